# SPDX-License-Identifier: MIT
"""Writes reference.csv and mesh.msh of every case from the closed forms of the pages of verification/host.

`make.py FOLDER` writes into that folder, `make.py --update` into this one.
"""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
VERIFICATION = HERE.parent
sys.path[:0] = [str(VERIFICATION), str(VERIFICATION.parent / "common")]
from tools import runner, tables  # noqa: E402
from tools.gmsh import Mesh, text  # noqa: E402


def page(name):
    """The module of a page of verification/host, with its closed forms."""
    return runner.load(f"host/{name}")


def rows(quantity, t, values, x="", y=""):
    """Rows of reference.csv; x and y: numbers, or arrays as long as the values."""
    t, values = np.atleast_1d(t), np.atleast_1d(values)
    x, y = (a if isinstance(a, str) else np.broadcast_to(a, values.shape) for a in (x, y))
    return [(quantity, repr(float(s)), x if isinstance(x, str) else repr(float(x[i])),
             y if isinstance(y, str) else repr(float(y[i])), repr(float(v)))
            for i, (s, v) in enumerate(zip(np.broadcast_to(t, values.shape), values))]


# ---- meshes


def line(*parts):
    """Places of corners: parts (begin, end, cells, ratio of the last cell to the first one's power of cells)."""
    places = [parts[0][0]]
    for begin, end, cells, ratio in parts:
        lengths = ratio ** np.arange(cells)
        places += list(begin + (end - begin) * np.cumsum(lengths) / lengths.sum())
    return np.array(places)


def rectangle(x, y, names=()):
    """A Gmsh mesh of quadratic triangles with the boundaries left, right, bottom, top and the body soil. names: more
    boundaries, each a name, a side and a test of the middle of an edge."""
    mesh = Mesh()
    mesh.block("soil", x, y)
    edges = {"left": mesh.edges["axis"], "right": mesh.edges["soil_side"],
             "bottom": mesh.edges["soil_bottom"], "top": mesh.edges["soil_top"]}
    for name, side, inside in names:
        taken = [edge for edge in edges[side] if inside(*mesh.points[edge[2]])]
        edges[name] = taken
        edges[side] = [edge for edge in edges[side] if edge not in taken]
    return text(mesh.points, mesh.cells, edges)


# ---- cases: (mesh, rows)


def terzaghi():
    found = []
    data = [r for r in tables.rows(VERIFICATION / "host/terzaghi/terzaghi.csv", header_in_comment=True)
            if r["case"] == "soft_water" and r["ramped"] == "0" and float(r["t"]) < 100]
    for quantity, depth in (("p_w_base", 1.0), ("p_w_middle", 0.5)):
        at = [r for r in data if float(r["depth"]) == depth]
        found += rows(quantity, [float(r["t"]) for r in at], [float(r["p_w"]) for r in at])
    at = [r for r in data if float(r["depth"]) == 0]
    found += rows("settlement", [float(r["t"]) for r in at], [float(r["settlement"]) for r in at])
    return rectangle(line((0, 0.1, 1, 1)), line((0, 0.5, 16, 1), (0.5, 1, 24, 0.87))), found


COLUMN = (line((0, 0.1, 1, 1)), line((0, 1, 40, 1)))
HOURS = np.arange(1000.0, 20001.0, 1000.0)


def conductivity(faces, z, before, after):
    """K/K_s after the rain changes from one share of K_s to another: the problem is linear in K."""
    steady = after - (after - 1) * np.exp(-faces.ALPHA * z)
    long = 0.9 + 0.1 * np.exp(-faces.ALPHA * z)
    return steady + (after - before) / 0.8 * (faces.series(z, HOURS, 0.9) - long)


def rain(before, after):
    faces = page("seepage_face")
    found = []
    for quantity, z in (("p_w_top", 1.0), ("p_w_middle", 0.5)):
        found += rows(quantity, HOURS, 10 / faces.ALPHA * np.log(conductivity(faces, z, before, after)))
    return rectangle(*COLUMN), found


def ponding():
    faces = page("seepage_face")
    begin, end = 1.0, 1e5
    for _ in range(60):
        middle = (begin + end) / 2
        begin, end = (middle, end) if faces.series(1.0, middle, 1.5)[0] < 1 else (begin, middle)
    t = HOURS[HOURS > begin + 360]
    return rectangle(*COLUMN), rows("ponding_time", begin, begin) + rows(
        "run_off", t, faces.CONDUCTIVITY * faces.run_off(t, 1.5))


def liakopoulos():
    data = [r for r in tables.rows(VERIFICATION / "host/liakopoulos/liakopoulos.csv")
            if r["variant"] == "no_gradient" and float(r["t"]) in (4800, 7200)]
    found = []
    for quantity, column, scale, shift in (("p_c", "p_c", 1e-3, 0), ("p_a", "p_a", 1e-3, -101325), ("u_z", "u", 1, 0)):
        for r in data:
            if abs(float(r["z"]) / 0.025 - round(float(r["z"]) / 0.025)) > 1e-6:
                continue   # between the nodes of the mesh
            found += rows(quantity, float(r["t"]), scale * (float(r[column]) + shift), 0.0, float(r["z"]))
    return rectangle(line((0, 0.1, 1, 1)), line((0, 1, 20, 1))), found


def well():
    seepage, x = page("seepage"), line((0.2, 20, 12, 1.4))
    mesh = rectangle(x, line((0, 5, 2, 1)))
    return mesh, rows("discharge", 1e9, 2 * np.pi * 5 * seepage.K * 30 / np.log(100)) + rows(
        "p_w", 1e9, 30 * np.log(x[1:-1] / 0.2) / np.log(100), x[1:-1], 0.0)


def pile():
    seepage = page("seepage")
    mesh = rectangle(line((0, 0.5, 12, 1), (0.5, 4, 12, 1.2)), line((-1, -0.5, 12, 1), (-0.5, 0, 12, 1)),
                     [("below_pile", "left", lambda x, y: y < -0.5)])
    return mesh, rows("discharge", 1e9, seepage.below_pile(0.5))


def dam():
    faces, found = page("seepage_face"), []
    for stage, low in (("empty", 0.0), ("tail", 4.0)):
        found += rows(f"discharge_{stage}", 1e10, faces.CONDUCTIVITY * (faces.HIGH**2 - low**2) / (2 * faces.WIDTH))
    return rectangle(line((0, 16, 16, 1)), line((0, 24, 24, 1))), found


def shear_wave():
    waves = page("waves")
    rho = 2.65 / (1 + waves.VOIDS)
    c = np.sqrt(waves.SHEAR / rho)
    t = np.round(np.arange(0.0, 0.4001, 0.005), 6)
    since = np.clip((t - 10 / c) / waves.PULSE, 0, 1)
    force = waves.LOAD * (1 - np.cos(2 * np.pi * since)) / 2
    return rectangle(line((0, 0.25, 1, 1)), line((0, 20, 40, 1))), rows("velocity", t, force / (rho * c))


def dynamic_consolidation():
    closed, found = page("dynamic_consolidation"), []
    t = np.round(np.arange(0.002, 0.0601, 0.002), 6)
    for quantity, depth in (("u_surface", 0.0), ("u_deep", 1.0)):
        found += rows(quantity, t, closed.displacement(depth, t, False))
    return rectangle(line((0, 0.1, 1, 1)), line((-8, -3, 80, 1), (-3, 0, 120, 1))), found


def unsaturated_wave():
    """A standing wave of wave number k: linear equations of strain, its rate, p_w and p_c, by eigenvectors."""
    wave = page("seepage_inertia")
    k, speed, p_c, modulus = 125.0, 1e-6, 3.0, 1.3e4
    e = wave.E0
    a = (p_c * e**2 / 5) ** 2
    log_sum = np.log(np.e + a)
    s = 1 / log_sum
    slope = -s / log_sum * a / (np.e + a) * 2
    s_p, s_v, n = slope / p_c, slope * 2 / e * (1 + e), e / (1 + e)
    kw = wave.PERMEABILITY / wave.ETA_W * max(s**3, 1e-4)
    ka = wave.PERMEABILITY / wave.ETA_A * max((1 - s) ** 2 * (1 - s**2), 1e-4)
    rho = (1 - n) * wave.RHO_S + n * s * wave.RHO_W + n * (1 - s) * wave.RHO_A
    air = n * (1 - s) / wave.K_A
    # Both balances of mass: `storage` (p_w, p_c)' + `swell` strain' + k**2 `flow` (p_w, p_c) = 0.
    storage = np.array([[n * s / wave.K_W + air, air], [air, air - n * s_p]])
    swell, flow = np.array([1.0, (1 - s) - n * s_v]), np.array([[kw + ka, ka], [ka, ka]])
    system = np.zeros((4, 4))
    system[0, 1] = 1
    system[1, [0, 2, 3]] = -k * k / rho * np.array([modulus + p_c * s_v, -1, -(1 - s) + p_c * s_p])
    system[2:, 1] = -np.linalg.solve(storage, swell)
    system[2:, 2:] = -k * k * np.linalg.solve(storage, flow)
    values, vectors = np.linalg.eig(system)
    # v_z = speed sin(k z): the rate of the volume strain is speed k cos(k z).
    share = np.linalg.solve(vectors, np.array([0, speed * k, 0, 0]))
    t = np.round(np.arange(0, 0.00401, 0.0001), 7)
    y = (vectors @ (share[:, None] * np.exp(np.outer(values, t)))).real
    mesh = rectangle(line((0, 0.002, 1, 1)), line((0, np.pi / k, 12, 1)))
    return mesh, rows("velocity", t, y[1] / k) + rows("p_w_change", t, y[2]) + rows("p_c_change", t, y[3])


def indentation():
    half, far = [(0, 0.15, 10, 0.75), (0.15, 0.3, 10, 4 / 3)], (0.3, 24, 18, 1.3)
    down = line((-24, -0.3, 18, 1 / 1.3), (-0.3, -0.15, 4, 0.75), (-0.15, 0, 10, 0.75))
    mesh = rectangle(line(*half, far), down, [("plate", "top", lambda x, y: x < 0.15)])
    return mesh, rows("force", 1.0, 2 * 1e4 * 0.15 * 1e-3 / (1 - 0.3**2))


CASES = {"terzaghi": terzaghi, "infiltration": lambda: rain(0.1, 0.9), "drainage": lambda: rain(0.9, 0.1),
         "ponding": ponding, "liakopoulos": liakopoulos, "well": well, "sheet_pile": pile, "dam": dam,
         "shear_wave": shear_wave, "dynamic_consolidation": dynamic_consolidation,
         "unsaturated_wave": unsaturated_wave, "indentation": indentation}


def main():
    if "-h" in sys.argv or "--help" in sys.argv:
        print(__doc__)
        return
    if len(sys.argv) != 2 or (sys.argv[1].startswith("-") and sys.argv[1] != "--update"):
        sys.exit(__doc__)
    target = HERE if sys.argv[1] == "--update" else pathlib.Path(sys.argv[1])
    for name, make in CASES.items():
        mesh, found = make()
        folder = target / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "mesh.msh").write_text(mesh, encoding="utf-8")
        tables.write(folder / "reference.csv", ("quantity", "t", "x", "y", "value"), found,
                     [f"{name}: made by make.py; m, s, kPa, kN; units of each quantity are in case.toml"])
        print(f"{name}: {len(found)} values")


if __name__ == "__main__":
    main()
