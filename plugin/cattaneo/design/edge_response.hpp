#pragma once

#include <cattaneo/design/response.hpp>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/readout/contact_edges.hpp>

namespace cattaneo
{

/// Results at an edge of contact, as responses.
struct EdgeIntensities
{
   Response k_n; ///< see EdgeFit
   Response k_t; ///< see EdgeFit
};

/** K_N and K_T of fit_edge() from the tractions of a state of the trace, which are linear in
    them: the position of the edge and the windows stay as they are. This is correct for a
    contact that does not grow with the load; for one that does see moving_edge(). K_T belongs
    to a stuck contact: take it from trace_stuck(). InputError as fit_edge(). */
EdgeIntensities edge_intensities(const ReducedProblem &problem, const MarchTrace &trace,
                                 std::size_t state, const ContactEdge &edge,
                                 CrackedBody cracked = CrackedBody::second,
                                 const FitSettings &settings = {});

/// Strengths of the modes at a corner, as responses.
struct CornerIntensities
{
   Response k_one; ///< see fretting::CornerFit
   Response k_two; ///< zero without a second mode
};

/// The same for fretting::fit_corner(), at a complete edge.
CornerIntensities corner_intensities(const ReducedProblem &problem, const MarchTrace &trace,
                                     std::size_t state, const ContactEdge &edge,
                                     const fretting::CornerModes &modes,
                                     CrackedBody cracked = CrackedBody::second,
                                     const FitSettings &settings = {});

/// An edge that moves, and the pressure's K_N there.
struct MovingEdge
{
   Response position; ///< arc length
   Response k_n;      ///< p = K_N √t
};

/** Both numbers come from one fit: the square of the pressure is a parabola over the arc
    length, of least squares through the nodes of the window of K_N, which vanishes at the edge
    and rises there by K_N² a unit of length. Exact for a Hertz contact apart from the error of
    the pressures; values agree with contact_edges() within its errors. InputError as
    fit_edge(), for an edge that is complete, and if the parabola has no zero there. */
MovingEdge moving_edge(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t state, const ContactEdge &edge,
                       const FitSettings &settings = {});

/** The trace up to its state `pressed`, and then the one of fully_stuck() under the loads of
    its state `loaded`, of which the nodes in contact there stick: what K_T is read from.
    InputError as fully_stuck(), and unless pressed < loaded. */
MarchTrace trace_stuck(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t pressed, std::size_t loaded);

} // namespace cattaneo
