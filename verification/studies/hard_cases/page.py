# SPDX-License-Identifier: MIT
"""Hard cases at a point and in the host: every case with the defaults; the tables of the other settings are made by study.py."""
import os
import pathlib

import host_report
import pictures
import report
from catalogue import CONTINUITY, INTEGRATION, SETTINGS, evaluate
from point_walk import Walker
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="with their defaults library and host meet the criterion of every case of the catalogue except those that name a limit, and a nudge of 1e-9 does not change the answer; "
          "damaged files and full disks are refused with a message, and nothing is lost",
    kind="robustness",
    input="`cases_reversals.py` and `cases_limits.py`: paths of one point, run by `mud_walk`; `host_cases.py` and `host_files.py`: scenes, run by `mud_host`",
    reference="a criterion a case: a bound of the state, a closed form, or the same path without the event; the same path nudged by 1e-9; the same path "
              "with scheme 3 and tolerance 1e-8",
    seconds=400, quick=14, pictures=("hard_cases.png", "point_cases.png", "host_cases.png"))
MAKES = (Script("study.py", ("results.csv", "host.csv"), 1100), Script("nonsense_scenes.py", ("nonsense.csv",), 110),
         Script("peers.py", ("peers.csv",), 600, "openseespy"))

# Cases of less than half a second each.
QUICK = ("reversals of 1e-09", "reversals of 2e-05", "noise of 1e-6 along", "tiny loops in softening", "nine nested loops", "figure eights", "random walks",
         "tension and back", "reversals at the cut-off", "tension under suction", "static liquefaction", "the steady state", "50 % of shear",
         "wetting to saturation", "drying to 1e5 kPa", "wetting at rest", "pulses of suction", "p' 100 MPa", "10 % in one increment", "void ratio 0.02 to 4.5")


def check(bench):
    walker = Walker(bench.build)
    for case in report.CASES:
        if bench.quick and case.name not in QUICK:
            continue
        outcome = evaluate(walker, case, SETTINGS[0], integration=not bench.quick)
        if case.limit:
            # Not passed, and said so in the table; a model that learns it has to be noticed.
            bench.below(f"{case.name}: {case.criterion}: by how much it falls short of what the page says of the model", case.allowed - outcome.value,
                        Tolerance(case.limit, absolute=0.0))
            told, judge, allowed = case.proof
            bench.below(f"{case.name}: {told}", judge(walker.run_all(case.paths(SETTINGS[0]))), Tolerance("so it is the model and not its integration", absolute=allowed))
        else:
            bench.below(f"{case.name}: {case.criterion}", outcome.value, Tolerance(f"{case.group}: {case.hard}", absolute=case.allowed))
        bench.below(f"{case.name}: change of the stress after a nudge of 1e-9 [%]", outcome.continuity,
                    Tolerance("continuity: the third digit stays", absolute=CONTINUITY))
        if not bench.quick:
            bench.below(f"{case.name}: distance of the stress from scheme 3 at tolerance 1e-8 [%]", outcome.integration,
                        Tolerance("the answer is the model's, not the integrator's: one per cent", absolute=INTEGRATION))

    return check_host(bench)


def check_host(bench):
    """The host's part: the same, but for the distance from a tight tolerance. Returns the records of the cases of files."""
    os.environ["MUD_BUILD_DIR"] = str(bench.build)
    records = {}
    for case in host_report.CASES:
        if bench.quick and case.name not in host_report.QUICK:
            continue
        outcome = host_report.outcome(case, SETTINGS[0], bench.quick)
        records[case.name] = outcome.runs
        if case.name == "scenes of nonsense":   # a committed record; every check runs scenes of its own (tests/host/test_host_nonsense.py)
            continue
        if outcome.told:
            bench.note(f"{case.name}: {outcome.told}")
        if case.limit:
            bench.below(f"{case.name}: {case.criterion}: by how much it falls short of what the page says", case.allowed - outcome.value,
                        Tolerance(case.limit, absolute=0.0))
        else:
            bench.below(f"{case.name}: {case.criterion}", outcome.value, Tolerance(f"{case.group}: {case.hard}", absolute=case.allowed))
        if outcome.continuity == outcome.continuity:
            bench.below(f"{case.name}: change of the answer after a nudge of 1e-9 [%]", outcome.continuity,
                        Tolerance("continuity: the third digit stays", absolute=CONTINUITY))
    return records


def texts(bench):
    results = report.committed()
    host = host_report.committed()
    return {"README.md": {"summary": report.summary(results), "cases": report.case_table(results), "limits": report.limits(), "settings": report.setting_table(results),
                          "host summary": host_report.summary(host), "host cases": host_report.case_table(host), "host limits": host_report.limits(),
                          "host settings": host_report.setting_table(host), "nonsense": host_report.nonsense(),
                          "peers": host_report.peer_table()}}


def draw(bench, records, plt):
    os.environ["MUD_BUILD_DIR"] = str(bench.build)
    bench.save(pictures.setting_sheet(report.CASES + host_report.host_cases.CASES, report.committed() | host_report.committed(), plt), "hard_cases.png")
    bench.save(pictures.point_sheet(report.CASES, Walker(bench.build), plt), "point_cases.png")
    bench.save(pictures.host_sheet(host_report.host_cases.CASES, records, pathlib.Path(bench.folder()), plt), "host_cases.png")
