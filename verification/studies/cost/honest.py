# SPDX-License-Identifier: MIT
"""Is the estimated error of an answer the true one? Runs scenes and cases with an accuracy, and against what is known:
a closed form, or given fine steps on the same mesh. Writes honest.csv; resumable, a scene whose rows are there is left.

    verification/run studies/cost --make --only honest.py [--pass SCENE...]

References go to build/cost/honest and serve again. Seven CPU minutes.
"""
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import time

import numpy as np

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
sys.path[:0] = [str(root / "common"), str(root / "verification")]
import tables  # noqa: E402
from tools import results  # noqa: E402

build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
NAMES = ("scene", "accuracy", "steps", "answer", "change", "true_error", "estimated_error", "ratio")
HOST, HERE = "verification/host/", "verification/studies/cost/scenes/"
FINE_FLOW = [("dt = 1.0e-3", "dt = 1e-5"), ("dt_growth = 1.03", "dt_growth = 1.005")]
FREE_FLOW = [("   dt = 1.0e-3\n", ""), ("   dt_growth = 1.03\n", "")]
STEPS_OF_LIAKOPOULOS = [(r"dt = 0.1\n", "dt = 0.01\n"), (r"dt = 1\n", "dt = 0.1\n"), (r"dt = 5\n", "dt = 0.5\n"),
                        (r"dt = 30\n", "dt = 3\n"), (r"dt_max = 5\n", "dt_max = 0.5\n"),
                        (r"dt_max = 10\n", "dt_max = 1\n"), (r"dt_max = 30\n", "dt_max = 6\n")]


def references():
    """Where runs with fine steps serve again, to the same programs."""
    return results.current(build.parent / "cost/honest", build)


def swing(time):
    """Free vibration of verification/host/vibration: released at t = 1 s from 12 kN on a spring of 12000 kN/m, 3 Mg."""
    return {"top.u_z": np.where(time < 1, -time, -np.cos(np.sqrt(4000.0)*(time - 1)))*1e-3}


# The indentation at 30 kPa on a coarse mesh and while the load acts: the bounces after it are chaotic.
INDENTATION = "verification/studies/indentation/indent_s030.nml"
COARSE = [("duration = 0.03999", "duration = 0.028"), ("r_cells = 6, 8", "r_cells = 3, 4"),
          ("r_ratio = 1, 1.35", "r_ratio = 1, 1.8225"), ("z_cells = 7, 7", "z_cells = 4, 4"),
          ("z_ratio = 0.76, 0.9", "z_ratio = 0.5776, 0.81")]
FINE_IMPACT = [("rho_inf = 0.8", "rho_inf = 0"), ("dt = 3.0e-5", "dt = 7.5e-6"),
               ("tolerance = 1.0e-3", "tolerance = 1e-6"),
               ("   tangent = 2\n", "   tangent = 2\n   tolerance = 1e-7\n   scheme = 2\n")]
# What the paper's settings give by hand is left open.
FREE_IMPACT = [("   rho_inf = 0.8\n", ""), ("   tolerance = 1.0e-3\n", ""), ("   dt = 3.0e-5\n", "")]

# Name: scene, changes of both runs, changes of the reference (or its closed form), changes of the run with an
# accuracy, accuracies.
THREE = ("1e-1", "1e-2", "1e-3")
TWO = THREE[:2]
SCENES = {
    "vibration": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "")], swing, [], THREE),
    "vibration, rho_inf 1": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "rho_inf = 1")], swing, [], TWO),
    "vibration, rho_inf 0": (HOST + "vibration/scene.nml", [("rho_inf = 0.8", "rho_inf = 0")], swing, [], THREE),
    "bar on a wall": (HOST + "contact/bar.nml", [("rho_inf = 0.8", ""), ("duration = 1.5e-3", "duration = 6e-4")],
                      [("dt = 2.0e-6", "dt = 2e-7")], [], TWO),
    "bar, leaves again": (HOST + "contact/bar.nml", [("rho_inf = 0.8", "")], [("dt = 2.0e-6", "dt = 2.5e-7")], [], TWO),
    "falling plate": (HOST + "contact/fall.nml", [("rho_inf = 0.8", ""), ("duration = 0.006", "duration = 0.003")],
                      [("dt = 1.0e-5", "dt = 1e-6")], [], TWO),
    "dynamic consolidation": (HOST + "dynamic_consolidation/scene.nml", [], [("dt = 1.0e-4", "dt = 2e-5")], [], TWO),
    "Terzaghi": (HOST + "terzaghi/scene.nml", [("   dt_max = 1\n", "")], FINE_FLOW, FREE_FLOW, THREE),
    "Terzaghi, equal order": (HOST + "terzaghi/scene.nml", [
        ("   dt_max = 1\n", ""), ("pressures = 'linear'", "pressures = 'quadratic'")], FINE_FLOW, FREE_FLOW, TWO),
    "Mandel": (HERE + "mandel.nml", [], FINE_FLOW, FREE_FLOW, THREE),
    "Mandel, equal order": (HERE + "mandel.nml", [("pressures = 'linear'", "pressures = 'quadratic'")], FINE_FLOW,
                            FREE_FLOW, TWO),
    "rain for five days": (HERE + "rain.nml", [], [("dt = 100", "dt = 100\n   steps = 'given'")],
                           [("   dt = 100\n", "")], THREE),
    "Liakopoulos": (HOST + "liakopoulos/scene.nml", [], STEPS_OF_LIAKOPOULOS,
                    [(r"   dt(_growth|_max)? = \S+\n", "")], TWO),
    "footing on sand, static": (HERE + "footing.nml", [], [], [("   dt = 0.004\n", "")], THREE),
    "column shaken at its base": (HOST + "waves/layers.nml", [("duration = 4", "duration = 1.5")],
                                  [("dt = 2.0e-3", "dt = 2e-4")], [("rho_inf = 1.0", "rho_inf = 0.8")], TWO),
    "three fields of MUD": ("tests/host/scenes/restart.nml", [
        ("checkpoint_steps = 2", ""), ("max_iterations = [35]", "max_iterations = 9")],
        [(r"duration = 0.3\n   dt = 1.0e-3\n   dt_growth = 1.3",
          "duration = 0.3\n dt = 1e-7\n dt_growth = 1.02\n dt_max = 2e-3\n rho_inf = 0"),
         (r"duration = 0.03\n   dt = 1.0e-3", "duration = 0.03\n   dt = 2e-5")], [], TWO),
    # Scenes that nothing was tuned with.
    "harmonic load, damped": (HERE + "harmonic.nml", [], [], [("   dt = 2.5e-4\n", "")], TWO),
    "harmonic load, strongly damped": (HERE + "harmonic.nml", [("damping = 6.3", "damping = 30")], [],
                                       [("   dt = 2.5e-4\n", "")], TWO),
    "harmonic load, undamped": (HERE + "harmonic.nml", [("   damping = 6.3\n", ""), ("duration = 2", "duration = 0.5")],
                                [("dt = 2.5e-4", "dt = 5e-5")], [("   dt = 2.5e-4\n", "")], TWO),
    "footing on dense sand": (HERE + "sand.nml", [], [], [("   dt = 0.0025\n   tolerance = 1.0e-6\n", "")], TWO),
    "footing on loose sand": (HERE + "sand.nml", [("e_0 = 0.65", "e_0 = 0.85"), ("value = 80", "value = 30")], [],
                              [("   dt = 0.0025\n   tolerance = 1.0e-6\n", "")], TWO),
    "plate pushed into sand": (HERE + "push.nml", [], [], [("   dt = 0.005\n   tolerance = 1.0e-6\n", "")], THREE),
    "plate falls 2 cm": (HERE + "drop.nml", [], [], [("   dt = 4.0e-6\n", "")], TWO),
    "plate falls 2 mm": (HERE + "drop.nml", [("z = 0.02\n", "z = 0.002\n")], [], [("   dt = 4.0e-6\n", "")], TWO),
    "indentation at 30 kPa": (INDENTATION, COARSE, FINE_IMPACT, FREE_IMPACT, THREE),
    # The same with the default memory, whose elastic domain does not turn with every vibration.
    "indentation, elastic domain": (INDENTATION, COARSE + [("   memory_rule = 1\n", ""), ("   rho_e = 0.0\n", "")],
                                    FINE_IMPACT, FREE_IMPACT, THREE),
}
# Paths of the driver: material's keys, start, stage.
PATHS = {
    "driver: drained": ("p_eff = 100 void_ratio = 0.833", "control = 'drained' eps_a_end = 0.05"),
    "driver: undrained": ("p_eff = 100 void_ratio = 0.833", "control = 'undrained' eps_a_end = 0.05"),
    "driver: stress cycles": ("p_eff = 100 void_ratio = 0.735",
                              "control = 'undrained' cycle_by = 'q' amplitude = 15 cycles = 2"),
    "driver: constant water": ("p_eff = 100 void_ratio = 0.8 suction = 50",
                               "control = 'drained' water = 'constant' eps_a_end = 0.02"),
}


def changed(text, changes):
    for old, new in changes:
        if not re.search(old, text):
            raise ValueError(f"{old} is not in the scene")
        text = re.sub(old, new, text)
    return text


def run(text, beside, folder, *words):
    """Why it failed, or nothing. The scene's relative paths become absolute."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = folder / "scene.nml"
    scene.write_text(re.sub(r"file = '(?!/)([^']+)'", lambda m: f"file = '{beside / m[1]}'", text), encoding="utf-8")
    done = subprocess.run([build / "host/mud_host", scene, "--output", folder, "--quiet", *words], text=True,
                          capture_output=True, env={**os.environ, "OMP_NUM_THREADS": "1"})
    return done.stderr.strip() if done.returncode not in (0, results.MISSED) else ""


def row(name, accuracy, steps, answer, change, true, estimate):
    return (name, accuracy, steps, answer, f"{change:.3g}", f"{true:.2g}", f"{estimate:.2g}",
            f"{true/estimate:.2g}" if estimate > 0 else "")


def failed(name, accuracy, said):
    return (name, accuracy, 0, "failed: " + " ".join(said.split())[:120].replace(",", ";"), "", "", "", "")


def of_run(folder, answer):
    """Times and values of an answer of a run: a column of its histories, a force of a support, a thrust."""
    if ": " in answer:
        stage, column = answer.split(": ")
        rows = tables.columns(folder / f"reactions_{stage}.csv")
        return rows["time_of_forces"], rows[column]
    rows = tables.columns(folder / ("contact.csv" if answer.endswith(".thrust") else "histories.csv"))
    return rows["time"], rows[answer]


def is_force(answer):
    """Whether an answer is a force of a support or a thrust."""
    return ": " in answer or answer.endswith(".thrust")


def contacts(time, thrust):
    """First and last row of every time that the contact is closed; a gap shorter than the contact before it is none."""
    closed = np.flatnonzero(thrust)
    spans = []
    for row in closed:
        if spans and (row == spans[-1][1] + 1 or time[row] - time[spans[-1][1]] <= time[spans[-1][1]] - time[spans[-1][0]]):
            spans[-1][1] = row
        else:
            spans.append([row, row])
    return spans


def apart(folder, other, answer):
    """Largest distance of an answer of two runs: of histories at the times of the first within those of the other, of
    thrusts that of their peaks."""
    (time, one), (other_time, two) = of_run(folder, answer), of_run(other, answer)
    if not answer.endswith(".thrust"):
        slack = 1e-9*(other_time[-1] - other_time[0])
        common = (time >= other_time[0] - slack) & (time <= other_time[-1] + slack)
        return np.max(np.abs(one - np.interp(time, other_time, two))[common])
    spans, distances = contacts(time, one), [0.0]
    ends = [-np.inf, *((time[a[1]] + time[b[0]])/2 for a, b in zip(spans, spans[1:])), np.inf]
    for (first, last), begin, end in zip(spans, ends, ends[1:]):
        there = np.abs(two[(other_time >= begin) & (other_time < end)])
        distances.append(abs(np.max(np.abs(one[first:last + 1])) - np.max(there, initial=0)))
    return max(distances)


def reference(name, folder):
    """The distance of an answer of a run to the run with given fine steps, or to a closed form, as a function of its
    folder and the answer; nothing where the closed form does not say."""
    path, both, known, _, _ = SCENES[name]
    if callable(known):
        def off(out, answer):
            time, values = of_run(out, answer)
            exact = known(time).get(answer)
            return None if exact is None else np.max(np.abs(values - exact))
        return off
    text = changed((root / path).read_text(encoding="utf-8"), both + known)
    fine = folder / hashlib.sha256(text.encode()).hexdigest()[:12]
    if not (fine / "done").exists():
        said = run(text, (root / path).parent, fine)
        if said:
            raise RuntimeError(said)
        (fine / "done").touch()
    return lambda out, answer: apart(out, fine, answer)


def scene_rows(name, accuracies=None, folder=None):
    """Every answer at every accuracy."""
    path, both, _, free, asked = SCENES[name]
    folder = pathlib.Path(folder or references()) / re.sub(r"\W+", "_", name)
    try:
        off = reference(name, folder)
    except RuntimeError as said:
        return [failed(name, "reference", str(said))]
    text = changed((root / path).read_text(encoding="utf-8"), both + free)
    rows = []
    for accuracy in accuracies or asked:
        out = folder / f"a{accuracy}"
        if said := run(text, (root / path).parent, out, "--accuracy", accuracy):
            rows.append(failed(name, accuracy, said))
            continue
        steps = len(tables.columns(out / "histories.csv")["time"]) - 1
        for answer in tables.rows(out / "answers.csv"):
            at, change = answer["answer"], float(answer["largest_change"])
            distance = off(out, at)
            if distance is not None:
                rows.append(row(name, accuracy, steps, at, change, distance/change, float(answer["estimated_error"])))
    return rows


def path_rows(name, accuracies=("3e-2", "1e-3")):
    """The history of a path of the driver against increments of 2e-6, tolerance 1e-10, another scheme: at the rows that
    both write, which are the ends of the ways where stress turns."""
    start, stage = PATHS[name]
    folder = references() / "driver"
    folder.mkdir(parents=True, exist_ok=True)
    case, out = folder / "case.nml", folder / "out.csv"
    cycles = "cycle_by" in stage

    def call(more, given, *words):
        case.write_text(f"&material file = '{root}/drivers/materials/toyoura.nml' {more} /\n&initial {start} /\n"
                        f"&stage {stage} output_interval = 1e-3 {given} /\n", encoding="utf-8")
        done = subprocess.run([build / "drivers/mud_triax", case, "--output", out, *words], text=True,
                              capture_output=True, check=True)
        rows = tables.columns(out)
        if cycles:   # between the ends of ways the rows of two runs are not the same
            turns = np.r_[True, np.diff(np.sign(np.diff(rows["q"]))) != 0, True]
            rows = {name: values[turns] for name, values in rows.items()}
        return done.stdout, rows

    _, exact = call("tolerance = 1e-10 scheme = 3", "increment = 2e-6", "--quiet")
    rows = []
    for accuracy in accuracies:
        said, found = call("", "", "--accuracy", accuracy)
        increments = int(re.search(r"(\d+) increments", said)[1])
        for answer, error, change in re.findall(r"^ +(\w+) (\S+) % of (\S+)(?: kPa)?$", said, re.MULTILINE):
            if answer in ("p_eff", "q", "eps_v", "suction") and float(change) > 0 and float(error) > 0:
                true = np.max(np.abs(found[answer] - exact[answer]))/float(change)
                rows.append(row(name, accuracy, increments, answer, float(change), true, float(error)/100))
    return rows


def main(words):
    table = results.folder(__file__) / "honest.csv"
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    order = [*SCENES, *PATHS]
    chosen = words or order
    begin, left = time.monotonic(), [n for n in chosen if not any(r[0] == n for r in have)]
    for i, name in enumerate(left):
        have += [tuple(map(str, r)) for r in (scene_rows(name) if name in SCENES else path_rows(name))]
        have.sort(key=lambda r: order.index(r[0]) if r[0] in order else len(order))
        tables.write(table, NAMES, have)
        spent = time.monotonic() - begin
        print(f"{name}: {i + 1} of {len(left)}, {spent:.0f} s, about {spent/(i + 1)*(len(left) - i - 1):.0f} s left",
              flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
