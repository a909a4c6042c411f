#pragma once

#include <cattaneo/condense/condense.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

/// Random trusses that touch along lines, and interfaces between them.
namespace cattaneo_test
{

extern std::mt19937 random_numbers;
double random_number(double low = -1, double high = 1);

class Interfaces : public testing::Test
{
   void SetUp() override { random_numbers.seed(7); } // whatever tests ran before
};

/** A body that no finite-element program made: points joined by bars, each to each, of random
    stiffnesses. Its points are the nodes of its lines, each once, and some more around a place.
    Rigid motions strain none. */
struct Truss
{
   std::vector<cattaneo::ContactLine> lines;
   std::vector<Eigen::Vector2d> points;
   std::vector<int> fixed; ///< dofs
   Eigen::MatrixXd K;
   std::vector<cattaneo::BodyLoad> loads;

   Truss(std::vector<cattaneo::ContactLine> sides, const Eigen::Vector2d &around,
         double stiffness = 1);
   int size() const { return static_cast<int>(K.rows()); }
   /// Fixes two points inside.
   Truss &hold();
   Truss &load(const std::string &name);
   Truss &lift(const std::string &name);
   cattaneo::CondensedBody condensed(const std::string &name = "",
                                     const cattaneo::CondensedBody *alike = nullptr) const;
};

/// Nodes of a line that stand at given places.
std::vector<int> at_places(const cattaneo::ContactLine &line,
                           const std::vector<Eigen::Vector2d> &places);

/** The whole of all bodies by Lagrange multipliers: rows of relative displacements, made of the
    dual functions and frames, tie all dofs of all bodies. Compares stiffness, loads, energies
    and fields of the reduction with it. `flip`: sides of the interfaces as (slave, master). */
void agrees_with_multipliers(const std::vector<Truss> &bodies, cattaneo::Reduction &reduction,
                             const std::vector<cattaneo::Interface> &interfaces,
                             double tolerance = 1e-9);

cattaneo::Interface between(int a, const cattaneo::ContactLine &one, int b,
                            const cattaneo::ContactLine &two,
                            cattaneo::SlaveSide slave = cattaneo::SlaveSide::first);

cattaneo::ContactLine side(const Eigen::Vector2d &from, const Eigen::Vector2d &to, int elements,
                           int order = 1);

} // namespace cattaneo_test
