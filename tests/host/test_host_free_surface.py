# SPDX-License-Identifier: MIT
"""Dry loose sand without a surcharge: void that opens beside a footing is a gap, not void ratio of the soil, and the
run goes on; taken up again at the gap it gives the same bytes."""
import os
import shutil
import subprocess

from checking import at_length, build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

environment = {**os.environ, "OMP_NUM_THREADS": "1"}
C_H, SINKS = 0.968, 0.03
SCENE = f"""&scene name = 'f' gravity = 9.81 checkpoint_steps = 6 /
&mesh r = 0, 0.5, 4 r_cells = 4, 6 r_ratio = 0.85, 1.3 z = -4, -1, 0 z_cells = 4, 5 z_ratio = 0.75, 0.85 /
&mud name = 's' file = '{root / "drivers/materials/toyoura.nml"}' /
&region material = 's' void_ratio = 0.907 /
&initial stress = 'geostatic' k_0 = 0.5 surcharge = 0 /
&history name = 'h' times = 1, 4 values = 0, 1 /
&stage name = 'geo' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-5 zero_displacements = 'yes' /
&stage name = 'push' analysis = 'static' duration = 3 fields = 0 /
&fix group = 'top_1' field = 'u_z' value = {-SINKS} history = 'h' stages = 'push' /
&fix group = 'top_1' field = 'u_r' stages = 'push' /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 'c' r = 0 z = 0 /
"""


def run(name, *more):
    path = work / "scene.nml"
    path.write_text(SCENE)
    done = subprocess.run([build / "host/mud_host", path, "--output", work / name, "--quiet", *more],
                          capture_output=True, text=True, env=environment)
    check(f"{name}: the footing sinks to its end", done.returncode == 0, done.stderr)
    return tables.numbers(work / name / "histories.csv") if done.returncode == 0 else []


@at_length
def test_the_footing_sinks_and_grains_part_beside_it():
    # 3 cm are given. Soil is at its loosest at 1/c_h; without a gap the void ratio of the soil would reach its bound.
    rows = run("footing")
    check("it is 3 cm below where it was", rows and abs(rows[-1]["c.u_z"] + SINKS) < 1e-12, rows[-1:])
    largest = max(row["e"] for row in tables.numbers(work / "footing" / "points_push.csv"))
    check("grains part somewhere: void beyond 1/c_h", largest > 1/C_H + 0.5, largest)
    shutil.copytree(work / "footing", work / "again")
    os.utime(work / "again" / "points_push.csv", (0, 0))
    run("again", "--restart", work / "again" / "checkpoint.h5")
    check("taken up again, it is written anew", (work / "again" / "points_push.csv").stat().st_mtime > 0)
    for name in ("points_push.csv", "nodes_push.csv"):
        check(f"taken up again, {name} is the same", (work / "again" / name).read_bytes()
              == (work / "footing" / name).read_bytes())
