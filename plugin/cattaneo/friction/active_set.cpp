// Newton's steps on the states of all nodes.

#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/disc.hpp>
#include <cattaneo/friction/methods.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Gives a node the piece of its bound at its pressure, unless the pressure is on the present
/// piece to `tiny`. True if the node slips and its piece has changed.
bool changes_piece(Increment &at, Index i, double tiny)
{
   const FrictionBound &bound = at.system.bound[i];
   if (at.piece.size() == 0 || !bound.bends()) { return false; }
   double &piece = at.piece[i];
   const double p = std::max(at.F[at.system.m(i)], 0.0);
   if (p >= bound.bend(piece, -1) - tiny && p <= bound.bend(piece, 1) + tiny) { return false; }
   piece = p;
   return slips(at.status[i]);
}

/// States and pieces as numbers, to compare sets of them.
std::vector<double> states_and_pieces(const Increment &at)
{
   std::vector<double> key;
   for (const NodeState state : at.status) { key.push_back(static_cast<double>(state)); }
   for (Index i = 0; i < at.piece.size(); ++i)
   {
      key.push_back(at.system.bound[i].bend(at.piece[i], -1));
   }
   return key;
}

} // namespace

Index ask_for_states(Increment &at)
{
   // Violations too small to change a state.
   const VectorXd tiny =
      (0.5 * at.round_off()).cwiseMax(0.1 * at.system.settings.tolerance * at.reference);
   Index changed = 0;
   for (Index i = 0; i < at.system.n; ++i)
   {
      const double tiny_normal = tiny[at.system.m(i)];
      const ContactNode node = at.node(i);
      const NodeState next =
         wanted_state(node, at.status[i], tiny_normal, at.round_off_along(tiny, i));
      const bool other_state = next != at.status[i];
      at.status[i] = next;
      if (changes_piece(at, i, tiny_normal) || other_state) { ++changed; }
   }
   return changed;
}

bool newton(Increment &at)
{
   if (at.system.disc()) { return newton_in_the_disc(at); }
   // Each step may cost a factor, of order n³. If only a few of many nodes keep changing,
   // Lemke's method is cheaper. It changes them one by one, at n² each.
   return newton_on_states([&] { return states_and_pieces(at); }, at.system.settings.max_newton,
                           at.system.n / 50, [&] { return solve_for_states(at); },
                           [&] { return ask_for_states(at); }) &&
          ends_with_least_motion(at);
}

bool polished(Increment &at)
{
   const VectorXd u = at.u;
   const std::vector<NodeState> status = at.status;
   if (newton(at)) { return true; }
   at.move_to(u, status);
   return ends_with_least_motion(at);
}

Search active_set(Increment &at)
{
   // With two tangents the number of Newton's steps is the same from the start and after
   // sweeps, so there are no sweeps.
   const int sweeps = at.system.disc() ? 0 : at.system.settings.sweeps;
   for (int k = 0; k < sweeps; ++k) { sweep(at); }
   at.find_pieces();
   at.swept = {at.u, at.status};
   return newton(at) ? Search::found : Search::not_here;
}

} // namespace cattaneo
