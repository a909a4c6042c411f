#include <algorithm>
#include <cattaneo/condense/trace.hpp>
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

/// Nodes of line 2 for those of line 1, where one was found.
struct Matches
{
   std::vector<int> partner; ///< -1: none
   std::vector<bool> matched1, matched2;
   bool complete = false;
   bool facing = false; ///< somewhere the lines have opposite normals
   double offset = 0;   ///< the largest along the tangent, in distances of nodes
};

/// The data of the nodes of a line or a surface that pairing needs.
struct PairedSide
{
   Eigen::Matrix3Xd place, normal;
   Eigen::VectorXd spacing;
};

PairedSide side_of(const ContactLine &line)
{
   PairedSide side{Eigen::Matrix3Xd::Zero(3, line.size()),
                   Eigen::Matrix3Xd::Zero(3, line.size()), line.each(&LineNode::spacing)};
   for (Eigen::Index i = 0; i < line.size(); ++i)
   {
      side.place.col(i).head(2) = line.nodes[i].position;
      side.normal.col(i).head(2) = line.nodes[i].normal();
   }
   return side;
}

PairedSide side_of(const ContactSurface &surface)
{
   PairedSide side{surface.positions().transpose(), Eigen::Matrix3Xd(3, surface.size()),
                   Eigen::VectorXd(surface.size())};
   for (Eigen::Index i = 0; i < surface.size(); ++i)
   {
      side.normal.col(i) = surface.nodes[i].normal();
      side.spacing[i] = surface.nodes[i].spacing;
   }
   return side;
}

Matches match(const PairedSide &side1, const PairedSide &side2, double tolerance)
{
   const Eigen::Index n1 = side1.place.cols(), n2 = side2.place.cols();
   Matches found{std::vector<int>(n1, -1), std::vector<bool>(n1, false),
                 std::vector<bool>(n2, false), n1 == n2};
   for (Eigen::Index i = 0; i < n1; ++i)
   {
      double nearest = std::numeric_limits<double>::infinity(), offset_of_nearest = 0;
      Eigen::Index partner = -1;
      for (Eigen::Index j = 0; j < n2; ++j)
      {
         const Eigen::Vector3d apart = side1.place.col(i) - side2.place.col(j);
         const double distance = apart.squaredNorm();
         if (distance >= nearest) { continue; }
         const Eigen::Vector3d across = side1.normal.col(i) - side2.normal.col(j);
         const double square = across.squaredNorm(); // 4 for exactly opposite sides
         found.facing = found.facing || square >= 2;
         if (square < 2) { continue; }
         // The distance vector without its part along the mean normal.
         const double offset = (apart - apart.dot(across) / square * across).norm();
         const double spacing = std::min(side1.spacing[i], side2.spacing[j]);
         if (offset > tolerance * spacing) { continue; }
         nearest = distance;
         offset_of_nearest = offset / spacing;
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

Matches match(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   return match(side_of(line1), side_of(line2), tolerance);
}

/// How many nodes have no partner, and the first of them.
std::string without_partner(const ContactSurface &surface, const std::vector<bool> &matched)
{
   const auto first = std::find(matched.begin(), matched.end(), false) - matched.begin();
   if (first == surface.size()) { return "none"; }
   return std::to_string(std::count(matched.begin(), matched.end(), false)) +
          ", the first at " + place_text(surface.nodes[first].position, Formulation::space);
}

/// The tolerance that would pair the lines, and where they are, for messages.
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
           << " would pair all nodes";
   }
   else if (!loose.facing)
   {
      text << "the lines do not face each other anywhere (their outward normals must be "
              "opposite)";
   }
   else
   {
      text << "no tolerance would pair all nodes: both lines must have as many nodes over the "
              "same "
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
   require(static_cast<Eigen::Index>(pairing.partner.size()) == n, "pairing: it has ",
           pairing.partner.size(), " nodes, must have as many as the line, ", n);
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

Pairing pair_surfaces(const ContactSurface &surface1, const ContactSurface &surface2,
                      double tolerance, const std::string &what)
{
   require(tolerance > 0 && tolerance < 0.5, what, ": tolerance is ", tolerance,
           ", must be above 0 and below 0.5 (distances of nodes)");
   surface1.validate();
   surface2.validate();
   const Matches found = match(side_of(surface1), side_of(surface2), tolerance);
   require(found.complete, what, ": contact nodes without a partner within ", tolerance,
           " distances of nodes: of body 1 (", surface1.size(),
           " nodes): ", without_partner(surface1, found.matched1), "; of body 2 (",
           surface2.size(), " nodes): ", without_partner(surface2, found.matched2),
           found.facing ? "" : "; the surfaces do not face each other anywhere");
   Pairing made{found.partner, Eigen::VectorXd(surface1.size())};
   const Eigen::MatrixX3d points1 = surface1.points(), points2 = surface2.points();
   for (Eigen::Index i = 0; i < surface1.size(); ++i)
   {
      const SurfaceNode &one = surface1.nodes[i], &other = surface2.nodes[found.partner[i]];
      // If the middles of two edges face each other, the ends of these edges must do so too.
      std::set<Eigen::Index> ends, its(other.between.begin(), other.between.end());
      for (Eigen::Index end : one.between) { ends.insert(end < 0 ? end : found.partner[end]); }
      require(ends == its, what, ": the node at ", place_text(one.position, Formulation::space),
              " is the middle of an edge of ", one.between[0] < 0 ? "body 2" : "body 1",
              " alone, both bodies must have faces of order 2 with the same edges there");
      const Eigen::Vector3d normal = (one.normal() - other.normal()).normalized();
      const double gap =
         (points1.row(i) - points2.row(found.partner[i])).transpose().dot(normal);
      const bool round_off = std::abs(gap) < 1e-9 * std::min(one.spacing, other.spacing);
      made.gap[i] = round_off ? 0 : gap;
   }
   return made;
}

} // namespace cattaneo
