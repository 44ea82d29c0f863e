# SPDX-License-Identifier: MIT
"""Does a change of the host leave its answers alone, to the last bit?

    scripts/same_answers.py record FOLDER      runs the scenes below and keeps their files
    scripts/same_answers.py compare FOLDER     runs them again and compares

The program is build/release/host/mud_host, or the one under $MUD_BUILD_DIR; --program names another one, --only some
of the scenes. Tables count byte for byte, HDF5 files by the values of every dataset (a checkpoint without its
fingerprint, which is that of the scene's words). The scenes are short versions of those of the verification and
name everything that a default of the library could change. About a minute; exit code 1 where an answer moved. Files
and columns that the older program did not write are named, and are no answer that moved; of a checkpoint the entries
that both have are compared.
"""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np

root = pathlib.Path(__file__).resolve().parents[1]
sys.path.append(str(root / "common"))
import tables  # noqa: E402 (its folder is known only now)

build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")


def page(name):
    """Folder of a page of the verification."""
    places = [f"verification/{place}{name}/" for place in ("host/", "studies/", "host_")]
    return next(place for place in places if (root / place).exists())


INDENTATION, CONTACT = page("indentation") + "indent_s030.nml", page("contact")
SHORT = ("duration = 0.03999", "duration = 0.0012\n   fields = 20")
IMPACT = ("times = 2, 2.014, 2.028", "times = 2, 2.0004, 2.0008")   # so that contact is lost within the short run
RULE = ("toyoura.nml'", "toyoura.nml'\n   memory_rule = 1\n   rho_e = 0")
SATURATED = [("= 'u-p_w-p_c'", "= 'u-p_w'"),
             ("p_w = -30\n   p_c = 30", "p_w = 0\n   p_w_slope = -9.78057\n   surcharge = 0.5"),
             ("   field = 'p_w'\n   value = -30", "   field = 'p_w'"),
             ("&fix\n   group = 'top_2'\n   field = 'p_c'\n   value = 30\n/\n",
              "&load\n   group = 'top'\n   kind = 'pressure'\n   value = 0.5\n/\n")]
COLUMN = """&scene name = 'column' geometry = 'plane_strain' fields = 'u-p_w' without = 'inertia' /
&mesh r = 0, 0.1 r_cells = 1 z = 0, 1 z_cells = 10 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1.0e-10 law = 'constant' /
&region material = 'soil' void_ratio = 0.8 permeability = 'k' /
&history name = 'h' times = 0, 0.05 values = 0, 1 /
&stage name = 'load' analysis = 'dynamic' tolerance = 1.0e-8 duration = 0.1 dt = 0.002 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 10 history = 'h' /
&point name = 'top' r = 0 z = 1 /
&point name = 'base' r = 0 z = 0 /
"""
# Its second stage begins with accelerations of a force that is there at once, and of a base that is moved.
STRUCK = [(" without = 'inertia'", ""), ("times = 0, 0.05 values = 0, 1", "times = 0, 0.1 values = 1, 0.2"),
          ("analysis = 'dynamic'", "analysis = 'quasi_static'"),
          ("&fix group = 'left'", "&stage name = 'free' analysis = 'dynamic' tolerance = 1.0e-8 duration = 0.02 "
           "dt = 0.001 /\n&fix group = 'left'"),
          ("group = 'bottom' field = 'u_z' /", "group = 'bottom' field = 'u_z' value = 0.3 history = 'h' "
           "motion = 'acceleration' /\n&load group = 'top' kind = 'pressure' value = 4 stages = 'free' /")]

# Name: scene and pieces of its text that are replaced.
CASES = {
    "indentation_s0030": (INDENTATION, [SHORT, IMPACT]),
    "indentation_s0200": (INDENTATION, [SHORT, IMPACT, ("-30\n   p_c = 30", "-200\n   p_c = 200"),
                                        ("value = -30", "value = -200"),
                                        ("value = 30", "value = 200"), ("memory_rule = 1", "memory_rule = 0")]),
    "indentation_saturated": (INDENTATION, [SHORT, IMPACT, *SATURATED]),
    "indentation_tangent": (INDENTATION, [("duration = 0.03999", "duration = 0.0003"),
                                          ("tangent = 2", "tangent = 3"),
                                          ("gravity = 9.81", "gravity = 9.81\n   factors = 'fresh'"),
                                          ("gap = 'nodal'", "gap = 'pointwise'\n   drainage = 'state'")]),
    "terzaghi": (page("terzaghi") + "scene.nml", []),
    "liakopoulos": (page("liakopoulos") + "scene.nml", []),
    "cylinder": (page("cylinder") + "scene.nml", []),
    "vibration": (page("vibration") + "scene.nml", []),
    "seepage_inertia": (page("seepage_inertia") + "scene.nml", [("duration = 0.004", "duration = 0.0008")]),
    "dynamic_consolidation": (page("dynamic_consolidation") + "scene.nml", []),
    "patch_stress": (page("patch") + "stress.nml", []),
    "patch_flow": (page("patch") + "flow.nml", []),
    "geostatic": (page("patch") + "geostatic.nml", []),
    "element_suction": (page("element") + "suction.nml", [RULE, ("duration = 1.0e7", "duration = 1.0e6")]),
    "contact_fall": (CONTACT + "fall.nml", []),
    "contact_patch": (CONTACT + "patch.nml", []),
    "contact_split": (CONTACT + "split.nml", [("penalty = 1.0e6", "penalty = 1.0e6\n   gap = 'pointwise'")]),
    "contact_hertz": (CONTACT + "hertz.nml", []),
    "contact_drain": (CONTACT + "drain.nml", []),
    "contact_steel": (CONTACT + "steel.nml", [("duration = 0.04", "duration = 0.01")]),
    "contact_bar": (CONTACT + "bar.nml", [("duration = 1.5e-3", "duration = 1.0e-4")]),
    "restart": ("tests/host/scenes/restart.nml", [RULE]),
    "without": (COLUMN, []),
    "struck": (COLUMN, STRUCK),
}


def stage(source, text, scratch):
    """A scene's changed text in a folder of its own, where the paths that it names lead to what they lead to beside the
    original: nothing is written into the source tree."""
    place = scratch / source.parent.relative_to(root)
    place.mkdir(parents=True, exist_ok=True)
    for real, shown in ((source.parent, place), (root, scratch)):
        for entry in real.iterdir():
            if not (shown / entry.name).exists():
                (shown / entry.name).symlink_to(entry)
    copy = place / f"same_answers_{source.name}"
    copy.write_text(text, encoding="utf-8")
    return copy


def run(program, name, folder, scene):
    """A scene's files."""
    commands = [[program, scene, "--output", folder]]
    if name == "restart":
        commands.append([*commands[0], "--restart", folder / "checkpoint.h5"])
    for command in commands:
        done = subprocess.run(command, capture_output=True, text=True,
                              env={**os.environ, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive"})
        if done.returncode:
            sys.exit(f"{name} ended with {done.returncode}: {done.stderr}")
        if name == "restart" and len(commands) == 2 and command is commands[0]:
            shutil.copytree(folder, folder / "unbroken")


NO_ANSWERS = ("fingerprint", "groups", "origin")   # of a checkpoint


def datasets(path):
    """Every dataset of an HDF5 file by its path."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return {k: v for k, v in found.items() if not (path.name == "checkpoint.h5" and k in NO_ANSWERS)}


def apart(one, other):
    """In words how two files differ; empty if they do not."""
    if one.suffix == ".h5":
        a, b = datasets(one), datasets(other)
        if one.name == "checkpoint.h5":
            a = {k: v for k, v in a.items() if k in b}
        elif a.keys() != b.keys():
            return f"datasets {sorted(a.keys() ^ b.keys())}"
        moved = [k for k in a if np.asarray(a[k]).tobytes() != np.asarray(b[k]).tobytes()]
        return ", ".join(f"{k} {largest(a[k], b[k])}" for k in moved)
    if one.read_bytes() == other.read_bytes():
        return ""
    if one.suffix != ".csv":
        return "the text"
    if not set(tables.header(one)) <= set(tables.header(other)) or len(a := tables.rows(one)) != len(
            b := tables.rows(other)):
        return "columns or number of rows"
    pairs = {name: [[row[name] for row in table] for table in (a, b)] for name in tables.header(one)}
    return ", ".join(f"{name} {largest(*pair)}" for name, pair in pairs.items() if pair[0] != pair[1])


def largest(a, b):
    """Largest difference over the largest value of the first."""
    try:
        a, b = np.asarray(a, float), np.asarray(b, float)
        return f"by {np.max(np.abs(a - b)):.2g} of {np.max(np.abs(a)):.2g}"
    except ValueError:
        return "(no numbers)"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("record", "compare"))
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, default=build / "host/mud_host")
    parser.add_argument("--only", nargs="+", default=list(CASES), choices=list(CASES), metavar="SCENE")
    args = parser.parse_args()
    moved = 0
    with tempfile.TemporaryDirectory() as scratch:
        for name in args.only:
            source, changes = CASES[name]
            text = source if source.startswith("&") else (root / source).read_text(encoding="utf-8")
            for old, new in changes:
                if old not in text:
                    sys.exit(f"{name}: {source} has no text {old!r} to replace")
                text = text.replace(old, new)
            folder = pathlib.Path(scratch) / name
            beside = root / ("scene.nml" if source.startswith("&") else source)
            run(args.program, name, folder, stage(beside, text, pathlib.Path(scratch) / "tree" / name))
            kept = args.folder / name
            if args.what == "record":
                shutil.rmtree(kept, ignore_errors=True)
                shutil.copytree(folder, kept)
                print(f"{name}: {sum(1 for f in kept.rglob('*') if f.is_file())} files", flush=True)
                continue
            files = {str(f.relative_to(p)) for p in (kept, folder) for f in p.rglob("*") if f.is_file()}
            wrong, new = [], []
            for file in sorted(files):
                if not (kept / file).exists():
                    new.append(file)
                elif not (folder / file).exists():
                    wrong.append(f"{file}: gone")
                elif difference := apart(kept / file, folder / file):
                    wrong.append(f"{file}: {difference}")
            also = f", and new files: {', '.join(new)}" if new else ""
            print(f"{name}: {'same' if not wrong else 'MOVED'}{also}", *wrong[:8], sep="\n   ", flush=True)
            moved += bool(wrong)
    if args.what == "compare":
        print(f"{len(args.only) - moved} scenes the same, {moved} moved")
    return moved > 0


if __name__ == "__main__":
    sys.exit(main())
