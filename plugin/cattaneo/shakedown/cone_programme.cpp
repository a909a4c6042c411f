#include <algorithm>
#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace cattaneo
{

Eigen::MatrixXd ConeProgramme::bound(double theta, const Eigen::MatrixXd &p) const
{
   Eigen::MatrixXd bound = friction.cwiseProduct(p);
   if (strength0.size()) { bound += strength0; }
   if (strength1.size()) { bound += theta * strength1; }
   return bound;
}

Eigen::MatrixXd ConeProgramme::skewed(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p) const
{
   return skew.size() ? Eigen::MatrixXd(q + skew.cwiseProduct(p)) : q;
}

ConeProgramme friction_cones(const ReducedProblem &problem, const StuckForces &loads)
{
   const Eigen::Index n = problem.nodes(), vertices = loads.vertices();
   ConeProgramme programme;
   if (problem.laws.empty())
   {
      programme.friction = problem.friction.replicate(1, vertices);
      programme.loads = loads;
      return programme;
   }
   Eigen::Index most = 0; // pieces
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const FrictionLaw &law = problem.laws[i];
      require(
         law.concave(), "shakedown: the law of friction of node ", i,
         " has a piece that is steeper than the one before it, must be concave: limits can "
         "be computed for no other law");
      most = std::max({most, law.forward.rows(), law.backward.rows()});
   }
   const Eigen::Index columns = most * vertices;
   programme.friction.resize(n, columns);
   // With two components a law is the same to all sides.
   const bool skewed = problem.components() == 1;
   if (skewed) { programme.skew.resize(n, columns); }
   programme.strength0.resize(n, columns);
   programme.strength1 = Eigen::MatrixXd::Zero(n, columns);
   programme.loads = {loads.q0.replicate(1, most), loads.q1.replicate(1, most),
                      loads.p0.replicate(1, most), loads.p1.replicate(1, most)};
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const FrictionBound bound = friction_bound(problem, i);
      const FrictionLaw &law = problem.laws[i];
      for (Eigen::Index k = 0; k < most; ++k)
      {
         // -(slope p + intercept of forward) ≤ q ≤ the same of backward: half their sum about
         // half their difference, of which the part without p is a force. The piece before a
         // point is the one at it; where one bound has fewer, its last counts again.
         const double f = law.forward(std::min(k, law.forward.rows() - 1), 0),
                      b = law.backward(std::min(k, law.backward.rows() - 1), 0);
         const auto part = Eigen::seqN(k * vertices, vertices);
         programme.friction(i, part).setConstant(0.5 *
                                                 (bound.slope(f, 1) + bound.slope(b, -1)));
         programme.strength0(i, part).setConstant(
            0.5 * (bound.intercept(f, 1) + bound.intercept(b, -1)));
         if (!skewed) { continue; }
         programme.skew(i, part).setConstant(0.5 * (bound.slope(f, 1) - bound.slope(b, -1)));
         programme.loads.q0(i, part).array() +=
            0.5 * (bound.intercept(f, 1) - bound.intercept(b, -1));
      }
   }
   return programme;
}

Eigen::MatrixXd ConeMechanism::opening(const ConeProgramme &programme) const
{
   const Eigen::MatrixXd by_limit = programme.friction.cwiseProduct(limit);
   return programme.skew.size() ? by_limit + programme.skew.cwiseProduct(slip) : by_limit;
}

CollapseMechanism ConeMechanism::at_vertices(const ConeProgramme &programme,
                                             Eigen::Index vertices) const
{
   const Eigen::MatrixXd openings = opening(programme);
   CollapseMechanism sums{slip.leftCols(vertices), openings.leftCols(vertices)};
   for (Eigen::Index first = vertices; first < slip.cols(); first += vertices)
   {
      sums.slip += slip.middleCols(first, vertices);
      sums.opening += openings.middleCols(first, vertices);
   }
   return sums;
}

SlippedForces slipped_forces(const ReducedProblem &problem, const StuckForces &loads,
                             double theta, const Eigen::VectorXd &slip, Rounding rounding)
{
   SlippedForces forces{loads.q(theta).colwise() + Eigen::VectorXd(problem.A() * slip),
                        loads.p(theta).colwise() + Eigen::VectorXd(problem.B() * slip),
                        Eigen::MatrixXd::Zero(loads.q0.rows(), loads.vertices()),
                        Eigen::MatrixXd::Zero(loads.p0.rows(), loads.vertices())};
   if (rounding == Rounding::ignored) { return forces; }
   // A sum of k terms is wrong by at most k units of round-off of the sum of their sizes; here
   // they are the slips, the loads' two parts and their product with θ.
   const double share =
      static_cast<double>(slip.size() + 4) * std::numeric_limits<double>::epsilon();
   const auto error = [&](const Eigen::MatrixXd &constant, const Eigen::MatrixXd &varying,
                          const auto &stiffness)
   {
      const Eigen::MatrixXd of_loads =
         constant.cwiseAbs() + std::abs(theta) * varying.cwiseAbs();
      const Eigen::VectorXd of_slip = stiffness.cwiseAbs() * slip.cwiseAbs();
      return Eigen::MatrixXd(share * (of_loads.colwise() + of_slip));
   };
   forces.q_error = error(loads.q0, loads.q1, problem.A());
   forces.p_error = error(loads.p0, loads.p1, problem.B());
   return forces;
}

double worst_violation(const ConeProgramme &programme, const ReducedProblem &problem,
                       double theta, const Eigen::VectorXd &slip, Rounding rounding)
{
   const Eigen::Index n = programme.nodes();
   const SlippedForces at = slipped_forces(problem, programme.loads, theta, slip, rounding);
   const Eigen::MatrixXd skew = programme.skew.cwiseAbs();
   const double side = rounding == Rounding::in_favour ? -1 : 1;
   Eigen::MatrixXd excess = tangential_lengths(programme.skewed(at.q, at.p), n) +
                            side * tangential_lengths(at.q_error, n) -
                            programme.bound(theta, at.p - side * at.p_error);
   if (skew.size()) { excess += side * skew.cwiseProduct(at.p_error); }
   if (rounding != Rounding::ignored && programme.strength0.size())
   {
      excess +=
         side * 4 * std::numeric_limits<double>::epsilon() *
         (programme.strength0.cwiseAbs() + std::abs(theta) * programme.strength1.cwiseAbs());
   }
   return (excess.array().colwise() / programme.force_scale.array()).maxCoeff();
}

namespace
{

/** The inverse Hessian of the barrier -log(t² - |s|²) of one cone of motions, for {t; s}:
    steps of length one in its norm stay inside. Nearly rank one at the surface of the cone, so
    that a motion there changes along itself only. */
Eigen::MatrixXd room(double limit, const Eigen::VectorXd &slip)
{
   Eigen::VectorXd x(1 + slip.size());
   x << limit, slip;
   const double depth = (limit - slip.norm()) * (limit + slip.norm());
   Eigen::MatrixXd H = x * x.transpose();
   H(0, 0) -= 0.5 * depth;
   H.diagonal().tail(slip.size()).array() += 0.5 * depth;
   return H;
}

/// Makes the motions of all columns meet A Σslip + Bᵀ Σopening = 0 by the smallest changes in
/// the norm of their cones. Changes are scaled down where needed, so that the motions stay
/// inside the cones. False if there is no such change.
bool balance(const ConeProgramme &programme, ConeMechanism &mechanism)
{
   const Eigen::Index n = programme.nodes(), c = programme.components(), m = n * c;
   const Eigen::Index columns = programme.loads.vertices();
   const ResidualForces &residual = *programme.residual;
   const Eigen::Index rigid = residual.rigid.cols();
   // The matrix from {limit; slip} of node i and column j to {opening; slip}.
   const auto motion = [&](Eigen::Index i, Eigen::Index j)
   {
      Eigen::MatrixXd G = Eigen::MatrixXd::Identity(1 + c, 1 + c);
      G(0, 0) = programme.friction(i, j);
      if (programme.skew.size()) { G(0, 1) = programme.skew(i, j); }
      return G;
   };

   // In residual forces the condition is Σslip + Mᵀ Σopening = 0 except for a rigid motion.
   std::vector<Eigen::MatrixXd> rooms; // of {limit; slip}, by pulls on {opening; slip}
   Eigen::MatrixXd by_slip = Eigen::MatrixXd::Zero(m, m); // Mᵀ times their rows of opening
   Eigen::VectorXd by_opening = Eigen::VectorXd::Zero(n);
   Eigen::MatrixXd of_slip = Eigen::MatrixXd::Zero(m, m);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      Eigen::MatrixXd total = Eigen::MatrixXd::Zero(1 + c, 1 + c);
      for (Eigen::Index j = 0; j < columns; ++j)
      {
         const Eigen::MatrixXd G = motion(i, j);
         rooms.push_back(room(mechanism.limit(i, j), mechanism.slip(Eigen::seqN(i, c, n), j)) *
                         G.transpose());
         total += G * rooms.back();
      }
      by_opening[i] = total(0, 0);
      for (Eigen::Index k = 0; k < c; ++k)
      {
         by_slip.col(k * n + i) = residual.transfer.row(i).transpose() * total(0, 1 + k);
         for (Eigen::Index l = 0; l < c; ++l)
         {
            of_slip(k * n + i, l * n + i) = total(1 + k, 1 + l);
         }
      }
   }
   Eigen::MatrixXd normal(m + rigid, m + rigid);
   normal.setZero();
   normal.topLeftCorner(m, m) =
      of_slip + by_slip + by_slip.transpose() +
      residual.transfer.transpose() * by_opening.asDiagonal() * residual.transfer;
   const Eigen::VectorXd unit = normal.diagonal()
                                   .head(m)
                                   .cwiseMax(std::numeric_limits<double>::min())
                                   .cwiseSqrt()
                                   .cwiseInverse();
   normal.topLeftCorner(m, m) =
      unit.asDiagonal() * normal.topLeftCorner(m, m) * unit.asDiagonal();
   // Motions of the surface leave it nearly singular; repetition makes up for the difference.
   normal.diagonal().head(m).array() += 1e-12;
   Eigen::MatrixXd border = unit.asDiagonal() * residual.rigid;
   border.colwise().normalize();
   normal.topRightCorner(m, rigid) = border;
   normal.bottomLeftCorner(rigid, m) = border.transpose();
   Eigen::MatrixXd right = Eigen::MatrixXd::Zero(m + rigid, 1);
   right.col(0).head(m) = -unit.cwiseProduct(mechanism.slip.rowwise().sum() +
                                             residual.transfer.transpose() *
                                                mechanism.opening(programme).rowwise().sum());
   DenseLU factors;
   if (!factors.compute(normal)) { return false; }
   factors.solve(right);
   const Eigen::VectorXd force = unit.asDiagonal() * right.col(0).head(m);
   const Eigen::VectorXd pressure = residual.transfer * force;

   ConeMechanism change{Eigen::MatrixXd(m, columns), Eigen::MatrixXd(n, columns)};
   double longest = 0;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      Eigen::VectorXd pull(1 + c);
      pull << pressure[i], force(Eigen::seqN(i, c, n));
      for (Eigen::Index j = 0; j < columns; ++j)
      {
         const Eigen::VectorXd step = rooms[i * columns + j] * pull;
         longest = std::max(longest, pull.dot(motion(i, j) * step));
         change.limit(i, j) = step[0];
         change.slip(Eigen::seqN(i, c, n), j) = step.tail(c);
      }
   }
   const double share = std::min(1.0, 0.9 / std::sqrt(longest));
   if (!std::isfinite(share)) { return false; }
   mechanism.slip += share * change.slip;
   mechanism.limit += share * change.limit;
   return true;
}

constexpr double none = std::numeric_limits<double>::infinity();

/// The bound of weak_duality_bound() by a mechanism that is repaired as it is. NaN if it cannot
/// be repaired.
double bound_once_repaired(const ConeProgramme &programme, const ReducedProblem &problem,
                           ConeMechanism &mechanism, double slip_size)
{
   constexpr double round_off = 1e-14; // of a sum, over the sum of its sizes
   const Eigen::Index n = programme.nodes();
   Eigen::MatrixXd &slip = mechanism.slip;
   Eigen::MatrixXd &limit = mechanism.limit;

   Eigen::MatrixXd opening;
   Eigen::VectorXd imbalance;
   double share = none; // of the largest imbalance, relative to the terms that balance
   constexpr double tiny = std::numeric_limits<double>::min();
   constexpr int max_rounds = 30;
   for (int round = 0;; ++round)
   {
      limit = limit.cwiseMax(tangential_lengths(slip, n) * (1 + 1e-15));
      opening = mechanism.opening(programme);
      const Eigen::VectorXd slips = slip.rowwise().sum(), openings = opening.rowwise().sum();
      imbalance = problem.A() * slips + problem.B().transpose() * openings;
      const Eigen::VectorXd gross =
         problem.A().cwiseAbs() * slip.cwiseAbs().rowwise().sum() +
         problem.B().transpose().cwiseAbs() * opening.cwiseAbs().rowwise().sum();
      // Until it is round-off: small, and no longer halved.
      const double before = share;
      share = (imbalance.array().abs() / (gross.array() + tiny)).maxCoeff();
      if (share <= round_off || (share <= 1e-10 && share > 0.5 * before)) { break; }
      if (round == max_rounds || !balance(programme, mechanism)) { return std::nan(""); }
   }

   const StuckForces &loads = programme.loads;
   const auto work = [&](const Eigen::MatrixXd &q, const Eigen::MatrixXd &p,
                         const Eigen::MatrixXd &strength, double &gross)
   {
      const Eigen::MatrixXd by_slip = slip.cwiseProduct(q),
                            by_opening = opening.cwiseProduct(p);
      Eigen::MatrixXd by_limit = Eigen::MatrixXd::Zero(n, limit.cols());
      if (strength.size()) { by_limit = limit.cwiseProduct(strength); }
      gross =
         by_slip.cwiseAbs().sum() + by_opening.cwiseAbs().sum() + by_limit.cwiseAbs().sum();
      return by_slip.sum() + by_opening.sum() + by_limit.sum();
   };
   double gross0 = 0, gross1 = 0;
   const double w0 = work(loads.q0, loads.p0, programme.strength0, gross0),
                w1 = work(loads.q1, loads.p1, programme.strength1, gross1);
   const double falls = -w1 - round_off * gross1;
   if (!(falls > 0)) { return none; }
   slip /= -w1;
   limit /= -w1;
   return (w0 + round_off * gross0 + imbalance.lpNorm<1>() * slip_size) / falls;
}

} // namespace

double weak_duality_bound(const ConeProgramme &programme, const ReducedProblem &problem,
                          ConeMechanism &mechanism, double slip_size)
{
   if (mechanism.slip.cols() != programme.loads.vertices() || !mechanism.slip.allFinite() ||
       !mechanism.limit.allFinite())
   {
      return none;
   }
   // At the surface of its cones a mechanism has no room for its repair, and interior points
   // come nearer to the surface than their equations are in balance. A mechanism is repaired as
   // it is given and from inside of its cones by a share of its limits, which costs about that
   // share of the works. The share is as small as the repair allows.
   const ConeMechanism given = mechanism;
   double best = bound_once_repaired(programme, problem, mechanism, slip_size);
   for (double inward = 1e-10; inward < 2e-5; inward *= 10)
   {
      ConeMechanism moved{given.slip, given.limit * (1 + inward)};
      const double bound = bound_once_repaired(programme, problem, moved, slip_size);
      if (std::isnan(bound)) { continue; }
      if (!(best <= bound))
      {
         best = bound;
         mechanism = moved;
      }
      break;
   }
   return std::isnan(best) ? none : best;
}

} // namespace cattaneo
