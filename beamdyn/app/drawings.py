"""Drawings of the screens: a deflected beam, and sketches that explain the symbols of the inputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from beamdyn.app.scene_form import inputs_of
from beamdyn.common.drawing.layout import Rows, round_below
from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, DrawnShape, Label, Outline, Symbol
from beamdyn.common.drawing.sketch import Sketch, wall

_DEEP = 0.012  # thickness of the drawn beam, as a fraction of its length
_SHOWN = 0.22  # largest drawn deflection, as a fraction of the length of the beam
_PHI, _PSI, _ETA = np.radians((36.0, 35.0, 24.0))
_ROOT, _LENGTH, _TIP = np.array([1.0, 0.0]), 0.9, 0.16
# How a unit length along y, across the strip, is drawn in oblique projection: (right, up).
_AWAY = 0.5 * np.array([np.cos(0.7), np.sin(0.7)])
_SECTIONS = 4  # number of positions along the beam between two drawn cross-sections
# Radius of the arrow for the direction of rotation, divided by the drawn radius of the beam's root.
_HUB = 0.16


# Deflected beam ---------------------------------------------------------------------------------------


def drawn_larger(largest: float, length: float) -> float:
    """Return the factor (1, 2, 5, 10, ...) by which deflections are magnified to make them visible.

    Parameters
    ----------
    largest : float
        The largest deflection [m].
    length : float
        Length of the beam [m].
    """
    if not 0 < largest < np.inf:
        return 1.0
    return round_below(_SHOWN * length / largest)


def bent_beam(
    x: np.ndarray,
    deflection: np.ndarray,
    title: str,
    label: str = "",
    envelope: Sequence[np.ndarray] = (),
    room: float = 0.0,
    scale: str = "",
) -> Drawing:
    """Draw a deflected beam with its root at the left.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m], from 0 to its length.
    deflection : ndarray, shape (n,)
        Magnified deflection [m].
    title : str
        Title of the drawing.
    label : str
        Label at the tip.
    envelope : sequence of ndarray, shape (n,)
        Further magnified deflections [m], drawn in grey.
    room : float
        Largest magnified deflection [m] for which the drawing reserves space.
    scale : str
        Magnification of the deflection, in words.
    """
    length = float(x[-1])
    half = 0.5 * _DEEP * length
    edge = np.vstack([np.column_stack([x, deflection + half]), np.column_stack([x, deflection - half])[::-1]])
    corners = np.array([[0.0, -room], [1.1 * length, room]])
    shapes: list[DrawnShape] = [
        Outline([(0, 0), (length, 0)], "axis", 0.9, (5.0, 3.0)),
        *(Outline(np.column_stack([x, other]), "ghost", 1.4) for other in envelope),
        *wall((0.0, 0.0), (0.0, 0.09 * length), (-0.03 * length, -0.02 * length)),
        Outline(edge, "beam", 1.2, closed=True, filled=True),
        Symbol("dot", (length, deflection[-1]), "mark", 5.0),
    ]
    tip = (length, float(deflection[-1]))
    labels = [Label(label, tip, "mark", (1.0, 0.4))] if label else []
    words = "A bent beam, drawn along its own axis, clamped at the left"
    return Drawing(shapes, labels, title, words, room=corners, scale=scale)


def bent_strip(
    x: np.ndarray, y: np.ndarray, deflection: np.ndarray, across: np.ndarray, title: str, room: float
) -> Drawing:
    """Draw a deflected strip as a mesh of lines in oblique projection, with its root at the left.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the strip [m], from 0 to its length.
    y : ndarray, shape (n, positions)
        Positions across the strip [m].
    deflection : ndarray, shape (n, positions)
        Magnified deflection [m].
    across : ndarray, shape (n,)
        Magnified deflection of the centre line in the direction -y [m].
    title : str
        Title of the drawing.
    room : float
        Largest magnified deflection [m] for which the drawing reserves space.
    """

    def seen(deflection: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.stack([x[:, None] + _AWAY[0] * y, deflection + _AWAY[1] * y], axis=-1)

    rest, bent = seen(0 * deflection, y), seen(deflection, y - across[:, None])
    root, sections = rest[0], slice(None, None, _SECTIONS)
    lines = [*bent.transpose(1, 0, 2), *bent[sections]]
    gap = np.full((1, 2), np.nan)
    border = np.concatenate([rest[:, 0], rest[::-1, -1]])
    shapes: list[DrawnShape] = [
        Outline(border, "ghost", 1.4, closed=True),
        Outline(np.concatenate([part for line in lines for part in (line, gap)]), "beam", 1.0),
        Outline(root, "ground", 3.0),
    ]
    aside = _AWAY[1] * float(np.ptp(y)) / 2
    corners = np.array([[0.0, -room - aside], [1.1 * float(x[-1]), room + aside]])
    words = "A strip seen obliquely, drawn along its own axis, clamped at the left"
    return Drawing(shapes, [], title, words, room=corners)


# Sketches of symbols ----------------------------------------------------------------------------------


def sketch(entries: Mapping[str, str]) -> Rows:
    """Draw the sketches for a form with the given field texts, with the symbols of its inputs."""
    symbols = {entry.path: entry.quantity.symbol for entry in inputs_of(entries)}
    paths = {*symbols}
    rows = [[_plan()], [_section(paths), _from_the_side()]]
    speed = symbols.get("motion.rotation.speed", "omega")
    return [*rows, [_road(speed)]] if "motion.road.wavelength" in paths else rows


def _plan() -> Drawing:
    """Draw the beam and the rotor that carries it, seen along the axis of rotation."""
    s = Sketch()
    along = np.array([-np.cos(_PHI), np.sin(_PHI)])
    aside = np.array([along[1], -along[0]])
    tip, end = _ROOT + _LENGTH * along, _ROOT + (_LENGTH + _TIP) * along
    s.axis((0, 0))
    s.moment("omega", (0, 0), _HUB, 2.6, 0.6, "axis")
    s.length("r", (0, 0), _ROOT, (0.0, -1.0))
    s.dashed(_ROOT, _ROOT - (0.55, 0.0))
    s.angle("phi", _ROOT, 0.34, np.pi, np.pi - _PHI)
    s.add(*wall(_ROOT, 0.09 * aside, -0.04 * (along + aside)))
    s.say("k", _ROOT, (1.0, -0.3), "ground")
    edge = 0.018 * aside
    s.add(
        Outline([_ROOT + edge, tip + edge, tip - edge, _ROOT - edge], "beam", 1.2, closed=True, filled=True)
    )
    s.length("L", _ROOT + 0.17 * aside, tip + 0.17 * aside, aside)
    s.add(Outline([tip, end], "neutral", 1.4), Disc(end, 0.05, "body", 1.4, filled=True))
    s.add(Symbol("dot", end, "weight", 4.0))
    s.length("e", tip + 0.17 * aside, end + 0.17 * aside, aside)
    s.say("m_t", end + 0.05 * along, along, "weight")
    return s.drawing("Seen along the axis of rotation", "A beam on its carrier: r, phi, L, e, m_t, k")


def _section(paths: set[str]) -> Drawing:
    """Draw the cross-section at the root, seen from the tip.

    If "beam.thickness" is among the `paths` of the form's inputs, it has the symbols h (thickness) and b
    (width); else c (distance of the surface from the centre).
    """
    s = Sketch()
    e, f = np.array([np.cos(_PSI), np.sin(_PSI)]), np.array([-np.sin(_PSI), np.cos(_PSI)])
    h, b = 0.34, 0.9
    corners = [0.5 * (x * h * e + y * b * f) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    s.dashed((-0.75, 0.0), (0.85, 0.0))
    s.add(Outline(corners, "beam", 1.2, closed=True, filled=True), Arrow((0, 0), 0.75 * e, "load", "bending"))
    s.angle("psi", (0, 0), 0.6, 0.0, float(_PSI))
    if "beam.thickness" in paths:
        s.length("h", corners[2] - 0.13 * f, corners[3] - 0.13 * f, -f)
        s.length("b", corners[2] - 0.13 * e, corners[1] - 0.13 * e, -e)
    else:
        s.length("c", -0.58 * f, -0.58 * f + 0.5 * h * e, -f)
    return s.drawing("Section, from the tip", "The section and its direction of bending: psi, b, h")


def _from_the_side() -> Drawing:
    """Draw a radial beam that is inclined to the plane of rotation, seen from the side."""
    s = Sketch()
    along = np.array([np.cos(_ETA), np.sin(_ETA)])
    root = np.array([0.42, 0.0])
    s.dashed((0.0, -0.42), (0.0, 0.75))
    s.dashed((0.0, 0.0), (1.3, 0.0))
    s.add(*wall(root, (0.0, 0.1), (-0.05, -0.04)))
    s.add(Outline([root, root + 0.85 * along], "beam", 4.0))
    s.angle("eta", root, 0.62, 0.0, float(_ETA))
    return s.drawing("From the side", "An outward beam that leaves the plane of rotation: eta")


def _road(speed: str) -> Drawing:
    """Draw a wheel that rolls on a wavy road, with the symbol of its angular speed."""
    s = Sketch()
    x = np.linspace(-1.15, 2.0, 121)
    road = np.column_stack([x, -0.16 * np.cos(2 * np.pi * x / 1.1)])
    hub = np.array([-0.5, 0.54])
    s.add(Outline(road, "ground", 1.6), Disc(hub, 0.4, "wheel", 1.4))
    s.axis(hub)
    s.length("R", hub, hub - (0.0, 0.4), (1.0, 0.0))
    s.moment(speed, hub, 0.52, 2.1, 1.0, "axis")
    s.width("lambda", (0.55, 0.16), (1.65, 0.16), 0.4)
    s.height("A", (1.0, 0.0), (1.65, 0.16), 1.65)
    return s.drawing("Wheel on the road", "A wheel on a wavy road: R, lambda, A")
