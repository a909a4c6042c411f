#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/bodies_union.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/** The energies' minimum over y, ½ {u; y}ᵀ E ᵀS E {u; y} + λᵀFᵀE {u; y}, where a common rigid
    motion Y of the bodies is at rest in the mean, Yᵀ E {u; y} = 0. With z = {u; λ} and V the
    forces on y of z, y = -K⁻¹(V z + Bᵀ μ): a Cholesky factor of K (with springs on Y, which
    nothing else resists), and borders B for the constraint. */
class Minimum
{
public:
   /// False if something else moves freely.
   bool compute(const MatrixXd &K, const MatrixXd &forces, const MatrixXd &motions_u,
                const MatrixXd &motions_y)
   {
      forces_ = forces;
      half_ = forces;
      if (!factor_.compute(K)) { return false; }
      factor_.solve_half(half_);
      borders_ = motions_y.transpose();
      if (borders_.rows() == 0) { return true; }
      MatrixXd B = borders_.transpose();
      factor_.solve_half(B);
      stays_ = MatrixXd::Zero(borders_.rows(), forces.cols());
      stays_.leftCols(motions_u.rows()) = motions_u.transpose();
      stays_ -= B.transpose() * half_;
      return border_.compute(B.transpose() * B);
   }
   Index unknowns() const { return forces_.cols(); } ///< of z
   /// What the minimum takes from the energy of z, and the constraint adds.
   MatrixXd without(const MatrixXd &energy, Index first, Index count) const
   {
      MatrixXd left = minus_square(energy, half_.middleCols(first, count));
      if (borders_.rows() == 0) { return left; }
      MatrixXd added = stays_.middleCols(first, count);
      border_.solve_half(added);
      left += added.transpose() * added;
      left.triangularView<Eigen::StrictlyUpper>() = left.transpose();
      return left;
   }
   /// The same between some of z and others.
   MatrixXd taken(Index first, Index count, Index from, Index columns) const
   {
      MatrixXd sum =
         half_.middleCols(first, count).transpose() * half_.middleCols(from, columns);
      if (borders_.rows() == 0) { return sum; }
      MatrixXd a = stays_.middleCols(first, count), b = stays_.middleCols(from, columns);
      border_.solve_half(a);
      border_.solve_half(b);
      return sum - a.transpose() * b;
   }
   VectorXd at(const VectorXd &z) const
   {
      VectorXd rhs = -forces_ * z;
      if (borders_.rows() > 0)
      {
         VectorXd multiplier = stays_ * z;
         border_.solve(multiplier);
         rhs -= borders_.transpose() * multiplier;
      }
      factor_.solve(rhs);
      return rhs;
   }

private:
   DenseCholesky factor_, border_;
   MatrixXd forces_, half_, borders_, stays_;
};

class BodiesUnion : public Reduction::Union
{
public:
   RelativeDisplacement map;
   Minimum minimum;
   std::vector<Index> sizes; ///< of each body's S

   explicit BodiesUnion(RelativeDisplacement relative) : map(std::move(relative)) {}
   VectorXd own(const std::vector<CondensedBody> &, int b, const VectorXd &relative,
                const VectorXd &multipliers) const override
   {
      // Motions of an obstacle, which come later, do not load the bodies.
      VectorXd z(minimum.unknowns());
      z << relative(map.sliding), multipliers.head(z.size() - map.relative());
      VectorXd coordinates(map.size());
      coordinates << z.head(map.relative()), minimum.at(z);
      const auto count = static_cast<Index>(map.free[b].size());
      VectorXd all = VectorXd::Zero(sizes[b]);
      all(map.free[b]) = map.E.middleRows(map.offsets[b], count) * coordinates;
      return all;
   }
};

/// Rigid motions of the plane (or along the axis) about a point, of bodies' traces.
MatrixXd about(const CondensedBody &body, const Eigen::Vector2d &centre, double size)
{
   MatrixXd R = body.rigid_motions();
   if (R.cols() == 3)
   {
      R.col(2) = (R.col(2) + centre[1] * R.col(0) - centre[0] * R.col(1)) / size;
   }
   return R;
}

/** Rigid motions that all bodies of a group may do, as columns of coefficients. A body's free
    motions are rigid motions of the whole, so that each direction of these is either free or
    not: values are 0 or 1 (about hinges, to how far apart they are). */
MatrixXd common_coefficients(const std::vector<CondensedBody> &bodies,
                             const std::vector<int> &group, const Eigen::Vector2d &centre,
                             double size)
{
   MatrixXd resisted;
   for (int b : group)
   {
      const ThinQR R = thin_qr(about(bodies[b], centre, size));
      const MatrixXd &Q = bodies[b].free_motions;
      const MatrixXd rest = R.Q - Q * (Q.transpose() * R.Q);
      const SymmetricModes modes = symmetric_modes(rest.transpose() * rest);
      const Index held = (modes.values.array() > 1e-9).count();
      // Motions Rc that are free: those whose part along the resisted directions vanishes.
      MatrixXd rows = modes.vectors.rightCols(held).transpose() * R.R;
      for (Index k = 0; k < rows.rows(); ++k) { rows.row(k).normalize(); }
      resisted.conservativeResize(resisted.rows() + held, R.R.cols());
      resisted.bottomRows(held) = rows;
   }
   const SymmetricModes modes = symmetric_modes(resisted.transpose() * resisted);
   return modes.vectors.leftCols((modes.values.array() < 1e-14).count());
}

/// What the bodies of a group may do together, orthonormal columns in U.
MatrixXd common_motions(const std::vector<CondensedBody> &bodies, const std::vector<int> &group,
                        const RelativeDisplacement &map)
{
   Eigen::AlignedBox2d box;
   for (int b : group)
   {
      for (const LineNode &node : bodies[b].line.nodes) { box.extend(node.position); }
   }
   const double size = box.diagonal().norm() > 0 ? box.diagonal().norm() : 1;
   const MatrixXd c = common_coefficients(bodies, group, box.center(), size);
   MatrixXd motions = MatrixXd::Zero(map.size(), c.cols());
   if (c.cols() == 0) { return motions; }
   for (int b : group)
   {
      motions.middleRows(map.offsets[b], static_cast<Index>(map.free[b].size())) =
         (about(bodies[b], box.center(), size) * c)(map.free[b], Eigen::all);
   }
   return thin_qr(motions).Q;
}

/// Free motions of all bodies, one after the other, orthonormal columns in U.
MatrixXd free_motions(const std::vector<CondensedBody> &bodies, const RelativeDisplacement &map)
{
   MatrixXd all = MatrixXd::Zero(map.size(), 0);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const MatrixXd &own = bodies[b].free_motions;
      all.conservativeResizeLike(MatrixXd::Zero(map.size(), all.cols() + own.cols()));
      all.rightCols(own.cols())
         .middleRows(map.offsets[b], static_cast<Index>(map.free[b].size())) =
         own(map.free[b], Eigen::all);
   }
   return all;
}

/// Those that supports leave free, or all if there is none.
std::vector<int> free_bodies(const std::vector<CondensedBody> &bodies)
{
   std::vector<int> free, all;
   for (int b = 0; b < static_cast<int>(bodies.size()); ++b)
   {
      all.push_back(b);
      if (bodies[b].free_motions.cols() > 0) { free.push_back(b); }
   }
   return free.empty() ? all : free;
}

/// Columns of Q without the directions of Y, which they span.
MatrixXd without(const MatrixXd &Q, const MatrixXd &Y)
{
   if (Y.cols() == 0) { return Q; }
   const MatrixXd along = Y.transpose() * Q;
   const SymmetricModes modes = symmetric_modes(along.transpose() * along);
   return Q * modes.vectors.leftCols(Q.cols() - Y.cols());
}

} // namespace

std::string called(const std::vector<CondensedBody> &bodies, int body)
{
   if (body < 0) { return "the rigid obstacle"; }
   const std::string &name = bodies[body].name;
   return name.empty() ? "body " + std::to_string(body) : "body '" + name + "'";
}

std::string called(const std::vector<CondensedBody> &bodies, const std::vector<int> &some)
{
   std::vector<std::string> names;
   for (int b : some) { names.push_back(called(bodies, b)); }
   return listed(names, " and ");
}

Block united(const std::vector<CondensedBody> &bodies, const std::vector<ContactRow> &rows,
             const std::vector<std::vector<int>> &groups, const Reduction::PatternIndex &index,
             const std::vector<LoadPattern> &patterns)
{
   auto shared = std::make_shared<BodiesUnion>(RelativeDisplacement(bodies, rows));
   const RelativeDisplacement &map = shared->map;
   const Index size = map.size(), m = map.relative(), rest = size - m;
   const auto count = static_cast<Index>(patterns.size());
   const auto n = static_cast<Index>(rows.size());

   // S and the loads in {u; y}.
   MatrixXd K = MatrixXd::Zero(size, size);
   Block block;
   block.H = MatrixXd::Zero(count, count);
   std::vector<MatrixXd> forces;
   VectorXd scale = VectorXd::Zero(count);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const CondensedBody &body = bodies[b];
      const auto own = map.E.middleRows(map.offsets[b], static_cast<Index>(map.free[b].size()));
      const RelativeDisplacement::Matrix E = own;
      const MatrixXd S = body.S(map.free[b], map.free[b]);
      const MatrixXd SE = S * E;
      K += E.transpose() * SE;
      shared->sizes.push_back(body.S.rows());
      forces.push_back(clamped_forces(body, index[b], count));
      scale += forces.back().colwise().norm().transpose();
      add_response(body, index[b], block.H);
   }
   K = (0.5 * (K + K.transpose())).eval();
   MatrixXd F = map.stacked(forces);
   MatrixXd Y(size, 0);
   for (const std::vector<int> &group : groups)
   {
      const MatrixXd own = common_motions(bodies, group, map);
      balance(own, F, scale, patterns, called(bodies, group));
      Y.conservativeResize(Eigen::NoChange, Y.cols() + own.cols());
      Y.rightCols(own.cols()) = own;
   }
   const MatrixXd EF = map.E.transpose() * F, EY = map.E.transpose() * Y;
   if (Y.cols() > 0)
   {
      K.noalias() += K.bottomRightCorner(rest, rest).diagonal().mean() * EY * EY.transpose();
   }
   MatrixXd V(rest, m + count);
   V << K.bottomLeftCorner(rest, m), EF.bottomRows(rest);
   // What moves bodies against each other, as contact nodes see it; a motion that none sees is
   // not resisted by what closes them.
   const MatrixXd moving = without(free_motions(bodies, map), Y);
   const ThinQR qr = thin_qr(map.G * moving);
   const Eigen::ArrayXd seen = qr.R.diagonal().array().abs();
   const bool all_seen =
      m >= moving.cols() && (moving.cols() == 0 || seen.minCoeff() > 1e-13 * seen.maxCoeff());
   require(all_seen && shared->minimum.compute(K.bottomRightCorner(rest, rest), V,
                                               EY.topRows(m), EY.bottomRows(rest)),
           "reduce: ", called(bodies, free_bodies(bodies)),
           " can move without resistance even where every contact node is closed and sticks: "
           "more nodes must touch, or a body be supported");
   MatrixXd S = shared->minimum.without(K.topLeftCorner(m, m), 0, m);
   MatrixXd f = EF.topRows(m) - shared->minimum.taken(0, m, m, count);
   const MatrixXd together = shared->minimum.taken(m, count, m, count);
   for (Index k = 0; k < count; ++k)
   {
      const double sign = patterns[k].control == Control::force ? 1.0 : -1.0;
      block.H.row(k) += sign * together.row(k);
   }

   // It meets no resistance and feels its own loads only, to round-off of S.
   const MatrixXd &Q = qr.Q;
   if (moving.cols() > 0)
   {
      const MatrixXd work =
         qr.R.transpose().triangularView<Eigen::Lower>().solve(moving.transpose() * F);
      S -= Q * (Q.transpose() * S);
      S -= (S * Q).eval() * Q.transpose();
      S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
      f += Q * (work - Q.transpose() * f);
   }

   // Rows that do not slide are held.
   const auto spread = [&](const MatrixXd &some)
   {
      MatrixXd all = MatrixXd::Zero(map.components * n, some.cols());
      all(map.sliding, Eigen::all) = some;
      return all;
   };
   block.S = spread(spread(S).transpose().eval()).transpose();
   block.f = spread(f);
   block.motions = spread(Q);
   for (Index i = 0; i < n; ++i)
   {
      if (!rows[i].slides) { block.held.push_back(static_cast<int>(i)); }
   }
   block.way_back = std::move(shared);
   return block;
}

namespace
{

/// A union of which some nodes are tied.
class TiedUnion : public Reduction::Union
{
public:
   std::shared_ptr<const Reduction::Union> all;
   std::vector<int> free;     ///< rows {v; w} of those that are not
   MatrixXd stiffness, loads; ///< forces on the tied ones

   VectorXd own(const std::vector<CondensedBody> &bodies, int b, const VectorXd &relative,
                const VectorXd &multipliers) const override
   {
      VectorXd u = VectorXd::Zero(relative.size() + stiffness.rows());
      u(free) = relative;
      return all->own(bodies, b, u, multipliers);
   }
   VectorXd tied(const VectorXd &relative, const VectorXd &multipliers) const override
   {
      return stiffness * relative + loads * multipliers.head(loads.cols());
   }
};

/// Numbers of all components of nodes, of `all` nodes.
std::vector<int> components_of(const std::vector<int> &nodes, Index all, int components)
{
   std::vector<int> rows;
   for (int c = 0; c < components; ++c)
   {
      for (int node : nodes) { rows.push_back(static_cast<int>(c * all) + node); }
   }
   return rows;
}

} // namespace

Block united(const std::vector<CondensedBody> &bodies, const UnionRows &rows,
             const Reduction::PatternIndex &index, const std::vector<LoadPattern> &patterns)
{
   Block block = united(bodies, rows.rows, rows.groups, index, patterns);
   if (rows.tied.empty()) { return block; }
   const auto all = static_cast<Index>(rows.rows.size());
   const auto components = static_cast<int>(block.S.rows() / all);
   const std::vector<int> free = components_of(rows.free, all, components),
                          tied = components_of(rows.tied, all, components);
   auto way_back = std::make_shared<TiedUnion>();
   way_back->all = block.way_back;
   way_back->free = free;
   way_back->stiffness = block.S(tied, free);
   way_back->loads = block.f(tied, Eigen::all);
   block.way_back = std::move(way_back);
   block.S = block.S(free, free).eval();
   block.f = block.f(free, Eigen::all).eval();
   const MatrixXd motions = at_rest(block.motions, block.motions(tied, Eigen::all));
   block.motions = motions(free, Eigen::all);
   std::vector<int> held;
   for (std::size_t k = 0; k < free.size(); ++k)
   {
      if (std::count(block.held.begin(), block.held.end(), free[k]) > 0)
      {
         held.push_back(static_cast<int>(k));
      }
   }
   block.held = held;
   return block;
}

} // namespace cattaneo
