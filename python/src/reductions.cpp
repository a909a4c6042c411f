#include "arrays.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <algorithm>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/reduced/geometry_warnings.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Condensed bodies meet: interfaces, reduce(), and the way back to the fields of the bodies.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(Side, "None | int | tuple[int, ContactLine]");

CATTANEO_ARGUMENT(MaybePairing, "None | Pairing");
CATTANEO_ARGUMENT(MaybePlace, "None | float | collections.abc.Callable[[float, float], float]");

/// A number, or a function of (x, y).
ScalarField place_function(nb::handle object, const std::string &what)
{
   if (PyCallable_Check(object.ptr()) == 0) { return number(object, what); }
   return [function = nb::borrow(object), what](double x, double y)
   { return number(function(x, y), what + "(" + exact_text(x) + ", " + exact_text(y) + ")"); };
}

InterfaceSide side(nb::handle object, const std::string &what)
{
   if (object.is_none()) { return {}; }
   if (PyIndex_Check(object.ptr()) !=
       0) // of a half-plane, whose line is that of the other side
   {
      return {static_cast<int>(whole(object, what, 0, 1 << 20)), {}};
   }
   if (!nb::isinstance<nb::tuple>(object) || nb::len(object) != 2)
   {
      refuse(object, what, "(number of the body, its ContactLine)");
   }
   return {static_cast<int>(whole(object[0], what + "[0]", 0, 1 << 20)),
           given<ContactLine>(nb::object(object[1]), what + "[1]")};
}

std::vector<CondensedBody> body_list(nb::handle bodies, const std::string &what = "bodies")
{
   std::vector<CondensedBody> all;
   for (const nb::object &body : sequence(bodies, what.c_str()))
   {
      all.push_back(given<CondensedBody>(body, what + "[" + std::to_string(all.size()) + "]"));
   }
   return all;
}

std::vector<Interface> interface_list(nb::handle interfaces)
{
   std::vector<Interface> all;
   for (const nb::object &each : sequence(interfaces, "interfaces"))
   {
      all.push_back(given<Interface>(each, "interfaces[" + std::to_string(all.size()) + "]"));
   }
   return all;
}

Reduction reduced(nb::handle first, nb::handle second, nb::handle pairing,
                  nb::handle half_plane)
{
   if (nb::isinstance<nb::list>(first) || nb::isinstance<nb::tuple>(first))
   {
      require(pairing.is_none(),
              "pairing is of two bodies, of several it is said of an Interface");
      return half_plane.is_none() ? reduce(body_list(first), interface_list(second))
                                  : reduce(body_list(first), interface_list(second),
                                           given<HalfPlane>(half_plane, "half_plane"));
   }
   require(half_plane.is_none(),
           "half_plane is of a list of bodies; of one body it is the second argument");
   const CondensedBody &body = given<CondensedBody>(first, "the first argument");
   if (nb::isinstance<HalfPlane>(second))
   {
      return reduce(body, given<HalfPlane>(second, "second"));
   }
   if (nb::isinstance<CondensedBody>(second))
   {
      const CondensedBody &other = given<CondensedBody>(second, "second");
      if (!pairing.is_none())
      {
         return reduce(body, other, given<Pairing>(pairing, "pairing"));
      }
      const Pairing pairs = pair_lines(body.line, other.line);
      const auto knows_elements = [](const CondensedBody &of)
      {
         return std::none_of(of.line.chains.begin(), of.line.chains.end(),
                             [](const LineChain &chain) { return chain.elements.empty(); });
      };
      // Places coincide. Where elements do not, nodes do not bear one to one.
      if (differing_element(body.line, other.line, pairs) >= 0 && knows_elements(body) &&
          knows_elements(other))
      {
         return reduce({body, other}, {{"contact", {0, body.line}, {1, other.line}}});
      }
      return reduce(body, other, pairs);
   }
   return reduce(body, place_function(second, "gap"));
}

Reduction with_torsion(nb::handle first, nb::handle second, nb::handle pairing,
                       nb::handle half_plane, nb::handle torsion)
{
   Reduction result = reduced(first, second, pairing, half_plane);
   for (const InterfaceReport &face : result.interfaces)
   {
      if (!face.differing) { continue; }
      warn("reduce: interface '" + face.name +
           "' pairs nodes one to one where the elements of the bodies differ, at (" +
           exact_text((*face.differing)[0]) + ", " + exact_text((*face.differing)[1]) +
           ") for instance: tractions are wrong from node to node; without a pairing nodes "
           "need not match");
   }
   if (!torsion.is_none()) { result.add_torsion(body_list(torsion, "torsion")); }
   return result;
}

nb::list points(const std::vector<Eigen::Vector2d> &places)
{
   nb::list all;
   for (const Eigen::Vector2d &place : places)
   {
      all.append(nb::make_tuple(place[0], place[1]));
   }
   return all;
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
      [](Of<ContactLine> line1, Of<ContactLine> line2, Number tolerance)
      {
         return pair_lines(given(line1, "line1"), given(line2, "line2"),
                           number(tolerance, "tolerance"));
      },
      arg("line1"), arg("line2"), arg("tolerance") = 1e-6,
      "Pairs nodes that match; tolerance: of the offset along the tangent, in edge lengths.");

   nb::class_<Interface>(m, "Interface",
                         "Where two bodies may touch, or a body and a rigid obstacle, or two "
                         "parts of one body.")
      .def(
         "__init__",
         [](Interface *self, Text name, Side first, Side second, Text slave, MaybePlace gap,
            Number most_overlap, Flag tied, MaybePairing pairing)
         {
            if (first.is_none())
            {
               refuse(first, "first", "(number of the body, its ContactLine)");
            }
            Interface made{
               text(name, "name"),
               side(first, "first"),
               side(second, "second"),
               chosen<SlaveSide>(slave, "slave", {"coarser", "finer", "first", "second"}),
               std::nullopt,
               number(most_overlap, "most_overlap"),
               flag(tied, "tied")};
            if (!pairing.is_none()) { made.pairing = given<Pairing>(pairing, "pairing"); }
            if (!gap.is_none()) { made.gap = place_function(gap, "gap"); }
            new (self) Interface(std::move(made));
         },
         arg("name"), arg("first"), arg("second") = nb::none(), nb::kw_only(),
         arg("slave") = "coarser", arg("gap") = nb::none(), arg("most_overlap") = 0.1,
         arg("tied") = false, arg("pairing") = nb::none(),
         "first, second: (number of the body, its line); no second: a rigid obstacle; of a "
         "half-plane the number alone.\n"
         "slave: which side carries the nodes: 'coarser', 'finer', 'first' or 'second'.\n"
         "gap: a function of (x, y) or a number instead of the geometry's.\n"
         "most_overlap: of the geometry, in lengths of the slave's elements.\n"
         "tied: joined whatever happens, without nodes in the problem; see "
         "Reduction.tied_forces().\n"
         "pairing: nodes one to one, of pair_lines(), instead of any that face each other.")
      .def_ro("name", &Interface::name)
      .def("__repr__",
           [](const Interface &self)
           {
              const auto called = [](const InterfaceSide &side)
              {
                 return side.body < 0 ? std::string("a rigid obstacle")
                                      : "body " + std::to_string(side.body) + " (" +
                                           std::to_string(side.line.size()) + " nodes)";
              };
              return "<Interface '" + self.name + "': " + called(self.first) + " on " +
                     called(self.second) + ">";
           });

   nb::class_<InterfaceReport>(m, "InterfaceReport", "What an interface came to.")
      .def_ro("name", &InterfaceReport::name)
      .def_prop_ro(
         "bodies",
         [](const InterfaceReport &self)
         { return nb::make_tuple(self.bodies[0], self.bodies[1]); },
         nb::sig("def bodies(self) -> tuple[int, int]"),
         "whose nodes it has, and whose face them; -1: a rigid obstacle")
      .def_ro("first", &InterfaceReport::first)
      .def_ro("nodes", &InterfaceReport::nodes)
      .def_ro("matching", &InterfaceReport::matching)
      .def_prop_ro(
         "free_surface", [](const InterfaceReport &self) { return points(self.free_surface); },
         nb::sig("def free_surface(self) -> list[tuple[float, float]]"),
         "places of nodes that nothing faces")
      .def_prop_ro(
         "without_row", [](const InterfaceReport &self) { return points(self.without_row); },
         nb::sig("def without_row(self) -> list[tuple[float, float]]"))
      .def_ro("left_out", &InterfaceReport::left_out,
              "length that is faced but that no node stands for")
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
   nb::class_<Self>(m, "Reduction",
                    "A reduced problem with the way back to the fields of its bodies.")
      .def_prop_ro(
         "problem", [](Self &self) -> ReducedProblem & { return self.problem; },
         nb::rv_policy::reference_internal)
      .def_prop_ro(
         "bodies",
         [](nb::handle_t<Self> self)
         {
            nb::list all;
            for (CondensedBody &body : given<Self>(self, "self").bodies)
            {
               all.append(nb::cast(body, nb::rv_policy::reference_internal, self));
            }
            return all;
         },
         nb::sig("def bodies(self) -> list[CondensedBody]"))
      .def_prop_ro(
         "interfaces",
         [](const Self &self)
         {
            nb::list all;
            for (const InterfaceReport &each : self.interfaces)
            {
               all.append(nb::cast(InterfaceReport(each)));
            }
            return all;
         },
         nb::sig("def interfaces(self) -> list[InterfaceReport]"))
      .def_ro("counters", &Self::counters)
      .def(
         "displacement",
         [](Self &self, Whole body, Of<ContactState> state)
         {
            const ContactState &of = given(state, "state");
            of.validate(self.problem);
            const long last = static_cast<long>(self.bodies.size()) - 1;
            return array(self.displacement(static_cast<int>(whole(body, "body", 0, last)), of.v,
                                           of.w, of.multipliers));
         },
         arg("body"), arg("state"),
         "Displacements of all rows of the stiffness of a body in a state; one solve.")
      .def(
         "tied_forces",
         [](Self &self, Of<ContactState> state)
         {
            const ContactState &of = given(state, "state");
            of.validate(self.problem);
            return array(self.tied_forces(of.v, of.w, of.multipliers));
         },
         arg("state"),
         "Nodal forces {q; p} that tied interfaces transfer, all tangential ones first, of "
         "their "
         "nodes in the order of `interfaces`.")
      .def(
         "warnings",
         [](const Self &self, Of<ContactState> state)
         {
            const ContactState &of = given(state, "state");
            of.validate(self.problem);
            return geometry_warnings(self, of.p);
         },
         arg("state"),
         "Sentences about geometry that this state hangs on: normals of both bodies that "
         "differ "
         "by an angle that is not small against friction where a node bears, elements that "
         "differ where nodes are paired, ends that are taken for planes of symmetry, nodes "
         "that "
         "supports hold askew. Empty: there is nothing to say.")
      .def(
         "add_obstacle_motion",
         [](Self &self, Text name, Place ux, Place uy)
         {
            self.add_obstacle_motion(text(name, "name"), place_function(ux, "ux"),
                                     place_function(uy, "uy"));
         },
         arg("name"), arg("ux"), arg("uy"),
         "A load that moves the rigid obstacle of one body by (ux, uy) per unit multiplier, "
         "numbers or functions of (x, y).")
      .def("__repr__",
           [](nb::handle_t<Self> self)
           {
              const Self &of = given<Self>(self, "self");
              std::string names;
              for (const CondensedBody &body : of.bodies)
              {
                 if (!body.name.empty()) { names += " '" + body.name + "'"; }
              }
              const nb::object problem = self.attr("problem");
              return "<Reduction of " + std::to_string(of.bodies.size()) +
                     (of.bodies.size() == 1 ? " body" : " bodies") + names + ": " +
                     nb::repr(problem).c_str() + ">";
           });

   m.def(
      "reduce", &with_torsion, arg("bodies"), arg("other") = 0.0, arg("pairing") = nb::none(),
      arg("half_plane") = nb::none(), nb::kw_only(), arg("torsion") = nb::none(),
      nb::sig("def reduce(bodies: CondensedBody | collections.abc.Sequence[CondensedBody], "
              "other: float | collections.abc.Callable[[float, float], float] | HalfPlane | "
              "CondensedBody | collections.abc.Sequence[Interface] = 0.0, pairing: None | "
              "Pairing = None, half_plane: None | HalfPlane = None, *, torsion: None | "
              "collections.abc.Sequence[CondensedBody] = None) -> Reduction"),
      "Condensed bodies to a reduced problem.\n\n"
      "reduce(body, gap=0.0): on a rigid obstacle; gap, a number or a function of (x, y), says "
      "how far it is from the body; 0.0: of the shape that the body has.\n"
      "reduce(body, half_plane): pressed on a half-plane; the gap is the geometry's.\n"
      "reduce(body1, body2[, pairing]): two bodies whose nodes match. Where nodes are at the "
      "same "
      "places but elements differ they meet as those of an interface do; a pairing that is "
      "given "
      "is taken and warned of (OutcomeWarning).\n"
      "reduce([bodies], [interfaces]): any number of bodies, nodes that match or not; with "
      "half_plane=… on it, which is body number len(bodies), the second side of interfaces "
      "without a line: Interface('foot', (0, line), 1).\n"
      "torsion: the axisymmetric bodies once more, in their order, condensed to the same nodes "
      "with formulation 'torsion': tangential components are then 2 a node, all radial ones "
      "first, and q_theta are forces: a torque is the sum of r q_theta.");

   nb::class_<SeparateBodies>(m, "SeparateBodies",
                              "Bodies that keep displacements of their own: K U + loads = "
                              "L^T {q; p}, u = L U.")
      .def_prop_ro("K", viewed(&SeparateBodies::K))
      .def_prop_ro(
         "L", [](const SeparateBodies &self) { return array(Eigen::MatrixXd(self.L)); },
         "dense")
      .def_prop_ro("loads", viewed(&SeparateBodies::loads), "a column a load")
      .def_prop_ro(
         "names",
         [](const SeparateBodies &self)
         {
            nb::list all;
            for (const LoadPattern &each : self.patterns) { all.append(each.name); }
            return all;
         },
         nb::sig("def names(self) -> list[str]"), "of the loads");
   m.def(
      "separate",
      [](nb::object bodies, nb::object interfaces)
      { return separate(body_list(bodies), interface_list(interfaces)); },
      arg("bodies"), arg("interfaces"),
      nb::sig("def separate(bodies: collections.abc.Sequence[CondensedBody], interfaces: "
              "collections.abc.Sequence[Interface]) -> SeparateBodies"));
}

} // namespace cattaneo::python
