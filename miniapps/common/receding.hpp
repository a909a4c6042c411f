#pragma once

#include "common/scene.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace miniapp
{

/** The plane receding contact of thesis chapter 5: an elastic strip 0 < x < length, 0 < y < t
    on a similar half-plane: the half-plane itself, which has no mesh, or the block -side < x <
    length, -domain < y < 0, u_y = 0 at its bottom. A pressure p0 acts on the strip's top for x
    > n t. u_x = 0 at x = length (of both).

    Units t = p0 = E' = 1, E' = E/(1-ν²). Every overhang n has its own load pattern, see
    overhang_load(): the end of the load need not be a mesh line, so that one condensed pair
    serves all n. */
struct RecedingOptions
{
   double length = 100; ///< of the strip, in t
   double domain = 0;   ///< depth of the block, in t; 0: none, the half-plane itself
   double side = 0;     ///< of the block beyond the strip's end, in t; 0: the depth
   std::vector<double> overhangs = {4.0}; ///< n, in t
   int order = 2;
   double spacing =
      0.02; ///< of the contact nodes from the corner to beyond the edge of the load
   double corner = 0.0005; ///< of the contact nodes at the strip's end
   /// Growth of the elements away from the contact and the corner. Those of the strip are at
   /// most 0.4 (growth - 1) t high.
   double growth = 1.25;
   double poisson = 0.3;
   /// Grid lines of the contact from 0 to `length` in place of `spacing` and `corner`.
   std::vector<double> grid = {};
   /// Refines the mesh of a body (0 or 1) before it is made; both alike along the contact.
   std::function<void(mfem::Mesh &, int)> refine = {};

   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

Scene make_receding(const RecedingOptions &options);

/** Tractions along the bonded contact, as in a monolith: those that the clamped contact nodes
    carry. */
struct BondedTractions
{
   /// Strengths of the two singular terms of the Williams corner (rows), of pressure and shear
   /// (columns), fitted on 0.005 < x/t < 0.05, and the ratio of the first ones, which is 0.543;
   /// NaN where the mesh is too coarse to fit.
   Eigen::Matrix2d strengths;
   double corner_ratio = 0;
   double lowest_pressure = 0;
   /// Least friction for full adhesion: the largest of the corner's ratio (exact) and of |q|/p
   /// away from the corner; infinite if the bonded strip pulls somewhere.
   double adhesion_friction = 0;
   double adhesion_x = 0; ///< where that friction is needed (0: at the corner)
   Eigen::VectorXd p, q;  ///< tractions of the nodes
};

/// Name of the load pattern of an overhang.
std::string overhang_load(double overhang);

BondedTractions bonded_tractions(const cattaneo::ReducedProblem &problem, double overhang);

/// History of one point of the contact line while a load is reduced from its full value.
struct PointHistory
{
   /// @param positions of the nodes
   /// @param slip of the nodes under full load
   PointHistory(double xi, const Eigen::VectorXd &positions, const Eigen::VectorXd &slip);
   void note(double level, const Eigen::VectorXd &slip, cattaneo::NodeState status);

   double xi;
   Eigen::Index node = 0; ///< the nearest one
   std::vector<double> level = {0, 1}, slip = {0};
   double slips_from = std::numeric_limits<double>::quiet_NaN(),
          separates_at = std::numeric_limits<double>::quiet_NaN();
   double step = 0; ///< half of the largest step of the level, the uncertainty of both

private:
   double interpolated(const Eigen::VectorXd &of) const;
   Eigen::VectorXd positions_;
};

} // namespace miniapp
