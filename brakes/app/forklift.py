"""The forklift's three screens: vehicle, kinematics and internal forces, which uses results of the others."""

from __future__ import annotations

from beamdyn.common.edge.rendering import html
from beamdyn.common.edge.tables import table
from beamdyn.common.screens.screens import FoldedPart
from brakes.answers import forklift
from brakes.answers.forklift import ForkliftAnswer, stage_outputs
from brakes.answers.tables import list_outputs
from brakes.app.screens import make_document, make_screen
from brakes.reproduce.forklift_as_printed import answer_as_printed


def _as_printed(answer: ForkliftAnswer) -> str:
    """Results beside those that follow from the paper's stop, in HTML."""
    printed = answer_as_printed(answer.design, answer.stages) or answer
    rows = list_outputs(stage_outputs(answer.stages), [answer, printed])
    return html([table("", ("", "corrected", "as printed", "unit"), rows, (0, 3))])


_PAPER = FoldedPart("As the paper prints", _as_printed, _as_printed)
VEHICLE = make_screen(forklift.TYPES["vehicle"], _PAPER)
KINEMATICS = make_screen(forklift.TYPES["kinematics"])
FORCES = make_screen(forklift.TYPES["forces"], _PAPER)
FORKLIFT = make_document(forklift.FORKLIFT, (VEHICLE, KINEMATICS, FORCES))
