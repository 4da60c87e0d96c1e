"""Resonance speeds and steady response against brute force, and what they refuse."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamdyn as bd
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.line_roots import bracket
from beamdyn.scene.motion.base import Motion, MotionSample
from beamdyn.steady.crossings import KINDS, order_by_speed
from benchmarks.cases.scenes import HARVESTER


def rolling(waves: float, amplitude: float = 0.01, **changes: object) -> bd.Scene:
    """The harvester on a road with so many waves a turn."""
    road = bd.RoadWave(wavelength=2 * math.pi * 0.3 / waves, velocity_amplitude=amplitude)
    return replace(HARVESTER, motion=bd.RollingWheel(0.3, speed=55.0, road=road), **changes)


ROLLING = rolling(2 * math.pi)
COMMENSURATE = rolling(6, 0.05)
OUTWARD = replace(ROLLING, mount=bd.Mount(0.215, math.pi))


# Brute force --------------------------------------------------------------------------------------


def modal(scene: bd.Scene, modes: int) -> Equations:
    return choose_model(scene, "ritz", np.array([60.0]), modes).modal_equations(modes)


def first_order(equations: Equations, motion: Motion, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A and b of y' = A y + b at times t, from the terms themselves."""
    root, n = equations.root(motion.at(t)), equations.size
    A, b = np.zeros((len(t), 2 * n, 2 * n)), np.zeros((len(t), 2 * n))
    A[:, :n, n:] = np.eye(n)
    A[:, n:, :n], A[:, n:, n:] = -equations.matrix(0, root), -equations.matrix(1, root)
    b[:, n:] = equations.load(root)
    return A, b


@pytest.mark.parametrize("waves", [2.0, 2 * math.pi])
def test_response_is_the_tail_of_a_damped_transient(waves: float) -> None:
    """Phase by phase, with gravity, a static load and one road that repeats each turn, one that does not."""
    mount = bd.Mount(0.215, 0.2, 0.3)
    scene = rolling(waves, mount=mount, gravity=9.81, damping_ratio=0.1)
    motion = scene.motion.with_speed(60.0)
    found, one = bd.steady_response(scene, [60.0], modes=1, tolerance=1e-10), modal(scene, 1)

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        A, b = first_order(one, motion, np.array([t]))
        return A[0] @ y + b[0]

    t = np.linspace(0.6, 0.7, 200)
    run = solve_ivp(slope, (0, 0.7), np.zeros(2), "DOP853", t, rtol=1e-10, atol=1e-14)
    tip = one.tip @ run.y[:1]
    steady = found.tip(60.0 * t, waves * 60.0 * t)[0]
    np.testing.assert_allclose(steady, tip, rtol=0, atol=1e-8 * found.amplitude[0])
    assert np.abs(tip).max() <= found.amplitude[0] * (1 + 1e-8) <= found.bound[0] * (1 + 2e-8)


def monodromy_growth(scene: bd.Scene, speed: float) -> float:
    """Rate of growth from one turn, cut into steps of a fourth-order Magnus integrator."""
    import scipy.linalg

    steps = 600
    h = 2 * math.pi / speed / steps
    nodes = (np.arange(steps)[:, None] + 0.5 + np.array([-1, 1]) * math.sqrt(3) / 6).ravel() * h
    A = first_order(modal(scene, 2), scene.motion.with_speed(speed), nodes)[0]
    first, second = A[::2], A[1::2]
    omega = h / 2 * (first + second) + math.sqrt(3) / 12 * h**2 * (second @ first - first @ second)
    turn = np.eye(A.shape[-1])
    for step in omega:
        turn = scipy.linalg.expm(step) @ turn
    return math.log(np.abs(np.linalg.eigvals(turn)).max()) * speed / (2 * math.pi)


@pytest.mark.parametrize("damping", [0.0, 2e-4])
def test_tongue_is_that_of_the_monodromy_matrix(damping: float) -> None:
    scene = replace(COMMENSURATE, damping_ratio=damping)
    centre = next(c.speed for c in bd.resonance_speeds(scene, 150.0) if c.kind == "parametric")
    speeds = centre + np.linspace(-0.1, 0.1, 13)
    found = bd.steady_response(scene, speeds, modes=2)
    expected = np.array([monodromy_growth(scene, speed) for speed in speeds])
    assert 3 <= (~found.stable).sum() <= 10
    np.testing.assert_array_equal(~found.stable, expected > 1e-6)
    np.testing.assert_allclose(found.growth_rate[~found.stable], expected[~found.stable], rtol=1e-5)


def test_enough_damping_closes_the_tongue() -> None:
    centre = next(c.speed for c in bd.resonance_speeds(COMMENSURATE, 150.0) if c.kind == "parametric")
    assert bd.steady_response(replace(COMMENSURATE, damping_ratio=0.01), [centre]).stable.all()


def test_amplitude_is_the_largest_over_a_fine_grid_of_phases() -> None:
    found = bd.steady_response(replace(ROLLING, gravity=9.81, damping_ratio=0.01), np.linspace(5, 155, 40))
    phase = np.linspace(0, 2 * math.pi, 181)
    sampled = np.abs(found.tip(phase[:, None], phase)).max(axis=(1, 2))
    assert (sampled <= found.amplitude * (1 + 1e-12)).all()
    assert (sampled >= found.amplitude * (1 - 5e-3)).all()
    assert (found.amplitude <= found.bound * (1 + 1e-12)).all()


def test_error_covers_the_neglected_harmonics() -> None:
    exact = bd.steady_response(ROLLING, [50.0, 60.0], harmonics=5)
    for kept in (1, 2, 3):
        found = bd.steady_response(ROLLING, [50.0, 60.0], harmonics=kept)
        assert (np.abs(found.amplitude - exact.amplitude) <= found.error * found.bound).all()


# Steady response ----------------------------------------------------------------------------------


def test_damping_lowers_the_peak() -> None:
    speeds = np.linspace(50, 56, 121)
    peaks = [
        bd.steady_response(replace(ROLLING, damping_ratio=ratio), speeds).amplitude.max()
        for ratio in (0.002, 0.01, 0.05)
    ]
    assert peaks[0] > 2 * peaks[1] > 4 * peaks[2]


def test_static_line_is_the_static_deflection() -> None:
    scene = replace(HARVESTER, mount=bd.Mount(0.215, 0.05))
    found = bd.steady_response(scene, [20.0, 60.0], modes=12)
    expected = bd.frequency_locus(scene, [20.0, 60.0], 1).static_deflection
    assert [line.name for line in found.lines] == ["static"]
    np.testing.assert_allclose(found.line_amplitude[:, 0].real, expected, rtol=1e-6)
    np.testing.assert_allclose(found.amplitude, np.abs(expected), rtol=1e-6)


def test_nothing_forces_the_beam() -> None:
    found = bd.steady_response(HARVESTER, [20.0, 60.0])
    assert found.amplitude.tolist() == [0.0, 0.0] and found.lines == () and found.stable.all()


def test_stretch_hardly_changes_it() -> None:
    """Coriolis coupling and stretch are of the relative order (gamma/alpha)^2 = 1e-7 here."""
    beam = HARVESTER.beam
    scene = replace(ROLLING, beam=beam, physics=bd.Physics(stretch=True), damping_ratio=0.01)
    coupled = bd.steady_response(scene, [40.0, 60.0])
    alone = bd.steady_response(replace(scene, physics=bd.Physics()), [40.0, 60.0])
    np.testing.assert_allclose(coupled.amplitude, alone.amplitude, rtol=1e-5)


def test_past_the_critical_speed() -> None:
    found = bd.steady_response(ROLLING, [100.0, 170.0])
    assert found.status.tolist() == ["stable", "past the critical speed"]
    assert np.isnan(found.amplitude[1]) and "past the critical speed" in found.warnings[0]


def test_height_given_for_a_velocity_is_noticed() -> None:
    road = bd.RoadWave(wavelength=0.3, height=0.01)
    found = bd.steady_response(replace(HARVESTER, motion=bd.RollingWheel(0.3, 55.0, road)), [55.0])
    assert any("height" in warning for warning in found.warnings)
    assert any("linear theory" in warning for warning in found.warnings)


def test_results_are_written_and_drawn(tmp_path) -> None:
    found = bd.steady_response(ROLLING, np.linspace(50, 60, 11))
    found.save(tmp_path / "steady.json")
    assert found.plot().get_yscale() == "log"
    crossings = bd.resonance_speeds(ROLLING, 150.0)
    crossings.save(tmp_path / "crossings.json")
    drawn = crossings.plot()
    labels = [text.get_text() for text in (*drawn.get_legend().get_texts(), *drawn.texts)]
    assert {"road +", "road -", "forced", "parametric", "mode 1"} <= set(labels)


# Resonance speeds ---------------------------------------------------------------------------------


def test_crossings_lie_on_line_and_locus_in_ascending_order() -> None:
    found = bd.resonance_speeds(replace(OUTWARD, gravity=9.81), 1500.0, modes=4, order=2)
    speeds = [c.speed for c in found]
    assert len(found) > 10 and speeds == sorted(speeds)
    for c in found:
        own = bd.natural_modes(OUTWARD, c.speed, 4).frequency
        wanted = (
            own[c.mode - 1] if c.kind == "forced" else own[c.mode - 1] + own[(c.second_mode or c.mode) - 1]
        )
        assert abs(wanted * 2 * math.pi / (c.line.multiple * c.speed) - 1) < 1e-10
        assert c.error < 1e-9


def test_several_crossings_on_one_line() -> None:
    scene = rolling(4 * math.pi, mount=OUTWARD.mount)
    found = bd.resonance_speeds(scene, 2000.0)
    on_line = [c.mode for c in found if c.kind == "forced" and c.line.name == "road +"]
    assert on_line == [1, 2, 3]


def test_roots_between_two_nodes_are_bracketed() -> None:
    def dips(x: float) -> float:
        return (x - 3.4) ** 2 - 1e-6

    x = np.arange(8.0)
    assert [(a < r < b) for (a, b), r in zip(bracket(dips, x, dips(x)), (3.399, 3.401), strict=True)]


@pytest.mark.parametrize("changes", [{}, {"gravity": 9.81}])
@pytest.mark.parametrize("order", [1, 2])
def test_crossings_that_are_not_listed_are_counted(changes: dict, order: int) -> None:
    scene = replace(ROLLING, **changes)
    found, more = (bd.resonance_speeds(scene, 150.0, order=n) for n in (order, order + 1))
    assert (found.order, found.unlisted) == (order, len(more) - len(found))
    assert f"{found.unlisted} crossings of order {order + 1}" in found.extent and not found.warnings
    assert {(c.kind, c.speed) for c in found} < {(c.kind, c.speed) for c in more}
    assert found.may_peak == sum(
        (c.kind == "forced") * s for s, each in ((1, more), (-1, found)) for c in each
    )
    assert (
        f"{found.may_peak} of these crossings are forced, where the steady response may have a peak"
        in found.extent
    )


@pytest.mark.parametrize(
    ("unlisted", "may_peak", "said"),
    [
        (1, 1, "this crossing is forced"),
        (3, 1, "1 of these crossings is forced"),
        (3, 2, "2 of these crossings are forced"),
    ],
)
def test_one_crossing_is_and_several_are_forced(unlisted: int, may_peak: int, said: str) -> None:
    found = replace(bd.resonance_speeds(ROLLING, 20.0), unlisted=unlisted, may_peak=may_peak)
    assert f": {said}, where" in found.extent


def test_no_crossing_says_what_was_sought() -> None:
    slow = bd.resonance_speeds(ROLLING, 20.0)
    assert len(slow) == slow.unlisted == 0
    assert slow.warnings == ("no mode meets a line of order 1 up to 20 rad/s; lines: road -, road +",)


@pytest.mark.parametrize("motion", [None, bd.SteadyRotation(50.0)])
def test_nothing_excites_the_beam(motion: Motion | None) -> None:
    found = bd.resonance_speeds(replace(HARVESTER, motion=motion), 150.0, order=3)
    name = "no motion" if motion is None else "a SteadyRotation"
    assert len(found) == found.unlisted == 0 and len(found.warnings) == 1
    assert f"the scene has {name} and gravity = 0" in found.warnings[0]


def test_a_beam_that_is_not_forced_has_parametric_crossings_only() -> None:
    flap = replace(ROLLING, mount=bd.Mount(0.215, 0.0, math.pi / 2))
    assert {c.kind for c in bd.resonance_speeds(flap, 150.0)} == {"parametric"}


def test_search_ends_at_the_critical_speed() -> None:
    found = bd.resonance_speeds(ROLLING, 1000.0)
    assert max(c.speed for c in found) < 159.82 and "critical speed" in found.warnings[0]


@pytest.mark.parametrize("radius", [0.2, 0.3, 0.35])
def test_the_search_past_the_critical_speed_finds_the_crossings_below_it(radius: float) -> None:
    """There the stiffness is 0, exactly or within rounding, and gyroscopic modes have a double root 0."""
    mount, stretched = bd.Mount(radius, 0.1, 1.2), bd.Physics(stretch=True)
    scene = replace(ROLLING, mount=mount, physics=stretched, gravity=9.81, motion=bd.RollingWheel(0.3, 55.0))
    critical = bd.critical_speed(scene)
    past, below = (
        bd.resonance_speeds(scene, v, discretization=bd.Ritz(10)) for v in (2 * critical, critical)
    )
    assert [c.kind for c in past] == ["forced", "parametric"]  # of mode 1 and the line of the rotation
    near = bd.resonance_speeds(scene, critical * (1 - 1e-6), discretization=bd.Ritz(10))
    for found in (past, below):
        for one, other in zip(found, near, strict=True):
            assert abs(one.speed - other.speed) <= (one.error + other.error) * other.speed


def test_elements_agree() -> None:
    ritz, fem = (
        bd.resonance_speeds(ROLLING, 150.0, 1, discretization=discretization)
        for discretization in ("ritz", "fem")
    )
    for a, b in zip(ritz, fem, strict=True):
        assert abs(a.speed - b.speed) < 2 * b.error * b.speed < 1e-4


# Refused ------------------------------------------------------------------------------------------


class Unknown:
    """A motion that is known in time only."""

    def at(self, t: np.ndarray) -> MotionSample:
        return MotionSample.steady(np.ones(np.shape(t)))

    def with_speed(self, speed: float) -> Unknown:
        return self


@pytest.mark.parametrize("motion", [Unknown(), bd.UserMotion(MotionSample.steady)])
def test_motion_without_a_steady_state_is_refused(motion: Motion) -> None:
    scene = replace(HARVESTER, motion=motion)
    with pytest.raises(ValueError, match="simulate it"):
        bd.resonance_speeds(scene, 100.0)
    with pytest.raises(ValueError, match="simulate it"):
        bd.steady_response(scene, [50.0])


@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan, "fast"])
def test_top_speed(value: float) -> None:
    with pytest.raises(ValueError, match="top_speed"):
        bd.resonance_speeds(ROLLING, value)


@pytest.mark.parametrize("name", ["modes", "order"])
@pytest.mark.parametrize("value", [0, -1, 1.5])
def test_counts(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=name):
        bd.resonance_speeds(ROLLING, 100.0, **{name: value})


@pytest.mark.parametrize("speeds", [[], [2.0, 1.0], [1.0, 1.0], [math.nan], [[1.0]]])
def test_speeds_ascend(speeds: list) -> None:
    with pytest.raises(ValueError, match="speeds"):
        bd.steady_response(ROLLING, speeds)


@pytest.mark.parametrize(
    "wrong", [{"tolerance": 0.0}, {"harmonics": -1}, {"modes": 0}, {"discretization": "magic"}]
)
def test_settings(wrong: dict) -> None:
    with pytest.raises(ValueError, match=next(iter(wrong))):
        bd.steady_response(ROLLING, [50.0], **wrong)


def test_modes_of_the_body_that_are_not_sought_are_named() -> None:
    """A line may meet the first mode of torsion of the strip of steel, which no beam that only bends has."""
    beam = bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(beam, bd.Mount(0.215), motion=bd.RollingWheel(0.3, 30.0, bd.RoadWave(0.1, 0.01)))
    found = [bd.resonance_speeds(scene, 120.0, modes=n) for n in (2, 3)]
    two, three = (each.left_out_effects for each in found)
    assert two.unlisted == ()
    (torsion,) = three.unlisted
    assert torsion.kind == "torsion" and np.nanmax(torsion.frequency) == pytest.approx(656, rel=0.03)
    assert "modes not listed: torsion 6" in three.sentence()
    written = found[1].to_dict()
    assert [mode["kind"] for mode in written["unlisted_modes"]] == ["torsion"]
    assert written["unlisted"] == found[1].unlisted  # crossings of the next order, a number


@pytest.mark.parametrize("change", [-3e-13, 3e-13])
def test_lines_that_rounding_sets_apart_are_one(change: float) -> None:
    """Twice the road's frequency and four times that of rotation meet where the road has two waves a turn."""
    near, exact = (
        bd.resonance_speeds(rolling(waves, gravity=9.81), 120.0, modes=1, order=2)
        for waves in (2.0 * (1 + change), 2.0)
    )
    assert [line.name for line in near.lines] == [line.name for line in exact.lines]
    assert (len(near), near.unlisted, near.may_peak) == (len(exact), exact.unlisted, exact.may_peak)


def test_crossings_at_one_speed_keep_their_order_whatever_rounding_makes_of_it() -> None:
    """Twice a frequency meets twice a line where the frequency meets the line."""
    first = bd.resonance_speeds(ROLLING, top_speed=90.0, modes=1).crossings[0]
    around = [
        replace(first, kind=kind, speed=first.speed * (1 + k * 1e-13)) for kind in KINDS for k in (2, -1)
    ]
    later = replace(first, mode=3, speed=first.speed * (1 + 1e-8))
    ordered = order_by_speed([later, *around[::-1], replace(first, mode=2)])
    assert [c.kind for c in ordered] == ["forced"] * 3 + ["parametric"] * 2 + ["forced"]
    assert [c.mode for c in ordered] == [1, 1, 2, 1, 1, 3]
    pairs = [replace(first, second_mode=k, speed=first.speed * (1 - k * 1e-13)) for k in (2, 3)]
    assert [c.second_mode for c in order_by_speed([*pairs, first])] == [None, 2, 3]
    assert order_by_speed([]) == ()


def test_a_range_of_speeds_whose_squares_underflow_has_no_crossings() -> None:
    assert bd.resonance_speeds(ROLLING, top_speed=1e-300, modes=1, order=1).crossings == ()
