#include <cattaneo/algebra/root.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

constexpr double eps = std::numeric_limits<double>::epsilon();

double dot(const NodeVector &a, const NodeVector &b)
{
   double sum = 0;
   for (Index k = 0; k < a.size(); ++k) { sum += a[k] * b[k]; }
   return sum;
}

/// A⁻¹ b by cofactors, so that a mirrored A and b give the mirrored answer to the last bit.
NodeVector solve(const NodeMatrix &A, const NodeVector &b)
{
   if (b.size() < 2) { return b.size() == 0 ? b : NodeVector(b / A(0, 0)); }
   const double det = A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0);
   return Vector2d((A(1, 1) * b[0] - A(0, 1) * b[1]) / det,
                   (A(0, 0) * b[1] - A(1, 0) * b[0]) / det);
}

/// The bound of a friction force that opposes this direction of slip.
double bound_against(const ContactNode &node, const NodeVector &way)
{
   return node.bound.at(node.p, way.size() == 2 ? 0.0 : way[0] > 0 ? 1.0 : -1.0);
}

/// The slip equation of the disc in the variable t = s/(s + k), 0 <= t <= 1, with k as large as
/// A. It is finite at both ends, and linear if A is a multiple of I.
struct SlipEquation
{
   const LoneNode &node;
   double k = 0.5 * node.A.trace();

   /// x = -(1-t) y with ((1-t) A + t k I) y = q0.
   NodeVector y(double t) const
   {
      return solve((1 - t) * node.A + t * k * NodeMatrix::Identity(2, 2), node.q0);
   }
   /// |q| less its bound.
   double operator()(double t) const
   {
      const NodeVector at = y(t);
      const double p = node.p0 - (1 - t) * dot(node.b, at);
      return k * t * std::hypot(at[0], at[1]) - node.bound.line(p);
   }
};

} // namespace

double magnitude(const NodeVector &x)
{
   const double other = x.size() > 1 ? x[1] : 0.0;
   return x.size() == 0 ? 0.0 : other == 0 ? std::abs(x[0]) : std::hypot(x[0], other);
}

FrictionBound::FrictionBound(const FrictionLaw &law)
   : lines_{piece_of(law.forward, 0), piece_of(law.backward, 0)},
     law_(law.forward.rows() > 1 || law.backward.rows() > 1 ? &law : nullptr)
{
}

FrictionBound::Line FrictionBound::piece_of(const Eigen::MatrixX2d &points, double p)
{
   const Index last = points.rows() - 1;
   Index k = 0;
   while (k < last && p > points(k, 0)) { ++k; }
   if (k == 0) { return {0, points(0, 1) / points(0, 0)}; }
   const double slope = (points(k, 1) - points(k - 1, 1)) / (points(k, 0) - points(k - 1, 0));
   return {points(k, 1) - slope * points(k, 0), slope};
}

FrictionBound FrictionBound::straight(double p) const
{
   FrictionBound result;
   result.lines_[0] = piece(p, 1);
   result.lines_[1] = piece(p, -1);
   return result;
}

FrictionBound FrictionBound::of_rates(double p) const
{
   FrictionBound result = straight(p);
   for (Line &line : result.lines_) { line.intercept = 0; }
   return result;
}

double FrictionBound::bend(double p, double way) const
{
   double found = std::copysign(std::numeric_limits<double>::infinity(), way);
   if (!law_) { return found; }
   for (const Eigen::MatrixX2d *points : {&law_->forward, &law_->backward})
   {
      // Beyond the last point the polyline goes straight on.
      for (Index k = 0; k + 1 < points->rows(); ++k)
      {
         const double at = (*points)(k, 0);
         if (way < 0 ? at <= p && at > found : at >= p && at < found) { found = at; }
      }
   }
   return found;
}

FrictionBound friction_bound(const ReducedProblem &problem, Index i)
{
   return problem.laws.empty() ? FrictionBound(problem.friction[i])
                               : FrictionBound(problem.laws[i]);
}

std::vector<FrictionBound> friction_bounds(const ReducedProblem &problem)
{
   std::vector<FrictionBound> bounds;
   for (Index i = 0; i < problem.nodes(); ++i) { bounds.push_back(friction_bound(problem, i)); }
   return bounds;
}

std::vector<FrictionBound> friction_bounds(const VectorXd &coefficients)
{
   std::vector<FrictionBound> bounds;
   for (double f : coefficients) { bounds.emplace_back(f); }
   return bounds;
}

NodeState friction_state(const ContactNode &node, double margin)
{
   const NodeVector trial = node.trial();
   if (trial.size() == 2)
   {
      const double size = std::hypot(trial[0], trial[1]);
      const bool sticks = size <= node.bound.at(node.p) + margin || size == 0;
      return sticks ? NodeState::stick : NodeState::slip;
   }
   if (trial[0] < -node.bound.at(node.p, 1) - margin) { return NodeState::forward_slip; }
   if (trial[0] > node.bound.at(node.p, -1) + margin) { return NodeState::backward_slip; }
   return NodeState::stick;
}

NodeState wanted_state(const ContactNode &node, NodeState now, double tiny, double tiny_along)
{
   if (!closed(now))
   {
      // A node that overlaps sticks first, because the direction of its slip is not known yet.
      return node.kn * node.gap < -tiny ? NodeState::stick : now;
   }
   if (node.p < -tiny) { return NodeState::separation; }
   if (node.q.size() == 0) { return now; }
   return friction_state(node, slips(now) ? -tiny_along : tiny_along);
}

NodeState fitting_state(const ContactNode &node, NodeState now, double allowed)
{
   if (!closed(now) || node.q.size() == 0) { return now; }
   const auto broken = [&](NodeState state)
   {
      if (state == NodeState::stick)
      {
         return std::max(magnitude(node.q) - bound_against(node, -node.q),
                         node.kt * magnitude(node.slip));
      }
      if (state == NodeState::slip) { return slip_violation(node); }
      const double way = sense(state);
      return std::max(std::abs(node.q[0] + way * node.bound.at(node.p, way)),
                      -way * node.kt * node.slip[0]);
   };
   double least = broken(now);
   if (least <= allowed) { return now; }
   const bool plane = node.q.size() == 1;
   for (const NodeState state :
        {NodeState::stick, plane ? NodeState::forward_slip : NodeState::slip,
         plane ? NodeState::backward_slip : NodeState::slip})
   {
      if (broken(state) >= least) { continue; }
      least = broken(state);
      now = state;
   }
   return now;
}

NodeState natural_state(const ContactNode &node)
{
   if (node.kn * node.gap > node.p) { return NodeState::separation; }
   return friction_state(node);
}

NodeResidual residual(const ContactNode &node)
{
   NodeResidual R{std::min(node.kn * node.gap, node.p), node.trial()};
   NodeVector &bounded = R.tangential;
   if (bounded.size() == 1)
   {
      bounded[0] = std::clamp(bounded[0], -node.bound.at(node.p, 1), node.bound.at(node.p, -1));
   }
   if (bounded.size() == 2)
   {
      const double size = std::hypot(bounded[0], bounded[1]), limit = node.bound.at(node.p);
      if (size > limit) { bounded *= limit / size; }
   }
   R.tangential = node.q - bounded;
   return R;
}

FrictionDerivative friction_derivative(const ContactNode &node)
{
   const NodeVector trial = node.trial();
   const Index c = trial.size();
   FrictionDerivative d{NodeMatrix::Identity(c, c), NodeVector::Zero(c), 0.0};
   const double size = magnitude(trial), limit = bound_against(node, -trial);
   if (size <= limit) { return d; }
   d.n = trial / size;
   d.P.setZero();
   d.slope = node.bound.derivative(node.p, c == 2 ? 0.0 : -d.n[0]);
   if (c == 2)
   {
      const DiscSlip to(trial, limit);
      d.P = to.share * to.t() * to.t().transpose();
   }
   return d;
}

DiscSlip::DiscSlip(const Vector2d &trial, double bound)
{
   const double length = std::hypot(trial[0], trial[1]);
   n = trial / length;
   share = std::min(bound / length, 1.0);
}

LoneNode lone_node(const ReducedProblem &problem, Index i)
{
   const Index n = problem.nodes(), c = problem.components();
   LoneNode node{NodeMatrix(c, c), NodeVector(c), problem.C()(i, i),
                 NodeVector(c),    0.0,           FrictionBound(problem.friction[i])};
   for (Index k = 0; k < c; ++k)
   {
      node.b[k] = problem.B()(i, k * n + i);
      for (Index l = 0; l < c; ++l) { node.A(k, l) = problem.A()(k * n + i, l * n + i); }
   }
   return node;
}

NodeMove solve_node(const LoneNode &node)
{
   const NodeVector free = solve(node.A, node.q0), lift = solve(node.A, node.b);
   const double frictionless = node.p0 - dot(node.b, free);
   NodeMove move{true, NodeState::stick, NodeVector::Zero(node.q0.size()), 0.0};
   if (frictionless < 0)
   {
      move.state = NodeState::separation;
      move.gap = -frictionless / (node.c - dot(node.b, lift));
      move.slip = -free - move.gap * lift;
      return move;
   }
   if (node.q0.size() == 0) { return move; }
   const auto presses = [&] { return node.p0 + dot(node.b, move.slip) >= 0; };
   if (node.q0.size() == 2)
   {
      if (magnitude(node.q0) <= node.bound.line(node.p0))
      {
         move.found = node.p0 >= 0;
         return move;
      }
      const SlipEquation equation{node};
      // A straight piece of a bent law may be below zero at this pressure, because the piece
      // belongs to other pressures. Its bound is then zero, and the node goes to another piece.
      const double t = equation(0) > 0 ? 0.0 : find_root(equation, 0, 1);
      move.state = NodeState::slip;
      move.slip = -(1 - t) * equation.y(t);
      move.found = presses();
      return move;
   }
   const auto reserve = [&](double sense)
   { return node.bound.reserve(node.q0[0], node.p0, sense); };
   if (node.p0 >= 0 && reserve(1) >= 0 && reserve(-1) >= 0) { return move; }
   for (const NodeState slip : {NodeState::forward_slip, NodeState::backward_slip})
   {
      const double s = sense(slip), slope = node.bound.slope(node.p0, s),
                   x = -s * reserve(s) / (node.A(0, 0) + s * slope * node.b[0]);
      move.slip[0] = x;
      move.state = slip;
      if (s * x > 0 && presses()) { return move; }
   }
   move.found = false;
   return move;
}

double critical_friction(const LoneNode &node)
{
   const double pull = magnitude(node.b);
   if (pull == 0) { return std::numeric_limits<double>::infinity(); }
   if (node.b.size() == 1) { return node.A(0, 0) / pull; }
   // With A in the axes of b and m = (1, -t)/√(1 + t²), t >= 0 on the side where A is least,
   // the ratio is (a - 2 h t + d t²)/(|b| √(1 + t²)). It is stationary where t³ + (2 - a/d) t =
   // 2 h/d, which has one such root.
   const double x = node.b[0] / pull, y = node.b[1] / pull,
                a = x * x * node.A(0, 0) + 2 * x * y * node.A(0, 1) + y * y * node.A(1, 1),
                d = node.A(0, 0) + node.A(1, 1) - a,
                h = std::abs(x * y * (node.A(1, 1) - node.A(0, 0)) +
                             (x * x - y * y) * node.A(0, 1)),
                linear = 2 - a / d, least = std::sqrt(std::max(0.0, -linear));
   const double t = find_root([&](double t) { return t * (t * t + linear) - 2 * h / d; }, least,
                              least + std::cbrt(2 * h / d));
   return (a - 2 * h * t + d * t * t) / (pull * std::sqrt(1 + t * t));
}

double slip_violation(const ContactNode &node, double uncertain)
{
   const double length = magnitude(node.slip),
                beyond = std::max(magnitude(node.q) - bound_against(node, -node.q), 0.0);
   if (length <= uncertain) { return beyond; }
   const double bound = bound_against(node, node.slip),
                off = magnitude(node.q + bound / length * node.slip) -
                      bound * (uncertain / length);
   return std::max(beyond, std::min(off, node.kt * length));
}

double slip_round_off(double size)
{
   return 4 * eps * size;
}

LawCheck check_laws(const ReducedProblem &problem, const VectorXd &v_old,
                    const ContactState &state, const VectorXd &forces, double allowed,
                    const VectorXd &round_off, const VectorXd &slip_error)
{
   const Index n = problem.nodes(), m = problem.slips(), c = problem.components();
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
   for (Index i = 0; i < n; ++i)
   {
      ContactNode node{
         NodeVector(c), NodeVector(c),     state.w[i] + problem.gap[i], forces[m + i],
         0.0,           problem.C()(i, i), friction_bound(problem, i)};
      double most = std::max(allowed, round_off[m + i]), size = 0, known_to = 0;
      note(check.normal, std::abs(node.p - state.p[i]), most);
      note(check.normal, std::abs(std::min(node.p, node.kn * node.gap)), most);
      if (c == 0) { continue; }
      most = std::max(allowed, node.bound.steepness(node.p) * round_off[m + i]);
      for (Index k = 0; k < c; ++k)
      {
         const Index row = k * n + i;
         most = std::max(most, round_off[row]);
         node.q[k] = forces[row];
         node.slip[k] = state.v[row] - v_old[row];
         node.kt = std::max(node.kt, problem.A()(row, row));
         size = std::max(size, std::abs(state.v[row]));
         if (slip_error.size()) { known_to = std::max(known_to, slip_error[row]); }
         note(check.tangential, std::abs(forces[row] - state.q[row]), most);
      }
      // An open node carries no force, and no other law holds for its slip.
      if (!closed(state.status[i])) { node.slip.setZero(); }
      check.tangential = std::max(check.tangential, slip_violation(node));
      judge(slip_violation(node, std::max(known_to, c == 2 ? slip_round_off(size) : 0.0)),
            most);
   }
   return check;
}

} // namespace cattaneo
