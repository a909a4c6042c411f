// Random increments and marches over families of problems that are hard for a friction solver,
// judged by the laws in long double (campaign_laws.hpp).
//
//    campaign -increments 300000 -save findings
//    campaign -family hilbert -stepping exact -increments 10000 -seed 3
//    campaign -replay findings/NAME
#include "campaign_laws.hpp"
#include "campaign_problems.hpp"
#include <cattaneo/friction/march.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <sys/time.h>
#include <unistd.h>

using namespace campaign;
using namespace cattaneo;

namespace
{
using Clock = std::chrono::steady_clock;
double since(Clock::time_point start)
{
   return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What one answer states of its own accuracy, relative to the largest force.
template <class Answer>
double stated(const Answer &answer)
{
   return std::max({answer.residual_normal, answer.residual_tangential, answer.round_off});
}

/// By how much an answer may break a law, over its largest force. Its forces were formed in
/// double and differ from the true ones by its round-off at most; its residual was found with
/// these. A bound of friction f p differs by f times as much besides.
template <class Answer>
double may_break(const Answer &answer, double friction)
{
   return std::max(answer.residual_normal, answer.residual_tangential) +
          (1 + friction) * answer.round_off;
}

/// The march that is being run, for the case that it does not end.
char running[200];
void hangs(int)
{
   (void)!write(2, running, std::strlen(running));
   _exit(3);
}

enum Class
{
   violated,
   misnamed,
   wrong_loss,
   false_statement,
   missed,
   unsure,
   unjustified,
   overstated,
   stalled,
   solvable,
   thrown,
   slow,
   classes
};
const char *const class_names[] = {"violation", "misnamed",   "wrong_loss",  "false_mechanism",
                                   "missed",    "unverified", "unjustified", "overstated",
                                   "stalled",   "solvable",   "exception",   "slow"};

struct Row
{
   long increments = 0, accepted = 0, sliding = 0, none = 0, not_unique = 0, fallbacks = 0;
   long count[classes] = {};
   double worst = 0, slowest = 0, seconds = 0;
   std::map<std::string, long> methods; ///< that found an answer, and how often
   void add(const Row &o)
   {
      for (const auto &[method, times] : o.methods) methods[method] += times;
      increments += o.increments, accepted += o.accepted, sliding += o.sliding, none += o.none;
      not_unique += o.not_unique, fallbacks += o.fallbacks, seconds += o.seconds;
      for (int k = 0; k < classes; ++k) count[k] += o.count[k];
      worst = std::max(worst, o.worst), slowest = std::max(slowest, o.slowest);
   }
};

struct Find
{
   Class kind;
   double size;
   std::string name, stepping, what;
   Case made;
};

class Campaign
{
public:
   bool verbose = false;
   unsigned limit = 300; ///< seconds of CPU that one march may take, whatever else runs
   std::map<std::string, std::map<std::string, Row>> table;
   std::vector<Find> finds;
   std::string family, label, stepping;

   void run(const Case &made)
   {
      made_ = &made;
      std::snprintf(running, sizeof running, "does not end: %s %s\n", label.c_str(),
                    stepping.c_str());
      itimerval after{};
      after.it_value.tv_sec = limit;
      setitimer(ITIMER_PROF, &after, nullptr);
      row_ = &table[family][stepping];
      const auto start = Clock::now();
      try
      {
         Laws laws(made.problem);
         laws_ = &laws;
         existence_.reset();
         ContactState state = made.slip.size()
                                 ? ContactState::with_slip(made.problem, made.slip)
                                 : ContactState::virgin(made.problem);
         u_ = Laws::displacements(state);
         state_ = state;
         scale_ = laws.scale(u_, made.history[0]);
         if (stepping == "increment") step_through(state);
         else march_through(state);
      }
      catch (const std::exception &e)
      {
         note(thrown, 1, e.what());
      }
      row_->seconds += since(start);
   }

private:
   const Case *made_ = nullptr;
   Row *row_ = nullptr;
   const Laws *laws_ = nullptr;
   std::unique_ptr<Existence> existence_;
   ContactState state_; // the last accepted one
   Vector u_;           // its displacements
   Real scale_ = 0;

   void note(Class kind, double size, const std::string &what)
   {
      ++row_->count[kind];
      if (verbose) std::printf("   %s %.3g: %s\n", class_names[kind], size, what.c_str());
      int held = 0;
      Find *least = nullptr;
      for (Find &find : finds)
         if (find.kind == kind && find.stepping == stepping &&
             find.name.find(family + "-") == 0)
         {
            ++held;
            if (!least || find.size < least->size) least = &find;
         }
      if (held < 2) finds.push_back({kind, size, label, stepping, what, *made_});
      else if (size > least->size) *least = {kind, size, label, stepping, what, *made_};
   }

   template <class Answer>
   void accepted(const ContactState &state, const Answer &answer, const double *loss)
   {
      const double accuracy = stated(answer);
      ++row_->accepted;
      scale_ = std::max(scale_, laws_->scale(u_, state.multipliers));
      const Real scale = std::max(scale_, Real(1e-4000L));
      const Vector u = Laws::displacements(state);
      Violation wrong;
      const Violation v = laws_->judge(u, u_, state, &wrong);
      const double worst = v.size / scale;
      // An answer without any force, before or after, states its accuracy in the problem's own
      // unit: there is no largest force.
      const bool forceless =
         state_.peak_force == 0 && laws_->loads(state.multipliers).isZero(Real(0));
      const Real leave =
         std::max(Real(1e-9) * scale, Real(may_break(answer, double(laws_->f.maxCoeff())) *
                                           (forceless ? 1.0 : state.peak_force)));
      char text[200];
      std::snprintf(text, sizeof text, "%s at node %d, t %.6g, stated %.1e", v.law, int(v.node),
                    state.time, accuracy);
      if (verbose)
      {
         std::printf("   t %.17g worst %.2e %s%s\n      v", state.time, worst, text,
                     loss ? (", loss " + std::to_string(*loss)).c_str() : "");
         for (const double x : state.v) std::printf(" %.9g", x);
         std::printf("  w");
         for (const double x : state.w) std::printf(" %.9g", x);
         std::printf("  q");
         for (const double x : state.q) std::printf(" %.9g", x);
         std::printf("  p");
         for (const double x : state.p) std::printf(" %.9g", x);
         std::printf(" ");
         for (const NodeState x : state.status) std::printf(" %s", name(x));
         std::puts("");
      }
      row_->worst = std::max(row_->worst, accuracy > 1e-9 ? 0 : worst);
      if (v.size > leave) note(violated, worst, text);
      else if (wrong.size > leave)
      {
         std::snprintf(text, sizeof text, "%s at node %d, t %.6g, stated %.1e", wrong.law,
                       int(wrong.node), state.time, accuracy);
         note(misnamed, wrong.size / scale, text);
      }
      if (accuracy > 1e-9)
      {
         const double floor = laws_->round_off(u, u_, state, scale);
         std::snprintf(text, sizeof text, "stated %.1e, round-off in long double %.1e, t %.6g",
                       accuracy, floor, state.time);
         note(overstated, accuracy, text);
         if (accuracy > 100 * floor) note(unjustified, accuracy / floor, text);
      }
      if (loss) check_loss(*loss, u, state, scale, accuracy);
      u_ = u;
      state_ = state;
   }

   /// ½ f (p + p₁)|Δv| of every node, p the pressure at which it begins to slip: in the plane
   /// where what is left of its friction, r = f p + (slip's sense) q, is used up, as it changes
   /// linearly to what it would be had the node stuck; in the disc, between p₀ and p₁.
   void check_loss(double loss, const Vector &u, const ContactState &state, Real scale,
                   double accuracy)
   {
      const Index n = laws_->n, c = laws_->c;
      Real least = 0, most = 0, far = 0, vague = 0;
      const Vector step = u - u_;
      for (Index i = 0; i < n && c > 0; ++i)
      {
         const Real p0 = std::max(state_.p[i], 0.0), p1 = std::max(state.p[i], 0.0),
                    f = laws_->f[i], way = laws_->tangential(step, i);
         Real low = std::min(p0, p1), high = std::max(p0, p1);
         if (c == 1)
         {
            const Real sense = step[i] > 0 ? 1 : -1, left = f * p0 + sense * state_.q[i],
                       stuck = f * p1 + sense * (state.q[i] - laws_->K(i, i) * step[i]);
            const Real share =
               left > 0 && left > stuck ? std::min(left / (left - stuck), Real(1)) : 0;
            low = high = p0 + share * (p1 - p0);
            // Forces are known to round-off, and where they reach a bound as well.
            vague += f * std::abs(p1 - p0) / laws_->K(i, i);
         }
         least += f * way / 2 * (low + p1);
         most += f * way / 2 * (high + p1);
         far += f * way;
      }
      // Forces are as the answer states them, and so is their work.
      const Real known = std::max(accuracy, 1e-13) * scale;
      const Real leave = 1e-9 * most + known * (far + vague);
      if (loss >= 0 && loss >= least - leave && loss <= most + leave) return;
      char text[200];
      std::snprintf(text, sizeof text, "loss %.9g, must be %.9g ... %.9g, t %.6g", loss,
                    double(least), double(most), state.time);
      const Real off = std::max(least - loss, loss - most);
      note(wrong_loss, double(off / (most + scale * far)), text);
   }

   /// An increment to these loads that was not solved: is what is said of it true? Where a
   /// march ended that is so if it is at any of several loads beyond, the first the farthest:
   /// there may be equilibria again soon, as where loads that balance each other pass through
   /// zero and little holds a body for a moment.
   void failed(FrictionStatus status, const std::string &message,
               const std::vector<Eigen::VectorXd> &loads)
   {
      const bool stall = status == FrictionStatus::stalled;
      if (!stall) ++(status == FrictionStatus::gross_sliding ? row_->sliding : row_->none);
      Verdict none = Verdict::open;
      if (!stall || laws_->K.rows() <= 40)
      {
         if (!existence_) existence_ = std::make_unique<Existence>(*laws_);
         for (const Eigen::VectorXd &load : loads)
         {
            none = existence_->none(u_, load);
            if (none != Verdict::wrong) break;
         }
      }
      const char *const truths[] = {"there is no equilibrium", "there is one",
                                    "not known whether there is one"};
      char text[400];
      std::snprintf(text, sizeof text, "%s [%s; %d motions, margin %.1e] %s", name(status),
                    truths[int(none)], existence_ ? int(existence_->motions()) : -1,
                    existence_ ? existence_->margin : 0, message.c_str());
      // "None was found, friction is above critical" claims no mechanism.
      const bool claim = status == FrictionStatus::gross_sliding ||
                         message.find("critical") == std::string::npos;
      if (stall) note(none == Verdict::wrong ? solvable : stalled, 1, text);
      else if (none != Verdict::right)
         note(none == Verdict::open ? unsure : claim ? false_statement : missed, 1, text);
      else if (verbose) std::printf("   %s\n", text);
   }

   void timed(double seconds, double time)
   {
      row_->slowest = std::max(row_->slowest, seconds);
      if (seconds > 0.5) note(slow, seconds, "increment to t " + std::to_string(time));
   }

   void step_through(ContactState &state)
   {
      FrictionSolver solver(made_->problem);
      for (std::size_t k = 1; k < made_->history.size(); ++k)
      {
         ++row_->increments;
         const auto start = Clock::now();
         const IncrementReport report = solver.solve(state, made_->history[k]);
         timed(since(start), k);
         state.time = k;
         if (report.status == FrictionStatus::not_unique) ++row_->not_unique;
         if (report.status == FrictionStatus::converged ||
             report.status == FrictionStatus::not_unique)
         {
            ++row_->methods[report.found_by];
            accepted(state, report, nullptr);
         }
         else
         {
            ++row_->methods["none"];
            if (Laws::displacements(state) != u_)
               note(violated, 1, "a failure moved the state");
            failed(report.status, report.message, {made_->history[k]});
         }
      }
   }

   void march_through(ContactState &state)
   {
      MarchSettings settings;
      settings.increments = made_->increments;
      settings.single_increment_if_exact = made_->single_if_exact;
      settings.stop_at_steady_state = false;
      settings.stepping = stepping == "exact" ? Stepping::exact : Stepping::fixed;
      settings.every_event = true; // every accepted state is judged
      auto last = Clock::now();
      const LoadHistory history = LoadHistory::through(made_->history);
      const MarchReport report =
         march(made_->problem, history, state, settings,
               [&](const ContactState &now, const IncrementRecord &record)
               {
                  ++row_->increments;
                  ++row_->methods[record.found_by];
                  timed(since(last), now.time);
                  accepted(now, record, &record.dissipation);
                  last = Clock::now();
               });
      timed(since(last), report.time);
      row_->fallbacks += report.fallbacks;
      for (int k = 0; k < report.stalled; ++k) note(stalled, 0, "passed by shorter increments");
      if (report.status == FrictionStatus::not_unique) ++row_->not_unique;
      if (verbose)
         std::printf("   march: %s %s; %d fallbacks: %s\n", name(report.status),
                     report.message.c_str(), report.fallbacks, report.fallback_reason.c_str());
      if (report.status != FrictionStatus::converged &&
          report.status != FrictionStatus::not_unique)
      {
         // Just beyond the last equilibrium there should be none.
         ++row_->increments;
         const std::size_t piece = std::min<std::size_t>(
            std::max(0.0, std::floor(report.event_time)), made_->history.size() - 2);
         const Eigen::VectorXd rest = made_->history[piece + 1] - report.event_multipliers;
         std::vector<Eigen::VectorXd> beyond;
         for (const double share : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
            beyond.push_back(report.event_multipliers + share * rest);
         failed(report.status, report.message, beyond);
      }
   }
};

void keep(const Find &find, const std::string &file)
{
   save(find.made.problem, file + ".json");
   std::ofstream out(file + ".txt");
   out.precision(17);
   out << "# " << find.stepping << ' ' << find.made.increments << ' '
       << find.made.single_if_exact << ' ' << find.what << '\n';
   if (find.made.slip.size()) out << "# slip " << find.made.slip.transpose() << '\n';
   for (const auto &point : find.made.history) out << point.transpose() << '\n';
}

int replay(const std::string &file)
{
   Case made;
   made.problem = load_reduced_problem(file + ".json");
   Campaign campaign;
   campaign.verbose = true;
   std::ifstream in(file + ".txt");
   std::string line, word;
   for (bool first = true; std::getline(in, line); first = false)
   {
      std::istringstream words(line);
      if (line[0] == '#') words >> word;
      if (line[0] == '#' && first)
         words >> campaign.stepping >> made.increments >> made.single_if_exact;
      else if (line[0] == '#') words >> word;
      if (line[0] == '#' && first) continue;
      std::vector<double> values;
      for (double x; words >> x;) values.push_back(x);
      const Eigen::VectorXd all = Eigen::Map<Eigen::VectorXd>(values.data(), values.size());
      if (line[0] == '#') made.slip = all;
      else made.history.push_back(all);
   }
   campaign.family = campaign.label = "replay";
   campaign.run(made);
   return 0;
}

/// A line of the table, or its head.
void print(const std::string &family, const std::string &stepping, const Row *r)
{
   std::printf("%-20s %-9s", family.c_str(), stepping.c_str());
   const Row &x = r ? *r : Row();
   const std::vector<std::pair<const char *, long>> counts = {
      {"increments", x.increments},
      {"accepted", x.accepted},
      {"sliding", x.sliding},
      {"none", x.none},
      {"not unique", x.not_unique},
      {"stalled", x.count[stalled] + x.count[solvable]},
      {"solvable", x.count[solvable]},
      {"fallback", x.fallbacks},
      {">1e-9", x.count[overstated]},
      {"unjust", x.count[unjustified]},
      {"violation", x.count[violated]},
      {"misnamed", x.count[misnamed]},
      {"wrong loss", x.count[wrong_loss]},
      {"false", x.count[false_statement]},
      {"missed", x.count[missed]},
      {"unverified", x.count[unsure]},
      {"thrown", x.count[thrown]}};
   for (const auto &[title, count] : counts)
      r ? std::printf(" %*ld", std::max(6, int(std::strlen(title))), count)
        : std::printf(" %6s", title);
   if (r) std::printf(" %8.1e %10.1f %7.1f\n", x.worst, 1e3 * x.slowest, x.seconds);
   else std::puts("    worst slowest/ms seconds");
   std::fflush(stdout);
}
/// Which method found the answers, by family: over all ways of stepping, failures of single
/// increments under "none".
void print_methods(const std::map<std::string, std::map<std::string, Row>> &table,
                   const Row &total)
{
   std::printf("\nanswers by the method that found them\n%-20s", "family");
   for (const auto &[method, times] : total.methods) std::printf("  %s", method.c_str());
   std::puts("");
   const auto line = [&](const std::string &family, const std::map<std::string, long> &found)
   {
      std::printf("%-20s", family.c_str());
      for (const auto &[method, times] : total.methods)
      {
         const auto here = found.find(method);
         std::printf("  %*ld", int(method.size()), here == found.end() ? 0 : here->second);
      }
      std::puts("");
   };
   long answers = 0;
   for (const auto &[method, times] : total.methods)
      if (method != "none") answers += times;
   for (const auto &[family, rows] : table)
   {
      Row sum;
      for (const auto &[stepping, row] : rows) sum.add(row);
      line(family, sum.methods);
   }
   line("all", total.methods);
   std::printf("%-20s", "% of the answers");
   for (const auto &[method, times] : total.methods)
      std::printf("  %*.2f", int(method.size()), 100.0 * times / std::max(1L, answers));
   std::puts("\n");
}
} // namespace

int main(int argc, char **argv)
{
   std::string family, stepping, folder;
   std::uint64_t seed = 1;
   long increments = 4000, only = -1, limit = 300;
   bool verbose = false;
   for (int k = 1; k < argc; ++k)
   {
      const std::string option = argv[k];
      const char *value = k + 1 < argc ? argv[++k] : "";
      if (option == "-family") family = value;
      else if (option == "-stepping") stepping = value;
      else if (option == "-seed") seed = std::atoll(value);
      else if (option == "-increments") increments = std::atol(value);
      else if (option == "-case") only = std::atol(value), verbose = true;
      else if (option == "-limit") limit = std::atol(value);
      else if (option == "-save") folder = value;
      else if (option == "-replay") return replay(value);
      else
      {
         std::cerr << "campaign: unknown option '" << option
                   << "'; there are -family NAME -stepping increment|fixed|exact "
                      "-seed S -increments N "
                      "-limit SECONDS -save FOLDER -case K -replay FILE\n";
         return 1;
      }
   }
   Campaign campaign;
   campaign.verbose = verbose;
   campaign.limit = limit;
   std::signal(SIGPROF, hangs);
   const char *const steppings[] = {"increment", "fixed", "exact"};
   std::vector<std::pair<const FamilyEntry *, int>> all;
   double weight = 0;
   for (const FamilyEntry &f : families())
      for (int c = 1; c <= 2; ++c)
         if (family.empty() || family == (c == 2 ? "disc_" : "") + f.name)
            all.push_back({&f, c}), weight += f.weight(c);
   print("family", "stepping", nullptr);
   Row total;
   for (const auto &[f, c] : all)
   {
      campaign.family = (c == 2 ? "disc_" : "") + f->name;
      const auto done = [&, f = f, c = c]
      {
         long sum = 0;
         for (const auto &row : campaign.table[campaign.family]) sum += row.second.increments;
         return sum * weight >= increments * f->weight(c);
      };
      for (int number = only < 0 ? 0 : only; only < 0 ? !done() : number == only; ++number)
      {
         const Case made = make_case(*f, c, seed, number);
         for (const char *s : steppings)
         {
            if (!stepping.empty() && stepping != s) continue;
            campaign.stepping = s;
            campaign.label =
               campaign.family + "-" + std::to_string(seed) + "-" + std::to_string(number);
            campaign.run(made);
         }
      }
      for (const char *s : steppings)
         if (campaign.table[campaign.family].count(s))
         {
            print(campaign.family, s, &campaign.table[campaign.family][s]);
            total.add(campaign.table[campaign.family][s]);
         }
   }
   print("all", "", &total);
   print_methods(campaign.table, total);
   std::sort(campaign.finds.begin(), campaign.finds.end(),
             [](const Find &a, const Find &b)
             { return a.kind != b.kind ? a.kind < b.kind : a.size > b.size; });
   for (const Find &find : campaign.finds)
   {
      const std::string name =
         std::string(class_names[find.kind]) + "-" + find.name + "-" + find.stepping;
      std::printf("%-60s %9.2e  %s\n", name.c_str(), find.size, find.what.c_str());
      if (!folder.empty()) keep(find, folder + "/" + name);
   }
   return total.count[violated] + total.count[misnamed] + total.count[wrong_loss] +
                total.count[false_statement] + total.count[unjustified] + total.count[thrown]
             ? 2
             : 0;
}
