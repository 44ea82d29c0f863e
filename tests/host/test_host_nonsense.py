# SPDX-License-Identifier: MIT
"""Scenes of nonsense: a clear refusal or a run, never a crash.

300 scenes in the check run, 50 in the slow builds, which only read them; 1000 and 100 by ./check --tier nightly.
`MUD_NONSENSE=100000` for a long run, `MUD_NONSENSE_FIRST` for where it begins.
"""
import collections
import concurrent.futures
import os
import pathlib
import re
import shutil
import signal
import subprocess

from checking import add, build, check, light, nightly, root, work
from nonsense import Grammar  # noqa: E402

HOST = build / "host/mud_host"
TABLE = (root / "host/OUTPUT.md").read_text(encoding="utf-8").split("## Exit codes")[1]
CODES = {0, *map(int, re.findall(r"^\| (\d+) \|", TABLE, re.MULTILINE))}
REFUSALS = {2, 10, 11, 12}
CRASH = re.compile(r"Fortran runtime error|Backtrace|Sanitizer|runtime error:|SIG[A-Z]+|terminate called")
# Of the processor: a scene that still runs then is a run.
SECONDS = int(os.environ.get("MUD_NONSENSE_SECONDS", 2))
WAITING = 1200   # of the clock
OUT_OF_TIME = {-signal.SIGXCPU, 128 + signal.SIGXCPU}
ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1"}
FIRST = int(os.environ.get("MUD_NONSENSE_FIRST", 0))
EVERY = int(os.environ.get("MUD_NONSENSE_RUN", 10))
TOGETHER = "MUD_NONSENSE_TOGETHER" in os.environ
COUNT = int(os.environ.get("MUD_NONSENSE", (100 if nightly else 50) if light else (1000 if nightly else 300)))


def bases():
    """Scenes that work and take little: drained, coupled, with contact, with MUD at suction."""
    names = ("cylinder/scene.nml", "terzaghi/scene.nml", "contact/fall.nml", "element/suction.nml")
    folder = root / "verification/host"
    return [re.sub(r"'(\.\.[^']*)'", lambda m, at=(folder / name).parent: f"'{at / m[1]}'",
                   (folder / name).read_text(encoding="utf-8"))
            for name in names]


def judged(number, text):
    """What is wrong with the answer to a scene, an empty text if nothing is; and what the answer was."""
    folder = work / str(number)
    folder.mkdir()
    scene = folder / "scene.nml"
    scene.write_bytes(text.encode("utf-8"))
    # Reading and building alone for nine of ten; the slow builds trap overflow, which nonsense may well reach in a run.
    check_only = ("--check",) if light or number % EVERY else ()
    try:
        # Seconds of the processor, so that a busy machine hangs nothing; of the clock only for what waits for ever.
        limited = f'ulimit -S -t {60 if check_only else SECONDS}; exec "$0" "$@"'
        done = subprocess.run(["sh", "-c", limited, HOST, scene, "--output", folder / "out", "--quiet", *check_only],
                              capture_output=True, timeout=WAITING, env=ENVIRONMENT, cwd=folder,
                              stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        return "waits for ever", "still running"
    if done.returncode in OUT_OF_TIME:
        return ("reading hangs" if check_only else ""), "still running"
    shutil.rmtree(folder)
    return verdict(done.returncode, done.stderr.decode(errors="replace"), "read" if check_only else "ran")


def verdict(code, told, good):
    """What is wrong with an exit code and what was said, and what kind of answer it is."""
    kind = "refused" if code in REFUSALS else "ended early" if code else good
    if code not in CODES:
        return f"exit code {code}: {told[:300]}", kind
    if CRASH.search(told):
        return f"crash: {told[:300]}", kind
    if code and len(told.split()) < 4:
        return f"exit code {code} without a sentence: {told!r}", kind
    return "", kind


def read_together(texts):
    """{number: (what is wrong, kind)} of scenes that are only read; one process goes on until a scene ends it."""
    found, folder = {}, work / "together"
    folder.mkdir()
    for number, text in texts.items():
        (folder / f"{number}.nml").write_bytes(text.encode("utf-8"))
    while left := [number for number in texts if number not in found]:
        try:
            named = "".join(f"{folder / f'{n}.nml'}\n" for n in left).encode()
            done = subprocess.run([build / "tests/check_scenes"], input=named, capture_output=True, timeout=WAITING,
                                  env=ENVIRONMENT, cwd=folder)
            code, out, told = done.returncode, done.stdout, done.stderr.decode(errors="replace")
        except subprocess.TimeoutExpired as late:
            code, out, told = "hangs", late.stdout or b"", ""
        for answer in out.decode(errors="replace").split("scene " + str(folder))[1:]:
            name, _, answer = answer.partition("\n")
            at = int(pathlib.Path(name.strip()).stem)
            number, _, sentence = answer.strip().partition(" ")
            if number:
                found[at] = verdict(int(number), sentence, "read")
            else:
                found[at] = f"ends the process, {code}: {told[:300]}", "failed"
        if not out:
            raise SystemExit(f"check_scenes did nothing: {code} {told}")
    shutil.rmtree(folder)
    return found


def test_scenes_of_nonsense_run_or_are_refused_by_a_sentence():
    grammar = Grammar(subprocess.run([HOST, "--template"], capture_output=True, text=True, check=True).stdout)
    check("the grammar has the groups of the template", len(grammar.groups) > 15 and len(grammar.words) > 15,
          f"{grammar.groups.keys()}")
    texts = bases()
    passed = failed = 0
    kinds = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        numbers = range(FIRST, FIRST + COUNT)
        known = read_together({n: grammar.scene(n, texts) for n in numbers if n % EVERY}) if TOGETHER else {}
        answers = pool.map(lambda n: known.get(n) or judged(n, grammar.scene(n, texts)), numbers)
        for number, (wrong, kind) in zip(numbers, answers):
            kinds[kind] += 1
            passed, failed = passed + (not wrong), failed + bool(wrong)
            if wrong:
                print(f"FAILED scene {number} (MUD_NONSENSE_FIRST={number} MUD_NONSENSE=1): {wrong}")
    print("answers: " + ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items())))
    add(passed, failed)
