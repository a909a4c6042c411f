#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/friction/increment.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

const ReducedProblem &valid(const ReducedProblem &problem)
{
   problem.validate();
   require(problem.components() <= 2, "friction solver: the reduced problem has ",
           problem.components(), " tangential components per node, at most 2 are supported");
   return problem;
}

} // namespace

VectorXd node_lengths(const ReducedProblem &problem)
{
   const bool known = problem.weights.size() > 0 && problem.weights.minCoeff() > 0;
   return known ? problem.weights : VectorXd::Ones(problem.nodes());
}

WithoutSlip::WithoutSlip(const ReducedProblem &of) : problem(of), K(of.C())
{
   if (problem.components() == 0) { return; }
   slides_freely = rigid_slips(problem);
   tangential = std::make_unique<SemidefiniteSolver>(problem.A(), slides_freely);
   if (slides_freely.cols() > 0)
   {
      const MatrixXd weighted =
         node_lengths(problem).replicate(problem.components(), 1).asDiagonal() * slides_freely;
      const MatrixXd square = slides_freely.transpose() * weighted;
      share_of_motion = solve_semidefinite(square, weighted.transpose());
   }
   K -= problem.B() * tangential->solve(problem.B().transpose());
   K = (0.5 * (K + K.transpose())).eval();
}

WithoutSlip::~WithoutSlip() = default;

VectorXd WithoutSlip::normal_forces(const VectorXd &clamped) const
{
   const VectorXd p = clamped.tail(problem.nodes());
   if (!tangential) { return p; }
   return p - problem.B() * tangential->solve(clamped.head(problem.slips()));
}

VectorXd WithoutSlip::slip(const VectorXd &v, const VectorXd &w, const VectorXd &clamped) const
{
   if (!tangential) { return v; }
   const VectorXd q = problem.B().transpose() * w + clamped.head(problem.slips());
   VectorXd next = -tangential->solve(q);
   if (slides_freely.cols() > 0)
   {
      const VectorXd moved = next - v;
      next -= slides_freely * (share_of_motion * moved);
   }
   return next;
}

FrictionSystem::FrictionSystem(std::shared_ptr<const ReducedProblem> given,
                               const FrictionSettings &chosen, bool keeps_slip)
   : shared(std::move(given)), problem(valid(*shared)), settings(chosen), n(problem.nodes()),
     c(keeps_slip || problem.friction.maxCoeff() > 0 ? problem.components() : 0),
     without_slip(c > 0 ? nullptr : std::make_unique<WithoutSlip>(problem)),
     K(without_slip ? without_slip->K : problem.K), bound(friction_bounds(problem))
{
   settings.validate();
   lone.kn = K.diagonal().tail(n);
   if (frictionless())
   {
      counters.dense_factorisations = without_slip->tangential ? 1 : 0;
      // If a body can slide freely up a slope, the small remainder of K is round-off of C.
      product = std::make_shared<StiffnessProduct>(
         StiffnessProduct{SymmetricProduct(K), RoundOff(problem.C())});
      whole_product = std::make_shared<StiffnessProduct>(
         StiffnessProduct{SymmetricProduct(problem.K), RoundOff(problem.K)});
      return;
   }
   counters.tangential_unknowns = c * n;
   lone.kt = problem.A().diagonal().head(n);
   lone.critical.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      const LoneNode node = lone_node(problem, i);
      if (disc()) { lone.kt[i] = std::sqrt(node.A.determinant()); }
      lone.critical[i] = critical_friction(node);
   }
   product = whole_product =
      std::make_shared<StiffnessProduct>(StiffnessProduct{SymmetricProduct(K), RoundOff(K)});
}

bool FrictionSystem::bends() const
{
   return std::any_of(bound.begin(), bound.end(),
                      [](const FrictionBound &of) { return of.bends(); });
}

std::vector<FrictionBound> FrictionSystem::lines_at(const VectorXd &p) const
{
   std::vector<FrictionBound> lines = bound;
   for (Index i = 0; i < n; ++i) { lines[i] = lines[i].straight(std::max(p[i], 0.0)); }
   return lines;
}

StateEquations &FrictionSystem::coupled_equations()
{
   if (!equations.coupled) { equations.coupled = std::make_unique<StateEquations>(K, bound); }
   return *equations.coupled;
}

double FrictionSystem::friction(Index i, double p) const
{
   return bound[i].bends() ? bound[i].steepness(p) : problem.friction[i];
}

Index FrictionSystem::above_critical(const VectorXd &p,
                                     const std::vector<NodeState> &states) const
{
   Index worst = -1;
   double most = 1; // friction over its critical value
   for (Index i = 0; !frictionless() && i < n; ++i)
   {
      const bool counts = states.empty() || closed(states[i]);
      const double share = friction(i, p[i]) / lone.critical[i];
      if (!counts || !(share >= most) || (worst >= 0 && share == most)) { continue; }
      worst = i;
      most = share;
   }
   return worst;
}

bool FrictionSystem::obeys_laws(const VectorXd &v_old, const ContactState &next, double scale,
                                IncrementReport &report, const VectorXd &slip_error) const
{
   // Includes tangential displacements that were eliminated: a body that slips without friction
   // may move far, which affects the pressure.
   const VectorXd all = next.displacements();
   const VectorXd clamped = problem.clamped_forces(next.multipliers);
   const VectorXd forces = clamped + whole_product->times(all);
   const VectorXd rows = whole_product->arithmetic.rows(all.cwiseAbs(), clamped);
   report.round_off = rows.maxCoeff() / scale;
   if (!(report.round_off < lost)) { return false; }
   const LawCheck check =
      check_laws(problem, v_old, next, forces, settings.tolerance * scale, rows, slip_error);
   report.residual_normal = check.normal / scale;
   report.residual_tangential = check.tangential / scale;
   return check.obeyed;
}

IncrementReport FrictionSystem::judge(const ContactState &before, const ContactState &after,
                                      const VectorXd &slip_error) const
{
   const VectorXd clamped = problem.clamped_forces(after.multipliers);
   const double reference =
      std::max({before.peak_force, after.peak_force, clamped.cwiseAbs().maxCoeff()});
   IncrementReport report = uniqueness(after);
   const bool obeyed =
      obeys_laws(before.v, after, reference > 0 ? reference : 1.0, report, slip_error);
   std::ostringstream message;
   if (!(report.round_off < lost))
   {
      message << "the forces of the state are lost in round-off (" << report.round_off
              << " of the largest)";
   }
   else if (!obeyed)
   {
      message << "the state breaks the equations or the laws by "
              << std::max(report.residual_normal, report.residual_tangential)
              << " of the largest force";
   }
   if (!message.str().empty())
   {
      report.status = FrictionStatus::stalled;
      report.message = message.str();
   }
   return report;
}

IncrementReport FrictionSystem::uniqueness(const ContactState &state) const
{
   IncrementReport report;
   report.status = FrictionStatus::converged;
   const Index node = above_critical(state.p, state.status);
   if (node < 0) { return report; }
   std::ostringstream message;
   message << "friction " << friction(node, state.p[node]) << " at node " << node
           << " is above its critical value " << lone.critical[node];
   report.status = FrictionStatus::not_unique;
   report.message = message.str();
   return report;
}

} // namespace cattaneo
