# SPDX-License-Identifier: MIT
"""An elastic half-space under a flexible circular load, and a consolidating strip between rigid plates, against closed
forms."""
import math

from checking import check, work
from host_program import ran
import tables  # noqa: E402 (checking knows its folder)

YOUNG, LOAD = 1e4, 100.0   # [kPa]

CIRCLE = """&scene name = 'circle' geometry = 'axisymmetric' fields = 'u' /
&mesh r = 0, 1, 3, 10, 60 r_cells = 8, 8, 8, 8 z = -60, -10, -3, -1, 0 z_cells = 8, 8, 8, 8 /
&elastic name = 'soil' young = 1e4 poisson = 0.3 /
&region material = 'soil' void_ratio = 0.5 /
&stage name = 's' analysis = 'static' duration = 1 dt = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top_1' kind = 'pressure' value = 100 /
&point name = 'centre' r = 0 z = 0 /
"""

STRIP = """&scene name = 'strip' geometry = 'plane_strain' fields = 'u-p_w' /
&mesh r = 0, 1 r_cells = 20 z = 0, 0.2 z_cells = 2 /
&elastic name = 'soil' young = 1e4 poisson = 0.2 /
&fluids k_w = 1e9 rho_w = 0 eta_w = 1e-6 /
&permeability name = 'k' intrinsic = 1e-12 /
&region material = 'soil' void_ratio = 0.5 permeability = 'k' /
&plate name = 'lid' group = 'top' mass = 1e-9 force = -100 /
&stage name = 'load' analysis = 'quasi_static' duration = 1e-4 dt = 1e-4 /
&stage name = 'wait' analysis = 'quasi_static' duration = 40 dt = 0.4 tolerance = 1e-8 /
&fix group = 'left' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'right' field = 'p_w' /
&point name = 'centre' r = 0 z = 0 /
"""


def test_a_circular_load_on_a_half_space():
    # Boussinesq: the centre settles by 2 p a (1 - nu^2)/E, less what the ground below the mesh would do, at most the
    # settlement of the depth H under the whole load as a point load; sides at the same distance take as much.
    ran("circle", CIRCLE)
    settles = -float(tables.numbers(work / "circle/histories.csv")[-1]["centre.u_z"])
    exact = 2*LOAD*(1 - 0.3**2)/YOUNG
    below = LOAD*(1 + 0.3)*(1 + 2*(1 - 0.3))/(2*YOUNG*60)
    check("the centre settles as Boussinesq's", exact - 2*below < settles < exact + below/4, (settles, exact, below))

    # Near the axis, to a depth of one radius: sigma_z = p (1 - (1 + (a/z)^2)^-3/2). Stresses of cells of a/8 are off by
    # (h/a)^2/4, 0.4 % of the load.
    points = [q for q in tables.numbers(work / "circle/points_s.csv") if q["r"] < 0.05 and -1 < q["z"]]
    off = [q["s_zz"] + LOAD*(1 - (1 + 1/q["z"]**2)**-1.5) for q in points]
    check("stresses below the centre are Boussinesq's", len(points) > 8 and max(map(abs, off)) < LOAD/256, off)


def test_pore_pressure_in_a_strip_between_plates_rises_before_it_falls():
    # Mandel (1953): p/(F/a)/2 = sum sin b/(b - sin b cos b) (cos(b r/a) - cos b) exp(-b^2 T), tan b = (1 - nu)/
    # (1/2 - nu) b, here at r = 0 with an incompressible fluid. A step of backward Euler is a time of c_v dt/a^2.
    ran("strip", STRIP)
    rows = tables.numbers(work / "strip/histories.csv")
    ratio, step = (1 - 0.2)/(0.5 - 0.2), 0.4*1e-6*YOUNG*(1 - 0.2)/((1 + 0.2)*(1 - 0.4))
    roots = []
    for k in range(60):
        low, high = k*math.pi + (1e-3 if k == 0 else 1e-9), (k + 0.5)*math.pi - 1e-12
        for _ in range(200):
            middle = (low + high)/2
            low, high = (middle, high) if math.tan(middle) < ratio*middle else (low, middle)
        roots.append(low)

    def exact(time):
        return LOAD*sum(math.sin(b)/(b - math.sin(b)*math.cos(b))*(1 - math.cos(b))*math.exp(-b*b*step*time/0.4)
                        for b in roots)

    late = [row for row in rows if row["time"] > 2]
    off = [row["centre.p_w"] - exact(row["time"]) for row in late]
    check("pressures are Mandel's", max(map(abs, off)) < step*LOAD, max(map(abs, off)))
    peak = max(row["centre.p_w"] for row in rows)
    check("they rise by a tenth before they fall", abs(peak/max(map(exact, (row["time"] for row in late))) - 1) < step
          and peak > 1.1*LOAD/2 and late[-1]["centre.p_w"] < LOAD/3, peak)


def test_the_axis_holds_itself():
    # The hoop strain of r = 0 is finite in no ground that leaves it. A shear to the outside pulls hardest there, and
    # without the support the hoop stress beside it was wrong in silence.
    held = CIRCLE.replace("'pressure'", "'shear_r'")
    support = "&fix group = 'left' field = 'u_r' /\n"
    check("there is a support on the axis", held.count(support) == 1, held)
    rows = [tables.numbers(work / name / "points_s.csv") for name, text in (
        ("held", held), ("free", held.replace(support, ""))) if ran(name, text)]
    check("without a support on the axis the answer is the same", len(rows) == 2 and rows[0] == rows[1] != [],
          [len(one) for one in rows])
