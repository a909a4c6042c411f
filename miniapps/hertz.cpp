//  hertz: parabolic contact pressed, then sheared, against Hertz and Cattaneo-Mindlin
//
//  Case III of the thesis (3.7.3). Two equal half-planes with an initial gap x²/2R, or a square
//  block (side 2a) with that gap on a similar half-plane. E' = E/(1-ν²) = 1 for each body, so
//  that E* = 1/2. The half-planes' length unit is the Hertz half-width b, the block's is a. The
//  computed pressure and shear are compared with the closed forms node by node; on the block
//  the contact is coupled and truly deviates from them.
//
//  Sample runs:  hertz
//                hertz -order 1
//                hertz -shear "0.3 0.6 0.9"
//                hertz -body block -ratio 0.8 -shear ""

#include "common/figure.hpp"
#include "common/miniapp.hpp"

#include <algorithm>
#include <cattaneo/condense/reduction.hpp>
#include <cattaneo/elastic/graded_mesh.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/zones.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <iostream>
#include <limits>

using namespace cattaneo;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();
const double E_star = 0.5, radius = 100;

struct Scene
{
   std::vector<std::unique_ptr<mfem::Mesh>> meshes;
   std::vector<std::unique_ptr<ElasticBody>> bodies;
   Reduction reduction;
   int dofs = 0;
};

Material material(double poisson)
{
   return {1 - poisson * poisson, poisson, PlaneState::strain};
}

/// Loads of a body whose face of attribute `top`, of half-width L at height H above the
/// contact, takes P as pressure and Q as shear with the linear pressure that balances its
/// moment. `turn` is -1 for the body below, the half-turn image of the one above.
void load(ElasticBody &body, int top, double L, double H, double P, double turn)
{
   body.add_pressure("P", top, P / (2 * L));
   body.add_traction("Q", top, turn * P / (2 * L), 0.0);
   const double slope = -turn * 1.5 * P * H / (L * L * L);
   body.add_pressure("Q", top, [=](double x, double) { return slope * x; });
}

/// Two half-planes, both free, under loads in equilibrium: body 2 is body 1 turned by 180°.
Scene half_planes(int order, int nodes, double span, double domain, double poisson, double P)
{
   Scene scene;
   const int elements = (nodes - 1) / order;
   const std::vector<double> contact = graded_to_ends(span, elements, 1.0);
   const double h = contact[1] - contact[0], growth = 1.25;
   const std::vector<double> depth = graded(0, span, h, growth, 0.2 * span);
   const std::vector<double> rings = ring_scales(span, domain, h, growth);
   const int surface = 1, far = 3;
   std::vector<CondensedBody> condensed;
   for (double turn : {-1.0, 1.0}) // the mesh is the lower body, its half-turn the upper one
   {
      scene.meshes.push_back(
         std::make_unique<mfem::Mesh>(half_plane_mesh(contact, depth, rings)));
      mfem::Mesh &mesh = *scene.meshes.back();
      for (int v = 0; v < mesh.GetNV(); ++v)
      {
         mesh.GetVertex(v)[0] *= turn;
         mesh.GetVertex(v)[1] *= turn;
      }
      scene.bodies.push_back(std::make_unique<ElasticBody>(mesh, order, material(poisson)));
      ElasticBody &body = *scene.bodies.back();
      load(body, far, domain, domain, P, -turn);
      scene.dofs += body.space().GetTrueVSize();
      const ContactLine line = contact_line(body, surface);
      condensed.push_back(
         condense(body, line, {}, condensed.empty() ? nullptr : &condensed.front()));
   }
   const Pairing pairing = pair_lines(condensed[0].line, condensed[1].line);
   scene.reduction = reduce(condensed[0], condensed[1], pairing);
   return scene;
}

/// Square block of side 2 on a half-plane that is held at its bottom.
Scene block(int order, int nodes, double domain, double poisson, double P)
{
   Scene scene;
   const double growth = 1.25;
   const std::vector<double> contact = graded_to_ends(1.0, (nodes - 1) / order, 1.0);
   const double h = contact[1] - contact[0];
   const int bottom = 1, top = 3;
   scene.meshes.push_back(
      std::make_unique<mfem::Mesh>(rectangle_mesh(contact, graded(0, 2, h, growth, 0.1))));
   scene.bodies.push_back(
      std::make_unique<ElasticBody>(*scene.meshes[0], order, material(poisson)));
   load(*scene.bodies[0], top, 1, 2, P, 1);
   scene.meshes.push_back(std::make_unique<mfem::Mesh>(half_plane_mesh(
      contact, graded(0, 1, h, growth, 0.1), ring_scales(1, domain, h, growth))));
   scene.bodies.push_back(
      std::make_unique<ElasticBody>(*scene.meshes[1], order, material(poisson)));
   ElasticBody &plane = *scene.bodies[1];
   const int surface = 1, far = 3;
   for (int component : {0, 1}) { plane.fix(far, component); }
   for (const auto &body : scene.bodies) { scene.dofs += body->space().GetTrueVSize(); }
   const ContactLine above = contact_line(*scene.bodies[0], bottom);
   const ContactLine below = contact_line(plane, surface);
   scene.reduction = reduce(condense(*scene.bodies[0], above), condense(plane, below),
                            pair_lines(above, below));
   return scene;
}

/// Peak pressure: top of the parabola p²(x) (exact for Hertz) fitted within half a half-width
/// of the largest nodal value, with the nodes' weights. Nodal values of quadratic elements
/// alternate about the smooth profile, by 0.03 % here, in the proportion of their weights.
double peak_pressure(const ReducedProblem &problem, const ContactState &state,
                     double half_width)
{
   const VectorXd p = tractions(problem, state.p), x = problem.position.col(0);
   Eigen::Index top = 0;
   p.maxCoeff(&top);
   Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
   Eigen::Vector3d rhs = Eigen::Vector3d::Zero();
   for (Eigen::Index i = 0; i < x.size(); ++i)
   {
      const double s = (x[i] - x[top]) / half_width;
      if (std::abs(s) > 0.5) { continue; }
      const Eigen::Vector3d row(1, s, s * s);
      normal += problem.weights[i] * row * row.transpose();
      rhs += problem.weights[i] * p[i] * p[i] * row;
   }
   const Eigen::Vector3d c = normal.ldlt().solve(rhs);
   return std::sqrt(c[0] - c[1] * c[1] / (4 * c[2]));
}

/// Largest deviation of nodal tractions from a closed form, in units of `scale`.
double deviation(const VectorXd &traction, const VectorXd &x, double scale,
                 const std::function<double(double)> &exact)
{
   double worst = 0;
   for (Eigen::Index i = 0; i < x.size(); ++i)
   {
      worst = std::max(worst, std::abs(traction[i] - exact(x[i])) / scale);
   }
   return worst;
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const miniapp::Stopwatch watch;
         const char *body = "half-plane", *shear_list = "0.6", *json = "", *csv = "",
                    *plot = "";
         double friction = 0.4, poisson = 0.3, ratio = 0.4, domain = 1e4, span = 1.67;
         int order = 2, nodes = 101, increments = 20;
         mfem::OptionsParser args(argc, argv);
         args.AddOption(&body, "-body", "--body",
                        "half-plane (two of them) or block (on a half-plane).");
         args.AddOption(&friction, "-friction", "--friction", "Coefficient of friction.");
         args.AddOption(&poisson, "-poisson", "--poisson", "Poisson's ratio of both bodies.");
         args.AddOption(&ratio, "-ratio", "--ratio", "Block: Hertz half-width over a.");
         args.AddOption(&span, "-span", "--span",
                        "Half-planes: half-width of the contact candidates, in b.");
         args.AddOption(&domain, "-domain", "--domain",
                        "Half-width and depth of a half-plane, in b or a.");
         args.AddOption(&order, "-order", "--order", "Order of the elements.");
         args.AddOption(&nodes, "-nodes", "--nodes", "Contact nodes.");
         args.AddOption(&shear_list, "-shear", "--shear",
                        "Monotonic shear after P: list of Q/fP.");
         args.AddOption(&increments, "-increments", "--increments",
                        "Load increments between two values (more where contact advances).");
         args.AddOption(&json, "-json", "--json", "File for the results.");
         args.AddOption(&csv, "-csv", "--csv", "Prefix of CSV files for the figures.");
         args.AddOption(&plot, "-plot", "--plot", "Picture of the results (png, pdf, svg).");
         miniapp::parse(args);
         miniapp::check_choice("--body", body, {"half-plane", "block"});
         const bool on_block = std::string(body) == "block";
         require(order >= 1 && order <= 8, "option --order is ", order, ", must be 1 to 8");
         require(nodes >= 9 && (nodes - 1) % order == 0, "option --nodes is ", nodes,
                 ", must be at least 9 and one more than a multiple of the order ", order);
         require(ratio > 0 && ratio < 1, "option --ratio is ", ratio,
                 ", must be between 0 and 1");
         require(span > 1, "option --span is ", span, ", must be above 1");
         require(domain > 10, "option --domain is ", domain, ", must be above 10");
         require(increments >= 1, "option --increments is ", increments,
                 ", must be at least 1");
         const std::vector<double> shear = miniapp::numbers("--shear", shear_list);

         const double b = on_block ? ratio : 1.0;
         const double P = M_PI * E_star * b * b / (4 * radius), p0 = 2 * P / (M_PI * b);
         Scene scene = on_block ? block(order, nodes, domain, poisson, P)
                                : half_planes(order, nodes, span, domain, poisson, P);
         ReducedProblem &problem = scene.reduction.problem;
         set_friction(problem, friction);
         const VectorXd x = problem.position.col(0);
         problem.gap = x.array().square() / (2 * radius);
         const double condensed = watch.seconds();
         std::cout << "Condensed " << scene.dofs << " dofs to " << 2 * problem.nodes() << " in "
                   << condensed << " s" << std::endl;

         MarchSettings settings;
         settings.increments = increments;
         FrictionSolver solver(problem, settings.friction);
         ContactState state = ContactState::virgin(problem);
         MarchReport report = march(
            solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state, settings);
         Counters counters = scene.reduction.counters;
         counters += report.counters;
         int code = miniapp::exit_code(report);
         miniapp::ReferenceTable table;
         nlohmann::ordered_json results;
         miniapp::Panel profiles = miniapp::Panel::lines("tractions", "Pressure and shear",
                                                         "x/b", "p/p0 Hertz, -q/(f p0 Hertz)");
         if (code == 0)
         {
            profiles.add("p", x / b, tractions(problem, state.p) / p0, "points");
            VectorXd exact(x.size());
            for (Eigen::Index i = 0; i < x.size(); ++i)
            {
               exact[i] = std::sqrt(std::max(0.0, 1 - x[i] * x[i] / (b * b)));
            }
            profiles.add("Hertz: p", x / b, exact, "dashed");
            const Zone contact = contact_zone(problem, state);
            const double half_width = 0.5 * (contact.to.position - contact.from.position);
            const VectorXd p = tractions(problem, state.p);
            const double peak = peak_pressure(problem, state, half_width);
            const double worst =
               deviation(p, x, p0,
                         [&](double s) {
                            return std::abs(s) < b ? p0 * std::sqrt(1 - s * s / (b * b)) : 0.0;
                         });
            results["half_width"] = half_width / b;
            results["half_width_error"] = std::max(contact.to.error, contact.from.error) / b;
            results["peak_pressure"] = peak / p0;
            results["pressure_deviation"] = worst;
            std::cout << "\nP:  half-width " << half_width / b << " b_Hertz (read-out ± "
                      << std::max(contact.to.error, contact.from.error) / b
                      << "), peak pressure " << peak / p0
                      << " p0_Hertz, largest deviation from Hertz " << worst << " p0"
                      << std::endl;
            // Tolerances: of the peak, 0.2 % for bilinear and 0.008 % for quadratic elements at
            // 101
            // nodes; of edges, the spread of the reference (none for closed forms) and the
            // read-out.
            const double read_out = std::max(contact.to.error, contact.from.error) / b;
            if (!on_block && nodes == 101 && span == 1.67 && domain >= 1e3)
            {
               table.add("peak pressure / p0 Hertz", 1.0, order == 1 ? 2e-3 : 8e-5, none,
                         peak / p0);
               table.add("half-width / b Hertz", 1.0, read_out, none, half_width / b);
            }
            if (on_block && (ratio == 0.4 || ratio == 0.8) && friction == 0.4 && domain >= 1e3)
            {
               table.add("half-width / b Hertz", ratio == 0.4 ? 0.989 : 0.959, 0.003 + read_out,
                         none, half_width / b);
               table.add("peak pressure / p0 Hertz", ratio == 0.4 ? 1.011 : 1.047, 0.003, none,
                         peak / p0);
            }
         }
         if (code == 0 && !shear.empty())
         {
            std::cout << "\n  Q/fP   stick c/b   Mindlin c/b   shear deviation / f p0\n";
         }
         nlohmann::ordered_json levels = nlohmann::ordered_json::array();
         for (std::size_t k = 0; k < shear.size() && code == 0; ++k)
         {
            const Vector2d from = state.multipliers, to(1, shear[k] * friction);
            state.time = 0;
            report = march(solver, LoadHistory::through({from, to}), state, settings);
            counters += report.counters;
            code = miniapp::exit_code(report);
            if (code != 0) { break; }
            const Zone stick = widest_zone(problem, state, NodeState::stick);
            const bool any = stick.last >= stick.first;
            const double c = any ? 0.5 * (stick.to.position - stick.from.position) / b : 0.0;
            const double exact_c = std::sqrt(std::max(0.0, 1 - shear[k]));
            // Shear +Q acts on body 1 above: the force of the contact on it is -q.
            const double worst = deviation(
               tractions(problem, state.q), x, friction * p0,
               [&](double s)
               {
                  auto ellipse = [&](double half)
                  { return std::abs(s) < half ? std::sqrt(half * half - s * s) / b : 0.0; };
                  return -friction * p0 * (ellipse(b) - ellipse(exact_c * b));
               });
            char label[32];
            std::snprintf(label, sizeof label, "-q/f, Q/fP = %g", shear[k]);
            profiles.add(label, x / b, tractions(problem, state.q) / (-friction * p0));
            std::printf("%6.3f   %9.5f   %11.5f   %12.2e\n", shear[k], c, exact_c, worst);
            levels.push_back({{"shear", shear[k]},
                              {"stick_half_width", c},
                              {"cattaneo_mindlin", exact_c},
                              {"shear_deviation", worst}});
            if (!on_block && nodes == 101 && span == 1.67 && domain >= 1e3)
            {
               char name[64];
               std::snprintf(name, sizeof name, "stick half-width / b, Q/fP = %g", shear[k]);
               table.add(name, exact_c, std::max(stick.from.error, stick.to.error) / b, none,
                         c);
            }
         }
         if (!levels.empty())
         {
            results["levels"] = levels;
            results["stick_half_width"] = levels.back()["stick_half_width"];
         }
         table.print();
         results["status"] = name(report.status);
         results["contact_nodes"] = problem.nodes();
         results["dofs"] = scene.dofs;
         results["seconds"] = watch.seconds();
         results["seconds_condensation"] = condensed;
         results["counters"] = miniapp::to_json(counters);
         results["references"] = table.json();
         miniapp::write_json(results, json);
         miniapp::output({profiles}, csv, plot);
         return code;
      });
}
