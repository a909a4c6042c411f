// The laws of contact and friction as one equation, the natural map: its residual, and Newton's
// method with a line search where active sets cycle.

#include <algorithm>
#include <cattaneo/friction/friction_implementation.hpp>
#include <cmath>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Zero in a solution, else forces: q less the trial force q - k x brought into the friction
/// bound, and the smaller of k gap and p. Alart and Curnier, with each node's own stiffness k.
VectorXd FrictionSolver::Implementation::natural_map() const
{
   VectorXd R(F.size());
   for (Index i = 0; i < n; ++i) { R[m(i)] = std::min(knn[i] * gap(i), F[m(i)]); }
   for (Index i = 0; !frictionless && i < n; ++i)
   {
      const double limit = bound(i);
      if (disc())
      {
         const Vector2d trial = disc_trial(i);
         const double size = std::hypot(trial[0], trial[1]);
         const Vector2d held = size > limit ? Vector2d(limit / size * trial) : trial;
         R[t(i, 0)] = F[t(i, 0)] - held[0];
         R[t(i, 1)] = F[t(i, 1)] - held[1];
         continue;
      }
      const double trial = F[t(i)] - ktt[i] * slip(i);
      R[t(i)] = F[t(i)] - std::clamp(trial, -limit, limit);
   }
   return R;
}

/// What is reported of the present displacements. False if it is too large anywhere.
bool FrictionSolver::Implementation::residuals(IncrementReport &report) const
{
   const VectorXd R = natural_map(), left = round_off();
   const double scale = reference > 0 ? reference : 1.0,
                allowed = 0.5 * settings.tolerance * scale; // room for the last word
   double tangent = 0;
   bool small = true;
   for (Index i = 0; i < n; ++i)
   {
      double limit = std::max(allowed, left[m(i)]);
      small = small && std::abs(R[m(i)]) <= limit;
      if (frictionless) { continue; }
      double size = std::abs(R[t(i)]);
      limit = std::max({allowed, problem.friction[i] * left[m(i)], left[t(i)]});
      if (disc())
      {
         // The natural map multiplies the error in the direction of a slip by the slip.
         const Vector2d x = disc_slip(i);
         const double uncertain = slip_round_off(at(u, i).norm());
         size = at(R, i).norm();
         limit = std::max(limit, left[t(i, 1)]);
         if (closed(status[i]))
         {
            const double k = std::max(K(t(i, 0), t(i, 0)), K(t(i, 1), t(i, 1))),
                         sure = slip_violation(at(F, i), x, k, bound(i), uncertain);
            small = small && sure <= limit && size <= limit;
            tangent = std::max(tangent, slip_violation(at(F, i), x, k, bound(i)));
         }
      }
      // An open node bears nothing, not f times what is left of its pressure.
      if (!closed(status[i])) { size = disc() ? at(F, i).norm() : std::abs(F[t(i)]); }
      tangent = std::max(tangent, size);
      small = small && size <= limit;
   }
   report.residual_normal = R.tail(n).cwiseAbs().maxCoeff() / scale;
   report.residual_tangential = tangent / scale;
   report.round_off = left.maxCoeff() / scale;
   return small;
}

/// Its derivative by the displacements.
MatrixXd FrictionSolver::Implementation::natural_map_derivative() const
{
   MatrixXd J(F.size(), F.size());
   for (Index i = 0; i < n; ++i)
   {
      if (knn[i] * gap(i) > F[m(i)]) { J.row(m(i)) = K.row(m(i)); }
      else
      {
         J.row(m(i)).setZero();
         J(m(i), m(i)) = knn[i];
      }
      // Rows of the slipping: (I - P) dq + P k dx - f n dp, where the trial force has direction
      // n and P leaves what is across it.
      const double limit = bound(i), f_i = limit > 0 ? problem.friction[i] : 0.0;
      if (disc())
      {
         const Vector2d trial = disc_trial(i);
         Matrix2d P = Matrix2d::Identity();
         Vector2d along(0, 0);
         if (std::hypot(trial[0], trial[1]) > limit)
         {
            const DiscSlip to(trial, limit);
            along = to.n;
            P = to.share * to.t() * to.t().transpose();
         }
         for (Index k = 0; k < 2; ++k)
         {
            J.row(t(i, k)) = ((k == 0) - P(k, 0)) * K.row(t(i, 0)) +
                             ((k == 1) - P(k, 1)) * K.row(t(i, 1)) -
                             f_i * along[k] * K.row(m(i));
            for (Index l = 0; l < 2; ++l) { J(t(i, k), t(i, l)) += P(k, l) * ktt[i]; }
         }
         continue;
      }
      const double trial = F[t(i)] - ktt[i] * slip(i);
      if (std::abs(trial) <= limit)
      {
         J.row(t(i)).setZero();
         J(t(i), t(i)) = ktt[i];
      }
      else { J.row(t(i)) = K.row(t(i)) - (trial > 0 ? f_i : -f_i) * K.row(m(i)); }
   }
   return J;
}

/// Newton's method on the natural map from the present displacements, damped so that the
/// residual falls in every step. False if it does not vanish.
bool FrictionSolver::Implementation::damped_newton()
{
   F = f + K * u;
   VectorXd R = natural_map();
   for (int k = 0; k < 2 * settings.max_newton; ++k)
   {
      // Near enough for the active set to go on from here.
      if (R.norm() <= 1e-9 * reference + round_off().maxCoeff()) { return true; }
      ++counters.newton_steps;
      ++counters.dense_factorisations;
      DenseLU factor;
      if (!factor.compute(natural_map_derivative())) { return false; }
      const VectorXd from = u;
      const double size = R.norm();
      VectorXd &step = R;
      factor.solve(step);
      VectorXd next;
      double share = 2;
      do {
         share *= 0.5;
         if (share < 1e-6) { return false; }
         u = from - share * step;
         F = f + K * u;
         next = natural_map();
      } while (!(next.norm() < (1 - 1e-4 * share) * size));
      R = next;
   }
   return false;
}

/// The states in which the natural map takes the present displacements.
void FrictionSolver::Implementation::states_of_natural_map()
{
   for (Index i = 0; i < n; ++i)
   {
      status[i] = NodeState::stick;
      if (knn[i] * gap(i) > F[m(i)]) { status[i] = NodeState::separation; }
      else if (disc())
      {
         const Vector2d trial = disc_trial(i);
         if (std::hypot(trial[0], trial[1]) <= bound(i)) { continue; }
         status[i] = NodeState::slip;
         direction[i] = DiscSlip(trial, bound(i));
      }
      else
      {
         const double trial = F[t(i)] - ktt[i] * slip(i);
         if (std::abs(trial) <= bound(i)) { continue; }
         status[i] = trial < 0 ? NodeState::forward_slip : NodeState::backward_slip;
      }
   }
}

/// Damped Newton from the present displacements, from those at the start of the increment, and
/// from random ones ever further away, in units of what the loads do to a node alone: as many
/// as so many operations allow (3e9: a second or two). The generator is seeded afresh, so that
/// equal increments start alike.
bool FrictionSolver::Implementation::run_damped_newton(IncrementReport &report,
                                                       const ContactState &state,
                                                       double operations)
{
   VectorXd u_old(u.size());
   u_old << state.v, state.w;
   const VectorXd far = reference * K.diagonal().cwiseInverse();
   const Index starts = std::clamp<Index>(4000000 / (n * n * n), 2, 1000);
   const double N = static_cast<double>(K.rows()), step = N * N * (N + 40) + 5e4;
   const long first_step = counters.newton_steps;
   std::mt19937_64 random(1);
   for (Index start = 0; start < starts; ++start)
   {
      if (start > 1 && step * double(counters.newton_steps - first_step) > operations)
      {
         break;
      }
      if (start > 0) { u = u_old; }
      const double size = std::pow(10, -2 + 4.0 * start / starts);
      for (Index k = 0; k < u.size() && start > 1; ++k)
      {
         u[k] += size * far[k] * (std::ldexp(double(random() >> 11), -52) - 1);
      }
      if (!damped_newton()) { continue; }
      states_of_natural_map();
      // From afar a free body that slides away looks like an answer: round-off hides what
      // drives it.
      const bool held = motions && motions->cols() == 0;
      if (polished(report) && (held || report.round_off <= may_hide_sliding)) { return true; }
   }
   return false;
}

} // namespace cattaneo
