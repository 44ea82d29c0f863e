# SPDX-License-Identifier: MIT
"""Memory rules under cycles and noise: the battery for every rule, and what the default rule has to pass."""
import math

import memory_long
import memory_published as published
import memory_six
from battery import ALL_MEMORIES, parse_rule, question
from memory_pictures import draw_biased, draw_loops, draw_noise, draw_symmetric
from point_walk import Walker
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="the default memory rule keeps symmetric cycles symmetric, closes loops and is not affected by small noise; the published rules do not",
    kind="study",
    input="paths of one point of Toyoura sand, written down in `memory_published.py`, `memory_six.py` and `memory_long.py` and run by `mud_walk`",
    reference="the same path without the event; for cycles, the symmetry of the material; for the size of an effect, docs/theory/memory-rules.md",
    seconds=55, quick=11, pictures=("loops.png", "symmetric.png", "biased.png", "noise.png"))

MAKES = (Script("make_results.py", ("results.csv",), 170),)

DEFAULT = "return_point:2e-5"
RULES = ("classic:0", "threshold:0", "repositioning:0", "return_point:0",
         "classic:2e-5", "threshold:2e-5", "repositioning:2e-5", "return_point:2e-5", ALL_MEMORIES)

POINTS = "the acceptance of the rule: 0.3 points of the numbers that a prototype gave (docs/theory/memory-rules.md)"
SYMMETRY = Tolerance("0.3 % of the range, in points of which the rule was accepted; the prototype's 0.01 of 6.2 kPa are half of it", absolute=0.3)
STRAIN = Tolerance("a tenth of the prototype's number and half its last digit: leads of 1, 2 or 4 kPa an increment differ by less", relative=0.1,
                   absolute=5e-4)
RANGE = Tolerance("the prototype's last digit, rounded, and the asymmetry that is allowed", absolute=0.025)
LOOP = Tolerance(POINTS, absolute=0.3)
SILENT = Tolerance("noise inside the elastic domain: the integration's tolerance of 1e-5 and what increments that end elsewhere add", absolute=5e-3)
NUMBER = Tolerance("the prototype at tolerance 1e-5, other increments around the turn", relative=1e-4)
TURNING = Tolerance("the requirement on turning paths: 1e-3 of the stress, a hundred tolerances", absolute=0.1)
QUICK_TURNS = ("circle 2e-4, 80 sides", "circle 2e-4, 332 sides", "square 2e-4", "eight 1e-4, 80 sides")

# What the prototype of the default rule gave; it had no isotropic memory.
SYMMETRIC = {"1 low": -3.07, "1 high": 3.10, "300 low": -3.09, "300 high": 3.10}
BIASED = {"100": 0.009, "1000": 0.068}
LOOPS = {(0.735, 0.01): (0.00, -0.02, -0.43, -4.4), (0.735, 0.10): (0.00, -0.29, -1.9, -3.2),
         (0.88, 0.01): (0.00, -0.03, -0.52, -5.0), (0.88, 0.10): (0.00, -0.36, -0.86, -5.3)}
ACROSS = -2.0
FIG1 = {"turn": 2844.56, "back": 2863.49, "0.105": 2958.68, "0.12": 3191.90}


def criteria(walker, soil):
    """(name, value, reference, tolerance, unit) of everything that is asked of the default rule."""
    found = []
    symmetry = memory_long.long_symmetric(walker, soil)
    found += [(f"1000 cycles of gamma {size}: asymmetry of tau in the last one over the range", value, 0.0, SYMMETRY, "%")
              for size, value in symmetry.items() if size != "cuts"]
    found += [(f"biased cycles without isotropic memory: axial strain after {n}", value, BIASED[n], STRAIN, "%")
              for n, value in published.biased(walker, soil.having(isotropic=1)).items()]
    found += [(f"300 cycles of gamma 1e-4: tau, {key}", value, SYMMETRIC[key], RANGE, "kPa")
              for key, value in published.symmetric(walker, soil).items() if key in SYMMETRIC]
    deviations = published.loops(walker, soil)
    for (e, place), expected in LOOPS.items():
        found += [(f"loop of {size:.1e} at {place:g}, e {e}: q 0.5 % later", deviations[f"e {e} at {place:g}, {size:.1e}"], value, LOOP, "%")
                  for size, value in zip(published.LOOP_SIZES, expected)]
    found += [(f"noise of {key}: q at 5 %", value, 0.0, SILENT, "%") for key, value in published.noise(walker, soil, sizes=(1e-6, 1e-5)).items()]
    found += [("noise of 1e-5 across the path: q at 5 %", published.across(walker, soil)["1e-05"], ACROSS, LOOP, "%")]
    found += [(f"Fig. 1: q, {key}", value, FIG1[key], NUMBER, "kPa") for key, value in published.fig1(walker, soil).items()]
    return found


def kept(walker, soil):
    """What the options that remember must leave: symmetry, silence under noise, first loading and its reversal of Fig. 1."""
    found = [(f"1000 cycles of gamma {size}: asymmetry of tau in the last one over the range", value, 0.0, SYMMETRY, "%")
             for size, value in memory_long.long_symmetric(walker, soil).items() if size != "cuts"]
    found += [(f"noise of {key}: q at 5 %", value, 0.0, SILENT, "%") for key, value in published.noise(walker, soil, sizes=(1e-6, 1e-5)).items()]
    return found + [(f"Fig. 1: q, {key}", value, FIG1[key], NUMBER, "kPa") for key, value in published.fig1(walker, soil).items()]


def misses(found):
    """How many of the criteria are not met."""
    return sum(not abs(value - reference) <= tolerance.absolute + tolerance.relative * abs(reference)
               for _, value, reference, tolerance, _ in found)


def check(bench):
    walker = Walker(bench.build)
    for name, value, reference, tolerance, unit in criteria(walker, parse_rule(DEFAULT)):
        bench.near(name, value, reference, tolerance, unit)
    if not bench.quick:
        for name, value, reference, tolerance, unit in kept(walker, parse_rule(ALL_MEMORIES)):
            bench.near(f"all memories: {name}", value, reference, tolerance, unit)
    turns = QUICK_TURNS if bench.quick else tuple(memory_six.TURNS)
    for name, value in memory_six.tolerance_on_turns(walker, parse_rule(DEFAULT), turns).items():
        bench.below(f"100 rounds of {name}: difference between the tolerances 1e-5 and 1e-8", value, TURNING, "%")
    # A criterion that every rule meets would prove nothing about the default.
    for rule, least in SEEN.items():
        bench.below(f"{rule}: criteria short of {least} that it misses", least - misses(criteria(walker, parse_rule(rule))),
                    Tolerance("the criteria detect a rule that ratchets or overshoots", absolute=0.0))
        if bench.quick:
            break
    return walker


SEEN = {"repositioning:2e-5": 10, "classic:2e-5": 10, "threshold:2e-5": 10, "classic:0": 20}


def draw(bench, walker, plt):
    for name, picture in (("loops", draw_loops), ("symmetric", draw_symmetric), ("biased", draw_biased), ("noise", draw_noise)):
        bench.save(picture(walker, plt), f"{name}.png")


# --- tables -----------------------------------------------------------------------------------------------------------
def number(text):
    value = float(text)
    if math.isnan(value):
        return "failed"
    if value == round(value) and abs(value) < 1e6:
        return f"{value:.0f}"
    if abs(value) < 5e-4:
        return f"{value:.0e}" if 1e-9 < abs(value) else "0"
    return f"{value:.2f}" if 0.1 <= abs(value) < 100 else f"{value:.3g}" if abs(value) < 0.1 else f"{value:.5g}"


def rule_text(rule):
    if rule == ALL_MEMORIES:
        return "all memories, 2e-5"
    name, radius = rule.split(":")
    return f"{name.replace('_', ' ')}, {radius}"


def published_table(values):
    def of(rule, row, *keys, separator="; "):
        return separator.join(number(values[row, key, rule]) for key in keys)
    head = ("rule, rho_e", "symmetric at 1; 300 [kPa]", "biased 100; 1000", "noise 1e-6 dense, loose", "noise 1e-5", "noise 5e-5", "walk 1e-5",
            "walk 5e-5", "across 1e-5")
    lines = []
    for rule in RULES:
        def noise(size, rule=rule):
            return of(rule, "noise", f"{size} e 0.735", f"{size} e 0.88", separator=", ")
        lines.append((rule_text(rule), "; ".join(f"{of(rule, 'symmetric', f'{i} low')}..{of(rule, 'symmetric', f'{i} high')}" for i in (1, 300)),
                      of(rule, "biased", "100", "1000"), noise("1e-06"), noise("1e-05"), noise("5e-05"), of(rule, "walk", "1e-05"),
                      of(rule, "walk", "5e-05"), of(rule, "across", "1e-05")))
    return tables.markdown(head, lines)


def loop_table(values):
    places = [(e, place) for e in (0.735, 0.88) for place in (0.01, 0.10)]
    return tables.markdown(("rule, rho_e", *(f"e {e} at {100 * place:g} %" for e, place in places)), [
        (rule_text(rule), *(", ".join(number(values["loops", f"e {e} at {place:g}, {size:.1e}", rule]) for size in published.LOOP_SIZES)
                            for e, place in places)) for rule in RULES])


def row_table(values, rows):
    """One line a quantity, one column a rule."""
    lines = []
    for row in rows:
        lines.append((f"**{row.__name__}**: {question(row)}", *[""] * len(RULES)))
        for key in dict.fromkeys(k for r, k, rule in values if r == row.__name__ and rule in RULES):
            found = [values.get((row.__name__, key, rule)) for rule in RULES]
            lines.append((key, *("" if value is None else number(value) for value in found)))
    return tables.markdown(("", *map(rule_text, RULES)), lines)


def energy_table(values):
    """The rows inside the elastic domain, and the first one outside."""
    return tables.markdown(("rho_e", "side of the square", "work of 100 loops [J/m3]", "largest drift of a stress [kPa]"), [
        (radius, side, number(values["energy", f"{side} work", f"{rule}:{radius}"]), number(values["energy", f"{side} drift", f"{rule}:{radius}"]))
        for rule, radius, side in (("classic", "1e-3", "1e-05"), ("classic", "1e-3", "1e-04"), ("return_point", "2e-5", "1e-05"),
                                   ("return_point", "2e-5", "2e-05"), ("return_point", "2e-5", "1e-04"))])


def texts(bench):
    found = tables.rows(bench.here / "results.csv")
    values = {(row["row"], row["quantity"], row["rule"]): row["value"] for row in found}
    return {"README.md": {"published": published_table(values), "loops": loop_table(values), "six": row_table(values, memory_six.ROWS),
                          "long": row_table(values, memory_long.ROWS), "energy": energy_table(values)}}


