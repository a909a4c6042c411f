#include "expect_input_error.hpp"

#include <algorithm>
#include <cattaneo/algebra/dense_cholesky.hpp>
#include <cattaneo/algebra/root.hpp>
#include <cattaneo/counters.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace
{

using namespace cattaneo;

std::vector<long> values(const Counters &counters)
{
   std::vector<long> all;
   Counters::for_each(counters, [&](const char *, long value) { all.push_back(value); });
   return all;
}

TEST(Counters, EveryOneIsVisitedAndBeginsAtZero)
{
   Counters counters;
   EXPECT_EQ(values(counters), std::vector<long>(sizeof(Counters) / sizeof(long), 0));
   // In the order of the members, so that each is there and under its own name.
   long next = 0;
   Counters::for_each(counters, [&](const char *, long &value) { value = ++next; });
   EXPECT_EQ(counters.assemblies, 1);
   EXPECT_EQ(counters.factorisations, 2);
   EXPECT_EQ(counters.back_substitutions, 3);
   EXPECT_EQ(counters.tangential_unknowns, 7);
   EXPECT_EQ(counters.limit_solves, next);
   EXPECT_TRUE(std::is_sorted(&counters.assemblies, &counters.limit_solves + 1));
}

TEST(Counters, AddAndSubtractButKeepTheLargestSize)
{
   Counters one, two;
   long next = 0;
   Counters::for_each(one, [&](const char *, long &value) { value = ++next; });
   Counters::for_each(two, [&](const char *, long &value) { value = 100 * next--; });
   Counters sum = one;
   sum += two;
   const std::vector<long> a = values(one), b = values(two), s = values(sum);
   for (std::size_t k = 0; k < a.size(); ++k)
   {
      EXPECT_EQ(s[k], k == 6 ? b[k] : a[k] + b[k]) << k;
   }
   Counters other = two;
   other += one;
   EXPECT_EQ(values(other), s); // the larger size, whichever comes first
   sum -= two;
   EXPECT_EQ(sum.assemblies, one.assemblies);
   EXPECT_EQ(sum.limit_solves, one.limit_solves);
   EXPECT_EQ(sum.tangential_unknowns, two.tangential_unknowns); // a size does not go away
}

TEST(InputError, SaysANumberAsAUserWroteItAndAComputedOneWithoutItsRoundOff)
{
   const auto said = [](double x)
   {
      try
      {
         require(false, "found ", x);
      }
      catch (const InputError &error)
      {
         return std::string(error.what());
      }
      return std::string();
   };
   // 0.1 + 0.2 is the neighbour of 0.3 above it: only seventeen digits tell them apart.
   EXPECT_EQ(said(0.1 + 0.2), "found 0.3");
   EXPECT_EQ(said(1.0 / 3), "found 0.333333333333");
   // Fifteen digits are more than anybody writes by hand, and each of them is there.
   EXPECT_EQ(said(0.123456789012345), "found 0.123456789012345");
   EXPECT_EQ(exact_text(0.1 + 0.2), "0.30000000000000004"); // of files
   EXPECT_NO_THROW(require(true, "found ", 1));
}

TEST(Root, IsFoundWhereSignsDifferOrRoundOffHidIt)
{
   EXPECT_DOUBLE_EQ(find_root([](double x) { return x * x - 2; }, 1, 2), std::sqrt(2.0));
   // Both signs lost to round-off: the root is at one end.
   EXPECT_EQ(find_root([](double x) { return x - 1 - 1e-15; }, 0, 1), 1);
   EXPECT_EQ(find_root([](double x) { return x + 1e-15; }, 0, 1), 0);
   EXPECT_EQ(find_root([](double) { return 1.0; }, 1, 1 + 1e-12), 1);
   // Nothing says that there is a root.
   expect_input_error([] { find_root([](double x) { return 3 - x; }, 2, -5); },
                      "between 2 and -5 the function goes from 1 to 8, its sign must change");
   EXPECT_TRUE(std::isnan(find_root([](double) { return NAN; }, 0, 1)));
   EXPECT_TRUE(std::isnan(find_root([](double x) { return std::sqrt(x) - 2; }, -1, 9)));
   EXPECT_TRUE(std::isnan(find_root([](double x) { return std::sqrt(x) - 2; }, 9, -1)));
}

TEST(DenseCholesky, RefusesWhatIsNotFinite)
{
   for (const double wrong : {double(NAN), double(INFINITY)})
   {
      for (const int row : {0, 2})
      {
         Eigen::MatrixXd matrix = Eigen::Matrix3d::Identity();
         matrix(2, row) = wrong;
         EXPECT_FALSE(DenseCholesky().compute(matrix)) << row;
      }
   }
   EXPECT_TRUE(DenseCholesky().compute(Eigen::Matrix3d::Identity()));
}

TEST(WholeFile, IsWrittenWholeOrNotAtAll)
{
   const std::string folder =
      testing::TempDir() + "cattaneo_whole_" + std::to_string(getpid()) + "/";
   std::filesystem::create_directories(folder);
   const std::string file = folder + "table.csv";
   expect_input_error([&] { write_whole(folder + "none/table.csv", "1"); },
                      "none/table.csv': there is no folder");
   // A full disk, played by a limit on the size of files: what is short enough to wait in the
   // stream's buffer is refused by the system when the file is closed.
   rlimit before;
   ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
   const rlimit small{10, before.rlim_max};
   const auto handler = std::signal(SIGXFSZ, SIG_IGN);
   ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
   expect_input_error([&] { write_whole(file, std::string(100, 'x')); },
                      (file + "': " + std::strerror(EFBIG)).c_str());
   setrlimit(RLIMIT_FSIZE, &before);
   std::signal(SIGXFSZ, handler);
   EXPECT_TRUE(std::filesystem::is_empty(folder));
   write_whole(file, "x,y\n");
   std::ifstream in(file);
   std::string text;
   EXPECT_TRUE(std::getline(in, text));
   EXPECT_EQ(text, "x,y");
   std::filesystem::remove_all(folder);
}

TEST(WholeFile, PipesAndLinksStayWhatTheyAre)
{
   namespace fs = std::filesystem;
   const std::string folder =
      testing::TempDir() + "cattaneo_links_" + std::to_string(getpid()) + "/";
   fs::create_directories(folder);
   const auto text_of = [](const std::string &file)
   {
      std::ifstream in(file);
      std::string text;
      std::getline(in, text);
      return text;
   };
   // A link to a file with rights of its own, and one to a file that is not there yet.
   std::ofstream(folder + "old.json") << "old\n";
   const fs::perms own = fs::perms::owner_read | fs::perms::owner_write;
   fs::permissions(folder + "old.json", own);
   for (const std::string name : {"old", "new"})
   {
      const std::string link = folder + "link to " + name;
      fs::create_symlink(name + ".json", link);
      EXPECT_NO_THROW(require_writable(link));
      write_whole(link, "it\n");
      EXPECT_TRUE(fs::is_symlink(link));
      EXPECT_EQ(text_of(folder + name + ".json"), "it");
   }
   EXPECT_EQ(fs::status(folder + "old.json").permissions(), own);
   const std::string pipe = folder + "pipe";
   ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
   const int reader = open(pipe.c_str(), O_RDWR | O_NONBLOCK);
   EXPECT_NO_THROW(require_writable(pipe));
   write_whole(pipe, "through");
   char through[8] = {};
   EXPECT_EQ(::read(reader, through, sizeof through), 7);
   EXPECT_STREQ(through, "through");
   close(reader);
   EXPECT_TRUE(fs::is_fifo(pipe));
   fs::remove_all(folder);
}

TEST(WholeFile, ANameThatCannotBeWrittenIsRefusedBeforeTheWork)
{
   const std::string folder =
      testing::TempDir() + "cattaneo_writable_" + std::to_string(getpid());
   std::filesystem::create_directories(folder);
   EXPECT_NO_THROW(require_writable(folder + "/a.json"));
   EXPECT_NO_THROW(require_writable("a.json"));
   EXPECT_FALSE(std::filesystem::exists(folder + "/a.json"));
   expect_input_error([&] { require_writable(folder); }, "there is a folder of that name");
   expect_input_error([&] { require_writable(folder + "/none/a.json"); }, "there is no folder");
   const std::string endless(300, 'x');
   expect_input_error([&] { require_writable(folder + "/" + endless); }, "File name too long");
   std::filesystem::create_symlink("ring", folder + "/ring");
   expect_input_error([&] { require_writable(folder + "/ring"); }, "levels of symbolic links");
   std::filesystem::remove_all(folder);
}

} // namespace
