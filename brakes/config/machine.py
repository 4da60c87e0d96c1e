"""Input files of brakes whose linings are pressed by one force: [brake], dimensions, [load], [heat]."""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar

from pydantic import create_model

from beamdyn.common.edge.config import CoreSection, MadeSection, section_of
from beamdyn.common.edge.inputs import in_range, of_file
from brakes.config.load import HeatInput, LoadInput, RubbingInput
from brakes.machines import Machine, MachineResult, solve_brake


class MachineInput(CoreSection):
    """File of a brake; the table of dimensions has the brake's name and is made from the brake's class."""

    table: ClassVar[str]
    title: ClassVar[str]

    brake: RubbingInput
    load: LoadInput
    heat: HeatInput | None = None

    @property
    def dimensions(self) -> MadeSection:
        """The table with the dimensions of the brake."""
        return getattr(self, self.table)

    @cached_property
    def core(self) -> Machine:
        """The brake with these dimensions."""
        return self.dimensions.core

    def solve(self) -> MachineResult:
        """Compute the forces in the brake.

        Raises
        ------
        ValueError
            As for `brakes.machines.solve_brake`.
        """
        reverse = self.brake.direction == "reverse"
        with in_range(self), of_file(self.dimensions.key_of):
            return solve_brake(self.core, friction=self.brake.friction, **self.load.given, reverse=reverse)


def file_of(made: type[Machine], table: str, title: str) -> type[MachineInput]:
    """Make the description of a brake's file from its class, the name of its table, and a title."""
    fields: dict[str, Any] = {table: (section_of(made), ...)}
    model = create_model(f"{made.__name__}File", __base__=MachineInput, __doc__=made.__doc__, **fields)
    model.table, model.title = table, title
    return model
