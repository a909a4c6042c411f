#include "readout.hpp"
#include "FitSettings.hpp"
#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// What a state says: zones, edges of contact, tractions.

namespace cattaneo::python
{

namespace
{

/// The state, which must be one of the problem.
const ContactState &checked(const ReducedProblem &problem, const ContactState &state)
{
   state.validate(problem);
   return state;
}

std::string with_error(double value, double error)
{
   std::ostringstream text;
   text << value;
   // The end of a line is known.
   if (error > 0) { text << " ± " << error << " (estimate)"; }
   return text.str();
}

void bind_zones(nb::module_ &m)
{
   nb::class_<ZoneBorder>(m, "ZoneBorder", "A point on the contact line found between nodes.")
      .def_ro("position", &ZoneBorder::position, "arc length")
      .def_ro(
         "error", &ZoneBorder::error,
         "estimate of the distance to the finest mesh's, no bound; 0 at an end of the line")
      .def("__float__", [](const ZoneBorder &self) { return self.position; })
      .def("__repr__",
           [](const ZoneBorder &self) { return with_error(self.position, self.error); });
   nb::class_<Zone>(m, "Zone", "A run of contact nodes in one state.")
      .def_ro("state", &Zone::state)
      .def_ro("from_", &Zone::from)
      .def_ro("to", &Zone::to)
      .def_ro("first", &Zone::first)
      .def_ro("last", &Zone::last)
      .def_ro("chain", &Zone::chain)
      .def_prop_ro(
         "width", [](const Zone &self)
         { return self.last < self.first ? 0.0 : self.to.position - self.from.position; })
      .def("__repr__",
           [](const Zone &self)
           {
              if (self.last < self.first) { return std::string("<Zone: none>"); }
              return std::string("<Zone: ") + name(self.state) + " from " +
                     with_error(self.from.position, self.from.error) + " to " +
                     with_error(self.to.position, self.to.error) + ">";
           });

   m.def(
      "zones",
      [](const ReducedProblem &problem, const ContactState &state)
      { return zones(problem, checked(problem, state)); },
      arg("problem"), arg("state"),
      "Zones of a state along the contact line, in the order of the nodes.");
   m.def(
      "contact_zones",
      [](const ReducedProblem &problem, const ContactState &state)
      { return contact_zones(zones(problem, checked(problem, state))); },
      arg("problem"), arg("state"), "Stretches of contact, whatever slips.");
   m.def(
      "contact_zone",
      [](const ReducedProblem &problem, const ContactState &state)
      { return contact_zone(problem, checked(problem, state)); },
      arg("problem"), arg("state"), "The widest stretch of contact.");
   m.def(
      "stick_zone",
      [](const ReducedProblem &problem, const ContactState &state)
      { return stick_zone(problem, checked(problem, state)); },
      arg("problem"), arg("state"), "The widest zone of stick.");
   m.def(
      "tractions",
      [](const ReducedProblem &problem, Numbers nodal_forces)
      {
         require(problem.weights.size() == problem.nodes(),
                 "the problem has no weights, which tractions need");
         return array(tractions(problem, vector(nodal_forces, "nodal_forces")));
      },
      arg("problem"), arg("nodal_forces"),
      "Forces over consistent weights: of p, (n,), or of the components of q, (c n,).");
}

void bind_edges(nb::module_ &m)
{
   nb::class_<FittedIntensity>(m, "FittedIntensity", "An intensity at an edge of contact.")
      .def_ro("value", &FittedIntensity::value)
      .def_ro("relative_error", &FittedIntensity::relative_error, "estimate")
      .def_ro("nodes", &FittedIntensity::nodes, "used by the fit")
      .def_prop_ro(
         "window",
         [](const FittedIntensity &self)
         { return nb::make_tuple(self.window.nearest, self.window.farthest); },
         nb::sig("def window(self) -> tuple[float, float]"))
      .def("__float__", [](const FittedIntensity &self) { return self.value; })
      .def("__repr__", [](const FittedIntensity &self)
           { return with_error(self.value, std::abs(self.relative_error * self.value)); });
   nb::class_<EdgeTractions>(m, "EdgeTractions", "Tractions near an edge, from any solution.")
      .def(
         "__init__",
         [](EdgeTractions *self, double edge, Numbers position, Numbers pressure, Numbers shear,
            double width)
         {
            const auto list = [](nb::handle values, const char *what)
            {
               const Eigen::VectorXd all = vector(values, what);
               return std::vector<double>(all.data(), all.data() + all.size());
            };
            EdgeTractions made{finite(edge, "edge"), list(position, "position"),
                               list(pressure, "pressure"), list(shear, "shear"), width};
            made.validate();
            new (self) EdgeTractions(std::move(made));
         },
         arg("edge"), arg("position"), arg("pressure"), arg("shear"),
         arg("width") = std::numeric_limits<double>::infinity(),
         "shear: fully stuck, on the cracked body, positive in the direction of increasing "
         "position; width: from this edge to the other edge of the contact, if it is known.")
      .def_ro("edge", &EdgeTractions::edge)
      .def_ro("position", &EdgeTractions::position)
      .def_ro("pressure", &EdgeTractions::pressure)
      .def_ro("shear", &EdgeTractions::shear)
      .def_ro("width", &EdgeTractions::width);
   nb::class_<EdgeFit>(m, "EdgeFit")
      .def_ro("k_n", &EdgeFit::k_n)
      .def_ro("k_t", &EdgeFit::k_t)
      .def("__repr__",
           [](nb::handle self)
           {
              return "<EdgeFit: K_N " +
                     nb::cast<std::string>(nb::repr(nb::object(self.attr("k_n")))) + ", K_T " +
                     nb::cast<std::string>(nb::repr(nb::object(self.attr("k_t")))) + ">";
           });
   m.def(
      "fit_edge",
      [](const EdgeTractions &tractions, FitSettings settings, const nb::kwargs &members)
      {
         set_members(settings, members);
         return fit_edge(tractions, settings);
      },
      arg("tractions"), nb::kw_only(), arg("settings") = FitSettings(), arg("members"),
      "K_N and K_T by least squares.");

   nb::class_<ContactEdge>(m, "ContactEdge", "One end of a stretch of contact.")
      .def_ro("position", &ContactEdge::position)
      .def_ro("side", &ContactEdge::side, "+1: the contact lies at larger arc length")
      .def_ro("half_width", &ContactEdge::half_width)
      .def_ro("complete", &ContactEdge::complete)
      .def_ro("why_not", &ContactEdge::why_not, "why there are no intensities, or empty")
      .def_ro("k_n", &ContactEdge::k_n)
      .def_ro("k_t", &ContactEdge::k_t)
      .def_ro("friction", &ContactEdge::friction)
      .def_ro("slip_zone", &ContactEdge::slip_zone)
      .def_ro("slip_zone_error", &ContactEdge::slip_zone_error, "estimate")
      .def_ro("slides", &ContactEdge::slides)
      .def("__repr__",
           [](const ContactEdge &self)
           {
              std::ostringstream text;

              text << "<ContactEdge at "
                   << with_error(self.position.position, self.position.error) << ": ";
              if (!self.why_not.empty()) { text << self.why_not << ">"; }
              else
              {
                 text << "K_N " << self.k_n.value << ", K_T " << self.k_t.value
                      << ", slip zone " << with_error(self.slip_zone, self.slip_zone_error)
                      << ">";
              }
              return text.str();
           });
   m.def(
      "contact_edges",
      [](const ReducedProblem &problem, const ContactState &pressed, const ContactState &loaded,
         const std::string &cracked, FitSettings settings, const nb::kwargs &members)
      {
         set_members(settings, members);
         return contact_edges(problem, checked(problem, pressed), checked(problem, loaded),
                              cracked_body(cracked), settings);
      },
      arg("problem"), arg("pressed"), arg("loaded"), arg("cracked") = "second", nb::kw_only(),
      arg("settings") = FitSettings(), arg("members"),
      "K_N, K_T and the slip zone at each end of each stretch of contact.\n\npressed: after "
      "the "
      "normal load alone. loaded: at peak load. cracked: 'first' or 'second' body.");
   m.def(
      "edge_tractions",
      [](const ReducedProblem &problem, const ContactState &state, const ContactEdge &edge,
         const std::string &cracked)
      { return edge_tractions(problem, checked(problem, state), edge, cracked_body(cracked)); },
      arg("problem"), arg("state"), arg("edge"), arg("cracked") = "second");
   m.def(
      "fully_stuck",
      [](const ReducedProblem &problem, const ContactState &pressed, const ContactState &loaded)
      { return fully_stuck(problem, checked(problem, pressed), checked(problem, loaded)); },
      arg("problem"), arg("pressed"), arg("loaded"),
      "The state if nothing had slipped since `pressed`.");
}

} // namespace

void bind_readout(nb::module_ &m)
{
   nb::module_ readout =
      m.def_submodule("readout", "What a state says: zones and edges of contact, tractions.");
   bind_settings<FitSettings>(readout);
   bind_zones(readout);
   bind_edges(readout);
}

} // namespace cattaneo::python
