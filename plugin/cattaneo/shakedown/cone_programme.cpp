#include <cattaneo/input_error.hpp>
#include <cattaneo/shakedown/cone_programme.hpp>
#include <cmath>
#include <limits>

#ifdef CATTANEO_USE_IPOPT
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#endif

namespace cattaneo
{

namespace
{

/// Length of the tangential force of node @a i, whose components are n apart.
double length(const Eigen::Ref<const Eigen::VectorXd> &q, Eigen::Index i, Eigen::Index n)
{
   return q.size() == n ? std::abs(q[i]) : std::hypot(q[i], q[n + i]);
}

} // namespace

double worst_violation(const ConeProgramme &programme, const ReducedProblem &problem,
                       double theta, const Eigen::VectorXd &slip)
{
   const Eigen::Index n = programme.nodes();
   const Eigen::MatrixXd q =
      programme.loads.q(theta).colwise() + Eigen::VectorXd(problem.A * slip);
   const Eigen::MatrixXd p =
      programme.loads.p(theta).colwise() + Eigen::VectorXd(problem.B * slip);
   double worst = -std::numeric_limits<double>::infinity();
   for (Eigen::Index j = 0; j < q.cols(); ++j)
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         const double excess = length(q.col(j), i, n) - programme.friction[i] * p(i, j);
         worst = std::max(worst, excess / programme.force_scale[i]);
      }
   }
   return worst;
}

double weak_duality_bound(const ConeProgramme &programme, const ReducedProblem &problem,
                          Mechanism &mechanism, double slip_size)
{
   constexpr double none = std::numeric_limits<double>::infinity();
   const Eigen::Index n = programme.nodes(), c = programme.components();
   const Eigen::Index vertices = programme.loads.vertices();
   Eigen::MatrixXd &slip = mechanism.slip;
   Eigen::MatrixXd &opening = mechanism.opening;
   if (slip.cols() != vertices || !slip.allFinite() || !opening.allFinite()) { return none; }

   Eigen::VectorXd imbalance;
   const auto excess = [&](Eigen::Index i, Eigen::Index j)
   { return programme.friction[i] * length(slip.col(j), i, n) - opening(i, j); };

   // Either step disturbs what the other one mends: the added slip needs opening, and opening
   // that is not a free motion of the bodies needs slip. They shrink by friction times
   // coupling.
   constexpr int max_rounds = 100;
   for (int round = 0; round < max_rounds; ++round)
   {
      const Eigen::VectorXd total_opening = opening.rowwise().sum();
      imbalance = problem.A * slip.rowwise().sum() + problem.B.transpose() * total_opening;
      const Eigen::VectorXd correction = -(programme.residual->flexibility * imbalance);
      double lack = 0;
      Eigen::VectorXd lacks = Eigen::VectorXd::Zero(n);
      for (Eigen::Index i = 0; i < n; ++i)
      {
         // Where the node has most room, so that few corrections need any opening.
         Eigen::Index j = 0;
         for (Eigen::Index k = 1; k < vertices; ++k)
         {
            if (excess(i, k) < excess(i, j)) { j = k; }
         }
         for (Eigen::Index k = 0; k < c; ++k) { slip(k * n + i, j) += correction[k * n + i]; }
         for (j = 0; j < vertices; ++j) { lacks[i] = std::max(lacks[i], excess(i, j)); }
         lack = std::max(lack, lacks[i]);
      }
      const double size = opening.cwiseAbs().maxCoeff();
      if (!(lack < 1e6 * size)) { return none; }
      if (lack <= 0) { break; }
      if (programme.residual->opens_freely) { opening.array() += lack * (1 + 1e-12); }
      else { opening.colwise() += lacks * (1 + 1e-12); }
   }
   for (Eigen::Index j = 0; j < vertices; ++j)
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         if (excess(i, j) > 0) { return none; }
      }
   }
   imbalance =
      problem.A * slip.rowwise().sum() + problem.B.transpose() * opening.rowwise().sum();

   const StuckForces &loads = programme.loads;
   const double w0 = opening.cwiseProduct(loads.p0).sum() + slip.cwiseProduct(loads.q0).sum();
   const double w1 = opening.cwiseProduct(loads.p1).sum() + slip.cwiseProduct(loads.q1).sum();
   if (!(w1 < 0)) { return none; }
   slip /= -w1;
   opening /= -w1;
   return (w0 + imbalance.lpNorm<1>() * slip_size) / -w1;
}

#ifdef CATTANEO_USE_IPOPT

namespace
{

using Ipopt::Index;
using Ipopt::Number;

/** The programme for Ipopt in unknowns of order one: x = {θ / scale, ρ, π} with ρ = r / s and
    π = M r / s, s the typical force of the node. π as unknowns tied by one dense equation keep
   the cone constraints sparse however many load vertices there are (NUMERICS: the Jacobian
   would otherwise be dense once per vertex). An uncoupled problem has no π. */
class ConeNlp : public Ipopt::TNLP
{
public:
   ConeNlp(const ConeProgramme &programme, const ConeSettings &settings, const ConeStart &start)
      : programme(programme), settings(settings), start(start), n(programme.nodes()),
        c(programme.components()), m(n * c), vertices(programme.loads.vertices()),
        rigid(programme.residual->rigid.cols()), coupled(!programme.residual->uncoupled)
   {
      const Eigen::VectorXd inverse = programme.force_scale.cwiseInverse();
      const Eigen::VectorXd inverse_q = inverse.replicate(c, 1);
      const double t = programme.theta_scale;
      q0 = inverse_q.asDiagonal() * programme.loads.q0;
      q1 = inverse_q.asDiagonal() * programme.loads.q1 * t;
      p0 = inverse.asDiagonal() * programme.loads.p0;
      p1 = inverse.asDiagonal() * programme.loads.p1 * t;
      if (coupled)
      {
         transfer = inverse.asDiagonal() * programme.residual->transfer *
                    inverse_q.cwiseInverse().asDiagonal();
      }
      balance = programme.residual->rigid.transpose() * inverse_q.cwiseInverse().asDiagonal();
      for (Eigen::Index k = 0; k < rigid; ++k) { balance.row(k).normalize(); }
      tangential = programme.pressure_only ? 0 : 1;
      equalities = (coupled ? n : 0) + rigid;
      cones = n * vertices;
   }

   ConeSolution solution;

   bool get_nlp_info(Index &variables, Index &constraints, Index &jacobian, Index &hessian,
                     IndexStyleEnum &style) override
   {
      variables = static_cast<Index>(1 + m + (coupled ? n : 0));
      constraints = static_cast<Index>(equalities + rows_per_cone() * cones);
      const Eigen::Index cone_entries = 1 + c + (coupled ? 1 : 0);
      jacobian = static_cast<Index>((coupled ? n * (m + 1) : 0) + rigid * m +
                                    rows_per_cone() * cones * cone_entries);
      hessian = static_cast<Index>(c == 1 ? 0 : 1 + 5 * n);
      style = TNLP::C_STYLE;
      return true;
   }

   bool get_bounds_info(Index, Number *x_low, Number *x_high, Index constraints, Number *g_low,
                        Number *g_high) override
   {
      const double none = 2e19; // what Ipopt takes for infinite
      x_low[0] = -none;
      x_high[0] = programme.ceiling;
      for (Eigen::Index k = 0; k < m; ++k)
      {
         const double s = programme.force_scale[k % n];
         x_low[1 + k] = programme.r_low.size() ? programme.r_low[k] / s : -none;
         x_high[1 + k] = programme.r_high.size() ? programme.r_high[k] / s : none;
      }
      for (Eigen::Index i = 0; coupled && i < n; ++i)
      {
         x_low[1 + m + i] = -none;
         x_high[1 + m + i] = none;
      }
      std::fill(g_low, g_low + equalities, 0.0);
      std::fill(g_high, g_high + equalities, 0.0);
      std::fill(g_low + equalities, g_low + constraints, settings.margin);
      std::fill(g_high + equalities, g_high + constraints, none);
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
         if (coupled) { Eigen::Map<Eigen::VectorXd>(x + 1 + m, n) = transfer * rho; }
      }
      if (init_z)
      {
         std::fill(z_low, z_low + variables, 0.0);
         std::fill(z_high, z_high + variables, 0.0);
      }
      if (init_lambda)
      {
         std::fill(lambda, lambda + constraints, 0.0);
         const Mechanism &mechanism = start.mechanism;
         const Eigen::VectorXd &s = programme.force_scale;
         for (Eigen::Index j = 0; j < vertices; ++j)
         {
            for (Eigen::Index i = 0; i < n; ++i)
            {
               const double y = mechanism.opening(i, j) / programme.friction[i];
               const double unit = s[i] / programme.theta_scale;
               Number *row = lambda + equalities + rows_per_cone() * (j * n + i);
               if (c == 1)
               {
                  row[0] = -0.5 * (y + mechanism.slip(i, j)) * unit;
                  row[1] = -0.5 * (y - mechanism.slip(i, j)) * unit;
               }
               else { row[0] = -y * unit; }
               // Stationary in π, the multiplier of its definition is what the cones press.
               if (coupled) { lambda[i] += mechanism.opening(i, j) * unit; }
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
      Eigen::Map<Eigen::VectorXd> values(g, equalities);
      if (coupled)
      {
         values.head(n) = Eigen::Map<const Eigen::VectorXd>(x + 1 + m, n) - transfer * rho;
      }
      values.tail(rigid) = balance * rho;
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Cone cone(*this, x, k);
         Number *row = g + equalities + rows_per_cone() * k;
         if (c == 1)
         {
            row[0] = cone.limit + cone.q[0];
            row[1] = cone.limit - cone.q[0];
         }
         else { row[0] = cone.limit - cone.length; }
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
         put(i, 1 + m + i, 1);
         for (Eigen::Index k = 0; k < m; ++k) { put(i, 1 + k, -transfer(i, k)); }
      }
      for (Eigen::Index r = 0; r < rigid; ++r)
      {
         for (Eigen::Index k = 0; k < m; ++k)
         {
            put(equalities - rigid + r, 1 + k, balance(r, k));
         }
      }
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Eigen::Index i = k % n, j = k / n;
         Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
         if (values && c == 2)
         {
            const Cone cone(*this, x, k);
            direction = cone.q / cone.length;
         }
         for (int side = 0; side < rows_per_cone(); ++side)
         {
            // One component: limit + q, then limit - q; two: limit - |q|.
            const double sign = c == 1 && side == 0 ? 1 : -1;
            const Eigen::Index r = equalities + rows_per_cone() * k + side;
            double by_theta = programme.friction[i] * p1(i, j);
            for (Eigen::Index d = 0; d < c; ++d)
            {
               by_theta += sign * direction[d] * q1(d * n + i, j);
            }
            put(r, 0, by_theta);
            for (Eigen::Index d = 0; d < c; ++d)
            {
               put(r, 1 + d * n + i, sign * direction[d] * tangential);
            }
            if (coupled) { put(r, 1 + m + i, programme.friction[i]); }
         }
      }
      return true;
   }

   bool eval_h(Index, const Number *x, bool, Number, Index, const Number *lambda, bool, Index,
               Index *row, Index *column, Number *values) override
   {
      if (c == 1) { return true; }
      if (!values)
      {
         row[0] = column[0] = 0;
         Eigen::Index entry = 1;
         const auto put = [&](Eigen::Index r, Eigen::Index k)
         {
            row[entry] = static_cast<Index>(r);
            column[entry++] = static_cast<Index>(k);
         };
         for (Eigen::Index i = 0; i < n; ++i)
         {
            put(1 + i, 0);
            put(1 + n + i, 0);
            put(1 + i, 1 + i);
            put(1 + n + i, 1 + i);
            put(1 + n + i, 1 + n + i);
         }
         return true;
      }
      std::fill(values, values + 1 + 5 * n, 0.0);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Eigen::Index i = k % n, j = k / n;
         const Cone cone(*this, x, k);
         const Eigen::Vector2d u = cone.q / cone.length;
         const Eigen::Matrix2d curvature = -lambda[equalities + k] *
                                           (Eigen::Matrix2d::Identity() - u * u.transpose()) /
                                           cone.length;
         const Eigen::Vector2d by_theta(q1(i, j), q1(n + i, j));
         const Eigen::Vector2d mixed = tangential * curvature * by_theta;
         Number *own = values + 1 + 5 * i;
         values[0] += by_theta.dot(curvature * by_theta);
         own[0] += mixed[0];
         own[1] += mixed[1];
         own[2] += tangential * curvature(0, 0);
         own[3] += tangential * curvature(1, 0);
         own[4] += tangential * curvature(1, 1);
      }
      return true;
   }

   void finalize_solution(Ipopt::SolverReturn, Index, const Number *x, const Number *,
                          const Number *, Index, const Number *, const Number *lambda, Number,
                          const Ipopt::IpoptData *, Ipopt::IpoptCalculatedQuantities *) override
   {
      solution.theta = x[0] * programme.theta_scale;
      const Eigen::VectorXd &s = programme.force_scale;
      solution.r = Eigen::Map<const Eigen::VectorXd>(x + 1, m).cwiseProduct(s.replicate(c, 1));
      Mechanism &mechanism = solution.mechanism;
      mechanism.slip.resize(m, vertices);
      mechanism.opening.resize(n, vertices);
      for (Eigen::Index k = 0; k < cones; ++k)
      {
         const Eigen::Index i = k % n, j = k / n;
         const Number *row = lambda + equalities + rows_per_cone() * k;
         const double unit = programme.theta_scale / s[i];
         if (c == 1)
         {
            const double plus = std::max(0.0, -row[0]), minus = std::max(0.0, -row[1]);
            mechanism.slip(i, j) = (plus - minus) * unit;
            mechanism.opening(i, j) = programme.friction[i] * (plus + minus) * unit;
         }
         else
         {
            const double y = std::max(0.0, -row[0]);
            const Cone cone(*this, x, k);
            for (Eigen::Index d = 0; d < 2; ++d)
            {
               mechanism.slip(d * n + i, j) = -y * cone.q[d] / cone.length * unit;
            }
            mechanism.opening(i, j) = programme.friction[i] * y * unit;
         }
      }
   }

private:
   /// The cone of node k % n at vertex k / n: tangential force and friction limit, over s.
   struct Cone
   {
      Eigen::Vector2d q = Eigen::Vector2d::Zero();
      double limit;
      double length; ///< |q|, rounded off at the tip from outside: still on the safe side

      Cone(const ConeNlp &nlp, const Number *x, Eigen::Index k)
      {
         const Eigen::Index n = nlp.n, i = k % n, j = k / n;
         const double theta = x[0];
         for (Eigen::Index d = 0; d < nlp.c; ++d)
         {
            q[d] = nlp.q0(d * n + i, j) + theta * nlp.q1(d * n + i, j) +
                   nlp.tangential * x[1 + d * n + i];
         }
         const double change = nlp.coupled ? x[1 + nlp.m + i] : 0.0;
         limit = nlp.programme.friction[i] * (nlp.p0(i, j) + theta * nlp.p1(i, j) + change);
         constexpr double tip = 1e-6; // changes |q| of order one by 5e-13
         length = std::sqrt(q.squaredNorm() + tip * tip);
      }
   };

   int rows_per_cone() const { return c == 1 ? 2 : 1; }

   const ConeProgramme &programme;
   const ConeSettings &settings;
   const ConeStart &start;
   const Eigen::Index n, c, m, vertices, rigid;
   const bool coupled;
   double tangential = 1;
   Eigen::Index equalities = 0, cones = 0;
   Eigen::MatrixXd q0, q1, p0, p1, transfer, balance;
};

/// One run of Ipopt. A convex programme needs no globalisation of the barrier parameter, and is
/// twice as fast without; @a careful adds it.
ConeSolution run_ipopt(const ConeProgramme &programme, const ConeSettings &settings,
                       const ConeStart &start, bool careful)
{
   using namespace Ipopt;
   SmartPtr<ConeNlp> nlp = new ConeNlp(programme, settings, start);
   SmartPtr<IpoptApplication> app = IpoptApplicationFactory();
   const SmartPtr<OptionsList> options = app->Options();
   options->SetIntegerValue("print_level", 0);
   options->SetStringValue("sb", "yes");
   for (const char *tolerance : {"tol", "constr_viol_tol", "dual_inf_tol", "compl_inf_tol"})
   {
      options->SetNumericValue(tolerance, settings.tolerance);
   }
   options->SetIntegerValue("acceptable_iter", 0);
   options->SetIntegerValue("max_iter", settings.max_iterations);
   options->SetNumericValue("bound_relax_factor", 0);
   options->SetStringValue("nlp_scaling_method", "none");
   options->SetStringValue("jac_c_constant", "yes");
   if (programme.components() == 1)
   {
      options->SetStringValue("jac_d_constant", "yes");
      options->SetStringValue("hessian_constant", "yes");
   }
   options->SetStringValue("mu_strategy", careful ? "monotone" : "adaptive");
   options->SetStringValue("adaptive_mu_globalization", "never-monotone-mode");
   if (start.mechanism.slip.size())
   {
      options->SetStringValue("warm_start_init_point", "yes");
      options->SetNumericValue("mu_init", 1e-4);
   }
   // An empty file name: otherwise the options of a file ipopt.opt in the working directory
   // rule.
   ApplicationReturnStatus status = app->Initialize("");
   if (status == Solve_Succeeded) { status = app->OptimizeTNLP(nlp); }

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
   ConeSolution solution = run_ipopt(programme, settings, start, false);
   if (solution.outcome == ConeOutcome::failed || solution.outcome == ConeOutcome::infeasible)
   {
      const int spent = solution.iterations;
      solution = run_ipopt(programme, settings, {start.theta, start.r, {}}, true);
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
