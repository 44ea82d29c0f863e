# SPDX-License-Identifier: MIT
"""Pictures of a run of mud_host: plot_run.py FOLDER [--fields NAME ...] [--times T ...] [--histories NAME ...]

Writes fields.png (a row for every time, a column for every field) and histories.png (a panel for every quantity, a line
for every point) into the folder. Without options: the moment of the largest displacement, and of everything what changes.
"""
import argparse
import pathlib
import re
import sys
import textwrap

import h5py
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.tri  # noqa: E402
import numpy as np  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
sys.dont_write_bytecode = True
import tables  # noqa: E402 (its folder is known only now)

COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900", "#555555")
# Curves are told apart without colours: a line and a marker for each.
LINES, MARKERS = ("-", "--", "-.", ":"), "osv^DPX*"
MARKS = 8           # markers of a curve
# Components of vectors by the names of histories.csv.
COMPONENTS = {"u_r": ("displacement", 0), "u_z": ("displacement", 1), "v_r": ("velocity", 0), "v_z": ("velocity", 1),
              "a_r": ("acceleration", 0), "a_z": ("acceleration", 1)}
USUAL = ("u_z", "u_r", "p_w", "p_c", "S_w", "p", "q", "e")   # in this order, as many as a page holds
UNITS = {"u": "m", "v": "m/s", "a": "m/s2", "p": "kPa", "s": "kPa", "e": "-", "S": "-"}  # by the letter
PAGE = 6            # panels without being asked
SMALL = 1e-9        # a range below this share of its size is constant
SPLIT = ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5])   # a 6-node triangle as four of three nodes
plt.rcParams.update({"savefig.dpi": 130, "font.size": 9, "axes.titlesize": 10, "axes.spines.top": False,
                     "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.3})


class Run:
    """The files of a folder."""

    def __init__(self, folder):
        self.folder = folder
        with h5py.File(folder / "mesh.h5") as file:
            # The node of a plate is in no element: it has no place in a picture.
            self.kept, elements = np.unique(file["elements"][...], return_inverse=True)
            self.nodes, self.elements = file["nodes"][...][self.kept], elements.reshape(-1, 6)
            self.scene = file.attrs["scene"].decode()
        # Not whatever lies in the folder: an earlier run may have written more.
        names = re.findall(r">(fields_\d+\.h5):/", (folder / "results.xdmf").read_text(encoding="utf-8"))
        self.files = [folder / name for name in dict.fromkeys(names)]
        self.times = []
        for path in self.files:
            with h5py.File(path) as file:
                self.times.append(float(file["time"][0]))
        with h5py.File(self.files[-1]) as file:
            names = [*file["nodes"], *file["cells"]]
        self.staged = "ground" in names   # Parts of the ground join or leave.
        self.names = [n for n in names if n not in ("displacement", "velocity", "acceleration")] + list(COMPONENTS)

    def field(self, frame, name):
        """(values, unit, description, whether they belong to nodes)"""
        with h5py.File(self.files[frame]) as file:
            if name in COMPONENTS:
                vector, component = COMPONENTS[name]
                item = file["nodes"][vector]
                return item[:, component][self.kept], item.attrs["unit"].decode(), vector, True
            place = "nodes" if name in file["nodes"] else "cells"
            item = file[place][name]
            values = item[...][self.kept] if place == "nodes" else item[...]
            return values, item.attrs["unit"].decode(), item.attrs["description"].decode(), place == "nodes"

    def peak(self):
        """The moment of the largest displacement of a node."""
        return int(np.argmax([np.hypot(self.field(i, "u_r")[0], self.field(i, "u_z")[0]).max()
                              for i in range(len(self.times))]))

    def ground(self, frame):
        """Whether every element is part of the ground."""
        return self.field(frame, "ground")[0] > 0 if self.staged else np.ones(len(self.elements), bool)


def moves(values):
    return np.ptp(values) > SMALL*max(1e-30, np.max(np.abs(values)))


def tells(run, frame, name):
    """Whether a field is worth a panel: a component of a vector must not be negligible beside the other."""
    values = run.field(frame, name)[0]
    if name not in COMPONENTS:
        return moves(values)
    other = run.field(frame, name[:2] + "rz".replace(name[2], ""))[0]
    return moves(values) and np.ptp(values) > 1e-3*np.ptp(other)


def choose(names, known, what):
    for name in names:
        if name not in known:
            sys.exit(f"plot_run: there is no {what} {name}; there are {', '.join(sorted(known))}")
    return list(names)


WIDE, BREADTH, LOWEST = 2.5, 9.0, 0.9   # width over height; inches of a panel of a wide mesh


def levels_of(low, high):
    """(levels, ticks): few and round; a constant gets a band of its own."""
    if not high - low > SMALL*max(abs(low), abs(high)):
        margin = max(abs(low), 1e-12)*1e-3
        return np.array([low - margin, high + margin]), [low]
    ticks = matplotlib.ticker.MaxNLocator(12).tick_values(low, high)
    levels = ticks.copy()
    # A contour plot leaves out what lies on its last level.
    levels[[0, -1]] += np.array([-1, 1])*SMALL*(high - low)
    return levels, ticks[::2]


def panel_size(wide, high):
    """(width, height) of a panel [inch], how much heights are stretched, and whether panels go one below the other."""
    if wide <= WIDE*high:
        # The shape of the mesh, within what a page can bear.
        scale = min(2.9/wide, 5.5/high)
        return (max(scale*wide, 0.5), max(scale*high, 0.8)), 1.0, False
    stretch = max(1.0, LOWEST/(BREADTH*high/wide))
    return (BREADTH, stretch*BREADTH*high/wide), stretch, True


def draw_fields(run, frames, names, factor, output):
    size, stretch, below = panel_size(*np.ptp(run.nodes, axis=0))
    # Panels of a wide mesh fill the page one below the other.
    shape = (len(frames)*len(names), 1) if below else (len(frames), len(names))
    figure, grid = plt.subplots(*shape, figsize=((size[0] + 1.2)*shape[1], (size[1] + 0.6)*shape[0] + 0.4),
                                squeeze=False, layout="constrained")
    grid = grid.reshape(len(frames), len(names))
    triangles = np.concatenate([run.elements[:, corners] for corners in SPLIT])
    for column, name in enumerate(names):
        shown = [run.field(frame, name) for frame in frames]
        levels, ticks = levels_of(min(v.min() for v, *_ in shown), max(v.max() for v, *_ in shown))
        for row, (frame, (values, unit, meaning, of_nodes)) in enumerate(zip(frames, shown)):
            axis = grid[row, column]
            moved = run.nodes + factor*np.stack([run.field(frame, "u_r")[0], run.field(frame, "u_z")[0]], axis=1)
            there = run.ground(frame)
            mesh = matplotlib.tri.Triangulation(*moved.T, triangles, mask=np.tile(~there, len(SPLIT)))
            if of_nodes:
                picture = axis.tricontourf(mesh, values, levels=levels, cmap="viridis")
            else:
                picture = axis.tripcolor(mesh, facecolors=np.tile(values, len(SPLIT)), cmap="viridis", vmin=levels[0],
                                         vmax=levels[-1], rasterized=True)
            bar = figure.colorbar(picture, ax=axis, shrink=0.9, pad=0.02, format="%.6g", ticks=ticks)
            bar.outline.set_visible(False)
            # The mesh itself, unless its lines would cover it.
            if len(run.elements) < 3000:
                axis.triplot(*moved.T, run.elements[there, :3], color="white", lw=0.25, alpha=0.6)
            axis.set_title(f"{name} [{unit}]")
            axis.margins(0)
            axis.set_aspect(stretch)
            last = row == len(frames) - 1 and (not below or column == len(names) - 1)
            # As scenes call them, in plane strain too.
            axis.set_xlabel("r [m]" if last else "")
            axis.set_ylabel(f"t = {run.times[frame]:.6g} s\nz [m]" if column == 0 or below else "")
    notes = ([f"displacements x {factor:g}"] if factor else []) + ([f"heights x {stretch:.3g}"] if stretch > 1 else [])
    title(figure, run.scene + (f" ({', '.join(notes)})" if notes else ""))
    # Panels that keep the shape of the mesh are narrower than their places: labels may stand outside of these.
    figure.savefig(output, bbox_inches="tight", pad_inches=0.1)
    plt.close(figure)
    print(output)


def title(figure, text):
    """Above the panels, in as many lines as the picture is wide: about 13 letters of this size an inch."""
    figure.suptitle(textwrap.fill(text, max(20, int(13*figure.get_figwidth()))), fontsize=11)


def read_histories(folder):
    table = tables.columns(folder / "histories.csv")
    return table.pop("time"), table


def crowded(time):
    """(from, to) of nine tenths of the steps where they take less than a fifth of the time; None: all counts alike."""
    most = int(0.9*len(time))
    spans = time[most:] - time[:len(time) - most]
    at = int(np.argmin(spans))
    return (time[at], time[at + most]) if most > 0 and spans[at] < 0.2*(time[-1] - time[0]) else None


def draw_histories(run, time, table, names, output):
    points = list(dict.fromkeys(name.rpartition(".")[0] for name in table))
    columns = min(3, len(names))
    rows = -(-len(names)//columns)
    figure, grid = plt.subplots(rows, columns, figsize=(3.9*columns, 2.7*rows + 0.5), squeeze=False,
                                layout="constrained", sharex=True)
    for axis, name in zip(grid.flat, names):
        for i, point in enumerate(points):
            # Markers of the curves stand beside each other.
            axis.plot(time, table[f"{point}.{name}"], color=COLOURS[i % len(COLOURS)], label=point,
                      ls=LINES[i % len(LINES)], marker=MARKERS[i % len(MARKERS)], ms=3.5,
                      markevery=((i % 4)/4/MARKS, 1/MARKS))
        axis.set_title(f"{name} [{UNITS[name[0]]}]")
        axis.grid(color="#dddddd", lw=0.6)
        axis.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useMathText=True)
    for axis in grid.flat[len(names):]:
        axis.axis("off")
    for column in range(columns):
        lowest = [grid[row, column] for row in range(rows) if row*columns + column < len(names)][-1]
        lowest.set_xlabel("time [s]")
        lowest.tick_params(labelbottom=True)
    if len(points) > 1:
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center",
                      ncols=max(1, int(13*figure.get_figwidth()/(max(map(len, points)) + 8))))
    title(figure, run.scene if len(points) > 1 else f"{run.scene}, {points[0]}")
    figure.savefig(output)
    plt.close(figure)
    print(output)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="output folder of a run")
    parser.add_argument("--fields", nargs="+", help="u_r u_z v_r v_z a_r a_z p_w p_c p_a s_rr s_zz s_tt s_rz p q e S_w "
                        "ground")
    parser.add_argument("--times", nargs="+", type=float, help="[s]; the nearest moments that were written are taken")
    parser.add_argument("--histories", nargs="+", help="columns of histories.csv without the name of the point")
    parser.add_argument("--window", nargs=2, type=float, metavar=("FROM", "TO"),
                        help="histories of this time alone [s]; default: all, or where nine tenths of the steps lie if "
                        "these take less than a fifth of the time")
    parser.add_argument("--deformed", type=float, default=0.0, metavar="FACTOR", help="draw displacements so many fold")
    parser.add_argument("--output", type=pathlib.Path, help="folder of the pictures; default: that of the run")
    options = parser.parse_args()
    try:
        run = Run(options.folder)
    except (OSError, KeyError, IndexError) as problem:
        sys.exit(f"plot_run: {options.folder} holds no fields of mud_host ({problem}); name the folder of --output")
    output = options.output or options.folder
    output.mkdir(parents=True, exist_ok=True)

    frames = [int(np.argmin(np.abs(np.array(run.times) - t))) for t in options.times] if options.times else [run.peak()]
    names = options.fields and choose(options.fields, run.names, "field")
    names = names or [n for n in USUAL if n in run.names and tells(run, frames[-1], n)][:PAGE] or ["u_z"]
    draw_fields(run, list(dict.fromkeys(frames)), names, options.deformed, output / "fields.png")

    try:
        time, table = read_histories(options.folder)
    except (OSError, tables.TableError) as problem:
        sys.exit(f"plot_run: {problem}")
    if not options.window and crowded(time):
        options.window = crowded(time)
        print(f"plot_run: most steps lie between {options.window[0]:g} and {options.window[1]:g} s, which is what is "
              f"shown; --window {time[0]:g} {time[-1]:g} shows all")
    if options.window:
        inside = (time >= options.window[0]) & (time <= options.window[1])
        time, table = time[inside], {name: values[inside] for name, values in table.items()}
        if not inside.any():
            sys.exit(f"plot_run: no history between {options.window[0]:g} and {options.window[1]:g} s")
    known = list(dict.fromkeys(name.rpartition(".")[2] for name in table))
    names = options.histories and choose(options.histories, known, "history")
    names = names or [n for n in known if any(moves(table[c]) for c in table if c.rpartition(".")[2] == n)]
    if names:
        draw_histories(run, time, table, names, output / "histories.png")


if __name__ == "__main__":
    main()
