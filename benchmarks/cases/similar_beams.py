"""Similar steel beams of any length: nondimensional answers must be equal."""

from __future__ import annotations

from typing import Literal

import numpy as np

import beamdyn as bd

_MODULUS, _DENSITY = 200e9, 7850.0
_BAND = 0.1, 30.0  # frequencies of the excitation, over the first angular frequency
_SPEED = 0.3  # speed, over the first angular frequency


def first_frequency(length: float) -> float:
    """Compute the first angular frequency at rest [rad/s] of a beam of given length [m], in closed form."""
    return 3.516 * float(np.sqrt(_MODULUS / _DENSITY / 12)) * (length / 250) / length**2


def similar_beam(length: float, planes: Literal[1, 2] = 1) -> bd.Scene:
    """Make a beam of width L/5 and thickness L/250 on a hub of L, with 1 % of damping."""
    beam = bd.Beam.rectangular(length, length / 5, length / 250, _MODULUS, _DENSITY)
    mount = bd.Mount(length, np.pi, 0.4 * (planes - 1))
    return bd.Scene(beam, mount, damping_ratio=0.01, physics=bd.Physics(planes=planes))


def linear_answers(length: float, planes: Literal[1, 2] = 1) -> np.ndarray:
    """Compute nondimensional frequency response, peaks, mean squares, poles: with functions and modes."""
    scene, omega = similar_beam(length, planes), first_frequency(length)
    low, high = (each * omega / (2 * np.pi) for each in _BAND)
    found = bd.frequency_response(scene, _SPEED * omega, np.geomspace(low, high, 20))
    density = 1e-6 * length**2 * omega**3
    rms = bd.random_response(scene, _SPEED * omega, bd.PowerSpectrum([low, high], [density] * 2)).rms
    poles = bd.matrices(scene, _SPEED * omega).poles[:10]
    of_modes = bd.matrices(scene, _SPEED * omega, modes=4).poles
    of_space = np.linalg.eigvals(bd.state_space(scene, _SPEED * omega, modes=4).A)
    return np.concatenate([
        found.response[:, 0] * omega**2,
        found.peaks.frequency / omega,
        found.peaks.size * omega**2,
        [rms / length],
        poles / omega,
        of_modes / omega,
        np.sort_complex(np.round(of_space / omega, 12)),
    ])  # fmt: skip


def deviation(length: float, planes: Literal[1, 2] = 1) -> float:
    """Compute the largest relative deviation of a beam's linear models from those of a beam of 1 m."""
    own, of_a_metre = (linear_answers(each, planes) for each in (length, 1.0))
    return float((np.abs(own - of_a_metre) / np.abs(of_a_metre)).max())
