#include <algorithm>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cmath>

namespace cattaneo
{

const char *name(NodeState state)
{
   const char *const names[] = {"stick", "separation", "forward slip", "backward slip", "slip"};
   return names[static_cast<int>(state)];
}

Eigen::VectorXd ContactState::displacements() const
{
   Eigen::VectorXd u(v.size() + w.size());
   u << v, w;
   return u;
}

Eigen::VectorXd ContactState::forces() const
{
   Eigen::VectorXd F(q.size() + p.size());
   F << q, p;
   return F;
}

namespace
{

void require_held(const ReducedProblem &problem, const Eigen::VectorXd &v, double allowed)
{
   for (Eigen::Index row : problem.held)
   {
      require(std::abs(v[row]) <= allowed, "contact state: row ", row, " of the slip is ",
              v[row], ", must be 0, because a support holds it");
   }
}

} // namespace

ContactState ContactState::virgin(const ReducedProblem &problem)
{
   return with_slip(problem, Eigen::VectorXd::Zero(problem.slips()));
}

ContactState ContactState::with_slip(const ReducedProblem &problem, const Eigen::VectorXd &v)
{
   const Eigen::Index n = problem.nodes();
   require(v.size() == problem.slips(), "contact state: initial slip has ", v.size(),
           " entries, must be ", problem.slips());
   require_held(problem, v, 0);
   ContactState state;
   state.v = v;
   state.slip_origin = v;
   state.w = Eigen::VectorXd::Zero(n);
   state.q = Eigen::VectorXd::Zero(problem.slips());
   state.p = Eigen::VectorXd::Zero(n);
   state.status.resize(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      state.status[i] = problem.gap[i] > 0 ? NodeState::separation : NodeState::stick;
   }
   state.multipliers = Eigen::VectorXd::Zero(problem.patterns.size());
   state.loads = problem.load_names();
   return state;
}

int ContactState::steady_period(double tolerance) const
{
   const auto largest = [](const Eigen::VectorXd &x) { return x.lpNorm<Eigen::Infinity>(); };
   const auto known = static_cast<int>(cycle_slip.size());
   for (int period = 1; period < known; ++period)
   {
      const Eigen::VectorXd &last = cycle_slip.back(), &before = cycle_slip[known - 1 - period];
      if (largest(last - before) <= tolerance * std::max(largest(last), largest(before)))
      {
         return period;
      }
   }
   return 0;
}

void ContactState::require_finite() const
{
   bool finite = std::isfinite(time) && std::isfinite(step) && std::isfinite(peak_force) &&
                 std::isfinite(dissipation);
   for (const Eigen::VectorXd *all : {&v, &w, &q, &p, &slip_origin, &multipliers})
   {
      finite = finite && all->allFinite();
   }
   for (const Eigen::VectorXd &slip : cycle_slip) { finite = finite && slip.allFinite(); }
   for (const auto &its : kept)
   {
      for (double x : its.second) { finite = finite && std::isfinite(x); }
   }
   if (cycle)
   {
      double sum = cycle->dissipation + cycle->external_work + cycle->normal_work +
                   cycle->slip_change + cycle->node_dissipation.sum();
      for (const Loop &loop : cycle->loops)
      {
         sum += loop.work() + loop.force_range() + loop.displacement_range();
      }
      finite = finite && std::isfinite(sum);
   }
   require(finite, "contact state: a value is not finite");
}

void ContactState::require_of(const ReducedProblem &problem) const
{
   validate(problem);
   // A slip before any load, see with_slip(), has no forces yet.
   if (peak_force == 0 && multipliers.isZero(0) && forces().isZero(0)) { return; }
   const Eigen::VectorXd u = displacements(), loads = problem.clamped_forces(multipliers),
                         size = problem.K.cwiseAbs() * u.cwiseAbs() + loads.cwiseAbs();
   Eigen::Index row = 0;
   const double off = (problem.K * u + loads - forces()).cwiseAbs().maxCoeff(&row);
   // A state without loads still has the round-off of earlier loads.
   const double allowed = std::max(1e-6 * size.maxCoeff(), 1e-9 * peak_force);
   require(off <= allowed, "contact state: the forces of node ", row % problem.nodes(),
           " differ by ", off,
           " from the forces that follow from its displacements and loads: the state belongs "
           "to another reduced problem");
}

void ContactState::validate(const ReducedProblem &problem) const
{
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   require(v.size() == m && q.size() == m && slip_origin.size() == m && w.size() == n &&
              p.size() == n && static_cast<Eigen::Index>(status.size()) == n &&
              multipliers.size() == patterns,
           "contact state: it has ", status.size(), " nodes and ", multipliers.size(),
           " load multipliers, must have ", n, " and ", patterns, " as the reduced problem");
   require(loads.empty() || loads == problem.load_names(), "contact state: its loads are ",
           listed(loads), ", must be those of the reduced problem in the same order: ",
           listed(problem.load_names()));
   for (const Eigen::VectorXd &slip : cycle_slip)
   {
      require(slip.size() == m, "contact state: the slip at the end of a cycle has ",
              slip.size(), " entries, must be ", m);
   }
   if (cycle)
   {
      const auto loops = static_cast<Eigen::Index>(cycle->loops.size());
      const Eigen::Index rubbed = m > 0 ? n : 0;
      require(loops == patterns && cycle->node_dissipation.size() == rubbed,
              "contact state: the cycle under way has ", loops, " loads and ",
              cycle->node_dissipation.size(), " nodes with a loss, must have ", patterns,
              " and ", rubbed, " as the reduced problem");
   }
   require_finite();
   require_held(problem, v, m > 0 ? 1e-9 * v.cwiseAbs().maxCoeff() : 0);
}

} // namespace cattaneo
