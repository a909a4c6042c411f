#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/facing.hpp>
#include <cattaneo/reduced/pairing.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace cattaneo
{

namespace
{

std::string listed(const ContactLine &line, const std::vector<bool> &matched)
{
   std::ostringstream text;
   text.precision(10);
   int count = 0;
   const int shown = 8;
   for (Eigen::Index i = 0; i < line.size(); ++i)
   {
      if (matched[i] || ++count > shown) { continue; }
      const Eigen::Vector2d &x = line.nodes[i].position;
      text << (count > 1 ? ", " : "") << "(" << x[0] << ", " << x[1] << ")";
   }
   if (count > shown) { text << " … and " << count - shown << " more"; }
   return count ? text.str() : "none";
}

/// Are the elements of all chains known?
bool knows_elements(const ContactLine &line)
{
   return std::none_of(line.chains.begin(), line.chains.end(),
                       [](const LineChain &chain) { return chain.elements.empty(); });
}

/// Nodes of line 2 for those of line 1, as far as they are found.
struct Matches
{
   std::vector<int> partner; ///< -1: none
   std::vector<bool> matched1, matched2;
   bool complete = false;
   bool facing = false; ///< somewhere the lines have opposite normals
   double offset = 0;   ///< the largest along the tangent, in distances of nodes
};

Matches match(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   const Eigen::Index n1 = line1.size(), n2 = line2.size();
   Matches found{std::vector<int>(n1, -1), std::vector<bool>(n1, false),
                 std::vector<bool>(n2, false), n1 == n2};
   for (Eigen::Index i = 0; i < n1; ++i)
   {
      double nearest = std::numeric_limits<double>::infinity(), offset_of_nearest = 0;
      Eigen::Index partner = -1;
      for (Eigen::Index j = 0; j < n2; ++j)
      {
         const LineNode &one = line1.nodes[i], &other = line2.nodes[j];
         const Eigen::Vector2d apart = one.position - other.position;
         const double distance = apart.squaredNorm();
         if (distance >= nearest) { continue; }
         const Eigen::Vector2d along = one.tangent - other.tangent;
         const double square = along.squaredNorm(); // 4 for exactly opposite lines
         const double offset = apart.dot(along);    // times the length of `along`
         const double spacing = std::min(one.spacing, other.spacing);
         const double allowed = tolerance * spacing;
         found.facing = found.facing || square >= 2;
         if (square < 2 || offset * offset > allowed * allowed * square) { continue; }
         nearest = distance;
         offset_of_nearest = std::abs(offset) / (std::sqrt(square) * spacing);
         partner = j;
      }
      if (partner < 0 || found.matched2[partner])
      {
         found.complete = false;
         continue;
      }
      found.matched1[i] = found.matched2[partner] = true;
      found.partner[i] = static_cast<int>(partner);
      found.offset = std::max(found.offset, offset_of_nearest);
   }
   return found;
}

/// What would pair the lines, and where they are.
std::string advice(const ContactLine &line1, const ContactLine &line2)
{
   double nearest = std::numeric_limits<double>::infinity();
   for (const LineNode &one : line1.nodes)
   {
      for (const LineNode &other : line2.nodes)
      {
         nearest = std::min(nearest, (one.position - other.position).norm());
      }
   }
   const Matches loose = match(line1, line2, 0.4999);
   std::ostringstream text;
   if (loose.complete)
   {
      const double unit = std::pow(10.0, std::floor(std::log10(loose.offset)) - 1);
      text << "a tolerance of " << std::ceil(loose.offset / unit * (1 + 1e-9)) * unit
           << " would pair all";
   }
   else if (!loose.facing)
   {
      text << "the lines do not face each other anywhere (their outward normals must be "
              "opposite)";
   }
   else
   {
      text << "no tolerance would pair all: both lines must have the same nodes over the same "
              "length";
   }
   text << "; the nearest nodes are " << nearest << " apart, line 1 reaches " << extent(line1)
        << ", line 2 " << extent(line2);
   return text.str();
}

} // namespace

LineNode mean_frame(LineNode node, const LineNode &other)
{
   if ((node.tangent + other.tangent).norm() > 1e-9)
   {
      node.tangent = (node.tangent - other.tangent).normalized();
   }
   return node;
}

namespace
{

/// Pairs all nodes one to one, if that is possible, whatever the elements.
std::optional<Pairing> paired_nodes(const ContactLine &line1, const ContactLine &line2,
                                    double tolerance)
{
   require(tolerance > 0 && tolerance < 0.5, "pairing: tolerance is ", tolerance,
           ", must be above 0 and below 0.5 (edge lengths)");
   line1.validate();
   line2.validate();
   const Matches found = match(line1, line2, tolerance);
   if (!found.complete) { return std::nullopt; }
   Pairing pairing{found.partner, Eigen::VectorXd::Zero(line1.size())};
   for (Eigen::Index i = 0; i < line1.size(); ++i)
   {
      const LineNode &other = line2.nodes[found.partner[i]],
                     node = mean_frame(line1.nodes[i], other);
      const double gap = (node.position - other.position).dot(node.normal());
      pairing.gap[i] = std::abs(gap) > 1e-9 * node.spacing ? gap : 0.0;
   }
   return pairing;
}

} // namespace

int differing_element(const ContactLine &line1, const ContactLine &line2,
                      const Pairing &pairing)
{
   const Eigen::Index n = line1.size();
   require(static_cast<Eigen::Index>(pairing.partner.size()) == n, "pairing: it is of ",
           pairing.partner.size(), " nodes, the line has ", n);
   for (int partner : pairing.partner)
   {
      require(partner >= 0 && partner < line2.size(), "pairing: partner ", partner,
              ", must be from 0 to ", line2.size() - 1);
   }
   if (!knows_elements(line1) || !knows_elements(line2))
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double one = line1.nodes[i].weight,
                      other = line2.nodes[pairing.partner[i]].weight;
         if (std::abs(one - other) > 0.05 * std::max(one, other)) { return int(i); }
      }
      return -1;
   }
   std::set<std::vector<Eigen::Index>> others; // nodes on the axis are -1 in both
   for (const LineChain &chain : line2.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         others.emplace(element.nodes.rbegin(), element.nodes.rend());
      }
   }
   for (const LineChain &chain : line1.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         std::vector<Eigen::Index> partners;
         int last = -1;
         for (Eigen::Index node : element.nodes)
         {
            partners.push_back(node < 0 ? node : pairing.partner[node]);
            last = node < 0 ? last : static_cast<int>(node);
         }
         if (others.count(partners) == 0) { return last; }
      }
   }
   return -1;
}

std::optional<Pairing> matching_nodes(const ContactLine &line1, const ContactLine &line2,
                                      double tolerance)
{
   std::optional<Pairing> found = paired_nodes(line1, line2, tolerance);
   if (found && differing_element(line1, line2, *found) >= 0) { found.reset(); }
   return found;
}

Pairing pair_lines(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   if (const std::optional<Pairing> found = paired_nodes(line1, line2, tolerance))
   {
      return *found;
   }
   const Matches found = match(line1, line2, tolerance);
   std::ostringstream text;
   text << "pairing: contact nodes without a partner within " << tolerance
        << " edge lengths; of body 1 (" << line1.size()
        << " nodes): " << listed(line1, found.matched1) << "; of body 2 (" << line2.size()
        << " nodes): " << listed(line2, found.matched2) << "; " << advice(line1, line2);
   throw InputError(text.str());
}

} // namespace cattaneo
