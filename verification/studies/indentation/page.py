# SPDX-License-Identifier: MIT
"""Indentation of unsaturated soil by a rigid plate: balances of a run, and what the committed analyses say."""
import analysis
import numpy as np
import sensitivity
import series
import settings
from tools import tables
from tools.bench import number
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the paper's indentation at eight suctions with and without the remedy against stress "
          "overshooting: its Table 1 and Figs 3 to 5 beside the results of this program, and the influence "
          "of its open choices",
    kind=("study", "conservation", "regression"),
    input="`indent_s030.nml` (suction 30 kPa, with the remedy) is run; `results/` holds the analyses and "
          "variations of `series.py`, `sensitivity.py`, `settings.py`",
    reference="published numbers and curves; balances of momentum and energy; eq. (24) for S_w; the committed analysis "
              "at 30 kPa",
    seconds=45, quick=3, pictures=("fig2_load.png", "fig3_interface.png", "fig4_errors.png", "fig5_displacement.png",
                                   "sensitivity.png"))
MAKES = (Script("series.py", ("results/*.csv", "results/histories/*.csv"), 1430),
         Script("sensitivity.py", ("results/sensitivity.csv",), 740),
         Script("settings.py", ("results/settings.csv",), 150))

SEATED = Tolerance("the seat is in equilibrium to 1e-8 of all forces; the plate's weight is about 1e-3 of these",
                   absolute=1e-4)
ROUNDED = Tolerance("one evaluation of eq. (24): a few thousand roundings", absolute=1e-12)
IMPULSE = Tolerance("the error of the scheme at the end is of the order of dt m times the last acceleration",
                    absolute=1e-3)
ENERGY = Tolerance("the imbalance of the ledger, against its largest entry: second order in the step, and steps that "
                   "open or close the contact", absolute=1e-3)
UNCHANGED = Tolerance("the series is written with six digits; loading is smooth, rounding does not grow before the "
                      "first unloading", absolute=1e-4)


def check(bench):
    text = (bench.here / "indent_s030.nml").read_text(encoding="utf-8")
    folder = bench.host("indent_s030.nml", [("duration = 0.03999", "duration = 1.5e-3")] if bench.quick else [])
    c, ledger, h = (tables.columns(folder / f"{name}.csv") for name in ("contact", "ledger", "histories"))
    impact = ledger["stage"] == 3
    seated = np.flatnonzero(ledger["stage"] == 2)[-1]
    t, mass = c["time"][impact] - 2, number(text, "mass")

    bench.near("thrust of the seated plate / its weight", c["interface.thrust"][seated] / (9.81 * mass), 1.0, SEATED)
    bench.near("S_w at the start", h["centre.S_w"][0], 1 / np.log(np.e + (30 * 0.8**2 / 5)**2), ROUNDED)
    # Impulse of load and weight against that of the contact and the plate's momentum, at the level of values in a step.
    before = c["plate.load"][seated:-1]
    load = (before + (c["plate.load"][impact] - before) / (1 + number(text, "rho_inf")))[-len(t):]
    impulse = np.sum(load * c["dt"][impact])
    missing = impulse + np.sum(c["interface.thrust"][impact] * c["dt"][impact]) - mass * c["plate.v_z"][-1]
    bench.below("impulse left open / impulse of the load", abs(missing / impulse), IMPULSE)
    entries = ("kinetic", "skeleton", "pores", "gravity", "loads", "supports")
    largest = max(np.abs(ledger[name][impact] - ledger[name][seated]).max() for name in entries)
    left = np.abs(ledger["imbalance"][impact] - ledger["imbalance"][seated]).max()
    bench.below("energy left open / largest entry of the ledger", left / largest, ENERGY)
    # The committed series is of this program: the history of its analysis at 30 kPa.
    kept = tables.columns(analysis.RESULTS / "histories/s0030_remedy.csv")
    common = kept["t_ms"] <= min(1e3 * t[-1], 14) + 1e-6
    place = np.rint(kept["t_ms"][common] / (1e3 * analysis.DT)).astype(int)
    now = -1e3 * (h["centre.u_z"][-len(t) - 1:] - h["centre.u_z"][-len(t) - 1])
    bench.near("displacement / that of the committed series", now[place] / now[place].max(),
               kept["u_mm"][common] / now[place].max(), UNCHANGED)
    if not bench.quick:
        depth = -1e3 * (h["centre.u_z"][-len(t):] - h["centre.u_z"][-len(t) - 1])
        gone = t[(c["interface.thrust"][impact] <= 0) & (t > 0.014)]
        bench.note(f"{len(t)} steps, {ledger['iterations'][impact].sum():.0f} iterations, "
                   f"{np.sum(ledger['iterations'][impact] > 1)} steps with more than one")
        bench.note(f"largest indentation {depth.max():.4f} mm at {1e3 * t[depth.argmax()]:.2f} ms, {depth[-1]:.4f} mm "
                   f"at the end; contact lost at {1e3 * gone[0]:.2f} ms")
        for name in ("p_w", "p_c", "S_w"):
            value = h["centre." + name][-len(t):]
            bench.note(f"{name} under the centre: {value[0]:.5g}, {value.min():.5g} to {value.max():.5g}")
        bench.note((folder / "log.txt").read_text(encoding="utf-8").strip().splitlines()[-1])


def texts(bench):
    """Tables from the committed results."""
    return {"README.md": {**series.texts(analysis.RESULTS), **settings.texts(analysis.RESULTS)},
            "SENSITIVITY.md": sensitivity.texts(analysis.RESULTS)}


def draw(bench, _, plt):
    series.pictures(analysis.RESULTS, bench.picture)
    sensitivity.picture(analysis.RESULTS, bench.picture("sensitivity.png"))
