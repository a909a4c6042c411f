#include "marches.hpp"

#include "FrictionSettings.hpp"
#include "MarchSettings.hpp"
#include "arrays.hpp"
#include "members.hpp"
#include "module.hpp"
#include "readout.hpp"
#include "watch.hpp"
#include <algorithm>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/friction/settled_states.hpp>
#include <cattaneo/joints/bolts.hpp>
#include <cattaneo/words.hpp>
#include <nanobind/stl/map.h>
#include <nanobind/stl/variant.h>
#include <sstream>

// Marches along load histories.

namespace cattaneo::python
{

namespace
{

using Observer = std::optional<nb::typed<nb::callable, nb::object(ContactState)>>;

/// Results of an interface in a march: a number, or one number for each component, for each
/// increment.
struct InterfaceMarch
{
   std::string name;
   std::vector<int> nodes;                ///< of the problem, increasing
   std::vector<double> normal;            ///< sum of p
   std::vector<double> tangential;        ///< sums of q, one component after the other
   std::vector<double> slip;              ///< mean of v by weights, in the same order
   std::vector<int> stick, slipped, open; ///< numbers of nodes
   std::vector<double> dissipation;       ///< of each cycle
   std::vector<NamedZone> zones;          ///< at the end
};

/// The interfaces of a problem by the names of its chains. Without chains all nodes belong to
/// one interface.
std::vector<InterfaceMarch> interfaces_of(const ReducedProblem &problem)
{
   std::vector<InterfaceMarch> all;
   std::map<std::string, std::size_t> at;
   for (const ContactChain &chain : problem.chains)
   {
      const auto [found, is_new] = at.emplace(chain.interface, all.size());
      if (is_new) { all.push_back({chain.interface, {}, {}, {}, {}, {}, {}, {}, {}, {}}); }
      std::vector<int> &nodes = all[found->second].nodes;
      for (Index i = 0; i < chain.nodes; ++i)
      {
         nodes.push_back(static_cast<int>(chain.first + i));
      }
   }
   if (all.empty())
   {
      all.emplace_back();
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         all[0].nodes.push_back(static_cast<int>(i));
      }
   }
   for (InterfaceMarch &each : all)
   {
      if (each.name.empty()) { each.name = "contact"; }
   }
   return all;
}

/// Adds an increment's end to each interface.
void note(std::vector<InterfaceMarch> &interfaces, const ReducedProblem &problem,
          const ContactState &at)
{
   const std::vector<NodeState> states = settled_states(problem, at);
   const bool weighted = problem.weights.size() == problem.nodes();
   for (InterfaceMarch &each : interfaces)
   {
      each.normal.push_back(at.p(each.nodes).sum());
      for (Index c = 0; c < problem.components(); ++c)
      {
         const auto q = at.q.segment(c * problem.nodes(), problem.nodes()),
                    v = at.v.segment(c * problem.nodes(), problem.nodes());
         // Shear that cancels leaves round-off.
         const Eigen::VectorXd forces = q(each.nodes);
         const double sum = forces.sum();
         const bool none = std::abs(sum) <= 1e-12 * forces.lpNorm<1>();
         each.tangential.push_back(none ? 0.0 : sum);
         const Eigen::VectorXd weights =
            weighted ? Eigen::VectorXd(problem.weights(each.nodes))
                     : Eigen::VectorXd::Ones(static_cast<Index>(each.nodes.size()));
         each.slip.push_back(weights.dot(v(each.nodes)) / weights.sum());
      }
      const auto count = [&](auto is)
      {
         return static_cast<int>(std::count_if(each.nodes.begin(), each.nodes.end(),
                                               [&](int i) { return is(states[i]); }));
      };
      each.stick.push_back(count([](NodeState of) { return of == NodeState::stick; }));
      each.slipped.push_back(count(slips));
      each.open.push_back(count([](NodeState of) { return !closed(of); }));
   }
}

/// Adds the zones of a state to each interface, if the problem says where its nodes are.
void add_zones(std::vector<InterfaceMarch> &interfaces, const ReducedProblem &problem,
               const ContactState &state)
{
   const Index n = problem.nodes();
   const bool lines = n > 0 && problem.components() == 1 && problem.arc_length.size() == n &&
                      problem.weights.size() == n && !problem.chains.empty();
   if (!lines) { return; }
   for (const NamedZone &zone : named_zones(problem, zones(problem, state), false))
   {
      for (InterfaceMarch &each : interfaces)
      {
         const bool its = std::find(each.nodes.begin(), each.nodes.end(), zone.zone.first) !=
                          each.nodes.end();
         if (its) { each.zones.push_back(zone); }
      }
   }
}

/// A report with the last state and the problem of the march.
struct March
{
   nb::object problem;
   std::vector<std::string> loads;
   MarchReport report;
   ContactState state;
   std::vector<ContactState> states;       ///< of all increments, if the settings keep them
   std::vector<InterfaceMarch> interfaces; ///< of marches that were observed

   /// One column for each increment.
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
         all[nb::cast(loads[l])] =
            array(each([&](const IncrementRecord &record) { return (record.*values)[l]; }));
      }
      return all;
   }
};

March march_of(const ReducedProblem &problem)
{
   March march{nb::find(problem), {}, {}, {}, {}, {}};
   for (const LoadPattern &each : problem.patterns) { march.loads.push_back(each.name); }
   return march;
}

/// The function that marches a state along a history: march() of a problem, or of a joint with
/// bolts.
using Marcher = std::function<MarchReport(const LoadHistory &, ContactState &,
                                          const MarchSettings &, const MarchObserver &)>;

March march_by(const Marcher &marcher, const ReducedProblem &problem, const History &history,
               const ContactState *state, MarchSettings settings, bool keep_states,
               const Observer &observer, const ProgressLike &progress, const StopLike &stop,
               const nb::kwargs &members, const std::vector<std::string> &bolts = {})
{
   set_members(settings, members);
   March march = march_of(problem);
   march.state = state_or_rest(problem, state);
   const LoadHistory loads = history_from(problem, history, march.state);
   Watch watch(progress, stop);
   settings.monitor = watch.monitor();
   march.interfaces = interfaces_of(problem);
   const MarchObserver each = [&](const ContactState &at, const IncrementRecord &)
   {
      note(march.interfaces, problem, at);
      if (keep_states) { march.states.push_back(at); }
      if (!observer) { return; }
      const nb::gil_scoped_acquire lock;
      (*observer)(nb::cast(ContactState(at)));
      watch.ask(); // an observer that stops the march stops it here
   };
   march.report = unlocked([&] { return marcher(loads, march.state, settings, each); });
   for (InterfaceMarch &interface : march.interfaces)
   {
      for (const CycleRecord &cycle : march.report.cycles)
      {
         interface.dissipation.push_back(cycle.node_dissipation(interface.nodes).sum());
      }
   }
   add_zones(march.interfaces, problem, march.state);
   const std::string early = nothing_presses(problem, loads, march.report, march.state, bolts);
   if (!early.empty()) { march.report.message += "; " + early; }
   warn_of("march", march.report);
   if (march.report.status == FrictionStatus::converged &&
       march.report.counters.increments == 0)
   {
      warn("march: nothing was marched, because the state has the time " +
           exact_text(march.report.time) + ", at the end of the history or beyond it");
   }
   return march;
}

March march_from(const ReducedProblem &problem, const History &history,
                 const ContactState *state, const MarchSettings &settings, bool keep_states,
                 const Observer &observer, const ProgressLike &progress, const StopLike &stop,
                 const nb::kwargs &members)
{
   // A copy, so that no other thread changes it meanwhile.
   const Marcher marcher = [copy = problem](const LoadHistory &loads, ContactState &at,
                                            const MarchSettings &how, const MarchObserver &each)
   { return cattaneo::march(copy, loads, at, how, each); };
   return march_by(marcher, problem, history, state, settings, keep_states, observer, progress,
                   stop, members);
}

March march_with_bolts(const BoltedJoint &self, const History &history,
                       const ContactState *state, const MarchSettings &settings,
                       bool keep_states, const Observer &observer, const ProgressLike &progress,
                       const StopLike &stop, const nb::kwargs &members)
{
   // The Python object of the problem, which the report refers to.
   const nb::object problem = nb::find(self).attr("problem");
   const Marcher marcher = [&self](const LoadHistory &loads, ContactState &at,
                                   const MarchSettings &how, const MarchObserver &each)
   { return self.march(loads, at, how, each); };
   std::vector<std::string> bolts;
   for (const Bolt &bolt : self.bolts()) { bolts.push_back(bolt.load); }
   March march = march_by(marcher, nb::cast<const ReducedProblem &>(problem), history, state,
                          settings, keep_states, observer, progress, stop, members, bolts);
   // A march also stops where a bolt would push. The user did not request that stop, so warn
   // of it.
   const MarchReport &report = march.report;
   if (report.status == FrictionStatus::stopped &&
       report.message.find("would be compressed") < std::string::npos)
   {
      warn("march: " + report.message + ", at time " + exact_text(report.event_time));
   }
   return march;
}

/// "interface 'face': normal force 90, tangential force -15, …" at the end of the march.
std::string said_of(const InterfaceMarch &self)
{
   std::ostringstream text;
   text << "interface '" << self.name << "': " << self.nodes.size() << " nodes";
   if (self.normal.empty()) { return text.str(); }
   text << ", normal force " << self.normal.back();
   const std::size_t components = self.tangential.size() / self.normal.size();
   for (std::size_t c = 0; c < components; ++c)
   {
      text << (c == 0 ? ", tangential force " : " and ")
           << self.tangential[self.tangential.size() - components + c];
   }
   text << ", " << self.stick.back() << " stick, " << self.slipped.back() << " slip, "
        << self.open.back() << " open";
   return text.str();
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
   if (self.interfaces.size() < 2)
   {
      text << "\n  normal force " << self.state.p.sum() << ", tangential force "
           << self.state.q.sum();
   }
   for (const InterfaceMarch &each : self.interfaces)
   {
      if (self.interfaces.size() > 1) { text << "\n  " << said_of(each); }
   }
   text << (self.interfaces.size() < 2 ? ", " : "\n  ") << "dissipation "
        << self.state.dissipation << "\n  largest residual " << report.largest_residual
        << ", energy imbalance " << report.energy_imbalance << ", error of advancing contact "
        << report.advance_error << " (estimate)";
   const LossError &loss = report.loss_error;
   if (loss.value > 0)
   {
      text << "\n  the increments change the loss by up to " << loss.value << " ("
           << (loss.bound ? "bound" : "estimate") << ": " << loss.by << ")";
   }
   else if (std::isnan(loss.value) && !loss.by.empty())
   {
      text << "\n  how far the increments change the loss is not known: " << loss.by;
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
      "The path of one load in the plane of its force and displacement, over a cycle.")
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

/// Numbers for each increment: (increments,), or for two components (increments, 2).
Reals of_increments(const std::vector<double> &values, std::size_t increments)
{
   using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
   const auto rows = static_cast<Index>(increments),
              columns = increments == 0 ? 0 : static_cast<Index>(values.size()) / rows;
   if (columns > 1)
   {
      return array(Rows(Eigen::Map<const Rows>(values.data(), rows, columns)));
   }
   return array(Eigen::VectorXd(
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()))));
}

void bind_interface_marches(nb::module_ &m)
{
   using Self = InterfaceMarch;
   nb::class_<Self>(m, "InterfaceMarch",
                    "Results of one interface in a march. Arrays have an entry for each "
                    "increment, as in MarchReport.")
      .def_ro("name", &Self::name)
      .def_prop_ro(
         "nodes", [](const Self &self) { return array_of_indices(self.nodes); },
         "numbers of its nodes in the problem: state.p[nodes] are its normal forces")
      .def_prop_ro(
         "normal_force",
         [](const Self &self) { return of_increments(self.normal, self.normal.size()); },
         "sum of p, compression positive")
      .def_prop_ro(
         "tangential_force",
         [](const Self &self) { return of_increments(self.tangential, self.normal.size()); },
         "sum of q, which is -f p where all slips forward; with two tangential components "
         "(increments, 2); no entries without friction")
      .def_prop_ro(
         "slip", [](const Self &self) { return of_increments(self.slip, self.normal.size()); },
         "mean of v over the interface, by weights, as tangential_force")
      .def_prop_ro(
         "sticking", [](const Self &self) { return array_of_indices(self.stick); },
         "number of nodes that stick")
      .def_prop_ro(
         "slipping", [](const Self &self) { return array_of_indices(self.slipped); },
         "number of nodes that slip, in any direction")
      .def_prop_ro(
         "open", [](const Self &self) { return array_of_indices(self.open); },
         "number of nodes that are open, or touch without force")
      .def_prop_ro(
         "dissipation",
         [](const Self &self)
         { return of_increments(self.dissipation, self.dissipation.size()); },
         "lost by friction in each marched cycle")
      .def_ro("zones", &Self::zones,
              "zones at the end of the march, as readout.zones() of its state has them; empty "
              "if the nodes are not on lines with arc lengths and weights")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<InterfaceMarch: " << said_of(self);
              for (const NamedZone &zone : self.zones)
              {
                 text << "\n  " << name(*zone.state) << " from " << zone.zone.from.position
                      << " to " << zone.zone.to.position << zone.places();
              }
              text << ">";
              return text.str();
           });
}

/// A marched cycle, with the names of its loads.
struct Cycle
{
   CycleRecord record;
   std::vector<std::string> loads;
};

/// Loads by name, at each point.
std::vector<NamedLoads> points_of(nb::handle points, const std::string &what)
{
   const std::string needed = "a list of loads by name, as [{}, {\"P\": 1}, {\"Q\": 0.2}]";
   if (nb::isinstance<nb::str>(points) || nb::isinstance<nb::dict>(points) ||
       !nb::isinstance<nb::sequence>(points))
   {
      refuse(points, what, needed);
   }
   std::vector<NamedLoads> all;
   for (const nb::handle point : points)
   {
      const std::string its = what + "[" + std::to_string(all.size()) + "]";
      if (!nb::hasattr(point, "keys")) { refuse(point, its, "loads by name, as {\"P\": 1}"); }
      NamedLoads loads;
      for (const nb::handle key : nb::borrow<nb::mapping>(point).keys())
      {
         if (!nb::isinstance<nb::str>(key)) { refuse(key, "a name in " + its, "a str"); }
         const std::string name = nb::cast<std::string>(key);
         loads[name] = number(point[key], its + "['" + name + "']");
      }
      all.push_back(loads);
   }
   require(all.size() > 1, what, " has ", all.size() == 1 ? "one point" : "no point",
           ", must have two at least, the first without load: [{}, {\"P\": 1}]");
   return all;
}

} // namespace

LoadHistory history_from(const ReducedProblem &problem, const History &history,
                         const ContactState &state)
{
   if (nb::isinstance<LoadHistory>(history)) { return nb::cast<LoadHistory>(history); }
   std::vector<NamedLoads> points = points_of(history, "history");
   // Loads that the first point does not name are those of the state.
   NamedLoads first = named(problem, state.multipliers);
   for (const auto &[name, value] : points[0]) { first[name] = value; }
   points[0] = first;
   LoadHistory loads = LoadHistory::through(problem, points);
   loads.times.array() += state.time;
   for (Index l = 0; l < state.multipliers.size(); ++l)
   {
      const double begin = loads.multipliers(l, 0), stands = state.multipliers[l];
      require(std::abs(begin - stands) <= 1e-12 * std::abs(stands), "history: load '",
              problem.patterns[l].name, "' is ", begin, " at its first point, and ", stands,
              state.multipliers.isZero(0) ? " before any load; begin with {}"
                                          : " in the state from which the march continues; "
                                            "begin with {}, which keeps its loads");
   }
   return loads;
}

nb::object march_report(const ReducedProblem &problem, MarchReport report, ContactState state)
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

ContactState state_or_rest(const ReducedProblem &problem, const ContactState *state)
{
   ContactState result = state ? *state : ContactState::virgin(problem);
   result.validate(problem);
   return result;
}

void bind_marches(nb::module_ &m)
{
   bind_settings<FrictionSettings>(m);
   bind_settings<MarchSettings>(m);
   nb::class_<LoadHistory>(m, "LoadHistory",
                           "A piecewise-linear history of load multipliers: points that are "
                           "marched once, then a cycle that repeats.")
      .def_static(
         "through",
         [](const ReducedProblem &problem, const Points &points, std::optional<int> cycle_start,
            int cycles, Numbers times)
         {
            require(cycle_start || cycles == 1,
                    "cycles needs cycle_start, the point at which the cycle starts");
            require(cycle_start.value_or(0) >= 0, "cycle_start is ", cycle_start.value_or(0),
                    ", must be the number of a point");
            LoadHistory history = LoadHistory::through(problem, points_of(points, "points"),
                                                       cycle_start.value_or(-1), cycles);
            if (!times.is_none())
            {
               history.times = vector(times, "times", history.times.size());
               history.validate(problem);
            }
            return history;
         },
         arg("problem"), arg("points"), arg("cycle_start") = nb::none(), arg("cycles") = 1,
         arg("times") = nb::none(),
         "Through loads by names: through(problem, [{}, {'P': 1}, {'Q': 0.2}]).\n\n"
         "points: multipliers of loads of the problem by name. A load that a point does not "
         "name keeps its value, from 0 at the first point.\ncycle_start: the "
         "point from which on the rest repeats, `cycles` times; its loads are those of the "
         "last "
         "point. times: increasing, 0, 1, 2, … unless given; only a parameter.")
      .def_static(
         "read",
         [](const ReducedProblem &problem, const std::string &history)
         { return load_history("history", history, problem); },
         arg("problem"), arg("text"),
         "text: points as case files and programs have them, \"P=0; P=1; Q=0.1; Q=-0.1\", of "
         "loads of the problem.")
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
      .def_prop_ro("cycle", copied(&Cycle::record, &CycleRecord::cycle), "from 1")
      .def_prop_ro("whole", copied(&Cycle::record, &CycleRecord::whole),
                   "False if the march was resumed within this cycle")
      .def_prop_ro(
         "loops",
         [](const Cycle &self)
         {
            nb::dict all;
            for (std::size_t l = 0; l < self.loads.size(); ++l)
            {
               all[nb::cast(self.loads[l])] = nb::cast(Loop(self.record.loops[l]));
            }
            return all;
         },
         nb::sig("def loops(self) -> dict[str, Loop]"), "of each load")
      .def_prop_ro("dissipation", copied(&Cycle::record, &CycleRecord::dissipation))
      .def_prop_ro("external_work", copied(&Cycle::record, &CycleRecord::external_work))
      .def_prop_ro("slip_change", copied(&Cycle::record, &CycleRecord::slip_change),
                   "largest difference from the slip one cycle before")
      .def_prop_ro("node_dissipation", copied(&Cycle::record, &CycleRecord::node_dissipation))
      .def("__repr__",
           [](const Cycle &self)
           {
              std::ostringstream text;

              text << "<CycleRecord " << self.record.cycle << ": dissipation "
                   << self.record.dissipation << ", slip change " << self.record.slip_change
                   << ">";
              return text.str();
           });

   bind_interface_marches(m);

   using Self = March;
   const auto number_of = [](auto member) // of each increment
   { return [member](const Self &self) { return array(self.each(member)); }; };
   nb::class_<Self> report(m, "MarchReport",
                           "The result of a march: `state` at its end, arrays with an entry "
                           "for each increment, and loops for each cycle.");
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
               all[nb::cast(self.loads[l])] = self.state.multipliers[static_cast<Index>(l)];
            }
            return all;
         },
         nb::sig("def loads(self) -> dict[str, float]"), "multipliers at the end, by name")
      .def_prop_ro(
         "states",
         [](Self &self)
         {
            return references(
               self, self.states, [](ContactState & at) -> auto & { return at; });
         },
         nb::sig("def states(self) -> list[ContactState]"),
         "of each increment, if keep_states was True")
      .def_prop_ro(
         "interfaces",
         [](const Self &self)
         {
            nb::dict all;
            for (const InterfaceMarch &each : self.interfaces)
            {
               all[nb::cast(each.name)] = nb::cast(InterfaceMarch(each));
            }
            return all;
         },
         nb::sig("def interfaces(self) -> dict[str, InterfaceMarch]"),
         "by name, in the order of their nodes: forces, slip and numbers of nodes of each; "
         "empty in reports that are made of states alone")
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
         "displacement of a force, reaction of a displacement, by the name of the load, per "
         "unit of its multiplier: multiplier times conjugate is work. Divided by the value of "
         "LoadPattern.size, where that is known, they are in the units of the problem.")
      .def_prop_ro("stick", number_of(&IncrementRecord::stick),
                   "number of nodes, of all interfaces together, as the next three")
      .def_prop_ro("separation", number_of(&IncrementRecord::separation))
      .def_prop_ro("forward_slip", number_of(&IncrementRecord::forward_slip))
      .def_prop_ro("backward_slip", number_of(&IncrementRecord::backward_slip))
      .def_prop_ro("slip", number_of(&IncrementRecord::slip),
                   "with two tangential components: nodes that slip")
      .def_prop_ro("dissipation", number_of(&IncrementRecord::dissipation),
                   "lost by friction in each increment, ½ f (p₀ + p₁)|Δv|: what wears")
      .def_prop_ro("friction_work", number_of(&IncrementRecord::friction_work),
                   "-½(q₀ + q₁)·Δv of each increment, which balances the energy")
      .def_prop_ro("external_work", number_of(&IncrementRecord::external_work))
      .def_prop_ro(
         "found_by",
         [](const Self &self)
         {
            std::vector<std::string> all;
            for (const IncrementRecord &each : self.report.increments)
            {
               all.emplace_back(each.found_by);
            }
            return all;
         },
         "the method that found each increment: 'event path', 'active set', 'Lemke', …")
      .def_prop_ro("event", number_of(&IncrementRecord::event),
                   "with every_event: node that comes to the boundary of its state where the "
                   "increment ends, counted from 0; -1: there is none")
      .def_prop_ro("cycles",
                   [](const Self &self)
                   {
                      std::vector<Cycle> all;
                      for (const CycleRecord &each : self.report.cycles)
                      {
                         all.push_back({each, self.loads});
                      }
                      return all;
                   })
      .def_prop_ro("changes", copied(&Self::report, &MarchReport::changes),
                   "with every_event: the changes of state in the order of the path")
      .def_prop_ro("events", copied(&Self::report, &MarchReport::events),
                   "number of changes of state on an exact path")
      .def_prop_ro("event_time", copied(&Self::report, &MarchReport::event_time),
                   "if the outcome is not 'converged': the time at which it occurred")
      .def_prop_ro("event_multipliers", copied(&Self::report, &MarchReport::event_multipliers))
      .def_prop_ro("steady_cycle", copied(&Self::report, &MarchReport::steady_cycle),
                   "0: not reached")
      .def_prop_ro("steady_period", copied(&Self::report, &MarchReport::steady_period))
      .def_prop_ro(
         "loss_error", [](const Self &self) { return self.report.loss_error.value; },
         "error of the loss, of the whole march or of one cycle, compared with the exact path; "
         "nan: not known")
      .def_prop_ro(
         "loss_error_is",
         [](const Self &self) { return self.report.loss_error.bound ? "bound" : "estimate"; },
         "'bound' if a second march followed the exact path, else 'estimate'")
      .def_prop_ro(
         "loss_error_by",
         [](const Self &self)
         {
            const LossError &error = self.report.loss_error;
            const bool asked = !error.by.empty() || !std::isnan(error.value);
            return asked ? error.by : "it was not requested: MarchSettings.loss_error";
         },
         "what was marched for comparison, or why the error is not known")
      .def_prop_ro(
         "extrapolated_loss",
         [](const Self &self) { return self.report.loss_error.extrapolated; },
         "loss of this march without increments, where the changes from march to march fall in "
         "one ratio; nan: they do not, or it was not requested")
      .def_prop_ro(
         "energy_imbalance", copied(&Self::report, &MarchReport::energy_imbalance),
         "balance of the energies, relative; of second order in the increments, so that it is "
         "no "
         "measure of loss_error")
      .def_prop_ro("advance_error", copied(&Self::report, &MarchReport::advance_error),
                   "estimate, of friction forces where contact advances in increments")
      .def_prop_ro("largest_residual", copied(&Self::report, &MarchReport::largest_residual))
      .def_prop_ro("taken_up_clearance",
                   copied(&Self::report, &MarchReport::taken_up_clearance))
      .def_prop_ro("fallbacks", copied(&Self::report, &MarchReport::fallbacks),
                   "increments taken because there was no exact path")
      .def_prop_ro("seconds", copied(&Self::report, &MarchReport::seconds))
      .def_prop_ro("counters", copied(&Self::report, &MarchReport::counters))
      .def(
         "plot",
         [](nb::object self, nb::args positional, nb::kwargs named) {
            return nb::module_::import_("cattaneo._plot")
               .attr("march")(self, *positional, **named);
         },
         nb::sig("def plot(self, axes: typing.Any = None) -> typing.Any"),
         "Tractions and slip at the end along the line of each interface, and the loop of each "
         "load that varies; needs matplotlib. axes: as many as there are figures, None for new "
         "ones. Returns them.")
      .def("__repr__", &brief);

   MarchSettings told; // unless they are given
   told.loss_error = true;
   m.def(
      "march", &march_from, arg("problem"), arg("history"), arg("state") = nb::none(),
      nb::kw_only(), arg("settings") = told, arg("keep_states") = false,
      arg("observer") = nb::none(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "Marches a contact along a load history, from rest or from `state`, which is not "
      "changed.\n\n"
      "problem: the contact, which is not changed either.\n"
      "history: points, [{}, {'P': 1}, {'Q': 0.2}], the first of which has the loads of the "
      "state; a load that a point does not name keeps its value. Or a LoadHistory, which has "
      "its own times: to continue a march that was stopped, pass the same history and its last "
      "state.\n"
      "settings: how it is marched. Given settings also decide whether the error of the loss "
      "is estimated (loss_error). Members may be given by their names alone, as increments=40, "
      "also those of "
      "settings within.\n"
      "keep_states: keeps the state of every increment. observer: is called with each.\n"
      "progress: True shows a line on stderr; a function is called with Progress. Other "
      "threads run meanwhile; Ctrl-C raises KeyboardInterrupt, and `stop`, a threading.Event, "
      "ends the march with status 'stopped' and the results so far.\n\n"
      "There is a warning (OutcomeWarning) for an outcome other than 'converged'. The report "
      "has it as well.");
   using Joint = BoltedJoint;
   nb::class_<Joint>(
      m, "BoltedJoint",
      "Bolts that a load history tightens, each to a force. Before that a bolt does nothing, "
      "afterwards it is a spring. Each loses force while others are tightened.")
      .def(
         "__init__",
         [](Joint *self, const Reduction &loose, const NamedLoads &bolts)
         {
            std::vector<Bolt> all;
            for (const auto &[load, stiffness] : bolts) { all.push_back({load, stiffness}); }
            new (self) Joint(loose, std::move(all));
         },
         arg("loose"), arg("bolts"),
         "loose: the reduction of all bodies, its gaps and friction set, in which the load of "
         "each bolt consists of opposite forces on its two ends.\n"
         "bolts: the stiffness of each, force over displacement of a load whose forces add up "
         "to 1 on either end; of F in their place stiffness / F².")
      .def_prop_ro(
         "problem", [](const Joint &self) -> const ReducedProblem & { return self.problem(); },
         nb::rv_policy::reference_internal, "with all bolts as springs: states are of this")
      .def("tightened", &Joint::tightened,
           "The reduction with all bolts as springs, for fields.")
      .def(
         "forces",
         [](const Joint &self, const ContactState &state)
         {
            const Eigen::VectorXd forces = self.forces(state);
            nb::dict all;
            for (std::size_t b = 0; b < self.bolts().size(); ++b)
            {
               all[nb::cast(self.bolts()[b].load)] = forces[static_cast<Index>(b)];
            }
            return all;
         },
         arg("state"), nb::sig("def forces(self, state: ContactState) -> dict[str, float]"),
         "The force of each bolt in a state of `problem`, by its name, in units of the forces "
         "of its load; pulling is positive.")
      .def("march", &march_with_bolts, arg("history"), arg("state") = nb::none(), nb::kw_only(),
           arg("settings") = told, arg("keep_states") = false, arg("observer") = nb::none(),
           arg("progress") = false, arg("stop") = nb::none(), arg("members"),
           "As march(), whose arguments these are.\n\n"
           "history: a point that names a bolt's load tightens the bolt, and the multiplier is "
           "its force then; a point that names it again tightens it again. In states the "
           "multiplier is its pretension. The march ends with status 'stopped' where the force "
           "of a bolt has fallen to zero and would turn into compression.\n"
           "state: of `problem`, where the march begins; None: before any load.\n"
           "settings, keep_states, observer, progress, stop: as for march().")
      .def("__repr__",
           [](const Joint &self)
           {
              std::vector<std::string> names;
              for (const Bolt &bolt : self.bolts()) { names.push_back("'" + bolt.load + "'"); }
              return "<BoltedJoint: " + listed(names) + ">";
           });
   m.def(
      "conjugates",
      [](const ReducedProblem &problem, const ContactState &state)
      { return array(conjugates(problem, state)); },
      arg("problem"), arg("state"),
      "Conjugate of each load in a state of a problem, with which its multiplier does work, in "
      "the order of "
      "problem.loads: displacement of a force, along it, reaction of a prescribed "
      "displacement, pushing along it.");
}

} // namespace cattaneo::python
