#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cmath>

namespace cattaneo
{

void check_limit(const ReducedProblem &reduced, const ResidualForces &residual,
                 const LimitSettings &settings)
{
   settings.validate();
   reduced.validate();
   const Eigen::Index m = reduced.slips();
   require(residual.flexibility.rows() == m && residual.transfer.rows() == reduced.nodes(),
           "shakedown: the residual forces do not belong to the reduced problem: ",
           residual.flexibility.rows(), " tangential unknowns instead of ", m);
}

Eigen::VectorXd typical_forces(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p)
{
   const Eigen::Index n = p.rows();
   Eigen::VectorXd scale = p.cwiseAbs().rowwise().maxCoeff();
   for (Eigen::Index k = 0; k < q.rows(); ++k)
   {
      scale[k % n] = std::max(scale[k % n], q.row(k).cwiseAbs().maxCoeff());
   }
   Eigen::VectorXd sorted = scale;
   std::nth_element(sorted.data(), sorted.data() + n / 2, sorted.data() + n);
   return scale.cwiseMax(1e-3 * std::max(sorted[n / 2], 1e-3 * scale.maxCoeff()));
}

ConeSolution solve_counted(const ConeProgramme &programme, const LimitSettings &settings,
                           const ConeStart &start, LimitReport &report,
                           ProgressReport &progress)
{
   ConeSettings cone;
   cone.goes_on = [&](int iteration)
   {
      progress.note(std::nan(""), report.iterations + iteration);
      return !settings.monitor.stopped();
   };
   cone.max_iterations = settings.max_iterations;
   ConeSolution solution = solve(programme, cone, start);
   report.iterations += solution.iterations;
   ++report.counters.limit_solves;
   return solution;
}

LimitStatus unless_stopped(LimitStatus status, const Monitor &monitor)
{
   const bool open = status == LimitStatus::bracketed || status == LimitStatus::failed;
   return open && monitor.stopped() ? LimitStatus::stopped : status;
}

bool usable(const ConeSolution &solution)
{
   return solution.r.size() > 0 && solution.r.allFinite() && std::isfinite(solution.theta);
}

double slip_size(const Eigen::VectorXd &slip)
{
   return 10 * slip.cwiseAbs().maxCoeff();
}

ConeProgramme clearance_programme(const ResidualForces &residual, const StuckForces &loads,
                                  double load_factor, Eigen::VectorXd friction,
                                  const Eigen::MatrixXd &weight,
                                  const Eigen::VectorXd &force_scale)
{
   ConeProgramme programme;
   programme.residual = &residual;
   programme.loads.q0 = loads.q(load_factor);
   programme.loads.p0 = loads.p(load_factor);
   programme.loads.q1 = Eigen::MatrixXd::Zero(loads.q0.rows(), loads.vertices());
   programme.loads.p1 = -(friction.cwiseInverse().asDiagonal() * weight);
   programme.friction = std::move(friction);
   programme.force_scale = force_scale;
   programme.ceiling = 10; // more clearance than ten times the friction limit is of no use
   return programme;
}

} // namespace cattaneo
