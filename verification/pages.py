"""Verification of the model with element tests: every page runs its cases through mud_triax and holds the results
against an independent reference.

    pages.py [--build DIR] [--output DIR] [--check] [PAGE ...]

prints one line a claim (value, reference, tolerance) and draws a picture of each page; --check leaves the pictures out.
What is claimed, and why the tolerance is what it is, stands in the README.md of the folder named like the page.
"""
import argparse
import atexit
import csv
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
CASES = ROOT / "drivers" / "cases"
MATERIAL = ROOT / "drivers" / "materials" / "toyoura.nml"
TOLERANCE = 1e-5   # of the library's integration, relative: its default
ROUNDING = 1e-12   # a few thousand roundings
P = {key: float(value) for key, value in re.findall(r"(\w+)\s*=\s*([-+.\deE]+)", re.sub(
    r"!.*", "", MATERIAL.read_text(encoding="utf-8")))}


class Bench:
    """Runs cases, each once, and keeps their columns as lists."""

    def __init__(self, build):
        self.driver = build / "drivers" / "mud_triax"
        self.folder = pathlib.Path(tempfile.mkdtemp())
        atexit.register(shutil.rmtree, self.folder, ignore_errors=True)
        self.results = {}

    def run(self, name, changes=()):
        key = (name, *changes)
        if key not in self.results:
            text = (CASES / f"{name}.nml").read_text(encoding="utf-8").replace("../materials", str(MATERIAL.parent))
            for old, new in changes:
                if not re.search(old, text):
                    raise ValueError(f"{name}: nothing to change at {old}")
                text = re.sub(old, new, text)
            self.results[key] = self.run_text(text, name)
        return self.results[key]

    def run_text(self, text, name="case"):
        case, out = self.folder / f"{name}.nml", self.folder / f"{name}.csv"
        case.write_text(text, encoding="utf-8")
        done = subprocess.run([self.driver, case, "--quiet", "--output", out], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"{name}: exit code {done.returncode}. {done.stderr.strip()}")
        lines = out.read_text(encoding="utf-8").splitlines()
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        run = {k: [float(row[k]) for row in rows] for k in rows[0]}
        run["notes"] = [line[2:] for line in lines if line.startswith("# stage")]
        return run


def claim(name, value, reference, tolerance):
    """A measured value beside its reference; the tolerance is absolute."""
    return name, value, reference, tolerance, abs(value - reference) <= tolerance


# Closed forms, written from the theory and not from the library.
def saturation(suction, e):
    if suction <= 0:
        return P["S_max"]
    ratio = suction * e ** P["Omega"] / P["P_a"]   # the e of e^Omega is the void ratio
    return P["S_min"] + (P["S_max"] - P["S_min"]) * math.log(math.e + ratio ** P["n_x"]) ** -P["m_x"]


def bonding(suction, e):
    t = max(suction, 0) / P["p_atm"]
    zeta = (1 - saturation(suction, e)) * (1 + t / (10.7 + 2.4 * t))
    return 1 - P["b_1"] * (1 - math.exp(P["b_2"] * zeta))


def critical_void_ratio(p, f=1.0):
    return P["N_c"] * f * (p + P["alpha_csl"]) ** -P["lambda"]


def steady_pressure(e):
    return (P["N_c"] / e) ** (1 / P["lambda"]) - P["alpha_csl"]


def line_pressure(e, f=1.0):
    return (P["N_l"] * f / e) ** (1 / P["lambda"])


def lode(cos3t):
    c4 = P["c"] ** 4
    return (2 * c4 / (1 + c4 - (1 - c4) * cos3t)) ** 0.25


# ---------------------------------------------------------------------------------------------------------------------
def steady_states(bench):
    claims = []
    for e in (0.735, 0.833, 0.907):
        p = steady_pressure(e)
        for way, strain in ((1, 0.10), (-1, -0.10)):
            q = way * P["M_c"] * (1 if way > 0 else P["c"]) * p
            run = bench.run_text(
                f"&material\n file = '{MATERIAL}'\n/\n&initial\n void_ratio = {e}\n sigma_a = {p + 2 * q / 3!r}\n"
                f" sigma_r = {p - q / 3!r}\n/\n&stage\n control = 'undrained'\n eps_a_end = {strain}\n/\n", "steady")
            word = "compression" if way > 0 else "extension"
            worst = max(max(abs(v / p - 1) for v in run["p_eff"]), max(abs(v / q - 1) for v in run["q"]))
            claims.append(claim(f"e {e}: a steady state stays one, {word}", worst, 0, 10 * TOLERANCE))
    for name in ("undrained_e735_p100", "undrained_e735_p3000", "undrained_e833_p100", "undrained_e833_p3000"):
        e = float(f"0.{name[11:14]}")
        run = bench.run(name, ((r"eps_a_end = \S+", "eps_a_end = 1.0"),))
        p = steady_pressure(e)
        claims.append(claim(f"{name} arrives, q [kPa]", run["q"][-1], P["M_c"] * p, 5e-4 * P["M_c"] * p))
    return claims


def draw_steady_states(bench, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for i, name in enumerate(("undrained_e735_p100", "undrained_e735_p3000", "undrained_e833_p100",
                              "undrained_e833_p3000")):
        run = bench.run(name, ((r"eps_a_end = \S+", "eps_a_end = 1.0"),))
        e = float(f"0.{name[11:14]}")
        axes[0].plot(run["eps_a"], run["q"], color=COLOURS[i], label=f"e {e}, from {name.split('_p')[1]} kPa")
        axes[1].plot(run["p_eff"], run["q"], color=COLOURS[i])
        p = steady_pressure(e)
        axes[0].axhline(P["M_c"] * p, color="black", ls=":", lw=1)
        axes[1].plot(p, P["M_c"] * p, "k*", ms=11)
    axes[0].plot([], [], "k:", label="closed form")
    axes[0].legend()
    axes[0].set(xlabel="axial strain, natural [-]", ylabel="q [kPa]", title="undrained compression to strain 1")
    axes[1].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="stars: p'$_c$, M$_c$p'$_c$")
    return figure


# ---------------------------------------------------------------------------------------------------------------------
def isotropic_reference(p, e, strain, steps=20000):
    """Runge-Kutta of 4th order on d ln p'/d eps_v = 1/(p'/K + A), the scalar form of isotropic compression."""
    def rate(ln_p, eps):
        p_now = math.exp(ln_p)
        e_now = (1 + e) * math.exp(-eps) - 1
        k = P["K_0"] * P["p_atm"] * (1 + e_now) / e_now * (p_now / P["p_atm"]) ** (2 / 3)
        delta = 1 - p_now / line_pressure(e_now)
        f = 1 - math.copysign(abs(delta) ** P["theta"], delta)
        kappa = p_now / k * (1 + e_now) / e_now
        a = e_now / (1 + e_now) * (P["lambda"] - kappa) * f
        return 1 / (p_now / k + max(a, 0))
    ln_p, d = math.log(p), strain / steps
    for i in range(steps):
        eps = i * d
        k1 = rate(ln_p, eps)
        k2 = rate(ln_p + d / 2 * k1, eps + d / 2)
        k3 = rate(ln_p + d / 2 * k2, eps + d / 2)
        k4 = rate(ln_p + d * k3, eps + d)
        ln_p += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return math.exp(ln_p)


def compression(bench):
    longer = (r"eps_v_end = \S+", "eps_v_end = 0.15")
    run = bench.run("isotropic_e8_p50", (longer,))
    claims = []
    for strain in (0.02, 0.06, 0.15):
        here = min(range(len(run["e"])), key=lambda i: abs(run["eps_v"][i] - strain))
        p = isotropic_reference(50.0, 0.8, strain)
        claims.append(claim(f"isotropic, p' at eps_v {strain} [kPa]", run["p_eff"][here], p, 10 * TOLERANCE * p))
    ratio = [p / line_pressure(e) for p, e in zip(run["p_eff"], run["e"])]
    claims.append(claim("isotropic: on the line at its end, p'/p'_line", ratio[-1], 1, 0.005))
    claims.append(claim("isotropic: the line is never crossed by more than", max(max(ratio) - 1, 0), 0, 1e-3))
    run = bench.run("oedometer_e8_p50", (longer,))
    here = min(range(len(run["e"])), key=lambda i: abs(run["eps_v"][i] - 0.06))
    claims.append(claim("oedometer, sigma_a at eps_v 0.06 [kPa]", run["sigma_a"][here], 16088.2, 5e-4 * 16088.2))
    claims.append(claim("oedometer, sigma_r at eps_v 0.06 [kPa]", run["sigma_r"][here], 5401.90, 5e-4 * 5401.9))
    claims.append(claim("oedometer: distance from the line at 0.06", k0_ratio(run)[here], 1.58, 0.005))
    return claims


def k0_ratio(run):
    """(p'/p'_line)(1 + 2 eta^2/M^2): 1 on the compression line."""
    return [p / line_pressure(e) * (1 + 2 * (q / p / P["M_c"]) ** 2) for p, q, e in zip(run["p_eff"], run["q"],
                                                                                       run["e"])]


def draw_compression(bench, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    for i, (name, label) in enumerate((("isotropic_e8_p50", "isotropic"), ("oedometer_e8_p50", "K0 (oedometer)"))):
        run = bench.run(name, ((r"eps_v_end = \S+", "eps_v_end = 0.15"),))
        axes[0].semilogx(run["p_eff"], run["e"], color=COLOURS[i], label=label)
        axes[1].plot([100 * v for v in run["eps_v"]], k0_ratio(run), color=COLOURS[i], label=label)
    e = [0.8 - 0.002 * i for i in range(130)]
    axes[0].semilogx([line_pressure(v) for v in e], e, "k--", lw=1, label="compression line, eq. (7)")
    axes[0].set(xlabel="p' [kPa], logarithmic", ylabel="e [-]", title="compression from 50 kPa", ylim=(0.52, 0.81))
    axes[1].axhline(1, color="black", ls="--", lw=1)
    axes[1].set(xlabel="volumetric strain [%]", ylabel=r"$(p'/\hat{\alpha})(1+2\eta^2/M^2)$", title="1: on the line")
    axes[0].legend()
    return figure


# ---------------------------------------------------------------------------------------------------------------------
def cycle_of(run):
    return int(run["cycle"][-1])


def liquefaction(bench):
    claims = []
    run = bench.run("cyclic_q_e833_p100")
    finer = bench.run("cyclic_q_e833_p100", ((r"increment = \S+", "increment = 2e-6"),
                                             (r"(?m)^   file = .*$", r"\g<0>\n   tolerance = 1e-8\n   scheme = 3")))
    claims.append(claim("cycles to r_u 0.95, by another integrator", cycle_of(run), cycle_of(finer), 0))
    claims.append(claim("strain there [-]", run["eps_a"][-1], finer["eps_a"][-1], 2e-3 * abs(finer["eps_a"][-1])))
    turns = [q for q in run["q"] if abs(abs(q) - 25) < 1]
    claims.append(claim("reversals at 25 kPa", max(abs(abs(q) - 25) for q in turns if abs(q) > 24.999), 0, 25e-7))
    claims.append(claim("r_u where it stops", run["r_u"][-1], 0.95, 0.01))
    shear = bench.run("cyclic_tau_e860_p100")
    last = [g for g, c in zip(shear["gamma_13"], shear["cycle"]) if c >= shear["cycle"][-1] - 1]
    claims.append(claim("simple shear stops at a double amplitude of", max(last) - min(last), 0.05, 5e-4))
    run = bench.run("cyclic_strain_e907_p100")
    p_min = 0.101325
    claims.append(claim("400 cycles of liquefied sand: all are done", cycle_of(run), 400, 0))
    claims.append(claim("p' falls to p_min and not below [kPa]", min(run["p_eff"]), p_min, 1e-9))
    eta = max(abs(q) / p for q, p in zip(run["q"], run["p_eff"]))
    bound = P["M_c"] * math.exp(-P["n_b"] * (0.907 - critical_void_ratio(p_min)))
    claims.append(claim("|q|/p' beyond the bounding surface", max(eta / bound - 1, 0), 0, 0.05))
    claims.append(claim("the void ratio stays", max(run["e"]) - min(run["e"]), 0, ROUNDING))
    return claims


def draw_liquefaction(bench, plt):
    figure, axes = plt.subplots(2, 3, figsize=(12, 7))
    run = bench.run("cyclic_q_e833_p100_mobility")
    axes[0, 0].plot(run["p_eff"], run["q"], color=COLOURS[0], lw=0.6)
    axes[0, 0].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="e 0.833, stress cycles of 25 kPa, 60 cycles")
    axes[1, 0].plot([100 * v for v in run["eps_a"]], run["q"], color=COLOURS[0], lw=0.4)
    axes[1, 0].set(xlabel="axial strain [%]", ylabel="q [kPa]", title="cyclic mobility", xlim=(-12, 1))
    run = bench.run("cyclic_tau_e860_p100")
    axes[0, 1].plot(run["sig_33"], run["sig_13"], color=COLOURS[1], lw=0.8)
    axes[0, 1].set(xlabel="vertical effective stress [kPa]", ylabel="shear stress [kPa]", title="e 0.86, simple shear")
    axes[1, 1].plot([100 * v for v in run["gamma_13"]], run["sig_13"], color=COLOURS[1], lw=0.8)
    axes[1, 1].set(xlabel="shear strain [%]", ylabel="shear stress [kPa]", title="to a double amplitude of 5 %")
    run = bench.run("cyclic_strain_e907_p100")
    axes[0, 2].plot(run["p_eff"], run["q"], color=COLOURS[2], lw=0.6)
    axes[0, 2].set(xlabel="p' [kPa]", ylabel="q [kPa]", title="e 0.907, strain cycles of 0.1 %, 400 cycles")
    axes[1, 2].semilogy(run["cycle"], run["p_eff"], ".", ms=1, color=COLOURS[2])
    axes[1, 2].set(xlabel="cycle", ylabel="p' [kPa], logarithmic", title="liquefied: p' near p_min")
    return figure


# ---------------------------------------------------------------------------------------------------------------------
def bonding_only(bench):
    claims = []
    run = bench.run("drying_constant_stress")
    claims.append(claim("drying at constant stress: strain", max(max(map(abs, run[k])) for k in ("eps_a", "eps_v")), 0,
                        0))
    psi = [e - critical_void_ratio(100.0, bonding(s, e)) for e, s in zip(run["e"], run["suction"])]
    claims.append(claim("drying at constant stress: state parameter", max(abs(a - b) for a, b in zip(psi, run["psi"])),
                        0, ROUNDING))
    run = bench.run("wetting_on_the_line")
    p = run["p_eff"][0]
    off, e = 0.0, run["e"][0]
    for suction, there in zip(run["suction"], run["e"]):
        for _ in range(60):   # e = N_l f(e, p_c) p'^-lambda, a contraction: f hardly depends on e
            e = P["N_l"] * bonding(suction, e) * p ** -P["lambda"]
        off = max(off, abs(there / e - 1))
    claims.append(claim("wetting on the line: it stays on the line, e/e_line", off, 0, 1e-4))
    e_end = P["N_l"] * p ** -P["lambda"]
    claims.append(claim("wetting on the line: void ratio when saturated", run["e"][-1], e_end, 1e-4 * e_end))
    return claims


def draw_bonding_only(bench, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    run = bench.run("wetting_on_the_line")
    p = run["p_eff"][0]
    line = []
    for suction, there in zip(run["suction"], run["e"]):
        e = there
        for _ in range(60):
            e = P["N_l"] * bonding(suction, e) * p ** -P["lambda"]
        line.append(e)
    axes[0].plot(run["suction"], run["e"], color=COLOURS[0], label="model")
    axes[0].plot(run["suction"], line, "k--", lw=1, label="closed form")
    axes[0].set(xlabel="suction [kPa]", ylabel="e [-]", title="wetting under constant effective stress, on the line")
    axes[0].invert_xaxis()
    axes[0].legend()
    run = bench.run("drying_constant_stress")
    axes[1].plot(run["suction"], run["psi"], color=COLOURS[0], label="model")
    axes[1].plot(run["suction"], [e - critical_void_ratio(100.0, bonding(s, e)) for e, s in zip(run["e"],
                                                                                               run["suction"])],
                 "k--", lw=1, label="closed form")
    axes[1].set(xlabel="suction [kPa]", ylabel="state parameter [-]", title="drying under constant effective stress")
    axes[1].legend()
    return figure


# ---------------------------------------------------------------------------------------------------------------------
def retention(bench):
    run = bench.run("drying_constant_volume")
    off = max(abs(s - saturation(p, e)) for s, p, e in zip(run["s_w"], run["suction"], run["e"]))
    claims = [claim("drying at constant volume: S_w", off, 0, ROUNDING)]
    run = bench.run("constant_water")
    off = max(abs(s - saturation(p, e)) for s, p, e in zip(run["s_w"], run["suction"], run["e"]))
    claims.append(claim("constant water content: S_w", off, 0, ROUNDING))
    water = [s * e for s, e in zip(run["s_w"], run["e"])]
    claims.append(claim("constant water content: S_w e over its start", max(abs(w / water[0] - 1) for w in water), 0,
                        1e-9))
    return claims


def draw_retention(bench, plt):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2))
    run = bench.run("drying_constant_volume")
    axes[0].semilogx(run["suction"][1:], run["s_w"][1:], color=COLOURS[0], label="model, e 0.8")
    for e, style in ((0.6, ":"), (0.8, "--"), (1.0, "-.")):
        axes[0].semilogx(run["suction"][1:], [saturation(s, e) for s in run["suction"][1:]], "k", ls=style, lw=1,
                         label=f"closed form, e {e}")
    axes[0].set(xlabel="suction [kPa], logarithmic", ylabel="S$_w$ [-]", title="retention curve, eqs (23), (24)")
    axes[0].legend()
    run = bench.run("constant_water")
    axes[1].plot(run["e"], run["s_w"], color=COLOURS[0], label="model")
    axes[1].plot(run["e"], [run["s_w"][0] * run["e"][0] / e for e in run["e"]], "k--", lw=1, label="S$_w$ e constant")
    axes[1].set(xlabel="e [-]", ylabel="S$_w$ [-]", title="constant water content, drained then isotropic")
    axes[1].legend()
    return figure


# ---------------------------------------------------------------------------------------------------------------------
RULES = ("uninterrupted", "as_published", "classic", "threshold", "repositioning", "resume")
# Theory page, section 7 and section 5: q at 0.10, at the turn, back at 0.10, at 0.105, 0.12, 0.15 [kPa].
FIG1 = {"uninterrupted": {0.105: 3015.6, 0.12: 3242.0, 0.15: 3492.1},
        "classic": {0.105: 2936.0, 0.12: 3139.7, 0.15: 3396.6},
        "threshold": {"at": 2920.0, "turn": 2845.0, "back": 2848.0, 0.105: 2943.1, 0.12: 3178.0, 0.15: 3456.4},
        "repositioning": {0.105: 2943.1}, "resume": {0.105: 3012.1}}


def fig1_table(bench, rule):
    run = bench.run(f"fig1_{rule}")
    last = run["stage"][-1]

    def q_at(strain, stage):
        here = [i for i, s in enumerate(run["stage"]) if s == stage]
        return run["q"][min(here, key=lambda i: abs(run["eps_a"][i] - strain))]
    values = {"at": q_at(0.10, 1)}
    if rule != "uninterrupted":
        values.update({"turn": q_at(0.09985, 2), "back": q_at(0.10, last)})
    return {**values, **{s: q_at(s, last) for s in (0.105, 0.12, 0.15)}}


def fig1(bench):
    claims = []
    for rule, marks in FIG1.items():
        values = fig1_table(bench, rule)
        claims += [claim(f"{rule}: q at {mark} [kPa]", values[mark], q, 2e-4 * q) for mark, q in marks.items()]
    sys.path.insert(0, str(HERE / "fig1"))
    import variants
    for switches, rule in ((({"interrupted": False}), "uninterrupted"), ({}, "classic")):
        q = variants.run(**switches, parts=1)[0]
        values = fig1_table(bench, rule)
        claims.append(claim(f"{rule}: q at 0.105 by the equations of triaxial space [kPa]", values[0.105], q[1],
                            2e-4 * q[1]))
    return claims


def draw_fig1(bench, plt):
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.6))
    for i, rule in enumerate(RULES):
        run = bench.run(f"fig1_{rule}")
        for axis in axes[:2]:
            axis.plot([100 * v for v in run["eps_a"]], run["q"], color=("black", *COLOURS)[i],
                      label=rule.replace("_", " "), ls=("-", "--", "-", "-.", ":", "--")[i], lw=(1.8, 1, 1.2, 1.4, 1.8, 1.4)[i])
    axes[0].set(xlabel="axial strain [%]", ylabel="q [kPa]", xlim=(0, 15), ylim=(0, 3600), title="the whole test")
    axes[1].set(xlabel="axial strain [%]", ylabel="q [kPa]", xlim=(9.97, 10.6), ylim=(2820, 3040),
                title="the reversal of 0.015 % at 10 %")
    axes[1].legend()
    rows = list(csv.DictReader((HERE / "fig1" / "variants.csv").read_text(encoding="utf-8").splitlines()))
    names = [row["variant"] for row in rows]
    jumps = [float(row["jump_0.105_pct"]) for row in rows]
    axes[2].barh(range(len(rows)), jumps, color=[COLOURS[1] if j > 0 else COLOURS[0] for j in jumps])
    axes[2].set_yticks(range(len(rows)), names)
    axes[2].invert_yaxis()
    axes[2].axvline(0, color="black", lw=0.8)
    axes[2].set(xlabel="q at 10.5 % against the variant's own\nuninterrupted path [%]",
                title="variants of the untreated rule")
    return figure


# ---------------------------------------------------------------------------------------------------------------------
PAGES = {"fig1": (fig1, draw_fig1), "steady_states": (steady_states, draw_steady_states),
         "compression": (compression, draw_compression),
         "liquefaction": (liquefaction, draw_liquefaction), "bonding": (bonding_only, draw_bonding_only),
         "retention": (retention, draw_retention)}
COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE", help=", ".join(PAGES))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "verification")
    parser.add_argument("--check", action="store_true", help="numbers only")
    options = parser.parse_args()
    wrong = [page for page in options.pages if page not in PAGES]
    if wrong:
        parser.error(f"no page {wrong[0]}; there are {', '.join(PAGES)}")
    bench = Bench(options.build.resolve())
    failed = 0
    for page in options.pages or PAGES:
        print(f"{page}:")
        for name, value, reference, tolerance, good in PAGES[page][0](bench):
            failed += not good
            print(f"   {'ok    ' if good else 'FAILED'} {name}: {value:.8g}, reference {reference:.8g}, "
                  f"off {value - reference:+.2g}, allowed {tolerance:.2g}")
        if not options.check:
            import matplotlib
            matplotlib.use("Agg")
            import matplotlib.pyplot as plt
            plt.rcParams.update({"savefig.dpi": 90, "font.size": 9, "axes.titlesize": 10, "axes.grid": True,
                                 "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
                                 "legend.frameon": False, "figure.constrained_layout.use": True})
            options.output.mkdir(parents=True, exist_ok=True)
            figure = PAGES[page][1](bench, plt)
            figure.savefig(options.output / f"{page}.png")
            print(f"   picture {options.output / f'{page}.png'}")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
