#pragma once

#include "common/own_history.hpp"
#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/friction/loop.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <map>
#include <string>
#include <vector>

namespace miniapp
{

/// What is said of a case's interfaces and bolts: resultants, losses, loops, forces.
class JointReport
{
public:
   /// All must outlive it.
   JointReport(Study &study, const JointCase &joint, const cattaneo::Reduction &reduction);
   /// The march that begins: when its bolts are tightened, and what a state from which it is
   /// taken up keeps of them. Prints which bolts are tightened again by a value that they have.
   void begin(const OwnHistory &history, const cattaneo::BoltedJoint *bolts);
   /// Puts into a state that is saved what begin() is to find in it.
   void keep(cattaneo::ContactState &state) const;
   /// A state that the march has reached, in this cycle (0: in none), or is taken up from (0).
   void note(const cattaneo::ContactState &state, int cycle);
   /// Forces of the contact on the first body, of a case with one interface; also in the
   /// results.
   std::string of_state(const cattaneo::ContactState &state);
   /// Forces of the shanks.
   std::vector<double> shanks(const cattaneo::ContactState &state) const;
   /// Tables and loops, at the end.
   void report(const cattaneo::ContactState &state, const cattaneo::MarchReport &march);

private:
   /// Resultants of an interface: pressure and shear on its first body, and their moment about
   /// its middle (about an axis, the torque). The defect is the sum of the moments on both
   /// bodies.
   struct Resultant
   {
      double normal = 0, tangential = 0, moment = 0, defect = 0, torque = 0;
      Eigen::Vector2d force{0, 0};
   };
   Resultant resultant(const cattaneo::InterfaceReport &face,
                       const cattaneo::ContactState &state) const;
   Eigen::Vector2d middle(const cattaneo::InterfaceReport &face) const;
   std::string body(int b) const;
   /// Do bodies twist about the axis?
   bool twists() const { return !reduction_.torsion.empty(); }
   void report_interfaces(const cattaneo::ContactState &state,
                          const cattaneo::MarchReport &march);
   void report_cycles(const cattaneo::MarchReport &march);
   void report_bolts(const cattaneo::ContactState &state);
   void draw_loops();

   Study &study_;
   const JointCase &joint_;
   const cattaneo::Reduction &reduction_;
   /// Mean slip of an interface and the sum of the shear that resists it. For bodies that
   /// twist, mean rotation and torque.
   struct Course
   {
      std::vector<double> slip, shear; ///< as far as a picture can show
      /// The last point before a cycle begins its loop.
      struct Cycle
      {
         cattaneo::Loop loop;
         double force = 0, slip = 0; ///< what is less than 1e-12 of these is none
      };
      std::map<int, Cycle> cycles;
   };
   std::vector<Course> courses_;
   int begun_ = 0; ///< cycle within which the march was taken up
   struct Range
   {
      double load = 0;            ///< the largest multiplier of the bolt's own load so far
      double least = 0, most = 0; ///< since its tightening ended
      double push = 0;            ///< the most that it pushed its ends apart at any time
      double tight = 0;           ///< its force when its own tightening ended
      double all_tight = 0;       ///< and when that of the last bolt did
   };
   std::vector<Range> range_; ///< of each bolt's force
   /// Points of the history that tighten a bolt, and the times at which each of these begins
   /// and ends. None of a bolt with a pretension.
   struct Tightening
   {
      int point = 0;
      double from = 0, to = 0;
   };
   std::vector<std::vector<Tightening>> tightenings_;
   bool is_tightened(std::size_t bolt, double time, double load) const;
   /// Of a march that is taken up from a state that keeps nothing of its bolts: its time.
   double known_from_ = 0;
};

} // namespace miniapp
