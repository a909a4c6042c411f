#include <algorithm>
#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/reduced/facing.hpp>
#include <cmath>
#include <sstream>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Vector2d;

Eigen::VectorXd ElementCurve::functions(double s) const
{
   Eigen::VectorXd values(order() + 1);
   lobatto_basis(order()).evaluate(s, values);
   return values;
}

Vector2d ElementCurve::place(double s) const
{
   // Places are counted from the first node, so that small elements far from the origin lose no
   // digits.
   const Vector2d from = element->points.col(0);
   return from + (element->points.colwise() - from) * functions(s);
}

Vector2d ElementCurve::derivative(double s) const
{
   const Vector2d from = element->points.col(0);
   return (element->points.colwise() - from) *
          (lobatto_basis(order()).slopes.transpose() * functions(s));
}

Vector2d ElementCurve::tangent(double s) const
{
   return tangents * functions(s);
}

double ElementCurve::length() const
{
   return (element->points.rightCols(order()) - element->points.leftCols(order()))
      .colwise()
      .norm()
      .sum();
}

Vector2d ElementCurve::bulge(double s) const
{
   if (element->bend) { return {0, 0}; }
   // A polynomial that is zero at the nodes. Its slopes at the ends turn the element's own
   // tangents to those of the line. Inner nodes of a straight element are on its chord, and not
   // on the curve.
   const Vector2d chord = element->points.rightCols(1) - element->points.leftCols(1);
   double off = 0;
   for (Index a = 1; a < order(); ++a)
   {
      const Vector2d e = element->points.col(a) - element->points.col(0);
      off = std::max(off, std::abs(chord[0] * e[1] - chord[1] * e[0]));
   }
   const bool straight = off <= 1e-6 * chord.squaredNorm();
   const Eigen::VectorXd &nodes = lobatto_basis(straight ? 1 : order()).nodes;
   const Index last = nodes.size() - 1;
   const auto factor = [&](Index end)
   {
      const Vector2d along = derivative(nodes[end]), t = tangents.col(end == 0 ? 0 : order());
      const double slope = along[0] * t[1] - along[1] * t[0], size = along.norm();
      if (std::abs(slope) > 0.3 * size) { return 0.0; } // half of a turn by 35 degrees
      double product = 1;
      for (Index j = 0; j <= last; ++j)
      {
         if (j != end) { product *= nodes[end] - nodes[j]; }
      }
      return std::abs(slope) > 1e-9 * size ? slope / product : 0.0;
   };
   double first = factor(0), second = factor(last);
   // At the end of a line only the element's tangent is known: the curve is assumed to bend
   // there as at the other end.
   if (first == 0) { first = second; }
   if (second == 0) { second = first; }
   const Vector2d along = derivative(s).normalized();
   return (s - nodes.array()).prod() * (first + s * (second - first)) *
          Vector2d(-along[1], along[0]);
}

std::string extent(const ContactLine &line)
{
   const auto position = line.each(&LineNode::position);
   const Eigen::RowVector2d low = position.colwise().minCoeff(),
                            high = position.colwise().maxCoeff();
   std::ostringstream text;
   text << "from (" << low[0] << ", " << low[1] << ") to (" << high[0] << ", " << high[1]
        << ")";
   return text.str();
}

std::vector<ElementCurve> curves(const ContactLine &line, const std::string &what)
{
   std::vector<ElementCurve> all;
   for (const LineChain &chain : line.chains)
   {
      require(!chain.elements.empty(), what, ": the contact line from ",
              line.nodes[chain.first].position,
              " has no elements, which sides with nodes that do not match need");
      for (const LineElement &element : chain.elements)
      {
         const Index order = element.order();
         require(order >= 1 && order <= LobattoBasis::highest_order, what,
                 ": the order of a contact element is ", order, ", must be from 1 to ",
                 LobattoBasis::highest_order);
         ElementCurve curve{&element, Eigen::Matrix2Xd(2, order + 1)};
         const double along = element.points(0, order) - element.points(0, 0);
         for (Index a = 0; a <= order; ++a)
         {
            const Index node = element.nodes[a];
            // A line crosses the axis at a right angle.
            curve.tangents.col(a) =
               node < 0 ? Vector2d(std::copysign(1.0, along), 0) : line.nodes[node].tangent;
         }
         all.push_back(std::move(curve));
      }
   }
   return all;
}

namespace
{

/// Signed distance along the mean tangent from the point at t on the other element to that at
/// s, zero if they face each other. Grows with s and with t, as the lines run in opposite
/// directions.
double beyond(const ElementCurve &first, double s, const ElementCurve &other, double t)
{
   return (first.place(s) - other.place(t)).dot(first.tangent(s) - other.tangent(t));
}

/// A possible part, with the distance of the elements there.
struct Candidate
{
   FacingPart part;
   double apart;
};

/// Parameter at which an increasing function crosses zero; 0 if it is positive from the
/// beginning, 1 if it is negative to the end.
template <class Function>
double crossing(const Function &value, double at_begin, double at_end)
{
   if (at_begin >= 0) { return 0; }
   if (at_end <= 0) { return 1; }
   return find_root(value, 0.0, 1.0);
}

} // namespace

double FacingLines::opposite(const FacingPart &part, double s) const
{
   const ElementCurve &one = first[part.element], &two = other[part.other];
   const auto value = [&](double t) { return beyond(one, s, two, t); };
   const double t = crossing(value, value(0), value(1));
   // Elements that match do so to the last bit, whatever the round-off of coordinates.
   return std::abs(t - (1 - s)) <= 1e-13 ? 1 - s : t;
}

FacingLines facing(const ContactLine &first, const ContactLine &other, const std::string &what)
{
   FacingLines result{curves(first, what), curves(other, what), {}};
   // Shorter parts are round-off.
   const double sliver = 1e-12;
   for (std::size_t e = 0; e < result.first.size(); ++e)
   {
      const ElementCurve &one = result.first[e];
      const Vector2d middle = one.tangent(0.5);
      const Vector2d begin = one.place(0), end = one.place(1);
      const Vector2d t0 = one.tangents.col(0), t1 = one.tangents.rightCols(1);
      std::vector<Candidate> candidates;
      for (std::size_t f = 0; f < result.other.size(); ++f)
      {
         const ElementCurve &two = result.other[f];
         if (middle.dot(two.tangents.col(0) + two.tangents.rightCols(1)) >= 0) { continue; }
         const Vector2d x0 = two.element->points.col(0), x1 = two.element->points.rightCols(1);
         const Vector2d u0 = two.tangents.col(0), u1 = two.tangents.rightCols(1);
         // The other element runs in the opposite direction: its end faces the beginning of the
         // part.
         const double end_at_begin = (begin - x1).dot(t0 - u1),
                      end_at_end = (end - x1).dot(t1 - u1),
                      begin_at_begin = (begin - x0).dot(t0 - u0),
                      begin_at_end = (end - x0).dot(t1 - u0);
         if (end_at_end <= 0 || begin_at_begin >= 0) { continue; }
         FacingPart part{e, f};
         part.from = crossing([&](double s) { return beyond(one, s, two, 1); }, end_at_begin,
                              end_at_end);
         part.to = crossing([&](double s) { return beyond(one, s, two, 0); }, begin_at_begin,
                            begin_at_end);
         if (!(part.to - part.from > sliver)) { continue; }
         const double s = 0.5 * (part.from + part.to), t = result.opposite(part, s);
         if (one.tangent(s).dot(two.tangent(t)) >= 0) { continue; }
         candidates.push_back({part, (one.place(s) - two.place(t)).norm()});
      }
      // The nearest elements come first; farther ones get the rest.
      std::sort(candidates.begin(), candidates.end(),
                [](const Candidate &a, const Candidate &b) { return a.apart < b.apart; });
      std::vector<FacingPart> taken;
      for (const Candidate &candidate : candidates)
      {
         std::vector<FacingPart> rest{candidate.part};
         for (const FacingPart &before : taken)
         {
            std::vector<FacingPart> left;
            for (const FacingPart &part : rest)
            {
               FacingPart low = part, high = part;
               low.to = std::min(part.to, before.from);
               high.from = std::max(part.from, before.to);
               for (const FacingPart &piece : {low, high})
               {
                  if (piece.to - piece.from > sliver) { left.push_back(piece); }
               }
            }
            rest = std::move(left);
         }
         taken.insert(taken.end(), rest.begin(), rest.end());
      }
      std::sort(taken.begin(), taken.end(),
                [](const FacingPart &a, const FacingPart &b) { return a.from < b.from; });
      result.parts.insert(result.parts.end(), taken.begin(), taken.end());
   }
   return result;
}

} // namespace cattaneo
