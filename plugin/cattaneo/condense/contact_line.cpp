#include <algorithm>
#include <cattaneo/algebra/lobatto_basis.hpp>
#include <cattaneo/condense/contact_line.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <set>

namespace cattaneo
{

namespace
{

/// Checks that elements follow each other from the first node of a chain to the last one, or
/// back to the first, and have every node of the chain once, except nodes that two elements
/// share.
void check_elements(const ContactLine &line, const LineChain &chain)
{
   const Eigen::Index end = chain.first + chain.nodes;
   Eigen::Index next = chain.first;
   for (std::size_t e = 0; e < chain.elements.size(); ++e)
   {
      const LineElement &element = chain.elements[e];
      const auto count = static_cast<Eigen::Index>(element.nodes.size());
      require(count >= 2 && element.points.cols() == count, "contact line: element ", e,
              " of the chain from node ", chain.first, " has ", count, " nodes and ",
              element.points.cols(), " points, must have equally many, at least two");
      for (Eigen::Index a = 0; a < count; ++a)
      {
         const Eigen::Index node = element.nodes[a];
         if (node < 0) { continue; } // on the axis
         const bool shared = a == 0 && e > 0, closes = chain.loop && next == end;
         const Eigen::Index expected = shared ? next - 1 : closes ? chain.first : next;
         require(node == expected && node < end &&
                    element.points.col(a) == line.nodes[node].position,
                 "contact line: node ", a, " of element ", e, " of the chain from node ",
                 chain.first, " is node ", node, " of the line, must be node ", expected,
                 " (the chain ends at node ", end - 1, ")", ", at its place");
         if (!shared && !closes) { ++next; }
      }
   }
   require(chain.elements.empty() || next == end,
           "contact line: the elements of the chain from node ", chain.first,
           " end before node ", next, ", must end at node ", end - 1);
}

/// A node much nearer to one neighbour than to the other one has a tiny weight, so that force
/// over weight is mostly round-off.
void check_spacing(const ContactLine &line, const LineChain &chain)
{
   const Eigen::Index count = chain.loop ? chain.nodes : chain.nodes - 2;
   const auto place = [&](Eigen::Index k)
   { return line.nodes[chain.first + k % chain.nodes].position; };
   for (Eigen::Index k = 0; k + 1 < chain.nodes; ++k)
   {
      const Eigen::Vector2d at = place(k);
      require(place(k + 1) != at, "contact line: two neighbouring nodes are both at ", at,
              ", must be at different places: merge them");
   }
   for (Eigen::Index k = 0; k < count && chain.nodes > 2; ++k)
   {
      const Eigen::Vector2d at = place(k + 1);
      const double before = (at - place(k)).norm(), after = (place(k + 2) - at).norm();
      require(std::min(before, after) >= ContactLine::least_ratio * std::max(before, after),
              "contact line: the distances from the node at ", at, " to its neighbours are ",
              before, " and ", after, ", the smaller must be at least ",
              ContactLine::least_ratio, " times the larger: merge nodes that should coincide");
   }
}

} // namespace

double LineElement::off_chord(Eigen::Index node) const
{
   const Eigen::Vector2d from = points.col(0), chord = points.rightCols(1) - from,
                         to_node = points.col(node) - from;
   return (chord[1] * to_node[0] - chord[0] * to_node[1]) / chord.squaredNorm();
}

/// Distance of a curve over the chord of an element from the element.
static Eigen::Vector2d off(const LineElement &element, const EdgeBend &curve, double s)
{
   if (curve.straight()) { return {0, 0}; }
   // The element is the polynomial through its nodes, wherever these are.
   double off = curve.off(s);
   if (element.order() > 1)
   {
      Eigen::VectorXd values(element.order() + 1);
      lobatto_basis(element.order()).evaluate(s, values);
      for (Eigen::Index a = 1; a < element.order(); ++a)
      {
         off -= values[a] * element.off_chord(a);
      }
   }
   const Eigen::Vector2d chord = element.points.rightCols(1) - element.points.leftCols(1);
   return off * Eigen::Vector2d(chord[1], -chord[0]);
}

Eigen::Vector2d LineElement::off_curve(double s) const
{
   return off(*this, bend.value_or(EdgeBend()), s);
}

Eigen::Vector2d LineElement::off_possible(double s) const
{
   return off(*this, possible, s);
}

Eigen::Vector2d LineElement::curve_tangent(double s) const
{
   const Eigen::Vector2d chord = points.rightCols(1) - points.leftCols(1);
   const double slope = bend ? bend->slope(s) : 0;
   return (chord + slope * Eigen::Vector2d(chord[1], -chord[0])).normalized();
}

/// Offsets of the inner nodes of elements, by off(element, s); n × 2.
template <class Off>
static Eigen::MatrixX2d off_nodes(const ContactLine &line, Off off)
{
   Eigen::MatrixX2d all = Eigen::MatrixX2d::Zero(line.size(), 2);
   for (const LineChain &chain : line.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         const Eigen::VectorXd &at = lobatto_basis(element.order()).nodes;
         for (Eigen::Index a = 1; a < element.order(); ++a)
         {
            all.row(element.nodes[a]) = off(element, at[a]);
         }
      }
   }
   return all;
}

Eigen::MatrixX2d ContactLine::off_curves() const
{
   return off_nodes(*this,
                    [](const LineElement &element, double s) { return element.off_curve(s); });
}

Eigen::MatrixX2d ContactLine::off_unmeasured() const
{
   return off_nodes(*this,
                    [this](const LineElement &element, double s) -> Eigen::Vector2d
                    {
                       const Eigen::Vector2d may = element.off_possible(s);
                       return as_meshed ? Eigen::Vector2d(may + element.off_curve(s)) : may;
                    });
}

Eigen::MatrixX2d ContactLine::outline() const
{
   const Eigen::MatrixX2d places = each(&LineNode::position);
   return as_meshed ? places : Eigen::MatrixX2d(places + off_curves());
}

Eigen::MatrixX2d ContactLine::bulges() const
{
   Eigen::MatrixX2d all = Eigen::MatrixX2d::Zero(size(), 2);
   const Eigen::MatrixX2d places = outline();
   for (const LineChain &chain : chains)
   {
      for (const LineElement &element : chain.elements)
      {
         const bool smooth = element.bend && !element.bend->straight() && !as_meshed;
         for (Eigen::Index a = 1; a < element.order() && smooth; ++a)
         {
            const Eigen::Index node = element.nodes[a];
            const Eigen::Vector2d from = element.points.col(0);
            const Eigen::Vector2d chord = element.points.rightCols(1) - from,
                                  e = places.row(node).transpose() - from;
            // Perpendicular to the chord, at whatever place along it the node is.
            const Eigen::Vector2d right(chord[1], -chord[0]);
            all.row(node) = right.dot(e) / right.squaredNorm() * right;
         }
      }
   }
   return all;
}

const LineChain &ContactLine::chain_of(Eigen::Index node) const
{
   return *std::find_if(chains.begin(), chains.end(),
                        [node](const LineChain &chain)
                        { return node < chain.first + chain.nodes; });
}

void ContactLine::validate() const
{
   require(!nodes.empty(), "contact line: it has no nodes, must have at least one");
   require(formulation != Formulation::space,
           "contact line: the body is in space, where contact must be given by a surface");
   for (Eigen::Index i = 0; i < size(); ++i)
   {
      const LineNode &node = nodes[i];
      const Eigen::Vector2d &at = node.position;
      require(at.allFinite() && (formulation == Formulation::plane || at[0] > 0),
              "contact line: node ", i, " is at ", at,
              ", must be finite, and have x > 0 if there is an axis");
      require(std::abs(node.tangent.norm() - 1) <= 1e-9, "contact line: the tangent at ", at,
              " has the length ", node.tangent.norm(), ", must be 1");
      require(node.weight > 0 && std::isfinite(node.weight),
              "contact line: the weight of the node at ", at, " is ", node.weight,
              ", must be positive");
      require(node.spacing > 0, "contact line: the spacing at ", at, " is ", node.spacing,
              ", must be positive");
      require(std::isfinite(node.arc_length), "contact line: the arc length of the node at ",
              at, " is ", node.arc_length, ", must be finite");
   }
   Eigen::Index next = 0;
   for (const LineChain &chain : chains)
   {
      require(chain.first == next && chain.nodes > 0 && chain.nodes <= size() - next,
              "contact line: a chain of ", chain.nodes, " nodes begins at node ", chain.first,
              ", must begin at node ", next, " and have 1 to ", size() - next);
      check_elements(*this, chain);
      check_spacing(*this, chain);
      next += chain.nodes;
   }
   require(next == size(), "contact line: the chains have ", next, " nodes, must have all ",
           size());
}

double angle_between(const Eigen::Vector2d &one, const Eigen::Vector2d &other)
{
   return std::atan2(std::abs(one[0] * other[1] - one[1] * other[0]), one.dot(other));
}

void bend_elements(ContactLine &line, const std::vector<SideChord> &chords)
{
   // Sorted by their beginnings along x, so that few are near each other.
   std::vector<const SideChord *> all;
   for (const SideChord &chord : chords) { all.push_back(&chord); }
   std::sort(all.begin(), all.end(),
             [](const SideChord *a, const SideChord *b) { return a->from[0] < b->from[0]; });
   for (LineChain &chain : line.chains)
   {
      for (LineElement &element : chain.elements)
      {
         const Eigen::Vector2d from = element.points.leftCols(1),
                               to = element.points.rightCols(1);
         const double near = 1e-6 * (to - from).norm();
         const auto begin = std::lower_bound(all.begin(), all.end(), from[0] - near,
                                             [](const SideChord *chord, double x)
                                             { return chord->from[0] < x; });
         for (auto at = begin; at != all.end() && (*at)->from[0] <= from[0] + near; ++at)
         {
            if (((*at)->from - from).norm() <= near && ((*at)->to - to).norm() <= near)
            {
               element.bend = (*at)->bend;
               element.possible = (*at)->possible;
            }
         }
      }
   }
}

ContactLine joined(const std::vector<ContactLine> &lines)
{
   require(!lines.empty(), "contact lines to be joined: none is given, must be at least one");
   ContactLine all;
   all.formulation = lines.front().formulation;
   all.as_meshed = std::all_of(lines.begin(), lines.end(),
                               [](const ContactLine &line) { return line.as_meshed; });
   std::set<std::array<int, 2>> known;
   for (const ContactLine &line : lines)
   {
      require(line.formulation == all.formulation, "contact lines to be joined: one is ",
              name(all.formulation), ", another ", name(line.formulation),
              ", all must be of one kind");
      line.validate();
      for (LineChain chain : line.chains)
      {
         const Eigen::Index from = chain.first;
         chain.first = all.size();
         bool whole = true;
         for (Eigen::Index i = 0; i < chain.nodes; ++i)
         {
            const LineNode &node = line.nodes[from + i];
            if (known.insert(node.dofs).second) { all.nodes.push_back(node); }
            else { whole = false; }
         }
         for (LineElement &element : chain.elements)
         {
            for (Eigen::Index &node : element.nodes)
            {
               if (node >= 0) { node += chain.first - from; }
            }
         }
         // The elements are those of the lines. If a node of a line was left out, the result
         // has no elements.
         if (!whole)
         {
            chain.elements.clear();
            chain.loop = false;
         }
         chain.nodes = all.size() - chain.first;
         if (chain.nodes > 0) { all.chains.push_back(chain); }
      }
   }
   return all;
}

} // namespace cattaneo
