#pragma once

#include "contact/own_bodies.hpp"

#include <cattaneo/mesh/smooth_sides.hpp>

#include <cattaneo/readout/small_displacements.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <vector>

namespace miniapp
{

/// Warns of bodies that overlap by more than the length of line that belongs to a node.
void warn_of_overlap(const cattaneo::ReducedProblem &problem,
                     const cattaneo::InterfaceReport &interface);
/// Warns of parts of an interface that no contact node represents.
void warn_of_left_out(const cattaneo::InterfaceReport &interface);
/// After a march that found no equilibrium, warns of bodies that nothing holds and that touch
/// nothing at rest.
void warn_of_loose_bodies(const OwnBodies &own);
/// Warns of a stiffness with few correct digits.
void warn_of_accuracy(double accuracy);

/// Warns of displacements that are not small: those recorded in the march, and rotations of
/// bodies with elements in its last state.
void warn_of_large_displacements(Scene &scene, const cattaneo::SmallDisplacements &noted,
                                 const cattaneo::ContactState &last);
/// Warns of a free side whose edges stay the chords of a curve, if the wall beside the side is
/// thereby thinner or thicker by more than a fortieth.
void warn_of_thin_wall(const cattaneo::SmoothSides &sides, const std::string &body, int order);
/// Notes which sides were taken as smooth curves, and the effect on gaps; `sides`: those of
/// each body with a mesh.
void note_smooth_sides(const JointCase &joint, const cattaneo::Reduction &reduction,
                       const std::vector<cattaneo::SmoothSides> &sides);
/// Warns where chords of curved sides change the pressure of a node by more than a twentieth of
/// the largest one. The nodal forces p are those of the state with the largest of a march.
/// Returns the error of pressures due to chords, and warns of it.
cattaneo::ChordalError warn_of_chords(const cattaneo::Reduction &reduction,
                                      const Eigen::VectorXd &p, const Eigen::VectorXd &w);
/// Warns if the elements that carry forces next to the axis are linear: their node on the axis
/// takes no force.
void warn_of_linear_axis(const cattaneo::Reduction &reduction, const Eigen::VectorXd &p);
/// For each interface: is its second side a straight rigid line, or a half-plane?
std::vector<bool> even_sides(const JointCase &joint);

/// Displacements are small, so that a node presses along its own normal. If this normal has
/// another direction than that of the rigid line, for instance beyond a corner of the side, the
/// node holds the body in a direction in which the line cannot. If the other side is not such a
/// line, the corners of both sides are checked.
class SidesThatBear
{
public:
   /// On a straight rigid line through two points; without points, on a line that is parallel
   /// to the side in the mean.
   explicit SidesThatBear(const cattaneo::InterfaceReport &interface,
                          const std::vector<Eigen::Vector2d> &rigid_line);
   /// At the corners of the bodies' lines.
   SidesThatBear(const cattaneo::InterfaceReport &interface,
                 const std::vector<cattaneo::CondensedBody> &bodies);
   /// A state that the march has reached.
   void note(const cattaneo::ContactState &state);
   void warn() const;

private:
   struct Node
   {
      Eigen::Index index = -1;
      double angle =
         0; ///< degrees between its normal and that of the line, or of the turn at a corner
      Eigen::Vector2d place{0, 0}; ///< its own; of the corner
   };
   const cattaneo::InterfaceReport &face_; ///< must outlive it
   bool corners_ = false;
   std::vector<Node> sides_;
   Node worst_;
};

/// Warns if the interval of a side of an interface ends within an element, which is then not
/// part of the contact.
void warn_of_cut_elements(const mfem::Mesh &mesh, const cattaneo::BoundaryPart &part,
                          const std::string &called, const std::string &name);

} // namespace miniapp
