//  work_precision: error against whole run time and dofs, orders 1 to 4, uniform and graded
//
//  Problems with known answers: Hertz and Cattaneo-Mindlin, Lubkin's twisted spheres, the
//  square punch, the receding strip and disc, the lap joint, the shakedown limit of a punch.
//  Every run is a process of its own, from mesh to answer, on the exact path (no error of
//  increments).
//
//  Meshes: uniform - nodes of equal distance where contact can be; graded - toward corners and
//  toward the edges of contact and stick that a coarse run finds (its time is counted); nested
//  - the same by splitting elements in four (nonconforming); default - the miniapp's own. Away
//  from the contact elements grow, and all are about halved from one level to the next.
//
//  References are closed forms where there are any; else two runs of this library on another
//  discretisation (orders 5 and 6 on finer graded meshes), whose difference is the uncertainty.
//  Independent reference values are printed beside them. An error within the uncertainty is
//  printed as "<" and left out of rates and pictures.

#include "common/contact_grid.hpp"
#include "common/disc_scene.hpp"
#include "common/figure.hpp"
#include "common/hertz_scene.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/measure.hpp"
#include "common/miniapp.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"

#include <algorithm>
#include <cattaneo/elastic/graded_mesh.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/friction/zones.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using miniapp::Focus;
using miniapp::focused_grid;

namespace
{

const double none = std::numeric_limits<double>::quiet_NaN();

enum class Family
{
   uniform,
   graded,
   nested,
   standard
};

const char *name(Family family)
{
   switch (family)
   {
   case Family::uniform:
      return "uniform";
   case Family::graded:
      return "graded";
   case Family::nested:
      return "nested";
   case Family::standard:
      return "default";
   }
   return "";
}

/// What a problem is asked to be solved on.
struct Resolution
{
   Family family = Family::uniform;
   int order = 2;
   double spacing = 0;             ///< of the contact nodes where nothing asks for less
   double finest = 1;              ///< spacing toward the edges over `spacing`
   double corner = 1;              ///< the same toward corners
   double growth = 1;              ///< from node to node
   std::vector<double> edges = {}; ///< of contact and stick, found before

   double element_growth() const { return 1 + order * (growth - 1); }

   /// Where nodes are to be close: in [lo, hi] `spacing`, and less at corners and edges.
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
   double scale; ///< errors are over this; 0: over the reference
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
   bool nested = false;
   bool standard = true; ///< there is a miniapp with a default mesh
};

const MarchSettings &exactly()
{
   static const MarchSettings settings = []
   {
      MarchSettings s;
      s.stepping = Stepping::exact;
      s.stop_at_steady_state = false;
      return s;
   }();
   return settings;
}

MarchReport follow(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                   const MarchSettings &settings = exactly())
{
   state.time = 0;
   MarchReport report = march(solver, history, state, settings);
   require(report.status == FrictionStatus::converged, "a march ended: ", report.message);
   return report;
}

// --- Hertz, Cattaneo-Mindlin ----------------------------------------------------------------

Answer hertz(const Resolution &r)
{
   const double f = 0.4, shear = 0.6, radius = 100, E_star = 0.5, span = 1.67;
   const double P = M_PI * E_star / (4 * radius), p0 = 2 * P / M_PI, c = std::sqrt(1 - shear);
   miniapp::HalfPlanes options;
   options.material = Material{0.91, 0.3};
   options.load = P;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = miniapp::mirrored(r.grid(span, r.foci(0, span)));
   }
   miniapp::HertzScene scene = make_scene(options);
   ReducedProblem &problem = scene.reduction.problem;
   set_friction(problem, f);
   const VectorXd x = problem.position.col(0);
   problem.gap = x.array().square() / (2 * radius);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   follow(solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state,
          MarchSettings()); // the contact grows: as the miniapp does
   const auto ellipse = [](double s, double half)
   { return std::abs(s) < half ? std::sqrt(half * half - s * s) : 0.0; };
   const Zone contact = contact_zone(problem, state);
   const double b = 0.5 * (contact.to.position - contact.from.position);
   Answer answer;
   answer.values = {
      miniapp::peak_pressure(problem, state, b) / p0, b,
      miniapp::deviation(problem, state.p, p0, [&](double s) { return p0 * ellipse(s, 1); })
         .mean};
   follow(solver, LoadHistory::through({Vector2d(1, 0), Vector2d(1, shear * f)}), state);
   const Zone stick = widest_zone(problem, state, NodeState::stick);
   const double found = 0.5 * (stick.to.position - stick.from.position);
   answer.values.push_back(found);
   answer.values.push_back(
      miniapp::deviation(problem, state.q, f * p0,
                         [&](double s) { return f * p0 * (ellipse(s, c) - ellipse(s, 1)); })
         .mean);
   answer.edges = {found, b};
   answer.dofs = scene.dofs;
   answer.nodes = static_cast<double>(problem.nodes());
   return answer;
}

// --- Lubkin: spheres pressed together and twisted -------------------------------------------

double lubkin_rotation(double c) // of P = G = a = f = 1
{
   const double k = std::sqrt(1 - c * c);
   return 1.5 / M_PI * (std::comp_ellint_1(k) - std::comp_ellint_2(k));
}

double lubkin_torque(double c)
{
   const int steps = 4000;
   double sum = 0;
   for (int k = 0; k <= steps; ++k)
   {
      const double s = c + (1 - c) * k / steps;
      sum += (k == 0 || k == steps ? 1 : 2 + 2 * (k % 2)) * s * s *
             std::comp_ellint_2(std::sqrt(1 - s * s));
   }
   return 4 / M_PI * sum * (1 - c) / steps / 3;
}

/// Two bodies that meet in r < 1 with a gap r²/(2 R), pressed and turned at their far ends.
/// Radius, torque and stick radius are compared for the force and the rotation that came out.
Answer lubkin(const Resolution &r)
{
   const double f = 0.3, c = 0.5, far = 3e3, sphere = 5, poisson = 0.3;
   const int bottom = 1, side = 2, top = 3;
   const std::vector<double> contact = r.grid(1, r.foci(0, 1));
   const double growth = r.element_growth(), h = miniapp::smallest_step(contact);
   const std::vector<double> radii =
      joined({contact, graded(1, far, contact.back() - contact[contact.size() - 2], growth)});
   const std::vector<double> up = graded(0, far, h, growth);
   std::vector<double> down;
   for (auto z = up.rbegin(); z != up.rend(); ++z) { down.push_back(-*z); }
   down.back() = 0;
   mfem::Mesh upper_mesh = rectangle_mesh(radii, up), lower_mesh = rectangle_mesh(radii, down);
   const BoundaryPart upper_far({side, top}), lower_far({bottom, side}),
      above({bottom}, 0, 0, 1), below({top}, 0, 0, 1);
   const Material material{1.0, poisson};
   ElasticBody upper(upper_mesh, r.order, material, Geometry::axisymmetric),
      lower(lower_mesh, r.order, material, Geometry::axisymmetric),
      turned(upper_mesh, r.order, material, Geometry::torsion),
      held(lower_mesh, r.order, material, Geometry::torsion);
   upper.fix(upper_far, 0);
   upper.add_displacement("approach", upper_far, 1, -1.0);
   lower.fix(lower_far, 0);
   lower.fix(lower_far, 1);
   turned.add_displacement("twist", upper_far, 0, 1.0);
   held.fix(lower_far, 0);
   const ContactLine one = contact_line(upper, above), other = contact_line(lower, below);
   Reduction reduction =
      reduce(condense(upper, one), condense(lower, other), pair_lines(one, other));
   reduction.add_torsion(condense(turned, contact_line(turned, above)),
                         condense(held, contact_line(held, below)));
   ReducedProblem &problem = reduction.problem;
   const Index n = problem.nodes();
   const VectorXd radius = problem.position.col(0);
   problem.gap = radius.cwiseAbs2() / (2 * sphere);
   set_friction(problem, f);
   FrictionSolver solver(problem);
   const double approach = 0.7 * 0.7 / sphere, G = 0.5 / (1 + poisson);
   const double E_star = 0.5 / (1 - poisson * poisson);
   ContactState state = ContactState::virgin(problem);
   const auto solve = [&](double twist)
   {
      const IncrementReport report = solver.solve(state, Vector2d(approach, twist));
      require(report.status == FrictionStatus::converged, "Lubkin: ", report.message);
   };
   solve(0);
   const double load = state.p.sum(), a = std::cbrt(0.75 * load * sphere / E_star);
   const double shift = radius[0] - problem.arc_length[0];
   const double edge = contact_zone(problem, state).to.position + shift;
   solve(f * load / (G * a * a) * lubkin_rotation(c));
   const double stick = widest_zone(problem, state, NodeState::stick).to.position + shift;
   const double torque = -radius.dot(state.q.tail(n)) / (f * load * a);
   Answer answer;
   answer.values = {torque / lubkin_torque(c), stick / a / c, edge / a};
   answer.edges = {stick, edge};
   answer.dofs = upper.dofs() + lower.dofs() + turned.dofs() + held.dofs();
   answer.nodes = static_cast<double>(n);
   return answer;
}

// --- punch, strip, disc, lap joint, shakedown -----------------------------------------------

/// Elements that are too large are split in four, and their quarters if need be: a coarse mesh
/// becomes one whose sizes follow the foci as the grid lines of graded meshes do, without the
/// lines that run on through the whole body.
std::function<void(mfem::Mesh &, int)> splitting(const Resolution &r, std::vector<Focus> foci)
{
   const auto too_large = [r, foci](const double(&lo)[2], const double(&hi)[2])
   {
      // Along the contact alone what both bodies share decides: they stay matched.
      const bool touches = lo[1] == 0 || hi[1] == 0;
      const double size = touches ? hi[0] - lo[0] : std::max(hi[0] - lo[0], hi[1] - lo[1]);
      return std::any_of(foci.begin(), foci.end(),
                         [&](const Focus &focus)
                         {
                            const double dx =
                                            std::max({lo[0] - focus.hi, focus.lo - hi[0], 0.0}),
                                         dy = touches ? 0.0 : std::max({lo[1], -hi[1], 0.0});
                            const double away = std::hypot(dx, dy);
                            const double wanted =
                               r.order * (focus.spacing + (r.growth - 1) * away);
                            return size > std::sqrt(2.0) * wanted; // so that the mean is right
                         });
   };
   return [too_large](mfem::Mesh &mesh, int)
   {
      mesh.EnsureNCMesh();
      mfem::Array<int> marked, vertices;
      do {
         marked.SetSize(0);
         for (int e = 0; e < mesh.GetNE(); ++e)
         {
            double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
            mesh.GetElementVertices(e, vertices);
            for (int v : vertices)
            {
               for (int k = 0; k < 2; ++k)
               {
                  lo[k] = std::min(lo[k], mesh.GetVertex(v)[k]);
                  hi[k] = std::max(hi[k], mesh.GetVertex(v)[k]);
               }
            }
            if (too_large(lo, hi)) { marked.Append(e); }
         }
         if (marked.Size()) { mesh.GeneralRefinement(marked, 1, 1); }
      } while (marked.Size());
   };
}

/// The coarse mesh to be split.
Resolution base(Resolution r, double spacing)
{
   r.spacing = spacing / r.order;
   r.growth = 1 + 0.9 / r.order;
   r.family = Family::uniform;
   return r;
}

Answer punch(const Resolution &r)
{
   const double f = 0.2;
   miniapp::PunchOptions options;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = miniapp::mirrored(r.grid(1, r.foci(0, 1, {1})));
   }
   if (r.family == Family::nested)
   {
      options.grid = miniapp::mirrored(base(r, 0.5).grid(1, base(r, 0.5).foci(0, 1)));
      options.growth = base(r, 0.5).element_growth();
      options.refine = splitting(r, r.foci(-1, 1, {-1, 1}));
   }
   miniapp::Punch scene = miniapp::make_punch(options);
   ReducedProblem &problem = scene.reduction.problem;
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState pressed = ContactState::virgin(problem);
   follow(solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), pressed);
   const double stick = widest_zone(problem, pressed, NodeState::stick).to.position - 1;
   ContactState state = pressed;
   follow(solver, LoadHistory::through({Vector2d(1, 0), Vector2d(1, 0.5 * f)}), state);
   const double right = widest_zone(problem, state, NodeState::stick).to.position - 1;
   const double Q = 0.8 * f;
   LoadHistory cycle =
      LoadHistory::through({Vector2d(1, 0), Vector2d(1, Q), Vector2d(1, -Q), Vector2d(1, 0)});
   cycle.cycle_start = 0;
   cycle.cycles = 2;
   state = pressed;
   Answer answer;
   answer.values = {follow(solver, cycle, state).cycles.back().dissipation, stick, right,
                    pressed.v[problem.nodes() - 1]};
   answer.edges = {stick};
   answer.dofs = scene.dofs;
   answer.nodes = static_cast<double>(problem.nodes());
   return answer;
}

Answer strip(const Resolution &r)
{
   const double f = 0.7, n = 4;
   miniapp::RecedingOptions options;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = r.grid(options.length, r.foci(0, n + 2.5));
   }
   if (r.family == Family::nested)
   {
      options.grid = base(r, 0.5).grid(options.length, base(r, 0.5).foci(0, n + 2.5));
      options.growth = base(r, 0.5).element_growth();
      options.refine = splitting(r, r.foci(0, n + 2.5));
   }
   miniapp::Receding scene = miniapp::make_receding(options);
   ReducedProblem &problem = scene.reduction.problem;
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   follow(solver, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}), state);
   const std::vector<Zone> all = zones(problem, state);
   Answer answer;
   answer.edges = {all.front().to.position, all.back().from.position};
   answer.values = {n - answer.edges[0], n - answer.edges[1]};
   answer.dofs = scene.dofs;
   answer.nodes = static_cast<double>(problem.nodes());
   return answer;
}

Answer disc(const Resolution &r)
{
   const double f = 0.5;
   miniapp::DiscOptions options;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = r.grid(options.disc_radius, r.foci(0, options.disc_radius));
   }
   miniapp::Disc scene = miniapp::make_disc(options);
   ReducedProblem &problem = scene.reduction.problem;
   Answer answer;
   const double shift = problem.position(0, 0) - problem.arc_length[0];
   for (double friction : {f, 0.0})
   {
      set_friction(problem, friction);
      FrictionSolver solver(problem);
      ContactState state = ContactState::virgin(problem);
      follow(solver, LoadHistory::through({VectorXd::Zero(1), VectorXd::Ones(1)}), state);
      if (friction == 0)
      {
         answer.values.push_back(f * problem.position.col(0).dot(state.p));
         break;
      }
      const std::vector<Zone> all = zones(problem, state);
      answer.values = {all.back().from.position + shift, all.front().to.position + shift};
      answer.edges = {answer.values[1], answer.values[0]};
   }
   answer.dofs = scene.dofs;
   answer.nodes = static_cast<double>(problem.nodes());
   return answer;
}

Answer lap_joint(const Resolution &r)
{
   const double f = 0.2, T = 0.04;
   miniapp::LapJointOptions options;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = r.grid(options.protrusion, r.foci(0, 0.8));
   }
   miniapp::LapJoint joint = miniapp::make_lap_joint(options);
   ReducedProblem &problem = joint.reduction.problem;
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState state = ContactState::virgin(problem);
   const auto half = [](const Zone &zone)
   { return 0.5 * (zone.to.position - zone.from.position); };
   follow(solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), state);
   const ContactState tightened = state;
   const double a0 = half(contact_zone(problem, state));
   follow(solver, LoadHistory::through({Vector2d(1, 0), Vector2d(1, T)}), state);
   const double a = half(contact_zone(problem, state)),
                c = half(widest_zone(problem, state, NodeState::stick));
   LoadHistory cycle = LoadHistory::through({Vector2d(1, 0), Vector2d(1, T), Vector2d(1, 0)});
   cycle.cycle_start = 0;
   cycle.cycles = 2;
   state = tightened;
   Answer answer;
   answer.values = {follow(solver, cycle, state).cycles.back().dissipation, a0, c / a};
   answer.edges = {c, a, a0};
   answer.dofs = joint.dofs;
   answer.nodes = static_cast<double>(problem.nodes());
   return answer;
}

Answer shakedown(const Resolution &r)
{
   const double f = 0.85;
   miniapp::PunchOptions options;
   options.half_plane = true;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = miniapp::mirrored(r.grid(1, r.foci(0, 1, {1})));
   }
   miniapp::Punch scene = miniapp::make_punch(options);
   ReducedProblem &reduced = scene.reduction.problem;
   set_friction(reduced, f);
   LimitProblem problem = limit_problem(reduced, held_and_cycled(reduced, "P", 1, "Q", -1));
   const LimitReport load = load_limit(problem);
   problem.cycle = held_and_cycled(reduced, "P", 1, "Q", -0.5);
   const LimitReport friction = friction_limit(problem, 0.8);
   require(load.status == LimitStatus::certified && friction.status == LimitStatus::certified,
           "shakedown: ", load.message, friction.message);
   Answer answer;
   answer.values = {load.limit / f, friction.limit};
   answer.dofs = scene.dofs;
   answer.nodes = static_cast<double>(reduced.nodes());
   return answer;
}

const std::vector<Problem> &problems()
{
   static const std::vector<Problem> all = {
      {"hertz",
       "Hertz, Cattaneo-Mindlin",
       {{"peak pressure", 1, 1},
        {"half-width", 1, 1},
        {"pressure, rms", 0, 1},
        {"stick half-width", std::sqrt(0.4), 1},
        {"shear, rms", 0, 1}},
       0.15,
       1.0 / 8,
       1,
       0,
       hertz},
      {"lubkin",
       "Lubkin: twisted spheres",
       {{"torque", 1, 1}, {"stick radius", 1, 1}, {"contact radius", 1, 1}},
       0.1,
       1.0 / 8,
       1,
       0,
       lubkin,
       false,
       false},
      {"punch",
       "Square punch on a rigid plane",
       {{"loss of a cycle", none, 0, 9.17e-4, 0.003 * 9.17e-4},
        {"stick, P only", none, 1, 0.471, 0.003},
        {"stick, Q = fP/2", none, 1, -0.203, 0.005},
        {"slip of the corner", none, 0, 0.0496, 0.0005}},
       0.1,
       1,
       1.0 / 64,
       3,
       punch,
       true},
      {"strip",
       "Receding strip",
       {{"separation s/t", none, 1, 1.406, 0.003}, {"stick e/t", none, 1, -0.442, 0.003}},
       0.2,
       1.0 / 16,
       1,
       2,
       strip,
       true},
      {"disc",
       "Receding disc",
       {{"separation d/t", none, 1, 3.728, 0.001},
        {"stick c/t", none, 1, 1.879, 0.001},
        {"spinning limit", none, 0, 17.106, 0.001}},
       0.2,
       1.0 / 16,
       1,
       2,
       disc},
      {"lap_joint",
       "Lap joint",
       {{"loss of a cycle", none, 0, 1.938e-4, 0.003 * 1.938e-4},
        {"contact a0/t", none, 1, 0.7011, 0.0005},
        {"stick c/a", none, 1, 0.760, 0.0005}},
       0.05,
       1.0 / 16,
       1,
       2,
       lap_joint},
      {"shakedown",
       "Shakedown limits of a punch",
       {{"load Q/fP", none, 0, 0.8040, 0.0003}, {"friction", none, 0, 0.805, 0.001}},
       0.1,
       1,
       1.0 / 64,
       2,
       shakedown},
   };
   return all;
}

Resolution resolution(const Problem &problem, Family family, int order, double level)
{
   // From node to node elements grow by a quarter on the coarsest level.
   return {family,
           order,
           problem.spacing / std::pow(2, level),
           problem.finest,
           problem.corner,
           1 + 0.25 / std::pow(2, level),
           {}};
}

/// Coarse run first, where there are edges to be found.
Answer solve(const Problem &problem, Resolution r)
{
   const bool finds =
      (r.family == Family::graded || r.family == Family::nested) && problem.finest < 1;
   if (finds) { r.edges = problem.solve(resolution(problem, Family::uniform, 2, 0)).edges; }
   return problem.solve(r);
}

struct Run
{
   Family family;
   int order = 0, level = 0;
   double nodes = 0, dofs = 0, seconds = 0, megabytes = 0;
   std::vector<double> error;
};

Measured measured(const Problem &problem, const Resolution &r)
{
   return in_own_process(
      [&]
      {
         const Answer answer = solve(problem, r);
         std::vector<double> all{answer.nodes, answer.dofs};
         all.insert(all.end(), answer.values.begin(), answer.values.end());
         return all;
      });
}

struct Reference
{
   double value, uncertainty;
};

std::vector<Reference> references(const Problem &problem)
{
   std::vector<Reference> result;
   const bool closed = std::all_of(problem.quantities.begin(), problem.quantities.end(),
                                   [](const Quantity &q) { return std::isfinite(q.exact); });
   Measured runs[2];
   for (int k = 0; k < 2 && !closed; ++k)
   {
      Resolution r = resolution(problem, Family::graded, 5 + k, problem.fine + k);
      r.finest = problem.finest / 4;
      r.corner = problem.corner / 16;
      r.growth = 1.12 - 0.03 * k;
      runs[k] = measured(problem, r);
      require(runs[k].ok, problem.name, ": the reference failed");
      std::printf("reference, order %d: %.0f nodes, %.0f dofs, %.2f s\n", 5 + k,
                  runs[k].values[0], runs[k].values[1], runs[k].cpu);
   }
   std::printf("%-20s %14s %10s   %s\n", "reference", "value", "+-", "independent");
   for (std::size_t q = 0; q < problem.quantities.size(); ++q)
   {
      const Quantity &quantity = problem.quantities[q];
      if (closed)
      {
         result.push_back({quantity.exact, 0});
         std::printf("%-20s %14.8g %10s   closed form\n", quantity.name, quantity.exact, "0");
         continue;
      }
      const double fine = runs[1].values[2 + q], other = runs[0].values[2 + q];
      result.push_back({fine, std::abs(fine - other)});
      std::printf("%-20s %14.8g %10.1e   %g +- %.1e\n", quantity.name, fine,
                  std::abs(fine - other), quantity.known, quantity.known_error);
   }
   return result;
}

/// Error within the uncertainty of the reference?
bool within(const Reference &reference, const Quantity &quantity, double error)
{
   const double scale = quantity.scale > 0 ? quantity.scale : std::abs(reference.value);
   return error <= reference.uncertainty / scale;
}

void print_rates(const std::vector<Run> &runs, const Problem &problem,
                 const std::vector<Reference> &reference)
{
   std::printf("%-8s %5d  observed rate against dofs:    ", name(runs.back().family),
               runs.back().order);
   for (std::size_t q = 0; q < problem.quantities.size(); ++q)
   {
      std::vector<double> x, y;
      for (const Run &run : runs)
      {
         if (within(reference[q], problem.quantities[q], run.error[q])) { continue; }
         x.push_back(run.dofs);
         y.push_back(run.error[q]);
      }
      std::printf(" %18.2f", log_slope(x, y));
   }
   std::printf("\n");
}

/// The least time of any mesh and order for errors of the shown quantity, and what the default
/// takes.
void print_buys(const std::vector<Run> &runs, const Problem &problem)
{
   const std::size_t q = 0;
   std::printf("cheapest for %s:", problem.quantities[q].name);
   for (double wanted : {1e-2, 1e-3, 1e-4, 1e-5})
   {
      const Run *best = nullptr;
      for (const Run &run : runs)
      {
         // Every finer run of the same kind must be as good: one lucky zero is no method.
         const bool lasting =
            std::all_of(runs.begin(), runs.end(),
                        [&](const Run &other)
                        {
                           return other.family != run.family || other.order != run.order ||
                                  other.level < run.level || other.error[q] <= wanted;
                        });
         if (lasting && (!best || run.seconds < best->seconds)) { best = &run; }
      }
      if (best)
      {
         std::printf("  %.0e %s p = %d, %.2f s;", wanted, name(best->family), best->order,
                     best->seconds);
      }
   }
   std::printf("\n");
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const char *wanted = "", *orders = "1 2 3 4", *csv = "", *picture = "";
         int levels = 3, samples = 2;
         mfem::OptionsParser args(argc, argv);
         args.AddOption(&wanted, "-problems", "--problems",
                        "Names: hertz lubkin punch strip disc lap_joint shakedown (all).");
         args.AddOption(&orders, "-orders", "--orders", "Orders of the elements.");
         args.AddOption(&levels, "-levels", "--levels", "Meshes of each kind and order.");
         args.AddOption(&samples, "-samples", "--samples",
                        "Meshes of slightly different spacing for each error.");

         args.AddOption(&csv, "-csv", "--csv", "File for the table.");
         args.AddOption(&picture, "-plot", "--plot", "File for the picture (needs --csv).");
         miniapp::parse(args);
         require(levels >= 1 && levels <= 8, "option --levels is ", levels, ", must be 1 to 8");
         require(!*picture || *csv, "option --plot needs --csv");
         std::istringstream words(wanted);
         std::vector<std::string> names;
         for (std::string word; words >> word;)
         {
            miniapp::check_choice(
               "--problems", word,
               {"hertz", "lubkin", "punch", "strip", "disc", "lap_joint", "shakedown"});
            names.push_back(word);
         }
         std::ofstream table;
         if (*csv)
         {
            table.open(csv);
            require(table.is_open(), "file '", csv, "' cannot be written");
         }
         table << "problem,title,quantity,mesh,order,level,nodes,dofs,seconds,megabytes,error,"
                  "uncertainty\n";
         const miniapp::Stopwatch watch;
         int failed = 0;
         for (const Problem &problem : problems())
         {
            if (!names.empty() &&
                std::find(names.begin(), names.end(), problem.name) == names.end())
            {
               continue;
            }
            std::printf("\n%s\n", problem.title);
            const std::vector<Reference> reference = references(problem);
            std::printf("%-8s %5s %6s %7s %8s %6s", "mesh", "order", "nodes", "dofs", "seconds",
                        "MB");
            for (const Quantity &q : problem.quantities) { std::printf(" %18s", q.name); }
            std::printf("\n");
            std::vector<Run> all;
            const auto run = [&](Family family, int order, int level)
            {
               // Edges of contact and stick lie somewhere between the nodes: errors of one mesh
               // are luck, of a few of almost the same spacing they are not.
               const int count = family == Family::standard ? 1 : samples;
               Run result;
               result.family = family;
               result.order = order;
               result.level = level;
               result.error.resize(reference.size());
               int done = 0;
               for (int k = 0; k < count; ++k)
               {
                  Resolution r = resolution(problem, family, order, level);
                  r.spacing /= 1 + 0.4 * k / count;
                  const Measured m = measured(problem, r);
                  if (!m.ok)
                  {
                     ++failed;
                     std::printf("(a %s mesh of order %d is left out)\n", name(family), order);
                     continue;
                  }
                  ++done;
                  result.nodes += m.values[0];
                  result.dofs += m.values[1];
                  result.seconds += m.cpu;
                  result.megabytes = std::max(result.megabytes, m.megabytes);
                  for (std::size_t q = 0; q < reference.size(); ++q)
                  {
                     result.error[q] += std::pow(m.values[2 + q] - reference[q].value, 2);
                  }
               }
               for (double *sum : {&result.nodes, &result.dofs, &result.seconds})
               {
                  *sum /= done;
               }

               std::printf("%-8s %5d %6.0f %7.0f %8.3f %6.0f", name(family), order,
                           result.nodes, result.dofs, result.seconds, result.megabytes);
               for (std::size_t q = 0; q < reference.size(); ++q)
               {
                  const Quantity &quantity = problem.quantities[q];
                  const double scale =
                     quantity.scale > 0 ? quantity.scale : std::abs(reference[q].value);
                  double &error = result.error[q];
                  error = std::sqrt(error / done) / scale;
                  const bool resolved = !within(reference[q], quantity, error);

                  std::printf(" %10s%8.1e", resolved ? "" : "<",
                              resolved ? error : reference[q].uncertainty / scale);
                  table << problem.name << ",\"" << problem.title << "\",\"" << quantity.name
                        << "\"," << name(family) << "," << order << "," << level << ","
                        << result.nodes << "," << result.dofs << "," << result.seconds << ","
                        << result.megabytes << "," << error << ","
                        << reference[q].uncertainty / scale << std::endl;
               }
               std::printf("\n");
               std::fflush(stdout);
               all.push_back(result);
               return result;
            };
            if (problem.standard) { run(Family::standard, 2, 0); }
            for (Family family : {Family::uniform, Family::graded, Family::nested})
            {
               if (family == Family::nested && !problem.nested) { continue; }
               for (double order : miniapp::numbers("--orders", orders))
               {
                  std::vector<Run> runs;
                  for (int level = 0; level < levels; ++level)
                  {
                     runs.push_back(run(family, static_cast<int>(order), level));
                  }
                  print_rates(runs, problem, reference);
               }
            }
            print_buys(all, problem);
         }
         std::printf("\n%.0f s in all\n", watch.seconds());
         table.close();
         require(!*csv || !table.fail(), "file '", csv, "' cannot be written");
         require(!*picture || miniapp::run_plot_script("work_precision.py", {csv, picture}),
                 "the picture '", picture, "' could not be drawn");
         if (failed) { std::printf("%d runs failed\n", failed); }
         return failed ? 2 : 0;
      });
}
