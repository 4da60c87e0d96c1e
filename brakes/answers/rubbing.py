"""Self-locking, friction and heating, for results of drum brakes and of brakes pressed by one force."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.pictures import Figure
from brakes.answers import tables
from brakes.answers.base import Answer, ArrayBrakeType, FileModel
from brakes.answers.doubts import PART, change
from brakes.common.heat import Fade, repeat_stops
from brakes.config.load import LoadInput
from brakes.drawings.machine import beside_charts

HEAT = tables.take_fields(
    Fade, "hottest settled first_angle last_angle first_friction last_friction energy pv"
)
_SHOWN = 10  # largest number of stops in the table of repeated stops


@dataclass(frozen=True)
class RubbingAnswer(Answer):
    """Base of results of brakes that slide or lock: forces, and heating in repeated stops.

    Attributes
    ----------
    design : BaseModel
        The design that the file describes.
    result : BrakeResult or MachineResult
        The forces in the brake.
    fade : Fade, optional
        Repeated stops, if the file has [heat]; None if the brake locks.
    """

    solver: ClassVar[Callable[..., Any]]

    design: Any
    result: Any
    fade: Fade | None = None

    @property
    def error(self) -> Any:
        """Upper bound of the relative error of torque, forces and C*; nan where the brake locks."""
        return self.result.error

    @property
    def warnings(self) -> Sequence[str]:
        """Warnings of repeated stops, and of a friction curve that does not start with [brake]'s friction."""
        if self.fade is None:
            return ()
        given, first = self.result.friction, self.fade.first_friction
        other = np.ndim(first) == 0 and abs(first - given) > 1e-9 * given
        said = f"the curve in [heat] begins at friction {first:.4g}, [brake] has {given:.4g}" if other else ""
        return (*self.fade.warnings, *([said] if said else []))

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on a brake that locks, and on a stop that does not end."""
        locks = (self.result.message,) if np.any(self.result.locked) else ()
        return (*locks, *(() if self.fade is None else self.fade.refusals))

    def refusals_of_cases(self, count: int) -> dict[int, str]:
        """Return a sentence on each design that locks or does not stop, by the index of the design.

        `count` is the number of all designs.
        """
        hot = {} if self.fade is None else self.fade.messages_of_cases(count)
        return hot | self.result.messages_of_locked(count)

    def again(self, brake: Any = None, **changed: Any) -> Any:
        """Repeat the solution at the same force, with another brake, friction or rotation."""
        result = self.result
        given = {name: getattr(result, name) for name in ("friction", "force", "reverse")}
        return type(self).solver(brake or result.brake, **given | changed)

    def stop_again(self) -> Answer:
        """Return this answer with the file's repeated stops, if it has any and the brake does not lock."""
        if self.design.heat is None or np.all(self.result.locked):
            return self
        duty, result = self.design.heat.core, self.result
        pv = result.peak_pressure * result.brake.rubbing_radius * duty.speed
        return replace(
            self, fade=repeat_stops(duty, result.friction, lambda mu: self.again(friction=mu).torque, pv)
        )

    def further_tables(self) -> list[RenderableType]:
        """Make the tables of repeated stops and of the influence of friction; none for a brake that locks."""
        if self.result.locked:
            return []
        return [*([] if self.fade is None else stops_tables(self.fade)), self._doubt()]

    def _doubt(self) -> str:
        """State how the torque changes at the same force by friction, by the pressure law, and in reverse."""
        torque, mu, back = self.result.torque, self.result.friction, not self.result.reverse
        ends = ", ".join(
            _change(self.again(friction=part * mu).torque, torque) for part in (1 - PART, 1 + PART)
        )
        others = [f"{words} {_change(self.again(each).torque, torque)}" for words, each in self.other_laws()]
        turned = self.again(reverse=back).torque
        if not abs(turned - torque) <= 1e-9 * torque:  # true also for nan, when the brake locks
            others.append(f"{'reverse' if back else 'forward'} {_change(turned, torque)}")
        said = "; ".join((f"friction -+{100 * PART:.0f} %: {ends}", *others))
        return f"At this force, torque {tables.format_number(torque)} N m; {said}."

    def doubtful(self) -> Iterator[Any]:
        """Yield results at the file's load with less and more friction, and under other pressure laws.

        If the file gives a torque, a brake that locks with the other friction or law has no result at this
        torque. It is then solved at the actuating force of this answer.
        """
        brake, mu = self.result.brake, self.result.friction
        others = ((other, mu) for _, other in self.other_laws())
        for varied, friction in (*((brake, part * mu) for part in (1 - PART, 1 + PART)), *others):
            try:
                yield self.at_load(varied, friction)
            except InvalidValue:
                yield self.again(varied, friction=friction)

    def at_load(self, brake: Any, friction: Any) -> Any:
        """Solve a brake with a friction coefficient at the load that the file gives."""
        given = self.design.load.given | {"reverse": self.result.reverse}
        return type(self).solver(brake, friction=friction, **given)

    def other_laws(self) -> Iterator[tuple[str, Any]]:
        """Yield the name of each other pressure law, and the brake under this law, if possible."""
        brake = self.result.brake
        for law in (each for each in brake.laws if each != brake.law):
            with suppress(InvalidValue):
                yield brake.laws[law], brake.with_law(law)

    def rows(self) -> Iterable[Sequence[object]]:
        """Make rows of name, value and unit of all outputs, for a file."""
        return tables.outputs_csv((*self.outputs(), *heat_outputs(self.design)), value=self)

    def figure(self, place: float | None = None) -> Figure:
        """Draw the brake with its forces, and beside it charts of pressures and brake factors."""
        ((drawing, *_), *_) = self.drawings(0.0)
        return beside_charts(drawing, self.charts(0.0))

    @abstractmethod
    def outputs(self) -> tuple[Output, ...]:
        """Describe the outputs of the brake and its linings that tables, sweeps and files show."""

    def loadable(self) -> Any:
        """Return the result with the forces, which can be saved to a file; None if stops are repeated."""
        return self.result if self.fade is None else None

    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""
        return self.result.to_dict() | ({} if self.fade is None else {"heat": self.fade.to_dict()})


class RubbingType(ArrayBrakeType[FileModel]):
    """Base of types of brakes that slide or lock: it states which results screen and sweeps show first."""

    error_from = "rounding of inputs and sums, divided by the margin to self-locking"
    key_results = (("torque", "torque"), ("brake factor C*", "c_star"), ("margin to self-locking", "margin"))
    together = f"[load]: {LoadInput.ONE}."
    sweep_results = "torque,c_star,peak_pressure"


def heat_outputs(design: Any) -> tuple[Output, ...]:
    """Describe the outputs on repeated stops; none if the file has no data for heating."""
    return () if design.heat is None else tables.take_from(lambda answer: answer.fade, HEAT)


def stops_tables(fade: Fade) -> Iterator[RenderableType]:
    """Make two tables of repeated stops: of all stops together, and of each stop."""
    title = f"Heat at this force; number of stops: {len(fade.end)}; no cooling while the brake acts"
    yield tables.outputs_table(title, HEAT, fade)
    names = [str(i + 1) for i in range(len(fade.end))][:_SHOWN]
    columns = [fade.start - 273.15, fade.end - 273.15, fade.end_friction, fade.angle, fade.heat]
    cells = [[name, *(tables.format_number(each[i]) for each in columns)] for i, name in enumerate(names)]
    heads = ("stop", "from [degC]", "to [degC]", "friction at its end", "angle [rad]", "heat [J]")
    yield table(
        "Stop by stop" if len(fade.end) <= _SHOWN else f"The first {_SHOWN} stops", heads, cells, (0,)
    )


def _change(other: float, torque: float) -> str:
    """State the torque `other` and its relative change from `torque`; "locks" if it is not finite."""
    return change(other, torque, "N m", "locks")
