# SPDX-License-Identifier: MIT
"""Tables and pictures of the committed results."""
import math
import pathlib

import cases_limits
import cases_reversals
import tables
from catalogue import SETTINGS

HERE = pathlib.Path(__file__).resolve().parent
CASES = cases_reversals.CASES + cases_limits.CASES
NAMES = ("case", "setting", "finished", "value", "allowed", "continuity", "integration", "rates", "cuts", "passed")


def committed():
    """(case, setting) -> row of results.csv."""
    return {(row["case"], row["setting"]): row for row in tables.rows(HERE / "results.csv")}


def number(text):
    value = float(text)
    return "0" if abs(value) < 1e-12 else f"{value:.2g}"


def verdict(row):
    if row["finished"] != "True":
        return "**does not end**"
    return number(row["value"]) if row["passed"] == "True" else f"**{number(row['value'])}**" + reasons(row)


def reasons(row):
    found = []
    if float(row["continuity"]) > 0.1:
        found.append(f"nudge {number(row['continuity'])}")
    if float(row["integration"]) > 1:
        found.append(f"tolerance {number(row['integration'])}")
    return f" ({', '.join(found)})" if found else ""


def case_table(results):
    lines = []
    for case in CASES:
        row, paper = results.get((case.name, "default")), results.get((case.name, "paper's remedy"))
        if row:
            lines.append((case.name, case.hard, f"{case.criterion}, at most {case.allowed:g}", verdict(paper) if paper else "", verdict(row), number(row["continuity"]),
                          number(row["integration"]), row["rates"]))
    return tables.markdown(("case", "what makes it hard", "criterion", "paper's remedy", "defaults", "nudge of 1e-9 [%]", "tolerance [%]", "rates"), lines)


def limits():
    return "\n".join(f"- **{case.name}**: {case.limit}." for case in CASES if case.limit) + "\n"


def setting_table(results):
    names = [setting.name for setting in SETTINGS]
    return tables.markdown(("case", *names), [
        (case.name, *(verdict(results[case.name, name]) if (case.name, name) in results else "" for name in names)) for case in CASES])


def summary(results):
    lines = []
    for setting in SETTINGS:
        rows = [results[case.name, setting.name] for case in CASES if (case.name, setting.name) in results]
        lines.append((setting.name, len(rows), sum(row["passed"] == "True" for row in rows), sum(row["finished"] != "True" for row in rows),
                      largest_change(rows), sum(int(row["rates"]) for row in rows), sum(int(row["cuts"]) for row in rows)))
    return tables.markdown(("setting", "cases", "passed", "did not end", "largest change after a nudge [%]", "rates", "cuts"), lines)


def largest_change(rows):
    """Of all cases that came to their end and were nudged [%], and which case it is."""
    asked = [(float(row["continuity"]), row["case"]) for row in rows if row["finished"] == "True" and not math.isnan(float(row["continuity"]))]
    if not asked:
        return ""
    value, case = max(asked)
    return f"{number(value)} ({case})"
