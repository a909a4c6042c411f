"""Quasi-static frictional contact by static reduction.

A stiffness matrix of any program, or a half-plane, is condensed to the nodes that can touch; on the
small dense problem that is left Coulomb's law is satisfied to round-off:

    body = cattaneo.NodalStiffness(K, places, elements=elements)   # scipy.sparse, NumPy
    line = body.contact_line(nodes)
    problem = cattaneo.reduce(cattaneo.condense(body, line)).problem
    problem.friction = 0.3
    report = cattaneo.march(problem, [{}, {"P": 1}, {"P": 1, "Q": 0.2}])

Names are those of the C++ library; docs/python.md is the guide.
"""

from importlib.metadata import PackageNotFoundError, version as _version

from . import fretting, readout, shakedown
from ._core import (
    CondensedBody,
    ContactLine,
    ContactState,
    Counters,
    CriticalFriction,
    CycleRecord,
    HalfPlane,
    HalfPlaneField,
    InputError,
    Interface,
    InterfaceReport,
    LoadHistory,
    LoadPattern,
    Loop,
    MarchReport,
    Material,
    NodalStiffness,
    NodeState,
    OutcomeWarning,
    Pairing,
    Progress,
    ReducedProblem,
    Reduction,
    SeparateBodies,
    StateChange,
    absorb_gap,
    can_lock,
    condense,
    conjugates,
    critical_friction,
    hold,
    joined,
    load_contact_state,
    load_reduced_problem,
    march,
    nodal_stiffness,
    pair_lines,
    read_stiffness,
    reduce,
    save,
    separate,
    set_friction,
    settled_states,
    straight_line,
    write_abaqus,
    write_matrix_market,
    write_npz,
)

try:
    __version__ = _version("cattaneo")
except PackageNotFoundError:  # imported from a build folder
    __version__ = "unknown"

__all__ = [name for name in dir() if not name.startswith("_")]
