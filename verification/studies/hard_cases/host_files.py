# SPDX-License-Identifier: MIT
"""Hard cases of the host's files: kills, full disks, damaged checkpoints and meshes, scenes of nonsense. The criterion is a number of runs
that did anything but what they promise; none is allowed."""
import math
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass
from typing import Callable

from host_cases import REFUSED_MESH
from host_runs import ENVIRONMENT, HostOutcome, host, run
from host_scenes import even, impact, rectangle, square
from tools import tables

HERE = pathlib.Path(__file__).resolve().parent
FILES = "files"
CRASH = re.compile(r"Fortran runtime error|Backtrace|Sanitizer|SIG[A-Z]+|terminate called")
EVERY = 10   # steps between checkpoints
WRONG, STOPPED, REFUSED = "WRONG", "message, continued, same files", "refused with a message"
CUT_OR_NOT = {"cut": "cut off", "bit": "one bit", "change": "one character"}
KINDS = ("refused", "read", "ran", "ended early", "still running", "failed")   # columns of nonsense.csv


def wrong_ones(record):
    return sum(answer == WRONG for _, answer in record)


@dataclass(frozen=True)
class FileCase:
    """`judge(folder, setting, quick)` gives (bad, tried, what happened, [(place, what became of it)]); `place` says what a place is."""
    name: str
    hard: str
    criterion: str
    judge: Callable
    place: str
    group: str = FILES
    allowed: float = 0
    limit: str = ""


def evaluate(case, setting, folder, quick=False):
    bad, tried, told, record = case.judge(folder, setting, quick)
    return HostOutcome(case.name, setting.name, True, bad, case.allowed, math.nan, tried, 0, bad <= case.allowed and tried > 0, told, record)


def scene(setting, quick):
    """A plate on unsaturated soil: three fields, contact, a checkpoint every ten steps."""
    text = impact(setting, duration=0.009 if quick else 0.03)
    return text.replace("gravity=9.81", f"gravity=9.81 checkpoint_steps={EVERY}", 1)


def differing(one, other):
    names = {p.name for p in [*one.iterdir(), *other.iterdir()] if not p.name.endswith(".part")}
    return [n for n in names if not (one / n).exists() or not (other / n).exists() or (one / n).read_bytes() != (other / n).read_bytes()]


def clear(result, *codes):
    """Whether a refusal is one: the right code, one sentence of some length, no crash."""
    return result.code in codes and not CRASH.search(result.told) and len(result.sentence().split()) > 4


def kills(folder, setting, quick):
    """Killed as soon as each checkpoint is there, and started again from it, to the end."""
    text = scene(setting, quick)
    whole = run(text, folder / "whole")
    out, count = folder / "killed/out", 0
    out.parent.mkdir(parents=True)
    (out.parent / "scene.nml").write_text(text, encoding="utf-8")
    mark = out / "checkpoint.h5"
    for _ in range(1000):
        before = mark.stat().st_mtime_ns if mark.exists() else 0
        child = subprocess.Popen([host(), out.parent / "scene.nml", "--output", out, "--quiet", *(("--restart", mark) if before else ())],
                                 env=ENVIRONMENT, stderr=subprocess.DEVNULL)
        while child.poll() is None and (mark.stat().st_mtime_ns if mark.exists() else 0) == before:
            time.sleep(0.0005)
        if child.poll() is not None:
            break
        child.send_signal(signal.SIGKILL)
        child.wait()
        count += 1
    wrong = differing(whole.folder, out)
    bad = len(wrong) + (child.returncode != 0) + (whole.code != 0)
    return (bad, count, f"{count} kills; files that differ: {', '.join(wrong) or 'none'}",
            [(EVERY * (i + 1), WRONG if bad else "killed, continued, same files") for i in range(count)])


def full_disks(folder, setting, quick):
    """No file may grow beyond a limit, which ends somewhere in the run; then there is room again, and the run goes on or starts anew."""
    text = scene(setting, quick)
    whole = run(text, folder / "whole")
    sizes = sorted({p.stat().st_size for p in whole.folder.iterdir()})
    dice = random.Random(2)
    limits = [dice.randrange(100, sizes[-1]) for _ in range(3 if quick else 12)]
    record = []
    for number, limit in enumerate(limits):
        place = folder / str(number)
        full = run(text, place, "--quiet", limits=lambda size=limit: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
        mark = place / "out/checkpoint.h5"
        after = run(text, place, "--quiet", *(("--restart", str(mark)) if mark.exists() else ()))
        good = clear(full, 4) and after.code == 0 and not differing(whole.folder, after.folder)
        record.append((limit / 1000, STOPPED if good else WRONG))
    return wrong_ones(record), len(limits), f"{len(limits)} limits from {min(limits)} to {max(limits)} bytes", record


def mounted(folder, setting, quick):
    """A file system of so many kilobytes that fills up on the way; needs user namespaces, without which nothing is tried."""
    text = scene(setting, quick)
    run(text, folder / "whole", "--quiet")
    whole = folder / "whole/out"
    place = folder / "small"
    place.mkdir()
    (folder / "scene.nml").write_text(text, encoding="utf-8")
    record = []
    for size in (20, 60, 120) if quick else (20, 40, 60, 80, 120, 160, 200, 300):
        kept = folder / f"kept{size}"
        script = (f"mount -t tmpfs -o size={size}k none {place} && {host()} {folder}/scene.nml --output {place}/out --quiet 2>{folder}/told; "
                  f"echo $? >{folder}/code; cp -r {place}/out {kept}")
        done = subprocess.run(["unshare", "-rm", "sh", "-c", script], capture_output=True, text=True, env=ENVIRONMENT)
        if not (folder / "code").exists() or "mount" in done.stderr or "unshare" in done.stderr:
            continue
        code, told = int((folder / "code").read_text()), (folder / "told").read_text()
        (folder / "code").unlink()
        if code == 0:
            record.append((size, WRONG if differing(whole, kept) else "room enough, same files"))
            continue
        good = code == 4 and "cannot be written" in told and len(told.splitlines()) == 1
        mark = kept / "checkpoint.h5"
        again = subprocess.run([host(), folder / "scene.nml", "--output", kept, "--quiet", *(("--restart", mark) if mark.exists() else ())],
                               capture_output=True, text=True, env=ENVIRONMENT)
        record.append((size, STOPPED if good and again.returncode == 0 and not differing(whole, kept) else WRONG))
    return wrong_ones(record), len(record), f"{len(record)} file systems of 20 to 300 kB", record


def damaged_checkpoints(folder, setting, quick):
    """Bits turned and ends cut off, everywhere: refused by one sentence, or, where nothing that counts was hit, the same end."""
    text = scene(setting, True)
    whole = run(text, folder / "whole")
    good = folder / "good"
    shutil.copytree(whole.folder, good)
    raw = (good / "checkpoint.h5").read_bytes()
    dice = random.Random(3)
    tries = [("bit", dice.randrange(8 * len(raw))) for _ in range(10 if quick else 200)] + [("cut", dice.randrange(len(raw))) for _ in range(5 if quick else 50)]
    control = run(text, folder / "whole", "--quiet", "--restart", str(good / "checkpoint.h5"))
    unsound = int(control.code != 0 or bool(differing(good, whole.folder)))   # the sound one is taken
    record = []
    for kind, place in tries:
        data = bytearray(raw)
        if kind == "bit":
            data[place // 8] ^= 1 << place % 8
        else:
            del data[place:]
        mark = folder / "bad.h5"
        mark.write_bytes(data)
        result = run(text, folder / "whole", "--quiet", "--restart", str(mark), seconds=60)
        if result.code == 0:   # nothing that counts was hit
            answer = WRONG if kind == "cut" or differing(good, whole.folder) else "nothing reads it, same files"
        else:
            answer = f"{CUT_OR_NOT[kind]}, {REFUSED}" if clear(result, 17) else WRONG
        record.append((100 * place / (8 * len(raw) if kind == "bit" else len(raw)), answer))
    ignored = sum(answer.startswith("nothing") for _, answer in record)
    return wrong_ones(record) + unsound, len(tries), f"{len(tries) - ignored} refused, {ignored} bits that nothing reads", record


def damaged_meshes(folder, setting, quick):
    """A mesh cut off anywhere, or with one character changed."""
    text, files = square(setting, rectangle(even(2), even(2)))
    mesh = files["square.msh"]
    good = run((text, files), folder / "good", "--check")
    assert good.code == 0, good.told
    dice = random.Random(4)
    record = []
    tries = [("cut", dice.randrange(len(mesh) - 1)) for _ in range(10 if quick else 150)] + [("change", dice.randrange(len(mesh))) for _ in range(10 if quick else 150)]
    complete = mesh.index("$EndElements") + len("$EndElements")
    for kind, place in tries:
        broken = mesh[:place] if kind == "cut" else mesh[:place] + dice.choice("0123456789-. $ex\n") + mesh[place + 1:]
        result = run((text, {"square.msh": broken}), folder / "broken", "--check", "--quiet", seconds=60)
        # A changed digit may be another good mesh; a mesh that was cut off never is.
        if clear(result, 2, 10, 11, 12, 13):
            answer = f"{CUT_OR_NOT[kind]}, {REFUSED}"
        else:
            answer = "read as another mesh" if result.code == 0 and (kind == "change" or place >= complete) else WRONG
        record.append((100 * place / len(mesh), answer))
    folded = run((text, {"square.msh": REFUSED_MESH}), folder / "folded", "--check", "--quiet")
    ran = sum(answer.startswith("read") for _, answer in record)
    return wrong_ones(record) + (not clear(folded, 12)), len(tries) + 1, f"{len(tries) + 1 - ran} refused, {ran} read as another mesh", record


def nonsense(folder, setting, quick):
    """The record of the long run: its places are blocks of scenes, and each kind of answer has its share [%]."""
    path = HERE / "nonsense.csv"
    rows = tables.rows(path) if path.exists() else []
    count = {key: sum(int(row[key]) for row in rows) for key in ("scenes", "failed", "refused", "read", "ran", "ended early", "still running")} if rows else {}
    told = ", ".join(f"{count[key]:,} {key}" for key in count if key not in ("scenes", "failed")) if rows else ""
    record = [((int(row["first"]) + int(row["scenes"]) / 2) / 1000, kind, 100 * int(row[kind]) / int(row["scenes"])) for row in rows for kind in KINDS]
    return count.get("failed", 0), count.get("scenes", 0), told, record


CASES = (
    FileCase("kill and restart at every tenth step", "files are half written, factors of the matrix are gone", "files that are not the same to the last bit", kills,
             "killed after step"),
    FileCase("full disk, by the size of a file", "every write may fail, that of the checkpoint too", "runs without a message, or whose continuation is not the same to the last bit",
             full_disks, "largest size of a file [kB]"),
    FileCase("full disk, by a small file system", "as before, with the error that the system reports for a full disk", "runs as before", mounted,
             "size of the file system [kB]"),
    FileCase("damaged checkpoint", "bits turned and ends cut off anywhere in a binary file", "answers that are neither a refusal with one message nor undamaged",
             damaged_checkpoints, "place in the file [%]"),
    FileCase("damaged mesh", "cut off anywhere, one character changed, an element that folds over", "answers that are neither a refusal with one message nor a mesh",
             damaged_meshes, "place in the file [%]"),
    FileCase("scenes of nonsense", "a grammar of all groups and keys, odd numbers, mistakes of every kind", "crashes, hangs, and refusals without a message", nonsense,
             "scene [1000]"),
)
