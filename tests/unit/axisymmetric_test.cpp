#include "cylinders.hpp"
#include "elastic_support.hpp"
#include <cattaneo/elastic/point_stress.hpp>

// Bodies of revolution: operators, loads, contact lines, and torsion as a third block.

namespace
{

using namespace cattaneo;
using namespace support;
using cattaneo_test::cylinder;
using cattaneo_test::kinds;

template <class F>
VectorXd nodal(const ElasticBody &body, F field)
{
   VectorXd U = VectorXd::Zero(body.stiffness().Height());
   const mfem::DenseMatrix &x = body.node_coordinates();
   for (int node = 0; node < x.Width(); ++node)
   {
      for (int c = 0; c < body.components(); ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0) { U[dof] = field(x(0, node), x(1, node), c); }
      }
   }
   return U;
}

/// Largest |K U - F| at dofs that the axis does not hold, relative to the largest |F|.
double imbalance(const ElasticBody &body, const VectorXd &U, double scale = 0.0)
{
   VectorXd residual = dense(body.stiffness()) * U;
   for (const BodyLoad &pattern : body.patterns())
   {
      residual -= pattern.values;
      scale = std::max(scale, pattern.values.cwiseAbs().maxCoeff());
   }
   for (int dof : body.essential_dofs()) { residual[dof] = 0; }
   return residual.cwiseAbs().maxCoeff() / scale;
}

TEST(Axisymmetric, PassesThePatchTests)
{
   const Material material{2.0, 0.3};
   const double lambda = material.lambda(), mu = material.mu();
   for (const char *kind : kinds)
   {
      mfem::Mesh mesh = cylinder(kind);
      for (int order : {1, 2, 3})
      {
         if (kind == std::string("curved") && order < 2) { continue; }
         const auto body = [&]
         { return ElasticBody(mesh, order, material, Formulation::axisymmetric); };
         ElasticBody pressed = body();
         pressed.add_pressure("p", BoundaryPart({1, 2, 3}), 1.0);
         const double compression = 1 / (3 * lambda + 2 * mu);
         EXPECT_LT(imbalance(pressed, nodal(pressed, [&](double r, double z, int c)
                                            { return -compression * (c == 0 ? r : z); })),
                   1e-11)
            << kind << order;

         // u_r = r, u_z = z/2: two states of uniform stress in one.
         ElasticBody expanded = body();
         const double spherical = lambda * 2.5;
         const double radial = spherical + 2 * mu, axial = spherical + mu;
         expanded.add_traction("t", 2, radial, 0.0);
         expanded.add_traction("t", 3, 0.0, axial);
         expanded.add_traction("t", 1, 0.0, -axial);
         EXPECT_LT(imbalance(expanded, nodal(expanded, [](double r, double z, int c)
                                             { return c == 0 ? r : 0.5 * z; })),
                   1e-11)
            << kind << order;
         const Stress s = stress(material, Strain{1.0, 0.5, 1.0, 0.0});
         EXPECT_NEAR(s.xx, radial, 1e-14);
         EXPECT_NEAR(s.yy, axial, 1e-14);
         EXPECT_NEAR(s.zz, radial, 1e-14);

         ElasticBody lifted = body();
         EXPECT_LT(
            imbalance(lifted,
                      nodal(lifted, [](double, double, int c) { return c == 1 ? 1 : 0; }),
                      lifted.stiffness().MaxNorm()),
            1e-13);
      }
   }
}

TEST(Torsion, PassesThePatchTests)
{
   const Material material{2.6, 0.3}; // G = 1
   for (const char *kind : kinds)
   {
      mfem::Mesh mesh = cylinder(kind);
      for (int order : {1, 2, 3})
      {
         if (kind == std::string("curved") && order < 2) { continue; }
         ElasticBody body(mesh, order, material, Formulation::torsion);
         EXPECT_EQ(body.stiffness().Height(), body.node_coordinates().Width());
         EXPECT_EQ(body.essential_dofs().Size(), 0);
         EXPECT_LT(imbalance(body, nodal(body, [](double, double, int) { return 1; }),
                             body.stiffness().MaxNorm()),
                   1e-13);
         // A twisted bar: u_θ = r z, τ_θz = G r; torque G π R⁴/2.
         const auto linear = [](double r, double) { return r; };
         body.add_traction("t", 3, linear);
         EXPECT_NEAR(body.patterns()[0].values.sum(), 0.5 * M_PI * 16, 1e-12);
         body.add_traction("t", 1, [](double r, double) { return -r; });
         EXPECT_LT(imbalance(body, nodal(body, [](double, double z, int) { return z; })), 1e-11)
            << kind << order;
      }
   }
}

/// Lamé's cylinder 1 < r < 2 under inner pressure, held between planes.
TEST(Axisymmetric, ThickWalledCylinderConvergesAtTheElementsRate)
{
   const double E = 1.0, nu = 0.3, a = 1, b = 2;
   const double k = (1 + nu) / E * a * a / (b * b - a * a);
   const double inner = k * ((1 - 2 * nu) * a + b * b / a);
   const double work = 2 * M_PI * a * inner; // p × area × displacement, height 1
   for (int order : {1, 2, 3})
   {
      double before = 0;
      for (int elements : {4, 8, 16})
      {
         mfem::Mesh mesh = rectangle_mesh(uniform(a, b, elements), uniform(0, 1, 1));
         ElasticBody body(mesh, order, {E, nu}, Formulation::axisymmetric);
         body.add_pressure("p", 4, 1.0);
         for (int face : {1, 3}) { body.fix(face, 1); }
         MatrixXd K = dense(body.stiffness());
         VectorXd F = body.patterns()[0].values;
         for (int dof : body.essential_dofs())
         {
            K.row(dof).setZero();
            K.col(dof).setZero();
            K(dof, dof) = 1;
            F[dof] = 0;
         }
         // The energy is short by the square of the error's energy norm.
         const double error = 1 - F.dot(K.llt().solve(F)) / work;
         EXPECT_GT(error, 0);
         if (elements == 16)
         {
            EXPECT_NEAR(std::log2(before / error), 2 * order, 0.15) << order;
         }
         before = error;
      }
   }
}

TEST(Axisymmetric, PartialLoadsAreExact)
{
   for (const char *kind : {"quads", "triangles"})
   {
      mfem::Mesh mesh = cylinder(kind);
      for (int order : {1, 2, 4})
      {
         const double a = 0.7321;
         const BoundaryPart top({3}, 0, 0, a);
         ElasticBody body(mesh, order, Material{}, Formulation::axisymmetric);
         body.add_pressure("p", top, 2.0);
         body.add_body_force("weight", 0.0, -1.0);
         const VectorXd up =
            nodal(body, [](double, double, int c) { return c == 1 ? 1.0 : 0.0; });
         const ElasticBody::Extent disc = body.extent(top);
         EXPECT_NEAR(disc.size, M_PI * a * a, 1e-13);
         EXPECT_NEAR(disc.middle[0], 2 * a / 3, 1e-13);
         EXPECT_NEAR(up.dot(body.patterns()[0].values), -2 * M_PI * a * a, 1e-13);
         EXPECT_NEAR(up.dot(body.patterns()[1].values), -4 * M_PI, 1e-12);
         const VectorXd tilt =
            nodal(body, [](double r, double, int c) { return c == 1 ? r : 0.0; });
         EXPECT_NEAR(tilt.dot(body.patterns()[0].values), -4 * M_PI * a * a * a / 3, 1e-13);
         ElasticBody twisted(mesh, order, Material{}, Formulation::torsion);
         twisted.add_traction("t", top, [](double r, double) { return 1 + r; });
         EXPECT_NEAR(twisted.patterns()[0].values.sum(),
                     2 * M_PI * (std::pow(a, 3) / 3 + std::pow(a, 4) / 4), 1e-13);
      }
   }
}

TEST(Axisymmetric, ContactLineWeighsAreasAndLeavesTheAxisOut)
{
   for (const char *kind : {"quads", "triangles", "curved"})
   {
      mfem::Mesh mesh = cylinder(kind);
      for (int order : {1, 2, 3})
      {
         ElasticBody body(mesh, order, Material{}, Formulation::axisymmetric);
         for (int attribute : {1, 3})
         {
            const ContactLine line = contact_line(body, attribute);
            EXPECT_EQ(line.size(), 4 * order);
            EXPECT_GT(line.each(&LineNode::position).col(0).minCoeff(), 0);
            EXPECT_NEAR(line.each(&LineNode::weight).sum(), 4 * M_PI, 1e-13);
            EXPECT_NEAR(line.each(&LineNode::weight).dot(line.each(&LineNode::position).col(0)),
                        2 * M_PI * 8 / 3.0,
                        order == 1 ? 0.2 : 1e-13); // the axis node's share sits at r = 1/2
            const double sign = attribute == 1 ? 1 : -1;
            EXPECT_NEAR((line.each(&LineNode::normal).col(1).array() - sign).abs().maxCoeff(),
                        0, 1e-14);
            for (Eigen::Index i = 0; i < line.size(); ++i)
            {
               const double r = line.nodes[i].position[0];
               EXPECT_NEAR(line.nodes[i].arc_length, attribute == 1 ? r : 2 - r, 1e-14);
            }
         }
         ElasticBody torsion(mesh, order, Material{}, Formulation::torsion);
         EXPECT_EQ(contact_line(torsion, 1).nodes[0].dofs[1], -1);
         expect_input_error([&] { contact_line(body, 4); },
                            "is the only one, and lies on the axis");
      }
   }
}

/// Two rings, one on the other, against both as one body with the same nodes.
struct Rings
{
   mfem::Mesh lower = rectangle_mesh(uniform(1, 2, 3), uniform(-1, 0, 3));
   mfem::Mesh upper = rectangle_mesh(uniform(1, 2, 3), uniform(0, 0.7, 2));
   mfem::Mesh both =
      rectangle_mesh(uniform(1, 2, 3), joined({uniform(-1, 0, 3), uniform(0, 0.7, 2)}));
   int order = 2;
   Material material{1.7, 0.3};

   ElasticBody body(mfem::Mesh &mesh, Formulation formulation, bool held, bool loaded) const
   {
      ElasticBody result(mesh, order, material, formulation);
      if (held)
      {
         for (int c = 0; c < result.components(); ++c) { result.fix(1, c); }
      }
      if (loaded && formulation == Formulation::axisymmetric)
      {
         result.add_pressure("p", BoundaryPart({3}, 0, 1.0, 1.4), 1.0);
      }
      if (loaded && formulation == Formulation::torsion)
      {
         result.add_traction("torque", 3, [](double r, double) { return r * r; });
      }
      return result;
   }

   Reduction reduction(bool torsion)
   {
      const ElasticBody top = body(upper, Formulation::axisymmetric, false, true),
                        bottom = body(lower, Formulation::axisymmetric, true, false);
      const ContactLine above = contact_line(top, 1), below = contact_line(bottom, 3);
      Reduction result =
         reduce(condense(top, above), condense(bottom, below), pair_lines(above, below));
      if (torsion)
      {
         const ElasticBody t = body(upper, Formulation::torsion, false, true),
                           b = body(lower, Formulation::torsion, true, false);
         result.add_torsion(condense(t, contact_line(t, 1)), condense(b, contact_line(b, 3)));
      }
      return result;
   }
};

VectorXd solved(const ElasticBody &body)
{
   MatrixXd K = dense(body.stiffness());
   VectorXd F = body.patterns()[0].values;
   for (int dof : body.essential_dofs())
   {
      K.row(dof).setZero();
      K.col(dof).setZero();
      K(dof, dof) = 1;
      F[dof] = 0;
   }
   return K.llt().solve(F);
}

TEST(Torsion, JoinsTheReducedProblemAsAThirdBlock)
{
   Rings stack;
   Reduction plain = stack.reduction(false), joined = stack.reduction(true);
   EXPECT_EQ(plain.problem.components(), 1);
   ReducedProblem &problem = joined.problem;
   problem.validate();
   const Eigen::Index n = problem.nodes();
   ASSERT_EQ(problem.components(), 2);
   EXPECT_EQ(problem.A().topLeftCorner(n, n), plain.problem.A());
   EXPECT_EQ(problem.B().leftCols(n), plain.problem.B());
   EXPECT_EQ(problem.C(), plain.problem.C());
   EXPECT_EQ(problem.A().topRightCorner(n, n).norm(), 0);
   EXPECT_EQ(problem.B().rightCols(n).norm(), 0);
   ASSERT_EQ(problem.patterns.size(), 2u);
   EXPECT_EQ(problem.patterns[0].q.tail(n).norm(), 0);
   EXPECT_EQ(problem.patterns[1].q.head(n).norm(), 0);
   EXPECT_EQ(problem.patterns[1].p.norm(), 0);
   // What a scene does not need is not built: half of everything.
   EXPECT_EQ(plain.counters.assemblies, 2);
   EXPECT_EQ(plain.counters.factorisations, 2);
   EXPECT_EQ(plain.counters.unions, 1);
   EXPECT_EQ(joined.counters.assemblies, 4);
   EXPECT_EQ(joined.counters.factorisations, 4);
   EXPECT_EQ(joined.counters.unions, 2);

   // Torque of the load on the held contact: ∫ r² r 2πr dr = 2π (2⁵ - 1)/5.
   const VectorXd r = problem.position.col(0);
   EXPECT_NEAR(problem.patterns[1].q.tail(n).dot(r), -2 * M_PI * 31 / 5, 1e-11);
   // The upper ring can spin: no torque resists where nothing presses it to the lower one.
   const MatrixXd A_theta = problem.A().bottomRightCorner(n, n);
   EXPECT_LT((A_theta * r).norm(), 1e-12 * A_theta.norm() * r.norm());

   // Bonded: the same displacements as the one body.
   const VectorXd none = VectorXd::Zero(2 * n), w = VectorXd::Zero(n);
   const ElasticBody whole = stack.body(stack.both, Formulation::axisymmetric, true, true);
   const ElasticBody whole_torsion = stack.body(stack.both, Formulation::torsion, true, true);
   const VectorXd U = solved(whole), psi = solved(whole_torsion);
   const mfem::DenseMatrix &x = whole.node_coordinates();
   for (int b : {0, 1})
   {
      ElasticBody part = stack.body(b == 0 ? stack.upper : stack.lower,
                                    Formulation::axisymmetric, false, false);
      ElasticBody twisting =
         stack.body(b == 0 ? stack.upper : stack.lower, Formulation::torsion, false, false);
      const VectorXd u = joined.displacement(b, none, w, VectorXd::Unit(2, 0));
      const VectorXd twist = joined.twist(b, none, VectorXd::Unit(2, 1));
      int found = 0;
      for (int node = 0; node < part.node_coordinates().Width(); ++node)
      {
         for (int other = 0; other < x.Width(); ++other)
         {
            if (std::hypot(x(0, other) - part.node_coordinates()(0, node),
                           x(1, other) - part.node_coordinates()(1, node)) > 1e-9)
            {
               continue;
            }
            ++found;
            for (int c : {0, 1})
            {
               EXPECT_NEAR(u[part.true_dof(node, c)], U[whole.true_dof(other, c)],
                           1e-11 * U.cwiseAbs().maxCoeff());
            }
            EXPECT_NEAR(twist[twisting.true_dof(node, 0)],
                        psi[whole_torsion.true_dof(other, 0)],
                        1e-11 * psi.cwiseAbs().maxCoeff());
         }
      }
      EXPECT_EQ(found, part.node_coordinates().Width());
   }
   // Conjugate of a force pattern: its displacement, here the torque's mean angle.
   EXPECT_NEAR(problem.H(1, 1), psi.dot(whole_torsion.patterns()[0].values),
               1e-11 * problem.H(1, 1));
   EXPECT_EQ(problem.H(0, 1), 0);
}

/// Signs of v_θ and q_θ: the upper body turned by a given angle, or the lower one.
TEST(Torsion, SlipIsThatOfBodyOneRelativeToBodyTwo)
{
   Rings stack;
   for (int turned : {0, 1})
   {
      ElasticBody top = stack.body(stack.upper, Formulation::torsion, false, false),
                  bottom = stack.body(stack.lower, Formulation::torsion, false, false);
      // The twist of one outer face is prescribed, the other held.
      (turned == 0 ? top : bottom).add_displacement("turn", turned == 0 ? 3 : 1, 0, 0.1);
      (turned == 0 ? bottom : top).fix(turned == 0 ? 1 : 3, 0);
      const ElasticBody a = stack.body(stack.upper, Formulation::axisymmetric, false, true),
                        b = stack.body(stack.lower, Formulation::axisymmetric, true, false);
      const ContactLine above = contact_line(a, 1), below = contact_line(b, 3);
      Reduction joined =
         reduce(condense(a, above), condense(b, below), pair_lines(above, below));
      joined.add_torsion(condense(top, contact_line(top, 1)),
                         condense(bottom, contact_line(bottom, 3)));
      const ReducedProblem &problem = joined.problem;
      const Eigen::Index n = problem.nodes();
      const VectorXd q = problem.patterns[1].q.tail(n), r = problem.position.col(0);
      // Bonded, the contact is carried along: the force on body 1 opposes its own turning.
      EXPECT_LT((turned == 0 ? 1 : -1) * q.dot(r), 0);
      // Slipping freely, q = 0: the turned body turns rigidly.
      const VectorXd v = -problem.A().bottomRightCorner(n, n).llt().solve(q);
      EXPECT_LT(difference(v, (turned == 0 ? 0.1 : -0.1) * r), 1e-10);
      VectorXd slip = VectorXd::Zero(2 * n);
      slip.tail(n) = v;
      for (int body : {0, 1})
      {
         const VectorXd twist = joined.twist(body, slip, VectorXd::Unit(2, 1));
         EXPECT_NEAR(twist.minCoeff(), body == turned ? 0.1 : 0.0, 1e-11);
         EXPECT_NEAR(twist.maxCoeff(), body == turned ? 0.1 : 0.0, 1e-11);
      }
      // Torque of the prescribed rotation: the contact's, while it is bonded.
      EXPECT_NEAR(problem.H(1, 1) * 1.0, 0.1 * std::abs(q.dot(r)), 1e-12);
   }
}

TEST(Torsion, RefusesWhatDoesNotBelongTogether)
{
   Rings stack;
   const ElasticBody bottom = stack.body(stack.lower, Formulation::axisymmetric, true, false),
                     torsion = stack.body(stack.lower, Formulation::torsion, true, false),
                     other = stack.body(stack.upper, Formulation::torsion, true, false),
                     plane(stack.lower, 2, Material{});
   const ContactLine line = contact_line(bottom, 3);
   const CondensedBody twist = condense(torsion, contact_line(torsion, 3));
   Reduction one = reduce(condense(bottom, line));
   expect_input_error([&] { reduce(twist); }, "is of torsion");
   expect_input_error([&] { one.add_torsion(twist, twist); },
                      "2 bodies are given, must be as many as in the reduction, 1");
   expect_input_error([&] { one.add_torsion(condense(other, contact_line(other, 3))); },
                      "must be the same");
   expect_input_error([&] { one.add_torsion(condense(bottom, line)); }, "its torsion");
   one.add_torsion(twist);
   EXPECT_EQ(one.problem.components(), 2);
   expect_input_error([&] { one.add_torsion(twist); }, "2 tangential components");
   expect_input_error(
      [&]
      { reduce(condense(plane, contact_line(plane, 1)), condense(bottom, line), Pairing()); },
      "both axisymmetric");
}

/// Stress at a point, and on the axis, of fields that the elements hold exactly.
TEST(Axisymmetric, StressIsRecovered)
{
   const Material material{2.6, 0.3}; // μ = 1, λ = 1.5
   for (const char *kind : {"quads", "triangles"})
   {
      mfem::Mesh mesh = cylinder(kind);
      const ElasticBody body(mesh, 2, material, Formulation::axisymmetric),
         torsion(mesh, 2, material, Formulation::torsion);
      // u_r = r z, u_z = r² : ε_rr = ε_θθ = z, ε_zz = 0, γ = r + 2 r.
      mfem::GridFunction u(&body.space()), twist(&torsion.space());
      const VectorXd nodes =
         nodal(body, [](double r, double z, int c) { return c == 0 ? r * z : r * r; });
      // ψ = r z: τ_rθ = r z, τ_θz = r².
      const VectorXd angles = nodal(torsion, [](double r, double z, int) { return r * z; });
      for (int k = 0; k < u.Size(); ++k) { u(k) = nodes[k]; }
      for (int k = 0; k < twist.Size(); ++k) { twist(k) = angles[k]; }
      mfem::Vector x;
      int on_axis = 0;
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mfem::ElementTransformation &transformation = *mesh.GetElementTransformation(e);
         const mfem::IntegrationRule &points = body.space().GetFE(e)->GetNodes();
         for (int k = 0; k < points.GetNPoints(); ++k)
         {
            transformation.SetIntPoint(&points.IntPoint(k));
            transformation.Transform(points.IntPoint(k), x);
            const double r = x(0), z = x(1);
            on_axis += r == 0;
            const Stress s = stress_at(body, u, transformation);
            const TorsionStress t = torsion_stress_at(torsion, twist, transformation);
            EXPECT_NEAR(s.xx, 5 * z, 1e-12);
            EXPECT_NEAR(s.yy, 3 * z, 1e-12);
            EXPECT_NEAR(s.zz, 5 * z, 1e-12);
            EXPECT_NEAR(s.xy, 3 * r, 1e-12);
            EXPECT_NEAR(t.r_theta, r * z, 1e-12);
            EXPECT_NEAR(t.theta_z, r * r, 1e-12);
         }
      }
      EXPECT_GT(on_axis, 0);
   }
}

TEST(Axisymmetric, HoopStrainNextToTheAxisIsThatOfTheAxis)
{
   // u_r = 0.01 r but for round-off of 1e-16 on the axis, which over r = 1e-13 would be a
   // strain of 1e-3. E = 2.6, ν = 0.3: σ_θθ = 1.5·0.02 + 2·0.01.
   mfem::Mesh mesh = rectangle_mesh({0, 1}, {0, 1});
   const ElasticBody body(mesh, 1, Material{2.6, 0.3}, Formulation::axisymmetric);
   mfem::GridFunction u(&body.space());
   const VectorXd nodes = nodal(body,
                                [](double r, double, int c) {
                                   return c == 1 ? 0 : r > 0 ? 0.01 * r : 1e-16;
                                });
   for (int k = 0; k < u.Size(); ++k) { u(k) = nodes[k]; }
   mfem::ElementTransformation &transformation = *mesh.GetElementTransformation(0);
   for (const double r : {0.0, 1e-13, 1e-3, 0.5})
   {
      mfem::IntegrationPoint point;
      point.Set2(r, 0.5);
      transformation.SetIntPoint(&point);
      EXPECT_NEAR(stress_at(body, u, transformation).zz, 0.05, 1e-12) << r;
   }
}

/// The contact's torque is that of the stress on a cross-section: exactly on a grid, since
/// functions of z alone are among the test functions.
TEST(Torsion, TorqueOfStressAndOfContactForcesAgree)
{
   const int elements = 4;
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 1, elements), uniform(0, 1, elements));
   ElasticBody body(mesh, 2, Material{2.6, 0.3}, Formulation::torsion);
   body.fix(3, 0);
   CondensedBody condensed = condense(body, contact_line(body, 1));
   // A contact that does not turn as one: u_θ = r³.
   const VectorXd r = condensed.line.each(&LineNode::position).col(0), v = r.array().cube();
   const double torque = r.dot(condensed.S * v);
   mfem::GridFunction twist(&body.space());
   twist = to_mfem(condensed.recover(v, VectorXd(0)));
   double section = 0; // at z = 1/2, seen from above
   for (int e = 0; e < mesh.GetNE(); ++e)
   {
      mfem::ElementTransformation &transformation = *mesh.GetElementTransformation(e);
      const mfem::IntegrationRule &rule = mfem::IntRules.Get(mfem::Geometry::SEGMENT, 8);
      for (int k = 0; k < rule.GetNPoints(); ++k)
      {
         mfem::IntegrationPoint ip;
         ip.Set2(rule.IntPoint(k).x, 0.0);
         transformation.SetIntPoint(&ip);
         mfem::Vector x;
         transformation.Transform(ip, x);
         if (std::abs(x(1) - 0.5) > 1e-9) { continue; }
         section -= rule.IntPoint(k).weight / elements * 2 * M_PI * x(0) * x(0) *
                    torsion_stress_at(body, twist, transformation).theta_z;
      }
   }
   EXPECT_GT(torque, 0);
   EXPECT_NEAR(section, torque, 1e-12 * torque);
}

TEST(Axisymmetric, OnlyTranslationAlongTheAxisIsRigid)
{
   Rings stack;
   const auto modes = [](const ElasticBody &body)
   { return condense(body, contact_line(body, 1)).rigid_modes; };
   ElasticBody free = stack.body(stack.upper, Formulation::axisymmetric, false, false);
   EXPECT_EQ(modes(free), 1);
   ElasticBody torsion = stack.body(stack.upper, Formulation::torsion, false, false);
   EXPECT_EQ(modes(torsion), 1);
   for (ElasticBody *body : {&free, &torsion})
   {
      const CondensedBody condensed = condense(*body, contact_line(*body, 1));
      const VectorXd Z = condensed.rigid_motions();
      EXPECT_LT((condensed.S * Z).norm(), 1e-13 * condensed.S.norm() * Z.norm());
   }
   free.fix(BoundaryPart({2}, 1, 0.3, 0.7), 0); // does not hold it
   EXPECT_EQ(modes(free), 1);
   free.fix_node(2, 0.7, 1);
   EXPECT_EQ(modes(free), 0);
   torsion.fix_node(2, 0.7, 0);
   EXPECT_EQ(modes(torsion), 0);
}

} // namespace
