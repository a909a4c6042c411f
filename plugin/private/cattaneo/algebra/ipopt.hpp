#pragma once

#ifdef CATTANEO_USE_IPOPT
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <cattaneo/algebra/one_thread.hpp>
#include <cmath>

namespace cattaneo
{

/// Ipopt with the options that all programmes share: silent, without scaling, and done only
/// when everything holds to @a tolerance.
inline Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt(double tolerance, int max_iterations)
{
   const Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
   // What a monitor or an objective throws ends the work; Ipopt would call it a failure.
   app->RethrowNonIpoptException(true);
   Ipopt::OptionsList &options = *app->Options();
   options.SetIntegerValue("print_level", 0);
   options.SetStringValue("sb", "yes");
   for (const char *name : {"tol", "constr_viol_tol", "dual_inf_tol", "compl_inf_tol"})
   {
      options.SetNumericValue(name, tolerance);
   }
   options.SetIntegerValue("acceptable_iter", 0);
   options.SetIntegerValue("max_iter", max_iterations);
   options.SetNumericValue("bound_relax_factor", 0);
   options.SetStringValue("nlp_scaling_method", "none");
   return app;
}

/// Solves with the options that it has by then.
inline Ipopt::ApplicationReturnStatus optimize(Ipopt::IpoptApplication &app,
                                               const Ipopt::SmartPtr<Ipopt::TNLP> &nlp)
{
   // An empty file name: otherwise a file ipopt.opt in the working directory rules.
   const Ipopt::ApplicationReturnStatus status = app.Initialize("");
   // The equations of a step have a row for each unknown and for each condition.
   Ipopt::Index unknowns = 0, conditions = 0, other = 0;
   Ipopt::TNLP::IndexStyleEnum style = Ipopt::TNLP::C_STYLE;
   nlp->get_nlp_info(unknowns, conditions, other, other, style);
   const OneThread alone(std::pow(unknowns + conditions, 3) / 6);
   return status == Ipopt::Solve_Succeeded ? app.OptimizeTNLP(nlp) : status;
}

} // namespace cattaneo
#endif
