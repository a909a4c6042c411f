#include "elastic_support.hpp"

namespace
{

using namespace cattaneo;
using namespace support;
using Backend = SparseFactor::Backend;

struct Case
{
   std::string mesh;
   int order;
   bool supported;
};

std::ostream &operator<<(std::ostream &out, const Case &c)
{
   return out << c.mesh << ", p = " << c.order << (c.supported ? ", supported" : ", free");
}

std::vector<Case> cases()
{
   std::vector<Case> all;
   for (const char *mesh :
        {"quads", "triangles", "nonconforming", "nonconforming triangles", "curved"})
   {
      for (int order : {1, 2, 3})
      {
         for (bool supported : {true, false}) { all.push_back({mesh, order, supported}); }
      }
   }
   return all;
}

/// Force patterns always; supports and displacement patterns only if supported.
void load(ElasticBody &body, bool supported)
{
   body.add_pressure("press", {{3}, 0, 0.3, 1.1}, [](double x, double) { return 1 + x; });
   body.add_traction("drag", 3, 0.4, [](double x, double) { return x * x; });
   body.add_body_force("weight", 0.1, [](double x, double y) { return -1 - x * y; });
   if (supported)
   {
      body.fix({{4}, 1, 0.3, 2.0}, 0);
      body.add_displacement("pull", {{2}, 1, 0.3, 2.0}, 0,
                            [](double, double y) { return 1 + y; });
      body.add_displacement("lift", {{2}, 1, 0.3, 2.0}, 1, 0.7);
   }
}

class Condensation : public testing::TestWithParam<Case>
{
};

TEST_P(Condensation, AgreesWithExplicitStaticReduction)
{
   mfem::Mesh mesh = block(GetParam().mesh);
   ElasticBody body(mesh, GetParam().order, Material{210.0, 0.3});
   load(body, GetParam().supported);
   const ContactLine line = contact_line(body, 1);
   CondensedBody condensed = condense(body, line);

   // Thesis (3.9)-(3.19) with dense matrices.
   const Split s(body, line);
   const Eigen::LDLT<MatrixXd> KII(s.block(s.I, s.I));
   const MatrixXd schur =
      s.R * (s.block(s.C, s.C) - s.block(s.C, s.I) * KII.solve(s.block(s.I, s.C))) *
      s.R.transpose();
   EXPECT_LT(difference(condensed.S, schur), 1e-11);
   EXPECT_EQ(difference(condensed.S, condensed.S.transpose()), 0.0);
   EXPECT_EQ(condensed.rigid_modes, GetParam().supported ? 0 : 3);
   EXPECT_EQ(condensed.counters.assemblies, 1);
   EXPECT_EQ(condensed.counters.factorisations, 1);
   EXPECT_EQ(condensed.counters.back_substitutions, static_cast<long>(body.patterns().size()));
   ASSERT_EQ(condensed.patterns.size(), body.patterns().size());
   for (std::size_t k = 0; k < body.patterns().size(); ++k)
   {
      const VectorXd values = body.patterns()[k].values;
      VectorXd clamped;
      if (body.patterns()[k].control == Control::force)
      {
         clamped = s.block(s.C, s.I) * KII.solve(VectorXd(values(s.I))) - VectorXd(values(s.C));
      }
      else
      {
         clamped = (s.block(s.C, s.D) - s.block(s.C, s.I) * KII.solve(s.block(s.I, s.D))) *
                   VectorXd(values(s.D));
      }
      VectorXd f(2 * line.size());
      f << condensed.patterns[k].q, condensed.patterns[k].p;
      EXPECT_EQ(condensed.patterns[k].name, body.patterns()[k].name);
      EXPECT_LT(difference(f, s.R * clamped), 1e-11) << condensed.patterns[k].name;
   }
}

/// The direct solution of the whole body for given contact displacements and multipliers:
/// recovery, contact forces and the conjugates of all patterns against it.
TEST_P(Condensation, RecoversTheFieldAndTheConjugatesOfTheLoads)
{
   mfem::Mesh mesh = block(GetParam().mesh);
   ElasticBody body(mesh, GetParam().order, Material{1.0, 0.25});
   load(body, GetParam().supported);
   const ContactLine line = contact_line(body, 1);
   CondensedBody condensed = condense(body, line);
   const Split s(body, line);

   std::mt19937 random(7);
   std::uniform_real_distribution<double> number(-1, 1);
   VectorXd u(2 * line.size()), multipliers(body.patterns().size());
   for (double &x : u) { x = number(random); }
   for (double &x : multipliers) { x = number(random); }
   VectorXd U = VectorXd::Zero(s.K.rows()), F = U;
   for (std::size_t k = 0; k < body.patterns().size(); ++k)
   {
      const VectorXd values = multipliers[k] * body.patterns()[k].values;
      (body.patterns()[k].control == Control::force ? F : U) += values;
   }
   U(s.C) = s.R.transpose() * u;
   const VectorXd pushed = VectorXd(F(s.I)) - s.block(s.I, s.D) * VectorXd(U(s.D)) -
                           s.block(s.I, s.C) * VectorXd(U(s.C));
   const VectorXd interior = s.block(s.I, s.I).ldlt().solve(pushed);
   U(s.I) = interior;
   const VectorXd residual = s.K * U - F; // reactions and contact forces

   const VectorXd recovered = condensed.recover(u, multipliers);
   EXPECT_LT(difference(recovered, U), 1e-11);
   EXPECT_LT((s.K * recovered - F)(s.I).cwiseAbs().maxCoeff(),
             1e-12 * s.K.cwiseAbs().maxCoeff());
   EXPECT_EQ(condensed.counters.field_recoveries, 1);

   VectorXd f = condensed.S * u;
   for (std::size_t k = 0; k < body.patterns().size(); ++k)
   {
      f.head(line.size()) += multipliers[k] * condensed.patterns[k].q;
      f.tail(line.size()) += multipliers[k] * condensed.patterns[k].p;
   }
   EXPECT_LT(difference(f, s.R * VectorXd(residual(s.C))), 1e-11);

   const double scale = std::abs(U.dot(s.K * U));
   for (std::size_t k = 0; k < body.patterns().size(); ++k)
   {
      VectorXd f_k(2 * line.size());
      f_k << condensed.patterns[k].q, condensed.patterns[k].p;
      const VectorXd values = body.patterns()[k].values;
      const bool force = body.patterns()[k].control == Control::force;
      const double conjugate =
         force ? values.dot(U) : VectorXd(values(s.D)).dot(VectorXd(residual(s.D)));
      const double expected =
         condensed.H.row(k).dot(multipliers) + (force ? -f_k.dot(u) : f_k.dot(u));
      EXPECT_NEAR(conjugate, expected, 1e-11 * scale) << condensed.patterns[k].name;
   }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Condensation, testing::ValuesIn(cases()));

TEST(Condensation, CountsRigidMotionsThatSupportsLeave)
{
   mfem::Mesh mesh = block("quads");
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix({{4}, 1, 0.3, 2.0},
               0); // no x displacement on a vertical edge: no rotation either
      EXPECT_EQ(condense(body, contact_line(body, 1)).rigid_modes, 1);
   }
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix_node(1.0, 1.0, 1);
      EXPECT_EQ(condense(body, contact_line(body, 1)).rigid_modes, 2);
   }
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix_node(1.0, 1.0, 0);
      body.fix_node(1.0, 1.0, 1);
      EXPECT_EQ(condense(body, contact_line(body, 1)).rigid_modes, 1);
   }
   {
      ElasticBody body(mesh, 1, Material{});
      body.fix(3, 1);
      body.fix(3, 0);
      EXPECT_EQ(condense(body, contact_line(body, 1)).rigid_modes, 0);
   }
}

TEST(Condensation, RefusesWhatNothingHolds)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   expect_input_error([&] { condense(body, ContactLine()); }, "contact line: it has no nodes");

   // One contact node holds two motions; the body can still turn about it.
   ContactLine one = contact_line(body, 1);
   one.nodes.resize(1);
   one.chains = {{0, 1}};
   expect_input_error([&] { condense(body, one); },
                      "leave 1 rigid motion(s) free of the body with the node (");
   body.fix_node(2.0, 1.0, 1);
   EXPECT_EQ(condense(body, one).counters.factorisations, 1);

   ElasticBody guided(mesh, 1, Material{});
   guided.guide(4, {}); // takes the corner node of the bottom with it
   expect_input_error(
      [&] { condense(guided, contact_line(guided, 1)); },
      "is in a guide, contact nodes must be free, held by a support or moved by a load: "
      "end the contact before the guide");

   ElasticBody other(mesh, 2, Material{});
   expect_input_error(
      [&] {
         condense(body, contact_line(other, {{1, 2, 3, 4}}));
      },
      "line of this body");
}

TEST(Condensation, SaysWhichNodeAndWhichSettingIsWrong)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody body(mesh, 1, Material{});
   const ContactLine line = contact_line(body, 1);
   CondensedBody condensed = condense(body, line);
   const VectorXd u = VectorXd::Zero(10), none;
   expect_input_error([&] { condensed.recover(u.head(9), none); }, "9 contact displacements");
   expect_input_error([&] { condensed.recover(u, VectorXd::Ones(1)); }, "1 load multipliers");
   expect_input_error([&] { condensed.recover(VectorXd::Constant(10, std::nan("")), none); },
                      "is not finite");
   body.add_pressure("press", 3, 1.0);
   condensed = condense(body, line);
   expect_input_error([&] { condensed.recover(u, VectorXd::Constant(1, std::nan(""))); },
                      "a load multiplier is not finite");
   for (const auto &[said, member] :
        {std::pair("direct_dofs is -1", &CondenseSettings::direct_dofs),
         {"max_iterations is -1", &CondenseSettings::max_iterations}})
   {
      CondenseSettings settings;
      settings.*member = -1;
      expect_input_error([&, settings = settings] { condense(body, line, settings); }, said);
      settings.*member = 0;
      if (member == &CondenseSettings::max_iterations)
      {
         expect_input_error([&, settings = settings] { condense(body, line, settings); },
                            "max_iterations is 0, must be at least 1");
      }
      else { EXPECT_NO_THROW(condense(body, line, settings)); }
   }
   ContactLine torn = line;
   torn.nodes.pop_back();
   expect_input_error(
      [&] { condense(body, torn); },
      "a chain of 5 nodes begins at node 0, must begin at node 0 and have 1 to 4");
   // Both ends are fixed along y: the first is named.
   body.fix({{2, 4}, 1, -1.0, 0.1}, 1);
   expect_input_error([&] { reduce(condense(body, line)); },
                      "the contact node at (0, 0) is fixed normal to the line");
   expect_input_error(
      [&] {
         reduce(condense(body, contact_line(body, {{1}, 0, 0.4, 2.0})));
      },
      "the contact node at (2, 0) is fixed normal to the line");
}

TEST(Condensation, SecondOfTwoEqualBodiesFactorsNothing)
{
   mfem::Mesh upper = block("quads"), lower = block("quads"), other = block("quads");
   rotate(lower, M_PI);
   other.GetVertex(8)[0] += 0.01;
   ElasticBody body(upper, 2, Material{}), turned(lower, 2, Material{}),
      different(other, 2, Material{});
   for (ElasticBody *b : {&body, &turned, &different})
   {
      b->fix(3, 0);
      b->fix(3, 1);
      b->add_body_force("weight", 0.0, -1.0);
   }
   CondensedBody first = condense(body, contact_line(body, 1));
   CondensedBody second = condense(turned, contact_line(turned, 1), {}, &first);
   EXPECT_EQ(first.counters.factorisations, 1);
   EXPECT_EQ(second.counters.factorisations, 0);
   const CondensedBody alone = condense(turned, contact_line(turned, 1));
   EXPECT_LT(difference(second.S, alone.S), 1e-12);
   EXPECT_LT(difference(second.patterns[0].p, alone.patterns[0].p), 1e-12);
   EXPECT_EQ(
      condense(different, contact_line(different, 1), {}, &first).counters.factorisations, 1);
   ElasticBody freed(lower, 2, Material{});
   EXPECT_EQ(condense(freed, contact_line(freed, 1), {}, &first).counters.factorisations, 1);
}

/// S and the load vectors are in the body's own frames: turning everything changes nothing.
TEST(Condensation, RotationChangesNothing)
{
   const auto condensed = [](double angle)
   {
      mfem::Mesh mesh = block("triangles", 6, 5);
      rotate(mesh, angle);
      ElasticBody body(mesh, 2, Material{3.0, 0.4});
      body.add_pressure("press", 3, 1.5);
      body.add_traction("drag", 2, std::cos(angle), std::sin(angle));
      body.add_body_force("weight", std::sin(angle), -std::cos(angle));
      return condense(body, contact_line(body, 1));
   };
   const CondensedBody reference = condensed(0.0);
   for (double angle : {0.1, 1.0, M_PI / 2, 2.5, -3.0})
   {
      const CondensedBody turned = condensed(angle);
      EXPECT_LT(difference(turned.S, reference.S), 1e-11) << angle;
      EXPECT_LT(difference(turned.H, reference.H), 1e-11) << angle;
      for (int k = 0; k < 3; ++k)
      {
         EXPECT_LT(difference(turned.patterns[k].p, reference.patterns[k].p), 1e-11) << angle;
         EXPECT_LT(difference(turned.patterns[k].q, reference.patterns[k].q), 1e-11) << angle;
      }
   }
}

/// Stiffness scales with E, forces with length × stress, and nothing depends on the units
/// otherwise.
TEST(Condensation, UnitsChangeNothing)
{
   const auto condensed = [](double modulus, double length)
   {
      mfem::Mesh mesh = block("quads", 6, 4);
      for (int v = 0; v < mesh.GetNV(); ++v)
      {
         for (int c = 0; c < 2; ++c) { mesh.GetVertex(v)[c] *= length; }
      }
      ElasticBody body(mesh, 2, Material{modulus, 0.3});
      body.fix({{4}, 1, 0.3 * length, 2 * length}, 0);
      body.add_pressure("press", {{3}, 0, 0.3 * length, 1.1 * length}, modulus);
      return condense(body, contact_line(body, 1));
   };
   const CondensedBody reference = condensed(1.0, 1.0);
   for (double modulus : {1e-9, 1.0, 1e9})
   {
      for (double length : {1e-9, 1.0, 1e9})
      {
         const CondensedBody scaled = condensed(modulus, length);
         EXPECT_LT(difference(scaled.S / modulus, reference.S), 1e-12);
         EXPECT_LT(
            difference(scaled.patterns[0].p / (modulus * length), reference.patterns[0].p),
            1e-12);
         EXPECT_LT(difference(scaled.H / (modulus * length * length), reference.H), 1e-12);
         EXPECT_EQ(scaled.rigid_modes, reference.rigid_modes);
      }
   }
}

TEST(Condensation, NumberingOfTheMeshChangesNothing)
{
   const auto condensed = [](bool renumber)
   {
      mfem::Mesh mesh = block("quads", 7, 5);
      if (renumber)
      {
         mfem::Array<int> order(mesh.GetNE());
         for (int e = 0; e < order.Size(); ++e) { order[e] = e; }
         std::shuffle(order.begin(), order.end(), std::mt19937(3));
         mesh.ReorderElements(order);
      }
      ElasticBody body(mesh, 2, Material{});
      body.add_pressure("press", {{3}, 0, 0.2, 0.9}, 1.0);
      return condense(body, contact_line(body, 1));
   };
   const CondensedBody a = condensed(false), b = condensed(true);
   EXPECT_LT(difference(b.S, a.S), 1e-12);
   EXPECT_LT(difference(b.patterns[0].p, a.patterns[0].p), 1e-12);
   EXPECT_LT(difference(b.line.each(&LineNode::position), a.line.each(&LineNode::position)),
             1e-15);
}

TEST(Condensation, PlaneStressIsPlaneStrainOfAnotherMaterial)
{
   mfem::Mesh mesh = block("quads");
   const double nu = 0.3, E = 2.0;
   // E' = E (1 + 2ν)/(1 + ν)², ν' = ν/(1 + ν) turns a plane-strain solution into plane stress.
   ElasticBody stress(mesh, 2, Material{E, nu, PlaneState::stress});
   ElasticBody strain(mesh, 2,
                      Material{E * (1 + 2 * nu) / ((1 + nu) * (1 + nu)), nu / (1 + nu)});
   EXPECT_LT(difference(dense(stress.stiffness()), dense(strain.stiffness())), 1e-14);
}

TEST(Condensation, TakesAUsersOperatorInEitherOrdering)
{
   mfem::Mesh mesh = block("nonconforming");
   ElasticBody reference(mesh, 2, Material{1.0, 0.3});
   load(reference, true);
   const CondensedBody expected = condense(reference, contact_line(reference, 1));
   for (auto ordering : {mfem::Ordering::byNODES, mfem::Ordering::byVDIM})
   {
      mfem::H1_FECollection collection(2, 2);
      mfem::FiniteElementSpace space(&mesh, &collection, 2, ordering);
      mfem::BilinearForm form(&space);
      const Material material{1.0, 0.3};
      mfem::ConstantCoefficient lambda(material.lambda()), mu(material.mu());
      form.AddDomainIntegrator(new mfem::ElasticityIntegrator(lambda, mu));
      form.Assemble();
      form.Finalize();
      mfem::SparseMatrix K;
      mfem::Array<int> none;
      form.FormSystemMatrix(none, K);
      ElasticBody body(space, K);
      load(body, true);
      const CondensedBody condensed = condense(body, contact_line(body, 1));
      EXPECT_EQ(condensed.counters.assemblies, 0);
      EXPECT_EQ(condensed.rigid_modes, expected.rigid_modes);
      EXPECT_LT(difference(condensed.S, expected.S), 1e-12);
      EXPECT_LT(difference(condensed.H, expected.H), 1e-12);
      for (std::size_t k = 0; k < expected.patterns.size(); ++k)
      {
         EXPECT_LT(difference(condensed.patterns[k].q, expected.patterns[k].q), 1e-11);
      }
      expect_input_error([&] { body.material(1); }, "given as a matrix");
   }
}

/// Work that loads do along a closed or open path, with the contact released, is the change of
/// elastic energy: nothing is lost or gained through H.
TEST(Condensation, WorkOfLoadsAndContactForcesIsElasticEnergy)
{
   mfem::Mesh mesh = block("curved");
   ElasticBody body(mesh, 2, Material{1.0, 0.3});
   load(body, true);
   const ContactLine line = contact_line(body, 1);
   CondensedBody condensed = condense(body, line);
   const MatrixXd K = dense(body.stiffness());
   const Eigen::Index n2 = 2 * line.size();
   const auto count = static_cast<Eigen::Index>(body.patterns().size());
   MatrixXd f(n2, count);
   VectorXd sign(count);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      f.col(k) << condensed.patterns[k].q, condensed.patterns[k].p;
      sign[k] = condensed.patterns[k].control == Control::force ? 1 : -1;
   }
   std::mt19937 random(11);
   std::uniform_real_distribution<double> number(-1, 1);
   const auto draw = [&](Eigen::Index size)
   {
      VectorXd x(size);
      for (double &e : x) { e = number(random); }
      return x;
   };
   VectorXd u0 = draw(n2), m0 = draw(count);
   double work = 0.0, energy0 = 0.0, energy = 0.0, largest = 0.0;
   for (int step = 0; step < 5; ++step)
   {
      const VectorXd u1 = draw(n2), m1 = draw(count);
      const auto state =
         [&](const VectorXd &u, const VectorXd &m, VectorXd &force, VectorXd &conjugate)
      {
         force = condensed.S * u + f * m;
         conjugate = condensed.H * m - sign.cwiseProduct(f.transpose() * u);
         const VectorXd U = condensed.recover(u, m);
         return 0.5 * U.dot(K * U);
      };
      VectorXd f0, f1, g0, g1;
      const double before = state(u0, m0, f0, g0);
      energy = state(u1, m1, f1, g1);
      if (step == 0) { energy0 = before; }
      // Everything is linear along the step: the trapezoidal rule is exact.
      work += 0.5 * (f0 + f1).dot(u1 - u0);
      for (Eigen::Index k = 0; k < count; ++k)
      {
         work += sign[k] > 0 ? 0.5 * (m0[k] + m1[k]) * (g1[k] - g0[k])
                             : 0.5 * (g0[k] + g1[k]) * (m1[k] - m0[k]);
      }
      largest = std::max({largest, energy, before});
      u0 = u1;
      m0 = m1;
   }
   EXPECT_NEAR(work, energy - energy0, 1e-11 * largest);
}

TEST(SparseFactor, SolvesAndReadsTheSchurComplement)
{
   mfem::Mesh mesh = block("quads", 9, 8);
   ElasticBody body(mesh, 2, Material{});
   const MatrixXd K = dense(body.stiffness());
   std::vector<int> keep;
   for (int i = 0; i < K.rows(); ++i) { keep.push_back(i); }
   std::shuffle(keep.begin(), keep.end(), std::mt19937(5));
   keep.resize(K.rows() - 17);
   const int n = static_cast<int>(keep.size());
   const MatrixXd kept = K(keep, keep);
   for (int trailing : {0, 1, 30, n / 2, n})
   {
      for (auto backend : {Backend::automatic, Backend::eigen})
      {
         const double shift = trailing > 0 ? 0.7 : 0.0;
         const SparseFactor factor(view(body.stiffness()), keep, trailing, shift, backend);
         MatrixXd shifted = kept;
         shifted.diagonal().tail(trailing).array() += shift;
         const int m = n - trailing;
         MatrixXd schur = kept.bottomRightCorner(trailing, trailing);
         if (m > 0)
         {
            schur -= kept.bottomLeftCorner(trailing, m) *
                     kept.topLeftCorner(m, m).ldlt().solve(kept.topRightCorner(m, trailing));
         }
         EXPECT_EQ(factor.rows(), n);
         EXPECT_LT((factor.schur() - schur).cwiseAbs().sum(), 1e-9 * trailing + 1e-300);
         schur.diagonal().array() += shift;
         const MatrixXd x = MatrixXd::Random(trailing, 2), rhs = MatrixXd::Random(n, 3);
         EXPECT_LT((factor.push(x) - schur * x).cwiseAbs().sum(), 1e-9 * trailing + 1e-300);
         EXPECT_LT((shifted * factor.solve(rhs) - rhs).cwiseAbs().maxCoeff(), 1e-9);
      }
   }
}

} // namespace
