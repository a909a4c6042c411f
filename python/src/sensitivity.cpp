#include "sensitivity.hpp"
#include "settings.hpp"

#include "arrays.hpp"
#include "marches.hpp"
#include "members.hpp"
#include "watch.hpp"
#include <mutex>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Derivatives of the results of a march.

namespace cattaneo::python
{

void Trace::check(const ReducedProblem &of) const
{
   const auto same =
      [](const char *what, const Eigen::VectorXd &now, const Eigen::VectorXd &then)
   {
      require(now.size() == then.size(), "trace: the problem has ", now.size(),
              " nodes, and had ", then.size(), " when it was marched");
      for (Index i = 0; i < now.size(); ++i)
      {
         require(now[i] == then[i], "trace: ", what, "[", i, "] of the problem is ", now[i],
                 ", and was ", then[i], " when it was marched; march it anew");
      }
   };
   same("friction", of.friction, friction);
   same("gap", of.gap, gap);
}

namespace
{

/// Derivatives by the entries of a state, by their names.
using Weights = std::map<std::size_t, std::map<std::string, Numbers>>;
/// A plain number does not depend on the states.
using ResponseLike = std::variant<Response, double>;

/// Sensitivity with its problem and trace, for one thread at a time.
struct Derivatives
{
   std::unique_ptr<const ReducedProblem> problem;
   nb::object trace;
   std::unique_ptr<Sensitivity> of;
   std::unique_ptr<std::mutex> turn = std::make_unique<std::mutex>();

   template <class Work>
   auto work(Work &&work)
   {
      return unlocked(
         [&]
         {
            const std::lock_guard<std::mutex> lock(*turn);
            return work(*of);
         });
   }
   /// The same, and Ctrl-C ends it.
   template <class Work>
   auto watched(const char *name, Work &&from)
   {
      Watch watch(nb::bool_(false), nb::none());
      const Monitor monitor = watch.monitor();
      auto result = work([&](Sensitivity &all) { return from(all, monitor); });
      if (!result.found)
      {
         warn(std::string(name) + ": the derivative could not be computed: " + result.message);
      }
      return result;
   }
};

constexpr std::pair<const char *, Eigen::VectorXd StateWeights::*> weight_names[] = {
   {"displacements", &StateWeights::displacements},
   {"forces", &StateWeights::forces},
   {"multipliers", &StateWeights::multipliers},
   {"conjugates", &StateWeights::conjugates},
   {"loss", &StateWeights::loss},
   {"worn", &StateWeights::worn}};

Response response_of(double value, const Weights &weights)
{
   Response response;
   response.value = finite(value, "value");
   std::vector<std::string> names;
   for (const auto &[each, member] : weight_names) { names.emplace_back(each); }
   for (const auto &[state, parts] : weights)
   {
      const std::string what = "weights[" + std::to_string(state) + "]";
      for (const auto &[key, values] : parts)
      {
         const auto part = weight_names[choice(key, "a name in " + what, names)];
         response.weights[state].*part.second = vector(values, what + "['" + key + "']");
      }
   }
   return response;
}

Response operand(const ResponseLike &other)
{
   if (const auto *response = std::get_if<Response>(&other)) { return *response; }
   Response constant;
   constant.value = finite(std::get<double>(other), "other");
   return constant;
}

/// Sums and products keep their order.
template <class Operation>
auto left(Operation operation)
{
   return [operation](const Response &self, ResponseLike other)
   { return operation(self, operand(other)); };
}
template <class Operation>
auto right(Operation operation)
{
   return [operation](const Response &self, ResponseLike other)
   { return operation(operand(other), self); };
}

void bind_trace(nb::module_ &m)
{
   nb::class_<Tie>(m, "Tie",
                   "A node that meets the laws of two states at the end of an increment. "
                   "Derivatives there are one-sided, and belong to the state `taken`.")
      .def_ro("state", &Tie::state, "of the trace")
      .def_ro("node", &Tie::node)
      .def_ro("taken", &Tie::taken, "state that the trace has")
      .def_ro("other", &Tie::other, "other state that obeys the laws as well")
      .def("__repr__",
           [](const Tie &self)
           {
              std::ostringstream text;

              text << "<Tie of node " << self.node << " in state " << self.state << ": "
                   << name(self.taken) << " or " << name(self.other) << ">";
              return text.str();
           });

   using Self = Trace;
   const auto each = [](auto value)
   {
      return [value](const Self &self)
      {
         Eigen::VectorXd all(self.trace.states.size());
         for (Index k = 0; k < all.size(); ++k)
         {
            all[k] = static_cast<double>(self.trace.states[k].*value);
         }
         return array(std::move(all));
      };
   };
   nb::class_<Self>(m, "MarchTrace",
                    "All states of a march, from which derivatives are computed.")
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> cattaneo._core.ReducedProblem"))
      .def_prop_ro("history", [](const Self &self) { return self.trace.history; })
      .def_prop_ro(
         "states",
         [](Self &self) { return references(self, self.trace.states, &TracedState::state); },
         nb::sig("def states(self) -> list[cattaneo._core.ContactState]"),
         "the first is the one at the start")
      .def_prop_ro("point", each(&TracedState::point),
                   "number of the point of the history after which each state lies, from 0")
      .def_prop_ro("share", each(&TracedState::share),
                   "share of the path to the next point, 0 to 1")
      .def_prop_ro(
         "event", each(&TracedState::event),
         "node whose change of state determines the share; -1: the history determines it")
      .def_prop_ro(
         "report",
         [](const Self &self)
         {
            return march_report(nb::cast<const ReducedProblem &>(self.problem),
                                self.trace.report, self.trace.states.back().state);
         },
         nb::sig("def report(self) -> cattaneo._core.MarchReport"))
      .def(
         "at",
         [](const Self &self, double time) { return self.trace.at(finite(time, "time")); },
         arg("time"),
         "Index of the last state that was reached not later than a time of the history.")
      .def(
         "last", [](const Self &self) { return self.trace.last(); }, "Index of the last state.")
      .def(
         "other_side",
         [](const Self &self, const std::vector<Tie> &ties)
         {
            Self result = self;
            for (const Tie &tie : ties)
            {
               auto &states = result.trace.states;
               require(tie.state < states.size() &&
                          tie.node < static_cast<Index>(states[tie.state].state.status.size()),
                       "ties: state ", tie.state, ", node ", tie.node,
                       " is not one of the trace");
               if (tie.state == 0)
               {
                  warn("other_side: the derivative on the other side of node " +
                       std::to_string(tie.node) +
                       " (at the start) belongs to another path, which this trace does not "
                       "contain: trace a march in which this node has a slightly larger gap");
               }
               states[tie.state].state.status[tie.node] = tie.other;
            }
            return result;
         },
         arg("ties"),
         "The same trace with the other state of some ties, whose derivatives are those of the "
         "other side.")
      .def("__len__", [](const Self &self) { return self.trace.states.size(); })
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;

              text << "<MarchTrace of " << self.trace.states.size()
                   << " states: " << name(self.trace.report.status) << ">";
              return text.str();
           });
   m.def(
      "trace_march",
      [](const ReducedProblem &problem, const History &history, const ContactState *state,
         MarchSettings settings, const ProgressLike &progress, const StopLike &stop,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         const ReducedProblem copy = problem;
         ContactState from = state_or_rest(copy, state);
         const LoadHistory loads = history_from(copy, history, from);
         Watch watch(progress, stop);
         settings.monitor = watch.monitor();
         Trace trace(problem,
                     unlocked([&] { return trace_march(copy, loads, from, settings); }));
         warn_of("trace_march", trace.trace.report);
         return trace;
      },
      arg("problem"), arg("history"), arg("state") = nb::none(), nb::kw_only(),
      arg("settings") = MarchSettings(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "Like march(), but keeps all states. A state at the start must be given, or the contact "
      "is at rest.");
   m.def(
      "trace_wear",
      [](const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
         double cycles, const WearState *state, WearSettings settings,
         const ProgressLike &progress, const StopLike &stop, const nb::kwargs &members)
      {
         set_members(settings, members);
         const ReducedProblem copy = problem;
         const WearLaw by = law;
         const LoadHistory loads = history;
         finite(cycles, "cycles");
         WearState from = state ? *state : WearState::virgin(copy);
         Watch watch(progress, stop);
         settings.march.monitor = watch.monitor();
         Trace trace(
            problem,
            unlocked([&] { return trace_wear(copy, by, loads, cycles, from, settings); }));
         warn_of("trace_wear", trace.trace.report);
         return trace;
      },
      arg("problem"), arg("law"), arg("history"), arg("cycles"), arg("state") = nb::none(),
      nb::kw_only(), arg("settings") = WearSettings(), arg("progress") = false,
      arg("stop") = nb::none(), arg("members"),
      "Like wear.wear() with every cycle marched, but keeps the states of all increments. "
      "Times increase from cycle to cycle.");
   m.def(
      "ties",
      [](const ReducedProblem &problem, const Self &trace, double tolerance)
      {
         trace.check(problem);
         return ties(problem, trace.trace, finite(tolerance, "tolerance"));
      },
      arg("problem"), arg("trace"), arg("tolerance") = 1e-9,
      "All ties of a trace, within `tolerance` of the largest nodal force so far.");
}

void bind_responses(nb::module_ &m)
{
   using R = Response;
   const auto plus = [](const R &a, const R &b) { return a + b; };
   const auto minus = [](const R &a, const R &b) { return a - b; };
   const auto times = [](const R &a, const R &b) { return a * b; };
   const auto over = [](const R &a, const R &b) { return a / b; };
   nb::class_<R>(m, "Response",
                 "A number that a march returned, with its derivatives by the states of the "
                 "trace. + - * / combine responses.")
      .def(
         "__init__",
         [](R *self, double value, const Weights &weights)
         { new (self) R(response_of(value, weights)); },
         arg("value"), arg("weights"),
         "weights: by the index of a state, derivatives by its entries: 'displacements' {v; "
         "w}, "
         "'forces' {q; p}, 'multipliers', 'conjugates', 'loss' of each node over the increment "
         "that ends in the state, 'worn' of the depth that it wears off.")
      .def_ro("value", &R::value)
      .def_prop_ro(
         "weights",
         [](const R &self)
         {
            nb::dict all;
            for (const auto &[k, weight] : self.weights)
            {
               nb::dict parts;
               for (const auto &[each, member] : weight_names)
               {
                  if ((weight.*member).size() > 0) { parts[each] = array(weight.*member); }
               }
               all[nb::cast(k)] = parts;
            }
            return all;
         },
         nb::sig("def weights(self) -> dict[int, dict[str, "
                 "numpy.typing.NDArray[numpy.float64]]]"))
      .def("__float__", [](const R &self) { return self.value; })
      .def("__add__", left(plus))
      .def("__radd__", left(plus))
      .def("__sub__", left(minus))
      .def("__rsub__", right(minus))
      .def("__mul__", left(times))
      .def("__rmul__", left(times))
      .def("__truediv__", left(over))
      .def("__rtruediv__", right(over))
      .def("__neg__", [](const R &self) { return -1 * self; })
      .def("__repr__",
           [](const R &self)
           {
              std::ostringstream text;

              text << "<Response " << self.value << " of " << self.weights.size() << " states>";
              return text.str();
           });

   using Self = Asked;
   // Responses refuses numbers of nodes or components that do not exist.
   const auto of_node = [](auto member)
   {
      return [member](const Self &self, std::size_t state, Index node)
      { return ((*self).*member)(state, node); };
   };
   const auto of_component = [](auto member)
   {
      return [member](const Self &self, std::size_t state, Index node, int component)
      { return ((*self).*member)(state, node, component); };
   };
   const auto of_pattern = [](auto member)
   {
      return [member](const Self &self, std::size_t state, const std::string &pattern)
      { return ((*self).*member)(state, pattern); };
   };
   const auto arms = [](nb::handle arm)
   { return arm.is_none() ? Eigen::VectorXd() : vector(arm, "arm"); };
   nb::class_<Self>(m, "Responses",
                    "The numbers of a trace. States are given by their index in it, "
                    "MarchTrace.at(time) or last().")
      .def(
         "__init__",
         [](Self *self, const ReducedProblem &problem, const Trace &trace)
         { new (self) Self(problem, trace); },
         arg("problem"), arg("trace"))
      .def(
         "dissipation",
         [](const Self &self, std::size_t from, std::size_t to, std::optional<Index> node) {
            return node ? (*self).dissipation(from, to, *node) : (*self).dissipation(from, to);
         },
         arg("from_"), arg("to"), arg("node") = nb::none(),
         "Energy lost by friction between two states, at all nodes or at one.")
      .def(
         "worn_depth",
         [](const Self &self, std::size_t from, std::size_t to, Index node)
         { return (*self).worn_depth(from, to, node); },
         arg("from_"), arg("to"), arg("node"),
         "Depth that a node loses between two states of trace_wear().")
      .def(
         "worn_volume",
         [](const Self &self, std::size_t from, std::size_t to)
         { return (*self).worn_volume(from, to); },
         arg("from_"), arg("to"),
         "Volume worn off at all nodes between two states of trace_wear().")
      .def("slip", of_component(&Responses::slip), arg("state"), arg("node"),
           arg("component") = 0)
      .def("opening", of_node(&Responses::opening), arg("state"), arg("node"),
           "w of a node, without the gap")
      .def("shear", of_component(&Responses::shear), arg("state"), arg("node"),
           arg("component") = 0, "q of the node")
      .def("normal_force", of_node(&Responses::normal_force), arg("state"), arg("node"),
           "p of the node, compression positive")
      .def("pressure", of_node(&Responses::pressure), arg("state"), arg("node"),
           "normal force over weight")
      .def(
         "peak_pressure",
         [](const Self &self, std::size_t state) { return (*self).peak_pressure(state); },
         arg("state"), "largest pressure of all nodes (of several equal ones the first)")
      .def(
         "shear_resultant",
         [arms](const Self &self, std::size_t state, Numbers arm, int component)
         { return (*self).shear_resultant(state, arms(arm), component); },
         arg("state"), arg("arm") = nb::none(), arg("component") = 0,
         "sum of q times the lever arm of each node, (n,); without arms the tangential force")
      .def(
         "normal_resultant",
         [arms](const Self &self, std::size_t state, Numbers arm)
         { return (*self).normal_resultant(state, arms(arm)); },
         arg("state"), arg("arm") = nb::none(),
         "sum of p times the lever arm of each node, (n,); without arms the normal force")
      .def("multiplier", of_pattern(&Responses::multiplier), arg("state"), arg("pattern"))
      .def("conjugate", of_pattern(&Responses::conjugate), arg("state"), arg("pattern"),
           "the displacement of a force, or the reaction of a displacement")
      .def(
         "secant_stiffness",
         [](const Self &self, std::size_t from, std::size_t to, const std::string &pattern)
         { return (*self).secant_stiffness(from, to, pattern); },
         arg("from_"), arg("to"), arg("pattern"),
         "change of force over change of displacement between two states");
}

void bind_parameters(nb::module_ &m)
{
   nb::class_<StiffnessChange>(
      m, "StiffnessChange",
      "Change of stiffness and loads by a number in which they are linear, such as a modulus.")
      .def(
         "__init__",
         [](StiffnessChange *self, Numbers K, Numbers loads, Numbers H)
         {
            StiffnessChange change{matrix(K, "K"), {}, {}};
            if (!loads.is_none()) { change.loads = matrix(loads, "loads"); }
            if (!H.is_none()) { change.H = matrix(H, "H"); }
            new (self) StiffnessChange(std::move(change));
         },
         arg("K"), arg("loads") = nb::none(), arg("H") = nb::none(),
         "K: change of ReducedProblem.K. loads: change of the forces {q; p} of each pattern, a "
         "column each. H: change of ReducedProblem.H.")
      .def_prop_ro("K", viewed(&StiffnessChange::K))
      .def_prop_ro("loads", viewed(&StiffnessChange::loads))
      .def_prop_ro("H", viewed(&StiffnessChange::H));
   m.def("stiffness_scale", &stiffness_scale, arg("problem"),
         "The change if all stiffnesses of a problem are multiplied by the same factor, per "
         "unit of this factor.");

   using Self = Parameters;
   nb::class_<Self>(m, "Parameters",
                    "A number for each parameter of a march: its change, or the derivative of "
                    "a response by it. No entries: no change.")
      .def(
         "__init__",
         [](Self *self, Numbers friction, Numbers gap, Numbers multipliers, Numbers stiffness,
            Numbers wear)
         {
            Self made;
            if (!wear.is_none()) { made.wear = vector(wear, "wear"); }
            if (!friction.is_none()) { made.friction = vector(friction, "friction"); }
            if (!gap.is_none()) { made.gap = vector(gap, "gap"); }
            if (!multipliers.is_none())
            {
               made.multipliers = matrix(multipliers, "multipliers");
            }
            if (!stiffness.is_none()) { made.stiffness = vector(stiffness, "stiffness"); }
            new (self) Self(std::move(made));
         },
         arg("friction") = nb::none(), arg("gap") = nb::none(), arg("multipliers") = nb::none(),
         arg("stiffness") = nb::none(), arg("wear") = nb::none(),
         "friction, gap: (n,), of each node. multipliers: (loads, points), of LoadHistory. "
         "stiffness: a number for each StiffnessChange. wear: (n,), of Archard's k of each "
         "node.")
      .def_prop_ro("friction", viewed(&Self::friction), "of each node")
      .def_prop_ro("gap", viewed(&Self::gap), "of each node")
      .def_prop_ro("multipliers", viewed(&Self::multipliers), "(loads, points)")
      .def_prop_ro("stiffness", viewed(&Self::stiffness), "of each StiffnessChange")
      .def_prop_ro("wear", viewed(&Self::wear), "of Archard's k of each node")
      .def(
         "dot", [](const Self &self, const Self &change) { return self.dot(change); },
         arg("change"), "Sum of derivative times change, over the parameters that both have.");
}

} // namespace

void bind_sensitivity(nb::module_ &m)
{
   bind_trace(m);
   bind_responses(m);
   bind_parameters(m);

   nb::class_<Gradient>(m, "Gradient", "Derivatives of a response, if they are known.")
      .def_ro("found", &Gradient::found)
      .def_ro("message", &Gradient::message, "why not")
      .def_prop_ro(
         "by", [](Gradient &self) -> Parameters & { return self.by; },
         nb::rv_policy::reference_internal, "derivative by each parameter");
   nb::class_<TraceChange>(m, "TraceChange",
                           "Changes of all states of a trace with one change of parameters, a "
                           "column for each state.")
      .def_ro("found", &TraceChange::found)
      .def_ro("message", &TraceChange::message, "why not")
      .def_prop_ro("displacements", viewed(&TraceChange::displacements), "of {v; w}")
      .def_prop_ro("forces", viewed(&TraceChange::forces), "of {q; p}")
      .def_prop_ro("multipliers", viewed(&TraceChange::multipliers), "of the load patterns")
      .def_prop_ro("conjugates", viewed(&TraceChange::conjugates), "of these")
      .def_prop_ro("loss", viewed(&TraceChange::loss),
                   "of each node over the increment that ends in the state")
      .def_prop_ro("worn", viewed(&TraceChange::worn),
                   "of the depth that it wears off; no columns: nothing wears")
      .def(
         "of",
         [](const TraceChange &self, const Response &response) { return self.of(response); },
         arg("response"), "Derivative of a response along the change.");

   using Self = Derivatives;
   nb::class_<Self>(m, "Sensitivity",
                    "Derivatives of the results of a march by its parameters. They are exact "
                    "in the discrete problem, with the states that its nodes had. If a node "
                    "meets the laws of two states they are one-sided, see ties().")
      .def(
         "__init__",
         [](Self *self, const ReducedProblem &problem, const Trace &trace,
            std::vector<StiffnessChange> stiffness)
         {
            trace.check(problem);
            Self made;
            made.problem = std::make_unique<const ReducedProblem>(problem);
            made.trace = nb::find(trace);
            made.of =
               std::make_unique<Sensitivity>(*made.problem, trace.trace, std::move(stiffness));
            new (self) Self(std::move(made));
         },
         arg("problem"), arg("trace"), arg("stiffness") = nb::tuple(),
         "problem: as it was marched. stiffness: changes of the stiffness for which "
         "derivatives are computed too.")
      .def(
         "gradient",
         [](Self &self, const Response &response)
         {
            const Response of = response;
            return self.watched("gradient", [&](Sensitivity &all, const Monitor &monitor)
                                { return all.gradient(of, monitor); });
         },
         arg("response"),
         "Derivatives of one response by all parameters, computed backwards through the march. "
         "If they are "
         "not known there is a warning (OutcomeWarning). Ctrl-C ends it.")
      .def(
         "along",
         [](Self &self, const Parameters &change)
         {
            const Parameters of = change;
            return self.watched("along", [&](Sensitivity &all, const Monitor &monitor)
                                { return all.along(of, monitor); });
         },
         arg("change"),
         "Derivatives of all states along one change of parameters, computed forwards through "
         "the march. "
         "If they are not known there is a warning (OutcomeWarning). Ctrl-C ends it.")
      .def(
         "factorisations",
         [](Self &self)
         { return self.work([](Sensitivity &all) { return all.factorisations(); }); },
         "Number of dense factorisations so far.")
      .def(
         "updates",
         [](Self &self) { return self.work([](Sensitivity &all) { return all.updates(); }); },
         "How often an unknown was bordered to a factor so far.");
}

} // namespace cattaneo::python
