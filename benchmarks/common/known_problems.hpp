#pragma once

#include "common/focused_grid.hpp"

#include <functional>
#include <limits>
#include <vector>

/// Problems with known answers, to be solved on meshes of different kinds: what work_precision
/// runs.
namespace known
{

constexpr double none = std::numeric_limits<double>::quiet_NaN();

enum class Family
{
   uniform,
   graded,
   nested,
   block, ///< graded, and the half-plane is a meshed block
   standard
};

const char *name(Family family);

/// What a problem is asked to be solved on.
struct Resolution
{
   Family family = Family::uniform;
   int order = 2;
   double spacing = 0;             ///< spacing of the contact nodes where nothing needs less
   double finest = 1;              ///< spacing toward the edges over `spacing`
   double corner = 1;              ///< the same toward corners
   double growth = 1;              ///< from node to node
   std::vector<double> edges = {}; ///< of contact and stick, found before
   double domain = 0;              ///< of a block; 0: a half-plane has no mesh

   double element_growth() const { return 1 + order * (growth - 1); }

   /// Where nodes must be close: `spacing` in [lo, hi], and less at corners and edges.
   std::vector<Focus> foci(double lo, double hi, const std::vector<double> &corners = {}) const
   {
      std::vector<Focus> all{{lo, hi, spacing}};
      if (family == Family::uniform) { return all; }
      for (double x : corners) { all.push_back({x, x, corner * spacing}); }
      for (double x : edges) { all.push_back({x, x, finest * spacing}); }
      return all;
   }
   /// Grid lines of a contact line, or of the half x > 0 of a symmetric one.
   std::vector<double> grid(double to, const std::vector<Focus> &foci) const
   {
      return focused_grid(0, to, order, growth, foci);
   }
};

struct Answer
{
   double dofs = 0, nodes = 0;
   std::vector<double> values; ///< of the problem's quantities
   std::vector<double> edges;  ///< where to grade to
};

struct Quantity
{
   const char *name;
   double exact; ///< closed form; NaN: none, the reference is computed
   double scale; ///< errors are relative to this; 0: to the reference
   double known = none, known_error = none; ///< independent reference value and its ±
};

struct Problem
{
   const char *name, *title;
   std::vector<Quantity> quantities;
   double spacing;        ///< of the coarsest level
   double finest, corner; ///< of graded meshes
   int fine;              ///< level of the first of the two reference meshes
   std::function<Answer(const Resolution &)> solve;
   double domain = 0; ///< of the block of that family; 0: it has none
   bool nested = false;
   bool standard = true; ///< there is a miniapp with a default mesh
};

const std::vector<Problem> &problems();

/// Level 0 is the coarsest, each next one has about half the spacing.
Resolution resolution(const Problem &problem, Family family, int order, double level);

/// Graded and nested meshes need a coarse run first if there are edges to find.
Answer solve(const Problem &problem, Resolution resolution);

} // namespace known
