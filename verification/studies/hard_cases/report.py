# SPDX-License-Identifier: MIT
"""Tables and pictures of the committed results."""
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
                      sum(int(row["rates"]) for row in rows), sum(int(row["cuts"]) for row in rows)))
    return tables.markdown(("setting", "cases", "passed", "did not end", "rates", "cuts"), lines)


def picture(results, plt):
    """Cases down, settings across: passed, failed its criterion, did not end."""
    colours = {"passed": (0.75, 0.88, 0.75), "failed": (0.96, 0.72, 0.55), "ended": (0.75, 0.25, 0.25), "none": (0.93, 0.93, 0.93)}
    figure, axes = plt.subplots(figsize=(9.5, 0.2 * len(CASES) + 1.6))
    image = []
    for case in CASES:
        line = []
        for setting in SETTINGS:
            row = results.get((case.name, setting.name))
            line.append(colours["none" if not row else "ended" if row["finished"] != "True" else "passed" if row["passed"] == "True" else "failed"])
        image.append(line)
    axes.imshow(image, aspect="auto")
    axes.set_yticks(range(len(CASES)), [case.name for case in CASES], fontsize=7)
    axes.set_xticks(range(len(SETTINGS)), [setting.name for setting in SETTINGS], fontsize=7, rotation=30, ha="left")
    axes.xaxis.tick_top()
    handles = [plt.Rectangle((0, 0), 1, 1, color=colours[key]) for key in ("passed", "failed", "ended")]
    axes.legend(handles, ("passed", "misses a criterion", "does not come to its end"), loc="upper center", bbox_to_anchor=(0.5, -0.01), ncol=3,
                fontsize=7, frameon=False)
    figure.tight_layout()
    return figure
