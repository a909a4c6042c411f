#include "design/design_scene.hpp"
#include "common/hertz_scene.hpp"
#include "common/punch.hpp"

#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;

namespace
{

/// The first point of the history that counts, which --from gives.
double first_point(const DesignScene &chosen, const LoadHistory &history)
{
   const Index points = history.times.size();
   Index first = std::isnan(chosen.from) ? points - 1 : 0;
   while (first < points && history.times[first] < chosen.from) { ++first; }
   const Index needed = chosen.cycles() ? 2 : 1;
   require(points - first >= needed, "option --from is ", chosen.from, ", must leave ", needed,
           needed > 1 ? " points" : " point", " of the history at least, which ends at time ",
           history.times[points - 1]);
   return history.times[first];
}

} // namespace

ReducedProblem make_problem(Study &study, const DesignScene &chosen)
{
   if (!chosen.file.empty())
   {
      ReducedProblem problem = load_reduced_problem(chosen.file);
      if (!std::isnan(chosen.friction)) { set_friction(problem, chosen.friction); }
      require(problem.arc_length.size() > 0 && problem.weights.size() > 0, "'", chosen.file,
              "' has no arc_length or no weights, which a design needs");
      study.condensed(problem, 0);
      return problem;
   }
   require(chosen.nodes % 4 == 1, "option --nodes is ", chosen.nodes,
           ", must be one more than a multiple of 4");
   Scene scene;
   // Finer toward the ends, where profiles and pressures are steepest.
   const int elements = chosen.nodes / 2;
   std::vector<double> grid;
   for (int k = 0; k <= elements; ++k) { grid.push_back(-std::cos(M_PI * k / elements)); }
   if (chosen.scene == "pad")
   {
      HalfPlanes planes;
      planes.nodes = chosen.nodes;
      planes.material = Material{8 / M_PI * 0.91, 0.3, PlaneState::strain};
      planes.grid = grid;
      scene = make_scene(planes);
      scene.problem().B().setZero(); // equal half-planes: the value is round-off
      join_coupling(scene.problem());
   }
   else
   {
      PunchOptions punch;
      punch.half_plane = true;
      punch.nodes = chosen.nodes;
      punch.grid = grid;
      scene = make_punch(punch);
   }
   ReducedProblem problem = scene.problem();
   problem.gap.setZero();
   set_friction(problem, std::isnan(chosen.friction) ? 0.3 : chosen.friction);
   study.condensed(problem, scene.dofs);
   return problem;
}

std::vector<DesignCase> make_cases(const DesignScene &chosen, const ReducedProblem &problem)
{
   const double sign = chosen.goal == "damping" ? -1 : 1;
   if (!chosen.file.empty())
   {
      const LoadHistory history = load_history("history", chosen.history, problem);
      return {{"history", history, sign, first_point(chosen, history)}};
   }
   std::vector<DesignCase> cases;
   for (std::size_t k = 0; k < chosen.loads.size(); ++k)
   {
      const double P = chosen.loads[k], Q = chosen.shear * problem.friction[0] * P;
      std::vector<NamedLoads> points = {{}, {{"P", P}}};
      if (Q > 0)
      {
         for (double sheared : {Q, -Q, Q}) { points.push_back({{"P", P}, {"Q", sheared}}); }
      }
      cases.push_back({exact_text("P = ", P), LoadHistory::through(problem, points),
                       sign * chosen.weights[k], chosen.cycles() ? 2.0 : 1.0});
   }
   return cases;
}

} // namespace miniapp
