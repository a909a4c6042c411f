"""Vibration of joints: modes with closed nodes glued, and the frequency and damping of each mode against its amplitude.

    structure = joints.VibratingStructure(reduction, [left, right])  # NodalStiffness with K and M
    modes = structure.modes(problem, state, 6)
    vibrating = structure.with_modes(modes)
    loops = joints.modal_curve(vibrating, structure.with_modes(modes, state), "mode 1", modes.omega[0], amplitudes)
    joints.write_dynamics("joint.mat", structure.craig_bampton(20), problem, {"B1": 4000.0})
"""

import os
from typing import Mapping

import numpy as np
from numpy.typing import NDArray

from ._core import InputError, ReducedProblem
from ._core.joints import (
    CraigBampton as CraigBampton,
    ModalLoop as ModalLoop,
    ModalLoopSettings as ModalLoopSettings,
    Modes as Modes,
    VibratingStructure as VibratingStructure,
    modal_curve as modal_curve,
    nodes_at_limit as nodes_at_limit,
)


def write_dynamics(
    file: str | os.PathLike[str], made: CraigBampton, problem: ReducedProblem, preload: Mapping[str, float] | None = None
) -> None:
    """Writes a joint for programs of dynamics.

    file: its ending decides. `.mat` (MATLAB's version 5, by SciPy) and `.npz` have all arrays. `.txt` stands for one
    file for each array, joint_M.txt for instance, with a line `row column value`, from 1, for each entry.
    made: of VibratingStructure.craig_bampton(). problem: that of the reduction, with friction and gaps.
    preload: multipliers of loads by name; those that are left out are 0.

    With d components of a node (2 in the plane, 3 in space) and n nodes: M and K (N, N); L (d n, N), from the
    coordinates to relative displacements, node by node, tangents first, then the normal one, positive where the gap
    closes; Qm (n, n) identity and Tm (n, n) areas of the nodes, both sparse; Fv (N, 1) forces of the preload; R (outputs,
    N); F (N, loads) and loads, their names; gap, friction, weights (n,); position; omega of the modes; rows, from 0, of
    {v; w} of the problem. In `.mat` these are the names and shapes of tmdsimpy's model of a Brake-Reuss beam.
    """
    n, N = problem.nodes, made.K.shape[0]
    d = problem.components + 1
    L: NDArray[np.float64] = np.zeros((d * n, N))
    for column, row in enumerate(made.rows):
        component, node = divmod(int(row), n)
        L[d * node + component, column] = -1 if component == d - 1 else 1
    multipliers = np.zeros(len(made.loads))
    for name, value in (preload or {}).items():
        if name not in made.loads:
            raise InputError(f"preload names '{name}', must be one of {', '.join(made.loads) or 'none'}")
        multipliers[made.loads.index(name)] = value
    F = made.F if made.loads else np.zeros((N, 0))
    arrays: dict[str, NDArray[np.float64]] = {"M": made.M, "K": made.K, "L": L, "Fv": (F @ multipliers)[:, None], "R": made.R, "F": F}
    arrays |= {"gap": problem.gap, "friction": problem.friction, "weights": problem.weights, "position": problem.position}
    arrays |= {"omega": made.omega, "rows": np.asarray(made.rows)}
    name, ending = os.path.splitext(os.fspath(file))
    if ending == ".npz":
        np.savez(file, Qm=np.eye(n), Tm=np.diag(problem.weights), loads=np.array(made.loads), **arrays)  # type: ignore[arg-type]
    elif ending == ".mat":
        from scipy.io import savemat
        from scipy.sparse import diags, identity

        sparse = {"Qm": identity(n, format="csc"), "Tm": diags(problem.weights, format="csc")}
        savemat(file, {**arrays, **sparse, "loads": np.array(made.loads, object)})
    elif ending == ".txt":
        for each, array in {**arrays, "Qm": np.eye(n), "Tm": np.diag(problem.weights)}.items():
            table = array if array.ndim == 2 else array[:, None]
            rows, columns = np.nonzero(table)
            with open(f"{name}_{each}.txt", "w", encoding="utf-8") as out:
                out.writelines(f"{i + 1} {j + 1} {table[i, j]:.17g}\n" for i, j in zip(rows, columns))
    else:
        raise InputError(f"file '{file}' ends with '{ending}', must end with .mat, .npz or .txt")
