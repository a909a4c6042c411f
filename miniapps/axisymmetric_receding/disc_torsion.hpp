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

/// T_s from the pressure of the contact without friction, because in steady spinning no
/// friction is left for the radial direction.
void spinning_limit(Study &study, Disc &disc);

/// Twists to each of the wanted torques (ascending), and past the greatest torque, or to each
/// of the wanted multipliers.
void twist(Study &study, Disc &disc, Run &run, Turning::Stop stop,
           const std::vector<double> &wanted);

/** Cycles of the twist between ± the value at which the torque first reaches `amplitude` T_s.
    These are limits of the rotation, so that the torque may relax; with --twist traction they
    are limits of the torque. */
void cycle(Study &study, Disc &disc, Run &run, double amplitude, int cycles);

} // namespace miniapp
