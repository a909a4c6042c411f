"""headers.py PLUGIN: every header that is installed is included by <cattaneo/cattaneo.hpp>, directly or by others."""

import pathlib
import re
import sys

plugin = pathlib.Path(sys.argv[1])
reached, next_ones = set(), ["cattaneo/cattaneo.hpp"]
while next_ones:
    header = next_ones.pop()
    if header not in reached:
        reached.add(header)
        next_ones += re.findall(r"#include <(cattaneo/[^>]+)>", (plugin / header).read_text(encoding="utf-8"))
missing = sorted({str(file.relative_to(plugin)) for file in plugin.glob("cattaneo/**/*.hpp")} - reached)
sys.exit(f"<cattaneo/cattaneo.hpp> does not include {', '.join(missing)}" if missing else 0)
