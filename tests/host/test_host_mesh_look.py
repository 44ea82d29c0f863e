# SPDX-License-Identifier: MIT
"""What mud_host sees in a mesh after reading it: on which side of an edge the ground lies, groups that hold nothing or
mean two things, nodes that nothing joins, planes, and files of Gmsh that cannot be used as they are."""
from checking import check, work
from host_program import start
import tables  # noqa: E402 (checking knows its folder)


def gmsh(nodes, surfaces, curves=(), points=(), names=True):
    """A Gmsh 4.1 text of 6-node triangles. nodes: number -> (x, y, z); the others: (name, [tuples of node numbers])."""
    entities = [[], [], []]
    physical, blocks = [], []
    for dimension, (kind, groups) in enumerate(((15, points), (8, curves), (9, surfaces))):
        for tag, (name, members) in enumerate(groups, 1):
            physical.append(f'{dimension} {tag} "{name}"')
            box = "0 0 0" if dimension == 0 else "0 0 0 0 0 0"
            entities[dimension].append(f"{tag} {box} 1 {tag}" + ("" if dimension == 0 else " 0"))
            blocks.append((dimension, tag, kind, members))
    total = sum(len(members) for *_, members in blocks)
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat"]
    if names:
        lines += ["$PhysicalNames", str(len(physical)), *physical, "$EndPhysicalNames"]
    lines += ["$Entities", " ".join(str(len(group)) for group in entities) + " 0", *sum(entities, []), "$EndEntities",
              "$Nodes", f"1 {len(nodes)} {min(nodes)} {max(nodes)}", f"2 1 0 {len(nodes)}", *map(str, nodes),
              *(" ".join(map(repr, x)) for x in nodes.values()), "$EndNodes", "$Elements",
              f"{len(blocks)} {total} 1 {total}"]
    number = 0
    for dimension, tag, kind, members in blocks:
        lines.append(f"{dimension} {tag} {kind} {len(members)}")
        for member in members:
            number += 1
            lines.append(" ".join(map(str, (number, *member))))
    return "\n".join([*lines, "$EndElements"]) + "\n"


class Grid:
    """Cells of 1 m by 1 m, two triangles each; corners (i, j) and middles have the numbers of a grid of half cells."""

    def __init__(self, columns, rows):
        self.wide = 2*columns + 1
        self.nodes = {self.node(i/2, j/2): (i/2, j/2, 0.0) for j in range(2*rows + 1) for i in range(self.wide)}

    def node(self, x, y):
        return int(2*y)*self.wide + int(2*x) + 1

    def cell(self, i, j):
        n = self.node
        return [(n(i, j), n(i + 1, j), n(i + 1, j + 1), n(i + .5, j), n(i + 1, j + .5), n(i + .5, j + .5)),
                (n(i, j), n(i + 1, j + 1), n(i, j + 1), n(i + .5, j + .5), n(i + .5, j + 1), n(i, j + .5))]

    def edge(self, a, b):
        return (self.node(*a), self.node(*b), self.node((a[0] + b[0])/2, (a[1] + b[1])/2))


def column(turned, exchanged):
    """Two cells, one on the other, the face between them in either direction, the elements in either order."""
    grid = Grid(1, 2)
    surfaces = [("low", grid.cell(0, 0)), ("high", grid.cell(0, 1))]
    face = grid.edge((1, 1), (0, 1)) if turned else grid.edge((0, 1), (1, 1))
    curves = [("face", [face]), ("bottom", [grid.edge((0, 0), (1, 0))]), ("top", [grid.edge((1, 2), (0, 2))]),
              ("sides", [grid.edge((x, y), (x, y + 1)) for x in (0, 1) for y in (0, 1)])]
    return gmsh(grid.nodes, surfaces[::-1] if exchanged else surfaces, curves)


TWO = """&scene name = 'two' geometry = 'plane_strain' fields = '{fields}' /
&mesh file = 'column.msh' /
&elastic name = 'e' young = 2e4 poisson = 0 /
&permeability name = 'k' intrinsic = 1e-12 law = 'constant' /
&region group = 'low' material = 'e' void_ratio = 0.5 {flow} {low} /
&region group = 'high' material = 'e' void_ratio = 0.5 {flow} {high} /
&stage name = 'one' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'two' analysis = '{kind}' duration = {duration} dt = {duration} /
&fix group = 'sides' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' /
{load}
&point name = 'face' r = 0 z = 1 /
"""
SOLID = dict(fields="u", flow="", kind="static", duration=1)


def columns_of(name, text, mesh):
    (work / "column.msh").write_text(mesh, encoding="utf-8")
    done = start(name, text)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return tables.columns(work / name / "histories.csv")


MESHES = [(turned, exchanged) for turned in (False, True) for exchanged in (False, True)]


def test_a_pressure_pushes_on_the_ground_that_is_there():
    # A column of 1 m, modulus 2e4 kPa, Poisson's ratio 0: 6 kPa move the face by 0.3 mm into what is left of it.
    only = "stages = 'one'"
    for mesh in MESHES:
        for what, low, high, stages, row, wanted in (
                ("excavated from above", "", only, "two", -1, -3e-4),
                ("undercut from below", only, "", "two", -1, 3e-4),
                ("preloaded before the fill", "", "stages = 'two'", "one", 1, -3e-4)):
            load = f"&load group = 'face' kind = 'pressure' value = 6 stages = '{stages}' /"
            found = columns_of("side", TWO.format(low=low, high=high, load=load, **SOLID),
                               column(*mesh))["face.u_z"][row]
            check(f"{what}, edge and order {mesh}", abs(found - wanted) < 1e-9, found)


def test_rain_falls_on_an_excavated_surface():
    # 1e-7 m/s through 1 m of k/eta = 1e-12/1e-6 raise p_w by 0.1 kPa from -50 kPa below;
    # what the part that leaves held up fades meanwhile, which strains the rest and moves p_w by 1e-4 kPa.
    wet = dict(fields="u-p_w", flow="permeability = 'k'", kind="quasi_static", duration="1e7")
    load = ("&initial p_w = -50 /\n&fix group = 'bottom' field = 'p_w' value = -50 /\n"
            "&fix group = 'top' field = 'p_w' value = -50 /\n"
            "&load group = 'face' kind = 'rain' value = 1e-7 stages = 'two' /")
    for mesh in MESHES:
        for low, high, wanted in (("", "stages = 'one'", -49.9), ("stages = 'one'", "", -50)):
            text = TWO.format(low=low, high=high, load=load, **wet)
            text = text.replace("dt = 1e7", "dt = 1e6 tolerance = 1e-9")
            found = columns_of("rain", text, column(*mesh))["face.p_w"][-1]
            check(f"rain falls on what looks up, {mesh}", abs(found - wanted) < 1e-3, (low, high, found))


def test_a_plate_lands_on_an_excavated_surface():
    # A plate that is moved down by 0.3 mm takes the face along; on the other side of the edges it would meet nothing.
    load = ("&plate name = 'p' r = 0, 1 z = 1 mass = 1 /\n&fix group = 'p' field = 'u_z' stages = 'one' /\n"
            "&fix group = 'p' field = 'u_z' value = -3e-4 stages = 'two' /\n"
            "&contact name = 'c' slave = 'face' master = 'p' penalty = 1e9 stages = 'two' /")
    for mesh in MESHES:
        found = columns_of("land", TWO.format(low="", high="stages = 'one'", load=load, **SOLID),
                           column(*mesh))["face.u_z"][-1]
        check(f"the plate is carried, {mesh}", abs(found + 3e-4) < 1e-7, found)


def test_an_absorbing_boundary_is_of_the_ground_that_is_there():
    # Under a constant shear stress the wave leaves downwards: v = tau/sqrt(rho G) of what is left, G = 1e4, rho = 2.
    text = TWO.format(low="stages = 'one'", high="", load="&load group = 'top' kind = 'shear_r' value = 3 "
                      "stages = 'two' /\n&absorbing group = 'face' stages = 'two' /", fields="u", flow="rho_s = 3",
                      kind="dynamic", duration=1)
    text = text.replace("dt = 1 /\n&fix", "dt = 1e-3 /\n&fix").replace("group = 'sides' field = 'u_r' /",
                                                                     "group = 'all' field = 'u_z' /")
    text = text.replace("&fix group = 'bottom' field = 'u_z' /\n&fix group = 'top' field = 'u_z' /\n",
                        "&fix group = 'bottom' field = 'u_r' /\n&fix group = 'top' field = 'u_r' stages = 'one' /\n")
    text = text.replace("&region group = 'low' material = 'e'", "&elastic name = 'rock' young = 2e6 poisson = 0 /\n"
                        "&region group = 'low' material = 'rock'")
    # Without stages it acts in the dynamic one alone: what is ground in the static one is no matter.
    for mesh, same in ((mesh, same) for mesh in MESHES for same in (text, text.replace(
            "&absorbing group = 'face' stages = 'two'", "&absorbing group = 'face'"))):
        rows = columns_of("absorbed", same, column(*mesh))
        speed = (rows["face.u_r"][-1] - rows["face.u_r"][-101])/(rows["time"][-1] - rows["time"][-101])
        check(f"speed behind the wave, {mesh}", abs(speed/(3/(2*1e4)**0.5) - 1) < 1e-3, speed)


def refused(name, text, code, *words):
    for more in (["--check"], []):
        done = start(name, text, *more)
        check(f"{name} is refused {more}", done.returncode == code, (done.returncode, done.stderr))
        for word in words:
            check(f"{name} {more}: {word}", word in done.stderr, done.stderr)


def test_an_edge_without_an_outside_is_refused():
    for mesh in MESHES:
        (work / "column.msh").write_text(column(*mesh), encoding="utf-8")
        both = TWO.format(low="", high="", load="&load group = 'face' kind = 'pressure' value = 6 /", **SOLID)
        refused("both", both, 11, "&load acts in stage 'one' on group 'face'",
                "(0.5, 1) m has ground on both sides", "name the stages")
        for what, kind in (("&absorbing group = 'face' /", "dynamic"),
                           ("&load group = 'face' kind = 'rain' value = 0 /", "static")):
            text = TWO.format(low="", high="", load=what, **{**SOLID, "fields": "u-p_w", "flow": "permeability = 'k'",
                                                            "kind": kind})
            refused("what", text, 11, "has ground on both sides")
        turns = TWO.format(low="stages = 'one'", high="stages = 'two'",
                           load="&load group = 'face' kind = 'pressure' value = 6 /", **SOLID)
        refused("turns", turns, 11, "ground on the other side than in stage 'one'", "one &load for each of the stages")


def test_the_built_in_mesh_names_the_faces_between_its_blocks():
    # A cut of the second of three columns and the second of two rows: its wall on the left and its floor are pushed.
    text = """&scene name = 'cut' geometry = 'plane_strain' /
&mesh r = 0, 1, 2, 3 r_cells = 2, 1, 1 z = 0, 1, 2 z_cells = 2, 1 /
&elastic name = 'e' young = 1e4 poisson = 0 /
&region material = 'e' void_ratio = 0 /
&region group = 'block_2_2' material = 'e' void_ratio = 0 stages = 'rest' /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 /
&stage name = 'cut' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-8 /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = '{}' kind = 'pressure' value = 5 stages = 'cut' /
&point name = 'left' r = 1 z = 1.5 /
&point name = 'right' r = 2 z = 1.5 /
&point name = 'floor' r = 1.5 z = 1 /
"""
    for group, point, sign in (("interface_r_1_2", "left.u_r", -1), ("interface_r_2_2", "right.u_r", 1),
                               ("interface_z_2_1", "floor.u_z", -1)):
        done = start("cut", text.format(group))
        check(f"{group} runs", done.returncode == 0, done.stderr)
        found = tables.columns(work / "cut/histories.csv")[point][-1]
        check(f"{group} pushes on what is left", sign*found > 1e-5, found)
    # The whole lines have ground on both sides beside the cut.
    for group, edges in (("interface_r_1", "(1, 0.25)"), ("interface_z_1", "(0.25, 1)")):
        done = start("cut", text.format(group))
        check(f"{group} is a group, and refused", done.returncode == 11 and f"edge at {edges} m" in done.stderr,
              done.stderr)


BLOCK = """&scene name = 'block' geometry = 'plane_strain' /
&mesh file = 'block.msh' /
&elastic name = 'e' young = 1e4 poisson = 0.2 /
&region material = 'e' void_ratio = 0 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 20 /
&point name = 'top' r = 0 z = 2 /
"""


def block(**changes):
    """A block of 1 m by 2 m, with what a test changes of it."""
    grid = Grid(1, 2)
    parts = {"nodes": grid.nodes, "surfaces": [("soil", grid.cell(0, 0) + grid.cell(0, 1))],
             "curves": [("left", [grid.edge((0, 1), (0, 0)), grid.edge((0, 2), (0, 1))]),
                        ("bottom", [grid.edge((0, 0), (1, 0))]), ("top", [grid.edge((1, 2), (0, 2))])],
             "points": []}
    for name, change in changes.items():
        parts[name] = change(parts[name])
    return gmsh(**parts)


def looked(name, mesh, text=BLOCK, *more):
    (work / "block.msh").write_text(mesh, encoding="utf-8")
    return start(name, text, *more)


def test_groups_that_hold_nothing_or_mean_two_things_are_refused():
    empty = lambda groups: [*groups, ("drain", [])]  # noqa: E731
    for line in ("&fix group = 'drain' field = 'u_z' /", "&load group = 'drain' kind = 'force_z' value = -5 /",
                 "&initial group = 'drain' v_z = 1 /", "&absorbing group = 'drain' /",
                 "&contact name = 'c' slave = 'drain' master = 'top' /",
                 "&region group = 'drain' material = 'e' void_ratio = 0 /"):
        for more in (["--check"], []):
            done = looked("empty", block(curves=empty), BLOCK + line + "\n", *more)
            check(f"{line} {more}: refused", done.returncode == 11
                  and "group 'drain' of the mesh is empty" in done.stderr, done.stderr)
    check("an empty group that nobody uses is no matter", looked("unused", block(curves=empty)).returncode == 0)
    corner = block(points=lambda _: [("bottom", [(1,)])])
    done = looked("two", corner)
    check("a point and a curve of one name", done.returncode == 11 and "'bottom' of several dimensions" in done.stderr
          and "scene" not in done.stderr, done.stderr)
    done = looked("two", corner, BLOCK.replace("'bottom'", "'all'"))
    check("of no matter where none of them is used", done.returncode == 0, done.stderr)
    # Two curves of one name, as Gmsh allows: one group.
    halves = block(curves=lambda groups: [groups[1], groups[2], ("left", groups[0][1][:1]), ("left", groups[0][1][1:])])
    one, two = (tables.columns(work / "one/histories.csv") for _ in range(2)
                if looked("one", halves if _ else block()).returncode == 0)
    check("curves of one name are one group", one["top.u_z"][-1] == two["top.u_z"][-1], (one, two))


def test_a_physical_group_called_all():
    done = looked("all", block(curves=lambda groups: [*groups, ("all", groups[2][1])]))
    check("of a curve: refused", done.returncode == 10 and "physical group is called 'all'" in done.stderr, done.stderr)
    done = looked("all", block(surfaces=lambda groups: [("all", groups[0][1])]))
    check("of all triangles: what a scene calls so", done.returncode == 0, done.stderr)


def test_names_with_commas_stand_in_quotes():
    text = BLOCK.replace("group = 'bottom'", "group = 'bottom, fixed'")
    text = text.replace("value = 20", "value = 20 history = 'h'")
    text = text.replace("dt = 1", "dt = 0.5") + "&history name = 'h' times = 0, 1 values = 0, 1 /\n"
    mesh = block(curves=lambda groups: [(name.replace("bottom", "bottom, fixed"), edges) for name, edges in groups])
    done = looked("commas", mesh, text)
    check("it runs, and its tables are read back", done.returncode == 0, done.stderr)
    rows = tables.columns(work / "commas/reactions_s.csv")
    check("the force stands under its name", abs(rows["bottom, fixed.force_z"][-1] - 20) < 1e-9, rows)


def test_nodes_at_one_place_that_nothing_joins_are_told():
    # The upper cell has nodes of its own.
    grid = Grid(1, 2)
    own = {node: node + 100 for node, x in grid.nodes.items() if x[1] == 1}
    nodes = {**grid.nodes, **{own[node]: grid.nodes[node] for node in own}}
    upper = [tuple(own.get(node, node) for node in one) for one in grid.cell(0, 1)]
    left = [grid.edge((0, 1), (0, 0)), tuple(own.get(node, node) for node in grid.edge((0, 2), (0, 1)))]
    slit = block(nodes=lambda _: nodes, surfaces=lambda _: [("low", grid.cell(0, 0)), ("high", upper)],
                 curves=lambda groups: [("left", left), *groups[1:], ("under", [grid.edge((1, 1), (0, 1))]),
                                        ("over", [tuple(own[node] for node in grid.edge((0, 1), (1, 1)))])])
    text = BLOCK.replace("&fix group = 'bottom' field = 'u_z'", "&fix group = 'all' field = 'u_z'")
    for more in (["--check"], []):
        done = looked("slit", slit, text, *more)
        check(f"told {more}", done.returncode == 0 and "3 pairs of boundary nodes at one place" in done.stderr
              and ", 1) m" in done.stderr, done.stderr)
    for joint in ("&contact name = 'c' slave = 'under' master = 'over' /",):
        done = looked("joined", slit, text + joint, "--check")
        check(f"{joint} joins", done.returncode == 0 and "one place" not in done.stderr, done.stderr)
    check("a whole mesh is no matter", looked("whole", block()).stderr == "", looked("whole", block()).stderr)


def test_a_load_on_nodes_of_no_element_is_refused():
    for line in ("&load group = 'anchor' kind = 'force_z' value = -5 /", "&fix group = 'anchor' field = 'u_r' /"):
        far = block(nodes=lambda nodes: {**nodes, 99: (4.0, 3.0, 0.0)}, points=lambda _: [("anchor", [(99,)])])
        for more in (["--check"], []):
            done = looked("anchor", far, BLOCK + line, *more)
            check(f"{line} {more}", done.returncode == 11 and "1 of the 1 nodes of group 'anchor' belong to no element"
                  in done.stderr and "(4, 3) m" in done.stderr, done.stderr)


def test_planes_of_a_mesh():
    check("x, y", looked("xy", block()).returncode == 0)
    turned = lambda order: lambda nodes: {n: tuple(x[i] for i in order) for n, x in nodes.items()}  # noqa: E731
    check("x, z runs", looked("xz", block(nodes=turned((0, 2, 1)))).returncode == 0)
    one, two = (tables.columns(work / f"{name}/histories.csv") for name in ("xy", "xz"))
    check("x, z as x, y", all((one[key] == two[key]).all() for key in one), (one, two))
    shifted = looked("shifted", block(nodes=lambda nodes: {n: (x, y, 7.5) for n, (x, y, _) in nodes.items()}))
    check("x, y at another z", shifted.returncode == 0, shifted.stderr)
    for what, change in (("a tilted plane", lambda nodes: {n: (x, 0.8*y, 0.6*y) for n, (x, y, _) in nodes.items()}),
                         ("y, z", turned((2, 0, 1)))):
        done = looked("tilted", block(nodes=change))
        check(f"{what} is refused by name", done.returncode == 10 and "lies in no plane x, y or x, z" in done.stderr,
              done.stderr)


def test_meshes_with_quadrilaterals_or_partitions():
    quads = block().replace("2 1 9 4\n", "2 1 16 4\n")
    done = looked("quads", quads)
    check("quadrilaterals", done.returncode == 10 and "has quadrilaterals; mesh it without Recombine" in done.stderr
          and "splitQuadrangles()" in done.stderr and "gmsh -2" not in done.stderr, done.stderr)
    parts = block().replace("$Nodes\n", "$PartitionedEntities\n2\n0\n0 0 0 0\n$EndPartitionedEntities\n$Nodes\n")
    done = looked("parts", parts)
    check("a partitioned mesh", done.returncode == 10 and "is partitioned; mesh it again without -part" in done.stderr,
          done.stderr)
