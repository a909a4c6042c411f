//  joint: frequency and damping of a bolted joint against amplitude, mode by mode
//
//  Reads a case file of the program contact, in which bodies have the key density. Tightens the
//  bolts, and finds the modes of the joint with all closed nodes glued. Then moves each mode
//  quasi-statically to and fro with a list of amplitudes. The steady loop of force over modal
//  amplitude gives the frequency and the damping ratio of a vibration. docs/joint_dynamics.md
//  states the assumptions. Units are those of the case: with mm, N and t/mm³ frequencies are
//  in Hz.
//
//  Sample runs:
//    joint --case meshes/bolted_joint.json --modes 4 --amplitudes "1e-7 … 2e-5"
//    joint --case meshes/bolted_joint_drawing.json --modes 1 --points-of-curve 4

#include "common/modal_curves.hpp"
#include "common/run.hpp"
#include "common/watch.hpp"
#include "contact/contact_in_space.hpp"
#include "contact/report_in_space.hpp"
#include "joint/case_of_joint.hpp"

#include <algorithm>
#include <cattaneo/contact/vibrating_body.hpp>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>
#include <map>

using namespace cattaneo;
using namespace miniapp;
using Eigen::Index;
using Eigen::VectorXd;

namespace
{

/// Adds the matrix that is this body, with its mass; false if it has none.
bool add_matrix(std::vector<VibratingBody> &all, const OwnBodies &own, std::size_t body)
{
   const auto found = own.vibrating.find(body);
   if (found == own.vibrating.end()) { return false; }
   all.push_back(found->second);
   return true;
}
bool add_matrix(std::vector<VibratingBody> &, const BodiesInSpace &, std::size_t)
{
   return false;
}

/// Every body must have a mass. `Own` is OwnBodies or BodiesInSpace.
template <class Own>
std::vector<VibratingBody> with_mass(const JointCase &joint, const Own &own)
{
   std::vector<VibratingBody> all;
   std::size_t mesh = 0; // matrices have no elements
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      const JointCase::Body &body = joint.bodies[b];
      require(!body.half_plane, "body ", body.name,
              " is a half-plane, which has no mass: all bodies of a joint that vibrates must "
              "have meshes, or be matrices with a mass");
      if (!body.matrix.empty())
      {
         require(add_matrix(all, own, b), body.source.called("mass"),
                 " is missing: all matrices of a joint that vibrates must have one, a file of "
                 "the program that wrote the matrix");
         continue;
      }
      require(!own.densities[mesh].empty(), body.source.called("density"),
              " is missing: all bodies of a joint that vibrates must have one (in mm and N "
              "steel has 7.85e-9)");
      all.push_back(vibrating_body(*own.scene.bodies[mesh], own.densities[mesh]));
      ++mesh;
   }
   return all;
}

/// Says the speed of sound √(E/ρ) of each body, and warns where it or the density is that of no
/// solid. Only where the case names units that are known here.
template <class Own>
void report_units(Study &study, const JointCase &joint, const Own &own)
{
   const std::map<std::string, double> metres{{"m", 1},      {"cm", 1e-2}, {"mm", 1e-3},
                                              {"um", 1e-6},  {"µm", 1e-6}, {"in", 0.0254},
                                              {"ft", 0.3048}},
      newtons{{"N", 1},          {"mN", 1e-3},      {"daN", 10},      {"kN", 1e3},
              {"MN", 1e6},       {"uN", 1e-6},      {"µN", 1e-6},     {"kgf", 9.80665},
              {"kp", 9.80665},   {"lbf", 4.448222}, {"lb", 4.448222}, {"kip", 4448.222},
              {"kips", 4448.222}};
   const auto length = metres.find(joint.unit_of_length);
   if (length == metres.end()) { return; }
   const auto force = newtons.find(joint.unit_of_force);
   // A unit of density in kg/m³: force · time² / length⁴.
   const double unit =
      force == newtons.end() ? none : force->second / std::pow(length->second, 4);
   constexpr double densest = 23000; // osmium has 22,590 kg/m³
   const std::string accelerated = text(
      "With %s and %s the unit of density is a mass per %s³, and 1 %s accelerates that mass "
      "by 1 %s/s²",
      joint.unit_of_length.c_str(), joint.unit_of_force.c_str(), joint.unit_of_length.c_str(),
      joint.unit_of_force.c_str(), joint.unit_of_length.c_str());
   std::vector<std::pair<std::string, std::string>> said; // speeds, names of bodies
   std::size_t mesh = 0;
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      if (!joint.bodies[b].matrix.empty()) { continue; } // nothing is known of it
      const std::vector<Material> &its = own.materials[mesh];
      const std::vector<double> &densities = own.densities[mesh++];
      const std::string &name = joint.bodies[b].name;
      double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
      bool warned = false;
      for (std::size_t a = 0; a < std::max(its.size(), densities.size()); ++a)
      {
         const double young = its[its.size() == 1 ? 0 : a].young,
                      density = densities[densities.size() == 1 ? 0 : a],
                      speed = std::sqrt(young / density) * length->second;
         slowest = std::min(slowest, speed);
         fastest = std::max(fastest, speed);
         if (warned) { continue; }
         warned = true;
         if (speed < 100 || speed > 20000)
         {
            warn(text("body %s: Young's modulus %g and density %g give a speed of sound of %g "
                      "m/s in the units that the case names. Solids have 100 to 20,000 m/s. %s",
                      name.c_str(), young, density, speed, accelerated.c_str()));
         }
         else if (density * unit > densest)
         {
            warn(text("body %s: density %g is %.3g kg/m³ in the units that the case names, "
                      "where no solid has more than 23,000 and steel has %.3g (7850 kg/m³). %s",
                      name.c_str(), density, density * unit, 7850 / unit, accelerated.c_str()));
         }
         else { warned = false; }
      }
      study.results["speeds_of_sound"][name] = {{"least", slowest}, {"most", fastest}};
      const std::string speeds =
         text("%.4g", slowest) + (fastest > slowest ? text(" to %.4g", fastest) : "");
      if (said.empty() || said.back().first != speeds) { said.emplace_back(speeds, name); }
      else { said.back().second += ", " + name; }
   }
   for (const auto &[speeds, names] : said)
   {
      study.say("   speed of sound √(E/ρ) in " + names + ": " + speeds + " m/s");
   }
}

/// The opening part of a history, up to one of its points.
LoadHistory up_to(const LoadHistory &history, Index point)
{
   LoadHistory opening;
   opening.times = history.times.head(point + 1);
   opening.multipliers = history.multipliers.leftCols(point + 1);
   opening.cycles = 1;
   const auto stated = static_cast<Index>(history.stated.size());
   opening.stated.assign(history.stated.begin(),
                         history.stated.begin() + std::min(stated, point + 1));
   return opening;
}

/// The point at which the joint is assembled: where its last bolt is tightened, else where its
/// cycle starts, else its last.
Index assembled_at(const LoadHistory &history, const JointCase &joint,
                   const ReducedProblem &problem, int cycle_start)
{
   const Index points = history.times.size();
   Index at = -1;
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      const auto values = history.multipliers.row(problem.pattern(bolt.name));
      for (Index k = 1; k < points; ++k)
      {
         if (values[k] != values[k - 1]) { at = std::max(at, k); }
      }
   }
   return at >= 0 ? at : cycle_start >= 0 ? cycle_start : points - 1;
}

/// Does nothing but the missing friction of some interfaces let the bodies float apart? Then
/// says so in `why`.
bool slides_freely(const VibratingStructure &structure, const ReducedProblem &problem,
                   const ContactState &state, const std::vector<InterfaceReport> &faces,
                   const Modes &modes, std::string &why)
{
   if (modes.rigid == 0) { return false; }
   GluedRows rough = glued_rows(problem, state);
   const Index n = problem.nodes();
   std::string names;
   for (const InterfaceReport &face : faces)
   {
      bool smooth = false;
      for (Index i = face.first; !face.tied && i < face.first + face.nodes; ++i)
      {
         if (!closed(state.status[i]) || problem.friction[i] > 0) { continue; }
         smooth = true;
         for (Index row = i; row < problem.slips(); row += n) { rough[row] = true; }
      }
      if (smooth) { names += (names.empty() ? "" : ", ") + face.name; }
   }
   // With friction there fewer motions would be free.
   if (names.empty() || structure.modes(rough, 1).rigid == modes.rigid) { return false; }
   why = "friction is 0 at interface " + names +
         ", and nothing else holds the bodies there along it: they slide apart under the "
         "forces of a mode, and no mode has a loop. Friction or a support must hold them";
   return true;
}

/// Draws which share of the loss each node of a surface has, per area. Nodes that lose nothing
/// are shown as stick.
void map_of_losses(Study &study, const Reduction &reduction, Index mode,
                   const std::string &title, const InterfaceReport &face, const ModalLoop &loop)
{
   const ReportInSpace::Map map = ReportInSpace::map_of(reduction, face);
   Panel &panel = study.panel(Panel::Kind::map, "losses_" + std::to_string(mode),
                              title + ": loss per area at " + face.name,
                              direction_name(map.across) + study.units.of(0, 1),
                              direction_name(map.up) + study.units.of(0, 1));
   for (const auto &triangle : map.triangles)
   {
      for (const Index i : triangle)
      {
         const double share = loop.node_dissipation[face.first + i] / loop.dissipation;
         panel.corner(map.flat(face.places.row(i)), share / face.weights[i],
                      closed(loop.peak.status[face.first + i]), share <= 1e-6);
      }
   }
}

/// The case without bolts that are not tightened yet at the end of the opening part of its
/// history: no force holds their shanks. A bolt that the history never names stays, and its
/// march says so.
JointCase without_loose_bolts(const JointCase &joint, const ReducedProblem &problem,
                              const LoadHistory &history, const LoadHistory &opening)
{
   JointCase assembled = joint;
   const auto loose = [&](const JointCase::Bolt &bolt)
   {
      const auto load = static_cast<Index>(problem.pattern(bolt.name));
      bool named = false;
      for (int k = 1; k < history.times.size(); ++k)
      {
         named = named || history.states(k, load);
      }
      return bolt.tightened && named && opening.multipliers.row(load).isZero(0);
   };
   assembled.bolts.erase(std::remove_if(assembled.bolts.begin(), assembled.bolts.end(), loose),
                         assembled.bolts.end());
   return assembled;
}

/// The history of one problem for another one, which has some of its loads.
LoadHistory of_loads(const LoadHistory &history, const ReducedProblem &from,
                     const ReducedProblem &to)
{
   LoadHistory made = history;
   made.multipliers.resize(static_cast<Index>(to.patterns.size()), history.times.size());
   std::map<int, int> number; // of a load there, by that here
   for (std::size_t k = 0; k < to.patterns.size(); ++k)
   {
      const auto before = static_cast<int>(from.pattern(to.patterns[k].name));
      number[before] = static_cast<int>(k);
      made.multipliers.row(static_cast<Index>(k)) = history.multipliers.row(before);
   }
   for (std::vector<int> &loads : made.stated)
   {
      std::vector<int> its;
      for (const int load : loads)
      {
         if (number.count(load) > 0) { its.push_back(number[load]); }
      }
      loads = its;
   }
   return made;
}

template <class Own>
void require_contact(const Own &own)
{
   const ReducedProblem &problem = own.scene.problem();
   require(!problem.patterns.empty(), "there is no load: nothing presses the bodies together");
   require(problem.nodes() > 0, "all interfaces are tied: the joint is linear, it has one "
                                "frequency for each mode and no damping");
}

/// Modes and loops about the end of this part of the history, a point of it by its number.
template <class Own>
void vibrate_after(Study &study, const CaseOfJoint &options, ModalCurves &curves,
                   const JointCase &joint, Own &own, const LoadHistory &opening, Index point)
{
   // 1. Bodies, reduced to their contact nodes.
   ReducedProblem &problem = own.scene.problem();
   std::vector<VibratingBody> bodies = with_mass(joint, own);
   study.condensed(own.scene);
   report_units(study, joint, own);

   // 2. The march to the state about which it vibrates.
   opening.validate(problem);
   ContactState state = ContactState::virgin(problem);
   MarchSettings settings;
   settings.keep_increments = false;
   if (joint.in_space()) { settings.increments = options.increments; }
   Watch watch("march");
   settings.monitor = watch.monitor();
   const MarchReport report = own.bolted ? own.bolted->march(opening, state, settings)
                                         : march(problem, opening, state, settings);
   study.counters += report.counters;
   add_outcome(problem, report, study.results);
   study.code = exit_code(problem, report);
   if (study.code != 0) { return; }
   study.results["loads"] = named(problem, state.multipliers);
   require(state.p.maxCoeff() > 0, "at point ", point,
           " of the history no contact node carries a force, so that none is glued: a load or "
           "a bolt must press the bodies together before (option --at-point names another "
           "point)");

   // 3. Modes with the closed nodes glued.
   std::vector<Bolt> shanks;
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      shanks.push_back({bolt.name, bolt.stiffness / (bolt.force * bolt.force)});
   }
   const VibratingStructure structure(own.scene.reduction, std::move(bodies), shanks);
   study.say(text("At point %ld of the history:", static_cast<long>(point)));
   const Modes modes = curves.report_modes(structure, problem, state, joint);

   if (std::string why;
       slides_freely(structure, problem, state, own.scene.reduction.interfaces, modes, why))
   {
      warn(why);
      study.results["message"] = why;
      study.code = 2;
      return;
   }

   // 4. Loops of each mode at each amplitude.
   if (joint.in_space())
   {
      curves.draw_losses = [&](Index mode, const std::string &title,
                               const InterfaceReport &face, const ModalLoop &loop)
      { map_of_losses(study, own.scene.reduction, mode, title, face, loop); };
   }
   curves.report_loops(structure, modes, own.scene, joint, state);
}

/// Reads the history of a case, and leaves out the bolts that it tightens only after the point
/// about which the joint vibrates. `make` makes the bodies of a case.
template <class Make>
void vibrate(Study &study, const CaseOfJoint &options, ModalCurves &curves,
             const JointCase &joint, const Make &make)
{
   auto own = make(joint);
   require_contact(own);
   const ReducedProblem &problem = own.scene.problem();
   LoadHistory history = load_history("history", options.history, problem);
   for (const auto &[load, with] : joint.go_with)
   {
      history.multipliers.row(problem.pattern(load)) =
         history.multipliers.row(problem.pattern(with));
   }
   const Index last = history.times.size() - 1;
   require(options.at_point <= last, "option --at-point is ", options.at_point,
           ", the history has the points 0 to ", last);
   const Index point = options.at_point >= 0
                          ? options.at_point
                          : assembled_at(history, joint, problem, options.cycle_start);
   require(point > 0, "option --at-point is 0, where no load acts: it must be 1 at least");
   const LoadHistory opening = up_to(history, point);
   const JointCase assembled = without_loose_bolts(joint, problem, history, opening);
   if (assembled.bolts.size() == joint.bolts.size())
   {
      vibrate_after(study, options, curves, joint, own, opening, point);
      return;
   }
   std::string loose;
   for (const JointCase::Bolt &bolt : joint.bolts)
   {
      const bool stays =
         std::any_of(assembled.bolts.begin(), assembled.bolts.end(),
                     [&](const JointCase::Bolt &its) { return its.name == bolt.name; });
      if (stays) { continue; }
      study.results["bolts_not_tightened"].push_back(bolt.name);
      loose += (loose.empty() ? "" : ", ") + bolt.name;
   }
   study.say("Not tightened yet, and left out: " + loose);
   auto without = make(assembled);
   require_contact(without);
   vibrate_after(study, options, curves, assembled, without,
                 of_loads(opening, problem, without.scene.problem()), point);
}

void joint_study(Study &study)
{
   CaseOfJoint options(study);
   ModalCurves curves(study);
   study.parse();
   curves.check_options();
   const JointCase joint = options.joint();
   options.name_units(study, joint);
   if (joint.in_space())
   {
      require(!study.options().says("check"),
              "option --check shows plane bodies: leave it out of a case in space");
      vibrate(study, options, curves, joint,
              [](const JointCase &its) { return make_bodies_in_space(its); });
   }
   else
   {
      vibrate(study, options, curves, joint,
              [](const JointCase &its) { return make_own_bodies(its); });
   }
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("joint", argc, argv, joint_study);
}
