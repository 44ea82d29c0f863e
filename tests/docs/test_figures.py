# SPDX-License-Identifier: MIT
"""The figures of docs/theory are those that figures.py makes of the present library, and every one is shown."""
import os
import re
import subprocess
import sys

from checking import build, check, needs_plain_library, root, work

HALF_A_POINT = 0.5   # of a picture: less is not seen; other compilers round otherwise
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


def drawn(path):
    """The numbers of all paths and marks, in their order."""
    text = path.read_text(encoding="utf-8")
    return [[float(x) for x in NUMBER.findall(part)] for part in re.findall(r'<path d="([^"]*)"', text)]


needs_plain_library()


def test_figures_py_makes_them():
    figures = root / "docs/theory/figures"
    done = subprocess.run([sys.executable, root / "docs/theory/figures.py", work], capture_output=True, text=True,
                          env={**os.environ, "MUD_LIBRARY_DIR": str(build), "MPLCONFIGDIR": str(work / "settings")})
    check("figures.py makes them", done.returncode == 0, done.stderr)
    made, kept = ({path.name: drawn(path) for path in folder.glob("*.svg")} for folder in (work, figures))
    check("all of them are kept", made and made.keys() == kept.keys(), made.keys() ^ kept.keys())
    for name in made.keys() & kept.keys():
        same = [len(a) for a in made[name]] == [len(b) for b in kept[name]] and all(
            abs(x - y) <= HALF_A_POINT for a, b in zip(made[name], kept[name]) for x, y in zip(a, b))
        check(f"{name} is the kept one; docs/theory/figures.py renews it", same)
    pages = "".join(page.read_text(encoding="utf-8") for page in (root / "docs/theory").glob("*.md"))
    for name in kept:
        check(f"{name} is shown", f"(figures/{name})" in pages)
