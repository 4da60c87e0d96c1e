"""Which of a mechanism's solutions with friction is drawn, and the mark where it locks itself."""

import asyncio
import json
from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.drawing.shapes import Symbol
from beamdyn.common.screens.open_document import OpenDocument
from brakes.app.program import BRAKES, MECHANISM

BLOCK_BRAKE = (Path(__file__).parents[2] / "examples" / "block_brake.toml").read_text(encoding="utf-8")
SCREEN = MECHANISM.screens[0]
NAMES = ["without friction", "squeezing", "releasing"]
SLOPE, FRICTION, WEIGHT = np.radians(10.0), 0.3, 5000.0
WEDGE = """
title = "wedge"
bodies = ["wedge", "load"]
[points]
A = ["0 mm", "0 mm"]
B = ["0 mm", "50 mm"]
[[contact]]
name = "floor"
body = "wedge"
at = "A"
normal = [0, 1]
friction = 0.3
[[contact]]
name = "face"
body = "load"
other = "wedge"
at = "B"
normal = "80 deg"
friction = 0.3
[[slot]]
name = "guide"
body = "load"
at = "B"
along = [0, 1]
[[rotation_lock]]
name = "flat"
body = "wedge"
[[rotation_lock]]
name = "upright"
body = "load"
[[force]]
name = "push"
body = "wedge"
at = "A"
direction = [1, 0]
[[force]]
name = "weight"
body = "load"
at = "B"
direction = [0, -1]
magnitude = "5000 N"
[run]
driver = "push"
travel = "10 mm"
points = 11
"""


def answer(text):
    work = OpenDocument(MECHANISM)
    work.open(text, "mine.toml")
    assert work.solve(SCREEN), work.mistakes
    return work.answered[SCREEN.name].answer


def drawing(answer, place=1.0):
    ((made,),) = SCREEN.drawings(answer, place)
    return made


def force(answer, name):
    """Size of an arrow as drawn [N]."""
    made = drawing(answer)
    return float(np.hypot(*made.arrows[name])) / made.newton


def marks(answer):
    return [shape for shape in drawing(answer).shapes if isinstance(shape, Symbol) and shape.role == "inside"]


def test_the_forces_drawn_are_those_of_the_branch():
    """A wedge, in with W (tan(phi + slope) + tan(phi)), out with the other sign."""
    found, phi = answer(WEDGE), np.arctan(FRICTION)
    branches = SCREEN.branches(found)
    assert [*branches] == NAMES
    expected = {
        "without friction": np.tan(SLOPE),
        "squeezing": np.tan(phi + SLOPE) + np.tan(phi),
        "releasing": np.tan(phi - SLOPE) + np.tan(phi),
    }
    for name, branch in branches.items():
        assert force(branch, "push") == pytest.approx(WEIGHT * expected[name], rel=1e-9)
        assert name in drawing(branch).title
    assert force(branches["squeezing"], "friction of floor") == pytest.approx(FRICTION * WEIGHT, rel=1e-9)
    assert "friction of floor" not in drawing(branches["without friction"]).arrows


def test_a_branch_that_locks_is_marked_in_drawing_and_curves():
    branches = SCREEN.branches(answer(WEDGE))
    assert [len(marks(branch)) for branch in branches.values()] == [0, 0, 1]
    (words,) = [label.text for label in drawing(branches["releasing"]).labels if label.role == "inside"]
    assert words == "locks: push has to act the other way"
    (chart,) = SCREEN.charts(branches["squeezing"], 1.0)
    assert [points.name for points in chart.points] == ["push, releasing: locks"]
    assert len(chart.points[0].at) == 11
    (axes,) = branches["squeezing"].figure().axes[1:]  # the same in the file
    marked = next(line for line in axes.lines if line.get_label() == "push, releasing: locks")
    assert len(marked.get_xdata()) == 11


def test_a_brake_that_jams_is_marked():
    """At mu = block / offset = 5 the friction presses the block on as hard as its reaction lifts it."""
    branches = SCREEN.branches(answer(BLOCK_BRAKE.replace("friction = 0.4", "friction = 5.1")))
    assert [len(marks(branch)) for branch in branches.values()] == [0, 1, 0]
    assert "locks: no torque moves it" in [label.text for label in drawing(branches["squeezing"]).labels]


def test_without_friction_there_is_one_branch():
    work = OpenDocument(MECHANISM)
    assert work.solve(SCREEN)
    assert SCREEN.branches(work.answered[SCREEN.name].answer) == {}


LOCKS = "has to act the other way"


def test_the_page_draws_the_branch_that_is_chosen(simulate, fields):
    entries = MECHANISM.opened(WEDGE, "wedge")

    def toggle(user):
        """That of the last screen."""
        found = [e for e in user.client.elements.values() if e.props.get("aria-label") == "forces drawn"]
        return found[-1]

    def pictures(user):
        return [p for e in user.client.elements.values() if "machine" in (p := e.props.get("innerHTML", ""))]

    async def body(another):
        user = await another(json.dumps({"front": "Mechanism", "designs": {"mechanism": entries}}))
        await asyncio.sleep(0.5)
        it = toggle(user)
        assert it.options == NAMES and it.value == NAMES[0]
        assert not any(LOCKS in picture for picture in pictures(user))
        with user.client:
            it.set_value("releasing")
        assert any(LOCKS in picture for picture in pictures(user))

    simulate(BRAKES, body)
