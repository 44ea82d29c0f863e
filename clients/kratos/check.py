# SPDX-License-Identifier: MIT
"""Kratos GeoMechanics: a cube, a ring and a plane by UMAT and by UDSM."""
import csv
import json
import pathlib
import subprocess

import cases
import clients
import project
import references

here = pathlib.Path(__file__).parent
PACKAGES = ["KratosGeoMechanicsApplication==10.4.4", "KratosLinearSolversApplication==10.4.4"]
KRATOS_3D = (0, 1, 2, 3, 5, 4)  # xx, yy, zz, xy, yz, xz
KRATOS_2D = (0, 1, 2, 3)
# Held stress: Kratos stops where displacements move by 1e-10 of themselves, mud_triax at 1e-10 of the stress.
HELD = 1e-7
python = clients.venv("kratos", PACKAGES)


def analysis(name, law, dimension, mesh, table, pressure, imposed, **presets):
    """Stresses of every step; the folder stays for the reader."""
    folder = clients.work_folder(f"kratos/{name}")
    text = (here / mesh).read_text()
    if name.startswith("plane"):
        text = text.replace("UPwSmallStrainAxisymmetricElement", "UPwSmallStrainElement").replace("Axisymmetric", "")
    (folder / mesh).write_text(text)
    steps = len(table["eps_a"]) - 1
    order = {"shear_order": 1} if law == "SmallStrainUMAT3DLaw" else {}
    state = clients.statev(void_ratio=table["e"][0], **presets)
    project.write(folder, "MaterialParameters.json",
                  project.material(law, clients.library_file, clients.props(**order), state, True))
    constraints, parts = [project.dry()], ["Soil"]
    if not imposed:
        faces = "XYZ"[:dimension]
        constraints += [project.constraint(f"Face_{c.lower()}", c) for c in faces]
        constraints.append(project.constraint("Top", faces[-1], 1))
        parts += [f"Face_{c.lower()}" for c in faces] + ["Top", "Cell"]
    components = 6 if dimension == 3 else 4
    loads = [project.start([-pressure]*3 + [0.0]*(components - 3))]
    if not imposed:
        loads.append(project.cell_pressure(dimension, pressure))
    project.write(folder, "ProjectParameters.json",
                  project.project(dimension, mesh.removesuffix(".mdpa"), steps, constraints, loads, parts))
    command = [python, here / "run.py"]
    if imposed:
        with open(folder / "strains.csv", "w") as file:
            csv.writer(file).writerows([repr(x) for x in row] for row in clients.strains(table)[1:])
        command.append("strains.csv")
    if clients.run(command, folder / "log.txt", cwd=folder, timeout=600) != 0:
        return []
    with open(folder / "stress.csv") as file:
        return [[float(x) for x in row] for row in csv.reader(file)]


def in_triaxial_axes(rows, axis):
    """(axial, radial) stress, compression positive."""
    return [[-row[axis], -row[0]] for row in rows]


told = json.loads(clients.describe("kratos"))["properties"][0]["Material"]["Variables"]
clients.verdict(told["UMAT_PARAMETERS"] == clients.props(shear_order=1) and told["STATE_VARIABLES"] == clients.statev()
                and told["IS_FORTRAN_UDSM"], "mud_describe kratos tells the parameters that follow",
                f"{len(told['UMAT_PARAMETERS'])} parameters, {len(told['STATE_VARIABLES'])} state variables")
for interface in ("UMAT", "UDSM"):
    solid, flat = f"SmallStrain{interface}3DLaw", f"SmallStrain{interface}2DPlaneStrainLaw"
    tag = interface.lower()
    table = clients.expected("triaxial")
    start, wanted = table["p_eff"][0], list(zip(table["sigma_a"][1:], table["sigma_r"][1:]))
    rows = analysis(f"triaxial_3d_{tag}", solid, 3, "cube.mdpa", table, start, False)
    clients.compare(f"triaxial with unloading, cube, {interface}", in_triaxial_axes(rows, 2), wanted, HELD)
    rows = analysis(f"triaxial_2d_{tag}", flat, 2, "ring.mdpa", table, start, False)
    clients.compare(f"triaxial with unloading, ring, {interface}", in_triaxial_axes(rows, 1), wanted, HELD)
    table = clients.expected("shear")
    rows = analysis(f"shear_{tag}", solid, 3, "cube.mdpa", table, start, True)
    clients.compare(f"three shear components, reversed, cube, {interface}", rows, clients.stresses(table)[1:],
                    places=KRATOS_3D)
    table = clients.expected("plane")
    rows = analysis(f"plane_{tag}", flat, 2, "ring.mdpa", table, start, True)
    clients.compare(f"plane strain with shear, reversed, {interface}", rows, clients.stresses(table)[1:],
                    places=KRATOS_2D)
table = clients.expected("shear_suction")
rows = analysis("shear_suction", "SmallStrainUMAT3DLaw", 3, "cube.mdpa", table, start, True,
                suction=table["suction"][0])
clients.compare("shear at a suction preset in STATE_VARIABLES, UMAT", rows, clients.stresses(table)[1:],
                places=KRATOS_3D)


def column(cells):
    """Settlement of the top under a pulse at every step: 1333 steps, dry, dynamic."""
    folder = clients.work_folder(f"kratos/column_{cells}")
    (folder / "column.mdpa").write_text(project.column_mesh(cells))
    project.write(folder, "MaterialParameters.json",
                  project.material("SmallStrainUMAT2DPlaneStrainLaw", clients.library_file, clients.props(),
                                   clients.statev(void_ratio=0.8), True))
    constraints = [project.dry(), project.constraint("Sides", "X"), project.constraint("Bottom", "Y")]
    loads = [project.start([-100.0]*3 + [0.0]), project.cell_pressure(2, 100.0, 1)]
    content = project.project(2, "column", STEPS, constraints, loads, ["Soil", "Sides", "Bottom", "Cell"])
    project.write(folder, "ProjectParameters.json", project.dynamic(content, STEP, STEPS*STEP))
    if clients.run([python, here / "run.py", "--top"], folder / "log.txt", cwd=folder, timeout=1500) != 0:
        return []
    with open(folder / "stress.csv") as file:
        return [float(row[0]) for row in csv.reader(file)]


def host_column(cells):
    folder = clients.work_folder(f"kratos/host_{cells}")
    (folder / "column.nml").write_text((here / "column.nml").read_text().replace("@CELLS@", str(cells)))
    command = [clients.build / "host/mud_host", "column.nml", "--output", "out", "--quiet"]
    if clients.run(command, folder / "log.txt", cwd=folder, timeout=1500) != 0:
        return []
    with open(folder / "out/histories.csv") as file:
        return [float(row["top.u_z"]) for row in csv.DictReader(file)][1:]


# The dynamic column. Both programs take the average acceleration, so that only the elements differ: what halving them
# moves either program is allowed.
STEPS, STEP = 1333, 2e-5
lists = coarse, fine, own_coarse, own_fine = column(10), column(20), host_column(10), host_column(20)
if any(len(rows) != STEPS for rows in lists):
    clients.verdict(False, "dynamic column, 1333 steps", f"steps {[len(rows) for rows in lists]}")
else:
    scale = max(abs(x) for x in own_fine)
    theirs, ours, apart = (max(abs(a - b) for a, b in zip(*pair))/scale
                           for pair in ((coarse, fine), (own_coarse, own_fine), (fine, own_fine)))
    clients.verdict(apart <= theirs + ours, "dynamic column against mud_host, 1333 steps",
                    f"apart {apart:.1e} of {scale:.4g}, allowed {theirs:.1e} (Kratos) + {ours:.1e} (mud_host)")


def refused(law):
    """Every node is prescribed and K_0 is negative: exit code, standard error and rows of stress."""
    folder = clients.work_folder(f"kratos/refused_{law}")
    (folder / "cube.mdpa").write_text((here / "cube.mdpa").read_text())
    (folder / "stress.csv").unlink(missing_ok=True)
    project.write(folder, "MaterialParameters.json", project.material(
        law, clients.library_file, clients.props(K_0=-1.0), clients.statev(), True))
    project.write(folder, "ProjectParameters.json", project.project(
        3, "cube", 5, [project.dry()], [project.start([-100.0]*3 + [0.0]*3)], ["Soil"]))
    (folder / "strains.csv").write_text("-1e-4,5e-5,5e-5,0,0,0\n"*5)
    done = subprocess.run([python, here / "run.py", "strains.csv"], cwd=folder, capture_output=True, text=True,
                          timeout=600)
    return done.returncode, done.stderr


code, told = refused("SmallStrainUMAT3DLaw")
last = told.strip().splitlines()[-1:]
clients.verdict("parameter K_0 (PROPS 1) is -1" in told and last and last[0].startswith("MUD: at the end of this"),
                "a refused parameter with every node prescribed, UMAT: the first and the last message tell it",
                f"exit code {code}")
code, told = refused("SmallStrainUDSM3DLaw")
clients.verdict("parameter K_0 (PROPS 1) is -1" in told and code != 0, "the same, UDSM: Kratos stops",
                f"exit code {code}")

# The start: ground with weight under K_0 stress, and a surcharge that grows.
K_0, SURCHARGE, ADDED = 0.5, 10.0, 40.0
folder = clients.work_folder("kratos/ground")
growing = [(0.0, SURCHARGE), (1.0, SURCHARGE), (21.0, SURCHARGE + ADDED)]
(folder / "column.mdpa").write_text(project.column_mesh(4, growing))
project.write(folder, "MaterialParameters.json", project.material(
    "SmallStrainUMAT2DPlaneStrainLaw", clients.library_file, clients.props(), clients.statev(void_ratio=0.8), True))
content = project.project(
    2, "column", 21, [project.dry(), project.constraint("Sides", "X"), project.constraint("Bottom", "Y")],
    [project.cell_pressure(2, SURCHARGE, 1)], ["Soil", "Sides", "Bottom", "Cell"])
# Of nothing a share of 1e-10 is never reached; the water's 1e-9 Mg/m3 move the ground by 1e-13 m.
content["solver_settings"]["displacement_absolute_tolerance"] = 1e-12
project.write(folder, "ProjectParameters.json", content)
code = clients.run([python, here / "run.py", "--ground", repr(2.65/1.8*9.81), repr(K_0), repr(SURCHARGE)],
                   folder / "log.txt", cwd=folder, timeout=600)
if code == 0:
    with open(folder / "stress.csv") as file:
        rows = [[float(x) for x in row] for row in csv.reader(file)]
    clients.verdict(rows[0][4] == 1 and rows[0][5] <= 1e-8, "ground under K_0 stress rests in one iteration",
                    f"{rows[0][4]:.0f} iterations, displacement {rows[0][5]:.1e} m")
    table = clients.expected("ground", sigma_a=-rows[0][1], sigma_r=-rows[0][0], sigma_a_end=-rows[-1][1])
    clients.compare("and its horizontal stress follows the surcharge as in mud_triax", [[rows[-1][0]]],
                    [[-table["sigma_r"][-1]]], 2e-4)
else:
    clients.verdict(False, "ground under K_0 stress", f"exit code {code}")
cases.check("kratos", PACKAGES[0], lambda case, divided: references.run(python, case, divided), references.FINER)
clients.finish()
