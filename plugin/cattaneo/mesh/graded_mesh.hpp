#pragma once

#include <mfem.hpp>
#include <vector>

namespace cattaneo
{

/** Coordinates from `from` to `to` in steps first, first·growth, first·growth², … of at most
    `largest` each. To end exactly at `to`, the last steps are scaled by one factor between 3/4
    and 5/4. Their number is such that together they are four times as long as the difference;
    all steps are scaled if there are only few. `from` > `to` is allowed; the result runs from
    `from` to `to`. InputError unless first > 0, growth >= 1, largest > 0, from != to, all
    finite but `largest`. */
std::vector<double> graded(double from, double to, double first, double growth,
                           double largest = 1e300);

/** Coordinates of [-half, half] with n intervals, symmetric to the last bit, in geometric
    progression toward both ends so that the end interval is `end_ratio` (0 < end_ratio <= 1)
    times the middle one. */
std::vector<double> graded_to_ends(double half, int intervals, double end_ratio);

/// Joins coordinate lists of which each starts where the one before ends.
std::vector<double> joined(const std::vector<std::vector<double>> &pieces);

/** Rectangle of quads with the given (strictly increasing) grid lines. Boundary attributes:
    1 bottom, 2 right, 3 top, 4 left. Vertex (i, j) has the number i + j·(number of x). */
mfem::Mesh rectangle_mesh(const std::vector<double> &x, const std::vector<double> &y);

/** Half-plane y < 0 around a contact |x| <= a, a = contact.back(): a box of quads with the grid
    lines x = contact (symmetric, increasing) and y = -depth (from 0, increasing), and around it
    rings that are copies of the box's outline scaled by `scale` (from 1, increasing) about the
    origin. Far elements are large in both directions, so that a domain of 10⁴ a costs a few
    dozen rings and none of the round-off of a tensor-product grid, whose far elements are
    needles.

    Boundary attributes: 1 the contact, 2 the free surface beside it, 3 the far bottom, 4 the
    far sides. */
mfem::Mesh half_plane_mesh(const std::vector<double> &contact, const std::vector<double> &depth,
                           const std::vector<double> &scale);

/** The right half of the same for axisymmetry: half-space z < 0 around a contact 0 <= r <= a.
    Boundary attributes as there, and 5 the axis. */
mfem::Mesh half_space_mesh(const std::vector<double> &contact, const std::vector<double> &depth,
                           const std::vector<double> &scale);

/// Scales 1 … domain/a for half_plane_mesh() and half_space_mesh(): rings that start with the
/// thickness `first` and grow by `growth` up to 3a, and twice as fast beyond, by 1 + 2 (growth
/// - 1), where the field is smooth.
std::vector<double> ring_scales(double a, double domain, double first, double growth);

} // namespace cattaneo
