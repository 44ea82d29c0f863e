# SPDX-License-Identifier: MIT
"""What accuracy costs: errors of mesh and steps that are those of finer runs, meshes of other fineness, messages."""
import os
import subprocess
import sys

import numpy as np

from checking import build, check, root, work
import tables  # noqa: E402

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
TERZAGHI = root / "verification/host/terzaghi/scene.nml"
BAND = 0.3, 3.0   # of the estimated error over the true one: what the table promises


def run(scene, out, *words):
    return subprocess.run([host, scene, "--output", out, *words], capture_output=True, text=True, env=environment)


def numbers(path):
    return [{name: value if name in ("answer", "state") else float(value) for name, value in row.items()}
            for row in tables.rows(path)]


# A checkpoint belongs to its mesh.
RESTART = root / "tests/host/scenes/restart.nml"


def test_price_ends_well():
    # Consolidation: the mesh error of the scene's own mesh is the distance to a mesh four times as fine.
    done = run(TERZAGHI, work / "price", "--price")
    check("--price ends well", done.returncode == 0, done.stderr)
    rows, answers = numbers(work / "price/price.csv"), numbers(work / "price/price_answers.csv")
    check("five meshes by five steps", len(rows) == 25, len(rows))
    check("the scene as it is stands once", sum(row["is_scene"] for row in rows) == 1)
    check("the parts add up", all(abs(row["error"] - row["mesh_error"] - row["steps_error"] - row["newton_error"])
                                  < 1e-6*row["error"] for row in rows))
    check("finer meshes and steps err less", all(
        one["error"] >= other["error"] for one in rows for other in rows
        if other["mesh"] >= one["mesh"] and other["steps"] <= one["steps"]))
    check("finer meshes take longer", all(one["seconds"] < other["seconds"] for one in rows for other in rows
                                          if one["mesh"] < other["mesh"] and one["steps"] == other["steps"]))
    here, fine = work / "here", work / "fine"
    run(TERZAGHI, here, "--fineness", "1")
    run(TERZAGHI, fine, "--fineness", "4")
    one, other = (tables.columns(folder / "histories.csv") for folder in (here, fine))
    for row in answers:
        if row["state"] == "ok":
            after = one["time"] > one["time"][1]
            far = one[row["answer"]] - np.interp(one["time"], other["time"], other[row["answer"]])
            true = np.max(np.abs(far)[after])
            share = row["mesh_error"]*row["range"]/true
            check(f"mesh error of {row['answer']}", BAND[0] < share < BAND[1], (row, true))
    check("some mesh errors are known", sum(row["state"] == "ok" for row in answers) >= 2, answers)
    quoted = next(row for row in rows if row["mesh"] == 4 and row["steps"] == 1)
    finer = run(TERZAGHI, fine, "--fineness", "4", "--check").stdout
    check("elements of a quote are those of the run", f"{quoted['elements']:.0f} elements" in finer, (quoted, finer))

    # The picture.
    done = subprocess.run([sys.executable, root / "host/plot_run.py", work / "price", "--price"], capture_output=True,
                          text=True)
    check("a picture of the price", done.returncode == 0 and (
        work / "price/price.png").stat().st_size > 10000, done.stderr)
    done = subprocess.run([sys.executable, root / "host/plot_run.py", here, "--price"], capture_output=True, text=True)
    check("no picture of a run without one", done.returncode == 1 and "holds no price" in done.stderr, done.stderr)


def test_a_scene_without_points():
    # What cannot be priced says why.
    text = TERZAGHI.read_text()
    without = work / "without.nml"
    without.write_text("&" + "&".join(part for part in text.split("&")[1:] if not part.startswith("point")))
    done = run(without, work / "none", "--price")
    check("a scene without points", done.returncode == 2 and "give the scene a &point" in done.stderr, done)
    done = run(TERZAGHI, work / "none", "--fineness", "0")
    check("fineness 0", done.returncode == 2 and "fineness" in done.stderr and "0.01" in done.stderr, done)
    done = run(RESTART, work / "restart", "--fineness", "2")
    kept = sorted((work / "restart").glob("checkpoint*.h5"))
    if check("a finer run leaves checkpoints", done.returncode == 0 and kept, done.stderr):
        done = run(RESTART, work / "again", "--restart", kept[0])
        check("and is not taken up on another mesh", done.returncode != 0 and "fineness" in done.stderr, done.stderr)
