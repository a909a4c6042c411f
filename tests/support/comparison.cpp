#include "comparison.hpp"

double largest(const Eigen::MatrixXd &x)
{
   return x.size() ? x.cwiseAbs().maxCoeff() : 0;
}

double difference(const Eigen::MatrixXd &a, const Eigen::MatrixXd &b)
{
   if (a.rows() != b.rows() || a.cols() != b.cols()) { return 1e300; }
   return largest(a - b) / std::max(1e-300, largest(b));
}

void expect_relative(double value, double expected, double tolerance)
{
   EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

std::string content(const std::string &file)
{
   std::ifstream in(file, std::ios::binary);
   EXPECT_TRUE(in.good()) << file;
   return {std::istreambuf_iterator<char>(in), {}};
}
