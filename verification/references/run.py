# SPDX-License-Identifier: MIT
"""usage: run.py [CASE...]   runs reference cases with mud_host and compares

A case is a folder with case.toml (properties, problem, quantities with their tolerances), reference.csv and mesh.msh.
Exit code 0: every quantity of every case is within its tolerance. MUD_BUILD_DIR: the build, build/release by default.
"""
import os
import pathlib
import re
import sys
import tempfile
import time
import tomllib
from dataclasses import dataclass

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
VERIFICATION = HERE.parent
ROOT = VERIFICATION.parent
sys.path[:0] = [str(VERIFICATION), str(ROOT / "common")]
from tools import tables  # noqa: E402
from tools.bench import Bench, absolute, changed  # noqa: E402

MESH = re.compile(r"&mesh\b[^/]*?/")   # of a scene, without the comments behind its slash


@dataclass(frozen=True)
class Compared:
    """A quantity of a case: the difference that is worst, what is allowed, and of how many values."""
    case: str
    quantity: str
    unit: str
    off: float
    allowed: float
    largest: float
    count: int

    @property
    def good(self):
        return self.off <= self.allowed   # false for NaN

    def line(self):
        return (f"{'ok    ' if self.good else 'FAILED'} {self.case}, {self.quantity}: off by {self.off:.3g} of "
                f"{self.largest:.4g} {self.unit}, allowed {self.allowed:.3g} ({self.count} values)")


def names():
    return sorted(path.parent.name for path in HERE.glob("*/case.toml"))


def read(case, folder=HERE):
    """What a case declares, and its rows by quantity: arrays t, x, y, value (NaN: no place)."""
    declared = tomllib.loads((folder / case / "case.toml").read_text(encoding="utf-8"))
    found = {}
    for row in tables.rows(folder / case / "reference.csv"):
        numbers = [float(row[name]) if row[name] else np.nan for name in ("t", "x", "y", "value")]
        found.setdefault(row["quantity"], []).append(numbers)
    return declared, {name: np.array(rows).T for name, rows in found.items()}


def scene_of(case, declared):
    """The scene of mud_host with the mesh of the case. A mesh of Gmsh has the body `soil`."""
    own = declared["mud_host"]
    path = VERIFICATION / own["scene"]
    text = re.sub(r"!.*", "", absolute(path.read_text(encoding="utf-8"), path.parent))
    text = changed(text, [tuple(pair) for pair in own.get("changes", [])], path.name)
    text = MESH.sub(f"&mesh file = '{HERE / case / 'mesh.msh'}' /", text, count=1)
    if "group = 'soil'" not in text:
        text = text.replace("&region", "&region group = 'soil'", 1)
    return text.replace("group = 'all'", "group = 'soil'")


def of_nodes(out, how, times, x, y):
    """Values at nodes: in the files of the stages that end at these times, or of the stage that is named."""
    values = np.empty(len(x))
    for t in np.unique(times):
        stage = f"t{t:g}" if how["nodes"] == "t" else how["nodes"]
        nodes = tables.columns(out / f"nodes_{stage}.csv")
        field = sum(nodes[name] for name in how["column"].split(" + "))
        for i in np.flatnonzero(times == t):
            distance = np.hypot(nodes["r"] - x[i], nodes["z"] - y[i])
            near = int(np.argmin(distance))
            # Between two nodes of a vertical line the value is taken linearly.
            if distance[near] > 1e-6:
                on = np.flatnonzero(np.isclose(nodes["r"], x[i]))
                on = on[np.argsort(nodes["z"][on])]
                values[i] = np.interp(y[i], nodes["z"][on], field[on])
            else:
                values[i] = field[near]
    return values


def answer(out, declared, how, rows):
    """What mud_host says of a quantity, at the times and places of the rows."""
    t, x, y, _ = rows
    if "nodes" in how:
        return of_nodes(out, how, t, x, y)
    table = tables.columns(out / how["file"])
    now, column = table["time"] - declared["mud_host"].get("since_s", 0.0), table[how["column"]]
    if "first_above" in how:
        beyond = np.flatnonzero((column > how["first_above"]) & (now > 0))
        return np.array([now[beyond[0]] if beyond.size else np.nan])
    value = np.array([column[-1]]) if how.get("last") else np.interp(t, now, column, left=np.nan, right=np.nan)
    return how.get("scale", 1.0) * value + how.get("offset", 0.0)


def run(case, build, scratch):
    """Comparisons of a case."""
    declared, reference = read(case)
    if set(reference) != set(declared["quantity"]):
        raise ValueError(f"{case}: case.toml and reference.csv have other quantities")
    bench = Bench(HERE / case, build, scratch)
    folder = bench.folder()
    (folder / "scene.nml").write_text(scene_of(case, declared), encoding="utf-8")
    bench.here = folder
    out = bench.host("scene.nml")
    found = []
    for name, rows in reference.items():
        told = declared["quantity"][name]
        off = np.abs(answer(out, declared, told["mud_host"], rows) - rows[3])
        found.append(Compared(case, name, told["unit"], float(np.max(off)), told["tolerance"],
                              float(np.abs(rows[3]).max()), len(rows[3])))
    return found


def main(words):
    if "-h" in words or "--help" in words:
        print(__doc__, "\ncases: ", ", ".join(names()), sep="")
        return 0
    unknown = [word for word in words if word not in names()]
    if unknown:
        print(f"there is no case {unknown[0]}; there are: {', '.join(names())}", file=sys.stderr)
        return 2
    build = pathlib.Path(os.environ.get("MUD_BUILD_DIR", ROOT / "build/release"))
    good = []
    with tempfile.TemporaryDirectory(prefix="mud-references-") as scratch:
        for case in words or names():
            began = time.monotonic()
            for compared in run(case, build, scratch):
                print(compared.line(), flush=True)
                good.append(compared.good)
            print(f"       {case}: {time.monotonic() - began:.1f} s", flush=True)
    print(f"{sum(good)} passed, {len(good) - sum(good)} failed")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
