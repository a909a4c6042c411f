#include <algorithm>
#include <cattaneo/friction/contact_laws.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Of one or two entries, without overflow. (Not `size`: of an expression that would be
/// Eigen's, the number of its entries.)
double magnitude(const NodeVector &x)
{
   const double other = x.size() > 1 ? x[1] : 0.0;
   return other == 0 ? std::abs(x[0]) : std::hypot(x[0], other);
}

} // namespace

RoundOff::RoundOff(const Eigen::Ref<const MatrixXd> &K) : K_(K)
{
   VectorXd sums = VectorXd::Zero(K.rows()); // by columns: K is symmetric
   for (Index j = 0; j < K.cols(); ++j) { sums[j] = K.col(j).cwiseAbs().sum(); }
   norm_ = sums.maxCoeff();
   graded_ = K.diagonal().minCoeff() < 1e-4 * K.diagonal().maxCoeff();
}

VectorXd RoundOff::rows(const VectorXd &size, const VectorXd &f) const
{
   if (!graded_)
   {
      const double largest = f.cwiseAbs().maxCoeff(), all = norm_ * size.maxCoeff() + largest;
      // Where that is much, it is worth knowing better.
      if (4 * eps * all <= 1e-11 * largest)
      {
         return VectorXd::Constant(K_.rows(), 4 * eps * all);
      }
   }
   VectorXd sum = f.cwiseAbs();
   for (Index j = 0; j < K_.cols(); ++j)
   {
      if (size[j] != 0) { sum += size[j] * K_.col(j).cwiseAbs(); }
   }
   return 4 * eps * sum;
}

double slip_violation(const NodeVector &q, const NodeVector &x, double k, double bound,
                      double uncertain)
{
   const double beyond = std::max(magnitude(q) - bound, 0.0), length = magnitude(x);
   if (length == 0) { return beyond; }
   const double off = magnitude(q + bound / length * x) - bound * (uncertain / length);
   return std::max(beyond, std::min(off, k * length));
}

double slip_round_off(double size)
{
   return 4 * eps * size;
}

LawCheck check_laws(const ReducedProblem &problem, const VectorXd &v_old,
                    const ContactState &state, const VectorXd &forces, double allowed,
                    const VectorXd &round_off)
{
   const Index n = problem.nodes(), m = problem.slips(), c = problem.components();
   const auto q = forces.head(m), p = forces.tail(n);
   LawCheck check;
   const auto judge = [&](double violation, double limit)
   {
      if (!(violation <= limit)) { check.obeyed = false; } // nor if it is not a number
   };
   const auto note = [&](double &largest, double violation, double limit)
   {
      largest = std::max(largest, violation);
      judge(violation, limit);
   };
   NodeVector q_i(c), x_i(c);
   for (Index i = 0; i < n; ++i)
   {
      const double gap = problem.C()(i, i) * (state.w[i] + problem.gap[i]);
      const double limit = std::max(allowed, round_off[m + i]);
      note(check.normal, std::abs(p[i] - state.p[i]), limit);
      note(check.normal, std::abs(std::min(p[i], gap)), limit);
      if (c == 0) { continue; }
      const double bound = problem.friction[i] * std::max(p[i], 0.0);
      double most = std::max(allowed, problem.friction[i] * round_off[m + i]), size = 0;
      for (Index k = 0; k < c; ++k)
      {
         const Index row = k * n + i;
         most = std::max(most, round_off[row]);
         q_i[k] = q[row];
         x_i[k] = state.v[row] - v_old[row];
         size = std::max(size, std::abs(state.v[row]));
         note(check.tangential, std::abs(q[row] - state.q[row]), most);
      }
      if (!closed(state.status[i])) { x_i.setZero(); } // no law but that it bears nothing
      const double k = c == 2 ? std::max(problem.A()(i, i), problem.A()(n + i, n + i))
                              : problem.A()(i, i),
                   uncertain = c == 2 ? slip_round_off(size) : 0.0;
      const double violation = slip_violation(q_i, x_i, k, bound);
      check.tangential = std::max(check.tangential, violation);
      judge(c == 2 ? slip_violation(q_i, x_i, k, bound, uncertain) : violation, most);
   }
   return check;
}

} // namespace cattaneo
