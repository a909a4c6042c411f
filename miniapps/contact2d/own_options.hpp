#pragma once

#include "common/study.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace miniapp
{

/// What the options of file 1 say of one body of a user's own.
struct BodyOptions
{
   std::string mesh, contact, support, load;
   std::vector<double> young = {1}, poisson = {0.3}; ///< one, or one for each attribute
};

/// What the options say of a half-plane without a mesh, in place of body 2.
struct HalfPlaneOptions
{
   double young = none, poisson = none, depth = none;

   bool given() const { return !std::isnan(young); }
};
void add_options(Study &study, HalfPlaneOptions &half_plane);

/// The options of body k: mesh1, young1, poisson1, contact1, support1 and load1 for k = "1".
void add_options(Study &study, BodyOptions &body, const std::string &k, const char *mesh_help);

} // namespace miniapp
