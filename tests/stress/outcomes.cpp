#include "outcomes.hpp"

#include "contact_laws.hpp"

#include <array>
#include <cattaneo/friction/free_bodies.hpp>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <map>
#include <vector>

namespace cattaneo_test
{

using namespace cattaneo;

namespace
{

struct Row
{
   std::string family;
   long runs = 0;
   std::array<long, 6> outcomes{};
   double violation = 0;
};

struct Table : testing::Environment
{
   std::vector<Row> rows;
   std::vector<std::string> remarks;
   std::map<std::string, long> methods;

   Row &row(const std::string &family)
   {
      for (Row &row : rows)
      {
         if (row.family == family) { return row; }
      }
      rows.push_back({});
      rows.back().family = family;
      return rows.back();
   }

   void TearDown() override
   {
      if (rows.empty()) { return; }
      std::printf("\n%-44s %7s %8s %6s %8s %8s %7s %6s %9s\n", "", "", "", "not", "gross", "no",
                  "", "", "largest");
      std::printf("%-44s %7s %8s %6s %8s %8s %7s %6s %9s\n", "outcomes", "runs", "verified",
                  "unique", "sliding", "solution", "stalled", "wrong", "violation");
      Row total;
      total.family = "all";
      for (const Row &row : rows)
      {
         print(row);
         total.runs += row.runs;
         for (std::size_t k = 0; k < 6; ++k) { total.outcomes[k] += row.outcomes[k]; }
         total.violation = std::max(total.violation, row.violation);
      }
      print(total);
      std::printf("(violation of the laws by a reported solution, over what the tolerance and "
                  "round-off allow)\n");
      std::printf("single increments by the method that found their end:");
      for (const auto &[name, times] : methods)
      {
         std::printf(" %s %ld;", name.c_str(), times);
      }
      std::printf("\n");
      for (const std::string &text : remarks) { std::printf("%s\n", text.c_str()); }
   }

   static void print(const Row &row)
   {
      std::printf("%-44s %7ld %8ld %6ld %8ld %8ld %7ld %6ld %9.2g\n", row.family.c_str(),
                  row.runs, row.outcomes[0], row.outcomes[1], row.outcomes[2], row.outcomes[3],
                  row.outcomes[4], row.outcomes[5], row.violation);
   }
};

// GoogleTest owns it.
Table *const table =
   static_cast<Table *>(testing::AddGlobalTestEnvironment(new Table)); // NOLINT

} // namespace

void record(const std::string &family, const std::string &run, const Verdict &verdict)
{
   Row &row = table->row(family);
   ++row.runs;
   ++row.outcomes[static_cast<std::size_t>(verdict.outcome)];
   row.violation = std::max(row.violation, verdict.violation);
   if (verdict.outcome == Outcome::wrong)
   {
      ADD_FAILURE() << family << ", " << run << ": " << verdict.what;
   }
   const long stalled = row.outcomes[static_cast<std::size_t>(Outcome::stalled)];
   if (verdict.outcome == Outcome::stalled && stalled <= 6)
   {
      std::printf("stalled: %s, %s: %s\n", family.c_str(), run.c_str(), verdict.what.c_str());
   }
}

void remark(const std::string &text)
{
   table->remarks.push_back(text);
}

void count_method(const IncrementReport &report)
{
   ++table->methods[*report.found_by ? report.found_by : "none"];
}

long count(const std::string &family, Outcome outcome)
{
   return table->row(family).outcomes[static_cast<std::size_t>(outcome)];
}

Verdict march_and_verify(const ReducedProblem &problem, const LoadHistory &history,
                         ContactState &state, const MarchSettings &settings)
{
   Verdict verdict;
   LawChecker laws(problem, state);
   Eigen::VectorXd v_old = state.v;
   MarchSettings every = settings;
   every.every_event = true; // the laws of increments hold on straight pieces
   verdict.report = march(problem, history, state, every,
                          [&](const ContactState &now, const IncrementRecord &record)
                          {
                             const double violation = laws.violation(v_old, now);
                             if (violation > verdict.violation)
                             {
                                verdict.violation = violation;
                                verdict.what =
                                   "at time " + std::to_string(record.time) + " " + laws.what();
                             }
                             v_old = now.v;
                          });
   const MarchReport &report = verdict.report;
   if (!(verdict.violation <= 1))
   {
      verdict.outcome = Outcome::wrong;
      return verdict;
   }
   verdict.what = report.message;
   switch (report.status)
   {
   case FrictionStatus::converged:
      verdict.outcome = Outcome::verified;
      break;
   case FrictionStatus::not_unique:
      verdict.outcome = Outcome::not_unique;
      break;
   case FrictionStatus::gross_sliding:
      verdict.outcome = Outcome::gross_sliding;
      break;
   case FrictionStatus::no_solution:
      verdict.outcome = Outcome::no_solution;
      break;
   case FrictionStatus::stalled:
      verdict.outcome = Outcome::stalled;
      break;
   case FrictionStatus::stopped: // nobody asked it to
      verdict.outcome = Outcome::wrong;
      break;
   }
   const bool ended_early = verdict.outcome != Outcome::verified;
   if (ended_early && report.message.empty())
   {
      verdict.outcome = Outcome::wrong;
      verdict.what = "ended early without a reason";
   }
   const bool lifts_off = report.message.find("lifts off") != std::string::npos;
   if (verdict.outcome != Outcome::gross_sliding && !lifts_off) { return verdict; }
   // Just beyond the load at which it came: on the piece that was being marched.
   int k = 0;
   while (k + 1 < history.pieces() && history.piece(k).end <= report.event_time) { ++k; }
   const LoadPiece piece = history.piece(k);
   const double beyond =
      std::min(1.0, (report.event_time - piece.start) / piece.duration() + 1e-5);
   const Eigen::VectorXd loads = piece.at(beyond);
   const Eigen::VectorXd forces = problem.clamped_forces(loads);
   const Mechanism mechanism = find_mechanism(problem, forces);
   if (!mechanism.exists || !proves_mechanism(problem, mechanism.motion, forces))
   {
      verdict.outcome = Outcome::wrong;
      verdict.what = report.message + ": no mechanism proves it";
   }
   return verdict;
}

} // namespace cattaneo_test
