# SPDX-License-Identifier: MIT
"""The drained tests of Verdugo & Ishihara (1996) on Toyoura sand, and how a run is compared with them."""
import pathlib

import numpy as np
from tools import tables

DATA = pathlib.Path(__file__).resolve().parent / "verdugo_ishihara_1996_drained_TC.csv"
TESTS = ("TMD4", "TMD5", "TMD6", "TMD1", "TMD2", "TMD3")   # densest first, at 100 and at 500 kPa
LOWEST, HIGHEST = 1.0, 25.0   # % of axial strain: below, the digitised curves are piecewise linear


def read():
    """Per test: sigma_r [kPa], e_0, and columns eps_a [%], eps_v [%], q [kPa], p [kPa], e."""
    columns = {"eps_a": "eps_a_pct", "eps_v": "eps_v_pct", "q": "q_kPa_derived", "p": "p_kPa_derived", "e": "e_derived"}
    rows, tests = tables.rows(DATA), {}
    for name in TESTS:
        mine = [row for row in rows if row["test"] == name]
        tests[name] = {"sigma_r": float(mine[0]["sigma3_kPa"]), "e_0": float(mine[0]["e0"]),
                       **{key: np.array([float(row[column]) for row in mine]) for key, column in columns.items()}}
    return tests


def used(test):
    """The rows that count."""
    return (test["eps_a"] >= LOWEST) & (test["eps_a"] <= HIGHEST)


def volumetric_strain(run):
    """Linear volumetric strain [%] as the laboratory reports it, (e_0 - e)/(1 + e_0); the model's own is natural."""
    return 100 * (run["e"][0] - run["e"]) / (1 + run["e"][0])


def misfit(run, test):
    """Over the laboratory rows from 1 to 25 %: rms of q/q_lab - 1 [%], and of the volumetric strain [points]."""
    def rms(values):
        return float(np.sqrt(np.mean(np.square(values))))
    strain = test["eps_a"][used(test)]
    q = np.interp(strain, 100 * run["eps_a"], run["q"])
    volume = np.interp(strain, 100 * run["eps_a"], volumetric_strain(run))
    return 100 * rms(q / test["q"][used(test)] - 1), rms(volume - test["eps_v"][used(test)])
