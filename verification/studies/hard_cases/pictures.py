# SPDX-License-Identifier: MIT
"""A picture a case: the stress path of every case at the point, what the runs of every case of the host did; and the table of all settings."""
import copy
import math

import host_files
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
    elif case.name in PLAIN:
        up = run.histories["centre.p_w"] if case.group == "pore water" else 1e3 * run.histories["centre.u_z"]
        axis.plot(run.histories["time"], up, lw=0.7)
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


PLAIN = ("showers", "a bank in layers, cut again", "drawdown at a seepage face", "spin-up of loose sand",
         "strength that falls, comes back and falls", "air that cannot escape, shaken")


def told(case, label):
    unit = {"penalty": "{} kN/m3", "steps": "{} x 3e-5 s" if "to" in case.name else "{} s", "chatter": "{} s", "impact": "k {} m2"}
    return unit.get(case.name.split()[0], "{}").format(label) if label else None


def label_number(label):
    return ("regular", "slivers", "distorted", "graded").index(label)


TIME, U_Z, P_W, Z, SETTLED, FORCE = "t [ms]", "u_z of the plate's centre [mm]", "p_w under the centre [kPa]", "z [m]", "settlement [cm]", "force [kN]"
HOST_VIEWS = {   # claim, across, up
    "chatter": ("chatter creates no energy at any step size", TIME, U_Z),
    "lift-off and re-impact": ("lift-off and re-impact create no energy", TIME, U_Z),
    "re-impact with friction": ("friction of 0.5: neither does it create energy", TIME, U_Z),
    "impact on undrained soil, quadratic pressures": ("quadratic pressures: they depend on k", TIME, P_W),
    "impact on undrained soil, linear pressures": ("linear pressures: they do not depend on k", TIME, P_W),
    "impact at suction 100 kPa": ("suction 100 kPa without the paper's remedy", TIME, U_Z),
    "steps of 3e-6 to 3e-4 s": ("0.1 to 10 times the paper's step", TIME, U_Z),
    "steps of 3e-3 s": ("100 times the paper's step", TIME, U_Z),
    "steps of 3e-3 s, energy alarm at 10 %": ("100 times against 10 times the paper's step", TIME, U_Z),
    "penalty 1e5 to 1e10 kN/m3": ("from 1e8 kN/m3 on the penalty hardly matters", TIME, U_Z),
    "permeability 1e-8 to 1e-14 m2, quadratic pressures": ("quadratic pressures oscillate from node to node", "p_w [kPa]", Z),
    "permeability 1e-8 to 1e-14 m2, linear pressures": ("linear pressures: uniform below the thin layer", "p_w [kPa]", Z),
    "showers": ("the surface ponds, runs off and dries", "t [s]", "p_w of the surface [kPa]"),
    "a bank in layers, cut again": ("three layers come, two leave at once", "stage", "u_z below the bank [mm]"),
    "a raft that rocks on sand": ("a raft lifts off and comes back: no energy is created", TIME, U_Z),
    "drawdown at a seepage face": ("the face lets water out alone", "t [s]", "p_w at a third of the height [kPa]"),
    "spin-up of loose sand": ("from 1 g to 50 g", "stage", "u_z of the surface [mm]"),
    "strength that falls, comes back and falls": ("M_c to 0.7, 1 and 0.6 of itself", "t [s]", "u_z of the strip's centre [mm]"),
    "air that cannot escape, shaken": ("pressure grows, air and water are kept", "cycle, times two", "p_w [kPa]"),
    "footing on loose sand": ("loose sand: the load levels out", SETTLED, FORCE),
    "footing on dense sand": ("dense sand: the load passes its peak", SETTLED, FORCE),
    "footing on undrained sand": ("undrained sand: it dilates, the force grows", SETTLED, FORCE),
    "footing at suction 100 kPa": ("suction 100 kPa: close to failure", SETTLED, FORCE),
    "slivers, distorted and graded meshes": ("four meshes: the same stress to 1e-9 %", "", ""),
}


FILE_CLAIMS = {
    "kill and restart at every tenth step": "killed at every tenth step: the same files",
    "full disk, by the size of a file": "a file cannot grow: message, nothing lost",
    "full disk, by a small file system": "small file system: message, nothing lost",
    "damaged checkpoint": "damaged checkpoint: refused, or nothing lost",
    "damaged mesh": "damaged mesh: refused, or another mesh",
    "scenes of nonsense": "scenes of nonsense: refused, read or run",
}


def draw_record(axis, case, record):
    """What became of every try, by where the damage was; of scenes of nonsense the share of each answer, by blocks."""
    if case.name == "scenes of nonsense":
        for kind in host_files.KINDS:
            axis.plot([at for at, answer, _ in record if answer == kind], [share for _, answer, share in record if answer == kind], lw=0.7, label=kind)
        axis.set_ylabel("share of a block of scenes [%]", fontsize=6, labelpad=1)
        axis.legend(fontsize=5, frameon=False, loc="center right", bbox_to_anchor=(1.0, 0.68), ncol=2)
    else:
        answers = sorted({answer for _, answer in record} | {host_files.WRONG})
        for row, answer in enumerate(answers):
            places = [at for at, found in record if found == answer]
            axis.plot(places, [row] * len(places), "|" if len(record) > 50 else "o", ms=5, color="#c8553d" if answer == host_files.WRONG else "#0b3c6f")
            axis.text(0.03, row + 0.2, f"{answer.lower()}: {len(places) or 'none'}", fontsize=5.5, transform=axis.get_yaxis_transform())
        axis.set_yticks([])
        axis.set_ylim(-0.6, len(answers) - 0.3)
    axis.set_xlabel(case.place, fontsize=6, labelpad=1)
    axis.set_title(FILE_CLAIMS[case.name], fontsize=7, pad=3)


def host_sheet(cases, records, folder, plt):
    """One panel a case, with the defaults: a line a run, or of a case of files what became of its tries (`records`: by its name)."""
    figure, axes = sheet(plt, len(cases) + len(host_files.CASES), columns=4, size=2.8, high=0.85)
    for axis, case in zip(axes[len(cases):], host_files.CASES):
        draw_record(axis, case, records[case.name])
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


COLOURS = {"passed": (0.75, 0.88, 0.75), "failed": (0.96, 0.72, 0.55), "ended": (0.75, 0.25, 0.25), "none": (0.93, 0.93, 0.93)}


def setting_sheet(cases, results, plt):
    """Cases down, settings across: passed, missed a criterion, did not end or was stopped, makes no difference."""
    def colour(row):
        return COLOURS["none" if not row else "ended" if row["finished"] != "True" else "passed" if row["passed"] == "True" else "failed"]
    figure, axes = plt.subplots(figsize=(9.5, 0.2 * len(cases) + 1.6))
    axes.imshow([[colour(results.get((case.name, setting.name))) for setting in SETTINGS] for case in cases], aspect="auto")
    axes.grid(False)
    axes.tick_params(length=0)
    axes.set_yticks(range(len(cases)), [case.name for case in cases], fontsize=7)
    axes.set_xticks(range(len(SETTINGS)), [setting.name for setting in SETTINGS], fontsize=7, rotation=30, ha="left")
    axes.xaxis.tick_top()
    axes.set_xticks([i - 0.5 for i in range(1, len(SETTINGS))], minor=True)
    axes.set_yticks([i - 0.5 for i in range(1, len(cases))], minor=True)
    axes.grid(which="minor", color="white", lw=0.8)
    axes.tick_params(which="minor", length=0)
    handles = [plt.Rectangle((0, 0), 1, 1, color=shade) for shade in COLOURS.values()]
    axes.legend(handles, ("passed", "misses a criterion", "does not come to its end, or is stopped with a message", "the setting makes no difference"),
                loc="upper center", bbox_to_anchor=(0.5, -0.005), ncol=2, fontsize=7, frameon=False)
    figure.tight_layout()
    return figure
