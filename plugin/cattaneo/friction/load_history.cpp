#include <algorithm>
#include <cattaneo/friction/load_history.hpp>
#include <cattaneo/input_error.hpp>

namespace cattaneo
{

NamedLoads named(const ReducedProblem &problem, const Eigen::VectorXd &multipliers)
{
   NamedLoads loads;
   for (std::size_t k = 0; k < problem.patterns.size(); ++k)
   {
      loads[problem.patterns[k].name] = multipliers[k];
   }
   return loads;
}

LoadHistory LoadHistory::through(const std::vector<Eigen::VectorXd> &points)
{
   require(!points.empty(), "load history: it has no points, must have at least two");
   LoadHistory history;
   history.times = Eigen::VectorXd::LinSpaced(points.size(), 0.0, points.size() - 1.0);
   history.multipliers.resize(points[0].size(), points.size());
   for (std::size_t k = 0; k < points.size(); ++k)
   {
      require(points[k].size() == points[0].size(), "load history: point ", k, " has ",
              points[k].size(), " multipliers, must have as many as point 0, ",
              points[0].size());
      history.multipliers.col(k) = points[k];
   }
   return history;
}

LoadHistory LoadHistory::through(const ReducedProblem &problem,
                                 const std::vector<NamedLoads> &points, int cycle_start,
                                 int cycles)
{
   std::vector<Eigen::VectorXd> ordered;
   NamedLoads loads; // with those that only earlier points name
   for (const NamedLoads &point : points)
   {
      for (const auto &[name, value] : point) { loads[name] = value; }
      ordered.push_back(problem.multipliers(loads));
   }
   LoadHistory history = through(ordered);
   for (const NamedLoads &point : points)
   {
      std::vector<int> &its = history.stated.emplace_back();
      for (const auto &load : point) { its.push_back(problem.pattern(load.first)); }
   }
   history.cycle_start = cycle_start;
   history.cycles = cycles;
   history.validate(problem);
   return history;
}

bool LoadHistory::states(int point, Eigen::Index load) const
{
   if (point < 0 || point >= static_cast<int>(stated.size())) { return false; }
   const std::vector<int> &its = stated[point];
   return std::find(its.begin(), its.end(), load) != its.end();
}

int LoadHistory::pieces() const
{
   const auto all = static_cast<int>(times.size()) - 1;
   return cycle_start < 0 ? all : cycle_start + (all - cycle_start) * cycles;
}

LoadPiece LoadHistory::piece(int k) const
{
   const int last = static_cast<int>(times.size()) - 1,
             opening = cycle_start < 0 ? last : cycle_start, period = last - opening;
   const double duration = times[last] - times[opening];
   LoadPiece piece;
   piece.point = k;
   if (k >= opening)
   {
      piece.point = opening + (k - opening) % period;
      piece.cycle = 1 + (k - opening) / period;
      piece.begins_cycle = piece.point == opening;
      piece.ends_cycle = piece.point == last - 1;
   }
   const double passed = std::max(0, piece.cycle - 1) * duration;
   piece.start = times[piece.point] + passed;
   // The start of the next piece, if there is one, so that both are the same number.
   piece.end = piece.ends_cycle && piece.cycle < cycles
                  ? times[opening] + piece.cycle * duration
                  : times[piece.point + 1] + passed;
   piece.from = multipliers.col(piece.point);
   piece.to = multipliers.col(piece.point + 1);
   return piece;
}

void LoadHistory::validate(const ReducedProblem &problem) const
{
   require(times.size() >= 2, "load history: it has ",
           times.size() == 1 ? "one point" : "no point",
           ", must have at least two, the first without load");
   require(multipliers.cols() == times.size(), "load history: the multipliers have ",
           multipliers.cols(), " columns, must have one for each of the ", times.size(),
           " times");
   const auto patterns = static_cast<Eigen::Index>(problem.patterns.size());
   require(multipliers.rows() == patterns, "load history: the multipliers have ",
           multipliers.rows(), " rows, must have one for each of the ", patterns,
           " load patterns");
   for (Eigen::Index k = 0; k < times.size(); ++k)
   {
      require(std::isfinite(times[k]), "load history: time of point ", k, " is ", times[k],
              ", must be finite");
      for (Eigen::Index l = 0; l < patterns; ++l)
      {
         require(std::isfinite(multipliers(l, k)), "load history: load '",
                 problem.patterns[l].name, "' is ", multipliers(l, k), " at point ", k,
                 ", must be finite");
      }
   }
   for (Eigen::Index k = 1; k < times.size(); ++k)
   {
      require(times[k] > times[k - 1], "load history: time ", times[k], " of point ", k,
              " is not after ", times[k - 1], " of the point before");
   }
   if (cycle_start < 0) { return; }
   require(cycle_start < times.size() - 1, "load history: the cycle starts at point ",
           cycle_start, ", must be one of 0 to ", times.size() - 2);
   constexpr int most_pieces = 1000000000;
   const int most =
      (most_pieces - cycle_start) / (static_cast<int>(times.size()) - 1 - cycle_start);
   require(cycles >= 1 && cycles <= most, "load history: ", cycles,
           " cycles, must be at least 1 and at most ", most);
   for (Eigen::Index k = 0; k < patterns; ++k)
   {
      const double first = multipliers(k, cycle_start), last = multipliers(k, times.size() - 1);
      require(first == last, "load history: load '", problem.patterns[k].name, "' is ", last,
              " at the end of the cycle and ", first,
              " at its start, must be the same: the last point closes the cycle");
   }
}

} // namespace cattaneo
