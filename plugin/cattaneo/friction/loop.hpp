#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <vector>

namespace cattaneo
{

struct ContactState;

/** What does work with the multiplier λ_k of each load pattern in a state (size: patterns):

       of a force, the displacement of where it acts      d_k = Σ_l H_kl λ_l - F_kᵀ u,
       of a prescribed displacement, its reaction         r_k = Σ_l H_kl λ_l + F_kᵀ u,

    with u = {v; w} the displacements of the contact, F_k = {q_k; p_k} the pattern's forces, and
    H what the bodies do with their contact clamped (ReducedProblem::H). Their unit is that of
    work over that of the multiplier: a pattern of forces of resultant 1 has as multiplier its
    resultant, and as d its mean displacement along itself; per unit thickness in the plane, of
    the full circumference in axisymmetry. Positive d is along the force, positive r pushes
    along the displacement. From nothing at rest; where bodies are free to move, or a half-plane
    has a stated depth, relative to that.

    Where H is not known (ReducedProblem::knows_loads) it is the contact's part, ∓F_kᵀ u: what
    is missing is linear in the loads. InputError if the state does not fit the problem. */
Eigen::VectorXd conjugates(const ReducedProblem &problem, const ContactState &state);

/** The way of one load pattern in the plane of its force F and displacement d (whichever is the
    multiplier, and its conjugate), over a cycle or any other part of a history: the loop that
    tests of joints record.

    Loads that vary together pass energy to each other: the work of one may then be negative, or
    more than what is lost; the sum over all patterns is what is lost in a steady cycle. */
class Loop
{
public:
   /// Begins at a multiplier and its conjugate, see conjugates(). `whole`: false if that is the
   /// contact's part alone (ReducedProblem::knows_loads).
   Loop(Control control, double multiplier, double conjugate, bool whole = true);
   /// One without a point yet, to be read from a file.
   Loop() = default;
   /// The next point of the way, straight from the one before.
   void add(double multiplier, double conjugate);

   /// ∫ F dd by trapezoids, exact for a way of straight pieces. Where the loop closes it is the
   /// enclosed area: positive if it is run clockwise, F upwards over d, as where energy is
   /// lost. If not `whole`, right where the loop closes and no other load varies.
   double work() const { return work_; }
   /// Largest less smallest.
   double force_range() const { return most_.force - least_.force; }
   /// Largest less smallest.
   double displacement_range() const { return most_.displacement - least_.displacement; }
   /// Secant stiffness ΔF/Δd between the extremes, which F and d reach together unless another
   /// load moves while this one stays. NaN if this load did not vary, or not `whole`.
   double stiffness() const;
   /** Loss factor η = D/(2π U), with D = work() of a cycle and U = ½ (ΔF/2)(Δd/2) the largest
       energy of a spring of the secant stiffness that swings between the same extremes, thus
       η = 4D/(π ΔF Δd). Twice the equivalent viscous damping ratio D/(4π U). NaN as
       stiffness(), and where d did not move. The energy definition of [Lazan 1968]. */
   double loss_factor() const;

   /// For files of states, to the last bit.
   template <class Json>
   friend void to_json(Json &json, const Loop &loop);
   /// Sets a loop to what to_json() has written.
   template <class Json>
   friend void from_json(const Json &json, Loop &loop);

private:
   struct Point
   {
      double force = 0, displacement = 0;
   };
   Point point(double multiplier, double conjugate) const;
   /// Is the secant known?
   bool swings() const;

   Control control_ = Control::force;
   bool whole_ = false;
   Point least_, most_, last_;
   double work_ = 0;
};

/// One marched cycle.
struct CycleRecord
{
   int cycle = 0; ///< its number, from 1
   /// False if the march was taken up within the cycle, from a state that did not know of it:
   /// then all here is of the rest of it.
   bool whole = false;
   std::vector<Loop> loops;  ///< of each load pattern; their work() adds up to external_work
   double dissipation = 0;   ///< lost by friction in the cycle
   double external_work = 0; ///< of all loads in the cycle
   double normal_work = 0;   ///< -½(p_old + p_new)·Δw: vanishes as increments shrink
   double slip_change = 0;   ///< largest |v - v one cycle before|
   Eigen::VectorXd node_dissipation; ///< size n
};

} // namespace cattaneo
