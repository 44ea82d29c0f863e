# SPDX-License-Identifier: MIT
"""What --price estimates, against runs on finer meshes."""
import math
import pathlib
import textwrap

import study
import table_1
from analysis import SUCTIONS

from tools import tables
from tools.page import Page, Script, Tolerance
from tools.results import MISSED

PAGE = Page(
    claim="errors of the mesh that `--price` estimates are within a factor of three of those against a mesh four times "
          "as fine, quoted times within a factor of two, with the exceptions that are listed; the paper's benchmark at "
          "converged meshes",
    kind=("study",),
    input="`study.py`: nine scenes on which the method was tried and eight on which nothing was chosen; `table_1.py`: "
          "the indentation at eight suctions",
    reference="the same scenes on meshes of twice and four times their cells, with the same steps",
    seconds=8, quick=8, pictures=("front.png",))
MAKES = (Script("study.py", ("results.csv", "times.csv"), 400), Script("table_1.py", ("table_1.csv",), 900),
         Script("table_1_fine.py", ("table_1_fine.csv",), 4000, alone=True))

FACTOR = Tolerance("a factor of three", absolute=math.log10(3.0))
FEW = Tolerance("at most one of twenty", absolute=0.05)
ORDERS = 1.0, 2.0       # of convergence that an estimate takes, host.md section 12
WEAK = 0.5              # an order below it says nothing: the distance of the meshes is the bar
NONE, FAR = 0.2, 0.02   # below that order and beyond that distance meshes do not converge, host.md section 12


def committed(name):
    return tables.rows(pathlib.Path(__file__).parent / name)


def check(bench):
    rows, _ = study.compare(bench.program("host/mud_host"), "terzaghi/scene", bench.folder())
    for _, answer, _, state, _, _, ratio in rows:
        if state == "ok":
            bench.near(f"Terzaghi, {answer}: logarithm of the estimated over the true error of the mesh",
                       math.log10(float(ratio)), 0.0, FACTOR)
    known = [float(r["ratio"]) for r in committed("results.csv") if r["ratio"]]
    bench.near("share of the estimates of the table that are too small by more than three",
               sum(x < 1/3 for x in known)/len(known), 0, FEW)
    return None


def counts(rows, what):
    """How many of them are how far off."""
    known = [float(r["ratio"]) for r in rows if r["ratio"]]
    inside, low = sum(1/3 < x < 3 for x in known), sum(x <= 1/3 for x in known)
    failed = [r["scene"] for r in rows if not r["ratio"]]
    told = [float(r["ratio"]) for r in rows if r["ratio"] and r["state"] != "does not converge"]
    shown = [float(r["ratio"]) for r in rows if r["ratio"] and r["state"] != "masked"]
    bounds = [float(r["ratio"]) for r in rows if r["ratio"] and r["state"] == "masked"]
    said = (f"Of {len(known)} estimates of {what} {inside} are within a factor of three, {low} too small by more, "
            f"{len(known) - inside - low} too large by more; without the {len(known) - len(told)} that the table says do "
            f"not converge {sum(1/3 < x < 3 for x in told)} of {len(told)} are within it, "
            f"{100*sum(1/3 < x < 3 for x in told)/len(told):.0f} %; of the {len(shown)} that are not masked "
            f"{sum(1/3 < x < 3 for x in shown)} are within a factor of three, of the {len(bounds)} upper bounds "
            f"{sum(x > 1/3 for x in bounds)} hold within one.")
    return said + (f" No estimate, since a run failed: {', '.join(failed)}." if failed else "")


def near(rows, what, answers):
    """Quotes within a factor of two, by how many times the cells of the finest mesh of the quote were halved."""
    finest = {r["scene"]: float(r["fineness"]) for r in answers if r["fineness"]}
    by = {}
    for r in rows:
        by.setdefault(round(math.log2(float(r["fineness"])/finest[r["scene"]])), []).append(float(r["ratio"]))
    words = {0: "on the finest mesh of the quote", 1: "one level ahead of it", 2: "two levels ahead",
             3: "three levels ahead"}
    said = [f"{sum(0.5 < x < 2 for x in by[n])} of {len(by[n])} {words[n]}" for n in sorted(by)]
    return f"Times of {what} within a factor of two: {', '.join(said)}."


def missed(rows):
    """Runs that were compared with although they did not meet the accuracy of their steps."""
    there = [f"{r['scene']} at {r['fineness']}" for r in rows if r["code"] == str(MISSED)]
    return (f"{len(there)} of {len(rows)} runs to compare with end with exit code {MISSED}: an estimate of their steps is "
            f"beyond three times the accuracy" + (f" ({', '.join(there)})." if there else "."))


def runs(suction, mesh):
    """Rows of the benchmark by fineness and setting."""
    return {(float(r["fineness"]), r["setting"]): r for name in ("table_1.csv", "table_1_fine.csv")
            for r in committed(name) if int(r["suction"]) == suction and r["mesh"] == mesh and r["peak"]}


def change(rows, key, other, what="peak"):
    """By how much a run is off another."""
    return float(rows[key][what])/float(rows[other][what]) - 1


def settlement(suction):
    """Row of the finest graded mesh, shares of its largest settlement that mesh, steps and Newton's method may leave,
    and the order that three meshes show; of two meshes the order is the least that an estimate takes."""
    rows = runs(suction, "graded")
    meshes = sorted(f for f, setting in rows if setting == "1e-2")[-3:]
    *coarse, middle, fine = (float(rows[f, "1e-2"]["peak"]) for f in meshes)
    mesh, order = abs(1 - middle/fine)/(2**ORDERS[0] - 1), None
    if coarse:
        before, last = abs(middle - coarse[0])/fine, abs(1 - middle/fine)
        order = math.log2(before/last)
        mesh = last/(2**min(max(order, ORDERS[0]), ORDERS[1]) - 1) if order >= WEAK else max(before, last)
    steps, newton = (share*abs(change(rows, (0.5, setting), (0.5, "1e-2"))) if (0.5, setting) in rows else None
                     for setting, share in (("2.5e-3", 4/3), ("newton", 1)))
    return rows[meshes[-1], "1e-2"], mesh, steps, newton, order


def table_1_text():
    """Settlements with their bars."""
    lines = []
    for suction in SUCTIONS:
        row, mesh, steps, newton, order = settlement(suction)
        lines.append((suction, row["elements"], f"{float(row['peak']):#.4g}",
                      f"{100*(mesh + (steps or 0) + (newton or 0)):.2g}", f"{100*mesh:.2g}",
                      *("not run" if x is None else f"{100*x:.2g}" for x in (steps, newton)),
                      "assumed" if order is None else
                      f"{order:.2g}" + ", does not converge"*(order < NONE and mesh > FAR)))
    good = [line[0] for line in lines if float(line[3]) <= 1 and "not run" not in line]
    return tables.markdown(("suction [kPa]", "elements", "settlement [mm]", "bar [%]", "of it mesh", "steps", "Newton",
                            "order"), lines) + textwrap.fill(
        f"Settlement to 1 % at {len(good)} of {len(lines)} suctions: {', '.join(map(str, good)) or 'none'} kPa.", 118)


def settings_text():
    """What the paper's mesh, step and tolerances err and cost, and what the graded mesh of half fineness does."""
    lines = []
    for suction in SUCTIONS:
        exact, paper, graded = float(settlement(suction)[0]["peak"]), runs(suction, "paper"), runs(suction, "graded")
        own, same, coarse = paper[1.0, "paper"], paper[1.0, "1e-2"], graded[0.5, "1e-2"]

        def off(row, exact=exact):
            return f"{100*(float(row['peak'])/exact - 1):+.2g}"
        lines.append((suction, off(same), f"{100*change(paper, (1.0, 'paper'), (1.0, '1e-2')):+.2g}",
                      f"{float(own['seconds'])/float(same['seconds']):.2g}", off(coarse),
                      f"{float(coarse['seconds'])/float(same['seconds']):.2g}"))
    elements = runs(table_1.FRONT, "graded")[0.5, "1e-2"]["elements"]
    return tables.markdown(("suction [kPa]", "the paper's mesh [%]", "its step and tolerance [%]", "time of these",
                            f"{elements} graded elements [%]", "time of these"), lines)


def newton_text():
    """The largest settlement with the default tolerance of Newton's method and with a hundredth of it."""
    rows = runs(table_1.FRONT, "paper")
    meshes = sorted({f for f, setting in rows if setting == "newton"})
    lines, worst = [], 0.0
    for accuracy, tight in (("1e-2", "newton"), ("2.5e-3", "2.5e-3 newton")):
        for said, setting in (("default", accuracy), (table_1.NEWTON, tight)):
            lines.append((accuracy, said, *(f"{float(rows[f, setting]['peak']):.5f}" if (f, setting) in rows else ""
                                            for f in meshes)))
        worst = max(worst, *(abs(change(rows, (f, accuracy), (f, tight))) for f in meshes if (f, tight) in rows))
    return tables.markdown(("accuracy", "Newton's tolerance", *(f"{f:g} times the cells" for f in meshes)), lines) + (
        f"The two rows of an accuracy differ by at most {100*worst:.2g} %.")


def texts(bench):
    answers, times = committed("results.csv"), committed("times.csv")
    old, new = ([r for r in answers if (r["scene"] in study.NEW) == held] for held in (False, True))
    quoted, others = ([r for r in times if (r["scene"] in study.NEW) == held] for held in (False, True))
    said = "\n".join(f"- {line}" for line in (
        counts(old, "the nine scenes"), counts(new, "the new scenes"), near(quoted, "the nine scenes", answers),
        near(others, "the new scenes", answers), missed(times)))
    return {"README.md": {
        "answers": tables.markdown(("scene", "answer", "fineness", "state", "estimated", "true", "ratio"),
                                   [tuple(r[n] for n in study.ANSWERS) for r in answers]),
        "times": tables.markdown(("scene", "fineness", "quoted [s]", "taken [s]", "ratio", "exit code"),
                                 [tuple(r[n] for n in study.TIMES) for r in times]),
        "counts": "\n".join(textwrap.fill(line, 118, subsequent_indent="  ") for line in said.split("\n")),
        "table_1": table_1_text(), "settings": settings_text(), "newton": newton_text()}}


def draw(bench, results, plt):
    """For the README of the top: error against time of the indentation at 30 kPa, the mesh included."""
    from tools.pictures import COLOURS
    rows = [r for r in committed("table_1.csv") if int(r["suction"]) == table_1.FRONT and r["peak"]]
    exact, bar = float(settlement(table_1.FRONT)[0]["peak"]), 100*sum(settlement(table_1.FRONT)[1:4])
    figure, axis = plt.subplots(figsize=(6.2, 3.8))

    paper = next(r for r in rows if r["setting"] == "paper")

    def off(row):
        return 100*abs(float(row["peak"])/exact - 1)

    def cost(row):
        return float(row["seconds"])/float(paper["seconds"])
    for mesh, fineness, mark, colour in (("paper", 0.25, "o-", 0), ("paper", 0.5, "s-", 1), ("paper", 1, "D-", 2),
                                         ("paper", 2, "^-", 3), ("graded", 0.5, "s--", 1), ("graded", 1, "D--", 2)):
        these = runs(table_1.FRONT, mesh)
        there = sorted((cost(r), off(r)) for (f, setting), r in these.items()
                       if f == fineness and setting in ("4e-2", "1e-2", "2.5e-3"))
        words = f"{these[fineness, '1e-2']['elements']} elements" + (", graded to the rim" if mesh == "graded" else "")
        axis.loglog(*zip(*there), mark, color=COLOURS[colour], markersize=5, label=words,
                    markerfacecolor="none" if mesh == "graded" else None)
    axis.loglog([cost(paper)], [off(paper)], "*", color=COLOURS[4], markersize=13,
                label="settings of the paper")
    axis.axhspan(0.1, bar, color="0.9")
    axis.text(axis.get_xlim()[0]*1.1, 0.85*bar, "what the reference leaves", color="0.4", fontsize=8, va="top")
    axis.set_ylim(0.2, 40)
    axis.set_yticks([0.3, 1, 3, 10, 30], ["0.3", "1", "3", "10", "30"])
    axis.set_xticks([0.03, 0.1, 0.3, 1], ["0.03", "0.1", "0.3", "1"])
    axis.set_xlabel("processor time over that of the paper's settings")
    axis.set_ylabel("error of the settlement [%]")
    axis.set_title("Indentation at 30 kPa: mesh, steps and Newton's method together", fontsize=10)
    axis.legend(fontsize=7.5)
    bench.save(figure, "front.png")
