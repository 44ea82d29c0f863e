# SPDX-License-Identifier: MIT
"""What accuracy costs in the indentation: error of every answer against CPU time, rate evaluations, factorisations.

    verification/run studies/cost --make --only study.py [--pass PART...]

One contributor at a time from a base, settings together, the paper's settings and tolerances, on a coarse mesh at a
suction of 30 kPa. Writes price.csv; resumable: an
analysis whose row is there is left. Prints progress and the time left. Three CPU minutes, one thread. Times are CPU
times of the process (user), for other programs may be running; compare them within one part of the table. A part is
named by its suction and mesh (`0coarse`).
"""
import os
import pathlib
import re
import resource
import subprocess
import sys
import time
from typing import NamedTuple

import numpy as np

here = pathlib.Path(__file__).resolve().parent
root = here.parents[2]
sys.path[:0] = [str(root / "common"), str(root / "verification"), str(root / "verification/studies/indentation")]
from analysis import change, render, scene  # noqa: E402
import tables  # noqa: E402
from tools import results  # noqa: E402

build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
host = build / "host/mud_host"
FOLDER = build.parent / "cost/price"
ANSWERS = ("peak", "peak_time", "p_w", "history")
NAMES = ("suction", "mesh", "contributor", "setting", "steps", "iterations", "rates", "factorisations", "seconds",
         *ANSWERS)
DURATION = 0.03       # s: to the end of the contact; the bounces after it are chaotic
SMALL = dict(r_cells="3, 4", r_ratio=f"1, {1.35**2:.8g}", z_cells="4, 4", z_ratio=f"{0.76**2:.8g}, {0.9**2:.8g}")


class Setting(NamedTuple):
    """What an analysis changes of the paper's settings; dt None: chosen by the tolerance."""
    dt: float | None = 6e-5
    rho_inf: float | None = 0.0
    newton: float | None = 1e-3
    stress: float | None = 1e-5
    scheme: int = 1
    factors: str = "reuse"
    pressures: str = "quadratic"
    quadrature: int = 6
    step_tolerance: str = ""


BASE = Setting(dt=1.2e-4)
PAPER = Setting(dt=3e-5, rho_inf=0.8)
# The references: finer in everything but the mesh; another rho_inf tells how far they can be trusted.
REFERENCE = Setting(dt=7.5e-6, newton=1e-6, stress=1e-7, scheme=2)
SECOND = REFERENCE._replace(rho_inf=0.5)
ANALYSES = {
    ("reference", "rho_inf 0"): REFERENCE,
    ("reference", "rho_inf 0.5"): SECOND,
    ("paper", "dt 3e-5, rho_inf 0.8"): PAPER,
    **{("step", f"dt {dt:.2g}, rho_inf 0"): BASE._replace(dt=dt) for dt in (4.8e-4, 2.4e-4, 1.2e-4, 6e-5)},
    **{("step", f"dt {dt:.2g}, rho_inf 0.8"): PAPER._replace(dt=dt) for dt in (6e-5,)},
    **{("stress", f"tolerance {t:.0e}, scheme {s}"): BASE._replace(stress=t, scheme=s)
       for t, s in ((1e-2, 1), (1e-3, 1), (1e-4, 1), (1e-5, 2))},
    **{("newton", f"tolerance {t:.0e}"): BASE._replace(newton=t) for t in (1e-2, 1e-5)},
    ("linear", "factors fresh"): BASE._replace(factors="fresh"),
    ("pressures", "linear"): BASE._replace(pressures="linear"),
    ("quadrature", "3 points"): BASE._replace(quadrature=3),
    **{("together", f"dt {dt:.2g}, rho_inf 0, stress {t:.0e}"): BASE._replace(dt=dt, stress=t)
       for dt, t in ((4.8e-4, 1e-3), (2.4e-4, 1e-3), (1.2e-4, 1e-3), (6e-5, 1e-4))},
    **{("tolerance", f"step_tolerance {a}"): Setting(None, None, None, None, step_tolerance=a)
       for a in ("1e-1", "3e-2", "1e-2", "1e-3")},
}
OF_ALL = ("reference", "rho_inf 0")
ORDER = [(s, "coarse", n) for s in (30,) for n in ANALYSES]


def scene_of(suction, s):
    """Text of the scene."""
    def adapt(groups):
        change(groups, "mesh", **SMALL)
        change(groups, "stage:impact", duration=DURATION, dt=s.dt, rho_inf=s.rho_inf, tolerance=s.newton)
        change(groups, "mud", tolerance=s.stress, scheme=None if s.step_tolerance else s.scheme)
        if s.step_tolerance:
            # What the paper's settings give by hand is left open.
            for name in ("geostatic", "seat"):
                change(groups, "stage:" + name, tolerance=None)
        change(groups, "scene", checkpoint_steps=None, factors=f"'{s.factors}'", pressures=f"'{s.pressures}'",
               quadrature=s.quadrature, step_tolerance=s.step_tolerance or None, threads=1)
    return render(scene(suction, "u-p_w-p_c", "remedy", adapt))


def folder_of(suction, mesh, name):
    """Of the results of a run."""
    return FOLDER / f"s{suction:04d}_{mesh}" / re.sub(r"\W+", "_", "_".join(name))


def run(suction, mesh, name):
    """Folder of the results, counts and CPU seconds."""
    folder = folder_of(suction, mesh, name)
    s = ANALYSES[name]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.nml").write_text(scene_of(suction, s), encoding="utf-8")
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([host, folder / "scene.nml", "--output", folder, "--verbose"], text=True, capture_output=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1"})
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if done.returncode:
        return folder, None, seconds, done.stderr.strip()
    counts = re.search(r"(\d+) steps, (\d+) iterations.*?, (\d+) rate evaluations.*?, (\d+) factorisations",
                       done.stdout)
    return folder, [int(n) for n in counts.groups()], seconds, ""


def answers(folder):
    """Peak of the displacement [mm], its time [ms], largest change of p_w [kPa], the history of the displacement."""
    h = tables.columns(folder / "histories.csv")
    of_impact = (h["time"] >= 2 - 1e-9) & (h["time"] <= 2 + DURATION + 1e-9)
    time_, u, p = (h[n][of_impact] for n in ("time", "centre.u_z", "centre.p_w"))
    fine = np.linspace(2, 2 + DURATION, 1501)
    return (-1e3*u.min(), 1e3*(time_[np.argmin(u)] - 2), p.max() - p[0], np.interp(fine, time_, 1e3*u))


def errors(found, exact):
    """Relative errors: of the values, and of the history in the mean square over its largest value."""
    return [abs(f/e - 1) for f, e in zip(found[:3], exact[:3])] + [
        float(np.sqrt(np.mean((found[3] - exact[3])**2))/exact[0])]


def main(words):
    table = results.folder(__file__) / "price.csv"
    have = [tuple(r[n] for n in NAMES) for r in tables.rows(table)] if table.exists() else []
    left = [a for a in ORDER if (not words or f"{a[0]}{a[1]}" in words)
            and not any(r[:4] == (str(a[0]), a[1], *a[2]) for r in have)]
    begin = time.monotonic()
    for i, (suction, mesh, name) in enumerate(left):
        folder, counts, seconds, said = run(suction, mesh, name)
        key = (str(suction), mesh, *name)
        if counts is None:
            have.append((*key, "failed: " + " ".join(said.split())[:90].replace(",", ";"), "", "", "",
                         f"{seconds:.2f}", "", "", "", ""))
        else:
            found, exact = answers(folder), answers(folder_of(suction, mesh, OF_ALL))
            shown = [f"{v:.6g}" for v in found[:3]] + ["0"] if name == OF_ALL else \
                [f"{e:.2g}" for e in errors(found, exact)]
            have.append((*key, *map(str, counts), f"{seconds:.2f}", *shown))
        tables.write(table, NAMES, have)
        spent = time.monotonic() - begin
        print(f"{suction} kPa, {mesh} mesh, {', '.join(name)}: {seconds:.1f} s; {i + 1} of {len(left)}, about "
              f"{spent/(i + 1)*(len(left) - i - 1):.0f} s left", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
