#include "arrays.hpp"
#include "readout.hpp"
#include "sensitivity.hpp"
#include "watch.hpp"
#include <cattaneo/design/edge_response.hpp>
#include <cattaneo/design/limit_gradient.hpp>
#include <limits>
#include <nanobind/stl/string.h>

// Responses at edges of contact, and derivatives of shakedown limits.

namespace cattaneo::python
{

namespace
{

std::size_t state_number(nb::handle state, const char *what = "state")
{
   return static_cast<std::size_t>(whole(state, what, 0, std::numeric_limits<int>::max()));
}

/// The trace, of the problem as it was marched.
const MarchTrace &trace_of(const Of<ReducedProblem> &problem, const Of<Trace> &trace)
{
   const Trace &of = given(trace, "trace");
   of.check(given(problem, "problem"));
   return of.trace;
}

void bind_edge_responses(nb::module_ &m)
{
   nb::class_<EdgeIntensities>(m, "EdgeIntensities", "K_N and K_T of an edge, as responses.")
      .def_ro("k_n", &EdgeIntensities::k_n)
      .def_ro("k_t", &EdgeIntensities::k_t);
   m.def(
      "edge_intensities",
      [](Of<ReducedProblem> problem, Of<Trace> trace, Whole state, Of<ContactEdge> edge,
         Text cracked, Window window, Whole skip)
      {
         return edge_intensities(given(problem, "problem"), trace_of(problem, trace),
                                 state_number(state), given(edge, "edge"),
                                 cracked_body(cracked), fit_settings(window, skip));
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), arg("cracked") = "second",
      arg("window") = nb::none(), arg("skip") = FitSettings().skip,
      "Those of readout.fit_edge() from the tractions of a state; the place of the edge and "
      "the "
      "windows are those of now, and stay. K_T is that of a stuck contact: of trace_stuck().");
   nb::class_<CornerIntensities>(m, "CornerIntensities",
                                 "Strengths of the modes at a corner, as responses.")
      .def_ro("k_one", &CornerIntensities::k_one)
      .def_ro("k_two", &CornerIntensities::k_two, "zero without a second mode");
   m.def(
      "corner_intensities",
      [](Of<ReducedProblem> problem, Of<Trace> trace, Whole state, Of<ContactEdge> edge,
         Of<fretting::CornerModes> modes, Text cracked, Window window, Whole skip)
      {
         return corner_intensities(given(problem, "problem"), trace_of(problem, trace),
                                   state_number(state), given(edge, "edge"),
                                   given(modes, "modes"), cracked_body(cracked),
                                   fit_settings(window, skip));
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), arg("modes"),
      arg("cracked") = "second", arg("window") = nb::none(), arg("skip") = FitSettings().skip,
      "Those of fretting.fit_corner() at an edge that is complete, of trace_stuck().");
   nb::class_<MovingEdge>(m, "MovingEdge", "An edge that moves, and the pressure's K_N there.")
      .def_ro("position", &MovingEdge::position, "arc length")
      .def_ro("k_n", &MovingEdge::k_n);
   m.def(
      "moving_edge",
      [](Of<ReducedProblem> problem, Of<Trace> trace, Whole state, Of<ContactEdge> edge,
         Window window, Whole skip)
      {
         return moving_edge(given(problem, "problem"), trace_of(problem, trace),
                            state_number(state), given(edge, "edge"),
                            fit_settings(window, skip));
      },
      arg("problem"), arg("trace"), arg("state"), arg("edge"), arg("window") = nb::none(),
      arg("skip") = FitSettings().skip,
      "Both of one fit to the square of the pressure; for an edge that is not complete.");
   m.def(
      "trace_stuck",
      [](Of<ReducedProblem> problem, Of<Trace> trace, Whole pressed, Whole loaded)
      {
         const MarchTrace &from = trace_of(problem, trace);
         return Trace(problem.object, trace_stuck(given(problem, "problem"), from,
                                                  state_number(pressed, "pressed"),
                                                  state_number(loaded, "loaded")));
      },
      arg("problem"), arg("trace"), arg("pressed"), arg("loaded"),
      "The trace up to its state `pressed`, and then readout.fully_stuck() under the loads of "
      "its state `loaded`: what K_T is read from.");
}

LimitGradient known_or_warned(const char *what, LimitGradient gradient)
{
   if (!gradient.found) { warn(std::string(what) + ": it is not known: " + gradient.message); }
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
      [](Of<LimitProblem> problem, Of<LimitReport> limit, Changes stiffness)
      {
         return known_or_warned("load_limit_gradient",
                                load_limit_gradient(given(problem, "problem"),
                                                    given(limit, "limit"),
                                                    stiffness_changes(stiffness)));
      },
      arg("problem"), arg("limit"), arg("stiffness") = nb::tuple(),
      "Of shakedown.load_limit(), whose report `limit` is. If it is not known that is warned "
      "of "
      "(OutcomeWarning).");
   m.def(
      "friction_limit_gradient",
      [](Of<LimitProblem> problem, Number load_factor, Of<LimitReport> limit, Changes stiffness)
      {
         return known_or_warned("friction_limit_gradient",
                                friction_limit_gradient(given(problem, "problem"),
                                                        number(load_factor, "load_factor"),
                                                        given(limit, "limit"),
                                                        stiffness_changes(stiffness)));
      },
      arg("problem"), arg("load_factor"), arg("limit"), arg("stiffness") = nb::tuple(),
      "Of shakedown.friction_limit() at a load factor.");
}

} // namespace

void bind_readout_gradients(nb::module_ &m)
{
   bind_edge_responses(m);
   bind_limit_gradients(m);
}

} // namespace cattaneo::python
