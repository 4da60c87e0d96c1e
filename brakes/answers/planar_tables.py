"""Tables, texts and outputs that answers on calipers and on mechanisms share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.tables import table
from beamdyn.common.edge.wording import in_small_units
from beamdyn.common.one_line import rounded_up
from brakes.drawings.mechanism_parts import members
from brakes.planar import Equilibrium, Joint, Load, Mechanism

_ROWS = 5  # of a stroke's table


def units_of(load: Load) -> tuple[float, str, str]:
    """Factor and unit of a load's travel for people, and the unit of its size."""
    return (180 / np.pi, "deg", load.unit) if load.is_couple else (1e3, "mm", load.unit)


def joint_outputs(mechanism: Mechanism, magnitudes: Any) -> list[Output]:
    """The largest force of each joint; `magnitudes` takes those of all joints from an answer."""
    return [
        Output(
            f"largest_{name_output(joint.name)}",
            f"largest force of {joint.name}",
            lambda answer, name=joint.name: np.max(np.abs(magnitudes(answer)[name])),
            joint.unit,
        )
        for joint in mechanism.joints
    ]


def name_output(words: str) -> str:
    """Name of an output, without spaces and commas, of a joint's or load's name."""
    return words.replace(" ", "_").replace(",", "")


def select_rows(count: int) -> np.ndarray:
    """Indices of the rows of a stroke's table, among `count` positions."""
    return np.unique(np.linspace(0, count - 1, _ROWS).round().astype(int))


def reactions_table(equilibrium: Equilibrium, title: str) -> Any:
    """Loads, forces of all joints on the bodies named first, and forces in two-force bodies."""
    mechanism = equilibrium.position.mechanism
    heads = ("force", "of", "x [N]", "y [N]", "size", "unit", "")
    loads = [
        (load.name, "load", "", "", format_force(equilibrium.amplitudes[load.name]), load.unit, "")
        for load in mechanism.loads
    ]
    joints = [_joint_row(joint, equilibrium) for joint in mechanism.joints]
    return table(title, heads, [*loads, (), *joints, *_member_rows(equilibrium)], (0, 1, 5, 6))


def _joint_row(joint: Joint, equilibrium: Equilibrium) -> Sequence[str]:
    force = np.ravel(equilibrium.reactions.get(joint.name, (np.nan, np.nan)))
    size = equilibrium.magnitudes[joint.name]
    xy = ("", "") if joint.is_couple else (format_force(force[0]), format_force(force[1]))
    sense = _sense(joint, float(np.ravel(size)[0]), _least_force(equilibrium))
    ends = f"on {joint.acts_on[0]} from {joint.acts_on[-1]}"
    return (joint.name, ends, *xy, format_force(size), joint.unit, sense)


def _sense(joint: Joint, size: float, least: float) -> str:
    return "" if not abs(size) > least else joint.signs[0] if size > 0 else joint.signs[1]


def _least_force(equilibrium: Equilibrium) -> float:
    """The error of the forces [N]: a smaller one neither pulls nor pushes."""
    sizes = np.concatenate([np.ravel(size) for size in equilibrium.magnitudes.values()])
    error = float(np.nan_to_num(np.fmax.reduce(equilibrium.error, axis=None)))
    return max(1e-9, error * float(np.nan_to_num(np.abs(sizes)).max(initial=0.0)))


def _member_rows(equilibrium: Equilibrium) -> Iterable[Sequence[str]]:
    for member in members(equilibrium.position, equilibrium):
        if member.name in equilibrium.position.mechanism.bodies and np.isfinite(member.force):
            pulls = abs(member.force) > _least_force(equilibrium)
            kind = "" if not pulls else "tension" if member.force > 0 else "compression"
            yield member.name, "two-force body", "", "", format_force(abs(member.force)), "N", kind


def format_force(value: Any, digits: int = 5) -> str:
    """A force as text; nan stands for a force that statics does not determine, or where friction jams."""
    number = float(np.ravel(value)[0])
    if np.isnan(number):
        return "not determined"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g}"


def format_size(value: Any, unit: str, digits: int = 5) -> str:
    """A force or moment with its unit; as `format_force` where it is not a number."""
    return format_force(value, digits) + ("" if np.isnan(value) else f" {unit}")


def largest_error(equilibrium: Equilibrium) -> float:
    """Largest error of an equilibrium's positions, over the largest force; nan where there are no forces."""
    return float(np.fmax.reduce(equilibrium.error, axis=None))


def describe_statics(equilibrium: Equilibrium, message: str, virtual_work: float, error: float) -> str:
    """Diagnosis in a sentence or two, with the error of the forces, nan where there are none."""
    stated = "" if np.isnan(error) else f" Error of the forces: {rounded_up(error)} of the largest."
    return (
        f"Statics: {in_small_units(message)}. Mobility {int(np.max(equilibrium.mobility))}, indeterminacy "
        f"{int(np.max(equilibrium.indeterminacy))}; virtual work of all loads "
        f"{virtual_work:.1e} of the largest force.{stated}"
    )
