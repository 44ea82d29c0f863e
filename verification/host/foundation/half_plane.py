# SPDX-License-Identifier: MIT
"""A rigid strip without mass, bonded to an elastic half plane, under harmonic forces: the mixed boundary value problem of
Luco and Westmann (1972) by panels of constant traction, with Lamb's solution for a harmonic line load in wave numbers.
Independent of the host: no mesh, no steps, no boundary that absorbs."""
import numpy as np


def flexibilities(k, mu, nu, shear_wave):
    """u_z by p_z, u_x by p_x and the coupling of both at the surface, for waves exp(i(omega t - k x)) with wave numbers of
    S waves; time goes as exp(i omega t), so roots have positive real parts or positive imaginary ones."""
    pressure_wave = shear_wave * np.sqrt((1 - 2 * nu) / (2 - 2 * nu))
    p, s = np.sqrt(k**2 - pressure_wave**2 + 0j), np.sqrt(k**2 - shear_wave**2 + 0j)
    rayleigh = (2 * k**2 - shear_wave**2) ** 2 - 4 * k**2 * p * s
    return (-(shear_wave**2) * p / (mu * rayleigh), -(shear_wave**2) * s / (mu * rayleigh),
            -k * (2 * k**2 - shear_wave**2 - 2 * p * s) / (mu * rayleigh))


def wave_numbers(shear_wave, panel):
    """Points and weights from 0 on: over the poles on an arc above the real axis, then along it."""
    x, w = np.polynomial.legendre.leggauss(400)
    angle = np.pi * (x + 1) / 2
    k = shear_wave * ((1 - np.cos(angle)) + 0.4j * np.sin(angle))
    weight = w * np.pi / 2 * shear_wave * (np.sin(angle) + 0.4j * np.cos(angle))
    ends = np.concatenate([np.arange(2 * shear_wave, 400 / panel, 1.0), [400 / panel]])
    x, w = np.polynomial.legendre.leggauss(12)
    middle, half = (ends[1:] + ends[:-1]) / 2, (ends[1:] - ends[:-1]) / 2
    return np.concatenate([k, (middle[:, None] + half[:, None] * x).ravel()]), np.concatenate([weight, (half[:, None] * w).ravel()])


def compliance(frequency, b, mu, nu, rho, panels=48, bonded=True):
    """(3, 3) of u_x, u_z and the rotation (from x to z, which points up) under f_x, f_z and the moment."""
    shear_wave = frequency / np.sqrt(mu / rho)
    width = 2 * b / panels
    k, weight = wave_numbers(shear_wave, width)
    zz, xx, xz = flexibilities(k, mu, nu, shear_wave)
    sinc = np.where(abs(k) > 0, (np.sin(k * width / 2) / (k * width / 2)) ** 2, 1)
    distance = width * np.arange(panels)
    even, odd = np.cos(np.outer(distance, k)), np.sin(np.outer(distance, k))
    load = weight * width * sinc / np.pi
    row = np.arange(panels)
    apart, sign = abs(row[:, None] - row), np.sign(row[:, None] - row)
    g_zz, g_xx = (even @ (load * zz))[apart], (even @ (load * xx))[apart]
    # Under a load that presses down the surface moves towards it; z points up here.
    g_xz = ((odd @ (load * xz))[apart]) * sign if bonded else 0 * g_zz
    x = width * (row + 0.5) - b
    flexibility = np.block([[g_xx, g_xz], [-g_xz, g_zz]])
    zero, one = 0 * x, 1 + 0 * x
    modes = np.array([np.concatenate([one, zero]), np.concatenate([zero, one]), np.concatenate([zero, x])]).T
    tractions = np.linalg.solve(flexibility, modes.astype(complex))
    return np.linalg.inv(width * modes.T @ tractions)
