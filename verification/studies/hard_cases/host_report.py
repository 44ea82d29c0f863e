# SPDX-License-Identifier: MIT
"""Tables and pictures of the committed results of the host."""
import math
import pathlib

import host_cases
import host_files
import host_runs
import tables
from catalogue import CONTINUITY, SETTINGS
from report import largest_change, number

HERE = pathlib.Path(__file__).resolve().parent
CASES = host_cases.CASES + host_files.CASES
# With the defaults alone, in a few seconds together.
QUICK = ("chatter", "permeability 1e-8 to 1e-14 m2, quadratic pressures", "permeability 1e-8 to 1e-14 m2, linear pressures", "impact at suction 100 kPa",
         "slivers, distorted and graded meshes", "kill and restart at every tenth step", "damaged checkpoint", "damaged mesh")


def settings_of(case):
    return getattr(case, "settings", SETTINGS[:1])


def outcome(case, setting, quick=False):
    """One row: a case of files is judged by what its runs do, the others by their answers."""
    with host_runs.temporary() as folder:
        folder = pathlib.Path(folder)
        if isinstance(case, host_files.FileCase):
            return host_files.evaluate(case, setting, folder, quick)
        return host_runs.evaluate(case, setting, folder, nudge=not quick)


def committed():
    """(case, setting) -> row of host.csv."""
    path = HERE / "host.csv"
    return {(row["case"], row["setting"]): row for row in tables.rows(path)} if path.exists() else {}


def verdict(row):
    if row is None:
        return ""
    if row["finished"] != "True":
        return f"**{row['told']}**"
    value = number(row["value"]) if math.isfinite(float(row["value"])) else "-"
    if row["passed"] == "True":
        return value
    return f"**{value}**" + (f" (nudge {number(row['continuity'])})" if float(row["continuity"]) > CONTINUITY else "")


def case_table(results):
    lines = []
    for case in CASES:
        row, paper = results.get((case.name, "default")), results.get((case.name, "paper's remedy"))
        if row is None:
            continue
        nudge = float(row["continuity"])
        told = row["told"] if isinstance(case, host_files.FileCase) else ""
        lines.append((case.name, case.hard, f"{case.criterion}, at most {case.allowed:g}", verdict(paper), verdict(row) + (f": {told}" if told else ""),
                      "" if math.isnan(nudge) else number(nudge), row["iterations"], row["cuts"]))
    return tables.markdown(("case", "what makes it hard", "criterion", "paper's remedy", "defaults", "nudge of 1e-9 [%]", "iterations or runs", "cuts"), lines)


def setting_table(results):
    shown = [case for case in CASES if len(settings_of(case)) > 2]
    names = [setting.name for setting in SETTINGS]
    return tables.markdown(("case", *names), [(case.name, *(verdict(results.get((case.name, name))) for name in names)) for case in shown])


def summary(results):
    """Of the cases that a memory rule, a scheme or a tolerance can change."""
    asked = [case for case in CASES if len(settings_of(case)) > 2]
    lines = []
    for setting in SETTINGS:
        rows = [results[case.name, setting.name] for case in asked if (case.name, setting.name) in results]
        lines.append((setting.name, len(rows), sum(row["passed"] == "True" for row in rows), sum(row["finished"] != "True" for row in rows), largest_change(rows),
                      sum(int(row["iterations"]) for row in rows), sum(int(row["cuts"]) for row in rows)))
    return tables.markdown(("setting", "cases", "passed", "stopped with a message", "largest change after a nudge [%]", "iterations", "cuts"), lines)


def limits():
    return "\n".join(f"- **{case.name}**: {case.limit}." for case in CASES if case.limit) + "\n"


def peer_table():
    """What others answer to some of the paths, as peers.py found it."""
    path = HERE / "peers.csv"
    rows = tables.rows(path) if path.exists() else []
    schemes = list(dict.fromkeys(row["scheme"] for row in rows))
    found = {(row["case"], row["scheme"]): row for row in rows}
    lines = []
    for case in dict.fromkeys(row["case"] for row in rows):
        told = [found[case, scheme] for scheme in schemes]
        lines.append((case, told[-1]["told"], *(row["value"] if row["value"] != "nan" else row["told"] for row in told)))
    return tables.markdown(("path", "asked", *schemes), lines)


def nonsense():
    """One sentence on the record of scenes of nonsense."""
    path = HERE / "nonsense.csv"
    rows = tables.rows(path) if path.exists() else []
    total = {key: sum(int(row[key]) for row in rows) for key in ("scenes", "failed", "refused", "read", "ran", "ended early", "still running")}
    return (f"{total['scenes']:,} scenes of nonsense: {total['refused']:,} refused with a message, {total['read']:,} read and not run, "
            f"{total['ran']:,} ran to their end, {total['ended early']:,} ended early with a message, {total['still running']:,} still ran "
            f"when they were stopped, {total['failed']:,} crashed, hung or ended without a message.\n")
