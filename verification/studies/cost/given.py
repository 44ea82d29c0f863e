# SPDX-License-Identifier: MIT
"""Are the estimated errors of given steps the true ones? The scenes of honest.py with the steps that they give, and
with longer ones, against the same references. Writes given.csv; resumable, a scene whose rows are there is left.

    verification/run studies/cost --make --only given.py [--pass SCENE...]

References go to build/cost/honest and serve honest.py too. A minute of CPU beside them.
"""
import pathlib
import re
import sys

import honest

from honest import results, tables

NAMES = ("scene", "steps_given", *honest.NAMES[2:])
# The indentation with fine steps: without an elastic domain their errors are irregular.
STEPS_OF_IMPACT = [(f"{dt} s, rho_inf 0", [("dt = 3.0e-5", f"dt = {dt}"), ("rho_inf = 0.8", "rho_inf = 0")])
                   for dt in ("6e-5", "3e-5", "1.5e-5")]
# Name in honest.py: what is said of its steps, and changes of the scene.
SCENES = {
    "vibration, rho_inf 0": [("0.005 s", []), ("0.002 s", [("dt = 0.005", "dt = 0.002")])],
    "bar on a wall": [("2e-6 s", []), ("8e-6 s", [("dt = 2.0e-6", "dt = 8e-6")])],
    "falling plate": [("1e-5 s", []), ("4e-5 s", [("dt = 1.0e-5", "dt = 4e-5")])],
    "dynamic consolidation": [("1e-4 s", []), ("4e-4 s", [("dt = 1.0e-4", "dt = 4e-4")])],
    "Terzaghi": [("growing by 1.03", []), ("growing by 1.3", [("dt_growth = 1.03", "dt_growth = 1.3")]),
                 ("10 s", [("dt = 1.0e-3", "dt = 10"), ("   dt_growth = 1.03\n", "")])],
    "Mandel": [("growing by 1.03", []), ("growing by 1.3", [("dt_growth = 1.03", "dt_growth = 1.3")])],
    "Liakopoulos": [("of its page", [])],
    "column shaken at its base": [("0.002 s", []), ("0.02 s", [("dt = 2.0e-3", "dt = 2e-2")])],
    "three fields of MUD": [("of the test", [])],
    "indentation at 30 kPa": [
        ("3e-5 s, rho_inf 0.8 (paper)", []),
        ("1.2e-4 s, rho_inf 0.8", [("dt = 3.0e-5", "dt = 1.2e-4")]),
        ("4.8e-4 s, rho_inf 0", [("dt = 3.0e-5", "dt = 4.8e-4"), ("rho_inf = 0.8", "rho_inf = 0")]),
        ("2e-3 s, rho_inf 0", [("dt = 3.0e-5", "dt = 2e-3"), ("rho_inf = 0.8", "rho_inf = 0")]), *STEPS_OF_IMPACT],
    "indentation, elastic domain": STEPS_OF_IMPACT,
}


def scene_rows(name, folder=None):
    """Every answer with every length of steps."""
    path, both, _, _, _ = honest.SCENES[name]
    folder = pathlib.Path(folder or honest.references()) / re.sub(r"\W+", "_", name)
    off = honest.reference(name, folder)
    rows = []
    for number, (said, changes) in enumerate(SCENES[name]):
        text = honest.changed((honest.root / path).read_text(encoding="utf-8"), both + changes)
        out = folder / f"given{number}"
        if why := honest.run(text, (honest.root / path).parent, out):
            rows.append(honest.failed(name, said, why))
            continue
        steps = len(tables.columns(out / "ledger.csv")["time"])
        for answer in tables.rows(out / "answers.csv"):
            at, change = answer["answer"], float(answer["largest_change"])
            distance = off(out, at)
            if distance is not None:
                rows.append(honest.row(name, said, steps, at, change, distance/change, float(answer["estimated_error"])))
    return rows


def main(words):
    table = results.folder(__file__) / "given.csv"
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    order = list(SCENES)
    for name in words or order:
        if any(row[0] == name for row in have):
            continue
        have += [tuple(map(str, row)) for row in scene_rows(name)]
        have.sort(key=lambda row: order.index(row[0]))
        tables.write(table, NAMES, have)
        print(name, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
