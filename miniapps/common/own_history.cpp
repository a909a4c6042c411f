#include "common/own_history.hpp"

#include "common/watch.hpp"

#include <algorithm>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cattaneo/readout/places.hpp>
#include <cmath>
#include <deque>
#include <map>
#include <optional>

namespace miniapp
{

using namespace cattaneo;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// The multipliers of all loads, by their names.
std::string loads_text(const ReducedProblem &problem, const VectorXd &loads)
{
   std::vector<std::string> words;
   for (Eigen::Index k = 0; k < loads.size(); ++k)
   {
      words.push_back(problem.patterns[k].name + " = " + message_text(loads[k]));
   }
   return listed(words);
}

/// A saved state must have the loads that the history has at the state's time.
void check_start(const ReducedProblem &problem, const ContactState &state,
                 const LoadHistory &history)
{
   for (int k = 0; k < history.pieces(); ++k)
   {
      const LoadPiece piece = history.piece(k);
      if (state.time < piece.start || state.time > piece.end) { continue; }
      const VectorXd loads = piece.at((state.time - piece.start) / piece.duration());
      const double scale = history.multipliers.cwiseAbs().maxCoeff();
      require((loads - state.multipliers).cwiseAbs().maxCoeff() <= 1e-9 * scale,
              "option --load-state: the saved state has the loads ",
              loads_text(problem, state.multipliers), " at its time ", state.time,
              ", and the history has ", loads_text(problem, loads),
              " then: up to there it must be the history of the march that saved the state");
      return;
   }
   require(false, "option --load-state: the saved state's time ", state.time,
           " is outside of the history, which ends at ",
           history.piece(history.pieces() - 1).end);
}

/// A saved state must obey the laws of the problem. InputError that names the interface if a
/// gap or a friction has been changed.
void check_laws_at_start(const ReducedProblem &problem, const ContactState &state)
{
   const Eigen::Index n = problem.nodes();
   if (n == 0) { return; }
   const double tiny = 1e-6 * std::max(state.peak_force, state.p.cwiseAbs().maxCoeff());
   const std::string where = "option --load-state: ",
                     must = ": it must be that of the march that saved the state";
   // Surfaces have no chains.
   std::vector<ContactChain> chains = problem.chains;
   if (chains.empty())
   {
      chains.emplace_back();
      chains[0].nodes = n;
   }
   for (const ContactChain &chain : chains)
   {
      const std::string at =
         chain.interface.empty() ? "" : " of interface '" + chain.interface + "'";
      for (Eigen::Index i = chain.first; i < chain.first + chain.nodes; ++i)
      {
         const double opening = state.w[i] + problem.gap[i],
                      force = problem.C()(i, i) * opening;
         require(force > -tiny && (!closed(state.status[i]) || force < tiny), where, "the gap",
                 at, " has been changed, so that a node ",
                 force > 0 ? "that is closed in the saved state would be open by "
                           : "would overlap by ",
                 message_text(std::abs(opening)), must);
         const bool law = std::all_of(problem.held.begin(), problem.held.end(),
                                      [&](Eigen::Index row) { return row % n != i; });
         if (!law || !problem.laws.empty() || state.q.size() == 0) { continue; }
         double q = 0;
         for (Eigen::Index c = 0; c < problem.components(); ++c)
         {
            q = std::hypot(q, state.q[c * n + i]);
         }
         require(q <= problem.friction[i] * state.p[i] + tiny, where, "the friction", at,
                 " has been changed to ", problem.friction[i],
                 ", and the saved state has a shear of ", message_text(q / state.p[i]),
                 " times the pressure", must);
      }
   }
}

/// The circle on which a run of nodes lies, if the run turns enough to be distinguished from a
/// straight line.
struct Circle
{
   Eigen::Vector2d centre{0, 0};
   double way = 1; ///< 1: the run goes round it counterclockwise, -1: clockwise

   /// The angle of a place on it, from the x axis counterclockwise, in degrees; NaN: not known.
   double angle(const Eigen::Vector2d &place) const
   {
      return std::atan2(place[1] - centre[1], place[0] - centre[0]) * 180 / std::acos(-1.0);
   }
   /// The angle of a second place, which is passed after the one at the angle `from`.
   double angle_after(double from, const Eigen::Vector2d &place) const
   {
      const double turn = std::fmod(way * (angle(place) - from) + 720, 360);
      // Equal angles mean the whole circle, not an empty arc.
      return from + way * (turn > 1e-9 ? turn : 360);
   }
};

std::optional<Circle> circle_of(const ReducedProblem &problem, const ContactChain &chain)
{
   const Eigen::Index n = chain.nodes;
   if (n < 4 || problem.position.rows() != problem.nodes() || problem.position.cols() < 2)
   {
      return std::nullopt;
   }
   // |x|² = 2 c·x + const, by least squares about the middle.
   const Eigen::MatrixX2d places = problem.position.block(chain.first, 0, n, 2);
   const Eigen::RowVector2d middle = places.colwise().mean();
   const Eigen::MatrixX2d x = places.rowwise() - middle;
   const double size = x.cwiseAbs().maxCoeff();
   Eigen::MatrixX3d M(n, 3);
   M << 2 * x / size, VectorXd::Ones(n);
   const Eigen::Vector3d found =
      M.colPivHouseholderQr().solve((x / size).rowwise().squaredNorm());
   const Eigen::RowVector2d centre = size * found.head(2).transpose();
   const VectorXd radii = (x.rowwise() - centre).rowwise().norm();
   const double radius = radii.mean();
   double turned = 0;
   for (Eigen::Index i = 1; i < n; ++i)
   {
      const Eigen::RowVector2d a = x.row(i - 1) - centre, b = x.row(i) - centre;
      turned += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
   }
   // Accepts a run that turns by 10 degrees or more, if its distance from the circle is at most
   // a thousandth of its distance from a straight line.
   const double off = radius * (1 - std::cos(std::min(std::abs(turned), 3.0) / 2));
   if (!std::isfinite(radius) || std::abs(turned) < std::acos(-1.0) / 18 ||
       (radii.array() - radius).abs().maxCoeff() > 1e-3 * off)
   {
      return std::nullopt;
   }
   return Circle{(middle + centre).transpose(), turned > 0 ? 1.0 : -1.0};
}

void check_energies(std::initializer_list<double> energies)
{
   for (double energy : energies)
   {
      require(
         std::isfinite(energy),
         "the energies of the march overflow: use other units for the loads or the moduli");
   }
}

/// Names of the interfaces of a problem, in the order of its nodes.
std::vector<std::string> interfaces(const ReducedProblem &problem)
{
   std::vector<std::string> names;
   for (const ContactChain &chain : problem.chains)
   {
      if (names.empty() || names.back() != chain.interface)
      {
         names.push_back(chain.interface);
      }
   }
   return names;
}

/** If the line of an interface is straight along an axis, its places are named by x or y. Marks
    a panel whose places are arc lengths s: "NAME=x,way,start", x = start + way s. */
void say_straight(Panel &panel, const ReducedProblem &problem, const std::string &interface,
                  bool about_axis)
{
   std::vector<Eigen::Index> nodes;
   for (const ContactChain &chain : problem.chains)
   {
      if (chain.interface != interface) { continue; }
      for (Eigen::Index i = 0; i < chain.nodes; ++i) { nodes.push_back(chain.first + i); }
   }
   if (nodes.size() < 2 || problem.position.rows() != problem.nodes() ||
       problem.position.cols() != 2)
   {
      return;
   }
   const Eigen::MatrixX2d places = problem.position(nodes, Eigen::all);
   const VectorXd arc = problem.arc_length(nodes);
   const double size = (places.colwise().maxCoeff() - places.colwise().minCoeff()).maxCoeff();
   for (const int axis : {0, 1})
   {
      const VectorXd along = places.col(axis), other = places.col(1 - axis);
      const double way = along[along.size() - 1] > along[0] ? 1 : -1,
                   start = along[0] - way * arc[0];
      if ((along.array() - way * arc.array() - start).abs().maxCoeff() < 1e-9 * size &&
          other.maxCoeff() - other.minCoeff() < 1e-9 * size)
      {
         panel.say("straight", text("%s=%c,%g,%.12g", interface.c_str(),
                                    about_axis ? "rz"[axis] : "xy"[axis], way, start));
         return;
      }
   }
}

/// The zones of a march, of a long one those of every second increment, every fourth, ….
class ZonesInTime
{
public:
   /// The zones of an interface in the file of the march before, up to the time at which this
   /// march continues.
   void read(const std::string &interface, const std::string &file, double until)
   {
      for (const ordered_json &row : read_rows(file))
      {
         const double time = row["time"];
         if (time > until * (1 + 1e-8)) { return; } // nine digits
         drawn_[time].push_back({interface, row["state"], row["from"], row["to"]});
      }
   }
   void add(const ReducedProblem &problem, const ContactState &state)
   {
      if (count_++ % stride_ != 0) { return; }
      draw(problem, state);
      if (drawn_.size() < most_drawn) { return; }
      bool stays = false;
      for (auto one = drawn_.begin(); one != drawn_.end();)
      {
         stays = !stays;
         one = stays ? std::next(one) : drawn_.erase(one);
      }
      stride_ *= 2;
   }
   /// The last state too.
   void draw(const ReducedProblem &problem, const ContactState &state)
   {
      std::vector<Stretch> &all = drawn_[state.time];
      all.clear();
      for (const Zone &zone : drawn_zones(problem, state))
      {
         all.push_back({problem.chains[zone.chain].interface, name(zone.state),
                        zone.from.position, zone.to.position});
      }
   }
   bool empty() const { return drawn_.empty(); }
   /// One panel for each interface.
   void show(const std::map<std::string, Panel *> &panels) const
   {
      for (const auto &[time, stretches] : drawn_)
      {
         for (const Stretch &one : stretches)
         {
            panels.at(one.interface)->zone(time, one.state, one.from, one.to);
         }
      }
   }

private:
   struct Stretch
   {
      std::string interface, state;
      double from, to;
   };
   std::map<double, std::vector<Stretch>> drawn_; ///< by time
   long count_ = 0, stride_ = 1;
};

} // namespace

OwnHistory::OwnHistory(Study &study) : study_(study)
{
   study.options().group("The history of loads");
   study.option(&text_, "history",
                "Load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'; default: all from "
                "0 to 1.",
                Text::statements);
   study.option(&cycle_start_, "cycle-start",
                "Point of the history (from 0) where its cycle starts; -1: there is none.",
                at_least(-1));
   study.option(&amplitude_, "amplitude",
                "Multiplies the differences of the cycle's loads from those at --cycle-start. "
                "If the cycle starts at Q = 0 and goes between ±Q, 0.5 halves Q.",
                positive);
   study.option(&amplitudes_, "amplitudes",
                "One run for each of these values of --amplitude, as '0.2 0.5 1'. '0.2 … 1' "
                "(typed with … or three dots) gives nine values in equal steps. The same as "
                "--sweep amplitude=VALUES.");
   study.options().leave_out_of_cases("amplitudes");
   study.option(&cycles_, "cycles",
                "Largest number of cycles. The march ends earlier when they are steady.",
                at_least(1));
   study.option(&settings.increments, "increments",
                "Load increments between two points of the history.", at_least(1));
   stepping_.declare_with_events(study);
   study.option(&frames_, "frames",
                "Times, as '1 2.5', whose states go to --paraview and to the table of contact "
                "nodes (--csv), besides the last state; all: every increment.");
   study.option(&save_state_, "save-state", "File for the last state.", Text::output);
   study.option(&load_state_, "load-state", "State from which the march continues.",
                Text::input);
   for (const char *name : {"frames", "load-state"})
   {
      study.options().leave_out_of_cases(name);
   }
}

void OwnHistory::check_options()
{
   const Options &options = study_.options();
   cattaneo::require(cycles_ <= 1 || cycle_start_ >= 0, options.called("cycles"), " is ",
                     cycles_, ", but the history has no cycle: ", options.called("cycle-start"),
                     " must give the point at which the cycle starts");
   cattaneo::require(!study_.options().says("history") ||
                        text_.find_first_not_of("; \t\n") != std::string::npos,
                     options.called("history"),
                     " has no point, must have one at least, as 'P=1' (without it all loads go "
                     "from 0 to 1)");
   cattaneo::require(
      cycle_start_ >= 0 || !options.says("amplitude"), options.called("amplitude"),
      " is of the cycle, but the history has none: ", options.called("cycle-start"),
      " must give the point at which the cycle starts");
   stepping_.set(settings);
   if (frames_ != "all") { wanted_ = numbers("--frames", frames_); }
   std::sort(wanted_.begin(), wanted_.end());
}

void OwnHistory::begin(const ReducedProblem &problem)
{
   history_ = load_history("history", text_, problem);
   for (const auto &[load, with] : go_with)
   {
      auto its = history_.multipliers.row(problem.pattern(load));
      require(text_.find(load) == std::string::npos, "history names '", load,
              "', which goes with '", with, "': it must be left out");
      its = history_.multipliers.row(problem.pattern(with));
   }
   history_.cycle_start = cycle_start_;
   const Eigen::Index start = cycle_start_;
   for (Eigen::Index k = start + 1;
        start >= 0 && amplitude_ != 1 && k < history_.multipliers.cols(); ++k)
   {
      const VectorXd at_start = history_.multipliers.col(start);
      history_.multipliers.col(k) =
         at_start + amplitude_ * (history_.multipliers.col(k) - at_start);
   }
   history_.cycles = cycles_;
   history_.validate(problem);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const auto values = history_.multipliers.row(static_cast<Eigen::Index>(k));
      // For a bolt that is never tightened the march has a message of its own.
      const bool bolt = bolts && std::any_of(bolts->bolts().begin(), bolts->bolts().end(),
                                             [&](const Bolt &one)
                                             { return one.load == problem.patterns[k].name; });
      if (bolt && values.maxCoeff() >= 20)
      {
         warn("history tightens bolt '" + problem.patterns[k].name + "' to " +
              message_text(values.maxCoeff()) +
              " times its preload: the value at a point is a factor, not a force");
      }
      if (bolt || values.cwiseAbs().maxCoeff() > 0) { continue; }
      warn("load '" + problem.patterns[k].name +
           "' is zero throughout the history, so that it does nothing: name it there, as '" +
           problem.patterns[k].name + "=1', or leave it out");
   }
   state = ContactState::virgin(problem);
   if (!load_state_.empty())
   {
      try
      {
         state = load_contact_state(load_state_);
         state.require_of(problem);
      }
      catch (const InputError &error)
      {
         throw InputError("option --load-state: file '" + load_state_ + "': " + error.what());
      }
      check_laws_at_start(problem, state);
      LoadHistory expected = history_;
      for (std::size_t b = 0; bolts && b < bolts->bolts().size(); ++b)
      {
         // Its load is a force in the history, and a pretension in a state.
         const Eigen::Index load = bolts->load(b);
         expected.multipliers.row(load).setConstant(state.multipliers[load]);
      }
      check_start(problem, state, expected);
   }
   check_times("frames", wanted_);
}

namespace
{

/// For bodies that are only tied, without a law of contact: the loads of the history, one after
/// the other. All cycles are the same.
MarchReport followed(const ReducedProblem &problem, const LoadHistory &history,
                     ContactState &state, const MarchSettings &settings,
                     const MarchObserver &note)
{
   MarchReport report;
   report.loss_error.value = 0;
   report.loss_error.bound = true;
   for (int k = 0; k < history.pieces(); ++k)
   {
      const LoadPiece piece = history.piece(k);
      for (int i = 1; i <= settings.increments; ++i)
      {
         const double share = static_cast<double>(i) / settings.increments,
                      time = i < settings.increments ? piece.start + share * piece.duration()
                                                     : piece.end;
         if (time <= state.time || settings.monitor.stopped()) { continue; }
         state.time = time;
         state.multipliers = i < settings.increments ? piece.at(share) : piece.to;
         IncrementRecord record = record_of(problem, state);
         record.cycle = piece.cycle;
         note(state, record);
      }
      if (!piece.ends_cycle) { continue; }
      report.steady_cycle = piece.cycle;
      report.steady_period = 1;
      break;
   }
   if (settings.monitor.stopped()) { report.status = FrictionStatus::stopped; }
   report.time = report.event_time = state.time;
   report.event_multipliers = state.multipliers;
   return report;
}

} // namespace

void OwnHistory::check_times(const std::string &option, const std::vector<double> &times) const
{
   const double end = history_.piece(history_.pieces() - 1).end;
   for (double time : times)
   {
      require(time > state.time && time <= end, study_.options().called(option), ": time ",
              time, " is outside of the march from ", state.time, " to ", end);
   }
}

void OwnHistory::march(const ReducedProblem &problem, const Observer &observe)
{
   const bool tables = !study_.csv().empty() && writes(), goes_on = !load_state_.empty();
   std::optional<HistoryWriter> history;
   std::optional<NodeWriter> nodes;
   std::optional<StateSaver> saver;
   int ended = 0;
   const int period = goes_on ? state.steady_period(settings.steady_tolerance) : 0;
   if (goes_on)
   {
      for (int k = 0; k < history_.pieces() && history_.piece(k).end <= state.time; ++k)
      {
         if (history_.piece(k).ends_cycle) { ended = history_.piece(k).cycle; }
      }
      study_.goes_on_after(ended);
   }
   if (tables)
   {
      const std::string rows = study_.history_file(), frames = study_.csv() + "_nodes.csv";
      for (const std::string &file : {rows, frames}) { study_.begins(file, goes_on); }
      if (goes_on)
      {
         history.emplace(rows, problem, state);
         nodes.emplace(frames, problem, state.time, interface_of_node);
      }
      else
      {
         history.emplace(rows, problem);
         nodes.emplace(frames, problem, interface_of_node);
      }
   }
   if (!save_state_.empty() && writes())
   {
      study_.begins(save_state_);
      saver.emplace(save_state_);
   }
   std::map<std::string, Panel *> diagrams;
   ZonesInTime zones_in_time;
   const std::vector<std::string> names = interfaces(problem);
   for (const std::string &name : names)
   {
      const bool one = names.size() == 1;
      Panel &diagram =
         study_.panel(Panel::Kind::zones, one ? "zones_in_time" : "zones_in_time_" + name,
                      one ? "Zones in time" : "Zones in time of " + name, "time",
                      "arc length" + study_.units.of(0, 1));
      diagrams[name] = &diagram;
      say_straight(diagram, problem, name, about_axis);
      if (!goes_on || study_.csv().empty()) { continue; }
      zones_in_time.read(name, study_.csv() + "_" + diagram.name() + ".csv", state.time);
   }
   // Surfaces have no arc length, along which zones lie.
   const bool shown = study_.keeps_panels() && !problem.chains.empty();
   if (goes_on && shown && zones_in_time.empty())
   {
      study_.say(text("Zones in time begin at %g, where the march continues, because no file "
                      "has the earlier ones",
                      state.time));
   }
   if (ended > 0 && !study_.csv().empty() && study_.rows_before("cycles").empty())
   {
      study_.say(text("The table of cycles begins after cycle %d, where the march continues, "
                      "because no file has the earlier ones",
                      ended));
   }
   Film *film = problem.chains.empty() && !show_maps ? nullptr : study_.film(problem);
   if (film && show_maps) { show_maps(*film); }
   std::deque<IncrementRecord> last_increments;
   const auto with_what_is_kept = [&](ContactState reached)
   {
      if (keep) { keep(reached); }
      return reached;
   };
   auto next = wanted_.begin();
   double last_frame = state.time;
   const auto note = [&](const ContactState &reached, const IncrementRecord &record)
   {
      check_energies({reached.dissipation, record.external_work});
      bool frame = frames_ == "all";
      for (; next != wanted_.end() && reached.time >= *next; ++next) { frame = true; }
      if (frame) { last_frame = reached.time; }
      if (shown) { zones_in_time.add(problem, reached); }
      last_increments.push_back(record);
      // With every event the results list them all.
      if (last_increments.size() > most_drawn && !settings.every_event)
      {
         last_increments.pop_front();
      }
      if (history) { history->add(reached, record); }
      if (nodes && frame) { nodes->add(reached); }
      if (film) { film->add(problem, reached, record); }
      cycle = record.cycle;
      observe(reached, frame);
      if (saver) { saver->add(with_what_is_kept(reached), record); }
   };
   Watch watch("march");
   settings.monitor = watch.monitor();
   settings.keep_increments = false;
   settings.loss_error = true;
   report = problem.nodes() == 0 ? followed(problem, history_, state, settings, note)
            : bolts              ? bolts->march(history_, state, settings, note)
                                 : cattaneo::march(problem, history_, state, settings, note);
   std::vector<std::string> tightened;
   for (std::size_t b = 0; bolts && b < bolts->bolts().size(); ++b)
   {
      tightened.push_back(bolts->bolts()[b].load);
   }
   const std::string early = nothing_presses(problem, history_, report, state, tightened);
   if (!early.empty()) { report.message += "; " + early; }
   check_energies({report.energy_imbalance, state.dissipation});
   report.increments.assign(last_increments.begin(), last_increments.end());
   // A march that was not cut would have ended there.
   const bool idle = goes_on && report.counters.increments == 0;
   if (period > 0 && (idle || report.steady_period == period))
   {
      report.steady_cycle = ended - period + 1;
      report.steady_period = period;
   }
   if (idle && report.status == FrictionStatus::converged)
   {
      warn(told("option --load-state: the saved state is at the end of the history, time ",
                state.time, ": nothing was left to march"));
   }
   if (!zones_in_time.empty()) { zones_in_time.draw(problem, state); }
   zones_in_time.show(diagrams);
   study_.counters += report.counters;
   study_.code = exit_code(problem, report);
   add_outcome(problem, report, study_.results);
   if (last_frame != state.time || report.increments.empty())
   {
      // A march that will be continued has no frame at its end, because its state is saved.
      if (nodes && !(saver && report.status == FrictionStatus::stopped)) { nodes->add(state); }
      observe(state, true);
   }
   if (saver) { save(with_what_is_kept(state), save_state_); }
}

namespace
{

/// Parts of the surface in their states.
void report_areas(Study &study, const ReducedProblem &problem, const ContactState &state)
{
   const ContactAreas areas = contact_areas(problem, state);
   const std::string unit = study.units.of(0, 2);
   ResultTable &table = study.table("areas", {{"state", "state"},
                                              {"area", "area" + unit, "%.5g"},
                                              {"", "± (estimate)"},
                                              {"area_error_estimate"},
                                              {"nodes", "nodes"}});
   const std::pair<const char *, const SurfacePart *> all[] = {
      {"contact", &areas.contact},
      {"stick", &areas.stick},
      {"slip", &areas.slip},
      {"separation", &areas.separation}};
   for (const auto &[name, part] : all)
   {
      study.row(table, {name, part->area, error_text(part->error), part->error, part->nodes});
   }
}

} // namespace

void OwnHistory::report_state(const ReducedProblem &problem, const std::string &more)
{
   study_.results["time"] = state.time;
   study_.results["loads"] = named(problem, state.multipliers);
   study_.title(
      text("At time %g%s: ", state.time, report.not_unique ? ", one of several states" : "") +
      more);
   if (problem.nodes() == 0) { return; } // nothing can open or slip
   // At a sharp corner the pressure of the bodies has no limit, and that of a mesh grows.
   const Eigen::VectorXd pressure = tractions(problem, state.p);
   Eigen::Index highest = 0;
   const double peak = pressure.maxCoeff(&highest);
   const bool at_corner = std::any_of(
      problem.chains.begin(), problem.chains.end(),
      [&](const ContactChain &chain)
      {
         return (highest == chain.first && chain.ends[0] == LineEnd::corner) ||
                (highest == chain.first + chain.nodes - 1 && chain.ends[1] == LineEnd::corner);
      });
   study_.value("peak_pressure", peak,
                "peak pressure" + study_.units.of(1, -2) +
                   (at_corner ? ", at a corner (depends on the mesh)" : ""));
   const Eigen::Index touching = touching_nodes(problem, state);
   study_.results["touching_nodes"] = touching;
   if (problem.chains.empty())
   {
      report_areas(study_, problem, state);
      return;
   }
   const std::vector<Zone> zones = about_axis
                                      ? zones_to_axis(problem, cattaneo::zones(problem, state))
                                      : cattaneo::zones(problem, state);
   const bool one_line = zones.back().chain == 0;
   const std::vector<std::string> names = interfaces(problem);
   std::vector<std::optional<Circle>> circles;
   for (const ContactChain &chain : problem.chains)
   {
      circles.push_back(circle_of(problem, chain));
   }
   const bool round = std::any_of(circles.begin(), circles.end(),
                                  [](const auto &circle) { return circle.has_value(); });
   ResultTable &table =
      study_.table("zones", {{"state", "state"},
                             {"from", "from" + study_.units.of(0, 1), "%.5g"},
                             {"to", "to (arc length)" + study_.units.of(0, 1), "%.5g"},
                             {"", "± (estimate)"},
                             {"from_error_estimate"},
                             {"to_error_estimate"},
                             {"piece", one_line ? "" : "piece of the line"},
                             {"interface", names.size() > 1 ? "interface" : ""},
                             {"from_x"},
                             {"from_y"},
                             {"to_x"},
                             {"to_y"},
                             {"from_angle", round ? "angle from" : "", "%.3f"},
                             {"to_angle", round ? "to (degrees from x to y)" : "", "%.3f"}});
   // If there are many zones, each interface has one line, without errors.
   const bool brief = !study_.verbose() && zones.size() > 8;
   table.quiet(brief);
   if (brief) { study_.say("   zones by arc length" + study_.units.of(0, 1) + ":"); }
   for (const std::string &interface : brief ? names : std::vector<std::string>())
   {
      std::string line;
      int piece = -1;
      for (const Zone &zone : zones)
      {
         if (problem.chains[zone.chain].interface != interface) { continue; }
         line += (line.empty() ? interface + ": " : ", ") + name(zone.state) +
                 (zone.chain == piece ? "" : text(" from %.5g", zone.from.position)) +
                 text(" to %.5g", zone.to.position);
         piece = zone.chain;
      }
      std::printf("%s", wrapped(line, 3).c_str());
   }
   for (const Zone &zone : zones)
   {
      const ContactChain &chain = problem.chains[zone.chain];
      const Eigen::Vector2d from = place_along(problem, chain, zone.from.position),
                            to = place_along(problem, chain, zone.to.position);
      std::array<double, 2> angles = {none, none};
      if (const auto &circle = circles[zone.chain])
      {
         angles = {circle->angle(from), circle->angle_after(circle->angle(from), to)};
      }
      study_.row(table, {name(zone.state), zone.from.position, zone.to.position,
                         error_text(std::max(zone.from.error, zone.to.error)), zone.from.error,
                         zone.to.error, zone.chain + 1, chain.interface, from[0], from[1],
                         to[0], to[1], angles[0], angles[1]});
   }
   if (touching > 0)
   {
      study_.say(text("   %ld nodes touch without force, and count as separated",
                      static_cast<long>(touching)));
   }
   Panel &drawn =
      study_.lines("tractions", "Pressure, and shear over f (dashed)",
                   "arc length" + study_.units.of(0, 1), "p, q/f" + study_.units.of(1, -2));
   if (names.size() > 1) { drawn.say("apart", "interfaces"); }
   for (const std::string &interface : names)
   {
      Eigen::Index first = problem.nodes(), end = 0;
      for (const ContactChain &chain : problem.chains)
      {
         if (chain.interface != interface) { continue; }
         first = std::min(first, chain.first);
         end = std::max(end, chain.first + chain.nodes);
      }
      say_straight(drawn, problem, interface, about_axis);
      drawn.add_tractions(names.size() > 1 ? interface : text("time %g", state.time),
                          problem.arc_length, problem, state, first, end - first);
   }
}

void OwnHistory::report_march(const ReducedProblem &problem)
{
   if (problem.nodes() == 0) { return; }
   const ordered_json &cycles = report_cycles(study_, problem, report).json();
   study_.results["first_cycle"] = cycles.empty() ? ordered_json(0) : cycles[0]["cycle"];
   study_.results["total_dissipation"] = state.dissipation;
   report_loss_error(study_, report);
   study_.results["advance_error_estimate"] = report.advance_error;
   study_.results["largest_residual"] = report.largest_residual;
   report_exact_path(study_, problem, settings, report);
}

std::vector<Zone> zones_to_axis(const ReducedProblem &problem, std::vector<Zone> zones)
{
   for (Zone &zone : zones)
   {
      const ContactChain &chain = problem.chains[zone.chain];
      for (const int end : {0, 1})
      {
         const Eigen::Index last = end ? chain.first + chain.nodes - 1 : chain.first;
         // On a plane of symmetry the node exists, and is held.
         const bool at_axis = (end ? zone.last : zone.first) == last &&
                              chain.ends[end] == LineEnd::symmetry &&
                              std::count(problem.held.begin(), problem.held.end(), last) == 0;
         if (!at_axis) { continue; }
         (end ? zone.to : zone.from).position += (end ? 1 : -1) * problem.position(last, 0);
      }
   }
   return zones;
}

void report_critical_friction(Study &study, const ReducedProblem &problem)
{
   const CriticalFriction critical = critical_friction(problem);
   study.results["critical_friction"] = {{"node", critical.node},
                                         {"locking", critical.locking},
                                         {"unique_below", critical.unique_below}};
   // Without --verbose it is printed only if a coefficient of the case is at least half of the
   // smaller one of `node` and `locking`.
   const double near = 0.5 * std::min(critical.node, critical.locking);
   if (!study.verbose() && problem.friction.maxCoeff() < near) { return; }
   const auto words = [](double value, const char *if_infinite)
   { return std::isfinite(value) ? text("%g", value) : if_infinite; };
   const std::string which = std::isfinite(critical.node)
                                ? text(" (node %ld)", static_cast<long>(critical.weakest_node))
                                : "";
   study.say(
      "Critical friction: of a single node " + words(critical.node, "none") + which +
      ", the contact can lock itself above " + words(critical.locking, "none") +
      ", only one solution below " +
      (critical.unique_below > 0 ? words(critical.unique_below, "any") : "(nothing proven)"));
}

} // namespace miniapp
