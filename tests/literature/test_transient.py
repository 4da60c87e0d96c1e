"""Published transients: Table 3 of Lee and Yoo, and the spin-up of an outward beam."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.scenes import BLADE_SPIN_UP, ROLLING

TABLE_3 = {1: 1.947177e-3, 2: 1.946482e-3, 3: 1.943300e-3, 4: 1.942770e-3, 5: 1.942558e-3, 6: 1.942509e-3}


@pytest.mark.parametrize("modes", TABLE_3)
def test_table_3_with_one_to_six_modes(modes: int) -> None:
    run = bd.simulate(ROLLING, 30.0, modes, tolerance=1e-6)
    assert run.peak(20.0, 30.0) == pytest.approx(TABLE_3[modes], abs=0.5e-9 + run.time_error)


def test_table_3_at_the_default_tolerance() -> None:
    run = bd.simulate(ROLLING, 30.0, modes=5)
    assert run.peak(20.0, 30.0) == pytest.approx(1.942558e-3, rel=3e-5)
    assert run.time_error < 1e-5 * run.largest
    assert round(run.peak(20.0, 30.0), 5) == 0.00194  # as printed
    assert run.largest == pytest.approx(2.0731e-3, abs=0.5e-7)
    assert abs(run.deflection([29.650])[0]) > 0.97 * run.peak(20.0, 30.0)  # the time has three decimals


def test_finite_elements_confirm_table_3() -> None:
    run = bd.simulate(ROLLING, 30.0, modes=5, discretization="fem")
    assert run.peak(20.0, 30.0) == pytest.approx(1.942558e-3, rel=1e-4)


def test_spin_up_of_an_outward_beam() -> None:
    """Largest deflection +0.57437 m at 6.762 s; printed with a minus: the papers turn the other way."""
    run = bd.simulate(BLADE_SPIN_UP, 20.0, modes=8)
    assert run.largest == pytest.approx(0.57437, abs=0.5e-5)
    assert run.deflection([6.762])[0] == pytest.approx(0.57437, abs=0.5e-5)


def test_the_same_with_stretch() -> None:
    run = bd.simulate(replace(BLADE_SPIN_UP, physics=bd.Physics(stretch=True)), 20.0, modes=8)
    assert run.largest == pytest.approx(0.57440, abs=0.5e-5)


@pytest.mark.parametrize("change, printed", [({"law": "linear"}, 1.51e-3)])
def test_the_answer_is_sensitive_to_the_spin_up_law(change: dict, printed: float) -> None:
    """It is the ring-down of the passage through resonance: a linear ramp gives 1.51 mm."""
    motion = replace(ROLLING.motion, speed=bd.SpinUp(55.0, duration=10.0, **change))
    run = bd.simulate(replace(ROLLING, motion=motion), 30.0, modes=5, tolerance=1e-3)
    assert run.peak(20.0, 30.0) == pytest.approx(printed, abs=0.5e-5)


def test_read_as_a_height_the_road_throws_the_beam_about() -> None:
    road = bd.RoadWave(wavelength=0.3, height=0.01)
    motion = replace(ROLLING.motion, road=road)
    run = bd.simulate(replace(ROLLING, motion=motion), 30.0, modes=5)
    assert run.largest > 10 * 0.05
    assert any("linear theory" in w for w in run.warnings) and any("height" in w for w in run.warnings)


def test_steps_between_samples_do_not_matter() -> None:
    coarse = bd.simulate(ROLLING, 30.0, 5, t_eval=np.linspace(0, 30, 31))
    assert len(coarse.t) == 31
    assert coarse.peak(20.0, 30.0) == pytest.approx(1.942558e-3, rel=3e-5)
