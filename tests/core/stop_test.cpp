#include "comparison.hpp"
#include "disc_problems.hpp"
#include "expect_input_error.hpp"
#include "same_state.hpp"

#include <cattaneo/design/sensitivity.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <shakedown_problems.hpp>
#include <sstream>

// Long work that is watched, stopped, written as it goes and taken up again.

namespace
{

using namespace cattaneo;
using cattaneo_test::expect_same;
using cattaneo_test::random_disc_problem;
using cattaneo_test::random_problem;
using Eigen::VectorXd;

LoadHistory to_and_fro(const ReducedProblem &problem, int cycles)
{
   return LoadHistory::through(
      problem, {{}, {{"press", 1}}, {{"shear", 0.8}}, {{"shear", -0.8}}, {{"shear", 0}}}, 1,
      cycles);
}

struct StoppedCase
{
   std::string name;
   ReducedProblem problem;
   MarchSettings settings;
};

/// Marches that go on to the last bit.
std::vector<StoppedCase> cases()
{
   std::mt19937 random(41);
   MarchSettings settings;
   settings.increments = 6;
   MarchSettings fixed = settings;
   fixed.stepping = Stepping::fixed;
   return {{"fixed", random_problem(12, 0.3, 0.1, random), fixed},
           {"fixed, more friction", random_problem(10, 0.5, 0.1, random), fixed},
           {"disc", random_disc_problem(5, 0.3, 0.1, random), settings}};
}

/// A march from rest with its history in a file: how many increments it takes.
long march_to_file(const StoppedCase &c, const LoadHistory &history, ContactState &state,
                   const std::string &file)
{
   HistoryWriter writer(file, c.problem);
   return march(c.problem, history, state, c.settings,
                [&](const ContactState &now, const IncrementRecord &record)
                { writer.add(now, record); })
      .counters.increments;
}

TEST(Stop, AtAnyIncrementTheMarchGoesOnToTheLastBit)
{
   const std::string folder = testing::TempDir();
   for (const StoppedCase &c : cases())
   {
      SCOPED_TRACE(c.name);
      const LoadHistory history = to_and_fro(c.problem, 3);
      ContactState whole = ContactState::virgin(c.problem);
      const long increments = march_to_file(c, history, whole, folder + "whole.csv");
      ASSERT_GT(increments, 20);
      int stopped = 0;
      for (long after = 0; after < increments; ++after)
      {
         std::atomic<bool> stop{after == 0};
         MarchSettings settings = c.settings;
         settings.monitor.stop = &stop;
         ContactState state = ContactState::virgin(c.problem), last = state;
         {
            HistoryWriter writer(folder + "cut.csv", c.problem);
            int count = 0;
            const MarchReport report =
               march(c.problem, history, state, settings,
                     [&](const ContactState &now, const IncrementRecord &record)
                     {
                        writer.add(now, record);
                        last = now;
                        if (++count == after) { stop = true; }
                     });
            expect_same(state, last);
            EXPECT_EQ(report.time, state.time);
            if (report.status == FrictionStatus::stopped)
            {
               ++stopped;
               EXPECT_EQ(report.event_time, state.time);
               EXPECT_EQ(report.event_multipliers, state.multipliers);
               EXPECT_FALSE(report.message.empty());
            }
         }
         save(state, folder + "state.json");
         ContactState rest = load_contact_state(folder + "state.json");
         HistoryWriter writer(folder + "cut.csv", c.problem, rest);
         const MarchReport report =
            march(c.problem, history, rest, c.settings,
                  [&](const ContactState &now, const IncrementRecord &record)
                  { writer.add(now, record); });
         EXPECT_EQ(report.status, FrictionStatus::converged);
         SCOPED_TRACE(after);
         expect_same(rest, whole);
         EXPECT_EQ(content(folder + "cut.csv"), content(folder + "whole.csv"));
         if (HasFailure()) { return; }
      }
      // But for those whose end came first, all were.
      EXPECT_GT(stopped, 0.7 * increments);
   }
}

TEST(Stop, OnAnExactPathGoesOnToRoundOff)
{
   std::mt19937 random(42);
   const ReducedProblem problem = random_problem(12, 0.3, 0.1, random);
   const LoadHistory history = to_and_fro(problem, 2);
   MarchSettings settings;
   settings.stepping = Stepping::exact;
   settings.every_event = true;
   ContactState whole = ContactState::virgin(problem);
   const long increments = march(problem, history, whole, settings).counters.increments;
   ASSERT_GT(increments, 20);
   for (int after = 1; after < increments; after += 3)
   {
      std::atomic<bool> stop{false};
      MarchSettings watched = settings;
      watched.monitor.stop = &stop;
      ContactState state = ContactState::virgin(problem);
      int count = 0;
      const MarchReport report =
         march(problem, history, state, watched,
               [&](const ContactState &, const IncrementRecord &) { stop = ++count >= after; });
      EXPECT_EQ(count, after); // after every event
      EXPECT_EQ(report.status, FrictionStatus::stopped);
      march(problem, history, state, settings);
      EXPECT_LT((state.v - whole.v).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((state.p - whole.p).cwiseAbs().maxCoeff(), 1e-12);
   }
}

TEST(Stop, AProgramThatEndsAnywhereIsTakenUpFromWhatItSaved)
{
   const std::string folder = testing::TempDir();
   for (const StoppedCase &c : cases())
   {
      SCOPED_TRACE(c.name);
      const LoadHistory history = to_and_fro(c.problem, 3);
      ContactState whole = ContactState::virgin(c.problem);
      const long increments = march_to_file(c, history, whole, folder + "whole.csv");
      for (long end = 1; end < increments; end += 5)
      {
         SCOPED_TRACE(end);
         std::filesystem::remove(folder + "state.json");
         ContactState state = ContactState::virgin(c.problem);
         {
            HistoryWriter writer(folder + "cut.csv", c.problem);
            StateSaver saver(folder + "state.json", 0);
            long count = 0;
            const auto dies = [&](const ContactState &now, const IncrementRecord &record)
            {
               writer.add(now, record);
               if (record.resumes) { saver.add(now, record); }
               if (++count == end) { throw std::runtime_error("out of power"); }
            };
            EXPECT_THROW(march(c.problem, history, state, c.settings, dies),
                         std::runtime_error);
         }
         // A line that was cut short, too.
         std::ofstream(folder + "cut.csv", std::ios::app) << "0.5,0,1";
         ContactState rest = ContactState::virgin(c.problem);
         if (std::filesystem::exists(folder + "state.json"))
         {
            rest = load_contact_state(folder + "state.json");
         }
         HistoryWriter writer(folder + "cut.csv", c.problem, rest);
         march(c.problem, history, rest, c.settings,
               [&](const ContactState &now, const IncrementRecord &record)
               { writer.add(now, record); });
         expect_same(rest, whole);
         EXPECT_EQ(content(folder + "cut.csv"), content(folder + "whole.csv"));
         if (HasFailure()) { return; }
      }
   }
}

TEST(Streaming, AHistoryIsGoneOnWithOnlyIfItIsTheSame)
{
   const std::string file = testing::TempDir() + "history.csv";
   std::mt19937 random(43);
   ReducedProblem problem = random_problem(4, 0.3, 0.1, random);
   std::filesystem::remove(file);
   ContactState state = ContactState::virgin(problem);
   IncrementRecord record;
   record.multipliers = record.conjugates = VectorXd::Zero(2);
   state.time = 3;
   {
      HistoryWriter none(file, problem, state); // no file to go on with: a new one
      for (double time : {0.5, 1.0, 1.5})
      {
         record.time = time;
         none.add(state, record);
      }
   }
   const std::string before = content(file);
   EXPECT_EQ(std::count(before.begin(), before.end(), '\n'), 4);
   // A state of another march: this one never came to time 1.2, and had other loads at time 1.
   state.time = 1.2;
   expect_input_error([&] { HistoryWriter(file, problem, state); }, "belongs to another march");
   state.time = 1;
   state.multipliers[1] = 1e-17;
   expect_input_error([&] { HistoryWriter(file, problem, state); }, "belongs to another march");
   EXPECT_EQ(content(file), before);
   problem.patterns[1].name = "other";
   expect_input_error([&] { HistoryWriter(file, problem, state); },
                      "displacement per unit of other");
   problem.patterns[1].name = "a\nb";
   expect_input_error([&] { HistoryWriter(file, problem, state); }, "has a line break");
   EXPECT_EQ(content(file), before);
   problem.patterns[1].name = "shear";
   problem.H.resize(0, 0);
   expect_input_error([&] { HistoryWriter(file, problem, state); },
                      "must be 'time,cycle,load press,load shear");
   EXPECT_EQ(content(file), before);
   expect_input_error([&] { HistoryWriter("no folder/h.csv", problem); }, "no folder");
   expect_input_error([&] { StateSaver(testing::TempDir() + "s.json", -1); }, "seconds is -1");
   expect_input_error([&] { StateSaver("no folder/s.json"); }, "no folder");
}

TEST(Streaming, RowsAreThereAsSoonAsTheyAreAdded)
{
   const std::string folder = testing::TempDir();
   std::mt19937 random(44);
   ReducedProblem problem = random_problem(4, 0.3, 0.1, random);
   problem.arc_length = Eigen::Vector4d(0, 1, 2, 3);
   problem.position = Eigen::MatrixXd::Zero(4, 2);
   HistoryWriter history(folder + "growing.csv", problem);
   NodeWriter nodes(folder + "growing_nodes.csv", problem);
   ContactState state = ContactState::virgin(problem);
   long rows = 0;
   march(problem, to_and_fro(problem, 1), state, {},
         [&](const ContactState &now, const IncrementRecord &record)
         {
            history.add(now, record);
            nodes.add(now);
            ++rows;
            for (const auto &[file, lines] :
                 {std::pair{"growing.csv", rows + 1}, {"growing_nodes.csv", 4 * rows + 1}})
            {
               const std::string text = content(folder + file);
               EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), lines) << file;
               EXPECT_EQ(text.back(), '\n');
            }
         });

   // Nodes of which it is not known where they are have no rows.
   const std::string none = folder + "nowhere.csv";
   problem.position.resize(0, 0);
   expect_input_error([&] { NodeWriter(none, problem); },
                      "must have arc lengths, positions and weights");
   problem.position = Eigen::MatrixXd::Zero(4, 2);
   problem.arc_length.resize(0);
   expect_input_error([&] { NodeWriter(none, problem); },
                      "must have arc lengths, positions and weights");
   EXPECT_FALSE(std::filesystem::exists(none));
}

TEST(Streaming, AStateIsSavedWhenItIsTime)
{
   const std::string file = testing::TempDir() + "saved.json";
   std::filesystem::remove(file);
   std::mt19937 random(45);
   const ReducedProblem problem = random_problem(4, 0.3, 0.1, random);
   const ContactState state = ContactState::virgin(problem);
   IncrementRecord on_grid, on_path;
   on_path.resumes = false;
   StateSaver later(file, 1e6), now(file, 0);
   later.add(state, on_grid);
   EXPECT_FALSE(std::filesystem::exists(file));
   now.add(state, on_grid);
   EXPECT_TRUE(std::filesystem::exists(file));
   expect_same(load_contact_state(file), state);
}

TEST(Progress, GrowsFromTheStartOfTheMarchToItsEnd)
{
   std::mt19937 random(46);
   const ReducedProblem problem = random_problem(8, 0.3, 0.1, random);
   const LoadHistory history = to_and_fro(problem, 3); // times 0 to 10
   std::vector<Progress> told;
   MarchSettings settings;
   settings.stop_at_steady_state = false;
   settings.every_event = true; // each is told of
   settings.monitor.interval = 0;
   settings.monitor.progress = [&](const Progress &progress) { told.push_back(progress); };
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, history, state, settings);
   ASSERT_EQ(told.size(), report.increments.size() + 1); // and the end
   for (std::size_t k = 0; k + 1 < told.size(); ++k)
   {
      EXPECT_EQ(told[k].steps, static_cast<long>(k) + 1);
      EXPECT_EQ(told[k].time, report.increments[k].time);
      EXPECT_NEAR(told[k].share, report.increments[k].time / 10, 1e-15);
      EXPECT_GE(told[k + 1].seconds, told[k].seconds);
   }
   EXPECT_EQ(told.back().share, 1);

   // From half of the way on it is of the other half.
   state = ContactState::virgin(problem);
   std::atomic<bool> stop{false};
   settings.monitor.stop = &stop;
   settings.monitor.progress = [&](const Progress &progress)
   {
      told.push_back(progress);
      stop = progress.time >= 5;
   };
   told.clear();
   EXPECT_EQ(march(problem, history, state, settings).status, FrictionStatus::stopped);
   EXPECT_NEAR(told.back().share, state.time / 10, 1e-15);
   const double from = state.time;
   told.clear();
   settings.monitor.stop = nullptr;
   march(problem, history, state, settings);
   EXPECT_NEAR(told.front().share, (told.front().time - from) / (10 - from), 1e-15);

   // The first increment and the end, if asked not to be told too often.
   told.clear();
   settings.monitor.interval = 1e6;
   state = ContactState::virgin(problem);
   march(problem, history, state, settings);
   EXPECT_EQ(told.size(), 2u);
   settings.monitor.interval = -1;
   expect_input_error([&] { march(problem, history, state, settings); }, "interval is -1");
}

std::atomic<bool> interrupted{false};

TEST(Stop, ASignalStops)
{
   std::mt19937 random(47);
   const ReducedProblem problem = random_problem(8, 0.3, 0.1, random);
   const auto before = std::signal(SIGINT, [](int) { interrupted = true; });
   MarchSettings settings;
   settings.monitor.stop = &interrupted;
   ContactState state = ContactState::virgin(problem);
   const MarchReport report = march(problem, to_and_fro(problem, 3), state, settings,
                                    [](const ContactState &now, const IncrementRecord &)
                                    {
                                       if (now.time > 2) { std::raise(SIGINT); }
                                    });
   std::signal(SIGINT, before);
   EXPECT_EQ(report.status, FrictionStatus::stopped);
   EXPECT_GT(report.time, 2);
   EXPECT_LT(report.time, 4);
}

TEST(Stop, DerivativesThatAreStoppedAreNotKnown)
{
   std::mt19937 random(53);
   const ReducedProblem problem = random_problem(8, 0.3, 0.1, random);
   const MarchTrace trace = trace_march(problem, to_and_fro(problem, 1));
   const Response lost = Responses(problem, trace).dissipation(0, trace.last());
   Sensitivity sensitivity(problem, trace);
   Parameters change;
   change.friction = problem.friction;
   const VectorXd known = sensitivity.gradient(lost).by.friction;
   std::atomic<bool> stop{false};
   long told = 0;
   Monitor monitor;
   monitor.interval = 0;
   monitor.stop = &stop;
   monitor.progress = [&](const Progress &progress)
   {
      EXPECT_EQ(progress.steps, told++);
      EXPECT_LT(progress.share, 1);
      stop = told == 5;
   };
   const Gradient gradient = sensitivity.gradient(lost, monitor);
   EXPECT_FALSE(gradient.found);
   EXPECT_EQ(gradient.message, "it was stopped on request");
   EXPECT_EQ(told, 5);
   told = 0;
   stop = false;
   const TraceChange along = sensitivity.along(change, monitor);
   EXPECT_FALSE(along.found);
   expect_input_error([&] { along.of(lost); }, "it was stopped on request");
   // What throws leaves all as it was.
   stop = false;
   monitor.progress = [](const Progress &progress)
   {
      if (progress.steps == 3) { throw std::runtime_error("enough"); }
   };
   EXPECT_THROW(sensitivity.gradient(lost, monitor), std::runtime_error);
   EXPECT_EQ(sensitivity.gradient(lost).by.friction, known);
}

TEST(Stop, ALimitSaysOnlyWhatIsProven)
{
   using namespace shakedown_test;
   const LimitProblem problem =
      limit_problem(punch_like(33), held_and_cycled(punch_like(33), "P", 1, "Q", -0.5));
   LimitSettings settings;
   testing::internal::CaptureStdout(); // Ipopt would talk, if it were let
   const LimitReport whole = load_limit(problem, settings);
   EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
   if (whole.status == LimitStatus::unavailable) { GTEST_SKIP() << whole.message; }
   ASSERT_EQ(whole.status, LimitStatus::certified);
   const LimitReport whole_friction = friction_limit(problem, 1);
   int stopped = 0;
   for (int after : {0, 1, 3, 7, 12, 20})
   {
      std::atomic<bool> stop{after == 0};
      settings.monitor.stop = &stop;
      settings.monitor.interval = 0;
      settings.monitor.progress = [&](const Progress &p)
      {
         EXPECT_EQ(p.time, 0); // a limit has none
         if (p.steps >= after) { stop = true; }
      };
      const LimitReport load = load_limit(problem, settings);
      if (load.status == LimitStatus::stopped)
      {
         ++stopped;
         EXPECT_LE(load.lower, whole.upper);
         EXPECT_GE(load.upper, whole.lower);
         EXPECT_LE(load.iterations, after + 3);
      }
      else { EXPECT_EQ(load.status, LimitStatus::certified); }
      stop = after == 0;
      const LimitReport friction = friction_limit(problem, 1, settings);
      if (friction.status == LimitStatus::stopped)
      {
         ++stopped;
         EXPECT_LE(friction.lower, whole_friction.upper);
         EXPECT_GE(friction.upper, whole_friction.lower);
      }
      else { EXPECT_EQ(friction.status, LimitStatus::certified); }
      EXPECT_STREQ(name(LimitStatus::stopped), "stopped");
   }
   EXPECT_GE(stopped, 6);

   // A march in time that did not end has no verdict, and finds no counter-example.
   std::atomic<bool> stop{true};
   CounterExampleSettings search;
   search.transient.march.monitor.stop = &stop;
   const CounterExample found = find_counter_example(problem, whole, 0.1, search);
   EXPECT_FALSE(found.found);
   EXPECT_EQ(found.quiet, 0.1);
   EXPECT_EQ(found.marches, 1);
   EXPECT_NE(found.message.find("stopped"), std::string::npos);
   const TransientBracket bracket = transient_bracket(problem, whole, 0.05, search.transient);
   EXPECT_EQ(bracket.below[0].verdict, TransientVerdict::stopped);
   EXPECT_EQ(bracket.below[0].status, FrictionStatus::stopped);
   EXPECT_STREQ(name(TransientVerdict::stopped), name(FrictionStatus::stopped));
}

} // namespace
