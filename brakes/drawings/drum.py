"""Drawings of drum brakes: free-body diagrams, pressure over the lining, shoe factors over friction."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle

from beamdyn.common.array_checks import Numbers
from beamdyn.common.curves import grid
from beamdyn.common.pictures import COLOURS
from brakes.drawings.arrows import ForceArrows, finish_drawing, force_label
from brakes.drum import BrakeResult, DrumBrake, ShoeResult, brake_torque

_P, _N, _T, _R = COLOURS[6], COLOURS[0], COLOURS[1], COLOURS[2]
_FRICTION_SHOWN, _LIMIT_SHOWN = 0.8, 1.6


def brake_figure(result: BrakeResult) -> Figure:
    """Draw free-body diagram, pressure and shoe factors; of a locked brake the factors alone.

    Parameters
    ----------
    result : BrakeResult
        A result of one case.
    """
    if result.locked:
        figure = Figure(figsize=(7.5, 4.8), layout="constrained")
        factors(figure.subplots(), result.brake, float(result.friction), result.reverse)
        return figure
    figure = Figure(figsize=(11.0, 7.0), layout="constrained")
    spaces = figure.add_gridspec(2, 2, width_ratios=(1.35, 1))
    free_body(figure.add_subplot(spaces[:, 0]), result)
    pressures(figure.add_subplot(spaces[0, 1]), result)
    factors(figure.add_subplot(spaces[1, 1]), result.brake, float(result.friction), result.reverse)
    return figure


def free_body(ax: Axes, result: BrakeResult) -> Axes:
    """Draw the shoes in the drum with their forces to one scale; of one case.

    The resultants N of the pressure and T of the friction act where their lines of action cross, which is
    outside the drum, at the effective arm from its centre.
    """
    r = float(result.shoes[0].shoe.drum_radius)
    largest = max(float(np.hypot(*v)) for s in result.shoes for v in (s.normal, s.tangential, s.pin_reaction))
    largest = max(largest, float(result.force))
    arrows = ForceArrows(ax, 0.75 * r / largest)
    ax.add_patch(Circle((0, 0), r, fill=False, color="0.55", linewidth=1.4))
    ax.plot(0, 0, "+", color="0.4", markersize=9)
    for i, shoe in enumerate(result.shoes):
        _draw_shoe(arrows, shoe, _placement(result, i), f"{i + 1}")
    _draw_rotation(ax, r, result.reverse)
    ax.update_datalim([(-1.05 * r, -1.05 * r), (1.05 * r, 1.05 * r)])
    finish_drawing(
        ax, f"Forces on the shoes at {float(result.force):.4g} N; torque {float(result.torque):.5g} N m"
    )
    arrows.add_scale_bar(largest)
    return ax


def _placement(result: BrakeResult, i: int) -> np.ndarray:
    """Matrix from a shoe's own axes to the picture: the first on the right, the second on the left."""
    if i == 0:
        return np.eye(2)
    same = result.brake.leading[0] == result.brake.leading[i]
    return np.diag((-1.0, -1.0)) if same else np.diag((-1.0, 1.0))


def _draw_shoe(arrows: ForceArrows, s: ShoeResult, placed: np.ndarray, name: str) -> None:
    ax, shoe = arrows.ax, s.shoe
    a1, a2 = shoe.lining
    alpha = np.linspace(a1, a2, 80)
    rim = float(shoe.drum_radius) * np.stack([np.sin(alpha), -np.cos(alpha)], axis=-1) @ placed
    ax.plot(*rim.T, color="0.35", linewidth=7, solid_capstyle="butt", zorder=3)
    pin = np.array(shoe.pivot, dtype=float) @ placed
    lever = np.array([0.55 * float(shoe.drum_radius), float(shoe.force_arm)]) @ placed
    inner = 0.86 * rim
    ax.plot(*np.vstack([pin, inner, lever]).T, color="0.75", linewidth=5, zorder=1, solid_joinstyle="round")
    ax.plot(*pin, "o", color="white", markeredgecolor=_R, markersize=8, markeredgewidth=1.8, zorder=5)
    centre = -float(s.effective_arm) * s.normal / np.hypot(*s.normal) @ placed
    ax.plot(*np.vstack([(0, 0), centre]).T, color=_N, linewidth=0.9, linestyle=":", zorder=2)
    P = np.array([float(s.force), 0.0]) @ placed
    arrows.draw(lever, P, f"$P_{name}$", _P, ends_here=True)
    acting = (centre, s.normal, "N", _N), (centre, s.tangential, "T", _T), (pin, s.pin_reaction, "R", _R)
    for at, vector, symbol, colour in acting:
        outward = ("left" if centre[0] > 0 else "right") if symbol == "T" else ""
        arrows.draw(at, vector @ placed, force_label(f"{symbol}_{name}", vector), colour, ha=outward)
    word = "leading" if s.leading else "trailing"
    middle = float(shoe.drum_radius) * np.array([0.42, 0.36]) @ placed
    text = f"{name}: {word}\n{float(s.torque):.4g} N m\nC* {float(s.c_star):.3g}"
    ax.text(middle[0], middle[1], text, ha="center", va="center", fontsize=9)


def _draw_rotation(ax: Axes, r: float, reverse: bool) -> None:
    """Draw the sense of rotation at the top of the drum: clockwise when forward."""
    ax.add_patch(Arc((0, 0), 2.16 * r, 2.16 * r, theta1=70, theta2=110, color="0.4", linewidth=1.5))
    end, sense = (np.radians(110.0), 1) if reverse else (np.radians(70.0), -1)
    at = 1.08 * r * np.array([np.cos(end), np.sin(end)])
    along = 0.02 * r * sense * np.array([-np.sin(end), np.cos(end)])
    head = {"arrowstyle": "-|>", "color": "0.4", "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=tuple(at + along), xytext=tuple(at), arrowprops=head)
    ax.text(0, 1.12 * r, "drum", ha="center", va="bottom", color="0.4", fontsize=9)


def pressures(ax: Axes, result: BrakeResult) -> Axes:
    """Draw the pressure over the linings; of one case."""
    for i, shoe in enumerate(result.shoes):
        a1, a2 = (float(a) for a in shoe.shoe.lining)
        alpha = np.linspace(a1, a2, 200)
        p = 1e-6 * shoe.pressure(alpha)
        word = "leading" if shoe.leading else "trailing"
        alpha, p = np.r_[a1, alpha, a2], np.r_[0.0, p, 0.0]
        ax.plot(np.degrees(alpha), p, color=COLOURS[i], linestyle=("-", "--")[i % 2], linewidth=1.8,
                label=f"{i + 1}: {word}")  # fmt: skip
    grid(ax)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("angle from straight down [deg]")
    ax.set_ylabel("pressure [MPa]")
    ax.legend(fontsize=9)
    ax.set_title("Pressure on the linings", fontsize=11)
    return ax


def factors(ax: Axes, brake: DrumBrake, friction: float | None = None, reverse: bool = False) -> Axes:
    """Draw C* of each shoe and of the brake over friction, with the friction at which it locks.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    brake : DrumBrake
        The brake.
    friction : float, optional
        Friction to mark.
    reverse : bool
        Whether the drum turns backward.
    """
    limits = [
        float(np.min(shoe.locking_friction))
        for shoe in brake_torque(brake, friction=0.1, force=1.0, reverse=reverse).shoes
    ]
    limit, first = min(limits), int(np.argmin(limits))
    top = 0.995 * limit if limit < _LIMIT_SHOWN else max(_FRICTION_SHOWN, 1.3 * (friction or 0))
    mu = np.linspace(1e-3, top, 400)
    result = brake_torque(brake, friction=mu, force=1.0, reverse=reverse)
    lines = [("brake", result.c_star, COLOURS[6], "-")] if len(result.shoes) > 1 else []
    for i, shoe in enumerate(result.shoes):
        word = "leading" if shoe.leading else "trailing"
        lines.append((f"{i + 1}: {word}", shoe.c_star, COLOURS[i], ("-", "--")[i % 2]))
    for label, values, colour, style in lines:
        ax.plot(mu, values, color=colour, linestyle=style, linewidth=1.8, label=label)
    ceiling = _ceiling(result.c_star, mu, friction)
    ax.set_ylim(0, ceiling)
    _mark_friction(ax, limit, COLOURS[first], friction, ceiling)
    grid(ax)
    ax.set_xlim(left=0)
    ax.set_xlabel("friction of the linings")
    ax.set_ylabel("C* = torque / (force radius)")
    ax.legend(fontsize=9, loc="upper left")
    ax.set_title("Shoe factors", fontsize=11)
    return ax


def _ceiling(c_star: Numbers, mu: np.ndarray, friction: float | None) -> float:
    """Upper limit of the C* axis, as C* grows without bound towards locking."""
    near = float(np.interp(min(friction or 0.35, 0.6 * mu[-1]), mu, c_star))
    return max(2.5 * near, 1.0)


def _mark_friction(ax: Axes, limit: float, colour: str, friction: float | None, ceiling: float) -> None:
    """Mark the friction of the case, and that at which the shoe drawn in this colour locks."""
    if friction:
        ax.axvline(friction, color="0.5", linewidth=1, linestyle=":")
        ax.text(friction, 0.02 * ceiling, f" {friction:g}", color="0.35", fontsize=9, va="bottom")
    if limit < _LIMIT_SHOWN:
        ax.axvline(limit, color=colour, linewidth=1.4, linestyle="-.")
        ax.text(limit, 0.5 * ceiling, f"locks at {limit:.3g} ", color=colour, fontsize=9, ha="right",
                rotation=90, va="center")  # fmt: skip
