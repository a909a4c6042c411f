#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

namespace
{

/// Shares of other nodes in a contact node's displacement around the axis. They equal the
/// shares of the radial displacements, which are odd in r as well, without the frames.
UnionRows twisting_rows(UnionRows rows, const std::vector<CondensedBody> &twisting)
{
   for (ContactRow &row : rows.rows) { row.slides[0] = true; }
   choose_dependents(twisting, rows.rows);
   for (ContactRow &row : rows.rows)
   {
      const auto &[b, node] = row.dependent[0];
      if (!holds(twisting[b], node, 0)) { continue; }
      // The node has no node opposite, or a single one that is held as well.
      row.slides[0] = false;
      const NodeOfBody *other = row.partner();
      require(other ? holds(twisting[other->first], other->second, 0) : row.shares.size() == 1,
              "add torsion: the contact node at ", twisting[b].line.nodes[node].position,
              " of ", called(twisting, b),
              " is held around the axis: end the contact line before it, or make the other "
              "side the slave");
   }
   return rows;
}

} // namespace

void Reduction::add_torsion(CondensedBody body1, std::optional<CondensedBody> body2)
{
   std::vector<CondensedBody> twisting;
   twisting.push_back(std::move(body1));
   if (body2) { twisting.push_back(std::move(*body2)); }
   add_torsion(std::move(twisting));
}

void Reduction::add_torsion(std::vector<CondensedBody> twisting)
{
   const Eigen::Index n = problem.nodes();
   require(
      obstacle_.size() == 0,
      "add torsion: the obstacle moves already, must be called before add_obstacle_motion()");
   require(torsion.empty() && problem.components() == 1, "add torsion: the reduction has ",
           problem.components(), " tangential components per node, must have 1");
   require(twisting.size() == bodies.size(), "add torsion: ", twisting.size(),
           " bodies are given, must be as many as in the reduction, ", bodies.size());
   require(
      shanks_.empty(),
      "add torsion: the reduction has shanks already, must be called before they are added");
   for (std::size_t b = 0; b < bodies.size(); ++b)
   {
      require(bodies[b].line.formulation == Formulation::axisymmetric &&
                 twisting[b].line.formulation == Formulation::torsion,
              "add torsion: body ", b,
              " must be axisymmetric, and the body that is added its torsion");
      const auto own = bodies[b].line.each(&LineNode::position),
                 other = twisting[b].line.each(&LineNode::position);
      require(own.rows() == other.rows() &&
                 (own - other).cwiseAbs().maxCoeff() <= 1e-12 * own.cwiseAbs().maxCoeff(),
              "add torsion: body ", b,
              " and its torsion have different contact nodes, must be the same");
      counters += twisting[b].counters;
   }
   require(problem.knows_loads(), "add torsion: the response H of the reduction's loads is not "
                                  "known, which torsion needs");
   const Eigen::Index before = problem.H.rows();
   torsion_pattern_ = join(twisting, problem.patterns);
   const auto count = static_cast<Eigen::Index>(problem.patterns.size());
   counters.unions += twisting.size() > 1;
   const Block block =
      united(twisting, twisting_rows(*rows_, twisting), torsion_pattern_, problem.patterns);
   torsion_union_ = block.way_back;
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

} // namespace cattaneo
