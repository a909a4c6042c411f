#pragma once

#include <cattaneo/friction/march.hpp>

namespace cattaneo
{

/// A step of a march: an increment, or on an exact path a step to the next event or stop.
struct MarchStep
{
   ContactState state; ///< at its end
   IncrementReport increment;
   Eigen::Index event = -1; ///< IncrementRecord's
   bool exact = false;      ///< by the exact path, or by one increment that is exact
   bool resumes = true;     ///< IncrementRecord's
   bool row = true; ///< an IncrementRecord ends here; an event between two stops has none

   /// May it be accepted?
   bool solved() const
   {
      return increment.status == FrictionStatus::converged ||
             increment.status == FrictionStatus::not_unique;
   }
   bool stalled() const { return increment.status == FrictionStatus::stalled; }
};

/// Energy lost by friction in a march.
struct Losses
{
   std::vector<double> pieces; ///< of each piece of the history that was marched, in order
   Eigen::VectorXd nodes;      ///< of each node; empty without friction
   double most_work = 0;       ///< largest |external work| on the way
   bool inexact = false;       ///< there were increments that are not exact
};

/// Present result of a march: its state, and the report of the increments that led there.
class MarchRecord
{
public:
   /// All must outlive the record.
   MarchRecord(const ReducedProblem &problem, ContactState &state,
               const MarchSettings &settings, const MarchObserver &observer);

   MarchReport report;

   /// Replaces the state, before any step was accepted.
   void restart();
   /// A cycle begins at the state. If not `whole`, the state lies within the cycle.
   void begin_cycle(int number, bool whole);
   /// Accepts a step of a piece: its end becomes the state.
   void accept(MarchStep &&step, const LoadPiece &piece);
   /// Notes that the state has the last loads with an equilibrium.
   void stop(const IncrementReport &failure);
   /// Adds the last row, the balance of energy, and the time that the march reached.
   void close();
   const Losses &losses() const { return losses_; }
   /// Was a step accepted that is not in a row yet?
   bool within_row() const { return row_begun_; }

private:
   double add_energies(const ContactState &next, const LoadPiece &piece, bool exact);
   void find_cut_off();
   void end_cycle();
   void end_row();
   /// Work of the step from the state to these multipliers and conjugates.
   double external_work(const Eigen::VectorXd &multipliers,
                        const Eigen::VectorXd &conjugates) const;

   const ReducedProblem &problem_;
   ContactState &state_;
   const MarchSettings &settings_;
   const MarchObserver &observer_;
   Eigen::VectorXd conjugates_; // of the state
   /// Sums over all steps.
   struct
   {
      double external_work = 0, dissipation = 0, normal_work = 0;
      double moved = 0; // all energies that were added up, without their signs
   } sums_;
   double energy_at_start_ = 0;
   double changed_ = 0; // see changed_while_closing()
   Losses losses_;
   double piece_end_ = -std::numeric_limits<double>::infinity(); // of the last of its pieces
   IncrementRecord row_;    // that the steps since the last one add up to …
   bool row_begun_ = false; // … if there are any
};

} // namespace cattaneo
