#pragma once

#include "common/joint_case.hpp"
#include "common/study.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/readout/small_displacements.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/// What the options of file 1 say of one body of a user's own.
struct BodyOptions
{
   std::string mesh, contact, support, load;
   std::vector<double> young = {1}, poisson = {0.3}; ///< one, or one for each attribute
};

/// What the options say of a half-plane without a mesh, in place of body 2.
struct HalfPlaneOptions
{
   double young = none, poisson = none, depth = none;

   bool given() const { return !std::isnan(young); }
};
void add_options(Study &study, HalfPlaneOptions &half_plane);

/// The options of body k: mesh1, young1, poisson1, contact1, support1 and load1 for k = "1".
void add_options(Study &study, BodyOptions &body, const std::string &k, const char *mesh_help);

/// What a case is reduced to.
struct OwnBodies
{
   Scene scene;
   std::optional<cattaneo::HalfPlane> half_plane;          ///< the last body
   std::vector<std::vector<cattaneo::Material>> materials; ///< of each body
   /// Estimated relative error of the stiffness; of bodies in series no more than the worst.
   double accuracy = 0;
   bool known_elements = true; ///< false: of a body that is a matrix they are not

   const cattaneo::ContactLine &line(int body = 0) const
   {
      return scene.reduction.bodies[body].line;
   }
   /// E* if all is of one material, else 0. Of materials that are known.
   double modulus() const;
   /// The corner at the first (1) or the last (-1) node of body 1's line; the lines of the two
   /// bodies run against each other. InputError where its exponents are not known.
   cattaneo::fretting::CornerModes corner(int end) const;
};

/// InputError naming body and key or option.
OwnBodies make_own_bodies(const JointCase &joint);

/// Warns of bodies that overlap by more than the length of a node's part of the line.
void warn_of_overlap(const cattaneo::ReducedProblem &problem,
                     const cattaneo::InterfaceReport &interface);
/// Of a march that found no equilibrium: warns of bodies that nothing holds and that touch
/// nothing at rest.
void warn_of_loose_bodies(const OwnBodies &own);
/// Warns of a stiffness with few right digits.
void warn_of_accuracy(double accuracy);

/// Warns of what lies beyond small displacements: what was noted of the march, and rotations of
/// bodies with elements in its last state.
void warn_of_large_displacements(OwnBodies &own, const cattaneo::SmallDisplacements &noted,
                                 const cattaneo::ContactState &last);
/// Of each interface whether its second side is a straight rigid line, or a half-plane.
std::vector<bool> even_sides(const JointCase &joint);

/// Displacements are small: a node presses along its own normal. One that bears although this
/// is far from the rigid line's, on a side beyond a corner for instance, holds the body as no
/// line could.
class SidesThatBear
{
public:
   explicit SidesThatBear(const cattaneo::InterfaceReport &interface);
   /// A state that the march has reached.
   void note(const cattaneo::ContactState &state);
   void warn() const;

private:
   struct Node
   {
      Eigen::Index index = -1;
      double angle = 0; ///< degrees between its normal and the line's
   };
   const cattaneo::InterfaceReport &face_; ///< must outlive it
   std::vector<Node> sides_;
   Node worst_;
};

} // namespace miniapp
