#pragma once

#include <cattaneo/algebra/symmetric_product.hpp>
#include <cattaneo/friction/march.hpp>
#include <memory>
#include <vector>

namespace cattaneo
{

/** Marches with only those nodes of a contact that may change their states while loads swing,
    which are few of many in a joint that vibrates. Of the others, open nodes carry no force and
    are eliminated, and sticking nodes do not move. Their gaps and forces follow from the nodes
    that are kept.

    The first choice is a guess from the linear response, and the next ones are the nodes that
    changed their states in the cycles before. Every state is checked at all nodes:
    if a node that was left out would change its state, it is kept from then on, and the march
    has to be repeated from a state that it reached before. So the states are those of a march
    of all nodes, to round-off. */
class ChangingNodes
{
public:
   using Index = Eigen::Index;

   /// Keeps a reference to the solver of all nodes.
   explicit ChangingNodes(FrictionSolver &solver);
   ~ChangingNodes();

   /// As cattaneo::march(), whose states and records have all nodes and loads. The state at the
   /// end is checked once more by the equations of all nodes.
   MarchReport march(const LoadHistory &history, ContactState &state,
                     const MarchSettings &settings, const MarchObserver &observer);
   /// Has the last march to be repeated, from any state that the observer got? Its report and
   /// the state at its end then mean nothing.
   bool repeats() const { return repeats_; }
   /// How many nodes the last march had kept.
   Index kept() const;

private:
   struct Part;
   /// How near nodes come to the limits of their states in a march.
   struct Watch
   {
      void begin(const ReducedProblem &problem, const ContactState &state);
      void look(const ReducedProblem &problem, const ContactState &state);
      std::vector<bool> found() const;

      bool cycles = false; ///< did the march go through at least one?
      std::vector<NodeState> status;
      std::vector<bool> changes;
      Eigen::VectorXd least, most; ///< forces that are left to the limit
   };

   bool choose(const LoadHistory &history, const ContactState &state);
   std::vector<bool> guess(const Eigen::MatrixXd &changes, const ContactState &state) const;
   bool holds(const std::vector<Index> &stuck) const;

   FrictionSolver &solver_;
   const ReducedProblem &problem_;
   bool worthwhile_;
   const SymmetricProduct times_K_;
   std::unique_ptr<Part> part_; // none: all nodes are used
   double swing_ = 0;           // range of the loads for which the nodes were chosen
   double stretch_ = 1.5;       // of the linear response, when nodes are chosen
   Watch watch_;                // of the last march
   std::vector<Index> joined_;  // nodes that had been left out before, for this range
   bool joins_ = false;         // some of them have to be added
   bool repeats_ = false;
   bool all_ = false; // the next march needs all nodes
};

} // namespace cattaneo
