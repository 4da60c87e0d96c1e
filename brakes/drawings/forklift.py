"""Drawings of a forklift on its slope, of its stopping distance, and of the forces in its brakes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from beamdyn.common.array_checks import Numbers
from beamdyn.common.curves import curves
from beamdyn.common.pictures import COLOURS
from brakes.drawings.arrows import ForceArrows, finish_drawing, force_label
from brakes.drawings.duo_servo import free_bodies, positions
from brakes.forklift import InternalForces, Kinematics, Stop

_WEIGHT, _NORMAL, _FRICTION = COLOURS[6], COLOURS[0], COLOURS[1]


def answer_figure(stop: Stop | None, followed: Kinematics | None, forces: InternalForces | None) -> Figure:
    """Draw the truck, the brake's two stages and the free bodies of its shoes, as far as they are given."""
    held = forces is not None and forces.status == "equilibrium"
    heights = [4.2] * (stop is not None) + [3.6] * (followed is not None) + [5.2] * held
    figure = Figure(figsize=(10.0, max(4.0, sum(heights))), layout="constrained")
    parts: Any = iter(
        figure.subfigures(max(1, len(heights)), 1, height_ratios=heights or [1], squeeze=False).flat
    )
    if stop is not None:
        truck(next(parts).subplots(), stop)
    if followed is not None:
        positions(next(parts), followed)
    if held:
        assert forces is not None
        free_bodies(next(parts), forces, followed)
    return figure


def truck(ax: Axes, stop: Stop) -> Axes:
    """Draw the truck on its slope with weight, axle loads and tyre friction to one scale; of one case."""
    t, beta = stop.truck, float(stop.conditions.slope)
    L, r1 = float(t.wheelbase), float(t.front_wheel_radius)
    turn = np.array(
        [[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]]
    )  # row vectors; downhill to +x
    weight = (float(stop.front_load) + float(stop.rear_load)) / np.cos(beta)
    friction = float(stop.conditions.friction) * float(stop.front_load)
    arrows = ForceArrows(ax, 1.1 * L / weight)
    _draw_chassis(ax, stop, turn)
    cg = np.array([float(t.cg[0]), float(t.cg[1]) + r1])
    places = {
        "M g": (cg, np.array([np.sin(beta), -np.cos(beta)]) * weight, _WEIGHT),
        "N_A": (np.zeros(2), np.array([0.0, float(stop.front_load)]), _NORMAL),
        "N_B": (np.array([L, 0.0]), np.array([0.0, float(stop.rear_load)]), _NORMAL),
        "R_A": (np.zeros(2), np.array([-friction, 0.0]), _FRICTION),
    }
    aside = {"N_A": "right", "N_B": "left", "M g": "left" if float(t.cg[0]) < L / 2 else "right"}
    for name, (at, vector, colour) in places.items():
        pushes, ha = name.startswith("N"), aside.get(name, "")
        label = force_label(name, vector)
        arrows.draw(at @ turn, vector @ turn, label, colour, ends_here=pushes, ha=ha)
    ax.plot(*(cg @ turn), "o", color=_WEIGHT, markersize=7, zorder=7)
    finish_drawing(ax, _title(stop))
    arrows.add_scale_bar(weight, (0.78, 0.88))
    return ax


def _title(stop: Stop) -> str:
    slope, speed = np.degrees(float(stop.conditions.slope)), 3.6 * float(stop.conditions.speed)
    where = f"{slope:.3g} deg, {speed:.3g} km/h"
    how = f"stops within {float(stop.distance):.4g} m" if stop.stops else str(stop.status)
    return f"{where}: {how}, torque of one brake {float(stop.torque_per_brake):.5g} N m"


def _draw_chassis(ax: Axes, stop: Stop, turn: np.ndarray) -> None:
    """Draw ground, wheels, body, mast and load; x down the slope, y up from the ground."""
    t = stop.truck
    L, r1 = float(t.wheelbase), float(t.front_wheel_radius)
    r2 = 0.75 * r1
    ground = np.array([(-1.3 * L, 0.0), (1.9 * L, 0.0)]) @ turn
    ax.plot(*ground.T, color="0.4", linewidth=2.0, zorder=2)
    body = [
        (0.1 * L, r1),
        (0.1 * L, 2.6 * r1),
        (0.75 * L, 2.6 * r1),
        (1.28 * L, 2.3 * r1),
        (1.28 * L, 0.8 * r1),
        (L, 0.8 * r1),
    ]
    cab = [(0.25 * L, 2.6 * r1), (0.3 * L, 4.9 * r1), (0.85 * L, 4.9 * r1), (0.95 * L, 2.5 * r1)]
    mast = [(-0.2 * L, 0.3 * r1), (-0.2 * L, 5.6 * r1), (-0.12 * L, 5.6 * r1), (-0.12 * L, 0.3 * r1)]
    for shape, shade in ((cab, "0.97"), (body, "0.9"), (mast, "0.85")):
        ax.add_patch(Polygon(np.array(shape) @ turn, facecolor=shade, edgecolor="0.55", zorder=1))
    for x, r in ((0.0, r1), (L, r2)):
        ax.add_patch(Circle(tuple(np.array([x, r]) @ turn), r, facecolor="0.75", edgecolor="0.35", zorder=3))
    _draw_load(ax, stop, turn)


def _draw_load(ax: Axes, stop: Stop, turn: np.ndarray) -> None:
    t = stop.truck
    if not float(t.load_mass) or float(t.load_cg[0]) >= 0:
        return
    x, y, r1 = (
        float(t.load_cg[0]),
        float(t.load_cg[1]) + float(t.front_wheel_radius),
        float(t.front_wheel_radius),
    )
    half = min(abs(x) - 0.2 * float(t.wheelbase), y - 0.3 * r1)
    box = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    box = box + np.array([x, y])
    ax.add_patch(Polygon(box @ turn, facecolor="0.93", edgecolor="0.55", zorder=1))
    fork = np.array([(-0.16 * float(t.wheelbase), y - half), (x - half, y - half)])
    ax.plot(*(fork @ turn).T, color="0.4", linewidth=3, zorder=1)
    at = np.array([x, y]) @ turn
    ax.text(
        at[0],
        at[1],
        f"load\n{float(t.load_mass):.5g} kg",
        ha="center",
        va="center",
        fontsize=9,
        color="0.3",
        zorder=7,
    )


def distances(ax: Axes, speeds: Numbers, slopes: Numbers, distance: np.ndarray) -> Axes:
    """Draw the stopping distance over speed, a curve per slope, and name the slopes without a stop.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    speeds : ndarray, shape (n,)
        [m/s].
    slopes : ndarray, shape (m,)
        [rad].
    distance : ndarray, shape (m, n)
        [m]; inf where the truck does not stop.
    """
    stops = [bool(np.isfinite(row).any()) for row in distance]
    names = [f"{np.degrees(b):.3g} deg" for b in np.asarray(slopes)]
    curves(
        ax,
        3.6 * np.asarray(speeds),
        distance[np.array(stops)],
        [n for n, s in zip(names, stops, strict=True) if s],
    )
    for name in (n for n, s in zip(names, stops, strict=True) if not s):
        ax.plot([], [], " ", label=f"{name}: never stops")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("speed [km/h]")
    ax.set_ylabel("stopping distance [m]")
    ax.legend(title="slope", fontsize=9, title_fontsize=9)
    return ax


def forces_over(
    ax: Axes, x: np.ndarray, forces: InternalForces, label: str, marks: Sequence[Any] = ()
) -> Axes:
    """Draw the forces in a brake over one of its inputs.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    x : ndarray, shape (n,)
        Places.
    forces : InternalForces
        Of n cases.
    label : str
        What x is.
    marks : sequence of (name, x, y)
        Published values, drawn as circles [N].
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
