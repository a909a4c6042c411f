"""Installs the package with pip into a fresh environment, where nothing of MFEM is, and runs its tests and examples there.

    package.py FOLDER      ends with 77 where Python's packages cannot be had"""

import os
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*words, **options):
    print("+", *words, flush=True)
    return subprocess.run([str(word) for word in words], **options).returncode


def main():
    folder = pathlib.Path(sys.argv[1])
    shutil.rmtree(folder, ignore_errors=True)
    python = folder / "venv" / "bin" / "python"
    pip = [python, "-m", "pip", "--disable-pip-version-check"]
    tools = ["scikit-build-core", "nanobind", "numpy", "scipy", "scikit-fem", "matplotlib", "pytest", "mypy"]
    if run(sys.executable, "-m", "venv", folder / "venv") or run(*pip, "install", "-q", *tools):
        print("skipped: Python's packages cannot be had")
        return 77
    # Without MFEM: nothing that was built here is named.
    clean = {key: value for key, value in os.environ.items() if key not in ("MFEM_DIR", "PYTHONPATH")}
    # Case files are read by the program of the build, if it is there.
    if (folder.parent / "miniapps" / "contact").is_file():
        clean["CATTANEO_BIN"] = str(folder.parent / "miniapps")
    # In the folder of the tests, so that the folder `python` of the repository is not what is imported.
    return run(*pip, "install", "-q", "--no-build-isolation", ROOT, env=clean) or run(
        python, "-m", "pytest", "-q", "-p", "no:cacheprovider", ROOT / "python" / "tests", cwd=folder, env=clean
    )


sys.exit(main())
