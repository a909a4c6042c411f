#pragma once

#include "comparison.hpp"
#include "expect_input_error.hpp"

#include <Eigen/Dense>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <mfem.hpp>
#include <random>

/// Meshes and dense reference algebra that several test files share.
namespace support
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd dense(const mfem::SparseMatrix &K);

std::vector<double> uniform(double from, double to, int n);

/// Boundary attributes of a rectangle.
constexpr int bottom = 1, right = 2, top = 3, left = 4;

/// Rectangle [0, 2] × [0, 1].
mfem::Mesh block(const std::string &kind, int nx = 4, int ny = 3);

void rotate(mfem::Mesh &mesh, double angle);

/// Full dense system of a body, split into interior, prescribed and contact dofs.
struct Split
{
   MatrixXd K;
   std::vector<int> I, D, C;
   MatrixXd R; ///< {v; w} = R {x of all; y of all}

   Split(const cattaneo::ElasticBody &body, const cattaneo::ContactLine &line);
   MatrixXd block(const std::vector<int> &rows, const std::vector<int> &cols) const;
};

} // namespace support
