# SPDX-License-Identifier: MIT
"""Named points of mud_host lie where the scene says, between nodes too: every mesh tells of the same place."""
import math
import os
import subprocess

from checking import build, check, work
import tables  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
# Under its own weight, without lateral strain, a column of height 1 settles by rho g (z - z**2/2)/E: quadratic, as the
# elements are. The pressure is hydrostatic: linear.
HEAVY = """&scene name = 'heavy' geometry = 'plane_strain' fields = 'u-p_w' gravity = 10 pressures = '{pressures}' /
&mesh r = 0, 0.7 r_cells = 2 z = 0, 1 z_cells = 3 z_ratio = 0.8 /
&elastic name = 'm' young = 1e9 poisson = 0 /
&permeability name = 'k' intrinsic = 1e-10 law = 'constant' /
&region material = 'm' rho_s = 3 void_ratio = 1 permeability = 'k' /
&initial p_w = 10 p_w_slope = -10 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-10 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&point name = 'between' r = {r} z = {z} /
"""


def run(name, text, *words):
    scene = work / f"{name}.nml"
    scene.write_text(text)
    done = subprocess.run([host, scene, "--output", work / name, "--quiet", *words], capture_output=True, text=True,
                          env=environment)
    check(f"{name} runs", done.returncode == 0, done.stderr)
    return {key: values[-1] for key, values in tables.columns(work / name / "histories.csv").items()}


def test_a_point_between_nodes_is_interpolated():
    # Buoyant density (3 - 1)/2 = 1.
    for pressures in ("quadratic", "linear"):
        for r, z in ((0.231, 0.417), (0.7, 0.93), (0.35, 0.9), (0.05, 0.0123)):
            for fineness in ("0.5", "1", "2"):
                name = f"{pressures}_{r}_{z}_{fineness}"
                row = run(name, HEAVY.format(pressures=pressures, r=r, z=z), "--fineness", fineness)
                settles = -10*(z - z*z/2)/1e9
                check(f"{name}: settlement", abs(row["between.u_z"]/settles - 1) < 1e-6, (row["between.u_z"], settles))
                check(f"{name}: pressure", abs(row["between.p_w"] - 10*(1 - z)) < 1e-9, row["between.p_w"])
    place = tables.rows(work / name / "points.csv")[0]
    check("points.csv says the place of the scene", (float(place["r"]), float(place["z"])) == (0.05, 0.0123), place)


def test_a_rounded_place_on_the_edge_is_that_place():
    # 1.0003 for a surface at 1: the element goes on beyond it.
    row = run("rounded", HEAVY.format(pressures="quadratic", r=0.1, z=1.0003))
    settles = -10*(1.0003 - 1.0003**2/2)/1e9
    check("a point just outside", abs(row["between.u_z"]/settles - 1) < 1e-6, (row["between.u_z"], settles))


def test_of_equally_near_quadrature_points_the_first_has_the_stress():
    # Around an inner node several quadrature points are equally near but for rounding.
    places = [(r, z) for r in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6) for z in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)]
    text = HEAVY.format(pressures="linear", r=0, z=0) \
        .replace("r_cells = 2 z = 0, 1 z_cells = 3 z_ratio = 0.8", "r_cells = 7 z = 0, 0.7 z_cells = 7")
    run("near", text + "".join(f"&point name = 'p{i}' r = {r} z = {z} /\n" for i, (r, z) in enumerate(places)))
    points = tables.numbers(work / "near/points_s.csv")
    for place in tables.rows(work / "near/points.csv")[1:]:
        far = [math.hypot(p["r"] - float(place["r"]), p["z"] - float(place["z"])) for p in points]
        first = next(p for p, d in zip(points, far) if d < min(far)*(1 + 1e-9))
        check(f"{place['name']} stands at the first", (float(place["stress_r"]), float(place["stress_z"]))
              == (first["r"], first["z"]), (place, first))
