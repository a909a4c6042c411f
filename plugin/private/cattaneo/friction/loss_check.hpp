#pragma once

#include <cattaneo/friction/march_record.hpp>

namespace cattaneo
{

/// How far the loss of a march from `start` may be from that of its path: `losses` and `report`
/// are the march's.
LossError loss_error(FrictionSolver &solver, const LoadHistory &history,
                     const ContactState &start, const MarchSettings &settings,
                     const Losses &losses, const MarchReport &report);

} // namespace cattaneo
