#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <string>

constexpr double pi = 3.14159265358979323846;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Of absolute value; 0 of nothing.
inline double largest(const Eigen::MatrixXd &x)
{
   return x.size() ? x.cwiseAbs().maxCoeff() : 0;
}

/// Largest entry of a - b, relative to the largest of b.
inline double difference(const Eigen::MatrixXd &a, const Eigen::MatrixXd &b)
{
   if (a.rows() != b.rows() || a.cols() != b.cols()) { return 1e300; }
   return largest(a - b) / std::max(1e-300, largest(b));
}

inline void expect_relative(double value, double expected, double tolerance = 1e-8)
{
   EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

/// Of a file, which must be there.
inline std::string content(const std::string &file)
{
   std::ifstream in(file, std::ios::binary);
   EXPECT_TRUE(in.good()) << file;
   return {std::istreambuf_iterator<char>(in), {}};
}
