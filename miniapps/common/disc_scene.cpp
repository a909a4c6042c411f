#include "common/disc_scene.hpp"

#include "common/contact_grid.hpp"
#include "common/miniapp.hpp"
#include "common/receding_study.hpp"

#include <algorithm>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using namespace cattaneo;

void DiscOptions::validate() const
{
   check_growth(growth);
   require(disc_radius >= spacing * order, "option --disc-radius is ", disc_radius,
           ", must be at least one element, ", spacing * order, " (in t)");
   require(domain == 0 || domain > disc_radius + 1, "option --domain is ", domain,
           ", must be 0, for a half-space without a mesh, or above ", disc_radius + 1,
           " (in t)");
   require(!load_radii.empty(), "option --load-radius has no value, must have at least one");
   for (double a : load_radii)
   {
      require(a > 0 && a <= disc_radius, "option --load-radius is ", a,
              ", must be above 0 and at most the disc's radius ", disc_radius, " (in t)");
      require(std::count(load_radii.begin(), load_radii.end(), a) == 1, "the load radius ", a,
              " is given twice: each value makes a load pattern, so give it once");
   }
}

std::string radius_load(double radius)
{
   return exact_text("a = ", radius);
}

Scene make_disc(const DiscOptions &options)
{
   options.validate();
   Scene scene;
   const Material material{1.0, options.poisson};
   const int bottom = 1, side = 2, top = 3;
   const double b = options.disc_radius, R = options.domain;
   const double growth = element_growth(options.growth, options.order);
   // Elements hold as many intervals between nodes as their order says.
   double h = options.spacing * options.order, h_end = h;
   const int count = std::max(1, static_cast<int>(std::lround(b / h)));
   std::vector<double> contact;
   for (int i = 0; i <= count; ++i) { contact.push_back(i == count ? b : b * i / count); }
   if (!options.grid.empty())
   {
      contact = options.grid;
      h = smallest_step(contact);
      h_end = contact.back() - contact[contact.size() - 2];
   }
   ElasticBody &disc =
      scene.add(rectangle_mesh(contact, graded(0, 1, h, growth, 0.4 * (growth - 1))),
                options.order, material, Formulation::axisymmetric);
   const bool meshed = R > 0;
   if (meshed)
   {
      std::vector<double> depth = graded(0, -R, h, growth);
      std::reverse(depth.begin(), depth.end());
      scene.add(rectangle_mesh(joined({contact, graded(b, R, h_end, growth)}), depth),
                options.order, material, Formulation::axisymmetric);
   }
   const BoundaryPart far({bottom, side});
   const auto line_of_disc = [&](const ElasticBody &body)
   { return contact_line(body, bottom); };
   const auto line_below = [&](const ElasticBody &body)
   { return contact_line(body, BoundaryPart({top}, 0, 0, b)); };

   for (double a : options.load_radii)
   {
      disc.add_pressure(radius_load(a), BoundaryPart({top}, 0, 0, a), 1.0);
   }
   HalfPlane half_space;
   half_space.material = material;
   CondensedBody upper = condense(disc, line_of_disc(disc), condensation());
   if (meshed)
   {
      ElasticBody &below = *scene.bodies[1];
      for (int c : {0, 1}) { below.fix(far, c); }
      scene.reduction = stacked(std::move(upper), below, line_below(below));
   }
   else { scene.reduction = reduce(std::move(upper), half_space); }
   if (options.twist == Twist::none) { return scene; }

   scene.add_torsion(options.order, material);
   ElasticBody &twisting = *scene.torsion[0];
   const double a = options.load_radii.front();
   const BoundaryPart loaded({top}, 0, 0, a);
   switch (options.twist)
   {
   case Twist::none:
      break;
   case Twist::top:
      twisting.add_displacement("twist", top, 0, 1.0);
      break;
   case Twist::loaded:
      twisting.add_displacement("twist", loaded, 0, 1.0);
      break;
   case Twist::rim:
      // Only above the contact, because its last node is at the rim and must be free.
      twisting.add_displacement("twist", BoundaryPart({side}, 1, 0.4 * h, 1), 0, 1.0);
      break;
   case Twist::traction:
      twisting.add_traction("twist", loaded,
                            [a](double r, double) { return 2 * r / (M_PI * std::pow(a, 4)); });
      break;
   }
   upper = condense(twisting, line_of_disc(twisting), condensation());
   CondensedBody lower;
   if (meshed)
   {
      ElasticBody &held = *scene.torsion[1];
      held.fix(far, 0);
      lower = condense(held, line_below(held), condensation());
   }
   else { lower = condense(half_space, upper.line); }
   scene.reduction.add_torsion(std::move(upper), std::move(lower));
   return scene;
}

CriticalLoad::CriticalLoad(DiscOptions options) : options_(std::move(options))
{
   const double b = options_.disc_radius, low = std::max(0.1 * b, b - 2.5);
   // The interpolation by a cubic needs four patterns.
   const int count = std::max(3, static_cast<int>(std::ceil((b - low) / 0.1)));
   options_.load_radii.clear();
   for (int k = 0; k <= count; ++k)
   {
      options_.load_radii.push_back(k == count ? b : low + (b - low) * k / count);
   }
   scene_ = make_disc(options_);
   counters_ = scene_.reduction.counters;
}

double CriticalLoad::radius(double friction)
{
   ReducedProblem &problem = scene_.reduction.problem;
   set_friction(problem, friction);
   FrictionSolver solver(problem);
   const std::vector<double> &grid = options_.load_radii;
   const auto separates = [&](double a)
   {
      const int above = std::lower_bound(grid.begin(), grid.end(), a) - grid.begin();
      const int first = std::clamp(above - 2, 0, static_cast<int>(grid.size()) - 4);
      NamedLoads load;
      for (int i = first; i < first + 4; ++i)
      {
         double &share = load[radius_load(grid[i])] = 1;
         for (int j = first; j < first + 4; ++j)
         {
            if (j != i) { share *= (a - grid[j]) / (grid[i] - grid[j]); }
         }
      }
      ContactState state = ContactState::virgin(problem);
      if (!guess_.empty()) { state.status = guess_; }
      const IncrementReport report =
         solver.solve(state, problem.multipliers(load)); // self-similar: one increment
      require(report.status == FrictionStatus::converged,
              "critical load radius, f = ", friction, ", a = ", a, ": ", report.message);
      guess_ = state.status;
      const std::vector<NodeState> settled = settled_states(problem, state);
      return std::any_of(settled.begin(), settled.end(),
                         [](NodeState status) { return !closed(status); });
   };
   double low = grid.front(), high = grid.back(), result = high;
   if (!separates(low)) { result = std::numeric_limits<double>::quiet_NaN(); }
   else if (!separates(high))
   {
      while (high - low > 1e-5)
      {
         const double middle = 0.5 * (low + high);
         (separates(middle) ? low : high) = middle;
      }
      result = high;
   }
   counters_ += solver.counters();
   return result;
}

double bonded_critical_radius(DiscOptions options)
{
   const auto lowest = [&](const std::vector<double> &radii)
   {
      options.load_radii = radii;
      const Scene scene = make_disc(options);
      const ReducedProblem &problem = scene.problem();
      std::vector<double> lowest;
      for (double a : radii)
      {
         // Without the node at the axis and the last three, at the corner of the rim.
         const LoadPattern &load = problem.patterns[problem.pattern(radius_load(a))];
         lowest.push_back(load.p.segment(1, problem.nodes() - 4).minCoeff());
      }
      return lowest;
   };
   return changing(options.disc_radius, 0.02 * options.disc_radius, lowest);
}

} // namespace miniapp
