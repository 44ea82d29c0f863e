# SPDX-License-Identifier: MIT
"""The paper's Table 1: eight suctions with and without the remedy, beside the paper's numbers, with Figs 2 to 5.

`verification/run indentation --make --only series.py [--pass OPTION ...]` runs what is not finished (a quarter of an
hour on two cores) and writes its results. An interrupted analysis goes on from its checkpoint; a finished one is kept
until its scene or the program changes. Its folder, in build/indentation, holds everything, also of a failed one.
Without options the table has rows of the present program alone. Exit code 1 if a balance is violated or the rows come
from several versions of the program.
"""
import math
import sys

import analysis
import figures
import numpy as np
from analysis import (DT, RESULTS, SERIES, SUCTIONS, Job, balances, errors, histories, label, measure,
                      program, read, read_rows, results_folder, root, run_all, scene, write_rows, write_table)

# Table 1 of the paper: relative CPU time, relative difference of displacement, iterations with and without the remedy.
PUBLISHED = {0: (0.68, 0.22, 1353, 1359), 3: (0.78, 0.16, 1729, 1747), 30: (0.97, 0.00, 2071, 2085),
             50: (0.96, 0.01, 1897, 2016), 100: (None, None, 2060, "36259, terminated"), 200: (0.57, 0.81, 1333, 1801),
             500: (0.78, 0.61, 1333, 1445), 1000: (0.92, 0.09, 1333, 1333)}

BOTH, TIGHT = ("remedy", "as_published"), (0, 30, 1000)   # [kPa]
CASES = [(0, "u-p_w")] + [(s, "u-p_w-p_c") for s in SUCTIONS]


def parser_of_series():
    parser = analysis.parser_of(__doc__, SUCTIONS, 60)
    parser.add_argument("--series", nargs="+", choices=[*SERIES, "all"], default=["table"],
                        help=f"by default those of Table 1, with Newton's tolerance 1e-5 at {TIGHT} kPa")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="analyses by name, for example "
                                                                              "s0030_remedy")
    return parser


def jobs_of(args, folder, steps):
    names = list(SERIES) if {"all", "table"} & set(args.series) else args.series

    def asked(suction, name):
        return "table" not in args.series or name in BOTH or name.endswith("_tight") and suction in TIGHT
    jobs = [Job(f"{label(s, f)}_{name}", scene(s, f, name, steps=steps), folder, steps, suction=s, fields=f,
                series=name)
            for s, f in CASES if s in args.suction for name in names if asked(s, name)]
    if args.only:
        everything = {f"{label(s, f)}_{name}": (s, f, name) for s, f in CASES for name in SERIES}
        unknown = [n for n in args.only if n not in everything]
        if unknown:
            sys.exit(f"there is no analysis {unknown[0]}; the names are {', '.join(everything)}")
        jobs = [Job(n, scene(*everything[n], steps=steps), folder, steps,
                    **dict(zip(("suction", "fields", "series"), everything[n]))) for n in args.only]
    return jobs


def main():
    parser = parser_of_series()
    args = parser.parse_args()
    quick = args.quick
    folder = root / ("build/indentation_quick" if quick else "build/indentation")
    results = results_folder(__file__, quick)
    jobs = jobs_of(args, folder, 50 if quick else analysis.STEPS)
    if args.list:
        analysis.show(jobs)
        return 0
    rows = analysis.rows_so_far(results / "series.csv", args, parser)
    digest, commit = program()

    def done(job):
        row = measure(job)
        row.update(program=digest, commit=commit)
        rows[job.name] = row
        write_rows(results / "series.csv", dict(sorted(rows.items())))
        if "last_ms" in row:
            write_table(results / "histories" / f"{job.name}.csv",
                        histories(job.folder, 2 if job.facts["suction"] == 30 else 10))
        if job.facts["suction"] == 30 and "last_ms" in row:
            write_table(results / f"errors_{job.facts['series']}.csv", errors(job.folder), 3)
    run_all(jobs, args.jobs, 60 * args.limit, done)
    rows = read_rows(results / "series.csv")   # Numbers as they are written.
    print(texts(results)["series"])
    return verdict(rows)


def texts(results):
    """The tables of README.md by their marks."""
    rows = read_rows(results / "series.csv")
    return {"series": table_1(rows) + "\n" + statements(rows, results), "details": details(rows)}


def verdict(rows):
    wrong = [w for r in rows.values() if r["outcome"] == "0" for w in balances(r)]
    wrong += [f"{r['name']} was stopped at the limit of time: start again" for r in rows.values()
              if r["outcome"] == "limit"]
    versions = {(r["program"], r["commit"]) for r in rows.values()}
    if len(versions) > 1:
        wrong.append(f"rows of {len(versions)} versions of the program: run series.py again with all suctions and "
                     f"series")
    if any(commit.endswith("+") for _, commit in versions):
        wrong.append("the program's sources are not those of the commit")
    for sentence in wrong:
        print("FAILED " + sentence)
    print(f"{len(rows)} analyses, {sum(r['outcome'] == '0' for r in rows.values())} to their end, {len(wrong)} "
          f"complaints")
    return 1 if wrong else 0


# ---- tables

def pair(rows, suction, fields, ending=""):
    return [rows.get(f"{label(suction, fields)}_{series}{ending}") for series in BOTH]


def ended(row):
    return row is not None and row["outcome"] == "0"


def relative(rows, suction, fields, ending=""):
    """CPU time and work with the remedy over those without, and the difference of the final displacement, eq. (22)."""
    return ratios(*pair(rows, suction, fields, ending))


def ratios(a, b):
    """The same of two rows (None: not there)."""
    if not (ended(a) and ended(b)):
        return math.nan, math.nan, math.nan
    cpu = a["cpu_s"] / b["cpu_s"] if a["attempts"] == b["attempts"] == 1 else math.nan
    return cpu, a["rates"] / b["rates"], abs((a["final_mm"] - b["final_mm"]) / b["final_mm"])


def number(value, form=".2f"):
    if value is None or isinstance(value, float) and math.isnan(value):
        return "-"
    return value if isinstance(value, str) else format(value, form)


def iterations(row):
    if row is None:
        return "not run"
    if math.isnan(row.get("iterations", math.nan)):
        return "no step"
    count = f"{row['iterations'] + max(0, row.get('rejected', 0) or 0):.0f}"
    return count if ended(row) else f"{count}, ended at {row['last_ms']:.2f} ms"


def table_1(rows):
    """Published | measured, by column."""
    times = ["| suction [kPa] | relative CPU time: **paper** | measured | relative work | relative difference of "
             "displacement: **paper** "
              "| measured | measured, Newton 1e-5 |", "|" + 7 * "---|"]
    solves = ["| suction [kPa] | iterations with the remedy: **paper** | measured | measured, Newton 1e-5 | without: "
              "**paper** | measured "
              "| measured, Newton 1e-5 |", "|" + 7 * "---|"]
    for s, fields in CASES:
        paper = PUBLISHED[s]
        own, tight = relative(rows, s, fields), relative(rows, s, fields, "_tight")
        (a, b), (c, d) = pair(rows, s, fields), pair(rows, s, fields, "_tight")
        name = f"{s} (u-p_w)" if fields == "u-p_w" else str(s)
        for text, cells in ((times, (paper[0], own[0], own[1], paper[1], own[2], tight[2])),
                            (solves, (str(paper[2]), iterations(a), iterations(c), str(paper[3]), iterations(b),
                                      iterations(d)))):
            text.append("| " + " | ".join([name, *(number(c) for c in cells)]) + " |")
    text = times + [""] + solves + ["", "**Paper**: published in its Table 1. Measured: here, with the paper's Newton "
                                        "tolerance 1e-3 and with 1e-5. "
                                     "Relative work: rate evaluations of the material with the remedy over those "
                                     "without; unlike CPU "
                                     "times, which are single runs (-: interrupted), it does not depend on what else "
                                     "the machine does. "
                                     "Iterations include those of rejected steps."]
    for r in ordered(rows):
        if r["outcome"] != "0":
            text.append(f"- `{r['name']}` ended at {number(r.get('last_ms', math.nan), '.2f')} ms: "
                        f"{r['message'] or r['outcome']}")
    text.append("")
    return "\n".join(text)


def ordered(rows):
    return sorted(rows.values(), key=lambda r: (r["suction"], r["fields"], list(SERIES).index(r["series"])))


def details(rows):
    head = (("name", "analysis", ""), ("final_mm", "final [mm]", ".4f"), ("largest_mm", "largest [mm]", ".4f"),
            ("largest_ms", "at [ms]", ".2f"),
            ("lost_ms", "contact lost [ms]", ".2f"), ("d_p_w", "at the peak of the load: change of p_w [kPa]", ".3g"),
            ("d_p_c", "p_c [kPa]", ".2g"), ("d_S_w", "S_w", ".2g"), ("ripple_kPa", "ripple of p_w [kPa]", ".2g"),
            ("second", "steps with more than one solve", ".0f"), ("cuts", "cuts", ".0f"),
            ("S_w_start", "S_w at the start", ".4f"),
            ("impulse_open", "impulse open", ".1e"), ("energy_open", "energy open", ".1e"), ("cpu_s", "CPU [s]", ".0f"))
    text = ["| " + " | ".join(h for _, h, _ in head) + " |", "|" + len(head) * "---|"]
    for row in ordered(rows):
        shown = {**row, "cpu_s": row["cpu_s"] if row["attempts"] == 1 else math.nan}
        text.append("| " + " | ".join(row["name"] if not f else number(shown.get(k, math.nan), f) for k, _, f in head)
                    + " |")
    return "\n".join(text)


def statements(rows, results):
    """The paper's sentences about the benchmark, and what the results say of each."""
    cases = [(s, f) for s, f in CASES if f == "u-p_w-p_c"]
    got = {s: (pair(rows, s, f), relative(rows, s, f)) for s, f in cases}
    both = {s: g for s, g in got.items() if ended(g[0][0]) and ended(g[0][1])}
    present = {s: g for s, g in got.items() if g[0][0] and g[0][1]}
    lines = ["| the paper says | measured | |", "|---|---|---|"]

    def say(claim, found, agrees, known=True):
        lines.append(f"| {claim} | {found if known else ''} | "
                     f"{'not known' if not known else 'agrees' if agrees else 'does not agree'} |")
    whole = len(present) == len(cases)
    if len(present) < len(cases):
        lines.append(f"| (suctions without both analyses: {', '.join(str(s) for s in got if s not in present)}) | | |")
    if not present:
        return "\n".join(lines)
    good = [s for s, g in present.items() if ended(g[0][0])]
    say("with the remedy every analysis ends", f"{len(good)} of {len(present)}", len(good) == len(present), whole)
    bad = [s for s, g in present.items() if not ended(g[0][1])]
    say("without it the one at 100 kPa fails, and no other", f"fails at: {', '.join(map(str, bad)) or 'none'}",
        bad == [100], whole)
    less = [s for s, g in both.items() if g[1][1] < 1]
    say("the remedy saves time at every suction", f"less work at {', '.join(map(str, less)) or 'none'} of "
                                                  f"{', '.join(map(str, both))}",
        len(less) == len(both))
    fewer = [s for s, g in both.items() if g[0][0]["iterations"] < g[0][1]["iterations"]]
    say("in the majority of the analyses it takes fewer iterations", f"fewer at {', '.join(map(str, fewer)) or 'none'} "
                                                                     f"of "
        f"{', '.join(map(str, both))}", 2 * len(fewer) > len(both))
    apart = {s: g[1][2] for s, g in both.items()}
    close = [s for s in apart if PUBLISHED[s][1] is not None and abs(apart[s] - PUBLISHED[s][1]) <= 0.05]
    say("final displacements differ by 0 to 0.81 (Table 1)", "within 0.05 of the paper's at "
        + (", ".join(map(str, close)) or "none"),
        len(close) == len([s for s in apart if PUBLISHED[s][1] is not None]))
    early = {}
    for s in both:
        a, b = (read(results / "histories" / f"s{s:04d}_{x}.csv") for x in ("remedy", "as_published"))
        load = a["t_ms"] <= 14
        other = np.interp(a["t_ms"], b["t_ms"], b["u_mm"])   # Cut steps have other times.
        early[s] = np.abs(a["u_mm"] - other)[load].max() / np.abs(other[load]).max()
    if early:
        order = sorted(early, key=early.get)
        say("both are in perfect agreement until unloading begins (Fig. 5, one example)",
            f"largest difference up to 14 ms "
            f"{100 * early[order[-1]]:.2g} % (suction {order[-1]})"
            + (f", at most {100 * early[order[-2]]:.2g} % at the others" if len(order) > 1 else ""),
            early[order[0]] <= 0.01)
    r = rows.get("s0030_remedy")
    if r and ended(r):
        say("30 kPa: pore water pressure rises on impact (Fig. 3)", f"by {r['d_p_w']:.3g} kPa at the peak of the load",
            r["d_p_w"] > 0)
        say("suction falls", f"changes by {r['d_p_c']:+.2g} kPa", r["d_p_c"] < 0)
        say("the degree of saturation rises slightly", f"changes by {r['d_S_w']:+.2g}", r["d_S_w"] > 0)
        say("rebound from 14 ms on", f"from {r['largest_ms']:.2f} ms on", abs(r["largest_ms"] - 14) < 0.5)
        counts = second_solves(results / "errors_remedy.csv")
        say("Newton's method rarely needs a second iteration before unloading, more after the end of the impact (Fig. "
            "4)",
            "steps with a second one: {} up to 14 ms, {} up to 28 ms, {} after".format(*counts),
            counts[0] < 5 and counts[2] > max(counts[:2]))
        say("strong oscillations of p_w after the impact", f"rms about the mean over 0.6 ms: {r['ripple_kPa']:.2g} "
                                                           f"kPa, "
            f"of a change of {r['d_p_w']:.3g}", r["ripple_kPa"] > 0.1 * abs(r["d_p_w"]), r["ripple_kPa"] > 0)
    return "\n".join(lines)


def second_solves(path):
    """Steps that took more than one iteration: loading, unloading, after."""
    e = read(path)
    more = e["iterations"] > 1
    return [int(np.sum(more & (e["t_ms"] > a) & (e["t_ms"] <= b))) for a, b in ((0, 14), (14, 28), (28, 1e9))]


# ---- pictures

def pictures(results, picture):
    """Figs 2 to 5 from committed results; `picture(name)` says where each is to be written."""
    rows = read_rows(results / "series.csv")

    def history(name):
        path = results / "histories" / f"{name}.csv"
        return read(path) if name in rows and path.exists() else None
    shown = {s: history(f"s0030_{s}") for s in ("as_published", "remedy")}
    shown = {s: h for s, h in shown.items() if h is not None}
    if shown:
        figures.load(next(iter(shown.values())), picture("fig2_load.png"))
        figures.interface(shown, picture("fig3_interface.png"))
    newton = []
    for series, title in (("remedy", "remedy, tolerance 1e-3"), ("as_published", "without"),
                          ("remedy_tight", "remedy, tolerance 1e-5"),
                          ("as_published_tight", "without")):
        if (results / f"errors_{series}.csv").exists():
            newton.append((title, read(results / f"errors_{series}.csv"), SERIES[series][1] or 1e-3))
    if newton:
        figures.newton(newton, picture("fig4_errors.png"))
    runs = {}
    for s, fields in CASES:
        name = f"{s} kPa" + (", saturated throughout (u-p_w)" if fields == "u-p_w" else "")
        both = {x: history(f"{label(s, fields)}_{x}") for x in ("remedy", "as_published")}
        if all(h is not None for h in both.values()):
            runs[name] = both
    if runs:
        figures.displacement(runs, picture("fig5_displacement.png"))


if __name__ == "__main__":
    sys.exit(main())
