"""Stated errors of drum brakes near self-locking, and of stops near never stopping, against 40 digits."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.stated_drum_errors import KINDS, measure
from brakes import drum, forklift
from brakes.cli import main

SHOE = drum.Shoe(0.138, 0.05, tuple(np.radians((30.0, 110.0))), (0.02, -0.11), 0.115)
LEVERS = forklift.Levers(0.15875, 0.1236, 0.0788, 0.12211, 0.12211, 0.344, 0.344, 0.1)


@pytest.mark.parametrize("kind", KINDS)
def test_stated_errors_cover_those_against_forty_digits(kind: str):
    """A hundred of the thousand of the benchmark, down to margins of 1e-12; of stops to 1e-9."""
    found = measure(kind, 100)
    assert max(each.true for each in found) > (1e-8 if kind == "stops" else 1e-6)
    assert all(each.true <= each.stated for each in found)
    assert np.median([each.stated / each.true for each in found]) < 100


@pytest.mark.parametrize("change", [-1e-13, 0.0, 1e-13])
def test_a_change_in_the_thirteenth_digit_does_not_unlock_a_brake(change: float):
    """At a margin of 0 only rounding would say whether it slides; at 1e-12 there is an answer."""
    limit = drum.shoe_torque(SHOE, friction=0.3, force=1.0).locking_friction
    assert drum.shoe_torque(SHOE, friction=limit * (1 + change), force=1.0).status == "locked"
    sliding = drum.shoe_torque(SHOE, friction=limit * (1 - 1e-12 + change), force=1.0)
    assert sliding.status == "slides" and sliding.error > 1e-5
    limit = LEVERS.locking_friction
    at, beside = (
        forklift.internal_forces(LEVERS, piston_force=1.0, friction=limit * (1 + change - margin))
        for margin in (0.0, 2e-12)
    )
    assert at.status == "locked" and np.isnan(at.error)
    assert beside.status == "equilibrium" and beside.error > 1e-5


@pytest.mark.parametrize("direction", ["reverse", "forward"])
def test_a_change_in_the_thirteenth_digit_does_not_stop_a_truck(direction: str):
    """On the steepest slope that its brakes hold, rounding would say whether it stops, in 1e12 m."""
    truck = forklift.Truck(5950.0, (1.049, 0.359), 0.0, (0.0, 0.0), 0.40, 1.89)
    (a, y), L = truck.cg, truck.wheelbase
    h = (y + truck.front_wheel_radius) * (1 if direction == "reverse" else -1)
    limit = np.arctan(0.7 * (L - a) / (L + 0.7 * h))
    beside = np.array([*np.arange(-3, 4) * 1e-13, -1e-10, 1e-10])
    rest = {"speed": 5.0, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3, "direction": direction}
    near = forklift.stop(truck, forklift.StopConditions(limit * (1 + beside), **rest))
    assert set(near.status) == {"too near to decide"} and not near.stops.any()
    assert np.isinf(near.distance).all() and len(near.messages_of_cases(9)) == 9
    sides = forklift.stop(truck, forklift.StopConditions(limit * (1 + np.array([-1e-8, 1e-8])), **rest))
    assert sides.status.tolist() == ["stops", "never stops"] and 0 < sides.error[0] < 1e-4


@pytest.mark.parametrize("digit", range(-3, 4))
def test_command_ends_alike_on_either_side_of_the_steepest_slope(digit: int, finished, tmp_path):
    text = Path("examples/forklift.toml").read_text().replace('"3500 kg"', '"0 kg"')
    limit = np.arctan(0.7 * (1.89 - 1.049) / (1.89 + 0.7 * 0.759)) * (1 + digit * 1e-13)
    file = tmp_path / "truck.toml"
    file.write_text(text.replace('"0.3019 rad"', f'"{float(limit)!r} rad"'))
    assert "too near the steepest" in " ".join(finished(main(["forklift", str(file)]), 1).err.split())


def test_commands_state_the_error_near_self_locking(finished, tmp_path):
    limit = drum.brake_torque(drum.simplex(SHOE), friction=0.3, force=1.0).locking_friction
    text = Path("examples/drum.toml").read_text().split("[second_shoe]")[0] + '[load]\nforce = "1000 N"\n'
    file, saved = tmp_path / "drum.toml", tmp_path / "found.json"
    file.write_text(text.replace("friction = 0.35", f"friction = {float(limit) * (1 - 1e-9)!r}"))
    assert "bound of the relative error" in finished(main(["drum", str(file), "--json", str(saved)]), 0).out
    assert 1e-7 < json.loads(saved.read_text())["error"] < 1e-4


def test_locked_shoe_that_is_given_a_pressure_does_not_speak_of_a_force():
    limit = drum.shoe_torque(SHOE, friction=0.3, force=1.0).locking_friction
    locked = drum.shoe_torque(SHOE, friction=2 * limit, peak_pressure=1e6)
    assert locked.status == "locked" and "from the force" not in locked.message
