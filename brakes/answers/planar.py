"""Tables, outputs, friction, and handles that results of calipers and of mechanisms share."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.console import table
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import describe
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.one_line import error_at_most, rounded_up
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import Result, plain
from beamdyn.common.screens.screen_parts import Handle
from beamdyn.common.words import Words
from brakes.answers.base import Answer
from brakes.config.mechanism import CaliperInput, MechanismInput
from brakes.drawings.mechanism import animate, free_body_diagrams
from brakes.drawings.mechanism_parts import members
from brakes.planar import Equilibrium, FrictionalEquilibrium, Load, Mechanism, Position, Stroke

_ROWS = 5  # number of positions of a stroke that the table shows


def units_of(load: Load) -> tuple[float, str, str]:
    """Return factor and unit for showing a load's travel, and the unit of the load."""
    return (180 / np.pi, "deg", load.unit) if load.is_couple else (1e3, "mm", load.unit)


def joint_outputs(mechanism: Mechanism, magnitudes: Any) -> list[Output]:
    """Describe each joint's largest force; `magnitudes(answer)` returns the forces of all joints."""
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
    """Make the name of an output from the name of a joint or load: no spaces, no commas."""
    return words.replace(" ", "_").replace(",", "")


def select_rows(count: int) -> np.ndarray:
    """Return the indices of the positions that the table shows, of `count` positions in a stroke."""
    return evenly_spread(count, _ROWS)


def reactions_table(equilibrium: Equilibrium, title: str) -> Any:
    """Make a table of loads, joint forces (each on the body named first) and forces in two-force bodies."""
    mechanism, magnitudes = equilibrium.position.mechanism, equilibrium.magnitudes
    rows: list[Sequence[str]] = [
        (load.name, "load", "", "", format_force(equilibrium.amplitudes[load.name]), load.unit, "")
        for load in mechanism.loads
    ]
    rows.append(())
    # Forces smaller than their largest error [N] count as neither tension nor compression.
    largest = np.nan_to_num(np.abs(np.concatenate([(0.0,), *map(np.ravel, magnitudes.values())])))
    least = max(1e-9, float(np.nan_to_num(equilibrium.largest_error)) * float(largest.max(initial=0.0)))
    for joint in mechanism.joints:
        size = float(np.ravel(magnitudes[joint.name])[0])
        xy = (
            ("", "")
            if joint.is_couple
            else map(format_force, np.ravel(equilibrium.reactions[joint.name])[:2])
        )
        sense = joint.signs[0 if size > 0 else 1] if abs(size) > least else ""
        ends = f"on {joint.acts_on[0]} from {joint.acts_on[-1]}"
        rows.append((joint.name, ends, *xy, format_force(size), joint.unit, sense))
    for member in members(equilibrium.position, equilibrium):
        if member.name in mechanism.bodies and np.isfinite(member.force):
            pulls = "tension" if member.force > 0 else "compression"
            size, sense = format_force(abs(member.force)), pulls if abs(member.force) > least else ""
            rows.append((member.name, "two-force body", "", "", size, "N", sense))
    return table(title, ("force", "of", "x [N]", "y [N]", "size", "unit", ""), rows, (0, 1, 5, 6))


def format_force(value: Any, digits: int = 5) -> str:
    """Format a force as text; nan (statics does not give the force, or friction jams): "not determined"."""
    number = float(np.ravel(value)[0])
    if np.isnan(number):
        return "not determined"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g}"


def format_size(value: Any, unit: str, digits: int = 5) -> str:
    """Format a force or moment with its unit; nan gives "not determined" without a unit."""
    return format_force(value, digits) + ("" if np.isnan(value) else f" {unit}")


# Friction in a mechanism: forces without friction, squeezing and releasing, side by side -------------


_ROUNDING = 1e-9  # loads below this fraction of the largest are shown as 0


@dataclass(frozen=True)
class MechanismFriction(Result):
    """Equilibria of a mechanism with friction, as drawn in its file and over the stroke of a driver.

    Attributes
    ----------
    driver : str
        Name of the load whose travel grows while the mechanism is squeezed.
    drawn : FrictionalEquilibrium
        Equilibria as drawn.
    over : FrictionalEquilibrium, optional
        Equilibria at each position of the stroke.
    """

    driver: str
    drawn: FrictionalEquilibrium
    over: FrictionalEquilibrium | None

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"driven by {self.driver}"
        yield error_at_most(self.error)
        yield from (f"{name}: {way.status}" for name, way in self._moving(self.last))

    @staticmethod
    def _moving(found: FrictionalEquilibrium) -> list[tuple[str, Equilibrium]]:
        """Return names and equilibria of the two directions of motion, squeezing and releasing."""
        return [*found.ways.items()][1:]

    @property
    def last(self) -> FrictionalEquilibrium:
        """Equilibria over the stroke, or as drawn if there is no stroke."""
        return self.over or self.drawn

    def locking(self, answered: bool) -> list[str]:
        """Return a sentence on each direction of motion whose status is not "determined".

        If `answered`, only directions in which the mechanism can be in equilibrium are included, such as a
        self-locking direction; else only directions in which it cannot.
        """
        return [
            Words(name, ": ", way.message)
            for name, way in self._moving(self.last)
            if way.status != "determined" and way.has_answer == answered
        ]

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on directions in which the mechanism jams, a contact opens or a cable slackens."""
        return self.locking(answered=False)

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on self-locking directions of motion, and on joints that jam if a load is offset."""
        said = self.last.without.warnings
        jams = (warning for _, way in self._moving(self.last) for warning in way.warnings)
        return [*self.locking(answered=True), *dict.fromkeys(each for each in jams if each not in said)]

    @property
    def error(self) -> float:
        """Largest error of the forces, relative to the largest force, where there is equilibrium."""
        return max(way.largest_error for way in self.last.ways.values())

    def table(self) -> RenderableType:
        """Make a table of loads, joints and friction as drawn: without friction, squeezing, releasing."""
        mechanism, ways = self.drawn.without.position.mechanism, self.drawn.ways
        sizes = [way.amplitudes | way.magnitudes for way in ways.values()]
        rows = [
            (part.name, *(format_force(size[part.name]) for size in sizes), part.unit)
            for part in (*mechanism.loads, *mechanism.joints)
        ]
        rubbing = [
            (
                f"friction of {name}",
                *map(format_force, (0.0, *(way.friction[name] for _, way in self._moving(self.drawn)))),
                "N m" if law.row.is_couple else "N",
            )
            for name, (_, law) in mechanism.friction.items()
        ]
        title = f"With friction, as drawn; squeezing: motion along {self.driver}, releasing: against it"
        return table(title, ("size of", *ways, "unit"), [*rows, (), *rubbing], (0, 4))

    def curves(self) -> list[tuple[Load, str, np.ndarray]]:
        """Return a curve over the stroke for each unknown load and direction of motion.

        Each curve is given by its load, its name, and its values [N, N m].
        """
        return [
            (load, f"{load.name}, {name}", way.amplitudes[load.name])
            for load in self.last.without.position.mechanism.unknown_loads
            for name, way in self._moving(self.last)
        ]

    def captions(self, index: int) -> Iterator[str]:
        """State each unknown load at the position of an index: without friction, squeezing, releasing."""
        for load in self.drawn.without.position.mechanism.unknown_loads:
            sizes = np.array([np.ravel(way.amplitudes[load.name])[index] for way in self.last.ways.values()])
            sizes[np.abs(sizes) < _ROUNDING * np.nanmax(np.abs(sizes), initial=0.0)] = 0.0
            said = (
                f"{format_size(size, load.unit, 4)} {way}"
                for size, way in zip(sizes, self.last.ways, strict=True)
            )
            yield f"{load.name}: {', '.join(said)}"

    def locked(self) -> dict[str, np.ndarray]:
        """Return masks of the positions of the stroke at which the mechanism locks, by the name of the curve.

        Locking means that it jams, so that there is no force, or that the unknown load must reverse.
        """
        amplitudes, found = self.last.without.amplitudes, {}
        least = _ROUNDING * np.nanmax(np.abs([*amplitudes.values()]), initial=0.0)
        for load, name, size in self.curves():
            without = amplitudes[load.name]
            turned = (np.abs(without) > least) & (size * np.sign(without) < -least)
            found[name] = np.isnan(size) | turned
        return {name: where for name, where in found.items() if where.any()}

    def to_dict(self) -> dict[str, Any]:
        """Convert the equilibria as drawn to plain numbers, lists and strings, by direction of motion."""
        keys = ("status", "message", "reactions", "magnitudes", "amplitudes", "friction", "residual")
        return {"driver": self.driver} | {
            n: {key: plain(getattr(way, key)) for key in keys} for n, way in self._moving(self.drawn)
        }


# Base of results of calipers and of mechanisms: statics, handles, free bodies, animation -----------


_FRAMES = 30  # number of frames in an animation


@dataclass(frozen=True)
class PlanarAnswer(Answer):
    """Base of results of calipers and of mechanisms.

    Attributes
    ----------
    design : CaliperInput or MechanismInput
        The design that the file describes.
    equilibrium : Equilibrium
        Equilibrium of a caliper at the end of its stroke, or of a mechanism as drawn.
    motion : Stroke, optional
        Positions over the stroke.
    """

    design: CaliperInput | MechanismInput
    equilibrium: Equilibrium
    motion: Stroke | None

    def headline(self) -> Iterator[str]:
        """Yield status, error and refusals for a one-line summary; see `Result.headline`."""
        yield self.status
        yield from (part for part in super().headline() if part != self.status)

    @property
    @abstractmethod
    def status(self) -> str:
        """Whether statics determines the forces; see `planar.Equilibrium`."""

    @property
    @abstractmethod
    def message(self) -> str:
        """The status as a sentence."""

    @property
    def refusals(self) -> Sequence[str]:
        """Sentence on loose bodies or undetermined reactions; empty if statics determines all forces."""
        return () if self.status == "determined" else (in_files(self.message),)

    def _diagnosis(self, message: str, virtual_work: np.ndarray) -> str:
        """State the result of statics in a sentence or two, with the error of the forces if there are any."""
        mobility, indeterminacy = self.equilibrium.mobility, self.equilibrium.indeterminacy
        error = self.error
        stated = "" if np.isnan(error) else f" Error of the forces: {rounded_up(error)} of the largest."
        return (
            f"Statics: {in_files(message)}. Mobility {int(np.max(mobility))}, indeterminacy "
            f"{int(np.max(indeterminacy))}; virtual work of all loads, over the "
            f"largest force: {np.max(virtual_work):.1e}.{stated}"
        )

    def handles(self, place: float) -> Sequence[Handle]:
        """Make handles to drag the points given in the file: those of a named caliper, or of a mechanism."""
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
        """Equilibria for which free-body diagrams are drawn, by the heading of the diagrams."""
        return {"": self.equilibrium}

    def free_bodies(self) -> Figure:
        """Draw the free-body diagram of each body."""
        return free_body_diagrams(self.equilibria)

    def animate(self, path: Path, force: bool) -> None:
        """Write an animation of the stroke as a GIF file; replace an existing file only if forced.

        Raises
        ------
        ValueError
            If there is no stroke.
        """
        if self.motion is None:
            raise ValueError("--animation needs a stroke: name run.driver and run.travel in the file")
        motion, mechanism = self.motion, self.motion.position.mechanism
        frames = evenly_spread(len(motion.values), _FRAMES)
        factor, unit, _ = units_of(mechanism.load(motion.driver))
        captions = [f"{motion.driver}: {factor * motion.values[k]:.2f} {unit}" for k in frames]
        animate(Position(mechanism, motion.position.batch[frames]), path, captions.__getitem__, force)
