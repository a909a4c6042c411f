#include "common/known_problems.hpp"

#include "common/disc_scene.hpp"
#include "common/hertz_scene.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/miniapp.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"
#include "common/twisted_bodies.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cmath>

namespace known
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;

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
   case Family::block:
      return "block";
   case Family::standard:
      return "default";
   }
   return "";
}

namespace
{

const MarchSettings &exactly()
{
   static const MarchSettings settings = []
   {
      MarchSettings s;
      s.increments = 1; // states between the points are not asked for
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
   options.domain = r.domain;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = mirrored(r.grid(span, r.foci(0, span)));
   }
   miniapp::Scene scene = make_scene(options);
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
   const Zone stick = widest_zone(zones(problem, state), NodeState::stick);
   const double found = 0.5 * (stick.to.position - stick.from.position);
   answer.values.push_back(found);
   answer.values.push_back(
      miniapp::deviation(problem, state.q, f * p0,
                         [&](double s) { return f * p0 * (ellipse(s, c) - ellipse(s, 1)); })
         .mean);
   answer.edges = {found, b};
   answer.dofs = scene.dofs > 0 ? scene.dofs : static_cast<double>(problem.K.rows());
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
/// Radius, torque and stick radius are compared with those of the resulting force and rotation.
Answer lubkin(const Resolution &r)
{
   const double f = 0.3, c = 0.5;
   miniapp::TwistedBodies bodies;
   bodies.contact = r.grid(1, r.foci(0, 1));
   bodies.order = r.order;
   bodies.growth = r.element_growth();
   bodies.far = 3e3;
   const double sphere = bodies.sphere, poisson = bodies.poisson;
   miniapp::Scene scene = miniapp::make_scene(bodies);
   ReducedProblem &problem = scene.reduction.problem;
   const Index n = problem.nodes();
   const VectorXd radius = problem.position.col(0);
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
   const double stick =
      widest_zone(zones(problem, state), NodeState::stick).to.position + shift;
   const double torque = -radius.dot(state.q.tail(n)) / (f * load * a);
   Answer answer;
   answer.values = {torque / lubkin_torque(c), stick / a / c, edge / a};
   answer.edges = {stick, edge};
   answer.dofs = scene.dofs;
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
      options.grid = mirrored(r.grid(1, r.foci(0, 1, {1})));
   }
   if (r.family == Family::nested)
   {
      options.grid = mirrored(base(r, 0.5).grid(1, base(r, 0.5).foci(0, 1)));
      options.growth = base(r, 0.5).element_growth();
      options.refine = splitting(r, r.foci(-1, 1, {-1, 1}));
   }
   miniapp::Scene scene = miniapp::make_punch(options);
   ReducedProblem &problem = scene.reduction.problem;
   set_friction(problem, f);
   FrictionSolver solver(problem);
   ContactState pressed = ContactState::virgin(problem);
   follow(solver, LoadHistory::through({Vector2d(0, 0), Vector2d(1, 0)}), pressed);
   const double stick = widest_zone(zones(problem, pressed), NodeState::stick).to.position - 1;
   ContactState state = pressed;
   follow(solver, LoadHistory::through({Vector2d(1, 0), Vector2d(1, 0.5 * f)}), state);
   const double right = widest_zone(zones(problem, state), NodeState::stick).to.position - 1;
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

/// The options of a study as its miniapp has them, or discretised otherwise.
template <class Options>
void discretise(Options &options, const Resolution &r, double length,
                const std::vector<Focus> &foci)
{
   if (r.family == Family::standard) { return; }
   options.order = r.order;
   options.growth = r.element_growth();
   options.grid = r.grid(length, foci);
}

Answer strip(const Resolution &r)
{
   const double f = 0.7, n = 4;
   miniapp::RecedingOptions options;
   options.domain = r.domain;
   discretise(options, r, options.length, r.foci(0, n + 2.5));
   if (r.family == Family::nested)
   {
      options.grid = base(r, 0.5).grid(options.length, base(r, 0.5).foci(0, n + 2.5));
      options.growth = base(r, 0.5).element_growth();
      options.refine = splitting(r, r.foci(0, n + 2.5));
   }
   miniapp::Scene scene = miniapp::make_receding(options);
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
   options.domain = r.domain;
   discretise(options, r, options.disc_radius, r.foci(0, options.disc_radius));
   miniapp::Scene scene = miniapp::make_disc(options);
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
   discretise(options, r, options.protrusion, r.foci(0, 0.8));
   miniapp::Scene joint = miniapp::make_lap_joint(options);
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
                c = half(widest_zone(zones(problem, state), NodeState::stick));
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
   options.domain = r.domain;
   if (r.family != Family::standard)
   {
      options.order = r.order;
      options.growth = r.element_growth();
      options.grid = mirrored(r.grid(1, r.foci(0, 1, {1})));
   }
   miniapp::Scene scene = miniapp::make_punch(options);
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

} // namespace

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
       hertz,
       1e4},
      {"lubkin",
       "Lubkin: twisted spheres",
       {{"torque", 1, 1}, {"stick radius", 1, 1}, {"contact radius", 1, 1}},
       0.1,
       1.0 / 8,
       1,
       0,
       lubkin,
       0,
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
       0,
       true},
      {"strip",
       "Receding strip",
       {{"separation s/t", none, 1, 1.406, 0.003}, {"stick e/t", none, 1, -0.442, 0.003}},
       0.2,
       1.0 / 16,
       1,
       2,
       strip,
       1e6,
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
       disc,
       1e3},
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
       shakedown,
       1e4},
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
           {},
           family == Family::block ? problem.domain : 0};
}

Answer solve(const Problem &problem, Resolution r)
{
   const bool meets_edges = r.family != Family::uniform && r.family != Family::standard,
              finds = meets_edges && problem.finest < 1;
   if (finds) { r.edges = problem.solve(resolution(problem, Family::uniform, 2, 0)).edges; }
   return problem.solve(r);
}

} // namespace known
