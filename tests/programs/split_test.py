"""Meshes of Gmsh: bodies that are cut along a named line, and materials by the names of surfaces."""

import pytest

from programs import changed, near_all

GROUPS = {"bottom": 1, "right": 2, "top": 3, "left": 4, "slit": 5, "lower": 1, "upper": 2}


def block(order, end):
    """A block [0, 4] × [0, 2] of 8 × 4 elements with a line 'slit' on y = 1 from x = 0 to `end`; attributes of its halves."""
    nx, ny = 8 * order, 4 * order
    number = {(i, j): 1 + i + (nx + 1) * j for j in range(ny + 1) for i in range(nx + 1)}
    elements = []

    def line(group, i, j, di, dj):
        nodes = [number[i, j], number[i + order * di, j + order * dj]] + ([number[i + di, j + dj]] if order == 2 else [])
        elements.append((8 if order == 2 else 1, GROUPS[group], nodes))

    for k in range(0, nx, order):
        line("bottom", k, 0, 1, 0)
        line("top", k, ny, 1, 0)
        if 4 * k / nx < end:
            line("slit", k, ny // 2, 1, 0)
    for k in range(0, ny, order):
        line("left", 0, k, 0, 1)
        line("right", nx, k, 0, 1)
    places = [(0, 0), (2, 0), (2, 2), (0, 2)] + [(1, 0), (2, 1), (1, 2), (0, 1), (1, 1)] * (order == 2)
    for j in range(0, ny, order):
        for i in range(0, nx, order):
            nodes = [number[i + order * di // 2, j + order * dj // 2] for di, dj in places]
            elements.append((10 if order == 2 else 3, GROUPS["lower" if j < ny // 2 else "upper"], nodes))
    names = [f'{2 if name in ("lower", "upper") else 1} {group} "{name}"' for name, group in GROUPS.items()]
    return "\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames", "$Nodes", str(len(number)),
         *(f"{n} {4 * i / nx} {2 * j / ny} 0" for (i, j), n in number.items()), "$EndNodes", "$Elements", str(len(elements)),
         *(f"{k + 1} {kind} 2 {group} {group} " + " ".join(map(str, nodes)) for k, (kind, group, nodes) in enumerate(elements)),
         "$EndElements", ""])


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("end", [2, 4])
def test_a_block_passes_the_patch_test(run, order, end):
    """A block that is cut, up to a tip within it or through, bears the uniform stress that it had before."""
    run.write("block.msh", block(order, end))
    load = ["P pressure top,bottom 1.3", "Q traction top 0.3 0", "Q traction bottom -0.3 0", "Q traction right 0 0.3", "Q traction left 0 -0.3"]
    # Cut through, the upper half is held by friction alone.
    support = "@0,0:xy @4,0:y"
    keys = {"order": order, "history": ["P=0", "P=1", "Q=1"], "interfaces": {"slit": {"between": ["block:slit-", "block:slit+"], "friction": 0.5}},
            "bodies": {"block": {"mesh": "block.msh", "split": "slit", "young": 1000, "poisson": 0.3, "support": support, "load": load}}}
    found = run.case(keys, "--csv", run.folder / "slit")
    nodes = run.columns("slit_nodes.csv")
    assert len(nodes["p"]) == 2 * end * order + (end == 4)  # the tip carries no row
    near_all(nodes["p"], 1.3, 1e-9)
    near_all([abs(q) for q in nodes["q"]], 0.3, 1e-9)
    assert found.warned() == ""
    assert "no line 'gap' to split, must be one of bottom, left, right, slit, top" in run.refused(changed(keys, {"bodies.block.split": "gap"}))
    assert "on the outer boundary" in run.refused(changed(keys, {"bodies.block.split": "top", "interfaces.slit.between": ["block:top-", "block:top+"]}))


def test_materials_go_by_the_names_of_surfaces(run):
    run.write("block.msh", block(1, 4))
    keys = {"order": 2, "history": ["P=0", "P=1"], "interfaces": {"floor": {"between": "block:bottom", "friction": 0.5}},
            "bodies": {"block": {"mesh": "block.msh", "young": {"upper": 3000, "lower": 1000}, "poisson": 0.3, "support": "left:x",
                                 "load": "P pressure top[0<x<1] 1"}}}
    run.case(keys, "--csv", run.folder / "named")
    run.case(changed(keys, {"bodies.block.young": [1000, 3000]}), "--csv", run.folder / "listed")
    named, listed = run.columns("named_nodes.csv"), run.columns("listed_nodes.csv")
    assert named["p"] == listed["p"] and max(named["p"]) > 0.5
    run.case(changed(keys, {"bodies.block.young": [3000, 1000]}), "--csv", run.folder / "listed")
    assert run.columns("listed_nodes.csv")["p"] != named["p"]
    assert ("names 'middle', which is no group of elements of the mesh, must be one of lower, upper"
            in run.refused(changed(keys, {"bodies.block.young": {"upper": 1, "middle": 1}})))
    assert "has nothing for the group 'lower'" in run.refused(changed(keys, {"bodies.block.young": {"upper": 1}}))
