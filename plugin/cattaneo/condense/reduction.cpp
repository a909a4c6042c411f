#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/condense/reduction.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>

namespace cattaneo
{

struct Reduction::Union
{
   Eigen::LLT<Eigen::MatrixXd> sum; ///< of S1 + S2 (+ springs on common rigid motions)
   Eigen::MatrixXd S2;              ///< body 2 in the order of body 1 and the opposite frames
   Eigen::MatrixXd difference;      ///< f1 - f2 of each pattern
   std::vector<int> partner;
   FrameChange frames; ///< from body 2's own frames (in the order of body 1)
};

namespace
{

struct JoinedPatterns
{
   std::vector<LoadPattern> patterns; ///< names and controls only
   std::vector<std::vector<int>> index;
};

JoinedPatterns join(const std::vector<CondensedBody> &bodies)
{
   JoinedPatterns all;
   for (const CondensedBody &body : bodies)
   {
      all.index.emplace_back();
      for (const LoadPattern &pattern : body.patterns)
      {
         std::size_t k = 0;
         while (k < all.patterns.size() && all.patterns[k].name != pattern.name) { ++k; }
         if (k == all.patterns.size())
         {
            all.patterns.push_back({pattern.name, pattern.control, {}, {}});
         }
         require(all.patterns[k].control == pattern.control, "reduce: load pattern '",
                 pattern.name,
                 "' is controlled by force in one body and by displacement in the other, must "
                 "be the "
                 "same in both");
         all.index.back().push_back(static_cast<int>(k));
      }
   }
   return all;
}

/// Forces {q; p} of a body's patterns as columns, in the order of the joined patterns.
Eigen::MatrixXd clamped_forces(const CondensedBody &body, const std::vector<int> &index,
                               std::size_t count)
{
   const Eigen::Index n = body.line.size();
   Eigen::MatrixXd f = Eigen::MatrixXd::Zero(2 * n, static_cast<Eigen::Index>(count));
   for (std::size_t k = 0; k < index.size(); ++k)
   {
      f.col(index[k]) << body.patterns[k].q, body.patterns[k].p;
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

void fill(ReducedProblem &problem, const Eigen::MatrixXd &S, const Eigen::MatrixXd &f,
          const ContactLine &line)
{
   const Eigen::Index n = line.size();
   problem.A = S.topLeftCorner(n, n);
   problem.B = S.bottomLeftCorner(n, n);
   problem.C = S.bottomRightCorner(n, n);
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      const auto column = static_cast<Eigen::Index>(k);
      problem.patterns[k].q = f.col(column).head(n);
      problem.patterns[k].p = f.col(column).tail(n);
   }
   problem.friction = Eigen::VectorXd::Zero(n);
   problem.weights = line.weights;
   problem.arc_length = line.arc_length;
   problem.position = line.position;
}

/// Rigid motions of the contact nodes that S1 + S2 does not resist, orthonormal.
Eigen::MatrixXd common_motions(const CondensedBody &body1, const Eigen::MatrixXd &sum)
{
   const Eigen::Index n = body1.line.size();
   Eigen::MatrixXd Z = body1.rigid_motions();
   // Turn about the middle of the line, at its own scale: the columns are then near orthogonal.
   const Eigen::RowVector2d middle = body1.line.position.colwise().mean();
   Z.col(2) += middle[1] * Z.col(0) - middle[0] * Z.col(1);
   const double extent = (body1.line.position.rowwise() - middle).cwiseAbs().maxCoeff();
   if (n == 1 || extent == 0) { Z.conservativeResize(Eigen::NoChange, 2); }
   else { Z.col(2) /= extent; }
   const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(Z).householderQ() *
                             Eigen::MatrixXd::Identity(2 * n, Z.cols());
   const Eigen::MatrixXd stiffness = Q.transpose() * sum * Q;
   const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
      0.5 * (stiffness + stiffness.transpose()));
   const double allowed = 1e-11 * sum.diagonal().mean();
   Eigen::Index free = 0;
   while (free < modes.eigenvalues().size() && modes.eigenvalues()[free] <= allowed) { ++free; }
   return Q * modes.eigenvectors().leftCols(free);
}

} // namespace

Reduction reduce(CondensedBody body, const ScalarField &gap)
{
   Reduction result;
   result.counters = body.counters;
   result.bodies.push_back(std::move(body));
   const CondensedBody &only = result.bodies.front();
   JoinedPatterns joined = join(result.bodies);
   result.pattern_ = joined.index;
   ReducedProblem &problem = result.problem;
   problem.patterns = joined.patterns;
   fill(problem, only.S, clamped_forces(only, joined.index[0], joined.patterns.size()),
        only.line);
   problem.H = only.H;
   const Eigen::Index n = only.line.size();
   problem.gap.resize(n);
   problem.dofs.resize(n, 2);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const double x = only.line.position(i, 0), y = only.line.position(i, 1);
      problem.gap[i] = gap(x, y);
      require(std::isfinite(problem.gap[i]), "reduce: the gap at (", x, ", ", y, ") is ",
              problem.gap[i], ", must be finite");
      problem.dofs.row(i) << only.line.true_dofs[i][0], only.line.true_dofs[i][1];
   }
   return result;
}

Reduction reduce(CondensedBody body1, CondensedBody body2, const Pairing &pairing)
{
   const Eigen::Index n = body1.line.size();
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
   JoinedPatterns joined = join(result.bodies);
   result.pattern_ = joined.index;
   const std::size_t count = joined.patterns.size();

   // Body 2 in body 1's order, and in frames exactly opposite to body 1's.
   auto shared = std::make_shared<Reduction::Union>();
   shared->partner = pairing.partner;
   FrameChange &frames = shared->frames;
   frames = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
   const ContactLine &line1 = first.line, &line2 = second.line;
   const Eigen::MatrixXd forces = clamped_forces(second, joined.index[1], count);
   Eigen::MatrixXd S2(2 * n, 2 * n), f2(2 * n, static_cast<Eigen::Index>(count));
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const int j = pairing.partner[i];
      frames.a[i] = -line1.tangent.row(i).dot(line2.tangent.row(j));
      frames.b[i] = -line1.tangent.row(i).dot(line2.normal.row(j));
      frames.c[i] = -line1.normal.row(i).dot(line2.tangent.row(j));
      frames.d[i] = -line1.normal.row(i).dot(line2.normal.row(j));
      require(frames.d[i] > 0,
              "reduce: the bodies do not face each other at the contact node (",
              line1.position(i, 0), ", ", line1.position(i, 1), ")");
      for (const Eigen::Index half : {Eigen::Index(0), n})
      {
         f2.row(half + i) = forces.row(half + j);
         for (Eigen::Index k = 0; k < n; ++k)
         {
            S2(k, half + i) = second.S(pairing.partner[k], half + j);
            S2(n + k, half + i) = second.S(n + pairing.partner[k], half + j);
         }
      }
   }
   shared->S2 = frames.both(S2);
   f2 = frames.rows(f2);

   const Eigen::MatrixXd &S1 = first.S;
   const Eigen::MatrixXd f1 = clamped_forces(first, joined.index[0], count);
   shared->difference = f1 - f2;
   Eigen::MatrixXd &sum = S2; // no longer needed as it was
   sum = S1 + shared->S2;
   if (first.rigid_modes > 0 && second.rigid_modes > 0)
   {
      const Eigen::MatrixXd Z = common_motions(first, sum);
      for (Eigen::Index k = 0; k < shared->difference.cols(); ++k)
      {
         const double load =
            Z.cols() > 0 ? (Z.transpose() * shared->difference.col(k)).norm() : 0.0;
         const double scale = f1.col(k).norm() + f2.col(k).norm();
         require(load <= 1e-9 * scale, "reduce: load pattern '", joined.patterns[k].name,
                 "' pushes both bodies in a common rigid motion that nothing resists (part ",
                 load / scale,
                 " of it), its loads must be in equilibrium or a body be supported");
      }
      shared->difference -= Z * (Z.transpose() * shared->difference);
      sum.noalias() += sum.diagonal().mean() * Z * Z.transpose();
   }
   shared->sum.compute(sum);
   require(shared->sum.info() == Eigen::Success,
           "reduce: the sum of the two condensed stiffnesses is not positive definite: the "
           "bodies can "
           "move together without resistance");

   // With S1 + S2 = L Lᵀ: S = S1 - YᵀY, Y = L⁻¹ S1, and the same for the loads.
   const Eigen::MatrixXd Y = shared->sum.matrixL().solve(S1);
   const Eigen::MatrixXd D = shared->sum.matrixL().solve(shared->difference);
   Eigen::MatrixXd S = S1;
   S.selfadjointView<Eigen::Lower>().rankUpdate(Y.transpose(), -1.0);
   S.triangularView<Eigen::StrictlyUpper>() = S.transpose();
   const Eigen::MatrixXd f = f1 - Y.transpose() * D;

   ReducedProblem &problem = result.problem;
   problem.patterns = joined.patterns;
   fill(problem, S, f, line1);
   problem.gap = pairing.gap;
   problem.H =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
   add_response(first, joined.index[0], problem.H);
   add_response(second, joined.index[1], problem.H);
   // The contact nodes are clamped to each other now, and move together where the loads push
   // them: more displacement of the forces, less reaction of the prescribed displacements.
   const Eigen::MatrixXd together = D.transpose() * D;
   problem.dofs.resize(n, 4);
   for (std::size_t k = 0; k < count; ++k)
   {
      const auto row = static_cast<Eigen::Index>(k);
      const double sign = problem.patterns[k].control == Control::force ? 1.0 : -1.0;
      problem.H.row(row) += sign * together.row(row);
   }
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const auto &dofs1 = line1.true_dofs[i], &dofs2 = line2.true_dofs[pairing.partner[i]];
      problem.dofs.row(i) << dofs1[0], dofs1[1], dofs2[0], dofs2[1];
   }
   result.union_ = std::move(shared);
   return result;
}

mfem::Vector Reduction::displacement(int b, const Eigen::VectorXd &v, const Eigen::VectorXd &w,
                                     const Eigen::VectorXd &multipliers)
{
   const Eigen::Index n = problem.nodes();
   require(b >= 0 && b < static_cast<int>(bodies.size()), "displacement: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   require(v.size() == n && w.size() == n, "displacement: ", v.size(), " tangential and ",
           w.size(), " normal displacements, must be ", n, " each");
   require(multipliers.size() == static_cast<Eigen::Index>(problem.patterns.size()),
           "displacement: ", multipliers.size(), " load multipliers, must be ",
           problem.patterns.size());
   Eigen::VectorXd u(2 * n);
   u << v, w;
   if (union_)
   {
      const Eigen::VectorXd loaded =
         union_->difference * multipliers.head(union_->difference.cols());
      const Eigen::VectorXd u1 = union_->sum.solve(union_->S2 * u - loaded);
      if (b == 0) { u = u1; }
      else
      {
         const Eigen::VectorXd u2 = union_->frames.inverse().rows(u - u1);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            u[union_->partner[i]] = u2[i];
            u[n + union_->partner[i]] = u2[n + i];
         }
      }
   }
   const std::vector<int> &index = pattern_[b];
   Eigen::VectorXd own(index.size());
   for (std::size_t k = 0; k < index.size(); ++k) { own[k] = multipliers[index[k]]; }
   const Counters before = bodies[b].counters;
   mfem::Vector field = bodies[b].recover(u, own);
   counters.back_substitutions +=
      bodies[b].counters.back_substitutions - before.back_substitutions;
   counters.field_recoveries += bodies[b].counters.field_recoveries - before.field_recoveries;
   return field;
}

} // namespace cattaneo
