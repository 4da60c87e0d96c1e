"""Inverse questions: find all inputs between two bounds at which an answer has a wanted value.

An answer is a function of the input; it need not exist for all inputs. It is sampled, each time twice as
densely, until the pieces over which it rises, falls or is level stay the same. The end of a piece (a turning
point, or the last input that has an answer) is found by sampling more densely around it, several times. A
rising or falling piece has the wanted value once if that lies between the answers at its two ends, else
nowhere.

References
----------
Alefeld, Potra, Shi (1995), Algorithm 748: enclosing zeros of continuous functions, ACM Transactions on
Mathematical Software 21.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import solve_possible
from beamdyn.common.inputs.checks import InvalidValue, ascending, function, not_negative, real
from brakes.common.solutions import Gap, Piece, Solutions, WholeSolutions, step

_EPS = np.finfo(float).eps
_SURE = 1e-13  # relative difference from the wanted value that counts as rounding
# An answer jumps at a root if it differs there from the wanted value by more than this fraction of its change
# over the bracket of the root.
_JUMP = 1e-6
# Relative width of the bracket of a turning point; in a narrower one rounding hides the turning point.
_TURN = 1e-9
# Relative width of the bracket of the last input with an answer, or of the end of a level part of the answer.
_EDGE = 1e-13
# The error of an answer at the end of a piece is its change over this many widths _EDGE of the end's bracket.
_ROUNDED_ENDS = 4
# Parts into which each refinement divides the bracket of a turning point, and of an edge.
_PARTS, _FEW_PARTS = 16, 4
_DOUBLED = 4  # largest number of times that the samples are doubled

Answer = Callable[[np.ndarray], Any]
Curve = tuple[np.ndarray, np.ndarray]  # inputs and answers, each of shape (n,)


def find(
    answer: Answer,
    target: float,
    samples: Any,
    why: Callable[[float], str] | None = None,
    *,
    rounding: float = 0.0,
) -> Solutions:
    """Find all inputs between two bounds at which an answer has a wanted value.

    Parameters
    ----------
    answer : callable
        ``answer(x)``: the answers to an array of inputs (n,), nan where there is none.  Inputs that the
        functions of this package refuse count as without an answer.
    target : float
        The wanted value [unit of the answer].
    samples : array_like, shape (n,)
        Inputs in ascending order at which the search begins; the first and the last are its bounds.
    why : callable, optional
        ``why(x)``: why there is no answer at an input, in a sentence.
    rounding : float
        By how much the wanted value may have been rounded [unit of the answer]: a level answer within
        this distance counts as the wanted one.

    Returns
    -------
    Solutions
        The inputs, or why there is none; names and units are added by ``dataclasses.replace``.

    Raises
    ------
    ValueError
        If the samples are not in ascending order, or fewer than two, or `rounding` is negative.

    References
    ----------
    Standard: a continuous answer takes each value between those at the ends of a piece; roots by Alefeld,
    Potra and Shi (1995).

    Examples
    --------
    >>> band = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)
    >>> def torque(friction):
    ...     return machines.solve_brake(band, friction=friction, force=100.0).torque
    >>> brakes.find(torque, 90.0, np.linspace(0.05, 0.4, 8)).values.round(6)
    array([0.164578])
    """
    function("answer", answer)
    target, x = real("target", target), ascending("samples", samples)
    not_negative("rounding", rounding)
    if len(x) < 2:
        raise InvalidValue("samples", x, "give two inputs or more: the first and the last are the bounds")
    answers = _Answers(answer, why)
    (x, y), settled = _settle(answers, x)
    runs = [*_runs(answers, x, y)]
    pieces = [piece for run in runs for piece in _pieces(answers, run)]
    target = _unrounded(pieces, target, rounding)
    level = [x[[0, -1]] for x, y in pieces if step(y[0], y[-1]) == 0 == step(y[0], target)]
    ranges = np.array(level).reshape(-1, 2)
    values, jumps = _solve(answers, pieces, ranges, target)
    return Solutions(
        target=target,
        values=values,
        ranges=ranges,
        residuals=answers(values) - target,
        pieces=tuple(_piece_with_errors(answers, piece) for piece in pieces),
        gaps=tuple(_gaps(answers, x, runs)),
        jumps=jumps,
        samples=x,
        answers=y,
        settled=settled,
    )


def find_whole(
    answer: Answer, target: float, samples: Any, why: Callable[[float], str] | None = None
) -> WholeSolutions:
    """Find the whole numbers at which an answer has a wanted value, or the first ones past it.

    Parameters
    ----------
    answer, target
        As for `find`.
    samples : array_like, shape (n,)
        The numbers, in ascending order; each is tried.
    why
        As for `find`.

    Returns
    -------
    WholeSolutions
        The numbers, or why there is none; names and units are added by ``dataclasses.replace``.

    Raises
    ------
    ValueError
        If the samples are not in ascending order.

    References
    ----------
    Standard: each number is tried.

    Examples
    --------
    >>> def torque(faces):
    ...     plates = machines.Plates(0.05, 0.07, faces)
    ...     return machines.solve_brake(plates, friction=0.1, force=1000.0).torque
    >>> brakes.find_whole(torque, 50.0, range(1, 21)).values
    array([9.])
    """
    function("answer", answer)
    target, x = real("target", target), ascending("samples", samples)
    answers = _Answers(answer, why)
    y = answers(x)
    past = np.where(step(y, target) == 0, 0.0, y - target)
    passes = np.append(False, past[:-1] * past[1:] < 0)
    runs = [_run_as_it_is(x, y, run) for run in _finite(y)]
    return WholeSolutions(
        target=target,
        values=x[(past == 0) | passes],
        ranges=np.empty((0, 2)),
        residuals=past[(past == 0) | passes],
        pieces=tuple(each for run in runs for each in _courses_as_they_are(run)),
        gaps=tuple(_gaps(answers, x, runs)),
        jumps=np.array([]),
        samples=x,
        answers=y,
        settled=True,
    )


@dataclass(frozen=True)
class _Answers:
    """The function `answer` with nan in place of an exception for refused inputs, and the reasons."""

    answer: Answer
    reason: Callable[[float], str] | None

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Compute the answer to each input; nan where there is none."""
        return self._with_refusals(x)[0]

    def there(self, x: np.ndarray) -> np.ndarray:
        """Return whether each input has an answer."""
        return np.isfinite(self(x))

    def why(self, x: float) -> str:
        """Return the reason why an input has no answer."""
        refused = self._with_refusals(np.array([x]))[1]
        return refused[0].advice(str) if refused else self.reason(x) if self.reason else "it has no value"

    def _with_refusals(self, x: np.ndarray) -> tuple[np.ndarray, dict[int, InvalidValue]]:
        found, rows, refused = solve_possible(lambda rows: self.answer(x[rows]), len(x))
        values = np.full(len(x), np.nan)
        values[rows] = np.nan if found is None else found
        return np.where(np.isfinite(values), values, np.nan), refused


# Pieces: ranges of inputs over which the answer rises, falls or is level ---------------------------------


@dataclass(frozen=True)
class _Run:
    """Neighbouring samples that all have answers, with the nearest input without an answer on either side."""

    x: np.ndarray
    y: np.ndarray
    before: float | None
    after: float | None


def _settle(answers: _Answers, x: np.ndarray) -> tuple[Curve, bool]:
    """Double the samples of the answer until its rising, level and falling pieces stay the same.

    Return the curve, and whether the pieces stayed the same at the last doubling.
    """
    y, settled = answers(x), False
    for _ in range(_DOUBLED):
        between, courses = (x[1:] + x[:-1]) / 2, _courses(y)
        x, y = _joined(x, y, between, answers(between))
        if settled := _courses(y) == courses:
            break
    return (x, y), settled


def _joined(x: np.ndarray, y: np.ndarray, more_x: Any, more_y: Any) -> Curve:
    """Return a curve (inputs, answers) with further points inserted in ascending order."""
    x, places = np.unique(np.append(x, more_x), return_index=True)
    return x, np.append(y, more_y)[places]


def _courses(y: np.ndarray) -> list[list[float]]:
    """Find the signs (1, 0, -1) of the rising, level and falling pieces of each run of finite answers."""
    return [[sign for sign, _ in _courses_of_run(y[run])] for run in _finite(y)]


def _finite(y: np.ndarray) -> list[slice]:
    """Find the slices of neighbouring finite answers."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], np.isfinite(y), [False]]).astype(int)))
    return [slice(*run) for run in ends.reshape(-1, 2).tolist()]


def _courses_of_run(y: np.ndarray) -> list[tuple[float, int]]:
    """Find the pieces of one run of answers: sign (1 rises, 0 level, -1 falls) and last index of each.

    A single level step counts as part of the piece before it: a turning point may lie within.
    """
    signs = step(y[:-1], y[1:])
    alone = np.flatnonzero((signs[1:-1] == 0) & (signs[:-2] != 0) & (signs[2:] != 0)) + 1
    signs[alone] = signs[alone - 1]
    each = ((sign, [*places]) for sign, places in groupby(range(len(signs)), lambda i: float(signs[i])))
    return [(sign, places[-1] + 1) for sign, places in each]


def _courses_as_they_are(run: _Run) -> Iterator[Piece]:
    """Yield the pieces over which the answers to whole numbers rise, fall or are level."""
    cuts = [0, *(last for _, last in _courses_of_run(run.y))] + [0] * (len(run.x) == 1)
    for i, j in pairwise(cuts):
        yield _piece((run.x[i : j + 1], run.y[i : j + 1]))


def _piece(curve: Curve) -> Piece:
    x, y = curve
    return Piece(*map(float, (x[0], x[-1], y[0], y[-1])))


def _piece_with_errors(answers: _Answers, curve: Curve) -> Piece:
    """Make a piece, with the errors of the answers at its ends.

    An error is the change of the answer when the end moves inwards by a few times its own uncertainty.
    """
    made, width = _piece(curve), _ROUNDED_ENDS * _EDGE * float(np.abs(curve[0]).max())
    moved = answers(np.array([min(made.start + width, made.end), max(made.end - width, made.start)]))
    first, last = np.abs(moved - [made.first, made.last]).tolist()
    return replace(made, first_error=first, last_error=last)


def _run_as_it_is(x: np.ndarray, y: np.ndarray, run: slice) -> _Run:
    """Make a run of whole numbers; its ends are samples and need no search."""
    before = float(x[run.start - 1]) if run.start else None
    return _Run(x[run], y[run], before, float(x[run.stop]) if run.stop < len(x) else None)


def _runs(answers: _Answers, x: np.ndarray, y: np.ndarray) -> Iterator[_Run]:
    """Yield the runs of inputs with answers, each extended to the exact ends of its range."""
    for run in _finite(y):
        first, last = run.start, run.stop - 1
        low = _edge(answers.there, x[first], x[first - 1]) if first > 0 else (x[first], None)
        high = _edge(answers.there, x[last], x[last + 1]) if last + 1 < len(x) else (x[last], None)
        edges = np.array([low[0], high[0]])
        yield _Run(*_joined(x[run], y[run], edges, answers(edges)), low[1], high[1])


def _edge(holds: Callable[[np.ndarray], Any], inside: Any, outside: Any) -> tuple[float, float]:
    """Bracket the end of a condition between an input that meets it and one that does not."""
    width = _EDGE * max(abs(inside), abs(outside))
    while abs(outside - inside) > width:
        grid = np.linspace(inside, outside, _FEW_PARTS + 1)
        k = [True, *holds(grid[1:-1]), False].index(False)
        inside, outside = grid[k - 1], grid[k]
    return float(inside), float(outside)


def _gaps(answers: _Answers, x: np.ndarray, runs: Sequence[_Run]) -> Iterator[Gap]:
    """Yield the ranges without an answer before, between and after the runs."""
    starts = [float(x[0]), *(run.after for run in runs)]
    ends = [*(run.before for run in runs), float(x[-1])]
    for k, (start, end) in enumerate(zip(starts, ends, strict=True)):
        if start is not None and end is not None:
            yield Gap(start, end, answers.why(end if k == 0 and runs else start))


def _pieces(answers: _Answers, run: _Run) -> Iterator[Curve]:
    """Divide a run of samples at turning points and at the ends of level pieces."""
    x, y = run.x, run.y
    cuts = [
        _turn(answers, x[last - 1], x[last + 1], sign)
        if sign * following < 0
        else _level_edge(answers, y[last], x[last], x[last - 1 if sign else last + 1])
        for (sign, last), (following, _) in pairwise(_courses_of_run(y))
    ]
    x, y = _joined(x, y, cuts, answers(np.array(cuts)))
    places = np.searchsorted(x, np.unique([x[0], *cuts, x[-1]]))
    yield from ((x[i : j + 1], y[i : j + 1]) for i, j in pairwise(places.tolist()))


def _level_edge(answers: _Answers, level: float, inside: float, outside: float) -> float:
    """Find the input at which a level piece of the answer begins or ends.

    Answers may deviate from `level` by half of the difference that counts as rounding. So any two answers of
    the piece differ by rounding only.
    """
    return _edge(lambda x: step(level, answers(x), 0.5) == 0, inside, outside)[0]


def _turn(answers: _Answers, low: float, high: float, sign: float) -> float:
    """Find the turning point between two inputs: a maximum (sign 1) or a minimum (sign -1)."""
    width = _TURN * max(abs(low), abs(high))
    while high - low > width:
        grid = np.linspace(low, high, _PARTS + 1)
        k = int(np.nanargmax(sign * answers(grid)))
        low, high = float(grid[max(k - 1, 0)]), float(grid[min(k + 1, _PARTS)])
    return float((low + high) / 2)


# Solutions -----------------------------------------------------------------------------------------------


def _unrounded(pieces: Sequence[Curve], target: float, rounding: float) -> float:
    """Return the answer of the level piece nearest to the wanted value `target` [unit of the answer].

    If that answer differs from the wanted value by more than `rounding`, the wanted value is returned.
    """
    heights = [float(y[0]) for _, y in pieces if step(y[0], y[-1]) == 0]
    nearest = min(heights, key=lambda height: abs(height - target), default=target)
    return nearest if abs(nearest - target) <= rounding else target


def _solve(
    answers: _Answers, pieces: Sequence[Curve], ranges: np.ndarray, target: float
) -> tuple[np.ndarray, np.ndarray]:
    """Find inputs that give the wanted value, outside of level ranges, and those where the answer jumps."""
    found, jumps = list[float](), list[float]()
    for x, y in pieces:
        past = y - target
        # A turning point that differs from the wanted value only by rounding counts as a solution.
        steps = {0: y[1] - y[0], -1: y[-1] - y[-2]}
        ends = [x[i] for i, way in steps.items() if abs(past[i]) <= _SURE * max(abs(target), abs(way))]
        if not ends and past[0] * past[-1] < 0:
            k = int(np.argmax(np.sign(past) != np.sign(past[0])))
            root, jumped = _root(
                answers, target, dict(zip(x[k - 1 : k + 1], past[k - 1 : k + 1], strict=True))
            )
            (jumps if jumped else found).append(root)
        found += ends
    # Solutions within level ranges, whose ends are uncertain by `near`, are left out.
    alone, near = np.unique(found), 2 * _EDGE * np.abs(ranges)
    low, high = (ranges + near * np.array([-1, 1])).T[..., None]
    return alone[~np.any((alone >= low) & (alone <= high), axis=0)], np.unique(jumps)


def _root(answers: _Answers, target: float, bracket: dict[float, float]) -> tuple[float, bool]:
    """Find the input at which the answer passes the wanted value in a bracket, and whether it jumps there.

    `bracket` maps each end of the bracket to the answer there minus the wanted value. These differences are
    not computed again, as rounding might change their signs.
    """
    from scipy.optimize import toms748  # imported here, because only inverse questions use it

    def difference(x: float) -> float:
        return float(bracket[x] if x in bracket else answers(np.array([x]))[0] - target)

    (low, before), (high, after) = bracket.items()
    if after == 0:
        return float(high), False
    root = toms748(difference, float(low), float(high), xtol=np.finfo(float).tiny, rtol=4 * _EPS)
    return root, abs(difference(root)) > _JUMP * abs(after - before)
