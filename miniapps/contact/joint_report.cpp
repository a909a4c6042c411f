#include "contact/joint_report.hpp"

#include "common/own_history.hpp"

#include <algorithm>
#include <cattaneo/readout/zones.hpp>
#include <cattaneo/whole_file.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Vector2d;
using Eigen::VectorXd;
using nlohmann::ordered_json;

JointReport::JointReport(Study &study, const JointCase &joint, const Reduction &reduction)
   : study_(study), joint_(joint), reduction_(reduction), courses_(reduction.interfaces.size())
{
}

std::string JointReport::body(int b) const
{
   return b < 0 ? "rigid line" : reduction_.bodies[b].name;
}

Vector2d JointReport::middle(const InterfaceReport &face) const
{
   const Vector2d mean = face.position.transpose() * face.weights / face.weights.sum();
   const double size = face.position.cwiseAbs().maxCoeff();
   // Coordinates of meshes have fewer digits.
   return {settled(mean[0], 1e3 * size), settled(mean[1], 1e3 * size)};
}

JointReport::Resultant JointReport::resultant(const InterfaceReport &face,
                                              const ContactState &state) const
{
   VectorXd q = VectorXd::Zero(face.nodes), p = q;
   if (face.tied)
   {
      const VectorXd f = reduction_.tied_forces(state.v, state.w, state.multipliers);
      q = f.segment(face.first, face.nodes);
      p = f.segment(f.size() / 2 + face.first, face.nodes);
   }
   else
   {
      if (state.q.size() > 0) { q = state.q.segment(face.first, face.nodes); }
      p = state.p.segment(face.first, face.nodes);
   }
   Resultant made;
   made.normal = p.sum();
   made.tangential = q.sum();
   const Vector2d about = middle(face);
   double size = 0, lever = 0;
   for (Index i = 0; i < face.nodes; ++i)
   {
      const Vector2d t = face.tangent.row(i), n(-t[1], t[0]);
      const Vector2d force = (face.of_second ? -1 : 1) * (q[i] * t + p[i] * n);
      // On the first body, and with the opposite sign on the second.
      const Vector2d arm = face.acts_at[face.of_second].row(i).transpose() - about,
                     apart = (face.acts_at[face.of_second].row(i) -
                              face.acts_at[!face.of_second].row(i))
                                .transpose();
      made.force += force;
      made.moment += arm[0] * force[1] - arm[1] * force[0];
      made.defect += apart[0] * force[1] - apart[1] * force[0];
      size += force.norm();
      lever += arm.norm() * force.norm();
   }
   for (double *x : {&made.normal, &made.tangential, &made.force[0], &made.force[1]})
   {
      *x = settled(*x, size);
   }
   made.moment = settled(made.moment, lever);
   made.defect = settled(made.defect, lever);
   if (twists())
   {
      const Index n = reduction_.problem.nodes();
      const VectorXd around = face.tied ? reduction_.tied_twisting(state.v, state.multipliers)
                                        : VectorXd(state.q.tail(n));
      const VectorXd torques = around.segment(face.first, face.nodes)
                                  .cwiseProduct(face.acts_at[face.of_second].col(0));
      made.torque = settled((face.of_second ? -1 : 1) * torques.sum(), torques.lpNorm<1>());
   }
   return made;
}

void JointReport::note(const ContactState &state, int cycle)
{
   // If a march continues within a cycle, the loops of this cycle are not known.
   if (cycle == 0 && state.cycle) { begun_ = state.cycle->cycle; }
   if (state.q.size() == 0) { return; }
   const Index n = state.p.size(), around = twists() ? n : 0; // first of the components
   for (std::size_t k = 0; k < courses_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      if (face.tied) { continue; }
      Course &course = courses_[k];
      VectorXd forces = state.q.segment(around + face.first, face.nodes),
               slips = state.v.segment(around + face.first, face.nodes);
      if (twists())
      {
         const VectorXd r = face.acts_at[face.of_second].col(0);
         forces = forces.cwiseProduct(r);
         slips = slips.cwiseQuotient(r);
      }
      const double slip = slips.dot(face.weights) / face.weights.sum();
      const double shear = -settled(forces.sum(), forces.lpNorm<1>());
      if (cycle > 0)
      {
         const bool first = course.slip.empty(); // of a march that continues within a cycle
         Course::Cycle &its =
            course.cycles
               .try_emplace(
                  cycle, Course::Cycle{Loop(Control::force, first ? shear : course.shear.back(),
                                            first ? slip : course.slip.back())})
               .first->second;
         its.loop.add(shear, slip);
         // Symmetry of a mesh with few digits leaves resultants of a millionth of the normal
         // forces.
         its.force =
            std::max({its.force, forces.lpNorm<1>(),
                      twists() ? 0 : 1e6 * state.p.segment(face.first, face.nodes).sum()});
         its.slip = std::max(its.slip, slips.cwiseAbs().maxCoeff());
      }
      if (course.slip.size() == 2 * most_drawn)
      {
         for (std::vector<double> *all : {&course.slip, &course.shear})
         {
            all->erase(all->begin(), all->begin() + most_drawn);
         }
      }
      course.pressing =
         std::max(course.pressing, std::abs(state.p.segment(face.first, face.nodes).sum()));
      course.slip.push_back(slip);
      course.shear.push_back(shear);
   }
}

std::string JointReport::of_state(const ContactState &state)
{
   if (reduction_.interfaces.size() > 1)
   {
      return text("%zu interfaces of %zu bodies", reduction_.interfaces.size(),
                  reduction_.bodies.size());
   }
   const InterfaceReport &face = reduction_.interfaces[0];
   const Vector2d force = resultant(face, state).force;
   study_.results["contact_force"] = {force[0], force[1]};
   return "contact force on " + body(face.bodies[face.of_second]) +
          text(" (%g, %g)", force[0], force[1]) + study_.units.total(0);
}

void JointReport::report(const ContactState &state, const MarchReport &march)
{
   report_interfaces(state, march);
   report_cycles(march);
   draw_loops();
}

void JointReport::report_interfaces(const ContactState &state, const MarchReport &march)
{
   const bool plane = joint_.formulation == Formulation::plane;
   const Units &u = study_.units;
   const bool faces_nothing =
      std::any_of(reduction_.interfaces.begin(), reduction_.interfaces.end(),
                  [](const InterfaceReport &face) { return !face.free_surface.empty(); });
   ResultTable &table = study_.table(
      "interfaces", {{"interface", "interface"},
                     {"on", "forces on"},
                     {"normal", "N (pressing)" + u.total(0), "%.6g"},
                     {"tangential", "T" + u.total(0), "%.6g"},
                     {"force_x", headed(plane ? "x" : "", u.total(0)), "%.6g"},
                     {"force_y", std::string(plane ? "y" : "axial") + u.total(0), "%.6g"},
                     {"moment", headed(plane ? "moment" : "", u.total(1)), "%.4g"},
                     {"moment_defect"},
                     {"torque", headed(twists() ? "torque" : "", u.total(1)), "%.6g"},
                     {"about_x", headed(plane ? "about the point x" : "", u.of(0, 1)), "%.5g"},
                     {"about_y", headed(plane ? "y" : "", u.of(0, 1)), "%.5g"},
                     {"dissipation", "lost a cycle" + u.total(1), "%.4e"},
                     {"stick", "sticks over" + u.of(0, 1), "%.4g"},
                     {"slip", "slips over" + u.of(0, 1), "%.4g"},
                     {"separation", "is open over" + u.of(0, 1), "%.4g"},
                     {"tied"},
                     {"nodes"},
                     {"free_surface", faces_nothing ? "no node opposite" : ""},
                     {"arm"}});
   std::vector<Zone> all_zones;
   if (reduction_.problem.nodes() > 0)
   {
      all_zones = zones(reduction_.problem, state);
      if (!plane) { all_zones = zones_to_axis(reduction_.problem, all_zones); }
   }
   const CycleRecord *cycle = march.cycles.empty() ? nullptr : &march.cycles.back();
   for (const InterfaceReport &face : reduction_.interfaces)
   {
      const Resultant sum = resultant(face, state);
      const Vector2d about = middle(face);
      const bool known = cycle && cycle->whole && !face.tied;
      const double lost =
         known ? cycle->node_dissipation.segment(face.first, face.nodes).sum() : none;
      std::array<double, 3> lengths = {0, 0, 0}; // of stick, slip and separation
      for (const Zone &zone : all_zones)
      {
         if (reduction_.problem.chains[zone.chain].interface != face.name) { continue; }
         lengths[zone.state == NodeState::stick        ? 0
                 : zone.state == NodeState::separation ? 2
                                                       : 1] +=
            zone.to.position - zone.from.position;
      }
      if (face.tied) { lengths.fill(none); }
      study_.row(table,
                 {face.name, body(face.bodies[face.of_second]), sum.normal, sum.tangential,
                  plane ? sum.force[0] : none, sum.force[1], plane ? sum.moment : none,
                  plane ? sum.defect : none, twists() ? sum.torque : none, about[0], about[1],
                  lost, lengths[0], lengths[1], lengths[2], face.tied, face.nodes,
                  face.free_surface.size(), face.arm});
   }
}

void JointReport::report_cycles(const MarchReport &march)
{
   const Units &u = study_.units;
   ResultTable &table = study_.table(
      "interface_cycles",
      {{"cycle", "cycle"},
       {"interface", "interface"},
       {"dissipation", "dissipation" + u.total(1), "%.4e"},
       {"work", (twists() ? "work of -torque" : "work of -T over mean slip") + u.total(1),
        "%.4e"},
       {"shear_range", twists() ? "range of torque" + u.total(1) : "range of T" + u.total(0),
        "%.4e"},
       {"slip_range", twists() ? "range of mean turn" : "range of mean slip" + u.of(0, 1),
        "%.4e"},
       {"stiffness", "secant stiffness" + u.total(twists() ? 1 : -1), "%.4e"},
       {"loss_factor", "loss factor (of the work)", "%.4f"}});
   // Only the last cycle is printed.
   table.quiet(!study_.verbose());
   for (const ordered_json &row : study_.rows_before(table.name()))
   {
      study_.row(table, table.values(row));
   }
   for (const CycleRecord &cycle : march.cycles)
   {
      if (cycle.whole && cycle.cycle == begun_)
      {
         study_.say(text("the march began within cycle %d: the loops of its interfaces are not "
                         "known, and left out",
                         begun_));
         continue;
      }
      for (std::size_t k = 0; k < courses_.size() && cycle.whole; ++k)
      {
         const InterfaceReport &face = reduction_.interfaces[k];
         const auto found = courses_[k].cycles.find(cycle.cycle);
         if (face.tied || found == courses_[k].cycles.end()) { continue; }
         const auto &[loop, most_force, most_slip] = found->second;
         const double force = settled(loop.force_range(), most_force),
                      way = settled(loop.displacement_range(), most_slip);
         const bool swings = force > 0 && way > 0;
         table.quiet(!study_.verbose() && &cycle != &march.cycles.back());
         study_.row(table,
                    {cycle.cycle, face.name,
                     cycle.node_dissipation.segment(face.first, face.nodes).sum(),
                     swings ? loop.work() : 0, force, way, swings ? loop.stiffness() : none,
                     swings ? loop.loss_factor() : none});
      }
   }
}

void JointReport::draw_loops()
{
   Panel &panel =
      study_.lines("interface_loops",
                   twists() ? "Torque of each interface over its mean turn"
                            : "Shear force of each interface over its mean slip",
                   twists() ? "mean turn" : "mean slip" + study_.units.of(0, 1),
                   (twists() ? "torque that resists" : "shear force that resists, -T") +
                      study_.units.total(twists() ? 1 : 0));
   for (std::size_t k = 0; k < courses_.size(); ++k)
   {
      const Course &course = courses_[k];
      if (course.shear.empty()) { continue; }
      // If forces balance each other, only round-off is left, which is not a loop.
      const auto [least, most] = std::minmax_element(course.shear.begin(), course.shear.end());
      if (*most - *least < 1e-6 * course.pressing) { continue; }
      panel.add(reduction_.interfaces[k].name, course.slip, course.shear);
   }
}

} // namespace miniapp
