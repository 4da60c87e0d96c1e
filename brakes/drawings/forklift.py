"""Drawings of a forklift on its slope and of its brakes, and charts of distances and forces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, DrawnShape, Label, Outline, Symbol
from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.plots.curves import curves
from beamdyn.common.results.pictures import COLOURS
from brakes.drawings.arrows import ForceArrows
from brakes.drawings.duo_servo import free_bodies, positions
from brakes.forklift import InternalForces, Kinematics, Stop, Truck


def answer_drawings(
    stop: Stop | None, followed: Kinematics | None, forces: InternalForces | None, outlines: Kinematics | None
) -> list[list[Drawing]]:
    """Make rows of drawings of truck, brake and free bodies, as far as they are given.

    Parameters
    ----------
    stop : Stop, optional
        Stop of the truck, which is drawn on its slope.
    followed : Kinematics, optional
        Motion of the shoes, drawn at the ends of both stages.
    forces : InternalForces, optional
        Forces on the shoes, drawn as free bodies; without equilibrium the shoes only.
    outlines : Kinematics, optional
        Motion of the shoes, for their outlines as free bodies.
    """
    rows = [] if stop is None else [[truck(stop)]]
    if followed is not None:
        rows.append(positions(followed))
    if forces is not None:
        rows.append(free_bodies(forces, outlines))
    return rows


def truck(stop: Stop) -> Drawing:
    """Draw the truck on its slope, with weight, axle loads and tyre friction to one scale; in m.

    The stop is a single case.
    """
    t, sense = stop.truck, stop.conditions.sense
    beta = sense * float(stop.conditions.slope)
    L, r1 = float(t.wheelbase), float(t.front_wheel_radius)
    # The matrix rotates row vectors; downhill is to +x, or to -x if the truck drives forwards.
    turn = np.array([[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]])
    weight = (float(stop.front_load) + float(stop.rear_load)) / np.cos(beta)
    friction = float(stop.brake_force)
    arrows = ForceArrows(1.1 * L / weight)
    draw_chassis(arrows.shapes, t, turn)
    if has_load(t):
        at = np.array([float(t.load_cg[0]), float(t.load_cg[1]) + r1]) @ turn
        arrows.labels.append(Label(f"load\n{float(t.load_mass):.5g} kg", at, "neutral", (0.0, 1.0)))
    cg = np.array([float(t.cg[0]), float(t.cg[1]) + r1])
    places = {
        "N_A": (np.zeros(2), np.array([0.0, float(stop.front_load)]), "normal"),
        "N_B": (np.array([L, 0.0]), np.array([0.0, float(stop.rear_load)]), "normal"),
        "R_A": (np.zeros(2), np.array([-sense * friction, 0.0]), "friction"),
        "Mg": (cg, np.array([np.sin(beta), -np.cos(beta)]) * weight, "weight"),
    }
    for name, (at, vector, role) in places.items():
        arrows.add(at @ turn, vector @ turn, name, role, ends_here=name.startswith("N"))
    arrows.shapes.append(Symbol("dot", cg @ turn, "weight", 7.0))
    if not stop.stops:  # an arrow down the slope, along which the truck moves on
        at = cg + np.array([0.0, 1.2 * r1])
        foot, tip = at @ turn, (at + np.array([sense * L, 0.0])) @ turn
        arrows.shapes.append(Arrow(foot, tip, "compression", "does not stop", 4.0))
        ends = np.stack([(foot + tip) / 2, tip])
        arrows.labels.append(Label("does not stop", ends, "compression", (0.0, 1.0), priority=4))
    slope, speed = np.degrees(float(stop.conditions.slope)), 3.6 * float(stop.conditions.speed)
    title = f"{slope:.3g} deg, {speed:.3g} km/h: {outcome(stop)}"
    key = {"weight": "weight", "normal": "axle loads", "friction": "friction of the tyres"}
    return arrows.drawing(title, "A forklift on a slope with the forces on it", key)


def outcome(stop: Stop) -> str:
    """State stopping distance, or why the truck does not stop, and brake torque; for a single case."""
    how = f"stops within {float(stop.distance):.5g} m" if stop.stops else str(stop.status)
    limit = ", which limits" if str(stop.limited_by) == "brake" else ""
    return f"{how}, torque of one brake {float(stop.torque_per_brake):.5g} N m{limit}"


def draw_chassis(shapes: list[DrawnShape], t: Truck, turn: np.ndarray) -> None:
    """Add ground, wheels, body, mast and load, rotated by a matrix; x is towards the rear axle, y up."""
    L, r1 = float(t.wheelbase), float(t.front_wheel_radius)
    r2 = 0.75 * r1
    shapes.append(Outline(np.array([(-1.3 * L, 0.0), (1.9 * L, 0.0)]) @ turn, "ground", 2.0))
    body = [(0.1, 1.0), (0.1, 2.6), (0.75, 2.6), (1.28, 2.3), (1.28, 0.8), (1.0, 0.8)]
    cab = [(0.25, 2.6), (0.3, 4.9), (0.85, 4.9), (0.95, 2.5)]
    mast = [(-0.2, 0.3), (-0.2, 5.6), (-0.12, 5.6), (-0.12, 0.3)]
    for shape, role in ((cab, "second"), (body, "body"), (mast, "body")):
        shapes.append(Outline(np.array(shape) * (L, r1) @ turn, role, 1.0, closed=True, filled=True))
    if has_load(t):
        x, y = float(t.load_cg[0]), float(t.load_cg[1]) + r1
        half = min(abs(x) - 0.2 * L, y - 0.3 * r1)
        box = np.array([(-half, -half), (half, -half), (half, half), (-half, half)]) + np.array([x, y])
        shapes += [
            Outline(box @ turn, "second", 1.0, closed=True, filled=True),
            Outline(np.array([(-0.16 * L, y - half), (x - half, y - half)]) @ turn, "neutral", 3.0),
            Symbol("dot", np.array([x, y]) @ turn, "neutral", 3.0),
        ]
    for x, r in ((0.0, r1), (L, r2)):
        hub = np.array([x, r]) @ turn
        shapes += [Disc(hub, r, "wheel", 1.2, filled=True), Symbol("cross", hub, "axis", 6.0)]


def has_load(t: Truck) -> bool:
    """Return whether there is a load on the fork."""
    return bool(float(t.load_mass)) and float(t.load_cg[0]) < 0


def distances(ax: Axes, speeds: Numbers, slopes: Numbers, distance: np.ndarray) -> Axes:
    """Draw the stopping distance over speed, a curve for each slope, and name the slopes without a stop.

    Parameters
    ----------
    ax : Axes
        Axes in which the curves are drawn.
    speeds : ndarray, shape (n,)
        Speeds before the stop [m/s].
    slopes : ndarray, shape (m,)
        Slopes [rad].
    distance : ndarray, shape (m, n)
        Stopping distances [m]; inf where the truck does not stop.
    """
    stops = np.isfinite(distance).any(axis=1)
    names = np.array([f"{np.degrees(b):.3g} deg" for b in np.asarray(slopes)])
    curves(ax, 3.6 * np.asarray(speeds), distance[stops], names[stops].tolist())
    for name in names[~stops].tolist():
        ax.plot([], [], " ", label=f"{name}: never stops")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("speed [km/h]")
    ax.set_ylabel("stopping distance [m]")
    ax.legend(title="slope", fontsize=9, title_fontsize=9)
    return ax


def forces_over(
    ax: Axes, x: np.ndarray, forces: InternalForces, label: str, marks: Sequence[Any] = ()
) -> Axes:
    """Draw the forces in a duo-servo brake over one of its inputs.

    Parameters
    ----------
    ax : Axes
        Axes in which the curves are drawn.
    x : ndarray, shape (n,)
        Values of the input, in the unit of `label`.
    forces : InternalForces
        Forces of n cases.
    label : str
        Name and unit of the input, for the axis.
    marks : sequence of (name, x, y)
        Published values of forces [N], drawn as circles.
    """
    names = ("A", "P_L", "C", "B", "Q", "D")
    values = 1e-3 * np.array([np.broadcast_to(getattr(forces, name), x.shape) for name in names])
    curves(ax, x, values, names)
    for name, places, published in marks:
        colour = COLOURS[names.index(name)]
        ax.plot(places, 1e-3 * np.asarray(published), "o", color=colour, markerfacecolor="white", zorder=4)
    ax.set_ylim(bottom=0)
    ax.set_xlim(right=x[-1] + 0.09 * (x[-1] - x[0]))
    ax.locator_params(axis="x", nbins=5)
    ax.set_xlabel(label)
    ax.set_ylabel("force [kN]")
    for name, row, colour in zip(names, values, COLOURS, strict=False):
        ax.annotate(
            f"${name}$", (x[-1], row[-1]), (5, 0), textcoords="offset points", color=colour, va="center"
        )
    return ax
