#pragma once

#include "common/scene.hpp"

namespace miniapp
{

class Study;

/** Shows the input of a study, for the option --check: tables of the bodies with their
    supports, of the contact lines and of the loads with their resultants. Two panels, of the
    whole and of the contact, show normals, partners, gaps, supports and loads. InputError on
    several ranks. */
void show(Study &study, const Scene &scene);

/// The same in space, without panels: tables of the bodies with their supports and the rigid
/// motions that these leave free, of the sides that touch with their gaps, and of the loads.
void show_in_space(Study &study, const Scene &scene);

} // namespace miniapp
