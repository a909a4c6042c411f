#include <cattaneo/algebra/nonnegative_fit.hpp>
#include <cattaneo/algebra/symmetric_matrix.hpp>
#include <cattaneo/friction/mechanism.hpp>
#include <cmath>
#include <vector>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Do the fit's residual r and all edges prove that there is no equilibrium (Farkas)? With
/// edges·r <= 0 for all of them, rᵀG x <= 0 < rᵀg for any x >= 0; here they may be positive by
/// round-off, which matters if forces as large as the fit's could then do the work of r.
bool proves(const NonnegativeFit &fit, const MatrixXd &G)
{
   const double slope = (G.transpose() * fit.residual).maxCoeff();
   return slope * fit.x.sum() < 0.1 * fit.residual.squaredNorm();
}

} // namespace

MatrixXd cone_edges(const MatrixXd &Z, const std::vector<FrictionBound> &bound)
{
   const auto n = static_cast<Index>(bound.size());
   const Index m = Z.rows() - n, lines = std::max(m, n);
   MatrixXd edges(Z.cols(), 2 * lines);
   for (Index row = 0; row < lines; ++row)
   {
      const Index i = row % n;
      const VectorXd normal = Z.row(m + i);
      const VectorXd tangential = m ? VectorXd(Z.row(row)) : VectorXd::Zero(Z.cols());
      edges.col(2 * row) = normal + bound[i].slope(0, -1) * tangential;
      edges.col(2 * row + 1) = normal - bound[i].slope(0, 1) * tangential;
   }
   return edges;
}

Mechanism find_mechanism(const ReducedProblem &problem, const VectorXd &clamped_forces,
                         double negligible)
{
   return find_mechanism(problem, friction_bounds(problem.friction), clamped_forces,
                         negligible);
}

Mechanism find_mechanism(const ReducedProblem &problem, const std::vector<FrictionBound> &bound,
                         const VectorXd &clamped_forces, double negligible)
{
   Mechanism mechanism;
   const MatrixXd &motions = problem.rigid_motions;
   if (motions.cols() == 0) { return mechanism; }
   // A lever of round-off would balance any load, with forces of any size.
   const double lever = 1e-13 * motions.cwiseAbs().maxCoeff();
   const MatrixXd Z = (motions.array().abs() < lever).select(0.0, motions);
   const Index n = problem.nodes(), m = problem.slips();
   // Equilibrium along the rigid motions: Zᵀ{q; p} = Zᵀ f^w.
   const Index c = std::max<Index>(problem.components(), 1);
   MatrixXd G = cone_edges(Z, bound);
   const VectorXd g = Z.transpose() * clamped_forces;
   NonnegativeFit fit = fit_nonnegative(G, g);
   VectorXd &r = fit.residual;
   // What the motions lack to be rigid does work too. The least squares are solved to 1e-13 of
   // the slope; r goes as its root where edges are only approached.
   const MatrixXd &K = problem.K;
   const double lack =
      symmetric_times(K, Z).cwiseAbs().maxCoeff() / K.diagonal().cwiseAbs().maxCoeff();
   const double least = (c == 2 ? 1e-5 : std::max(1e-12, 100 * lack)) * g.norm();
   bool proven = c == 1 && proves(fit, G);
   for (int round = 0; c == 2 && round < 50 && !proven && r.norm() > least; ++round)
   {
      // Edge of each round cone that points most along the residual.
      std::vector<VectorXd> edges;
      for (Index i = 0; i < n; ++i)
      {
         const MatrixXd tangential = Z({i, n + i}, Eigen::all);
         const VectorXd along = tangential * r;
         VectorXd edge = Z.row(m + i);
         if (along.norm() > 0)
         {
            edge += bound[i].slope() / along.norm() * tangential.transpose() * along;
         }
         if (edge.dot(r) > 1e-12 * edge.norm() * g.norm()) { edges.push_back(edge); }
      }
      proven = edges.empty();
      if (proven) { break; }
      G.conservativeResize(Eigen::NoChange, G.cols() + static_cast<Index>(edges.size()));
      for (std::size_t k = 0; k < edges.size(); ++k) { G.col(G.cols() - 1 - k) = edges[k]; }
      fit = fit_nonnegative(G, g);
   }
   if (!proven || r.norm() <= least || g.norm() == 0) { return mechanism; }
   mechanism.motion = Z * r;
   // Clamped forces hold the bodies, which go against this motion. What is held without
   // pressure works against them, the loads do r·g = r² along it.
   double held = 0;
   for (Index i = 0; i < n && m > 0; ++i)
   {
      double along = -mechanism.motion[i];
      if (c == 2) { along = std::hypot(along, mechanism.motion[n + i]); }
      held += bound[i].intercept(0, along) * std::abs(along);
   }
   if (r.squaredNorm() <= (1 + 1e-9) * held) { return mechanism; }
   const double largest = mechanism.motion.cwiseAbs().maxCoeff();
   if (largest <= negligible) { return mechanism; }
   mechanism.exists = true;
   mechanism.motion /= largest;
   // A body that slides bears on nodes along which it moves; one that lifts off bears on none,
   // or on those about which it turns.
   VectorXd borne = VectorXd::Zero(n);
   for (Index k = 0; k < 2 * c * n; ++k) { borne[(k / 2) % n] += fit.x[k]; }
   const double forces = fit.x.sum();
   for (Index i = 0; i < n && m > 0; ++i)
   {
      double along = 0;
      for (Index k = 0; k < c; ++k)
      {
         along = std::max(along, std::abs(mechanism.motion[k * n + i]));
      }
      const bool bears = (c == 2 && forces > 0) || borne[i] > 1e-9 * forces ||
                         std::abs(mechanism.motion[m + i]) < 1e-9;
      mechanism.slides = mechanism.slides || (bears && along > 1e-6);
   }
   mechanism.spins = c == 2 && mechanism.motion.segment(n, n).cwiseAbs().maxCoeff() > 1e-6;
   return mechanism;
}

Mechanism find_spinning(const ReducedProblem &problem, const VectorXd &frictionless_pressure,
                        const VectorXd &clamped_forces, double negligible)
{
   Mechanism mechanism;
   const Index n = problem.nodes();
   if (problem.components() != 2) { return mechanism; }
   const MatrixXd Z = rigid_slips(problem);
   if (Z.cols() != 1) { return mechanism; }
   double resistance = 0;
   for (Index i = 0; i < n; ++i)
   {
      resistance += friction_bound(problem, i).line(frictionless_pressure[i]) *
                    std::hypot(Z(i, 0), Z(n + i, 0));
   }
   const double drive = Z.col(0).dot(clamped_forces.head(2 * n));
   if (std::abs(drive) * Z.cwiseAbs().maxCoeff() <= negligible ||
       std::abs(drive) < (1 - 1e-9) * resistance)
   {
      return mechanism;
   }
   mechanism.exists = mechanism.slides = mechanism.spins = true;
   mechanism.motion = VectorXd::Zero(3 * n);
   mechanism.motion.head(2 * n) = (drive > 0 ? 1 : -1) / Z.cwiseAbs().maxCoeff() * Z.col(0);
   return mechanism;
}

} // namespace cattaneo
