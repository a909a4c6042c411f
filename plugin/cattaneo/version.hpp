#pragma once

// The version of Cattaneo, which CMake, pkg-config and the Python package read here.

/// Programs for another major version may not compile or behave differently.
#define CATTANEO_VERSION_MAJOR 0
/// Before 1.0 this holds for the minor version, too.
#define CATTANEO_VERSION_MINOR 1
/// A change of only the patch version breaks nothing.
#define CATTANEO_VERSION_PATCH 0
/// All three as text.
#define CATTANEO_VERSION "0.1.0"
