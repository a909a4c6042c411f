#include <cattaneo/fretting/critical_plane.hpp>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace cattaneo::fretting
{

namespace
{

using Eigen::VectorXd;

/// A criterion as a function of the angle of the plane's normal.
class OnPlanes
{
public:
   OnPlanes(PlaneCriterion criterion, const StressCycle &cycle, const FatigueMaterial &material,
            const PlaneWeights &weights)
      : criterion_(criterion), middle_(0.5 * (cycle.col(0) + cycle.col(1))),
        half_(0.5 * (cycle.col(0) - cycle.col(1))), shear_(cycle.col(3)),
        sum_(cycle.leftCols(3).rowwise().sum()), material_(material), weights_(weights)
   {
   }

   double operator()(double angle) const
   {
      const double c = std::cos(2 * angle), s = std::sin(2 * angle);
      const VectorXd normal = middle_ + c * half_ + s * shear_;
      const double most = normal.maxCoeff(), nu = material_.poisson, E = material_.young;
      if (criterion_ == PlaneCriterion::smith_watson_topper)
      {
         const VectorXd strain = ((1 + nu) * normal - nu * sum_) / E;
         return amplitude(strain) * std::max(most, 0.0);
      }
      const double shear = amplitude(c * shear_ - s * half_);
      if (criterion_ == PlaneCriterion::findley) { return shear + weights_.findley * most; }
      const double yield = std::sqrt(3) * material_.shear_yield.low;
      return 2 * (1 + nu) / E * shear *
             (1 + weights_.fatemi_socie * std::max(most, 0.0) / yield);
   }

private:
   static double amplitude(const VectorXd &x) { return 0.5 * (x.maxCoeff() - x.minCoeff()); }

   PlaneCriterion criterion_;
   VectorXd middle_, half_, shear_; ///< (σ_xx ± σ_yy)/2 and τ_xy
   VectorXd sum_;                   ///< trace of the stress
   const FatigueMaterial &material_;
   const PlaneWeights &weights_;
};

/// Place of the maximum of a function with a single maximum between two places, by golden
/// sections.
double summit(const OnPlanes &value, double low, double high)
{
   const double share = 0.5 * (std::sqrt(5.0) - 1);
   double left = high - share * (high - low), right = low + share * (high - low),
          at_left = value(left), at_right = value(right);
   while (high - low > 1e-7)
   {
      if (at_left < at_right)
      {
         low = left;
         left = right;
         at_left = at_right;
         right = low + share * (high - low);
         at_right = value(right);
      }
      else
      {
         high = right;
         right = left;
         at_right = at_left;
         left = high - share * (high - low);
         at_left = value(left);
      }
   }
   return 0.5 * (low + high);
}

} // namespace

CriticalPlane critical_plane(PlaneCriterion criterion, const StressCycle &cycle,
                             const FatigueMaterial &material, const PlaneWeights &weights)
{
   require(cycle.rows() > 0,
           "critical plane: the cycle has no instants, must have at least one");
   require(cycle.allFinite(), "critical plane: a stress of the cycle is not finite");
   require(weights.findley >= 0 && weights.fatemi_socie >= 0,
           "critical plane: the weights k are ", weights.findley, " (Findley) and ",
           weights.fatemi_socie, " (Fatemi–Socie), must not be negative");
   const OnPlanes value(criterion, cycle, material, weights);
   constexpr int planes = 360;
   constexpr double step = M_PI / planes;
   VectorXd at(planes);
   for (int k = 0; k < planes; ++k) { at[k] = value(k * step); }
   CriticalPlane best;
   best.value = -std::numeric_limits<double>::infinity();
   for (int k = 0; k < planes; ++k)
   {
      if (at[k] < at[(k + 1) % planes] || at[k] < at[(k + planes - 1) % planes]) { continue; }
      const double angle = summit(value, (k - 1) * step, (k + 1) * step);
      const double there = std::max(value(angle), at[k]);
      // If planes tie, as complementary ones do under shear alone, the first is taken, whatever
      // the rounding.
      if (!(there <= best.value + 1e-9 * std::abs(best.value))) { best = {there, angle}; }
   }
   best.angle -= M_PI * std::floor(best.angle / M_PI);
   return best;
}

StressCycle plain_fatigue_cycle(const FatigueMaterial &material)
{
   const double amplitude = material.fatigue_limit.low *
                            (material.fatigue_limit_basis == Basis::range ? 0.5 : 1.0),
                ratio = material.threshold_ratio, most = 2 * amplitude / (1 - ratio);
   StressCycle cycle = StressCycle::Zero(2, 4);
   cycle.col(0) << most, ratio * most;
   return cycle;
}

} // namespace cattaneo::fretting
