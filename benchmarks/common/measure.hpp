#pragma once

#include <functional>
#include <string>
#include <vector>

/** What a piece of work returned and took in a process of its own: its memory is its own, and
    the next piece starts as it did. */
struct Measured
{
   bool ok = false;            ///< false if it threw or crashed (and said so on stderr)
   std::vector<double> values; ///< what the work returned
   double cpu = 0;             ///< user and system time, seconds
   double wall = 0;            ///< seconds
   double megabytes = 0;       ///< peak resident memory
};

Measured in_own_process(const std::function<std::vector<double>()> &work);

/// Runs a program with its arguments to its end, without its output. Throws InputError if it
/// fails. @param threads of its linear algebra
Measured whole_process(const std::vector<std::string> &command, int threads = 1);

/// Path of a miniapp that was built beside this benchmark.
std::string miniapp_program(const std::string &name);

/// Slope of log(y) against log(x) by least squares: observed rates and exponents. Pairs that
/// are not positive and finite are left out; NaN with fewer than two.
double log_slope(const std::vector<double> &x, const std::vector<double> &y);
