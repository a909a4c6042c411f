#include "common/watch.hpp"

#include "common/miniapp.hpp"
#include "common/text.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <unistd.h>
#include <vector>

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

/// Content of the line: the computations in progress, the innermost last, and the share of it
/// that is done.
struct ShownProgress
{
   std::mutex mutex;
   std::condition_variable ends;
   std::vector<const char *> works;
   cattaneo::Progress progress;
   bool shown = false, ended = true;
} on_line;

void clear_line()
{
   if (on_line.shown) { std::fputs("\r\x1b[K", stderr); }
   on_line.shown = false;
}

/// @param seconds of the program
void show_line(double seconds)
{
   const cattaneo::Progress &p = on_line.progress;
   std::string how_far;
   // A study of many short computations does not know the share that is done, so the time left
   // is not printed.
   if (p.seconds >= 1)
   {
      const std::string share = p.share > 0 ? text("%.0f %%, ", 100 * p.share) : "",
                        left = p.share > 0
                                  ? text("%.0f s left, ", p.seconds * (1 - p.share) / p.share)
                                  : "";
      how_far = share + text("%ld steps, ", p.steps) + left;
   }
   std::fprintf(
      stderr, "\r%s: %s%.0f s (%s)\x1b[K", on_line.works.back(), how_far.c_str(), seconds,
      stop ? "stops; Ctrl-C ends it now" : "Ctrl-C ends it and writes the results so far");
   std::fflush(stderr);
   on_line.shown = true;
}

} // namespace

ProgressLine::ProgressLine(const char *program)
{
   if (ranks() == 1) { std::signal(SIGINT, ::miniapp::interrupted); }
   on_line.works = {program};
   if (!writes() || !isatty(STDERR_FILENO)) { return; }
   on_line.ended = false;
   ticks_ = std::thread([this] { tick(); });
}

ProgressLine::~ProgressLine()
{
   if (!ticks_.joinable()) { return; }
   {
      const std::lock_guard<std::mutex> lock(on_line.mutex);
      on_line.ended = true;
      clear_line();
   }
   on_line.ends.notify_all();
   ticks_.join();
}

void ProgressLine::tick()
{
   const Stopwatch watch;
   std::unique_lock<std::mutex> lock(on_line.mutex);
   while (!on_line.ends.wait_for(lock, std::chrono::milliseconds(500),
                                 [] { return on_line.ended; }))
   {
      if (watch.seconds() >= 2) { show_line(watch.seconds()); }
   }
}

void ProgressLine::clear()
{
   const std::lock_guard<std::mutex> lock(on_line.mutex);
   clear_line();
}

bool ProgressLine::interrupted()
{
   return stop;
}

Watch::Watch(const char *what)
{
   const std::lock_guard<std::mutex> lock(on_line.mutex);
   on_line.works.push_back(what);
   on_line.progress = {};
}

Watch::~Watch()
{
   const std::lock_guard<std::mutex> lock(on_line.mutex);
   on_line.works.pop_back();
   on_line.progress = {};
}

cattaneo::Monitor Watch::monitor()
{
   cattaneo::Monitor monitor;
   monitor.stop = &stop;
   if (writes() && isatty(STDERR_FILENO))
   {
      monitor.progress = [](const cattaneo::Progress &progress)
      {
         const std::lock_guard<std::mutex> lock(on_line.mutex);
         on_line.progress = progress;
      };
   }
   return monitor;
}

} // namespace miniapp
