#include "elastic_support.hpp"

namespace
{

using namespace cattaneo;
using namespace support;

// Held bodies are springs in series, (S1⁻¹ + S2⁻¹)⁻¹: with twice as many digits.
TEST(Reduction, StiffnessContrastsCostNoDigits)
{
   using Exact = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
   const std::vector<double> x = uniform(0, 2, 6);
   mfem::Mesh upper = rectangle_mesh(x, uniform(0, 1, 4)),
              lower = rectangle_mesh(x, uniform(-2, 0, 4));
   for (double c : {1e-8, 1.0, 1e8})
   {
      ElasticBody one(upper, 2, Material{1.0, 0.3}), other(lower, 2, Material{c, 0.2});
      for (int component : {0, 1})
      {
         one.fix(3, component);
         other.fix(1, component);
      }
      one.add_traction("Q", 2, 0.3, [](double, double y) { return y; });
      const CondensedBody above = condense(one, contact_line(one, 1)),
                          below = condense(other, contact_line(other, 3));
      const Eigen::Index n = above.line.size();
      std::vector<Eigen::Index> reversed;
      for (Eigen::Index k = 0; k < 2 * n; ++k)
      {
         reversed.push_back(k < n ? n - 1 - k : 3 * n - 1 - k);
      }
      const Exact S1 = above.S.cast<long double>(),
                  S2 = below.S(reversed, reversed).cast<long double>();
      const Exact S = (S1.inverse() + S2.inverse()).inverse(), way = S * S1.inverse();
      VectorXd f(2 * n);
      f << above.patterns[0].q, above.patterns[0].p;
      f = (way * f.cast<long double>()).cast<double>();
      const ReducedProblem first =
                              reduce(above, below, pair_lines(above.line, below.line)).problem,
                           second =
                              reduce(below, above, pair_lines(below.line, above.line)).problem;
      EXPECT_LT(difference(first.K, S.cast<double>()), 1e-13) << c;
      EXPECT_LT(difference(second.K(reversed, reversed), S.cast<double>()), 1e-13) << c;
      VectorXd of_first(2 * n), of_second(2 * n);
      of_first << first.patterns[0].q, first.patterns[0].p;
      of_second << second.patterns[0].q, second.patterns[0].p;
      EXPECT_LT(difference(of_first, f), 1e-13) << c;
      EXPECT_LT(difference(of_second(reversed), f), 1e-13) << c;
   }
}

/// The upper of two blocks pressed onto the lower one, which is held if told so, as it is
/// given.
Reduction stacked(double above, double below, bool held_above, bool held_below,
                  bool lower_first, double poisson = 0.3)
{
   mfem::Mesh up = rectangle_mesh(uniform(0, 2, 4), uniform(0, 1, 2)),
              down = rectangle_mesh(uniform(0, 2, 4), uniform(-1, 0, 2));
   ElasticBody upper(up, 2, Material{above, 0.3}), lower(down, 2, Material{below, poisson});
   for (int c : {0, 1})
   {
      if (held_above) { upper.fix(3, c); }
      if (held_below) { lower.fix(1, c); }
   }
   // Shear of two free bodies would turn them.
   const double shear = held_above || held_below ? 0.3 : 0.0;
   if (!held_above) { upper.add_traction("press", 3, shear, -1.0); }
   if (!held_below) { lower.add_traction("press", 1, -shear, 1.0); }
   const CondensedBody a = condense(upper, contact_line(upper, 1)),
                       b = condense(lower, contact_line(lower, 3));
   return lower_first ? reduce(b, a, pair_lines(b.line, a.line))
                      : reduce(a, b, pair_lines(a.line, b.line));
}

TEST(Reduction, KnowsTheRigidMotionsOfEitherBody)
{
   // One of them or both are free, which of them is the first or the stiffer does not matter.
   for (const double stiff : {1.0, 1e8, 1e-8})
   {
      for (const auto &[above, below, count] :
           {std::tuple(false, true, 3), {true, false, 3}, {false, false, 3}, {true, true, 0}})
      {
         if (!above && !below && stiff != 1) { continue; }
         for (const bool lower_first : {false, true})
         {
            const Reduction reduction = stacked(stiff, 1, above, below, lower_first);
            const ReducedProblem &problem = reduction.problem;
            EXPECT_NO_THROW(problem.validate());
            const MatrixXd &Z = problem.rigid_motions, &K = problem.K;
            ASSERT_EQ(Z.cols(), count);
            if (count == 0) { continue; }
            EXPECT_LT((K * Z).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
            // Relative translations are among them, and the resultants are those of the load.
            const Eigen::Index n = problem.nodes();
            VectorXd along = VectorXd::Zero(2 * n), across = along;
            along.head(n).setOnes();
            across.tail(n).setOnes();
            for (const VectorXd &x : {along, across})
            {
               EXPECT_LT((x - Z * (Z.transpose() * x)).norm(), 1e-12 * x.norm());
            }
            // Tractions of 1 and, of a single free body, 0.3 on a length of 2.
            const LoadPattern &load = problem.patterns[0];
            EXPECT_NEAR(load.p.sum(), 2, 1e-12);
            EXPECT_NEAR(std::abs(load.q.sum()), above || below ? 0.6 : 0.0, 1e-12);
         }
      }
   }
}

TEST(Reduction, CouplingIsExactlyZeroForMirrorImagesOnly)
{
   const ReducedProblem mirror = stacked(1, 1, true, true, false).problem;
   EXPECT_FALSE(mirror.coupled);
   const double other = stacked(1, 1, true, true, false, 0.2).problem.B().cwiseAbs().maxCoeff();
   for (const double change : {1e-6, 1e-8})
   {
      // The coupling grows with the difference of the two, from zero.
      const ReducedProblem near = stacked(1, 1, true, true, false, 0.3 - change).problem;
      EXPECT_TRUE(near.coupled) << change;
      EXPECT_GT(near.B().cwiseAbs().maxCoeff(), 0.1 * other * change / 0.1);
      EXPECT_LT(near.B().cwiseAbs().maxCoeff(), 10 * other * change / 0.1);
   }
}

} // namespace
