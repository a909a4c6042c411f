#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cmath>

namespace cattaneo
{

void Reduction::add_obstacle_motion(const std::string &name, const ScalarField &ux,
                                    const ScalarField &uy, const ScalarField &u_theta)
{
   require(bodies.size() == 1, "obstacle motion '", name, "': the reduction is of ",
           bodies.size(), " bodies, must be of one on a rigid obstacle");
   std::vector<ObstacleMotion> motions;
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      motions.push_back({k, ux, uy, u_theta});
   }
   add_obstacle_motion(name, motions);
}

void Reduction::add_obstacle_motion(const std::string &name,
                                    const std::vector<ObstacleMotion> &motions)
{
   require(!name.empty(), "obstacle motion: it has no name, must have one");
   const std::string where = "obstacle motion '" + name + "'";
   for (const LoadPattern &pattern : problem.patterns)
   {
      require(pattern.name != name, where, ": a load pattern of that name is there already");
   }
   const Eigen::Index n = problem.nodes(), m = problem.slips();
   Eigen::VectorXd d = Eigen::VectorXd::Zero(m + n);
   for (const ObstacleMotion &motion : motions)
   {
      require(motion.interface < interfaces.size(), where, ": interface ", motion.interface,
              ", must be 0 to ", interfaces.size() - 1);
      const InterfaceReport &of = interfaces[motion.interface];
      require(of.bodies[1] < 0 && !of.tied, where, ": interface '", of.name, "' is ",
              of.tied ? "tied" : "between two bodies", ", must be of one on a rigid obstacle");
      for (Eigen::Index i = 0; i < of.nodes; ++i)
      {
         const Eigen::Vector2d x = of.position.row(i), t = of.tangent.row(i),
                               u(motion.ux(x[0], x[1]), motion.uy(x[0], x[1]));
         const double theta = motion.u_theta(x[0], x[1]);
         require(u.allFinite() && std::isfinite(theta), where, ": the displacement at ", x,
                 " is (", u[0], ", ", u[1], ", ", theta, "), must be finite");
         require(!torsion.empty() || theta == 0, where, ": at ", x, " it is ", theta,
                 " along the circumference, must be 0 in a reduction without torsion");
         const Eigen::Index node = of.first + i;
         d[node] = t.dot(u);
         d[m + node] = t[0] * u[1] - t[1] * u[0];
         // What is held lies along an axis, whichever way the frame leans.
         const bool held = std::count(problem.held.begin(), problem.held.end(), node) > 0;
         const int along = std::abs(t[0]) >= std::abs(t[1]) ? 0 : 1;
         if (held) { d[node] = std::copysign(u[along], u[along] * t[along]); }
         if (!torsion.empty()) { d[n + node] = theta; }
      }
   }
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
   Eigen::MatrixXd all = Eigen::MatrixXd::Zero(m + n, k + 1);
   all.leftCols(obstacle_.cols()) = obstacle_;
   all.col(k) = d;
   obstacle_ = all;
}

} // namespace cattaneo
