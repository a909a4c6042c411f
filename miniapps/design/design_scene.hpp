#pragma once

#include "common/study.hpp"

#include <cattaneo/design/design.hpp>

namespace miniapp
{

/// The object of the design and its purpose: a scene with its loads, or a saved problem with
/// its history.
struct DesignScene
{
   std::string scene = "pad"; ///< or "punch"
   std::string goal = "pressure";
   std::string file;                         ///< of a saved problem, in place of the scene
   std::string history;                      ///< of its loads, as statements
   std::vector<double> loads = {1}, weights; ///< P of each case, and its weight
   double shear = 0;                         ///< amplitude of Q/fP
   double friction = none;                   ///< none: that of the file; for a scene 0.3
   double from = none; ///< time of the history from which on its points count; none: the last
   int nodes = 65;

   bool cycles() const { return goal != "pressure"; }
};

/// The contact before its design. InputError naming the option, as for the cases.
cattaneo::ReducedProblem make_problem(Study &study, const DesignScene &chosen);
std::vector<cattaneo::DesignCase> make_cases(const DesignScene &chosen,
                                             const cattaneo::ReducedProblem &problem);

} // namespace miniapp
