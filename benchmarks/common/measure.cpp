#include "common/measure.hpp"

#include <cattaneo/input_error.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <limits>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

Measured in_own_process(const std::function<std::vector<double>()> &work)
{
   Measured result;
   int ends[2];
   if (pipe(ends) != 0) { return result; }
   std::fflush(nullptr);
   const auto began = std::chrono::steady_clock::now();
   const pid_t child = fork();
   if (child == 0)
   {
      int code = 1;
      try
      {
         const std::vector<double> values = work();
         const auto bytes = static_cast<ssize_t>(values.size() * sizeof(double));
         code = write(ends[1], values.data(), bytes) == bytes ? 0 : 1;
      }
      catch (const std::exception &error)
      {
         std::fprintf(stderr, "error: %s\n", error.what());
      }
      std::fflush(nullptr);
      _exit(code);
   }
   close(ends[1]);
   double value = 0;
   while (child > 0 && read(ends[0], &value, sizeof value) == sizeof value)
   {
      result.values.push_back(value);
   }
   close(ends[0]);
   int status = 1;
   rusage usage{};
   if (child < 0 || wait4(child, &status, 0, &usage) != child) { return result; }
   const auto seconds = [](const timeval &t) { return t.tv_sec + 1e-6 * t.tv_usec; };
   result.ok = status == 0;
   result.cpu = seconds(usage.ru_utime) + seconds(usage.ru_stime);
   result.wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
   result.megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
   return result;
}

Measured whole_process(const std::vector<std::string> &command, int threads)
{
   Measured measured = in_own_process(
      [&]
      {
         setenv("OPENBLAS_NUM_THREADS", std::to_string(threads).c_str(), 1);
         std::vector<char *> words;
         for (const std::string &word : command)
         {
            words.push_back(const_cast<char *>(word.c_str()));
         }
         words.push_back(nullptr);
         if (std::freopen("/dev/null", "w", stdout)) { execv(words[0], words.data()); }
         std::perror(words[0]);
         _exit(1);
         return std::vector<double>();
      });
   cattaneo::require(measured.ok, "the program '", command[0],
                     "' failed, it must be built and run");
   return measured;
}

std::string miniapp_program(const std::string &name)
{
   const std::filesystem::path self = std::filesystem::canonical("/proc/self/exe");
   return self.parent_path().parent_path() / "miniapps" / name;
}

double log_slope(const std::vector<double> &x, const std::vector<double> &y)
{
   double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
   for (std::size_t k = 0; k < x.size() && k < y.size(); ++k)
   {
      if (!(x[k] > 0 && y[k] > 0 && std::isfinite(x[k]) && std::isfinite(y[k]))) { continue; }
      const double a = std::log(x[k]), b = std::log(y[k]);
      n += 1;
      sx += a;
      sy += b;
      sxx += a * a;
      sxy += a * b;
   }
   return n < 2 ? std::numeric_limits<double>::quiet_NaN()
                : (n * sxy - sx * sy) / (n * sxx - sx * sx);
}
