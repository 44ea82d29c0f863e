# SPDX-License-Identifier: MIT
"""The battery of memory rules: every row is a question that a rule answers with a few numbers.

   battery.py                                  all rows for the four standard rules
   battery.py --rules return_point:2e-5 3:0    rules by name or number, each with the radius of the elastic domain
   battery.py --rules return_point:2e-5:c_chi=0.26:c_ell=200      and further parameters
   battery.py --rows symmetric noise           some rows; --list tells their names and what they ask
   battery.py --quick                          the rows of the published table (seconds)
"""
import argparse
import json
import math
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
import memory_long  # noqa: E402
import memory_published  # noqa: E402
import memory_six  # noqa: E402
from point_walk import ROOT, RULES, Soil, Walker  # noqa: E402

ROWS = {row.__name__: row for rows in (memory_published, memory_six, memory_long) for row in rows.ROWS}
# The defaults with every option that remembers: cyclic preloading, fluidity, hysteresis of the retention curve.
ALL_MEMORIES = "return_point:2e-5:c_chi=0.26:c_ell=200:hysteresis=1"
QUICK = [row.__name__ for row in memory_published.ROWS]


def parse_rule(text):
    """The soil of NAME:RHO_E or NUMBER:RHO_E, with :PARAMETER=VALUE behind it as often as wanted."""
    name, radius, *more = [*text.split(":"), ""][:2] + text.split(":")[2:]
    try:
        further = tuple((key, float(value)) for key, value in (word.split("=") for word in more))
        return Soil(RULES[name] if name in RULES else int(name), float(radius or 0.0), further)
    except ValueError:
        raise SystemExit(f"rule {text}: NAME:RHO_E or NUMBER:RHO_E, names are {', '.join(RULES)}, and :PARAMETER=VALUE") from None


def question(row):
    return " ".join(row.__doc__.split())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rules", nargs="+", default=["classic:0", "classic:2e-5", "return_point:0", "return_point:2e-5"],
                        metavar="RULE:RHO_E")
    parser.add_argument("--rows", nargs="+", choices=ROWS)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--json", type=pathlib.Path, help="writes the numbers here")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    options = parser.parse_args()
    if options.list:
        for name, row in ROWS.items():
            print(f"{name:18s} {question(row)}")
        return
    soils = {text: parse_rule(text) for text in options.rules}
    walker = Walker(options.build)
    answers = {}
    for name in options.rows or (QUICK if options.quick else ROWS):
        start = time.time()
        print(f"{name}: {question(ROWS[name])}")
        answers[name] = {text: ROWS[name](walker, soil) for text, soil in soils.items()}
        keys = list(dict.fromkeys(k for found in answers[name].values() for k in found))
        for text, found in answers[name].items():
            print(f"   {text:20s} " + "  ".join(f"{k}: {found.get(k, math.nan):.4g}" for k in keys))
        print(f"   {time.time() - start:.1f} s", flush=True)
    if options.json:
        options.json.write_text(json.dumps(answers, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
