#pragma once

#include "common/own_history.hpp"
#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/joints/bolts.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// The report on the bolts of a case: when they are tightened, and their forces.
class BoltsReport
{
public:
   /// All must outlive it.
   BoltsReport(Study &study, const JointCase &joint, const cattaneo::Reduction &reduction);
   /// To be called when a march begins: finds when its bolts are tightened, and reads their
   /// values from the state with which it continues. Prints which bolts are tightened again to
   /// the value that they have.
   void begin(const OwnHistory &history, const cattaneo::BoltedJoint *bolts);
   /// Adds the values that begin() reads to a state before it is saved.
   void keep(cattaneo::ContactState &state) const;
   /// Takes a state that the march has reached.
   void note(const cattaneo::ContactState &state);
   /// The forces of the shanks.
   std::vector<double> shanks(const cattaneo::ContactState &state) const;
   /// Prints the table of the forces, at the end; nothing without bolts.
   void report(const cattaneo::ContactState &state);

private:
   Study &study_;
   const JointCase &joint_;
   const cattaneo::Reduction &reduction_;
   struct Range
   {
      double load = 0;            ///< the largest multiplier of the bolt's own load so far
      double least = 0, most = 0; ///< since its tightening ended
      double push = 0;            ///< the largest force with which it pushed its ends apart
      double tight = 0;           ///< its force when its own tightening ended
      double all_tight = 0;       ///< its force when all bolts were tightened
   };
   std::vector<Range> range_; ///< of each bolt's force
   /// Points of the history that tighten a bolt, and the times at which each of these
   /// tightenings begins and ends. None for a bolt with a pretension.
   struct Tightening
   {
      int point = 0;
      double from = 0, to = 0, value = 0;
   };
   std::vector<std::vector<Tightening>> tightenings_;
   bool is_tightened(std::size_t bolt, double time, double load) const;
   /// Point and value of each tightening that has begun before a time.
   std::vector<double> tightened_before(std::size_t bolt, double time) const;
   /// InputError if the march that saved a state has tightened bolts differently.
   void check_tightenings(const cattaneo::ContactState &state) const;
   /// For a march that continues from a state without values of bolts: its time.
   double known_from_ = 0;
};

} // namespace miniapp
