"""Effects that a model neglects, with the change that each would cause in a result, also in words."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import set_fields
from beamdyn.common.results.result import plain
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.results.statements import MODEL_ERROR, Speeds, Statement, joined
from beamdyn.common.words import Words, percent, told_from
from beamdyn.scene.physics import OfChosenPhysics
from beamdyn.scene.validity import list_speeds

LARGE_MODEL_ERROR = 0.01  # relative change by neglected effects above which a warning is given
_NEGLIGIBLE = 1e-9  # relative change below which the change may be a rounding error
_LARGE = 1000.0  # frequency [Hz] above which frequencies are printed as whole numbers
# Relative changes above which a change is printed as a factor, and above which this is in scientific
# notation.
_MANY_TIMES, _COUNTLESS = 10.0, 1e4


@dataclass(frozen=True)
class UnlistedMode:
    """Mode of the real body that a model does not have, because it neglects an effect.

    Parameters
    ----------
    kind : str
        Kind of the mode: torsion, or the direction of bending.
    number : int
        Number of the mode among all modes of its kind, from 1.
    effect : str
        Name of the effect that adds the mode to a model.
    frequency : ndarray
        Frequency [Hz] at each speed; nan where it is above the listed modes.
    assumed : str
        Assumption by which the frequency was computed; empty if none.
    """

    kind: str
    number: int
    effect: str
    frequency: np.ndarray
    assumed: str = ""

    def __post_init__(self) -> None:
        set_fields(self, frequency=np.asarray(self.frequency, dtype=float))

    def span(self) -> str:
        """Format the frequency to three digits; over several speeds as a range from lowest to highest."""
        known = self.frequency[np.isfinite(self.frequency)]
        both = (f"{at:.3g}" if at < _LARGE else f"{at:.0f}" for at in (known.min(), known.max()))
        return " to ".join(dict.fromkeys(both))


def spans_by_kind(modes: Sequence[UnlistedMode]) -> dict[str, str]:
    """Group the frequencies of modes by kind, as text: "79.9, 499 Hz"."""
    kinds = dict.fromkeys(mode.kind for mode in modes)
    return {kind: f"{', '.join(mode.span() for mode in modes if mode.kind == kind)} Hz" for kind in kinds}


def say_unlisted(modes: Sequence[UnlistedMode]) -> str:
    """Describe modes by kind: "torsion 656 Hz, flap 79.9, 499 Hz"."""
    assumed = {mode.kind: f" ({mode.assumed})" for mode in modes if mode.assumed}
    return ", ".join(f"{kind} {span}{assumed.get(kind, '')}" for kind, span in spans_by_kind(modes).items())


@dataclass(frozen=True)
class LeftOutEffects:
    """Changes of a result by the effects that a model neglects.

    Parameters
    ----------
    changes : dict of str to ndarray
        Relative change of each value of the result by adding the effect of that name; nan where it is
        unknown.
    not_known : dict of str to str
        Effects whose change is unknown for at least one value, with the reason or the missing input.
    assumed : dict of str to str
        Effects whose change is based on an assumption, with the assumption.
    not_modelled : tuple of str
        Effects that no model of this program can include.
    reasons : dict of str to str
        What the model assumes without each effect, and how to include the effect.
    shape : tuple of int
        Shape of the values of the result, and of each change.
    unlisted : tuple of UnlistedMode
        Modes of the real body that the model does not have, up to the highest mode listed.
    reversals : dict of str to str
        Effects that make a vibrating mode diverge or a diverging one vibrate, with a text that states which.
    counted : str
        Noun for what the last axis of the values counts, such as "mode".
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
        """Magnitude of the sum of all changes; nan where one of the changes is not known."""
        return np.abs(sum(self.changes.values(), np.zeros(self.shape)))

    @property
    def total_of_known(self) -> np.ndarray:
        """Magnitude of the sum of the known changes."""
        return np.abs(sum(map(np.nan_to_num, self.changes.values()), np.zeros(self.shape)))

    @property
    def lack_data(self) -> bool:
        """Whether the beam lacks data for an effect, whose change is then missing in the sum."""
        return bool(self.not_known.keys() - self.changes.keys())

    def at(self, index: Any) -> LeftOutEffects:
        """Select the changes of some values by their indices."""
        changes = {name: np.asarray(change[index]) for name, change in self.changes.items()}
        # If modes are the last axis, an index selects speeds.
        first = index[0] if isinstance(index, tuple) else index
        unlisted = tuple(replace(mode, frequency=mode.frequency[first]) for mode in self.unlisted)
        return replace(self, changes=changes, shape=np.zeros(self.shape)[index].shape, unlisted=unlisted)

    # Changes in words ------------------------------------------------------------------------------

    def sentence(self, what: str | None = None, where: str = "", speeds: np.ndarray | None = None) -> Words:
        """Summarize in one line: largest change by each effect, unknown changes, and effects without a model.

        Parameters
        ----------
        what : str, optional
            Noun for what the last axis of the values counts, in place of `counted`; "" if there is one value.
        where : str
            Conditions of the values, such as "at 100 rad/s"; the line begins with it.
        speeds : ndarray, optional
            Speeds [rad/s] of the first axis; a change that is largest at another speed is printed with the
            speed.
        """
        what = self.counted if what is None else what
        changes = joined(", ", self._say_changes(what, where, speeds))
        parts: list[str] = [changes or "nothing that can be computed"]
        reasons: dict[str, list[str]] = {}  # effects with the same reason are named together
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
        """Format the speeds at which a change is unknown; empty if the speeds or the change are not given."""
        change = self.changes.get(name)
        if speeds is None or change is None or not len(speeds):
            return ""
        unknown = np.asarray(np.isnan(change).reshape(len(change), -1).any(axis=1))
        return Words("at ", list_speeds(speeds, unknown)) if unknown.any() else ""

    def _say_changes(self, what: str, where: str, speeds: np.ndarray | None) -> Iterator[str]:
        """Yield the largest change by each effect, with the value (such as "mode 2") and speed concerned."""
        known = {name: change for name, change in self.changes.items() if np.isfinite(change).any()}
        for name in sorted(known, key=lambda name: -np.nanmax(np.abs(known[name]))):
            change, notes = known[name], []
            if abs(_largest(change)) < _NEGLIGIBLE:
                if name in self.not_known:  # not listed as small: changes of other values are unknown
                    continue
            else:
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
        """Yield warnings of changes past a tolerance or 1 %, of unknown ones, and of changed stability.

        Parameters
        ----------
        tolerance : float, optional
            Largest acceptable relative change; 1 % if not given.
        where : str
            Conditions of the largest change: see `sentence`.
        where_unknown : callable
            Function from an effect's name to the conditions at which its change is unknown; empty means
            `where`.
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
            shown, bound = say_size(at_least), say_size(limit)
            shown = f"{told_from(100 * at_least, 100 * limit)} %" if shown == bound else shown
            size = f"{'at least ' if partial else ''}{shown}, exceeds {bound}"
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
            said = f" may exceed {say_size(limit)}: the change by {', '.join(names)}, left out, is unknown: "
            end = said, why
            yield Statement(*begin, *end, kind=MODEL_ERROR, quantity="model error", limit=limit)


def _largest(change: np.ndarray) -> float:
    """Return the finite value of the largest magnitude, with its sign."""
    known = change[np.isfinite(change)]
    return float(known[np.abs(known).argmax()])


def say_change(change: float) -> str:
    """Format a relative change in percent, with two digits and its sign."""
    if abs(change) < _NEGLIGIBLE:
        return "0 %" if change == 0 else "below 1e-7 %"
    if abs(change) < _MANY_TIMES:
        return percent(change, "+")
    return f"{change:+.0f} times" if abs(change) < _COUNTLESS else f"{change:+.1e} times"


def say_size(size: float) -> str:
    """Format a relative size in percent, with two digits, or as words if it is not known."""
    return "not known" if np.isnan(size) else say_change(size).removeprefix("+")


# Results that state a model error -----------------------------------------------------------------


class NotJudged(LeftOutEffects):
    """Placeholder for changes by neglected effects that take long to compute and were not requested."""

    def sentence(self, what: str | None = None, where: str = "", speeds: np.ndarray | None = None) -> Words:
        """Explain how to request the model error."""
        return Words(
            "What the model leaves out is not computed yet: ask for model_error, which takes more solutions."
        )


class StatesModelError(OfChosenPhysics):
    """Base class of results that state the changes by effects that their model neglects.

    A subclass has the property `left_out_effects`, which is computed at its first use and cached.

    Attributes
    ----------
    judged_by_solving : bool
        Whether the model error takes longer to compute than the result.
    judged_value, counted : str
        Nouns for the values that have the model error, and for one of several values; used below a table.
    """

    kept = ("left_out_effects",)
    left_out_effects: Any
    judged_by_solving: ClassVar[bool] = False
    judged_value: str = ""
    counted: ClassVar[str] = ""

    def without_waiting(self) -> Any:
        """Return the result for immediate display: a model error that would take long is then omitted."""
        if not self.judged_by_solving or "left_out_effects" in vars(self):
            return self
        shape = np.shape(getattr(self, "left_out_speeds", 0.0))
        shown = copy(self)
        vars(shown)["left_out_effects"] = NotJudged({}, {}, {}, (), {}, shape)
        return shown

    @property
    def left_out(self) -> Mapping[str, np.ndarray]:
        """Relative change of the values by adding each neglected effect, by name of the effect.

        Effects without data, or that no model can include, are only in `left_out_effects`.
        """
        return MappingProxyType(self.left_out_effects.changes)

    @property
    def model_error(self) -> np.ndarray:
        """Magnitude of the sum of all changes in `left_out`; nan where one of the changes is not known."""
        return self.left_out_effects.total

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """List warnings of a model error above a tolerance or 1 %, and of an unknown one."""
        speeds = getattr(self, "left_out_speeds", None)
        effects = self.left_out_effects
        where = "" if speeds is None else where_worst(effects, speeds)
        return [*effects.warnings(tolerance, where, lambda name: effects.where_unknown(name, speeds))]

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to numbers, lists and strings, with model error and neglected effects.

        The warnings include those of a model error above 1 %.
        """
        effects, values = self.left_out_effects, super().to_dict()
        values["warnings"] = [*values.get("warnings", ()), *self.model_warnings()]
        judged = {"model_error": self.model_error, "left_out": effects.changes}
        named = {"not_known": effects.not_known, "assumed": effects.assumed}
        named |= {"not_modelled": effects.not_modelled, "unlisted_modes": effects.unlisted}
        return values | plain(judged | named)


def where_worst(effects: LeftOutEffects, speeds: np.ndarray) -> str:
    """Format the speed of the largest model error as "at 100 rad/s", or all speeds if it is unknown."""
    total = effects.total
    if not np.isfinite(total).any():
        return Words("at ", list_speeds(speeds, np.ones(len(speeds), bool))) if len(speeds) else ""
    worst = np.nanargmax(total) // (total.size // len(total))
    return Words("at ", Speeds(speeds[worst]))
