#pragma once

#include <cattaneo/condense/rigid_motion.hpp>
#include <cattaneo/elastic/body.hpp>
#include <memory>
#include <vector>

namespace cattaneo
{

/// What a factor is made from: all of a body, on one rank.
struct WholeBody
{
   std::shared_ptr<const mfem::SparseMatrix> K;
   std::vector<int> essential; ///< sorted
   DofPlaces places;
   std::vector<ElasticBody::Pattern> patterns;
};

/// All of a body on the first of its ranks, in the order of its global dofs; nothing of use on
/// the others.
WholeBody whole(const ElasticBody &body);

} // namespace cattaneo
