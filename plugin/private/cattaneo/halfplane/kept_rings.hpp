#pragma once

#include <cattaneo/halfplane/kernel_integrals.hpp>
#include <memory>
#include <mutex>
#include <vector>

namespace cattaneo
{

/// Keeps the axisymmetric integrals of the last surface, because a body and its torsion body
/// need the same ones one after the other. Safe with several threads.
class KeptRings
{
public:
   std::shared_ptr<const RingIntegrals> of(const SurfaceTrace &trace);
   /// How often the integrals were computed.
   long made() const { return made_; }

private:
   std::mutex guard_;
   std::vector<SurfaceElement> of_; ///< the surface that they belong to
   std::shared_ptr<const RingIntegrals> rings_;
   long made_ = 0;
};

} // namespace cattaneo
