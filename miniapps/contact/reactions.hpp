#pragma once

#include "contact/joint_report.hpp"
#include "contact/own_bodies.hpp"

namespace miniapp
{

/** Tables of what supports, guides, prescribed displacements and obstacles do to each body, and
    of how well the forces on each body balance.

    Forces of supports are K u less the loads, without what the contact does to nodes that are
    held. The balance is that of these, of the loads, and of the resultants of the interfaces
    where they act: nothing of it is zero by construction. */
void report_reactions(Study &study, const JointCase &joint, OwnBodies &own,
                      const JointReport &report, const cattaneo::ContactState &state);

} // namespace miniapp
