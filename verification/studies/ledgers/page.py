# SPDX-License-Identifier: MIT
"""Ledgers of effects: what every effect changes in six scenes, beside what the mesh and the steps change."""
import ledgers

from tools import tables
from tools.page import Page, Script, Tolerance
from tools.pictures import COLOURS

PAGE = Page(
    claim="what every effect changes in the answers of six scenes, with the time and the unknowns that it costs, beside what "
          "the mesh and the steps change",
    kind=("study", "regression"),
    input="the paper's indentation at suction 0, 30 and 1000 kPa with the remedy, Terzaghi's column, a dry footing, a site-response "
          "column: `mud_host --ablate` on half the cells along each side, every run with the steps of the first (`ledgers.py`)",
    reference="the scene as it is; for the regression the committed ledgers of the column and the footing",
    seconds=15, quick=0, pictures=("ledgers.png",))
MAKES = (Script("ledgers.py", tuple(f"results/{kind}_{name}.csv" for name in (
    "indentation_0", "indentation_30", "indentation_1000", "terzaghi", "footing", "site")
    for kind in ("effects", "answers", "methods")) + ("results/runs.csv",), 400),)

TITLES = {"indentation_0": "indentation, suction 0", "indentation_30": "indentation, suction 30 kPa",
          "indentation_1000": "indentation, suction 1000 kPa", "terzaghi": "Terzaghi's column", "footing": "dry footing",
          "site": "site response"}
AGAIN = ("terzaghi", "footing")   # run by the check
SAME = Tolerance("rounding of another machine, within Newton's tolerance of 1e-3 of the change in a step", absolute=5e-3)
SMALLEST = 1e-6                   # of the picture, share of an answer's range


def read(bench, kind, name):
    path = bench.here / f"results/{kind}_{name}.csv"
    return tables.rows(path) if path.exists() else []


def check(bench):
    made = ledgers.scenes()
    for name in AGAIN:
        folder = bench.folder()
        base, methods = made[name]
        ledgers.ledger(bench.build / "host/mud_host", name, base, methods, folder, "")
        kept = {row["effect"]: row for row in read(bench, "effects", name)}
        for row in tables.rows(folder / f"effects_{name}.csv"):
            if row["influence"]:
                bench.near(f"{TITLES[name]}: influence of {row['effect']}", float(row["influence"]),
                           float(kept[row["effect"]]["influence"]), SAME)
    return {name: (read(bench, "effects", name), worst_methods(read(bench, "methods", name))) for name in TITLES}


def worst_methods(rows):
    """Of every other mesh, or other steps, the answer that changes most."""
    worst = {}
    for row in rows:
        if row["change"] not in worst or float(row["influence"]) > float(worst[row["change"]]["influence"]):
            worst[row["change"]] = row
    return list(worst.values())


def percent(text):
    value = 100 * float(text)
    return "0" if value < 1e-4 else f"{value:.2g} %"


def lines(bench, name):
    """Rows of the table of a scene: effects, then methods."""
    found = []
    for row in read(bench, "effects", name):
        state = "without" if row["in_scene"] == "yes" else "with"
        if row["influence"]:
            found.append((f"{state} `{row['effect']}`", percent(row["influence"]), row["change"], row["answer"] or "-",
                          row["fewer_unknowns"], row["time_ratio"][:4]))
        else:
            found.append((f"{state} `{row['effect']}`", "-", "-", row["remark"].split(": the run")[0][:110].rstrip("; "), "-", "-"))
    own = {row["scene"]: row for row in tables.rows(bench.here / "results/runs.csv")}.get(name)
    for row in worst_methods(read(bench, "methods", name)):
        found.append((f"**{row['change']}**", percent(row["influence"]), row["difference"], row["answer"],
                      str(int(own["unknowns"]) - int(row["unknowns"])), f"{float(row['seconds']) / float(own['seconds']):.2g}"))
    return found


def remedy(bench):
    """Table 1: what the remedy, the mesh and the steps change in the settlement under the plate."""
    found = []
    for name in ("indentation_0", "indentation_30", "indentation_1000"):
        answers = {row["effect"]: row for row in read(bench, "answers", name) if row["answer"] == "centre.u_z"}
        methods = {row["change"]: row for row in read(bench, "methods", name) if row["answer"] == "centre.u_z"}
        if not answers:
            continue
        pick = [("remedy", answers.get("memory_rule")), *methods.items()]
        found.append((TITLES[name].split(", ")[1], f"{1e3 * float(answers['memory_rule']['range']):.3f}",
                      *(f"{1e3 * float(row.get('change' if what == 'remedy' else 'difference')):+.4f} ({percent(row['influence'])})"
                        for what, row in pick)))
    return tables.markdown(("", "range of the settlement [mm]", "without the remedy [mm]", "mesh of the benchmark [mm]",
                            "steps of the benchmark [mm]"), found)


def texts(bench):
    head = ("", "largest influence", "change [m, kPa]", "of answer", "fewer unknowns", "time ratio")
    marks = {name: tables.markdown(head, lines(bench, name)) for name in TITLES if read(bench, "effects", name)}
    runs = tables.rows(bench.here / "results/runs.csv")
    return {"README.md": {**marks, "remedy": remedy(bench), "runs": tables.markdown(
        tuple(runs[0])[:-1], [tuple(row.values())[:-1] for row in runs])}}


def draw(bench, results, plt):
    figure, axes = plt.subplots(2, 3, figsize=(15, 9))
    for axis, (name, (effects, methods)) in zip(axes.flat, results.items()):
        bars = [(row["effect"], max(float(row["influence"]), SMALLEST), COLOURS[0 if row["in_scene"] == "yes" else 1])
                for row in effects if row["influence"]]
        bars += [(row["change"], max(float(row["influence"]), SMALLEST), COLOURS[2]) for row in methods]
        bars.sort(key=lambda bar: bar[1])
        axis.barh([bar[0] for bar in bars], [100 * bar[1] for bar in bars], color=[bar[2] for bar in bars])
        axis.set(xscale="log", xlim=(100 * SMALLEST, None), title=TITLES[name])
        axis.axvline(1, color="k", lw=0.6)
        axis.tick_params(axis="y", labelsize=8)
    for axis in axes[1]:
        axis.set_xlabel("largest change of an answer [% of its range]")
    handles = [plt.Rectangle((0, 0), 1, 1, color=COLOURS[i]) for i in range(3)]
    figure.legend(handles, ["without the effect", "with the effect, which the scene does not have", "other mesh, other steps"],
                  loc="lower center", ncols=3)
    figure.set_layout_engine("tight", rect=(0, 0.05, 1, 1))
    bench.save(figure, "ledgers.png")
