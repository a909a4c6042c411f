#include <cattaneo/algebra/quadrature.hpp>
#include <cattaneo/halfplane/kernel_integrals.hpp>
#include <cmath>
#include <functional>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Least distance, as a share of the length, for which Gauss's rule is used.
constexpr double apart = 0.5;
/// Points of an element and its functions there; for x the functions are multiplied by the
/// weights, for s they are not.
struct Samples
{
   VectorXd x;
   MatrixXd phi;
};

/// A part of an element.
struct Panel
{
   const SurfaceElement *element;
   double begin, end;   ///< parameters
   double from, to;     ///< places
   bool uneven = false; ///< does the slope of x(t) vary much?

   Panel(const SurfaceElement &of, const SurfaceTrace &trace, double first = 0, double last = 1)
      : element(&of), begin(first), end(last)
   {
      const Index order = of.order();
      const VectorXd t = VectorXd::LinSpaced(2 * order + 1, begin, end);
      const SurfacePoints at = trace.points(of, t);
      from = begin == 0 ? of.x[0] : of.x[0] + at.x[0];
      to = end == 1 ? of.x[order] : of.x[0] + at.x[2 * order];
      uneven = at.dx.maxCoeff() > 1.5 * at.dx.minCoeff();
   }
   double size() const { return to - from; }
   std::vector<Panel> halves(const SurfaceTrace &trace) const
   {
      const double middle = 0.5 * (begin + end);
      return {{*element, trace, begin, middle}, {*element, trace, middle, end}};
   }
   bool same(const Panel &other) const
   {
      return element == other.element && begin == other.begin && end == other.end;
   }
};

/// Rule for products of the functions of two panels and a factor without a singularity within
/// half the length of the interval.
const QuadratureRule &regular_rule(const Panel &p, const Panel &q)
{
   return gauss_rule(static_cast<int>(p.element->order() + q.element->order()) + 17);
}

/// Computes several kernels at a pair of points, from the distance |x - s|, x and s.
using Values = std::function<void(double distance, double x, double s, double *values)>;

/// Integrals of `count` kernels over all pairs of elements.
class Integrals
{
public:
   Integrals(const SurfaceTrace &first, const SurfaceTrace &second, std::size_t count,
             bool about_axis, Values kernels)
      : first_(first), second_(second), kernels_(std::move(kernels)), values_(count),
        blocks_(count), about_axis_(about_axis), whole_{std::vector<std::map<int, Samples>>(
                                                           first.elements().size()),
                                                        std::vector<std::map<int, Samples>>(
                                                           second.elements().size())}
   {
   }

   std::vector<MatrixXd> all()
   {
      const bool same = &first_ == &second_;
      std::vector<MatrixXd> results(values_.size(),
                                    MatrixXd::Zero(first_.unknowns(), second_.unknowns()));
      const std::vector<Panel> rows = panels(first_), columns = panels(second_);
      for (const Panel &p : rows)
      {
         for (const Panel &q : columns)
         {
            const SurfaceElement &e = *p.element, &f = *q.element;
            for (MatrixXd &block : blocks_) { block.setZero(e.x.size(), f.x.size()); }
            add(p, q);
            for (std::size_t m = 0; m < results.size(); ++m)
            {
               results[m](e.unknowns, f.unknowns) += blocks_[m];
               if (same && &e != &f)
               {
                  results[m](f.unknowns, e.unknowns) += blocks_[m].transpose();
               }
            }
            if (same && &e == &f) { break; }
         }
      }
      return results;
   }

private:
   const SurfaceTrace &first_, &second_;
   const Values kernels_;
   std::vector<double> values_;   ///< of each kernel, at the present pair of points
   std::vector<MatrixXd> blocks_; ///< of each kernel, for the present pair of elements
   bool about_axis_;
   std::vector<std::map<int, Samples>>
      whole_[2]; ///< of whole elements, by the number of points

   static std::vector<Panel> panels(const SurfaceTrace &trace)
   {
      std::vector<Panel> all;
      for (const SurfaceElement &element : trace.elements())
      {
         all.emplace_back(element, trace);
      }
      return all;
   }
   void add(const Panel &p, const Panel &q)
   {
      const bool same = p.same(q), touches = p.to == q.from || q.to == p.from;
      const double distance = std::max(p.from - q.to, q.from - p.to);
      const double longer = std::max(p.size(), q.size());
      const bool even = !p.uneven && !q.uneven;
      if (same && even && about_axis_ && p.from == 0) { add_at_axis(p); }
      else if (same && even && !(about_axis_ && 2 * p.from < p.size())) { add_same(p); }
      else if (touches && even && longer <= 2 * std::min(p.size(), q.size()))
      {
         add_neighbours(p, q);
      }
      else if (even && distance >= apart * longer) { add_apart(p, q, distance); }
      else
      {
         // Halves the longer panel, or the uneven one, or both if they are the same.
         const bool of_p = same || (p.uneven == q.uneven ? p.size() >= q.size() : p.uneven);
         const std::vector<Panel> ps = of_p ? p.halves(first_) : std::vector{p},
                                  qs = same || !of_p ? q.halves(second_) : std::vector{q};
         for (const Panel &half : ps)
         {
            for (const Panel &other : qs) { add(half, other); }
         }
      }
   }

   /// Samples at fractions of a panel.
   static Samples samples(const Panel &p, const SurfaceTrace &trace, const VectorXd &fractions,
                          const VectorXd &weights)
   {
      const double length = p.end - p.begin;
      const VectorXd t = p.begin + length * fractions.array();
      SurfacePoints at = trace.points(*p.element, t);
      at.phi *= (length * at.dx.cwiseProduct(weights)).asDiagonal();
      return {std::move(at.x), std::move(at.phi)};
   }
   /// Samples of Gauss's rule. Those of a whole element are kept, those of a part are stored in
   /// `part`.
   const Samples &by_gauss(const Panel &p, int which, int points, Samples &part)
   {
      const SurfaceTrace &trace = which == 0 ? first_ : second_;
      const bool whole = p.begin == 0 && p.end == 1;
      Samples &made = whole ? whole_[which][p.element - trace.elements().data()][points] : part;
      if (made.x.size() == 0)
      {
         const QuadratureRule &rule = gauss_rule(points);
         made = samples(p, trace, rule.points, rule.weights);
      }
      return made;
   }

   /// Number of points of Gauss's rule for a singularity at a distance from a panel. Its error
   /// falls as ρ^(-2 points), where ρ is the sum of the half axes of the ellipse through the
   /// singularity.
   static int points_for(const Panel &p, double distance)
   {
      const double reach = 1 + 2 * distance / p.size();
      const double rho = reach + std::sqrt(reach * reach - 1);
      return static_cast<int>(p.element->order()) + 2 + static_cast<int>(8.5 / std::log10(rho));
   }
   void add_apart(const Panel &p, const Panel &q, double distance)
   {
      const int np = points_for(p, distance), nq = points_for(q, distance);
      Samples of_p, of_q;
      const Samples &x = by_gauss(p, 0, np, of_p), &s = by_gauss(q, 1, nq, of_q);
      const double xp = p.element->x[0], sq = q.element->x[0];
      std::vector<MatrixXd> G(values_.size(), MatrixXd(np, nq));
      for (Index l = 0; l < nq; ++l)
      {
         for (Index k = 0; k < np; ++k)
         {
            kernels_(std::abs(xp - sq + (x.x[k] - s.x[l])), xp + x.x[k], sq + s.x[l],
                     values_.data());
            for (std::size_t m = 0; m < G.size(); ++m) { G[m](k, l) = values_[m]; }
         }
      }
      for (std::size_t m = 0; m < G.size(); ++m)
      {
         blocks_[m].noalias() += x.phi * G[m] * s.phi.transpose();
      }
   }

   /// A pair of points as fractions x and s of two panels. x_by is the distance of x from the
   /// place where both would meet, as a fraction of the first panel, and s_by is that of s, of
   /// the second panel.
   struct Pair
   {
      double x, s, weight, x_by, s_by;
   };
   struct Pairs
   {
      VectorXd x, s, weights, x_by, s_by;
   };
   /// All pairs of points of two rules.
   template <class Place>
   static Pairs pairs(const QuadratureRule &a, const QuadratureRule &b, Place place)
   {
      const Index n = a.points.size(), m = b.points.size();
      VectorXd none(n * m);
      Pairs all{none, none, none, none, none};
      for (Index k = 0; k < n * m; ++k)
      {
         const Index i = k / m, j = k % m;
         const Pair one = place(a.points[i], b.points[j]);
         all.x[k] = one.x;
         all.s[k] = one.s;
         all.weights[k] = one.weight * a.weights[i] * b.weights[j];
         all.x_by[k] = one.x_by;
         all.s_by[k] = one.s_by;
      }
      return all;
   }
   /// Lengths between points of a panel whose fractions differ by `by`, to round-off however
   /// small that is. A length is the mean slope, whose degree is order - 1, times the
   /// difference.
   static VectorXd lengths(const Panel &p, const SurfaceTrace &trace, const VectorXd &from,
                           const VectorXd &to, const VectorXd &by)
   {
      const double length = p.end - p.begin;
      const QuadratureRule &rule = gauss_rule(static_cast<int>(p.element->order() / 2 + 1));
      VectorXd slope = VectorXd::Zero(from.size());
      for (Index k = 0; k < rule.points.size(); ++k)
      {
         const VectorXd between = from + rule.points[k] * (to - from);
         const VectorXd t = p.begin + length * between.array();
         slope += rule.weights[k] * trace.points(*p.element, t).dx;
      }
      return length * slope.cwiseProduct(by);
   }
   /// Integrals of each kernel over pairs of points.
   std::vector<MatrixXd> integrals(const Panel &p, const Panel &q, const Pairs &pairs,
                                   const VectorXd &distance)
   {
      const Samples x = samples(p, first_, pairs.x, pairs.weights),
                    s = samples(q, second_, pairs.s, VectorXd::Ones(pairs.s.size()));
      MatrixXd G(distance.size(), values_.size());
      for (Index k = 0; k < G.rows(); ++k)
      {
         kernels_(distance[k], p.element->x[0] + x.x[k], q.element->x[0] + s.x[k],
                  values_.data());
         for (Index m = 0; m < G.cols(); ++m) { G(k, m) = values_[m]; }
      }
      std::vector<MatrixXd> all;
      for (Index m = 0; m < G.cols(); ++m)
      {
         all.push_back(x.phi * G.col(m).asDiagonal() * s.phi.transpose());
      }
      return all;
   }
   /// Adds the integrals over the half of a square with s < x, and over the other half, which
   /// is its mirror image.
   void add_halves(const Panel &p, const Pairs &half)
   {
      const std::vector<MatrixXd> one =
         integrals(p, p, half, lengths(p, first_, half.s, half.x, half.x_by));
      for (std::size_t m = 0; m < one.size(); ++m)
      {
         blocks_[m] += one[m] + one[m].transpose();
      }
   }
   void add_same(const Panel &p)
   {
      const auto place = [](double apart_by, double at)
      {
         const double s = at * (1 - apart_by);
         return Pair{s + apart_by, s, 1 - apart_by, apart_by, 0};
      };
      add_halves(p, pairs(logarithmic_rule(), regular_rule(p, p), place));
   }
   /// The same at the axis, with the ratio of s to x as the variable.
   void add_at_axis(const Panel &p)
   {
      const auto place = [](double less, double at) {
         return Pair{at, at * (1 - less), at, at * less, 0};
      };
      add_halves(p, pairs(logarithmic_rule(), regular_rule(p, p), place));
   }
   void add_neighbours(const Panel &p, const Panel &q)
   {
      const double p_end = p.to == q.from ? 1 : 0, q_end = 1 - p_end;
      for (const bool x_farther : {true, false})
      {
         const auto place = [&](double farther, double ratio)
         {
            const double nearer = farther * ratio;
            const double x_by = x_farther ? farther : nearer,
                         s_by = x_farther ? nearer : farther;
            return Pair{std::abs(p_end - x_by), std::abs(q_end - s_by), farther, x_by, s_by};
         };
         const Pairs all = pairs(logarithmic_rule(), regular_rule(p, q), place);
         const VectorXd ends = VectorXd::Ones(all.x.size());
         const std::vector<MatrixXd> one =
            integrals(p, q, all,
                      lengths(p, first_, p_end * ends, all.x, all.x_by) +
                         lengths(q, second_, q_end * ends, all.s, all.s_by));
         for (std::size_t m = 0; m < one.size(); ++m) { blocks_[m] += one[m]; }
      }
   }
};

/// The arithmetic-geometric mean of r + s and |r - s|, and the sum Σ 2ⁿ⁻¹ c_n², n = 1, 2, …, of
/// the differences on the way.
struct ArithmeticGeometricMean
{
   double mean, differences = 0;

   ArithmeticGeometricMean(double distance, double r, double s)
   {
      double a = r + s, b = distance, c = std::min(r, s);
      double factor = 1;
      do {
         // a and b become their means. The next c is (a - b)/2, which is computed as c²/4a with
         // the new a, without a difference of large numbers.
         differences += factor * c * c;
         const double next = 0.5 * (a + b);
         b = std::sqrt(a * b);
         a = next;
         c *= 0.5 * c / (a + b);
         factor *= 2;
      } while (c > 1e-9 * a);
      mean = 0.5 * (a + b);
   }
};

} // namespace

MatrixXd kernel_integrals(const SurfaceTrace &first, const SurfaceTrace &second,
                          const SurfaceKernel &kernel)
{
   const auto value = [&](double distance, double x, double s, double *values)
   { *values = kernel.value(distance, x, s); };
   return Integrals(first, second, 1, kernel.about_axis, value).all().front();
}

RingIntegrals ring_integrals(const SurfaceTrace &trace)
{
   const auto values = [](double distance, double r, double s, double *values)
   {
      const ArithmeticGeometricMean agm(distance, r, s);
      values[0] = r * s / agm.mean;
      values[1] = 0.5 * agm.differences / agm.mean;
      values[2] = r * s * values[1];
   };
   std::vector<MatrixXd> all = Integrals(trace, trace, 3, true, values).all();
   return {std::move(all[0]), std::move(all[1]), std::move(all[2])};
}

SurfaceKernel logarithm()
{
   return {[](double distance, double, double) { return std::log(distance); }, false};
}

SurfaceKernel ring_even()
{
   return {[](double distance, double r, double s)
           { return r * s / ArithmeticGeometricMean(distance, r, s).mean; },
           true};
}

SurfaceKernel ring_odd()
{
   return {[](double distance, double r, double s)
           {
              const ArithmeticGeometricMean agm(distance, r, s);
              return 0.5 * agm.differences / agm.mean;
           },
           true};
}

} // namespace cattaneo
