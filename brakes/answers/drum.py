"""Results of drum brakes with pivoted shoes, for command, screen and report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.screens.screen_parts import Handle
from brakes.answers.base import Answer
from brakes.answers.rubbing import RubbingAnswer, RubbingType, heat_outputs
from brakes.answers.tables import (
    list_outputs,
    outputs_table,
    resultant,
    take_fields,
    take_from,
    take_from_each,
)
from brakes.config.drum import DrumInput
from brakes.drawings.drum import charts_of, drawing_of
from brakes.drawings.sketches import drum_sketch
from brakes.drum import BrakeResult, ShoeResult, brake_torque

_WHOLE = take_fields(BrakeResult, "torque c_star c_star_slope force peak_pressure locking_friction margin")
_SHOE = (
    *take_fields(ShoeResult, "torque c_star c_star_slope peak_pressure"),
    Output("normal", "resultant of the pressure N", lambda s: resultant(s.normal), "N"),
    Output("tangential", "resultant of the friction T", lambda s: resultant(s.tangential), "N"),
    Output("pin", "pin reaction R", lambda s: resultant(s.pin_reaction), "N"),
    Output("pin_x", "pin reaction, towards the shoe's side", lambda s: s.pin_reaction[..., 0], "N"),
    Output("pin_y", "pin reaction, upward", lambda s: s.pin_reaction[..., 1], "N"),
    *take_fields(ShoeResult, "effective_arm locking_friction closure error"),
)


def _outputs(shoes: int) -> tuple[Output, ...]:
    """Describe all outputs of a brake with `shoes` shoes; names of a shoe's numbers end in its index."""
    whole = take_from(lambda answer: answer.result, _WHOLE)
    return whole + take_from_each(lambda answer: answer.result.shoes, shoes, "shoe", _SHOE)


@dataclass(frozen=True)
class DrumAnswer(RubbingAnswer):
    """Results of a drum brake with pivoted shoes: its forces, and its heating in repeated stops."""

    solver = staticmethod(brake_torque)

    def tables(self) -> list[RenderableType]:
        """Make the tables of the brake and of its shoes."""
        brake, shoes = self.result, self.result.shoes
        direction = "reverse" if brake.reverse else "forward"
        title = "Shoes (components: x to the shoe's side, y upward)"
        names = [f"shoe {i}, {'leading' if s.leading else 'trailing'}" for i, s in enumerate(shoes, 1)]
        doubtful = [*self.doubtful()]
        of_shoes = [*zip(*(each.shoes for each in doubtful), strict=True)]
        return [
            outputs_table(f"Drum brake, {direction}, friction {brake.friction:g}", _WHOLE, brake, doubtful),
            table(title, ("", *names, "unit"), list_outputs(_SHOE, shoes, of_shoes), (0, len(names) + 1)),
            *self.further_tables(),
        ]

    def outputs(self) -> tuple[Output, ...]:
        """Describe the outputs of the brake and of its shoes."""
        return _outputs(len(self.result.shoes))

    def drawings(self, place: float) -> Rows:
        """Make the drawing of the shoes, with their forces unless the brake locks."""
        return ((drawing_of(self.result),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """Make the charts of pressures and shoe factors."""
        return charts_of(self.result)

    def handles(self, place: float) -> Sequence[Handle]:
        """Make handles to move the lining, pin and force of the first shoe, and the drum, in the drawing."""
        shoe = self.result.shoes[0].shoe
        r, force = float(shoe.drum_radius), float(shoe.force_arm)
        pivot = float(shoe.pivot[0]), float(shoe.pivot[1])
        start, end = ((float(r * np.sin(angle)), float(-r * np.cos(angle))) for angle in shoe.lining)
        return (
            Handle("drum radius", (0.0, r), lambda x, y: {"shoe.drum_radius": y}),
            Handle("start of the lining", start, lambda x, y: {"shoe.lining_start": _from_bottom(x, y)}),
            Handle("end of the lining", end, lambda x, y: {"shoe.lining_end": _from_bottom(x, y)}),
            Handle("pin of the shoe", pivot, lambda x, y: {"shoe.pivot_offset": x, "shoe.pivot_depth": -y}),
            Handle("height of the force", (0.55 * r, force), lambda x, y: {"shoe.force_arm": y}),
        )


def _from_bottom(x: float, y: float) -> float:
    """Compute the angle of a point about the drum's centre, from the downward vertical [rad]."""
    return float(np.arctan2(x, -y))


class DrumType(RubbingType[DrumInput]):
    """Drum brakes with pivoted shoes."""

    name = "drum"
    title = "Drum brake"
    purpose = "A brake with shoes on fixed pins: torque, pressure, pin reactions, and when it locks itself."
    method = "pressure and friction of each shoe integrated in closed form"
    model = DrumInput
    sections = needs = ("brake", "shoe", "second_shoe", "load", "heat")
    example_sweep = "brake.friction=0.1:0.6:26"
    sketches = staticmethod(drum_sketch)

    def solve(self, design: DrumInput) -> Answer:
        """Compute the forces in the brake, and its heating."""
        return DrumAnswer(design, design.solve()).stop_again()

    def outputs(self, design: DrumInput) -> Sequence[Output]:
        """Describe the outputs of the brake, of its shoes and of repeated stops."""
        return *_outputs(len(design.core.shoes)), *heat_outputs(design)


BRAKE = DrumType()
