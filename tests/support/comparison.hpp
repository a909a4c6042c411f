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

/// Largest absolute value of the entries, 0 if there are none.
double largest(const Eigen::MatrixXd &x);

/// Largest entry of a - b, relative to the largest of b.
double difference(const Eigen::MatrixXd &a, const Eigen::MatrixXd &b);

void expect_relative(double value, double expected, double tolerance = 1e-8);

/// Content of a file, which must be there.
std::string content(const std::string &file);
