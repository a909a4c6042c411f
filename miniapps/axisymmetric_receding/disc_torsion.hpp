#pragma once

#include "axisymmetric_receding/turning.hpp"
#include "common/disc_scene.hpp"
#include "common/receding_study.hpp"

#include <vector>

namespace miniapp
{

/// Data that all parts of the study share.
struct Disc
{
   DiscOptions options;
   Scene scene;
   double a = 2.5, f = 0.5; ///< radius of the load, friction
   int steps = 80;
   double limit = 0; ///< T_s

   cattaneo::ReducedProblem &problem() { return scene.problem(); }
   Eigen::VectorXd radii() { return problem().position.col(0); }
   cattaneo::NamedLoads pressed(double load = 1) const { return {{radius_load(a), load}}; }
   /// The zones of a state, by radii.
   Extent extent(const cattaneo::ContactState &state) { return extent(problem(), state); }
   Extent extent(const cattaneo::ReducedProblem &of, const cattaneo::ContactState &state) const;
};

/// T_s from the pressure of the contact without friction: steady spinning leaves none to the
/// radial direction.
void spinning_limit(Study &study, Disc &disc);

/// Twists to each of the wanted torques (ascending), and on past the greatest; or to each of
/// the wanted multipliers.
void twist(Study &study, Disc &disc, Run &run, Turning::Stop stop,
           const std::vector<double> &wanted);

/** Cycles of the twist between ± what first brings the torque to `amplitude` T_s. Rotation is
    held between its limits, so that the torque may relax; torque is, under --twist traction. */
void cycle(Study &study, Disc &disc, Run &run, double amplitude, int cycles);

} // namespace miniapp
