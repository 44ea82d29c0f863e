#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The figures of docs/theory, of the library and the default parameters: figures.py [FOLDER], default docs/theory/figures.

Curves that the library integrates (retention, compression) are paths of its updates; surfaces are the formulas of
material.md at the values of the registry; the elastic domain and a mortar segment are drawings.
"""
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "verification"), str(ROOT / "python")]
import mud  # noqa: E402 (its folder is known only now)
from tools.pictures import COLOURS, pyplot  # noqa: E402

BLUE, RED, GREEN = COLOURS[:3]
GREY = "#888888"


def lode_factor(cos_3theta, c):
    """material.md section 3.4."""
    return (2*c**4/(1 + c**4 - (1 - c**4)*cos_3theta))**0.25


def surfaces(plt, folder):
    """Critical, bounding and dilatancy ratios of dense sand (psi = -0.1): in p', q and in the deviatoric plane."""
    sand = mud.Material()
    psi, m_c, c = -0.1, sand["M_c"], sand["c"]
    ratios = (("bounding $M^b$", m_c*np.exp(max(-sand["n_b"]*psi, 0)), BLUE), ("critical $M_c$", m_c, GREY),
              ("dilatancy $M^d$", m_c*np.exp(sand["n_d"]*psi), RED))
    figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.6))
    angle = np.linspace(0, 2*np.pi, 361)
    for name, ratio, colour in ratios:
        left.plot([0, 100], [0, 100*ratio], color=colour, label=name)
        left.plot([0, 100], [0, -100*c*ratio], color=colour)
        size = np.sqrt(2/3)*ratio*lode_factor(np.cos(3*(angle - np.pi/2)), c)
        right.plot(size*np.cos(angle), size*np.sin(angle), color=colour)
    left.set(xlabel="p' [kPa]", ylabel="q [kPa]", title="triaxial plane, $\\psi = -0.1$")
    left.legend()
    for place in np.pi/2 + np.arange(3)*2*np.pi/3:
        right.plot([0, 1.3*np.cos(place)], [0, 1.3*np.sin(place)], color=GREY, linewidth=0.6)
    right.text(0.05, 1.25, "$r_1$: compression")
    right.set(title="deviatoric plane of stress ratios", aspect="equal", xticks=[], yticks=[])
    figure.savefig(folder / "surfaces.svg", metadata={"Date": None})


def oedometer(sand, e_0, largest):
    """(p' [kPa], e) of one-dimensional compression from 20 kPa to a mean stress."""
    stress, state = sand.initial_state(-20.0*np.array([1, 1, 1, 0, 0, 0]), 0.0, e_0)
    place = mud.states["void_ratio"].index
    rows = [(20.0, e_0)]
    while rows[-1][0] < largest:
        answer = sand.update(stress, state, np.array([0, 0, -2.0e-4*(1 + rows[-1][0]/2000), 0, 0, 0]))
        stress, state = answer.stress, answer.statev
        rows.append((-stress[:3].mean(), state[place]))
    return np.array(rows).T


def compression(plt, folder):
    """One-dimensional compression from three void ratios, towards the limiting compression line."""
    sand = mud.Material()
    figure, axes = plt.subplots(figsize=(4.6, 3.6))
    p = np.geomspace(20, 30000, 200)
    axes.loglog(p, sand["N_l"]*p**-sand["lambda"], color=RED, label="compression line")
    axes.loglog(p, sand["N_c"]*(p + sand["alpha_csl"])**-sand["lambda"], color=GREY, label="critical state line")
    for e_0, style in ((0.65, "-"), (0.75, "--"), (0.85, "-.")):
        axes.loglog(*oedometer(sand, e_0, 20000.0), style, color=BLUE, label=f"$e_0$ = {e_0}")
    axes.set(xlabel="p' [kPa]", ylabel="void ratio e", ylim=(0.35, 1.0), title="saturated, one-dimensional compression")
    axes.set_yticks([0.4, 0.5, 0.6, 0.8, 1.0], ["0.4", "0.5", "0.6", "0.8", "1.0"])
    axes.minorticks_off()
    axes.legend()
    figure.savefig(folder / "compression.svg", metadata={"Date": None})


def scan(sand, start, suctions):
    """S_w along suctions, from a suction and a degree of saturation (None: main drying curve)."""
    stress, state = sand.initial_state(-100.0*np.array([1, 1, 1, 0, 0, 0]), suctions[0], 0.7, start)
    place, found = mud.states["saturation"].index, []
    for suction in suctions:
        answer = sand.update(stress, state, np.zeros(6), suction)
        stress, state = answer.stress, answer.statev
        found.append(state[place])
    return found


def retention(plt, folder):
    """Main curves of a sand and scanning branches between them."""
    sand = mud.Material(ROOT / "drivers/materials/hostun_hysteresis.nml")
    figure, axes = plt.subplots(figsize=(4.6, 3.6))
    up = np.geomspace(0.05, 20, 250)
    axes.semilogx(up, scan(sand, None, up), color=BLUE, label="main drying")
    down = up[::-1]
    dry = scan(sand, None, np.concatenate((up, down)))[len(up):]
    axes.semilogx(down, dry, color=RED, label="wetting from 20 kPa")
    for turn, back in ((2.2, 0.4), (3.0, 0.8)):
        loop = np.concatenate((np.geomspace(0.05, turn, 150), np.geomspace(turn, back, 150), np.geomspace(back, turn, 150)))
        axes.semilogx(loop[150:], scan(sand, None, loop)[150:], color=GREEN,
                      label="scanning" if turn < 3 else None)
    axes.set(xlabel="suction $p_c$ [kPa]", ylabel="degree of saturation $S_w$", title="Hostun sand, constant void ratio")
    axes.legend()
    figure.savefig(folder / "retention.svg", metadata={"Date": None})


def elastic_domain(plt, folder):
    """The ball in strain space: inside it the response is elastic, at its rim it is carried along."""
    figure, axes = plt.subplots(figsize=(4.6, 3.0))
    turn = np.linspace(0, 2*np.pi, 200)
    for x, y, colour, style in ((0.0, 0.0, GREY, "--"), (1.7, 0.55, BLUE, "-")):
        axes.plot(x + np.cos(turn), y + np.sin(turn), style, color=colour)
        axes.plot([x], [y], "o", color=colour, markersize=3)
    path = np.array([[0.0, 0.0], [0.95, 0.31], [2.65, 0.86], [2.1, 0.2], [2.3, 0.9]])
    axes.plot(*path[:3].T, color=RED)
    axes.plot(*path[2:].T, ":", color=RED)
    axes.annotate("", path[2], path[1], arrowprops={"arrowstyle": "->", "color": RED})
    axes.text(-0.95, 1.15, "before: centre at rest", color=GREY)
    axes.text(1.2, 1.7, "after: centre carried along", color=BLUE)
    axes.text(2.75, 0.85, "strain")
    axes.text(1.15, 0.1, "$\\mathbf{d}$, $|\\mathbf{d}| \\leq \\rho_e$")
    axes.annotate("", path[2], (1.7, 0.55), arrowprops={"arrowstyle": "->", "color": BLUE})
    axes.text(1.35, -0.75, "inside: elastic, in any direction")
    axes.set(aspect="equal", xticks=[], yticks=[], xlim=(-1.3, 3.6), ylim=(-1.2, 2.0))
    axes.grid(False)
    figure.savefig(folder / "elastic_domain.svg", metadata={"Date": None})


def segment(plt, folder):
    """One slave edge and the segments that its middle node and the master's nodes cut."""
    figure, axes = plt.subplots(figsize=(6.4, 2.6))

    def slave(s):
        return np.array([s, 0.12*(s - 1)**2 + 0.05])

    def master(x):
        return np.array([x, -0.55 + 0.06*(x - 1.3)**2])

    fine = np.linspace(0, 2, 60)
    axes.plot(*slave(fine), color=BLUE)
    axes.plot(*slave(np.array([0, 1, 2])), "o", color=BLUE)
    wide = np.linspace(-0.3, 2.5, 80)
    nodes = np.array([-0.3, 0.45, 1.3, 2.5])
    axes.plot(*master(wide), color=RED)
    axes.plot(*master(nodes), "s", color=RED)
    cuts = np.array([0, 0.45, 1.0, 1.3, 2.0])
    for cut in cuts:
        axes.plot([cut, cut], [slave(cut)[1], master(cut)[1]], ":", color=GREY)
    points, _ = np.polynomial.legendre.leggauss(4)
    for a, b in zip(cuts, cuts[1:]):
        for s in (a + b)/2 + points*(b - a)/2:
            axes.plot(*slave(s), "|", color="black", markersize=7)
    axes.annotate("", (0.72, master(0.72)[1]), (0.72, slave(0.72)[1]), arrowprops={"arrowstyle": "<->"})
    axes.text(0.75, -0.25, "gap g")
    axes.text(2.05, 0.2, "slave, middle node included", color=BLUE)
    axes.text(2.05, -0.4, "master", color=RED)
    axes.set(xticks=[], yticks=[], xlim=(-0.4, 3.3), ylim=(-0.75, 0.4),
             title="four segments, four Gauss points (|) on each")
    axes.grid(False)
    figure.savefig(folder / "segment.svg", metadata={"Date": None})


FIGURES = (surfaces, compression, retention, elastic_domain, segment)


def main(folder):
    plt = pyplot()
    plt.rcParams.update({"svg.hashsalt": "mud", "svg.fonttype": "none"})
    folder.mkdir(parents=True, exist_ok=True)
    for figure in FIGURES:
        figure(plt, folder)
        plt.close("all")
        kept = folder / f"{figure.__name__}.svg"   # one line: nobody reads it
        kept.write_text(" ".join(kept.read_text(encoding="utf-8").split()) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/theory/figures")
