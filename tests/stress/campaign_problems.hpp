#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/halfplane/half_space.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace campaign
{
using cattaneo::Control;
using cattaneo::LoadPattern;
using cattaneo::ReducedProblem;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Random numbers by a rule of our own, so that a seed means the same problem everywhere.
struct Random
{
   std::mt19937_64 engine;
   double uniform(double a = 0, double b = 1)
   {
      return a + (b - a) * 0x1p-53 * (engine() >> 11);
   }
   double power(double a, double b) { return std::pow(10.0, uniform(a, b)); }
   int whole(int a, int b) { return a + static_cast<int>(engine() % (b - a + 1)); }
   bool chance(double p) { return uniform() < p; }
   double normal()
   {
      return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * M_PI * uniform());
   }
   VectorXd normals(Index n)
   {
      return VectorXd::NullaryExpr(n, [this](Index) { return normal(); });
   }
   MatrixXd normals(Index n, Index m)
   {
      return MatrixXd::NullaryExpr(n, m, [this](Index, Index) { return normal(); });
   }
};

/// A problem, where it starts and the loads that it is to follow.
struct Case
{
   ReducedProblem problem;
   VectorXd slip; ///< initial, empty: virgin
   std::vector<VectorXd> history;
   int increments = 1; ///< of each piece
   bool single_if_exact = true;
};

/// Builds one case of a family, of n nodes with c tangential components each.
class Builder
{
public:
   Builder(Random &random, Case &made, int nodes, int components)
      : r(random), made(made), n(nodes), c(components), size(nodes * (components + 1)),
        force_scale(VectorXd::Ones(size))
   {
   }

   Random &r;
   Case &made;
   const int n, c, size;
   VectorXd force_scale;    ///< loads of each displacement {v; w}
   MatrixXd rigid;          ///< motions without stiffness
   std::vector<Index> held; ///< rows of A
   bool self_balanced = false;
   bool proportional = false;
   bool symmetric = false;

   /// Random orthogonal axes, eigenvalues spread between 1/condition and 1.
   MatrixXd definite(int m, double condition)
   {
      const MatrixXd Q = r.normals(m, m).householderQr().householderQ();
      VectorXd values(m);
      for (int i = 0; i < m; ++i) values[i] = std::pow(condition, -r.uniform());
      values[0] = 1, values[m - 1] = 1 / condition;
      return Q * values.asDiagonal() * Q.transpose();
   }

   void stiffness(const MatrixXd &K0)
   {
      const MatrixXd K = 0.5 * (K0 + K0.transpose());
      ReducedProblem &p = made.problem;
      p.set_stiffness(K.topLeftCorner(c * n, c * n), K.bottomLeftCorner(n, c * n),
                      K.bottomRightCorner(n, n));
      p.gap = VectorXd::Zero(n);
   }

   void uncouple()
   {
      made.problem.B().setZero();
      cattaneo::complete(made.problem);
   }

   /// K = Gᵀ W G with G the differences that some rigid motions do not change; in whole numbers
   /// (no motion has any stiffness, exactly) or not (to round-off).
   void free_stiffness(bool whole_numbers)
   {
      MatrixXd G = MatrixXd::Identity(size, size);
      std::vector<VectorXd> motions;
      std::vector<bool> keep(size, true);
      for (int block = 0; block <= c; ++block)
      {
         const int order = r.whole(block == c ? 0 : 1, block == c ? 2 : 1);
         if (block < c && c == 2 && r.chance(0.4)) continue;
         for (int k = 0; k < std::min(order, n - 1); ++k)
         {
            VectorXd motion = VectorXd::Zero(size);
            for (int i = 0; i < n; ++i) motion[block * n + i] = k ? i : 1;
            motions.push_back(motion);
            for (int i = n - 1; i > k; --i)
               G.row(block * n + i) -= MatrixXd(G.row(block * n + i - 1));
            keep[block * n + k] = false;
         }
      }
      MatrixXd rows(0, size);
      for (int i = 0; i < size; ++i)
         if (keep[i])
         {
            rows.conservativeResize(rows.rows() + 1, size);
            rows.bottomRows(1) = G.row(i);
         }
      const int m = rows.rows();
      MatrixXd W = definite(m, r.power(0.5, 2));
      if (whole_numbers)
      {
         const MatrixXd M =
            MatrixXd::NullaryExpr(m, m, [this](Index, Index) { return r.whole(-2, 2); });
         W = M.transpose() * M + MatrixXd::Identity(m, m);
      }
      rigid.resize(size, motions.size());
      for (std::size_t k = 0; k < motions.size(); ++k) rigid.col(k) = motions[k];
      stiffness(rows.transpose() * W * rows);
   }

   double critical() const
   {
      const ReducedProblem &p = made.problem;
      double least = 1e30;
      for (int i = 0; i < n; ++i)
         for (int a = 0; a < c; ++a)
            least = std::min(least, p.A()(a * n + i, a * n + i) /
                                       std::max(1e-30, std::abs(p.B()(i, a * n + i))));
      return least;
   }

   void friction(double value) { made.problem.friction = VectorXd::Constant(n, value); }
   /// Below the critical value of every node; now and then not the same everywhere.
   void moderate_friction()
   {
      friction(std::min(r.uniform(0.05, 0.9), 0.8 * critical()));
      if (r.chance(0.3))
         for (double &f : made.problem.friction) f *= r.uniform(0.3, 1);
   }

   void gaps(double size_of_gap)
   {
      const double soft = made.problem.C().diagonal().mean();
      for (double &g : made.problem.gap)
         g = (r.chance(0.2) ? -0.3 : 1) * size_of_gap * r.uniform() / soft;
   }

   void patterns()
   {
      ReducedProblem &p = made.problem;
      const double f = std::max(0.05, p.friction.maxCoeff() > 0 ? p.friction.mean() : 0.3);
      const auto add = [&](const char *name, VectorXd F)
      {
         F = F.cwiseProduct(force_scale);
         p.patterns.push_back(LoadPattern{name, Control::force, F.head(c * n), F.tail(n)});
      };
      const bool even = symmetric || r.chance(0.2);
      const auto about = [&](double mean) { return even ? mean : mean * r.uniform(0.4, 1.6); };
      VectorXd P = VectorXd::Zero(size), Q = P;
      const double aside = r.chance(0.5) ? 0 : 0.3;
      const double ratio = f * (r.chance(0.5) ? 1 : r.uniform(0.5, 1.1));
      const double turn = r.uniform(0, 2 * M_PI);
      for (int i = 0; i < n; ++i)
      {
         P[c * n + i] = about(0.6);
         if (!symmetric) Q[c * n + i] = aside * r.normal();
         for (int a = 0; a < c; ++a)
         {
            if (!symmetric) P[a * n + i] = aside * f * r.normal();
            const double along = c == 1 ? 1 : a ? std::sin(turn) : std::cos(turn);
            Q[a * n + i] = proportional ? ratio * P[c * n + i] * along
                                        : f * along * (even ? 0.6 : r.uniform(0, 1.2));
         }
      }
      if (proportional) P.head(c * n).setZero(), Q.tail(n).setZero();
      add("P", P);
      add("Q", Q);
      if (self_balanced)
      {
         VectorXd S = r.normals(size);
         S.head(c * n) *= f;
         if (rigid.cols()) S -= rigid * rigid.colPivHouseholderQr().solve(S);
         add("S", S);
      }
      else if (!symmetric && !proportional && r.chance(0.4))
      {
         VectorXd R = r.normals(size);
         R.head(c * n) *= f;
         add("R", R);
      }
      p.H = MatrixXd::Zero(p.patterns.size(), p.patterns.size());
   }

   /// Points after an unloaded one: anywhere, back to nothing, reversed, proportional, and next
   /// to the one before.
   void history(int points, double tiny = 0.1)
   {
      const Index m = made.problem.patterns.size();
      std::vector<VectorXd> &h = made.history;
      h = {VectorXd::Zero(m)};
      for (int k = 1; k < points; ++k)
      {
         VectorXd x(m);
         const double kind = r.uniform();
         const VectorXd &before = h.back();
         for (Index j = 0; j < m; ++j)
            x[j] = j == 0   ? r.uniform(0.1, 1)
                   : j == 1 ? r.uniform(-1.1, 1.1)
                            : r.uniform(-0.5, 0.5);
         if (self_balanced && r.chance(0.5)) x.head(2).setZero();
         if (k > 1 && kind < tiny) x = before + r.power(-14, -6) * r.normals(m);
         else if (k > 1 && kind < tiny + 0.1) x = before, x[1] = -x[1];
         else if (k > 1 && kind < tiny + 0.2) x = before * r.uniform(0, 2);
         else if (k > 1 && kind < tiny + 0.28) x.setZero();
         h.push_back(x);
      }
   }
};

using Family = std::function<void(Builder &)>;

struct FamilyEntry
{
   std::string name;
   int nodes_plane, nodes_disc; ///< at most; 0: does not make sense
   Family build;
   bool slow = false; ///< with two components: fewer of them
   double weight(int components) const { return slow && components == 2 ? 0.25 : 1; }
};

inline const std::vector<FamilyEntry> &families()
{
   static const std::vector<FamilyEntry> all = {
      {"coupled", 12, 8,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(1, 3)));
          b.moderate_friction();
       }},
      {"critical", 8, 6,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.friction(std::min(5.0, b.r.uniform(0.9, 2) * b.critical()));
       }},
      {"free", 8, 6,
       [](Builder &b)
       {
          b.free_stiffness(b.r.chance(0.5));
          b.moderate_friction();
       },
       true},
      {"frictionless", 8, 6,
       [](Builder &b)
       {
          if (b.r.chance(0.7)) b.free_stiffness(b.r.chance(0.5));
          else b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.friction(0);
          if (b.r.chance(0.5))
             for (double &f : b.made.problem.friction)
                if (b.r.chance(0.4)) f = b.r.uniform(0.05, 0.5);
       },
       true},
      {"balanced", 8, 6,
       [](Builder &b)
       {
          b.free_stiffness(b.r.chance(0.5));
          b.moderate_friction();
          b.self_balanced = true;
       },
       true},
      {"scaled", 8, 6,
       [](Builder &b)
       {
          const double spread = b.r.uniform(1, 3.5);
          VectorXd d(b.size);
          for (int i = 0; i < b.n; ++i)
          {
             const double node = b.r.power(-spread, spread);
             const bool each = b.r.chance(0.2);
             for (int a = 0; a <= b.c; ++a)
                d[a * b.n + i] = each ? b.r.power(-spread, spread) : node;
          }
          b.stiffness(d.asDiagonal() * b.definite(b.size, b.r.power(0.5, 2)) * d.asDiagonal());
          b.moderate_friction();
          if (b.r.chance(0.5)) b.force_scale = d;
       }},
      {"duplicates", 8, 6,
       [](Builder &b)
       {
          const int few = std::max(1, b.n - b.r.whole(1, 3));
          const int small = few * (b.c + 1);
          MatrixXd G = MatrixXd::Zero(small, b.size);
          const bool held_apart = b.r.chance(0.3); // same place, but tangentially held
          for (int i = 0; i < b.n; ++i)
             for (int a = 0; a <= b.c; ++a) G(a * few + i % few, a * b.n + i) = 1;
          const double off[] = {0, 1e-12, 1e-10, 1e-8};
          MatrixXd K = G.transpose() * b.definite(small, b.r.power(0.5, 2)) * G +
                       off[b.r.whole(0, 3)] * b.definite(b.size, 10);
          if (held_apart) K.diagonal().head(b.c * b.n).array() += 0.3;
          b.stiffness(K);
          b.moderate_friction();
       },
       true},
      {"near_singular", 8, 6,
       [](Builder &b)
       {
          const MatrixXd Q = b.r.normals(b.size, b.size).householderQr().householderQ();
          VectorXd values(b.size);
          for (double &x : values) x = b.r.uniform(0.3, 1);
          for (int k = b.r.whole(1, 3); k-- > 0;)
             values[b.r.whole(0, b.size - 1)] = b.r.power(-12, -6);
          b.stiffness(Q * values.asDiagonal() * Q.transpose());
          b.moderate_friction();
       }},
      {"hilbert", 8, 16,
       [](Builder &b)
       {
          const MatrixXd H = MatrixXd::NullaryExpr(
             b.n, b.n, [](Index i, Index j) { return 1.0 / (i + j + 1); });
          const double coupling[] = {0, 0.3, 0.9};
          const double beta = coupling[b.r.whole(0, 2)];
          MatrixXd K = MatrixXd::Zero(b.size, b.size);
          if (b.r.chance(0.3))
             K = MatrixXd::NullaryExpr(b.size, b.size,
                                       [](Index i, Index j) { return 1.0 / (i + j + 1); });
          else
             for (int a = 0; a <= b.c; ++a)
             {
                K.block(a * b.n, a * b.n, b.n, b.n) = H;
                if (a == 0) K.block(0, b.c * b.n, b.n, b.n) = beta * H;
                if (a == b.c) K.block(b.c * b.n, 0, b.n, b.n) = beta * H;
             }
          b.stiffness(K);
          b.moderate_friction();
       },
       true},
      {"weak_coupling", 8, 6,
       [](Builder &b)
       {
          MatrixXd K = MatrixXd::Zero(b.size, b.size);
          const double spread = b.r.uniform(4, 9);
          for (int i = 0; i < b.n; ++i)
          {
             const double k = b.r.chance(0.5) ? 1 : std::pow(10.0, spread);
             const MatrixXd own = b.definite(b.c + 1, 10);
             const double beta = k == 1 ? b.r.power(-4, 0) : b.r.power(-12, -2);
             for (int a = 0; a <= b.c; ++a)
                for (int e = 0; e <= b.c; ++e)
                   K(a * b.n + i, e * b.n + i) =
                      k * own(a, e) * ((a == b.c) != (e == b.c) ? beta : 1);
          }
          if (b.r.chance(0.5)) K += 0.01 * b.definite(b.size, 10);
          b.stiffness(K);
          b.moderate_friction();
          if (b.r.chance(0.3)) b.force_scale = K.diagonal();
       }},
      {"strong_coupling", 10, 6,
       [](Builder &b)
       {
          const int m = b.c * b.n;
          const MatrixXd A = b.definite(m, 10), C = b.definite(b.n, 10);
          const MatrixXd O =
             MatrixXd(b.r.normals(m, m).householderQr().householderQ()).topRows(b.n);
          const double close[] = {0.9, 0.99, 0.999, 0.999999};
          MatrixXd K(b.size, b.size);
          const MatrixXd B = close[b.r.whole(0, 3)] * MatrixXd(C.llt().matrixL()) * O *
                             MatrixXd(A.llt().matrixL()).transpose();
          K << A, B.transpose(), B, C;
          b.stiffness(K);
          if (b.r.chance(0.5)) b.moderate_friction();
          else b.friction(b.r.uniform(0.1, 1.5));
       }},
      {"gaps", 10, 6,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.moderate_friction();
          b.gaps(b.r.power(-12, 1));
       }},
      {"tiny", 8, 6,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.moderate_friction();
       }},
      {"turning", 6, 4,
       [](Builder &b)
       {
          MatrixXd K = b.definite(b.size, 3);
          b.stiffness(K);
          if (b.r.chance(0.5)) b.uncouple();
          b.moderate_friction();
       }},
      {"uncoupled", 10, 6,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.uncouple();
          b.moderate_friction();
          if (b.r.chance(0.3)) b.gaps(b.r.power(-3, 0.5));
       }},
      {"condensed", 24, 12,
       [](Builder &b)
       {
          // The operator of a half-plane on a grid: its symbol is |k|, that of its coupling k.
          const double beta = b.r.chance(0.3) ? 0 : b.r.uniform(-0.5, 0.5);
          MatrixXd K = MatrixXd::Zero(b.size, b.size);
          for (int i = 0; i < b.n; ++i)
             for (int j = 0; j < b.n; ++j)
             {
                const int m = std::abs(i - j);
                const double even = m == 0 ? M_PI / 2 : m % 2 ? -2 / (M_PI * m * m) : 0;
                const double odd = m == 0 ? 0 : (m % 2 ? -1.0 : 1.0) / (i - j);
                for (int a = 0; a <= b.c; ++a) K(a * b.n + i, a * b.n + j) = even;
                K(b.c * b.n + i, j) = beta * odd;
                K(j, b.c * b.n + i) = beta * odd;
             }
          b.stiffness(K);
          b.moderate_friction();
          if (b.r.chance(0.5))
             for (int i = 0; i < b.n; ++i)
                b.made.problem.gap[i] =
                   b.r.uniform(0.5, 5) * std::pow((i + 0.5) / b.n - 0.5, 2);
       }},
      {"advancing", 9, 9,
       [](Builder &b)
       {
          // Cells of a rigid body on a half-space, in rows of three: free, coupled, and closing
          // one after the other.
          cattaneo::HalfSpace space;
          space.material = {1, b.r.uniform(0, 0.45)};
          space.size = {1, b.r.uniform(0.5, 2)};
          space.centres.resize(b.n, 2);
          for (int i = 0; i < b.n; ++i) space.centres.row(i) << i / 3, (i % 3) * space.size[1];
          space.turns = b.c == 2 && b.n > 3 && b.r.chance(0.3);
          ReducedProblem of;
          try
          {
             of = space.problem(VectorXd::Zero(b.n));
          }
          catch (const cattaneo::InputError &)
          {
             space.turns = false; // nothing resists it
             of = space.problem(VectorXd::Zero(b.n));
          }
          // In the plane no cell moves along the second tangent.
          std::vector<Index> rows;
          for (int a : b.c == 2 ? std::vector<int>{0, 1, 2} : std::vector<int>{0, 2})
             for (int i = 0; i < b.n; ++i) rows.push_back(a * b.n + i);
          b.rigid = MatrixXd::Zero(b.size, b.c + 1);
          for (int i = 0; i < b.size; ++i) b.rigid(i, i / b.n) = 1;
          if (space.turns)
          {
             b.rigid.conservativeResize(Eigen::NoChange, 4);
             b.rigid.col(3) << -space.centres.col(1), space.centres.col(0), VectorXd::Zero(b.n);
          }
          b.stiffness(of.K(rows, rows));
          b.moderate_friction();
          const double soft = b.made.problem.C().diagonal().mean(), middle = b.r.uniform(0, 2);
          for (int i = 0; i < b.n; ++i)
             b.made.problem.gap[i] = b.r.uniform(0.02, 0.3) / soft *
                                     (space.centres.row(i).array() - middle).square().sum();
       },
       true},
      {"held", 8, 8,
       [](Builder &b)
       {
          b.stiffness(b.definite(b.size, b.r.power(0.5, 2)));
          b.moderate_friction();
          for (int row = 0; row < b.c * b.n; ++row)
             if (b.r.chance(0.3)) b.held.push_back(row);
       }},
      {"symmetric", 10, 6,
       [](Builder &b)
       {
          const MatrixXd K0 = b.definite(b.size, b.r.power(0.5, 2));
          MatrixXd J = MatrixXd::Zero(b.size, b.size);
          for (int a = 0; a <= b.c; ++a)
             for (int i = 0; i < b.n; ++i)
                J(a * b.n + i, a * b.n + b.n - 1 - i) = a == 0 ? -1 : 1;
          b.stiffness(0.5 * (K0 + J * K0 * J));
          b.friction(std::min(0.8 * b.critical(), 0.1 * b.r.whole(1, 6)));
          b.symmetric = true;
          if (b.r.chance(0.3)) b.made.problem.gap.setConstant(b.r.uniform(-0.1, 0.5));
       }},
      {"proportional", 10, 6,
       [](Builder &b)
       {
          const MatrixXd A = b.definite(b.n, b.r.power(0.5, 2));
          MatrixXd K = MatrixXd::Zero(b.size, b.size);
          for (int a = 0; a <= b.c; ++a)
             K.block(a * b.n, a * b.n, b.n, b.n) = (a < b.c && b.r.chance(0.5) ? 0.5 : 1) * A;
          b.stiffness(K);
          b.friction(b.r.uniform(0.1, 0.9));
          b.proportional = true;
       }},
   };
   return all;
}

/// Case `number` of a family and seed: the same on every machine.
inline Case make_case(const FamilyEntry &family, int components, std::uint64_t seed, int number)
{
   Random r;
   std::uint64_t key = seed * 1000003 + number * 2 + components;
   for (const char letter : family.name) key = key * 31 + letter;
   r.engine.seed(key);
   Case made;
   const int most = components == 1 ? family.nodes_plane : family.nodes_disc;
   int n = r.whole(family.name == "condensed" ? 4 : r.chance(0.15) ? 1 : 2, most);
   if (family.name == "free" || family.name == "balanced" || family.name == "advancing" ||
       family.name == "frictionless" || family.name == "duplicates")
      n = std::max(n, 3);
   if (family.name == "hilbert" && components == 2 && r.chance(0.02)) n = r.whole(16, 40);
   Builder b(r, made, n, components);
   family.build(b);
   b.patterns();
   cattaneo::hold(made.problem, b.held);
   b.history(r.whole(5, 12), family.name == "tiny" ? 0.7 : 0.1);
   made.increments = family.name == "turning" ? 1 : r.whole(1, 5);
   made.single_if_exact = r.chance(0.7);
   if (r.chance(0.35))
   {
      made.slip = r.power(-3, 0.5) * r.normals(components * n);
      for (int i = 0; i < components * n; ++i)
         made.slip[i] *= b.force_scale[i] / made.problem.A()(i, i);
      for (const Index row : b.held) made.slip[row] = 0;
   }
   // Half of the problems come with the motions that a program which makes them knows; of the
   // others they were sought.
   if (number % 2)
   {
      if (b.rigid.cols())
         made.problem.rigid_motions =
            MatrixXd(b.rigid.householderQr().householderQ()).leftCols(b.rigid.cols());
      else if (family.name != "duplicates" && family.name != "hilbert")
         made.problem.rigid_motions = MatrixXd(b.size, 0);
   }
   made.problem.chains = cattaneo::one_chain(n);
   return made;
}

} // namespace campaign
