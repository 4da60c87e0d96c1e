"""A joint that no module of the package knows, written by the guidelines of `Joint`; the lists of kinds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from beamdyn.common.inputs.described import descriptions
from brakes import planar
from brakes.config.mechanism import PARTS
from brakes.drawings.mechanism import mechanism_drawing
from brakes.planar import (
    GROUND,
    JOINTS,
    LOADS,
    Force,
    Joint,
    Mechanism,
    Shape,
    free_body,
    solve_with_friction,
)
from brakes.planar.part import Body, Coefficient, DrawnPoint, Other
from brakes.planar.rows import FrictionLaw, Line, Row


@dataclass(frozen=True)
class Guide(Joint):
    """Two points of a body slide along the x axis of another body; each rubs."""

    label = "guides"

    body: Body
    other: Other
    at: DrawnPoint
    to: DrawnPoint
    friction: Coefficient = 0.0

    def _line(self, at, normal) -> Line:
        return Line(self.body, at, self.other, self.at, self.other, normal)

    def rows(self) -> tuple[Row, ...]:
        return self._line(self.at, (0.0, 1.0)), self._line(self.to, (0.0, 1.0))

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        first, second = self._line(self.at, (1.0, 0.0)), self._line(self.to, (1.0, 0.0))
        return (
            FrictionLaw(first, self.friction, (0,), "at"),
            FrictionLaw(second, self.friction, (1,), "to"),
        )

    def shapes(self) -> tuple[Shape, ...]:
        return tuple(Shape("face", ((self.body, at),), self.other) for at in (self.at, self.to))


def drawer(friction: float, arm: float) -> Mechanism:
    """A drawer pulled at an arm against 10 N, on a guide of length 2."""
    loads = Force("pull", "drawer", (2, arm), (1, 0)), Force("load", "drawer", (0, 0), (-1, 0), 10.0)
    return Mechanism(("drawer",), (Guide("rail", "drawer", GROUND, (0, 0), (2, 0), friction),), loads)


@pytest.mark.parametrize(("friction", "arm"), [(0.1, 0.5), (0.3, 1.2), (0.9, 1.1)])
def test_a_drawer(friction: float, arm: float):
    """P = F/(1 - 2 mu e/l) opens it and F/(1 + 2 mu e/l) holds it; the normal forces are P e/l."""
    found = solve_with_friction(drawer(friction, arm), "pull")
    assert found.squeeze.amplitudes["pull"] == pytest.approx(10 / (1 - friction * arm), rel=1e-12)
    assert found.release.amplitudes["pull"] == pytest.approx(10 / (1 + friction * arm), rel=1e-12)
    normal = found.squeeze.amplitudes["pull"] * arm / 2
    for end in ("rail at", "rail to"):
        assert found.squeeze.friction[end] == pytest.approx(-friction * normal, rel=1e-12)
    actions = free_body(found.squeeze, "drawer")
    assert np.abs(sum(action.force for action in actions)).max() < 1e-12 * normal


def test_a_drawer_jams():
    assert solve_with_friction(drawer(0.5, 2.1), "pull").squeeze.status == "self-locking"


def test_it_is_drawn_and_its_inputs_are_checked():
    made = mechanism_drawing(drawer(0.1, 0.5).drawing)
    assert sum(shape.role == "contact" for shape in made.shapes) == 2  # faces
    with pytest.raises(ValueError, match="guide 'rail': friction = -1: it must be at least 0"):
        drawer(-1.0, 0.5)


@pytest.mark.parametrize("part", JOINTS + LOADS)
def test_every_kind_is_listed_exported_and_described(part: type[planar.Part]):
    assert part.__name__ in planar.__all__
    assert PARTS[part.key()].startswith(f"{part.label}: name, ")
    assert all(described.meaning for described in descriptions(part).values())
