#pragma once

#include "common/lap_joint_scene.hpp"
#include "common/run.hpp"

#include <functional>
#include <string>
#include <vector>

namespace miniapp
{

/// Data that all parts of the study share.
struct Joint
{
   LapJointOptions options;
   Scene scene;
   double friction = 0.2, load = 0.04, snug = 0.05;
   int cycles = 3, frames = 8;
   cattaneo::MarchSettings settings;
   std::string paraview; ///< folder for the frames of the first cycle; none if empty

   cattaneo::ReducedProblem &problem() { return scene.problem(); }
   double P0() const { return options.widths[0]; }
   double unit() const { return P0() * P0(); } ///< of energies, over E'

   /// Multipliers of the pinch pressures: several bolts are first tightened together to the
   /// snug pressure, then one after another to the full one.
   std::vector<cattaneo::NamedLoads> tightening(const std::vector<int> &order, double width,
                                                double pressure = 1) const;
};

/// Results of a history of tightening and cycles.
struct BoltedLoop
{
   cattaneo::MarchReport report;
   cattaneo::ContactState tightened, first_peak, first_end, last_peak;
   std::vector<cattaneo::Zone> cycle_zones; ///< of the last whole cycle
   cattaneo::Zone contact, pulled, stick_first, stick_steady;

   bool converged() const { return report.status == cattaneo::FrictionStatus::converged; }
   double first() const
   {
      return report.cycles.empty() ? none : report.cycles.front().dissipation;
   }
   double steady() const
   {
      return report.cycles.empty() ? none : report.cycles.back().dissipation;
   }
   /// External work over the dissipation of the last cycle, less 1.
   double work_error() const
   {
      if (report.cycles.empty() || steady() == 0) { return 0.0; }
      return (report.cycles.back().external_work - steady()) / steady();
   }
};

using Observer = std::function<void(const cattaneo::ContactState &)>;

/// Marches through the tightening points, then cycles the remote load between 0 and `load`.
BoltedLoop pull(Run &run, std::vector<cattaneo::NamedLoads> points, double load, int cycles,
                const Observer &observe = {});

/// Remote compression at which a free end touches the other lap; NaN if none does before
/// `limit`.
double touch_load(cattaneo::FrictionSolver &solver, cattaneo::NamedLoads loads, double limit);

/// The orders of tightening, separated by slashes, as numbers of bolts from 1.
std::vector<std::vector<int>> orders(const std::string &text, const std::vector<double> &bolts);

/// Relative size below which a force counts as round-off of its neighbours.
constexpr double round_off = 1e-9;
/// Largest deviation from mirror symmetry, over the largest value. @param size scale of the
/// forces: a force that is round-off compared with it counts as zero, and so as symmetric
double asymmetry(const Eigen::VectorXd &forces, double size);

} // namespace miniapp
