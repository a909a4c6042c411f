#pragma once

// The version of Cattaneo, which CMake, pkg-config and the Python package read here.

/// Changes of it may break what was written against another.
#define CATTANEO_VERSION_MAJOR 0
/// Before 1.0 changes of it may, too.
#define CATTANEO_VERSION_MINOR 1
/// Changes of it alone break nothing.
#define CATTANEO_VERSION_PATCH 0
/// All three as text.
#define CATTANEO_VERSION "0.1.0"
