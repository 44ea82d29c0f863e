# SPDX-License-Identifier: MIT
"""Seepage faces and rain of mud_host: a rectangular dam (Charny, Baiocchi), rain on a column (Srivastava and Yeh) and past
ponding (finite differences), drawdown of a slope (volumes)."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="a boundary that lets water out only, and rain that runs off where the surface ponds: discharge and exit point "
          "of a dam, infiltration, time of ponding and run-off of a column, volumes of a slope",
    kind="exact",
    input="`dam.nml`: 16 m wide, 24 m of water against none and 4 m, cells of 1 m; `rain.nml`: 1 m above a water table, 40 "
          "cells, steps of 50 s, rain of 0.9 and 1.5 times K_s; `slope.nml`: 1:1.5, 4 m, emptied in a day",
    reference="Charny's discharge; Baiocchi's variational inequality; the series of Srivastava and Yeh (1991); finite "
              "differences of the linear equation that it solves, with the pressure held; volumes",
    seconds=35, quick=35, pictures=("seepage_face.png",))
MAKES = (Script("make_mesh.py", ("slope.msh", "curve.txt"), 1),)

WIDTH, HIGH = 16.0, 24.0
CONDUCTIVITY = 1e-5   # of dam and column [m/s]
FRINGE = Tolerance("the capillary fringe of 0.1 m carries some of the flow: half a per cent", relative=5e-3)
FIRST = Tolerance("the identity is exact for the field; the host's has cells of 1 m", relative=1e-3)
CELL = Tolerance("a cell of the host", absolute=1.0)
STEADY = Tolerance("what flows in flows out, up to Newton's tolerance", relative=1e-5)
LIMIT = Tolerance("a pressure stands at its limit or below", absolute=1e-6)
STEPS = Tolerance("one first-order step of 50 s of some 9000 s, and 40 cells; K/K_s lies between 0 and 1", absolute=5e-3)
LATEST = Tolerance("rain begins to run off within two steps of 50 s", absolute=100.0)
RATE = Tolerance("first order in the step of 50 s; of the rain", absolute=0.02)
VOLUME = Tolerance("the ledger's outflow is what is missing inside, whatever the steps; small strains, and Newton's tolerance", absolute=2e-4)


def dam_height(low, cells):
    """Height of the free surface one column before the low side, by Baiocchi's w = int_z p: w'' = 1 where w > 0 [m]."""
    h = WIDTH / cells
    z = np.linspace(0, HIGH, round(HIGH / h) + 1)
    w = np.zeros((cells + 1, z.size))
    w[0] = (HIGH - z) ** 2 / 2
    w[-1] = np.where(z < low, (low - z) ** 2 / 2, 0)
    w[:, 0] = HIGH**2 / 2 - (HIGH**2 - low**2) / 2 * np.linspace(0, 1, cells + 1)
    over = 2 / (1 + np.sin(np.pi * h / HIGH))
    colour = np.add.outer(np.arange(1, cells), np.arange(1, z.size - 1)) % 2
    for _ in range(12 * cells):
        for c in (0, 1):
            inner = w[1:-1, 1:-1]
            mean = (w[2:, 1:-1] + w[:-2, 1:-1] + w[1:-1, 2:] + w[1:-1, :-2] - h * h) / 4
            inner[colour == c] = np.maximum(0, inner + over * (mean - inner))[colour == c]
    column = w[-2]
    last = np.flatnonzero(column > 0)[-1]
    return z[last] + np.sqrt(2 * column[last])


def exit_height(low):
    """The limit of ever smaller cells: what the last halving changed, once more."""
    return 2 * dam_height(low, 128) - dam_height(low, 64)


def potential(p):
    """int_0^p of k_rw, the curve of dam.nml [kPa]."""
    grid = np.linspace(0, 1, 2001)
    x = np.outer(np.minimum(p, 0), grid)
    k = np.maximum(1e-4, (1 + (-x) ** 3) ** (-2 / 3 * 3))
    return np.where(p > 0, p, np.minimum(p, 0) * np.sum((k[:, 1:] + k[:, :-1]) / 2, axis=1) / 2000)


def check_dam(bench):
    out = bench.host("dam.nml")
    found = {}
    for stage, low in (("empty", 0.0), ("tail", 4.0)):
        row = tables.columns(out / f"reactions_{stage}.csv")
        nodes = tables.columns(out / f"nodes_{stage}.csv")
        flow = row["right.outflow_w"][-1]
        exact = CONDUCTIVITY * (HIGH**2 - low**2) / (2 * WIDTH)
        bench.near(f"dam, {low:g} m below: discharge", flow, exact, FRINGE, "m2/s")
        bench.near(f"dam, {low:g} m below: what enters", -row["left.outflow_w"][-1], flow, STEADY, "m2/s")
        sums = []
        for x in (0.0, WIDTH):
            on = np.flatnonzero(np.isclose(nodes["r"], x))
            on = on[np.argsort(nodes["z"][on])]
            sums.append(np.trapezoid(potential(nodes["p_w"][on]), nodes["z"][on]))
        bench.near(f"dam, {low:g} m below: discharge with that of the fringe", flow,
                   1e-6 * (sums[0] - sums[1]) / WIDTH, FIRST, "m2/s")
        p, z = nodes["p_w"][on], nodes["z"][on]
        found[low] = (z, p)
        bench.below(f"dam, {low:g} m below: pressure above its limit", np.max(p - np.maximum(0, 10 * (low - z))), LIMIT, "kPa")
        bench.near(f"dam, {low:g} m below: exit point", z[p > -1e-6].max(), exit_height(low), CELL, "m")
    return found


ALPHA, SHARE = 2.0, 0.4   # of rain.nml: K = K_s exp(ALPHA h), theta from 0.1 to 0.5


def roots(length, count=300):
    """Of tan(x length) + 2 x = 0."""
    low = (np.arange(count) + 0.5) * np.pi / length + 1e-12
    high = (np.arange(count) + 1.0) * np.pi / length
    for _ in range(70):
        middle = (low + high) / 2
        left = (np.sin(low * length) + 2 * low * np.cos(low * length)) * \
            (np.sin(middle * length) + 2 * middle * np.cos(middle * length)) <= 0
        low, high = np.where(left, low, middle), np.where(left, middle, high)
    return (low + high) / 2


LENGTH = ALPHA * 1.0
ROOTS = roots(LENGTH)


def series(z, time, after):
    """K/K_s at the height z [m] and the time [s] after the rain changes from 0.1 to `after` K_s."""
    big_z, big_t = ALPHA * z, ALPHA * CONDUCTIVITY * np.atleast_1d(time) / SHARE
    terms = np.sin(ROOTS * big_z) * np.sin(ROOTS * LENGTH) / (1 + LENGTH / 2 + 2 * ROOTS**2 * LENGTH)
    total = np.exp(-np.outer(big_t, ROOTS**2)) @ terms
    return after - (after - 1) * np.exp(-big_z) - 4 * (after - 0.1) * np.exp((LENGTH - big_z) / 2 - big_t / 4) * total


def run_off(times, rain, cells=400):
    """Share of K_s that runs off, by implicit differences of K_T = K_ZZ + K_Z with K <= 1 at the surface."""
    h = LENGTH / cells
    z = np.linspace(0, LENGTH, cells + 1)
    k = 0.1 + 0.9 * np.exp(-z)
    scale = ALPHA * CONDUCTIVITY / SHARE
    step, now, out, wet = 2e-5, 0.0, [], False

    def matrix(held):
        a = np.diag(np.full(cells + 1, 1 + 2 * step / h**2))
        i = np.arange(1, cells)
        a[i, i + 1], a[i, i - 1] = -step / h**2 - step / (2 * h), -step / h**2 + step / (2 * h)
        a[0], a[-1] = 0, 0
        a[0, 0] = 1
        if held:
            a[-1, -1] = 1
        else:   # half a cell: storage = rain - flux below
            a[-1, -1] = h / 2 + step * (1 / h + 0.5)
            a[-1, -2] = -step * (1 / h - 0.5)
        return np.linalg.inv(a)

    free, held = matrix(False), matrix(True)
    for t in times:
        while now < t * scale - 1e-12:
            b = k.copy()
            b[-1] = 1 if wet else h / 2 * k[-1] + step * rain
            k = (held if wet else free) @ b
            wet = wet or k[-1] >= 1
            now += step
        flux = (1 - k[-2]) / h + (1 + k[-2]) / 2
        out.append(rain - flux if wet else 0.0)
    return np.array(out)


def check_rain(bench):
    out = bench.host("rain.nml")
    history = tables.columns(out / "histories.csv")
    now = history["time"] > 1e9 + 1.0
    time = history["time"][now] - 1e9
    curves = {}
    for name, z in (("top", 1.0), ("middle", 0.5)):
        k = np.exp(ALPHA / 10 * history[f"{name}.p_w"][now])
        curves[name] = (time, k, series(z, time, 0.9))
        late = time >= 1000
        bench.near(f"rain of 0.9 K_s: K/K_s at {z:g} m from 1000 s on", k[late], series(z, time[late], 0.9), STEPS)
    out = bench.host("rain.nml", [("value = 9e-6", "value = 1.5e-5")])
    row = tables.columns(out / "reactions_wet.csv")
    time = row["time"] - 1e9
    begin, end = 1.0, 1e5
    for _ in range(50):
        middle = (begin + end) / 2
        begin, end = (middle, end) if series(1.0, middle, 1.5)[0] < 1 else (begin, middle)
    bench.near("rain of 1.5 K_s: first run-off", time[np.flatnonzero(row["top.at_limit"] > 0)[0]], begin, LATEST, "s")
    off = row["top.outflow_w"] / (0.1 * CONDUCTIVITY)
    wanted = run_off(time[9::10], 1.5)
    bench.near("rain of 1.5 K_s: run-off over K_s, from a tenth of an hour after ponding",
               off[9::10][time[9::10] > begin + 360], wanted[time[9::10] > begin + 360], RATE)
    bench.near("rain of 1.5 K_s: nothing runs off before", off[time < begin - 100], 0.0, LIMIT)
    return curves, (time, off, wanted)


def water(out, stage):
    """Volume of water in the body [m2]."""
    points = tables.columns(out / f"points_{stage}.csv")
    return np.sum(points["weight"] * points["S_w"] * points["e"] / (1 + points["e"]))


def check_volumes(bench):
    out = bench.host("slope.nml")
    ledger = tables.columns(out / "ledger.csv")
    left = ledger["outflow"][-1] - ledger["outflow_air"][-1]
    row, whole = tables.columns(out / "reactions_drain.csv"), water(out, "rest")
    lost = whole - water(out, "drain")
    bench.near("slope: water that left through the face, over all its water", left / whole, lost / whole, VOLUME)
    bench.below("slope: water that enters through the face", -np.min(row["slope.outflow_w"]) / np.max(row["slope.outflow_w"]), LIMIT)
    nodes = tables.columns(out / "nodes_drain.csv")
    face = np.isclose(nodes["r"], 12 - 1.5 * nodes["z"])
    bench.below("slope: pressure on the face", np.max(nodes["p_w"][face]), LIMIT, "kPa")
    bench.note(f"slope: {lost:.3g} m2 of water left of {whole:.3g}")


def check(bench):
    """What the picture shows."""
    found = check_dam(bench), *check_rain(bench)
    check_volumes(bench)
    return found


def draw(bench, found, plt):
    faces, curves, past = found
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.2), layout="constrained")
    for low, (z, p) in faces.items():
        axes[0].plot(p, z, label=f"host, {low:g} m outside")
        axes[0].axhline(exit_height(low), ls=":", lw=1, c="0.4")
    axes[0].set(xlabel="p_w on the low side [kPa]", ylabel="z [m]", title="Dam; dotted: exit points", xlim=(-40, 45))
    for name, (time, k, wanted) in curves.items():
        axes[1].plot(time / 3600, wanted, lw=1, label=f"series, {name}")
        axes[1].plot(time[::20] / 3600, k[::20], "o", ms=3, label=f"host, {name}")
    axes[1].set(xlabel="time [h]", ylabel="K/K_s", title="Rain of 0.9 K_s")
    time, off, wanted = past
    axes[2].plot(time[9::10] / 3600, wanted, lw=1, label="finite differences")
    axes[2].plot(time[9::10] / 3600, off[9::10], "o", ms=3, label="host")
    axes[2].set(xlabel="time [h]", ylabel="run-off/K_s", title="Rain of 1.5 K_s")
    for axis in axes:
        axis.legend(fontsize=8)
    bench.save(figure, "seepage_face.png")
