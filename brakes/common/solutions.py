"""Result of an inverse question: inputs at which an answer (a function) has a wanted value, or why none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.results.one_line import number
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance, Result
from beamdyn.common.words import supported

_LEVEL = 1e-12  # relative difference of two answers that counts as rounding


def step(first: np.ndarray | float, last: np.ndarray | float, part: float = 1.0) -> np.ndarray:
    """Return the sign of the change from one answer to another; 0 if it may be rounding error.

    `part` scales the relative difference that counts as rounding.
    """
    size = part * _LEVEL * np.maximum(np.abs(first), np.abs(last))
    return np.sign(np.where(np.abs(np.subtract(last, first)) <= size, 0.0, np.subtract(last, first)))


# Ratios of an answer to its error below which not even the first digit is sure, and above which six are.
_UNSURE, _SURE = 5, 2e6


def tell(answer: float, error: float) -> str:
    """Format an answer with the digits that its error supports; "about 6e+14" if none of them is sure."""
    if answer and abs(answer) <= _UNSURE * error:
        return f"about {answer:.0e}"
    return f"{answer:.6g}" if abs(answer) >= _SURE * error else supported(answer, error, 6)


@dataclass(frozen=True)
class Piece:
    """A range of inputs over which the answer rises, falls or is level.

    Parameters
    ----------
    start, end : float
        Ends of the range.
    first, last : float
        Answers at `start` and at `end`.
    first_error, last_error : float
        Change of these answers when the input changes within its rounding error; large beside a pole.
    """

    start: float
    end: float
    first: float
    last: float
    first_error: float = 0.0
    last_error: float = 0.0

    @property
    def shown_ends(self) -> tuple[str, str]:
        """Texts of the answers at both ends, with the digits that are sure."""
        return tell(self.first, self.first_error), tell(self.last, self.last_error)

    @property
    def course(self) -> str:
        """Word for the answer over this range: "rises", "falls" or "is level"."""
        return ("falls", "is level", "rises")[int(step(self.first, self.last)) + 1]


@dataclass(frozen=True)
class Gap:
    """A range of inputs without an answer.

    Parameters
    ----------
    start, end : float
        Ends of the range.
    reason : str
        Why there is no answer.
    """

    start: float
    end: float
    reason: str


@dataclass(frozen=True)
class Solutions(Result):
    """All inputs between two bounds at which an answer, a function of the input, has a wanted value.

    Attributes
    ----------
    target : float
        The wanted value [output_unit].
    values : ndarray, shape (k,)
        Inputs that give the wanted value [unit], in ascending order; empty if there are none.
    ranges : ndarray, shape (r, 2)
        Ranges of inputs over which the answer is level at the wanted value [unit]; not repeated in `values`.
    residuals : ndarray, shape (k,)
        Answers at `values` less the wanted value [output_unit].
    pieces : tuple of Piece
        Ranges over which the answer rises, falls or is level, which show that there are no other solutions.
    gaps : tuple of Gap
        Ranges without an answer.
    jumps : ndarray, shape (j,)
        Inputs at which the answer jumps past the wanted value [unit].
    samples, answers : ndarray, shape (n,)
        Inputs at which the answer was computed to find the pieces, and the answers; nan where there is none.
    settled : bool
        Whether the pieces stayed the same when the samples were last doubled.
    input, unit, output, output_unit : str
        Names of input and answer, and their units.
    wanted : str
        The wanted value as the user gave it, if that reads differently: in another unit, or rounded.
    provenance : Provenance, optional
        Version, method and computing time, if the question was about a file.

    Examples
    --------
    >>> found = brakes.find(lambda x: x * (4 - x), 3.0, np.linspace(0.5, 5.0, 10))
    >>> found.values
    array([1., 3.])
    >>> brakes.find(lambda x: x * (4 - x), 9.0, np.linspace(0.5, 5.0, 10)).message
    'none from 0.5 to 5: answer is at most 4, at input = 2'
    """

    target: float
    values: np.ndarray
    ranges: np.ndarray
    residuals: np.ndarray
    pieces: tuple[Piece, ...]
    gaps: tuple[Gap, ...]
    jumps: np.ndarray
    samples: np.ndarray
    answers: np.ndarray
    settled: bool
    input: str = "input"
    unit: str = ""
    output: str = "answer"
    output_unit: str = ""
    wanted: str = ""
    provenance: Provenance | None = None

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.output} {number(self.target, self.output_unit)}"
        yield self._where() if self.there else self.message

    @property
    def there(self) -> bool:
        """Whether any input gives the wanted value."""
        return bool(self.values.size + self.ranges.size)

    @property
    def refusals(self) -> tuple[str, ...]:
        """Sentence that says why no input gives the wanted value; empty if one does."""
        return () if self.there else (self.message,)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warning that there may be more solutions; empty if denser samples no longer changed the pieces."""
        count = f"the rising and falling ranges of {self.output} still change at {len(self.samples)} samples"
        return () if self.settled else (f"{count}: there may be more solutions; give a narrower range",)

    @property
    def message(self) -> str:
        """One sentence with the solutions, or with the reason why there are none."""
        low, high = self.samples[[0, -1]]
        if not self.there:
            which = f" gives {self.wanted}" if self.wanted else ""
            return f"none from {self._input(low)} to {self._input(high)}{which}: {'; '.join(self._reasons())}"
        return f"{self.output} = {self._target} at {self._where()}"

    @property
    def _target(self) -> str:
        """Text of the wanted value, as given by the user and in the answer's unit."""
        target = self._output(self.target)
        return f"{self.wanted} ({target})" if self.wanted else target

    def _where(self) -> str:
        """State the inputs that give the wanted value."""
        alone = f"{self.input} = {' and '.join(map(self._input, self.values))}"
        ends = ([*map(self._input, span)] for span in self.ranges)
        spans = (f"any {self.input} from {low} to {high}" for low, high in ends)
        return " and at ".join((*[alone] * bool(self.values.size), *spans))

    @property
    def lacking(self) -> tuple[str, ...]:
        """One sentence for each range of inputs without an answer, with the reason."""
        return tuple(
            f"no answer from {self._input(g.start)} to {self._input(g.end)}: {g.reason}" for g in self.gaps
        )

    def _reasons(self) -> Iterator[str]:
        """Yield the reasons why the answer does not reach the wanted value."""
        yield from self._extremes() if self.pieces else ()
        yield from (f"it jumps past the wanted value at {self.input} = {self._input(x)}" for x in self.jumps)
        yield from self.lacking if self.pieces else (gap.reason for gap in self.gaps)

    def _extremes(self) -> Iterator[str]:
        """Yield the answers nearest to the wanted value, below and above, and the inputs that give them."""
        pieces = self.pieces
        ends = [e for p in pieces for e in ((p.first, p.start, p.first_error), (p.last, p.end, p.last_error))]
        if step(min(ends)[0], max(ends)[0]) == 0:
            yield f"{self.output} is {self._output(ends[0][0])} whatever {self.input} is"
            return
        below, above = ([end for end in ends if sign * (end[0] - self.target) > 0] for sign in (-1, 1))
        for words, nearest in (("at most", max(below, default=None)), ("at least", min(above, default=None))):
            if nearest is not None:
                value, at, error = nearest
                size = f"{tell(value, error)} {self.output_unit}".rstrip()
                yield f"{self.output} is {words} {size}, at {self._places(value, at)}"

    def _places(self, value: float, at: float) -> str:
        """State where the answer has a value: at one input, or over the range in which it is level."""
        for p in self.pieces:
            if p.course == "is level" and step(p.first, value) == 0:
                return f"any {self.input} from {self._input(p.start)} to {self._input(p.end)}"
        return f"{self.input} = {self._input(at)}"

    def _input(self, value: float) -> str:
        return f"{value:.6g} {self.unit}".rstrip()

    def _output(self, value: float) -> str:
        return f"{value:.6g} {self.output_unit}".rstrip()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the answer over the input, with the wanted value and the solutions."""
        from beamdyn.common.plots.axes_and_lines import set_up_axes

        ax = set_up_axes(ax, *(f"{name} [{unit}]" if unit else name for name, unit in self.named))
        ax.plot(self.samples, self.answers, linewidth=1.8)
        ax.axhline(self.target, color="0.4", linestyle="--", linewidth=1.2)
        ax.plot(self.values, self.target + self.residuals, "o", color="black")
        return ax

    @property
    def named(self) -> tuple[tuple[str, str], tuple[str, str]]:
        """Labels of input and answer, each a name with a unit."""
        return (self.input, self.unit), (self.output, self.output_unit)


@dataclass(frozen=True)
class WholeSolutions(Solutions):
    """All whole numbers between two bounds at which an answer has a wanted value, or the first ones past it.

    Each number is tried. `values` has those whose answer is the wanted value; where the wanted value lies
    between the answers of two neighbouring numbers, it has the second of them.

    Examples
    --------
    >>> found = brakes.find_whole(lambda n: 87.5 * n, 300.0, range(1, 11))
    >>> found.message
    'answer passes 300 from input = 3 (262.5) to 4 (350): 4 is the first past it'
    """

    @property
    def message(self) -> str:
        """One sentence with the numbers found, or with the reason why there are none."""
        meets = self.residuals == 0
        if meets.all():
            return super().message
        exact = replace(self, values=self.values[meets], residuals=self.residuals[meets])
        said = [exact.message] if exact.there else []
        return "; ".join((*said, *map(self._passing, self.values[~meets])))

    def _passing(self, value: float) -> str:
        """Return the answers of the two neighbouring numbers between which the wanted value lies."""
        k = int(np.searchsorted(self.samples, value))
        (before, now), (first, last) = self.samples[k - 1 : k + 1], self.answers[k - 1 : k + 1]
        steps = f"{self._input(before)} ({self._output(first)}) to {self._input(now)} ({self._output(last)})"
        where = f"from {self.input} = {steps}"
        return f"{self.output} passes {self._target} {where}: {self._input(now)} is the first past it"
