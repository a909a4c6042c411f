#include "half_planes.hpp"

namespace cattaneo_test
{

using namespace cattaneo;

HalfPlane half_plane(double young, double poisson, PlaneState state)
{
   HalfPlane body;
   body.material = {young, poisson, state};
   body.depth = depth;
   return body;
}

std::vector<double> even(double from, double to, int elements)
{
   std::vector<double> grid;
   for (int e = 0; e <= elements; ++e) { grid.push_back(from + (to - from) * e / elements); }
   return grid;
}

double below(double poisson)
{
   return 0.5 / (1 - poisson);
}

} // namespace cattaneo_test
