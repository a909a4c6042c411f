#include <cattaneo/algebra/smooth_programme.hpp>
#include <cattaneo/design/design.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/progress_report.hpp>
#include <cmath>
#include <optional>

namespace cattaneo
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace
{

/// Pressures of all nodes that have a weight, at all states.
std::vector<Response> pressures(const ReducedProblem &problem, const Responses &of,
                                const std::vector<std::size_t> &states)
{
   std::vector<Response> all;
   for (std::size_t k : states)
   {
      for (Index i = 0; i < problem.nodes(); ++i)
      {
         if (problem.weights[i] > 0) { all.push_back(of.pressure(k, i)); }
      }
   }
   return all;
}

/// Times of the points of its history at which a case gives responses.
std::vector<double> times(const DesignCase &load_case)
{
   const LoadHistory &history = load_case.history;
   const double end = history.piece(history.pieces() - 1).end,
                from = std::isnan(load_case.from) ? end : load_case.from;
   std::vector<double> all;
   if (history.times[0] >= from) { all.push_back(history.times[0]); }
   for (int k = 0; k < history.pieces(); ++k)
   {
      if (history.piece(k).end >= from) { all.push_back(history.piece(k).end); }
   }
   return all;
}

void add(VectorXd &sum, double factor, const VectorXd &x)
{
   if (x.size() > 0) { sum += factor * x; }
}

VectorXd shaped(const DesignProblem &of, const VectorXd &x, MatrixXd &by)
{
   const Index n = of.problem.nodes();
   by = MatrixXd::Zero(n, x.size());
   VectorXd gap = of.shape(x, by);
   require(gap.size() == n && by.rows() == n && by.cols() == x.size(),
           "design: `shape` returned ", gap.size(), " gaps and ", by.rows(), " × ", by.cols(),
           " derivatives, must return ", n, " gaps (nodes) and ", n, " × ", x.size(),
           " derivatives (nodes × variables)");
   return gap;
}

void require_start(const DesignProblem &problem, const VectorXd &start, double tolerance)
{
   require(start.size() == problem.low.size(), "design: the start has ", start.size(),
           " values, must have one for each of the ", problem.low.size(), " variables");
   for (Index j = 0; j < start.size(); ++j)
   {
      require(start[j] >= problem.low[j] && start[j] <= problem.high[j], "design: variable ", j,
              " starts at ", start[j], ", must lie between ", problem.low[j], " and ",
              problem.high[j]);
   }
   const Index r = violated_limit(problem, start, tolerance);
   if (r < 0) { return; }
   require(false, "design: limit ", r, " is ", problem.limits.row(r).dot(start),
           " at the start, must be from ", problem.least[r], " to ", problem.most[r],
           " there: start at values that meet all limits, or widen this one");
}

/** Refuses derivatives that are not those of the shape. With them the search would end anywhere
    and call it an optimum. Along each variable the shape is moved by a short step into the
    bounds. Its change is compared with the mean of the derivatives at both ends, which is exact
    to the third order of the step. Bounds may be far away and the shape may bend before them,
    so shorter steps are tried as long as round-off leaves digits. */
void require_derivatives(const DesignProblem &problem, const VectorXd &start)
{
   MatrixXd here, there;
   const VectorXd gap = shaped(problem, start, here);
   const double digits = 1e-12 * gap.cwiseAbs().maxCoeff();
   for (Index j = 0; j < start.size(); ++j)
   {
      const double reach = problem.high[j] - problem.low[j];
      const bool up = problem.high[j] - start[j] >= start[j] - problem.low[j];
      for (double share = 1e-4; reach > 0; share *= 0.1)
      {
         VectorXd x = start;
         x[j] += (up ? share : -share) * reach;
         const double way = x[j] - start[j];
         const VectorXd change = shaped(problem, x, there) - gap,
                        expected = 0.5 * way * (here.col(j) + there.col(j));
         const double size =
            std::max(change.cwiseAbs().maxCoeff(), expected.cwiseAbs().maxCoeff());
         Index node = 0;
         const double off = (change - expected).cwiseAbs().maxCoeff(&node);
         if (off <= 1e-2 * size + digits) { break; }
         require(share > 1e-12 && size > 100 * digits,
                 "design: the derivative that `shape` returns for variable ", j, " is ",
                 expected[node] / way, " at node ", node,
                 ", must agree with the change of its gaps, ", change[node] / way);
      }
   }
}

/** Goes from a point that meets all bounds and limits toward another one, as far as they allow.
    At a limit it continues along that limit. */
VectorXd toward(const DesignProblem &problem, const VectorXd &start, const VectorXd &end)
{
   const Index variables = start.size(), count = variables + problem.limits.rows();
   const VectorXd unit = (problem.high - problem.low)
                            .unaryExpr([](double reach) { return reach > 0 ? reach : 1.0; });
   // Bounds are limits of one variable each.
   MatrixXd L = MatrixXd::Identity(count, variables);
   VectorXd least(count), most(count);
   if (count > variables) { L.bottomRows(count - variables) = problem.limits; }
   least << problem.low, problem.least;
   most << problem.high, problem.most;
   std::vector<bool> held(count);
   for (Index r = 0; r < count; ++r) { held[r] = least[r] == most[r]; }
   VectorXd x = start;
   for (Index stop = 0; stop >= 0;)
   {
      // The direction toward the end, projected onto the limits that are active already.
      VectorXd way = (end - x).cwiseQuotient(unit);
      std::vector<Index> along;
      for (Index r = 0; r < count; ++r)
      {
         if (held[r]) { along.push_back(r); }
      }
      if (!along.empty())
      {
         const MatrixXd kept = L(along, Eigen::all) * unit.asDiagonal();
         way -= kept.completeOrthogonalDecomposition().solve(kept * way).eval();
      }
      way = way.cwiseProduct(unit);
      // Go to the next limit, which is active from then on.
      stop = -1;
      double share = 1;
      for (Index r = 0; r < count; ++r)
      {
         const double at = L.row(r).dot(x), by = L.row(r).dot(way);
         if (held[r] || std::abs(by) <= 1e-12 * L.row(r).cwiseAbs().dot(unit)) { continue; }
         const double room = std::max(0.0, ((by > 0 ? most[r] : least[r]) - at) / by);
         if (room >= share) { continue; }
         share = room;
         stop = r;
      }
      x += share * way;
      if (stop >= 0) { held[stop] = true; }
   }
   return x.cwiseMax(problem.low).cwiseMin(problem.high);
}

/// The search ends after this number of iterations without a better design. If responses have a
/// kink at the optimum, Ipopt would go on looking for a smooth one.
constexpr int patience = 25;

/// One choice of variables and its results. `known` is false, with a message, if a case has no
/// answer or its derivatives are not known.
struct Trial
{
   VectorXd x;
   bool known = false;
   std::string message;
   ReducedProblem problem;
   std::vector<MarchTrace> traces;
   std::vector<std::vector<Response>> responses; ///< of each case
   VectorXd values;                              ///< of all, times the weights
   MatrixXd by;                                  ///< by each variable; empty: not known yet
};

/** One design() in progress. Ipopt, or the linear programmes of descend(), ask for trials. Each
    trial marches all cases. The best one that bounds and limits allow is kept, whatever the
    search itself ends with. */
class Design
{
public:
   Design(const DesignProblem &given, const DesignSettings &settings)
      : given_(given), settings_(settings), march_(settings.march),
        progress_(settings.march.monitor), variables_(given.low.size()),
        limits_(given.limits.rows() > 0 ? given.limits : MatrixXd(0, variables_))
   {
      // All trials must have the same states, so no march ends earlier than another. A single
      // march reports no progress, the search does.
      march_.stop_at_steady_state = false;
      march_.monitor.progress = {};
   }

   DesignReport run(const VectorXd &start);

private:
   Trial &at(const VectorXd &x);
   void differentiate(Trial &trial);
   double objective(const Trial &trial) const
   {
      return largest() ? trial.values.maxCoeff() : trial.values.sum();
   }
   bool largest() const { return given_.goal == DesignGoal::least_largest; }
   bool allowed(const VectorXd &x) const;
   bool stopped() const { return settings_.march.monitor.stopped(); }
   void find_scales(const Trial &trial);
   SmoothProgramme programme(const Trial *about = nullptr, double radius = 0);
   SmoothSolution descend();
   VectorXd y_of(const Trial &trial) const;
   VectorXd x_of(const VectorXd &y) const { return scale_.cwiseProduct(y.head(variables_)); }
   void take(const SmoothSolution &solution);
   void check_optimality(const SmoothSolution &solution);

   const DesignProblem &given_;
   const DesignSettings &settings_;
   MarchSettings march_;
   ProgressReport progress_;
   const Index variables_;
   const MatrixXd limits_; // a column per variable, also if it has none
   std::optional<Trial> trial_, best_;
   int iteration_ = 0,
       bettered_ =
          0; // number of the present trial, and of the last one that was better than all before
   double unit_ = 1;           // of the objective
   VectorXd scale_, row_unit_; // of each variable, and of each limit
   DesignReport report_;
};

/// The trial at x. Marches all cases unless x is that of the last trial or of the best one.
Trial &Design::at(const VectorXd &x)
{
   if (trial_ && trial_->x == x) { return *trial_; }
   if (best_ && best_->x == x) { return trial_.emplace(*best_); }
   trial_.emplace();
   Trial &trial = *trial_;
   trial.x = x;
   trial.problem = given_.with(x);
   if (best_ && trial.problem.friction.minCoeff() < 0)
   {
      // At the start the march refuses negative friction. Later the search turns back there.
      trial.message = "friction is negative there";
      return trial;
   }
   std::vector<double> values;
   for (const DesignCase &load_case : given_.cases)
   {
      LoadHistory history = load_case.history;
      for (Index j = 0; j < variables_; ++j)
      {
         const MatrixXd &change = given_.variables[j].multipliers;
         if (change.size() > 0) { history.multipliers += x[j] * change; }
      }
      ++report_.marches;
      trial.traces.push_back(trace_march(trial.problem, history, march_));
      const MarchTrace &trace = trial.traces.back();
      const FrictionStatus status = trace.report.status;
      if (status != FrictionStatus::converged && status != FrictionStatus::not_unique)
      {
         trial.message = "case '" + load_case.name + "': " + trace.report.message;
         return trial;
      }
      std::vector<std::size_t> states;
      for (double time : times(load_case)) { states.push_back(trace.at(time)); }
      const Responses of(trial.problem, trace);
      trial.responses.push_back(given_.objective ? given_.objective(of, states)
                                                 : pressures(trial.problem, of, states));
      for (const Response &response : trial.responses.back())
      {
         values.push_back(load_case.weight * response.value);
      }
   }
   trial.values = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
   require(trial.values.size() > 0,
           "design: the objective returned no response, must return at least one");
   require(!best_ || best_->values.size() == trial.values.size(),
           "design: the objective returned ", trial.values.size(), " responses, must return ",
           best_ ? best_->values.size() : 0, " as it did for other values of the variables");
   trial.known = trial.values.allFinite();
   // Keep the best trial. Note when it became better by more than the tolerance, because the
   // search ends when that was too long ago.
   if (trial.known && allowed(x) && (!best_ || objective(trial) < objective(*best_)))
   {
      bettered_ = !best_ || objective(trial) < objective(*best_) - settings_.tolerance * unit_
                     ? iteration_
                     : bettered_;
      best_ = trial;
   }
   return trial;
}

/// Computes the derivatives of all responses by all variables, once for each trial. If one is
/// not known, neither is the trial.
void Design::differentiate(Trial &trial)
{
   if (trial.by.size() > 0 || !trial.known) { return; }
   MatrixXd by(trial.values.size(), variables_);
   const std::vector<Parameters> changes = given_.changes(trial.x);
   Index first = 0;
   for (std::size_t c = 0; c < given_.cases.size() && trial.known; ++c)
   {
      ++report_.gradients;
      Sensitivity sensitivity(trial.problem, trial.traces[c]);
      const std::vector<Response> &responses = trial.responses[c];
      const auto count = static_cast<Index>(responses.size());
      const auto not_found = [&](const std::string &message)
      {
         trial.known = false;
         trial.message = "case '" + given_.cases[c].name + "': " + message;
      };
      // Forward derivatives cost a pass for each variable, backward ones a pass for each
      // response. Use the way with fewer passes.
      for (Index j = 0; count >= variables_ && j < variables_ && trial.known; ++j)
      {
         const TraceChange change = sensitivity.along(changes[j], march_.monitor);
         if (!change.found) { not_found(change.message); }
         for (Index i = 0; i < count && trial.known; ++i)
         {
            by(first + i, j) = change.of(responses[i]);
         }
      }
      for (Index i = 0; count < variables_ && i < count && trial.known; ++i)
      {
         const Gradient gradient = sensitivity.gradient(responses[i], march_.monitor);
         if (!gradient.found) { not_found(gradient.message); }
         for (Index j = 0; j < variables_; ++j)
         {
            by(first + i, j) = gradient.by.dot(changes[j]);
         }
      }
      by.middleRows(first, count) *= given_.cases[c].weight;
      first += count;
   }
   trial.known = trial.known && by.allFinite();
   trial.by = std::move(by);
}

bool Design::allowed(const VectorXd &x) const
{
   return (x - given_.low).minCoeff() >= 0 && (given_.high - x).minCoeff() >= 0 &&
          violated_limit(given_, x, settings_.tolerance) < 0;
}

/// Chooses units of the variables: a change by one unit changes the objective by about its
/// value at the start.
void Design::find_scales(const Trial &trial)
{
   unit_ = trial.values.cwiseAbs().maxCoeff();
   if (!(unit_ > 0)) { unit_ = 1; }
   scale_ = given_.high - given_.low;
   for (Index j = 0; j < variables_; ++j)
   {
      const double steepest = trial.by.col(j).cwiseAbs().maxCoeff();
      if (steepest > 0) { scale_[j] = std::min(scale_[j], unit_ / steepest); }
      if (!(scale_[j] > 0)) { scale_[j] = 1; }
   }
   row_unit_ = (limits_ * scale_.asDiagonal()).cwiseAbs().rowwise().maxCoeff();
   for (double &unit : row_unit_) { unit = unit > 0 ? unit : 1.0; }
}

/// The programme for Ipopt in scaled variables. For the goal of the least largest response it
/// has one more variable, which bounds all responses. With `about` responses are linear, as
/// they are at that trial, and variables stay within a radius of it.
SmoothProgramme Design::programme(const Trial *about, double radius)
{
   constexpr double none = 2e19; // what Ipopt takes for infinite
   const auto bounded = [none](const VectorXd &x)
   { return VectorXd(x.cwiseMax(-none).cwiseMin(none)); };
   const Index limits = limits_.rows(), extra = largest() ? 1 : 0,
               count = largest() ? best_->values.size() : 0;
   // 1. Bounds of the variables, and of their change from `about`. The bound of the responses
   // is free.
   SmoothProgramme p;
   p.linear = about != nullptr;
   p.low = VectorXd::Constant(variables_ + extra, -none);
   p.high = VectorXd::Constant(variables_ + extra, none);
   p.low.head(variables_) = given_.low.cwiseQuotient(scale_);
   p.high.head(variables_) = given_.high.cwiseQuotient(scale_);
   if (about)
   {
      const VectorXd middle = about->x.cwiseQuotient(scale_);
      p.low.head(variables_) =
         p.low.head(variables_).cwiseMax((middle.array() - radius).matrix());
      p.high.head(variables_) =
         p.high.head(variables_).cwiseMin((middle.array() + radius).matrix());
   }
   // 2. Conditions: no response is above the bound, and each limit holds.
   p.least = VectorXd::Constant(count + limits, -none);
   p.most = VectorXd::Zero(count + limits);
   p.least.tail(limits) = bounded(given_.least.cwiseQuotient(row_unit_));
   p.most.tail(limits) = bounded(given_.most.cwiseQuotient(row_unit_));
   // 3. Values, derivatives, and the end of the search. False where a trial is not known: Ipopt
   // then takes a shorter step.
   p.values = [this, about, count, limits](const VectorXd &y, double &f, VectorXd &c)
   {
      const VectorXd x = x_of(y);
      const Trial &trial = about ? *about : at(x);
      if (!trial.known) { return false; }
      VectorXd values = trial.values;
      if (about) { values += trial.by * (x - trial.x); }
      f = largest() ? y[variables_] : values.sum() / unit_;
      c.resize(count + limits);
      if (largest()) { c.head(count) = values.array() / unit_ - y[variables_]; }
      c.tail(limits) = (limits_ * x).cwiseQuotient(row_unit_);
      return true;
   };
   p.derivatives = [this, about, count, limits](const VectorXd &y, VectorXd &f, MatrixXd &c)
   {
      if (!about) { differentiate(at(x_of(y))); }
      const Trial &trial = about ? *about : *trial_;
      if (!trial.known) { return false; }
      const MatrixXd by = trial.by * scale_.asDiagonal() / unit_;
      f = VectorXd::Zero(y.size());
      c = MatrixXd::Zero(count + limits, y.size());
      if (largest())
      {
         f[variables_] = 1;
         c.topLeftCorner(count, variables_) = by;
         c.topRightCorner(count, 1).setConstant(-1);
      }
      else { f = by.colwise().sum().transpose(); }
      c.bottomLeftCorner(limits, variables_) =
         row_unit_.cwiseInverse().asDiagonal() * limits_ * scale_.asDiagonal();
      return true;
   };
   p.goes_on = [this, about](int iteration)
   {
      if (!about)
      {
         progress_.note(std::nan(""), iteration);
         iteration_ = iteration;
      }
      return !stopped() && (about || iteration_ - bettered_ < patience);
   };
   return p;
}

VectorXd Design::y_of(const Trial &trial) const
{
   VectorXd y(variables_ + (largest() ? 1 : 0));
   y.head(variables_) = trial.x.cwiseQuotient(scale_);
   if (largest()) { y[variables_] = trial.values.maxCoeff() / unit_; }
   return y;
}

/// Solves linear programmes within a radius. Between changes of node states pressures are
/// linear in gaps and loads, so the last programme is exact. The radius shrinks where a
/// programme promises much more than a march confirms.
SmoothSolution Design::descend()
{
   SmoothSolution last;
   Trial now = *best_;
   double radius = 0.3;
   for (int k = 0; k < settings_.max_iterations && radius > 1e-12; ++k)
   {
      progress_.note(std::nan(""), k);
      differentiate(now);
      if (!now.known)
      {
         last.outcome = ProgrammeOutcome::failed;
         last.message = now.message;
         return last;
      }
      last = solve(programme(&now, radius), y_of(now), 1e-3 * settings_.tolerance, 300);
      last.iterations = k + 1;
      if (last.outcome != ProgrammeOutcome::solved) { return last; }
      // The programme promises this improvement. If it is below the tolerance, the search is
      // done.
      const VectorXd next = x_of(last.y);
      const double promised = objective(now) - unit_ * last.y[variables_];
      if (promised <= settings_.tolerance * unit_)
      {
         last.y = y_of(now);
         return last;
      }
      // The ratio of the marched to the predicted improvement sets the trust radius, and
      // decides whether the step is taken.
      const Trial &trial = at(next);
      const double kept = trial.known ? (objective(now) - objective(trial)) / promised : -1;
      const bool far =
         (next - now.x).cwiseQuotient(scale_).cwiseAbs().maxCoeff() > 0.9 * radius;
      if (kept < 0.25) { radius *= 0.25; }
      else if (kept > 0.75 && far) { radius *= 3; }
      if (kept > 0.01) { now = trial; }
   }
   last.outcome = ProgrammeOutcome::failed;
   last.message =
      radius > 1e-12
         ? "not converged after " + std::to_string(settings_.max_iterations) +
              " iterations, the largest number allowed"
         : std::string("at this design nodes change their states, and derivatives jump");
   return last;
}

/// The conditions of optimality with the multipliers that were found, at the x of the report.
void Design::check_optimality(const SmoothSolution &solution)
{
   report_.stationarity = report_.complementarity = 0;
   Trial &trial = at(report_.x);
   differentiate(trial);
   const Index limits = limits_.rows(), count = solution.lambda.size() - limits;
   report_.bound_multipliers = unit_ * solution.z.head(variables_).cwiseQuotient(scale_);
   report_.limit_multipliers = unit_ * solution.lambda.tail(limits).cwiseQuotient(row_unit_);
   const VectorXd shares = largest() ? VectorXd(solution.lambda.head(count))
                                     : VectorXd(VectorXd::Ones(trial.values.size()));
   const VectorXd gradient = trial.by.transpose() * shares + report_.bound_multipliers +
                             limits_.transpose() * report_.limit_multipliers;
   report_.stationarity = gradient.cwiseProduct(scale_).cwiseAbs().maxCoeff() / unit_;
   if (largest())
   {
      report_.stationarity = std::max(report_.stationarity, std::abs(shares.sum() - 1));
   }
   const auto note = [&](double multiplier, double below, double above)
   {
      const double away = multiplier > 0 ? above : below;
      if (multiplier != 0)
      {
         report_.complementarity =
            std::max(report_.complementarity, std::abs(multiplier * away) / unit_);
      }
   };
   for (Index j = 0; j < variables_; ++j)
   {
      note(report_.bound_multipliers[j], report_.x[j] - given_.low[j],
           given_.high[j] - report_.x[j]);
   }
   const VectorXd at_limits = limits_ * report_.x;
   for (Index r = 0; r < limits; ++r)
   {
      note(report_.limit_multipliers[r], at_limits[r] - given_.least[r],
           given_.most[r] - at_limits[r]);
   }
   std::size_t c = 0, index = 0;
   for (Index i = 0; i < count; ++i, ++index)
   {
      while (index == trial.responses[c].size())
      {
         ++c;
         index = 0;
      }
      // A response below the largest must have no multiplier. No multiplier may be negative.
      note(shares[i], 0, report_.objective - trial.values[i]);
      report_.stationarity = std::max(report_.stationarity, -shares[i]);
      if (shares[i] > 1e-6)
      {
         report_.active.push_back({c, index, trial.values[i], shares[i]});
      }
   }
}

void Design::take(const SmoothSolution &solution)
{
   const bool solved = solution.outcome == ProgrammeOutcome::solved && !stopped();
   const VectorXd last = solved ? x_of(solution.y) : best_->x;
   const Trial &trial = at(last);
   // The last point may violate a limit by less than the tolerance. It is taken if it is as
   // good as the best point that violates none.
   const bool kept =
      trial.known && objective(trial) <= objective(*best_) + settings_.tolerance * unit_;
   report_.x = kept ? last : best_->x;
   report_.objective = objective(at(report_.x));
   report_.iterations = solution.iterations;
   report_.violation = 0;
   const VectorXd at_limits = limits_ * report_.x;
   for (Index r = 0; r < limits_.rows(); ++r)
   {
      const double off =
         std::max(given_.least[r] - at_limits[r], at_limits[r] - given_.most[r]);
      report_.violation = std::max(report_.violation, off / row_unit_[r]);
   }
   if (solved && kept) { check_optimality(solution); }
   const double most = 10 * settings_.tolerance;
   if (stopped())
   {
      report_.status = DesignStatus::stopped;
      report_.message = "the design was stopped on request";
   }
   else if (report_.stationarity <= most && report_.complementarity <= most &&
            report_.violation <= most)
   {
      report_.status = DesignStatus::optimal;
   }
   else
   {
      report_.status = DesignStatus::improved;
      report_.message = solution.outcome == ProgrammeOutcome::stopped
                           ? "no iteration of the last " + std::to_string(patience) +
                                " found a better design: nodes may change their states there, "
                                "so that derivatives "
                                "jump"
                        : solution.message.empty()
                           ? "the conditions of optimality do not hold to the tolerance"
                           : solution.message;
   }
   const Trial &found = at(report_.x);
   report_.traces = found.traces;
   for (const MarchTrace &trace : found.traces)
   {
      const std::vector<Tie> more = ties(found.problem, trace);
      report_.ties.insert(report_.ties.end(), more.begin(), more.end());
   }
}

DesignReport Design::run(const VectorXd &start)
{
   // 1. The start must have an answer and derivatives in all cases.
   report_.x = start;
   Trial &first = at(start);
   differentiate(first);
   if (!first.known)
   {
      report_.status = stopped() ? DesignStatus::stopped : DesignStatus::no_equilibrium;
      report_.message = first.message;
      report_.seconds = progress_.seconds();
      return report_;
   }
   // 2. Units of the variables follow from the derivatives at the start.
   report_.objective_at_start = objective(first);
   best_ = first;
   find_scales(first);
   // 3. Search. Peak pressures are linear between changes of states, and linear programmes end
   // in an exact optimum. All other goals go to Ipopt.
   const SmoothSolution solution =
      largest() && !given_.objective && !given_.shape
         ? descend()
         : solve(programme(), y_of(first), settings_.tolerance, settings_.max_iterations);
   if (solution.outcome == ProgrammeOutcome::unavailable)
   {
      report_.status = DesignStatus::unavailable;
      report_.message = solution.message;
      report_.objective = report_.objective_at_start;
   }
   // 4. Take the last point, or the best trial if that is better, and check the optimality
   // there.
   else { take(solution); }
   report_.seconds = progress_.seconds();
   progress_.end(1.0, report_.iterations);
   return report_;
}

} // namespace

Index violated_limit(const DesignProblem &of, const VectorXd &x, double tolerance)
{
   for (Index r = 0; r < of.limits.rows(); ++r)
   {
      const double at = of.limits.row(r).dot(x),
                   leave = tolerance * of.limits.row(r).cwiseAbs().dot(x.cwiseAbs());
      if (!(at >= of.least[r] - leave && at <= of.most[r] + leave)) { return r; }
   }
   return -1;
}

std::vector<Parameters> gap_variables(const MatrixXd &G)
{
   std::vector<Parameters> all(G.cols());
   for (Index j = 0; j < G.cols(); ++j) { all[j].gap = G.col(j); }
   return all;
}

void limit_curvature(DesignProblem &problem, double least, double most)
{
   require(least <= most, "curvature limits: the lower limit is ", least, " and the upper ",
           most, ", the lower must not be the larger");
   const ReducedProblem &of = problem.problem;
   const auto count = static_cast<Index>(problem.variables.size());
   require(count > 0, "curvature limits: the design has no variables yet, add them before");
   require(!problem.shape, "curvature limits: the gap of this design depends on its variables "
                           "nonlinearly (`shape`), must be linear in them");
   require(of.arc_length.size() == of.nodes(), "curvature limits: the problem has ",
           of.arc_length.size(), " arc lengths, must have one for each of its ", of.nodes(),
           " nodes");
   for (const ContactChain &chain : of.chains)
   {
      for (Index k = 1; k + 1 < chain.nodes; ++k)
      {
         const Index i = chain.first + k;
         const double before = std::abs(of.arc_length[i] - of.arc_length[i - 1]),
                      after = std::abs(of.arc_length[i + 1] - of.arc_length[i]);
         const auto curvature = [&](const VectorXd &gap)
         {
            return 2 * ((gap[i + 1] - gap[i]) / after - (gap[i] - gap[i - 1]) / before) /
                   (before + after);
         };
         const Index row = problem.limits.rows();
         problem.limits.conservativeResize(row + 1, count);
         problem.least.conservativeResize(row + 1);
         problem.most.conservativeResize(row + 1);
         for (Index j = 0; j < count; ++j)
         {
            const VectorXd &gap = problem.variables[j].gap;
            problem.limits(row, j) = gap.size() ? curvature(gap) : 0.0;
         }
         problem.least[row] = least - curvature(of.gap);
         problem.most[row] = most - curvature(of.gap);
      }
   }
}

std::vector<VectorXd> spread_starts(const DesignProblem &problem, const VectorXd &start,
                                    int count)
{
   problem.validate();
   const DesignSettings usual;
   require_start(problem, start, usual.tolerance);
   const Index variables = start.size();
   // The sequence of the golden ratio in d dimensions, with the root of φ^(d+1) = φ + 1.
   double phi = 2;
   for (int k = 0; k < 60; ++k)
   {
      phi = std::pow(1 + phi, 1.0 / (static_cast<double>(variables) + 1));
   }
   std::vector<VectorXd> all;
   for (int k = 1; k <= count; ++k)
   {
      VectorXd place(variables);
      for (Index j = 0; j < variables; ++j)
      {
         const double part = 0.5 + k * std::pow(phi, -static_cast<double>(j + 1));
         place[j] =
            problem.low[j] + (part - std::floor(part)) * (problem.high[j] - problem.low[j]);
      }
      all.push_back(toward(problem, start, place));
   }
   return all;
}

const char *name(DesignStatus status)
{
   const char *const names[] = {"optimal", "improved", "no equilibrium", "unavailable",
                                "stopped"};
   return names[static_cast<int>(status)];
}

void DesignSettings::validate() const
{
   march.validate();
   require(tolerance >= 1e-14 && tolerance < 1, "design settings: tolerance is ", tolerance,
           ", must be from 1e-14 to 1");
   require_at_least("design settings: max_iterations", max_iterations, 1);
}

ReducedProblem DesignProblem::with(const VectorXd &x) const
{
   require(x.size() == static_cast<Index>(variables.size()), "design: ", x.size(),
           " values are given, must be one for each of the ", variables.size(), " variables");
   ReducedProblem result = problem;
   for (Index j = 0; j < x.size(); ++j)
   {
      add(result.gap, x[j], variables[j].gap);
      add(result.friction, x[j], variables[j].friction);
   }
   MatrixXd by;
   if (shape) { result.gap += shaped(*this, x, by); }
   return result;
}

std::vector<Parameters> DesignProblem::changes(const VectorXd &x) const
{
   std::vector<Parameters> all = variables;
   MatrixXd by;
   if (shape) { shaped(*this, x, by); }
   for (Index j = 0; j < by.cols(); ++j)
   {
      if (all[j].gap.size() == 0) { all[j].gap.setZero(by.rows()); }
      all[j].gap += by.col(j);
   }
   return all;
}

void DesignProblem::validate() const
{
   problem.validate();
   const Index n = problem.nodes();
   const auto count = static_cast<Index>(variables.size());
   require(!cases.empty(), "design: there is no load case, must be at least one");
   require(count > 0, "design: there is no variable, must be at least one");
   require(low.size() == count && high.size() == count, "design: there are ", low.size(),
           " lower and ", high.size(), " upper bounds, must be one of each for the ", count,
           " variables");
   require(objective || problem.weights.size() == n,
           "design: the problem has no weights of its nodes, which pressures need");
   require(least.size() == limits.rows() && most.size() == limits.rows() &&
              (limits.rows() == 0 || limits.cols() == count),
           "design: limits is ", limits.rows(), " × ", limits.cols(), " with ", least.size(),
           " lower and ", most.size(), " upper values, must have ", count,
           " columns (variables), and a row for each lower and upper value");
   require(limits.allFinite(), "design: limits has an entry that is not finite");
   for (Index r = 0; r < limits.rows(); ++r)
   {
      require(least[r] <= most[r], "design: limit ", r, " is from ", least[r], " to ", most[r],
              ", its lower value must not be above the upper one");
   }
   for (const DesignCase &load_case : cases)
   {
      load_case.history.validate(problem);
      require(std::isfinite(load_case.weight), "design: the weight of case '", load_case.name,
              "' is ", load_case.weight, ", must be finite");
      require(!times(load_case).empty(), "design: case '", load_case.name,
              "' has no point of its history at time ", load_case.from,
              " or later, must have one");
   }
   for (Index j = 0; j < count; ++j)
   {
      require(std::isfinite(low[j]) && std::isfinite(high[j]) && low[j] <= high[j],
              "design: variable ", j, " has the bounds ", low[j], " and ", high[j],
              ", must be finite, the lower one first");
      const Parameters &by = variables[j];
      require((by.gap.size() == 0 || by.gap.size() == n) &&
                 (by.friction.size() == 0 || by.friction.size() == n),
              "design: variable ", j, " has ", by.gap.size(), " gaps and ", by.friction.size(),
              " coefficients of friction, must have none or ", n, ", one for each node");
      require(by.stiffness.size() == 0, "design: variable ", j,
              " changes the stiffness, must change gaps, friction or loads only");
      for (const DesignCase &load_case : cases)
      {
         const MatrixXd &of = load_case.history.multipliers, &change = by.multipliers;
         require(change.size() == 0 ||
                    (change.rows() == of.rows() && change.cols() == of.cols()),
                 "design: variable ", j, " has ", change.rows(), " × ", change.cols(),
                 " multipliers, must have as many as case '", load_case.name, "', ", of.rows(),
                 " × ", of.cols());
      }
   }
}

DesignReport design(const DesignProblem &problem, const VectorXd &start,
                    const DesignSettings &settings)
{
   settings.validate();
   problem.validate();
   require_start(problem, start, settings.tolerance);
   if (problem.shape) { require_derivatives(problem, start); }
   return Design(problem, settings).run(start);
}

} // namespace cattaneo
