#include "arrays.hpp"
#include "marches.hpp"
#include "module.hpp"
#include "sensitivity.hpp"
#include "watch.hpp"
#include <cattaneo/design/design.hpp>
#include <limits>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <sstream>

// Designs, and the derivatives that they are found by.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(MaybeNumbers, "None | numpy.typing.ArrayLike");
CATTANEO_ARGUMENT(MaybeNumber, "None | float");
CATTANEO_ARGUMENT(Cases, "collections.abc.Sequence[DesignCase]");
CATTANEO_ARGUMENT(Variables, "numpy.typing.ArrayLike | collections.abc.Sequence[Parameters]");
CATTANEO_ARGUMENT(Shape, "None | collections.abc.Callable[[numpy.ndarray], "
                         "tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike]]");
CATTANEO_ARGUMENT(Objective, "None | collections.abc.Callable[[Responses, list[int]], "
                             "collections.abc.Sequence[Response]]");

constexpr int most = std::numeric_limits<int>::max();

/// A problem to choose for. Python's functions are called where C++'s would be.
struct Wanted
{
   DesignProblem problem;
   nb::object objective, shape;
};

/// What a search came to, and the problem that was designed.
struct Found
{
   DesignReport report;
   nb::object problem;
   nb::list traces;
};

/// Variables as Parameters, or as columns that are added to the gap.
std::vector<Parameters> variables_of(nb::handle variables, Index nodes)
{
   const bool listed =
      nb::isinstance<nb::list>(variables) || nb::isinstance<nb::tuple>(variables);
   if (!listed || nb::len(variables) == 0 || !nb::isinstance<Parameters>(variables[0]))
   {
      return gap_variables(matrix(variables, "variables", nodes));
   }
   std::vector<Parameters> all;
   for (const nb::object &each : sequence(variables, "variables"))
   {
      all.push_back(given<Parameters>(each, "variables[" + std::to_string(all.size()) + "]"));
   }
   return all;
}

/// Calls Python's shape for C++.
Eigen::VectorXd shaped(nb::handle shape, const Eigen::VectorXd &x, Eigen::MatrixXd &by)
{
   const nb::gil_scoped_acquire lock;
   const std::vector<nb::object> answer = sequence(shape(array(x)), "what the shape returned");
   require(answer.size() == 2, "what the shape returned has ", answer.size(),
           " entries, must be two: gaps of the nodes, and their derivatives by each variable");
   by = matrix(answer[1], "derivatives of the shape", by.rows(), by.cols());
   return vector(answer[0], "gaps of the shape", by.rows());
}

Wanted wanted(const ReducedProblem &problem, nb::handle cases, nb::handle variables,
              nb::handle low, nb::handle high, nb::handle limits, nb::handle least,
              nb::handle upper, nb::handle goal, nb::handle objective, nb::handle shape)
{
   Wanted result;
   DesignProblem &of = result.problem;
   of.problem = problem;
   for (const nb::object &each : sequence(cases, "cases"))
   {
      of.cases.push_back(
         given<DesignCase>(each, "cases[" + std::to_string(of.cases.size()) + "]"));
   }
   of.variables = variables_of(variables, problem.nodes());
   const auto count = static_cast<Index>(of.variables.size());
   of.low = vector_or_number(low, "low", count);
   of.high = vector_or_number(high, "high", count);
   if (!limits.is_none()) { of.limits = matrix(limits, "limits", -1, count); }
   const double infinity = std::numeric_limits<double>::infinity();
   const Index rows = of.limits.rows();
   of.least = least.is_none() ? Eigen::VectorXd(Eigen::VectorXd::Constant(rows, -infinity))
                              : bounds(least, "least", rows);
   of.most = upper.is_none() ? Eigen::VectorXd(Eigen::VectorXd::Constant(rows, infinity))
                             : bounds(upper, "most", rows);
   of.goal = chosen<DesignGoal>(goal, "goal", {"least_largest", "least_sum"});
   const auto function = [](nb::handle given, const char *name)
   {
      if (!given.is_none() && PyCallable_Check(given.ptr()) == 0)
      {
         refuse(given, name, "a function or None");
      }
      return nb::borrow(given);
   };
   result.objective = function(objective, "objective");
   result.shape = function(shape, "shape");
   if (!shape.is_none())
   {
      of.shape = [shape](const Eigen::VectorXd &x, Eigen::MatrixXd &by)
      { return shaped(shape, x, by); };
   }
   // It decides what must be known of the problem.
   if (!objective.is_none())
   {
      of.objective = [](const Responses &, const std::vector<std::size_t> &)
      { return std::vector<Response>(); };
   }
   of.validate();
   return result;
}

/// Calls Python's objective for C++.
std::vector<Response> ask(nb::handle objective, const Responses &of,
                          const std::vector<std::size_t> &states)
{
   const nb::gil_scoped_acquire lock;
   nb::object asked = nb::cast(Asked(of));
   std::vector<Response> all;
   nb::list of_states;
   for (std::size_t k : states) { of_states.append(k); }
   // What it is asked of ends with the call, whoever keeps it.
   struct End
   {
      nb::handle asked;
      ~End() { nb::inst_ptr<Asked>(asked)->end(); }
   } const end{asked};
   const nb::object answer = objective(asked, of_states);
   for (const nb::object &each : sequence(answer, "what the objective returned"))
   {
      const std::string what = "response " + std::to_string(all.size()) + " of the objective";
      all.push_back(given<Response>(each, what));
   }
   return all;
}

Found found(const Wanted &wanted, const Eigen::VectorXd &start, DesignSettings settings,
            nb::handle progress, nb::handle stop)
{
   DesignProblem copy = wanted.problem;
   const nb::object objective = wanted.objective;
   if (!objective.is_none())
   {
      copy.objective = [asked = nb::handle(objective)](const Responses &of,
                                                       const std::vector<std::size_t> &states)
      { return ask(asked, of, states); };
   }
   Watch watch(progress, stop);
   settings.march.monitor = watch.monitor();
   Found result;
   result.report = one_at_a_time([&] { return design(copy, start, settings); });
   DesignReport &report = result.report;
   result.problem = nb::cast(copy.with(report.x));
   for (MarchTrace &trace : report.traces)
   {
      warn_of("design, case '" + copy.cases[result.traces.size()].name + "'", trace.report);
      result.traces.append(nb::cast(Trace(result.problem, std::move(trace))));
   }
   report.traces.clear();
   if (report.status != DesignStatus::optimal && report.status != DesignStatus::stopped)
   {
      warn(std::string("design: ") + name(report.status) + ": " + report.message);
   }
   return result;
}

void bind_problem(nb::module_ &m)
{
   nb::class_<DesignCase>(m, "DesignCase",
                          "Loads that a design has to do with: a march from before any load.")
      .def(
         "__init__",
         [](DesignCase *self, Text name, Of<LoadHistory> history, Number weight,
            MaybeNumber from)
         {
            const double since = from.is_none() ? std::numeric_limits<double>::quiet_NaN()
                                                : number(from, "from_");
            new (self) DesignCase{text(name, "name"), given(history, "history"),
                                  number(weight, "weight"), since};
         },
         arg("name"), arg("history"), arg("weight") = 1.0, arg("from_") = nb::none(),
         "name: in messages. weight: of what is asked of it; negative: as much of it as "
         "possible. from_: states at the points of the history are asked from this time on; "
         "None: the last alone.")
      .def_ro("name", &DesignCase::name)
      .def_ro("history", &DesignCase::history)
      .def_ro("weight", &DesignCase::weight)
      .def("__repr__",
           [](const DesignCase &self) {
              return "<DesignCase '" + self.name + "', weight " + exact_text(self.weight) + ">";
           });

   using Self = Wanted;
   nb::class_<Self>(
      m, "DesignProblem",
      "What may be chosen, and what for: variables x that add x[j] times a change "
      "of parameters to those of the problem, between bounds and under linear "
      "limits.")
      .def(
         "__init__",
         [](Self *self, Of<ReducedProblem> problem, Cases cases, Variables variables,
            Numbers low, Numbers high, MaybeNumbers limits, MaybeNumbers least,
            MaybeNumbers most, Text goal, Objective objective, Shape shape)
         {
            new (self) Self(wanted(given(problem, "problem"), cases, variables, low, high,
                                   limits, least, most, goal, objective, shape));
         },
         arg("problem"), arg("cases"), arg("variables"), arg("low"), arg("high"), nb::kw_only(),
         arg("limits") = nb::none(), arg("least") = nb::none(), arg("most") = nb::none(),
         arg("goal") = "least_largest", arg("objective") = nb::none(),
         arg("shape") = nb::none(),
         "problem: that of x = 0. variables: columns that are added to the gap, (n, number of "
         "variables), or a list of Parameters without stiffness. low, high: bounds of each, or "
         "one number. limits: a matrix L with a row a limit, least <= L x <= most, which may "
         "be "
         "infinite.\n"
         "objective: a function of Responses and the states that count, which returns a list "
         "of "
         "Response; None: the pressures of all nodes. goal: 'least_largest' or 'least_sum' of "
         "all responses of all cases, each times its case's weight. shape: a function of x "
         "that returns a gap that is added, (n,), and its derivatives, (n, number of "
         "variables); None: the gap is linear in x.")
      .def_prop_ro(
         "variables", [](const Self &self) { return self.problem.variables; },
         nb::sig("def variables(self) -> list[Parameters]"), "per unit of each")
      .def_prop_ro("low", [](const Self &self) { return array(self.problem.low); })
      .def_prop_ro("high", [](const Self &self) { return array(self.problem.high); })
      .def_prop_ro("limits", [](const Self &self) { return array(self.problem.limits); })
      .def_prop_ro("least", [](const Self &self) { return array(self.problem.least); })
      .def_prop_ro("most", [](const Self &self) { return array(self.problem.most); })
      .def(
         "with_",
         [](const Self &self, Numbers x)
         { return self.problem.with(vector(x, "x", self.problem.low.size())); },
         arg("x"), "The reduced problem of values x of the variables.")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<DesignProblem: " << self.problem.low.size() << " variables, "
                   << self.problem.limits.rows() << " limits, cases:";
              for (const DesignCase &each : self.problem.cases) { text << " " << each.name; }
              text << ">";
              return text.str();
           });
   m.def(
      "gap_variables", [](Numbers G) { return gap_variables(matrix(G, "G")); }, arg("G"),
      nb::sig("def gap_variables(G: numpy.typing.ArrayLike) -> list[Parameters]"),
      "Variables that are the columns of G, (n, number of variables), added to the gap.");
   m.def(
      "spread_starts",
      [](Of<Self> problem, Numbers start, Number count)
      {
         const DesignProblem &of = given(problem, "problem").problem;
         nb::list all;
         for (const Eigen::VectorXd &x :
              spread_starts(of, vector_or_number(start, "start", of.low.size()),
                            whole(count, "count", 0, most)))
         {
            all.append(array(x));
         }
         return all;
      },
      arg("problem"), arg("start"), arg("count"),
      nb::sig("def spread_starts(problem: DesignProblem, start: numpy.typing.ArrayLike, "
              "count: int) -> list[numpy.ndarray]"),
      "Other starts for a search: `count` points spread evenly over the box of the bounds, "
      "each of which `start` goes toward as far as the limits let it, along those that it "
      "meets.");
   m.def(
      "limit_curvature",
      [](Of<Self> problem, Number least, Number most)
      {
         limit_curvature(given(problem, "problem").problem, number(least, "least"),
                         number(most, "most"));
      },
      arg("problem"), arg("least"), arg("most"),
      "Adds limits of the curvature of the gap at each node that has two neighbours, positive "
      "where it opens to both sides.");
}

void bind_report(nb::module_ &m)
{
   nb::class_<ActiveResponse>(m, "ActiveResponse", "One response that an optimum depends on.")
      .def_ro("load_case", &ActiveResponse::load_case, "number of the case")
      .def_ro("index", &ActiveResponse::index,
              "in the objective's list; the node of a pressure")
      .def_ro("value", &ActiveResponse::value, "times the case's weight")
      .def_ro("multiplier", &ActiveResponse::multiplier, "share of it, they add up to 1")
      .def("__repr__",
           [](const ActiveResponse &self)
           {
              std::ostringstream text;
              text << "<ActiveResponse " << self.index << " of case " << self.load_case << ": "
                   << self.value << ", multiplier " << self.multiplier << ">";
              return text.str();
           });
   using Self = Found;
   const auto of_report = [](auto member)
   { return [member](const Self &self) { return self.report.*member; }; };
   const auto numbers = [](auto member)
   { return [member](const Self &self) { return array(self.report.*member); }; };
   nb::class_<Self>(m, "DesignReport",
                    "The best design that was found, and how far it is an optimum.")
      .def_prop_ro(
         "status", [](const Self &self) { return name(self.report.status); },
         "'optimal': the conditions of optimality hold; 'improved', 'no equilibrium', "
         "'unavailable' or 'stopped'")
      .def_prop_ro("optimal",
                   [](const Self &self) { return self.report.status == DesignStatus::optimal; })
      .def_prop_ro("message", of_report(&DesignReport::message))
      .def_prop_ro("x", numbers(&DesignReport::x), "variables")
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> cattaneo._core.ReducedProblem"), "with them")
      .def_prop_ro("objective", of_report(&DesignReport::objective))
      .def_prop_ro("objective_at_start", of_report(&DesignReport::objective_at_start))
      .def_prop_ro(
         "traces", [](const Self &self) { return nb::list(self.traces); },
         nb::sig("def traces(self) -> list[MarchTrace]"), "of each case")
      .def_prop_ro("stationarity", of_report(&DesignReport::stationarity))
      .def_prop_ro("complementarity", of_report(&DesignReport::complementarity))
      .def_prop_ro("violation", of_report(&DesignReport::violation))
      .def_prop_ro("active", of_report(&DesignReport::active),
                   "'least_largest': the responses that matter")
      .def_prop_ro("bound_multipliers", numbers(&DesignReport::bound_multipliers),
                   "of each variable; positive: of the upper bound")
      .def_prop_ro("limit_multipliers", numbers(&DesignReport::limit_multipliers),
                   "of each limit; positive: of the upper one")
      .def_prop_ro("ties", of_report(&DesignReport::ties),
                   "of all cases: derivatives there are one-sided")
      .def_prop_ro("iterations", of_report(&DesignReport::iterations))
      .def_prop_ro("marches", of_report(&DesignReport::marches))
      .def_prop_ro("gradients", of_report(&DesignReport::gradients))
      .def_prop_ro("seconds", of_report(&DesignReport::seconds))
      .def("__repr__",
           [](const Self &self)
           {
              const DesignReport &report = self.report;
              std::ostringstream text;
              text << "<DesignReport: " << name(report.status);
              if (!report.message.empty()) { text << " (" << report.message << ")"; }
              text << ", objective " << report.objective << ", at the start "
                   << report.objective_at_start << "\n  " << report.marches << " marches, "
                   << report.iterations << " iterations; stationarity " << report.stationarity
                   << ", complementarity " << report.complementarity << ", violation "
                   << report.violation << ">";
              return text.str();
           });
   const DesignSettings settings;
   const MarchSettings &march = settings.march;
   m.def(
      "design",
      [](Of<Wanted> problem, Numbers start, Number tolerance, Whole max_iterations,
         Whole increments, Text stepping, Flag single_increment_if_exact, Whole max_halvings,
         Text method, ProgressLike progress, StopLike stop)
      {
         DesignSettings with;
         with.march = march_settings(increments, stepping, single_increment_if_exact,
                                     max_halvings, method);
         with.tolerance = number(tolerance, "tolerance");
         with.max_iterations =
            static_cast<int>(whole(max_iterations, "max_iterations", 1, most));
         const Wanted &of = given(problem, "problem");
         return found(of, vector_or_number(start, "start", of.problem.low.size()), with,
                      progress, stop);
      },
      arg("problem"), arg("start"), nb::kw_only(), arg("tolerance") = settings.tolerance,
      arg("max_iterations") = settings.max_iterations, arg("increments") = march.increments,
      arg("stepping") = "exact",
      arg("single_increment_if_exact") = march.single_increment_if_exact,
      arg("max_halvings") = march.max_halvings, arg("method") = "automatic",
      arg("progress") = false, arg("stop") = nb::none(),
      "Finds the variables that serve the goal, from a start within bounds and limits: an "
      "optimum in its neighbourhood, contact is not convex.\n\n"
      "increments, stepping, …: of each march, as in march(). Ctrl-C, `stop` and `progress` "
      "are asked between iterations. A status other than 'optimal' is warned of "
      "(OutcomeWarning).");
}

} // namespace

void bind_design(nb::module_ &m)
{
   nb::module_ design =
      m.def_submodule("design", "Derivatives of what a march returns, and designs.");
   bind_sensitivity(design);
   bind_readout_gradients(design);
   bind_problem(design);
   bind_report(design);
}

} // namespace cattaneo::python
