#pragma once

#include <cattaneo/friction/march_record.hpp>

namespace cattaneo
{

/// Error of the loss of a march from `start`. It is a bound where there is an exact path to
/// compare with, else an estimate. `losses` and `report` are those of the march.
LossError loss_error(FrictionSolver &solver, const LoadHistory &history,
                     const ContactState &start, const MarchSettings &settings,
                     const Losses &losses, const MarchReport &report);

} // namespace cattaneo
