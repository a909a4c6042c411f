#include <algorithm>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cmath>
#include <vector>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// t² - |q|² for the cone t >= |q| of {t; q}, without cancellation. Positive inside of the
/// cone.
double depth(const Vector3d &x)
{
   const double q = x.tail(2).norm();
   return (x[0] - q) * (x[0] + q);
}

/// The Jordan product: the cone consists of all squares in it.
Vector3d product(const Vector3d &a, const Vector3d &b)
{
   Vector3d c;
   c << a.dot(b), a[0] * b.tail(2) + b[0] * a.tail(2);
   return c;
}

/// x with product(a, x) = b.
Vector3d quotient(const Vector3d &a, const Vector3d &b)
{
   const double first = (a[0] * b[0] - a.tail(2).dot(b.tail(2))) / depth(a);
   Vector3d x;
   x << first, (b.tail(2) - first * a.tail(2)) / a[0];
   return x;
}

/// The scaling of a cone [Nesterov 1997]: W z = W⁻¹ s = λ.
struct Scaling
{
   Matrix3d W, inverse;
   Vector3d lambda;

   Scaling() = default;
   Scaling(const Vector3d &s, const Vector3d &z)
   {
      const double of_s = std::sqrt(depth(s)), of_z = std::sqrt(depth(z));
      const Vector3d s1 = s / of_s, z1 = z / of_z, J(1, -1, -1);
      const double gamma = std::sqrt(0.5 * (1 + s1.dot(z1)));
      const Vector3d w = (s1 + J.cwiseProduct(z1)) / (2 * gamma);
      const Vector3d v = (w + Vector3d::UnitX()) / std::sqrt(2 * (w[0] + 1)),
                     turned = J.cwiseProduct(v);
      const double size = std::sqrt(of_s / of_z);
      W = size * (2 * v * v.transpose() - Matrix3d(J.asDiagonal()));
      inverse = (2 * turned * turned.transpose() - Matrix3d(J.asDiagonal())) / size;
      lambda = W * z;
   }
};

/// The largest share of a step that stays in the cone.
double share_inside(const Vector3d &x, const Vector3d &step)
{
   // depth(x + a step) = c + 2 b a + d a², whose first zero it is.
   const double c = depth(x), b = x[0] * step[0] - x.tail(2).dot(step.tail(2)),
                d = (step[0] - step.tail(2).norm()) * (step[0] + step.tail(2).norm()),
                root = b * b - d * c;
   if (d >= 0 && (b >= 0 || root < 0)) { return 1e30; }
   return c / (std::sqrt(std::max(root, 0.0)) - b);
}

/** The programme in unknowns of order one, x = {θ; ρ}, forces over the typical force of their
    node: the cones s = {f p + s0 + θ s1 - margin; q + r} and the bounds of x, linear in x. The
    dual is z in the same cones with Gᵀ z + balanceᵀ y = {1; 0}, where s is h + G x. */
class InteriorPoints
{
public:
   InteriorPoints(const ConeProgramme &programme, const ConeSettings &settings,
                  const ConeStart &start);
   ConeSolution find();

private:
   /// A direction of all unknowns.
   struct Step
   {
      VectorXd x, y;
      std::vector<Vector3d> s, z;
      VectorXd low_s, low_z, high_s, high_z; // of the bounds x >= -reach and x <= reach
   };
   /// The change that a step must achieve in the products of s and z.
   struct Aim
   {
      std::vector<Vector3d> cones;
      VectorXd low, high;
   };

   Vector3d cone_at(const VectorXd &x, const VectorXd &pressure, Index k) const;
   Vector3d along(const VectorXd &x, const VectorXd &pressure, Index k) const;
   void add_transposed(Index k, const Vector3d &z, VectorXd &by_x, VectorXd &by_pressure) const;
   bool scale_and_factor();
   Step direction(const Aim &aim) const;
   Aim aim(double target, const Step *affine) const;
   double share(const Step &step) const;
   double gap() const;
   void take_residuals();

   const ConeProgramme &programme_;
   const ConeSettings &settings_;
   const Index n_, m_, columns_, cones_;
   MatrixXd q0_, q1_, bound0_, bound1_, transfer_, balance_;
   VectorXd low_, high_; // bounds of x
   const double tangential_;
   // The iterate.
   VectorXd x_, y_;
   std::vector<Vector3d> s_, z_;
   VectorXd low_s_, low_z_, high_s_, high_z_;
   // Residuals: of the dual equations, of balance, of s = h + G x.
   VectorXd dual_, unbalanced_;
   std::vector<Vector3d> off_;
   VectorXd low_off_, high_off_;
   // Data of one iteration.
   std::vector<Scaling> scaling_;
   DenseCholesky factor_, border_;
   MatrixXd held_; // H⁻¹ balanceᵀ
};

InteriorPoints::InteriorPoints(const ConeProgramme &programme, const ConeSettings &settings,
                               const ConeStart &start)
   : programme_(programme), settings_(settings), n_(programme.nodes()), m_(2 * n_),
     columns_(programme.loads.vertices()), cones_(n_ * columns_),
     tangential_(programme.pressure_only ? 0 : 1)
{
   const VectorXd inverse = programme.force_scale.cwiseInverse(),
                  inverse_q = inverse.replicate(2, 1);
   const double unit = programme.theta_scale;
   q0_ = inverse_q.asDiagonal() * programme.loads.q0;
   q1_ = inverse_q.asDiagonal() * programme.loads.q1 * unit;
   bound0_ = inverse.asDiagonal() * programme.friction.cwiseProduct(programme.loads.p0);
   bound1_ = inverse.asDiagonal() * programme.friction.cwiseProduct(programme.loads.p1) * unit;
   if (programme.strength0.size()) { bound0_ += inverse.asDiagonal() * programme.strength0; }
   if (programme.strength1.size())
   {
      bound1_ += inverse.asDiagonal() * programme.strength1 * unit;
   }
   bound0_.array() -= settings.margin;
   if (!programme.residual->uncoupled)
   {
      transfer_ = inverse.asDiagonal() * programme.residual->transfer *
                  inverse_q.cwiseInverse().asDiagonal();
   }
   balance_ = programme.residual->rigid.transpose() * inverse_q.cwiseInverse().asDiagonal();
   for (Index k = 0; k < balance_.rows(); ++k) { balance_.row(k).normalize(); }
   low_ = VectorXd::Constant(1 + m_, -programme.reach);
   high_ = VectorXd::Constant(1 + m_, programme.reach);
   high_[0] = programme.ceiling;
   low_[0] = std::min(-programme.ceiling, -programme.reach);
   // Starts at the given point. Each s is moved inside of its cone, and z is chosen so that all
   // products of s and z are equal.
   x_ = VectorXd::Zero(1 + m_);
   x_[0] = start.theta / unit;
   if (start.r.size()) { x_.tail(m_) = inverse_q.cwiseProduct(start.r); }
   x_ = x_.cwiseMax(0.5 * low_).cwiseMin(0.5 * high_);
   y_ = VectorXd::Zero(balance_.rows());
   const VectorXd pressure =
      transfer_.size() ? VectorXd(transfer_ * x_.tail(m_)) : VectorXd::Zero(n_);
   for (Index k = 0; k < cones_; ++k)
   {
      Vector3d s = cone_at(x_, pressure, k);
      constexpr double least = 0.1;
      s[0] = std::max(s[0], s.tail(2).norm() + least);
      s_.push_back(s);
      const double middle = 1 / (static_cast<double>(cones_) * depth(s));
      z_.emplace_back(middle * s[0], -middle * s[1], -middle * s[2]);
   }
   low_s_ = x_ - low_;
   high_s_ = high_ - x_;
   low_z_ = low_s_.cwiseInverse() / static_cast<double>(cones_);
   high_z_ = high_s_.cwiseInverse() / static_cast<double>(cones_);
}

Vector3d InteriorPoints::along(const VectorXd &x, const VectorXd &pressure, Index k) const
{
   const Index i = k % n_, j = k / n_;
   return {x[0] * bound1_(i, j) + programme_.friction(i, j) * pressure[i],
           x[0] * q1_(i, j) + tangential_ * x[1 + i],
           x[0] * q1_(n_ + i, j) + tangential_ * x[1 + n_ + i]};
}

Vector3d InteriorPoints::cone_at(const VectorXd &x, const VectorXd &pressure, Index k) const
{
   const Index i = k % n_, j = k / n_;
   return Vector3d(bound0_(i, j), q0_(i, j), q0_(n_ + i, j)) + along(x, pressure, k);
}

void InteriorPoints::add_transposed(Index k, const Vector3d &z, VectorXd &by_x,
                                    VectorXd &by_pressure) const
{
   const Index i = k % n_, j = k / n_;
   by_x[0] += z[0] * bound1_(i, j) + z[1] * q1_(i, j) + z[2] * q1_(n_ + i, j);
   by_x[1 + i] += tangential_ * z[1];
   by_x[1 + n_ + i] += tangential_ * z[2];
   by_pressure[i] += programme_.friction(i, j) * z[0];
}

double InteriorPoints::gap() const
{
   double sum = low_s_.dot(low_z_) + high_s_.dot(high_z_);
   for (Index k = 0; k < cones_; ++k) { sum += s_[k].dot(z_[k]); }
   return sum;
}

void InteriorPoints::take_residuals()
{
   const VectorXd pressure =
      transfer_.size() ? VectorXd(transfer_ * x_.tail(m_)) : VectorXd::Zero(n_);
   VectorXd by_pressure = VectorXd::Zero(n_);
   dual_ = low_z_ - high_z_;
   dual_[0] += 1;
   off_.resize(cones_);
   for (Index k = 0; k < cones_; ++k)
   {
      add_transposed(k, z_[k], dual_, by_pressure);
      off_[k] = s_[k] - cone_at(x_, pressure, k);
   }
   if (transfer_.size()) { dual_.tail(m_) += transfer_.transpose() * by_pressure; }
   dual_.tail(m_) += balance_.transpose() * y_;
   unbalanced_ = balance_ * x_.tail(m_);
   low_off_ = low_s_ - (x_ - low_);
   high_off_ = high_s_ - (high_ - x_);
}

/// Computes H = Gᵀ W⁻² G and its factor, and the border for the balance of the rigid motions.
/// False if it has no factor.
bool InteriorPoints::scale_and_factor()
{
   scaling_.resize(cones_);
   // The part of H for {θ, ρ₁, ρ₂, π} of each node, summed over its cones.
   std::vector<Eigen::Matrix4d> own(n_, Eigen::Matrix4d::Zero());
   for (Index k = 0; k < cones_; ++k)
   {
      const Index i = k % n_, j = k / n_;
      scaling_[k] = Scaling(s_[k], z_[k]);
      if (!scaling_[k].inverse.allFinite()) { return false; }
      Eigen::Matrix<double, 3, 4> G;
      G << bound1_(i, j), 0, 0, programme_.friction(i, j), q1_(i, j), tangential_, 0, 0,
         q1_(n_ + i, j), 0, tangential_, 0;
      const Eigen::Matrix<double, 3, 4> scaled = scaling_[k].inverse * G;
      own[i] += scaled.transpose() * scaled;
   }
   MatrixXd H = MatrixXd::Zero(1 + m_, 1 + m_);
   H.diagonal() = low_z_.cwiseQuotient(low_s_) + high_z_.cwiseQuotient(high_s_);
   for (Index i = 0; i < n_; ++i)
   {
      const Eigen::Matrix4d &N = own[i];
      H(0, 0) += N(0, 0);
      for (Index a = 0; a < 2; ++a)
      {
         H(1 + a * n_ + i, 0) += N(1 + a, 0);
         for (Index b = 0; b < 2; ++b) { H(1 + a * n_ + i, 1 + b * n_ + i) += N(1 + a, 1 + b); }
      }
   }
   if (transfer_.size())
   {
      MatrixXd rooted(n_, m_);
      for (Index i = 0; i < n_; ++i)
      {
         const Eigen::Matrix4d &N = own[i];
         // π = transfer ρ couples all nodes. Its part of H is the square of a matrix.
         rooted.row(i) = std::sqrt(N(3, 3)) * transfer_.row(i);
         H.col(0).tail(m_) += N(0, 3) * transfer_.row(i).transpose();
         for (Index a = 0; a < 2; ++a)
         {
            const Index row = 1 + a * n_ + i;
            H.row(row).tail(m_) += N(1 + a, 3) * transfer_.row(i);
            H.col(row).tail(m_) += N(1 + a, 3) * transfer_.row(i).transpose();
         }
      }
      H.bottomRightCorner(m_, m_) = -minus_square(-H.bottomRightCorner(m_, m_), rooted).eval();
   }
   H.row(0).tail(m_) = H.col(0).tail(m_).transpose();
   // If H is singular to round-off, a slightly larger diagonal makes it definite. It does no
   // harm, because steps are corrected.
   H.diagonal() *= 1 + 1e-14;
   if (!factor_.compute(std::move(H))) { return false; }
   if (balance_.rows() == 0) { return true; }
   MatrixXd right = MatrixXd::Zero(1 + m_, balance_.rows());
   right.bottomRows(m_) = balance_.transpose();
   // The balance is a border of H: its Schur complement is balance H⁻¹ balanceᵀ.
   held_ = factor_.solved(right);
   return border_.compute(balance_ * held_.bottomRows(m_));
}

InteriorPoints::Aim InteriorPoints::aim(double target, const Step *affine) const
{
   Aim wanted;
   wanted.cones.resize(cones_);
   for (Index k = 0; k < cones_; ++k)
   {
      const Scaling &W = scaling_[k];
      wanted.cones[k] = target * Vector3d::UnitX() - product(W.lambda, W.lambda);
      if (affine) { wanted.cones[k] -= product(W.inverse * affine->s[k], W.W * affine->z[k]); }
   }
   wanted.low = (target - (low_s_.array() * low_z_.array())).matrix();
   wanted.high = (target - (high_s_.array() * high_z_.array())).matrix();
   if (affine)
   {
      wanted.low -= affine->low_s.cwiseProduct(affine->low_z);
      wanted.high -= affine->high_s.cwiseProduct(affine->high_z);
   }
   return wanted;
}

/// Newton's step to the products of s and z in `aim`, and to zero residuals.
InteriorPoints::Step InteriorPoints::direction(const Aim &aim) const
{
   // With s = h + G x and W dz + W⁻¹ ds = e, where e solves λ ∘ e = aim (∘: the product of the
   // cones, e: quotient()):
   //    dz = W⁻¹ e - W⁻² ds,   ds = G dx - off.
   Step step;
   step.s.resize(cones_);
   step.z.resize(cones_);
   std::vector<Vector3d> fixed(cones_); // of dz, without dx
   VectorXd right = dual_, by_pressure = VectorXd::Zero(n_);
   for (Index k = 0; k < cones_; ++k)
   {
      const Scaling &W = scaling_[k];
      fixed[k] = W.inverse * (quotient(W.lambda, aim.cones[k]) + W.inverse * off_[k]);
      add_transposed(k, fixed[k], right, by_pressure);
   }
   if (transfer_.size()) { right.tail(m_) += transfer_.transpose() * by_pressure; }
   const VectorXd low = aim.low.cwiseQuotient(low_s_) +
                        low_z_.cwiseQuotient(low_s_).cwiseProduct(low_off_),
                  high = aim.high.cwiseQuotient(high_s_) +
                         high_z_.cwiseQuotient(high_s_).cwiseProduct(high_off_);
   right += low - high;
   // H dx - balanceᵀ dy = right, balance dx = -unbalanced.
   step.x = right;
   factor_.solve(step.x);
   step.y = VectorXd::Zero(balance_.rows());
   if (balance_.rows() > 0)
   {
      step.y = -unbalanced_ - balance_ * step.x.tail(m_);
      border_.solve(step.y);
      step.x += held_ * step.y;
   }
   const VectorXd pressure =
      transfer_.size() ? VectorXd(transfer_ * step.x.tail(m_)) : VectorXd::Zero(n_);
   for (Index k = 0; k < cones_; ++k)
   {
      const Matrix3d &inverse = scaling_[k].inverse;
      const Vector3d moved = along(step.x, pressure, k);
      step.s[k] = moved - off_[k];
      step.z[k] = fixed[k] - inverse * (inverse * moved);
   }
   step.low_s = step.x - low_off_;
   step.high_s = -step.x - high_off_;
   step.low_z = low - low_z_.cwiseQuotient(low_s_).cwiseProduct(step.x);
   step.high_z = high + high_z_.cwiseQuotient(high_s_).cwiseProduct(step.x);
   return step;
}

double InteriorPoints::share(const Step &step) const
{
   double most = 1e30;
   for (Index k = 0; k < cones_; ++k)
   {
      most = std::min({most, share_inside(s_[k], step.s[k]), share_inside(z_[k], step.z[k])});
   }
   const auto inside = [&](const VectorXd &at, const VectorXd &way)
   {
      for (Index k = 0; k < at.size(); ++k)
      {
         if (way[k] < 0) { most = std::min(most, -at[k] / way[k]); }
      }
   };
   inside(low_s_, step.low_s);
   inside(low_z_, step.low_z);
   inside(high_s_, step.high_s);
   inside(high_z_, step.high_z);
   return most;
}

ConeSolution InteriorPoints::find()
{
   ConeSolution solution;
   const double count = static_cast<double>(cones_ + 2 * x_.size());
   for (solution.iterations = 0; solution.iterations < settings_.max_iterations;
        ++solution.iterations)
   {
      if (settings_.goes_on && !settings_.goes_on(solution.iterations))
      {
         solution.outcome = ConeOutcome::stopped;
         solution.message = "it was stopped on request";
         break;
      }
      // 1. Done when all conditions hold.
      take_residuals();
      double off = unbalanced_.size() ? unbalanced_.cwiseAbs().maxCoeff() : 0.0;
      for (const Vector3d &each : off_) { off = std::max(off, each.cwiseAbs().maxCoeff()); }
      const double left = gap(), size = 1 + std::abs(x_[0]);
      // Round-off of the dual equations grows as the gap closes, so they are only asked to hold
      // to 1e-6. The bound that the mechanism proves does not depend on them.
      constexpr double enough = 1e-6;
      if (left <= settings_.tolerance * size && off <= settings_.tolerance &&
          dual_.cwiseAbs().maxCoeff() <= enough)
      {
         solution.outcome =
            x_[0] > 0.99 * programme_.ceiling ? ConeOutcome::ceiling : ConeOutcome::solved;
         break;
      }
      // 2. Try Newton's step toward the solution itself, and see how much of it stays in the
      // cones.
      if (!scale_and_factor()) { break; }
      const Step affine = direction(aim(0, nullptr));
      const double first = std::min(1.0, share(affine)), mean = left / count;
      // 3. Take a step toward the central path. The shorter the first step was, the larger are
      // the products that it aims at. It is corrected for the products of the first step's
      // changes [Mehrotra 1992].
      const double target = std::pow(1 - first, 3) * mean;
      const Step step = direction(aim(target, &affine));
      const double length = std::min(1.0, 0.99 * share(step));
      if (!(length > 1e-8)) { break; }
      x_ += length * step.x;
      y_ += length * step.y;
      for (Index k = 0; k < cones_; ++k)
      {
         s_[k] += length * step.s[k];
         z_[k] += length * step.z[k];
      }
      low_s_ += length * step.low_s;
      low_z_ += length * step.low_z;
      high_s_ += length * step.high_s;
      high_z_ += length * step.high_z;
   }
   if (solution.outcome == ConeOutcome::failed)
   {
      solution.message = "the method of interior points stopped before the optimum";
   }
   solution.theta = x_[0] * programme_.theta_scale;
   solution.r = x_.tail(m_).cwiseProduct(programme_.force_scale.replicate(2, 1));
   solution.mechanism.slip.resize(m_, columns_);
   solution.mechanism.limit.resize(n_, columns_);
   for (Index k = 0; k < cones_; ++k)
   {
      const Index i = k % n_, j = k / n_;
      const Vector3d z = z_[k] * (programme_.theta_scale / programme_.force_scale[i]);
      solution.mechanism.limit(i, j) = z[0];
      solution.mechanism.slip(i, j) = z[1];
      solution.mechanism.slip(n_ + i, j) = z[2];
   }
   return solution;
}

} // namespace

ConeSolution solve_by_interior_points(const ConeProgramme &programme,
                                      const ConeSettings &settings, const ConeStart &start)
{
   return InteriorPoints(programme, settings, start).find();
}

} // namespace cattaneo
