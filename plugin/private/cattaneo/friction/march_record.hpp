#pragma once

#include <cattaneo/friction/march.hpp>

namespace cattaneo
{

/// What a march has come to: its state, and the report of the increments that led there.
class MarchRecord
{
public:
   /// All must outlive the record.
   MarchRecord(const ReducedProblem &problem, ContactState &state,
               const MarchSettings &settings, const MarchObserver &observer);

   MarchReport report;

   /// The state stands where a cycle begins, or, not `whole`, within it.
   void begin_cycle(int number, bool whole);
   /// The end of an increment of a piece becomes the state. `exact`: by the exact path, or by
   /// one increment where that is exact. `resumes`, `event`: see IncrementRecord.
   void accept(ContactState &&next, const LoadPiece &piece, const IncrementReport &increment,
               bool exact, bool resumes, Eigen::Index event);
   /// The state stands at the last load with an equilibrium.
   void stop(const IncrementReport &failure);
   /// The balance of energy, and how far the march came.
   void close();

   /// The loss of each piece of the history that was marched, from the first one on.
   const std::vector<double> &piece_losses() const { return piece_losses_; }
   /// The loss of each node; empty without friction.
   const Eigen::VectorXd &node_losses() const { return node_losses_; }
   /// The largest work of the loads on the way.
   double most_work() const { return most_work_; }
   /// Were there increments that are not exact?
   bool inexact() const { return inexact_; }

private:
   void end_cycle();
   /// Of the increment from the state to that of the record.
   double external_work(const IncrementRecord &record) const;

   const ReducedProblem &problem_;
   ContactState &state_;
   const MarchSettings &settings_;
   const MarchObserver &observer_;
   Eigen::VectorXd conjugates_; // of the state
   double external_work_ = 0, dissipation_ = 0, normal_work_ = 0;
   double most_work_ = 0; // largest |external work| on the way
   const double energy_at_start_;
   double changed_ = 0;      // see changed_while_closing()
   double moved_energy_ = 0; // all energies that were added up, without their signs
   std::vector<double> piece_losses_;
   Eigen::VectorXd node_losses_;
   double piece_end_ = -std::numeric_limits<double>::infinity(); // of the last of them
   bool inexact_ = false;
};

} // namespace cattaneo
