"""The coarser model, by which errors are stated: some of the functions of the model, and fewer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.analyses.results.of_modes import critical_answer
from beamdyn.modes import critical_search
from beamdyn.modes.modal import continuation, equilibrium
from beamdyn.modes.modal.model import Model

BEAM = bd.Beam.from_stiffness(
    1.0,
    bd.Table([0.0, 0.4, 1.0], [1.0, 0.6, 0.5]),
    bd.Table([0.0, 0.4, 1.0], [1.0, 0.5, 0.4]),
    second_bending_stiffness=5.0,
    axial_stiffness=3e3,
    shear_stiffness=1e3,
    rotary_inertia=2e-3,
)
UNIFORM = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
CLAMPED = bd.Mount(0.1, math.pi, math.pi / 2)
TURNING = bd.Mount(0.1, math.pi, 0.4, root_stiffness=2.0, second_root_stiffness=0.0)
PHYSICS = {
    "one plane": bd.Physics(),
    "two planes": bd.Physics(planes=2),
    "stretch": bd.Physics(stretch=True),
    "shear": bd.Physics(shear=True, rotary_inertia=True),
}
SPEEDS = np.array([0.5, 1.3])


@pytest.mark.parametrize("mount", [CLAMPED, TURNING], ids=["clamped", "turning"])
@pytest.mark.parametrize("physics", PHYSICS.values(), ids=PHYSICS.keys())
@pytest.mark.parametrize("basis", ["legendre", "eigenfunctions"])
def test_part_of_the_equations_is_the_coarser_model(mount: bd.Mount, physics: bd.Physics, basis: str) -> None:
    for functions in (2, 3, 4, 6, 9):
        model = Model(bd.Scene(BEAM, mount, physics=physics), bd.Ritz(functions, basis))  # pyright: ignore
        modes = bd.Ritz(functions, basis).coarser().functions  # pyright: ignore
        found = model.coarse_solver.solve(SPEEDS, modes)
        each = model.coarser.solver.solve(SPEEDS, modes)
        assert model.coarse_solver.size == model.coarser.solver.size < model.solver.size
        error = np.abs(found.eigenvalue**2 - each.eigenvalue**2)  # squares: twice; stated: 1.5 times
        assert (error <= 3 * (found.rounding + each.rounding) * np.abs(each.eigenvalue) ** 2).all()


@pytest.mark.parametrize(
    "discretization",
    [bd.Ritz(1), bd.Ritz(1, "eigenfunctions"), bd.Ritz(1, "moments"), bd.Fem(2), bd.Fem(2, on_each=1)],
    ids=str,
)
def test_no_error_is_stated_by_a_model_with_itself(discretization: bd.Discretization) -> None:
    for root_stiffness in (math.inf, 3.0):
        mount = bd.Mount(0.1, math.pi, math.pi / 2, root_stiffness=root_stiffness)
        assert np.isinf(bd.natural_modes(bd.Scene(UNIFORM, mount), 1.0, 1, discretization).error).all()
    inward = bd.Scene(UNIFORM, bd.Mount(2.0, 0.0, math.pi / 2))
    assert np.isinf(bd.critical_point(inward, discretization).error)


def test_moments_between_masses_that_are_those_of_the_coarser_model() -> None:
    """Between many masses a moment is linear: more of them may be asked for, but no further function."""
    masses = [bd.PointMass(k / 11, 0.03) for k in range(1, 11)]
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, point_masses=masses)
    scene = bd.Scene(beam, CLAMPED)
    model = Model(scene, bd.Ritz(20, "moments"))
    assert model.coarse_solver.size == model.solver.size
    assert np.isinf(bd.natural_modes(scene, 1.0, 3, model.discretization).error).all()
    assert (
        bd.natural_modes(scene, 1.0, 3, tolerance=1e-2).error.max() <= 1e-2
    )  # by one with further functions


@pytest.mark.parametrize("functions", [1, 2, 3])
def test_few_moments(functions: int) -> None:
    """Too few for inertia and tension to cause others."""
    found = bd.natural_modes(bd.Scene(BEAM, CLAMPED), 1.0, 1, bd.Ritz(functions, "moments"))
    best = bd.natural_modes(bd.Scene(BEAM, CLAMPED), 1.0, 1, bd.Ritz(12))
    assert best.frequency[0] <= found.frequency[0] * (1 + 1e-12)  # a Rayleigh quotient, but for rounding


def test_each_field_has_more_functions_than_in_the_coarser_model() -> None:
    """The stretch has more here, but bending has not: its error would be stated as rounding."""
    masses = (bd.PointMass(0.3, 0.2), bd.PointMass(0.7, 0.1))
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, axial_stiffness=3e3, point_masses=masses)
    scene = bd.Scene(beam, CLAMPED, physics=bd.Physics(stretch=True))
    for functions in range(2, 25):
        model = Model(scene, bd.Ritz(functions, "moments"))
        bending, coarse = model.equations.blocks["bending"], model.equations.coarse
        if coarse is not None and np.isin(np.arange(bending.start, bending.stop), coarse).all():
            assert np.isinf(bd.natural_modes(scene, 1.0, 1, model.discretization).error).all()
            return
    raise AssertionError("no basis has as many functions of bending as the coarser one")


def _error_beyond_stated(scene: bd.Scene, functions: int, modes: int, finest: int) -> float:
    """Compute the largest ratio of the true error of a mode to the stated one."""
    found, best = (bd.natural_modes(scene, 50.0, modes, bd.Ritz(n)) for n in (functions, finest))
    return float((np.abs(found.frequency / best.frequency - 1) / found.error).max())


@pytest.mark.parametrize("functions", range(11, 16))
def test_modes_that_every_other_function_changes(functions: int) -> None:
    """About an equilibrium, a basis with one function less changed them by a hundredth of their error."""
    strip = bd.Beam.rectangular(0.3, 0.03, 0.004, 70e9, 2700.0)
    scene = bd.Scene(strip, bd.Mount(0.1, 2.2, 0.4), physics=bd.Physics(large_deflection=True))
    assert _error_beyond_stated(scene, functions, 5, 24) <= 1


@pytest.mark.parametrize("functions", range(4, 9))
def test_camber_has_more_functions_across_than_in_the_coarser_model(functions: int) -> None:
    """Of five functions along the beam, the coarser model kept all that camber has across it."""
    strip = bd.Beam.rectangular(0.3, 0.12, 0.004, 70e9, 2700.0, poissons_ratio=0.33)
    scene = bd.Scene(strip, bd.Mount(0.2), physics=bd.Physics(camber=True))
    assert _error_beyond_stated(scene, functions, 1, 14) <= 1


@pytest.mark.parametrize("tolerance", [0.1, 0.01])
def test_torsion_of_a_strip_at_a_loose_tolerance(tolerance: float) -> None:
    """The second function of torsion across changes its mode by less than the third."""
    strip = bd.Beam.rectangular(0.3, 0.1, 0.002, 70e9, 2700.0, poissons_ratio=0.3)
    physics = bd.Physics(rotary_inertia=True, torsion=True)
    scene = bd.Scene(strip, bd.Mount(0.1, 0.0, math.pi / 2), physics=physics)
    found = bd.natural_modes(scene, 20.0, 2, tolerance=tolerance)
    best = bd.natural_modes(scene, 20.0, 2, bd.Ritz(14))
    assert (np.abs(found.frequency / best.frequency - 1) <= found.error).all()


@pytest.mark.parametrize("tolerance", [0.1, 0.01])
def test_setting_angles_of_a_cambered_strip(tolerance: float) -> None:
    """They have bases with more functions across than the two by which their error is stated."""
    strip = bd.Beam.rectangular(0.3, 0.12, 0.004, 70e9, 2700.0, poissons_ratio=0.33)
    scene = bd.Scene(strip, bd.Mount(0.2), physics=bd.Physics(camber=True))
    found, best = (bd.setting_angle_limits(scene, 50.0, tolerance=t) for t in (tolerance, 1e-5))
    assert max(abs(found.first - best.first), abs(found.second - best.second)) <= found.error


OBLIQUE = bd.Scene(
    bd.Beam.rectangular(0.05, 0.01, 0.4e-3, 200e9, 7850.0, poissons_ratio=0.3),
    bd.Mount(0.215, math.pi / 4, math.pi / 6),
    physics=bd.Physics(planes=2, rotary_inertia=True, torsion=True, large_deflection=True),
)


def test_stiffness_of_a_beam_bent_in_space_is_symmetric_in_a_boundary_layer() -> None:
    """The rotation of sections varies as fast as the functions do, and was integrated with too few points."""
    solver, speed = Model(OBLIQUE, bd.Ritz(50)).deflected, 2000.0
    stiffness = solver.load.at(solver.equilibria(np.array([speed]))[0], speed**2).change
    size = np.sqrt(np.abs(np.diag(stiffness)))
    skew = (stiffness - stiffness.T) / np.outer(size, size)
    assert np.abs(skew).max() < 1e-9  # 2e-7 with 14 points more than the functions need


@pytest.mark.parametrize(
    ("compared", "speeds", "used", "error"),
    [
        ((4860.0, False), [(4879.0, False), (4900.0, False), (2720.0, True)], 2, 0.0),
        ((4860.0, False), [(4879.0, False), (2806.0, True), (2804.0, True)], 3, (2806 / 2804) ** 2 - 1),
        ((2990.0, None), [(3000.0, None), (3100.0, None), (2720.0, True)], 1, np.inf),
        ((2990.0, True), [(2806.0, True), (2600.0, True), (2599.0, True)], 3, (2600 / 2599) ** 2 - 1),
    ],
)
def test_stability_of_a_bent_beam_and_its_loss_are_confirmed_by_the_model_before(
    compared: tuple[float, bool | None],
    speeds: list[tuple[float, bool | None]],
    used: int,
    error: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A coarse basis may miss it, and two functions less may change the speed by less than its error."""
    models = [Model(OBLIQUE, bd.Ritz(k)) for k in (9, 10, 11)]
    answers = iter([speeds[0], compared, *speeds[1:]])

    def lose(_: object) -> equilibrium.StabilityLoss:
        speed, is_lost = next(answers)
        return equilibrium.StabilityLoss(speed**2, is_lost, np.zeros(1))

    monkeypatch.setattr(equilibrium.DeflectedSolver, "find_loss_of_stability", lose)
    found = critical_search.search_bent(iter(models), 0.06)
    speed, is_lost = speeds[used - 1]
    assert found.speed == pytest.approx(speed, rel=1e-14) and found.loss.is_lost == is_lost
    # Slow convergence: three times the difference of the speeds, half of that of their squares.
    assert found.error == pytest.approx(1.5 * error, rel=1e-6, abs=0.0)


@pytest.mark.slow
def test_the_error_of_a_loss_of_stability_holds_against_a_far_finer_basis() -> None:
    """The boundary layer of the strip in space is resolved slowly."""
    models = (Model(OBLIQUE, bd.Ritz(k)) for k in (25, 31))
    found = critical_search.search_bent(models, 0.0)
    finer = Model(OBLIQUE, bd.Ritz(56)).deflected.find_loss_of_stability()
    assert found.error / 10 < found.speed / math.sqrt(finer.squared) - 1 < found.error


@pytest.mark.slow
def test_a_loss_of_stability_is_told_to_be_inaccurate_and_past_linear_elasticity() -> None:
    strain, _, error = bd.critical_point(OBLIQUE, bd.Ritz(20)).warnings
    assert error.startswith("the estimated relative error of the critical speed is 0.")
    assert strain.startswith("at 2882.3 rad/s the strain reaches 0.17: ")


def test_one_model_alone_does_not_claim_that_a_bent_beam_stays_stable() -> None:
    """With 10 functions the strip keeps the stability that it loses at 2672 rad/s."""
    alone = bd.critical_point(OBLIQUE, bd.Ritz(10))
    assert alone.speed == alone.error == np.inf and "no second model confirms" in str(alone.warnings)
    assert str(critical_answer(alone).renderables[0]).startswith("no critical speed found up to 2.574")


@pytest.mark.parametrize("speed", [20.0, 150.0])
def test_equilibria_of_many_elements_are_found_near_those_of_few(
    speed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only few elements are followed from rest, at a hundredth of the cost; the equilibrium is the same."""
    strip = bd.Beam.rectangular(0.1, 0.01, 0.0005, 200e9, 7850.0)
    scene = bd.Scene(strip, bd.Mount(0.2, 0.5), physics=bd.Physics(large_deflection=True))
    model, followed = Model(scene, bd.Fem(72)), list[int]()

    def follow(load: continuation.Loading, *given: Any) -> np.ndarray:
        followed.append(load.elastica.beam.size)
        return reach(load, *given)

    reach = continuation.reach
    alone = equilibrium.DeflectedSolver(model.bent, "straight").tips(np.array([speed]))
    monkeypatch.setattr(continuation, "reach", follow)
    assert model.deflected.tips(np.array([speed])) == pytest.approx(alone, rel=1e-11)  # Newton's method ends
    assert followed == [2 * 36]
