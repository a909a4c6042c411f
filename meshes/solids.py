"""Meshes of hexahedra and wedges: layers on a plan. Writes the meshes of pin_on_block.json and dovetail_3d.json.

python3 meshes/solids.py [FOLDER] [--finer N] [--halve FILE …]

Run it from the top of the repository. FOLDER is meshes/ unless given. --finer N divides the elements at the contact of the pin, and
the layers of the dovetail, into N. --halve writes meshes of hexahedra (Gmsh's format 2.2) with halved elements into FOLDER instead.
Other scripts import discs, and layers of them or of a plane mesh.
"""

import argparse
import math
import pathlib

GMSH_TYPES = {2: ("triangle", 3), 3: ("quadrilateral", 4), 4: ("tetrahedron", 4), 5: ("hexahedron", 8), 6: ("wedge", 6), 9: ("triangle", 6)}
TYPE_OF_FACE, TYPE_OF_SOLID = {3: 2, 4: 3}, {4: 4, 6: 6, 8: 5}


class Plan:
    """A plane mesh: points (x, y), cells of three or four corners, counterclockwise, and named edges of two points."""

    def __init__(self, points, cells, edges):
        self.points, self.cells, self.edges = points, cells, edges


class Solids:
    """A mesh in space: nodes (x, y, z), cells of 6 or 8 corners in the order of Gmsh, named faces of 3 or 4 corners, and its name."""

    def __init__(self, nodes, cells, faces, name="body"):
        self.nodes, self.cells, self.faces, self.name = nodes, cells, faces, name

    def sides(self):
        """Names of the faces, each once."""
        return list(dict.fromkeys(name for name, _ in self.faces))


def growing(first, last, step, growth):
    """Places from first to last in steps that grow by `growth`, scaled so that they end there."""
    steps = [step]
    while sum(steps) < abs(last - first):
        steps.append(steps[-1] * growth)
    scale = (last - first) / sum(steps)
    return [first + scale * sum(steps[:k]) for k in range(len(steps))] + [last]


def disc(core, cells, radii, half=True):
    """A disc about the origin, or its half with y >= 0: a square of half-width `core` with `cells` (even) cells across, within rings of
    the radii. Rings turn from squares to circles up to the fourth one. Edges are `cut` (y = 0) and `side`."""
    n = cells // 2
    points, quads, edges, number = [], [], [], {}
    first = 0 if half else -n
    for j in range(first, n + 1):
        for i in range(-n, n + 1):
            number[i, j] = len(points)
            points.append((core * i / n, core * j / n))
    for j in range(first, n):
        for i in range(-n, n):
            quads.append((number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]))
    # The outline of the square, counterclockwise: half of it from (core, 0) to (-core, 0), the whole from and to (core, 0).
    outline = [(n, j) for j in range(n + 1)] + [(i, n) for i in range(n - 1, -n - 1, -1)] + [(-n, j) for j in range(n - 1, -1, -1)]
    if not half:
        outline += [(-n, j) for j in range(-1, -n - 1, -1)] + [(i, -n) for i in range(-n + 1, n + 1)] + [(n, j) for j in range(-n + 1, 0)]
    inner, mean = [number[at] for at in outline], 1.1 * core
    round_ = radii[min(3, len(radii) - 1)]
    pairs = [(m, m + 1) for m in range(len(outline) - 1)] + ([] if half else [(len(outline) - 1, 0)])
    for radius in radii:
        outer, share = [], min(1.0, (radius - core) / (round_ - core))
        for m, (i, j) in enumerate(outline):
            # Angles grow evenly along the outline, 45 degrees for n cells.
            angle = math.pi / 4 * m / n
            outer.append(len(points))
            square = (radius / mean * core * i / n, radius / mean * core * j / n)
            at = [(1 - share) * s + share * radius * c for s, c in zip(square, (math.cos(angle), math.sin(angle)))]
            points.append((at[0], 0.0 if half and m in (0, len(outline) - 1) else at[1]))
        quads += [(inner[a], outer[a], outer[b], inner[b]) for a, b in pairs]
        if half:
            edges += [("cut", (inner[0], outer[0])), ("cut", (outer[-1], inner[-1]))]
        inner = outer
    if half:
        edges += [("cut", (number[i, 0], number[i + 1, 0])) for i in range(-n, n)]
    edges += [("side", (inner[a], inner[b])) for a, b in pairs]
    return Plan(points, quads, edges)


def layers(plan, heights, place=None, low="low", high="high"):
    """The plan at each of the heights (increasing), elements between them: edges keep their names. `place` moves (x, y, z). Names of the
    lowest and highest faces may be functions of the middle (x, y) of a cell."""
    def name(given, cell):
        return given(*(sum(plan.points[k][c] for k in cell) / len(cell) for c in (0, 1))) if callable(given) else given
    count = len(plan.points)
    nodes = [place(x, y, z) if place else (x, y, z) for z in heights for x, y in plan.points]
    solids, faces = [], []
    top = (len(heights) - 1) * count
    for k in range(len(heights) - 1):
        solids += [tuple(k * count + p for p in cell) + tuple((k + 1) * count + p for p in cell) for cell in plan.cells]
        faces += [(side, (k * count + a, k * count + b, (k + 1) * count + b, (k + 1) * count + a)) for side, (a, b) in plan.edges]
    faces += [(name(low, cell), tuple(reversed(cell))) for cell in plan.cells]
    faces += [(name(high, cell), tuple(top + p for p in cell)) for cell in plan.cells]
    return Solids(nodes, solids, faces)


def ended(mesh, side, height):
    """Faces of a side that reach a height are named `SIDE_end`, so that a guide at that height alone holds the nodes there."""
    return Solids(mesh.nodes, mesh.cells, [(side + "_end" if name == side and any(mesh.nodes[p][2] == height for p in face) else name, face)
                                           for name, face in mesh.faces], mesh.name)


def refined(mesh):
    """A mesh of hexahedra with each of them divided into eight: new nodes are the middles of edges, faces and elements."""
    nodes, made = list(mesh.nodes), {}

    def middle(corners):
        key = tuple(sorted(corners))
        if len(key) == 1:
            return key[0]
        if key not in made:
            made[key] = len(nodes)
            nodes.append(tuple(sum(mesh.nodes[k][c] for k in key) / len(key) for c in range(3)))
        return made[key]

    def lattice(corner_at, corners, dimension):
        """Nodes at {0, 1, 2}^dimension: the middle of the corners that lie on each side that the place is on."""
        places = [()]
        for _ in range(dimension):
            places = [at + (t,) for at in places for t in range(3)]
        return {at: middle([c for c, where in zip(corners, corner_at) if all(t in (1, 2 * s) for t, s in zip(at, where))]) for at in places}

    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cube = [(*at, 0) for at in square] + [(*at, 1) for at in square]
    cells, faces = [], []
    for cell in mesh.cells:
        at = lattice(cube, cell, 3)
        cells += [tuple(at[tuple(o + s for o, s in zip(origin, where))] for where in cube) for origin in cube]
    for name, face in mesh.faces:
        at = lattice(square, face, 2)
        faces += [(name, tuple(at[tuple(o + s for o, s in zip(origin, where))] for where in square)) for origin in square]
    return Solids(nodes, cells, faces, mesh.name)


def read_gmsh(file):
    """Nodes, elements by kind as (attribute, corners), and names by (dimension, attribute) of a file of format 2.2."""
    lines = iter(pathlib.Path(file).read_text(encoding="utf-8").splitlines())
    nodes, elements, names = {}, {}, {}
    for line in lines:
        if line == "$PhysicalNames":
            for _ in range(int(next(lines))):
                dimension, attribute, name = next(lines).split(maxsplit=2)
                names[int(dimension), int(attribute)] = name.strip('"')
        elif line == "$Nodes":
            for _ in range(int(next(lines))):
                number, *at = next(lines).split()
                nodes[int(number)] = tuple(map(float, at))
        elif line == "$Elements":
            for _ in range(int(next(lines))):
                words = list(map(int, next(lines).split()))
                elements.setdefault(words[1], []).append((words[3], words[3 + words[2]:]))
    return nodes, elements, names


def read_solids(file):
    """A mesh of hexahedra of a Gmsh file of format 2.2, with named faces."""
    nodes, elements, names = read_gmsh(file)
    used = sorted({k for _, cell in elements[5] for k in cell})
    number = {k: n for n, k in enumerate(used)}
    return Solids([nodes[k] for k in used], [tuple(number[k] for k in cell) for _, cell in elements[5]],
                  [(names[2, attribute], tuple(number[k] for k in face)) for attribute, face in elements[3]], names[3, elements[5][0][0]])


def read_plan(file, sides):
    """The straight triangles of a plane Gmsh file (format 2.2, order 1 or 2), its edges named by `sides`, attribute: name."""
    nodes, elements, _ = read_gmsh(file)
    cells = [cell[:3] for kind in (2, 9) for _, cell in elements.get(kind, [])]
    edges = [(sides[attribute], edge[:2]) for kind in (1, 8) for attribute, edge in elements.get(kind, [])]
    used = sorted({k for cell in cells for k in cell})
    number = {k: n for n, k in enumerate(used)}
    return Plan([nodes[k][:2] for k in used], [tuple(number[k] for k in cell) for cell in cells],
                [(name, tuple(number[k] for k in edge)) for name, edge in edges])


def gmsh_text(mesh):
    """A mesh in Gmsh's format 2.2."""
    sides = mesh.sides()
    rows = [(TYPE_OF_FACE[len(face)], 1 + sides.index(name), face) for name, face in mesh.faces]
    rows += [(TYPE_OF_SOLID[len(cell)], 1, cell) for cell in mesh.cells]
    names = [f'2 {k} "{name}"' for k, name in enumerate(sides, 1)] + [f'3 1 "{mesh.name}"']
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames",
                      "$Nodes", str(len(mesh.nodes)), *("%d %.12g %.12g %.12g" % (k, *at) for k, at in enumerate(mesh.nodes, 1)), "$EndNodes",
                      "$Elements", str(len(rows)),
                      *(f"{k} {kind} 2 {tag} {tag} " + " ".join(str(p + 1) for p in own) for k, (kind, tag, own) in enumerate(rows, 1)),
                      "$EndElements", ""])


def pin(finer=1, radius=50.0, across=10.0, core=0.3, reach=0.9, high=10.0):
    """Half of a pin with a spherical end of this radius, which touches z = 0. Its sides: `contact` within `reach` of the axis, `rim`
    around it, `side`, `top` and the plane of symmetry `cut`, which ends below the top."""
    cells = 6 * finer
    step = 2 * core / cells
    rings = [core + (reach - core) * k / round((reach - core) / step) for k in range(1, round((reach - core) / step) + 1)]
    plan = disc(core, cells, rings + growing(reach, across, step * 1.5, 1.8)[1:])

    def end(x, y, z):
        return (x, y, z + (radius - math.sqrt(radius**2 - x**2 - y**2)) * (1 - z / high))
    return ended(layers(plan, growing(0.0, high, step, 1.6), end, low=lambda x, y: "contact" if math.hypot(x, y) < reach else "rim", high="top"), "cut", high)


def dovetail_plan(meshes, body):
    """The triangles of a body of dovetail.json. The contact is the `flank`, which is flat, and the `arc` beside it."""
    plan = read_plan(meshes / f"dovetail_{body}.msh", {1: "symmetry", 2: "end", 3: "arc", 4: "free", 5: "next"})
    plan.edges = [("flank" if side == "arc" and all(abs(sum(plan.points[k]) - 4) < 1e-9 for k in edge) else side, edge) for side, edge in plan.edges]
    return plan


def dovetail(meshes, body, finer=1, width=6.0, cells=6):
    """Half of a body of the dovetail, `width` wide: wedges between `middle` (z = 0) and `face`, thinner towards the face."""
    steps = [0.75 ** (k / finer) for k in range(cells * finer)]
    return layers(dovetail_plan(meshes, body), [width / 2 * sum(steps[:k]) / sum(steps) for k in range(len(steps))] + [width / 2], low="middle", high="face")


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=here)
    parser.add_argument("--finer", type=int, default=1)
    parser.add_argument("--halve", nargs="+", type=pathlib.Path, default=[], metavar="FILE")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    if options.halve:
        made = {file.stem: refined(read_solids(file)) for file in options.halve}
    else:
        made = {"pin_on_block_pin": pin(options.finer), **{f"dovetail_3d_{body}": dovetail(here, body, options.finer) for body in ("root", "disc")}}
    for name, mesh in made.items():
        (options.folder / f"{name}.msh").write_text(gmsh_text(mesh), encoding="utf-8")
        print(f"{name}.msh: {len(mesh.nodes)} nodes, {len(mesh.cells)} elements, sides {', '.join(mesh.sides())}")


if __name__ == "__main__":
    main()
