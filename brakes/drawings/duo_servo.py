"""Drawings of a duo-servo brake: its parts at any position of their motion, and its shoes as free bodies."""

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
    """Draw three positions of the brake: at rest, linings on the drum, and piston at its bottom."""
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
    """Draw a duo-servo brake at a position of its motion; in m.

    Parameters
    ----------
    geometry : DuoServo
        The brake; a single one, without arrays.
    motion : ShoeMotion
        Motion of its shoes for a clearance.
    progress : float
        0 at rest, 1 with the linings on the drum, 2 with the piston at its bottom; 0.5 is half of the turn of
        the first stage, 1.5 half of the turn of the second.
    title : str
        Title of the drawing.

    Notes
    -----
    The drawn lining is concentric at rest and reaches from pin to pin. Where it is outside the drum, it would
    touch first: this part is drawn thick and red.
    """
    r, tilt = float(geometry.drum_radius), float(geometry.face_tilt)
    pin, middle = np.array([geometry.adjuster], dtype=float), float(geometry.contact_angle)
    adjuster = np.vstack([moved(pin, geometry, motion, progress, side) for side in _SIDES])
    shapes: list[DrawnShape] = [Disc((0, 0), r, "neutral"), Symbol("cross", (0, 0), "axis", 8.0)]
    shapes.append(Outline(adjuster, "neutral", 3.5))
    for side, role in _SIDES.items():
        place, sign = (geometry, motion, progress, side), 1 if side == "right" else -1
        rim = moved(lining(geometry, motion), *place)
        ends = moved(np.array([geometry.adjuster, geometry.tip], dtype=float), *place)
        out = np.hypot(*rim.T) > r + 1e-9
        contact = (r - float(motion.clearance)) * np.array([[np.cos(middle), np.sin(middle)]])
        tip, along = ends[1], np.array([sign * np.sin(tilt), np.cos(tilt)]) * 0.1 * r
        shapes += [
            Outline(np.vstack([ends[0], 0.97 * rim, tip]), "body", 4.0),
            Outline(np.array([tip, (sign * 0.12 * r, tip[1])]), "support", 5.0),  # the piston's rod, along x
            # The piston's face goes through the tip.
            Outline(np.array([tip - along, tip + along]), "contact", 2.5),
            Outline(rim, role, 3.0),
            *([Outline(np.where(out[:, None], rim, np.nan), "inside", 5.0)] if out.any() else []),
            Symbol("diamond", moved(contact, *place)[0], "mark", 8.0),
            *(Symbol("pin", end, "pin") for end in ends),
        ]
    words = "A duo-servo brake: drum, two shoes with their linings, pistons, adjuster"
    return Drawing(tuple(shapes), (), title, words, key=_KEY)


def moved(
    points: np.ndarray, geometry: DuoServo, motion: ShoeMotion, progress: float, side: str
) -> np.ndarray:
    """Compute the positions of the right shoe's points, or of the left one's, during the motion.

    Parameters
    ----------
    points : ndarray, shape (points, 2)
        Points of the right shoe at rest [m].
    geometry, motion, progress
        Arguments of `duo_servo`.
    side : {"right", "left"}
        Side on which the points are wanted; the left one is the mirror image at rest.

    Returns
    -------
    ndarray, shape (points, 2)
        Moved points [m].
    """
    first, second = min(progress, 1.0), max(progress - 1.0, 0.0)
    pin = np.array(geometry.adjuster, dtype=float)
    turned = pin + _turned(np.asarray(points) - pin, -first * float(motion.seating_turn))
    if side == "left":
        turned = turned * (-1.0, 1.0)
    return _turned(turned, second * float(motion.drum_turn))


def lining(geometry: DuoServo, motion: ShoeMotion) -> np.ndarray:
    """Return points [m] of the right lining at rest, concentric with the drum, pin to pin: (121, 2)."""
    (x, y), (ax, ay) = geometry.tip, geometry.adjuster
    angle = np.linspace(np.arctan2(float(ay), float(ax)), np.arctan2(float(y), float(x)), 121)
    radius = float(geometry.drum_radius) - float(motion.clearance)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _turned(points: np.ndarray, angle: float) -> np.ndarray:
    """Rotate points (rows of x, y) anticlockwise by an angle [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


# Free bodies ------------------------------------------------------------------------------------------------


def free_bodies(forces: InternalForces, followed: Kinematics | None = None) -> list[Drawing]:
    """Draw both shoes as free bodies, with the forces on them to one scale; for a single case, in m.

    Without equilibrium, the shoes are drawn without forces.

    Parameters
    ----------
    forces : InternalForces
        Forces in the brake.
    followed : Kinematics, optional
        Motion of the brake, for the outlines of the shoes; without it only the forces are drawn.
    """
    if forces.status == "equilibrium":
        largest = float(max(forces.A, forces.P_L, forces.C))
        scale = 0.9 * float(forces.levers.drum_radius) / largest
    else:
        scale = 0.0
    return [_free_body(ForceArrows(scale), forces, followed, side) for side in ("left", "right")]


def _free_body(arrows: ForceArrows, f: InternalForces, followed: Kinematics | None, side: str) -> Drawing:
    """Draw a shoe with its outline, if known, and the forces on it, or the reason why there are none."""
    levers, leads, name = f.levers, side == "right", f"{_SIDES[side]} shoe"
    r, sense, gamma = float(levers.drum_radius), 1 if leads else -1, float(levers.gamma)
    a, alpha = map(float, (levers.a1, levers.alpha1) if leads else (levers.a2, levers.alpha2))
    arrows.shapes += [Disc((0, 0), r, "axis", 1.2, (4.0, 2.0)), Symbol("cross", (0, 0), "axis", 8.0)]
    if followed is not None:
        geometry, motion = followed.geometry, followed.geometry.move_shoes(followed.clearance)
        place = (geometry, motion, 2.0, side)
        tip, pin = moved(np.array([geometry.tip, geometry.adjuster], dtype=float), *place)
        rim = moved(0.97 * lining(geometry, motion), *place)
        arrows.shapes.append(Outline(np.vstack([pin, rim, tip]), "body", 6.0))
    else:
        tip = a * np.array([sense * np.sin(alpha), np.cos(alpha)])
        pin = float(levers.b1) * np.array([np.sin(gamma), -np.cos(gamma)])
    if f.status != "equilibrium":
        why = {"locked": "locks itself", "no solution": "no equilibrium"}[str(f.status)]
        arrows.labels.append(Label(why, (0, 0), "inside", (0.0, 1.0), priority=4))
        return arrows.drawing(name, f"The {name}, which has no equilibrium", {})
    A, B, size, share = (
        (f.A_vector, f.B_vector, f.P_L, f.leading_share)
        if leads
        else (f.C_vector, f.D_vector, f.piston_force, f.trailing_share)
    )
    P = float(size) * np.array([sense * np.cos(alpha), -np.sin(alpha)])
    Q = sense * float(f.Q) * np.array([np.cos(gamma), np.sin(gamma)])
    contact, names = -r * A / np.hypot(*A), ("A", "B", "P_L") if leads else ("C", "D", "P_T")
    arrows.add(contact, A, names[0], "normal")
    arrows.add(contact, B, names[1], "friction")
    arrows.add(tip, P, names[2], "force", ends_here=True)
    arrows.add(pin, Q, "Q", "reaction", ends_here=True)
    key = {"normal": "drum", "friction": "its friction", "force": "piston", "reaction": "adjuster"}
    title = f"{name}: {100 * float(share):.3g} % of the torque"
    return arrows.drawing(title, f"Free body of the {name}", key)
