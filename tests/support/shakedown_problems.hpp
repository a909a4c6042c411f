#pragma once

#include <algorithm>
#include <cattaneo/shakedown/limit.hpp>
#include <cmath>
#include <limits>
#include <random>

/// Reduced problems and brute-force answers for the tests of the shakedown limits.
namespace shakedown_test
{

using namespace cattaneo;

Eigen::MatrixXd random_matrix(std::mt19937 &random, Eigen::Index rows, Eigen::Index cols);

/** A random coupled contact of @a n nodes with @a c tangential components: patterns "press"
    (positive pressures), "shear" and "twist". @a rigid: a free body, with tangential and normal
    translations (and, for n > 2, a rotation) that cost nothing. */
ReducedProblem random_contact(unsigned seed, Eigen::Index n, Eigen::Index c, bool rigid);

/** Like a square punch on an elastic half-plane: stiffness of the two half-planes' type on a
    mesh that is graded to both edges, a coupling like that of dissimilar materials, tractions
    that are smooth. Zero tangential and normal translations. */
ReducedProblem punch_like(Eigen::Index n, double coupling = 0.1);

/// A cycle of random vertices around a constant first pattern.
LoadCycle random_cycle(unsigned seed, Eigen::Index patterns, Eigen::Index vertices);

/// A contact and its loads.
struct RandomLimit
{
   ReducedProblem problem;
   LoadCycle cycle;
};

/** A limit of any kind: with and without coupling, up to one so strong that friction wedges the
    contact and nothing limits the load; bodies held or free; friction from 0.05 to 5, one
    coefficient or many; constant loads that press everywhere, somewhere or nowhere, with shear
    from none to more than friction can hold; load varying to and fro, from zero, once or round
    a polygon, with or without changes of pressure; forces and lengths in any unit. */
RandomLimit random_limit(unsigned seed, Eigen::Index components);

/** The largest λ of a linear programme with one tangential component by brute force: every
    corner of the admissible set of (λ, v) is the meeting of as many conditions as there are
    unknowns.
    @a n at most 3. A rigid slip is fixed by holding node 0. */
double brute_force_load(const ReducedProblem &problem, const LoadCycle &cycle);

} // namespace shakedown_test
