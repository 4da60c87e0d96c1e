"""Drawings of a duo-servo brake: its parts at any point of both stages, and its shoes as free bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from beamdyn.common.pictures import COLOURS
from brakes.drawings.arrows import ForceArrows, finish_drawing, force_label
from brakes.forklift import DuoServo, InternalForces, Kinematics, ShoeMotion

_SIDES = {"right": COLOURS[0], "left": COLOURS[1]}
_RED = "#a00000"
_PUSH, _NORMAL, _RUB = COLOURS[6], COLOURS[0], COLOURS[1]


def positions(figure: Any, followed: Kinematics) -> None:
    """Draw the brake at rest, with the linings on the drum, and with the piston at its bottom."""
    panels = figure.subplots(1, 3)
    titles = (
        f"at rest, clearance {1e3 * float(followed.clearance):.3g} mm",
        f"linings on the drum, shoes turned {np.degrees(followed.right.turn[-1]):.3g} deg",
        f"piston at its bottom, drum turned {np.degrees(followed.drum.turn[-1]):.3g} deg",
    )
    for ax, progress, title in zip(panels, (0.0, 1.0, 2.0), titles, strict=True):
        duo_servo(ax, followed.geometry, followed.geometry.move_shoes(followed.clearance), progress)
        ax.set_title(title, fontsize=10)


def duo_servo(ax: Axes, geometry: DuoServo, motion: ShoeMotion, progress: float) -> Axes:
    """Draw the brake at a point of its motion.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    geometry : DuoServo
        One brake.
    motion : ShoeMotion
        Its motion at a clearance.
    progress : float
        0 at rest, 1 with the linings on the drum, 2 with the piston at its bottom; in between, the fraction
        of the stage's turn.

    Notes
    -----
    The lining drawn is concentric at rest and reaches from pin to pin. Where it is outside the drum, it would
    touch first: there it is drawn thick and red.
    """
    r = float(geometry.drum_radius)
    ax.add_patch(Circle((0, 0), r, fill=False, color="0.45", linewidth=1.6))
    ax.plot(0, 0, "+", color="0.5", markersize=8)
    for side, colour in _SIDES.items():
        _draw_shoe(ax, geometry, motion, progress, side, colour)
    _draw_adjuster(ax, geometry, motion, progress)
    _add_legend(ax)
    ax.update_datalim([(-1.04 * r, -1.04 * r), (1.04 * r, 1.04 * r)])
    finish_drawing(ax, "")
    return ax


def moved(
    points: np.ndarray, geometry: DuoServo, motion: ShoeMotion, progress: float, side: str
) -> np.ndarray:
    """Move points of a shoe from the right side at rest to a side at a point of the motion, shape (n, 2)."""
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


def _draw_shoe(
    ax: Axes, geometry: DuoServo, motion: ShoeMotion, progress: float, side: str, colour: str
) -> None:
    place = (geometry, motion, progress, side)
    rim = moved(lining(geometry, motion), *place)
    ends = moved(np.array([geometry.adjuster, geometry.tip], dtype=float), *place)
    ax.plot(*np.vstack([ends[0], 0.97 * rim, ends[1]]).T, color="0.8", linewidth=4, zorder=1)
    ax.plot(*rim.T, color=colour, linewidth=3, zorder=3)
    out = np.hypot(*rim.T) > float(geometry.drum_radius) + 1e-9
    ax.plot(*np.where(out[:, None], rim, np.nan).T, color=_RED, linewidth=5, zorder=4)
    contact = (float(geometry.drum_radius) - float(motion.clearance)) * np.array(
        [[np.cos(geometry.contact_angle), np.sin(geometry.contact_angle)]]
    )
    ax.plot(*moved(contact, *place).T, "D", color=colour, markeredgecolor="white", markersize=7, zorder=6)
    ax.plot(*ends.T, "o", color="white", markeredgecolor="0.2", markersize=6, zorder=6)
    _draw_piston(ax, geometry, ends[1], side)


def _draw_piston(ax: Axes, geometry: DuoServo, tip: np.ndarray, side: str) -> None:
    """Draw a piston: its face through the tip, its rod along x."""
    tilt, sign, r = float(geometry.face_tilt), (1 if side == "right" else -1), float(geometry.drum_radius)
    along = np.array([sign * np.sin(tilt), np.cos(tilt)]) * 0.1 * r
    face = np.array([tip - along, tip + along])
    ax.plot(*face.T, color="0.25", linewidth=2.5, zorder=5)
    rod = np.array([tip, (sign * 0.12 * r, tip[1])])
    ax.plot(*rod.T, color="0.6", linewidth=5, zorder=2, solid_capstyle="butt")


def _draw_adjuster(ax: Axes, geometry: DuoServo, motion: ShoeMotion, progress: float) -> None:
    pin = np.array([geometry.adjuster], dtype=float)
    ends = np.vstack([moved(pin, geometry, motion, progress, side) for side in _SIDES])
    ax.plot(*ends.T, color="0.35", linewidth=3.5, zorder=2)


def _add_legend(ax: Axes) -> None:
    """Add the legend in the middle of the drum, which is empty."""
    entries = [
        Line2D([], [], color=_SIDES["right"], linewidth=3, label="leading shoe's lining"),
        Line2D([], [], color=_SIDES["left"], linewidth=3, label="trailing shoe's lining"),
        Line2D([], [], color="0.4", marker="D", linestyle="", markersize=6, label="contact of the lining"),
    ]
    if any(line.get_color() == _RED and np.isfinite(line.get_xdata()).any() for line in ax.lines):
        entries.append(Line2D([], [], color=_RED, linewidth=5, label="inside the drum's wall"))
    ax.legend(handles=entries, loc="upper center", bbox_to_anchor=(0.0, 0.0), bbox_transform=ax.transData,
              fontsize=8, frameon=False)  # fmt: skip


# Free bodies ------------------------------------------------------------------------------------------------


def free_bodies(figure: Any, forces: InternalForces, followed: Kinematics | None = None) -> None:
    """Draw both shoes as free bodies, with the forces on them to one scale; of one case.

    Parameters
    ----------
    figure : Figure or SubFigure
        Where to draw two panels.
    forces : InternalForces
        The forces.
    followed : Kinematics, optional
        The brake's motion, for the outlines of the shoes; without it only the forces are drawn.
    """
    left, right = figure.subplots(1, 2)
    largest = float(max(forces.A, forces.P_L, forces.C))
    scale = 0.9 * float(forces.levers.drum_radius) / largest
    for ax, side, title in ((left, "left", "trailing shoe"), (right, "right", "leading shoe")):
        arrows = ForceArrows(ax, scale)
        _draw_free_body(arrows, forces, followed, side)
        share = forces.leading_share if side == "right" else forces.trailing_share
        finish_drawing(ax, f"{title}: {100 * float(share):.3g} % of the torque")
        arrows.add_scale_bar(largest)


def _draw_free_body(arrows: ForceArrows, f: InternalForces, followed: Kinematics | None, side: str) -> None:
    ax, r = arrows.ax, float(f.levers.drum_radius)
    ax.add_patch(Circle((0, 0), r, fill=False, color="0.7", linewidth=1.2, linestyle="--"))
    ax.plot(0, 0, "+", color="0.5", markersize=8)
    outline, tip, pin = _outline(f, followed, side)
    if outline is not None:
        ax.plot(*outline.T, color="0.82", linewidth=7, zorder=1, solid_joinstyle="round")
    A, B = (f.A_vector, f.B_vector) if side == "right" else (f.C_vector, f.D_vector)
    contact = -r * A / np.hypot(*A)
    alpha, gamma = float(f.levers.alpha1 if side == "right" else f.levers.alpha2), float(f.levers.gamma)
    sense = 1 if side == "right" else -1
    P = float(f.P_L if side == "right" else f.piston_force) * np.array(
        [sense * np.cos(alpha), -np.sin(alpha)]
    )
    Q = sense * float(f.Q) * np.array([np.cos(gamma), np.sin(gamma)])
    a, b, ab = ("A", "B", "P_L") if side == "right" else ("C", "D", "P_T")
    arrows.draw(contact, A, force_label(a, A), _NORMAL)
    arrows.draw(contact, B, force_label(b, B), _RUB, ha="left" if side == "right" else "right")
    arrows.draw(tip, P, force_label(ab, P), _PUSH, ends_here=True)
    arrows.draw(pin, Q, force_label("Q", Q), COLOURS[2], ends_here=True)
    ax.update_datalim([(-1.02 * r, -1.02 * r), (1.02 * r, 1.02 * r)])


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
