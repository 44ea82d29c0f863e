# SPDX-License-Identifier: MIT
"""Closed forms of the model at a point, written from the theory (docs/theory/material.md) and not from the library."""
import math
import re

from tools.bench import parameters

P = parameters()


def saturation(suction, e):
    if suction <= 0:
        return P["S_max"]
    ratio = suction * e ** P["Omega"] / P["P_a"]   # the e of e^Omega is the void ratio
    return P["S_min"] + (P["S_max"] - P["S_min"]) * math.log(math.e + ratio ** P["n_x"]) ** -P["m_x"]


def bonding(suction, e):
    t = max(suction, 0) / P["p_atm"]
    zeta = (1 - saturation(suction, e)) * (1 + t / (10.7 + 2.4 * t))
    return 1 - P["b_1"] * (1 - math.exp(P["b_2"] * zeta))


def critical_void_ratio(p, f=1.0):
    return P["N_c"] * f * (p + P["alpha_csl"]) ** -P["lambda"]


def steady_pressure(e):
    return (P["N_c"] / e) ** (1 / P["lambda"]) - P["alpha_csl"]


def line_pressure(e, f=1.0):
    return (P["N_l"] * f / e) ** (1 / P["lambda"])


def lode(cos3t):
    c4 = P["c"] ** 4
    return (2 * c4 / (1 + c4 - (1 - c4) * cos3t)) ** 0.25


INTEGRATION = 1e-5   # relative tolerance of the library's integration: its default
# The closed forms are those of the published model, which has no elastic domain: so are the cases held against them.
PUBLISHED = ((re.compile(r"(?m)^   file = .*$"), r"\g<0>\n   rho_e = 0.0"),)
ROUNDING = 1e-12     # a few thousand roundings
