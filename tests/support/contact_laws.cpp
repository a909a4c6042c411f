#include "contact_laws.hpp"

namespace cattaneo_test
{

LawChecker::LawChecker(const cattaneo::ReducedProblem &problem,
                       const cattaneo::ContactState &start)
   : problem_(problem), n_(problem.nodes()), c_(problem.components()), K_(problem.K)
{
   sums_ = K_.cwiseAbs().rowwise().sum();
   norm_ = sums_.maxCoeff();
   Eigen::VectorXd u(K_.rows());
   u << start.v, start.w;
   peak_ = (K_ * u).cwiseAbs().maxCoeff();
   for (Eigen::Index i = 0; i < n_; ++i)
   {
      peak_ = std::max(peak_, -problem.gap[i] * problem.C()(i, i));
   }
}

double LawChecker::violation(const Eigen::VectorXd &v_old, const cattaneo::ContactState &state)
{
   using namespace cattaneo;
   const Eigen::VectorXd f = problem_.clamped_forces(state.multipliers);
   Eigen::VectorXd u(K_.rows());
   u << state.v, state.w;
   const Eigen::VectorXd F = f + K_ * u;
   peak_ = std::max(peak_, f.cwiseAbs().maxCoeff());
   // Row by row: a soft node beside a stiff one is judged by its own forces.
   const Eigen::VectorXd round_off = 16 * std::sqrt(static_cast<double>(n_)) *
                                     std::numeric_limits<double>::epsilon() *
                                     (u.cwiseAbs().maxCoeff() * sums_ + f.cwiseAbs());
   worst_ = 0;
   what_ = "";
   for (Eigen::Index i = 0; i < n_; ++i)
   {
      allowed_ = 1e-11 * peak_;
      for (Eigen::Index k = i; k < K_.rows(); k += n_)
      {
         allowed_ = std::max(allowed_, 1e-11 * peak_ + round_off[k]);
      }
      const Eigen::Index m = c_ * n_ + i;
      const double p = F[m], y = problem_.C()(i, i) * (u[m] + problem_.gap[i]);
      const double fp = problem_.friction[i] * std::max(p, 0.0);
      Eigen::VectorXd q(c_), x(c_);
      double reported = std::abs(p - state.p[i]), kt = 0;
      for (Eigen::Index k = 0; k < c_; ++k)
      {
         const Eigen::Index t = k * n_ + i;
         q[k] = F[t];
         kt = k ? std::min(kt, problem_.A()(t, t)) : problem_.A()(t, t);
         x[k] = u[t] - v_old[t];
         reported = std::max(reported, std::abs(q[k] - state.q[t]));
      }
      x *= kt;
      note(reported, i, "reported forces are not those of the displacements");
      switch (state.status[i])
      {
      case NodeState::separation:
         note(-y, i, "open and penetrating");
         note(std::max(std::abs(p), q.norm()), i, "open and loaded");
         break;
      case NodeState::stick:
         note(std::abs(y), i, "stuck but not closed");
         note(-p, i, "stuck in tension");
         note(x.norm(), i, "stuck and moving");
         note(q.norm() - fp, i, "stuck beyond the friction limit");
         break;
      case NodeState::forward_slip:
      case NodeState::backward_slip:
         note(std::abs(y), i, "slipping but not closed");
         note(-p, i, "slipping in tension");
         note(std::abs(q[0] + sense(state.status[i]) * fp), i, "slipping off the limit");
         note(-sense(state.status[i]) * x[0], i, "slipping the wrong way");
         break;
      case NodeState::slip:
         note(std::abs(y), i, "slipping but not closed");
         note(-p, i, "slipping in tension");
         note(std::abs(q.norm() - fp), i, "slipping off the limit");
         // The angle between force and slip counts by the smaller of the two.
         if (x.norm() > 0 && q.norm() > 0)
         {
            note((q / q.norm() + x / x.norm()).norm() * fp * x.norm() / (fp + x.norm()), i,
                 "slipping the wrong way");
         }
         break;
      }
   }
   if (!u.allFinite() || round_off.maxCoeff() > 1e-4 * peak_)
   {
      what_ = "moved so far that round-off hides the forces";
      return std::numeric_limits<double>::infinity();
   }
   peak_ = std::max(peak_, (F - f).cwiseAbs().maxCoeff()); // what the next one starts from
   return worst_;
}

double LawChecker::round_off(const Eigen::VectorXd &v_old, const Eigen::VectorXd &u,
                             const Eigen::VectorXd &loads) const
{
   const double size = std::max(u.cwiseAbs().maxCoeff(), v_old.cwiseAbs().maxCoeff());
   const double peak = std::max(peak_, problem_.clamped_forces(loads).cwiseAbs().maxCoeff());
   return 4 * std::numeric_limits<double>::epsilon() * norm_ * size / peak;
}

void LawChecker::note(double violation, Eigen::Index node, const char *what)
{
   if (!(violation > 0)) { return; }
   violation /= allowed_; // infinite without any force
   if (!(violation > worst_)) { return; }
   worst_ = violation;
   what_ = "node " + std::to_string(node) + " is " + what;
}

bool proves_mechanism(const cattaneo::ReducedProblem &problem, const Eigen::VectorXd &motion,
                      const Eigen::VectorXd &clamped_forces)
{
   const Eigen::MatrixXd K = problem.K;
   const Eigen::Index n = problem.nodes(), c = problem.components();
   const double size = motion.cwiseAbs().maxCoeff();
   const double norm = K.cwiseAbs().rowwise().sum().maxCoeff();
   if ((K * motion).cwiseAbs().maxCoeff() > 1e-9 * norm * size) { return false; }
   const double work = motion.dot(clamped_forces);
   double most = 0; // work against the motion per unit of pressure; none may be done for it
   for (Eigen::Index i = 0; i < n; ++i)
   {
      double slip = 0;
      for (Eigen::Index k = 0; k < c; ++k) { slip = std::hypot(slip, motion[k * n + i]); }
      most = std::max(most, motion[c * n + i] + problem.friction[i] * slip);
   }
   const double pressure = clamped_forces.cwiseAbs().sum();
   return work > 0 && most * pressure < 0.1 * work;
}

} // namespace cattaneo_test
