# SPDX-License-Identifier: MIT
"""Scenes of a quarter of a smooth, rigid, square footing on saturated MUD sand, for checks and for scaling.py.

footing.py CELLS > SCENE.nml, or footing.scene(...). The sand begins at an even effective stress of 50 kPa; the water at
a back pressure, for dense sand dilates.
"""
import sys

BACK = 2000.0  # [kPa]


def scene(cells, graded=True, seconds=100.0, settlement=0.02, steps=10, back=BACK, scale=1.0, tolerance=1e-8,
          accuracy="", stage="", elements="tetrahedra"):
    """cells: along an edge, divisible by 3; graded: ground of 8 half widths, else of 3; accuracy, stage: more keys."""
    inner, outer = cells//3, cells - cells//3
    far, ratio = (8.0, 1.35**(6.0/cells)) if graded else (3.0, 1.0)
    half = 0.5*scale
    line = f"{{0}} = 0, {half!r}, {far*half!r}  {{0}}_cells = {inner}, {outer}  {{0}}_ratio = 1, {ratio!r}"
    down = f"z = {-far*half!r}, {-half!r}, 0  z_cells = {outer}, {inner}  z_ratio = {1.0/ratio!r}, 1"
    control = accuracy or f"dt = {seconds/steps!r}"
    return f"""! A quarter of a square footing, pushed {settlement} m in {seconds} s.
&scene name = 'footing' geometry = 'box' fields = 'u-p_w' pressures = 'linear' quadrature = 3 /
&mesh {line.format('r')}
      {line.format('y')}
      {down} cells = '{elements}' /
&mud name = 'sand' scheme = 2 /
&permeability name = 'k' intrinsic = 1.0193679918450561e-12 law = 'constant' /
&region material = 'sand' permeability = 'k' void_ratio = 0.75 /
&initial p_w = {back!r} stress = 'uniform' sigma = -50, -50, -50 /
&history name = 'ramp' times = 0, {seconds!r} values = 0, 1 /
&stage name = 'push' analysis = 'quasi_static' duration = {seconds!r} {control} tolerance = {tolerance!r}
       max_iterations = 30 {stage} /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'front' field = 'u_y' /
&fix group = 'back' field = 'u_y' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' value = {back!r} /
&fix group = 'top_1_1' field = 'u_z' value = {-settlement!r} history = 'ramp' /
&load group = 'top' kind = 'pressure' value = {back + 50.0!r} /
&point name = 'centre' /
&point name = 'below' z = {-half!r} /
"""


if __name__ == "__main__":
    print(scene(int(sys.argv[1])), end="")
