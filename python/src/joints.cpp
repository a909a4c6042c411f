#include "ModalLoopSettings.hpp"
#include "arrays.hpp"
#include "marches.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/joints/modal_loop.hpp>
#include <cattaneo/joints/vibration.hpp>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Modes of joints, and their frequency and damping against amplitude.

namespace cattaneo::python
{

namespace
{

void bind_modes(nb::module_ &m)
{
   using Self = Modes;
   nb::class_<Self>(m, "Modes",
                    "The lowest modes of vibration of a joint whose closed nodes are glued.")
      .def_prop_ro("omega", viewed(&Self::omega),
                   "(modes,), circular frequencies, increasing, in radians per unit of time")
      .def_prop_ro(
         "shapes",
         [](const Self &self)
         {
            nb::list all;
            for (const std::vector<Eigen::VectorXd> &mode : self.shapes)
            {
               nb::list bodies;
               for (const Eigen::VectorXd &body : mode) { bodies.append(array(body)); }
               all.append(bodies);
            }
            return all;
         },
         nb::sig("def shapes(self) -> list[list[numpy.typing.NDArray[numpy.float64]]]"),
         "of each mode and each body: displacements of all rows of its stiffness, of unit "
         "modal mass over all bodies")
      .def_prop_ro("residuals", viewed(&Self::residuals),
                   "(modes,), ‖K φ - ω² M φ‖ / ‖K φ‖ on the rows that move")
      .def_prop_ro("effective_mass", viewed(&Self::effective_mass),
                   "(modes, components), mass that moves with the ground along each component")
      .def_ro("rigid", &Self::rigid, "motions that nothing resists; they are left out")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<Modes: omega";
              for (const double omega : self.omega) { text << " " << omega; }
              text << ", " << self.rigid << " rigid motions left out>";
              return text.str();
           });
}

/// Bodies with their masses.
std::vector<VibratingBody> vibrating(const std::vector<NodalStiffness> &bodies)
{
   std::vector<VibratingBody> all;
   for (const NodalStiffness &body : bodies)
   {
      require(body.M.rows() > 0, "body '", body.name,
              "' has no mass, must have one: its M, or the argument mass of read_stiffness()");
      all.push_back({body.body(), SharedMatrix(body.M)});
   }
   return all;
}

void bind_craig_bampton(nb::module_ &m)
{
   using Self = CraigBampton;
   nb::class_<Self>(
      m, "CraigBampton",
      "A joint for programs of dynamics: M ẍ + K x = F ℓ + forces of the contact. x has the "
      "relative displacements {v; w} that are not held, then amplitudes of modes with all of "
      "these at 0. K has no contact stiffness.")
      .def_prop_ro("K", viewed(&Self::K), "(n, n), symmetric")
      .def_prop_ro("M", viewed(&Self::M), "(n, n), symmetric")
      .def_prop_ro(
         "rows", [](const Self &self) { return array_of_indices(self.rows); },
         "rows of {v; w} of the problem, of the first coordinates")
      .def_prop_ro("omega", viewed(&Self::omega),
                   "circular frequencies of the modes, of the other coordinates; 0: motions "
                   "that nothing resists")
      .def_ro("loads", &Self::loads, "names of the loads of forces")
      .def_prop_ro("F", viewed(&Self::F), "(n, loads), forces per unit multiplier")
      .def_prop_ro("R", viewed(&Self::R), "(outputs, n), rows of displacements that are wanted")
      .def("__repr__",
           [](const Self &self)
           {
              return "<CraigBampton: " + std::to_string(self.rows.size()) +
                     " relative displacements, " + std::to_string(self.omega.size()) +
                     " modes>";
           });
}

void bind_structure(nb::module_ &m)
{
   using Self = VibratingStructure;
   nb::class_<Self>(
      m, "VibratingStructure",
      "The bodies of a joint with their masses, and how they vibrate about a state.")
      .def(
         "__init__",
         [](Self *self, Reduction &reduction, const std::vector<NodalStiffness> &bodies,
            const std::map<std::string, double> &shanks)
         {
            std::vector<Bolt> all;
            for (const auto &[load, stiffness] : shanks) { all.push_back({load, stiffness}); }
            new (self) Self(reduction, vibrating(bodies), all);
         },
         arg("reduction"), arg("bodies"), arg("shanks") = nb::dict(), nb::keep_alive<1, 2>(),
         "reduction: of these bodies. bodies: as they were condensed, in the same order, each "
         "with its mass `M`. shanks: stiffness of each bolt of add_shank() or BoltedJoint by "
         "the name of its load; the reduction is then BoltedJoint.tightened().\nInputError if "
         "a "
         "body has no mass, if bodies and shanks do not have the stiffness of the problem, as "
         "in another order, or if a mass is not symmetric, positive definite and the same "
         "along "
         "all axes.")
      .def_prop_ro("mass", &Self::mass, "of all bodies; in the plane per unit of thickness")
      .def(
         "modes",
         [](const Self &self, const ReducedProblem &problem, const ContactState &state,
            int count)
         {
            state.validate(problem);
            require(self.stiffness_of(problem),
                    "modes: the problem has another stiffness than the structure, must be that "
                    "of its reduction (of a BoltedJoint the problem of tightened())");
            if (!(state.p.maxCoeff() > 0))
            {
               warn("modes: no contact node of the state carries a force, so that none is "
                    "glued: a load must press the bodies together before");
            }
            const GluedRows glued = glued_rows(problem, state);
            return unlocked([&] { return self.modes(glued, count); });
         },
         arg("problem"), arg("state"), arg("count"),
         "The lowest modes about a state. Closed nodes with friction are glued, also those at "
         "the limit of friction. Closed nodes without friction slide. Open nodes are free, as "
         "are those that touch without a force: there is a warning if all do.\n\nproblem: of "
         "the reduction, with its friction. state: of this problem. count: number of modes, "
         "at least 1.\nInputError if the problem has another stiffness.")
      .def(
         "with_modes",
         [](const Self &self, const Modes &modes)
         { return unlocked([&] { return self.with_modes(modes); }); },
         arg("modes"),
         "The problem with one more load for each mode, 'mode 1', 'mode 2', …: the forces M φ. "
         "The conjugate of its multiplier α is the modal amplitude φᵀ M x.\n\nmodes: of "
         "modes().")
      .def(
         "with_modes",
         [](const Self &self, const Modes &modes, const ContactState &state)
         { return self.with_modes(modes, state); },
         arg("modes"), arg("state"),
         "The state in the problem with modes, whose multipliers are 0.")
      .def(
         "craig_bampton",
         [](const Self &self, int count, std::optional<double> most,
            const std::vector<std::pair<int, int>> &outputs)
         {
            std::vector<OutputDof> all;
            for (const auto &[body, dof] : outputs) { all.push_back({body, dof}); }
            const double limit = most ? *most : std::numeric_limits<double>::infinity();
            return unlocked([&] { return self.craig_bampton(count, limit, all); });
         },
         arg("count"), arg("most") = nb::none(), arg("outputs") = nb::tuple(),
         "The joint for programs of dynamics, by the method of Hurty, Craig and Bampton: the "
         "relative displacements of the contact, and modes with all of them held.\n\ncount: "
         "largest number of these modes, at least 1. most: largest circular frequency of them. "
         "outputs: (body, row of its stiffness) of displacements that are wanted.\nCosts two "
         "solves for each row of the contact.")
      .def("__repr__", [](const Self &self)
           { return "<VibratingStructure: mass " + exact_text(self.mass()) + ">"; });
   m.def(
      "nodes_at_limit",
      [](const ReducedProblem &problem, const ContactState &state)
      {
         state.validate(problem);
         return nodes_at_limit(problem, state);
      },
      arg("problem"), arg("state"),
      "Number of closed nodes with friction that stand at the limit of friction in a state. "
      "They are glued in modes, because the first reversal takes them away from the limit.");
}

void bind_loops(nb::module_ &m)
{
   using Self = ModalLoop;
   nb::class_<Self> loop(
      m, "ModalLoop",
      "A steady loop of one mode: the structure moves quasi-statically under the forces M φ, "
      "whose multiplier α swings between two opposite values until a cycle ends in the state "
      "in which it began. A loop that is not `steady` has no frequency and no damping. Only a "
      "loop that is `converged` as well has the size that was asked for.");
   bind_outcome(loop, [](const Self &self) -> const Self & { return self; });
   loop
      .def_ro(
         "steady", &Self::steady,
         "did the last cycle end as it began? True also of the largest loop before the joint "
         "slides, which is not `converged`")
      .def_ro("omega", &Self::omega,
              "circular frequency by the first harmonic, ω₁² = ∮ α cos θ dθ/(π q)")
      .def_ro("zeta", &Self::zeta, "damping ratio D/(2π ω₁² q²)")
      .def_ro("omega_secant", &Self::omega_secant, "by the secant, ω² = Δα/Δq")
      .def_ro("zeta_secant", &Self::zeta_secant, "D/(2π α q)")
      .def_ro("omega_error", &Self::omega_error,
              "estimate of the error of omega by increments, from half as many; 0 on an exact "
              "path")
      .def_ro("zeta_error", &Self::zeta_error, "likewise of zeta")
      .def_ro("amplitude", &Self::amplitude, "half of the range of the modal amplitude q")
      .def_ro("force", &Self::force, "half of the range of α")
      .def_ro("energy", &Self::energy, "½ force · amplitude")
      .def_ro("dissipation", &Self::dissipation, "D, lost by friction in the cycle")
      .def_ro("area", &Self::area, "∮ α dq by trapezoids")
      .def_prop_ro("node_dissipation", viewed(&Self::node_dissipation),
                   "(n,), lost at each node of the problem")
      .def_ro("cycles", &Self::cycle, "number of cycles until the loop was steady, or at most")
      .def_ro("change", &Self::change,
              "by how much the last cycle changed the state, over what moves in it")
      .def_ro("ratchet", &Self::ratchet,
              "largest displacement that each cycle adds while forces repeat; 0: none")
      .def_ro("sliding_force", &Self::sliding_force,
              "force beyond which nothing holds the joint; nan: it was not reached")
      .def_ro("omega_first", &Self::omega_first,
              "for comparison, by the secant of the first loading")
      .def_ro("zeta_masing", &Self::zeta_masing,
              "for comparison, by Masing's rule from the first loading")
      .def_prop_ro(
         "points",
         [](const Self &self)
         {
            Eigen::MatrixXd all(self.points.size(), 2);
            for (std::size_t k = 0; k < self.points.size(); ++k)
            {
               all.row(static_cast<Index>(k)) << self.points[k].amplitude, self.points[k].force;
            }
            return array(std::move(all));
         },
         "(points, 2), modal amplitude less that in the middle, and modal force, along the "
         "loop")
      .def_prop_ro(
         "peak", [](Self &self) -> ContactState & { return self.peak; },
         nb::rv_policy::reference_internal, "state at the largest force of the loop")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<ModalLoop: amplitude " << self.amplitude;
              if (self.steady)
              {
                 text << ", omega " << self.omega << ", zeta " << self.zeta << ", steady after "
                      << self.cycle << " cycles";
              }
              if (!self.message.empty()) { text << ", " << self.message; }
              text << ">";
              return text.str();
           });
   m.def(
      "modal_curve",
      [](const ReducedProblem &problem, const ContactState &state, const std::string &load,
         double omega, Numbers sizes, ModalLoopSettings settings, const ProgressLike &progress,
         const StopLike &stop, const nb::kwargs &members)
      {
         set_members(settings, members);
         state.validate(problem);
         const ReducedProblem copy = problem;
         const ContactState from = state;
         const Eigen::VectorXd all = vector(sizes, "sizes");
         Watch watch(progress, stop);
         settings.march.monitor = watch.monitor();
         const std::vector<ModalLoop> loops = unlocked(
            [&]
            {
               FrictionSolver solver(copy, settings.march.friction);
               return modal_curve(solver, copy, from, load, omega,
                                  {all.data(), all.data() + all.size()}, settings);
            });
         for (const ModalLoop &each : loops)
         {
            if (!each.message.empty())
            {
               warn("modal_curve: '" + load + "', amplitude " + exact_text(each.amplitude) +
                    ": " + each.message);
            }
         }
         return loops;
      },
      arg("problem"), arg("state"), arg("load"), arg("omega"), arg("sizes"), nb::kw_only(),
      arg("settings") = ModalLoopSettings(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "Steady loops of one mode with several sizes.\n\n"
      "problem: of with_modes(). state: about which it vibrates, of this problem, with a "
      "multiplier of the mode of 0. load: the mode's, 'mode 1' for instance. omega: its "
      "frequency without slip, Modes.omega. sizes: increasing, amplitudes or energies "
      "(settings.size). A size whose forces are round-off of those of the state is refused. "
      "Sizes at which the joint slides get the largest loop before that, which is steady and "
      "not `converged`.\nThere is a warning (OutcomeWarning) for each loop that is no result, "
      "with the reason in its `message`.");
}

} // namespace

void bind_joints(nb::module_ &m)
{
   nb::module_ joints = m.def_submodule("joints", "Vibration of joints.");
   bind_settings<ModalLoopSettings>(joints);
   bind_modes(joints);
   bind_craig_bampton(joints);
   bind_structure(joints);
   bind_loops(joints);
}

} // namespace cattaneo::python
