//  siconos_peer: increments of reduced problems, solved by this library and by Siconos
//
//  siconos_peer [--held] PROBLEM.json...   the increments of the problems' stored solutions
//  siconos_peer --random                   families of random problems (dense, positive
//  definite)
//
//  Prints one line an increment and solver, as CSV: problem, nodes, increment, solver, seconds,
//  residual, info, iterations. Every solver gets the same increment, from the same state, in
//  units in which the stiffness and the loads are of order one, and is judged by the same
//  residual: the natural map of the laws over the largest clamped nodal force. Only the
//  solver's own call is timed; what is made once a problem (our solver, the compliance, the
//  complementarity matrix) is not. The least of three times counts.
//
//  --held: springs (0.01 of the diagonal, as stiff as the softest elastic motion) hold every
//  node. The compliance, which Siconos' friction solvers start from, does not exist where a
//  body is held by contact alone.

#include "common/miniapp.hpp"

#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <LinearComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <lcp_cst.h>
#include <limits>
#include <random_problem.hpp>

using namespace cattaneo;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

constexpr int repetitions = 3;
constexpr double long_time = 0.05; ///< seconds that are measured only once
std::FILE *csv = nullptr;

struct Answer
{
   double seconds = std::numeric_limits<double>::infinity();
   int info = 0;
   long iterations = 0;
   VectorXd slip, opening; ///< Δv and w + g
   VectorXd q, p;
};

template <class Solve>
double timed(const Solve &solve)
{
   const auto began = std::chrono::steady_clock::now();
   solve();
   return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// A march of one problem: the loads of each increment, and the states it passes.
struct Increments
{
   std::string name;
   ReducedProblem problem;
   std::vector<VectorXd> multipliers;
   std::vector<ContactState> states; ///< before each increment, and after the last
};

/// Stiffness and loads of order one: what an absolute tolerance needs.
void scale_to_one(ReducedProblem &problem, const std::vector<VectorXd> &multipliers)
{
   double force = 0;
   for (const VectorXd &loads : multipliers)
   {
      force = std::max(force, problem.clamped_forces(loads).cwiseAbs().maxCoeff());
   }
   const double stiffness = problem.K.diagonal().mean();
   problem.K /= stiffness;
   problem.gap *= stiffness / force;
   for (LoadPattern &pattern : problem.patterns)
   {
      pattern.q /= force;
      pattern.p /= force;
   }
}

void hold(ReducedProblem &problem)
{
   problem.A().diagonal() *= 1.01;
   problem.C().diagonal() *= 1.01;
   complete(problem);
}

/// The increments in the library's own solution. False if it found none.
bool march_through(Increments &run)
{
   FrictionSolver solver(run.problem);
   ContactState state = ContactState::virgin(run.problem);
   run.states = {state};
   for (const VectorXd &loads : run.multipliers)
   {
      const FrictionStatus status = solver.solve(state, loads).status;
      if (status != FrictionStatus::converged && status != FrictionStatus::not_unique)
      {
         return false;
      }
      run.states.push_back(state);
   }
   return true;
}

/// One problem, ready for every solver.
class Comparison
{
public:
   explicit Comparison(const Increments &run)
      : run(run), n(run.problem.nodes()), K(run.problem.K)
   {
      make_lcp_matrix();
      const Eigen::LLT<MatrixXd> factor(K);
      const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues()[0];
      regular = factor.info() == Eigen::Success && least > 1e-10 * K.cwiseAbs().maxCoeff();
      if (regular)
      {
         W = MatrixXd::Identity(2 * n, 2 * n);
         factor.solveInPlace(W);
         // Siconos counts the normal component of a contact first.
         Eigen::VectorXi order(2 * n);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            order[2 * i] = static_cast<int>(n + i);
            order[2 * i + 1] = static_cast<int>(i);
         }
         permutation = order;
         W_contacts = W(order, order);
      }
   }

   void print()
   {
      std::vector<Answer> ours(run.multipliers.size());
      for (int r = 0; r < repetitions; ++r)
      {
         FrictionSolver solver(run.problem); // nothing is remembered from the time before
         for (std::size_t k = 0; k < ours.size(); ++k)
         {
            ContactState state = run.states[k];
            IncrementReport report;
            const long before = solver.counters().newton_steps;
            const double seconds =
               timed([&] { report = solver.solve(state, run.multipliers[k]); });
            Answer &answer = ours[k];
            answer.seconds = std::min(answer.seconds, seconds);
            answer.info = static_cast<int>(report.status);
            answer.iterations = solver.counters().newton_steps - before;
            answer.slip = state.v - run.states[k].v;
            answer.opening = state.w + run.problem.gap;
            from_displacements(k, answer);
         }
      }
      for (std::size_t k = 0; k < ours.size(); ++k)
      {
         line(k, "cattaneo", ours[k]);
         line(k, "siconos lcp lemke", lcp(k, SICONOS_LCP_LEMKE));
         line(k, "siconos lcp pivot", lcp(k, SICONOS_LCP_PIVOT));
         line(k, "siconos lcp newton", lcp(k, SICONOS_LCP_NEWTON_FB_FBLSA));
         if (!regular) { continue; }
         line(k, "siconos friction nsgs 1e-6", friction(k, SICONOS_FRICTION_2D_NSGS, 1e-6));
         line(k, "siconos friction nsgs 1e-10", friction(k, SICONOS_FRICTION_2D_NSGS, 1e-10));
         line(k, "siconos friction lemke", friction(k, SICONOS_FRICTION_2D_LEMKE, 1e-10));
      }
   }

private:
   /// Forces at Δv = 0 and w + g = 0: where an increment starts from.
   VectorXd stuck_forces(std::size_t k) const
   {
      VectorXd u(2 * n);
      u << run.states[k].v, -run.problem.gap;
      return run.problem.clamped_forces(run.multipliers[k]) + K * u;
   }

   void from_displacements(std::size_t k, Answer &answer) const
   {
      VectorXd x(2 * n);
      x << answer.slip, answer.opening;
      const VectorXd F = stuck_forces(k) + K * x;
      answer.q = F.head(n);
      answer.p = F.tail(n);
   }

   /** Slip is the difference of two numbers that are not negative, forward a and backward b:

          p       = …  >= 0    with  w + g >= 0
          f p + q = …  >= 0    with  a >= 0
          f p - q = …  >= 0    with  b >= 0,    each product zero.   */
   void make_lcp_matrix()
   {
      const ReducedProblem &P = run.problem;
      const auto f = P.friction.asDiagonal();
      M.resize(3 * n, 3 * n);
      M.topRows(n) << P.C(), P.B(), -P.B();
      M.middleRows(n, n) << f * P.C() + P.B().transpose(), f * P.B() + P.A(),
         -(f * P.B() + P.A());
      M.bottomRows(n) << f * P.C() - P.B().transpose(), f * P.B() - P.A(), P.A() - f * P.B();
   }

   Answer lcp(std::size_t k, int id)
   {
      const VectorXd F = stuck_forces(k);
      const auto f = run.problem.friction.asDiagonal();
      VectorXd b(3 * n);
      b << F.tail(n), f * F.tail(n) + F.head(n), f * F.tail(n) - F.head(n);
      Answer answer;
      VectorXd z, s;
      for (int r = 0; r < repetitions && (r == 0 || answer.seconds < long_time); ++r)
      {
         z = s = VectorXd::Zero(3 * n);
         MatrixXd matrix = M; // some solvers work in it
         VectorXd right = b;
         NumericsMatrix *numerics = NM_create_from_data(NM_DENSE, static_cast<int>(3 * n),
                                                        static_cast<int>(3 * n), matrix.data());
         LinearComplementarityProblem problem{static_cast<int>(3 * n), numerics, right.data()};
         SolverOptions *options = solver_options_create(id);
         options->iparam[SICONOS_IPARAM_MAX_ITER] =
            id == SICONOS_LCP_NEWTON_FB_FBLSA ? 100 : 10000;
         options->dparam[SICONOS_DPARAM_TOL] = 1e-10;
         const double seconds = timed(
            [&] {
               answer.info =
                  linearComplementarity_driver(&problem, z.data(), s.data(), options);
            });
         answer.seconds = std::min(answer.seconds, seconds);
         answer.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
         solver_options_delete(options);
         numerics->matrix0 = nullptr; // Eigen's
         NM_clear(numerics);
         std::free(numerics);
      }
      answer.opening = z.head(n);
      answer.slip = z.segment(n, n) - z.tail(n);
      from_displacements(k, answer);
      return answer;
   }

   /// u = W r + …, reactions in Coulomb's cones. The start is the reaction before the
   /// increment.
   Answer friction(std::size_t k, int id, double tolerance)
   {
      const VectorXd free = -(W * stuck_forces(k));
      VectorXd old(2 * n);
      old << run.states[k].q, run.states[k].p;
      Answer answer;
      VectorXd r, u;
      for (int repeated = 0;
           repeated < repetitions && (repeated == 0 || answer.seconds < long_time); ++repeated)
      {
         r = old(permutation);
         u = VectorXd::Zero(2 * n);
         MatrixXd matrix = W_contacts;
         VectorXd right = free(permutation), mu = run.problem.friction;
         NumericsMatrix *numerics = NM_create_from_data(NM_DENSE, static_cast<int>(2 * n),
                                                        static_cast<int>(2 * n), matrix.data());
         FrictionContactProblem problem{2, static_cast<int>(n), numerics, right.data(),
                                        mu.data()};
         SolverOptions *options = solver_options_create(id);
         options->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
         options->dparam[SICONOS_DPARAM_TOL] = tolerance;
         const double seconds =
            timed([&] { answer.info = fc2d_driver(&problem, r.data(), u.data(), options); });
         answer.seconds = std::min(answer.seconds, seconds);
         answer.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
         solver_options_delete(options);
         numerics->matrix0 = nullptr;
         NM_clear(numerics);
         std::free(numerics);
      }
      VectorXd reaction(2 * n);
      reaction(permutation) = r;
      const VectorXd x = W * reaction + free;
      answer.q = reaction.head(n);
      answer.p = reaction.tail(n);
      answer.slip = x.head(n);
      answer.opening = x.tail(n);
      return answer;
   }

   /// Largest violation of the laws by forces and displacements that are in equilibrium, over
   /// the largest clamped nodal force (which is 1 at most here).
   double residual(const Answer &a) const
   {
      double worst = 0;
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double f = run.problem.friction[i];
         worst = std::max(worst, std::abs(std::min(a.p[i], K(n + i, n + i) * a.opening[i])));
         const double limit = f * std::max(a.p[i], 0.0);
         const double trial = a.q[i] - K(i, i) * a.slip[i];
         worst = std::max(worst, std::abs(a.q[i] - std::min(std::max(trial, -limit), limit)));
         if (!std::isfinite(a.p[i] + a.q[i] + a.slip[i] + a.opening[i])) { return 1e300; }
      }
      return worst;
   }

   void line(std::size_t k, const char *solver, const Answer &answer) const
   {
      std::fprintf(csv, "%s,%ld,%zu,%s,%.3e,%.2e,%d,%ld\n", run.name.c_str(),
                   static_cast<long>(n), k, solver, answer.seconds, residual(answer),
                   answer.info, answer.iterations);
   }

   const Increments &run;
   const Eigen::Index n;
   const MatrixXd K;
   MatrixXd M, W, W_contacts;
   Eigen::VectorXi permutation;
   bool regular = false;
};

void compare(Increments run, bool held)
{
   if (held)
   {
      hold(run.problem);
      run.name += " held";
   }
   scale_to_one(run.problem, run.multipliers);
   if (!march_through(run))
   {
      std::fprintf(stderr, "%s: no march\n", run.name.c_str());
      return;
   }
   Comparison(run).print();
}

Increments stored(const std::string &file)
{
   const std::filesystem::path path = file;
   Increments run{path.stem().string(), load_reduced_problem(file), {}, {}};
   const std::string name = (path.parent_path() / path.stem()).string() + ".solution.json";
   std::ifstream in(name);
   require(in.good(), "cannot read file '", name, "'");
   const nlohmann::json solution = nlohmann::json::parse(in);
   for (const nlohmann::json &increment : solution.at("increments"))
   {
      const auto loads = increment.at("multipliers").get<std::vector<double>>();
      run.multipliers.push_back(Eigen::Map<const VectorXd>(loads.data(), loads.size()));
   }
   return run;
}

/// Random dense problems: nodes, friction, coupling; pressed, then sheared to and fro.
void random_families()
{
   std::mt19937 random(1);
   for (const int n : {10, 20, 40, 80})
   {
      for (const double coupling : {0.1, 0.4})
      {
         for (const double friction : {0.2, 0.8})
         {
            char name[64];
            std::snprintf(name, sizeof name, "random %d %.1f %.1f", n, friction, coupling);
            Increments run{
               name, cattaneo_test::random_problem(n, friction, coupling, random), {}, {}};
            for (const double load : {0.5, 1.0})
            {
               run.multipliers.push_back(Eigen::Vector2d(load, 0));
            }
            for (const double shear : {0.2, 0.4, 0.2, 0.0, -0.2, -0.4})
            {
               run.multipliers.push_back(Eigen::Vector2d(1, shear));
            }
            compare(std::move(run), false);
         }
      }
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         require(argc > 2, "usage: siconos_peer TABLE.csv [--held] PROBLEM.json... | --random");
         csv = std::fopen(argv[1], "w"); // stdout is Siconos' own
         require(csv, "cannot write file '", argv[1], "'");
         std::fprintf(csv, "problem,nodes,increment,solver,seconds,residual,info,iterations\n");
         bool held = false;
         for (int k = 2; k < argc; ++k)
         {
            if (std::strcmp(argv[k], "--random") == 0) { random_families(); }
            else if (std::strcmp(argv[k], "--held") == 0) { held = true; }
            else { compare(stored(argv[k]), held); }
         }
         return std::fclose(csv) == 0 ? 0 : 1;
      });
}
