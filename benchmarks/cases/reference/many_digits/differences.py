"""Differences of eigenvalues by the numbers of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg
from mpmath import mp, mpf

import beamdyn as bd
from benchmarks.cases.reference.many_digits.eigenvalues import AtRest, Mode, Pencil, modes_of
from benchmarks.cases.reference.many_digits.energies import Space
from benchmarks.cases.reference.many_digits.fixed import DIGITS
from benchmarks.cases.reference.many_digits.numbers import Numbers

_BESIDE = mpf(10) ** -18  # change of a number for a difference quotient, relative to its magnitude
_MESHES = (  # numbers of trial functions on each segment, and of pieces of each segment
    (10, 1), (14, 1), (20, 1), (28, 1), (40, 1), (28, 2), (40, 2), (28, 4),
)  # fmt: skip
# Numbers of a scene that change the modes at rest.
_AT_REST = "beam.", "mount.root_stiffness", "mount.second_root_stiffness"
_LARGEST = 700  # largest number of trial functions of all fields together
_RTOL = 1e-11  # largest change of frequencies by a finer mesh


@dataclass(frozen=True)
class Number:
    """A number of a scene: name in scene files, value, and nonzero typical magnitude."""

    name: str
    value: float
    size: float


def frequency_derivatives(
    scene: bd.Scene, speed: float, modes: int, numbers: Sequence[Number]
) -> tuple[list[float], np.ndarray, np.ndarray]:
    """Compute frequencies [Hz], derivatives [Hz / unit of each number], and the change on another mesh.

    Arrays have the shape (numbers, modes).
    """
    with mp.workdps(DIGITS):
        coarse, fine = _meshes(scene, speed, modes)
        found, other = (_derivatives(each, modes, numbers) for each in (fine, coarse))
        frequency = [float(mp.im(mode.s) / (2 * mp.pi)) for mode in found[0]]
        return frequency, found[1], np.abs(found[1] - other[1])


def _meshes(scene: bd.Scene, speed: float, modes: int) -> tuple[Pencil, Pencil]:
    """Return the first two successive meshes whose frequencies agree."""
    before: tuple[Pencil, np.ndarray] | None = None
    for functions, pieces in _MESHES:
        pencil = Pencil.of(Numbers(scene, speed, functions, pieces))
        if pencil.space.size > _LARGEST:
            break
        found = _rough(pencil, modes)
        if before is not None and np.abs(found / before[1] - 1).max() <= _RTOL:
            return before[0], pencil
        before = pencil, found
    raise ArithmeticError("not settled on the largest mesh")


def _rough(pencil: Pencil, modes: int) -> np.ndarray:
    """Compute squared frequencies in double precision, without damping and gyroscopic terms."""
    e, matrix = pencil.energies, pencil.space.matrix
    M, K = matrix(e.mass), matrix(e.still) + float(pencil.numbers.omega) ** 2 * matrix(e.spin)
    shift = 1.0
    inverse = scipy.linalg.eigh(M, K + shift * M, eigvals_only=True)[::-1][:modes]
    return 1 / inverse


def _derivatives(pencil: Pencil, modes: int, of: Sequence[Number]) -> tuple[list[Mode], np.ndarray]:
    """Compute modes of a scene, and derivatives of their frequencies by differences."""
    if pencil.numbers.ratios(1):
        pencil = replace(pencil, damping=AtRest.of(pencil))
    found = [replace(mode, s=pencil.quotient(mode)) for mode in modes_of(pencil, modes)]
    rows = [_by_number(pencil, found, number) for number in of]
    return found, np.array(rows).reshape(len(of), modes)


def _by_number(pencil: Pencil, modes: Sequence[Mode], number: Number) -> list[float]:
    """Compute difference quotients by a number; changed eigenvalues have an error of second order."""
    change = _BESIDE * mpf(number.size)
    beside = _changed(pencil, number, change)
    return [float(mp.im(beside.quotient(mode) - mode.s) / change / (2 * mp.pi)) for mode in modes]


def _changed(pencil: Pencil, number: Number, change: mpf) -> Pencil:
    """Return the scene with a number changed; trial functions stay where the mesh does."""
    numbers = replace(pencil.numbers, name=number.name, value=mpf(number.value), change=change)
    same = numbers.mesh.ends == pencil.numbers.mesh.ends
    found = Pencil(numbers, pencil.space if same else Space(numbers))
    if pencil.damping is None:
        return found
    if not number.name.startswith(_AT_REST):
        ratios = numbers.ratios(len(pencil.damping.roots))
        return replace(found, damping=replace(pencil.damping, ratios=ratios))
    return replace(found, damping=AtRest.of(found, pencil.damping.shapes))
