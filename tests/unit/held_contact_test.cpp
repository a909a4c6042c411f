// Contact nodes of which supports hold a component: half models and their likes.
#include "elastic_support.hpp"
#include <cattaneo/contact/assemble.hpp>
#include <cattaneo/friction/march.hpp>
#include <functional>

namespace
{

using namespace cattaneo;
using namespace support;

/// [-1, 1] × [0, 1], or its right half with the same nodes, moved up by `up`.
mfem::Mesh whole_or_half(bool half, double up)
{
   mfem::Mesh mesh = mfem::Mesh::MakeCartesian2D(half ? 8 : 16, 5, mfem::Element::QUADRILATERAL,
                                                 true, half ? 1.0 : 2.0, 1.0, false);
   for (int v = 0; v < mesh.GetNV(); ++v)
   {
      double *x = mesh.GetVertex(v);
      if (!half) { x[0] = std::round((x[0] - 1) * 8) / 8; }
      else { x[0] = std::round(x[0] * 8) / 8; }
      x[1] += up;
   }
   return mesh;
}

/// Held against moving sideways: on the plane of symmetry, or somewhere on it.
void hold_sideways(ElasticBody &body, bool half, double y)
{
   if (half) { body.fix(4, 0); }
   else { body.fix_node(0, y, 0); }
}

struct Solved
{
   Reduction reduction;
   ContactState state;
};

Solved pressed(Reduction reduction)
{
   ReducedProblem &problem = reduction.problem;
   set_friction(problem, 0.3);
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(
      problem,
      LoadHistory::through(problem, {{}, {{"down", 0.1}}, {{"down", 0.06}}, {{"down", 0.08}}}),
      state);
   EXPECT_EQ(report.status, FrictionStatus::converged);
   return {std::move(reduction), state};
}

/// Forces, displacements and fields of the right half of the whole model.
void expect_half_of(Solved &whole, Solved &half, const std::vector<const ElasticBody *> &bodies,
                    const std::vector<const ElasticBody *> &halves)
{
   const ReducedProblem &all = whole.reduction.problem, &part = half.reduction.problem;
   const double force = whole.state.p.maxCoeff(), move = whole.state.v.cwiseAbs().maxCoeff() +
                                                         whole.state.w.cwiseAbs().maxCoeff();
   ASSERT_GT(force, 0);
   ASSERT_GT(whole.state.q.cwiseAbs().maxCoeff(), 0.01 * force);
   ASSERT_LT(whole.state.p.minCoeff(), 1e-6 * force); // some are open
   ASSERT_EQ(2 * part.nodes() - 1, all.nodes());
   for (Eigen::Index i = 0; i < part.nodes(); ++i)
   {
      Eigen::Index j = 0;
      (all.position.rowwise() - part.position.row(i)).rowwise().norm().minCoeff(&j);
      ASSERT_LT((all.position.row(j) - part.position.row(i)).norm(), 1e-12);
      const bool on_plane = part.position(i, 0) == 0;
      const double share = on_plane ? 0.5 : 1; // of the node that both halves have
      EXPECT_NEAR(half.state.p[i], share * whole.state.p[j], 1e-9 * force);
      EXPECT_NEAR(half.state.w[i], whole.state.w[j], 1e-9 * move);
      EXPECT_NEAR(half.state.v[i], whole.state.v[j], 1e-9 * move);
      EXPECT_NEAR(part.weights[i], share * all.weights[j], 1e-12);
      if (!on_plane)
      {
         EXPECT_NEAR(half.state.q[i], whole.state.q[j], 1e-9 * force);
         continue;
      }
      EXPECT_EQ(part.held, std::vector<Eigen::Index>{i});
      EXPECT_EQ(half.state.v[i], 0);
      EXPECT_EQ(half.state.q[i], 0);
      const ContactChain &chain = part.chains[0];
      EXPECT_EQ(chain.ends[i == 0 ? 0 : 1], LineEnd::symmetry);
   }
   EXPECT_NEAR(half.state.dissipation, whole.state.dissipation / 2, 1e-9 * force * move);
   EXPECT_TRUE(all.held.empty());
   for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
   {
      const VectorXd u =
         whole.reduction.displacement(b, whole.state.v, whole.state.w, whole.state.multipliers);
      const VectorXd u_half =
         half.reduction.displacement(b, half.state.v, half.state.w, half.state.multipliers);
      const mfem::DenseMatrix &x = bodies[b]->node_coordinates(),
                              &x_half = halves[b]->node_coordinates();
      for (int i = 0; i < x_half.Width(); ++i)
      {
         int found = 0;
         for (int j = 0; j < x.Width(); ++j)
         {
            if (std::hypot(x(0, j) - x_half(0, i), x(1, j) - x_half(1, i)) > 1e-9) { continue; }
            ++found;
            for (int c : {0, 1})
            {
               EXPECT_NEAR(u_half[halves[b]->true_dof(i, c)], u[bodies[b]->true_dof(j, c)],
                           1e-9 * move);
            }
         }
         EXPECT_EQ(found, 1);
      }
   }
}

TEST(HeldContact, HalfModelOnARigidCylinderIsHalfOfTheWhole)
{
   mfem::Mesh mesh = whole_or_half(false, 0), half_mesh = whole_or_half(true, 0);
   ElasticBody body(mesh, 2, Material{1.0, 0.3}), half(half_mesh, 2, Material{1.0, 0.3});
   hold_sideways(body, false, 1);
   hold_sideways(half, true, 1);
   const auto solve = [](ElasticBody &of)
   {
      of.add_displacement("down", 3, 1, -1.0);
      return pressed(reduce(condense(of, contact_line(of, 1)),
                            [](double x, double) { return 0.25 * x * x; }));
   };
   Solved all = solve(body), part = solve(half);
   expect_half_of(all, part, {&body}, {&half});
   CondensedBody condensed = condense(half, contact_line(half, 1));
   EXPECT_LT(condensed.error_estimate(), 1e-9);
   // The same as data of any program.
   const CondensedBody data = condense(assembled(half), contact_line(half, 1));
   EXPECT_EQ(data.held, condensed.held);
   EXPECT_EQ(data.S, condensed.S);
}

TEST(HeldContact, HalfOfWhatAGuideMovesIsHalfOfTheWhole)
{
   mfem::Mesh mesh = whole_or_half(false, 0), half_mesh = whole_or_half(true, 0);
   ElasticBody body(mesh, 2, Material{1.0, 0.3}), half(half_mesh, 2, Material{1.0, 0.3});
   hold_sideways(body, false, 1);
   hold_sideways(half, true, 1);
   // Two blocks beside the middle, each under half of the force.
   const Guide block{{Guide::Motion::free}, {Guide::Motion::force, "down", -0.5}};
   body.guide({{3}, 0, -2.0, -0.3}, block);
   for (ElasticBody *of : {&body, &half}) { of->guide({{3}, 0, 0.3, 2.0}, block); }
   const auto solve = [](ElasticBody &of)
   {
      return pressed(reduce(condense(of, contact_line(of, 1)),
                            [](double x, double) { return 0.25 * x * x; }));
   };
   Solved all = solve(body), part = solve(half);
   expect_half_of(all, part, {&body}, {&half});
}

TEST(HeldContact, AHalfModelMayStandInAnyOfFourDirections)
{
   Eigen::MatrixXd upright;
   for (int turns = 0; turns < 4; ++turns)
   {
      mfem::Mesh mesh = whole_or_half(true, 0);
      rotate(mesh, turns * std::acos(-1.0) / 2);
      ElasticBody body(mesh, 2, Material{1.0, 0.3});
      body.fix(4, turns % 2); // across the plane of symmetry
      body.fix(3, 0);
      body.fix(3, 1);
      const CondensedBody condensed = condense(body, contact_line(body, 1));
      if (turns == 0) { upright = condensed.S; }
      EXPECT_LT((condensed.S - upright).norm(), 1e-12 * upright.norm()) << turns;
      EXPECT_EQ(condensed.held.size(), 1u);
   }
}

TEST(HeldContact, HalfModelOfTwoBodiesIsHalfOfTheWhole)
{
   // A block with a bottom that bulges on a softer one: the line meets the plane of symmetry at
   // an angle, as a half does.
   const auto bulge = [](const mfem::Vector &x, mfem::Vector &y)
   {
      y.SetSize(2);
      y(0) = x(0);
      y(1) = x(1) + 0.02 * x(0) * x(0) * (1 - x(1));
   };
   mfem::Mesh upper[2] = {whole_or_half(false, 0), whole_or_half(true, 0)},
              lower[2] = {whole_or_half(false, -1), whole_or_half(true, -1)};
   std::vector<ElasticBody> body1, body2;
   std::vector<Solved> solved;
   for (int half : {0, 1})
   {
      upper[half].Transform(bulge);
      ElasticBody &top = body1.emplace_back(upper[half], 2, Material{1.0, 0.3});
      ElasticBody &bottom = body2.emplace_back(lower[half], 2, Material{0.4, 0.2});
      hold_sideways(top, half == 1, 1);
      hold_sideways(bottom, half == 1, -1);
      bottom.fix(1, 1);
      top.add_displacement("down", 3, 1, -0.1);
      CondensedBody first = condense(top, contact_line(top, 1)),
                    second = condense(bottom, contact_line(bottom, 3));
      // In frames as condensing left them.
      const Pairing pairing = pair_lines(first.line, second.line, 0.1);
      solved.push_back(pressed(reduce(std::move(first), std::move(second), pairing)));
   }
   EXPECT_EQ(solved[1].reduction.problem.chains[0].other_ends[0], LineEnd::symmetry);
   expect_half_of(solved[0], solved[1], {&body1[0], &body2[0]}, {&body1[1], &body2[1]});
}

/// Both bodies whole, tied at the contact nodes by multipliers to given relative displacements
/// in given frames: a dense system that knows no condensation.
struct Tied
{
   MatrixXd M, rhs; ///< one column a pattern, after those of unit relative displacements
   int dofs1, dofs;

   Tied(const ElasticBody &body1, const ElasticBody &body2, const ReducedProblem &problem,
        const Eigen::MatrixX2d &tangent)
   {
      const MatrixXd K1 = dense(body1.stiffness()), K2 = dense(body2.stiffness());
      dofs1 = static_cast<int>(K1.rows());
      dofs = dofs1 + static_cast<int>(K2.rows());
      const auto ties = 2 * problem.nodes();
      MatrixXd K = MatrixXd::Zero(dofs, dofs), T = MatrixXd::Zero(ties, dofs);
      K.topLeftCorner(dofs1, dofs1) = K1;
      K.bottomRightCorner(K2.rows(), K2.rows()) = K2;
      for (Eigen::Index i = 0; i < problem.nodes(); ++i)
      {
         const Eigen::Matrix2d frame{{tangent(i, 0), tangent(i, 1)},
                                     {-tangent(i, 1), tangent(i, 0)}};
         for (int row : {0, 1})
         {
            for (int c : {0, 1})
            {
               T(row * problem.nodes() + i, problem.dofs(i, c)) = frame(row, c);
               T(row * problem.nodes() + i, dofs1 + problem.dofs(i, 2 + c)) = -frame(row, c);
            }
         }
      }
      MatrixXd F = MatrixXd::Zero(dofs, ties + problem.patterns.size());
      for (std::size_t k = 0; k < problem.patterns.size(); ++k)
      {
         for (const BodyLoad &load : body1.patterns())
         {
            if (load.name == problem.patterns[k].name)
            {
               F.col(ties + k).head(dofs1) = load.values;
            }
         }
         for (const BodyLoad &load : body2.patterns())
         {
            if (load.name == problem.patterns[k].name)
            {
               F.col(ties + k).tail(K2.rows()) = load.values;
            }
         }
      }
      loads = F;
      const auto fix = [&](int dof)
      {
         K.row(dof).setZero();
         K.col(dof).setZero();
         T.col(dof).setZero();
         F.row(dof).setZero();
         K(dof, dof) = 1;
      };
      for (int dof : body1.essential_dofs()) { fix(dof); }
      for (int dof : body2.essential_dofs()) { fix(dofs1 + dof); }
      M = MatrixXd::Zero(dofs + ties, dofs + ties);
      M << K, T.transpose(), T, MatrixXd::Zero(ties, ties);
      rhs = MatrixXd::Zero(dofs + ties, F.cols());
      rhs.topRows(dofs) = F;
      rhs.bottomLeftCorner(ties, ties).setIdentity();
   }
   MatrixXd loads;
};

TEST(HeldContact, WhatOneOfTwoBodiesHoldsIsTheOthersAlone)
{
   double slope = 0; // of the contact, to what supports hold
   struct Case
   {
      const char *name;
      std::function<void(ElasticBody &, ElasticBody &)> fix;
      std::vector<Eigen::Index> held;
   };
   const std::vector<Case> cases = {{"upper", [](auto &a, auto &) { a.fix(4, 0); }, {}},
                                    {"lower", [](auto &, auto &b) { b.fix(4, 0); }, {}},
                                    {"upper left, lower right",
                                     [](auto &a, auto &b)
                                     {
                                        a.fix(4, 0);
                                        b.fix(2, 0);
                                     },
                                     {}},
                                    {"both",
                                     [](auto &a, auto &b)
                                     {
                                        a.fix(4, 0);
                                        b.fix(4, 0);
                                     },
                                     {0}},
                                    {"normal of the upper",
                                     [&](auto &a, auto &)
                                     {
                                        a.fix_node(0, 0, 1);
                                        a.fix_node(2, 2 * slope, 0);
                                     },
                                     {}},
                                    {"all of the upper's corner",
                                     [](auto &a, auto &)
                                     {
                                        a.fix(4, 0);
                                        a.fix(4, 1);
                                     },
                                     {}},
                                    {"all of the lower's corner, upper loose",
                                     [](auto &, auto &b)
                                     {
                                        b.fix(2, 0);
                                        b.fix(2, 1);
                                     },
                                     {}}};
   // Whichever of the bodies the formulas begin with.
   for (const auto &[stiffer, leaning] :
        std::vector<std::pair<double, double>>{{5, 0}, {0.2, 0}, {5, 0.1}, {0.2, -0.15}})
   {
      slope = leaning;
      mfem::Mesh upper = block("quads"), lower = block("quads");
      for (mfem::Mesh *mesh : {&upper, &lower})
      {
         for (int v = 0; v < mesh->GetNV(); ++v)
         {
            double *x = mesh->GetVertex(v);
            x[1] += slope * x[0] - (mesh == &lower ? 1 : 0);
         }
      }
      for (const Case &one : cases)
      {
         ElasticBody top(upper, 1, Material{1.0, 0.3}),
            bottom(lower, 1, Material{stiffer, 0.2});
         bottom.fix(1, 0);
         bottom.fix(1, 1);
         one.fix(top, bottom);
         top.add_pressure("P", 3, [](double x, double) { return 1 + x; });
         top.add_traction("Q", 2, 0.3, 0.1);
         bottom.add_traction("Q", 2, 1.0, -2.0);
         CondensedBody first = condense(top, contact_line(top, 1)),
                       second = condense(bottom, contact_line(bottom, 3));
         const Pairing pairing = pair_lines(first.line, second.line);
         Reduction reduction = reduce(std::move(first), std::move(second), pairing);
         const ReducedProblem &problem = reduction.problem;
         problem.validate();
         EXPECT_EQ(problem.held, one.held) << one.name;

         const Tied tied(top, bottom, problem, reduction.interfaces[0].tangent);
         MatrixXd M = tied.M, rhs = tied.rhs;
         const auto n = problem.nodes(), ties = 2 * n;
         for (Eigen::Index row : one.held) // it carries no force: its equation is empty
         {
            M.row(tied.dofs + row).setZero();
            M.col(tied.dofs + row).setZero();
            M(tied.dofs + row, tied.dofs + row) = 1;
            rhs.col(row).setZero();
         }
         const MatrixXd x = M.fullPivLu().solve(rhs);
         MatrixXd forces = -x.bottomRows(ties), S = problem.K;
         for (Eigen::Index row : one.held) { S.row(row).setZero(), S.col(row).setZero(); }
         EXPECT_LT(difference(S, forces.leftCols(ties)), 1e-10) << one.name;
         for (std::size_t k = 0; k < problem.patterns.size(); ++k)
         {
            VectorXd f(ties);
            f << problem.patterns[k].q, problem.patterns[k].p;
            EXPECT_LT(difference(f, forces.col(ties + k)), 1e-10) << one.name;
         }
         const MatrixXd H =
            tied.loads.rightCols(2).transpose() * x.topRightCorner(tied.dofs, 2);
         EXPECT_LT(difference(problem.H, H), 1e-10) << one.name;

         VectorXd u = VectorXd::LinSpaced(ties, -1, 2), loads(2);
         for (Eigen::Index row : one.held) { u[row] = 0; }
         loads << 0.7, -0.4;
         VectorXd all(ties + 2);
         all << u, loads;
         const VectorXd field = x.topRows(tied.dofs) * all;
         EXPECT_LT(difference(reduction.displacement(0, u.head(n), u.tail(n), loads),
                              field.head(tied.dofs1)),
                   1e-10)
            << one.name;
         EXPECT_LT(difference(reduction.displacement(1, u.head(n), u.tail(n), loads),
                              field.tail(tied.dofs - tied.dofs1)),
                   1e-10)
            << one.name;
      }
   }
}

TEST(HeldContact, HeldRowsAreEmptyToTheLastBitWhereBodiesMoveFreely)
{
   mfem::Mesh upper = whole_or_half(true, 0), lower = whole_or_half(true, -1);
   ElasticBody top(upper, 2, Material{1.0, 0.3}), bottom(lower, 2, Material{2.0, 0.2});
   for (ElasticBody *body : {&top, &bottom}) { body->fix(4, 0); }
   top.add_pressure("P", 3, 0.7);
   bottom.add_pressure("P", 1, 0.7);
   const CondensedBody first = condense(top, contact_line(top, 1)),
                       second = condense(bottom, contact_line(bottom, 3));
   EXPECT_EQ(first.rigid_modes, 1);
   EXPECT_EQ(second.rigid_modes, 1);
   const Reduction alone = reduce(first),
                   both = reduce(first, second, pair_lines(first.line, second.line));
   for (const Reduction *reduction : {&alone, &both})
   {
      reduction->problem.validate(); // asks for exact zeros
      EXPECT_EQ(reduction->problem.held, std::vector<Eigen::Index>{0});
      // Half of the whole's force comes through, to the round-off of an equilibrium.
      EXPECT_NEAR(reduction->problem.patterns[0].p.sum(), 0.7, 1e-12);
   }
}

TEST(HeldContact, TwistThatIsHeldIsHeld)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody disc(mesh, 1, Material{}), twisting(mesh, 1, Material{}, Formulation::torsion);
   ElasticBody meridian(mesh, 1, Material{}, Formulation::axisymmetric);
   meridian.fix(3, 1);
   twisting.fix(2, 0);
   twisting.add_traction("T", 3, [](double r, double) { return r; });
   Reduction reduction = reduce(condense(meridian, contact_line(meridian, 1)));
   reduction.add_torsion(condense(twisting, contact_line(twisting, 1)));
   const ReducedProblem &problem = reduction.problem;
   problem.validate();
   EXPECT_EQ(problem.held, std::vector<Eigen::Index>{2 * problem.nodes() - 1});
}

// Held it is a plane of symmetry, moved it is none, and no friction is known there.
TEST(HeldContact, AMovedEndIsNoPlaneOfSymmetry)
{
   mfem::Mesh mesh = block("quads");
   for (const std::string way : {"held", "pushed", "tilted about its corner"})
   {
      ElasticBody body(mesh, 2, Material{});
      body.fix(3, 1);
      if (way == "held") { body.fix(4, 0); }
      else if (way == "pushed") { body.add_displacement("push", 4, 0, 0.5); }
      else
      {
         body.add_displacement("tilt", 4, 0, [](double, double y) { return y; });
      }
      const CondensedBody condensed = condense(body, contact_line(body, 1));
      EXPECT_EQ(condensed.line.chains[0].ends[0] == LineEnd::symmetry, way == "held");
      EXPECT_EQ(condensed.moved.size() > 0, way == "pushed");
      const Reduction reduction = reduce(condensed);
      EXPECT_EQ(reduction.problem.held, std::vector<Eigen::Index>{0});
      EXPECT_EQ(reduction.problem.chains[0].ends[0] == LineEnd::symmetry, way == "held");
      EXPECT_EQ(reduction.interfaces[0].moved.size(), way == "pushed" ? 1u : 0u);
   }
}

TEST(HeldContact, WhatCannotBeContactIsRefused)
{
   mfem::Mesh mesh = block("quads");
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix(4, 0);
      body.fix(4, 1);
      CondensedBody condensed = condense(body, contact_line(body, 1));
      expect_input_error([&] { reduce(std::move(condensed)); },
                         "the contact node at (0, 0) is fixed normal to the line");
   }
   {
      ElasticBody body(mesh, 1, Material{}, Formulation::torsion);
      body.add_displacement("turn", 2, 0, 1.0);
      expect_input_error([&] { condense(body, contact_line(body, 1)); },
                         "of the contact node at (2, 0) is turned by load pattern 'turn'");
   }
   {
      // Held at 20 degrees to the line.
      mfem::Mesh turned = block("quads");
      rotate(turned, 20 * std::acos(-1.0) / 180);
      ElasticBody body(turned, 1, Material{});
      body.fix_node(0, 0, 0);
      expect_input_error([&] { condense(body, contact_line(body, 1)); },
                         "the line meets it at 20");
   }
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix(1, 0);
      body.fix(1, 1);
      expect_input_error([&] { condense(body, contact_line(body, 1)); },
                         "all 10 contact dofs are fixed");
   }
}

} // namespace
