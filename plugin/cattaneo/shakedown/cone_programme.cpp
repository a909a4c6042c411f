#include <cattaneo/algebra/dense_lu.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

SlippedForces slipped_forces(const ReducedProblem &problem, const StuckForces &loads,
                             double theta, const Eigen::VectorXd &slip, Rounding rounding)
{
   const Eigen::Index n = problem.nodes();
   const Eigen::MatrixXd q = loads.q(theta).colwise() + Eigen::VectorXd(problem.A() * slip);
   SlippedForces forces{tangential_lengths(q, n),
                        loads.p(theta).colwise() + Eigen::VectorXd(problem.B() * slip)};
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
   forces.shear += tangential_lengths(error(loads.q0, loads.q1, problem.A()), n);
   forces.p -= error(loads.p0, loads.p1, problem.B());
   return forces;
}

double worst_violation(const ConeProgramme &programme, const ReducedProblem &problem,
                       double theta, const Eigen::VectorXd &slip, Rounding rounding)
{
   const auto [shear, p] = slipped_forces(problem, programme.loads, theta, slip, rounding);
   const Eigen::MatrixXd excess = shear - programme.friction.asDiagonal() * p;
   return (excess.array().colwise() / programme.force_scale.array()).maxCoeff();
}

namespace
{

/** The inverse Hessian of the barrier -log(o² - f²|s|²) of one cone of motions, for {o; s}:
   steps of length one in its norm stay inside. Nearly rank one at the surface of the cone, so
   that a motion there changes along itself only. */
Eigen::MatrixXd room(double friction, double opening, const Eigen::VectorXd &slip)
{
   Eigen::VectorXd x(1 + slip.size());
   x << opening, friction * slip;
   const double depth =
      (opening - x.tail(slip.size()).norm()) * (opening + x.tail(slip.size()).norm());
   Eigen::MatrixXd H = x * x.transpose();
   H(0, 0) -= 0.5 * depth;
   H.diagonal().tail(slip.size()).array() += 0.5 * depth;
   H.rightCols(slip.size()) /= friction;
   H.bottomRows(slip.size()) /= friction;
   return H;
}

/// Makes the motions of all vertices meet A Σslip + Bᵀ Σopening = 0 by the smallest changes in
/// the norm of their cones, shortened to leave them inside. False if there is no such change.
bool balance(const ConeProgramme &programme, CollapseMechanism &mechanism)
{
   const Eigen::Index n = programme.nodes(), c = programme.components(), m = n * c;
   const Eigen::Index vertices = programme.loads.vertices();
   const ResidualForces &residual = *programme.residual;
   const Eigen::Index rigid = residual.rigid.cols();
   const auto slip_of = [&](Eigen::Index i, Eigen::Index j)
   { return Eigen::VectorXd(mechanism.slip(Eigen::seqN(i, c, n), j)); };

   // In residual forces the condition is Σslip + Mᵀ Σopening = 0 but for a rigid motion.
   std::vector<Eigen::MatrixXd> rooms;
   Eigen::MatrixXd by_slip = Eigen::MatrixXd::Zero(m, m); // Mᵀ times rooms of opening by slip
   Eigen::VectorXd by_opening = Eigen::VectorXd::Zero(n);
   Eigen::MatrixXd of_slip = Eigen::MatrixXd::Zero(m, m);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      Eigen::MatrixXd total = Eigen::MatrixXd::Zero(1 + c, 1 + c);
      for (Eigen::Index j = 0; j < vertices; ++j)
      {
         rooms.push_back(room(programme.friction[i], mechanism.opening(i, j), slip_of(i, j)));
         total += rooms.back();
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
   right.col(0).head(m) =
      -unit.cwiseProduct(mechanism.slip.rowwise().sum() +
                         residual.transfer.transpose() * mechanism.opening.rowwise().sum());
   DenseLU factors;
   if (!factors.compute(normal)) { return false; }
   factors.solve(right);
   const Eigen::VectorXd force = unit.asDiagonal() * right.col(0).head(m);
   const Eigen::VectorXd pressure = residual.transfer * force;

   CollapseMechanism change{Eigen::MatrixXd(m, vertices), Eigen::MatrixXd(n, vertices)};
   double longest = 0;
   for (Eigen::Index i = 0; i < n; ++i)
   {
      Eigen::VectorXd pull(1 + c);
      pull << pressure[i], force(Eigen::seqN(i, c, n));
      for (Eigen::Index j = 0; j < vertices; ++j)
      {
         const Eigen::VectorXd step = rooms[i * vertices + j] * pull;
         longest = std::max(longest, pull.dot(step));
         change.opening(i, j) = step[0];
         change.slip(Eigen::seqN(i, c, n), j) = step.tail(c);
      }
   }
   const double share = std::min(1.0, 0.9 / std::sqrt(longest));
   if (!std::isfinite(share)) { return false; }
   mechanism.slip += share * change.slip;
   mechanism.opening += share * change.opening;
   return true;
}

} // namespace

double weak_duality_bound(const ConeProgramme &programme, const ReducedProblem &problem,
                          CollapseMechanism &mechanism, double slip_size)
{
   constexpr double none = std::numeric_limits<double>::infinity();
   constexpr double round_off = 1e-14; // of a sum, over the sum of its sizes
   const Eigen::Index n = programme.nodes();
   const Eigen::Index vertices = programme.loads.vertices();
   Eigen::MatrixXd &slip = mechanism.slip;
   Eigen::MatrixXd &opening = mechanism.opening;
   if (slip.cols() != vertices || !slip.allFinite() || !opening.allFinite()) { return none; }

   Eigen::VectorXd imbalance;
   double share = none; // of the largest imbalance in what is in balance
   constexpr double tiny = std::numeric_limits<double>::min();
   constexpr int max_rounds = 30;
   for (int round = 0;; ++round)
   {
      const Eigen::MatrixXd least =
         programme.friction.asDiagonal() * tangential_lengths(slip, n);
      opening = opening.cwiseMax(least * (1 + 1e-15));
      const Eigen::VectorXd slips = slip.rowwise().sum(), openings = opening.rowwise().sum();
      imbalance = problem.A() * slips + problem.B().transpose() * openings;
      const Eigen::VectorXd gross = problem.A().cwiseAbs() * slip.cwiseAbs().rowwise().sum() +
                                    problem.B().transpose().cwiseAbs() * openings;
      // Until it is round-off: small, and no longer halved.
      const double before = share;
      share = (imbalance.array().abs() / (gross.array() + tiny)).maxCoeff();
      if (share <= round_off || (share <= 1e-10 && share > 0.5 * before)) { break; }
      if (round == max_rounds || !balance(programme, mechanism)) { return none; }
   }

   const StuckForces &loads = programme.loads;
   const auto work = [&](const Eigen::MatrixXd &q, const Eigen::MatrixXd &p, double &gross)
   {
      const Eigen::MatrixXd by_slip = slip.cwiseProduct(q),
                            by_opening = opening.cwiseProduct(p);
      gross = by_slip.cwiseAbs().sum() + by_opening.cwiseAbs().sum();
      return by_slip.sum() + by_opening.sum();
   };
   double gross0 = 0, gross1 = 0;
   const double w0 = work(loads.q0, loads.p0, gross0), w1 = work(loads.q1, loads.p1, gross1);
   const double falls = -w1 - round_off * gross1;
   if (!(falls > 0)) { return none; }
   slip /= -w1;
   opening /= -w1;
   return (w0 + round_off * gross0 + imbalance.lpNorm<1>() * slip_size) / falls;
}

} // namespace cattaneo
