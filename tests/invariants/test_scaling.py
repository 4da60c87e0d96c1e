"""Symmetries and scaling laws of rotating beams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from benchmarks.cases.scenes import HARVESTER

angles = st.floats(-np.pi, np.pi)
speeds = st.floats(0, 140)


def squares(scene: bd.Scene, speed: float) -> np.ndarray:
    return (bd.natural_modes(scene, speed).eigenvalue ** 2).real


def turned(setting: float, bending: float) -> bd.Scene:
    return replace(HARVESTER, mount=bd.Mount(0.215, setting, bending))


@given(angles, angles, speeds)
def test_bending_angle_shifts_squared_frequencies(setting: float, bending: float, speed: float) -> None:
    """lambda^2 at psi is that out of the plane less omega^2 cos^2 psi: same vectors, Southwell's identity."""
    flap = squares(turned(setting, np.pi / 2), speed)
    found = squares(turned(setting, bending), speed)
    scale = np.abs(flap) + speed**2
    assert (np.abs(found - (flap + speed**2 * np.cos(bending) ** 2)) < 1e-10 * scale.max()).all()


@given(angles, speeds)
def test_leading_and_trailing_and_turning_back_are_alike(setting: float, speed: float) -> None:
    one = squares(turned(setting, 0.3), speed)
    for other in (squares(turned(-setting, 0.3), speed), squares(turned(setting, 0.3), -speed)):
        np.testing.assert_allclose(one, other, rtol=1e-9)


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # any units
@given(st.floats(1e-5, 100), st.floats(-9, 12), st.floats(-3, 4))
def test_similar_beams(length: float, log_stiffness: float, log_mass: float) -> None:
    """Frequency times tau = sqrt(rho A L^4 / EI) depends on speed times tau and radius / L alone."""
    mass, stiffness = 10**log_mass, 10**log_stiffness
    tau = np.sqrt(mass * length**4 / stiffness)
    beam = bd.Beam.from_stiffness(length, mass, stiffness)
    unit = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(2.0, np.pi, 1.0))
    scene = bd.Scene(beam, bd.Mount(2 * length, np.pi, 1.0))
    found = bd.natural_modes(scene, 3.0 / tau).frequency * tau
    np.testing.assert_allclose(found, bd.natural_modes(unit, 3.0).frequency, rtol=1e-11)


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # any units
@pytest.mark.parametrize("offset", [-0.05, 0.05])
def test_signs_of_torsion_modes_do_not_depend_on_the_unit_of_length(offset: float) -> None:
    """Twist and deflection of the tip have opposite signs with one of the offsets."""

    def tips(metre: float) -> np.ndarray:
        beam = bd.Beam.from_stiffness(
            metre,
            1.0,
            metre**2,
            rotary_inertia=1e-3 * metre**2,
            second_rotary_inertia=1e-3 * metre**2,
            torsion_stiffness=0.1 * metre**2,
            mass_offset=offset * metre,
        )
        modes = bd.natural_modes(bd.Scene(beam, physics=bd.Physics(torsion=True)))
        assert "torsion" in modes.kind
        return modes.tip * np.sqrt(metre)

    np.testing.assert_allclose(tips(1024.0), tips(1.0), rtol=1e-9)


def test_modes_are_orthonormal() -> None:
    modes = bd.natural_modes(HARVESTER, 50.0, 5)
    pencil, v = modes.model.solver.pencil, modes.vectors
    np.testing.assert_allclose(v.T @ pencil.M @ v, np.eye(5), atol=1e-10)
    stiffness = v.T @ (pencil.K0 + 50.0**2 * pencil.K2) @ v
    np.testing.assert_allclose(stiffness, np.diag(np.abs(modes.eigenvalue) ** 2), atol=1e-8 * stiffness.max())


def test_parseval_of_the_modal_load() -> None:
    """The modal loads of all modes add up to the beam's mass."""
    model = Model(HARVESTER, bd.Ritz(60))
    v = model.solver.solve(np.zeros(1), 60).vector[0]
    total = 7850 * 0.01 * 0.0002 * 0.05
    assert abs(((v.T @ model.equations.P(0)) ** 2).sum() / total - 1) < 0.01


def test_coriolis_lowers_the_first_frequency_of_an_outward_beam() -> None:
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, axial_stiffness=70.0**2)
    scene = bd.Scene(beam, bd.Mount(0.0, np.pi))
    plain, coupled = (
        bd.natural_modes(replace(scene, physics=bd.Physics(stretch=s)), 10.0, 1).frequency
        for s in (False, True)
    )
    assert coupled < plain


def test_damped_frequency_at_rest() -> None:
    damped = bd.natural_modes(replace(HARVESTER, damping_ratio=0.1), 0.0)
    plain = bd.natural_modes(HARVESTER, 0.0)
    np.testing.assert_allclose(damped.frequency, plain.frequency * np.sqrt(1 - 0.1**2), rtol=1e-9)
    np.testing.assert_allclose(damped.growth_rate, -0.1 * 2 * np.pi * plain.frequency, rtol=1e-9)
