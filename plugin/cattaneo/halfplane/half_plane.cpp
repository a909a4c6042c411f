#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/condense/straight_line.hpp>
#include <cattaneo/condense/supported_nodes.hpp>
#include <cattaneo/halfplane/flexibility.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/halfplane/kept_rings.hpp>
#include <cattaneo/halfplane/surface.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

std::shared_ptr<const RingIntegrals> KeptRings::of(const SurfaceTrace &trace)
{
   const std::lock_guard<std::mutex> lock(guard_);
   const auto same = [](const SurfaceElement &a, const SurfaceElement &b)
   { return a.unknowns == b.unknowns && a.x == b.x; };
   const std::vector<SurfaceElement> &now = trace.elements();
   if (!rings_ || !std::equal(now.begin(), now.end(), of_.begin(), of_.end(), same))
   {
      rings_ = std::make_shared<RingIntegrals>(ring_integrals(trace));
      of_ = now;
      ++made_;
   }
   return rings_;
}

std::shared_ptr<KeptRings> keep_rings()
{
   return std::make_shared<KeptRings>();
}

SurfaceTrace trace_of(const ContactLine &line, const Surface &surface)
{
   std::vector<SurfaceElement> elements;
   Index unknowns = line.size();
   for (const LineChain &chain : line.chains)
   {
      for (const LineElement &element : chain.elements)
      {
         SurfaceElement made{element.nodes, VectorXd(element.points.cols())};
         for (Index a = 0; a < made.x.size(); ++a)
         {
            made.x[a] = surface.along(element.points.col(a));
            if (made.unknowns[a] >= 0) { continue; }
            made.unknowns[a] = line.size();
            made.x[a] = 0;
            unknowns = line.size() + 1;
         }
         if (made.x[0] > made.x[made.order()])
         {
            std::reverse(made.unknowns.begin(), made.unknowns.end());
            made.x.reverseInPlace();
         }
         elements.push_back(std::move(made));
      }
   }
   return {unknowns, std::move(elements)};
}

namespace
{

/// The half-plane's own line: that of the other body, reversed.
ContactLine surface_line(const ContactLine &other, const Surface &surface)
{
   ContactLine line;
   const Index n = other.size();
   line.formulation = other.formulation;
   for (Index i = 0; i < n; ++i)
   {
      LineNode node;
      node.dofs = {static_cast<int>(i),
                   components(line.formulation) == 2 ? static_cast<int>(n + i) : -1};
      node.position = surface.place(surface.along(other.nodes[n - 1 - i].position));
      node.tangent = tangent(surface.body);
      node.spacing = std::numeric_limits<double>::infinity();
      line.nodes.push_back(node);
   }
   double length = 0;
   for (auto of = other.chains.rbegin(); of != other.chains.rend(); ++of)
   {
      require(!of->elements.empty(), "half-plane: the contact line has no elements, must have "
                                     "those of the body above");
      require(!of->loop, "half-plane: the contact line is a closed loop, must be open");
      LineChain chain;
      chain.first = n - of->first - of->nodes;
      chain.nodes = of->nodes;
      for (auto from = of->elements.rbegin(); from != of->elements.rend(); ++from)
      {
         LineElement element{from->nodes, from->points.rowwise().reverse()};
         std::reverse(element.nodes.begin(), element.nodes.end());
         for (Index a = 0; a < element.points.cols(); ++a)
         {
            Index &node = element.nodes[a];
            if (node >= 0) { node = n - 1 - node; }
            const double x = node < 0 ? 0 : surface.along(element.points.col(a));
            element.points.col(a) = surface.place(x);
            if (a > 0)
            {
               const double step = (element.points.col(a) - element.points.col(a - 1)).norm();
               length += step;
               for (const Index side : {element.nodes[a - 1], node})
               {
                  if (side >= 0)
                  {
                     line.nodes[side].spacing = std::min(line.nodes[side].spacing, step);
                  }
               }
            }
            if (node >= 0) { line.nodes[node].arc_length = length; }
         }
         chain.elements.push_back(std::move(element));
      }
      const auto end = [&](const LineElement &element, Index a)
      {
         const bool on_plane =
            surface.body.is_symmetric() && surface.along(element.points.col(a)) == 0;
         return element.nodes[a] < 0 || on_plane ? LineEnd::symmetry : LineEnd::smooth;
      };
      chain.ends = {end(chain.elements.front(), 0),
                    end(chain.elements.back(), chain.elements.back().order())};
      line.chains.push_back(std::move(chain));
   }
   return line;
}

/// Writes weights of the trace into the line; the weight of a node on the axis goes to its
/// neighbour.
void set_weights(ContactLine &line, const SurfaceTrace &trace)
{
   VectorXd weights = trace.integral([&](double x) { return measure(line.formulation, x); });
   if (trace.unknowns() > line.size())
   {
      const std::vector<Index> &innermost = trace.elements().front().unknowns;
      weights[innermost[1]] += weights[innermost[0]];
   }
   for (Index i = 0; i < line.size(); ++i) { line.nodes[i].weight = weights[i]; }
}

/// The half-plane has only the dofs of its contact nodes.
class SurfaceSolver : public BodySolver
{
public:
   std::vector<int> free;
   Index dofs = 0;
   double relative_error = 0;

   VectorXd recover(const VectorXd &contact, const VectorXd &, Counters &) const override
   {
      VectorXd field = VectorXd::Zero(dofs);
      field(free) = contact;
      return field;
   }
   double error(const MatrixXd &, const MatrixXd &, Counters &) const override
   {
      return relative_error;
   }
};

/** Least eigenvalue of F scaled to a diagonal of ones, by inverse iteration (a few per cent too
    large). Random errors ε √(F_ii F_jj) in the entries of F change energies, and so S, by a
    relative 2 ε √n over this eigenvalue. */
double least_eigenvalue(const DenseCholesky &factor, const VectorXd &diagonal)
{
   const Index n = diagonal.size();
   VectorXd x(n);
   for (Index i = 0; i < n; ++i) { x[i] = std::sin(1.0 + static_cast<double>(i * i)); }
   double largest = 0;
   for (int k = 0; k < 8; ++k)
   {
      x.normalize();
      VectorXd y = diagonal.cwiseSqrt().cwiseProduct(x);
      factor.solve(y);
      x = diagonal.cwiseSqrt().cwiseProduct(y);
      largest = x.norm();
   }
   return 1 / largest;
}

/// Motions without resistance, (x, y) along columns.
MatrixXd translations(const HalfPlane &body, Formulation formulation)
{
   if (formulation != Formulation::plane) { return Eigen::Vector2d(0, 1); }
   if (body.is_symmetric()) { return body.normal; }
   return Eigen::Matrix2d::Identity();
}

/// Displacements of its contact nodes under a bulk stress of 1, without forces on them.
VectorXd stretched(const CondensedBody &body, const HalfPlane &half_plane)
{
   const Index n = body.line.size();
   VectorXd u = VectorXd::Zero(body.S.rows());
   for (Index i = 0; i < n; ++i)
   {
      // Along the surface, which is the tangent of all frames.
      u[i] = half_plane.bulk_strain(body.line.formulation) *
             (body.line.nodes[i].position - half_plane.point).dot(tangent(half_plane));
   }
   for (int row : body.held) { u[row] = 0; }
   return u;
}

/** Adds the loads of a body that is held. Under far forces it moves freely with them, by
    translations y along the motions R. With u₀ the displacements under the bulk stresses the
    energy is

       ½ (u - R y - u₀ ℓ)ᵀ S (u - R y - u₀ ℓ) - ℓᵀ Fᵀ y,

    whose minimum over y depends on u and ℓ only. */
void add_loads(CondensedBody &body, const HalfPlane &half_plane)
{
   const bool plane = body.line.formulation == Formulation::plane;
   std::vector<std::string> names;
   const auto column = [&](const std::string &pattern)
   {
      const auto found = std::find(names.begin(), names.end(), pattern);
      if (found != names.end()) { return static_cast<Index>(found - names.begin()); }
      names.push_back(pattern);
      return static_cast<Index>(names.size()) - 1;
   };
   const MatrixXd axes = translations(half_plane, body.line.formulation);
   const auto most = static_cast<Index>(half_plane.forces.size() + half_plane.bulk.size());
   MatrixXd F = MatrixXd::Zero(axes.cols(), most), u0 = MatrixXd::Zero(body.S.rows(), most);
   for (const FarForce &load : half_plane.forces)
   {
      F.col(column(load.pattern)) = axes.transpose() * load.force;
   }
   const VectorXd strained = stretched(body, half_plane);
   for (const BulkStress &load : half_plane.bulk)
   {
      u0.col(column(load.pattern)) = load.stress * strained;
   }
   const auto count = static_cast<Index>(names.size());
   F.conservativeResize(Eigen::NoChange, count);
   u0.conservativeResize(Eigen::NoChange, count);
   MatrixXd pushed = MatrixXd::Zero(body.S.rows(), count); // by the far forces, u = 0
   body.H = MatrixXd::Zero(count, count);
   if (!half_plane.forces.empty())
   {
      const MatrixXd motions =
         plane ? MatrixXd(body.rigid_motions().leftCols(2) * axes) : body.rigid_motions();
      const MatrixXd held_back = body.S * motions;
      DenseCholesky resistance;
      require(resistance.compute(motions.transpose() * held_back),
              "half-plane: its stiffness against its translations is not positive definite");
      body.S -= held_back * resistance.solved(held_back.transpose());
      body.S.triangularView<Eigen::StrictlyUpper>() = body.S.transpose();
      const MatrixXd moved = resistance.solved(F);
      pushed = -held_back * moved;
      body.H = F.transpose() * moved + pushed.transpose() * u0 + u0.transpose() * pushed;
      body.rigid_modes = static_cast<int>(motions.cols());
      body.free_motions = thin_qr(motions).Q;
   }
   const MatrixXd held = body.S * u0, clamped = pushed - held;
   body.H -= u0.transpose() * held;
   const Index n = body.line.size();
   for (Index k = 0; k < count; ++k)
   {
      body.patterns.push_back({names[static_cast<std::size_t>(k)], Control::force,
                               clamped.col(k).head(n), clamped.col(k).tail(n)});
   }
}

} // namespace

void HalfPlane::validate(Formulation formulation) const
{
   material.validate();
   const bool plane = formulation == Formulation::plane;
   require(
      plane || material.state == PlaneState::strain,
      "half-plane: its material is in plane stress, must be of plane strain about an axis");
   require(point.allFinite(), "half-plane: the point of its surface is ", point,
           ", must be finite");
   require(std::abs(normal.norm() - 1) <= 1e-9 &&
              (plane ? !is_symmetric() || normal[0] == 0 || normal[1] == 0 : normal[0] == 0),
           "half-plane: the normal of its surface is ", normal, ", must be of length 1",
           plane ? "" : " and along the axis",
           plane && is_symmetric() ? ", and horizontal or vertical beside a plane of symmetry"
                                   : "");
   require(thickness > 0 && std::isfinite(thickness) && (plane || thickness == 1),
           "half-plane: its thickness is ", thickness,
           plane ? ", must be positive and finite" : ", must be 1 about an axis");
   require(
      plane || !is_symmetric(),
      "half-plane: `symmetric` is true for a half-space about an axis, must be false there");
   for (const FarForce &load : forces)
   {
      const Eigen::Vector2d &F = load.force;
      require(!load.pattern.empty(), "half-plane: a far force has no pattern, must name one");
      require(F.allFinite() && ((plane && !is_symmetric()) || F.dot(tangent(*this)) == 0),
              "half-plane: the far force of the pattern '", load.pattern, "' is ", F,
              ", must be finite",
              plane && !is_symmetric() ? "" : " and along the normal of the surface");
      require(std::count_if(forces.begin(), forces.end(),
                            [&](const FarForce &other)
                            { return other.pattern == load.pattern; }) == 1,
              "half-plane: two far forces have the pattern '", load.pattern,
              "', must be one: add them up");
   }
   for (const BulkStress &load : bulk)
   {
      require(!load.pattern.empty(), "half-plane: a bulk stress has no pattern, must name one");
      require(std::isfinite(load.stress), "half-plane: the bulk stress of the pattern '",
              load.pattern, "' is ", load.stress, ", must be finite");
      require(std::count_if(bulk.begin(), bulk.end(),
                            [&](const BulkStress &other)
                            { return other.pattern == load.pattern; }) == 1,
              "half-plane: two bulk stresses have the pattern '", load.pattern,
              "', must be one: add them up");
   }
}

double HalfPlane::bulk_strain(Formulation formulation) const
{
   return formulation == Formulation::plane ? 1 / material.plane_modulus()
                                            : (1 - material.poisson) / material.young;
}

double HalfPlane::bulk_stress(const NamedLoads &loads) const
{
   double sum = 0;
   for (const BulkStress &load : bulk)
   {
      const auto found = loads.find(load.pattern);
      if (found != loads.end()) { sum += found->second * load.stress; }
   }
   return sum;
}

CondensedBody condense(const HalfPlane &body, const ContactLine &other)
{
   body.validate(other.formulation);
   other.validate();
   for (const LineChain &chain : other.chains)
   {
      for (const std::size_t end : {0, 1})
      {
         const LineNode &last = other.nodes[chain.first + (end ? chain.nodes - 1 : 0)];
         require(body.symmetric || other.formulation != Formulation::plane || chain.loop ||
                    chain.ends[end] != LineEnd::symmetry,
                 "half-plane: a support holds the last contact node, at ", last.position,
                 ", along the surface: say whether this is a plane of symmetry. For half a "
                 "model set symmetric = true, with `point` on the plane, else "
                 "symmetric = false");
      }
   }
   const Surface surface(body, other);
   CondensedBody result;
   result.line = surface_line(other, surface);
   const ContactLine &line = result.line;
   const SurfaceTrace trace = trace_of(line, surface);
   set_weights(result.line, trace);
   line.validate();

   const Formulation formulation = line.formulation;
   const bool torsion = formulation == Formulation::torsion;
   const Flexibility F =
      formulation == Formulation::plane
         ? plane_flexibility(trace, body.material, body.depth, body.is_symmetric())
      : torsion ? torsion_flexibility(*body.rings->of(trace), body.material)
                : axisymmetric_flexibility(trace, *body.rings->of(trace), body.material,
                                           -tangent(body)[0]);
   const Eigen::SparseMatrix<double> mass = trace.mass(
      [&](double x)
      { return measure(formulation, x) * lever(formulation, x) * lever(formulation, x); });

   // The free unknowns. In each component those on the axis come last.
   const Index n = line.size(), unknowns = trace.unknowns(), axis = unknowns - n;
   std::vector<int> kept, free; // unknowns, and rows of S
   for (int c = 0; c < components(formulation); ++c)
   {
      for (Index i = 0; i < unknowns; ++i)
      {
         const bool on_axis = i == n, normal = c == 1 || torsion;
         const bool on_plane =
            !on_axis && body.is_symmetric() && surface.along(line.nodes[i].position) == 0;
         const auto row = static_cast<int>(c * n + i);
         if (on_plane && !normal) { result.held.push_back(row); }
         if ((on_axis || on_plane) && !normal) { continue; }
         kept.push_back(static_cast<int>(c * unknowns + i));
         if (!on_axis) { free.push_back(row); }
      }
   }
   const auto size = static_cast<Index>(kept.size()), rows = components(formulation) * n;
   const MatrixXd flexible = F(kept, kept);
   DenseCholesky factor;
   require(factor.compute(flexible),
           "half-plane: its flexibility is not positive definite: choose a larger depth than ",
           body.depth,
           " (to which displacements are relative), or a Poisson's ratio further from its "
           "limits than ",
           body.material.poisson);
   const Eigen::SparseMatrix<double> M = kept_of(mass, kept);
   MatrixXd S = M * (factor.inverse() * M);
   S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
   if (axis) // no far force moves it
   {
      const VectorXd column = S.col(size - 1) / std::sqrt(S(size - 1, size - 1));
      S -= column * column.transpose();
   }
   result.S = MatrixXd::Zero(rows, rows);
   const auto own = static_cast<Index>(free.size());
   result.thickness = body.thickness;
   result.S(free, free) = body.thickness * S.topLeftCorner(own, own);
   if (torsion)
   {
      const VectorXd inverse = line.each(&LineNode::position).col(0).cwiseInverse();
      result.S = (inverse.asDiagonal() * result.S * inverse.asDiagonal()).eval();
      result.S.triangularView<Eigen::StrictlyUpper>() = result.S.transpose();
   }
   result.free_motions.resize(rows, 0);
   auto solver = std::make_shared<SurfaceSolver>();
   solver->dofs = rows;
   // The free rows by components x and y. A component that is held along the surface is x, or y
   // if the surface is upright.
   const bool upright = tangent(body)[0] == 0;
   for (Index i = 0; i < rows; ++i)
   {
      const auto row = static_cast<int>(upright ? (i + n) % rows : i);
      if (!std::binary_search(result.held.begin(), result.held.end(), row))
      {
         solver->free.push_back(static_cast<int>(i));
      }
   }
   solver->relative_error = 10 * std::numeric_limits<double>::epsilon() *
                            std::sqrt(double(size)) /
                            least_eigenvalue(factor, flexible.diagonal());
   result.solver = std::move(solver);
   if ((!body.forces.empty() || !body.bulk.empty()) && !torsion) { add_loads(result, body); }
   return result;
}

CondensedBody condense(const HalfPlane &body, const std::vector<double> &grid, int order,
                       Formulation formulation)
{
   ContactLine own = straight_line(grid, order, formulation);
   const Surface surface(body, own);
   for (LineNode &node : own.nodes) { node.position = surface.place(node.position[0]); }
   for (LineElement &element : own.chains[0].elements)
   {
      for (Index a = 0; a < element.points.cols(); ++a)
      {
         element.points.col(a) = surface.place(element.points(0, a));
      }
   }
   ContactLine facing = surface_line(own, surface);
   // Radii grow to the right. If the line of the surface runs to the left, the axis comes last.
   if (!surface.plane && tangent(body)[0] < 0) { facing = surface_line(facing, surface); }
   set_weights(facing, trace_of(facing, surface));
   return condense(body, facing);
}

namespace
{

/// A chain of an interface's first side, which stands on the half-plane.
struct Standing
{
   std::size_t interface;
   const LineChain *chain;
   double along; ///< the surface, of its first node
};

/// Nodes of some chains as a line of their own; elements keep the numbers of their nodes.
void append(ContactLine &line, const ContactLine &from, const LineChain &chain)
{
   LineChain moved = chain;
   moved.first = line.size();
   for (LineElement &element : moved.elements)
   {
      for (Index &node : element.nodes)
      {
         if (node >= 0) { node += moved.first - chain.first; }
      }
   }
   line.nodes.insert(line.nodes.end(), from.nodes.begin() + chain.first,
                     from.nodes.begin() + chain.first + chain.nodes);
   line.chains.push_back(std::move(moved));
}

} // namespace

Reduction reduce(std::vector<CondensedBody> bodies, std::vector<Interface> interfaces,
                 const HalfPlane &half_plane)
{
   const auto below = static_cast<int>(bodies.size());
   for (Interface &one : interfaces)
   {
      // If its body ends at a plane of symmetry, the half-plane must say whether it is
      // symmetric there.
      const int first = one.first.body;
      if (one.second.body == below && first >= 0 && first < below)
      {
         meet_supports(one.first.line, bodies[first]);
      }
   }
   std::vector<Standing> standing;
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      const ContactLine &line = interfaces[k].first.line;
      for (const LineChain &chain : line.chains)
      {
         if (interfaces[k].second.body != below) { continue; }
         const Vector2d &place = line.nodes[chain.first].position;
         standing.push_back({k, &chain, (place - half_plane.point).dot(tangent(half_plane))});
      }
   }
   require(!standing.empty(),
           "half-plane: it is in no interface, must be the second side of one");
   // The lines of the bodies on the half-plane run opposite to its own line.
   std::stable_sort(standing.begin(), standing.end(),
                    [](const Standing &a, const Standing &b) { return a.along > b.along; });
   ContactLine all;
   all.formulation = interfaces[standing[0].interface].first.line.formulation;
   for (const Standing &one : standing)
   {
      append(all, interfaces[one.interface].first.line, *one.chain);
   }
   const Index n = all.size();
   for (Index i = 0; i < n; ++i) // its own dofs: those of bodies may coincide
   {
      all.nodes[i].dofs = {static_cast<int>(i), static_cast<int>(n + i)};
      if (components(all.formulation) == 1) { all.nodes[i].dofs[1] = -1; }
   }
   bodies.push_back(condense(half_plane, all));
   const CondensedBody &made = bodies.back();
   for (Interface &one : interfaces)
   {
      if (one.second.body != below) { continue; }
      one.second.line = ContactLine();
      one.second.line.formulation = all.formulation;
      one.pairing =
         Pairing{std::vector<int>(one.first.line.size()), VectorXd(one.first.line.size())};
   }
   // Its chains are those of the bodies on it, from the last to the first, each reversed.
   for (std::size_t c = standing.size(); c-- > 0;)
   {
      Interface &one = interfaces[standing[c].interface];
      const LineChain &chain = *standing[c].chain;
      ContactLine &own = one.second.line;
      append(own, made.line, made.line.chains[standing.size() - 1 - c]);
      for (Index i = 0; i < chain.nodes; ++i)
      {
         const LineNode &node = one.first.line.nodes[chain.first + i];
         const double gap = (half_plane.point - node.position).dot(half_plane.normal);
         one.pairing->partner[chain.first + i] = static_cast<int>(own.size() - 1 - i);
         one.pairing->gap[chain.first + i] = std::abs(gap) > 1e-9 * node.spacing ? gap : 0.0;
      }
   }
   return reduce(std::move(bodies), interfaces);
}

Reduction reduce(CondensedBody body, const HalfPlane &half_plane)
{
   Interface contact;
   contact.first = {0, body.line};
   contact.second.body = 1;
   std::vector<CondensedBody> bodies;
   bodies.push_back(std::move(body));
   return reduce(std::move(bodies), {contact}, half_plane);
}

} // namespace cattaneo
