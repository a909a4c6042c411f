"""Cases of bodies in space: blocks, meshes of solids, obstacles, histories, and mistakes."""

import json
import math
import re

import pytest

from programs import alike, even, near, near_all, near_relative, rectangle, shipped


def axis(points, cells, **more):
    return {"points": points, "cells": cells if isinstance(cells, list) else [cells], **more}


def brick(x, y, z, elements="hexahedra"):
    return {"x": axis(*x), "y": axis(*y), "z": axis(*z), "elements": elements}


def block(load="P pressure top 1", friction=0.3, **keys):
    """A block of E = 1, ν = 0.3 on a rigid plane."""
    return {"analysis": "space", "order": 1,
            "bodies": {"block": {"block": brick(([0, 2], 4), ([0, 1], 2), ([0, 1], 2)), "young": 1, "poisson": 0.3, "load": load, **keys}},
            "interfaces": {"floor": {"between": "block:bottom", "friction": friction,
                                     "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}}}


def solid(cells, size, elements):
    """Nodes and boundary faces of a brick of hexahedra or tetrahedra, by side: 1 below, 6 above, 2 the others."""
    nx, ny, nz = cells
    number = {}
    for k in range(nz + 1):
        for j in range(ny + 1):
            for i in range(nx + 1):
                number[i, j, k] = len(number)
    nodes = [[i * size[0] / nx, j * size[1] / ny, k * size[2] / nz] for i, j, k in number]
    solids, faces = [], []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                h = [number[i + a, j + b, k + c] for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
                quads = [(k == 0, 1, (0, 3, 2, 1)), (k == nz - 1, 6, (4, 5, 6, 7)), (j == 0, 2, (0, 1, 5, 4)), (i == nx - 1, 2, (1, 2, 6, 5)),
                         (j == ny - 1, 2, (2, 3, 7, 6)), (i == 0, 2, (3, 0, 4, 7))]
                if elements == "hexahedra":
                    solids.append(h)
                    faces += [(side, [h[a] for a in face]) for outer, side, face in quads if outer]
                    continue
                tets = [[h[0], h[s], h[t], h[6]] for s, t in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1))]
                solids += tets
                triangles = [sorted(tet[:m] + tet[m + 1:]) for tet in tets for m in range(4)]
                for outer, side, face in quads:
                    own = {h[a] for a in face}
                    faces += [(side, triangle) for triangle in triangles if outer and set(triangle) <= own]
    return nodes, solids, faces


def mfem_text(nodes, solids, faces):
    kind, flat = {8: (5, 3), 4: (4, 2)}[len(solids[0])]
    lines = ["MFEM mesh v1.0", "", "dimension", "3", "", "elements", str(len(solids)), *(f"1 {kind} " + " ".join(map(str, s)) for s in solids), "",
             "boundary", str(len(faces)), *(f"{side} {flat} " + " ".join(map(str, f)) for side, f in faces), "", "vertices", str(len(nodes)), "3",
             *(" ".join(map(repr, at)) for at in nodes), ""]
    return "\n".join(lines)


def gmsh_text(nodes, solids, faces, version):
    kind, flat = {8: (5, 3), 4: (4, 2)}[len(solids[0])]
    names = ["$PhysicalNames", "4", '2 1 "low"', '2 6 "high"', '2 2 "sides"', '3 7 "all of it"', "$EndPhysicalNames"]
    head = ["$MeshFormat", f"{version} 0 8", "$EndMeshFormat", *names]
    if version == "2.2":
        rows = [(flat, side, f) for side, f in faces] + [(kind, 7, s) for s in solids]
        return "\n".join([*head, "$Nodes", str(len(nodes)), *(f"{k} " + " ".join(map(repr, at)) for k, at in enumerate(nodes, 1)), "$EndNodes",
                          "$Elements", str(len(rows)),
                          *(f"{k} {t} 2 {g} {g} " + " ".join(str(n + 1) for n in own) for k, (t, g, own) in enumerate(rows, 1)), "$EndElements", ""])
    sides = sorted({side for side, _ in faces})
    entities = [f"0 0 {len(sides)} 1", *(f"{s} 0 0 0 1 1 1 1 {s} 0" for s in sides), "1 0 0 0 1 1 1 1 7 0"]
    numbers = [str(k) for k in range(1, len(nodes) + 1)]
    lines, count = [], 0
    for dimension, entity, t, rows in [(2, s, flat, [f for side, f in faces if side == s]) for s in sides] + [(3, 1, kind, solids)]:
        lines.append(f"{dimension} {entity} {t} {len(rows)}")
        for own in rows:
            count += 1
            lines.append(f"{count} " + " ".join(str(n + 1) for n in own))
    return "\n".join([*head, "$Entities", *entities, "$EndEntities", "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"3 1 0 {len(nodes)}", *numbers,
                      *(" ".join(map(repr, at)) for at in nodes), "$EndNodes", "$Elements", f"{len(sides) + 1} {count} 1 {count}", *lines,
                      "$EndElements", ""])


def test_an_extruded_problem_is_the_plane_one(run):
    """A block is pressed on another one and sheared to and fro: in plane strain, and between walls as a slice of hexahedra.
    Nothing opens, so that both marches take the same increments."""
    thick, history = 0.7, ["P=0", "P=1", "Q=0.1", "Q=-0.1", "Q=0.1"]
    for name, low, high in (("upper", 0, 2), ("lower", -1, 0)):
        run.write(name + ".mesh", rectangle(even(0, 3, 6), even(low, high, 3), lambda x, y: (x, y)))
    march = {"history": history, "cycle-start": 2, "cycles": 1, "stepping": "fixed", "increments": 10, "order": 1}
    plane = run.case({"bodies": {"upper": {"mesh": str(run.folder / "upper.mesh"), "young": 2, "poisson": 0.3, "load": "P pressure 3 1; Q traction 3 1 0"},
                                 "lower": {"mesh": str(run.folder / "lower.mesh"), "young": 5, "poisson": 0.2, "support": "1:xy"}},
                      "interfaces": {"face": {"between": ["upper:1", "lower:3"], "friction": 0.15}}, **march}, "--csv", run.folder / "plane")
    for layers in (1, 2):
        def slab(low, high):
            return brick(([0, 3], 6), ([low, high], 3), ([0, thick], layers))
        space = run.case({"analysis": "space", **march,
                          "bodies": {"upper": {"block": slab(0, 2), "young": 2, "poisson": 0.3, "support": "bottom:z top:z",
                                               "load": "P pressure back 1; Q traction back 1 0 0"},
                                     "lower": {"block": slab(-1, 0), "young": 5, "poisson": 0.2, "support": "front:xyz bottom:z top:z"}},
                          "interfaces": {"face": {"between": ["upper:front", "lower:back"], "friction": 0.15}}}, "--csv", run.folder / "space")
        one, other = plane.interface("face"), space.interface("face")
        near(other["force_x"], thick * one["force_x"], 1e-10)
        near(other["force_y"], thick * one["force_y"], 1e-10)
        flat, deep = run.columns("plane_history.csv"), run.columns("space_history.csv")
        assert max(flat["forward_slip"]) > 0 and max(flat["stick"]) > 0
        for load in ("P", "Q"):
            courses = []
            for table in (flat, deep):
                key = next(key for key in table if key.startswith("displacement") and key.endswith(load))
                courses.append([x / max(map(abs, table[key])) for x in table[key]])
            alike(*courses, 1e-9)
        near_relative(space["peak_pressure"], plane["peak_pressure"], 1e-9)
        # Walls bear what plane strain does; each body is in balance.
        assert {row["name"] for row in space["reactions"] if row["body"] == "upper"} == {"bottom:z", "top:z"}
        near_all([row["imbalance"] for row in space["balance"]], 0, 1e-10)


def test_bolted_laps_are_the_plane_ones(run):
    """Two laps, pulled together by a bolt and sheared to and fro: in plane strain, and between walls as a slice of hexahedra.
    The bolt pulls on all of the lap, so that nothing opens."""
    thick, ends = 0.7, ["upper:3[0<x<3]", "lower:1[0<x<3]"]
    march = {"history": ["Q=0", "bolt=1", "Q=0.1", "Q=-0.1", "Q=0.1"], "cycle-start": 2, "cycles": 1, "stepping": "fixed", "increments": 10, "order": 1}
    run.write("upper.mesh", rectangle(even(0, 4, 8), even(0, 1, 2), lambda x, y: (x, y)))
    run.write("lower.mesh", rectangle(even(-1, 3, 8), even(-1, 0, 2), lambda x, y: (x, y)))
    plane = run.case({"thickness": thick,
                      "bodies": {"upper": {"mesh": str(run.folder / "upper.mesh"), "young": 2, "poisson": 0.3, "support": "2:y", "load": "Q traction 2 1 0"},
                                 "lower": {"mesh": str(run.folder / "lower.mesh"), "young": 5, "poisson": 0.2, "support": "4:xy"}},
                      "interfaces": {"face": {"between": ["upper:1[0<x<3]", "lower:3[0<x<3]"], "friction": 0.15}},
                      "bolts": {"bolt": {"between": ends, "stiffness": 0.8, "preload": 1.5}}, **march})

    def slab(x0, x1, y0, y1):
        return brick(([x0, x1], 8), ([y0, y1], 2), ([0, thick], 1))
    keys = {"analysis": "space", **march,
            "bodies": {"upper": {"block": slab(0, 4, 0, 1), "young": 2, "poisson": 0.3, "support": "right:y bottom:z top:z", "load": "Q traction right 1 0 0"},
                       "lower": {"block": slab(-1, 3, -1, 0), "young": 5, "poisson": 0.2, "support": "left:xyz bottom:z top:z"}},
            "interfaces": {"face": {"between": ["upper:front[0<x<3]", "lower:back[0<x<3]"], "friction": 0.15}},
            "bolts": {"bolt": {"between": ["upper:back[0<x<3]", "lower:front[0<x<3]"], "stiffness": 0.8, "preload": 1.5}}}
    space = run.case(keys, "--save-state", run.folder / "whole")
    one, other = plane.interface("face"), space.interface("face")
    assert one["separation"] == 0 and other["separation"] == 0 and other["slip"] > 0
    for key in ("normal", "force_x", "force_y"):
        near(other[key], one[key], 1e-10)
    for key in ("tightened_to", "all_tightened", "force", "least", "most"):
        near(space["bolts"][0][key], plane["bolts"][0][key], 1e-10)
    near(space["bolts"][0]["all_tightened"], 1.5, 1e-10)
    assert space["bolts"][0]["least"] < space["bolts"][0]["most"]
    # The displacement of the load is that of the end, and its force is the whole force.
    sizes = {row["load"]: row for row in space["load_sizes"]}
    near(sizes["Q"]["size"], thick, 1e-12)
    assert sizes["Q"]["displacement"] == "displacement of upper:right along x" and sizes["bolt"]["kind"] == "bolt"
    near_all([row["imbalance"] for row in space["balance"]], 0, 1e-10)
    # A march goes on from a state in which the bolt is tight.
    run.case({**keys, "history": ["Q=0", "bolt=1"], "cycle-start": -1}, "--save-state", run.folder / "part")
    rest = run.case(keys, "--load-state", run.folder / "part")
    near_relative(rest["bolts"][0]["least"], space["bolts"][0]["least"], 1e-12)


@pytest.mark.parametrize("axis", "xy")
def test_a_guide_presses_and_bends_a_column(run, axis):
    """A column, ν = 0, on a smooth plane, under a rigid block: its pressure is P/A + M x/I, and the block comes down by P H/(E A) and turns
    by M H/(E I)."""
    wide, deep, height, force, moment = 2, 1, 1.5, 0.3, 0.02
    area, bend = wide * deep, {"x": wide * deep**3 / 12, "y": deep * wide**3 / 12}[axis]
    half = {"x": deep, "y": wide}[axis] / 2
    for turning, history in (({"moment": "M", "value": moment}, ["P=0", "P=1", "M=1"]), ({"angle": "M", "value": moment * height / bend}, ["P=0", "P=1", "M=1"])):
        case = block(None, 0, block=brick(([0, wide], 2), ([0, deep], 2), ([0, height], 2)), poisson=0, order=2,
                     guides={"on": "top", "x": "held", "y": "held", "z": {"force": "P", "value": -force}, "rotation-" + axis: turning})
        del case["bodies"]["block"]["load"]
        middle = {"middle": {"body": "block", "at": [wide / 2, deep / 2, height / 2]}}
        got = run.case({**case, "history": history, "points": middle}, "--csv", run.folder / "column")
        point = got["points"][0]
        near(point["zz"], -force / area, 1e-10)
        near(point["uz"], -force / area * height / 2, 1e-10)
        near_all([point[key] for key in ("xx", "yy", "xy", "yz", "xz")], 0, 1e-10)
        near(run.columns("column_point_history.csv")["zz"][-1], point["zz"], 1e-12)
        near(got["peak_pressure"], force / area + moment * half / bend, 1e-10)
        table = run.columns("column_history.csv")
        near(abs(table["displacement P"][-1]), force * height / area, 1e-10)
        column = "displacement M" if "moment" in turning else "reaction M"
        near(abs(table[column][-1]), moment * height / bend if "moment" in turning else moment, 1e-10)
        row = next(row for row in got["reactions"] if row["kind"] == "guide")
        near(row["force_z"], -force, 1e-10)
        # Elements of the upper half turn by three quarters of the angle of the block, in the mean.
        angle = 0.75 * moment * height / bend
        assert (f"body block turns by {math.degrees(angle):.6g} degrees" in got.warned()) == (angle > 0.05), got.warned()
        near_all([row["imbalance"] for row in got["balance"]], 0, 1e-10)


def test_obstacles_with_one_surface_are_alike(run):
    """A cylinder in three ways: as such, as a height, and as the plane problem's circle. And a large sphere as a height."""
    radius, march = 8, {"history": ["P=0", "P=0.05", "Q=0.01"], "order": 1, "stepping": "fixed", "increments": 4}
    made = block("P pressure top 1; Q traction top 1 0 0", block=brick(([-1, 1], 8), ([0, 0.5], 1), ([0, 1], 4)), support="front:y back:y")
    made.update(march)
    shapes = {"cylinder": {"cylinder": {"point": [0, 3, -radius], "axis": [0, -2, 0], "radius": radius}},
              "height": {"height": f"sqrt({radius}^2-x^2)-{radius}"},
              "sphere": {"sphere": {"centre": [0, 0.2, -radius], "radius": radius}},
              "dome": {"height": f"sqrt({radius}^2-x^2-(y-0.2)^2)-{radius}"}}
    found = {name: run.case(with_(made, shape, *FLOOR, "obstacle")) for name, shape in shapes.items()}
    for one, other in (("cylinder", "height"), ("sphere", "dome")):
        near_relative(found[other]["peak_pressure"], found[one]["peak_pressure"], 1e-8)
        near_relative(found[other].interface("floor")["normal"], 0.05, 1e-12)
    assert found["cylinder"].interface("floor")["separation"] > 0
    run.write("block.mesh", rectangle(even(-1, 1, 8), even(0, 1, 4), lambda x, y: (x, y)))
    plane = run.case({"bodies": {"block": {"mesh": str(run.folder / "block.mesh"), "young": 1, "poisson": 0.3, "load": "P pressure 3 1; Q traction 3 1 0"}},
                      "interfaces": {"floor": {"between": "block:1", "friction": 0.3, "obstacle": {"circle": {"centre": [0, -radius], "radius": radius}}}}, **march})
    near_relative(found["cylinder"]["peak_pressure"], plane["peak_pressure"], 1e-6)


def test_a_bolt_to_the_ground_is_a_spring(run):
    """Two blocks, ν = 0, in uniform stress: in series they have the stiffness E A / H. Beside them the shank pulls the upper one
    down, and takes its share of a force F that lifts it."""
    area, height, shank, preload, lift = 2, 2, 0.3, 0.05, 0.01
    clamped = area / height

    def one(low, **keys):
        return {"block": brick(([0, 2], 2), ([0, 1], 2), ([low, low + 1], 2)), "young": 1, "poisson": 0, **keys}
    for key, tight in (("preload", preload), ("pretension", preload / (1 + shank / clamped))):
        got = run.case({"analysis": "space", "order": 1, "history": ["F=0", "bolt=1", "F=1"],
                        "bodies": {"upper": one(1, load=f"F traction top 0 0 {lift / area}"), "lower": one(0, support="bottom:xyz")},
                        "interfaces": {"face": {"between": ["upper:bottom", "lower:top"], "friction": 0.2}},
                        "bolts": {"bolt": {"between": "upper:top", "direction": [0, 0, 1], "stiffness": shank, key: preload}}})
        row = got["bolts"][0]
        near(row["all_tightened"], tight, 1e-12)
        near(row["force"], tight + lift * shank / (shank + clamped), 1e-12)
        near(got.interface("face")["normal"], row["force"] - lift, 1e-12)
        near(next(r for r in got["reactions"] if r["body"] == "lower")["force_z"], row["force"] - lift, 1e-12)
        near_all([r["imbalance"] for r in got["balance"]], 0, 1e-10)


def hertz(run, cells):
    """A quarter of the shipped case without friction, with so many cells across the contact: peak pressure, radius, its error."""
    case = shipped("sphere_on_block")
    body = case["bodies"]["block"]
    body["block"]["y"]["cells"][0], body["block"]["z"]["cells"][1] = cells, cells
    body["block"]["x"] = body["block"]["y"]
    body["support"].append("left:x")
    case["interfaces"]["ball"].update(friction=0, guide={"x": "held", "y": "held", "z": {"force": "P", "value": -1500}})
    case.update(history=["P=0", "P=1"])
    for key in ("cycle-start", "cycles"):
        case.pop(key)
    got = run.case(case)
    area = next(row for row in got["areas"] if row["state"] == "contact")
    near_relative(got.interface("ball")["normal"], 1500, 1e-9)
    return got["peak_pressure"], math.sqrt(4 * area["area"] / math.pi), area["area_error_estimate"] / area["area"]


def test_sphere_on_a_block_is_hertz(run):
    """Peak pressure and radius of contact are Hertz's on a half-space, to what halving the cells changes."""
    modulus, radius, force = 210e3 / (1 - 0.3**2), 50, 6000
    a = (0.75 * force * radius / modulus) ** (1 / 3)
    peak = 1.5 * force / (math.pi * a**2)
    coarse, fine = hertz(run, 6), hertz(run, 12)
    change = abs(fine[0] - coarse[0]) / peak
    assert change < 0.1
    # The block is ten radii wide and deep, which changes a by less than (1/10)³.
    near_relative(fine[0], peak, change + 2e-3)
    near_relative(fine[1], a, fine[2] / 2 + 1e-3)


def two_blocks(run, cells, others):
    """A quarter of two alike blocks with other cells on each side, and the gap of a sphere: peak pressure, radius, its error."""
    def one(fine, axis_z, **keys):
        wide = {"points": [0, 1.5, 10], "cells": [fine, 6], "growth": [1, 1.43]}
        return {"block": {"x": wide, "y": wide, "z": axis_z}, "young": 210e3, "poisson": 0.3, **keys}
    got = run.case({"analysis": "space", "order": 1, "history": ["P=0", "P=1"], "bodies": {
        "low": one(cells, {"points": [-10, -1.2, 0], "cells": [6, cells], "growth": [0.7, 1]}, support=["left:x", "front:y", "bottom:z"]),
        "high": one(others, {"points": [0, 1.2, 10], "cells": [others, 6], "growth": [1, 1.43]}, support=["left:x", "front:y"],
                    load="P pressure top 7.5")},
        "interfaces": {"face": {"between": ["low:top", "high:bottom"], "friction": 0, "gap": "(x*x+y*y)/100"}}})
    area = next(row for row in got["areas"] if row["state"] == "contact")
    near_relative(got.interface("face")["normal"], 750, 1e-9)
    near_all([row["imbalance"] for row in got["balance"]], 0, 1e-9)
    return got["peak_pressure"], math.sqrt(4 * area["area"] / math.pi), area["area_error_estimate"] / area["area"]


@pytest.mark.rest
def test_blocks_that_do_not_match_are_hertz(run):
    """Two blocks with other cells on each side: peak pressure and radius are Hertz's, to what halving the cells changes."""
    modulus, radius, force = 210e3 / (1 - 0.3**2) / 2, 50, 3000
    a = (0.75 * force * radius / modulus) ** (1 / 3)
    peak = 1.5 * force / (math.pi * a**2)
    coarse, fine = two_blocks(run, 6, 8), two_blocks(run, 12, 15)
    change = abs(fine[0] - coarse[0]) / peak
    assert change < 0.1
    near_relative(fine[0], peak, change + 2e-3)
    near_relative(fine[1], a, fine[2] / 2 + 1e-3)


@pytest.mark.parametrize("order", [1, 2])
def test_sides_that_do_not_match_pass_a_pressure(run, order):
    """A column of three blocks with other elements each: every area carries the pressure, in contact and at a tie."""
    def one(low, cells, elements, **keys):
        return {"block": brick(([0, 1], cells), ([0, 1], cells + 1), ([low, low + 1], 2), elements), "young": 1, "poisson": 0.0, **keys}
    case = {"analysis": "space", "order": order,
            "bodies": {"top": one(2, 2, "tetrahedra", load="P pressure top 0.03"), "middle": one(1, 3, "hexahedra"),
                       "foot": one(0, 2, "wedges", support="bottom:xyz")},
            "interfaces": {"face": {"between": ["top:bottom", "middle:top"], "friction": 0.5},
                           "glue": {"between": ["middle:bottom", "foot:top"], "tied": True}}}
    for slave in ("coarser", "finer", "first", "second"):
        case["interfaces"]["face"]["slave"] = slave
        got = run.case(case, "--csv", run.folder / "column", "--paraview", run.folder / "fields")
        near(got.interface("face")["force_z"], 0.03, 1e-12)
        near(got.interface("glue")["force_z"], 0.03, 1e-12)
        near_all(run.columns("column_nodes.csv")["p"], 0.03, 1e-11)
        near_all([row["imbalance"] for row in got["balance"]], 0, 1e-10)


@pytest.mark.rest
def test_two_bodies_with_the_gap_of_a_sphere_are_cattaneos_and_mindlins(run):
    """Two blocks of one material, halves of a model, with the initial gap of a sphere: pressed by P, then sheared by Q = f P / 2. The radius of
    contact is Hertz's a, that of stick a (1 - Q/fP)^(1/3), to the estimates of table `areas` and what the blocks, of ten radii, change."""
    young, poisson, radius, friction, force = 210e3, 0.3, 50, 0.3, 3000
    case = shipped("sphere_on_block")
    lower = case["bodies"].pop("block")
    upper = json.loads(json.dumps(lower))
    upper["block"]["z"] = {"points": [0, 1.2, 8, 10], "cells": [8, 5, 2], "growth": [1, 1.43, 1]}
    upper["guides"] = {"on": "top", "x": {"force": "Q", "value": friction * force}, "y": "held", "z": {"force": "P", "value": -force}}
    upper["support"] = "front[0<z<8]:y"
    case["bodies"] = {"upper": upper, "lower": lower}
    case["interfaces"] = {"ball": {"between": ["upper:bottom", "lower:top"], "friction": friction, "gap": f"(x^2+y^2)/{2 * radius}"}}
    case.update(history=["P=0", "P=1", "Q=0.5"], increments=20)
    for key in ("cycle-start", "cycles"):
        case.pop(key)
    got = run.case(case)
    modulus = young / (1 - poisson**2) / 2
    a = (0.75 * 2 * force * radius / modulus) ** (1 / 3)
    areas = {row["state"]: row for row in got["areas"]}
    contact, stick = (math.sqrt(2 * areas[name]["area"] / math.pi) for name in ("contact", "stick"))
    near_relative(contact, a, areas["contact"]["area_error_estimate"] / areas["contact"]["area"] / 2 + 1e-3)
    near_relative(stick, a * 0.5 ** (1 / 3), areas["stick"]["area_error_estimate"] / areas["stick"]["area"] / 2 + 1e-2)
    near_relative(abs(got.interface("ball")["force_x"]), friction * force / 2, 1e-9)


def test_what_no_node_can_carry_is_warned_of(run):
    """A side that reaches over 1e-6 of the next cells: their nodes have no row, and the area is said."""
    def one(x, z, cells, **keys):
        return {"block": brick((x, cells), ([0, 1], 2), (z, 1)), "young": 1, "poisson": 0, **keys}
    case = {"analysis": "space", "order": 1,
            "bodies": {"top": one([0.25 - 1e-6, 0.75], [0, 1], 3, load="P pressure top 0.001"), "foot": one([0, 1], [-1, 0], 4, support="bottom:xyz")},
            "interfaces": {"face": {"between": ["top:bottom", "foot:top"], "friction": 0.5, "slave": "second"}}}
    got = run.case(case)
    assert "(about an axis and in space: of its area) faces the other side" in got.warned()
    near_relative(got.interface("face")["force_z"], 0.001 * (0.5 + 1e-6), 1e-12)
    case["interfaces"]["face"]["slave"] = "first"
    assert run.case(case).warned() == ""


def test_the_shipped_sphere_slips_in_a_ring(run):
    case = shipped("sphere_on_block")
    case["bodies"]["block"]["block"]["x"]["cells"] = [3, 10, 3]
    case["bodies"]["block"]["block"]["y"]["cells"] = [5, 3]
    case["bodies"]["block"]["block"]["z"]["cells"] = [3, 4]
    got = run.case(case, "--csv", run.folder / "ball", "--save", run.folder / "ball.json", "--paraview", run.folder / "fields")
    row = got.interface("ball")
    near_relative(row["normal"], 3000, 1e-9)
    near_relative(abs(row["force_x"]), 600, 1e-9)
    assert row["stick"] > 0 and row["slip"] > 0 and row["separation"] > 0
    areas = {part["state"]: part["area"] for part in got["areas"]}
    near(areas["stick"] + areas["slip"], areas["contact"], 1e-12)
    # The steady cycle loses energy, which table interfaces has too.
    assert got["dissipation"][-1] > 0
    near_relative(row["dissipation"], got["dissipation"][-1], 1e-12)
    near_all([row["imbalance"] for row in got["balance"]], 0, 1e-9)
    assert {panel["name"] for panel in got["shown"]["panels"]} >= {"pressure", "shear", "slip", "interface_loops"}
    nodes = run.columns("ball_nodes.csv")
    assert {"x", "y", "z", "p", "q1", "q2", "slip1", "slip2"} <= set(nodes)
    assert max(nodes["p"]) == pytest.approx(got["peak_pressure"])
    assert "<Polys>" in run.text("fields/contact/contact_0.vtp") and (run.folder / "fields/block/block.pvd").exists()
    # The reduced file is a problem of the program march.
    again = run("march", "--reduced", run.folder / "ball.json", "--history", "P=0; P=1; Q=1")
    assert again["status"] == "converged"


def test_a_march_goes_on_from_a_state(run):
    case = {**block("P pressure top 1; Q traction top 0.2 0.1 0"), "history": ["P=0", "P=1", "Q=1", "Q=-1", "Q=1"], "cycle-start": 2, "cycles": 1}
    whole = run.case(case, "--save-state", run.folder / "whole")
    run.case({**case, "history": ["P=0", "P=1", "Q=1"], "cycle-start": -1}, "--save-state", run.folder / "part")
    rest = run.case(case, "--load-state", run.folder / "part", "--save-state", run.folder / "rest")
    assert run.text("rest") == run.text("whole")
    assert rest["total_dissipation"] == whole["total_dissipation"]


def test_a_state_of_other_gaps_or_friction_is_refused(run):
    case = {**block("P pressure top 1; Q traction top 0.2 0.1 0"), "history": ["P=0", "P=1", "Q=1"]}
    run.case({**case, "history": ["P=0", "P=1", "Q=0.8"]}, "--save-state", run.folder / "state")
    later = {**case, "history": ["P=0", "P=1", "Q=0.8", "Q=1"]}
    run.case(later, "--load-state", run.folder / "state")
    lower = with_(later, [0, 0, -0.001], *FLOOR, "obstacle", "plane", "point")
    assert "the gap has been changed" in run.refused(lower, "--load-state", run.folder / "state")
    assert "the friction has been changed to 0.05" in run.refused(with_(later, 0.05, *FLOOR, "friction"), "--load-state", run.folder / "state")


@pytest.mark.parametrize("elements", ["hexahedra", "tetrahedra"])
def test_meshes_of_solids(run, elements):
    """MFEM's format and both of Gmsh's give the same answer, with names of groups too."""
    made = solid((4, 2, 2), (2, 1, 1), elements)
    run.write("block.mesh", mfem_text(*made))
    run.write("two.msh", gmsh_text(*made, "2.2"))
    run.write("four.msh", gmsh_text(*made, "4.1"))
    values = []
    for name, low, high in (("block.mesh", 1, 6), ("two.msh", 1, "high"), ("four.msh", "low", 6)):
        case = block(f"P pressure {high} 1; Q traction {high} 0.2 0 0")
        case["bodies"]["block"].update(mesh=str(run.folder / name))
        del case["bodies"]["block"]["block"]
        case["interfaces"]["floor"]["between"] = f"block:{low}"
        case["history"] = ["P=0", "P=1", "Q=1"]
        values.append(run.case(case))
        near(values[-1].interface("floor")["normal"], 2, 1e-12)
        near(values[-1].interface("floor")["force_x"], -0.4, 1e-12)
    for value in values[1:]:
        near_relative(value["peak_pressure"], values[0]["peak_pressure"], 1e-10)
        near_relative(value["total_dissipation"], values[0]["total_dissipation"], 1e-8)
    if elements == "hexahedra":
        same = run.case({**block("P pressure top 1; Q traction top 0.2 0 0"), "history": ["P=0", "P=1", "Q=1"]})
        near_relative(same["peak_pressure"], values[0]["peak_pressure"], 1e-10)


EDGES = {8: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
         4: [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)], 6: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]}


def deck_text(nodes, solids, order):
    """Solids as an .inp, with a material, the surface HIGH of faces above and the node set LOW below."""
    nodes, middles, rows = [list(at) for at in nodes], {}, []
    for solid_ in solids:
        row = list(solid_)
        for a, b in EDGES[len(solid_)] if order == 2 else []:
            key = tuple(sorted((solid_[a], solid_[b])))
            if key not in middles:
                middles[key] = len(nodes)
                nodes.append([(x + y) / 2 for x, y in zip(nodes[key[0]], nodes[key[1]], strict=True)])
            row.append(middles[key])
        rows.append(row)
    top = max(at[2] for at in nodes)
    faces = {8: [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)], 4: [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)],
             6: [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]}[len(solids[0])]
    high = [f"{e}, S{side}" for e, row in enumerate(rows, 1) for side, face in enumerate(faces, 1) if all(abs(nodes[row[k]][2] - top) < 1e-9 for k in face)]
    lines = [f"{e}, " + ", ".join(str(n + 1) for n in row) for e, row in enumerate(rows, 1)]
    lines = [line if line.count(",") < 16 else ", ".join(line.split(", ")[:16]) + ",\n" + ", ".join(line.split(", ")[16:]) for line in lines]
    return "\n".join(["*NODE", *(f"{k}, " + ", ".join(map(repr, at)) for k, at in enumerate(nodes, 1)), f"*ELEMENT, TYPE=C3D{len(rows[0])}, ELSET=ALL", *lines,
                      "*NSET, NSET=LOW", *(str(k) for k, at in enumerate(nodes, 1) if at[2] == 0), "*SURFACE, NAME=HIGH, TYPE=ELEMENT", *high,
                      "*MATERIAL, NAME=SOFT", "*ELASTIC", "1, 0.3", "*SOLID SECTION, ELSET=ALL, MATERIAL=SOFT", ""])


def test_meshes_that_are_cut_or_curved_are_warned_of(run):
    """Two cells of a mesh with nodes of their own are not one body. Elements of order 1 cannot turn on a curved mesh without false forces."""
    nodes, solids, _ = solid((2, 1, 1), (2, 1, 1), "hexahedra")
    case = block()

    def warned(text, order):
        case["bodies"]["block"].update(mesh=run.write("body.inp", text))
        case["bodies"]["block"]["load"] = "P pressure HIGH 0.01"
        case["interfaces"]["floor"]["between"] = "block:LOW"
        return run.case({**case, "order": order}).warned()
    del case["bodies"]["block"]["block"]
    assert warned(deck_text(nodes, solids, 1), 1) == ""
    shared = [n for n in solids[1] if nodes[n][0] == 1]
    apart = [list(at) for at in nodes] + [list(nodes[n]) for n in shared]
    cut = [solids[0], [len(nodes) + shared.index(n) if n in shared else n for n in solids[1]]]
    said = warned(deck_text(apart, cut, 1), 1)
    assert "4 pairs of nodes coincide" in said and "(1, 0, 0)" in said, said
    straight = deck_text(nodes, solids, 2)
    assert warned(straight, 1) == ""
    # The middle of the edge above moves outwards.
    bent = straight.replace(", 0.5, 0.0, 1.0\n", ", 0.5, -0.1, 1.0\n")
    assert bent != straight
    assert "is curved, but elements of order 1" in warned(bent, 1)
    assert "curved" not in warned(bent, 2)


@pytest.mark.parametrize("elements, order", [(elements, order) for elements in ("hexahedra", "tetrahedra", "wedges") for order in (1, 2)])
def test_decks_of_solids(run, elements, order):
    """C3D4 to C3D20 with a surface of faces: under a pressure, and as the body of MFEM's elements of the same order (of hexahedra and wedges
    of order 2 the nodes in the middles of faces are added)."""
    cells, size = (4, 2, 2), (2, 1, 1)
    nodes, solids, _ = solid(cells, size, "tetrahedra" if elements == "tetrahedra" else "hexahedra")
    if elements == "wedges":
        solids = [[h[k] for k in half] for h in solids for half in ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7))]
    case = block("P pressure HIGH 1; Q traction HIGH 0.2 0 0")
    case["bodies"]["block"] = {"mesh": run.write("solid.inp", deck_text(nodes, solids, order)), "load": case["bodies"]["block"]["load"]}
    case["interfaces"]["floor"]["between"] = "block:LOW"
    case.update(order=order, history=["P=0", "P=1", "Q=1"], stepping="fixed", increments=2)
    got = run.case(case)
    near(got.interface("floor")["normal"], 2, 1e-12)
    near(got.interface("floor")["force_x"], -0.4, 1e-12)
    same = {**block("P pressure top 1; Q traction top 0.2 0 0"), **{key: case[key] for key in ("order", "history", "stepping", "increments")}}
    same["bodies"]["block"]["block"]["elements"] = elements
    if elements == "hexahedra":
        near_relative(got["peak_pressure"], run.case(same)["peak_pressure"], 1e-10)
    # Temperature: a body that is free to expand beside the pressure takes strain without stress.
    hot = {**case, "history": ["P=0", "P=1 H=1"], "points": {"corner": [1.9, 0.9, 0.8]},
           "interfaces": {"floor": {**case["interfaces"]["floor"], "friction": 0}},
           "bodies": {"block": {"mesh": case["bodies"]["block"]["mesh"], "expansion": 1e-3, "load": "P pressure HIGH 1; H temperature 50",
                                "support": "@0,0,1:xy @2,0,1:y"}}}
    point = run.case(hot)["points"][0]
    near_all([point["ux"] - 0.35 * 1.9, point["uy"] - 0.35 * 0.9, point["uz"] + 0.95 * 0.8, point["zz"] + 1, point["von_mises"] - 1], 0, 1e-10)


def test_stacks_ties_and_moving_planes(run):
    """Two blocks, of which the lower is tied to a third one, are pressed by a plane that comes down: its reaction is the force."""
    def one(low, **keys):
        return {"block": brick(([0, 1], 2), ([0, 1], 2), ([low, low + 1], 2)), "young": 1, "poisson": 0.0, **keys}
    got = run.case({"analysis": "space", "order": 2, "bodies": {"top": one(2), "middle": one(1), "foot": one(0, support="bottom:xyz")},
                    "interfaces": {"lid": {"between": "top:top", "friction": 0.2, "motion": {"D": {"z": -0.03}},
                                           "obstacle": {"plane": {"point": [0, 0, 3], "normal": [0, 0, -1]}}},
                                   "face": {"between": ["top:bottom", "middle:top"], "friction": 0.5},
                                   "glue": {"between": ["middle:bottom", "foot:top"], "tied": True}}})
    for name, sign in (("lid", -1), ("face", 1), ("glue", 1)):
        near(got.interface(name)["force_z"], sign * 0.01, 1e-12)
    assert got.interface("glue")["tied"]
    foot = next(row for row in got["reactions"] if row["body"] == "foot")
    near(foot["force_z"], 0.01, 1e-12)


def test_ties_alone_are_linear(run):
    """Two blocks of ν = 0 that are only tied, with other cells each: a column under a pressure, whose force moves its end by P H/E."""
    def one(low, cells, **keys):
        return {"block": brick(([0, 1], cells), ([0, 1], cells), ([low, low + 1], 2)), "young": 1, "poisson": 0, **keys}
    got = run.case({"analysis": "space", "order": 1, "history": ["P=0", "P=1"], "points": {"end": {"body": "top", "at": [0.3, 0.6, 2]}},
                    "bodies": {"top": one(1, 2, load="P pressure top 0.01"), "foot": one(0, 3, support="bottom:xyz")},
                    "interfaces": {"glue": {"between": ["top:bottom", "foot:top"], "tied": True}}}, "--csv", run.folder / "tied")
    assert got["status"] == "converged" and "all interfaces are tied" in got.output
    near(got.interface("glue")["force_z"], 0.01, 1e-12)
    near(got["points"][0]["uz"], -0.02, 1e-12)
    near(got["points"][0]["zz"], -0.01, 1e-12)
    near_all([row["imbalance"] for row in got["balance"]], 0, 1e-10)


def on_two(seam, cells, order, slave=None, reach=0, elements="hexahedra", poisson=0.0):
    """A block of 10 × 6 on two blocks that meet at x = `seam`, pressed by 10."""
    def one(x, z, n, **keys):
        return {"block": brick((x, n), ([0, 6], 2), (z, 1), elements), "young": 1000, "poisson": poisson, **keys}
    made = {"analysis": "space", "order": order, "history": ["P=0", "P=1"],
            "bodies": {"up": one([0, 10], [0, 4], cells[0], load="P traction top 0 0 -10", support="left:x front:y"),
                       "l1": one([-reach, seam], [-3, 0], cells[1], support="bottom:xyz left:x front:y"),
                       "l2": one([seam, 10 + reach], [-3, 0], cells[2], support="bottom:xyz front:y")},
            "interfaces": {name: {"between": ["up:bottom", low + ":top"], "friction": 0.2} for name, low in (("a", "l1"), ("b", "l2"))}}
    for face in made["interfaces"].values():
        if slave:
            face["slave"] = slave
    return made


@pytest.mark.parametrize("order, elements", [(1, "hexahedra"), (2, "hexahedra"), (2, "tetrahedra"), (2, "wedges")])
def test_a_seam_within_faces_passes_a_pressure(run, order, elements):
    """Two interfaces meet within faces of the slave: under a pressure of 10 each of them bears 10 times its own area."""
    for seam, cells in ((4.3, (1, 2, 3)), (5, (1, 1, 2)), (3.1, (2, 3, 2)), (6.9, (3, 1, 2))):
        got = run.case(on_two(seam, cells, order, "first", elements=elements), "--csv", run.folder / "seam")
        near_relative(got.interface("a")["normal"], 60 * seam, 1e-9)
        near_relative(got.interface("b")["normal"], 60 * (10 - seam), 1e-9)
        table = run.columns("seam_nodes.csv")
        near_all([p for p, time in zip(table["p"], table["time"], strict=True) if time == 1], 10, 1e-8)


def test_a_seam_within_faces_takes_the_other_side(run):
    """The blocks below reach further than the one above, so that neither side lies within the other: the default puts the nodes of one
    interface at least on the side whose faces no seam cuts, and forces are those of the side that none cuts in both, to 1 %."""
    def case(slave=None):
        made = on_two(4.3, (1, 3, 3), 2, slave, reach=2)
        made["bodies"]["up"].pop("support")
        for low in ("l1", "l2"):
            made["bodies"][low]["support"] = "bottom:xyz"
        return made
    default, below = run.case(case()), run.case(case("second"))
    for name in "ab":
        near_relative(default.interface(name)["normal"], below.interface(name)["normal"], 0.01)
    # The nodes at x = 5 and y of the upper block belong to the first interface.
    said = run.case(case("first")).warned()
    assert "interface 'b': nodes of body up with up to" in said and "interface 'a': nodes" not in said, said
    assert default.warned() == below.warned() == ""


def test_a_side_without_free_nodes_is_not_taken(run):
    """Three blocks below meet within the only face of the block above, whose four nodes two of them have: the third one has nodes of its own."""
    def one(x, y, z, n, **keys):
        return {"block": brick((x, n), (y, n), (z, 1)), "young": 1000, "poisson": 0.0, **keys}
    case = {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
            "bodies": {"up": one([0, 10], [0, 6], [0, 4], 1, load="P traction top 0 0 -10"),
                       **{name: one(x, y, [-3, 0], n, support="bottom:xyz") for name, x, y, n in
                          (("l1", [-2, 6.9], [0, 6], 2), ("l2", [6.9, 12], [0, 2.12], 1), ("l3", [6.9, 12], [2.12, 6], 1))}},
            "interfaces": {name: {"between": ["up:bottom", low + ":top"], "friction": 0.2} for name, low in (("a", "l1"), ("b", "l2"), ("c", "l3"))}}
    got = run.case(case)
    near(sum(got.interface(name)["normal"] for name in "abc"), 600, 1e-9)
    near_all([row["imbalance"] for row in got["balance"]], 0, 1e-9)
    for face in case["interfaces"].values():
        face["slave"] = "first"
    assert "is free of other interfaces: make the other side the slave" in run.refused(case)


def test_a_tie_over_a_distance_is_warned_of(run):
    """Blocks are tied over a gap: a shear of 8 over a distance of 0.5 leaves a moment of 4, which is said. Tied sides must not overlap by
    more than sides that touch."""
    def one(x, low, cells, **keys):
        return {"block": brick(([0, x], cells), ([0, 8], cells), ([low, low + 4], 1)), "young": 1000, "poisson": 0.3, **keys}
    def case(away, cells=3):
        return {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
                "bodies": {"u": one(10, away, 2, load="P traction top 0.1 0 -1"), "l": one(10, -4, cells, support="bottom:xyz"),
                           "s": one(10, away + 4, 2, support="top:xyz")},
                "interfaces": {"t": {"between": ["u:bottom", "l:top"], "tied": True},
                               "c": {"between": ["s:bottom", "u:top"], "friction": 0.1}}}
    for cells in (3, 2):
        got = run.case(case(0.5, cells))
        assert "interface 't': its sides are tied although they are apart by up to 0.5, at" in got.warned(), got.warned()
        row = got.interface("t")
        near_relative(row["moment_defect"], 0.5 * abs(row["tangential"]), 1e-9)
        assert row["tangential"] > 1
        got = run.case(case(0, cells))
        assert "tied although" not in got.warned()
        near(got.interface("t")["moment_defect"], 0, 1e-9)
    assert "the sides overlap by 1 at" in run.refused(case(-1)) and "sides that are tied must touch" in run.refused(case(-1))


@pytest.mark.parametrize("order, elements", [(1, "hexahedra"), (1, "wedges"), (2, "tetrahedra")])
def test_a_tie_between_seams_is_not_apart(run, order, elements):
    """A block lies on four others whose seams run within its faces; two of these are tied. All sides are in one plane, so that no tie is
    apart, although its nodes lie beside the side opposite. Where the tied blocks are lower by 0.1, ties are apart by this length."""
    def case(low):
        def one(x, y, z, cells, **keys):
            return {"block": brick((x, cells), (y, cells), (z, 1), elements), "young": 1000, "poisson": 0, **keys}
        made = {"analysis": "space", "order": order, "history": ["P=0", "P=1"], "interfaces": {},
                "bodies": {"up": one([0, 4], [0, 3], [0, 1], 3, load="P traction top 0.1 0 -2")}}
        for k, (x, y) in enumerate((x, y) for y in ([0, 1.38], [1.38, 3]) for x in ([0, 2.56], [2.56, 4])):
            tied = k in (0, 3)
            made["bodies"][f"l{k}"] = one(x, y, [-1, -low if tied else 0], 2 + k % 2, support="bottom:xyz")
            made["interfaces"][f"c{k}"] = {"between": ["up:bottom", f"l{k}:top"], "slave": "first", **({"tied": True} if tied else {"friction": 0.5})}
        return made
    assert "tied although" not in run.case(case(0)).warned()
    apart = run.case(case(0.1)).warned()
    for name in ("c0", "c3"):
        assert f"interface '{name}': its sides are tied although they are apart by up to 0.1, at" in apart, apart


def test_bodies_that_overlap_below_a_side_are_said(run):
    """Two blocks below one overlap each other between x = 1 and 2: 2 of the area of the upper one, which is 8, faces both of them, with
    either slave. Blocks that meet at a seam within faces face no place twice."""
    def case(low, slave=None):
        def one(x, y, z, cells, **keys):
            return {"block": brick((x, cells), (y, 3), (z, 1)), "young": 1000, "poisson": 0.3, **keys}
        face = {"friction": 0.3, **({"slave": slave} if slave else {})}
        return {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
                "bodies": {"up": one([0, 4], [0, 2], [0, 1], 5, load="P pressure top 2"),
                           "l1": one([-1, 2], [-0.5, 2.5], [-1, 0], 4, support="bottom:xyz"),
                           "l2": one([low, 5], [-0.5, 2.5], [-1, 0], 5, support="bottom:xyz")},
                "interfaces": {"a": {"between": ["up:bottom", "l1:top"], **face}, "b": {"between": ["up:bottom", "l2:top"], **face}}}
    for slave in (None, "first", "second"):
        said = run.case(case(1, slave)).warned()
        told = re.search(r"interfaces 'a' and 'b': about ([0-9.]+) of the area of body up faces the other sides of both", said)
        # Each of the three faces along y and two along x is taken in 128 parts.
        assert told and abs(float(told[1]) - 2) < 0.2, said
        assert "faces the other sides of both" not in run.case(case(2, slave)).warned()


@pytest.mark.parametrize("slave", ["first", "second", None])
def test_faces_behind_others_do_not_count(run, slave):
    """A block stands on an arm over a slot. The slot's floor looks the same way: if it is named with the arm's top, all is as without it."""
    nodes, solids, _ = solid((4, 2, 3), (4, 2, 3), "hexahedra")
    arm = [s for s in solids if not all(nodes[v][0] >= 1 and 1 <= nodes[v][2] <= 2 for v in s)]
    quads = [[h[a] for a in q] for h in arm for q in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
    alone = [q for k, q in enumerate(quads) if sum(set(q) == set(other) for other in quads) == 1]
    def side(q):
        low, high = min(nodes[v][2] for v in q), max(nodes[v][2] for v in q)
        return {0: 1, 1: 8, 3: 6}.get(low, 2) if low == high else 2
    mesh = run.write("arm.mesh", mfem_text(nodes, arm, [(side(q), q) for q in alone]))
    def case(sides):
        return {"analysis": "space", "order": 1, "history": ["P=0", "P=1", "Q=1"],
                "bodies": {"up": {"block": brick(([0.5, 3.7], 5), ([0.2, 1.7], 2), ([3, 4], 2)), "young": 1000, "poisson": 0.3,
                                  "load": "P pressure top 2; Q traction top 0.3 0 0"},
                           "lo": {"mesh": mesh, "young": 1000, "poisson": 0.3, "support": "1:xyz"}},
                "interfaces": {"c": {"between": ["up:bottom", f"lo:{sides}"], "friction": 0.4, **({"slave": slave} if slave else {})}}}
    top, both = run.case(case("6")), run.case(case("6,8"))
    for key in ("normal", "tangential", "moment_x", "moment_y", "stick", "slip", "separation", "about_x", "about_z"):
        near(both.interface("c")[key] - top.interface("c")[key], 0, 1e-8)
    near_relative(both["peak_pressure"], top["peak_pressure"], 1e-9)


def test_moments_are_about_the_middle_beside_a_tie(run):
    """Half of a side is tied, and the tie has the nodes at the edge that both halves share. Each half bears a pressure of 2 on 2 × 2, with
    no moment about its middle."""
    def one(z, cells, **keys):
        return {"block": brick(([0, 4], cells), ([0, 2], 2), (z, 2)), "young": 1000, "poisson": 0, **keys}
    halves = {"t": "[0<x<2]", "c": "[2<x<4]"}
    for order in (1, 2):
        got = run.case({"analysis": "space", "order": order, "history": ["P=0", "P=1"],
                        "bodies": {"up": one([0, 1], 2, load="P pressure top 2"), "lo": one([-1, 0], 6, support="bottom:xyz")},
                        "interfaces": {name: {"between": ["up:bottom" + part, "lo:top" + part], "slave": "first",
                                              **({"tied": True} if name == "t" else {"friction": 0.2})} for name, part in halves.items()}})
        for name, x in (("t", 1), ("c", 3)):
            row = got.interface(name)
            near_all([row["about_x"] - x, row["about_y"] - 1, row["about_z"], row["force_z"] - 8], 0, 1e-9)
            near_all([row["moment_x"], row["moment_y"], row["moment_z"]], 0, 1e-9)


def test_moments_of_interfaces_and_supports(run):
    """A block that is pushed at its top stands on another one: N acts where statics say, beside the middle, so that the moment about it is
    the shear times the height. The support below takes it with the height of the lower block, and each row says its place."""
    def one(low, high, cells, **keys):
        return {"block": brick(([0, 4], cells), ([0, 2], 2), ([low, high], 2)), "young": 1000, "poisson": 0.3, **keys}
    for cells in (4, 3):
        got = run.case({"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
                        "bodies": {"u": one(0, 1, 4, load="P traction top 0.2 0 -1"), "l": one(-3, 0, cells, support="bottom:xyz")},
                        "interfaces": {"f": {"between": ["u:bottom", "l:top"], "friction": 0.5}}})
        row = got.interface("f")
        near(row["normal"], 8, 1e-10)
        near(row["force_x"], -1.6, 1e-10)
        # On the upper block the load has the moment 1.6 about y, and the contact the opposite one.
        near_all([row["moment_x"], row["moment_z"], row["moment_y"] + 1.6], 0, 1e-9)
        near_all([row["about_x"] - 2, row["about_y"] - 1, row["about_z"], row["moment_defect"]], 0, 1e-9)
        support = next(r for r in got["reactions"] if r["body"] == "l")
        near_all([support["force_x"] + 1.6, support["force_z"] - 8, support["moment_y"] + 1.6 * 4, support["moment_x"], support["moment_z"]], 0, 1e-9)
        near_all([support["about_x"] - 2, support["about_y"] - 1, support["about_z"] + 3], 0, 1e-9)


def test_nodes_name_their_interface_and_area(run):
    """Two feet on a plane: p times area of the nodes of an interface is its force."""
    case = block("P traction top 0.1 0 -1")
    floor = case["interfaces"].pop("floor")
    for name, part in (("left", "bottom[0<x<0.5]"), ("right", "bottom[1.5<x<2]")):
        case["interfaces"][name] = {**floor, "between": "block:" + part}
    got = run.case(case, "--csv", run.folder / "feet")
    nodes = run.columns("feet_nodes.csv")
    forces = []
    for name in ("left", "right"):
        rows = [k for k, one in enumerate(nodes["interface"]) if one == name and nodes["time"][k] == nodes["time"][-1]]
        assert len(rows) == got.interface(name)["nodes"] > 0
        forces.append(sum(nodes["p"][k] * nodes["area"][k] for k in rows))
        near(forces[-1], got.interface(name)["normal"], 1e-12)
    near(sum(forces), 2, 1e-12)
    assert forces[1] > forces[0] + 0.01


def test_an_interference_is_allowed_by_its_key(run):
    """A block overlaps a plane by 0.1 of its edge of 0.5 and more: ν = 0, so that the pressure is E times overlap over height."""
    case = block("P pressure top 1e-9", 0, poisson=0, support="top:xyz")
    case["interfaces"]["floor"]["obstacle"]["plane"]["point"] = [0, 0, 0.1]
    error = run.refused(case)
    assert "overlap by 0.1" in error and "(0.1 of the distance of nodes)" in error and "key 'overlap'" in error, error
    case["interfaces"]["floor"]["overlap"] = 0.3
    near(run.case(case)["peak_pressure"], 0.1, 1e-12)


def test_contact_that_is_cut_off_is_warned_of(run):
    """A part of a side bears up to its rim although the block and the plane go on beyond it; so it does under a smaller part of another
    block. Where one of both ends in a corner, a contact may end."""
    cut = "contact is compressed up to the rim of its surface"
    case = block("P traction top 0.01 0 -1")
    assert cut not in run.case(case).warned()
    case["interfaces"]["floor"]["between"] = "block:bottom[0<x<1.5]"
    assert cut in run.case(case).warned()

    def one(x, low, cells, **keys):
        return {"block": brick((x, cells), ([0, 1], 2), ([low, low + 1], 1)), "young": 1, "poisson": 0.3, **keys}
    for cells in (4, 3):
        both = {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
                "bodies": {"u": one([0, 1], 0, 2, load="P pressure top 0.1"), "l": one([-1, 2], -1, 3 * cells // 2, support="bottom:xyz")},
                "interfaces": {"f": {"between": ["u:bottom", "l:top"], "friction": 0.3}}}
        assert cut not in run.case(both).warned(), cells
    both["bodies"]["l"] = one([-1, 2], -1, 6, support="bottom:xyz")
    both["interfaces"]["f"]["between"] = ["u:bottom", "l:top[0<x<1]"]
    assert cut not in run.case(both).warned()
    both["bodies"]["u"] = one([0, 1], 0, 4, load="P pressure top 0.1")
    both["interfaces"]["f"]["between"] = ["u:bottom[0.25<x<1]", "l:top[0<x<1]"]
    assert cut in run.case(both).warned()
    both["interfaces"]["f"]["between"] = ["u:bottom", "l:top[0<x<0.5]"]
    assert cut in run.case(both).warned()


def test_a_side_around_a_corner_is_warned_of(run):
    """On a plane the edge of a chamfer of 45 degrees bears with a normal of 22 degrees, that of one of 11 degrees with 6. In a bore a block
    stands on its edges, of which one belongs to two sides of a contact."""
    nodes, solids, faces = solid((4, 2, 1), (2, 1, 2), "hexahedra")
    for slope, words in ((1, "degrees off that of the plane"), (0.2, "")):
        slanted = [[x, y, slope * (x - 1) if z == 0 and x > 1 else z] for x, y, z in nodes]
        case = block("P pressure 6 0.01")
        case["bodies"]["block"]["mesh"] = run.write("chamfer.mesh", mfem_text(slanted, solids, faces))
        del case["bodies"]["block"]["block"]
        case["interfaces"]["floor"]["between"] = "block:1"
        said = run.case(case).warned()
        assert words in said and ("off that" in said) == (words != ""), said
    case = block("P traction top 0 0 -0.001", support="front:y")
    case["interfaces"]["floor"]["obstacle"] = {"cylinder": {"point": [1, 0, 0.5], "axis": [0, 1, 0], "radius": -1.12}}
    assert "turns by" not in run.case(case).warned()
    case["interfaces"]["floor"]["between"] = "block:bottom,left"
    assert "its side turns by 90 degrees at (0, " in run.case(case).warned()


def test_a_ball_may_be_smaller_than_the_side(run):
    """A ball of radius 3 on a block of 10 × 10: nodes beside it are open, and its force is carried. A rectangle of the side alone, by
    intervals along two axes, has the same pressures."""
    case = {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
            "bodies": {"b": {"block": brick(([-5, 5], 10), ([-5, 5], 10), ([0, 4], 3)), "young": 1000, "poisson": 0.3, "support": "top:xyz"}},
            "interfaces": {"f": {"between": "b:bottom", "friction": 0, "obstacle": {"sphere": {"centre": [0, 0, -3], "radius": 3}},
                                 "guide": {"x": "held", "y": "held", "z": {"force": "P", "value": 30}}}}}
    whole = run.case(case)
    near_relative(whole.interface("f")["normal"], 30, 1e-10)
    assert whole.interface("f")["separation"] > 90
    case["interfaces"]["f"]["between"] = "b:bottom[-2<x<2,-1<y<2]"
    part = run.case(case)
    near_relative(part["peak_pressure"], whole["peak_pressure"], 1e-9)
    areas = part.interface("f")
    near(areas["stick"] + areas["slip"] + areas["separation"], 12, 1e-9)
    case["bodies"]["b"].update(load="Q pressure bottom[2<x<4,-1<y<2] 1", support="top:xyz bottom[-5<x<-4,0<y<5]:z")
    loads = run.case({**case, "history": ["P=0", "P=1", "Q=1"]})["load_sizes"]
    near_relative(next(row for row in loads if row["load"] == "Q")["size"], 6, 1e-9)
    case["interfaces"]["f"]["obstacle"]["sphere"]["centre"] = [20, 0, -3]
    assert "no node of the side faces the sphere" in run.refused(case)


def test_check_shows_the_input(run):
    """--check lists bodies, sides and loads of a case in space, and computes nothing."""
    case = on_two(4.3, (2, 2, 3), 1)
    case["units"] = {"length": "mm", "force": "N"}
    del case["bodies"]["up"]["support"]
    got = run.case(case, "--check")
    assert got["status"] == "checked" and "interfaces" not in got.results
    up, low, _ = got["bodies"]
    assert (up["elements"], up["dofs"], up["free_motions"], up["held_x"]) == (4, 54, 6, 0)
    assert (low["free_motions"], low["held_z"], low["z_from"], low["x_to"]) == (0, 9, -3, 4.3)
    a, b = got["sides"]
    assert a["meet"] == b["meet"] == "the mortar" and {a["nodes_on"], a["opposite"]} == {"up", "l1"}
    near_all([a["area"] - 25.8, b["area"] - 34.2, a["least_gap"], b["most_gap"]], 0, 1e-10)
    load = got["loads"][0]
    near_all([load["x"], load["y"], load["z"] + 600, load["moment_x"] + 1800, load["moment_y"] - 3000, load["moment_z"]], 0, 1e-9)
    assert "gap from [mm]" in got.output and "[N]" in got.output


def test_a_body_that_tips_is_not_said_to_be_pulled(run):
    """The load presses, but its resultant passes beside the foot on which the block stands."""
    case = block("P traction top[1.5<x<2] 0 0 -1")
    case["interfaces"]["floor"]["between"] = "block:bottom[0<x<1]"
    got = run.case(case, code=2)
    assert "load 'P' presses, but the bodies do not come to rest" in got["message"] and "tips" in got["message"], got["message"]


def test_a_balance_without_forces_is_none(run):
    """A block that expands freely on another one has forces of round-off only, which are not said to be out of balance."""
    def one(low, high, half, **keys):
        return {"block": brick(([-half, half], 4), ([-half, half], 4), ([low, high], 2)), "young": 1000, "poisson": 0.3, **keys}
    case = {"analysis": "space", "order": 1, "history": ["H=0", "H=1"],
            "bodies": {"b": one(0, 4, 5, load="H temperature 50", expansion=1e-5), "l": one(-4, 0, 6, support="bottom:xyz")},
            "interfaces": {"f": {"between": ["b:bottom", "l:top"], "friction": 0.3}}}
    got = run.case(case)
    near_all([row["imbalance"] for row in got["balance"]], 0, 1e-6)
    assert "Each body is in balance to" in run.case(block()).output


def test_chords_of_a_press_fit_are_warned_of(run):
    """Two quarter rings, of which one is larger by an interference and has other elements: at order 1 the chords change the pressures."""
    def ring(name, low, high, around):
        nodes, solids, faces = solid((2, around, 1), (2, around, 1), "hexahedra")
        placed = []
        for i, j, k in nodes:
            r, angle = low + (high - low) * i / 2, math.pi / 2 * j / around
            placed.append([r * math.cos(angle), r * math.sin(angle), k])
        named = []
        for _, face in faces:
            at = [nodes[v] for v in face]
            side = next(side for side, c, value in ((1, 0, 0), (2, 0, 2), (3, 1, 0), (4, 1, around), (5, 2, 0), (6, 2, 1)) if all(x[c] == value for x in at))
            named.append((side, face))
        return run.write(name, mfem_text(placed, solids, named))
    held = "3:y 4:x 5:z 6:z"
    case = {"analysis": "space", "order": 1, "history": ["P=0", "P=1"],
            "bodies": {"shaft": {"mesh": ring("shaft.mesh", 3, 5, 8), "young": 1000, "poisson": 0.3, "support": held, "load": "P pressure 1 1e-6"},
                       "hub": {"mesh": ring("hub.mesh", 4.99, 8, 6), "young": 1000, "poisson": 0.3, "support": held}},
            "interfaces": {"fit": {"between": ["shaft:2", "hub:1"], "slave": "first", "overlap": 0.3}}}
    said = run.case(case)
    assert "its elements are chords of curves" in said.warned() and "nodes that match" in said.warned(), said.warned()
    assert said["chords_node_pressure_change_estimate"] > 0.05
    # A given gap leaves nothing open.
    case["interfaces"]["fit"]["gap"] = -0.01
    meant = run.case(case)
    assert "chords" not in meant.warned() and "chords_node_pressure_change_estimate" not in meant.results
    del case["interfaces"]["fit"]["gap"]
    # Elements of order 2 on a mesh with straight edges have chords of the same height.
    case["order"] = 2
    case["bodies"]["hub"]["mesh"] = ring("hub.mesh", 4.99, 8, 7)
    assert "its elements are chords of curves" in run.case(case).warned()
    for order in (1, 2):
        case["order"] = order
        case["bodies"]["hub"]["mesh"] = ring("hub.mesh", 4.99, 8, 8)
        assert "chords" not in run.case(case).warned()


def test_large_slip_is_warned_of(run):
    """An obstacle moves by two cells below a block. Its shape is a height, which need not be the same everywhere."""
    case = block("P pressure top 0.01", 0.1, support="top:xy")
    case["interfaces"]["floor"].update(obstacle={"height": "0*x"}, motion={"D": {"x": 1}})
    case["history"] = ["P=0", "P=1", "D=1"]
    said = run.case(case).warned()
    assert "interface 'floor': a node slips by " in said and "of its distance from the next" in said, said
    case["interfaces"]["floor"]["obstacle"] = {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}
    assert "slips" not in run.case(case).warned()


def without(case, *path):
    changed = json.loads(json.dumps(case))
    within = changed
    for key in path[:-1]:
        within = within[key]
    del within[path[-1]]
    return changed


def with_(case, value, *path):
    changed = json.loads(json.dumps(case))
    within = changed
    for key in path[:-1]:
        within = within[key]
    within[path[-1]] = value
    return changed


BODY, FLOOR = ("bodies", "block"), ("interfaces", "floor")


@pytest.mark.parametrize("value, path, words", [
    ([{"on": "top", "rotation": "free"}], (*BODY, "guides"), ["guides.0", "unknown key 'rotation'", "rotation-z"]),
    ([{"on": "top", "z": "held", "centre": [0, 0]}], (*BODY, "guides"), ["guides.0.centre", "three numbers"]),
    ([{"on": "lid", "z": "held"}], (*BODY, "guides"), ["guides.0.on", "lid", "top"]),
    ([{"on": "top", "z": "held"}, {"on": "top", "x": "held"}], (*BODY, "guides"), ["guides.1.on", "guided already"]),
    ("block.mtx", (*BODY, "matrix"), ["matrix", "not for bodies in space"]),
    (2, (*BODY, "thickness"), ["thickness", "not for bodies in space"]),
    (3, (*BODY, "order"), ["order", "must be 1 or 2"]),
    ("x.mesh", (*BODY, "mesh"), ["both", "mesh and block"]),
    ([0, 0], (*BODY, "block", "x", "points"), ["follows 0", "must increase"]),
    ([1, 2], (*BODY, "block", "x", "cells"), ["2 points", "2 numbers of cells"]),
    ("cubes", (*BODY, "block", "elements"), ["cubes", "wedges"]),
    ("lid:xyz", (*BODY, "support"), ["lid", "bottom"]),
    ("top:xt", (*BODY, "support"), ["xt", "x, y and z"]),
    ("bottom", (*BODY, "support"), ["@x,y,z:components"]),
    ("P traction top 1 0", (*BODY, "load"), ["has 5 words", "tx ty tz"]),
    ("P displacement-r top 1", (*BODY, "load"), ["displacement-r", "displacement-z"]),
    ("P pressure top[0<x<0.7] 1", (*BODY, "load"), ["cuts a face", "must end where faces end"]),
    ({"line": [[0, 0], [1, 0]]}, (*FLOOR, "obstacle"), ["unknown key 'line'", "plane"]),
    ({"cylinder": {"point": [0, 0, -1], "axis": [0, 0, 0], "radius": 1}}, (*FLOOR, "obstacle"), ["cylinder.axis", "must have a length"]),
    ({"cylinder": {"point": [0, 0, -1], "axis": [0, 1, 0], "radius": 0}}, (*FLOOR, "obstacle"), ["cylinder.radius", "must be positive"]),
    ({"height": "x+z"}, (*FLOOR, "obstacle"), ["obstacle.height", "z"]),
    ({"height": "sqrt(1-x)"}, (*FLOOR, "obstacle"), ["obstacle", "height", "not a finite number"]),
    (0.5, (*BODY, "poisson"), ["below 0.5 in plane strain and in space"]),
    ("P pressure top[0<x<1,0<t<1] 1", (*BODY, "load"), ["top[0<x<1,0<t<1]", "interval"]),
    ({"sphere": {"centre": [0, 0, -1], "radius": 0}}, (*FLOOR, "obstacle"), ["radius", "must be positive"]),
    ({"plane": {"point": [0, 0, 0.5], "normal": [0, 0, 1]}}, (*FLOOR, "obstacle"), ["overlap by 0.5", "obstacle"]),
    ([[1, 0.3]], (*FLOOR, "strength"), ["strength", "not for bodies in space"]),
    (0.1, (*FLOOR, "pairing"), ["pairing", "not for bodies in space"]),
    ("larger", (*FLOOR, "slave"), ["larger", "is not one of", "coarser", "second"]),
    ([[0, 0.3], [1, 0.4]], (*FLOOR, "friction"), ["function of the place"]),
    ("x-1", (*FLOOR, "friction"), ["friction", "is -1", "not negative"]),
    ({"D": {"angle": 1}}, (*FLOOR, "motion"), ["angle", "not for bodies in space"]),
    ({"z": {"force": "F"}, "rotation": "free"}, (*FLOOR, "guide"), ["rotation", "not for bodies in space"]),
    ({"tip": [0, 0]}, ("points",), ["points.tip", "three numbers"]),
    ({"tip": [0, 0, 3]}, ("points",), ["points.tip", "(0, 0, 3) is in no body"]),
    ({"b": {"between": "block:top", "stiffness": 1, "preload": 1}}, ("bolts",), ["b", "bolted to the ground", "direction"]),
    ({"b": {"between": "block:top", "stiffness": 1, "preload": 1, "direction": [0, 1]}}, ("bolts",), ["direction", "three numbers"]),
    ({"b": {"between": "block:top", "stiffness": 1, "preload": 1, "direction": [0, 0, 0]}}, ("bolts",), ["direction is (0, 0, 0)", "must have a length"]),
    ({"b": {"between": "block:lid", "stiffness": 1, "preload": 1, "direction": [0, 0, 1]}}, ("bolts",), ["bolts.b.between", "lid", "top"]),
    ({"P": {"between": "block:top", "stiffness": 1, "preload": 1, "direction": [0, 0, 1]}}, ("bolts",), ["load 'P'", "name of a bolt"]),
    (2, ("thickness",), ["thickness", "not for bodies in space"]),
    (5, ("order",), ["order", "must be 1 or 2"]),
    ([1, 2], ("edges",), ["edges", "leave it out"]),
    ("plane strain", ("analysis",), ["block", "must be space"]),
])
def test_mistakes_are_named(run, value, path, words):
    error = run.refused(with_(block(), value, *path))
    for word in words:
        assert word in error, error


def test_more_mistakes(run):
    assert "no obstacle" in run.refused(without(block(), *FLOOR, "obstacle"))
    nodes, solids, faces = solid((1, 1, 1), (1, 1, 1), "hexahedra")
    whole = gmsh_text(nodes, solids, faces, "2.2")
    for name, text, words in (
            ("flat.mesh", rectangle(even(0, 1, 1), even(0, 1, 1), lambda x, y: (x, y)), ["dimension 2", "must be 3"]),
            ("stray.mesh", mfem_text(nodes, solids, [*faces, (3, [0, 1, 2, 6])]), ["no face of an element"]),
            ("twice.mesh", mfem_text(nodes, solids, [*faces, (3, faces[0][1][::-1])]), ["one face twice"]),
            ("three.mesh", mfem_text(nodes, solids * 3, faces), ["at most two elements"]),
            ("bare.mesh", mfem_text(nodes, solids, []), ["no boundary elements"]),
            ("inside.mesh", mfem_text(nodes, [solids[0][4:] + solids[0][:4]], faces), ["turned inside out"]),
            ("group.msh", whole.replace(" 5 2 7 7 ", " 5 2 0 7 "), ["of a volume", "no physical group"]),
            ("eight.msh", whole.replace("$EndElements", "").replace("$Elements\n7", "$Elements\n8") + "8 16 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n",
             ["order 2", "must be 1"]),
            ("deck.inp", "*NODE\n1, 0, 0, 0\n", ["no elements", "C3D"])):
        case = block()
        case["bodies"]["block"].update(mesh=run.write(name, text))
        del case["bodies"]["block"]["block"]
        case["interfaces"]["floor"]["between"] = "block:1"
        case["bodies"]["block"]["load"] = "P pressure 6 1"
        error = run.refused(case)
        for word in words:
            assert word in error, (name, error)
    solids_in_the_plane = {"bodies": {"block": {"mesh": run.write("whole.msh", whole), "young": 1, "poisson": 0.3}}, "interfaces": {"f": {"between": "block:1"}}}
    assert "in space" in run.refused(solids_in_the_plane)
