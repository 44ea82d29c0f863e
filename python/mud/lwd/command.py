# SPDX-License-Identifier: MIT
"""mud_lwd: what a light falling weight deflectometer reads on unsaturated soil."""

from __future__ import annotations

import argparse
import os
import pathlib
import signal
import sys

from ..errors import InputError
from ..study.runs import Failed
from .chart import INTERRUPTED, Place, run_grid, write_chart
from .device import DEVICES, device_of, record_of
from .ground import Layer, Test
from .measure import FINENESS, TOLERANCE, measure, write_tables
from .page import write_page

EXIT_INPUT, EXIT_FAILED = 2, 3
CODES = "exit codes: 0 done; 2 the input is refused; 3 a run fails; 130 interrupted (the same command goes on)"
# Options with a value that all tests of a chart have.
SHARED = ("peak", "pulse", "force", "buffer", "buffer_damping", "fall_mass", "fall", "radius", "plate_mass", "shape")
SHARED += ("poisson", "permeability", "k0", "grains", "width", "depth", "interval", "fineness", "step_tolerance")
FORMAT = "CSV, first line time,force,deflection [ms, kN, mm]"


def parser() -> argparse.ArgumentParser:
    top = argparse.ArgumentParser(prog="mud_lwd", description=__doc__, epilog=CODES)
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    test = commands.add_parser("test", help="one test: seating and measured drops, a page with errors", epilog=CODES)
    chart = commands.add_parser("chart", help="modulus over suction, saturation and void ratio", epilog=CODES)
    for one in (test, chart):
        _common(one)
    test.add_argument("--void-ratio", type=float, required=True, metavar="E", help="of the ground below the layers [-]")
    water = test.add_mutually_exclusive_group()
    water.add_argument("--suction", type=float, metavar="KPA", help="the same at every depth")
    water.add_argument(
        "--water-table", type=float, metavar="M", help="depth of the water table; suction grows above it"
    )
    test.add_argument("--rain", type=float, default=0.0, metavar="MM_H", help="rain before the test")
    test.add_argument("--rain-hours", type=float, default=0.0, metavar="H", help="how long it rains")
    test.add_argument(
        "--layer",
        nargs=3,
        action="append",
        default=[],
        metavar=("THICKNESS", "MATERIAL", "E"),
        help="a layer above the ground, the upper one first: thickness [m], material or elastic:YOUNG[:POISSON] [kPa], "
        "void ratio",
    )
    test.add_argument("--measured", metavar="FILE", help=f"record that is drawn beside the last drop: {FORMAT}")
    test.add_argument("--no-page", action="store_true", help="tables only")
    chart.add_argument("--void-ratios", type=float, nargs="+", required=True, metavar="E", help="of the grid [-]")
    chart.add_argument("--suctions", type=float, nargs="+", required=True, metavar="KPA", help="of the grid")
    chart.add_argument("--processes", type=int, default=2, metavar="N", help="tests at a time; default 2")
    return top


def _common(one):
    one.add_argument(
        "--material", required=True, help="name in the library, FILE.nml, or elastic:YOUNG[:POISSON] [kPa]"
    )
    one.add_argument(
        "--device",
        default="zorn",
        choices=[*DEVICES],
        help="default zorn: 7.07 kN in 17 ms, 300 mm, 15 kg, 22.5/s; prima needs its force and mass from you",
    )
    own = one.add_argument_group("values of your own device")
    own.add_argument("--peak", type=float, metavar="KN", help="largest force of the half sine")
    own.add_argument("--pulse", type=float, metavar="MS", help="duration of the half sine")
    own.add_argument("--force", metavar="FILE", help=f"measured force in place of the half sine: {FORMAT}")
    own.add_argument("--buffer", type=float, metavar="KN_M", help="stiffness: the mass falls on it and makes the pulse")
    own.add_argument("--buffer-damping", type=float, metavar="KN_S_M", help="of a dashpot beside it; default 0")
    own.add_argument("--fall-mass", type=float, metavar="KG", help="of the mass that falls")
    own.add_argument("--fall", type=float, metavar="M", help="its height of fall")
    own.add_argument("--radius", type=float, metavar="MM", help="of the plate")
    own.add_argument("--plate-mass", type=float, metavar="KG", help="what rests on the ground: plate and guide")
    own.add_argument("--tied", action="store_true", help="joins the plate to the ground: it cannot leave it")
    own.add_argument("--shape", type=float, metavar="F", help="of E = f (1 - nu^2) sigma r/s: 2 flexible, pi/2 rigid")
    own.add_argument("--poisson", type=float, metavar="NU", help="of this formula")
    more = one.add_argument_group("ground and accuracy")
    more.add_argument("--permeability", type=float, metavar="M2", help=f"intrinsic; default {Test.permeability:g}")
    more.add_argument(
        "--k0", type=float, metavar="K0", help=f"horizontal over vertical net stress; default {Test.k_0:g}"
    )
    more.add_argument("--grains", type=float, metavar="MG_M3", help=f"density of the grains; default {Test.rho_s:g}")
    more.add_argument(
        "--width", type=float, metavar="M", help=f"of the ground that is computed; default {Test.width:g}"
    )
    more.add_argument(
        "--depth", type=float, metavar="M", help=f"down to a base that does not move; default {Test.depth:g}"
    )
    more.add_argument(
        "--interval", type=float, metavar="MS", help=f"from drop to drop; default {1e3 * Test.interval:g}"
    )
    more.add_argument("--drops", type=int, nargs=2, metavar=("SEATING", "MEASURED"), help="default 3 3")
    more.add_argument("--fineness", type=float, default=FINENESS, metavar="F", help="times the cells; default 1")
    more.add_argument(
        "--step-tolerance", type=float, default=TOLERANCE, metavar="A", help=f"of the steps; default {TOLERANCE:g}"
    )
    one.add_argument("--output", type=pathlib.Path, metavar="FOLDER", help="default: lwd_test, lwd_chart")
    one.add_argument("--host", default="", metavar="PROGRAM", help="mud_host; default: MUD_HOST, or the search path")
    one.add_argument("--quiet", action="store_true", help="prints the last line only")


def test_of(args, layers=(), **water) -> Test:
    """The test that options describe."""

    def scaled(value, factor):
        return None if value is None else value * factor

    device = device_of(
        args.device,
        args.force,
        peak=args.peak,
        pulse=scaled(args.pulse, 1e-3),
        radius=scaled(args.radius, 1e-3),
        mass=scaled(args.plate_mass, 1e-3),
        fall_mass=scaled(args.fall_mass, 1e-3),
        fall=args.fall,
        buffer=args.buffer,
        damping=args.buffer_damping,
        shape=args.shape,
        poisson=args.poisson,
    )
    given = {
        "permeability": args.permeability,
        "k_0": args.k0,
        "rho_s": args.grains,
        "width": args.width,
        "depth": args.depth,
        "interval": scaled(args.interval, 1e-3),
    }
    if args.drops:
        given |= {"seating": args.drops[0], "measured": args.drops[1]}
    return Test(device, tuple(layers), tied=args.tied, **{k: v for k, v in (given | water).items() if v is not None})


def test(args) -> int:
    """The command `test`."""
    layers = []
    for thickness, material, void_ratio in args.layer:
        try:
            layers.append(Layer(material, float(void_ratio), float(thickness)))
        except ValueError as problem:
            raise InputError(
                f"--layer {thickness} {material} {void_ratio}: thickness and void ratio are numbers"
            ) from problem
    layers.append(Layer(args.material, args.void_ratio))
    if args.measured:
        record_of(args.measured)  # what is wrong with it is told before the runs
    what = test_of(
        args,
        layers,
        suction=args.suction,
        water_table=args.water_table,
        rain=args.rain,
        rain_hours=args.rain_hours,
    )
    folder = args.output or pathlib.Path("lwd_test")
    measured = measure(what, folder, args.host, args.quiet, args.fineness, args.step_tolerance)
    write_tables(measured, folder)
    told = [] if args.no_page else write_page(measured, folder, args.measured)
    if not args.quiet:
        for warning in measured.warnings:
            print(f"mud_lwd: warning: {warning}", file=sys.stderr, flush=True)
        for sentence in told:
            print(sentence)
        print(
            f"results: {folder / ('drops.csv' if args.no_page else 'report.html')}, "
            f"{measured.seconds:.0f} s of processor time"
        )
    print(f"modulus {measured.told('modulus')}, deflection {measured.told('deflection')}")
    return 0


def chart(args) -> int:
    """The command `chart`."""
    ratios, suctions = ([*dict.fromkeys(given)] for given in (args.void_ratios, args.suctions))
    for e in ratios:  # what is wrong is told once, before anything runs
        for suction in suctions:
            test_of(args, [Layer(args.material, e)], suction=suction)
    if args.processes < 1:
        raise InputError(f"--processes is {args.processes}; at least one test runs at a time")
    folder = args.output or pathlib.Path("lwd_chart")
    folder.mkdir(parents=True, exist_ok=True)
    shared = ["--material", args.material, "--device", args.device, *["--tied"] * args.tied]
    for option in SHARED:
        if getattr(args, option) is not None:
            shared += [f"--{option.replace('_', '-')}", str(getattr(args, option))]
    if args.drops:
        shared += ["--drops", *map(str, args.drops)]
    if args.host:
        shared += ["--host", args.host]
    places = [Place(e, s, folder / f"e{e:g}_s{s:g}") for e in ratios for s in suctions]
    run_grid(
        places, shared, args.processes, (lambda words: None) if args.quiet else lambda words: print(words, flush=True)
    )
    write_chart(places, folder, args.material)
    failed = [p for p in places if not p.told]
    for place in failed:
        print(f"mud_lwd: e = {place.void_ratio:g}, {place.suction:g} kPa: {place.said}", file=sys.stderr)
    print(f"{len(places) - len(failed)} of {len(places)} tests; {folder / 'chart.csv'}, {folder / 'chart.png'}")
    return EXIT_FAILED if failed else 0


def main(words: list[str] | None = None) -> int:
    args = parser().parse_args(words)
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    # A chart ends its tests by SIGTERM: their runs end with them.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return {"test": test, "chart": chart}[args.command](args)
    except (InputError, OSError) as problem:  # OSError: a file or folder that cannot be written
        print(f"mud_lwd: {problem}", file=sys.stderr)
        return EXIT_INPUT
    except Failed as problem:
        print(f"mud_lwd: {problem}", file=sys.stderr)
        return EXIT_FAILED
    except KeyboardInterrupt:
        print("\nmud_lwd: interrupted; the same command goes on", file=sys.stderr)
        return INTERRUPTED
