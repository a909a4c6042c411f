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
   double changed_ = 0; // see changed_while_closing()
};

} // namespace cattaneo
