# SPDX-License-Identifier: MIT
"""The command mud_calibrate."""

from __future__ import annotations

import argparse
import pathlib
import sys
import tempfile

from ..errors import InputError, MudError
from .calibrate import calibrate, evaluate, remarks_of_the_library
from .fit import Effort, say
from .report import summary, write_material, write_report
from .tables import NEEDS
from .task import Task, make_task, read_task

UNFINISHED = "unfinished.evaluations"  # in the folder of the page while a fit runs
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
    parser.add_argument(
        "--evaluate", metavar="MATERIAL", help="fit nothing: the page of this material, a name or a file *.nml"
    )
    parser.add_argument(
        "--first", type=float, metavar="kPa", help="stress from which compression counts (default 10 where it begins below)"
    )
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
    parser.add_argument(
        "--starts", type=int, default=Effort.starts, help=f"starts that are followed (default {Effort.starts})"
    )
    parser.add_argument(
        "--members", type=int, default=Effort.members, help=f"sets of the ensemble, 0: none (default {Effort.members})"
    )
    parser.add_argument("--quiet", action="store_true", help="no progress, and no remarks of the library on sets that are tried")
    return parser


def _known(words: list[str]) -> dict[str, float]:
    known = {}
    for word in words:
        name, equals, value = word.partition("=")
        if name in known:
            raise InputError(f"--known {word}: {name} is given twice")
        try:
            known[name] = float(value)
        except ValueError:
            equals = ""
        if not equals:
            raise InputError(f"--known {word}: write NAME=NUMBER, as in --known phi_c=33.1")
    return known


def main(words: list[str] | None = None) -> int:
    """Exit code 0: done; 2: what was given is refused; 130: interrupted."""
    parser = _parser()
    options = parser.parse_args(words)
    with remarks_of_the_library(not options.quiet):
        return _run(parser, options)


def _run(parser: argparse.ArgumentParser, options: argparse.Namespace) -> int:
    """A command whose words are understood; its exit code."""
    tables = [{"file": file, "kind": kind} for kind in NEEDS for file in getattr(options, kind.replace("-", "_"))]
    if options.first is not None:
        tables = [{**t, "first": options.first} if t["kind"] in ("oedometer", "isotropic") else t for t in tables]
    if bool(options.task) == bool(tables):
        parser.error("give a task, or tables with --name: one of them")
    try:
        task = _task(parser, options, tables)
        materials, folder = options.materials or options.output / "materials", options.output / task.name
        for place in (folder,) if options.evaluate else (materials, folder):
            _try(place)
        if options.evaluate:
            result = evaluate(task, options.evaluate, options.beside)
        else:
            result = calibrate(
                task,
                Effort(
                    samples=options.samples, starts=options.starts, joint=options.evaluations, members=options.members
                ),
                options.workers,
                None if options.quiet else say,
                options.beside,
                folder / UNFINISHED,
            )
        written = [] if options.evaluate else [write_material(result, materials)]
        written.append(write_report(result, folder))
    except MudError as problem:
        print(f"mud_calibrate: {problem}", file=sys.stderr)
        return 2
    except OSError as problem:
        print(f"mud_calibrate: {problem.filename} cannot be written: {problem.strerror}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print(
            f"\nmud_calibrate: interrupted; the same command goes on from {folder / UNFINISHED}", file=sys.stderr
        )
        return 130
    for line in summary(result.misfits, bool(result.diagnosis)):
        print(f"{line['set']}: {line['text']}")
    found = (*result.diagnosis.sentences, *result.diagnosis.warnings) if result.diagnosis else ()
    for sentence in (*result.notes, *found):
        print(sentence)
    print("\n".join(map(str, written)))
    print(f"{result.seconds:.0f} s, {result.simulations} simulations")
    return 0


def _task(parser: argparse.ArgumentParser, options: argparse.Namespace, tables: list[dict]) -> Task:
    """The task of a file, or of the tables of the command line."""
    if not options.task:
        if not options.name:
            parser.error("tables need --name")
        others = {"known": _known(options.known), "start": options.start}
        others |= {} if options.seed is None else {"seed": options.seed}
        return make_task(options.name, tables, options.held_out, **others)
    for given, name in (
        (options.name, "--name"),
        (options.known, "--known"),
        (options.held_out, "--held-out"),
        (options.start, "--start"),
        (options.first is not None, "--first"),
    ):
        if given:
            parser.error(f"{name} stands in the task; change it there")
    task = read_task(options.task)
    if options.seed is not None:
        task.seed = options.seed
    return task


def _try(folder: pathlib.Path) -> None:
    """Refuses a folder that nothing can be written to, before minutes of work."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as problem:
        raise InputError(f"--output: {folder} cannot be written: {problem.strerror}") from problem


if __name__ == "__main__":
    sys.exit(main())
