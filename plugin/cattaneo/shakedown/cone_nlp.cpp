#include <cattaneo/algebra/ipopt.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <string>

namespace cattaneo
{

#ifdef CATTANEO_USE_IPOPT

namespace
{

/** The programme for Ipopt in unknowns of order one, forces over the typical force s of their
    node: x = {θ, ρ, π, t} with ρ = r / s, π = M r / s and, with two tangential components only,
    t = (f p + strength) / s of every cone.

    π as unknowns tied by one dense equation keep the cones sparse however many load vertices
    there are; an uncoupled problem has none. One component: the two rows t ± q ≥ 0 of a linear
    programme. Two: t - |q|²/t ≥ 0, which is convex and smooth for t > 0, where the bound t ≥ 0
    keeps it; |q| itself has no derivative at the tip, where limits by separation lie. */
class ConeNlp : public Ipopt::TNLP
{
   using Index = Ipopt::Index;
   using Number = Ipopt::Number;

public:
   ConeNlp(const ConeProgramme &programme, const ConeSettings &settings, const ConeStart &start)
      : programme(programme), settings(settings), start(start), n(programme.nodes()),
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

   ConeSolution solution;

   bool get_nlp_info(Index &variables, Index &constraints, Index &jacobian, Index &hessian,
                     IndexStyleEnum &style) override
   {
      const Eigen::Index pi = coupled ? 1 : 0;
      variables = static_cast<Index>(first_t + (disc ? cones : 0));
      constraints = static_cast<Index>(first_cone + (disc ? 1 : 2) * cones);
      jacobian = static_cast<Index>(pi * n * (m + 1) + rigid * m +
                                    cones * (disc ? (2 + pi) + 4 : 2 * (2 + pi)));
      hessian = static_cast<Index>(disc ? 1 + 4 * n + 4 * cones : 0);
      style = TNLP::C_STYLE;
      return true;
   }

   bool get_bounds_info(Index variables, Number *x_low, Number *x_high, Index constraints,
                        Number *g_low, Number *g_high) override
   {
      const double none = 2e19; // what Ipopt takes for infinite
      std::fill(x_low, x_low + variables, -none);
      std::fill(x_high, x_high + variables, none);
      // θ has a ceiling, so that an unlimited load does not run away.
      x_high[0] = programme.ceiling;
      for (Eigen::Index k = 0; k < m; ++k)
      {
         const double s = programme.force_scale[k % n];
         x_low[1 + k] = programme.r_low.size() ? programme.r_low[k] / s : -programme.reach;
         x_high[1 + k] = programme.r_high.size() ? programme.r_high[k] / s : programme.reach;
      }
      std::fill(x_low + first_t, x_low + variables, 0.0);
      // Balance and definitions are equations. The cones are inequalities with a margin.
      std::fill(g_low, g_low + first_cone, 0.0);
      std::fill(g_high, g_high + first_cone, 0.0);
      std::fill(g_low + first_cone, g_low + constraints, settings.margin);
      std::fill(g_high + first_cone, g_high + constraints, none);
      return true;
   }

   bool get_starting_point(Index variables, bool, Number *x, bool init_z, Number *z_low,
                           Number *z_high, Index constraints, bool init_lambda,
                           Number *lambda) override
   {
      std::fill(x, x + variables, 0.0);
      x[0] = start.theta / programme.theta_scale;
      if (start.r.size())
      {
         Eigen::Map<Eigen::VectorXd> rho(x + 1, m);
         rho = start.r.cwiseQuotient(programme.force_scale.replicate(c, 1));
         if (coupled) { Eigen::Map<Eigen::VectorXd>(x + first_pi, n) = transfer * rho; }
      }
      for (Eigen::Index k = 0; disc && k < cones; ++k)
      {
         // t is kept away from the tip of its cone, where |q|²/t has no derivative.
         x[first_t + k] = std::max(limit(x, k), 1e-2);
      }
      if (init_z)
      {
         std::fill(z_low, z_low + variables, 0.0);
         std::fill(z_high, z_high + variables, 0.0);
      }
      if (init_lambda)
      {
         std::fill(lambda, lambda + constraints, 0.0);
         const ConeMechanism &mechanism = start.mechanism;
         const Eigen::MatrixXd opening = mechanism.opening(programme);
         for (Eigen::Index k = 0; k < cones; ++k)
         {
            const Eigen::Index i = k % n, j = k / n;
            const double unit = programme.force_scale[i] / programme.theta_scale;
            const double y = mechanism.limit(i, j) * unit;
            // Stationary in π, the multiplier of its definition is what the cones press.
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
      }
      return true;
   }

   bool eval_f(Index, const Number *x, bool, Number &value) override
   {
      value = -x[0];
      return true;
   }

   bool eval_grad_f(Index variables, const Number *, bool, Number *gradient) override
   {
      std::fill(gradient, gradient + variables, 0.0);
      gradient[0] = -1;
      return true;
   }

   bool eval_g(Index, const Number *x, bool, Index, Number *g) override
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

   bool eval_jac_g(Index, const Number *x, bool, Index, Index, Index *row, Index *column,
                   Number *values) override
   {
      // Structure and values are written by the same walk, in the same order.
      Eigen::Index entry = 0;
      const auto put = [&](Eigen::Index r, Eigen::Index k, double value)
      {
         if (values) { values[entry] = value; }
         else
         {
            row[entry] = static_cast<Index>(r);
            column[entry] = static_cast<Index>(k);
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

   bool eval_h(Index, const Number *x, bool, Number, Index, const Number *lambda, bool, Index,
               Index *row, Index *column, Number *values) override
   {
      if (!disc) { return true; }
      if (!values)
      {
         Eigen::Index entry = 0;
         const auto put = [&](Eigen::Index r, Eigen::Index k)
         {
            row[entry] = static_cast<Index>(r);
            column[entry++] = static_cast<Index>(k);
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
         Number *own = values + 1 + 4 * i;
         own[0] += weight * tangential * by_theta[0];
         own[1] += weight * tangential * by_theta[1];
         own[2] += weight * tangential;
         own[3] += weight * tangential;
         Number *with_t = values + 1 + 4 * n + 4 * k;
         with_t[0] = -weight * u.dot(by_theta);
         with_t[1] = -weight * tangential * u[0];
         with_t[2] = -weight * tangential * u[1];
         with_t[3] = weight * u.squaredNorm();
      }
      return true;
   }

   bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number,
                              Number, Number, Number, Number, Number, Index,
                              const Ipopt::IpoptData *,
                              Ipopt::IpoptCalculatedQuantities *) override
   {
      return !settings.goes_on || settings.goes_on(iteration);
   }

   void finalize_solution(Ipopt::SolverReturn, Index, const Number *x, const Number *z_low,
                          const Number *, Index, const Number *, const Number *lambda, Number,
                          const Ipopt::IpoptData *, Ipopt::IpoptCalculatedQuantities *) override
   {
      const Eigen::VectorXd &s = programme.force_scale;
      solution.theta = x[0] * programme.theta_scale;
      solution.r = Eigen::Map<const Eigen::VectorXd>(x + 1, m).cwiseProduct(s.replicate(c, 1));
      ConeMechanism &mechanism = solution.mechanism;
      mechanism.slip.resize(m, columns);
      mechanism.limit.resize(n, columns);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         // The multipliers of the bound and of q: what each row's multiplier does to them.
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
   }

private:
   /// The bound over s of cone k, that is of node k % n in column k / n.
   double limit(const Number *x, Eigen::Index k) const
   {
      const Eigen::Index i = k % n, j = k / n;
      const double change = coupled ? x[first_pi + i] : 0.0;
      return bound0(i, j) + x[0] * bound1(i, j) + programme.friction(i, j) * change;
   }

   /// (q + a p) / s of cone k; the second component is zero if there is but one.
   Eigen::Vector2d shear(const Number *x, Eigen::Index k) const
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
   const ConeStart &start;
   const Eigen::Index n, c, m, columns, cones, rigid;
   const bool coupled, disc;
   const double tangential; ///< what r does to the tangential forces: 1, or 0 if left out
   /// First unknown π and t; first row of rigidᵀ r = 0, of the definitions of t, of the cones.
   const Eigen::Index first_pi, first_t, first_balance, first_definition, first_cone;
   Eigen::MatrixXd q0, q1, bound0, bound1, skew, transfer, balance;
};

/// One run of Ipopt. A convex programme needs no globalisation of the barrier parameter, and is
/// twice as fast without.
ConeSolution run_ipopt(const ConeProgramme &programme, const ConeSettings &settings,
                       const ConeStart &start)
{
   using namespace Ipopt;
   SmartPtr<ConeNlp> nlp = new ConeNlp(programme, settings, start);
   const SmartPtr<IpoptApplication> app = ipopt(settings.tolerance, settings.max_iterations);
   const SmartPtr<OptionsList> options = app->Options();
   options->SetStringValue("jac_c_constant", "yes");
   if (programme.components() == 1)
   {
      options->SetStringValue("jac_d_constant", "yes");
      options->SetStringValue("hessian_constant", "yes");
   }
   options->SetStringValue("mu_strategy", "adaptive");
   options->SetStringValue("adaptive_mu_globalization", "never-monotone-mode");
   if (start.mechanism.slip.size())
   {
      options->SetStringValue("warm_start_init_point", "yes");
      // The default would push every multiplier up to 1e-3 and spoil most of what is known.
      options->SetNumericValue("warm_start_mult_bound_push", 1e-9);
   }
   const ApplicationReturnStatus status = optimize(*app, nlp);

   ConeSolution solution = nlp->solution;
   const SmartPtr<SolveStatistics> statistics = app->Statistics();
   if (IsValid(statistics)) { solution.iterations = statistics->IterationCount(); }
   const double ceiling = programme.ceiling * programme.theta_scale;
   switch (status)
   {
   case Solve_Succeeded:
      solution.outcome =
         solution.theta > 0.99 * ceiling ? ConeOutcome::ceiling : ConeOutcome::solved;
      break;
   case Infeasible_Problem_Detected:
      solution.outcome = ConeOutcome::infeasible;
      solution.message = "Ipopt found no admissible point";
      break;
   case User_Requested_Stop:
      solution.outcome = ConeOutcome::stopped;
      solution.message = "it was asked to stop";
      break;
   default:
      // A point was returned all the same; what it proves is for the caller to find out.
      solution.outcome = ConeOutcome::failed;
      solution.message = "Ipopt ended with return status " + std::to_string(status);
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
   ConeSolution solution = run_ipopt(programme, settings, start);
   const bool failed =
      solution.outcome == ConeOutcome::failed || solution.outcome == ConeOutcome::infeasible;
   if (failed && start.mechanism.slip.size() > 0) // multipliers that led astray
   {
      const int spent = solution.iterations;
      solution = run_ipopt(programme, settings, {start.theta, start.r, {}});
      solution.iterations += spent;
   }
   return solution;
}

#else

ConeSolution solve(const ConeProgramme &, const ConeSettings &, const ConeStart &)
{
   ConeSolution solution;
   solution.outcome = ConeOutcome::unavailable;
   solution.message = "built without Ipopt (CATTANEO_USE_IPOPT=OFF)";
   return solution;
}

#endif

} // namespace cattaneo
