#include "WearSettings.hpp"
#include "arrays.hpp"
#include "marches.hpp"
#include "members.hpp"
#include "module.hpp"
#include "watch.hpp"
#include <cattaneo/wear/worn_out.hpp>
#include <nanobind/stl/string.h>
#include <sstream>

// Fretting wear.

namespace cattaneo::python
{

namespace
{

using Observer = std::optional<nb::typed<nb::callable, nb::object(WearState, WearRecord)>>;
CATTANEO_ARGUMENT(Truths, "numpy.typing.NDArray[numpy.bool_]", anything);

Truths truths(const std::vector<bool> &values)
{
   Eigen::Matrix<bool, Eigen::Dynamic, 1> all(static_cast<Index>(values.size()));
   for (Index i = 0; i < all.size(); ++i) { all[i] = values[i]; }
   return array<Truths>(std::move(all));
}

/// A report with the last state and the records of the computation.
struct Wear
{
   nb::object problem;
   WearReport report;
   WearState state;
};

/// The result of worn_out(), independent of the problem.
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
         [](Self *self, Numbers coefficient, Numbers threshold, bool of_energy)
         {
            Self law{vector(coefficient, "coefficient"), {}, of_energy};
            if (!threshold.is_none())
            {
               law.threshold = vector_or_number(threshold, "threshold", law.coefficient.size());
            }
            new (self) Self(std::move(law));
         },
         arg("coefficient"), arg("threshold") = nb::none(), arg("of_energy") = false,
         "coefficient: k of each node, (n,), at least 0, in 1/pressure. threshold: the "
         "pressure p_th below which nothing wears, (n,) or one number, at least 0. of_energy: "
         "k is the wear per energy that friction loses per area.\nInputError for negative "
         "values or other sizes.")
      .def_static(
         "uniform",
         [](const ReducedProblem &problem, double coefficient)
         { return Self::uniform(problem, finite(coefficient, "coefficient")); },
         arg("problem"), arg("coefficient"),
         "The same k, in 1/pressure, at every node of a problem, without a threshold.")
      .def(
         "set",
         [](Self &self, const ReducedProblem &problem, const std::string &interface,
            double coefficient)
         { self.set(problem, interface, finite(coefficient, "coefficient")); },
         arg("problem"), arg("interface"), arg("coefficient"),
         "Sets k, in 1/pressure, at the nodes of an interface. InputError if the problem has "
         "none with this name.")
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
      [](const ReducedProblem &problem, const Self &law, const ContactState &before,
         const ContactState &after)
      {
         law.validate(problem);
         before.validate(problem);
         after.validate(problem);
         return array(worn_depth(problem, law, before, after));
      },
      arg("problem"), arg("law"), arg("before"), arg("after"),
      "Depth that each node loses over the increment from state `before` to state `after`, "
      "(n,), at least 0, in units of length.");
   m.def(
      "worn_volume",
      [](const ReducedProblem &problem, Numbers depth)
      { return worn_volume(problem, vector(depth, "depth", problem.nodes())); },
      arg("problem"), arg("depth"),
      "Volume of the depths of all nodes, (n,), per unit thickness; in axisymmetry of the full "
      "circumference. Needs weights.");
}

void bind_state(nb::module_ &m)
{
   using Self = WearState;
   nb::class_<Self> state(m, "WearState",
                          "The state of a wearing contact: all data on which its future "
                          "depends. Arrays are read-only views.");
   bind_validate(state);
   bind_copies(state);
   state
      .def(
         "__init__",
         [](Self *self, const ContactState &contact, Numbers depth, Numbers dissipation,
            double cycles)
         {
            const Index n = contact.p.size();
            Self state{contact, vector_or_number(depth, "depth", n),
                       vector_or_number(dissipation, "dissipation", n),
                       finite(cycles, "cycles")};
            new (self) Self(std::move(state));
         },
         arg("contact"), arg("depth"), arg("dissipation") = 0.0, arg("cycles") = 0.0,
         "contact: a ContactState of the worn contact. depth: worn off so far, and "
         "dissipation: energy lost by friction so far, both (n,) or one number, at least 0. "
         "cycles: number of cycles so far.")
      .def_static("virgin", &Self::virgin, arg("problem"),
                  "The state of the unworn contact of a problem, before any load.")
      .def_prop_ro(
         "contact", [](Self &self) -> ContactState & { return self.contact; },
         nb::rv_policy::reference_internal,
         "with the slip and the forces of the worn contact, whose gap is problem.gap + depth")
      .def_prop_ro("depth", viewed(&Self::depth),
                   "(n,), depth worn off; the gap is problem.gap + depth")
      .def_prop_ro("dissipation", viewed(&Self::dissipation),
                   "(n,), energy lost by friction at each node so far")
      .def_ro("cycles", &Self::cycles, "number of cycles so far, marched or jumped over")
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
                          "Record of a cycle that was marched, or of a jump over several.")
      .def_ro("cycles", &WearRecord::cycles, "number of cycles so far, at its end")
      .def_ro("covered", &WearRecord::covered, "number of cycles that the record covers")
      .def_ro("volume", &WearRecord::volume, "volume worn off so far, per unit thickness")
      .def_ro("depth", &WearRecord::depth, "largest so far")
      .def_ro("dissipation", &WearRecord::dissipation, "energy lost by friction so far")
      .def_ro("loss", &WearRecord::loss,
              "energy lost in the last cycle; after a jump, in a cycle of the worn contact")
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
      "Result of a march with wear: `state` at its end, and arrays with an "
      "entry for every cycle that was marched and every jump.");
   bind_outcome(report, [](const Self &self) -> const WearReport & { return self.report; });
   report
      .def_prop_ro(
         "problem", [](const Self &self) { return self.problem; },
         nb::sig("def problem(self) -> cattaneo._core.ReducedProblem"), "the unworn one")
      .def_prop_ro(
         "state", [](Self &self) -> WearState & { return self.state; },
         nb::rv_policy::reference_internal, "at the end")
      .def_prop_ro("cycles", of_records(&WearRecord::cycles), "so far")
      .def_prop_ro("covered", of_records(&WearRecord::covered),
                   "number of cycles that each record covers")
      .def_prop_ro("volume", of_records(&WearRecord::volume),
                   "volume worn off so far, per unit thickness")
      .def_prop_ro("depth", of_records(&WearRecord::depth), "largest so far")
      .def_prop_ro("dissipation", of_records(&WearRecord::dissipation),
                   "energy lost by friction so far")
      .def_prop_ro("loss", of_records(&WearRecord::loss),
                   "energy lost in the last cycle of each record; after a jump, in a cycle of "
                   "the worn contact")
      .def_prop_ro("errors", of_records(&WearRecord::error),
                   "estimates of the largest error of depth so far, by all jumps")
      .def_prop_ro(
         "last",
         [](const Self &self)
         {
            return march_report(nb::cast<const ReducedProblem &>(self.problem),
                                self.report.last, self.state.contact);
         },
         nb::sig("def last(self) -> cattaneo._core.MarchReport"),
         "report of the last cycle that was marched")
      .def_prop_ro(
         "marched", copied(&Self::report, &WearReport::marched),
         "cycles that were marched, also those that are marched only to see where a jump leads")
      .def_prop_ro("jumps", copied(&Self::report, &WearReport::jumps))
      .def_prop_ro(
         "error", copied(&Self::report, &WearReport::error),
         "estimate of the largest error of depth at the end by jumps, including how errors of "
         "early jumps have grown; infinite if the wear is too unstable for an estimate")
      .def_prop_ro("reached", copied(&Self::report, &WearReport::reached),
                   "True if the estimated error of depths is within the tolerance")
      .def_prop_ro("remark", copied(&Self::report, &WearReport::remark),
                   "the text of the warning if errors of jumps have grown, or if no "
                   "equilibrium was found at the worn gap; else empty")
      .def_prop_ro("explicit_limit", copied(&Self::report, &WearReport::explicit_limit),
                   "largest number of cycles that may share one explicit update of the gap")
      .def_prop_ro("implicit_cycles", copied(&Self::report, &WearReport::implicit_cycles))
      .def_prop_ro("steady_cycle", copied(&Self::report, &WearReport::steady_cycle),
                   "first of the cycles with equal wear; 0: none")
      .def_prop_ro("final_cycle", copied(&Self::report, &WearReport::final_cycle),
                   "cycle at which wear ended; 0: it has not ended")
      .def_prop_ro("counters", copied(&Self::report, &WearReport::counters))
      .def_prop_ro("seconds", copied(&Self::report, &WearReport::seconds))
      .def("__repr__", &brief);
}

Wear worn(const ReducedProblem &problem, const WearLaw &law, const LoadHistory &history,
          double cycles, const WearState *state, WearSettings settings,
          const Observer &observer, const ProgressLike &progress, const StopLike &stop,
          const nb::kwargs &members)
{
   set_members(settings, members);
   const ReducedProblem copy = problem;
   const WearLaw by = law;
   const LoadHistory loads = history;
   finite(cycles, "cycles");
   Wear result{nb::find(problem), {}, state ? *state : WearState::virgin(copy)};
   Watch watch(progress, stop);
   settings.march.monitor = watch.monitor();
   const WearObserver call = [&](const WearState &now, const WearRecord &record)
   {
      const nb::gil_scoped_acquire lock;
      (*observer)(nb::cast(WearState(now)), nb::cast(WearRecord(record)));
   };
   result.report = unlocked(
      [&]
      {
         return wear(copy, by, loads, cycles, result.state, settings,
                     observer ? call : WearObserver());
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
   m.def(
      "wear", &worn, arg("problem"), arg("law"), arg("history"), arg("cycles"),
      arg("state") = nb::none(), nb::kw_only(), arg("settings") = WearSettings(),
      arg("observer") = nb::none(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "Wears a contact: marches the part of a history before its cycle, then the cycle until "
      "`cycles` are reached, and adds the wear of each cycle to the gap. `state` is not "
      "changed.\n\n"
      "history: with a cycle (cycle_start); its number of repetitions is ignored.\n"
      "settings: with a tolerance cycles are jumped over. This holds for the given increments "
      "and stepping: unstable wear may end elsewhere with others. If the tolerance was not "
      "reached, `reached` is False. A warning has this and any other remark.\n"
      "observer: is called with WearState and WearRecord after every cycle marched and every "
      "jump, of jumps when their error is known.\n\n"
      "Ctrl-C, `stop` and `progress` are checked between cycles. There is a warning "
      "(OutcomeWarning) for an outcome other than 'converged'.");

   using Self = Worn;
   nb::class_<Self> end(m, "WornOut",
                        "A state in which a cycle wears off nothing more. A march may end in "
                        "another one, with wear at nodes that stick here.");
   bind_outcome(end, [](const Self &self) -> const WornOut & { return self.end; });
   end.def_prop_ro("depth", copied(&Self::end, &WornOut::depth),
                   "(n,), depth worn off at each node")
      .def_prop_ro("overlap", copied(&Self::end, &WornOut::overlap),
                   "(n,), overlap that the unworn surfaces would have; it crosses zero where "
                   "the worn zone ends")
      .def_prop_ro(
         "stick", [](const Self &self) { return truths(self.end.stick); },
         "nodes that never slip in a cycle: they alone carry the loads")
      .def_prop_ro(
         "contact", [](Self &self) -> ContactState & { return self.end.contact; },
         nb::rv_policy::reference_internal, "state at the end of a cycle of the worn contact")
      .def_prop_ro(
         "unworn", [](Self &self) -> ContactState & { return self.end.unworn; },
         nb::rv_policy::reference_internal, "state at the end of the unworn cycle")
      .def_prop_ro(
         "slip_range", [](const Self &self) { return array(self.slip_range); },
         "(n,), largest less smallest slip of each node over the unworn cycle")
      .def_prop_ro("loss", copied(&Self::end, &WornOut::loss),
                   "energy loss of a cycle, over that of the unworn contact")
      .def_prop_ro("searches", copied(&Self::end, &WornOut::searches),
                   "number of sets of sticking nodes that were tried")
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
      [](const ReducedProblem &problem, const LoadHistory &history, const ContactState *contact,
         MarchSettings settings, const ProgressLike &progress, const StopLike &stop,
         const nb::kwargs &members)
      {
         set_members(settings, members);
         const ReducedProblem copy = problem;
         const LoadHistory loads = history;
         const ContactState from = state_or_rest(copy, contact);
         Watch watch(progress, stop);
         settings.monitor = watch.monitor();
         Worn result = unlocked(
            [&]
            {
               WornOut end = worn_out(copy, loads, from, settings);
               Eigen::VectorXd range = end.range.range();
               return Worn{std::move(end), std::move(range)};
            });
         warn_of_status("worn_out", result.end.status, "(" + result.end.message + ")");
         return result;
      },
      arg("problem"), arg("history"), arg("contact") = nb::none(), nb::kw_only(),
      arg("settings") = MarchSettings(), arg("progress") = false, arg("stop") = nb::none(),
      arg("members"),
      "A fully worn state of partial slip, without the cycles that lead there. Slipping nodes "
      "carry no force and sticking nodes keep their place. The depth is the largest overlap at "
      "any point of the cycle.\n\nhistory: with a cycle. contact: a state of the unworn "
      "problem at the start of the history or of its cycle; None: before any load. The result "
      "holds for any law of wear without a threshold.\n\nThis is one state in which wear ends. "
      "The end of a march may be another, with wear at nodes that stick here. If A = C, B = 0 "
      "(half-planes of one material) and pressures do not vary in the cycle both are the "
      "same.");
}

} // namespace

void bind_wear(nb::module_ &m)
{
   nb::module_ wear = m.def_submodule("wear", "Fretting wear.");
   bind_settings<WearSettings>(wear);
   bind_law(wear);
   bind_state(wear);
   bind_report(wear);
   bind_wear_march(wear);
}

} // namespace cattaneo::python
