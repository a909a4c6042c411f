#include "arrays.hpp"
#include "module.hpp"
#include <cattaneo/readout/areas.hpp>
#include <nanobind/stl/string.h>
#include <sstream>

// Areas of a contact surface.

namespace cattaneo::python
{

void bind_areas(nb::module_ &m)
{
   nb::module_ readout = m.def_submodule("readout");
   nb::class_<SurfacePart>(readout, "SurfacePart",
                           "A part of the contact surface: the nodes in one state.")
      .def_ro("area", &SurfacePart::area, "sum of their weights")
      .def_ro("error", &SurfacePart::error,
              "estimate of the error because the outline consists of whole nodes, no bound")
      .def_ro("nodes", &SurfacePart::nodes, "number of them")
      .def("__float__", [](const SurfacePart &self) { return self.area; })
      .def("__repr__",
           [](const SurfacePart &self)
           {
              std::ostringstream text;
              text << self.area << " ± " << self.error << " (estimate), " << self.nodes
                   << " nodes";
              return text.str();
           });
   nb::class_<ContactAreas>(readout, "ContactAreas", "Parts of the contact surface in a state.")
      .def_ro("contact", &ContactAreas::contact, "stick and slip together")
      .def_ro("stick", &ContactAreas::stick, "pressed, without slip")
      .def_ro("slip", &ContactAreas::slip, "pressed, and slipping in any direction")
      .def_ro("separation", &ContactAreas::separation, "open, or touching without force");
   readout.def(
      "contact_areas",
      [](const ReducedProblem &problem, const ContactState &state)
      { return contact_areas(problem, state); },
      nb::arg("problem"), nb::arg("state"),
      "Areas of contact, stick, slip and separation in a state of a problem with two "
      "tangential "
      "components, from settled_states().");
   nb::class_<RadialEdge>(readout, "RadialEdge", "The radius of a circular edge.")
      .def_ro("radius", &RadialEdge::radius,
              "of the circle that has the area of the nodes within")
      .def_ro("error", &RadialEdge::error,
              "all nodes nearer than radius - error are within the edge, and all beyond radius "
              "+ error are outside; at least half an edge of a node; an estimate, no bound")
      .def("__float__", [](const RadialEdge &self) { return self.radius; })
      .def("__repr__",
           [](const RadialEdge &self)
           {
              std::ostringstream text;
              text << self.radius << " ± " << self.error;
              return text.str();
           });
   nb::class_<RadialEdges>(readout, "RadialEdges", "Edges of a contact that is round.")
      .def_ro("contact", &RadialEdges::contact, "between contact and separation")
      .def_ro("stick", &RadialEdges::stick, "between stick and the annulus of slip");
   readout.def(
      "radial_edges",
      [](const ReducedProblem &problem, const ContactState &state, Numbers centre)
      { return radial_edges(problem, state, vector(centre, "centre", 2)); },
      nb::arg("problem"), nb::arg("state"), nb::arg("centre") = nb::make_tuple(0.0, 0.0),
      "Radii of contact and of stick about a centre (x, y) in a state of a contact surface, "
      "with the range in which they lie.");
}

} // namespace cattaneo::python
