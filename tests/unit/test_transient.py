"""Transients: initial states, stock methods, what a run answers, and bad input."""

from __future__ import annotations

import importlib
import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.transient.step_size import TooManySteps, check_number_of_steps
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import largest_in_each
from benchmarks.cases.scenes import HARVESTER, ROLLING, SHORT_SPIN_UP
from benchmarks.stated_transient_errors import random_wave_run

STEADY = replace(HARVESTER, mount=bd.Mount(0.215, 0.02), motion=bd.SteadyRotation(50.0))


@pytest.fixture(scope="module")
def short() -> bd.Transient:
    return bd.simulate(ROLLING, 2.0, modes=2, tolerance=1e-9)


@pytest.fixture(scope="module")
def spun_up() -> bd.Transient:
    """To half of the full speed in few periods, because stock methods take many steps in each."""
    return bd.simulate(SHORT_SPIN_UP, 0.1, modes=2, tolerance=1e-9)


@pytest.fixture(scope="module")
def exact() -> bd.Transient:
    """With far more modes than are judged by it."""
    return bd.simulate(ROLLING, 3.0, modes=30, tolerance=1e-9)


def test_equilibrium_stays() -> None:
    run = bd.simulate(STEADY, 1.0, initial="equilibrium")
    static = bd.natural_modes(STEADY, 50.0).static_deflection
    assert run.tip == pytest.approx(static, rel=1e-3)  # three modes of the static deflection
    assert np.ptp(run.tip) < 1e-9 * abs(static)


@pytest.mark.parametrize(("angle", "initial"), [(0.0, "rest"), (0.3, "equilibrium")])
def test_what_does_not_move_takes_no_steps(angle: float, initial: str) -> None:
    still = replace(HARVESTER, mount=bd.Mount(0.215, angle), motion=bd.SteadyRotation(50.0))
    run = bd.simulate(still, 1e4, initial=initial)
    assert "no steps" in run.provenance.method
    assert (run.largest == 0) == (initial == "rest")
    assert np.ptp(run.tip) <= 1e-12 * run.largest  # rounding
    for moved in (
        replace(still, gravity=9.81),
        replace(still, motion=bd.SpinUp(50.0, 0.1)),
        replace(still, motion=ROLLING.motion),
    ):
        assert "no steps" not in bd.simulate(moved, 0.2, 2, 1e-3, initial=initial).provenance.method


def test_energy_is_constant_at_steady_speed() -> None:
    run = bd.simulate(STEADY, 5.0, modes=3)
    segment = run.path.segments[0]
    energy = run.energy(
        segment.start + segment.h * np.arange(0, len(segment.acceleration), 7)
    )  # ends of steps
    kinetic = (run.velocities**2).sum(axis=1).max() / 2
    assert np.ptp(energy) < 1e-10 * kinetic


def test_free_vibration_has_the_natural_frequency() -> None:
    """One mode at rest: q = cos(omega t)."""
    scene = replace(HARVESTER, motion=bd.SteadyRotation(0.0))
    run = bd.simulate(scene, 1.0, modes=1, initial=np.array([1e-6, 0.0]), tolerance=1e-10)
    omega = 2 * np.pi * bd.natural_modes(HARVESTER, 0.0).frequency[0]
    np.testing.assert_allclose(run.coordinates[:, 0], 1e-6 * np.cos(omega * run.t), atol=1e-14)


def test_damping_rings_down() -> None:
    scene = replace(HARVESTER, motion=bd.SteadyRotation(0.0), damping_ratio=0.02)
    run = bd.simulate(scene, 1.0, modes=1, initial=np.array([1e-6, 0.0]), tolerance=1e-9)
    omega = 2 * np.pi * bd.natural_modes(HARVESTER, 0.0).frequency[0]
    turned = omega * np.sqrt(1 - 0.02**2) * run.t
    exact = np.exp(-0.02 * omega * run.t) * (np.cos(turned) + 0.02 / np.sqrt(1 - 0.02**2) * np.sin(turned))
    np.testing.assert_allclose(run.coordinates[:, 0], 1e-6 * exact, atol=1e-13)


@pytest.mark.parametrize(
    "method",
    [
        "DOP853",
        "LSODA",
        bd.GaussCollocation,
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("RK45", "Radau", "BDF")),
    ],
)
def test_stock_methods_agree(method, spun_up: bd.Transient) -> None:
    loose = method in ("BDF", "RK45")
    options = {"rtol": 1e-6 if loose else 1e-8, "atol": 1e-14 if loose else 1e-15}
    run = bd.simulate(SHORT_SPIN_UP, 0.1, modes=2, method=method, **options)
    t = np.linspace(0, 0.1, 60)
    deviation = np.abs(run.deflection(t) - spun_up.deflection(t)).max()
    assert deviation < (2e-2 if loose else 1e-4) * spun_up.largest
    assert math.isnan(run.time_error)


def test_time_error_covers_the_true_one(short: bd.Transient) -> None:
    t = np.linspace(0, 2, 301)
    for tolerance in (1e-3, 1e-5):
        run = bd.simulate(ROLLING, 2.0, modes=2, tolerance=tolerance)
        true = np.abs(run.deflection(t) - short.deflection(t)).max()
        assert true <= run.time_error <= tolerance * run.largest


def test_jacobian_is_the_derivative(short: bd.Transient) -> None:
    y = np.array([1e-5, 2e-6, 1e-3, -1e-3])
    J = short.system.jacobian(1.3, y)
    columns = [short.system.rhs(1.3, y + e) - short.system.rhs(1.3, y) for e in np.eye(4)]
    np.testing.assert_allclose(J, np.array(columns).T, rtol=1e-6, atol=1e-6)


def test_shape_strain_and_tip(short: bd.Transient) -> None:
    x = np.linspace(0, 0.05, 5)
    u = short.shape(x, [0.5, 1.0])
    assert u.shape == (2, 5)
    np.testing.assert_allclose(u[:, 0], 0, atol=1e-18)
    np.testing.assert_allclose(u[:, -1], short.deflection([0.5, 1.0]))


def test_peak_between_samples_is_larger_than_the_samples(short: bd.Transient) -> None:
    dense = np.abs(short.deflection(np.linspace(1, 2, 100001))).max()
    assert short.peak(1.0, 2.0) == pytest.approx(dense, rel=1e-7)
    assert short.peak(1.0, 2.0) >= dense * (1 - 1e-14)


@pytest.mark.parametrize("w", [5.0, 40.0, 300.0])
def test_peaks_of_a_sine_and_its_values_at_the_ends_of_a_window(w: float) -> None:
    """Of the largest everywhere, and of windows that end on a slope or hold less than a step."""

    class Sine:
        start, end = 0.0, 10.0
        samples = np.linspace(0, 10, 8001), np.sin(w * np.linspace(0, 10, 8001))[:, None], np.empty(0)

        def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return np.sin(w * t)[:, None], np.empty(0)

    rise = 0.5 * np.pi / w
    windows = [(0.0, 10.0), (0.0, 0.7 * rise), (1.3 * rise, 1.5 * rise), (0.3 * rise, 0.30001 * rise)]
    found = largest_in_each(lambda q: np.abs(q[:, 0]), Sine(), windows)
    wanted = [1.0, np.sin(0.35 * np.pi), np.sin(0.65 * np.pi), np.sin(0.150005 * np.pi)]
    np.testing.assert_allclose(found, wanted, rtol=1e-12)  # a parabola over 1e-3 rad errs by less


def test_peaks_where_samples_are_dense_beside_long_steps() -> None:
    """A fast sine is found between its samples though others are two hundred times as far apart."""
    w, t = 200.0, np.concatenate([np.linspace(0, 1, 501)[:-1], np.linspace(1, 21, 51)])

    class Sine:
        start, end, samples = 0.0, 21.0, (t, np.where(t < 1, np.sin(w * t), 0.0)[:, None], np.empty(0))

        def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            return np.where(t < 1, np.sin(w * t), 0.0)[:, None], np.empty(0)

    (found,) = largest_in_each(lambda q: np.abs(q[:, 0]), Sine(), [(0.0, 21.0)])
    assert found == pytest.approx(1.0, rel=1e-10)  # a parabola over 1e-3 rad errs by less


def test_windows_searched_together_are_those_searched_alone(short: bd.Transient) -> None:
    windows = [(0.0, 2.0), (0.3, 0.31), (1.0, 1.0 + 1e-9), (1.5, 2.0)]  # the third is between two samples
    assert isinstance(short.system, ModalSystem)
    tip = short.path.projected(short.system.tips)
    together = largest_in_each(lambda q: np.abs(q[:, 0]), tip, windows)
    assert together == pytest.approx([short.peak(*window) for window in windows], rel=1e-12)  # rounding


def test_full_finite_elements_equal_their_modes() -> None:
    scene = replace(ROLLING, motion=ROLLING.motion.with_speed(30.0))
    full = bd.simulate(scene, 0.5, modes=None, discretization=bd.Fem(6))
    some = bd.simulate(scene, 0.5, modes=6, discretization=bd.Fem(6))
    t = np.linspace(0, 0.5, 50)
    assert np.abs(full.deflection(t) - some.deflection(t)).max() < 1e-3 * some.largest


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: bd.simulate(ROLLING, 0.0), ["t_end", "0"]),
        (lambda: bd.simulate(ROLLING, -1.0), ["t_end", "-1"]),
        (lambda: bd.simulate(ROLLING, math.nan), ["t_end"]),
        (lambda: bd.simulate(HARVESTER, 1.0), ["motion"]),
        (lambda: bd.simulate(ROLLING, 1.0, modes=0), ["modes"]),
        (lambda: bd.simulate(ROLLING, 1.0, tolerance=0.0), ["tolerance"]),
        (lambda: bd.simulate(ROLLING, 1.0, tolerance=1e-14), ["tolerance", "1e-12"]),
        (lambda: bd.simulate(ROLLING, 1e8), ["t_end", "steps", "steady"]),
        (lambda: bd.simulate(ROLLING, 1.0, initial="hot"), ["initial", "rest"]),
        (lambda: bd.simulate(ROLLING, 1.0, modes=3, initial=np.zeros(3)), ["initial", "6"]),
        (lambda: bd.simulate(ROLLING, 1.0, initial=np.zeros(4)), ["initial", "number of its modes"]),
        (lambda: bd.simulate(ROLLING, 1.0, t_eval=[0.0, 2.0]), ["t_eval"]),
        (lambda: bd.simulate(ROLLING, 1.0, t_eval=[0.5, 0.1]), ["t_eval", "ascend"]),
        (
            lambda: bd.simulate(replace(ROLLING, motion=ROLLING.motion.with_speed(170.0)), 12.0),
            ["critical", "159.8", "t ="],
        ),
        (
            lambda: bd.simulate(replace(HARVESTER, motion=bd.SampledRotation((0.0, 1.0), (0.0, 9.0))), 2.0),
            ["1", "2"],
        ),
        (lambda: bd.simulate(ROLLING, 1.0, method="Euler"), ["method", "Euler"]),
    ],
)
def test_bad_input(call, words) -> None:
    with pytest.raises(ValueError) as caught:
        call()
    assert all(word in str(caught.value) for word in words)


def test_windows_and_times_outside_the_run(short: bd.Transient) -> None:
    for window in ((1.0, 3.0), (-1.0, 1.0), (1.0, 1.0), (1.5, 1.0), (math.nan, 1.0)):
        with pytest.raises(ValueError, match=r"window|start"):
            short.peak(*window)
    with pytest.raises(ValueError, match="run"):
        short.at([2.5])


@pytest.mark.parametrize("times", ["x", 1j, [True], [True, 0.5], None, [[0.1, 0.2]], [0.1, math.nan]])
@pytest.mark.parametrize("ask", ["at", "deflection", "energy", "root_strain"])
def test_times_that_are_none_are_refused_by_name(short: bd.Transient, ask: str, times) -> None:
    with pytest.raises(ValueError, match=r"^t(\[|:| =)") as caught:
        getattr(short, ask)(times)
    assert "give a" in str(caught.value) or "must be finite" in str(caught.value)


def test_a_run_beyond_memory_names_two_numbers_that_differ() -> None:
    with pytest.raises(TooManySteps) as caught:
        check_number_of_steps(3_100_000, 2, 30.0)
    assert "3.1e+06 steps" in str(caught.value) and "3e+06 of 2 coordinates" in str(caught.value)


@pytest.mark.parametrize("modes", [1, 3, 5])
def test_what_the_modes_left_out_is_covered_and_not_far_off(modes, exact: bd.Transient) -> None:
    run = bd.simulate(ROLLING, 3.0, modes=modes, tolerance=1e-8)
    true = np.abs(run.tip - exact.deflection(run.t)).max()
    assert true <= run.mode_error * run.largest <= 10 * true


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_modes_are_chosen_for_the_tolerance(tolerance, exact: bd.Transient) -> None:
    run = bd.simulate(ROLLING, 3.0, tolerance=tolerance)
    true = np.abs(run.tip - exact.deflection(run.t)).max()
    assert true <= run.time_error + run.mode_error * run.largest <= 2 * tolerance * run.largest
    assert "rad/s" in run.provenance.method


def test_one_mode_fewer_than_chosen_would_miss_the_tolerance() -> None:
    run = bd.simulate(ROLLING, 3.0, tolerance=1e-6)
    basis = run.request.basis
    assert basis.modes is not None
    assert basis.modes > 2
    assert run.mode_error <= 1e-6
    fewer = replace(run.request, basis=replace(basis, modes=basis.modes - 1)).run()
    assert fewer.mode_error > 1e-6


@pytest.mark.slow
def test_modes_chosen_serve_a_stock_integrator_and_times_too() -> None:
    t = np.linspace(0, 0.02, 11)
    ours, stock = (bd.simulate(ROLLING, 0.02, method=m, t_eval=t, tolerance=1e-6) for m in ("auto", "DOP853"))
    assert ours.coordinates.shape == stock.coordinates.shape
    # The stock method holds its tolerance in each step only.
    np.testing.assert_allclose(stock.tip, ours.tip, rtol=0, atol=1e-4 * ours.largest)


def test_initial_coordinates_are_those_of_the_refined_model_too() -> None:
    start = np.array([1e-6, -2e-6, 0.0, 1e-4])
    run = bd.simulate(ROLLING, 0.1, modes=2, initial=start)
    assert run.refined is not None
    np.testing.assert_allclose(run.refined.coordinates[0], [1e-6, -2e-6, 0, 0], rtol=0, atol=1e-20)
    np.testing.assert_allclose(run.refined.velocities[0], [0, 1e-4, 0, 0], rtol=0, atol=1e-17)


@pytest.mark.slow
def test_modes_left_out_of_the_largest_model_are_not_known() -> None:
    run = bd.simulate(ROLLING, 0.01, modes=None, discretization=bd.Fem(100))
    assert run.mode_error == np.inf


@pytest.mark.slow
def test_modes_that_cannot_meet_the_tolerance_are_named_after_seconds() -> None:
    """A blow excites all modes: the truncation error falls with the square of their number only."""
    blow = replace(HARVESTER, mount=bd.Mount(0.215, 0.3), motion=bd.SpinUp(50.0, 1e-9))
    run = bd.simulate(blow, 0.1)
    assert 1e-5 < run.mode_error < 1e-2
    missed = [w for w in run.warnings if "tolerance = 1e-05 is not reached" in w]
    assert len(missed) == 1
    assert all(words in missed[0] for words in (f"{run.mode_error:.1g}", "smoother motion"))
    largest = run.refined  # of all that were integrated; 42 modes would have taken a hundred times the time
    assert largest is not None
    assert len(largest.t) / 8 * largest.system.size**2 <= 5 * 5e6


def test_a_run_that_does_not_fit_into_memory_is_refused(monkeypatch) -> None:
    monkeypatch.setattr("beamdyn.transient.integration._propagate", None)  # not to be called
    with pytest.raises(
        ValueError, match=r"t_end = 100000 s: it takes about [\d.]+e\+06 steps.*50 coordinates"
    ):
        bd.simulate(STEADY, 1e5, modes=50, tolerance=0.1)


def test_a_beam_that_its_weight_buckles_is_refused() -> None:
    rope = bd.Beam.rectangular(10.0, 0.02, 0.01, 5e9, 1200.0)  # hangs over: its weight is far past buckling
    scene = bd.Scene(rope, bd.Mount(0.3, np.pi), bd.SteadyRotation(0.01), gravity=9.81)
    with pytest.raises(ArithmeticError, match="grows without bound"):
        bd.simulate(scene, 300.0, modes=2)


def test_a_wheel_leaves_the_road_only_where_there_is_one() -> None:
    shaken = bd.ShakenCarrier(frequency=20.0, along_n2=30.0, rotation=50.0)
    rough = bd.RollingWheel(0.3, 50.0, bd.RoadWave(0.3, velocity_amplitude=0.1))
    said = (bd.simulate(replace(ROLLING, motion=m), 0.1, modes=1).warnings for m in (shaken, rough))
    assert ["leaves the road" in " ".join(each) for each in said] == [False, True]


@pytest.mark.slow
def test_time_error_sees_what_the_series_for_a_modulated_beam_leaves_out() -> None:
    """Against DOP853, which shares no code: also where interpolation between few steps is most of it."""
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    road = bd.RoadWave(wavelength=0.3, height=1e-3)
    scene = bd.Scene(beam, bd.Mount(0.215), bd.RollingWheel(0.2, bd.SteadyRotation(66.0), road))
    t, runs = np.linspace(0, 0.5, 2001), [bd.simulate(scene, 0.5, 1, 10.0**-k) for k in (3, 5, 7, 9)]
    exact = bd.simulate(scene, 0.5, 1, method="DOP853", t_eval=t, rtol=3e-13, atol=1e-13 * runs[-1].largest)
    for run in runs:
        true = np.abs(run.deflection(t) - exact.tip).max()
        assert true <= run.time_error + 1e-10 * run.largest  # DOP853's own
        assert run.time_error <= run.request.tolerance * run.largest


@pytest.mark.slow
def test_tolerance_below_rounding_ends() -> None:
    """Finer steps only add rounding there: the run ends with the error that it has, and says it."""
    run = bd.simulate(ROLLING, 10.0, 5, tolerance=1e-12)
    t = np.linspace(0, 10, 501)
    finer = bd.simulate(ROLLING, 10.0, 5, tolerance=1e-10)
    assert 1e-12 < run.time_error / run.largest < 1e-9
    assert any("1e-12 is not reached" in w and "time-integration error" in w for w in run.warnings)
    assert len(run.path.samples[0]) < 3e6
    assert np.abs(run.deflection(t) - finer.deflection(t)).max() <= run.time_error + finer.time_error


def test_an_option_that_does_not_exist_is_refused() -> None:
    with pytest.raises(TypeError, match="no option tolerence"):
        bd.simulate(ROLLING, 1.0, tolerence=1e-9)


def test_a_tolerance_that_cannot_be_met_does_not_make_the_answer_worse(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """More accurate steps leave less work for modes; a small limit of the work shows that in a second."""
    for limit in ("_MOST_WORK", "_SLOW_WORK"):
        monkeypatch.setattr(importlib.import_module("beamdyn.transient.simulate"), limit, 1e5)
    sudden = replace(HARVESTER, motion=bd.SpinUp(50.0, duration=1e-4), damping_ratio=0.005)
    usual, tight = (bd.simulate(sudden, 0.05, tolerance=tolerance) for tolerance in (1e-5, 1e-9))
    assert tight.mode_error <= usual.mode_error and "not reached" in " ".join(tight.warnings)


def test_a_motion_beyond_all_bounds_is_refused_where_it_gets_there():
    """It was followed on, in finer and finer steps, until these no longer fitted into memory: 20 s."""
    stiff = bd.Beam.rectangular(0.12, 0.01, 0.0025, 20e9, 1900.0)
    scene = bd.Scene(stiff, bd.Mount(0.25), bd.RollingWheel(0.3, bd.SteadyRotation(80.0)), 0.05, 1e9)
    with pytest.raises(ArithmeticError, match=r"grows without bound, to states past 1e\+50 before t = 0\.04"):
        bd.simulate(scene, t_end=1.0)


def test_modes_at_two_speeds_are_taken_where_they_converge_faster() -> None:
    """Two of them are farther off than four at rest, of which 28 would not do; four of them do."""
    run = bd.simulate(**random_wave_run(np.random.default_rng([7, 22])))
    assert not run.request.basis.is_at_rest and (run.request.basis.modes or 0) < 7
    assert run.mode_error < 1e-5 and not [said for said in run.warnings if "not reached" in said]
