"""Effects of tolerances on results, from the results of designs, which the caller's function computes.

In shapes of arrays, N counts designs, d inputs, and k results.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.one_line import counted
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import Statement, after
from beamdyn.common.spreading.first_order import KnownDerivatives, first_order_of, slopes_from
from beamdyn.common.spreading.spread_result import Spread
from beamdyn.common.spreading.statistics import SpreadDesigns, indices_of, scatter_of
from beamdyn.common.spreading.tolerances import SpreadInput
from beamdyn.common.spreading.worst_case import BOTH, trends_of, worst_cases
from beamdyn.common.words import percent

_FEW = 3  # largest number of reasons for missing results, and of warnings about worst cases, that are listed


@dataclass(frozen=True)
class SpreadAnswers:
    """Results of N designs, with errors and statuses.

    Parameters
    ----------
    answers, units : tuple of str, length k
        Name and unit of each result.
    value : ndarray, shape (N, k)
        Results; not finite where there is none.
    error : ndarray, shape (N, k)
        Estimated relative errors of the results; nan if unknown.
    status : ndarray of str, shape (N, k)
        Status of each result, such as "stable" or "divergence".
    warnings : tuple of str
        Warnings about the results.
    method, compared_with : str
        As for `Provenance`.
    """

    answers: tuple[str, ...]
    units: tuple[str, ...]
    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]
    method: str
    compared_with: str

    @property
    def absolute_error(self) -> np.ndarray:
        """Return the absolute errors of the results, shape (N, k); nan if unknown."""
        with np.errstate(invalid="ignore"):
            size = np.abs(self.value) * self.error
        size = np.where(np.isinf(self.error), np.inf, size)  # inf * 0 is nan, but the error is inf
        return np.where(np.isfinite(self.value), size, np.nan)

    @property
    def size_of_error(self) -> np.ndarray:
        """Return the absolute errors of the results, shape (N, k); 0 if unknown."""
        return np.nan_to_num(self.absolute_error, nan=0.0, posinf=np.inf)


# A function that computes the results of N designs from their inputs, arrays (N,) by name of the input; it
# raises ValueError if all designs fail.
Evaluate = Callable[[dict[str, np.ndarray]], SpreadAnswers]
Derivatives = Callable[[], KnownDerivatives]


def solve_spread(
    what: str,
    inputs: Sequence[SpreadInput],
    samples: int,
    seed: int,
    evaluate: Evaluate,
    derivatives: Derivatives = KnownDerivatives,
    cautions: Sequence[str] = (),
) -> Spread:
    """Compute ranges of results over tolerances of inputs.

    Parameters
    ----------
    what : str
        Name of the requested results.
    inputs : sequence of SpreadInput
        The d inputs.
    samples, seed : int
        Number of samples and seed, as returned by `check_samples` and `check_seed`.
    evaluate : callable
        Function that computes the results of designs.
    derivatives : callable
        Function that returns the known derivatives of the results at the nominal design.
    cautions : sequence of str
        Warnings that precede the warnings of the results.
    """
    start = perf_counter()
    designs = SpreadDesigns(inputs, samples, seed)
    found = evaluate(_columns(inputs, designs.table))
    further = _FurtherAnswers(evaluate, inputs, np.any(np.isfinite(found.value), axis=0))
    nominal, beside, random = designs.part(found.value)
    errors = designs.part(found.size_of_error)
    worst_error = found.size_of_error.max(axis=0)
    near_error = np.maximum(errors[0], errors[1].max(axis=(0, 1)))
    known = derivatives()
    slopes = slopes_from(nominal, beside, designs.steps, near_error).replaced(known.rows)
    sampled = designs.table[1 + 4 * len(inputs) :][: 2 * samples]
    trends = trends_of(random, errors[2], sampled[:samples], sampled[samples:])
    worst = worst_cases(inputs, trends, designs.table, found.value, found.absolute_error, further)
    scatter, indices = scatter_of(random[:2]), indices_of(random, worst_error)
    made = Spread(
        what=what,
        answers=found.answers,
        units=found.units,
        inputs=tuple(inputs),
        nominal=nominal,
        error=_largest_error(found),
        first_order=first_order_of(inputs, nominal, slopes),
        worst=worst,
        trends=trends,
        scatter=scatter,
        indices=indices,
        states=_states(designs.part(found.status)[2][:2]),
        samples=samples,
        seed=seed,
        sampled_inputs=sampled,
        sampled_answers=random[:2].reshape(2 * samples, -1),
        warnings=(),
        provenance=Provenance(__version__, found.method, found.compared_with, perf_counter() - start),
    )
    said = (*cautions, *known.warnings, *_notes(made, worst_error), *found.warnings)
    return replace(made, warnings=(*said, *further.warnings(found.warnings)))


def _columns(inputs: Sequence[SpreadInput], designs: np.ndarray) -> dict[str, np.ndarray]:
    return {each.name: designs[:, i] for i, each in enumerate(inputs)}


@dataclass
class _FurtherAnswers:
    """Computes the results of designs for worst cases, and collects the warnings about them.

    A combination of inputs may be invalid even if each input is valid; such a design has no result.
    """

    evaluate: Evaluate
    inputs: Sequence[SpreadInput]
    # For each result, whether any earlier design has it; only such a result is reported if it is missing.
    wanted: Any
    _count: int = 0
    _without: dict[str, int] = field(default_factory=dict)
    _said: list[str] = field(default_factory=list)

    def __call__(self, designs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the results (n, k) of n designs (n, d), and their absolute errors (n, k)."""
        self._count += len(designs)
        value, error = zip(*self._parts(designs), strict=True)
        return np.concatenate(value), np.concatenate(error)

    def _parts(self, designs: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield the results of all designs and their absolute errors, in parts.

        If a design is invalid, the designs are split into halves in order to find it.
        """
        try:
            found = self.evaluate(_columns(self.inputs, designs))
        except ValueError as error:
            if isinstance(error, InvalidValue) and len(designs) > 1:
                for half in np.array_split(designs, 2):
                    yield from self._parts(half)
                return
            self._without[str(error)] = self._without.get(str(error), 0) + len(designs)
            nothing = np.full((len(designs), len(self.wanted)), np.nan)
            yield nothing, nothing
            return
        self._said += found.warnings
        for missing, status in zip(~np.isfinite(found.value) & self.wanted, found.status, strict=True):
            if missing.any():
                state = str(status[missing][0])
                self._without[state] = self._without.get(state, 0) + 1
        yield found.value, found.absolute_error

    def warnings(self, before: Sequence[str]) -> Iterator[str]:
        """Yield the number of designs without results, and warnings that were not given before."""
        if self._without:
            why = [f"{reason}: {number}" for reason, number in self._without.items()]
            parts = "; ".join([*why[:_FEW], *(["..."] if why[_FEW:] else [])])
            number = f"{sum(self._without.values())} of {self._count}"
            yield f"worst cases: {number} designs have no answer ({parts})"
        first = dict[tuple[str, ...], str]()
        for sentence in (*before, *self._said):
            first.setdefault(_subject(sentence), sentence)
        new = [*first.values()][len({*map(_subject, before)}) :]
        yield from (after("worst cases: ", said) for said in new[:_FEW])
        if more := len(new[_FEW:]):  # such as one warning with other numbers in each design
            yield f"worst cases: {counted(more, 'more warning')}"


def _subject(sentence: str) -> tuple[str, ...]:
    """Return the key by which repeated warnings are recognized: kind and quantity, or else the text."""
    return (sentence.kind, sentence.quantity) if isinstance(sentence, Statement) else (sentence,)


def _largest_error(found: SpreadAnswers) -> np.ndarray:
    """Return the largest relative error of each result; nan if unknown."""
    known = np.where(np.isfinite(found.value), found.error, np.nan)
    largest = np.where(np.isnan(known), -np.inf, known).max(axis=0)
    return np.where(largest < 0, np.nan, largest)


def _states(status: np.ndarray) -> tuple[dict[str, float], ...]:
    """Return the fraction of designs in each status, the most frequent first, for each of k results.

    `status` has the statuses (2, n, k) of two samples of n random designs.
    """
    made = []
    for column in status.reshape(-1, status.shape[-1]).T:
        words, counts = np.unique(column, return_counts=True)
        order = np.argsort(-counts, kind="stable")
        made.append({str(words[i]): float(counts[i] / len(column)) for i in order})
    return tuple(made)


# Warnings ---------------------------------------------------------------------------------------


def _notes(spread: Spread, error: np.ndarray) -> Iterator[str]:
    """Yield sentences on what limits the statistics of each result."""
    yield from _without_answer(spread)
    worst = spread.worst
    for k, name in enumerate(spread.answers):
        if worst.searched[k]:
            trends = zip(spread.inputs, spread.trends[:, k], strict=True)
            turning = [each.name for each, trend in trends if trend == BOTH]
            why = f"it rises and falls with {', '.join(turning)}" if turning else "a corner is not the worst"
            ended = (
                f"a search that was ended after {worst.designs} designs" if worst.cut_short[k] else "a search"
            )
            yield f"{name}: {why}, so that its worst cases come from {ended}: worse designs may exist"
        if spread.scatter.deviation[k] <= error[k]:
            yield f"{name}: no Sobol' indices, as its scatter is within its numerical error, {error[k]:.1g}"


def _without_answer(spread: Spread) -> Iterator[str]:
    """Yield sentences on missing results, one for all results with the same reasons."""
    said: dict[str, list[str]] = {}
    for name, share, parts in zip(spread.answers, spread.scatter.no_answer, spread.states, strict=True):
        why = ", ".join(f"{state} {percent(part)}" for state, part in parts.items())
        if share == 1:
            said.setdefault(f"no random design has an answer ({why})", []).append(name)
        elif share:
            rest = "the statistics cover only the other designs, and there are no Sobol' indices"
            sentence = f"{percent(share)} of the random designs have no answer ({why}); {rest}"
            said.setdefault(sentence, []).append(name)
    for sentence, names in said.items():
        yield f"{'; '.join(names)}: {sentence}"
