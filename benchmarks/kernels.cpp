//  kernels: time of each expensive act on its own, with Google Benchmark
//
//  Assembly, ordering, ordering and factorisation, extraction of the reduced stiffness, union
//  of two bodies, a warm friction step, an active-set (Newton) step, a shakedown limit. The
//  argument of the first four is the number of dofs of a square of quadratic elements whose
//  lower side is the contact; of the others it is the number of contact nodes of a punch on a
//  half-plane. Options are Google Benchmark's: --benchmark_filter=…, --benchmark_out=FILE.

#include "common/punch.hpp"

#include <benchmark/benchmark.h>
#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/friction/friction_solver.hpp>
#include <cattaneo/shakedown/limit.hpp>
#include <cmath>
#include <numeric>
#ifdef CATTANEO_USE_CHOLMOD
#include <cholmod.h>
#endif

using namespace cattaneo;
using Eigen::Vector2d;

namespace
{

mfem::Mesh square(const benchmark::State &state)
{
   const int side = static_cast<int>(std::lround((std::sqrt(state.range(0) / 2.0) - 1) / 2));
   return mfem::Mesh::MakeCartesian2D(side, side, mfem::Element::QUADRILATERAL, true, 1.0, 1.0);
}

/// A square with its rows in the order of the factor, contact last.
struct Square
{
   mfem::Mesh mesh;
   ElasticBody body;
   std::vector<int> keep;
   int trailing = 0;

   explicit Square(const benchmark::State &state)
      : mesh(square(state)), body(mesh, 2, Material{1.0, 0.3})
   {
      std::vector<bool> contact(body.dofs(), false);
      const ContactLine line = contact_line(body, 1);
      for (const auto &node : line.nodes)
      {
         for (int dof : node.dofs) { contact[dof] = true; }
      }
      for (const bool last : {false, true})
      {
         for (int dof = 0; dof < body.dofs(); ++dof)
         {
            if (contact[dof] == last) { keep.push_back(dof); }
         }
      }
      trailing = 2 * static_cast<int>(line.size());
   }
   /// The contact dofs get a stiffness of their own: nothing is held.
   SparseFactor factor() const { return {view(body.stiffness()), keep, trailing, 1.0}; }
};

void assembly(benchmark::State &state)
{
   mfem::Mesh mesh = square(state);
   for (auto _ : state)
   {
      benchmark::DoNotOptimize(ElasticBody(mesh, 2, Material{1.0, 0.3}).dofs());
   }
}

#ifdef CATTANEO_USE_CHOLMOD
void ordering(benchmark::State &state)
{
   const Square square(state);
   const mfem::SparseMatrix &K = square.body.stiffness();
   cholmod_common common;
   cholmod_start(&common);
   cholmod_sparse pattern{};
   pattern.nrow = pattern.ncol = K.Height();
   pattern.nzmax = K.NumNonZeroElems();
   pattern.p = const_cast<int *>(K.GetI());
   pattern.i = const_cast<int *>(K.GetJ());
   pattern.stype = -1;
   pattern.itype = CHOLMOD_INT;
   pattern.xtype = CHOLMOD_PATTERN;
   pattern.packed = 1;
   std::vector<int> last(K.Height(), 0), order(K.Height());
   for (int k = K.Height() - square.trailing; k < K.Height(); ++k) { last[square.keep[k]] = 1; }
   for (auto _ : state)
   {
      if (!cholmod_camd(&pattern, nullptr, 0, last.data(), order.data(), &common))
      {
         state.SkipWithError("no order was found");
      }
   }
   cholmod_finish(&common);
}
#endif

void ordering_and_factorisation(benchmark::State &state)
{
   const Square square(state);
   for (auto _ : state) { benchmark::DoNotOptimize(square.factor().rows()); }
}

void extraction(benchmark::State &state)
{
   const SparseFactor factor = Square(state).factor();
   for (auto _ : state) { benchmark::DoNotOptimize(factor.schur().data()); }
}

miniapp::Scene punch(const benchmark::State &state)
{
   miniapp::PunchOptions options;
   options.half_plane = true;
   options.nodes = static_cast<int>(state.range(0));
   options.domain = 100;
   miniapp::Scene punch = miniapp::make_punch(options);
   set_friction(punch.reduction.problem, 0.4);
   return punch;
}

/// The bodies are copied each time, which is a part of what is measured.
void union_of_two_bodies(benchmark::State &state)
{
   const miniapp::Scene scene = punch(state);
   const CondensedBody &one = scene.reduction.bodies[0], &two = scene.reduction.bodies[1];
   const Pairing pairing = pair_lines(one.line, two.line);
   for (auto _ : state)
   {
      benchmark::DoNotOptimize(reduce(one, two, pairing).problem.A().data());
   }
}

/// Partial slip, twenty increments from no shear to 0.8 fP and round again.
void friction_step(benchmark::State &state)
{
   const miniapp::Scene scene = punch(state);
   FrictionSolver solver(scene.reduction.problem);
   ContactState pressed = ContactState::virgin(scene.reduction.problem);
   solver.solve(pressed, Vector2d(1, 0));
   ContactState contact = pressed;
   const Counters before = solver.counters();
   int step = 0;
   for (auto _ : state)
   {
      if (step == 20)
      {
         contact = pressed;
         step = 0;
      }
      ++step;
      if (solver.solve(contact, Vector2d(1, 0.32 * step / 20)).status !=
          FrictionStatus::converged)
      {
         state.SkipWithError("the step did not converge");
      }
   }
   Counters done = solver.counters();
   done -= before;
   const auto a_step = [&](long count) {
      return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kAvgIterations);
   };
   state.counters["newton"] = a_step(done.newton_steps);
   state.counters["dense"] = a_step(done.dense_factorisations);
}

/// One large step, many active-set steps: their mean.
void newton_step(benchmark::State &state)
{
   const miniapp::Scene scene = punch(state);
   FrictionSolver solver(scene.reduction.problem);
   const Counters before = solver.counters();
   for (auto _ : state)
   {
      ContactState contact = ContactState::virgin(scene.reduction.problem);
      if (solver.solve(contact, Vector2d(1, 0.3)).status != FrictionStatus::converged)
      {
         state.SkipWithError("the step did not converge");
      }
   }
   Counters done = solver.counters();
   done -= before;
   state.counters["seconds/newton"] =
      benchmark::Counter(static_cast<double>(done.newton_steps),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void limit_programme(benchmark::State &state)
{
   miniapp::Scene scene = punch(state);
   set_friction(scene.reduction.problem, 0.85);
   const LimitProblem problem = limit_problem(
      scene.reduction.problem, held_and_cycled(scene.reduction.problem, "P", 1, "Q", -1));
   for (auto _ : state)
   {
      if (load_limit(problem).status != LimitStatus::certified)
      {
         state.SkipWithError("no certified limit");
      }
   }
}

BENCHMARK(assembly)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
#ifdef CATTANEO_USE_CHOLMOD
BENCHMARK(ordering)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
#endif
BENCHMARK(ordering_and_factorisation)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(extraction)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
BENCHMARK(union_of_two_bodies)->Arg(101)->Arg(401)->Unit(benchmark::kMillisecond);
BENCHMARK(friction_step)->Arg(101)->Arg(401)->Unit(benchmark::kMillisecond);
BENCHMARK(newton_step)->Arg(101)->Arg(401)->Unit(benchmark::kMillisecond);
BENCHMARK(limit_programme)->Arg(65)->Arg(129)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
