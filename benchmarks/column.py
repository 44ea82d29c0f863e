#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The host beside OpenSees, OpenGeoSys and Kratos on one problem: consolidation of a square of soil.

    python3 -m venv peers
    peers/bin/pip install openseespylinux==3.7.1.2 ogs==6.5.9 KratosGeoMechanicsApplication==10.4.4 \\
        KratosLinearSolversApplication==10.4.4
    build/venv/bin/python3 benchmarks/column.py --peers peers [--results benchmarks/results]

1 m by 1 m in plane strain, linear elastic, incompressible water, drained at the top, loaded with 100 kPa at once;
quadratic displacements and linear pressures on the same nodes (OpenSees: quadrilaterals of nine nodes, the others
triangles of six), equal steps, Newton's method to 1e-6 with a direct solver, one thread. Every program runs N steps and
3 N steps, in turn; a step takes the difference of their processor times over 2 N, so that reading and the first step do
not count. Told are medians of the rounds, and the settlement and the pressure at the base at the end of N steps of the
first size beside Terzaghi's series: that all solve the same problem. Three minutes a round, without OpenGeoSys and
Kratos on the large mesh (--small) seconds.
"""
import argparse
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT/"common"))
import tables  # noqa: E402 (its folder is known only now)

YOUNG, POISSON, MOBILITY, LOAD, STEP = 1e4, 0.25, 1e-6, 100.0, 0.2   # kPa, -, permeability over viscosity [m2/(kPa s)], kPa, s
POROSITY = 0.8/1.8
SIZES = {16: 50, 64: 4}   # cells along a side: steps N


class Grid:
    """Nodes (i, j), 0 to 2 n along a side, and triangles of six nodes as lists of (i, j), corners first."""

    def __init__(self, n):
        self.n, self.side = n, 2*n + 1
        self.nodes = [(i, j) for j in range(self.side) for i in range(self.side)]
        self.triangles = [[*c, *(self.middle(c[k], c[k - 2]) for k in range(3))]
                          for j in range(0, 2*n, 2) for i in range(0, 2*n, 2)
                          for c in (((i, j), (i + 2, j), (i + 2, j + 2)), ((i, j), (i + 2, j + 2), (i, j + 2)))]
        last = 2*n
        self.edges = {"bottom": [((i, 0), (i + 2, 0), (i + 1, 0)) for i in range(0, last, 2)],
                      "top": [((i, last), (i + 2, last), (i + 1, last)) for i in range(0, last, 2)],
                      "left": [((0, j), (0, j + 2), (0, j + 1)) for j in range(0, last, 2)],
                      "right": [((last, j), (last, j + 2), (last, j + 1)) for j in range(0, last, 2)]}

    @staticmethod
    def middle(a, b):
        return (a[0] + b[0])//2, (a[1] + b[1])//2

    @staticmethod
    def corner(node):
        return node[0] % 2 == node[1] % 2 == 0

    def place(self, node):
        return node[0]/(2*self.n), node[1]/(2*self.n)

    def unknowns(self):
        return 2*self.side**2 + (self.n + 1)**2


def opensees(n, steps):
    """Newmark's method with gamma 0.6, as its examples of u-p elements have it; a pressure is a velocity there."""
    import openseespylinux.opensees as ops
    grid = Grid(n)
    number = {node: k for k, node in enumerate(grid.nodes, 1)}
    for freedoms, corner in ((3, True), (2, False)):
        ops.model("basic", "-ndm", 2, "-ndf", freedoms)
        for node in grid.nodes:
            if grid.corner(node) == corner:
                ops.node(number[node], *grid.place(node))
    for node in grid.nodes:
        held = [node[0] in (0, 2*n), node[1] == 0] + [node[1] == 2*n]*grid.corner(node)
        if any(held):
            ops.fix(number[node], *map(int, held))
    ops.nDMaterial("ElasticIsotropic", 1, YOUNG, POISSON, 0.0)
    around = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1))
    cells = [(i, j) for j in range(0, 2*n, 2) for i in range(0, 2*n, 2)]
    for k, (i, j) in enumerate(cells, 1):
        ops.element("9_4_QuadUP", k, *(number[i + a, j + b] for a, b in around), 1.0, 1, 1e12, 0.0, MOBILITY, MOBILITY, 0.0, 0.0)
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for i in range(2*n + 1):
        share = (1 if i in (0, 2*n) else 4 if i % 2 else 2)/(6*n)
        ops.load(number[i, 2*n], 0.0, -LOAD*share, *[0.0]*(i % 2 == 0))
    for setting in ("constraints Plain", "numberer RCM", "system UmfPack", "algorithm Newton"):
        getattr(ops, setting.split()[0])(setting.split()[1])
    ops.test("NormDispIncr", 1e-8, 30, 0)
    ops.integrator("Newmark", 0.6, 0.3025)
    ops.analysis("Transient")
    if ops.analyze(steps, STEP):
        raise RuntimeError("OpenSees did not converge")
    return ops.nodeDisp(number[0, 2*n], 2), ops.nodeVel(number[0, 0], 3)


def opengeosys(n, steps):
    """HYDRO_MECHANICS, backward Euler, SparseLU of Eigen."""
    sys.path.insert(0, str(ROOT/"clients/opengeosys"))
    import meshio
    import project as made
    QUADRATIC_TRIANGLE, QUADRATIC_EDGE = 22, 21
    grid = Grid(n)
    nodes = sorted(grid.nodes, key=lambda node: not grid.corner(node))
    number = {node: k for k, node in enumerate(nodes)}
    points = [(*grid.place(node), 0.0) for node in nodes]
    cells = [[number[node] for node in t] for t in grid.triangles]
    pathlib.Path("column.vtu").write_text(made.grid(points, cells, [QUADRATIC_TRIANGLE]*len(cells),
                                                    cell_data=made.array("MaterialIDs", "Int32", [0]*len(cells))))
    for name, edges in grid.edges.items():
        kept = sorted({number[node] for edge in edges for node in edge})
        place = {k: i for i, k in enumerate(kept)}
        pathlib.Path(f"{name}.vtu").write_text(made.grid(
            [points[k] for k in kept], [[place[number[node]] for node in edge] for edge in edges], [QUADRATIC_EDGE]*len(edges),
            made.array("bulk_node_ids", "UInt64", kept)))
    # Integration order 4 has six points; it does not extrapolate stresses from fewer than there are nodes.
    process = ("<process><name>P</name><type>HYDRO_MECHANICS</type><integration_order>4</integration_order>"
               "<constitutive_relation><type>LinearElasticIsotropic</type><youngs_modulus>young</youngs_modulus>"
               "<poissons_ratio>poisson</poissons_ratio></constitutive_relation><process_variables><pressure>pressure</pressure>"
               "<displacement>displacement</displacement></process_variables><secondary_variables><secondary_variable "
               'internal_name="sigma" output_name="sigma"/></secondary_variables><specific_body_force>0 0'
               "</specific_body_force></process>")
    media = ("<phases><phase><type>AqueousLiquid</type>" + made.properties(density=1.0, viscosity=1e-6)
             + "</phase><phase><type>Solid</type>" + made.properties(density=2.65) + "</phase></phases>"
             + made.properties(porosity=POROSITY, biot_coefficient=1.0, permeability=MOBILITY*1e-6, reference_temperature=293.15))
    parameters = "".join(made.constant(*row) for row in (("young", YOUNG), ("poisson", POISSON), ("zero", 0), ("rest", 0, 0),
                                                         ("load", -LOAD)))
    held = "".join(made.condition(*row) for row in ((0, "zero", "left"), (0, "zero", "right"), (1, "zero", "bottom"),
                                                    (1, "load", "top", "Neumann")))
    variables = (made.variable("displacement", 2, "rest", held, order=2)
                 + made.variable("pressure", 1, "zero", made.condition(0, "zero", "top")))
    pathlib.Path("column.prj").write_text(made.whole(
        ["column", *grid.edges], process, media, "<abstols>1e-6 1e-9 1e-9</abstols>", made.equal_steps(steps*STEP, steps),
        ("displacement", "pressure"), parameters, "", variables, kept=[steps*STEP]))
    with open("ogs.log", "w", encoding="utf-8") as log:
        subprocess.run([pathlib.Path(sys.executable).parent/"ogs", "column.prj"], stdout=log, stderr=log, check=True)
    data = meshio.read(f"r_{steps}.vtu").point_data
    return data["displacement"][number[0, 2*n]][1], data["pressure"][number[0, 0]]


def kratos(n, steps):
    """U_Pw solver, elements of different order, backward Euler, sparse_lu of Eigen."""
    sys.path.insert(0, str(ROOT/"clients/kratos"))
    import KratosMultiphysics as core
    from KratosMultiphysics.GeoMechanicsApplication.geomechanics_analysis import GeoMechanicsAnalysis
    import project as made
    grid = Grid(n)
    number = {node: k for k, node in enumerate(grid.nodes, 1)}

    def block(kind, rows):
        return [f"Begin {kind}", *rows, f"End {kind.split()[0]}", ""]

    def part(name, nodes, **others):
        lists = {"Tables": (), "Nodes": [number[node] for node in nodes], "Elements": (), "Conditions": (), **others}
        return block(f"SubModelPart {name}", [row for kind, rows in lists.items() if rows
                                              for row in block(f"SubModelPart{kind}", map(str, rows))])

    def numbered(kind, rows):
        return block(kind, [f"{k} 0 " + " ".join(str(number[node]) for node in row) for k, row in enumerate(rows, 1)])

    top = [node for node in grid.nodes if node[1] == 2*n]
    text = (block("ModelPartData", []) + block("Properties 0", [])
            + block("Table 1 TIME NORMAL_CONTACT_STRESS", [f"0 {LOAD}", f"1e6 {LOAD}"])
            + block("Nodes", [f"{number[node]} {grid.place(node)[0]!r} {grid.place(node)[1]!r} 0.0" for node in grid.nodes])
            + numbered("Elements SmallStrainUPwDiffOrderElement2D6N", grid.triangles)
            + numbered("Conditions LineNormalLoadDiffOrderCondition2D3N", [(b, a, m) for a, b, m in grid.edges["top"]])
            + part("Soil", grid.nodes, Elements=range(1, len(grid.triangles) + 1))
            + part("Bottom", [node for node in grid.nodes if node[1] == 0])
            + part("Sides", [node for node in grid.nodes if node[0] in (0, 2*n)])
            + part("Top", top) + part("Cell", top, Conditions=range(1, n + 1), Tables=(1,)))
    pathlib.Path("column.mdpa").write_text("\n".join(text), encoding="utf-8")
    drained = made.dry()
    drained["Parameters"]["model_part_name"] = "PorousDomain.Top"
    project = made.project(2, "column", 1, [made.constraint("Bottom", "Y"), made.constraint("Sides", "X"), drained],
                           [made.cell_pressure(2, LOAD, 1)], ["Bottom", "Sides", "Top", "Cell"])
    project["problem_data"]["end_time"] = steps*STEP
    project["solver_settings"]["time_stepping"]["time_step"] = STEP
    project["solver_settings"] |= {"displacement_relative_tolerance": 1e-6, "displacement_absolute_tolerance": 1e-12}
    soil = made.material("GeoLinearElasticPlaneStrain2DLaw", "", [], [], False)
    variables = soil["properties"][0]["Material"]["Variables"]
    for key in ("IS_FORTRAN_UDSM", "UDSM_NAME", "UDSM_NUMBER", "UMAT_PARAMETERS", "STATE_VARIABLES", "PERMEABILITY_ZZ",
                "PERMEABILITY_YZ", "PERMEABILITY_ZX"):
        del variables[key]
    variables |= {"YOUNG_MODULUS": YOUNG, "POISSON_RATIO": POISSON, "POROSITY": POROSITY, "BULK_MODULUS_SOLID": 1e12,
                  "BULK_MODULUS_FLUID": 1e12, "PERMEABILITY_XX": MOBILITY*1e-6, "PERMEABILITY_YY": MOBILITY*1e-6}
    made.write(pathlib.Path("."), "MaterialParameters.json", soil)
    core.Logger.GetDefaultOutput().SetSeverity(core.Logger.Severity.WARNING)
    model = core.Model()
    GeoMechanicsAnalysis(model, core.Parameters(json.dumps(project))).Run()
    nodes = model["PorousDomain"].Nodes
    return (nodes[number[0, 2*n]].GetSolutionStepValue(core.DISPLACEMENT_Y),
            -nodes[number[0, 0]].GetSolutionStepValue(core.WATER_PRESSURE))


def host(n, steps, factors):
    """mud_host; rho_inf 0, a method of second order that damps as backward Euler does."""
    words = {"CELLS": n, "FACTORS": factors, "END": steps*STEP, "STEP": STEP}
    scene = (ROOT/"benchmarks/column.nml").read_text(encoding="utf-8")
    pathlib.Path("column.nml").write_text(re.sub("@([A-Z]+)@", lambda found: str(words[found[1]]), scene), encoding="utf-8")
    program = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT/"build/release")/"host/mud_host"
    subprocess.run([program, "column.nml", "--quiet", "--output", "out"], check=True)
    last = tables.rows("out/histories.csv")[-1]
    return float(last["top.u_z"]), float(last["base.p_w"])


PROGRAMS = {
    "mud_host": ("UMFPACK, factors kept while they serve (default)", lambda n, steps: host(n, steps, "reuse")),
    "mud_host, fresh": ("UMFPACK, new factors in every iteration", lambda n, steps: host(n, steps, "fresh")),
    "OpenSees": ("9_4_QuadUP, UMFPACK, Newmark 0.6", opensees),
    "OpenGeoSys": ("HYDRO_MECHANICS, SparseLU, backward Euler", opengeosys),
    "Kratos": ("U_Pw, sparse_lu, backward Euler", kratos)}


def timed(python, name, n, steps):
    """Processor seconds of a run in a process of its own, settlement [m] and pressure at the base [kPa] at its end."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as folder:
        before = os.times()
        run = subprocess.run([python, __file__, "--run", name, str(n), str(steps)], cwd=folder, env=environment,
                             capture_output=True, text=True)
        after = os.times()
    answer = re.search(r"^answer (\S+) (\S+)$", run.stdout, re.MULTILINE)
    if run.returncode or not answer:
        raise SystemExit(f"{name}, {n} cells, {steps} steps, ended with code {run.returncode}:\n{run.stdout[-2000:]}\n"
                         f"{run.stderr[-2000:]}")
    return (after.children_user + after.children_system - before.children_user - before.children_system,
            float(answer[1]), float(answer[2]))


def terzaghi(time):
    """Settlement [m] and pressure at the base [kPa]: Terzaghi (1943), as a series."""
    stiffness = YOUNG*(1 - POISSON)/((1 + POISSON)*(1 - 2*POISSON))
    waves = [((2*i + 1)*math.pi/2, (-1)**i) for i in range(400)]
    left = [math.exp(-m**2*MOBILITY*stiffness*time) for m, _ in waves]
    return (-LOAD/stiffness*(1 - sum(2/m**2*e for (m, _), e in zip(waves, left))),
            LOAD*sum(2*sign/m*e for (m, sign), e in zip(waves, left)))


def measured(python, names, sizes, rounds):
    rows = []
    for n, steps in sizes.items():
        runs = {name: [] for name in names}
        for _ in range(rounds):
            for name in names:
                runs[name].append([timed(python if PROGRAMS[name][1] in (opensees, opengeosys, kratos) else sys.executable,
                                         name, n, count) for count in (steps, 3*steps)])
        settlement, pressure = terzaghi(steps*STEP)
        for name in names:
            each = [(long[0] - short[0])/(2*steps) for short, long in runs[name]]
            _, u, p = runs[name][0][0]
            rows.append({"program": name, "method": PROGRAMS[name][0], "unknowns": Grid(n).unknowns(), "steps": steps,
                         "milliseconds": f"{1e3*statistics.median(each):.2f}", "least": f"{1e3*min(each):.2f}",
                         "time": f"{steps*STEP:g}", "settlement_mm": f"{-1e3*u:.5f}", "pressure_kPa": f"{p:.4f}",
                         "settlement_error_percent": f"{100*(u/settlement - 1):.3f}",
                         "pressure_error_percent": f"{100*(p/pressure - 1):.3f}"})
            print(*rows[-1].values(), sep=", ", flush=True)
    return rows


def table(rows):
    """Milliseconds by the number of unknowns, and the answers on the small mesh."""
    sizes = sorted({row["unknowns"] for row in rows})
    taken = {(row["program"], row["unknowns"]): float(row["milliseconds"]) for row in rows}
    lines = [[row["program"], row["method"], *(f"{taken[row['program'], n]:.1f}" for n in sizes),
              f"{row['settlement_mm']} mm ({row['settlement_error_percent']} %)",
              f"{row['pressure_kPa']} kPa ({row['pressure_error_percent']} %)"] for row in rows if row["unknowns"] == sizes[0]]
    return tables.markdown(["program", "method", *(f"{n:,} unknowns" for n in sizes), "settlement", "pressure at the base"], lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peers", type=pathlib.Path, help="folder of the environment with the other programs; else the host alone")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--small", action="store_true", help="the small mesh alone")
    parser.add_argument("--results", type=pathlib.Path, help="folder of column.csv and column.md; otherwise they are printed")
    parser.add_argument("--run", nargs=3, metavar=("PROGRAM", "CELLS", "STEPS"), help="one run, in the folder it is called in")
    given = parser.parse_args()
    if given.run:
        name, n, steps = given.run
        print("answer", *PROGRAMS[name][1](int(n), int(steps)))
        return
    names = list(PROGRAMS) if given.peers else [name for name in PROGRAMS if name.startswith("mud_host")]
    sizes = dict(list(SIZES.items())[:1 if given.small else None])
    processor = re.search(r"model name.*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    machine = (f"{processor[1] if processor else 'Machine'}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the start; "
               f"medians of {given.rounds} rounds.")
    rows = measured(given.peers and given.peers.absolute()/"bin/python3", names, sizes, given.rounds)
    page = tables.wrapped(f"# The host beside other programs\n\nMilliseconds of the processor a step of a consolidating square "
                          f"of elastic soil, made by `column.py`; the answers at {rows[0]['time']} s on the small mesh, beside "
                          f"Terzaghi's series.\n\n{machine}\n\n{table(rows)}")
    print(page)
    if given.results:
        tables.write(given.results/"column.csv", list(rows[0]), [list(row.values()) for row in rows])
        (given.results/"column.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
