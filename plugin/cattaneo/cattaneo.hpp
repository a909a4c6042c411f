#pragma once

// All of Cattaneo for programs that use MFEM.
#include <cattaneo/contact/interfaces_of_bodies.hpp>
#include <cattaneo/contact/vibrating_body.hpp>
#include <cattaneo/core.hpp>
#include <cattaneo/elastic/mass.hpp>
#include <cattaneo/elastic/point_stress.hpp>
#include <cattaneo/elastic/rotation.hpp>
#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/elastic/views.hpp>
#include <cattaneo/mesh/filled_corner.hpp>
#include <cattaneo/mesh/graded_mesh.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/mesh/smooth_sides.hpp>
#include <cattaneo/output/paraview.hpp>
