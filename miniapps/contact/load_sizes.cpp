#include "contact/load_sizes.hpp"

#include "common/load_axes.hpp"
#include "contact/report_in_space.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/words.hpp>
#include <cmath>
#include <cstdlib>
#include <map>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector3d;
using nlohmann::ordered_json;

namespace
{

/// The share of one body, guide, obstacle or bolt in a load.
struct Share
{
   std::string kind;         ///< as in LoadSize; "forces": on nodes of a body
   Vector3d along{0, 0, 0};  ///< the resultant, or the displacement
   double moment = 0;        ///< about the origin; an angle; for a scalar kind its value
   Vector3d couple{0, 0, 0}; ///< in space the moment about the origin
   double size = 0;          ///< sum of the forces, to tell round-off from a resultant
   double lever = 0;         ///< the same of the moment
   std::string place;        ///< what is loaded
   bool known = true;        ///< false: the statement has a function in place of a number
   int statements = 1;       ///< number of the statements in it
   double pressure = 0;      ///< for a single statement of a pressure
};

/// The value of a word that is a plain number; otherwise unknown.
std::optional<double> plain_number(const std::string &word)
{
   char *end = nullptr;
   const double value = std::strtod(word.c_str(), &end);
   if (word.empty() || *end != 0 || !std::isfinite(value)) { return std::nullopt; }
   return value;
}

/// Shares by the names of loads.
class Shares
{
public:
   explicit Shares(const JointCase &joint) : joint_(joint) {}

   void add(const std::string &load, Share share) { all_[load].push_back(std::move(share)); }

   /// The statements of a body other than forces: displacements, twists, strains.
   void add_statements(const JointCase::Body &body)
   {
      for (const std::string &statement : split(body.load, ";\n"))
      {
         const std::vector<std::string> words = split(statement, " \t");
         if (words.size() < 3) { continue; }
         const std::string &load = words[0], &kind = words[1];
         const bool moves = kind.rfind("displacement-", 0) == 0;
         const std::size_t last = words.size() - 1;
         const std::optional<double> value = plain_number(words[last]);
         Share made;
         made.known = value.has_value();
         made.place = body.name + ":" + words[2];
         if (moves)
         {
            made.kind = "displacement";
            const char way = kind.back();
            const int component = way == 'x' || way == 'r'          ? 0
                                  : joint_.in_space() && way == 'z' ? 2
                                                                    : 1;
            made.along[component] = value.value_or(0);
         }
         else if (kind == "twist") { made.kind = "rotation"; }
         else if (kind == "temperature" || (kind == "initial-strain" && last == 2))
         {
            made.kind = kind == "temperature" ? kind : "strain";
            made.place = body.name;
         }
         else if (kind == "initial-strain")
         {
            made.known = false;
            made.kind = "strain";
         }
         else { continue; } // forces on nodes
         if (!moves) { made.moment = value.value_or(0); }
         add(load, made);
      }
      for (const BulkStress &one : body.bulk)
      {
         Share made;
         made.kind = "stress";
         made.moment = one.stress;
         made.place = body.name;
         add(one.pattern, made);
      }
   }

   /// Forces on the nodes of a body in space.
   void add_forces(const JointCase::Body &body, const ElasticBody &elastic)
   {
      for (const BodyLoad &load : elastic.patterns())
      {
         Share made;
         if (load.control != Control::force || !describe(body, load.name, made)) { continue; }
         for (int node = 0; node < elastic.node_coordinates().Width(); ++node)
         {
            Vector3d force;
            for (const int c : {0, 1, 2}) { force[c] = load.values[elastic.true_dof(node, c)]; }
            const Vector3d at = elastic.place(node);
            made.along += force;
            made.couple += at.cross(force);
            made.size += force.lpNorm<1>();
            made.lever += at.cross(force).lpNorm<1>();
         }
         add(load.name, made);
      }
   }

   /// Forces and torques on the nodes of a body.
   void add_forces(const JointCase::Body &body, const HeldBody &held, double thickness)
   {
      const bool plane = joint_.formulation == Formulation::plane;
      for (const BodyLoad &load : held.loads)
      {
         Share made;
         if (load.control != Control::force || !describe(body, load.name, made)) { continue; }
         for (Index dof = 0; dof < load.values.size(); ++dof)
         {
            // In axisymmetry radial forces cancel.
            if (!plane && held.component[dof] == 0) { continue; }
            const double force = thickness * load.values[dof];
            const Eigen::Vector2d &at = held.place[dof];
            made.along[held.component[dof]] += force;
            if (plane)
            {
               const double arm = held.component[dof] == 0 ? -at[1] : at[0];
               made.moment += arm * force;
               made.lever += std::abs(arm * force);
            }
            made.size += std::abs(force);
         }
         add(load.name, made);
      }
      for (const BodyLoad &load : held.around.loads)
      {
         if (load.control != Control::force) { continue; }
         Share made;
         if (!describe(body, load.name, made)) { continue; }
         made.kind = "torque";
         made.moment = load.values.sum();
         made.lever = load.values.lpNorm<1>();
         add(load.name, made);
      }
   }

   /// One motion of a rigid block, a guide or an obstacle. @param way 0: x, 1: y, 2: rotation;
   /// in space 2: z, 3 to 5: rotations about x, y and z
   void add_way(const Guide::Along &along, int way, const std::string &place)
   {
      if (along.load.empty()) { return; }
      Share made;
      made.place = place;
      const bool force = along.motion == Guide::Motion::force;
      if (joint_.in_space() && way > 2)
      {
         made.kind = force ? "moment" : "rotation";
         (force ? made.couple[way - 3] : made.moment) = along.value;
         made.lever = std::abs(along.value);
      }
      else if (way == 2 && !joint_.in_space())
      {
         made.kind = force ? "moment" : "rotation";
         made.moment = along.value;
         made.lever = std::abs(along.value);
      }
      else
      {
         made.kind = force ? "forces" : "displacement";
         made.along[way] = along.value;
         made.size = std::abs(along.value);
      }
      add(along.load, made);
   }

   void add_guide(const Guide &guide, const std::string &place)
   {
      const auto six = guide.in_space();
      for (int way = 0; joint_.in_space() && way < 6; ++way) { add_way(*six[way], way, place); }
      if (joint_.in_space()) { return; }
      add_way(guide.x, 0, place);
      add_way(guide.y, 1, place);
      add_way(guide.rotation, 2, place);
   }

   /// The size of a load; empty if it is not known.
   LoadSize of(const std::string &load) const
   {
      const auto found = all_.find(load);
      if (found == all_.end()) { return {}; }
      const std::vector<Share> &shares = found->second;
      LoadSize made;
      std::vector<std::string> places;
      for (const Share &one : shares)
      {
         if (!one.known) { return {}; }
         if (std::find(places.begin(), places.end(), one.place) == places.end())
         {
            places.push_back(one.place);
         }
      }
      made.place = listed(places);
      const std::string &kind = shares[0].kind;
      if (kind == "forces" || kind == "moment" || kind == "torque")
      {
         add_resultant(shares, made);
      }
      else if (kind == "displacement") { add_displacement(shares, made); }
      else if (std::all_of(shares.begin(), shares.end(),
                           [&](const Share &one)
                           { return one.kind == kind && one.moment == shares[0].moment; }))
      {
         made.kind = kind;
         made.value = std::abs(shares[0].moment);
      }
      const bool usable = !made.kind.empty() && made.value > 0 && std::isfinite(made.value);
      return usable ? made : LoadSize();
   }

private:
   /// The parts of a body on which a load of forces acts; false if no statement of forces has
   /// this load.
   bool describe(const JointCase::Body &body, const std::string &load, Share &made) const
   {
      made.kind = "forces";
      made.place = body.name;
      made.statements = 0;
      std::vector<std::string> parts;
      for (const std::string &statement : split(body.load, ";\n"))
      {
         const std::vector<std::string> words = split(statement, " \t");
         if (words.size() < 3 || words[0] != load) { continue; }
         const std::string &kind = words[1];
         if (kind == "temperature" || kind == "initial-strain") { return false; }
         ++made.statements;
         if (kind == "body-force") { continue; }
         if (std::find(parts.begin(), parts.end(), words[2]) == parts.end())
         {
            parts.push_back(words[2]);
         }
         if (kind == "pressure") { made.pressure = plain_number(words[3]).value_or(0); }
      }
      if (!parts.empty()) { made.place += ":" + listed(parts, ","); }
      // A card of a deck has no statement. Bolts and guides are treated elsewhere.
      return made.statements > 0 || load.rfind("CLOAD", 0) == 0;
   }

   void add_resultant(const std::vector<Share> &shares, LoadSize &made) const
   {
      constexpr double none_of_it = 1e-9; // meshes have fewer digits than forces
      Vector3d sum(0, 0, 0), couple = sum;
      double moment = 0, size = 0, lever = 0, apart = 0;
      int pushed = 0;
      bool torque = true;
      for (const Share &one : shares)
      {
         const bool forces = one.kind == "forces";
         if (!forces && one.kind != "moment" && one.kind != "torque") { return; }
         torque = torque && one.kind == "torque";
         sum += one.along;
         moment += one.moment;
         couple += one.couple;
         size += one.size;
         lever += one.lever;
         if (one.along.norm() > none_of_it * one.size)
         {
            apart += 0.5 * one.along.norm();
            ++pushed;
         }
      }
      if (sum.norm() > none_of_it * size)
      {
         made.kind = "force";
         made.value = sum.norm();
         for (double &x : sum) { x = settled(x, 1e3 * made.value); }
         set_direction(made, sum / made.value);
      }
      else if (pushed > 1)
      {
         made.kind = "opposite forces";
         made.value = apart;
      }
      else if (std::hypot(moment, couple.norm()) > none_of_it * lever)
      {
         made.kind = torque ? "torque" : "moment";
         made.value = std::hypot(moment, couple.norm());
      }
      else if (shares.size() == 1 && shares[0].statements > 1)
      {
         made.kind = "opposite forces";
         made.value = 0.5 * shares[0].size;
      }
      else if (shares.size() == 1 && shares[0].pressure != 0)
      {
         made.kind = "pressure";
         made.value = std::abs(shares[0].pressure);
      }
   }

   /// Components of one part add up. All parts must have the same motion.
   void add_displacement(const std::vector<Share> &shares, LoadSize &made) const
   {
      std::map<std::string, Vector3d> parts;
      for (const Share &one : shares)
      {
         if (one.kind != "displacement") { return; }
         Vector3d &its = parts.try_emplace(one.place, Vector3d(0, 0, 0)).first->second;
         for (const int c : {0, 1, 2})
         {
            if (one.along[c] != 0) { its[c] = one.along[c]; }
         }
      }
      const Vector3d first = parts.begin()->second;
      for (const auto &part : parts)
      {
         if (part.second != first) { return; }
      }
      made.kind = "displacement";
      made.value = first.norm();
      set_direction(made, first / made.value);
   }

   /// LoadSize has directions of the plane. In space the words of the place have them.
   void set_direction(LoadSize &made, const Vector3d &along) const
   {
      if (!joint_.in_space()) { made.direction = {along[0], along[1]}; }
      else { made.place += " along " + direction_name(along); }
   }

   const JointCase &joint_;
   std::map<std::string, std::vector<Share>> all_;
};

/// Adds the motions of obstacles, and gives each load its size.
void set_sizes(ReducedProblem &problem, Shares &shares, const JointCase &joint)
{
   for (const JointCase::Face &face : joint.faces)
   {
      const std::string place = "the obstacle of " + face.name;
      if (face.guide) { shares.add_guide(*face.guide, place); }
      for (int c = 0; face.moves && c < 3; ++c) { shares.add_way((*face.moves)[c], c, place); }
      for (const JointCase::Motion &one : face.motions)
      {
         Share made;
         made.place = place;
         made.known = one.angle == 0 || one.along.norm() == 0;
         made.kind = one.angle == 0 ? "displacement" : "rotation";
         made.along = one.along;
         made.moment = one.angle;
         shares.add(one.load, made);
      }
   }
   for (LoadPattern &pattern : problem.patterns)
   {
      const auto bolt =
         std::find_if(joint.bolts.begin(), joint.bolts.end(),
                      [&](const JointCase::Bolt &one) { return one.name == pattern.name; });
      pattern.size = bolt != joint.bolts.end()
                        ? LoadSize{"bolt", bolt->force, {0, 0}, bolt->name}
                        : shares.of(pattern.name);
   }
}

} // namespace

void set_load_sizes(OwnBodies &own, const JointCase &joint)
{
   Shares shares(joint);
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      const JointCase::Body &body = joint.bodies[b];
      shares.add_statements(body);
      for (const JointCase::Body::Guided &each : body.guides)
      {
         shares.add_guide(each.guide, body.name + ":" + each.on);
      }
      shares.add_forces(body, own.held[b], joint.thickness_of(static_cast<int>(b)));
   }
   set_sizes(own.scene.problem(), shares, joint);
}

void set_load_sizes(BodiesInSpace &own, const JointCase &joint)
{
   Shares shares(joint);
   for (std::size_t b = 0; b < joint.bodies.size(); ++b)
   {
      const JointCase::Body &body = joint.bodies[b];
      shares.add_statements(body);
      for (const JointCase::Body::Guided &each : body.guides)
      {
         shares.add_guide(each.guide, body.name + ":" + each.on);
      }
      shares.add_forces(body, *own.scene.bodies[b]);
   }
   set_sizes(own.scene.problem(), shares, joint);
}

void report_load_sizes(Study &study, const ReducedProblem &problem)
{
   ordered_json &all = study.results["load_sizes"] = ordered_json::array();
   for (const LoadPattern &pattern : problem.patterns)
   {
      const LoadSize &size = pattern.size;
      const LoadAxes axes = load_axes(pattern, study.units, problem.knows_loads());
      const bool known = !size.kind.empty();
      const bool directed = size.direction[0] != 0 || size.direction[1] != 0;
      all.push_back({{"load", pattern.name},
                     {"kind", known ? size.kind : "load factor"},
                     {"size", size.value},
                     {"direction", directed ? ordered_json(size.direction) : ordered_json()},
                     {"displacement of", size.place},
                     {"force", axes.force},
                     {"displacement", axes.displacement}});
      if (!study.verbose() || !known) { continue; }
      study.say(text("   load %s = 1: %s %.6g%s%s%s", pattern.name.c_str(), size.kind.c_str(),
                     size.value, axes.unit.c_str(), size.place.empty() ? "" : " of ",
                     size.place.c_str()));
   }
}

} // namespace miniapp
