#pragma once

// Judges states and statements by the laws of contact and friction in long double, from the
// problem as it is given. Shares nothing with the solver but the data types.

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace campaign
{
using cattaneo::ContactState;
using cattaneo::NodeState;
using cattaneo::ReducedProblem;
using Eigen::Index;
using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

struct Violation
{
   Real size = 0; ///< force
   const char *law = "";
   Index node = 0;
};

/// A problem in long double, with what judging it takes.
class Laws
{
public:
   explicit Laws(const ReducedProblem &problem)
      : n(problem.nodes()), c(problem.components()), K(problem.K.cast<Real>()),
        F(K.rows(), problem.patterns.size()), gap(problem.gap.cast<Real>()),
        f(problem.friction.cast<Real>())
   {
      for (std::size_t k = 0; k < problem.patterns.size(); ++k)
         F.col(k) << problem.patterns[k].q.cast<Real>(), problem.patterns[k].p.cast<Real>();
   }

   const Index n, c;
   Matrix K, F;
   const Vector gap, f;

   static Vector displacements(const ContactState &s)
   {
      Vector u(s.v.size() + s.w.size());
      u << s.v.cast<Real>(), s.w.cast<Real>();
      return u;
   }
   Vector loads(const Eigen::VectorXd &multipliers) const
   {
      return F * multipliers.cast<Real>();
   }
   Real tangential(const Vector &x, Index i) const
   {
      return c == 1 ? std::abs(x[i]) : std::hypot(x[i], x[n + i]);
   }
   Real largest(const Vector &forces) const
   {
      Real most = 0;
      for (Index i = 0; i < n; ++i)
         most = std::max({most, tangential(forces, i), std::abs(forces[c * n + i])});
      return most;
   }
   /// The largest nodal force that an increment knows of before it is solved: clamped forces at
   /// its loads, forces of the displacements that it starts from, of an interference.
   Real scale(const Vector &u, const Eigen::VectorXd &multipliers) const
   {
      Vector closing = Vector::Zero(K.rows());
      closing.tail(n) = (-gap).cwiseMax(Real(0));
      return std::max({largest(loads(multipliers)), largest(K * u), largest(K * closing)});
   }

   /** The worst violation, as a force, of: the stated forces are K u + f; no penetration (its
       force by the node's own stiffness), no tension, complementarity; Coulomb's cone; friction
       against the increment of slip, of full size, unless the force of that increment by the
       node's own stiffness is smaller. In `named`, if given, what the stated statuses say
       wrongly; the sense of slip where there is no friction is not counted. */
   Violation judge(const Vector &u, const Vector &before, const ContactState &s,
                   Violation *named = nullptr) const
   {
      const Vector forces = K * u + loads(s.multipliers);
      Violation worst;
      Index i = 0;
      const auto note = [&](Violation &most, Real size, const char *law)
      {
         if (!(size <= most.size)) most = {std::isfinite(size) ? size : INFINITY, law, i};
      };
      const auto broken = [&](Real size, const char *law) { note(worst, size, law); };
      for (; i < n; ++i)
      {
         const Index k = c * n + i;
         const Real p = forces[k], open = K(k, k) * (u[k] + gap[i]);
         broken(std::abs(p - s.p[i]), "stated p");
         broken(-open, "penetration");
         broken(-p, "tension");
         broken(std::min(p, open), "pressure across a gap");
         const Real limit = f[i] * std::max(p, Real(0));
         broken(tangential(forces, i) - limit, "cone");
         Real way = 0, stiff = 0, stated = 0, against = 0;
         for (Index a = 0; a < c; ++a)
         {
            const Index t = a * n + i;
            way = std::hypot(way, u[t] - before[t]);
            stiff = std::max(stiff, K(t, t));
            stated = std::max(stated, std::abs(forces[t] - s.q[t]));
         }
         broken(stated, "stated q");
         for (Index a = 0; a < c && way > 0; ++a)
            against = std::hypot(against, forces[a * n + i] +
                                             limit * (u[a * n + i] - before[a * n + i]) / way);
         broken(std::min(against, stiff * way), "friction against slip");
         if (!named) continue;
         const auto wrong = [&](Real size, const char *state) { note(*named, size, state); };
         const NodeState status = s.status[i];
         if (status == NodeState::separation)
            wrong(std::max(std::abs(p), tangential(forces, i)), "separation");
         else wrong(std::abs(open), "closed");
         const double sense = cattaneo::sense(status);
         if (status == NodeState::stick) wrong(std::min(limit, stiff * way), "stick");
         if (sense)
            wrong(std::max(std::abs(forces[i] + Real(sense) * limit),
                           std::min(limit, stiff * Real(sense) * (before[i] - u[i]))),
                  "sense of slip");
         if (status == NodeState::slip) wrong(std::abs(tangential(forces, i) - limit), "slip");
      }
      return worst;
   }

   /// What round-off can leave in the forces at a state: the condition of its active equations,
   /// the size of the sums K u + f over the forces, and with two tangents the direction of a
   /// slip, which is the difference of two displacements of that size.
   Real round_off(const Vector &u, const Vector &before, const ContactState &s,
                  Real scale) const
   {
      const Real eps = std::numeric_limits<double>::epsilon();
      const Vector sums = K.cwiseAbs() * u.cwiseAbs() + loads(s.multipliers).cwiseAbs();
      const Vector unit = K.diagonal().cwiseSqrt().cwiseInverse();
      const Matrix S = unit.asDiagonal() * K * unit.asDiagonal();
      Real turned = 0; // friction forces, by directions of slip that round-off turns
      Matrix M = Matrix::Identity(K.rows(), K.rows());
      for (Index i = 0; i < n; ++i)
      {
         const Index k = c * n + i;
         if (s.status[i] == NodeState::separation) M.row(k) = S.row(k);
         if (s.status[i] == NodeState::stick && f[i] > 0) continue;
         Vector direction = Vector::Zero(c);
         Real way = 0;
         for (Index a = 0; a < c; ++a)
            way = std::hypot(way, direction[a] = u[a * n + i] - before[a * n + i]);
         if (way > 0) direction /= way;
         for (Index a = 0; a < c && c == 2 && way > 0; ++a)
         {
            const Real known_to = 4 * eps * std::abs(u[a * n + i]);
            turned = std::max(turned, f[i] * std::abs(Real(s.p[i])) * known_to / way);
         }
         const bool pressed = s.status[i] != NodeState::separation;
         for (Index a = 0; a < c; ++a)
         {
            const Index t = a * n + i;
            M.row(t) = S.row(t);
            if (!pressed) continue;
            M.row(t) += f[i] * direction[a] * unit[t] / unit[k] * S.row(k);
            if (way > 0)
               for (Index e = 0; e < c; ++e)
                  M(t, e * n + i) += f[i] * s.p[i] / way * unit[t] * unit[e * n + i] *
                                     ((a == e) - direction[a] * direction[e]);
         }
      }
      for (Index i = 0; i < M.rows(); ++i)
         M.row(i) /= std::max(M.row(i).cwiseAbs().maxCoeff(), Real(1e-4000L));
      const Matrix inverse = M.fullPivLu().inverse();
      const Real condition = M.cwiseAbs().rowwise().sum().maxCoeff() *
                             inverse.cwiseAbs().rowwise().sum().maxCoeff();
      if (!std::isfinite(condition)) return INFINITY;
      return eps * (condition + largest(sums) / scale) + turned / scale;
   }
};

enum class Verdict
{
   right,
   wrong,
   open
};

/** Judges "there is no equilibrium under these loads".

    If K is positive definite there always is one, whatever the friction: the solution of the
    problem with given bounds of friction g is bounded whatever g is (its energy is no more than
    without further slip), so that pressure -> bounds -> pressure has a fixed point (Brouwer).
    Else only motions R without stiffness can be lost: forces F within the cones must balance
    the loads along them, Rᵀ F = Rᵀ f; a nonnegative fit finds such forces or a motion along
    which the loads work against all of them (Farkas). If they can be balanced, weak springs
    hold the bodies: their answer, which exists, is nearly one without them, or runs away. */
class Existence
{
public:
   explicit Existence(const Laws &laws) : laws_(laws)
   {
      const Vector unit = laws.K.diagonal().cwiseSqrt().cwiseInverse();
      const Matrix S = unit.asDiagonal() * laws.K * unit.asDiagonal();
      Eigen::SelfAdjointEigenSolver<Matrix> eigen(S);
      Index zero = 0;
      for (const Real value : eigen.eigenvalues())
      {
         if (value < 1e-15L * S.rows()) ++zero;
         else if (value < 1e-13L) unclear_ = true; // neither: the entries of K are rounded
      }
      R_ = unit.asDiagonal() * eigen.eigenvectors().leftCols(zero);
      for (Index k = 0; k < zero; ++k) R_.col(k) /= R_.col(k).cwiseAbs().maxCoeff();
   }

   Index motions() const { return R_.cols(); }
   double margin = 0; ///< of the last statement: unbalanced work over the work of all loads

   Verdict none(const Vector &u, const Eigen::VectorXd &multipliers)
   {
      margin = 0;
      if (!unclear_ && !R_.cols()) return Verdict::wrong;
      const Vector loads = laws_.loads(multipliers);
      const Vector work = R_.cwiseAbs().transpose() * loads.cwiseAbs();
      if (R_.cols()) margin = unbalanced(loads) / std::max(work.maxCoeff(), Real(1e-4000L));
      if (!unclear_ && margin > 1e-13) return Verdict::right;
      const Real left = held_by_springs(u, multipliers);
      if (left < 1e-8) return Verdict::wrong;
      return left < 1e-6 || std::isinf(left) || unclear_ ? Verdict::open : Verdict::right;
   }

private:
   /// What of the loads' work along R no forces within the cones can balance (Lawson and
   /// Hanson). The disc is taken as a polygon about it: what that cannot hold, nothing can.
   Real unbalanced(const Vector &loads) const
   {
      const Index n = laws_.n, c = laws_.c;
      std::vector<Vector> rays;
      const int directions = c == 1 ? 2 : 64;
      for (Index i = 0; i < n; ++i)
         for (int d = 0; d < (laws_.f[i] > 0 ? directions : 1); ++d)
         {
            Vector ray = R_.row(c * n + i);
            if (laws_.f[i] > 0)
               for (Index a = 0; a < c; ++a)
                  ray +=
                     laws_.f[i] * R_.row(a * n + i).transpose() *
                     (c == 1 ? Real(d ? -1 : 1)
                             : std::cos(M_PI * (d - 16 * Real(a)) / 32) / std::cos(M_PI / 64));
            if (ray.norm() > 0) rays.push_back(ray.normalized());
         }
      const Vector b = R_.transpose() * loads;
      std::vector<Index> active;
      Vector x, rest = b;
      for (int step = 0; step < 200; ++step)
      {
         Index best = -1;
         Real gain = 1e-17L * b.norm();
         for (std::size_t k = 0; k < rays.size(); ++k)
            if (rays[k].dot(rest) > gain) gain = rays[k].dot(rest), best = k;
         if (best < 0) break;
         active.push_back(best);
         x.conservativeResize(active.size());
         x[active.size() - 1] = 0;
         while (!active.empty())
         {
            Matrix G(b.size(), active.size());
            for (std::size_t k = 0; k < active.size(); ++k) G.col(k) = rays[active[k]];
            const Vector y = G.completeOrthogonalDecomposition().solve(b);
            Real way = 1;
            Index leaves = -1;
            for (Index k = 0; k < y.size(); ++k)
               if (y[k] <= 0 && x[k] / (x[k] - y[k]) <= way)
                  way = x[k] > y[k] ? x[k] / (x[k] - y[k]) : 0, leaves = k;
            x += way * (y - x);
            rest = b - G * x;
            if (leaves < 0) break;
            active.erase(active.begin() + leaves);
            Vector fewer(x.size() - 1);
            fewer << x.head(leaves), x.tail(x.size() - 1 - leaves);
            x = fewer;
         }
      }
      return rest.norm();
   }

   /// The worst violation of the laws, over the largest force, by the answer of the problem
   /// with weak springs at all nodes; infinite if none was found. Newton's method on the
   /// natural map from several starts, undamped and damped by turns.
   Real held_by_springs(const Vector &before, const Eigen::VectorXd &multipliers) const
   {
      const Index n = laws_.n, c = laws_.c, size = laws_.K.rows();
      const Vector stiff = laws_.K.diagonal(), loads = laws_.loads(multipliers);
      const Real scale = laws_.scale(before, multipliers);
      const Matrix K = laws_.K + Matrix(1e-10L * stiff.asDiagonal());
      Matrix J;
      const auto map = [&](const Vector &u, bool derive) -> Vector
      {
         const Vector forces = K * u + loads;
         Vector rest = forces;
         if (derive) J = K;
         for (Index i = 0; i < n; ++i)
         {
            const Index k = c * n + i;
            const Real open = stiff[k] * (u[k] + laws_.gap[i]);
            if (forces[k] <= open) continue; // no forces
            rest[k] = open;
            if (derive) J.row(k).setZero(), J(k, k) = stiff[k];
            const Real limit = laws_.f[i] * std::max(forces[k], Real(0));
            Real k_t = 0;
            for (Index a = 0; a < c; ++a) k_t = std::max(k_t, stiff[a * n + i]);
            Vector trial(c);
            for (Index a = 0; a < c; ++a)
               trial[a] = forces[a * n + i] - k_t * (u[a * n + i] - before[a * n + i]);
            const Real size_of_trial = trial.norm();
            const Vector d = trial / std::max(size_of_trial, Real(1e-4000L));
            Matrix rows(c, size);
            for (Index a = 0; a < c; ++a)
            {
               const Index t = a * n + i;
               rows.row(a) = K.row(t);
               rows(a, t) -= k_t;
               if (size_of_trial <= limit) rest[t] = k_t * (u[t] - before[t]);
               else rest[t] = forces[t] - limit * d[a];
            }
            if (!derive) continue;
            for (Index a = 0; a < c; ++a)
            {
               const Index t = a * n + i;
               if (size_of_trial <= limit) J.row(t).setZero(), J(t, t) = k_t;
               else
                  J.row(t) =
                     K.row(t) - (forces[k] > 0 ? laws_.f[i] * d[a] : 0) * K.row(k) -
                     limit / size_of_trial * (rows.row(a) - d[a] * (d.transpose() * rows));
            }
         }
         return rest;
      };
      std::mt19937_64 random(1);
      for (int start = 0; start < 60; ++start)
      {
         Vector u = start < 4 ? before : Vector(before.size());
         if (start >= 4)
            for (Index i = 0; i < size; ++i)
               u[i] = before[i] + scale / stiff[i] * std::pow(10.0L, Real(random() % 4)) *
                                     (Real(random() % 2001) / 1000 - 1);
         Vector rest = map(u, false);
         for (int step = 0; step < 40; ++step)
         {
            const Real enough =
               1e-13L * scale + 1e-17L * laws_.largest(K.cwiseAbs() * u.cwiseAbs());
            if (rest.norm() < enough)
            {
               ContactState s;
               s.multipliers = multipliers;
               const Vector forces = laws_.K * u + loads;
               s.q = forces.head(c * n).cast<double>(), s.p = forces.tail(n).cast<double>();
               return laws_.judge(u, before, s).size / scale;
            }
            map(u, true);
            const Vector way = J.partialPivLu().solve(-rest);
            if (!way.allFinite()) break;
            Real part = 1;
            Vector next = map(u + way, false);
            while (start % 2 && part > 1e-4L && next.norm() > (1 - 0.1L * part) * rest.norm())
               next = map(u + (part /= 2) * way, false);
            u += part * way;
            rest = next;
         }
      }
      return INFINITY;
   }

   const Laws &laws_;
   Matrix R_;
   bool unclear_ = false;
};

} // namespace campaign
