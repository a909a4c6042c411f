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

/** Long work without the interpreter's lock, which Ctrl-C ends with KeyboardInterrupt, and
    which is stopped from elsewhere by an object with is_set(), as threading.Event: its status
    is then 'stopped', and its result what it came to before. */
class Watch
{
public:
   /// @param progress True: a line on stderr; a function: called with Progress
   Watch(nb::handle progress, nb::handle stop);

   Monitor monitor();
   /// Asks `stop`, if there is one, now: it is looked at only now and then.
   void ask();

private:
   void look(const Progress &progress);

   nb::object progress_, stop_;
   std::atomic<bool> stopped_{false};
};

/// Does what `work` says without the lock.
template <class Work>
auto unlocked(Work &&work)
{
   const nb::gil_scoped_release release;
   return work();
}

/// Held while Ipopt works: the linear solver inside of it (MUMPS) is not safe for threads. What
/// is called from inside may ask for Ipopt in turn.
std::recursive_mutex &ipopt();

/// Does what `work` says with Ipopt, without the interpreter's lock, which is given up first.
template <class Work>
auto one_at_a_time(Work &&work)
{
   const nb::gil_scoped_release release;
   const std::lock_guard<std::recursive_mutex> turn(ipopt());
   return work();
}

/// Warns of an outcome that a script should not pass over, as cattaneo.OutcomeWarning.
void warn(const std::string &sentence);

} // namespace cattaneo::python
