# SPDX-License-Identifier: MIT
"""incrementalDriver: input and the numbers expected; compared if MUD_INCREMENTAL_DRIVER names the program with MUD."""
import csv
import os
import pathlib

import clients

DIGITS = 1e-9   # the output has eleven digits
HELD = 1e-6     # what the iteration of the program leaves of a held stress
STAGES = {"triaxial": ((100, {2: -0.02}), (30, {2: 0.003}), (65, {2: -0.013})),
          "shear": ((30, (-0.004, 0.003, -0.001, -0.006, 0.003, -0.002)),
                    (30, (0.002, -0.0015, 0.0005, 0.003, -0.0015, 0.001)),
                    (25, (0.001, -0.002, -0.001, -0.002, -0.005, 0.004)))}


def load(case):
    """test.inp: strains given, or the axis (3) moved with the stress of 1 and 2 held."""
    lines = [f"{case}.out"]
    for parts, change in STAGES[case]:
        lines += ["*LinearLoad", f"{parts} 100 1.0", "*Cartesian"]
        for i in range(6):
            held = isinstance(change, dict) and i in (0, 1)
            value = change.get(i, 0.0) if isinstance(change, dict) else change[i]
            lines.append(f"{int(held)} {value!r}")
    return "\n".join([*lines, "*End", ""])


program = os.environ.get("MUD_INCREMENTAL_DRIVER")
for case in STAGES:
    folder = clients.work_folder(f"incrementaldriver/{case}")
    (folder / "parameters.inp").write_text(clients.describe("incrementaldriver"))
    (folder / "initialconditions.inp").write_text(clients.describe("incrementaldriver-start"))
    (folder / "test.inp").write_text(load(case))
    table = clients.expected(case)
    if case == "shear":
        wanted = clients.stresses(table)[1:]
    else:
        wanted = [[-r, -r, -a] for a, r in zip(table["sigma_a"][1:], table["sigma_r"][1:])]
    with open(folder / "expected.csv", "w") as file:
        csv.writer(file).writerows([repr(x) for x in row] for row in wanted)
    if not program:
        continue
    if clients.run([pathlib.Path(program).resolve()], folder / "log.txt", cwd=folder, timeout=300) != 0:
        clients.verdict(False, case, "the program failed")
        continue
    rows = [line.split() for line in (folder / f"{case}.out").read_text().splitlines()[2:]]
    got = [[float(x) for x in row[8:8 + len(wanted[0])]] for row in rows]
    clients.compare(case, got, wanted, HELD if case == "triaxial" else DIGITS)
if not program:
    clients.skip(f"input and expected.csv are in {folder.parent.relative_to(clients.home.parent)}; to compare set "
                 "MUD_INCREMENTAL_DRIVER to the program")
clients.finish()
