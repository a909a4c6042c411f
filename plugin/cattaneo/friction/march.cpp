#include <cattaneo/friction/loss_check.hpp>
#include <cattaneo/friction/march_run.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <memory>

namespace cattaneo
{

using Eigen::VectorXd;

void MarchSettings::validate() const
{
   friction.validate();
   require_at_least("march settings: increments", increments, 1);
   for (int count : increments_of_piece)
   {
      require_at_least("march settings: an entry of increments_of_piece", count, 1);
   }
   require_at_least("march settings: max_halvings", max_halvings, 0);
   require_at_least("march settings: steady_tolerance", steady_tolerance, 0);
   monitor.validate();
}

namespace
{

/// A history must go on with the loads of the state. If they jump, the path in between is not
/// known, and the friction forces depend on it.
void check_loads(const FrictionSolver &solver, const LoadHistory &history,
                 const ContactState &state)
{
   if (solver.frictionless()) { return; }
   int k = 0;
   while (k + 1 < history.pieces() && history.piece(k).end <= state.time) { ++k; }
   const LoadPiece piece = history.piece(k);
   if (state.time >= piece.end) { return; }
   const bool begins = state.time <= history.times[0];
   const VectorXd loads =
      begins ? piece.from : piece.at((state.time - piece.start) / piece.duration());
   const bool at_rest = state.multipliers.isZero(0);
   for (Eigen::Index l = 0; l < loads.size(); ++l)
   {
      // Late in a long history the time of a state has few digits for its place within a piece.
      const double most = history.multipliers.row(l).cwiseAbs().maxCoeff();
      require(std::abs(loads[l] - state.multipliers[l]) <= 1e-6 * most, "history: load '",
              solver.problem().patterns[l].name, "' is ", loads[l], " at ",
              begins ? "its first point" : "time " + exact_text(state.time), ", and ",
              state.multipliers[l],
              at_rest ? " before any load: begin with a point without loads"
                      : " in the state from which the march continues: begin with the loads of "
                        "that state");
   }
}

} // namespace

MarchReport march(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
                  const MarchSettings &settings, const MarchObserver &observer)
{
   // 1. Input that does not fit is refused.
   settings.validate();
   state.validate(solver.problem());
   history.validate(solver.problem());
   check_loads(solver, history, state);
   // 2. The march.
   const bool asks_for_loss = settings.loss_error && solver.problem().components() > 0;
   std::optional<ContactState> start;
   if (asks_for_loss) { start = state; }
   MarchRun run(solver, history, state, settings, observer);
   MarchReport report = run.run();
   // 3. Estimate the error of its loss by another march from the same state.
   if (asks_for_loss)
   {
      if (report.taken_up_clearance > 0)
      {
         take_up_clearance(solver.problem(), history, *start);
      }
      report.loss_error = loss_error(solver, history, *start, settings, run.losses(), report);
   }
   return report;
}

MarchReport march(const ReducedProblem &problem, const LoadHistory &history,
                  ContactState &state, const MarchSettings &settings,
                  const MarchObserver &observer)
{
   const std::shared_ptr<const ReducedProblem> lent(std::shared_ptr<void>(), &problem);
   FrictionSolver solver(lent, settings.friction);
   const Counters made = solver.counters();
   MarchReport report = march(solver, history, state, settings, observer);
   report.counters += made;
   return report;
}

} // namespace cattaneo
