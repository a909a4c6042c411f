#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <cattaneo/joints/vibration.hpp>
#include <optional>
#include <vector>

namespace miniapp
{

/// Dofs of a body that one support, guide or load holds or moves.
struct Holding
{
   std::string kind;      ///< support, guide or displacement
   std::string name;      ///< its name in the case: "end:xy", the part of a guide, a load
   std::vector<int> dofs; ///< each dof belongs to one of them
};

/// Data from which the forces on a body follow, if its displacements are known.
struct HeldBody
{
   cattaneo::SharedMatrix K;           ///< of all dofs; none of a half-plane
   std::vector<int> component;         ///< of each dof, 0: x or r, 1: y or z
   std::vector<Eigen::Vector2d> place; ///< of each dof
   std::vector<cattaneo::BodyLoad> loads;
   std::vector<Holding> holdings;
   /// The same around the axis, if the body twists: rotations of its nodes, and torques.
   struct Around
   {
      cattaneo::SharedMatrix K;
      std::vector<Eigen::Vector2d> place; ///< of each dof
      std::vector<cattaneo::BodyLoad> loads;
      std::vector<Holding> holdings;
   } around;
   /// Supports have no rows in K; their forces follow from the balance.
   bool supports_left_out = false;
};

/// The bodies of a case, reduced.
struct OwnBodies
{
   Scene scene;
   std::optional<cattaneo::HalfPlane> half_plane;          ///< the last body
   std::vector<std::vector<cattaneo::Material>> materials; ///< of each body
   std::vector<std::vector<double>> densities; ///< of each body with a mesh; empty: not given
   /// Estimated relative error of the stiffness; for bodies in series that of the worst body at
   /// most.
   double accuracy = 0;
   std::vector<HeldBody> held; ///< of each body
   /// By number: bodies that are matrices with a mass.
   std::map<std::size_t, cattaneo::VibratingBody> vibrating;
   bool known_elements = true;                  ///< false for a body that is a matrix
   std::optional<cattaneo::BoltedJoint> bolted; ///< for bolts that are tightened to a force

   const cattaneo::ContactLine &line(int body = 0) const
   {
      return scene.reduction.bodies[body].line;
   }
   /// E* if all bodies have the same known material, else 0.
   double modulus() const;
   /// The corner at the first (1) or the last (-1) node of body 1's line; the lines of the two
   /// bodies run in opposite directions. InputError if its exponents are not known.
   cattaneo::fretting::CornerModes corner(int end) const;
};

/// InputError naming body and key.
OwnBodies make_own_bodies(const JointCase &joint);

} // namespace miniapp
