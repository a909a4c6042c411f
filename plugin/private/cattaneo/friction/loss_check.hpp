#pragma once

#include <cattaneo/friction/march_record.hpp>

namespace cattaneo
{

/// Estimated error of the loss of a march from `start`, compared with that of its exact path.
/// `losses` and `report` are those of the march.
LossError loss_error(FrictionSolver &solver, const LoadHistory &history,
                     const ContactState &start, const MarchSettings &settings,
                     const Losses &losses, const MarchReport &report);

} // namespace cattaneo
