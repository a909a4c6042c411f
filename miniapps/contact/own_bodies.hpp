#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <optional>
#include <vector>

namespace miniapp
{

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

/// InputError naming body and key.
OwnBodies make_own_bodies(const JointCase &joint);

} // namespace miniapp
