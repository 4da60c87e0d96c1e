"""Frequencies of a scene by the second method, from nondimensional functions of its properties."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

import beamdyn as bd
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.profile import Profile
from beamdyn.studies.sensitivities.changes import evaluate_nearby
from beamdyn.studies.sensitivities.sensitivity_result import SceneNumber
from benchmarks.cases.reference.twisted_beam import Blade, Body, constant, converged, solve
from benchmarks.cases.reference.twisted_beam.blade import Function, Pair
from benchmarks.cases.reference.twisted_beam.coned import coned_frequencies, solve_coned

_FINEST = 64  # largest number of pieces between breakpoints
_OF_DERIVATIVES = 1e-10  # relative accuracy of frequencies from which differences are computed
_MARGIN = 4.0  # margin for rounding of these frequencies, over the difference of two meshes


def squared_frequencies(
    scene: bd.Scene, speed: float, count: int = 3, rtol: float = 1e-12
) -> tuple[np.ndarray, float]:
    """Compute the lowest lambda^2 [1/s^2], without stretch and damping, and the change on the last mesh."""
    blade, unit = blade_of_scene(scene)
    squares, change = converged(blade, speed * unit, count, rtol)
    return squares / unit**2, change


def coned_frequencies_of(
    scene: bd.Scene, speed: float, count: int = 3, rtol: float = 1e-10
) -> tuple[np.ndarray, float]:
    """Compute the lowest frequencies [rad/s] of a scene with precone, and the change on the last mesh."""
    blade, unit = blade_of_scene(scene)
    found, change = coned_frequencies(blade, speed * unit, count, rtol)
    return found / unit, change


def squares_on_mesh(scene: bd.Scene, speed: float, count: int, pieces: int) -> np.ndarray:
    """Compute the lowest lambda^2 [1/s^2], also with precone, on a mesh of equal pieces."""
    blade, unit = blade_of_scene(scene)
    if scene.mount.precone:
        return (solve_coned(blade, speed * unit, count, pieces) / unit) ** 2
    return solve(blade, speed * unit, count, pieces).quotients / unit**2


def pieces_needed(scene: bd.Scene, speed: float, count: int, rtol: float) -> tuple[int, float]:
    """Find the number of pieces whose halving changes no lambda^2 by more than `rtol`, and the change."""
    pieces, before, change = 1, squares_on_mesh(scene, speed, count, 1), math.inf
    while pieces < _FINEST:
        pieces *= 2
        found = squares_on_mesh(scene, speed, count, pieces)
        change = float(np.max(np.abs(found / before - 1)))
        if change <= rtol:
            return pieces, change
        before = found
    raise ArithmeticError(f"not converged: the finest mesh changes lambda^2 by {change:.1e}")


def derivatives_by_collocation(
    scene: bd.Scene, speed: float, numbers: Sequence[SceneNumber], count: int = 3
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Compute derivatives of frequencies [Hz / unit of each number] by differences of eight frequencies.

    The second array is the rounding error, estimated by a mesh twice as fine: the lowest modes of beams that
    are far stiffer in one direction have few digits.
    """
    pieces, _ = pieces_needed(scene, speed, count, _OF_DERIVATIVES)
    frequency = np.sqrt(squares_on_mesh(scene, speed, count, pieces)) / (2 * np.pi)
    slopes, sizes = [], []
    for number in numbers:

        def squares(value: float, name: str = number.name) -> np.ndarray:
            beside = with_numbers(scene, {name: value})
            return np.stack([squares_on_mesh(beside, speed, count, n) for n in (pieces, 2 * pieces)])

        widest = next(evaluate_nearby(number, squares))
        slopes.append(np.tensordot(widest.weights, np.array(widest.values), 1) / (8 * np.pi**2 * frequency))
        sizes.append(np.abs(widest.weights).sum())
    noise = np.max([np.abs(a - b) / size for (a, b), size in zip(slopes, sizes, strict=True)], axis=0)
    return [(a, _MARGIN * noise * size) for (a, _), size in zip(slopes, sizes, strict=True)]


def blade_of_scene(scene: bd.Scene) -> tuple[Blade, float]:
    """Return the nondimensional blade (units: length, mass and stiffness at the root), unit of time [s]."""
    beam, mount, physics = scene.beam, scene.mount, scene.physics
    length, root = beam.length, np.zeros(1)
    mass, stiffness = (float(p(root)[0]) for p in (beam.mass_per_length, beam.bending_stiffness))

    def pair(name: str, unit: float, default: float, modelled: bool = True) -> Pair:
        first, second = (getattr(beam, key) if modelled else None for key in (name, f"second_{name}"))
        return _over(first, unit, default), _over(second, unit, default)

    stiff = pair("shear_stiffness", stiffness / length**2, math.inf, physics.shear)
    blade = Blade(
        mass=_over(beam.mass_per_length, mass, 1.0),
        stiffness=pair("bending_stiffness", stiffness, 1.0),
        twist=_over(beam.twist if physics.planes == 2 else None, 1.0, 0.0),
        flexibility=(_inverse(stiff[0]), _inverse(stiff[1])),
        rotary=pair("rotary_inertia", mass * length**2, 0.0, physics.rotary_inertia),
        hub=0.0 if _right_angle(mount) else -math.cos(mount.setting_angle) * mount.radius / length,
        bending_angle=mount.bending_angle,
        springs=(mount.root_stiffness * length / stiffness, mount.second_root_stiffness * length / stiffness),
        body=_body(beam.tip, mass, length),
        planes=physics.planes,
        breakpoints=beam.breakpoints[1:-1],
        precone=mount.precone,
    )
    return blade, length**2 * math.sqrt(mass / stiffness)


def _over(profile: Profile | None, unit: float, default: float) -> Function:
    return constant(default) if profile is None else lambda x: profile(x) / unit


def _inverse(function: Function) -> Function:
    return lambda x: 1 / function(x)


def _right_angle(mount: bd.Mount) -> bool:
    return abs(math.cos(mount.setting_angle)) < 2e-16


def _body(tip: bd.TipMass | None, mass: float, length: float) -> Body:
    if tip is None:
        return Body()
    inertias = (tip.inertia, tip.inertia_about_bending_direction, tip.axial_inertia)
    return Body(tip.mass / (mass * length), tip.offset / length, *(j / (mass * length**3) for j in inertias))
