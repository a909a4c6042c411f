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

/// The report on a case's interfaces and bolts: resultants, losses, loops, forces.
class JointReport
{
public:
   /// All must outlive it.
   JointReport(Study &study, const JointCase &joint, const cattaneo::Reduction &reduction);
   /// To be called when a march begins: finds when its bolts are tightened, and reads their
   /// values from the state with which it continues. Prints which bolts are tightened again to
   /// the value that they have.
   void begin(const OwnHistory &history, const cattaneo::BoltedJoint *bolts);
   /// Adds the values that begin() reads to a state before it is saved.
   void keep(cattaneo::ContactState &state) const;
   /// Takes a state that the march has reached, in this cycle (0: in none), or with which it
   /// continues (0).
   void note(const cattaneo::ContactState &state, int cycle);
   /// Reports the contact forces on the first body, for a case with one interface; also in the
   /// results.
   std::string of_state(const cattaneo::ContactState &state);
   /// Reports the forces of the shanks.
   std::vector<double> shanks(const cattaneo::ContactState &state) const;
   /// Prints tables and loops, at the end.
   void report(const cattaneo::ContactState &state, const cattaneo::MarchReport &march);

private:
   /// Resultants of an interface: pressure and shear on its first body, and their moment about
   /// its middle (in axisymmetry the torque). The defect is the sum of the moments on both
   /// bodies, which should be zero.
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
      double pressing = 0;             ///< the largest force that pressed
      /// The last point before a cycle begins its loop.
      struct Cycle
      {
         cattaneo::Loop loop;
         double force = 0, slip = 0; ///< values below 1e-12 of these count as zero
      };
      std::map<int, Cycle> cycles;
   };
   std::vector<Course> courses_;
   int begun_ = 0; ///< cycle within which the march continued
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
