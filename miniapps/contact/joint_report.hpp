#pragma once

#include "common/own_history.hpp"
#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <cattaneo/friction/loop.hpp>
#include <cattaneo/friction/march.hpp>
#include <map>
#include <string>
#include <vector>

namespace miniapp
{

/// The report on the interfaces of a case: resultants, losses and loops.
class JointReport
{
public:
   /// All must outlive it.
   JointReport(Study &study, const JointCase &joint, const cattaneo::Reduction &reduction);
   /// Takes a state that the march has reached, in this cycle (0: in none), or with which it
   /// continues (0).
   void note(const cattaneo::ContactState &state, int cycle);
   /// Reports the contact forces on the first body, for a case with one interface; also in the
   /// results.
   std::string of_state(const cattaneo::ContactState &state);
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
};

} // namespace miniapp
