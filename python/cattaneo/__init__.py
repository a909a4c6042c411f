"""Quasi-static frictional contact by static reduction.

A stiffness matrix of any program, or a half-plane, is condensed to the nodes that can touch; on the
small dense problem that remains, Coulomb's law is satisfied to round-off:

    body = cattaneo.NodalStiffness(K, places, elements=elements)   # scipy.sparse, NumPy
    line = body.contact_line(nodes)
    problem = cattaneo.reduce(cattaneo.condense(body, line)).problem
    problem.friction = 0.3
    report = cattaneo.march(problem, [{}, {"P": 1}, {"Q": 0.2}])

Arguments that many functions have: `problem`, a ReducedProblem; `state`, a ContactState of this problem (None: before
any load); `settings`, the struct that is named in the signature, whose members can also be given by their names;
`progress`, True for a line on stderr, or a function that gets a Progress; `stop`, a threading.Event that ends long
work; `file`, a name or path.

Names are those of the C++ library; docs/python.md is the guide.
"""

from . import (
    design as design,
    fretting as fretting,
    joints as joints,
    readout as readout,
    shakedown as shakedown,
    show as show,
    wear as wear,
)
from ._core import (
    BlasKernels as BlasKernels,
    BoltedJoint as BoltedJoint,
    CondensedBody as CondensedBody,
    ContactLine as ContactLine,
    ContactState as ContactState,
    ContactSurface as ContactSurface,
    Counters as Counters,
    CriticalFriction as CriticalFriction,
    CycleRecord as CycleRecord,
    FrictionSettings as FrictionSettings,
    HalfPlane as HalfPlane,
    HalfPlaneField as HalfPlaneField,
    HalfSpace as HalfSpace,
    Heights as Heights,
    InputError as InputError,
    Interface as Interface,
    InterfaceMarch as InterfaceMarch,
    InterfaceReport as InterfaceReport,
    LoadHistory as LoadHistory,
    LoadPattern as LoadPattern,
    Loop as Loop,
    MarchReport as MarchReport,
    MarchSettings as MarchSettings,
    Material as Material,
    NodalStiffness as NodalStiffness,
    NodeState as NodeState,
    OutcomeWarning as OutcomeWarning,
    Pairing as Pairing,
    Progress as Progress,
    ReducedProblem as ReducedProblem,
    Reduction as Reduction,
    SeparateBodies as SeparateBodies,
    StateChange as StateChange,
    absorb_gap as absorb_gap,
    blas_kernels as blas_kernels,
    can_lock as can_lock,
    condense as condense,
    condense_joint as condense_joint,
    conjugates as conjugates,
    critical_friction as critical_friction,
    gaps_to_cylinder as gaps_to_cylinder,
    gaps_to_height as gaps_to_height,
    gaps_to_plane as gaps_to_plane,
    gaps_to_sphere as gaps_to_sphere,
    hold as hold,
    joined as joined,
    load_contact_state as load_contact_state,
    load_reduced_problem as load_reduced_problem,
    march as march,
    nodal_stiffness as nodal_stiffness,
    pair_lines as pair_lines,
    pair_surfaces as pair_surfaces,
    read_heights as read_heights,
    read_stiffness as read_stiffness,
    reduce as reduce,
    save as save,
    separate as separate,
    set_friction as set_friction,
    settled_states as settled_states,
    straight_line as straight_line,
    version as _version,
    write_abaqus as write_abaqus,
    write_matrix_market as write_matrix_market,
    write_nastran as write_nastran,
    write_npz as write_npz,
)

from . import _core, _repr
from ._case import Case as Case, case as case
from ._compliance import from_compliance as from_compliance
from . import _pickle as _pickle  # teaches pickle, and with it multiprocessing, problems and states

_repr.teach(_core)

__version__ = _version
