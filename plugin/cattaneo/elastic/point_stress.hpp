#pragma once

#include <cattaneo/elastic/body.hpp>
#include <cattaneo/elastic/stress.hpp>

namespace cattaneo
{

/// Stress at a point of a body, not one of torsion, from its displacement: `transformation` of
/// the point's element with the point set. On the axis ε_θθ is its limit ε_rr. `loads`: the
/// multipliers, of those patterns at least that are initial strains (InputError otherwise).
Stress stress_at(const ElasticBody &body, const mfem::GridFunction &displacement,
                 mfem::ElementTransformation &transformation, const NamedLoads &loads = {});

/// The same of a torsion body, from its twist ψ = u_θ/r: τ_rθ = G r ∂ψ/∂r, τ_θz = G r ∂ψ/∂z.
TorsionStress torsion_stress_at(const ElasticBody &body, const mfem::GridFunction &twist,
                                mfem::ElementTransformation &transformation);

} // namespace cattaneo
