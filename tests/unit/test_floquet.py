"""Motions that pulsate, periods, verdicts, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

import beamdyn as bd
from beamdyn.scene.motion.base import check_consistent
from beamdyn.studies.floquet.interpolation import interpolate_on_grid
from beamdyn.studies.floquet.monodromy import Monodromy, PeriodicScenes, period_of
from beamdyn.studies.floquet.multipliers import multipliers_of

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
PULSATING = bd.PulsatingRotation(50.0, 0.1, 20.0)
MOUNT = bd.Mount(0.215)


@pytest.mark.parametrize(
    "motion", [PULSATING, bd.ShakenCarrier(20.0, 1.0, 2.0, 3.0, rotation=bd.SpinUp(50.0, 0.1))]
)
def test_pulsating_motions_are_consistent(motion):
    check_consistent(motion, 0.3)


def test_pulsating_motions_have_no_steady_response():
    for motion in (PULSATING, bd.ShakenCarrier(20.0, 1.0)):
        with pytest.raises(ValueError, match="pulsates"):
            bd.steady_response(bd.Scene(STRIP, MOUNT, motion), [50.0], 1)


@pytest.mark.parametrize(
    ("motion", "gravity", "expected"),
    [
        (PULSATING, 0.0, 1 / 20),
        (bd.PulsatingRotation(40 * math.pi, 0.1, 30.0), 9.81, 1 / 10),  # 20 turns and 30 beats a second
        (bd.SteadyRotation(50.0), 9.81, 2 * math.pi / 50),
        (bd.RollingWheel(0.3, 10.0, bd.RoadWave(0.6 * math.pi / 2.5, 0.01)), 0.0, 4 * math.pi / 10),
        (bd.ShakenCarrier(20.0, 1.0), 9.81, 1 / 20),
    ],
)
def test_periods(motion, gravity, expected):
    found = period_of(bd.Scene(STRIP, MOUNT, motion, gravity=gravity)).time
    assert found == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(
    ("motion", "gravity", "said"),
    [
        (None, 0.0, "needs a periodic motion"),
        (bd.SteadyRotation(0.0), 0.0, "stands still"),
        (bd.SpinUp(50.0, 1.0), 0.0, "does not repeat itself"),
        (bd.PulsatingRotation(1000.0, 0.1, 0.01), 9.81, "does not cover the circle in 4096 periods"),
    ],
)
def test_motions_that_do_not_repeat_themselves_are_refused(motion, gravity, said):
    with pytest.raises(ValueError, match=said):
        bd.floquet_multipliers(bd.Scene(STRIP, MOUNT, motion, gravity=gravity))


@pytest.mark.parametrize(
    ("motion", "gravity", "said"),
    [
        (bd.PulsatingRotation(50.0, 0.1, 20.0), 9.81, r"have no common period.*the ratio 93/37,"),
        (bd.PulsatingRotation(1000.0, 0.1, 0.01), 9.81, r"have no common period.*the ratio 1/64,"),
        (bd.RollingWheel(0.3, 10.0, bd.RoadWave(0.3, 0.01)), 0.0, "have no common period"),
    ],
)
def test_a_period_is_refused_where_phases_do_not_meet(motion, gravity, said):
    with pytest.raises(ValueError, match=said):
        period_of(bd.Scene(STRIP, MOUNT, motion, gravity=gravity))


def test_large_deflection_is_refused():
    scene = bd.Scene(STRIP, MOUNT, PULSATING, physics=bd.Physics(large_deflection=True))
    with pytest.raises(ValueError, match="straight beam"):
        bd.floquet_multipliers(scene)


@pytest.mark.parametrize(
    ("vary", "said"),
    [
        ({"speed": [1.0, 2.0]}, "two numbers"),
        ({"speed": [2.0, 1.0], "motion.frequency": [1.0]}, "ascend"),
        ({"speed": [2.0], "motion.pulse": [1.0]}, "unknown input"),
        ({"speed": [2.0], "motion.duration": [1.0]}, "no such number"),
        ({"speed": np.linspace(1, 2, 3000), "motion.frequency": np.linspace(1, 2, 3000)}, "at most"),
    ],
)
def test_charts_refuse(vary, said):
    with pytest.raises(ValueError, match=said):
        bd.stability_chart(bd.Scene(STRIP, MOUNT, PULSATING), vary)


def test_charts_judge_each_scene_where_phases_meet_after_other_numbers_of_turns_or_never():
    rotation = 10 * math.pi
    motion, rates = bd.PulsatingRotation(rotation, 0.1, 10.0), [10.0, 10.0 * math.sqrt(1.5), 12.5]
    scene = bd.Scene(STRIP, MOUNT, motion, gravity=9.81, damping_ratio=0.01)
    chart = bd.stability_chart(scene, {"motion.frequency": rates, "mount.radius": [0.1, 0.2]}, 1)
    assert chart.integrated == 6
    for i, method in enumerate(("multipliers", "exponent", "multipliers")):
        given = replace(scene, mount=bd.Mount(0.2), motion=replace(motion, frequency=rates[i]))
        alone = bd.floquet_multipliers(given, 1)
        assert (alone.method, alone.status) == (method, chart.status[i, 1])
        assert alone.growth_rate == pytest.approx(chart.growth_rate[i, 1], rel=1e-9)


def test_a_chart_of_a_harvester_is_that_of_its_scenes():
    layers = bd.Harvester(1e-4, 7750.0, e31=-10.0, c11e=6e10, eps33s=1.3e-8, resistance=1e5)
    scene = bd.Scene(layers.on(STRIP), MOUNT, PULSATING, damping_ratio=0.01)
    vary = {"motion.frequency": [150.0, 160.0], "motion.fluctuation": [0.1, 0.2]}
    chart = bd.stability_chart(scene, vary, 1)
    alone = replace(scene, motion=replace(PULSATING, frequency=160.0, fluctuation=0.2))
    assert bd.floquet_multipliers(alone, 1).growth_rate == pytest.approx(chart.growth_rate[1, 1], rel=1e-9)


def test_a_beam_on_a_hinge_that_is_damped_by_its_mass_decays_at_half_of_that():
    mount = bd.Mount(0.1, math.pi, root_stiffness=0.0)
    found = bd.floquet_multipliers(bd.Scene(STRIP, mount, PULSATING, damping=bd.Damping(mass_factor=1.0)))
    assert found.status == "stable" and found.growth_rate_error < 1e-8
    assert found.growth_rate == pytest.approx(-0.5, abs=found.growth_rate_error)


def test_multipliers_of_a_beam_with_precone_are_those_of_its_modes_where_nothing_pulsates():
    mount = bd.Mount(0.1, math.pi, math.pi / 2, precone=0.3)
    scene = bd.Scene(STRIP, mount, bd.PulsatingRotation(50.0, 0.0, 20.0), damping_ratio=0.01)
    found = bd.floquet_multipliers(scene, 4)
    flat = replace(scene, mount=replace(mount, precone=0.0))
    own, other = (
        np.exp(bd.natural_modes(each, 50.0, 1).eigenvalue[0] * found.period) for each in (scene, flat)
    )
    assert np.abs(found.multipliers - own).min() < 1e-4 < np.abs(found.multipliers - other).min()


def test_a_chart_resumes_from_its_store(tmp_path, monkeypatch):
    vary = {"motion.frequency": np.linspace(15.0, 25.0, 4), "motion.fluctuation": [0.1, 0.2]}
    scene = bd.Scene(STRIP, MOUNT, PULSATING)
    chart = bd.stability_chart(scene, vary, 1, store=tmp_path / "store")
    monkeypatch.delattr(PeriodicScenes, "monodromy")  # nothing is integrated again
    again = bd.stability_chart(scene, vary, 1, store=tmp_path / "store")
    np.testing.assert_array_equal(again.growth_rate, chart.growth_rate)
    with pytest.raises(AttributeError):
        bd.stability_chart(scene, vary, 1)


def test_a_chart_has_the_physics_that_its_fastest_motion_needs():
    scene = bd.Scene(
        bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3),
        MOUNT,
        PULSATING,
        physics="auto",
    )
    vary = {"speed": [1.0, 150.0], "motion.fluctuation": [0.0, 0.1]}
    chosen = bd.stability_chart(scene, vary, 1).scene.physics_choice
    assert chosen is not None and max(chosen.speeds) > 140.0


def test_the_limit_of_a_damped_tongue_goes_round_its_tip():
    scene = bd.Scene(STRIP, MOUNT, bd.PulsatingRotation(50.0, 0.1, 124.0), damping_ratio=0.01)
    vary = {"motion.frequency": np.linspace(115.0, 131.0, 17), "motion.fluctuation": np.linspace(0.1, 0.5, 5)}
    limits = bd.stability_limits(scene, vary, 1)
    assert limits.kinds == ("principal",) and limits.error.max() <= 1e-8
    np.testing.assert_allclose(limits.place[[0, -1], 1], 0.5, rtol=1e-12)  # both branches to the border
    frequency, least = limits.place[limits.place[:, 1].argmin()]
    for amplitude, expected in ((0.999 * least, "stable"), (1.001 * least, "unstable")):
        motion = bd.PulsatingRotation(50.0, amplitude, frequency)
        assert bd.floquet_multipliers(replace(scene, motion=motion), 1).status == expected


# Verdicts -----------------------------------------------------------------------------------------

J = np.kron([[0, 1], [-1, 0]], np.eye(2))  # the form of two oscillators


def turned(first, second):
    """Monodromy matrix of two oscillators that turn by angles, the second perhaps backwards in energy."""
    c, s = np.diag(np.cos([first, second])), np.diag(np.sin([first, second]))
    return np.block([[c, s], [-s, c]])


def verdict(matrix, error=1e-10, form=J):
    found = multipliers_of(
        Monodromy(matrix[None], np.array([error]), np.ones(1), None if form is None else form[None], 1)
    )
    return found.verdict[0], found.growth[0][0]


def test_verdicts_without_damping():
    assert verdict(turned(1.0, 2.0)) == ("stable", 0.0)
    assert verdict(turned(1.0, 1.0))[0] == "stable"  # equal multipliers of one sign stay on the circle
    assert verdict(turned(1.0, -1.0))[0] == "undecided"  # those of opposite signs may leave it
    assert verdict(turned(1.0, np.pi))[0] == "undecided"  # a double multiplier -1
    assert verdict(turned(1.0, 2.0), error=2.0)[0] == "undecided"
    grown = np.diag([1.1, 1.0, 1 / 1.1, 1.0]) @ turned(0.0, 2.0)
    state, rate = verdict(grown)
    assert state == "unstable"
    assert rate == pytest.approx(math.log(1.1), rel=1e-12)  # rounding


def test_verdicts_with_damping():
    assert verdict(0.9 * turned(1.0, -1.0), form=None)[0] == "stable"
    assert verdict(1.1 * turned(1.0, 2.0), form=None)[0] == "unstable"
    assert verdict((1 - 1e-12) * turned(1.0, 2.0), form=None)[0] == "undecided"


@pytest.mark.parametrize("seed", range(8))
def test_multipliers_of_one_magnitude_are_ordered_by_angle(seed):
    """Turns by three angles, and a matrix of other digits that is similar to it."""
    rng, turns = np.random.default_rng(seed), (0.3, 1.1, 2.9)
    blocks = [[[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]] for a in turns]
    similar = np.eye(6) + 0.1 * rng.standard_normal((6, 6))
    matrix = similar @ block_diag(*blocks) @ np.linalg.inv(similar)
    found = multipliers_of(Monodromy(matrix[None], np.array([1e-14]), np.ones(1), None, 1))
    np.testing.assert_allclose(np.angle(found.value[0]), [2.9, 1.1, 0.3, -0.3, -1.1, -2.9], rtol=1e-12)


def test_errors_cover_a_jordan_block():
    """An error d of a double multiplier moves it by sqrt(d)."""
    found = multipliers_of(
        Monodromy(np.array([[[1.0, 1.0], [1e-12, 1.0]]]), np.array([1e-10]), np.ones(1), None, 1)
    )
    assert found.error[0].max() >= 0.9e-5
    assert found.error[0].max() < 1e-4


# Interpolation ------------------------------------------------------------------------------------


def test_interpolation_states_its_error():
    x, y = np.linspace(-1, 2, 150), np.linspace(0, 1, 5)

    def wave(a, b):
        return np.array([np.cos(9 * a + b), b])

    found = interpolate_on_grid(lambda pairs: [wave(*each) for each in pairs], (x, y), lambda: 1e-9, slice(1))
    exact = np.array([[wave(a, b) for b in y] for a in x])
    assert found.samples <= 65 * 5
    assert np.abs(found.value - exact).max() <= found.error + 1e-13
    assert found.error < 1e-8


def test_what_polynomials_do_not_resolve_is_taken_at_the_values():
    x = np.linspace(-1, 1, 30)
    found = interpolate_on_grid(
        lambda pairs: [np.array([abs(a) + b]) for a, b in pairs], (x, np.zeros(1)), lambda: 1e-9, slice(1)
    )
    np.testing.assert_array_equal(found.value[:, 0, 0], np.abs(x))
    assert found.error == 0


# Modes that are left out --------------------------------------------------------------------------


def test_the_error_by_modes_left_out_covers_many_modes():
    """Two modes more change the growth rate by a quarter of what all others do: they agree by chance."""
    beam = bd.Beam.rectangular(
        0.0415, 0.0039, 0.000403, 200e9, 7850.0, tip=bd.TipMass(3e-4, offset=2.5e-4, inertia=4.4e-10)
    )
    motion = bd.PulsatingRotation(98.35, 0.3549, 801.4)
    scene = bd.Scene(beam, bd.Mount(0.193, math.radians(-25.28), math.pi / 2), motion, 0.05)
    found, more, many = (bd.floquet_multipliers(scene, modes=n) for n in (2, 4, 14))
    change = abs(found.growth_rate - many.growth_rate)
    assert 3 * abs(found.growth_rate - more.growth_rate) < change <= found.mode_error


RESONATING = bd.Scene(
    bd.Beam.rectangular(0.29, 0.11, 0.0034, 200e9, 1900.0, tip=bd.TipMass(0.39)),
    bd.Mount(1.14, math.radians(150.9), math.radians(79.7)),
    bd.PulsatingRotation(299.2, 0.336, 594.3),
    0.01,
)


def test_another_verdict_with_more_modes_is_told():
    """The one mode that is kept does not resonate, the first two together do."""
    found, said = (
        bd.floquet_multipliers(RESONATING, modes=1),
        "modes the motion is unstable, with a growth rate of",
    )
    assert found.status == "stable"
    assert any(said in each for each in found.model_warnings())
    assert said in found.to_json()
    assert not any(said in each for each in bd.floquet_multipliers(RESONATING, modes=2).model_warnings())


def test_charts_tell_other_verdicts_with_more_modes():
    vary = {"motion.frequency": [560.0, 594.3], "motion.fluctuation": [0.05, 0.336]}
    few, more = (bd.stability_chart(RESONATING, vary, modes=n) for n in (1, 3))
    other = (few.status != more.status).sum()
    assert other == 2
    said = f"at {other} of 4 points the verdict is another one with 3 modes"
    assert any(said in each for each in few.model_warnings())
    assert not any("another one" in each for each in more.model_warnings())
