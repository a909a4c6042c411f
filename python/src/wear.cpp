#include "arrays.hpp"
#include "marches.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/wear/wear_march.hpp>
#include <cattaneo/wear/worn_out.hpp>
#include <nanobind/stl/string.h>
#include <sstream>

// Fretting wear.

namespace cattaneo::python
{

namespace
{

CATTANEO_ARGUMENT(MaybeNumbers, "None | numpy.typing.ArrayLike");
CATTANEO_ARGUMENT(MaybeWearState, "None | WearState");
CATTANEO_ARGUMENT(Observer, "None | collections.abc.Callable[[WearState, WearRecord], object]");
CATTANEO_ARGUMENT(Truths, "numpy.typing.NDArray[numpy.bool_]");

Truths truths(const std::vector<bool> &values)
{
   Eigen::Matrix<bool, Eigen::Dynamic, 1> all(static_cast<Index>(values.size()));
   for (Index i = 0; i < all.size(); ++i) { all[i] = values[i]; }
   return array<Truths>(std::move(all));
}

/// A report with the state it ended in, and what was taken on the way.
struct Wear
{
   nb::object problem;
   WearReport report;
   WearState state;
};

/// What worn_out() found, free of the problem.
struct Worn
{
   WornOut end;
   Eigen::VectorXd slip_range;
};

void bind_law(nb::module_ &m)
{
   using Self = WearLaw;
   nb::class_<Self> law(m, "WearLaw",
                        "Archard's law at each contact node: depth rate = k (p - p_th)+ |slip "
                        "rate|, p the pressure, k of both bodies together.");
   bind_validate(law);
   law.def(
         "__init__",
         [](Self *self, Numbers coefficient, MaybeNumbers threshold, Flag of_energy)
         {
            Self law{vector(coefficient, "coefficient"), {}, flag(of_energy, "of_energy")};
            if (!threshold.is_none())
            {
               law.threshold = vector_or_number(threshold, "threshold", law.coefficient.size());
            }
            new (self) Self(std::move(law));
         },
         arg("coefficient"), arg("threshold") = nb::none(), arg("of_energy") = false,
         "coefficient: k of each node, in 1/pressure. threshold: the pressure p_th below which "
         "nothing wears, of each node or one number. of_energy: k is of the energy that "
         "friction takes per area.")
      .def_static(
         "uniform",
         [](Of<ReducedProblem> problem, Number coefficient) {
            return Self::uniform(given(problem, "problem"), number(coefficient, "coefficient"));
         },
         arg("problem"), arg("coefficient"), "The same k at every node, no threshold.")
      .def(
         "set",
         [](Self &self, Of<ReducedProblem> problem, Text interface, Number coefficient)
         {
            self.set(given(problem, "problem"), text(interface, "interface"),
                     number(coefficient, "coefficient"));
         },
         arg("problem"), arg("interface"), arg("coefficient"),
         "Another k at the nodes of an interface.")
      .def_prop_ro("coefficient", viewed(&Self::coefficient), "k of each node")
      .def_prop_ro("threshold", viewed(&Self::threshold), "no entries: none")
      .def_ro("of_energy", &Self::of_energy)
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<WearLaw: k of " << self.coefficient.size() << " nodes";
              if (self.coefficient.size() > 0)
              {
                 text << " from " << self.coefficient.minCoeff() << " to "
                      << self.coefficient.maxCoeff();
              }
              text << (self.of_energy ? " of the energy" : "")
                   << (self.threshold.size() > 0 ? ", with a threshold>" : ">");
              return text.str();
           });
   m.def(
      "worn_depth",
      [](Of<ReducedProblem> problem, Of<Self> law, Of<ContactState> before,
         Of<ContactState> after)
      {
         const ReducedProblem &of = given(problem, "problem");
         const Self &by = given(law, "law");
         const ContactState &from = given(before, "before"), &to = given(after, "after");
         by.validate(of);
         from.validate(of);
         to.validate(of);
         return array(worn_depth(of, by, from, to));
      },
      arg("problem"), arg("law"), arg("before"), arg("after"),
      "Depth that each node loses over an increment between two states.");
   m.def(
      "worn_volume",
      [](Of<ReducedProblem> problem, Numbers depth)
      {
         const ReducedProblem &of = given(problem, "problem");
         return worn_volume(of, vector(depth, "depth", of.nodes()));
      },
      arg("problem"), arg("depth"),
      "Volume of a depth of each node, per unit thickness; of the full circumference in "
      "axisymmetry.");
}

void bind_state(nb::module_ &m)
{
   using Self = WearState;
   nb::class_<Self> state(m, "WearState",
                          "All that the future of a wearing contact depends on. Arrays are "
                          "views that cannot be written to.");
   bind_validate(state);
   bind_copies(state);
   state
      .def(
         "__init__",
         [](Self *self, Of<ContactState> contact, Numbers depth, Numbers dissipation,
            Number cycles)
         {
            const ContactState &at = given(contact, "contact");
            const Index n = at.p.size();
            Self state{at, vector_or_number(depth, "depth", n),
                       vector_or_number(dissipation, "dissipation", n),
                       number(cycles, "cycles")};
            new (self) Self(std::move(state));
         },
         arg("contact"), arg("depth"), arg("dissipation") = 0.0, arg("cycles") = 0.0,
         "depth: worn off so far, and dissipation: energy that friction took so far, of each "
         "node or one number.")
      .def_static(
         "virgin",
         [](Of<ReducedProblem> problem) { return Self::virgin(given(problem, "problem")); },
         arg("problem"), "Unworn, before any load.")
      .def_prop_ro(
         "contact", [](Self &self) -> ContactState & { return self.contact; },
         nb::rv_policy::reference_internal,
         "with the slip and the forces of the worn contact, whose gap is problem.gap + depth")
      .def_prop_ro("depth", viewed(&Self::depth), "worn off; the gap is problem.gap + depth")
      .def_prop_ro("dissipation", viewed(&Self::dissipation),
                   "energy that friction took at each node so far")
      .def_ro("cycles", &Self::cycles, "so far, marched or jumped over")
      .def("__repr__",
           [](const Self &self)
           {
              std::ostringstream text;
              text << "<WearState after " << self.cycles << " cycles: largest depth "
                   << (self.depth.size() > 0 ? self.depth.maxCoeff() : 0.0) << " of "
                   << self.depth.size() << " nodes, dissipation " << self.dissipation.sum()
                   << ">";
              return text.str();
           });
   m.def(
      "load_wear_state", [](File name) { return load_wear_state(file(name)); }, arg("file"),
      "Reads what save() wrote of a state.");
}

std::string brief(const Wear &self)
{
   const WearReport &report = self.report;
   std::ostringstream text;
   text << "<WearReport: " << name(report.status);
   if (!report.message.empty()) { text << " (" << report.message << ")"; }
   text << " after " << self.state.cycles << " cycles, " << report.marched << " marched, "
        << report.jumps << " jumps";
   if (report.jumps > 0 && std::isfinite(report.error))
   {
      text << ", estimate of their error of depth " << report.error;
   }
   if (!report.remark.empty()) { text << "\n  " << report.remark; }
   if (!self.report.records.empty())
   {
      const WearRecord &last = self.report.records.back();
      text << "\n  largest depth " << last.depth << ", volume " << last.volume
           << ", dissipation " << last.dissipation << ", loss of a cycle " << last.loss;
   }
   text << "\n  explicit updates are stable below " << report.explicit_limit << " cycles";
   if (report.implicit_cycles > 0)
   {
      text << ", " << report.implicit_cycles << " cycles wore more and were implicit";
   }
   if (report.steady_cycle > 0) { text << "\n  steady from cycle " << report.steady_cycle; }
   if (report.final_cycle > 0) { text << "\n  final at cycle " << report.final_cycle; }
   text << ">";
   return text.str();
}

void bind_report(nb::module_ &m)
{
   nb::class_<WearRecord>(m, "WearRecord",
                          "Of a cycle that was marched, or a jump over several.")
      .def_ro("cycles", &WearRecord::cycles, "so far, at its end")
      .def_ro("covered", &WearRecord::covered, "how many it covers")
      .def_ro("volume", &WearRecord::volume, "worn off so far")
      .def_ro("depth", &WearRecord::depth, "largest so far")
      .def_ro("dissipation", &WearRecord::dissipation, "energy that friction took so far")
      .def_ro("loss", &WearRecord::loss,
              "of it in the last cycle; after a jump, in a cycle of the worn contact")
      .def_ro("error", &WearRecord::error,
              "estimate of the largest error of depth so far, by all jumps")
      .def("__repr__",
           [](const WearRecord &self)
           {
              std::ostringstream text;
              text << "<WearRecord at cycle " << self.cycles << ": largest depth " << self.depth
                   << ", volume " << self.volume << ", loss of a cycle " << self.loss << ">";
              return text.str();
           });
   using Self = Wear;
   const auto of_records = [](auto member)
   {
      return [member](const Self &self)
      {
         Eigen::VectorXd all(self.report.records.size());
         for (Index k = 0; k < all.size(); ++k) { all[k] = self.report.records[k].*member; }
         return array(std::move(all));
      };
   };
   nb::class_<Self> report(
      m, "WearReport",
      "What a march with wear came to: `state` at its end, and arrays with "
      "an entry for every cycle that was marched and every jump.");
   bind_outcome(report, [](const Self &self) -> const WearReport & { return self.report; });
   report
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> cattaneo._core.ReducedProblem"), "the unworn one")
      .def_prop_ro(
         "state", [](Self &self) -> WearState & { return self.state; },
         nb::rv_policy::reference_internal, "at the end")
      .def_prop_ro("cycles", of_records(&WearRecord::cycles), "so far")
      .def_prop_ro("covered", of_records(&WearRecord::covered), "cycles of each record")
      .def_prop_ro("volume", of_records(&WearRecord::volume), "worn off so far")
      .def_prop_ro("depth", of_records(&WearRecord::depth), "largest so far")
      .def_prop_ro("dissipation", of_records(&WearRecord::dissipation),
                   "energy that friction took so far")
      .def_prop_ro("loss", of_records(&WearRecord::loss),
                   "of the last cycle of each record; after a jump, of a cycle of the worn "
                   "contact")
      .def_prop_ro("errors", of_records(&WearRecord::error),
                   "estimates of the largest error of depth so far, by all jumps")
      .def_prop_ro(
         "last",
         [](const Self &self)
         { return march_report(self.problem, self.report.last, self.state.contact); },
         nb::sig("def last(self) -> cattaneo._core.MarchReport"), "of the last cycle marched")
      .def_prop_ro(
         "marched", [](const Self &self) { return self.report.marched; },
         "cycles, also those that only look where a jump leads")
      .def_prop_ro("jumps", [](const Self &self) { return self.report.jumps; })
      .def_prop_ro(
         "error", [](const Self &self) { return self.report.error; },
         "estimate of the largest error of depth at the end that comes of jumps, with all that "
         "grew on the way; infinite where the way is too unstable for an estimate")
      .def_prop_ro(
         "reached", [](const Self &self) { return self.report.reached; },
         "True if depths are estimated to be right to the tolerance")
      .def_prop_ro(
         "remark", [](const Self &self) { return self.report.remark; },
         "what a warning says too: where errors of jumps grew on the way, and where no "
         "equilibrium "
         "was found at the worn gap; else empty")
      .def_prop_ro(
         "explicit_limit", [](const Self &self) { return self.report.explicit_limit; },
         "most cycles that may share one explicit update of the gap")
      .def_prop_ro("implicit_cycles",
                   [](const Self &self) { return self.report.implicit_cycles; })
      .def_prop_ro(
         "steady_cycle", [](const Self &self) { return self.report.steady_cycle; },
         "from which each cycle wears as the next does; 0: none")
      .def_prop_ro(
         "final_cycle", [](const Self &self) { return self.report.final_cycle; },
         "at which wear had come to its end; 0: it has not")
      .def_prop_ro("counters", [](const Self &self) { return self.report.counters; })
      .def_prop_ro("seconds", [](const Self &self) { return self.report.seconds; })
      .def("__repr__", &brief);
}

Wear worn(nb::handle problem, const WearLaw &law, const LoadHistory &history, double cycles,
          nb::handle state, WearSettings settings, nb::handle observer, nb::handle progress,
          nb::handle stop)
{
   const ReducedProblem copy = given<ReducedProblem>(problem, "problem");
   Wear result{nb::borrow(problem), {}, {}};
   result.state = state.is_none() ? WearState::virgin(copy) : given<WearState>(state, "state");
   require_observer(observer);
   Watch watch(progress, stop);
   settings.march.monitor = watch.monitor();
   const WearObserver call = [&](const WearState &now, const WearRecord &record)
   {
      const nb::gil_scoped_acquire lock;
      observer(nb::cast(WearState(now)), nb::cast(WearRecord(record)));
   };
   result.report = unlocked(
      [&]
      {
         return wear(copy, law, history, cycles, result.state, settings,
                     observer.is_none() ? WearObserver() : call);
      });
   const WearReport &report = result.report;
   warn_of_status("wear", report.status,
                  "after " + exact_text(result.state.cycles) + " cycles: " + report.message);
   if (!report.remark.empty()) { warn("wear: " + report.remark); }
   for (const CutOffContact &end : report.last.cut_off) { warn("wear: " + end.message()); }
   return result;
}

void bind_wear_march(nb::module_ &m)
{
   const WearSettings settings;
   const MarchSettings &march = settings.march;
   m.def(
      "wear",
      [](Of<ReducedProblem> problem, Of<WearLaw> law, Of<LoadHistory> history, Number cycles,
         MaybeWearState state, Text update, Number tolerance, Number final_share,
         Number steady_tolerance, Whole increments, Text stepping,
         Flag single_increment_if_exact, Whole max_halvings, Text method, Observer observer,
         ProgressLike progress, StopLike stop)
      {
         WearSettings with;
         with.march = march_settings(increments, stepping, single_increment_if_exact,
                                     max_halvings, method);
         with.update = chosen<GapUpdate>(update, "update", {"cycle", "piece"});
         with.tolerance = number(tolerance, "tolerance");
         with.final_share = number(final_share, "final_share");
         with.steady_tolerance = number(steady_tolerance, "steady_tolerance");
         const WearLaw by = given(law, "law");
         const LoadHistory loads = given(history, "history");
         return worn(problem.object, by, loads, number(cycles, "cycles"), state, with, observer,
                     progress, stop);
      },
      arg("problem"), arg("law"), arg("history"), arg("cycles"), arg("state") = nb::none(),
      nb::kw_only(), arg("update") = "cycle", arg("tolerance") = settings.tolerance,
      arg("final_share") = settings.final_share,
      arg("steady_tolerance") = settings.steady_tolerance, arg("increments") = march.increments,
      arg("stepping") = "exact",
      arg("single_increment_if_exact") = march.single_increment_if_exact,
      arg("max_halvings") = march.max_halvings, arg("method") = "automatic",
      arg("observer") = nb::none(), arg("progress") = false, arg("stop") = nb::none(),
      "Wears a contact: marches the opening part of a history, then its cycle until `cycles` "
      "are over, and takes off what each cycle wears. `state` stays as it is.\n\n"
      "history: with a cycle (cycle_start); how often it repeats is not asked.\n"
      "tolerance: cycles are jumped over where depths are estimated to differ by no more than "
      "this share of the largest from those of all cycles marched, 1e-8 to 0.1; 0: every cycle "
      "is marched, as with update 'piece'. The same increments and stepping are meant: an "
      "unstable way ends elsewhere "
      "with others. Where the tolerance was not reached `reached` is False; of that and of any "
      "other remark a warning says so. final_share: ends where a cycle adds less than this "
      "share of the largest depth. update: the gap follows at the end of each 'cycle' or "
      "'piece' of it. increments, stepping, …: of each march, as in march().\n"
      "observer: is called with WearState and WearRecord after every cycle marched and every "
      "jump, of jumps when their error is known.\n\n"
      "Ctrl-C, `stop` and `progress` are asked between cycles. An outcome other than "
      "'converged' is warned of (OutcomeWarning).");

   using Self = Worn;
   const auto of_end = [](auto member)
   { return [member](const Self &self) { return array(self.end.*member); }; };
   nb::class_<Self> end(
      m, "WornOut",
      "A state in which a cycle wears off nothing more. A march may come to another one where "
      "nodes stick that it finds worn.");
   bind_outcome(end, [](const Self &self) -> const WornOut & { return self.end; });
   end.def_prop_ro("depth", of_end(&WornOut::depth), "worn off at each node")
      .def_prop_ro("overlap", of_end(&WornOut::overlap),
                   "how far the surfaces would overlap unworn; crosses zero where wear ends")
      .def_prop_ro(
         "stick", [](const Self &self) { return truths(self.end.stick); },
         "nodes that never slip in a cycle: they alone carry the loads")
      .def_prop_ro(
         "contact", [](Self &self) -> ContactState & { return self.end.contact; },
         nb::rv_policy::reference_internal, "at the end of a cycle")
      .def_prop_ro(
         "unworn", [](Self &self) -> ContactState & { return self.end.unworn; },
         nb::rv_policy::reference_internal, "at the end of the unworn cycle")
      .def_prop_ro(
         "slip_range", [](const Self &self) { return array(self.slip_range); },
         "of each node over the unworn cycle: largest - smallest slip")
      .def_prop_ro(
         "loss", [](const Self &self) { return self.end.loss; },
         "energy of a cycle, over that of the unworn contact")
      .def_prop_ro(
         "searches", [](const Self &self) { return self.end.searches; },
         "sets of sticking nodes that were tried")
      .def("__repr__",
           [](const Self &self)
           {
              const WornOut &end = self.end;
              std::ostringstream text;
              text << "<WornOut: " << name(end.status);
              if (!end.message.empty()) { text << " (" << end.message << ")"; }
              text << ", " << std::count(end.stick.begin(), end.stick.end(), true) << " of "
                   << end.stick.size() << " nodes stick";
              if (end.depth.size() > 0)
              {
                 text << ", largest depth " << end.depth.maxCoeff() << ", loss " << end.loss
                      << " of the unworn cycle's; a march may end elsewhere";
              }
              text << ">";
              return text.str();
           });
   m.def(
      "worn_out",
      [](Of<ReducedProblem> problem, Of<LoadHistory> history, MaybeState contact,
         Whole increments, Text stepping, Flag single_increment_if_exact, Whole max_halvings,
         Text method, ProgressLike progress, StopLike stop)
      {
         MarchSettings with = march_settings(increments, stepping, single_increment_if_exact,
                                             max_halvings, method);
         const ReducedProblem copy = given(problem, "problem");
         const LoadHistory loads = given(history, "history");
         const ContactState from = state_or_rest(copy, contact);
         Watch watch(progress, stop);
         with.monitor = watch.monitor();
         Worn result = unlocked(
            [&]
            {
               WornOut end = worn_out(copy, loads, from, with);
               Eigen::VectorXd range = end.range.range();
               return Worn{std::move(end), std::move(range)};
            });
         warn_of_status("worn_out", result.end.status, "(" + result.end.message + ")");
         return result;
      },
      arg("problem"), arg("history"), arg("contact") = nb::none(), nb::kw_only(),
      arg("increments") = march.increments, arg("stepping") = "exact",
      arg("single_increment_if_exact") = march.single_increment_if_exact,
      arg("max_halvings") = march.max_halvings, arg("method") = "automatic",
      arg("progress") = false, arg("stop") = nb::none(),
      "A fully worn state of partial slip, without the cycles that lead there: nodes that "
      "slip carry nothing, nodes that stick stay where they are, depth is what overlaps at any "
      "point of the cycle.\n\n"
      "history: with a cycle. contact: a state before its opening part or at the start of its "
      "cycle, of the unworn problem; rest if None. Wear is that of any law without a "
      "threshold.\n\n"
      "This is a state in which wear ends: the one that a march comes to may be another where "
      "nodes stick that it finds worn. Where A = C, B = 0 (half-planes of one material) and "
      "pressures do not vary in the cycle it is the same.");
}

} // namespace

void bind_wear(nb::module_ &m)
{
   nb::module_ wear = m.def_submodule("wear", "Fretting wear.");
   bind_law(wear);
   bind_state(wear);
   bind_report(wear);
   bind_wear_march(wear);
}

} // namespace cattaneo::python
