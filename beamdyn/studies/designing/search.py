"""Search of an inverse design: numbers as fractions of their ranges, and the best of all computed designs.

Logarithms of numbers and results are used, so that powers become linear.  All computed designs are kept, and
the best one is the result.

In shapes of arrays, N counts designs, p unknowns (numbers to be found), and m targets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import minimize, toms748
from scipy.stats.qmc import LatinHypercube

from beamdyn.common.inputs.checks import NoModelAnswer
from beamdyn.common.inputs.described import VariedInput
from beamdyn.common.results.statements import unannounced
from beamdyn.common.spreading.statistics import seeded
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene
from beamdyn.studies.designing.target import Asked, Target
from beamdyn.studies.resonance_speeds import NO_RESONANCE
from beamdyn.studies.study import study
from beamdyn.studies.study_result import Study

MOST_SOLVES = 60  # largest number of designs that a search computes
_EXACT = 1e-10  # relative miss below which a target is met, if the error of the result is not larger
_STEP = 1e-5  # step of differences within a search, as a fraction of the range of a free number
DIFFERENCE = 1e-3  # step of differences for the derivatives of results, as a fraction of a number's range
_CLOSE = 1e-13  # interval to which a root is bracketed, as a fraction of the range of a number
# Distance from a bound within which a minimum counts as being at the bound, as a fraction of a number's
# range.
_AT_END = 1e-9
_SCANNED, _SPREAD = 9, 4  # number of first designs: for a single free number, and for each of several numbers
_ROUNDING = 4 * np.finfo(float).eps
_FLAT = 1e-12  # change of the objective below which a minimization ends
# Largest miss, as a logarithm, that Newton's steps remove, and the number of these steps.
_NEARLY, _CORRECTIONS = 1e-2, 2
_STARTS = 3  # number of starts of the minimization, from the best known designs

Function = Callable[[np.ndarray], np.ndarray]  # function from designs (N, p) to an array with N rows


class Spent(Exception):
    """Raised when the search has computed the largest allowed number of designs."""


@dataclass(frozen=True)
class Ranges:
    """Numbers of a scene as fractions, 0 to 1, of the ranges between their bounds.

    The fractions are of logarithms if both bounds are positive.

    Parameters
    ----------
    inputs : tuple of VariedInput
        The p numbers, whose two values are their bounds.
    """

    inputs: tuple[VariedInput, ...]

    @cached_property
    def _ends(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        low, high = np.array([each.values for each in self.inputs]).T
        return low, high, low > 0

    def values(self, shares: np.ndarray) -> np.ndarray:
        """Convert fractions of the ranges to values [unit] (..., numbers)."""
        low, high, positive = self._ends
        ratio = np.where(positive, high / np.where(positive, low, 1.0), 1.0)
        found = np.where(positive, low * ratio**shares, low + (high - low) * shares)
        return np.where(shares >= 1 - _CLOSE, high, np.where(shares <= _CLOSE, low, found))

    def shares(self, values: np.ndarray) -> np.ndarray:
        """Convert values to fractions of the ranges, clipped to the bounds."""
        low, high, positive = self._ends
        values = np.clip(values, low, high)
        safe = [np.where(positive, each, 1.0) for each in (values, low, high)]
        of_logarithms = np.log(safe[0] / safe[1]) / np.where(positive, np.log(safe[2] / safe[1]), 1.0)
        return np.where(positive, of_logarithms, (values - low) / (high - low))

    def slopes(self, shares: np.ndarray) -> np.ndarray:
        """Compute derivatives [unit] of the numbers with respect to their fractions of the ranges."""
        low, high, positive = self._ends
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(positive, self.values(shares) * np.log(high / low), high - low)


@dataclass(frozen=True)
class Search:
    """Search for a design, which stores all designs that it has computed.

    Parameters
    ----------
    scene : Scene
        The scene.
    ranges : Ranges
        The numbers of the scene that are free, with their ranges.
    targets : tuple of Target
        Targets of the design.
    own : ndarray, shape (p,)
        Numbers of the given scene, as fractions of the ranges.
    discretization, tolerance
        As for `study`.
    spare : int
        Number of designs that are reserved for the last steps.
    """

    scene: Scene
    ranges: Ranges
    targets: tuple[Target, ...]
    own: np.ndarray
    discretization: DiscretizationChoice
    tolerance: float | None
    spare: int = 0
    _computed: dict[bytes, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)

    # Results of designs ----------------------------------------------------------------------------

    @cached_property
    def asked(self) -> dict[Asked, list[int]]:
        """Questions for studies, each with the indices of the targets that need the result."""
        found: dict[Asked, list[int]] = {}
        for k, target in enumerate(self.targets):
            found.setdefault(target.asked, []).append(k)
        return found

    def studied(self, asked: Asked, shares: np.ndarray) -> Study:
        """Run the study that answers a question for designs (in rows), given as fractions of ranges."""
        values = self.ranges.values(shares)
        vary = {each.name: values[:, k] for k, each in enumerate(self.ranges.inputs)}
        of = [self.targets[k] for k in self.asked[asked]]
        modes = max(each.mode for each in of) if of[0].has_modes else None
        how = {"discretization": self.discretization, "tolerance": self.tolerance, "combine": "zip"}
        with unannounced():
            return study(self.scene, vary, **asked._asdict(), modes=modes, **how)

    def _answers(self, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute results (nan if there is none, inf above the top speed) and relative errors of designs."""
        value = np.full((len(shares), len(self.targets)), np.nan)
        error = np.zeros(value.shape)
        for asked, targets in self.asked.items():
            try:
                found = self.studied(asked, shares)
            except NoModelAnswer:
                continue
            for k in targets:
                place = self.targets[k].place(found.labels)
                if place is not None:
                    # Without a crossing up to the top speed the result is inf.
                    beyond = np.where(found.status == NO_RESONANCE, np.inf, found.value)
                    value[:, k], error[:, k] = (
                        each.reshape(len(shares), -1)[:, place] for each in (beyond, found.error)
                    )
        return value, np.where(np.isnan(error), 0.0, error)

    def known(self, shares: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return results and relative errors (N, m) of designs (N, p).

        Designs that are not yet known are computed together.

        Raises
        ------
        Spent
            If there are more such designs than the search may still compute.
        """
        new = np.array([x for x in shares if x.tobytes() not in self._computed])
        if len(new):
            if self.solves + len(new) > MOST_SOLVES - self.spare:
                raise Spent
            rows = zip(new, *self._answers(new), strict=True)
            self._computed.update({x.tobytes(): (value, error) for x, value, error in rows})
        each = [self._computed[x.tobytes()] for x in shares]
        return np.array([value for value, _ in each]), np.array([error for _, error in each])

    def excess(self, shares: np.ndarray) -> np.ndarray:
        """Compute by how much designs exceed the targets (designs, targets); see `Target.excess`."""
        value, _ = self.known(shares)
        return np.array([each.excess(value[:, k]) for k, each in enumerate(self.targets)]).T

    # All designs ------------------------------------------------------------------------------------

    @property
    def solves(self) -> int:
        """Number of designs computed, including those for the derivatives of the best design."""
        return len(self._computed) + 2 * len(self.own) + 1

    @property
    def designs(self) -> np.ndarray:
        """Fractions of the ranges (designs, numbers) of all designs computed so far."""
        return np.array([np.frombuffer(key) for key in self._computed])

    def missed(self, shares: np.ndarray) -> np.ndarray:
        """Compute by how much designs miss targets (designs, targets), 0 below 1e-10; see `Target.missed`."""
        excess = self.excess(shares)
        missed = np.array([each.missed(excess[:, k]) for k, each in enumerate(self.targets)]).T
        return np.where(missed <= _EXACT, 0.0, missed)

    def met(self, shares: np.ndarray) -> np.ndarray:
        """Return whether each design (row) meets each target (column), within the errors of the results."""
        error = self.known(shares)[1]
        return self.missed(shares) <= np.where(np.isfinite(error), error, 0.0)

    def aim(self, shares: np.ndarray) -> np.ndarray:
        """Compute the objective of the search, which is minimized, for each design (row).

        It is the logarithm of the result that is to be smallest, or minus the logarithm of the result that is
        to be largest; without such a target, the sum of squared changes of the numbers from the given scene.
        """
        for k, each in enumerate(self.targets):
            if each.best is not None:
                return -self.excess(shares)[:, k]
        return ((shares - self.own) ** 2).sum(axis=1)

    def _aim_slopes(self, x: np.ndarray) -> np.ndarray:
        """Compute the derivatives of the objective at a design."""
        if any(each.best is not None for each in self.targets):
            return _slopes(self.aim, x)
        return 2 * (x - self.own)

    def ranked(self, shares: np.ndarray) -> np.ndarray:
        """Sort designs (rows), the best first: by their miss of the targets, then by the objective."""
        missed = (self.missed(shares) ** 2).sum(axis=1)
        return shares[np.lexsort((self.aim(shares), missed))]

    # The search -------------------------------------------------------------------------------------

    def run(self, seed: int) -> np.ndarray:
        """Run the search, and return the best design as fractions of the ranges."""
        with suppress(Spent):
            replace(self, spare=len(self.own) + _CORRECTIONS)._explore(
                seed
            )  # the copy shares the table of computed designs with this search
        with suppress(Spent):
            self._correct(self.ranked(self.designs)[0])
        return self.ranked(self.designs)[0]

    def _explore(self, seed: int) -> None:
        """Compute first designs over the ranges of the numbers, then ever better ones."""
        self.known(self._first(seed))
        if len(self.own) == 1:
            self._bracket()
        self._descend(self.ranked(self.designs)[:_STARTS])

    def _correct(self, x: np.ndarray) -> None:
        """Remove a small miss of the targets at a design, with steps by Newton and Broyden."""
        missed = self.missed(x[None])[0]
        if self._is_met or missed.max() > _NEARLY:
            return
        kept = [k for k, each in enumerate(self.targets) if missed[k] > 0 or each.equals is not None]
        excess = partial(self._some_excess, kept)
        slopes, own = _slopes(excess, x), excess(x[None])[0]
        for _ in range(_CORRECTIONS):
            step = _step_within(slopes, own, x)
            if not step.any():
                return
            x = x + step
            own = excess(x[None])[0]
            slopes = slopes + np.outer(own, step) / (step @ step)

    def _first(self, seed: int) -> np.ndarray:
        """Return the first designs of a search, in rows: the given scene, and some spread over the ranges."""
        p = len(self.own)
        if p == 1:
            return np.unique(np.append(np.linspace(0, 1, _SCANNED), self.own))[:, None]
        return np.vstack([self.own, seeded(LatinHypercube, p, seed).random(_SPREAD * p)])

    @property
    def _is_met(self) -> bool:
        """Whether any computed design meets all targets."""
        return bool(self.met(self.designs).all(axis=1).any())

    @property
    def _is_found(self) -> bool:
        """Whether the search can end: all targets are met, and no result is to be minimized or maximized."""
        return self._is_met and all(each.best is None for each in self.targets)

    def _bracket(self) -> None:
        """Find by bracketing where a result has its required value, if exactly one target is a value."""
        wanted = [k for k, each in enumerate(self.targets) if each.equals is not None]
        if len(wanted) != 1:
            return

        def beyond(x: float) -> float:
            return float(self.excess(np.array([[x]]))[0, wanted[0]])

        shares = np.sort(self.designs[:, 0]).tolist()
        around = [(a, b) for a, b in pairwise(shares) if beyond(a) * beyond(b) < 0]
        for a, b in sorted(around, key=lambda ends: abs(sum(ends) / 2 - self.own[0])):
            self.known(np.array([[toms748(beyond, a, b, xtol=_CLOSE, rtol=_ROUNDING)]]))
            if self._is_found:
                return

    def _descend(self, starts: np.ndarray) -> None:
        """Minimize the objective, subject to the targets, from several designs.

        As long as no design meets the targets, the sum of squared misses is minimized as well.
        """
        for start in starts:
            if self._is_found:
                return
            self._minimize(self.aim, self._aim_slopes, start, [*self._constraints()])
            if not self._is_met:
                missed = lambda shares: (self.missed(shares) ** 2).sum(axis=1)  # noqa: E731
                self._minimize(missed, partial(_slopes, missed), self.ranked(self.designs)[0], [])

    def _constraints(self) -> Iterator[dict[str, Any]]:
        """Yield the constraints of the minimization: targets that are values, and targets that are limits."""
        for kind, is_limit in (("eq", False), ("ineq", True)):
            places = [k for k, t in enumerate(self.targets) if t.best is None and t.is_limit == is_limit]
            if places:
                excess = partial(self._some_excess, places)
                yield {"type": kind, "fun": _at(excess), "jac": partial(_slopes, excess)}

    def _some_excess(self, places: list[int], shares: np.ndarray) -> np.ndarray:
        return self.excess(shares)[:, places]

    def _minimize(
        self, function: Function, slopes: Function, start: np.ndarray, constraints: Sequence[Any]
    ) -> None:
        """Minimize a function of designs by sequential quadratic programming.

        Every computed design is stored.
        """
        minimize(
            _at(function),
            start,
            jac=slopes,
            bounds=[(0.0, 1.0)] * len(start),
            constraints=constraints,
            method="SLSQP",
            options={"ftol": _FLAT, "maxiter": MOST_SOLVES},
        )

    # Additional output ------------------------------------------------------------------------------

    def derivatives(self, x: np.ndarray) -> np.ndarray:
        """Compute derivatives of the logarithms of results, shape (results, numbers).

        They are with respect to the numbers as fractions of their ranges; each is the slope of a parabola
        through three designs, all within the bounds.
        """
        steps = np.where(x < DIFFERENCE, 1.0, np.where(x > 1 - DIFFERENCE, -2.0, -1.0)) * DIFFERENCE
        a, b = (
            steps,
            np.where((x < DIFFERENCE) | (x > 1 - DIFFERENCE), np.where(x < DIFFERENCE, 2, -1), 1)
            * DIFFERENCE,
        )
        designs = np.vstack([x, x + np.diag(a), x + np.diag(b)])
        with np.errstate(divide="ignore", invalid="ignore"):
            own, before, after = np.split(np.log(self._answers(designs)[0]), [1, 1 + len(x)])
            a, b = a[:, None], b[:, None]
            found = -(a + b) / (a * b) * own + b / (a * (b - a)) * before - a / (b * (b - a)) * after
        return found.T


def _step_within(slopes: np.ndarray, excess: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Compute the shortest step from a design x that cancels an excess to first order, within the bounds."""
    step, free = np.zeros(len(x)), np.ones(len(x), dtype=bool)
    while free.any():
        step[free] = np.linalg.lstsq(slopes[:, free], -excess - slopes[:, ~free] @ step[~free], rcond=None)[0]
        beyond = free & ((x + step < 0) | (x + step > 1))
        if not beyond.any():
            break
        step[beyond] = np.clip(x + step, 0.0, 1.0)[beyond] - x[beyond]
        free &= ~beyond
    return step


def _at(function: Function) -> Callable[[np.ndarray], Any]:
    """Turn a function of designs (in rows) into one of a single design."""
    return lambda x: function(_within(x)[None])[0]


def _within(x: np.ndarray) -> np.ndarray:
    """Return fractions clipped to the ranges, and set to a bound if they differ from it by rounding."""
    return np.where(x < _AT_END, 0.0, np.where(x > 1 - _AT_END, 1.0, x))


def _slopes(function: Function, x: np.ndarray) -> np.ndarray:
    """Compute derivatives of a function with respect to a design x, by differences within the bounds."""
    x = _within(x)
    steps = np.where(x + _STEP <= 1, _STEP, -_STEP)
    values = function(np.vstack([x, x + np.diag(steps)]))
    return (values[1:] - values[0]).T / steps
