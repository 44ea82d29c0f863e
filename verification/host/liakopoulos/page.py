# SPDX-License-Identifier: MIT
"""Liakopoulos' drainage with mobile air against OpenGeoSys (values, digitised profiles) and a finite-volume program."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="u, p_w and p_c with flow of both fluids, retention and relative permeabilities given by formulas, in a "
          "column that starts saturated and lets air in",
    kind="code-to-code",
    input="`scene.nml`: 20 quadratic cells, ideal gas without the gradient of its density, effective stress zero at "
          "the start, rho_inf 0, g 9.81",
    reference="OpenGeoSys 6: four figures at 7200 s and digitised profiles "
              "(`liakopoulos_twophase_ogs6_porouslab.csv`); `liakopoulos.py`, finite volumes written for this page, "
              "variant `no_gradient`, 720 cells. Not the experiment of 1964",
    seconds=6, quick=6, pictures=("liakopoulos.png",))
MAKES = (Script("liakopoulos.py", ("liakopoulos.csv", "ends.csv", "differences.csv"), 150),)

TIMES = (120, 300, 4800, 7200)
OTHER_CODE = Tolerance("the two codes differ in the gas law, gravity (9.806) and the mesh", absolute=0.01)
DIGITISED = Tolerance("digitised to about half a per cent of the axes; on the flank of the front p_a changes by 1 % of "
                      "its range within 0.6 mm of height, and the markers' "
                      "heights are known to 1 mm", absolute=0.03)
FRONT = Tolerance("720 cells of second order there, 20 quadratic elements here, whose steepest gradient is one of 0.05 "
                  "m", absolute=0.015)
SMOOTH = Tolerance("displacements are smooth across the front", absolute=0.001)
# OpenGeoSys at 7200 s, and how the tables write each.
OGS = {"p_c": 9376.64, "p_a": 96911.48, "s_w": 0.913174, "u": 4.64837e-3}
FORMS = {"p_c": ".2f", "p_a": ".2f", "s_w": ".6f", "u": ".5e"}
AXIS_OF = {"pc_Pa": ("p_c", 1e3, 0.0), "uy_m": ("u_z", 1.0, 0.0), "pg_Pa": ("p_a", 1e3, 101325.0)}


def wall(field):
    """Indices of the nodes at r = 0 from the base to the top."""
    on = np.flatnonzero(np.isclose(field["r"], 0))
    return on[np.argsort(field["z"][on])]


def check(bench):
    """Fields by time, digitised profiles."""
    profiles = [r for r in tables.rows(bench.here / "liakopoulos_twophase_ogs6_porouslab.csv") if r["code"] == "ogs"]
    out = bench.host("scene.nml")
    fields = {t: tables.columns(out / f"nodes_t{t}.csv") for t in TIMES}
    f = fields[7200]
    p_a = 1e3 * (f["p_w"] + f["p_c"]) + 101325
    p_c = 1e3 * f["p_c"].max()
    for what, value, reference in (("max p_c", p_c, OGS["p_c"]), ("min p_a", p_a.min(), OGS["p_a"]),
                                   ("largest fall of p_a", 101325 - p_a.min(), 101325 - OGS["p_a"]),
                                   ("min S_w", 1 - 1.9722e-11 * p_c**2.4279, OGS["s_w"]),
                                   ("max |u|", np.abs(f["u_z"]).max(), OGS["u"])):
        bench.note(f"{what}: {value:.6g}, OpenGeoSys {reference:.6g}, {100 * (value / reference - 1):+.3f} %")
        bench.below(f"{what} at 7200 s", abs(value / reference - 1), OTHER_CODE)
    for f in fields.values():
        f["p_a"] = f["p_w"] + f["p_c"]
    against_markers(bench, fields, profiles)
    against_volumes(bench, fields)
    return fields, profiles


def against_markers(bench, fields, profiles):
    """Ten equidistant heights (printed with two digits). At 120 and 300 s the air has hardly entered: only reported."""
    for name, (key, scale, shift) in AXIS_OF.items():
        span = np.ptp([float(r[name]) for r in profiles])
        for t, f in fields.items():
            rows = [r for r in profiles if float(r["t_s"]) == t]
            height = np.round(9 * np.array([float(r["y_m"]) for r in rows])) / 9
            mine = np.interp(height, f["z"][wall(f)], (scale * f[key] + shift)[wall(f)])
            worst = np.max(np.abs(mine - [float(r[name]) for r in rows])) / span
            if t >= 4800:
                bench.below(f"profile of {key} at {t} s / range", worst, DIGITISED)
            else:
                bench.note(f"profile of {key} at {t} s: {100 * worst:.1f} % of the range")


def against_volumes(bench, fields):
    volumes = [r for r in tables.rows(bench.here / "liakopoulos.csv")
               if r["variant"] == "no_gradient"]
    for key, column, scale, shift, allowed in (("p_c", "p_c", 1e3, 0.0, FRONT), ("p_a", "p_a", 1e3, 101325.0, FRONT),
                                               ("u_z", "u", 1.0, 0.0, SMOOTH)):
        for t in (4800, 7200):
            f = fields[t]
            span = np.ptp([float(r[column]) for r in volumes if float(r["t"]) == t])
            z, value = f["z"][wall(f)], (scale * f[key] + shift)[wall(f)]
            pairs = [(np.interp(float(r["z"]), z, value), float(r[column])) for r in volumes if float(r["t"]) == t
                     and np.min(np.abs(z - float(r["z"]))) < 1e-6]
            bench.below(f"finite volumes: {key} at {t} s / range ({len(pairs)} heights)",
                        max(abs(a - b) for a, b in pairs) / span,
                        allowed)


def texts(bench):
    """The tables of liakopoulos.py."""
    ends = tables.rows(bench.here / "ends.csv")
    lines = [("OpenGeoSys 6", *(f"{OGS[name]:{form}}" for name, form in FORMS.items()))]
    lines += [(row["variant"], *(f"{float(row[name]):{form}}, {100 * (float(row[name]) / OGS[name] - 1):+.3f} %"
                                 for name, form in FORMS.items())) for row in ends]
    return {"README.md": {
        "ends": tables.markdown(("", "max p_c [Pa]", "min p_a [Pa]", "min S_w", "max abs u [m]"), lines),
        "differences": tables.markdown(("", "p_w [Pa]", "p_c [Pa]", "p_a [Pa]", "u [m]"), [
            tuple(row.values()) for row in tables.rows(bench.here / "differences.csv")])}}


def draw(bench, results, plt):
    fields, profiles = results
    figure, axes = plt.subplots(1, 3, figsize=(11.4, 3.2))
    for axis, (name, (key, scale, shift)) in zip(axes, AXIS_OF.items()):
        for i, (t, f) in enumerate(fields.items()):
            axis.plot((scale * f[key] + shift)[wall(f)], f["z"][wall(f)], color=f"C{i}", label=f"{t} s")
            rows = [r for r in profiles if float(r["t_s"]) == t]
            axis.plot([float(r[name]) for r in rows], [round(9 * float(r["y_m"])) / 9 for r in rows], "o", ms=3,
                      color=f"C{i}")
        axis.set(xlabel={"p_c": "suction [Pa]", "u_z": "displacement [m]", "p_a": "air pressure [Pa]"}[key],
                 ylabel="height [m]")
        axis.locator_params(axis="x", nbins=4)
    axes[0].legend(title="line: host\no: OpenGeoSys", fontsize=7, title_fontsize=7)
    bench.save(figure, "liakopoulos.png")
