# SPDX-License-Identifier: MIT
"""mud3d, FEniCSx, PETSc and MPI: points against mud_triax, derivatives, closed forms, scenes against mud_host, ranks,
restart, steps, multigrid, refusals. check.py WORD... runs the parts whose names begin with a word.

Writes the numbers of the runs to results.json in its work folder."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import clients

import closed
import footing

here = pathlib.Path(__file__).parent
PYTHON = "/usr/bin/python3"  # Debian's packages belong to Debian's Python
RANKS = 1e-7   # of histories, relative to their largest value: Newton's tolerance of these runs is 1e-8
HOST = 0.01    # of the range of a history, against mud_host
clients.debian(["python3-dolfinx", "openmpi-bin"])
folder = clients.work_folder("fenicsx")
package = clients.python_package
environment = {**os.environ, **package, "PYTHONPATH": f"{package['PYTHONPATH']}:{here}", "OMP_NUM_THREADS": "1",
               "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1"}  # a waiting rank leaves its core to others
numbers = {}


def launch(name, command, ranks=1, refused=False):
    before = ["mpirun", "-n", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    command = [*before, PYTHON, *command]
    if refused:  # a failure is what is expected: its log is read, not shown
        with open(folder/f"{name}.log", "w") as log:
            return subprocess.run(command, stdout=log, stderr=log, cwd=folder, env=environment, timeout=3000).returncode
    return clients.run(command, folder/f"{name}.log", cwd=folder, env=environment, timeout=3000)


def program(name, script, *arguments):
    """What a program wrote to its result file, or None."""
    result = folder/f"{name}.json"
    result.unlink(missing_ok=True)
    code = launch(name, [here/script, *arguments, "--result", result])
    return json.loads(result.read_text()) if code == 0 else None


def table(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name.strip(): [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def solid(name, scene, *arguments, ranks=1):
    """Histories of a run of mud3d, or None. scene: a path, or its text."""
    path = _scene(name, scene)
    shutil.rmtree(folder/name, ignore_errors=True)
    code = launch(name, ["-m", "mud3d", path, "--output", name, *arguments], ranks)
    if code != 0:
        return None
    numbers[name] = json.loads((folder/name/"run.json").read_text())
    return table(folder/name/"histories.csv")


def host(name, scene):
    path = _scene(name, scene)
    shutil.rmtree(folder/name, ignore_errors=True)
    command = [clients.build/"host/mud_host", path, "--output", name, "--quiet"]
    code = clients.run(command, folder/f"{name}.log", cwd=folder, timeout=900)
    return table(folder/name/"histories.csv") if code in (0, 20) else None


def _scene(name, scene):
    if isinstance(scene, pathlib.Path):
        return scene
    (folder/f"{name}.nml").write_text(scene)
    return folder/f"{name}.nml"


def text(path, *changes):
    """A scene with other words, and its files by their full names."""
    scene = re.sub(r"file = '([^']*)'", lambda m: f"file = '{(path.parent/m[1]).resolve()}'", path.read_text())
    for old, new in changes:
        if old not in scene:
            sys.exit(f"{path}: {old} is not there")
        scene = scene.replace(old, new)
    return scene


def at(times, values, time):
    """Linear between two rows."""
    for i in range(1, len(times)):
        if times[i] >= time:
            share = (time - times[i - 1])/(times[i] - times[i - 1])
            return values[i - 1] + share*(values[i] - values[i - 1])
    return values[-1]


def near(what, got, wanted, columns, allowed, from_time=0.0):
    """Largest difference of histories over the range of the wanted one."""
    if got is None or wanted is None:
        return clients.verdict(False, what, "a run did not come to its end")
    for column in columns:
        size = max(wanted[column]) - min(wanted[column])
        times = [t for t in got["time"] if from_time <= t <= wanted["time"][-1]]
        apart = max(abs(at(got["time"], got[column], t) - at(wanted["time"], wanted[column], t)) for t in times)
        numbers[f"{what}: {column}"] = apart/size
        clients.verdict(apart <= allowed*size and size > 0.0, f"{what}: {column}",
                        f"apart {apart/size:.1e} of its range {size:.4g}, allowed {allowed:.0e}")


def same(what, got, wanted, allowed=RANKS):
    if got is None or wanted is None or len(got["time"]) != len(wanted["time"]):
        return clients.verdict(False, what, "a run did not come to its end, or took other steps")
    columns = [c for c in wanted if c != "time" and c.split(".")[-1][:2] in ("u_", "p_", "s_")]
    worst = 0.0
    for column in columns:
        kind = [c for c in columns if c.split(".")[-1][:2] == column.split(".")[-1][:2]]
        size = max(abs(x) for c in kind for x in wanted[c])
        worst = max(worst, max(abs(a - b) for a, b in zip(got[column], wanted[column]))/size if size else 0.0)
    numbers[what] = worst
    told = f"{len(columns)} histories, largest difference {worst:.1e}, allowed {allowed:.0e}"
    clients.verdict(worst <= allowed, what, told)


def points():
    """The batch call as the finite elements use it, on the strains and suctions of mud_triax."""
    for case, parameters in (("shear", {}), ("shear_suction", {}), ("wetting", {}), ("hysteresis", {"hysteresis": 1})):
        rows = clients.expected(case)
        path = folder/f"{case}.json"
        path.write_text(json.dumps({"strains": clients.strains(rows), "suction": rows["suction"],
                                    "void_ratio": rows["e"][0], "stress": -rows["p_eff"][0], "parameters": parameters}))
        answer = program(f"points_{case}", "points.py", path)
        clients.compare(f"batch call, {case}", answer["stress"] if answer else [], clients.stresses(rows)[1:])
        if parameters:
            clients.compare(f"its degree of saturation, {answer and answer['state_variables']} state variables",
                            [answer["saturation"] if answer else []], [rows["s_w"][1:]])


def blocks():
    """What the integration of stress leaves is all that differences may show."""
    told = program("blocks", "blocks.py", folder)
    worst = max((value, f"{state}: {block}") for state, found in told.items() for block, value in found.items()) \
        if told else (1.0, "")
    numbers["blocks"] = worst
    clients.verdict(worst[0] <= 2e-5, "every block of the derivatives of a point against differences",
                    f"{worst[0]:.1e} in {worst[1]}, allowed 2e-5")


def consolidation():
    """Terzaghi and Mandel: the scenes of mud_host in hexahedra; not in the first steps, when the load acts at once."""
    scene = clients.root/"verification/host/terzaghi/scene.nml"
    got = solid("terzaghi", text(scene, ("duration = 100", "duration = 40")), "--thickness", "0.1", "--no-fields")
    wanted = got and {"time": got["time"], "base.p_w": [closed.terzaghi(0.0, t) for t in got["time"]],
                      "middle.p_w": [closed.terzaghi(0.5, t) for t in got["time"]]}
    near("Terzaghi in three dimensions", got, wanted, ("base.p_w", "middle.p_w"), 3e-3, 0.1)
    scene = clients.root/"verification/studies/cost/scenes/mandel.nml"
    got = solid("mandel", text(scene, ("duration = 200", "duration = 60")), "--thickness", "0.2", "--no-fields")
    wanted = got and {"time": got["time"], "middle.p_w": [closed.mandel(0.0, t) for t in got["time"]]}
    near("Mandel in three dimensions, under a tied plate", got, wanted, ("middle.p_w",), HOST, 0.5)


def liakopoulos():
    scene = here/"scenes/liakopoulos.nml"
    got, wanted = solid("liakopoulos", scene, "--thickness", "0.1", "--no-fields"), host("liakopoulos_host", scene)
    near("Liakopoulos' column", got, wanted, ("top.u_z", "middle.u_z", "top.p_w", "middle.p_w"), HOST)


def layers():
    """MUD and an elastic region, each with its own water."""
    scene = here/"scenes/layers.nml"
    got, wanted = solid("layers", scene, "--thickness", "0.25", "--no-fields"), host("layers_host", scene)
    near("two materials under rain", got, wanted, ("top.u_z", "middle.u_z", "top.p_w", "middle.p_w"), HOST)


def gmsh():
    scene = here/"scenes/gmsh.nml"
    near("a mesh of Gmsh in the plane", solid("gmsh", scene, "--no-fields"), host("gmsh_host", scene),
         ("top.u_z", "base.p_w"), 1e-4)


def tagged():
    """A mesh of Gmsh in three dimensions: materials and sides by tags; the answer is that of a column in the plane."""
    scene = here/"scenes/tagged.nml"
    column = text(scene, ("geometry = 'box'", "geometry = 'plane_strain'"), ("group = 'lower'", "group = 'block_1_1'"),
                  ("group = 'upper'", "group = 'block_1_2'"), ("&fix group = 'front' field = 'u_y' /\n", ""),
                  ("&fix group = 'back' field = 'u_y' /\n", ""), (" y = 0 ", " "), (" y = 0.4 ", " "))
    column = re.sub(r"&mesh file = '[^']*'", "&mesh r = 0, 0.5 r_cells = 2 z = 0, 0.5, 1 z_cells = 10, 10", column)
    near("a mesh of Gmsh in three dimensions, two materials", solid("tagged", scene), host("tagged_host", column),
         ("top.u_z", "base.p_w"), HOST, 2.0)
    one = table(folder/"tagged/histories.csv") if (folder/"tagged/histories.csv").exists() else None
    same("the same on two ranks: histories", solid("tagged_two", scene, "--no-fields", ranks=2), one)


def plane():
    """Quadrilaterals in the plane."""
    scene = text(clients.root/"verification/host/terzaghi/scene.nml", ("duration = 100", "duration = 40"))
    got = solid("plane", scene, "--cells", "quadrilaterals", "--no-fields")
    wanted = got and {"time": got["time"], "base.p_w": [closed.terzaghi(0.0, t) for t in got["time"]]}
    near("Terzaghi in quadrilaterals in the plane", got, wanted, ("base.p_w",), 3e-3, 0.1)


def incoming():
    """A wave that comes in from damped layers' base."""
    scene = text(clients.root/"verification/host/layered_site/scene.nml", ("duration = 1.2", "duration = 0.6 dt = 2e-3"))
    got = solid("incoming", scene, "--thickness", "1", "--no-fields")
    near("a wave that comes in through an absorbing base", got, host("incoming_host", scene), ("surface.u_r",), HOST)


def waves():
    """A pulse that leaves through an absorbing base, and a column of MUD shaken between tied sides."""
    scene = text(clients.root/"verification/host/waves/column.nml", ("duration = 0.4", "duration = 0.2"))
    got, wanted = solid("wave", scene, "--thickness", "0.25", "--no-fields"), host("wave_host", scene)
    near("wave column", got, wanted, ("middle.u_r",), HOST)
    scene = text(clients.root/"verification/host/site/scene.nml", ("duration = 5.5", "duration = 2"))
    got, wanted = solid("shaken", scene, "--thickness", "0.1", "--no-fields"), host("shaken_host", scene)
    columns = [f"z{z:03d}.{c}" for z in range(0, 100, 10) for c in ("u_r", "p_w") if c == "u_r" or z]
    near("shaken column", got, wanted, columns, HOST)


def strip():
    scene = here/"scenes/strip.nml"
    got = solid("strip", scene, "--thickness", "0.25", "--cells", "tetrahedra", "--no-fields")
    near("strip", got, host("strip_host", scene), ("centre.u_z", "below.u_z", "below.p_w"), HOST)
    same("strip: points side by side", solid("strip_lanes", scene, "--thickness", "0.25", "--cells", "tetrahedra",
                                             "--no-fields", "--lanes"), got)


def indentation():
    # By its own tolerance, 1e-4, ranks differ by up to that where rounding decides what a point does in an iteration.
    scene = text(here/"scenes/indentation.nml", ("dt = 4.0e-4 tolerance = 1e-4", "dt = 4.0e-4 tolerance = 1e-8"))
    one = solid("indentation", scene, "--no-fields")
    near("indentation, sector of 5 degrees", one, host("indentation_host", scene),
         ("centre.u_z", "rim.u_z", "below.u_z"), HOST)
    two = solid("indentation_two", scene, "--no-fields", ranks=2)
    same("indentation: two ranks give the histories of one", two, one)


def ground():
    """The start: ground with weight under K_0 stress, then a surcharge."""
    g = clients.GROUND
    density = g["weight"]/9.81
    scene = f"""&scene name = 'ground' geometry = 'plane_strain' fields = 'u' gravity = 9.81 /
&mesh r = 0, 1 r_cells = 1 z = {-g["height"]!r}, 0 z_cells = 8 /
&mud name = 'sand' file = 'toyoura.nml' /
&region material = 'sand' void_ratio = 0.8 rho_s = {density*1.8!r} /
&initial stress = 'geostatic' k_0 = {g["k_0"]!r} surcharge = {g["surcharge"]!r} /
&history name = 'ramp' times = 1, 2 values = 0, 1 /
&stage name = 'rest' analysis = 'static' duration = 1 dt = 1 tolerance = 1e-8 /
&stage name = 'load' analysis = 'static' duration = 1 dt = {1.0/g["steps"]!r} tolerance = 1e-6 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top' kind = 'pressure' value = {g["surcharge"]!r} /
&load group = 'top' kind = 'pressure' value = {g["added"]!r} history = 'ramp' /
&point name = 'low' z = {-g["height"]!r} /
&point name = 'top' /
""".replace("file = 'toyoura.nml'", f"file = '{clients.root/'drivers/materials/toyoura.nml'}'")
    got = solid("ground", scene, "--thickness", "1", "--cells", "tetrahedra", "--no-fields")
    log = (folder/"ground.log").read_text()
    first = re.search(r"rest: time 1 s.* (\d+) iterations", log)
    clients.ground(got and {
        "first": {"iterations": int(first[1]), "moved": max(abs(got[c][0]) for c in got if ".u_" in c),
                  "stress": [got["low.s_rr"][0], got["low.s_zz"][0]]},
        "last": {"stress": [got["low.s_rr"][-1], got["low.s_zz"][-1]]}})


def ranks():
    small = footing.scene(3, steps=4, settlement=0.02)
    one = solid("one", small, "--no-fields")
    same("footing: two ranks give the histories of one", solid("two", small, ranks=2), one)
    fields = (folder/"two/results.xdmf").exists() and (folder/"two/results.h5").stat().st_size > 10000
    clients.verdict(fields, "fields for ParaView from two ranks", "results.xdmf, results.h5")
    solid("half", small, "--no-fields", "--stop-after", "2", "--checkpoint", "half.state")
    again = solid("again", small, "--no-fields", "--restart", "half.state")
    bits = again and one and (folder/"again/histories.csv").read_text().splitlines()[1:] == \
        (folder/"one/histories.csv").read_text().splitlines()[3:]
    clients.verdict(bool(bits), "a restart gives the bits of the whole run", "rows of histories.csv")
    later = one and {name: values[2:] for name, values in one.items()}
    same("a restart on two ranks gives its histories", solid("other", small, "--no-fields", "--restart", "half.state",
                                                             ranks=2), later)
    same("multigrid gives the histories of MUMPS", solid("multigrid", small, "--no-fields", "--linear", "amg"), one)
    same("the same on two ranks", solid("multigrid_two", small, "--no-fields", "--linear", "amg", ranks=2), one)
    deep = footing.scene(3, steps=1, settlement=1.5, scale=4.0, tolerance=1e-6)
    one, two = solid("deep", deep, "--no-fields"), solid("deep_two", deep, "--no-fields", ranks=2)
    cuts = [numbers.get(name, {}).get("cuts") for name in ("deep", "deep_two")]
    clients.verdict(one is not None and abs(one["centre.u_z"][-1] + 1.5) < 1e-9 and cuts[0],
                    "1.5 m in one step get through by cuts", f"{cuts[0]} cuts")
    clients.verdict(cuts[0] == cuts[1], "two ranks cut the same steps", f"{cuts} cuts")


def steps():
    """Steps by their error: within 1e-2 of the closed form, and the same ones on two ranks."""
    scene = text(clients.root/"verification/host/terzaghi/scene.nml", ("duration = 100", "duration = 40"),
                 ("dt = 1.0e-3", ""), ("dt_growth = 1.03", ""), ("dt_max = 1", ""), ("tolerance = 1.0e-8", ""),
                 ("name = 'terzaghi'", "name = 'terzaghi' step_tolerance = 1e-2"))
    one = solid("controlled", scene, "--thickness", "0.1", "--no-fields")
    wanted = one and {"time": one["time"], "base.p_w": [closed.terzaghi(0.0, t) for t in one["time"]]}
    near(f"Terzaghi by {one and len(one['time'])} steps of tolerance 1e-2", one, wanted, ("base.p_w",), 1e-2, 0.1)
    two = solid("controlled_two", scene, "--thickness", "0.1", "--no-fields", ranks=2)
    clients.verdict(bool(one and two) and len(one["time"]) == len(two["time"]) and
                    all(abs(a - b) <= 1e-6*b for a, b in zip(two["time"], one["time"])),
                    "two ranks choose the same steps", f"{one and len(one['time'])}, {two and len(two['time'])} steps")


def refusals():
    """What the physics cannot carry is refused with a sentence, on two ranks as on one."""
    small = footing.scene(3, steps=1)
    wet = small.replace("'u-p_w'", "'u-p_w-p_c'")
    for name, scene, words in (
            ("tension", footing.scene(3, steps=1, settlement=1.0, back=0.0, scale=4.0, tolerance=1e-6),
             "the pressure of the water falls to"),
            ("air", wet, "air that flows is not carried"),
            ("contact", small + "&contact name = 'c' slave = 'top' master = 'plate' /\n", "&contact is not carried"),
            ("key", small.replace("&scene ", "&scene seepage_inertia = 'yes' "), "seepage_inertia"),
            ("field", small.replace("field = 'u_y'", "field = 'rotation'"), "rotation")):
        for ranks in (1, 2):
            command = ["-m", "mud3d", _scene(f"refused_{name}", scene), "--output", f"refused_{name}", "--no-fields"]
            code = launch(f"refused_{name}", command, ranks, refused=True)
            log = (folder/f"refused_{name}.log").read_text()
            said = [line for line in log.splitlines() if line.startswith("mud3d: ")]
            clients.verdict(code in (2, 14) and any(words in line for line in said),
                            f"refused on {ranks} ranks: {name}", said[0][:140] if said else "no sentence")


def scaling():
    """Iterations of the multigrid: at most 40 at every size, for fast and slow loading, on one rank and on two."""
    result = folder/"scaling.json"
    result.unlink(missing_ok=True)
    wanted = [(cells, mesh, seconds, 1) for cells in (3, 6, 9, 12) for mesh in ("even", "graded")
              for seconds in ("0.001", "1", "100")]
    wanted += [(12, "graded", "1", 2), (15, "graded", "1", 1), (15, "graded", "1", 2)]
    for cells, mesh, seconds, ranks in wanted:
        command = [here/"scaling.py", str(cells), mesh, seconds, result]
        launch(f"scaling_{cells}_{mesh}_{seconds}_{ranks}", command, ranks)
    rows = [json.loads(line) for line in result.read_text().splitlines()]
    numbers["scaling"] = rows
    worst = max(row["iterations"] for row in rows)
    clients.verdict(len(rows) == len(wanted) and 0 < min(row["iterations"] for row in rows) and worst <= 40,
                    f"GMRES iterations at {rows[0]['unknowns']} to {rows[-1]['unknowns']} unknowns, three speeds",
                    f"at most {worst}, allowed 40")


parts = [points, blocks, consolidation, liakopoulos, layers, gmsh, tagged, plane, waves, incoming, strip, indentation,
         ground, ranks, steps, refusals, scaling]
words = sys.argv[1:]
for part in parts:
    if not words or any(part.__name__.startswith(word) for word in words):
        part()
(folder/"results.json").write_text(json.dumps({"library": clients.commit(), "runs": numbers}, indent=1) + "\n")
clients.finish()
