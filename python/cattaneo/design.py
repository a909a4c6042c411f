"""Derivatives of what a march returns, by friction, gaps, loads and stiffness, and designs found by them.

    trace = design.trace_march(problem, history)
    lost = design.Responses(problem, trace).dissipation(0, trace.last())
    gradient = design.Sensitivity(problem, trace).gradient(lost)    # gradient.by.friction, .gap: one number per node

    wanted = design.DesignProblem(problem, [design.DesignCase("full", history)], G, low=0, high=1)
    design.design(wanted, start=0)                                  # gap = problem.gap + G x, smallest peak pressure
"""

from ._core.design import (
    ActiveResponse as ActiveResponse,
    CornerIntensities as CornerIntensities,
    DesignCase as DesignCase,
    DesignProblem as DesignProblem,
    DesignReport as DesignReport,
    DesignSettings as DesignSettings,
    EdgeIntensities as EdgeIntensities,
    Gradient as Gradient,
    LimitGradient as LimitGradient,
    MarchTrace as MarchTrace,
    MovingEdge as MovingEdge,
    Parameters as Parameters,
    Response as Response,
    Responses as Responses,
    Sensitivity as Sensitivity,
    StiffnessChange as StiffnessChange,
    Tie as Tie,
    TraceChange as TraceChange,
    corner_intensities as corner_intensities,
    design as design,
    edge_intensities as edge_intensities,
    friction_limit_gradient as friction_limit_gradient,
    gap_variables as gap_variables,
    limit_curvature as limit_curvature,
    load_limit_gradient as load_limit_gradient,
    moving_edge as moving_edge,
    spread_starts as spread_starts,
    stiffness_scale as stiffness_scale,
    ties as ties,
    trace_march as trace_march,
    trace_stuck as trace_stuck,
    trace_wear as trace_wear,
)
