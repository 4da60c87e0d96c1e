"""Size of the parametric term that linear models leave out: accelerations along the beam vary its stiffness.

A random acceleration a along the beam varies the squared frequency of a mode by the fraction xi = kappa a,
kappa = |phi K_GA phi| / omega^2 for its shape phi of unit mass.  For an oscillator of the damping ratio zeta,

    q'' + 2 zeta omega q' + omega^2 (1 + xi) q = w,

with xi and w of a wide band the equations of the second moments give the variance over that without xi

    1 / (1 - x),    x = omega G(2 f) / (8 zeta),

with the one-sided density G of xi at twice the natural frequency (stochastic averaging: Roberts and Spanos
(1986), International Journal of Non-Linear Mechanics 21, 111-134).  At x = 1 the mean square grows without
limit.  Of a narrow band, and of xi that depends on w, this tells the order of magnitude.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from beamdyn.linear.excitations import BaseMotion, Excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum

_LARGE = 0.01  # relative change that is worth a warning


@dataclass(frozen=True)
class ParametricTerm:
    """Size of the parametric term.

    Parameters
    ----------
    stiffness_variation : float
        Root mean square of the random variation of the squared lowest frequency, relative to it.
    by_gravity : float
        Amplitude of its variation by gravity as the beam turns, likewise relative.
    rms_change : float
        Estimated relative change of the root mean square of the lowest mode by the random variation; inf
        where it would grow without limit.

    References
    ----------
    Roberts and Spanos (1986), International Journal of Non-Linear Mechanics 21, 111-134.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_response(scene, 83.3, bd.RoadRoughness("C", highest=10.0))
    >>> found.parametric.stiffness_variation < 0.1
    True
    """

    stiffness_variation: float
    by_gravity: float
    rms_change: float

    def warnings(self) -> Iterator[str]:
        """Yield a warning for each that is not small."""
        if self.rms_change > _LARGE:
            size = "without limit" if math.isinf(self.rms_change) else f"by some {self.rms_change:.0%}"
            yield f"the parametric term that is left out would raise the root mean square {size}"
        if self.by_gravity > _LARGE:
            yield (
                f"gravity along the beam varies the lowest squared frequency by {self.by_gravity:.1%} "
                "within a turn, which is left out"
            )


def parametric_term(
    model: ModelAtSpeed, excitation: Excitation, spectrum: PowerSpectrum | float
) -> ParametricTerm:
    """Estimate the size of the parametric term for the lowest mode.

    Parameters
    ----------
    model : ModelAtSpeed
        The linear model.
    excitation : BaseMotion or PointForce
        The input.
    spectrum : PowerSpectrum or float
        Its one-sided density; a number is that of white noise.
    """
    K_GA = model.equations.matrices[0].get("root_axial")
    if K_GA is None:
        return ParametricTerm(0.0, 0.0, 0.0)
    squared, shapes = scipy.linalg.eigh(model.K, model.M)
    kappa = abs(shapes[:, 0] @ K_GA @ shapes[:, 0]) / squared[0]
    of_gravity = BaseMotion("n2").accelerations(model.scene.mount, model.speed).values()
    weight = abs(model.scene.gravity) * sum(abs(given.get("root_axial", 0.0)) for given in of_gravity)
    along = {
        h: abs(given.get("root_axial", 0.0)) ** 2
        for h, given in excitation.accelerations(model.scene.mount, model.speed).items()
    }
    if not isinstance(spectrum, PowerSpectrum):
        variation, density = (math.inf if any(along.values()) else 0.0), sum(along.values()) * spectrum
    else:
        variation = kappa * math.sqrt(sum(along.values())) * spectrum.rms
        twice = 2 * math.sqrt(squared[0]) / (2 * math.pi)
        turns = model.speed / (2 * math.pi)
        density = sum(
            share * float(spectrum.at(np.array(abs(twice - h * turns)))) for h, share in along.items()
        )
    x = _excess(model, squared[0], shapes[:, 0], kappa**2 * density)
    change = math.inf if x >= 1 else 1 / math.sqrt(1 - x) - 1
    return ParametricTerm(float(variation), float(kappa * weight), change)


def _excess(model: ModelAtSpeed, squared: float, shape: np.ndarray, density: float) -> float:
    """The number x of the lowest mode: 0 where nothing varies."""
    if not density:
        return 0.0
    omega = math.sqrt(squared)
    zeta = float(shape @ model.C @ shape) / (2 * omega)
    return omega * density / (8 * zeta) if zeta > 0 else math.inf
