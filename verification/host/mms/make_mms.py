# SPDX-License-Identifier: MIT
"""Manufactured solutions: writes manufactured.f90 and samples.csv.

The Fortran module follows the chain rule by hand over derivatives that sympy writes into it. The samples take another
way: stress tensor, cylindrical divergence and fluxes are written out from their definitions, differentiated by sympy as
they stand, and evaluated with 60 digits (the axis is approached as r = 1e-25).
"""
import csv
import math
import pathlib

import mpmath
import sympy as sp
from sympy.printing.fortran import FCodePrinter
from tools.results import folder

here = pathlib.Path(__file__).parent
mpmath.mp.dps = 60

# name, value, comment; kPa, m, s, Mg. Chosen so that every term of the equations matters, not for realism.
MATERIAL = [
    ("young", "5000", "Young's modulus [kPa]."),
    ("poisson", "0.3", "Poisson's ratio [-]."),
    ("e_0", "0.8", "Void ratio where u = 0 [-]."),
    ("rho_s", "2.7", "Density of the grains [Mg/m3]."),
    ("rho_w", "1.0", "Density of the water [Mg/m3]."),
    ("rho_a", "0.1", "Density of the air, exaggerated [Mg/m3]."),
    ("bulk_w", "20000", "K_w [kPa]."),
    ("bulk_a", "101", "K_a [kPa]."),
    ("k", "5e-10", "Intrinsic permeability [m2]."),
    ("eta_w", "1e-6", "Viscosity of the water [kPa s]."),
    ("eta_a", "1e-7", "Viscosity of the air, exaggerated [kPa s]."),
    ("gravity", "9.81", "Along -z [m/s2]."),
    ("s_min", "0.05", "S_min of the retention curve [-]."),
    ("s_max", "1.0", "S_max of the retention curve [-]."),
    ("p_entry", "5", "P_a of the retention curve [kPa]."),
    ("n_x", "2", "Exponent n_x [-]."),
    ("m_x", "1", "Exponent m_x [-]."),
    ("omega", "2", "Exponent Omega of the void ratio [-]."),
]
# base, amplitude, length, wave, shift, rate, swing, omega, phase
FIELDS = {
    "u_over_r": ("0", "0.01", "1.2", "2.0", "0.3", "0.5", "0.8", "40", "0.2"),
    "u_z": ("0", "0.015", "1.1", "1.7", "-0.9", "0.4", "0.7", "40", "0.7"),
    "p_w": ("-15", "6", "0.9", "2.3", "0.5", "0.6", "0.5", "40", "1.1"),
    "p_c": ("18", "5", "1.0", "1.9", "-0.4", "-0.5", "0.6", "40", "0.4"),
}
COMMENTS = {"u_over_r": "u_r/r [-].", "u_z": "u_z [m].", "p_w": "p_w [kPa].", "p_c": "p_c [kPa]."}
KEYS = "base amplitude length wave shift rate swing omega phase".split()

r, z, t = sp.symbols("r z t", positive=True)


def product(q):
    """A field in space and time, its part in space, its factor in time."""
    space = q["amplitude"]*sp.exp(-(r/q["length"])**2)*sp.cos(q["wave"]*z + q["shift"])
    time = 1 + q["rate"]*t + q["swing"]*sp.sin(q["omega"]*t + q["phase"])
    return q["base"] + space*time, space, time


def modified_suction(p_c, e, q):
    return (p_c*e**q["omega"]/q["p_entry"])**q["n_x"]


def saturation(a, q):
    return q["s_min"] + (q["s_max"] - q["s_min"])*sp.log(sp.E + a)**(-q["m_x"])


def retention(p_c, e, q):
    return saturation(modified_suction(p_c, e, q), q)


def corey(s):
    return s**3, (1 - s)**2*(1 - s**2)


# ---- the Fortran module ------------------------------------------------------------------------------------------

class Fortran(FCodePrinter):
    """Doubles with their kind and integer powers left alone."""
    def _print_Integer(self, expr):
        return str(int(expr))

    def _print_Rational(self, expr):
        return f"{int(expr.p)}.0_wp/{int(expr.q)}.0_wp"

    def _print_Float(self, expr):
        return f"{float(expr)!r}_wp"

    def _print_Exp1(self, expr):
        return "exp(1.0_wp)"


def assignments(pairs):
    """Fortran lines `name = expression` at 6 columns, wrapped."""
    printer = Fortran({"source_format": "free", "standard": 2008})
    lines = []
    for name, expr in pairs:
        text = printer.doprint(sp.simplify(expr)).replace("\n", " ").replace("& ", "").replace("&", "")
        text = "      " + name + " = " + " ".join(text.split())
        while len(text) > 118:
            cut = max(text.rfind(c, 0, 112) for c in " *")
            lines.append(text[:cut + 1].rstrip() + " &")
            text = "         " + text[cut + 1:].lstrip()
        lines.append(text)
    return "\n".join(lines)


def write_module():
    q = {k: sp.Symbol(k, real=True) for k in KEYS}
    q["length"] = sp.Symbol("length", positive=True)
    _, f, time = product(q)
    space = [("d%f", f), ("d%z", f.diff(z)), ("d%zz", f.diff(z, 2)), ("d%r_over_r", f.diff(r)/r),
             ("d%rz_over_r", f.diff(r, z)/r), ("d%rr", f.diff(r, 2))]
    p_c, e, a, slope = sp.symbols("p_c e a slope", positive=True)
    m = {k: sp.Symbol(k, positive=True) for k in "s_min s_max p_entry n_x m_x omega".split()}
    power = modified_suction(p_c, e, m)
    s_w = saturation(a, m)
    keep = [("a", power), ("s_w", s_w), ("slope", s_w.diff(a)*a), ("ds_dc", slope*power.diff(p_c)/power),
            ("ds_de", slope*power.diff(e)/power)]
    s = sp.Symbol("s", positive=True)
    k_w, k_a = corey(s)
    rel = [("k_w", k_w), ("k_a", k_a), ("dk_w", sp.factor(k_w.diff(s))), ("dk_a", sp.factor(k_a.diff(s)))]

    def real(text):
        text = repr(float(text))
        return text + "_wp"
    rows = [f"      real(wp) :: {n} = {real(v)}" for n, v, _ in MATERIAL]
    width = max(map(len, rows))
    rows = [row.ljust(width) + f"  !< {c}" for row, (_, _, c) in zip(rows, MATERIAL)]
    for name, values in FIELDS.items():
        rows.append(f"      !> {COMMENTS[name]}")
        rows.append(f"      type(product_t) :: {name} = product_t(" + ", ".join(map(real, values)) + ")")
    text = (here/"manufactured.f90.in").read_text()
    for mark, block in {"PARAMETERS": "\n".join(rows), "SPACE": assignments(space),
                        "TIME": assignments([(f"time({i + 1})", time.diff(t, i)) for i in range(3)]),
                        "RETENTION": assignments(keep), "COREY": assignments(rel)}.items():
        text = text.replace(f"@{mark}@", block)
    too_long = [line for line in text.splitlines() if len(line) > 120]
    assert not too_long, too_long
    (folder(__file__)/"manufactured.f90").write_text(text)


# ---- the samples, from the definitions ----------------------------------------------------------------------------

def solution(axisymmetric, fields, inertia, rate_of_e, linear, fixed_density, material):
    """Symbolic solution and loads, everything written out from the definitions."""
    q = {n: sp.Rational(v) if "e" not in v else sp.Rational(str(sp.Float(v, 30))) for n, v, _ in MATERIAL}
    q.update({k: sp.Rational(v) for k, v in material.items()})
    q["k"], q["eta_w"], q["eta_a"] = sp.Rational(5, 10**10), sp.Rational(1, 10**6), sp.Rational(1, 10**7)
    f = {}
    for name, values in FIELDS.items():
        par = dict(zip(KEYS, map(sp.Rational, values)))
        if linear:
            par["swing"] = sp.Integer(0)
        f[name] = product(par)[0]
    u_r, u_z = r*f["u_over_r"], f["u_z"]
    p_w = f["p_w"] if fields >= 2 else sp.Integer(0)
    p_c = f["p_c"] if fields >= 3 else sp.Integer(0)
    a_r, a_z = u_r.diff(t, 2), u_z.diff(t, 2)
    over_r = 1/r if axisymmetric else 0

    def div(v_r, v_z):
        return v_r.diff(r) + v_r*over_r + v_z.diff(z)
    eps = {"rr": u_r.diff(r), "zz": u_z.diff(z), "tt": u_r*over_r, "rz": (u_r.diff(z) + u_z.diff(r))/2}
    volume = eps["rr"] + eps["zz"] + eps["tt"]
    mu = q["young"]/(2*(1 + q["poisson"]))
    lam = q["young"]*q["poisson"]/((1 + q["poisson"])*(1 - 2*q["poisson"]))
    e = (1 + q["e_0"])*sp.exp(volume) - 1
    n = e/(1 + e)
    ps, es = sp.symbols("ps es", positive=True)
    if fields == 3:
        curve = retention(ps, es, q)
        at = {ps: p_c, es: e}
        s_w = curve.subs(at)
        s_rate = s_w.diff(t) if rate_of_e else curve.diff(ps).subs(at)*p_c.diff(t)
        s_e = (s_w - q["s_min"])/(q["s_max"] - q["s_min"])
    else:
        s_w = s_e = sp.Integer(1)
        s_rate = sp.Integer(0)
    k_rw, k_ra = corey(s_e)
    effective = {i: -2*mu*eps[i] - (lam*volume if i != "rz" else 0) for i in eps}
    pore = p_w + (1 - s_w)*p_c
    total = {i: effective[i] + (pore if i != "rz" else 0) for i in eps}
    rho = (1 - n)*q["rho_s"] + (n*s_w*q["rho_w"] + n*(1 - s_w)*q["rho_a"] if fields > 1 else 0)
    if fixed_density:
        rho = sp.Rational(fixed_density)
    g = q["gravity"]
    div_r = total["rr"].diff(r) + (total["rr"] - total["tt"])*over_r + total["rz"].diff(z)
    div_z = total["rz"].diff(r) + total["rz"]*over_r + total["zz"].diff(z)
    i = 1 if inertia else 0
    p_a = p_w + p_c
    zero = sp.Integer(0)
    out = {"u_r": u_r, "u_z": u_z, "v_r": u_r.diff(t), "v_z": u_z.diff(t), "a_r": a_r, "a_z": a_z,
           "p_w": p_w, "p_c": p_c, "p_w_rate": p_w.diff(t), "p_c_rate": p_c.diff(t),
           "void_ratio": e, "s_w": s_w, "rho": rho, "body_r": rho*a_r + div_r, "body_z": rho*(a_z + g) + div_z,
           "source_w": zero, "source_a": zero}
    out.update({f"total_{j}": total[j] for j in ("rr", "zz", "tt", "rz")})
    out.update(q_w_r=zero, q_w_z=zero, q_a_r=zero, q_a_z=zero)
    if fields >= 2:
        kw = -q["k"]/q["eta_w"]*k_rw
        q_w = [kw*(p_w.diff(r) + i*q["rho_w"]*a_r), kw*(p_w.diff(z) + q["rho_w"]*(g + i*a_z))]
        out["q_w_r"], out["q_w_z"] = q_w
        out["source_w"] = n*s_w/q["bulk_w"]*p_w.diff(t) + n*s_rate + s_w*volume.diff(t) + div(*q_w)
    if fields >= 3:
        ka = -q["k"]/q["eta_a"]*k_ra
        q_a = [ka*(p_a.diff(r) + i*q["rho_a"]*a_r), ka*(p_a.diff(z) + q["rho_a"]*(g + i*a_z))]
        out["q_a_r"], out["q_a_z"] = q_a
        out["source_a"] = n*(1 - s_w)/q["bulk_a"]*p_a.diff(t) - n*s_rate + (1 - s_w)*volume.diff(t) + div(*q_a)
    return out


# axisymmetric, fields, seepage inertia, dS_w/de in the rate, linear in time, fixed density, other material
CASES = [(1, 3, 0, 1, 0, None, {}), (0, 3, 0, 1, 0, None, {}), (1, 3, 1, 1, 0, None, {}), (1, 3, 0, 1, 1, None, {}),
         (1, 3, 0, 0, 0, None, {}), (1, 2, 0, 1, 0, None, {}), (1, 2, 1, 1, 0, None, {}), (0, 2, 1, 1, 0, None, {}),
         (1, 1, 0, 1, 0, None, {}), (0, 1, 0, 1, 0, None, {}), (0, 3, 1, 1, 0, "1.9", {}),
         (1, 3, 0, 1, 0, None, {"omega": "1.5", "n_x": "1.8", "m_x": "0.9", "poisson": "0.2", "s_max": "0.98"})]
POINTS = [("0", "0", "0"), ("0", "0.7", "0.013"), ("0.25", "0.1", "0.05"), ("0.5", "0.5", "0.021"), ("1", "1", "0.1"),
          ("0.03", "0.9", "0.002"), ("0.8", "0.35", "0.037")]


def write_samples():
    rows, ranges = [], {}
    for number, case in enumerate(CASES, 1):
        out = solution(*case)
        names = list(out)
        call = sp.lambdify((r, z, t), list(out.values()), "mpmath")
        for point in POINTS:
            x = [mpmath.mpf(v) for v in point]
            x[0] = x[0] or mpmath.mpf("1e-25")
            values = [float(v) if abs(v) > 1e-20 else 0.0 for v in map(mpmath.mpf, call(*x))]
            density = float(case[5] or 0)
            rows.append([number, *map(int, case[:5]), density, *map(float, point), *values])
    with open(folder(__file__)/"samples.csv", "w", newline="") as file:
        file.write("# manufactured solutions at sample points, from the definitions by sympy and mpmath (make_mms.py)\n"
                   "# kPa, m, s, Mg; pressures and stress compression positive; p_c = p_a - p_w\n"
                   "# case 12 has other values: omega 1.5, n_x 1.8, m_x 0.9, poisson 0.2, s_max 0.98\n"
                   "# " + ",".join(["case", "axisymmetric", "fields", "seepage_inertia", "void_ratio_rate", "linear",
                                    "fixed_density", "r", "z", "t", *names]) + "\n")
        csv.writer(file, lineterminator="\n").writerows([[repr(v) for v in row] for row in rows])
    # Range of the default solution over the unit square and the first 0.2 s, for the README.
    out = solution(*CASES[0])
    call = sp.lambdify((r, z, t), [out[k] for k in ("p_w", "p_c", "s_w", "void_ratio", "rho")], "math")
    for k in range(21):
        for i in range(21):
            for j in range(11):
                for name, v in zip(("p_w", "p_c", "s_w", "e", "rho"), call(max(i/20, 1e-9), j/10, k/100)):
                    low, high = ranges.get(name, (math.inf, -math.inf))
                    ranges[name] = (min(low, v), max(high, v))
    print({k: (round(a, 4), round(b, 4)) for k, (a, b) in ranges.items()})


if __name__ == "__main__":
    write_module()
    write_samples()
