#include "common/watch.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <cmath>
#include <csignal>
#include <unistd.h>

namespace miniapp
{

namespace
{

std::atomic<bool> stop{false};

extern "C" void interrupted(int)
{
   stop = true;
   std::signal(SIGINT, SIG_DFL);
}

} // namespace

Watch::Watch(const char *what) : what_(what)
{
   // From the first march on: an interrupt between two of them stops the next.
   static bool installed = false;
   if (ranks() == 1 && !installed) { std::signal(SIGINT, interrupted); }
   installed = true;
}

Watch::~Watch()
{
   if (shown_) { std::fputs("\r\x1b[K", stderr); }
}

cattaneo::Monitor Watch::monitor()
{
   cattaneo::Monitor monitor;
   monitor.stop = &stop;
   if (writes() && isatty(STDERR_FILENO))
   {
      monitor.progress = [this](const cattaneo::Progress &progress) { show(progress); };
   }
   return monitor;
}

void Watch::show(const cattaneo::Progress &p)
{
   if (p.seconds < 2) { return; }
   const std::string share = p.share > 0 ? text("%.0f %%, ", 100 * p.share) : "",
                     left = p.share > 0
                               ? text(", %.0f s left", p.seconds * (1 - p.share) / p.share)
                               : "";
   std::fprintf(stderr, "\r%s: %s%ld steps, %.0f s%s (Ctrl-C writes what there is)\x1b[K",
                what_, share.c_str(), p.steps, p.seconds, left.c_str());
   std::fflush(stderr);
   shown_ = true;
}

} // namespace miniapp
