#include "elastic_support.hpp"

#include <Eigen/Eigenvalues>
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/contact/vibrating_body.hpp>
#include <cattaneo/elastic/mass.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/joints/modal_loop.hpp>
#include <cmath>

namespace
{

using namespace cattaneo;
using namespace support;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const double pi = std::acos(-1.0);
const Material steel{2.0, 0.3};
const double density = 0.7;

/// Forces of inertia of a unit acceleration along the last component add up to the mass.
double mass_along_last(const ElasticBody &body, const SharedMatrix &M)
{
   VectorXd r = VectorXd::Zero(M.size());
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      const int dof = body.true_dof(node, body.components() - 1);
      if (dof >= 0) { r[dof] = 1; }
   }
   return r.dot(M.view() * r);
}

TEST(Mass, IsDensityTimesVolume)
{
   mfem::Mesh mesh = rectangle_mesh(uniform(1, 3, 4), uniform(0, 0.5, 2));
   for (const int order : {1, 2, 3})
   {
      ElasticBody plane(mesh, order, steel);
      EXPECT_NEAR(mass_along_last(plane, mass_matrix(plane, {density})), density * 2 * 0.5,
                  1e-12);
      ElasticBody ring(mesh, order, steel, Formulation::axisymmetric);
      EXPECT_NEAR(mass_along_last(ring, mass_matrix(ring, {density})),
                  density * pi * (9 - 1) * 0.5, 1e-11);
   }
   ElasticBody plane(mesh, 2, steel);
   EXPECT_THROW(mass_matrix(plane, {1, 2}), InputError);
   EXPECT_THROW(mass_matrix(plane, {-1}), InputError);
   ElasticBody turning(mesh, 2, steel, Formulation::torsion);
   EXPECT_THROW(mass_matrix(turning, {1}), InputError);
}

/// A column 0 < x < 1 in two parts, one on the other at y = 1, pressed together by friction.
struct Column
{
   std::vector<mfem::Mesh> meshes;
   std::vector<std::unique_ptr<ElasticBody>> bodies;
   Reduction reduction;
   ContactState state;

   explicit Column(bool held, Formulation formulation = Formulation::plane,
                   double friction = 0.8)
   {
      const double inner = formulation == Formulation::plane ? 0 : 2;
      meshes.push_back(rectangle_mesh(uniform(inner, inner + 1, 4), uniform(0, 1, 3)));
      meshes.push_back(rectangle_mesh(uniform(inner, inner + 1, 4), uniform(1, 2.5, 4)));
      std::vector<NamedBody> named;
      for (mfem::Mesh &mesh : meshes)
      {
         bodies.push_back(std::make_unique<ElasticBody>(mesh, 2, steel, formulation));
         named.push_back({"part " + std::to_string(bodies.size()), bodies.back().get()});
      }
      bodies[1]->add_pressure("P", top, 1e-3);
      if (held)
      {
         for (const int c : {0, 1}) { bodies[0]->fix(bottom, c); }
      }
      else { bodies[0]->add_pressure("P", bottom, 1e-3); }
      reduction = reduce(named, {BoundaryInterface{"joint", {0, top}, {1, bottom}}});
      set_friction(reduction.problem, friction);
      state = ContactState::virgin(reduction.problem);
      const MarchReport report = march(
         reduction.problem, LoadHistory::through(reduction.problem, {{}, {{"P", 1}}}), state);
      EXPECT_EQ(report.status, FrictionStatus::converged) << report.message;
   }
   VibratingStructure structure()
   {
      std::vector<VibratingBody> all;
      for (const auto &body : bodies) { all.push_back(vibrating_body(*body, {density})); }
      return {reduction, std::move(all)};
   }
};

/// The squares of the frequencies of one body, by a dense method.
VectorXd squares_of_one(ElasticBody &body)
{
   const SharedMatrix K = body.shared_stiffness(), M = mass_matrix(body, {density});
   const mfem::Array<int> fixed = body.essential_dofs();
   std::vector<int> free;
   for (int dof = 0; dof < K.size(); ++dof)
   {
      if (fixed.Find(dof) < 0) { free.push_back(dof); }
   }
   const MatrixXd dense_K = MatrixXd(K.view())(free, free),
                  dense_M = MatrixXd(M.view())(free, free);
   return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(dense_K, dense_M,
                                                             Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Two parts whose nodes are all glued are one body.
TEST(Modes, AreThoseOfOneBodyIfAllIsGlued)
{
   for (const Formulation formulation : {Formulation::plane, Formulation::axisymmetric})
   {
      for (const bool held : {true, false})
      {
         SCOPED_TRACE(std::string(name(formulation)) + (held ? ", held" : ", free"));
         Column column(held, formulation);
         const VibratingStructure structure = column.structure();
         const GluedRows glued = glued_rows(column.reduction.problem, column.state);
         EXPECT_EQ(std::count(glued.begin(), glued.end(), false), 0);
         const Modes modes = structure.modes(glued, 5);
         const double inner = formulation == Formulation::plane ? 0 : 2;
         mfem::Mesh whole = rectangle_mesh(uniform(inner, inner + 1, 4),
                                           {0, 1.0 / 3, 2.0 / 3, 1, 1.375, 1.75, 2.125, 2.5});
         ElasticBody one(whole, 2, steel, formulation);
         if (held)
         {
            for (const int c : {0, 1}) { one.fix(bottom, c); }
         }
         const VectorXd squares = squares_of_one(one);
         // Three rigid motions in the plane, one about an axis.
         const int rigid = held ? 0 : formulation == Formulation::plane ? 3 : 1;
         EXPECT_EQ(modes.rigid, rigid);
         for (Index k = 0; k < 5; ++k)
         {
            EXPECT_NEAR(std::pow(modes.omega[k], 2), squares[rigid + k],
                        1e-8 * squares[rigid + k]);
            EXPECT_LT(modes.residuals[k], 1e-7);
         }
         EXPECT_NEAR(structure.mass(),
                     density * 2.5 * (formulation == Formulation::plane ? 1 : pi * (9 - 4)),
                     1e-10);
         // Orthogonal to each other, of unit mass.
         for (Index i = 0; i < 5; ++i)
         {
            for (Index j = 0; j <= i; ++j)
            {
               double product = 0;
               for (std::size_t b = 0; b < 2; ++b)
               {
                  const SharedMatrix M = mass_matrix(*column.bodies[b], {density});
                  product += modes.shapes[i][b].dot(M.view() * modes.shapes[j][b]);
               }
               EXPECT_NEAR(product, i == j, 1e-9);
            }
         }
      }
   }
}

/// A steady loop in which no node slips swings with the frequency of the glued mode.
TEST(Modes, LoopWithoutSlipHasTheFrequencyOfTheMode)
{
   for (const Formulation formulation : {Formulation::plane, Formulation::axisymmetric})
   {
      for (const bool held : {true, false})
      {
         SCOPED_TRACE(std::string(name(formulation)) + (held ? ", held" : ", free"));
         Column column(held, formulation);
         const VibratingStructure structure = column.structure();
         const Modes modes =
            structure.modes(glued_rows(column.reduction.problem, column.state), 3);
         const ReducedProblem problem = structure.with_modes(modes);
         const ContactState state = structure.with_modes(modes, column.state);
         FrictionSolver solver(problem);
         for (int k = 0; k < 3; ++k)
         {
            const ModalLoop loop = modal_loop(
               solver, problem, state, "mode " + std::to_string(k + 1), modes.omega[k], 1e-7);
            ASSERT_EQ(loop.status, FrictionStatus::converged) << loop.message;
            EXPECT_TRUE(loop.steady) << loop.message;
            EXPECT_NEAR(loop.omega_secant, modes.omega[k], 1e-6 * modes.omega[k]);
            EXPECT_NEAR(loop.omega, modes.omega[k], 1e-6 * modes.omega[k]);
            EXPECT_LT(loop.zeta, 1e-9);
         }
      }
   }
}

/// Closed nodes without friction slide: the parts move freely along their interface.
TEST(Modes, SlideWithoutFriction)
{
   Column column(true, Formulation::plane, 0);
   const GluedRows glued = glued_rows(column.reduction.problem, column.state);
   const Index n = column.reduction.problem.nodes();
   for (Index i = 0; i < n; ++i)
   {
      EXPECT_FALSE(glued[i]);
      EXPECT_TRUE(glued[n + i]);
   }
   // The upper part moves along the joint as a rigid body.
   EXPECT_EQ(column.structure().modes(glued, 2).rigid, 1);
}

/// A slender bar that is free to widen swings along its axis as the closed form says.
TEST(Modes, BarAlongItsAxis)
{
   mfem::Mesh low = rectangle_mesh(uniform(0, 0.02, 1), uniform(0, 0.5, 8));
   mfem::Mesh high = rectangle_mesh(uniform(0, 0.02, 1), uniform(0.5, 1, 8));
   const Material bar{2.0, 0.0};
   ElasticBody a(low, 2, bar), b(high, 2, bar);
   for (ElasticBody *each : {&a, &b}) { each->fix(BoundaryPart(right), 0); }
   for (ElasticBody *each : {&a, &b}) { each->fix(BoundaryPart(left), 0); }
   a.fix(bottom, 1);
   b.add_pressure("P", top, 1e-3);
   Reduction reduction =
      reduce({{"low", &a}, {"high", &b}}, {BoundaryInterface{"joint", {0, top}, {1, bottom}}});
   set_friction(reduction.problem, 0.3);
   ContactState state = ContactState::virgin(reduction.problem);
   march(reduction.problem, LoadHistory::through(reduction.problem, {{}, {{"P", 1}}}), state);
   const VibratingStructure structure(
      reduction, {vibrating_body(a, {density}), vibrating_body(b, {density})});
   const Modes modes = structure.modes(glued_rows(reduction.problem, state), 2);
   for (int k = 0; k < 2; ++k)
   {
      const double exact = (2 * k + 1) * pi / 2 * std::sqrt(2.0 / density);
      EXPECT_NEAR(modes.omega[k], exact, 1e-5 * exact);
      // The mass that takes part is 8/π²/(2k + 1)² of the whole.
      const double share = 8 / std::pow(pi * (2 * k + 1), 2);
      EXPECT_NEAR(modes.effective_mass(k, 1) / structure.mass(), share, 1e-4);
   }
}

/// The loads of modes are those of the same forces before the reduction.
TEST(Modes, LoadsAreThoseOfTheForces)
{
   Column column(true);
   const VibratingStructure structure = column.structure();
   const Modes modes = structure.modes(glued_rows(column.reduction.problem, column.state), 2);
   const ReducedProblem problem = structure.with_modes(modes);
   std::vector<NamedBody> named;
   for (std::size_t b = 0; b < 2; ++b)
   {
      const SharedMatrix M = mass_matrix(*column.bodies[b], {density});
      for (int k = 0; k < 2; ++k)
      {
         column.bodies[b]->add_forces("mode " + std::to_string(k + 1),
                                      to_mfem(M.view() * modes.shapes[k][b]));
      }
      named.push_back({"part " + std::to_string(b + 1), column.bodies[b].get()});
   }
   const ReducedProblem direct =
      reduce(named, {BoundaryInterface{"joint", {0, top}, {1, bottom}}}).problem;
   ASSERT_EQ(problem.patterns.size(), direct.patterns.size());
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const LoadPattern &made = problem.patterns[k];
      const int its = direct.pattern(made.name);
      const LoadPattern &expected = direct.patterns[its];
      EXPECT_LT((made.q - expected.q).norm(), 1e-9 * expected.q.norm() + 1e-12) << made.name;
      EXPECT_LT((made.p - expected.p).norm(), 1e-9 * expected.p.norm() + 1e-12) << made.name;
      for (std::size_t l = 0; l < problem.patterns.size(); ++l)
      {
         const int other = direct.pattern(problem.patterns[l].name);
         EXPECT_NEAR(problem.H(static_cast<Index>(k), static_cast<Index>(l)),
                     direct.H(its, other), 1e-9 * direct.H.norm())
            << made.name << ", " << problem.patterns[l].name;
      }
   }
}

} // namespace
