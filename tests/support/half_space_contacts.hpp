#pragma once

#include <algorithm>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <vector>

namespace cattaneo_test
{

using Places = Eigen::MatrixX2d;

cattaneo::Material of_shear(double shear_modulus, double poisson);

/// Centres of the m × m cells about a middle that lie within a radius of it.
Places cells(int m, double edge, double radius, const Eigen::Vector2d &middle = {0, 0});

/// A contact of square cells with these centres. Without `other` the other body is rigid.
cattaneo::HalfSpace contact_of(const cattaneo::Material &material,
                               std::optional<cattaneo::Material> other, double edge,
                               Places centres);

/** A disc about x = y = 0, cut into 6 m² triangles between m rings, of which the inner vertices
    are moved by up to a fifth of the way between rings, always in the same way. Without another
    body it is rigid. */
cattaneo::HalfSpace disc_of_triangles(const cattaneo::Material &material,
                                      std::optional<cattaneo::Material> other, int rings,
                                      double radius);

/// Means of x² + y² over the triangles: exact by the middles of their edges.
Eigen::VectorXd mean_square(const cattaneo::HalfSpace &contact);

int number_of(const cattaneo::ContactState &state, cattaneo::NodeState status);
int number_closed(const cattaneo::ContactState &state);
double conjugate(const cattaneo::ReducedProblem &problem, const cattaneo::ContactState &state,
                 const char *load);

/// From one point of a history to the next by equal increments.
cattaneo::MarchReport marched(const cattaneo::ReducedProblem &problem,
                              const std::vector<cattaneo::NamedLoads> &points,
                              cattaneo::ContactState &state, int increments = 1);

/// A rigid sphere and a half-space, CONTACT's example "spence35": 45 cells along each side from
/// -4.4999 on, of which those within a radius may touch. The others stay open and say nothing.
cattaneo::ReducedProblem kalkers_spence(double radius);

/// How many dense factors increments took, by the counters after each.
struct FactorsOfIncrements
{
   long most = 0, all = 0, increments = 0;
   void note(const cattaneo::Counters &counters)
   {
      const long taken = counters.dense_factorisations - all;
      most = std::max(most, taken);
      all = counters.dense_factorisations;
      ++increments;
   }
   double mean() const { return static_cast<double>(all) / static_cast<double>(increments); }
};

/** Two equal spheres of shear modulus 1 and ν = 0 that touch in r < a = 1, pressed and sheared
    there and back. Hertz' approach a²/R; Cattaneo's and Mindlin's stick radius c = a (1-s)^⅓, s
    = Q/fP, and shift (3fP/16a) Σ(2-ν)/G (1 - (1-s)^⅔); unloading and loss by Masing. Each leg
    is one increment: slip keeps its direction, so that it is exact. */
struct ShearedSpheres
{
   double approach = 0, loading = 0, unloading = 0, loss = 0; ///< shares of the closed forms
};
ShearedSpheres sheared_spheres(int cells_across);

} // namespace cattaneo_test
