# SPDX-License-Identifier: MIT
"""Pictures of element tests and of the host's histories; they need matplotlib (extra ``plots``)."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .element_test import TestResult
    from .host import HostRun

COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900", "#555555")
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1)))
STYLE = {
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "font.size": 9,
    "savefig.dpi": 130,
    "lines.linewidth": 1.5,
}
_POINTS = {"marker": "o", "ls": "", "color": COLOURS[5], "ms": 3.5, "mfc": "white"}


def pyplot():
    """matplotlib.pyplot; for files alone where nobody has chosen a backend or imported it before."""
    try:
        import matplotlib
    except ImportError as problem:
        raise ImportError("plots need matplotlib: pip install 'mud-soil[plots]'") from problem
    chosen = isinstance(dict.__getitem__(matplotlib.rcParams, "backend"), str)  # rcParams["backend"] would choose one
    if not chosen and "matplotlib.pyplot" not in sys.modules:
        matplotlib.use("Agg", force=False)
    import matplotlib.pyplot as plt

    return plt


@contextlib.contextmanager
def style() -> Iterator[None]:
    """The style of the project for what is drawn meanwhile, also as a decorator; the user's own comes back."""
    with pyplot().rc_context(STYLE):
        yield


# Of a range, a share of its scale below which it is constant.
_SMALL = 1e-9
# Column -> (label, factor).
_LABELS = {
    "eps_a": ("axial strain [%]", 100),
    "eps_v": ("volumetric strain [%]", 100),
    "gamma_13": ("shear strain [%]", 100),
    "q": ("deviator stress q [kPa]", 1),
    "sig_13": ("shear stress [kPa]", 1),
    "p_eff": ("mean effective stress p' [kPa]", 1),
    "u": ("excess pore pressure [kPa]", 1),
    "e": ("void ratio [-]", 1),
    "suction": ("suction [kPa]", 1),
    "s_w": ("degree of saturation [-]", 1),
    "r_u": ("pore pressure ratio [-]", 1),
    "cycle": ("cycle", 1),
    "psi": ("state parameter [-]", 1),
    "n_substep": ("substeps since the start", 1),
}
# Names of a laboratory's columns -> those of a result.
_LABORATORY = {name: name for name in _LABELS if name not in ("psi", "n_substep")}
_LABORATORY |= {"p": "p_eff", "S_w": "s_w", "gamma": "gamma_13", "tau": "sig_13"}


def panels(runs: Sequence[Mapping[str, np.ndarray]]) -> list[tuple[str, str, str, bool]]:
    """(title, x column, y column, logarithmic x) for what happens in results of mud_triax: paths of stress and strain
    always, pore pressure where it builds up, suction and saturation where suction moves, cycles where there are any."""

    def moves(name: str, scale: float | str = "") -> bool:
        """Whether a column moves, measured by a number, by another column or by its own size."""
        return any(
            name in run
            and np.ptp(run[name])
            > _SMALL * (max(1e-30, np.max(np.abs(run[scale or name]))) if isinstance(scale, str) else scale)
            for run in runs
        )

    shear = moves("gamma_13", 1.0)
    strain, stress = ("gamma_13", "sig_13") if shear else ("eps_a", "q")
    strain = strain if moves(strain, 1.0) else "eps_v"
    pages = []
    if moves(stress, "p_eff"):
        pages += [("stress and strain", strain, stress, False), ("stress path", "p_eff", stress, False)]
    if moves("eps_v", 1.0) and strain != "eps_v":
        pages.append(("volume", strain, "eps_v", False))
    if moves("u", "p_eff"):
        pages.append(("pore pressure", strain, "u", False))
    if moves("e"):
        pages.append(("state", "p_eff", "e", True))
    else:
        pages.append(("mean stress", strain, "p_eff", False))
    if moves("suction"):
        pages += [("retention", "suction", "s_w", False), ("wetting and drying", "suction", "e", False)]
    if moves("r_u") and moves("cycle"):
        pages += [("pore pressure by cycles", "cycle", "r_u", False), ("strain by cycles", "cycle", strain, False)]
    pages += [("state parameter", strain, "psi", False), ("cost", strain, "n_substep", False)]
    return [page for page in pages if any(page[1] in run and page[2] in run for run in runs)]


def values_of(run: Mapping[str, np.ndarray], name: str) -> np.ndarray:
    """A column as it is drawn: strains in per cent, axial and volumetric ones linear as a laboratory reports them; cycles
    counted on from row to row."""
    values = run[name]
    if name == "cycle":
        return _counted(run["stage"] if "stage" in run else np.zeros(len(values)), values)
    if name == "eps_a":
        values = -np.expm1(-values)
    elif name == "eps_v":
        values = (run["e"][0] - run["e"]) / (1 + run["e"][0])
    return _LABELS[name][1] * values


def _counted(stage: np.ndarray, cycle: np.ndarray) -> np.ndarray:
    """The number of the cycle as a count that grows over its rows in each stage and is whole at its end."""
    counted = cycle.astype(float)
    for place in {(one, number) for one, number in zip(stage, cycle) if number > 0}:
        rows = np.flatnonzero((stage == place[0]) & (cycle == place[1]))
        counted[rows] = place[1] - 1 + np.arange(1, len(rows) + 1) / len(rows)
    return counted


def logarithmic(axis) -> None:
    """A logarithmic x axis of what was drawn, with numbers between the powers of ten where it spans less than two of them."""
    from matplotlib.ticker import LogFormatter

    axis.set_xscale("log")
    low, high = axis.get_xlim()
    if high > 100 * low:
        return
    for which in (axis.xaxis.set_major_formatter, axis.xaxis.set_minor_formatter):
        which(LogFormatter(labelOnlyBase=False, minor_thresholds=(2, 0.6)))


def draw(
    plt, runs: Mapping[str, Mapping[str, np.ndarray]], pages: Sequence[tuple[str, str, str, bool]], unit: str = "kPa"
) -> Figure:
    """A figure with a panel for each of ``pages``, a line for each run; the key stands below the panels. unit : of stress."""
    wide = 3 if len(pages) > 4 else 2
    high = -(-len(pages) // wide)
    figure, axes = plt.subplots(high, wide, figsize=(4.3 * wide, 3.3 * high + 0.3), squeeze=False, layout="constrained")
    for axis, (title, x, y, log) in zip(axes.flat, pages):
        for i, run in enumerate(runs.values()):
            if x in run and y in run:
                line = {"color": COLOURS[i % len(COLOURS)], "ls": LINES[i // len(COLOURS) % len(LINES)]}
                axis.plot(values_of(run, x), values_of(run, y), **line, lw=0.7 if run["cycle"].max() > 5 else 1.5)
                axis.plot(values_of(run, x)[0], values_of(run, y)[0], "o", color=line["color"], ms=4)
        axis.set_title(title, fontsize=10)
        axis.set_xlabel(_LABELS[x][0].replace("kPa", unit) + (", logarithmic" if log else ""))
        axis.set_ylabel(_LABELS[y][0].replace("kPa", unit))
        axis.grid(color="#dddddd", lw=0.6)
        if log:
            logarithmic(axis)
    for axis in axes.flat[len(pages) :]:
        axis.axis("off")
    return figure


def key(plt, figure: Figure, labels: Sequence[str], laboratory: bool = False) -> None:
    """The key of ``draw`` below the panels, a line for each run."""
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=COLOURS[i % len(COLOURS)], ls=LINES[i // len(COLOURS) % len(LINES)], label=label)
        for i, label in enumerate(labels)
    ]
    if laboratory:
        handles.append(Line2D([], [], **_POINTS, label="laboratory"))
    figure.legend(handles=handles, loc="outside lower center", ncols=min(4, len(handles)))


@style()
def plot_test(
    tests: TestResult | Mapping[str, TestResult] | Sequence[TestResult],
    output: str | os.PathLike | None = None,
    laboratory: Mapping[str, np.ndarray] | None = None,
) -> Figure:
    """Panels of one test, of several by label, or of a list: what they show follows from what moves in the tests, shear,
    pore pressure, cycles and suction included.

    laboratory : columns eps_a and eps_v (linear strain [-]), gamma, q, tau, p, u, suction [kPa, or the unit of stress of
        the tests], e, S_w, r_u, cycle; where a panel has both of its columns they are drawn as points.
    output : picture to write; None returns the figure alone. Returns the matplotlib figure.
    """
    from .errors import InputError

    if isinstance(tests, Mapping):
        runs = {"model": tests} if "eps_a" in tests else dict(tests)
    else:
        runs = {f"test {i}": test for i, test in enumerate(tests, 1)}
    if not runs:
        raise InputError("there is no test to draw")
    for label, run in runs.items():
        if not isinstance(run, Mapping) or "eps_a" not in run:
            raise InputError(f"{label} is {run!r}: each is a result of mud.element_test, or columns of one by name")
    units = {label: getattr(run, "units", {}).get("q", "kPa") for label, run in runs.items()}
    unit, *others = dict.fromkeys(units.values())
    if others:
        told = ", ".join(f"{label} in {one}" for label, one in units.items())
        raise InputError(f"the stresses of the tests have different units: {told}; draw those of one unit together")
    measured = {}
    for name, values in (laboratory or {}).items():
        if name not in _LABORATORY:
            raise InputError(
                f"laboratory: there is no column {name} to draw; there are {', '.join(sorted(_LABORATORY))}"
            )
        measured[_LABORATORY[name]] = _LABELS[_LABORATORY[name]][1] * np.asarray(values, dtype=float)
    plt = pyplot()
    pages = [page for page in panels(list(runs.values())) if page[0] not in ("cost", "state parameter")]
    figure, drawn = draw(plt, runs, pages, unit), set()
    for axis, (_, x, y, _) in zip(figure.axes, pages):
        if x in measured and y in measured:
            axis.plot(measured[x], measured[y], **_POINTS)
            drawn |= {x, y}
    if measured and not drawn:
        plt.close(figure)
        raise InputError(
            f"laboratory: no panel shows two of {', '.join(laboratory)}; the panels show "
            + ", ".join(f"{y} over {x}" for _, x, y, _ in pages)
        )
    if len(runs) > 1 or drawn:
        key(plt, figure, list(runs), bool(drawn))
    if output is not None:
        figure.savefig(output)
        plt.close(figure)
    return figure


@style()
def plot_histories(run: HostRun, columns: Sequence[str], output: str | os.PathLike | None = None) -> Figure:
    """Histories of a run of the host against time [s], a panel for each column ("POINT.QUANTITY"). Returns the figure."""
    from .errors import InputError, UnknownName

    columns = [columns] if isinstance(columns, str) else list(columns)
    if not columns:
        raise InputError('there is no history to draw: columns is empty; it is a list such as ["foot.u_z"]')
    plt = pyplot()
    table = run.histories
    time = table[next(iter(table))]
    figure, axes = plt.subplots(
        len(columns), 1, figsize=(7, 2.2 * len(columns) + 0.4), sharex=True, squeeze=False, layout="constrained"
    )
    for axis, name in zip(axes[:, 0], columns):
        if name not in table:
            plt.close(figure)
            raise UnknownName(f"there is no history {name}; there are {', '.join(list(table)[1:])}")
        axis.plot(time, table[name], color=COLOURS[0])
        axis.set_ylabel(name)
        axis.grid(color="#dddddd", lw=0.6)
    axes[-1, 0].set_xlabel("time [s]")
    if output is not None:
        figure.savefig(output)
        plt.close(figure)
    return figure
