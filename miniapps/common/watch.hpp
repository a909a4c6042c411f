#pragma once

#include <cattaneo/monitor.hpp>
#include <thread>

namespace miniapp
{

/** The progress of a whole program. On a terminal (not in a pipe or a file) a line appears
   after two seconds. It has the present work, how much of it is done, and the time since the
   start. It disappears when something is printed. The first Ctrl-C stops the work that a Watch
   watches at the end of an increment, so that the study writes what it has, and a second one
   ends the program at once. On several ranks there is no such stop: they would not stop at the
   same increment. One at a time. */
class ProgressLine
{
public:
   /// @param program what the line calls what no Watch watches
   explicit ProgressLine(const char *program);
   ~ProgressLine();
   ProgressLine(const ProgressLine &) = delete;
   static void clear(); ///< before something is printed
   static bool interrupted();

private:
   void tick();
   std::thread ticks_;
};

/// Work that may be long, in the line of the program.
class Watch
{
public:
   /// @param what the work is called in the line
   explicit Watch(const char *what);
   ~Watch();
   Watch(const Watch &) = delete;
   /// For the settings of the work; must not outlive the program's line.
   cattaneo::Monitor monitor();
};

} // namespace miniapp
