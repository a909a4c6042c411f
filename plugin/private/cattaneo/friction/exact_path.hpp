#pragma once

#include <cattaneo/counters.hpp>
#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <string>

namespace cattaneo
{

/// Adds the nodes of a state that change to other states there.
void list_changes(const ContactState &from, const std::vector<NodeState> &to,
                  std::vector<StateChange> &changes);

/** The exact path of frictional contact: where loads change linearly, displacements and forces
    do too, until a node reaches a boundary of its state (a gap closes, a pressure vanishes,
    friction is exhausted). There, and where the loads turn, the nodes on a boundary choose new
    states such that the rates meet the laws of contact and friction: a small complementarity
    problem. One inverse is kept through all changes by low-rank updates; there is no step
    size.

    The state alone says which nodes are on a boundary (to round-off), so that a path can be cut
    at any event and resumed: the result is the same to round-off. */
class ExactPath
{
public:
   /// A problem with friction, which must outlive the path. InputError unless it has one
   /// tangential component a node: the disc of two has no straight sides.
   explicit ExactPath(const ReducedProblem &problem);

   /// Is the state an equilibrium that meets the laws (to round-off)? A path can only start
   /// from one; an initial slip or interference is none.
   bool starts_from(const ContactState &state) const;

   /** Advances `state` along loads that change linearly to `multipliers` at `time`, as far as
       the next event or to there, and appends the changes of state with which it set out.
       False, with the state unchanged, if no rates meet the laws (see failure()): the loads
       cannot rise further, or not slowly. */
   bool advance(ContactState &state, double time, const Eigen::VectorXd &multipliers,
                std::vector<StateChange> &changes);

   /// Node that met the boundary of its state where the last advance() ended; -1: none did.
   Eigen::Index event() const { return event_; }
   /// How well the slips of the last advance() are known, one for each node: round-off of the
   /// state before, times what the conditioning of the equations makes of it.
   const Eigen::VectorXd &slip_error() const { return slip_error_; }
   const std::string &failure() const { return failure_; }
   /// The method that found the rates of the last advance(), as a march records it.
   const char *found_by() const { return found_by_; }
   /// The last advance() failed since no rates meet the laws, with equations that can be
   /// solved.
   bool ended() const { return ended_; }
   const Counters &counters() const { return counters_; }

private:
   void find_choices(const ContactState &state);
   bool hold_pivot(std::vector<NodeState> states);
   bool release_pivot();
   bool find_rates(const ContactState &state, const Eigen::VectorXd &multipliers);
   double left(Eigen::Index node, double sense) const;
   double rate(Eigen::Index node, double sense) const;
   template <class Visitor>
   void for_each_boundary(Visitor visit) const;
   double way_to_event();
   double way_past_event() const;

   const ReducedProblem &problem_;
   const Eigen::MatrixXd &K_; // the problem's
   StateEquations equations_;
   Eigen::VectorXd u_, F_;           // displacements {v; w} and forces {q; p}
   Eigen::VectorXd u_rate_, F_rate_; // over the rest of the piece
   // Where u_rate_ and F_rate_ hold with the states of the equations, as long as those stay.
   Eigen::VectorXd reached_, target_;
   ComplementarityProblem rates_;
   Eigen::VectorXd slip_error_;
   Eigen::VectorXd noise_; // of each node: forces below this are round-off
   // A motion that nothing resists and nothing drives, and the node that is said to touch while
   // rates are found; -1: there is none.
   Eigen::VectorXd pivot_;
   Eigen::Index held_ = -1;
   bool ended_ = false;
   Eigen::Index event_ = -1;
   std::string failure_;
   const char *found_by_ = "";
   Counters counters_;
};

} // namespace cattaneo
