#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>

namespace cattaneo
{

struct Reduction::Union
{
   DenseCholesky sum;    ///< of S1 + S2 (+ springs on common rigid motions) where both are free
   Eigen::MatrixXd pull; ///< S2 in the order of body 1 and the opposite frames, see pull()
   Eigen::MatrixXd difference; ///< f1 - f2 of each pattern
   std::vector<int> held2;     ///< rows that body 2 holds: body 1 alone moves there
   std::vector<int> partner;
   FrameChange frames; ///< from body 2's own frames (in the order of body 1)

   /// Where body 2 has the rows of body 1's order.
   std::vector<int> order(Eigen::Index rows) const
   {
      const auto n = static_cast<Eigen::Index>(partner.size());
      std::vector<int> result(rows);
      for (Eigen::Index k = 0; k < rows; ++k)
      {
         result[k] = static_cast<int>(k - k % n) + partner[k % n];
      }
      return result;
   }

   /// Displacements of body `b` in its own order and frames.
   Eigen::VectorXd own(int b, const Eigen::VectorXd &relative,
                       const Eigen::VectorXd &multipliers) const
   {
      Eigen::VectorXd u1 = pull * relative - difference * multipliers.head(difference.cols());
      sum.solve(u1);
      u1(held2) = relative(held2);
      if (b == 0) { return u1; }
      Eigen::VectorXd u2(u1.size());
      u2(order(u1.size())) = frames.transposed().rows(relative - u1);
      return u2;
   }
};

namespace
{

/// Numbers of the bodies' patterns among all, which grow by those that are new.
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

/// Forces {q; p} of a body's patterns as columns, in the order of the joined patterns.
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

/// One or two bodies on relative displacements: f = S u + Σ λ_k f_k.
struct Block
{
   Eigen::MatrixXd S, f, H;
   Eigen::MatrixXd motions;                          ///< that nothing resists, orthonormal
   std::vector<int> held;                            ///< rows that no body moves
   std::shared_ptr<const Reduction::Union> way_back; ///< of two bodies
};

void fill(ReducedProblem &problem, const Block &block, const ContactLine &line)
{
   const Eigen::MatrixXd &S = block.S, &f = block.f;
   const Eigen::Index n = line.size();
   problem.gap = Eigen::VectorXd::Zero(n);
   problem.K = S;
   join_coupling(problem);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const auto column = static_cast<Eigen::Index>(k);
      problem.patterns[k].q = f.col(column).head(n);
      problem.patterns[k].p = f.col(column).tail(n);
   }
   problem.H = block.H;
   problem.friction = Eigen::VectorXd::Zero(n);
   problem.weights = line.each(&LineNode::weight);
   problem.arc_length = line.each(&LineNode::arc_length);
   problem.position = line.each(&LineNode::position);
   problem.rigid_motions = block.motions;
   for (int row : block.held)
   {
      require(row < n, "reduce: the contact node at (", problem.position(row % n, 0), ", ",
              problem.position(row % n, 1),
              ") is fixed normal to the line, it must be able to open: the contact line must "
              "end before it");
      problem.K(row, row) = problem.K(n + row, n + row); // any stiffness would do
      problem.held.push_back(row);
   }
   // A rigid obstacle is known where the line is, and taken to go on.
   for (const LineChain &chain : line.chains)
   {
      problem.chains.push_back({"contact",
                                chain.first,
                                chain.nodes,
                                chain.loop,
                                chain.ends,
                                {LineEnd::smooth, LineEnd::smooth}});
   }
}

/// How the boundary goes on at a node of a line: within the line it does so smoothly.
LineEnd goes_on_at(const ContactLine &line, Eigen::Index node)
{
   const LineChain &chain = line.chain_of(node);
   if (chain.loop) { return LineEnd::smooth; }
   // The lines of two bodies run against each other: body 1's first node is body 2's last. A
   // chain of one node has two ends there: the one that does not go on decides.
   const bool first = node == chain.first, last = node == chain.first + chain.nodes - 1;
   if (first && last)
   {
      return chain.ends[0] == LineEnd::smooth ? chain.ends[1] : chain.ends[0];
   }
   return first ? chain.ends[0] : last ? chain.ends[1] : LineEnd::smooth;
}

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
/// taken from B then is no more than that.
bool mirrored(const Eigen::MatrixXd &S1, const Eigen::MatrixXd &S2, Eigen::Index n)
{
   if (S1.rows() != 2 * n) { return false; }
   const Eigen::ArrayXd own = S1.diagonal().cwiseSqrt();
   Eigen::ArrayXd sign = Eigen::ArrayXd::Ones(2 * n);
   sign.tail(n) = -1;
   for (Eigen::Index j = 0; j < 2 * n; ++j)
   {
      const Eigen::ArrayXd off = S1.col(j).array() - sign[j] * sign * S2.col(j).array();
      if (!(off.abs() <= 1e-10 * own[j] * own).all()) { return false; }
   }
   return true;
}

/** Components of the relative displacement u = u1 + u2 that body a holds (u_a = 0) are those of
    body b alone. With F the rows that both are free to move in, and body a's displacement on F
    eliminated: K = [S_a + (S_b of what a holds)] - pullᵀ (S1 + S2)_F⁻¹ pull, pull the rows F of
    S_a - S_b (columns that a holds). Either body may be a. Where nothing is held pull is S_a.
 */
Eigen::MatrixXd pull(const Eigen::MatrixXd &Sa, const Eigen::MatrixXd &Sb,
                     const std::vector<int> &held_a, const std::vector<int> &held_b)
{
   Eigen::MatrixXd result = Sa;
   for (int row : held_a) { result.col(row) = -Sb.col(row); }
   for (int row : held_a) { result.row(row).setZero(); }
   for (int row : held_b) { result.row(row).setZero(); }
   return result;
}
Eigen::MatrixXd with_those_of(const Eigen::MatrixXd &Sb, Eigen::MatrixXd Sa,
                              const std::vector<int> &held_a)
{
   for (int row : held_a)
   {
      for (int column : held_a) { Sa(row, column) = Sb(row, column); }
   }
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
      require(std::abs(frames.b[i]) <= 1e-12, "reduce: body 2 is fixed at the contact node (",
              first.line.nodes[i].position[0], ", ", first.line.nodes[i].position[1],
              ") in a direction that is not one of body 1's frame there (off by ",
              std::abs(frames.b[i]), "), it must be body 1, or body 1 be fixed there too");
      frames.a[i] = frames.d[i] = 1;
      frames.b[i] = frames.c[i] = 0;
   }
   return rows;
}

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

Block united(const CondensedBody &first, const CondensedBody &second,
             const std::vector<int> &partner, const Reduction::PatternIndex &index,
             const std::vector<LoadPattern> &patterns)
{
   const Eigen::Index n = first.line.size(), size = first.S.rows();
   const auto count = static_cast<Eigen::Index>(patterns.size());
   // Body 2 in body 1's order, and in frames exactly opposite to body 1's.
   auto shared = std::make_shared<Reduction::Union>();
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
      require(frames.d[i] > 0,
              "reduce: the bodies do not face each other at the contact node (",
              node.position[0], ", ", node.position[1], ")");
   }
   const std::vector<int> order = shared->order(size), &held1 = first.held;
   const std::vector<int> &held2 = shared->held2 = held_by_second(first, second, order, frames);
   const Eigen::MatrixXd S2 = frames.both(second.S(order, order));
   const Eigen::MatrixXd forces = clamped_forces(second, index[1], count);
   const Eigen::MatrixXd f2 = frames.rows(forces(order, Eigen::all));

   const Eigen::MatrixXd &S1 = first.S;
   const Eigen::MatrixXd f1 = clamped_forces(first, index[0], count);
   shared->difference = f1 - f2;
   Eigen::MatrixXd sum = S1 + S2;
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
   const Eigen::MatrixXd motions2 = frames.rows(second.free_motions(order, Eigen::all));
   const JoinedMotions motions = joined(first.free_motions, motions2);
   if (const Eigen::MatrixXd &Z = motions.common; Z.cols() > 0)
   {
      const Eigen::MatrixXd push = Z.transpose() * shared->difference;
      for (Eigen::Index k = 0; k < push.cols(); ++k)
      {
         const double load = push.col(k).norm();
         const double scale = f1.col(k).norm() + f2.col(k).norm();
         require(load <= 1e-9 * scale, "reduce: load pattern '", patterns[k].name,
                 "' pushes both bodies in a common rigid motion that nothing resists (part ",
                 load / scale,
                 " of it), its loads must be in equilibrium or a body be supported");
      }
      shared->difference -= Z * push;
      sum.noalias() += sum.diagonal().mean() * Z * Z.transpose();
   }
   require(shared->sum.compute(std::move(sum)),
           "reduce: the sum of the two condensed stiffnesses is not positive definite: the "
           "bodies can move together without resistance");

   // With S1 + S2 = L Lᵀ and Y = L⁻¹ S1: S = S1 - YᵀY, and the same for the loads; or with the
   // bodies exchanged. From the softer one less is taken away, so that few digits are lost; but
   // a free one's rigid motions stay without forces only if one begins with it.
   const Eigen::Index free1 = first.free_motions.cols(), free2 = second.free_motions.cols();
   const bool by_first = free1 != free2 ? free1 > free2 : S1.trace() <= S2.trace();
   shared->pull = pull(S2, S1, held2, held1);
   Eigen::MatrixXd Y = by_first ? pull(S1, S2, held1, held2) : shared->pull,
                   D = shared->difference;
   Eigen::MatrixXd f = by_first ? f1 : f2;
   for (int row : by_first ? held1 : held2) { f.row(row) = (by_first ? f2 : f1).row(row); }
   shared->sum.solve_half(Y);
   shared->sum.solve_half(D);
   Block block{
      minus_square(by_first ? with_those_of(S2, S1, held1) : with_those_of(S1, S2, held2), Y),
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
      block.S -= Q * (Q.transpose() * block.S);
      block.S -= (block.S * Q) * Q.transpose();
      block.S.triangularView<Eigen::StrictlyUpper>() = block.S.transpose();
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
   if (mirrored(S1, S2, n))
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

} // namespace

Reduction reduce(CondensedBody body, const ScalarField &gap)
{
   Reduction result;
   require(body.line.formulation != Formulation::torsion,
           "reduce: the body is one of torsion, which is to be added to a reduction");
   result.counters = body.counters;
   result.bodies.push_back(std::move(body));
   const CondensedBody &only = result.bodies.front();
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   const auto count = static_cast<Eigen::Index>(problem.patterns.size());
   fill(problem, alone(only, result.pattern_[0], count), only.line);
   const Eigen::Index n = only.line.size();
   problem.gap.resize(n);
   problem.dofs.resize(n, 2);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double x = problem.position(i, 0), y = problem.position(i, 1);
      const auto &dofs = only.line.nodes[i].dofs;
      problem.gap[i] = gap(x, y);
      require(std::isfinite(problem.gap[i]), "reduce: the gap at (", x, ", ", y, ") is ",
              problem.gap[i], ", must be finite");
      problem.dofs.row(i) << dofs[0], dofs[1];
   }
   return result;
}

Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing)
{
   const Eigen::Index n = body1.line.size();
   require(body1.line.formulation == body2.line.formulation &&
              body1.line.formulation != Formulation::torsion,
           "reduce: the bodies must be both plane or both axisymmetric");
   require(body2.line.size() == n && static_cast<Eigen::Index>(pairing.partner.size()) == n &&
              pairing.gap.size() == n,
           "reduce: contact lines of ", n, " and ", body2.line.size(),
           " nodes with a pairing of ", pairing.partner.size(), ", must be as many");
   std::vector<bool> taken(n, false);
   for (int j : pairing.partner)
   {
      require(j >= 0 && j < n && !taken[j], "reduce: partner ", j,
              " in the pairing, must be each of 0 to ", n - 1, " once");
      taken[j] = true;
   }
   Reduction result;
   result.counters = body1.counters;
   result.counters += body2.counters;
   ++result.counters.unions;
   result.bodies.push_back(std::move(body1));
   result.bodies.push_back(std::move(body2));
   const CondensedBody &first = result.bodies[0], &second = result.bodies[1];
   ReducedProblem &problem = result.problem;
   result.pattern_ = join(result.bodies, problem.patterns);
   const Block block =
      united(first, second, pairing.partner, result.pattern_, problem.patterns);
   result.union_ = block.way_back;
   fill(problem, block, first.line);
   for (ContactChain &chain : problem.chains)
   {
      chain.other_ends = {
         goes_on_at(second.line, pairing.partner[chain.first]),
         goes_on_at(second.line, pairing.partner[chain.first + chain.nodes - 1])};
      chain.bodies = {0, 1};
   }
   problem.gap = pairing.gap;
   problem.dofs.resize(n, 4);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const auto &dofs1 = first.line.nodes[i].dofs,
                 &dofs2 = second.line.nodes[pairing.partner[i]].dofs;
      problem.dofs.row(i) << dofs1[0], dofs1[1], dofs2[0], dofs2[1];
   }
   return result;
}

void Reduction::add_torsion(CondensedBody body)
{
   std::vector<CondensedBody> one;
   one.push_back(std::move(body));
   add_torsion(std::move(one));
}

void Reduction::add_torsion(CondensedBody body1, CondensedBody body2)
{
   std::vector<CondensedBody> two;
   two.push_back(std::move(body1));
   two.push_back(std::move(body2));
   add_torsion(std::move(two));
}

void Reduction::add_torsion(std::vector<CondensedBody> twisting)
{
   const Eigen::Index n = problem.nodes();
   require(obstacle_.size() == 0,
           "add torsion: the obstacle already moves, torsion must be added before");
   require(torsion.empty() && problem.components() == 1, "add torsion: the reduction has ",
           problem.components(), " tangential components a node, must have 1");
   require(twisting.size() == bodies.size(), "add torsion: of ", twisting.size(),
           " bodies to a reduction of ", bodies.size(), ", must be as many");
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      require(bodies[b].line.formulation == Formulation::axisymmetric &&
                 twisting[b].line.formulation == Formulation::torsion,
              "add torsion: body ", b, " must be axisymmetric, and what is added its torsion");
      const auto own = bodies[b].line.each(&LineNode::position),
                 other = twisting[b].line.each(&LineNode::position);
      require(own.rows() == other.rows() &&
                 (own - other).cwiseAbs().maxCoeff() <= 1e-12 * own.cwiseAbs().maxCoeff(),
              "add torsion: the contact nodes of body ", b,
              " are not those of its torsion, must be the same");
      counters += twisting[b].counters;
   }
   const Eigen::Index before = problem.H.rows();
   torsion_pattern_ = join(twisting, problem.patterns);
   const auto count = static_cast<Eigen::Index>(problem.patterns.size());
   Block block;
   if (twisting.size() == 1) { block = alone(twisting[0], torsion_pattern_[0], count); }
   else
   {
      ++counters.unions;
      block =
         united(twisting[0], twisting[1], union_->partner, torsion_pattern_, problem.patterns);
      torsion_union_ = block.way_back;
   }
   Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n);
   K.topLeftCorner(n, n) = problem.A();
   K.block(n, n, n, n) = block.S;
   K.bottomLeftCorner(n, n) = problem.B();
   K.bottomRightCorner(n, n) = problem.C();
   for (int row : block.held)
   {
      K(n + row, n + row) = K(2 * n + row, 2 * n + row);
      problem.held.push_back(n + row);
   }
   problem.K = std::move(K);
   join_coupling(problem);
   for (Eigen::Index k = 0; k < count; ++k)
   {
      LoadPattern &pattern = problem.patterns[k];
      pattern.q.conservativeResizeLike(Eigen::VectorXd::Zero(2 * n));
      pattern.q.tail(n) = block.f.col(k);
      if (k >= before) { pattern.p = Eigen::VectorXd::Zero(n); }
   }
   problem.H.conservativeResizeLike(Eigen::MatrixXd::Zero(count, count));
   problem.H += block.H;
   // Rigid motions in the plane of the axis, and about it.
   const Eigen::MatrixXd meridian = std::move(problem.rigid_motions);
   Eigen::MatrixXd motions =
      Eigen::MatrixXd::Zero(3 * n, meridian.cols() + block.motions.cols());
   motions.topLeftCorner(n, meridian.cols()) = meridian.topRows(n);
   motions.bottomLeftCorner(n, meridian.cols()) = meridian.bottomRows(n);
   motions.block(n, meridian.cols(), n, block.motions.cols()) = block.motions;
   problem.rigid_motions = motions;
   torsion = std::move(twisting);
}

void Reduction::add_obstacle_motion(const std::string &name, const ScalarField &ux,
                                    const ScalarField &uy, const ScalarField &u_theta)
{
   require(!name.empty(), "obstacle motion: it has no name, must have one");
   const std::string where = "obstacle motion '" + name + "'";
   require(bodies.size() == 1, where, ": the reduction is of ", bodies.size(),
           " bodies, must be of one on a rigid obstacle");
   for (const LoadPattern &pattern : problem.patterns)
   {
      require(pattern.name != name, where, ": a load pattern of that name is there already");
   }
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   Eigen::VectorXd u(2 * n), theta(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double x = problem.position(i, 0), y = problem.position(i, 1);
      u[i] = ux(x, y);
      u[n + i] = uy(x, y);
      theta[i] = u_theta(x, y);
      require(std::isfinite(u[i]) && std::isfinite(u[n + i]) && std::isfinite(theta[i]), where,
              ": the displacement at (", x, ", ", y, ") is (", u[i], ", ", u[n + i], ", ",
              theta[i], "), must be finite");
      require(!torsion.empty() || theta[i] == 0, where, ": at (", x, ", ", y, ") it is ",
              theta[i], " along the circumference, must be 0 in a reduction without torsion");
   }
   u = FrameChange::of(bodies[0].line).rows(u).col(0);
   Eigen::VectorXd d(m + n);
   d << u.head(n), theta.head(m - n), u.tail(n);
   for (Eigen::Index row : problem.held)
   {
      const Eigen::Index i = row % n;
      require(std::abs(d[row]) <= 1e-12 * d.cwiseAbs().maxCoeff(), where, ": it moves by ",
              d[row], " along the component that is fixed at the node (",
              problem.position(i, 0), ", ", problem.position(i, 1), "), must not");
      d[row] = 0;
   }
   // The body moves by u + λ d: f = K (u + λ d) + …, and the reaction is dᵀ f.
   const Eigen::VectorXd f = problem.K * d;
   const auto k = static_cast<Eigen::Index>(problem.patterns.size());
   problem.H.conservativeResizeLike(Eigen::MatrixXd::Zero(k + 1, k + 1));
   problem.H(k, k) = d.dot(f);
   for (Eigen::Index j = 0; j < k; ++j)
   {
      const LoadPattern &other = problem.patterns[j];
      problem.H(k, j) = d.head(m).dot(other.q) + d.tail(n).dot(other.p);
      problem.H(j, k) = other.control == Control::force ? -problem.H(k, j) : problem.H(k, j);
   }
   problem.patterns.push_back({name, Control::displacement, f.head(m), f.tail(n)});
   if (obstacle_.size() == 0) { obstacle_.resize(m + n, 0); }
   Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(m + n, k + 1);
   motions.leftCols(obstacle_.cols()) = obstacle_;
   motions.col(k) = d;
   obstacle_ = motions;
}

Eigen::VectorXd Reduction::recover(CondensedBody &body, const Eigen::VectorXd &u,
                                   const std::vector<int> &patterns,
                                   const Eigen::VectorXd &multipliers)
{
   Eigen::VectorXd own(patterns.size());
   for (std::size_t k = 0; k < patterns.size(); ++k) { own[k] = multipliers[patterns[k]]; }
   Counters added = body.counters;
   Eigen::VectorXd field = body.recover(u, own);
   added -= body.counters;
   counters -= added;
   return field;
}

Eigen::VectorXd Reduction::displacement(int b, const Eigen::VectorXd &v,
                                        const Eigen::VectorXd &w,
                                        const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(bodies.size()), "displacement: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   const Eigen::Index tangential = torsion.empty() ? n : 2 * n;
   require(v.size() == tangential && w.size() == n, "displacement: ", v.size(),
           " tangential and ", w.size(), " normal displacements, must be ", tangential, " and ",
           n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "displacement: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   Eigen::VectorXd u(2 * n);
   u << v.head(n), w;
   if (obstacle_.size() > 0)
   {
      u.head(n) += (obstacle_ * multipliers).head(n);
      u.tail(n) += (obstacle_ * multipliers).tail(n);
   }
   if (union_) { u = union_->own(b, u, multipliers); }
   return recover(bodies[b], u, pattern_[b], multipliers);
}

Eigen::VectorXd Reduction::twist(int b, const Eigen::VectorXd &v,
                                 const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(torsion.size()), "twist: body ", b,
           ", the reduction has ", torsion.size(), " that twist (counted from 0)");
   require(v.size() == 2 * n, "twist: ", v.size(), " tangential displacements, must be ",
           2 * n);
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "twist: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   Eigen::VectorXd u = v.tail(n);
   if (obstacle_.size() > 0) { u += (obstacle_ * multipliers).segment(n, n); }
   if (torsion_union_) { u = torsion_union_->own(b, u, multipliers); }
   return recover(torsion[b], u, torsion_pattern_[b], multipliers);
}

} // namespace cattaneo
