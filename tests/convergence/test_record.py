"""Motions given by many samples: the steps follow the tolerance, over several samples where it allows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from beamdyn.transient import record_steps, step_size
from beamdyn.transient.gauss import tableau
from beamdyn.transient.record_steps import RecordSteps, propagate_record
from beamdyn.transient.step_size import StepSize
from beamdyn.transient.system import ModalSystem
from benchmarks.cases.scenes import HARVESTER

TILTED = replace(HARVESTER, mount=bd.Mount(0.215, 0.3))
TIMES = np.arange(201) / 1000  # 1 kHz
END = float(TIMES[-1])


def speed(t: np.ndarray) -> np.ndarray:
    """A spin-up that begins and ends smoothly, with some ripple."""
    x = t / END
    return 50 * x**2 * (3 - 2 * x) + 0.2 * np.sin(40 * t) ** 2


def noisy(size: float, times: np.ndarray = TIMES) -> np.ndarray:
    return speed(times) + size * np.random.default_rng(1).standard_normal(len(times))


def spiked() -> np.ndarray:
    values = speed(TIMES)
    values[133] += 0.3
    return values


IRREGULAR = np.concatenate([[0.0], np.sort(np.random.default_rng(2).uniform(0, END, 120)), [END]])
RECORDS = {
    "smooth": bd.SampledRotation(TIMES, speed(TIMES)),
    "noisy": bd.SampledRotation(TIMES, noisy(0.01)),
    "kinks": bd.SampledRotation(TIMES, noisy(0.001), "pchip"),
    "one wrong sample": bd.SampledRotation(TIMES, spiked()),
    "irregular": bd.SampledRotation(IRREGULAR, noisy(1e-4, IRREGULAR)),
}


def scene(record: bd.SampledRotation, **options) -> bd.Scene:
    wheel = bd.RollingWheel(0.3, record, bd.RoadWave(0.3, velocity_amplitude=0.01))
    return replace(TILTED, motion=wheel if options else record, **options)


def count_steps(run: bd.Transient) -> int:
    return sum(len(segment.acceleration) for segment in run.path.segments)


@pytest.mark.parametrize("name", RECORDS)
def test_errors_follow_the_tolerance(name: str, monkeypatch) -> None:
    """Against steps that end at every sample, at a tight tolerance."""
    options = {"gravity": 9.81, "damping_ratio": 0.02} if name in ("noisy", "irregular") else {}
    made, t = scene(RECORDS[name], **options), np.linspace(0, END, 4001)
    runs = [bd.simulate(made, END, 2, tolerance) for tolerance in (1e-2, 1e-3, 1e-5, 1e-7)]
    monkeypatch.setattr(record_steps, "is_record", lambda *arguments: False)
    monkeypatch.setattr(step_size, "_PARTS", 1)
    exact = bd.simulate(made, END, 2, 1e-8)
    for run, tolerance in zip(runs, (1e-2, 1e-3, 1e-5, 1e-7), strict=True):
        true = np.abs(run.deflection(t) - exact.deflection(t)).max()
        assert true <= run.time_error + exact.time_error
        assert run.time_error <= tolerance * run.largest
    assert count_steps(runs[0]) <= count_steps(runs[-1])


def test_a_smooth_record_takes_the_steps_of_its_motion_not_of_its_samples() -> None:
    """At most three times the steps that the function takes from which the samples are."""
    law = Polynomial([0, 0, 150 / END**2, -100 / END**3])
    function = bd.RotationFunction(law.integ(), law, law.deriv(), END)
    record = bd.SampledRotation(TIMES, law(TIMES))
    for tolerance in (1e-3, 1e-5):
        one, other = (bd.simulate(replace(TILTED, motion=m), END, 1, tolerance) for m in (record, function))
        assert count_steps(one) <= 3 * count_steps(other) <= len(TIMES) / 2
        assert abs(one.largest - other.largest) <= one.time_error + other.time_error


def test_a_record_against_an_integrator_that_shares_no_code() -> None:
    run = bd.simulate(scene(RECORDS["noisy"]), 0.1, 1, 1e-3)
    assert count_steps(run) < 50  # of 100 samples
    options = {"rtol": 1e-9, "max_step": 1e-3, "t_eval": np.linspace(0, 0.1, 301)}
    exact = bd.simulate(scene(RECORDS["noisy"]), 0.1, 1, method="DOP853", **options)
    assert np.abs(run.deflection(exact.t) - exact.tip).max() <= run.time_error + 1e-6 * run.largest


def system_of(motion: bd.SampledRotation, modes: int = 1) -> ModalSystem:
    return ModalSystem(Model(TILTED, bd.Ritz(14)).modal_equations(modes), motion)


def test_polynomials_of_low_degree_are_kept_over_several_samples() -> None:
    law = Polynomial([1.0, -30.0, 200.0, 100.0])  # which a cubic spline reproduces, and whose square is kept
    system = system_of(bd.SampledRotation(IRREGULAR, law(IRREGULAR)))
    steps, table = RecordSteps.choose(system, END, StepSize(3.0)), tableau(8)
    assert steps.counts.max() > 3
    t = steps.start[:, None] + steps.h[:, None] * table.c
    root = steps.root(system, table)
    np.testing.assert_allclose(root.speed, law(t), rtol=0, atol=1e-10)
    np.testing.assert_allclose(root.acceleration, law.deriv()(t), rtol=0, atol=1e-8)
    np.testing.assert_allclose(root.speed_squared, law(t) ** 2, rtol=0, atol=1e-9)


def test_the_mean_acceleration_of_a_step_is_the_speed_gained() -> None:
    record = RECORDS["noisy"]
    system = system_of(record)
    steps, table = RecordSteps.choose(system, END, StepSize(5.0)), tableau(8)
    assert steps.counts.max() > 5
    gained = record.at(steps.start + steps.h).speed - record.at(steps.start).speed
    mean = steps.root(system, table).acceleration @ table.b
    np.testing.assert_allclose(mean * steps.h, gained, rtol=0, atol=1e-11)


@pytest.mark.parametrize("name", ["kinks", "noisy"])
def test_ends_of_steps_over_several_samples_converge_with_the_order_of_the_stages(name: str) -> None:
    """The polynomials of degree 7 leave out what the response over a step, but for h^8, does not feel."""
    system, zero = system_of(RECORDS[name]), np.zeros(1)
    sizes = END / 16 / np.array([1, 2, 3, 12])
    ends = [
        propagate_record(system, RecordSteps.choose(system, END, FixedSteps(h)), zero, zero, 8, 1e-15).state[
            -1, 1:
        ]
        for h in sizes
    ]
    errors = [np.abs(end / ends[-1] - 1).max() for end in ends[:-1]]
    assert np.polyfit(np.log(sizes[:-1]), np.log(errors), 1)[0] > 6.5


class FixedSteps:
    """Steps of one length, whatever the motion."""

    def __init__(self, h: float) -> None:
        self.h = h

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        return max(1, round((end - start) / self.h))


def test_a_sweep_of_a_record_is_its_transients() -> None:
    made = replace(TILTED, motion=RECORDS["noisy"])
    found = bd.sweep(made, [20.0, 60.0], (0.1, END), modes=2, tolerance=1e-4)
    for v, peak, error in zip(found.speeds, found.peaks, found.time_error, strict=True):
        run = bd.simulate(replace(made, motion=made.motion.with_speed(v)), END, 2, 1e-7)
        assert abs(run.peak(0.1, END) - peak) <= error + run.time_error
        assert error <= 1e-4 * run.largest


def test_long_pieces_are_divided() -> None:
    """Few samples, fast motion: as many steps within a piece as the tolerance needs."""
    times = np.linspace(0, END, 21)
    record = bd.SampledRotation(times, speed(times))
    run = bd.simulate(replace(TILTED, motion=record), END, 2, 1e-6)
    exact = bd.simulate(replace(TILTED, motion=record), END, 2, 1e-10)
    t = np.linspace(0, END, 4001)
    assert np.abs(run.deflection(t) - exact.deflection(t)).max() <= run.time_error + exact.time_error
    assert run.time_error <= 1e-6 * run.largest


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6])
def test_expanded_maps_of_equal_steps_are_those_solved_one_by_one(accuracy: float, monkeypatch) -> None:
    """Within the accuracy that their series is given, over the largest coordinate."""
    system, zero = system_of(RECORDS["noisy"], 2), np.zeros(2)
    steps = RecordSteps.choose(system, END, FixedSteps(1.1e-3))
    assert len(steps) == len(TIMES) - 1 and len(steps.blocks) == 1
    expanded = propagate_record(system, steps, zero, zero, 8, accuracy)
    monkeypatch.setattr(record_steps, "_expand", lambda *arguments: False)
    solved = propagate_record(system, steps, zero, zero, 8, accuracy)
    for one, other in ((expanded.state[:, 1:3], solved.state[:, 1:3]), (expanded.state, solved.state)):
        assert not np.array_equal(one, other)  # they were found in another way
        np.testing.assert_allclose(one, other, rtol=0, atol=accuracy * np.abs(other).max())


DRIFTING = np.cumsum((1 + 9e-7) ** np.arange(513)) - 1  # each step longer than the last by less than 1e-6
UNEQUAL = np.cumsum(1 + 0.3 * np.random.default_rng(3).random(301))
FINE = np.arange(1001.0)  # five samples a step


@pytest.mark.parametrize("places", [DRIFTING, UNEQUAL, FINE], ids=["drifting", "unequal", "fine"])
def test_steps_that_are_not_on_an_equal_grid_are_solved_one_by_one(places: np.ndarray, monkeypatch) -> None:
    """Expanded maps are of equal steps between two samples; to the bit, as the same code is to run."""
    times = (places - places[0]) * END / (places[-1] - places[0])
    system, zero = system_of(bd.SampledRotation(times, noisy(1e-3, times)), 2), np.zeros(2)
    h = END / 200 if places is FINE else 1.5 * END / len(places)
    steps = RecordSteps.choose(system, END, FixedSteps(h))
    assert len(steps) >= 128  # enough to be expanded
    found = propagate_record(system, steps, zero, zero, 8, 1e-3)
    monkeypatch.setattr(record_steps, "_expand", lambda *arguments: False)
    solved = propagate_record(system, steps, zero, zero, 8, 1e-3)
    np.testing.assert_array_equal(found.state, solved.state)


def test_many_samples_at_unequal_times_keep_the_tolerance() -> None:
    """At nearly steady speed, where equal steps would be expanded; in no more steps than samples."""
    rng = np.random.default_rng(3)
    times = 1e-3 * np.cumsum(1 + 0.3 * rng.random(1001))
    times -= times[0]
    values = 30 + 0.2 * np.sin(40 * times) ** 2 + 0.01 * rng.standard_normal(len(times))
    made, end = scene(bd.SampledRotation(times, values)), float(times[-1])
    run, exact = (bd.simulate(made, end, 2, tolerance) for tolerance in (1e-3, 1e-8))
    t = np.linspace(0, end, 4001)
    assert np.abs(run.deflection(t) - exact.deflection(t)).max() <= run.time_error + exact.time_error
    assert run.time_error <= 1e-3 * run.largest and count_steps(run) < len(times)


def test_a_jump_takes_one_step_between_samples_not_tiny_ones() -> None:
    """Samples resolve the jump; steps between them have no kinks inside, whatever modes the jump excites."""
    values = np.where(TIMES > END / 2, 10.0, 5.0)
    run = bd.simulate(scene(bd.SampledRotation(TIMES, values, "pchip")), END, 5, 1e-2)
    assert count_steps(run) <= len(TIMES) - 1
    exact = bd.simulate(scene(bd.SampledRotation(TIMES, values, "pchip")), END, 5, 1e-6)
    t = np.linspace(0, END, 4001)
    assert np.abs(run.deflection(t) - exact.deflection(t)).max() <= run.time_error + exact.time_error
