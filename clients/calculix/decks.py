# SPDX-License-Identifier: MIT
"""Decks of CalculiX that are made from triaxial.inp, and ground with weight under a K_0 stress."""
import math
import pathlib

GRAVITY = 9.81
TRIAXIAL = (pathlib.Path(__file__).parent / "triaxial.inp").read_text()
END = "*END STEP\n"
HEAD = TRIAXIAL[:TRIAXIAL.index("*AMPLITUDE")]
FIRST, SECOND = (text + END for text in TRIAXIAL.split(END)[:2])
PRINT = "*EL PRINT, ELSET=SOIL\nS\n"


def cut():
    """The first step with increments that CalculiX chooses, half of the step to begin with."""
    return FIRST.replace("*STATIC, DIRECT\n1., 100.", "*STATIC\n50., 100., 1.E-3, 50.")


def finite():
    """The first step with finite strains."""
    return FIRST.replace("*STEP, INC=1000", "*STEP, INC=1000, NLGEOM")


def restart():
    """The first step, which writes for a restart, and the second, which begins there."""
    return FIRST.replace("*CONTROLS", "*RESTART, WRITE, FREQUENCY=1\n*CONTROLS", 1), "*RESTART, READ, STEP=1\n" + SECOND


def turning(degrees, axial, radial, steps):
    """All nodes move: the cube is stretched along its axes to these logarithmic strains and turns about y."""
    nodes = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    amplitudes, conditions = [], []
    for n, x in enumerate(nodes, 1):
        for d in range(3):
            amplitudes.append(f"*AMPLITUDE, NAME=A{n}{d}")
            for k in range(steps + 1):
                c, s = (f(math.radians(degrees)*k/steps) for f in (math.cos, math.sin))
                u = [math.exp(strain*k/steps)*x[i] for i, strain in enumerate((radial, radial, axial))]
                place = (c*u[0] + s*u[2], u[1], -s*u[0] + c*u[2])
                amplitudes.append(f"{k}., {place[d] - x[d]!r}")
            conditions += [f"*BOUNDARY, AMPLITUDE=A{n}{d}", f"{n}, {d + 1}, {d + 1}, 1."]
    return HEAD + "\n".join([*amplitudes, "*STEP, INC=1000, NLGEOM", "*STATIC, DIRECT", f"1., {steps}.", *conditions,
                             PRINT + END])


def ground(cells, height, density, k_0, surcharge, added, steps):
    """A column of ground with weight [m, Mg/m3, kPa]: a step in which nothing is added, and one in which the surcharge
    grows. Every point has the stress of its depth and STATEV of zeros: it begins with a memory of its own."""
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{4*k + i}, {x}., {y}., {height*(k/cells - 1.0)!r}" for k in range(cells + 1)
              for i, (x, y) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1)), 1)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=SOIL")
    lines += [f"{e + 1}, " + ", ".join(str(4*e + i) for i in range(1, 9)) for e in range(cells)]
    lines += ["*INCLUDE, INPUT=material.inp", f"*DENSITY\n{density!r}",
              "*SOLID SECTION, ELSET=SOIL, MATERIAL=@ABAQUS_MUD", "*INITIAL CONDITIONS, TYPE=STRESS"]
    for e in range(cells):
        for point in range(8):
            z = height*((e + 0.5 + (-0.5 if point < 4 else 0.5)/math.sqrt(3.0))/cells - 1.0)
            vertical = -(surcharge - density*GRAVITY*z)
            lines.append(f"{e + 1}, {point + 1}, {k_0*vertical!r}, {k_0*vertical!r}, {vertical!r}, 0., 0., 0.")
    # The loads of the start act from time 0.
    lines += ["*AMPLITUDE, NAME=HELD\n0., 1., 1.E6, 1.", "*BOUNDARY\nALL, 1, 2",
              *(f"{i}, 3, 3" for i in range(1, 5))]
    controls = FIRST[FIRST.index("*CONTROLS"):FIRST.index("*BOUNDARY\nTOP")]
    output = "*NODE PRINT, NSET=ALL\nU\n" + PRINT + END
    return "\n".join([*lines, "*STEP, INC=1000", "*STATIC, DIRECT", "1., 1.", controls.strip(),
                      f"*DLOAD, AMPLITUDE=HELD\nSOIL, GRAV, {GRAVITY}, 0., 0., -1.\n{cells}, P2, {surcharge!r}",
                      output + "*STEP, INC=1000", "*STATIC, DIRECT", f"1., {steps}.",
                      f"*DLOAD\n{cells}, P2, {surcharge + added!r}", output])
