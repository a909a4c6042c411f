#include "common/film.hpp"

#include "common/load_axes.hpp"
#include "common/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace miniapp
{

using namespace cattaneo;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;

namespace
{

/// Eight digits are enough for a picture.
ordered_json rounded(double x)
{
   if (!std::isfinite(x)) { return nullptr; }
   return std::strtod(text("%.8g", x).c_str(), nullptr);
}

ordered_json list(const VectorXd &values)
{
   ordered_json list = ordered_json::array();
   for (double x : values) { list.push_back(rounded(x)); }
   return list;
}

/// Tangential nodal forces; with two components their length.
VectorXd shear(const ReducedProblem &problem, const ContactState &state)
{
   const Index n = problem.nodes();
   if (problem.components() == 0) { return VectorXd::Zero(n); }
   if (problem.components() == 1) { return state.q; }
   return state.q.reshaped(n, 2).rowwise().norm();
}

} // namespace

Film::Film(const std::string &name, const ReducedProblem &problem, const Units &units)
   : most_(std::clamp<std::size_t>(400000 / (2 * problem.nodes() + 1), 40, 600))
{
   ordered_json loads = ordered_json::array(), breaks = ordered_json::array();
   for (const LoadPattern &pattern : problem.patterns)
   {
      const bool force = pattern.control == Control::force;
      const LoadAxes axes = load_axes(pattern, units, problem.knows_loads());
      const bool known = !pattern.size.kind.empty();
      loads.push_back({{"name", pattern.name},
                       {"force", force},
                       {"size", known ? ordered_json(axes.size) : ordered_json()},
                       {"force_label", axes.force},
                       {"displacement_label", axes.displacement},
                       {"word", std::string(problem.knows_loads() ? "" : "contact ") +
                                   (force ? "displacement" : "reaction")}});
   }
   ordered_json interfaces = ordered_json::array(); // of the nodes of a chain
   for (const ContactChain &chain : problem.chains)
   {
      breaks.push_back(chain.first);
      const bool follows = !interfaces.empty() && interfaces.back()["name"] == chain.interface;
      if (!follows)
      {
         interfaces.push_back({{"name", chain.interface}, {"first", chain.first}});
      }
      interfaces.back()["end"] = chain.first + chain.nodes;
   }
   if (interfaces.empty())
   {
      interfaces.push_back({{"name", ""}, {"first", 0}, {"end", problem.nodes()}});
   }
   ordered_json places = ordered_json::array(); // x and y of the nodes, where they are known
   for (Index c = 0; c < problem.position.cols(); ++c)
   {
      places.push_back(list(problem.position.col(c)));
   }
   head_ = {{"name", name},
            {"loads", loads},
            {"position", list(problem.arc_length)},
            {"friction", list(problem.friction)},
            {"places", places},
            {"breaks", breaks},
            {"interfaces", interfaces}};
}

void Film::show_maps(const ordered_json &interfaces, Fields fields)
{
   head_["interfaces"] = interfaces;
   head_["places"] = ordered_json::array();
   head_["position"] = ordered_json::array();
   head_["maps"] = true;
   fields_ = std::move(fields);
   // A map has five numbers a node.
   most_ = std::clamp<std::size_t>(most_ / 3, 20, 200);
}

void Film::add(const ReducedProblem &problem, const ContactState &state,
               const IncrementRecord &record)
{
   last_ = Frame{history_.size(), {}, {}, {}};
   if (fields_) { last_.others = fields_(state); }
   else
   {
      last_.p = tractions(problem, state.p);
      last_.q = tractions(problem, shear(problem, state));
      ordered_json &zones = last_.others["zones"] = ordered_json::array();
      for (const Zone &zone : drawn_zones(problem, state))
      {
         zones.push_back({name(zone.state), rounded(zone.from.position),
                          rounded(zone.to.position), problem.chains[zone.chain].interface});
      }
   }
   if (history_.size() % stride_ == 0) { frames_.push_back(last_); }
   history_.push_back({{"time", record.time},
                       {"cycle", record.cycle},
                       {"loads", list(record.multipliers)},
                       {"conjugates", list(record.conjugates)},
                       {"dissipation", rounded(record.dissipation)}});
   if (frames_.size() <= most_) { return; }
   std::vector<Frame> kept;
   for (std::size_t k = 0; k < frames_.size(); k += 2) { kept.push_back(frames_[k]); }
   frames_ = kept;
   stride_ *= 2;
}

ordered_json Film::Frame::json() const
{
   ordered_json frame = {{"row", row}};
   if (p.size() > 0)
   {
      frame["p"] = list(p);
      frame["q"] = list(q);
   }
   frame.update(others);
   return frame;
}

ordered_json Film::json() const
{
   ordered_json film = head_;
   film["stride"] = stride_;
   film["history"] = history_;
   ordered_json &frames = film["frames"] = ordered_json::array();
   for (const Frame &frame : frames_) { frames.push_back(frame.json()); }
   if (frames_.back().row != last_.row) { frames.push_back(last_.json()); }
   return film;
}

std::vector<Zone> drawn_zones(const ReducedProblem &problem, const ContactState &state)
{
   const double length = problem.arc_length.maxCoeff() - problem.arc_length.minCoeff(),
                half = 0.4 * length / std::max<double>(1, problem.nodes() - 1);
   std::vector<Zone> list = zones(problem, state);
   for (Zone &zone : list)
   {
      if (zone.first != zone.last || zone.from.position != zone.to.position) { continue; }
      zone.from.position -= half;
      zone.to.position += half;
   }
   return list;
}

} // namespace miniapp
