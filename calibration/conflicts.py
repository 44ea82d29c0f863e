# SPDX-License-Identifier: MIT
"""Writes into calibration/README.md what fits of Karlsruhe sand with cycles give up for what, by their weights.

usage: calibration/conflicts.py [--check]     --check: changes nothing, exit code 1 if the table is not up to date
"""

import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "common")]
import tables  # noqa: E402
from library import renew  # noqa: E402
from mud.calibration.misfit import misfit_of  # noqa: E402
from mud.calibration.simulation import SETTINGS, simulate  # noqa: E402
from mud.calibration.soundness import LOADED, UNLOADED, compressed  # noqa: E402
from mud.calibration.task import read_task  # noqa: E402
from mud.calibration.variables import parameters_of  # noqa: E402
from mud.material import Material  # noqa: E402

VOID_RATIO = 0.85
BEGIN, END = "<!-- conflicts -->", "<!-- end conflicts -->"
HEAD = (
    "set",
    "q [%], fitted; held out",
    "eps_v [points]",
    "e, largest: fitted; held out",
    "rms of log10 N: fitted; all",
    "N of TCUI1, 4, 8, 10, 19, 20",
    "G/G_max at 1e-4, 1e-3",
    "damping at 1e-3",
    "K0 at OCR 1, 2, 8",
)


def rms(values):
    there = [v for v in values if np.isfinite(v)]
    return float(np.sqrt(np.mean(np.square(there))))


def unloaded(material):
    """K0 of a sample of the tests' void ratio at 400 kPa and, unloaded without radial strain, at 200 and 50 kPa."""
    run = compressed(material, VOID_RATIO, LOADED, 200.0, UNLOADED)
    return [run["sigma_r"][i] / run["sigma_a"][i] for i in run.end_of_stages()[1:]]


def line(name, material, task):
    """The cells of a set."""
    answers = [simulate(material.changed(**SETTINGS), item.test, item.use) for item in task.items]
    told = [misfit_of(item, answer) for item, answer in zip(task.items, answers)]
    off, count, modulus = {}, [], None
    for item, answer in zip(task.items, answers):
        if item.test.kind == "liquefaction":
            log_n = float(answer.columns["log_N"][0])
            off[item.test.name] = log_n - float(item.test["log_N"][0])
            count.append(f"{10**log_n:.0f}")
        elif item.test.kind == "modulus":
            strains = np.round(np.log10(item.test["gamma"]), 3).tolist()
            at = [strains.index(-4.0), strains.index(-3.0)]
            modulus = [answer.columns["G_ratio"][at], answer.columns["damping"][at[1]]]

    def of(quantity, held):
        return [getattr(m, quantity) for m in told if m.held_out == held and np.isfinite(getattr(m, quantity))]

    fitted = [off[item.test.name] for item in task.items if item.test.name in off and not item.test.held_out]
    return (
        name,
        f"{rms(of('q', False)):.1f}; {rms(of('q', True)):.1f}",
        f"{rms(of('eps_v', False)):.2f}",
        f"{max(of('e', False)):.4f}; {max(of('e', True)):.4f}",
        f"{rms(fitted):.2f}; {rms(off.values()):.2f}",
        ", ".join(count),
        f"{modulus[0][0]:.2f}, {modulus[0][1]:.2f}",
        f"{modulus[1]:.2f}",
        ", ".join(f"{ratio:.2f}" for ratio in unloaded(material)),
    )


def table():
    task = read_task(ROOT / "calibration/karlsruhe_cyclic.toml")
    lines = [line("`karlsruhe`, no preloading", Material("karlsruhe"), task)]
    for row in tables.rows(ROOT / "calibration/karlsruhe_cyclic_weights.csv"):
        name = row.pop("weights")
        values = {key: float(value) for key, value in row.items()}
        material = Material(**parameters_of({**task.fixed_variables, **values}, task.base))
        lines.append(line(name, material, task))
    start = Material(ROOT / "calibration" / task.start)
    lines.append(line("oedometer 1.6, cycles 3, modulus 2.5: the start", start, task))
    lines.append(line("**`karlsruhe_cyclic`**", Material("karlsruhe_cyclic"), task))
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (HEAD, ["---"] * len(HEAD), *lines))


if __name__ == "__main__":
    renew(BEGIN, END, table, __doc__, "conflicts.py")
