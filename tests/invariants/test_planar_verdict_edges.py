"""Verdicts on friction at the very friction that jams a mechanism: no last digit decides them."""

from __future__ import annotations

import numpy as np
import pytest

from brakes import planar

JAMMING = 5.0  # arm of the pressure about the fulcrum over that of the friction, 0.25 m / 0.05 m


def block_brake(friction: float, angle: float) -> planar.Mechanism:
    """A lever that presses a block on a round drum, drawn turned by an angle."""

    def at(x: float, y: float) -> tuple[float, float]:
        z = complex(x, y) * np.exp(1j * angle)
        return z.real, z.imag

    joints = (
        planar.Pin("fulcrum", "lever", "ground", at=at(0, 0)),
        planar.Pin("axle", "drum", "ground", at=at(0.25, -0.2)),
        planar.Contact(
            "block", "lever", "drum", at=at(0.25, -0.05), centre=at(0.25, -0.2), friction=friction
        ),
    )
    loads = (
        planar.Force("hand", "lever", at=at(0.6, 0), direction=at(0, -1), magnitude=500.0),
        planar.Moment("torque", "drum"),
    )
    return planar.Mechanism(("lever", "drum"), joints, loads)


@pytest.mark.parametrize("angle", np.linspace(0, 6, 5).tolist())
@pytest.mark.parametrize("margin", [0.0, 1e-10, 1e-9, 3e-9, 1e-8])
def test_no_last_digit_decides_whether_a_brake_jams(margin: float, angle: float):
    """Within rounding of Newton's method on either side it jams; a thousandth below there is an answer."""
    found = set()
    for digit in range(-3, 4):
        for side in (1 - margin, 1 + margin):
            mechanism = block_brake(JAMMING * side * (1 + digit * 1e-13), angle)
            ways = planar.solve_with_friction(mechanism, "torque")
            found.add(tuple(sorted((way.status, way.is_determined) for way in (ways.squeeze, ways.release))))
    assert len(found) == 1 and "self-locking" in str(found)
    below = planar.solve_with_friction(block_brake(JAMMING * 0.999, angle), "torque")
    assert {below.squeeze.status, below.release.status} == {"determined"}
