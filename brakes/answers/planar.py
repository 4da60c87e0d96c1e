"""What answers on calipers and on mechanisms share: tables, outputs, friction, handles."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import describe
from beamdyn.common.edge.tables import table
from beamdyn.common.edge.wording import in_small_units
from beamdyn.common.results.one_line import error_at_most, rounded_up
from beamdyn.common.results.result import Result, plain
from beamdyn.common.screens.screens import Handle
from brakes.answers.base import Answer
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput
from brakes.drawings.mechanism import animate, free_body_diagrams
from brakes.drawings.mechanism_parts import members
from brakes.planar import (
    Equilibrium,
    FrictionalEquilibrium,
    Joint,
    Load,
    Mechanism,
    Position,
    Stroke,
    solve_with_friction,
)
from brakes.planar.rows import Row

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


# Friction in a mechanism: its forces without friction, squeezing and releasing, side by side -------------


WITHOUT = "without friction"
BRANCHES = (WITHOUT, "squeezing", "releasing")
_ROUNDING = (
    1e-9  # a load of this part of the largest is shown as 0, such as a brake's torque without friction
)


@dataclass(frozen=True)
class MechanismFriction(Result):
    """Equilibria of a mechanism with friction, as drawn and over the stroke.

    Attributes
    ----------
    driver : str
        The load whose travel grows while the mechanism is squeezed.
    drawn : FrictionalEquilibrium
        As drawn.
    over : FrictionalEquilibrium, optional
        At each position of the stroke.
    """

    driver: str
    drawn: FrictionalEquilibrium
    over: FrictionalEquilibrium | None

    def headline(self) -> Iterator[str]:
        """What it says in one line; see `Result.headline`."""
        yield f"driven by {self.driver}"
        yield error_at_most(self.error)
        ways = {"squeezing": self.last.squeeze, "releasing": self.last.release}
        yield from (f"{name}: {way.status}" for name, way in ways.items())

    @classmethod
    def of(cls, drawn: Equilibrium, driver: str, motion: Stroke | None) -> MechanismFriction:
        """Solve with the friction of the joints; see `brakes.planar.solve_with_friction`."""
        position = drawn.position
        mechanism = position.mechanism
        over = None if motion is None else solve_with_friction(mechanism, driver, motion.position)
        return cls(driver, solve_with_friction(mechanism, driver, position), over)

    @property
    def last(self) -> FrictionalEquilibrium:
        """The equilibria over the stroke if there is one, else those as drawn."""
        return self.over or self.drawn

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on directions in which no force moves it, a contact opens, or a cable slackens."""
        return [sentence for way, sentence in self._locking() if not way.has_answer]

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on directions in which it locks itself, and on what jams at the least offset."""
        found = self.last.squeeze, self.last.release
        said = self.last.without.warnings
        jams = dict.fromkeys(warning for way in found for warning in way.warnings if warning not in said)
        return [*(sentence for way, sentence in self._locking() if way.has_answer), *jams]

    def _locking(self) -> list[tuple[Equilibrium, str]]:
        ways = {"squeezing": self.last.squeeze, "releasing": self.last.release}
        return [(way, f"{name}: {way.message}") for name, way in ways.items() if way.status != "determined"]

    @property
    def error(self) -> float:
        """Largest error of the forces, over the largest force, where there is equilibrium."""
        return max(largest_error(way) for way in _ways(self.last))

    def table(self) -> RenderableType:
        """Sizes of loads, joints and friction as drawn: without friction, squeezing, releasing."""
        mechanism, ways = self.drawn.without.position.mechanism, _ways(self.drawn)
        rows = [
            _row(part.name, [(way.amplitudes | way.magnitudes)[part.name] for way in ways], part.unit)
            for part in (*mechanism.loads, *mechanism.joints)
        ]
        rubbing = [
            _row(f"friction of {name}", [0.0, *(way.friction[name] for way in ways[1:])], _unit(law.row))
            for name, (_, law) in mechanism.friction.items()
        ]
        heads = ("size of", "without friction", "squeezing", "releasing", "unit")
        title = f"With friction, as drawn; squeezing: motion along {self.driver}, releasing: against it"
        return table(title, heads, [*rows, (), *rubbing], (0, 4))

    def columns(self) -> dict[str, np.ndarray]:
        """The unknown load over the stroke, squeezing and releasing, by name and unit."""
        return {f"{name} [{load.unit}]": size for load, name, size in self._curves()}

    def curves(self, couples: bool) -> dict[str, np.ndarray]:
        """Moments, or forces, of the unknown loads over the stroke, squeezing and releasing, by name."""
        return {name: size for load, name, size in self._curves() if load.is_couple == couples}

    def _curves(self) -> list[tuple[Load, str, np.ndarray]]:
        over = self.last
        ways = {"squeezing": over.squeeze, "releasing": over.release}
        loads = unknown_loads(over.without.position.mechanism)
        return [
            (load, f"{load.name}, {name}", way.amplitudes[load.name])
            for load in loads
            for name, way in ways.items()
        ]

    def caption(self, index: int) -> str:
        """The unknown load in three numbers, at one of the positions."""
        sentences = []
        for load in unknown_loads(self.drawn.without.position.mechanism):
            sizes = np.array([np.ravel(way.amplitudes[load.name])[index] for way in _ways(self.last)])
            sizes[np.abs(sizes) < _ROUNDING * np.nanmax(np.abs(sizes), initial=0.0)] = 0.0
            without, squeezing, releasing = (format_size(size, load.unit, 4) for size in sizes)
            sentences.append(
                f"{load.name}: {without} without friction, {squeezing} squeezing, {releasing} releasing"
            )
        return "; ".join(sentences)

    def at(self, position: Position, branch: str) -> Equilibrium:
        """Equilibrium of a branch at one position."""
        found = solve_with_friction(position.mechanism, self.driver, position)
        return _ways(found)[BRANCHES.index(branch)]

    def locked(self) -> dict[str, np.ndarray]:
        """Where the mechanism locks over the stroke, by the name of each curve on which it does.

        There it jams, so that there is no force, or the unknown load has to act in the other direction.
        """
        over = self.last
        found = {}
        for load, name, size in self._curves():
            without = over.without.amplitudes[load.name]
            least = _ROUNDING * np.nanmax(np.abs([*over.without.amplitudes.values()]), initial=0.0)
            turned = (np.abs(without) > least) & (size * np.sign(without) < -least)
            found[name] = np.isnan(size) | turned
        return {name: where for name, where in found.items() if where.any()}

    def to_dict(self) -> dict[str, Any]:
        """The equilibria as drawn, by the direction of motion, as plain numbers, lists and strings."""
        keys = ("status", "message", "reactions", "magnitudes", "amplitudes", "friction", "residual")
        ways = {"squeezing": self.drawn.squeeze, "releasing": self.drawn.release}
        return {"driver": self.driver} | {
            name: {key: plain(getattr(way, key)) for key in keys} for name, way in ways.items()
        }


def unknown_loads(mechanism: Mechanism) -> list[Load]:
    """Loads without a given magnitude, which equilibrium gives."""
    return [load for load in mechanism.loads if load.amplitude(np.zeros(1)) is None]


def _ways(found: FrictionalEquilibrium) -> tuple[Equilibrium, Equilibrium, Equilibrium]:
    return found.without, found.squeeze, found.release


def _row(name: str, sizes: Sequence[Any], unit: str) -> Sequence[str]:
    return (name, *map(format_force, sizes), unit)


def _unit(row: Row) -> str:
    return "N m" if row.is_couple else "N"


# Base of the answers on calipers and on mechanisms: diagnosis, handles, free bodies, animation -----------


_FRAMES = 30  # of an animation


@dataclass(frozen=True)
class PlanarAnswer(Answer):
    """An answer on a caliper or a mechanism.

    Attributes
    ----------
    design : CaliperInput or MechanismInput
        Its file.
    equilibrium : Equilibrium
        Equilibrium of a caliper at the end of its stroke, or of a mechanism as drawn.
    motion : Stroke, optional
        Positions over the stroke.
    """

    design: CaliperInput | MechanismInput
    equilibrium: Equilibrium
    motion: Stroke | None

    def headline(self) -> Iterator[str]:
        """What it says in one line, its status first; see `Result.headline`."""
        yield self.status
        yield from (part for part in super().headline() if part != self.status)

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
        return () if self.status == "determined" else (in_small_units(self.message),)

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

    @property
    def equilibria(self) -> Mapping[str, Equilibrium]:
        """Equilibria whose bodies are drawn one by one, by their headings."""
        return {"": self.equilibrium}

    def free_bodies(self) -> Figure:
        """Draw each body by itself with the forces on it."""
        return free_body_diagrams(self.equilibria)

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
