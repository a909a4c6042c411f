#pragma once

#ifdef CATTANEO_USE_IPOPT
#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>

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
   return status == Ipopt::Solve_Succeeded ? app.OptimizeTNLP(nlp) : status;
}

} // namespace cattaneo
#endif
