#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/readout/edge_fit.hpp>
#include <cattaneo/readout/zones.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// Which body the crack is in; its shear traction gives K_T its sign. Body 1 is the one whose
/// contact line the reduced problem has.
enum class CrackedBody
{
   first,
   second
};

/** One end of a stretch of contact, with its results. Units are those of the reduced problem
    (forces per unit thickness); arc length as ReducedProblem::arc_length. */
struct ContactEdge
{
   ZoneBorder position;     ///< arc length, read out between the nodes by zones()
   int side = 1;            ///< +1: the contact lies at larger arc length, -1: at smaller
   double half_width = 0.0; ///< of the stretch of contact
   Eigen::Index first = 0;  ///< nodes of this edge's half of the contact,
   Eigen::Index last = -1;  ///< in increasing order; a middle one belongs to both halves
   /// The contact reaches the end of the contact line, where a body may end with a corner.
   bool complete = false;
   std::string why_not;    ///< why there are no intensities: complete, or cut off; else empty
   FittedIntensity k_n;    ///< zero if there are none
   FittedIntensity k_t;    ///< zero if there are none; signed as fretting::Edge::k_t
   double friction = 0.0;  ///< at the outermost node in contact
   double slip_zone = 0.0; ///< computed: from the edge to where stick begins, 0 if it sticks
   double slip_zone_error = 0.0; ///< estimate, from the errors of both positions
   bool slides = false; ///< no stick in this stretch of contact: slip_zone is its whole width

   /// InputError if its nodes are not some of the problem's, or if that has no weights.
   void validate(const ReducedProblem &problem) const;
};

/** Shear tractions if nothing had slipped since @a pressed: the nodes of @a tied keep the slip
    of @a pressed, those closed in @a loaded stay closed, all others are free; the loads are
    those of @a loaded. Plane problems with friction.
    @param tied one entry a node */
ContactState fully_stuck(const ReducedProblem &problem, const ContactState &pressed,
                         const ContactState &loaded, const std::vector<bool> &tied);
/// Tied are the nodes closed in @a loaded.
ContactState fully_stuck(const ReducedProblem &problem, const ContactState &pressed,
                         const ContactState &loaded);

/** K_N, K_T and the slip zone at each end of each stretch of contact, in the order of the
    nodes. An edge is incomplete unless the contact reaches an end of the contact line. Where
    both bodies go on smoothly beyond that end, the line is cut off, and the edge is neither. An
    end on a plane of symmetry is no edge: the contact continues as its mirror image, and the
    other edge has the whole half of the contact.

    K_N is fitted to the pressure of @a loaded. K_T is fitted to the shear of fully_stuck().
    Its singularity does not lie at the edge of contact but within a spacing of the last tied
    node. An auxiliary stuck solution shows where it lies (a uniform misfit strain between the
    bodies, singular at every edge). K_T is interpolated to the edge of contact between two
    solutions: one ties the nodes in contact, the other one node more at each edge. This brings
    the error from first to second order in the spacing.

    @param pressed state after the normal load alone, before the cyclic loads
    @param loaded state at peak load: frictional, or fully stuck
    InputError for a problem that is not plane or has no friction, and for a contact line of
    several pieces. Also for a closed line that is in contact where it begins, and for a contact
    with too few nodes for the fit. */
std::vector<ContactEdge> contact_edges(const ReducedProblem &problem,
                                       const ContactState &pressed, const ContactState &loaded,
                                       CrackedBody cracked = CrackedBody::second,
                                       const FitSettings &settings = {});

/// Tractions of a state in the half of the contact next to an edge; shear on the cracked body.
/// InputError as ContactEdge::validate(), and if the problem has no arc lengths.
EdgeTractions edge_tractions(const ReducedProblem &problem, const ContactState &state,
                             const ContactEdge &edge,
                             CrackedBody cracked = CrackedBody::second);

} // namespace cattaneo
