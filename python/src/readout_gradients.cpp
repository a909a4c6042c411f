#include "arrays.hpp"
#include "readout.hpp"
#include "sensitivity.hpp"
#include "settings.hpp"
#include "watch.hpp"
#include <cattaneo/design/edge_response.hpp>
#include <cattaneo/design/limit_gradient.hpp>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

// Responses at edges of contact, and derivatives of shakedown limits.

namespace cattaneo::python
{

namespace
{

/// The trace, which must belong to the problem as it was marched.
const MarchTrace &trace_of(const ReducedProblem &problem, const Trace &trace)
{
   trace.check(problem);
   return trace.trace;
}

void bind_edge_responses(nb::module_ &m)
{
   nb::class_<EdgeIntensities>(m, "EdgeIntensities", "K_N and K_T of an edge, as responses.")
      .def_ro("k_n", &EdgeIntensities::k_n)
      .def_ro("k_t", &EdgeIntensities::k_t);
   m.def(
      "edge_intensities",
      [](const ReducedProblem &problem, const Trace &trace, std::size_t state,
         const ContactEdge &edge, const std::string &cracked, FitSettings settings,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         return edge_intensities(problem, trace_of(problem, trace), state, edge,
                                 cracked_body(cracked), settings);
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), arg("cracked") = "second",
      nb::kw_only(), arg("settings") = FitSettings(), arg("members"),
      "K_N and K_T of readout.fit_edge() from the tractions of a state. The place of the edge "
      "and the windows are fixed. K_T needs a stuck contact: use trace_stuck().");
   nb::class_<CornerIntensities>(m, "CornerIntensities",
                                 "Strengths of the modes at a corner, as responses.")
      .def_ro("k_one", &CornerIntensities::k_one)
      .def_ro("k_two", &CornerIntensities::k_two, "zero without a second mode");
   m.def(
      "corner_intensities",
      [](const ReducedProblem &problem, const Trace &trace, std::size_t state,
         const ContactEdge &edge, const fretting::CornerModes &modes,
         const std::string &cracked, FitSettings settings, const nb::kwargs &members)
      {
         set_members(settings, members);
         return corner_intensities(problem, trace_of(problem, trace), state, edge, modes,
                                   cracked_body(cracked), settings);
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), arg("modes"),
      arg("cracked") = "second", nb::kw_only(), arg("settings") = FitSettings(), arg("members"),
      "Strengths of fretting.fit_corner() at a complete edge. Use trace_stuck().");
   nb::class_<MovingEdge>(m, "MovingEdge",
                          "The position of an edge that moves, and K_N there, as responses.")
      .def_ro("position", &MovingEdge::position, "arc length")
      .def_ro("k_n", &MovingEdge::k_n);
   m.def(
      "moving_edge",
      [](const ReducedProblem &problem, const Trace &trace, std::size_t state,
         const ContactEdge &edge, FitSettings settings, const nb::kwargs &members)
      {
         set_members(settings, members);
         return moving_edge(problem, trace_of(problem, trace), state, edge, settings);
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), nb::kw_only(),
      arg("settings") = FitSettings(), arg("members"),
      "Position and K_N, both from one fit to the square of the pressure; for an edge that is "
      "not complete.");
   m.def(
      "trace_stuck",
      [](const ReducedProblem &problem, const Trace &trace, std::size_t pressed,
         std::size_t loaded) {
         return Trace(problem, trace_stuck(problem, trace_of(problem, trace), pressed, loaded));
      },
      arg("problem"), arg("trace"), arg("pressed"), arg("loaded"),
      "The trace up to its state `pressed`, and then readout.fully_stuck() under the loads of "
      "its state `loaded`. K_T is computed from it.");
}

LimitGradient known_or_warned(const char *what, LimitGradient gradient)
{
   if (!gradient.found)
   {
      warn(std::string(what) + ": the derivative could not be computed: " + gradient.message);
   }
   return gradient;
}

void bind_limit_gradients(nb::module_ &m)
{
   using Self = LimitGradient;
   nb::class_<Self>(m, "LimitGradient",
                    "Derivatives of a shakedown limit by the data of its problem, if they are "
                    "known; one-sided where there are several mechanisms.")
      .def_ro("found", &Self::found)
      .def_ro("message", &Self::message, "why not")
      .def_prop_ro("friction", viewed(&Self::friction),
                   "by f of each node, size n; of a friction limit no entries")
      .def_prop_ro("constant", viewed(&Self::constant),
                   "by the constant multiplier of each load")
      .def_prop_ro("varying", viewed(&Self::varying),
                   "by the varying one at each vertex, (loads, vertices)")
      .def_ro("load_factor", &Self::load_factor, "of a friction limit: by its load factor")
      .def_prop_ro("gap", viewed(&Self::gap),
                   "by the gap that the closed contact bridges, size n")
      .def_prop_ro("stiffness", viewed(&Self::stiffness), "by each StiffnessChange");
   m.def(
      "load_limit_gradient",
      [](const LimitProblem &problem, const LimitReport &limit,
         const std::vector<StiffnessChange> &stiffness)
      {
         return known_or_warned("load_limit_gradient",
                                load_limit_gradient(problem, limit, stiffness));
      },
      arg("problem"), arg("limit"), arg("stiffness") = nb::tuple(),
      "Derivatives of the limit whose report `limit` shakedown.load_limit() gave. If they are "
      "not known there is a warning (OutcomeWarning).");
   m.def(
      "friction_limit_gradient",
      [](const LimitProblem &problem, double load_factor, const LimitReport &limit,
         const std::vector<StiffnessChange> &stiffness)
      {
         return known_or_warned("friction_limit_gradient",
                                friction_limit_gradient(problem,
                                                        finite(load_factor, "load_factor"),
                                                        limit, stiffness));
      },
      arg("problem"), arg("load_factor"), arg("limit"), arg("stiffness") = nb::tuple(),
      "Derivatives of shakedown.friction_limit() at a load factor.");
}

} // namespace

void bind_readout_gradients(nb::module_ &m)
{
   bind_edge_responses(m);
   bind_limit_gradients(m);
}

} // namespace cattaneo::python
