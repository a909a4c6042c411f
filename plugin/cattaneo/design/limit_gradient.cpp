#include <cattaneo/design/limit_gradient.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/tangential_lengths.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Contribution of each datum to the work of the mechanism on the forces of a load factor.
/// False if there is none.
bool take_work(const LimitProblem &problem, double load_factor, const LimitReport &limit,
               const std::vector<StiffnessChange> &stiffness, LimitGradient &by)
{
   const ReducedProblem &reduced = problem.reduced;
   require_coulomb(reduced, "the gradient of a limit");
   const LoadCycle &cycle = problem.cycle;
   cycle.validate(reduced);
   const Index n = reduced.nodes(), m = reduced.slips(), vertices = cycle.vertices(),
               count = static_cast<Index>(reduced.patterns.size());
   if (limit.status != LimitStatus::certified && limit.status != LimitStatus::bracketed)
   {
      by.message = "the limit is not known from both sides: " + limit.message;
      return false;
   }
   const CollapseMechanism &mechanism = limit.mechanism;
   require(mechanism.slip.rows() == m && mechanism.slip.cols() == vertices &&
              limit.slip.size() == m,
           "gradient of a limit: its mechanism has ", mechanism.slip.rows(), " slips at ",
           mechanism.slip.cols(), " vertices, must have as many as the problem, ", m, " at ",
           vertices);
   MatrixXd motion(m + n, vertices);
   motion << mechanism.slip, mechanism.opening;
   const VectorXd all = motion.rowwise().sum();
   const MatrixXd loads = cycle.multipliers(load_factor),
                  p = stuck_forces(reduced, cycle).p(load_factor).colwise() +
                      VectorXd(reduced.B() * limit.slip);
   by.friction = tangential_lengths(mechanism.slip, n).cwiseProduct(p).rowwise().sum();
   by.constant.resize(count);
   by.varying.resize(count, vertices);
   for (Index k = 0; k < count; ++k)
   {
      const VectorXd work =
         motion.transpose() * reduced.clamped_forces(VectorXd::Unit(count, k));
      by.constant[k] = work.sum();
      by.varying.row(k) = load_factor * work.transpose();
      by.load_factor += work.dot(cycle.varying.row(k));
   }
   // Closed at w = -g.
   by.gap = -(reduced.K * all).tail(n);
   VectorXd u = VectorXd::Zero(m + n);
   u.head(m) = limit.slip;
   by.stiffness.resize(static_cast<Index>(stiffness.size()));
   for (std::size_t s = 0; s < stiffness.size(); ++s)
   {
      const StiffnessChange &change = stiffness[s];
      require(change.K.rows() == m + n && change.K.cols() == m + n,
              "gradient of a limit: a change of the stiffness is ", change.K.rows(), " × ",
              change.K.cols(), ", must be ", m + n, " × ", m + n);
      double &work = by.stiffness[static_cast<Index>(s)];
      work = all.dot(change.K * u);
      if (change.loads.cols() > 0)
      {
         require(change.loads.rows() == m + n && change.loads.cols() == count,
                 "gradient of a limit: a change of the loads is ", change.loads.rows(), " × ",
                 change.loads.cols(), ", must be ", m + n, " × ", count);
         work += motion.cwiseProduct(change.loads * loads).sum();
      }
   }
   return true;
}

} // namespace

LimitGradient load_limit_gradient(const LimitProblem &problem, const LimitReport &limit,
                                  const std::vector<StiffnessChange> &stiffness)
{
   // The mechanism is scaled so that its work on the varying loads falls by one per unit of λ.
   LimitGradient by;
   by.found = take_work(problem, limit.limit, limit, stiffness, by);
   by.load_factor = 0;
   return by;
}

LimitGradient friction_limit_gradient(const LimitProblem &problem, double load_factor,
                                      const LimitReport &limit,
                                      const std::vector<StiffnessChange> &stiffness)
{
   LimitGradient by;
   by.found = take_work(problem, load_factor, limit, stiffness, by);
   if (!by.found) { return by; }
   const double scale = -1 / by.friction.sum();
   by.friction.resize(0);
   by.constant *= scale;
   by.varying *= scale;
   by.gap *= scale;
   by.stiffness *= scale;
   by.load_factor *= scale;
   return by;
}

} // namespace cattaneo
