# SPDX-License-Identifier: MIT
"""What pilots keep and let go in scenes that a careless choice spoils, and what it costs and saves."""
import pathlib
import re
import subprocess
import sys
import time

import numpy as np
from tools import tables
from tools.bench import ROOT
from tools.page import Page, Script, Tolerance
from tools.results import MISSED

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import scenes  # noqa: E402

PAGE = Page(
    claim="`effects = 'auto'` keeps the effects that matter in eleven scenes where a careless choice gives wrong results, and removes effects that do not matter in six others and in four of the eleven",
    kind=("robustness", "study"),
    input="`scenes.py`: every scene leaves all possible choices open; compared are the run that `auto` chooses, the run with "
          "everything (`effects_tolerance = 1e-6`), and the careless run (`without`)",
    reference="the run with everything, at its end and on the way, as a share of the range of each answer",
    seconds=90, quick=0, pictures=("effects.png",))

MAKES = (Script("times.py", ("times.csv",), 150),)

COUNT = Tolerance("a count")
CARELESS = 0.05    # what a trap must err by, so that it is one


def changed(scene):
    """What removed effects may change."""
    return Tolerance("removed effects may change an answer by the tolerance of the scene (1 %, 4 % where the scene "
                     "sets it), by the pilots' factor of 2 at most twice as much; steps are chosen anew, to 1 %",
                     absolute=2*(0.04 if "effects_tolerance = 0.04" in scene.text else 0.01) + 0.01)


def run(bench, scene, name, *edits):
    """Seconds, table of effects and histories; None where the program refuses."""
    text = scene.text.replace("{materials}", str(ROOT / "drivers/materials"))
    for old, new in edits:
        text = text.replace(old, new, 1)
    folder = bench.folder()
    path = folder / f"{name}.nml"
    path.write_text(text)
    began = time.monotonic()
    done = subprocess.run([str(bench.build / "host/mud_host"), str(path), "--output", str(folder / name)],
                          capture_output=True, text=True)
    seconds = time.monotonic() - began
    if done.returncode not in (0, MISSED):
        return None, done.stderr.strip(), seconds, 0
    table = folder / name / "effects.csv"
    rows = {row["effect"]: row for row in tables.rows(table)} if table.exists() else {}
    pilots = re.search(r"of these (\S+) s for pilots", done.stdout)
    return tables.columns(folder / name / "histories.csv"), rows, seconds, float(pilots[1]) if pilots else 0.0


def apart(one, other):
    """Largest distance of displacement histories at the named points, as a share of the largest range."""
    columns = [name for name in one if name.endswith((".u_r", ".u_z"))]
    scale = max(np.ptp(one[name]) for name in columns)
    return max(float(np.max(np.abs(np.interp(one["time"], other["time"], other[name]) - one[name]))) for name in columns) / scale


def check(bench):
    results = []
    for scene in scenes.TRAPS + scenes.EASY:
        auto, table, seconds, pilots = run(bench, scene, "auto")
        if auto is None:
            bench.below(f"{scene.name}: runs", 1.0, Tolerance("a count"), table)
            continue
        full, _, all_seconds, all_pilots = run(bench, scene, "full", ("effects = 'auto'", "effects = 'auto' effects_tolerance = 1e-6")
                                               if "effects_tolerance" not in scene.text else
                                               ("effects_tolerance = 0.04", "effects_tolerance = 1e-6"))
        row = {"name": scene.name, "what": scene.what, "auto": apart(full, auto), "seconds": seconds - pilots,
               "pilots": pilots, "full": all_seconds - all_pilots, "careless": None,
               "off": [name for name, r in table.items() if r["influence"] and r["on"] == "off"]}
        for name in scene.keeps:
            bench.near(f"{scene.name}: keeps {name}", float(table[name]["on"] == "on"), 1.0, COUNT)
        for name in scene.drops:
            bench.near(f"{scene.name}: lets {name} go", float(table[name]["on"] == "off"), 1.0, COUNT)
        bench.below(f"{scene.name}: what auto changes", row["auto"], changed(scene))
        if scene.careless:
            words = ", ".join(f"'{word}'" for word in scene.careless)
            careless, refused, _, _ = run(bench, scene, "careless", ("effects = 'auto'", f"effects = 'auto' without = {words}"))
            row["careless"] = "refused" if careless is None else apart(full, careless)
            if careless is not None:
                bench.below(f"{scene.name}: share that makes it a trap over the error of carelessness",
                            CARELESS / row["careless"], Tolerance("a trap has an error of more than 5 %", absolute=1.0))
        bench.note(scene.name, f"auto {100 * row['auto']:.2g} %, careless "
                   + (f"{100 * row['careless']:.3g} %" if isinstance(row["careless"], float) else str(row["careless"]))
                   + f", off: {', '.join(row['off']) or 'nothing'}; {row['seconds']:.2f} s after {row['pilots']:.2f} s of pilots; "
                   f"with everything {row['full']:.2f} s")
        results.append(row)
    return results


def texts(bench):
    rows = []
    for row in tables.rows(bench.here / "times.csv"):
        whole, pilots = float(row["seconds"]), float(row["of these pilots"])
        rows.append((row["scene"], row["elements"], row["off"], f"{row['unknowns with everything']} to {row['unknowns']}",
                     row["seconds with everything"], row["seconds"], row["of these pilots"],
                     f"{100 * pilots / float(row['seconds with everything']):.2g} %", f"{100 * float(row['share allowed']):.0f} %",
                     f"{100 * (1 - whole / float(row['seconds with everything'])):.0f} %", f"{100 * float(row['changes']):.2g} %"))
    return {"README.md": {"times": tables.markdown(
        ("scene", "elements", "removed", "unknowns", "with everything [s]", "with auto [s]", "of these pilots [s]",
         "pilots, share of the whole run", "allowed by their estimate", "time saved", "largest change of a displacement"), rows)}}


def draw(bench, results, plt):
    figure, axis = plt.subplots(figsize=(7, 5))
    names = [r["name"] for r in results]
    place = np.arange(len(names))
    axis.barh(place + 0.2, [100 * max(r["auto"], 1e-6) for r in results], 0.4, label="auto")
    axis.barh(place - 0.2, [100 * r["careless"] if isinstance(r["careless"], float) else np.nan for r in results], 0.4,
              label="careless choice")
    axis.axvline(1, color="k", lw=0.6)
    axis.set_xscale("log")
    axis.set_yticks(place, names)
    axis.invert_yaxis()
    axis.set_xlabel("largest error of a displacement, share of its range [%]")
    axis.legend()
    figure.tight_layout()
    bench.save(figure, "effects.png")
