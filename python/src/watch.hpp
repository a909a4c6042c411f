#pragma once

#include "arguments.hpp"
#include <cattaneo/monitor.hpp>
#include <mutex>

namespace cattaneo::python
{

CATTANEO_ARGUMENT(ProgressLike,
                  "bool | collections.abc.Callable[[cattaneo._core.Progress], object]",
                  anything);
CATTANEO_ARGUMENT(StopLike, "threading.Event", anything);

/** Long work without the interpreter's lock. Ctrl-C ends it with KeyboardInterrupt. An object
    with is_set(), such as threading.Event, can stop it from elsewhere: its status is then
    'stopped', with the result so far. */
class Watch
{
public:
   /// @param progress True: a line on stderr; a function: called with Progress
   Watch(nb::handle progress, nb::handle stop);

   Monitor monitor();
   /// Checks `stop`, if there is one, now. Otherwise it is checked only from time to time.
   void ask();

private:
   void look(const Progress &progress);

   nb::object progress_, stop_;
   std::atomic<bool> stopped_{false};
};

/// Calls `work` without the lock.
template <class Work>
auto unlocked(Work &&work)
{
   const nb::gil_scoped_release release;
   return work();
}

/// Held while Ipopt works: the linear solver inside of it (MUMPS) is not safe for threads. A
/// function that is called from inside may use Ipopt in turn.
std::recursive_mutex &ipopt();

/// Calls `work`, which uses Ipopt, without the interpreter's lock, which is released first.
template <class Work>
auto one_at_a_time(Work &&work)
{
   const nb::gil_scoped_release release;
   const std::lock_guard<std::recursive_mutex> turn(ipopt());
   return work();
}

/// Warns, with cattaneo.OutcomeWarning, of an outcome that a script should not ignore.
void warn(const std::string &sentence);

} // namespace cattaneo::python
