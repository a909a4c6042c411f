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

   /// The end of an increment becomes the state. `exact`: by the exact path, or by one
   /// increment where that is exact.
   void accept(ContactState &&next, int cycle, const IncrementReport &increment, bool exact);
   void end_cycle();
   /// The state stands at the last load with an equilibrium.
   void stop(const IncrementReport &failure);
   /// The balance of energy, and how far the march came.
   void close();

private:
   const ReducedProblem &problem_;
   ContactState &state_;
   const MarchSettings &settings_;
   const MarchObserver &observer_;
   CycleRecord cycle_;
   double external_work_ = 0, dissipation_ = 0, normal_work_ = 0;
   const double energy_at_start_;
   double changed_ = 0; // see changed_while_closing()
};

} // namespace cattaneo
