# SPDX-License-Identifier: MIT
"""Localisation: onset and normal of bands beside Rudnicki & Rice's, bands of a sample, and which answers of a plate on sand have a
limit."""
import re
from pathlib import Path

import numpy as np

from tools import tables
from tools.page import Page, Script, Tolerance

HERE = Path(__file__).parent
PAGE = Page(
    claim="a run tells when the tangent of its soil loses ellipticity, and bands form in the direction that the tensor gives; settlements of "
          "soil that does have no limit on finer meshes, forces on it have, and a viscosity gives both",
    kind=("exact", "study"),
    input="`element.nml`, `sample.nml`: the Drucker-Prager UMAT of the tests, associated and not; the indentation at 3 to 100 kPa and every "
          "scene of the repository whose soil yields (`study.py`)",
    reference="onset and normal: closed form of Rudnicki & Rice (1975); band of the sample: the normal with the least determinant; the rest is "
              "the program beside itself",
    seconds=120, quick=8)
MAKES = (Script("study.py", ("indentation.csv", "scenes.csv"), 1300, alone=True),)

SHEAR, POISSON, FRICTION, START, HARDENING, LAST = 2.0e4 / 2.4, 0.2, 0.6, -30.0, 5.0e3, 0.01
STEP = Tolerance("the law is followed in steps of 0.002: the first one that ends beyond the onset counts", absolute=0.002)
NORMAL = Tolerance("the sentence has whole degrees, and the least determinant, below zero by then, has moved a little from where it was zero",
                   absolute=1.5)
BAND = Tolerance("a band is four to eight cells of 0.1 m wide, and its ends at the sides of the sample bend", absolute=5.0)
NARROW = Tolerance("twice as fine a mesh moves its peak by a quarter at most where a viscosity decides its width", absolute=0.25)


def props(dilatancy):
    return [("2.0e4, 0.2, 0.6, 0.1,", f"2.0e4, 0.2, 0.6, {dilatancy},")]


def run(bench, scene, changes=(), more=()):
    library = [("'drucker_prager.so'", f"'{bench.program('tests/umats/drucker_prager.so').resolve()}'")]
    return bench.host(scene, library + list(changes), more=more)


def moduli(rows, dilatancy):
    """Hardening modulus after every step, from the stress that the law carries, and the largest one with a band at this stress,
    over G; the normal that belongs to it, in degrees from the major principal stress, which is along r."""
    mean = sum(rows[f"top.s_{c}"] for c in ("rr", "zz", "tt")) / 3
    rr, zz, tt = (rows[f"top.s_{c}"] - mean for c in ("rr", "zz", "tt"))
    tau = np.maximum(np.sqrt((rr**2 + zz**2 + tt**2) / 2 + rows["top.s_rz"] ** 2), 1e-9)
    carried = (tau + FRICTION * mean - START) / HARDENING / LAST
    falls = np.arange(len(carried)) > carried.argmax()
    modulus = HARDENING / SHEAR * np.sqrt(np.maximum(0, 1 - 2 * carried)) * np.where(falls, -1, 1)
    out = tt / tau
    critical = (1 + POISSON) / (9 * (1 - POISSON)) * (dilatancy - FRICTION) ** 2 - (1 + POISSON) / 2 * (out + (dilatancy + FRICTION) / 3) ** 2
    xi = (1 + POISSON) * (dilatancy + FRICTION) / 3 - (1 - POISSON) * out
    normal = np.degrees(np.arctan(np.sqrt(np.maximum(0, (rr / tau - xi) / (xi - zz / tau)))))
    return modulus, critical, normal, carried > 1e-9


def onset(bench, dilatancy):
    """Times of the onset, by the ledger and by the closed form, and the modulus there; normals when 5 % are reached, likewise."""
    folder = run(bench, "element.nml", props(dilatancy))
    ledger, rows = tables.columns(folder / "ledger.csv"), tables.columns(folder / "histories.csv")
    modulus, critical, normal, yields = moduli(rows, dilatancy)
    beyond = int((yields & (modulus <= critical)).argmax())
    ahead = (modulus - critical)[beyond - 1:beyond + 1]
    exact = rows["time"][beyond - 1] + (rows["time"][beyond] - rows["time"][beyond - 1]) * ahead[0] / (ahead[0] - ahead[1])
    told = ledger["time"][(ledger["localised"] > 0).argmax()]
    above = int((ledger["localised"] > 0.05).argmax()) + 1   # the histories begin with the start
    said = float(re.search(r"normal at (\d+) degrees", (folder / "log.txt").read_text())[1])
    return told, exact, modulus[beyond], min(said, 180 - said), normal[above]


def band(folder):
    """Normal of the band in degrees [0, 180), and its largest rate of shear: from the displacements of stage `band`."""
    start, end = (tables.columns(folder / f"nodes_{name}.csv") for name in ("shear", "band"))
    r, z = (np.unique(np.round(start[c], 9)) for c in "rz")
    u = np.zeros((2, len(r), len(z)))
    place = np.searchsorted(r, np.round(start["r"], 9)), np.searchsorted(z, np.round(start["z"], 9))
    for k, name in enumerate(("u_r", "u_z")):
        u[k][place] = end[name] - start[name]
    dr, dz = np.diff(r)[:, None], np.diff(z)[None]
    middle = lambda a, axis: (np.delete(a, 0, axis) + np.delete(a, -1, axis)) / 2   # noqa: E731
    opening = middle(np.diff(u[0], axis=0) / dr, 1) - middle(np.diff(u[1], axis=1) / dz, 0)
    shear = np.hypot(opening, middle(np.diff(u[0], axis=1) / dz, 0) + middle(np.diff(u[1], axis=0) / dr, 1))
    peak = np.quantile(shear, 0.995)
    weight = dr * dz * np.where(shear > 0.5 * peak, shear, 0)
    x, y = np.meshgrid(middle(r, 0), middle(z, 0), indexing="ij")
    points = np.array([x.ravel(), y.ravel()])
    _, axes = np.linalg.eigh(np.cov(points, aweights=weight.ravel()))
    return float(np.degrees(np.arctan2(axes[1, 0], axes[0, 0])) % 180), float(peak)


def check(bench):
    for name, dilatancy in (("far from associated", -0.4), ("not associated", 0.1), ("associated", 0.6)):
        told, exact, modulus, said, normal = onset(bench, dilatancy)
        bench.note(f"{name}: hardening modulus over G at the onset {modulus:.3f}")
        bench.near(f"{name}: onset, time", told, exact, STEP)
        bench.near(f"{name}: normal, degrees from r", said, normal, NORMAL)
    found = {}
    for name, more in SAMPLES.items():
        if bench.quick and name != "viscosity 20":
            continue
        folder = run(bench, "sample.nml", more=[word for key in more for word in ("--set" if "=" in key else "--fineness", key)])
        found[name] = band(folder)
        rows = tables.columns(folder / "histories.csv")
        bench.note(f"{name}: normal {found[name][0]:.1f} degrees, rate of shear {found[name][1]:.4f}, last {rows['time'][-1]:.3f} s")
        bench.near(f"sample, {name}: normal of the band, degrees", found[name][0], NORMAL_OF_TENSOR, BAND)
    if not bench.quick:
        bench.below("sample, viscosity 20: peak of the shear on the finer mesh over the coarser, less one",
                    abs(found["viscosity 20, finer"][1] / found["viscosity 20"][1] - 1), NARROW)
    return None


# Of the two normals with the least determinant, 38 degrees on both sides of r when 5 % are reached, the one of a band that rises from the
# weak corner.
NORMAL_OF_TENSOR = 142.0
VISCOUS = ("region[1].viscosity=20", "region[2].viscosity=20")
SAMPLES = {"viscosity 20": VISCOUS, "viscosity 20, finer": (*VISCOUS, "2"),
           "damping 1000, no viscosity": ("stage.analysis=dynamic", "region[1].damping=1000", "region[2].damping=1000")}


def texts(bench):
    rows = tables.rows(HERE / "indentation.csv")
    head = ("suction [kPa]", "viscosity [kPa s]", "fineness", "largest share", "above 5 % from [ms]", "settlement [mm]", "thrust [kN]",
            "impulse up to 14 ms [kN s]", "p_w under the centre at 14 ms [kPa]")
    plate = tables.markdown(head, [(r["suction"], r["viscosity"], r["fineness"], f"{100 * float(r['share']):.2f} %", r["since_ms"] or "-",
                                    f"{float(r['settlement_mm']):.3f}", f"{float(r['thrust_kN']):.3f}", f"{float(r['impulse_kNs']):.5f}",
                                    f"{float(r['p_w_kPa']):.3f}") for r in rows])
    scenes = tables.markdown(("scene", "largest share", "above 5 % from [s]", "run", "most of it at, normal"), [
        (r["scene"], f"{100 * float(r['share']):.2f} %", r["since"] or "-", r["done"], r["words"] or "-")
        for r in tables.rows(HERE / "scenes.csv")])
    return {"README.md": {"indentation": plate, "scenes": scenes}}
