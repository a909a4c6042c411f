#pragma once

#include <cattaneo/friction/exact_path.hpp>
#include <cattaneo/friction/near_contact.hpp>

namespace cattaneo
{

/// An ExactPath that leaves out the nodes that are far from touching, see NearContacts.
class NearPath
{
public:
   /// All must outlive the path. InputError as ExactPath's.
   explicit NearPath(NearContacts &near);

   // As ExactPath's.
   bool starts_from(const ContactState &state) const { return whole_.starts_from(state); }
   bool advance(ContactState &state, const PathWay &way, std::vector<StateChange> &changes);
   Eigen::Index event() const { return event_; }
   const Eigen::VectorXd &slip_error() const { return slip_error_; }
   const std::string &failure() const { return last_->failure(); }
   const char *found_by() const { return last_->found_by(); }
   bool ended() const { return last_->ended(); }
   Counters counters() const;

private:
   std::optional<NearContacts::Way> set_out(const ContactState &state, int eighths);

   NearContacts &contacts_;
   ExactPath whole_;
   std::shared_ptr<NearContact> near_; // the problem of path_
   std::unique_ptr<ExactPath> path_;
   // The near problem's state, as long as its loads hold for that state, and for how many
   // steps.
   std::optional<ContactState> part_;
   Eigen::VectorXd u_; // displacements of the whole there
   long parts_ = 0;
   int steps_ = 0;
   ExactPath *last_ = &whole_; // that was advanced
   Eigen::Index event_ = -1;
   Eigen::VectorXd slip_error_;
   Counters counters_; // of paths that were discarded
};

} // namespace cattaneo
