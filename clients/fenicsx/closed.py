# SPDX-License-Identifier: MIT
"""Closed forms of consolidation that the check compares with."""
import math


def terzaghi(z, t, load=100.0, young=1e4, poisson=0.25, mobility=1e-6, height=1.0):
    """Pore pressure at the height z above the base, incompressible water: docs/theory/host.md section 10.1."""
    modulus = young*(1.0 - poisson)/((1.0 + poisson)*(1.0 - 2.0*poisson))
    T = mobility*modulus*t/height**2
    M = [(2*m + 1)*math.pi/2.0 for m in range(200)]
    return load*sum(2.0/m*math.sin(m*(height - z)/height)*math.exp(-m*m*T) for m in M)


def mandel(x, t, load=100.0, young=1e4, poisson=0.2, mobility=1e-6, width=1.0):
    """Pore pressure at the distance x from the middle, incompressible water and grains (Mandel 1953)."""
    modulus = young*(1.0 - poisson)/((1.0 + poisson)*(1.0 - 2.0*poisson))
    T, ratio, total = mobility*modulus*t/width**2, (1.0 - poisson)/(0.5 - poisson), 0.0
    for i in range(60):
        low, high = i*math.pi + 1e-9, (i + 0.5)*math.pi - 1e-9
        for _ in range(80):  # tan a = ratio a
            a = 0.5*(low + high)
            low, high = (a, high) if math.tan(a) < ratio*a else (low, a)
        share = math.sin(a)/(a - math.sin(a)*math.cos(a))
        total += share*(math.cos(a*x/width) - math.cos(a))*math.exp(-a*a*T)
    return load*total
