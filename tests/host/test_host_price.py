# SPDX-License-Identifier: MIT
"""What accuracy costs: errors of mesh and steps that are those of finer runs, meshes of other fineness, messages."""
import os
import re
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
    # Consolidation: the mesh error of the scene's own mesh is the distance to a mesh three times as fine.
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
    run(TERZAGHI, fine, "--fineness", "3")
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
    check("a finer run leaves checkpoints", done.returncode == 0 and kept, done.stderr)
    done = run(RESTART, work / "restart", "--restart", kept[0])
    check("and is not taken up on another mesh", done.returncode == 17 and "fineness" in done.stderr, done.stderr)


STRIP = root / "verification/studies/price/strip.nml"


def changed(name, **keys):
    """The strip with other values of &scene; None: without the key."""
    text = STRIP.read_text()
    for key, value in keys.items():
        lines = [line for line in text.splitlines() if not line.startswith(f"   {key} =")]
        if value is not None:
            lines.insert(lines.index("&scene") + 1, f"   {key} = {value}")
        text = "\n".join(lines) + "\n"
    scene = work / f"{name}.nml"
    scene.write_text(text)
    return scene


def mixed(path):
    """Rows with numbers where there are numbers."""
    def cell(text):
        try:
            return float(text)
        except ValueError:
            return text
    return [{name: cell(value) for name, value in row.items()} for row in tables.rows(path)]


def test_two_meshes_are_never_enough():
    # The error of the mesh hides behind that of the steps from the second mesh on.
    text = (root / "verification/host/waves/column.nml").read_text()
    for old, new in (("name = 'column'", "name = 'column'\n   accuracy = 0.03\n   mesh = 'auto'"),
                     ("   dt = 0.5e-3\n", ""), ("   tolerance = 1.0e-5\n", ""),
                     ("file = '", f"file = '{root / 'verification/host/waves'}/")):
        check(f"the column has {old!r}", old in text)
        text = text.replace(old, new)
    (work / "column.nml").write_text(text)
    done = run(work / "column.nml", work / "column")
    check("the column has three meshes", done.returncode in (0, 20) and len(mixed(work / "column/levels.csv")) >= 3,
          done.stdout[-600:] + done.stderr)


def test_meshes_are_refined_until_the_accuracy_holds():
    # The strip: what is reached is the distance to a mesh twice as fine as the finest.
    done = run(STRIP, work / "auto", "--accuracy", "0.02")
    check("the accuracy is reached", done.returncode == 0 and "The accuracy is reached" in done.stdout, done.stderr)
    levels = mixed(work / "auto/levels.csv")
    check("each mesh is twice as fine", [row["mesh"] for row in levels] == [0.25*2**k for k in range(len(levels))],
          levels)
    last = levels[-1]
    check("it ends with the first mesh that reaches it", last["error"] <= 0.02 and all(
        row["error"] > 0.02 or row["mesh_state"] == "assumed" for row in levels[1:-1]), levels)
    folder = work / f"auto/mesh_{len(levels)}"
    answers = {row["answer"]: row for row in mixed(folder / "answers.csv")}
    check("its error stands in answers.csv", answers[last["answer"]]["mesh_error"] == last["mesh_error"]
          and answers[last["answer"]]["mesh_state"] == last["mesh_state"], (answers, last))
    run(STRIP, work / "finer", "--fineness", f"{2*last['mesh']:g}")
    one, other = (tables.columns(path / "histories.csv") for path in (folder, work / "finer"))
    for goal in ("centre.u_z", "edge.u_z"):
        far = abs(one[goal][-1]/other[goal][-1] - 1)
        check(f"{goal} is within what was asked", far < 0.02, far)
        check(f"the estimate of {goal} is not too small", answers[goal]["mesh_error"] > BAND[0]*far,
              (answers[goal], far))
    plain = mixed(work / "finer/answers.csv")
    check("a single mesh says that its error is not estimated", all(
        row["mesh_state"] == "not estimated" and row["mesh_error"] == "" for row in plain), plain)


def test_a_budget_stops_before_a_mesh_and_a_restart_goes_on():
    # No mesh of this strip ends within a microsecond; two are needed to tell any error.
    short = changed("short", budget="1e-6")
    done = run(short, work / "short")
    check("the budget ends it", done.returncode == 20 and "The accuracy is not reached" in done.stderr
          and "the budget leaves" in done.stderr, done.stderr)
    levels = mixed(work / "short/levels.csv")
    check("two meshes are there", len(levels) == 2 and (work / "short/mesh_2/histories.csv").exists()
          and not (work / "short/mesh_3").exists(), levels)
    # With another budget the same scene goes on, and makes none of the runs again.
    before = (work / "short/mesh_2/histories.csv").stat().st_mtime_ns
    long = changed("long", budget="100")
    done = run(long, work / "short", "--restart", work / "short/levels.h5")
    check("it goes on", done.returncode == 0 and "The accuracy is reached" in done.stdout, done.stderr)
    check("what was made is left", (work / "short/mesh_2/histories.csv").stat().st_mtime_ns == before)
    whole = run(long, work / "whole")
    check("as without the interruption", whole.returncode == 0, whole.stderr)
    one, other = (mixed(work / f"{name}/levels.csv") for name in ("short", "whole"))
    check("the same meshes and errors", [{k: v for k, v in row.items() if k != "seconds"} for row in one]
          == [{k: v for k, v in row.items() if k != "seconds"} for row in other], (one, other))
    done = run(changed("other", accuracy="0.03"), work / "short", "--restart", work / "short/levels.h5")
    check("another accuracy is another scene", done.returncode == 17 and "another scene" in done.stderr, done.stderr)
    done = run(long, work / "short", "--restart", work / "short/levels.h5", "--check")
    check("--check says that it fits", done.returncode == 0 and "fits" in done.stdout, done)


def test_contradictions_of_a_refinement_are_refused():
    for what, words, *options in (
            (changed("none", accuracy=None), "needs accuracy"),
            (changed("goal", goals="'centre.u_x'"), "there is no answer 'centre.u_x'"),
            (changed("held", goals="'centre.u_r'"), "'centre.u_r' is prescribed"),
            (changed("thrust", goals="'strip.thrust'"), "meshes are not compared by the peaks of a thrust"),
            (STRIP, "leave --verify out", "--verify")):
        done = run(what, work / "refused", *options)
        check(f"refused: {words}", done.returncode == 2 and words in done.stderr, done.stderr)
    text = STRIP.read_text().replace("z_ratio = 0.8", "z_ratio = 0.8\n   fineness = 2")
    (work / "both.nml").write_text(text)
    done = run(work / "both.nml", work / "refused")
    check("a fineness beside it", done.returncode == 2 and "contradict" in done.stderr, done.stderr)
    done = run(STRIP, work / "refused", "--restart", work / "both.nml")
    check("a text is no levels.h5", done.returncode == 17 and "levels.h5" in done.stderr, done.stderr)


def test_fineness_asks_for_one_mesh():
    done = run(STRIP, work / "one", "--fineness", "1")
    check("one mesh by --fineness", done.returncode == 0 and (work / "one/histories.csv").exists()
          and "mesh not estimated: --price" in done.stdout, done.stdout)


# Errors of a run: what they contain, and what not.
SAND = """&scene name = 's' fields = 'u' gravity = 9.81 /
&mesh r = 0, 0.5, 2 r_cells = 1, 2 z = -2, 0 z_cells = 2 /
&mud name = 'sand' e_0 = 0.75 /
&region material = 'sand' /
&initial stress = 'geostatic' k_0 = 0.5 surcharge = 1 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = 1 /
&load group = 'top_1' kind = 'pressure' value = 20 /
&point name = 'c' r = 0 z = 0 /
"""
ELASTIC = SAND.replace("&mud name = 'sand' e_0 = 0.75 /", "&elastic name = 'sand' young = 1e4 poisson = 0.3 /").replace(
    "&region material = 'sand' /", "&region material = 'sand' void_ratio = 0.75 rho_s = 2.65 /")
MOVING = ELASTIC.replace("'static' duration = 1 dt = 1", "'dynamic' duration = 0.05")
LAST = {"sand at once": (SAND, (), "steps 0 % without what came in single steps, Newton's method ",
                         "; mesh not estimated: --price; nor is the stress integration."),
        "sand by a history": (SAND.replace("value = 20", "value = 20 history = 'ramp'").replace("dt = 1 ", ""),
                              (), "steps ", "; mesh not estimated: --price; nor is the stress integration."),
        "elastic": (ELASTIC, (), "steps 0 %, Newton's method ", "%; mesh not estimated: --price."),
        "elastic, dynamic": (MOVING, (), "steps ", "%; mesh not estimated: --price."),
        "elastic, dynamic, verified": (MOVING, ("--verify",), "steps ", "%; mesh not estimated: --price.")}


def test_every_run_says_what_its_errors_contain():
    for name, (text, words, begins, ends) in LAST.items():
        path = work / f"last_{name.replace(', ', '_').replace(' ', '_')}.nml"
        path.write_text(text)
        done = run(path, path.with_suffix(""), *words)
        said = next((line for line in done.stdout.splitlines() if line.startswith("In these errors: ")), "")
        check(f"{name}: runs", done.returncode == 0, done.stderr)
        check(f"{name}: what is in its errors", said.startswith(f"In these errors: {begins}") and said.endswith(ends),
              said)
        check(f"{name}: single steps", ("single steps" in said) == (name == "sand at once"), said)
        check(f"{name}: measured is said where it is", (" % (measured), " in said) == bool(words), said)
        check(f"{name}: vibrations", ("Not seen: vibrations" in done.stdout) == (text == MOVING and not words),
              done.stdout)
        rows = tables.rows(path.with_suffix("") / "answers.csv")
        row = next((r for r in rows if r["answer"] == "c.u_z"), {})
        told = [float(number) for number in re.findall(r"([0-9.e-]+) %", said)]
        check(f"{name}: answers.csv has the same parts", row and len(told) == 2 and np.allclose(
            [100*float(row["estimated_error"]), 100*float(row["newton_error"])], told, rtol=1e-3, atol=1e-12)
              and row["mesh_state"] == "not estimated" and row["mesh_error"] == "", (row, said))


def test_a_point_keeps_its_node_on_every_mesh():
    # (1.229, 0.5) is no node of the file: the one that is nearest there is taken on split meshes, too.
    ring = root / "verification/studies/price/ring.nml"
    places = []
    for fineness in ("1", "4"):
        done = run(ring, work / f"ring{fineness}", "--fineness", fineness, "--accuracy", "0.3", "--check")
        said = next(line for line in done.stderr.splitlines() if "point inside" in line)
        places.append(said.split("node at ")[1].split(" m and")[0])
    check("one node", places[0] == places[1], places)
