"""Mechanisms drawn with their forces: open and closed, body by body, and in motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.pictures import COLOURS, save_animation
from brakes.drawings import mechanism_parts as parts
from brakes.planar import GROUND, Action, Equilibrium, Position, free_body

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TENSION, COMPRESSION = COLOURS[0], COLOURS[1]
LOAD, REACTION, BODY = "#000000", COLOURS[2], "#8a8f98"
_MM = 1e3
_LONGEST = 0.28  # longest arrow, over the size of the mechanism
_SHORTEST = 1e-6  # shorter arrows are not drawn [mm]
_ASIDE = 0.17  # distance from the middle, over the size, past which arrows may point inwards
_FAINT = 0.35


def draw_mechanism(
    position: Position,
    ax: Axes,
    equilibrium: Equilibrium | None = None,
    faint: bool = False,
    labels: bool = True,
) -> Axes:
    """Draw a mechanism at one position: bodies, pins, members, cables, faces.

    Parameters
    ----------
    position : Position
        One position.
    ax : Axes
        Where to draw; in mm.
    equilibrium : Equilibrium, optional
        Its forces: members in tension are blue, in compression vermilion.
    faint : bool
        Draw it pale and without labels, as a shadow.
    labels : bool
        Write the names of the bodies.
    """
    alpha, labels = (_FAINT, False) if faint else (1.0, labels)
    straight = parts.two_force_bodies(position.mechanism)
    for body in position.mechanism.bodies:
        if body not in straight:
            _draw_body(ax, parts.outline(position, body) * _MM, alpha)
            if labels:
                _write(ax, body, parts.label_place(position, body) * _MM, "0.25")
    for cable in parts.cables(position, equilibrium):
        _draw_member(ax, cable, alpha, labels, linestyle="--", linewidth=1.4, zorder=3)
    for _, _, points in parts.shapes(position, "spring"):
        ax.plot(*(points * _MM).T, ":", color="0.25", linewidth=1.4, alpha=alpha, zorder=3)
    for member in parts.members(position, equilibrium):
        _draw_member(ax, member, alpha, labels, linewidth=4, solid_capstyle="round", zorder=4)
    for _, shape, points in parts.shapes(position, "pin"):
        _draw_pin(ax, points[0] * _MM, GROUND in dict(shape.ends), alpha)
    _draw_faces(ax, position, alpha)
    ax.set_aspect("equal")
    ax.set(xlabel="x [mm]", ylabel="y [mm]")
    return ax


def _draw_body(ax: Axes, corners: np.ndarray, alpha: float) -> None:
    if len(corners) > 2:
        ax.fill(*corners.T, facecolor=BODY, alpha=0.22 * alpha, zorder=1)
    closed = np.vstack((corners, corners[:1]))
    ax.plot(*closed.T, color=BODY, linewidth=2, alpha=alpha, solid_joinstyle="round", zorder=2)


def _write(ax: Axes, text: str, at: Any, colour: str, **how: Any) -> None:
    box = {"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 0.5}
    how = {"ha": "center", "va": "center", "textcoords": "offset points", "xytext": (0, 0)} | how
    ax.annotate(text, (at[0], at[1]), fontsize="small", color=colour, zorder=10, bbox=box, **how)


def _colour(member: parts.Member) -> str:
    return "0.35" if not np.isfinite(member.force) else TENSION if member.force >= 0 else COMPRESSION


def _draw_member(ax: Axes, member: parts.Member, alpha: float, label: bool, **line: Any) -> None:
    ax.plot(*(member.ends * _MM).T, color=_colour(member), alpha=alpha, **line)
    if label:
        _write_along(ax, member)


def _write_along(ax: Axes, member: parts.Member) -> None:
    """Write name and force beside the last segment of a member, parallel to it."""
    size = f" {abs(member.force):.4g} N" if np.isfinite(member.force) else ""
    first, last = member.ends[-2:] * _MM
    turn = float(np.degrees(np.arctan2(last[1] - first[1], last[0] - first[0])))
    turn = turn - 180 if turn > 90 else turn + 180 if turn <= -90 else turn
    side = np.radians(turn + 90)
    beside = (8 * np.cos(side), 8 * np.sin(side))
    _write(
        ax,
        member.name + size,
        first + 0.55 * (last - first),
        _colour(member),
        xytext=beside,
        rotation=turn,
        rotation_mode="anchor",
    )


def _draw_pin(ax: Axes, at: np.ndarray, grounded: bool, alpha: float) -> None:
    if grounded:
        ax.plot(*at, "^", color="0.35", markersize=13, alpha=alpha, zorder=5)
    ax.plot(*at, "o", color="white", markeredgecolor="0.1", markersize=6, alpha=alpha, zorder=6)


def _draw_faces(ax: Axes, position: Position, alpha: float) -> None:
    """Draw short lines along slots and contact faces."""
    low, high = parts.extent(position)
    half = 0.06 * float(np.linalg.norm(high - low)) * _MM
    for _, shape, points in parts.shapes(position, "face"):
        x, y = shape.along
        angle = float(position.angle(shape.frame)) + np.arctan2(y, x)
        along, at = half * np.array((np.cos(angle), np.sin(angle))), points[0] * _MM
        ax.plot(*np.stack((at - along, at + along)).T, color="0.1", linewidth=1.6, alpha=alpha, zorder=5)


# Forces -------------------------------------------------------------------------------------------


def force_scale(*equilibria: Equilibrium) -> float:
    """Arrow length per newton [m/N] that makes the longest arrow a fixed part of the mechanism."""
    largest, size = 0.0, 0.0
    for equilibrium in equilibria:
        low, high = parts.extent(equilibrium.position)
        size = max(size, float(np.linalg.norm(high - low)))
        forces = [np.linalg.norm(arrow.force) for arrow in parts.outer_forces(equilibrium)]
        largest = max(largest, float(np.nanmax(forces, initial=0.0)))
    return _LONGEST * size / largest if largest else 0.0


def draw_rim(pads: np.ndarray, ax: Axes) -> Axes:
    """Draw the rim between the faces (2, 2) of two pads that touch it [m]."""
    low, high = np.sort(pads[:, 0]) * _MM
    height, middle = 0.3 * (high - low), float(pads[:, 1].mean()) * _MM
    x, y = (low, high, high, low), middle + height * np.array((-1, -1, 1, 1))
    ax.fill(x, y, facecolor="#f1ead2", edgecolor="0.6", zorder=0)
    _write(ax, "rim", np.array(((low + high) / 2, middle)), "0.35")
    return ax


def draw_forces(equilibrium: Equilibrium, ax: Axes, scale: float | None = None, key: bool = True) -> Axes:
    """Draw loads (black) and reactions of the ground (green) as arrows, all at one scale.

    Parameters
    ----------
    equilibrium : Equilibrium
        At one position.
    ax : Axes
        Where the mechanism is drawn; in mm.
    scale : float, optional
        Length of 1 N [m/N].
    key : bool
        Draw the key of colours and scale.
    """
    scale = force_scale(equilibrium) if scale is None else scale
    low, high = parts.extent(equilibrium.position)
    for arrow in parts.outer_forces(equilibrium):
        aside = arrow.at[0] - (low[0] + high[0]) / 2  # from outside, where it would cross the middle
        inwards = arrow.reaction and abs(aside) > _ASIDE * math.dist(low, high) and arrow.force[0] * aside < 0
        _draw_arrow(ax, arrow.at, arrow.force, scale, REACTION if arrow.reaction else LOAD, "", inwards)
    colours = {"tension": TENSION, "compression": COMPRESSION, "load": LOAD, "reaction": REACTION}
    if key:
        _draw_key(ax, colours, scale)
    return ax


def _draw_arrow(
    ax: Axes, at: np.ndarray, force: np.ndarray, scale: float, colour: str, name: str, inwards: bool = False
) -> None:
    """Draw an arrow from the point, or to it if `inwards`; none for a force of nearly 0 or nan."""
    size, reach = float(np.linalg.norm(force)), force * scale * _MM
    if not np.linalg.norm(reach) > _SHORTEST:
        return
    foot, tip = (at * _MM - reach, at * _MM) if inwards else (at * _MM, at * _MM + reach)
    how = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(tip), tuple(foot), arrowprops=how, zorder=9)
    ax.update_datalim(np.stack((foot, tip)))
    away = force / size * (-1 if inwards else 1)
    _write(
        ax,
        f"{name} {size:.4g} N".strip(),
        foot if inwards else tip,
        colour,
        xytext=tuple(7 * away),
        ha="left" if away[0] > 0.35 else "right" if away[0] < -0.35 else "center",
        va="bottom" if away[1] > 0.35 else "top" if away[1] < -0.35 else "center",
    )


def _draw_key(ax: Axes, colours: dict[str, str], scale: float) -> None:
    """Draw the key: colours, and the scale of the arrows."""
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=colour, linewidth=3, label=name) for name, colour in colours.items()]
    title = f"1 mm is {1 / (scale * _MM):.3g} N" if scale else None
    ax.legend(
        handles=handles, loc="best", fontsize="small", framealpha=0.8, title=title, title_fontsize="small"
    )


def draw_open_and_closed(open_: Position, closed: Equilibrium, ax: Axes, key: bool = True) -> Axes:
    """Draw the open mechanism as a shadow under the closed one with its forces."""
    draw_mechanism(open_, ax, faint=True)
    draw_mechanism(closed.position, ax, closed)
    draw_forces(closed, ax, key=key)
    ax.margins(0.28, 0.12)
    ax.autoscale_view()
    return ax


# Free bodies --------------------------------------------------------------------------------------


def free_body_diagrams(equilibria: Mapping[str, Equilibrium]) -> Figure:
    """Draw the free-body diagram of every body in one figure, all forces of an equilibrium at one scale.

    Parameters
    ----------
    equilibria : mapping
        Equilibria at one position by their headings, such as without and with friction; one may be "".
    """
    from matplotlib.figure import Figure

    first, *_ = equilibria.values()
    count = len(first.position.mechanism.bodies)
    columns = min(3, count)
    rows = -(-count // columns)
    figure = Figure(figsize=(4.6 * columns, 4.4 * rows * len(equilibria)), layout="constrained")
    parts: Any = figure.subfigures(len(equilibria), 1, squeeze=False)
    for part, (heading, equilibrium) in zip(parts[:, 0], equilibria.items(), strict=True):
        _draw_free_bodies(part.subplots(rows, columns, squeeze=False).ravel(), equilibrium)
        scale = _scale_of_actions(equilibrium)
        words = f"1 mm of an arrow is {1 / (scale * _MM):.3g} N" if scale else ""
        part.suptitle(": ".join(filter(None, (heading, words))), fontsize="medium")
    return figure


def _draw_free_bodies(axes: np.ndarray, equilibrium: Equilibrium) -> None:
    """Draw each body on axes of its own; those left over go."""
    bodies, scale = equilibrium.position.mechanism.bodies, _scale_of_actions(equilibrium)
    for body, ax in zip(bodies, axes, strict=False):
        draw_free_body(equilibrium, body, ax, scale)
    for ax in axes[len(bodies) :]:
        ax.remove()


def draw_free_body(equilibrium: Equilibrium, body: str, ax: Axes, scale: float) -> Axes:
    """Draw the free-body diagram of a body: loads black, joints green; `scale` the length of 1 N [m/N]."""
    corners = parts.outline(equilibrium.position, body)
    _draw_body(ax, corners * _MM, 1.0)
    loads = {load.name for load in equilibrium.position.mechanism.loads}
    pulling = {name for name, _, _ in parts.shapes(equilibrium.position, "cable")} - loads
    couples = []
    for action in free_body(equilibrium, body):
        if not np.isfinite(action.at).all():
            couples.append(_describe_couple(action))
            continue
        towards = bool(action.force @ (corners.mean(axis=0) - action.at) > 0)
        inwards = towards and action.name not in pulling  # a push comes from outside, a cable pulls away
        colour = LOAD if action.name in loads else REACTION
        words = action.name.replace("friction of ", "friction of\n")  # narrow: the arrow lies in a face
        _draw_arrow(ax, action.at, action.force, scale, colour, words, inwards)
        ax.plot(*(action.at * _MM), "o", color="white", markeredgecolor="0.1", markersize=5, zorder=6)
    ax.set_title("\n".join((body, *filter(None, couples))), fontsize="medium")
    _frame(ax)
    return ax


def _frame(ax: Axes) -> None:
    """Set limits to a square around all that is drawn, with room for labels."""
    box = ax.dataLim
    half = max(1.2 * box.width, 0.7 * box.height)
    x, y = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
    ax.set(xlim=(x - half, x + half), ylim=(y - half, y + half), xlabel="x [mm]", ylabel="y [mm]")
    ax.set_aspect("equal")


def _describe_couple(action: Action) -> str:
    return f"{action.name}: couple {action.couple:.4g} N m" if abs(action.couple) > 1e-12 else ""


def _scale_of_actions(equilibrium: Equilibrium) -> float:
    mechanism = equilibrium.position.mechanism
    forces = [np.linalg.norm(a.force) for body in mechanism.bodies for a in free_body(equilibrium, body)]
    low, high = parts.extent(equilibrium.position)
    largest = float(np.nanmax(forces, initial=0.0))
    return _LONGEST * float(np.linalg.norm(high - low)) / largest if largest else 0.0


# Motion -------------------------------------------------------------------------------------------


def animate(
    positions: Position,
    path: str | Path,
    caption: Callable[[int], str] = lambda k: "",
    force: bool = False,
    rate: float = 20.0,
) -> None:
    """Write an animation of a mechanism that moves to the last position and back.

    Parameters
    ----------
    positions : Position
        Its positions.
    path : str or Path
        File to write, .gif.
    caption : callable
        Title of position k.
    force : bool
        Overwrite a file that exists.
    rate : float
        Pictures a second.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.6, 5.2), layout="constrained")
    ax = figure.subplots()
    low, high = (_MM * corner for corner in parts.extent(positions))
    margin = 0.12 * float(np.linalg.norm(high - low))
    count = len(positions.batch)

    def frames() -> Iterator[int]:
        for k in (*range(count), *range(count - 2, 0, -1)):
            ax.clear()
            draw_mechanism(Position(positions.mechanism, positions.batch[k]), ax)
            ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
            ax.set_title(caption(k))
            yield k

    save_animation(figure, path, frames(), 80, rate, force)
