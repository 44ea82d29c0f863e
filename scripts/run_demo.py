"""Runs the model against Verdugo & Ishihara's triaxial tests on Toyoura sand, then one impact on unsaturated soil.

Six drained tests beside their laboratory points, twelve undrained tests beside the closed-form steady state, through the
driver mud_triax; the paper's indentation at a suction of 30 kPa through mud_host (its Fig. 3). This file only starts
them, compares and draws.
"""
import argparse
import csv
import math
import os
import pathlib
import re
import subprocess
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402
import numpy as np  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
DRIVERS = ROOT / "drivers"
LABORATORY = ROOT / "verification" / "verdugo_ishihara" / "verdugo_ishihara_1996_drained_TC.csv"
MATERIAL = DRIVERS / "materials" / "toyoura.nml"

# Densest first. Misfits of the independent reference integration: q [%], eps_v [percentage points].
DRAINED = {"TMD4": (8, 0.46), "TMD5": (15, 0.83), "TMD6": (33, 1.64),
           "TMD1": (7, 0.10), "TMD2": (15, 0.98), "TMD3": (42, 1.90)}
VOID_RATIOS = ("0.735", "0.833", "0.907")
PRESSURES = (100, 1000, 2000, 3000)
LOWEST, HIGHEST = 1.0, 25.0  # % of axial strain: below, the digitised curves are piecewise linear
STEADY_STRAIN = 1.0          # natural axial strain to which the undrained tests are continued
CONTROL_TOLERANCE = 1e-10    # the driver's own promise for a held stress

COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e")  # told apart in grey and by colour-blind readers
plt.rcParams.update({
    "figure.dpi": 110, "savefig.dpi": 160, "font.size": 9, "axes.titlesize": 10, "axes.grid": True,
    "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.6,
    "figure.constrained_layout.use": True})


class RunFailed(Exception):
    pass


def run_case(driver, case, output):
    """Runs one case and returns its columns."""
    done = subprocess.run([driver, case, "--quiet", "--output", output], capture_output=True, text=True)
    if done.returncode != 0:
        raise RunFailed(f"{case.name}: exit code {done.returncode}. {done.stderr.strip()}")
    with open(output, encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def continued(case, folder):
    """The same undrained test to a larger strain."""
    text = case.read_text(encoding="utf-8")
    text, ends = re.subn(r"eps_a_end = \S+", f"eps_a_end = {STEADY_STRAIN}", text)
    text, files = re.subn(r"file = '[^']*'", f"file = '{MATERIAL}'", text)
    if (ends, files) != (1, 1):
        raise RunFailed(f"{case.name}: cannot be continued; it should have one eps_a_end and one material file")
    copy = folder / f"{case.stem}_continued.nml"
    copy.write_text(text, encoding="utf-8")
    return copy


def read_laboratory():
    """Per test: sigma_r [kPa], e_0, and columns eps_a [%], eps_v [%], q [kPa], p [kPa], e."""
    tests = {}
    with open(LABORATORY, encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            test = tests.setdefault(row["test"], {"sigma_r": float(row["sigma3_kPa"]), "e_0": float(row["e0"]),
                                                  "rows": []})
            test["rows"].append([float(row[k]) for k in ("eps_a_pct", "eps_v_pct", "q_kPa_derived", "p_kPa_derived",
                                                         "e_derived")])
    for test in tests.values():
        test["eps_a"], test["eps_v"], test["q"], test["p"], test["e"] = np.array(test.pop("rows")).T
    return tests


def read_material():
    text = re.sub(r"!.*", "", MATERIAL.read_text(encoding="utf-8"))
    return {key: float(value) for key, value in re.findall(r"(\w+)\s*=\s*([-+.\deE]+)", text)}


def volumetric_strain(run):
    """Linear volumetric strain [%] as the laboratory reports it, (e_0 - e)/(1 + e_0); the model's own is natural."""
    return 100 * (run["e"][0] - run["e"]) / (1 + run["e"][0])


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def misfit(run, test):
    """Over the laboratory rows from 1 to 25 %: rms of q/q_lab - 1 [%], and of the volumetric strain [points]."""
    used = (test["eps_a"] >= LOWEST) & (test["eps_a"] <= HIGHEST)
    strain = test["eps_a"][used]
    q = np.interp(strain, 100 * run["eps_a"], run["q"])
    volume = np.interp(strain, 100 * run["eps_a"], volumetric_strain(run))
    return 100 * rms(q / test["q"][used] - 1), rms(volume - test["eps_v"][used])


def steady_state(void_ratio, material):
    """Closed form: on the critical state line of eq. (8) at stress ratio M_c."""
    pressure = (material["N_c"] / void_ratio) ** (1 / material["lambda"]) - material["alpha_csl"]
    return pressure, material["M_c"] * pressure


def at_strain(run, strain):
    return int(np.argmin(np.abs(run["eps_a"] - strain)))


def draw_drained(runs, tests, folder):
    figure, axes = plt.subplots(2, 2, figsize=(9.5, 7), sharex=True)
    for column, group in enumerate((("TMD4", "TMD5", "TMD6"), ("TMD1", "TMD2", "TMD3"))):
        top, bottom = axes[0, column], axes[1, column]
        for colour, name in zip(COLOURS, group):
            run, test = runs[name], tests[name]
            label = f"$e_0$ = {test['e_0']:.3f}"
            top.plot(100 * run["eps_a"], run["q"], color=colour, label=label)
            top.plot(test["eps_a"], test["q"], "o", color=colour, ms=4, mfc="white")
            bottom.plot(100 * run["eps_a"], volumetric_strain(run), color=colour, label=label)
            bottom.plot(test["eps_a"], test["eps_v"], "o", color=colour, ms=4, mfc="white")
        top.set_title(f"drained, radial stress {tests[group[0]]['sigma_r']:.0f} kPa")
        top.set_ylim(bottom=0)
        bottom.axhline(0, color="#888888", lw=0.8)
        bottom.set_xlabel("axial strain [%]")
        handles, labels = top.get_legend_handles_labels()
        handles += [plt.Line2D([], [], color="#555555"),
                    plt.Line2D([], [], color="#555555", marker="o", ls="", ms=4, mfc="white")]
        top.legend(handles, labels + ["model", "laboratory"], loc="lower right", ncols=2)
    limits = [f(a.get_ylim()[i] for a in axes[1]) for i, f in ((0, min), (1, max))]
    for axis in axes[1]:
        axis.set_ylim(*limits)
        axis.set_xlim(0, 30)
        axis.annotate("contraction", (0.02, 0.97), xycoords="axes fraction", va="top", color="#777777")
        axis.annotate("dilation", (0.02, 0.03), xycoords="axes fraction", va="bottom", color="#777777")
    axes[0, 0].set_ylabel("deviator stress q [kPa]")
    axes[1, 0].set_ylabel("volumetric strain [%]")
    figure.suptitle("Toyoura sand, drained triaxial compression: MUD with its published parameters, "
                    "and Verdugo & Ishihara (1996)")
    return save(figure, folder / "drained.png")


def draw_undrained(runs, material, folder):
    figure, axes = plt.subplots(2, 3, figsize=(11, 7))
    for column, void_ratio in enumerate(VOID_RATIOS):
        top, bottom = axes[0, column], axes[1, column]
        pressure, deviator = steady_state(float(void_ratio), material)
        for colour, start in zip(COLOURS, PRESSURES):
            run = runs[void_ratio, start]
            top.plot(100 * run["eps_a"], run["q"], color=colour, label=f"{start} kPa")
            bottom.plot(run["p_eff"], run["q"], color=colour)
            bottom.plot(run["p_eff"][0], 0, "|", color=colour, ms=9, mew=2, clip_on=False)
        right = 1.08 * max(run["p_eff"].max() for (e, _), run in runs.items() if e == void_ratio)
        line = np.array([0, right])
        bottom.plot(line, material["M_c"] * line, color="#777777", lw=1, ls="--", label="$q = M_c\\,p'$")
        bottom.plot(pressure, deviator, "*", color="black", ms=11, zorder=5, label="steady state, closed form")
        top.axhline(deviator, color="black", lw=0.9, ls=":", label="steady state, closed form")
        top.set_title(f"undrained, e = {void_ratio}")
        top.set_xlabel("axial strain [%]")
        top.set_xlim(0, 25)
        top.set_ylim(bottom=0)
        bottom.set_xlabel("mean effective stress p' [kPa]")
        bottom.set_xlim(0, right)
        bottom.set_ylim(0, 1.08 * max(run["q"].max() for (e, _), run in runs.items() if e == void_ratio))
    axes[0, 0].set_ylabel("deviator stress q [kPa]")
    axes[1, 0].set_ylabel("deviator stress q [kPa]")
    axes[0, 0].legend(title="consolidated at", loc="lower right")
    axes[1, 0].legend(loc="upper left")
    figure.suptitle("Toyoura sand, undrained triaxial compression: MUD with its published parameters")
    return save(figure, folder / "undrained.png")


def draw_states(drained, undrained, tests, material, folder):
    figure, axis = plt.subplots(figsize=(8, 5.5))
    pressure = np.geomspace(20, 6000, 400)
    critical = material["N_c"] * (pressure + material["alpha_csl"]) ** -material["lambda"]
    axis.plot(pressure, critical, color="black", lw=2.2, label="critical state line, closed form")
    for run in drained.values():
        axis.plot(run["p_eff"], run["e"], color=COLOURS[0])
    for test in tests.values():
        axis.plot(test["p"], test["e"], "o", color=COLOURS[0], ms=3, mfc="white", mew=0.7)
        axis.plot(test["p"][-1], test["e"][-1], "o", color=COLOURS[0], ms=6)
    for run in undrained.values():
        axis.plot(run["p_eff"], run["e"], color=COLOURS[1], lw=1.3, alpha=0.8)
        axis.plot(run["p_eff"][0], run["e"][0], "|", color=COLOURS[1], ms=9, mew=2)
        axis.plot(run["p_eff"][-1], run["e"][-1], "D", color=COLOURS[1], ms=4, zorder=5)
    axis.set_xscale("log")
    axis.set_xticks((20, 50, 100, 200, 500, 1000, 2000, 5000))
    axis.xaxis.set_major_formatter(matplotlib.ticker.ScalarFormatter())
    axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axis.set_xlim(20, 6000)
    axis.set_xlabel("mean effective stress p' [kPa], logarithmic")
    axis.set_ylabel("void ratio e [-]")
    extra = [plt.Line2D([], [], color=COLOURS[0]),
             plt.Line2D([], [], color=COLOURS[0], marker="o", ls="", ms=3, mfc="white", mew=0.7),
             plt.Line2D([], [], color=COLOURS[0], marker="o", ls="", ms=6),
             plt.Line2D([], [], color=COLOURS[1], marker="|", ms=9, mew=2),
             plt.Line2D([], [], color=COLOURS[1], marker="D", ls="", ms=4)]
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles + extra, labels + ["drained, model to 30 %", "drained, laboratory", "its last point",
                                           "undrained, model, from the bar", "its end at 25 %"], loc="lower left")
    axis.set_title("Toyoura sand: paths towards the critical state")
    return save(figure, folder / "states.png")


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    return path


def report_drained(runs, tests, folder):
    print("Drained tests: misfit over the laboratory rows from 1 to 25 % axial strain")
    print("   q: rms of q/q_lab - 1;  eps_v: rms difference in percentage points;  ref.: an independent integration")
    print("   test   sigma_r    e_0   rows |    q [%]   ref.  | eps_v [pp]  ref.  | control error")
    lines = []
    for name, (other_q, other_volume) in DRAINED.items():
        run, test = runs[name], tests[name]
        q, volume = misfit(run, test)
        rows = int(np.sum((test["eps_a"] >= LOWEST) & (test["eps_a"] <= HIGHEST)))
        error = run["control_error"].max()
        print(f"   {name}  {test['sigma_r']:5.0f} kPa  {test['e_0']:.3f}  {rows:3d} | {q:8.2f}  {other_q:5d}  |"
              f"   {volume:7.3f}  {other_volume:5.2f}  |  {error:.1e}")
        lines.append((name, test["sigma_r"], test["e_0"], rows, f"{q:.4f}", other_q, f"{volume:.5f}", other_volume,
                      f"{error:.2e}"))
    write(folder / "misfit.csv", ("test", "sigma_r_kPa", "e_0", "rows", "q_rms_pct", "q_rms_pct_reference",
                                  "eps_v_rms_pp", "eps_v_rms_pp_reference", "control_error"), lines)


def report_undrained(runs, further, material, folder):
    print("Undrained tests: p' and q [kPa] at 25 %, continued to natural strain "
          f"{STEADY_STRAIN:g},\n   and the steady state p'_c = (N_c/e)^(1/lambda) - alpha_csl, q_c = M_c p'_c")
    print("     e    p'_0 |  at 25 %: p'        q |  continued: p'      q |  closed: p'_c     q_c |"
          " q/q_c - 1: at 25 %, continued")
    lines = []
    for (void_ratio, start), run in runs.items():
        longer = further[void_ratio, start]
        pressure, deviator = steady_state(float(void_ratio), material)
        end = at_strain(run, 0.25)
        values = (run["p_eff"][end], run["q"][end], longer["p_eff"][-1], longer["q"][-1], pressure, deviator)
        off = [100 * (values[i] / deviator - 1) for i in (1, 3)]
        print(f"   {void_ratio}  {start:4d} |   {values[0]:8.2f} {values[1]:8.2f} |"
              f"   {values[2]:8.2f} {values[3]:8.2f} |   {values[4]:8.2f} {values[5]:8.2f} |"
              f"   {off[0]:+8.2f} %   {off[1]:+7.3f} %")
        lines.append((void_ratio, start, *(f"{v:.4f}" for v in values), *(f"{v:.4f}" for v in off)))
    write(folder / "steady_state.csv", ("e", "p_0_kPa", "p_25pct_kPa", "q_25pct_kPa", "p_continued_kPa",
                                        "q_continued_kPa", "p_closed_kPa", "q_closed_kPa", "q_off_25pct_pct",
                                        "q_off_continued_pct"), lines)


def indentation(host, folder):
    """The paper's section 4 at a suction of 30 kPa; its answer is shown as the paper's Fig. 3."""
    sys.path.insert(0, str(ROOT / "verification" / "host_indentation"))
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


def write(path, header, lines):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release", metavar="DIR",
                        help="build folder with drivers/mud_triax (default: build/release)")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "demo", metavar="DIR",
                        help="where figures and tables go (default: build/demo)")
    options = parser.parse_args()
    driver, folder = options.build.resolve() / "drivers" / "mud_triax", options.output.resolve()
    if not driver.exists():
        sys.exit(f"{driver} is missing: build it first (./demo does), or name the build folder with --build.")
    folder.mkdir(parents=True, exist_ok=True)

    material, tests = read_material(), read_laboratory()
    drained, undrained, further = {}, {}, {}
    try:
        for name in DRAINED:
            case = DRIVERS / "cases" / f"vi_drained_{name}.nml"
            drained[name] = run_case(driver, case, folder / f"{case.stem}.csv")
        for void_ratio in VOID_RATIOS:
            for start in PRESSURES:
                case = DRIVERS / "cases" / f"undrained_e{void_ratio[2:]}_p{start}.nml"
                undrained[void_ratio, start] = run_case(driver, case, folder / f"{case.stem}.csv")
                longer = continued(case, folder)
                further[void_ratio, start] = run_case(driver, longer, folder / f"{longer.stem}.csv")
    except RunFailed as problem:
        sys.exit(f"run_demo: {problem}")

    report_drained(drained, tests, folder)
    print()
    report_undrained(undrained, further, material, folder)
    print()
    worst = max(run["control_error"].max() for run in drained.values())
    if not worst <= CONTROL_TOLERANCE:
        sys.exit(f"run_demo: the radial stress of a drained test is off by {worst:.1e} of its value, "
                 f"allowed {CONTROL_TOLERANCE:.0e}.")
    if not all(math.isfinite(value) for run in drained.values() for value in run["q"]):
        sys.exit("run_demo: a drained test holds values that are not finite.")
    for path in (draw_drained(drained, tests, folder), draw_undrained(undrained, material, folder),
                 draw_states(drained, undrained, tests, material, folder)):
        print(f"figure {path}")
    print(f"tables {folder / 'misfit.csv'}, {folder / 'steady_state.csv'}; every test as CSV beside them")
    host = options.build.resolve() / "host" / "mud_host"
    if host.exists():
        indentation(host, folder)
    else:
        print("mud_host was not built (it needs UMFPACK and LAPACK): no indentation")


if __name__ == "__main__":
    main()
