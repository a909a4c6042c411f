//  benchmark_floor: whole studies against the work that none of them can do without
//
//  The floor of a study is the time of what any program that solves its equations this way has
//  to do, on the same matrices: start (a process with the same libraries), assemble each
//  different body, order and factor it once with its reduced stiffness and one solve a load,
//  the flexibility of a half-plane (a logarithm for each pair of nodes, and its inverse), the
//  union of two bodies, one Cholesky factor of the whole reduced stiffness, and one product
//  with it for each increment of the study, whose forces have to be told. No mesh, no search
//  for the states of the nodes, no read-out and no output.
//
//  Processor seconds of one thread, the least of several runs of the study and of each part of
//  the floor, in turns, each in a process of its own. The ratios are compared with those that
//  floor.json keeps: exit code 2 if a study has become slower by more than the stated share.

#include "common/disc_scene.hpp"
#include "common/hertz_scene.hpp"
#include "common/lap_joint_scene.hpp"
#include "common/measure.hpp"
#include "common/miniapp.hpp"
#include "common/options.hpp"
#include "common/punch.hpp"
#include "common/receding.hpp"
#include "common/study.hpp"
#include "common/text.hpp"

#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/sparse_factor.hpp>
#include <cattaneo/algebra/symmetric_product.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

using namespace cattaneo;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

double processor_seconds()
{
   timespec now{};
   clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
   return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A study as its command, and the scene that it makes.
struct Studied
{
   std::vector<std::string> command;
   std::function<miniapp::Scene()> scene;

   std::string name() const
   {
      std::string words;
      for (const std::string &word : command)
      {
         const bool spaces = word.find(' ') != std::string::npos;
         words += (words.empty() ? "" : " ") + (spaces ? '"' + word + '"' : word);
      }
      return words;
   }
};

std::vector<Studied> all_studies()
{
   const auto punch = [](bool half_plane)
   {
      miniapp::PunchOptions options;
      options.half_plane = half_plane;
      return miniapp::make_punch(options);
   };
   const auto strip = [] { return miniapp::make_receding({}); };
   const auto disc = [](miniapp::Twist twist)
   {
      miniapp::DiscOptions options;
      options.twist = twist;
      return miniapp::make_disc(options);
   };
   const auto laps = []
   {
      miniapp::LapJointOptions options;
      options.spacing = 0.005;
      return miniapp::make_lap_joint(options);
   };
   return {
      {{"square_punch"}, [=] { return punch(false); }},
      {{"lap_joint"}, laps},
      {{"plane_receding"}, strip},
      {{"axisymmetric_receding", "-torque", "0.9"}, [=] { return disc(miniapp::Twist::top); }},
      {{"square_punch", "-cycles", "3"}, [=] { return punch(false); }},
      {{"square_punch", "-obstacle", "half-plane"}, [=] { return punch(true); }},
      {{"hertz"}, [] { return miniapp::make_scene(miniapp::HalfPlanes{}); }},
      {{"plane_receding", "-unload", "0.9 0.5 0.2 0.1"}, strip},
      {{"axisymmetric_receding"}, [=] { return disc(miniapp::Twist::none); }},
      {{"shakedown"}, [=] { return punch(true); }},
   };
}

/// Seconds since the last part.
class Parts
{
public:
   void done(double &part)
   {
      const double now = processor_seconds();
      part += now - began_;
      began_ = now;
   }

private:
   double began_ = processor_seconds();
};

/// Parts of a floor, seconds.
struct Floor
{
   double start = 0, assembly = 0, factors = 0, dense = 0;
   double all() const { return start + assembly + factors + dense; }
};

/// Orders and factors a body with the nodes of its contact line last, reads its reduced
/// stiffness off the factor, and solves for each load.
void factor_once(const ElasticBody &body, const ContactLine &line)
{
   std::vector<int> role(body.dofs(), 0), keep;
   for (const LineNode &node : line.nodes)
   {
      for (int c = 0; c < components(line.formulation); ++c) { role[node.dofs[c]] = 1; }
   }
   for (int dof : body.essential_dofs()) { role[dof] = 2; }
   double shift = 0;
   for (int wanted : {0, 1})
   {
      for (int dof = 0; dof < body.dofs(); ++dof)
      {
         if (role[dof] != wanted) { continue; }
         keep.push_back(dof);
         shift = std::max(shift, body.stiffness()(dof, dof));
      }
   }
   const auto contact = static_cast<int>(std::count(role.begin(), role.end(), 1));
   const SparseFactor factor(view(body.stiffness()), keep, contact, shift);
   require(factor.schur().allFinite(), "the reduced stiffness of a body is not finite");
   MatrixXd forces(keep.size(), body.patterns().size());
   for (Index k = 0; k < forces.cols(); ++k)
   {
      forces.col(k) = body.patterns()[k].values(keep);
   }
   require(factor.solve(forces).allFinite(), "the displacements of a body are not finite");
}

/// With something for motions that nothing resists and for components that are held: these
/// cost no less.
DenseCholesky factored(MatrixXd S)
{
   S.diagonal() *= 1.5;
   S.diagonal() = (S.diagonal().array() > 0).select(S.diagonal(), 1);
   DenseCholesky factor;
   require(factor.compute(std::move(S)), "a reduced stiffness is not positive definite");
   return factor;
}

/// A logarithm for each pair of nodes, the factor and its inverse.
void flexibility(const CondensedBody &half_plane)
{
   const auto place = half_plane.line.each(&LineNode::arc_length);
   double sum = 0;
   for (Index i = 0; i < place.size(); ++i)
   {
      for (Index j = 0; j < i; ++j) { sum += std::log(std::abs(place[i] - place[j])); }
   }
   require(std::isfinite(sum), "the kernel of a half-plane is not finite");
   factored(half_plane.S).inverse();
}

void join(const std::vector<CondensedBody> &bodies)
{
   if (bodies.size() < 2) { return; }
   MatrixXd Y = bodies[0].S;
   factored(bodies[0].S + bodies[1].S).solve_half(Y);
   minus_square(bodies[0].S, Y);
}

Floor floor_of(const miniapp::Scene &scene, long increments)
{
#ifdef __GLIBC__
   // Each matrix on pages of its own, as in a process that makes it for the first time.
   mallopt(M_MMAP_MAX, 65536);
   mallopt(M_MMAP_THRESHOLD, 1 << 17);
#endif
   const Reduction &reduction = scene.reduction;
   std::vector<const ElasticBody *> bodies;
   std::vector<const CondensedBody *> condensed;
   for (const bool twisting : {false, true})
   {
      for (const auto &body : twisting ? scene.torsion : scene.bodies)
      {
         bodies.push_back(body.get());
      }
      for (const CondensedBody &body : twisting ? reduction.torsion : reduction.bodies)
      {
         condensed.push_back(&body);
      }
   }
   // Bodies come first, then the half-plane without a mesh; equal bodies have one factor.
   const std::size_t meshed = scene.bodies.size(), all = reduction.bodies.size();
   const auto factors = static_cast<std::size_t>(reduction.counters.factorisations);
   Floor floor;
   Parts parts;
   for (std::size_t b = 0; b < bodies.size() && b < factors; ++b)
   {
      const ElasticBody &body = *bodies[b];
      mfem::FiniteElementSpace &space = body.space();
      parts.done(floor.start);
      ElasticBody(*space.GetMesh(), space.FEColl()->GetOrder(), body.material(1),
                  body.formulation());
      parts.done(floor.assembly);
      factor_once(body, condensed[b < meshed ? b : all + b - meshed]->line);
      parts.done(floor.factors);
   }
   for (std::size_t b = 0; b < condensed.size(); ++b)
   {
      if (b % all >= meshed) { flexibility(*condensed[b]); }
   }
   join(reduction.bodies);
   join(reduction.torsion);
   const MatrixXd &K = reduction.problem.K;
   factored(K);
   const SymmetricProduct forces(K);
   VectorXd u = VectorXd::LinSpaced(K.rows(), 0, 1);
   for (long k = 0; k < increments; ++k) { u = forces(u).normalized(); }
   require(u.allFinite(), "a product with the reduced stiffness is not finite");
   parts.done(floor.dense);
   floor.start = 0; // it was what lies between the parts
   return floor;
}

/// What was found of a study, seconds.
struct Found
{
   Floor floor;
   double study = 0;
   double ratio() const { return study / floor.all(); }
};

Found measured(const Studied &one, int repeats)
{
   const std::filesystem::path self = std::filesystem::canonical("/proc/self/exe"),
                               results = std::filesystem::temp_directory_path() /
                                         ("floor_" + std::to_string(getpid()) + ".json");
   std::vector<std::string> command = one.command;
   command[0] = miniapp_program(command[0]);
   std::vector<std::string> counted = command;
   counted.insert(counted.end(), {"--json", results});
   whole_process(counted);
   const auto report = nlohmann::json::parse(std::ifstream(results));
   std::filesystem::remove(results);
   const long increments = report.at("counters").at("increments");

   constexpr double much = 1e300;
   Found least{{much, much, much, much}, much};
   for (int k = 0; k < repeats; ++k)
   {
      least.study = std::min(least.study, whole_process(command).cpu);
      least.floor.start = std::min(least.floor.start, whole_process({self, "start"}).cpu);
      const Measured floor = in_own_process(
         [&]
         {
            const Floor found = floor_of(one.scene(), increments);
            return std::vector<double>{found.assembly, found.factors, found.dense};
         });
      require(floor.ok && floor.values.size() == 3, "the floor of '", one.name(), "' failed");
      double *const parts[] = {&least.floor.assembly, &least.floor.factors, &least.floor.dense};
      for (std::size_t part = 0; part < 3; ++part)
      {
         *parts[part] = std::min(*parts[part], floor.values[part]);
      }
   }
   return least;
}

int compare(int repeats, double share, bool write)
{
   const std::string file = CATTANEO_SOURCE_DIR "/benchmarks/floor.json";
   nlohmann::ordered_json kept = nlohmann::ordered_json::object();
   if (std::filesystem::exists(file))
   {
      kept = nlohmann::ordered_json::parse(std::ifstream(file));
   }
   nlohmann::ordered_json found_now = nlohmann::ordered_json::object();
   std::vector<std::string> slower;
   std::printf("%-44s %7s %8s %7s %7s | %7s %7s %6s %6s\n", "seconds of", "start", "assembly",
               "factors", "dense", "floor", "study", "ratio", "kept");
   for (const Studied &one : all_studies())
   {
      const Found found = measured(one, repeats);
      const double before = kept.value(one.name(), miniapp::none);
      std::printf("%-44s %7.3f %8.3f %7.3f %7.3f | %7.3f %7.3f %6.2f %6.2f\n",
                  one.name().c_str(), found.floor.start, found.floor.assembly,
                  found.floor.factors, found.floor.dense, found.floor.all(), found.study,
                  found.ratio(), before);
      std::fflush(stdout);
      found_now[one.name()] = std::round(100 * found.ratio()) / 100;
      if (std::isnan(before))
      {
         slower.push_back(one.name() + ": no ratio of it is kept, -write keeps one");
      }
      else if (found.ratio() > (1 + share) * before)
      {
         slower.push_back(miniapp::text("%s: %.2f floors, %.0f %% more than %.2f",
                                        one.name().c_str(), found.ratio(),
                                        100 * (found.ratio() / before - 1), before));
      }
   }
   if (write)
   {
      write_whole(file, found_now.dump(2) + '\n');
      return 0;
   }
   for (const std::string &line : slower) { std::printf("slower: %s\n", line.c_str()); }
   if (slower.empty()) { std::printf("none is slower by more than %g %%\n", 100 * share); }
   return slower.empty() ? 0 : 2;
}

} // namespace

int main(int argc, char *argv[])
{
   if (argc == 2 && std::string(argv[1]) == "start") { return 0; }
   return miniapp::run(
      [&]
      {
         int repeats = 7;
         double share = 0.2;
         bool write = false;
         miniapp::Options args("benchmarks/benchmark_floor.cpp", argc, argv);
         args.add(&repeats, "repeats", "Runs of each, of which the least counts.",
                  miniapp::at_least(1));
         args.add(&share, "share", "What a study may take more of than its kept ratio.",
                  miniapp::not_negative);
         args.add(&write, "write", "Keep the ratios found instead, in benchmarks/floor.json.");
         args.parse();
         return compare(repeats, share, write);
      });
}
