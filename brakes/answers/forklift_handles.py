"""Handles on a forklift's drawings: points that the user can move, and the inputs that result."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.screens.screen_parts import Handle
from brakes.drawings.duo_servo import moved
from brakes.forklift import DuoServo, ShoeMotion, Stop

_TOLERANCE = 1e-7  # tolerance of the iteration for the position at rest of a dragged point [m, rad]
_ITERATIONS = 30  # largest number of iterations for the position at rest of a dragged point
_GROUND = 1.9  # end of the drawn ground, in units of the wheelbase
_REAR_AXLE = 0.75  # height of the drawn rear axle, in units of the front wheel's radius
Values = Callable[[float, float], dict[str, float]]

# A truck ------------------------------------------------------------------------------------------------


def truck_handles(stop: Stop) -> list[Handle]:
    """Make handles on the centres of gravity, the rear axle, the front wheel and the slope of a truck."""
    t, sense = stop.truck, stop.conditions.sense
    beta = sense * float(stop.conditions.slope)
    L, r = float(t.wheelbase), float(t.front_wheel_radius)
    turn = np.array([[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]])  # rotates row vectors

    def on_slope(label: str, at: Sequence[Any], values: Values) -> Handle:
        """Make a handle at a point; `values` converts coordinates along and normal to the slope to inputs."""
        place, back = _pair(np.array(at, dtype=float) @ turn), turn.T
        return Handle(label, place, lambda x, y: values(*_pair((x, y) @ back)), step=0.01, grain=1e-3)

    def find_empty_cg(x: float, y: float) -> dict[str, float]:
        """Find the empty truck's centre of gravity with which the loaded truck's lies at (x, y) [m]."""
        m, ml = float(t.empty_mass), float(t.load_mass)
        cg = ((m + ml) * np.array([x, y - r]) - ml * np.array(t.load_cg, dtype=float)) / m
        return {"truck.empty_cg_x": float(cg[0]), "truck.empty_cg_y": float(cg[1])}

    end = _pair(np.array([_GROUND * L, 0.0]) @ turn)
    handles = [
        Handle(
            "end of the slope", end, lambda x, y: {"stop.slope": sense * float(np.arctan2(-y, x))}, step=0.05
        ),
        on_slope("rear axle", (L, _REAR_AXLE * r), lambda x, y: {"truck.wheelbase": x}),
        on_slope("top of the front wheel", (0, 2 * r), lambda x, y: {"truck.front_wheel_radius": y / 2}),
        on_slope("centre of gravity with the load", (t.cg[0], t.cg[1] + r), find_empty_cg),
    ]
    if float(t.load_mass):
        at = t.load_cg[0], t.load_cg[1] + r
        handles.append(
            on_slope(
                "centre of gravity of the load",
                at,
                lambda x, y: {"truck.load_cg_x": x, "truck.load_cg_y": y - r},
            )
        )
    return handles


# A duo-servo brake --------------------------------------------------------------------------------------


def duo_servo_handles(motion: ShoeMotion, progress: float) -> list[Handle]:
    """Make handles on the drum, and on pins, contact and piston face of the right shoe during its motion."""
    g = motion.geometry
    tip, adjuster = (_place_drawn(motion, progress, getattr(g, name)) for name in ("tip", "adjuster"))
    contact = _place_drawn(motion, progress, _contact_at_rest(motion))
    tilt, r = float(g.face_tilt), float(g.drum_radius)
    return [
        Handle("drum radius", (0.0, r), lambda x, y: {"brake.drum_radius": y}),
        Handle("tip of the shoe", _pair(tip), partial(_find_pin, motion, progress, "tip")),
        Handle("adjuster's pin", _pair(adjuster), partial(_find_pin, motion, progress, "adjuster")),
        Handle("contact of the lining", _pair(contact), partial(_find_contact, motion, progress)),
        Handle(
            "tilt of the piston's face",
            _pair(tip + 0.1 * r * np.array([np.sin(tilt), np.cos(tilt)])),
            lambda x, y: {"brake.face_tilt": float(np.arctan2(x - tip[0], y - tip[1]))},
        ),
    ]


def _place_drawn(motion: ShoeMotion, progress: float, point: object) -> np.ndarray:
    """Compute the drawn position of a point of the right shoe from its position at rest."""
    return moved(np.array([point], dtype=float), motion.geometry, motion, progress, "right")[0]


def _contact_at_rest(motion: ShoeMotion) -> np.ndarray:
    g = motion.geometry
    radius, angle = float(g.drum_radius) - float(motion.clearance), float(g.contact_angle)
    return radius * np.array([np.cos(angle), np.sin(angle)])


def _find_pin(motion: ShoeMotion, progress: float, name: str, x: float, y: float) -> dict[str, float]:
    """Find the position at rest of a pin drawn at (x, y), by iteration, as the pin changes the motion."""
    turn = max(progress - 1, 0) * float(motion.drum_turn) - min(progress, 1) * float(motion.seating_turn)
    back = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])  # rotates row vectors

    def residual(pin: np.ndarray) -> np.ndarray:
        other = _move_changed(motion.geometry, motion, **{name: _pair(pin)})
        return (np.array([x, y]) - _place_drawn(other, progress, pin)) @ back

    pin = _iterate(np.array(getattr(motion.geometry, name), dtype=float), residual)
    return {f"brake.{name}_x": float(pin[0]), f"brake.{name}_y": float(pin[1])}


def _find_contact(motion: ShoeMotion, progress: float, x: float, y: float) -> dict[str, float]:
    """Find the contact angle for which the lining's contact point is drawn in the direction of (x, y).

    `progress` tells how far the shoe has moved: 0 at rest, 1 with the lining on the drum. If it is 0, also
    find the clearance for which the contact point is drawn at (x, y) itself. Return the values by the names
    of the inputs.
    """

    def residual(angle: np.ndarray) -> np.ndarray:
        other = _move_changed(motion.geometry, motion, contact_angle=float(angle))
        drawn = _place_drawn(other, progress, _contact_at_rest(other))
        return np.arctan2(y, x) - np.arctan2(drawn[1], drawn[0])

    angle = {"brake.contact_angle": float(_iterate(np.array(motion.geometry.contact_angle), residual))}
    gap = float(motion.geometry.drum_radius) - float(np.hypot(x, y))
    return angle if progress else angle | {"brake.clearance": gap}


def _move_changed(geometry: DuoServo, motion: ShoeMotion, **changed: object) -> ShoeMotion:
    return dataclasses.replace(geometry, **changed).move_shoes(motion.clearance)  # pyright: ignore[reportArgumentType]


def _iterate(start: np.ndarray, residual: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Iterate x + residual(x) until the residual is negligible, or until `residual` raises ValueError."""
    for _ in range(_ITERATIONS):
        try:
            step = residual(start)
        except ValueError:
            break
        start = start + step
        if np.all(np.abs(step) < _TOLERANCE):
            break
    return start


def _pair(point: object) -> tuple[float, float]:
    x, y = np.asarray(point, dtype=float).tolist()
    return x, y
