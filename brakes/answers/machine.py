"""Answers on brakes whose linings are pressed by one force: each type names its class and its drawings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rich.console import RenderableType

from beamdyn.common.drawing.chart import Chart
from beamdyn.common.drawing.shapes import Drawing
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.tables import table
from beamdyn.common.inputs.checks import InvalidValue
from brakes.answers.base import Answer, ArrayBrakeType
from brakes.answers.rubbing import RubbingAnswer, heat_outputs
from brakes.answers.tables import list_outputs, take_fields, take_from
from brakes.config.load import LoadInput
from brakes.config.machine import MachineInput, file_of
from brakes.drawings.machine import charts_of, machine_figure
from brakes.drawings.sketches import cylinder_sketch
from brakes.machines import LiningResult, Machine, MachineResult, solve_brake

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_WHOLE = take_fields(
    MachineResult,
    "torque c_star c_star_slope force peak_pressure radius locking_friction margin error",
)
_LINING = take_fields(LiningResult, "torque peak_pressure")
Draw = Callable[[MachineResult], Drawing]


def _of_lining(brake: Machine) -> tuple[Output, ...]:
    """Numbers of a lining of a brake."""
    forces = (
        Output(name, stated.words, lambda lining, name=name: lining.reactions[name], stated.unit)
        for name, stated in brake.reactions.items()
    )
    return *_LINING, *forces


def _outputs(brake: Machine) -> tuple[Output, ...]:
    """All numbers of a brake; those of a lining end in its number."""
    count = len(brake.linings(0.0, False))
    return take_from(lambda answer: answer.result, _WHOLE) + tuple(
        Output(f"{o.name}_{i + 1}", f"{o.words}, lining {i + 1}", o.of, o.unit, o.scale)
        for i in range(count)
        for o in take_from(lambda answer, i=i: answer.result.linings[i], _of_lining(brake))
    )


@dataclass(frozen=True)
class MachineAnswer(RubbingAnswer):
    """Forces in a brake whose linings are pressed by one force, and how hot it gets."""

    solver = staticmethod(solve_brake)

    @property
    def warnings(self) -> Sequence[str]:
        """Also remarks of the brake's type, such as a cone that sticks."""
        return (*self.result.brake.remarks(self.result.friction, self.result.reverse), *super().warnings)

    def by_law(self) -> dict[str, MachineResult]:
        """The result under each law of the pressure, by its words, the chosen law first.

        A law under which there is no result, such as that of a block that would lift, is left out.
        """
        brake, found = self.result.brake, {}
        for law in sorted(brake.laws, key=lambda law: law != brake.law):
            try:
                given = self.design.load.given | {"reverse": self.result.reverse}
                found[brake.laws[law]] = solve_brake(
                    brake.with_law(law), friction=self.result.friction, **given
                )
            except InvalidValue:
                continue
        return found or {"value": self.result}

    def tables(self) -> list[RenderableType]:
        """The brake under each law, its linings, and what the numbers hang on."""
        result, laws = self.result, self.by_law()
        direction = "reverse" if result.reverse else "forward"
        title = f"{self.design.title}, {direction}, friction {result.friction:g}"
        names, parts = [each.name for each in result.linings], _of_lining(result.brake)
        heads = ("", *laws, "unit"), ("", *names, "unit")
        doubtful = [*self.doubtful()]
        of_laws, of_linings = (
            [doubtful] * len(laws),
            [*zip(*(each.linings for each in doubtful), strict=True)],
        )
        return [
            table(title, heads[0], list_outputs(_WHOLE, [*laws.values()], of_laws), (0, len(laws) + 1)),
            table("Linings", heads[1], list_outputs(parts, result.linings, of_linings), (0, len(names) + 1)),
            *self.further_tables(),
        ]

    def outputs(self) -> tuple[Output, ...]:
        """Numbers of the brake and of its linings."""
        return _outputs(self.result.brake)

    def figure(self, place: float | None = None) -> Figure:
        """The brake with its forces, pressures and factors."""
        return machine_figure(self.drawings(0.0), self.result)

    def drawings(self, place: float) -> Rows:
        """The brake with its forces; of one that locks without."""
        return ((TYPES[type(self.result.brake)].draw(self.result),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """Pressures and factors."""
        return charts_of(self.result)


TYPES: dict[type[Machine], MachineType] = {}  # by class of the brake


class MachineType(ArrayBrakeType[MachineInput]):
    """A type of brake whose linings are pressed by one force.

    Parameters
    ----------
    made : type of Machine
        Class of the brake.
    name, title, purpose : str
        As of `BrakeType`.
    draw : callable
        Makes the drawing of a result of one case.
    sketch : callable
        Makes the drawings that explain the symbols of the form.
    """

    method = "pressure and friction of each lining integrated in closed form"
    error_from = "rounding of inputs and sums, over the margin to self-locking"
    key_results = (("torque", "torque"), ("brake factor C*", "c_star"), ("margin to self-locking", "margin"))
    together = f"[load]: {LoadInput.ONE}."
    example_sweep = "brake.friction=0.1:0.25:16"
    sweep_results = "torque,c_star,peak_pressure"

    def __init__(
        self, made: type[Machine], name: str, title: str, purpose: str, draw: Draw, sketch: Callable[[], Rows]
    ) -> None:
        self.name, self.title, self.purpose = name, title, purpose  # type: ignore[misc]
        self.model, self.draw, self.sketched = file_of(made, name, title), draw, sketch
        self.sections = self.needs = ("brake", name, "load", "heat")
        TYPES[made] = self

    def solve(self, design: MachineInput) -> Answer:
        """Forces in the brake, and its heat."""
        return MachineAnswer(design, design.solve()).stop_again()

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Explain the symbols of the form."""
        return *self.sketched(), (cylinder_sketch(),)

    def outputs(self, design: MachineInput) -> Sequence[Output]:
        """Numbers of the brake and of its linings."""
        return *_outputs(design.core), *heat_outputs(design)
