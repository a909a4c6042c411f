#include <algorithm>
#include <array>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

std::vector<double> graded(double from, double to, double first, double growth, double largest)
{
   require(std::isfinite(from) && std::isfinite(to) && from != to, "graded: runs from ", from,
           " to ", to, ", the ends must be finite and different");
   require_positive("graded: first step", first);
   require_at_least("graded: growth", growth, 1);
   require(largest > 0, "graded: largest step is ", largest, ", must be positive");
   const double length = std::abs(to - from);
   const double allowed = 1e7; // far more grid lines than any mesh can use
   require(length / std::min(first, largest) < allowed || growth > 1, "graded: first step ",
           first, " is too small for the length ", length, ", must be larger, or grow");

   std::vector<double> steps;
   double sum = 0.0, step = std::min(first, largest);
   // Another step only if it brings the end nearer.
   while (steps.empty() || length - sum > 0.5 * step)
   {
      steps.push_back(step);
      sum += step;
      step = std::min(step * growth, largest);
      require(steps.size() < allowed, "graded: there are more than ", allowed, " steps from ",
              from, " to ", to, ": choose larger steps");
   }
   const double missing = length - sum;
   std::size_t k = steps.size();
   double scaled = 0.0;
   while (k > 0 && scaled < 4 * std::abs(missing)) { scaled += steps[--k]; }
   if (scaled > 0)
   {
      for (; k < steps.size(); ++k) { steps[k] *= 1 + missing / scaled; }
   }

   std::vector<double> points{from};
   const double direction = to > from ? 1.0 : -1.0;
   sum = 0.0;
   for (double h : steps)
   {
      sum += h;
      points.push_back(from + direction * sum);
   }
   points.back() = to;
   return points;
}

std::vector<double> graded_to_ends(double half, int intervals, double end_ratio)
{
   require_positive("graded to ends: half length", half);
   require(intervals >= 1, "graded to ends: ", intervals, " intervals, must be at least 1");
   require(end_ratio > 0 && end_ratio <= 1, "graded to ends: end ratio is ", end_ratio,
           ", must be above 0 and at most 1");
   const int n = intervals, last = (n - 1) / 2; // steps from the end to the middle interval
   const double growth = last > 0 ? std::pow(end_ratio, -1.0 / last) : 1.0;
   // Distances from the middle, outward; the middle interval counts half if n is odd.
   std::vector<double> outward;
   double sum = 0.0;
   if (n % 2 == 0) { outward.push_back(0.0); }
   for (int d = last; d >= 0; --d)
   {
      sum += std::pow(growth, d - last) * (n % 2 == 1 && d == last ? 0.5 : 1.0);
      outward.push_back(sum);
   }
   std::vector<double> x(n + 1);
   const int count = static_cast<int>(outward.size());
   for (int k = 0; k < count; ++k)
   {
      const double value = k == count - 1 ? half : half * (outward[k] / sum);
      x[n - count + 1 + k] = value;
      x[count - 1 - k] = -value;
   }
   if (n % 2 == 0) { x[n / 2] = 0.0; }
   return x;
}

std::vector<double> joined(const std::vector<std::vector<double>> &pieces)
{
   std::vector<double> all;
   for (const std::vector<double> &piece : pieces)
   {
      require(!piece.empty(), "joined: a list of coordinates is empty");
      if (all.empty())
      {
         all = piece;
         continue;
      }
      const double tolerance = 1e-12 * (std::abs(all.front()) + std::abs(piece.back()));
      require(std::abs(piece.front() - all.back()) <= tolerance, "joined: a list starts at ",
              piece.front(), ", must start where the one before ends, at ", all.back());
      all.insert(all.end(), piece.begin() + 1, piece.end());
   }
   return all;
}

namespace
{

void check_grid(const char *mesh, const char *name, const std::vector<double> &grid)
{
   require(grid.size() >= 2, mesh, ": ", grid.size(), " grid lines in ", name,
           ", must be at least 2");
   for (std::size_t k = 0; k < grid.size(); ++k)
   {
      require(std::isfinite(grid[k]) && (k == 0 || grid[k] > grid[k - 1]), mesh, ": grid line ",
              k, " in ", name, " is ", grid[k],
              ", must be finite and larger than the one before");
   }
}

/// Box of quads below `contact` and rings around it; `half`: the left side of the box is an
/// axis that the rings end at.
mfem::Mesh ringed_box(const char *name, const std::vector<double> &contact,
                      const std::vector<double> &depth, const std::vector<double> &scale,
                      bool half)
{
   check_grid(name, "depth", depth);
   check_grid(name, "scale", scale);
   require(depth.front() == 0, name, ": depth starts at ", depth.front(), ", must be 0");
   require(scale.front() == 1, name, ": scale starts at ", scale.front(), ", must be 1");
   const int nx = static_cast<int>(contact.size()) - 1, ny = static_cast<int>(depth.size()) - 1;
   const int rings = static_cast<int>(scale.size()) - 1;
   const int left = half ? 0 : ny; // edges of the outline on the left side of the box
   const int outline = left + nx + ny;
   mfem::Mesh mesh(2, (nx + 1) * (ny + 1) + rings * (outline + 1), nx * ny + rings * outline,
                   nx + 2 * rings + (half ? ny : 0) + outline);
   for (int j = 0; j <= ny; ++j)
   {
      for (int i = 0; i <= nx; ++i) { mesh.AddVertex(contact[i], -depth[j]); }
   }
   // The outline runs down the left side of the box, along its bottom and up the right side.
   std::vector<int> inner;
   for (int j = 0; j < left; ++j) { inner.push_back(j * (nx + 1)); }
   for (int i = 0; i <= nx; ++i) { inner.push_back(ny * (nx + 1) + i); }
   for (int j = ny - 1; j >= 0; --j) { inner.push_back(j * (nx + 1) + nx); }
   std::vector<std::array<double, 2>> points;
   for (int v : inner) { points.push_back({mesh.GetVertex(v)[0], mesh.GetVertex(v)[1]}); }
   for (int k = 1; k <= rings; ++k)
   {
      for (const auto &point : points)
      {
         mesh.AddVertex(scale[k] * point[0], scale[k] * point[1]);
      }
   }
   const auto grid = [nx](int i, int j) { return i + j * (nx + 1); };
   const auto ring = [&](int m, int k)
   { return k == 0 ? inner[m] : (nx + 1) * (ny + 1) + (k - 1) * (outline + 1) + m; };
   for (int j = 0; j < ny; ++j)
   {
      for (int i = 0; i < nx; ++i)
      {
         mesh.AddQuad(grid(i, j + 1), grid(i + 1, j + 1), grid(i + 1, j), grid(i, j));
      }
   }
   for (int k = 0; k < rings; ++k)
   {
      for (int m = 0; m < outline; ++m)
      {
         mesh.AddQuad(ring(m, k), ring(m, k + 1), ring(m + 1, k + 1), ring(m + 1, k));
      }
   }
   for (int i = nx; i > 0; --i) { mesh.AddBdrSegment(grid(i, 0), grid(i - 1, 0), 1); }
   for (int j = 0; half && j < ny; ++j) { mesh.AddBdrSegment(grid(0, j), grid(0, j + 1), 5); }
   for (int k = 0; k < rings; ++k)
   {
      mesh.AddBdrSegment(ring(0, k), ring(0, k + 1), half ? 5 : 2);
      mesh.AddBdrSegment(ring(outline, k + 1), ring(outline, k), 2);
   }
   for (int m = 0; m < outline; ++m)
   {
      mesh.AddBdrSegment(ring(m, rings), ring(m + 1, rings),
                         m < left || m >= left + nx ? 4 : 3);
   }
   mesh.FinalizeQuadMesh(1, 0, false);
   return mesh;
}

} // namespace

mfem::Mesh rectangle_mesh(const std::vector<double> &x, const std::vector<double> &y)
{
   check_grid("rectangle mesh", "x", x);
   check_grid("rectangle mesh", "y", y);
   require(static_cast<double>(x.size()) * y.size() < std::numeric_limits<int>::max() / 4,
           "rectangle mesh: ", x.size(), " × ", y.size(), " grid lines are too many");
   const int nx = static_cast<int>(x.size()) - 1, ny = static_cast<int>(y.size()) - 1;
   mfem::Mesh mesh =
      mfem::Mesh::MakeCartesian2D(nx, ny, mfem::Element::QUADRILATERAL, true, 1, 1, false);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      mesh.GetVertex(v)[0] = x[v % (nx + 1)];
      mesh.GetVertex(v)[1] = y[v / (nx + 1)];
   }
   return mesh;
}

mfem::Mesh half_plane_mesh(const std::vector<double> &contact, const std::vector<double> &depth,
                           const std::vector<double> &scale)
{
   check_grid("half-plane mesh", "contact", contact);
   require(contact.front() == -contact.back(), "half-plane mesh: the contact runs from ",
           contact.front(), " to ", contact.back(), ", must be symmetric about 0");
   return ringed_box("half-plane mesh", contact, depth, scale, false);
}

mfem::Mesh half_space_mesh(const std::vector<double> &contact, const std::vector<double> &depth,
                           const std::vector<double> &scale)
{
   check_grid("half-space mesh", "contact", contact);
   require(contact.front() == 0, "half-space mesh: the contact starts at ", contact.front(),
           ", must start on the axis, at 0");
   return ringed_box("half-space mesh", contact, depth, scale, true);
}

std::vector<double> ring_scales(double a, double domain, double first, double growth)
{
   require(domain > 4 * a, "ring scales: the domain is ", domain, ", must be above ", 4 * a);
   std::vector<double> radii = graded(a, 3 * a, first, growth);
   const double last = radii.back() - radii[radii.size() - 2];
   radii =
      joined({radii, graded(3 * a, domain, std::max(last, 0.1 * a), 1 + 2 * (growth - 1))});
   for (double &radius : radii) { radius /= a; }
   radii.front() = 1;
   return radii;
}

} // namespace cattaneo
