#pragma once

#include <cattaneo/fretting/half_plane.hpp>

namespace cattaneo::fretting
{

/** The numbers through which the contact acts on its edge, at one instant of the load (thesis
    2.2).

    Coordinates: t along the surface from the edge into the contact, y into the cracked body.
    Any consistent units: with N and mm, K_N is in MPa/√mm and K_T in MPa√mm. */
struct Edge
{
   double k_n = 0.0;      ///< pressure p = K_N √t (2.1), > 0
   double k_t = 0.0;      ///< fully stuck shear q = K_T/√t (2.4); > 0 pulls the body in +t
   double friction = 0.0; ///< Coulomb coefficient f, > 0: without friction nothing sticks

   /// InputError outside the ranges above. K_T < 0 (leading edge) and K_T = 0 are allowed.
   void validate() const;
};

/** Length of the slip zone d = 2|K_T|/(f K_N) (2.11).
    A lower bound: for Hertz it is (1 + √(1 - Q/fP))/2 times the exact one. */
double slip_zone(const Edge &edge);

/// Contact pressure at t (2.1); 0 outside the contact.
double pressure(const Edge &edge, double t);

/// Shear traction at t under partial slip, f K_N (√t - √(t-d)) (2.12 with √2 for its 2).
double shear_traction(const Edge &edge, double t);

/// Stress at (t, y), y >= 0, in the near-edge field ((2.13)-(2.16), corrected).
InPlaneStress stress(const Edge &edge, double t, double y);

/// σ_xx at the contact edge, ±√(8 f K_N |K_T|) with the sign of K_T (thesis 2.5.1, doubled).
double edge_stress(const Edge &edge);

} // namespace cattaneo::fretting
