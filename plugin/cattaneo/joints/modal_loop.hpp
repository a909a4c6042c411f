#pragma once

#include <cattaneo/friction/march.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// How the size of a modal loop is stated.
enum class LoopSize
{
   amplitude, ///< half of the range of the modal amplitude q
   energy     ///< of the spring of the secant stiffness at that amplitude, ½ α q
};

/// How modal loops are marched. The defaults need no tuning.
struct ModalLoopSettings
{
   /// Its increments are those of each half of a cycle, to begin with, if there is no exact
   /// path.
   MarchSettings march;
   LoopSize size = LoopSize::amplitude; ///< what the size of a loop is
   int cycles = 200;                    ///< marched at most until a loop is steady
   /// A loop is steady if a cycle ends in the state in which it began: displacements and forces
   /// of the nodes by this share of their largest ranges in the cycle (what later cycles add is
   /// counted), and ∮ α dq by this share of the loss.
   double steady_tolerance = 1e-9;
   double tolerance = 1e-9; ///< of the size that is asked for, relative
   /// Where the march takes increments, they are doubled, at most three times, until that
   /// changes zeta by less than this share of it, and omega by less than a tenth of this share.
   double increment_error = 0.02;
};

/// A point of a loop.
struct LoopPoint
{
   double force = 0;     ///< the modal force α
   double amplitude = 0; ///< the modal amplitude φᵀ M x, less that in the middle of the loop
};

/** A steady loop of one mode, and what a vibration with its amplitude has: the structure moves
    quasi-statically under the load M φ, whose multiplier α swings between two opposite values,
    until a cycle ends in the state in which it began. */
struct ModalLoop
{
   FrictionStatus status = FrictionStatus::converged; ///< that of its march
   /// One sentence where there is no loop of the size that was asked for.
   std::string message;
   /// The force from which on nothing holds the mode in equilibrium: the joint slides as a
   /// whole. NaN: it was not reached.
   double sliding_force = std::numeric_limits<double>::quiet_NaN();

   double force = 0;     ///< half of the range of α
   double amplitude = 0; ///< half of the range of q
   double energy = 0;    ///< ½ force · amplitude
   /// By the secant, ω² = Δα/Δq.
   double omega_secant = 0;
   double zeta_secant = 0; ///< D/(2π α q), with the secant
   /// By the first harmonic, ω₁² = ∮ α cos θ dθ/(π q) where q moves as q cos θ: closer to a
   /// vibration.
   double omega = 0;
   double zeta = 0; ///< D/(2π ω₁² q²)
   /// Estimates of the errors of omega and zeta because the march takes increments: how much
   /// they differ from those by half as many. 0 on an exact path.
   double omega_error = 0;
   double zeta_error = 0;  ///< see omega_error
   double dissipation = 0; ///< D, lost by friction in the cycle
   /// ∮ α dq by trapezoids, which is D to round-off.
   double area = 0;
   Eigen::VectorXd node_dissipation; ///< of each node of the problem; they add up to D
   int cycle = 0;                    ///< number of cycles until the loop was steady, or at most
   /// False: cycles still changed at the last one, see the message. A steady loop that is not
   /// of the size that was asked for has another `status` than converged.
   bool steady = false;
   /// By how much the last cycle changed the state, over what moves in it.
   double change = 0;
   /// The joint ratchets: forces repeat, but each cycle adds the same displacements, the
   /// largest of which is this one. 0: it does not.
   double ratchet = 0;
   Eigen::Index ratchet_node = -1; ///< where that is
   /// The modal amplitude φᵀ M x in the middle of the loop.
   double middle = 0;

   /// For comparison: by the secant of the first loading from the state before it.
   double omega_first = 0;
   /// For comparison: damping ratio by Masing's rule from the curve of the first loading.
   double zeta_masing = 0;

   std::vector<LoopPoint> points; ///< of the steady cycle, its changes of state among them
   ContactState peak;             ///< the state at the largest force of the steady cycle
   ContactState trough;           ///< likewise at the least force
};

/** The steady loop of a mode, of a stated size.

    The force that makes a loop of that size is found by regula falsi. The first trial is
    marched from the given state, and each later one from the steady loop of the largest force
    that was not too large, so that the joint never went through a larger loop. Where cycles
    approach a steady one in a constant ratio, as when a vibration relieves shear that the
    assembly has left, the march goes on from where they lead to, and the next cycles show
    whether it is steady.

    Where no force makes such a loop, since the joint slides as a whole before, the loop of the
    largest force that has one is returned with the status and a message. A loop that is not
    steady after ModalLoopSettings::cycles is returned with `steady` false and a message: its
    frequency and damping are no results. That is so too if the joint ratchets. A loss that is
    round-off of the work of the state's forces counts as 0.

    @param problem  with the modes' loads, see VibratingStructure::with_modes()
    @param state    about which it vibrates; the multiplier of the mode is 0
    @param load     name of the mode's load
    @param omega    frequency where no node slips, to begin with
    @param size     > 0
    InputError for another value, for one so small that the modal forces are round-off of the
    state's, or where the load is none of forces. */
ModalLoop modal_loop(FrictionSolver &solver, const ReducedProblem &problem,
                     const ContactState &state, const std::string &load, double omega,
                     double size, const ModalLoopSettings &settings = {});

/** Loops of one mode with several sizes, from the smallest on, as modal_loop() finds them. Each
    begins at the steady loop of the size before, so that shear which the assembly has left is
    relieved only once. Sizes beyond one at which the joint slides get the loop of that one,
   with its sliding_force.

   @param sizes  increasing
    InputError as of modal_loop(), and if sizes do not increase. */
std::vector<ModalLoop> modal_curve(FrictionSolver &solver, const ReducedProblem &problem,
                                   const ContactState &state, const std::string &load,
                                   double omega, const std::vector<double> &sizes,
                                   const ModalLoopSettings &settings = {});

} // namespace cattaneo
