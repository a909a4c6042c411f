#include "LimitSettings.hpp"
#include "TransientSettings.hpp"
#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Shakedown limits, and the functions for them.

namespace cattaneo::python
{

namespace
{

void warn_of(const char *what, const LimitReport &report)
{
   const bool answered = report.status == LimitStatus::certified ||
                         report.status == LimitStatus::unlimited ||
                         report.status == LimitStatus::stopped;
   if (!answered)
   {
      warn(std::string(what) + ": " + name(report.status) +
           (report.message.empty() ? "" : ": " + report.message));
   }
}

template <class Limit>
LimitReport watched(const char *what, const LimitProblem &problem, LimitSettings settings,
                    const LimitReport *start, const ProgressLike &progress,
                    const StopLike &stop, Limit limit)
{
   const LimitProblem copy = problem;
   LimitReport from;
   if (start)
   {
      from = *start;
      settings.start = &from;
   }
   Watch watch(progress, stop);
   settings.monitor = watch.monitor();
   LimitReport report = one_at_a_time([&] { return limit(copy, settings); });
   warn_of(what, report);
   return report;
}

NodeList node_list(const ReducedProblem &problem, nb::handle nodes,
                   const char *argument = "nodes")
{
   const std::vector<int> all =
      indices(nodes, argument, 0, static_cast<long>(problem.nodes()) - 1);
   return {all.begin(), all.end()};
}

void bind_cycle(nb::module_ &m)
{
   nb::class_<LoadCycle>(m, "LoadCycle",
                         "A polygonal load cycle: constant + factor × varying at each vertex.")
      .def_static(
         "through",
         [](const ReducedProblem &problem, const NamedLoads &constant,
            const std::vector<NamedLoads> &vertices)
         {
            require(!vertices.empty(), "vertices has no entries, must have at least one");
            return LoadCycle::through(problem, constant, vertices);
         },
         arg("problem"), arg("constant"), arg("vertices"),
         "through(problem, {'P': 1}, [{'Q': 1}, {'Q': -1}]) holds P and cycles Q to and fro.")
      .def_prop_ro("constant", viewed(&LoadCycle::constant))
      .def_prop_ro("varying", viewed(&LoadCycle::varying), "(loads, vertices)")
      .def("__repr__", [](const LoadCycle &self)
           { return "<LoadCycle of " + std::to_string(self.vertices()) + " vertices>"; });
   m.def(
      "held_and_cycled",
      [](const ReducedProblem &problem, const std::string &held, double load,
         const std::string &cycled, double reversal)
      {
         return held_and_cycled(problem, held, finite(load, "load"), cycled,
                                finite(reversal, "reversal"));
      },
      arg("problem"), arg("held"), arg("load"), arg("cycled"), arg("reversal"),
      "A cycle with one load held at a constant multiplier, and another cycled between λ and "
      "reversal × λ, -1 <= reversal <= 1. λ is the load factor.");
}

void bind_limits(nb::module_ &m)
{
   nb::class_<LimitProblem>(m, "LimitProblem",
                            "A contact and its load cycle, the input of limits. The problem "
                            "must have no gap (see absorb_gap()).")
      .def_prop_ro(
         "reduced", [](LimitProblem &self) -> ReducedProblem & { return self.reduced; },
         nb::rv_policy::reference_internal)
      .def_ro("coupling", &LimitProblem::coupling, "degree of coupling, 0 to 1")
      .def_prop_rw(
         "cycle", [](const LimitProblem &self) { return self.cycle; },
         [](LimitProblem &self, const LoadCycle &cycle)
         {
            cycle.validate(self.reduced);
            self.cycle = cycle;
         },
         nb::for_setter(arg("cycle")), "the load cycle; it may be replaced for a sweep");
   m.def(
      "limit_problem",
      [](const ReducedProblem &problem, const LoadCycle &cycle)
      {
         cycle.validate(problem);
         return unlocked([of = problem, loads = cycle]() mutable
                         { return limit_problem(std::move(of), std::move(loads)); });
      },
      arg("problem"), arg("cycle"),
      "Computes the residual forces of a problem, the expensive part of a limit. For a sweep "
      "over friction or cycles make it once.");

   using Self = LimitReport;
   nb::class_<Self>(m, "LimitReport", "A shakedown limit between proven bounds.")
      .def_prop_ro(
         "status", [](const Self &self) { return name(self.status); },
         "'certified', 'bracketed', 'unlimited', 'no solution', 'failed', 'stopped' or "
         "'unavailable'")
      .def_prop_ro("certified",
                   [](const Self &self) { return self.status == LimitStatus::certified; })
      .def_ro("message", &Self::message)
      .def_ro("limit", &Self::limit, "the safe side")
      .def_ro("lower", &Self::lower)
      .def_ro("upper", &Self::upper)
      .def_prop_ro("slip", viewed(&Self::slip),
                   "the slip with which the contact sticks throughout")
      .def_prop_ro(
         "mechanism_slip", [](const Self &self) { return array(self.mechanism.slip); },
         "(c n, vertices), of the dual mechanism")
      .def_prop_ro(
         "mechanism_opening", [](const Self &self) { return array(self.mechanism.opening); },
         "(n, vertices)")
      .def_ro("coupling", &Self::coupling, "degree of coupling, 0 to 1")
      .def_ro("coupled", &Self::coupled,
              "does slip change pressures? If so, some start shakes down below the limit, but "
              "not every start has to")
      .def_ro("every_start", &Self::every_start,
              "lower limit λ1 of a load, below which every start shakes down, or a proven "
              "lower bound of it; nan if nothing is known")
      .def_ro("starts", &Self::starts, "one sentence on the starts that shake down")
      .def_prop_ro(
         "assumption", [](const Self &) { return std::string(limit_assumption); },
         "the assumption of the bounds")
      .def_ro("of_the_mesh", &Self::of_the_mesh,
              "reason why the limit belongs to this mesh only, '' if there is none")
      .def_prop_ro("statement", &Self::statement, nb::sig("def statement(self) -> list[str]"),
                   "three sentences: the assumption, which starts shake down, and whether the "
                   "mesh decides the limit")
      .def_ro("iterations", &Self::iterations)
      .def_ro("seconds", &Self::seconds)
      .def_ro("counters", &Self::counters)
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;

              text.precision(9);
              text << "<LimitReport: " << name(self.status);
              if (self.proven())
              {
                 text << ", " << self.limit << ", proven between " << self.lower << " and "
                      << self.upper;
              }
              else if (self.status == LimitStatus::unlimited) { text << ", " << self.limit; }
              if (!self.message.empty()) { text << ": " << self.message; }
              for (const std::string &sentence : self.statement())
              {
                 text << "\n  " << sentence;
              }
              text << ">";
              return text.str();
           });

   const LimitSettings settings;
   LimitSettings told; // unless they are given
   told.every_start = true;
   m.def(
      "load_limit",
      [](const LimitProblem &problem, LimitSettings settings, const LimitReport *start,
         const ProgressLike &progress, const StopLike &stop, const nb::kwargs &members)
      {
         set_members(settings, members);
         return watched("load_limit", problem, settings, start, progress, stop,
                        [](const LimitProblem &of, const LimitSettings &with)
                        { return load_limit(of, with); });
      },
      arg("problem"), nb::kw_only(), arg("settings") = told, arg("start") = nb::none(),
      arg("progress") = false, arg("stop") = nb::none(), arg("members"),
      "The largest load factor at which some residual slip keeps all nodes stuck and closed, "
      "for the "
      "friction of the problem.\n"
      "settings: without them λ1 is found too, below which every start shakes down in a "
      "coupled "
      "contact. Settings that are given say so themselves (every_start).\n"
      "start: an earlier report of a sweep.");
   m.def(
      "friction_limit",
      [](const LimitProblem &problem, double load_factor, LimitSettings settings,
         const LimitReport *start, const ProgressLike &progress, const StopLike &stop,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         const double factor = finite(load_factor, "load_factor");
         return watched("friction_limit", problem, settings, start, progress, stop,
                        [factor](const LimitProblem &of, const LimitSettings &with)
                        { return friction_limit(of, factor, with); });
      },
      arg("problem"), arg("load_factor"), nb::kw_only(), arg("settings") = settings,
      arg("start") = nb::none(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "The smallest coefficient of friction, the same at all nodes, with which the contact can "
      "shake down under a load factor. The problem's own friction is not used.");

   nb::class_<LowerLimitReport>(
      m, "LowerLimitReport",
      "The limit λ1 below which every start shakes down, or a proven lower bound of it.")
      .def_prop_ro(
         "kind",
         [](const LowerLimitReport &self)
         {
            const char *const kinds[] = {"uncoupled", "two nodes", "bound", "apart", "none"};
            return kinds[static_cast<int>(self.kind)];
         })
      .def_ro("message", &LowerLimitReport::message)
      .def_ro("value", &LowerLimitReport::value)
      .def_prop_ro("slip", viewed(&LowerLimitReport::slip))
      .def("__repr__", [](const LowerLimitReport &self)
           { return "<LowerLimitReport: " + self.message + ">"; });
   m.def(
      "lower_limit",
      [](const LimitProblem &problem, const LimitReport &upper, Numbers apart,
         LimitSettings settings, const nb::kwargs &members)
      {
         set_members(settings, members);
         const NodeList nodes =
            apart.is_none() ? NodeList() : node_list(problem.reduced, apart, "apart");
         return one_at_a_time([&, copy = problem, limit = upper]
                              { return lower_limit(copy, limit, settings, nodes); });
      },
      arg("problem"), arg("upper"), nb::kw_only(), arg("apart") = nb::none(),
      arg("settings") = settings, arg("members"),
      "upper: the report of load_limit. apart: exempt nodes. In a contact that "
      "stays closed, slip that goes on for ever below the value includes slip at one of them.");
}

void bind_closed(nb::module_ &m)
{
   nb::class_<ClosedContact>(m, "ClosedContact",
                             "A receding contact whose nodes `closed` stay closed and whose "
                             "others stay open.")
      .def_prop_ro(
         "reduced", [](ClosedContact &self) -> ReducedProblem & { return self.reduced; },
         nb::rv_policy::reference_internal, "reduced problem of the closed nodes")
      .def_prop_ro("closed",
                   [](const ClosedContact &self) { return array_of_indices(self.closed); })
      .def_prop_ro("open",
                   [](const ClosedContact &self) { return array_of_indices(self.open); })
      .def(
         "open_gaps",
         [](const ClosedContact &self, Numbers slip, const NamedLoads &loads)
         {
            return array(self.open_gaps(vector(slip, "slip", self.reduced.slips()),
                                        self.reduced.multipliers(loads)));
         },
         arg("slip"), arg("loads"),
         "w + gap of the open nodes for a slip of the closed nodes and multipliers of the "
         "loads; negative where the assumption fails");
   m.def(
      "closed_contact",
      [](const ReducedProblem &problem, Numbers nodes)
      { return closed_contact(problem, node_list(problem, nodes)); },
      arg("problem"), arg("nodes"));
   m.def(
      "stay_closed",
      [](const ReducedProblem &problem, const LoadCycle &cycle, double load_factor, int cycles)
      {
         const ReducedProblem copy = problem;
         const LoadCycle loads = cycle;
         const double factor = finite(load_factor, "load_factor");
         require_at_least("stay_closed: cycles", cycles, 1);
         Watch watch(nb::bool_(false), nb::none());
         const StayedClosed result =
            unlocked([&] { return stay_closed(copy, loads, factor, cycles, watch.monitor()); });
         if (result.march.status != FrictionStatus::converged)
         {
            warn(std::string("stay_closed: the march ended with ") + name(result.march.status) +
                 ", so that its nodes are not reliable: " + result.march.message);
         }
         return array_of_indices(result.nodes);
      },
      arg("problem"), arg("cycle"), arg("load_factor"), arg("cycles"),
      "Marches some cycles at a load factor, and returns the numbers of the nodes that are "
      "closed throughout.");
}

void bind_estimates(nb::module_ &m)
{
   nb::class_<PointwiseEstimate>(m, "PointwiseEstimate",
                                 "An estimate of the limit from one node at a time.")
      .def_ro("value", &PointwiseEstimate::value)
      .def_ro("node", &PointwiseEstimate::node)
      .def("__float__", [](const PointwiseEstimate &self) { return self.value; })
      .def("__repr__",
           [](const PointwiseEstimate &self)
           {
              return "<PointwiseEstimate: " + exact_text(self.value) + " at node " +
                     std::to_string(self.node) + ">";
           });
   m.def(
      "method1_friction",
      [](const ReducedProblem &problem, const LoadCycle &cycle, double load_factor)
      { return method1_friction(problem, cycle, finite(load_factor, "load_factor")); },
      arg("problem"), arg("cycle"), arg("load_factor"));
   m.def(
      "method1_load",
      [](const ReducedProblem &problem, const LoadCycle &cycle)
      { return method1_load(problem, cycle); },
      arg("problem"), arg("cycle"));
   m.def(
      "degree_of_coupling",
      [](const ReducedProblem &problem) { return degree_of_coupling(problem); }, arg("problem"),
      "Degree of coupling of slip and pressure, 0 to 1; for two half-planes |β| of Dundurs.");

   nb::class_<TransientReport>(m, "TransientReport",
                               "A march of a load cycle from a given slip.")
      .def_prop_ro("verdict", [](const TransientReport &self) { return name(self.verdict); })
      .def_prop_ro("status", [](const TransientReport &self) { return name(self.status); })
      .def_ro("message", &TransientReport::message)
      .def_ro("load_factor", &TransientReport::load_factor)
      .def_prop_ro(
         "dissipation",
         [](const TransientReport &self)
         {
            return array(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
               self.dissipation.data(), self.dissipation.size())));
         },
         "of each cycle, until steady")
      .def_ro("decay", &TransientReport::decay)
      .def_ro("elastic_slip", &TransientReport::elastic_slip,
              "largest slip if the stuck contact loses all friction, the scale of cycle_slip")
      .def_prop_ro("cycle_slip", viewed(&TransientReport::cycle_slip),
                   "(n,), length of the slip path in the last cycle of each node that is in "
                   "contact at some time of it")
      .def_prop_ro(
         "opened", [](const TransientReport &self) { return array_of_indices(self.opened); },
         "nodes that are open at some time of the last cycle")
      .def_prop_ro("slip", viewed(&TransientReport::slip), "at the end")
      .def("__repr__",
           [](const TransientReport &self)
           {
              std::ostringstream text;

              text << "<TransientReport: load factor " << self.load_factor << ", "
                   << name(self.verdict) << " after " << self.dissipation.size() << " cycles>";
              return text.str();
           });
   m.def(
      "transient",
      [](const LimitProblem &problem, double load_factor, Numbers start,
         std::optional<int> cycles, const LimitReport *limit, TransientSettings settings,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         if (cycles) { settings.cycles = *cycles; }
         settings.validate();
         const LimitProblem copy = problem;
         const double factor = finite(load_factor, "load_factor");
         const Eigen::VectorXd slip = vector_or_number(start, "start", copy.reduced.slips());
         if (limit && limit->proven())
         {
            settings.upper = std::min(settings.upper, limit->upper);
         }
         Watch watch(nb::bool_(false), nb::none());
         settings.march.monitor = watch.monitor();
         return unlocked(
            [&]
            {
               FrictionSolver solver(copy.reduced, settings.march.friction);
               return transient(solver, copy, factor, slip, settings);
            });
      },
      arg("problem"), arg("load_factor"), arg("start") = 0.0, arg("cycles") = nb::none(),
      arg("limit") = nb::none(), nb::kw_only(), arg("settings") = TransientSettings(),
      arg("members"),
      "Marches the cycle at a load factor from the slip `start`, (c n,), to see whether the "
      "contact shakes down. limit: the report of load_limit(). Above its proven upper bound "
      "the verdict is never 'shaken down': if slip seems to have ended, it is 'moves only at "
      "nodes that open' or, without such nodes, 'still slipping'.");
}

} // namespace

void bind_shakedown(nb::module_ &m)
{
   nb::module_ shakedown = m.def_submodule("shakedown", "Shakedown limits and bounds.");
   bind_settings<LimitSettings>(shakedown);
   bind_settings<TransientSettings>(shakedown);
   bind_cycle(shakedown);
   bind_limits(shakedown);
   bind_closed(shakedown);
   bind_estimates(shakedown);
}

} // namespace cattaneo::python
