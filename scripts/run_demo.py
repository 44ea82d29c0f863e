# SPDX-License-Identifier: MIT
"""Runs the model against Verdugo & Ishihara's triaxial tests on Toyoura sand, then one impact on unsaturated soil.

Six drained tests beside their laboratory points, twelve undrained tests beside the closed-form steady state, through the
driver mud_triax: the page verification/material/verdugo_ishihara; the paper's indentation at a suction of 30 kPa through
mud_host (its Fig. 3). Between them Toyoura sand with its published and with fitted parameters, and a light falling weight
deflectometer on it by mud_lwd. This file only starts them.
"""
import argparse
import os
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
VERIFICATION = ROOT / "verification"
sys.path.insert(0, str(VERIFICATION))
from tools import runner  # noqa: E402

PAGE = "material/verdugo_ishihara"


def indentation(host, folder):
    """The paper's section 4 at a suction of 30 kPa; its answer is shown as the paper's Fig. 3."""
    sys.path.insert(0, str(VERIFICATION / "studies/indentation"))
    import analysis
    import figures
    print("\nImpact of a rigid plate on soil at a suction of 30 kPa (about half a minute)", flush=True)
    output = folder / "indentation"
    # Threads that wait without spinning: the machine may have other work.
    environment = {**os.environ, "OMP_WAIT_POLICY": "passive"}
    if subprocess.run([host, analysis.TEMPLATE, "--output", output], env=environment).returncode != 0:
        sys.exit("run_demo: the indentation did not come to its end.")
    columns = analysis.histories(output, 1)
    deepest = int(np.argmax(columns["u_mm"]))
    print(f"   largest indentation {columns['u_mm'][deepest]:.3f} mm at {columns['t_ms'][deepest]:.2f} ms, "
          f"{columns['u_mm'][-1]:.3f} mm at the end; p_w {columns['p_w_kPa'].max() - columns['p_w_kPa'][0]:+.2f} kPa under the centre")
    print(f"figure {figures.interface({'remedy': columns}, folder / 'indentation.png')}")


def deflectometer(build, host, folder):
    """A seating and a measured drop on Toyoura sand at a suction of 30 kPa, with their errors."""
    print("\nA light falling weight deflectometer on unsaturated sand (about half a minute)", flush=True)
    environment = {**os.environ, "MUD_LIBRARY_DIR": str(build), "PYTHONPATH": str(ROOT / "python")}
    test = ["test", "--material", "toyoura", "--void-ratio", "0.8", "--suction", "30", "--drops", "1", "1"]
    if subprocess.run([sys.executable, "-m", "mud.lwd", *test, "--host", host, "--output", folder / "lwd"],
                      env=environment).returncode != 0:
        sys.exit("run_demo: the deflectometer test did not come to its end.")
    print(f"figure {folder / 'lwd/lwd.png'}; three seating and three measured drops on your ground: docs/how-to/lwd.md")


def fitted_sand(build, folder):
    """Toyoura sand with the published and the fitted parameters beside the laboratory, by the Python package."""
    os.environ.setdefault("MUD_LIBRARY_DIR", str(build))
    sys.path.insert(0, str(ROOT / "python"))
    import mud
    from mud import plots
    from mud.calibration import answers_of, misfits_of, read_task
    print("\nA fitted sand beside the published one (a second)", flush=True)
    items = read_task(ROOT / "calibration/toyoura_fitted.toml").items
    plt = plots.pyplot()
    plt.rcParams.update(plots.STYLE)
    figure, axes = plt.subplots(2, 2, figsize=(9.5, 7), sharex=True, layout="constrained")
    for column, name in enumerate(("toyoura", "toyoura_fitted")):
        answers = answers_of(mud.Material(name), items)
        missed = misfits_of(items, answers)
        for row, (quantity, label, factor) in enumerate((("q", "q [kPa]", 1), ("eps_v", "volumetric strain [%]", 100))):
            for colour, item in zip(plots.COLOURS, items):
                strain = 100*item.test["eps_a"][item.use.rows]
                axes[row, column].plot(strain, factor*item.test[quantity][item.use.rows], "o", ms=3.5, mfc="white", color=colour)
                axes[row, column].plot(strain, factor*answers[item.test.name].columns[quantity], color=colour,
                                       label=f"e {item.test.e_0:.3f}, {item.test.sigma_r:.0f} kPa")
            axes[row, column].set_ylabel(label)
            axes[row, column].sharey(axes[row, 0])
        axes[0, column].set_title(f"material {name}")
        axes[1, column].set_xlabel("axial strain [%]")
        print(f"   {name}: misfit of q {np.sqrt(np.mean([m.q**2 for m in missed])):.0f} % rms of {len(items)} drained tests, of volumetric "
              f"strain {np.sqrt(np.mean([m.eps_v**2 for m in missed])):.2f} points")
    axes[0, 0].legend(fontsize=7)
    figure.suptitle("Toyoura sand, Verdugo & Ishihara (1996): published and fitted parameters")
    figure.savefig(folder / "fitted_sand.png")
    print(f"figure {folder / 'fitted_sand.png'}; your own sand: calibration/README.md")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release", metavar="DIR",
                        help="build folder with drivers/mud_triax (default: build/release)")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "demo", metavar="DIR",
                        help="where figures and tables go (default: build/demo)")
    options = parser.parse_args()
    build, folder = options.build.resolve(), options.output.resolve()
    driver = build / "drivers" / "mud_triax"
    if not driver.exists():
        sys.exit(f"{driver} is missing: build it first (./demo does), or name the build folder with --build.")
    print("Eighteen triaxial tests on Toyoura sand (about ten seconds)", flush=True)
    outcome = runner.run_page(PAGE, build, folder)
    runner.report(outcome)
    if outcome.failed:
        sys.exit("run_demo: the triaxial tests are not what they should be, see the lines that begin with FAILED.")
    print(f"figures and tables in {folder / PAGE}")
    fitted_sand(build, folder)
    host = build / "host" / "mud_host"
    if host.exists():
        deflectometer(build, host, folder)
        indentation(host, folder)
    else:
        print("mud_host was not built (it needs UMFPACK and LAPACK): no deflectometer and no indentation")


if __name__ == "__main__":
    main()
