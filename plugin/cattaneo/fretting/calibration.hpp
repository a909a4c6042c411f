#pragma once

namespace cattaneo::fretting
{

/** E* of two similar bodies: E/(2(1-ν²)) in plane strain, E/2 in plane stress.
    InputError for E <= 0 or ν out of range. */
double contact_modulus(double young, double poisson, bool plane_stress = false);

/// Two cylinders or a cylinder on a plane, in terms of half width and peak pressure.
struct HertzContact
{
   double half_width = 0.0;    ///< a
   double peak_pressure = 0.0; ///< p0
   double k_n = 0.0;           ///< p0 √(2/a) (2.3)
};

/** Hertz contact under the normal force @a load per unit thickness; @a radius is the relative
    radius R = 1/(1/R1 + 1/R2), @a modulus is E*. InputError unless all are positive. */
HertzContact hertz_contact(double load, double radius, double modulus);

/// Calibration (2.20) of a Hertz contact whose half width is known.
double hertz_k_n(double load, double half_width);

/// A pad with a flat of half width b and rounded edges of radius R, pressed by P.
struct FlatRoundedContact
{
   double flat = 0.0;       ///< b
   double radius = 0.0;     ///< R
   double modulus = 0.0;    ///< E*
   double half_width = 0.0; ///< a > b
   double k_n = 0.0;        ///< E* /(πR) √(2a) arccos(b/a)

   /// Pressure at x from the centre; 0 outside the contact.
   double pressure(double x) const;
};

/** Finds the half width a at which E* /(2R) (a² arccos(b/a) - b√(a²-b²)) is @a load.
    InputError unless load, radius, modulus > 0 and flat >= 0 (0 is Hertz). */
FlatRoundedContact flat_rounded_contact(double load, double radius, double flat,
                                        double modulus);

/// The rounded edge of a semi-infinite flat pad (appendix A): the flat's edge is at x = a_r.
struct RoundedEdge
{
   double rounded_width = 0.0; ///< a_r, the part of the contact on the radius
   double k_p = 0.0; ///< far pressure p → K_P/√x of the flat pad (A.2, sign corrected)
   double k_n = 0.0; ///< edge pressure p → K_N √x, 3 K_P/a_r (A.3)

   /// Pressure at distance x from the contact edge (A.1); 0 outside.
   double pressure(double x) const;
};

/// From the far intensity of the sharp flat pad, P/(π√(2b)) for a wide one. InputError unless
/// all are positive.
RoundedEdge rounded_edge(double k_p, double radius, double modulus);

/// Any symmetric contact of half width a: K_N = (√(2/a)/π) dP/da.
double symmetric_k_n(double half_width, double load_rate);

/** Static tension gradient of a contact edge whose surface has the relative radius R there:
    below the edge the pressure of the whole contact adds (E* /R) y to the near-edge field; for
    Hertz that is 2 p0 y/a. The pad's slope (x-b)/R is the analytic part of the pressure's
    complex extension. */
double edge_gradient(double radius, double modulus);

/** Shear intensities of the two edges. The trailing edge is the one at which the shear force on
    the cracked body points into the contact; bulk tension adds there, and is opposed by the
    shear force at the leading edge, where K_T may be negative. */
struct ShearIntensities
{
   double trailing = 0.0; ///< K_T there, force per length to the power 3/2
   double leading = 0.0;  ///< K_T there, signed
};

/** K_T = ±Q/(π√(2a)) + (σ0/4)√(a/2) ((2.6), (2.9), (2.19)), independent of the profile.
    @param shear Q, force per unit thickness on the cracked body
    @param bulk_difference σ0, tension in the cracked body minus tension in the other one */
ShearIntensities shear_intensities(double half_width, double shear, double bulk_difference);

} // namespace cattaneo::fretting
