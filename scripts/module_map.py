#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the map of the Fortran sources from their `use` lines: docs/architecture.svg.

A box is a folder, a frame a part of the project. An arrow says that the folder above uses the one below, or one frame
another; arrows that follow from others are left out. A use against the order of the rest (a cycle) is drawn in red and
told. The same sources give the same bytes.

    python3 scripts/module_map.py            writes docs/architecture.svg
    python3 scripts/module_map.py --check    exit code 1 if it is not what it should be
"""
import argparse
import pathlib
import re
import sys
from collections import Counter
from xml.sax.saxutils import escape

ROOT = pathlib.Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs/architecture.svg"
PARTS = ["host", "drivers", "materials", "common", "umat"]   # folders at the top whose sources are drawn
COLUMNS = [["host"], ["drivers", "materials", "common"], ["umat"]]
OF_THE_FOLDER_ABOVE = {"src"}   # folders that say nothing of a layer
PROGRAM, GROUND = "program", "ground"   # beside the folders of a part: what stands on top of them, what all of them use

UNIT = re.compile(r"^(module|program) (\w+)$", re.MULTILINE)
USE = re.compile(r"^\s*use\s*(?:,\s*(?:non_)?intrinsic\s*)?(?:::)?\s*(\w+)", re.MULTILINE)

COLOURS = (("use", "#456"), ("linked", "#456"), ("between", "#245a9e"), ("wrong", "#c22"))
BOX, HEIGHT, GAP, ROW, PAD, TITLE = 112, 30, 18, 66, 20, 30   # sizes [px]


def folder_of(path):
    parts = [part for part in path.parent.relative_to(ROOT).parts if part not in OF_THE_FOLDER_ABOVE]
    return "/".join(parts)


def uses_of_folders():
    """{(user, used): how many use lines} of the folders of PARTS, and every folder; the library's interface and what
    implements it are tied by the C interface, not by a use."""
    where, lines = {}, []
    files = sorted(file for part in PARTS for file in (ROOT / part).glob("**/*.f90"))
    divided = {folder.split("/")[0] for folder in map(folder_of, files) if "/" in folder}
    for path in files:
        text, folder = path.read_text(encoding="utf-8"), folder_of(path)
        units = UNIT.findall(text)
        if folder in divided:
            folder += "/" + (PROGRAM if any(kind == "program" for kind, _ in units) else GROUND)
        where.update({unit: folder for _, unit in units})
        lines += [(folder, used) for used in USE.findall(text)]
    found = Counter((folder, where[used]) for folder, used in lines if where.get(used, folder) != folder)
    return found, sorted(set(where.values()))


def reachable(edges, start):
    """Folders that a path of uses leads to."""
    seen, left = set(), [start]
    while left:
        here = left.pop()
        for a, b in edges:
            if a == here and b not in seen:
                seen.add(b)
                left.append(b)
    return seen


def split_cycles(found):
    """(edges that run downwards, edges that run upwards) in the order of the folders with the fewest use lines upwards:
    exact, by dynamic programming over the sets of folders of every cycle."""
    upwards = []
    for circle in circles(found):
        best = {0: (0, ())}   # set of folders placed from the top, as bits -> (use lines upwards, their order)
        for placed in range(1 << len(circle)):
            cost, order = best[placed]
            for i, folder in enumerate(circle):
                if placed >> i & 1:
                    continue
                above = sum(found.get((folder, circle[k]), 0) for k in order)
                candidate = (cost + above, (*order, i))
                if candidate < best.get(placed | 1 << i, (float("inf"),)):
                    best[placed | 1 << i] = candidate
        order = [circle[i] for i in best[(1 << len(circle)) - 1][1]]
        upwards += [(a, b) for a, b in found if a in order and b in order and order.index(b) < order.index(a)]
    return sorted(set(found) - set(upwards)), sorted(upwards)


def circles(found):
    """Folders that reach each other, every group once."""
    groups = {tuple(sorted(b for b in reachable(found, a) if a in reachable(found, b))) for a, _ in found}
    return sorted(group for group in groups if group)


def reduced(edges):
    """Edges that do not follow from others."""
    return [(a, b) for a, b in edges if b not in reachable([e for e in edges if e != (a, b)], a)]


def rows_of(folders, edges):
    """Rows of a frame from the top: a folder stands a row below the lowest that uses it."""
    def depth(folder):
        return 1 + max((depth(a) for a, b in edges if b == folder), default=-1)

    depths = {folder: depth(folder) for folder in folders}
    return [[f for f in folders if depths[f] == level] for level in range(max(depths.values()) + 1)]


def arrange(rows, edges):
    """Orders each row by the mean place of those above that use it, so that arrows cross less."""
    place = {folder: i - (len(row) - 1)/2 for row in rows for i, folder in enumerate(row)}
    for above, row in zip(rows, rows[1:]):
        users = {f: [place[a] for a, b in edges if b == f and a in place] for f in row}
        row.sort(key=lambda f: (sum(users[f])/len(users[f]) if users[f] else 0.0, f))
        for i, folder in enumerate(row):
            place[folder] = i - (len(row) - 1)/2
    return rows


class Picture:
    def __init__(self):
        self.below, self.above = [], []

    def frame(self, x, y, width, height, name):
        self.below.append(f'<rect class="frame" x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="8"/>')
        self.above.append(f'<text class="name" x="{x + 12:g}" y="{y + 20:g}">{escape(name)}/</text>')

    def box(self, x, y, name):
        self.above.append(f'<rect class="box" x="{x:g}" y="{y:g}" width="{BOX}" height="{HEIGHT}" rx="4"/>'
                          f'<text class="label" x="{x + BOX/2:g}" y="{y + HEIGHT/2 + 4.5:g}">{escape(name)}</text>')

    def arrow(self, a, b, kind="use"):
        bend = 0.45*(b[1] - a[1])
        self.below.append(f'<path class="{kind}" d="M{a[0]:g} {a[1]:g} C{a[0]:g} {a[1] + bend:g} '
                          f'{b[0]:g} {b[1] - bend:g} {b[0]:g} {b[1]:g}" marker-end="url(#{kind}-head)"/>')

    def line(self, points, kind="between"):
        path = " L".join(f"{x:g} {y:g}" for x, y in points)
        self.below.append(f'<path class="{kind}" d="M{path}" marker-end="url(#{kind}-head)"/>')

    def tell(self, x, y, words):
        self.above.append(f'<text class="told" x="{x:g}" y="{y:g}">{escape(words)}</text>')

    def text(self, width, height):
        heads = "".join(f'<marker id="{kind}-head" markerWidth="9" markerHeight="9" refX="8" refY="4" orient="auto" '
                        f'markerUnits="userSpaceOnUse"><path d="M0 0 L9 4 L0 8 z" fill="{colour}"/></marker>'
                        for kind, colour in COLOURS)
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
            f'viewBox="0 0 {width:g} {height:g}" font-family="DejaVu Sans, Verdana, sans-serif">',
            "<title>Folders of the Fortran sources and what uses what</title>",
            "<style>.frame{fill:#f6f8fa;stroke:#9ab}.box{fill:#fff;stroke:#456}.name{font-size:14px;font-weight:bold;"
            "fill:#234}.label{font-size:12px;text-anchor:middle;fill:#123}.use{fill:none;stroke:#456}"
            ".linked{fill:none;stroke:#456;stroke-dasharray:2 4}.told{font-size:11px;fill:#456}"
            ".between{fill:none;stroke:#245a9e;stroke-width:2}.wrong{fill:none;stroke:#c22;stroke-width:1.5;"
            "stroke-dasharray:5 3}</style>",
            f"<defs>{heads}</defs>", f'<rect width="{width:g}" height="{height:g}" fill="#fff"/>',
            *self.below, *self.above, "</svg>", ""])


def size_of(rows):
    return (max(len(row) for row in rows)*(BOX + GAP) - GAP + 2*PAD, TITLE + len(rows)*ROW - (ROW - HEIGHT) + PAD)


def draw():
    """(the picture, uses that run against the order)"""
    found, folders = uses_of_folders()
    kept, wrong = split_cycles(found)
    part = {folder: folder.split("/")[0] for folder in folders}
    picture, frames, at = Picture(), {}, {}
    inner = {name: reduced([(a, b) for a, b in kept if part[a] == part[b] == name]) for name in PARTS}
    interface = ("umat/include", "umat/abi")   # mud_interface declares what abi defines with bind(c)
    if all(folder in part for folder in interface):
        inner["umat"].append(interface)
    rows = {name: arrange(rows_of([f for f in folders if part[f] == name], inner[name]), inner[name])
            for name in PARTS if name in part.values()}
    sizes = {name: size_of(rows[name]) for name in rows}
    columns = [[name for name in column if name in rows] for column in COLUMNS]
    height = max(sum(sizes[n][1] for n in column) + 60*(len(column) - 1) for column in columns if column)
    x = 20
    for column in filter(None, columns):
        width = max(sizes[name][0] for name in column)
        free = (height - sum(sizes[name][1] for name in column))/max(len(column) - 1, 1)
        y = 20
        for name in column:
            tall = height if len(column) == 1 else sizes[name][1]
            frames[name] = (x, y, width, tall)
            picture.frame(x, y, width, tall, name)
            pitch = ROW if len(rows[name]) == 1 else (tall - TITLE - PAD - HEIGHT)/(len(rows[name]) - 1)
            for level, row in enumerate(rows[name]):
                left = x + (width - len(row)*(BOX + GAP) + GAP)/2
                for i, folder in enumerate(row):
                    at[folder] = (left + i*(BOX + GAP), y + TITLE + level*pitch)
                    label = folder.removeprefix(name).lstrip("/") or "modules"
                    picture.box(*at[folder], label)
            y += tall + free
        x += width + 60
    for name in rows:
        for a, b in inner[name]:
            picture.arrow((at[a][0] + BOX/2, at[a][1] + HEIGHT), (at[b][0] + BOX/2, at[b][1] - 1),
                          "linked" if (a, b) == interface else "use")
    for a, b in wrong:
        if part[a] == part[b]:
            picture.arrow((at[a][0] + BOX/2 + 12, at[a][1]), (at[b][0] + BOX/2 + 12, at[b][1] + HEIGHT + 1), "wrong")
    outside = {}
    for a, b in kept:
        if part[a] != part[b]:
            outside.setdefault((part[a], part[b]), set()).add(b)
    between(picture, frames, at, {edge: sorted(outside[edge]) for edge in reduced(sorted(outside))})
    for a, b in sorted({(part[a], part[b]) for a, b in wrong if part[a] != part[b]}):
        picture.line([centre(frames[a]), centre(frames[b])], "wrong")
    picture.tell(20, height + 42, "An arrow: uses; what follows from other arrows is left out. Dotted: through the C "
                 "interface." + (" Red: against the order." if wrong else ""))
    return picture.text(x - 40, height + 56), wrong


def centre(frame):
    return frame[0] + frame[2]/2, frame[1] + frame[3]/2


def between(picture, frames, at, edges):
    """One arrow for all uses of one frame by another, {(user, used): folders used}: down a column, or to the right, to
    the box if it is one folder alone; round the frames of a column between."""
    used = Counter()
    for (a, b), folders in sorted(edges.items()):
        (xa, ya, wa, ha), (xb, yb, wb, hb) = frames[a], frames[b]
        if xa == xb:
            used[xa] += 1
            x = xa + wa*used[xa]/4
            picture.line([(x, ya + ha), (x, yb - 1)])
            continue
        target, y = xb - 1, max(ya, yb) + (min(ya + ha, yb + hb) - max(ya, yb))/2
        if len(folders) == 1 and folders[0] != b:
            target, y = at[folders[0]][0] - 1, at[folders[0]][1] + HEIGHT/2
        start, gap = y, free_height(frames, xa + wa, xb)
        if gap is not None or not ya < y < ya + ha:
            start = gap if gap is not None else ya + ha/2
        picture.line([(xa + wa, start), (target, start)] if start == y
                     else [(xa + wa, start), (xb - 30, start), (xb - 30, y), (target, y)])


def free_height(frames, left, right):
    """Middle of the widest gap between the frames that stand from left to right; None if none stands there."""
    spans = sorted((y, y + height) for x, y, _, height in frames.values() if left < x < right)
    gaps = [(below[0] - above[1], (above[1] + below[0])/2) for above, below in zip(spans, spans[1:])]
    return max(gaps)[1] if gaps else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="compare with docs/architecture.svg instead of writing it")
    check = parser.parse_args().check
    text, wrong = draw()
    for a, b in wrong:
        print(f"against the order: {a} uses {b}")
    if check:
        good = PICTURE.exists() and PICTURE.read_text(encoding="utf-8") == text
        if not good:
            print("docs/architecture.svg is not what the sources say; renew it with scripts/module_map.py")
        return 0 if good else 1
    PICTURE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
