#pragma once

#include <cattaneo/friction/march.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/** Table of a march with one row an increment, as CSV:

       time, cycle, load multipliers (column "load NAME" each), numbers of nodes in stick,
       separation, forward and backward slip (with torsion: slip), dissipation and external work
   of the increment, relative residuals normal and tangential, and round_off (what arithmetic
   can reach of them).

    add() is made to be a MarchObserver. Numbers are written so that they are read back to the
   last bit. */
class HistoryTable
{
public:
   void add(const ContactState &state, const IncrementRecord &record);
   /// Writes the file whole or not at all; InputError if it cannot be written or a name holds a
   /// comma, a quote or a line break.
   void write(const std::string &file, const ReducedProblem &problem) const;

private:
   struct Row
   {
      IncrementRecord record;
      Eigen::VectorXd multipliers;
   };
   std::vector<Row> rows_;
};

/** Writes the contact nodes of some states, as CSV, one row a node and state:

       time, node, arc_length, x, y, state (see settled_states()), p, q (tractions: nodal forces
   over consistent weights), slip v, opening w + g; with torsion q and slip have a radial and a
   circumferential column each.

    Needs arc length, positions and weights. InputError if the file cannot be
   written or a state does not fit; whole or not at all. */
void write_nodes(const std::string &file, const ReducedProblem &problem,
                 const std::vector<ContactState> &states);

} // namespace cattaneo
