# SPDX-License-Identifier: MIT
"""Hard cases at a point: every case with the library's defaults; the table of the other settings is made by study.py."""
import report
from catalogue import CONTINUITY, INTEGRATION, SETTINGS, evaluate
from point_walk import Walker
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="with its defaults the library comes to the end of every case of the catalogue, keeps its criterion in all but those that name a limit of the model, and answers the same after a nudge of 1e-9",
    kind="robustness",
    input="`cases_reversals.py` and `cases_limits.py`: paths of one point, written down case by case and run by `mud_walk`",
    reference="a criterion a case: a bound of the state, a closed form, or the same path without the event; the same path nudged by 1e-9; the same path "
              "with scheme 3 and tolerance 1e-8",
    seconds=120, quick=6, pictures=("hard_cases.png",))
MAKES = (Script("study.py", ("results.csv",), 1800),)

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
        else:
            bench.below(f"{case.name}: {case.criterion}", outcome.value, Tolerance(f"{case.group}: {case.hard}", absolute=case.allowed))
        bench.below(f"{case.name}: change of the stress after a nudge of 1e-9 [%]", outcome.continuity,
                    Tolerance("continuity: the third digit stays", absolute=CONTINUITY))
        if not bench.quick:
            bench.below(f"{case.name}: distance of the stress from scheme 3 at tolerance 1e-8 [%]", outcome.integration,
                        Tolerance("the answer is the model's, not the integrator's: one per cent", absolute=INTEGRATION))


def texts(bench):
    results = report.committed()
    return {"README.md": {"summary": report.summary(results), "cases": report.case_table(results), "limits": report.limits(), "settings": report.setting_table(results)}}


def draw(bench, _, plt):
    bench.save(report.picture(report.committed(), plt), "hard_cases.png")
