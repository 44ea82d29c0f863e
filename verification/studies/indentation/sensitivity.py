"""What the paper leaves open in its indentation benchmark, varied one by one: how far it moves each column of Table 1.

At suctions 0, 30, 100 and 1000 kPa with and without the remedy: the standard set, about 190 analyses and five hours
on one core, the most
telling ones first; further variations by `--only`. Resumable as series.py is (which must have run before: its
analyses are what is compared
with): `verification/run indentation --make --only sensitivity.py [--pass OPTION ...]`. Exit code 1 if the balance of
momentum
is violated or rows are of another program than the series'.
"""
import math
import sys
from collections.abc import Callable
from typing import NamedTuple

import figures
from analysis import (DT, STEPS, Job, balances, change, label, measure, parser_of, program, read_rows, render,
                      results_folder,
                      root, run_all, scene, show, write_rows)
from series import PUBLISHED, ended, iterations, made_by, number, ratios

SUCTIONS = (0, 30, 100, 1000)
BOTH = ("remedy", "as_published")
FIELDS = "u-p_w-p_c"
OPEN, STATED = True, False


def keys(where, **values):
    """Sets keys of a group."""
    return lambda groups: change(groups, where, **values)


def together(*steps):
    def apply(groups):
        for step in steps:
            step(groups)
    return apply


def without_weight(groups):
    # A plate that just touches is held by nothing in a static stage.
    change(groups, "plate", weight="'no'")
    next(k for g, k in groups if g == "fix" and k["group"] == "'plate'")["stages"] = "'geostatic', 'seat'"


def drained_by_state(groups):
    change(groups, "contact", drainage="'state'")
    for name, k in groups:
        if name == "fix" and k["group"] == "'top_2'":
            k["group"] = "'top'"


def default_floor(groups):
    """1e-4 is the key's default."""
    change(groups, "permeability", floor=None)


FINE = keys("mesh", r_cells="12, 16", r_ratio=f"1, {1.35**0.5:.8g}", z_cells="14, 14",
            z_ratio=f"{0.76**0.5:.8g}, {0.9**0.5:.8g}")


class Variation(NamedTuple):
    name: str
    what: str
    known: str       # What is known of it, and what the series uses.
    adapt: Callable  # Makes a scene of it.
    series: tuple    # That it means something for.
    open: bool       # The paper leaves it open: only such a one can be a reason for a difference from the paper.


VARIATIONS = {v[0]: Variation(*v) for v in (
    ("mass_15", "plate of 15 kg", "not stated; 11.1 kg", keys("plate", mass=0.015), BOTH, OPEN),
    ("mass_5.6", "plate of 5.6 kg", "not stated; 11.1 kg", keys("plate", mass=0.0056), BOTH, OPEN),
    ("weightless", "plate without weight", "not stated; with", without_weight, BOTH, OPEN),
    ("peak_12", "peak of the load at 12 ms", "not stated; 14 ms", keys("history", times="2, 2.012, 2.028"), BOTH, OPEN),
    ("mualem", "Mualem-van Genuchten permeabilities", "not stated; Corey", keys("permeability", law="'mualem'"), BOTH,
     OPEN),
    ("floor_1e-2", "least relative permeability 1e-2", "not stated; 1e-4 (1e-2 at suction 0)",
     keys("permeability", floor=1e-2), BOTH, OPEN),
    ("floor_1e-3", "least relative permeability 1e-3", "not stated; 1e-4 (1e-2 at suction 0)",
     keys("permeability", floor=1e-3), BOTH, OPEN),
    ("floor_1e-4", "least relative permeability 1e-4", "not stated; 1e-4 (1e-2 at suction 0)", default_floor, BOTH,
     OPEN),
    ("rate_suction", "saturation changes by suction alone", "dS_w/de not stated; with",
     keys("scene", saturation_rate="'suction'"), BOTH, OPEN),
    ("seepage_inertia", "inertia in Darcy's law", "eqs (20), (21) have it; without",
     keys("scene", seepage_inertia="'yes'"), BOTH, OPEN),
    ("flow_drains", "initial flow not subtracted", "not stated; subtracted", keys("scene", initial_flow="'drain'"),
     BOTH, OPEN),
    ("drainage_state", "drainage follows the contact", "stated in words; footprint impervious", drained_by_state, BOTH,
     OPEN),
    ("e_0.75", "void ratio 0.75", "0.8 stated", keys("region", void_ratio=0.75), BOTH, STATED),
    ("e_0.85", "void ratio 0.85", "0.8 stated", keys("region", void_ratio=0.85), BOTH, STATED),
    ("theta_0.1", "theta 0.1", "missing in Table 2; 0.2", keys("mud", theta=0.1), BOTH, OPEN),
    ("theta_0.3", "theta 0.3", "missing in Table 2; 0.2", keys("mud", theta=0.3), BOTH, OPEN),
    ("k0_effective", "K_0 of the effective stress", "not stated; of the net stress",
     keys("initial", k_0_of="'effective'"), BOTH, OPEN),
    ("eps_hat_1e-5", "threshold of the remedy 1e-5", "not stated; 1e-4", keys("mud", eps_hat=1e-5), ("remedy",), OPEN),
    ("eps_hat_1e-3", "threshold of the remedy 1e-3", "not stated; 1e-4", keys("mud", eps_hat=1e-3), ("remedy",), OPEN),
    ("damping_10", "damping 10 /s", "matrices of it are named; none (10 /s: 4.5 % of critical at the load's 112 rad/s)",
     keys("region", damping=10), BOTH, OPEN),
    ("rho_1", "rho_inf 1 (no damping)", "not stated; 0.8", keys("stage:impact", rho_inf=1, created_energy=1e9), BOTH, OPEN),
    ("rho_0.5", "rho_inf 0.5", "not stated; 0.8", keys("stage:impact", rho_inf=0.5), BOTH, OPEN),
    ("rho_0", "rho_inf 0", "not stated; 0.8", keys("stage:impact", rho_inf=0), BOTH, OPEN),
    ("dt_half", "half the time step", "3e-5 s stated", keys("stage:impact", dt=DT / 2), BOTH, STATED),
    ("dt_tenth", "a tenth of the time step", "3e-5 s stated", keys("stage:impact", dt=DT / 10), BOTH, STATED),
    ("mesh_half", "half the size of the elements (1568)", "410 elements stated; 392", FINE, BOTH, STATED),
    ("taylor_hood", "linear pressures", "not stated; quadratic", keys("scene", pressures="'linear'"), BOTH, OPEN),
    ("quadrature_3", "3 points an element", "not stated; 6", keys("scene", quadrature=3), BOTH, OPEN),
    ("quadrature_7", "7 points an element", "not stated; 6", keys("scene", quadrature=7), BOTH, OPEN),
    ("quadrature_12", "12 points an element", "not stated; 6", keys("scene", quadrature=12), BOTH, OPEN),
    ("stress_1e-4", "stress tolerance 1e-4", "1e-5 stated", keys("mud", tolerance=1e-4), BOTH, STATED),
    ("stress_1e-6", "stress tolerance 1e-6", "1e-5 stated", keys("mud", tolerance=1e-6), BOTH, STATED),
    ("newton_1e-2", "Newton tolerance 1e-2", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-2), BOTH, OPEN),
    ("newton_1e-4", "Newton tolerance 1e-4", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-4), BOTH, OPEN),
    ("newton_1e-5", "Newton tolerance 1e-5", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-5), BOTH, OPEN),
    ("newton_1e-6", "Newton tolerance 1e-6", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-6), BOTH, OPEN),
    ("norm_residual", "Newton: |R|/|R_0| below 1e-3", "not stated; error of every field",
     keys("stage:impact", measure="'residual'"), BOTH, OPEN),
    ("norm_correction", "Newton: |dx|/|x| below 1e-3", "not stated; error of every field",
     keys("stage:impact", measure="'correction'"), BOTH, OPEN),
    ("predictor_none", "iteration starts from the old values", "not stated; constant rates",
     keys("stage:impact", predictor="'none'"), BOTH, OPEN),
    ("fresh_factors", "every matrix factorised anew", "not stated; factors serve on", keys("scene", factors="'fresh'"),
     BOTH, OPEN),
    ("tangent_1", "elastic tangent", "not stated; continuum", keys("mud", tangent=1), BOTH, OPEN),
    ("tangent_3", "consistent tangent", "not stated; continuum", keys("mud", tangent=3), BOTH, OPEN),
    ("penalty_1e7", "penalty 1e7 kN/m3", "1e8 stated", keys("contact", penalty=1e7), BOTH, STATED),
    ("penalty_1e9", "penalty 1e9 kN/m3", "1e8 stated", keys("contact", penalty=1e9), BOTH, STATED),
    ("gap_pointwise", "gap penalised point by point", "eq. (18); nodal", keys("contact", gap="'pointwise'"), BOTH,
     OPEN),
)}


CONTROL = "classic"   # Guards as with the remedy, no remedy.
TIGHT = "newton_1e-5"   # Runs with the series.
EXACT = "fresh_factors"   # The same equations; what it changes is the residual of linear solutions by reused factors.
# What runs unless --only names others, in this order: mesh and step tell most, the slowest come last.
STANDARD = ("mesh_half", "dt_tenth", EXACT, "mass_15", "weightless", "peak_12", "mualem", "rate_suction",
            "seepage_inertia", "drainage_state",
            "e_0.75", "theta_0.3", "k0_effective", "eps_hat_1e-5", "eps_hat_1e-3", "damping_10", "rho_0.5",
            "stress_1e-4", "norm_residual",
            "tangent_3", "penalty_1e7", "quadrature_7", "rho_1", "quadrature_3")


def arguments():
    parser = parser_of(__doc__, SUCTIONS, 30)
    names = [name for name in VARIATIONS if name != TIGHT]
    parser.add_argument("--only", nargs="+", choices=names, default=STANDARD, metavar="NAME",
                        help=f"the standard set by default; {', '.join(names)}")
    return parser.parse_args()


def jobs_of(args, folder, steps):
    jobs = []
    for name in dict.fromkeys((*STANDARD, *VARIATIONS)):
        if name in args.only:
            jobs += [job_of(s, one, name, folder, steps) for s in args.suction if not same(s, name)
                     for one in VARIATIONS[name].series]
    return jobs


def job_of(suction, series, name, folder, steps):
    groups = scene(suction, FIELDS, series, VARIATIONS[name].adapt, steps=steps)
    return Job(f"{label(suction, FIELDS)}_{series}_{name}", groups, folder, steps, suction=suction, fields=FIELDS,
               series=series,
               variation=name)


def controls(rows, args, folder, steps):
    """What failed without the remedy and without guards, by the same rule with guards: do these alone save it?"""
    failed = [(int(r["suction"]), r["variation"]) for r in rows.values() if r["series"] == "as_published"
              and not ended(r)]
    return [job_of(s, CONTROL, name, folder, steps) for s, name in failed if s in args.suction and name in args.only]


def main():
    args = arguments()
    folder = root / ("build/indentation_quick" if args.quick else "build/indentation")
    results = results_folder(__file__, args.quick)
    scenes, steps = folder / "sensitivity", 50 if args.quick else STEPS
    jobs = jobs_of(args, scenes, steps)
    if args.list:
        show(jobs)
        return 0
    path = results / "sensitivity.csv"
    rows = read_rows(path)
    digest, commit = program()

    def done(job):
        rows[job.name] = measure(job)
        rows[job.name].update(program=digest, commit=commit)
        write_rows(path, dict(sorted(rows.items())))
    run_all(jobs, args.jobs, 60 * args.limit, done)
    run_all(controls(read_rows(path), args, scenes, steps), args.jobs, 60 * args.limit, done)
    rows, base = evaluated(results)
    print(report(rows, base))
    print(f"{len(rows)} analyses, {sum(ended(r) for r in rows.values())} of them to their end")
    # What closes the ledger of energy is among what is varied: it is reported, and no failure.
    broken = [w for r in rows.values() if ended(r) for w in balances(r) if "impulse" in w]
    for sentence in broken:
        print("FAILED " + sentence)
    versions = {r["program"] for r in (*rows.values(), *(base.get(f"{label(s, FIELDS)}_{x}", {"program": "none"})
                                                        for s in SUCTIONS for x in BOTH))}
    if len(versions) > 1:
        print(f"FAILED rows and series come from {len(versions)} versions of the program, or the series is not complete")
    return 1 if broken or len(versions) > 1 else 0


# ---- evaluation

def evaluated(results):
    """Rows of the variations and those of the series that they are compared with."""
    rows = {k: r for k, r in read_rows(results / "sensitivity.csv").items() if r["variation"] in VARIATIONS}
    base = read_rows(results / "series.csv")
    return with_tight(rows, base), base


def texts(results):
    """The text of SENSITIVITY.md by its mark."""
    return {"sensitivity": report(*evaluated(results))}


def picture(results, path):
    figures.tornado(bars(*evaluated(results)), path)


def columns(a, b):
    """Columns of Table 1 and the final displacements of a pair of rows (None: not there)."""
    return {**dict(zip(("cpu", "work", "difference"), ratios(a, b))),
            "with": a["iterations"] if ended(a) else math.nan, "without": b["iterations"] if ended(b) else math.nan,
            "final": a["final_mm"] if ended(a) else math.nan, "final_b": b["final_mm"] if ended(b) else math.nan}


def pair(rows, base, suction, name):
    """Rows with and without the remedy; where the variation means nothing for one, that of the series."""
    head, series = label(suction, FIELDS), VARIATIONS[name].series if name else ()
    return [(rows.get(f"{head}_{one}_{name}") if one in series else base.get(f"{head}_{one}")) for one in BOTH]


def tried(rows, base, suction):
    """Columns of every variation that ran at a suction, by its name."""
    return {name: columns(*pair(rows, base, suction, name)) for name in VARIATIONS if ran(rows, suction, name)}


def with_tight(rows, base):
    """The rows, and those of the series that are a variation: Newton's tolerance 1e-5."""
    tight = {r["name"].replace("_tight", "_" + TIGHT): {**r, "variation": TIGHT} for r in base.values()
             if r["series"].endswith("_tight") and r["suction"] in SUCTIONS and r["fields"] == FIELDS}
    return {**rows, **tight}


def cells(a, b):
    c = columns(a, b)
    return [number(c["cpu"]), number(c["work"]), number(c["difference"], ".3g"), iterations(a), iterations(b),
            number(c["final"], ".4f"), number(c["final_b"], ".4f")]


def report(rows, base):
    text = ["## What moves the table most", "", *strongest(rows, base), ""]
    for s in SUCTIONS:
        paper, missing = PUBLISHED[s], []
        text += [f"## Suction {s} kPa", "", "| | relative CPU time | relative work | relative difference of "
                                            "displacement | iterations with "
                 "remedy | without | final displacement with [mm] | without [mm] |", "|" + 8 * "---|",
                 f"| **paper** (published) | {number(paper[0])} | | {number(paper[1])} | {paper[2]} | {paper[3]} | | |",
                 "| **series** (measured) | " + " | ".join(cells(*pair(rows, base, s, ""))) + " |"]
        for name, variation in VARIATIONS.items():
            if ran(rows, s, name):
                text.append(f"| {cell(variation.what)} | {' | '.join(cells(*pair(rows, base, s, name)))} |")
            elif name in STANDARD and not same(s, name):
                missing.append(variation.what)
        text += ["", f"Not run at {s} kPa: {'; '.join(missing)}.", ""] if missing else [""]
    further = [v.what for name, v in VARIATIONS.items() if not any(ran(rows, s, name) for s in SUCTIONS)
               and name not in STANDARD]
    if further:
        text += [f"Not run, but there for `--only`: {'; '.join(further)}.", ""]
    text += [f"Made by commit {made_by(rows)}, like the series.", "", "## Noise", "", *noise(rows, base), "",
             "## Towards the paper", "",
             *towards(rows, base), "", "## Failures", "",
             *failures(rows)]
    return "\n".join(text)


MOVED = (("work", "relative work", "+.2f"), ("difference", "relative difference of displacement", "+.2f"),
         ("with", "iterations with the remedy", "+.0f"),
         ("without", "iterations without", "+.0f"), ("final", "final displacement with the remedy [mm]", "+.4f"))
OTHER_STEPS = ("dt_tenth", "dt_half")   # Their iterations are those of more steps.


def strongest(rows, base):
    """The variations that move each column most, by suction."""
    text = ["Change of each column of Table 1 against the series; the three largest. In brackets how many of the "
            "variations move it by more than a tenth "
            "of its value (displacement: by more than the remedy does).", "",
            "| suction [kPa] | " + " | ".join(title for _, title, _ in MOVED) + " |", "|" + (len(MOVED) + 1) * "---|"]
    for s in SUCTIONS:
        start, found_here, line = columns(*pair(rows, base, s, "")), tried(rows, base, s), []
        for key, _, form in MOVED:
            found = {VARIATIONS[name].what: c[key] - start[key] for name, c in found_here.items()
                     if not math.isnan(c[key] - start[key]) and not (key in ("with", "without")
                                                                     and name in OTHER_STEPS)}
            limit = abs(start["final"] - start["final_b"]) if key == "final" else 0.1 * abs(start[key])
            largest = sorted(found, key=lambda what: -abs(found[what]))[:3]
            line.append("; ".join(f"{cell(what)} {found[what]:{form}}" for what in largest)
                        + f" ({sum(abs(by) > limit for by in found.values())} of {len(found)})")
        text.append(f"| {s} | {' | '.join(line)} |")
    return text


def cell(text):
    """A text within a row of a table."""
    return text.replace("|", "\\|")


def ran(rows, suction, name):
    """Whether a variation ran at that suction, with every series that it means something for."""
    return all(f"{label(suction, FIELDS)}_{one}_{name}" in rows for one in VARIATIONS[name].series)


def same(suction, name):
    """Whether a variation is what the series does at that suction anyway."""
    one = VARIATIONS[name].series[0]
    return render(scene(suction, FIELDS, one, VARIATIONS[name].adapt)) == render(scene(suction, FIELDS, one))


NUMERICS = (("dt_tenth", "a tenth of the time step"), ("mesh_half", "half the size of the elements"),
            (EXACT, "every matrix factorised anew"))


def moves(rows, base, suction):
    """How far the remedy, and each of NUMERICS with and without it, moves the final displacement [mm]; nan where not
    known."""
    a, b = pair(rows, base, suction, "")
    if not (ended(a) and ended(b)):
        return math.nan, [(math.nan, math.nan)] * len(NUMERICS)
    return abs(a["final_mm"] - b["final_mm"]), [
        tuple(abs(x["final_mm"] - y["final_mm"]) if ended(x) else math.nan for x,
              y in zip(pair(rows, base, suction, name), (a, b)))
        for name, _ in NUMERICS]


def is_noise(rows, base, suction):
    effect, by = moves(rows, base, suction)
    return any(m > effect for two in by for m in two)


def noise(rows, base):
    """A column that the step or the mesh moves by more than the remedy does, says nothing about the remedy."""
    text = ["If a tenth of the time step, half the size of the elements or a linear solution by fresh instead of "
            "earlier factors "
            "moves the final displacement by more than the remedy does, its relative difference says nothing about the "
            "remedy: noise. Two numbers: with and "
            "without the remedy [mm].", "",
            "| suction | the remedy moves it by | " + " | ".join(what for _, what in NUMERICS) + " | the column is |",
            "|" + 6 * "---|"]
    for s in SUCTIONS:
        effect, by = moves(rows, base, s)
        shown = [" and ".join("missing" if math.isnan(v) else f"{v:.4f}" for v in two) for two in by]
        word = "noise" if is_noise(rows, base, s) else "not known yet" if any(map(math.isnan, sum(by, ()))) else "an effect of the remedy"
        text.append(f"| {s} | {number(effect, '.4f')} | {' | '.join(shown)} | {word} |")
    return text


# Of a column of Table 1: place in PUBLISHED, title, allowed distance (of iterations: of the paper's), what must be
# that close, format.
COLUMN_NAMES = {"work": (0, "relative CPU time (ours: work, CPU)", 0.05, ("work", "cpu"), ".2f"),
                "difference": (1, "relative difference of displacement", 0.05, ("difference",), ".2f"),
                "with": (2, "iterations with the remedy", 0.02, ("with",), ".0f"),
                "without": (3, "iterations without", 0.02, ("without",), ".0f")}


def towards(rows, base):
    """Which variation brings a column closest to the paper's figure; what none brings there is unexplained."""
    text = ["Met: within 0.05 of the paper's ratios, within 2 % of its iterations. Explained: something that the paper "
            "leaves open, varied "
            "alone, meets the figure, the series does not, and an exact linear solution moves it less. Else "
            "unexplained. CPU times depend on what "
            "else the machine did: work chooses the closest, and both must meet the paper's.", "",
            "| suction | column | paper | series | closest variation | its value | |", "|" + 7 * "---|"]
    for s in SUCTIONS:
        found = {name: c for name, c in tried(rows, base, s).items() if VARIATIONS[name].open}
        for key, (place, title, *_) in COLUMN_NAMES.items():
            if isinstance(PUBLISHED[s][place], (int, float)):
                text.append(f"| {s} | {title} | {PUBLISHED[s][place]} | "
                            f"{' | '.join(closest(rows, base, s, key, found))} |")
    return text


def closest(rows, base, s, key, found):
    """Of a column at a suction: the series' value, the variation closest to the paper, its value, and what that
    says."""
    place, _, allowed, keys, form = COLUMN_NAMES[key]
    paper, start = PUBLISHED[s][place], columns(*pair(rows, base, s, ""))
    limit = allowed * (paper if key in ("with", "without") else 1)

    def shown(c):
        return ", ".join(number(c[k], form) for k in keys)

    def meets(c):
        return all(abs(c[k] - paper) <= limit for k in keys)

    if math.isnan(start[key]):
        return "not known", "", "", ""
    if meets(start):
        return shown(start), "", "", "met"
    found = {name: c for name, c in found.items() if not math.isnan(c[key])}
    if not found:
        return shown(start), "none run yet", "", ""
    best = min(found, key=lambda name: abs(found[name][key] - paper))
    by_exact = abs(found[EXACT][key] - start[key]) if EXACT in found else math.nan
    # A hit among so many tries counts only where the column says something, and beyond what the linear solution does
    # to it.
    if not meets(found[best]):
        word = "unexplained"
    elif key == "difference" and is_noise(rows, base, s):
        word = "unexplained: by chance, the column is noise"
    elif not abs(found[best][key] - start[key]) > by_exact:
        word = "unexplained: within what the linear solution does"
    else:
        word = "explained by it"
    return shown(start), cell(VARIATIONS[best].what), shown(found[best]), word


def failures(rows):
    text = []
    for row in rows.values():
        if not ended(row):
            text.append(f"- `{row['name']}`: ended at {number(row.get('last_ms', math.nan))} ms: "
                        f"{(row['message'] or row['outcome']).rstrip('.')}.")
            control = rows.get(row["name"].replace("as_published", CONTROL))
            if control and control is not row:
                text[-1] += f" With guards, without the remedy (`{control['name']}`): " + (
                    f"runs to the end, {control['final_mm']:.4f} mm." if ended(control) else "fails too.")
    broken = [w for row in rows.values() if ended(row) for w in balances(row) if "S_w" not in w]
    text += ["", "Balances outside their limits: " + ("; ".join(broken) if broken else "none") + "."]
    return text


def bars(rows, base):
    """For the picture: by suction, effect of the remedy and (what, change with, change without) of every variation
    [mm]."""
    answer = {}
    used = [name for name in VARIATIONS if any(ran(rows, s, name) for s in SUCTIONS)]
    for s in SUCTIONS:
        a, b = pair(rows, base, s, "")
        if not (ended(a) and ended(b)):
            continue
        lines = []
        for name in used:
            if not same(s, name):
                c, d = pair(rows, base, s, name)
                lines.append((VARIATIONS[name].what, *(x["final_mm"] - y["final_mm"] if ended(x) else math.nan for x,
                                                       y in ((c, a), (d, b)))))
        answer[s] = (a["final_mm"], abs(a["final_mm"] - b["final_mm"]), lines)
    return answer


if __name__ == "__main__":
    sys.exit(main())
