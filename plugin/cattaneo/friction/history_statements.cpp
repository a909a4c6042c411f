#include <algorithm>
#include <cattaneo/friction/history_statements.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/words.hpp>

namespace cattaneo
{

LoadHistory load_history(const std::string &called, const std::string &text,
                         const ReducedProblem &problem)
{
   std::vector<NamedLoads> points;
   for (const std::string &statement : split_unquoted(called, text, ";"))
   {
      const std::string where = called + " '" + statement + "'";
      NamedLoads point;
      for (const std::string &word : split_unquoted(where, statement, ", \t\n"))
      {
         const bool quoted = word[0] == '\'' || word[0] == '"';
         const std::size_t end = quoted ? word.find(word[0], 1) : 0,
                           equals = word.find('=', end);
         require(
            equals != std::string::npos && (!quoted || equals == end + 1), where, ": '", word,
            "', must be PATTERN=number such as P=1 without spaces, a name with spaces, commas "
            "or = in quotes");
         const std::string name = quoted ? word.substr(1, end - 1) : word.substr(0, equals);
         require(point.count(name) == 0, where, ": '", name,
                 "' is named twice at one point, must be named once; separate points by "
                 "semicolons, as 'P=0; P=1'");
         const std::vector<std::string> loads = problem.load_names();
         require(std::find(loads.begin(), loads.end(), name) != loads.end(), where,
                 ": there is no load '", name, "', must be one of: ", listed(loads));
         point[name] = number(where, word.substr(equals + 1));
      }
      points.push_back(point);
   }
   if (points.empty())
   {
      points.resize(2);
      for (const LoadPattern &pattern : problem.patterns) { points[1][pattern.name] = 1; }
   }
   for (const auto &[name, value] : points[0])
   {
      require(
         value == 0, called, ": ", name, " is ", value,
         " at the first point, must be 0, because the bodies start without load: begin with '",
         name, "=0'");
   }
   require(points.size() > 1, called, " has one point, must have two at least, as '",
           problem.patterns.empty() ? "P" : problem.patterns[0].name, "=0; ",
           problem.patterns.empty() ? "P" : problem.patterns[0].name,
           "=1', because loads grow from one point to the next");
   return LoadHistory::through(problem, points);
}

std::string nothing_presses(const ReducedProblem &problem, const LoadHistory &history,
                            const MarchReport &report, const ContactState &state,
                            const std::vector<std::string> &bolts)
{
   const bool ended =
      report.status != FrictionStatus::converged && report.status != FrictionStatus::stopped;
   if (!ended || state.p.size() == 0 || state.p.maxCoeff() > 0) { return ""; }
   std::vector<std::string> later, now;
   for (std::size_t l = 0; l < problem.patterns.size(); ++l)
   {
      const auto row = history.multipliers.row(static_cast<Eigen::Index>(l));
      Eigen::Index point = 0;
      while (point < row.size() && row[point] == 0) { ++point; }
      // The load grows from the point before this one.
      const Eigen::VectorXd &p = problem.patterns[l].p;
      const bool presses = p.sum() * row.sum() > 1e-9 * p.lpNorm<1>() * row.lpNorm<1>();
      if (presses && point < row.size() && point > 0 && history.times[point - 1] <= state.time)
      {
         now.push_back("'" + problem.patterns[l].name + "'");
      }
      if (!presses || point == row.size() || point == 0 ||
          history.times[point - 1] <= state.time)
      {
         continue;
      }
      const std::string &name = problem.patterns[l].name;
      const bool bolt = std::find(bolts.begin(), bolts.end(), name) != bolts.end();
      later.push_back((bolt ? "bolt '" : "load '") + name +
                      (bolt ? "' is tightened at point " : "' grows on the way to point ") +
                      std::to_string(point));
   }
   if (later.empty() && !now.empty() && report.status == FrictionStatus::gross_sliding)
   {
      return "load " + listed(now) + (now.size() == 1 ? " presses" : " press") +
             " too little for the shear that comes at the same time: the bodies must be "
             "pressed more, or have more friction";
   }
   if (later.empty() && !now.empty())
   {
      return "load " + listed(now) + (now.size() == 1 ? " presses" : " press") +
             ", but the bodies do not come to rest on each other: a body tips if the resultant "
             "of its loads passes beside its contact, and nothing stops it if it is sheared "
             "before a gap closes. Support it against that, press it first, or close the gap";
   }
   return later.empty() ? "no load presses the bodies together, and no other load comes later: "
                          "does a load have the "
                          "wrong sign?"
                        : "no load presses the bodies together yet: " + listed(later) +
                             " of the history (from 0), the load that presses must come first";
}

} // namespace cattaneo
