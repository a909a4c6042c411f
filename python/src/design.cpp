#include "DesignSettings.hpp"
#include "arrays.hpp"
#include "marches.hpp"
#include "members.hpp"
#include "module.hpp"
#include "sensitivity.hpp"
#include "watch.hpp"
#include <limits>
#include <nanobind/stl/variant.h>
#include <sstream>

// Designs, and the derivatives that the search for them uses.

namespace cattaneo::python
{

namespace
{

using Variables = std::variant<std::vector<Parameters>, Numbers>;
using Shape = std::optional<nb::typed<nb::callable, std::pair<Numbers, Numbers>(Reals)>>;
using Objective =
   std::optional<nb::typed<nb::callable, std::vector<Response>(Asked, std::vector<int>)>>;

/// A design problem whose objective and shape are functions of Python. They are called where
/// C++ would call its own.
struct Wanted
{
   DesignProblem problem;
   nb::object objective, shape;
};

/// The outcome of a search, and the problem that was designed.
struct Found
{
   DesignReport report;
   nb::object problem;
   nb::list traces;
};

/// Variables, given as Parameters or as columns that are added to the gap.
std::vector<Parameters> variables_of(const Variables &variables, Index nodes)
{
   if (const auto *columns = std::get_if<Numbers>(&variables))
   {
      return gap_variables(matrix(*columns, "variables", nodes));
   }
   return std::get<std::vector<Parameters>>(variables);
}

/// Calls Python's shape for C++.
Eigen::VectorXd shaped(nb::handle shape, const Eigen::VectorXd &x, Eigen::MatrixXd &by)
{
   const nb::gil_scoped_acquire lock;
   const nb::object returned = shape(array(x));
   std::pair<nb::object, nb::object> answer;
   if (!nb::try_cast(returned, answer))
   {
      refuse(returned, "what the shape returned",
             "two arrays, gaps of the nodes and their derivatives by each variable");
   }
   by = matrix(answer.second, "derivatives of the shape", by.rows(), by.cols());
   return vector(answer.first, "gaps of the shape", by.rows());
}

Wanted wanted(const ReducedProblem &problem, std::vector<DesignCase> cases,
              const Variables &variables, nb::handle low, nb::handle high, nb::handle limits,
              nb::handle least, nb::handle upper, const std::string &goal,
              const Objective &objective, const Shape &shape)
{
   Wanted result;
   DesignProblem &of = result.problem;
   of.problem = problem;
   of.cases = std::move(cases);
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
   of.goal = chosen<DesignGoal>(goal, "goal");
   if (shape)
   {
      result.shape = *shape;
      of.shape = [shape = nb::handle(*shape)](const Eigen::VectorXd &x, Eigen::MatrixXd &by)
      { return shaped(shape, x, by); };
   }
   if (objective)
   {
      result.objective = *objective;
      // It decides which data of the problem must be known.
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
   nb::list of_states;
   for (std::size_t k : states) { of_states.append(k); }
   // The objects that it gets are valid only during the call, even if they are kept.
   struct End
   {
      nb::handle asked;
      ~End() { nb::inst_ptr<Asked>(asked)->end(); }
   } const end{asked};
   const nb::object answer = objective(asked, of_states);
   std::vector<Response> all;
   if (!nb::try_cast(answer, all))
   {
      refuse(answer, "what the objective returned", "a list of Response");
   }
   return all;
}

Found found(const Wanted &wanted, const Eigen::VectorXd &start, DesignSettings settings,
            const ProgressLike &progress, const StopLike &stop)
{
   DesignProblem copy = wanted.problem;
   if (wanted.objective.is_valid())
   {
      copy.objective = [asked = nb::handle(wanted.objective)](
                          const Responses &of, const std::vector<std::size_t> &states)
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
      result.traces.append(
         nb::cast(Trace(nb::cast<const ReducedProblem &>(result.problem), std::move(trace))));
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
   nb::class_<DesignCase>(
      m, "DesignCase",
      "One load case of a design. It is marched from the state before any load.")
      .def(
         "__init__",
         [](DesignCase *self, const std::string &name, const LoadHistory &history,
            double weight, std::optional<double> from)
         {
            new (self) DesignCase{name, history, finite(weight, "weight"),
                                  from ? finite(*from, "from_") : std::nan("")};
         },
         arg("name"), arg("history"), arg("weight") = 1.0, arg("from_") = nb::none(),
         "name: used in messages.\nweight: factor of its responses; a negative one maximises "
         "them.\nfrom_: responses are taken at the points of the history from this time on; "
         "None: only at the last point.")
      .def_ro("name", &DesignCase::name)
      .def_ro("history", &DesignCase::history)
      .def_ro("weight", &DesignCase::weight)
      .def("__repr__",
           [](const DesignCase &self) {
              return "<DesignCase '" + self.name + "', weight " + exact_text(self.weight) + ">";
           });

   using Self = Wanted;
   nb::class_<Self>(m, "DesignProblem",
                    "The variables of a design and its goal. Each variable adds x[j] times a "
                    "change of parameters to those of the problem. Variables lie between "
                    "bounds, and may have linear limits.")
      .def(
         "__init__",
         [](Self *self, const ReducedProblem &problem, std::vector<DesignCase> cases,
            const Variables &variables, Numbers low, Numbers high, Numbers limits,
            Numbers least, Numbers most, const std::string &goal, const Objective &objective,
            const Shape &shape)
         {
            new (self) Self(wanted(problem, std::move(cases), variables, low, high, limits,
                                   least, most, goal, objective, shape));
         },
         arg("problem"), arg("cases"), arg("variables"), arg("low"), arg("high"), nb::kw_only(),
         arg("limits") = nb::none(), arg("least") = nb::none(), arg("most") = nb::none(),
         arg("goal") = "least_largest", arg("objective") = nb::none(),
         arg("shape") = nb::none(),
         "problem: the reduced problem at x = 0.\n"
         "variables: columns that are added to the gap, (n, number of variables), or a list of "
         "Parameters without stiffness.\n"
         "low, high: bounds of each variable, or one number.\n"
         "limits: a matrix L with a row for each limit, least <= L x <= most. Both may be "
         "infinite.\n"
         "objective: a function of Responses and the states that count. It returns a list of "
         "Response. None: the pressures of all nodes.\n"
         "goal: 'least_largest' or 'least_sum' of all responses of all cases, each times the "
         "weight of its case.\n"
         "shape: a function of x. It returns a gap that is added, (n,), and its derivatives, "
         "(n, number of variables). None: the gap is linear in x.")
      .def_prop_ro(
         "variables", [](const Self &self) { return self.problem.variables; },
         nb::sig("def variables(self) -> list[Parameters]"), "per unit of each")
      .def_prop_ro("low", copied(&Self::problem, &DesignProblem::low))
      .def_prop_ro("high", copied(&Self::problem, &DesignProblem::high))
      .def_prop_ro("limits", copied(&Self::problem, &DesignProblem::limits))
      .def_prop_ro("least", copied(&Self::problem, &DesignProblem::least))
      .def_prop_ro("most", copied(&Self::problem, &DesignProblem::most))
      .def(
         "with_",
         [](const Self &self, Numbers x)
         { return self.problem.with(vector(x, "x", self.problem.low.size())); },
         arg("x"), "The reduced problem with values x of the variables.")
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
      [](const Self &problem, Numbers start, int count)
      {
         const DesignProblem &of = problem.problem;
         require_at_least("spread_starts: count", count, 0);
         nb::list all;
         for (const Eigen::VectorXd &x :
              spread_starts(of, vector_or_number(start, "start", of.low.size()), count))
         {
            all.append(array(x));
         }
         return all;
      },
      arg("problem"), arg("start"), arg("count"),
      nb::sig("def spread_starts(problem: DesignProblem, start: numpy.typing.ArrayLike, "
              "count: int) -> list[numpy.ndarray]"),
      "Other starts for a search: `count` points that are spread evenly over the box of the "
      "bounds. A point that violates limits is replaced by the place that is reached on the "
      "way from `start` to it.");
   m.def(
      "limit_curvature",
      [](Self &problem, double least, double most)
      { limit_curvature(problem.problem, finite(least, "least"), finite(most, "most")); },
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
      .def_ro("multiplier", &ActiveResponse::multiplier,
              "its share in the optimum; all shares add up to 1")
      .def("__repr__",
           [](const ActiveResponse &self)
           {
              std::ostringstream text;

              text << "<ActiveResponse " << self.index << " of case " << self.load_case << ": "
                   << self.value << ", multiplier " << self.multiplier << ">";
              return text.str();
           });
   using Self = Found;
   nb::class_<Self>(
      m, "DesignReport",
      "The best design that was found, and how well it meets the conditions of an optimum.")
      .def_prop_ro(
         "status", [](const Self &self) { return name(self.report.status); },
         "'optimal': the conditions of optimality hold; 'improved', 'no equilibrium', "
         "'unavailable' or 'stopped'")
      .def_prop_ro("optimal",
                   [](const Self &self) { return self.report.status == DesignStatus::optimal; })
      .def_prop_ro("message", copied(&Self::report, &DesignReport::message))
      .def_prop_ro("x", copied(&Self::report, &DesignReport::x), "variables")
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> cattaneo._core.ReducedProblem"), "with them")
      .def_prop_ro("objective", copied(&Self::report, &DesignReport::objective))
      .def_prop_ro("objective_at_start",
                   copied(&Self::report, &DesignReport::objective_at_start))
      .def_prop_ro(
         "traces", [](const Self &self) { return nb::list(self.traces); },
         nb::sig("def traces(self) -> list[MarchTrace]"), "of each case")
      .def_prop_ro("stationarity", copied(&Self::report, &DesignReport::stationarity))
      .def_prop_ro("complementarity", copied(&Self::report, &DesignReport::complementarity))
      .def_prop_ro("violation", copied(&Self::report, &DesignReport::violation))
      .def_prop_ro("active", copied(&Self::report, &DesignReport::active),
                   "'least_largest': the responses that matter")
      .def_prop_ro("bound_multipliers", copied(&Self::report, &DesignReport::bound_multipliers),
                   "of each variable; positive: of the upper bound")
      .def_prop_ro("limit_multipliers", copied(&Self::report, &DesignReport::limit_multipliers),
                   "of each limit; positive: of the upper one")
      .def_prop_ro("ties", copied(&Self::report, &DesignReport::ties),
                   "of all cases: derivatives there are one-sided")
      .def_prop_ro("iterations", copied(&Self::report, &DesignReport::iterations))
      .def_prop_ro("marches", copied(&Self::report, &DesignReport::marches))
      .def_prop_ro("gradients", copied(&Self::report, &DesignReport::gradients))
      .def_prop_ro("seconds", copied(&Self::report, &DesignReport::seconds))
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
   m.def(
      "design",
      [](const Wanted &problem, Numbers start, DesignSettings settings,
         const ProgressLike &progress, const StopLike &stop, const nb::kwargs &members)
      {
         set_members(settings, members);
         return found(problem, vector_or_number(start, "start", problem.problem.low.size()),
                      std::move(settings), progress, stop);
      },
      arg("problem"), arg("start"), nb::kw_only(), arg("settings") = DesignSettings(),
      arg("progress") = false, arg("stop") = nb::none(), arg("members"),
      "Finds the best variables for the goal, from a start within bounds and limits. The "
      "optimum is local, because contact is not convex.\n\nCtrl-C, `stop` and `progress` are "
      "checked between iterations. There is a warning (OutcomeWarning) for a status other than "
      "'optimal'.");
}

} // namespace

void bind_design(nb::module_ &m)
{
   nb::module_ design =
      m.def_submodule("design", "Derivatives of the results of marches, and designs.");
   bind_settings<DesignSettings>(design);
   bind_sensitivity(design);
   bind_readout_gradients(design);
   bind_problem(design);
   bind_report(design);
}

} // namespace cattaneo::python
