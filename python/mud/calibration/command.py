# SPDX-License-Identifier: MIT
"""The command mud_calibrate."""

from __future__ import annotations

import argparse
import pathlib
import sys

from ..errors import MudError
from .calibrate import calibrate
from .fit import Effort, say
from .report import summary, write_material, write_report
from .tables import NEEDS
from .task import make_task, read_task

EXAMPLE = """
With a task (TOML):     mud_calibrate my_sand.toml --output out
Or from tables alone:   mud_calibrate --name my_sand --drained triaxial.csv --oedometer oed.csv --known phi_c=33.1 \\
                                      --held-out T3 --held-out T7 --output out
It leaves out/materials/my_sand.nml (mud_triax --material out/materials/my_sand.nml) and out/my_sand/README.md.
"""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="mud_calibrate",
        description="Fits a material of MUD to laboratory tests.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("task", nargs="?", type=pathlib.Path, help="TOML file that says what to fit to what")
    parser.add_argument("--name", help="name of the material (with tables instead of a task)")
    for kind in NEEDS:
        parser.add_argument(f"--{kind}", action="append", default=[], metavar="CSV", help=f"table of {kind} tests")
    parser.add_argument(
        "--known",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="phi_c [degrees], G_max with G_max_p and G_max_e, or any parameter",
    )
    parser.add_argument(
        "--held-out", action="append", default=[], metavar="TEST", help="test that is not fitted, only compared"
    )
    parser.add_argument("--start", help="material to start from, whose values stay where nothing is fitted")
    parser.add_argument("--seed", type=int, default=None, help="of the search (default 1)")
    parser.add_argument("--beside", metavar="MATERIAL", help="show the misfit of this material too")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."), metavar="FOLDER")
    parser.add_argument(
        "--materials", type=pathlib.Path, metavar="FOLDER", help="where NAME.nml goes; default OUTPUT/materials"
    )
    parser.add_argument(
        "--workers", type=int, default=0, help="processes; default: one a core; the answer does not depend on it"
    )
    parser.add_argument(
        "--samples", type=int, default=Effort.samples, help=f"points of the search (default {Effort.samples})"
    )
    parser.add_argument(
        "--evaluations", type=int, default=Effort.joint, help=f"of the joint fit (default {Effort.joint})"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress")
    return parser


def _known(words: list[str]) -> dict[str, float]:
    known = {}
    for word in words:
        name, equals, value = word.partition("=")
        try:
            known[name] = float(value)
        except ValueError:
            equals = ""
        if not equals:
            sys.exit(f"mud_calibrate: --known {word}: write NAME=NUMBER, as in --known phi_c=33.1")
    return known


def main(words: list[str] | None = None) -> int:
    """Exit code 0: done; 2: what was given is refused."""
    parser = _parser()
    options = parser.parse_args(words)
    tables = [{"file": file, "kind": kind} for kind in NEEDS for file in getattr(options, kind)]
    if bool(options.task) == bool(tables):
        parser.error("give a task, or tables with --name: one of them")
    try:
        if options.task:
            for given, name in (
                (options.name, "--name"),
                (options.known, "--known"),
                (options.held_out, "--held-out"),
                (options.start, "--start"),
            ):
                if given:
                    parser.error(f"{name} stands in the task; change it there")
            task = read_task(options.task)
        else:
            if not options.name:
                parser.error("tables need --name")
            task = make_task(options.name, tables, options.held_out, known=_known(options.known), start=options.start)
        if options.seed is not None:
            task.seed = options.seed
        result = calibrate(
            task,
            Effort(samples=options.samples, joint=options.evaluations),
            options.workers,
            None if options.quiet else say,
            options.beside,
        )
    except MudError as problem:
        print(f"mud_calibrate: {problem}", file=sys.stderr)
        return 2
    material = write_material(result, options.materials or options.output / "materials")
    page = write_report(result, options.output / task.name)
    for line in summary(result.misfits):
        print(f"{line['set']}: {line['text']}")
    for sentence in (*result.diagnosis.sentences, *result.diagnosis.warnings):
        print(sentence)
    print(f"{material}\n{page}\n{result.seconds:.0f} s, {result.simulations} simulations")
    return 0


if __name__ == "__main__":
    sys.exit(main())
