#pragma once

#include <cmath>

namespace cattaneo
{

/// What the (x, y) plane of a two-dimensional mesh stands for.
enum class Formulation
{
   plane,        ///< (u_x, u_y), plane strain or plane stress, per unit thickness
   axisymmetric, ///< x = r, y = z: (u_r, u_z), the whole circumference
   torsion       ///< x = r, y = z: the twist ψ = u_θ/r, the whole circumference
};

/// What it is called in messages.
inline const char *name(Formulation formulation)
{
   const char *const names[] = {"plane", "axisymmetric", "of torsion"};
   return names[static_cast<int>(formulation)];
}

/// Unknowns a node: (x, y), (r, z), or the twist alone.
inline int components(Formulation formulation)
{
   return formulation == Formulation::torsion ? 1 : 2;
}

/// What a component is called in messages.
inline const char *component_name(Formulation formulation, int component)
{
   const char *const names[3][2] = {{"x", "y"}, {"r", "z"}, {"twist", ""}};
   return names[static_cast<int>(formulation)][component];
}

/** Length of the circle (or thickness of the slice) that a point at x = r of the plane stands
    for: the one place where the 2πr of axisymmetry is written. Operators, loads and the weights
    of contact lines are integrals over the plane times this. */
inline double measure(Formulation formulation, double r)
{
   return formulation == Formulation::plane ? 1.0 : 2 * M_PI * r;
}

/** Displacement of a point at x = r for a unit value of the unknown: u_θ = r ψ in torsion. A
    force per area does work on the unknown with this lever, so that forces that are conjugate
    to the twist are torques. */
inline double lever(Formulation formulation, double r)
{
   return formulation == Formulation::torsion ? r : 1.0;
}

} // namespace cattaneo
