#include <cattaneo/algebra/nonlinear_programme.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <string>

namespace cattaneo
{

namespace
{

/** The programme in unknowns of order one, forces over the typical force s of their
    node: x = {θ, ρ, π, t} with ρ = r / s, π = M r / s and, with two tangential components only,
    t = (f p + strength) / s of every cone.

    π as unknowns tied by one dense equation keep the cones sparse however many load vertices
    there are; an uncoupled problem has none. One component: the two rows t ± q ≥ 0 of a linear
    programme. Two: t - |q|²/t ≥ 0, which is convex and smooth for t > 0, where the bound t ≥ 0
    keeps it; |q| itself has no derivative at the tip, where limits by separation lie. */
class ConeNlp : public NonlinearProgramme
{
public:
   ConeNlp(const ConeProgramme &programme, const ConeSettings &settings, const ConeStart &from)
      : programme(programme), settings(settings), from(from), n(programme.nodes()),
        c(programme.components()), m(n * c), columns(programme.loads.vertices()),
        cones(n * columns), rigid(programme.residual->rigid.cols()),
        coupled(!programme.residual->uncoupled), disc(c == 2),
        tangential(programme.pressure_only ? 0 : 1), first_pi(1 + m),
        first_t(first_pi + (coupled ? n : 0)), first_balance(coupled ? n : 0),
        first_definition(first_balance + rigid),
        first_cone(first_definition + (disc ? cones : 0))
   {
      // Scales all forces by the typical force of their node, and θ by its own scale.
      const Eigen::VectorXd inverse = programme.force_scale.cwiseInverse();
      const Eigen::VectorXd inverse_q = inverse.replicate(c, 1);
      const double unit = programme.theta_scale;
      q0 = inverse_q.asDiagonal() * programme.loads.q0;
      q1 = inverse_q.asDiagonal() * programme.loads.q1 * unit;
      const Eigen::MatrixXd p0 = inverse.asDiagonal() * programme.loads.p0,
                            p1 = inverse.asDiagonal() * programme.loads.p1 * unit;
      bound0 = programme.friction.cwiseProduct(p0);
      bound1 = programme.friction.cwiseProduct(p1);
      if (programme.strength0.size()) { bound0 += inverse.asDiagonal() * programme.strength0; }
      if (programme.strength1.size())
      {
         bound1 += inverse.asDiagonal() * programme.strength1 * unit;
      }
      skew = Eigen::MatrixXd::Zero(n, columns);
      if (programme.skew.size())
      {
         skew = programme.skew;
         q0 += skew.cwiseProduct(p0);
         q1 += skew.cwiseProduct(p1);
      }
      if (coupled)
      {
         transfer = inverse.asDiagonal() * programme.residual->transfer *
                    inverse_q.cwiseInverse().asDiagonal();
      }
      balance = programme.residual->rigid.transpose() * inverse_q.cwiseInverse().asDiagonal();
      for (Eigen::Index k = 0; k < rigid; ++k) { balance.row(k).normalize(); }
   }

   Sizes sizes() const override
   {
      const Eigen::Index pi = coupled ? 1 : 0;
      return {first_t + (disc ? cones : 0), first_cone + (disc ? 1 : 2) * cones,
              pi * n * (m + 1) + rigid * m + cones * (disc ? (2 + pi) + 4 : 2 * (2 + pi)),
              disc ? 1 + 4 * n + 4 * cones : 0};
   }

   Bounds bounds() const override
   {
      const Sizes all = sizes();
      const double none = 2e19; // what Ipopt takes for infinite
      Bounds made{Eigen::VectorXd::Constant(all.variables, -none),
                  Eigen::VectorXd::Constant(all.variables, none),
                  Eigen::VectorXd::Zero(all.conditions), Eigen::VectorXd::Zero(all.conditions)};
      // θ has a ceiling, so that an unlimited load does not run away.
      made.high[0] = programme.ceiling;
      for (Eigen::Index k = 0; k < m; ++k)
      {
         const double s = programme.force_scale[k % n];
         made.low[1 + k] = programme.r_low.size() ? programme.r_low[k] / s : -programme.reach;
         made.high[1 + k] = programme.r_high.size() ? programme.r_high[k] / s : programme.reach;
      }
      made.low.tail(all.variables - first_t).setZero();
      // Balance and definitions are equations. The cones are inequalities with a margin.
      made.least.tail(all.conditions - first_cone).setConstant(settings.margin);
      made.most.tail(all.conditions - first_cone).setConstant(none);
      return made;
   }

   Eigen::VectorXd start() const override
   {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(sizes().variables);
      x[0] = from.theta / programme.theta_scale;
      if (from.r.size())
      {
         x.segment(1, m) = from.r.cwiseQuotient(programme.force_scale.replicate(c, 1));
         if (coupled) { x.segment(first_pi, n) = transfer * x.segment(1, m); }
      }
      for (Eigen::Index k = 0; disc && k < cones; ++k)
      {
         // t is kept away from the tip of its cone, where |q|²/t has no derivative.
         x[first_t + k] = std::max(limit(x.data(), k), 1e-2);
      }
      return x;
   }

   Eigen::VectorXd multipliers() const override
   {
      const ConeMechanism &mechanism = from.mechanism;
      if (mechanism.slip.size() == 0) { return {}; }
      Eigen::VectorXd lambda = Eigen::VectorXd::Zero(sizes().conditions);
      const Eigen::MatrixXd opening = mechanism.opening(programme);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Eigen::Index i = k % n, j = k / n;
         const double unit = programme.force_scale[i] / programme.theta_scale;
         const double y = mechanism.limit(i, j) * unit;
         // The Lagrangian is stationary in π only if the multiplier of its definition is the
         // sum of the openings.
         if (coupled) { lambda[i] += opening(i, j) * unit; }
         if (disc)
         {
            lambda[first_definition + k] = y;
            lambda[first_cone + k] = -0.5 * y;
         }
         else
         {
            lambda[first_cone + 2 * k] = -0.5 * (y + mechanism.slip(i, j) * unit);
            lambda[first_cone + 2 * k + 1] = -0.5 * (y - mechanism.slip(i, j) * unit);
         }
      }
      return lambda;
   }

   bool value(const double *x, double &f) const override
   {
      f = -x[0];
      return true;
   }

   bool gradient(const double *, double *f) const override
   {
      std::fill(f, f + sizes().variables, 0.0);
      f[0] = -1;
      return true;
   }

   bool conditions(const double *x, double *g) const override
   {
      const Eigen::Map<const Eigen::VectorXd> rho(x + 1, m);
      if (coupled)
      {
         Eigen::Map<Eigen::VectorXd>(g, n) =
            Eigen::Map<const Eigen::VectorXd>(x + first_pi, n) - transfer * rho;
      }
      Eigen::Map<Eigen::VectorXd>(g + first_balance, rigid) = balance * rho;
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         if (disc)
         {
            const double t = x[first_t + k];
            g[first_definition + k] = t - limit(x, k);
            g[first_cone + k] = t - shear(x, k).squaredNorm() / t;
         }
         else
         {
            const double t = limit(x, k), q = shear(x, k)[0];
            g[first_cone + 2 * k] = t + q;
            g[first_cone + 2 * k + 1] = t - q;
         }
      }
      return true;
   }

   bool jacobian(const double *x, int *row, int *column, double *values) const override
   {
      // Structure and values are written by the same walk, in the same order.
      Eigen::Index entry = 0;
      const auto put = [&](Eigen::Index r, Eigen::Index k, double value)
      {
         if (values) { values[entry] = value; }
         else
         {
            row[entry] = static_cast<int>(r);
            column[entry] = static_cast<int>(k);
         }
         ++entry;
      };
      for (Eigen::Index i = 0; coupled && i < n; ++i)
      {
         put(i, first_pi + i, 1);
         for (Eigen::Index k = 0; k < m; ++k) { put(i, 1 + k, -transfer(i, k)); }
      }
      for (Eigen::Index r = 0; r < rigid; ++r)
      {
         for (Eigen::Index k = 0; k < m; ++k) { put(first_balance + r, 1 + k, balance(r, k)); }
      }
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Eigen::Index i = k % n, j = k / n;
         const double f = programme.friction(i, j);
         if (disc)
         {
            // The definition of t: t - f p - strength = 0.
            put(first_definition + k, first_t + k, 1);
            put(first_definition + k, 0, -bound1(i, j));
            if (coupled) { put(first_definition + k, first_pi + i, -f); }
            const Eigen::Vector2d u =
               values ? Eigen::Vector2d(shear(x, k) / x[first_t + k]) : Eigen::Vector2d::Zero();
            put(first_cone + k, first_t + k, 1 + u.squaredNorm());
            put(first_cone + k, 0, -2 * (u[0] * q1(i, j) + u[1] * q1(n + i, j)));
            put(first_cone + k, 1 + i, -2 * u[0] * tangential);
            put(first_cone + k, 1 + n + i, -2 * u[1] * tangential);
            continue;
         }
         for (const int side : {0, 1})
         {
            const double sign = side == 0 ? 1 : -1;
            put(first_cone + 2 * k + side, 0, bound1(i, j) + sign * q1(i, j));
            put(first_cone + 2 * k + side, 1 + i, sign * tangential);
            if (coupled)
            {
               put(first_cone + 2 * k + side, first_pi + i, f + sign * skew(i, j));
            }
         }
      }
      return true;
   }

   bool hessian(const double *x, const double *lambda, int *row, int *column,
                double *values) const override
   {
      if (!disc) { return true; }
      if (!values)
      {
         Eigen::Index entry = 0;
         const auto put = [&](Eigen::Index r, Eigen::Index k)
         {
            row[entry] = static_cast<int>(r);
            column[entry++] = static_cast<int>(k);
         };
         put(0, 0);
         for (Eigen::Index i = 0; i < n; ++i)
         {
            put(1 + i, 0);
            put(1 + n + i, 0);
            put(1 + i, 1 + i);
            put(1 + n + i, 1 + n + i);
         }
         for (Eigen::Index k = 0; k < cones; ++k)
         {
            put(first_t + k, 0);
            put(first_t + k, 1 + k % n);
            put(first_t + k, 1 + n + k % n);
            put(first_t + k, first_t + k);
         }
         return true;
      }
      std::fill(values, values + 1 + 4 * n, 0.0);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         // The second derivatives of |q|²/t are 2/t in q, -2 q/t² mixed, 2 |q|²/t³ in t.
         const Eigen::Index i = k % n, j = k / n;
         const double t = x[first_t + k], weight = -lambda[first_cone + k] * 2 / t;
         const Eigen::Vector2d u = shear(x, k) / t, by_theta(q1(i, j), q1(n + i, j));
         values[0] += weight * by_theta.squaredNorm();
         double *own = values + 1 + 4 * i;
         own[0] += weight * tangential * by_theta[0];
         own[1] += weight * tangential * by_theta[1];
         own[2] += weight * tangential;
         own[3] += weight * tangential;
         double *with_t = values + 1 + 4 * n + 4 * k;
         with_t[0] = -weight * u.dot(by_theta);
         with_t[1] = -weight * tangential * u[0];
         with_t[2] = -weight * tangential * u[1];
         with_t[3] = weight * u.squaredNorm();
      }
      return true;
   }

   bool goes_on(int iteration) const override
   {
      return !settings.goes_on || settings.goes_on(iteration);
   }

   /// The limit, the residual forces and the mechanism that a solution stands for.
   ConeSolution found(const ProgrammeSolution &point) const
   {
      ConeSolution solution;
      solution.iterations = point.iterations;
      if (point.x.size() == 0) { return solution; }
      const double *x = point.x.data(), *z_low = point.z_low.data(),
                   *lambda = point.lambda.data();
      const Eigen::VectorXd &s = programme.force_scale;
      solution.theta = x[0] * programme.theta_scale;
      solution.r = Eigen::Map<const Eigen::VectorXd>(x + 1, m).cwiseProduct(s.replicate(c, 1));
      ConeMechanism &mechanism = solution.mechanism;
      mechanism.slip.resize(m, columns);
      mechanism.limit.resize(n, columns);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         // `limit` multiplies the bound of the cone, `slip` multiplies q. Both follow from the
         // multipliers of the rows that contain bound and q.
         const Eigen::Index i = k % n, j = k / n;
         const double unit = programme.theta_scale / s[i];
         double by_limit;
         if (disc)
         {
            const Eigen::Vector2d u = shear(x, k) / x[first_t + k];
            const double y = std::max(0.0, -lambda[first_cone + k]) * unit;
            by_limit = y * (1 + u.squaredNorm()) + std::max(0.0, z_low[first_t + k]) * unit;
            mechanism.slip(i, j) = -2 * y * u[0];
            mechanism.slip(n + i, j) = -2 * y * u[1];
         }
         else
         {
            const double plus = std::max(0.0, -lambda[first_cone + 2 * k]) * unit;
            const double minus = std::max(0.0, -lambda[first_cone + 2 * k + 1]) * unit;
            by_limit = plus + minus;
            mechanism.slip(i, j) = plus - minus;
         }
         mechanism.limit(i, j) = by_limit;
      }
      return solution;
   }

private:
   /// The bound over s of cone k, that is of node k % n in column k / n.
   double limit(const double *x, Eigen::Index k) const
   {
      const Eigen::Index i = k % n, j = k / n;
      const double change = coupled ? x[first_pi + i] : 0.0;
      return bound0(i, j) + x[0] * bound1(i, j) + programme.friction(i, j) * change;
   }

   /// (q + a p) / s of cone k; the second component is zero if there is but one.
   Eigen::Vector2d shear(const double *x, Eigen::Index k) const
   {
      const Eigen::Index i = k % n, j = k / n;
      Eigen::Vector2d q = Eigen::Vector2d::Zero();
      for (Eigen::Index d = 0; d < c; ++d)
      {
         const Eigen::Index row = d * n + i;
         q[d] = q0(row, j) + x[0] * q1(row, j) + tangential * x[1 + row];
      }
      if (coupled) { q[0] += skew(i, j) * x[first_pi + i]; }
      return q;
   }

   const ConeProgramme &programme;
   const ConeSettings &settings;
   const ConeStart &from;
   const Eigen::Index n, c, m, columns, cones, rigid;
   const bool coupled, disc;
   const double tangential; ///< what r does to the tangential forces: 1, or 0 if left out
   /// First unknown π and t; first row of rigidᵀ r = 0, of the definitions of t, of the cones.
   const Eigen::Index first_pi, first_t, first_balance, first_definition, first_cone;
   Eigen::MatrixXd q0, q1, bound0, bound1, skew, transfer, balance;
};

/// One run. A convex programme needs no globalisation of the barrier parameter, and is twice as
/// fast without.
ConeSolution run_once(const ConeProgramme &programme, const ConeSettings &settings,
                      const ConeStart &start)
{
   const ConeNlp cones(programme, settings, start);
   ProgrammeSettings of;
   of.tolerance = settings.tolerance;
   of.max_iterations = settings.max_iterations;
   of.linear_equations = of.convex = true;
   of.linear = programme.components() == 1;
   const ProgrammeSolution point = solve(cones, of);
   ConeSolution solution = cones.found(point);
   solution.message = point.message;
   const double ceiling = programme.ceiling * programme.theta_scale;
   switch (point.outcome)
   {
   case ProgrammeOutcome::solved:
      solution.outcome =
         solution.theta > 0.99 * ceiling ? ConeOutcome::ceiling : ConeOutcome::solved;
      break;
   case ProgrammeOutcome::infeasible:
      solution.outcome = ConeOutcome::infeasible;
      solution.message = "Ipopt found no admissible point";
      break;
   case ProgrammeOutcome::stopped:
      solution.outcome = ConeOutcome::stopped;
      break;
   case ProgrammeOutcome::unavailable:
      solution.outcome = ConeOutcome::unavailable;
      break;
   case ProgrammeOutcome::failed:
      // Ipopt returned a point nevertheless. The caller finds out what it proves.
      solution.outcome = ConeOutcome::failed;
   }
   return solution;
}

} // namespace

ConeSolution solve(const ConeProgramme &programme, const ConeSettings &settings,
                   const ConeStart &start)
{
   if (programme.components() == 2 && programme.r_low.size() == 0)
   {
      ConeSolution found = solve_by_interior_points(programme, settings, start);
      if (found.outcome != ConeOutcome::failed) { return found; }
   }
   ConeSolution solution = run_once(programme, settings, start);
   const bool failed =
      solution.outcome == ConeOutcome::failed || solution.outcome == ConeOutcome::infeasible;
   // The multipliers of an earlier solution can lead the search astray. Without them the same
   // programme may be solved.
   if (failed && start.mechanism.slip.size() > 0)
   {
      const int spent = solution.iterations;
      solution = run_once(programme, settings, {start.theta, start.r, {}});
      solution.iterations += spent;
   }
   return solution;
}

} // namespace cattaneo
