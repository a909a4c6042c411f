#include "common/design_choice.hpp"

#include "common/text.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <sstream>

namespace miniapp
{

using cattaneo::DesignProblem;
using cattaneo::Parameters;
using cattaneo::ReducedProblem;
using cattaneo::require;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

VectorXd from_the_middle(const ReducedProblem &problem)
{
   const VectorXd &s = problem.arc_length;
   return s.array() - 0.5 * (s.minCoeff() + s.maxCoeff());
}

/// Bodies that nothing keeps from moving apart, all nodes alike: only differences of gaps
/// count.
bool moves_apart(const ReducedProblem &problem)
{
   const VectorXd forces = problem.C() * VectorXd::Ones(problem.nodes());
   return forces.cwiseAbs().maxCoeff() <= 1e-6 * problem.C().cwiseAbs().maxCoeff();
}

/// The node amid those with the least gap.
Index touching_node(const VectorXd &x, const VectorXd &gap)
{
   Index node = 0;
   for (Index i = 1; i < gap.size(); ++i)
   {
      const bool as_near = gap[i] == gap[node] && std::abs(x[i]) < std::abs(x[node]);
      if (gap[i] < gap[node] || as_near) { node = i; }
   }
   return node;
}

void bound(DesignProblem &design, Index count, double low, double high)
{
   design.low = VectorXd::Constant(count, low);
   design.high = VectorXd::Constant(count, high);
}

/// Patterns by their names, separated by semicolons.
std::vector<Index> patterns_of(const std::string &names, const ReducedProblem &problem)
{
   std::vector<Index> found;
   std::istringstream all(names);
   for (std::string name; std::getline(all, name, ';');)
   {
      const std::size_t from = name.find_first_not_of(" '\""),
                        to = name.find_last_not_of(" '\"");
      name = from == std::string::npos ? "" : name.substr(from, to - from + 1);
      const Index k = problem.pattern(name);
      require(std::find(found.begin(), found.end(), k) == found.end(),
              "option --choose names '", name, "' twice");
      found.push_back(k);
   }
   require(found.size() > 1, "option --choose is '", names,
           "', must be two loads at least, separated by semicolons: their sum stays");
   return found;
}

/** Variables that add to the multipliers of loads wherever one of them acts, so that their sum
    stays: none below zero, none by more than `most`. */
DesignVariables choose_loads(DesignProblem &design, const DesignChoice &choice)
{
   const std::vector<Index> loads = patterns_of(choice.loads, design.problem);
   const MatrixXd M = design.cases[0].history.multipliers(loads, Eigen::all);
   const auto count = M.rows();
   require(M.minCoeff() >= 0, "option --choose: a load is ", M.minCoeff(),
           " in the history, must not be negative");
   require(M.maxCoeff() > 0,
           "option --choose: its loads are zero in the history, one must act");
   bound(design, count, -choice.most, choice.most);
   DesignVariables result{{}, VectorXd::Zero(count), M.rowwise().maxCoeff()};
   for (Index j = 0; j < count; ++j)
   {
      Parameters change;
      change.multipliers = MatrixXd::Zero(design.problem.patterns.size(), M.cols());
      for (Index k = 0; k < M.cols(); ++k)
      {
         if (M.col(k).maxCoeff() == 0) { continue; }
         change.multipliers(loads[j], k) = 1;
         design.low[j] = std::max(design.low[j], -M(j, k));
      }
      design.variables.push_back(std::move(change));
      result.names.push_back(design.problem.patterns[loads[j]].name);
   }
   design.limits = MatrixXd::Ones(1, count);
   design.least = design.most = VectorXd::Zero(1);
   return result;
}

/// Friction of zones of equal lengths, which begins as the problem has it.
DesignVariables choose_coat(DesignProblem &design, const DesignChoice &choice)
{
   const ReducedProblem &problem = design.problem;
   require(choice.coat.size() == 2 && choice.coat[0] < choice.coat[1], "option --coat has ",
           choice.coat.size(), " numbers, must be the least friction and the most");
   const double first = problem.arc_length.minCoeff(),
                length = problem.arc_length.maxCoeff() - first;
   DesignVariables result{{}, VectorXd::Zero(choice.zones), VectorXd::Zero(choice.zones)};
   bound(design, choice.zones, 0, 0);
   for (int j = 0; j < choice.zones; ++j)
   {
      const double from = first + length * j / choice.zones,
                   to = first + length * (j + 1) / choice.zones;
      Parameters change;
      change.friction = VectorXd::Zero(problem.nodes());
      double least = INFINITY, most = -INFINITY;
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         const int zone =
            length > 0
               ? std::min(choice.zones - 1, static_cast<int>((problem.arc_length[i] - first) /
                                                             length * choice.zones))
               : 0;
         if (zone != j) { continue; }
         change.friction[i] = 1;
         least = std::min(least, problem.friction[i]);
         most = std::max(most, problem.friction[i]);
      }
      const std::string name = "f from " + text("%.4g to %.4g", from, to);
      require(least <= most, "option --zones is ", choice.zones, ": no node lies from ", from,
              " to ", to);
      require(least >= choice.coat[0] && most <= choice.coat[1], "option --coat is from ",
              choice.coat[0], " to ", choice.coat[1], ", friction is from ", least, " to ",
              most, " from ", from, " to ", to, ": the design starts there");
      require(least == most, "option --zones is ", choice.zones, ": friction is from ", least,
              " to ", most, " from ", from, " to ", to, ", must be one number there");
      design.low[j] = choice.coat[0] - least;
      design.high[j] = choice.coat[1] - least;
      result.before[j] = least;
      result.names.push_back(name);
      design.variables.push_back(std::move(change));
   }
   return result;
}

/// Flat over |x| < b, a parabola (|x| - b)²/2R beyond: b and 1/R are chosen.
DesignVariables choose_rounded(DesignProblem &design, const DesignChoice &choice)
{
   const VectorXd x = from_the_middle(design.problem);
   const double half = x.maxCoeff();
   design.variables.resize(2);
   bound(design, 2, 0, choice.most);
   design.high[0] = half;
   design.shape = [x](const VectorXd &values, MatrixXd &by)
   {
      const Eigen::ArrayXd beyond = (x.array().abs() - values[0]).max(0.0);
      by.col(0) = -values[1] * beyond;
      by.col(1) = 0.5 * beyond.square();
      return VectorXd(values[1] * by.col(1));
   };
   const Eigen::Vector2d start(half / 2, 0);
   return {{"flat half-width", "1/R"}, start, VectorXd::Zero(2)};
}

/// The gap of nodes, or a sum of powers.
DesignVariables choose_gap(DesignProblem &design, const DesignChoice &choice)
{
   if (choice.profile == "rounded")
   {
      require(std::isnan(choice.curvature),
              "option --curvature: of a rounded profile --most is the limit of 1/R");
      return choose_rounded(design, choice);
   }
   const ReducedProblem &given = design.problem;
   const VectorXd x = from_the_middle(given);
   const Index n = given.nodes();
   const bool free = choice.profile == "free";
   // Where bodies can move apart a node that touches stays: only differences of gaps count.
   const bool apart = moves_apart(given);
   DesignVariables result;
   MatrixXd G = MatrixXd::Identity(n, n);
   if (free && apart)
   {
      const Index node = touching_node(x, given.gap);
      G.middleCols(node, n - 1 - node) = G.rightCols(n - 1 - node).eval();
      G.conservativeResize(n, n - 1);
   }
   if (!free)
   {
      G.resize(n, static_cast<Index>(choice.powers.size()));
      for (Index j = 0; j < G.cols(); ++j)
      {
         const double power = choice.powers[j];
         require(power == std::floor(power) &&
                    std::count(choice.powers.begin(), choice.powers.end(), power) == 1,
                 "option --powers has ", power, ", must be whole numbers, each once");
         G.col(j) = (x / x.cwiseAbs().maxCoeff()).array().pow(static_cast<int>(power));
         result.names.push_back("of power " + text("%g", power));
      }
   }
   design.variables = cattaneo::gap_variables(G);
   bound(design, G.cols(), 0, choice.most);
   // What begins flat is crowned. What has a gap may also be too round: other nodes come before
   // the one that stays, so that no shape is left out; of bodies that are held, by their gaps.
   // An odd power leans to one side or to the other.
   for (Index j = 0; j < G.cols(); ++j)
   {
      const bool odd = !free && static_cast<int>(choice.powers[j]) % 2 == 1;
      if (odd || (apart && !choice.begins_flat)) { design.low[j] = -choice.most; }
   }
   if (!std::isnan(choice.curvature))
   {
      limit_curvature(design, -choice.curvature, choice.curvature);
   }
   result.start = result.before = VectorXd::Zero(G.cols());
   return result;
}

} // namespace

DesignVariables choose_variables(DesignProblem &design, const DesignChoice &choice)
{
   if (choice.what() == "loads") { return choose_loads(design, choice); }
   if (choice.what() == "coat") { return choose_coat(design, choice); }
   return choose_gap(design, choice);
}

} // namespace miniapp
