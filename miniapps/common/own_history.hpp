#pragma once

#include "common/run.hpp"

#include <cattaneo/joints/bolts.hpp>
#include <cattaneo/output/history.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace miniapp
{

/** A march along the load history of a case, from rest or from a saved state: its options, the
    files that it writes during the march, and the report on it and on its last state. */
class OwnHistory
{
public:
   /// Adds the options. The times of frames are given on the command line only.
   explicit OwnHistory(Study &study);
   /// To be called after parsing. InputError naming the option.
   void check_options();

   /// Reads the history for this problem, and the state from which it starts. InputError naming
   /// the option.
   void begin(const cattaneo::ReducedProblem &problem);
   /// InputError if the march does not reach one of these times of an option.
   void check_times(const std::string &option, const std::vector<double> &times) const;

   /// Called with every state that is reached; `frame`: the state is one of the requested
   /// frames.
   using Observer = std::function<void(const cattaneo::ContactState &, bool frame)>;
   /// Marches and writes: with --csv PREFIX_history.csv, and PREFIX_nodes.csv of the frames
   /// (from a saved state it continues the files of the march before); with --save-state the
   /// state, every few seconds. If there is no equilibrium, the exit code of the study says so,
   /// and the study goes on. InputError if energies overflow.
   void march(const cattaneo::ReducedProblem &problem, const Observer &observe);

   /// The history, after begin().
   const cattaneo::LoadHistory &history() const { return history_; }

   /// Reports the last state: its loads, zones and tractions, and `more` about its forces.
   void report_state(const cattaneo::ReducedProblem &problem, const std::string &more);
   /// Reports the march: cycles, losses, residuals, the changes of an exact path.
   void report_march(const cattaneo::ReducedProblem &problem);

   /// Is the problem axisymmetric? Zones at the axis then begin there.
   bool about_axis = false;
   /// Called with a state before it is saved, to add values that are kept with it.
   std::function<void(cattaneo::ContactState &)> keep;
   /// Bolts that the history tightens; must outlive it. Null: there are none.
   const cattaneo::BoltedJoint *bolts = nullptr;
   /// For contact on surfaces: shows its maps in the film of the march.
   std::function<void(Film &)> show_maps;
   /// For contact on surfaces with several interfaces: the name of that of each contact node.
   std::vector<std::string> interface_of_node;
   /// Loads that take the multiplier of another load: name of the load → name of the other.
   std::map<std::string, std::string> go_with;
   cattaneo::MarchSettings settings;
   cattaneo::ContactState state;
   cattaneo::MarchReport report;
   int cycle = 0; ///< of the state that an observer is called with; 0: none

private:
   Study &study_;
   SteppingOptions stepping_;
   std::string text_, frames_, save_state_, load_state_, amplitudes_;
   double amplitude_ = 1; ///< factor of the cycle
   int cycle_start_ = -1, cycles_ = 1;
   std::vector<double> wanted_; ///< times of frames, in their order
   cattaneo::LoadHistory history_;
};

/// In an axisymmetric problem: zones next to the axis, extended to the axis, where there is no
/// contact node.
std::vector<cattaneo::Zone> zones_to_axis(const cattaneo::ReducedProblem &problem,
                                          std::vector<cattaneo::Zone> zones);

/// The coefficients of friction at which the contact changes its character.
void report_critical_friction(Study &study, const cattaneo::ReducedProblem &problem);

} // namespace miniapp
