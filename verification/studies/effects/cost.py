#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `mud_study effects` costs beside the run that it is for: processor times of pilots, and of the scene as it stands
without a study. Usage: cost.py"""
import os
import pathlib
import re
import resource
import subprocess
import sys

import f90nml
from scenes import strip

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "verification"), str(ROOT / "python")]
import tables  # noqa: E402
from mud.study.effects import settled, write_scene  # noqa: E402
from tools import results  # noqa: E402

NAMES = ("scene", "pilots", "spent", "quoted", "run", "share", "off")


def footing(cells):
    """A flexible footing on dense sand: its weight is asked for, switches of the material are left open."""
    return f"""&scene name = 'footing' effects = 'auto' step_tolerance = 1e-3 /
&mesh r = 0, 0.75, 4 r_cells = {cells}, {2*cells} z = -3, 0 z_cells = {2*cells} z_ratio = 0.95 /
&mud name = 'sand' e_0 = 0.7 /
&region material = 'sand' /
&initial stress = 'geostatic' surcharge = 5 k_0 = 0.5 /
&history name = 'ramp' times = 0, 1 values = 0, 1 /
&stage name = 'push' analysis = 'static' duration = 1 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&load group = 'top_1' kind = 'pressure' value = 5 /
&load group = 'top_2' kind = 'pressure' value = 5 /
&load group = 'top_1' kind = 'pressure' value = 60 history = 'ramp' /
&point name = 'centre' r = 0 z = 0 /
&point name = 'aside' r = 1.2 z = 0 /
"""


SCENES = {"strip, 32 elements": strip(4), "strip, 3200 elements": strip(40), "strip, 24200 elements": strip(110),
          "footing on sand, 1200 elements": footing(10), "footing on sand, 10800 elements": footing(30),
          "footing on sand, 23232 elements": footing(44)}


def processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    made, rows = results.folder(__file__), []
    build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_LIBRARY_DIR": str(build), "OMP_NUM_THREADS": "1",
                   "MUD_HOST": str(build / "host/mud_host"), "MPLBACKEND": "Agg"}
    for name, text in SCENES.items():
        folder = made / re.sub("[ ,]+", "_", name)
        folder.mkdir(exist_ok=True)
        path = folder / "scene.nml"
        path.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, "-m", "mud.study", "effects", path, "--output", folder], capture_output=True,
                              text=True, env=environment)
        pilots, spent = re.search(r"(\d+) pilots, (\S+) s", done.stdout).groups()
        quoted = re.search(r"quoted at (\S+) s", done.stdout)
        write_scene(settled(f90nml.read(path)), folder / "plain.nml", folder)
        kept = folder / "plain_seconds.txt"     # dear, and the same for every study
        if not kept.exists():
            before = processor()
            subprocess.run([build / "host/mud_host", folder / "plain.nml", "--quiet", "--set", "stage.fields=0", "--output",
                            folder / "plain"], env=environment, check=True)
            kept.write_text(f"{processor() - before:.4g}", encoding="utf-8")
        run = float(kept.read_text(encoding="utf-8"))
        table = tables.rows(folder / "effects.csv") if (folder / "effects.csv").exists() else []
        rows.append((name, pilots, spent, quoted.group(1) if quoted else "", f"{run:.3g}", f"{float(spent)/run:.2g}",
                     " ".join(r["effect"].replace(" ", "_") for r in table if r["on"] == "off" and r["influence"])))
        tables.write(made / "cost.csv", NAMES, rows)
        print(*rows[-1], sep=", ", flush=True)


if __name__ == "__main__":
    main()
