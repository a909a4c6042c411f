#pragma once

#include <cattaneo/friction/march.hpp>
#include <cattaneo/output/streamed_file.hpp>
#include <chrono>
#include <string>

namespace cattaneo
{

/** Table of a march with one row an increment, as CSV, written as the march goes:

       time, cycle, load multipliers (column "load NAME" each), numbers of nodes in stick,
       separation, forward and backward slip (with two tangents: slip), dissipation and external
       work of the increment, relative residuals normal and tangential, round_off (the smallest
       residual that round-off allows), and a column of each load: "displacement NAME" of a
       force, "reaction NAME" of a prescribed displacement, "contact displacement NAME" and
       "contact reaction NAME" if only the contact's part of it is known
       (ReducedProblem::knows_loads). Where the resultant of the load is known
       (LoadPattern::size), they are in the units of the problem: the displacement along the
       force, the rotation by a moment in radians, how far the ends of a bolt come together.
       Otherwise the column is "displacement per unit of NAME" or "reaction per unit of NAME"
       and has conjugates(). At last IncrementRecord::found_by and IncrementRecord::event.

    add() can be used as a MarchObserver. Numbers are written so that they are read back to the
    last bit. Nothing is kept in memory. */
class HistoryWriter
{
public:
   /// A new file. InputError if it cannot be written or the name of a pattern holds a line
   /// break; names with a comma or a quote are put in quotes. Only the columns are kept from
   /// the problem.
   HistoryWriter(const std::string &file, const ReducedProblem &problem);
   /// Continues the file of a march that is resumed from a state. Rows beyond the time of the
   /// state are dropped, so that the result is the file of a march that never stopped.
   /// InputError if the rows that stay do not end with the time and the multipliers of the
   /// state.
   HistoryWriter(const std::string &file, const ReducedProblem &problem,
                 const ContactState &from);

   /// InputError if the row cannot be written or has not a multiplier for each pattern.
   void add(const ContactState &state, const IncrementRecord &record);

private:
   Eigen::VectorXd sizes_; ///< of the loads, see resultants() in history.cpp
   bool disc_;
   StreamedFile file_;
};

/** Table of the contact nodes of some states, as CSV, one row a node and state, written as they
    come:

       time, node, arc_length, x, y, state (see settled_states()), p, q (tractions: nodal forces
    over consistent weights), slip v, opening w + g; with two tangents q and slip have a column
    of each, q1 and q2, slip1 and slip2: about an axis radial and circumferential. In space x,
    y, z take the place of arc_length, x, y, and the last column is the area of the node, its
    weight. Needs arc length (not in space), positions and weights.

    With several interfaces a column names that of each node: lines know it, for surfaces it
    must be given. The problem must outlive this. */
class NodeWriter
{
public:
   /// InputError if the file cannot be written or the problem lacks what is needed.
   /// `interface_of`: of each node in space, the name of its interface; empty: no such column.
   NodeWriter(const std::string &file, const ReducedProblem &problem,
              std::vector<std::string> interface_of = {});
   /// Continues from the time of a state, like HistoryWriter.
   NodeWriter(const std::string &file, const ReducedProblem &problem, double time,
              std::vector<std::string> interface_of = {});

   /// InputError if the state does not fit or cannot be written.
   void add(const ContactState &state);

private:
   const ReducedProblem &problem_;
   const std::vector<std::string> interface_of_;
   StreamedFile file_;
};

/** Saves a state every few seconds during a march, so that little is lost if the program ends:
    with load_contact_state() the march can be resumed. The file is always complete. */
class StateSaver
{
public:
   /// InputError if a file of that name cannot be written, or seconds are negative.
   explicit StateSaver(const std::string &file, double seconds = 5);

   /// Saves if the time has come, and the march can be resumed from this state to the last bit
   /// (IncrementRecord::resumes). If no such state came for the same time again, any state is
   /// saved. Add a state to a HistoryWriter before, so that no row is missing.
   void add(const ContactState &state, const IncrementRecord &record);

private:
   std::string file_;
   double seconds_;
   std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace cattaneo
