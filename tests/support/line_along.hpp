#pragma once

#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <functional>
#include <limits>

namespace cattaneo_test
{

using Curve = std::function<Eigen::Vector2d(double)>;

/** The trace of a body along a curve, on its left as the parameter grows, with elements of one
    order that end at the given parameters. Nodes lie on the curve; weights, tangents and arc
    lengths are those of the elements. A node at r = 0 of a body of revolution is left out. */
cattaneo::ContactLine
line_along(const Curve &curve, const std::vector<double> &grid, int order,
           cattaneo::Formulation formulation = cattaneo::Formulation::plane, int first_dof = 0);

/// From one point to another, the parameter from 0 to 1.
Curve straight(const Eigen::Vector2d &from, const Eigen::Vector2d &to);

/// About a point, the parameter is the angle.
Curve circle(const Eigen::Vector2d &centre, double radius, bool clockwise = false);

std::vector<double> uniform_grid(double from, double to, int elements);

} // namespace cattaneo_test
