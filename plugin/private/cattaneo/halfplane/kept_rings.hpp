#pragma once

#include <cattaneo/halfplane/kernel_integrals.hpp>
#include <memory>
#include <mutex>
#include <vector>

namespace cattaneo
{

/// Integrals about an axis of the surface that was asked for last: a body and its torsion ask
/// one after the other. Several threads may.
class KeptRings
{
public:
   std::shared_ptr<const RingIntegrals> of(const SurfaceTrace &trace);
   /// How often they were made.
   long made() const { return made_; }

private:
   std::mutex guard_;
   std::vector<SurfaceElement> of_; ///< whose they are
   std::shared_ptr<const RingIntegrals> rings_;
   long made_ = 0;
};

} // namespace cattaneo
