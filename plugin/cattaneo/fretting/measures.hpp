#pragma once

#include <cattaneo/fretting/near_edge.hpp>

namespace cattaneo::fretting
{

/* Correlators of life other than the crack threshold. All are of the steady cycle in which K_T
    changes by ΔK_T at constant K_N, for any load ratio. Only K_N and f of @a edge are used. */

/// Length of the zone of reversed slip, ΔK_T/(f K_N); 2K_T/(f K_N) when fully reversed.
double reversed_slip_zone(const Edge &edge, double k_t_range);

/// Range of σ_xx at the contact edge, 4√(f K_N ΔK_T): the S of an S-N curve (thesis 2.5.1).
double edge_stress_range(const Edge &edge, double k_t_range);

/// Range of the mode II intensity of the stuck edge, ΔK_II = √(2π) ΔK_T (thesis 2.5.2).
double mode_two_range(double k_t_range);

/** Frictional energy per unit area and cycle at distance t from the edge (2.22, corrected):
    (16 ΔK_T²/3E*) √τ (1-τ)^{3/2} with τ = t/d_r; 0 outside the slip zone.
    With N and mm: N/mm = kJ/m² = mJ/mm². */
double slip_energy_density(const Edge &edge, double k_t_range, double modulus, double t);

/// Its maximum √3 ΔK_T²/E*, at a quarter of the slip zone.
double slip_energy_max(double k_t_range, double modulus);

/// Energy per cycle, edge and unit thickness, (π/3) ΔK_T³/(f K_N E*). With N and mm: N = mJ/mm.
double slip_energy_total(const Edge &edge, double k_t_range, double modulus);

/// Exact energy per cycle and unit thickness of a whole Hertz contact (both edges) under ±Q:
/// 4(fP)²/(πE*) ((1-x) ln(1-x) + x - x²/2), x = Q/(fP). InputError unless 0 <= x <= 1.
double hertz_slip_energy(double friction, double load, double load_ratio, double modulus);

} // namespace cattaneo::fretting
