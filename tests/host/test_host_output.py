# SPDX-License-Identifier: MIT
"""Output of mud_host: restarts after SIGKILL at random moments, refused checkpoints, full disks, files and pictures."""
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import h5py
import matplotlib.pyplot as plt
import meshio
import numpy as np

from checking import brief, build, check, light, root, work
import tables  # noqa: E402 (checking knows its folder)

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
NO_LEAKS = {**environment, "LSAN_OPTIONS": "detect_leaks=0"}   # HDF5 loses buffers of a file damaged or not written


def run(scene, out, *more, **how):
    how = {"env": environment, "capture_output": True, "text": True, **how}
    return subprocess.run([host, scene, "--output", out, *more], **how)


def differences(one, other):
    """Names of files that are not the same in two folders of output."""
    names = {p.name for p in [*one.iterdir(), *other.iterdir()]}
    return [name for name in sorted(names) if not (one / name).exists() or not (other / name).exists()
            or (one / name).read_bytes() != (other / name).read_bytes()]


# The scene of the restarts: MUD, three fields, growing and cut steps, a checkpoint after every other
# step, so that factors serve again. The checking builds take a shorter one.
scene = work / "scene.nml"
whole = work / "whole"
KILLS = 4 if brief else 6 if light else 10
keep = work / "kept.h5"

# Checkpoints that are refused.
bad = work / "bad.h5"


def raw():
    return keep.read_bytes()


def altered(change):
    bad.write_bytes(raw())
    with h5py.File(bad, "r+") as file:
        change(file)


def flip():
    """One bit of the data of the displacements."""
    with h5py.File(keep) as file:
        place = file["x"].id.get_chunk_info(0).byte_offset
    data = bytearray(raw())
    data[place + 100] ^= 1
    bad.write_bytes(data)


def flip_structure():
    """One bit of what says where the number of steps is and what it looks like."""
    with h5py.File(keep) as file:
        place = h5py.h5o.get_info(file["steps"].id).addr
    data = bytearray(raw())
    data[place + 40] ^= 1
    bad.write_bytes(data)


def foreign(name, value):
    """A count that no run writes, under a good checksum."""
    return lambda: altered(lambda file: file[name].__setitem__(0, value))


def drop(file):
    del file["stress"]


def shorten(file):
    del file["s"]
    file["s"] = np.ones(3)


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def refused(what, folder, words, *more, **how):
    before = contents(folder)
    done = subprocess.run([host, scene, "--restart", keep, "--quiet", *more], capture_output=True, text=True,
                          env=environment, **how)
    check(f"restart {what}", done.returncode == 17 and words in done.stderr and len(done.stderr.splitlines()) == 1,
          f"{done.returncode}: {done.stderr}")
    check(f"restart {what}: nothing changed", contents(folder) == before)


FAR = 3*10**9


# A full disk, as a limit on the size of a file that the next checkpoint does not fit under: the last good one is kept.
def small_disk():
    resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))


# Pictures without writing code; what there is not is named.
plot = [sys.executable, root / "host/plot_run.py", whole]


def on_a_terminal(*command):
    """What a program shows on a terminal; None where the machine has none to lend."""
    try:
        near, far = os.openpty()
    except OSError:
        return None
    child = subprocess.Popen(command, env=environment, stdout=far)
    os.close(far)
    shown = b""
    while True:
        try:
            piece = os.read(near, 4096)
        except OSError:  # the other end is closed
            break
        if not piece:
            break
        shown += piece
    child.wait()
    os.close(near)
    return shown


def same_after_a_kill(what, case, rows=10):
    """A scene runs at once, and once killed behind some rows and restarted: the same bytes. The folder of the first."""
    one, two = work / f"{what}_one", work / f"{what}_two"
    done = run(case, one, "--quiet")
    check(f"{what}: uninterrupted run", done.returncode == 0, done.stderr)
    child = subprocess.Popen([host, case, "--output", two, "--quiet"], env=environment)
    while child.poll() is None and not ((two / "ledger.csv").exists() and (two / "checkpoint.h5").exists()
                                        and len((two / "ledger.csv").read_bytes().splitlines()) > rows):
        time.sleep(0.002)
    check(f"{what}: killed on the way", child.poll() is None)
    child.send_signal(signal.SIGKILL)
    child.wait()
    done = run(case, two, "--quiet", "--restart", two / "checkpoint.h5")
    for left_over in two.glob("*.part"):
        left_over.unlink()
    check(f"{what}: same bytes", done.returncode == 0 and not differences(one, two),
          done.stderr + str(differences(one, two)))
    return one


def test_uninterrupted_run():
    text = (root / "tests/host/scenes/restart.nml").read_text().replace("../../..", str(root))
    if light:
        text = text.replace("duration = 0.03\n", "duration = 0.01\n").replace("duration = 0.3\n", "duration = 0.03\n")
    scene.write_text(text)
    t0 = time.monotonic()
    done = run(scene, work / "whole", "--quiet")
    duration = time.monotonic() - t0
    check("uninterrupted run", done.returncode == 0, done.stderr)

    # SIGKILL at ten random moments (fewer in the slow builds), at least two of them in a checkpoint's write, seen by
    # the unfinished file that stays behind. Those are aimed at: the kill
    # follows as soon as the unfinished file shows up.
    dice = random.Random(1)
    out = work / "killed"
    kills = in_write = starts = 0
    while kills < KILLS and starts < 100:
        starts += 1
        part, last = out / "checkpoint.h5.part", out / "checkpoint.h5"
        part.unlink(missing_ok=True)
        more = ("--restart", last) if last.exists() else ()
        child = subprocess.Popen(
            [host, scene, "--output", out, "--quiet", *more],
            env=environment, stderr=subprocess.PIPE)
        aimed = kills % 2 == 1
        end = time.monotonic() + dice.uniform(0.02, 0.25)*duration
        while child.poll() is None and (time.monotonic() < end or aimed and not part.exists()):
            pass
        if child.poll() is not None:
            if child.returncode:
                check("restarted run goes on", False, child.stderr.read().decode())
                break
            shutil.rmtree(out)  # it came to its end: once more from the start, the moments are not all used up
            continue
        child.send_signal(signal.SIGKILL)
        child.wait()
        kills += 1
        in_write += part.exists()
    check("as many kills as asked for", kills == KILLS, kills)
    check("two kills in a write", in_write >= 2, in_write)
    (out / "checkpoint.h5.part").unlink(missing_ok=True)
    for left_over in out.glob("*.part"):
        left_over.unlink()
    done = run(scene, out, "--quiet",
               *(("--restart", out / "checkpoint.h5") if (out / "checkpoint.h5").exists() else ()))
    check("last restart ends well", done.returncode == 0, done.stderr)
    check("restarted after kills: same bytes", not differences(whole, out), differences(whole, out))

    # From a checkpoint in the middle: only so a second comparison is sure to cover most of the run.
    half = work / "half"
    child = subprocess.Popen([host, scene, "--output", half, "--quiet"], env=environment)
    while child.poll() is None and not ((half / "ledger.csv").exists()
                                        and len((half / "ledger.csv").read_bytes().splitlines()) > 13):
        time.sleep(0.002)
    killed = child.poll() is None
    child.send_signal(signal.SIGKILL)
    child.wait()
    check("killed on the way", killed)
    with h5py.File(half / "checkpoint.h5") as file:
        step = int(file["steps"][0])
        kept = {name: dict(item.attrs) for name, item in file.items() if name.startswith("control_")}
        check("what the control of the steps carries is stored by name, with its unit and meaning",
              {"control_dt", "control_held", "control_t_sudden", "control_x_first", "control_rate"} <= set(kept)
              and all(said["unit"] and said["description"] for said in kept.values()), kept)
    check("checkpoint on the way", 0 < step < len((whole / "ledger.csv").read_bytes().splitlines()) - 1, step)

    shutil.copy(half / "checkpoint.h5", keep)
    shutil.copytree(half, work / "full")
    done = run(scene, half, "--quiet", "--restart", half / "checkpoint.h5")
    for left_over in half.glob("*.part"):
        left_over.unlink()
    check("restart on the way: same bytes", done.returncode == 0 and not differences(whole, half),
          done.stderr + str(differences(whole, half)))

    # A plate in contact: its tables and the matrix that grew with it come back too.
    touch = work / "touch.nml"
    plate = (root / "verification/studies/indentation/indent_s030.nml").read_text().replace("../../..", str(root))
    touch.write_text(plate.replace("duration = 0.03999", f"duration = {6.0e-4 if light else 1.5e-3}")
                     .replace("gravity = 9.81", "gravity = 9.81\n   checkpoint_steps = 4"))
    one = same_after_a_kill("contact", touch)
    check("contact: rows", len((one / "contact.csv").read_text().splitlines()) > (20 if light else 50))

    # Everything that soil can remember: turning points of suction, contraction, margin, fluidity.
    soil = "hysteresis = 1\n   isotropic = 2\n   c_chi = 0.26\n   c_ell = 200\n   p_ell = 200"
    memories = work / "memories.nml"
    memories.write_text(text.replace("tangent = 3", f"tangent = 3\n   {soil}"))
    same_after_a_kill("memories", memories)
    with h5py.File(work / "memories_one/checkpoint.h5") as file:
        shapes = {name: getattr(data, "shape", ()) for name, data in file.items()}
    # As many as another host is told to keep of this material.
    (work / "soil.nml").write_text(f"&material {soil} /\n")
    told = subprocess.run([build / "drivers/mud_describe", "abaqus", work / "soil.nml"], capture_output=True, text=True)
    depvar = int(re.search(r"\*Depvar\s+(\d+)", told.stdout)[1])
    check("memories: every number of STATEV is kept", any(depvar in shape for shape in shapes.values()),
          (depvar, shapes))

    # Comments and threads belong to nobody's fingerprint; a value does.
    scene.write_text(
    "! another comment\n" +
    text.replace(
        "checkpoint_steps = 2",
         "threads = 2\n   checkpoint_steps = 0"))
    done = run(scene, half, "--quiet", "--restart", half / "checkpoint.h5")
    check("same scene with a comment and other threads", done.returncode == 0, done.stderr)
    scene.write_text(text)

    # Trees of the oldest format have no checksum: a bit of one that turns loses a dataset, which then reads as zeros.
    check("every structure of a checkpoint has a checksum", b"TREE" not in raw() and b"SNOD" not in raw())

    other = text.replace("void_ratio = 0.8", "void_ratio = 0.81")
    REFUSED = [
        ("missing", lambda: bad.unlink(missing_ok=True), text, "is missing"),
        ("empty", lambda: bad.write_bytes(b""), text, "truncated"),
        ("truncated", lambda: bad.write_bytes(raw()[:len(raw())//2]), text, "truncated"),
        ("one byte short", lambda: bad.write_bytes(raw()[:-1]), text, "truncated"),
        ("no HDF5", lambda: bad.write_bytes(b"checkpoint"*1000), text, "no HDF5"),
        ("foreign HDF5", lambda: shutil.copy(whole / "mesh.h5", bad), text, "no checkpoint"),
        ("other format", lambda: altered(lambda f: f.attrs.modify("format", np.bytes_("0"))), text, "another version"),
        ("other library", lambda: altered(lambda f: f.attrs.modify("library", np.bytes_("9.9"))), text,
         "another version"),
        ("damaged bit", flip, text, "damaged"),
        ("damaged structure", flip_structure, text, "damaged"),
        ("stage that is not there", foreign("stage_number", 7.0), text, "damaged"),
        ("negative count", foreign("steps", -1.0), text, "damaged"),
        ("half a step", foreign("steps", 2.5), text, "damaged"),
        ("count that is no number", foreign("stage_number", float("nan")), text, "damaged"),
        ("no fields of which there are times", foreign("frames_extent", -1.0), text, "damaged"),
        ("negative number of fields", foreign("frames_extent", -2.0), text, "damaged"),
        ("more fields than times of them", foreign("frames_extent", 1e9), text, "damaged"),
        ("no number of steps", lambda: altered(lambda file: file.__delitem__("steps")), text, "damaged"),
        ("missing entry", lambda: altered(drop), text, "damaged"),
        ("missing number of an observer", lambda: altered(lambda file: file.__delitem__("cycles_largest")), text,
         "damaged"),
        ("no next step", lambda: altered(lambda file: file.__delitem__("control_dt")), text, "damaged"),
        ("no times of fields", lambda: altered(lambda file: file.__delitem__("frames")), text, "damaged"),
        ("other extent", lambda: altered(shorten), text, "damaged"),
        ("other scene", lambda: bad.write_bytes(raw()), other, "another scene"),
    ]
    for what, make, scene_text, words in REFUSED:
        make()
        scene.write_text(scene_text)
        done = run(scene, half, "--quiet", "--restart", bad, env=NO_LEAKS)
        check(f"checkpoint {what}: exit code", done.returncode == 17, f"{done.returncode}: {done.stderr}")
        check(
    f"checkpoint {what}: one sentence",
    words in done.stderr and len(
        done.stderr.splitlines()) == 1,
         done.stderr)
    scene.write_text(text)
    done = run(scene, work / "elsewhere", "--quiet", "--restart", keep)
    check("restart into another folder", done.returncode == 17 and "interrupted run" in done.stderr, done.stderr)

    # A restart that is refused changes nothing in the folder, nor does one make it.
    check("refused restart: no folder", not (work / "elsewhere").exists())

    stranger = work / "stranger"
    scene.write_text(other)
    done = run(scene, stranger, "--quiet")
    scene.write_text(text)
    check("run of another scene", done.returncode == 0, done.stderr)
    refused("over another run", stranger, "holds another run", "--output", stranger)
    for name in ("histories.csv", "ledger.csv"):
        lost = work / f"without_{name}"
        shutil.copytree(whole, lost)
        (lost / name).unlink()
        refused(f"without {name}", lost, name, "--output", lost)
        (lost / name).write_bytes((whole / name).read_bytes()[:100])
        refused(f"with a short {name}", lost, name, "--output", lost)
    (lost / "mesh.h5").unlink()
    refused("without a mesh", lost, "mesh.h5", "--output", lost)

    # Without --output it goes on where the checkpoint lies, whatever the default folder holds.
    shutil.copytree(half, work / "home")
    shutil.copy(keep, work / "home/checkpoint.h5")
    elsewhere = work / "start/output"
    shutil.copytree(stranger, elsewhere)
    before = contents(elsewhere)
    home = contents(work / "home")
    start = [host, scene, "--restart", work / "home/checkpoint.h5"]
    how = {"capture_output": True, "text": True, "env": environment, "cwd": work / "start"}
    done = subprocess.run([*start, "--check"], **how)
    check("check of a checkpoint", done.returncode == 0 and "checkpoint.h5 fits: stage" in done.stdout.splitlines()[-1]
          and "linear solves" not in done.stdout and contents(work / "home") == home, done.stdout + done.stderr)

    # Counters and lengths beyond 32 bits: a file with a hole is long and takes no room.
    long = work / "long"
    shutil.copytree(half, long)
    altered(lambda f: f["rate_evaluations"].__setitem__(0, 2.0*FAR))
    done = run(scene, long, "--verbose", "--restart", bad)
    told = re.search(r" (\d+) rate evaluations", done.stdout)
    check("counter beyond 32 bits", done.returncode == 0 and told and int(told[1]) > 2*FAR, done.stdout + done.stderr)
    altered(lambda f: f["histories_bytes"].__setitem__(0, float(FAR)))
    done = run(scene, long, "--check", "--restart", bad)
    check("length beyond 32 bits: too short", done.returncode == 17
          and "histories.csv is missing, shorter" in done.stderr, done.stderr)
    os.truncate(long / "histories.csv", FAR + 100)
    done = run(scene, long, "--check", "--restart", bad)
    check("length beyond 32 bits: long enough", done.returncode == 0 and " fits: stage" in done.stdout, done.stderr)

    # Rows follow what is kept.
    done = run(scene, long, "--quiet", "--restart", bad)
    rows = len((half / "histories.csv").read_bytes())
    check("length beyond 32 bits: rows follow", done.returncode == 0 and 0 <
          (long / "histories.csv").stat().st_size - FAR < rows, done.stderr)
    shutil.rmtree(long)
    refused("of a strange folder, to be checked", stranger, "holds another run", "--output", stranger, "--check")
    done = subprocess.run([*start, "--quiet"], **how)
    check("restart without --output", done.returncode == 0 and not differences(whole, work / "home"),
          done.stderr + str(differences(whole, work / "home")))
    check("restart without --output: default folder untouched", contents(elsewhere) == before)

    # A file that the scene names counts as much as the scene.
    copy = work / "sand.nml"
    copy.write_text((root / "drivers/materials/toyoura.nml").read_text())
    scene.write_text(re.sub(r"file = '.*toyoura.nml'", "file = 'sand.nml'", text))
    done = run(scene, half, "--quiet", "--restart", keep)
    check("other material file", done.returncode == 17 and "&mud in line " in done.stderr, done.stderr)
    scene.write_text(text)

    full = work / "full"
    for left_over in full.glob("*.part"):
        left_over.unlink()
    assert len(raw()) > 20000
    scene.write_text(text.replace("checkpoint_steps = 2", "checkpoint_steps = 1"))   # before the next fields are due
    done = run(scene, full, "--quiet", "--restart", full / "checkpoint.h5", preexec_fn=small_disk, env=NO_LEAKS)
    scene.write_text(text)
    check("full disk: exit code", done.returncode == 4, f"{done.returncode}: {done.stderr}")
    check(
    "full disk: sentence",
    "checkpoint.h5 cannot be written" in done.stderr and len(
        done.stderr.splitlines()) == 1,
         done.stderr)
    check("full disk: last good one kept", (full / "checkpoint.h5").read_bytes() == raw())
    check("full disk: no rest", not list(full.glob("*.part")))
    done = run(scene, full, "--quiet", "--restart", full / "checkpoint.h5")
    check("after a full disk: same bytes", done.returncode == 0 and not differences(whole, full),
          done.stderr + str(differences(whole, full)))

    # A table on a device that is always full, and nothing else: the run says which. All effects are derived, so that
    # their table is written too.
    short = re.sub(r"duration = .*", "duration = 2.0e-3", text.replace("checkpoint_steps = 2\n", "\n"))
    scene.write_text(short)
    touch_short = work / "touch_short.nml"
    touch_short.write_text(re.sub(r"duration = .*", "duration = 1.0e-4", plate))
    for name, which in (
        ("histories.csv", scene),
        ("ledger.csv", scene),
        ("nodes_rest.csv", scene),
        ("points_rest.csv", scene),
        ("contact.csv", touch_short),
        ("contact_impact.csv", touch_short)):
        out = work / f"full_{name}"
        out.mkdir()
        (out / name).symlink_to("/dev/full")
        done = run(which, out, "--quiet")
        told = f"{name} cannot be written; is the disk full?" in done.stderr and len(done.stderr.splitlines()) == 1
        check(f"full disk under {name}", done.returncode == 4 and told, f"{done.returncode}: {done.stderr}")

    # At a checkpoint it shows at once, not at the end.
    scene.write_text(text)
    out = work / "full_at_checkpoint"
    out.mkdir()
    (out / "ledger.csv").symlink_to("/dev/full")
    done = run(scene, out, "--quiet")
    check("full disk at a checkpoint", done.returncode == 4 and "ledger.csv cannot" in done.stderr
          and not (out / "checkpoint.h5").exists(), done.stderr)

    # Every dataset says its unit and what it is.
    for path in sorted(whole.glob("*.h5")):
        with h5py.File(path) as file:
            sets = []
            file.visititems(lambda name, item: sets.append(item) if isinstance(item, h5py.Dataset) else None)
            told = all(item.attrs.get("unit") and item.attrs.get("description") for item in sets)
            check(f"{path.name}: units and descriptions", sets and told)
    # Fields that an earlier, longer run left behind are not of this one.
    (whole / "fields_999999.h5").write_bytes(b"of another run")
    done = subprocess.run([*plot, "--times", "0", "1e9", "--deformed", "10", "--output", work / "pictures"],
                          capture_output=True, text=True)
    check("picture without the fields of an earlier run", done.returncode == 0, done.stderr)
    for name in ("fields.png", "histories.png"):
        path = work / "pictures" / name
        check(f"picture {name}", path.exists() and path.read_bytes().startswith(
            b"\x89PNG") and path.stat().st_size > 10000, done.stderr)
    (whole / "fields_999999.h5").unlink()
    done = subprocess.run([*plot, "--fields", "p_x"], capture_output=True, text=True)
    check("picture of no field", done.returncode == 1 and "no field p_x" in done.stderr, done.stderr)
    done = subprocess.run([*plot, "--window", "7", "8", "--fields", "p_w"], capture_output=True, text=True)
    check("picture of no time", done.returncode == 1 and "no history between" in done.stderr, done.stderr)
    done = subprocess.run([*plot[:2], one, "--window", "2", "3", "--fields", "p_w"], capture_output=True, text=True)
    check("picture beside a plate", done.returncode == 0 and (one / "fields.png").exists(), done.stderr)
    done = subprocess.run([*plot[:2], work], capture_output=True, text=True)
    check("picture of no run", done.returncode == 1 and "no fields of mud_host" in done.stderr, done.stderr)


def test_labels_of_a_tall_mesh_stand_inside_the_picture():
    block = (root / "host/README.md").read_text().split("<!-- first scene -->")[1].split("```")[1]
    tall = work / "tall.nml"
    tall.write_text(block.replace("z = 0, 1  z_cells = 4", "z = 0, 6  z_cells = 24"))
    done = run(tall, work / "tall", "--quiet")
    check("a column runs", done.returncode == 0, done.stderr)
    done = subprocess.run([*plot[:2], work / "tall"], capture_output=True, text=True)
    check("its picture", done.returncode == 0, done.stderr)
    pixels = plt.imread(work / "tall/fields.png")[:, :, :3]
    check("nothing is cut off at its sides", np.all(pixels[:, :3] == 1) and np.all(pixels[:, -3:] == 1))


def test_400_points():
    # A row is as long as it must be: 400 points.
    block = (root / "host/README.md").read_text().split("<!-- first scene -->")[1].split("```")[1]
    many = work / "many.nml"
    many.write_text(block + "".join(f"&point name = 'p{k}' r = {k/400} z = {k/800} /\n" for k in range(400)))
    done = run(many, work / "many", "--quiet")
    check("400 points", done.returncode == 0, done.stderr)
    if done.returncode == 0:
        rows = tables.numbers(work / "many/histories.csv")   # which refuses a row that is shorter than the first
        check("400 points: columns", len(rows) == 2 and len(rows[0]) == 1 + 14*401, [len(row) for row in rows])

    # A folder is made with those above it, whatever its name holds.
    odd = work / "it's; a $HOME/of `results`/"
    done = run(many, odd, "--quiet")
    check("odd folder", done.returncode == 0 and (odd / "ledger.csv").exists(), done.stderr)


def test_no_folder():
    # A folder that nothing can be written to, from the first file on.
    done = run(scene, "/proc/nowhere", "--quiet")
    check("no folder", done.returncode == 4, done.stderr)


def test_xdmf_6_node_triangles():
    # results.xdmf as a reader of that format sees it: times, connections and coordinates, fields by name and unit.
    with meshio.xdmf.TimeSeriesReader(whole / "results.xdmf") as series:
        points, cells = series.read_points_cells()
        frames = [series.read_data(k) for k in range(series.num_steps)]
    check("xdmf: 6-node triangles", [c.type for c in cells] == ["triangle6"] and cells[0].data.shape == (4, 6))
    nodes = np.stack([*tables.columns(whole / "nodes_pulse.csv").values()], axis=1)
    check("xdmf: coordinates", np.array_equal(points, nodes[:, :2]))
    corner = points[cells[0].data]
    check("xdmf: middles of sides", np.allclose(corner[:, 3:], (corner[:, :3] + corner[:, [1, 2, 0]])/2, atol=1e-15))
    last_time, at_nodes, in_cells = frames[-1]
    for name, columns in (("displacement [m]", nodes[:, 2:4]), ("velocity [m/s]", nodes[:, 6:8])):
        check(f"xdmf: {name}", np.array_equal(at_nodes[name][:, :2], columns) and not at_nodes[name][:, 2].any())
    for name, column in (("p_w [kPa]", 4), ("p_c [kPa]", 5)):
        check(f"xdmf: {name}", np.array_equal(at_nodes[name], nodes[:, column]))
    check("xdmf: p_a", np.array_equal(at_nodes["p_a [kPa]"], at_nodes["p_w [kPa]"] + at_nodes["p_c [kPa]"]))
    gauss = np.stack([*tables.columns(whole / "points_pulse.csv").values()], axis=1).reshape(4, 3, 9)
    mean = (gauss*gauss[:, :, 2:3]).sum(1)/gauss[:, :, 2].sum(1)[:, None]

    # A mean of three numbers of one sign: a few roundings.
    for name, values in (("s_rr [kPa]", mean[:, 3]), ("s_zz [kPa]", mean[:, 4]), ("s_tt [kPa]", mean[:, 5]),
                         ("e [-]", mean[:, 7]), ("S_w [-]", mean[:, 8]), ("p [kPa]", -mean[:, 3:6].sum(1)/3)):
        check(f"xdmf: {name}", np.allclose(in_cells[name][0], values, rtol=1e-14, atol=0), in_cells[name][0] - values)
    deviator = mean[:, 3:6] - mean[:, 3:6].mean(1)[:, None]
    q = np.sqrt(1.5*(deviator**2).sum(1) + 3*mean[:, 6]**2)
    check("xdmf: q", np.allclose(in_cells["q [kPa]"][0], q, rtol=1e-13, atol=0), in_cells["q [kPa]"][0] - q)

    # The frames are those that the stages ask for: the start, every so many steps, and the ends.
    ledger = tables.columns(whole / "ledger.csv")
    wanted = [0.0]
    for number, every in ((1, 7), (2, 10)):
        times = ledger["time"][ledger["stage"] == number]
        wanted += [t for i, t in enumerate(times, 1) if i % every == 0 and i < len(times)] + [times[-1]]
    check("xdmf: times", [t for t, _, _ in frames] == wanted, f"{[t for t, _, _ in frames]} {wanted}")

    # What a run tells at its end: phases that add up, counters of the ledger.
    done = run(scene, work / "told", "--verbose")
    seconds = [float(s) for s in re.findall(r"^ +[A-Za-z ]+? +(\d+\.\d{3}) s", done.stdout, re.MULTILINE)]
    check("account: phases add up", len(seconds) == 9 and abs(
        sum(seconds[:-1]) - seconds[-1]) < 9*0.0005 + 1e-9, seconds)
    steps = len(ledger["time"])
    check("account: counters", f"{steps} steps" in done.stdout, done.stdout)
    for phase in ("material", "assembly", "contact", "factorisation", "solution", "output"):
        check(f"account: {phase}", re.search(rf"^ +{phase} ", done.stdout, re.MULTILINE), done.stdout)

    # On a terminal a line in place says how far the run is.
    shown = on_a_terminal(host, scene, "--output", work / "told")
    if shown is None:
        print("no pseudo-terminals on this machine: the progress line was not looked at")
    else:
        check("progress line", re.search(rb"\rStage \w+: step \d+, time \S+ s, \d+ %; about \d+ s left", shown), shown)


def test_failing_steps_are_shown():
    # A step that is tried again is shown: a strain of 1.2 in one step is refused and cut once.
    squeezed = work / "squeezed.nml"
    squeezed.write_text("""&scene name = 'squeezed' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&elastic name = 'm' young = 1e4 poisson = 0 /
&region material = 'm' rho_s = 2 void_ratio = 0 /
&stage name = 'squeeze' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' value = 1.2 /
&history name = 'h' times = 0, 1 values = 0, 1 /
""".replace("value = 1.2", "value = 1.2 history = 'h'"))
    shown = on_a_terminal(host, squeezed, "--output", work / "squeezed")
    if shown is not None:
        check("failing steps are shown", b"\rStage squeeze, time 0 s: a step of 1 s is repeated, cuts 1" in shown,
              shown)


def test_fields_of_controlled_steps():
    # Controlled steps write fields at fifty times of a stage, near enough for a film; keys say otherwise. points.csv: a
    # node of the mesh, and a quadrature point within the cell beside it.
    film = work / "film.nml"
    swing = """&scene name = 'film' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = -4, 0 z_cells = 4 /
&elastic name = 'm' young = 2e4 poisson = 0.25 /
&region material = 'm' rho_s = 2 void_ratio = 0 /
&history name = 'v' times = 0, 0.2, 2 values = 0, 1, 0 /
&stage name = 's' analysis = 'dynamic' duration = 2 {more} /
&tie first = 'left' second = 'right' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'bottom' field = 'u_r' /
&load group = 'top' kind = 'shear_r' value = 5 history = 'v' /
&point name = 'corner' r = 1 z = 0 /
"""
    for more, least, most in (("", 45, 53), ("fields = 0", 2, 3), ("output_dt = 0.5", 5, 6)):
        film.write_text(swing.format(more=more))
        done = run(film, work / "film", "--quiet")
        times = (work / "film/results.xdmf").read_text().count("<Time ") if done.returncode == 0 else done.stderr
        check(f"fields of controlled steps, {more or 'no key'}",
              done.returncode == 0 and least <= times <= most, times)
    film.write_text(swing.format(more=""))
    run(film, work / "film", "--quiet")
    place = tables.rows(work / "film/points.csv")[0]
    at = [float(place[name]) for name in ("r", "z", "stress_r", "stress_z")]
    check("points.csv", place["name"] == "corner" and at[:2] == [1.0, 0.0] and 0 < 1 - at[2] < 0.5 and 0 < -at[3] < 0.5,
          place)
