#pragma once

#include <cattaneo/monitor.hpp>
#include <thread>

namespace miniapp
{

/** The progress of a whole program. On a terminal (not in a pipe or a file) a line appears
    after two seconds. It has the present computation, the share of it that is done, and the
    time since the start. It disappears when something is printed. The first Ctrl-C stops a
    watched computation at the end of an increment, so that the study writes its results so far.
    A second one ends the program at once. On several ranks there is no such stop, because they
    would not stop at the same increment. Only one object may exist at a time. */
class ProgressLine
{
public:
   /// @param program name in the line for work that no Watch watches
   explicit ProgressLine(const char *program);
   ~ProgressLine();
   ProgressLine(const ProgressLine &) = delete;
   static void clear(); ///< before something is printed
   static bool interrupted();

private:
   void tick();
   std::thread ticks_;
};

/// A computation that may take long, shown in the line of the program.
class Watch
{
public:
   /// @param what name of the computation in the line
   explicit Watch(const char *what);
   ~Watch();
   Watch(const Watch &) = delete;
   /// The monitor for the settings of the computation; must not outlive the program's line.
   cattaneo::Monitor monitor();
};

} // namespace miniapp
