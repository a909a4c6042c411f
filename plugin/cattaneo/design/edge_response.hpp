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

/** K_N and K_T of fit_edge() from the tractions of a state of the trace. The position of the
    edge and the windows are fixed, so that both are linear in the tractions. This is correct
    for a contact that does not grow with the load; otherwise see moving_edge(). K_T belongs to
    a stuck contact: use the trace of trace_stuck(). InputError as fit_edge(). */
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

/** Both numbers come from one fit: a parabola over the arc length is fitted by least squares to
    the square of the pressure, at the nodes of the window of K_N. Its zero is the edge, and its
    slope there is K_N². Exact for a Hertz contact apart from the error of the pressures; values
    agree with contact_edges() within its errors. InputError as fit_edge(), for an edge that is
    complete, and if the parabola has no zero there. */
MovingEdge moving_edge(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t state, const ContactEdge &edge,
                       const FitSettings &settings = {});

/** The trace up to its state `pressed`, followed by the state of fully_stuck() under the loads
    of its state `loaded`, in which all nodes stick that are in contact in `loaded`. K_T is
    computed from the latter. InputError as fully_stuck(), and unless pressed < loaded. */
MarchTrace trace_stuck(const ReducedProblem &problem, const MarchTrace &trace,
                       std::size_t pressed, std::size_t loaded);

} // namespace cattaneo
