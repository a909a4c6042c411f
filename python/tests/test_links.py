"""What the module links, which a wheel would have to bring: docs/python.md says which."""

import shutil
import subprocess

import pytest
from cattaneo import _core

SAID = ("libcholmod", "libipopt", "libopenblas", "liblapack", "libblas")
SYSTEM = ("libstdc++", "libm.", "libgcc_s", "libc.", "libdl", "libpthread", "ld-linux", "libgfortran", "libmvec")


def test_links_nothing_else():
    """Nothing of MFEM, MPI or Python itself above all."""
    if shutil.which("readelf") is None:
        pytest.skip("there is no readelf")
    out = subprocess.run(["readelf", "-d", _core.__file__], check=True, capture_output=True, text=True).stdout
    needed = [line.split("[")[1].rstrip("]") for line in out.splitlines() if "(NEEDED)" in line]
    assert needed
    for library in needed:
        assert library.startswith(SAID + SYSTEM), library
