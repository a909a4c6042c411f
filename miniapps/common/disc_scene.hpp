#pragma once

#include "common/scene.hpp"

#include <cattaneo/friction/contact_state.hpp>

#include <vector>

namespace miniapp
{

/// The part of the disc that is twisted about its axis.
enum class Twist
{
   none,    ///< no part: torsion is left out
   top,     ///< u_θ = φ r on the whole top
   loaded,  ///< the same on the top's nodes under the (first) load only
   rim,     ///< the same on the outer side
   traction ///< t_θ proportional to r under the (first) load; force control, unit torque
};

/** The axisymmetric receding contact of thesis chapter 7: a disc 0 < r < b, 0 < z < t on a
    half-space of the same material: the half-space itself, which has no mesh, or a cylinder r <
    R, -R < z < 0 that is fixed on its side and bottom. Dead pressure p0 on r < a of the disc's
    top.

    Units t = p0 = E = 1. Every load radius has its own load pattern, see radius_load(), on one
    condensed pair: the end of the load need not be a mesh line. The twist is the pattern
    "twist", of angle φ = 1 or torque 1. */
struct DiscOptions
{
   double disc_radius = 5;                 ///< b, in t
   std::vector<double> load_radii = {2.5}; ///< a, in t
   double domain = 0; ///< R, in t; 0: the half-space itself, without a mesh
   int order = 2;
   double spacing =
      0.02; ///< spacing of the contact nodes (rounded so that elements end at b), in t
   /// Growth of the elements away from the contact. Those of the disc are at most 0.4 (growth -
   /// 1) t high.
   double growth = 0; ///< 0: the default of element_growth()
   /// Grid lines of the contact from 0 to the disc's radius in place of `spacing`.
   std::vector<double> grid = {};
   double poisson = 0.3;
   Twist twist = Twist::none;

   /// InputError naming the option, its value and what is allowed.
   void validate() const;
};

/// Name of the load pattern of a radius.
std::string radius_load(double radius);

Scene make_disc(const DiscOptions &options);

/** Radius of the load above which no node of a disc separates, for any friction, on one
    condensed pair. The clamped forces are smooth in the load's radius: those of a radius in
    between are interpolated by a cubic through patterns 0.1 t apart. */
class CriticalLoad
{
public:
   /// Friction and the load radii of the options are not used.
   explicit CriticalLoad(DiscOptions options);
   /// Bisected to 1e-5; NaN if the disc stays closed under the smallest load (b - 2.5 t, but
   /// not less than b/10), 0 … b else. InputError if an increment fails.
   double radius(double friction);
   const cattaneo::Counters &counters() const { return counters_; }

private:
   DiscOptions options_;
   Scene scene_;
   cattaneo::Counters counters_;
   std::vector<cattaneo::NodeState> guess_; ///< of the last state: where the next search starts
};

/** Radius of the load below which a disc that is bonded to its half-space pulls somewhere, to a
    thousandth of b; NaN if it never does. Ill-conditioned: far from the load the pressure is a
    thousandth of p0. */
double bonded_critical_radius(DiscOptions options);

} // namespace miniapp
