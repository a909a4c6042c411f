#pragma once

#include <cattaneo/elastic/body.hpp>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace cattaneo
{

// The small language in which users of the programs write supports and loads (docs/contact.md).
// `called` is the name of the text in errors, for instance that of an option. All functions
// throw an InputError with this name and the statement.

/// Properties of the body that a statement may use.
struct BodyTerms
{
   /// Attributes by the names of their groups. A group that is no part of the boundary has
   /// none.
   std::map<std::string, std::vector<int>> boundary;
   bool numbered = true; ///< attributes may be named by their numbers
   /// Coefficient of thermal expansion of the whole body. Without it loads of temperature are
   /// refused.
   double expansion = std::numeric_limits<double>::quiet_NaN();
};

/// Boundary attributes or names of them, perhaps with an interval: "3", "3,4", "flank",
/// "3[-1<x<1]".
BoundaryPart boundary_part(const std::string &called, const std::string &text,
                           const BodyTerms &terms = {});

/// A number or a function of the coordinates (Expression): "0.5", "-3*x", "1+2*x-y^2", about an
/// axis also of r and z.
ScalarField scalar_field(const std::string &called, const std::string &text,
                         Formulation formulation = Formulation::plane);

/// Supports, separated by spaces: "1:x 2,4:xy" fixes components on boundary attributes,
/// "@0,-1:x" at the node nearest to a point, which must lie within the body. About an axis
/// components are r and z, x and y mean the same, and t, around the axis: "1:rzt". An
/// axisymmetric body takes r and z from the same text, its torsion body t.
void add_supports(ElasticBody &body, const std::string &called, const std::string &text,
                  const BodyTerms &terms = {});

/// Boundary attributes that supports hold, in any component. Supports of single nodes at points
/// are left out. InputError as of add_supports().
std::vector<int> supported_attributes(const std::string &called, const std::string &text,
                                      const BodyTerms &terms = {});

/// Loads, separated by semicolons, each "PATTERN KIND WHERE VALUES": "P pressure 3 100", "Q
/// traction 3 0.5 0", "G body-force 0 -9.81", "D displacement-x 3[0<y<1] 0.01", "H temperature
/// 20+3*y", "E initial-strain 1e-4" or "E initial-strain xx yy xy zz" (rr, zz, rz and θθ about
/// an axis; xy is half of the angle). Names of patterns are UTF-8, without = , and ". About an
/// axis also "T traction-t 3 0.5", force per area around it, and "W twist 3 0.01", a turn about
/// it in radians: from the same text a torsion body takes these loads, and an axisymmetric body
/// the others.
void add_loads(ElasticBody &body, const std::string &called, const std::string &text,
               const BodyTerms &terms = {});

/// True if supports or loads act around an axis.
bool twists(const std::string &supports, const std::string &loads);

} // namespace cattaneo
