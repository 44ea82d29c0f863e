# SPDX-License-Identifier: MIT
"""Table 1 with absorbing sides and base beside the paper's fixed ones, and with the settings that mud_host has by default
today: how much of the table is reflection, and how much a choice of this program.

`verification/run indentation --make --only settings.py [--pass OPTION ...]`. A run that was interrupted goes on from its
checkpoint. Suction 30 kPa; 0, 100 and 1000 by --suction, which the table keeps until another program renews 30 kPa:
every row is of the same program.
"""
import sys

import analysis
from analysis import (STEPS, Job, change, label, measure, program, read_rows, results_folder, root, run_all, scene, show,
                      write_rows)
from series import ended, iterations, number, ratios

SUCTIONS, FIELDS, BOTH = (0, 30, 100, 1000), "u-p_w-p_c", ("remedy", "as_published")
NIGHTLY = (30,)   # Suctions, unless --suction names others.
STATIC = "'geostatic', 'seat'"


def absorbing(groups):
    """The side and the base are fixed until the impact begins; then they let waves out."""
    for name, keys in groups:
        if name == "fix" and keys["group"] in ("'right'", "'bottom'"):
            keys["stages"] = STATIC
    groups += [("absorbing", dict(group=group, stages="'impact'")) for group in ("'right'", "'bottom'")]


def today(groups):
    """What the scene sets and the program would choose by itself: both gaps, and rho_inf 0 where contacts act."""
    change(groups, "contact", gap=None)
    change(groups, "stage:impact", rho_inf=0)


SETTINGS = {"fixed": ("fixed sides and base, the paper's settings", lambda groups: None),
            "absorbing": ("absorbing sides and base", absorbing),
            "today": ("fixed; combined gap and rho_inf 0, the defaults of mud_host", today)}


def parser_of_settings():
    parser = analysis.parser_of(__doc__, SUCTIONS, 30)
    parser.set_defaults(suction=NIGHTLY)
    parser.add_argument("--only", nargs="+", choices=list(SETTINGS), default=list(SETTINGS), metavar="NAME")
    return parser


def jobs_of(args, folder, steps):
    return [Job(f"{label(s, FIELDS)}_{one}_{name}", scene(s, FIELDS, one, SETTINGS[name][1], steps=steps), folder, steps,
                suction=s, fields=FIELDS, series=one, variation=name)
            for s in args.suction for name in args.only for one in BOTH]


def main():
    parser = parser_of_settings()
    args = parser.parse_args()
    folder = root / ("build/indentation_quick" if args.quick else "build/indentation") / "settings"
    results = results_folder(__file__, args.quick)
    jobs = jobs_of(args, folder, 50 if args.quick else STEPS)
    if args.list:
        show(jobs)
        return 0
    rows = analysis.rows_so_far(results / "settings.csv", args, parser)
    digest, commit = program()

    def done(job):
        rows[job.name] = measure(job)
        rows[job.name].update(program=digest, commit=commit)
        write_rows(results / "settings.csv", dict(sorted(rows.items())))
    run_all(jobs, args.jobs, 60 * args.limit, done)
    print(texts(results)["settings"])
    versions = {r["program"] for r in read_rows(results / "settings.csv").values()}
    if len(versions) > 1:
        print(f"FAILED rows of {len(versions)} versions of the program")
    return 1 if len(versions) > 1 else 0


def texts(results):
    """The table of README.md by its mark."""
    rows = read_rows(results / "settings.csv")
    text = ["| suction [kPa] | boundaries and settings | largest [mm] | final with the remedy [mm] | without [mm] | relative "
            "difference | relative work | iterations with | without |", "|" + 9 * "---|"]
    for s in SUCTIONS:
        for name, (what, _) in SETTINGS.items():
            a, b = (rows.get(f"{label(s, FIELDS)}_{one}_{name}") for one in BOTH)
            if a is None and b is None:
                continue
            _, work, difference = ratios(a, b)
            finals = [number(r["final_mm"], ".4f") if ended(r) else "-" for r in (a, b)]
            largest = number(a["largest_mm"], ".4f") if ended(a) else "-"
            text.append(f"| {s} | {what} | {largest} | {' | '.join(finals)} | {number(difference)} | {number(work)} | "
                        f"{iterations(a)} | {iterations(b)} |")
    return {"settings": "\n".join(text)}


if __name__ == "__main__":
    sys.exit(main())
