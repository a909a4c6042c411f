#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/friction/contact_law.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/contact_edges.hpp>
#include <cmath>
#include <limits>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

namespace
{

std::vector<bool> closed_nodes(const ReducedProblem &problem, const ContactState &state)
{
   const std::vector<NodeState> settled = settled_states(problem, state);
   std::vector<bool> nodes(settled.size());
   for (std::size_t i = 0; i < nodes.size(); i++) { nodes[i] = closed(settled[i]); }
   return nodes;
}

/** Forces and displacements for given v at the tied nodes and given w at the closed ones. The
    other nodes carry no such force: q = A v + Bᵀ w + q0, p = B v + C w + p0. */
void release(const ReducedProblem &problem, const std::vector<bool> &tied,
             const std::vector<bool> &shut, const VectorXd &clamped, ContactState &state)
{
   const Index n = problem.nodes();
   VectorXd u = state.displacements();
   std::vector<Index> free;
   for (Index row = 0; row < 2 * n; row++)
   {
      if (!(row < n ? tied[row] : shut[row - n])) { free.push_back(row); }
   }
   const Eigen::MatrixXd &K = problem.K;
   u(free).setZero();
   VectorXd forces = K * u + clamped;
   if (!free.empty())
   {
      const VectorXd x = solve_semidefinite(K(free, free), -forces(free));
      u(free) = x;
      forces = K * u + clamped;
      forces(free).setZero();
   }
   state.v = u.head(n);
   state.w = u.tail(n);
   state.q = forces.head(n);
   state.p = forces.tail(n);
}

void check(const ReducedProblem &problem, const ContactState &pressed,
           const ContactState &loaded)
{
   require(problem.components() == 1,
           "the near-edge field needs a plane contact with "
           "friction: the problem has ",
           problem.components(), " tangential components per node, must have 1.");
   pressed.validate(problem);
   loaded.validate(problem);
}

void check_one_chain(const ReducedProblem &problem)
{
   const std::vector<int> chain = chain_numbers(problem);
   for (Index i = 1; i < problem.nodes(); i++)
   {
      require(chain[i] == chain[i - 1],
              "the contact line has several pieces (one ends at node ", i - 1,
              " at arc length ", problem.arc_length[i - 1], "), must be one piece.");
   }
}

/// Refuses a loop that is in contact at its first and last node: a stretch of contact would be
/// cut in two there.
void check_seam(const ReducedProblem &problem, const ContactState &loaded)
{
   if (problem.chains.empty() || !problem.chains[0].loop) { return; }
   const std::vector<bool> shut = closed_nodes(problem, loaded);
   for (const Index i : {Index(0), problem.nodes() - 1})
   {
      require(!shut[i], "the contact line is a loop, and touches at node ", i,
              ", next to its beginning: a loop must be out of contact "
              "at its first and last node (let its numbers begin there).");
   }
}

bool mirrored(const ReducedProblem &problem, Index node)
{
   return !problem.chains.empty() &&
          ((node == 0 && problem.chains.front().mirrored_at(0)) ||
           (node == problem.nodes() - 1 && problem.chains.back().mirrored_at(1)));
}

/// The middle of a stretch of contact together with its mirror image, if it has one.
double middle_of(const ReducedProblem &problem, const Zone &stretch)
{
   for (const Index end : {stretch.first, stretch.last})
   {
      if (!mirrored(problem, end)) { continue; }
      const std::vector<Index> &held = problem.held;
      const bool on_plane = std::count(held.begin(), held.end(), end) > 0;
      // The node on the axis of revolution is not in the line; this node is its neighbour.
      const double beside =
         on_plane || problem.position.rows() == 0 ? 0.0 : std::abs(problem.position(end, 0));
      return problem.arc_length[end] + (end == stretch.first ? -beside : beside);
   }
   return 0.5 * (stretch.from.position + stretch.to.position);
}

/// Marks an edge at an end of the line as complete or cut off, with the reason why it has no
/// intensities.
void refuse_at_end(const ReducedProblem &problem, ContactEdge &edge)
{
   const std::size_t end = edge.side > 0 ? 0 : 1;
   const bool cut_off = !problem.chains.empty() &&
                        problem.chains[0].ends[end] == LineEnd::smooth &&
                        problem.chains[0].other_ends[end] == LineEnd::smooth;
   edge.complete = !cut_off;
   std::ostringstream text;
   text << "the contact reaches the end of the contact line at arc length "
        << edge.position.position;
   if (cut_off)
   {
      text << ", where both bodies go on smoothly: it is cut off there and has neither K_N nor "
              "K_T; name more of the boundaries as contact.";
   }
   else
   {
      text << ": the edge is complete (a corner) or cut off there. Its pressure does not "
              "fall to zero as K_N √t, so that it has neither K_N nor K_T. Fit the "
              "intensities of the corner, or lengthen the line if it was cut off.";
   }
   edge.why_not = text.str();
}

/// Where a quantity that is smooth across an edge vanishes, with an estimate of the error.
struct Zero
{
   double position = 0.0;
   double error = std::numeric_limits<double>::infinity();
};

/** Zero nearest to t = 0 of a parabola through values at distances t (increasing, in spacings).
    As many values are used as give the smallest error. The error is the larger of the standard
    error and the change when a cubic is fitted. */
Zero nearest_zero(const VectorXd &t, const VectorXd &values, const VectorXd &weights)
{
   Zero best;
   for (Index count = 6; count <= t.size(); count++)
   {
      const double scale = t[count - 1];
      const VectorXd root = weights.head(count).cwiseSqrt(),
                     rhs = root.cwiseProduct(values.head(count));
      const Eigen::MatrixXd terms = root.asDiagonal() * powers(t.head(count) / scale, 3);
      const ScatteredFit parabola(terms.leftCols(3), rhs);
      const VectorXd &c = parabola.x;
      const double under = c[1] * c[1] - 4 * c[0] * c[2];
      if (!(under > 0 && c[1] > 0)) { continue; }
      const double zero = -2 * c[0] / (c[1] + std::sqrt(under));
      const double slope = c[1] + 2 * c[2] * zero;
      // At the zero: scatter of the parabola, and the cubic's value.
      const double standard = parabola.error(Eigen::Vector3d(1, zero, zero * zero));
      const VectorXd d = least_squares(terms, rhs);
      const double other = d[0] + zero * (d[1] + zero * (d[2] + zero * d[3]));
      const double error = std::max(standard, std::abs(other)) / slope * scale;
      if (error < best.error) { best = {zero * scale, error}; }
   }
   return best;
}

/// Extrapolates `value` to its zero near an end of contact, from the nodes of the half stretch
/// at that end. The two nodes nearest to the end are left out, because they carry parts of
/// elements that are not wholly in contact.
template <class Value>
Zero zero_near_end(const ReducedProblem &problem, Index end, Index last, int side,
                   const Value &value)
{
   const VectorXd &s = problem.arc_length;
   const double h = std::abs(s[end + side] - s[end]);
   const Index count = std::max<Index>(side * (last - end) - 1, 0);
   VectorXd t(count), values(count), weights(count);
   for (Index k = 0; k < count; k++)
   {
      const Index i = end + side * (k + 2);
      t[k] = std::abs(s[i] - s[end]) / h;
      values[k] = value(i);
      weights[k] = problem.weights[i];
   }
   Zero zero = nearest_zero(t, values, weights);
   // It must lie within a spacing, else it was not found.
   if (!(zero.position > -2 && zero.position < 1)) { return {}; }
   return {s[end] + side * h * zero.position, h * zero.error};
}

/// Positions where the stuck shear of these tied nodes is singular, one for each edge.
std::vector<Zero> singular_positions(const ReducedProblem &problem, const ContactState &loaded,
                                     const std::vector<Zone> &contact,
                                     const std::vector<ContactEdge> &edges,
                                     const std::vector<bool> &tied)
{
   const Index n = problem.nodes();
   const VectorXd &s = problem.arc_length;
   ContactState misfit = loaded;
   misfit.v.setZero();
   misfit.w.setZero();
   for (const Zone &stretch : contact)
   {
      const double middle = middle_of(problem, stretch);
      for (Index i = std::max<Index>(stretch.first - 1, 0);
           i <= std::min(stretch.last + 1, n - 1); i++)
      {
         misfit.v[i] = s[i] - middle;
      }
   }
   const VectorXd strain = misfit.v;
   release(problem, tied, closed_nodes(problem, loaded), VectorXd::Zero(2 * n), misfit);
   const VectorXd q = tractions(problem, misfit.q);
   std::vector<Zero> positions;
   for (const ContactEdge &edge : edges)
   {
      const int side = edge.side;
      Index end = side > 0 ? edge.first : edge.last;
      if (tied[end - side]) { end -= side; }
      // (strain/q)² is a parabola for a Hertz contact; near its middle both vanish.
      const Index half = side > 0 ? edge.last - 1 : edge.first + 1;
      Zero zero = zero_near_end(problem, end, half, side,
                                [&](Index i) { return std::pow(strain[i] / q[i], 2); });
      // Search inwards, because the last node of the line may be tied beyond the edge.
      const double h = std::abs(s[end + side] - s[end]);
      if (!std::isfinite(zero.error)) { zero = {s[end] - 0.5 * side * h, 0.5 * h}; }
      positions.push_back(zero);
   }
   return positions;
}

/// From the edge to the first stick zone.
void read_slip_zone(const ReducedProblem &problem, const std::vector<Zone> &all,
                    const Zone &stretch, ContactEdge &edge)
{
   std::vector<Zone> inside;
   for (const Zone &zone : all)
   {
      if (zone.first >= stretch.first && zone.last <= stretch.last) { inside.push_back(zone); }
   }
   if (edge.side < 0) { std::reverse(inside.begin(), inside.end()); }
   if (inside.front().state == NodeState::stick)
   {
      // Slip between the last two nodes is not visible.
      const Index end = edge.side > 0 ? stretch.first : stretch.last;
      edge.slip_zone_error =
         !edge.why_not.empty()
            ? 0
            : std::abs(problem.arc_length[end - edge.side] - problem.arc_length[end]);
      return;
   }
   for (const Zone &zone : inside)
   {
      if (zone.state != NodeState::stick) { continue; }
      const ZoneBorder front = edge.side > 0 ? zone.from : zone.to;
      edge.slip_zone = std::abs(front.position - edge.position.position);
      edge.slip_zone_error = front.error + edge.position.error;
      return;
   }
   edge.slides = true;
   edge.slip_zone = 2 * edge.half_width;
}

/// Locates the edges of a stretch of contact, or of its half if the other half is its mirror
/// image.
std::vector<ContactEdge> edges_of(const ReducedProblem &problem, const ContactState &loaded,
                                  const Zone &stretch, const FitSettings &settings)
{
   // The node on a plane of symmetry is the middle of the whole contact.
   const bool from_mirror = mirrored(problem, stretch.first),
              to_mirror = mirrored(problem, stretch.last);
   const Index mirrors = from_mirror + to_mirror;
   if (mirrors == 2) { return {}; }
   // Each edge has half of a stretch.
   const bool chosen = settings.window.farthest == 0;
   const Index least = 2 * (FitSettings::least_nodes + (chosen ? settings.skip : 0));
   const Index half = stretch.last - stretch.first + 1, size = mirrors ? 2 * half - 1 : half;
   require(size >= least, "a stretch of contact has ", size,
           " nodes; the fit of its edges needs at least ", least, ": refine the contact.");
   // With an odd number of nodes the middle one belongs to both edges, as on a plane of
   // symmetry. Either edge of a symmetric contact, whole or half, is then fitted to the same
   // number of nodes.
   const Index sum = stretch.first + stretch.last,
               left = from_mirror ? stretch.first
                      : to_mirror ? stretch.last
                                  : sum / 2,
               right = mirrors ? left : sum - left;
   std::vector<ContactEdge> found;
   for (const int side : {1, -1})
   {
      if (side > 0 ? from_mirror : to_mirror) { continue; }
      ContactEdge edge;
      edge.side = side;
      edge.position = side > 0 ? stretch.from : stretch.to;
      edge.first = side > 0 ? stretch.first : right;
      edge.last = side > 0 ? left : stretch.last;
      const FrictionBound at = friction_bound(problem, side > 0 ? edge.first : edge.last);
      require(at.slope(0, 1) == at.slope(0, -1),
              "contact edges: at zero pressure the coefficient of friction is ", at.slope(0, 1),
              " for slip forward and ", at.slope(0, -1),
              " for slip backward, both must be equal at an edge");
      edge.friction = at.slope();
      if (side > 0 ? stretch.first == 0 : stretch.last == problem.nodes() - 1)
      {
         refuse_at_end(problem, edge);
      }
      else
      {
         // p² is smooth (a parabola for Hertz) except at its last nodes. Its zero is used only
         // if its error is smaller than that of the border by zones().
         const VectorXd p = tractions(problem, loaded.p);
         const Index end = side > 0 ? edge.first : edge.last;
         const Zero zero = zero_near_end(problem, end, side > 0 ? edge.last : edge.first, side,
                                         [&](Index i) { return p[i] * p[i]; });
         const double h = std::abs(problem.arc_length[end - side] - problem.arc_length[end]);
         const double error = std::max(zero.error, 0.5 * h);
         if (error < edge.position.error) { edge.position = {zero.position, error}; }
      }
      found.push_back(edge);
   }
   const double first_edge = found.front().position.position,
                half_width = mirrors ? std::abs(first_edge - middle_of(problem, stretch))
                                     : 0.5 * (found.back().position.position - first_edge);
   for (ContactEdge &edge : found) { edge.half_width = half_width; }
   return found;
}

/// The tractions that are fitted if the edge is at this position.
EdgeTractions tractions_from(const ReducedProblem &problem, const ContactState &state,
                             ContactEdge edge, CrackedBody cracked, double position)
{
   edge.position.position = position;
   return edge_tractions(problem, state, edge, cracked);
}

void read_k_n(const ReducedProblem &problem, const ContactState &loaded, CrackedBody cracked,
              const FitSettings &settings, ContactEdge &edge)
{
   const auto fitted = [&](double shift)
   {
      const double position = edge.position.position + shift;
      return fit_edge(tractions_from(problem, loaded, edge, cracked, position), settings).k_n;
   };
   FittedIntensity &k_n = edge.k_n;
   k_n = fitted(0);
   // Adds the change of K_N by the error of the edge's position.
   double change = 0;
   for (const double shift : {-edge.position.error, edge.position.error})
   {
      change = std::max(change, std::abs(fitted(shift).value - k_n.value));
   }
   if (k_n.value > 0) { k_n.relative_error += change / k_n.value; }
}

/// Places at which the shear of two stuck solutions about an edge is singular.
struct StuckPair
{
   Zero from;              ///< the nodes in contact are tied
   Zero to;                ///< and one more, beyond the edge
   std::vector<bool> tied; ///< these
};

std::vector<StuckPair> stuck_pairs(const ReducedProblem &problem, const ContactState &loaded,
                                   const std::vector<ContactEdge> &edges,
                                   const std::vector<bool> &base)
{
   const VectorXd &s = problem.arc_length;
   const std::vector<Zone> contact = contact_zones(zones(problem, loaded));
   const std::vector<Zero> from = singular_positions(problem, loaded, contact, edges, base);
   std::vector<StuckPair> pairs;
   for (std::size_t e = 0; e < edges.size(); e++)
   {
      StuckPair pair{from[e], {}, base};
      const int side = edges[e].side;
      const Index end = side > 0 ? edges[e].first : edges[e].last;
      pair.tied[end - side] = true;
      pair.to = singular_positions(problem, loaded, contact, edges, pair.tied)[e];
      // One more tied node moves the singularity by about a spacing. If it was not found there,
      // take the place half a spacing beyond the last tied node, in both solutions.
      const double h = std::abs(s[end - side] - s[end]),
                   moved = side * (pair.from.position - pair.to.position);
      if (std::max(pair.from.error, pair.to.error) >= 0.5 * h || moved < 0.5 * h ||
          moved > 1.5 * h)
      {
         pair.from = {s[end] - 0.5 * side * h, 0.5 * h};
         pair.to = {s[end] - 1.5 * side * h, 0.5 * h};
      }
      // The scatter of a fit is not a bound, so the error is at least a quarter of a spacing,
      // as in zones().
      pair.from.error = std::max(pair.from.error, 0.25 * h);
      pair.to.error = std::max(pair.to.error, 0.25 * h);
      pairs.push_back(pair);
   }
   return pairs;
}

/// K_T of every edge at its own position, interpolated between the solution with the nodes in
/// contact stuck and the solutions with one more stuck node at each edge in turn.
void read_k_t(const ReducedProblem &problem, const ContactState &pressed,
              const ContactState &loaded, CrackedBody cracked, const FitSettings &settings,
              std::vector<ContactEdge> &edges)
{
   const std::vector<bool> base = closed_nodes(problem, loaded);
   const std::vector<StuckPair> pairs = stuck_pairs(problem, loaded, edges, base);
   const auto fitted = [&](const ContactState &stuck, std::size_t e, double position)
   {
      EdgeTractions tractions = tractions_from(problem, stuck, edges[e], cracked, position);
      // A node that is tied outside of the contact has no pressure, but its shear is fitted
      // too.
      std::fill(tractions.pressure.begin(), tractions.pressure.end(), 1.0);
      return fit_edge(tractions, settings).k_t;
   };
   const std::size_t count = edges.size();
   const ContactState base_state = fully_stuck(problem, pressed, loaded, base);
   std::vector<double> value(count), doubtful(count, 0.0);
   for (std::size_t e = 0; e < count; e++)
   {
      edges[e].k_t = fitted(base_state, e, pairs[e].from.position);
      value[e] = edges[e].k_t.value;
   }
   for (std::size_t e = 0; e < count; e++)
   {
      const ContactState stuck = fully_stuck(problem, pressed, loaded, pairs[e].tied);
      const Zero &from = pairs[e].from, &to = pairs[e].to;
      const double step = to.position - from.position;
      const double fraction = (edges[e].position.position - from.position) / step;
      const double doubt = edges[e].position.error + std::abs(1 - fraction) * from.error +
                           std::abs(fraction) * to.error;
      for (std::size_t other = 0; other < count; other++)
      {
         const double position = other == e ? to.position : pairs[other].from.position;
         const double change = fitted(stuck, other, position).value - edges[other].k_t.value;
         value[other] += fraction * change;
         doubtful[other] += std::abs(change / step) * doubt;
      }
   }
   for (std::size_t e = 0; e < count; e++)
   {
      FittedIntensity &k_t = edges[e].k_t;
      // Friction bounds the shear that pressing has left, so the K_T of this shear is zero. A
      // K_T that a fit finds in it is an error of the whole K_T.
      const double left = std::abs(fitted(pressed, e, pairs[e].from.position).value);
      const double error = k_t.relative_error * std::abs(k_t.value) + doubtful[e] + left;
      k_t.value = value[e];
      k_t.relative_error = error > 0 ? error / std::abs(k_t.value) : 0.0;
      // Shear below the round-off of the friction limit is zero.
      const double bears = edges[e].friction * edges[e].k_n.value * edges[e].half_width;
      if (std::abs(k_t.value) <= 1e-9 * bears) { k_t.value = k_t.relative_error = 0; }
   }
}

} // namespace

ContactState fully_stuck(const ReducedProblem &problem, const ContactState &pressed,
                         const ContactState &loaded, const std::vector<bool> &tied)
{
   check(problem, pressed, loaded);
   require(Index(tied.size()) == problem.nodes(), "there are ", tied.size(),
           " entries for tied nodes, must be one for each of the ", problem.nodes(), " nodes.");
   ContactState stuck = loaded;
   stuck.v = pressed.v;
   stuck.w = -problem.gap;
   stuck.slip_origin = pressed.v;
   const std::vector<bool> shut = closed_nodes(problem, loaded);
   for (std::size_t i = 0; i < tied.size(); i++)
   {
      stuck.status[i] = shut[i] ? NodeState::stick : NodeState::separation;
   }
   release(problem, tied, shut, problem.clamped_forces(loaded.multipliers), stuck);
   return stuck;
}

ContactState fully_stuck(const ReducedProblem &problem, const ContactState &pressed,
                         const ContactState &loaded)
{
   return fully_stuck(problem, pressed, loaded, closed_nodes(problem, loaded));
}

void ContactEdge::validate(const ReducedProblem &problem) const
{
   const Index n = problem.nodes();
   require(first >= 0 && last < n && first <= last, "the edge is of nodes ", first, " to ",
           last, ", must be of 0 to ", n - 1, " (is it one of this problem?)");
   require(problem.weights.size() == n, "the problem has ", problem.weights.size(),
           " weights, must have one for each of its ", n, " nodes");
}

EdgeTractions edge_tractions(const ReducedProblem &problem, const ContactState &state,
                             const ContactEdge &edge, CrackedBody cracked)
{
   edge.validate(problem);
   require(problem.arc_length.size() == problem.nodes(), "the problem has ",
           problem.arc_length.size(), " arc lengths for its ", problem.nodes(), " nodes");
   // q is the force on body 1 along increasing arc length.
   const double sign = cracked == CrackedBody::first ? 1 : -1;
   const VectorXd p = tractions(problem, state.p), q = tractions(problem, state.q);
   EdgeTractions result;
   result.edge = edge.position.position;
   if (edge.half_width > 0) { result.width = 2 * edge.half_width; }
   for (Index i = edge.first; i <= edge.last; i++)
   {
      // Only the nodes within the edge are used.
      if (edge.side * (problem.arc_length[i] - result.edge) <= 0) { continue; }
      result.position.push_back(problem.arc_length[i]);
      result.pressure.push_back(p[i]);
      result.shear.push_back(sign * q[i]);
   }
   return result;
}

std::vector<ContactEdge> contact_edges(const ReducedProblem &problem,
                                       const ContactState &pressed, const ContactState &loaded,
                                       CrackedBody cracked, const FitSettings &settings)
{
   check(problem, pressed, loaded);
   check_one_chain(problem);
   check_seam(problem, loaded);
   settings.validate();
   const std::vector<Zone> all = zones(problem, loaded);
   std::vector<ContactEdge> edges;
   for (const Zone &stretch : contact_zones(all))
   {
      for (ContactEdge &edge : edges_of(problem, loaded, stretch, settings))
      {
         read_slip_zone(problem, all, stretch, edge);
         edges.push_back(edge);
      }
   }
   // Fit only the edges that have intensities, then put them back in their places.
   const auto has_some = [](const ContactEdge &edge) { return edge.why_not.empty(); };
   std::vector<ContactEdge> read;
   std::copy_if(edges.begin(), edges.end(), std::back_inserter(read), has_some);
   for (ContactEdge &edge : read) { read_k_n(problem, loaded, cracked, settings, edge); }
   read_k_t(problem, pressed, loaded, cracked, settings, read);
   auto next = read.begin();
   for (ContactEdge &edge : edges)
   {
      if (has_some(edge)) { edge = *next++; }
   }
   return edges;
}

} // namespace cattaneo
