"""Steady response and resonance speeds of beams that bend in two directions."""

from __future__ import annotations

import math
from dataclasses import replace
from io import StringIO
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from matplotlib.figure import Figure
from numpy.polynomial import Polynomial
from rich.console import Console
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion.base import Motion
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import periodic_system
from beamdyn.steady.stability import growth_rate

TWO = bd.Physics(planes=2)
PHASE = np.linspace(0, 2 * math.pi, 61)
GRID = PHASE[:, None], PHASE


def rolling(waves: float, amplitude: float = 0.01) -> bd.RollingWheel:
    """A wheel on a road with so many waves a turn."""
    road = bd.RoadWave(wavelength=2 * math.pi * 0.3 / waves, velocity_amplitude=amplitude)
    return bd.RollingWheel(0.3, speed=60.0, road=road)


def strip(width: float = 0.0004, **changes: Any) -> bd.Beam:
    """A steel strip, twice as wide as it is thick, so that both planes matter."""
    return bd.Beam.rectangular(0.05, width, 0.0002, 200e9, 7850.0, **changes)


FLAT = bd.Scene(strip(), bd.Mount(0.215, math.pi), rolling(2 * math.pi), 0.02, 9.81, TWO)
TWISTED = replace(FLAT, beam=strip(twist=Polynomial([0.0, 0.8])), mount=bd.Mount(0.215, math.pi - 0.2, 0.3))


def stiff_way(scene: bd.Scene) -> bd.Beam:
    """The beam in one plane that bends as the scene's does across."""
    assert scene.beam.second_bending_stiffness is not None
    return bd.Beam.from_stiffness(0.05, scene.beam.mass_per_length, scene.beam.second_bending_stiffness)


def tips(found: bd.SteadyResponse) -> np.ndarray:
    """Tip deflection in both directions over the phases, shape (2, S, ...)."""
    return np.array([found.tip(*GRID, direction=direction) for direction in (0, 1)])


# One plane after the other ------------------------------------------------------------------------


@pytest.mark.parametrize("psi", [0.0, math.pi / 2])
def test_planes_without_twist_are_two_beams_in_one_plane(psi: float) -> None:
    mount = bd.Mount(0.215, math.pi - 0.2, psi)
    scene = replace(FLAT, mount=mount)
    across = stiff_way(scene)
    alone = [
        replace(scene, physics=bd.Physics()),
        replace(
            scene, physics=bd.Physics(), beam=across, mount=replace(mount, bending_angle=psi + math.pi / 2)
        ),
    ]
    settings: dict[str, Any] = {
        "speeds": [40.0, 70.0],
        "modes": 2,
        "harmonics": 2,
        "discretization": bd.Ritz(14),
    }
    found, parts = (
        bd.steady_response(scene, **settings),
        [bd.steady_response(each, **settings) for each in alone],
    )
    expected = np.array([part.tip(*GRID) for part in parts])
    np.testing.assert_allclose(tips(found), expected, rtol=0, atol=1e-12 * found.bound.max())
    lengths = np.hypot(*expected).max(axis=(1, 2))
    assert (lengths <= found.amplitude * (1 + 1e-12)).all() and (found.amplitude <= 1.02 * lengths).all()
    for direction, part in enumerate(parts):
        np.testing.assert_allclose(found.largest_tip(direction), part.amplitude, rtol=1e-10, atol=1e-25)
    # Both start at the harmonics of their own loads, so that the rates of free motion are the same, too.
    rates = np.max([part.growth_rate for part in parts], axis=0)
    np.testing.assert_allclose(found.growth_rate, rates, rtol=1e-9)


def test_a_constant_twist_of_a_quarter_turn_exchanges_the_stiffnesses() -> None:
    """Twist t at the bending angle psi is the untwisted section at psi + t; here by a quarter turn."""
    beam = strip()
    turned = replace(TWISTED, beam=strip(twist=Polynomial([math.pi / 2])))
    exchanged = replace(
        TWISTED,
        beam=replace(stiff_way(TWISTED), second_bending_stiffness=beam.bending_stiffness),
    )
    twisted, plain = (
        bd.steady_response(s, [40.0, 70.0], modes=3, harmonics=2, discretization=bd.Ritz(14))
        for s in (turned, exchanged)
    )
    np.testing.assert_allclose(tips(twisted), tips(plain), rtol=0, atol=1e-10 * plain.bound.max())
    np.testing.assert_allclose(twisted.amplitude, plain.amplitude, rtol=1e-9)


def test_a_constant_twist_is_a_change_of_the_bending_angle() -> None:
    """The vector is the same; its components are those along other axes."""
    tau, mount = 0.5, TWISTED.mount
    twisted = replace(TWISTED, beam=strip(twist=Polynomial([tau])))
    turned = replace(TWISTED, beam=strip(), mount=replace(mount, bending_angle=mount.bending_angle + tau))
    found, expected = (
        bd.steady_response(s, [40.0, 70.0], modes=3, harmonics=2, discretization=bd.Ritz(14))
        for s in (twisted, turned)
    )
    turn = np.array([[math.cos(tau), -math.sin(tau)], [math.sin(tau), math.cos(tau)]])
    rotated = np.einsum("ab,bsij->asij", turn, tips(expected))
    np.testing.assert_allclose(tips(found), rotated, rtol=0, atol=1e-10 * expected.bound.max())
    np.testing.assert_allclose(found.amplitude, expected.amplitude, rtol=1e-9)
    np.testing.assert_allclose(found.bound, expected.bound, rtol=1e-9)


# Brute force --------------------------------------------------------------------------------------


def first_order(equations: Equations, motion: Motion, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A and b of y' = A y + b at times t, from the terms one by one, about unit masses."""
    root, n = equations.root(motion.at(t)), equations.size
    matrices, load = np.zeros((3, len(t), n, n)), np.zeros((len(t), n))
    for term in equations.terms:
        place = matrices[term.order][:, equations.blocks[term.rows], equations.blocks[term.columns]]
        place += term.factor * getattr(root, term.quantity)[:, None, None] * term.matrix
    for each in equations.loads:
        load[:, equations.blocks[each.rows]] += (
            each.factor * getattr(root, each.quantity)[:, None] * each.vector
        )
    K, C, M = matrices
    A, b = np.zeros((len(t), 2 * n, 2 * n)), np.zeros((len(t), 2 * n))
    A[:, :n, n:] = np.eye(n)
    A[:, n:, :n], A[:, n:, n:] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    b[:, n:] = np.linalg.solve(M, load[..., None])[..., 0]
    return A, b


@pytest.mark.slow
def test_twisted_response_is_the_tail_of_a_damped_transient() -> None:
    """Both components, phase by phase, on a road that does not repeat with the turns."""
    scene, speed = replace(TWISTED, mount=bd.Mount(0.215, math.pi - 0.2, 0.8), damping_ratio=0.1), 60.0
    found = bd.steady_response(scene, [speed], modes=2, tolerance=1e-9)
    two = choose_model(scene, "ritz", np.array([speed]), 2).modal_equations(2)

    assert scene.motion is not None
    motion = scene.motion.with_speed(speed)

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        A, b = first_order(two, motion, np.array([t]))
        return A[0] @ y + b[0]

    t = np.linspace(0.6, 0.7, 200)
    run = solve_ivp(slope, (0, 0.7), np.zeros(4), "DOP853", t, rtol=1e-9, atol=1e-13)
    for direction in (0, 1):
        steady = found.tip(speed * t, 2 * math.pi * speed * t, direction)[0]
        expected = two.tips[direction] @ run.y[:2]
        np.testing.assert_allclose(steady, expected, rtol=0, atol=1e-7 * found.amplitude[0])
        assert np.abs(expected).max() > 0.1 * found.amplitude[0]
    lengths = np.hypot(*(two.tips @ run.y[:2]))
    assert lengths.max() <= found.amplitude[0] * (1 + 1e-7) <= found.bound[0] * (1 + 2e-7)


def monodromy_growth(equations: Equations, motion: Motion, speed: float) -> float:
    """Growth rate from one turn, cut into steps of a fourth-order Magnus integrator."""
    steps = 600
    h = 2 * math.pi / speed / steps
    nodes = (np.arange(steps)[:, None] + 0.5 + np.array([-1, 1]) * math.sqrt(3) / 6).ravel() * h
    A = first_order(equations, motion.with_speed(speed), nodes)[0]
    first, second = A[::2], A[1::2]
    omega = h / 2 * (first + second) + math.sqrt(3) / 12 * h**2 * (second @ first - first @ second)
    turn = np.eye(A.shape[-1])
    for step in scipy.linalg.expm(omega):
        turn = step @ turn
    return math.log(np.abs(np.linalg.eigvals(turn)).max()) * speed / (2 * math.pi)


def test_tongues_of_both_planes_and_between_them() -> None:
    """A twisted strip on a road of four waves a turn, at parametric and combination resonances."""
    mount, wheel = bd.Mount(0.02, math.pi - 0.2, 0.3), rolling(4, 1.0)
    scene = replace(TWISTED, mount=mount, motion=wheel, damping_ratio=0.0, gravity=0.0)
    crossings = bd.resonance_speeds(scene, 450.0, modes=2, order=2)
    first = [c for c in crossings if c.kind == "parametric" and c.line.name == "road +"]
    kinds = {(c.mode, c.second_mode): c.speed for c in first}
    equations = Model(scene, bd.Ritz(14)).modal_equations(2)
    for pair, least in (((1, None), 6.0), ((2, None), 6.0), ((1, 2), 0.1)):
        speeds = kinds[pair] * np.linspace(0.999, 1.001, 17)
        rates, errors = growth_rate(periodic_system(equations, wheel, speeds))
        fastest = rates.argmax()
        expected = monodromy_growth(equations, wheel, float(speeds[fastest]))
        assert rates[fastest] > least  # the combination's tongue is narrower than the others
        # 1e-6: the error of the integrator with 600 steps a turn
        assert abs(rates[fastest] - expected) < errors[fastest] + 1e-6 * expected


def test_the_plane_that_grows_decides_where_nothing_couples_the_two() -> None:
    scene = replace(
        FLAT, mount=bd.Mount(0.02, math.pi), motion=rolling(4, 1.0), damping_ratio=0.0, gravity=0.0
    )
    crossings = bd.resonance_speeds(scene, 450.0, modes=2)
    tongues = [c for c in crossings if c.kind == "parametric" and c.line.name == "road +"]
    assert [int(np.argmax(c.plane_share)) for c in tongues] == [0, 1]
    out = replace(
        scene, physics=bd.Physics(), beam=stiff_way(scene), mount=bd.Mount(0.02, math.pi, math.pi / 2)
    )
    for c in tongues:
        alone = out if np.argmax(c.plane_share) else replace(scene, physics=bd.Physics())
        found, expected = (
            bd.steady_response(s, [c.speed], modes=2, harmonics=1, discretization=bd.Ritz(14))
            for s in (scene, alone)
        )
        assert found.status[0] == "parametric instability" and np.isnan(found.amplitude[0])
        np.testing.assert_allclose(found.growth_rate, expected.growth_rate, rtol=1e-9)


# Crossings ----------------------------------------------------------------------------------------


def test_crossings_are_those_of_lines_with_natural_frequencies() -> None:
    found = bd.resonance_speeds(TWISTED, 200.0, modes=2)
    undamped = replace(TWISTED, damping_ratio=0.0, motion=None)
    forced = [c for c in found if c.kind == "forced"]
    assert {c.mode for c in forced} == {1, 2}
    for c in forced:

        def detuning(speed: float, c: bd.Crossing = c) -> float:
            modes = bd.natural_modes(undamped, speed, 2)
            return float(2 * math.pi * modes.frequency[c.mode - 1] - c.line.multiple * speed)

        speed = brentq(detuning, 0.99 * c.speed, 1.01 * c.speed, xtol=1e-9)
        assert abs(speed - c.speed) < 1e-9 * c.speed
        share = bd.natural_modes(undamped, c.speed, 2).plane_share[c.mode - 1]
        np.testing.assert_allclose(c.plane_share, share, rtol=0, atol=1e-8)


def test_a_line_meets_only_the_modes_that_it_drives() -> None:
    """Gravity and road act in the plane of rotation; out of it, they vary the tension only."""
    for psi, driven in ((0.0, 0), (math.pi / 2, 1)):
        scene = replace(FLAT, mount=bd.Mount(0.215, math.pi, psi))
        found = bd.resonance_speeds(scene, 300.0, modes=2, order=2)
        assert {int(np.argmax(c.plane_share)) for c in found if c.kind == "forced"} == {driven}
        assert {int(np.argmax(c.plane_share)) for c in found if c.kind == "parametric"} == {0, 1}
        assert all(c.second_mode is None for c in found)  # no combination of planes that nothing couples


def test_planes_without_twist_have_the_crossings_of_both() -> None:
    found = bd.resonance_speeds(FLAT, 400.0, modes=2)
    across = stiff_way(FLAT)
    alone = [
        replace(FLAT, physics=bd.Physics()),
        replace(FLAT, physics=bd.Physics(), beam=across, mount=bd.Mount(0.215, math.pi, math.pi / 2)),
    ]
    expected = sorted(c.speed for scene in alone for c in bd.resonance_speeds(scene, 400.0, modes=1))
    np.testing.assert_allclose([c.speed for c in found], expected, rtol=1e-11)


def test_a_hinge_that_turns_with_the_rotation_is_no_crossing() -> None:
    """Out of the plane, with the root on the axis, its frequency is the speed."""
    mount = bd.Mount(0.0, math.pi, math.pi / 2, root_stiffness=0.0)
    scene = bd.Scene(strip(), mount, bd.SteadyRotation(1.0), gravity=9.81)
    found = bd.resonance_speeds(scene, 50.0, 1, order=2, discretization=bd.Ritz(10))
    assert not len(found) and "mode 1 and the line 2 rotation (parametric) resonate" in found.warnings[0]


def test_a_hinged_beam_that_the_slightest_rotation_turns_over_is_refused() -> None:
    scene = replace(FLAT, mount=bd.Mount(0.215, 0.0, 0.0, root_stiffness=0.0))
    with pytest.raises(ValueError, match="root_stiffness = 0 N m/rad: the beam is unstable at any speed"):
        bd.resonance_speeds(scene, 50.0, 1, discretization=bd.Ritz(10))


def test_the_hinge_in_the_plane_of_rotation_is_named() -> None:
    """The one that turns over; not one of a plane that is not modelled, and no spring that there is not."""
    for bending, hinges, name in (
        (0.0, (0.0, math.inf), "root_stiffness"),
        (math.pi / 2, (0.0, 0.0), "second_root_stiffness"),
        (math.pi / 2, (math.inf, 0.0), "second_root_stiffness"),
    ):
        scene = replace(FLAT, mount=bd.Mount(0.215, 0.0, bending, *hinges))
        with pytest.raises(InvalidValue) as refusal:
            bd.resonance_speeds(scene, 50.0, 1, discretization=bd.Ritz(10))
        assert (refusal.value.field, refusal.value.value) == (f"mount.{name}", 0.0)


def test_resonances_by_elements_on_soft_springs() -> None:
    def found(stiffness: float, discretization: Any) -> bd.Crossings:
        mount = bd.Mount(1.0, root_stiffness=stiffness, second_root_stiffness=0.0)
        scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), mount, bd.SteadyRotation(1.0), gravity=9.81)
        return bd.resonance_speeds(scene, 10.0, 2, discretization=discretization)

    for stiffness in (1e-9, 1e-13):
        by_elements, exact = found(stiffness, "fem"), found(stiffness, "ritz")
        speeds = [c.speed for c in exact]
        assert [c.speed for c in by_elements] == pytest.approx(speeds, rel=1e-9) and len(exact) == 2
    by_elements, exact = found(1e-17, "fem"), found(1e-17, "ritz")
    assert [c.speed for c in by_elements] == [c.speed for c in exact] and len(exact) == 2
    assert by_elements.warnings[0].startswith("finite elements do not resolve the springs")


def test_the_response_of_a_damped_hinge_needs_no_large_basis_at_rest() -> None:
    """At rest the turn has the frequency 0 exactly, whatever the basis: the first that is tried is taken."""
    beam = bd.Beam.rectangular(1.0, 0.06, 0.03, 70e9, 2700.0)
    mount = bd.Mount(0.3, math.pi, root_stiffness=0.0)
    found = bd.steady_response(bd.Scene(beam, mount, damping_ratio=0.02, gravity=9.81), [0.0, 20.0])
    assert found.status.tolist() == ["turns freely about the root", "stable"]
    assert found.request.model.equations.size <= 40


@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_a_hinged_beam_that_turns_freely_has_no_steady_response(damping: float) -> None:
    """At rest nothing holds it; under rotation, outward, the tension does."""
    mount = bd.Mount(0.215, math.pi, root_stiffness=0.0)
    scene = replace(FLAT, mount=mount, damping_ratio=damping)
    found = bd.steady_response(scene, [0.0, 60.0], modes=2, harmonics=1, discretization=bd.Ritz(10))
    assert found.status.tolist() == ["turns freely about the root", "stable"]
    assert np.isnan(found.amplitude).tolist() == [True, False]
    assert found.warnings[0].startswith("turns freely about the root at 1 speed, 0 rad/s")


# Results ------------------------------------------------------------------------------------------


def test_largest_vector_is_that_of_a_fine_grid() -> None:
    rng = np.random.default_rng(3)
    harmonics = np.array([(0, 0), (1, 0), (0, 1), (1, 1), (2, -1)])
    a = rng.normal(size=(20, 2, 5)) + 1j * rng.normal(size=(20, 2, 5))
    phase = 2 * math.pi * np.arange(400) / 400
    waves = np.exp(1j * (harmonics[:, 0, None, None] * phase[:, None] + harmonics[:, 1, None, None] * phase))
    sampled = np.hypot(*np.einsum("sdh,hij->dsij", a, waves).real).max(axis=(1, 2))
    found = largest_over_phases(a, harmonics)
    assert (sampled <= found * (1 + 1e-12)).all() and (found <= sampled * (1 + 1e-3)).all()


def test_bound_of_one_line_is_its_amplitude() -> None:
    """Of an ellipse the longer semi-axis: that of one line at a time is reached."""
    found = bd.steady_response(replace(TWISTED, gravity=0.0), [60.0], modes=2, harmonics=0)
    for line in range(len(found.lines)):
        a = np.array([found.line_amplitude[:, line], found.line_amplitude_across[:, line]])
        vector = np.real(a[..., None] * np.exp(1j * np.linspace(0, math.pi, 2001)))
        single = np.hypot(*vector).max()
        assert largest_over_phases(np.swapaxes(a, 0, 1)[..., None], np.array([[1, 0]]))[0] == pytest.approx(
            single, rel=1e-6
        )
    assert (found.amplitude <= found.bound).all()


def test_static_vector_is_the_static_deflection() -> None:
    scene = bd.Scene(TWISTED.beam, TWISTED.mount, physics=TWO)
    found = bd.steady_response(scene, [20.0, 60.0], modes=14)
    expected = bd.frequency_locus(scene, [20.0, 60.0], 1).static_deflection
    np.testing.assert_allclose(found.amplitude, expected, rtol=1e-5)
    assert (np.abs(found.line_amplitude_across) > 0).all()


def test_csv_has_both_directions() -> None:
    found = bd.steady_response(TWISTED, [60.0], modes=2, harmonics=1)
    heads, row = rows_of(found)
    assert dict(zip(heads, row, strict=True))["largest_across_m"] == found.largest_tip(1)[0]
    one = bd.steady_response(replace(TWISTED, physics=bd.Physics()), [60.0], modes=2, harmonics=1)
    assert "largest_across_m" not in next(iter(rows_of(one)))
    heads, *rows = rows_of(bd.resonance_speeds(FLAT, 400.0, modes=2))
    across = {row[heads.index("mode")]: row[heads.index("share_across")] for row in rows}
    assert across == {1: 0.0, 2: pytest.approx(1.0, abs=1e-12)}


def printed(part: Any) -> str:
    """As it is printed at the width of a pipe."""
    console = Console(width=120, record=True, file=StringIO(), markup=False)
    console.print(part)
    return console.export_text()


@pytest.mark.parametrize(
    ("angle", "words", "names"),
    [
        (0.0, ("edge", "flap"), ("in the plane of rotation (edge)", "out of the plane of rotation (flap)")),
        (0.3, ("bending", "across"), ("in the direction of bending", "across the direction of bending")),
    ],
)
def test_one_set_of_words(angle: float, words: tuple[str, str], names: tuple[str, str]) -> None:
    """Tables, plots and CSV heads name the two directions alike; no table is cut."""
    scene = replace(TWISTED, mount=replace(TWISTED.mount, bending_angle=angle))
    steady = bd.steady_response(scene, [10 / 3, 60.0], modes=2, harmonics=1)
    sweep = bd.sweep(scene, [10 / 3, 60.0], (0.0, 0.02), modes=2)
    tables = printed(tables_of(steady)), printed(tables_of(sweep))
    for text in tables:
        assert all(f"{word} [mm]" in text for word in words) and "…" not in text
        assert "largest tip deflection [mm]" in text and "status" in text
    crossings = bd.resonance_speeds(scene, 400.0, modes=2)
    assert f"{words[0]}, {words[1]} [%]" in printed(tables_of(crossings))
    legend = steady.plot(Figure().subplots()).get_legend()
    assert legend is not None
    labels = [text.get_text() for text in legend.get_texts()]
    assert [label for label in labels if label in names] == [*names]
    heads = [list(next(iter(rows))) for rows in (rows_of(steady), rows_of(sweep), rows_of(crossings))]
    for row, name in zip(heads, ("largest_{}_m", "largest_{}_m", "share_{}"), strict=True):
        assert all(name.format(direction) in row for direction in ("bending", "across"))
    run = rows_of(bd.simulate(scene, 0.01, 2))
    tips = "tip_deflection_bending_m", "tip_deflection_across_m"
    assert next(iter(run)) == ["time_s", *tips, "model_error_of_largest"]


@pytest.mark.parametrize("direction", [-1, 2, "across"])
def test_direction_of_the_tip(direction: Any) -> None:
    found = bd.steady_response(TWISTED, [60.0], modes=1, harmonics=0)
    with pytest.raises(ValueError, match="direction = "):
        found.tip(PHASE, 0.0, direction)


# Modes left out -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("twist", "width", "angle"), [(1.4, 0.1, 1.4), (1.0, 0.05, 1.1), (0.4, 0.05, 1.0), (1.2, 0.1, -1.4)]
)
def test_stated_errors_cover_the_modes_left_out_beside_a_heavy_tip_body(twist, width, angle):
    """Modes 5 and 6 do little, 7 to 9 much; what all of them together do is known from static responses."""
    tip = bd.TipMass(4 * 27 * width)  # four times the mass of the blade
    twisted = Polynomial([0.0, twist])
    blade = bd.Beam.rectangular(1.0, width, 0.01, 70e9, 2700.0, tip=tip, twist=twisted)
    mount = bd.Mount(0.5, setting_angle=math.pi, bending_angle=angle)
    physics, motion = bd.Physics(planes=2), bd.SteadyRotation(6.0)
    scene = bd.Scene(blade, mount, motion, gravity=9.81, damping_ratio=0.02, physics=physics)
    few, many, auto = (bd.steady_response(scene, [6.0], modes) for modes in (4, 12, "auto"))
    true = abs(few.amplitude[0] - many.amplitude[0]) / few.bound[0]
    assert true <= few.mode_error[0] <= 3 * true
    stated = auto.mode_error[0] + many.mode_error[0]
    assert abs(auto.amplitude[0] - many.amplitude[0]) <= stated * many.bound[0]
    assert (auto.request.basis.modes, auto.mode_error[0] < 1e-6) == (2, True)
