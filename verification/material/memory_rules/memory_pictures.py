# SPDX-License-Identifier: MIT
"""Pictures of the page: what every rule does with loops, cycles and noise."""
from battery import parse_rule
from memory_published import biased_path, noise_path
from point_steps import ACROSS, AXIAL, DENSE, LOOSE, MIDDLE, increments, straight, times
from point_walk import Path
from tools.pictures import COLOURS

NAMES = ("classic", "threshold", "repositioning", "return_point")
STYLES = dict(zip(NAMES, (("#777777", "--"), (COLOURS[2], "-."), (COLOURS[4], ":"), (COLOURS[1], "-"))))
RADII = ("0", "2e-5")


def label(name):
    return name.replace("_", " ")


def soils(radius):
    return {name: parse_rule(f"{name}:{radius}") for name in NAMES}


def traced(path, size, direction, step):
    """A straight step with a row at every increment."""
    n = increments(size, step)
    for _ in range(n):
        path.go(1, times(size / n, direction)).row()
    return path


def loop(soil, e, place, size, then):
    """Rows around a loop, from `then` before it."""
    path = straight(Path(soil, e), place - then).row()
    traced(path, then, AXIAL, then / 60)
    if size:
        traced(traced(path, -size, AXIAL, size / 30), size, AXIAL, size / 30)
    return traced(path, then, AXIAL, then / 120)


def draw_loops(walker, plt):
    size, then = 1.5e-4, 1e-3
    places = [(e, place) for e in (DENSE, LOOSE) for place in (0.01, 0.10)]
    figure, axes = plt.subplots(2, 4, figsize=(14, 7))
    for line, radius in zip(axes, RADII):
        for axis, (e, place) in zip(line, places):
            runs = walker.run_all({"uninterrupted": loop(parse_rule(f"classic:{radius}"), e, place, 0.0, then),
                                   **{name: loop(soil, e, place, size, then) for name, soil in soils(radius).items()}})
            for name, rows in runs.items():
                colour, style = STYLES.get(name, ("black", "-"))
                axis.plot([100 * r["strain"][0] for r in rows], [r.q for r in rows], style, color=colour, label=label(name),
                          lw=2.2 if name == "uninterrupted" else 1.3, alpha=0.35 if name == "uninterrupted" else 1)
            axis.set(title=f"e {e} at {100 * place:g} %, rho_e {radius}", xlabel="axial strain [%]")
        line[0].set_ylabel("q [kPa]")
    axes[0, 0].legend(loc="upper left")
    return figure


def draw_symmetric(walker, plt, amplitude=1e-4, shown=(1, 100, 300)):
    figure, axes = plt.subplots(2, 4, figsize=(14, 6.4), sharex=True)
    for line, radius in zip(axes, RADII):
        runs = walker.run_all({name: symmetric_cycles(soil, amplitude, shown) for name, soil in soils(radius).items()})
        for axis, (name, rows) in zip(line, runs.items()):
            for i, colour in zip(shown, (COLOURS[0], COLOURS[2], COLOURS[1])):
                part = [r for r in rows if r["label"] == str(i)]
                axis.plot([1e4 * r["strain"][3] for r in part], [r["stress"][3] for r in part], color=colour, label=f"cycle {i}")
            axis.set(title=f"{label(name)}, rho_e {radius}")
        line[0].set_ylabel("shear stress [kPa]")
    for axis in axes[1]:
        axis.set_xlabel("shear strain [1e-4]")
    axes[0, 0].legend()
    return figure


def symmetric_cycles(soil, amplitude, shown):
    """Drained simple shear of +-amplitude; rows along the cycles `shown`."""
    path = Path(soil, MIDDLE).lead("ssseee").go(10, times(amplitude, ACROSS))
    for i in range(1, max(shown) + 1):
        if i in shown:
            path.row(str(i))
        for size in (-2 * amplitude, 2 * amplitude):
            for _ in range(20):
                path.go(1, times(size / 20, ACROSS))
                if i in shown:
                    path.row(str(i))
    return path


def draw_biased(walker, plt, cycles=1000):
    write = sorted({round(10 ** (k / 8)) for k in range(8 * 3 + 1)})
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True)
    for axis, radius in zip(axes, RADII):
        runs = walker.run_all({name: biased_path(soil, 50, 2, cycles, write) for name, soil in soils(radius).items()})
        for name, rows in runs.items():
            done = [r for r in rows if not r["failed"]]
            start = done[0]["strain"][0]
            colour, style = STYLES[name]
            axis.loglog([int(r["label"]) for r in done[1:]], [max(100 * (r["strain"][0] - start), 1e-5) for r in done[1:]], style,
                        color=colour, label=label(name), lw=1.6)
        axis.set(title=f"drained triaxial, q = 50 +- 2 kPa, rho_e {radius}", xlabel="cycle")
    axes[0].set_ylabel("axial strain since the first cycle [%]")
    axes[0].legend()
    return figure


def draw_noise(walker, plt, size=5e-5):
    figure, axes = plt.subplots(2, 2, figsize=(10, 7.4), sharex=True)
    for line, radius in zip(axes, RADII):
        for axis, e in zip(line, (DENSE, LOOSE)):
            clean = traced(Path(parse_rule(f"classic:{radius}"), e), 0.05, AXIAL, 2.5e-4)
            runs = walker.run_all({"without noise": clean, **{name: shown(noise_path(soil, e, size, 1)) for name, soil in soils(radius).items()}})
            for name, rows in runs.items():
                colour, style = STYLES.get(name, ("black", "-"))
                axis.plot([100 * r["strain"][0] for r in rows], [r.q for r in rows], style, color=colour, label=label(name),
                          lw=2.4 if name == "without noise" else 1.2, alpha=0.35 if name == "without noise" else 1)
            axis.set(title=f"e {e}, rho_e {radius}")
        line[0].set_ylabel("q [kPa]")
    for axis in axes[1]:
        axis.set_xlabel("axial strain [%]")
    axes[0, 0].legend()
    return figure


def shown(path):
    """A row after every step forward: the path without its reversals."""
    lines = []
    for line in path.lines:
        lines.append(line)
        if line.startswith("go ") and float(line.split()[2]) > 0:
            lines.append("row along")
    path.lines = lines
    return path
