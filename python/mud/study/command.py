# SPDX-License-Identifier: MIT
"""mud_study: what a scene of mud_host is worth, measured by runs of it."""

from __future__ import annotations

import argparse
import os
import pathlib
import sys

from ..errors import InputError
from .accuracy import BUDGET, EXIT_CODES, MET, Study, share, sum_of, write_table
from .runs import Scene

EXIT_INPUT, EXIT_INTERRUPTED = 2, 130
CODES = """exit codes: 0 met; 2 the command or the scene is refused; 3 runs of the scene fail; 21 localised; 22 does not
converge; 23 budget used up; 130 interrupted (the same command goes on)"""


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="mud_study", description=__doc__, epilog=CODES)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, words in (("accuracy", "runs the scene until the measured error is what is asked"),):
        one = commands.add_parser(name, help=words, description=words, epilog=CODES)
        one.add_argument("scene", help="file of a scene of mud_host")
        one.add_argument("--accuracy", type=_share, default=1e-2, metavar="A", help="error asked for [-], default 1e-2")
        one.add_argument("--budget", type=float, default=3600.0, metavar="SECONDS",
                         help="no run ends later than this; default 3600")
        one.add_argument("--goals", nargs="+", metavar="ANSWER", help="answers that count, as top.u_z plate.force_z; "
                         "default: goals of the scene, else unknowns of points and plates")
        one.add_argument("--output", type=pathlib.Path, metavar="FOLDER",
                         help="folder of the study; finished runs in it are not repeated; default: study_SCENE")
        one.add_argument("--host", default="", metavar="PROGRAM", help="mud_host; default: MUD_HOST, or the search path")
        one.add_argument("--quiet", action="store_true", help="prints the last line only")
    return top


def _share(text):
    value = float(text)
    if not 1e-6 <= value <= 0.5:
        raise argparse.ArgumentTypeError(f"{text} is outside 1e-6 to 0.5")
    return value


def accuracy(scene: Scene, args) -> int:
    """The study `accuracy`: table, picture, the line."""
    study = Study(scene, args.accuracy, args.goals)
    result = study.search()
    if not result.pairs:
        print(f"mud_study: {result.state}: {result.sentence}", file=sys.stderr)
        return EXIT_CODES[result.state]
    pair = result.last
    write_table(scene.folder / "accuracy.csv", pair)
    from .pictures import accuracy_picture

    accuracy_picture(scene.folder / "accuracy.png", result, args.accuracy)
    if result.state != MET:
        print(f"mud_study: {result.state}: {result.sentence}", file=sys.stderr, flush=True)
    scene.say("answer, largest change, total of the error:")
    for name, e in sorted(pair.errors.items(), key=lambda item: -item[1].total):
        scene.say(f"   {name}: {e.change:.4g}, {share(e.total)}")
    print(last_line(result, scene, args.accuracy))
    return EXIT_CODES[result.state]


def last_line(result, scene, asked):
    pair = result.last
    run = pair.run
    return (f"{sum_of(pair.errors[pair.worst])}, of {pair.worst}; asked {share(asked)}: {result.state}; "
            f"fineness {pair.fineness:g}, step tolerance {pair.tolerance:.2g}, {run.seconds:.3g} s; study of "
            f"{len(scene.runs)} runs, {scene.spent / max(run.processor, 1e-3):.2g} times that run")


def main(words: list[str] | None = None) -> int:
    args = parser().parse_args(words)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    folder = args.output or pathlib.Path(f"study_{pathlib.Path(args.scene).stem}")
    try:
        scene = Scene(args.scene, folder, args.host, args.budget, args.quiet)
        folder.mkdir(parents=True, exist_ok=True)
        return {"accuracy": accuracy}[args.command](scene, args)
    except InputError as problem:
        print(f"mud_study: {problem}", file=sys.stderr)
        return EXIT_INPUT
    except KeyboardInterrupt:
        print("\nmud_study: interrupted; the same command goes on", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
