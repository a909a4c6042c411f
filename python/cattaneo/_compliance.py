"""Problems from a flexibility matrix, as boundary elements and closed forms give it."""

from collections.abc import Mapping
from typing import Any

from ._core import InputError, LoadPattern, ReducedProblem


def _array(values: Any, name: str, shape: tuple[int, ...], of: str) -> Any:
    """An array of finite floats. A shape of -1 allows any size."""
    import numpy as np

    if hasattr(values, "toarray"):  # SciPy's sparse ones
        values = values.toarray()
    try:
        found = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} is not an array of numbers, must be {of}") from None
    fits = found.ndim == len(shape) and all(want in (-1, have) for want, have in zip(shape, found.shape))
    if not fits:
        raise InputError(f"{name} has shape {found.shape}, must be {of}")
    if not np.isfinite(found).all():
        at = tuple(int(k) for k in np.argwhere(~np.isfinite(found))[0])
        raise InputError(f"{name}{list(at)} is {found[at]}, must be finite")
    return found


def _parts(F: Any, motions: Any, slips: int) -> list[Any]:
    """Blocks of rows that are not coupled to each other: slips and openings, or all rows."""
    import numpy as np

    rows = np.arange(len(F))
    moves = [np.abs(motions[part]).max(axis=0, initial=0) > 0 for part in (rows < slips, rows >= slips)]
    apart = slips > 0 and not F[:slips, slips:].any() and not (moves[0] & moves[1]).any()
    return [rows[:slips], rows[slips:]] if apart else [rows]


def _held(F: Any, motions: Any, slips: int) -> tuple[Any, Any]:
    """K with F K = 1 except for the motions, K Z = 0. Also the forces G that leave the nodes in place and do unit work on
    one motion each: Zᵀ G = 1, F G in the span of Z."""
    import numpy as np

    K, G = np.zeros_like(F), np.zeros_like(motions)
    for part in _parts(F, motions, slips):
        of_part = np.abs(motions[part]).max(axis=0, initial=0) > 0
        Z, flexible = motions[np.ix_(part, of_part)], F[np.ix_(part, part)]
        # Forces that do no work on the motions are N y. Only such forces can act on a free body.
        q, r = np.linalg.qr(Z, mode="complete")
        free = Z.shape[1]
        if free and (np.abs(np.diag(r)) < 1e-10 * np.linalg.norm(Z, axis=0)).any():
            raise InputError("the columns of rigid_motions are not independent, each must be another motion")
        N = q[:, free:]
        balanced = N.T @ flexible @ N
        try:
            root = np.linalg.inv(np.linalg.cholesky((balanced + balanced.T) / 2)) @ N.T
        except np.linalg.LinAlgError:
            kind = "forces that balance on the rigid motions" if free else "some forces"
            raise InputError(
                f"F is not positive definite: {kind} do no work on the displacements that they cause, or negative "
                "work. Forces q and p and displacements v and w must have one sign (a pressure opens, w > 0), and "
                "all free motions must be in rigid_motions"
            ) from None
        K[np.ix_(part, part)] = root.T @ root
        if free:
            alone = q[:, :free] @ np.linalg.inv(r[:free]).T
            G[np.ix_(part, of_part)] = alone - root.T @ (root @ (flexible @ alone))
    return K, G


def from_compliance(
    F: Any,
    rigid_motions: Any = None,
    *,
    forces: Mapping[str, Any] | None = None,
    displacements: Mapping[str, Any] | None = None,
    components: int = 1,
    gap: Any = 0.0,
    friction: Any = 0.0,
    weights: Any = None,
    arc_length: Any = None,
    position: Any = None,
) -> ReducedProblem:
    """The contact problem of a flexibility matrix: displacements of contact nodes by forces on them, as boundary
    elements and closed forms give it. With m = (components + 1) n for n nodes:

    F: (m, m), symmetric, {v; w} by nodal forces {q; p}: all first tangents, all second tangents if there are any, then
    all normals. p > 0 presses and w > 0 opens. For two bodies F is the sum of both matrices. If columns are for
    tractions, divide them by the weights. For a matrix by collocation use (F + F.T) / 2.
    rigid_motions: (m, k), {v; w} of each motion that no support prevents, one per column. F may contain any multiple of
    them (a half-plane's logarithm, a reference point). None if supports hold the bodies.
    forces: loads by name, (k,): the work that a load of multiplier 1 does on each rigid motion. [-1] on a motion
    w = 1 presses with a force of 1. Conjugates are displacements along them.
    displacements: loads by name, (m,): the displacements of nodes that carry no forces under a load of multiplier 1,
    for instance an indenter that is pressed in (w = -1), or a strain. Conjugates are reactions. If a name is in
    `forces` too, both are one load of forces, and its conjugate is only the part of the contact.
    components: number of tangential components per node: 0, 1 in the plane, 2 in space.
    gap, friction, weights, arc_length, position: as ReducedProblem has them."""
    import numpy as np

    if components not in (0, 1, 2):
        raise InputError(f"components is {components!r}, must be 0, 1 or 2")
    F = _array(F, "F", (-1, -1), "square, one row per displacement {v; w}")
    m = len(F)
    if m == 0 or F.shape[1] != m or m % (components + 1) != 0:
        raise InputError(
            f"F has shape {F.shape}, must be square with {components + 1} rows per node, as components is {components}"
        )
    n = m // (components + 1)
    slips = m - n
    skew = np.abs(F - F.T)
    if skew.max() > 1e-10 * np.abs(F).max():
        i, j = (int(k) for k in np.unravel_index(skew.argmax(), skew.shape))
        raise InputError(
            f"F[{i}, {j}] is {F[i, j]:.6g} and F[{j}, {i}] is {F[j, i]:.6g}, must be equal: columns are of nodal "
            "forces, not of tractions; for a matrix by collocation use (F + F.T) / 2"
        )
    none = np.zeros((m, 0))
    Z = none if rigid_motions is None else _array(rigid_motions, "rigid_motions", (m, -1), f"({m}, k)")
    if Z.shape[1] and np.abs(Z).max(axis=0).min() == 0:
        raise InputError(f"rigid_motions[:, {int(np.abs(Z).max(axis=0).argmin())}] is zero, must be a motion")
    if Z.shape[1] >= m:
        raise InputError(f"rigid_motions has {Z.shape[1]} columns, must have fewer than F has rows, {m}")
    K, G = _held((F + F.T) / 2, Z, slips)

    names = [*(forces or {}), *(name for name in displacements or {} if name not in (forces or {}))]
    work = {name: _array([r] if np.ndim(r) == 0 else r, f"forces['{name}']", (Z.shape[1],), f"({Z.shape[1]},), one for each rigid motion")
            for name, r in (forces or {}).items()}  # fmt: skip
    moved = {name: _array(u, f"displacements['{name}']", (m,), f"({m},), of all nodes {{v; w}}")
             for name, u in (displacements or {}).items()}  # fmt: skip
    # If a load does work r on the motions, held nodes resist it with the forces -G r. If it moves free nodes by u,
    # held nodes resist it with -K u.
    held = {name: -G @ work.get(name, np.zeros(Z.shape[1])) - K @ moved.get(name, np.zeros(m)) for name in names}
    patterns = [
        LoadPattern(name, f[:slips], f[slips:], "force" if name in work else "displacement")
        for name, f in held.items()
    ]
    # With all nodes held, forces move the bodies by a, Z a + F f = 0, and displacements cause the reactions -uᵀ f.
    H = np.zeros((len(names), len(names)))
    back = np.linalg.pinv(Z) if Z.shape[1] else none.T
    for k, name in enumerate(names):
        for j, other in enumerate(names):
            if name in work:
                own = moved.get(other, np.zeros(m))
                H[k, j] = -work[name] @ back @ (F @ held[other] + own)
            else:
                H[k, j] = -moved[name] @ held[other]
    known = not any(name in moved for name in work)
    return ReducedProblem(
        K[:slips, :slips], K[slips:, :slips], K[slips:, slips:], patterns, gap=gap, friction=friction,
        weights=weights, arc_length=arc_length, position=position, H=H if known else None, rigid_motions=Z,
    )  # fmt: skip
