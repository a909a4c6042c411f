#include "common/lap_joint_scene.hpp"

#include "common/contact_grid.hpp"
#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;

void LapJointOptions::validate() const
{
   require(growth > 1 && growth <= 2, "growth is ", growth, ", must be above 1 and at most 2");
   require(!widths.empty(), "option --width has no value, must have at least one");
   require(!bolts.empty(),
           "option --bolt-positions is empty, must have the position of at least one bolt");
   for (double w : widths)
   {
      require(w > 0 && 0.5 * w <= protrusion, "option --width or --map-width: ", w,
              " must be positive and within the protrusion ", protrusion, " to both sides");
      require(std::count(widths.begin(), widths.end(), w) == 1, "the width ", w,
              " is given twice: each value makes a load pattern, so give it once");
   }
   for (double x : bolts)
   {
      require(std::isfinite(x), "option --bolt-positions: ", x, " must be finite");
      require(std::count(bolts.begin(), bolts.end(), x) == 1,
              "option --bolt-positions: there are two bolts "
              "at ",
              x, ", must be at different places");
   }
}

std::string pinch_load(int bolt, double width)
{
   return "bolt " + std::to_string(bolt + 1) + exact_text(", w = ", width);
}

Scene make_lap_joint(const LapJointOptions &options)
{
   options.validate();
   Scene joint;
   const Material material = unit_material(options.poisson);
   double d = 0;
   for (double x : options.bolts) { d = std::max(d, std::abs(x)); }
   const double free_end = d + options.protrusion, loaded_end = -d - options.remote;
   const double w_max = *std::max_element(options.widths.begin(), options.widths.end());

   // Grid lines common to both laps on the overlap, symmetric about the middle; fine where the
   // contact is expected, a little beyond the outermost pinch.
   double h = options.order * options.spacing;
   const double growth = options.growth, coarse = growth - 1;
   const double fine = std::min(free_end, d + 0.5 * w_max + 0.3);
   constexpr double most_nodes = 20000; // their stiffness fills 13 GB
   require(2 * fine / options.spacing < most_nodes,
           "options --bolt-positions and --spacing: ", 2 * fine / options.spacing,
           " contact nodes would lie between the bolts, must be at "
           "most ",
           most_nodes);
   const int count = 2 * static_cast<int>(std::ceil(fine / h));
   std::vector<double> right;
   for (int k = 0; k <= count / 2; ++k) { right.push_back(2 * fine * k / count); }
   if (fine < free_end)
   {
      right = joined({right, graded(fine, free_end, h, growth, 0.4 * coarse)});
   }
   if (!options.grid.empty())
   {
      right = options.grid;
      h = smallest_step(right);
   }
   std::vector<double> x =
      graded(-free_end, loaded_end, right.back() - right[right.size() - 2], growth, coarse);
   std::reverse(x.begin(), x.end());
   for (std::size_t k = right.size() - 1; k-- > 0;) { x.push_back(-right[k]); }
   x.insert(x.end(), right.begin() + 1, right.end());

   const int interface = 1, outer = 3, loaded = 4; // sides of the upper lap; 2 is the free end
   const bool equal = options.lower_thickness == 1.0;
   std::vector<CondensedBody> condensed;
   for (const double turn : {1.0, -1.0})
   {
      const double thickness = 0.5 * (turn > 0 ? 1.0 : options.lower_thickness);
      // An even number of layers, symmetric about the middle, so that the supported node is a
      // vertex.
      const double half = 0.5 * thickness;
      std::vector<double> y = graded(0, half, h, growth, 0.2 * coarse);
      const std::size_t lower_half = y.size() - 1;
      for (std::size_t k = lower_half; k-- > 0;) { y.push_back(thickness - y[k]); }
      mfem::Mesh mesh = rectangle_mesh(x, y);
      ElasticBody &lap = joint.add(turn > 0 ? std::move(mesh) : half_turn(std::move(mesh)),
                                   options.order, material);
      for (double w : options.widths)
      {
         for (std::size_t k = 0; k < options.bolts.size(); ++k)
         {
            const std::string name = pinch_load(static_cast<int>(k), w);
            const double centre = options.bolts[k];
            lap.add_pressure(name, BoundaryPart({outer}, 0, centre - 0.5 * w, centre + 0.5 * w),
                             1.0);
         }
      }
      lap.add_pressure("T", loaded, -1 / thickness);
      lap.fix_node(turn * loaded_end, turn * half, 1);
      const ContactLine line =
         contact_line(lap, BoundaryPart({interface}, 0, -free_end, free_end));
      condensed.push_back(condense(lap, line, condensation(),
                                   condensed.empty() || !equal ? nullptr : &condensed.front()));
   }
   const Pairing pairing = pair_lines(condensed[0].line, condensed[1].line);
   joint.reduction = reduce(std::move(condensed[0]), std::move(condensed[1]), pairing);
   return joint;
}

} // namespace miniapp
