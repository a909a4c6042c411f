#include <cattaneo/friction/methods.hpp>
#include <utility>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Holds the rigid motions by weak springs, ever weaker ones, each fixed where the one before
/// let the bodies go. True if a body moves on and on: the force that they bear stays the same.
/// Else what they hold is near an answer without them, or, where they bear nothing, is one (a
/// pivot, balanced so that only round-off would decide which way it leans, stays where it is).
bool drifts(Increment &at)
{
   FrictionSystem &s = at.system;
   const ReducedProblem &problem = s.problem;
   const MatrixXd &Z = problem.rigid_motions;
   if (Z.cols() == 0) { return false; }
   const Index n = s.n;
   const double negligible = s.settings.tolerance * at.reference;
   Mechanism &mechanism = at.mechanism;
   const Index along = problem.slips(), components = problem.components();
   const auto count = static_cast<Index>(problem.patterns.size());
   mechanism = {};
   VectorXd own(along + n), borne;
   own << problem.A().diagonal(), problem.C().diagonal();
   const double soft = own.minCoeff(), mean = own.mean();
   // Weak against the softest node and felt by the stiffest, or they prove nothing.
   // Above critical friction a body that slides may as well lock itself.
   const bool tell = soft > 1e-6 * own.maxCoeff() && s.above_critical() < 0;
   VectorXd anchor = at.start.displacements();
   VectorXd loads(count + 1);
   loads << at.multipliers, 1;
   ContactState begin = at.start;
   begin.multipliers.conservativeResize(count + 1);
   begin.multipliers[count] = 1;
   int alike = 0; // springs in a row that bore the same as the one before
   for (double weakness : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
   {
      const double spring = weakness * (tell ? soft : mean);
      if (spring < 1e-13 * own.maxCoeff()) { break; } // round-off
      ReducedProblem held = problem;
      held.K += spring * Z * Z.transpose();
      join_coupling(held);
      const VectorXd pull = -spring * Z * (Z.transpose() * anchor);
      held.patterns.push_back({"springs", Control::force, pull.head(along), pull.tail(n)});
      held.H.conservativeResizeLike(MatrixXd::Zero(count + 1, count + 1));
      held.rigid_motions = MatrixXd(along + n, 0);
      held.chains.clear();
      held.held.clear();
      FrictionSystem solver(std::make_shared<ReducedProblem>(std::move(held)), s.settings);
      solver.brief = true;
      ContactState next = begin;
      const IncrementReport report = solver.solve(next, loads);
      s.counters += solver.counters;
      if (report.status != FrictionStatus::converged &&
          report.status != FrictionStatus::not_unique)
      {
         if (alike > 0) { break; }
         borne.resize(0);
         continue;
      }
      mechanism = {};
      const VectorXd u_next = next.displacements();
      const VectorXd bears = spring * Z * (Z.transpose() * (u_next - anchor));
      anchor = u_next;
      const double size = bears.cwiseAbs().maxCoeff();
      at.rested = next;
      at.rested->multipliers = at.multipliers;
      at.rested->peak_force = at.reference;
      at.at_rest = size <= negligible;
      if (at.at_rest) { return false; }
      const VectorXd before = std::exchange(borne, bears);
      if (!tell || before.size() == 0 || size <= 1e-9 * at.reference ||
          (bears - before).cwiseAbs().maxCoeff() > 0.01 * size)
      {
         alike = 0;
         continue;
      }
      ++alike;
      mechanism.motion = -bears / size;
      for (Index i = 0; i < n; ++i)
      {
         if (!closed(next.status[i])) { continue; }
         for (Index k = 0; k < components; ++k)
         {
            const bool slips = std::abs(mechanism.motion[k * n + i]) > 1e-6;
            mechanism.slides = mechanism.slides || slips;
            mechanism.spins = mechanism.spins || (k == 1 && slips);
         }
      }
   }
   // What opens everywhere is for find_mechanism() to prove: a spring may hold a body before it
   // touches.
   mechanism.exists = mechanism.slides && alike > 1;
   return mechanism.exists;
}

/// True if the loads drive a steady rotation, which friction in the disc can hide from the
/// springs above.
bool spins(Increment &at)
{
   FrictionSystem &s = at.system;
   const ReducedProblem &problem = s.problem;
   if (!s.disc() || problem.friction.maxCoeff() == 0 || problem.rigid_motions.cols() == 0)
   {
      return false;
   }
   if (!s.smooth)
   {
      ReducedProblem without = problem;
      set_friction(without, 0);
      // It could not bear the torque.
      const MatrixXd Z = rigid_slips(problem);
      for (LoadPattern &pattern : without.patterns)
      {
         pattern.q -= Z * (Z.transpose() * pattern.q);
      }
      s.smooth = std::make_unique<FrictionSolver>(without);
   }
   ContactState state = ContactState::virgin(problem);
   if (s.smooth->solve(state, at.multipliers).status != FrictionStatus::converged)
   {
      return false;
   }
   at.mechanism = find_spinning(problem, state.p, problem.clamped_forces(at.multipliers),
                                s.settings.tolerance * at.reference);
   return at.mechanism.exists;
}

} // namespace

bool moves_away(Increment &at)
{
   if (!at.away)
   {
      const bool moves = !at.system.brief && (drifts(at) || spins(at));
      at.away = moves ? at.mechanism : Mechanism{};
   }
   at.mechanism = *at.away;
   return at.away->exists;
}

Search weak_springs(Increment &at)
{
   if (moves_away(at) || !at.rested) { return Search::not_here; }
   at.take(at.system.frictionless ? at.rested->w : at.rested->displacements(),
           at.rested->status);
   if (newton(at)) { return Search::found; }
   return at.at_rest ? Search::hopeless : Search::not_here; // see FrictionSystem::solve()
}

} // namespace cattaneo
