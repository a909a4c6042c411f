#include "arrays.hpp"
#include "module.hpp"
#include "watch.hpp"
#include "words.hpp"
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/condense_joint.hpp>
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <cattaneo/reduced/pairing.hpp>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

// Half-planes and half-spaces without a mesh, and condense() of all bodies.

namespace cattaneo::python
{

namespace
{

/// Warns of linear elements next to the axis. Refinement does not remove their error.
CondensedBody warned(CondensedBody result)
{
   for (const LineChain &chain : result.line.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         const bool beside = element.nodes.front() < 0 || element.nodes.back() < 0;
         if (beside && element.order() == 1 &&
             result.line.formulation == Formulation::axisymmetric)
         {
            warn("condense: the element next to the axis is linear, and its node on the axis "
                 "takes no force: the pressure of the next node is wrong by 5 % or more on any "
                 "mesh; take order 2");
            return result;
         }
      }
   }
   return result;
}

} // namespace

void bind_half_planes(nb::module_ &m)
{
   nb::class_<Material>(m, "Material", "Isotropic linear elasticity in the plane.")
      .def(
         "__init__",
         [](Material *self, double young, double poisson, bool plane_stress)
         {
            const Material material{finite(young, "young"), finite(poisson, "poisson"),
                                    plane_stress ? PlaneState::stress : PlaneState::strain};
            material.validate();
            new (self) Material(material);
         },
         arg("young"), arg("poisson"), arg("plane_stress") = false,
         "young: Young's modulus E, > 0. poisson: Poisson's ratio, above -1 and below 0.5. "
         "plane_stress: plane stress if true, else plane strain.")
      .def_ro("young", &Material::young)
      .def_ro("poisson", &Material::poisson)
      .def_prop_ro("plane_stress",
                   [](const Material &self) { return self.state == PlaneState::stress; })
      .def_prop_ro("plane_modulus", &Material::plane_modulus, "E/(1-ν²); E in plane stress")
      .def("__repr__",
           [](const Material &self)
           {
              return "Material(young=" + exact_text(self.young) +
                     ", poisson=" + exact_text(self.poisson) +
                     (self.state == PlaneState::stress ? ", plane_stress=True)" : ")");
           });

   nb::class_<HalfPlane>(m, "HalfPlane",
                         "An elastic half-plane (about an axis half-space) with a straight "
                         "surface: a body without a mesh.")
      .def(
         "__init__",
         [](HalfPlane *self, const Material &material, double depth, Numbers point,
            Numbers normal, std::optional<bool> symmetric, const NamedNumbers &forces,
            const NamedLoads &bulk, double thickness)
         {
            HalfPlane body{material,
                           finite(depth, "depth"),
                           vector(point, "point", 2),
                           vector(normal, "normal", 2),
                           {},
                           {}};
            if (symmetric) { body.symmetric = *symmetric; }
            body.thickness = finite(thickness, "thickness");
            for (const auto &[name, stress] : bulk)
            {
               body.bulk.push_back({name, finite(stress, ("bulk['" + name + "']").c_str())});
            }
            for (const auto &[name, force] : by_names(forces, "forces"))
            {
               body.forces.push_back({name, vector(force, "forces['" + name + "']", 2)});
            }
            new (self) HalfPlane(std::move(body));
         },
         arg("material"), arg("depth") = 0.0, arg("point") = nb::make_tuple(0.0, 0.0),
         arg("normal") = nb::make_tuple(0.0, -1.0), arg("symmetric") = nb::none(),
         arg("forces") = nb::dict(), arg("bulk") = nb::dict(), arg("thickness") = 1.0,
         "material: its elastic constants.\n"
         "depth: of the plane, > 0: displacements are relative to the point at this depth "
         "below "
         "each force; contact under given forces does not depend on it. At least twice "
         "the length of the contact; 1e4 times is fine.\n"
         "symmetric: in the plane, true if the line through the point along the normal is a "
         "plane of symmetry (half a model). It must be given if a contact line ends at a held "
         "node.\n"
         "point: of the surface. normal: into the half-plane, a unit vector.\n"
         "forces: by name, (x, y), from far away; without any it is held.\n"
         "bulk: by name, uniform stresses along the surface, tension positive; about an axis "
         "the same in all directions. They do not move `point`. A name may have a force as "
         "well.\n"
         "thickness: of the plane: forces and stiffness are those of this thickness.")
      .def_ro("material", &HalfPlane::material)
      .def_ro("depth", &HalfPlane::depth)
      .def_ro("thickness", &HalfPlane::thickness)
      .def("__repr__",
           [](const HalfPlane &self)
           {
              return "<HalfPlane: E = " + exact_text(self.material.young) +
                     ", ν = " + exact_text(self.material.poisson) +
                     ", depth = " + exact_text(self.depth) + ", surface at (" +
                     exact_text(self.point[0]) + ", " + exact_text(self.point[1]) + ")" +
                     (self.forces.empty() ? ", held" : ", pressed from far away") + ">";
           });

   m.def(
      "condense",
      [](const NodalStiffness &body, const ContactLine &line)
      {
         // Copies, so that no other thread changes them meanwhile.
         const AssembledBody assembled = body.body();
         const ContactLine trace = line;
         const std::string gone =
            assembled.grounded ? assembled.eliminated_warning() : std::string();
         if (!gone.empty()) { warn("condense: " + gone); }
         CondensedBody result = unlocked([&] { return condense(assembled, trace); });
         result.name = body.name;
         return warned(std::move(result));
      },
      arg("body"), arg("line"),
      "Condenses a body to the nodes of a contact line: one sparse factorisation, one solve a "
      "load.\n\nbody: a body with a mesh or matrix, or a half-plane. line: from "
      "body.contact_line(), or several lines joined(). For a half-plane it is the line of the "
      "body that presses on it, or the places of the ends of elements along its surface. "
      "order: order of these elements, 1 to 8. formulation: 'plane' or 'axisymmetric'.");
   m.def(
      "condense",
      [](const NodalStiffness &body, const ContactSurface &surface)
      {
         const AssembledBody assembled = body.body();
         const ContactSurface trace = surface;
         const std::string gone =
            assembled.grounded ? assembled.eliminated_warning() : std::string();
         if (!gone.empty()) { warn("condense: " + gone); }
         CondensedBody result = unlocked([&] { return condense(assembled, trace); });
         result.name = body.name;
         return warned(std::move(result));
      },
      arg("body"), arg("surface"),
      "Condenses a body in space to the nodes of a surface.\n\nsurface: from "
      "body.contact_surface().");
   m.def(
      "condense_joint",
      [](const NodalStiffness &body1, const ContactSurface &surface1,
         const NodalStiffness &body2, const ContactSurface &surface2, const Pairing &pairing)
      {
         const AssembledBody one = body1.body(), other = body2.body();
         const ContactSurface first = surface1, second = surface2;
         const std::vector<int> partner = pairing.partner;
         for (const AssembledBody *body : {&one, &other})
         {
            const std::string gone =
               body->grounded ? body->eliminated_warning() : std::string();
            if (!gone.empty()) { warn("condense joint: " + gone); }
         }
         CondensedBody result =
            unlocked([&] { return condense_joint(one, first, other, second, partner); });
         result.name = body1.name + " on " + body2.name;
         return warned(std::move(result));
      },
      arg("body1"), arg("surface1"), arg("body2"), arg("surface2"), arg("pairing"),
      "Condenses two bodies in space together, in relative coordinates. Only the relative "
      "displacements of their contact nodes are kept, half as many rows as of both bodies "
      "alone. "
      "The result stands for the joint as one body: reduce(joint, pairing.gap). Its forces are "
      "those on body1, and displacement(0, …) has the rows of body1, then those of body2. "
      "Loads "
      "of one name are one load.\n\nbody1: may be free. surface1: from "
      "body1.contact_surface(). body2: must be held by its supports. surface2: its surface. "
      "pairing: pair_surfaces(surface1, surface2). InputError if supports hold a contact node "
      "of "
      "body1 alone, or a load moves one.");
   m.def(
      "condense",
      [](const HalfPlane &body, const ContactLine &line)
      {
         return warned(unlocked([half_plane = body, trace = line]
                                { return condense(half_plane, trace); }));
      },
      arg("body"), arg("line"));
   m.def(
      "condense",
      [](const HalfPlane &body, Numbers line, int order, const std::string &formulation)
      {
         const Eigen::VectorXd ends = vector(line, "line");
         const auto kind = chosen<Formulation>(formulation, "formulation");
         within(order, "order", 1, 8);
         return warned(unlocked(
            [&, half_plane = body] {
               return condense(half_plane, {ends.data(), ends.data() + ends.size()}, order,
                               kind);
            }));
      },
      arg("body"), arg("line"), arg("order") = 1, arg("formulation") = "plane");

   using Field = HalfPlaneField;
   nb::class_<Field>(
      m, "HalfPlaneField",
      "Displacements and stresses inside of a half-plane under the forces of its "
      "contact nodes, by closed forms.")
      .def(
         "__init__",
         [](Field *self, const HalfPlane &body, const ContactLine &line, Numbers forces,
            double bulk)
         { new (self) Field(body, line, vector(forces, "forces", 2 * line.size()), bulk); },
         arg("body"), arg("line"), arg("forces"), arg("bulk") = 0.0,
         "body: the half-plane. line: of the condensed half-plane. forces: {q; p} on its nodes "
         "in their frames. "
         "bulk: "
         "uniform stress along the surface that acts in addition, tension positive.")
      .def(
         "at",
         [](const Field &self, Numbers points)
         {
            const Eigen::MatrixXd places = matrix(points, "points", -1, 2);
            Eigen::MatrixXd displacement(places.rows(), 2), stress(places.rows(), 3);
            for (Index i = 0; i < places.rows(); ++i)
            {
               const Field::Point point = self.at(places.row(i));
               displacement.row(i) = point.displacement;
               stress.row(i) << point.xx, point.yy, point.xy;
            }
            return nb::make_tuple(array(std::move(displacement)), array(std::move(stress)));
         },
         arg("points"),
         nb::sig("def at(self, points: numpy.typing.ArrayLike) -> "
                 "tuple[numpy.typing.NDArray[numpy.float64], "
                 "numpy.typing.NDArray[numpy.float64]]"),
         "At points (m, 2): displacements (m, 2) and stresses xx, yy, xy (m, 3), tension "
         "positive.");
}

} // namespace cattaneo::python
