"""Drawings and figures of bicycle calipers, and sketches that explain inputs of calipers and mechanisms."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.on_axes import draw_in, plot_charts_of_one_x
from beamdyn.common.drawing.shapes import (
    Arrow,
    Chart,
    ChartAxis,
    Disc,
    Drawing,
    DrawnShape,
    Label,
    Outline,
    Symbol,
)
from beamdyn.common.drawing.sketch import Sketch
from beamdyn.common.results.pictures import Figure, new_figure
from brakes.calipers import NAMED, Caliper, CaliperStroke
from brakes.drawings.mechanism import merged, named_curves, open_and_closed, travel_axis
from brakes.planar import Equilibrium, Position, solve

_HEIGHTS = (1.0, 1.0, 1.6, 0.8)  # heights of the charts over the stroke, relative to one another


def caliper_drawing(caliper: Caliper, closed: Equilibrium, title: str = "") -> Drawing:
    """Draw a caliper open (outlined in grey) and closed on the rim, with its forces; in mm.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    closed : Equilibrium
        Equilibrium of the closed caliper, from `Caliper.equilibrium`.
    title : str
        Title of the drawing; by default the caliper's name.
    """
    place = closed.position
    shapes = [shape for name in caliper.pads for shape in caliper.mechanism.load(name).shapes()]
    both_push = [shape.style for shape in shapes] == ["force", "force"]
    faces = np.array([place.point(*shape.ends[0]) for shape in shapes]) if both_push else None
    open_ = Position(place.mechanism, np.zeros_like(place.coordinates))
    return open_and_closed(open_, closed, title or caliper.name, faces)


def title_of(caliper: Caliper, run: CaliperStroke, cable: float) -> str:
    """Compose the title of a drawing at a travel of the cable [m]."""
    return f"{caliper.name}: cable travel {1e3 * cable:.3g} mm, {run.finger_force:g} N on lever; grey: open"


def caliper_figure(
    caliper: Caliper, run: CaliperStroke, closed: Equilibrium, cable: float | None = None, caption: str = ""
) -> Figure:
    """Draw a caliper open and closed, and its advantage, pad ratio and reactions over the stroke.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    run : CaliperStroke
        The caliper over its stroke.
    closed : Equilibrium
        Equilibrium of the closed caliper, from `Caliper.equilibrium`.
    cable : float, optional
        Travel of the cable in the closed position [m], marked in the curves; by default that at the end of
        the stroke.
    caption : str
        A further line under the title.
    """
    figure = new_figure(11.5, 7.6, None)  # no layout engine: it takes twice as long as a fixed layout
    place = float(run.cable[-1] if cable is None else cable)
    title = "\n".join(filter(None, (title_of(caliper, run, place), caption)))
    draw_in(figure, (0.005, 0.01, 0.545, 0.985), caliper_drawing(caliper, closed, title))
    charts = stroke_charts(caliper, run, place)
    plot_charts_of_one_x(figure, charts, 0.625, _HEIGHTS[: len(charts)])
    return figure


def stroke_charts(caliper: Caliper, run: CaliperStroke, cable: float) -> list[Chart]:
    """Make charts of advantage, pad velocities and reactions over the stroke, with a mark at a cable travel.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    run : CaliperStroke
        The caliper over its stroke.
    cable : float
        Travel of the cable to mark [m].
    """
    joints = caliper.mechanism.joints
    forces, couples = (
        merged({joint.name: run.magnitudes[joint.name] for joint in joints if joint.unit == unit})
        for unit in ("N", "N m")
    )
    advantage, ratio = (
        {f"{side} pad": pair[:, k] for k, side in enumerate(("right", "left"))}
        for pair in (run.advantage, run.pad_ratio)
    )
    shown = (
        ("Mechanical advantage of each pad", ChartAxis("pad force / finger force"), advantage),
        ("Velocity ratio of each pad", ChartAxis("pad travel / cable travel"), ratio),
        ("Forces of the joints", ChartAxis("force of the joint", "N"), forces),
        ("Couples of the joints", ChartAxis("couple of the joint", "N m"), couples),
    )
    x = 1e3 * run.cable
    travel = travel_axis("cable travel", "mm", x)
    return [
        Chart(title, travel, axis, named_curves(x, curves), cursor=1e3 * cable)
        for title, axis, curves in shown
        if curves
    ]


# Sketches that explain the inputs of calipers and mechanisms: dimensions, symbols of joints, angles ------


_MM = 1e3
_LETTERS = 9.0


def caliper_sketch(name: str) -> Rows:
    """Sketch a named caliper with its dimensions, and the vehicle; for other names, only the vehicle."""
    return [[_dimensions(name)], [_bicycle()]] if name in NAMED else [[_bicycle()]]


def _bicycle() -> Drawing:
    """Sketch the dimensions of the vehicle that a caliper stops."""
    s = Sketch()
    R, L = 0.7, 2.1
    cg = np.array([1.15, 2.0])
    s.add(Outline([(-1.0, 0.0), (3.2, 0.0)], "ground", 2.0))
    for x in (0.0, L):
        s.add(Disc((x, R), R, "wheel", 1.6), Disc((x, R), 0.84 * R, "axis", 1.0))
        s.axis((x, R))
    frame = np.array([(0.0, R), (0.2, 1.7), (0.85, 0.75), (L, R), (1.35, 1.65), (0.2, 1.7)])
    s.add(Outline(frame, "body", 3.0), Outline([(0.85, 0.75), (1.35, 1.65)], "body", 3.0))
    s.add(Symbol("dot", cg, "weight", 7.0))
    s.say("M", cg, (1.0, 1.0), "weight")
    s.length("R", (L, R), (L, 0.0), (1.0, 0.0))
    s.length("r", (0.0, R), 0.84 * R * np.array([-np.cos(0.5), -np.sin(0.5)]) + (0.0, R), (-0.3, 1.0))
    s.height("h", (L, 0.0), cg, 3.05)
    s.width("x", (0.0, R), cg, -0.26)
    s.width("L", (0.0, R), (L, 0.0), -0.88)
    s.arrow("v", (0.0, 2.15), (-0.8, 2.15))
    return s.drawing("The vehicle that it stops", "A bicycle: R, r, L, h, x, M, v")


def _dimensions(name: str) -> Drawing:
    design = NAMED[name]()
    drawn = caliper_drawing(design.build(), solve(design.build().mechanism), design.label)
    points = {key: value for key, value in vars(design).items() if isinstance(value, tuple)}
    middle = np.mean([*points.values()], axis=0)
    places: dict[tuple[float, float], list[str]] = {}
    for key, at in points.items():
        places.setdefault(at, []).append(key.replace("_", " "))
    labels = [
        Label("\n".join(names), np.multiply(_MM, at), "dimension", tuple(np.sign(at - middle)), size=_LETTERS)
        for at, names in places.items()
    ]
    words = f"Where the points of the form are: {', '.join(key.replace('_', ' ') for key in points)}"
    marks = [Symbol("dot", np.multiply(_MM, at), "dimension", 5.0) for at in places]
    shapes = [shape for shape in drawn.shapes if getattr(shape, "role", "") not in ("load", "reaction")]
    return Drawing((*shapes, *marks), tuple(labels), f"{design.label}, seen from the front", words, unit="")


def mechanism_sketch(stops: bool) -> Rows:
    """Sketch the symbols of joints and loads, angles of directions and, if `stops` is true, the vehicle."""
    return [[_symbols()], [_directions()], *([[_bicycle()]] if stops else [])]


def _symbols() -> Drawing:
    """Sketch the symbols of the joints."""
    s = Sketch()
    line = np.array([(-0.35, 0.0), (0.35, 0.0)])
    symbols: dict[str, tuple[Callable[[np.ndarray], DrawnShape], ...]] = {
        "pin": (lambda at: Symbol("pin", at, "pin"),),
        "pin on the ground": (
            lambda at: Symbol("ground", at, "ground", 14.0),
            lambda at: Symbol("pin", at, "pin"),
        ),
        "bar": (lambda at: Outline(at + line, "neutral", 4.0),),
        "cable": (lambda at: Outline(at + line, "cable", 1.4, (5.0, 3.0)),),
        "spring": (lambda at: Outline(at + line, "spring", 1.4, (1.5, 2.0)),),
        "slot, contact": (lambda at: Outline(at + line, "contact", 1.6),),
    }
    for i, (words, shapes) in enumerate(symbols.items()):
        at = np.array([2.6 * (i % 2), -0.8 * (i // 2)])
        s.add(*(shape(at) for shape in shapes))
        s.labels.append(Label(words, at + np.array((0.4, 0.0)), "text", (1.0, 0.0), size=_LETTERS))
    s.room = [(5.0, 0.0)]  # leaves room for the words on the right
    return s.drawing("Signs of joints", "How pins, bars, cables, springs, slots and contacts are drawn")


def _directions() -> Drawing:
    """Sketch which directions 0, 90 and -30 degrees have."""
    s = Sketch()
    for words, way in {"0 deg": (1.0, 0.0), "90 deg": (0.0, 1.0), "-30 deg": (0.87, -0.5)}.items():
        s.add(Arrow((0.0, 0.0), way, "load", words, 1.6))
        s.labels.append(Label(words, way, "text", way, size=_LETTERS))
    s.room = [(-1.6, 0.0), (2.6, 0.0)]
    return s.drawing("Directions and angles", "0 deg points to the right, 90 deg up")
