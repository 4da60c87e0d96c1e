"""Draw the rooms of both packages and the imports between them, as they are in the code.

Run: `python docs/draw_architecture.py`.  Writes docs/architecture.svg and prints every arrow with its number
of imports.  Layers are those of the import contracts in pyproject.toml; grimp, which import-linter brings,
reads the imports.  The picture leaves out an arrow where a path through other rooms leads to the same room.
"""

from __future__ import annotations

import sys
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "architecture.svg"
SHARED = "beamdyn.common"  # the one room of beamdyn that brakes uses
COLOURS = {"beamdyn": "#dce9f5", "brakes": "#f7e6d0"}
HEIGHT = 0.42  # of a box, where layers stand 1 apart
WIDTH, LETTER, ARROW = 0.8, 0.094, 0.17  # of a box at least, of each letter in it, of each arrow at it
PLACE = 0.34  # width of a place that an arrow passes

Arrow = tuple[str, str]  # the room that imports, and the one that it imports
Layers = Sequence[Sequence[str]]  # names of rooms, highest layer first
Point = tuple[float, float]


# What the code says -------------------------------------------------------------------------------


def read_layers(package: str) -> list[list[str]]:
    """Rooms of a package in the order of its import contract, without `__main__` and `_version`."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"]
    (contract,) = (c for c in contracts["contracts"] if c.get("containers") == [package])
    rows = [[name.strip() for name in layer.split("|")] for layer in contract["layers"]]
    shown = [[name for name in row if not name.startswith("_")] for row in rows]
    foreign = [] if SHARED.startswith(package) else [[SHARED]]
    return [row for row in shown if row] + foreign


def count_imports(package: str) -> Counter[Arrow]:
    """Number of imports from one room of a package to another; imports of the package itself do not count."""
    import grimp

    graph = grimp.build_graph("beamdyn", "brakes", cache_dir=None)
    counts = Counter(
        (find_room(importer, package), find_room(imported, package))
        for importer in graph.modules
        if importer.startswith(f"{package}.")
        for imported in graph.find_modules_directly_imported_by(importer)
    )
    shown = {name for row in read_layers(package) for name in row}
    return Counter({(a, b): n for (a, b), n in sorted(counts.items()) if a != b and {a, b} <= shown})


def find_room(module: str, package: str) -> str:
    """The room of a module, without the name of the package that is drawn."""
    return ".".join(module.split(".")[:2]).removeprefix(f"{package}.")


def find_upward(arrows: Mapping[Arrow, int], layers: Layers) -> list[Arrow]:
    """Arrows that do not lead to a lower layer: there should be none."""
    depth = {name: k for k, row in enumerate(layers) for name in row}
    return [(a, b) for a, b in arrows if depth[a] >= depth[b]]


def leave_out_implied(arrows: Mapping[Arrow, int]) -> dict[Arrow, int]:
    """Arrows whose two rooms no path through other rooms joins (the transitive reduction)."""
    below: dict[str, set[str]] = {}
    for a, b in arrows:
        below.setdefault(a, set()).add(b)

    def reaches(start: str, end: str) -> bool:
        return end in below.get(start, ()) or any(reaches(room, end) for room in below.get(start, ()))

    return {
        (a, b): n for (a, b), n in arrows.items() if not any(reaches(other, b) for other in below[a] - {b})
    }


# Where it is drawn --------------------------------------------------------------------------------


def lead_through_layers(arrows: Mapping[Arrow, int], layers: Layers) -> dict[Arrow, list[str]]:
    """The way of each arrow: its rooms, and between them a place of its own in every layer that it passes."""
    depth = {name: k for k, row in enumerate(layers) for name in row}
    return {(a, b): [a, *(f"{a} > {b} {k}" for k in range(depth[a] + 1, depth[b])), b] for a, b in arrows}


def box_widths(layers: Layers, ways: Mapping[Arrow, Sequence[str]]) -> dict[str, float]:
    """Widths of the boxes of rooms: room for the name, and for the arrows that leave and that reach it."""
    ends = [Counter(way[end] for way in ways.values()) for end in (0, -1)]
    names = [name for row in layers for name in row]
    return {
        name: max(WIDTH, LETTER * (len(name) + 1), ARROW * max(count[name] for count in ends))
        for name in names
    }


def place(
    layers: Layers, ways: Mapping[Arrow, Sequence[str]], widths: Mapping[str, float]
) -> dict[str, Point]:
    """Positions of rooms and places: near the mean of what they are joined to, without overlap in a layer."""
    rows = [list(row) for row in layers]
    for way in ways.values():
        top = next(k for k, row in enumerate(layers) if way[0] in row)
        for k, name in enumerate(way[1:-1], top + 1):
            rows[k].append(name)
    links = [link for way in ways.values() for link in pairwise(way)]
    x = {name: float(k) - (len(row) - 1) / 2 for row in rows for k, name in enumerate(row)}
    for sweep in range(40):
        for row in rows if sweep % 2 else rows[::-1]:
            wanted = {name: mean_of_neighbours(name, links, x) for name in row}
            x |= spread(wanted, widths)
    return {name: (x[name], -float(k)) for k, row in enumerate(rows) for name in row}


def mean_of_neighbours(name: str, links: Sequence[Arrow], x: Mapping[str, float]) -> float:
    """Mean position of what a room or place is joined to, drawn to the middle to keep the picture narrow."""
    near = [b for a, b in links if a == name] + [a for a, b in links if b == name]
    weights = [3.0 if ">" in name and ">" in other else 1.0 for other in near]
    total = sum(weight * x[other] for weight, other in zip(weights, near, strict=True))
    return total / (sum(weights) + 0.6)


def spread(wanted: Mapping[str, float], widths: Mapping[str, float]) -> dict[str, float]:
    """Positions in the order of the wanted ones with room for each, mere places taking little."""
    names = sorted(wanted, key=lambda name: (round(wanted[name], 6), name))
    found = [wanted[names[0]]]
    for before, name in pairwise(names):
        apart = sum(widths[each] + 0.14 if each in widths else PLACE for each in (before, name)) / 2
        found.append(max(wanted[name], found[-1] + apart))
    shift = sum(wanted[name] - at for name, at in zip(names, found, strict=True)) / len(names)
    return {name: at + shift for name, at in zip(names, found, strict=True)}


# The picture --------------------------------------------------------------------------------------


def draw_package(ax: Axes, package: str, imports: Mapping[Arrow, int], left: float) -> float:
    """Boxes in layers, arrows downward, the number of imports at the end of each; returns the right edge."""
    layers, shown = read_layers(package), leave_out_implied(imports)
    ways = lead_through_layers(shown, layers)
    widths = box_widths(layers, ways)
    at = place(layers, ways, widths)
    shift = left - min(x for x, _ in at.values())
    at = {name: (x + shift, y) for name, (x, y) in at.items()}
    right = max(x for x, _ in at.values())
    for arrow, points in draw_lines(at, ways, widths):
        draw_arrow(ax, points, shown[arrow])
    for name in (name for row in layers for name in row):
        draw_box(ax, at[name], widths[name], name, COLOURS["beamdyn" if name == SHARED else package])
    ax.text((left + right) / 2, 0.5, package, ha="center", fontsize=12, weight="bold")
    return right


def draw_lines(
    at: Mapping[str, Point], ways: Mapping[Arrow, Sequence[str]], widths: Mapping[str, float]
) -> Iterator[tuple[Arrow, list[Point]]]:
    """The points of each arrow; arrows that share a box leave and reach it side by side."""
    leaving, reaching = (share_sides(at, ways, widths, end) for end in (0, -1))
    for arrow, way in ways.items():
        points = [(leaving[arrow], at[way[0]][1] - HEIGHT / 2)]
        for x, y in (at[name] for name in way[1:-1]):
            points += [(x, y + HEIGHT / 2), (x, y - HEIGHT / 2)]
        yield arrow, [*points, (reaching[arrow], at[way[-1]][1] + HEIGHT / 2)]


def share_sides(
    at: Mapping[str, Point], ways: Mapping[Arrow, Sequence[str]], widths: Mapping[str, float], end: int
) -> dict[Arrow, float]:
    """Where on its box each arrow begins (end 0) or ends (end -1), in the order of where they go."""
    sides: dict[str, list[tuple[float, Arrow]]] = {}
    for arrow, way in ways.items():
        sides.setdefault(way[end], []).append((at[way[1 if end == 0 else -2]][0], arrow))
    return {
        arrow: at[room][0] + widths[room] * ((k + 0.5) / len(side) - 0.5)
        for room, side in sides.items()
        for k, (_, arrow) in enumerate(sorted(side))
    }


def draw_arrow(ax: Axes, points: Sequence[Point], count: int) -> None:
    """A curve that leaves, passes and reaches all its points vertically."""
    from matplotlib.patches import FancyArrowPatch
    from matplotlib.path import Path as Curve

    corners, codes = [points[0]], [Curve.MOVETO]
    for (x0, y0), (x1, y1) in pairwise(points):
        corners += [(x0, (y0 + y1) / 2), (x1, (y0 + y1) / 2), (x1, y1)]
        codes += [Curve.CURVE4] * 3
    style = {"mutation_scale": 8, "color": "#556270", "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    ax.add_patch(FancyArrowPatch(path=Curve(corners, codes), arrowstyle="-|>", **style))
    x, y = points[-1]
    box = {"boxstyle": "round,pad=0.08", "fc": "white", "ec": "none"}
    ax.text(x, y + 0.17, str(count), ha="center", va="center", fontsize=7, color="#333333", bbox=box)


def draw_box(ax: Axes, at: Point, width: float, name: str, colour: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    x, y = at
    corner = x - width / 2 + 0.05, y - HEIGHT / 2 + 0.05
    outline = {"boxstyle": "round,pad=0.05", "fc": colour, "ec": "#556270", "lw": 0.9}
    ax.add_patch(FancyBboxPatch(corner, width - 0.1, HEIGHT - 0.1, **outline))
    ax.text(x, y, name, ha="center", va="center", fontsize=8.5)


NOTE = """An arrow points to the room that is imported;
the number counts the imports. Of {counts} arrows
those are drawn that no path through other
rooms implies.

Written by docs/draw_architecture.py"""


def main() -> None:
    import matplotlib as mpl
    from matplotlib.figure import Figure

    sys.path.insert(0, str(ROOT))  # the code beside this script, not what is installed
    mpl.rcParams["svg.hashsalt"] = "architecture"  # the same file each time
    ax, left, counts = Figure(figsize=(10.4, 10.4)).add_axes((0, 0, 1, 1)), 0.0, []
    for package in COLOURS:
        imports = count_imports(package)
        counts.append(len(imports))
        left = draw_package(ax, package, imports, left) + 1.3
        for (importer, imported), count in imports.items():
            print(f"{package}: {importer} -> {imported} {count}")
    lowest = -max(len(read_layers(package)) for package in COLOURS) + 1
    note = NOTE.format(counts=" and ".join(map(str, counts)))
    ax.text(left - 0.85, lowest - 0.6, note, ha="right", va="top", ma="left", fontsize=8.5, linespacing=1.4)
    ax.set(xlim=(-0.8, left - 0.5), ylim=(lowest - 2.4, 0.8))
    ax.axis("off")
    ax.get_figure().savefig(PICTURE, metadata={"Date": None})


if __name__ == "__main__":
    main()
