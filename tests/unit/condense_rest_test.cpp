#include "elastic_support.hpp"

namespace
{

using namespace cattaneo;
using namespace support;
using Backend = SparseFactor::Backend;

TEST(Condensation, FreeBodyHasExactlyItsThreeRigidMotions)
{
   for (const char *kind : {"quads", "triangles", "nonconforming", "curved"})
   {
      mfem::Mesh mesh = block(kind, 8, 6);
      // Rotations are in the space if its order is not below that of the mesh (3 if curved).
      ElasticBody body(mesh, 3, Material{1.0, 0.3});
      const CondensedBody condensed = condense(body, contact_line(body, 1));
      const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(condensed.S);
      const VectorXd values = modes.eigenvalues() / modes.eigenvalues().tail(1)[0];
      EXPECT_LT(values.head(3).cwiseAbs().maxCoeff(), 1e-12) << kind;
      EXPECT_GT(values[3], 1e-4) << kind;
      // The motions themselves are in the null space, and independent.
      const MatrixXd Z = condensed.rigid_motions();
      EXPECT_LT((condensed.S * Z).cwiseAbs().maxCoeff(),
                1e-12 * condensed.S.cwiseAbs().maxCoeff());
      EXPECT_EQ(Eigen::ColPivHouseholderQR<MatrixXd>(Z).rank(), 3);
   }
}

TEST(Condensation, SupportsOfASmallLeverHoldNevertheless)
{
   // Along x at two points of the height 0 or `lever`, along y at a third: what can turn is
   // held by the lever alone.
   for (const double lever : {1e-4, 0.0})
   {
      mfem::Mesh mesh = rectangle_mesh({0, 0.5, 1}, {0, 1e-4, 1});
      ElasticBody body(mesh, 1, Material{});
      body.fix_node(0, 0, 0);
      body.fix_node(1, 0, 1);
      body.fix_node(0.5, lever, 0);
      EXPECT_EQ(condense(body, contact_line(body, 3)).rigid_modes, lever > 0 ? 0 : 1);
   }
}

TEST(Condensation, RefusesASeparatePartThatNothingHolds)
{
   // Two blocks that share no node, contact on the lower left one only.
   mfem::Mesh mesh(2, 8, 2, 8);
   for (double x0 : {0.0, 3.0})
   {
      mesh.AddVertex(x0, 0.0);
      mesh.AddVertex(x0 + 1, 0.0);
      mesh.AddVertex(x0 + 1, 1.0);
      mesh.AddVertex(x0, 1.0);
   }
   for (int k : {0, 4})
   {
      mesh.AddQuad(k, k + 1, k + 2, k + 3);
      for (int i = 0; i < 4; ++i) { mesh.AddBdrSegment(k + i, k + (i + 1) % 4, k + i + 1); }
   }
   mesh.FinalizeQuadMesh(1, 0, true);
   ElasticBody body(mesh, 2, Material{});
   expect_input_error([&] { condense(body, contact_line(body, 1)); }, "separate part");
   const CondensedBody both = condense(body, contact_line(body, BoundaryPart({1, 5})));
   EXPECT_EQ(both.rigid_modes, 6);
   EXPECT_EQ(both.S.topRightCorner(3, 3).rows(), 3);
}

TEST(Condensation, ASlightlyStifferBodyFactorsItsOwn)
{
   // Stiffnesses that differ by 1e-8, all or one entry of them, are not equal; those that
   // differ by round-off are.
   mfem::Mesh mesh = block("quads");
   const ElasticBody isotropic(mesh, 2, Material{});
   const auto condensed =
      [&](double factor, int entry, const BoundaryPart &touching, const CondensedBody *alike)
   {
      mfem::SparseMatrix K(isotropic.stiffness());
      if (entry < 0) { K *= factor; }
      else { K(entry, entry) *= factor; }
      ElasticBody body(isotropic.space(), K);
      body.fix(3, 0);
      body.fix(3, 1);
      return condense(body, contact_line(body, touching), {}, alike);
   };
   const CondensedBody first = condensed(1, -1, 1, nullptr);
   const auto shares = [](const CondensedBody &other)
   {
      EXPECT_LE(other.counters.factorisations, 1);
      return other.counters.factorisations == 0;
   };
   // The stiffest diagonal entry, and the stiffness along x of a corner.
   int stiffest = 0;
   for (int i = 0; i < isotropic.stiffness().Height(); ++i)
   {
      if (isotropic.stiffness()(i, i) > isotropic.stiffness()(stiffest, stiffest))
      {
         stiffest = i;
      }
   }
   EXPECT_TRUE(shares(condensed(1, -1, 1, &first)));
   EXPECT_TRUE(shares(condensed(1 + 2e-16, stiffest, 1, &first)));
   for (const double factor : {1 + 1e-8, 1 - 1e-8, 2.0})
   {
      const CondensedBody stiffer = condensed(factor, -1, 1, &first);
      EXPECT_FALSE(shares(stiffer)) << factor;
      EXPECT_LT(difference(stiffer.S, factor * first.S), 1e-13);
      EXPECT_FALSE(shares(condensed(factor, stiffest, 1, &first)));
      EXPECT_FALSE(shares(condensed(factor, 0, 1, &first)));
   }
   // The same stiffness and supports, but other contact nodes: fewer, as many, and reversed.
   EXPECT_FALSE(shares(condensed(1, -1, {{1}, 0, 0.0, 1.5}, &first)));
   EXPECT_FALSE(shares(condensed(1, -1, {{1, 2}, 1, 0.0, 0.7}, &first)));
   const CondensedBody left = condensed(1, -1, {{1}, 0, 0.0, 1.5}, nullptr),
                       right = condensed(1, -1, {{1}, 0, 0.5, 2.0}, &left);
   EXPECT_EQ(right.S.rows(), left.S.rows());
   EXPECT_FALSE(shares(right));
   // In torsion a shorter line of the same first nodes is the beginning of the longer one.
   const ElasticBody shaft(mesh, 2, Material{}, Formulation::torsion);
   const auto twisted = [&](double to, const CondensedBody *alike) {
      return condense(shaft, contact_line(shaft, {{1}, 0, 0.0, to}), {}, alike);
   };
   const CondensedBody all = twisted(2.0, nullptr);
   EXPECT_TRUE(shares(twisted(2.0, &all)));
   EXPECT_FALSE(shares(twisted(1.0, &all)));
   EXPECT_LT(difference(right.S, condensed(1, -1, {{1}, 0, 0.5, 2.0}, nullptr).S), 1e-15);
}

TEST(Condensation, ElasticFoundationInAUsersOperatorIsASupport)
{
   mfem::Mesh mesh = block("quads");
   mfem::H1_FECollection collection(1, 2);
   mfem::FiniteElementSpace space(&mesh, &collection, 2);
   mfem::ConstantCoefficient one(1.0);
   for (bool founded : {false, true})
   {
      mfem::BilinearForm form(&space);
      form.AddDomainIntegrator(new mfem::ElasticityIntegrator(one, one));
      if (founded) { form.AddDomainIntegrator(new mfem::VectorMassIntegrator(one)); }
      form.Assemble();
      form.Finalize();
      const ElasticBody body(space, form.SpMat());
      EXPECT_EQ(condense(body, contact_line(body, 1)).rigid_modes, founded ? 0 : 3);
   }
}

TEST(Condensation, NamesTheNodeWhereTheOperatorIsNotPositiveDefinite)
{
   mfem::Mesh mesh = block("quads");
   ElasticBody good(mesh, 1, Material{});
   mfem::SparseMatrix K(good.stiffness());
   const int node = 12, dof = good.true_dof(node, 1);
   K(dof, dof) = -1.0;
   mfem::H1_FECollection collection(1, 2);
   mfem::FiniteElementSpace space(&mesh, &collection, 2, mfem::Ordering::byVDIM);
   ElasticBody body(space, K);
   const ContactLine line = contact_line(body, 1);
   expect_input_error([&] { condense(body, line); }, "not positive definite");
}

TEST(SparseFactor, NamesTheBadRow)
{
   mfem::SparseMatrix K(6);
   for (int i = 0; i < 6; ++i) { K.Add(i, i, i == 4 ? -2.0 : 1.0); }
   K.Finalize();
   for (auto backend : {Backend::automatic, Backend::eigen})
   {
      try
      {
         SparseFactor(view(K), {5, 4, 3, 2, 1}, 2, 0.0, backend);
         ADD_FAILURE();
      }
      catch (const NotPositiveDefinite &error)
      {
         EXPECT_EQ(error.row, 4);
      }
      EXPECT_THROW(SparseFactor(view(K), {0, 0}, 0, 0.0, backend), InputError);
      EXPECT_THROW(SparseFactor(view(K), {7}, 0, 0.0, backend), InputError);
      EXPECT_THROW(SparseFactor(view(K), {}, 0, 0.0, backend), InputError);
      EXPECT_THROW(SparseFactor(view(K), {0}, 2, 0.0, backend), InputError);
      EXPECT_THROW(SparseFactor(view(K), {0}, 0, std::nan(""), backend), InputError);
   }
}

TEST(SparseFactor, SaysWhatIsWrongWithItsInput)
{
   mfem::SparseMatrix K(4), oblong(2, 3), singular(4), broken(4), open(4);
   for (int i = 0; i < 4; ++i)
   {
      K.Add(i, i, 1.0 + i);
      singular.Add(i, i, i == 2 ? 0.0 : 1.0);
      broken.Add(i, i, i == 2 ? std::nan("") : 1.0);
   }
   oblong.Add(0, 0, 1.0);
   for (mfem::SparseMatrix *matrix : {&K, &oblong, &singular, &broken}) { matrix->Finalize(0); }
   for (auto backend : {Backend::automatic, Backend::eigen})
   {
      const auto refused = [&](const mfem::SparseMatrix &matrix, const std::vector<int> &keep,
                               int trailing, double shift, const char *said)
      {
         expect_input_error([&] { SparseFactor(view(matrix), keep, trailing, shift, backend); },
                            said);
      };
      refused(K, {0, 4}, 0, 0, "row 4 to keep, must be from 0 to 3");
      refused(K, {-1}, 0, 0, "row -1 to keep, must be from 0 to 3");
      refused(K, {1, 2, 1}, 0, 0, "row 1 is in the list of rows to keep twice");
      refused(K, {0}, -1, 0, "-1 trailing rows, must be from 0 to 1");
      refused(K, {0}, 1, -1, "shift is -1");
      refused(oblong, {0}, 0, 0, "the matrix (2×3) must be square");
      refused(open, {0}, 0, 0, "the matrix (4×4) is not finalized");
      refused(broken, {1, 2}, 0, 0, "entry (2, 2) of the matrix is nan");
      EXPECT_NO_THROW(SparseFactor(view(broken), {1, 3}, 0, 0, backend));
      // Without stiffness is not positive either.
      try
      {
         SparseFactor(view(singular), {3, 1, 0, 2}, 1, 0.0, backend);
         ADD_FAILURE();
      }
      catch (const NotPositiveDefinite &error)
      {
         EXPECT_EQ(error.row, 2);
      }
      EXPECT_NEAR(SparseFactor(view(singular), {3, 1, 0, 2}, 1, 0.5, backend).schur()(0, 0), 0,
                  1e-15);
      const SparseFactor factor(view(K), {2, 3}, 1, 0, backend);
      expect_input_error([&] { factor.solve(MatrixXd::Ones(3, 1)); },
                         "right-hand sides have 3 rows, must have as many as the factor, 2");
      EXPECT_LT((factor.solve(MatrixXd::Ones(2, 1)) - Eigen::Vector2d(1.0 / 3, 0.25)).norm(),
                1e-15);
   }
}

} // namespace
