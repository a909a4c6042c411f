// Two tangents: the increment is solved without friction and with laws whose bends are rounded
// off. Then friction grows to what it is, and the bends become sharp.
//
// Where nothing can move freely the solution without friction is the only one, and all
// solutions with a share of friction are bounded. The solutions that are connected to the first
// one therefore reach all of friction (Leray and Schauder). Above critical friction they may do
// so on a path on which friction decreases for a while, so that the path is followed by its
// length.

#include <cattaneo/friction/methods.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace cattaneo
{

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace
{

/// The smaller of two numbers, with its derivatives. The bend where they are equal is rounded
/// off by this amount [Chen 1993].
struct Smaller
{
   double value, by_a, by_b;
   Smaller(double a, double b, double rounding)
   {
      const double r = std::hypot(a - b, 2 * rounding);
      value = 0.5 * (a + b - r);
      by_a = 0.5 * (1 - (a - b) / r);
      by_b = 0.5 * (1 + (a - b) / r);
   }
};

/// The laws of a node with a share of its friction, all bends rounded off: zero in a solution,
/// else forces.
struct RoundedLaws
{
   double normal, by_gap, by_pressure; // the gap counted by the node's stiffness
   Vector2d tangential, by_pressure_along;
   Matrix2d by_trial; // of the friction force

   RoundedLaws(const ContactNode &node, double rounding, double share)
   {
      // 1. The smaller of gap and pressure: their product is rounding² in a solution.
      const Smaller least(node.kn * node.gap, node.p, rounding);
      normal = least.value;
      by_gap = least.by_a;
      by_pressure = least.by_b;
      // 2. The bound of the friction force, at a pressure that is never zero.
      const double r = std::hypot(node.p, 2 * rounding), pressure = 0.5 * (node.p + r),
                   limit = share * node.bound.at(pressure),
                   slope = share * node.bound.derivative(pressure) * 0.5 * (1 + node.p / r);
      // 3. The friction force is the trial force, shortened to less than the bound.
      const Vector2d trial = node.trial();
      const double size = std::hypot(trial[0], trial[1]);
      const Smaller of(-limit, -size, rounding);
      const double longer = -of.value, factor = limit / longer;
      tangential = Vector2d(node.q) - factor * trial;
      by_trial = factor * Matrix2d::Identity();
      if (size > 0)
      {
         by_trial -= factor * of.by_b / (longer * size) * trial * trial.transpose();
      }
      by_pressure_along = -slope * (1 - factor * of.by_a) / longer * trial;
   }
};

/// The path of solutions from zero friction to full friction.
class GrowingFriction
{
public:
   /// rounding: of each node at the start of the path, a force.
   GrowingFriction(Increment &increment, VectorXd rounding)
      : at_(increment), s_(increment.system), N_(s_.K.rows()), rounding_(std::move(rounding)),
        unit_(increment.scale() * s_.K.diagonal().cwiseInverse())
   {
   }

   /// Follows the path with at most `most` factorisations. Near its end it tries at each point
   /// whether Newton's steps find the end of the increment from there.
   bool reaches_end(Index most);
   Index factors() const { return factors_; }

private:
   // A point x of the path has the displacements, in units of those that the loads cause at a
   // node alone, and as its last entry the share of friction.
   VectorXd laws(const VectorXd &x);
   MatrixXd derivative(const VectorXd &x);
   double error(const VectorXd &laws, double share) const;
   bool begin(VectorXd &x);
   bool correct(VectorXd &x, const VectorXd &along, bool &easily);
   bool turn(const VectorXd &x, VectorXd &along);
   double rounding(Index i, double share) const { return rounding_[i] * (1 - share); }

   Increment &at_;
   FrictionSystem &s_;
   const Index N_;
   const VectorXd rounding_, unit_;
   Index factors_ = 0;
};

/// Evaluates the laws of all nodes at x, in units of the largest load, and moves the increment
/// to x.
VectorXd GrowingFriction::laws(const VectorXd &x)
{
   at_.u = x.head(N_).cwiseProduct(unit_);
   at_.F = at_.f + s_.product->times(at_.u);
   VectorXd R(N_);
   for (Index i = 0; i < s_.n; ++i)
   {
      const RoundedLaws node(at_.node(i), rounding(i, x[N_]), x[N_]);
      R[s_.m(i)] = node.normal;
      for (Index k = 0; k < 2; ++k) { R[s_.t(i, k)] = node.tangential[k]; }
   }
   return R / at_.scale();
}

/// Their derivative at the present place of the increment, with a last row of zeros.
MatrixXd GrowingFriction::derivative(const VectorXd &x)
{
   const double share = x[N_];
   MatrixXd J = MatrixXd::Zero(N_ + 1, N_ + 1);
   for (Index i = 0; i < s_.n; ++i)
   {
      const ContactNode at = at_.node(i);
      const RoundedLaws node(at, rounding(i, share), share);
      const Index m = s_.m(i);
      // 1. By the displacements.
      J.row(m).head(N_) = node.by_pressure * s_.K.row(m);
      J(m, m) += node.by_gap * at.kn;
      for (Index k = 0; k < 2; ++k)
      {
         auto row = J.row(s_.t(i, k)).head(N_);
         row = node.by_pressure_along[k] * s_.K.row(m);
         for (Index l = 0; l < 2; ++l)
         {
            row += ((k == l) - node.by_trial(k, l)) * s_.K.row(s_.t(i, l));
            row[s_.t(i, l)] += node.by_trial(k, l) * at.kt;
         }
      }
      // 2. By the share of friction, from a difference: it only gives the path's direction.
      const double step = 1e-4 * (1 - share);
      const RoundedLaws ahead(at, rounding(i, share + step), share + step);
      J(m, N_) = (ahead.normal - node.normal) / step;
      for (Index k = 0; k < 2; ++k)
      {
         J(s_.t(i, k), N_) = (ahead.tangential[k] - node.tangential[k]) / step;
      }
   }
   J.leftCols(N_) *= unit_.asDiagonal();
   J /= at_.scale();
   ++factors_;
   ++s_.counters.newton_steps;
   ++s_.counters.dense_factorisations;
   return J;
}

/// Distance of a point from the path; 1 if the error of forces is as large as the rounding of
/// the laws.
double GrowingFriction::error(const VectorXd &laws, double share) const
{
   return laws.norm() * at_.scale() / (rounding_.minCoeff() * (1 - share));
}

/// The solution without friction, by Newton's steps that are shortened until the residual
/// falls. With rounded laws and a definite stiffness their equations are never singular.
bool GrowingFriction::begin(VectorXd &x)
{
   VectorXd R = laws(x);
   for (int k = 0; k < 100; ++k)
   {
      if (error(R, 0) <= 1e-3) { return true; }
      DenseLU factor;
      if (!factor.compute(derivative(x).topLeftCorner(N_, N_))) { return false; }
      const VectorXd from = x.head(N_);
      const double size = R.norm();
      VectorXd step = R;
      factor.solve(step);
      for (double share = 1;; share *= 0.5)
      {
         if (share < 1e-6) { return false; }
         x.head(N_) = from - share * step;
         R = laws(x);
         if (R.norm() < (1 - 1e-4 * share) * size) { break; }
      }
   }
   return false;
}

/// Newton's steps across the direction `along`, back to the path. False if they do not reach it
/// soon.
bool GrowingFriction::correct(VectorXd &x, const VectorXd &along, bool &easily)
{
   double before = std::numeric_limits<double>::infinity();
   for (int k = 0; k < 6; ++k)
   {
      VectorXd R(N_ + 1);
      R << laws(x), 0;
      easily = k <= 3;
      if (error(R, x[N_]) <= 1e-2) { return true; }
      if (!(R.norm() < 0.5 * before)) { return false; }
      before = R.norm();
      MatrixXd J = derivative(x);
      J.row(N_) = along.transpose();
      DenseLU factor;
      if (!factor.compute(std::move(J))) { return false; }
      factor.solve(R);
      x -= R;
      if (!(x[N_] < 1)) { return false; }
   }
   return false;
}

/// Takes the direction of the path at x, on the side of the last one. False if it turns
/// sharply.
bool GrowingFriction::turn(const VectorXd &x, VectorXd &along)
{
   MatrixXd J = derivative(x);
   J.row(N_) = along.transpose();
   DenseLU factor;
   if (!factor.compute(std::move(J))) { return false; }
   VectorXd next = VectorXd::Unit(N_ + 1, N_);
   factor.solve(next);
   next.normalize();
   const double cosine = next.dot(along);
   along = next;
   return cosine > 0.8;
}

bool GrowingFriction::reaches_end(Index most)
{
   // 1. The path begins without friction, and friction grows.
   VectorXd x = VectorXd::Zero(N_ + 1), along = VectorXd::Unit(N_ + 1, N_);
   x.head(N_) = at_.start.displacements().cwiseQuotient(unit_);
   if (!begin(x)) { return false; }
   turn(x, along);
   double length = 0.1;
   while (factors_ < most && length > 1e-9 && 1 - x[N_] > 1e-10)
   {
      // 2. A step along the path and back to it. It takes nine tenths of the way to the end at
      // most, as the laws become sharp there.
      double step = length;
      if (along[N_] > 0) { step = std::min(step, 0.9 * (1 - x[N_]) / along[N_]); }
      VectorXd next = x + step * along, direction = along;
      bool easily = false;
      if (!correct(next, along, easily) || next[N_] < 0 || !turn(next, direction))
      {
         length = 0.5 * step;
         continue;
      }
      x = next;
      along = direction;
      if (easily) { length = 2 * step; }
      // 3. Near the end the states of the nodes are known.
      if (1 - x[N_] < 0.01)
      {
         laws(x);
         if (ends_from_natural_states(at_)) { return true; }
      }
   }
   return false;
}

} // namespace

Search growing_friction(Increment &at)
{
   const FrictionSystem &s = at.system;
   // Where bodies can move freely, nothing bounds the path.
   if (s.problem.rigid_motions.cols() > 0) { return Search::not_here; }
   constexpr double operations = 3e9; // a second or two
   const double N = static_cast<double>(s.K.rows());
   auto left = static_cast<Index>(operations / disc_step_operations(N));
   // One path in a hundred repeats itself without end, because steps may jump from one branch
   // to another. Other roundings give other paths, as many as the allowed number of factors
   // permits.
   constexpr Index enough = 1000, few = 100;
   std::mt19937_64 random(1);
   for (const double size : {0.1, 0.01, 1.0, 0.1, 0.03, 0.3, 0.01, 0.1})
   {
      if (left < few) { break; }
      VectorXd rounding(s.n);
      for (double &of : rounding)
      {
         of = size * at.scale() * std::exp2(std::ldexp(double(random() >> 11), -52) - 1);
      }
      GrowingFriction path(at, std::move(rounding));
      if (path.reaches_end(std::min(left, enough))) { return Search::found; }
      left -= path.factors();
   }
   return Search::not_here;
}

} // namespace cattaneo
