"""The rotor drawn: axis of rotation, radius, and the beam at its angles, undeformed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.drawing.layout import length_text, round_below
from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, DrawnShape, Label, Outline, Symbol, arc
from beamdyn.common.drawing.sheet import Paper
from beamdyn.common.drawing.svg import svg_of
from beamdyn.common.results.one_line import number, warned
from beamdyn.common.results.result import Provenance, Result
from beamdyn.scene.beam import Beam
from beamdyn.scene.scene import Scene, check_scene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STATIONS = 41  # along the beam
_SEEN = 0.03  # depth over length that is large enough to be seen
_UNKNOWN = 0.03  # drawn depth over length where the section is not known
_SHORT = 0.2  # length over radius below which the beam is also drawn by itself
_SECTION = 290.0  # height of the section's view [pt]
_DOTTED = (1.5, 2.5)
_DASHED = (5.0, 3.0)
_DEGREES = 180 / np.pi


@dataclass(frozen=True)
class RotorDrawing(Result):
    """A scene's rotor as it is drawn: turned by 180 deg, which puts the root right of the axis.

    Parameters
    ----------
    radius : float
        Distance of the root from the axis of rotation [m].
    setting_angle, bending_angle, precone : float
        Of the mount [rad].
    length : float
        Of the beam [m].
    magnification : float
        By how much depth and width of the beam are drawn larger than its length.
    section_known : bool
        Whether depth and width are those of a rectangular section; else the beam is drawn as a strip.
    outline : ndarray, shape (82, 2)
        Edge of the beam as drawn, in the plane of rotation [m].
    section : ndarray, shape (4, 2)
        Corners of the root's section as drawn, in the plane of rotation and along its axis [m].
    provenance : Provenance
        How it was made.

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
        """What it says in one line; see `Result.headline`."""
        yield f"radius {self.say_length(self.radius)}, length {self.say_length(self.length)}"
        angles = "setting angle", "bending angle", "precone"
        for name in angles:
            yield f"{name} {number(_DEGREES * getattr(self, name.replace(' ', '_')), 'deg')}"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is not as drawn."""
        known = "" if self.section_known else "the beam's section is not known: it is drawn as a strip"
        return (known,) if known else ()

    def drawings(self) -> list[list[Drawing]]:
        """The views as data: along the axis of rotation, the section seen from the tip below it.

        Between them the beam by itself, to a scale of its own, where it is short beside the radius.
        """
        apart = [[_beam_alone(self)]] if self.length < _SHORT * self.radius else []
        return [[_plan(self)], *apart, [_section_view(self)]]

    def svg(self) -> str:
        """The text of an SVG file, whose colours follow the reader's preference for light or dark."""
        rows = self.drawings()
        return svg_of(rows, _paper(rows))

    def figure(self) -> Figure:
        """Draw both views by matplotlib."""
        from beamdyn.common.drawing.on_axes import figure_of

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
    Lengths along the beam, its radius and the offset of a tip body are to one scale. Depth and width of the
    section are drawn larger where they would not be seen, by the magnification that the drawing states. Signs
    of point masses, tip bodies and springs have no scale.

    Examples
    --------
    >>> drawing = bd.draw(bd.load_scene("examples/tyre_harvester.toml"))
    >>> drawing.radius, drawing.length  # m
    (0.215, 0.05)
    """
    start = perf_counter()
    check_scene(scene)
    beam, mount = scene.beam, scene.mount
    xi = _places(beam)
    sides, known = _sides(beam, xi)
    depth = _depth(sides, mount.bending_angle + _twist(beam, xi))
    magnification = float(max(1, round(1 / round_below(float(depth.max()) / (_SEEN * beam.length)))))
    along, aside = _directions(mount.setting_angle)
    axis = np.array([mount.radius, 0.0]) + beam.length * np.cos(mount.precone) * xi[:, None] * along
    edge = magnification * depth[:, None] / 2 * aside
    return RotorDrawing(
        radius=mount.radius,
        setting_angle=mount.setting_angle,
        bending_angle=mount.bending_angle,
        precone=mount.precone,
        length=beam.length,
        magnification=magnification,
        section_known=known,
        outline=np.vstack([axis + edge, (axis - edge)[::-1]]),
        section=_corners(sides[0], mount.bending_angle + float(_twist(beam, xi)[0])),
        provenance=Provenance(
            __version__, "undeformed", "none: it is drawn from the scene", perf_counter() - start
        ),
        scene=scene,
    )


def _paper(rows: list[list[Drawing]]) -> Paper:
    """Paper on which the section takes less room than the rotor."""
    made = Paper.of(rows)
    return Paper(made.width, (*made.heights[:-1], _SECTION))


# Geometry -----------------------------------------------------------------------------------------


def _directions(setting_angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Axes b1 and b2 of the beam on paper, where a1 points left and a2 down, shapes (2,)."""
    c, s = np.cos(setting_angle), np.sin(setting_angle)
    return np.array([-c, s]), np.array([-s, -c])


def _places(beam: Beam) -> np.ndarray:
    """Positions x/L of the outline's corners: both sides of each breakpoint, where sections may jump."""
    inner = np.array(beam.breakpoints[1:-1])
    return np.unique(np.concatenate([np.linspace(0, 1, _STATIONS), inner, np.nextafter(inner, 0)]))


def _sides(beam: Beam, xi: np.ndarray) -> tuple[np.ndarray, bool]:
    """Thickness and width (k, 2) [m] of sections, and whether they are known; a strip where they are not."""
    if beam.section is None:
        return np.full((len(xi), 2), _UNKNOWN * beam.length), False
    return np.stack([beam.section.thickness(xi), beam.section.width(xi)], axis=1), True


def _twist(beam: Beam, xi: np.ndarray) -> np.ndarray:
    return np.zeros(len(xi)) if beam.twist is None else np.asarray(beam.twist(xi))


def _depth(sides: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Height (k,) of turned sections in the plane of rotation [m]."""
    return sides[:, 0] * np.abs(np.cos(angle)) + sides[:, 1] * np.abs(np.sin(angle))


def _corners(sides: np.ndarray, angle: float) -> np.ndarray:
    """Corners (4, 2) of a section whose thickness lies at an angle from b2 towards b3."""
    e, f = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    t, w = sides / 2
    return np.array([t * e + w * f, -t * e + w * f, -t * e - w * f, t * e - w * f])


# View along the axis of rotation ------------------------------------------------------------------


def _plan(rotor: RotorDrawing) -> Drawing:
    r, L = rotor.radius, rotor.length
    along, aside = _directions(rotor.setting_angle)
    root, tip = np.array([r, 0.0]), np.array([r, 0.0]) + L * np.cos(rotor.precone) * along
    size = max(r, L)
    shapes: list[DrawnShape] = [Symbol("cross", (0, 0), "axis", 12.0)]
    labels = [Label("axis of rotation", (0, 0), "dimension", (-0.3, -1.0))]
    turn = 0.12 * size
    turned = arc((0, 0), turn, 2.4, 0.75)
    shapes += [Outline(turned[:-6], "axis", 1.2), Arrow(turned[-9], turned[-1], "axis", width=1.2)]
    labels.append(Label("positive rotation", (0, turn), "axis", (0.0, 1.0)))
    if r > 0:
        shapes += [
            Outline([(0, 0), root], "axis", 1.0, _DASHED),
            Arrow((0, 0), root, "dimension", "r", 1.0, both=True),
        ]
        labels.append(Label(f"= {length_text(r)}", [(r / 2, 0), (r / 3, 0)], "dimension", (0, -1), "r"))
    shapes += [
        Outline(rotor.outline, "beam", 1.2, closed=True, filled=True),
        *_supports(rotor, root, 0.06 * size),
    ]
    labels += [*_angle_labels(rotor, root, tip, along, aside)]
    shapes += [*_angle_shapes(rotor, root)]
    shapes += [*_bodies(rotor, root, along)]
    labels += [*_body_labels(rotor, root, along)]
    seen = f"; depth and width drawn {rotor.magnification:g} times larger" if rotor.magnification > 1 else ""
    seen = seen if rotor.section_known else "; section not known"
    title = f"Plane of rotation{seen}"
    return Drawing(shapes, labels, title, "A rotating beam seen along the axis of rotation")


def _beam_alone(rotor: RotorDrawing) -> Drawing:
    """The beam of the plane of rotation, to a scale of its own."""
    along, aside = _directions(rotor.setting_angle)
    root = np.array([rotor.radius, 0.0])
    tip = root + rotor.length * np.cos(rotor.precone) * along
    shapes = [
        Outline(rotor.outline, "beam", 1.2, closed=True, filled=True),
        *_supports(rotor, root, 0.12 * rotor.length),
        *_angle_shapes(rotor, root),
        *_bodies(rotor, root, along),
    ]
    labels = [*_angle_labels(rotor, root, tip, along, aside), *_body_labels(rotor, root, along)]
    return Drawing(shapes, labels, "The beam by itself, to a larger scale", "The beam of the rotor by itself")


def _supports(rotor: RotorDrawing, root: np.ndarray, half: float) -> list[DrawnShape]:
    """The root: clamped in a wall of half this length, or a hinge with its spring."""
    along, aside = _directions(rotor.setting_angle)
    if np.isfinite(rotor.scene.mount.root_stiffness):
        return [Symbol("pin", root, "pin", 8.0)]
    wall = np.array([root - half * aside, root + half * aside])
    ticks = wall[0] + np.linspace(0, 1, 6)[:, None] * (wall[1] - wall[0])
    back = -0.35 * half * (along + 0.6 * aside)
    hatches: list[DrawnShape] = [Outline([tick, tick + back], "ground", 0.9) for tick in ticks]
    return [Outline(wall, "ground", 2.4), *hatches]


def _angle_shapes(rotor: RotorDrawing, root: np.ndarray) -> Iterator[DrawnShape]:
    """Arc of the setting angle, from the direction inward to the beam."""
    phi = rotor.setting_angle
    size = 0.3 * rotor.length
    yield Outline([root, root - np.array([1.2 * size, 0.0])], "axis", 0.9, _DOTTED)
    if phi:
        turned = arc(root, size, np.pi, np.pi - phi)
        yield Outline(turned[:-2], "dimension", 1.0)
        yield Arrow(turned[-4], turned[-1], "dimension", "phi", 1.0)


def _angle_labels(
    rotor: RotorDrawing, root: np.ndarray, tip: np.ndarray, along: np.ndarray, aside: np.ndarray
) -> Iterator[Label]:
    phi, size = rotor.setting_angle, 0.3 * rotor.length
    middle = arc(root, size, np.pi - phi / 2, np.pi - phi / 3, 2)
    way = middle[0] - root
    yield Label(f"= {phi * _DEGREES:.4g}°", middle, "dimension", (way[0], way[1]), "φ")
    places = root + np.array([0.55, 0.75, 0.35])[:, None] * (tip - root)
    beside = 0.5 * _SEEN * rotor.length
    yield Label(
        f"beam, L = {length_text(rotor.length)}", places - beside * aside, "beam", (-aside[0], -aside[1])
    )
    if rotor.precone:
        text = f"leaves the plane by η = {rotor.precone * _DEGREES:.4g}°"
        yield Label(text, places + beside * aside, "dimension", (aside[0], aside[1]))
    stiffness = rotor.scene.mount.root_stiffness
    root_words = "root, clamped" if np.isinf(stiffness) else f"root, {stiffness:.4g} N m/rad"
    yield Label(root_words, root, "ground", (-along[0] + 0.3, -along[1] - 0.5))


def _bodies(rotor: RotorDrawing, root: np.ndarray, along: np.ndarray) -> Iterator[DrawnShape]:
    """Tip body and point masses, as signs without scale."""
    beam, c = rotor.scene.beam, np.cos(rotor.precone)
    tip = root + rotor.length * c * along
    for mass in beam.point_masses:
        yield Symbol("dot", root + mass.position * c * along, "weight", 9.0)
    for spring in beam.point_springs:
        yield Symbol("diamond", root + spring.position * c * along, "support", 9.0)
    if beam.tip is not None:
        centre = tip + beam.tip.offset * c * along
        yield Disc(centre, 0.035 * rotor.length, "body", 1.4, filled=True)
        yield Outline([tip, centre], "neutral", 1.4)
        yield Symbol("dot", centre, "weight", 4.0)


def _body_labels(rotor: RotorDrawing, root: np.ndarray, along: np.ndarray) -> Iterator[Label]:
    beam, c = rotor.scene.beam, np.cos(rotor.precone)
    for mass in beam.point_masses:
        yield Label(_mass(mass.mass), root + mass.position * c * along, "weight", (0.0, 1.0))
    for spring in beam.point_springs:
        yield Label(
            f"spring {spring.stiffness:.4g} N/m", root + spring.position * c * along, "dimension", (0.0, 1.0)
        )
    if beam.tip is not None:
        centre = root + (rotor.length + beam.tip.offset) * c * along
        far = centre + 0.035 * rotor.length * along
        yield Label(f"tip body {_mass(beam.tip.mass)}", far, "weight", (along[0], along[1]), priority=1)


# Section, seen from the tip -----------------------------------------------------------------------


def _section_view(rotor: RotorDrawing) -> Drawing:
    half = 1.35 * float(np.abs(rotor.section).max())
    psi = rotor.bending_angle
    e, dash = np.array([np.cos(psi), np.sin(psi)]), () if rotor.section_known else _DASHED
    shapes: list[DrawnShape] = [
        Outline([(-half, 0), (half, 0)], "axis", 1.0, _DASHED),
        Arrow((0, 0), (0, half), "axis", "b3", 1.0),
        Outline(rotor.section, "beam", 1.4, dash, closed=True, filled=rotor.section_known),
        Arrow((0, 0), half * e, "load", "bending", 1.8),
        Symbol("dot", (0, 0), "beam", 4.0),
    ]
    labels = [
        Label("plane of rotation", [(-0.8 * half, 0), (0.7 * half, 0)], "axis", (0, -1)),
        Label("parallel to the axis of rotation", (0, half), "axis", (0, 1)),
        Label("positive bending", [half * e, 0.6 * half * e], "load", (e[0], e[1]), priority=2),
    ]
    if psi:
        turned = arc((0, 0), 0.55 * half, 0.0, psi)
        shapes.append(Outline(turned, "dimension", 1.0))
        middle = arc((0, 0), 0.55 * half, psi / 2, psi / 3, 2)
        labels.append(Label(f"= {psi * _DEGREES:.4g}°", middle, "dimension", tuple(middle[0]), "ψ"))
    known = "" if rotor.section_known else " (not known: a square)"
    return Drawing(
        shapes, labels, f"Section of the root, from the tip{known}", "The section and its bending angle"
    )


def _mass(mass: float) -> str:
    return f"{mass:.4g} kg" if mass >= 1 else f"{1e3 * mass:.4g} g"
