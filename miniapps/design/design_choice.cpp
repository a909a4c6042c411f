#include "design/design_choice.hpp"

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

/// Nodes along one line, with their own arc length.
struct Line
{
   Index first, nodes;
   std::string name; ///< before the names of its variables; empty if there is one line
   double middle;    ///< its arc length; for half a line that of the plane or axis of symmetry
};

std::vector<Line> lines_of(const ReducedProblem &problem)
{
   const auto middle_of = [&](Index first, Index nodes, bool from_mirror, bool to_mirror)
   {
      const auto s = problem.arc_length.segment(first, nodes);
      const double start = s.minCoeff(), end = s.maxCoeff();
      return from_mirror == to_mirror ? 0.5 * (start + end) : from_mirror ? start : end;
   };
   std::vector<Line> all;
   for (const cattaneo::ContactChain &chain : problem.chains)
   {
      std::string name;
      if (problem.chains.size() > 1)
      {
         name = "line " + std::to_string(all.size() + 1) + " (" + chain.interface + "), ";
      }
      all.push_back(
         {chain.first, chain.nodes, name,
          middle_of(chain.first, chain.nodes, chain.mirrored_at(0), chain.mirrored_at(1))});
   }
   if (all.empty())
   {
      all.push_back({0, problem.nodes(), "", middle_of(0, problem.nodes(), false, false)});
   }
   return all;
}

/// Distance of each node from the middle of its line.
VectorXd from_the_middle(const ReducedProblem &problem)
{
   VectorXd x = problem.arc_length;
   for (const Line &line : lines_of(problem))
   {
      x.segment(line.first, line.nodes).array() -= line.middle;
   }
   return x;
}

/// Can the bodies move apart freely, by the same distance at all nodes? Then only differences
/// of gaps count.
bool moves_apart(const ReducedProblem &problem)
{
   const VectorXd forces = problem.C() * VectorXd::Ones(problem.nodes());
   return forces.cwiseAbs().maxCoeff() <= 1e-6 * problem.C().cwiseAbs().maxCoeff();
}

/// The node with the smallest gap, and of several such nodes the one nearest to x = 0.
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
           "', must be at least two loads, separated by semicolons, whose sum stays the same");
   return found;
}

/** Variables that are added to the multipliers of loads wherever one of them acts, with a
    constant sum. No multiplier falls below zero, and none changes by more than `most`. */
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

/// Friction in zones of equal length of each line. It begins with the value of the problem.
DesignVariables choose_coat(DesignProblem &design, const DesignChoice &choice)
{
   const ReducedProblem &problem = design.problem;
   require(choice.coat.size() == 2, "option --coat has ", choice.coat.size(),
           " numbers, must be the least friction and the most");
   require(choice.coat[0] < choice.coat[1], "option --coat is from ", choice.coat[0], " to ",
           choice.coat[1], ", must be the least friction and the most, in this order");
   const std::vector<Line> lines = lines_of(problem);
   const auto zones = static_cast<Index>(choice.zones),
              count = zones * static_cast<Index>(lines.size());
   DesignVariables result{{}, VectorXd::Zero(count), VectorXd::Zero(count)};
   bound(design, count, 0, 0);
   for (Index v = 0; v < count; ++v)
   {
      const Line &line = lines[v / zones];
      const Index j = v % zones;
      const auto s = problem.arc_length.segment(line.first, line.nodes);
      const double first = s.minCoeff(), length = s.maxCoeff() - first;
      const double from = first + length * j / zones, to = first + length * (j + 1) / zones;
      Parameters change;
      change.friction = VectorXd::Zero(problem.nodes());
      double least = INFINITY, most = -INFINITY;
      for (Index i = line.first; i < line.first + line.nodes; ++i)
      {
         const Index zone =
            length > 0
               ? std::min(zones - 1,
                          static_cast<Index>((problem.arc_length[i] - first) / length * zones))
               : 0;
         if (zone != j) { continue; }
         change.friction[i] = 1;
         least = std::min(least, problem.friction[i]);
         most = std::max(most, problem.friction[i]);
      }
      const std::string place = line.name + text("f from %.4g to %.4g", from, to);
      require(least <= most, "option --zones is ", zones, ": no node lies in ", place);
      require(least >= choice.coat[0] && most <= choice.coat[1],
              "option --coat allows friction from ", choice.coat[0], " to ", choice.coat[1],
              ", must include the friction of the problem, ", least, " to ", most, " in ",
              place, ", with which the design starts");
      require(least == most, "option --zones is ", zones, ": friction is from ", least, " to ",
              most, " in ", place, ", must be one number there");
      design.low[v] = choice.coat[0] - least;
      design.high[v] = choice.coat[1] - least;
      result.before[v] = least;
      result.names.push_back(place);
      design.variables.push_back(std::move(change));
   }
   return result;
}

/// Flat over |x| < b of each line, a parabola (|x| - b)²/2R beyond: b and 1/R are chosen.
DesignVariables choose_rounded(DesignProblem &design, const DesignChoice &choice)
{
   const VectorXd x = from_the_middle(design.problem);
   const std::vector<Line> lines = lines_of(design.problem);
   const auto count = 2 * static_cast<Index>(lines.size());
   design.variables.resize(count);
   bound(design, count, 0, choice.most);
   DesignVariables result{{}, VectorXd::Zero(count), VectorXd::Zero(count)};
   for (Index k = 0; k < count; k += 2)
   {
      const Line &line = lines[k / 2];
      design.high[k] = x.segment(line.first, line.nodes).cwiseAbs().maxCoeff();
      result.start[k] = design.high[k] / 2;
      result.names.push_back(line.name + "flat half-width");
      result.names.push_back(line.name + "1/R");
   }
   design.shape = [x, lines](const VectorXd &values, MatrixXd &by)
   {
      VectorXd gap = VectorXd::Zero(x.size());
      for (Index k = 0; k < values.size(); k += 2)
      {
         const Line &line = lines[k / 2];
         const Eigen::ArrayXd beyond =
            (x.segment(line.first, line.nodes).array().abs() - values[k]).max(0.0);
         by.col(k).segment(line.first, line.nodes) = -values[k + 1] * beyond;
         by.col(k + 1).segment(line.first, line.nodes) = 0.5 * beyond.square();
         gap += values[k + 1] * by.col(k + 1);
      }
      return gap;
   };
   return result;
}

/// The gap of nodes, or a sum of powers.
DesignVariables choose_gap(DesignProblem &design, const DesignChoice &choice)
{
   if (choice.profile == "rounded")
   {
      require(std::isnan(choice.curvature), "option --curvature cannot be used with a rounded "
                                            "profile, where --most is the limit of 1/R");
      return choose_rounded(design, choice);
   }
   const ReducedProblem &given = design.problem;
   const VectorXd x = from_the_middle(given);
   const Index n = given.nodes();
   const bool free = choice.profile == "free";
   // If bodies can move apart, a node that touches keeps its gap, because only differences of
   // gaps count.
   const bool apart = moves_apart(given);
   DesignVariables result;
   MatrixXd G = MatrixXd::Identity(n, n);
   std::vector<bool> odd; // powers of a crown
   if (free && apart)
   {
      const Index node = touching_node(x, given.gap);
      G.middleCols(node, n - 1 - node) = G.rightCols(n - 1 - node).eval();
      G.conservativeResize(n, n - 1);
   }
   if (!free)
   {
      const std::vector<Line> lines = lines_of(given);
      const std::size_t powers = choice.powers.size();
      require(powers > 0, "option --powers is empty, must be whole numbers");
      G = MatrixXd::Zero(n, static_cast<Index>(powers * lines.size()));
      for (Index j = 0; j < G.cols(); ++j)
      {
         const Line &line = lines[j / powers];
         const double power = choice.powers[j % powers];
         require(power == std::floor(power) &&
                    std::count(choice.powers.begin(), choice.powers.end(), power) == 1,
                 "option --powers has ", power, ", must be whole numbers, each once");
         const Eigen::ArrayXd own = x.segment(line.first, line.nodes).array();
         const double half = own.abs().maxCoeff();
         G.col(j).segment(line.first, line.nodes) =
            (own / (half > 0 ? half : 1.0)).pow(static_cast<int>(power));
         odd.push_back(static_cast<int>(power) % 2 == 1);
         result.names.push_back(line.name + "of power " + text("%g", power));
      }
   }
   design.variables = cattaneo::gap_variables(G);
   bound(design, G.cols(), 0, choice.most);
   // A flat start can only be crowned. A start with a gap may also be too round: then other
   // nodes may touch before the one that keeps its gap, so that no shape is excluded. For
   // supported bodies the gaps themselves decide. An odd power tilts the profile to either
   // side.
   for (Index j = 0; j < G.cols(); ++j)
   {
      const bool leans = !free && odd[j];
      if (leans || (apart && !choice.begins_flat)) { design.low[j] = -choice.most; }
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
