"""What a state says: zones and edges of contact, tractions."""

from ._core.readout import (
    ContactEdge,
    EdgeFit,
    EdgeTractions,
    FittedIntensity,
    Zone,
    ZoneBorder,
    contact_edges,
    contact_zone,
    contact_zones,
    edge_tractions,
    fit_edge,
    fully_stuck,
    stick_zone,
    tractions,
    zones,
)

__all__ = [name for name in dir() if not name.startswith("_")]
