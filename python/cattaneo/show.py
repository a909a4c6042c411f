"""Pictures and pages of runs: the package cattaneo_show, which needs nothing that is compiled."""

from cattaneo_show import Refused as Refused, page as page, panel as panel, panel_names as panel_names, plot as plot, read as read
