#pragma once

#include <cattaneo/design/sensitivity.hpp>
#include <functional>
#include <vector>

namespace cattaneo_test
{

/// A march that can be differentiated.
struct MarchCase
{
   cattaneo::ReducedProblem problem;
   cattaneo::LoadHistory history;
   cattaneo::MarchSettings settings;
};

/// Pressed, sheared to and fro, with some nodes that open and close and slip that turns.
MarchCase random_case(int seed, cattaneo::Stepping stepping, int increments = 3);

/// The problem with its parameters changed along a direction.
MarchCase changed(MarchCase c, const cattaneo::Parameters &by, double h);

/// Reads a response from a march.
using Read =
   std::function<cattaneo::Response(const cattaneo::Responses &, const cattaneo::MarchTrace &)>;

/// Derivative along a direction by central differences of the march as a whole.
double by_differences(const MarchCase &c, const cattaneo::Parameters &by, const Read &read,
                      double h);

/// One of each kind of parameters, at random.
std::vector<cattaneo::Parameters> directions(const MarchCase &c, int seed);

/// A march with its derivatives.
struct Differentiated
{
   MarchCase c;
   cattaneo::MarchTrace trace;
   cattaneo::Sensitivity sensitivity;

   explicit Differentiated(const MarchCase &given);
   cattaneo::Response response(const Read &read) const;
};

} // namespace cattaneo_test
