#pragma once

#include <limits>
#include <vector>

namespace cattaneo
{

/** Tractions near the edge of an incomplete contact, from any solution. All arrays have one
    entry a node, in any order; nodes without pressure are ignored, those with pressure must all
    lie on one side of the edge (the other edge's half of the contact may be left in). */
struct EdgeTractions
{
   double edge = 0.0;            ///< position of the contact edge
   std::vector<double> position; ///< along the surface
   std::vector<double> pressure; ///< traction (not nodal force), compression positive
   std::vector<double> shear; ///< fully stuck shear traction on the cracked body, positive in
                              ///< the direction of increasing position
   /// Width of the contact, from this edge to its other edge, where the tractions vanish or
   /// are singular, as at this edge. Infinite if there is no other edge, or if it is not known.
   double width = std::numeric_limits<double>::infinity();

   /// InputError for arrays of unequal length, entries that are not finite, and a width that
   /// is not positive.
   void validate() const;
};

/// Distances from the edge between which nodes are used.
struct FitWindow
{
   double nearest = 0.0;  ///< from the edge
   double farthest = 0.0; ///< from the edge
};

/// Which nodes a fit uses.
struct FitSettings
{
   /// Both 0: the window with the least reported error is chosen.
   FitWindow window;
   /// Number of nodes next to the edge that a chosen window leaves out, because discretisation
   /// smears the edge over them.
   int skip = 2;
   static constexpr int least_nodes = 4; ///< in a window

   /// InputError unless 0 <= nearest < farthest (or both 0) and skip >= 0.
   void validate() const;
};

/// One node near an edge or a corner.
struct EdgeSample
{
   double distance = 0.0; ///< from the edge or corner, positive
   double pressure = 0.0; ///< traction, compression positive
   double shear = 0.0;    ///< on the cracked body, positive into the contact
};

/// Samples first … last - 1 may be used.
struct UsableSamples
{
   std::vector<EdgeSample> samples; ///< by distance
   std::size_t first = 0;           ///< first of `samples` that may be used
   std::size_t last = 0;            ///< one beyond the last
};

/** The tractions that a fit may use: the nodes of the window, or all but the skipped ones if
    the window is to be chosen. The node at the edge itself is not used.
    @param pressed nodes without pressure do not count
    InputError for bad arguments, nodes on both sides of the edge, and fewer nodes than
    FitSettings::least_nodes. */
UsableSamples usable_samples(const EdgeTractions &tractions, const FitSettings &settings,
                             bool pressed);

/// One intensity and its relative error. The error is the larger of the standard error of the
/// fit and the change when one more term of the expansion is fitted. If the window is chosen by
/// the fit, the error is also at least the difference from the value of any window whose own
/// error is at most three times as large.
struct FittedIntensity
{
   double value = 0.0;          ///< K_N or K_T, in the units of tractions and distances
   double relative_error = 0.0; ///< estimate, of the value
   FitWindow window;            ///< that was used
   int nodes = 0;               ///< used
};

/// The intensities at an edge.
struct EdgeFit
{
   FittedIntensity k_n; ///< p = K_N √t
   /// signed as fretting::Edge::k_t: > 0 pulls the body in, away from the edge
   FittedIntensity k_t;
};

/** K_N and K_T by least squares: with r = √(t (1 - t/width)), p/r = K_N + c t and
    q r = K_T + c t, with the next terms of both expansions for a smooth profile. Without those
    terms they are the tractions of Hertz and of a stuck shear force on half-planes, whose two
    edges are alike. InputError for arrays of unequal length, entries that are not finite,
    pressure on both sides of the edge or beyond the width, and fewer than 4 nodes in the
    window. */
EdgeFit fit_edge(const EdgeTractions &tractions, const FitSettings &settings = {});

} // namespace cattaneo
