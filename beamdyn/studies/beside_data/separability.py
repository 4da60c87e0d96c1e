"""Identifiability: which numbers the data determine, and which further data would help.

Let J = U S V^T be the derivatives of residuals, over their uncertainties, with respect to the variables of
size 1.  A change of size 1/s along a column of V, with the singular value s, changes the data by one
uncertainty; as numbers are bounded, 1/s is limited to ten.  If a number can change by its full size within
the uncertainties, the data do not determine it.  Uncertainties are at least a millionth of the frequency, so
that rounding cannot change this decision.

In shapes of arrays, p counts variables, and N measured values.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.common.results.statements import unannounced
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.points import TipMass
from beamdyn.scene.profile import mean
from beamdyn.scene.scene import Scene
from beamdyn.studies.beside_data.fit import FittedModes, Fitting

LARGEST = 1.0  # standard error of a variable of size 1 above which its number is undetermined
# Smallest relative uncertainty of a frequency that is assumed in the decision about identifiability.
FINEST = 1e-6
# A number is listed with an undetermined direction of the variables if this direction contributes at least
# this fraction of `LARGEST` to its standard error.
_TAKES_PART = 0.5
# Smaller singular values are replaced by this one: the bounds of a variable are about ten times its size
# apart.
_BOUND = 0.1
# Smallest relative change of a measurement, per unit step of the variables along a direction, for which it
# determines that direction.
_TOLD = 0.05
_STEP = 1e-3
_BODY = 0.2  # mass of a known body, over that of the beam, that is proposed for a measurement
_FASTER = 2.0  # ratio of the speed proposed for a measurement to the largest speed of the data
# Speed [rad/s] proposed for a measurement if the data are at rest, over the first frequency [Hz]: a quarter
# of the angular frequency.
_FAST = np.pi / 2
_PLACES = np.linspace(0.0, 1.0, 201)


@dataclass(frozen=True)
class Information:
    """Information in residuals about p variables, by the singular values of their derivatives.

    Parameters
    ----------
    J : ndarray, shape (residuals, p)
        Derivatives of the residuals over their standard uncertainties.
    """

    J: np.ndarray

    @cached_property
    def _parts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        U, s, V = np.linalg.svd(self.J, full_matrices=False)
        return U, np.maximum(s, _BOUND), V.T

    @cached_property
    def covariance(self) -> np.ndarray:
        """Covariance matrix of the variables."""
        _, s, V = self._parts
        return (V / s**2) @ V.T

    @property
    def told(self) -> np.ndarray:
        """Whether the data determine each variable."""
        return np.sqrt(np.diag(self.covariance)) <= LARGEST

    @property
    def lost(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Directions (p,) that the data do not determine, with masks (p,) of their main variables."""
        _, s, V = self._parts
        each = [
            (v, ~self.told & (np.abs(v) / size > _TAKES_PART * LARGEST))
            for v, size in zip(V.T, s, strict=True)
        ]
        return [(v, named) for v, named in each if named.any()]

    @property
    def leverage(self) -> np.ndarray:
        """Leverage of each measured value in the fit: the diagonal of the hat matrix."""
        U, s, _ = self._parts
        return (U[:, s > _BOUND] ** 2).sum(axis=1)

    def step(self, residual: np.ndarray) -> np.ndarray:
        """Compute the step to the smallest sum of squares of the linearized problem without bounds."""
        U, s, V = self._parts
        return -V @ ((U.T @ residual) / s)


@dataclass(frozen=True)
class NotSeparable:
    """Numbers that the data do not determine separately.

    Parameters
    ----------
    names : tuple of str
        Names of the numbers in scene files.
    measurements : tuple of str
        Additional measurements that would determine them separately.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> data = bd.MeasuredFrequencies([62.0, 389.0, 1090.0], uncertainty=0.5)
    >>> unknown = {"beam.youngs_modulus": None, "beam.density": None}
    >>> bd.identify(bd.Scene(strip), data, free=unknown).not_separable[0].names
    ('beam.youngs_modulus', 'beam.density')
    """

    names: tuple[str, ...]
    measurements: tuple[str, ...]


def not_separable(modes: FittedModes, lost: list[tuple[np.ndarray, np.ndarray]]) -> tuple[NotSeparable, ...]:
    """List the numbers of each undetermined direction, and measurements that would determine it."""
    paths = np.array([number.path for number in modes.fitting.numbers])
    return tuple(
        NotSeparable(tuple(paths[named].tolist()), tuple(_telling(modes, direction)))
        for direction, named in lost
    )


def _telling(modes: FittedModes, direction: np.ndarray) -> list[str]:
    """List the additional measurements whose results change clearly along a direction of the variables."""
    low, high = modes.fitting.limits
    ends = [np.clip(modes.x + step * direction, low, high) for step in (-_STEP, _STEP)]
    change = float(np.linalg.norm(ends[1] - ends[0]))
    before, after = (_measured(modes.fitting, modes.fitting.scene_at(x)) for x in ends)
    return [name for name in before if abs(np.log(after[name] / before[name])) > _TOLD * change]


def _measured(fitting: Fitting, scene: Scene) -> dict[str, float]:
    """Compute quantities of a scene that could be measured in addition, by name."""
    first, speed = _frequency(scene), float(np.abs(fitting.data.speeds).max())
    return {
        "the mass of the beam": _mass(scene),
        "the deflection of the tip under a known force": _compliance(scene),
        "the first frequency with a known body at the tip": _frequency(
            _loaded(scene, _BODY * _mass(fitting.scene))
        ),
        f"the frequency of mode {fitting.modes} at rest": _frequency(scene, mode=fitting.modes),
        "the first frequency at a higher speed": _frequency(scene, max(_FASTER * speed, _FAST * first)),
    }


def _frequency(scene: Scene, speed: float = 0.0, mode: int = 1) -> float:
    """Compute a natural frequency [Hz]; 1 if the mode does not vibrate, so that it has a logarithm."""
    with unannounced():
        found = float(natural_modes(scene, speed, mode).frequency[mode - 1])
    return found if found > 0 else 1.0


def _mass(scene: Scene) -> float:
    """Compute the mass of the beam with its tip body and point masses [kg]."""
    beam = scene.beam
    bodies = beam.point_masses if beam.tip is None else (*beam.point_masses, beam.tip)
    return mean(beam.mass_per_length) * beam.length + sum(body.mass for body in bodies)


def _compliance(scene: Scene) -> float:
    """Compute the tip deflection per unit force [m/N], by bending stiffness and root spring."""
    L, arm = scene.beam.length, (1 - _PLACES) ** 2
    bending = float(np.trapezoid(arm / scene.beam.bending_stiffness(_PLACES), _PLACES)) * L**3
    return bending + L**2 / scene.mount.root_stiffness


def _loaded(scene: Scene, mass: float) -> Scene:
    """Return the scene with a mass [kg] added at the tip."""
    tip = scene.beam.tip or TipMass(0.0)
    return replace(scene, beam=replace(scene.beam, tip=replace(tip, mass=tip.mass + mass)))
