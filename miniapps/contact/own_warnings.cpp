#include "contact/own_warnings.hpp"

#include <algorithm>
#include <cattaneo/elastic/rotation.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using namespace cattaneo;

void warn_of_accuracy(double accuracy)
{
   if (accuracy <= 1e-6) { return; }
   warn(std::isfinite(accuracy)
           ? told("the relative error of the contact stiffness may be ", accuracy,
                  " (round-off of the condensation, an upper estimate)")
           : "round-off of the condensation leaves no digit of the contact stiffness",
        ": Young's moduli or element sizes within a body are too far apart. Replace a much "
        "stiffer part by a rigid obstacle or a guide, or lower its modulus; this changes no "
        "visible result");
}

/// An interference fit moves nodes by less than their distance. A larger overlap means a body
/// in a wrong place, or in other units.
void warn_of_overlap(const ReducedProblem &problem, const InterfaceReport &interface)
{
   if (interface.tied) { return; }
   Eigen::Index deepest = 0;
   const auto gap = problem.gap.segment(interface.first, interface.nodes);
   const double overlap = -gap.cwiseQuotient(interface.spacing).minCoeff(&deepest);
   if (overlap <= 1) { return; }
   warn("the bodies overlap by ", -gap[deepest], " at (", interface.position(deepest, 0), ", ",
        interface.position(deepest, 1), "), which is ", overlap,
        " distances of nodes. Small displacements cannot open such an overlap: check that both "
        "meshes are in place and in the same unit");
}

void warn_of_left_out(const InterfaceReport &interface)
{
   if (interface.left_out <= 0) { return; }
   warn("interface '", interface.name, "': ", interface.left_out,
        " of its length (about an axis and in space: of its area) faces the other side, but no "
        "contact node "
        "there can carry a force: choose the other side by key 'slave', or use finer elements "
        "there");
}

void warn_of_loose_bodies(const OwnBodies &own)
{
   const Reduction &reduction = own.scene.reduction;
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      double least = std::numeric_limits<double>::infinity();
      for (const InterfaceReport &face : reduction.interfaces)
      {
         const auto number = static_cast<int>(b);
         if (face.bodies[0] != number && face.bodies[1] != number) { continue; }
         least = std::min(
            least,
            face.tied ? 0 : reduction.problem.gap.segment(face.first, face.nodes).minCoeff());
      }
      if (reduction.bodies[b].free_motions.cols() == 0 || least <= 0) { continue; }
      const std::string &name = reduction.bodies[b].name;
      warn("body ", (name.empty() ? std::to_string(b + 1) : name),
           " is free and touches nothing at rest (the least gap is ", least,
           "). The first force moves it in one step until it touches, and a march may fail "
           "from there. Place it so that it touches, move it there by a guide, or hold a "
           "motion that nothing resists (a rotation without friction)");
   }
}

void warn_of_thin_wall(const SmoothSides &sides, const std::string &body, int order)
{
   if (!sides.thinned) { return; }
   const WallOfChords &at = *sides.thinned;
   const double share = at.off / at.wall;
   // In the mean along a chord the wall lacks two thirds of what it lacks at the middle.
   // Membrane stiffness is in proportion to the thickness, bending stiffness to its third
   // power: an error of twice the share at the middle, which is a twentieth here.
   if (std::abs(share) < 0.025) { return; }
   warn("body ", body, ": ", sides.free_chords,
        " straight edges of its free sides are chords of smooth curves and stay straight, ",
        order < 2 ? "because its elements are of order 1"
                  : "because elements beside them would fold, or its mesh is periodic",
        "; at (", at.place[0], ", ", at.place[1], ") its wall is ", at.wall,
        ", that of the curves ", at.wall + at.off, ": the body is ",
        share > 0 ? "softer" : "stiffer", " than it should be, its wall by about ",
        2. / 3 * std::abs(share), " in tension and by ", 2 * std::abs(share),
        " in bending (estimates). Use more edges there, or a curved mesh (in Gmsh: -order 2)");
}

void note_smooth_sides(const JointCase &joint, const Reduction &reduction,
                       const std::vector<SmoothSides> &sides)
{
   for (std::size_t k = 0; k < reduction.interfaces.size(); ++k)
   {
      const InterfaceReport &face = reduction.interfaces[k];
      std::vector<std::string> names;
      std::string straight;
      for (int b : face.bodies)
      {
         // Round-off of coordinates does not make a curve.
         const bool smooth = b >= 0 && b < static_cast<int>(sides.size()) &&
                             !joint.bodies[b].as_meshed &&
                             sides[b].most > 1e-5 * face.spacing.mean();
         if (!smooth || (!names.empty() && face.bodies[0] == face.bodies[1])) { continue; }
         names.push_back(joint.bodies[b].name);
         const std::vector<SideChord> &folding = sides[b].folding;
         if (folding.empty()) { continue; }
         const Eigen::Vector2d at = 0.5 * (folding.front().from + folding.front().to);
         straight +=
            told("; elements beside ", folding.size(), " of the ", sides[b].edges, " of ",
                 joint.bodies[b].name, " would fold: these stay straight, the first at (",
                 at[0], ", ", at[1], ")");
      }
      if (names.empty()) { continue; }
      const double change = face.curved.size() > 0 ? face.curved.cwiseAbs().maxCoeff() : 0;
      note("interface '" + joint.faces[k].name + "': straight edges of " + listed(names) +
           " are taken for chords of smooth curves through their vertices, " +
           (change > 0 ? told("which changes the gap by up to ", change)
                       : "which leaves the gap as it is") +
           straight + " (key geometry: as meshed takes the polygons)");
   }
   for (std::size_t b = 0; b < sides.size(); ++b)
   {
      if (sides[b].free_edges == 0) { continue; }
      note(told("body ", joint.bodies[b].name, ": ", sides[b].free_edges,
                " straight edges of its other sides are taken for chords of smooth curves as "
                "well, and curved"));
   }
}

ChordalError warn_of_chords(const Reduction &reduction, const Eigen::VectorXd &p,
                            const Eigen::VectorXd &w)
{
   const ChordalError shares = chordal_error(reduction, p, w);
   const bool in_space = !reduction.bodies.empty() && reduction.bodies[0].surface.size() > 0;
   const bool known = std::isfinite(shares.at_a_node);
   if (shares.at_a_node <= 0.05) { return shares; }
   // First where nodes carry forces, and beside these, because chords are off their curves only
   // between vertices, and perhaps only vertices carry forces. If there is none, then anywhere.
   const InterfaceReport *worst = nullptr;
   double most = 0;
   for (const bool anywhere : {!known, true})
   {
      for (const InterfaceReport &face : reduction.interfaces)
      {
         if (face.tied || face.chords.size() != face.nodes) { continue; }
         for (Eigen::Index i = 0; i < face.nodes; ++i)
         {
            const Eigen::Index from = std::max<Eigen::Index>(i - 1, 0),
                               to = std::min(i + 1, face.nodes - 1);
            const bool near = p.segment(face.first + from, to - from + 1).maxCoeff() > 0;
            if ((anywhere || near) && std::abs(face.chords[i]) > most)
            {
               worst = &face;
               most = std::abs(face.chords[i]);
            }
         }
      }
      if (worst) { break; }
   }
   if (!worst) { return shares; }
   warn("interface '", worst->name,
        "': its elements are chords of curves, so that the gap is uncertain by about ", most,
        ": ",
        known ? told("this changes the largest pressure by up to ", shares.of_peak,
                     " of it, and that of a single node by up to ", shares.at_a_node,
                     " of the largest (estimates)")
              : "no node carries a force now, but some may on the curves",
        in_space
           ? ". Take nodes that match, finer elements, elements of order 2 on both sides, or "
             "give the gap by key 'gap'"
           : ". Take key geometry: smooth, which follows curves that the vertices show, a "
             "mesh of a higher order (in Gmsh: -order 2), or give the gap by key 'gap'");
   return shares;
}

void warn_of_linear_axis(const Reduction &reduction, const Eigen::VectorXd &p)
{
   for (std::size_t b = 0; b < reduction.bodies.size(); ++b)
   {
      double reach = 0; // of linear elements with a node that is not in the line
      for (const LineChain &chain : reduction.bodies[b].line.chains)
      {
         for (const LineElement &element : chain.elements)
         {
            const bool axis = element.nodes.front() < 0 || element.nodes.back() < 0;
            if (axis && element.order() == 1)
            {
               reach = std::max(reach, element.points.row(0).maxCoeff());
            }
         }
      }
      bool bears = false;
      for (const InterfaceReport &face : reduction.interfaces)
      {
         const int number = static_cast<int>(b);
         const bool has = face.bodies[0] == number || face.bodies[1] == number;
         if (reach == 0 || face.tied || !has) { continue; }
         for (Eigen::Index i = 0; i < face.nodes; ++i)
         {
            bears = bears || (face.position(i, 0) < 2 * reach && p[face.first + i] > 0);
         }
      }
      if (!bears) { continue; }
      const std::string &name = reduction.bodies[b].name;
      warn("body " + (name.empty() ? std::to_string(b + 1) : name) +
           " has linear elements next to the axis. Their node on the axis takes no force. The "
           "pressure of the next node is wrong by about 5 % or more on any mesh: use elements "
           "of order 2");
   }
}

std::vector<bool> even_sides(const JointCase &joint)
{
   std::vector<bool> even;
   for (const JointCase::Face &face : joint.faces)
   {
      const bool rigid = face.sides[1].body < 0;
      even.push_back(
         (rigid && std::isnan(face.radius) && !face.curve && face.obstacle.size() < 3) ||
         (!rigid && joint.bodies[face.sides[1].body].half_plane));
   }
   return even;
}

void warn_of_large_displacements(Scene &scene, const SmallDisplacements &noted,
                                 const ContactState &last)
{
   for (const std::string &sentence : noted.warnings()) { warn(sentence); }
   Reduction &reduction = scene.reduction;
   const Counters before = reduction.counters; // of the study, which requested no fields
   for (std::size_t b = 0; b < scene.bodies.size(); ++b)
   {
      const Eigen::VectorXd field =
         reduction.displacement(static_cast<int>(b), last.v, last.w, last.multipliers);
      const Rotation most = largest_rotation(*scene.bodies[b], field);
      const std::string &name = reduction.bodies[b].name,
                        sentence = rotation_warning(name.empty() ? std::to_string(b + 1) : name,
                                                    most.angle, most.place,
                                                    scene.meshes[b]->Dimension() == 3);
      if (!sentence.empty()) { warn(sentence); }
   }
   reduction.counters = before;
}

/// Degrees.
static double angle_of(double cosine)
{
   return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
}

SidesThatBear::SidesThatBear(const InterfaceReport &interface,
                             const std::vector<Eigen::Vector2d> &rigid_line)
   : face_(interface)
{
   Eigen::MatrixX2d normals(interface.nodes, 2);
   normals << -interface.tangent.col(1), interface.tangent.col(0);
   Eigen::Vector2d across = (normals.transpose() * interface.weights).normalized();
   if (rigid_line.size() == 2)
   {
      const Eigen::Vector2d along = (rigid_line[1] - rigid_line[0]).normalized(),
                            normal(-along[1], along[0]);
      across = normal.dot(across) < 0 ? Eigen::Vector2d(-normal) : normal;
   }
   const Eigen::VectorXd cosine = normals * across;
   for (Eigen::Index i = 0; i < interface.nodes; ++i)
   {
      if (angle_of(cosine[i]) > 15)
      {
         sides_.push_back({i, angle_of(cosine[i]), interface.position.row(i)});
      }
   }
}

SidesThatBear::SidesThatBear(const InterfaceReport &interface,
                             const std::vector<CondensedBody> &bodies)
   : face_(interface), corners_(true)
{
   for (int b : interface.bodies)
   {
      if (b < 0) { continue; }
      const ContactLine &line = bodies[b].line;
      for (const LineChain &chain : line.chains)
      {
         const Eigen::Index n = chain.nodes;
         for (Eigen::Index k = chain.loop ? 0 : 1; k < (chain.loop ? n : n - 1); ++k)
         {
            const auto place = [&](Eigen::Index node)
            { return line.nodes[chain.first + (node + n) % n].position; };
            const Eigen::Vector2d before = (place(k) - place(k - 1)).normalized(),
                                  after = (place(k + 1) - place(k)).normalized();
            const double turn = angle_of(before.dot(after));
            // 30 degrees is the angle between the edges of a circle of twelve nodes.
            if (turn < 30.5) { continue; }
            for (Eigen::Index i = 0; i < interface.nodes; ++i)
            {
               const double away = (interface.position.row(i) - place(k).transpose()).norm();
               if (away < 0.5 * interface.spacing[i]) { sides_.push_back({i, turn, place(k)}); }
            }
         }
      }
   }
}

void SidesThatBear::note(const ContactState &state)
{
   for (const Node &side : sides_)
   {
      const Eigen::Index i = face_.first + side.index;
      if (closed(state.status[i]) && state.p[i] > 1e-9 * state.p.maxCoeff() &&
          side.angle > worst_.angle)
      {
         worst_ = side;
      }
   }
}

void SidesThatBear::warn() const
{
   if (worst_.index < 0) { return; }
   const std::string place = told("at (", worst_.place[0], ", ", worst_.place[1], ")");
   const long angle = std::lround(worst_.angle);
   miniapp::warn(
      corners_
         ? told("interface '", face_.name, "': its side turns by ", angle, " degrees ", place,
                ", where it carries a force. A contact node has one normal, so forces and "
                "zones are "
                "wrong there: make each face a separate interface, or give a curve more nodes")
         : told("node ", worst_.index, " ", place, " carries a force although its normal is ",
                angle,
                " degrees off that of the rigid line. Forces and zones are wrong there: name "
                "no boundary around a corner as contact"));
}

void warn_of_cut_elements(const mfem::Mesh &mesh, const BoundaryPart &part,
                          const std::string &called, const std::string &name)
{
   int count = 0;
   std::string first;
   for (int e = 0; e < mesh.GetNBE(); ++e)
   {
      const std::vector<int> &its = part.attributes;
      if (std::count(its.begin(), its.end(), mesh.GetBdrAttribute(e)) == 0) { continue; }
      mfem::Array<int> ends;
      mesh.GetBdrElementVertices(e, ends);
      const double *a = mesh.GetVertex(ends[0]), *b = mesh.GetVertex(ends[1]);
      const double low = std::min(a[part.axis], b[part.axis]),
                   high = std::max(a[part.axis], b[part.axis]), small = 1e-9 * (high - low);
      const bool cut = (part.lo > low + small && part.lo < high - small) ||
                       (part.hi > low + small && part.hi < high - small);
      if (!cut) { continue; }
      if (count++ == 0)
      {
         first = "from " + as_text(Eigen::Vector2d(a[0], a[1])) + " to " +
                 as_text(Eigen::Vector2d(b[0], b[1]));
      }
   }
   if (count == 0) { return; }
   warn(called + ": the interval of '" + name + "' ends within an element, " + first +
        ", which is left out of the contact: no force is carried there, and the nodes beside "
        "it carry more. End the interval where elements end, or put a node of the mesh at its "
        "end");
}

} // namespace miniapp
