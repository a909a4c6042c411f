#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>

namespace cattaneo
{

using Eigen::Index;
using Eigen::VectorXd;

/* The forces N of the pattern {q_N; p_N} = F act in f = K u + F N + …, and their conjugate is
   g = H_N· ℓ - Fᵀ u. With N = T - s g, that is N/s + g = T/s, they are

      N = (T/s + Fᵀ u - Σ H_Nj ℓ_j) / h,    h = H_NN + 1/s,

   the sum over the other patterns, and are put in wherever N stands. */
void Reduction::add_shank(const std::string &pattern, double stiffness)
{
   const std::string where = "shank '" + pattern + "'";
   const auto k = static_cast<Index>(problem.pattern(pattern));
   require(problem.patterns[k].control == Control::force, where,
           ": the load with this name prescribes displacements, must prescribe forces");
   require(stiffness > 0 && std::isfinite(stiffness), where, ": its stiffness is ", stiffness,
           ", must be positive and finite");
   require(problem.knows_loads(), where,
           ": the response H of the reduction's loads is not "
           "known, which shanks need");
   require(obstacle_.size() == 0 && free_motions_.size() == 0, where,
           ": the obstacle moves already, shanks must be added "
           "before add_obstacle_motion()");
   const Index m = problem.slips(), n = problem.nodes();
   VectorXd F(m + n);
   F << problem.patterns[k].q, problem.patterns[k].p;
   const VectorXd response = problem.H.row(k), felt = problem.H.col(k);
   const double h = response[k] + 1 / stiffness, share = 1 / (stiffness * h);
   Shank made{k, -response / h, F / h};
   made.at_rest[k] = share;
   shanks_.push_back(made);

   problem.K += F * F.transpose() / h;
   for (Index j = 0; j < problem.H.rows(); ++j)
   {
      LoadPattern &load = problem.patterns[j];
      const VectorXd scaled = j == k ? VectorXd(share * F) : VectorXd(-response[j] / h * F);
      load.q = (j == k ? VectorXd::Zero(m) : load.q) + scaled.head(m);
      load.p = (j == k ? VectorXd::Zero(n) : load.p) + scaled.tail(n);
   }
   problem.H -= felt * response.transpose() / h;
   problem.H.row(k) = share * response;
   problem.H.col(k) = share * felt;
   problem.H(k, k) = share * response[k];
   join_coupling(problem);
   // A motion that the shank resists is not free any more.
   const Eigen::MatrixXd &Q = problem.rigid_motions;
   if (F.norm() > 0) { problem.rigid_motions = at_rest(Q, F.transpose() / F.norm() * Q); }
}

VectorXd Reduction::acting(const VectorXd &u, VectorXd multipliers) const
{
   // The last bolt was added to a problem that already contained the others as springs.
   for (auto shank = shanks_.rbegin(); shank != shanks_.rend(); ++shank)
   {
      const Index known = shank->at_rest.size();
      multipliers[shank->pattern] =
         shank->at_rest.dot(multipliers.head(known)) + shank->at_once.dot(u);
   }
   return multipliers;
}

} // namespace cattaneo
