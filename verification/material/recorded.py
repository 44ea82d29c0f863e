# SPDX-License-Identifier: MIT
"""Pages that state what the published parameter set gives: measured values are kept in results.csv."""
import math
import os
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
from point_walk import Soil  # noqa: E402
from tools import results, runner, tables  # noqa: E402
from tools.bench import ROOT, Bench  # noqa: E402
from tools.page import Tolerance  # noqa: E402

# The published model has no elastic domain, forgets at every reversal, and every rise of p' is plastic; the default is what a user gets who sets nothing.
PUBLISHED, DEFAULT = "published (classic, rho_e 0)", "default"
PARAMETERS = {PUBLISHED: {"memory_rule": 0, "rho_e": 0.0, "isotropic": 1}, DEFAULT: {}}
DRIVER = {PUBLISHED: "   memory_rule = 'classic'\n   rho_e = 0.0\n   isotropic = 1\n", DEFAULT: ""}


NONE = Tolerance("recorded for the same paths", absolute=0.0)
AGAIN = Tolerance("the recorded value has 5 digits; other compilers round otherwise and the integration is good to 1e-5 a substep", relative=2e-3,
                  absolute=1e-6)


def soils():
    """The materials of the two columns, for mud_walk."""
    return {name: Soil(properties=tuple(p.items())) for name, p in PARAMETERS.items()}


def make(script):
    """Writes results.csv from what the page of this folder measures."""
    folder = pathlib.Path(script).resolve().parent
    page = runner.load(str(folder.relative_to(HERE.parent)))
    made = results.folder(script)
    measured = page.measure(Bench(folder, os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release", made / "scratch"))
    tables.write(made / "results.csv", ("quantity", "column", "value"),
                 [(quantity, column, f"{value:.5g}") for (quantity, column), value in measured.items()],
                 ["made by make_results.py"])


def read(bench):
    return {(row["quantity"], row["column"]): float(row["value"]) for row in tables.rows(bench.here / "results.csv")}


def compare(bench, measured, tolerance=AGAIN, what="values"):
    """Measured against recorded values, column by column; what was never reached (NaN) has to stay so."""
    recorded = read(bench)
    for column in dict.fromkeys(column for _, column in measured):
        pairs = [(value, recorded[key]) for key, value in measured.items() if key[1] == column]
        bench.near(f"{what}, {column}: marks reached in one of both runs only", sum(math.isnan(a) != math.isnan(b) for a, b in pairs),
                   0, NONE)
        both = [pair for pair in pairs if not any(map(math.isnan, pair))]
        if both:
            bench.near(f"{what}, {column}", *zip(*both), tolerance)


def shown(value):
    if value is None:
        return ""
    if math.isnan(value):
        return "never"
    if abs(value) < 1e-9:
        return "0"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def table(bench, columns, head=""):
    """The recorded values as a table of a README."""
    values = read(bench)
    lines = [(quantity, *(shown(values.get((quantity, column))) for column in columns))
             for quantity in dict.fromkeys(q for q, column in values if column in columns)]
    return tables.markdown((head, *columns), lines)
