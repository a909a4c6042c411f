#pragma once

#include <cattaneo/contact/condense_body.hpp>
#include <cattaneo/friction/contact_state.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <string>
#include <vector>

namespace miniapp
{

/// Series for ParaView in a folder: contact.pvd, and body1.pvd (and body2.pvd) with the fields
/// of the bodies, which are recovered for these states and no others.
void write_paraview(const std::string &folder, cattaneo::Reduction &reduction,
                    const std::vector<const cattaneo::ElasticBody *> &bodies,
                    const std::vector<cattaneo::ContactState> &states);

} // namespace miniapp
