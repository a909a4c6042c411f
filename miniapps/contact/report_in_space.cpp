#include "contact/report_in_space.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/readout/areas.hpp>
#include <cmath>
#include <cstdlib>
#include <map>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixX3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using nlohmann::ordered_json;

ReportInSpace::ReportInSpace(Study &study, const JointCase &joint, BodiesInSpace &own)
   : study_(study), joint_(joint), own_(own), reduction_(own.scene.reduction),
     courses_(reduction_.interfaces.size())
{
   for (const InterfaceReport &face : reduction_.interfaces)
   {
      maps_.push_back(face.tied ? Map() : map_of(reduction_, face));
   }
}

std::string ReportInSpace::first_body(const InterfaceReport &face) const
{
   return reduction_.bodies[face.bodies[face.of_second]].name;
}

MatrixX3d ReportInSpace::tangential(const InterfaceReport &face,
                                    const VectorXd &components) const
{
   const Index n = components.size() / 2;
   MatrixX3d made(face.nodes, 3);
   for (Index i = 0; i < face.nodes; ++i)
   {
      made.row(i) = components[face.first + i] * face.frames.row(i).segment<3>(0) +
                    components[n + face.first + i] * face.frames.row(i).segment<3>(3);
   }
   return face.of_second ? MatrixX3d(-made) : made;
}

ReportInSpace::Sum ReportInSpace::sum(const InterfaceReport &face,
                                      const ContactState &state) const
{
   VectorXd q = state.q, p = state.p;
   if (face.tied)
   {
      const VectorXd all = reduction_.tied_forces(state.v, state.w, state.multipliers);
      q = all.head(all.size() / 3 * 2);
      p = all.tail(all.size() / 3);
   }
   if (q.size() == 0) { q = VectorXd::Zero(2 * p.size()); }
   const MatrixX3d shear = tangential(face, q);
   Sum made;
   for (Index i = 0; i < face.nodes; ++i)
   {
      const double bears = p[face.first + i];
      const Vector3d normal =
         (face.of_second ? -bears : bears) * face.frames.row(i).segment<3>(6).transpose();
      made.normal += bears;
      made.shear += shear.row(i);
      made.force += normal + shear.row(i).transpose();
      made.size += std::hypot(bears, shear.row(i).norm());
   }
   for (int c = 0; c < 3; ++c)
   {
      made.shear[c] = settled(made.shear[c], made.size);
      made.force[c] = settled(made.force[c], made.size);
   }
   return made;
}

Vector3d ReportInSpace::middle(const InterfaceReport &face) const
{
   // A body that touches itself has forces of both sides.
   const Vector3d of_places = face.places.transpose() * face.weights / face.weights.sum();
   if (face.bodies[0] == face.bodies[1]) { return of_places; }
   // The forces of a traction of 1 along x. Nodes that have rows of other interfaces are among
   // those that bear them.
   Index ties = 0;
   for (const InterfaceReport &one : reduction_.interfaces)
   {
      ties += one.tied ? one.nodes : 0;
   }
   const Index n = reduction_.problem.nodes(), all = face.tied ? ties : n;
   VectorXd forces = VectorXd::Zero(3 * all);
   for (Index i = 0; i < face.nodes; ++i)
   {
      for (Index k = 0; k < 3; ++k)
      {
         forces[k * all + face.first + i] = face.weights[i] * face.frames(i, 3 * k);
      }
   }
   const VectorXd none = VectorXd::Zero(3 * std::max(n, ties));
   const Eigen::MatrixXd at_nodes =
      face.tied
         ? reduction_.contact_forces(face.bodies[0], none.head(2 * n), none.head(n), forces)
         : reduction_.contact_forces(face.bodies[0], forces.head(2 * n), forces.tail(n),
                                     none.head(3 * ties));
   Vector3d sum = Vector3d::Zero();
   for (Index k = 0; k < at_nodes.rows(); ++k)
   {
      sum += at_nodes(k, 0) * reduction_.bodies[face.bodies[0]].surface.nodes[k].position;
   }
   return sum / face.weights.sum();
}

ReportInSpace::Moments ReportInSpace::moments(const InterfaceReport &face,
                                              const ContactState &state,
                                              const Vector3d &about) const
{
   // The forces of this interface alone.
   const auto alone = [&face](const VectorXd &all, Index components)
   {
      VectorXd made = VectorXd::Zero(all.size());
      const Index n = all.size() / components;
      for (Index k = 0; k < components && n > 0; ++k)
      {
         made.segment(k * n + face.first, face.nodes) =
            all.segment(k * n + face.first, face.nodes);
      }
      return made;
   };
   const VectorXd tied = reduction_.tied_forces(state.v, state.w, state.multipliers),
                  none_of = VectorXd::Zero(tied.size()),
                  q = face.tied ? VectorXd(VectorXd::Zero(state.q.size())) : alone(state.q, 2),
                  p = face.tied ? VectorXd(VectorXd::Zero(state.p.size())) : alone(state.p, 1),
                  its_tied = face.tied ? alone(tied, 3) : none_of;
   double size = 0;
   const auto on_body = [&](int body)
   {
      const Eigen::MatrixXd forces = reduction_.contact_forces(body, q, p, its_tied);
      const ContactSurface &surface = reduction_.bodies[body].surface;
      Vector3d sum = Vector3d::Zero();
      for (Index i = 0; i < surface.size(); ++i)
      {
         const Vector3d force = forces.row(i), arm = surface.nodes[i].position - about;
         sum += arm.cross(force);
         size += arm.norm() * force.norm();
      }
      return sum;
   };
   Moments made;
   const int first = face.bodies[face.of_second], second = face.bodies[!face.of_second];
   Vector3d left = on_body(first);
   made.on_first = left;
   // A body that touches itself has the sum of both.
   if (second >= 0 && second != first) { left += on_body(second); }
   if (second >= 0) { made.defect = settled(left.norm(), size); }
   if (second == first) { made.on_first.fill(none); }
   for (double &x : made.on_first) { x = settled(x, size); }
   return made;
}

void ReportInSpace::note(const ContactState &state, int)
{
   if (state.q.size() == 0) { return; }
   for (std::size_t k = 0; k < courses_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      if (face.tied) { continue; }
      Course &course = courses_[k];
      const MatrixX3d slip = tangential(face, state.v);
      if (course.slip.size() == 2 * most_drawn)
      {
         for (std::vector<Vector3d> *all : {&course.slip, &course.shear})
         {
            all->erase(all->begin(), all->begin() + most_drawn);
         }
      }
      course.slip.emplace_back(slip.transpose() * face.weights / face.weights.sum());
      course.shear.emplace_back(sum(face, state).shear);
   }
}

std::string ReportInSpace::of_state(const ContactState &state)
{
   if (reduction_.interfaces.size() > 1)
   {
      return text("%zu interfaces of %zu bodies", reduction_.interfaces.size(),
                  reduction_.bodies.size());
   }
   const InterfaceReport &face = reduction_.interfaces[0];
   const Vector3d force = sum(face, state).force;
   study_.results["contact_force"] = {force[0], force[1], force[2]};
   return "contact force on " + first_body(face) +
          text(" (%g, %g, %g)", force[0], force[1], force[2]) + study_.units.total(0);
}

void ReportInSpace::report(const ContactState &state, const MarchReport &march,
                           const BoltsReport &bolts)
{
   report_interfaces(state, march);
   report_cycles(march);
   report_reactions(state, bolts);
   draw_loops();
   draw_maps(state);
}

void ReportInSpace::report_interfaces(const ContactState &state, const MarchReport &march)
{
   const Units &u = study_.units;
   ResultTable &table =
      study_.table("interfaces", {{"interface", "interface"},
                                  {"on", "forces on"},
                                  {"normal", "N (pressing)" + u.of(1, 0), "%.6g"},
                                  {"tangential", "T" + u.of(1, 0), "%.6g"},
                                  {"force_x", "x" + u.of(1, 0), "%.6g"},
                                  {"force_y", "y" + u.of(1, 0), "%.6g"},
                                  {"force_z", "z" + u.of(1, 0), "%.6g"},
                                  {"moment_x", "moment about x" + u.of(1, 1), "%.4g"},
                                  {"moment_y", "y" + u.of(1, 1), "%.4g"},
                                  {"moment_z", "z" + u.of(1, 1), "%.4g"},
                                  {"moment_defect"},
                                  {"about_x"},
                                  {"about_y"},
                                  {"about_z"},
                                  {"dissipation", "lost a cycle" + u.of(1, 1), "%.4e"},
                                  {"stick", "stick" + u.of(0, 2), "%.4g"},
                                  {"slip", "slip" + u.of(0, 2), "%.4g"},
                                  {"separation", "open (area)" + u.of(0, 2), "%.4g"},
                                  {"tied"},
                                  {"nodes"}});
   const std::vector<NodeState> states = settled_states(reduction_.problem, state);
   const CycleRecord *cycle = march.cycles.empty() ? nullptr : &march.cycles.back();
   for (const InterfaceReport &face : reduction_.interfaces)
   {
      const Sum found = sum(face, state);
      const Vector3d about = middle(face);
      const Moments turning = moments(face, state, about);
      const bool known = cycle && cycle->whole && !face.tied;
      const double lost =
         known ? cycle->node_dissipation.segment(face.first, face.nodes).sum() : none;
      std::array<double, 3> areas = {0, 0, 0}; // of stick, slip and separation
      for (Index i = 0; i < face.nodes && !face.tied; ++i)
      {
         const NodeState one = states[face.first + i];
         areas[!closed(one) ? 2 : slips(one) ? 1 : 0] += face.weights[i];
      }
      if (face.tied) { areas.fill(none); }
      study_.row(table, {face.name,
                         first_body(face),
                         found.normal,
                         found.shear.norm(),
                         found.force[0],
                         found.force[1],
                         found.force[2],
                         turning.on_first[0],
                         turning.on_first[1],
                         turning.on_first[2],
                         turning.defect,
                         about[0],
                         about[1],
                         about[2],
                         lost,
                         areas[0],
                         areas[1],
                         areas[2],
                         face.tied,
                         face.nodes});
   }
}

void ReportInSpace::report_cycles(const MarchReport &march)
{
   ResultTable &table = study_.table(
      "interface_cycles", {{"cycle", "cycle"},
                           {"interface", "interface"},
                           {"dissipation", "dissipation" + study_.units.of(1, 1), "%.4e"}});
   table.quiet(!study_.verbose());
   for (const ordered_json &row : study_.rows_before(table.name()))
   {
      study_.row(table, table.values(row));
   }
   for (const CycleRecord &cycle : march.cycles)
   {
      for (const InterfaceReport &face : reduction_.interfaces)
      {
         if (face.tied || !cycle.whole) { continue; }
         study_.row(table, {cycle.cycle, face.name,
                            cycle.node_dissipation.segment(face.first, face.nodes).sum()});
      }
   }
}

/// Forces of supports and prescribed displacements on each body are K u less its loads and the
/// contact forces on its nodes. With the loads and the contact they are in balance.
void ReportInSpace::report_reactions(const ContactState &state, const BoltsReport &bolts)
{
   // For a bolt its force, not its pretension.
   VectorXd factors = state.multipliers;
   const std::vector<double> shanks = bolts.shanks(state);
   for (std::size_t k = 0; k < shanks.size(); ++k)
   {
      const JointCase::Bolt &bolt = joint_.bolts[k];
      factors[reduction_.problem.pattern(bolt.name)] = shanks[k] / bolt.force;
   }
   const Units &u = study_.units;
   ResultTable &table = study_.table("reactions",
                                     {{"body", "forces on"},
                                      {"kind", "by"},
                                      {"name", "called"},
                                      {"force_x", "x" + u.of(1, 0), "%.6g"},
                                      {"force_y", "y" + u.of(1, 0), "%.6g"},
                                      {"force_z", "z" + u.of(1, 0), "%.6g"},
                                      {"moment_x", "moment about x" + u.of(1, 1), "%.4g"},
                                      {"moment_y", "y" + u.of(1, 1), "%.4g"},
                                      {"moment_z", "z" + u.of(1, 1), "%.4g"},
                                      {"about_x"},
                                      {"about_y"},
                                      {"about_z"}}),
               &balance = study_.table(
                  "balance",
                  {{"body", "body"},
                   {"imbalance", "imbalance of forces and moments over the largest force",
                    "%.1e"}});
   balance.quiet(!study_.verbose());
   Reduction &reduction = own_.scene.reduction;
   const VectorXd tied = reduction.tied_forces(state.v, state.w, state.multipliers);
   double worst = 0;
   bool loaded = false; // is there a force on any body?
   // Smaller forces are round-off of bodies that move or expand without any.
   std::vector<VectorXd> fields;
   double small = 0;
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      fields.push_back(
         reduction.displacement(static_cast<int>(b), state.v, state.w, state.multipliers));
      small = std::max(small, 1e-12 * own_.scene.bodies[b]->stiffness().MaxNorm() *
                                 fields[b].cwiseAbs().maxCoeff());
   }
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      const auto number = static_cast<int>(b);
      const ElasticBody &body = *own_.scene.bodies[b];
      const VectorXd &field = fields[b];
      mfem::Vector product(body.dofs());
      body.stiffness().Mult(to_mfem(field), product);
      VectorXd rest = view(product);
      std::vector<Vector3d> places(body.dofs());
      std::vector<int> components(body.dofs());
      for (int node = 0; node < body.node_coordinates().Width(); ++node)
      {
         for (int c = 0; c < 3; ++c)
         {
            places[body.true_dof(node, c)] = body.place(node);
            components[body.true_dof(node, c)] = c;
         }
      }
      const Vector3d about = body.box().center();
      const double arm = body.box().diagonal().norm();
      // All forces that act on the body, and their moments.
      Vector3d force = Vector3d::Zero(), moment = force;
      double largest = 0;
      const auto add = [&](const Vector3d &place, const Vector3d &one)
      {
         force += one;
         moment += (place - about).cross(one);
         largest = std::max(largest, one.norm());
      };
      for (const BodyLoad &load : body.patterns())
      {
         if (load.control != Control::force) { continue; }
         const double factor = factors[reduction.problem.pattern(load.name)];
         rest -= factor * load.values;
         for (int dof = 0; dof < body.dofs(); ++dof)
         {
            if (load.values[dof] == 0) { continue; }
            add(places[dof], factor * load.values[dof] * Vector3d::Unit(components[dof]));
         }
      }
      const Eigen::MatrixXd contact = reduction.contact_forces(number, state.q, state.p, tied);
      const ContactSurface &surface = reduction.bodies[b].surface;
      for (Index i = 0; i < surface.size(); ++i)
      {
         const Vector3d one = contact.row(i);
         for (int c = 0; c < 3; ++c) { rest[surface.nodes[i].dofs[c]] -= one[c]; }
         add(surface.nodes[i].position, one);
      }
      for (const Holding &holding : own_.holdings[b])
      {
         // The moment is about the middle of its nodes.
         Vector3d sum = Vector3d::Zero(), turning = sum, middle = sum;
         double size = 0, lever = 0;
         for (const int dof : holding.dofs)
         {
            middle += places[dof] / static_cast<double>(holding.dofs.size());
         }
         for (const int dof : holding.dofs)
         {
            const Vector3d one = rest[dof] * Vector3d::Unit(components[dof]);
            const Vector3d arm = places[dof] - middle;
            sum += one;
            turning += arm.cross(one);
            size += one.norm();
            lever += arm.norm() * one.norm();
            add(places[dof], one);
         }
         for (double &x : sum) { x = settled(x, size); }
         for (double &x : turning) { x = settled(x, lever); }
         study_.row(table, {reduction.bodies[b].name, holding.kind, holding.name, sum[0],
                            sum[1], sum[2], turning[0], turning[1], turning[2], middle[0],
                            middle[1], middle[2]});
      }
      const double imbalance =
         largest > small ? std::max(force.norm(), moment.norm() / arm) / largest : 0;
      loaded = loaded || largest > small;
      worst = std::max(worst, imbalance);
      study_.row(balance, {reduction.bodies[b].name, imbalance});
   }
   if (!loaded) { return; }
   study_.say(
      text("\nEach body is in balance to %.1e of the largest force on a node of it", worst));
}

std::string direction_name(const Vector3d &way)
{
   for (int c = 0; c < 3; ++c)
   {
      if (std::abs(std::abs(way[c]) - 1) < 1e-9)
      {
         return std::string(way[c] < 0 ? "-" : "") + "xyz"[c];
      }
   }
   return text("(%.3g, %.3g, %.3g)", way[0], way[1], way[2]);
}

namespace
{

/// The direction or its opposite, whose largest component is positive.
Vector3d upright(const Vector3d &way)
{
   Index largest = 0;
   way.cwiseAbs().maxCoeff(&largest);
   return way[largest] < 0 ? Vector3d(-way) : way;
}

/// The direction in which vectors differ most.
Vector3d widest(const std::vector<Vector3d> &all)
{
   Vector3d mean = Vector3d::Zero();
   for (const Vector3d &one : all) { mean += one / static_cast<double>(all.size()); }
   Matrix3d spread = Matrix3d::Zero();
   for (const Vector3d &one : all) { spread += (one - mean) * (one - mean).transpose(); }
   return upright(Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvectors().col(2));
}

} // namespace

void ReportInSpace::draw_loops()
{
   Panel &panel =
      study_.lines("interface_loops", "Shear force of each interface over its mean slip",
                   "mean slip" + study_.units.of(0, 1), "-T" + study_.units.of(1, 0));
   for (std::size_t k = 0; k < courses_.size(); ++k)
   {
      const Course &course = courses_[k];
      if (course.slip.empty()) { continue; }
      const Vector3d way = widest(course.shear);
      std::vector<double> slip, shear;
      for (std::size_t i = 0; i < course.slip.size(); ++i)
      {
         slip.push_back(course.slip[i].dot(way));
         shear.push_back(-course.shear[i].dot(way));
      }
      panel.add(reduction_.interfaces[k].name + ", along " + direction_name(way), slip, shear);
   }
}

namespace
{

/// Five digits are enough for a picture.
double few_digits(double x)
{
   return std::strtod(text("%.5g", x).c_str(), nullptr);
}

/// Triangles of a face, by positions of its nodes.
std::vector<std::array<int, 3>> triangles_of(std::size_t nodes)
{
   switch (nodes)
   {
   case 3:
      return {{0, 1, 2}};
   case 4:
      return {{0, 1, 2}, {0, 2, 3}};
   case 6:
      return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
   default:
      // The middle of the face is the last node.
      return {{0, 4, 8}, {4, 1, 8}, {1, 5, 8}, {5, 2, 8},
              {2, 6, 8}, {6, 3, 8}, {3, 7, 8}, {7, 0, 8}};
   }
}

} // namespace

ReportInSpace::Map ReportInSpace::map_of(const Reduction &reduction,
                                         const InterfaceReport &face)
{
   Map made;
   // The position of each node of the body in the interface.
   const int owner = face.bodies[0];
   std::map<int, Index> row_of;
   for (Index i = 0; i < face.nodes; ++i)
   {
      row_of[reduction.problem.dofs(face.first + i, 3 * owner)] = i;
   }
   const ContactSurface &surface = reduction.bodies[owner].surface;
   for (const std::vector<Index> &nodes : surface.faces)
   {
      std::vector<Index> rows;
      for (const Index node : nodes)
      {
         const auto found = row_of.find(surface.nodes[node].dofs[0]);
         if (found != row_of.end()) { rows.push_back(found->second); }
      }
      if (rows.size() != nodes.size()) { continue; }
      for (const auto &[a, b, c] : triangles_of(rows.size()))
      {
         made.triangles.push_back({rows[a], rows[b], rows[c]});
      }
   }
   // Axes in the surface, along the axes of space where these lie in it.
   const Vector3d normal = (face.frames.rightCols(3).transpose() * face.weights).normalized();
   const Matrix3d frame = frame_of(normal);
   made.across = upright(frame.row(0));
   made.up = upright(frame.row(1));
   return made;
}

ordered_json ReportInSpace::maps() const
{
   ordered_json all = ordered_json::array();
   for (std::size_t k = 0; k < maps_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      const Map &map = maps_[k];
      if (face.tied) { continue; }
      ordered_json x = ordered_json::array(), y = x, areas = x, triangles = x;
      for (Index i = 0; i < face.nodes; ++i)
      {
         const Vector2d at = map.flat(face.places.row(i));
         x.push_back(few_digits(at[0]));
         y.push_back(few_digits(at[1]));
         areas.push_back(few_digits(face.weights[i]));
      }
      for (const auto &[a, b, c] : map.triangles) { triangles.push_back({a, b, c}); }
      all.push_back({{"name", face.name},
                     {"first", face.first},
                     {"end", face.first + face.nodes},
                     {"on", first_body(face)},
                     {"x", x},
                     {"y", y},
                     {"areas", areas},
                     {"triangles", triangles},
                     {"x_label", direction_name(map.across) + study_.units.of(0, 1)},
                     {"y_label", direction_name(map.up) + study_.units.of(0, 1)}});
   }
   return all;
}

ordered_json ReportInSpace::fields(const ContactState &state) const
{
   const ReducedProblem &problem = reduction_.problem;
   const Index n = problem.nodes();
   const VectorXd p = tractions(problem, state.p),
                  q = state.q.size() > 0 ? tractions(problem, state.q)
                                         : VectorXd(VectorXd::Zero(2 * n)),
                  v = state.v.size() > 0 ? state.v : VectorXd(VectorXd::Zero(2 * n));
   const std::vector<NodeState> states = settled_states(problem, state);
   // Pressures, and two components each of shear and slip.
   std::array<std::vector<double>, 5> values;
   for (std::vector<double> &one : values) { one.assign(n, 0); }
   std::string letters(n, 'o');
   for (std::size_t k = 0; k < maps_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      const Map &map = maps_[k];
      if (face.tied) { continue; }
      const MatrixX3d shear = tangential(face, q), slip = tangential(face, v);
      for (Index i = 0; i < face.nodes; ++i)
      {
         const Index node = face.first + i;
         if (!closed(states[node])) { continue; }
         letters[node] = slips(states[node]) ? 's' : 'k';
         const Vector2d t = map.flat(shear.row(i)), s = map.flat(slip.row(i));
         values[0][node] = p[node];
         values[1][node] = t[0];
         values[2][node] = t[1];
         values[3][node] = s[0];
         values[4][node] = s[1];
      }
   }
   ordered_json made = {{"state", letters}};
   const std::array<const char *, 5> names = {"p", "qx", "qy", "sx", "sy"};
   for (std::size_t k = 0; k < names.size(); ++k)
   {
      ordered_json list = ordered_json::array();
      for (const double x : values[k]) { list.push_back(few_digits(x)); }
      made[names[k]] = list;
   }
   return made;
}

void ReportInSpace::draw_maps(const ContactState &state)
{
   const ReducedProblem &problem = reduction_.problem;
   const std::vector<NodeState> states = settled_states(problem, state);
   const VectorXd p = tractions(problem, state.p);
   for (std::size_t k = 0; k < maps_.size(); ++k)
   {
      const InterfaceReport &face = reduction_.interfaces[k];
      const Map &map = maps_[k];
      if (face.tied) { continue; }
      const auto flat = [&](const Vector3d &x) { return map.flat(x); };
      // The part in contact is shown, with a margin.
      Eigen::AlignedBox2d shown, whole;
      for (Index i = 0; i < face.nodes; ++i)
      {
         const Vector2d at = flat(face.places.row(i)), edge(face.spacing[i], face.spacing[i]);
         whole.extend(at);
         if (!closed(states[face.first + i])) { continue; }
         shown.extend(at - 2 * edge);
         shown.extend(at + 2 * edge);
      }
      shown = shown.isEmpty() ? whole : shown.intersection(whole);
      const std::string several = reduction_.interfaces.size() > 1 ? " of " + face.name : "",
                        end = reduction_.interfaces.size() > 1 ? "_" + face.name : "";
      const auto panel = [&](const std::string &name, const std::string &title) -> Panel &
      {
         const std::string unit = study_.units.of(0, 1);
         Panel &made =
            study_.panel(Panel::Kind::map, name + end, title + several,
                         direction_name(map.across) + unit, direction_name(map.up) + unit);
         for (const int c : {0, 1})
         {
            made.limit(c ? "y" : "x", shown.min()[c], shown.max()[c]);
         }
         return made;
      };
      const auto draw = [&](Panel &into, const VectorXd &values, const MatrixX3d *arrows)
      {
         for (const auto &triangle : map.triangles)
         {
            Eigen::AlignedBox2d around;
            for (const Index i : triangle) { around.extend(flat(face.places.row(i))); }
            if (!around.intersects(shown)) { continue; }
            for (const Index i : triangle)
            {
               const NodeState one = states[face.first + i];
               into.corner(flat(face.places.row(i)), values[i], closed(one),
                           one == NodeState::stick);
            }
         }
         for (Index i = 0; arrows && i < face.nodes; ++i)
         {
            if (values[i] > 0) { into.arrow(flat(face.places.row(i)), flat(arrows->row(i))); }
         }
      };
      draw(panel("pressure", "Pressure" + study_.units.of(1, -2)),
           p.segment(face.first, face.nodes), nullptr);
      if (state.q.size() == 0) { continue; }
      const MatrixX3d shear = tangential(face, tractions(problem, state.q)),
                      moved = tangential(face, state.v);
      // Nodes that are open do not slip.
      MatrixX3d slip = moved;
      for (Index i = 0; i < face.nodes; ++i)
      {
         if (!closed(states[face.first + i])) { slip.row(i).setZero(); }
      }
      draw(panel("shear", "Shear on " + first_body(face) + study_.units.of(1, -2)),
           shear.rowwise().norm(), &shear);
      draw(panel("slip", "Slip of " + first_body(face) + study_.units.of(0, 1)),
           slip.rowwise().norm(), &slip);
   }
}

} // namespace miniapp
