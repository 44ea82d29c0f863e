# SPDX-License-Identifier: MIT
"""A picture a case: the stress path of every case at the point, what the runs of every case of the host did."""
import copy
import math

import host_runs
import numpy as np
from catalogue import SETTINGS
from point_views import VIEWS

WANTED = 300    # states of a path that are drawn
FINE = 3000     # of a path that others are held against
SHOWN = (SETTINGS[0], SETTINGS[2])   # defaults, paper's remedy


def with_rows(path, wanted=WANTED):
    """The same path with a row after every few increments, so that its way can be drawn; its label is the number of steps so far."""
    steps = [int(line.split()[1]) for line in path.lines if line.startswith("go ")]
    every, dense, count = max(2, len(steps) // wanted), copy.copy(path), 0
    dense.lines = []
    for line in path.lines:
        if not line.startswith("go "):
            dense.lines.append(line)
            continue
        words = line.split()
        n, change = int(words[1]), [float(word) for word in words[2:]]
        pieces = max(1, min(n, round(wanted * n / sum(steps))))
        cuts = [round(n * i / pieces) for i in range(pieces + 1)]
        count += 1
        for a, b in zip(cuts, cuts[1:]):
            dense.lines.append(f"go {b - a} " + " ".join(repr(x * (b - a) / n) for x in change))
            if pieces > 1 or count % every < 2:   # two in a row: both ends of a cycle
                dense.lines.append(f"row {count}")
    return dense


def refined(path):
    """A straight path in increments so small that what lies between two rows is a chord."""
    steps, fine = [int(line.split()[1]) for line in path.lines if line.startswith("go ")], copy.copy(path)
    times = max(1, round(FINE / sum(steps)))
    fine.lines = [f"go {int(line.split()[1]) * times} " + " ".join(line.split()[2:]) if line.startswith("go ") else line for line in path.lines]
    return with_rows(fine, FINE)


def sheet(plt, count, columns, size, high=1.0):
    rows = -(-count // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(columns * size, rows * size * high))
    for axis in axes.flat[count:]:
        axis.axis("off")
    for axis in axes.flat:
        axis.tick_params(labelsize=5, length=2, pad=1)
        axis.locator_params(nbins=4)
    return figure, axes.flat


def draw_view(axis, view, runs, colour):
    for x, y in view.curves(runs):
        dots = view.marks or len(y) <= 2
        axis.plot(x, y, "." if dots else "-", ms=5, lw=0.6, color=colour)


def point_sheet(cases, walker, plt):
    """What each case claims, with the defaults and, in the other colour, the paper's remedy; dashed the bound of the criterion."""
    figure, axes = sheet(plt, len(cases), columns=5, size=2.3, high=0.92)
    for axis, case in zip(axes, cases):
        view = VIEWS[case.name]
        for colour, setting in zip(("#c8553d", "#0b3c6f"), reversed(SHOWN)):
            paths = {label: refined(path) if view.held_against and label.startswith("clean") else with_rows(path) for label, path in case.paths(setting).items()}
            runs = {label: [row for row in rows if all(map(math.isfinite, row["stress"]))] for label, rows in walker.run_all(paths).items()}
            draw_view(axis, view, runs, colour)
        for x, y in view.lines(runs) if view.lines else ():
            axis.plot(x, y, ":", lw=0.9, color="black")
        for set_scale, scale in ((axis.set_yscale, view.scale), (axis.set_xscale, view.scale_across)):
            set_scale(scale, **({"linthresh": 0.01 if set_scale == axis.set_yscale else 1.0} if scale == "symlog" else {}))
        for ticks in (axis.xaxis, axis.yaxis):
            ticks.set_minor_formatter(plt.NullFormatter())
        if view.bound is not None:
            axis.axhline(view.bound, ls="--", lw=0.7, color="0.35")
        axis.set_xlabel(view.across, fontsize=5.5, labelpad=1)
        axis.set_ylabel(view.up, fontsize=5.5, labelpad=1)
        axis.set_title(view.claim, fontsize=6.5, pad=3)
    for text, colour, height in (("defaults", "#0b3c6f", 0.8), ("paper's remedy, no elastic domain", "#c8553d", 0.65), ("dashed: bound of the criterion", "black", 0.5),
                                 ("dotted: closed form", "black", 0.35)):
        axes[-1].text(0.0, height, text, color=colour, fontsize=7, transform=axes[-1].transAxes)
    figure.tight_layout(pad=0.5, w_pad=0.4, h_pad=0.6)
    return figure


def draw_run(axis, case, label, run):
    """What tells most of a run: a profile, a mesh, a load-settlement curve, or a history."""
    if case.group == "mesh":
        nodes, k = run.table("nodes_press"), int(label_number(label))
        axis.plot(nodes["r"] + 1.15 * (k % 2), nodes["z"] - 1.15 * (k // 2), ".", ms=1)
    elif "permeability" in case.name:
        nodes = run.table("nodes_load")
        at = np.flatnonzero(np.abs(nodes["r"]) < 1e-9)
        at = at[np.argsort(nodes["z"][at])]
        axis.plot(nodes["p_w"][at], nodes["z"][at], lw=0.7, label=f"k {label}")
    elif case.group == "failure":
        push, history = run.table("reactions_push"), run.histories
        settled = np.interp(push["time"], history["time"], -100 * history["edge.u_z"])
        axis.plot(settled, -push["top_1.force_z"], "-" if label == "fine" else ".", lw=0.8, ms=4, label={"fine": "20 steps", "coarse": "10"}[label])
    else:
        history = run.histories
        start = 2.0 if history["time"][-1] > 1.9 else 0.0
        late = history["time"] >= start - 1e-9
        up = history["centre.p_w"] if case.name.startswith("impact on undrained") else 1e3 * history["centre.u_z"]
        axis.plot(1e3 * (history["time"][late] - start), up[late], lw=0.7, label=told(case, label))


def told(case, label):
    unit = {"penalty": "{} kN/m3", "steps": "{} x 3e-5 s" if "to" in case.name else "{} s", "chatter": "{} s", "impact": "k {} m2"}
    return unit.get(case.name.split()[0], "{}").format(label) if label else None


def label_number(label):
    return ("regular", "slivers", "distorted", "graded").index(label)


TIME, U_Z, P_W, Z, SETTLED, FORCE = "t [ms]", "u_z of the plate's centre [mm]", "p_w under the centre [kPa]", "z [m]", "settlement [cm]", "force [kN]"
HOST_VIEWS = {   # claim, across, up
    "chatter": ("chatter makes no energy, by any step", TIME, U_Z),
    "lift-off and re-impact": ("thrown off, and back: no energy made", TIME, U_Z),
    "impact on undrained soil, quadratic pressures": ("pressures of one order: the answer hangs on k", TIME, P_W),
    "impact on undrained soil, linear pressures": ("an order below: it does not", TIME, P_W),
    "impact at suction 100 kPa": ("suction 100 kPa without the remedy", TIME, U_Z),
    "steps of 3e-6 to 3e-4 s": ("a tenth to ten times the paper's step", TIME, U_Z),
    "steps of 3e-3 s": ("a hundred times: stops at the first step", TIME, U_Z),
    "steps of 3e-3 s, energy alarm at 10 %": ("a hundred times, let go: what it would answer", TIME, U_Z),
    "penalty 1e5 to 1e10 kN/m3": ("from 1e8 on the penalty is not seen", TIME, U_Z),
    "permeability 1e-8 to 1e-14 m2, quadratic pressures": ("pressures of one order: from node to node", "p_w [kPa]", Z),
    "permeability 1e-8 to 1e-14 m2, linear pressures": ("an order below: flat below the thin layer", "p_w [kPa]", Z),
    "footing on loose sand": ("loose sand: the load levels out", SETTLED, FORCE),
    "footing on dense sand": ("dense sand: beyond the peak", SETTLED, FORCE),
    "footing on undrained sand": ("no drainage: it dilates and gains", SETTLED, FORCE),
    "footing at suction 100 kPa": ("suction 100 kPa: close to failure", SETTLED, FORCE),
    "slivers, distorted and graded meshes": ("four meshes, one stress to 1e-9 %", "", ""),
}


def host_sheet(cases, folder, plt):
    """One panel a case, a line a run, with the defaults."""
    figure, axes = sheet(plt, len(cases), columns=4, size=2.8, high=0.85)
    for number, (axis, case) in enumerate(zip(axes, cases)):
        for label, run in host_runs.run_all(case.scenes(SETTINGS[0]), folder / str(number)).items():
            if run.folder.exists() and run.code in (0, 18):
                draw_run(axis, case, label, run)
        claim, across, up = HOST_VIEWS[case.name]
        axis.set_title(claim, fontsize=7, pad=3)
        axis.set_xlabel(across, fontsize=6, labelpad=1)
        axis.set_ylabel(up, fontsize=6, labelpad=1)
        if axis.get_legend_handles_labels()[1]:
            axis.legend(fontsize=4.5, frameon=False)
    figure.tight_layout(pad=0.5, w_pad=0.5, h_pad=0.7)
    return figure
