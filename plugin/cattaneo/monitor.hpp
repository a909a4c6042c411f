#pragma once

#include <atomic>
#include <cattaneo/input_error.hpp>
#include <functional>

namespace cattaneo
{

/// How far long work has come.
struct Progress
{
   double share = 0;   ///< of it that is done, from 0 to 1; NaN: not known
   long steps = 0;     ///< done: increments of a march, iterations of a limit
   double time = 0;    ///< of a march, in its load history
   double seconds = 0; ///< since it began; share and seconds say how long the rest will take
};

/** Watches long work, and may stop it. Settings of everything that can take long have one.

    Both are asked by the thread that does the work, once an increment (or iteration), never in
    the middle of one. Copies share the same stop flag. */
struct Monitor
{
   /// Called after an increment, but not sooner than `interval` seconds after the call before,
   /// and once more when the work ends. May be empty. What it throws ends the work as it
   /// stands.
   std::function<void(const Progress &)> progress;
   double interval = 0.1; ///< seconds, not negative; 0: after every increment
   /** True asks the work to stop: its status is then `stopped`, its result what it came to
       before. Not owned, may be null, must outlive the work; nobody resets it. Any thread may
       set it, and so may a signal handler: std::atomic<bool> is free of locks wherever this
       library runs, and setting it does nothing else. On several ranks that march together all
       must set it between the same two increments. */
   const std::atomic<bool> *stop = nullptr;

   static_assert(std::atomic<bool>::is_always_lock_free); // a signal handler may set one

   /// Has somebody asked the work to stop?
   bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
   /// InputError naming the setting, its value and what is allowed.
   void validate() const { require_at_least("monitor: interval", interval, 0); }
};

} // namespace cattaneo
