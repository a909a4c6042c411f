"""Shakedown limits of a contact under cyclic load, with bounds that are proven while its nodes stay closed.

    limit = shakedown.limit_problem(problem, shakedown.LoadCycle.through(problem, {"P": 1}, [{"Q": 1}, {"Q": -1}]))
    shakedown.load_limit(limit)
"""

from ._core.shakedown import (
    ClosedContact,
    LimitProblem,
    LimitReport,
    LoadCycle,
    LowerLimitReport,
    PointwiseEstimate,
    TransientReport,
    closed_contact,
    degree_of_coupling,
    friction_limit,
    held_and_cycled,
    limit_problem,
    load_limit,
    lower_limit,
    method1_friction,
    method1_load,
    stay_closed,
    transient,
)

__all__ = [name for name in dir() if not name.startswith("_")]
