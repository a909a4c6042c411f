"""Vibration of joints: modes with closed nodes glued, and the frequency and damping of each mode against its amplitude.

    structure = joints.VibratingStructure(reduction, [left, right])  # NodalStiffness with K and M
    modes = structure.modes(problem, state, 6)
    vibrating = structure.with_modes(modes)
    loops = joints.modal_curve(vibrating, structure.with_modes(modes, state), "mode 1", modes.omega[0], amplitudes)
    joints.write_dynamics("joint.mat", structure.craig_bampton(20), problem, {"B1": 4000.0})
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Mapping

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

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def _wide(value: float) -> str:
    """A number in the 16 columns of a wide field of Nastran, with as many digits as fit."""
    for digits in range(10, 0, -1):
        field = f"{value:.{digits}E}"
        if len(field) <= 16:
            break
    return field.replace("E", "D").rjust(16)


def _write_abaqus(
    name: str, made: CraigBampton, problem: ReducedProblem, places: list[tuple[int, int]], forces: NDArray[np.float64]
) -> None:
    """name.inp, and the matrices as ABAQUS names its own, name_STIF1.mtx and name_MASS1.mtx."""
    n = problem.nodes
    base = os.path.basename(name)
    for ending, matrix in (("STIF1", made.K), ("MASS1", made.M)):
        with open(f"{name}_{ending}.mtx", "w", encoding="utf-8") as out:
            for i, (node, direction) in enumerate(places):
                for j in matrix[i, : i + 1].nonzero()[0]:
                    out.write(f"{node},{direction}, {places[j][0]},{places[j][1]}, {matrix[i, j]:.17g}\n")
    with open(f"{name}.inp", "w", encoding="utf-8") as out:
        out.write("** A joint by the method of Hurty, Craig and Bampton. Contact is not in the matrices.\n")
        out.write("** Node, area, gap, coefficient of friction:\n")
        for i in range(n):
            out.write(f"** {i + 1}, {problem.weights[i]:.17g}, {problem.gap[i]:.17g}, {problem.friction[i]:.17g}\n")
        out.write("** Relative displacements, the last direction is normal and opens the gap:\n*NODE, NSET=CONTACT\n")
        for i, place in enumerate(problem.position):
            out.write(f"{i + 1}, " + ", ".join(f"{x:.17g}" for x in place) + "\n")
        out.write("** Amplitudes of modes, in direction 1:\n*NODE, NSET=MODES\n")
        out.writelines(f"{n + 1 + k}, " + ", ".join("0" for _ in problem.position[0]) + "\n" for k in range(len(made.omega)))
        out.write(f"*MATRIX INPUT, NAME=STIFFNESS, INPUT={base}_STIF1.mtx\n*MATRIX INPUT, NAME=MASS, INPUT={base}_MASS1.mtx\n")
        out.write("*MATRIX ASSEMBLE, STIFFNESS=STIFFNESS, MASS=MASS\n")
        if forces.any():
            out.write("*STEP\n*STATIC\n** Forces of the preload:\n*CLOAD\n")
            out.writelines(f"{node}, {direction}, {force:.17g}\n" for (node, direction), force in zip(places, forces) if force)
            out.write("*END STEP\n")


def _write_nastran(
    name: str, made: CraigBampton, problem: ReducedProblem, places: list[tuple[int, int]], forces: NDArray[np.float64]
) -> None:
    """name.bdf: stiffness KAAX and mass MAAX, and forces of the preload P2G. Modes are scalar points."""
    n, N = problem.nodes, len(problem.gap) + len(made.omega)
    ends = [f"{node:16d}{direction if node <= n else 0:16d}" for node, direction in places]
    with open(f"{name}.bdf", "w", encoding="utf-8") as out:
        out.write("$ A joint by the method of Hurty, Craig and Bampton. Contact is not in the matrices.\n")
        out.write("$ Relative displacements of the grid points; the last component is normal and opens the gap.\n")
        out.write("$ Grid point, area, gap, coefficient of friction:\n")
        for i in range(n):
            out.write(f"$ {i + 1} {problem.weights[i]:.10g} {problem.gap[i]:.10g} {problem.friction[i]:.10g}\n")
        for i, place in enumerate(problem.position):
            x, y, z = (_wide(value).replace("D", "E") for value in (*place, 0.0)[:3])
            out.write(f"GRID*   {i + 1:16d}{0:16d}{x}{y}\n*       {z}\n")
        if len(made.omega):
            out.write(f"SPOINT  {n + 1:8d}THRU    {N:8d}\n")
        for matrix, values in (("KAAX", made.K), ("MAAX", made.M)):
            out.write(f"DMIG    {matrix}           0       6       2       0\n")
            for j, column in enumerate(ends):
                out.write(f"DMIG*   {matrix}            {column}\n")
                out.writelines(f"*       {ends[i]}{_wide(values[i, j])}\n" for i in range(j, len(ends)) if values[i, j])
        if forces.any():
            out.write(f"DMIG    P2G            0       9       2       0                       1\nDMIG*   P2G             {1:16d}{0:16d}\n")
            out.writelines(f"*       {end}{_wide(force)}\n" for end, force in zip(ends, forces) if force)


def write_dynamics(
    file: str | os.PathLike[str], made: CraigBampton, problem: ReducedProblem, preload: Mapping[str, float] | None = None
) -> None:
    """Writes a joint for programs of dynamics.

    file: its ending decides. `.mat` (MATLAB's version 5, by SciPy) and `.npz` have all arrays. `.txt` stands for one
    file for each array, joint_M.txt for instance, with a line `row column value`, from 1, for each entry. `.inp` is a
    deck of ABAQUS with joint_STIF1.mtx and joint_MASS1.mtx beside it (*MATRIX INPUT), and `.bdf` has them for Nastran as
    DMIG KAAX and MAAX, with ten or eleven digits. There a contact node has its relative displacements as directions 1,
    2 (and 3), the last of which is normal and opens the gap. Each mode is a node after them. Both have the forces of the
    preload (*CLOAD, DMIG P2G), and areas, gaps and friction as comments, but no outputs.
    made: of VibratingStructure.craig_bampton(). problem: that of the reduction, with friction and gaps.
    preload: multipliers of loads by name; those that are left out are 0.

    With d components of a node (2 in the plane, 3 in space) and n nodes: M and K (N, N); L (d n, N), from the
    coordinates to relative displacements, node by node, tangents first, then the normal one, positive where the gap
    closes; Qm (n, n) identity and Tm (n, n) areas of the nodes, both sparse; Fv (N, 1) forces of the preload; R (outputs,
    N); F (N, loads) and loads, their names; gap, friction, weights (n,); position; omega of the modes; rows, from 0, of
    {v; w} of the problem. In `.mat` these are the names and shapes of tmdsimpy's model of a Brake-Reuss beam.
    """
    import numpy as np

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
    # Node and direction of each coordinate, in files that have nodes.
    places = [(int(row) % n + 1, int(row) // n + 1) for row in made.rows] + [(n + 1 + k, 1) for k in range(len(made.omega))]
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
    elif ending == ".inp":
        _write_abaqus(name, made, problem, places, F @ multipliers)
    elif ending == ".bdf":
        _write_nastran(name, made, problem, places, F @ multipliers)
    else:
        raise InputError(f"file '{file}' ends with '{ending}', must end with .mat, .npz, .txt, .inp or .bdf")
