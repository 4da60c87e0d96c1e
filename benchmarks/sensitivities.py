"""Derivatives of frequencies by the numbers of a scene, against other programs' frequencies beside it.

Run: python -m benchmarks.sensitivities [--scenes N] [--first N]

Half of the scenes bend in one plane, half in two, with twist, shear, rotary inertia, springs and precone.
Of one plane the reference are differences in 40-digit arithmetic (power series), of two planes the
derivative of the polynomial through eight frequencies by collocation.  Printed is the largest error of the
relative change of a frequency over that of a number, and how many errors exceed the stated ones.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial

import numpy as np
from mpmath import mp, mpf

import beamdyn as bd
from beamdyn.common.announced import unannounced
from beamdyn.sensitivities.interpolation import evaluate_nearby
from beamdyn.sensitivities.scene_numbers import SceneNumber
from beamdyn.studies.inputs import scene_of
from benchmarks.cases.random_physics import random_physics_scene
from benchmarks.cases.random_scenes import random_scene
from benchmarks.cases.reference.of_scene import exact
from benchmarks.cases.reference.of_two_planes import coned_frequencies_of, squared_frequencies
from benchmarks.rows import Row, show

MODES = 3
_BESIDE = 1e-3  # relative step of the differences in 40 digits: their error is of its eighth power
_RTOL = 1e-10  # of the collocation
_ALONE = ("speed", "model.damping_ratio")  # whose derivatives have no such reference
_OF_SCENE = 3  # numbers of a scene in two planes whose reference is computed


def compare(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Errors of the relative changes of one scene; and the stated ones with the reference's, shape (k,)."""
    rng = np.random.default_rng(seed)
    scene, speed = random_physics_scene(rng) if seed % 2 else random_scene(rng)
    with unannounced():
        found = bd.frequency_sensitivities(scene, speed, MODES)
    known = np.isfinite(found.derivative).all(axis=1)
    numbers = [k for k, each in enumerate(found.inputs) if known[k] and each.name not in _ALONE]
    chosen = rng.permutation(numbers)[:_OF_SCENE] if seed % 2 else numbers
    reference = by_collocation if seed % 2 else by_differences
    errors, stated = [], []
    for k in chosen:
        number = found.inputs[k]
        size = max(abs(number.value), 100 * number.step) / found.value
        truth, doubt = reference(found.scene, speed, number)
        errors.append((found.derivative[k] - truth) * size)
        stated.append((found.error[k] + doubt) * size)
    return np.abs(np.concatenate(errors)), np.concatenate(stated)


def by_differences(scene: bd.Scene, speed: float, number: SceneNumber) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of frequencies [Hz / unit of the number] from eight 40-digit ones beside the scene.

    Their squares are differenced, which are smooth where a frequency vanishes.  What the derivatives' own
    errors may be is added: the numbers of the scenes beside are rounded to 16 digits.
    """
    sides = (-4, -3, -2, -1, 1, 2, 3, 4) if number.value - number.step >= number.least else range(8)
    values = [number.value + side * _BESIDE * 100 * number.step for side in sides]
    with mp.workdps(40):
        rows = [exact(scene_of(scene, {number.name: v}), speed, MODES) for v in values]
        step = mpf(100 * number.step)  # in units of it the powers have like sizes
        apart = [(mpf(value) - mpf(number.value)) / step for value in values]
        powers = mp.matrix([[x**k for x in apart] for k in range(8)])
        weights = mp.lu_solve(powers, mp.matrix([0, 1, 0, 0, 0, 0, 0, 0])) / step
        squares = [
            mp.fsum(-w * row[j] ** 2 for w, row in zip(weights, rows, strict=True)) for j in range(MODES)
        ]
        found = [
            mp.re(each) / (2 * s.imag) for each, s in zip(squares, exact(scene, speed, MODES), strict=True)
        ]
        rounding = [float(2e-16 * mp.norm(weights, 1) * s.imag / mp.pi) for s in exact(scene, speed, MODES)]
        return np.array([float(each / (2 * mp.pi)) for each in found]), np.array(rounding)


def by_collocation(scene: bd.Scene, speed: float, number: SceneNumber) -> tuple[np.ndarray, np.ndarray]:
    """The same from eight frequencies by collocation of the differential equations."""

    def squares(value: float) -> tuple[np.ndarray, float]:
        beside = scene_of(scene, {number.name: value})
        if scene.mount.precone:
            found, change = coned_frequencies_of(beside, speed, MODES, _RTOL)
            return found**2, change
        return squared_frequencies(beside, speed, MODES, _RTOL)

    pairs, weights = evaluate_nearby(number, squares)
    frequency = np.sqrt(squares(number.value)[0]) / (2 * np.pi)
    changes = weights @ np.array([square for square, _ in pairs])
    relative = np.abs(weights).sum() * max(change for _, change in pairs) / 2
    return changes / (8 * np.pi**2 * frequency), relative * frequency


def summarize(scenes: int, first: int) -> Iterator[Row]:
    """The largest error, and how many the stated ones do not cover."""
    answers = [compare(seed) for seed in range(first, first + scenes)]
    error, stated = (np.concatenate(each) for each in zip(*answers, strict=True))
    yield f"derivatives of {MODES} modes of {scenes} random scenes", f"{error.size}", ""
    yield "... largest error of a relative change", f"{error.max():.0e}", "1e-08"
    yield "... errors above the stated ones", f"{(error > stated).sum()}", "0"
    yield "... largest error over the stated one", f"{(error / stated).max():.2g}", "1"


PARTS = (partial(summarize, 6, 0),)

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    show("Sensitivities", partial(summarize, given.scenes, given.first))
