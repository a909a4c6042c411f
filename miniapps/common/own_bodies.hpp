#pragma once

#include "common/study.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace miniapp
{

/// What the options say of one body of a user's own.
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

/// One body on the rigid line that touches it or on such a half-plane, or two.
struct OwnBodies
{
   Scene scene;
   std::optional<cattaneo::HalfPlane> half_plane;
   std::vector<std::vector<cattaneo::Material>> materials; ///< of each body
   /// Estimated relative error of the stiffness; of two in series no more than the worse.
   double accuracy = 0;

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

/// InputError naming body and option. @param pairing of nodes along the contact
OwnBodies make_own_bodies(const std::vector<BodyOptions> &options,
                          const HalfPlaneOptions &half_plane, int order, bool plane_stress,
                          double pairing);

/** The same of a stiffness that another program wrote (read_stiffness()), which has as many
   bodies as there are options. Body 1 is the one with a set of nodes that contact1 names;
   supports and loads are on sets, "FLOOR:xy", "P traction TOP 0 -1", and the file has its own.
   Their materials are not known. */
OwnBodies own_bodies_of_matrix(const std::string &matrix,
                               const std::vector<BodyOptions> &options,
                               const HalfPlaneOptions &half_plane, double pairing);

/// Warns of bodies that overlap by more than the distance of their nodes.
void warn_of_overlap(const cattaneo::ReducedProblem &problem,
                     const cattaneo::ContactLine &line);
/// Warns of a stiffness with few right digits.
void warn_of_accuracy(double accuracy);

/// Displacements are small: a node presses along its own normal. One that bears although this
/// is far from the rigid line's, on a side beyond a corner for instance, holds the body as no
/// line could.
class SidesThatBear
{
public:
   explicit SidesThatBear(const cattaneo::ContactLine &line);
   /// A state that the march has reached.
   void note(const cattaneo::ContactState &state);
   void warn() const;

private:
   struct Node
   {
      Eigen::Index index = -1;
      double angle = 0; ///< degrees between its normal and the line's
   };
   const cattaneo::ContactLine &line_;
   std::vector<Node> sides_;
   Node worst_;
};

} // namespace miniapp
