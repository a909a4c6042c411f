#pragma once

#include <cattaneo/friction/contact_state.hpp>

namespace cattaneo
{

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
   /// load moves while this one is held there. NaN if this load did not vary, or not `whole`.
   double stiffness() const;
   /** Loss factor η = D/(2π U), with D = work() of a cycle and U = ½ (ΔF/2)(Δd/2) the largest
       energy of a spring of the secant stiffness that swings between the same extremes, thus
       η = 4D/(π ΔF Δd). Twice the equivalent viscous damping ratio D/(4π U). NaN as
       stiffness(), and where d did not move. The energy definition of [Lazan 1968]. */
   double loss_factor() const;

private:
   struct Point
   {
      double force, displacement;
   };
   Point point(double multiplier, double conjugate) const;
   /// Is the secant known?
   bool swings() const;

   Control control_;
   bool whole_;
   Point least_, most_, last_;
   double work_ = 0;
};

} // namespace cattaneo
