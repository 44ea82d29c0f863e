# SPDX-License-Identifier: MIT
"""Prints how much the answer of ground depends on how its stress at the start came about.

usage: gravity_loading.py BUILD_FOLDER
Default sand of void ratio 0.75, or what plastic loading leaves of it: a point under a vertical effective stress of 100
kPa by mud_triax, and a strip of 2 m on 5 m of ground with weight under a surcharge of 10 kPa by mud_host, where
gravity_history switches the weight on.
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "common"))
from tables import numbers  # noqa: E402

build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/release").resolve()
VERTICAL, SMALL = 100.0, 1.0   # [kPa]
SURCHARGE, DEPTH, WEIGHT = 10.0, 5.0, 9.81*2.65/1.75   # of the strip [kPa, m, kN/m3]
TESTS = ("control = 'k0'\n   sigma_a_end = 150\n   increment = 0.5",
         "control = 'k0'\n   sigma_a_end = 50\n   increment = 0.5",
         "control = 'undrained'\n   eps_a_end = {:.15g}")


STRIP = """&scene
   name = 'strip'
   geometry = 'plane_strain'
   fields = 'u'
   gravity = 9.81
   gravity_history = 'weight'
/
&mesh
   r = 0, 1, 6
   r_cells = 3, 4
   z = -5, -2, 0
   z_cells = 2, 4
/
&mud
   name = 'sand'
/
&region
   material = 'sand'
   void_ratio = {void_ratio!r}
/
&initial
   {stress}
/
&history
   name = 'weight'
   times = 0, 1
   values = {begin!r}, 1
/
&history
   name = 'strip'
   times = 1, 2
   values = 0, 1
/
&stage
   name = 'ground'
   analysis = 'static'
   duration = 1
   dt = {step!r}
/
&stage
   name = 'strip'
   analysis = 'static'
   duration = 1
   dt = 0.05
/
&fix
   group = 'left'
   field = 'u_r'
/
&fix
   group = 'right'
   field = 'u_r'
/
&fix
   group = 'bottom'
   field = 'u_z'
/
&load
   group = 'top'
   kind = 'pressure'
   value = {surcharge!r}
/
&load
   group = 'top_1'
   kind = 'pressure'
   value = 100
   history = 'strip'
/
&point
   name = 'centre'
   r = 0
   z = 0
/
"""


def strip(folder, void_ratio, k_0, plastic):
    """Settlement of the middle of the strip under 100 kPa [mm]; plastic: the weight is switched on, under the surcharge
    at K_0, otherwise its stress is given."""
    if plastic:
        stress = f"stress = 'uniform'\n   sigma = {-k_0*SURCHARGE!r}, {-SURCHARGE!r}, {-k_0*SURCHARGE!r}"
    else:
        stress = f"stress = 'geostatic'\n   surface = 0\n   surcharge = {SURCHARGE!r}\n   k_0 = {k_0!r}"
    (folder / "strip.nml").write_text(STRIP.format(
        void_ratio=void_ratio, stress=stress, begin=0.0 if plastic else 1.0, step=0.04 if plastic else 1.0,
        surcharge=SURCHARGE))
    subprocess.run([build / "host/mud_host", "strip.nml", "--output", "strip", "--quiet"], cwd=folder,
                   check=True)
    path = [(row["time"], row["centre.u_z"]) for row in numbers(folder / "strip/histories.csv")]
    before = min(path, key=lambda row: abs(row[0] - 1.0))[1]
    return 1e3*(before - path[-1][1])


def run(folder, start, *stages):
    """Columns of a case at its end."""
    text = f"&material\n/\n&initial\n   {start}\n/\n" + "".join(f"&stage\n   {stage}\n/\n" for stage in stages)
    (folder / "case.nml").write_text(text)
    subprocess.run([build / "drivers/mud_triax", "case.nml", "--output", "case.csv", "--quiet"], cwd=folder, check=True)
    return numbers(folder / "case.csv")[-1]


def answers(folder, start, *before):
    """Settlement of 50 kPa more [%], horizontal stress after 50 kPa less, q of undrained compression to 0.1 % [kPa]."""
    at = run(folder, start, *before) if before else {"eps_a": 0.0}
    ends = [run(folder, start, *before, test.format(at["eps_a"] + 0.001)) for test in TESTS]
    return 100.0*(ends[0]["eps_a"] - at["eps_a"]), ends[1]["sigma_r"], ends[2]["q"]


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    plastic = (f"p_eff = {SMALL}\n   void_ratio = 0.75",
               f"control = 'k0'\n   sigma_a_end = {VERTICAL}\n   increment = 0.5")
    end = run(folder, *plastic)
    k_0 = end["sigma_r"]/VERTICAL
    # what plastic loading by the weight leaves of the void ratio at half of the depth of the ground
    middle = run(folder, f"sigma_a = {SURCHARGE}\n   sigma_r = {k_0*SURCHARGE:.15g}\n   void_ratio = 0.75",
                 f"control = 'k0'\n   sigma_a_end = {SURCHARGE + 0.5*DEPTH*WEIGHT}\n   increment = 0.5")["e"]

    def given(ratio):
        return (f"sigma_a = {VERTICAL}\n   sigma_r = {ratio*VERTICAL:.15g}\n   void_ratio = {end['e']:.15g}",)

    print("| stress at the start | K_0 | settlement | sigma_h | q | strip |")
    for what, ratio, start in (("plastic: vertical stress from 1 to 100 kPa, weight from 0", k_0, plastic),
                               ("the same stress, given", k_0, given(k_0)),
                               ("elastic, Poisson's ratio 0.3", 0.3/0.7, given(0.3/0.7)),
                               ("given", 0.5, given(0.5)), ("given", 1.0, given(1.0))):
        settlement, horizontal, q = answers(folder, *start)
        settled = strip(folder, 0.75 if start is plastic else middle, ratio, start is plastic)
        print(f"| {what} | {ratio:.3f} | {settlement:.3f} | {horizontal:.1f} | {q:.1f} | {settled:.1f} |", flush=True)
