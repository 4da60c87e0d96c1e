"""Worked examples of drum brakes in textbooks, solved by the package in the books' units."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from brakes import drum
from brakes.published import load

INCH = 0.0254
LBF = 4.4482216152605
Answers = dict[str, tuple[float, ...]]


def from_pin_line(case: dict[str, Any], scale: float, tilt: float = 0.0) -> drum.Shoe:
    """Make a shoe from angles theta measured from the line centre-pin, which has the angle `tilt` from -y."""
    far = case["pin_distance"]["value"] * scale
    pivot = far * np.sin(tilt), -far * np.cos(tilt)
    arm = case["moment_arm"]["value"] * scale if "moment_arm" in case else 2 * far * np.cos(tilt)
    start, end = (np.radians(angle) + tilt for angle in case["theta"]["value"])
    radius, width = case["drum_radius"]["value"] * scale, case["face_width"]["value"] * scale
    return drum.Shoe(radius, width, (start, end), pivot, arm + pivot[1])


def answers() -> dict[str, Answers]:
    """Solve all examples; return the results that each prints: a value, or values of several parts."""
    cases = load("drum_textbooks")
    return {name: solve(cases) for name, solve in _SOLUTIONS.items()}


def _shigley_16_2(cases: dict[str, Any]) -> Answers:
    case = cases["shigley_16_2"]
    case = case | {"pin_distance": {"value": float(np.hypot(*case["pin"]["value"]))}}
    shoe = from_pin_line(case, 1e-3)
    brake = drum.brake_torque(drum.simplex(shoe), peak_pressure=1e6, friction=case["friction"]["value"])
    leading, trailing = brake.shoes
    # Moment of the normal force, whose line of action passes through the drum's centre.
    normal = abs(leading.normal[0] * shoe.pivot[1])
    return {
        "friction_moment": (normal - brake.force * 1e-3 * case["moment_arm"]["value"],),
        "normal_moment": (normal,),
        "force": (brake.force / 1e3,),
        "leading_torque": (leading.torque,),
        "trailing_pressure": (trailing.peak_pressure / 1e3,),
        "trailing_torque": (trailing.torque,),
    }


def _shigley_16_1(cases: dict[str, Any]) -> Answers:
    case, tilt = cases["shigley_16_1"], np.radians(30)
    brake = _pushed(case, 1e-3, 1e3)
    leading, trailing = brake.shoes
    # Axes along and normal to the line from the centre to the pin.
    axes = (np.sin(tilt), -np.cos(tilt)), (np.cos(tilt), np.sin(tilt))
    return {
        "leading_pressure": (leading.peak_pressure / 1e3,),
        "trailing_pressure": (trailing.peak_pressure / 1e3,),
        "leading_torque": (leading.torque,),
        "trailing_torque": (trailing.torque,),
        "total_torque": (brake.torque,),
        "leading_pin": (_length(leading.pin_reaction),),
        "trailing_pin_components": tuple(sorted(abs(float(trailing.pin_reaction @ axis)) for axis in axes)),
        "trailing_pin": (_length(trailing.pin_reaction),),
    }


def _shigley_16_1_inch(cases: dict[str, Any]) -> Answers:
    brake = _pushed(cases["shigley_16_1_inch"], INCH, LBF)
    leading, trailing = brake.shoes
    psi, torque = LBF / INCH**2, LBF * INCH
    return {
        "leading_pressure": (leading.peak_pressure / psi,),
        "trailing_pressure": (trailing.peak_pressure / psi,),
        "leading_torque": (leading.torque / torque,),
        "trailing_torque": (trailing.torque / torque,),
        "total_torque": (brake.torque / torque,),
        "leading_pin": (_length(leading.pin_reaction) / LBF,),
        "trailing_pin": (_length(trailing.pin_reaction) / LBF,),
    }


def _pushed(case: dict[str, Any], length: float, force: float) -> drum.BrakeResult:
    """Solve both shoes of problem 16-1, in the units [m] and [N] of the case."""
    shoe = from_pin_line(case, length, np.radians(case["pin_angle"]["value"]))
    friction = case["friction"]["value"]
    return drum.brake_torque(drum.simplex(shoe), force=case["force"]["value"] * force, friction=friction)


def _shigley_16_2_problem(cases: dict[str, Any]) -> Answers:
    case = cases["shigley_16_1_inch"] | cases["shigley_16_2_problem"]
    shoe = from_pin_line(case, INCH, np.radians(case["pin_angle"]["value"]))
    drawn, pushed = (
        drum.shoe_torque(shoe, peak_pressure=1.0, friction=case["friction"]["value"], leading=leading)
        for leading in (True, False)
    )
    normal = (drawn.force + pushed.force) / 2 * shoe.moment_arm
    return {
        "friction_moment": ((normal - drawn.force * shoe.moment_arm) / INCH**3,),
        "normal_moment": (normal / INCH**3,),
        "force": (drawn.force / INCH**2,),
    }


def _bhandari_12_9(cases: dict[str, Any]) -> Answers:
    case = cases["bhandari_12_9"]
    pair = drum.simplex(from_pin_line(case, 1e-3))
    brake = drum.brake_torque(pair, peak_pressure=1e6, friction=case["friction"]["value"])
    return {
        "reference_force": (brake.force,),
        "reference_torque": (1e3 * case["pairs"] * brake.torque,),
    }


def _length(vector: np.ndarray) -> float:
    return float(np.linalg.norm(vector))


_SOLUTIONS: dict[str, Callable[[dict[str, Any]], Answers]] = {
    "shigley_16_2": _shigley_16_2,
    "shigley_16_1": _shigley_16_1,
    "shigley_16_1_inch": _shigley_16_1_inch,
    "shigley_16_2_problem": _shigley_16_2_problem,
    "bhandari_12_9": _bhandari_12_9,
}
