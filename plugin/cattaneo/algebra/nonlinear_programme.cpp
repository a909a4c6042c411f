#include <cattaneo/algebra/nonlinear_programme.hpp>
#ifdef CATTANEO_USE_IPOPT
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cmath>
#endif

namespace cattaneo
{

#ifdef CATTANEO_USE_IPOPT

namespace
{

/// A programme in Ipopt's interface.
class AskedByIpopt : public Ipopt::TNLP
{
   using Index = Ipopt::Index;
   using Number = Ipopt::Number;

public:
   AskedByIpopt(const NonlinearProgramme &programme, ProgrammeSolution &solution)
      : programme_(programme), solution_(solution)
   {
   }

   bool get_nlp_info(Index &variables, Index &conditions, Index &jacobian, Index &hessian,
                     IndexStyleEnum &style) override
   {
      const NonlinearProgramme::Sizes sizes = programme_.sizes();
      variables = static_cast<Index>(sizes.variables);
      conditions = static_cast<Index>(sizes.conditions);
      jacobian = static_cast<Index>(sizes.jacobian);
      hessian = static_cast<Index>(sizes.hessian);
      style = TNLP::C_STYLE;
      return true;
   }
   bool get_bounds_info(Index, Number *x_low, Number *x_high, Index, Number *c_low,
                        Number *c_high) override
   {
      const NonlinearProgramme::Bounds bounds = programme_.bounds();
      copy(bounds.low, x_low);
      copy(bounds.high, x_high);
      copy(bounds.least, c_low);
      copy(bounds.most, c_high);
      return true;
   }
   bool get_starting_point(Index variables, bool, Number *x, bool init_z, Number *z_low,
                           Number *z_high, Index, bool init_lambda, Number *lambda) override
   {
      copy(programme_.start(), x);
      if (init_z)
      {
         std::fill(z_low, z_low + variables, 0.0);
         std::fill(z_high, z_high + variables, 0.0);
      }
      if (init_lambda) { copy(programme_.multipliers(), lambda); }
      return true;
   }
   bool eval_f(Index, const Number *x, bool, Number &f) override
   {
      return programme_.value(x, f);
   }
   bool eval_grad_f(Index, const Number *x, bool, Number *f) override
   {
      return programme_.gradient(x, f);
   }
   bool eval_g(Index, const Number *x, bool, Index, Number *c) override
   {
      return programme_.conditions(x, c);
   }
   bool eval_jac_g(Index, const Number *x, bool, Index, Index, Index *row, Index *column,
                   Number *values) override
   {
      return programme_.jacobian(x, row, column, values);
   }
   bool eval_h(Index, const Number *x, bool, Number, Index, const Number *lambda, bool, Index,
               Index *row, Index *column, Number *values) override
   {
      return programme_.hessian(x, lambda, row, column, values);
   }
   bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number,
                              Number, Number, Number, Number, Number, Index,
                              const Ipopt::IpoptData *,
                              Ipopt::IpoptCalculatedQuantities *) override
   {
      return programme_.goes_on(iteration);
   }
   void finalize_solution(Ipopt::SolverReturn, Index variables, const Number *x,
                          const Number *z_low, const Number *z_high, Index conditions,
                          const Number *, const Number *lambda, Number,
                          const Ipopt::IpoptData *, Ipopt::IpoptCalculatedQuantities *) override
   {
      using Map = Eigen::Map<const Eigen::VectorXd>;
      solution_.x = Map(x, variables);
      solution_.z_low = Map(z_low, variables);
      solution_.z_high = Map(z_high, variables);
      solution_.lambda = Map(lambda, conditions);
   }

private:
   static void copy(const Eigen::VectorXd &from, Number *to)
   {
      std::copy(from.data(), from.data() + from.size(), to);
   }

   const NonlinearProgramme &programme_;
   ProgrammeSolution &solution_;
};

Ipopt::SmartPtr<Ipopt::IpoptApplication> application(const ProgrammeSettings &settings,
                                                     bool multipliers_known)
{
   const Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
   // An exception of a monitor or an objective ends the work; Ipopt would report a failure.
   app->RethrowNonIpoptException(true);
   Ipopt::OptionsList &options = *app->Options();
   options.SetIntegerValue("print_level", 0);
   options.SetStringValue("sb", "yes");
   // Done only when everything holds to the tolerance.
   for (const char *name : {"tol", "constr_viol_tol", "dual_inf_tol", "compl_inf_tol"})
   {
      options.SetNumericValue(name, settings.tolerance);
   }
   options.SetIntegerValue("acceptable_iter", 0);
   options.SetIntegerValue("max_iter", settings.max_iterations);
   options.SetNumericValue("bound_relax_factor", 0);
   options.SetStringValue("nlp_scaling_method", "none");
   if (!settings.second_derivatives)
   {
      options.SetStringValue("hessian_approximation", "limited-memory");
   }
   if (settings.linear_equations) { options.SetStringValue("jac_c_constant", "yes"); }
   if (settings.linear)
   {
      options.SetStringValue("jac_d_constant", "yes");
      options.SetStringValue("hessian_constant", "yes");
   }
   if (settings.convex)
   {
      options.SetStringValue("mu_strategy", "adaptive");
      options.SetStringValue("adaptive_mu_globalization", "never-monotone-mode");
   }
   if (multipliers_known)
   {
      options.SetStringValue("warm_start_init_point", "yes");
      // The default would raise every multiplier to 1e-3, and so spoil most known multipliers.
      options.SetNumericValue("warm_start_mult_bound_push", 1e-9);
   }
   return app;
}

/// The reason why a programme was not solved, for messages.
std::string in_words(Ipopt::ApplicationReturnStatus status, int max_iterations)
{
   using namespace Ipopt;
   switch (status)
   {
   case Solved_To_Acceptable_Level:
      return "only a looser tolerance was reached (Ipopt's acceptable level)";
   case Infeasible_Problem_Detected:
      return "no values of the variables were found that meet all limits: the limits may "
             "contradict each other or the bounds";
   case Search_Direction_Becomes_Too_Small:
   case Restoration_Failed:
   case Error_In_Step_Computation:
      return "the last values could not be improved, although they do not meet the conditions "
             "of optimality: derivatives may jump there";
   case Diverging_Iterates:
      return "the variables grow without end";
   case Maximum_Iterations_Exceeded:
      return "not converged after " + std::to_string(max_iterations) +
             " iterations, the largest number allowed";
   case Not_Enough_Degrees_Of_Freedom:
      return "there are more equations among the limits than variables";
   case Invalid_Number_Detected:
      return "a value or a derivative is not known or not finite";
   case Insufficient_Memory:
      return "there is not enough memory";
   default:
      return "Ipopt ended with its return status " + std::to_string(status);
   }
}

} // namespace

ProgrammeSolution solve(const NonlinearProgramme &programme, const ProgrammeSettings &settings)
{
   using namespace Ipopt;
   ProgrammeSolution solution;
   const SmartPtr<IpoptApplication> app =
      application(settings, programme.multipliers().size() > 0);
   const SmartPtr<TNLP> asked = new AskedByIpopt(programme, solution);
   // An empty file name, because otherwise Ipopt would read a file ipopt.opt in the working
   // directory.
   ApplicationReturnStatus status = app->Initialize("");
   if (status == Solve_Succeeded)
   {
      // The equations of a step have a row for each unknown and for each condition.
      const NonlinearProgramme::Sizes sizes = programme.sizes();
      const OneThread alone(
         std::pow(static_cast<double>(sizes.variables + sizes.conditions), 3) / 6);
      status = app->OptimizeTNLP(asked);
   }
   const SmartPtr<SolveStatistics> statistics = app->Statistics();
   if (IsValid(statistics)) { solution.iterations = statistics->IterationCount(); }
   if (status == Solve_Succeeded) { solution.outcome = ProgrammeOutcome::solved; }
   else if (status == User_Requested_Stop)
   {
      solution.outcome = ProgrammeOutcome::stopped;
      solution.message = "it was stopped on request";
   }
   else
   {
      const bool none = status == Infeasible_Problem_Detected;
      solution.outcome = none ? ProgrammeOutcome::infeasible : ProgrammeOutcome::failed;
      solution.message = in_words(status, settings.max_iterations);
   }
   return solution;
}

#else

ProgrammeSolution solve(const NonlinearProgramme &, const ProgrammeSettings &)
{
   ProgrammeSolution solution;
   solution.outcome = ProgrammeOutcome::unavailable;
   solution.message = "built without Ipopt (CATTANEO_USE_IPOPT=OFF)";
   return solution;
}

#endif

} // namespace cattaneo
