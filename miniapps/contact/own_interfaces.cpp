#include "contact/own_interfaces.hpp"

#include "common/text.hpp"
#include "contact/own_bolts.hpp"
#include "contact/own_half_plane.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/obstacle_shape.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace miniapp
{

using namespace cattaneo;

namespace
{

/// The rigid obstacle is the straight line that touches the contact nodes, across their mean
/// normal.
ScalarField distance_to_rigid_line(const ContactLine &line)
{
   const Eigen::Vector2d normal = mean_normal(line);
   const double level = (line.each(&LineNode::position) * normal).minCoeff();
   return [=](double x, double y) { return normal.dot(Eigen::Vector2d(x, y)) - level; };
}

void warn_of_offsets(const ContactLine &line1, const ContactLine &line2, const Pairing &pairs)
{
   double most = 0;
   for (Eigen::Index i = 0; i < line1.size(); ++i)
   {
      const LineNode &other = line2.nodes[pairs.partner[i]],
                     one = mean_frame(line1.nodes[i], other);
      most = std::max(most, std::abs((one.position - other.position).dot(one.tangent)) /
                               std::min(one.spacing, other.spacing));
   }
   if (most <= 0.1) { return; }
   warn(text("paired nodes lie up to %.2g of an element's length apart along the line, so both "
             "bodies feel the same force at different places: leave out key 'pairing'",
             most));
}

/// The only interface of two bodies, whose nodes are paired one to one.
Reduction paired(std::vector<CondensedBody> bodies, const JointCase::Face &face)
{
   try
   {
      const Pairing pairs = pair_lines(bodies[0].line, bodies[1].line, face.pairing);
      warn_of_offsets(bodies[0].line, bodies[1].line, pairs);
      Reduction made = reduce(std::move(bodies[0]), std::move(bodies[1]), pairs);
      for (ContactChain &chain : made.problem.chains) { chain.interface = face.name; }
      return made;
   }
   catch (const InputError &error)
   {
      throw InputError("interface '" + face.name + "': " + error.what());
   }
}

bool has_shape(const JointCase::Face &face)
{
   return !face.obstacle.empty() || !std::isnan(face.radius) || face.curve;
}

/// A rigid motion of the obstacle of an interface: a translation, and a rotation about a
/// centre.
ObstacleMotion rigid(std::size_t interface, const JointCase::Motion &one)
{
   return {interface,
           [one](double, double y) { return one.along[0] - one.angle * (y - one.centre[1]); },
           [one](double x, double) { return one.along[1] + one.angle * (x - one.centre[0]); }};
}

/// Loads that move rigid obstacles (one load may move those of several interfaces), and
/// obstacles that are free to move.
void move_obstacles(Reduction &reduction, const JointCase &joint)
{
   std::map<std::string, std::vector<ObstacleMotion>> loads;
   std::vector<Reduction::FreeMotion> free;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      if (!face.guide) { continue; }
      const std::array<double, 3> at = face.guide->centre.value_or(std::array<double, 3>{});
      const bool plane = joint.formulation == Formulation::plane;
      for (const int way : {0, 1, 2})
      {
         const Guide::Along &along = way == 0   ? face.guide->x
                                     : way == 1 ? face.guide->y
                                                : face.guide->rotation;
         // In axisymmetry it moves only along the axis.
         const bool said = !along.load.empty();
         require(plane || way == 1 || !said, face.source.called("guide"),
                 ": in axisymmetry an obstacle can only move along y");
         if (along.motion == Guide::Motion::held || (!plane && way != 1)) { continue; }
         JointCase::Motion one;
         one.centre = {at[0], at[1]};
         if (way < 2) { one.along[way] = 1; }
         else { one.angle = 1; }
         if (along.motion == Guide::Motion::displacement)
         {
            one.along *= along.value;
            one.angle *= along.value;
            loads[along.load].push_back(rigid(k, one));
         }
         else { free.push_back({along.load, along.value, {rigid(k, one)}}); }
      }
   }
   if (!free.empty()) { reduction.free_obstacles(free); }
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      for (const JointCase::Motion &one : joint.faces[k].motions)
      {
         require(joint.formulation == Formulation::plane ||
                    (one.along[0] == 0 && one.angle == 0),
                 joint.faces[k].source.called("motion"),
                 ": in axisymmetry an obstacle can only move along y");
         loads[one.load].push_back(rigid(k, one));
      }
   }
   for (const auto &[load, motions] : loads) { reduction.add_obstacle_motion(load, motions); }
}

/// Arc length of the point of a line that is nearest to a place. Beyond the ends the line is
/// continued straight.
double arc_length_on(const ContactLine &line, const Eigen::Vector2d &place)
{
   double nearest = std::numeric_limits<double>::infinity(), found = 0;
   for (const LineChain &chain : line.chains)
   {
      const Eigen::Index last = chain.first + chain.nodes - 1;
      if (chain.nodes == 1) { found = line.nodes[last].arc_length; }
      for (Eigen::Index i = chain.first; i < last + (chain.loop ? 1 : 0); ++i)
      {
         const LineNode &a = line.nodes[i], &b = line.nodes[i < last ? i + 1 : chain.first];
         const Eigen::Vector2d along = b.position - a.position;
         const double share = along.dot(place - a.position) / along.squaredNorm();
         const double within = std::clamp(share, 0.0, 1.0);
         const double away = (a.position + within * along - place).norm();
         const bool end = !chain.loop && (share < 0 ? i == chain.first : i == last - 1);
         if (away >= nearest) { continue; }
         nearest = away;
         found = a.arc_length + (end ? share : within) * along.norm();
      }
   }
   return found;
}

/// A larger overlap means an obstacle in a wrong place, or in other units, not an interference.
void check_overlap(const ReducedProblem &problem, const InterfaceReport &report,
                   const JointCase::Face &face, const ContactLine &line)
{
   const auto &elements = line.chains[0].elements;
   const auto order = elements.empty() ? 1 : elements[0].order();
   for (Eigen::Index i = 0; i < report.nodes; ++i)
   {
      const double overlap = -problem.gap[report.first + i],
                   element = static_cast<double>(order) * report.spacing[i];
      require(overlap <= face.most_overlap * element, face.source.called("obstacle"),
              " overlaps the body by ", overlap, " at ",
              Eigen::Vector2d(report.position.row(i)), ", at most ",
              face.most_overlap * element, " is allowed (", face.most_overlap,
              " of the element's length): for an interference fit allow more by key 'overlap'; "
              "leave out of the contact a side that faces away from the obstacle");
   }
}

} // namespace

std::vector<Interface> interfaces_of(const JointCase &joint,
                                     const std::vector<std::array<ContactLine, 2>> &lines)
{
   std::vector<Interface> interfaces;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      Interface made{face.name, {face.sides[0].body, lines[k][0]}, {}, face.slave};
      made.most_overlap = face.most_overlap;
      made.tied = face.tied;
      if (face.sides[1].body >= 0) { made.second = {face.sides[1].body, lines[k][1]}; }
      else { made.gap = distance_to_rigid_line(lines[k][0]); }
      // These depend on the arc length or the normals, which are not known yet.
      if (face.gap || has_shape(face)) { made.gap = 0.0; }
      interfaces.push_back(std::move(made));
   }
   return interfaces;
}

Reduction united(const JointCase &joint, std::vector<CondensedBody> condensed,
                 const std::vector<std::array<ContactLine, 2>> &lines)
{
   const JointCase::Face &one = joint.faces[0];
   if (!std::isnan(one.pairing))
   {
      require(joint.faces.size() == 1 && condensed.size() == 2 && one.sides[1].body >= 0,
              one.source.called("pairing"),
              " is for two bodies at one interface only: leave it out, because nodes need not "
              "match");
      return paired(std::move(condensed), one);
   }
   return reduce(std::move(condensed), interfaces_of(joint, lines));
}

void complete(OwnBodies &own, const JointCase &joint,
              const std::vector<std::array<ContactLine, 2>> &lines)
{
   Reduction &reduction = own.scene.reduction;
   ReducedProblem &problem = reduction.problem;
   std::vector<std::pair<const JointCase::Face *, std::vector<Eigen::Index>>> laws;
   for (std::size_t k = 0; k < joint.faces.size(); ++k)
   {
      const JointCase::Face &face = joint.faces[k];
      InterfaceReport &report = reduction.interfaces[k];
      report.name = face.name;
      if (face.gap && face.sides[1].body >= 0) // for any geometry
      {
         report.chords.setZero();
         report.curved.setZero();
      }
      for (Eigen::Index i = report.first; i < report.first + report.nodes && !face.tied; ++i)
      {
         const Eigen::Vector2d place = problem.position.row(i);
         const double arc = arc_length_on(lines[k][0], place);
         const auto check = [&](const char *key, double value, bool right, const char *must)
         {
            require(right, face.source.called(key), " is ", told(value), " at arc length ",
                    told(arc), ", the place (", told(place[0]), ", ", told(place[1]), "), ",
                    must);
         };
         const double f = problem.friction[i] = face.friction.at(arc, place);
         check("friction", f, std::isfinite(f) && f >= 0, "must be finite and not negative");
         if (!face.gap) { continue; }
         const double g = problem.gap[i] = face.gap->at(arc, place);
         check("gap", g, std::isfinite(g), "must be finite");
      }
      if (face.strength && report.nodes > 0)
      {
         std::vector<Eigen::Index> nodes(report.nodes);
         std::iota(nodes.begin(), nodes.end(), report.first);
         laws.emplace_back(&face, std::move(nodes));
      }
      if (has_shape(face))
      {
         try
         {
            problem.gap.segment(report.first, report.nodes) =
               face.curve ? gaps_to_curve(report, [&](double x) { return (*face.curve)({x}); })
               : face.obstacle.empty() ? gaps_to_circle(report, face.centre, face.radius)
                                       : gaps_to_polyline(report, face.obstacle);
         }
         catch (const InputError &error)
         {
            throw InputError(face.source.called("obstacle") + ": " + error.what());
         }
         check_overlap(problem, report, face, lines[k][0]);
      }
   }
   // To be done when the coefficients of all other interfaces are known.
   for (const auto &[face, nodes] : laws)
   {
      try
      {
         set_friction_law(problem, *face->strength, nodes);
      }
      catch (const InputError &error)
      {
         throw InputError(face->source.called("strength") + ": " + error.what());
      }
   }
   add_bolts(reduction, own.bolted, joint,
             [&joint](Reduction &made) { move_obstacles(made, joint); });
}

} // namespace miniapp
