# SPDX-License-Identifier: MIT
"""A law of one file and one entry of the registry runs in a case of the driver and in a scene of the host."""
import subprocess

from checking import build, check, work
import tables  # noqa: E402 (checking knows its folder)

programs = build / "tests/planted"
# K = 200 p', with the p' where an increment begins: n increments of volumetric strain h end at p' (1 + 200 h)^n.
STIFFNESS, START, STEP, COUNT = 200.0, 100.0, 1e-4, 50
END = START*(1 + STIFFNESS*STEP)**COUNT
KEYS = f"stiffness = {STIFFNESS}\n   poisson = 0.3\n"


def run(program, text, *words):
    file = work / f"{program}.nml"
    file.write_text(text)
    return subprocess.run([programs / program, file, *words], capture_output=True, text=True, cwd=work)


def test_a_case_of_the_driver_runs_it_and_ends_at_the_product_of_its():
    # Held stresses are met to 1e-10 of themselves in each of 50 increments.
    done = run("mud_triax", f"""&material
   law = 'hypoelastic'
   {KEYS}/
&initial
   p_eff = {START}
   void_ratio = 0.8
/
&stage
   control = 'isotropic'
   eps_v_end = {STEP*COUNT}
   increment = {STEP}
   output_interval = {STEP}
/
""", "--output", "case.csv", "--quiet")
    rows = tables.numbers(work / "case.csv") if done.returncode == 0 else [{}]
    check("a case of the driver runs it and ends at the product of its increments",
          abs(rows[-1].get("p_eff", 0) - END) <= 1e-8*END, f"{rows[-1]} {done.stderr}")


def test_a_scene_of_the_host_runs_it_and_ends_there_too():
    # Newton's tolerance is 1e-10 of the forces in each of 50 steps.
    done = run("mud_host", f"""&scene name = 'column' geometry = 'plane_strain' fields = 'u' /
&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /
&hypoelastic
   name = 'soil'
   {KEYS}/
&region material = 'soil' void_ratio = 0.8 /
&initial stress = 'uniform' sigma = {-START}, {-START}, {-START} /
&history name = 'down' times = 0, 1 values = 0, 1 /
&stage name = 'press' analysis = 'static' duration = 1 dt = {1/COUNT} tolerance = 1e-10 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'u_z' value = {-STEP*COUNT} history = 'down' /
""", "--output", "scene", "--quiet")
    points = tables.numbers(work / "scene/points_press.csv") if done.returncode == 0 else []
    mean = [-(p["s_rr"] + p["s_zz"] + p["s_tt"])/3 for p in points]
    check("a scene of the host runs it and ends there too", mean and max(abs(p - END) for p in mean) <= 1e-8*END,
          f"{mean} {done.stderr}")


def test_the_template_of_scenes_has_its_group():
    template = subprocess.run([programs / "mud_host", "--template"], capture_output=True, text=True).stdout
    check("the template of scenes has its group",
          "&hypoelastic" in template and "stiffness" in template, template[-500:])
    done = run("mud_triax", f"&material law = 'hypoelastik' {KEYS}/\n&initial p_eff = 100 void_ratio = 0.8 /\n"
               "&stage control = 'isotropic' eps_v_end = 0.01 increment = 1e-4 output_interval = 1e-4 /\n")
    check("a misspelt law is told the nearest", done.returncode == 2 and "hypoelastic" in done.stderr, done.stderr)
    done = run("mud_host", "&scene name = 'a' fields = 'u' /\n&hypoelastic name = 'a' stiffnes = 1 /\n"
               "&mesh r = 0, 1 r_cells = 1 z = 0, 1 z_cells = 1 /\n&region material = 'a' void_ratio = 0.8 /\n"
               "&stage name = 'b' analysis = 'static' duration = 1 dt = 1 /\n")
    check("and a misspelt key of its own", done.returncode == 2 and "stiffness" in done.stderr, done.stderr)
