#pragma once

#include <cattaneo/friction/march_record.hpp>
#include <cattaneo/friction/near_path.hpp>
#include <cattaneo/progress_report.hpp>

namespace cattaneo
{

/// A piece of the history, cut by equal steps: increments, or the stops of a path.
class SteppedPiece
{
public:
   SteppedPiece() = default;
   SteppedPiece(LoadPiece loads, int steps) : loads_(std::move(loads)), steps_(steps) {}

   const LoadPiece &loads() const { return loads_; }
   int steps() const { return steps_; }
   double end() const { return loads_.end; }
   double duration() const { return loads_.duration(); }
   /// The first end of a step after a time before the piece's own end.
   double end_of_step(double time) const;
   Eigen::VectorXd multipliers(double time) const;

private:
   double end_of(double step) const;

   LoadPiece loads_;
   int steps_ = 1;
};

/// Increments of a piece of a march's history.
int steps_of_piece(const MarchSettings &settings, const LoadPiece &piece);

/// Does the friction bound of a node consist of more than one line?
bool friction_bends(const ReducedProblem &problem);

/// For a state before any load. Moves free bodies that touch nothing until they touch where the
/// first loads push them. Returns the largest distance; 0: nothing is moved.
double take_up_clearance(const ReducedProblem &problem, const LoadHistory &history,
                         ContactState &state);

/// One march in progress.
class MarchRun
{
public:
   /// All must outlive it.
   MarchRun(FrictionSolver &solver, const LoadHistory &history, ContactState &state,
            const MarchSettings &settings, const MarchObserver &observer);

   /// Marches to the end of the history, or to the last equilibrium that is found.
   MarchReport run();
   /// The losses of what run() has marched.
   const Losses &losses() const { return record_.losses(); }

private:
   // Each returns false where the march ends.
   bool march_pieces();
   bool march_piece();
   bool stay(double target);
   bool follow_path();
   bool start_path();
   bool path_step(std::string &reason);
   bool step_by_increment(double target, bool exact);

   void begin_cycle(bool first_piece);
   bool restart_without_clearance();
   bool is_stopped();
   bool equilibria_end();
   double first_closing(double target);
   double first_known(double from, double target);
   double first_unbalanced(double failed) const;
   void bisect_last_equilibrium(double failed, IncrementReport failure);

   bool has_path() const;
   bool self_similar() const;
   bool exact_in_one() const;
   double share() const;
   MarchStep attempt(double time, bool whole = false);
   void accept(MarchStep &&step);
   void note(const std::vector<StateChange> &changes);

   FrictionSolver &solver_;
   const ReducedProblem &problem_;
   NearContacts near_;
   const LoadHistory &history_;
   ContactState &state_;
   const MarchSettings &settings_;
   const bool friction_bends_;
   MarchRecord record_;
   ProgressReport progress_;
   const double began_, end_;       // times of the load history
   SteppedPiece piece_;             // the present one
   std::unique_ptr<NearPath> path_; // made when first needed, and kept over stops and pieces
};

} // namespace cattaneo
