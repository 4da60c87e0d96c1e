"""Drawings of drum brakes: free-body diagrams, pressure over the lining, shoe factors over friction."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beamdyn.common.drawing.on_axes import plot_chart
from beamdyn.common.drawing.shapes import (
    Arrow,
    Chart,
    ChartAxis,
    ChartCurve,
    ChartMark,
    Disc,
    Drawing,
    Label,
    Outline,
    Symbol,
    arc,
)
from brakes.drawings.arrows import ForceArrows, on_rim
from brakes.drawings.machine import FRICTION_SHOWN, LIMIT_SHOWN, beside_charts, over_friction
from brakes.drum import BrakeResult, DrumBrake, ShoeResult, brake_torque

_ANGLES, _FRICTIONS = 61, 121  # numbers of points of the curves over the angle, and over the friction


def brake_figure(result: BrakeResult) -> Figure:
    """Draw a drum brake with its forces and shoe factors and, unless it locks, its pressure.

    Parameters
    ----------
    result : BrakeResult
        Result for a single case.
    """
    return beside_charts(drawing_of(result), charts_of(result))


def charts_of(result: BrakeResult) -> list[Chart]:
    """Make the charts of pressure, unless the brake locks, and of shoe factors; for a single case."""
    factors_over_friction = factor_chart(result.brake, float(result.friction), result.reverse)
    return [factors_over_friction] if result.locked else [pressure_chart(result), factors_over_friction]


def drawing_of(result: BrakeResult) -> Drawing:
    """Draw the shoes in the drum with their forces to one scale, or a mark on each shoe that locks.

    The result is for a single case, and lengths are in m. The resultants N of pressure and T of friction act
    where their lines of action cross: outside the drum, at the effective arm from its centre.
    """
    r = float(result.shoes[0].shoe.drum_radius)
    vectors = (v for s in result.shoes for v in (s.normal, s.tangential, s.pin_reaction))
    largest = 0.0 if result.locked else max(float(result.force), *(float(np.hypot(*v)) for v in vectors))
    arrows = ForceArrows(0.0 if result.locked else 0.75 * r / largest)
    # When the drum turns forward, its top moves clockwise.
    start, end = np.radians((70.0, 110.0) if result.reverse else (110.0, 70.0))
    way = arc((0, 0), 1.08 * r, start, end)
    arrows.shapes += [
        Disc((0, 0), r, "neutral", 1.4),
        Symbol("cross", (0, 0), "axis", 9.0),
        Outline(way[:-4], "neutral", 1.5),
        Arrow(way[-6], way[-1], "neutral", width=1.5),
        Symbol("dot", (0.0, r), "neutral", 3.0),
    ]
    arrows.labels.append(Label("drum", (0.0, 1.08 * r), "neutral", (0.0, 1.0)))
    for i, shoe in enumerate(result.shoes):  # the first shoe is on the right, the second on the left
        same = result.brake.leading[0] == result.brake.leading[i]
        placed = np.eye(2) if i == 0 else np.diag((-1.0, -1.0 if same else 1.0))
        _draw_shoe(arrows, shoe, placed, f"{i + 1}", bool(result.locked))
    if result.locked:
        title = f"Friction {float(result.friction):.3g}: the brake locks itself"
        return arrows.drawing(title, "A drum brake that locks: its shoes, and a mark on each that locks", {})
    title = f"Forces on the shoes at {float(result.force):.5g} N; torque {float(result.torque):.5g} N m"
    key = {"load": "actuating force P", "normal": "pressure N", "friction": "friction T", "reaction": "pin R"}
    return arrows.drawing(title, "A drum brake: its shoes with the forces on them", key)


def _draw_shoe(arrows: ForceArrows, s: ShoeResult, placed: np.ndarray, name: str, bare: bool) -> None:
    """Add a shoe with lining, pin and, unless `bare`, forces; `placed` transforms the shoe's axes."""
    r, shoe = float(s.shoe.drum_radius), s.shoe
    rim = on_rim(r, np.linspace(*shoe.lining, 80)) @ placed
    pin = np.array(shoe.pivot, dtype=float) @ placed
    lever = np.array([0.55 * r, float(shoe.force_arm)]) @ placed
    middle = r * np.array([0.36, 0.3]) @ placed
    arrows.shapes += [
        Outline(np.vstack([pin, 0.86 * rim, lever]), "body", 5.0),
        Outline(rim, "support", 7.0),
        *(Symbol("dot", at, "support", 3.0) for at in (rim[0], rim[-1])),
    ]
    if not bare:
        centre = -float(s.effective_arm) * s.normal / np.hypot(*s.normal) @ placed
        arrows.shapes.append(Outline(np.vstack([(0, 0), centre]), "normal", 0.9, (1.0, 2.0)))
        arrows.add(lever, np.array([float(s.force), 0.0]) @ placed, f"P_{name}", "load", ends_here=True)
        arrows.add(centre, s.normal @ placed, f"N_{name}", "normal")
        arrows.add(centre, s.tangential @ placed, f"T_{name}", "friction")
        arrows.add(pin, s.pin_reaction @ placed, f"R_{name}", "reaction")
        word = "leading" if s.leading else "trailing"
        text = f"{name}: {word}\n{float(s.torque):.4g} N m\nC* {float(s.c_star):.3g}"
        arrows.labels.append(Label(text, middle))
    arrows.shapes += [Symbol("pin", pin, "reaction", 8.0), Symbol("dot", lever, "load", 3.0)]
    if bare and s.locked:
        at = (on_rim(r, np.array([np.mean(shoe.lining)])) @ placed)[0]
        arrows.shapes.append(Symbol("cross", at, "inside", 16.0))
        text = f"{name}: locks from\nfriction {float(s.locking_friction):.3g} on"
        arrows.labels.append(Label(text, middle, "inside", priority=4))


def pressure_chart(result: BrakeResult) -> Chart:
    """Make the chart of one case's pressure along each lining, with vertical lines to zero at its ends."""
    curves = []
    for i, shoe in enumerate(result.shoes):
        a1, a2 = (float(a) for a in shoe.shoe.lining)
        alpha = np.linspace(a1, a2, _ANGLES)
        p = np.r_[0.0, 1e-6 * shoe.pressure(alpha), 0.0]
        curves.append(ChartCurve(_name(i, shoe), np.degrees(np.r_[a1, alpha, a2]), p, dashed=bool(i % 2)))
    angle, pressure = ChartAxis("angle from straight down", "deg"), ChartAxis("pressure", "MPa", low=0.0)
    return Chart("Pressure on the linings", angle, pressure, curves)


def _name(i: int, shoe: ShoeResult) -> str:
    """Name the curve of a shoe by its number and whether it leads."""
    return f"{i + 1}: {'leading' if shoe.leading else 'trailing'}"


def factors(ax: Axes, brake: DrumBrake, friction: float | None = None, reverse: bool = False) -> Axes:
    """Draw the chart of `factor_chart` in matplotlib axes.

    Parameters
    ----------
    ax : Axes
        Axes in which the chart is drawn.
    brake, friction, reverse
        Arguments of `factor_chart`.
    """
    return plot_chart(ax, factor_chart(brake, friction, reverse))


def factor_chart(brake: DrumBrake, friction: float | None = None, reverse: bool = False) -> Chart:
    """Make the chart of C* = torque / (force * radius) over friction, marking where the brake locks.

    It has a curve for each shoe and, if there are several, one for the brake.

    Parameters
    ----------
    brake : DrumBrake
        The brake.
    friction : float, optional
        Friction coefficient to mark.
    reverse : bool
        Whether the drum turns backward.
    """
    shoes = brake_torque(brake, friction=0.1, force=1.0, reverse=reverse).shoes
    limits = [float(np.min(shoe.locking_friction)) for shoe in shoes]
    limit, first = min(limits), int(np.argmin(limits))
    top = 0.995 * limit if limit < LIMIT_SHOWN else max(FRICTION_SHOWN, 1.3 * (friction or 0))
    mu = np.linspace(1e-3, top, _FRICTIONS)
    result = brake_torque(brake, friction=mu, force=1.0, reverse=reverse)
    of_shoes = [
        ChartCurve(_name(i, shoe), mu, shoe.c_star, dashed=bool(i % 2)) for i, shoe in enumerate(result.shoes)
    ]
    whole = [ChartCurve("brake", mu, result.c_star)] if len(of_shoes) > 1 else []
    marks = [ChartMark(friction, f"{friction:g}", at_foot=True)] if friction else []
    if limit < LIMIT_SHOWN:
        marks.append(ChartMark(limit, f"locks at {limit:.3g}", curve=of_shoes[first].name))
    # C* grows without bound towards locking: the range of its axis follows from C* at a lower friction.
    near = float(np.interp(min(friction or 0.35, 0.6 * mu[-1], 0.6 * limit), mu, result.c_star))
    return over_friction("Shoe factors", [*of_shoes, *whole], marks, near)
