"""Base of the answers on calipers and on mechanisms: diagnosis, handles, free bodies, animation."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.app.screens import Handle
from beamdyn.common.edge.inputs import describe
from beamdyn.common.edge.wording import in_small_units
from brakes.answers.base import Answer
from brakes.answers.planar_tables import units_of
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput
from brakes.drawings.mechanism import animate, free_body_diagrams
from brakes.planar import Equilibrium, Position, Stroke

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
