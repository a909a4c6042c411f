#include <cattaneo/algebra/ipopt.hpp>
#include <cattaneo/algebra/smooth_programme.hpp>

namespace cattaneo
{

#ifdef CATTANEO_USE_IPOPT

namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;
/// The programme for Ipopt, with a dense Jacobian.
class SmoothNlp : public Ipopt::TNLP
{
   using Index = Ipopt::Index;
   using Number = Ipopt::Number;

public:
   SmoothNlp(const SmoothProgramme &programme, const VectorXd &start)
      : programme(programme), start(start)
   {
   }

   SmoothSolution solution;

   bool get_nlp_info(Index &variables, Index &constraints, Index &jacobian, Index &hessian,
                     IndexStyleEnum &style) override
   {
      variables = static_cast<Index>(programme.low.size());
      constraints = static_cast<Index>(programme.least.size());
      jacobian = variables * constraints;
      hessian = 0;
      style = TNLP::C_STYLE;
      return true;
   }

   bool get_bounds_info(Index, Number *x_low, Number *x_high, Index, Number *g_low,
                        Number *g_high) override
   {
      const auto copy = [](const VectorXd &from, Number *to)
      { std::copy(from.data(), from.data() + from.size(), to); };
      copy(programme.low, x_low);
      copy(programme.high, x_high);
      copy(programme.least, g_low);
      copy(programme.most, g_high);
      return true;
   }

   bool get_starting_point(Index variables, bool, Number *x, bool, Number *, Number *, Index,
                           bool, Number *) override
   {
      std::copy(start.data(), start.data() + variables, x);
      return true;
   }

   bool eval_f(Index, const Number *x, bool, Number &value) override
   {
      VectorXd c;
      return programme.values(at(x), value, c);
   }

   bool eval_g(Index, const Number *x, bool, Index constraints, Number *g) override
   {
      double value = 0;
      VectorXd c;
      const bool known = programme.values(at(x), value, c);
      if (known) { std::copy(c.data(), c.data() + constraints, g); }
      return known;
   }

   bool eval_grad_f(Index variables, const Number *x, bool, Number *gradient) override
   {
      VectorXd f;
      MatrixXd c;
      const bool known = programme.derivatives(at(x), f, c);
      if (known) { std::copy(f.data(), f.data() + variables, gradient); }
      return known;
   }

   bool eval_jac_g(Index variables, const Number *x, bool, Index constraints, Index, Index *row,
                   Index *column, Number *values) override
   {
      for (Index k = 0; !values && k < variables * constraints; ++k)
      {
         row[k] = k % constraints;
         column[k] = k / constraints;
      }
      if (!values) { return true; }
      VectorXd f;
      MatrixXd c;
      const bool known = programme.derivatives(at(x), f, c);
      if (known) { std::copy(c.data(), c.data() + c.size(), values); }
      return known;
   }

   /// Asked only of what is linear: it has no entries.
   bool eval_h(Index, const Number *, bool, Number, Index, const Number *, bool, Index, Index *,
               Index *, Number *) override
   {
      return true;
   }

   bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number,
                              Number, Number, Number, Number, Number, Index,
                              const Ipopt::IpoptData *,
                              Ipopt::IpoptCalculatedQuantities *) override
   {
      return !programme.goes_on || programme.goes_on(iteration);
   }

   void finalize_solution(Ipopt::SolverReturn, Index variables, const Number *x,
                          const Number *z_low, const Number *z_high, Index constraints,
                          const Number *, const Number *lambda, Number,
                          const Ipopt::IpoptData *, Ipopt::IpoptCalculatedQuantities *) override
   {
      using Map = Eigen::Map<const VectorXd>;
      solution.y = Map(x, variables);
      solution.z = Map(z_high, variables) - Map(z_low, variables);
      solution.lambda = Map(lambda, constraints);
   }

private:
   VectorXd at(const Number *x) const
   {
      return Eigen::Map<const VectorXd>(x, programme.low.size());
   }

   const SmoothProgramme &programme;
   const VectorXd &start;
};

/// What it means that a programme was not solved.
std::string in_words(Ipopt::ApplicationReturnStatus status, int max_iterations)
{
   using namespace Ipopt;
   switch (status)
   {
   case Solved_To_Acceptable_Level:
      return "the tolerance was nearly reached, and no more";
   case Infeasible_Problem_Detected:
      return "no values of the variables were found that hold all limits: they may contradict "
             "each other or the bounds";
   case Search_Direction_Becomes_Too_Small:
   case Restoration_Failed:
   case Error_In_Step_Computation:
      return "no step from there is better, though the conditions of optimality do not hold: "
             "derivatives may jump there";
   case Diverging_Iterates:
      return "the variables grow without end";
   case Maximum_Iterations_Exceeded:
      return "not done after " + std::to_string(max_iterations) + " iterations, which is all";
   case Not_Enough_Degrees_Of_Freedom:
      return "more limits hold as equations than there are variables";
   case Invalid_Number_Detected:
      return "a value or a derivative is not known or not finite";
   case Insufficient_Memory:
      return "there is not enough memory";
   default:
      return "Ipopt ended with its return status " + std::to_string(status);
   }
}

} // namespace

SmoothSolution solve(const SmoothProgramme &programme, const VectorXd &start, double tolerance,
                     int max_iterations)
{
   using namespace Ipopt;
   SmartPtr<SmoothNlp> nlp = new SmoothNlp(programme, start);
   const SmartPtr<IpoptApplication> app = ipopt(tolerance, max_iterations);
   if (!programme.linear)
   {
      app->Options()->SetStringValue("hessian_approximation", "limited-memory");
   }
   const ApplicationReturnStatus status = optimize(*app, nlp);
   SmoothSolution solution = nlp->solution;
   const SmartPtr<SolveStatistics> statistics = app->Statistics();
   if (IsValid(statistics)) { solution.iterations = statistics->IterationCount(); }
   solution.outcome = status == Solve_Succeeded       ? SmoothOutcome::solved
                      : status == User_Requested_Stop ? SmoothOutcome::stopped
                                                      : SmoothOutcome::failed;
   if (solution.outcome == SmoothOutcome::failed)
   {
      solution.message = in_words(status, max_iterations);
   }
   return solution;
}

#else

SmoothSolution solve(const SmoothProgramme &, const Eigen::VectorXd &, double, int)
{
   return {SmoothOutcome::unavailable,
           "built without Ipopt (CATTANEO_USE_IPOPT=OFF)",
           {},
           {},
           {},
           0};
}

#endif

} // namespace cattaneo
