//  solve_reduced: marches a saved reduced problem and writes its solution, increment by
//  increment
//
//  solve_reduced PROBLEM.json HISTORY INCREMENTS SOLUTION.json
//
//  HISTORY: points separated by semicolons, each with one multiplier a load pattern in the
//  order of the file ("0 0; 1 0; 1 0.3"). Every piece between two points is cut into the same
//  number of equal increments, also where one would do. docs/reduced_problems.md describes both
//  files.

#include "common/run.hpp"

#include <cattaneo/friction/march.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/whole_file.hpp>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

using namespace cattaneo;

namespace
{

std::vector<double> list(const Eigen::VectorXd &x)
{
   return {x.data(), x.data() + x.size()};
}

LoadHistory read_history(const std::string &text)
{
   std::vector<Eigen::VectorXd> points;
   std::istringstream in(text);
   for (std::string point; std::getline(in, point, ';');)
   {
      const std::vector<double> loads = miniapp::numbers("HISTORY", point);
      points.push_back(Eigen::Map<const Eigen::VectorXd>(loads.data(), loads.size()));
   }
   return LoadHistory::through(points);
}

} // namespace

int main(int argc, char *argv[])
{
   return miniapp::run(
      [&]
      {
         require(argc == 5,
                 "usage: solve_reduced PROBLEM.json HISTORY INCREMENTS SOLUTION.json");
         const ReducedProblem problem = load_reduced_problem(argv[1]);
         const LoadHistory history = read_history(argv[2]);
         MarchSettings settings;
         settings.increments = std::atoi(argv[3]);
         settings.stepping = Stepping::fixed;
         settings.single_increment_if_exact = false;
         nlohmann::ordered_json increments = nlohmann::ordered_json::array();
         ContactState state = ContactState::virgin(problem);
         const MarchReport report =
            march(problem, history, state, settings,
                  [&](const ContactState &reached, const IncrementRecord &)
                  {
                     std::string states; // one letter a node
                     for (NodeState s : reached.status)
                     {
                        states += s == NodeState::separation      ? 'o'
                                  : s == NodeState::stick         ? 's'
                                  : s == NodeState::forward_slip  ? '+'
                                  : s == NodeState::backward_slip ? '-'
                                                                  : '/';
                     }
                     increments.push_back({{"multipliers", list(reached.multipliers)},
                                           {"states", states},
                                           {"v", list(reached.v)},
                                           {"w", list(reached.w)},
                                           {"q", list(reached.q)},
                                           {"p", list(reached.p)}});
                  });
         std::cout << argv[1] << ": " << problem.nodes() << " nodes, " << increments.size()
                   << " increments, largest residual " << report.largest_residual
                   << ", dissipation " << state.dissipation << std::endl;
         const int code = miniapp::exit_code(problem, report);
         if (code != 0) { return code; }
         const nlohmann::ordered_json solution = {
            {"format", "cattaneo reduced solution 1"},
            {"problem", std::filesystem::path(argv[1]).filename().string()},
            {"history", argv[2]},
            {"increments", increments}};
         write_whole(argv[4], solution.dump() + '\n');
         return 0;
      });
}
