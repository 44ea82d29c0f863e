# SPDX-License-Identifier: MIT
"""Updates of other laws for sand beside those of MUD, in one run: the materials alone, without an element around them.

    build/venv/bin/python3 benchmarks/peers.py --opensees OPENSEES.SO [--umat LIBRARY:SYMBOL] [--results benchmarks/results]

OPENSEES.SO is the module of the package openseespylinux (`pip download --no-deps openseespylinux`, unpacked); its class
ManzariDafalias3D is called by the symbols of the library. LIBRARY:SYMBOL is the hypoplastic UMAT of
P. Staubach (github.com/patrickstaubach/abaqus-implicit), compiled by `gfortran -O2 -shared -fPIC -ffixed-line-length-none`; both
are the reader's to fetch, nothing of them is here.

Every law is sheared undrained in compression from p' 100 kPa and a void ratio of 0.735, 0.5 % in increments of 1e-5; then
the increments have the size of the row, with a tangent, as many as make the columns of one round. Rounds run all variants one
after another; times are medians, in processor time of the thread. What large increments lose is the difference of the deviator
at the end of 2 % to that of the same law and scheme in increments of 1e-5.
"""
import argparse
import csv
import ctypes
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
from ctypes import POINTER, c_double, c_int, c_void_p

import numpy as np

root = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(root / "python"))
import mud  # noqa: E402 (its folder is known only now)

SIZES, UPDATES = (1e-5, 1e-4, 1e-3), (500, 100, 20)
PRESSURE, VOID_RATIO, BEFORE = 100.0, 0.735, 500
UNDRAINED = np.array([-1.0, 0.5, 0.5, 0.0, 0.0, 0.0])
# Toyoura sand in Dafalias & Manzari (2004), e 0.735; density last.
DAFALIAS_MANZARI = (125.0, 0.05, VOID_RATIO, 1.25, 0.712, 0.019, 0.934, 0.7, 101.3, 0.01, 7.05, 0.968, 1.1, 0.704, 3.5, 4.0,
                    600.0, 1.6)
# Toyoura sand, Herle & Gudehus (1999): phi_c [deg], -, h_s [kPa], n, e_d0, e_c0, e_i0, alpha, beta; an intergranular strain
# as is usual: m_T, m_R, R, beta_r, chi (Niemunis & Herle 1997); bulk modulus of water, 0.
HYPOPLASTIC = (30.0, 0.2, 2.6e6, 0.27, 0.61, 0.98, 1.10, 0.18, 1.0, 2.0, 5.0, 1e-4, 0.5, 6.0, 0.0)
SYMBOLS = ("_ZN17ManzariDafalias3DC1Eiddddddddddddddddddiiidd", "_ZN17ManzariDafalias3D14setTrialStrainERK6Vector",
           "_ZN15ManzariDafalias11commitStateEv", "_ZN17ManzariDafalias3D9getStressEv", "_ZN17ManzariDafalias3D10getTangentEv",
           "_ZN15ManzariDafalias15Elastic2PlasticEv", "_ZN6VectorC1EPdi", "_ZN6VectoraSERKS_", "_ZN15ManzariDafalias10mElastFlagE")
numbers = POINTER(c_double)
HEAD = """# Other laws beside MUD

Microseconds an update by the size of the increment, undrained from 0.5 % on, with a tangent, the materials alone; and what
increments of 1e-3 change of the deviator at 2.5 %, against increments of 1e-5 with the same law and scheme. Made by `peers.py`.

"""


def at(array):
    return array.ctypes.data_as(numbers)


def shim(folder):
    """peers.c, compiled with the library of this tree."""
    built = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release") / "umat"
    target = folder / "peers.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", f"-I{root / 'umat/include'}", root / "benchmarks/peers.c", "-o", target,
                    f"-L{built}", "-lmud", f"-Wl,-rpath,{built}"], check=True)
    library = ctypes.CDLL(str(target))
    for name in ("walk_mud", "walk_umat", "walk_opensees"):
        getattr(library, name).restype = c_double
    library.begin_opensees.restype = c_void_p
    return library


class Mud:
    """Toyoura sand of the library with one tangent."""

    def __init__(self, library, tangent):
        self.library, self.tangent = library, mud.points.tangent_kind(tangent)
        self.name, self.scheme = "MUD", f"scheme automatic, 1e-5, {tangent} tangent"
        self.material = mud.Material("toyoura")

    def begin(self):
        self.stress, self.statev = self.material.initial_state(-PRESSURE * np.array([1.0, 1, 1, 0, 0, 0]), 0.0, VOID_RATIO)

    def walk(self, d_strain, n, failed):
        return self.library.walk_mud(c_void_p(self.material._address), at(self.stress), at(self.statev), len(self.statev),
                                     at(d_strain), n, self.tangent, ctypes.byref(failed))


class OpenSees:
    def __init__(self, library, module, scheme, words):
        self.library, self.number = library, scheme
        self.name, self.scheme = "ManzariDafalias", words
        self.addresses = (c_void_p * len(SYMBOLS))(*[ctypes.cast(getattr(module, name), c_void_p).value for name in SYMBOLS])
        self.parameters = np.array(DAFALIAS_MANZARI)

    def begin(self):
        self.strain, self.stress = np.zeros(6), np.zeros(6)
        self.material = c_void_p(self.library.begin_opensees(self.addresses, at(self.parameters), self.number, c_double(1e-7),
                                                             c_double(PRESSURE), at(self.strain)))

    def walk(self, d_strain, n, failed):
        return self.library.walk_opensees(self.addresses, self.material, at(self.strain), at(d_strain), n, at(self.stress),
                                          ctypes.byref(failed))


class Hypoplastic:
    def __init__(self, library, entry):
        self.library, self.name, self.scheme = library, "hypoplastic UMAT", "Euler, corrected by the mean of two rates, 1e-2"
        path, symbol = entry.rsplit(":", 1)
        self.umat = ctypes.cast(getattr(ctypes.CDLL(path), symbol), c_void_p)
        self.props = np.array(HYPOPLASTIC)

    def begin(self):
        self.stress, self.statev, self.strain = -PRESSURE * np.array([1.0, 1, 1, 0, 0, 0]), np.zeros(40), np.zeros(6)
        self.statev[0] = VOID_RATIO

    def walk(self, d_strain, n, failed):
        return self.library.walk_umat(self.umat, at(self.props), len(self.props), at(self.stress), at(self.statev),
                                      len(self.statev), at(self.strain), at(d_strain), n, ctypes.byref(failed))


def walk(law, size, updates):
    """Nanoseconds an update, and the deviator at the end [kPa]."""
    failed = c_int(0)
    law.begin()
    law.walk(SIZES[0] * UNDRAINED, BEFORE, failed)
    time = law.walk(size * UNDRAINED, updates, failed)
    if failed.value:
        raise RuntimeError(f"{law.name}, {law.scheme}: {failed.value} updates of {size:g} failed")
    return time, float(law.stress[1] - law.stress[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--opensees", help="opensees.so of openseespylinux")
    parser.add_argument("--umat", help="LIBRARY:SYMBOL of a hypoplastic UMAT")
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument("--results", type=pathlib.Path, help="folder of peers.csv and peers.md; otherwise they are printed")
    given = parser.parse_args()
    processor = re.search(r"model name.*: (.*)", pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    machine = (f"{processor[1] if processor else 'Machine'}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the start; "
               f"medians of {given.rounds} rounds.")
    with tempfile.TemporaryDirectory() as folder:
        library = shim(pathlib.Path(folder))
    laws = [Mud(library, "continuum"), Mud(library, "consistent")]
    if given.opensees:
        module = ctypes.CDLL(given.opensees)
        laws += [OpenSees(library, module, 1, "modified Euler, 1e-7"),
                 OpenSees(library, module, 2, "backward Euler, 1e-7")]
    if given.umat:
        laws.append(Hypoplastic(library, given.umat))
    times = {(law, size): [] for law in laws for size in SIZES}
    for _ in range(given.rounds):
        for law in laws:
            for size, updates in zip(SIZES, UPDATES):
                times[law, size].append(walk(law, size, updates)[0])
    rows = []
    for law in laws:
        fine = walk(law, SIZES[0], round(0.02 / SIZES[0]))[1]
        for size in SIZES:
            end = walk(law, size, round(0.02 / size))[1]
            rows.append({"law": law.name, "scheme": law.scheme, "increment": f"{size:g}",
                         "microseconds": f"{statistics.median(times[law, size]) / 1000:.2f}",
                         "least": f"{min(times[law, size]) / 1000:.2f}", "deviator": f"{end:.4f}",
                         "difference_percent": f"{100 * (end / fine - 1):.4f}"})
    page = f"{machine}\n\n{table(rows)}"
    print(page)
    if given.results:
        with open(given.results / "peers.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        (given.results / "peers.md").write_text(f"{HEAD}{page}\n", encoding="utf-8")


def table(rows):
    """Microseconds an update by size of the increment, and what the largest loses."""
    lines = ["| law | integration | 1e-5 | 1e-4 | 1e-3 | of the deviator, 1e-3 |", "|---|---|---|---|---|---|"]
    for i in range(0, len(rows), len(SIZES)):
        part = rows[i:i + len(SIZES)]
        cells = " | ".join(f"{float(row['microseconds']):.1f}" for row in part)
        lines.append(f"| {part[0]['law']} | {part[0]['scheme']} | {cells} | {float(part[-1]['difference_percent']):.3f} % |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
