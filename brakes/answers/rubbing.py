"""What the answers on drum brakes and on brakes pressed by one force share: doubts, heat, what locks."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.tables import table
from beamdyn.common.inputs.checks import InvalidValue
from brakes.answers.base import Answer
from brakes.answers.doubts import PART, change
from brakes.answers.tables import (
    format_number,
    outputs_csv,
    outputs_table,
    take_fields,
    take_from,
)
from brakes.common.heat import Fade, repeat_stops

HEAT = take_fields(Fade, "hottest settled first_angle last_angle first_friction last_friction energy pv")
_SHOWN = 10  # stops


@dataclass(frozen=True)
class RubbingAnswer(Answer):
    """Forces in a brake that slides or locks, and how hot it gets.

    Attributes
    ----------
    design : BaseModel
        The file.
    result : BrakeResult or MachineResult
        The forces.
    fade : Fade, optional
        The stops of [heat]; none if the brake locks.
    """

    solver: ClassVar[Callable[..., Any]]

    design: Any
    result: Any
    fade: Fade | None = None

    @property
    def error(self) -> Any:
        """Bound of the relative error of torque, forces and C*; nan where the brake locks."""
        return self.result.error

    @property
    def warnings(self) -> Sequence[str]:
        """Limits that are passed, and a curve that begins with another friction than that of [brake]."""
        if self.fade is None:
            return ()
        given, first = self.result.friction, self.fade.first_friction
        other = np.ndim(first) == 0 and abs(first - given) > 1e-9 * given
        said = (
            f"[heat] begins with friction {first:.4g} of its curve, [brake] has {given:.4g}" if other else ""
        )
        return (*self.fade.warnings, *([said] if said else []))

    @property
    def refusals(self) -> Sequence[str]:
        """A sentence if the brake locks, or a stop does not end."""
        locks = (self.result.message,) if np.any(self.result.locked) else ()
        return (*locks, *(() if self.fade is None else self.fade.refusals))

    def refusals_of_cases(self, count: int) -> dict[int, str]:
        """A sentence on each design whose brake locks, or of which a stop does not end, by row."""
        hot = {} if self.fade is None else self.fade.messages_of_cases(count)
        return hot | self.result.messages_of_locked(count)

    def again(self, brake: Any = None, **changed: Any) -> Any:
        """The result of the same force, with another brake, friction or direction."""
        result = self.result
        given = {name: getattr(result, name) for name in ("friction", "force", "reverse")}
        return type(self).solver(brake or result.brake, **given | changed)

    def stop_again(self) -> Answer:
        """The answer with the stops of the file, if it has any and the brake does not lock."""
        if self.design.heat is None or np.all(self.result.locked):
            return self
        duty, result = self.design.heat.core, self.result
        pv = result.peak_pressure * result.brake.rubbing_radius * duty.speed
        return replace(
            self, fade=repeat_stops(duty, result.friction, lambda mu: self.again(friction=mu).torque, pv)
        )

    def further_tables(self) -> list[RenderableType]:
        """The stops, and what the torque hangs on; nothing of a brake that locks."""
        if self.result.locked:
            return []
        return [*([] if self.fade is None else stops_tables(self.fade)), self._doubt()]

    def _doubt(self) -> str:
        """The torque at this force with less and more friction, under other laws, and in reverse."""
        torque, mu, back = self.result.torque, self.result.friction, not self.result.reverse
        ends = ", ".join(
            _change(self.again(friction=part * mu).torque, torque) for part in (1 - PART, 1 + PART)
        )
        others = [f"{words} {_change(found, torque)}" for words, found in self.by_other_laws()]
        turned = self.again(reverse=back).torque
        if not abs(turned / torque - 1) < 1e-9:  # also where it locks
            others.append(f"{'reverse' if back else 'forward'} {_change(turned, torque)}")
        said = "; ".join((f"friction -+{100 * PART:.0f} %: {ends}", *others))
        return f"At this force, torque {format_number(torque)} N m; {said}."

    def by_other_laws(self) -> Iterator[tuple[str, float]]:
        """Words and torque of the other laws of the pressure, with the same force."""
        return ((words, self.again(brake).torque) for words, brake in self._other_laws())

    def doubtful(self) -> Iterator[Any]:
        """Results of the same load with less and more friction, and under other laws of the pressure."""
        result, given = self.result, self.design.load.given | {"reverse": self.result.reverse}
        for part in (1 - PART, 1 + PART):
            yield type(self).solver(result.brake, friction=part * result.friction, **given)
        for _, brake in self._other_laws():
            yield type(self).solver(brake, friction=result.friction, **given)

    def _other_laws(self) -> Iterator[tuple[str, Any]]:
        """Words of the other laws of the pressure, and the brake under each, where there can be one."""
        brake = self.result.brake
        for law in (each for each in brake.laws if each != brake.law):
            with suppress(InvalidValue):
                yield brake.laws[law], brake.with_law(law)

    def rows(self) -> Iterable[Sequence[object]]:
        """Names, values and units of all numbers."""
        return outputs_csv((*self.outputs(), *heat_outputs(self.design)), value=self)

    @abstractmethod
    def outputs(self) -> tuple[Output, ...]:
        """Numbers of the brake and of its linings."""

    def loadable(self) -> Any:
        """The result of the mechanics, if there is no other."""
        return self.result if self.fade is None else None

    def values(self) -> dict[str, Any]:
        """The results as plain numbers, lists and strings."""
        fade = {} if self.fade is None else {"heat": self.fade.to_dict()}
        return self.result.to_dict() | fade


def heat_outputs(design: Any) -> tuple[Output, ...]:
    """Numbers of the stops, if the file has them."""
    return () if design.heat is None else take_from(lambda answer: answer.fade, HEAT)


def stops_tables(fade: Fade) -> Iterator[RenderableType]:
    """The stops as a whole, and one by one."""
    title = f"Heat in {len(fade.end)} stops at this force, without cooling while it brakes"
    yield outputs_table(title, HEAT, fade)
    names = [str(i + 1) for i in range(len(fade.end))][:_SHOWN]
    columns = [fade.start - 273.15, fade.end - 273.15, fade.end_friction, fade.angle, fade.heat]
    cells = [[name, *(format_number(each[i]) for each in columns)] for i, name in enumerate(names)]
    heads = ("stop", "from [degC]", "to [degC]", "friction at its end", "angle [rad]", "heat [J]")
    yield table(
        "Stop by stop" if len(fade.end) <= _SHOWN else f"The first {_SHOWN} stops", heads, cells, (0,)
    )


def _change(other: float, torque: float) -> str:
    """A torque and its relative change."""
    return change(other, torque, "N m", "locks")
