"""The page of a run: one file that needs no other files."""

import io
import json
import pathlib
import re

from .panels import panel_names, read
from .tables import write

HERE = pathlib.Path(__file__).resolve().parent


def page(run, file, figure=True):
    """Writes the page of a run, whole or not at all.

    run: what read() returned, or the name of its file. figure: whether the picture of its panels is in it, which needs
    matplotlib. Its slider has the increments of runs that were written with --html. Refused if the file cannot be
    written."""
    run = run if isinstance(run, dict) else read(run)
    shown = run["shown"]
    case = shown["options"].get("case") or ""
    data = {"study": shown["study"], "title": pathlib.Path(case).name.removesuffix(".json"), "status": run.get("status", ""), "message": run.get("message", ""), "event": shown["event"], "units": shown.get("units", {"length": "", "pressure": ""}),
            "seconds": run.get("seconds"), "warnings": run.get("warnings", []), "options": shown["options"], "given": shown.get("given", {}), "values": shown["values"],
            "tables": shown["tables"], "films": shown["marches"], "more_films": shown["more_marches"], "lead": shown.get("lead"), "sketch": shown.get("sketch")}
    text = (HERE / "page.html").read_text(encoding="utf-8")
    # Within a script "</" would end it.
    text = text.replace("@RUN@", json.dumps(data, ensure_ascii=False).replace("</", "<\\/"))
    text = text.replace("@FIGURE@", svg(run) if figure and shown["panels"] else "")
    write(file, text)


# What the slider shows already, increment by increment.
SLIDER_HAS = ("zones_in_time", "tractions", "loops")
MAPS_HAVE = ("pressure", "shear", "slip")


def svg(run):
    """Each panel by itself, so that they stand side by side where there is room. Those of the slider are left out."""
    from .drawing import drawn_panels, save, sheet

    slider = bool(run["shown"]["marches"])
    has = SLIDER_HAS + (MAPS_HAVE if any(march.get("maps") for march in run["shown"]["marches"]) else ())
    names = [name for name in panel_names(run) if not (slider and run["shown"]["study"] in ("contact", "march") and name.startswith(has))]
    pieces = []
    for k, one in enumerate(drawn_panels(run, names)):
        drawn = io.StringIO()
        save(sheet([one]), drawn, format="svg")
        # Names within a picture are those of the page as well.
        text = drawn.getvalue()[drawn.getvalue().index("<svg"):]
        text = re.sub(r'(\bid="|href="#|url\(#)', rf"\1f{k}-", text)
        pieces.append(f"<div>{text}</div>")
    return "".join(pieces)
