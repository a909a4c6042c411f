#include "elastic_support.hpp"

namespace
{

using namespace cattaneo;
using namespace support;

/// Two blocks on either side of an interface y = y0(x), as separate meshes and as one.
struct TwoBlocks
{
   mfem::Mesh upper, lower, merged;

   explicit TwoBlocks(bool curved, const std::vector<double> &x = uniform(0, 2, 5))
      : upper(rectangle_mesh(x, uniform(0, 1, 3))),
        lower(rectangle_mesh(x, uniform(-1.5, 0, 4))),
        merged(rectangle_mesh(x, joined({uniform(-1.5, 0, 4), uniform(0, 1, 3)})))
   {
      for (int e = 0; e < merged.GetNE(); ++e)
      {
         mfem::Vector centre(2);
         merged.GetElementCenter(e, centre);
         merged.SetAttribute(e, centre(1) > 0 ? 1 : 2);
      }
      merged.SetAttributes();
      for (mfem::Mesh *mesh : {&upper, &lower, &merged})
      {
         if (!curved) { break; }
         mesh->SetCurvature(2);
         mesh->Transform(
            [](const mfem::Vector &in, mfem::Vector &out)
            {
               out.SetSize(2);
               out(0) = in(0) + 0.1 * in(1);
               out(1) = in(1) + 0.15 * std::sin(2 * in(0));
            });
      }
   }
};

const Material hard{3.0, 0.2}, soft{1.0, 0.35};

/// True dof of another body's node at the same place.
int at(const ElasticBody &body, double x, double y, int component)
{
   const mfem::DenseMatrix &nodes = body.node_coordinates();
   for (int i = 0; i < nodes.Width(); ++i)
   {
      if (std::hypot(nodes(0, i) - x, nodes(1, i) - y) < 1e-9)
      {
         return body.true_dof(i, component);
      }
   }
   ADD_FAILURE() << "no node at " << x << ", " << y;
   return 0;
}

/// Merged dof of each dof of a body.
std::vector<int> embedding(const ElasticBody &body, const ElasticBody &merged)
{
   std::vector<int> map(body.stiffness().Height());
   const mfem::DenseMatrix &nodes = body.node_coordinates();
   for (int i = 0; i < nodes.Width(); ++i)
   {
      for (int c = 0; c < 2; ++c)
      {
         map[body.true_dof(i, c)] = at(merged, nodes(0, i), nodes(1, i), c);
      }
   }
   return map;
}

class Union : public testing::TestWithParam<std::tuple<bool, int, bool>>
{
};

/// Bonded, and with an imposed relative displacement, against the merged mesh solved directly.
TEST_P(Union, AgreesWithTheMergedMesh)
{
   const auto [curved, order, free_upper] = GetParam();
   TwoBlocks mesh(curved);
   ElasticBody upper(mesh.upper, order, hard), lower(mesh.lower, order, soft),
      merged(mesh.merged, order, {hard, soft});
   lower.fix(1, 0);
   lower.fix(1, 1);
   upper.add_pressure("press", {{3}, 0, 0.35, 1.4}, [](double x, double) { return 1 + x; });
   upper.add_traction("drag", 3, 0.3, 0.1);
   upper.add_body_force("weight", 0.0, -1.0);
   lower.add_body_force("weight", 0.1, -2.0);
   lower.add_traction("side", 2, -0.2, 0.3);
   if (!free_upper)
   {
      // Upper edge coordinates move with the curve: take the whole top, which has no contact
      // node.
      upper.add_displacement("lift", 3, 1, 0.4);
   }
   Reduction reduction = [&]
   {
      const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
      return reduce(condense(upper, line1), condense(lower, line2), pair_lines(line1, line2));
   }();
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   EXPECT_EQ(reduction.counters.unions, 1);
   EXPECT_EQ(reduction.counters.factorisations, 2);
   EXPECT_EQ(reduction.counters.assemblies, 2);
   EXPECT_EQ(reduction.bodies[0].rigid_modes, free_upper ? 3 : 1);
   EXPECT_LT(problem.gap.cwiseAbs().maxCoeff(), 1e-14);

   const Eigen::Index n = problem.nodes();
   const ContactLine &line = reduction.bodies[0].line;
   const std::vector<int> from1 = embedding(upper, merged), from2 = embedding(lower, merged);
   const MatrixXd K1 = dense(upper.stiffness()), K2 = dense(lower.stiffness());
   MatrixXd K = MatrixXd::Zero(merged.stiffness().Height(), merged.stiffness().Height());
   K(from1, from1) += K1;
   K(from2, from2) += K2;
   EXPECT_LT(difference(K, dense(merged.stiffness())), 1e-13);

   std::mt19937 random(3);
   std::uniform_real_distribution<double> number(-1, 1);
   for (bool bonded : {true, false})
   {
      VectorXd v = VectorXd::Zero(n), w = v, multipliers(problem.patterns.size());
      for (double &x : multipliers) { x = number(random); }
      for (Eigen::Index i = 0; i < n && !bonded; ++i)
      {
         v[i] = number(random);
         w[i] = number(random);
      }
      // Directly: body 1 is displaced by U + jump, body 2 by U.
      VectorXd F1 = VectorXd::Zero(K1.rows()), F2 = VectorXd::Zero(K2.rows()), jump = F1;
      VectorXd F = VectorXd::Zero(K.rows()), U = F;
      std::vector<bool> held(K.rows(), false);
      for (std::size_t k = 0; k < problem.patterns.size(); ++k)
      {
         for (const ElasticBody *body : {&upper, &lower})
         {
            for (const auto &pattern : body->patterns())
            {
               if (pattern.name != problem.patterns[k].name) { continue; }
               const VectorXd values = multipliers[k] * pattern.values;
               const bool first = body == &upper;
               if (pattern.control == Control::force) { (first ? F1 : F2) += values; }
               else
               {
                  for (int dof : body->essential_dofs())
                  {
                     U[(first ? from1 : from2)[dof]] += values[dof];
                  }
               }
            }
         }
      }
      for (int dof : upper.essential_dofs()) { held[from1[dof]] = true; }
      for (int dof : lower.essential_dofs()) { held[from2[dof]] = true; }
      for (Eigen::Index i = 0; i < n; ++i)
      {
         for (int c = 0; c < 2; ++c)
         {
            jump[line.nodes[i].dofs[c]] =
               v[i] * line.nodes[i].tangent[c] + w[i] * line.nodes[i].normal()[c];
         }
      }
      const VectorXd G1 = F1 - K1 * jump;
      for (int i = 0; i < F1.size(); ++i) { F[from1[i]] += G1[i]; }
      for (int i = 0; i < F2.size(); ++i) { F[from2[i]] += F2[i]; }
      std::vector<int> loose, tied;
      for (int i = 0; i < K.rows(); ++i) { (held[i] ? tied : loose).push_back(i); }
      const VectorXd rhs = VectorXd(F(loose)) - K(loose, tied) * VectorXd(U(tied));
      const VectorXd solution = K(loose, loose).ldlt().solve(rhs);
      U(loose) = solution;
      const VectorXd U1 = VectorXd(U(from1)) + jump, U2 = U(from2);

      EXPECT_LT(difference(reduction.displacement(0, v, w, multipliers), U1), 1e-11);
      EXPECT_LT(difference(reduction.displacement(1, v, w, multipliers), U2), 1e-11);

      // Contact forces on body 1, from the direct solution, against q = A v + Bᵀ w + …
      const VectorXd residual = K1 * U1 - F1;
      VectorXd direct(2 * n), u(2 * n);
      u << v, w;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const Eigen::RowVector2d f(residual[line.nodes[i].dofs[0]],
                                    residual[line.nodes[i].dofs[1]]);
         direct[i] = f.dot(line.nodes[i].tangent);
         direct[n + i] = f.dot(line.nodes[i].normal());
      }
      EXPECT_LT(difference(problem.K * u + problem.clamped_forces(multipliers), direct), 1e-11);

      // Conjugates of the loads through H.
      const VectorXd R = K * U - F; // at tied dofs: reactions, as U holds no jump there
      for (std::size_t k = 0; k < problem.patterns.size(); ++k)
      {
         VectorXd f(2 * n);
         f << problem.patterns[k].q, problem.patterns[k].p;
         double conjugate = 0.0;
         for (const ElasticBody *body : {&upper, &lower})
         {
            for (const auto &pattern : body->patterns())
            {
               if (pattern.name != problem.patterns[k].name) { continue; }
               const VectorXd values = pattern.values;
               const bool first = body == &upper;
               if (pattern.control == Control::force)
               {
                  conjugate += values.dot(first ? U1 : U2);
               }
               else
               {
                  for (int dof : body->essential_dofs())
                  {
                     conjugate += values[dof] * R[(first ? from1 : from2)[dof]];
                  }
               }
            }
         }
         const double sign = problem.patterns[k].control == Control::force ? -1 : 1;
         EXPECT_NEAR(conjugate, problem.H.row(k).dot(multipliers) + sign * f.dot(u),
                     1e-11 * U.cwiseAbs().maxCoeff() * F.cwiseAbs().sum())
            << problem.patterns[k].name;
      }
   }
   EXPECT_EQ(reduction.counters.field_recoveries, 4);
   EXPECT_EQ(reduction.bodies[0].counters.field_recoveries, 2);
}

INSTANTIATE_TEST_SUITE_P(Blocks, Union,
                         testing::Combine(testing::Bool(), testing::Values(1, 2, 3),
                                          testing::Bool()));

TEST(Reduction, EqualHalfPlanesAreUncoupledAndFactoredOnce)
{
   // The contact patch is a small part of a large, graded block.
   const std::vector<double> right = graded(1, 1e4, 0.1, 1.6);
   std::vector<double> left;
   for (auto x = right.rbegin(); x != right.rend(); ++x) { left.push_back(-*x); }
   mfem::Mesh upper = rectangle_mesh(joined({left, graded_to_ends(1, 16, 0.2), right}),
                                     graded(0, 1e4, 0.02, 1.5)),
              lower(upper);
   rotate(lower, M_PI);
   ElasticBody body1(upper, 1, Material{1.0, 0.3}), body2(lower, 1, Material{1.0, 0.3});
   const ContactLine line1 = contact_line(body1, {{1}, 0, -1, 1});
   const ContactLine line2 = contact_line(body2, {{1}, 0, -1, 1});
   ASSERT_EQ(line1.size(), 17);
   for (ElasticBody *body : {&body1, &body2})
   {
      body->fix(3, 0);
      body->fix(3, 1);
   }
   CondensedBody first = condense(body1, line1);
   CondensedBody second = condense(body2, line2, {}, &first);
   const double coupling = first.S.bottomLeftCorner(17, 17).cwiseAbs().maxCoeff();
   const Reduction reduction =
      reduce(std::move(first), std::move(second), pair_lines(line1, line2));
   EXPECT_EQ(reduction.counters.factorisations, 1);
   EXPECT_EQ(reduction.counters.assemblies, 2);
   EXPECT_GT(coupling, 0.05); // either body alone is coupled
   EXPECT_LT(reduction.problem.B().cwiseAbs().maxCoeff(),
             1e-12 * reduction.problem.A().cwiseAbs().maxCoeff());
   reduction.problem.validate();
}

TEST(Reduction, WhichBodyIsTheFirstChangesNothing)
{
   for (bool curved : {false, true})
   {
      TwoBlocks mesh(curved);
      ElasticBody upper(mesh.upper, 2, hard), lower(mesh.lower, 2, soft);
      lower.fix(1, 0);
      lower.fix(1, 1);
      upper.add_pressure("press", 3, 1.0);
      lower.add_displacement("push", 1, 0, [](double x, double) { return 0.1 * x * x; });
      const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
      const Reduction a =
         reduce(condense(upper, line1), condense(lower, line2), pair_lines(line1, line2));
      const Reduction b =
         reduce(condense(lower, line2), condense(upper, line1), pair_lines(line2, line1));
      // The other body's line runs the other way; forces on both are equal in their own frames.
      const Eigen::Index n = a.problem.nodes();
      ASSERT_EQ(b.problem.nodes(), n);
      EXPECT_LT(difference(b.problem.A().reverse(), a.problem.A()), 1e-11);
      EXPECT_LT(difference(b.problem.B().reverse(), a.problem.B()), 1e-11);
      EXPECT_LT(difference(b.problem.C().reverse(), a.problem.C()), 1e-11);
      for (const char *name : {"press", "push"})
      {
         const LoadPattern &pa = a.problem.patterns[a.problem.pattern(name)];
         const LoadPattern &pb = b.problem.patterns[b.problem.pattern(name)];
         EXPECT_LT(difference(pb.q.reverse(), pa.q), 1e-11);
         EXPECT_LT(difference(pb.p.reverse(), pa.p), 1e-11);
      }
      const int ka = a.problem.pattern("press"), kb = b.problem.pattern("press");
      const int la = a.problem.pattern("push"), lb = b.problem.pattern("push");
      EXPECT_NEAR(b.problem.H(kb, lb), a.problem.H(ka, la),
                  1e-11 * std::abs(a.problem.H(ka, la)));
      EXPECT_NEAR(b.problem.H(kb, kb), a.problem.H(ka, ka), 1e-11 * a.problem.H(ka, ka));
      EXPECT_EQ(a.problem.dofs(0, 0), b.problem.dofs(n - 1, 2));
   }
}

TEST(Reduction, RotationOfBothBodiesChangesNothing)
{
   const auto reduced = [](double angle)
   {
      TwoBlocks mesh(false);
      rotate(mesh.upper, angle);
      rotate(mesh.lower, angle);
      ElasticBody upper(mesh.upper, 2, hard), lower(mesh.lower, 2, soft);
      lower.fix(1, 0);
      lower.fix(1, 1);
      upper.add_pressure("press", 3, 1.0);
      upper.add_traction("drag", 3, std::cos(angle), std::sin(angle));
      const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
      return reduce(condense(upper, line1), condense(lower, line2), pair_lines(line1, line2));
   };
   const Reduction reference = reduced(0.0);
   for (double angle : {0.3, -1.2, 2.0, M_PI})
   {
      const Reduction turned = reduced(angle);
      EXPECT_LT(difference(turned.problem.K, reference.problem.K), 1e-11);
      EXPECT_LT(difference(turned.problem.clamped_forces(Eigen::Vector2d(1, 1)),
                           reference.problem.clamped_forces(Eigen::Vector2d(1, 1))),
                1e-11);
      EXPECT_LT(difference(turned.problem.H, reference.problem.H), 1e-11);
   }
}

TEST(Reduction, TwoFreeBodiesNeedLoadsInEquilibrium)
{
   TwoBlocks mesh(false);
   const auto pressed = [&mesh](double below)
   {
      ElasticBody upper(mesh.upper, 2, hard), lower(mesh.lower, 2, soft);
      upper.add_pressure("press", 3, 1.0);
      lower.add_pressure("press", 1, below);
      const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
      return reduce(condense(upper, line1), condense(lower, line2), pair_lines(line1, line2));
   };
   expect_input_error([&] { pressed(0.9); }, "common rigid motion");
   Reduction reduction = pressed(1.0);
   const ReducedProblem &problem = reduction.problem;
   const Eigen::Index n = problem.nodes();
   // Bonded: the load passes through, and the displacements agree on the interface.
   EXPECT_NEAR(problem.patterns[0].p.sum(), 2.0, 1e-11);
   EXPECT_NEAR(problem.patterns[0].q.sum(), 0.0, 1e-11);
   const VectorXd zero = VectorXd::Zero(n), one = VectorXd::Ones(1);
   const VectorXd U1 = reduction.displacement(0, zero, zero, one);
   const VectorXd U2 = reduction.displacement(1, zero, zero, one);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      for (int c = 0; c < 2; ++c)
      {
         EXPECT_NEAR(U1[problem.dofs(i, c)], U2[problem.dofs(i, 2 + c)], 1e-12);
      }
   }
   // Relative rigid motions cost nothing.
   const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(problem.K);
   const double largest = modes.eigenvalues().tail(1)[0];
   EXPECT_LT(modes.eigenvalues().head(3).cwiseAbs().maxCoeff(), 1e-12 * largest);
   EXPECT_GT(modes.eigenvalues()[3], 1e-4 * largest);
}

TEST(Reduction, CarriesTheLineOfItsFirstBody)
{
   // Simpson's weights of unequal quadratic edges, which are not the tributary lengths.
   mfem::Mesh up = rectangle_mesh({0, 1, 4}, {0, 1}), down = rectangle_mesh({0, 1, 4}, {-1, 0});
   ElasticBody upper(up, 2, Material{}), lower(down, 2, Material{});
   lower.fix(1, 0);
   lower.fix(1, 1);
   const CondensedBody a = condense(upper, contact_line(upper, 1)),
                       b = condense(lower, contact_line(lower, 3));
   for (const bool pair : {false, true})
   {
      const Reduction reduction = pair ? reduce(a, b, pair_lines(a.line, b.line)) : reduce(a);
      const ReducedProblem &problem = reduction.problem;
      const double x[] = {0, 0.5, 1, 2.5, 4}, weight[] = {1, 4, 4, 12, 3}; // sixths
      ASSERT_EQ(problem.nodes(), 5);
      for (int i = 0; i < 5; ++i)
      {
         EXPECT_NEAR(problem.weights[i], weight[i] / 6, 1e-14);
         EXPECT_NEAR(problem.arc_length[i], x[i], 1e-14);
         EXPECT_NEAR(problem.position(i, 0), x[i], 1e-14);
         EXPECT_NEAR(problem.position(i, 1), 0, 1e-14);
         EXPECT_EQ(problem.gap[i], 0);
         EXPECT_EQ(problem.friction[i], 0);
      }
   }
   // Bodies that look the same way cannot touch, whatever the pairing says.
   Pairing wrong = pair_lines(a.line, b.line);
   for (int i = 0; i < 5; ++i) { wrong.partner[i] = i; }
   expect_input_error([&] { reduce(a, a, wrong); },
                      "the bodies do not face each other at the contact node (0, 0)");
}

TEST(Reduction, OneBodyOnARigidObstacle)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 2, Material{});
   body.add_pressure("press", 3, 1.0);
   const CondensedBody condensed = condense(body, contact_line(body, 1));
   Reduction reduction = reduce(condensed, [](double x, double) { return 0.1 * x * x; });
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   EXPECT_EQ(difference(problem.K, condensed.S), 0.0);
   EXPECT_EQ(problem.nodes(), 9);
   EXPECT_DOUBLE_EQ(problem.gap[8], 0.4);
   EXPECT_NEAR(problem.weights.sum(), 2.0, 1e-14);
   EXPECT_NEAR(problem.patterns[0].p.sum(), 2.0, 1e-11);
   EXPECT_EQ(problem.dofs.cols(), 2);
   EXPECT_EQ(reduction.counters.unions, 0);
   EXPECT_EQ(reduction.counters.field_recoveries, 0);
   const VectorXd v = VectorXd::LinSpaced(9, 0, 1), w = VectorXd::LinSpaced(9, 1, 2);
   const VectorXd U = reduction.displacement(0, v, w, VectorXd::Zero(1));
   for (int i = 0; i < 9; ++i)
   {
      EXPECT_EQ(U(problem.dofs(i, 0)), v[i]);
      EXPECT_EQ(U(problem.dofs(i, 1)), w[i]);
   }
   EXPECT_EQ(reduction.counters.field_recoveries, 1);
   expect_input_error([&] { reduction.displacement(1, v, w, VectorXd::Zero(1)); }, "body 1");
   expect_input_error([&] { reduction.displacement(0, v.head(3), w, VectorXd::Zero(1)); },
                      "3 tangential");
   expect_input_error([&] { reduction.displacement(0, v, w, VectorXd::Zero(2)); },
                      "2 load multipliers");
   expect_input_error([&] { reduce(condensed, [](double, double) { return std::nan(""); }); },
                      "the gap at");
}

TEST(Reduction, RefusesAPatternOfTwoKinds)
{
   TwoBlocks mesh(false);
   ElasticBody upper(mesh.upper, 1, hard), lower(mesh.lower, 1, soft);
   upper.add_pressure("load", 3, 1.0);
   lower.add_displacement("load", 1, 1, 0.1);
   const ContactLine line1 = contact_line(upper, 1), line2 = contact_line(lower, 3);
   expect_input_error(
      [&] { reduce(condense(upper, line1), condense(lower, line2), pair_lines(line1, line2)); },
      "controlled by force in one body");
   Pairing wrong = pair_lines(line1, line2);
   wrong.partner[0] = wrong.partner[1];
   ElasticBody plain(mesh.lower, 1, soft);
   expect_input_error([&] { reduce(condense(upper, line1), condense(plain, line2), wrong); },
                      "once");
}

} // namespace
