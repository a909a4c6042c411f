#pragma once

#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>

namespace cattaneo_test
{

/// A block |x| < size, of height 2 size, on a wider block held at its base.
struct TwoBlocks
{
   double size = 1, young = 1;
   double contrast = 1; ///< modulus of the upper block over that of the lower
   double poisson = 0.3;
   int order = 2;
   int intervals = 8;      ///< elements along the contact
   double end_ratio = 0.2; ///< end element over the middle one
   double flat = 1;        ///< width over height of the contact's middle elements
   double gap = 0;         ///< uniform gap over size
   double curved_gap = 0;  ///< gap at the corners over size, parabolic
   double balance = 1;     ///< share of the moment of "Q" that its pressure balances
};

/// Patterns "P", of resultant 2e-3 young·size, and "Q", with the same resultant along the
/// contact and the pressure that balances its moment about the contact. Moduli of 1e-3 strain
/// in the softer body.
cattaneo::ReducedProblem reduce_two_blocks(const TwoBlocks &scene, double friction);

} // namespace cattaneo_test
