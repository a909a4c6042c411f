#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/facing.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cmath>
#include <map>
#include <sstream>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Least share of a node's weight on an element that must be faced for the node to have a
/// function there. With less the function would be extrapolated.
constexpr double least_share = 0.25;
/// Least share of its own node in the integrals of a dual function, on an element that is faced
/// in part.
constexpr double least_own = 0.1;
/// If a neighbour is shorter than this share of an element's length, the functions of the
/// element are narrowed at that end.
constexpr double short_neighbour = 0.2;

/// Round-off of roots, in parameters of an element.
constexpr double near = 1e-9;

/** Functions of an element's contact nodes, by component, as combinations of the element's
    functions (functions of the element × contact nodes). A node on the axis is no contact node:
    its displacement follows from the others, as displacements along the axis are even in r and
    those away from it odd. */
struct Trace
{
   std::vector<Index> nodes;  ///< of the line
   VectorXd places;           ///< their parameters
   std::array<MatrixXd, 2> x; ///< for components x and y

   explicit Trace(const LineElement &element)
   {
      const VectorXd points = lobatto_points(static_cast<int>(element.order()));
      std::vector<Index> kept;
      Index axis = -1;
      for (Index a = 0; a <= element.order(); ++a)
      {
         const Index node = element.nodes[a];
         if (node < 0) { axis = a; }
         else
         {
            kept.push_back(a);
            nodes.push_back(node);
         }
      }
      places = points(kept);
      const auto count = static_cast<Index>(kept.size());
      x[0] = MatrixXd::Zero(element.order() + 1, count);
      for (Index j = 0; j < count; ++j) { x[0](kept[j], j) = 1; }
      x[1] = x[0];
      for (Index j = 0; axis >= 0 && j < count; ++j)
      {
         double &value = x[1](axis, j) = 1;
         for (Index l = 0; l < count; ++l)
         {
            const double r = element.points(0, kept[l]), own = element.points(0, kept[j]);
            if (l != j) { value *= r * r / (r * r - own * own); }
         }
      }
   }
};

/// A point of integration on a slave element, and what it faces.
struct Point
{
   double s, weight;
   std::size_t other;    ///< element of the master
   VectorXd own, facing; ///< functions of both elements
   Vector2d apart;       ///< x_s - x_m, on the outlines
   Vector2d chords;      ///< by which smooth curves would change it
   Vector2d curved;      ///< its distance along the normal, less the value on the chords
};

/// A point of a line's outline.
struct Outline
{
   Vector2d place, left;  ///< the point, and the distance of a smooth curve from it
   Vector2d curved{0, 0}; ///< distance from the chord, if a curve was taken

   Outline(const ElementCurve &curve, double s, bool as_meshed)
      : place(curve.place(s)), left(curve.bulge(s))
   {
      const LineElement &element = *curve.element;
      const Vector2d off = element.off_curve(s), from = element.points.col(0);
      (as_meshed ? left : place) += off;
      left += element.off_possible(s);
      if (as_meshed || !element.bend || element.bend->straight()) { return; }
      // Across the chord, wherever along it the point is.
      const Vector2d chord = element.points.rightCols(1) - from, right(chord[1], -chord[0]);
      curved = right.dot(place - from) / right.squaredNorm() * right;
   }
};

/// Is the outline of an element a curve whose chord the element is?
bool follows_curve(const ElementCurve &curve, bool as_meshed)
{
   return !as_meshed && curve.element->bend && !curve.element->bend->straight();
}

/** Parameter of the point on another element's curve that faces a point of an outline, across
    the mean of both curves' directions. t is the answer of the elements themselves. Two arcs of
    one circle then face each other at the same place, and their gap is zero whatever their
    chords. The answer may lie a little beyond the element's ends, where its curve goes on. */
double opposite_on_curve(const ElementCurve &first, double s, const ElementCurve &other,
                         double t)
{
   const LineElement &one = *first.element, &two = *other.element;
   const Vector2d place = Outline(first, s, false).place, along = one.curve_tangent(s),
                  chord = two.points.rightCols(1) - two.points.leftCols(1);
   double at = t;
   for (int step = 0; step < 20; ++step)
   {
      const Vector2d direction = two.curve_tangent(at), mean = along - direction;
      const double speed = chord.norm() * chord.norm() / chord.dot(direction);
      const double by =
         (place - Outline(other, at, false).place).dot(mean) / (speed * direction.dot(mean));
      if (!(std::abs(at + by - t) < 0.2))
      {
         return t;
      } // the step is too large: keep the point on the straight elements
      at += by;
      if (std::abs(by) < 1e-15) { break; }
   }
   // Elements that match do so to the last bit.
   return std::abs(at - (1 - s)) <= 1e-13 ? 1 - s : at;
}

/// Hat functions at all points (functions × points): linear from each place to the next,
/// constant beyond the outer places, never negative. The rule does not integrate their kinks
/// exactly, which does not matter, as all their integrals use the same points.
MatrixXd hats(const VectorXd &places, const std::vector<Point> &points)
{
   const auto last = static_cast<std::size_t>(places.size() - 1);
   MatrixXd values = MatrixXd::Zero(places.size(), static_cast<Index>(points.size()));
   for (std::size_t p = 0; p < points.size(); ++p)
   {
      const double s = points[p].s;
      const auto next = static_cast<std::size_t>(
         std::upper_bound(places.data(), places.data() + places.size(), s) - places.data());
      const std::size_t low = next > 0 ? next - 1 : 0, high = std::min(next, last);
      const double share =
         low == high ? 0
                     : (s - places[Index(low)]) / (places[Index(high)] - places[Index(low)]);
      values(Index(low), Index(p)) += 1 - share;
      values(Index(high), Index(p)) += share;
   }
   return values;
}

/// Lengths at both ends of an element that belong to short neighbours, in parameters; 0 if
/// none.
using NearEnds = std::array<double, 2>;

/// The functions of an element's nodes at the points. At an end with a short neighbour the
/// function becomes a hat as narrow as the neighbour, and the next node gets the difference.
/// The sum stays 1.
MatrixXd narrowed(MatrixXd functions, const VectorXd &places, const std::vector<Point> &points,
                  const NearEnds &ends)
{
   const Index last = places.size() - 1;
   const bool has_first = ends[0] > 0 && places[0] == 0,
              has_last = ends[1] > 0 && places[last] == 1;
   // With two nodes that both become narrow, no third function could get the difference.
   if (last < 1 || (last == 1 && has_first && has_last)) { return functions; }
   const auto narrow = [&](Index end, Index beside, double from, double reach)
   {
      for (std::size_t p = 0; p < points.size(); ++p)
      {
         const auto at = static_cast<Index>(p);
         const double hat = std::max(0.0, 1 - std::abs(points[p].s - from) / reach);
         functions(beside, at) += functions(end, at) - hat;
         functions(end, at) = hat;
      }
   };
   if (has_first) { narrow(0, 1, 0, ends[0]); }
   if (has_last) { narrow(last, last - 1, 1, ends[1]); }
   return functions;
}

/// Dual functions at the points (times their weights) for some of an element's nodes.
struct DualFunctions
{
   std::vector<int> nodes; ///< indices in Trace::nodes
   MatrixXd weighted;      ///< nodes × points
   bool positive = false;  ///< is the share of its own node large enough in each?
};

/// Dual functions to the functions `phi` of an element's nodes, as combinations of `tests`
/// (both: functions × points).
DualFunctions made_of(const MatrixXd &tests, const MatrixXd &phi, const VectorXd &weights,
                      const std::vector<int> &nodes)
{
   // ψ = diag(D) N⁻¹ B for N = ∫B φᵀ: ∫ψ_i φ_j = D_i δ_ij among the nodes with functions.
   const MatrixXd own = rows_of(phi, nodes);
   const MatrixXd B = tests * weights.asDiagonal();
   const VectorXd D = product(own, weights);
   DualFunctions found{nodes, D.asDiagonal() * solve_square(product(B, own.transpose()), B)};
   const VectorXd sums = found.weighted.rowwise().sum();
   found.positive = sums.minCoeff() > 0 && (D - least_own * sums).minCoeff() > 0 &&
                    found.weighted.allFinite();
   return found;
}

/// Why no part of one line faces the other, in words.
std::string why_apart(const FacingLines &lines)
{
   const auto towards = [](const std::vector<ElementCurve> &line)
   {
      Vector2d sum(0, 0);
      for (const ElementCurve &curve : line) { sum += curve.length() * curve.tangent(0.5); }
      return Vector2d(sum.normalized());
   };
   const bool opposed =
      std::any_of(lines.first.begin(), lines.first.end(),
                  [&](const ElementCurve &one)
                  {
                     return std::any_of(lines.other.begin(), lines.other.end(),
                                        [&](const ElementCurve &two)
                                        { return one.tangent(0.5).dot(two.tangent(0.5)) < 0; });
                  });
   if (opposed) { return "they lie beside each other, must lie over each other"; }
   const Vector2d one = towards(lines.first), two = towards(lines.other);
   // Outwards is to the right. Three decimals, zeros without a sign.
   const auto rounded = [](double x) { return std::round(1e3 * x) / 1e3 + 0.0; };
   std::ostringstream text;
   text << "their outward normals are (" << rounded(one[1]) << ", " << rounded(-one[0])
        << ") and (" << rounded(two[1]) << ", " << rounded(-two[0])
        << ") in the mean, must be opposite: are these the sides that touch?";
   return text.str();
}

/// Sums the integrals over the elements of the slave and the master.
class Assembly
{
public:
   Assembly(const ContactLine &slave, const ContactLine &master,
            const std::vector<int> &without, const std::string &what);
   Mortar result();

private:
   void add(std::size_t element);
   double covered(std::size_t element) const;
   bool is_faced(std::size_t element, double s) const;
   std::vector<Point> points_of(std::size_t element) const;
   double weight_at(const ElementCurve &curve, double s) const;
   void find_near_ends();
   DualFunctions dual(const Trace &trace, std::size_t element, const std::vector<Point> &points,
                      int component, const std::vector<int> &nodes) const;
   std::vector<int> functions_of(const Trace &trace, std::size_t element,
                                 const std::vector<Point> &points);
   void add_rows(const Trace &trace, std::size_t element, const std::vector<Point> &points,
                 const std::vector<Index> &rows, const std::array<MatrixXd, 2> &psi);
   struct Neighbour
   {
      Index row = -1;   ///< a node of the slave; -1: none
      int elements = 0; ///< elements without functions between it and this one
   };
   Neighbour neighbour(std::size_t element, bool after) const;
   void extend(std::size_t element);

   const ContactLine &slave_, &master_;
   const std::string &what_;
   std::vector<bool> without_, faced_, has_row_;
   FacingLines lines_;
   std::vector<std::vector<FacingPart>> parts_; ///< of each slave element
   std::vector<NearEnds> near_ends_;            ///< of each slave element
   std::vector<std::vector<Index>> functions_;  ///< rows on each slave element, along it
   std::vector<Trace> master_traces_;
   std::array<std::map<std::pair<Index, Index>, double>, 2> own_, other_;
   Eigen::MatrixX2d apart_, chords_,
      curved_; ///< ∫ψ times the values of the points, for each slave node
   VectorXd weights_, size_;
   double left_out_ = 0;
};

Assembly::Assembly(const ContactLine &slave, const ContactLine &master,
                   const std::vector<int> &without, const std::string &what)
   : slave_(slave), master_(master), what_(what), without_(slave.size(), false),
     faced_(slave.size(), false), has_row_(slave.size(), false),
     lines_(facing(slave, master, what)), parts_(lines_.first.size()),
     near_ends_(lines_.first.size(), NearEnds{0, 0}), functions_(lines_.first.size()),
     apart_(Eigen::MatrixX2d::Zero(slave.size(), 2)), chords_(apart_), curved_(apart_),
     weights_(VectorXd::Zero(slave.size())), size_(VectorXd::Zero(slave.size()))
{
   for (int node : without)
   {
      require(node >= 0 && node < slave.size(), what, ": node ", node,
              " of the slave is to have no contact condition, must be from 0 to ",
              slave.size() - 1);
      without_[node] = true;
   }
   for (const FacingPart &part : lines_.parts) { parts_[part.element].push_back(part); }
   for (const ElementCurve &curve : lines_.other)
   {
      master_traces_.emplace_back(*curve.element);
   }
   require(!lines_.parts.empty(), what_,
           ": the lines face each other nowhere: ", why_apart(lines_), " (one reaches ",
           extent(slave_), ", the other ", extent(master_), ")");
   find_near_ends();
   for (std::size_t e = 0; e < lines_.first.size(); ++e) { add(e); }
   for (std::size_t e = 0; e < lines_.first.size(); ++e) { extend(e); }
}

/** Finds the ends of long elements at short ones. The end node would use a mean of the other
    body over the long element, but nodes on the short element use the points that face them.
    Both differ by the part of the displacement that the long element cannot represent. This
    difference over the short length would be a large strain, and the pressure there would be
    many times that of all other nodes. So the function of the end node is only as wide as the
    short element. */
void Assembly::find_near_ends()
{
   std::map<Index, std::vector<std::pair<std::size_t, int>>>
      at; // element and its end, of nodes
   for (std::size_t e = 0; e < lines_.first.size(); ++e)
   {
      const std::vector<Index> &nodes = lines_.first[e].element->nodes;
      if (nodes.front() >= 0) { at[nodes.front()].emplace_back(e, 0); }
      if (nodes.back() >= 0) { at[nodes.back()].emplace_back(e, 1); }
   }
   for (const auto &[node, both] : at)
   {
      if (both.size() != 2) { continue; }
      for (std::size_t k : {0, 1})
      {
         const auto &[element, end] = both[k];
         const double ratio =
            lines_.first[both[1 - k].first].length() / lines_.first[element].length();
         if (ratio < short_neighbour) { near_ends_[element][end] = ratio; }
      }
   }
}

double Assembly::covered(std::size_t element) const
{
   double sum = 0;
   for (const FacingPart &part : parts_[element]) { sum += part.to - part.from; }
   return sum;
}

bool Assembly::is_faced(std::size_t element, double s) const
{
   return std::any_of(parts_[element].begin(), parts_[element].end(),
                      [s](const FacingPart &part)
                      { return s >= part.from - near && s <= part.to + near; });
}

double Assembly::weight_at(const ElementCurve &curve, double s) const
{
   return curve.derivative(s).norm() * measure(slave_.formulation, curve.place(s)[0]);
}

std::vector<Point> Assembly::points_of(std::size_t element) const
{
   const ElementCurve &curve = lines_.first[element];
   std::vector<Point> points;
   std::vector<FacingPart> pieces = parts_[element];
   // Narrow functions near an end are integrated over their own interval.
   const auto &[first, last] = near_ends_[element];
   for (double cut : {first, 1 - last})
   {
      const std::size_t count = cut > 0 && cut < 1 ? pieces.size() : 0;
      for (std::size_t k = 0; k < count; ++k)
      {
         if (cut <= pieces[k].from + near || cut >= pieces[k].to - near) { continue; }
         pieces.push_back(pieces[k]);
         pieces.back().from = pieces[k].to = cut;
      }
   }
   for (const FacingPart &part : pieces)
   {
      const ElementCurve &other = lines_.other[part.other];
      // Exact for the product of three functions of straight elements, with some more points
      // for curved ones.
      const QuadratureRule &rule = gauss_rule(
         static_cast<int>(curve.order() + std::max(curve.order(), other.order()) + 3));
      for (Index k = 0; k < rule.points.size(); ++k)
      {
         const double s = part.from + (part.to - part.from) * rule.points[k];
         double t = lines_.opposite(part, s);
         if (follows_curve(curve, slave_.as_meshed) && follows_curve(other, master_.as_meshed))
         {
            t = opposite_on_curve(curve, s, other, t);
         }
         const Outline own(curve, s, slave_.as_meshed), faced(other, t, master_.as_meshed);
         points.push_back({s, rule.weights[k] * (part.to - part.from) * weight_at(curve, s),
                           part.other, curve.functions(s), other.functions(t),
                           own.place - faced.place, own.left - faced.left,
                           own.curved - faced.curved});
      }
   }
   return points;
}

DualFunctions Assembly::dual(const Trace &trace, std::size_t element,
                             const std::vector<Point> &points, int component,
                             const std::vector<int> &nodes) const
{
   const auto count = static_cast<Index>(points.size());
   const bool all = nodes.size() == trace.nodes.size();
   MatrixXd phi(static_cast<Index>(trace.nodes.size()), count);
   VectorXd weights(count);
   for (Index p = 0; p < count; ++p)
   {
      phi.col(p) = trace.x[component].transpose() * points[p].own;
      weights[p] = points[p].weight;
   }
   const NearEnds &ends = near_ends_[element];
   if (all && ends != NearEnds{0, 0} && covered(element) > 1 - near)
   {
      DualFunctions found =
         made_of(narrowed(phi, trace.places, points, ends), phi, weights, nodes);
      if (found.positive) { return found; }
   }
   return made_of(all ? phi : hats(trace.places(nodes), points), phi, weights, nodes);
}

/// The nodes of an element that have functions on its faced part. Empty: the line does not face
/// the master there.
std::vector<int> Assembly::functions_of(const Trace &trace, std::size_t element,
                                        const std::vector<Point> &points)
{
   const ElementCurve &curve = lines_.first[element];
   const auto whole_weight = [&](int component, Index j)
   {
      const QuadratureRule &rule = gauss_rule(static_cast<int>(2 * curve.order() + 3));
      double sum = 0;
      for (Index k = 0; k < rule.points.size(); ++k)
      {
         const double s = rule.points[k];
         sum += rule.weights[k] * weight_at(curve, s) *
                trace.x[component].col(j).dot(curve.functions(s));
      }
      return sum;
   };
   std::vector<int> free, inside, ends;
   bool share = true; // is the share of all nodes large enough?
   for (int j = 0; j < static_cast<int>(trace.nodes.size()); ++j)
   {
      const Index node = trace.nodes[j];
      const double s = trace.places[j];
      for (int component : {0, 1})
      {
         const double whole = whole_weight(component, j);
         require(whole > 0, what_, ": the weight of the node at ", slave_.nodes[node].position,
                 " is ", whole,
                 " on an element of the slave, must be positive: is the element turned over?");
         double faced = 0;
         for (const Point &point : points)
         {
            faced += point.weight * trace.x[component].col(j).dot(point.own);
         }
         share = share && faced >= least_share * whole;
      }
      if (without_[node]) { continue; }
      free.push_back(j);
      if (is_faced(element, s))
      {
         inside.push_back(j);
         if (s == 0 || s == 1) { ends.push_back(j); }
      }
   }
   std::vector<std::vector<int>> choices{inside, ends};
   if (share || covered(element) > 1 - near) { choices.insert(choices.begin(), free); }
   for (int end : ends) { choices.push_back({end}); }
   for (const std::vector<int> &nodes : choices)
   {
      if (!nodes.empty() && dual(trace, element, points, 0, nodes).positive &&
          dual(trace, element, points, 1, nodes).positive)
      {
         return nodes;
      }
   }
   return {};
}

void Assembly::add(std::size_t element)
{
   if (covered(element) < near) { return; }
   const Trace trace(*lines_.first[element].element);
   for (std::size_t j = 0; j < trace.nodes.size(); ++j)
   {
      if (is_faced(element, trace.places[Index(j)])) { faced_[trace.nodes[j]] = true; }
   }
   const std::vector<Point> points = points_of(element);
   const std::vector<int> nodes = functions_of(trace, element, points);
   if (nodes.empty()) { return; }
   std::vector<Index> &rows = functions_[element];
   for (int node : nodes) { rows.push_back(trace.nodes[node]); }
   for (Index row : rows)
   {
      has_row_[row] = true;
      size_[row] = std::max(size_[row], lines_.first[element].length());
   }
   add_rows(trace, element, points, rows,
            {dual(trace, element, points, 0, nodes).weighted,
             dual(trace, element, points, 1, nodes).weighted});
}

/// Adds the integrals of functions on an element to rows. `psi` has the functions times the
/// weights of the points.
void Assembly::add_rows(const Trace &trace, std::size_t element,
                        const std::vector<Point> &points, const std::vector<Index> &rows,
                        const std::array<MatrixXd, 2> &psi)
{
   const std::vector<Index> &dual_to = functions_[element];
   for (int component : {0, 1})
   {
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
         const Index row = rows[i];
         for (std::size_t p = 0; p < points.size(); ++p)
         {
            const Point &point = points[p];
            const double value = psi[component](static_cast<Index>(i), static_cast<Index>(p));
            if (component == 1) { weights_[row] += value; }
            apart_(row, component) += value * point.apart[component];
            chords_(row, component) += value * point.chords[component];
            curved_(row, component) += value * point.curved[component];
            const Trace &other = master_traces_[point.other];
            const VectorXd facing = other.x[component].transpose() * point.facing;
            for (std::size_t m = 0; m < other.nodes.size(); ++m)
            {
               other_[component][{row, other.nodes[m]}] +=
                  value * facing[static_cast<Index>(m)];
            }
            const VectorXd own = trace.x[component].transpose() * point.own;
            for (std::size_t j = 0; j < trace.nodes.size(); ++j)
            {
               // Among nodes with functions this is zero, apart from round-off.
               const Index node = trace.nodes[j];
               if (node != row && std::count(dual_to.begin(), dual_to.end(), node))
               {
                  continue;
               }
               own_[component][{row, node}] += value * own[static_cast<Index>(j)];
            }
         }
      }
   }
}

/// The nearest row along the line before or after an element, if the line is faced up to there.
Assembly::Neighbour Assembly::neighbour(std::size_t element, bool after) const
{
   const std::vector<ElementCurve> &all = lines_.first;
   Neighbour found;
   for (std::size_t at = element; found.elements < static_cast<int>(all.size());
        ++found.elements)
   {
      const auto end = [](const ElementCurve &curve, bool last)
      { return last ? curve.element->nodes.back() : curve.element->nodes.front(); };
      const Index node = end(all[at], after);
      std::size_t next = 0;
      while (next < all.size() && (node < 0 || end(all[next], !after) != node)) { ++next; }
      if (next == all.size() || !is_faced(at, after ? 1 : 0) || !is_faced(next, after ? 0 : 1))
      {
         break;
      }
      const std::vector<Index> &rows = functions_[next];
      if (!rows.empty())
      {
         found.row = after ? rows.front() : rows.back();
         break;
      }
      at = next;
   }
   return found;
}

/** Gives the faced part of an element without functions to the next rows. Nodes of such an
    element carry rows of another interface, or lie beyond the faced part. The functions of the
    next rows go on into the element, so that a constant pressure stays constant there as well.
    */
void Assembly::extend(std::size_t element)
{
   if (covered(element) < near || !functions_[element].empty()) { return; }
   const std::vector<Point> points = points_of(element);
   const Neighbour before = neighbour(element, false), after = neighbour(element, true);
   std::vector<Index> rows;
   if (before.row >= 0) { rows.push_back(before.row); }
   if (after.row >= 0 && after.row != before.row) { rows.push_back(after.row); }
   MatrixXd psi(static_cast<Index>(rows.size()), static_cast<Index>(points.size()));
   for (std::size_t p = 0; p < points.size(); ++p)
   {
      const Point &point = points[p];
      if (rows.empty()) { left_out_ += point.weight; }
      else { psi.col(static_cast<Index>(p)).setConstant(point.weight); }
      if (rows.size() < 2) { continue; }
      const double length = before.elements + 1 + after.elements,
                   along = (before.elements + point.s) / length;
      psi(0, static_cast<Index>(p)) *= 1 - along;
      psi(1, static_cast<Index>(p)) *= along;
   }
   if (!rows.empty())
   {
      add_rows(Trace(*lines_.first[element].element), element, points, rows, {psi, psi});
   }
}

Mortar Assembly::result()
{
   Mortar made;
   std::vector<Index> number(slave_.size(), -1);
   for (Index i = 0; i < slave_.size(); ++i)
   {
      if (has_row_[i])
      {
         number[i] = static_cast<Index>(made.nodes.size());
         made.nodes.push_back(static_cast<int>(i));
      }
      else if (!faced_[i]) { made.free_surface.push_back(static_cast<int>(i)); }
   }
   const auto n = static_cast<Index>(made.nodes.size());
   made.weights = weights_(made.nodes);
   made.size = size_(made.nodes);
   made.left_out = left_out_;
   Eigen::MatrixX2d apart = apart_(made.nodes, Eigen::all),
                    chords = chords_(made.nodes, Eigen::all),
                    curved = curved_(made.nodes, Eigen::all);
   Eigen::MatrixX2d normal(n, 2), own_normal(n, 2), other_normal(n, 2);
   const auto normals1 = slave_.each(&LineNode::normal),
              normals2 = master_.each(&LineNode::normal);
   for (int c : {0, 1})
   {
      VectorXd sums = VectorXd::Zero(n);
      for (const auto &[at, value] : own_[c]) { sums[number[at.first]] += value; }
      const auto rows = [&](const auto &entries, Index columns)
      {
         std::vector<Eigen::Triplet<double>> list;
         for (const auto &[at, value] : entries)
         {
            const Index row = number[at.first];
            list.emplace_back(row, at.second, value / sums[row]);
         }
         Mortar::Matrix matrix(n, columns);
         matrix.setFromTriplets(list.begin(), list.end());
         return matrix;
      };
      made.own[c] = rows(own_[c], slave_.size());
      made.other[c] = rows(other_[c], master_.size());
      apart.col(c).array() /= sums.array();
      chords.col(c).array() /= sums.array();
      curved.col(c).array() /= sums.array();
      own_normal.col(c) = made.own[c] * normals1.col(c);
      other_normal.col(c) = made.other[c] * normals2.col(c);
      normal.col(c) = own_normal.col(c) - other_normal.col(c);
   }
   made.turn.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      made.turn[i] = angle_between(own_normal.row(i), -other_normal.row(i));
   }
   normal.rowwise().normalize();
   made.tangent.resize(n, 2);
   made.tangent << normal.col(1), -normal.col(0);
   made.gap = normal.cwiseProduct(apart).rowwise().sum();
   made.chords = normal.cwiseProduct(chords).rowwise().sum();
   made.curved = normal.cwiseProduct(curved).rowwise().sum();
   made.arm = made.tangent.cwiseProduct(apart).rowwise().sum();
   for (Index i = 0; i < n; ++i) // round-off of coordinates
   {
      const double least = 1e-9 * slave_.nodes[made.nodes[i]].spacing;
      if (std::abs(made.gap[i]) <= least) { made.gap[i] = 0; }
   }
   return made;
}

} // namespace

Mortar mortar(const ContactLine &slave, const ContactLine &master,
              const std::vector<int> &without, const std::string &what)
{
   require(slave.formulation == master.formulation && slave.formulation != Formulation::torsion,
           what, ": the lines are ", name(slave.formulation), " and ", name(master.formulation),
           ", must be both plane or both axisymmetric");
   slave.validate();
   master.validate();
   Mortar found = Assembly(slave, master, without, what).result();
   const bool taken = std::any_of(
      without.begin(), without.end(),
      [&](int k)
      { return !std::count(found.free_surface.begin(), found.free_surface.end(), k); });
   require(
      !found.nodes.empty() || !taken, what,
      ": all nodes over the master are in contact by an earlier interface: "
      "name each place where two sides meet once, and make a side that lies between two nodes "
      "the slave (slave: first or second)");
   require(!found.nodes.empty(), what,
           ": no node of the slave lies over the master: make the other side the slave "
           "(slave: first or second), or mesh the slave with finer elements");
   return found;
}

} // namespace cattaneo
