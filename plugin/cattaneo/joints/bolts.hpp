#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <functional>
#include <string>
#include <vector>

namespace cattaneo
{

/** A bolt that is tightened to a force. Before tightening it does nothing, during tightening it
    pulls with the force of the tool, afterwards it is a spring. A point of the load history
   that names its load tightens it: the multiplier at that point is the bolt's force, in units
   of the load's forces: 1 if these are those of the preload. A point that names it again
   tightens it again, also to the same force. In the other pieces nobody turns the nut, and the
   force follows from the joint. If the history does not know which loads its points name
    (LoadHistory::stated), a bolt is tightened where its multiplier changes. */
struct Bolt
{
   std::string load;     ///< of forces on its two ends that are each other's opposite
   double stiffness = 1; ///< as Reduction::add_shank() has it, > 0
};

/** Bolts that are tightened in the order of a load history. Each loses force while others are
    tightened.

    The bolt that is being tightened is a force, those tightened before are shanks, and the
    others do not act. Each part of the history has its own reduced problem, so that no
    iterations are needed. States are those of problem(), in which all bolts are shanks. There
    the multiplier of a bolt's load is its pretension T: N = T - stiffness · g, with N the force
    and g the approach of the bolt's ends. */
class BoltedJoint
{
public:
   /** @param loose     of all bodies, without these bolts and before obstacles move, its gaps
                        and friction set
       @param complete  adds what must come after shanks, motions of obstacles for instance
       InputError if a load is not there or is of displacements, or H is not known. */
   BoltedJoint(Reduction loose, std::vector<Bolt> bolts,
               std::function<void(Reduction &)> complete = {});

   /// The reduction with the shanks of all bolts, for fields and for all that follows from the
   /// tightened joint.
   Reduction tightened() const;
   /// The problem of tightened().
   const ReducedProblem &problem() const { return problem_; }
   /// The bolts.
   const std::vector<Bolt> &bolts() const { return bolts_; }
   /// Number of a bolt's load among those of the problem.
   Eigen::Index load(std::size_t bolt) const;
   /// Forces of the bolts in a state of problem(), in units of their loads' forces.
   Eigen::VectorXd forces(const ContactState &state) const;
   /// Is this bolt tightened in this piece of the history?
   bool tightens(std::size_t bolt, const LoadHistory &history, const LoadPiece &piece) const;

   /** Like march(), for a history in which multipliers of bolts are forces, from a state of
       problem(). The march ends when a bolt would push: its status is `stopped`, and the state
       and `event_time` are those at which the bolt's force is zero.

       A march need not tighten a bolt that a point after the first names with a force of 0, and
       none with more: a later march tightens it, which continues from the state of this one.

       InputError if another bolt is never tightened, or if a bolt is loosened at the end, is
       tightened to a negative force, or is tightened or named within the cycle. */
   MarchReport march(const LoadHistory &history, ContactState &state,
                     const MarchSettings &settings = {},
                     const MarchObserver &observer = {}) const;

private:
   struct Part;
   int last_tightening(const LoadHistory &history) const;
   Part part(const LoadHistory &history, const LoadPiece &piece,
             const ContactState &state) const;
   Eigen::VectorXd approaches(const ReducedProblem &problem, const ContactState &state) const;
   MarchReport march(const Part &part, ContactState &state, const MarchSettings &settings,
                     const MarchObserver &observer) const;
   std::size_t pushing(const Part &part, const ContactState &state) const;
   void go_back(const Part &part, const ContactState &before, const ContactState &beyond,
                std::size_t bolt, const MarchSettings &settings, ContactState &state) const;

   Reduction loose_;
   std::vector<Bolt> bolts_;
   std::function<void(Reduction &)> complete_;
   ReducedProblem problem_;
};

} // namespace cattaneo
