#pragma once

#include "common/study.hpp"

#include <functional>
#include <vector>

namespace miniapp
{

/** The square punch of thesis 3.7: |x| < a, 0 < y < 2a, on a rigid plane or on an elastically
    similar half-plane: the half-plane itself, which has no mesh (its displacements are relative
    to the depth 1e4 a), or a block of half-width and depth `domain`, held at its bottom.

    Units a = P0 = E' = 1, E' = E/(1-ν²) of each body. Load patterns: "P", a uniform pressure of
    resultant 1 on the top face; "Q", a uniform shear of resultant 1 in +x on the top face with
    the linear pressure that balances its moment about the contact plane. */
struct PunchOptions
{
   bool half_plane = false;
   double poisson = 0.3;
   int order = 2;
   int nodes = 201; ///< contact nodes; (nodes - 1) must be a multiple of the order
   double grading =
      0.01; ///< size of the contact elements at the corners over those in the middle
   double plane_stiffness = 1;  ///< E' of the half-plane over that of the block
   double plane_poisson = none; ///< of the half-plane; NaN: that of the block
   double domain = 0; ///< half-width and depth of the half-plane's block, in a; 0: no block
   /// Growth of the elements away from the contact, the largest of which are 0.8 (growth - 1)
   /// a. 0: the default of element_growth(), but 1.1 and 0.04 a for order 1.
   double growth = 0;
   /// Grid lines of the contact from -1 to 1 in place of `nodes` and `grading`.
   std::vector<double> grid = {};
   /// Refines the mesh of a body (0 or 1) before it is made; both alike along the contact.
   std::function<void(mfem::Mesh &, int)> refine = {};

   /// True if the support of the half-plane is too far away to affect the contact.
   bool unbounded() const { return domain == 0 || domain >= 1e3; }
   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

/// The options --poisson, --order, --nodes, --grading and --domain.
void add_options(Study &study, PunchOptions &options);

Scene make_punch(const PunchOptions &options);

} // namespace miniapp
