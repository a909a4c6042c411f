// A rigid obstacle that moves is a pattern of displacements.
#include "elastic_support.hpp"
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/friction/march.hpp>

namespace
{

using namespace cattaneo;
using namespace support;

/// Down, aside and a turn about (0.3, 0.2): by the top of the block, or by the obstacle from
/// the other side.
const std::vector<std::string> motions = {"down", "aside", "turn"};

Reduction moved(ElasticBody &body, bool by_obstacle)
{
   const auto turn_x = [](double, double y) { return 0.2 - y; };
   const auto turn_y = [](double x, double) { return x - 0.3; };
   if (by_obstacle)
   {
      body.fix(3, 0);
      body.fix(3, 1);
      Reduction reduction = reduce(condense(body, contact_line(body, 1)));
      reduction.add_obstacle_motion("down", 0.0, 1.0);
      reduction.add_obstacle_motion("aside", -1.0, 0.0);
      reduction.add_obstacle_motion(
         "turn", [=](double x, double y) { return -turn_x(x, y); },
         [=](double x, double y) { return -turn_y(x, y); });
      return reduction;
   }
   body.add_displacement("down", 3, 0, 0.0);
   body.add_displacement("down", 3, 1, -1.0);
   body.add_displacement("aside", 3, 0, 1.0);
   body.add_displacement("aside", 3, 1, 0.0);
   body.add_displacement("turn", 3, 0, turn_x);
   body.add_displacement("turn", 3, 1, turn_y);
   return reduce(condense(body, contact_line(body, 1)));
}

TEST(ObstacleMotion, IsTheOppositeMotionOfTheSupport)
{
   for (const char *kind : {"quads", "triangles", "curved"})
   {
      mfem::Mesh mesh = block(kind);
      // The curved ones are cubic, and turn without strain by displacements that are.
      const int order = std::string(kind) == "curved" ? 3 : 2;
      ElasticBody body(mesh, order, Material{1.0, 0.3}), other(mesh, order, Material{1.0, 0.3});
      Reduction support = moved(body, false), obstacle = moved(other, true);
      ReducedProblem &a = support.problem, &b = obstacle.problem;
      b.validate();
      EXPECT_LT(difference(b.H, a.H), 1e-10) << kind;
      for (int k : {0, 1, 2})
      {
         EXPECT_EQ(b.patterns[k].name, motions[k]);
         EXPECT_EQ(b.patterns[k].control, Control::displacement);
         EXPECT_LT(difference(b.patterns[k].q, a.patterns[k].q), 1e-10) << kind;
         EXPECT_LT(difference(b.patterns[k].p, a.patterns[k].p), 1e-10) << kind;
      }
      // Forces, slip and loss of a history are then the same, and the body's strains.
      for (ReducedProblem *problem : {&a, &b}) { set_friction(*problem, 0.4); }
      ContactState states[2] = {ContactState::virgin(a), ContactState::virgin(b)};
      for (int k : {0, 1})
      {
         const ReducedProblem &problem = k == 0 ? a : b;
         const MarchReport report =
            march(problem,
                  LoadHistory::through(
                     problem,
                     {{}, {{"down", 0.1}}, {{"aside", 0.02}}, {{"aside", 0}, {"turn", 0.01}}}),
                  states[k]);
         EXPECT_EQ(report.status, FrictionStatus::converged);
      }
      EXPECT_LT(difference(states[1].p, states[0].p), 1e-9) << kind;
      EXPECT_LT(difference(states[1].q, states[0].q), 1e-9) << kind;
      EXPECT_LT(difference(states[1].v, states[0].v), 1e-9) << kind;
      EXPECT_NEAR(states[1].dissipation, states[0].dissipation, 1e-10) << kind;
      ASSERT_GT(states[0].dissipation, 1e-6);
      VectorXd fields[2];
      for (int k : {0, 1})
      {
         Reduction &of = k == 0 ? support : obstacle;
         fields[k] = of.displacement(0, states[k].v, states[k].w,
                                     of.problem.multipliers({{"down", 0.1}, {"turn", 0.01}}));
      }
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         // Seen from the obstacle.
         const double x = body.node_coordinates()(0, node),
                      y = body.node_coordinates()(1, node);
         const double ox = -0.01 * (0.2 - y), oy = 0.1 - 0.01 * (x - 0.3);
         const int dx = body.true_dof(node, 0), dy = body.true_dof(node, 1);
         EXPECT_NEAR(fields[1][dx] - ox, fields[0][dx], 1e-11) << kind;
         EXPECT_NEAR(fields[1][dy] - oy, fields[0][dy], 1e-11) << kind;
      }
   }
}

/// A plate on a rigid floor under another one of other nodes, whose top moves: or the floor.
Reduction stack(ElasticBody &low, ElasticBody &high, bool by_obstacle)
{
   const auto turn_x = [](double, double y) { return 0.2 - y; };
   const auto turn_y = [](double x, double) { return x - 0.3; };
   if (by_obstacle)
   {
      high.fix(3, 0);
      high.fix(3, 1);
   }
   else
   {
      high.add_displacement("down", 3, 0, 0.0);
      high.add_displacement("down", 3, 1, -1.0);
      high.add_displacement("turn", 3, 0, turn_x);
      high.add_displacement("turn", 3, 1, turn_y);
   }
   Reduction made = reduce({{"low", &low}, {"high", &high}},
                           {{"between", {1, 1}, {0, 3}}, {"floor", {0, 1}, {}}});
   if (!by_obstacle) { return made; }
   made.add_obstacle_motion("down", {{1, 0.0, 1.0}});
   made.add_obstacle_motion("turn", {{1, [=](double x, double y) { return -turn_x(x, y); },
                                      [=](double x, double y) { return -turn_y(x, y); }}});
   return made;
}

TEST(ObstacleMotion, OfAStackIsTheOppositeMotionOfItsTop)
{
   mfem::Mesh below = block("quads"), above = block("triangles", 7, 3);
   for (int v = 0; v < above.GetNV(); ++v) { above.GetVertex(v)[1] += 1; }
   ElasticBody low(below, 2, Material{1.0, 0.3}), high(above, 2, Material{2.0, 0.2}),
      other(above, 2, Material{2.0, 0.2});
   Reduction support = stack(low, high, false), obstacle = stack(low, other, true);
   ReducedProblem &a = support.problem, &b = obstacle.problem;
   b.validate();
   EXPECT_LT(difference(b.H, a.H), 1e-9);
   for (const char *name : {"down", "turn"})
   {
      const LoadPattern &one = b.patterns[b.pattern(name)], &same = a.patterns[a.pattern(name)];
      EXPECT_LT(difference(one.q, same.q), 1e-9);
      EXPECT_LT(difference(one.p, same.p), 1e-9);
   }
   // The field of the lower body: moved with the floor, and strained as under the moved top.
   const Eigen::Index n = a.nodes();
   const VectorXd u = VectorXd::LinSpaced(2 * n, -0.03, 0.07);
   const auto field = [&](Reduction &of) {
      return of.displacement(0, u.head(n), u.tail(n), of.problem.multipliers({{"down", 0.3}}));
   };
   VectorXd moved = field(obstacle);
   for (int node = 0; node < low.node_coordinates().Width(); ++node)
   {
      moved[low.true_dof(node, 1)] -= 0.3;
   }
   EXPECT_LT((moved - field(support)).cwiseAbs().maxCoeff(), 1e-10);
   expect_input_error(
      [&] {
         obstacle.add_obstacle_motion("d", {{0, 0.0, 1.0}});
      },
      "interface 'between' is between two bodies");
   expect_input_error(
      [&] {
         obstacle.add_obstacle_motion("d", {{2, 0.0, 1.0}});
      },
      "interface 2, must be 0 to 1");
   expect_input_error([&] { obstacle.add_obstacle_motion("d", 0.0, 1.0); },
                      "the reduction has 2 bodies, must have one");
}

TEST(ObstacleMotion, ConjugatesAreReactionAndDisplacementOfTheWholeBody)
{
   // g = H λ + Fᵀ u of the obstacle is its reaction, g = H λ - Fᵀ u of a force its
   // displacement: both of the assembled body, which knows of no reduction.
   mfem::Mesh mesh = block("curved");
   ElasticBody body(mesh, 2, Material{1.0, 0.3});
   body.add_pressure("P", 2, 1.0);
   body.add_displacement("stretch", 3, 0, [](double x, double) { return 0.1 * x; });
   Reduction reduction = moved(body, true);
   const ReducedProblem &problem = reduction.problem;
   const Eigen::Index n = problem.nodes();
   const VectorXd u = VectorXd::LinSpaced(2 * n, -0.3, 0.7);
   const VectorXd loads = problem.multipliers(
      {{"P", 0.4}, {"stretch", -2}, {"down", 0.3}, {"aside", 0.2}, {"turn", 0.5}});
   const VectorXd field = reduction.displacement(0, u.head(n), u.tail(n), loads);
   const VectorXd residual =
      dense(body.stiffness()) * field - 0.4 * body.patterns()[problem.pattern("P")].values;
   const VectorXd conjugate = problem.H * loads;
   const auto work = [&](const LoadPattern &pattern)
   { return pattern.q.dot(u.head(n)) + pattern.p.dot(u.tail(n)); };
   const int P = problem.pattern("P");
   EXPECT_NEAR(conjugate[P] - work(problem.patterns[P]), body.patterns()[P].values.dot(field),
               1e-11);
   const int stretch = problem.pattern("stretch");
   EXPECT_NEAR(conjugate[stretch] + work(problem.patterns[stretch]),
               body.patterns()[stretch].values.dot(residual), 1e-11);
   const auto reaction = [&](auto ux, auto uy)
   {
      double sum = 0;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double x = problem.position(i, 0), y = problem.position(i, 1);
         sum +=
            ux(x, y) * residual[problem.dofs(i, 0)] + uy(x, y) * residual[problem.dofs(i, 1)];
      }
      return sum;
   };
   const auto zero = [](double, double) { return 0.0; };
   const auto one = [](double, double) { return 1.0; };
   const std::vector<double> reactions = {reaction(zero, one), -reaction(one, zero),
                                          -reaction([](double, double y) { return 0.2 - y; },
                                                    [](double x, double) { return x - 0.3; })};
   for (std::size_t k = 0; k < 3; ++k)
   {
      const int m = problem.pattern(motions[k]);
      EXPECT_NEAR(conjugate[m] + work(problem.patterns[m]), reactions[k], 1e-11) << motions[k];
   }
}

TEST(ObstacleMotion, TurnsAboutTheAxis)
{
   mfem::Mesh mesh = block("quads");
   std::vector<Reduction> reductions;
   for (bool by_obstacle : {false, true})
   {
      ElasticBody body(mesh, 2, Material{}, Formulation::axisymmetric),
         twisting(mesh, 2, Material{}, Formulation::torsion);
      body.fix(3, 1);
      if (by_obstacle) { twisting.fix(3, 0); }
      else { twisting.add_displacement("turn", 3, 0, 1.0); }
      Reduction &reduction =
         reductions.emplace_back(reduce(condense(body, contact_line(body, 1))));
      reduction.add_torsion(condense(twisting, contact_line(twisting, 1)));
      if (by_obstacle)
      {
         reduction.add_obstacle_motion("turn", 0.0, 0.0, [](double r, double) { return -r; });
      }
   }
   const ReducedProblem &a = reductions[0].problem, &b = reductions[1].problem;
   EXPECT_LT(difference(b.patterns[0].q, a.patterns[0].q), 1e-10);
   EXPECT_LT(difference(b.H, a.H), 1e-10);
   // Twist of the body seen from the obstacle, at some slip.
   const VectorXd v = VectorXd::LinSpaced(2 * a.nodes(), 0, 0.1),
                  turn = VectorXd::Constant(1, 0.2);
   const VectorXd by_top = reductions[0].twist(0, v, turn);
   const VectorXd by_obstacle = reductions[1].twist(0, v, turn);
   EXPECT_LT(difference((by_obstacle.array() + 0.2).matrix(), by_top), 1e-10);
}

TEST(ObstacleMotion, RefusesWhatMeansNothing)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   body.fix(3, 1);
   body.fix(4, 0); // the plane of symmetry x = 0
   body.add_pressure("P", 2, 1.0);
   Reduction reduction = reduce(condense(body, contact_line(body, 1)));
   expect_input_error([&] { reduction.add_obstacle_motion("P", 0.0, 1.0); },
                      "a load pattern with this name exists already");
   expect_input_error([&] { reduction.add_obstacle_motion("d", 0.0, std::nan("")); },
                      "must be finite");
   expect_input_error([&] { reduction.add_obstacle_motion("d", 0.0, 1.0, 1.0); },
                      "without torsion");
   expect_input_error([&] { reduction.add_obstacle_motion("d", 1.0, 0.0); },
                      "along the fixed component of the node (0, 0)");
   EXPECT_EQ(reduction.problem.patterns.size(), 1u);
   reduction.add_obstacle_motion("up", 0.0, 1.0);
   reduction.problem.validate();

   mfem::Mesh lower = block("quads");
   for (int v = 0; v < lower.GetNV(); ++v) { lower.GetVertex(v)[1] -= 1; }
   ElasticBody below(lower, 1, Material{});
   below.fix(1, 0);
   below.fix(1, 1);
   const ContactLine line1 = contact_line(body, 1), line2 = contact_line(below, 3);
   Reduction two =
      reduce(condense(body, line1), condense(below, line2), pair_lines(line1, line2));
   expect_input_error([&] { two.add_obstacle_motion("d", 0.0, 1.0); },
                      "the reduction has 2 bodies, must have one");
}

} // namespace
