#pragma once

#include <cattaneo/monitor.hpp>

namespace miniapp
{

/** Watches long work: on a terminal (not in a pipe or a file) a line says after two seconds how
    far it has come, and goes when the work ends; Ctrl-C stops it at the end of an increment, so
    that the study writes what it has, and a second one ends the program at once. On several
    ranks there is no such stop: they would not stop at the same increment. */
class Watch
{
public:
   /// @param what the work is called in the line
   explicit Watch(const char *what);
   ~Watch();
   Watch(const Watch &) = delete;
   /// For the settings of the work; must not outlive this.
   cattaneo::Monitor monitor();

private:
   void show(const cattaneo::Progress &progress);
   const char *what_;
   bool shown_ = false;
};

} // namespace miniapp
