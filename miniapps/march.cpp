//  march: any saved reduced problem through a load history, in cycles, by the method you choose
//
//  Reads a reduced problem (docs/reduced_problems.md): a file that a study wrote with --save,
//  one of those in problems/, or matrices of your own, which need no mesh. Units are those of
//  the file.
//
//  Sample runs:
//    march --case problems/sliders.case.json
//    march --reduced problems/hertz.json --history "P=0; P=1; Q=.24; Q=-.24"
//    march --method gauss-seidel --reduced problems/hertz.json --history "P=0; P=1"

#include "common/own_history.hpp"
#include "common/strength_options.hpp"

#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cmath>

using namespace cattaneo;
using namespace miniapp;
using Eigen::VectorXd;

namespace
{

/// Matrices of other programs may come without neighbours, places and weights.
void fill_in(ReducedProblem &problem)
{
   const Eigen::Index n = problem.nodes();
   if (problem.chains.empty()) // each node for itself
   {
      for (Eigen::Index i = 0; i < n; ++i)
      {
         problem.chains.push_back({"node " + std::to_string(i), i, 1});
      }
   }
   if (problem.arc_length.size() == 0)
   {
      problem.arc_length = VectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
      warn("the file has no arc length: positions are numbers of nodes, from 0");
   }
   if (problem.weights.size() == 0)
   {
      problem.weights = VectorXd::Ones(n);
      warn("the file has no weights: tractions are nodal forces");
   }
   if (problem.position.size() == 0)
   {
      problem.position = Eigen::MatrixXd::Zero(n, 2);
      problem.position.col(0) = problem.arc_length;
   }
}

void march_problem(Study &study)
{
   std::string file, method = "automatic";
   double friction = none;
   OwnHistory history(study);
   FrictionSettings &solver = history.settings.friction;
   int max_sweeps = static_cast<int>(solver.max_sweeps);
   study.options().group("The problem");
   study.option(&file, "reduced",
                "Reduced problem: a file that --save of a study wrote, or your own.",
                Text::input);
   study.option(&friction, "friction",
                "Coefficient of friction of all nodes, instead of the file's.", not_negative);
   const StrengthOptions strength(study);
   study.options().group("The solver");
   study.option(&method, "method",
                "automatic, or gauss-seidel (one node at a time, as in the thesis).",
                {"automatic", "gauss-seidel"});
   study.option(&solver.tolerance, "tolerance",
                "Largest violation of an equation or law, relative to the largest nodal force.",
                positive);
   study.option(&max_sweeps, "max-sweeps",
                "Largest number of sweeps of an increment by gauss-seidel.", at_least(1));
   study.parse();
   study.only_if(method == "gauss-seidel", {"max-sweeps"}, "goes with --method gauss-seidel");
   history.check_options();
   strength.check();
   require(!file.empty(), "option reduced is empty, must name a reduced problem");
   solver.max_sweeps = max_sweeps;
   if (method == "gauss-seidel") { solver.method = FrictionMethod::gauss_seidel; }

   ReducedProblem problem = load_reduced_problem(file);
   require(!problem.patterns.empty(), "'", file, "' has no load pattern");
   fill_in(problem);
   if (!std::isnan(friction)) { set_friction(problem, friction); }
   if (strength.given()) { strength.set(problem); }
   history.begin(problem);
   study.only_if(!study.csv().empty(), {"frames"}, "goes with --csv");
   study.condensed(problem, 0);

   history.march(problem, [](const ContactState &, bool) {});
   study.save(problem);
   const double normal = history.state.p.sum(),
                tangential = history.state.q.head(problem.nodes()).sum();
   study.results["normal_force"] = normal;
   study.results["tangential_force"] = tangential;
   history.report_state(problem, text("sums of nodal forces p %g, q %g", normal, tangential));
   history.report_march(problem);
   report_critical_friction(study, problem);
}

} // namespace

int main(int argc, char *argv[])
{
   return Study::run("march", argc, argv, march_problem);
}
