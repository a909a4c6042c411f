#include "common/modal_curves.hpp"

#include "common/run.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

const double pi = std::acos(-1.0);
/// The largest damping ratio, and loss over the work of the state's forces, of loops in which
/// no node slips.
constexpr double no_slip = 1e-8, no_loss = 1e-12;
/// Modal forces below this share of the forces of the state are lost in their round-off: at
/// this share frequencies are wrong by some 1e-6.
constexpr double least_force = 1e-7;

/// "1e-7 … 1e-4" (or ... or to) in equal ratios, or a list of numbers.
std::vector<double> amplitudes(const std::string &words, int count)
{
   const std::vector<std::string> parts = split(words, " ,\t");
   const auto number = [&](const std::string &word)
   {
      const double value = cattaneo::number("option --amplitudes", word);
      require(value > 0 && std::isfinite(value), "option --amplitudes: ", value,
              ", must be positive and finite");
      return value;
   };
   std::vector<double> all;
   if (parts.size() == 3 && (parts[1] == "…" || parts[1] == "..." || parts[1] == "to"))
   {
      const double from = number(parts[0]), to = number(parts[2]);
      require(count >= 2, "option --points-of-curve is ", count,
              ", must be at least 2 for a range of amplitudes");
      for (int k = 0; k < count; ++k)
      {
         all.push_back(from * std::pow(to / from, static_cast<double>(k) / (count - 1)));
      }
      return all;
   }
   for (const std::string &part : parts) { all.push_back(number(part)); }
   return all;
}

/// The length of the displacement of a place per unit of the amplitude of a mode.
double displacement_at(const Scene &scene, const JointCase &joint, const Modes &modes,
                       std::size_t mode, const JointCase::Point &point)
{
   std::size_t meshes = 0;
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      if (!joint.bodies[b].matrix.empty()) { continue; } // its elements are not known
      const std::size_t mesh = meshes++;
      if (point.body >= 0 && point.body != static_cast<int>(b)) { continue; }
      const int dimension = scene.meshes[mesh]->Dimension();
      mfem::DenseMatrix place(dimension, 1);
      for (int c = 0; c < dimension; ++c) { place(c, 0) = point.at[c]; }
      mfem::Array<int> elements;
      mfem::Array<mfem::IntegrationPoint> within;
      scene.meshes[mesh]->FindPoints(place, elements, within, false);
      if (elements[0] < 0) { continue; }
      mfem::GridFunction field(&scene.bodies[mesh]->space());
      const VectorXd &shape = modes.shapes[mode][b];
      mfem::Vector dofs(static_cast<int>(shape.size()));
      std::copy(shape.begin(), shape.end(), dofs.begin());
      field.SetFromTrueDofs(dofs);
      mfem::Vector moved(dimension);
      field.GetVectorValue(elements[0], within[0], moved);
      return moved.Norml2();
   }
   throw InputError("point '" + point.name + "' of option --amplitude-at is in no body");
}

/// Slope of log y over log x, by least squares of its lower half (three points at least); NaN
/// with fewer.
double slope(const std::vector<double> &x, const std::vector<double> &y)
{
   std::vector<double> a, b;
   for (std::size_t k = 0; k < x.size(); ++k)
   {
      if (x[k] > 0 && y[k] > 0)
      {
         a.push_back(std::log(x[k]));
         b.push_back(std::log(y[k]));
      }
   }
   const auto used = static_cast<Index>(std::max<std::size_t>(3, (a.size() + 1) / 2));
   if (static_cast<Index>(a.size()) < used) { return none; }
   const VectorXd p = Eigen::Map<VectorXd>(a.data(), used),
                  q = Eigen::Map<VectorXd>(b.data(), used);
   const VectorXd from_mean = p.array() - p.mean();
   return from_mean.dot(q) / from_mean.squaredNorm();
}

/// The first size, from small ones on, at which the frequency is a tenth below that of the
/// glued mode, or the last before the joint slides as a whole or ratchets.
double default_size(FrictionSolver &solver, const ReducedProblem &problem,
                    const ContactState &state, const std::string &mode, double omega,
                    const ModalLoopSettings &settings)
{
   const LoadPattern &load = problem.patterns[problem.pattern(mode)];
   const double forces = std::hypot(load.q.norm(), load.p.norm());
   const double force = 1e-6 * std::hypot(state.p.norm(), state.q.norm()) / forces,
                small = settings.size == LoopSize::energy ? 0.5 * std::pow(force / omega, 2)
                                                          : force / (omega * omega);
   ModalLoopSettings rough = settings;
   rough.tolerance = 0.1;
   rough.steady_tolerance = 1e-4;
   double size = small;
   for (int k = 0; k < 20; ++k, size *= 4)
   {
      const ModalLoop loop = modal_loop(solver, problem, state, mode, omega, size, rough);
      if (loop.steady && std::isnan(loop.sliding_force) && loop.omega > 0.9 * omega)
      {
         continue;
      }
      if (!loop.steady && std::isnan(loop.sliding_force)) { return size / 4; }
      const double reached = settings.size == LoopSize::energy ? loop.energy : loop.amplitude;
      return std::isnan(loop.sliding_force) ? size : 0.9 * std::max(reached, size / 4);
   }
   return size;
}

/// The smallest loop whose forces are more than round-off of those of the state.
double smallest_size(const ReducedProblem &problem, const ContactState &state,
                     const std::string &mode, double omega, LoopSize size)
{
   const LoadPattern &load = problem.patterns[problem.pattern(mode)];
   const double force = least_force * std::hypot(state.p.norm(), state.q.norm()) /
                        std::hypot(load.q.norm(), load.p.norm());
   return size == LoopSize::energy ? 0.5 * std::pow(force / omega, 2) : force / (omega * omega);
}

/// A loop in which no node slips loses nothing but round-off. `work` is that of the forces of
/// the state.
void leave_round_off(ModalLoop &loop, double work)
{
   if (loop.zeta >= no_slip && loop.dissipation > no_loss * work) { return; }
   loop.zeta = loop.zeta_secant = loop.dissipation = 0;
   loop.node_dissipation.setZero();
}

/// Was no loop found, for another reason than that the joint slides?
bool fails(const ModalLoop &loop)
{
   const bool marched =
      loop.status == FrictionStatus::converged || loop.status == FrictionStatus::not_unique;
   return !std::isfinite(loop.sliding_force) && !(loop.force > 0 && loop.steady && marched);
}

/// Draws the loss by friction at each node, along each interface that loses a hundredth or
/// more.
void draw_along(Panel &panel, const std::string &label,
                const std::vector<InterfaceReport> &faces, const ModalLoop &loop)
{
   for (const InterfaceReport &face : faces)
   {
      if (face.tied || face.position.rows() == 0) { continue; }
      const VectorXd lost = loop.node_dissipation.segment(face.first, face.nodes);
      if (!(lost.sum() >= 0.01 * loop.dissipation) || loop.zeta == 0) { continue; }
      VectorXd along = VectorXd::Zero(face.nodes);
      for (Index i = 1; i < face.nodes; ++i)
      {
         along[i] = along[i - 1] + (face.position.row(i) - face.position.row(i - 1)).norm();
      }
      panel.add(label + ", " + face.name, along, lost / loop.dissipation);
   }
}

/// The force of a bolt in a state of a problem with modes.
double bolt_force(const ReducedProblem &problem, const ContactState &state,
                  const JointCase::Bolt &bolt)
{
   const auto load = static_cast<Index>(problem.pattern(bolt.name));
   return bolt.force * state.multipliers[load] -
          bolt.stiffness / bolt.force * conjugates(problem, state)[load];
}

/// By the name of each bolt: the force that it has lost in the middle of a loop, and its least
/// force in the loop.
ordered_json bolt_forces(const ReducedProblem &problem, const ContactState &assembled,
                         const ModalLoop &loop, const JointCase &joint)
{
   ordered_json all = ordered_json::object();
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      const double before = bolt_force(problem, assembled, bolt),
                   high = bolt_force(problem, loop.peak, bolt),
                   low = bolt_force(problem, loop.trough, bolt);
      all[bolt.name] = {{"force", before},
                        {"lost", before - 0.5 * (high + low)},
                        {"least", std::min(high, low)}};
   }
   return all;
}

/// "mode 1 (slope 0.98)".
std::string with_slope(const std::string &name, double slope)
{
   return std::isnan(slope) ? name : name + text(" (slope %.2f)", slope);
}

} // namespace

ModalCurves::ModalCurves(Study &study, int modes, bool points) : study_(study), modes_(modes)
{
   study.options().group("Modes and amplitudes");
   study.option(&modes_, "modes",
                modes > 0 ? "Number of modes, from the lowest one on."
                          : "Number of modes about the state without remote load, from the "
                            "lowest one on (0: none).",
                at_least(std::min(modes, 1)));
   study.option(
      &amplitudes_, "amplitudes",
      "Amplitudes, as a range in equal ratios, '1e-7 … 1e-4' (or ... in its place), or a "
      "list. Default: a range of a thousand, which ends where a tenth of the frequency is "
      "lost or the joint slides or ratchets.");
   study.option(&count_, "points-of-curve", "Number of amplitudes in a range.", at_least(2));
   const char *without = "Kind of the amplitudes: modal (half of the range of φᵀ M x) or "
                         "energy (½ α q, of the spring of the secant stiffness).",
              *with = "Kind of the amplitudes: modal (half of the range of φᵀ M x), energy "
                      "(½ α q, of the spring of the secant stiffness), or point (the "
                      "displacement of the glued mode at the point of --amplitude-at).";
   std::vector<std::string> kinds = {"modal", "energy"};
   if (points) { kinds.emplace_back("point"); }
   study.option(&kind_, "amplitude-of", points ? with : without, kinds);
   study.option(&shown_, "shown-amplitude",
                "Amplitude whose loop and losses along the interfaces are drawn: the nearest "
                "one of the list (default: the largest).",
                positive);
   if (!points) { return; }
   study.option(&at_, "amplitude-at",
                "Name of a point of the case: its displacement is in the table, and with "
                "--amplitude-of point amplitudes are displacements there.");
}

void ModalCurves::check_options()
{
   require((kind_ != "point") || !at_.empty(),
           "option --amplitude-of is point: option --amplitude-at must name it");
   if (!amplitudes_.empty()) { stated_ = amplitudes(amplitudes_, count_); }
   require(amplitudes_.empty() || !stated_.empty(), "option --amplitudes is '", amplitudes_,
           "', must have a number");
}

Modes ModalCurves::report_modes(const VibratingStructure &structure,
                                const ReducedProblem &problem, const ContactState &state,
                                const JointCase &joint)
{
   const double mass = structure.mass();
   const bool plane = joint.formulation == Formulation::plane,
              axis = joint.formulation == Formulation::axisymmetric;
   study_.value("total_mass", mass,
                plane && study_.units.per_thickness ? "total mass, per thickness"
                                                    : "total mass");
   const GluedRows glued = glued_rows(problem, state);
   const Modes modes = structure.modes(glued, modes_);
   int open = 0;
   for (const NodeState status : state.status) { open += !closed(status); }
   const int limit = nodes_at_limit(problem, state);
   study_.results["nodes_glued"] = problem.nodes() - open;
   study_.results["nodes_open"] = open;
   study_.results["nodes_at_limit"] = limit;
   study_.results["rigid_modes_left_out"] = modes.rigid;
   study_.say(text(
      "   %ld contact nodes are glued, %d of them at the limit of friction, and %d are open",
      static_cast<long>(problem.nodes() - open), limit, open));
   if (modes.rigid > 0) { study_.say(text("   %d rigid motions are left out", modes.rigid)); }
   std::vector<Column> columns = {
      {"mode", "mode"},
      {"frequency", "frequency [1/time]", "%.6g"},
      {"omega"},
      {"residual", "residual", "%.1e"},
      {"effective_mass_x", axis ? "" : "mass moved in x, of 1", "%.4f"},
      {"effective_mass_y", axis ? "mass moved in z, of 1" : "in y", "%.4f"}};
   if (joint.in_space()) { columns.push_back({"effective_mass_z", "in z", "%.4f"}); }
   ResultTable &table = study_.table("modes", columns);
   for (Index k = 0; k < modes.omega.size(); ++k)
   {
      std::vector<ordered_json> row = {k + 1, modes.omega[k] / (2 * pi), modes.omega[k],
                                       modes.residuals[k]};
      for (const double moved : modes.effective_mass.row(k)) { row.emplace_back(moved / mass); }
      study_.row(table, row);
   }
   for (Index k = 1; k < modes.omega.size(); ++k)
   {
      if (modes.omega[k] - modes.omega[k - 1] > 1e-4 * modes.omega[k]) { continue; }
      warn(
         text("modes %ld and %ld have the same frequency to 0.01 %%: their shapes are any two "
              "of a family, and so are their loops and damping ratios",
              static_cast<long>(k), static_cast<long>(k + 1)));
   }
   return modes;
}

double ModalCurves::drawn_size(const ModalLoop &loop, double at_point) const
{
   return kind_ == "energy"  ? loop.energy
          : kind_ == "point" ? loop.amplitude * at_point
                             : loop.amplitude;
}

void ModalCurves::report_loops(const VibratingStructure &structure, const Modes &modes,
                               const Scene &scene, const JointCase &joint,
                               const ContactState &reached)
{
   // 1. The problem with the loads of the modes.
   const ReducedProblem problem = structure.with_modes(modes);
   study_.save(problem);
   const ContactState state = structure.with_modes(modes, reached);
   FrictionSolver solver(problem);
   const JointCase::Point *point = nullptr;
   for (const JointCase::Point &one : joint.points)
   {
      if (one.name == at_) { point = &one; }
   }
   require(at_.empty() || point, "option --amplitude-at is '", at_,
           "', which is no point of the case (key 'points')");

   // 2. The table and the figure.
   const std::vector<InterfaceReport> &faces = scene.reduction.interfaces;
   ResultTable &table = study_.table(
      "loops", {{"mode", "mode"},
                {"amplitude", "amplitude", "%.4g"},
                {"at_point", point ? "at " + at_ + study_.units.of(0, 1) : "", "%.4g"},
                {"frequency", "frequency [1/time]", "%.6g"},
                {"change", "less than glued by [%]", "%.4f"},
                {"zeta", "damping ratio", "%.4g"},
                {"dissipation", "loss" + study_.units.total(1), "%.4g"},
                {"most_lost", "most at"},
                {"slipping", "nodes slip"},
                {"bolt_loss", joint.bolts.empty() ? "" : "a bolt loses [%]", "%.3g"},
                {"status", "status"},
                {"omega"},
                {"omega_secant"},
                {"zeta_secant"},
                {"omega_first_loading"},
                {"zeta_masing"},
                {"force"},
                {"energy"},
                {"area"},
                {"cycles"},
                {"state_change"},
                {"ratchet"},
                {"sliding_force"}});
   const std::string size =
      kind_ == "energy" ? "energy ½ α q" + study_.units.total(1)
      : kind_ == "point"
         ? "displacement at " + at_ + study_.units.of(0, 1)
         : "modal amplitude q = φᵀM x " +
              (study_.units.length.empty()
                  ? std::string("[length √mass]")
                  : "[s √(" + study_.units.force + " " + study_.units.length + ")]");
   Panel &frequency = study_.lines("frequency", "Frequency over amplitude", size,
                                   "frequency over that of the glued mode");
   Panel &damping = study_.lines("damping", "Damping over amplitude", size, "damping ratio ζ");
   Panel &softening =
      study_.lines("softening", "Loss of frequency over amplitude", size, "1 - ω/ω glued");
   Panel &loops = study_.lines("loop", "Steady loops", "modal amplitude over the largest",
                               "modal force over the largest");
   Panel &map = study_.lines("losses", "Where they lose",
                             "place along the interface" + study_.units.of(0, 1),
                             "share of the loss of each node");
   frequency.say("scale", "semilogx");
   damping.say("scale", "loglog");
   softening.say("scale", "loglog");

   // 3. Mode after mode.
   const double work =
      state.p.cwiseAbs().dot(state.w.cwiseAbs()) + state.q.cwiseAbs().dot(state.v.cwiseAbs());
   ModalLoopSettings settings;
   settings.size = kind_ == "energy" ? LoopSize::energy : LoopSize::amplitude;
   // In space each trial takes many increments. A loop of nearly the requested amplitude is a
   // point of the same curve, and the table has its own amplitude.
   settings.tolerance = joint.in_space() ? 0.02 : 1e-3;
   settings.march.increments = 8; // in space, where they are doubled as needed
   for (Index k = 0; k < modes.omega.size(); ++k)
   {
      const std::string name = "mode " + std::to_string(k + 1);
      const double glued = modes.omega[k],
                   at_point = point ? displacement_at(scene, joint, modes,
                                                      static_cast<std::size_t>(k), *point)
                                    : none;
      require(kind_ != "point" || at_point > 0, "mode ", k + 1, " does not move the point '",
              at_, "': option --amplitude-at must name another");
      std::vector<double> sizes = stated_, x, zeta, ratio, lost;
      for (double &its : sizes)
      {
         if (kind_ == "point") { its /= at_point; }
      }
      const double least = smallest_size(problem, state, name, glued, settings.size);
      if (sizes.empty())
      {
         const double most = default_size(solver, problem, state, name, glued, settings);
         for (int j = 0; j < count_; ++j)
         {
            const double share = std::pow(1e-3, 1 - static_cast<double>(j) / (count_ - 1));
            sizes.push_back(std::max(least, share * most));
         }
      }
      std::sort(sizes.begin(), sizes.end());
      sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
      const double unit = kind_ == "point" ? at_point : 1; // of a size, as it was asked for
      const std::string kind = kind_ == "energy"  ? "energy"
                               : kind_ == "point" ? "displacement at " + at_
                                                  : "amplitude";
      require(sizes.front() >= least, name, ": ", kind, " ", sizes.front() * unit,
              " must be at least ", least * unit,
              ": forces of a smaller one are round-off of those that hold the joint together");
      ModalLoop drawn;
      std::vector<ModalLoop> found =
         modal_curve(solver, problem, state, name, glued, sizes, settings);
      for (ModalLoop &loop : found) { leave_round_off(loop, work); }
      if (stated_.empty())
      {
         // A range of the program's own ends where loops end that are steady. It has two loops
         // at least, which say what fails.
         std::size_t end = sizes.size();
         while (end > 0 && fails(found[end - 1])) { --end; }
         if (end >= 2 && end < sizes.size())
         {
            warn(name + ": the range ends at " + kind +
                 text(" %.4g, since at %.4g ", sizes[end - 1] * unit, sizes[end] * unit) +
                 found[end].message);
            sizes.resize(end);
            found.resize(end);
         }
      }
      for (std::size_t j = 0; j < sizes.size(); ++j)
      {
         const ModalLoop &loop = found[j];
         const double its = sizes[j];
         const bool known = !fails(loop) && !std::isfinite(loop.sliding_force);
         if (fails(loop))
         {
            study_.code = 2;
            std::string where;
            for (const InterfaceReport &face : faces)
            {
               const Index first = face.first, behind = first + face.nodes;
               if (loop.ratchet > 0 && !face.tied && loop.ratchet_node >= first &&
                   loop.ratchet_node < behind)
               {
                  where = " (interface " + face.name + ")";
               }
            }
            warn(name + ", " + kind + text(" %g: ", its * unit) + loop.message + where);
         }
         row(table, loop, its,
             {k + 1, glued, at_point, known, joint.in_space(),
              known ? bolt_forces(problem, state, loop, joint) : ordered_json::object()},
             faces);
         if (!known) { continue; }
         x.push_back(drawn_size(loop, at_point));
         zeta.push_back(loop.zeta);
         ratio.push_back(loop.omega / glued);
         lost.push_back(std::max(0.0, 1 - loop.omega / glued));
         const auto away = [&](const ModalLoop &one)
         { return std::abs(std::log(drawn_size(one, at_point) / shown_)); };
         if (drawn.force == 0 || std::isnan(shown_) || away(loop) < away(drawn))
         {
            drawn = loop;
         }
      }
      // They are not on logarithmic axes.
      std::vector<double> lost_drawn = lost, zeta_drawn = zeta;
      for (std::size_t j = 0; j < x.size(); ++j)
      {
         if (zeta_drawn[j] == 0) { zeta_drawn[j] = none; }
         if (lost_drawn[j] < 1e-6) { lost_drawn[j] = none; }
      }
      const double zeta_slope = slope(x, zeta_drawn), lost_slope = slope(x, lost_drawn);
      study_.results["slopes"].push_back(
         {{"mode", k + 1}, {"zeta", zeta_slope}, {"softening", lost_slope}});
      frequency.add(name, x, ratio);
      damping.add(with_slope(name, zeta_slope), x, zeta_drawn);
      softening.add(with_slope(name, lost_slope), x, lost_drawn);
      if (drawn.force == 0) { continue; }
      const std::string label = name + text(" at %.3g", drawn_size(drawn, at_point));
      for (const LoopPoint &one : drawn.points)
      {
         loops.point(label, one.amplitude / drawn.amplitude, one.force / drawn.force);
      }
      if (!joint.in_space()) { draw_along(map, label, faces, drawn); }
      else if (draw_losses && drawn.zeta > 0)
      {
         const auto lost_by = [&](const InterfaceReport &face) {
            return face.tied ? 0.0
                             : drawn.node_dissipation.segment(face.first, face.nodes).sum();
         };
         draw_losses(k + 1, label,
                     *std::max_element(faces.begin(), faces.end(),
                                       [&](const auto &a, const auto &b)
                                       { return lost_by(a) < lost_by(b); }),
                     drawn);
      }
   }
}

void ModalCurves::row(ResultTable &table, const ModalLoop &loop, double size, const Row &of,
                      const std::vector<InterfaceReport> &faces)
{
   // 1. How much each interface loses, and does it slide as a whole at the peak?
   ordered_json interfaces = ordered_json::object();
   std::string most_at;
   double most = 0;
   int slipping = 0;
   const bool slips = loop.zeta > 0;
   for (const InterfaceReport &face : faces)
   {
      if (face.tied || !of.known) { continue; }
      const VectorXd lost = loop.node_dissipation.segment(face.first, face.nodes);
      int touching = 0, slip = 0;
      for (Index i = 0; i < face.nodes; ++i)
      {
         touching += closed(loop.peak.status[face.first + i]);
         slip += slips && lost[i] > 1e-6 * loop.dissipation;
      }
      slipping += slip;
      interfaces[face.name] = {{"loss", lost.sum()},
                               {"nodes_that_slip", slip},
                               {"nodes_closed_at_the_peak", touching},
                               {"node_losses", std::vector<double>(lost.begin(), lost.end())}};
      if (slips && lost.sum() > most)
      {
         most = lost.sum();
         most_at = face.name + text(" (%.0f %%)", 100 * most / loop.dissipation);
      }
   }
   // 2. The largest share of its force that a bolt loses.
   double bolt_loss = none;
   for (const auto &[name, bolt] : of.bolts.items())
   {
      const double share = 100 * bolt["lost"].get<double>() / bolt["force"].get<double>();
      if (!(bolt_loss >= share)) { bolt_loss = share; }
   }
   // 3. The row.
   const bool slides = std::isfinite(loop.sliding_force);
   const auto or_none = [&](double value) { return of.known ? value : none; };
   ordered_json more = {
      {"interfaces", interfaces}, {"bolts", of.bolts}, {"message", loop.message}};
   if (of.by_increments)
   {
      more["omega_error_estimate"] = or_none(loop.omega_error);
      more["zeta_error_estimate"] = or_none(loop.zeta_error);
   }
   study_.row(table,
              {of.mode,
               of.known            ? loop.amplitude
               : kind_ == "energy" ? none
                                   : size,
               or_none(loop.amplitude) * of.at_point,
               or_none(loop.omega / (2 * pi)),
               100 * (1 - or_none(loop.omega) / of.glued),
               or_none(loop.zeta),
               or_none(loop.dissipation),
               most_at,
               slipping,
               bolt_loss,
               slides             ? text("slides at %.4g", loop.sliding_force)
               : loop.ratchet > 0 ? text("moves on by %.3g in each cycle", loop.ratchet)
               : loop.force > 0 && !loop.steady ? text("not steady after %d cycles", loop.cycle)
                                                : std::string(cattaneo::name(loop.status)),
               or_none(loop.omega),
               or_none(loop.omega_secant),
               or_none(loop.zeta_secant),
               or_none(loop.omega_first),
               or_none(loop.zeta_masing),
               or_none(loop.force),
               of.known || kind_ != "energy" ? or_none(loop.energy) : size,
               or_none(loop.area),
               loop.cycle,
               loop.change,
               loop.ratchet,
               loop.sliding_force},
              {}, more);
}

} // namespace miniapp
