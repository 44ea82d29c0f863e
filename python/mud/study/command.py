# SPDX-License-Identifier: MIT
"""mud_study: what a scene of mud_host is worth, measured by runs of it."""

from __future__ import annotations

import argparse
import os
import pathlib
import shlex
import subprocess
import sys

from ..errors import InputError
from .accuracy import EXIT_CODES, MET, REFUSED, Study, share, sum_of, write_table
from .effects import LEAST_RUN, SHARE, Effects, Silent, write_scene
from .pictures import accuracy_picture, effects_picture, price_picture
from .runs import BudgetUsedUp, Failed, Scene, hold, write_csv

EXIT_INPUT, EXIT_INTERRUPTED = 2, 130
LEVELS = (0.1, 0.03, 0.01)  # of price
CODES = """exit codes: 0 met; 2 the command or the scene is refused; 3 runs of the scene fail; 21 localised; 22 does not
converge; 23 budget used up; 130 interrupted (the same command goes on)"""


COMMANDS = {
    "accuracy": "runs the scene until the measured error is what is asked",
    "price": "what 10, 3 and 1 per cent of error cost: error against time, recipe and picture",
    "effects": "what each effect of the scene changes, by pilots that cost a share of the run",
    "run": "leaves out what does not matter, and runs the scene until the error is what is asked",
}


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="mud_study", description=__doc__, epilog=CODES)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, words in COMMANDS.items():
        one = commands.add_parser(name, help=words, description=words, epilog=CODES)
        add = one.add_argument
        add("scene", help="file of a scene of mud_host")
        if name == "effects":
            add("--run", action="store_true", help="writes the scene without what does not matter, and runs it")
        if name in ("effects", "run"):
            add("--share", type=float, default=SHARE, metavar="S",
                help=f"of the run that pilots may cost; default {SHARE:g}; inf: any, also of short runs")
            add("--least-run", type=float, default=LEAST_RUN, metavar="SECONDS",
                help=f"time of the run below which there are no pilots; default {LEAST_RUN:g}")
        if name in ("accuracy", "run"):
            add("--accuracy", type=_share, default=1e-2, metavar="A", help="error asked for [-], default 1e-2")
        add("--budget", type=float, default=3600.0, metavar="SECONDS",
            help="time that runs may take; default 3600. Times are those of the processor")
        add("--goals", nargs="+", metavar="ANSWER", help="answers that count, as top.u_z plate.force_z; default: goals "
            "of the scene, else unknowns of points and plates")
        add("--output", type=pathlib.Path, metavar="FOLDER",
            help="folder of the study; finished runs in it are not repeated; default: study_SCENE")
        add("--host", default="", metavar="PROGRAM", help="mud_host; default: MUD_HOST, or the search path")
        add("--quiet", action="store_true", help="prints the last line only")
    return top


def _share(text):
    value = float(text)
    if not 1e-6 <= value <= 0.5:
        raise argparse.ArgumentTypeError(f"{text} is outside 1e-6 to 0.5")
    return value


def tell(study):
    """How a study ended where that is not as asked, and what its finest run warns of."""
    if study.state != MET:
        print(f"mud_study: {study.state}: {study.sentence}", file=sys.stderr, flush=True)
    for text in study.pairs[-1].run.warnings if study.pairs else []:
        print(f"mud_study: warning of the finest run: {text}", file=sys.stderr)


def forget(folder: pathlib.Path, name: str):
    """Removes table and picture of an earlier study: one that has no answer leaves none."""
    for kind in ("csv", "png"):
        (folder / f"{name}.{kind}").unlink(missing_ok=True)


def accuracy(scene: Scene, args, folder=None) -> int:
    """The study `accuracy`: table and picture in the folder of the study, the line."""
    folder = folder or scene.folder
    forget(folder, "accuracy")
    study = Study(scene, args.accuracy, args.goals)
    study.search()
    tell(study)
    if study.pairs:
        pair = study.pairs[-1]
        write_table(folder / "accuracy.csv", pair)
        accuracy_picture(folder / "accuracy.png", study)
        scene.say("answer, largest change, total of the error:")
        for name, e in sorted(pair.errors.items(), key=lambda item: -item[1].total):
            scene.say(f"   {name}: {e.change:.4g}, {share(e.total)}")
        for name in (goal for goal in study.goals if goal not in pair.errors):
            scene.say(f"   {name}: does not change")
        scene.say(f"results: {scene.folder / pair.run.key.folder}; errors: {folder / 'accuracy.csv'}, accuracy.png")
        scene.say(f"that run: {recipe(scene, pair.run.key)}")
        print(f"{sum_of(pair.errors[pair.worst])}, of {pair.worst}; asked {share(args.accuracy)}: {study.state}; "
              f"fineness {pair.fineness:g}, step tolerance {pair.tolerance:.4g}, {pair.run.seconds:.3g} s; study of "
              f"{len(scene.runs)} runs, {scene.spent / max(pair.run.seconds, 1e-3):.2g} times that run")
    return EXIT_CODES[study.state]


def price(scene: Scene, args) -> int:
    """The study `price`: pairs for 10, 3 and 1 %; what the budget does not reach is expected from those."""
    forget(scene.folder, "price")
    study, rows, recipes = Study(scene, LEVELS[0], args.goals), [], []
    for study.accuracy in LEVELS:
        if study.state in ("", MET):
            study.search()
    # A pair holds what it and all finer ones tell.
    held = [(p, max(q.total for q in study.pairs[i:])) for i, p in enumerate(study.pairs)]
    for level in LEVELS:
        enough = [(p, total) for p, total in held if total <= level]
        if enough:
            best, total = min(enough, key=lambda x: x[0].run.seconds)
            rows.append((level, MET, best.fineness, best.tolerance, total, best.run.seconds))
            recipes.append(recipe(scene, best.run.key))
        else:
            expected = study.expected(level) if study.pairs else None
            rows.append((level, study.state, *(expected or ("",) * 4)))
            recipes.append(recipe(scene, study.key(*expected[:2])) if expected else "")
    tell(study)
    if study.pairs:
        head = ("accuracy", "state", "fineness", "step_tolerance", "total", "seconds")
        write_csv(scene.folder / "price.csv", head, rows)
        price_picture(scene.folder / "price.png", study, rows)
        for (level, state, _, _, total, seconds), command in zip(rows, recipes):
            known = "measured" if state == MET else "expected"
            words = f"{seconds:.2g} s, {known} {share(total)}: {command}" if command else "no run known holds it"
            print(f"{share(level)}: {words}")
    return EXIT_CODES[study.state]


def run(scene: Scene, args) -> int:
    """The study `run`: effects, then accuracy of what is left."""
    path = reduced(scene, args)
    return accuracy(Scene(path, scene.folder / "runs", scene.host, scene.left, scene.quiet), args, scene.folder)


def effects(scene: Scene, args) -> int:
    """The study `effects`: table, and with --run the reduced scene and its run."""
    path = reduced(scene, args)
    if not args.run:
        return 0
    done = subprocess.run([scene.host, path, "--output", scene.folder / "run", *(["--quiet"] if args.quiet else [])])
    print(f"the run of {path}: exit code {done.returncode}, {scene.folder / 'run'}")
    return done.returncode


def reduced(scene: Scene, args) -> pathlib.Path:
    """The scene without what does not matter, as a file; the scene as it stands where no pilot may be run."""
    forget(scene.folder, "effects")
    study, path, rows = Effects(scene, args.share, args.least_run), scene.folder / "reduced.nml", []
    try:
        rows = study.search()
    except Silent as silent:
        scene.say(f"effects: {silent}; no effect is tried")
    except BudgetUsedUp:
        scene.say("effects: the budget ends before the pilots do; all stays as the scene has it")
    except Failed as failure:
        if failure.code in REFUSED:
            raise InputError(str(failure)) from failure
        print(f"mud_study: effects: {failure}; all stays as the scene has it", file=sys.stderr)
    scene.used += study.spent
    for row in rows:
        told = "" if row.influence is None else f"{share(row.influence)} of {row.answer}"
        by = "hand " if row.by_hand else "pilot"
        scene.say(f"   {row.name:26s} {'on' if row.on else 'off':3s} by {by} {told:30s} {row.why}")
    if rows:
        study.write(scene.folder / "effects.csv")
        effects_picture(scene.folder / "effects.png", rows, study.tolerance)
    write_scene(study.reduced(), path, scene.path.parent)
    untried = [r.name for r in study.rows if not (r.by_hand or r.on or (rows and r.influence is not None))]
    if untried:
        print(f"mud_study: no key says {', '.join(untried)}, nothing in the scene asks for it, and no pilot has tried "
              "it: off. Say it by its key, or try it by --share inf", file=sys.stderr)
    quoted = f", for a run quoted at {study.quote:.3g} s" if study.quote else ""
    scene.say(f"{study.pilots} pilots, {study.spent:.3g} s of processor time{quoted}; scene of the run: {path}")
    return path


def recipe(scene, key) -> str:
    """The command that makes a run."""
    return shlex.join(["mud_host", str(scene.path), *scene.words_of(key)])


def main(words: list[str] | None = None) -> int:
    args = parser().parse_args(words)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    folder = args.output or pathlib.Path(f"study_{pathlib.Path(args.scene).stem}")
    try:
        scene = Scene(args.scene, folder, args.host, args.budget, args.quiet)
        hold(folder)
        return {"accuracy": accuracy, "price": price, "effects": effects, "run": run}[args.command](scene, args)
    except (InputError, OSError) as problem:
        print(f"mud_study: {problem}", file=sys.stderr)
        return EXIT_INPUT
    except KeyboardInterrupt:
        print("\nmud_study: interrupted; the same command goes on", file=sys.stderr)
        return EXIT_INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
