#pragma once

// All of Cattaneo::core, which knows no MFEM.
#include <cattaneo/condense/condense.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/fretting/assessment.hpp>
#include <cattaneo/fretting/calibration.hpp>
#include <cattaneo/fretting/corner.hpp>
#include <cattaneo/fretting/edge_crack.hpp>
#include <cattaneo/fretting/edge_report.hpp>
#include <cattaneo/fretting/hertz_field.hpp>
#include <cattaneo/fretting/measures.hpp>
#include <cattaneo/fretting/yield.hpp>
#include <cattaneo/friction/critical_friction.hpp>
#include <cattaneo/halfplane/half_plane.hpp>
#include <cattaneo/output/history.hpp>
#include <cattaneo/reduced/interfaces.hpp>
#include <cattaneo/reduced/mortar.hpp>
#include <cattaneo/reduced/reduced_file.hpp>
#include <cattaneo/reduced/reduction.hpp>
#include <cattaneo/shakedown/closed_contact.hpp>
#include <cattaneo/shakedown/estimates.hpp>
#include <cattaneo/shakedown/limit_of_the_mesh.hpp>
#include <cattaneo/shakedown/lower_limit.hpp>
#include <cattaneo/shakedown/stay_closed.hpp>
#include <cattaneo/shakedown/transient.hpp>
#include <cattaneo/whole_file.hpp>
