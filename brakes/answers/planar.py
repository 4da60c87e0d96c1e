"""What answers on calipers and on mechanisms share: diagnosis, free bodies, tables of forces, animation."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.app.screens import Handle
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import describe
from beamdyn.common.edge.tables import table
from brakes.answers.base import Answer
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput
from brakes.drawings.mechanism import animate, free_body_diagrams
from brakes.drawings.mechanism_parts import members
from brakes.planar import Equilibrium, Joint, Load, Mechanism, Position, Stroke

_FRAMES = 30  # of an animation
_ROWS = 5  # of a stroke's table


@dataclass(frozen=True)
class PlanarAnswer(Answer):
    """An answer on a caliper or a mechanism.

    Attributes
    ----------
    design : CaliperInput or MechanismInput
        Its file.
    equilibrium : Equilibrium
        Of a caliper at the end of its stroke, of a mechanism as drawn.
    motion : Stroke, optional
        Positions over the stroke.
    """

    design: CaliperInput | MechanismInput
    equilibrium: Equilibrium
    motion: Stroke | None

    @property
    @abstractmethod
    def status(self) -> str:
        """Whether statics determines the forces."""

    @property
    @abstractmethod
    def message(self) -> str:
        """The status as a sentence."""

    @property
    def refusals(self) -> Sequence[str]:
        """Which bodies are loose, or which reactions statics does not determine."""
        return () if self.status == "determined" else (self.message,)

    def handles(self, place: float) -> Sequence[Handle]:
        """The points of the file: a named caliper's dimensions, or a mechanism's named points."""
        if isinstance(self.design, MechanismInput):
            points = [(name, f"points.{name}", at) for name, at in self.design.points.items()]
        else:
            dimensions = self.design.dimensions  # pyright: ignore[reportAttributeAccessIssue]  (of _model_of)
            meanings = {entry.name: entry.quantity.meaning for entry in describe(type(dimensions))}
            points = [
                (meanings[name], f"dimensions.{name}", at) for name, at in dimensions if isinstance(at, tuple)
            ]
        return [
            Handle(label, (float(at[0]), float(at[1])), lambda x, y, path=path: {path: (x, y)}, scale=1e3)
            for label, path, at in points
        ]

    def free_bodies(self) -> Figure:
        """Draw each body by itself with the forces on it."""
        return free_body_diagrams(self.equilibrium)

    def animate(self, path: Path, force: bool) -> None:
        """Write an animation of the stroke as GIF, over a file that exists if forced.

        Raises
        ------
        ValueError
            If there is no stroke.
        """
        if self.motion is None:
            raise ValueError("--animation needs a stroke: name run.driver and run.travel in the file")
        motion, mechanism = self.motion, self.motion.position.mechanism
        frames = np.unique(np.linspace(0, len(motion.values) - 1, _FRAMES).round().astype(int))
        factor, unit, _ = units_of(mechanism.load(motion.driver))
        captions = [f"{motion.driver}: {factor * motion.values[k]:.2f} {unit}" for k in frames]
        animate(Position(mechanism, motion.position.batch[frames]), path, captions.__getitem__, force)


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


# Tables -------------------------------------------------------------------------------------------------


def select_rows(count: int) -> np.ndarray:
    """Indices of the rows of a stroke's table, among so many positions."""
    return np.unique(np.linspace(0, count - 1, _ROWS).round().astype(int))


def reactions_table(equilibrium: Equilibrium, title: str) -> Any:
    """Loads, forces of all joints on the bodies named first, and forces in two-force bodies."""
    mechanism, heads = equilibrium.position.mechanism, ("force", "of", "x [N]", "y [N]", "size [N]", "")
    loads = [
        (load.name, "load", "", "", format_force(equilibrium.amplitudes[load.name]), "")
        for load in mechanism.loads
    ]
    joints = [_joint_row(joint, equilibrium) for joint in mechanism.joints]
    return table(title, heads, [*loads, (), *joints, *_member_rows(equilibrium)], (0, 1, 5))


def _joint_row(joint: Joint, equilibrium: Equilibrium) -> Sequence[str]:
    force = np.ravel(equilibrium.reactions.get(joint.name, (np.nan, np.nan)))
    size = equilibrium.magnitudes[joint.name]
    xy = ("", "") if joint.is_couple else (format_force(force[0]), format_force(force[1]))
    unit = joint.unit if joint.is_couple else _sense(joint, float(np.ravel(size)[0]))
    ends = f"on {joint.acts_on[0]} from {joint.acts_on[-1]}"
    return (joint.name, ends, *xy, format_force(size), unit)


def _sense(joint: Joint, size: float) -> str:
    return "" if not np.isfinite(size) else joint.signs[0] if size > 0 else joint.signs[1]


def _member_rows(equilibrium: Equilibrium) -> Iterable[Sequence[str]]:
    for member in members(equilibrium.position, equilibrium):
        if member.name in equilibrium.position.mechanism.bodies and np.isfinite(member.force):
            kind = "tension" if member.force > 0 else "compression"
            yield member.name, "two-force body", "", "", format_force(abs(member.force)), kind


def format_force(value: Any, digits: int = 5) -> str:
    """A force as text; not a number is what statics does not determine."""
    number = float(np.ravel(value)[0])
    if np.isnan(number):
        return "not determined"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g}"


def describe_statics(equilibrium: Equilibrium, message: str, virtual_work: float) -> str:
    """Diagnosis in a sentence or two."""
    return (
        f"Statics: {message}. Mobility {int(np.max(equilibrium.mobility))}, indeterminacy "
        f"{int(np.max(equilibrium.indeterminacy))}; virtual work of all loads "
        f"{virtual_work:.1e} of the largest force."
    )
