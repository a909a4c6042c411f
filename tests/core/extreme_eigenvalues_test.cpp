#include <Eigen/QR>
#include <cattaneo/algebra/extreme_eigenvalues.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Bounds on the right side of these eigenvalues, and near them in units of the largest.
void expect_ends(const MatrixXd &M, double smallest, double largest, const char *name)
{
   // Round-off of the entries moves both by so much.
   const double moved = 1e-15 * static_cast<double>(M.rows()) * largest;
   EXPECT_GE(largest_eigenvalue(M), largest - moved) << name;
   EXPECT_LE(largest_eigenvalue(M), largest * (1 + 1e-10)) << name;
   EXPECT_LE(smallest_eigenvalue(M), smallest + moved) << name;
   EXPECT_GE(smallest_eigenvalue(M), smallest - 1e-10 * largest) << name;
}

MatrixXd rotated(const VectorXd &eigenvalues)
{
   const Index n = eigenvalues.size();
   MatrixXd some(n, n);
   for (Index i = 0; i < n; ++i)
   {
      for (Index j = 0; j < n; ++j) { some(i, j) = std::sin(1.0 + 3.7 * i + 1.3 * i * j); }
   }
   const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(some).householderQ();
   const MatrixXd M = Q * eigenvalues.asDiagonal() * Q.transpose();
   return 0.5 * (M + M.transpose());
}

} // namespace

/// The chain of n equal springs between walls: 2 - 2 cos(kπ/(n + 1)).
TEST(ExtremeEigenvalues, OfAChainOfSprings)
{
   for (Index n : {1, 2, 7, 40, 300})
   {
      MatrixXd M = MatrixXd::Zero(n, n);
      M.diagonal().setConstant(2);
      if (n > 1)
      {
         M.diagonal(1).setConstant(-1);
         M.diagonal(-1).setConstant(-1);
      }
      const double angle = std::acos(-1.0) / static_cast<double>(n + 1);
      expect_ends(M, 2 - 2 * std::cos(angle), 2 + 2 * std::cos(angle), "chain");
   }
}

TEST(ExtremeEigenvalues, OfSpectraWithClustersAndDecades)
{
   const Index n = 120;
   VectorXd cluster = VectorXd::Ones(n), decades(n), near(n);
   cluster[0] = 3;
   for (Index i = 0; i < n; ++i)
   {
      decades[i] = std::pow(10, -8.0 * static_cast<double>(i) / (n - 1));
      near[i] = 1 + 1e-6 * static_cast<double>(i);
   }
   expect_ends(rotated(cluster), 1, 3, "cluster");
   expect_ends(rotated(decades), 1e-8, 1, "decades");
   expect_ends(rotated(near), 1, near.maxCoeff(), "near each other");
   expect_ends(MatrixXd::Identity(n, n), 1, 1, "identity");
}

/// Where the vectors end before the matrix does, round-off must not go on as a direction.
TEST(ExtremeEigenvalues, OfFewDistinctValues)
{
   for (Index n : {2, 3, 5, 8, 9, 17, 30, 60})
   {
      for (Index distinct : {1, 2, 3, 5, 9})
      {
         for (double scale : {1e-9, 1.0, 3.7e11})
         {
            VectorXd values(n);
            for (Index i = 0; i < n; ++i)
            {
               values[i] = scale * (1 + 0.73 * static_cast<double>(i % distinct));
            }
            const std::string name = std::to_string(distinct) + " of " + std::to_string(n);
            const double largest = values.maxCoeff();
            expect_ends(MatrixXd(values.asDiagonal()), scale, largest, name.c_str());
            expect_ends(rotated(values), scale, largest, name.c_str());
         }
      }
   }
}

TEST(ExtremeEigenvalues, NothingBelowZeroIsCalledPositive)
{
   VectorXd values = VectorXd::LinSpaced(50, 1, 2);
   for (double worst : {0.0, -1e-12, -1.0})
   {
      values[7] = worst;
      EXPECT_EQ(smallest_eigenvalue(rotated(values)), 0) << worst;
   }
   EXPECT_EQ(largest_eigenvalue(MatrixXd::Zero(5, 5)), 0);
   EXPECT_EQ(largest_eigenvalue(MatrixXd(0, 0)), 0);
}
