#pragma once

#include "contact/bolts_report.hpp"
#include "contact/own_bodies.hpp"

namespace miniapp
{

/** Tables of the forces of supports, guides, prescribed displacements and obstacles on each
    body, and of the balance of all forces on it.

    Forces of supports are K u minus the loads, without the contact forces on held nodes. The
    balance adds these, the loads, and the resultants of the interfaces at the points where they
    act. None of it is zero by construction. */
void report_reactions(Study &study, const JointCase &joint, OwnBodies &own,
                      const BoltsReport &bolts, const cattaneo::ContactState &state);

} // namespace miniapp
