"""Floquet multipliers of a scene in periodic motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.stability_charts import plot_exponent, plot_multipliers
from beamdyn.common.results.one_line import counted, error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import GROWING, TOLERANCE, Statement, announced_of_plain_beam
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import ModalBasis
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import warn_of_left_out
from beamdyn.studies.floquet.exponents import largest_exponent
from beamdyn.studies.floquet.monodromy import COARSER, check_periodic, meet_again
from beamdyn.studies.floquet.multipliers import STABLE, UNSTABLE, multipliers_of

MULTIPLIERS, EXPONENT = "multipliers", "exponent"
_ON_CIRCLE = "stability is not decided: multipliers meet, or lie on the unit circle, within their errors"
# The growth rate has settled if its last change is below this share of its change by more modes in all.
_SETTLED, _MOST_REFINEMENTS = 0.25, 4
_BOUNDED = "stability is not decided: the largest exponent is 0 within its error"


@dataclass(frozen=True)
class FloquetMultipliers(SceneResult, JudgedByRepeating):
    """Floquet multipliers of free vibration about a periodic motion: its growth factors over one period.

    `left_out` contains the estimated relative change of the magnitude of the largest multiplier by each
    neglected physical effect, `model_error` the magnitude of the sum of these changes; both are computed at
    first use.

    Parameters
    ----------
    status : {"stable", "unstable", "undecided"}
        Whether free vibration decays or, without damping, stays bounded, as the multipliers and their errors
        show; otherwise "undecided".
    growth_rate : float
        Largest growth rate of free vibration [1/s]; 0 for stable motion without damping.
    growth_rate_error : float
        Estimated error of the growth rate [1/s], for the modes in the model; see `mode_error`.
    multipliers : ndarray of complex, shape (2 n,)
        Nondimensional multipliers, the largest first.
    multiplier_errors : ndarray, shape (2 n,)
        Estimated errors of the multipliers, nondimensional.
    krein_sign : ndarray, shape (2 n,)
        Without damping 1 or -1 for multipliers on the unit circle, which leave it only where they meet one of
        the other sign; 0 for others.
    period : float
        Period of the equations of motion [s]; with `method` "exponent" that of the faster phase.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.
    method : {"multipliers", "exponent"}
        "multipliers" for a periodic motion; for two angular frequencies without a common period "exponent":
        bounds of the largest Lyapunov exponent, and no multipliers.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> motion = bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=123.9)
    >>> found = bd.floquet_multipliers(bd.Scene(strip, bd.Mount(radius=0.215), motion), modes=2)
    >>> found.status, round(found.growth_rate, 3)  # 1/s
    ('unstable', 2.107)
    """

    status: str
    growth_rate: float
    growth_rate_error: float
    multipliers: np.ndarray
    multiplier_errors: np.ndarray
    krein_sign: np.ndarray
    period: float
    modes: int = field(repr=False)
    method: str = field(default=MULTIPLIERS, metadata=ADDED_LATER)

    judged_value = "the largest multiplier"
    follows_stiffness: ClassVar[bool] = False

    def headline(self) -> Iterator[str]:
        """Yield status, growth rate and its error, the parts of the result's one-line summary.

        See `Result.headline`.
        """
        by = " by its largest exponent" if self.method == EXPONENT else ""
        yield f"{self.status}{by}, growth rate {number(self.growth_rate, '1/s')}"
        yield from (error_at_most(self.growth_rate_error, "1/s"), warned(self.warnings))

    @property
    def spectral_radius(self) -> float:
        """Growth factor of free vibration over a period, from the largest multiplier or the growth rate."""
        known = self.method == MULTIPLIERS
        return float(np.abs(self.multipliers).max()) if known else math.exp(self.growth_rate * self.period)

    @cached_property
    def mode_error(self) -> float:
        """Estimated error of the growth rate by neglected modes [1/s], from solutions with more modes.

        It is the largest distance from these, plus twice their last change; inf if there is no larger model.
        """
        rates = [self.growth_rate, *(more.growth_rate for more in self._with_more_modes)]
        return _span(rates) + 2 * abs(rates[-1] - rates[-2]) if len(rates) > 1 else math.inf

    @cached_property
    def _with_more_modes(self) -> tuple[FloquetMultipliers, ...]:
        """Results with more and more modes, until the growth rate settles; empty if there are none.

        Each has half as many modes more, at least two.  A single one may agree by chance, or lack the mode
        with which a kept one resonates.
        """
        found, basis, rates = [], ModalBasis(self.modes).refined(), [self.growth_rate]
        while basis is not None and self.again is not None and len(found) < _MOST_REFINEMENTS:
            found.append(self.again(self.scene, modes=basis.modes))
            rates.append(found[-1].growth_rate)
            basis = None if abs(rates[-1] - rates[-2]) <= _SETTLED * _span(rates) else basis.refined()
        return tuple(found)

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """List warnings of another verdict with more modes, and those of the model error."""
        said = "with {0.modes} modes the motion is {0.status}, with a growth rate of {0.growth_rate:.4g} 1/s"
        verdicts = [
            Statement(said.format(more), kind=TOLERANCE, quantity="growth rate", value=more.growth_rate)
            for more in self._with_more_modes[-1:]
            if {more.status, self.status} == {STABLE, UNSTABLE}
        ]
        return verdicts + super().model_warnings(tolerance)

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, including `mode_error`."""
        return {**super().to_dict(), "mode_error": self.mode_error}

    def judged(self, found: FloquetMultipliers) -> np.ndarray:
        """Return the magnitude of the largest multiplier of `found`, shape ().

        It is the value whose model error is stated.
        """
        return np.array(found.spectral_radius)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers and the unit circle in the complex plane; without any, the exponent."""
        if self.method == EXPONENT:
            return plot_exponent(self.growth_rate, self.growth_rate_error, ax)
        return plot_multipliers(self.multipliers, self.multiplier_errors, self.krein_sign, ax)


def _span(rates: Sequence[float]) -> float:
    """Return the largest distance of growth rates [1/s] from the first."""
    return max(abs(rate - rates[0]) for rate in rates)


@announced_of_plain_beam
@repeatable
@one_blas_thread()  # with small matrices, further threads only slow each other down
def floquet_multipliers(
    scene: Scene, modes: int = 3, discretization: DiscretizationChoice = "ritz"
) -> FloquetMultipliers:
    """Compute the Floquet multipliers of a scene in periodic motion, and whether the motion is stable.

    The monodromy matrix of the equations in modes at rest is integrated over a period by Gauss collocation of
    order 16; forcing does not affect stability, and is omitted.

    Parameters
    ----------
    scene : Scene
        The scene, in a periodic motion, such as `PulsatingRotation` or `ShakenCarrier`, or in steady rotation
        with gravity.  If two frequencies of motion, road and gravity have no common period, the largest
        Lyapunov exponent is used: see `method`.
    modes : int
        Number of modes at rest of each uncoupled displacement, such as bending in each plane.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    FloquetMultipliers

    Raises
    ------
    ValueError
        If there is no motion, it has more than two frequencies without a common period, or an argument is out
        of its range.

    References
    ----------
    Theory of Floquet, and of Krein for undamped motion (standard): Nayfeh and Mook (1979), Nonlinear
    Oscillations, chapter 5; integrated as Hairer, Lubich and Wanner (2006), section II.1.3; bounds of the
    exponent by Goldstein and Schlag (2001), Annals of Mathematics 154, 155-203.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> shaken = bd.ShakenCarrier(frequency=50.0, along_n1=10.0)
    >>> bd.floquet_multipliers(bd.Scene(strip, motion=shaken), modes=1).status
    'stable'
    """
    start = perf_counter()
    scenes = check_periodic(scene, modes, discretization)
    scene, (model, _) = scenes.scene, scenes.modal(scenes.scene)
    if meet_again(scene):
        kind, how, why = MULTIPLIERS, "Gauss collocation of order 16", _ON_CIRCLE
        found = multipliers_of(scenes.monodromy({}))
        value, errors, period = found.value[0], found.error[0], float(found.period[0])
        sign = np.zeros(len(value)) if found.sign is None else found.sign[0]
        status, (rate, error) = str(found.verdict[0]), map(float, np.ravel(found.growth))
    else:
        kind, how, why = EXPONENT, "largest Lyapunov exponent over two phases", _BOUNDED
        rate, error, status, period = largest_exponent(scene, scenes.equations(scene))
        value, errors, sign = np.zeros(0, dtype=complex), np.zeros(0), np.zeros(0)
    method = f"{model.discretization}, {counted(scenes.modes, 'mode')}, {how}"
    return FloquetMultipliers(
        status=status,
        growth_rate=rate,
        growth_rate_error=error,
        multipliers=value,
        multiplier_errors=errors,
        krein_sign=sign,
        period=period,
        warnings=tuple(_warnings(scene, status, rate, error, why)),
        provenance=Provenance.since(start, method, COARSER),
        modes=scenes.modes,
        scene=scene,
        method=kind,
    )


def _warnings(scene: Scene, status: str, rate: float, error: float, why: str) -> Iterator[Statement]:
    """Yield warnings about the result: neglected effects, growth, and why stability is undecided."""
    yield from warn_of_left_out(scene)
    said = {"quantity": "growth rate", "value": rate}
    if status == UNSTABLE:
        yield Statement(f"free motion grows by {rate:.4g} 1/s", kind=GROWING, **said)
    elif status != STABLE:
        yield Statement(why, kind=TOLERANCE, limit=error, **said)
