#pragma once

#include <cstdlib>
#include <initializer_list>
#include <string>
#include <vector>

namespace cattaneo_test
{

/// How much of a family of cases is run: environment variable CATTANEO_STRESS=short (for builds
/// with sanitizers), not set (all tests in less than three minutes) or full (./test --all).
enum class Extent
{
   brief,
   usual,
   full
};

Extent extent();

/// The number of random cases of a test.
int cases(int usual, int full);

/// The meshes of a convergence test: the first ones, and in full the finer ones too.
template <class Mesh>
std::vector<Mesh> meshes(std::initializer_list<Mesh> usual, std::initializer_list<Mesh> finer)
{
   std::vector<Mesh> all(usual);
   if (extent() == Extent::full) { all.insert(all.end(), finer); }
   return all;
}

} // namespace cattaneo_test
