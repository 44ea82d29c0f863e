# SPDX-License-Identifier: MIT
"""Cyclic simple shear of unsaturated sand at constant suction: volume lost in 200 cycles, measured and computed."""
import make_results as series

from tools import tables
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="volume that unsaturated sand loses in 200 drained cycles of simple shear: sign and order of the twelve tests beside "
          "those of the published set of Toyoura sand, which meets them in part",
    kind=("study", "regression"),
    input="vertical net stress 50 kPa, K0 0.5, amplitudes 0.3 to 5 %, suctions 4, 6, 10 kPa; retention fitted to the tests' S_w; e 0.806, "
          "relative density 45 % of Toyoura sand (`make_results.py`)",
    reference="Rong & McCartney (2019), digitised; another sand, of e 0.64; for the regression `results.csv`",
    seconds=20, quick=4, pictures=("seismic_compression.png",))
MAKES = (Script("make_results.py", ("results.csv",), 75),)

CURVE = Tolerance("three points and two exponents; what the fit leaves", absolute=0.01)
SAME = Tolerance("rounding of another machine within the tolerance of 1e-3 of the stress integration", absolute=0.05)
AGAIN = 0.3   # amplitude of the tests that the check runs again [%]


def key(row):
    return float(row["gamma_amplitude_percent"]), float(row["suction_kPa"])


def check(bench):
    rows = tables.rows(bench.here / "results.csv")
    tests = {key(test): test for test in series.tests()}
    variants = [v for v in series.VARIANTS if any(row["variant"] == v for row in rows)]
    for variant in variants[:1 if bench.quick else None]:
        kept = {key(row): row for row in rows if row["variant"] == variant}
        test = tests[AGAIN, 6.0]
        row = dict(zip(series.COLUMNS, series.run(bench.build, variant, test)))
        bench.near(f"{variant}: volume lost at {AGAIN} % and 6 kPa", float(row["eps_v_200_percent"]),
                   float(kept[AGAIN, 6.0]["eps_v_200_percent"]), SAME, "%")
        bench.near(f"{variant}: S_w at the start", float(row["S_w_initial"]), test["S_w_initial"], CURVE)
    return rows


def sentence(values, by):
    """Whether numbers rise or fall along a list."""
    steps = [b - a for a, b in zip(values, values[1:])]
    if all(step > 0 for step in steps):
        return f"rises with {by}"
    return f"falls with {by}" if all(step < 0 for step in steps) else f"neither rises nor falls with {by}"


def verdicts(rows, measured):
    """Of every variant: in how many tests the sign is that of the test, and the order of the suctions and amplitudes."""
    lines = []
    sources = {"measured": measured}
    for row in rows:
        sources.setdefault(row["variant"], {})[key(row)] = float(row["eps_v_200_percent"])
    amplitudes = sorted({a for a, _ in measured})
    suctions = sorted({s for _, s in measured})
    for name, found in sources.items():
        falls = sum(sentence([found[a, s] for s in suctions], "").startswith("falls") for a in amplitudes)
        rises = sum(sentence([found[a, s] for a in amplitudes], "").startswith("rises") for s in suctions)
        lines.append((name, f"{sum(v > 0 for v in found.values())} of 12", f"{falls} of 4", f"{rises} of 3"))
    return lines


def texts(bench):
    rows = tables.rows(bench.here / "results.csv")
    measured = {key(test): test["eps_v_200_percent"] for test in series.tests()}
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    of = {(row["variant"], *key(row)): row["eps_v_200_percent"] for row in rows}
    table = [(f"{a:g}", f"{s:g}", f"{value:.2f}", *(f"{float(of[v, a, s]):.2f}" for v in variants))
             for (a, s), value in measured.items()]
    return {"README.md": {
        "tests": tables.markdown(("amplitude [%]", "suction [kPa]", "measured [%]", *(f"{v} [%]" for v in variants)), table),
        "orders": tables.markdown(("", "volume is lost", "less of it with more suction, amplitudes", "more of it with the amplitude, "
                                   "suctions"), verdicts(rows, measured))}}


def draw(bench, rows, plt):
    measured = {key(test): test["eps_v_200_percent"] for test in series.tests()}
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    figure, axes = plt.subplots(1, 1 + len(variants), figsize=(3.6 * (1 + len(variants)), 3.8), sharey=True)
    found = {v: {key(row): float(row["eps_v_200_percent"]) for row in rows if row["variant"] == v} for v in variants}
    for axis, (name, values) in zip(axes, ({"measured": measured} | found).items()):
        for i, suction in enumerate(sorted({s for _, s in measured})):
            points = sorted((a, v) for (a, s), v in values.items() if s == suction)
            axis.semilogx(*zip(*points), "o-", color=COLOURS[i], label=f"suction {suction:g} kPa")
        axis.axhline(0, color="k", lw=0.6)
        axis.set(title=name, xlabel="shear strain amplitude [%], logarithmic")
    axes[0].set_ylabel("volume lost in 200 cycles [%]")
    axes[0].legend()
    bench.save(figure, "seismic_compression.png")
