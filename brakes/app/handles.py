"""Points of the drawings that can be moved, and the inputs that their places are."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from beamdyn.common.app.screens import Handle
from beamdyn.common.edge.inputs import describe
from brakes.config.mechanism import CaliperInput
from brakes.drawings.duo_servo import moved
from brakes.drum import BrakeResult
from brakes.forklift import DuoServo, ShoeMotion, Stop

_NEAR = 1e-7  # how near a point that is sought comes to where it is wanted [m], [rad]
_ROUNDS = 30
_FAR = 1.9  # end of the ground that is drawn, in wheelbases
_REAR = 0.75  # height of the rear axle that is drawn, in radii of the front wheel
Values = Callable[[float, float], dict[str, float]]

# A truck ------------------------------------------------------------------------------------------------


def of_truck(stop: Stop) -> list[Handle]:
    """Centres of gravity, rear axle, front wheel and the slope itself; x down the slope, y off the ground."""
    t, beta = stop.truck, float(stop.slope)
    L, r = float(t.wheelbase), float(t.front_wheel_radius)
    turn = np.array([[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]])  # of row vectors

    def handle(label: str, at: Sequence[Any], values: Values) -> Handle:
        place, back = _pair(np.array(at, dtype=float) @ turn), turn.T
        return Handle(label, place, lambda x, y: values(*_pair((x, y) @ back)), step=0.01, grain=1e-3)

    end = _pair(np.array([_FAR * L, 0.0]) @ turn)
    found = [
        Handle("end of the slope", end, lambda x, y: {"stop.slope": float(np.arctan2(-y, x))}, step=0.05),
        handle("rear axle", (L, _REAR * r), lambda x, y: {"truck.wheelbase": x}),
        handle("top of the front wheel", (0, 2 * r), lambda x, y: {"truck.front_wheel_radius": y / 2}),
        handle("centre of gravity with the load", (t.cg[0], t.cg[1] + r), partial(_empty_cg, stop)),
    ]
    if float(t.load_mass):
        at = t.load_cg[0], t.load_cg[1] + r
        found.append(handle("centre of gravity of the load", at, partial(_load_cg, r)))
    return found


def _load_cg(r: float, x: float, y: float) -> dict[str, float]:
    return {"truck.load_cg_x": x, "truck.load_cg_y": y - r}


def _empty_cg(stop: Stop, x: float, y: float) -> dict[str, float]:
    """That of the empty truck with which the whole has its centre of gravity at a place."""
    t = stop.truck
    m, ml = float(t.empty_mass), float(t.load_mass)
    whole = np.array([x, y - float(t.front_wheel_radius)])
    cg = ((m + ml) * whole - ml * np.array(t.load_cg, dtype=float)) / m
    return {"truck.empty_cg_x": float(cg[0]), "truck.empty_cg_y": float(cg[1])}


# A duo-servo brake --------------------------------------------------------------------------------------


def of_duo_servo(motion: ShoeMotion, progress: float) -> list[Handle]:
    """Pins, contact and piston face of the right shoe where it is on its way, and the drum."""
    g = motion.geometry
    tip, adjuster = (_drawn(motion, progress, getattr(g, name)) for name in ("tip", "adjuster"))
    contact = _drawn(motion, progress, _contact(motion))
    tilt, r = float(g.face_tilt), float(g.drum_radius)
    face = tip + 0.1 * r * np.array([np.sin(tilt), np.cos(tilt)])
    return [
        Handle("drum radius", (0.0, r), lambda x, y: {"brake.drum_radius": y}),
        Handle("tip of the shoe", _pair(tip), partial(_pin, motion, progress, "tip")),
        Handle("adjuster's pin", _pair(adjuster), partial(_pin, motion, progress, "adjuster")),
        Handle("contact of the lining", _pair(contact), partial(_contact_at, motion, progress)),
        Handle("tilt of the piston's face", _pair(face), partial(_tilt, tip)),
    ]


def _drawn(motion: ShoeMotion, progress: float, point: object) -> np.ndarray:
    """Where a point of the right shoe, given at rest, is drawn."""
    return moved(np.array([point], dtype=float), motion.geometry, motion, progress, "right")[0]


def _contact(motion: ShoeMotion) -> np.ndarray:
    g = motion.geometry
    radius, angle = float(g.drum_radius) - float(motion.clearance), float(g.contact_angle)
    return radius * np.array([np.cos(angle), np.sin(angle)])


def _tilt(tip: np.ndarray, x: float, y: float) -> dict[str, float]:
    return {"brake.face_tilt": float(np.arctan2(x - tip[0], y - tip[1]))}


def _pin(motion: ShoeMotion, progress: float, name: str, x: float, y: float) -> dict[str, float]:
    """Place at rest of a pin that is drawn at (x, y): it changes the way on which it is drawn."""
    turn = max(progress - 1, 0) * float(motion.drum_turn) - min(progress, 1) * float(motion.seating_turn)
    back = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])  # of row vectors

    def miss(pin: np.ndarray) -> np.ndarray:
        other = _other(motion.geometry, motion, **{name: _pair(pin)})
        return (np.array([x, y]) - _drawn(other, progress, pin)) @ back

    pin = _sought(np.array(getattr(motion.geometry, name), dtype=float), miss)
    return {f"brake.{name}_x": float(pin[0]), f"brake.{name}_y": float(pin[1])}


def _contact_at(motion: ShoeMotion, progress: float, x: float, y: float) -> dict[str, float]:
    """Angle of the contact that is drawn in the direction of (x, y); at rest the clearance as well."""

    def miss(angle: np.ndarray) -> np.ndarray:
        other = _other(motion.geometry, motion, contact_angle=float(angle))
        drawn = _drawn(other, progress, _contact(other))
        return np.arctan2(y, x) - np.arctan2(drawn[1], drawn[0])

    angle = {"brake.contact_angle": float(_sought(np.array(motion.geometry.contact_angle), miss))}
    gap = float(motion.geometry.drum_radius) - float(np.hypot(x, y))
    return angle if progress else angle | {"brake.clearance": gap}


def _other(geometry: DuoServo, motion: ShoeMotion, **changed: object) -> ShoeMotion:
    return dataclasses.replace(geometry, **changed).motion(motion.clearance)  # pyright: ignore[reportArgumentType]


def _sought(start: np.ndarray, miss: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Goes on by what it misses until that is nothing; a place of no brake is the answer as well."""
    for _ in range(_ROUNDS):
        try:
            gap = miss(start)
        except ValueError:
            break
        start = start + gap
        if np.all(np.abs(gap) < _NEAR):
            break
    return start


# A drum brake -------------------------------------------------------------------------------------------


def of_drum(found: BrakeResult) -> list[Handle]:
    """Lining, pin, force and drum of the first shoe; of a locked brake, which is not drawn, none."""
    if found.locked:
        return []
    shoe = found.shoes[0].shoe
    r, (start, end) = float(shoe.drum_radius), (float(angle) for angle in shoe.lining)
    return [
        Handle("drum radius", (0.0, r), lambda x, y: {"shoe.drum_radius": y}),
        Handle("start of the lining", _on_rim(r, start), partial(_lining, "lining_start")),
        Handle("end of the lining", _on_rim(r, end), partial(_lining, "lining_end")),
        Handle(
            "pin of the shoe",
            _pair(shoe.pivot),
            lambda x, y: {"shoe.pivot_offset": x, "shoe.pivot_depth": -y},
        ),
        Handle(
            "height of the force",
            (0.55 * r, float(shoe.force_arm)),
            lambda x, y: {"shoe.force_arm": y},
        ),
    ]


def _on_rim(r: float, angle: float) -> tuple[float, float]:
    return float(r * np.sin(angle)), float(-r * np.cos(angle))


def _lining(name: str, x: float, y: float) -> dict[str, float]:
    return {f"shoe.{name}": float(np.arctan2(x, -y))}


# A caliper ----------------------------------------------------------------------------------------------


def of_caliper(given: CaliperInput) -> list[Handle]:
    """Points of its dimensions, where it is open."""
    dimensions = given.dimensions  # pyright: ignore[reportAttributeAccessIssue]  (added by _model_of)
    meanings = {entry.name: entry.quantity.meaning for entry in describe(type(dimensions))}
    return [
        Handle(meanings[name], _pair(point), partial(_point, name), scale=1e3)
        for name, point in dimensions
        if isinstance(point, tuple)
    ]


def _point(name: str, x: float, y: float) -> dict[str, tuple[float, float]]:
    return {f"dimensions.{name}": (x, y)}


def _pair(point: object) -> tuple[float, float]:
    x, y = np.asarray(point, dtype=float).tolist()
    return x, y
