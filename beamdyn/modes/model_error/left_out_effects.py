"""The effects that a model leaves out, each with the change that it would make in an answer, and in words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import set_fields
from beamdyn.common.results.digits import percent
from beamdyn.common.results.result import plain
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import MODEL_ERROR, Speeds, Statement, joined
from beamdyn.common.words import Words
from beamdyn.scene.physics import OfChosenPhysics
from beamdyn.scene.validity import list_speeds

LARGE_MODEL_ERROR = 0.01  # relative change by what is left out, above which a warning says so
_NEGLIGIBLE = 1e-9  # relative change that is not told from rounding
_LARGE = 1000.0  # frequency [Hz] from which it is said in whole numbers
_MANY_TIMES, _COUNTLESS = 10.0, 1e4  # relative changes above which percent, and all digits, say little


@dataclass(frozen=True)
class UnlistedMode:
    """A mode of the body that a model does not have.

    Parameters
    ----------
    kind : str
        Its kind: torsion, or the direction of bending.
    number : int
        Its number among those of its kind, from 1.
    effect : str
        Name of the effect with which a model has it.
    frequency : ndarray
        Its frequency [Hz] at each speed; nan where it lies above the modes listed.
    assumed : str
        What the frequency rests on; empty if on nothing that was not given.
    """

    kind: str
    number: int
    effect: str
    frequency: np.ndarray
    assumed: str = ""

    def __post_init__(self) -> None:
        set_fields(self, frequency=np.asarray(self.frequency, dtype=float))

    def span(self) -> str:
        """Its frequency to three digits; over several speeds from the least to the largest."""
        known = self.frequency[np.isfinite(self.frequency)]
        both = (f"{at:.3g}" if at < _LARGE else f"{at:.0f}" for at in (known.min(), known.max()))
        return " to ".join(dict.fromkeys(both))


def spans_by_kind(modes: Sequence[UnlistedMode]) -> dict[str, str]:
    """Frequencies of modes by their kind: "79.9, 499 Hz"."""
    kinds = dict.fromkeys(mode.kind for mode in modes)
    return {kind: f"{', '.join(mode.span() for mode in modes if mode.kind == kind)} Hz" for kind in kinds}


def say_unlisted(modes: Sequence[UnlistedMode]) -> str:
    """Name modes by kind: "torsion 656 Hz, flap 79.9, 499 Hz"."""
    assumed = {mode.kind: f" ({mode.assumed})" for mode in modes if mode.assumed}
    return ", ".join(f"{kind} {span}{assumed.get(kind, '')}" for kind, span in spans_by_kind(modes).items())


@dataclass(frozen=True)
class LeftOutEffects:
    """Changes of an answer by the effects that a model leaves out.

    Parameters
    ----------
    changes : dict of str to ndarray
        Relative change of each value of the answer by adding the effect of that name; nan where that is not
        known.
    not_known : dict of str to str
        Effects whose change is not known, for some value at least, and why, or what to give.
    assumed : dict of str to str
        Effects whose change rests on an assumption, and on which.
    not_modelled : tuple of str
        Effects that no model here has.
    reasons : dict of str to str
        What the model assumes in place of each effect, and how to include it.
    shape : tuple of int
        Shape of the values, which each change has.
    unlisted : tuple of UnlistedMode
        Modes of the body that the model does not have, below the highest that it lists.
    reversals : dict of str to str
        Effects by which a mode that vibrates diverges, or the other way round, and which of the two.
    counted : str
        What the last axis of the values counts.
    """

    changes: dict[str, np.ndarray]
    not_known: dict[str, str]
    assumed: dict[str, str]
    not_modelled: tuple[str, ...]
    reasons: dict[str, str]
    shape: tuple[int, ...] = ()
    unlisted: tuple[UnlistedMode, ...] = ()
    reversals: dict[str, str] = field(default_factory=dict)
    counted: str = field(default="mode", metadata=ADDED_LATER)

    @property
    def total(self) -> np.ndarray:
        """Size of the sum of all changes; nan where one of them is not known."""
        return np.abs(sum(self.changes.values(), np.zeros(self.shape)))

    @property
    def total_of_known(self) -> np.ndarray:
        """Size of the sum of the changes that are known."""
        return np.abs(sum(map(np.nan_to_num, self.changes.values()), np.zeros(self.shape)))

    @property
    def lack_data(self) -> bool:
        """Whether the beam lacks the data of an effect, which is not in the sum then."""
        return bool(self.not_known.keys() - self.changes.keys())

    def at(self, index: Any) -> LeftOutEffects:
        """Select the changes of some of the values."""
        changes = {name: np.asarray(change[index]) for name, change in self.changes.items()}
        first = (
            index[0] if isinstance(index, tuple) else index
        )  # of the speeds, where modes are the last axis
        unlisted = tuple(replace(mode, frequency=mode.frequency[first]) for mode in self.unlisted)
        return replace(self, changes=changes, shape=np.zeros(self.shape)[index].shape, unlisted=unlisted)

    # In words -----------------------------------------------------------------------------------------

    def sentence(self, what: str | None = None, where: str = "", speeds: np.ndarray | None = None) -> Words:
        """One line: the largest change by each effect, what is not known, and what is not modelled.

        Parameters
        ----------
        what : str, optional
            What the last axis of the values counts, in place of `counted`; "" where there is one value.
        where : str
            Where the values hold, said first: "at 100 rad/s".
        speeds : ndarray, optional
            Speeds [rad/s] of the first axis: what holds elsewhere than `where` is said with its own.
        """
        what = self.counted if what is None else what
        parts: list[str] = [
            joined(", ", self._say_changes(what, where, speeds)) or "nothing that can be computed"
        ]
        reasons: dict[str, list[str]] = {}  # effects of one reason are named together
        for name, why in self.not_known.items():
            place = self.where_unknown(name, speeds)
            full = why if not place or place == where else Words(why, "; ", place)
            reasons.setdefault(full, []).append(name)
        if reasons:
            said = (Words(f"{', '.join(names)} (", why, ")") for why, names in reasons.items())
            parts.append(Words("not known: ", joined(", ", said)))
        if self.unlisted:
            parts.append(f"modes not listed: {say_unlisted(self.unlisted)}")
        if self.not_modelled:
            parts.append(f"not modelled: {', '.join(self.not_modelled)}")
        begin = ("left out ", where) if where else ("left out",)
        return Words(*begin, ": ", joined("; ", parts))

    def where_unknown(self, name: str, speeds: np.ndarray | None) -> str:
        """The speeds at which a change is not known; empty if these are not given, or it is known at all."""
        change = self.changes.get(name)
        if speeds is None or change is None or not len(speeds):
            return ""
        unknown = np.asarray(np.isnan(change).reshape(len(change), -1).any(axis=1))
        return Words("at ", list_speeds(speeds, unknown)) if unknown.any() else ""

    def _say_changes(self, what: str, where: str, speeds: np.ndarray | None) -> Iterator[str]:
        """The largest change by each effect, with the number of its value and the speed."""
        known = {name: change for name, change in self.changes.items() if np.isfinite(change).any()}
        for name in sorted(known, key=lambda name: -np.nanmax(np.abs(known[name]))):
            change, notes = known[name], []
            if abs(_largest(change)) >= _NEGLIGIBLE:
                first = int(np.nanargmax(np.abs(change)))
                if what and change.ndim and change.shape[-1] > 1:
                    notes.append(f"{what} {first % change.shape[-1] + 1}")
                place = ""
                if speeds is not None:
                    place = Words("at ", Speeds(speeds[first // (change.size // len(change))]))
                notes.append(place if place != where else "")
            note = joined(", ", filter(None, [*notes, self.assumed.get(name, "")]))
            said = f"{name} {say_change(_largest(change))}"
            yield Words(said, " (", note, ")") if note else said

    def warnings(
        self,
        tolerance: float | None = None,
        where: str = "",
        where_unknown: Callable[[str], str] = lambda name: "",
    ) -> Iterator[Statement]:
        """Yield warnings of changes past a tolerance, or 1 %, of unknown ones, and of verdicts they reverse.

        Parameters
        ----------
        tolerance : float, optional
            The tolerance.
        where : str
            Where the largest change is, as for `sentence`.
        where_unknown : callable
            Where the change by an effect of a name is not known; empty if that is where the largest is.
        """
        for name, how in self.reversals.items():
            begin = (where_unknown(name), " ") if where_unknown(name) else ()
            end = f"the model error decides on stability: {name} is left out, and {how}; "
            yield Statement(*begin, end, self.reasons[name], kind=MODEL_ERROR, quantity="stability")
        limit = LARGE_MODEL_ERROR if tolerance is None else max(tolerance, _NEGLIGIBLE)
        at_least = float(self.total_of_known.max(initial=0.0))
        if at_least > limit:
            begin = (where, " the model error") if where else ("the model error",)
            partial = np.isnan(self.total[self.total_of_known == at_least]).any()
            size = f"{'at least ' if partial else ''}{say_size(at_least)}, exceeds {say_size(limit)}"
            largest = max(self.changes, key=lambda name: np.abs(np.nan_to_num(self.changes[name])).max())
            change, how = say_change(_largest(self.changes[largest])), self.reasons.get(largest, "")
            assumed = f" ({self.assumed[largest]})" if largest in self.assumed else ""
            said = f", {size}: {largest}, left out, changes the answer by {change}{assumed}"
            data = {"quantity": "model error", "value": at_least, "limit": limit}
            yield Statement(*begin, said, *(("; ", how) if how else ()), kind=MODEL_ERROR, **data)
            return
        unknown: dict[tuple[str, str], list[str]] = {}
        for name, why in self.not_known.items():
            if name in self.changes and name not in self.reversals and np.isnan(self.changes[name]).any():
                unknown.setdefault((where_unknown(name) or where, why), []).append(name)
        for (place, why), names in unknown.items():
            begin = (place, " the model error") if place else ("the model error",)
            end = (
                f" may exceed {say_size(limit)}: what {', '.join(names)}, left out, changes is not known: ",
                why,
            )
            yield Statement(*begin, *end, kind=MODEL_ERROR, quantity="model error", limit=limit)


def _largest(change: np.ndarray) -> float:
    """The value of the largest size."""
    known = change[np.isfinite(change)]
    return float(known[np.abs(known).argmax()])


def say_change(change: float) -> str:
    """A relative change in percent, to two digits, with its sign."""
    if abs(change) < _NEGLIGIBLE:
        return "0 %" if change == 0 else "below 1e-7 %"
    if abs(change) < _MANY_TIMES:
        return percent(change, "+")
    return f"{change:+.0f} times" if abs(change) < _COUNTLESS else f"{change:+.1e} times"


def say_size(size: float) -> str:
    """A relative size in percent, to two digits; in words where it is not known."""
    return "not known" if np.isnan(size) else say_change(size).removeprefix("+")


# Results that carry it ----------------------------------------------------------------------------


class NotJudged(LeftOutEffects):
    """Stands for what the effects left out would change where that takes long and was not asked for."""

    def sentence(self, what: str | None = None, where: str = "", speeds: np.ndarray | None = None) -> Words:
        """Say how it is asked for."""
        return Words(
            "What the model leaves out is not computed yet: ask for model_error, which takes some solutions."
        )


class StatesModelError(OfChosenPhysics):
    """Base of results that say what the effects left out of their model would change; see `OfChosenPhysics`.

    A subclass has the cached property `left_out_effects`, which is computed when asked for.

    Attributes
    ----------
    judged_by_solving : bool
        Whether the model error takes longer than the answer.
    judged_value, counted : str
        The values of which it is the error, and what each of several is, where a line says so below a table.
    """

    kept = ("left_out_effects",)
    left_out_effects: Any
    judged_by_solving: ClassVar[bool] = False
    judged_value: str = ""
    counted: ClassVar[str] = ""

    def without_waiting(self) -> Any:
        """Leave out model errors that take long and were not asked for: the result can be shown at once."""
        if not self.judged_by_solving or "left_out_effects" in vars(self):
            return self
        shape = np.shape(getattr(self, "left_out_speeds", 0.0))
        shown = copy(self)
        vars(shown)["left_out_effects"] = NotJudged({}, {}, {}, (), {}, shape)
        return shown

    @property
    def left_out(self) -> Mapping[str, np.ndarray]:
        """Relative change by adding each effect that the model leaves out, by the effect's name.

        Effects that lack data, or that no model here has, are named by `left_out_effects`.
        """
        return MappingProxyType(self.left_out_effects.changes)

    @property
    def model_error(self) -> np.ndarray:
        """Size of the sum of all changes in `left_out`; nan where one of them is not known."""
        return self.left_out_effects.total

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """Warnings of a model error past a tolerance, or 1 %, and of one that is not known."""
        speeds = getattr(self, "left_out_speeds", None)
        effects = self.left_out_effects
        where = "" if speeds is None else where_worst(effects, speeds)
        return [*effects.warnings(tolerance, where, lambda name: effects.where_unknown(name, speeds))]

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings, with its model error and what is left out.

        Its warnings include those of the model error past 1 %.
        """
        effects, values = self.left_out_effects, super().to_dict()
        values["warnings"] = [*values.get("warnings", ()), *self.model_warnings()]
        judged = {"model_error": self.model_error, "left_out": effects.changes}
        named = {"not_known": effects.not_known, "assumed": effects.assumed}
        named |= {"not_modelled": effects.not_modelled, "unlisted_modes": effects.unlisted}
        return values | plain(judged | named)


def where_worst(effects: LeftOutEffects, speeds: np.ndarray) -> str:
    """Where a model error over speeds (k,) is largest, "at 100 rad/s"; at which where it is not known."""
    total = effects.total
    if not np.isfinite(total).any():
        return Words("at ", list_speeds(speeds, np.ones(len(speeds), bool))) if len(speeds) else ""
    worst = np.nanargmax(total) // (total.size // len(total))
    return Words("at ", Speeds(speeds[worst]))
