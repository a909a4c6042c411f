"""What a state says: zones and edges of contact, tractions."""

from ._core.readout import (
    ContactAreas as ContactAreas,
    ContactEdge as ContactEdge,
    EdgeFit as EdgeFit,
    EdgeTractions as EdgeTractions,
    FitSettings as FitSettings,
    FittedIntensity as FittedIntensity,
    SurfacePart as SurfacePart,
    Zone as Zone,
    ZoneBorder as ZoneBorder,
    contact_areas as contact_areas,
    contact_edges as contact_edges,
    contact_zone as contact_zone,
    contact_zones as contact_zones,
    edge_tractions as edge_tractions,
    fit_edge as fit_edge,
    fully_stuck as fully_stuck,
    stick_zone as stick_zone,
    tractions as tractions,
    zones as zones,
)
