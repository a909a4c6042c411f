#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd Reduction::contact_forces(int b, const VectorXd &q, const VectorXd &p,
                                   const VectorXd &tied) const
{
   require(b >= 0 && b < static_cast<int>(bodies.size()), "contact forces: body ", b,
           ", must be from 0 to ", bodies.size() - 1);
   const Index n = problem.nodes();
   const int d = dimension(bodies[b].line.formulation);
   // With torsion the circumferential forces follow, which have no component along the line.
   const Index tangential = (d - 1) * n;
   require((q.size() == 0 || q.size() >= tangential) && p.size() == n,
           "contact forces: ", q.size(), " tangential and ", p.size(),
           " normal forces, must be ", tangential, " and ", n);
   MatrixXd forces = MatrixXd::Zero(bodies[b].nodes(), d);
   // A column of forces {q; p} in the frame of a row.
   const auto add = [&](int row, const VectorXd &in_frame)
   {
      if (in_frame.isZero(0)) { return; }
      const ContactRow &of = rows_->rows[row];
      const VectorXd its = of.frame(d).transpose() * in_frame;
      for (const TraceShare &share : of.shares)
      {
         if (share.of.first != b) { continue; }
         const std::array<double, 3> part = {share.x, share.y, share.z};
         for (int c = 0; c < d; ++c) { forces(share.of.second, c) += part[c] * its[c]; }
      }
   };
   const auto ties = static_cast<Index>(rows_->tied.size());
   require(ties == 0 || tied.size() == d * ties, "contact forces: ", tied.size(),
           " forces of tied nodes, must be ", d * ties);
   VectorXd in_frame(d);
   for (Index i = 0; i < n; ++i)
   {
      for (int k = 0; k + 1 < d; ++k) { in_frame[k] = q.size() == 0 ? 0.0 : q[k * n + i]; }
      in_frame[d - 1] = p[i];
      add(rows_->free[i], in_frame);
   }
   for (Index i = 0; i < ties; ++i)
   {
      for (int k = 0; k < d; ++k) { in_frame[k] = tied[k * ties + i]; }
      add(rows_->tied[i], in_frame);
   }
   return bodies[b].surface.forces_at_nodes(std::move(forces));
}

VectorXd Reduction::contact_torques(int b, const VectorXd &q, const VectorXd &tied) const
{
   require(b >= 0 && b < static_cast<int>(torsion.size()), "contact torques: body ", b,
           ", must be below ", torsion.size(), ", the number of bodies that twist");
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
