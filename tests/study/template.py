"""template.py PROGRAM PAGE: the study that docs/new_study.md shows does what the page says of studies."""

import json
import pathlib
import subprocess
import sys
import tempfile


def main():
    program, page = sys.argv[1:]
    text = pathlib.Path(page).read_text(encoding="utf-8")
    code = text.split("```cpp\n")[1].split("```")[0]
    lines = [line for line in code.splitlines() if line.strip() and not line.startswith("//")]
    assert len(lines) <= 60, f"{len(lines)} lines"
    with tempfile.TemporaryDirectory() as folder:
        case = pathlib.Path(folder) / "case.json"
        case.write_text('{"width": 0.5, "friction": 0}', encoding="utf-8")
        for options, pressed in (([], 1.0), (["--case", str(case)], 0.5)):
            run = subprocess.run([program, *options, "--json", "r.json", "--csv", "t", "--plot", "p.png"], cwd=folder,
                                 text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            assert run.returncode == 0, run.stdout
            results = json.loads((pathlib.Path(folder) / "r.json").read_text(encoding="utf-8"))
            # It lifts off beside the pressure, and within less than its thickness.
            assert 0.5 * pressed < results["half_width"] < 0.5 * pressed + 1, results
            assert (pathlib.Path(folder) / "t_tractions.csv").stat().st_size > 0
            assert (pathlib.Path(folder) / "p.png").stat().st_size > 0
        run = subprocess.run([program, "-width", "-1"], text=True, stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, check=False)
        assert run.returncode == 1 and "option --width is -1, must be between 0 and 16" in run.stdout, run.stdout


main()
