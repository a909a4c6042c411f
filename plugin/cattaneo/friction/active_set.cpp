#include <algorithm>
#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/disc.hpp>
#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

Index ask_for_states(Increment &at)
{
   // Violations that change nothing.
   const VectorXd tiny =
      (0.5 * at.round_off()).cwiseMax(0.1 * at.system.settings.tolerance * at.reference);
   Index changed = 0;
   for (Index i = 0; i < at.system.n; ++i)
   {
      const ContactNode node = at.node(i);
      const NodeState next =
         wanted_state(node, at.status[i], tiny[at.system.m(i)], at.round_off_along(tiny, i));
      // Without friction anywhere a node keeps this name, and has no tangential unknowns.
      if (next == NodeState::slip && at.system.disc())
      {
         at.direction[i] = DiscSlip(node.trial(), node.bound.at(node.p));
      }
      changed += next != at.status[i];
      at.status[i] = next;
   }
   return changed;
}

bool newton(Increment &at)
{
   if (at.system.disc()) { return newton_in_the_disc(at); }
   // Each step may cost a factor, of order n³: where a few nodes of many go on changing the
   // path takes them one by one at n² each.
   return newton_on_states(
             at.status, at.system.settings.max_newton, at.system.n / 50,
             [&] { return solve_for_states(at); }, [&] { return ask_for_states(at); }) &&
          ends_with_least_motion(at);
}

bool polished(Increment &at)
{
   const VectorXd u = at.u;
   const std::vector<NodeState> status = at.status;
   if (newton(at)) { return true; }
   at.take(u, status);
   return ends_with_least_motion(at);
}

Search active_set(Increment &at)
{
   const FrictionSettings &settings = at.system.settings;
   // In the disc Newton's steps are as many from the state at the start as from a swept one.
   if (at.system.disc() && newton(at)) { return Search::found; }
   at.go_back();
   int sweeps = settings.sweeps;
   for (int k = 0; k < settings.max_attempts; ++k)
   {
      if (k > 0) { at.go_back(); }
      for (int j = 0; j < sweeps; ++j) { sweep(at); }
      at.swept = {at.u, at.status};
      if (newton(at)) { return Search::found; }
      sweeps = std::max(4, 2 * sweeps);
   }
   return Search::not_here;
}

} // namespace cattaneo
