// Random small reduced problems: whatever is called a solution obeys the laws, and answers do
// not depend on units, orientation, numbering, chains or a way through a file.

#include "holds.hpp"

#include "contact_laws.hpp"

#include <array>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace
{

using namespace cattaneo;
using namespace cattaneo_test;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case
{
   ReducedProblem problem;
   std::vector<VectorXd> loads; ///< points of the history, from zero
};

/// All numbers of a node: rows of a root of the stiffness (4 numbers each: tangential, normal,
/// circumferential), forces of the two patterns in the same order, gap and friction.
using Node = std::vector<int>;
constexpr int root = 4, node_numbers = 3 * root + 6 + 2;

/// Up to six nodes on springs and on a common elastic part of rank four. Without springs
/// (`held` false) there are motions that nothing resists.
Case random_case(int least_components, int most_components, bool held)
{
   const int c = *rc::gen::inRange(least_components, most_components + 1).as("components");
   const auto node = rc::gen::container<Node>(node_numbers, around_zero(4));
   const auto nodes =
      *rc::gen::resize(6, rc::gen::nonEmpty(
                             rc::gen::container<std::vector<Node>>(rc::gen::resize(100, node))))
          .as("nodes: 3 x 4 of the root of the stiffness, forces of P and Q, "
              "gap, friction");
   const int softness = held ? *rc::gen::inRange(0, 4).as("springs 1/10^") : 0;
   const bool interference = *rc::gen::arbitrary<bool>().as("interference");
   const auto points =
      *rc::gen::resize(
          5, rc::gen::nonEmpty(rc::gen::container<std::vector<std::array<int, 2>>>(
                rc::gen::resize(100, rc::gen::container<std::array<int, 2>>(around_zero(6))))))
          .as("points of the history, halves of P and Q");

   Case result;
   ReducedProblem &problem = result.problem;
   const Index n = static_cast<Index>(nodes.size());
   MatrixXd R((c + 1) * n, root), F((c + 1) * n, 2);
   problem.gap.resize(n);
   problem.friction.resize(n);
   for (Index i = 0; i < n; ++i)
   {
      const Node &draw = nodes[static_cast<std::size_t>(i)];
      for (int part = 0; part <= c; ++part)
      {
         // The normal part is the last of the problem, and the second of the draw.
         const int from = c == 0 || part == c ? 1 : 2 * part;
         for (int k = 0; k < root; ++k) { R(part * n + i, k) = 0.25 * draw[from * root + k]; }
         for (int k = 0; k < 2; ++k)
         {
            F(part * n + i, k) = 0.25 * draw[3 * root + 3 * k + from];
         }
      }
      const int gap = draw[node_numbers - 2];
      problem.gap[i] = 0.1 * (interference ? gap : std::abs(gap));
      problem.friction[i] = c == 0 ? 0 : 0.2 * std::abs(draw[node_numbers - 1]);
   }
   MatrixXd K = R * R.transpose();
   if (held) { K.diagonal().array() += std::pow(10, -softness); }
   RC_PRE(K.diagonal().minCoeff() > 0);
   problem.set_stiffness(K.topLeftCorner(c * n, c * n), K.bottomLeftCorner(n, c * n),
                         K.bottomRightCorner(n, n));
   const char *names[] = {"P", "Q"};
   for (int k = 0; k < 2; ++k)
   {
      problem.patterns.push_back(
         {names[k], Control::force, F.col(k).head(c * n), F.col(k).tail(n)});
   }
   problem.H = MatrixXd::Zero(2, 2);
   problem.weights = VectorXd::Ones(n);
   problem.chains = one_chain(n);
   problem.arc_length = VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
   result.loads.push_back(VectorXd::Zero(2));
   for (const auto &point : points)
   {
      result.loads.push_back(Eigen::Vector2d(0.5 * point[0], 0.5 * point[1]));
   }
   // Without any force yet there is no scale to judge a motion that nothing resists by.
   RC_PRE(!problem.clamped_forces(result.loads[1]).isZero(0));
   return result;
}

/// What fails is written as a file of a reduced problem; its history is in the message.
void check(const Case &c, const std::function<void()> &act)
{
   keep_if_it_fails(".json", act, [&](const std::string &file) { save(c.problem, file); });
}

bool solved(FrictionStatus status)
{
   return status == FrictionStatus::converged || status == FrictionStatus::not_unique;
}

/// Solves the points one after another, each as one increment, as far as there are answers.
ContactState solve_points(const Case &c, std::vector<FrictionStatus> &statuses)
{
   FrictionSolver solver(c.problem);
   ContactState state = ContactState::virgin(c.problem);
   LawChecker laws(c.problem, state);
   for (std::size_t k = 1; k < c.loads.size(); ++k)
   {
      const ContactState before = state;
      const IncrementReport report = solver.solve(state, c.loads[k]);
      statuses.push_back(report.status);
      if (!solved(report.status))
      {
         RC_ASSERT(!report.message.empty());
         RC_ASSERT(state.v == before.v && state.w == before.w && state.q == before.q &&
                   state.p == before.p && state.status == before.status);
         break;
      }
      const double violation = laws.violation(before.v, state);
      if (!(violation <= 1)) { RC_FAIL(laws.what() + ", by " + std::to_string(violation)); }
   }
   return state;
}

void check_march(const Case &c, Stepping stepping)
{
   MarchSettings settings;
   settings.stepping = stepping;
   settings.increments = 4;
   settings.every_event = true; // the laws of increments hold on straight pieces
   ContactState state = ContactState::virgin(c.problem);
   LawChecker laws(c.problem, state);
   VectorXd v_old = state.v;
   bool begins = true;
   std::string at_first;
   const MarchReport report = march(c.problem, LoadHistory::through(c.loads), state, settings,
                                    [&](const ContactState &now, const IncrementRecord &record)
                                    {
                                       const double violation = laws.violation(v_old, now);
                                       if (!(violation <= 1))
                                       {
                                          const std::string what =
                                             "at time " + std::to_string(record.time) + " " +
                                             laws.what() + ", by " + std::to_string(violation);
                                          if (!begins) { RC_FAIL(what); }
                                          at_first = what;
                                       }
                                       v_old = now.v;
                                       begins = false;
                                    });
   // Slip begins where bodies were moved to that touched nothing.
   if (!at_first.empty() && report.taken_up_clearance == 0) { RC_FAIL(at_first); }
   RC_ASSERT(report.status == FrictionStatus::converged || !report.message.empty());
}

TEST(ReducedProblemProperties, IncrementsObeyTheLaws)
{
   for (const bool held : {true, false})
   {
      expect_holds(1500,
                   [&]
                   {
                      const Case c = random_case(0, 2, held);
                      check(c,
                            [&]
                            {
                               std::vector<FrictionStatus> statuses;
                               solve_points(c, statuses);
                            });
                   });
   }
}

TEST(ReducedProblemProperties, MarchesObeyTheLaws)
{
   for (const Stepping stepping : {Stepping::fixed, Stepping::exact})
   {
      for (const bool held : {true, false})
      {
         expect_holds(150,
                      [&]
                      {
                         const Case c = random_case(1, 2, held);
                         check(c, [&] { check_march(c, stepping); });
                      });
      }
   }
}

/// Answers of the same problem, seen otherwise, are the same wherever there is only one, and
/// there always is with springs and little friction: see CriticalFriction::unique_below.
/// `turn` makes the other problem, `back` brings its state to the first one's.
void expect_same_answers(int cases, const std::function<void(Case &)> &turn,
                         const std::function<void(const Case &, ContactState &)> &back)
{
   expect_holds(cases,
                [&]
                {
                   Case c = random_case(1, 2, true);
                   const double unique = critical_friction(c.problem).unique_below;
                   const double most = c.problem.friction.maxCoeff();
                   if (most >= unique) { c.problem.friction *= 0.9 * unique / most; }
                   Case other = c;
                   turn(other);
                   check(c,
                         [&]
                         {
                            std::vector<FrictionStatus> statuses, others;
                            const ContactState a = solve_points(c, statuses);
                            ContactState b = solve_points(other, others);
                            RC_ASSERT(statuses == others);
                            for (const FrictionStatus status : statuses)
                            {
                               RC_ASSERT(solved(status));
                            }
                            back(c, b);
                            // By the softest spring a violation of the laws, 1e-11, is a
                            // displacement.
                            const double size = std::max(a.peak_force, 1e-300);
                            RC_ASSERT((a.q - b.q).cwiseAbs().maxCoeff() <= 1e-6 * size);
                            RC_ASSERT((a.p - b.p).cwiseAbs().maxCoeff() <= 1e-6 * size);
                            VectorXd u(a.v.size() + a.w.size());
                            u << a.v - b.v, a.w - b.w;
                            RC_ASSERT((c.problem.K * u).cwiseAbs().maxCoeff() <= 1e-6 * size);
                         });
                });
}

TEST(ReducedProblemProperties, UnitsDoNotMatter)
{
   for (const auto &[force, length] :
        {std::pair(1e6, 1.0), std::pair(1.0, 1e-3), std::pair(3e-9, 7e4)})
   {
      const double stiffness = force / length;
      expect_same_answers(
         300,
         [&, force = force, length = length](Case &c)
         {
            c.problem.K *= stiffness;
            for (LoadPattern &pattern : c.problem.patterns)
            {
               pattern.q *= force;
               pattern.p *= force;
            }
            c.problem.gap *= length;
         },
         [&, force = force, length = length](const Case &, ContactState &state)
         {
            state.v /= length;
            state.w /= length;
            state.q /= force;
            state.p /= force;
         });
   }
}

TEST(ReducedProblemProperties, TheMirrorImageIsMirrored)
{
   expect_same_answers(
      600,
      [](Case &c)
      {
         c.problem.set_stiffness(c.problem.A(), -1 * c.problem.B(), c.problem.C());
         for (LoadPattern &pattern : c.problem.patterns) { pattern.q *= -1; }
      },
      [](const Case &, ContactState &state)
      {
         state.v *= -1;
         state.q *= -1;
      });
}

/// The nodes in reverse order.
TEST(ReducedProblemProperties, NumbersOfNodesDoNotMatter)
{
   const auto reverse = [](const VectorXd &x, Index n)
   {
      VectorXd y(x.size());
      for (Index from = 0; from < x.size(); from += n)
      {
         y.segment(from, n) = x.segment(from, n).reverse();
      }
      return y;
   };
   const auto reverse_rows = [&](const MatrixXd &M, Index n)
   {
      MatrixXd R = M;
      for (Index k = 0; k < M.cols(); ++k) { R.col(k) = reverse(M.col(k), n); }
      return R;
   };
   expect_same_answers(
      600,
      [&](Case &c)
      {
         ReducedProblem &problem = c.problem;
         const Index n = problem.nodes();
         problem.K = reverse_rows(reverse_rows(problem.K, n).transpose(), n).transpose();
         for (LoadPattern &pattern : problem.patterns)
         {
            pattern.q = reverse(pattern.q, n);
            pattern.p = reverse(pattern.p, n);
         }
         problem.gap = reverse(problem.gap, n);
         problem.friction = reverse(problem.friction, n);
      },
      [&](const Case &c, ContactState &state)
      {
         for (VectorXd *x : {&state.v, &state.w, &state.q, &state.p})
         {
            *x = reverse(*x, c.problem.nodes());
         }
      });
}

/// To the last bit: chains say what is next to what, which no increment asks.
TEST(ReducedProblemProperties, ChainsAndFilesChangeNoBit)
{
   const std::string file =
      testing::TempDir() + "cattaneo_properties_" + std::to_string(::getpid()) + ".json";
   expect_holds(300,
                [&]
                {
                   const Case c = random_case(0, 2, true);
                   check(
                      c,
                      [&]
                      {
                         Case split = c, restored = c;
                         split.problem.chains.clear();
                         for (Index i = 0; i < c.problem.nodes(); ++i)
                         {
                            split.problem.chains.push_back({"one by one", i, 1, false, {}, {}});
                         }
                         save(c.problem, file);
                         restored.problem = load_reduced_problem(file);
                         std::vector<FrictionStatus> statuses, others;
                         const ContactState state = solve_points(c, statuses);
                         for (const Case &other : {split, restored})
                         {
                            others.clear();
                            const ContactState same = solve_points(other, others);
                            RC_ASSERT(statuses == others);
                            RC_ASSERT(same.v == state.v && same.w == state.w);
                            RC_ASSERT(same.q == state.q && same.p == state.p);
                            RC_ASSERT(same.status == state.status);
                            RC_ASSERT(same.dissipation == state.dissipation);
                         }
                      });
                });
   std::remove(file.c_str());
}

} // namespace
