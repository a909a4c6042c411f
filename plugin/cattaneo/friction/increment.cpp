#include <cattaneo/friction/increment.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Increment::Increment(FrictionSystem &s, const ContactState &state, const VectorXd &loads)
   : system(s), start(state), multipliers(loads), status(state.status),
     direction(s.disc() ? s.n : 0)
{
   const VectorXd clamped = s.problem.clamped_forces(multipliers);
   reference = std::max(state.peak_force, clamped.cwiseAbs().maxCoeff());
   // Initial interference loads the contact too.
   reference = std::max(reference, (-s.problem.gap.array() * s.lone.kn.array()).maxCoeff());
   if (!s.frictionless())
   {
      f = clamped;
      u = state.displacements();
   }
   else
   {
      f = s.without_slip->normal_forces(clamped);
      u = state.w;
   }
   for (Index i = 0; i < s.n; ++i)
   {
      if (closed(status[i])) { u[s.m(i)] = -s.problem.gap[i]; }
   }
   if (!s.frictionless() && state.peak_force > 0)
   {
      // The state of the increment before, from which sweeps begin. An accepted state is
      // computed anew.
      F = state.forces() - s.problem.clamped_forces(state.multipliers);
   }
   else { F = s.product->times(u); }
   // Initial slip loads the contact too, but not slip from which displacements of other nodes
   // follow.
   reference = std::max(reference, F.cwiseAbs().maxCoeff());
   F += f;
   swept = {u, status};
   find_pieces();
   // The result depends on the state and the loads, not on earlier increments. A march that is
   // interrupted and resumed gives the same bits.
   for (auto *equations : {&s.equations.coupled, &s.equations.normal, &s.equations.tangential})
   {
      if (*equations) { (*equations)->begin(); }
   }
}

NodeVector Increment::along(const VectorXd &x, Index i) const
{
   NodeVector entries(system.c);
   for (Index k = 0; k < system.c; ++k) { entries[k] = x[system.t(i, k)]; }
   return entries;
}

ContactNode Increment::node(Index i) const
{
   return {slip(i),
           along(F, i),
           gap(i),
           F[system.m(i)],
           system.frictionless() ? 0.0 : system.lone.kt[i],
           system.lone.kn[i],
           system.bound[i]};
}

double Increment::round_off_along(const VectorXd &rows, Index i) const
{
   double most = system.bound[i].slope(F[system.m(i)]) * rows[system.m(i)];
   for (Index k = 0; k < system.c; ++k) { most = std::max(most, rows[system.t(i, k)]); }
   return most;
}

void Increment::move_to(const VectorXd &displacements, const std::vector<NodeState> &states)
{
   u = displacements;
   F = f + system.product->times(u);
   status = states;
   find_pieces();
}

void Increment::move_to(const ContactState &there)
{
   move_to(system.frictionless() ? there.w : there.displacements(), there.status);
}

void Increment::find_pieces()
{
   if (!system.disc() && system.bends()) { piece = F.tail(system.n).cwiseMax(0.0); }
}

ContactState Increment::end() const
{
   const FrictionSystem &s = system;
   ContactState next = start;
   next.multipliers = multipliers;
   next.peak_force = reference;
   next.status = status;
   next.w = u.tail(s.n);
   next.p = F.tail(s.n);
   if (!s.frictionless())
   {
      next.v = u.head(s.c * s.n);
      next.q = F.head(s.c * s.n);
   }
   else if (s.without_slip->tangential)
   {
      next.v = s.without_slip->slip(start.v, next.w, s.problem.clamped_forces(multipliers));
      next.q.setZero();
      for (Index i = 0; i < s.n; ++i)
      {
         if (!closed(status[i])) { continue; }
         next.status[i] = s.problem.components() == 2 ? NodeState::slip
                          : next.v[i] >= start.v[i]   ? NodeState::forward_slip
                                                      : NodeState::backward_slip;
      }
   }
   // Held rows do not move, even if all forces are round-off so that any state is an answer.
   for (const Index row : s.problem.held) { next.v[row] = next.q[row] = 0; }
   // Round-off must not appear as a traction or an overlap.
   for (Index i = 0; i < s.n; ++i)
   {
      if (closed(status[i])) { continue; }
      next.p[i] = 0;
      for (Index k = i; k < next.q.size(); k += s.n) { next.q[k] = 0; }
   }
   return next;
}

void Increment::fit_states(ContactState &next) const
{
   const double allowed = system.settings.tolerance * scale();
   const VectorXd slips = next.v - start.v;
   for (Index i = 0; i < system.n; ++i)
   {
      ContactNode at = node(i);
      at.slip = along(slips, i);
      at.q = along(next.q, i);
      at.p = next.p[i];
      next.status[i] = fitting_state(at, next.status[i], allowed);
   }
}

bool Increment::residuals()
{
   const FrictionSystem &s = system;
   const VectorXd left = round_off();
   const double allowed = 0.5 * s.settings.tolerance * scale(); // reserve for the final check
   double normal = 0, tangential = 0;
   bool small = true;
   for (Index i = 0; i < s.n; ++i)
   {
      ContactNode at = node(i);
      const NodeResidual R = residual(at);
      normal = std::max(normal, std::abs(R.normal));
      small = small && std::abs(R.normal) <= std::max(allowed, left[s.m(i)]);
      if (s.frictionless()) { continue; }
      const double limit = std::max(allowed, round_off_along(left, i));
      // An open node carries no force, not even f times the round-off of its pressure.
      double size = magnitude(closed(status[i]) ? R.tangential : at.q);
      small = small && size <= limit;
      if (s.disc() && closed(status[i]))
      {
         // The natural map multiplies the error in the direction of a slip by the slip.
         const Index r = s.t(i, 0), c = s.t(i, 1);
         at.kt = std::max(s.K(r, r), s.K(c, c));
         const double uncertain = slip_round_off(magnitude(along(u, i)));
         small = small && slip_violation(at, uncertain) <= limit;
         size = std::max(size, slip_violation(at));
      }
      tangential = std::max(tangential, size);
   }
   report.residual_normal = normal / scale();
   report.residual_tangential = tangential / scale();
   report.round_off = left.maxCoeff() / scale();
   return small;
}

bool Increment::ends_here()
{
   next = end();
   const bool obeyed = system.obeys_laws(start.v, next, scale(), report);
   // The solution moves so far that its forces cannot be distinguished from round-off.
   if (report.round_off >= lost && report.round_off < 0.1)
   {
      cause.lost_in_round_off = report.round_off;
   }
   return obeyed;
}

bool Increment::finds_mechanism()
{
   Mechanism &mechanism = cause.mechanism;
   const VectorXd clamped = system.problem.clamped_forces(multipliers);
   const double negligible = system.settings.tolerance * reference;
   mechanism = find_mechanism(system.problem, clamped, negligible);
   if (mechanism.exists || !system.bends()) { return mechanism.exists; }
   const std::vector<FrictionLaw> &laws = system.problem.laws;
   if (!std::all_of(laws.begin(), laws.end(),
                    [](const FrictionLaw &law) { return law.concave(); }))
   {
      return false;
   }
   // No law allows more than the line of any of its pieces. Checked are the pieces at the start
   // of the increment, which is often close to the last equilibrium, and the present ones.
   for (const VectorXd &p : {start.p, VectorXd(F.tail(system.n))})
   {
      mechanism = find_mechanism(system.problem, system.lines_at(p), clamped, negligible);
      if (mechanism.exists) { break; }
   }
   return mechanism.exists;
}

} // namespace cattaneo
