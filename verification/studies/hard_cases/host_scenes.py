# SPDX-License-Identifier: MIT
"""Scenes of the hard cases of the host: small, coarse, a few seconds each."""
import random

from host_runs import load, rho, sand
from tools import gmsh

STRESSES = "p_w=-{s} p_c={s} stress='geostatic' k_0=0.4"
# The plate of the paper: radius 0.15 m, 11.1 kg, 6.5 kN. 32 elements.
PLATE_MESH = "&mesh r=0,0.15,2 r_cells=2,2 r_ratio=1,3 z=-2,-0.3,0 z_cells=2,2 z_ratio=0.4,0.7 /\n"
SIDES = "&fix group='left' field='u_r' /\n&fix group='right' field='u_r' /\n&fix group='bottom' field='u_z' /\n"


def impact(setting, suction=30, dt=3e-4, duration=0.04, pulse=0.028, penalty=None, k=5e-10, force=6.5, pressures='quadratic', friction=None, **material):
    """The paper's plate on soil at a suction, or on saturated soil (0): geostatic stage, seat, triangular pulse of `pulse` seconds."""
    wet = suction == 0
    rows = [f"&scene name='impact' fields='{'u-p_w' if wet else 'u-p_w-p_c'}' pressures='{pressures}' gravity=9.81 initial_flow='subtract' /\n", PLATE_MESH, sand(setting, **material),
            "&fluids k_w=2.25e6 rho_w=0.997 /\n", f"&permeability name='k' intrinsic={k} /\n",
            f"&region material='sand' {'' if wet else 'retention=' + chr(39) + 'material' + chr(39)} permeability='k' rho_s=2.7 void_ratio=0.8 /\n",
            "&initial stress='geostatic' k_0=0.4 " + ("p_w_slope=-9.78057 surcharge=0.2" if wet else f"p_w=-{suction} p_c={suction}") + " /\n",
            f"&history name='pulse' times=2,{2 + pulse / 2},{2 + pulse} values=0,1,0 /\n",
            f"&plate name='plate' r=0,0.15 mass=0.0111 weight='yes' force={load(setting, -force)} history='pulse' /\n",
            f"&contact name='c' slave='top' master='plate' stages='seat','impact' {f'penalty={penalty}' if penalty else ''} {f'friction={friction}' if friction else ''} /\n",
            "&stage name='rest' analysis='static' duration=1 dt=1 tolerance=1e-10 zero_displacements='yes' /\n",
            "&stage name='seat' analysis='static' duration=1 dt=1 tolerance=1e-8 max_iterations=100 /\n",
            f"&stage name='impact' analysis='dynamic' duration={duration} dt={dt} {rho(setting)} /\n",
            "&fix group='plate' field='u_z' hold='yes' stages='rest' /\n", SIDES, "&point name='centre' r=0 z=0 /\n"]
    if wet:
        rows.append("&load group='top' kind='pressure' value=0.2 /\n")
    else:   # saturated soil is sealed
        rows.append(f"&fix group='top_2' field='p_w' value={-suction} /\n&fix group='top_2' field='p_c' value={suction} /\n")
    return "".join(rows)


def tolerant(text):
    """The same scene, not stopped before a tenth of the largest work has come out of nothing."""
    return text.replace("analysis='dynamic'", "analysis='dynamic' created_energy=0.1")


def falling(setting, penalty=1e7, dt=1e-5, speed=0.05, duration=0.006):
    """A plate that falls on an elastic body."""
    return ("&scene name='fall' gravity=9.81 /\n&mesh r=0,0.15,0.5 r_cells=2,2 z=-0.5,0 z_cells=3 z_ratio=0.6 /\n"
            "&elastic name='soil' young=1e4 poisson=0.3 /\n&region material='soil' void_ratio=0.8 /\n&initial stress='geostatic' k_0=0.4 /\n"
            "&plate name='plate' r=0,0.15 z=1e-5 mass=0.0111 weight='yes' /\n"
            f"&contact name='c' slave='top' master='plate' penalty={penalty} /\n&initial group='plate' v_z={load(setting, -speed)} /\n"
            f"&stage name='fall' analysis='dynamic' duration={duration} dt={dt} {rho(setting)} tolerance=1e-6 /\n{SIDES}"
            "&point name='centre' r=0 z=0 /\n")


def column(setting, k, pressures, dt=1e-3, steps=1):
    """Elastic column of 1 m, drained on top, 100 kPa at once."""
    return (f"&scene name='column' geometry='plane_strain' fields='u-p_w' pressures='{pressures}' /\n&mesh r=0,0.25 r_cells=1 z=0,1 z_cells=8 /\n"
            f"&elastic name='soil' young=1e4 poisson=0.25 /\n&permeability name='k' intrinsic={k} law='constant' /\n"
            "&region material='soil' permeability='k' void_ratio=0.8 /\n"
            f"&stage name='load' analysis='quasi_static' duration={dt * steps} dt={dt} rho_inf=0 tolerance=1e-8 /\n{SIDES}"
            f"&fix group='top' field='p_w' /\n&load group='top' kind='pressure' value={load(setting, 100.0)} /\n&point name='base' r=0 z=0 /\n")


def showers(setting, dt=30):
    """Sand above a water table in showers of three times its conductivity: the surface ponds and dries again and again."""
    times = [300.0 * i + x for i in range(10) for x in (0.0, 0.1)]
    values = [x for i in range(10) for x in ((0, 1) if i % 2 == 0 else (1, 0))]
    return ("&scene name='showers' geometry='plane_strain' fields='u-p_w-p_c' pressures='linear' gravity=9.81 /\n"
            f"&mesh r=0,0.25 r_cells=1 z=-2,0 z_cells=10 z_ratio=0.8 /\n{sand(setting)}"
            "&permeability name='k' intrinsic=1e-11 /\n&region material='sand' retention='material' permeability='k' void_ratio=0.8 /\n"
            "&initial stress='geostatic' k_0=0.5 surcharge=2 p_w_slope=-9.81 p_c_slope=9.81 datum=-2 /\n"
            f"&history name='clouds' times={','.join(map(str, times))} values={','.join(map(str, values))} /\n"
            f"&stage name='rain' analysis='quasi_static' duration=3000 dt={dt} rho_inf=0 max_iterations=20 /\n{SIDES}"
            "&fix group='bottom' field='p_w' /\n&fix group='bottom' field='p_c' /\n&load group='top' kind='pressure' value=2 /\n"
            f"&load group='top' kind='rain' value={load(setting, 3e-4)} history='clouds' ponding=0.02 /\n&point name='centre' r=0 z=0 /\n")


LIFT = 0.5   # [m]
BANK = (-2, 0, LIFT, 2 * LIFT, 3 * LIFT)


def bank(setting):
    """Three layers of loose sand, without stress when they come, on two metres of it; then the uppermost two leave again."""
    stages = ["rest", "one", "two", "three", "cut"]
    present = ("'one','two','three','cut'", "'two','three'", "'three'")
    text = ("&scene name='bank' geometry='plane_strain' gravity=" + load(setting, 9.81) + " /\n"
            f"&mesh r=0,1,2 r_cells=1,1 z={','.join(map(str, BANK))} z_cells=2,1,1,1 /\n{sand(setting)}"
            "&region material='sand' drainage='dry' void_ratio=0.85 rho_s=2.7 /\n&initial group='block_1_1' stress='geostatic' k_0=0.5 surface=0 /\n"
            "&initial group='block_2_1' stress='geostatic' k_0=0.5 surface=0 /\n")
    for row, names in enumerate(present, 2):
        text += f"&region group='block_1_{row}' material='sand' drainage='dry' void_ratio=0.85 rho_s=2.7 stages={names} /\n"
        text += f"&region group='block_2_{row}' material='sand' drainage='dry' void_ratio=0.85 rho_s=2.7 stages={names} /\n"
    for name in stages:
        text += f"&stage name='{name}' analysis='static' duration=1 dt=0.25 max_iterations=20 " + ("zero_displacements='yes' /\n" if name == "rest" else "/\n")
    return text + SIDES + "&point name='centre' r=0 z=0 /\n"


def raft(setting, dt=2e-3):
    """A raft of 1.2 m that carries a slender mass, on dry sand, pushed at the height of its mass: it lifts off on one side, comes back and rocks."""
    return ("&scene name='raft' geometry='plane_strain' gravity=9.81 /\n"
            f"&mesh r=-2.4,-0.6,0.6,2.4 r_cells=3,4,3 r_ratio=0.7,1,1.4 z=-2,0 z_cells=4 z_ratio=0.7 /\n{sand(setting)}"
            "&region material='sand' drainage='dry' void_ratio=0.75 rho_s=2.7 /\n&initial stress='geostatic' k_0=0.5 surcharge=5 /\n"
            "&plate name='raft' motion='plane' r=-0.6,0.6 z=0 center=0,1.5 mass=3 inertia=2.4 weight='yes' "
            f"force_r={load(setting, 14.0)} history='push' /\n&history name='push' times=2,2.1,2.3,2.4 values=0,1,-1,0 /\n"
            "&contact name='c' slave='top' master='raft' friction=0.6 stages='seat','rock' /\n&load group='top' kind='pressure' value=5 /\n"
            "&stage name='rest' analysis='static' duration=1 dt=1 tolerance=1e-8 zero_displacements='yes' /\n"
            "&stage name='seat' analysis='static' duration=1 dt=0.25 max_iterations=50 /\n"
            f"&stage name='rock' analysis='dynamic' duration=1 dt={dt} {rho(setting)} max_iterations=30 /\n"
            "&fix group='raft' field='u_z' hold='yes' stages='rest' /\n&fix group='raft' field='u_r' hold='yes' stages='rest' /\n"
            f"&fix group='raft' field='rotation' hold='yes' stages='rest' /\n{SIDES}&fix group='bottom' field='u_r' /\n&point name='centre' r=0 z=0 /\n")


def drawdown(setting):
    """A bank of saturated loose sand whose water stood to its top; the water in front of it falls in a minute, and its face lets out what is left."""
    return ("&scene name='drawdown' geometry='plane_strain' fields='u-p_w-p_c' pressures='linear' gravity=9.81 /\n"
            f"&mesh r=0,3 r_cells=6 z=0,2 z_cells=6 /\n{sand(setting)}"
            "&permeability name='k' intrinsic=1e-11 /\n&region material='sand' retention='material' permeability='k' void_ratio=0.85 rho_s=2.7 /\n"
            "&initial stress='geostatic' k_0=0.5 surcharge=5 surface=2 p_w_slope=-9.81 datum=2 /\n&load group='top' kind='pressure' value=5 /\n"
            f"&history name='fall' times=0,60 values=1,0 /\n&fix group='right' field='p_w' kind='seepage' value={load(setting, 19.62)} value_slope=-9.81 history='fall' /\n"
            f"&stage name='rain' analysis='quasi_static' duration=3600 dt=6 dt_growth=1.2 dt_max=300 rho_inf=0 max_iterations=30 /\n{SIDES}"
            "&point name='centre' r=3 z=0.667 /\n")


def spin(setting):
    """Loose sand is spun up from 1 g to 50 g."""
    return ("&scene name='spin' geometry='plane_strain' gravity=" + load(setting, 490.5) + " gravity_history='spin' /\n"
            f"&mesh r=0,0.2 r_cells=2 z=0,0.3 z_cells=6 /\n{sand(setting)}"
            "&region material='sand' drainage='dry' void_ratio=0.9 rho_s=2.7 /\n&initial stress='geostatic' k_0=0.5 surface=0.3 /\n"
            "&history name='spin' times=0,1,2 values=0.02,0.02,1 /\n"
            "&stage name='rest' analysis='static' duration=1 dt=1 tolerance=1e-8 zero_displacements='yes' /\n"
            f"&stage name='spin' analysis='static' duration=1 dt=0.02 max_iterations=20 /\n{SIDES}&point name='centre' r=0 z=0.3 /\n")


def fading(setting):
    """Dry sand under a strip load: its strength falls to 0.7, comes back and falls again, below what it was."""
    return ("&scene name='fading' geometry='plane_strain' gravity=9.81 /\n"
            f"&mesh r=0,0.5,3 r_cells=3,4 r_ratio=0.8,1.6 z=-2,0 z_cells=5 z_ratio=0.7 /\n{sand(setting)}"
            "&region material='sand' drainage='dry' void_ratio=0.8 rho_s=2.7 /\n&initial stress='geostatic' k_0=0.5 surcharge=5 /\n"
            "&strength material='sand' parameter='M_c' history='fade' /\n&history name='fade' times=0,2,2.5,3,4 values=1,1,0.7,1,0.6 /\n"
            "&history name='ramp' times=1,2 values=0,1 /\n&load group='top' kind='pressure' value=5 /\n"
            f"&load group='top_1' kind='pressure' value={load(setting, 30.0)} history='ramp' /\n"
            "&stage name='rest' analysis='static' duration=1 dt=1 tolerance=1e-8 zero_displacements='yes' /\n"
            "&stage name='load' analysis='static' duration=1 dt=0.1 max_iterations=20 /\n"
            f"&stage name='fade' analysis='static' duration=2 dt=0.05 max_iterations=20 /\n{SIDES}&point name='centre' r=0 z=0 /\n")


AIR, HENRY, WATER = 101.325, 0.02, 2.2e6   # kPa, -, kPa


def shaken_air(setting):
    """Loose sand with a tenth of its pores full of air that cannot leave, in cycles of axial load."""
    turns = [float(i) for i in range(41)]
    values = [0.0] + [(1, -1)[i % 2] for i in range(40)]
    return ("&scene name='shaken_air' fields='u-p_w-p_c' pressures='quadratic' /\n&mesh r=0,0.05 r_cells=1 z=0,0.1 z_cells=1 /\n"
            f"{sand(setting, P_a=0.02, b_1=0, b_2=0)}&fluids gas='ideal' k_w={WATER} henry={HENRY} /\n"
            "&region material='sand' retention='material' drainage='undrained' void_ratio=0.833 rho_s=2.7 /\n"
            "&initial stress='uniform' sigma=-100,-100,-100 p_w=99.989 p_c=0.011 /\n"
            f"&history name='turns' times={','.join(map(str, turns))} values={','.join(map(str, values))} /\n"
            f"&stage name='shake' analysis='quasi_static' duration=40 dt=0.05 rho_inf=0 tolerance=1e-5 max_iterations=20 /\n{SIDES.splitlines()[0]}\n{SIDES.splitlines()[2]}\n"
            "&load group='right' kind='pressure' value=200 /\n&load group='top' kind='pressure' value=200 /\n"
            f"&load group='top' kind='pressure' value={load(setting, 25.0)} history='turns' /\n&point name='centre' r=0 z=0.1 /\n")


FOOTING_MESH = "&mesh r=0,0.5,4 r_cells=2,3 r_ratio=0.7,1.9 z=-4,-0.6,0 z_cells=2,2 z_ratio=0.4,0.7 /\n"


def footing(setting, void_ratio, steps, settlement=0.25, suction=0, undrained=False, pressures='quadratic'):
    """A rough circular footing of 1 m pushed into soil; 40 elements."""
    fields = "u-p_w" if undrained else "u-p_w-p_c" if suction else "u"
    water = suction or undrained
    return (f"&scene name='footing' fields='{fields}' pressures='{pressures}' gravity=9.81 initial_flow='subtract' /\n{FOOTING_MESH}{sand(setting)}"
            + ("&permeability name='k' intrinsic=1e-12 /\n" if water else "")
            + f"&region material='sand' void_ratio={void_ratio} {'permeability=' + repr('k') if water else ''} "
            + ("retention='material'" if suction else "") + " /\n"
            + "&initial stress='geostatic' surcharge=2 k_0=0.5 "
            + (f"p_w=-{suction} p_c={suction}" if suction else "p_w_slope=-9.81" if undrained else "") + " /\n"
            + f"&history name='ramp' times=0,{0.01 if undrained else 1.0} values=0,1 /\n"
            + f"&stage name='push' analysis='{'quasi_static' if undrained else 'static'}' duration={0.01 if undrained else 1.0} "
            f"dt={(0.01 if undrained else 1.0) / steps} cuts=10 {'rho_inf=0' if undrained else ''} /\n{SIDES}&fix group='bottom' field='u_r' /\n"
            "&fix group='top_1' field='u_r' /\n"
            f"&fix group='top_1' field='u_z' value={load(setting, -settlement)} history='ramp' /\n&load group='top_2' kind='pressure' value=2.0 /\n"
            + (f"&fix group='top_2' field='p_w' value={-suction} /\n" if water else "") + (f"&fix group='top_2' field='p_c' value={suction} /\n" if suction else "")
            + "&point name='edge' r=0.5 z=0 /\n")


# ---- meshes

def rectangle(xs, ys, move=lambda i, j, x, y: (x, y), bulge=0.0):
    """Gmsh 4.1 text of a rectangle cut along xs and ys, each cell in two 6-node triangles; `move` shifts inner corners, `bulge` moves the
    middle of the first inner side by so much of its length."""
    nx, ny = len(xs), len(ys)
    points, sides = [], {}
    for j, y in enumerate(ys):
        for i, x in enumerate(xs):
            points.append(move(i, j, x, y) if 0 < i < nx - 1 and 0 < j < ny - 1 else (x, y))

    def middle(a, b):
        key = frozenset((a, b))
        if key not in sides:
            points.append(tuple((p + q) / 2 for p, q in zip(points[a], points[b])))
            sides[key] = len(points) - 1
        return sides[key]

    triangles, edges = [], {"bottom": [], "right": [], "top": [], "left": []}
    for j in range(ny - 1):
        for i in range(nx - 1):
            a, b, c, d = j * nx + i, j * nx + i + 1, (j + 1) * nx + i + 1, (j + 1) * nx + i
            triangles += [(p, q, r, middle(p, q), middle(q, r), middle(r, p)) for p, q, r in ((a, b, c), (a, c, d))]
            for at, name, p, q in ((j == 0, "bottom", a, b), (i == nx - 2, "right", b, c), (j == ny - 2, "top", c, d), (i == 0, "left", d, a)):
                if at:
                    edges[name].append((p, q, middle(p, q)))
    if bulge:
        x, y = points[triangles[0][5]]
        points[triangles[0][5]] = (x + bulge * (xs[1] - xs[0]), y - bulge * (ys[1] - ys[0]))
    return gmsh.text(points, {"soil": triangles}, edges, digits=17)


def even(n):
    return [i / n for i in range(n + 1)]


def meshes():
    """The unit square in ways that no mesher would hand out."""
    dice = random.Random(1)
    return {"regular": rectangle(even(4), even(4)),
            "slivers": rectangle(even(4), [0, 0.25, 0.5, 0.5005, 0.75, 1]),                       # angles of 0.1 degrees
            "distorted": rectangle(even(4), even(4), lambda i, j, x, y: (x + dice.uniform(-0.1, 0.1), y + dice.uniform(-0.1, 0.1))),
            "graded": rectangle([0, *(10.0 ** -n for n in (5, 4, 3, 2, 1, 0))], even(2))}          # sizes over five decades


def square(setting, mesh, material=None, strain=0.01):
    """A unit square compressed without lateral strain: every mesh has to give the same stress everywhere."""
    text = ("&scene name='square' geometry='plane_strain' /\n&mesh file='square.msh' /\n" + (material or sand(setting)) +
            f"&region material='sand' void_ratio=0.8 /\n&initial stress='uniform' sigma=-100,-100,-100 /\n&history name='ramp' times=0,1 values=0,1 /\n"
            f"&stage name='press' analysis='static' duration=1 dt=0.1 tolerance=1e-8 /\n{SIDES}"
            f"&fix group='top' field='u_z' value={load(setting, -strain)} history='ramp' /\n")
    return text, {"square.msh": mesh}
