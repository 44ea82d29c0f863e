# SPDX-License-Identifier: MIT
"""host/OUTPUT.md gives a unit and a meaning for every column of the tables that mud_host writes."""
import re
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402

# Short runs that write every kind of table: contact with a plate and drainage; supports, loads, controlled steps.
DRAIN = re.sub(r"duration = 3", "duration = 0.1", (root / "verification/host/contact/drain.nml").read_text())
BLOCK = """&scene name = 'block' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 's' young = 1e4 poisson = 0.3 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 's' permeability = 'k' void_ratio = 0.8 /
&stage name = 'a' analysis = 'quasi_static' duration = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 10 /
&point name = 'top' r = 0 z = 1 /
"""
KINDS = {"histories", "ledger", "contact", "reactions", "nodes", "points"}


def described(text):
    """The words in backticks of the first column of the table of columns; `a` ... `b` stands for a_FIELD to b_FIELD."""
    section = text.split("\n## Columns\n")[1].split("\n## ")[0]
    names, rows = set(), [line.split(" | ") for line in section.splitlines() if line.startswith("| `")]
    for name, unit, meaning in rows:
        if not unit.strip() or not meaning.strip(" |"):
            return set()
        for stem in re.findall(r"`(error|first)_u_r` \.\.\. ", name):
            names |= {f"{stem}_{field}" for field in ("u_r", "u_z", "p_w", "p_c")}
        names |= set(re.findall(r"`(\w+)`", name))
    return names


def test_the_manual_has_the_table():
    names = described((root / "host/OUTPUT.md").read_text(encoding="utf-8"))
    check("the manual has the table", len(names) > 40, names)
    written = set()
    for name, text in (("drain", DRAIN), ("block", BLOCK)):
        (work / f"{name}.nml").write_text(text)
        done = subprocess.run([build / "host/mud_host", work / f"{name}.nml", "--output", work / name, "--quiet"],
                              capture_output=True, text=True)
        check(f"{name} runs", done.returncode == 0, done.stderr)
        for path in (work / name).glob("*.csv"):
            written.add(path.stem.split("_")[0])
            columns = {column.split(".")[-1] for column in tables.header(path)}
            check(f"{name}/{path.name}: every column is described", columns <= names, columns - names)
    check("the runs write every kind of table", KINDS <= written, KINDS - written)
