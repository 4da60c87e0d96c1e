"""The forklift's three screens: vehicle, kinematics, internal forces, each handing on to the next."""

from __future__ import annotations

from matplotlib.figure import Figure

from brakes.answers import forklift
from brakes.answers.forklift import ForkliftAnswer, stage_outputs
from brakes.app.screens import make_document, make_screen
from brakes.reproduce.forklift import compare
from brakes.reproduce.forklift_as_printed import answer_as_printed


def draw_as_printed(answer: ForkliftAnswer) -> Figure:
    """Results beside those that follow from the paper's stop."""
    printed = answer_as_printed(answer.design, answer.stages)
    return compare(stage_outputs(answer.stages), answer, printed or answer)


_PAPER = ("As the paper prints", draw_as_printed)
VEHICLE = make_screen(forklift.TYPES["vehicle"], _PAPER)
KINEMATICS = make_screen(forklift.TYPES["kinematics"])
FORCES = make_screen(forklift.TYPES["forces"], _PAPER)
FORKLIFT = make_document(forklift.FORKLIFT, (VEHICLE, KINEMATICS, FORCES))
