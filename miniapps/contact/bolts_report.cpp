#include "contact/bolts_report.hpp"

#include <algorithm>
#include <cattaneo/input_error.hpp>
#include <cmath>
#include <limits>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;

BoltsReport::BoltsReport(Study &study, const JointCase &joint, const Reduction &reduction)
   : study_(study), joint_(joint), reduction_(reduction), range_(joint.bolts.size()),
     tightenings_(joint.bolts.size())
{
}

namespace
{

/// The name of a bolt's values in a saved state.
std::string kept_name(const JointCase::Bolt &bolt)
{
   return "bolt " + bolt.name;
}

/// The name of a bolt's tightenings in a saved state: point of the history and value, one after
/// the other.
std::string points_name(const JointCase::Bolt &bolt)
{
   return "points of bolt " + bolt.name;
}

} // namespace

std::vector<double> BoltsReport::tightened_before(std::size_t bolt, double time) const
{
   std::vector<double> all;
   for (const Tightening &one : tightenings_[bolt])
   {
      if (one.from >= time) { continue; }
      all.push_back(one.point);
      all.push_back(one.value);
   }
   return all;
}

void BoltsReport::check_tightenings(const ContactState &state) const
{
   const auto told = [](const std::vector<double> &all)
   {
      std::vector<std::string> words;
      for (std::size_t k = 0; k + 1 < all.size(); k += 2)
      {
         words.push_back("to " + message_text(all[k + 1]) + " at point " +
                         message_text(all[k]));
      }
      return words.empty() ? std::string("nowhere") : listed(words);
   };
   for (std::size_t k = 0; k < joint_.bolts.size(); ++k)
   {
      const auto found = state.kept.find(points_name(joint_.bolts[k]));
      if (!joint_.bolts[k].tightened || found == state.kept.end()) { continue; }
      const std::vector<double> now = tightened_before(k, state.time);
      require(now == found->second,
              "option --load-state: the march that saved the state had "
              "tightened bolt '",
              joint_.bolts[k].name, "' ", told(found->second), ", and the history tightens it ",
              told(now), " up to the time of the state, ", state.time,
              ": up to there it must be the history of that march");
   }
}

void BoltsReport::begin(const OwnHistory &march, const BoltedJoint *bolts)
{
   const LoadHistory &history = march.history();
   for (std::size_t b = 0; bolts && b < bolts->bolts().size(); ++b)
   {
      const std::string &load = bolts->bolts()[b].load;
      std::size_t k = 0;
      while (joint_.bolts[k].name != load) { ++k; }
      // Bolts are tightened only in the opening part.
      for (int p = 0; p < history.pieces() && history.piece(p).cycle == 0; ++p)
      {
         const LoadPiece piece = history.piece(p);
         if (!bolts->tightens(b, history, piece)) { continue; }
         const Index row = bolts->load(b);
         tightenings_[k].push_back({piece.point + 1, piece.start, piece.end, piece.to[row]});
         if (piece.from[row] != piece.to[row]) { continue; }
         study_.say(text("   point %d of the history (from 0) names bolt '%s', which has this "
                         "value already: it is tightened to it again (without the name its "
                         "force follows from the joint)",
                         piece.point + 1, load.c_str()));
      }
   }
   if (march.state.time == 0) { return; }
   check_tightenings(march.state);
   for (std::size_t k = 0; k < joint_.bolts.size(); ++k)
   {
      const auto found = march.state.kept.find(kept_name(joint_.bolts[k]));
      if (found == march.state.kept.end() || found->second.size() != 6)
      {
         known_from_ = march.state.time; // a file of an older version
         constexpr double far = std::numeric_limits<double>::infinity();
         range_[k].least = far;
         range_[k].most = -far;
         continue;
      }
      const std::vector<double> &its = found->second;
      range_[k] = {its[0], its[1], its[2], its[3], its[4], its[5]};
   }
}

void BoltsReport::keep(ContactState &state) const
{
   for (std::size_t k = 0; k < range_.size(); ++k)
   {
      const Range &its = range_[k];
      state.kept[kept_name(joint_.bolts[k])] = {its.load, its.least, its.most,
                                                its.push, its.tight, its.all_tight};
      state.kept[points_name(joint_.bolts[k])] = tightened_before(k, state.time);
   }
}

/// Is a bolt being tightened at this time, or does its tightening end here?
bool BoltsReport::is_tightened(std::size_t bolt, double time, double load) const
{
   if (!joint_.bolts[bolt].tightened) { return load > range_[bolt].load; }
   return std::any_of(tightenings_[bolt].begin(), tightenings_[bolt].end(),
                      [&](const Tightening &one) { return time > one.from && time <= one.to; });
}

std::vector<double> BoltsReport::shanks(const ContactState &state) const
{
   std::vector<double> forces;
   if (joint_.bolts.empty()) { return forces; }
   const VectorXd approach = conjugates(reduction_.problem, state);
   for (const JointCase::Bolt &bolt : joint_.bolts)
   {
      const int k = reduction_.problem.pattern(bolt.name);
      // Its conjugate is the approach of the ends, times the force of the pattern.
      forces.push_back(bolt.force * state.multipliers[k] -
                       bolt.stiffness * approach[k] / bolt.force);
   }
   return forces;
}

void BoltsReport::note(const ContactState &state)
{
   const std::vector<double> now = shanks(state);
   for (std::size_t k = 0; k < now.size(); ++k)
   {
      // The force of a bolt during its own tightening does not count.
      Range &range = range_[k];
      const double load =
         std::abs(state.multipliers[reduction_.problem.pattern(joint_.bolts[k].name)]);
      if (is_tightened(k, state.time, load))
      {
         range = {load, now[k], now[k], range.push, now[k], now[k]};
         for (std::size_t other = 0; other < now.size(); ++other)
         {
            range_[other].all_tight = now[other];
         }
      }
      range.push = std::max(range.push, -now[k]);
      range.least = std::min(range.least, now[k]);
      range.most = std::max(range.most, now[k]);
   }
}

void BoltsReport::report(const ContactState &state)
{
   if (joint_.bolts.empty()) { return; }
   const Units &u = study_.units;
   // Without a record of the march before, the values begin where this march continues.
   const bool begins = known_from_ > 0;
   const bool at_points = std::any_of(tightenings_.begin(), tightenings_.end(),
                                      [](const auto &all) { return !all.empty(); });
   ResultTable &table = study_.table(
      "bolts",
      {{"bolt", "bolt"},
       {"tightened_at", at_points ? "tightened at point" : ""},
       {"tightened_to", "tightened to" + u.total(0), "%.6g"},
       {"all_tightened", "when all were tightened" + u.total(0), "%.6g"},
       {"force", "force at the end" + u.total(0), "%.6g"},
       {"least", std::string(begins ? "least" : "least since tightened") + u.total(0), "%.6g"},
       {"most", std::string(begins ? "most" : "most since tightened") + u.total(0), "%.6g"},
       {"known_from", begins ? "since time" : ""}});
   if (begins)
   {
      study_.say(
         text("   the saved state is of an older version and has no values of its bolts: "
              "'least' and 'most' begin at time %g, where the march continues",
              known_from_));
   }
   const std::vector<double> now = shanks(state);
   for (std::size_t k = 0; k < now.size(); ++k)
   {
      const JointCase::Bolt &bolt = joint_.bolts[k];
      const Range &range = range_[k];
      std::vector<std::string> points;
      double last = 0; // when its tightening ended, if the march came so far
      for (const Tightening &one : tightenings_[k])
      {
         if (one.from >= state.time) { continue; }
         points.push_back(std::to_string(one.point));
         last = one.to;
      }
      const bool unknown = begins && (!bolt.tightened || last <= known_from_);
      study_.row(table, {bolt.name, listed(points), unknown ? none : range.tight,
                         unknown ? none : range.all_tight, now[k], range.least, range.most,
                         unknown ? known_from_ : none});
      // Bolts that are not tightened yet move a little with the others.
      if (bolt.tightened || range_[k].push <= 1e-3 * bolt.force) { continue; }
      warn(text(
         "bolt '%s' is compressed, by up to %g, where a real bolt would become loose: tighten "
         "it after the loads that press its ends together, or give it more pretension",
         bolt.name.c_str(), range_[k].push));
   }
}

} // namespace miniapp
