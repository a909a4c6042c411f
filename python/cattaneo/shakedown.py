"""Shakedown limits of a contact under cyclic load, with bounds that are proven while its nodes stay closed.

    limit = shakedown.limit_problem(problem, shakedown.LoadCycle.through(problem, {"P": 1}, [{"Q": 1}, {"Q": -1}]))
    shakedown.load_limit(limit)
"""

from ._core.shakedown import (
    ClosedContact as ClosedContact,
    LimitProblem as LimitProblem,
    LimitReport as LimitReport,
    LimitSettings as LimitSettings,
    LoadCycle as LoadCycle,
    LowerLimitReport as LowerLimitReport,
    PointwiseEstimate as PointwiseEstimate,
    TransientReport as TransientReport,
    TransientSettings as TransientSettings,
    closed_contact as closed_contact,
    degree_of_coupling as degree_of_coupling,
    friction_limit as friction_limit,
    held_and_cycled as held_and_cycled,
    limit_problem as limit_problem,
    load_limit as load_limit,
    lower_limit as lower_limit,
    method1_friction as method1_friction,
    method1_load as method1_load,
    stay_closed as stay_closed,
    transient as transient,
)
