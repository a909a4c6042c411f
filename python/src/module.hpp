#pragma once

#include <nanobind/nanobind.h>

// One function for each concept. It adds the classes and functions of the concept to the
// module.

namespace cattaneo::python
{

void bind_bodies(nanobind::module_ &m);
void bind_half_planes(nanobind::module_ &m);
void bind_half_spaces(nanobind::module_ &m);
void bind_reduced_problems(nanobind::module_ &m);
void bind_reductions(nanobind::module_ &m);
void bind_states(nanobind::module_ &m);
void bind_marches(nanobind::module_ &m);
void bind_readout(nanobind::module_ &m);
void bind_areas(nanobind::module_ &m);
void bind_shakedown(nanobind::module_ &m);
void bind_fretting(nanobind::module_ &m);
void bind_wear(nanobind::module_ &m);
void bind_design(nanobind::module_ &m);
void bind_joints(nanobind::module_ &m);

} // namespace cattaneo::python
