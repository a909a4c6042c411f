#include "marches.hpp"

#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/friction/history_statements.hpp>
#include <limits>
#include <nanobind/stl/string.h>
#include <sstream>

// Marches along load histories.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(Points, "collections.abc.Sequence[collections.abc.Mapping[str, float]]");
CATTANEO_ARGUMENT(MaybeWhole, "None | int");
CATTANEO_ARGUMENT(MaybeNumbers, "None | numpy.typing.ArrayLike");
CATTANEO_ARGUMENT(Observer, "None | collections.abc.Callable[[ContactState], object]");

/// A report with the state it ended in, and the problem it is of.
struct March
{
   nb::object problem;
   std::vector<std::string> loads;
   MarchReport report;
   ContactState state;
   std::vector<ContactState> states; ///< of all increments, if they were to be kept

   /// A column for each increment.
   template <class Value>
   Eigen::VectorXd each(Value value) const
   {
      Eigen::VectorXd all(report.increments.size());
      for (Index k = 0; k < all.size(); ++k)
      {
         all[k] = static_cast<double>(std::invoke(value, report.increments[k]));
      }
      return all;
   }
   nb::dict each_load(Eigen::VectorXd IncrementRecord::*values) const
   {
      nb::dict all;
      for (std::size_t l = 0; l < loads.size(); ++l)
      {
         all[loads[l].c_str()] =
            array(each([&](const IncrementRecord &record) { return (record.*values)[l]; }));
      }
      return all;
   }
};

March march_of(nb::handle problem)
{
   March march{nb::borrow(problem), {}, {}, {}, {}};
   for (const LoadPattern &each : given<ReducedProblem>(problem, "problem").patterns)
   {
      march.loads.push_back(each.name);
   }
   return march;
}

LoadHistory history_through(const ReducedProblem &problem, nb::handle points,
                            nb::handle cycle_start, nb::handle cycles, nb::handle times)
{
   std::vector<NamedLoads> loads;
   for (const nb::object &point : sequence(points, "points"))
   {
      loads.push_back(named_loads(point, "points[" + std::to_string(loads.size()) + "]"));
   }
   require(loads.size() >= 2, "points has ", loads.size(),
           " entries, must have two at least: where the history starts and where it goes");
   LoadHistory history = LoadHistory::through(problem, loads);
   const auto count = static_cast<long>(loads.size());
   if (!times.is_none()) { history.times = vector(times, "times", count); }
   if (!cycle_start.is_none())
   {
      history.cycle_start = static_cast<int>(whole(cycle_start, "cycle_start", 0, count - 2));
      history.cycles = static_cast<int>(
         whole(cycles, "cycles", 1, std::numeric_limits<int>::max() / count - 1));
   }
   else
   {
      require(whole(cycles, "cycles", 1, std::numeric_limits<int>::max()) == 1,
              "cycles needs cycle_start, the point at which the cycle starts");
   }
   history.validate(problem);
   return history;
}

nb::object march_from(nb::handle problem, nb::handle history, nb::handle state,
                      const MarchSettings &given_settings, nb::handle keep_states,
                      nb::handle observer, nb::handle progress, nb::handle stop)
{
   const ReducedProblem &of = given<ReducedProblem>(problem, "problem");
   MarchSettings settings = given_settings;
   March march = march_of(problem);
   march.state = state_or_rest(of, state);
   const LoadHistory loads = history_from(of, history, march.state);
   const bool keep = flag(keep_states, "keep_states");
   require_observer(observer);
   Watch watch(progress, stop);
   settings.monitor = watch.monitor();
   const MarchObserver each = [&](const ContactState &at, const IncrementRecord &)
   {
      if (keep) { march.states.push_back(at); }
      if (observer.is_none()) { return; }
      const nb::gil_scoped_acquire lock;
      observer(nb::cast(ContactState(at)));
      watch.ask(); // an observer that ends the march ends it here
   };
   const MarchObserver watched = keep || !observer.is_none() ? each : MarchObserver();
   const ReducedProblem copy = of; // that no other thread changes meanwhile
   march.report =
      unlocked([&] { return cattaneo::march(copy, loads, march.state, settings, watched); });
   nb::object result = nb::cast(std::move(march));
   const MarchReport &report = nb::inst_ptr<March>(result)->report;
   warn_of("march", report);
   if (report.status == FrictionStatus::converged && report.counters.increments == 0)
   {
      warn("march: nothing was marched, the state stands at time " + exact_text(report.time) +
           ", at the end of the history or beyond it");
   }
   return result;
}

std::string brief(const March &self)
{
   const MarchReport &report = self.report;
   std::ostringstream text;
   text << "<MarchReport: " << name(report.status);
   if (!report.message.empty()) { text << " (" << report.message << ")"; }
   text << " at time " << report.time << ", " << report.counters.increments << " increments, "
        << report.cycles.size() << " cycles";
   if (report.steady_cycle > 0) { text << ", steady from cycle " << report.steady_cycle; }
   text << "\n  loads:";
   for (std::size_t l = 0; l < self.loads.size(); ++l)
   {
      text << " " << self.loads[l] << " = " << self.state.multipliers[static_cast<Index>(l)];
   }
   text << "\n  normal force " << self.state.p.sum() << ", tangential force "
        << self.state.q.sum() << ", dissipation " << self.state.dissipation
        << "\n  largest residual " << report.largest_residual << ", energy imbalance "
        << report.energy_imbalance << ", error of advancing contact " << report.advance_error
        << " (estimate)";
   const LossError &loss = report.loss_error;
   if (loss.value > 0)
   {
      text << "\n  the increments change the loss by up to " << loss.value << " ("
           << (loss.bound ? "bound" : "estimate") << ": " << loss.by << ")";
   }
   if (report.not_unique)
   {
      text << "\n  not unique from time " << report.not_unique->time << ": "
           << report.not_unique->message;
   }
   for (const CutOffContact &end : report.cut_off) { text << "\n  " << end.message(); }
   text << ">";
   return text.str();
}

void bind_cycles(nb::module_ &m)
{
   nb::class_<Loop>(
      m, "Loop",
      "The way of one load in the plane of its force and displacement, over a cycle.")
      .def_prop_ro("work", &Loop::work, "enclosed area where the loop closes")
      .def_prop_ro("force_range", &Loop::force_range)
      .def_prop_ro("displacement_range", &Loop::displacement_range)
      .def_prop_ro("stiffness", &Loop::stiffness, "secant, nan if the load did not vary")
      .def_prop_ro("loss_factor", &Loop::loss_factor)
      .def("__repr__",
           [](const Loop &self)
           {
              std::ostringstream text;
              text << "<Loop: work " << self.work() << ", secant stiffness " << self.stiffness()
                   << ", loss factor " << self.loss_factor() << ">";
              return text.str();
           });
   nb::class_<StateChange>(m, "StateChange", "A node changes its state on the exact path.")
      .def_ro("time", &StateChange::time)
      .def_ro("node", &StateChange::node)
      .def_prop_ro("multipliers", viewed(&StateChange::multipliers))
      .def_ro("from_", &StateChange::from)
      .def_ro("to", &StateChange::to)
      .def("__repr__",
           [](const StateChange &self)
           {
              std::ostringstream text;
              text << "<StateChange at time " << self.time << ": node " << self.node << " from "
                   << name(self.from) << " to " << name(self.to) << ">";
              return text.str();
           });
}

/// A marched cycle, with the names of its loads.
struct Cycle
{
   CycleRecord record;
   std::vector<std::string> loads;
};

} // namespace

LoadHistory history_from(const ReducedProblem &problem, nb::handle history,
                         const ContactState &state)
{
   const bool listed = nb::isinstance<nb::list>(history) || nb::isinstance<nb::tuple>(history);
   if (!listed && !nb::isinstance<LoadHistory>(history))
   {
      refuse(history, "history", "a LoadHistory or a list of loads by names");
   }
   LoadHistory loads =
      listed ? history_through(problem, history, nb::none(), nb::cast(1), nb::none())
             : given<LoadHistory>(history, "history");
   loads.validate(problem);
   if (listed) { loads.times.array() += state.time; }
   for (Index l = 0; listed && l < state.multipliers.size(); ++l)
   {
      const double first = loads.multipliers(l, 0), stands = state.multipliers[l];
      require(std::abs(first - stands) <= 1e-12 * std::abs(stands), "history: load '",
              problem.patterns[l].name, "' is ", first, " at its first point, and ", stands,
              state.multipliers.isZero(0)
                 ? " before any load; begin with {}"
                 : " in the state that it goes on from; begin with what that has "
                   "(MarchReport.loads)");
   }
   return loads;
}

MarchSettings march_settings(nb::handle increments, nb::handle stepping,
                             nb::handle single_increment_if_exact, nb::handle max_halvings,
                             nb::handle method)
{
   MarchSettings settings;
   settings.increments =
      static_cast<int>(whole(increments, "increments", 1, std::numeric_limits<int>::max()));
   settings.stepping = chosen<Stepping>(stepping, "stepping", {"fixed", "exact"});
   settings.single_increment_if_exact =
      flag(single_increment_if_exact, "single_increment_if_exact");
   settings.max_halvings = static_cast<int>(whole(max_halvings, "max_halvings", 0, 1000));
   settings.friction.method =
      chosen<FrictionMethod>(method, "method", {"automatic", "gauss_seidel"});
   return settings;
}

nb::object march_report(nb::handle problem, MarchReport report, ContactState state)
{
   March march = march_of(problem);
   march.report = std::move(report);
   march.state = std::move(state);
   return nb::cast(std::move(march));
}

void warn_of_status(const std::string &what, FrictionStatus status, const std::string &message)
{
   if (status == FrictionStatus::converged || status == FrictionStatus::stopped) { return; }
   warn(what + ": " + name(status) + " " + message);
}

void warn_of(const std::string &what, const MarchReport &report)
{
   warn_of_status(what, report.status,
                  "at time " + exact_text(report.event_time) + ": " + report.message);
   for (const CutOffContact &end : report.cut_off) { warn(what + ": " + end.message()); }
}

ContactState state_or_rest(const ReducedProblem &problem, nb::handle state)
{
   ContactState result =
      state.is_none() ? ContactState::virgin(problem) : given<ContactState>(state, "state");
   result.validate(problem);
   return result;
}

void bind_marches(nb::module_ &m)
{
   nb::class_<LoadHistory>(
      m, "LoadHistory",
      "A piecewise-linear history of load multipliers: an opening part, then "
      "a cycle that repeats.")
      .def_static(
         "through",
         [](Of<ReducedProblem> problem, Points points, MaybeWhole cycle_start, Whole cycles,
            MaybeNumbers times) {
            return history_through(given(problem, "problem"), points, cycle_start, cycles,
                                   times);
         },
         arg("problem"), arg("points"), arg("cycle_start") = nb::none(), arg("cycles") = 1,
         arg("times") = nb::none(),
         "Through loads by names, zero for those that are not named: through(problem, [{}, "
         "{'P': 1}, {'P': 1, 'Q': 0.2}]).\n\ncycle_start: the point from which on the rest "
         "repeats, `cycles` times; its loads are those of the last point. times: increasing, "
         "0, "
         "1, 2, … unless given; only a parameter.")
      .def_static(
         "read",
         [](Of<ReducedProblem> problem, Text history) {
            return load_history("history", text(history, "history"), given(problem, "problem"));
         },
         arg("problem"), arg("text"),
         "As programs write it, \"P=0; P=1; Q=0.1; Q=-0.1\": a load that is not named keeps "
         "its "
         "value.")
      .def_prop_ro("times", viewed(&LoadHistory::times))
      .def_prop_ro("multipliers", viewed(&LoadHistory::multipliers), "(loads, points)")
      .def_ro("cycle_start", &LoadHistory::cycle_start, "-1: no cycle")
      .def_ro("cycles", &LoadHistory::cycles)
      .def("__repr__",
           [](const LoadHistory &self)
           {
              std::ostringstream text;
              text << "<LoadHistory: " << self.times.size() << " points from time "
                   << self.times[0] << " to " << self.times[self.times.size() - 1];
              if (self.cycle_start >= 0)
              {
                 text << ", " << self.cycles << " cycles from point " << self.cycle_start;
              }
              text << ">";
              return text.str();
           });
   bind_cycles(m);

   nb::class_<Cycle>(m, "CycleRecord", "One marched cycle.")
      .def_prop_ro(
         "cycle", [](const Cycle &self) { return self.record.cycle; }, "from 1")
      .def_prop_ro(
         "whole", [](const Cycle &self) { return self.record.whole; },
         "False if the march was taken up within it")
      .def_prop_ro(
         "loops",
         [](const Cycle &self)
         {
            nb::dict all;
            for (std::size_t l = 0; l < self.loads.size(); ++l)
            {
               all[self.loads[l].c_str()] = nb::cast(Loop(self.record.loops[l]));
            }
            return all;
         },
         nb::sig("def loops(self) -> dict[str, Loop]"), "of each load")
      .def_prop_ro("dissipation", [](const Cycle &self) { return self.record.dissipation; })
      .def_prop_ro("external_work", [](const Cycle &self) { return self.record.external_work; })
      .def_prop_ro(
         "slip_change", [](const Cycle &self) { return self.record.slip_change; },
         "largest difference from the slip one cycle before")
      .def_prop_ro("node_dissipation",
                   [](const Cycle &self) { return array(self.record.node_dissipation); })
      .def("__repr__",
           [](const Cycle &self)
           {
              std::ostringstream text;
              text << "<CycleRecord " << self.record.cycle << ": dissipation "
                   << self.record.dissipation << ", slip change " << self.record.slip_change
                   << ">";
              return text.str();
           });

   using Self = March;
   const auto number_of = [](auto member) // of each increment
   { return [member](const Self &self) { return array(self.each(member)); }; };
   nb::class_<Self> report(m, "MarchReport",
                           "What a march came to: `state` at its end, arrays with an entry an "
                           "increment, and loops a cycle.");
   bind_outcome(report, [](const Self &self) -> const MarchReport & { return self.report; });
   report
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> ReducedProblem"))
      .def_prop_ro(
         "state", [](Self &self) -> ContactState & { return self.state; },
         nb::rv_policy::reference_internal, "at the end")
      .def_prop_ro(
         "loads",
         [](const Self &self)
         {
            nb::dict all;
            for (std::size_t l = 0; l < self.loads.size(); ++l)
            {
               all[self.loads[l].c_str()] = self.state.multipliers[static_cast<Index>(l)];
            }
            return all;
         },
         nb::sig("def loads(self) -> dict[str, float]"), "multipliers at the end, by name")
      .def_prop_ro(
         "states",
         [](nb::handle_t<Self> self)
         {
            nb::list all;
            for (ContactState &state : given<Self>(self, "self").states)
            {
               all.append(nb::cast(state, nb::rv_policy::reference_internal, self));
            }
            return all;
         },
         nb::sig("def states(self) -> list[ContactState]"),
         "of each increment, if keep_states was True")
      .def_prop_ro("time", number_of(&IncrementRecord::time))
      .def_prop_ro("cycle", number_of(&IncrementRecord::cycle), "0: opening part")
      .def_prop_ro(
         "multipliers",
         [](const Self &self) { return self.each_load(&IncrementRecord::multipliers); },
         nb::sig("def multipliers(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
         "by the name of the load")
      .def_prop_ro(
         "conjugates",
         [](const Self &self) { return self.each_load(&IncrementRecord::conjugates); },
         nb::sig("def conjugates(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
         "displacement of a force, reaction of a displacement, by the name of the load")
      .def_prop_ro("stick", number_of(&IncrementRecord::stick), "number of nodes")
      .def_prop_ro("separation", number_of(&IncrementRecord::separation))
      .def_prop_ro("forward_slip", number_of(&IncrementRecord::forward_slip))
      .def_prop_ro("backward_slip", number_of(&IncrementRecord::backward_slip))
      .def_prop_ro("slip", number_of(&IncrementRecord::slip),
                   "with two tangential components: nodes that slip")
      .def_prop_ro("dissipation", number_of(&IncrementRecord::dissipation),
                   "lost by friction in each increment")
      .def_prop_ro("external_work", number_of(&IncrementRecord::external_work))
      .def_prop_ro(
         "cycles",
         [](const Self &self)
         {
            nb::list all;
            for (const CycleRecord &each : self.report.cycles)
            {
               all.append(nb::cast(Cycle{each, self.loads}));
            }
            return all;
         },
         nb::sig("def cycles(self) -> list[CycleRecord]"))
      .def_prop_ro(
         "changes",
         [](const Self &self)
         {
            nb::list all;
            for (const StateChange &each : self.report.changes)
            {
               all.append(nb::cast(StateChange(each)));
            }
            return all;
         },
         nb::sig("def changes(self) -> list[StateChange]"),
         "with every_event: the changes of state in the order of the path")
      .def_prop_ro(
         "events", [](const Self &self) { return self.report.events; },
         "number of changes of state on an exact path")
      .def_prop_ro(
         "event_time", [](const Self &self) { return self.report.event_time; },
         "where the outcome is not 'converged': when it came about")
      .def_prop_ro("event_multipliers",
                   [](const Self &self) { return array(self.report.event_multipliers); })
      .def_prop_ro(
         "steady_cycle", [](const Self &self) { return self.report.steady_cycle; },
         "0: not reached")
      .def_prop_ro("steady_period", [](const Self &self) { return self.report.steady_period; })
      .def_prop_ro(
         "loss_error", [](const Self &self) { return self.report.loss_error.value; },
         "how far the loss, in all or of a cycle, may be from that of the path; nan: not known")
      .def_prop_ro(
         "loss_error_is",
         [](const Self &self) { return self.report.loss_error.bound ? "bound" : "estimate"; },
         "'bound' where the exact path was followed beside the march, else 'estimate'")
      .def_prop_ro(
         "loss_error_by", [](const Self &self) { return self.report.loss_error.by; },
         "what was marched beside it, or why nothing is known")
      .def_prop_ro(
         "energy_imbalance", [](const Self &self) { return self.report.energy_imbalance; },
         "balance of the energies, relative; of second order in the increments, so that it is "
         "no "
         "measure of loss_error")
      .def_prop_ro(
         "advance_error", [](const Self &self) { return self.report.advance_error; },
         "estimate, of friction forces where contact advances in increments")
      .def_prop_ro("largest_residual",
                   [](const Self &self) { return self.report.largest_residual; })
      .def_prop_ro("taken_up_clearance",
                   [](const Self &self) { return self.report.taken_up_clearance; })
      .def_prop_ro(
         "fallbacks", [](const Self &self) { return self.report.fallbacks; },
         "increments taken because there was no exact path")
      .def_prop_ro("seconds", [](const Self &self) { return self.report.seconds; })
      .def_prop_ro("counters", [](const Self &self) { return self.report.counters; })
      .def(
         "plot",
         [](nb::object self, nb::args positional, nb::kwargs named) {
            return nb::module_::import_("cattaneo._plot")
               .attr("march")(self, *positional, **named);
         },
         nb::sig("def plot(self, axes: typing.Any = None) -> typing.Any"),
         "Tractions and slip at the end along the contact line, and the loop of each load that "
         "varies; needs matplotlib. Returns its axes.")
      .def("__repr__", &brief);

   const FrictionSettings friction;
   const MarchSettings settings;
   m.def(
      "march",
      [](Of<ReducedProblem> problem, nb::object history, nb::object state, Whole increments,
         Text stepping, Flag single_increment_if_exact, Whole max_halvings,
         Flag stop_at_steady_state, Number steady_tolerance, Text method, Number tolerance,
         Flag keep_states, Flag every_event, Flag loss_error, nb::object observer,
         nb::object progress, nb::object stop)
      {
         MarchSettings settings = march_settings(
            increments, stepping, single_increment_if_exact, max_halvings, method);
         settings.stop_at_steady_state = flag(stop_at_steady_state, "stop_at_steady_state");
         settings.steady_tolerance = number(steady_tolerance, "steady_tolerance");
         settings.friction.tolerance = number(tolerance, "tolerance");
         settings.every_event = flag(every_event, "every_event");
         settings.loss_error = flag(loss_error, "loss_error");
         settings.validate();
         return march_from(problem.object, history, state, settings, keep_states, observer,
                           progress, stop);
      },
      arg("problem"), arg("history"), arg("state") = nb::none(), nb::kw_only(),
      arg("increments") = settings.increments, arg("stepping") = "exact",
      arg("single_increment_if_exact") = settings.single_increment_if_exact,
      arg("max_halvings") = settings.max_halvings,
      arg("stop_at_steady_state") = settings.stop_at_steady_state,
      arg("steady_tolerance") = settings.steady_tolerance, arg("method") = "automatic",
      arg("tolerance") = friction.tolerance, arg("keep_states") = false,
      arg("every_event") = false, arg("loss_error") = true, arg("observer") = nb::none(), arg("progress") = false,
      arg("stop") = nb::none(),
      nb::sig(
         "def march(problem: ReducedProblem, history: LoadHistory | "
         "collections.abc.Sequence[collections.abc.Mapping[str, float]], state: None | "
         "ContactState = None, *, increments: int = 20, stepping: str = 'exact', "
         "single_increment_if_exact: bool = True, max_halvings: int = 12, "
         "stop_at_steady_state: "
         "bool = True, steady_tolerance: float = 1e-10, method: str = 'automatic', tolerance: "
         "float = 1e-12, keep_states: bool = False, every_event: bool = False, loss_error: bool = True, observer: "
         "None | collections.abc.Callable[[ContactState], object] = None, progress: bool | "
         "collections.abc.Callable[[Progress], object] = False, stop: None | threading.Event = "
         "None) -> MarchReport"),
      "Marches a contact along a load history, from rest or from `state`, which stays as it "
      "is.\n\n"
      "history: points, [{}, {'P': 1}, {'P': 1, 'Q': 0.2}], the first of which is where the "
      "state stands; or a LoadHistory, whose times are its own: a march that was stopped is "
      "taken "
      "up with the same history and the state it came to.\n"
      "stepping: 'exact', from one change of state to the next, or 'fixed', in equal "
      "increments. increments: of each piece of the history; on an exact path they are stops, "
      "at which states are recorded. every_event: each change of state is recorded in their "
      "place, and listed in `changes`.\n"
      "keep_states: keeps the state of every increment. observer: is called with each.\n"
      "loss_error: where increments are taken, march beside them to say how wrong their loss "
      "may be; that takes as long again in the plane, half as long with two tangential "
      "components.\n"
      "progress: True shows a line on stderr; a function is called with Progress. Other "
      "threads "
      "run meanwhile; Ctrl-C raises KeyboardInterrupt, and `stop`, a threading.Event, ends the "
      "march with status 'stopped' and what there is.\n\n"
      "An outcome other than 'converged' is warned of (OutcomeWarning) and stands in the "
      "report.");
   m.def(
      "conjugates",
      [](Of<ReducedProblem> problem, Of<ContactState> state)
      { return array(conjugates(given(problem, "problem"), given(state, "state"))); },
      arg("problem"), arg("state"),
      "What does work with each load's multiplier: displacement of a force, reaction of a "
      "displacement.");
}

} // namespace cattaneo::python
