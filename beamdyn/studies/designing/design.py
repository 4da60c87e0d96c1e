"""Inverse design: search for numbers of a scene whose results meet given targets."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, count
from beamdyn.common.inputs.described import Designs, VariedInput
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.curves import plot_bars
from beamdyn.common.results.one_line import counted, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance, plain
from beamdyn.common.results.statements import announced, joined
from beamdyn.common.words import InputName, Words
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.numbers import check_path, is_speed, number_at, unit_of, with_numbers
from beamdyn.scene.scene import Scene, SceneResult, check_scene
from beamdyn.studies.designing.proofs import Proofs
from beamdyn.studies.designing.search import DIFFERENCE, Ranges, Search, Spent
from beamdyn.studies.designing.target import Target, say_number


@dataclass(frozen=True)
class FoundDesign(SceneResult):
    """Numbers of a scene whose results meet the targets, or come nearest to them; computed by `design`.

    Parameters
    ----------
    names, units : tuple of str, shape (p,)
        Names of the numbers in scene files, and their SI units.
    given, value : ndarray, shape (p,)
        Values in the scene, and values in the design [unit].  A value in the scene is 0 if the scene lacks
        the number, and nan if it varies along the beam.
    low, high : ndarray, shape (p,)
        Bounds of the numbers [unit].
    targets : tuple of Target, shape (m,)
        The targets.
    reached : ndarray, shape (m,)
        Results of the design [unit of each]; nan if there is none.
    error : ndarray, shape (m,)
        Estimated relative errors of these results.
    met : ndarray of bool, shape (m,)
        Whether each target is met, within 1e-10 or the error of the result; a target "best" is met if there
        is a result.
    derivative : ndarray, shape (m, p)
        Derivative of each result with respect to each number [unit / unit of the number]; finite difference.
    limited_by : tuple of str
        Bounds and limits that the design reaches, in words.
    only_one_way : bool
        Whether the results that miss their targets rise or fall monotonically with each number over all
        computed designs, and the design is at the bounds nearest to the targets.  This does not prove that no
        other design within the bounds is nearer: results may have extrema between computed designs.
    proof : str
        Proof that no design within the bounds comes nearer to any missed target; empty unless there is a
        proof for each of them.
    why_none : str
        Proof that no design within the bounds meets all targets, within the errors of the results; empty
        without a proof.
    solves : int
        Number of designs computed, at most 60.
    warnings : tuple of str
        Warnings about the results of the design.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> free = {"beam.thickness": (0.1e-3, 0.2e-3)}
    >>> found = bd.design(bd.Scene(strip), free, [bd.Target("frequencies", equals=80.0)])
    >>> found.found, found.limited_by
    (False, ('beam.thickness is at its largest value',))
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    given: np.ndarray
    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    targets: tuple[Target, ...]
    reached: np.ndarray
    error: np.ndarray
    met: np.ndarray
    derivative: np.ndarray
    limited_by: tuple[str, ...]
    only_one_way: bool
    proof: str
    why_none: str
    solves: int

    def headline(self) -> Iterator[str]:
        """Yield whether a design was found, and its numbers, for the one-line summary.

        See `Result.headline`.
        """
        yield "found" if self.found else "none found, the nearest"
        for name, value, unit in self._numbers:
            yield Words(InputName(name), " ", say_number(value, unit))
        yield from (counted(self.solves, "solve"), warned(self.warnings))

    @property
    def found(self) -> bool:
        """Whether the design meets all targets."""
        return bool(self.met.all())

    @property
    def scene_found(self) -> Scene:
        """Scene with the numbers of the design."""
        return with_numbers(self.scene, dict(zip(self.names, self.value.tolist(), strict=True)))

    @property
    def relative(self) -> np.ndarray:
        """Relative change of m results over that of p numbers, shape (m, p).

        It is 3 if a result is proportional to the cube of a number.
        """
        return self.derivative * self.value / self.reached[:, None]

    @property
    def without_effect(self) -> tuple[str, ...]:
        """Names of the numbers that change no result, according to the derivatives at this design."""
        return tuple(
            name
            for name, each in zip(self.names, self.derivative.T, strict=True)
            if (each == 0).all()  # derivatives within rounding were set to 0 earlier
        )

    @property
    def _numbers(self) -> Iterator[tuple[str, float, str]]:
        return zip(self.names, self.value.tolist(), self.units, strict=True)

    def sentences(self) -> tuple[str, ...]:
        """Return sentences about missed targets, and about the bounds and limits that the design reaches."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        missed = [k for k, met in enumerate(self.met) if not met]
        if missed:
            numbers = joined(
                ", ", (Words(InputName(n), " = ", say_number(v, u)) for n, v, u in self._numbers)
            )
            said = (Words(self.targets[k].says, f" (there {self._reached(k)})") for k in missed)
            sure = bool(self.proof)
            none = "No design in the bounds has " if sure else "No design was found that has "
            nearest = "; the nearest is " if sure else "; the nearest found is "
            beside = "" if sure or len(missed) == len(self.met) else " together with all other targets"
            yield Words(none, joined(" and ", said), beside, nearest, numbers, ".")
            if self.proof:
                yield f"It is proven that no other design comes nearer: {self.proof}."
            elif self.why_none:
                yield Words("It is proven that no design meets all targets: ", self.why_none, ".")
            elif self.only_one_way:
                said = "which suggests, but does not prove, that no other design comes nearer"
                yield f"These answers {self._ways()} over all designs computed, {said}."
        if self.without_effect:
            many = len(self.without_effect) > 1
            names = joined(" and ", map(InputName, self.without_effect))
            targets = " and ".join(dict.fromkeys(each.name for each in self.targets))
            yield Words(names, f" {'have' if many else 'has'} no effect on {targets}.")
        if self.limited_by:
            yield Words("Limited by: ", joined("; ", self.limited_by), ".")

    def _ways(self) -> str:
        """State that the results depend monotonically on each number, or not at all."""
        still = len(self.without_effect)
        if still == len(self.names):
            return "are the same"
        return f"rise or fall with each {'other ' if still else ''}number"

    def _reached(self, k: int) -> str:
        value = float(self.reached[k])
        if np.isinf(value):
            return (
                "it does not buckle" if self.targets[k].what == "critical_speed" else "beyond the top speed"
            )
        return "no answer" if np.isnan(value) else self.targets[k].amount(value)

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with its sentences under "sentences"."""
        return super().to_dict() | {"found": self.found, "sentences": plain(self.sentences())}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative change of each result over that of each number, the most important on top."""
        labels = [each.name for each in self.targets]
        names = [InputName(each).on_form for each in self.names]
        return plot_bars(names, self.relative.T, labels, "relative change over that of the number", ax)


# The search --------------------------------------------------------------------------------------------


MOST_NUMBERS = 6
_SAME = 1e-9  # difference or slope of logarithms below which it counts as 0
_AT = 1e-6  # fraction of a range, or relative distance from a limit, below which a design is at the limit


@announced
@one_blas_thread()  # with small matrices, further threads only slow each other down
def design(
    scene: Scene,
    free: Mapping[str, tuple[float, float] | None],
    targets: Sequence[Target],
    *,
    seed: int = 0,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> FoundDesign:
    """Find numbers of a scene, within bounds, for which the results meet given targets.

    If several designs meet all targets, the one with the best value is returned, if a target requires the
    best; otherwise the one nearest to the scene, measured in fractions of the (logarithmic) ranges.  If no
    design meets all targets, the result states that and is the nearest one.  At most 60 designs are computed.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is used for crossings, amplitudes, peaks, strains and power.
    free : mapping of str to pair of float or None
        The numbers by their names in scene files, such as "beam.thickness", at most 6, each with its smallest
        and largest value [SI], or None for half and twice the value in the scene.
    targets : sequence of Target
        Required values of the results.
    seed : int
        Seed of the random designs with which a search over several numbers starts.
    discretization, tolerance
        As for `study`.

    Returns
    -------
    FoundDesign

    Raises
    ------
    ValueError
        If an argument is wrong, or no design within the bounds has a result.

    References
    ----------
    Sequential quadratic programming: Kraft (1988); one number: Alefeld, Potra and Shi (1995), Algorithm 748.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215))
    >>> resonance = bd.Target("frequencies", equals=80.0, speed=50.0)
    >>> found = bd.design(scene, {"beam.thickness": (0.1e-3, 0.4e-3)}, [resonance])
    >>> round(float(found.value[0] * 1e3), 6)  # mm
    0.253122
    """
    start = perf_counter()
    check_scene(scene)
    if not isinstance(free, Mapping) or not 0 < len(free) <= MOST_NUMBERS:
        bound = f"give 1 to {MOST_NUMBERS} numbers with their bounds"
        raise InvalidValue("free", free, bound, 'such as {"beam.thickness": (1e-4, 4e-4)}')
    inputs = tuple(_check_bounds(scene, path, bounds) for path, bounds in free.items())
    for corner in Designs(inputs).extremes():  # a scene must exist for each combination of bounds
        with_numbers(scene, corner)
    targets = _check_targets(targets)
    ranges = Ranges(inputs)
    given = np.array([number_at(scene, each.name) or 0.0 for each in inputs])
    middle = ranges.values(np.full(len(inputs), 0.5))
    own = ranges.shares(np.where(np.isfinite(given), given, middle))
    search = Search(scene, ranges, targets, own, discretization, tolerance)
    return _BestDesign(search, search.run(count("seed", seed, 0))).with_unmoved().result(given, start)


def _check_bounds(scene: Scene, path: str, bounds: object) -> VariedInput:
    if isinstance(path, str) and is_speed(path):
        bound = "the speed is no number of a scene"
        raise InvalidValue("free", path, bound, "give targets their speeds")
    check_path("free", path)
    own = number_at(scene, path)
    if bounds is None and own and np.isfinite(own):
        bounds = sorted((own / 2, own * 2))
    ends = as_floats(bounds)
    if ends is None or ends.shape != (2,) or not (np.isfinite(ends).all() and ends[0] < ends[1]):
        unit = unit_of(path) or ""
        raise InvalidValue(path, bounds, "give a least and a largest value, finite and ascending", "", unit)
    return VariedInput(path, unit_of(path) or "", ends)


def _check_targets(targets: object) -> tuple[Target, ...]:
    good = isinstance(targets, list | tuple) and targets and all(isinstance(t, Target) for t in targets)
    if not good:
        remedy = 'such as [bd.Target("frequencies", equals=62.0)]'
        raise InvalidValue("targets", targets, "give targets in a list", remedy)
    assert isinstance(targets, list | tuple)
    if sum(each.best is not None for each in targets) > 1:
        bound = "only one answer can be required to be the largest or smallest"
        raise InvalidValue("targets", [each.says for each in targets], bound, "give limits to the others")
    return tuple(targets)


@dataclass(frozen=True)
class _BestDesign:
    """Best design of a search, as fractions x of the numbers' ranges, with statements about it."""

    search: Search
    x: np.ndarray

    @cached_property
    def _excess(self) -> np.ndarray:
        return self.search.excess(self.x[None])[0]

    @cached_property
    def _met(self) -> np.ndarray:
        return self.search.met(self.x[None])[0]

    @cached_property
    def _slopes(self) -> np.ndarray:
        found = self.search.derivatives(self.x)
        _, error = self.search.known(self.x[None])
        rounded = np.where(np.abs(found) <= np.maximum(_SAME, error.T / DIFFERENCE), 0.0, found)
        level = [k for k in np.flatnonzero((rounded == 0).all(axis=0)).tolist() if not self._is_idle(k)]
        # At an extremum the derivatives by a number round to 0, although the number has an effect.  These
        # derivatives are not rounded, as a number whose derivatives are all 0 counts as without effect.
        rounded[:, level] = found[:, level]
        return rounded

    def _is_idle(self, k: int) -> bool:
        """Return whether number k has no effect: no result changes if it moves to its farther bound."""
        far = self.x.copy()
        far[k] = 0.0 if self.x[k] > 0.5 else 1.0
        with suppress(Spent):
            value, error = self.search.known(np.array([self.x, far]))
            change = np.abs(value[1] - value[0])
            return bool((change <= (error.sum(axis=0) + _SAME) * np.abs(value[0])).all())
        return False

    def with_unmoved(self) -> _BestDesign:
        """Return the design in which numbers without effect have the scene's values."""
        moved = np.where((self._slopes == 0).all(axis=0), self.search.own, self.x)
        if (moved == self.x).all():
            return self
        with suppress(Spent):
            if (self.search.met(moved[None])[0] == self._met).all():
                return replace(self, x=moved)
        return self

    def _limits(self) -> Iterator[str]:
        """Yield a sentence for each bound of a number and each limit of a result that the design reaches."""
        for each, x in zip(self.search.ranges.inputs, self.x.tolist(), strict=True):
            if x <= _AT or x >= 1 - _AT:
                at = "smallest" if x <= _AT else "largest"
                yield Words(InputName(each.name), f" is at its {at} value")
        for target, excess in zip(self.search.targets, self._excess.tolist(), strict=True):
            if target.is_limit and abs(excess) <= _AT:
                yield target.says

    def _only_one_way(self) -> bool:
        """Return whether monotone results explain why the design misses targets.

        They do if each result that misses its target is monotone in each number over all computed designs,
        and the design is at those bounds of the numbers that are best for each of these results.
        """
        designs = self.search.designs
        excess = self.search.excess(designs)
        for k in np.flatnonzero(~self._met):
            # Sign of the change of each number that brings the result nearer to the target.
            better = -np.sign(self._excess[k]) * np.sign(self._slopes[k])
            if self.search.targets[k].at_most is not None:
                better = -better
            if not (np.where(better > 0, self.x >= 1 - _AT, self.x <= _AT) | (better == 0)).all():
                return False
            z = designs * better
            above = (z[:, None] >= z).all(axis=2)
            gain = -np.sign(self._excess[k]) * (excess[:, None, k] - excess[:, k])
            if (gain[above] < -_SAME).any():
                return False
        return not self._met.all()

    def result(self, given: np.ndarray, start: float) -> FoundDesign:
        """Build the result of a search that started at a time of `perf_counter` [s].

        `given` are the values of the numbers in the scene.
        """
        search, x, proofs = self.search, self.x, Proofs(self.search, self.x)
        value, error = (each[0] for each in search.known(x[None]))
        studies = [search.studied(asked, x[None]) for asked in search.asked]
        low, high = np.array([each.values for each in search.ranges.inputs]).T
        return FoundDesign(
            names=tuple(each.name for each in search.ranges.inputs),
            units=tuple(each.unit for each in search.ranges.inputs),
            given=given,
            value=search.ranges.values(x),
            low=low,
            high=high,
            targets=search.targets,
            reached=value,
            error=error,
            met=self._met,
            derivative=value[:, None] * self._slopes / search.ranges.slopes(x),
            limited_by=tuple(self._limits()),
            only_one_way=self._only_one_way(),
            proof=proofs.no_nearer,
            why_none=proofs.none,
            solves=search.solves,
            warnings=tuple(dict.fromkeys(said for each in studies for said in each.warnings)),
            provenance=Provenance.since(
                start, studies[0].provenance.method, studies[0].provenance.compared_with
            ),
            scene=search.scene,
        )
