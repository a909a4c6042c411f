#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include "words.hpp"
#include <algorithm>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Interfaces of condensed bodies, reduce(), and the recovery of the fields of the bodies.

namespace cattaneo::python
{

namespace
{

/// A side that is only the number of a body is a half-plane, whose line is that of the other
/// side.
using Side = std::variant<int, std::pair<int, ContactLine>, std::pair<int, ContactSurface>>;
/// A number, or a function of (x, y), in three dimensions of (x, y, z).
using Place = std::variant<double, nb::typed<nb::callable, double(double, double)>>;
using Bodies = std::vector<CondensedBody>;

ScalarField place_function(const Place &place, const std::string &what, bool in_space = false)
{
   if (const auto *value = std::get_if<double>(&place)) { return finite(*value, what.c_str()); }
   if (in_space)
   {
      return [function = std::get<1>(place), what](double x, double y, double z)
      {
         return number(function(x, y, z), what + "(" + exact_text(x) + ", " + exact_text(y) +
                                             ", " + exact_text(z) + ")");
      };
   }
   return [function = std::get<1>(place), what](double x, double y)
   { return number(function(x, y), what + "(" + exact_text(x) + ", " + exact_text(y) + ")"); };
}

InterfaceSide side(const Side &side, const char *what)
{
   const int *alone = std::get_if<int>(&side);
   const auto *on_line = std::get_if<1>(&side);
   const auto *on_surface = std::get_if<2>(&side);
   const int body = alone ? *alone : on_line ? on_line->first : on_surface->first;
   within(body, what, 0, 1 << 20);
   return {body, on_line ? on_line->second : ContactLine(),
           on_surface ? on_surface->second : ContactSurface()};
}

bool in_space(const CondensedBody &body)
{
   return body.line.formulation == Formulation::space;
}

/// Two bodies whose nodes lie at the same places.
Reduction reduced_pair(const CondensedBody &body, const CondensedBody &other,
                       const Pairing *given)
{
   if (given) { return reduce(body, other, *given); }
   if (body.surface.size() > 0 && other.surface.size() > 0)
   {
      return reduce({body, other},
                    {{"contact", {0, {}, body.surface}, {1, {}, other.surface}}});
   }
   const Pairing pairs = pair_lines(body.line, other.line);
   const auto knows_elements = [](const CondensedBody &of)
   {
      return std::none_of(of.line.chains.begin(), of.line.chains.end(),
                          [](const LineChain &chain) { return chain.elements.empty(); });
   };
   // The places coincide. If the elements do not, forces are not transferred from node to node.
   if (differing_element(body.line, other.line, pairs) >= 0 && knows_elements(body) &&
       knows_elements(other))
   {
      return reduce({body, other}, {{"contact", {0, body.line}, {1, other.line}}});
   }
   return reduce(body, other, pairs);
}

/// Adds the torsion bodies, if there are any, and warns of paired elements that differ.
Reduction completed(Reduction result, const Bodies &torsion)
{
   for (const InterfaceReport &face : result.interfaces)
   {
      if (!face.differing) { continue; }
      warn("reduce: interface '" + face.name +
           "' pairs nodes one to one where the elements of the bodies differ, at (" +
           exact_text((*face.differing)[0]) + ", " + exact_text((*face.differing)[1]) +
           ") for instance: tractions of single nodes are wrong there; without a pairing nodes "
           "need not match");
   }
   if (!torsion.empty()) { result.add_torsion(torsion); }
   return result;
}

std::pair<double, double> xy(const Eigen::Vector2d &place)
{
   return {place[0], place[1]};
}

} // namespace

void bind_reductions(nb::module_ &m)
{
   nb::class_<Pairing>(m, "Pairing", "Nodes of two contact lines that face each other.")
      .def_prop_ro(
         "partner", [](const Pairing &self) { return array_of_indices(self.partner); },
         "node of line 2 for each node of line 1")
      .def_prop_ro("gap", viewed(&Pairing::gap), "from geometry, positive if apart");
   m.def(
      "pair_lines",
      [](const ContactLine &line1, const ContactLine &line2, double tolerance)
      { return pair_lines(line1, line2, finite(tolerance, "tolerance")); },
      arg("line1"), arg("line2"), arg("tolerance") = 1e-6,
      "Pairs the nodes of line1 with those of line2 that face them, one to one. tolerance: "
      "largest offset along the tangent, in edge lengths.");

   m.def(
      "pair_surfaces",
      [](const ContactSurface &surface1, const ContactSurface &surface2, double tolerance)
      { return pair_surfaces(surface1, surface2, finite(tolerance, "tolerance")); },
      arg("surface1"), arg("surface2"), arg("tolerance") = 1e-6,
      "Pairs the nodes of surface1 with those of surface2 that face them, one to one. "
      "tolerance: of the offset along the surface, in distances of nodes.");
   m.def(
      "gaps_to_plane",
      [](const ContactSurface &surface, Numbers point, Numbers normal)
      {
         return array(
            gaps_to_plane(surface, vector(point, "point", 3), vector(normal, "normal", 3)));
      },
      arg("surface"), arg("point"), arg("normal"),
      "Distance of a plane from each node of a surface, along the node's normal.\n\nsurface: "
      "of "
      "a body. point: of the plane. normal: of any length and sense.");
   m.def(
      "gaps_to_sphere",
      [](const ContactSurface &surface, Numbers centre, double radius)
      {
         return array(
            gaps_to_sphere(surface, vector(centre, "centre", 3), finite(radius, "radius")));
      },
      arg("surface"), arg("centre"), arg("radius"),
      "Distance of a sphere from each node of a surface, along the node's normal.\n\nsurface: "
      "of "
      "a body. centre: of the sphere. radius: negative for a hollow.");

   m.def(
      "gaps_to_cylinder",
      [](const ContactSurface &surface, Numbers point, Numbers axis, double radius)
      {
         return array(gaps_to_cylinder(surface, vector(point, "point", 3),
                                       vector(axis, "axis", 3), finite(radius, "radius")));
      },
      arg("surface"), arg("point"), arg("axis"), arg("radius"),
      "Distance of a cylinder without ends from each node of a surface, along the node's "
      "normal.\n\nsurface: of a body. point: on the axis. axis: of any length and sense. "
      "radius: "
      "negative for a bore.");
   m.def(
      "gaps_to_height",
      [](const ContactSurface &surface, const Place &height)
      { return array(gaps_to_height(surface, place_function(height, "height"))); },
      arg("surface"), arg("height"),
      "Distance of the obstacle z = height(x, y) from each node of a surface, along the node's "
      "normal.\n\nsurface: of a body. height: a function of (x, y), or a number.");

   nb::class_<Interface>(m, "Interface",
                         "Where two bodies may touch, or a body and a rigid obstacle, or two "
                         "parts of one body.")
      .def(
         "__init__",
         [](Interface *self, const std::string &name, const Side &first,
            const std::optional<Side> &second, const std::string &slave,
            const std::optional<std::variant<Place, Numbers>> &gap, double most_overlap,
            bool tied, const Pairing *pairing)
         {
            Interface made{name,
                           side(first, "first"),
                           second ? side(*second, "second") : InterfaceSide(),
                           chosen<SlaveSide>(slave, "slave"),
                           std::nullopt,
                           finite(most_overlap, "most_overlap"),
                           tied};
            if (pairing) { made.pairing = *pairing; }
            const bool surface = made.first.surface.size() > 0;
            if (gap && gap->index() == 0)
            {
               made.gap = place_function(std::get<0>(*gap), "gap", surface);
            }
            else if (gap)
            {
               require(surface,
                       "gap has a value for each node, which is for bodies in space; of "
                       "others it is a number or a function of the place");
               made.node_gaps = vector(std::get<1>(*gap), "gap");
            }
            new (self) Interface(std::move(made));
         },
         arg("name"), arg("first"), arg("second") = nb::none(), nb::kw_only(),
         arg("slave") = "coarser", arg("gap") = nb::none(), arg("most_overlap") = 0.1,
         arg("tied") = false, arg("pairing") = nb::none(),
         "name: its name in tables and sentences.\nfirst, second: (number of the body, its "
         "line, or in space its surface); without second: a rigid obstacle; for a half-plane "
         "the number alone.\nslave: "
         "the side that carries the nodes: 'coarser', 'finer', 'first' or 'second'.\ngap: a "
         "function of (x, y), in space of (x, y, z) or a value of each node of the side that "
         "has "
         "the nodes, or a number, instead of the gap of the geometry.\nmost_overlap: "
         "largest accepted overlap of the geometry, in lengths of the slave's elements.\ntied: "
         "joined permanently, without nodes in the problem; see "
         "Reduction.tied_forces().\npairing: nodes one to one, from pair_lines() or "
         "pair_surfaces(); without it nodes need not match.")
      .def_ro("name", &Interface::name)
      .def("__repr__",
           [](const Interface &self)
           {
              const auto called = [](const InterfaceSide &side)
              {
                 return side.body < 0
                           ? std::string("a rigid obstacle")
                           : "body " + std::to_string(side.body) + " (" +
                                std::to_string(side.line.size() + side.surface.size()) +
                                " nodes)";
              };
              return "<Interface '" + self.name + "': " + called(self.first) + " on " +
                     called(self.second) + ">";
           });

   nb::class_<InterfaceReport>(m, "InterfaceReport", "The data of an interface in a reduction.")
      .def_ro("name", &InterfaceReport::name)
      .def_prop_ro(
         "bodies",
         [](const InterfaceReport &self) { return std::pair(self.bodies[0], self.bodies[1]); },
         "number of the body that has the nodes, and of the one that faces them; -1: a rigid "
         "obstacle")
      .def_ro("first", &InterfaceReport::first)
      .def_ro("nodes", &InterfaceReport::nodes)
      .def_ro("matching", &InterfaceReport::matching)
      .def_prop_ro(
         "frames",
         [](const InterfaceReport &self) { return array(Eigen::MatrixXd(self.frames)); },
         "in space (nodes, 9): first tangent, second tangent, normal into the body that has "
         "the "
         "nodes, of each node")
      .def_prop_ro("free_surface", each_of(&InterfaceReport::free_surface, &xy),
                   "places of nodes that nothing faces")
      .def_prop_ro("without_row", each_of(&InterfaceReport::without_row, &xy))
      .def_ro("left_out", &InterfaceReport::left_out,
              "length that is faced but belongs to no node")
      .def_ro("arm", &InterfaceReport::arm, "moment left by a normal force of 1")
      .def_prop_ro(
         "turn", [](const InterfaceReport &self) { return array(Eigen::VectorXd(self.turn)); },
         "(nodes,), the angle between the normals of both bodies at each node, in radians")
      .def("__repr__",
           [](const InterfaceReport &self)
           {
              std::ostringstream text;

              text << "<InterfaceReport '" << self.name << "': nodes " << self.first << " to "
                   << self.first + self.nodes - 1 << (self.matching ? ", matching" : "") << ", "
                   << self.free_surface.size() << " nodes of free surface, left out "
                   << self.left_out << ">";
              return text.str();
           });

   using Self = Reduction;
   nb::class_<Self>(
      m, "Reduction",
      "A reduced problem, from whose states the fields of its bodies can be recovered.")
      .def_prop_ro(
         "problem", [](Self &self) -> ReducedProblem & { return self.problem; },
         nb::rv_policy::reference_internal)
      .def_prop_ro(
         "bodies",
         [](Self &self)
         {
            return references(
               self, self.bodies, [](CondensedBody & body) -> auto & { return body; });
         },
         nb::sig("def bodies(self) -> list[CondensedBody]"))
      .def_prop_ro("interfaces", [](const Self &self) { return self.interfaces; })
      .def_ro("counters", &Self::counters)
      .def(
         "displacement",
         [](Self &self, int body, const ContactState &state)
         {
            state.validate(self.problem);
            within(body, "body", 0, static_cast<int>(self.bodies.size()) - 1);
            return array(self.displacement(body, state.v, state.w, state.multipliers));
         },
         arg("body"), arg("state"),
         "Displacements of all rows of the stiffness of a body in a state of `problem`. Costs "
         "one solve. body: its number, from 0.")
      .def(
         "tied_forces",
         [](Self &self, const ContactState &state)
         {
            state.validate(self.problem);
            return array(self.tied_forces(state.v, state.w, state.multipliers));
         },
         arg("state"),
         "Nodal forces {q; p} that tied interfaces transfer in a state of `problem`: all "
         "tangential ones first, of the interfaces' nodes in the order of `interfaces`.")
      .def(
         "contact_forces",
         [](const Self &self, int body, const ContactState &state)
         {
            state.validate(self.problem);
            within(body, "body", 0, static_cast<int>(self.bodies.size()) - 1);
            return array(self.contact_forces(
               body, state.q, state.p, self.tied_forces(state.v, state.w, state.multipliers)));
         },
         arg("body"), arg("state"),
         "(nodes, 2), in space (nodes, 3): forces along x, y and z of contact and ties on the "
         "nodes of a body's contact line or surface, in its order.\n\nbody: its number, "
         "from "
         "0. state: of `problem`.")
      .def(
         "warnings",
         [](const Self &self, const ContactState &state)
         {
            state.validate(self.problem);
            return geometry_warnings(self, state.p);
         },
         arg("state"),
         "Warnings about geometry that affects this state, as sentences. They are about nodes "
         "in contact at which the normals of both bodies differ by an angle that is not small "
         "compared with friction, and about elements that differ although nodes are paired. "
         "Others are about ends that are taken for planes of symmetry, and nodes that supports "
         "hold obliquely. Empty if there are none.")
      .def(
         "add_obstacle_motion",
         [](Self &self, const std::string &name, const Place &ux, const Place &uy,
            const Place &uz)
         {
            const bool space = in_space(self.bodies[0]);
            const auto *z = std::get_if<double>(&uz);
            require(space || (z && *z == 0), "uz is not 0, and the bodies are not in space");
            self.add_obstacle_motion(name, place_function(ux, "ux", space),
                                     place_function(uy, "uy", space),
                                     place_function(uz, "uz", space));
         },
         arg("name"), arg("ux"), arg("uy"), arg("uz") = 0.0,
         "Adds a load that moves the rigid obstacle of one body. name: name of the load. ux, "
         "uy, in space uz: displacement per unit multiplier, numbers or functions of (x, y), "
         "in "
         "space of (x, y, z).")
      .def(
         "add_shank",
         [](Self &self, const std::string &pattern, double stiffness)
         { self.add_shank(pattern, finite(stiffness, "stiffness")); },
         arg("pattern"), arg("stiffness"),
         "A bolt: the load `pattern` pulls two parts of the bodies together and becomes the "
         "pretension; the force that acts is T - stiffness g, with g the approach of the "
         "parts.\n\npattern: name of a load of forces whose sum is 1 on each part, opposite "
         "on both. stiffness: force over displacement.")
      .def("__repr__",
           [](Self &of)
           {
              std::string names;
              for (const CondensedBody &body : of.bodies)
              {
                 if (!body.name.empty()) { names += " '" + body.name + "'"; }
              }
              const nb::object problem = nb::find(of).attr("problem");
              return "<Reduction of " + std::to_string(of.bodies.size()) +
                     (of.bodies.size() == 1 ? " body" : " bodies") + names + ": " +
                     nb::repr(problem).c_str() + ">";
           });

   // From condensed bodies to a reduced problem: one function for each kind of contact.
   const char *const torsion_is =
      "torsion: the axisymmetric bodies once more, in their order, condensed to the same nodes "
      "with formulation 'torsion'. A node then has 2 tangential components; all radial ones "
      "come first. q_theta are forces: a torque is the sum of r q_theta.";
   m.def(
      "reduce",
      [](const CondensedBody &body, const Place &gap, const Bodies &torsion)
      { return completed(reduce(body, place_function(gap, "gap", in_space(body))), torsion); },
      arg("body"), arg("gap") = 0.0, nb::kw_only(), arg("torsion") = nb::tuple(),
      "One body on a rigid obstacle. gap: its distance from the body, a number or a function "
      "of (x, y), in space of (x, y, z); 0.0: the obstacle has the shape of the body.");
   m.def(
      "reduce",
      [](const CondensedBody &body, const HalfPlane &half_plane, const Bodies &torsion)
      { return completed(reduce(body, half_plane), torsion); },
      arg("body"), arg("half_plane"), nb::kw_only(), arg("torsion") = nb::tuple(),
      "One body pressed on a half-plane. The gap is that of the geometry.");
   m.def(
      "reduce",
      [](const CondensedBody &body, const CondensedBody &other, const Pairing *pairing,
         const Bodies &torsion)
      { return completed(reduced_pair(body, other, pairing), torsion); },
      arg("body"), arg("other"), arg("pairing") = nb::none(), nb::kw_only(),
      arg("torsion") = nb::tuple(),
      "Two bodies whose nodes match, `body` on the `other`. If nodes are at the same places "
      "but elements differ, the bodies meet as at an interface. In space they do so if nodes "
      "do "
      "not match, too. pairing: from pair_lines() or pair_surfaces(); it is used whatever the "
      "elements, with a warning (OutcomeWarning) if they differ.");
   m.def(
      "reduce",
      [](const CondensedBody &body, Numbers gap)
      {
         if (body.surface.size() == 0) { throw nb::next_overload(); }
         return reduce(body, vector(gap, "gap", body.nodes()));
      },
      arg("body"), arg("gap"),
      "A body in space on a rigid obstacle. gap: of each of its contact nodes, see "
      "gaps_to_plane() and gaps_to_sphere().");
   m.def(
      "reduce",
      [](const Bodies &bodies, const std::vector<Interface> &interfaces,
         const HalfPlane *half_plane, const Bodies &torsion)
      {
         return completed(half_plane ? reduce(bodies, interfaces, *half_plane)
                                     : reduce(bodies, interfaces),
                          torsion);
      },
      arg("bodies"), arg("interfaces"), nb::kw_only(), arg("half_plane") = nb::none(),
      arg("torsion") = nb::tuple(),
      (std::string(
          "Any number of bodies that meet at interfaces, with nodes that match or not. With "
          "half_plane=… they stand on it: it is body number len(bodies), and the second side, "
          "without a line, of its interfaces: Interface('foot', (0, line), 1).\n") +
       torsion_is)
         .c_str());

   nb::class_<SeparateBodies>(
      m, "SeparateBodies",
      "Bodies that keep their own displacements: K U + loads = L^T {q; p}, u = L U.")
      .def_prop_ro("K", viewed(&SeparateBodies::K))
      .def_prop_ro(
         "L", [](const SeparateBodies &self) { return array(Eigen::MatrixXd(self.L)); },
         "dense")
      .def_prop_ro("loads", viewed(&SeparateBodies::loads), "a column per load")
      .def_prop_ro("names", each_of(&SeparateBodies::patterns, &LoadPattern::name),
                   "of the loads");
   m.def(
      "separate",
      [](const Bodies &bodies, const std::vector<Interface> &interfaces)
      { return separate(bodies, interfaces); },
      arg("bodies"), arg("interfaces"),
      "Condensed bodies that meet at interfaces, but keep their own displacements.");
}

} // namespace cattaneo::python
