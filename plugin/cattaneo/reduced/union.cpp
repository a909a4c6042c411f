#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/union.hpp>
#include <cmath>

namespace cattaneo
{

std::vector<int> PairUnion::order(Eigen::Index rows) const
{
   const auto n = static_cast<Eigen::Index>(partner.size());
   std::vector<int> result(rows);
   for (Eigen::Index k = 0; k < rows; ++k)
   {
      result[k] = static_cast<int>(k - k % n) + partner[k % n];
   }
   return result;
}

/// From the order and frames of body 1, in the opposite sense.
Eigen::VectorXd PairUnion::to_second(const Eigen::VectorXd &u) const
{
   Eigen::VectorXd own(u.size());
   own(order(u.size())) = frames.transposed().rows(u);
   return own;
}

Eigen::VectorXd PairUnion::own(const std::vector<CondensedBody> &bodies, int b,
                               const Eigen::VectorXd &relative,
                               const Eigen::VectorXd &multipliers) const
{
   // The forces of pull() and of the loads.
   Eigen::VectorXd moved = relative;
   moved(held2).setZero();
   const Eigen::VectorXd forces = bodies[1].S * to_second(moved);
   Eigen::VectorXd u1 = frames.rows(forces(order(relative.size()))) -
                        of_held * relative(held2) -
                        difference * multipliers.head(difference.cols());
   for (const std::vector<int> *held : {&held1, &held2}) { u1(*held).setZero(); }
   sum.solve(u1);
   u1(held2) = relative(held2);
   return b == 0 ? u1 : to_second(relative - u1);
}

bool holds(const CondensedBody &body, int node, int component)
{
   const auto row = static_cast<int>(node + component * body.line.size());
   return std::binary_search(body.held.begin(), body.held.end(), row);
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

Eigen::MatrixXd clamped_forces(const CondensedBody &body, const std::vector<int> &index,
                               Eigen::Index count)
{
   Eigen::MatrixXd f = Eigen::MatrixXd::Zero(body.S.rows(), count);
   for (std::size_t k = 0; k < index.size(); ++k)
   {
      const LoadPattern &pattern = body.patterns[k];
      f.col(index[k]).head(pattern.q.size()) += pattern.q;
      f.col(index[k]).tail(pattern.p.size()) += pattern.p;
   }
   return f;
}

void add_response(const CondensedBody &body, const std::vector<int> &index, Eigen::MatrixXd &H)
{
   for (std::size_t i = 0; i < index.size(); ++i)
   {
      for (std::size_t j = 0; j < index.size(); ++j) { H(index[i], index[j]) += body.H(i, j); }
   }
}

void balance(const Eigen::MatrixXd &motions, Eigen::MatrixXd &forces,
             const Eigen::VectorXd &scale, const std::vector<LoadPattern> &patterns,
             const std::string &bodies)
{
   const Eigen::MatrixXd push = motions.transpose() * forces;
   for (Eigen::Index k = 0; k < push.cols(); ++k)
   {
      const double load = push.col(k).norm();
      require(load <= 1e-9 * scale[k], "reduce: load pattern '", patterns[k].name, "' pushes ",
              bodies, " in a common rigid motion that nothing resists (part ", load / scale[k],
              " of it), its loads must be in equilibrium or a body be supported");
   }
   forces -= motions * push;
}

namespace
{

/// What two bodies may do, orthonormal columns each.
struct JoinedMotions
{
   Eigen::MatrixXd common; ///< that both may
   Eigen::MatrixXd all;    ///< and that one of them may
};

JoinedMotions joined(const Eigen::MatrixXd &Q1, const Eigen::MatrixXd &Q2)
{
   const Eigen::MatrixXd rest = Q2 - Q1 * (Q1.transpose() * Q2);
   if (rest.cols() == 0) { return {rest, Q1}; }
   // They are the same to round-off of the bodies' coordinates.
   const SymmetricModes modes = symmetric_modes(rest.transpose() * rest);
   const Eigen::Index same = (modes.values.array() < 1e-12).count(), own = Q2.cols() - same;
   Eigen::MatrixXd all(Q1.rows(), Q1.cols() + own);
   all << Q1, rest * modes.vectors.rightCols(own);
   return {Q2 * modes.vectors.leftCols(same), thin_qr(all).Q};
}

/// True if body 2 is the mirror image of body 1 in the contact line, so that tangential and
/// normal displacements do not feel each other: A1 = A2, C1 = C2, B1 = -B2, each entry to
/// 1e-10 of the two nodes' own stiffness, which condensation of two meshes may leave. What is
/// taken from B then is no more than that. Where one of them alone is free to move, along the
/// contact or across it, the other one would be its image if it were as free: what these
/// motions Z meet is taken from its stiffness, S - S Z (Zᵀ S Z)⁻¹ Zᵀ S.
bool mirrored(const Eigen::MatrixXd &S1, const Eigen::MatrixXd &Z1, const Eigen::MatrixXd &S2,
              const Eigen::MatrixXd &Z2, Eigen::Index n)
{
   if (S1.rows() != 2 * n) { return false; }
   const bool first_is_free = Z2.cols() == 0;
   const Eigen::MatrixXd &Z = first_is_free ? Z1 : Z2, &held = first_is_free ? S2 : S1;
   Eigen::MatrixXd back, share; // of Z, in the stiffness of the other body
   if (Z1.cols() != Z2.cols())
   {
      // They go along the contact or across it if what they have along it is a projector.
      const Eigen::MatrixXd along = Z.topRows(n).transpose() * Z.topRows(n);
      if (std::min(Z1.cols(), Z2.cols()) > 0 || (along * along - along).norm() > 1e-10)
      {
         return false;
      }
      back = held * Z;
      DenseCholesky resistance;
      if (!resistance.compute(Z.transpose() * back)) { return false; }
      share = resistance.solved(back.transpose());
   }
   const Eigen::ArrayXd own = S1.diagonal().cwiseSqrt();
   Eigen::ArrayXd sign = Eigen::ArrayXd::Ones(2 * n);
   sign.tail(n) = -1;
   for (Eigen::Index j = 0; j < 2 * n; ++j)
   {
      Eigen::ArrayXd one = S1.col(j), other = S2.col(j);
      if (back.cols() > 0) { (first_is_free ? other : one) -= (back * share.col(j)).array(); }
      if (!((one - sign[j] * sign * other).abs() <= 1e-10 * own[j] * own).all())
      {
         return false;
      }
   }
   return true;
}

/** Components of the relative displacement u = u1 + u2 that body a holds (u_a = 0) are those of
    body b alone. With F the rows that both are free to move in, and body a's displacement on F
    eliminated: K = [S_a + (S_b of what a holds)] - pullᵀ (S1 + S2)_F⁻¹ pull, pull the rows F of
    S_a - S_b (columns that a holds). Either body may be a. Where nothing is held pull is S_a.
    Of S_b no more is asked for than the columns that a holds. */
Eigen::MatrixXd pull(Eigen::MatrixXd Sa, const Eigen::MatrixXd &columns_b,
                     const std::vector<int> &held_a, const std::vector<int> &held_b)
{
   Sa(Eigen::all, held_a) = -columns_b;
   for (int row : held_a) { Sa.row(row).setZero(); }
   for (int row : held_b) { Sa.row(row).setZero(); }
   return Sa;
}
Eigen::MatrixXd with_those_of(const Eigen::MatrixXd &columns_b, Eigen::MatrixXd Sa,
                              const std::vector<int> &held_a)
{
   Sa(held_a, held_a) = columns_b(held_a, Eigen::all);
   return Sa;
}

/// Where body 2 holds components, as rows in body 1's order; there its frame must be that of
/// body 1, which `frames` then has to the last bit.
std::vector<int> held_by_second(const CondensedBody &first, const CondensedBody &second,
                                const std::vector<int> &order, FrameChange &frames)
{
   const Eigen::Index n = first.line.size();
   std::vector<int> rows;
   const auto holds = [&](int row)
   { return std::binary_search(second.held.begin(), second.held.end(), order[row]); };
   for (int row = 0; row < static_cast<int>(order.size()); ++row)
   {
      if (!holds(row)) { continue; }
      rows.push_back(row);
      const Eigen::Index i = row % n;
      const auto other = static_cast<int>(row < n ? row + n : i);
      if (frames.b.size() == 0 || holds(other)) { continue; }
      require(std::abs(frames.b[i]) <= 1e-12, "reduce: body 2 is fixed at the contact node ",
              first.line.nodes[i].position,
              " in a direction that is not one of body 1's frame there (off by ",
              std::abs(frames.b[i]), "), it must be body 1, or body 1 be fixed there too");
      frames.a[i] = frames.d[i] = 1;
      frames.b[i] = frames.c[i] = 0;
   }
   return rows;
}

} // namespace

Block alone(const CondensedBody &body, const std::vector<int> &index, Eigen::Index count)
{
   Block block{body.S,
               clamped_forces(body, index, count),
               Eigen::MatrixXd::Zero(count, count),
               body.free_motions,
               body.held,
               nullptr};
   add_response(body, index, block.H);
   return block;
}

void take(Block block, ReducedProblem &problem)
{
   const Eigen::Index n = block.S.rows() / 2;
   problem.gap = problem.friction = Eigen::VectorXd::Zero(n);
   problem.K = std::move(block.S);
   problem.H = block.H;
   problem.rigid_motions = block.motions;
   for (int row : block.held)
   {
      problem.K(row, row) = problem.K(n + row, n + row); // any stiffness would do
      problem.held.push_back(row);
   }
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const auto column = static_cast<Eigen::Index>(k);
      problem.patterns[k].q = block.f.col(column).head(n);
      problem.patterns[k].p = block.f.col(column).tail(n);
   }
   join_coupling(problem);
}

Block united(const CondensedBody &first, const CondensedBody &second,
             const std::vector<int> &partner, const Reduction::PatternIndex &index,
             const std::vector<LoadPattern> &patterns)
{
   const Eigen::Index n = first.line.size(), size = first.S.rows();
   const auto count = static_cast<Eigen::Index>(patterns.size());
   // Body 2 in body 1's order, and in frames exactly opposite to body 1's.
   auto shared = std::make_shared<PairUnion>();
   shared->partner = partner;
   FrameChange &frames = shared->frames;
   frames.a.resize(n);
   if (size == n) { frames.a.setConstant(-1.0); }
   else { frames = {frames.a, frames.a, frames.a, frames.a}; }
   for (Eigen::Index i = 0; i < n && size == 2 * n; ++i)
   {
      const LineNode &node = first.line.nodes[i], &other = second.line.nodes[partner[i]];
      frames.a[i] = -node.tangent.dot(other.tangent);
      frames.b[i] = -node.tangent.dot(other.normal());
      frames.c[i] = -node.normal().dot(other.tangent);
      frames.d[i] = -node.normal().dot(other.normal());
      require(frames.d[i] > 0, "reduce: the bodies do not face each other at the contact node ",
              node.position);
   }
   const std::vector<int> order = shared->order(size), &held1 = shared->held1 = first.held;
   const std::vector<int> &held2 = shared->held2 = held_by_second(first, second, order, frames);
   // Made where it is needed, not kept: of so large matrices there should be few at a time.
   const auto second_stiffness = [&] { return frames.both(second.S(order, order)); };
   const Eigen::MatrixXd forces = clamped_forces(second, index[1], count);
   const Eigen::MatrixXd f2 = frames.rows(forces(order, Eigen::all));

   const Eigen::MatrixXd &S1 = first.S;
   const Eigen::MatrixXd f1 = clamped_forces(first, index[0], count);
   shared->difference = f1 - f2;
   shared->of_held = S1(Eigen::all, held2);
   Eigen::MatrixXd sum = second_stiffness();
   const Eigen::MatrixXd of_held1 = sum(Eigen::all, held1); // columns of S2
   const Eigen::MatrixXd motions2 = frames.rows(second.free_motions(order, Eigen::all));
   const bool images = mirrored(S1, first.free_motions, sum, motions2, n),
              softer1 = S1.trace() <= sum.trace();
   sum += S1;
   const double own = sum.diagonal().mean();
   for (const std::vector<int> *held : {&held1, &held2})
   {
      for (int row : *held)
      {
         sum.row(row).setZero();
         sum.col(row).setZero();
         sum(row, row) = own;
         shared->difference.row(row).setZero();
      }
   }
   const JoinedMotions motions = joined(first.free_motions, motions2);
   if (const Eigen::MatrixXd &Z = motions.common; Z.cols() > 0)
   {
      const Eigen::VectorXd scale = (f1.colwise().norm() + f2.colwise().norm()).transpose();
      balance(Z, shared->difference, scale, patterns,
              first.name.empty() ? "both bodies"
                                 : "body '" + first.name + "' and body '" + second.name + "'");
      sum.selfadjointView<Eigen::Lower>().rankUpdate(Z, sum.diagonal().mean());
   }
   require(shared->sum.compute(std::move(sum)),
           "reduce: the sum of the two condensed stiffnesses is not positive definite: the "
           "bodies can move together without resistance");

   // With S1 + S2 = L Lᵀ and Y = L⁻¹ S1: S = S1 - YᵀY, and the same for the loads; or with the
   // bodies exchanged. From the softer one less is taken away, so that few digits are lost; but
   // a free one's rigid motions stay without forces only if one begins with it.
   const Eigen::Index free1 = first.free_motions.cols(), free2 = second.free_motions.cols();
   const bool by_first = free1 != free2 ? free1 > free2 : softer1;
   Eigen::MatrixXd Y = by_first ? pull(S1, of_held1, held1, held2)
                                : pull(second_stiffness(), shared->of_held, held2, held1),
                   D = shared->difference;
   Eigen::MatrixXd f = by_first ? f1 : f2;
   for (int row : by_first ? held1 : held2) { f.row(row) = (by_first ? f2 : f1).row(row); }
   shared->sum.solve_half(Y);
   shared->sum.solve_half(D);
   Block block{minus_square(by_first
                               ? with_those_of(of_held1, S1, held1)
                               : with_those_of(shared->of_held, second_stiffness(), held2),
                            Y),
               f + (by_first ? -1.0 : 1.0) * Y.transpose() * D,
               Eigen::MatrixXd::Zero(count, count),
               {},
               {},
               nullptr};
   std::set_intersection(held1.begin(), held1.end(), held2.begin(), held2.end(),
                         std::back_inserter(block.held));
   // What moves freely relative to the other must do so to round-off of S, not of the stiffer,
   // and feels its own loads only.
   const auto release = [&](const Eigen::MatrixXd &Q, const Eigen::MatrixXd &loads)
   {
      if (Q.cols() == 0) { return; }
      remove_motions(block.S, Q);
      block.f -= Q * (Q.transpose() * (block.f - loads));
   };
   release(first.free_motions, f1);
   release(motions2, f2);
   block.motions = motions.all;
   for (int row : block.held) // not even round-off of the free motions
   {
      block.S.row(row).setZero();
      block.S.col(row).setZero();
      block.f.row(row).setZero();
      block.motions.row(row).setZero();
   }
   if (images)
   {
      block.S.bottomLeftCorner(n, n).setZero();
      block.S.topRightCorner(n, n).setZero();
   }
   add_response(first, index[0], block.H);
   add_response(second, index[1], block.H);
   // The contact nodes are clamped to each other now, and move together where the loads push
   // them: more displacement of the forces, less reaction of the prescribed displacements.
   const Eigen::MatrixXd together = D.transpose() * D;
   for (Eigen::Index k = 0; k < count; ++k)
   {
      const double sign = patterns[k].control == Control::force ? 1.0 : -1.0;
      block.H.row(k) += sign * together.row(k);
   }
   block.way_back = std::move(shared);
   return block;
}

} // namespace cattaneo
