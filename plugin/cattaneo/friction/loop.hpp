#pragma once

#include <cattaneo/reduced/reduced_problem.hpp>
#include <vector>

namespace cattaneo
{

struct ContactState;

/** Conjugates of the multipliers ℓ_k of all load patterns in a state (size: patterns), which do
    work with them:

       the displacement of the place where a force acts   d_k = Σ_j H_kj ℓ_j - F_kᵀ u,
       the reaction of a prescribed displacement          r_k = Σ_j H_kj ℓ_j + F_kᵀ u,

    with u = {v; w} the displacements of the contact, F_k = {q_k; p_k} the pattern's forces, and
    H the response of the bodies with their contact clamped (ReducedProblem::H). Their unit is
    that of work over that of the multiplier. A pattern of forces of resultant 1 has its
    resultant as multiplier, and its mean displacement along itself as d. They are per unit
    thickness in the plane, and for the full circumference in axisymmetry. Positive d is along
    the force, positive r pushes along the displacement. Displacements are relative to bodies at
    rest without loads; if bodies are free to move, or a half-plane has a stated depth, they are
    relative to that.

    If H is not known (ReducedProblem::knows_loads) this is the contact's part alone, ∓F_kᵀ u.
    The missing part is linear in the loads. InputError if the state does not fit the
    problem. */
Eigen::VectorXd conjugates(const ReducedProblem &problem, const ContactState &state);

/** The path of one load pattern in the plane of its force F and displacement d (one is the
    multiplier, the other its conjugate), over a cycle or any other part of a history. Tests of
    joints record this loop.

    Loads that vary together exchange energy: the work of one may then be negative, or more than
    the loss. In a steady cycle the sum over all patterns is the loss. */
class Loop
{
public:
   /// Begins at a multiplier and its conjugate, see conjugates(). `whole` is false if the
   /// conjugate is the contact's part alone (ReducedProblem::knows_loads).
   Loop(Control control, double multiplier, double conjugate, bool whole = true);
   /// A loop without a point, to be read from a file.
   Loop() = default;
   /// Adds the next point of the path, which is straight from the point before.
   void add(double multiplier, double conjugate);

   /// ∫ F dd by trapezoids, exact for a path of straight pieces. If the loop closes this is the
   /// enclosed area. It is positive if the loop runs clockwise (F upwards over d), as when
   /// energy is lost. If not `whole`, it is correct only if the loop closes and no other load
   /// varies.
   double work() const { return work_; }
   /// Largest less smallest.
   double force_range() const { return most_.force - least_.force; }
   /// Largest less smallest.
   double displacement_range() const { return most_.displacement - least_.displacement; }
   /// Secant stiffness ΔF/Δd between the extremes. F and d reach them together, unless another
   /// load changes while this one stays. NaN if this load did not vary, or if not `whole`.
   double stiffness() const;
   /** Loss factor η = D/(2π U), with D = work() of a cycle and U = ½ (ΔF/2)(Δd/2) the largest
       energy of a spring of the secant stiffness that swings between the same extremes, thus η
       = 4D/(π ΔF Δd). It is twice the equivalent viscous damping ratio D/(4π U). NaN if
       stiffness() is, or if d did not change. The energy definition of [Lazan 1968]. */
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
   /// False if the march was resumed within the cycle from a state without its record. All
   /// values here then belong to the rest of the cycle.
   bool whole = false;
   std::vector<Loop>
      loops;               ///< loop of each load pattern; their work() adds up to external_work
   double dissipation = 0; ///< lost by friction in the cycle
   double external_work = 0;         ///< of all loads in the cycle
   double normal_work = 0;           ///< -½(p_old + p_new)·Δw: vanishes as increments shrink
   double slip_change = 0;           ///< largest |v - v one cycle before|
   Eigen::VectorXd node_dissipation; ///< size n
};

} // namespace cattaneo
