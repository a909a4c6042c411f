#pragma once

#include <cattaneo/monitor.hpp>
#include <chrono>

namespace cattaneo
{

/// Reports progress to a monitor, no more often than the monitor asks for.
class ProgressReport
{
public:
   /// Starts the clock of the work. The monitor must outlive this.
   explicit ProgressReport(const Monitor &monitor) : monitor_(monitor) {}

   double seconds() const { return since(began_); }
   void note(double share, long steps, double time = 0)
   {
      if (!monitor_.progress || (told_ && since(last_) < monitor_.interval)) { return; }
      tell(share, steps, time);
   }
   /// Whatever the interval.
   void end(double share, long steps, double time = 0)
   {
      if (monitor_.progress) { tell(share, steps, time); }
   }

private:
   using Clock = std::chrono::steady_clock;
   static double since(Clock::time_point then)
   {
      return std::chrono::duration<double>(Clock::now() - then).count();
   }
   void tell(double share, long steps, double time)
   {
      last_ = Clock::now();
      told_ = true;
      monitor_.progress({share, steps, time, seconds()});
   }

   const Monitor &monitor_;
   const Clock::time_point began_ = Clock::now();
   Clock::time_point last_;
   bool told_ = false;
};

} // namespace cattaneo
