#include <cattaneo/condense/local_frame.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>

namespace cattaneo
{

void Reduction::add_obstacle_motion(const std::string &name, const ScalarField &ux,
                                    const ScalarField &uy, const ScalarField &u_theta)
{
   require(!name.empty(), "obstacle motion: it has no name, must have one");
   const std::string where = "obstacle motion '" + name + "'";
   require(bodies.size() == 1 && !union_, where, ": the reduction is of ", bodies.size(),
           " bodies, must be of one on a rigid obstacle");
   for (const LoadPattern &pattern : problem.patterns)
   {
      require(pattern.name != name, where, ": a load pattern of that name is there already");
   }
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   Eigen::VectorXd u(2 * n), theta(n);
   for (Eigen::Index i = 0; i < n; ++i)
   {
      const Eigen::Vector2d x = problem.position.row(i);
      u[i] = ux(x[0], x[1]);
      u[n + i] = uy(x[0], x[1]);
      theta[i] = u_theta(x[0], x[1]);
      require(std::isfinite(u[i]) && std::isfinite(u[n + i]) && std::isfinite(theta[i]), where,
              ": the displacement at ", x, " is (", u[i], ", ", u[n + i], ", ", theta[i],
              "), must be finite");
      require(!torsion.empty() || theta[i] == 0, where, ": at ", x, " it is ", theta[i],
              " along the circumference, must be 0 in a reduction without torsion");
   }
   u = FrameChange::of(bodies[0].line).rows(u).col(0);
   Eigen::VectorXd d(m + n);
   d << u.head(n), theta.head(m - n), u.tail(n);
   for (Eigen::Index row : problem.held)
   {
      const Eigen::Index i = row % n;
      require(std::abs(d[row]) <= 1e-12 * d.cwiseAbs().maxCoeff(), where, ": it moves by ",
              d[row], " along the component that is fixed at the node ",
              Eigen::Vector2d(problem.position.row(i)), ", must not");
      d[row] = 0;
   }
   // The body moves by u + λ d: f = K (u + λ d) + …, and the reaction is dᵀ f.
   const Eigen::VectorXd f = problem.K * d;
   const auto k = static_cast<Eigen::Index>(problem.patterns.size());
   // What is not known of the other loads stays so.
   const bool known = problem.knows_loads();
   if (known)
   {
      problem.H.conservativeResizeLike(Eigen::MatrixXd::Zero(k + 1, k + 1));
      problem.H(k, k) = d.dot(f);
   }
   for (Eigen::Index j = 0; j < k && known; ++j)
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

} // namespace cattaneo
