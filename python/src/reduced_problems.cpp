#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include "words.hpp"
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/wear/wear_march.hpp>
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// The reduced problem, a contact problem as plain data.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(Sparse,
                  "numpy.typing.ArrayLike | scipy.sparse.sparray | scipy.sparse.spmatrix",
                  anything);

using Self = ReducedProblem;

/// No rows: there is no such matrix.
Eigen::MatrixXd mass(nb::object M)
{
   if (nb::hasattr(M, "toarray")) { M = M.attr("toarray")(); } // a sparse matrix of SciPy
   return M.is_none() ? Eigen::MatrixXd() : matrix(M, "M");
}

ReducedProblem made_by_hand(nb::handle A, nb::handle B, nb::handle C,
                            const std::vector<LoadPattern> &patterns, nb::handle gap,
                            nb::handle friction, nb::handle weights, nb::handle arc_length,
                            nb::handle position, nb::handle H, nb::handle rigid_motions)
{
   ReducedProblem problem;
   const Eigen::MatrixXd normal = matrix(C, "C");
   const Index n = normal.rows();
   require(n > 0 && normal.cols() == n, "C has shape (", n, ", ", normal.cols(),
           "), must be square with a row per node");
   const Eigen::MatrixXd tangential = matrix(A, "A");
   const Index slips = tangential.rows();
   require(tangential.cols() == slips && slips <= 2 * n && slips % n == 0, "A has shape (",
           slips, ", ", tangential.cols(),
           "), must be square with 0, 1 or 2 rows per node, of ", n, " nodes");
   for (const LoadPattern &pattern : patterns)
   {
      require(pattern.q.size() == slips && pattern.p.size() == n, "patterns[",
              problem.patterns.size(), "] has ", pattern.q.size(), " tangential and ",
              pattern.p.size(), " normal forces, must have ", slips, " and ", n);
      problem.patterns.push_back(pattern);
   }
   problem.gap = vector_or_number(gap, "gap", n);
   problem.friction = vector_or_number(friction, "friction", n);
   if (!weights.is_none()) { problem.weights = vector_or_number(weights, "weights", n); }
   if (!position.is_none()) { problem.position = matrix(position, "position", n); }
   if (!arc_length.is_none())
   {
      problem.arc_length = vector(arc_length, "arc_length", n);
      for (Index i = 1; i < n; ++i)
      {
         require(problem.arc_length[i] > problem.arc_length[i - 1], "arc_length[", i, "] is ",
                 problem.arc_length[i], ", must be larger than the one before, ",
                 problem.arc_length[i - 1]);
      }
      problem.chains = one_chain(n);
   }
   if (!H.is_none())
   {
      const auto count = static_cast<Index>(problem.patterns.size());
      problem.H = matrix(H, "H", count, count);
   }
   // Read by rows and columns, so that a matrix with only one triangle is noticed.
   for (const auto &[name, block] :
        {std::pair<const char *, const Eigen::MatrixXd &>("A", tangential), {"C", normal}})
   {
      Index i = 0, j = 0;
      if (block.size() == 0) { continue; }
      const double skew = (block - block.transpose()).cwiseAbs().maxCoeff(&i, &j);
      require(skew <= 1e-10 * block.cwiseAbs().maxCoeff(), name, "[", i, ", ", j, "] is ",
              block(i, j), " and ", name, "[", j, ", ", i, "] is ", block(j, i),
              ", must be equal");
   }
   const Eigen::MatrixXd coupling = matrix(B, "B", n, slips);
   if (rigid_motions.is_none()) { problem.set_stiffness(tangential, coupling, normal); }
   else
   {
      problem.set_stiffness(tangential, coupling, normal, {});
      complete(problem, matrix(rigid_motions, "rigid_motions", slips + n));
      require_semidefinite(problem);
   }
   problem.validate();
   return problem;
}

nb::list chains(const Self &self)
{
   const auto both = [&](const std::array<LineEnd, 2> &of)
   { return nb::make_tuple(word(of[0]), word(of[1])); };
   nb::list all;
   for (const ContactChain &chain : self.chains)
   {
      nb::dict each;
      each["interface"] = chain.interface;
      each["first"] = chain.first;
      each["nodes"] = chain.nodes;
      each["loop"] = chain.loop;
      each["ends"] = both(chain.ends);
      each["other_ends"] = both(chain.other_ends);
      each["bodies"] = nb::make_tuple(chain.bodies[0], chain.bodies[1]);
      all.append(each);
   }
   return all;
}

std::string range(const Eigen::VectorXd &values)
{
   if (values.size() == 0) { return "not known"; }
   const double least = values.minCoeff(), most = values.maxCoeff();
   std::ostringstream text;
   text << least;
   if (most > least) { text << " to " << most; }
   return text.str();
}

std::string brief(const Self &self)
{
   std::ostringstream text;
   text << "<ReducedProblem: " << self.nodes() << " contact nodes";
   if (self.components() != 1)
   {
      text << " with " << self.components() << " tangential components";
   }
   text << (self.coupled ? ", coupled" : ", uncoupled") << ", friction " << range(self.friction)
        << ", gap " << range(self.gap);
   if (self.rigid_motions.cols() > 0)
   {
      text << ", " << self.rigid_motions.cols() << " free rigid motions";
   }
   text << ", loads:";
   for (const LoadPattern &each : self.patterns)
   {
      text << " " << each.name
           << (each.control == Control::displacement ? " (displacement)" : "");
   }
   text << (self.patterns.empty() ? " none>" : ">");
   return text.str();
}

/// Sets n numbers in place, so that views of them stay valid.
void set_numbers(Eigen::VectorXd &to, nb::handle values, const char *what, Index n)
{
   const Eigen::VectorXd all = vector_or_number(values, what, n);
   for (Index i = 0; i < n; ++i)
   {
      require(all[i] >= 0 || std::string(what) != "friction", what, "[", i, "] is ", all[i],
              ", must not be negative");
      require(all[i] > 0 || std::string(what) != "weights", what, "[", i, "] is ", all[i],
              ", must be positive");
   }
   if (to.size() != n) { to.resize(n); }
   to.noalias() = all;
}

} // namespace

void bind_reduced_problems(nb::module_ &m)
{
   nb::class_<LoadPattern>(
      m, "LoadPattern",
      "Contact forces by a load, per unit multiplier, with the contact nodes clamped.")
      .def(
         "__init__",
         [](LoadPattern *self, const std::string &name, Numbers q, Numbers p,
            const std::string &control)
         {
            LoadPattern pattern{name, chosen<Control>(control, "control"), vector(q, "q"),
                                vector(p, "p")};
            require(!pattern.name.empty(), "name is '', a load must have one");
            new (self) LoadPattern(std::move(pattern));
         },
         arg("name"), arg("q"), arg("p"), arg("control") = "force",
         "name: name of the load. q: tangential forces of all nodes, (c n,), with the nodes "
         "clamped, per unit multiplier. p: normal ones, (n,), compression positive. control: "
         "'force', or 'displacement' if the multiplier prescribes a displacement.")
      .def_ro("name", &LoadPattern::name)
      .def_prop_ro("control", [](const LoadPattern &self)
                   { return self.control == Control::force ? "force" : "displacement"; })
      .def_prop_ro("q", viewed(&LoadPattern::q), "tangential, size c n")
      .def_prop_ro("p", viewed(&LoadPattern::p), "normal, compression positive, size n")
      .def_prop_ro(
         "size",
         [](const LoadPattern &self) -> nb::object
         {
            const LoadSize &size = self.size;
            if (size.kind.empty()) { return nb::none(); }
            nb::dict made;
            made["kind"] = size.kind;
            made["value"] = size.value;
            made["direction"] = nb::make_tuple(size.direction[0], size.direction[1]);
            made["place"] = size.place;
            return std::move(made);
         },
         nb::sig("def size(self) -> dict[str, object] | None"),
         "How large the load is at multiplier 1, for results in physical units; None: not "
         "known.\n\n"
         "The entry 'kind' is 'force', 'moment', 'displacement', 'bolt' or another kind of the "
         "program contact. The entry 'value' is positive. A load of forces at multiplier m has "
         "the size m · value, and its displacement is conjugate / value. A prescribed "
         "displacement has the size m · value, and its reaction is conjugate / value. The "
         "entry "
         "'direction' is a unit vector, or (0, 0) if the load has none. The entry 'place' "
         "names "
         "the loaded part.")
      .def("__repr__",
           [](const LoadPattern &self)
           {
              std::ostringstream text;

              text << "<LoadPattern '" << self.name << "': a "
                   << (self.control == Control::force ? "force" : "displacement")
                   << ", tangential sum " << self.q.sum() << ", normal sum " << self.p.sum()
                   << ">";
              return text.str();
           });

   nb::class_<Self> problem(
      m, "ReducedProblem",
      "A frictional contact problem reduced to its n contact nodes:\n\n"
      "    q = A v + B^T w + sum of multiplier × q_k\n"
      "    p = B v + C  w + sum of multiplier × p_k\n\n"
      "v slip, w opening, q tangential and p normal nodal forces, compression positive. c "
      "tangential components per node: 1 in the plane, 2 with torsion, 0 without friction.");
   bind_copies(problem,
               "A copy whose friction and gap can be changed without those of this problem.");
   problem
      .def(
         "__init__",
         [](Self *self, Numbers A, Numbers B, Numbers C,
            const std::vector<LoadPattern> &patterns, Numbers gap, Numbers friction,
            Numbers weights, Numbers arc_length, Numbers position, Numbers H,
            Numbers rigid_motions)
         {
            new (self) Self(made_by_hand(A, B, C, patterns, gap, friction, weights, arc_length,
                                         position, H, rigid_motions));
         },
         arg("A"), arg("B"), arg("C"), arg("patterns"), nb::kw_only(), arg("gap") = 0.0,
         arg("friction") = 0.0, arg("weights") = nb::none(), arg("arc_length") = nb::none(),
         arg("position") = nb::none(), arg("H") = nb::none(), arg("rigid_motions") = nb::none(),
         "A problem made by hand: A (c n, c n), B (n, c n), C (n, n). patterns: its "
         "loads.\ngap and friction: a value for each node, or one number.\nweights: length or "
         "area of each node; tractions and laws of friction need them.\narc_length: "
         "increasing; with it the nodes follow each other on one line.\nposition: (n, 2), or "
         "(n, 3) for a surface in space.\nH: loads by loads, the displacements of forces "
         "(reactions of displacements) with clamped contact nodes; None: not known, conjugates "
         "are then only the contact's part.\nrigid_motions: (c n + n, k), all motions (v, w) "
         "that nothing resists, as columns; None: they are computed.")
      .def_prop_ro("nodes", &Self::nodes, "n")
      .def_prop_ro("components", &Self::components, "c")
      .def_prop_ro("K", viewed(&Self::K), "(c n + n, c n + n), the whole stiffness; no copy")
      .def_prop_ro(
         "A", [](const Self &self) { return view(self.A(), nb::find(self)); },
         "(c n, c n); no copy")
      .def_prop_ro(
         "B", [](const Self &self) { return view(self.B(), nb::find(self)); },
         "(n, c n); no copy")
      .def_prop_ro(
         "C", [](const Self &self) { return view(self.C(), nb::find(self)); },
         "(n, n); no copy")
      .def_ro("coupled", &Self::coupled, "is B not zero?")
      .def_prop_ro(
         "patterns", [](const Self &self) { return self.patterns; }, "copies")
      .def_prop_ro("loads", each_of(&Self::patterns, &LoadPattern::name),
                   "names of the load patterns")
      .def_prop_ro(
         "H", [](const Self &self) { return array(self.H); },
         "loads by loads with clamped contact; no rows: not known")
      .def_prop_rw(
         "gap", [](Self &self) { return view<double>(self.gap, nb::find(self)); },
         [](Self &self, Numbers gap) { set_numbers(self.gap, gap, "gap", self.nodes()); },
         nb::for_setter(arg("gap")),
         "gap of each node, which is closed if w + gap = 0; a number sets all of them")
      .def_prop_rw(
         "friction", [](Self &self) { return view<double>(self.friction, nb::find(self)); },
         [](Self &self, Numbers friction)
         {
            set_numbers(self.friction, friction, "friction", self.nodes());
            self.laws.clear();
         },
         nb::for_setter(arg("friction")),
         "Coulomb coefficient of each node; a number sets all of them. With another law it is "
         "the steepest slope of the law, and must not be changed in place")
      .def_prop_ro("laws",
                   each_of(&Self::laws, [](const FrictionLaw &law)
                           { return std::pair(array(law.forward), array(law.backward)); }),
                   "For each node points (p, bound) of nodal forces, for slip forward and "
                   "backward; empty: Coulomb's law")
      .def(
         "set_friction_law",
         [](Self &self, Numbers points, Numbers backward, Numbers nodes)
         {
            const Eigen::MatrixX2d forward = matrix(points, "points", -1, 2);
            FrictionLaw law{forward, forward};
            if (!backward.is_none()) { law.backward = matrix(backward, "backward", -1, 2); }
            std::vector<Index> chosen;
            if (!nodes.is_none())
            {
               const std::vector<int> all =
                  indices(nodes, "nodes", 0, static_cast<long>(self.nodes()) - 1);
               chosen.assign(all.begin(), all.end());
               require(!chosen.empty(), "nodes is empty, must name a node, or be None for all");
            }
            set_friction_law(self, law, chosen);
         },
         arg("points"), arg("backward") = nb::none(), arg("nodes") = nb::none(),
         "Sets a law of friction other than Coulomb's: a polyline from (0, 0) that goes "
         "straight on beyond its last point.\n\npoints: (pressure, shear strength), (k, 2), "
         "tractions. backward: "
         "the same for slip backward, if it differs. nodes: where it holds; None: at all "
         "nodes. [[1, f]] is Coulomb's law.")
      .def_prop_ro(
         "weights", [](const Self &self) { return array(self.weights); },
         "traction = force / weight")
      .def_prop_ro("arc_length", [](const Self &self) { return array(self.arc_length); })
      .def_prop_ro(
         "position", [](const Self &self) { return array(self.position); },
         "(n, 2), or (n, 3) of a surface in space")
      .def_prop_ro(
         "rim", [](const Self &self) { return array_of_indices(self.rim); },
         "nodes of a surface beyond which the bodies go on; contact there is cut off")
      .def_prop_ro(
         "dofs", [](const Self &self) { return array<Integers>(self.dofs); },
         "(n, 2 per body), rows of each node in each body's stiffness, -1: none")
      .def_prop_ro("chains", &chains,
                   nb::sig("def chains(self) -> list[dict[str, typing.Any]]"),
                   "runs of nodes that follow each other along a line")
      .def_prop_ro(
         "rigid_motions", [](const Self &self) { return array(self.rigid_motions); },
         "{v; w} that nothing resists, a column each")
      .def_prop_ro(
         "held", [](const Self &self) { return array_of_indices(self.held); },
         "rows of A at which v = 0")
      .def(
         "multipliers",
         [](const Self &self, const NamedLoads &loads)
         { return array(self.multipliers(loads)); },
         arg("loads"),
         "loads: multipliers by name. Returns them in the order of the patterns, with zero for "
         "loads that are not named")
      .def(
         "clamped_forces",
         [](const Self &self, const NamedLoads &loads)
         { return array(self.clamped_forces(self.multipliers(loads))); },
         arg("loads"), "{q; p} under loads (multipliers by name), with the nodes clamped")
      .def(
         "validate",
         [](const Self &self)
         {
            self.validate();
            require_semidefinite(self); // its arrays may be written to
         },
         "InputError unless sizes, symmetry, signs and definiteness are those of a contact "
         "problem.")
      .def("__repr__", &brief);

   m.def(
      "hold",
      [](Self &problem, Numbers rows)
      {
         const std::vector<int> held =
            indices(rows, "rows", 0, static_cast<long>(problem.slips()) - 1);
         hold(problem, {held.begin(), held.end()});
      },
      arg("problem"), arg("rows"), "Marks rows of A of a problem as held: v = 0 there.");
   m.def(
      "set_friction",
      [](Self &problem, double coefficient)
      { set_numbers(problem.friction, nb::cast(coefficient), "friction", problem.nodes()); },
      arg("problem"), arg("coefficient"),
      "Sets the same coefficient of friction at every node of a problem.");
   m.def("absorb_gap", &absorb_gap, arg("problem"),
         "The equivalent problem without a gap. Its load 'gap' must be held at 1.");

   m.def(
      "save", [](const Self &of, File name) { save(of, file(name)); }, arg("of"), arg("file"),
      "Writes a file, JSON from which all is restored to the last bit. of: a reduced problem, "
      "a ContactState or a WearState.");
   m.def(
      "save", [](const ContactState &of, File name) { save(of, file(name)); }, arg("of"),
      arg("file"));
   m.def(
      "save", [](const WearState &of, File name) { save(of, file(name)); }, arg("of"),
      arg("file"));
   m.def(
      "load_reduced_problem", [](File name) { return load_reduced_problem(file(name)); },
      arg("file"),
      "Reads a reduced problem from a file that save(), or a program with --save, wrote.");
   m.def(
      "write_npz",
      [](File name, const Self &of, Sparse M) { write_npz(file(name), of, mass(M)); },
      arg("file"), arg("of"), arg("M") = nb::none(),
      "Writes arrays for programs of joint dynamics to a file that ends with .npz. of: a "
      "reduced problem or a NodalStiffness, with K and loads. M: its mass matrix, of the same "
      "rows, dense or sparse.");

   m.def(
      "write_npz",
      [](File name, const NodalStiffness &of, Sparse M) { write_npz(file(name), of, mass(M)); },
      arg("file"), arg("of"), arg("M") = nb::none());

   nb::class_<CriticalFriction>(m, "CriticalFriction",
                                "Coefficients of friction at which the character of a contact "
                                "changes, independent of the loads.")
      .def_ro("node", &CriticalFriction::node,
              "with more friction the rate problem of the node with this value, taken alone, "
              "has several answers or none")
      .def_ro("weakest_node", &CriticalFriction::weakest_node)
      .def_ro("locking", &CriticalFriction::locking, "above it the contact can lock itself")
      .def_ro("unique_below", &CriticalFriction::unique_below,
              "with less friction there is at most one answer (proven)")
      .def("__repr__",
           [](const CriticalFriction &self)
           {
              std::ostringstream text;

              text << "<CriticalFriction: one answer below " << self.unique_below
                   << " (proven), node " << self.weakest_node << " alone has several above "
                   << self.node << ", locks itself above " << self.locking << ">";
              return text.str();
           });
   m.def(
      "critical_friction",
      [](const Self &problem)
      {
         const Self copy = problem;
         return unlocked([&] { return critical_friction(copy); });
      },
      arg("problem"),
      "The coefficients of friction at which the character of a problem's contact changes, by "
      "its stiffness alone.");
   m.def(
      "can_lock", [](const Self &problem) { return can_lock(problem); }, arg("problem"),
      "Can the contact of a problem lock itself with its present friction?");
}

} // namespace cattaneo::python
