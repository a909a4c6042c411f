"""The kernels of OpenBLAS: named, and called poor where they are."""

import os
import pathlib
import subprocess
import sys

import cattaneo
import pytest


def named(**environment):
    """What a Python of its own says, which loads OpenBLAS anew."""
    code = "import cattaneo; kernels = cattaneo.blas_kernels(); print(kernels.name, kernels.better, kernels.statement, sep='\\n')"
    kept = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
    paths = os.pathsep.join(sys.path)
    out = subprocess.run([sys.executable, "-c", code], env={**kept, "PYTHONPATH": paths, **environment}, capture_output=True, text=True, check=True)
    return out.stdout.split("\n")[:3]


def flags():
    try:
        text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return set()
    return set(next((line.split(":")[1].split() for line in text.splitlines() if line.startswith("flags")), []))


def test_are_named():
    name, better, statement = named()
    assert repr(cattaneo.blas_kernels()) == cattaneo.blas_kernels().statement
    if not name:
        pytest.skip("the BLAS is not OpenBLAS")
    assert name in statement
    assert better == "" or better in statement


def test_poor_ones_are_called_so():
    if not named()[0] or not {"avx2", "fma"} <= flags():
        pytest.skip("no OpenBLAS, or a processor without AVX2")
    assert named(OPENBLAS_CORETYPE="Prescott")[:2] == ["Prescott", "Haswell"]
    assert "OPENBLAS_CORETYPE=Haswell" in named(OPENBLAS_CORETYPE="Prescott")[2]
    assert named(OPENBLAS_CORETYPE="Haswell")[:2] == ["Haswell", ""]
