#include <algorithm>
#include <cattaneo/friction/disc.hpp>
#include <cattaneo/friction/methods.hpp>
#include <set>

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
   std::set<std::vector<NodeState>> visited;
   // A few nodes of many that go on changing do so up to the last step allowed. Each step may
   // cost a factor, of order n³: the path takes them one by one at n² each.
   constexpr int enough = 8;
   const Index few = at.system.n / 50;
   Index fewest = at.system.n + 1;
   int patience = enough;
   for (int k = 0; k < at.system.settings.max_newton && patience > 0; ++k)
   {
      if (!visited.insert(at.status).second) { return false; } // it cycles
      if (!solve_for_states(at)) { return false; }
      const Index changed = ask_for_states(at);
      if (changed == 0) { return ends_with_least_motion(at); }
      patience = changed < fewest || fewest > few ? enough : patience - 1;
      fewest = std::min(fewest, changed);
   }
   return false;
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
      at.u_swept = at.u;
      at.status_swept = at.status;
      if (newton(at)) { return Search::found; }
      sweeps = std::max(4, 2 * sweeps);
   }
   return Search::not_here;
}

} // namespace cattaneo
