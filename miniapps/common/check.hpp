#pragma once

#include "common/scene.hpp"

namespace miniapp
{

class Study;

/** What a study is about to compute with, for the option --check: tables of the bodies with
    their supports, of the contact lines and of the loads with their resultants, and two panels,
    of all and of the contact, with normals, partners, gaps, supports and loads. InputError on
    several ranks. */
void show(Study &study, const Scene &scene);

} // namespace miniapp
