#include "joint/case_of_joint.hpp"

#include <cmath>

namespace miniapp
{

using namespace cattaneo;

CaseOfJoint::CaseOfJoint(Study &study)
{
   study.options().require_version(2);
   study.options().group("The case, as the program contact reads it");
   study.option(&analysis, "analysis", "plane strain, plane stress, axisymmetric or space.");
   study.option(&thickness, "thickness",
                "Thickness of plane bodies: forces, masses and energies are those of the whole "
                "thickness (default: per thickness).",
                positive);
   study.option(
      &geometry, "geometry",
      "Sides meshed with straight edges: smooth (the curve through their vertices, if "
      "they lie on one) or as meshed (polygons).",
      {"smooth", "as meshed"});
   study.option(&bodies, "bodies", "Bodies by their names, as JSON; each must have a density.",
                Text::structure);
   study.option(&interfaces, "interfaces",
                "Interfaces where bodies touch, by their names, as JSON.", Text::structure);
   study.option(&bolts, "bolts",
                "Bolts, which pull two parts together, by their names, as JSON.",
                Text::structure);
   study.option(&points, "points", "Points for option --amplitude-at, by their names, as JSON.",
                Text::structure);
   study.option(&units, "units",
                "Names of the units of length and force, as JSON. They are printed; numbers "
                "are not converted.",
                Text::structure);
   study.options().add_set();
   study.option(&order, "order", "Order of the elements.", within(1, 8));
   study.option(&history, "history",
                "Load multipliers at times 0, 1, …, as 'P=0; P=1'; default: all from 0 to 1.",
                Text::statements);
   study.option(&at_point, "at-point",
                "Point of the history (from 0) at which the joint vibrates; -1: where its last "
                "bolt is tightened, without bolts where its cycle starts, or its last point.",
                at_least(-1));
   study.option(&cycle_start, "cycle-start",
                "Point of the history where the cycle of the program contact starts.",
                at_least(-1));
   study.option(&cycles, "cycles", "Cycles of the program contact; not used here.",
                at_least(1));
   study.option(
      &increments, "increments",
      "In space: increments between two points of the history. In the plane and about an "
      "axis the march is exact.",
      at_least(1));
}

JointCase CaseOfJoint::joint() const
{
   return joint_case({analysis, structure("bodies", bodies),
                      structure("interfaces", interfaces), structure("bolts", bolts),
                      structure("points", points), structure("units", units), geometry,
                      thickness},
                     order);
}

void CaseOfJoint::name_units(Study &study, const JointCase &joint) const
{
   if (joint.unit_of_length.empty()) { return; }
   study.units = {joint.unit_of_length, joint.unit_of_force,
                  joint.formulation == Formulation::plane && std::isnan(thickness)};
   study.results["units"] = {{"length", joint.unit_of_length}, {"force", joint.unit_of_force}};
}

} // namespace miniapp
