"""Frequency loci: natural modes followed over speed.

In shapes of arrays, S counts speeds, m modes, and k speeds at which the model error is computed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import ascending, count, within
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.plots import plot_locus, plot_locus_by_plane
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.one_line import counted, error_at_most, spanned, states, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import announced
from beamdyn.equations.effects import first_drawn
from beamdyn.modes.modal.discretization_choice import TOLERANCES, DiscretizationChoice, solve_to_tolerance
from beamdyn.modes.modal.model import (
    BENDING,
    OTHER_KINDS,
    Model,
    TellsKinds,
    kinds_of_modes,
    plane_share,
    static_load,
)
from beamdyn.modes.modal.solvers import track
from beamdyn.modes.model_error.effect_choice import choose_physics
from beamdyn.modes.model_error.left_out_changes import left_out_with_modes
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.modes.modes import drawn_order, frequency_of, provenance_of, status_of, warn_of_modes
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.scene.validity import check_speeds

_MOST_JUDGED = 16  # largest number of speeds of a locus at which the model error is computed
_EXTRA_MODES = 2  # number of additional higher modes, with which the requested modes may exchange their order


@dataclass(frozen=True)
class Locus(TellsKinds, SceneResult, StatesModelError):
    """Modes followed over speed through crossings and veerings, numbered by their order at the first speed.

    `error` is the numerical error.  `left_out` contains the estimated relative change of each frequency by
    each neglected physical effect at the `left_out_speeds` (k,), `model_error` (k, modes) the magnitude of
    the sum of these changes; both are computed at first use, and `left_out_at` computes the changes at other
    speeds.  `kind` (S, modes) is "bending", "torsion" or "camber" as in `Modes`, at each speed: modes
    exchange their kinds at a veering.

    Parameters
    ----------
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    frequency : ndarray, shape (S, modes)
        Frequencies [Hz]; nan where a mode is unstable or does not oscillate.
    growth_rate : ndarray, shape (S, modes)
        Growth rates [1/s].
    confidence : ndarray, shape (S, modes)
        Confidence that a mode continues the one at the speed before: 1 is certain, 0 a guess.
    error : ndarray, shape (S, modes)
        Estimated relative error of the eigenvalues.
    status : ndarray of str, shape (S, modes)
        "stable", "divergence", "flutter", "overdamped", or "neutral" (a free rotation with the frequency 0).
    eigenvalue : ndarray of complex, shape (S, modes)
        Eigenvalue s of the motion exp(s t) [1/s].
    plane_share : ndarray, shape (S, modes, 2)
        Fraction of the kinetic energy of the mode's deflection in each direction of bending at the root.
    static_deflection : ndarray, shape (S,)
        Static tip deflection under the rotation [m], signed or a magnitude as in `Modes`.
    axial_strain : ndarray, shape (S,)
        Largest static axial strain; nan if it is unknown.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> locus = bd.frequency_locus(bd.Scene(strip, bd.Mount(radius=0.215)), np.linspace(0, 200, 5), modes=1)
    >>> locus.frequency[:, 0].round(2), locus.growth_rate[:, 0].round(2)  # past 159.8 rad/s it buckles
    (array([65.23, 61.96, 50.91, 22.54,   nan]), array([  0.  ,   0.  ,   0.  ,   0.  , 308.99]))
    """

    speeds: np.ndarray
    frequency: np.ndarray
    growth_rate: np.ndarray
    confidence: np.ndarray
    error: np.ndarray
    status: np.ndarray
    eigenvalue: np.ndarray
    plane_share: np.ndarray
    static_deflection: np.ndarray
    axial_strain: np.ndarray
    model: Model = field(repr=False)
    # Eigenvalues (S, k) in ascending order, including additional higher modes.
    ascending: np.ndarray = field(repr=False)
    place: np.ndarray = field(repr=False)  # index of each mode in `ascending` (S, m)
    kinds: np.ndarray | None = field(default=None, repr=False, metadata=ADDED_LATER)

    def headline(self) -> Iterator[str]:
        """Yield the parts of the one-line summary of the locus; see `Result.headline`."""
        count, modes = self.frequency.shape
        yield f"{counted(modes, 'mode')}, {counted(count, 'speed')}, {self.say_speed(self.speeds)}"
        yield spanned(self.frequency, "Hz")
        yield error_at_most(self.error)
        yield from (states(self.status, ("stable", "neutral")), warned(self.warnings))

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Changes of frequencies at the `left_out_speeds` by each neglected effect: (speeds, modes)."""
        return self.left_out_at(self._judged)

    @property
    def left_out_speeds(self) -> np.ndarray:
        """Speeds of the locus at which the model error is computed [rad/s].

        They are spread evenly from the first to the last speed, with the speeds before and after a mode
        becomes unstable or stable.
        """
        return self.speeds[self._judged]

    @property
    def _judged(self) -> np.ndarray:
        """Indices of the speeds at which the model error is computed."""
        changed = (self.status[1:] != self.status[:-1]).any(axis=1)
        before = np.flatnonzero(changed)[:_MOST_JUDGED]
        spread = evenly_spread(len(self.speeds), _MOST_JUDGED)
        return np.unique(np.concatenate([spread, before, before + 1]))

    def left_out_at(self, indices: Sequence[int] | np.ndarray) -> LeftOutEffects:
        """Estimate the changes by neglected effects at the speeds with given indices: (speeds, modes)."""
        at = np.asarray(indices, dtype=int)
        return left_out_with_modes(self.model, self.speeds[at], self.eigenvalue[at])

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, with model error and neglected effects."""
        return super().to_dict() | {"left_out_speeds": self.left_out_speeds.tolist()}

    def names(self) -> tuple[str, ...]:
        """Return the names of the modes: the number, and the kind unless it is bending at the first speed."""
        kinds = (f", {kind}" if kind != BENDING else "" for kind in self.kind[0])
        return tuple(f"mode {i}{kind}" for i, kind in enumerate(kinds, 1))

    @property
    def main_motions(self) -> np.ndarray:
        """Number of the main motion of each mode at each speed: (speeds, modes).

        Bending in the directions that are drawn solid and dashed is 0 and 1; torsion and camber are 2 and 3.
        """
        solid = first_drawn(self.scene) if self.scene.physics.planes == 2 else 0
        motions = np.where(self.plane_share[:, :, solid] >= 0.5, 0, 1)
        for number, kind in enumerate(OTHER_KINDS, 2):
            motions[self.kind == kind] = number
        return motions

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the frequencies of all modes over speed."""
        units, names = self.display_units, self.names()
        if self.scene.physics.planes == 2:
            words, kinds = (*drawn_order(self.scene)[1], *OTHER_KINDS), self.main_motions
            return plot_locus_by_plane(self.speeds, self.frequency, kinds, words, ax, names, units)
        return plot_locus(self.speeds, self.frequency, ax, names, units=units)


@announced
@one_blas_thread()  # with small matrices, further threads only slow each other down
def frequency_locus(
    scene: Scene,
    speeds: np.ndarray | Sequence[float] | float,
    modes: int = 3,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Locus:
    """Compute natural frequencies over speed, and follow the modes.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speeds : sequence of float
        Speeds [rad/s], ascending.
    modes : int
        Number of modes to follow.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`; met at every speed.

    Returns
    -------
    Locus

    Raises
    ------
    ValueError
        If an argument is out of its range.

    References
    ----------
    As `natural_modes`; between Chebyshev points of the speed by interpolation (standard).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> locus = bd.frequency_locus(bd.Scene(strip, bd.Mount(radius=0.215)), [0.0, 50.0, 100.0], modes=1)
    >>> locus.frequency[:, 0].round(3)  # Hz
    array([65.23 , 61.963, 50.907])
    """
    start = perf_counter()
    check_scene(scene)
    speeds, modes = ascending("speeds", speeds), count("modes", modes)
    check_speeds(speeds)
    tolerance = None if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    scene = choose_physics(scene, speeds, modes, tolerance)
    solution = solve_to_tolerance(scene, discretization, speeds, modes, tolerance, _EXTRA_MODES)
    order, confidence = track(solution.eigen.vector, solution.model.solver.pencil.M)
    s, followed = np.take_along_axis(solution.eigen.eigenvalue, order, axis=1)[:, :modes], order[:, :modes]
    # An additional mode gets the largest error of all modes at the same speed.
    errors = np.repeat(solution.error.max(axis=1, keepdims=True), followed.max(initial=0) + 1, axis=1)
    errors[:, :modes] = solution.error[:, : errors.shape[1]]
    error = np.take_along_axis(errors, followed, axis=1)
    shares = plane_share(solution.model.equations, solution.eigen.vector)
    kinds = kinds_of_modes(solution.model.equations, solution.eigen.vector)
    growth_rate = np.real(s) + 0.0
    deflection, strain = static_load(solution.model, speeds)
    return Locus(
        speeds=speeds,
        frequency=frequency_of(s),
        growth_rate=growth_rate,
        confidence=confidence[:, :modes],
        error=error,
        status=status_of(s),
        eigenvalue=s,
        plane_share=np.take_along_axis(shares, followed[:, :, None], axis=1),
        static_deflection=deflection,
        axial_strain=strain,
        warnings=tuple(
            warn_of_modes(solution.model, speeds, deflection, strain, error, growth_rate, tolerance)
        ),
        provenance=provenance_of(solution, start),
        scene=scene,
        model=solution.model,
        ascending=solution.eigen.eigenvalue,
        place=followed,
        kinds=None if kinds is None else np.take_along_axis(kinds, followed, axis=1),
    )
