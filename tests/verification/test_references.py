# SPDX-License-Identifier: MIT
"""verification/references: mud_host meets every quantity, and the data are those of the closed forms."""
import subprocess
import sys

import numpy as np
import pytest
from checking import build, check, needs_release, nightly, root, work

needs_release("the pages of verification/host run the same scenes in every build")
sys.path.insert(0, str(root / "verification/references"))
import others  # noqa: E402
import run  # noqa: E402
import tables  # noqa: E402 (run knows its folder)

LONG = ("dam",)   # 25 s; verification/host/seepage_face runs its scene in the check run


@pytest.mark.parametrize("case", run.names())
def test_mud_host_meets_the_reference(case):
    if case in LONG and not nightly:
        declared, reference = run.read(case)
        check(f"{case}: every quantity has its data", set(reference) == set(declared["quantity"]), sorted(reference))
        return
    for compared in run.run(case, build, work / case):
        check(f"{case}: {compared.quantity}", compared.good, compared.line())
        # Data that a tenth of their range changes, and a mesh or scene that does nothing, would be seen.
        check(f"{case}: the tolerance of {compared.quantity} says something", compared.allowed < 0.1*compared.largest,
              compared.line())


def test_the_data_are_those_of_the_closed_forms():
    done = subprocess.run([sys.executable, root / "verification/references/make.py", work / "made"],
                          capture_output=True, text=True)
    check("make.py runs", done.returncode == 0, done.stderr)
    for case in run.names():
        for name in ("reference.csv", "mesh.msh"):
            check(f"{case}: {name} is made", (work / "made" / case / name).exists(), done.stdout)
        kept, made = (tables.rows(folder / case / "reference.csv")
                      for folder in (root / "verification/references", work / "made"))
        check(f"{case}: as many rows", len(kept) == len(made), f"{len(kept)}, {len(made)}")
        a, b = (np.array([float(row["value"]) for row in rows]) for rows in (kept, made))
        check(f"{case}: values", np.allclose(a, b, rtol=1e-9, atol=1e-12*np.abs(a).max()), np.abs(a - b).max())
        check(f"{case}: places", [row["t"] + row["x"] for row in kept] == [row["t"] + row["x"] for row in made], case)
        text = [(folder / case / "mesh.msh").read_text()
                for folder in (root / "verification/references", work / "made")]
        check(f"{case}: the mesh", text[0] == text[1], "make.py writes another mesh")


def test_a_wrong_answer_is_seen(tmp_path):
    compared = run.Compared("case", "quantity", "kPa", float("nan"), 1.0, 10.0, 3)
    check("a NaN is not within a tolerance", not compared.good, compared.line())
    done = subprocess.run([sys.executable, root / "verification/references/run.py", "no_such_case"],
                          capture_output=True, text=True)
    check("a case that is not there is refused", done.returncode == 2 and "there are: dam" in done.stderr, done.stderr)


def test_the_table_of_the_page_is_that_of_the_cases():
    text = (root / "verification/references/README.md").read_text(encoding="utf-8")
    for case in run.names():
        declared, reference = run.read(case)
        row = f"| [{case}]({case}/case.toml) | {declared['title']} | {declared['reference'].split(':')[0]} |"
        check(f"{case} has its row in the page", row in text, row)


def test_the_table_of_other_programs_is_that_of_their_checks():
    text = (root / "verification/references/README.md").read_text(encoding="utf-8")
    check("others.py --update has written it", others.table() in text, others.table())
    refused = [case for name in others.PROGRAMS for case, found in others.kept(name)["cases"].items()
               if found == "no convergence"]
    check("no run of another program broke off", not refused, refused)
