"""Drawing of the rotor: axis of rotation, radius, and the undeformed beam at its angles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from time import perf_counter
from typing import TypeAlias

import numpy as np

from beamdyn.common.drawing.layout import Paper, length_text, round_below
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, DrawnShape, Label, Outline, Symbol, arc
from beamdyn.common.drawing.svg import svg_of
from beamdyn.common.results.one_line import number, warned
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import Provenance, Result
from beamdyn.scene.scene import Scene, check_scene

_STATIONS = 41  # number of positions along the beam at which its edge is drawn
_SEEN = 0.03  # smallest ratio of depth to length that is visible in a drawing
_UNKNOWN = 0.03  # drawn ratio of depth to length if the section is not known
_SHORT = 0.2  # ratio of length to radius below which the beam is also drawn separately
_SECTION = 290.0  # height of the drawing of the section [pt]
_DOTTED = (1.5, 2.5)
_DASHED = (5.0, 3.0)
_DEGREES = 180 / np.pi


Part: TypeAlias = DrawnShape | Label


@dataclass(frozen=True)
class RotorDrawing(Result):
    """Drawing of a scene's rotor, turned by 180 deg so that the root is right of the axis.

    Parameters
    ----------
    radius : float
        Distance of the root from the axis of rotation [m].
    setting_angle, bending_angle, precone : float
        Angles of the mount [rad].
    length : float
        Length of the beam [m].
    magnification : float
        Factor by which the dimensions of the section are enlarged relative to the length of the beam.
    section_known : bool
        Whether the beam has a rectangular section, which is drawn; else it is drawn as a strip.
    outline : ndarray, shape (n, 2)
        Edge of the beam as drawn, in the plane of rotation [m]: n = 82 without inner breakpoints.
    section : ndarray, shape (4, 2)
        Corners of the root's section as drawn, in the plane of rotation and along its axis [m].
    provenance : Provenance
        Program version and computing time.

    Examples
    --------
    >>> drawing = bd.draw(bd.load_scene("examples/tyre_harvester.toml"))
    >>> drawing.radius, drawing.setting_angle
    (0.215, 0.0)
    """

    radius: float
    setting_angle: float
    bending_angle: float
    precone: float
    length: float
    magnification: float
    section_known: bool
    outline: np.ndarray
    section: np.ndarray
    provenance: Provenance
    scene: Scene = field(repr=False)

    def headline(self) -> Iterator[str]:
        """Yield radius, length and angles for the one-line summary; see `Result.headline`."""
        yield f"radius {self.say_length(self.radius)}, length {self.say_length(self.length)}"
        for name in ("setting angle", "bending angle", "precone"):
            yield f"{name} {number(_DEGREES * getattr(self, name.replace(' ', '_')), 'deg')}"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """A warning if the beam's section is not known, and is drawn as a strip."""
        return () if self.section_known else ("the beam's section is not known: it is drawn as a strip",)

    def drawings(self) -> list[list[Drawing]]:
        """Return views as data: along the axis of rotation, and below it the section seen from the tip.

        A beam that is short relative to the radius is also drawn alone, between these two views.
        """
        apart = [[_beam_alone(self)]] if self.length < _SHORT * self.radius else []
        return [[_plan(self)], *apart, [_section_view(self)]]

    def svg(self) -> str:
        """Return the drawing as SVG text, whose colours follow the reader's preference for light or dark."""
        rows = self.drawings()
        return svg_of(rows, _paper(rows))

    def figure(self) -> Figure:
        """Draw all views by matplotlib."""
        rows = self.drawings()
        return figure_of(rows, _paper(rows))


def draw(scene: Scene) -> RotorDrawing:
    """Draw a scene's rotor: the beam at its radius and angles, undeformed.

    Parameters
    ----------
    scene : Scene
        The scene; its motion, gravity and damping are not drawn.

    Returns
    -------
    RotorDrawing

    Notes
    -----
    Lengths along the beam, its radius and the offset of a tip body are to one scale. The section is enlarged
    where it would be too thin to be visible, by the magnification that the drawing states. Symbols of point
    masses, tip bodies and springs are not to scale.

    Examples
    --------
    >>> drawing = bd.draw(bd.load_scene("examples/tyre_harvester.toml"))
    >>> drawing.radius, drawing.length  # m
    (0.215, 0.05)
    """
    start = perf_counter()
    check_scene(scene)
    beam, mount = scene.beam, scene.mount
    inner = np.array(beam.breakpoints[1:-1])  # sections may jump at breakpoints: both sides are drawn
    xi = np.unique(np.concatenate([np.linspace(0, 1, _STATIONS), inner, np.nextafter(inner, 0)]))
    if beam.strip is None:
        sides = np.full((len(xi), 2), _UNKNOWN * beam.length)
    else:
        sides = np.stack([beam.strip.thickness(xi), beam.strip.width(xi)], axis=1)
    angle = mount.bending_angle + (0.0 * xi if beam.twist is None else np.asarray(beam.twist(xi)))
    depth = sides[:, 0] * np.abs(np.cos(angle)) + sides[:, 1] * np.abs(np.sin(angle))
    magnification = float(max(1, round(1 / round_below(float(depth.max()) / (_SEEN * beam.length)))))
    along, aside = _directions(mount.setting_angle)
    axis = np.array([mount.radius, 0.0]) + beam.length * np.cos(mount.precone) * xi[:, None] * along
    edge = magnification * depth[:, None] / 2 * aside
    c, s, (t, w) = np.cos(angle[0]), np.sin(angle[0]), sides[0] / 2
    thick, wide = t * np.array([c, s]), w * np.array([-s, c])
    return RotorDrawing(
        radius=mount.radius,
        setting_angle=mount.setting_angle,
        bending_angle=mount.bending_angle,
        precone=mount.precone,
        length=beam.length,
        magnification=magnification,
        section_known=beam.strip is not None,
        outline=np.vstack([axis + edge, (axis - edge)[::-1]]),
        section=np.array([thick + wide, wide - thick, -thick - wide, thick - wide]),
        provenance=Provenance.since(start, "undeformed", "none: it is drawn from the scene"),
        scene=scene,
    )


def _paper(rows: list[list[Drawing]]) -> Paper:
    """Choose the size of the paper, with a fixed height for the view of the section in the last row."""
    made = Paper.of(rows)
    return Paper(made.width, (*made.heights[:-1], _SECTION))


def _drawing(parts: Iterable[Part], title: str, words: str) -> Drawing:
    """Make a drawing from parts (shapes and labels), which are drawn in the given order."""
    shapes: list[DrawnShape] = []
    labels: list[Label] = []
    for part in parts:
        if isinstance(part, Label):
            labels.append(part)
        else:
            shapes.append(part)
    return Drawing(shapes, labels, title, words)


def _directions(setting_angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Compute the beam's directions b1 and b2 (2,) in the drawing, where a1 points left and a2 down."""
    c, s = np.cos(setting_angle), np.sin(setting_angle)
    return np.array([-c, s]), np.array([-s, -c])


# View along the axis of rotation ------------------------------------------------------------------


def _plan(rotor: RotorDrawing) -> Drawing:
    """Draw the rotor in the plane of rotation: axis, radius and beam."""
    seen = f"; depth and width drawn {rotor.magnification:g} times larger" if rotor.magnification > 1 else ""
    seen = seen if rotor.section_known else "; section not known"
    parts = _rotor_parts(rotor)
    return _drawing(parts, f"Plane of rotation{seen}", "A rotating beam seen along the axis of rotation")


def _rotor_parts(rotor: RotorDrawing) -> Iterator[Part]:
    """Yield the axis of rotation with its sense, the radius, and the beam."""
    r, size = rotor.radius, max(rotor.radius, rotor.length)
    turn = 0.12 * size
    turned = arc((0, 0), turn, 2.4, 0.75)
    yield Symbol("cross", (0, 0), "axis", 12.0)
    yield Label("axis of rotation", (0, 0), "dimension", (-0.3, -1.0))
    yield Outline(turned[:-6], "axis", 1.2)
    yield Arrow(turned[-9], turned[-1], "axis", width=1.2)
    yield Label("positive rotation", (0, turn), "axis", (0.0, 1.0))
    if r > 0:
        root = np.array([r, 0.0])
        yield Outline([(0, 0), root], "axis", 1.0, _DASHED)
        yield Arrow((0, 0), root, "dimension", "r", 1.0, both=True)
        yield Label(f"= {length_text(r)}", [(r / 2, 0), (r / 3, 0)], "dimension", (0, -1), "r")
    yield from _beam_parts(rotor, 0.06 * size)


def _beam_alone(rotor: RotorDrawing) -> Drawing:
    """Draw the beam alone in the plane of rotation, to a separate scale."""
    title = "The beam by itself, to a larger scale"
    return _drawing(_beam_parts(rotor, 0.12 * rotor.length), title, "The beam of the rotor by itself")


def _beam_parts(rotor: RotorDrawing, half: float) -> Iterator[Part]:
    """Yield the beam with its root (hinge, or wall of half length `half`), its angles and bodies."""
    along, aside = _directions(rotor.setting_angle)
    root, phi = np.array([rotor.radius, 0.0]), rotor.setting_angle
    stiffness = rotor.scene.mount.root_stiffness
    yield Outline(rotor.outline, "beam", 1.2, closed=True, filled=True)
    if np.isfinite(stiffness):
        yield Symbol("pin", root, "pin", 8.0)
    else:
        wall = np.array([root - half * aside, root + half * aside])
        yield Outline(wall, "ground", 2.4)
        back = -0.35 * half * (along + 0.6 * aside)
        for tick in wall[0] + np.linspace(0, 1, 6)[:, None] * (wall[1] - wall[0]):
            yield Outline([tick, tick + back], "ground", 0.9)
    size = 0.3 * rotor.length
    yield Outline([root, root - np.array([1.2 * size, 0.0])], "axis", 0.9, _DOTTED)
    if phi:
        turned = arc(root, size, np.pi, np.pi - phi)
        yield Outline(turned[:-2], "dimension", 1.0)
        yield Arrow(turned[-4], turned[-1], "dimension", "phi", 1.0)
    middle = arc(root, size, np.pi - phi / 2, np.pi - phi / 3, 2)
    way = middle[0] - root
    yield Label(f"= {phi * _DEGREES:.4g}°", middle, "dimension", (way[0], way[1]), "φ")
    tip = root + rotor.length * np.cos(rotor.precone) * along
    places = root + np.array([0.55, 0.75, 0.35])[:, None] * (tip - root)
    below, name = 0.5 * _SEEN * rotor.length * aside, f"beam, L = {length_text(rotor.length)}"
    yield Label(name, places - below, "beam", (-aside[0], -aside[1]))
    if rotor.precone:
        text = f"leaves the plane by η = {rotor.precone * _DEGREES:.4g}°"
        yield Label(text, places + below, "dimension", (aside[0], aside[1]))
    root_words = "root, clamped" if np.isinf(stiffness) else f"root, {stiffness:.4g} N m/rad"
    yield Label(root_words, root, "ground", (-along[0] + 0.3, -along[1] - 0.5))
    yield from _bodies(rotor, root, along)


def _bodies(rotor: RotorDrawing, root: np.ndarray, along: np.ndarray) -> Iterator[Part]:
    """Yield point masses, springs and tip body as symbols without scale."""
    beam, c = rotor.scene.beam, np.cos(rotor.precone)
    for mass in beam.point_masses:
        at = root + mass.position * c * along
        yield Symbol("dot", at, "weight", 9.0)
        yield Label(_mass(mass.mass), at, "weight", (0.0, 1.0))
    for spring in beam.point_springs:
        at = root + spring.position * c * along
        yield Symbol("diamond", at, "support", 9.0)
        yield Label(f"spring {spring.stiffness:.4g} N/m", at, "dimension", (0.0, 1.0))
    if beam.tip is not None:
        tip = root + rotor.length * c * along
        centre = tip + beam.tip.offset * c * along
        far = root + (rotor.length + beam.tip.offset) * c * along + 0.035 * rotor.length * along
        yield Disc(centre, 0.035 * rotor.length, "body", 1.4, filled=True)
        yield Outline([tip, centre], "neutral", 1.4)
        yield Symbol("dot", centre, "weight", 4.0)
        yield Label(f"tip body {_mass(beam.tip.mass)}", far, "weight", (along[0], along[1]), priority=1)


# Section, seen from the tip -----------------------------------------------------------------------


def _section_view(rotor: RotorDrawing) -> Drawing:
    """Draw the root's section with the direction of bending, and the plane and axis of rotation."""
    known = "" if rotor.section_known else " (not known: a square)"
    title = f"Section of the root, from the tip{known}"
    return _drawing(_section_parts(rotor), title, "The section and its bending angle")


def _section_parts(rotor: RotorDrawing) -> Iterator[Part]:
    half, psi = 1.35 * float(np.abs(rotor.section).max()), rotor.bending_angle
    e, dash = np.array([np.cos(psi), np.sin(psi)]), () if rotor.section_known else _DASHED
    yield Outline([(-half, 0), (half, 0)], "axis", 1.0, _DASHED)
    yield Arrow((0, 0), (0, half), "axis", "b3", 1.0)
    yield Outline(rotor.section, "beam", 1.4, dash, closed=True, filled=rotor.section_known)
    yield Arrow((0, 0), half * e, "load", "bending", 1.8)
    yield Symbol("dot", (0, 0), "beam", 4.0)
    yield Label("plane of rotation", [(-0.8 * half, 0), (0.7 * half, 0)], "axis", (0, -1))
    yield Label("parallel to the axis of rotation", (0, half), "axis", (0, 1))
    yield Label("positive bending", [half * e, 0.6 * half * e], "load", (e[0], e[1]), priority=2)
    if psi:
        yield Outline(arc((0, 0), 0.55 * half, 0.0, psi), "dimension", 1.0)
        middle = arc((0, 0), 0.55 * half, psi / 2, psi / 3, 2)
        yield Label(f"= {psi * _DEGREES:.4g}°", middle, "dimension", tuple(middle[0]), "ψ")


def _mass(mass: float) -> str:
    return f"{mass:.4g} kg" if mass >= 1 else f"{1e3 * mass:.4g} g"
