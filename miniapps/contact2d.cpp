//  contact2d: frictional contact of your own meshes: two bodies, or one on a rigid line
//
//  Reads one or two meshes (MFEM, or Gmsh in format 2.2), condenses them to the nodes of their
//  contact attributes and marches a load history with Coulomb friction. Materials, supports,
//  loads and history come from options, from a JSON case file, or from both: docs/contact2d.md
//  describes them. Units are the user's: forces are per unit thickness.
//
//  Sample runs:  contact2d -case meshes/dovetail.json
//                contact2d -case meshes/rounded_punch.json --cycles 2 -edges "1 2 3"
//                contact2d -mesh1 meshes/rounded_punch.msh -contact1 3 -load1 "P pressure 2 .1"

#include "common/case_options.hpp"
#include "common/contact_edges.hpp"
#include "common/fields.hpp"
#include "common/filled_corner.hpp"
#include "common/locking.hpp"
#include "common/mesh_file.hpp"
#include "common/statements.hpp"
#include "common/study_output.hpp"

#include <algorithm>
#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

using namespace cattaneo;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// What the options say of one body.
struct BodyOptions
{
   const char *mesh = "", *young = "1", *poisson = "0.3", *contact = "", *support = "",
              *load = "";
};

struct Side
{
   std::unique_ptr<mfem::Mesh> mesh;
   std::vector<Material> materials; ///< one, or one for each element attribute
   std::unique_ptr<ElasticBody> body;
   CondensedBody condensed;
};

std::vector<Material> materials(const BodyOptions &options, const std::string &k,
                                bool plane_stress)
{
   std::vector<double> young = miniapp::numbers(("young" + k).c_str(), options.young);
   std::vector<double> poisson = miniapp::numbers(("poisson" + k).c_str(), options.poisson);
   require(!young.empty() && !poisson.empty(), "options young", k, " and poisson", k,
           " must not be empty");
   const std::size_t count = std::max(young.size(), poisson.size());
   if (young.size() == 1) { young.resize(count, young[0]); }
   if (poisson.size() == 1) { poisson.resize(count, poisson[0]); }
   require(young.size() == poisson.size(), "options young", k, " and poisson", k, " have ",
           young.size(), " and ", poisson.size(), " values, must have as many (or one)");
   std::vector<Material> list;
   for (std::size_t a = 0; a < count; ++a)
   {
      list.push_back(
         {young[a], poisson[a], plane_stress ? PlaneState::stress : PlaneState::strain});
   }
   return list;
}

Side make_side(const BodyOptions &options, const std::string &k, int order, bool plane_stress)
{
   try
   {
      require(options.contact[0], "option contact", k,
              " is empty, must name boundary attributes");
      Side side;
      mfem::Mesh mesh = miniapp::read_mesh(options.mesh);
      miniapp::warn_of_lower_order(mesh, order, options.mesh);
      const int attributes = mesh.attributes.Size() ? mesh.attributes.Max() : 1;
      side.mesh = miniapp::distribute(std::move(mesh), order);
      side.materials = materials(options, k, plane_stress);
      require(side.materials.size() == 1 ||
                 side.materials.size() <= static_cast<std::size_t>(attributes),
              "options young", k, " and poisson", k, " have ", side.materials.size(),
              " values, must have one, or one for each element attribute of the mesh, 1 to ",
              attributes);
      const std::vector<Material> &list = side.materials;
      side.body = list.size() == 1 ? std::make_unique<ElasticBody>(*side.mesh, order, list[0])
                                   : std::make_unique<ElasticBody>(*side.mesh, order, list);
      for (const Material &material : list)
      {
         if (!miniapp::locks(order, material)) { continue; }
         miniapp::warn_of_locking(order, material);
         break;
      }
      miniapp::add_supports(*side.body, "support" + k, options.support);
      miniapp::add_loads(*side.body, "load" + k, options.load);
      const ContactLine line =
         contact_line(*side.body, miniapp::boundary_part("contact" + k, options.contact));
      side.condensed = condense(*side.body, line, miniapp::condensation());
      return side;
   }
   catch (const InputError &error)
   {
      throw InputError("body " + k + " ('" + options.mesh + "'): " + error.what());
   }
}

Eigen::Vector2d mean_normal(const ContactLine &line)
{
   return (line.each(&LineNode::normal).transpose() * line.each(&LineNode::weight))
      .normalized();
}

/// Displacements are small: a node presses along its own normal. One that bears although this
/// is far from the rigid line's, on a side beyond a corner for instance, holds the body as no
/// line could.
class SidesThatBear
{
public:
   explicit SidesThatBear(const ContactLine &line) : line_(line)
   {
      const Eigen::VectorXd cosine = line.each(&LineNode::normal) * mean_normal(line);
      for (Eigen::Index i = 0; i < line.size(); ++i)
      {
         if (angle(cosine[i]) > 15) { sides_.push_back({i, angle(cosine[i])}); }
      }
   }
   /// A state that the march has reached.
   void note(const ContactState &state)
   {
      for (const Node &side : sides_)
      {
         if (closed(state.status[side.index]) &&
             state.p[side.index] > 1e-9 * state.p.maxCoeff() && side.angle > worst_.angle)
         {
            worst_ = side;
         }
      }
   }
   void warn() const
   {
      if (worst_.index < 0) { return; }
      std::ostringstream text;
      text << "node " << worst_.index << " at (" << line_.nodes[worst_.index].position[0]
           << ", " << line_.nodes[worst_.index].position[1] << ") bears although its normal is "
           << std::lround(worst_.angle)
           << " degrees off that of the rigid line: forces and zones are wrong there, name no "
              "boundary around a corner as contact";
      miniapp::warn(text.str());
   }

private:
   struct Node
   {
      Eigen::Index index = -1;
      double angle = 0; ///< degrees between its normal and the line's
   };
   static double angle(double cosine)
   {
      return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
   }

   const ContactLine &line_;
   std::vector<Node> sides_;
   Node worst_;
};

/// The rigid obstacle is the straight line that touches the contact nodes, across their mean
/// normal.
Reduction on_rigid_line(const CondensedBody &body)
{
   const ContactLine &line = body.line;
   const Eigen::Vector2d normal = mean_normal(line);
   const double level = (line.each(&LineNode::position) * normal).minCoeff();
   return reduce(body,
                 [=](double x, double y) { return normal.dot(Eigen::Vector2d(x, y)) - level; });
}

Pairing paired(const ContactLine &line1, const ContactLine &line2, double tolerance)
{
   try
   {
      return pair_lines(line1, line2, tolerance);
   }
   catch (const InputError &error)
   {
      throw InputError(std::string("option ") + error.what());
   }
}

struct Wedge
{
   double angle; ///< that the body fills
   Material material;
};

Wedge wedge_at(const Side &side, Eigen::Index node)
{
   const miniapp::FilledCorner corner =
      miniapp::filled_corner(*side.mesh, side.condensed.line.nodes[node].position);
   const std::size_t last = side.materials.size() - 1;
   return {corner.angle, side.materials[std::min<std::size_t>(corner.attribute - 1, last)]};
}

bool similar(const Material &a, const Material &b)
{
   return a.young == b.young && a.poisson == b.poisson;
}

/// The corner at the first (1) or the last (-1) node of body 1's line; the lines of the two
/// bodies run against each other.
fretting::CornerModes corner_at(const std::vector<Side> &sides, int end)
{
   const Eigen::Index last = sides[0].condensed.line.size() - 1;
   const Wedge pad = wedge_at(sides[0], end > 0 ? 0 : last);
   if (sides.size() == 1)
   {
      return fretting::corner_modes(fretting::RigidCorner{
         pad.angle, pad.material.poisson, pad.material.state == PlaneState::stress});
   }
   const Wedge body = wedge_at(sides[1], end > 0 ? last : 0);
   require(similar(pad.material, body.material),
           "the bodies differ in material there, whose exponents are not known here");
   const double gap = 2 * std::acos(-1.0) - pad.angle - body.angle;
   require(gap > 1e-6, "the surfaces of both bodies run on smoothly there: the contact line is "
                       "cut off, lengthen it");
   return fretting::corner_modes(fretting::Corner{pad.angle, body.angle});
}

/// States of a march at given times, each the first one that reaches its time.
struct Snapshots
{
   std::vector<double> times;
   std::vector<ContactState> states;

   void note(const ContactState &reached)
   {
      for (std::size_t k = 0; k < times.size(); ++k)
      {
         if (states[k].status.empty() && reached.time >= times[k]) { states[k] = reached; }
      }
   }
   bool complete() const
   {
      return std::none_of(states.begin(), states.end(),
                          [](const ContactState &s) { return s.status.empty(); });
   }
};

void add_options(miniapp::CaseOptions &args, BodyOptions &body, const std::string &k,
                 const char *mesh_help)
{
   using Text = miniapp::CaseOptions::Text;
   args.add(&body.mesh, "mesh" + k, Text::file, mesh_help);
   args.add(&body.young, "young" + k, Text::numbers,
            "Young's modulus: one, or one for each element attribute.");
   args.add(&body.poisson, "poisson" + k, Text::numbers,
            "Poisson's ratio: one, or one for each element attribute.");
   args.add(&body.contact, "contact" + k, Text::attributes,
            "Boundary attributes of the contact, as 3 or 3,4 or 3[-1<x<1].");
   args.add(&body.support, "support" + k, Text::statements,
            "Fixed components, as '1:xy 2:x @0,-1:x' (attributes, or the node near a point).");
   args.add(
      &body.load, "load" + k, Text::statements,
      "Loads 'PATTERN KIND WHERE VALUES; …', as 'P pressure 3 100; Q traction 3 1 0'; kinds: "
      "pressure, traction, body-force, displacement-x, displacement-y.");
}

/// A saved state must stand where the history stands at its time.
void check_start(const ContactState &state, const LoadHistory &history)
{
   for (int k = 0; k < history.pieces(); ++k)
   {
      const LoadPiece piece = history.piece(k);
      if (state.time < piece.start || state.time > piece.end) { continue; }
      const VectorXd loads = piece.at((state.time - piece.start) / piece.duration());
      const double scale = history.multipliers.cwiseAbs().maxCoeff();
      require((loads - state.multipliers).cwiseAbs().maxCoeff() <= 1e-9 * scale,
              "option load-state: the saved state has the load multipliers (",
              state.multipliers.transpose(), "), the history has (", loads.transpose(),
              ") at its time ", state.time);
      return;
   }
   require(false, "option load-state: the saved state's time ", state.time,
           " is outside of the history, which ends at ",
           history.piece(history.pieces() - 1).end);
}

/// Above this estimated error of the stiffness a warning is given.
constexpr double stated_accuracy = 1e-6;

std::string what_is_left(double accuracy)
{
   std::ostringstream text;
   if (std::isfinite(accuracy))
   {
      text << "the stiffness of the contact may be wrong by " << accuracy
           << " of itself (round-off of the condensation, an estimate from above)";
   }
   else { text << "round-off of the condensation leaves nothing of the contact's stiffness"; }
   text << ": Young's moduli or element sizes within a body are too far apart; take a much "
           "stiffer part for rigid, or less contrast, which changes no result that can be told";
   return text.str();
}

/// An interference fit moves nodes by less than their distance; more is a body in a wrong
/// place, or in other units.
void warn_of_overlap(const ReducedProblem &problem, const ContactLine &line)
{
   Eigen::Index deepest = 0;
   const double overlap =
      -problem.gap.cwiseQuotient(line.each(&LineNode::spacing)).minCoeff(&deepest);
   if (overlap <= 1) { return; }
   std::ostringstream text;
   text << "the bodies overlap by " << -problem.gap[deepest] << " at ("
        << line.nodes[deepest].position[0] << ", " << line.nodes[deepest].position[1]
        << "), which is " << overlap
        << " distances of nodes: small displacements do not open that, see that both meshes "
           "are in "
           "their places and in one unit";
   miniapp::warn(text.str());
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         const miniapp::Stopwatch watch;
         using Text = miniapp::CaseOptions::Text;
         BodyOptions options[2];
         int order = 2, cycle_start = -1, cycles = 1, increments = 20;
         bool plane_stress = false;
         double friction = 0, pairing_tolerance = 1e-6;
         const char *gap = "geometry", *history_text = "", *stepping = "advancing",
                    *edge_times = "";
         const char *json = "", *csv = "", *paraview = "", *frames = "", *save_file = "",
                    *load_file = "", *reduced_file = "";

         miniapp::CaseOptions args(argc, argv);
         add_options(args, options[0], "1", "Mesh of body 1 (MFEM, or Gmsh 2.2).");
         add_options(args, options[1], "2",
                     "Mesh of body 2; without it body 1 is on a rigid line.");
         args.add(&order, "order", "Order of the elements.");
         args.add(&plane_stress, "plane-stress", "Plane stress instead of plane strain.");
         args.add(&friction, "friction", "Coefficient of friction.");
         args.add(&gap, "gap", Text::word,
                  "Initial gap: geometry (from the meshes) or closed (none).");
         args.add(&pairing_tolerance, "pairing",
                  "Largest offset of paired nodes along the contact, in distances of nodes.");
         args.add(&history_text, "history", Text::statements,
                  "Load multipliers at times 0, 1, …, as 'P=0; P=1; Q=0.1'; default: all from "
                  "0 to 1.");
         args.add(&cycle_start, "cycle-start",
                  "Point of the history (from 0) where its cycle starts; -1: there is none.");
         args.add(&cycles, "cycles",
                  "How often the cycle is marched (fewer once it is steady).");
         args.add(&increments, "increments",
                  "Load increments between two points of the history.");
         args.add(&stepping, "stepping", Text::word, miniapp::stepping_help);
         args.add(&edge_times, "edges", Text::numbers,
                  "Times of two states: pressed, and at the peak of the cyclic loads. Reports "
                  "K_N, K_T and slip at the contact edges; a third time is the other end of "
                  "the cycle, for the energy.");
         miniapp::Options &line = args.command_line();
         line.add(miniapp::Options::Names::output, &json, "-json", "--json",
                  "File for the results.");
         line.add(miniapp::Options::Names::prefix, &csv, "-csv", "--csv",
                  "Prefix of the tables PREFIX_history.csv and PREFIX_nodes.csv.");
         line.add(miniapp::Options::Names::folder, &paraview, "-paraview", "--paraview",
                  "Folder for ParaView files.");
         line.AddOption(&frames, "-frames", "--frames",
                        "Times to be written besides the last one, or all (every increment).");
         line.add(miniapp::Options::Names::output, &save_file, "-save-state", "--save-state",
                  "File for the last state.");
         line.add(miniapp::Options::Names::input, &load_file, "-load-state", "--load-state",
                  "State to go on from.");
         miniapp::add_save_option(line, &reduced_file);
         args.parse();

         require(options[0].mesh[0], "option mesh1 is empty, must name a mesh file");
         require(options[1].mesh[0] ||
                    !(options[1].contact[0] || options[1].support[0] || options[1].load[0]),
                 "options contact2, support2 or load2 are given without a mesh2");
         require(order >= 1 && order <= 8, "option order is ", order, ", must be 1 to 8");
         require(friction >= 0 && std::isfinite(friction), "option friction is ", friction,
                 ", must be a number that is not negative");
         require(pairing_tolerance > 0 && pairing_tolerance < 0.5, "option pairing is ",
                 pairing_tolerance, ", must be above 0 and below 0.5");
         require(increments >= 1, "option increments is ", increments, ", must be at least 1");
         require(cycle_start >= -1, "option cycle-start is ", cycle_start,
                 ", must be a point of the history, from 0, or -1 for no cycle");
         require(cycles >= 1, "option cycles: ", cycles, " cycles, at least 1 is needed");
         if (cycles > 1 && cycle_start < 0)
         {
            miniapp::warn("option cycles is " + std::to_string(cycles) +
                          ", but the history has no cycle: option cycle-start says where it "
                          "starts");
         }
         miniapp::check_choice("gap", gap, {"geometry", "closed"});
         const std::string prefix = csv, folder = paraview;
         const bool all_frames = std::string(frames) == "all";
         std::vector<double> wanted =
            all_frames ? std::vector<double>() : miniapp::numbers("frames", frames);
         std::sort(wanted.begin(), wanted.end());
         Snapshots snapshots{miniapp::numbers("edges", edge_times), {}};
         snapshots.states.resize(snapshots.times.size());
         require(snapshots.times.empty() || snapshots.times.size() == 2 ||
                    snapshots.times.size() == 3,
                 "option edges has ", snapshots.times.size(),
                 " times, must have two (pressed, peak) or three (the other end of the cycle)");
         for (std::size_t k = 1; k < snapshots.times.size(); ++k)
         {
            require(snapshots.times[k] > snapshots.times[0], "option edges: time ",
                    snapshots.times[k], " must be after the pressed state's, ",
                    snapshots.times[0]);
         }
         require(snapshots.times.empty() || friction > 0,
                 "option edges needs friction: without it nothing is stuck");

         std::vector<Side> sides;
         int dofs = 0;
         for (int k = 0; k < (options[1].mesh[0] ? 2 : 1); ++k)
         {
            sides.push_back(make_side(options[k], std::to_string(k + 1), order, plane_stress));
            dofs += sides[k].body->dofs();
         }
         // Of two bodies in series no more than the worse of them.
         double accuracy = 0;
         for (Side &side : sides)
         {
            accuracy = std::max(accuracy, side.condensed.error_estimate());
         }
         Reduction reduction = sides.size() == 1
                                  ? on_rigid_line(sides[0].condensed)
                                  : reduce(sides[0].condensed, sides[1].condensed,
                                           paired(sides[0].condensed.line,
                                                  sides[1].condensed.line, pairing_tolerance));
         const ContactLine &contact = sides[0].condensed.line;
         ReducedProblem &problem = reduction.problem;
         set_friction(problem, friction);
         if (std::string(gap) == "closed") { problem.gap.setZero(); }
         require(!problem.patterns.empty(),
                 "there is no load: option load1 or load2 must name one");
         LoadHistory history = miniapp::load_history("history", history_text, problem);
         history.cycle_start = cycle_start;
         history.cycles = cycles;
         history.validate(static_cast<int>(problem.patterns.size()));
         const double condensed = watch.seconds();
         std::cout << "Condensed " << dofs << " dofs to " << 2 * problem.nodes() << " in "
                   << condensed << " s; gap " << problem.gap.minCoeff() << " to "
                   << problem.gap.maxCoeff() << "; stiffness right to " << accuracy
                   << " of itself" << std::endl;
         if (!(accuracy <= stated_accuracy)) { miniapp::warn(what_is_left(accuracy)); }
         warn_of_overlap(problem, contact);

         ContactState state = ContactState::virgin(problem);
         if (load_file[0])
         {
            state = load_contact_state(load_file);
            state.validate(problem);
            check_start(state, history);
         }
         const auto check_times = [&](const char *option, const std::vector<double> &times)
         {
            for (double time : times)
            {
               const double end = history.piece(history.pieces() - 1).end;
               require(time > state.time && time <= end, "option ", option, ": time ", time,
                       " is outside of the march from ", state.time, " to ", end);
            }
         };
         check_times("frames", wanted);
         check_times("edges", snapshots.times);

         MarchSettings settings;
         settings.increments = increments;
         settings.stepping = miniapp::stepping("stepping", stepping);
         const bool recording = csv[0] || paraview[0];
         HistoryTable table;
         std::vector<ContactState> recorded;
         auto next_frame = wanted.begin();
         std::optional<SidesThatBear> beyond_corners;
         if (sides.size() == 1) { beyond_corners.emplace(contact); }
         const MarchReport report = march(
            problem, history, state, settings,
            [&](const ContactState &reached, const IncrementRecord &record)
            {
               snapshots.note(reached);
               if (beyond_corners) { beyond_corners->note(reached); }
               if (!recording) { return; }
               table.add(reached, record);
               bool frame = all_frames;
               for (; next_frame != wanted.end() && reached.time >= *next_frame; ++next_frame)
               {
                  frame = true;
               }
               if (frame) { recorded.push_back(reached); }
            });
         require(
            std::isfinite(report.energy_imbalance) && std::isfinite(state.dissipation),
            "the energies of the march overflow: the loads or the moduli need other units");
         if (reduced_file[0] && miniapp::writes()) { save(problem, reduced_file); }
         const int code = miniapp::exit_code(problem, report);
         if (beyond_corners) { beyond_corners->warn(); }
         if (recording && (recorded.empty() || recorded.back().time != state.time))
         {
            recorded.push_back(state);
         }

         if (paraview[0])
         {
            std::vector<const ElasticBody *> bodies;
            for (const Side &side : sides) { bodies.push_back(side.body.get()); }
            miniapp::write_paraview(folder, reduction, bodies, recorded);
         }
         if (csv[0] && miniapp::writes())
         {
            table.write(prefix + "_history.csv", problem);
            write_nodes(prefix + "_nodes.csv", problem, recorded);
         }
         if (save_file[0] && miniapp::writes()) { save(state, save_file); }

         // The contact pushes body 1 by q along the tangents and p along the normals.
         const Eigen::Vector2d force = contact.each(&LineNode::tangent).transpose() * state.q +
                                       contact.each(&LineNode::normal).transpose() * state.p;
         const double peak = tractions(problem, state.p).maxCoeff();
         ordered_json results, zone_list = ordered_json::array(),
                               losses = ordered_json::array();
         std::cout << "\nAt time " << state.time
                   << (report.not_unique ? ", one of several states" : "")
                   << ": contact force on body 1 (" << force.transpose() << "), peak pressure "
                   << peak
                   << "\n\n state            from          to   (arc length)        ±\n";
         const std::vector<Zone> all_zones = zones(problem, state);
         const bool one_line = all_zones.back().chain == 0;
         for (std::size_t k = 0; k < all_zones.size(); ++k)
         {
            const Zone &zone = all_zones[k];
            if (!one_line && (k == 0 || all_zones[k - 1].chain != zone.chain))
            {
               std::printf(" piece %d of the contact line\n", zone.chain + 1);
            }
            std::printf(" %-13s %9.5g   %9.5g   %14s\n", name(zone.state), zone.from.position,
                        zone.to.position,
                        miniapp::error_text(std::max(zone.from.error, zone.to.error)).c_str());
            zone_list.push_back({{"state", name(zone.state)},
                                 {"from", zone.from.position},
                                 {"to", zone.to.position},
                                 {"from_error", zone.from.error},
                                 {"to_error", zone.to.error},
                                 {"piece", zone.chain + 1}});
         }
         const Eigen::Index touching = touching_nodes(problem, state);
         if (touching > 0)
         {
            std::cout << " " << touching
                      << " nodes touch without force; they carry nothing and count as "
                         "separated\n";
         }
         if (!report.cycles.empty())
         {
            std::cout << "\n cycle   dissipation   external work   slip change\n";
         }
         const int last_cycle = report.increments.empty() ? 0 : report.increments.back().cycle;
         const int ended = static_cast<int>(report.cycles.size());
         // A cycle that was not finished has increments, but no record.
         const bool unfinished = code != 0 && last_cycle > 0;
         const int first_cycle = last_cycle - ended + (unfinished ? 0 : 1);
         for (int k = 0; k < ended; ++k)
         {
            const CycleRecord &cycle = report.cycles[k];
            std::printf("%6d   %11.4e   %13.4e   %11.2e\n", first_cycle + k, cycle.dissipation,
                        cycle.external_work, cycle.slip_change);
            losses.push_back(cycle.dissipation);
         }
         if (report.steady_cycle)
         {
            std::cout << "steady from cycle " << report.steady_cycle << ", period "
                      << report.steady_period << std::endl;
         }
         if (!snapshots.times.empty() && snapshots.complete())
         {
            const bool cycle = snapshots.times.size() == 3 && !report.cycles.empty();
            miniapp::EdgeStudy study{problem, snapshots.states[0], snapshots.states[1]};
            if (cycle)
            {
               study.opposite = &snapshots.states[2];
               study.cycle = &report.cycles.back();
            }
            if (sides.size() == 1) { study.cracked = CrackedBody::first; }
            else if (sides[0].materials.size() == 1 && sides[1].materials.size() == 1 &&
                     similar(sides[0].materials[0], sides[1].materials[0]))
            {
               const Material &m = sides[0].materials[0];
               study.modulus = fretting::contact_modulus(m.young, m.poisson, plane_stress);
            }
            study.corner = [&](int end) { return corner_at(sides, end); };
            const miniapp::EdgeReport edges = miniapp::read_edges(study);
            miniapp::print(edges, [](double s) { return s; });
            results["edges"] = miniapp::to_json(edges);
         }
         const CriticalFriction critical = critical_friction(problem);
         const auto text = [](double value, const char *if_infinite)
         {
            std::ostringstream out;
            out << value;
            return std::isfinite(value) ? out.str() : if_infinite;
         };
         std::cout << "Critical friction: of a node alone " << text(critical.node, "none");
         if (std::isfinite(critical.node))
         {
            std::cout << " (node " << critical.weakest_node << ")";
         }
         std::cout << ", locks itself above " << text(critical.locking, "none")
                   << ", one answer for sure below "
                   << (critical.unique_below > 0 ? text(critical.unique_below, "any")
                                                 : "(nothing proven)")
                   << std::endl;
         results["critical_friction"] = {
            {"node", miniapp::json_number(critical.node)},
            {"locking", miniapp::json_number(critical.locking)},
            {"unique_below", miniapp::json_number(critical.unique_below)}};
         miniapp::add_outcome(problem, report, results);
         results["time"] = state.time;
         results["loads"] = named(problem, state.multipliers);
         results["peak_pressure"] = peak;
         results["contact_force"] = {force[0], force[1]};
         results["zones"] = zone_list;
         results["touching_nodes"] = touching;
         results["first_cycle"] = losses.empty() ? 0 : first_cycle;
         results["dissipation"] = losses;
         results["total_dissipation"] = state.dissipation;
         results["steady_cycle"] = report.steady_cycle;
         results["steady_period"] = report.steady_period;
         results["energy_imbalance"] = report.energy_imbalance;
         results["advance_error"] = report.advance_error;
         results["largest_residual"] = report.largest_residual;
         results["condensation_error"] = miniapp::json_number(accuracy);
         results["contact_nodes"] = problem.nodes();
         results["dofs"] = dofs;
         Counters counters = reduction.counters;
         counters += report.counters;
         results["counters"] = miniapp::to_json(counters);
         miniapp::add_exact_path(problem, report, settings, results);
         results["seconds"] = watch.seconds();
         results["seconds_condensation"] = condensed;
         miniapp::write_json(results, json);
         return code;
      });
}
