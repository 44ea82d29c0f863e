# SPDX-License-Identifier: MIT
"""``mud_check_law``: a bench for anybody's UMAT or user-defined soil model of PLAXIS.

Runs what ``law_checks`` asks of a law and writes a report: one finding a line, pictures, and cases of ``mud_triax``.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import pathlib
import sys
from collections.abc import Sequence

import numpy as np

from . import _native
from .law_checks import CHECKS, FAULT, NOTE, UNJUDGED, Finding, Refusal, Setting
from .law_under_test import ORDERS, SYMBOLS, Ended, Law, apart
from .material import Material
from .plots import pyplot, style

SLOW = 300.0  # s that a check may take


def check_law(law: Law, at: Setting | None = None, only: Sequence[str] = (), progress=None) -> list[Finding]:
    """All findings of a law. ``only``: names of checks (keys of ``law_checks.CHECKS``)."""
    at = at or Setting(-100.0 * np.array([1.0, 1, 1, 0, 0, 0]))
    unknown = [name for name in only if name not in CHECKS]
    if unknown:
        raise ValueError(f"there is no check {unknown[0]!r}; there are: {', '.join(CHECKS)}")
    if law.n_state < 0:
        raise ValueError(f"n_state (--nstatv) is {law.n_state}; it is 0 or more")
    given = {"stress": at.stress, "suction": law.suction, "props": law.props, "statev": law.begin()}
    for name, values in given.items():
        if not np.isfinite(np.asarray(values, dtype=float)).all():
            raise ValueError(f"{name} (--{name}) has a value that is not finite")
    _room_for_state(law)
    if law.start_state is not None and len(law.start_state) != law.n_state:
        raise ValueError(
            f"start_state (--statev) has {len(law.start_state)} values, n_state (--nstatv) is {law.n_state}"
        )
    if not 0.0 < at.reach < 0.5 or at.increments < 10:
        raise ValueError("reach (--reach) is between 0 and 0.5, increments (--increments) at least 10")
    findings: list[Finding] = []
    for name, check in CHECKS.items():
        if only and name not in only:
            continue
        arguments = (law, at, _mud()) if name == "speed" else (law, at)
        try:
            found = apart(check, *arguments, seconds=SLOW)
        except Refusal as refusal:
            found = [Finding(name, UNJUDGED, f"{refusal}; a smaller --reach or another --stress may help")]
        except Ended as end:
            found = [Finding(name, FAULT, f"the check did not come to its end: {end}")]
        except (OSError, AttributeError) as problem:
            raise ValueError(f"{law.library} cannot be called as a {law.kind}: {problem}") from problem
        for finding in found:
            if progress:
                progress(line_of(finding))
        findings += found
    return findings


def _mud() -> Law:
    """The library's own UMAT with its default parameters: what a speed is compared with."""
    sand = Material()
    return Law(str(_native.mud._name), props=list(sand.props), n_state=_native.mud.mud_count(2))


def line_of(finding: Finding) -> str:
    value = "" if finding.value is None else f" [{finding.value:.2g}]"
    return f"{finding.verdict:10s} {finding.check}: {finding.sentence}{value}"


def write_report(findings: Sequence[Finding], law: Law, folder: pathlib.Path) -> None:
    """report.md, findings.json, a picture of every check that has curves, and cases of mud_triax."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = [
        f"# {pathlib.Path(law.library).name}: {law.symbol}",
        "",
        f"{law.kind}, {len(law.props)} properties, {law.n_state} state variables, {law.components} components.",
        "",
        "| verdict | check | finding | value | |",
        "|---|---|---|---|---|",
    ]
    for i, finding in enumerate(findings):
        more = []
        name = f"{i + 1:02d}_{finding.check.replace(' ', '_')}"
        if finding.case:
            (folder / f"{name}.nml").write_text(finding.case, encoding="utf-8")
            more.append(f"[case]({name}.nml)")
        if finding.curves:
            with contextlib.suppress(ImportError):  # without matplotlib there are no pictures
                _draw(finding, folder / f"{name}.png")
                more.append(f"[picture]({name}.png)")
        value = "" if finding.value is None else f"{finding.value:.2g}"
        lines.append(f"| {finding.verdict} | {finding.check} | {finding.sentence} | {value} | {', '.join(more)} |")
    (folder / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    rows = [{"check": f.check, "verdict": f.verdict, "sentence": f.sentence, "value": f.value} for f in findings]
    (folder / "findings.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


@style()
def _draw(finding: Finding, path: pathlib.Path) -> None:
    plt = pyplot()
    apart_curves = {k: v for k, v in finding.curves.items() if v[0]}
    iterations = {k: v[1] for k, v in finding.curves.items() if not v[0]}
    figure, axes = plt.subplots(1, 1 + bool(iterations), figsize=(5 + 4 * bool(iterations), 3.6), squeeze=False)
    panel = axes[0, 0]
    logarithmic = finding.check in ("increments", "tangent")
    for label, (x, y) in apart_curves.items():
        panel.plot(x, y, marker="o" if logarithmic else None, label=label)
    if logarithmic:
        panel.set_xscale("log")
        panel.set_yscale("log")
    panel.set_xlabel(finding.axes[0])
    panel.set_ylabel(finding.axes[1])
    panel.legend()
    for label, y in iterations.items():
        axes[0, 1].semilogy(range(len(y)), y, marker="o", label=label)
        axes[0, 1].set_xlabel("iteration")
        axes[0, 1].set_ylabel("residual of the stress")
        axes[0, 1].legend()
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.replace(",", " ").split()]


def _room_for_state(law: Law) -> None:
    """A model of PLAXIS says how many state variables it has: as many are taken, fewer are refused."""
    try:
        told = apart(law.told, seconds=20.0)
    except (OSError, AttributeError, Ended) as problem:
        raise ValueError(f"{law.library} cannot be called as a {law.kind}: {problem}") from problem
    if told is None:
        return
    if law.n_state == 0:
        law.n_state = told.n_state
    elif law.n_state < told.n_state:
        raise ValueError(
            f"n_state (--nstatv) is {law.n_state}; the law says that it has {told.n_state} (IDTASK 4): name these"
        )


def main(words: Sequence[str] | None = None) -> int:
    """The command. Exit codes: 0 no fault, 1 faults, 2 it could not be asked."""
    parser = argparse.ArgumentParser(prog="mud_check_law", description=__doc__.split("\n\n")[0].replace("``", ""))
    parser.add_argument("library", help="shared library of the law")
    parser.add_argument("--kind", choices=sorted(SYMBOLS), default="umat")
    parser.add_argument("--symbol", default="", help="default: " + ", ".join(f"{k}: {v}" for k, v in SYMBOLS.items()))
    parser.add_argument("--props", type=_numbers, default=[], help="PROPS in their order, separated by commas")
    parser.add_argument("--nstatv", type=int, default=0, help="number of state variables; UDSM: the law's own")
    parser.add_argument("--statev", type=_numbers, default=None, help="state variables at the start; default zeros")
    parser.add_argument("--stress", type=_numbers, default=[-100.0] * 3, help="at the start, tension positive: 3 or 6")
    parser.add_argument("--suction", type=float, default=0.0, help="PREDEF(1)")
    parser.add_argument("--shear-order", choices=sorted(ORDERS), default="abaqus", help="abaqus: 12, 13, 23")
    parser.add_argument("--components", type=int, choices=(4, 6), default=6, help="NTENS")
    parser.add_argument("--reach", type=float, default=1e-2, help="largest strain of a path")
    parser.add_argument("--increments", type=int, default=100, help="of a path")
    parser.add_argument("--only", action="append", default=[], metavar="CHECK", help=", ".join(CHECKS))
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("law_report"), help="folder of the report")
    given = parser.parse_args(words)
    try:
        if len(given.stress) not in (3, 6):
            raise ValueError(f"--stress has {len(given.stress)} components; allowed are 3 (normal) and 6")
        law = Law(
            given.library,
            given.kind,
            given.props,
            given.nstatv,
            given.symbol,
            given.shear_order,
            components=given.components,
            suction=given.suction,
            start_state=given.statev,
        )
        at = Setting(np.array(list(given.stress) + [0.0] * (6 - len(given.stress))), given.reach, given.increments)
        given.output.mkdir(parents=True, exist_ok=True)  # what cannot be written is told before the checks
        findings = check_law(law, at, given.only, lambda line: print(line, flush=True))
    except (ValueError, OSError) as problem:
        print(f"mud_check_law: {problem}", file=sys.stderr)
        return 2
    write_report(findings, law, given.output)
    count = {v: sum(f.verdict == v for f in findings) for v in (FAULT, NOTE, UNJUDGED)}
    unjudged = f", {count[UNJUDGED]} not judged" if count[UNJUDGED] else ""
    page = given.output / "report.md"
    print(f"{len(findings)} findings, {count[FAULT]} faults, {count[NOTE]} notes{unjudged}: {page}")
    return 1 if count[FAULT] else 0


if __name__ == "__main__":
    sys.exit(main())
