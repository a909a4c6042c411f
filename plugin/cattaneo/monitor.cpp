#include <cattaneo/input_error.hpp>
#include <cattaneo/monitor.hpp>

namespace cattaneo
{

static_assert(std::atomic<bool>::is_always_lock_free); // a signal handler may set one

void Monitor::validate() const
{
   require_at_least("monitor: interval", interval, 0);
}

} // namespace cattaneo
