"""Friction in a mechanism: its forces without friction, squeezing and releasing, side by side."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.edge.tables import table
from beamdyn.common.one_line import error_at_most
from beamdyn.common.results import Result, plain
from brakes.answers.planar_tables import format_force, format_size, largest_error
from brakes.planar import (
    Equilibrium,
    FrictionalEquilibrium,
    Load,
    Mechanism,
    Position,
    Stroke,
    solve_with_friction,
)
from brakes.planar.rows import Row

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
