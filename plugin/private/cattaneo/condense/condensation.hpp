#pragma once

#include <cattaneo/condense/condensed_body.hpp>
#include <cattaneo/condense/free_motions.hpp>
#include <cattaneo/condense/trace.hpp>

namespace cattaneo
{

/// The effect of load patterns on a body whose contact nodes are clamped, in global components.
struct ClampedLoads
{
   Eigen::MatrixXd forces;   ///< contact forces, one column per pattern
   Eigen::MatrixXd response; ///< F_kᵀ K_II⁻¹ F_j of the patterns' interior forces
   /// Work of pattern k's forces (or those of its motion) at the supports on the motion that
   /// pattern j prescribes.
   Eigen::MatrixXd reaction;
};

/// The results of a solver for a body, in global components, for contact dofs that are free.
struct Condensation
{
   Eigen::MatrixXd S;
   FreeMotions free;
   ClampedLoads clamped;
   Counters counters;
   std::shared_ptr<const BodySolver> solver;
   Eigen::MatrixXd H =
      {}; ///< only set for a body with blocks; else H follows from the clamped loads
};

/// ReducedProblem::H from the energies of clamped loads, with its signs set and made symmetric.
Eigen::MatrixXd load_by_load(const std::vector<BodyLoad> &loads, const ClampedLoads &clamped);

/** Replaces contact displacements u by u - g ℓ if loads move the contact by g (one column per
    load). Changes the forces f of the loads, with S u + f ℓ in all, and the response H of loads
    with these controls. */
void shift_contact(const Eigen::MatrixXd &g, const Eigen::MatrixXd &S,
                   const std::vector<Control> &controls, Eigen::MatrixXd &f,
                   Eigen::MatrixXd &H);

/// The numbers from 0 to count - 1 that are not in `held`.
std::vector<int> others(const std::vector<int> &held, Eigen::Index count);

/// Dofs of all contact nodes, {x; y} (in space {x; y; z}, torsion: the twist), and which of
/// them supports hold. Held dofs are not part of the condensed stiffness.
struct ContactDofs
{
   std::vector<int> all;
   std::vector<int> held; ///< positions in `all`, increasing
   /// Displacements by unit loads, `all` × loads. Empty if no load moves a held dof.
   Eigen::MatrixXd moved = {};
   /// The dofs of `held` in whose plane (the one normal to their component) a load moves a dof.
   /// This is then no plane of symmetry, although the node itself may be at rest.
   std::vector<int> in_moved_plane = {};

   /// Notes that the load moves the dof at a position of `all`. InputError that names the node,
   /// for a body of torsion.
   void move(int position, Eigen::Index load, double by, const Trace &trace,
             const std::vector<BodyLoad> &loads);
   std::vector<int> free() const;
   std::vector<int> free_positions() const;
};

/// The contact dofs of a trace on a body with `dofs` dofs. InputError if the trace has another
/// formulation, or if one of its dofs is not from 0 to dofs - 1.
ContactDofs contact_dofs(const Trace &trace, Formulation formulation, int dofs);
/// The same for a line. InputError also if the line is not valid (ContactLine::validate).
ContactDofs contact_dofs(const ContactLine &line, Formulation formulation, int dofs);

/// Does a load move one of these dofs in the plane normal to the component of a contact dof?
/// `position` is the place of this contact dof among those of the trace.
bool moves_plane(const Trace &trace, int position, const DofPlaces &places,
                 const std::vector<int> &fixed, const std::vector<BodyLoad> &loads);

/// Throws an InputError that names the node at a position of the contact dofs. `how` says in
/// which way it moves, what is allowed, and what to do.
[[noreturn]] void refuse_motion(const Trace &trace, int position, const std::string &how);
/// The argument `how` of refuse_motion() for a node that a rigid block moves.
constexpr const char *in_guide =
   "is in a guide, contact nodes must be free, held by a support or moved by a load: end the "
   "contact before the guide";

/// The condensed body in the frames of the contact line, without the false stiffness against
/// rigid motions that round-off causes. Only names and controls of `loads` are used. InputError
/// as in meet_supports().
CondensedBody in_local_frames(const ContactLine &line, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found);
/// The same for a surface.
CondensedBody in_local_frames(const ContactSurface &surface, const std::vector<BodyLoad> &loads,
                              const ContactDofs &contact, Condensation found);

/// The results of condense() before it turns to the frames of the line; `contact` are the free
/// dofs of contact_dofs().
Condensation condense_by_factor(const AssembledBody &body, const std::vector<int> &contact,
                                const BodySolver *alike);
/// The same with the free motions of a body without blocks, which are known.
Condensation condense_by_factor(const AssembledBody &body, const std::vector<int> &contact,
                                const BodySolver *alike, FreeMotions free);

/// The body, with the rows of supports that were eliminated fixed if it is grounded.
AssembledBody with_eliminated(const AssembledBody &body);

/// InputError unless a trace has the dofs of the nodes that it names, to 1e-9 of its size and
/// to round-off of its coordinates.
void require_in_place(const Trace &trace, const DofPlaces &places);

} // namespace cattaneo
