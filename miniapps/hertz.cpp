//  hertz: parabolic contact pressed, then sheared, against Hertz and Cattaneo-Mindlin
//
//  Case III of the thesis (3.7.3). Two equal half-planes with an initial gap x²/2R, or a
//  square block (side 2a) with that gap on a similar half-plane. E' = E/(1-ν²) = 1 for each
//  body, so that E* = 1/2. The unit of length is the Hertz half-width b with half-planes, and
//  a with the block. The computed pressure and shear are compared with the closed forms node
//  by node. Slip and pressure of the block are coupled, so its contact really differs from
//  the closed forms.
//
//  Sample runs:
//    hertz
//    hertz --domain 1e4
//    hertz --order 1
//    hertz --shear "0.3 0.6 0.9"
//    hertz --body block --ratio 0.8 --shear none
//    hertz --body block --shear none

#include "common/hertz_scene.hpp"
#include "common/run.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>

using namespace cattaneo;
using namespace miniapp;
using Eigen::VectorXd;

namespace
{

void hertz(Study &study)
{
   std::string body = "half-plane";
   double friction = 0.4, poisson = 0.3, ratio = 0.4, domain = 0, span = 1.67;
   int order = 2, nodes = 101;
   std::vector<double> shear = {0.6}, levels_of_P;
   MarchSettings settings;
   study.options().group("The contact");
   study.option(&body, "body", "half-plane (two of them) or block (on a half-plane).",
                {"half-plane", "block"});
   study.option(&friction, "friction", "Coefficient of friction.", not_negative);
   study.option(&poisson, "poisson", "Poisson's ratio of both bodies.");
   study.option(&ratio, "ratio",
                "With a block: Hertz's half-width of contact over the half-width of the block.",
                between(0, 1));
   study.option(&span, "span",
                "With half-planes: half-width of the line of contact nodes over Hertz's "
                "half-width of contact.",
                above(1));
   study.options().group("The mesh");
   study.option(&domain, "domain", domain_help, none_or_above(10));
   study.option(&order, "order", "Order of the elements.", within(1, 8));
   study.option(&nodes, "nodes", "Number of contact nodes.", at_least(9));
   study.options().group("The loads");
   study.option(&levels_of_P, "load-levels",
                "Loading: fractions of the full load P at which pressures and gaps are drawn "
                "(empty: none).",
                above_up_to(0, 1));
   study.option(&shear, "shear", "Monotonic shear after P: values of Q/fP, or none.");
   study.option(&settings.increments, "increments",
                "Load increments between two values of --load-levels or --shear (more where "
                "contact advances).",
                at_least(1));
   study.parse();
   require((nodes - 1) % order == 0, "option --nodes is ", nodes,
           ", must be one more than a multiple of the order ", order);
   if (friction == 0)
   {
      require(shear.empty() || !study.options().says("shear"),
              "option --shear is Q/(fP), so that --friction must be above 0");
      shear.clear();
   }

   const bool on_block = body == "block";
   const double E_star = 0.5, radius = 100, b = on_block ? ratio : 1.0;
   const double P = M_PI * E_star * b * b / (4 * radius), p0 = 2 * P / (M_PI * b);
   const Material material = unit_material(poisson);
   Scene scene =
      on_block
         ? make_scene(BlockOnHalfPlane{order, nodes, domain, material, P})
         : make_scene(HalfPlanes{order, nodes, b, span, domain, material, P, false, false});
   ReducedProblem &problem = scene.problem();
   set_friction(problem, friction);
   const VectorXd x = problem.position.col(0);
   problem.gap = x.array().square() / (2 * radius);
   study.reduced(scene);
   // The pressure over p0, with x in b: √(1 - x²) within the contact, and zero beyond.
   const auto ellipse = [b](double half, double s)
   { return std::abs(s) < half ? std::sqrt(half * half - s * s) / b : 0.0; };

   Run run(study, problem, settings);
   if (!levels_of_P.empty())
   {
      // Thesis figures 3.11 and 3.12; b and p0 are those of the full load.
      Panel &gaps = study.lines("gaps", "Gap during loading", "x/b", "gap over b²/2R"),
            &pressures =
               study.lines("pressures", "Pressure during loading", "x/b", "p/p0 Hertz");
      std::sort(levels_of_P.begin(), levels_of_P.end());
      for (const double level : levels_of_P)
      {
         run.to({{"P", level}});
         const std::string label = exact_text("P/P0 = ", level);
         gaps.add(label, x / b, VectorXd((problem.gap + run.state.w) * (2 * radius / (b * b))));
         pressures.add(label, x / b, tractions(problem, run.state.p) / p0);
      }
      gaps.add("before", x / b, VectorXd(problem.gap * (2 * radius / (b * b))), "dashed");
   }
   run.to({{"P", 1}});
   Panel &profiles =
      study.lines("tractions", "Pressure and shear", "x/b", "p/p0 Hertz, -q/(f p0 Hertz)");
   profiles.add("p", x / b, tractions(problem, run.state.p) / p0, "points");
   profiles.add("Hertz: p", x / b, x.unaryExpr([&](double s) { return ellipse(b, s); }),
                "dashed");
   const Zone contact = contact_zone(problem, run.state);
   const Deviation pressure =
      deviation(problem, run.state.p, p0, [&](double s) { return p0 * ellipse(b, s); });
   study.title("P only");
   study.value("half_width", half_width(contact) / b, "half-width", read_out_error(contact) / b,
               "b_Hertz");
   study.value("peak_pressure", peak_pressure(problem, run.state, half_width(contact)) / p0,
               "peak pressure", none, "p0_Hertz");
   study.value("pressure_deviation", pressure.largest, "largest deviation from Hertz", none,
               "p0_Hertz");
   study.value("pressure_deviation_mean", pressure.mean, "mean deviation from Hertz", none,
               "p0_Hertz");

   ResultTable &levels = study.table("levels", {{"shear", "Q/fP", "%.3f"},
                                                {"stick_half_width", "stick c/b", "%.5f"},
                                                {"cattaneo_mindlin", "Mindlin c/b", "%.5f"},
                                                {"shear_deviation", "q off / f p0", "%.2e"}});
   const std::size_t one_way = levels_one_way(shear);
   for (std::size_t k = 0; k < shear.size(); ++k)
   {
      const double Q = shear[k], way = Q < 0 ? -1 : 1;
      run.to({{"Q", Q * friction}});
      const Zone stick = stick_zone(problem, run.state);
      const double c = half_width(stick) / b;
      // Only for monotonic loading. There is no closed form for reversed loading here.
      const double exact_c = k < one_way ? std::sqrt(std::max(0.0, 1 - std::abs(Q))) : none;
      // Shear +Q acts on body 1 above: the force of the contact on it is -q.
      const Deviation off =
         deviation(problem, run.state.q, friction * p0,
                   [&](double s) {
                      return -way * friction * p0 * (ellipse(b, s) - ellipse(exact_c * b, s));
                   });
      profiles.add(exact_text("-q/f, Q/fP = ", Q), x / b,
                   tractions(problem, run.state.q) / (-friction * p0));
      study.row(levels, {Q, c, exact_c, k < one_way ? off.largest : none});
      study.results["stick_half_width"] = c;
      // A closed form has no spread. The allowed difference by the mesh is the error of the
      // position.
      if (k < one_way && !on_block && nodes == 101 && span == 1.67 &&
          (domain == 0 || domain >= 1e3))
      {
         study.compare(exact_text("stick half-width / b, Q/fP = ", Q), exact_c,
                       {0, read_out_error(stick) / b}, c);
      }
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("hertz", argc, argv, hertz);
}
