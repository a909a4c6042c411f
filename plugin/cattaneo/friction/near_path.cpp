#include <cattaneo/friction/near_path.hpp>

namespace cattaneo
{

using Eigen::VectorXd;

NearPath::NearPath(NearContacts &near) : contacts_(near), whole_(near.problem()) {}

/// Continues from the end of the last step. Every sixteenth step begins anew, to remove
/// accumulated round-off.
std::optional<NearContacts::Way> NearPath::set_out(const ContactState &state, int eighths)
{
   constexpr int most_steps = 16;
   if (part_ && near_->eighths() == eighths && near_->parts() == parts_ &&
       steps_ < most_steps && state.displacements() == u_ &&
       near_->loads(state.multipliers) == part_->multipliers)
   {
      return NearContacts::Way{near_, *part_};
   }
   steps_ = 0;
   return contacts_.set_out(state, eighths);
}

bool NearPath::advance(ContactState &state, const PathWay &way,
                       std::vector<StateChange> &changes)
{
   const std::size_t listed = changes.size();
   for (int eighths = contacts_.eighths(state); eighths > 0;)
   {
      auto part = set_out(state, eighths);
      if (!part) { break; }
      if (near_ != part->near)
      {
         if (path_) { counters_ += path_->counters(); }
         near_ = part->near;
         part_.reset();
         path_ = std::make_unique<ExactPath>(near_->problem());
      }
      last_ = path_.get();
      const VectorXd to = near_->loads(way.multipliers), at_stop = near_->loads(way.at_stop);
      if (!path_->advance(part->part, {way.time, to, way.stop, at_stop}, changes))
      {
         return false;
      }
      ContactState next = near_->whole(state, part->part);
      if (const int more = contacts_.touched(next, eighths); more > 0)
      {
         changes.resize(listed);
         eighths = more;
         continue;
      }
      for (std::size_t k = listed; k < changes.size(); ++k)
      {
         changes[k].node = near_->node(changes[k].node);
         changes[k].multipliers = state.multipliers;
      }
      ++steps_;
      parts_ = near_->parts();
      u_ = next.displacements();
      part_ = std::move(part->part);
      event_ = path_->event() < 0 ? -1 : near_->node(path_->event());
      slip_error_ = VectorXd::Zero(state.v.size());
      for (Eigen::Index i = 0; i < path_->slip_error().size(); ++i)
      {
         slip_error_[near_->node(i)] = path_->slip_error()[i];
      }
      state = std::move(next);
      return true;
   }
   last_ = &whole_;
   const bool advanced = whole_.advance(state, way, changes);
   event_ = whole_.event();
   slip_error_ = whole_.slip_error();
   return advanced;
}

Counters NearPath::counters() const
{
   Counters sum = counters_;
   sum += whole_.counters();
   if (path_) { sum += path_->counters(); }
   return sum;
}

} // namespace cattaneo
