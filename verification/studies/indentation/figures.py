# SPDX-License-Identifier: MIT
"""Pictures of the indentation benchmark: columns of histories in, files out."""
from tools.pictures import pyplot

plt = pyplot()

COLOURS = {"remedy": "#c8553d", "as_published": "#0b3c6f", "classic": "#3a8f6a"}
WORDS = {"remedy": "with the remedy", "as_published": "as published, without it",
         "classic": "without it, with guards"}
STYLE = {"font.size": 9, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
         "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.2,
         "axes.titlesize": 9, "figure.constrained_layout.use": True}


def save(figure, path):
    figure.savefig(path, dpi=110)
    plt.close(figure)
    return path


def load(columns, path):
    """Fig. 2: load against time, as the run applied it."""
    with plt.rc_context(STYLE):
        figure, axis = plt.subplots(figsize=(4.5, 2.8))
        axis.plot(columns["t_ms"], columns["load_kN"], color="black", label="load on the plate, weight included")
        axis.plot(columns["t_ms"], columns["thrust_kN"], color=COLOURS["remedy"], lw=0.9, label="contact force")
        axis.set(xlabel="time [ms]", ylabel="force [kN]", xlim=(0, 40), ylim=(0, None))
        axis.legend(loc="upper right", fontsize=8)
        return save(figure, path)


def interface(runs, path, suction=30):
    """Fig. 3: displacement, p_w, p_c, S_w under the centre; `runs` by series."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(8.5, 5.4), sharex=True)
        parts = (("u_mm", "a) displacement [mm]"), ("p_w_kPa", "b) pore water pressure [kPa]"),
                 ("p_c_kPa", "c) suction [kPa]"), ("S_w", "d) degree of saturation [-]"))
        for axis, (key, title) in zip(axes.flat, parts):
            for series, columns in runs.items():
                axis.plot(columns["t_ms"], columns[key], color=COLOURS[series], lw=1.4 if series == "remedy" else 0.9,
                          label=WORDS[series], zorder=3 if series == "remedy" else 2)
            axis.set_title(title, loc="left")
            axis.axvline(14, color="#999999", lw=0.8, ls=":")
            axis.axvline(28, color="#999999", lw=0.8, ls=":")
            axis.ticklabel_format(useOffset=False)
        axes[0, 0].invert_yaxis()
        axes[0, 0].legend(loc="upper center", fontsize=8)
        for axis in axes[1]:
            axis.set(xlabel="time [ms]", xlim=(0, 40))
        figure.suptitle(f"Under the centre of the plate, initial suction {suction} kPa; dotted: peak and end of the "
                        f"load",
                        fontsize=9)
        return save(figure, path)


def newton(runs, path):
    """Fig. 4: error after the first and after the last iteration of every step; `runs`: (title, columns, tolerance)."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, len(runs), figsize=(2.6 * len(runs) + 1.2, 5), sharex=True, sharey=True,
                                    squeeze=False)
        for column, (title, e, tolerance) in enumerate(runs):
            second = e["iterations"] > 1
            for axis, key, mask in ((axes[0, column], "first", slice(None)), (axes[1, column], "last", second)):
                axis.semilogy(e["t_ms"][mask], e[key][mask], ".", ms=2.5, color="#0b3c6f")
                axis.axhline(tolerance, color="#c8553d", lw=0.9)
                axis.axvline(14, color="#999999", lw=0.8, ls=":")
                axis.axvline(28, color="#999999", lw=0.8, ls=":")
            axes[0, column].set_title(title)
            axes[1, column].annotate(f"{second.sum()} of {len(second)} steps", (0.03, 0.97), xycoords="axes fraction",
                                     va="top")
            axes[1, column].set(xlabel="time [ms]", xlim=(0, 40))
        axes[0, 0].set_ylabel("a) error after the first iteration")
        axes[1, 0].set_ylabel("b) after the last, where there are more")
        return save(figure, path)


def displacement(runs, path):
    """Fig. 5: displacement of the centre with and without the remedy; `runs`: suction label -> series -> columns."""
    with plt.rc_context(STYLE):
        rows = (len(runs) + 2) // 3
        figure, axes = plt.subplots(rows, 3, figsize=(10, 2.6 * rows), sharex=True, squeeze=False)
        for axis in axes.flat[len(runs):]:
            axis.axis("off")
        for axis, (title, by_series) in zip(axes.flat, runs.items()):
            for series, columns in by_series.items():
                axis.plot(columns["t_ms"], columns["u_mm"], color=COLOURS[series], ls="-" if series == "remedy"
                          else "--",
                          label=WORDS[series], lw=1.6 if series == "remedy" else 1.2)
            axis.axvline(14, color="#999999", lw=0.8, ls=":")
            axis.set_title(title)
            axis.set_xlim(0, 40)
            axis.invert_yaxis()
        for axis in axes.flat[max(0, len(runs) - 3):len(runs)]:
            axis.set_xlabel("time [ms]")
            axis.tick_params(labelbottom=True)
        for axis in axes[:, 0]:
            axis.set_ylabel("displacement [mm]")
        axes.flat[0].legend(loc="upper right", fontsize=8)
        return save(figure, path)


def tornado(parts, path):
    """Change of the final displacement by every variation, with and without the remedy; the band is the remedy's
    effect."""
    if not parts:
        return None
    names = list(dict.fromkeys(what for _, _, lines in parts.values() for what, *_ in lines))
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, len(parts), figsize=(3.6 + 2.3 * len(parts), 1.2 + 0.2 * len(names)),
                                    sharey=True, squeeze=False)
        for axis, (suction, (final, effect, lines)) in zip(axes.flat, parts.items()):
            axis.axvspan(-effect, effect, color="#c8553d", alpha=0.15, lw=0, label="effect of the remedy")
            axis.axvline(0, color="#555555", lw=0.8)
            for what, a, b in lines:
                place = len(names) - names.index(what)
                axis.barh(place, a, height=0.75, color="#c8553d")
                axis.plot(b, place, "d", ms=3.5, color="#0b3c6f")
                if a != a and b != b:
                    axis.annotate("-", (0, place), va="center", ha="center", color="#555555")
            axis.set_title(f"{suction} kPa (final {final:.3g} mm)")
            linear = max(effect, 2e-3)
            axis.set_xscale("symlog", linthresh=linear, linscale=0.6)
            left, right = axis.get_xlim()
            powers = [10.0**k for k in range(-3, 2) if 10.0**k > 1.5 * linear]
            axis.set_xticks([x for x in (*(-v for v in powers), 0, *powers) if left <= x <= right])
            axis.set_xlabel("change [mm]")
            axis.grid(axis="y", visible=False)
            axis.tick_params(axis="x", labelrotation=45, labelsize=7)
        axes[0, 0].set_yticks([len(names) - i for i in range(len(names))], names, fontsize=8)
        axes[0, 0].set_ylim(0.3, len(names) + 0.7)
        handles = [plt.Rectangle((0, 0), 1, 1, color="#c8553d"),
                   plt.Line2D([], [], color="#0b3c6f", marker="d", ls="", ms=4),
                   plt.Rectangle((0, 0), 1, 1, color="#c8553d", alpha=0.15)]
        figure.legend(handles, ["with the remedy", "without", "size of the remedy's effect"],
                      loc="outside lower center", ncols=3)
        figure.suptitle("Change of the final displacement of the centre", fontsize=10)
        return save(figure, path)
