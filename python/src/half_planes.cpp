#include "arrays.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/halfplane/half_plane_field.hpp>
#include <nanobind/stl/string.h>

// Half-planes and half-spaces without a mesh, and condense() of all bodies.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(AnyBody, "NodalStiffness | HalfPlane");
CATTANEO_ARGUMENT(LineOrGrid, "ContactLine | numpy.typing.ArrayLike");
CATTANEO_ARGUMENT(MaybeFlag, "bool | None");
CATTANEO_ARGUMENT(FarForces, "None | collections.abc.Mapping[str, numpy.typing.ArrayLike]");

const std::vector<std::string> formulations = {"plane", "axisymmetric", "torsion"};

CondensedBody condensed(nb::handle body, nb::handle line, nb::handle order,
                        nb::handle formulation)
{
   if (nb::isinstance<NodalStiffness>(body))
   {
      const auto &stiffness = given<NodalStiffness>(body, "body");
      // Copies, so that no other thread changes them meanwhile.
      const AssembledBody assembled = stiffness.body();
      const ContactLine trace = given<ContactLine>(line, "line");
      const nb::gil_scoped_release unlocked;
      CondensedBody result = condense(assembled, trace);
      result.name = stiffness.name;
      return result;
   }
   if (!nb::isinstance<HalfPlane>(body))
   {
      refuse(body, "body", "of class NodalStiffness or HalfPlane");
   }
   const HalfPlane half_plane = given<HalfPlane>(body, "body");
   if (nb::isinstance<ContactLine>(line))
   {
      const ContactLine trace = given<ContactLine>(line, "line");
      const nb::gil_scoped_release unlocked;
      return condense(half_plane, trace);
   }
   const Eigen::VectorXd ends = vector(line, "line");
   const int degree = static_cast<int>(whole(order, "order", 1, 8));
   const auto kind = chosen<Formulation>(formulation, "formulation", formulations);
   const nb::gil_scoped_release unlocked;
   return condense(half_plane, {ends.data(), ends.data() + ends.size()}, degree, kind);
}

/// Linear elements beside the axis have an error that no refinement takes away.
CondensedBody warned(nb::handle body, nb::handle line, nb::handle order, nb::handle formulation)
{
   if (nb::isinstance<NodalStiffness>(body))
   {
      const AssembledBody assembled = given<NodalStiffness>(body, "body").body();
      const std::string gone =
         assembled.grounded ? assembled.eliminated_warning() : std::string();
      if (!gone.empty()) { warn("condense: " + gone); }
   }
   CondensedBody result = condensed(body, line, order, formulation);
   for (const LineChain &chain : result.line.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         const bool beside = element.nodes.front() < 0 || element.nodes.back() < 0;
         if (beside && element.order() == 1 &&
             result.line.formulation == Formulation::axisymmetric)
         {
            warn("condense: a linear element lies beside the axis, whose node on it takes no "
                 "force: pressures next to it are wrong by 5 % or more however fine the "
                 "elements are; take order 2");
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
         [](Material *self, Number young, Number poisson, Flag plane_stress)
         {
            const Material material{number(young, "young"), number(poisson, "poisson"),
                                    flag(plane_stress, "plane_stress") ? PlaneState::stress
                                                                       : PlaneState::strain};
            material.validate();
            new (self) Material(material);
         },
         arg("young"), arg("poisson"), arg("plane_stress") = false)
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
         [](HalfPlane *self, Of<Material> material, Number depth, Numbers point, Numbers normal,
            MaybeFlag symmetric, FarForces forces)
         {
            HalfPlane body{given(material, "material"),
                           number(depth, "depth"),
                           vector(point, "point", 2),
                           vector(normal, "normal", 2),
                           {},
                           {}};
            if (!symmetric.is_none()) { body.symmetric = flag(symmetric, "symmetric"); }
            if (!forces.is_none())
            {
               if (!nb::isinstance<nb::dict>(forces))
               {
                  refuse(forces, "forces", "a dict of forces (x, y) by names");
               }
               for (const auto &[key, force] : nb::borrow<nb::dict>(forces))
               {
                  const std::string name = text(key, "a name in forces");
                  body.forces.push_back({name, vector(force, "forces['" + name + "']", 2)});
               }
            }
            new (self) HalfPlane(std::move(body));
         },
         arg("material"), arg("depth") = 0.0, arg("point") = nb::make_tuple(0.0, 0.0),
         arg("normal") = nb::make_tuple(0.0, -1.0), arg("symmetric") = nb::none(),
         arg("forces") = nb::none(),
         "depth: of the plane, > 0: displacements are relative to the point at this depth "
         "below "
         "each force; what given forces do to a contact does not depend on it. At least twice "
         "the length of the contact; 1e4 times is fine.\n"
         "symmetric: of the plane, that the line through the point along the normal is one of "
         "symmetry (half a model). It must be said where a contact line ends at a held node.\n"
         "point: of the surface. normal: into the half-plane, a unit vector.\n"
         "forces: by name, (x, y), from far away; without any it is held.")
      .def_ro("material", &HalfPlane::material)
      .def_ro("depth", &HalfPlane::depth)
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
      "condense", &warned, arg("body"), arg("line"), arg("order") = 1,
      arg("formulation") = "plane",
      nb::sig("def condense(body: NodalStiffness | HalfPlane, line: ContactLine | "
              "numpy.typing.ArrayLike, order: int = 1, formulation: str = 'plane') -> "
              "CondensedBody"),
      "Condenses a body to the nodes of a contact line: one sparse factorisation, one solve a "
      "load.\n\nOf a half-plane the line is that of the body that presses on it, or ends of "
      "elements of the given order along its surface.");

   using Field = HalfPlaneField;
   nb::class_<Field>(
      m, "HalfPlaneField",
      "Displacements and stresses inside of a half-plane under the forces of its "
      "contact nodes, by closed forms.")
      .def(
         "__init__",
         [](Field *self, Of<HalfPlane> body, Of<ContactLine> line, Numbers forces)
         {
            const auto &trace = given(line, "line");
            new (self)
               Field(given(body, "body"), trace, vector(forces, "forces", 2 * trace.size()));
         },
         arg("body"), arg("line"), arg("forces"),
         "line: of the condensed half-plane. forces: {q; p} on its nodes in their frames.")
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
