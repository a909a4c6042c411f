#include <algorithm>
#include <cattaneo/algebra/dense_algebra.hpp>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/products.hpp>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cattaneo/words.hpp>
#include <cmath>
#include <map>
#include <set>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace
{

/// The place of a contact node in messages.
std::string place_of(const ReducedProblem &problem, Index node)
{
   const bool in_space = problem.position.cols() == 3;
   Vector3d place(0, 0, 0);
   place.head(problem.position.cols()) = problem.position.row(node);
   return place_text(place, in_space ? Formulation::space : Formulation::plane);
}

/// The beginning of messages about a pattern with this name, of the obstacles at some
/// interfaces. InputError if the name is empty, or if a pattern of the other kind has it
/// already.
std::string named_pattern(const ReducedProblem &problem, const std::string &name,
                          Control control, const std::vector<std::string> &at)
{
   require(!name.empty(), "obstacle motion: it has no name, must have one");
   std::vector<std::string> faces;
   for (const std::string &face : at)
   {
      if (!face.empty()) { faces.push_back("'" + face + "'"); }
   }
   const std::string where = "obstacle motion '" + name + "'" +
                             (faces.empty() ? "" : " at interface " + listed(faces));
   for (const LoadPattern &pattern : problem.patterns)
   {
      require(pattern.name != name || pattern.control == control, where,
              ": a load pattern with this name exists already, and is controlled by ",
              control == Control::force ? "displacement, not by force"
                                        : "force, not by displacement");
   }
   return where;
}

/// The names of the interfaces at which an obstacle moves.
template <class Motions>
std::vector<std::string> faces_of(const Motions &motions,
                                  const std::vector<InterfaceReport> &interfaces)
{
   std::vector<std::string> names;
   for (const ObstacleMotion &motion : motions)
   {
      if (motion.interface < interfaces.size())
      {
         names.push_back(interfaces[motion.interface].name);
      }
   }
   return names;
}

/// Joins patterns from number `first` on, and their columns, with an earlier pattern of the
/// same name: they have one multiplier, and their conjugates add up.
void join_names(ReducedProblem &problem, std::size_t first, MatrixXd &columns)
{
   std::vector<LoadPattern> &all = problem.patterns;
   for (std::size_t k = first; k < all.size();)
   {
      std::size_t same = 0;
      while (all[same].name != all[k].name) { ++same; }
      if (same == k)
      {
         ++k;
         continue;
      }
      const auto from = static_cast<Index>(k), to = static_cast<Index>(same);
      std::vector<Index> left;
      for (Index j = 0; j < static_cast<Index>(all.size()); ++j)
      {
         if (j != from) { left.push_back(j); }
      }
      all[same].q += all[k].q;
      all[same].p += all[k].p;
      all.erase(all.begin() + from);
      columns.col(to) += columns.col(from);
      columns = columns(Eigen::all, left).eval();
      if (problem.H.rows() == 0) { continue; }
      problem.H.row(to) += problem.H.row(from);
      problem.H.col(to) += problem.H.col(from);
      problem.H = problem.H(left, left).eval();
   }
}

} // namespace

void Reduction::add_obstacle_motion(const std::string &name, const ScalarField &ux,
                                    const ScalarField &uy, const ScalarField &third)
{
   require(bodies.size() == 1, "obstacle motion '", name, "': the reduction has ",
           bodies.size(), " bodies, must have one, on a rigid obstacle");
   const bool in_space = bodies[0].line.formulation == Formulation::space;
   const ScalarField none = 0.0;
   std::vector<ObstacleMotion> motions;
   for (std::size_t k = 0; k < interfaces.size(); ++k)
   {
      motions.push_back({k, ux, uy, in_space ? none : third, in_space ? third : none});
   }
   add_obstacle_motion(name, motions);
}

void Reduction::displace_in_space(const std::string &where, const ObstacleMotion &motion,
                                  VectorXd &d) const
{
   const InterfaceReport &of = interfaces[motion.interface];
   const Index n = problem.nodes();
   const ContactSurface &surface = bodies[of.bodies[0]].surface;
   // Displacements of all nodes of the body, then those of their unknowns.
   Eigen::MatrixXd u(surface.size(), 3);
   std::map<int, Index> number;
   for (Index k = 0; k < surface.size(); ++k)
   {
      const Vector3d &x = surface.nodes[k].position;
      u.row(k) << motion.ux(x[0], x[1], x[2]), motion.uy(x[0], x[1], x[2]),
         motion.uz(x[0], x[1], x[2]);
      number[surface.nodes[k].dofs[0]] = k;
   }
   u = surface.of_nodes(std::move(u));
   for (Index i = 0; i < of.nodes; ++i)
   {
      const Index node = of.first + i;
      const Index k = number.at(problem.dofs(node, 3 * of.bodies[0]));
      const Vector3d its = u.row(k);
      require(its.allFinite(), where, ": the displacement at ", place_of(problem, node),
              " is (", its[0], ", ", its[1], ", ", its[2], "), must be finite");
      for (int c = 0; c < 3; ++c)
      {
         d[c * n + node] = of.frames.row(i).segment(3 * c, 3).dot(its);
      }
   }
}

VectorXd Reduction::displaced(const std::string &where,
                              const std::vector<ObstacleMotion> &motions) const
{
   const Index n = problem.nodes(), m = problem.slips();
   VectorXd d = VectorXd::Zero(m + n);
   for (const ObstacleMotion &motion : motions)
   {
      require(motion.interface < interfaces.size(), where, ": interface ", motion.interface,
              ", must be 0 to ", interfaces.size() - 1);
      const InterfaceReport &of = interfaces[motion.interface];
      require(of.bodies[1] < 0 && !of.tied, where, ": interface '", of.name, "' is ",
              of.tied ? "tied" : "between two bodies",
              ", must be of a body on a rigid obstacle");
      if (of.frames.rows() == of.nodes && of.nodes > 0) { displace_in_space(where, motion, d); }
      for (Index i = 0; i < of.nodes && of.frames.rows() == 0; ++i)
      {
         const Vector2d x = of.position.row(i), t = of.tangent.row(i),
                        u(motion.ux(x[0], x[1]), motion.uy(x[0], x[1]));
         const double theta = motion.u_theta(x[0], x[1]);
         require(u.allFinite() && std::isfinite(theta), where, ": the displacement at ", x,
                 " is (", u[0], ", ", u[1], ", ", theta, "), must be finite");
         require(!torsion.empty() || theta == 0, where, ": at ", x, " it is ", theta,
                 " along the circumference, must be 0 in a reduction without torsion");
         const Index node = of.first + i;
         d[node] = t.dot(u);
         d[m + node] = t[0] * u[1] - t[1] * u[0];
         // A held component lies along an axis, whatever the direction of the frame.
         const bool held = std::count(problem.held.begin(), problem.held.end(), node) > 0;
         const int along = std::abs(t[0]) >= std::abs(t[1]) ? 0 : 1;
         if (held) { d[node] = std::copysign(u[along], u[along] * t[along]); }
         if (!torsion.empty()) { d[n + node] = theta; }
      }
   }
   std::set<Index> known; // nodes whose slip is a load's, without friction
   for (const InterfaceReport &of : interfaces)
   {
      for (const InterfaceReport::Moved &one : of.moved) { known.insert(one.node); }
   }
   for (Index row : problem.held)
   {
      const Index i = row % n;
      require(known.count(row) > 0 || std::abs(d[row]) <= 1e-12 * d.cwiseAbs().maxCoeff(),
              where, ": it moves by ", d[row], " along the fixed component of the node ",
              place_of(problem, i), ", must not move along it");
      d[row] = 0;
   }
   return d;
}

VectorXd Reduction::moved(const VectorXd &u, const VectorXd &multipliers) const
{
   VectorXd all = u;
   if (obstacle_.size() > 0) { all += obstacle_ * multipliers; }
   // Free motions follow from the other displacements.
   if (free_motions_.size() > 0)
   {
      VectorXd far = by_load_ * multipliers.head(by_load_.cols());
      far += by_contact_ * all;
      all += free_motions_ * far;
   }
   return all;
}

void Reduction::add_obstacle_motion(const std::string &name,
                                    const std::vector<ObstacleMotion> &motions)
{
   const std::string where =
      named_pattern(problem, name, Control::displacement, faces_of(motions, interfaces));
   const Index n = problem.nodes(), m = problem.slips();
   const VectorXd d = displaced(where, motions);
   // The body moves by u + ℓ d: f = K (u + ℓ d) + …, and the reaction is dᵀ f.
   const Eigen::VectorXd f = problem.K * d;
   const auto k = static_cast<Eigen::Index>(problem.patterns.size());
   // If the responses of the other loads are unknown, they stay unknown.
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
   join_names(problem, static_cast<std::size_t>(k), obstacle_);
}

/* Obstacles that move by D y under the forces F take U = u + D y of the bodies, and the forces
   f = K U + Σ ℓ_k f_k of the contact on these. They are in equilibrium where Dᵀ f = F, that is

      y = M⁻¹ (F - Dᵀ K u - Σ ℓ_k Dᵀ f_k),    M = Dᵀ K D,

   which is put in for y in f and in the conjugates g_k = H_k ℓ ∓ f_kᵀ U. */
void Reduction::free_obstacles(const std::vector<FreeMotion> &motions)
{
   require(!motions.empty() && free_motions_.size() == 0 && obstacle_.size() == 0,
           "free obstacles: ",
           motions.empty()             ? "there is no motion"
           : free_motions_.size() == 0 ? "others have been moved already"
                                       : "they have been freed already",
           ", must be called once, with all motions, before add_obstacle_motion()");
   const Index n = problem.nodes(), m = problem.slips(),
               count = static_cast<Index>(motions.size()),
               before = static_cast<Index>(problem.patterns.size());
   MatrixXd D(m + n, count);
   for (Index a = 0; a < count; ++a)
   {
      const std::string &load = motions[a].load;
      D.col(a) =
         displaced(load.empty() ? "free obstacle"
                                : named_pattern(problem, load, Control::force,
                                                faces_of(motions[a].motions, interfaces)),
                   motions[a].motions);
   }
   const MatrixXd KD = product(problem.K, D);
   const MatrixXd M = transposed_product(D, KD);
   const VectorXd size = M.diagonal(), squares = D.colwise().squaredNorm();
   const double most = problem.K.diagonal().maxCoeff();
   bool resisted = true;
   for (Index a = 0; a < count; ++a) { resisted &= size[a] > 1e-12 * squares[a] * most; }
   // For motions of unit energy a pivot is the energy that remains if the other motions are
   // free.
   VectorXd unit = VectorXd::Zero(count);
   DenseCholesky factor;
   if (resisted)
   {
      unit = size.cwiseSqrt().cwiseInverse();
      resisted = factor.compute(unit.asDiagonal() * M * unit.asDiagonal()) &&
                 factor.smallest_pivot() > 1e-10;
   }
   std::vector<std::string> names;
   for (const FreeMotion &motion : motions)
   {
      for (const std::string &name : faces_of(motion.motions, interfaces))
      {
         const std::string quoted = "'" + name + "'";
         if (!name.empty() && std::find(names.begin(), names.end(), quoted) == names.end())
         {
            names.push_back(quoted);
         }
      }
   }
   require(resisted, "free obstacles: the bodies do not resist all motions of the obstacles",
           names.empty() ? "" : " of interface " + listed(names),
           ": support the bodies, or hold the obstacles");
   const auto solved = [&](const MatrixXd &forces) -> MatrixXd
   { return unit.asDiagonal() * factor.solved(unit.asDiagonal() * forces); };
   MatrixXd f(m + n, before);
   for (Index k = 0; k < before; ++k)
   {
      f.col(k) << problem.patterns[k].q, problem.patterns[k].p;
   }
   const MatrixXd work = transposed_product(D, f); // of each load on each motion
   free_motions_ = D;
   by_contact_ = -solved(KD.transpose());
   by_load_ = MatrixXd::Zero(count, before);
   if (before > 0) { by_load_ = -solved(work); }
   // 1. The loads that are there already.
   for (Index k = 0; k < before; ++k)
   {
      LoadPattern &load = problem.patterns[k];
      const VectorXd given = KD * by_load_.col(k);
      load.q += given.head(m);
      load.p += given.tail(n);
      const double sign = load.control == Control::force ? -1 : 1;
      if (problem.knows_loads())
      {
         for (Index j = 0; j < before; ++j)
         {
            problem.H(k, j) += sign * work.col(k).dot(by_load_.col(j));
         }
      }
   }
   // 2. Those of the obstacles.
   const bool known = problem.knows_loads();
   for (Index a = 0; a < count; ++a)
   {
      if (motions[a].load.empty()) { continue; }
      const auto at = static_cast<Index>(problem.patterns.size());
      const VectorXd y = motions[a].force * solved(VectorXd::Unit(count, a));
      const VectorXd given = KD * y;
      problem.patterns.push_back(
         {motions[a].load, Control::force, given.head(m), given.tail(n)});
      by_load_.conservativeResize(Eigen::NoChange, at + 1);
      by_load_.col(at) = y;
      if (!known) { continue; }
      problem.H.conservativeResizeLike(MatrixXd::Zero(at + 1, at + 1));
      for (Index k = 0; k < before; ++k)
      {
         const double sign = problem.patterns[k].control == Control::force ? -1 : 1;
         problem.H(k, at) = sign * work.col(k).dot(y);
         problem.H(at, k) = motions[a].force * by_load_(a, k);
      }
      Index of = before; // of the loads of obstacles
      for (Index b = 0; b <= a; ++b)
      {
         if (motions[b].load.empty()) { continue; }
         problem.H(of, at) = motions[b].force * y[b];
         problem.H(at, of) = problem.H(of, at);
         ++of;
      }
   }
   join_names(problem, static_cast<std::size_t>(before), by_load_);
   // 3. Bodies and obstacles that move together meet no resistance.
   MatrixXd half = unit.asDiagonal() * KD.transpose();
   factor.solve_half(half);
   problem.K = minus_square(std::move(problem.K), half);
   MatrixXd free(m + n, problem.rigid_motions.cols() + count);
   free << problem.rigid_motions, D;
   problem.rigid_motions = thin_qr(free).Q;
   join_coupling(problem);
}

} // namespace cattaneo
