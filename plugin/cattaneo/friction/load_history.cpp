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
   require(!points.empty(), "load history: there are no points");
   LoadHistory history;
   history.times = Eigen::VectorXd::LinSpaced(points.size(), 0.0, points.size() - 1.0);
   history.multipliers.resize(points[0].size(), points.size());
   for (std::size_t k = 0; k < points.size(); ++k)
   {
      require(points[k].size() == points[0].size(), "load history: point ", k, " has ",
              points[k].size(), " multipliers, point 0 has ", points[0].size());
      history.multipliers.col(k) = points[k];
   }
   return history;
}

LoadHistory LoadHistory::through(const ReducedProblem &problem,
                                 const std::vector<NamedLoads> &points)
{
   std::vector<Eigen::VectorXd> ordered;
   for (const NamedLoads &loads : points) { ordered.push_back(problem.multipliers(loads)); }
   return through(ordered);
}

int LoadHistory::opening() const
{
   return cycle_start < 0 ? static_cast<int>(times.size()) - 1 : cycle_start;
}

int LoadHistory::period() const
{
   return static_cast<int>(times.size()) - 1 - opening();
}

int LoadHistory::segments() const
{
   return opening() + (cycle_start < 0 ? 0 : period() * cycles);
}

int LoadHistory::point(int segment) const
{
   return segment < opening() ? segment : opening() + (segment - opening()) % period();
}

int LoadHistory::cycle(int segment) const
{
   return segment < opening() ? 0 : 1 + (segment - opening()) / period();
}

bool LoadHistory::ends_cycle(int segment) const
{
   return segment >= opening() && (segment - opening()) % period() == period() - 1;
}

double LoadHistory::start_time(int segment) const
{
   const int repeats = std::max(0, cycle(segment) - 1);
   const double duration = cycle_start < 0 ? 0.0 : times[times.size() - 1] - times[cycle_start];
   return times[point(segment)] + repeats * duration;
}

double LoadHistory::end_time(int segment) const
{
   // The next piece's start where there is one, so that both are the same number.
   if (segment + 1 < segments()) { return start_time(segment + 1); }
   const int repeats = std::max(0, cycle(segment) - 1);
   const double duration = cycle_start < 0 ? 0.0 : times[times.size() - 1] - times[cycle_start];
   return times[point(segment) + 1] + repeats * duration;
}

Eigen::VectorXd LoadHistory::start(int segment) const
{
   return multipliers.col(point(segment));
}
Eigen::VectorXd LoadHistory::end(int segment) const
{
   return multipliers.col(point(segment) + 1);
}

void LoadHistory::validate(int patterns) const
{
   require(times.size() >= 2, "load history: ", times.size(), " points, at least 2 are needed");
   require(multipliers.cols() == times.size(), "load history: ", multipliers.cols(),
           " columns of multipliers for ", times.size(), " times");
   require(multipliers.rows() == patterns, "load history: ", multipliers.rows(),
           " multipliers a point for ", patterns, " load patterns");
   require(times.allFinite() && multipliers.allFinite(),
           "load history: a time or multiplier is not finite");
   for (Eigen::Index k = 1; k < times.size(); ++k)
   {
      require(times[k] > times[k - 1], "load history: time ", times[k], " of point ", k,
              " is not after ", times[k - 1], " of the point before");
   }
   if (cycle_start < 0) { return; }
   require(cycle_start < times.size() - 1, "load history: the cycle starts at point ",
           cycle_start, ", must be one of 0 to ", times.size() - 2);
   require(cycles >= 1, "load history: ", cycles, " cycles, at least 1 is needed");
   const Eigen::VectorXd first = multipliers.col(cycle_start);
   const Eigen::VectorXd last = multipliers.col(multipliers.cols() - 1);
   require(first == last, "load history: the loads at the end of the cycle (", last.transpose(),
           ") differ from those at its start (", first.transpose(), ")");
}

} // namespace cattaneo
