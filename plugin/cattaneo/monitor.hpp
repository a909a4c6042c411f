#pragma once

#include <atomic>
#include <cattaneo/input_error.hpp>
#include <functional>

namespace cattaneo
{

/// Progress of long work.
struct Progress
{
   double share = 0;   ///< share of the work that is done, from 0 to 1; NaN: not known
   long steps = 0;     ///< increments of a march, or iterations of a limit, that are done
   double time = 0;    ///< time of a march in its load history
   double seconds = 0; ///< since it began; share and seconds say how long the rest will take
};

/** Observes long work, and may stop it. The settings of all long work contain one.

    The thread that does the work uses both, once an increment (or iteration), never in the
    middle of one. Copies share the same stop flag. */
struct Monitor
{
   /// Called after an increment, but not sooner than `interval` seconds after the last call,
   /// and once more at the end of the work. May be empty. An exception that it throws ends the
   /// work at once.
   std::function<void(const Progress &)> progress;
   double interval = 0.1; ///< seconds, not negative; 0: after every increment
   /** True makes the work stop: its status is then `stopped`, with the result so far. Not
       owned, may be null, must outlive the work. The work does not reset it. Any thread may set
       it, and so may a signal handler: std::atomic<bool> is free of locks wherever this library
       runs, and setting it does nothing else. On several ranks that march together all must set
       it between the same two increments. */
   const std::atomic<bool> *stop = nullptr;

   static_assert(
      std::atomic<bool>::is_always_lock_free); // a signal handler may set such a flag

   /// Was the work asked to stop?
   bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
   /// InputError naming the setting, its value and what is allowed.
   void validate() const { require_at_least("monitor: interval", interval, 0); }
};

} // namespace cattaneo
