"""Results of a forklift's stop from its pedal: forces from foot to wheels, energy, and heating."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import of_file
from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import refuse
from beamdyn.common.results.result import Result
from brakes.answers.rubbing import HEAT, stops_tables
from brakes.answers.tables import outputs_table, take, take_fields, take_from
from brakes.chain import Actuation, BrakedStop, Heat, brake_from_pedal, fade_of_stops, heat_of_stop
from brakes.common.heat import Fade
from brakes.config.forklift import ForkliftInput
from brakes.forklift import InternalForces, internal_forces


@dataclass(frozen=True)
class FromPedal(Result):
    """Results of a forklift's stop from its pedal.

    Attributes
    ----------
    braked : BrakedStop
        Forces from the pedal to the wheels, and the stop.
    heat : Heat
        Energy of the stop, and temperature rise of the drums.
    brake_error : ndarray
        Upper bound of the relative error of the torque that a brake can give.
    fade : Fade, optional
        Heating in repeated stops, if the file has [heat].
    """

    braked: BrakedStop
    heat: Heat
    brake_error: Numbers
    fade: Fade | None = None

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield from self.braked.headline()

    @property
    def error(self) -> Numbers:
        """Upper bound of the relative error of torque and deceleration.

        The torque's error changes the deceleration only where the brake, not the grip, limits it.
        """
        stop = self.braked.stop
        slowing = np.where(stop.stops, np.abs(stop.acceleration), np.inf)
        sensitive = np.where(stop.limited_by == "brake", stop.brake_force / stop.truck.mass / slowing, 0.0)
        return (self.brake_error * (1 + sensitive))[()]

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on limits that are exceeded, and on wanted values that cannot be reached."""
        asked = {
            "force at which the wheels lock": self.braked.locking,
            "least friction that stops": self.braked.friction,
        }
        # Reasons are shown only for a single case.
        alone = {what: found for what, found in asked.items() if np.ndim(found.reason) == 0}
        lacking = tuple(f"{what}: {found.message}" for what, found in alone.items() if found.reason)
        return (*self.braked.actuation.warnings, *self.heat.warnings, *lacking)

    @property
    def refusals(self) -> tuple[str, ...]:
        """Sentence on repeated stops of which one does not end; empty if all end."""
        return () if self.fade is None else self.fade.refusals

    def tables(self, doubtful: Sequence[Any] = ()) -> list[RenderableType]:
        """Make the tables of forces from pedal to wheels, of the pedal force's limit, and of repeated stops.

        Digits in which the `doubtful` results differ, such as those with other friction, are dimmed.
        """
        title = f"From the pedal to the wheels; the {self.braked.limited_by} limits the braking force"
        said = f"Pedal, {self.braked.actuation.verdict}."
        stops = () if self.fade is None else stops_tables(self.fade)
        return [outputs_table(title, OUTPUTS, self, doubtful), said, *stops]


# The table of the first stop already has its energy and its pressure times velocity.
_FADE = tuple(each for each in HEAT if each.name not in ("energy", "pv"))
OUTPUTS = (
    *take_from(
        lambda found: found.braked.actuation,
        take_fields(Actuation, "pedal_force output_force pressure actuator_force pedal_travel"),
    ),
    Output(
        "allowed_force",
        "largest pedal force that is allowed",
        lambda found: found.braked.actuation.pedal.allowed_force,
        "N",
    ),
    *take_from(
        lambda found: found.braked,
        (
            *take_fields(BrakedStop, "available_torque locking_torque"),
            take("locking_force", "force on the pedal at which the wheels just lock", "N"),
            take("locking_pressure", "pressure of the line there", "MPa"),
            take("least_friction", "least friction of the tyres that stops the truck"),
        ),
    ),
    *take_from(
        lambda found: found.heat,
        take_fields(Heat, "energy drum_energy tyre_energy temperature_rise lining_pv"),
    ),
)


def pedal_outputs(design: ForkliftInput) -> tuple[Output, ...]:
    """Describe the outputs of pedal and repeated stops, if the file has tables for them."""
    repeated = () if design.heat is None else take_from(lambda found: found.fade, _FADE)
    return (*OUTPUTS, *repeated) if design.pedal else ()


def solve_pedal(design: ForkliftInput) -> FromPedal:
    """Compute the forces from the pedal to the wheels, the stop and its heat, for a file that has a pedal.

    Parameters
    ----------
    design : ForkliftInput
        The design that the file describes.

    Raises
    ------
    ValueError
        As for `brakes.chain.brake_from_pedal`.
    NoAnswer
        If the brake is self-locking, so that its torque does not follow from the pedal.
    """
    geometry = design.brake.motion if design.brake else design.levers and design.levers.core
    assert geometry and design.pedal and design.line and design.truck and design.stop and design.forces
    with of_file({"friction": "lining_friction"}):
        unit = internal_forces(geometry, piston_force=1.0, friction=design.forces.lining_friction)
    _refuse_locked(unit, design.forces.lining_friction)
    with of_file({}):
        braked = brake_from_pedal(
            design.truck.core, design.stop.core, design.pedal.core, design.line.core, unit.torque
        )
    drums = design.drums and design.drums.core
    pressed = (unit.A + unit.C) * braked.stop.torque_per_brake / unit.torque
    heat = heat_of_stop(braked.stop, drums, pressed, unit.levers.drum_radius)
    fade = _repeat(design, geometry, braked)
    return FromPedal(braked, heat, unit.error, fade and replace(fade, pv=heat.lining_pv))


def _repeat(design: ForkliftInput, geometry: Any, braked: BrakedStop) -> Fade | None:
    """Compute repeated stops with heating, if the file has them."""
    if design.heat is None or design.drums is None or design.forces is None:
        return None

    def torque_per_force(friction: Numbers) -> Numbers:
        unit = internal_forces(geometry, piston_force=1.0, friction=friction)
        return np.where(unit.status == "equilibrium", unit.torque, np.nan)

    with of_file({}):
        friction, drums = design.forces.lining_friction, design.drums.core
        return fade_of_stops(braked, drums, friction, torque_per_force, **dict(design.heat))


def _refuse_locked(unit: InternalForces, friction: Any) -> None:
    """Raise an error for self-locking brakes; in a sweep, it names the designs that lock."""
    locked = np.asarray(unit.status) != "equilibrium"
    if locked.ndim == 0 and locked:
        raise NoAnswer(f"forces.lining_friction = {friction:.6g}: {unit.message}")
    bound = "the brake locks by itself, and no torque follows from the piston's force"
    refuse(locked, "forces.lining_friction", friction, "", bound)
