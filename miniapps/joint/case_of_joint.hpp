#pragma once

#include "common/study.hpp"
#include "contact/joint_case.hpp"

#include <string>

namespace miniapp
{

/// The options in a case file of contact. For a joint that vibrates, the bodies and the history
/// up to the assembly are used.
struct CaseOfJoint
{
   int order = 2, cycle_start = -1, cycles = 1, increments = 20, at_point = -1;
   double thickness = none;
   std::string analysis = "plane strain", geometry = "smooth", bodies, interfaces, bolts,
               points, units, history;

   explicit CaseOfJoint(Study &study);
   JointCase joint() const;
   /// Names the units of printed values.
   void name_units(Study &study, const JointCase &joint) const;
};

} // namespace miniapp
