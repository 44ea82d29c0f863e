# SPDX-License-Identifier: MIT
"""Pictures of element tests and of the host's histories; they need matplotlib (extra ``plots``)."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .element_test import TestResult
    from .host import HostRun

COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900", "#555555")


def pyplot():
    """matplotlib.pyplot with the style of the project."""
    try:
        import matplotlib
    except ImportError as problem:
        raise ImportError("plots need matplotlib: pip install 'mud-soil[plots]'") from problem
    if not os.environ.get("MPLBACKEND"):
        matplotlib.use("Agg", force=False)
    import matplotlib.pyplot as plt

    plt.rcParams.update(
        {
            "axes.spines.top": False,
            "axes.spines.right": False,
            "legend.frameon": False,
            "font.size": 9,
            "savefig.dpi": 130,
            "lines.linewidth": 1.5,
        }
    )
    return plt


def plot_test(
    tests: TestResult | Mapping[str, TestResult],
    output: str | os.PathLike | None = None,
    laboratory: Mapping[str, np.ndarray] | None = None,
) -> Figure:
    """Four panels of one test, or of several by label: q against axial strain and against p', volumetric strain, void ratio.

    laboratory : columns eps_a and eps_v (linear strain [-]), q, p [kPa], e; those that are there are drawn as points.
    output : picture to write; None returns the figure alone. Returns the matplotlib figure.
    """
    plt = pyplot()
    runs = tests if isinstance(tests, dict) else {"model": tests}
    figure, axes = plt.subplots(2, 2, figsize=(9, 6.5), layout="constrained")
    panels = (
        ("axial strain [%]", "q [kPa]", lambda r: (100 * r.axial_strain, r["q"]), ("eps_a", "q")),
        ("p' [kPa]", "q [kPa]", lambda r: (r["p_eff"], r["q"]), ("p", "q")),
        (
            "axial strain [%]",
            "volumetric strain [%]",
            lambda r: (100 * r.axial_strain, 100 * r.volumetric_strain),
            ("eps_a", "eps_v"),
        ),
        ("p' [kPa]", "void ratio", lambda r: (r["p_eff"], r["e"]), ("p", "e")),
    )
    for axis, (x_label, y_label, values, names) in zip(axes.flat, panels):
        for colour, (label, run) in zip(COLOURS, runs.items()):
            axis.plot(*values(run), color=colour, label=label)
        if laboratory is not None and all(name in laboratory for name in names):
            x, y = (np.asarray(laboratory[n]) * (100 if n.startswith("eps") else 1) for n in names)
            axis.plot(x, y, "o", color=COLOURS[5], ms=3.5, mfc="white", label="laboratory")
        axis.set_xlabel(x_label)
        axis.set_ylabel(y_label)
        axis.grid(color="#dddddd", lw=0.6)
    if len(runs) > 1 or laboratory is not None:
        axes[0, 0].legend()
    if output is not None:
        figure.savefig(output)
        plt.close(figure)
    return figure


def plot_histories(run: HostRun, columns: Sequence[str], output: str | os.PathLike | None = None) -> Figure:
    """Histories of a run of the host against time [s], a panel for each column ("POINT.QUANTITY"). Returns the figure."""
    plt = pyplot()
    table = run.histories
    time = table[next(iter(table))]
    figure, axes = plt.subplots(
        len(columns), 1, figsize=(7, 2.2 * len(columns) + 0.4), sharex=True, squeeze=False, layout="constrained"
    )
    for axis, name in zip(axes[:, 0], columns):
        if name not in table:
            raise KeyError(f"there is no history {name}; there are {', '.join(list(table)[1:])}")
        axis.plot(time, table[name], color=COLOURS[0])
        axis.set_ylabel(name)
        axis.grid(color="#dddddd", lw=0.6)
    axes[-1, 0].set_xlabel("time [s]")
    if output is not None:
        figure.savefig(output)
        plt.close(figure)
    return figure
