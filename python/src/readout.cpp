#include "readout.hpp"
#include "FitSettings.hpp"
#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include <cattaneo/readout/places.hpp>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Readings of a state: zones, edges of contact, tractions.

namespace cattaneo::python
{

std::vector<NamedZone> named_zones(const ReducedProblem &problem,
                                   const std::vector<Zone> &zones, bool contact)
{
   std::vector<NamedZone> all;
   for (const Zone &zone : zones)
   {
      NamedZone made;
      made.zone = zone;
      if (!contact) { made.state = zone.state; }
      if (zone.last >= zone.first && zone.chain < static_cast<int>(problem.chains.size()))
      {
         const ContactChain &chain = problem.chains[zone.chain];
         made.interface = chain.interface;
         made.from = place_along(problem, chain, zone.from.position);
         made.to = place_along(problem, chain, zone.to.position);
      }
      all.push_back(made);
   }
   return all;
}

std::string NamedZone::places() const
{
   if (!from.allFinite() || !to.allFinite()) { return ""; }
   std::ostringstream text;
   const auto add = [&](const Eigen::Vector2d &place)
   {
      // A coordinate that is round-off of the other one is 0.
      const double least = 1e-9 * place.cwiseAbs().maxCoeff();
      const auto shown = [&](double x) { return std::abs(x) < least ? 0.0 : x; };
      text << "(" << shown(place[0]) << ", " << shown(place[1]) << ")";
   };
   text << ", ";
   add(from);
   text << " to ";
   add(to);
   return text.str();
}

namespace
{

/// The state, which must belong to the problem.
const ContactState &checked(const ReducedProblem &problem, const ContactState &state)
{
   state.validate(problem);
   return state;
}

std::string with_error(double value, double error)
{
   std::ostringstream text;
   text << value;
   // The end of a line is exact.
   if (error > 0) { text << " ± " << error << " (estimate)"; }
   return text.str();
}

std::string brief(const NamedZone &self)
{
   const std::string kind = self.state ? name(*self.state) : "contact";
   if (self.none()) { return "<Zone: no " + kind + ">"; }
   return "<Zone: " + kind + " from " +
          with_error(self.zone.from.position, self.zone.from.error) + " to " +
          with_error(self.zone.to.position, self.zone.to.error) +
          (self.interface.empty() ? "" : " of '" + self.interface + "'") + self.places() + ">";
}

void bind_zones(nb::module_ &m)
{
   nb::class_<ZoneBorder>(m, "ZoneBorder", "A point on the contact line found between nodes.")
      .def_ro("position", &ZoneBorder::position, "arc length")
      .def_ro("error", &ZoneBorder::error,
              "estimate of the distance from the border on the finest mesh, no bound; 0 at an "
              "end of the line")
      .def("__float__", [](const ZoneBorder &self) { return self.position; })
      .def("__repr__",
           [](const ZoneBorder &self) { return with_error(self.position, self.error); });
   nb::class_<NamedZone>(m, "Zone", "Neighbouring contact nodes in one state, or in contact.")
      .def_prop_ro(
         "state", [](const NamedZone &self) { return self.state; },
         nb::sig("def state(self) -> NodeState | None"),
         "state of all its nodes; None: they are in contact, stick or slip")
      .def_ro("interface", &NamedZone::interface,
              "name of its interface, '' if the problem has none")
      .def_prop_ro(
         "from_", [](const NamedZone &self) { return self.zone.from; }, "first end")
      .def_prop_ro(
         "to", [](const NamedZone &self) { return self.zone.to; }, "last end")
      .def_prop_ro(
         "from_place", [](const NamedZone &self) { return array(self.from); },
         "(x, y) of the first end, on the straight line between the nodes beside it; nan if "
         "the "
         "problem has no places")
      .def_prop_ro(
         "to_place", [](const NamedZone &self) { return array(self.to); },
         "(x, y) of the last end, as from_place")
      .def_prop_ro(
         "first", [](const NamedZone &self) { return self.zone.first; },
         "number of its first node")
      .def_prop_ro(
         "last", [](const NamedZone &self) { return self.zone.last; },
         "number of its last node; less than `first`: there is no such zone")
      .def_prop_ro(
         "chain", [](const NamedZone &self) { return self.zone.chain; },
         "index of its line in problem.chains")
      .def_prop_ro(
         "width",
         [](const NamedZone &self)
         { return self.none() ? 0.0 : self.zone.to.position - self.zone.from.position; },
         "along the line; 0: there is no such zone")
      .def("__repr__", [](const NamedZone &self) { return brief(self); });

   m.def(
      "zones",
      [](const ReducedProblem &problem, const ContactState &state)
      { return named_zones(problem, zones(problem, checked(problem, state)), false); },
      arg("problem"), arg("state"),
      "Zones of a state of the problem along its contact lines, in the order of the nodes: "
      "neighbouring nodes that stick, slip in one direction, or are open.");
   m.def(
      "contact_zones",
      [](const ReducedProblem &problem, const ContactState &state) {
         return named_zones(problem, contact_zones(zones(problem, checked(problem, state))),
                            true);
      },
      arg("problem"), arg("state"),
      "Parts of its lines that are in contact in a state of the problem: neighbouring nodes "
      "that are pressed, whether they stick or slip.");
   m.def(
      "contact_zone",
      [](const ReducedProblem &problem, const ContactState &state) {
         return named_zones(problem, {contact_zone(problem, checked(problem, state))}, true)[0];
      },
      arg("problem"), arg("state"),
      "The widest of contact_zones(), over all lines and interfaces of the problem in this "
      "state. Its width is 0 if all nodes are open.");
   m.def(
      "stick_zone",
      [](const ReducedProblem &problem, const ContactState &state) {
         return named_zones(problem, {stick_zone(problem, checked(problem, state))}, false)[0];
      },
      arg("problem"), arg("state"),
      "The widest zone of stick in a state of the problem. Its width is 0 if no node sticks.");
   m.def(
      "tractions",
      [](const ReducedProblem &problem, Numbers nodal_forces)
      {
         require(problem.weights.size() == problem.nodes(),
                 "the problem has no weights, which tractions need");
         return array(tractions(problem, vector(nodal_forces, "nodal_forces")));
      },
      arg("problem"), arg("nodal_forces"),
      "Tractions: nodal forces over the weights of the problem's nodes. nodal_forces: p, (n,), "
      "or q, (c n,), of a state.");
}

void bind_edges(nb::module_ &m)
{
   nb::class_<FittedIntensity>(m, "FittedIntensity", "An intensity at an edge of contact.")
      .def_ro("value", &FittedIntensity::value)
      .def_ro("relative_error", &FittedIntensity::relative_error, "estimate")
      .def_ro("nodes", &FittedIntensity::nodes, "number of nodes used by the fit")
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
         "edge: its arc length. position, pressure: of each node. "
         "shear: fully stuck, on the cracked body, positive in the direction of increasing "
         "position. width: from this edge to the other edge of the contact, if it is known.")
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
      "K_N and K_T by least squares. tractions: near the edge, from any program. settings: "
      "which nodes are fitted. InputError with fewer than 4 nodes in the window.");

   nb::class_<ContactEdge>(m, "ContactEdge", "One end of a stretch of contact.")
      .def_ro("position", &ContactEdge::position)
      .def_ro("side", &ContactEdge::side, "+1: the contact lies at larger arc length")
      .def_ro("half_width", &ContactEdge::half_width)
      .def_ro("complete", &ContactEdge::complete)
      .def_ro("why_not", &ContactEdge::why_not,
              "reason why there are no intensities, '' if there are some")
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
      "K_N, K_T and the slip zone at each end of each part in contact.\n\npressed: a state of "
      "the problem after the normal load alone. loaded: the state at peak load. cracked: the "
      "body to which K_T and slip refer, 'first' or 'second'. settings: which nodes are "
      "fitted.");
   m.def(
      "edge_tractions",
      [](const ReducedProblem &problem, const ContactState &state, const ContactEdge &edge,
         const std::string &cracked)
      { return edge_tractions(problem, checked(problem, state), edge, cracked_body(cracked)); },
      arg("problem"), arg("state"), arg("edge"), arg("cracked") = "second",
      "Tractions of a state near an edge, one of contact_edges(), as input of fit_edge(). "
      "cracked: "
      "'first' or 'second', the body on which shear is positive towards larger arc length.");
   m.def(
      "fully_stuck",
      [](const ReducedProblem &problem, const ContactState &pressed, const ContactState &loaded)
      { return fully_stuck(problem, checked(problem, pressed), checked(problem, loaded)); },
      arg("problem"), arg("pressed"), arg("loaded"),
      "The state under the loads of `loaded` if nothing had slipped since `pressed`, both of "
      "the problem.");
}

} // namespace

void bind_readout(nb::module_ &m)
{
   nb::module_ readout =
      m.def_submodule("readout", "Results of a state: zones and edges of contact, tractions.");
   bind_settings<FitSettings>(readout);
   bind_zones(readout);
   bind_edges(readout);
}

} // namespace cattaneo::python
