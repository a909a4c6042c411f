#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <string>

namespace miniapp
{

/// The options that a case file of contact has, of which a joint that vibrates needs its bodies
/// and the history up to its assembly.
struct CaseOfJoint
{
   int order = 2, cycle_start = -1, cycles = 1, increments = 20, at_point = -1;
   double thickness = none;
   std::string analysis = "plane strain", geometry = "smooth", bodies, interfaces, bolts,
               points, units, history;

   explicit CaseOfJoint(Study &study);
   JointCase joint() const;
   /// Names the units of what is printed.
   void name_units(Study &study, const JointCase &joint) const;
};

} // namespace miniapp
