#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <optional>
#include <vector>

namespace miniapp
{

/// Dofs of a body that something outside of it holds or moves.
struct Holding
{
   std::string kind;      ///< support, guide or displacement
   std::string name;      ///< as the case has it: "end:xy", the part of a guide, a load
   std::vector<int> dofs; ///< none is another's
};

/// What forces on a body follow from when its displacements are known.
struct HeldBody
{
   cattaneo::SharedMatrix K;           ///< of all dofs; none of a half-plane
   std::vector<int> component;         ///< of each dof, 0: x or r, 1: y or z
   std::vector<Eigen::Vector2d> place; ///< of each dof
   std::vector<cattaneo::BodyLoad> loads;
   std::vector<Holding> holdings;
   /// The same around the axis, where the body twists: of the turns of its nodes, and torques.
   struct Around
   {
      cattaneo::SharedMatrix K;
      std::vector<Eigen::Vector2d> place; ///< of each dof
      std::vector<cattaneo::BodyLoad> loads;
      std::vector<Holding> holdings;
   } around;
   /// Supports are no rows of K: what they bear is what is left over.
   bool supports_left_out = false;
};

/// What a case is reduced to.
struct OwnBodies
{
   Scene scene;
   std::optional<cattaneo::HalfPlane> half_plane;          ///< the last body
   std::vector<std::vector<cattaneo::Material>> materials; ///< of each body
   /// Estimated relative error of the stiffness; of bodies in series no more than the worst.
   double accuracy = 0;
   std::vector<HeldBody> held; ///< of each body
   bool known_elements = true; ///< false: of a body that is a matrix they are not
   std::optional<cattaneo::BoltedJoint> bolted; ///< of bolts that are tightened to a force

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

/// InputError naming body and key.
OwnBodies make_own_bodies(const JointCase &joint);

} // namespace miniapp
