"""Results of brakes whose linings are pressed by one force, with tables and drawings, and `MachineType`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass

from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart, Drawing
from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.inputs.checks import InvalidValue
from brakes.answers.base import Answer
from brakes.answers.rubbing import RubbingAnswer, RubbingType, heat_outputs
from brakes.answers.tables import list_outputs, take_fields, take_from, take_from_each
from brakes.config.machine import MachineInput, file_of
from brakes.drawings import annulus, band, block, sliding
from brakes.drawings.machine import charts_of
from brakes.drawings.sketches import cylinder_sketch
from brakes.machines import (
    Band,
    Block,
    Cone,
    Disc,
    LiningResult,
    Machine,
    MachineResult,
    Plates,
    Sliding,
    solve_brake,
)

_WHOLE = take_fields(
    MachineResult, "torque c_star c_star_slope force peak_pressure radius locking_friction margin error"
)
_LINING = take_fields(LiningResult, "torque peak_pressure")
Draw = Callable[[MachineResult], Drawing]


def _of_lining(brake: Machine) -> tuple[Output, ...]:
    """Describe the outputs of one lining of a brake."""
    forces = (
        Output(name, stated.words, lambda lining, name=name: lining.reactions[name], stated.unit)
        for name, stated in brake.reactions.items()
    )
    return *_LINING, *forces


def _outputs(brake: Machine) -> tuple[Output, ...]:
    """Describe all outputs of a brake; those of a lining have names that end in its number."""
    whole, count = take_from(lambda answer: answer.result, _WHOLE), len(brake.linings(0.0, False))
    return whole + take_from_each(lambda answer: answer.result.linings, count, "lining", _of_lining(brake))


@dataclass(frozen=True)
class MachineAnswer(RubbingAnswer):
    """Results of a brake whose linings are pressed by one force: its forces, and its heating."""

    solver = staticmethod(solve_brake)

    @property
    def warnings(self) -> Sequence[str]:
        """Remarks of the brake's type, such as a cone that sticks, and warnings of repeated stops."""
        return (*self.result.brake.remarks(self.result.friction, self.result.reverse), *super().warnings)

    def by_law(self) -> dict[str, MachineResult]:
        """Solve the brake under each pressure law; results by description of the law, the chosen law first.

        Laws without a result, as for a block that would lift, are left out.
        """
        brake = self.result.brake
        found = {brake.laws[brake.law] if brake.laws else "value": self.result}
        for words, other in self.other_laws():
            with suppress(InvalidValue):
                found[words] = self.at_load(other, self.result.friction)
        return found

    def tables(self) -> list[RenderableType]:
        """Make the tables of the brake under each law, of its linings, and of the influence of friction."""
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
        """Describe the outputs of the brake and of its linings."""
        return _outputs(self.result.brake)

    def drawings(self, place: float) -> Rows:
        """Make the drawing of the brake, with its forces unless it locks."""
        return ((TYPES[type(self.result.brake)].draw(self.result),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """Make the charts of pressures and brake factors."""
        return charts_of(self.result)


_BAND = "A band around a drum, simple or differential: torque, tensions, pressure, and when it locks itself."
_BLOCK = "Blocks on levers outside a drum: torque, pressure, fulcrum forces, and when it locks itself."
_CONE = "A cone pressed into a cup: torque, pressure new and worn in, and whether it sticks."
_DISC = (
    "A pad on each side of a disc, fixed or floating caliper: torque, forces and pressure, new and worn in."
)
_PLATES = "Rings pressed together: torque and pressure, new and worn in."
_SLIDING = (
    "A drum brake whose shoes slide on an abutment: torque, where the linings touch, when it locks itself."
)
TYPES: dict[type[Machine], MachineType] = {}  # types of brakes by the class of the brake


class MachineType(RubbingType[MachineInput]):
    """Description of a type of brake whose linings are pressed by one force, for form, command and report.

    Parameters
    ----------
    made : type of Machine
        Class of the brake.
    name, title, purpose : str
        Name, title and purpose, as in `BrakeType`.
    draw : callable
        Makes the drawing of a result for a single case.
    sketch : callable
        Makes drawings that explain the symbols of the input form.
    """

    method = "pressure and friction of each lining integrated in closed form"
    example_sweep = "brake.friction=0.1:0.25:16"

    def __init__(
        self, made: type[Machine], name: str, title: str, purpose: str, draw: Draw, sketch: Callable[[], Rows]
    ) -> None:
        self.name, self.title, self.purpose = name, title, purpose  # type: ignore[misc]
        self.model, self.draw, self.sketched = file_of(made, name, title), draw, sketch
        self.sections = self.needs = ("brake", name, "load", "heat")
        TYPES[made] = self

    def solve(self, design: MachineInput) -> Answer:
        """Compute the forces in the brake, and its heating."""
        return MachineAnswer(design, design.solve()).stop_again()

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Make drawings that explain the symbols of the input form."""
        return *self.sketched(), (cylinder_sketch(),)

    def outputs(self, design: MachineInput) -> Sequence[Output]:
        """Describe the outputs of the brake, of its linings and of repeated stops."""
        return *_outputs(design.core), *heat_outputs(design)


MACHINES = {  # types by the name of the command
    each.name: each
    for each in (
        MachineType(Band, "band", "Band brake", _BAND, band.draw_band, band.band_sketch),
        MachineType(Block, "block", "Block brake", _BLOCK, block.draw_block, block.block_sketch),
        MachineType(Cone, "cone", "Cone brake", _CONE, annulus.draw_cone, annulus.cone_sketch),
        MachineType(Disc, "disc", "Disc brake", _DISC, annulus.draw_disc, annulus.disc_sketch),
        MachineType(
            Plates, "plates", "Multi-plate brake", _PLATES, annulus.draw_plates, annulus.plates_sketch
        ),
        MachineType(
            Sliding, "sliding", "Sliding shoes", _SLIDING, sliding.draw_sliding, sliding.sliding_sketch
        ),
    )
}
