"""Results of vehicles: parking and stops in both directions, which axle locks first, the lever's force."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import in_range, of_file
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import plain
from brakes import vehicle
from brakes.answers.base import Answer, ArrayBrakeType
from brakes.answers.doubts import hangs_on_friction, with_less_and_more
from brakes.answers.tables import list_outputs, outputs_csv, outputs_table, take_fields, take_from
from brakes.chain import Actuation, actuate, force_for, ratio_for
from brakes.config.vehicle import VehicleInput
from brakes.drawings.vehicle import standing, vehicle_sketch
from brakes.vehicle.axles import Axle

_AXLES: tuple[Axle, Axle] = ("front", "rear")
_HOLDING = (
    Output("holds", "holds on the slope: 1, else 0", lambda holding: np.equal(holding.status, "holds") * 1.0),
    *take_fields(
        vehicle.Holding,
        "largest_slope slipping_slope tipping_slope rolling_slope needed_force braking_force "
        "front_load rear_load",
    ),
)
_BRAKING = take_fields(vehicle.Braking, "pitching front_alone rear_alone both front_locks rear_locks largest")
_SLOWING = take_fields(vehicle.Slowing, "distance time deceleration ratio front_force rear_force") + tuple(
    replace(o, name=f"braked_{o.name}") for o in take_fields(vehicle.Slowing, "front_load rear_load")
)
_LEVER = take_fields(Actuation, "pedal_force output_force pressure actuator_force pedal_travel")
_WORDS = {
    "friction_to_hold": ("least friction of the tyres that holds", ""),
    "force_to_hold": ("force on the lever that holds", "N"),
    "ratio_to_hold": ("ratio of the lever that holds at its force", ""),
}


@dataclass(frozen=True)
class OneDirection:
    """Results with one axle downhill at rest, or leading in a stop.

    Attributes
    ----------
    holding : Holding
        Whether the vehicle at rest holds on the slope.
    braking : Braking
        Hardest braking in a stop, and its limit: locking wheels or pitching over.
    needs : mapping of str to Needed
        Values of inputs at which a result has its wanted value, by name.
    slowing : Slowing, optional
        The stop on the slope, if the file has one.
    """

    holding: vehicle.Holding
    braking: vehicle.Braking
    needs: Mapping[str, vehicle.Needed]
    slowing: vehicle.Slowing | None


def _of_one_way(design: VehicleInput) -> tuple[Output, ...]:
    """Describe the outputs for one direction of motion."""
    asked = (
        Output(name, _WORDS[name][0], lambda way, name=name: way.needs[name].value, _WORDS[name][1])
        for name in (["friction_to_hold"] if design.lever is None else [*_WORDS])
    )
    return (
        *take_from(lambda way: way.holding, _HOLDING),
        *asked,
        *take_from(lambda way: way.braking, _BRAKING),
        *_of_stop(design),
    )


def _of_stop(design: VehicleInput) -> tuple[Output, ...]:
    """Describe the outputs of the stop in one direction; none if the file has no stop."""
    return () if design.stop is None else take_from(lambda way: way.slowing, _SLOWING)


def _outputs(design: VehicleInput) -> tuple[Output, ...]:
    """Describe all outputs.

    The names of outputs end in "_front" or "_rear".  This is the axle that is downhill while the vehicle
    stands on a slope, and that is ahead in the direction of travel during a stop. Outputs of the lever have
    no such ending.
    """
    ways = tuple(
        Output(f"{o.name}_{axle}", f"{o.words}, {axle} downhill", o.of, o.unit, o.scale)
        for axle in _AXLES
        for o in take_from(lambda answer, axle=axle: answer.ways[axle], _of_one_way(design))
    )
    return (*ways, *take_from(lambda answer: answer.lever, _of_lever(design)))


def _of_lever(design: VehicleInput) -> tuple[Output, ...]:
    """Describe the lever's outputs, without pressure if it pulls a cable; none if the file has no lever."""
    if design.lever is None:
        return ()
    return tuple(each for each in _LEVER if design.line or each.name != "pressure")


@dataclass(frozen=True)
class VehicleAnswer(Answer):
    """Results of a vehicle at rest on a slope and in a stop, with either axle downhill.

    Attributes
    ----------
    design : VehicleInput
        The design that the file describes.
    ways : mapping of {"front", "rear"} to OneDirection
        Results by the axle that is downhill or leads.
    lever : Actuation, optional
        Forces from the lever to the brakes, if the file has a lever.
    """

    design: VehicleInput
    ways: Mapping[Axle, OneDirection]
    lever: Actuation | None

    @property
    def error(self) -> Any:
        """Upper bound of the relative error of the largest slopes on which the vehicle holds."""
        return max(way.holding.error / np.min(way.holding.largest_slope) for way in self.ways.values())

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on the directions in which the vehicle does not hold on the slope or does not stop."""
        ways = self.ways.items()
        return [f"{axle} axle downhill: {said}" for axle, way in ways for said in _failures(way)]

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on a lever force above the limit, and on rolling back after an uphill stop."""
        ways = ((f"{axle} axle leading: ", way.slowing) for axle, way in self.ways.items())
        stops = [words + said for words, stop in ways if stop is not None for said in stop.warnings]
        return [*(() if self.lever is None else self.lever.warnings), *stops]

    def tables(self) -> list[RenderableType]:
        """Make the tables of both directions and of the lever.

        A line names each input for which no value gives the wanted result.
        """
        ways = [*self.ways.values()]
        # These outputs are left out: another row has the status in words, and another table has the stop.
        elsewhere = {"holds", *(each.name for each in _SLOWING)}
        others = with_less_and_more(self.design, "road.friction", BRAKE.solve)
        doubtful = [[other.ways[axle] for other in others] for axle in self.ways]
        rows = list_outputs((o for o in _of_one_way(self.design) if o.name not in elsewhere), ways, doubtful)
        said = [["", *(str(way.holding.status) for way in ways), ""]]
        first = [["ends the hardest braking", *(str(way.braking.first) for way in ways), ""]]
        heads = ("", "front downhill or leading", "rear downhill or leading", "unit")
        title = "The vehicle at rest on the slope, and in a stop on level ground"
        tables: list[RenderableType] = [table(title, heads, [*said, *rows, *first], (0, 3))]
        tables.append(self._doubt())
        tables += [f"{words}, {axle} downhill: {text}" for words, axle, text in self._lacking()]
        if self.design.stop is not None:
            ends = [["", *(str(way.slowing and way.slowing.status) for way in ways), ""]]
            way = self.design.stop.core.heading.removesuffix("hill")
            cells = [*ends, *list_outputs(_of_stop(self.design), ways, doubtful)]
            tables.append(
                table(f"A stop {way} the slope", ("", "front leading", "rear leading", "unit"), cells, (0, 3))
            )
        if self.lever is not None:
            tables.append(outputs_table("The lever at its force", _of_lever(self.design), self.lever))
            tables.append(f"Lever, {self.lever.verdict}.")
        return tables

    def _doubt(self) -> str:
        """State the largest slope on which the vehicle holds both ways, with less and more tyre friction."""

        def largest(design: VehicleInput) -> float:
            ways = BRAKE.solve(design).ways.values()
            return float(np.degrees(min(way.holding.largest_slope for way in ways)))

        least = min((way.holding for way in self.ways.values()), key=lambda held: float(held.largest_slope))
        of = f"tyres on the road: Largest slope in both directions (past it, the vehicle {least.limited_by})"
        return hangs_on_friction(self.design, "road.friction", of, largest, "deg", "none")

    def _lacking(self) -> Iterable[tuple[str, str, str]]:
        """Yield each input for which no value gives the wanted result: its name, the axle, the reason."""
        for axle, way in self.ways.items():
            for name, found in way.needs.items():
                if found.reason:
                    yield _WORDS[name][0], axle, found.message

    def rows(self) -> Iterable[Sequence[object]]:
        """Make rows of name, value and unit of all outputs."""
        return outputs_csv(_outputs(self.design), value=self)

    def figure(self, place: float | None = None) -> Figure:
        """Draw the vehicle on its slope in both directions."""
        return figure_of(self.drawings(0.0))

    def drawings(self, place: float) -> Rows:
        """Make the drawings of the vehicle on its slope, with its forces, in both directions."""
        return [[standing(way.holding) for way in self.ways.values()]]

    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""
        return {"ways": plain(self.ways), "lever": plain(self.lever)}


def _failures(way: OneDirection) -> list[str]:
    """Return sentences saying that the vehicle does not hold or does not stop in one direction.

    If `way` has the results of many designs, only the stop has a sentence; the output `holds` then tells
    which designs hold.
    """
    holding, slowing = way.holding, way.slowing
    said = [slowing.message] if slowing is not None and not np.all(slowing.stops) else []
    alone = np.ndim(holding.status) == 0 and holding.status != "holds"
    return [holding.message, *said] if alone else said


class ParkingType(ArrayBrakeType[VehicleInput]):
    """Type of brake for vehicles parked on a slope.

    Its results also state the hardest braking in a stop, which axle locks first, and the lever's force.
    """

    name = "vehicle"
    title = "Parking and grip"
    purpose = (
        "A vehicle on a slope: does it hold, slip or tip, what must the lever give, which axle locks first?"
    )
    method = "equilibrium of two axles in closed form"
    error_from = "rounding of inputs and sums"
    model = VehicleInput
    together = "Give [truck] or [vehicle]; [lever], [cable] or [line], and [brakes] go together."
    sections = needs = ("truck", "vehicle", "road", "braking", "stop", "lever", "cable", "line", "brakes")
    example_sweep = "road.slope=1:35:35 deg"
    sketches = staticmethod(vehicle_sketch)
    sweep_results = "holds_front,holds_rear,braking_force_front,braking_force_rear"
    key_results = (
        ("largest slope, front axle downhill", "largest_slope_front"),
        ("largest slope, rear axle downhill", "largest_slope_rear"),
    )

    def solve(self, design: VehicleInput) -> VehicleAnswer:
        """Solve parking and stops with either axle downhill, and the forces from the lever."""
        with in_range(design), of_file({}):
            line = design.cable or design.line
            pulled = actuate(design.lever.core, line.core) if design.lever and line else None
            gain = design.brakes.core.force_per_actuator_force if design.brakes else np.nan
            force = gain * pulled.actuator_force if pulled else np.inf
            ways: dict[Axle, OneDirection] = {
                axle: _solve_way(design, axle, force, pulled, gain) for axle in _AXLES
            }
        return VehicleAnswer(design, ways, pulled)

    def outputs(self, design: VehicleInput) -> Sequence[Output]:
        """Describe the outputs of both directions, and of the lever."""
        return _outputs(design)


def _solve_way(
    design: VehicleInput, axle: Axle, force: Any, pulled: Actuation | None, gain: Any
) -> OneDirection:
    """Solve one direction, in which `axle` is downhill at rest and leads in a stop.

    `force` is the force of the lever's brakes along the ground [N], inf without a lever; `pulled` are the
    forces from the lever to the brakes; `gain` is the braking force over the force on each actuator.
    """
    standing, road, braking = design.standing, design.road.core, design.braking
    holding = vehicle.hold(standing, road, braking.parked_by, axle, force)
    needs = {"friction_to_hold": vehicle.friction_to_hold(standing, road.slope, braking.parked_by, axle)}
    if pulled is not None:
        each = holding.needed_force / gain
        needs["force_to_hold"] = force_for(pulled.pedal, pulled.line, each)
        needs["ratio_to_hold"] = ratio_for(pulled.pedal, pulled.line, each)
    limits = vehicle.braking_limits(standing, road.friction, braking.front_share, axle)
    return OneDirection(holding, limits, needs, _solve_stop(design, limits, force))


def _solve_stop(design: VehicleInput, limits: vehicle.Braking, force: Any) -> vehicle.Slowing | None:
    """Solve the stop in one direction; None if the file has no table [stop].

    The braking force is that given in [stop], else that of the lever, else the largest without locking.
    """
    if design.stop is None:
        return None
    approach, road, share = design.stop.core, design.road.core, design.braking.front_share
    given = approach.brake_force
    if given is None and design.lever is not None:
        given, share = force, {"front": 1.0, "rear": 0.0, "both": share}[design.braking.parked_by]
    elif given is None:
        given = limits.largest * design.standing.mass * road.gravity * np.cos(road.slope)
    return vehicle.slow_down(design.standing, road, approach, given, share, limits.leading)


BRAKE = ParkingType()
