# SPDX-License-Identifier: MIT
"""Growth of a standing wave with seepage inertia against the roots of the linearised balance equations."""
import numpy as np
from tools import tables
from tools.page import Page, Script, Tolerance

PAGE = Page(
    claim="with the seepage inertia terms plane waves in unsaturated soil grow, as the equations predict; without them "
          "they do not at the wave numbers of a mesh",
    kind="exact",
    input="`scene.nml`: half a wave between two impermeable walls, v_z = v sin(k z) at the start, constrained modulus "
          "13 MPa, 12 quadratic cells, 250 steps an e-folding "
          "time, trapezoidal; 125, 250 and 500 per metre",
    reference="roots of the determinant of the linearised equations; `growth.csv` by eigenvalues",
    seconds=6, quick=3, pictures=("seepage_inertia.png",))
MAKES = (Script("growth.py", ("growth.csv", "history.csv", "agreement.csv"), 15),)

E0, RHO_S, RHO_W, RHO_A, K_W, K_A, PERMEABILITY, ETA_W, ETA_A = (0.8, 2.65, 1.0, 1.2e-3, 2.2e6, 101.325, 5e-10, 1e-6,
                                                                 1.8e-8)
FITTED = Tolerance("decaying roots and faster modes of the mesh, excited by rounding, are left in the fit; period "
                   "elongation", absolute=0.01)
DECAY = Tolerance("every root decays")
NO_GROWTH = Tolerance("not more than at the start", absolute=1.0)
GROWTH = Tolerance("only the sign is claimed")


def growth(k, p_c, modulus=1.3e4, inertia=True):
    """Root with the largest real part of det(A2 s**2 + A1 s + A0) for (volume strain, p_w, p_c) exp(s t + i k z)."""
    a = (p_c * E0**2 / 5) ** 2
    log_sum = np.log(np.e + a)
    s = 1 / log_sum
    slope = -s / log_sum * a / (np.e + a) * 2          # d S / d ln p*
    s_p, s_v = slope / p_c, slope * 2 / E0 * (1 + E0)
    n = E0 / (1 + E0)
    kw, ka = PERMEABILITY / ETA_W * max(s**3, 1e-4), PERMEABILITY / ETA_A * max((1 - s) ** 2 * (1 - s**2), 1e-4)
    rho = (1 - n) * RHO_S + n * s * RHO_W + n * (1 - s) * RHO_A
    air = n * (1 - s) / K_A
    a2 = np.array([[rho, 0, 0], [-inertia * (kw * RHO_W + ka * RHO_A), 0, 0], [-inertia * ka * RHO_A, 0, 0]])
    a1 = np.array([[0, 0, 0], [1, n * s / K_W + air, air], [(1 - s) - n * s_v, air, air - n * s_p]])
    a0 = k * k * np.array([[modulus + p_c * s_v, -1, -(1 - s) + p_c * s_p], [0, kw + ka, ka], [0, ka, ka]])
    # The determinant has degree 4 in s: interpolated on a circle of the expected size and solved.
    size = 80.0 * k   # about the elastic wave's frequency
    points = size * np.exp(2j * np.pi * np.arange(8) / 8)
    values = np.array([np.linalg.det(a2 * p * p + a1 * p + a0) for p in points])
    coefficients = np.real(np.fft.fft(values) / 8)[:5]
    roots = size * np.roots(coefficients[::-1])
    return roots[np.argmax(roots.real)]


def fitted(t, y):
    """Complex rate of y = exp(a t) cos(b t + c), from the recurrence of equidistant samples."""
    stride = 12   # less than half a period, or the frequency folds
    y0, y1, y2 = y[:-2 * stride], y[stride:-stride], y[2 * stride:]
    (p, q), *_ = np.linalg.lstsq(np.stack([y1, y0], 1), y2, rcond=None)
    roots = np.log(np.roots([1, -p, -q]).astype(complex)) / (stride * (t[1] - t[0]))
    return roots[np.argmax(roots.imag)]


def check(bench):
    """Complex rates of growth by wave number."""
    measured = {}
    for k in (125,) if bench.quick else (125, 250, 500):
        exact = growth(k, 3.0)
        life = 1e-3 * 1283 / exact.real
        length = np.pi / k
        changes = [("0.025132741228718346", repr(float(length))), ("z = 0.012566370614359173", f"z = {length / 2}"),
                   ("wave_number = 125", f"wave_number = {k}"), ("duration = 0.004", f"duration = {3 * life}"),
                   ("dt = 4.0e-6", f"dt = {life / 250}"), ("r = 0, 0.002", f"r = 0, {0.25 / k}"),
                   ("wave = 1.0e-6", f"wave = {1.25e-4 / k}")]
        h = tables.columns(bench.host("scene.nml", changes) / "histories.csv")
        late = h["time"] > 1.5 * life
        rate = fitted(h["time"][late], h["middle.v_z"][late])
        bench.note(f"wave number {k}/m: growth {rate.real:.1f}, frequency {abs(rate.imag):.1f}; linearised "
                   f"{exact.real:.1f}, {abs(exact.imag):.1f} 1/s")
        bench.below(f"wave number {k}: growth rate", abs(rate.real / exact.real - 1), FITTED)
        bench.below(f"wave number {k}: frequency", abs(abs(rate.imag) / abs(exact.imag) - 1), FITTED)
        measured[k] = rate
    bench.below("largest growth rate without seepage inertia", max(growth(k, p, inertia=False).real for k in (125, 500)
                                                                   for p in (3.0, 10.0, 1000.0)), DECAY, "1/s")
    h = tables.columns(bench.host("scene.nml", [("seepage_inertia = 'yes'",
                                                 "seepage_inertia = 'no'")]) / "histories.csv")
    v = np.abs(h["middle.v_z"])
    bench.below("without: velocity at the end / at the start", v[-50:].max() / v[0], NO_GROWTH)
    bench.note("suction 10 and 1000 kPa, wave number 500/m:", *(f"{growth(500, p).real:.0f}" for p in (10.0, 1000.0)),
               "1/s")
    bench.below("sign at 10 and 1000 kPa (-growth)", max(-growth(500, p).real for p in (10.0, 1000.0)), GROWTH, "1/s")
    return measured


def texts(bench):
    """The tables of growth.py."""
    rows, lines = tables.rows(bench.here / "growth.csv", header_in_comment=True), []
    for suction in dict.fromkeys(row["suction"] for row in rows):
        of = [row for row in rows if row["suction"] == suction]
        waves = ", ".join(f"{float(row['wave_number']):g}" for row in of)
        lines.append((f"{float(suction):g}", f"{float(of[0]['modulus']):.1f}",
                      *(", ".join(f"{float(row[name]):+.1f}" for row in of)
                        for name in ("growth", "growth_without_inertia"))))
    return {"README.md": {
        "growth": tables.markdown(("suction [kPa]", "E [kPa]", f"growth per second at {waves} per metre",
                                   "without seepage inertia"), lines),
        "agreement": tables.markdown(("check", "suction [kPa]", "off by"), [
            tuple(row.values()) for row in tables.rows(bench.here / "agreement.csv")])}}


def draw(bench, measured, plt):
    figure, axis = plt.subplots(figsize=(3.8, 3.2))
    ks = np.geomspace(30, 8000, 120)
    for p, colour in ((3.0, "C0"), (10.0, "C1"), (1000.0, "C2")):
        axis.semilogx(ks, [growth(k, p).real for k in ks], color=colour, label=f"suction {p:g} kPa, linearised")
    axis.semilogx(list(measured), [r.real for r in measured.values()], "ko", ms=5, label="host, 3 kPa")
    axis.set(xlabel="wave number [1/m]", ylabel="growth rate [1/s]")
    axis.set_ylim(-500, 3500)
    axis.legend(fontsize=7)
    bench.save(figure, "seepage_inertia.png")
