"""How long `import cattaneo` takes in a Python that has just started: less than 0.3 s. It does not import NumPy.

import_time.py [SECONDS]   Python must find the package (PYTHONPATH)

Each import is in a process of its own, and the time is that of the clock around the statement. What else the machine
does only makes it longer, so the shortest of several counts: of five, or of more, up to forty, until it is short
enough. Prints it beside that of NumPy alone, and what it took longest to import."""

import re
import subprocess
import sys

LIMIT = float(sys.argv[1]) if len(sys.argv) > 1 else 0.3


def seconds(statement):
    code = f"import time; begin = time.perf_counter(); {statement}; print(time.perf_counter() - begin)"
    return float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)


def main():
    # Functions that need NumPy import it when they are called.
    code = "import sys, cattaneo; sys.exit('numpy' in sys.modules)"
    if subprocess.run([sys.executable, "-c", code]).returncode:
        print("import cattaneo imports NumPy, must not")
        return 1
    times = [seconds("import cattaneo") for _ in range(5)]
    while min(times) >= LIMIT and len(times) < 40:
        times.append(seconds("import cattaneo"))
    print(f"import cattaneo: {min(times):.3f} s, the shortest of {len(times)} (at most {LIMIT} s); "
          f"NumPy alone: {min(seconds('import numpy') for _ in range(5)):.3f} s")
    if min(times) < LIMIT:
        return 0
    listed = subprocess.run([sys.executable, "-X", "importtime", "-c", "import cattaneo"], check=True, capture_output=True, text=True).stderr
    rows = [(int(own), name) for own, name in re.findall(r"import time: +(\d+) \| +\d+ \| +(\S+)", listed)]
    print("longest, in ms:", *(f"{name} {own / 1000:.0f}" for own, name in sorted(rows, reverse=True)[:8]))
    return 1


sys.exit(main())
