#include "fretting_problems.hpp"

#include "comparison.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace cattaneo_test
{

using namespace cattaneo::fretting;

FatigueMaterial aluminium()
{
   FatigueMaterial m;
   m.name = "aluminium";
   m.young = 74000;
   m.poisson = 0.3;
   m.threshold = 66.4;
   m.fatigue_limit = {124, 124};
   m.shear_yield = {270, 270};
   return m;
}

FrettingProblem round_numbers()
{
   FrettingProblem problem;
   problem.crack.edge = {2, 0.3, 0.6};
   problem.crack.stress_ratio = 0.5;
   FatigueMaterial &m = problem.material;
   m.name = "round";
   m.young = 1820;
   m.poisson = 0.3; // E/(2(1 - ν²)) = 1000
   m.fatigue_limit = {10, 20};
   m.threshold = 10 * std::sqrt(0.04 * pi);
   m.shear_yield = {2, 4};
   m.threshold_ratio = 0.5;
   problem.half_width = 10;
   problem.rounded_width = 4;
   problem.bulk_known = true;
   problem.crack.stress_gradient = 1e-9;
   return problem;
}

bool mentions(const FrettingReport &report, const std::string &text)
{
   for (const Validity &item : report.validity)
   {
      if (item.text.find(text) != std::string::npos) { return true; }
   }
   return false;
}

const Validity &measure(const FrettingReport &report, const std::string &name)
{
   static const Validity none{"none", nan_value, Trust::good, ""};
   for (const Validity &item : report.validity)
   {
      if (item.measure == name) { return item; }
   }
   ADD_FAILURE() << "no measure " << name;
   return none;
}

} // namespace cattaneo_test
