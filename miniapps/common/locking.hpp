#pragma once

#include <cattaneo/elastic/body.hpp>
#include <string>

namespace miniapp
{

/// True if linear elements will be much too stiff: order 1 and a Poisson's ratio of 0.49 or
/// more, but for plane stress.
bool locks(int order, const cattaneo::Material &material);

/// One line on stderr if a body with this material locks.
void warn_of_locking(int order, const cattaneo::Material &material);

} // namespace miniapp
