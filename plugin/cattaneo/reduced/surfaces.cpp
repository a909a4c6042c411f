#include <algorithm>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/surfaces.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace
{

std::string place_of(const CondensedBody &body, Index node)
{
   return place_text(body.surface.nodes[node].position, Formulation::space);
}

/// The frame with the mean normal of two nodes that face each other. Its first tangent is that
/// of the first node, or of the second one if supports hold tangents there (`other_is_held`),
/// turned to be perpendicular to the normal.
Matrix3d frame_between(const SurfaceNode &one, const SurfaceNode &other, bool other_is_held)
{
   const Vector3d normal = (one.normal() - other.normal()).normalized();
   const Vector3d along = (other_is_held ? other : one).frame.row(0);
   Matrix3d frame;
   frame.row(2) = normal;
   frame.row(0) = (along - normal.dot(along) * normal).normalized();
   frame.row(1) = normal.cross(Vector3d(frame.row(0)));
   return frame;
}

} // namespace

std::vector<ContactRow> rows_on_obstacle(const CondensedBody &body)
{
   std::vector<ContactRow> rows(body.nodes());
   for (int i = 0; i < static_cast<int>(body.nodes()); ++i)
   {
      require(!holds(body, i, 2), "reduce: the contact node at ", place_of(body, i),
              " is fixed normal to the surface, so that it cannot open: end the contact before "
              "it");
      rows[i].slave = {0, i};
      rows[i].axes = body.surface.nodes[i].frame;
      rows[i].slides = {!holds(body, i, 0), !holds(body, i, 1)};
      rows[i].shares = {{{0, i}, 1, 1, 1}};
   }
   return rows;
}

std::vector<ContactRow> rows_of_pairs(const std::vector<CondensedBody> &bodies,
                                      const Pairing &pairing)
{
   const CondensedBody &one = bodies[0], &other = bodies[1];
   const auto n = static_cast<int>(one.nodes());
   require(other.nodes() == n && static_cast<int>(pairing.partner.size()) == n &&
              pairing.gap.size() == n,
           "reduce: the contact surfaces have ", n, " and ", other.nodes(),
           " nodes and the pairing ", pairing.partner.size(), ", must be equally many");
   std::vector<bool> taken(n, false);
   std::vector<ContactRow> rows(n);
   for (int i = 0; i < n; ++i)
   {
      const int partner = pairing.partner[i];
      require(partner >= 0 && partner < n && !taken[partner], "reduce: partner ", partner,
              " in the pairing, must have each number from 0 to ", n - 1, " once");
      taken[partner] = true;
      const SurfaceNode &own = one.surface.nodes[i], &its = other.surface.nodes[partner];
      require(own.normal().dot(its.normal()) < 0,
              "reduce: the bodies do not face each other at the contact node ",
              place_of(one, i));
      require(!holds(one, i, 2) || !holds(other, partner, 2), "reduce: the contact node at ",
              place_of(one, i),
              " is fixed normal to the surface in both bodies, so that it cannot open: end the "
              "contact before it");
      const bool held = holds(one, i, 0) || holds(one, i, 1),
                 its_held = holds(other, partner, 0) || holds(other, partner, 1);
      ContactRow &row = rows[i];
      row.slave = {0, i};
      row.axes = frame_between(own, its, its_held && !held);
      // A tangent does not slide if both bodies hold it.
      for (int k = 0; k < 2; ++k)
      {
         const Vector3d tangent = row.axes.row(k);
         const auto is_held = [&tangent](const CondensedBody &body, int node)
         {
            double part = 0;
            for (int t = 0; t < 2; ++t)
            {
               const Vector3d along = body.surface.nodes[node].frame.row(t);
               part += holds(body, node, t) ? std::pow(along.dot(tangent), 2) : 0.0;
            }
            return part > 0.5;
         };
         row.slides[k] = !is_held(one, i) || !is_held(other, partner);
      }
      row.shares = {{{0, i}, 1, 1, 1}, {{1, partner}, -1, -1, -1}};
   }
   choose_dependents(bodies, rows);
   return rows;
}

Reduction reduce_surfaces(std::vector<CondensedBody> bodies, std::vector<ContactRow> contact,
                          const VectorXd &gap)
{
   Reduction result;
   for (const CondensedBody &body : bodies) { result.counters += body.counters; }
   result.counters.unions += bodies.size() > 1;
   result.bodies = std::move(bodies);
   auto rows = std::make_shared<UnionRows>();
   rows->rows = std::move(contact);
   // Every motion of a body on an obstacle is a motion relative to the obstacle.
   if (result.bodies.size() > 1) { rows->groups = {{0, 1}}; }
   const auto n = static_cast<Index>(rows->rows.size());
   for (int i = 0; i < static_cast<int>(n); ++i) { rows->free.push_back(i); }
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   Block block = united(result.bodies, *rows, result.pattern_, problem.patterns);
   result.union_ = block.way_back;
   take(std::move(block), 3, problem);
   // The nodes are those of the first body; areas are the means of both.
   const auto count = static_cast<int>(result.bodies.size());
   problem.gap = gap;
   problem.weights = VectorXd::Zero(n);
   problem.position.resize(n, 3);
   problem.dofs = Eigen::MatrixXi::Constant(n, 3 * count, -1);
   InterfaceReport report;
   report.name = "contact";
   report.bodies = {0, count > 1 ? 1 : -1};
   report.nodes = n;
   report.matching = count > 1;
   report.frames.resize(n, 9);
   for (Index i = 0; i < n; ++i)
   {
      const ContactRow &row = rows->rows[i];
      require(std::isfinite(gap[i]), "reduce: the gap at ",
              place_of(result.bodies[0], row.slave.second), " is ", gap[i], ", must be finite");
      for (const TraceShare &share : row.shares)
      {
         const SurfaceNode &node = result.bodies[share.of.first].surface.nodes[share.of.second];
         problem.weights[i] += node.weight / count;
         for (int c = 0; c < 3; ++c) { problem.dofs(i, 3 * share.of.first + c) = node.dofs[c]; }
      }
      problem.position.row(i) = result.bodies[0].surface.nodes[row.slave.second].position;
      report.frames.row(i) << row.axes.row(0), row.axes.row(1), row.axes.row(2);
   }
   report.weights = problem.weights;
   result.interfaces = {report};
   result.rows_ = std::move(rows);
   return result;
}

Reduction reduce(CondensedBody body, const VectorXd &gap)
{
   require(body.line.formulation == Formulation::space,
           "reduce: gaps are given for each node, but the body is ",
           name(body.line.formulation), ", where the gap must be a function of the place");
   require(gap.size() == body.nodes(), "reduce: ", gap.size(),
           " gaps, must be one for each of the ", body.nodes(), " contact nodes");
   std::vector<CondensedBody> bodies;
   bodies.push_back(std::move(body));
   std::vector<ContactRow> rows = rows_on_obstacle(bodies[0]);
   choose_dependents(bodies, rows);
   return reduce_surfaces(std::move(bodies), std::move(rows), gap);
}

} // namespace cattaneo
