"""Frequency over amplitude, against an average Lagrangian of one mode and against harmonic balance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import least_squares

import beamdyn as bd
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.beam_in_space.rotating_beam import BentState
from beamdyn.equations.root_motion import root_motion
from beamdyn.modes.modal.equilibrium import DeflectedSolver
from beamdyn.modes.modal.model import Model

CANTILEVER = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0))
HARVESTER = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
BENT = bd.Scene(HARVESTER, bd.Mount(0.215, math.radians(45)), physics=bd.Physics(large_deflection=True))


@pytest.mark.parametrize(("mode", "number"), [(1, 1.8751040687119611), (2, 4.694091132974174)])
def test_cantilever_at_rest_against_the_average_lagrangian_of_a_mode(mode: int, number: float) -> None:
    """With w = y phi(x), y = A cos(omega t), an inextensible beam has, to the fourth order of A,

        L = <1/2 m y.^2 + 1/2 n (y y.)^2 - 1/2 k y^2 - 1/2 b y^4>
          = m omega^2 A^2 / 4 + n omega^2 A^4 / 16 - k A^2 / 4 - 3 b A^4 / 16,

    from bending 1/2 int w''^2 (1 + w'^2) and shortening 1/2 int w'^2; dL/dA = 0 gives omega(A).  The forces
    are cubic, so that the linear mode alone decides the first order.
    """
    x, weights = np.polynomial.legendre.leggauss(60)
    x, weights = (x + 1) / 2, weights / 2
    s = (np.sinh(number) - np.sin(number)) / (np.cosh(number) + np.cos(number))

    def slope(x: np.ndarray) -> np.ndarray:
        z = number * x
        return number * (np.sinh(z) + np.sin(z) - s * (np.cosh(z) - np.cos(z)))

    z = number * x
    shape = np.cosh(z) - np.cos(z) - s * (np.sinh(z) - np.sin(z))
    curvature = number**2 * (np.cosh(z) + np.cos(z) - s * (np.sinh(z) + np.sin(z)))
    shortening = np.array([each * weights @ slope(each * x) ** 2 for each in x])
    tip = np.cosh(number) - np.cos(number) - s * (np.sinh(number) - np.sin(number))
    m, k = weights @ shape**2, weights @ curvature**2
    b, n = weights @ (curvature * slope(x)) ** 2, weights @ shortening**2
    found = bd.backbone(CANTILEVER, 0.0, mode)
    expected = (0.75 * b / k - 0.25 * n / m) / tip**2
    assert found.coefficient == pytest.approx(expected, abs=found.error + 1e-9)
    assert found.error < 1e-6 * abs(expected)  # extrapolated from 2 % of the length: fourth powers remain


@pytest.mark.parametrize(("angle", "speed"), [(5.0, 150.0), (150.0, 80.0), (20.0, 180.0)])
def test_bent_beams_against_harmonic_balance(angle: float, speed: float) -> None:
    scene = replace(BENT, mount=bd.Mount(0.215, math.radians(angle)))
    solver = Model(scene, bd.Ritz(5)).solver
    assert isinstance(solver, DeflectedSolver)
    state = solver.elastica.at(solver.equilibria(np.array([speed]))[0])
    first = bd.backbone(scene, speed, discretization=bd.Ritz(5))
    omega, amplitude = _balance(state, speed, 2 * np.pi * first.frequency, 0.02)
    shift = omega / (2 * np.pi * first.frequency) - 1
    assert shift == pytest.approx(first.coefficient * amplitude**2, rel=0.01)  # amplitude^2 = 4e-4, times 25


def _balance(state: BentState, speed: float, omega: float, small: float) -> tuple[float, float]:
    """Frequency, and amplitude over the length, of a periodic motion by a balance of four harmonics."""
    elastica, n, harmonics, samples = state.of, state.of.beam.size, 4, 24
    phase = 2 * np.pi * np.arange(samples) / samples
    waves = np.array(
        [np.ones(samples)] + [f(h * phase) for h in range(1, harmonics + 1) for f in (np.cos, np.sin)]
    )
    order = np.array([0] + [h for h in range(1, harmonics + 1) for _ in range(2)])
    derivative = np.zeros_like(waves)
    derivative[1::2], derivative[2::2] = -order[1::2, None] * waves[2::2], order[2::2, None] * waves[1::2]
    second = -(order[:, None] ** 2) * waves
    move = state.bent.tip_motions[:, 1], state.bent.tip_motions[:, 0]
    sample = bd.MotionSample.steady(np.full(samples, speed))
    motion = root_motion(elastica.linear.mount, sample)
    pencil = state.linearized().steady()
    K = pencil.K0 + speed**2 * pencil.K2
    v = scipy.linalg.eigh(K, state.bent.mass)[1][:, 0]
    v = v * small * elastica.beam.stations.length / np.hypot(move[0] @ v, move[1] @ v)
    scale, work, held = np.abs(v).max(), np.abs(K @ v).max(), int(np.abs(v).argmax())
    start = np.zeros((len(waves), n))
    start[1] = v / scale
    fixed = [
        n + held,
        2 * n + held,
    ]  # the cosine, which sets the amplitude, and the sine, which sets the phase
    given = start.ravel()[fixed]

    def complete(unknown: np.ndarray) -> tuple[np.ndarray, float]:
        full = np.insert(unknown, [fixed[0], fixed[1] - 1], given)
        return full[:-1].reshape(-1, n) * scale, float(full[-1] * omega)

    def residual(unknown: np.ndarray) -> np.ndarray:
        c, w = complete(unknown)
        r = elastica.at(state.bent.q + waves.T @ c).work(w * derivative.T @ c, w**2 * second.T @ c, motion)
        return (waves @ r).ravel() / samples / work

    # Energy is kept, so that one of the equations follows from the others: least squares.
    found = least_squares(residual, np.delete(np.append(start.ravel(), 1.0), fixed), xtol=1e-15, ftol=1e-15)
    assert np.abs(found.fun).max() < 1e-7
    c, frequency = complete(found.x)
    tip = [m @ (c[1] - 1j * c[2]) for m in move]
    size = (abs(tip[0] + 1j * tip[1]) + abs(tip[0] - 1j * tip[1])) / 2
    return frequency, float(size / elastica.beam.stations.length)


def test_an_unstable_equilibrium_has_no_backbone() -> None:
    scene = replace(BENT, mount=bd.Mount(0.215, 0.0))
    with pytest.raises(InvalidValue, match="does not oscillate"):
        bd.backbone(scene, 200.0)
    assert bd.backbone(replace(scene, physics=bd.Physics(branch="bent")), 200.0).frequency > 0


def test_frequency_at_an_amplitude() -> None:
    found = bd.backbone(CANTILEVER)
    assert found.at(0.1) == pytest.approx(found.frequency * (1 + 0.01 * found.coefficient), rel=1e-15)


def test_in_space_a_motion_in_one_plane_has_the_backbone_of_that_plane() -> None:
    planar, in_space = (
        bd.backbone(replace(BENT, physics=bd.Physics(planes, large_deflection=True)), 100.0)
        for planes in (1, 2)
    )
    assert in_space.frequency == pytest.approx(planar.frequency, rel=1e-11)  # both are known to rounding
    assert in_space.coefficient == pytest.approx(planar.coefficient, abs=planar.error + in_space.error)


@pytest.mark.parametrize("smallest", [bd.Ritz(1), bd.Fem(2)])
def test_the_smallest_discretization_has_no_smaller_one_to_estimate_its_error(
    smallest: bd.Discretization,
) -> None:
    assert bd.backbone(CANTILEVER, discretization=smallest).error == np.inf
