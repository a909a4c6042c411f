#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit_search.hpp>
#include <cmath>

namespace cattaneo
{

LimitSearch::LimitSearch(const ReducedProblem &reduced, const ResidualForces &residual,
                         StuckForces loads, const LimitSettings &settings)
   : reduced_(reduced), residual_(residual), loads_(std::move(loads)), settings_(settings),
     no_slip_(Eigen::VectorXd::Zero(reduced.slips())), progress_(settings.monitor)
{
   settings.validate();
   reduced.validate();
   const Eigen::Index m = reduced.slips();
   require(residual.flexibility.rows() == m && residual.transfer.rows() == reduced.nodes(),
           "shakedown: the residual forces belong to another problem: they have ",
           residual.flexibility.rows(), " tangential unknowns, must have ", m);
}

LimitReport LimitSearch::ended(LimitStatus status, const std::string &message)
{
   const bool open = status == LimitStatus::bracketed || status == LimitStatus::failed;
   report_.status = open && settings_.monitor.stopped() ? LimitStatus::stopped : status;
   report_.message = message;
   report_.seconds = progress_.seconds();
   progress_.end(1.0, report_.iterations);
   return report_;
}

std::string because(const std::string &message)
{
   return " (" + (message.empty() ? "the solver has reached its accuracy" : message) + ")";
}

std::string not_closed(const std::string &message)
{
   return "the gap between the bounds is wider than the tolerance" + because(message);
}

Eigen::VectorXd typical_forces(const Eigen::MatrixXd &q, const Eigen::MatrixXd &p)
{
   const Eigen::Index n = p.rows();
   Eigen::VectorXd scale = p.cwiseAbs().rowwise().maxCoeff();
   const Eigen::VectorXd shear = q.cwiseAbs().rowwise().maxCoeff();
   for (Eigen::Index k = 0; k < q.rows(); k += n)
   {
      scale = scale.cwiseMax(shear.segment(k, n));
   }
   Eigen::VectorXd sorted = scale;
   std::nth_element(sorted.data(), sorted.data() + n / 2, sorted.data() + n);
   return scale.cwiseMax(1e-3 * std::max(sorted[n / 2], 1e-3 * scale.maxCoeff()));
}

ConeSolution LimitSearch::solve(const ConeProgramme &programme, const ConeStart &start)
{
   ConeSettings cone;
   cone.goes_on = [&](int iteration)
   {
      progress_.note(std::nan(""), report_.iterations + iteration);
      return !settings_.monitor.stopped();
   };
   cone.max_iterations = settings_.max_iterations;
   ConeSolution solution = cattaneo::solve(programme, cone, start);
   report_.iterations += solution.iterations;
   ++report_.counters.limit_solves;
   return solution;
}

bool usable(const ConeSolution &solution)
{
   return solution.r.size() > 0 && solution.r.allFinite() && std::isfinite(solution.theta);
}

double slip_size(const Eigen::VectorXd &slip)
{
   return 10 * slip.cwiseAbs().maxCoeff();
}

ConeProgramme clearance_programme(ConeProgramme programme, const Eigen::MatrixXd &weight)
{
   programme.loads.q1.setZero();
   programme.loads.p1.setZero();
   programme.strength1 = -weight;
   programme.ceiling = 10; // a clearance above ten times the friction limit decides nothing
   return programme;
}

} // namespace cattaneo
