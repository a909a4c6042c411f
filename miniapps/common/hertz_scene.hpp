#pragma once

#include "common/scene.hpp"

#include <cattaneo/friction/contact_state.hpp>

#include <functional>
#include <vector>

namespace miniapp
{

/** Two half-planes of the same material, a pad above (body 1) and a specimen below. They have
    no mesh: the specimen is held, the pad takes the loads. Or they are blocks, both free under
    loads in equilibrium, of which body 2 is body 1 turned by 180°. The gap is zero, and is set
    in the reduced problem. Any consistent units.

    Load patterns: "P", the normal force `load`; "Q", a shear of the same resultant, +x on the
    pad, on blocks with the pressure that balances its moment; "bulk" and "bulk pad" if asked
    for, unit tension along x in the specimen and in the pad, which are blocks then. */
struct HalfPlanes
{
   int order = 2;
   int nodes = 101;         ///< contact nodes; (nodes - 1) a multiple of the order
   double half_width = 1.0; ///< expected half-width of the contact, the unit of the next two
   double span = 1.67;      ///< half-width of the contact candidates
   double domain = 0; ///< half-width and depth of each block; 0: the half-planes themselves
   cattaneo::Material material;
   double load = 1.0; ///< per unit thickness
   bool bulk = false, bulk_pad = false;
   double growth =
      0; ///< of the elements away from the contact; 0: the default of element_growth()
   /// Grid lines of the contact (symmetric, increasing) in place of `nodes` and `span`.
   std::vector<double> grid = {};

   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

/// Square block of side 2 on a half-plane without a mesh, or on a block that is held at its
/// bottom. Loads as above; the support carries those of the specimen.
struct BlockOnHalfPlane
{
   int order = 2;
   int nodes = 101;
   double domain = 0;
   cattaneo::Material material;
   double load = 1.0;
};

Scene make_scene(const HalfPlanes &options);
Scene make_scene(const BlockOnHalfPlane &options);

/// Peak pressure: top of the parabola p²(x) (exact for Hertz) fitted within half a half-width
/// of the largest nodal value, with the nodes' weights. Nodal values of quadratic elements
/// alternate about the smooth profile, by 0.03 % at 101 nodes, in the proportion of their
/// weights.
double peak_pressure(const cattaneo::ReducedProblem &problem,
                     const cattaneo::ContactState &state, double half_width);

/// Deviation of nodal tractions from a closed form, in units of `scale`.
struct Deviation
{
   double largest =
      0; ///< of any node; at the edge it depends on where the edge lies in its element
   double mean = 0; ///< root of the mean square over the contact line
};

Deviation deviation(const cattaneo::ReducedProblem &problem,
                    const Eigen::VectorXd &nodal_forces, double scale,
                    const std::function<double(double)> &exact);

} // namespace miniapp
