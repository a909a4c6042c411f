#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/condense/condensation.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/union.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// The bodies' stiffness EᵀSE in {u; y}, lower triangles.
struct Stiffness
{
   MatrixXd uu;
   MatrixXd yu; ///< with `more` additional columns for loads
   MatrixXd yy;
};

/// One column at a time: S times the bodies' displacements of this coordinate, and its product
/// with all later coordinates. Only these blocks are in memory at once.
Stiffness stiffness(const std::vector<CondensedBody> &bodies, const RelativeDisplacement &map,
                    Index more)
{
   const Index m = map.relative(), size = map.size(), rest = size - m;
   Stiffness K{MatrixXd::Zero(m, m), MatrixXd::Zero(rest, m + more),
               MatrixXd::Zero(rest, rest)};
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      const MatrixXd &S = bodies[b].S;
      const std::vector<int> &free = map.free[b];
      const auto rows = static_cast<Index>(free.size());
      // One row of Et for each coordinate; its entries stand one after the other in memory.
      const RelativeDisplacement::Matrix Et =
         RelativeDisplacement::Matrix(map.E.middleRows(map.offsets[b], rows)).transpose();
      const int *begin = Et.outerIndexPtr(), *row = Et.innerIndexPtr();
      const double *share = Et.valuePtr();
      // If nodes match, each coordinate has one entry at most.
      bool single = true;
      std::vector<int> only_row(size, 0);
      VectorXd only_share = VectorXd::Zero(size), column(rows);
      for (Index c = 0; c < size; ++c)
      {
         single = single && begin[c + 1] - begin[c] <= 1;
         if (begin[c] == begin[c + 1]) { continue; }
         only_row[c] = row[begin[c]];
         only_share[c] = share[begin[c]];
      }
      const auto add_felt = [&](Index first, Index last, double *to)
      {
         for (Index d = first; d < last && single; ++d, ++to)
         {
            *to += only_share[d] * column[only_row[d]];
         }
         for (Index d = first; d < last && !single; ++d, ++to)
         {
            for (int e = begin[d]; e < begin[d + 1]; ++e) { *to += share[e] * column[row[e]]; }
         }
      };
      for (Index c = 0; c < size; ++c)
      {
         if (begin[c] == begin[c + 1]) { continue; }
         column.setZero();
         for (int e = begin[c]; e < begin[c + 1]; ++e)
         {
            const double *of = S.col(free[row[e]]).data();
            for (Index r = 0; r < rows; ++r) { column[r] += share[e] * of[free[r]]; }
         }
         const Index y = std::max(c, m);
         if (c < m) { add_felt(c, m, &K.uu(c, c)); }
         if (y < size) { add_felt(y, size, c < m ? &K.yu(0, c) : &K.yy(y - m, c - m)); }
      }
   }
   return K;
}

/** The energies' minimum over y, ½ {u; y}ᵀ EᵀSE {u; y} + ℓᵀFᵀE {u; y}, where a common rigid
    motion Y of the bodies is at rest in the mean, Yᵀ E {u; y} = 0. With z = {u; ℓ} and V the
    forces on y of z, y = -K⁻¹(V z + Bᵀ μ): a Cholesky factor of K (with springs on Y, which
    nothing else resists), and borders B for the constraint. */
class Minimum
{
public:
   /// V becomes L⁻¹ V. False if there is another free motion.
   bool compute(MatrixXd K, MatrixXd &V, const MatrixXd &motions_u, const MatrixXd &motions_y)
   {
      if (!factor_.compute(std::move(K))) { return false; }
      factor_.solve_half(V);
      borders_ = motions_y;
      if (borders_.cols() == 0) { return true; }
      MatrixXd B = borders_;
      factor_.solve_half(B);
      stays_ = -transposed_product(B, V);
      stays_.leftCols(motions_u.rows()) += motions_u.transpose();
      if (!border_.compute(transposed_product(B, B))) { return false; }
      resisted_ = stays_;
      border_.solve_half(resisted_);
      return true;
   }
   /// The constraint adds the square of this matrix times z to the energy of z. Empty without a
   /// constraint.
   const MatrixXd &constraint() const { return resisted_; }
   /// y under the forces V z.
   VectorXd at(VectorXd Vz, const VectorXd &z) const
   {
      if (borders_.cols() > 0)
      {
         VectorXd multiplier = stays_ * z;
         border_.solve(multiplier);
         Vz += borders_ * multiplier;
      }
      factor_.solve(Vz);
      return -Vz;
   }

private:
   DenseCholesky factor_, border_;
   MatrixXd borders_, stays_, resisted_;
};

class BodiesUnion : public Reduction::Union
{
public:
   RelativeDisplacement map;
   Minimum minimum;
   MatrixXd loads;   ///< forces on y of each pattern
   MatrixXd motions; ///< common motions of bodies, as forces on {u; y}
   double springs = 0;
   std::vector<int> free;     ///< rows {v; w} of all contact nodes of those that are not tied
   MatrixXd of_tied, on_tied; ///< forces on the tied ones, by displacements and by loads
   /// Displacements of contact nodes by unit loads, as {v; w} of the rows that slide. Empty: no
   /// load moves any.
   MatrixXd moved;

   explicit BodiesUnion(RelativeDisplacement relative) : map(std::move(relative)) {}

   VectorXd own(const std::vector<CondensedBody> &bodies, int b, const VectorXd &relative,
                const VectorXd &multipliers) const override
   {
      const Index m = map.relative(), rest = map.size() - m;
      VectorXd coordinates = VectorXd::Zero(map.size());
      for (std::size_t i = 0; i < free.size(); ++i)
      {
         if (const int place = map.place[free[i]]; place >= 0)
         {
            coordinates[place] = relative[static_cast<Index>(i)];
         }
      }
      // The free components contribute the rest.
      if (moved.size() > 0) { coordinates.head(m) -= moved * multipliers.head(moved.cols()); }
      if (rest > 0)
      {
         // Motions of an obstacle, which come later, do not load the bodies.
         VectorXd z(m + loads.cols());
         z << coordinates.head(m), multipliers.head(loads.cols());
         coordinates.tail(rest) = minimum.at(
            forces(bodies, coordinates).tail(rest) + loads * z.tail(loads.cols()), z);
      }
      return map.of_body(b, map.E * coordinates, bodies[b].S.rows());
   }
   VectorXd tied(const VectorXd &relative, const VectorXd &multipliers) const override
   {
      if (of_tied.rows() == 0) { return {}; }
      return of_tied * relative + on_tied * multipliers.head(on_tied.cols());
   }

private:
   /// EᵀSE {u; y}, with the springs.
   VectorXd forces(const std::vector<CondensedBody> &bodies, const VectorXd &coordinates) const
   {
      const VectorXd U = map.E * coordinates;
      std::vector<MatrixXd> of_bodies;
      for (std::size_t k = 0; k < bodies.size(); ++k)
      {
         const MatrixXd &S = bodies[k].S;
         of_bodies.push_back(S * map.of_body(static_cast<int>(k), U, S.rows()));
      }
      VectorXd f = map.E.transpose() * map.stacked(of_bodies).col(0);
      if (springs > 0) { f += springs * (motions * (motions.transpose() * coordinates)); }
      return f;
   }
};

/// InputError if a load pattern does work on common motions of bodies; else the rounding of
/// that work is taken from the forces. `motions`: orthonormal columns; `forces`: a column a
/// pattern; `scale`: their size.
void balance(const MatrixXd &motions, MatrixXd &forces, const VectorXd &scale,
             const std::vector<LoadPattern> &patterns, const std::string &bodies)
{
   if (motions.cols() == 0) { return; }
   const MatrixXd push = transposed_product(motions, forces);
   for (Index k = 0; k < push.cols(); ++k)
   {
      const double load = push.col(k).norm();
      require(load <= 1e-9 * scale[k], "reduce: load pattern '", patterns[k].name, "' pushes ",
              bodies,
              " in a common rigid motion that nothing resists: support one of them "
              "against this motion, or let the forces of the load balance each other");
   }
   add_product(forces, motions, push, -1);
}

/// Motions that supports leave free, or all motions if there are no supports.
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

/// Rows of these nodes in {v; w} of `all` nodes.
std::vector<int> components_of(const std::vector<int> &nodes, Index all, int components)
{
   std::vector<int> rows;
   for (int c = 0; c < components; ++c)
   {
      for (int node : nodes) { rows.push_back(static_cast<int>(c * all) + node); }
   }
   return rows;
}

std::vector<int> at(const std::vector<int> &numbers, const std::vector<int> &of)
{
   std::vector<int> found;
   for (int k : of) { found.push_back(numbers[k]); }
   return found;
}

/// Relative displacements {v; w} that contact nodes have where loads move held components of
/// them, a column per pattern; empty: no load does.
MatrixXd moved_contacts(const std::vector<CondensedBody> &bodies, const UnionRows &rows,
                        const Reduction::PatternIndex &index, Index count)
{
   MatrixXd moved;
   const auto n = static_cast<Index>(rows.rows.size());
   const int components = cattaneo::components(bodies[0].line.formulation);
   for (Index i = 0; i < n; ++i)
   {
      const ContactRow &row = rows.rows[i];
      const SmallMatrix frame = row.frame(components);
      for (const TraceShare &share : row.shares)
      {
         const CondensedBody &body = bodies[share.of.first];
         const double part[] = {share.x, share.y, share.z};
         for (Index k = 0; k < body.moved.cols(); ++k)
         {
            VectorXd by(components);
            for (int c = 0; c < components; ++c)
            {
               by[c] = part[c] * body.moved(share.of.second + c * body.nodes(), k);
            }
            if (by.isZero(0)) { continue; }
            if (moved.size() == 0) { moved = MatrixXd::Zero(components * n, count); }
            const VectorXd along = frame * by;
            for (int c = 0; c < components; ++c)
            {
               moved(c * n + i, index[share.of.first][k]) += along[c];
            }
         }
      }
   }
   return moved;
}

/// The response of a body to the loads on it.
void add_response(const CondensedBody &body, const std::vector<int> &index, MatrixXd &H)
{
   for (std::size_t i = 0; i < index.size(); ++i)
   {
      for (std::size_t j = 0; j < index.size(); ++j) { H(index[i], index[j]) += body.H(i, j); }
   }
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

Reduction::PatternIndex join(const std::vector<CondensedBody> &bodies,
                             std::vector<LoadPattern> &all)
{
   Reduction::PatternIndex index;
   for (const CondensedBody &body : bodies)
   {
      index.emplace_back();
      for (const LoadPattern &pattern : body.patterns)
      {
         std::size_t k = 0;
         while (k < all.size() && all[k].name != pattern.name) { ++k; }
         if (k == all.size()) { all.push_back({pattern.name, pattern.control, {}, {}}); }
         require(all[k].control == pattern.control, "reduce: load pattern '", pattern.name,
                 "' is controlled by force in one body and by displacement in the other, must "
                 "be the same in both");
         index.back().push_back(static_cast<int>(k));
      }
   }
   return index;
}

MatrixXd clamped_forces(const CondensedBody &body, const std::vector<int> &index, Index count)
{
   MatrixXd f = MatrixXd::Zero(body.S.rows(), count);
   for (std::size_t k = 0; k < index.size(); ++k)
   {
      const LoadPattern &pattern = body.patterns[k];
      f.col(index[k]).head(pattern.q.size()) += pattern.q;
      f.col(index[k]).tail(pattern.p.size()) += pattern.p;
   }
   return f;
}

Block united(const std::vector<CondensedBody> &bodies, const UnionRows &rows,
             const Reduction::PatternIndex &index, const std::vector<LoadPattern> &patterns)
{
   auto shared = std::make_shared<BodiesUnion>(RelativeDisplacement(bodies, rows.rows));
   const RelativeDisplacement &map = shared->map;
   const Index m = map.relative(), rest = map.size() - m;
   const auto count = static_cast<Index>(patterns.size());
   Block block;

   // Loads on all bodies, and the response of each body to its loads.
   block.H = MatrixXd::Zero(count, count);
   std::vector<MatrixXd> forces;
   VectorXd scale = VectorXd::Zero(count);
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      forces.push_back(clamped_forces(bodies[b], index[b], count));
      scale += forces.back().colwise().norm().transpose();
      add_response(bodies[b], index[b], block.H);
   }
   MatrixXd F = map.stacked(forces);

   // Motions that bodies which touch have in common.
   MatrixXd Y(map.size(), 0);
   for (const std::vector<int> &group : rows.groups)
   {
      const MatrixXd own = common_motions(bodies, group, map);
      balance(own, F, scale, patterns, called(bodies, group));
      Y.conservativeResize(Eigen::NoChange, Y.cols() + own.cols());
      Y.rightCols(own.cols()) = own;
   }
   const MatrixXd EF = map.E.transpose() * F;
   shared->motions = map.E.transpose() * Y;
   shared->loads = EF.bottomRows(rest);

   // Stiffness and loads in {u; y}.
   Stiffness K = stiffness(bodies, map, count);
   const MatrixXd Yu = shared->motions.topRows(m), Yy = shared->motions.bottomRows(rest);
   if (Y.cols() > 0)
   {
      shared->springs = K.yy.diagonal().mean();
      add_square(K.uu, Yu, shared->springs);
      add_square(K.yy, Yy, shared->springs);
      add_product(K.yu.leftCols(m), Yy, Yu.transpose(), shared->springs);
   }
   K.yu.rightCols(count) = shared->loads;

   // Motions of bodies relative to each other, in the contact nodes. A motion that moves no
   // contact node is not resisted by the contact.
   const MatrixXd moving = motions_apart(bodies, map, Y);
   const ThinQR qr = thin_qr(map.G * moving);
   const Eigen::ArrayXd seen = qr.R.diagonal().array().abs();
   const bool all_seen =
      m >= moving.cols() && (moving.cols() == 0 || seen.minCoeff() > 1e-13 * seen.maxCoeff());
   require(all_seen && shared->minimum.compute(std::move(K.yy), K.yu, Yu, Yy),
           "reduce: ", called(bodies, free_bodies(bodies)),
           " can move without resistance even if every contact node is closed and sticks: "
           "give the contact more nodes, or support a body");

   // With K = L Lᵀ and W = L⁻¹ V the minimum takes WᵀW from the energy of {u; ℓ}.
   const auto of_u = K.yu.leftCols(m), of_loads = K.yu.rightCols(count);
   MatrixXd S = minus_square(std::move(K.uu), of_u), f = EF.topRows(m),
            together = transposed_product(of_loads, of_loads);
   subtract_product(f, of_u, of_loads);
   if (const MatrixXd &C = shared->minimum.constraint(); C.size() > 0)
   {
      add_square(S, C.leftCols(m).transpose());
      mirror_lower(S);
      add_product(f, C.leftCols(m).transpose(), C.rightCols(count));
      add_product(together, C.rightCols(count).transpose(), C.rightCols(count), -1);
   }
   for (Index k = 0; k < count; ++k)
   {
      const double sign = patterns[k].control == Control::force ? 1.0 : -1.0;
      block.H.row(k) += sign * together.row(k);
   }

   // Rigid motions of the bodies meet no resistance, and their loads do the work F on them.
   // Both are set exactly in S and f, which have them only to round-off.
   const MatrixXd &Q = qr.Q;
   if (moving.cols() > 0 && rest > 0)
   {
      const MatrixXd work = solve_square(qr.R.transpose(), transposed_product(moving, F));
      remove_motions(S, Q);
      add_product(f, Q, work - transposed_product(Q, f));
   }

   // If loads move contact nodes by g, the free components are u - ℓ g.
   const MatrixXd moved = moved_contacts(bodies, rows, index, count);
   if (moved.size() > 0)
   {
      const MatrixXd g = shared->moved = rows_of(moved, map.sliding);
      std::vector<Control> controls;
      for (const LoadPattern &pattern : patterns) { controls.push_back(pattern.control); }
      shift_contact(g, S, controls, f, block.H);
   }

   // Rows that do not slide are held, and those of tied nodes are left out.
   const auto all = static_cast<Index>(rows.rows.size());
   shared->free = components_of(rows.free, all, map.components);
   const std::vector<int> free = at(map.place, shared->free),
                          tied = at(map.place, components_of(rows.tied, all, map.components));
   for (std::size_t k = 0; k < free.size(); ++k)
   {
      if (free[k] >= 0) { continue; }
      block.held.push_back(static_cast<int>(k));
      for (Index load = 0; load < moved.cols(); ++load)
      {
         const double by = std::abs(moved(shared->free[k], load));
         // Larger than the round-off of two sides that are moved together.
         if (by > 1e-12 * moved.col(load).cwiseAbs().maxCoeff())
         {
            block.moved.push_back({static_cast<Index>(k), static_cast<int>(load)});
         }
      }
   }
   block.motions = rows_of(tied.empty() ? Q : at_rest(Q, rows_of(Q, tied)), free);
   block.f = rows_of(f, free);
   shared->of_tied = block_of(S, tied, free);
   shared->on_tied = rows_of(f, tied);
   const bool as_it_is = tied.empty() && block.held.empty();
   block.S = as_it_is ? std::move(S) : block_of(S, free, free);
   block.way_back = std::move(shared);
   return block;
}

void take(Block block, int components, ReducedProblem &problem)
{
   const Index n = block.S.rows() / components, m = block.S.rows() - n;
   problem.gap = problem.friction = Eigen::VectorXd::Zero(n);
   problem.K = std::move(block.S);
   problem.H = block.H;
   problem.rigid_motions = block.motions;
   for (int row : block.held)
   {
      problem.K(row, row) = problem.K(m + row % n, m + row % n); // any stiffness is possible
      problem.held.push_back(row);
   }
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const auto column = static_cast<Index>(k);
      problem.patterns[k].q = block.f.col(column).head(m);
      problem.patterns[k].p = block.f.col(column).tail(n);
   }
   // Two bodies that are mirror images have no coupling of tangential and normal displacements.
   // Rounding and two meshes leave a small one, which is set to zero.
   const Eigen::ArrayXd own = problem.K.diagonal().cwiseSqrt();
   const auto none = [&](Index j)
   { return (problem.K.col(j).tail(n).array().abs() <= 1e-10 * own[j] * own.tail(n)).all(); };
   Index j = 0;
   while (j < m && none(j)) { ++j; }
   if (j == m) { problem.K.bottomLeftCorner(n, m).setZero(); }
   join_coupling(problem);
}

} // namespace cattaneo
