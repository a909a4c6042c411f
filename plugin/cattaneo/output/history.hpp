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
   work of the increment, relative residuals normal and tangential, round_off (what arithmetic
   can reach of them), and the conjugate of each multiplier, see conjugates(): column
   "displacement NAME" of a force, "reaction NAME" of a prescribed displacement; "contact
   displacement NAME" and "contact reaction NAME" if only the contact's part of it is known
    (ReducedProblem::knows_loads). At last IncrementRecord::found_by and IncrementRecord::event.

    add() is made to be a MarchObserver. Numbers are written so that they are read back to the
    last bit. Nothing is kept in memory. */
class HistoryWriter
{
public:
   /// A new file. InputError if it cannot be written or the name of a pattern holds a line
   /// break; names with a comma or a quote are put in quotes. Only the columns are kept from
   /// the problem.
   HistoryWriter(const std::string &file, const ReducedProblem &problem);
   /// Goes on with the file of a march that is taken up from a state: rows beyond its time are
   /// dropped, so that in the end it is that of a march that never stopped. InputError if what
   /// stays does not end with the time and the multipliers of the state.
   HistoryWriter(const std::string &file, const ReducedProblem &problem,
                 const ContactState &from);

   /// InputError if the row cannot be written or has not a multiplier for each pattern.
   void add(const ContactState &state, const IncrementRecord &record);

private:
   Eigen::Index patterns_;
   bool disc_;
   StreamedFile file_;
};

/** Table of the contact nodes of some states, as CSV, one row a node and state, written as they
    come:

       time, node, arc_length, x, y, state (see settled_states()), p, q (tractions: nodal forces
    over consistent weights), slip v, opening w + g; with two tangents q and slip have a column
    of each, q1 and q2, slip1 and slip2: about an axis radial and circumferential. Needs arc
   length, positions and weights.

    The problem must outlive this. */
class NodeWriter
{
public:
   /// InputError if the file cannot be written or the problem lacks what is needed.
   NodeWriter(const std::string &file, const ReducedProblem &problem);
   /// Goes on from the time of a state, as HistoryWriter.
   NodeWriter(const std::string &file, const ReducedProblem &problem, double time);

   /// InputError if the state does not fit or cannot be written.
   void add(const ContactState &state);

private:
   const ReducedProblem &problem_;
   StreamedFile file_;
};

/** Saves a state every few seconds while a march goes on, so that little is lost if the program
    ends: with load_contact_state() the march is taken up again. The file is always whole. */
class StateSaver
{
public:
   /// InputError if a file of that name cannot be written, or seconds are negative.
   explicit StateSaver(const std::string &file, double seconds = 5);

   /// Saves if it is time to: a state from which a march goes on to the last bit
   /// (IncrementRecord::resumes), or any if none came for as long again. Add a state to a
   /// HistoryWriter before, so that no row is missing.
   void add(const ContactState &state, const IncrementRecord &record);

private:
   std::string file_;
   double seconds_;
   std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace cattaneo
