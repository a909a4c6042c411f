// Free bodies above rigid lines, straight and curved, that touch at one node and must tip, roll
// or turn until others hold them. Every increment is verified.

#include "contact_laws.hpp"

#include <cattaneo/friction/march.hpp>
#include <gtest/gtest.h>
#include <random>

namespace
{

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// The motions of the plane in the frames of nodes on an arc of this curvature about the
/// origin.
MatrixXd motions_on_arc(const VectorXd &s, double curvature)
{
   const auto n = s.size();
   MatrixXd motions(2 * n, 3);
   for (Eigen::Index j = 0; j < n; ++j)
   {
      const double angle = curvature * s[j];
      const Vector2d place(s[j], -0.5 * curvature * s[j] * s[j]),
         tangent(std::cos(angle), -std::sin(angle)), normal(std::sin(angle), std::cos(angle)),
         turned(-place[1], place[0]);
      motions.row(j) << tangent[0], tangent[1], turned.dot(tangent);
      motions.row(n + j) << normal[0], normal[1], turned.dot(normal);
   }
   return Eigen::HouseholderQR<MatrixXd>(motions).householderQ() * MatrixXd::Identity(2 * n, 3);
}

/// Three to eight nodes, one of which touches; pressed within their hull by P, drawn along by
/// Q.
ReducedProblem resting_on_one_node(double curvature, double coupling, unsigned seed)
{
   std::mt19937 random(seed);
   std::normal_distribution<double> normal;
   std::uniform_real_distribution<double> uniform(0, 1);
   const int n = 3 + static_cast<int>(seed % 6);
   const auto any = [&](int rows, int columns)
   { return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); })); };
   ReducedProblem problem;
   const MatrixXd motions = motions_on_arc(VectorXd::LinSpaced(n, -0.5, 0.5), curvature),
                  free = MatrixXd::Identity(2 * n, 2 * n) - motions * motions.transpose(),
                  W = any(2 * n, 2 * n);
   MatrixXd K =
      free * (MatrixXd::Identity(2 * n, 2 * n) + coupling / n * W * W.transpose()) * free;
   K = (K + K.transpose()).eval() / 2;
   // The motions are found again, as far as round-off lets them.
   problem.set_stiffness(K.topLeftCorner(n, n), K.bottomLeftCorner(n, n),
                         K.bottomRightCorner(n, n));
   EXPECT_EQ(problem.rigid_motions.cols(), 3);
   EXPECT_LT((problem.K * problem.rigid_motions).norm(), 1e-13 * problem.K.norm());
   const VectorXd pressing = (0.2 * any(n, 1).array() + 1).cwiseMax(0.05);
   problem.patterns = {{"P", Control::force, VectorXd::Zero(n), pressing},
                       {"Q", Control::force, VectorXd::Ones(n), VectorXd::Zero(n)}};
   problem.H = MatrixXd::Zero(2, 2);
   problem.gap = VectorXd::NullaryExpr(n, [&] { return uniform(random); });
   problem.gap[seed % n] = 0;
   set_friction(problem, 0.3);
   return problem;
}

TEST(TippingBodies, ComeToRestOnOtherNodes)
{
   for (double curvature : {0.0, 0.1, 0.5, 1.5})
   {
      for (double coupling : {0.0, 0.3, 3.0})
      {
         for (double size : {1e-3, 0.1, 10.0})
         {
            for (unsigned seed = 1; seed <= 25; ++seed)
            {
               SCOPED_TRACE(testing::Message()
                            << "curvature " << curvature << " coupling " << coupling << " size "
                            << size << " seed " << seed);
               const ReducedProblem problem = resting_on_one_node(curvature, coupling, seed);
               ContactState state = ContactState::virgin(problem);
               cattaneo_test::LawChecker laws(problem, state);
               VectorXd before = state.v;
               MarchSettings settings;
               settings.stepping = Stepping::fixed;
               settings.increments = 4;
               const auto history = LoadHistory::through(
                  problem, {{}, {{"P", size}}, {{"P", size}, {"Q", size * 0.1}}});
               const MarchReport report =
                  march(problem, history, state, settings,
                        [&](const ContactState &reached, const IncrementRecord &)
                        {
                           EXPECT_LE(laws.violation(before, reached), 1);
                           before = reached.v;
                        });
               ASSERT_EQ(report.status, FrictionStatus::converged) << report.message;
               int carrying = 0; // one node alone balances no moment but its own
               for (double p : state.p) { carrying += p > 1e-9 * size; }
               EXPECT_GE(carrying, 2);
            }
         }
      }
   }
}

} // namespace
