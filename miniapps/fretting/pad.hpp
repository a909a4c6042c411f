#pragma once

#include "common/contact_edges.hpp"
#include "common/study.hpp"

#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <string>

namespace miniapp
{

/// A pad on a specimen and its loads, as given on the command line or by one test record.
/// Units: N, mm, MPa; forces per mm of thickness. NaN: not given.
struct Pad
{
   std::string kind = "hertz";
   double radius = 100, flat = none; ///< of the rounded edges; half width of the flat
   double normal = 400, shear = 50;
   double bulk = none, bulk_pad = 0;
   double load_ratio = -1;
   double friction = none;
   double k_n = none, k_t = none, half_width = none;
   int nodes = 201, order = 2; ///< of the finite element contact
   cattaneo::fretting::FatigueMaterial material;
   bool plane_stress = false;

   double bulk_or_none() const { return std::isnan(bulk) ? 0 : bulk; }
   double modulus() const; ///< E*
   /// Half width of the contact under a normal force alone (per unit thickness).
   double half_width_under(double load) const;
};

/// Both edges of the contact, if they are known.
struct PadContact
{
   double half_width = 0.0, rounded_width = 0.0, k_n = 0.0;
   cattaneo::fretting::ShearIntensities k_t; ///< leading: NaN if unknown
   double stress_gradient = 0.0;
};

/// The loads make the whole contact slide. This is an outcome; a test record with such loads is
/// refused.
struct PadSlides : cattaneo::InputError
{
   using cattaneo::InputError::InputError;
};

/// From closed forms. InputError for options that contradict each other, PadSlides if the pad
/// slides under the loads.
PadContact calibrate(const Pad &pad);

/// One edge of the finite element contact over one steady cycle.
struct PadEdge : cattaneo::fretting::SolvedEdge
{
   double reversed_slip_zone = 0.0; ///< computed, back at peak load
   bool resolved = false; ///< less than two spacings resolve neither a slip zone nor its energy
};

/// Contact forces and bulk stress on the specimen at an instant of the steady cycle.
struct PadInstant
{
   Eigen::VectorXd shear, pressure; ///< forces of the contact nodes, along x and pressing
   double bulk = 0.0;               ///< stress, MPa
};

/// The pad on a half-plane, pressed and sheared by finite elements.
struct SolvedPad
{
   Eigen::VectorXd positions;              ///< of the contact nodes along x
   Eigen::VectorXd pressure, shear;        ///< on the specimen at peak load, MPa
   std::vector<PadInstant> cycle;          ///< the steady one
   double half_width = 0.0, spacing = 0.0; ///< of the contact, and of its nodes at the edges
   PadEdge trailing, leading;
   int steady_cycle = 0, dofs = 0;
   double seconds = 0.0;
   cattaneo::Counters counters;

   struct Stress
   {
      double value = 0, error = 0; ///< the error is an estimate
   };
   /** σ_xx on the surface of the specimen at an edge of the contact at peak load, with the bulk
       stress, MPa. Pressure and shear begin like the root of the distance from the edge, and so
       does the stress. The integral contains this root, the tractions of a mesh do not. The
       error is the difference from the result with every second node. */
   Stress edge_stress(bool trailing) const;

   /// The intensities of this contact, in place of the closed forms.
   PadContact in_place_of(PadContact closed_form) const;
};

/// InputError if it ends before the peak load.
/// @param saves whether its reduced problem goes to the file of --save
SolvedPad solve(Study &study, const Pad &pad, const PadContact &closed_form, bool saves);

/// Results of the finite elements beside closed forms: those of Hertz and Mindlin, with bulk
/// stress those of Nowell and Hills (as long as both edges slip in the sense of the shear). For
/// a pad with a flat they are those of Ciavarella, Hills and Monno, and of Jäger and
/// Ciavarella.
void compare(Study &study, const Pad &pad, const PadContact &closed_form,
             const SolvedPad &solved);

/// The edge whose crack is driven harder.
struct JudgedEdge
{
   cattaneo::fretting::FrettingProblem problem;
   cattaneo::fretting::FrettingReport report;
   std::string edge;
};
JudgedEdge judge(const Pad &pad, const PadContact &contact,
                 const cattaneo::fretting::FrettingSettings &criteria);

} // namespace miniapp
