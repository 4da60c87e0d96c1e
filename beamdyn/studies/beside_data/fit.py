"""Bounded least squares on natural frequencies: residuals, their derivatives, and the search for the minimum.

A residual is the difference of computed and measured frequency, divided by a weight [Hz].  Its derivatives
follow from the eigenproblem, s' = -w^T dP v / (w^T (2 s M + C + omega G) v) (Lancaster 1966, section 7), for
the eigenvalue s of the dynamic stiffness P(s) with its right and left eigenvectors v and w, where dP is the
difference between the matrices of two nearly equal scenes.  So only matrices are differenced, not
eigenvalues.

In shapes of arrays, p counts variables, S speeds, n computed and m measured frequencies at each, and N pairs.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.optimize import least_squares

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.statements import unannounced
from beamdyn.common.spreading.statistics import seeded
from beamdyn.common.words import Named
from beamdyn.equations.discretization import Discretization
from beamdyn.modes.modal.model import Model, kinds_of_modes
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.scene.measured_frequencies import MeasuredFrequencies
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import refuse_large_deflection
from beamdyn.studies.beside_data.free_numbers import FreeNumber, opened
from beamdyn.studies.beside_data.pairing import NO_MODE, likeness_of, likeness_of_kinds, pair
from beamdyn.studies.sensitivities.changes import PencilChange, PerturbedModes, equations_near

_STEP = 1e-4  # step of central differences of the matrices, for variables of size 1
_HZ = 1 / (2 * np.pi)
# Number of computed modes in excess of the measured ones, among which matching modes are searched.
_MORE_MODES = 3
_TRIED = 4  # number of trial points (values of all variables) for each start of a fit
_PAIRINGS = 3  # number of times that measured frequencies are paired again within a fit


def _check_linear(scene: Scene) -> None:
    """Refuse large deflection: before anything is computed, and again where physics "auto" has chosen it."""
    bound = "a fit needs derivatives, which are computed for linear equations only"
    refuse_large_deflection(scene, bound, ", or try values by ", Named("bd.study", "beamdyn study"))


@dataclass(frozen=True)
class Fitting:
    """Fitting problem: frequencies of a scene at some speeds, and numbers of the scene that may change.

    Parameters
    ----------
    scene : Scene
        The scene.
    data : MeasuredFrequencies
        The measured frequencies.
    numbers : tuple of FreeNumber
        The p numbers that may change.
    weight : ndarray, shape (speeds, measured)
        Weights [Hz] by which residuals are divided.
    tolerance : float
        Relative change of variables and of the sum of squares below which a fit ends.
    """

    scene: Scene
    data: MeasuredFrequencies
    numbers: tuple[FreeNumber, ...]
    weight: np.ndarray
    tolerance: float = 1e-12
    solved: list[int] = field(default_factory=lambda: [0])  # number of eigenproblems solved so far

    @cached_property
    def modes(self) -> int:
        """Number of modes computed at each speed."""
        return self.data.frequency.shape[1] + _MORE_MODES

    @cached_property
    def _fastest(self) -> Modes:
        """Modes at the highest speed, whose basis and physics suffice at all speeds.

        A root spring or tip body that the scene lacks is added if one of its parameters is fitted.
        """
        opening = opened(self.scene, [number.path for number in self.numbers])
        _check_linear(opening)
        with unannounced():
            found = natural_modes(opening, float(np.abs(self.data.speeds).max()), self.modes)
        _check_linear(found.scene)
        return found

    @property
    def start(self) -> Scene:
        """Scene from which fits start, with its physics chosen if it was "auto"."""
        return self._fastest.scene

    @property
    def discretization(self) -> Discretization:
        """Basis in which all scenes of the fit are solved."""
        return self._fastest.model.discretization

    def scene_at(self, x: Sequence[float] | np.ndarray) -> Scene:
        """Return the scene whose free numbers have the values that belong to the variables x (p,)."""
        pairs = zip(self.numbers, np.asarray(x, dtype=float).tolist(), strict=True)
        values = {number.path: number.number(each) for number, each in pairs}
        return with_numbers(self.start, values) if values else self.start

    def at(self, x: np.ndarray) -> FittedModes:
        """Compute the modes of the scene that belongs to the variables x (p,)."""
        self.solved[0] += 1
        return FittedModes(self, x, Model(self.scene_at(x), self.discretization))

    @property
    def flat(self) -> float:
        """Gradient of the sum of squares that counts as 0: tolerance times median (frequency/weight)^2."""
        return self.tolerance * float(np.nanmedian((self.data.frequency / self.weight) ** 2))

    @property
    def limits(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper limits of the variables."""
        low, high = zip(*(number.limits for number in self.numbers), strict=True)
        return np.array(low), np.array(high)


@dataclass(frozen=True)
class FittedModes:
    """Modes of one scene of a fit, at all measured speeds.

    Parameters
    ----------
    fitting : Fitting
        The fitting problem.
    x : ndarray, shape (p,)
        Values of the variables.
    model : Model
        The discretized scene.
    """

    fitting: Fitting
    x: np.ndarray
    model: Model

    @cached_property
    def _solved(self) -> tuple[np.ndarray, np.ndarray]:
        found = self.model.solver.solve(self.fitting.data.speeds, self.fitting.modes)
        return found.eigenvalue, found.vector

    @property
    def frequency(self) -> np.ndarray:
        """Frequencies [Hz] (speeds, modes); 0 if a mode does not vibrate."""
        return np.abs(np.imag(self._solved[0])) * _HZ

    def pairs(self) -> np.ndarray:
        """Return the index (speeds, measured) of each measured frequency's mode; `NO_MODE` for none."""
        data = self.fitting.data
        rows = range(len(data.speeds))
        return np.array([pair(data.frequency[i], self.frequency[i], self._likeness(i)) for i in rows])

    def _likeness(self, row: int) -> np.ndarray | None:
        """Compute the modal assurance criterion of measured and computed shapes at a speed.

        Return None if no shapes were measured.
        """
        data, equations, vectors = self.fitting.data, self.model.equations, self._solved[1][row]
        if data.shapes is None:
            kinds = kinds_of_modes(equations, vectors[None])
            return likeness_of_kinds(data.labels, None if kinds is None else kinds[0], vectors.shape[1])
        xi = np.asarray(data.positions) / self.model.scene.beam.length
        return likeness_of(data.shapes, vectors.T @ equations.deflection(np.minimum(xi, 1.0)))

    def residual(self, pairs: np.ndarray) -> np.ndarray:
        """Compute the residuals of paired frequencies: differences divided by their weights."""
        rows, columns = np.nonzero(pairs != NO_MODE)
        off = self.frequency[rows, pairs[rows, columns]] - self.fitting.data.frequency[rows, columns]
        return off / self.fitting.weight[rows, columns]

    def derivative(self, pairs: np.ndarray) -> np.ndarray:
        """Compute derivatives (pairs, variables) of the residuals of pairs with respect to the variables."""
        rows, columns = np.nonzero(pairs != NO_MODE)
        pencil, speeds = self.model.equations.steady(), self.fitting.data.speeds.tolist()
        modes = [PerturbedModes.of(pencil, *each) for each in zip(speeds, *self._solved, strict=True)]
        each = [[np.imag(at.derivatives(change)) * _HZ for at in modes] for change in self._matrix_changes]
        of_modes = np.nan_to_num(np.array(each))
        found = of_modes[:, rows, pairs[rows, columns]] / self.fitting.weight[rows, columns]
        return found.T.reshape(len(rows), len(self.x))

    @property
    def _matrix_changes(self) -> list[PencilChange]:
        """Derivatives of matrices with respect to each variable: differences of two nearly equal scenes."""
        changes = []
        for k, (least, most) in enumerate(zip(*self.fitting.limits, strict=True)):
            step = _STEP * (self.x[k] if self.fitting.numbers[k].is_compliance else 1.0)
            low, high = max(self.x[k] - step, least), min(self.x[k] + step, most)
            scenes = {
                at: self.fitting.scene_at(np.where(np.arange(len(self.x)) == k, at, self.x))
                for at in (low, self.x[k], high)
            }
            near = {at: equations_near(self.model, scene) for at, scene in scenes.items()}
            # If a point mass passes a breakpoint, the number of basis functions changes: a scene with another
            # number is left out, and the difference is one-sided.
            (low, a), *_, (high, b) = (
                (at, e) for at, e in near.items() if e.size == self.model.equations.size
            )
            changes.append(PencilChange.of([a.steady(), b.steady()], np.array([-1.0, 1.0]) / (high - low)))
        return changes


@dataclass(frozen=True)
class Fitted:
    """Result of one fit: modes, pairs and sum of squares.

    Parameters
    ----------
    modes : FittedModes
        Modes of the fitted scene.
    pairs : ndarray, shape (speeds, measured)
        Indices of the paired modes, as from `FittedModes.pairs`.
    cost : float
        Sum of squared residuals of the pairs.
    """

    modes: FittedModes
    pairs: np.ndarray
    cost: float

    @property
    def rank(self) -> tuple[int, float]:
        """Sort key of fits: fewer frequencies without a mode first, then smaller residuals."""
        return int((self.pairs == NO_MODE).sum()), self.cost


@one_blas_thread()
def fit_from(fitting: Fitting, x: Sequence[float] | np.ndarray, most: int) -> Fitted:
    """Minimize the sum of squares, starting at the variables x; return the fitted modes.

    Measured frequencies are paired with modes again as the scene changes.

    Parameters
    ----------
    fitting : Fitting
        The fitting problem.
    x : sequence of float
        Variables at which the fit starts.
    most : int
        Largest number of scenes whose modes are computed.
    """
    cache: dict[bytes, FittedModes] = {}

    def at(x: np.ndarray) -> FittedModes:
        key = np.asarray(x).tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = fitting.at(np.array(x))
        return cache[key]

    found, end = np.array(x, dtype=float), fitting.solved[0] + most
    pairs = at(found).pairs()
    for _ in range(_PAIRINGS):
        if (pairs == NO_MODE).all() or fitting.solved[0] >= end:
            break
        solved = least_squares(
            lambda x, pairs=pairs: at(x).residual(pairs),
            found,
            lambda x, pairs=pairs: at(x).derivative(pairs),
            bounds=fitting.limits,
            xtol=fitting.tolerance,
            ftol=fitting.tolerance,
            gtol=fitting.flat,
            max_nfev=end - fitting.solved[0],
        )
        found, before = solved.x, pairs
        pairs = at(found).pairs()
        if np.array_equal(pairs, before):
            break
    return _unfitted(at(found))


def fit(fitting: Fitting, starts: int, seed: int, most: int, enough: float) -> Fitted:
    """Return the best of several fits with different starts.

    The starts are the best of several candidates: the scene's own numbers, and random ones.  The best have
    the fewest frequencies without a mode, and among these the smallest sum of squared residuals.

    Parameters
    ----------
    fitting : Fitting
        The fitting problem.
    starts : int
        Largest number of starts.
    seed : int
        Seed of the random starts.
    most : int
        Largest number of scenes whose modes are computed, in total over all fits.
    enough : float
        Sum of squared residuals below which no further fit is started.
    """
    best: Fitted | None = None
    for first in _nearest(fitting, starts, seed):
        left = most - fitting.solved[0]
        if left < 2 and best is not None:
            break
        found = fit_from(fitting, first, max(left, 2))
        best = found if best is None or found.rank < best.rank else best
        if best.rank[0] == 0 and best.cost <= enough:
            break
    assert best is not None
    return best


def _nearest(fitting: Fitting, starts: int, seed: int) -> list[np.ndarray]:
    """Return the variables (p,) at which fits start, those with the smallest sum of squares first."""
    from scipy.stats.qmc import LatinHypercube  # the import is inside the function because it takes long

    numbers = fitting.numbers
    rows = _TRIED * starts if len(numbers) > 1 else starts - 1
    shares = seeded(LatinHypercube, len(numbers), seed).random(rows)
    tried = [np.array([n.first for n in numbers])]
    tried += [
        np.array([n.place(share) for n, share in zip(numbers, each, strict=True)]) for each in shares.tolist()
    ]
    ranked = [(_unfitted(fitting.at(tried[0])).rank, 0)]
    for k, x in enumerate(tried[1:], 1):
        with suppress(InvalidValue):  # no scene, such as a thickness beyond the width
            ranked.append((_unfitted(fitting.at(x)).rank, k))
    return [tried[k] for _, k in sorted(ranked)[:starts]]


def _unfitted(modes: FittedModes) -> Fitted:
    """Build the result of a fit without steps: unchanged modes, their pairs and sum of squares."""
    pairs = modes.pairs()
    return Fitted(modes, pairs, float((modes.residual(pairs) ** 2).sum()))
