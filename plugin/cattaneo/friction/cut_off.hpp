#pragma once

#include <cattaneo/friction/contact_state.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// A compressed contact that reaches an end of its line, or the rim of its surface, although
/// neither body ends there.
struct CutOffContact
{
   std::string interface;  ///< name of the line's
   Eigen::Index chain = 0; ///< in the problem's list; -1: the rim of a surface
   /// The outermost node of the chain at that end; on a rim the most compressed one
   Eigen::Index node = 0;
   bool at_first = false; ///< it is the first node of the chain, else the last
   double x = 0;          ///< of the node, 0 if the problem has no positions
   double y = 0;          ///< likewise
   double time = 0;       ///< of the state

   /// Is it at the same end, or also at a rim?
   bool same_place(const CutOffContact &other) const
   {
      return chain == other.chain &&
             (chain < 0 || (node == other.node && at_first == other.at_first));
   }
   /// A sentence on the fault and its cure, without a full stop.
   std::string message() const;
};

/** The places at which the contact of a state is cut off. There the node at an end of a chain
    is compressed, and beyond it *both* bodies go on smoothly (ContactChain::ends, other_ends),
    so that the contact would continue if the line did. Forces, and zones near that end, are
    then wrong, and nothing else in the results shows it. Either the part of the boundary that
    was named is too short, or a pad has rolled off its line. At corners a contact may end. Ends
    of an unknown kind are not reported. On a surface a node of ReducedProblem::rim is
    compressed. */
std::vector<CutOffContact> cut_off_contact(const ReducedProblem &problem,
                                           const ContactState &state);

} // namespace cattaneo
