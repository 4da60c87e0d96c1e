"""Each added effect vanishes like the inverse of its stiffness, down to rounding; a hinge at the root."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd

MODES = 3
RATIOS = np.logspace(4, 6, 5)  # above the second term of the series, below rounding
METHODS: Any = pytest.mark.parametrize("method", [bd.Ritz(16), bd.Fem(16)], ids=["ritz", "fem"])
HUB = bd.Mount(0.5, math.pi, math.radians(50))


def stiffer_across(ratio: float) -> bd.Scene:
    """Both directions oblique to the plane of rotation, which couples them."""
    beam = bd.Beam.from_stiffness(1.0, Polynomial([1, -0.4]), 1.0, second_bending_stiffness=ratio)
    return bd.Scene(beam, HUB, physics=bd.Physics(planes=2))


def twisted(mount: bd.Mount = HUB, shear: float | None = None) -> bd.Scene:
    beam = bd.Beam.from_stiffness(
        1.0,
        Polynomial([1, -0.4]),
        Polynomial([1, -0.6]),
        second_bending_stiffness=5.0,
        twist=Polynomial([0, 0.6]),
        shear_stiffness=shear,
        second_shear_stiffness=None if shear is None else 2 * shear,
    )
    return bd.Scene(beam, mount, physics=bd.Physics(planes=2, shear=shear is not None))


def one_plane(scene: bd.Scene) -> bd.Scene:
    return replace(scene, physics=bd.Physics())


def stiffer_in_shear(ratio: float) -> bd.Scene:
    return twisted(shear=ratio)


def stiffer_at_the_root(ratio: float) -> bd.Scene:
    return twisted(replace(HUB, root_stiffness=ratio, second_root_stiffness=3 * ratio))


# Scenes of a growing stiffness, the simpler model, and the speed: high where it alone couples the planes.
LIMITS: dict[str, tuple[Callable[[float], bd.Scene], bd.Scene, float]] = {
    "second plane": (stiffer_across, one_plane(stiffer_across(1.0)), 40.0),
    "shear": (stiffer_in_shear, twisted(), 4.0),
    "root": (stiffer_at_the_root, twisted(), 4.0),
}


def frequencies(scene: bd.Scene, speed: float, method: Any) -> np.ndarray:
    return bd.natural_modes(scene, speed, MODES, method).frequency


@METHODS
@pytest.mark.parametrize("limit", LIMITS)
def test_distance_to_the_simpler_model(limit: str, method: Any) -> None:
    scenes, simpler, speed = LIMITS[limit]
    expected = frequencies(simpler, speed, method)
    distance = np.array([1 - frequencies(scenes(ratio), speed, method) / expected for ratio in RATIOS])
    assert (distance > 0).all()  # every stiffness raises the frequencies
    exponents = np.polyfit(np.log(RATIOS), np.log(distance), 1)[0]
    np.testing.assert_allclose(exponents, -1, atol=0.05)


@METHODS
@pytest.mark.parametrize("limit", LIMITS)
def test_the_simpler_model_is_reached(limit: str, method: Any) -> None:
    """At 1e15 times the stiffness what is left is rounding: 1e-12 of Ritz, 1e-10 of elements."""
    scenes, simpler, speed = LIMITS[limit]
    rtol = 1e-12 if isinstance(method, bd.Ritz) else 1e-10
    stiff = frequencies(scenes(1e15), speed, method)
    np.testing.assert_allclose(stiff, frequencies(simpler, speed, method), rtol=rtol)


# A hinge at the root ------------------------------------------------------------------------------


def hinged(gamma: float, modes: int, method: Any = "ritz") -> np.ndarray:
    """Frequencies over the speed, out of the plane of rotation, without hub."""
    scene = bd.Scene(
        bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, math.pi, math.pi / 2, root_stiffness=0.0)
    )
    return 2 * math.pi * bd.natural_modes(scene, gamma, modes, method).frequency / gamma


@pytest.mark.parametrize("gamma", [1e3, 1e4])
def test_a_hinged_chain_is_approached_from_above(gamma: float) -> None:
    """Without bending stiffness the modes are odd Legendre polynomials: lambda/gamma = sqrt(n (2 n - 1))."""
    n = np.array([2, 3])
    distance = hinged(gamma, 3)[1:] / np.sqrt(n * (2 * n - 1)) - 1
    assert (distance > 0).all()
    assert (distance < 500 / gamma**2).all()  # the bound that is asked for, of the order of EI / gamma^2


@pytest.mark.parametrize("gamma", [0.1, 1.0, 10.0, 1e2, 1e3, 1e4])
def test_a_hinged_blade_turns_with_the_speed(gamma: float) -> None:
    """Whatever the stiffness, the first mode is straight and has the frequency of the rotation."""
    np.testing.assert_allclose(hinged(gamma, 1), 1, rtol=1e-12)
