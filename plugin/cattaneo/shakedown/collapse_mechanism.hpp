#pragma once

#include <Eigen/Dense>

namespace cattaneo
{

/** Motions dual to the limit: at load vertex j node i slips by `slip` and opens by `opening`,
   with opening ≥ f |slip| (the flow rule associated with the friction cone). */
struct CollapseMechanism
{
   Eigen::MatrixXd slip;    ///< c·n × vertices
   Eigen::MatrixXd opening; ///< n × vertices
};

} // namespace cattaneo
