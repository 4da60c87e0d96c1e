"""A stop by one brake is limited by the grip of the tyre and by pitching over, or says what is not known."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from brakes.calipers import Stance, stop
from brakes.cli import main

G = 9.80665
RIDER = {"mass": 80.0, "speed": 8.0, "friction": 0.4}
TOURER = Stance("front", tyre_friction=0.8, wheelbase=1.067, cg_height=1.143, cg_behind_front=0.635)
RECUMBENT = Stance("front", tyre_friction=0.8, wheelbase=1.6, cg_height=0.6, cg_behind_front=0.9)


def balance(stance: Stance, inertia: float, radius: float) -> tuple[float, float]:
    """Decelerations at slip and at lift-off from the free body of the vehicle and its wheels.

    Unknowns: both normal forces, the braked tyre's force, and the deceleration; the wheels, all of them
    slowed down by the braked tyre, turn with it.
    """
    m, length, h, x = 80.0, stance.wheelbase, stance.cg_height, stance.cg_behind_front
    slips = (
        [0, -stance.tyre_friction, 1, 0]
        if stance.braked_wheel == "rear"
        else [-stance.tyre_friction, 0, 1, 0]
    )
    lifts = [0, 1, 0, 0]
    found = []
    for last in (slips, lifts):
        rows = [
            [1, 1, 0, 0],  # vertical
            [0, 0, 1, -(m + inertia / radius**2)],  # horizontal, wheels included
            [0, length, 0, m * h + inertia / radius],  # moments about the front contact
            last,
        ]
        found.append(np.linalg.solve(np.array(rows, float), [m * G, 0, m * G * x, 0])[3])
    return found[0], found[1]


@pytest.mark.parametrize("wheel", ["front", "rear"])
@pytest.mark.parametrize("stance", [TOURER, RECUMBENT])
@pytest.mark.parametrize("inertia", [0.0, 0.25])
def test_limits_against_the_free_body(stance: Stance, wheel: str, inertia: float) -> None:
    stance = dataclasses.replace(stance, braked_wheel=wheel)
    found = stop(pad_force=1e4, wheel_inertia=inertia, tyre_radius=0.34, stance=stance, **RIDER)
    grip, pitch = balance(stance, inertia, 0.34)
    assert found.pitch_limit == pytest.approx(pitch, rel=1e-13)
    if math.isfinite(found.grip_limit):
        assert found.grip_limit == pytest.approx(grip, rel=1e-13)
    limit = min(found.grip_limit, pitch)
    assert found.deceleration == pytest.approx(limit, rel=1e-13)
    assert found.distance == pytest.approx(8.0**2 / (2 * limit), rel=1e-13)
    assert found.limited_by == ("grip" if found.grip_limit < pitch else "pitching over")


def test_an_upright_bicycle_pitches_over_at_0_56_g() -> None:
    """x / h = 0.635 / 1.143; a recumbent's front tyre slips first."""
    found = stop(pad_force=1000.0, stance=TOURER, **RIDER)
    assert found.pitch_limit / G == pytest.approx(0.635 / 1.143, rel=1e-14)
    assert found.limited_by == "pitching over" and "the rear wheel lifts at 0.556 g" in found.message
    assert stop(pad_force=1000.0, stance=RECUMBENT, **RIDER).limited_by == "grip"


def test_a_weak_brake_is_its_own_limit() -> None:
    weak, free = stop(pad_force=200.0, stance=TOURER, **RIDER), stop(pad_force=200.0, **RIDER)
    assert weak.limited_by == free.limited_by == "brake"
    assert weak.distance == free.distance
    assert weak.message == f"stops in {weak.distance:.6g} m"


def test_the_force_at_the_limit_stops_as_quickly() -> None:
    hard = stop(pad_force=5000.0, stance=TOURER, **RIDER)
    just = stop(pad_force=hard.pad_limit, stance=TOURER, **RIDER)
    assert just.distance == hard.distance and just.limited_by == "brake"


def test_a_force_that_grows_past_the_limit_is_held_there() -> None:
    """F = k s up to F_l at s_l = F_l / k, then F_l: E = 2 mu (F_l s_l / 2 + F_l (s - s_l)), from k s0 on."""
    limit = stop(pad_force=1.0, stance=TOURER, **RIDER).pad_limit
    slope, first = 300.0, 50.0
    turn = (limit - first) / slope
    used = 2 * 0.4 * (first * turn + slope * turn**2 / 2)
    by_hand = turn + (80.0 * 8.0**2 / 2 - used) / (2 * 0.4 * limit)
    found = stop(pad_force=lambda s: first + slope * s, stance=TOURER, **RIDER)
    assert found.distance == pytest.approx(by_hand, rel=1e-9)  # the integration meets the kink
    assert found.limited_by == "pitching over"


def test_a_stop_without_a_stance_is_that_of_a_usual_bicycle() -> None:
    """80 kg on 1.02 m, 1.10 m high and 0.62 m behind the front hub: it pitches over at 0.563636364 g."""
    found = stop(pad_force=1000.0, **RIDER)
    assert found.limited_by == "pitching over"
    assert found.pitch_limit / G == pytest.approx(0.563636364, abs=5e-10)  # digits of the reference
    rear = stop(pad_force=1000.0, stance=Stance(braked_wheel="rear"), **RIDER)
    assert rear.limited_by == "grip" and rear.grip_limit / G == pytest.approx(0.261052632, abs=5e-10)
    assert stop(pad_force=1.0, **RIDER).grip_limit / G == pytest.approx(2.2857, abs=5e-5)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"wheelbase": 0.6}, ["cg_behind_front = 0.62 m", "0.6 m"]),
        ({"cg_height": 1.1, "cg_behind_front": 1.2, "wheelbase": 1.0}, ["cg_behind_front = 1.2 m", "1 m"]),
        ({"braked_wheel": "left"}, ["'front'", "'rear'"]),
        ({"cg_height": 0.0, "cg_behind_front": 0.5}, ["cg_height = 0 m"]),
        (dataclasses.asdict(TOURER) | {"tyre_friction": 50.0}, ["tyre_friction = 50: it must be at most 2"]),
    ],
)
def test_incomplete_stances_are_refused(given, words) -> None:
    with pytest.raises(ValueError) as refusal:
        Stance(**given)
    assert all(word in str(refusal.value) for word in words), str(refusal.value)


STOP = """
caliper = "v-brake"
[dimensions]
lever_ratio = 2.2
[run]
finger = "150 N"
[stop]
mass = "80 kg"
speed = "30 km/h"
friction = 0.4
"""


def answer(capsys, tmp_path: Path, text: str) -> tuple[int, str]:
    path = tmp_path / "m.toml"
    path.write_text(text)
    code = main(["caliper", str(path)])
    captured = capsys.readouterr()
    return code, " ".join((captured.out + captured.err).split())


def test_a_file_gives_the_limits(capsys, tmp_path) -> None:
    lengths = 'wheelbase = "1067 mm"\ncg_height = "1143 mm"\ncg_behind_front = "635 mm"\n'
    code, text = answer(capsys, tmp_path, STOP + lengths + "tyre_friction = 0.8\n")
    assert code == 0 and "limited by pitching over: the rear wheel lifts at 0.556 g" in text
    code, text = answer(capsys, tmp_path, STOP + lengths + 'tyre_friction = 0.8\nbraked_wheel = "rear"\n')
    assert code == 0 and "limited by grip: the rear tyre slips" in text
    assert "a usual bicycle" not in text


def test_a_file_that_gives_no_stance_has_that_of_a_usual_bicycle(capsys, tmp_path) -> None:
    code, text = answer(capsys, tmp_path, STOP)
    assert code == 0 and "limited by pitching over: the rear wheel lifts at 0.564 g" in text
    assert "does not give them: tyre_friction 0.8, wheelbase 1.02 m, cg_height 1.1 m" in text


@pytest.mark.parametrize(("force", "said"), [("180 N", "kept"), ("181 N", "exceeded")])
def test_the_hand_has_its_limit(capsys, tmp_path, force, said) -> None:
    code, text = answer(capsys, tmp_path, STOP.replace("150 N", force))
    assert code == 0 and f"allows 180 N for a hand on a bicycle's lever: {said}." in text
    assert ("warning: hand, force of 181 N" in text) == (said == "exceeded")
