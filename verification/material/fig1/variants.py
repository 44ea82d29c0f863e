# SPDX-License-Identifier: MIT
"""Variants of the untreated reversal rule on the path of the paper's Fig. 1: does any jump upwards?

The equations of the model in triaxial space (compression positive, undrained, saturated, no guard), written apart from
the library: one explicit integration with small fixed substeps, one switch for each way in which a program may treat a
reversal. As a program it prints the table of the README and writes it as variants.csv.
"""
import math

K_0, G_0, N_C, LAMBDA, ALPHA, N_L, THETA = 150.0, 125.0, 18.7, 0.37, 3370.0, 25.0, 0.2
M_C, C, N_B, N_D, A_0, H_0, C_H, C_Z, Z_MAX = 1.25, 0.712, 1.25, 2.1, 0.4, 12.0, 0.968, 600.0, 4.0
P_ATM, E = 101.325, 0.735
ROOT = math.sqrt(2 / 3)
INCREMENT, AMPLITUDE, AT, END = 1e-5, 1.5e-4, 0.10, 0.15
MARKS = (0.1005, 0.105, 0.15)

# name: (what differs, switches)
VARIANTS = {
    "as stated": ("memory set to the stress ratio as soon as x < 0, tested in every substep", {}),
    "once per call": ("tested at the start of each increment only", {"test": "call"}),
    "x from the trial": ("direction of the strain increment decides, at its sign changes only", {"test": "sign"}),
    "floor 1e-3": ("as stated, x at least 1e-3", {"floor": 1e-3}),
    "floor 1e-2": ("as stated, x at least 1e-2", {"floor": 1e-2}),
    "floor 0.1": ("as stated, x at least 0.1", {"floor": 0.1}),
    "no softening": ("sign changes; hardening is zero outside the bounding surface",
                     {"test": "sign", "outside": "zero"}),
    "hardening outside": ("sign changes; the distance to the bounding surface counts as positive",
                          {"test": "sign", "outside": "positive"}),
    "elastic outside": ("sign changes; elastic where the plastic multiplier comes out negative",
                        {"test": "sign", "negative": "elastic"}),
    "|x|, unloading only": ("memory set when unloading begins, kept on reloading; |r - r_in|",
                            {"test": "unloading", "floor": 1e-6, "absolute": True}),
    "|x|, both": ("sign changes; |r - r_in|", {"test": "sign", "absolute": True}),
}


def run(interrupted=True, test="substep", floor=1e-12, outside="soft", negative="keep", absolute=False, parts=4,
        at=AT):
    """q at the marks after the reload; the path is cut into increments of 1e-5 and each into `parts` equal substeps."""
    p, r, z, r_in = 100.0, 0.0, 0.0, 0.0   # r, z, r_in: components along compression of unit deviator norm
    legs = [(round(at / INCREMENT), 1)]
    if interrupted:
        legs += [(round(AMPLITUDE / INCREMENT), -1), (round(AMPLITUDE / INCREMENT), 1)]
    legs.append((round((END - AT) / INCREMENT), 1))
    marks, values, strain, forward = [at + m - AT for m in MARKS], [], 0.0, 1
    elastic_share = 0

    def rate(p, r, z, s, d):
        """(dp, dr, dz, negative multiplier) for the strain rate d of sign s in the norm of the deviator."""
        k = K_0 * P_ATM * (1 + E) / E * (p / P_ATM) ** (2 / 3)
        g = G_0 * P_ATM * (2.97 - E) ** 2 / (1 + E) * math.sqrt(p / P_ATM)
        psi = E - N_C * (p + ALPHA) ** -LAMBDA
        lode = (2 * C**4 / (1 + C**4 - (1 - C**4) * s)) ** 0.25
        lode_r = (2 * C**4 / (1 + C**4 - (1 - C**4) * (1 if r >= 0 else -1))) ** 0.25
        bound = ROOT * lode * M_C * math.exp(max(-N_B * psi, 0))
        dilatant = ROOT * lode * M_C * math.exp(N_D * psi)
        d_rate = A_0 * (1 + max(s * z, 0)) * (dilatant - s * r)
        x = s * (r - r_in)
        x = max(abs(x) if absolute else x, floor)
        h = H_0 * G_0 * (1 - C_H * E) * (p / P_ATM) ** -0.5 / x
        distance = bound - s * r
        if distance < 0 and outside != "soft":
            distance = 0.0 if outside == "zero" else -distance

        def solve(k_e):
            below = 2 * g - s * r * k_e * d_rate + 2 / 3 * p * h * distance
            multiplier = 2 * g * abs(d) / below
            wrong = below <= 0
            if wrong and negative == "elastic":
                multiplier = 0.0
            return multiplier, -k_e * multiplier * d_rate, wrong
        multiplier, dp, wrong = solve(k)
        weight = 1 - (abs(r) / (ROOT * lode_r * M_C * math.exp(max(-N_B * psi, 0)))) ** 2
        if dp > 0 and weight > 0:   # the isotropic mechanism softens the bulk modulus
            image = (N_L / E) ** (1 / LAMBDA)
            delta = 1 - p / image * (1 + 3 * r * r / M_C**2)
            f = 1 - math.copysign(abs(delta) ** THETA, delta)
            kappa = p / k * (1 + E) / E
            multiplier, dp, wrong = solve(k / (1 + k / p * weight * E / (1 + E) * (LAMBDA - kappa) * f))
        ds = 2 * g * (d - multiplier * s)
        dz = -C_Z * max(-multiplier * d_rate, 0) * (Z_MAX * s + z)
        return dp, (ds - r * dp) / p, dz, wrong

    for count, s in legs:
        if s != forward and test in ("sign", "unloading") and (test == "sign" or s < 0):
            r_in = r
        forward = s
        for _ in range(count):
            d = s * math.sqrt(1.5) * INCREMENT / parts
            if test == "call" and s * (r - r_in) < 0:
                r_in = r
            for _ in range(parts):
                if test == "substep" and s * (r - r_in) < 0:
                    r_in = r
                one = rate(p, r, z, s, d)
                two = rate(p + one[0], r + one[1], z + one[2], s, d)
                p, r, z = (v + 0.5 * (a + b) for v, a, b in zip((p, r, z), one, two))
                elastic_share += one[3]
                if not (0 < p < 1e6 and abs(r) < 10):
                    return values + [math.nan] * (len(marks) - len(values)), elastic_share
            strain += s * INCREMENT
            if strain > at + INCREMENT / 2 and len(values) < len(marks) and strain > marks[len(values)] - INCREMENT / 2:
                values.append(p * r / ROOT)
    return values, elastic_share


def table():
    """Rows: variant, what, q uninterrupted and interrupted at the marks, jump there, effect of the step, refusals."""
    rows = []
    for name, (what, switches) in VARIANTS.items():
        clean = run(**switches, interrupted=False)[0]
        values, refused = run(**switches)
        coarse = run(**{**switches, "parts": 1})[0]
        rows.append([name, what, *(f"{v:.1f}" for v in clean), *(f"{v:.1f}" for v in values),
                     *(f"{100 * (v / c - 1):+.1f}" for v, c in zip(values[:2], clean)),
                     f"{100 * (coarse[1] / values[1] - 1):+.1f}", refused])
    return rows


def main():
    from tools import results, tables
    header = ["variant", "what", *(f"q_clean_{m}" for m in MARKS), *(f"q_{m}" for m in MARKS), "jump_0.1005_pct",
              "jump_0.105_pct", "one_substep_pct", "negative_multipliers"]
    rows = table()
    for row in (header, *rows):
        print(" | ".join(str(v) for v in row))
    tables.write(results.folder(__file__) / "variants.csv", header, rows)


if __name__ == "__main__":
    main()
