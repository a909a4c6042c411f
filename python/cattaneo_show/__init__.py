"""Pictures and pages of the runs that Cattaneo's programs write as JSON.

    from cattaneo_show import read, plot, page

    run = read("run.json")                      # of ./run NAME --json run.json
    plot(run, "run.png", panels=["tractions"])  # needs matplotlib
    page(run, "run.html")                       # figures in it need matplotlib

Nothing is computed here, and nothing has to be built. `python3 cattaneo_show run.json --plot run.png` does the same."""

from .page import page as page
from .panels import Refused as Refused, panel as panel, panel_names as panel_names, read as read


def plot(run, file=None, panels=None):
    """A figure (matplotlib) of a run's panels, saved if a file is named (png, pdf or svg).

    run: what read() returned, or the name of its file. panels: their names (panel_names()), in the order wanted, or None
    for all. Returns the figure. Unknown names are refused; ImportError without matplotlib."""
    from .drawing import figure, save

    made = figure(run if isinstance(run, dict) else read(run), panels)
    if file is not None:
        save(made, file, dpi=110)
    return made
