// Bodies that only contact keeps in place. Three questions: do the loads drive them away, where
// do they rest on weak springs, and what is the least motion if their place is not determined?

#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/friction/methods.hpp>
#include <cmath>
#include <utility>
#include <vector>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ---------------------------------------------------------------------------------------------
// Mechanisms: loads that no admissible contact forces can balance.

namespace
{

/// Forces inside the friction cones that balance the loads along the rigid motions as closely
/// as possible.
struct ConeFit
{
   NonnegativeFit fit;
   bool proven = false; ///< the residual belongs to the cones, not to too few edges
};

/// Do the fit's residual r and all edges prove that there is no equilibrium (Farkas)? With
/// edges·r <= 0 for all of them, rᵀG x <= 0 < rᵀg for any x >= 0; here they may be positive by
/// round-off, which matters if forces as large as the fit's could then do the work of r.
bool proves(const NonnegativeFit &fit, const MatrixXd &G)
{
   const double slope = (G.transpose() * fit.residual).maxCoeff();
   return slope * fit.x.sum() < 0.1 * fit.residual.squaredNorm();
}

/// For each round cone the edge that points most along r, if it does so by more than `least`.
MatrixXd edges_along(const MatrixXd &Z, const std::vector<FrictionBound> &bound,
                     const VectorXd &r, double least)
{
   const auto n = static_cast<Index>(bound.size());
   MatrixXd edges(Z.cols(), n);
   Index count = 0;
   for (Index i = 0; i < n; ++i)
   {
      const MatrixXd tangential = Z({i, n + i}, Eigen::all);
      const VectorXd along = tangential * r;
      VectorXd edge = Z.row(2 * n + i);
      if (along.norm() > 0)
      {
         edge += bound[i].slope() / along.norm() * tangential.transpose() * along;
      }
      if (edge.dot(r) > least * edge.norm()) { edges.col(count++) = edge; }
   }
   return edges.leftCols(count);
}

/// Forces inside the cones that balance the loads g along the motions Z, apart from a residual.
/// A residual below `enough` of the loads counts as zero.
ConeFit fit_to_cones(const MatrixXd &Z, const std::vector<FrictionBound> &bound,
                     const VectorXd &g, double enough)
{
   const bool disc = Z.rows() == 3 * static_cast<Index>(bound.size());
   MatrixXd G = cone_edges(Z, bound);
   ConeFit found{fit_nonnegative(G, g), false};
   found.proven = !disc && proves(found.fit, G);
   for (int round = 0; disc && round < 50 && !found.proven; ++round)
   {
      const VectorXd &r = found.fit.residual;
      if (!(r.norm() > enough * g.norm())) { break; }
      const MatrixXd more = edges_along(Z, bound, r, 1e-12 * g.norm());
      found.proven = more.cols() == 0;
      if (found.proven) { break; }
      G.conservativeResize(Eigen::NoChange, G.cols() + more.cols());
      G.rightCols(more.cols()) = more.rowwise().reverse();
      found.fit = fit_nonnegative(G, g);
   }
   return found;
}

/// Does a mechanism slide or spin, or only lift off? A body that slides has forces at nodes and
/// moves along these nodes. A body that lifts off has no forces, or forces only at nodes about
/// which it turns. `forces`: along the edges of the cones.
void describe(Mechanism &mechanism, const ReducedProblem &problem, const VectorXd &forces)
{
   const Index n = problem.nodes(), m = problem.slips(), c = problem.components(),
               edges = 2 * std::max<Index>(c, 1) * n;
   VectorXd borne = VectorXd::Zero(n);
   for (Index k = 0; k < edges; ++k) { borne[(k / 2) % n] += forces[k]; }
   const double sum = forces.sum();
   for (Index i = 0; i < n && m > 0; ++i)
   {
      double along = 0;
      for (Index k = 0; k < c; ++k)
      {
         along = std::max(along, std::abs(mechanism.motion[k * n + i]));
      }
      const bool bears = (c == 2 && sum > 0) || borne[i] > 1e-9 * sum ||
                         std::abs(mechanism.motion[m + i]) < 1e-9;
      mechanism.slides = mechanism.slides || (bears && along > 1e-6);
   }
   mechanism.spins = c == 2 && mechanism.motion.segment(n, n).cwiseAbs().maxCoeff() > 1e-6;
}

/// Work of the forces that nodes hold without pressure, along a motion.
double work_without_pressure(const ReducedProblem &problem,
                             const std::vector<FrictionBound> &bound, const VectorXd &motion)
{
   const Index n = problem.nodes();
   double work = 0;
   for (Index i = 0; i < n && problem.slips() > 0; ++i)
   {
      double along = -motion[i];
      if (problem.components() == 2) { along = std::hypot(along, motion[n + i]); }
      work += bound[i].intercept(0, along) * std::abs(along);
   }
   return work;
}

} // namespace

MatrixXd cone_edges(const MatrixXd &Z, const std::vector<FrictionBound> &bound)
{
   const auto n = static_cast<Index>(bound.size());
   const Index m = Z.rows() - n, lines = std::max(m, n);
   MatrixXd edges(Z.cols(), 2 * lines);
   for (Index row = 0; row < lines; ++row)
   {
      const Index i = row % n;
      const VectorXd normal = Z.row(m + i);
      const VectorXd tangential = m ? VectorXd(Z.row(row)) : VectorXd::Zero(Z.cols());
      edges.col(2 * row) = normal + bound[i].slope(0, -1) * tangential;
      edges.col(2 * row + 1) = normal - bound[i].slope(0, 1) * tangential;
   }
   return edges;
}

Mechanism find_mechanism(const ReducedProblem &problem, const VectorXd &clamped_forces,
                         double negligible)
{
   return find_mechanism(problem, friction_bounds(problem.friction), clamped_forces,
                         negligible);
}

Mechanism find_mechanism(const ReducedProblem &problem, const std::vector<FrictionBound> &bound,
                         const VectorXd &clamped_forces, double negligible)
{
   Mechanism mechanism;
   const MatrixXd &motions = problem.rigid_motions;
   if (motions.cols() == 0) { return mechanism; }
   // 1. Equilibrium along the rigid motions: Zᵀ{q; p} = Zᵀ f^w. A lever arm that is only
   // round-off could balance any load with very large forces.
   const double lever = 1e-13 * motions.cwiseAbs().maxCoeff();
   const MatrixXd Z = (motions.array().abs() < lever).select(0.0, motions);
   const VectorXd g = Z.transpose() * clamped_forces;
   if (g.norm() == 0) { return mechanism; }
   // 2. The least squares are solved to 1e-13 of the slope; the residual goes as its root where
   // edges are only approached, as those of round cones are.
   const bool disc = problem.components() == 2;
   const double enough = disc ? 1e-5 : 1e-12;
   const auto [fit, proven] = fit_to_cones(Z, bound, g, enough);
   const VectorXd &r = fit.residual;
   if (!proven || r.norm() <= enough * g.norm()) { return mechanism; }
   // 3. The loads that are left drive the bodies along this motion. If the motions are not
   // exactly rigid, the stiffness does work on them too.
   const MatrixXd &K = problem.K;
   const double lack =
      symmetric_times(K, Z).cwiseAbs().maxCoeff() / K.diagonal().cwiseAbs().maxCoeff();
   if (!disc && r.norm() <= 100 * lack * g.norm()) { return mechanism; }
   mechanism.motion = Z * r;
   // 4. Clamped forces hold the bodies, so the bodies move against this motion. Forces that
   // need no pressure resist it; the work of the loads along it is r·g = r².
   const double resisted = work_without_pressure(problem, bound, mechanism.motion);
   const double largest = mechanism.motion.cwiseAbs().maxCoeff();
   if (r.squaredNorm() <= (1 + 1e-9) * resisted || largest <= negligible) { return mechanism; }
   mechanism.exists = true;
   mechanism.motion /= largest;
   describe(mechanism, problem, fit.x);
   return mechanism;
}

Mechanism find_spinning(const ReducedProblem &problem, const VectorXd &frictionless_pressure,
                        const VectorXd &clamped_forces, double negligible)
{
   Mechanism mechanism;
   const Index n = problem.nodes();
   if (problem.components() != 2) { return mechanism; }
   const MatrixXd Z = rigid_slips(problem);
   if (Z.cols() != 1) { return mechanism; }
   double resistance = 0;
   for (Index i = 0; i < n; ++i)
   {
      resistance += friction_bound(problem, i).line(frictionless_pressure[i]) *
                    std::hypot(Z(i, 0), Z(n + i, 0));
   }
   const double drive = Z.col(0).dot(clamped_forces.head(2 * n));
   if (std::abs(drive) * Z.cwiseAbs().maxCoeff() <= negligible ||
       std::abs(drive) < (1 - 1e-9) * resistance)
   {
      return mechanism;
   }
   mechanism.exists = mechanism.slides = mechanism.spins = true;
   mechanism.motion = VectorXd::Zero(3 * n);
   mechanism.motion.head(2 * n) = (drive > 0 ? 1 : -1) / Z.cwiseAbs().maxCoeff() * Z.col(0);
   return mechanism;
}

// ---------------------------------------------------------------------------------------------
// Weak springs on the rigid motions.

namespace
{

/// A problem whose rigid motions have springs of one stiffness, which carry no force at the
/// displacements `anchor`. Their forces there are one more load pattern.
ReducedProblem with_springs(const ReducedProblem &problem, double spring,
                            const VectorXd &anchor)
{
   const MatrixXd &Z = problem.rigid_motions;
   const auto count = static_cast<Index>(problem.patterns.size());
   ReducedProblem sprung = problem;
   sprung.K += spring * Z * Z.transpose();
   join_coupling(sprung);
   const VectorXd pull = -spring * Z * (Z.transpose() * anchor);
   sprung.patterns.push_back(
      {"springs", Control::force, pull.head(problem.slips()), pull.tail(problem.nodes())});
   sprung.H.conservativeResizeLike(MatrixXd::Zero(count + 1, count + 1));
   sprung.rigid_motions = MatrixXd(Z.rows(), 0);
   sprung.chains.clear();
   sprung.held.clear();
   return sprung;
}

/// The multipliers, with one for the springs appended.
VectorXd with_one(const VectorXd &multipliers)
{
   VectorXd all(multipliers.size() + 1);
   all << multipliers, 1;
   return all;
}

/// The motion of a body that springs with these forces cannot stop.
Mechanism motion_of(const VectorXd &bears, const std::vector<NodeState> &states,
                    Index components)
{
   Mechanism mechanism;
   mechanism.motion = -bears / bears.cwiseAbs().maxCoeff();
   const auto n = static_cast<Index>(states.size());
   for (Index i = 0; i < n; ++i)
   {
      if (!closed(states[i])) { continue; }
      for (Index k = 0; k < components; ++k)
      {
         const bool slips = std::abs(mechanism.motion[k * n + i]) > 1e-6;
         mechanism.slides = mechanism.slides || slips;
         mechanism.spins = mechanism.spins || (k == 1 && slips);
      }
   }
   return mechanism;
}

/// Holds the rigid motions by weak springs, then by weaker and weaker ones. Each spring is
/// unstretched at the place that the bodies reached on the spring before. If the last three
/// springs carry the same force and a body slides at a closed node, the body moves without end
/// (if springs can show it). Otherwise the place where the springs hold the bodies is close to
/// an answer without springs. If the springs carry no force, the place is itself an answer. (A
/// balanced pivot, for which only round-off would decide to which side it leans, stays where it
/// is.)
OnSprings put_on_springs(Increment &at)
{
   FrictionSystem &s = at.system;
   const ReducedProblem &problem = s.problem;
   const MatrixXd &Z = problem.rigid_motions;
   OnSprings found;
   if (Z.cols() == 0) { return found; }
   VectorXd own(Z.rows()), borne;
   own << problem.A().diagonal(), problem.C().diagonal();
   const double soft = own.minCoeff(), mean = own.mean();
   // Springs prove something only if they are weak against the softest node, and yet above the
   // round-off of the stiffest one. Above critical friction a sliding body may also lock
   // itself.
   const bool tell = soft > 1e-6 * own.maxCoeff() && s.above_critical(at.start.p) < 0;
   VectorXd anchor = at.start.displacements();
   const VectorXd loads = with_one(at.multipliers);
   ContactState begin = at.start;
   begin.multipliers = with_one(begin.multipliers);
   int alike = 0; // number of successive springs with the same force as the one before
   for (double weakness : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
   {
      const double spring = weakness * (tell ? soft : mean);
      if (spring < 1e-13 * own.maxCoeff()) { break; } // round-off
      // 1. The end of the increment with these springs.
      FrictionSystem sprung(
         std::make_shared<ReducedProblem>(with_springs(problem, spring, anchor)), s.settings);
      Increment of_sprung(sprung, begin, loads);
      const bool solved = find_end_quickly(of_sprung);
      s.counters += sprung.counters;
      if (!solved)
      {
         if (alike > 0) { break; }
         borne.resize(0);
         continue;
      }
      // 2. The next springs are unstretched where these have let the bodies go.
      ContactState &next = of_sprung.next;
      if (!sprung.frictionless()) { of_sprung.fit_states(next); }
      const VectorXd moved = next.displacements() - anchor;
      const VectorXd bears = spring * Z * (Z.transpose() * moved);
      anchor += moved;
      found.state = next;
      found.state->multipliers = at.multipliers;
      found.state->peak_force = at.reference;
      // 3. If the springs carry no force, the state is an answer.
      const double size = bears.cwiseAbs().maxCoeff();
      found.bear_nothing = size <= s.settings.tolerance * at.reference;
      if (found.bear_nothing) { break; }
      // 4. If the force of the springs no longer changes, the bodies would move without end.
      const VectorXd before = std::exchange(borne, bears);
      const bool same = tell && before.size() > 0 && size > 1e-9 * at.reference &&
                        (bears - before).cwiseAbs().maxCoeff() <= 0.01 * size;
      alike = same ? alike + 1 : 0;
      found.away = same ? motion_of(bears, next.status, problem.components()) : Mechanism{};
   }
   // Springs prove nothing about a body that opens everywhere, because a spring may hold it
   // before it touches. For such a body find_mechanism() has the proof.
   found.away.exists = !found.bear_nothing && alike > 1 && found.away.slides;
   return found;
}

/// The steady rotation that the loads drive, which friction in the disc can hide from springs.
Mechanism find_spinning(Increment &at)
{
   FrictionSystem &s = at.system;
   const ReducedProblem &problem = s.problem;
   if (!s.disc() || problem.friction.maxCoeff() == 0 || problem.rigid_motions.cols() == 0)
   {
      return {};
   }
   // 1. The contact without friction, which could not carry the torque.
   auto without = std::make_shared<ReducedProblem>(problem);
   set_friction(*without, 0);
   const MatrixXd Z = rigid_slips(problem);
   for (LoadPattern &pattern : without->patterns)
   {
      pattern.q -= Z * (Z.transpose() * pattern.q);
   }
   FrictionSystem frictionless(without, s.settings);
   const ContactState virgin = ContactState::virgin(problem);
   Increment of_frictionless(frictionless, virgin, at.multipliers);
   if (!find_end_quickly(of_frictionless)) { return {}; }
   // 2. With its pressures.
   return find_spinning(problem, of_frictionless.next.p, problem.clamped_forces(at.multipliers),
                        s.settings.tolerance * at.reference);
}

} // namespace

bool moves_away(Increment &at)
{
   if (!at.springs)
   {
      at.springs = put_on_springs(at);
      if (!at.springs->away.exists) { at.springs->away = find_spinning(at); }
   }
   at.cause.mechanism = at.springs->away;
   return at.cause.mechanism.exists;
}

Search weak_springs(Increment &at)
{
   if (moves_away(at) || !at.springs->state) { return Search::not_here; }
   at.move_to(*at.springs->state);
   if (newton(at)) { return Search::found; }
   return at.springs->bear_nothing ? Search::hopeless : Search::not_here;
}

// ---------------------------------------------------------------------------------------------
// Motions that nothing resists. A body that slips at all of its nodes has such a motion, and
// its place follows only from the history of its slip.

MatrixXd free_motions(const ReducedProblem &problem, const std::vector<NodeState> &states)
{
   const MatrixXd &Z = problem.rigid_motions;
   const Index n = problem.nodes(), slips = problem.slips();
   std::vector<Index> resisting;
   for (Index i = 0; i < n && Z.cols() > 0; ++i)
   {
      if (closed(states[i])) { resisting.push_back(slips + i); }
      for (Index row = i; states[i] == NodeState::stick && row < slips; row += n)
      {
         resisting.push_back(row);
      }
   }
   return resisting.empty() ? MatrixXd(Z.rows(), 0) : at_rest(Z, Z(resisting, Eigen::all));
}

bool may_slide(const Increment &at)
{
   const ReducedProblem &problem = at.system.problem;
   if (problem.rigid_motions.cols() == 0 || at.report.round_off <= may_hide_sliding)
   {
      return false;
   }
   const std::vector<NodeState> &before = at.start.status;
   const bool touched = std::any_of(before.begin(), before.end(), closed);
   return !touched || free_motions(problem, at.status).cols() > 0;
}

namespace
{

/// Moves a body that slips at all nodes where it touches to the place of least motion that its
/// states allow, measured along the length of the contact: where the last sticking node let go,
/// for instance. (Not for friction in the disc.)
void move_least(Increment &at)
{
   const FrictionSystem &s = at.system;
   if (s.c != 1) { return; }
   const MatrixXd free = free_motions(s.problem, at.status);
   if (free.cols() == 0) { return; }
   // Rows that can move in one direction only: slip and gaps.
   std::vector<Index> bounded;
   std::vector<double> way;
   for (Index i = 0; i < s.n; ++i)
   {
      bounded.push_back(closed(at.status[i]) ? s.t(i) : s.m(i));
      way.push_back(closed(at.status[i]) ? sense(at.status[i]) : 1.0);
   }
   // Motions whose squares, by the length of the contact, are of size one.
   const VectorXd unit = node_lengths(s.problem).replicate(2, 1).cwiseSqrt();
   const MatrixXd R = thin_qr(unit.asDiagonal() * free).R;
   const MatrixXd motions =
      R.transpose().triangularView<Eigen::Lower>().solve(free.transpose()).transpose();
   const Eigen::Map<const VectorXd> sign(way.data(), static_cast<Index>(way.size()));
   const MatrixXd G = sign.asDiagonal() * motions(bounded, Eigen::all);
   VectorXd from = at.start.displacements();
   from.tail(s.n) = -s.problem.gap;
   VectorXd u = at.u;
   // Done twice, because the motion before may have been large.
   for (int k = 0; k < 2; ++k)
   {
      const VectorXd moved = u - at.start.displacements();
      u -= motions * (motions.transpose() * unit.cwiseAbs2().cwiseProduct(moved));
      const VectorXd left = u - from;
      const auto back = least_distance(G, -sign.cwiseProduct(VectorXd(left(bounded))));
      if (!back) { return; }
      u += motions * *back;
   }
   at.move_to(u, at.status);
}

} // namespace

bool ends_with_least_motion(Increment &at)
{
   move_least(at);
   return at.ends_here();
}

// ---------------------------------------------------------------------------------------------
// Clearance before the first load.

std::optional<VectorXd> taken_up_clearance(const ReducedProblem &problem,
                                           const VectorXd &clamped_forces)
{
   const Index n = problem.nodes(), slips = problem.slips();
   std::vector<Index> touching, open;
   for (Index i = 0; i < n; ++i)
   {
      if (problem.gap[i] > 0)
      {
         open.push_back(i);
         continue;
      }
      for (Index row = i; row < slips + n; row += n) { touching.push_back(row); }
   }
   const MatrixXd &all = problem.rigid_motions;
   if (all.cols() == 0 || open.empty()) { return {}; }
   const MatrixXd Z = at_rest(all, all(touching, Eigen::all));
   // Round-off of loads that balance each other moves nothing.
   const VectorXd d = -(Z.transpose() * clamped_forces);
   if (d.size() == 0 || d.norm() <= 1e-9 * clamped_forces.norm()) { return {}; }
   const MatrixXd W = Z.bottomRows(n)(open, Eigen::all);
   const VectorXd g = problem.gap(open), closing = -(W * d);
   const auto unborne = [&](const MatrixXd &rows)
   { return fit_nonnegative(rows.transpose(), -d).residual.norm(); };
   const double negligible = 1e-9 * d.norm();
   if (unborne(W) > negligible) { return {}; }
   for (double far = 10; far < 1e7; far *= 10)
   {
      const double t = far * g.maxCoeff() / closing.maxCoeff();
      const std::optional<VectorXd> rest = least_distance(W, t * closing - g);
      if (!rest) { continue; }
      const VectorXd c = *rest + t * d, left = g + W * c;
      std::vector<Index> bearing;
      for (Index k = 0; k < left.size(); ++k)
      {
         if (left[k] <= 1e-9 * far * g.maxCoeff()) { bearing.push_back(k); }
      }
      if (bearing.empty() || unborne(W(bearing, Eigen::all)) > negligible) { continue; }
      VectorXd u = Z * c;
      // Round-off must not look like penetration.
      for (Index i : open) { u[slips + i] = std::max(u[slips + i], -problem.gap[i]); }
      return u;
   }
   return {};
}

} // namespace cattaneo
