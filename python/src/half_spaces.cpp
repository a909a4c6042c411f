#include "arrays.hpp"
#include "module.hpp"
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/halfplane/half_space_vtu.hpp>
#include <cattaneo/halfplane/heights.hpp>
#include <nanobind/stl/optional.h>

// Half-spaces in three dimensions, without a mesh.

namespace cattaneo::python
{

void bind_half_spaces(nb::module_ &m)
{
   nb::class_<HalfSpace>(
      m, "HalfSpace",
      "Two elastic half-spaces that meet in the plane z = 0, or one on a rigid body: contact "
      "in "
      "three dimensions without a mesh, tractions uniform on equal rectangles or on triangles.")
      .def(
         "__init__",
         [](HalfSpace *self, const Material &material, const std::optional<Material> &other,
            const std::optional<Numbers> &size, const std::optional<Numbers> &centres,
            const std::optional<Numbers> &vertices, const std::optional<Numbers> &triangles,
            bool turns, bool ends)
         {
            HalfSpace body;
            body.material = material;
            body.other = other;
            if (size) { body.size = vector_or_number(*size, "size", 2); }
            if (centres)
            {
               require(size.has_value(), "half-space: rectangles have centres and no size");
               body.centres = matrix(*centres, "centres", -1, 2);
            }
            if (vertices) { body.vertices = matrix(*vertices, "vertices", -1, 2); }
            if (triangles)
            {
               const Eigen::MatrixXd corners = matrix(*triangles, "triangles", -1, 3);
               require(corners == corners.array().round().matrix() &&
                          corners.cwiseAbs().maxCoeff() < 2e9,
                       "half-space: triangles are not whole numbers of vertices");
               body.triangles = corners.cast<int>();
            }
            body.turns = turns;
            body.ends = ends;
            body.validate();
            new (self) HalfSpace(std::move(body));
         },
         nb::arg("material"), nb::arg("other") = nb::none(), nb::kw_only(),
         nb::arg("size") = nb::none(), nb::arg("centres") = nb::none(),
         nb::arg("vertices") = nb::none(), nb::arg("triangles") = nb::none(),
         nb::arg("turns") = false, nb::arg("ends") = false,
         "material: of the body above. other: of the half-space below; None: it is rigid.\n"
         "size: edges (x, y) of every rectangle, or one number for both.\n"
         "centres: (n, 2), of the rectangles that may touch: any cells of one grid, in any "
         "order.\n"
         "vertices: (k, 2), and triangles: (n, 3), their corners, rows of vertices from 0, as "
         "of scipy.spatial.Delaunay: instead of size and centres.\n"
         "turns: is the body above free to turn about the normal through x = y = 0?\n"
         "ends: does a body end at the rim of the cells, as a flat punch? If not, contact that "
         "is compressed there is cut off, and marches warn.")
      .def(
         "problem",
         [](const HalfSpace &self, Numbers gap)
         {
            const HalfSpace contact = self;
            const Eigen::VectorXd gaps = vector_or_number(gap, "gap", self.nodes());
            const nb::gil_scoped_release unlocked;
            return contact.problem(gaps);
         },
         nb::arg("gap"),
         "The frictional contact with a gap of each cell, (n,) at the centre of a rectangle or "
         "in the mean over a triangle, or one number. First tangents along x, second along y, "
         "normals along z, into the body "
         "above; weights are areas.\n"
         "Loads are forces on this body from far away: 'P' presses it on the other one, 'Q1' "
         "and 'Q2' act along x and y; if it turns, 'T' is a moment about z. Their conjugates "
         "are its approach, shifts and turn.")
      .def(
         "outlines",
         [](const HalfSpace &self, Numbers cells)
         {
            // Other functions do not accept true and false as numbers either.
            const nb::object flags = nb::module_::import_("numpy")
                                        .attr("asarray")(cells, "bool")
                                        .attr("astype")("float");
            const Eigen::VectorXd which = vector(flags, "cells", self.nodes());
            nb::list lines;
            for (Eigen::MatrixX2d &line :
                 self.outlines(std::vector<bool>(which.begin(), which.end())))
            {
               lines.append(array(Eigen::MatrixXd(line)));
            }
            return lines;
         },
         nb::arg("cells"),
         nb::sig("def outlines(self, cells: numpy.typing.ArrayLike) -> "
                 "list[numpy.typing.NDArray[numpy.float64]]"),
         "Outlines of the cells with true entries, (n,), along their edges: closed lines (k, "
         "2), counter-clockwise around a part and clockwise around a hole. "
         "settled_states(problem, state) == NodeState.stick is the edge of stick.")
      .def(
         "displacements",
         [](const HalfSpace &self, Numbers points, Numbers forces)
         {
            return array(self.displacements(matrix(points, "points", -1, 2),
                                            vector(forces, "forces", 3 * self.nodes())));
         },
         nb::arg("points"), nb::arg("forces"),
         "At points (m, 2) of the surface under nodal forces {q; p}, (3 n,): displacements (m, "
         "3) along x, y and z of the body above less those of the body below, without the "
         "rigid motions of far bodies.")
      .def(
         "stresses",
         [](const HalfSpace &self, Numbers points, Numbers forces)
         {
            return array(self.stresses(matrix(points, "points", -1, 3),
                                       vector(forces, "forces", 3 * self.nodes())));
         },
         nb::arg("points"), nb::arg("forces"),
         "Stresses (m, 6) at points (m, 3) inside of the bodies under nodal forces {q; p}, (3 "
         "n,). They are xx, yy, zz, yz, zx and xy, positive in tension. z > 0 is the body "
         "above, z < 0 the one below.")
      .def(
         "resultant",
         [](const HalfSpace &self, Numbers forces) {
            return array(
               Eigen::VectorXd(self.resultant(vector(forces, "forces", 3 * self.nodes()))));
         },
         nb::arg("forces"),
         "(6,), resultant on the body above of nodal forces {q; p}, (3 n,): force and moment "
         "about x = y = 0, along x, y and z.")
      .def(
         "write_vtu",
         [](const HalfSpace &self, File name, const ReducedProblem &problem,
            const ContactState &state) { write_vtu(file(name), self, problem, state); },
         nb::arg("file"), nb::arg("problem"), nb::arg("state"),
         "Writes a state for ParaView and others: a quadrilateral or triangle for each cell, "
         "with "
         "pressure, shear, slip, opening and state (NodeState). Numbered names, one for each "
         "state of a march, are a series.")
      .def_ro("material", &HalfSpace::material, "of the body above")
      .def_ro("other", &HalfSpace::other, nb::sig("def other(self) -> None | Material"),
              "of the half-space below; None: it is rigid")
      .def_prop_ro(
         "size", [](const HalfSpace &self) { return array(Eigen::VectorXd(self.size)); },
         "(2,), edges of every rectangle along x and y")
      .def_prop_ro(
         "centres", [](const HalfSpace &self) { return array(Eigen::MatrixXd(self.centres)); },
         "(n, 2), of the rectangles; (0, 2) where there are triangles")
      .def_prop_ro(
         "vertices",
         [](const HalfSpace &self) { return array(Eigen::MatrixXd(self.vertices)); },
         "(k, 2), of the triangles")
      .def_prop_ro(
         "triangles",
         [](const HalfSpace &self) { return array<Integers>(Eigen::MatrixXi(self.triangles)); },
         "(n, 3), their corners, rows of vertices")
      .def_prop_ro(
         "middles",
         [](const HalfSpace &self) { return array(Eigen::MatrixXd(self.middles())); },
         "(n, 2), centres of area of the rectangles or triangles")
      .def_prop_ro(
         "areas", [](const HalfSpace &self) { return array(self.areas()); },
         "(n,), of the rectangles or triangles")
      .def_ro("turns", &HalfSpace::turns, "is the body above free to turn?")
      .def_ro("ends", &HalfSpace::ends, "does a body end at the rim of the cells?");

   nb::class_<Heights>(
      m, "Heights",
      "Heights of a surface on a regular grid, linear between its points along "
      "x and y. The middle of the grid is x = y = 0.")
      .def(
         "__init__",
         [](Heights *self, Numbers z, Numbers step) {
            new (self) Heights{vector_or_number(step, "step", 2), matrix(z, "z").transpose()};
         },
         nb::arg("z"), nb::kw_only(), nb::arg("step"),
         "z: (lines, points), a row each line along x, the first with the least y. step: from "
         "one point to the next along x and y, or one number for both.")
      .def(
         "at",
         [](const Heights &self, Numbers points)
         { return array(self.at(matrix(points, "points", -1, 2))); },
         nb::arg("points"), "At points (m, 2) within the grid.")
      .def_prop_ro(
         "z", [](const Heights &self) { return array(Eigen::MatrixXd(self.z.transpose())); },
         "(lines, points); nan: not measured")
      .def_prop_ro(
         "step", [](const Heights &self) { return array(Eigen::VectorXd(self.step)); },
         "(2,), from one point to the next along x and y");
   m.def(
      "read_heights", [](File name, double unit) { return read_heights(file(name), unit); },
      nb::arg("file"), nb::arg("unit") = 1.0,
      "Reads a text file of surface data, SDF of ISO 25178-71. Its lengths are in metres. "
      "unit: unit of the result in metres, 1e-3 for mm.");
}

} // namespace cattaneo::python
