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
MAKES = (Script("study.py", ("results.csv", "times.csv"), 290), Script("table_1.py", ("table_1.csv",), 820))

FACTOR = Tolerance("a factor of three", absolute=math.log10(3.0))
FEW = Tolerance("at most one of twenty", absolute=0.05)
ORDERS = 1.0, 2.0       # of convergence that an estimate takes, host.md section 12
WEAK = 0.5              # an order below it says nothing: the distance of the meshes is the bar


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


def of_paper(suction):
    """What the paper's step and tolerance change of the settlement on its mesh, its time over that of controlled steps
    there, and that of twice the cells over that of its own."""
    rows = {(float(r["fineness"]), r["setting"]): r for r in committed("table_1.csv")
            if int(r["suction"]) == suction and r["peak"]}
    paper, same = rows[1.0, "paper"], rows[1.0, "1e-2"]
    return (float(paper["peak"])/float(same["peak"]) - 1, float(paper["seconds"])/float(same["seconds"]),
            float(rows[2.0, "1e-2"]["seconds"])/float(same["seconds"]))


def settlement(suction):
    """Finest mesh, its largest settlement [mm], shares of it that mesh, steps and Newton's method may leave, the order
    that three meshes show, and by how much the paper's mesh differs."""
    rows = {(float(r["fineness"]), r["setting"]): float(r["peak"]) for r in committed("table_1.csv")
            if int(r["suction"]) == suction and r["peak"]}
    meshes = sorted(f for f, setting in rows if setting == "1e-2")[-3:]
    coarse, middle, fine = (rows[f, "1e-2"] for f in meshes)
    before, last = abs(middle/fine - coarse/fine), abs(1 - middle/fine)
    order = math.log2(before/last)
    mesh = last/(2**min(max(order, ORDERS[0]), ORDERS[1]) - 1) if order >= WEAK else max(before, last)
    half = rows[0.5, "1e-2"]
    steps = 4/3*abs(rows[0.5, "2.5e-3"]/half - 1) if (0.5, "2.5e-3") in rows else None
    return meshes[-1], fine, mesh, steps, abs(rows[0.5, "newton"]/half - 1), order, rows[1.0, "1e-2"]/fine - 1


def table_1_text():
    """Settlements with their bars, and what the paper's mesh, step and tolerance change and cost."""
    lines = []
    for suction in SUCTIONS:
        finest, peak, mesh, steps, newton, order, its_mesh = settlement(suction)
        settings, time_of_steps, time_of_mesh = of_paper(suction)
        bar = mesh + (steps or 0) + newton
        lines.append((suction, f"{finest:g}", f"{peak:.4g}", f"{100*bar:.2g}", f"{100*mesh:.2g}",
                      f"{100*steps:.2g}" if steps is not None else "not known", f"{100*newton:.2g}", f"{order:.2g}",
                      f"{100*its_mesh:+.2g}", f"{100*settings:+.2g}", f"{time_of_steps:.2g}", f"{time_of_mesh:.2g}"))
    good = [line[0] for line in lines if float(line[3]) <= 1 and line[5] != "not known"]
    return tables.markdown(
        ("suction [kPa]", "times the cells", "settlement [mm]", "bar [%]", "of it mesh", "steps", "Newton", "order",
         "the paper's mesh [%]", "its step and tolerance [%]", "time of these", "time of twice its cells"), lines) + textwrap.fill(
        f"Settlement to 1 % at {len(good)} of {len(lines)} suctions: {', '.join(map(str, good)) or 'none'} kPa.", 118)


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
        "table_1": table_1_text()}}


def draw(bench, results, plt):
    """For the README of the top: error against time of the indentation at 30 kPa, the mesh included."""
    from tools.pictures import COLOURS
    rows = [r for r in committed("table_1.csv") if int(r["suction"]) == table_1.FRONT and r["peak"]]
    exact = float(next(r["peak"] for r in rows if (float(r["fineness"]), r["setting"]) == (4, "2.5e-3")))
    figure, axis = plt.subplots(figsize=(6.2, 3.8))

    paper = next(r for r in rows if r["setting"] == "paper")

    def off(row):
        return 100*abs(float(row["peak"])/exact - 1)

    def cost(row):
        return float(row["seconds"])/float(paper["seconds"])
    for fineness, mark, colour in ((0.25, "o-", 0), (0.5, "s-", 1), (1, "D-", 2), (2, "^-", 3)):
        there = sorted(((cost(r), off(r)) for r in rows if float(r["fineness"]) == fineness
                        and r["setting"] in ("4e-2", "1e-2", "2.5e-3")))
        elements = next(r["elements"] for r in rows if float(r["fineness"]) == fineness)
        axis.loglog(*zip(*there), mark, color=COLOURS[colour], markersize=5, label=f"{elements} elements")
    axis.loglog([cost(paper)], [off(paper)], "*", color=COLOURS[4], markersize=13,
                label="settings of the paper")
    bar = 100*settlement(table_1.FRONT)[2]
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
