#pragma once

#include <cattaneo/condense/assembled_body.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <limits>
#include <memory>
#include <vector>

namespace cattaneo
{

/// A body with its mass. Stiffness, mass and loads are as they were before
/// CondensedBody::thicken().
struct VibratingBody
{
   AssembledBody body; ///< as it was condensed
   SharedMatrix M;     ///< symmetric and positive definite, of the same dofs
};

/// Rows {v; w} of a problem that are kept as they are, true or false.
using GluedRows = std::vector<bool>;

/** The rows that a small vibration about a state leaves as they are. A closed node does not
    open, and one with friction does not slip, even if it stands at its limit of friction: it
    leaves that limit with the first reversal. A closed node without friction slips, and an open
    one moves freely, as does one that touches without a force. Held rows are glued. */
GluedRows glued_rows(const ReducedProblem &problem, const ContactState &state);

/// Closed nodes with friction whose state is slip: they stand at the limit of friction.
int nodes_at_limit(const ReducedProblem &problem, const ContactState &state);

/// What modes() came to: the lowest modes of vibration of a joint whose nodes are glued.
struct Modes
{
   Eigen::VectorXd omega; ///< circular frequencies, ascending, in radians per unit of time
   /// Of each mode and each body: displacements of all dofs, φ, with φᵀ M φ = 1 over all
   /// bodies.
   std::vector<std::vector<Eigen::VectorXd>> shapes;
   /// ‖K φ - ω² M φ‖ / ‖K φ‖ of each mode, on the dofs that move.
   Eigen::VectorXd residuals;
   /// modes × components (x, y; about an axis r, z; in space x, y, z): the mass that each mode
   /// moves if the ground moves along the component, (φᵀ M r)². About an axis that of r is 0.
   Eigen::MatrixXd effective_mass;
   int rigid = 0; ///< motions that nothing resists; they are left out

   Eigen::MatrixXd coordinates;       ///< of the modes, for with_modes()
   Eigen::MatrixXd rigid_coordinates; ///< likewise
};

/// A place where a displacement is wanted: a dof of a body.
struct OutputDof
{
   int body = 0; ///< its number
   int dof = 0;  ///< of its stiffness
};

/** A joint for programs of dynamics, by the method of Hurty, Craig and Bampton: M ẍ + K x = F ℓ
   + forces of the contact, with x the relative displacements {v; w} that are not held, and then
    amplitudes of modes with all relative displacements held at 0. K has no contact stiffness:
    the contact is in the forces, {q; p} on the rows of {v; w}. */
struct CraigBampton
{
   Eigen::MatrixXd K;              ///< stiffness, symmetric
   Eigen::MatrixXd M;              ///< mass, symmetric
   std::vector<Eigen::Index> rows; ///< of {v; w}, of the first coordinates
   /// Circular frequencies of the modes, of the other coordinates. The first are 0: motions
   /// that nothing resists.
   Eigen::VectorXd omega;
   std::vector<std::string> loads; ///< names of the loads of forces
   Eigen::MatrixXd F;              ///< coordinates × loads: forces per unit multiplier
   Eigen::MatrixXd R;              ///< outputs × coordinates: displacements
};

/** The bodies of a joint in one system of coordinates: the displacements of dofs beyond the
    contact, those of the contact nodes, and the relative displacements of the problem.
   Stiffness and mass are sparse, and springs of bolts are in the stiffness. */
class VibratingStructure
{
public:
   /** @param reduction  of these bodies, in their order, with the shanks
       @param bodies     as they were condensed
       @param shanks     bolts that act as springs, loads of the bodies by name
       InputError if numbers or sizes of bodies disagree, if bodies twist, if the stiffness of
       the bodies and shanks is not that of the problem, or if a mass is not symmetric, positive
       definite where the body moves, and the same along all axes. with_modes() and
       craig_bampton() refuse an obstacle that is free to move, which has no mass here. */
   VibratingStructure(Reduction &reduction, std::vector<VibratingBody> bodies,
                      const std::vector<Bolt> &shanks = {});
   ~VibratingStructure();

   /// Mass of all bodies, in the unit of density times volume; in the plane per unit of
   /// thickness unless the bodies have one.
   double mass() const;

   /// Has the problem the stiffness of the reduction, to round-off?
   bool stiffness_of(const ReducedProblem &problem) const;

   /** The lowest modes with these rows glued. Motions that nothing resists are no modes. By the
       Lanczos method with shift and inversion.
       @param count at least 1
       InputError if there are fewer dofs than modes, or if the method finds fewer. */
   Modes modes(const GluedRows &glued, int count) const;

   /** The problem with one more load for each mode, named "mode 1", "mode 2", …: the forces
       M φ on the bodies. Its multiplier is α, and its conjugate is the modal amplitude
       φᵀ M x. States of the problem go on in this one, see with_modes(state).
       InputError if a load has such a name, or if parts of the bodies float apart. */
   ReducedProblem with_modes(const Modes &modes) const;
   /// The state in the problem with modes: their multipliers are 0.
   ContactState with_modes(const Modes &modes, ContactState state) const;

   /** The condensed stiffness and mass of the relative displacements of the contact and of the
       lowest modes with all of them held.
       @param count    largest number of modes besides motions that nothing resists, at least 1
       @param most     largest circular frequency of these modes
       @param outputs  rows of CraigBampton::R
       Displacements that loads prescribe are 0. Costs two solves for each row of the contact.
       InputError as of modes(), or for an output that is no dof. */
   CraigBampton craig_bampton(int count, double most = std::numeric_limits<double>::infinity(),
                              const std::vector<OutputDof> &outputs = {}) const;

private:
   struct Parts;
   std::unique_ptr<Parts> parts_;
   Reduction &reduction_;
};

} // namespace cattaneo
