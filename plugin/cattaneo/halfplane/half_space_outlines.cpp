#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/halfplane/polygon_integrals.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <map>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::Vector2d;

namespace
{

/// A corner of a cell: its distance in cell edges, in x and y, from the first corner of all;
/// for triangles the number of its vertex, and 0.
using CellCorner = std::pair<long, long>;

/// The corners of each cell, counter-clockwise as polygons_of() has them.
std::vector<std::vector<CellCorner>> corners_of(const HalfSpace &contact,
                                                const std::vector<Polygon> &polygons)
{
   std::vector<std::vector<CellCorner>> corners(polygons.size());
   for (std::size_t i = 0; i < polygons.size(); ++i)
   {
      for (const Vector2d &each : polygons[i])
      {
         const Vector2d edges = (each - polygons[0][0]).cwiseQuotient(contact.size);
         corners[i].emplace_back(std::lround(edges[0]), std::lround(edges[1]));
      }
      if (contact.triangles.rows() == 0) { continue; }
      const auto triangle = static_cast<Index>(i);
      for (std::size_t k = 0; k < 3; ++k)
      {
         corners[i][k] = {contact.triangles(triangle, static_cast<Index>(k)), 0};
      }
      // The polygon may have the other sense.
      const Eigen::RowVector2d second = contact.vertices.row(contact.triangles(triangle, 1));
      if (second != polygons[i][1].transpose()) { std::swap(corners[i][1], corners[i][2]); }
   }
   return corners;
}

/// Angle by which the line from a to b turns to the left to go on to c, from -π to π.
double left_turn(const Vector2d &a, const Vector2d &b, const Vector2d &c)
{
   const Vector2d before = b - a, after = c - b;
   return std::atan2(before[0] * after[1] - before[1] * after[0], before.dot(after));
}

} // namespace

std::vector<MatrixX2d> HalfSpace::outlines(const std::vector<bool> &cells) const
{
   validate();
   require(static_cast<Index>(cells.size()) == nodes(),
           "half-space: outlines: the selection has ", cells.size(), " values, must be ",
           nodes(), ", true or false for each cell");
   const std::vector<Polygon> polygons = polygons_of(*this);
   const std::vector<std::vector<CellCorner>> corners = corners_of(*this, polygons);

   // The edges of these cells, with the cells on the left.
   std::map<CellCorner, Vector2d> places;
   std::set<std::pair<CellCorner, CellCorner>> edges;
   for (std::size_t i = 0; i < cells.size(); ++i)
   {
      if (!cells[i]) { continue; }
      const std::size_t sides = corners[i].size();
      for (std::size_t k = 0; k < sides; ++k)
      {
         places.emplace(corners[i][k], polygons[i][k]);
         edges.emplace(corners[i][k], corners[i][(k + 1) % sides]);
      }
   }
   // Edges that two cells share occur in both directions.
   std::map<CellCorner, std::set<CellCorner>> onward;
   for (const auto &[from, to] : edges)
   {
      if (edges.count({to, from}) == 0) { onward[from].insert(to); }
   }
   std::vector<MatrixX2d> outlines;
   while (!onward.empty())
   {
      const CellCorner start = onward.begin()->first;
      std::vector<CellCorner> way{start};
      do {
         const CellCorner here = way.back();
         std::set<CellCorner> &next = onward.at(here);
         CellCorner chosen = *next.begin();
         // If parts touch, the sharpest turn to the left stays with the same part.
         for (const CellCorner &each : next)
         {
            if (way.size() == 1) { break; }
            const Vector2d &before = places.at(way[way.size() - 2]);
            if (left_turn(before, places.at(here), places.at(each)) >
                left_turn(before, places.at(here), places.at(chosen)))
            {
               chosen = each;
            }
         }
         next.erase(chosen);
         if (next.empty()) { onward.erase(here); }
         way.push_back(chosen);
      } while (way.back() != start);
      MatrixX2d line(static_cast<Index>(way.size()), 2);
      for (Index k = 0; k < line.rows(); ++k)
      {
         line.row(k) = places.at(way[static_cast<std::size_t>(k)]);
      }
      outlines.push_back(std::move(line));
   }
   return outlines;
}

} // namespace cattaneo
