#pragma once

#include "extent.hpp"
#include <cattaneo/friction/march.hpp>
#include <string>

namespace cattaneo_test
{

/// How a run of the stress suite ended. Nothing but `wrong` is a failure of the library: the
/// others are solutions that were verified, or stated reasons.
enum class Outcome
{
   verified,      ///< converged, and every increment meets the laws
   not_unique,    ///< the same, and said to be above critical friction
   gross_sliding, ///< stopped there; the last state verified
   no_solution,   ///< likewise
   stalled,       ///< likewise: no method reached the tolerance
   wrong          ///< a state that breaks the laws, or a reason that is not true
};

/// One run.
struct Verdict
{
   Outcome outcome = Outcome::verified;
   double violation = 0; ///< largest of all increments, over what is allowed
   std::string what;     ///< why it is wrong, or the reason that was stated
   cattaneo::MarchReport report;
};

/// Adds a run to a row of the table, which is printed when all tests have run, and fails the
/// test, naming the run, if its outcome is `wrong`.
void record(const std::string &family, const std::string &run, const Verdict &verdict);

/// A remark below the table.
void remark(const std::string &text);

/// Counts the method that found the end of an increment, for a line below the table.
void count_method(const cattaneo::IncrementReport &report);

/// Runs of a row that had an outcome.
long count(const std::string &family, Outcome outcome);

/// Marches a history and verifies every increment by LawChecker. Gross sliding and lifting off
/// must be proven by a mechanism just beyond the load at which they came.
Verdict march_and_verify(const cattaneo::ReducedProblem &problem,
                         const cattaneo::LoadHistory &history, cattaneo::ContactState &state,
                         const cattaneo::MarchSettings &settings = {});

} // namespace cattaneo_test
