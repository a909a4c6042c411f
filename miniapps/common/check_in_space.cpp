#include "common/check.hpp"
#include "common/study.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace
{

/// Calls visit(place, value) for each node at which values of true dofs are not zero.
template <class Visit>
void each_node_with(const ElasticBody &body, const VectorXd &values, Visit visit)
{
   for (int node = 0; node < body.node_coordinates().Width(); ++node)
   {
      Vector3d value(0, 0, 0);
      for (int c = 0; c < 3; ++c)
      {
         const int dof = body.true_dof(node, c);
         if (dof >= 0) { value[c] = values[dof]; }
      }
      if (!value.isZero(0)) { visit(Vector3d(body.place(node)), value); }
   }
}

void list_bodies_in_space(Study &study, const Scene &scene)
{
   const std::string length = study.units.of(0, 1);
   ResultTable &bodies =
      study.table("bodies", {{"body", "body"},
                             {"elements", "elements"},
                             {"dofs", "dofs"},
                             {"x_from", "x from" + length, "%.5g"},
                             {"x_to", "to" + length, "%.5g"},
                             {"y_from", "y from" + length, "%.5g"},
                             {"y_to", "to" + length, "%.5g"},
                             {"z_from", "z from" + length, "%.5g"},
                             {"z_to", "to" + length, "%.5g"},
                             {"held_x", "held in x"},
                             {"held_y", "in y"},
                             {"held_z", "in z (nodes)"},
                             {"free_motions", "rigid motions that supports leave free"}});
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const ElasticBody &body = *scene.bodies[k];
      const CondensedBody &condensed = scene.reduction.bodies[k];
      Eigen::AlignedBox3d box;
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         box.extend(Vector3d(body.place(node)));
      }
      VectorXd held = VectorXd::Zero(body.dofs());
      for (const int dof : body.essential_dofs()) { held[dof] = 1; }
      std::array<int, 3> count{0, 0, 0};
      each_node_with(body, held,
                     [&](const Vector3d &, const Vector3d &value)
                     {
                        for (int c = 0; c < 3; ++c) { count[c] += value[c] != 0; }
                     });
      const double size = box.diagonal().norm();
      const auto end = [&](double x) { return settled(x, size); };
      study.row(bodies, {condensed.name, scene.meshes[k]->GetNE(), body.dofs(),
                         end(box.min()[0]), end(box.max()[0]), end(box.min()[1]),
                         end(box.max()[1]), end(box.min()[2]), end(box.max()[2]), count[0],
                         count[1], count[2], condensed.free_motions.cols()});
   }
}

void list_sides_in_space(Study &study, const Scene &scene)
{
   const std::string length = study.units.of(0, 1);
   ResultTable &sides = study.table("sides", {{"interface", "interface"},
                                              {"nodes_on", "nodes on"},
                                              {"opposite", "opposite"},
                                              {"meet", "they meet by"},
                                              {"nodes", "nodes"},
                                              {"area", "area" + study.units.of(0, 2), "%.5g"},
                                              {"left_out", "left out", "%.2g"},
                                              {"least_gap", "gap from" + length, "%.3g"},
                                              {"most_gap", "to" + length, "%.3g"},
                                              {"least_spacing", "spacing" + length, "%.3g"},
                                              {"most_spacing", "to" + length, "%.3g"},
                                              {"friction", "friction", "%.3g"}});
   const Reduction &reduction = scene.reduction;
   const ReducedProblem &problem = reduction.problem;
   for (const InterfaceReport &face : reduction.interfaces)
   {
      const bool rigid = face.bodies[1] < 0;
      const std::string meet = rigid           ? "nodes"
                               : face.matching ? "nodes that match"
                                               : "the mortar";
      double least = none, most = none, friction = none;
      if (!face.tied && face.nodes > 0)
      {
         const auto gaps = problem.gap.segment(face.first, face.nodes);
         least = gaps.minCoeff();
         most = gaps.maxCoeff();
         friction = problem.friction.segment(face.first, face.nodes).maxCoeff();
      }
      study.row(sides, {face.name, reduction.bodies[face.bodies[0]].name,
                        rigid ? "the obstacle" : reduction.bodies[face.bodies[1]].name,
                        face.tied ? meet + ", tied" : meet, face.nodes, face.weights.sum(),
                        face.left_out, least, most, face.spacing.minCoeff(),
                        face.spacing.maxCoeff(), friction});
   }
}

void list_loads_in_space(Study &study, const Scene &scene)
{
   const std::string force_unit = study.units.of(1, 0), moment_unit = study.units.of(1, 1);
   ResultTable &loads =
      study.table("loads", {{"load", "load"},
                            {"body", "body"},
                            {"kind", "kind"},
                            {"nodes", "nodes"},
                            {"x", "sum x" + force_unit, "%.6g"},
                            {"y", "y" + force_unit, "%.6g"},
                            {"z", "z" + force_unit, "%.6g"},
                            {"moment_x", "moment x" + moment_unit, "%.4g"},
                            {"moment_y", "y" + moment_unit, "%.4g"},
                            {"moment_z", "z (about 0)" + moment_unit, "%.4g"}});
   for (std::size_t k = 0; k < scene.bodies.size(); ++k)
   {
      const ElasticBody &body = *scene.bodies[k];
      for (const BodyLoad &load : body.patterns())
      {
         const bool is_force = load.control == Control::force;
         Vector3d sum(0, 0, 0), moment(0, 0, 0);
         double size = 0, lever = 0;
         int nodes = 0;
         each_node_with(body, load.values,
                        [&](const Vector3d &place, const Vector3d &value)
                        {
                           sum += value;
                           moment += place.cross(value);
                           size += value.norm();
                           lever += place.norm() * value.norm();
                           ++nodes;
                        });
         // The force of a guide stands at no node. Where it acts is that of its bearing.
         bool on_guide = false;
         for (const BlockMotion &block : body.blocks())
         {
            if (block.load != load.name) { continue; }
            on_guide = true;
            std::vector<Vector3d> ways;
            each_node_with(body, block.motion,
                           [&](const Vector3d &, const Vector3d &value)
                           { ways.push_back(value); });
            nodes += static_cast<int>(ways.size());
            const bool alike =
               !ways.empty() && std::all_of(ways.begin(), ways.end(),
                                            [&](const Vector3d &way)
                                            { return (way - ways[0]).norm() <= 1e-12; });
            if (!alike) { continue; } // a moment
            sum += block.force * ways[0];
            size += std::abs(block.force);
         }
         const auto shown = [&](double x, double of)
         { return is_force ? settled(x, of) : none; };
         const auto turning = [&](int c)
         { return is_force && !on_guide ? settled(moment[c], lever) : none; };
         study.row(loads, {load.name, scene.reduction.bodies[k].name,
                           !is_force  ? "displacement"
                           : on_guide ? "force or moment on a guide"
                                      : "forces",
                           nodes, shown(sum[0], size), shown(sum[1], size), shown(sum[2], size),
                           turning(0), turning(1), turning(2)});
      }
   }
}

} // namespace

void show_in_space(Study &study, const Scene &scene)
{
   study.title("Input of the computation");
   list_bodies_in_space(study, scene);
   list_sides_in_space(study, scene);
   list_loads_in_space(study, scene);
}

} // namespace miniapp
