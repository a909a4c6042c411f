#include <cattaneo/algebra/nonlinear_programme.hpp>
#include <cattaneo/algebra/smooth_programme.hpp>

namespace cattaneo
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// With a dense Jacobian.
class DenseProgramme : public NonlinearProgramme
{
public:
   DenseProgramme(const SmoothProgramme &programme, const VectorXd &start)
      : programme_(programme), start_(start)
   {
   }
   Sizes sizes() const override
   {
      const Index variables = programme_.low.size(), conditions = programme_.least.size();
      return {variables, conditions, variables * conditions, 0};
   }
   Bounds bounds() const override
   {
      return {programme_.low, programme_.high, programme_.least, programme_.most};
   }
   VectorXd start() const override { return start_; }
   bool value(const double *x, double &f) const override
   {
      VectorXd c;
      return programme_.values(at(x), f, c);
   }
   bool conditions(const double *x, double *c) const override
   {
      double f = 0;
      VectorXd found;
      const bool known = programme_.values(at(x), f, found);
      if (known) { std::copy(found.data(), found.data() + found.size(), c); }
      return known;
   }
   bool gradient(const double *x, double *f) const override
   {
      VectorXd found;
      MatrixXd c;
      const bool known = programme_.derivatives(at(x), found, c);
      if (known) { std::copy(found.data(), found.data() + found.size(), f); }
      return known;
   }
   bool jacobian(const double *x, int *row, int *column, double *values) const override
   {
      const auto conditions = static_cast<int>(programme_.least.size()),
                 entries = conditions * static_cast<int>(programme_.low.size());
      for (int k = 0; !values && k < entries; ++k)
      {
         row[k] = k % conditions;
         column[k] = k / conditions;
      }
      if (!values) { return true; }
      VectorXd f;
      MatrixXd c;
      const bool known = programme_.derivatives(at(x), f, c);
      if (known) { std::copy(c.data(), c.data() + c.size(), values); }
      return known;
   }
   bool goes_on(int iteration) const override
   {
      return !programme_.goes_on || programme_.goes_on(iteration);
   }

private:
   VectorXd at(const double *x) const
   {
      return Eigen::Map<const VectorXd>(x, programme_.low.size());
   }

   const SmoothProgramme &programme_;
   const VectorXd &start_;
};

} // namespace

SmoothSolution solve(const SmoothProgramme &programme, const VectorXd &start, double tolerance,
                     int max_iterations)
{
   ProgrammeSettings settings;
   settings.tolerance = tolerance;
   settings.max_iterations = max_iterations;
   settings.second_derivatives = programme.linear; // there are none
   const ProgrammeSolution found = solve(DenseProgramme(programme, start), settings);
   return {found.outcome, found.message,   found.x, found.z_high - found.z_low,
           found.lambda,  found.iterations};
}

} // namespace cattaneo
