# SPDX-License-Identifier: MIT
"""Tables and pictures of the oscillation study from its CSV files."""
import re
import statistics

from tools import tables

RULES = ("classic", "threshold", "repositioning", "return_point", "as_published", "elastic_domain", "return_point_2e-5")
COLOURS = dict(zip(RULES, ("#555555", "#0b3c6f", "#3a8f6a", "#c8553d", "#b0b0b0", "#8a5a9e", "#d9a441")))
WIDTHS = {"classic": 5.0, "threshold": 3.2}   # drawn first: curves that others hide stay visible
FLOOR = 1e-5   # % of distance that is drawn as "none": below the integration's own error
TRUE = {"1": "drained", "0": "undrained"}


def read(folder, name):
    """Rows of a committed file, numbers as such."""
    return [{k: v if re.search("[A-Za-z]{3}", v) else float(v) for k, v in row.items()}
            for row in tables.rows(folder / f"{name}.csv")]


def short(value):
    """A distance in per cent."""
    value *= 100
    return f"{value:.0f}" if value >= 10 else f"{value:.2g}" if value >= 0.01 else "< 0.01"


def size_text(value):
    return f"{value:.0e}".replace("e-0", "e-")


def worst(rows):
    """Largest distance, with the number of runs that did not reach their end."""
    ends = [r["distance"] for r in rows if r["failed"] == 0]
    failed = len(rows) - len(ends)
    return (short(max(ends)) if ends else "-") + (f" ({failed} failed)" if failed else "")


def middle(rows):
    ends = [r["distance"] for r in rows if r["failed"] == 0]
    return short(statistics.median(ends)) if ends else "-"


def chosen(rows, **values):
    return [r for r in rows if all(r[k] == v for k, v in values.items())]


def values_of(rows, key):
    return sorted({r[key] for r in rows})


def single_table(rows):
    return tables.markdown(["amplitude", *RULES], [
        [size_text(size)] + [f"{middle(part)} / {worst(part)}" for rule in RULES
                             for part in [chosen(rows, rule=rule, size=size)]] for size in values_of(rows, "size")])


def many_table(rows):
    lines = []
    for events in values_of(rows, "events"):
        for size in values_of(rows, "size"):
            parts = [chosen(rows, rule=rule, size=size, events=events) for rule in RULES]
            lines.append([int(events), size_text(size)] + [f"{middle(p)} / {worst(p)}" for p in parts])
    return tables.markdown(["reversals", "size", *RULES], lines)


def paths_table(rows):
    """300 random reversals of 1e-6 by the path."""
    lines = []
    for e in values_of(rows, "e"):
        for drained in (0.0, 1.0):
            for path in ("straight", "turning"):
                for suction in (0.0, 100.0):
                    same = chosen(rows, e=e, drained=drained, path=path, suction=suction, events=300, random_events=1,
                                  size=1e-6)
                    lines.append([f"{e:.3f}", TRUE[f"{drained:.0f}"], path, f"{suction:.0f}"]
                                 + [worst(chosen(same, rule=rule)) for rule in RULES])
    return tables.markdown(["e", "", "path", "suction", *RULES], lines)


def cost_table(rows):
    lines = []
    for rule in RULES:
        part = chosen(rows, rule=rule)
        lines.append([rule, len(part), int(sum(r["failed"] for r in part)), int(sum(r["halvings"] for r in part)),
                      int(statistics.median(r["substeps"] for r in part)),
                      int(max(r["substeps"] for r in part)), int(statistics.median(r["resets"] for r in part))])
    return tables.markdown(["", "runs", "failed", "increments cut", "substeps, median", "substeps, most",
                            "resets, median"],
                 lines)


def transverse_table(rows):
    plain = [r for r in RULES if r not in ("elastic_domain", "as_published")]
    radii = values_of(chosen(rows, rule="elastic_domain"), "rho_e")
    lines = []
    for noise in ("shear", "six"):
        for size in values_of(rows, "size"):
            same = chosen(rows, noise=noise, size=size)
            lines.append([noise, size_text(size)] + [worst(chosen(same, rule=rule)) for rule in plain]
                         + [worst(chosen(same, rule="elastic_domain", rho_e=radius)) for radius in radii])
    return tables.markdown(["noise", "size", *plain, *(f"rho_e {size_text(r)}" for r in radii)], lines)


def numerics_table(rows):
    rules = [r for r in RULES]
    lines = []
    for increment in values_of(rows, "increment"):
        for tolerance in sorted(values_of(rows, "tolerance"), reverse=True):
            same = chosen(rows, increment=increment, tolerance=tolerance)
            if same:
                lines.append([size_text(increment), size_text(tolerance)] + [
                    f"{worst(part)}, {statistics.median(r['substeps'] for r in part):.0f}" if part else "not run"
                    for rule in rules for part in [chosen(same, rule=rule)]])
    return tables.markdown(["increment", "tolerance", *rules], lines)


def hard_table(groups):
    lines = []
    for name, rows in groups.items():
        for size in values_of(rows, "size") if "size" in rows[0] else (None,):
            same = chosen(rows, size=size) if size is not None else rows
            lines.append([name, size_text(size) if size is not None else "1e-6 to 2e-3"]
                         + [f"{middle(p)} / {worst(p)}" for rule in RULES for p in [chosen(same, rule=rule)]])
    return tables.markdown(["", "size", *RULES], lines)


def clean_table(rows):
    lines = []
    for rule in RULES:
        for radius in values_of(chosen(rows, rule=rule), "rho_e"):
            line = [f"elastic domain, rho_e {size_text(radius)}" if rule == "elastic_domain" else rule]
            for drained in (0.0, 1.0):
                part = chosen(rows, rule=rule, rho_e=radius, drained=drained)
                line += [worst(part), int(statistics.median(r["rates"] for r in part))]
            lines.append(line)
    return tables.markdown(["", "undrained, %", "rates", "drained, %", "rates"], lines)


def laboratory_table(rows):
    radii = values_of(rows, "rho_e")
    return tables.markdown(["test", *(f"rho_e {size_text(r) if r else 0}" for r in radii)], [
        [test]
        + [f"{r['q']:.2f} / {r['eps_v']:.3f}" for radius in radii for r in chosen(rows, test=test, rho_e=radius)]
        for test in dict.fromkeys(r["test"] for r in rows)])


def draw(bench, name, panels, label, legend_columns, plt):
    """Panels: title -> {curve: (colour, style, [(size, distance)])}."""
    figure, axes = plt.subplots(2, 2, figsize=(9.5, 7), sharex=True, sharey=True)
    for axis, (title, curves) in zip(axes.flat, panels.items()):
        for curve, (colour, style, points) in curves.items():
            axis.loglog([p[0] for p in points], [max(100 * p[1], FLOOR) for p in points], style, color=colour,
                        label=curve, marker="o", ms=3.5, lw=WIDTHS.get(curve, 1.5))
        axis.axhline(0.1, color="#999999", lw=0.7)
        axis.set_title(title)
    for axis in axes[1]:
        axis.set_xlabel(label)
    for axis in axes[:, 0]:
        axis.set_ylabel("distance from the clean path [%]")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=legend_columns)
    bench.save(figure, name, dpi=130)


def panels_of(rows, curves, **fixed):
    """Dense and loose, undrained and drained."""
    return {f"e {e:.3f}, {TRUE[f'{drained:.0f}']}": {
        name: (colour, style, [(s, max(r["distance"] for r in part)) for s in values_of(rows, "size")
                               if (part := chosen(rows, e=e, drained=drained, size=s, failed=0, **which, **fixed))])
        for name, (colour, style, which) in curves.items()} for e in (0.735, 0.907) for drained in (0.0, 1.0)}


def texts(folder):
    """The tables of README.md by their marks."""
    single, many, transverse = (read(folder, n) for n in ("single", "many", "transverse"))
    hard = {name: read(folder, name) for name in ("nested", "inner", "unloading", "growing")}
    return {"clean": clean_table(read(folder, "clean")), "single": single_table(single), "many": many_table(many),
            "paths": paths_table(many), "cost": cost_table(many), "transverse": transverse_table(transverse),
            "numerics": numerics_table(read(folder, "numerics")), "hard": hard_table(hard),
            "laboratory": laboratory_table(read(folder, "laboratory"))}


def pictures(bench, plt):
    single, many, transverse = (read(bench.here, n) for n in ("single", "many", "transverse"))
    rules = {rule: (COLOURS[rule], "--" if rule == "as_published" else "-", {"rule": rule}) for rule in RULES}
    draw(bench, "single.png", panels_of(single, rules, path="straight", suction=0.0, **{"from": 0.05}),
         "amplitude of one reversal at 0.05 [-]", 4, plt)
    draw(bench, "many.png", panels_of(many, rules, path="straight", suction=0.0, events=300, random_events=1),
         "mean size of 300 random reversals [-]", 4, plt)
    radii = values_of(chosen(transverse, rule="elastic_domain"), "rho_e")
    curves = {rule: rules[rule] for rule in ("classic", "threshold", "return_point", "return_point_2e-5")}
    curves |= {f"rho_e {size_text(r)}": (colour, "-", {"rule": "elastic_domain", "rho_e": r})
               for r, colour in zip(radii, ("#e3c9ee", "#c79bdb", "#8a5a9e", "#4d2060"))}
    draw(bench, "transverse.png", panels_of(transverse, curves, noise="shear"),
         "mean size of 300 random perturbations in shear, across the path [-]", 4, plt)
