# SPDX-License-Identifier: MIT
"""What the steps of a tolerance leave: runs scenes with step_tolerance, against a closed form or given fine steps on the
same mesh. Writes tolerances.csv; resumable, a scene whose rows are there is left.

    verification/run studies/cost --make --only tolerances.py [--pass SCENE...]

References go to build/cost/tolerances and serve again. Seven CPU minutes.
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
NAMES = ("scene", "tolerance", "steps", "answer", "change", "error")
UNKNOWNS = ("u_r", "u_z", "p_w", "p_c")
SMALL_CHANGE = 0.05   # of the largest change of the field among the named points: answers that change less are left out
HOST, HERE = "verification/host/", "verification/studies/cost/scenes/"
FINE_FLOW = [("dt = 1.0e-3", "dt = 1e-5"), ("dt_growth = 1.03", "dt_growth = 1.005")]
FREE_FLOW = [("   dt = 1.0e-3\n", ""), ("   dt_growth = 1.03\n", "")]
STEPS_OF_LIAKOPOULOS = [(r"dt = 0.1\n", "dt = 0.01\n"), (r"dt = 1\n", "dt = 0.1\n"), (r"dt = 5\n", "dt = 0.5\n"),
                        (r"dt = 30\n", "dt = 3\n"), (r"dt_max = 5\n", "dt_max = 0.5\n"),
                        (r"dt_max = 10\n", "dt_max = 1\n"), (r"dt_max = 30\n", "dt_max = 6\n")]


def references():
    """Where runs with fine steps serve again, to the same programs."""
    return results.current(build.parent / "cost/tolerances", build)


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

# Name: scene, changes of both runs, changes of the reference (or its closed form), changes of the run with a
# tolerance, tolerances.
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
    return done.stderr.strip() if done.returncode else ""


def failed(name, tolerance, said):
    return (name, tolerance, 0, "failed: " + " ".join(said.split())[:120].replace(",", ";"), "", "")


def apart(folder, other, answer):
    """Largest distance of a history of two runs at the times of the first within those of the other."""
    one, two = (tables.columns(place / "histories.csv") for place in (folder, other))
    slack = 1e-9*(two["time"][-1] - two["time"][0])
    common = (one["time"] >= two["time"][0] - slack) & (one["time"] <= two["time"][-1] + slack)
    return np.max(np.abs(one[answer] - np.interp(one["time"], two["time"], two[answer]))[common])


def reference(name, folder):
    """The distance of an answer of a run to the run with given fine steps, or to a closed form, as a function of its
    folder and the answer; nothing where the closed form does not say."""
    path, both, known, _, _ = SCENES[name]
    if callable(known):
        def off(out, answer):
            rows = tables.columns(out / "histories.csv")
            exact = known(rows["time"]).get(answer)
            return None if exact is None else np.max(np.abs(rows[answer] - exact))
        return off
    text = changed((root / path).read_text(encoding="utf-8"), both + known)
    fine = folder / hashlib.sha256(text.encode()).hexdigest()[:12]
    if not (fine / "done").exists():
        said = run(text, (root / path).parent, fine)
        if said:
            raise RuntimeError(said)
        (fine / "done").touch()
    return lambda out, answer: apart(out, fine, answer)


def scene_rows(name, tolerances=None, folder=None):
    """Every answer at every tolerance."""
    path, both, _, free, asked = SCENES[name]
    folder = pathlib.Path(folder or references()) / re.sub(r"\W+", "_", name)
    try:
        off = reference(name, folder)
    except RuntimeError as said:
        return [failed(name, "reference", str(said))]
    text = changed((root / path).read_text(encoding="utf-8"), both + free)
    rows = []
    for tolerance in tolerances or asked:
        out = folder / f"a{tolerance}"
        if said := run(text, (root / path).parent, out, "--step-tolerance", tolerance):
            rows.append(failed(name, tolerance, said))
            continue
        found = tables.columns(out / "histories.csv")
        change = {at: np.ptp(values) for at, values in found.items() if at.split(".")[-1] in UNKNOWNS}
        largest = {field: max([c for at, c in change.items() if at.split(".")[-1][0] == field], default=0) for field in "up"}
        for at, of in change.items():
            if of > SMALL_CHANGE*largest[at.split(".")[-1][0]] and (distance := off(out, at)) is not None:
                rows.append((name, tolerance, len(found["time"]) - 1, at, f"{of:.3g}", f"{distance/of:.2g}"))
    return rows


def main(words):
    table = results.folder(__file__) / "tolerances.csv"
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    order = list(SCENES)
    chosen = words or order
    begin, left = time.monotonic(), [n for n in chosen if not any(r[0] == n for r in have)]
    for i, name in enumerate(left):
        have += [tuple(map(str, r)) for r in scene_rows(name)]
        have.sort(key=lambda r: order.index(r[0]) if r[0] in order else len(order))
        tables.write(table, NAMES, have)
        spent = time.monotonic() - begin
        print(f"{name}: {i + 1} of {len(left)}, {spent:.0f} s, about {spent/(i + 1)*(len(left) - i - 1):.0f} s left",
              flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
