#include "elastic_support.hpp"

#include <functional>
#include <numeric>

namespace
{

using namespace cattaneo;
using namespace support;

using Long = long double;
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

/// What a body consists of: Young's modulus by the centre of an element.
using Modulus = std::function<double(double x, double y)>;

enum class Held
{
   nowhere,
   below,
   at_its_end ///< x = 3; the contact ends at x = 2 then
};

/// A rectangle of bilinear elements, [0, 3] × [0, 2], contact at the top.
struct Rectangle
{
   mfem::Mesh mesh = rectangle_mesh(uniform(0, 3, 12), uniform(0, 2, 8));
   std::vector<Material> materials;

   explicit Rectangle(const Modulus &modulus, double poisson = 0.3)
   {
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mfem::Vector centre(2);
         mesh.GetElementCenter(e, centre);
         mesh.SetAttribute(e, e + 1);
         materials.push_back({modulus(centre(0), centre(1)), poisson});
      }
      mesh.SetAttributes();
   }
   CondensedBody condensed(Held held)
   {
      ElasticBody body(mesh, 1, materials);
      for (int c : {0, 1})
      {
         if (held == Held::below) { body.fix(1, c); }
         if (held == Held::at_its_end) { body.fix(2, c); }
      }
      return condense(body, contact_line(body, {{3}, 0, 0.0, contact_end(held)}));
   }

   static double contact_end(Held held) { return held == Held::at_its_end ? 2.0 : 3.0; }

   /// The same stiffness, assembled and condensed in extended precision, in global components
   /// {x; y} of the nodes along the top from the right to the left.
   LongMatrix exact(Held held)
   {
      const int n = mesh.GetNV();
      LongMatrix K = LongMatrix::Zero(2 * n, 2 * n);
      for (int e = 0; e < mesh.GetNE(); ++e)
      {
         mfem::Array<int> v;
         mesh.GetElementVertices(e, v);
         const Long hx = Long(mesh.GetVertex(v[1])[0]) - mesh.GetVertex(v[0])[0];
         const Long hy = Long(mesh.GetVertex(v[3])[1]) - mesh.GetVertex(v[0])[1];
         const Long E = materials[e].young, nu = materials[e].poisson;
         const Long lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
         const Long g = 1 / std::sqrt(Long(3));
         for (const Long s : {-g, g})
         {
            for (const Long t : {-g, g})
            {
               const Long sx[] = {-1, 1, 1, -1}, sy[] = {-1, -1, 1, 1};
               Long dx[4], dy[4];
               for (int a = 0; a < 4; ++a)
               {
                  dx[a] = sx[a] * (1 + sy[a] * t) / (2 * hx);
                  dy[a] = sy[a] * (1 + sx[a] * s) / (2 * hy);
               }
               const Long w = hx * hy / 4;
               for (int a = 0; a < 4; ++a)
               {
                  for (int b = 0; b < 4; ++b)
                  {
                     K(v[a], v[b]) +=
                        w * ((lambda + 2 * mu) * dx[a] * dx[b] + mu * dy[a] * dy[b]);
                     K(n + v[a], n + v[b]) +=
                        w * ((lambda + 2 * mu) * dy[a] * dy[b] + mu * dx[a] * dx[b]);
                     const Long mixed = w * (lambda * dx[a] * dy[b] + mu * dy[a] * dx[b]);
                     K(v[a], n + v[b]) += mixed;
                     K(n + v[b], v[a]) += mixed;
                  }
               }
            }
         }
      }
      std::vector<int> in, contact, top;
      for (int i = 0; i < n; ++i)
      {
         const double x = mesh.GetVertex(i)[0], y = mesh.GetVertex(i)[1];
         if ((held == Held::below && y == 0) || (held == Held::at_its_end && x == 3))
         {
            continue;
         }
         if (y == 2 && x <= contact_end(held)) { top.push_back(i); }
         else { in.insert(in.end(), {i, n + i}); }
      }
      std::sort(top.begin(), top.end(),
                [&](int a, int b) { return mesh.GetVertex(a)[0] > mesh.GetVertex(b)[0]; });
      contact = top;
      for (int i : top) { contact.push_back(n + i); }
      const LongMatrix inner = K(in, in);
      return K(contact, contact) -
             K(contact, in) * inner.llt().solve(LongMatrix(K(in, contact)));
   }
};

/// Largest |uᵀ (S - S*) u| / uᵀ S* u of motions that S* resists.
double energy_error(const MatrixXd &S, const LongMatrix &exact, Held held)
{
   const Eigen::Index m = S.rows(), n = m / 2;
   LongMatrix Q(m, held == Held::nowhere ? 3 : 0);
   if (held == Held::nowhere)
   {
      // Translations, and the rotation about the middle of a straight line.
      Q.setZero();
      Q.col(0).head(n).setConstant(1);
      Q.col(1).tail(n).setConstant(1);
      Q.col(2).tail(n) = Eigen::VectorXd::LinSpaced(n, -1, 1).cast<Long>();
      for (int k = 0; k < 3; ++k) { Q.col(k) /= Q.col(k).norm(); }
   }
   const LongMatrix M = exact + exact.trace() / m * Q * Q.transpose();
   const Eigen::LLT<LongMatrix> L(M);
   EXPECT_EQ(L.info(), Eigen::Success);
   LongMatrix D = S.cast<Long>() - exact;
   D -= (Q * (Q.transpose() * D)).eval();
   D -= ((D * Q) * Q.transpose()).eval();
   L.matrixL().solveInPlace(D);
   LongMatrix E = D.transpose();
   L.matrixL().solveInPlace(E);
   return static_cast<double>(
      Eigen::SelfAdjointEigenSolver<LongMatrix>(E).eigenvalues().cwiseAbs().maxCoeff());
}

/// In global components: the line at the top of a body runs to -x with the normal -y.
MatrixXd global(const CondensedBody &body)
{
   return body.S; // both components change their sign
}

TEST(StiffnessError, BoundsTheErrorAgainstExtendedPrecision)
{
   const auto layers = [](double top, double bottom)
   { return [=](double, double y) { return y > 1 ? top : bottom; }; };
   const auto strips = [](double contrast)
   { return [=](double x, double) { return x > 1.5 ? contrast : 1.0; }; };
   const auto inclusion = [](double contrast)
   {
      return [=](double x, double y)
      { return std::abs(x - 1.5) < 0.6 && y > 0.6 && y < 1.4 ? contrast : 1.0; };
   };
   std::vector<double> ratios;
   for (const double contrast : {1.0, 1e4, 1e8, 1e12})
   {
      const std::pair<const char *, Modulus> scenes[] = {{"stiff on soft", layers(contrast, 1)},
                                                         {"soft on stiff", layers(1, contrast)},
                                                         {"side by side", strips(contrast)},
                                                         {"inclusion", inclusion(contrast)}};
      for (const auto &[name, modulus] : scenes)
      {
         for (const Held held : {Held::nowhere, Held::below, Held::at_its_end})
         {
            SCOPED_TRACE(std::string(name) + ", held " + std::to_string(int(held)));
            Rectangle block(modulus);
            CondensedBody condensed = block.condensed(held);
            const double error = energy_error(global(condensed), block.exact(held), held);
            const double estimate = condensed.error_estimate();
            EXPECT_LE(error, estimate);
            if (estimate > 1e-12) { ratios.push_back(std::log(estimate / error)); }
            if (contrast == 1) { EXPECT_LE(estimate, 1e-12); }
         }
      }
   }
   // Sharp on the whole: 8 of the random vectors, and what of the assembly's worst case did not
   // happen. The error of one scene may be small by luck.
   const double mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / ratios.size();
   EXPECT_LE(std::exp(mean), 100);
}

TEST(StiffnessError, BoundsTheErrorOfLayersInSeries)
{
   // Without lateral contraction a uniform push meets 1/Σ h/E over the width of 3.
   for (const double contrast : {1.0, 1e6, 1e12})
   {
      for (const bool stiff_top : {true, false})
      {
         const double top = stiff_top ? contrast : 1, bottom = stiff_top ? 1 : contrast;
         Rectangle block([=](double, double y) { return y > 1 ? top : bottom; }, 0);
         CondensedBody condensed = block.condensed(Held::below);
         const Eigen::Index n = condensed.line.size();
         const double stiffness = condensed.S.bottomRightCorner(n, n).sum();
         const double error = std::abs(stiffness * (1 / top + 1 / bottom) / 3 - 1);
         EXPECT_LE(error, condensed.error_estimate()) << contrast;
      }
   }
}

} // namespace
