"""`simulate` and `sweep` with large deflection: results, starts, sweeps, refusals and files."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.modes.modal.model import ModalBasis, Model, reduce_to_modes
from benchmarks.cases.scenes import HARVESTER, SHORT_SPIN_UP

ELASTICA = bd.Physics(large_deflection=True)
TILTED = replace(HARVESTER, physics=ELASTICA, mount=bd.Mount(0.215, math.radians(88.35985)))
STEADY = replace(TILTED, motion=bd.SteadyRotation(100.0))


@pytest.fixture(scope="module")
def run() -> bd.Transient:
    return bd.simulate(STEADY, 0.02, 3)


def test_result_has_the_outputs_of_a_linear_run(run: bd.Transient) -> None:
    assert run.tip.shape == run.tip_across.shape == run.t.shape
    assert not run.tip_across.any()
    assert run.peak(0.0, 0.02) == run.peak(0.0, 0.02, direction=0) == pytest.approx(run.largest)
    assert run.peak(0.0, 0.02, direction=1) == 0
    assert run.deflection(run.t) == pytest.approx(run.tip, abs=1e-14)
    assert run.coordinates.shape == run.velocities.shape == (len(run.t), 3)


def test_shape_bends_without_stretching(run: bd.Transient) -> None:
    """No point lies further off the axis than along the beam from the root; the root stays."""
    x = np.linspace(0, 0.05, 11)
    shape = run.shape(x, [0.01, 0.02])
    assert shape.shape == (2, 11)
    assert np.abs(shape[:, 0]).max() < 1e-15  # rounding
    assert (np.abs(np.diff(shape, axis=1)) <= 0.005).all()
    assert not run.shape(x, [0.01], direction=1).any()


def test_no_warning_of_linear_theory_past_a_tenth_of_the_length(run: bd.Transient) -> None:
    assert run.largest > 0.3 * 0.05
    (searle,) = run.warnings  # no other says so
    assert "Searle's parameter" in searle


def test_a_stored_run_reads_the_same(run: bd.Transient, tmp_path: Path) -> None:
    run.save(tmp_path / "run.zip")
    loaded = bd.load(tmp_path / "run.zip")
    assert isinstance(loaded, bd.Transient)
    assert (loaded.tip == run.tip).all()


def test_more_modes_change_the_tip_by_no_more_than_the_mode_error(run: bd.Transient) -> None:
    assert run.refined is not None
    assert run.distance_from(bd.simulate(STEADY, 0.02, 8)) <= run.mode_error * run.largest < 0.1 * run.largest


def test_start_in_equilibrium_stays_there() -> None:
    """Printed to ten digits: tip at -0.3546564296 L; five modes at rest show four of them."""
    still = bd.simulate(STEADY, 0.1, 5, initial="equilibrium")
    assert still.tip == pytest.approx(-0.3546564296 * 0.05, rel=1e-4)
    assert still.time_error == 0


@pytest.mark.parametrize("bending_angle", [0.0, math.pi / 2])
def test_start_on_the_bent_branch_stays_there(bending_angle: float) -> None:
    """Where `equilibrium` has it; eight modes at rest show four digits of its tip."""
    mount = bd.Mount(0.215, 0.0, bending_angle)
    scene = replace(HARVESTER, physics=bd.Physics(large_deflection=True, branch="bent"), mount=mount)
    expected = bd.equilibrium(scene, 200.0).tip @ [0, math.cos(bending_angle), math.sin(bending_angle)]
    still = bd.simulate(replace(scene, motion=bd.SteadyRotation(200.0)), 0.01, 8, initial="equilibrium")
    assert abs(expected) > 0.3 * 0.05  # the straight branch has 0
    assert still.tip == pytest.approx(expected, rel=1e-4)
    assert still.time_error == 0


@pytest.mark.parametrize(
    ("motion", "why"), [(bd.SpinUp(200.0, 1.0), "rotate"), (bd.SteadyRotation(90.0), "90")]
)
def test_refuses_to_start_on_a_branch_that_does_not_exist(motion: bd.Motion, why: str) -> None:
    physics = bd.Physics(large_deflection=True, branch="bent")
    scene = replace(HARVESTER, physics=physics, mount=bd.Mount(0.215, 0.0), motion=motion)
    with pytest.raises(InvalidValue, match=f"initial.*{why}"):
        bd.simulate(scene, 0.01, 3, initial="equilibrium")


def test_equilibrium_holds_gravity_too() -> None:
    """A soft cantilever sags: 0.1 s later it is where it was, as nothing else acts on it."""
    scene = replace(HARVESTER, gravity=981.0, motion=bd.SteadyRotation(0.0), physics=ELASTICA)
    still = bd.simulate(scene, 0.1, 3, initial="equilibrium")
    assert abs(still.tip[0]) > 0.003 * 0.05
    assert still.tip == pytest.approx(still.tip[0], rel=1e-10)


def test_a_beam_under_a_load_that_varies_does_not_stay_in_equilibrium() -> None:
    """In the beam's axes gravity turns 256 times in the run, which evenly spaced times may not see."""
    speed = bd.SteadyRotation(64 * 2 * math.pi)
    scene = replace(HARVESTER, mount=bd.Mount(0.05, math.pi), gravity=9.81, motion=speed, physics=ELASTICA)
    run = bd.simulate(scene, 4.0, 1, tolerance=1e-3, initial="equilibrium")
    assert np.ptp(run.tip) > 1e-5 * 0.05


def test_bends_on_past_the_critical_speed_of_the_straight_beam() -> None:
    scene = replace(HARVESTER, mount=bd.Mount(0.215, 0.05), motion=bd.SpinUp(180.0, duration=0.05))
    with pytest.raises(ValueError, match="critical speed"):
        bd.simulate(scene, 0.06, 2)
    run = bd.simulate(replace(scene, physics=ELASTICA), 0.06, 2)
    assert 0 < run.largest < 0.05


def test_methods_of_solve_ivp_integrate_it_as_well() -> None:
    run, other = (bd.simulate(STEADY, 0.003, 2, method=method) for method in ("auto", "Radau"))
    assert run.distance_from(other) < 1e-3 * run.largest  # the tolerance of each of its steps is 1e-5


def test_sweep_gives_the_peaks_of_transients() -> None:
    scene = replace(SHORT_SPIN_UP, physics=ELASTICA)
    swept = bd.sweep(scene, [40.0, 50.0], window=(0.2, 0.25), modes=2)
    assert swept.status == ("done", "done")
    assert scene.motion is not None
    single = bd.simulate(replace(scene, motion=scene.motion.with_speed(50.0)), 0.25, 2)
    assert swept.peaks[1] == single.peak(0.2, 0.25)


def test_refuses_the_root_strain(run: bd.Transient) -> None:
    with pytest.raises(InvalidValue, match="large_deflection"):
        run.root_strain([0.01])


def test_refuses_an_integrator_of_linear_equations() -> None:
    with pytest.raises(InvalidValue, match="method"):
        bd.simulate(STEADY, 0.02, 3, method=bd.GaussCollocation)


IN_SPACE = bd.Physics(planes=2, rotary_inertia=True, torsion=True, large_deflection=True)


@pytest.mark.slow
@pytest.mark.parametrize(("physics", "bending_angle"), [(ELASTICA, 0.0), (IN_SPACE, 0.5)])
def test_finite_elements_move_as_polynomials_do(physics: bd.Physics, bending_angle: float) -> None:
    """Their coordinates differ from nodal values; modes taken for those moved the tip by a tenth."""
    mount = bd.Mount(0.215, math.pi / 4, bending_angle)
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    moved = bd.Scene(beam, mount, bd.SpinUp(80.0, 0.05), gravity=9.81, physics=physics)
    t = np.linspace(0, 0.05, 6)
    elements, basis = (
        bd.simulate(moved, 0.05, modes=4, discretization=each).deflection(t)
        for each in (bd.Fem(16), bd.Ritz(12))
    )
    np.testing.assert_allclose(elements, basis, rtol=0, atol=1e-3 * np.abs(basis).max())
    elements, basis = (
        bd.steady_response(replace(moved, motion=None), [60.0], 3, discretization=each).bound
        for each in (bd.Fem(16), bd.Ritz(12))
    )
    np.testing.assert_allclose(elements, basis, rtol=1e-3)


def test_modes_of_finite_elements_in_space_have_their_own_stiffness() -> None:
    """Twist in other coordinates than nodal values was taken for nodal values."""
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    model = Model(bd.Scene(beam, bd.Mount(0.215, 1.0, 0.5), physics=IN_SPACE), bd.Fem(8))
    modal = reduce_to_modes(model.bent.about_straight, ModalBasis(3))
    stiffness, own = model.bent.reduced(modal).beam.stiffness, modal.matrices[0]["unity"]
    np.testing.assert_allclose(stiffness, own, rtol=0, atol=1e-9 * np.abs(own).max())
