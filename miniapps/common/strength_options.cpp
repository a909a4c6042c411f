#include "common/strength_options.hpp"

#include <cattaneo/input_error.hpp>

namespace miniapp
{

using cattaneo::require;

namespace
{

Eigen::MatrixX2d points_of_strength(const char *option, const std::vector<double> &numbers)
{
   require(numbers.size() % 2 == 0, "option --", option, " has ", numbers.size(),
           " numbers, must be a pressure and a strength in turn");
   Eigen::MatrixX2d all(numbers.size() / 2, 2);
   for (std::size_t k = 0; k < numbers.size(); ++k) { all(k / 2, k % 2) = numbers[k]; }
   return all;
}

} // namespace

StrengthOptions::StrengthOptions(Study &study) : study(study)
{
   study.option(&forward, "strength",
                "Friction by a polyline in place of a coefficient: pressure and shear strength "
                "of each point in turn, as '1 0.5 3 0.8'. It begins at (0, 0) and goes "
                "straight on beyond the last point.",
                not_negative);
   study.option(&backward, "strength-backward",
                "The same for slip backward; default: as forward.", not_negative);
}

void StrengthOptions::check() const
{
   require(forward.empty() || !study.options().says("friction"),
           "options --friction and --strength are two laws of friction, choose one");
   require(backward.empty() || !forward.empty(),
           "option --strength-backward goes with --strength");
}

void StrengthOptions::set(cattaneo::ReducedProblem &problem) const
{
   const Eigen::MatrixX2d points = points_of_strength("strength", forward);
   set_friction_law(
      problem,
      cattaneo::FrictionLaw{points, backward.empty()
                                       ? points
                                       : points_of_strength("strength-backward", backward)});
}

} // namespace miniapp
