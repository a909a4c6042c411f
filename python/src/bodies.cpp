#include "arrays.hpp"
#include "module.hpp"
#include "words.hpp"
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/exchange/nodal_statements.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/words.hpp>
#include <filesystem>
#include <limits>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <set>
#include <sstream>

// Stiffness matrices, their contact lines, and condensed bodies.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(Matrix,
                  "scipy.sparse.sparray | scipy.sparse.spmatrix | numpy.typing.ArrayLike",
                  anything);
CATTANEO_ARGUMENT(Nodes, "str | numpy.typing.ArrayLike", anything);

CATTANEO_ARGUMENT(Statements, "str | collections.abc.Sequence[str]", anything);

/// Statements of a case file: a string, or a list of them.
std::string in_words(nb::handle statements, const std::string &what)
{
   if (nb::isinstance<nb::str>(statements)) { return nb::cast<std::string>(statements); }
   std::vector<std::string> all;
   if (!nb::try_cast(statements, all)) { refuse(statements, what, "a str, or a list of them"); }
   return listed(all, "; ");
}

constexpr int most_rows = std::numeric_limits<int>::max() - 1;

/// A copy in SciPy's csr. The indices of a csr matrix must be checked, because a script may
/// have changed them, and SciPy would write outside the matrix.
nb::object own_rows(nb::handle K, const std::string &name)
{
   if (nb::hasattr(K, "row") && nb::hasattr(K, "col")) // coo
   {
      const Index entries = integer(K.attr("data").attr("size"));
      const char *const names[] = {"row", "col"};
      for (int k : {0, 1})
      {
         const std::string what = name + "." + names[k];
         const auto found =
            indices(nb::object(K.attr(names[k])), what, 0, integer(K.attr("shape")[k]) - 1);
         require(static_cast<Index>(found.size()) == entries, what, " has ", found.size(),
                 " entries, must have ", entries, " as ", name, ".data");
      }
   }
   try
   {
      const nb::object own = K.attr("copy")();
      if (nb::hasattr(own, "check_format"))
      {
         own.attr("check_format")(nb::arg("full_check") = true);
      }
      return own.attr("tocsr")();
   }
   catch (nb::python_error &error)
   {
      if (!error.matches(PyExc_ValueError)) { throw; }
      throw InputError(name +
                       " is not a valid sparse matrix: " + nb::str(error.value()).c_str());
   }
}

/// A sparse or dense matrix of Python. Duplicate entries are added up, as SciPy does.
NodalStiffness::Matrix sparse_matrix(nb::handle K, const std::string &name)
{
   if (!nb::hasattr(K, "tocsr")) // dense
   {
      const Eigen::MatrixXd dense = matrix(K, name);
      require(dense.rows() == dense.cols() && dense.rows() > 0, name, " has shape (",
              dense.rows(), ", ", dense.cols(), "), must be square");
      return dense.sparseView(0.0, 0.0);
   }
   const nb::object rows = own_rows(K, name);
   rows.attr("sum_duplicates")();
   const Index size = integer(rows.attr("shape")[0]), columns = integer(rows.attr("shape")[1]),
               entries = integer(rows.attr("nnz"));
   require(size == columns && size > 0, name, " has shape (", size, ", ", columns,
           "), must be square");
   require(entries <= most_rows, name, " has ", entries, " entries, at most ", most_rows,
           " are possible");
   const Eigen::VectorXd values = vector(rows.attr("data"), name + ".data", entries);
   const auto column = indices(rows.attr("indices"), name + ".indices", 0, size - 1),
              start = indices(rows.attr("indptr"), name + ".indptr", 0, entries);
   require(static_cast<Index>(column.size()) == entries &&
              static_cast<Index>(start.size()) == size + 1 && start.front() == 0 &&
              start.back() == entries && std::is_sorted(start.begin(), start.end()),
           name, ".indptr does not fit ", name, ": it must have ", size + 1,
           " entries that increase from 0 to ", entries);
   return Eigen::Map<const NodalStiffness::Matrix>(size, size, entries, start.data(),
                                                   column.data(), values.data());
}

/// Elements of one kind as rows of an array, or several such arrays.
std::vector<NodalStiffness::Nodes> element_list(nb::handle elements, long most)
{
   std::vector<NodalStiffness::Nodes> all;
   const auto add = [&](nb::handle block, const std::string &what)
   {
      const Eigen::MatrixXi nodes = whole_matrix(block, what, -1, -1, 0, most);
      for (Index e = 0; e < nodes.rows(); ++e)
      {
         const Eigen::RowVectorXi row = nodes.row(e);
         all.emplace_back(row.data(), row.data() + row.size());
      }
   };
   const bool several =
      (nb::isinstance<nb::list>(elements) || nb::isinstance<nb::tuple>(elements)) &&
      nb::len(elements) > 0 &&
      integer(nb::module_::import_("numpy").attr("ndim")(nb::object(elements[0]))) == 2;
   if (!several)
   {
      add(elements, "elements");
      return all;
   }
   for (std::size_t k = 0; k < nb::len(elements); ++k)
   {
      add(nb::object(elements[k]), "elements[" + std::to_string(k) + "]");
   }
   return all;
}

std::vector<int> node_numbers(const NodalStiffness &body)
{
   std::vector<int> nodes;
   for (const auto &[node, place] : body.places) { nodes.push_back(node); }
   return nodes;
}

/// A set by its name, numbers of nodes, or a mask over NodalStiffness.nodes.
NodalStiffness::Nodes nodes_in(const NodalStiffness &body, nb::handle nodes)
{
   const auto some = [](NodalStiffness::Nodes found, const char *why)
   {
      require(!found.empty(), "nodes", why, ", must name at least one node");
      return found;
   };
   if (nb::isinstance<nb::str>(nodes))
   {
      return some(body.nodes_of(nb::cast<std::string>(nodes)), " is a set without nodes");
   }
   if (!is_mask(nodes)) { return some(indices(nodes, "nodes", 0, most_rows), " is empty"); }
   const std::vector<int> all = node_numbers(body);
   NodalStiffness::Nodes found;
   for (int k : indices(nodes, "nodes", 0, static_cast<long>(all.size()) - 1))
   {
      found.push_back(all[k]);
   }
   return some(found, " is a mask without a true entry");
}

/// The name of a load, which must not be empty.
const std::string &load_name(const std::string &load)
{
   require(!load.empty(), "load is '', a load must have a name");
   return load;
}

/// 1 and 2 for x and y, or r and z; in space 3 for z.
std::vector<int> directions(const NodalStiffness &body, const std::string &direction)
{
   if (body.formulation == Formulation::space)
   {
      choice(direction, "direction", {"x", "y", "z", "xy", "xz", "yz", "xyz"});
      std::vector<int> all;
      for (char letter : direction) { all.push_back(letter - 'x' + 1); }
      return all;
   }
   const bool plane = body.formulation == Formulation::plane;
   const std::size_t word = choice(direction, "direction",
                                   plane ? std::vector<std::string>{"x", "y", "xy"}
                                         : std::vector<std::string>{"r", "z", "rz"});
   return word == 2 ? std::vector<int>{1, 2} : std::vector<int>{static_cast<int>(word) + 1};
}

void fill(NodalStiffness &body, nb::handle places, nb::handle dofs, nb::handle elements,
          nb::handle fixed, const NamedNumbers &loads, const NamedNumbers &sets)
{
   const int rows = static_cast<int>(body.K.rows());
   const Eigen::MatrixXd at = matrix(places, "places");
   const int nodes = static_cast<int>(at.rows()), dimension = static_cast<int>(at.cols());
   require(nodes > 0 && (dimension == 2 || dimension == 3), "places has shape (", nodes, ", ",
           dimension, "), must have a row of two or three coordinates for each node");
   if (dimension == 3)
   {
      require(body.formulation == Formulation::plane, "places has three coordinates a node, ",
              "which is no ", name(body.formulation), " body");
      body.formulation = Formulation::space;
   }
   for (int node = 0; node < nodes; ++node)
   {
      body.places[node] = at.row(node).head(2);
      if (dimension == 3) { body.z[node] = at(node, 2); }
   }
   Eigen::MatrixXi row_of(nodes, dimension);
   if (dofs.is_none())
   {
      require(rows == dimension * nodes, "K has ", rows, " rows and places ", nodes,
              " nodes: without dofs rows ", dimension,
              " i and on are the directions of node i, "
              "there must be ",
              dimension, " times as many rows as nodes");
      for (int row = 0; row < rows; ++row) { row_of(row / dimension, row % dimension) = row; }
   }
   else { row_of = whole_matrix(dofs, "dofs", nodes, dimension, -1, rows - 1); }
   body.dofs.assign(rows, {-1, 0});
   for (int node = 0; node < nodes; ++node)
   {
      for (int c = 0; c < dimension; ++c)
      {
         const int row = row_of(node, c);
         if (row < 0) { continue; }
         NodeDof &dof = body.dofs[row];
         require(dof.node < 0, "dofs[", node, ", ", c, "] is row ", row, ", which is dofs[",
                 dof.node, ", ", dof.direction - 1,
                 "] already; each row is of one node and direction");
         dof = {node, c + 1};
      }
   }
   for (int row = 0; row < rows; ++row)
   {
      require(body.dofs[row].node >= 0, "row ", row,
              " of K is in no entry of dofs, must be a direction of a node");
   }
   // Checked also if dofs are fixed: a matrix whose rows are in another order resists rigid
   // motions.
   body.body();
   if (!elements.is_none())
   {
      const std::vector<NodalStiffness::Nodes> all = element_list(elements, nodes - 1);
      if (dimension == 3)
      {
         body.faces = outer_faces(all, [&body](int node) { return body.place(node); });
      }
      else { body.edges = outer_edges(all, body.places); }
   }
   if (!fixed.is_none())
   {
      const std::vector<int> held = indices(fixed, "fixed", 0, rows - 1);
      const std::set<int> sorted(held.begin(), held.end());
      body.fixed.assign(sorted.begin(), sorted.end());
   }
   for (const auto &[name, values] : by_names(loads, "loads"))
   {
      body.load_of(name, Control::force).values = vector(values, "loads['" + name + "']", rows);
   }
   for (const auto &[given, members] : by_names(sets, "sets"))
   {
      std::string name = given;
      const std::vector<int> found = indices(members, "sets['" + name + "']", 0, nodes - 1);
      for (char &letter : name)
      {
         letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
      }
      require(body.sets.emplace(name, found).second, "sets has '", name,
              "' twice, whatever its capitals");
   }
   body.validate();
}

void set_mass(NodalStiffness &body, nb::handle M)
{
   NodalStiffness::Matrix mass = sparse_matrix(M, "M");
   require(mass.rows() == body.K.rows(), "M has shape (", mass.rows(), ", ", mass.rows(),
           "), must be that of K, (", body.K.rows(), ", ", body.K.rows(), ")");
   const NodalStiffness::Matrix skew = mass - NodalStiffness::Matrix(mass.transpose());
   require(skew.norm() <= 1e-10 * mass.norm(), "M is not symmetric, must be");
   body.M = std::move(mass);
}

nb::object sparse(const NodalStiffness::Matrix &K)
{
   const Index rows = K.rows(), entries = K.nonZeros();
   return nb::module_::import_("scipy.sparse")
      .attr("csr_array")(
         nb::make_tuple(array(Eigen::VectorXd(K.coeffs())),
                        array<Integers>(Eigen::VectorXi(
                           Eigen::Map<const Eigen::VectorXi>(K.innerIndexPtr(), entries))),
                        array<Integers>(Eigen::VectorXi(
                           Eigen::Map<const Eigen::VectorXi>(K.outerIndexPtr(), rows + 1)))),
         nb::arg("shape") = nb::make_tuple(rows, rows));
}

nb::list line_chains(const ContactLine &line)
{
   nb::list all;
   for (const LineChain &chain : line.chains)
   {
      nb::dict each;
      each["first"] = chain.first;
      each["nodes"] = chain.nodes;
      each["loop"] = chain.loop;
      each["ends"] = nb::make_tuple(word(chain.ends[0]), word(chain.ends[1]));
      all.append(each);
   }
   return all;
}

std::string brief(const NodalStiffness &body)
{
   std::ostringstream text;
   text << "<NodalStiffness '" << body.name << "': " << name(body.formulation) << ", "
        << body.places.size() << " nodes, " << body.K.rows() << " rows, " << body.fixed.size()
        << " fixed";
   if (body.supports_left_out) { text << ", supports left out by its program"; }
   text << ", loads:";
   for (const BodyLoad &load : body.loads) { text << " " << load.name; }
   if (body.loads.empty()) { text << " none"; }
   text << ", sets:";
   for (const auto &[set, nodes] : body.sets)
   {
      text << " " << set << " (" << nodes.size() << ")";
   }
   if (body.sets.empty()) { text << " none"; }
   text << (body.edges.empty() && body.faces.empty() ? ", no elements known>" : ">");
   return text.str();
}

void bind_stiffness(nb::module_ &m)
{
   using Self = NodalStiffness;
   nb::class_<Self>(
      m, "NodalStiffness",
      "The stiffness of one elastic body or several, with supports and loads, of any "
      "program.\n\n"
      "Forces are per unit thickness in the plane, of the whole circumference about an axis. "
      "Arguments for nodes are the name of a set, numbers of nodes, or a mask over `nodes`. A "
      "direction is 'x', 'y' or 'xy', about an axis 'r', 'z' or 'rz'.")
      .def(
         "__init__",
         [](Self *self, Matrix K, Numbers places, Numbers dofs, Numbers elements,
            const std::string &formulation, Numbers fixed, const NamedNumbers &loads,
            const NamedNumbers &sets, bool supports_left_out, const std::string &name, Matrix M)
         {
            Self body;
            body.name = name;
            body.formulation = chosen<Formulation>(formulation, "formulation");
            require(body.formulation != Formulation::torsion, "formulation is '", formulation,
                    "', must be one of 'plane', 'axisymmetric'");
            body.supports_left_out = supports_left_out;
            body.K = sparse_matrix(K, "K");
            try
            {
               fill(body, places, dofs, elements, fixed, loads, sets);
               if (!M.is_none()) { set_mass(body, M); }
            }
            catch (const InputError &error)
            {
               const nb::object type = nb::getattr(K, "dtype", nb::str(""));
               const std::string kind = nb::str(type).c_str();
               if (kind != "float32" && kind != "float16") { throw; }
               throw InputError(std::string(error.what()) + " (K is " + kind + ", of " +
                                (kind == "float32" ? "7" : "3") +
                                " digits: assemble it in float64)");
            }
            new (self) Self(std::move(body));
         },
         arg("K"), arg("places"), arg("dofs") = nb::none(), arg("elements") = nb::none(),
         nb::kw_only(), arg("formulation") = "plane", arg("fixed") = nb::none(),
         arg("loads") = nb::dict(), arg("sets") = nb::dict(), arg("supports_left_out") = false,
         arg("name") = "body", arg("M") = nb::none(),
         "K: symmetric, of all rows, supported ones among them, not eliminated (n rows).\n"
         "places: (nodes, 2), x and y (r and z) of node 0, 1, …; (nodes, 3) of a body in "
         "space.\n"
         "dofs: (nodes, 2), rows of K of each node's two directions, -1: none. Left out: rows "
         "2 i and 2 i + 1 are those of node i. In space (nodes, 3).\n"
         "formulation: 'plane', or 'axisymmetric', where x is r and K is of the whole "
         "circumference.\n"
         "elements: (elements, 3, 4, 6, 7, 8 or 9) nodes, corners in order around it, then the "
         "middles of the sides; a list of such arrays if there are several kinds. They tell "
         "outer edges, so that contact_line() takes nodes in any order. In space (elements, 4, "
         "5, 6 or 8) corners of tetrahedra, pyramids, wedges and hexahedra, of order 2 with "
         "the "
         "middles after the corners in any order (10, 13, 14, 15, 18, 20 or 27), for "
         "contact_surface().\n"
         "fixed: rows that are held. loads: forces on all rows by name. sets: nodes by name. "
         "name: name of the body in messages.\n"
         "supports_left_out: K resists motions that nothing here holds (springs to the ground, "
         "supports whose rows are gone). Rows that hold nothing but their diagonal, or "
         "nothing, "
         "are supports that were eliminated: they are fixed, which condense() warns of.\n"
         "M: the mass, symmetric, with the rows of K, in units in which M times an "
         "acceleration "
         "is a force.")
      .def_rw("name", &Self::name)
      .def_prop_ro("formulation", [](const Self &self) { return word(self.formulation); })
      .def_prop_ro(
         "K", [](const Self &self) { return sparse(self.K); },
         nb::sig("def K(self) -> scipy.sparse.csr_array"), "a copy")
      .def_prop_rw(
         "M", [](const Self &self) { return sparse(self.M); },
         [](Self &self, const Matrix &M) { set_mass(self, M); },
         nb::for_getter(nb::sig("def M(self) -> scipy.sparse.csr_array")),
         nb::for_setter(arg("M")), "the mass, a copy; without rows if it is not known")
      .def_prop_ro(
         "nodes", [](const Self &self) { return array_of_indices(node_numbers(self)); },
         "numbers of the nodes, increasing")
      .def_prop_ro(
         "places",
         [](const Self &self)
         {
            Eigen::MatrixXd all(self.places.size(), dimension(self.formulation));
            Index k = 0;
            for (const auto &[node, place] : self.places)
            {
               all.row(k++) = self.place(node).head(all.cols());
            }
            return array(std::move(all));
         },
         "(nodes, 2), in space (nodes, 3), in the order of `nodes`")
      .def_prop_ro(
         "dofs",
         [](const Self &self)
         {
            std::map<int, Index> at;
            for (const auto &[node, place] : self.places) { at.emplace(node, at.size()); }
            Eigen::MatrixXi rows =
               Eigen::MatrixXi::Constant(at.size(), components(self.formulation), -1);
            for (std::size_t row = 0; row < self.dofs.size(); ++row)
            {
               rows(at.at(self.dofs[row].node), self.dofs[row].direction - 1) =
                  static_cast<int>(row);
            }
            return array<Integers>(std::move(rows));
         },
         "(nodes, 2), in space (nodes, 3), rows of each node's directions in the order of "
         "`nodes`, -1: none")
      .def_prop_ro(
         "sets",
         [](const Self &self)
         {
            nb::dict all;
            for (const auto &[set, nodes] : self.sets)
            {
               all[nb::cast(set)] = array_of_indices(nodes);
            }
            return all;
         },
         nb::sig("def sets(self) -> dict[str, numpy.typing.NDArray[numpy.intc]]"),
         "numbers of nodes by the name of the set, in capitals")
      .def_prop_ro(
         "fixed", [](const Self &self) { return array_of_indices(self.fixed); },
         "rows that are held")
      .def_rw(
         "supports_left_out", &Self::supports_left_out,
         "K resists motions that nothing here holds: springs to the ground, supports whose "
         "rows are gone or hold nothing but their diagonal")
      .def_prop_ro(
         "loads",
         [](const Self &self)
         {
            nb::dict all;
            for (const BodyLoad &load : self.loads)
            {
               all[nb::cast(load.name)] = array(load.values);
            }
            return all;
         },
         nb::sig("def loads(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
         "values on all rows by the name of the load: forces, or prescribed displacements")
      .def(
         "nodes_of",
         [](const Self &self, const std::string &set)
         { return array_of_indices(self.nodes_of(set)); },
         arg("set"), "Numbers of the nodes of a set, by its name (capitals do not matter).")
      .def(
         "fix",
         [](Self &self, Nodes nodes, const std::string &direction)
         {
            const NodalStiffness::Nodes at = nodes_in(self, nodes);
            for (int d : directions(self, direction)) { self.fix(at, d); }
         },
         arg("nodes"), arg("direction"),
         "Holds nodes along a direction.\n\n"
         "nodes: the name of a set, numbers of nodes, or a mask over `nodes`.\n"
         "direction: 'x', 'y' or 'xy', about an axis 'r', 'z' or 'rz'.")
      .def(
         "add_forces",
         [](Self &self, const std::string &load, Nodes nodes, const std::string &direction,
            double force)
         {
            const NodalStiffness::Nodes at = nodes_in(self, nodes);
            finite(force, "force");
            for (int d : directions(self, direction))
            {
               self.add_forces(load_name(load), at, d, force);
            }
         },
         arg("load"), arg("nodes"), arg("direction"), arg("force"),
         "Adds a force at each node, per unit multiplier, to a load. The load may be a new "
         "one.\n\nload: its name. nodes: the name of a set, numbers of nodes, or a mask over "
         "`nodes`. direction: 'x', 'y' or 'xy', about an axis 'r', 'z' or 'rz'. force: on each "
         "node in this direction. About an axis it is the force on the whole "
         "circumference.")
      .def(
         "add_displacement",
         [](Self &self, const std::string &load, Nodes nodes, const std::string &direction,
            double value)
         {
            const NodalStiffness::Nodes at = nodes_in(self, nodes);
            finite(value, "value");
            for (int d : directions(self, direction))
            {
               self.add_displacement(load_name(load), at, d, value);
            }
         },
         arg("load"), arg("nodes"), arg("direction"), arg("value"),
         "Moves nodes by a value per unit multiplier of a load, and fixes them.\n\n"
         "load: its name; a load has forces or displacements. nodes: the name of a set, "
         "numbers "
         "of nodes, or a mask over `nodes`. direction: 'x', 'y' or 'xy', about an axis 'r', "
         "'z' or 'rz'. value: the displacement along it.")
      .def(
         "add_traction",
         [](Self &self, const std::string &load, Nodes nodes, Numbers traction, int order)
         {
            if (self.formulation == Formulation::space)
            {
               self.add_surface_traction(load_name(load), nodes_in(self, nodes),
                                         vector(traction, "traction", 3));
               return;
            }
            self.add_traction(load_name(load), nodes_in(self, nodes),
                              vector(traction, "traction", 2), within(order, "order", 0, 8));
         },
         arg("load"), arg("nodes"), arg("traction"), arg("order") = 0,
         "Adds a force per length, about an axis and in space per area, to a load.\n\n"
         "load: its name. nodes: of the part of the boundary, as contact_line() takes them. "
         "traction: (x, y), about an axis (r, z), in space (x, y, z), per unit multiplier. "
         "order: as "
         "contact_line() has it.")
      .def(
         "add_supports",
         [](Self &self, const Statements &supports)
         { add_supports(self, "supports", in_words(supports, "supports")); },
         arg("supports"),
         "supports: in words, as in case files, \"FLOOR:y WALL:xy\": sets and the directions "
         "that are held. Or a list of these.")
      .def(
         "add_loads",
         [](Self &self, const Statements &loads)
         { add_loads(self, "loads", in_words(loads, "loads")); },
         arg("loads"),
         "loads: in words, as in case files, \"P traction TOP 0 -1; P force TIP 0 -1; D "
         "displacement-x END 0.01\": load, kind, set, values. Or a list of these.")
      .def("parts", &Self::parts,
           "The separate bodies, each with the name of a set that contains all of its nodes.")
      .def(
         "contact_line",
         [](const Self &self, Nodes nodes, int order)
         { return self.contact_line(nodes_in(self, nodes), within(order, "order", 0, 8)); },
         arg("nodes"), arg("order") = 0,
         "The trace of the body on nodes: the name of a set, numbers of nodes, or a mask over "
         "`nodes`.\n\norder 0: on outer edges all of whose nodes are "
         "among the given ones, in any order. order 1 to 8, if no elements are known: nodes in "
         "order, the body on their left, elements of that order through them.")
      .def(
         "contact_surface",
         [](const Self &self, Nodes nodes)
         {
            const nb::object numpy = nb::module_::import_("numpy");
            if (nb::isinstance<nb::str>(nodes) || integer(numpy.attr("ndim")(nodes)) != 2)
            {
               return self.contact_surface(nodes_in(self, nodes));
            }
            return self.contact_surface(element_list(nodes, most_rows));
         },
         arg("nodes"),
         "The trace of a body in space.\n\n"
         "nodes: the name of a set, numbers of nodes, or a mask over `nodes`: all outer faces "
         "of elements whose nodes are among them. Where no elements are known it is an array "
         "of the faces themselves, a row each. These have 3 or 4 corners, which come first. "
         "With 6, 8 or 9 nodes the middles of edges and faces follow. With 10 or 16 nodes two "
         "of each edge follow, at its thirds, and then those inside.")
      .def("__repr__", &brief);

   m.def(
      "read_stiffness",
      [](File matrix, File places, File mass)
      {
         const std::string name = file(matrix, "matrix");
         std::string at = places.is_none() ? std::string() : file(places, "places");
         const auto with_mass = [&](NodalStiffness made)
         {
            const bool deck = std::filesystem::path(at).extension() == ".inp";
            if (!mass.is_none()) { read_mass(made, file(mass, "mass"), deck ? at : ""); }
            return made;
         };
         const nb::object plain = nb::module_::import_("cattaneo._files").attr("plain")(name);
         if (plain.is_none()) { return with_mass(read_stiffness(name, at)); }
         if (at.empty() && !nb::cast<bool>(plain[2]))
         {
            at = std::filesystem::path(name).replace_extension(".dofs").string();
         }
         NodalStiffness result = read_stiffness(nb::cast<std::string>(plain[1]), at);
         result.name = name;
         return with_mass(std::move(result));
      },
      arg("matrix"), arg("places") = nb::none(), arg("mass") = nb::none(),
      "Reads a stiffness.\n\n"
      "matrix: a file of CalculiX (.sti), ABAQUS (.mtx), MATLAB (.mat with K, by SciPy) or a "
      "script (.mtx, .npy, .npz with .dofs; .npz of write_npz).\n"
      "places: the file with the places of nodes, an .inp or .dofs, if it is not beside the "
      "matrix with the same name.\n"
      "mass: the file with the mass of the same rows, which becomes `M`: of CalculiX (.mas), "
      "of "
      "ABAQUS (*MATRIX GENERATE, MASS), MatrixMarket (.mtx), .npy or .npz. A .mas has its deck "
      "in places, beside it with its name, or beside the matrix. Each row that is not fixed "
      "and "
      "has a stiffness must have a mass.");
   m.def(
      "nodal_stiffness", [](CondensedBody &body) { return nodal_stiffness(body); }, arg("body"),
      "The stiffness of a condensed body on its contact nodes, for another program.");
   m.def(
      "write_abaqus",
      [](File name, const Self &stiffness) { write_abaqus(file(name), stiffness); },
      arg("file"), arg("stiffness"),
      "Writes a stiffness for ABAQUS. file: an .mtx, with *USER ELEMENT; an .inp is written "
      "beside it.");
   m.def(
      "write_matrix_market",
      [](File name, const Self &stiffness) { write_matrix_market(file(name), stiffness); },
      arg("file"), arg("stiffness"),
      "Writes a stiffness as MatrixMarket. file: an .mtx; the .dofs that read_stiffness() "
      "needs is written beside it.");
   m.def(
      "write_nastran",
      [](File name, const Self &stiffness) { write_nastran(file(name), stiffness); },
      arg("file"), arg("stiffness"),
      "Writes a stiffness for Nastran. file: bulk data with DMIG KAAX, GRID, SPC1 and FORCE, "
      "to "
      "10 or 11 digits.");
}

void bind_lines(nb::module_ &m)
{
   using Self = ContactLine;
   nb::class_<Self>(
      m, "ContactLine",
      "The trace of a body on an interface: its contact nodes, in order with the body on the "
      "left, and the boundary elements between them.")
      .def("__len__", &Self::size)
      .def_prop_ro("formulation", [](const Self &self) { return word(self.formulation); })
      .def_prop_ro(
         "positions",
         [](const Self &self)
         { return array(Eigen::MatrixXd(self.each(&LineNode::position))); },
         "(n, 2)")
      .def_prop_rw(
         "tangents",
         [](const Self &self) { return array(Eigen::MatrixXd(self.each(&LineNode::tangent))); },
         [](Self &self, Numbers tangents)
         {
            const Eigen::MatrixXd all = matrix(tangents, "tangents", self.size(), 2);
            for (Index i = 0; i < self.size(); ++i)
            {
               require(std::abs(all.row(i).norm() - 1) < 1e-9, "tangents[", i, "] has length ",
                       all.row(i).norm(), ", must be a unit vector");
               self.nodes[i].tangent = all.row(i);
            }
         },
         nb::for_setter(arg("tangents")),
         "(n, 2), unit vectors along the line, the body on their left; a copy, to be set as a "
         "whole")
      .def_prop_ro(
         "normals",
         [](const Self &self) { return array(Eigen::MatrixXd(self.each(&LineNode::normal))); },
         "(n, 2), into the body")
      .def_prop_ro(
         "weights",
         [](const Self &self) { return array(Eigen::VectorXd(self.each(&LineNode::weight))); },
         "consistent: they sum to the length; about an axis to the area")
      .def_prop_ro("arc_length", [](const Self &self)
                   { return array(Eigen::VectorXd(self.each(&LineNode::arc_length))); })
      .def_prop_ro(
         "dofs",
         [](const Self &self)
         {
            Eigen::MatrixXi all(self.size(), 2);
            for (Index i = 0; i < self.size(); ++i)
            {
               all.row(i) << self.nodes[i].dofs[0], self.nodes[i].dofs[1];
            }
            return array<Integers>(std::move(all));
         },
         "(n, 2), rows of the stiffness")
      .def_rw(
         "as_meshed", &Self::as_meshed,
         "gaps are those of the edges as they are; else straight edges whose ends lie as on a "
         "smooth curve are taken for chords of it")
      .def_prop_ro("chains", &line_chains,
                   nb::sig("def chains(self) -> list[dict[str, typing.Any]]"),
                   "runs of consecutive nodes: first, nodes (their number), loop, and ends "
                   "(how the boundary continues at each end)")
      .def("__repr__",
           [](const Self &self)
           {
              double length = 0;
              for (const LineNode &node : self.nodes) { length += node.weight; }
              return "<ContactLine: " + std::to_string(self.size()) + " nodes in " +
                     std::to_string(self.chains.size()) +
                     (self.chains.size() == 1 ? " chain, " : " chains, ") +
                     (self.formulation == Formulation::plane ? "length " : "area ") +
                     exact_text(length) + ">";
           });

   m.def(
      "joined", [](const std::vector<Self> &lines) { return joined(lines); }, arg("lines"),
      "The trace of a body with several interfaces, for one condensation: all nodes of the "
      "lines, one line after the other, each once.");
   m.def(
      "straight_line",
      [](Numbers grid, int order, const std::string &formulation)
      {
         const Eigen::VectorXd ends = vector(grid, "grid");
         return straight_line({ends.data(), ends.data() + ends.size()},
                              within(order, "order", 1, 8),
                              chosen<Formulation>(formulation, "formulation"));
      },
      arg("grid"), arg("order") = 1, arg("formulation") = "plane",
      "The trace of a body above y = 0 without a mesh.\n\n"
      "grid: x (r about an axis) where elements end, increasing. order: of the elements, 1 to "
      "8. formulation: 'plane', 'axisymmetric' or 'torsion'.");
}

void bind_surfaces(nb::module_ &m)
{
   using Self = ContactSurface;
   m.def(
      "joined", [](const std::vector<Self> &surfaces) { return joined(surfaces); },
      arg("surfaces"),
      "The trace of a body in space with several interfaces, for one "
      "condensation.\n\nsurfaces: of contact_surface(); nodes and faces of all, each node "
      "once.");
   nb::class_<Self>(
      m, "ContactSurface",
      "The trace of a body in space: its contact nodes and the faces between them.\n\nOn "
      "faces of 6 and 8 nodes displacements, gaps and forces are those of unknowns. These have "
      "positive weights: N + 1/5 of the middles of adjacent edges at corners, 3/5 N at "
      "middles. "
      "at_nodes() and forces_at_nodes() convert them to those of the nodes.")
      .def("__len__", &Self::size)
      .def(
         "at_nodes",
         [](const Self &self, Numbers values)
         { return array(self.at_nodes(matrix(values, "values", self.size(), -1))); },
         arg("values"),
         "values: (n, k) of the unknowns, displacements for instance. Returns those of the "
         "nodes.")
      .def(
         "of_nodes",
         [](const Self &self, Numbers values)
         { return array(self.of_nodes(matrix(values, "values", self.size(), -1))); },
         arg("values"), "The inverse of at_nodes(). values: (n, k) of the nodes.")
      .def(
         "forces_at_nodes",
         [](const Self &self, Numbers forces)
         { return array(self.forces_at_nodes(matrix(forces, "forces", self.size(), -1))); },
         arg("forces"),
         "forces: (n, k) on the unknowns. Returns those on the nodes that do the same work.")
      .def_prop_ro(
         "positions", [](const Self &self) { return array(Eigen::MatrixXd(self.positions())); },
         "(n, 3)")
      .def_prop_ro(
         "frames",
         [](const Self &self)
         {
            Eigen::MatrixXd all(self.size(), 9);
            for (Index i = 0; i < self.size(); ++i)
            {
               const Eigen::Matrix3d &frame = self.nodes[i].frame;
               all.row(i) << frame.row(0), frame.row(1), frame.row(2);
            }
            return array(std::move(all));
         },
         "(n, 9): first tangent, second tangent, normal into the body of each node")
      .def_prop_ro(
         "normals",
         [](const Self &self)
         {
            Eigen::MatrixXd all(self.size(), 3);
            for (Index i = 0; i < self.size(); ++i) { all.row(i) = self.nodes[i].normal(); }
            return array(std::move(all));
         },
         "(n, 3), into the body")
      .def_prop_ro(
         "weights", [](const Self &self) { return array(self.weights()); },
         "of the unknowns, consistent: they sum to the area")
      .def_prop_ro(
         "dofs",
         [](const Self &self)
         {
            Eigen::MatrixXi all(self.size(), 3);
            for (Index i = 0; i < self.size(); ++i)
            {
               const std::array<int, 3> &own = self.nodes[i].dofs;
               all.row(i) << own[0], own[1], own[2];
            }
            return array<Integers>(std::move(all));
         },
         "(n, 3), rows of the stiffness")
      .def_prop_ro(
         "faces",
         [](const Self &self)
         {
            std::vector<std::vector<int>> all;
            for (const auto &face : self.faces) { all.emplace_back(face.begin(), face.end()); }
            return all;
         },
         "numbers of the nodes of each face: three or four corners in their order around it, "
         "then those of the edges and inside, if it has them")
      .def("__repr__",
           [](const Self &self)
           {
              return "<ContactSurface: " + std::to_string(self.size()) + " nodes, " +
                     std::to_string(self.faces.size()) + " faces, area " +
                     exact_text(self.weights().sum()) + ">";
           });
}

void bind_condensed(nb::module_ &m)
{
   using Self = CondensedBody;
   nb::class_<Self>(m, "CondensedBody",
                    "A body reduced to its contact nodes: f = S u + sum of multiplier × load, "
                    "with u = {v; w} and f = {q; p} in the frames of its contact line.")
      .def_rw("name", &Self::name, "name of the body in messages")
      .def_prop_ro(
         "line", [](const Self &self) { return self.line; }, "a copy; without nodes in space")
      .def_prop_ro(
         "surface", [](const Self &self) { return self.surface; },
         "a copy; it has nodes only in space")
      .def_prop_ro("S", viewed(&Self::S), "(2 n, 2 n), in space (3 n, 3 n), symmetric")
      .def_prop_ro("H", viewed(&Self::H), "loads by loads with the contact clamped")
      .def_prop_ro(
         "held", [](const Self &self) { return array_of_indices(self.held); },
         "rows of S that supports hold")
      .def_prop_ro(
         "moved", viewed(&Self::moved),
         "(2 n, loads): displacements {x; y} of contact nodes that loads move, per unit "
         "multiplier; empty if none is")
      .def_ro("thickness", &Self::thickness,
              "thickness for which all forces are, 1 unless thicken() is called")
      .def("thicken", &Self::thicken, arg("times"),
           "Multiplies the thickness of a plane body, and with it S, H and the forces of its "
           "loads. Pressures are over the area of the thinner "
           "one of two bodies.\n"
           "times: > 0, of a plane body.")
      .def_ro("rigid_modes", &Self::rigid_modes, "rigid motions that are free")
      .def_ro("counters", &Self::counters)
      .def(
         "recover",
         [](Self &self, Numbers u, Numbers multipliers)
         {
            return array(self.recover(
               vector(u, "u", self.S.rows()),
               vector(multipliers, "multipliers", static_cast<Index>(self.patterns.size()))));
         },
         arg("u"), arg("multipliers"),
         "Displacements of all rows of the stiffness. u: {v; w} of the contact nodes of this "
         "body, (2 n,). multipliers: of its loads, in their order.")
      .def("error_estimate", &Self::error_estimate,
           "Relative error of S from round-off, an upper estimate. Costs a few solves.")
      .def("__repr__",
           [](const Self &self)
           {
              std::string loads;
              for (const LoadPattern &each : self.patterns) { loads += " " + each.name; }
              return "<CondensedBody '" + self.name + "': " + std::to_string(self.nodes()) +
                     " contact nodes, " + std::to_string(self.rigid_modes) +
                     " free rigid motions, loads:" + (loads.empty() ? " none" : loads) + ">";
           });
}

} // namespace

void bind_bodies(nb::module_ &m)
{
   bind_stiffness(m);
   bind_lines(m);
   bind_surfaces(m);
   bind_condensed(m);
}

} // namespace cattaneo::python
