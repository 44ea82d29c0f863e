# SPDX-License-Identifier: MIT
"""The results of a calibration as files: the material file, a page in Markdown with pictures, and the misfits as a table."""

from __future__ import annotations

import csv
import datetime
import pathlib
import textwrap

import numpy as np

from .. import _native
from ..errors import MudError
from ..material import TESTED
from ..namelist import LONGEST, quoted
from ..plots import COLOURS, logarithmic, pyplot, style
from ..registry import parameters
from .calibrate import UNDERSTOOD, Calibration
from .diagnosis import origin_of
from .ensemble import LEVEL
from .fit import PRIOR
from .misfit import ROBUST, Misfit
from .simulation import SETTINGS, loops, turns
from .task import Item, Task

PAGE = 6  # tests a picture
NUMERICS = ("scheme", "tolerance", "eps_hat", "j_exp", "max_substeps")


def write_material(result: Calibration, folder: pathlib.Path) -> pathlib.Path:
    """NAME.nml: every paper parameter with the origin of its value, ranges and misfit as comments."""
    folder.mkdir(parents=True, exist_ok=True)
    task, path = result.task, folder / f"{result.task.name}.nml"
    lines = [
        *_wrapped(
            f"{task.title or task.name}, fitted by mud_calibrate on {datetime.date.today().isoformat()}, MUD {_version()}.", "! "
        ),
        *_wrapped(f"Tests: {_origin(task)}", "! "),
        *_wrapped(_range_text(result), "! "),
        *_wrapped(_misfit_text(result), "! "),
        "&material",
        f"   name = {quoted((task.title or task.name) + ('' if '(' in task.title else ' (fitted)'), LONGEST)}",
        f"   reference = {quoted(task.reference, LONGEST)}",
        *(f"   {name} = {text}".ljust(26) + "! of the fitted tests" for name, text in zip(TESTED, _range_of_tests(result))),
    ]
    for name, entry in parameters.items():
        value = result.material[name]
        # Numerical settings and switches are left to the library; a switch that the start or the tests have moved is kept.
        switch = entry.lower == 0 and entry.upper == 1 and entry.default in (0.0, 1.0) and name not in ("S_min", "S_max")
        usual = entry.origin in ("paper", "mended") and not switch
        if (usual or value != entry.default) and not entry.options and name not in NUMERICS:
            lines.append(f"   {name} = {value:.6g}".ljust(26) + f"! {origin_of(name, result.diagnosis, task)}")
    path.write_text("\n".join([*lines, "/", ""]), encoding="utf-8")
    return path


def _origin(task: Task) -> str:
    """Where the tests come from: the reference of the task, or else its tables."""
    return task.reference or ", ".join(sorted({item.test.source for item in task.items}))


def _range_of_tests(result: Calibration) -> list[str]:
    """Least and largest void ratio, least and largest stress of the fitted tests; none where they have no such columns."""
    mechanical = [i for i in result.task.fitted() if i.test.kind != "retention"]
    stressed = [i for i in mechanical if "p" in i.test or "sigma_a" in i.test]
    ratios = [i for i in mechanical if "e" in i.test]
    if stressed and ratios:
        stress = np.concatenate([i.test["p" if "p" in i.test else "sigma_a"][_passed(i)] for i in stressed])
        ratio = np.concatenate([i.test["e"][_passed(i)] for i in ratios])
        return [f"{ratio.min():.3f}", f"{ratio.max():.3f}", f"{stress.min():.0f}", f"{stress.max():.0f}"]
    return []


def _passed(item: Item) -> np.ndarray:
    """Rows of a test that the model passes: those that count, and where a curve begins, which is given and so does not count."""
    begins = [item.use.start] if item.test.kind in ("drained", "undrained", "oedometer", "isotropic") else []
    return np.concatenate([begins, item.use.rows]).astype(int)


def _range_text(result: Calibration) -> str:
    """Range of stress and void ratio, or of suction, of the fitted tests."""
    told = []
    for e_min, e_max, least, most in filter(None, [_range_of_tests(result)]):
        told.append(f"stress (p', oedometer: sigma_a) {least} to {most} kPa, void ratio {e_min} to {e_max}")
    retention = [i for i in result.task.fitted() if i.test.kind == "retention"]
    if retention:
        suction = np.concatenate([i.test["suction"][i.use.rows] for i in retention])
        told.append(f"suction {suction.min():.3g} to {suction.max():.3g} kPa")
    return "Range of the fitted tests: " + "; ".join(told) + "."


def _misfit_text(result: Calibration) -> str:
    return "Misfit: " + "; ".join(f"{line['set']}: {line['text']}" for line in summary(result.misfits)) + "."


def summary(misfits: list[Misfit], fitted: bool = True) -> list[dict[str, str]]:
    """A line for the fitted and one for the held-out tests: rms over the tests, and the worst one. fitted : False: nothing was,
    the tests that are not held out are only compared."""
    lines = []
    for held, word in ((False, set_of(fitted)), (True, "held out")):
        mine, told = [m for m in misfits if m.held_out is held], []
        for key, unit, what in (
            ("q", "%", "q"),
            ("p", "%", "p'"),
            ("eps_v", "points", "volumetric strain"),
            ("S_w", "", "S_w"),
            ("r_u", "", "r_u"),
            ("sigma_r", "kPa", "radial stress"),
            ("G", "%", "shear modulus"),
            ("damping", "points", "damping"),
            ("N", "", "cycles to liquefaction by a factor of"),
        ):
            values = np.array([getattr(m, key) for m in mine])
            values = values[np.isfinite(values)]
            if len(values):
                told.append(
                    f"{what} {np.sqrt(np.mean(values**2)):.2g} {unit} rms of {len(values)} tests (worst {values.max():.2g})".replace(
                        "  ", " "
                    )
                )
        values = np.array([m.e for m in mine if np.isfinite(m.e)])
        if len(values):
            loading = np.array([m.e_loading for m in mine if np.isfinite(m.e)])
            told.append(
                f"void ratio in compression within {loading.max():.4f} in first loading, {values.max():.4f} with unloading "
                f"({len(values)} tests)"
            )
        if mine:
            lines.append({"set": word, "text": ", ".join(told)})
    return lines


def set_of(fitted: bool) -> str:
    """What the tests that are not held out are called."""
    return "fitted" if fitted else "compared"


def write_report(result: Calibration, folder: pathlib.Path) -> pathlib.Path:
    """README.md, pictures and misfit.csv into the folder; returns the page."""
    folder.mkdir(parents=True, exist_ok=True)
    pictures = _pictures(result, folder)
    task = result.task
    text = [f"# {task.title or task.name}: {'calibration' if result.diagnosis else 'comparison'}", "", _made(result), ""]
    text += [f"Tests: {_origin(task)}", ""]
    # What was understood has a table of its own.
    notes = [note for note in (*task.notes, *result.notes) if not note.startswith(UNDERSTOOD)]
    text += [*(f"- {note}" for note in notes), ""] if notes else []
    text += _understood(task)
    text += _misfit_summary("", result.misfits, bool(result.diagnosis))
    text += [
        "q: rms of q/q_lab - 1 over the laboratory rows from 1 to 20 % axial strain; volumetric strain: rms difference in "
        "percentage points over the same rows; void ratio: largest difference. The laboratory's linear axial strain is turned "
        "into the model's natural one.",
        "",
    ]
    if result.beside is not None:
        text += _misfit_summary(f"Beside it: material `{result.beside_name}`, the same measure.", result.beside, bool(result.diagnosis))
    text += _coverage(result)
    text += ["## Curves", "", *(f"![{p.stem}]({p.name})" for p in pictures), "", "## Misfit of each test", ""]
    text += _misfit_table(result)
    if result.diagnosis:
        text += ["", *_fitted_sections(result)]
    path = folder / "README.md"
    path.write_text("\n".join(_lines(text)).rstrip("\n") + "\n", encoding="utf-8")
    with open(folder / "misfit.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("test", "kind", "set", *(column for _, column in _RECORDED), "stopped"))
        for m in result.misfits:
            numbers = ("" if np.isnan(v) else f"{v:.4g}" for v in (getattr(m, key) for key, _ in _RECORDED))
            writer.writerow((m.name, m.kind, "held out" if m.held_out else set_of(bool(result.diagnosis)), *numbers, m.stopped))
    return path


def _lines(text: list[str]) -> list[str]:
    """Sentences and lists in lines of 120 columns; tables as they are."""
    lines: list[str] = []
    for line in "\n".join(text).split("\n"):
        keep = not line or line.startswith(("|", "#", "!["))
        lines += [line] if keep else _wrapped(line, "- " if line.startswith("- ") else "")
    return lines


def _wrapped(text: str, mark: str) -> list[str]:
    """Lines of 120 columns; a comment has its mark in each of them, an item of a list in the first."""
    later = mark if mark == "! " else " " * len(mark)
    return textwrap.wrap(text if text.startswith(mark) else mark + text, 120, subsequent_indent=later,
                         break_long_words=False, break_on_hyphens=False)


# Attributes of a misfit and their columns in misfit.csv.
_RECORDED = (
    ("q", "q_rms_percent"),
    ("p", "p_rms_percent"),
    ("eps_v", "eps_v_rms_points"),
    ("e", "e_largest"),
    ("e_loading", "e_largest_loading"),
    ("S_w", "S_w_rms"),
    ("r_u", "r_u_rms"),
    ("sigma_r", "sigma_r_rms_kPa"),
    ("G", "G_rms_percent"),
    ("damping", "damping_rms_points"),
    ("N", "N_factor"),
)


def _made(result: Calibration) -> str:
    """How the page was made."""
    task = result.task
    if not result.diagnosis:
        return (
            f"Made by `mud_calibrate --evaluate`: MUD {_version()}, material {result.material.title}, "
            f"{len(task.items)} test{'s' * (len(task.items) > 1)}, nothing fitted."
        )
    return (
        f"Made by `mud_calibrate`: MUD {_version()}, seed {task.seed}, {len(task.fitted())} tests fitted and "
        f"{len(task.items) - len(task.fitted())} held out, {result.simulations} simulations, "
        f"{result.cpu_seconds:.0f} s of processor time, shared by {result.workers} workers ({result.seconds:.0f} s on the "
        "clock of a machine that may have done other things too)."
    )


def _misfit_summary(head: str, misfits: list[Misfit], fitted: bool) -> list[str]:
    lines = [f"| {line['set']} | {line['text']} |" for line in summary(misfits, fitted)]
    return [*([head, ""] if head else []), "| set | misfit |", "|---|---|", *lines, ""]


def _understood(task: Task) -> list[str]:
    """What the tables were understood to say, where they did not say it as the library does."""
    told = dict.fromkeys((item.test.source, line) for item in task.items for line in item.test.understood)
    if not told:
        return []
    return [
        "## What the tables were understood to say",
        "",
        "| table | in it | understood as |",
        "|---|---|---|",
        *(f"| {source} | {given} | {meant} |" for source, (given, meant) in told),
        "",
    ]


def _coverage(result: Calibration) -> list[str]:
    """How many points lie in their bands."""
    if not result.ensemble:
        return []
    lines = []
    for held, word in ((False, "fitted"), (True, "held out")):
        shares = result.ensemble.coverage(result.task.items, held)
        if shares:
            total, n = shares.pop("")
            parts = ", ".join(f"{quantity} {100 * share:.0f} %" for quantity, (share, _) in shares.items())
            lines.append(f"| {word} | {100 * total:.0f} % of {n} | {parts} |")
    return [
        f"Bands of {100 * LEVEL:.0f} % (parameters and the error of the model) hold these shares of the laboratory's points:",
        "",
        "| set | all | by quantity |",
        "|---|---|---|",
        *lines,
        "",
    ]


def _fitted_sections(result: Calibration) -> list[str]:
    """Parameters, what is determined, minima, warnings, how it was fitted."""
    found, ensemble = result.diagnosis, result.ensemble
    text = [
        "## Parameters",
        "",
        "| parameter | value | 95 % | bounds | a change by 10 % moves the curves by | |",
        "|---|---|---|---|---|---|",
    ]
    for f in found.findings:
        if f.fitted:
            text.append(
                f"| `{f.variable.name}` | {f.value:.4g} | {f.low:.3g} to {f.high:.3g} | {f.variable.lower:g} to "
                f"{f.variable.upper:g} | {f.sensitivity:.2f} | {'' if f.determined else 'not determined'}"
                f"{' at its ' + f.at_bound + ' bound' if f.at_bound else ''} |"
            )
    text += [
        "",
        "The last column but one is the sensitivity: rms over the curves, in standard deviations of what was measured. "
        "`e_c100` is the critical void ratio at 100 kPa and stands for N_c; `e_l10` the void ratio of the compression line at "
        "10 MPa and stands for N_l; `P_aw_ratio`, `n_w_share` and `m_w_ratio` are where the main wetting curve lies beside the "
        "drying curve. "
        + (
            f"Intervals are those of an ensemble of {len(ensemble.members)} sets drawn about the minima and weighted by their "
            f"misfit ({ensemble.effective:.0f} of them count"
            + (f", weights evened out by the exponent {ensemble.evened:.2g}" if ensemble.evened < 1 else "")
            + "); they include every minimum below. "
            if ensemble
            else "Intervals come from the Jacobian at the optimum. "
        )
        + "Variance of the misfit: over the independent observations of the curves less the fitted parameters. Rows whose errors "
        "follow each other, as those of a model do along a curve, are one observation together. "
        f"The prior of a parameter is its start between its bounds, with a deviation of {PRIOR:g} times their width.",
        "",
    ]
    if len(result.minima) > 1:
        names = [f.variable.name for f in found.findings if f.fitted and f.variable.name in result.minima[0].values]
        text += [
            "Minima within a tenth of the best misfit:",
            "",
            "| misfit | start | " + " | ".join(names) + " |",
            "|" + "---|" * (len(names) + 2),
            *(
                f"| {m.cost:.3f} | {m.start} | " + " | ".join(f"{m.values[name]:.4g}" for name in names) + " |"
                for m in result.minima
            ),
            "",
        ]
    if ensemble:
        text += [
            "Error of the model over the scatter of the measurement, from the fitted tests: "
            + ", ".join(f"{kind}, {quantity} {error:.1f}" for (kind, quantity), error in ensemble.errors.items())
            + ".",
            "",
        ]
    text += ["## What these tests determine", ""]
    text += [f"- {sentence}" for sentence in found.sentences] or ["Every parameter that was fitted is determined."]
    text += ["", "Correlations of the fitted variables at the optimum:", "", *_matrix(found.names, found.matrix), ""]
    text += ["## Warnings", ""]
    text += [f"- {warning}" for warning in found.warnings] or ["None."]
    text += [
        "",
        "## How it was fitted",
        "",
        "| step | misfit |",
        "|---|---|",
        *(f"| {step} | {cost:.3f} |" for step, cost in result.history),
        "",
        "Misfit in standard deviations of the measurement: every curve counts as much as any other, residuals beyond "
        f"{ROBUST:g} deviations count less (soft l1). Start: critical state from the ends of the shear tests; then a Sobol "
        "search, several starts through the groups one after the other, and everything together (trust region, bounded) from "
        "each of them. Steps before `starts tried` use a part of the tests and rows.",
    ]
    return text


def _misfit_table(result: Calibration) -> list[str]:
    """Fitted and held-out tests apart; columns that a kind has."""
    columns = [
        ("q", "q [%]", ".1f"),
        ("p", "p' [%]", ".1f"),
        ("eps_v", "eps_v [points]", ".2f"),
        ("e", "e, largest", ".4f"),
        ("e_loading", "e, first loading", ".4f"),
        ("S_w", "S_w, rms", ".3f"),
        ("r_u", "r_u, rms", ".3f"),
        ("sigma_r", "sigma_r, rms [kPa]", ".1f"),
        ("G", "G [%]", ".1f"),
        ("damping", "damping [points]", ".1f"),
        ("N", "N, factor", ".2f"),
    ]
    used = [c for c in columns if any(np.isfinite(getattr(m, c[0])) for m in result.misfits)]
    beside = {m.name: m for m in result.beside or []}
    lines = [
        "| test | set | start | "
        + " | ".join(title + (f" | {result.beside_name}" if beside else "") for _, title, _ in used)
        + " |",
        "|" + "---|" * (3 + len(used) * (2 if beside else 1)),
    ]
    for held in (False, True):
        for m in result.misfits:
            if m.held_out is held:
                cells = []
                for key, _, form in used:
                    for one in ([m, beside[m.name]] if beside else [m]):
                        value = getattr(one, key)
                        cells.append("" if np.isnan(value) else format(value, form))
                lines.append(
                    f"| {m.name} | {'**held out**' if held else set_of(bool(result.diagnosis))} | {_start_text(result.item(m.name))} | "
                    + " | ".join(cells)
                    + f" |{' ' + m.stopped if m.stopped else ''}"
                )
    return lines


def _start_text(item: Item) -> str:
    test = item.test
    if test.kind in ("retention", "stiffness", "modulus", "liquefaction"):
        starts = {(float(p), float(e)) for p, e in zip(test["p_0"], test["e_0"])} if "p_0" in test and "e_0" in test else ()
        if len(starts) == 1:
            return "{:.0f} kPa, e {:.3f}".format(*starts.pop())
        return f"{len(item.use.rows)} point{'s' * (len(item.use.rows) > 1)}"
    if test.kind == "drained":
        return f"{test.sigma_r:.0f} kPa, e {test.e_0:.3f}"
    if test.kind in ("oedometer", "isotropic"):
        return f"{test['sigma_a' if test.kind == 'oedometer' else 'p'][item.use.start]:.0f} kPa, e {test['e'][item.use.start]:.3f}"
    return f"{test['p' if 'p' in test else 'p_0'][0]:.0f} kPa, e {test.e_0:.3f}"


def _matrix(names: list[str], matrix: np.ndarray) -> list[str]:
    return [
        "| | " + " | ".join(names) + " |",
        "|" + "---|" * (len(names) + 1),
        *(
            "| " + name + " | " + " | ".join(f"{v:+.2f}" if j < i else "" for j, v in enumerate(row)) + " |"
            for i, (name, row) in enumerate(zip(names, matrix))
        ),
    ]


@style()
def _pictures(result: Calibration, folder: pathlib.Path) -> list[pathlib.Path]:
    """Curves against the laboratory, a few tests a picture, fitted and held out apart."""
    plt, made = pyplot(), []
    for held, word in ((False, set_of(bool(result.diagnosis))), (True, "held_out")):
        for kind in dict.fromkeys(item.test.kind for item in result.task.items):
            items = [i for i in result.task.items if i.test.kind == kind and i.test.held_out is held]
            parts = -(-len(items) // PAGE)
            told = "held out, predicted" if held and result.diagnosis else word.replace("_", " ")
            for n in range(parts):
                title = f"{result.task.title or result.task.name}: {kind}, {told}"
                figure = _page(result, items[n::parts], title, plt)
                made.append(folder / f"{word}_{kind}{f'_{n + 1}' if parts > 1 else ''}.png")
                figure.savefig(made[-1], dpi=100)
                plt.close(figure)
                if kind == "cyclic":
                    figure = _loops(result, items[n::parts], f"{title}: loops of the model", plt)
                    made.append(made[-1].with_stem(made[-1].stem.replace("cyclic", "loops")))
                    figure.savefig(made[-1], dpi=100)
                    plt.close(figure)
    return made


def _loops(result: Calibration, items: list[Item], title: str, plt):
    """Stress over strain, and over mean stress, of the model in cyclic tests; the tables have reversals alone."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.9), layout="constrained")
    for colour, item in zip(COLOURS, items):
        try:
            run = loops(result.material.changed(**SETTINGS), item.test, item.use)
        except MudError:  # its line of the table says that it could not begin
            continue
        strain, stress = ("gamma_13", "sig_13") if item.test.control.startswith("simple_shear") else ("eps_a", "q")
        axes[0].plot(100 * run[strain], run[stress], color=colour, lw=0.8, label=f"{item.test.name}: {_start_text(item)}")
        axes[1].plot(run["p_eff"], run[stress], color=colour, lw=0.8)
    axes[0].set(xlabel="axial or shear strain [%]", ylabel="q, in simple shear tau [kPa]")
    axes[1].set(xlabel=_AXES["p"])
    for axis in axes:
        axis.grid(color="#dddddd", lw=0.6)
    figure.legend(loc="outside lower center", ncols=3, fontsize=7)
    figure.suptitle(title, fontsize=10)
    return figure


# What is drawn of a kind of test: (x, y) of each panel.
_PANELS = {
    "drained": (("eps_a", "q"), ("eps_a", "eps_v")),
    "undrained": (("eps_a", "q"), ("p", "q")),
    "oedometer": (("sigma_a", "e"), ("sigma_a", "sigma_r")),
    "isotropic": (("p", "e"),),
    "retention": (("suction", "S_w"),),
    "cyclic": (("cycle", "eps_v"), ("cycle", "r_u")),
    "stiffness": (("p", "G_max"),),
    "modulus": (("gamma", "G_ratio"), ("gamma", "damping")),
    "liquefaction": (("N", "csr"),),
}
_AXES = {
    "eps_a": "axial strain [%]",
    "eps_v": "volumetric strain [%]",
    "q": "q [kPa]",
    "p": "p' [kPa]",
    "sigma_a": "axial stress [kPa]",
    "e": "void ratio",
    "suction": "suction [kPa]",
    "S_w": "degree of saturation",
    "cycle": "cycle",
    "r_u": "pore pressure ratio r_u",
    "sigma_r": "radial stress [kPa]",
    "G_max": "G_max [kPa]",
    "gamma": "shear strain [-]",
    "G_ratio": "G/G_max",
    "damping": "damping ratio",
    "N": "cycles to liquefaction",
    "csr": "cyclic stress ratio q/(2 p_0)",
}


def _page(result: Calibration, items: list[Item], title: str, plt):
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    kind = items[0].test.kind
    panels = [(x, y) for x, y in _PANELS[kind] if any(x in i.test and y in i.test for i in items)]
    figure, axes = plt.subplots(1, len(panels), figsize=(10 if len(panels) > 1 else 7, 4.9), squeeze=False, layout="constrained")
    handles, banded = [], False
    for colour, item in zip(COLOURS, items):
        for axis, (x, y) in zip(axes[0], panels):
            if x in item.test and y in item.test:
                banded |= _draw(axis, result, item, x, y, colour)
        handles.append(
            Line2D([], [], color=colour, ls="" if kind == "liquefaction" else "-", marker="o", ms=4, mfc="white",
                   label=f"{item.test.name}: {_start_text(item)}")
        )
    for axis, (x, y) in zip(axes[0], panels):
        axis.set_xlabel(_AXES[x])
        axis.set_ylabel(_AXES[y])
        if x in ("sigma_a", "p") and y == "e" or x in ("suction", "gamma", "N"):
            logarithmic(axis)
        axis.grid(color="#dddddd", lw=0.6)
    handles.append(Line2D([], [], color="#555555", ls="", marker="o", ms=4, mfc="white", label="laboratory"))
    handles.append(Line2D([], [], color="#555555", label="model", **({"ls": "", "marker": "x"} if kind == "liquefaction" else {})))
    if banded:
        handles.append(Patch(color="#555555", alpha=0.15, lw=0, label=f"{100 * LEVEL:.0f} % band"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=7)
    figure.suptitle(title, fontsize=10)
    return figure


def _draw(axis, result: Calibration, item: Item, x: str, y: str, colour: str) -> bool:
    """Points, line and band of a test; whether there is a band."""
    test, rows, answer = item.test, item.use.rows, result.answers[item.test.name]
    across, up = (100 if name.startswith("eps") else 1 for name in (x, y))
    if y == "csr":  # the cycles are the answer
        axis.plot(test[x][rows], test[y][rows], "o", ms=3, color=colour, mfc="white", mew=0.8)
        axis.plot(10 ** answer.columns["log_N"], test[y][rows], "x", ms=4, color=colour)
        return False
    model_x = answer.columns["p"] if x == "p" and y == "q" else test[x][rows]
    axis.plot(across * test[x][rows], up * test[y][rows], "o", ms=3, color=colour, mfc="white", mew=0.8)
    hysteresis = item.use.turning and result.material["hysteresis"] != 0
    sorts = test.kind in ("retention", "stiffness", "modulus") and not hysteresis
    order = np.argsort(model_x, kind="stable") if sorts else slice(None)
    axis.plot(across * model_x[order], up * answer.columns[y][order], color=colour)
    band = result.ensemble.bands[test.name].get(y) if result.ensemble and x != "p" else None
    if band is None:
        return False
    if hysteresis:
        branches = [slice(a, b + 1) for a, b in zip(*turns(test[x][rows]))]
    else:  # of a loop the first loading
        branches = [slice(0, int(np.argmax(test[x][rows])) + 1 if test.kind in ("oedometer", "isotropic") else len(rows))]
    for branch in branches:
        along = np.argsort(test[x][rows][branch], kind="stable")
        low, high = up * band.low[branch][along], up * band.high[branch][along]
        axis.fill_between(across * test[x][rows][branch][along], low, high, color=colour, alpha=0.15, lw=0)
    return True


def _version() -> str:
    return _native.text_of(_native.mud.mud_version)[1]
