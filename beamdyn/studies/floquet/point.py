"""Floquet multipliers of a scene in periodic motion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.stability_charts import plot_multipliers
from beamdyn.common.results.one_line import error_at_most, number, warned
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import GROWING, TOLERANCE, Statement, announced_of_plain_beam
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.modal_basis import ModalBasis
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_left_out
from beamdyn.studies.floquet.monodromy import COARSER
from beamdyn.studies.floquet.multipliers import STABLE, UNSTABLE, multipliers_of
from beamdyn.studies.floquet.periodic_scenes import check_periodic

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class FloquetMultipliers(JudgedByRepeating):
    """Floquet multipliers of free motion about a periodic motion: factors of its growth over a period.

    `model_error` and `left_out`, computed when asked for, are what the physics left out would change in the
    size of the largest multiplier.

    Parameters
    ----------
    status : {"stable", "unstable", "undecided"}
        Whether free motion decays, or without damping stays bounded: shown by the multipliers and their
        errors, else "undecided".
    growth_rate : float
        Largest growth rate of free motion [1/s]; 0 without damping where it is stable.
    growth_rate_error : float
        Its estimated error [1/s], of the modes that are kept; see `mode_error`.
    multipliers : ndarray of complex, shape (2 n,)
        The nondimensional multipliers, the largest first.
    multiplier_errors : ndarray, shape (2 n,)
        Their estimated errors, nondimensional.
    krein_sign : ndarray, shape (2 n,)
        Without damping 1 or -1 for multipliers on the unit circle, which leave it only where they meet one of
        the other sign; 0 of others.
    period : float
        Period of the equations of motion [s].
    warnings : tuple of str
        Limitations of the result.
    provenance : Provenance
        How it was computed.

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
    warnings: tuple[str, ...]
    provenance: Provenance
    modes: int = field(repr=False)
    scene: Scene = field(repr=False)

    judged_value = "the largest multiplier"
    follows_stiffness: ClassVar[bool] = False

    def headline(self) -> Iterator[str]:
        """Verdict, growth rate and its error in one line; see `Result.headline`."""
        yield f"{self.status}, growth rate {number(self.growth_rate, '1/s')}"
        yield from (error_at_most(self.growth_rate_error, "1/s"), warned(self.warnings))

    @property
    def spectral_radius(self) -> float:
        """Size of the largest multiplier: the growth of free motion over a period."""
        return float(np.abs(self.multipliers[0]))

    @cached_property
    def mode_error(self) -> float:
        """Estimated error of the growth rate by the modes left out [1/s], by a solution with more modes.

        It is twice the change by half as many modes more, at least two; inf if there is no larger model.
        """
        finer = ModalBasis(self.modes).refined()
        if finer is None or self.again is None:
            return math.inf
        return 2 * abs(self.again(self.scene, modes=finer.modes).growth_rate - self.growth_rate)

    def judged(self, found: FloquetMultipliers) -> np.ndarray:
        """Size of the largest multiplier, of which the model error is stated: shape ()."""
        return np.array(found.spectral_radius)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers and the unit circle in the complex plane."""
        return plot_multipliers(self.multipliers, self.multiplier_errors, self.krein_sign, ax)


@announced_of_plain_beam
@repeatable
@one_blas_thread()  # the matrices are small: more threads only wait for each other
def floquet_multipliers(
    scene: Scene, modes: int = 3, discretization: DiscretizationChoice = "ritz"
) -> FloquetMultipliers:
    """Compute the Floquet multipliers of a scene in periodic motion, and whether it is stable.

    The monodromy matrix of the equations in modes at rest is integrated over a period by Gauss collocation of
    order 16; forcing does not matter to stability, and is left out.

    Parameters
    ----------
    scene : Scene
        The scene, in a motion that repeats itself, such as `PulsatingRotation` or `ShakenCarrier`, or in
        steady rotation with gravity.  The phases of motion, road and gravity must meet again.
    modes : int
        Number of modes at rest of each field.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.

    Returns
    -------
    FloquetMultipliers

    Raises
    ------
    ValueError
        If there is no motion, it does not repeat itself, or an argument is out of its range.

    References
    ----------
    Theory of Floquet, and of Krein for undamped motion (standard): Nayfeh and Mook (1979), Nonlinear
    Oscillations, chapter 5; integrated as Hairer, Lubich and Wanner (2006), section II.1.3.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> shaken = bd.ShakenCarrier(frequency=50.0, along_n1=10.0)
    >>> bd.floquet_multipliers(bd.Scene(strip, motion=shaken), modes=1).status
    'stable'
    """
    start = perf_counter()
    scenes = check_periodic(scene, modes, discretization)
    scene, multipliers = scenes.scene, multipliers_of(scenes.monodromy({}))
    status, (rate, error) = str(multipliers.verdict[0]), map(float, np.ravel(multipliers.growth))
    model, _ = scenes.modal(scene)
    method = f"{model.discretization}, {scenes.modes} modes, Gauss collocation of order 16"
    sign = np.zeros(multipliers.value.shape[1]) if multipliers.sign is None else multipliers.sign[0]
    return FloquetMultipliers(
        status=status,
        growth_rate=rate,
        growth_rate_error=error,
        multipliers=multipliers.value[0],
        multiplier_errors=multipliers.error[0],
        krein_sign=sign,
        period=float(multipliers.period[0]),
        warnings=tuple(_warnings(scene, status, rate, error)),
        provenance=Provenance(__version__, method, COARSER, perf_counter() - start),
        modes=scenes.modes,
        scene=scene,
    )


def _warnings(scene: Scene, status: str, rate: float, error: float) -> Iterator[Statement]:
    """Yield what limits the answer."""
    yield from warn_of_left_out(scene)
    said = {"quantity": "growth rate", "value": rate}
    if status == UNSTABLE:
        yield Statement(f"free motion grows by {rate:.4g} 1/s", kind=GROWING, **said)
    elif status != STABLE:
        why = "stability is not decided: multipliers meet, or lie on the unit circle, within their errors"
        yield Statement(why, kind=TOLERANCE, limit=error, **said)
