"""Drawings of a duo-servo brake: its parts at any point of both stages, and its shoes as free bodies."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Label, Outline, Symbol
from brakes.drawings.arrows import ForceArrows
from brakes.forklift import DuoServo, InternalForces, Kinematics, ShoeMotion

_SIDES = {"right": "leading", "left": "trailing"}
_KEY = {
    "leading": "leading shoe's lining",
    "trailing": "trailing shoe's lining",
    "mark": "contact of the lining",
    "inside": "inside the drum's wall",
}


def positions(followed: Kinematics) -> list[Drawing]:
    """The brake at rest, with the linings on the drum, and with the piston at its bottom."""
    titles = (
        f"at rest, clearance {1e3 * float(followed.clearance):.3g} mm",
        f"linings on the drum, shoes turned {np.degrees(followed.right.turn[-1]):.3g} deg",
        f"piston at its bottom, drum turned {np.degrees(followed.drum.turn[-1]):.3g} deg",
    )
    motion = followed.geometry.move_shoes(followed.clearance)
    return [
        duo_servo(followed.geometry, motion, progress, title)
        for progress, title in zip((0.0, 1.0, 2.0), titles, strict=True)
    ]


def duo_servo(geometry: DuoServo, motion: ShoeMotion, progress: float, title: str = "") -> Drawing:
    """The brake at a point of its motion; in m.

    Parameters
    ----------
    geometry : DuoServo
        One brake.
    motion : ShoeMotion
        Its motion at a clearance.
    progress : float
        0 at rest, 1 with the linings on the drum, 2 with the piston at its bottom; in between, the fraction
        of the stage's turn.
    title : str
        Title.

    Notes
    -----
    The lining drawn is concentric at rest and reaches from pin to pin. Where it is outside the drum, it would
    touch first: there it is drawn thick and red.
    """
    r = float(geometry.drum_radius)
    shapes: list[DrawnShape] = [Disc((0, 0), r, "neutral"), Symbol("cross", (0, 0), "axis", 8.0)]
    shapes += _adjuster(geometry, motion, progress)
    for side, role in _SIDES.items():
        shapes += _shoe(geometry, motion, progress, side, role)
    words = "A duo-servo brake: drum, two shoes with their linings, pistons, adjuster"
    return Drawing(tuple(shapes), (), title, words, key=_KEY)


def moved(
    points: np.ndarray, geometry: DuoServo, motion: ShoeMotion, progress: float, side: str
) -> np.ndarray:
    """Move points of the right shoe at rest to where they are on a side at a point of the motion.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        Points of the right shoe at rest [m].
    geometry, motion, progress
        As for `duo_servo`.
    side : {"right", "left"}
        The side.

    Returns
    -------
    ndarray, shape (n, 2)
        [m]
    """
    first, second = min(progress, 1.0), max(progress - 1.0, 0.0)
    pin = np.array(geometry.adjuster, dtype=float)
    turned = pin + _turned(np.asarray(points) - pin, -first * float(motion.seating_turn))
    if side == "left":
        turned = turned * (-1.0, 1.0)
    return _turned(turned, second * float(motion.drum_turn))


def lining(geometry: DuoServo, motion: ShoeMotion) -> np.ndarray:
    """Points [m] of the right lining at rest, concentric and reaching from pin to pin, shape (121, 2)."""
    (x, y), (ax, ay) = geometry.tip, geometry.adjuster
    angle = np.linspace(np.arctan2(float(ay), float(ax)), np.arctan2(float(y), float(x)), 121)
    radius = float(geometry.drum_radius) - float(motion.clearance)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _turned(points: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


def _shoe(geometry: DuoServo, motion: ShoeMotion, progress: float, side: str, role: str) -> list[DrawnShape]:
    place = (geometry, motion, progress, side)
    rim = moved(lining(geometry, motion), *place)
    ends = moved(np.array([geometry.adjuster, geometry.tip], dtype=float), *place)
    out = np.hypot(*rim.T) > float(geometry.drum_radius) + 1e-9
    contact = (float(geometry.drum_radius) - float(motion.clearance)) * np.array(
        [[np.cos(geometry.contact_angle), np.sin(geometry.contact_angle)]]
    )
    inside = [Outline(np.where(out[:, None], rim, np.nan), "inside", 5.0)] if out.any() else []
    return [
        Outline(np.vstack([ends[0], 0.97 * rim, ends[1]]), "body", 4.0),
        *_piston(geometry, ends[1], side),
        Outline(rim, role, 3.0),
        *inside,
        Symbol("diamond", moved(contact, *place)[0], "mark", 8.0),
        *(Symbol("pin", end, "pin") for end in ends),
    ]


def _piston(geometry: DuoServo, tip: np.ndarray, side: str) -> list[DrawnShape]:
    """A piston: its face through the tip, its rod along x."""
    tilt, sign, r = float(geometry.face_tilt), (1 if side == "right" else -1), float(geometry.drum_radius)
    along = np.array([sign * np.sin(tilt), np.cos(tilt)]) * 0.1 * r
    rod = np.array([tip, (sign * 0.12 * r, tip[1])])
    face = np.array([tip - along, tip + along])
    return [Outline(rod, "support", 5.0), Outline(face, "contact", 2.5)]


def _adjuster(geometry: DuoServo, motion: ShoeMotion, progress: float) -> list[DrawnShape]:
    pin = np.array([geometry.adjuster], dtype=float)
    ends = np.vstack([moved(pin, geometry, motion, progress, side) for side in _SIDES])
    return [Outline(ends, "neutral", 3.5)]


# Free bodies ------------------------------------------------------------------------------------------------


def free_bodies(forces: InternalForces, followed: Kinematics | None = None) -> list[Drawing]:
    """Both shoes as free bodies, with the forces on them to one scale; of one case, in m.

    Parameters
    ----------
    forces : InternalForces
        The forces.
    followed : Kinematics, optional
        The brake's motion, for the outlines of the shoes; without it only the forces are drawn.
    """
    largest = float(max(forces.A, forces.P_L, forces.C))
    scale = 0.9 * float(forces.levers.drum_radius) / largest
    return [
        _free_body(ForceArrows(scale), forces, followed, "left", "trailing shoe"),
        _free_body(ForceArrows(scale), forces, followed, "right", "leading shoe"),
    ]


def bare_shoes(forces: InternalForces, followed: Kinematics | None = None) -> list[Drawing]:
    """Both shoes without forces, where there is no equilibrium; otherwise as `free_bodies`."""
    why = {"locked": "locks itself", "no solution": "no equilibrium"}[str(forces.status)]
    drawings = []
    for side, name in (("left", "trailing shoe"), ("right", "leading shoe")):
        arrows = ForceArrows(0.0)
        _draw_shoe(arrows, forces, followed, side)
        arrows.labels.append(Label(why, (0, 0), "inside", (0.0, 1.0), priority=4))
        drawings.append(arrows.drawing(name, f"The {name}, which has no equilibrium", {}))
    return drawings


def _draw_shoe(
    arrows: ForceArrows, f: InternalForces, followed: Kinematics | None, side: str
) -> tuple[np.ndarray, np.ndarray]:
    """Add the drum, and the outline of a shoe if known; return the points of piston and adjuster [m]."""
    r = float(f.levers.drum_radius)
    arrows.shapes += [Disc((0, 0), r, "axis", 1.2, (4.0, 2.0)), Symbol("cross", (0, 0), "axis", 8.0)]
    outline, tip, pin = _outline(f, followed, side)
    if outline is not None:
        arrows.shapes.append(Outline(outline, "body", 6.0))
    return tip, pin


def _free_body(
    arrows: ForceArrows, f: InternalForces, followed: Kinematics | None, side: str, name: str
) -> Drawing:
    r = float(f.levers.drum_radius)
    tip, pin = _draw_shoe(arrows, f, followed, side)
    A, B = (f.A_vector, f.B_vector) if side == "right" else (f.C_vector, f.D_vector)
    contact = -r * A / np.hypot(*A)
    alpha, gamma = float(f.levers.alpha1 if side == "right" else f.levers.alpha2), float(f.levers.gamma)
    sense = 1 if side == "right" else -1
    P = float(f.P_L if side == "right" else f.piston_force) * np.array(
        [sense * np.cos(alpha), -np.sin(alpha)]
    )
    Q = sense * float(f.Q) * np.array([np.cos(gamma), np.sin(gamma)])
    a, b, ab = ("A", "B", "P_L") if side == "right" else ("C", "D", "P_T")
    arrows.add(contact, A, a, "normal")
    arrows.add(contact, B, b, "friction")
    arrows.add(tip, P, ab, "force", ends_here=True)
    arrows.add(pin, Q, "Q", "reaction", ends_here=True)
    share = f.leading_share if side == "right" else f.trailing_share
    key = {"normal": "drum", "friction": "its friction", "force": "piston", "reaction": "adjuster"}
    title = f"{name}: {100 * float(share):.3g} % of the torque"
    return arrows.drawing(title, f"Free body of the {name}", key)


def _outline(
    f: InternalForces, followed: Kinematics | None, side: str
) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
    """Outline of the shoe if known, and the points [m] where the piston and the adjuster act."""
    if followed is not None:
        geometry, motion = followed.geometry, followed.geometry.move_shoes(followed.clearance)
        place = (geometry, motion, 2.0, side)
        tip, pin = moved(np.array([geometry.tip, geometry.adjuster], dtype=float), *place)
        rim = moved(0.97 * lining(geometry, motion), *place)
        return np.vstack([pin, rim, tip]), tip, pin
    levers, sense = f.levers, 1 if side == "right" else -1
    a, alpha = (levers.a1, levers.alpha1) if side == "right" else (levers.a2, levers.alpha2)
    tip = float(a) * np.array([sense * np.sin(float(alpha)), np.cos(float(alpha))])
    pin = float(levers.b1) * np.array([np.sin(float(levers.gamma)), -np.cos(float(levers.gamma))])
    return None, tip, pin
