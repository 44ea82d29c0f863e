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
        dots = view.marks or len(y) < 2
        axis.plot(x, y, "." if dots else "-", ms=4, lw=0.6, color=colour)


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
        axes[len(cases)].text(0.0, height, text, color=colour, fontsize=7, transform=axes[len(cases)].transAxes)
    figure.tight_layout(pad=0.5, w_pad=0.4, h_pad=0.6)
    return figure


def draw_run(axis, case, label, run):
    """What tells most of a run: a profile, a mesh, a load-settlement curve, or a history."""
    if case.group == "mesh":
        nodes, k = run.table("nodes_press"), int(label_number(label))
        axis.plot(nodes["r"] + 1.15 * (k % 2), nodes["z"] - 1.15 * (k // 2), ".", ms=1)
    elif "column" in case.scenes(SETTINGS[0])[next(iter(case.scenes(SETTINGS[0])))][:40]:
        nodes = run.table("nodes_load")
        at = np.flatnonzero(np.abs(nodes["r"]) < 1e-9)
        at = at[np.argsort(nodes["z"][at])]
        axis.plot(nodes["p_w"][at], nodes["z"][at], lw=0.7)
    elif case.group == "failure":
        push = run.table("reactions_push")
        axis.plot(run.histories["edge.u_z"][1:] * -100 if len(push["time"]) < len(run.histories["time"]) else run.histories["edge.u_z"] * -100,
                  -push["top_1.force_z"], lw=0.8)
    else:
        history = run.histories
        start = 2.0 if history["time"][-1] > 1.9 else 0.0
        late = history["time"] >= start - 1e-9
        axis.plot(1e3 * (history["time"][late] - start), 1e3 * history["centre.u_z"][late], lw=0.7)


def label_number(label):
    return ("regular", "slivers", "distorted", "graded").index(label)


UNITS = {"mesh": "nodes of the four meshes", "failure": "force [kN] over settlement [cm]", "pore water": "", "contact": "u_z [mm] over t [ms]"}


def host_sheet(cases, folder, plt):
    """One panel a case, a line a run, with the defaults."""
    figure, axes = sheet(plt, len(cases), columns=5, size=2.1)
    for number, (axis, case) in enumerate(zip(axes, cases)):
        for label, run in host_runs.run_all(case.scenes(SETTINGS[0]), folder / str(number)).items():
            if run.folder.exists() and run.code in (0, 18):
                draw_run(axis, case, label, run)
        told = UNITS[case.group] or ("z [m] over p_w [kPa]" if "permeability" in case.name else "u_z [mm] over t [ms]")
        axis.set_title(f"{case.name}\n{told}", fontsize=5, pad=2)
    return figure
