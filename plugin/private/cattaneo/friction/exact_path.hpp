#pragma once

#include <cattaneo/counters.hpp>
#include <cattaneo/friction/complementarity.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>
#include <optional>
#include <string>

namespace cattaneo
{

/// Adds the nodes of a state that change their states there.
void list_changes(const ContactState &from, const std::vector<NodeState> &to,
                  std::vector<StateChange> &changes);

/// A straight piece of an exact path. The loads change linearly from those of the state to
/// `multipliers` at `time`. The path is followed as far as a stop on the way, at most to that
/// end.
struct PathWay
{
   double time;                        ///< of its end
   const Eigen::VectorXd &multipliers; ///< there
   double stop;                        ///< time of the stop
   const Eigen::VectorXd &at_stop;     ///< multipliers there
};

/** The exact path of frictional contact: where loads change linearly, displacements and forces
    do too, until a node reaches a boundary of its state (a gap closes, a pressure vanishes,
    friction is exhausted). There, and where the direction of the loads changes, the nodes on a
    boundary get new states such that the rates meet the laws of contact and friction. This is a
    small complementarity problem. One inverse is kept through all changes by low-rank updates;
    there is no step size.

    The state alone says which nodes are on a boundary (to round-off), so that a path can be cut
    at any event and resumed: the result is the same to round-off. */
class ExactPath
{
public:
   /// The problem must have friction and outlive the path. InputError unless it has one
   /// tangential component a node, as the friction disc of two has no straight sides.
   explicit ExactPath(const ReducedProblem &problem);

   /// Is the state an equilibrium that obeys the laws (to round-off)? A path can only start
   /// from such a state, and not from an initial slip or interference.
   bool starts_from(const ContactState &state) const;

   /** Advances `state` to the next event or to the stop, and appends the changes of state at
       the start of this step. A stop is no event: rates and factor are kept across it. If the
       path cannot be continued, it returns false and leaves the state unchanged; failure() says
       why. */
   bool advance(ContactState &state, const PathWay &way, std::vector<StateChange> &changes);

   /// Node that reached the boundary of its state at the end of the last advance(); -1: none
   /// did.
   Eigen::Index event() const { return last_.event; }
   /// Error of each node's slip in the last advance(): the round-off of the previous state,
   /// amplified by the conditioning of the equations.
   const Eigen::VectorXd &slip_error() const { return last_.slip_error; }
   /// Why the last advance() failed, in a sentence (see docs/increments.md).
   const std::string &failure() const { return last_.failure; }
   /// The method that found the rates of the last advance(), for the record of a march.
   const char *found_by() const { return last_.found_by; }
   /// Did the last advance() fail because no rates meet the laws, although the equations of the
   /// states could be solved? Then equilibria may end here. A march takes this for their end,
   /// if increments beyond, by a little and to the next stop, both stall. Other failures tell
   /// nothing about equilibria: after these a stall leads to an increment in place of the path.
   bool ended() const { return last_.ended; }
   const Counters &counters() const { return counters_; }

private:
   double set_out(const ContactState &state, const PathWay &way);
   void find_choices(const ContactState &state);
   bool set_piece(Eigen::Index node, double pressure);
   bool find_pieces(const ContactState &state);
   bool turn_bends();
   Eigen::VectorXd intercepts(const std::vector<NodeState> &states) const;
   bool set_states(const ContactState &state);
   bool place_pivot(std::vector<NodeState> states);
   bool release_pivot();
   bool search_rates(std::optional<ComplementarityReport> known,
                     const std::vector<NodeState> &present);
   bool find_rates(const ContactState &state, const PathWay &way);
   double left(Eigen::Index node, double sense) const;
   double rate(Eigen::Index node, double sense) const;
   template <class Visitor>
   void for_each_boundary(Visitor visit) const;
   double share_to_event(double stop);
   double share_past_event() const;
   double go(double share, const std::vector<NodeState> &states, const Eigen::VectorXd &loads);
   void write(ContactState &state, std::vector<NodeState> states, double present) const;

   const ReducedProblem &problem_;
   const Eigen::MatrixXd &K_; // the problem's
   /// A node at a bend of its bound, and the side of it to which its pressure goes.
   struct Bend
   {
      Eigen::Index node;
      double pressure, side;
   };
   struct
   {
      const std::vector<FrictionBound> given; // of the nodes
      std::vector<FrictionBound> pieces;      // straight ones, at the present pressures
      std::vector<Bend> bends;                // where pressures are on one
   } bounds_;
   StateEquations equations_;        // with the bounds of rates
   Eigen::VectorXd u_, F_;           // displacements {v; w} and forces {q; p}
   Eigen::VectorXd u_rate_, F_rate_; // over the rest of the path
   /// Loads at the start and at the end of the path for which u_rate_ and F_rate_ were
   /// computed. They hold there as long as no node changes its state.
   struct
   {
      Eigen::VectorXd from, to;
   } known_;
   ComplementarityProblem rates_;
   Eigen::VectorXd noise_; // one for each node: forces below it are round-off
   /// A motion that nothing resists and nothing drives, and the node that is set to touch while
   /// rates are found; -1: none.
   struct
   {
      Eigen::VectorXd motion;
      Eigen::Index node = -1;
   } pivot_;
   /// Results of the last advance().
   struct
   {
      bool ended = false;
      Eigen::Index event = -1;
      std::string failure;
      const char *found_by = "";
      Eigen::VectorXd slip_error;
   } last_;
   Counters counters_;
};

} // namespace cattaneo
