#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::Vector2d;
using Eigen::VectorXd;

MatrixX2d Reduction::contact_forces(int b, const VectorXd &q, const VectorXd &p,
                                    const VectorXd &tied) const
{
   require(b >= 0 && b < static_cast<int>(bodies.size()), "contact forces: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   const Index n = problem.nodes();
   require((q.size() == 0 || q.size() >= n) && p.size() == n, "contact forces: ", q.size(),
           " tangential and ", p.size(), " normal forces, must be ", n, " each");
   MatrixX2d forces = MatrixX2d::Zero(bodies[b].line.size(), 2);
   const auto force = [](const Vector2d &t, double along, double across)
   { return Vector2d(along * t[0] - across * t[1], along * t[1] + across * t[0]); };
   const auto slip = [&](Index i) { return q.size() == 0 ? 0.0 : q[i]; };
   const auto add = [&](int row, double along, double across)
   {
      const ContactRow &of = rows_->rows[row];
      const Vector2d its = force(of.tangent, along, across);
      for (const TraceShare &share : of.shares)
      {
         if (share.of.first != b) { continue; }
         forces(share.of.second, 0) += share.x * its[0];
         forces(share.of.second, 1) += share.y * its[1];
      }
   };
   const auto ties = static_cast<Index>(rows_->tied.size());
   require(ties == 0 || tied.size() == 2 * ties, "contact forces: ", tied.size(),
           " forces of tied nodes, must be ", 2 * ties);
   for (Index i = 0; i < n; ++i) { add(rows_->free[i], slip(i), p[i]); }
   for (Index i = 0; i < ties; ++i) { add(rows_->tied[i], tied[i], tied[ties + i]); }
   return forces;
}

VectorXd Reduction::contact_torques(int b, const VectorXd &q, const VectorXd &tied) const
{
   require(b >= 0 && b < static_cast<int>(torsion.size()), "contact torques: body ", b,
           ", the reduction has ", torsion.size(), " that twist (counted from 0)");
   const Index n = problem.nodes();
   const auto ties = static_cast<Index>(rows_->tied.size());
   require(q.size() == n && (ties == 0 || tied.size() == ties), "contact torques: ", q.size(),
           " circumferential forces and ", tied.size(), " of tied nodes, must be ", n, " and ",
           ties);
   const ContactLine &line = torsion[b].line;
   VectorXd torques = VectorXd::Zero(line.size());
   const auto add = [&](int row, double force)
   {
      for (const TraceShare &share : rows_->rows[row].shares)
      {
         const Index node = share.of.second;
         if (share.of.first != b) { continue; }
         torques[node] += line.nodes[node].position[0] * share.x * force;
      }
   };
   for (Index i = 0; i < n; ++i) { add(rows_->free[i], q[i]); }
   for (Index i = 0; i < ties; ++i) { add(rows_->tied[i], tied[i]); }
   return torques;
}

} // namespace cattaneo
