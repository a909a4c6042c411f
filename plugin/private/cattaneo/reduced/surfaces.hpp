#pragma once

#include <cattaneo/reduced/union.hpp>

namespace cattaneo
{

/// Contact nodes of a body in space on a rigid obstacle. InputError if a normal one is held.
std::vector<ContactRow> rows_on_obstacle(const CondensedBody &body);

/// Contact nodes of two bodies in space whose nodes face each other one to one, in frames
/// between both. InputError if the pairing does not fit, or if both hold a normal component.
std::vector<ContactRow> rows_of_pairs(const std::vector<CondensedBody> &bodies,
                                      const Pairing &pairing);

/// The reduced problem of one body or two in space, with these rows and gaps.
Reduction reduce_surfaces(std::vector<CondensedBody> bodies, std::vector<ContactRow> rows,
                          const Eigen::VectorXd &gap);

} // namespace cattaneo
