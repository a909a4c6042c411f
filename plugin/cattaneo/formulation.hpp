#pragma once

#include <cmath>

namespace cattaneo
{

/// The meaning of a body's coordinates and displacements.
enum class Formulation
{
   plane,        ///< (u_x, u_y), plane strain or plane stress, per unit thickness
   axisymmetric, ///< x = r, y = z: (u_r, u_z), the whole circumference
   torsion,      ///< x = r, y = z: the twist ψ = u_θ/r, the whole circumference
   space         ///< (u_x, u_y, u_z)
};

/// Its name in messages.
inline const char *name(Formulation formulation)
{
   const char *const names[] = {"plane", "axisymmetric", "of torsion", "in space"};
   return names[static_cast<int>(formulation)];
}

/// Unknowns per node: (x, y), (r, z), only the twist, or (x, y, z).
inline int components(Formulation formulation)
{
   return formulation == Formulation::torsion ? 1 : formulation == Formulation::space ? 3 : 2;
}

/// Number of coordinates of a place.
inline int dimension(Formulation formulation)
{
   return formulation == Formulation::space ? 3 : 2;
}

/// Is x the distance from an axis?
inline bool about_axis(Formulation formulation)
{
   return formulation == Formulation::axisymmetric || formulation == Formulation::torsion;
}

/// The name of a component in messages.
inline const char *component_name(Formulation formulation, int component)
{
   const char *const names[4][3] = {
      {"x", "y", ""}, {"r", "z", ""}, {"twist", "", ""}, {"x", "y", "z"}};
   return names[static_cast<int>(formulation)][component];
}

/** Length of the circle, 2πr, (or thickness of the slice) that belongs to a point at x = r of
    the plane. The 2πr of axisymmetry is written only here. Operators, loads and the weights of
    contact lines are integrals over the plane times this. */
inline double measure(Formulation formulation, double r)
{
   return about_axis(formulation) ? 2 * M_PI * r : 1.0;
}

/** Displacement of a point at x = r for a unit value of the unknown: u_θ = r ψ in torsion. A
    force per area does work on the unknown with this lever, so that forces that are conjugate
    to the twist are torques. */
inline double lever(Formulation formulation, double r)
{
   return formulation == Formulation::torsion ? r : 1.0;
}

} // namespace cattaneo
