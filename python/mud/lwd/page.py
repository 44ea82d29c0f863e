# SPDX-License-Identifier: MIT
"""Picture and page of a test."""

from __future__ import annotations

import base64
import html
import pathlib

import numpy as np

from ..errors import InputError
from ..host import HostRun
from ..plots import COLOURS, LINES, pyplot, style
from .device import record_of
from .ground import Test, point_of
from .measure import Measured, unit_of

SPLIT = ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5])  # a 6-node triangle as four of three nodes
SHOWN = 0.02  # force above which a record and a pulse begin [share of the peak]


@style()
def picture(measured: Measured, path: pathlib.Path, record: str | None = None) -> list[str]:
    """Sketch, last drop against time, pressures, drops, the ground at the peak. Returns what a record shows."""
    plt = pyplot()
    figure, axes = plt.subplots(2, 3, figsize=(12, 7.2), constrained_layout=True)
    _sketch(axes[0, 0], measured.test)
    told = _last_drop(axes[0, 1], measured, record)
    _pressures(axes[0, 2], measured)
    _drops(axes[1, 0], measured)
    _profile(axes[1, 1], measured)
    _field(figure, axes[1, 2], measured)
    figure.savefig(path, dpi=130)
    plt.close(figure)
    return told


def _sketch(axes, test: Test):
    a, device = test.device.radius, test.device
    down = min(test.depth, 8 * a)
    top = 0.0
    for i, layer in enumerate(test.layers):
        low = min(top + layer.thickness, down)
        axes.fill_between([0, 4 * a], -top, -low, color="0.93" if i % 2 == 0 else "0.85", lw=0)
        name = pathlib.Path(layer.material).stem if not layer.elastic else "elastic"
        axes.text(3.9 * a, -(top + low) / 2, f"{name}\ne = {layer.void_ratio:g}", ha="right", va="center", fontsize=8)
        top = low
    axes.fill_between([0, a], 0, 0.25 * a, color="0.3", lw=0)
    axes.annotate("", (0.5 * a, 0.3 * a), (0.5 * a, 1.9 * a), arrowprops={"arrowstyle": "-|>", "color": "k"})
    pulse = f"{device.largest:.3g} kN\n" + ("recorded" if device.record else f"half sine of {1e3 * device.pulse:g} ms")
    if device.buffer:
        pulse = f"{1e3 * device.fall_mass:g} kg from {device.fall:g} m\non {device.buffer:g} kN/m"
    axes.text(0.75 * a, 1.1 * a, f"{device.name}: {pulse}", fontsize=8, va="center")
    if test.water_table is not None and test.water_table < down:
        axes.axhline(-test.water_table, color=COLOURS[0], ls="--", lw=1)
        axes.text(0.1 * a, -test.water_table, "water table", fontsize=8, va="bottom", color=COLOURS[0])
    elif test.wet:
        water = f"water table {test.water_table:g} m below" if test.suction is None else f"suction {test.suction:g} kPa"
        axes.text(0.1 * a, -down, water, fontsize=8, va="bottom", color=COLOURS[0])
    if test.rain:
        axes.text(4 * a, 1.9 * a, f"rain {test.rain:g} mm/h, {test.rain_hours:g} h", fontsize=8, ha="right", va="top")
    axes.set(xlim=(0, 4 * a), ylim=(-down, 2 * a), xlabel="r [m]", ylabel="z [m]", title="input")


def _last_drop(axes, measured: Measured, record):
    test, history = measured.test, measured.answers.history
    start = test.starts[-1]
    seen = history["time"] >= start - 1e-9
    t = 1e3 * (history["time"][seen] - start)
    force, s = history["force"][seen], 1e3 * (history["deflection"][seen] - history["deflection"][seen][0])
    for name, values, factor, line, colour in (
        ("force [kN]", force, 1.0, LINES[1], COLOURS[5]),
        ("deflection [mm]", s, 1e3, LINES[0], COLOURS[0]),
    ):
        axes.plot(t, values, line, color=colour, label=name)
        _band(axes, t, values, factor * measured.band(name.split()[0], start).total[seen], colour)
    told = []
    if record:
        own = record_of(record)
        begin = own["time"][0]
        if "force" in own:
            begin = own["time"][np.argmax(own["force"] > SHOWN * own["force"].max())]
            axes.plot(own["time"] - begin, own["force"], ":", color="k", lw=1)
            told.append(f"force: record {own['force'].max():.4g} kN, computed {force.max():.4g} kN at the peak")
        if "deflection" in own:
            axes.plot(own["time"] - begin, own["deflection"], "o", color=COLOURS[1], ms=3, mfc="w", label="record")
            told.append(
                f"deflection: record {own['deflection'].max():.4g} mm, "
                f"computed {measured.told(f'{test.drops[-1]}.deflection')} at the peak"
            )
    axes.legend(fontsize=8)
    axes.set(xlabel="time since the drop [ms]", title="last drop")
    return told


def _band(axes, time, values, error, colour):
    """The error of a history about it."""
    axes.fill_between(time, values - error, values + error, color=colour, alpha=0.2, lw=0)


def _pressures(axes, measured: Measured):
    test, history = measured.test, measured.answers.history
    if not test.wet:
        axes.text(0.5, 0.5, "no water", ha="center", transform=axes.transAxes)
        axes.set_axis_off()
        return
    start = test.starts[-1]
    seen = history["time"] >= start - 1e-9
    t = 1e3 * (history["time"][seen] - start)
    for i, depth in enumerate(test.depths[:4]):
        name = f"p_w_{point_of(depth)}"
        p = history[name][seen] - history[name][seen][0]
        axes.plot(t, p, LINES[i], color=COLOURS[i], label=f"{1e3 * depth:.0f} mm below")
        _band(axes, t, p, measured.band(name, start).total[seen], COLOURS[i])
    axes.legend(fontsize=8)
    axes.set(xlabel="time since the drop [ms]", ylabel="change of the water pressure [kPa]", title="last drop")


def _drops(axes, measured: Measured):
    drops, errors = measured.answers.drops, measured.errors
    number = np.arange(1, len(drops) + 1)
    for name, mark, colour in (("deflection", "o", COLOURS[0]), ("settlement", "s", COLOURS[1])):
        values = [1e3 * getattr(d, name) for d in drops]
        bars = [1e3 * errors[f"{d.name}.{name}"].total for d in drops]
        axes.errorbar(number, values, bars, fmt=mark, color=colour, mfc="w", capsize=3, label=f"{name} [mm]")
    axes.axvspan(0.5, measured.test.seating + 0.5, color="0.93", lw=0)
    axes.set(xlabel="drop (grey: seating)", title=f"modulus {measured.told('modulus')}", xticks=number)
    axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
    axes.legend(fontsize=8)


def _profile(axes, measured: Measured):
    test, points = measured.test, HostRun(measured.folder).histories
    start, last = test.starts[-1], measured.answers.drops[-1].deflection
    seen = points["time"] >= start - 1e-9
    depth, share = [0.0], [1.0]
    for d in test.depths:
        u = -points[f"{point_of(d)}.u_z"][seen]
        depth.append(d)
        share.append((u - u[0]).max() / last)
    axes.plot(share, [-d for d in depth], "o-", color=COLOURS[0], mfc="w")
    axes.axhline(-measured.answers.influence, color="0.6", lw=1)
    axes.annotate(
        f"a tenth at {measured.answers.influence:.2g} m", (0.98, -measured.answers.influence), va="bottom", ha="right"
    )
    axes.set(xlabel="largest displacement over the plate's [-]", ylabel="z [m]", title="below the centre, last drop")


def _field(figure, axes, measured: Measured):
    test = measured.test
    run = HostRun(measured.folder)
    try:
        frames, (nodes, elements) = run.times(), run.mesh()
        peak = test.starts[-1] + measured.answers.drops[-1].at
        frame = int(np.argmin(np.abs(frames - peak)))
        first = int(np.argmin(np.abs(frames - test.starts[-1])))
        moved = 1e3 * (run.field("displacement", first)[:, 1] - run.field("displacement", frame)[:, 1])
    except (ImportError, InputError, OSError) as problem:
        axes.text(0.5, 0.5, "no fields:\n" + "\n".join(str(problem).split(": ")), ha="center", fontsize=8, wrap=True)
        axes.set_axis_off()
        return
    import matplotlib.tri

    a = test.device.radius
    triangles = np.concatenate([elements[:, part] for part in SPLIT])
    mesh = matplotlib.tri.Triangulation(nodes[:, 0], nodes[:, 1], triangles)
    drawn = axes.tricontourf(mesh, moved, levels=12, cmap="Blues")
    figure.colorbar(drawn, ax=axes, label="displacement downwards [mm]")
    axes.plot([0, a], [0, 0], color="k", lw=3)
    axes.set(xlim=(0, 5 * a), ylim=(-6 * a, 0.3 * a), aspect="equal", xlabel="r [m]", ylabel="z [m]")
    axes.set_title(f"{1e3 * (frames[frame] - test.starts[-1]):.0f} ms after the last drop begins")


STYLE = (
    "body{font:15px/1.45 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}table{border-collapse:collapse}"
    "td,th{padding:.15em .8em;border-bottom:1px solid #ccc;text-align:right}"
    "td:first-child{text-align:left}img{width:100%}"
)


def write_page(measured: Measured, folder: pathlib.Path, record: str | None = None) -> list[str]:
    """report.html with its picture inside, and lwd.png. Returns sentences about a record."""
    told = picture(measured, folder / "lwd.png", record)
    test, answers, errors = measured.test, measured.answers, measured.errors
    image = base64.b64encode((folder / "lwd.png").read_bytes()).decode()
    rows = [
        [
            f"{i + 1} ({'measured' if d.measured else 'seating'})",
            *(
                f"{getattr(d, n) * unit_of(n)[1]:.4g} &plusmn; {errors[f'{d.name}.{n}'].total * unit_of(n)[1]:.1g}"
                for n in ("deflection", "modulus", "rebound", "settlement", "force")
            ),
            f"{1e3 * d.deflection / d.velocity:.3g}",
            f"{1e3 * d.lift:.2g}",
        ]
        for i, d in enumerate(answers.drops)
    ]
    head = ["drop", "deflection [mm]", "modulus [MN/m<sup>2</sup>]", "rebound [mm]", "settlement [mm]", "force [kN]"]
    head += ["s/v [ms]", "lift [mm]"]
    histories = [
        [name, f"{change:.4g}", *(f"{x:.1g}" for x in (e.total, e.mesh, e.steps, e.solve)), unit]
        for name, change, e, unit in measured.changes()
    ]
    device = test.device
    formula = (
        "E<sub>vd</sub> = 22.5/s"
        if device.name == "zorn" and abs(device.modulus(1e-3) - 22.5e3) < 1.0
        else f"E = {device.shape:.4g} (1 - {device.poisson:g}<sup>2</sup>) &sigma; r/s, &sigma; "
        + ("of the largest force of each drop" if device.cell else f"= {device.peak / device.area:.4g} kPa")
    )
    water = (
        f"S_w = {answers.saturation:.3g} and a suction of {answers.suction:.4g} kPa below the plate before the drops"
        if test.wet
        else "no water"
    )
    warnings = "".join(f"<li>{html.escape(w)}</li>" for w in measured.warnings) or "<li>none</li>"
    body = f"""<h1>Light falling weight deflectometer, computed</h1>
<p><b>Modulus {html.escape(measured.told("modulus"))}</b>, deflection {html.escape(measured.told("deflection"))},
means of {test.measured} drops after {test.seating} seating drops ({html.escape(device.standard)}; {formula}).
Depth of influence {html.escape(measured.told("influence"))}: there the ground moves by a tenth of the plate's way.</p>
<p>{water}; e = {answers.void_ratio:.3g}. Permeability {test.permeability:g} m<sup>2</sup>,
K<sub>0</sub> = {test.k_0:g}.
Errors are those of mesh, steps and tolerances, measured by four runs; they say nothing about the soil.</p>
<img alt="input, last drop, pressures, drops, profile, field" src="data:image/png;base64,{image}">
<table><tr>{"".join(f"<th>{x}</th>" for x in head)}</tr>
{"".join("<tr>" + "".join(f"<td>{x}</td>" for x in row) + "</tr>" for row in rows)}</table>
<p>The plate {"is tied to the ground" if test.tied else "lies loose: lift is how far it is thrown up"}.
Histories in histories.csv, each with its error at every time:</p>
<table><tr><th>history</th><th>largest change</th><th>largest error</th><th>of mesh</th><th>of steps</th>
<th>of solving</th><th>unit</th></tr>
{"".join("<tr>" + "".join(f"<td>{x}</td>" for x in row) + "</tr>" for row in histories)}</table>
{"".join(f"<p>{html.escape(x)}</p>" for x in told)}
<h2>Warnings</h2><ul>{warnings}</ul>
<p>Input: scene.nml. Tables: results.csv, drops.csv, histories.csv. Fields: {html.escape(str(measured.folder.name))}
in runs.</p>"""
    (folder / "report.html").write_text(
        f"<!doctype html><meta charset='utf-8'><title>mud_lwd</title><style>{STYLE}</style>{body}\n", encoding="utf-8"
    )
    return told
