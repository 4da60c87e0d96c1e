"""The program ``brakes app`` and its documents, input files with their screens; most are made from types."""

from __future__ import annotations

from dataclasses import replace

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.console import table
from beamdyn.common.edge.rendering import html
from beamdyn.common.edge.units import show
from beamdyn.common.screens.screens import FoldedPart, Program
from brakes.answers import STANDARD, caliper, forklift
from brakes.answers.forklift import ForkliftAnswer, stage_outputs
from brakes.answers.tables import list_outputs
from brakes.app.mechanism_lists import LISTS
from brakes.app.screens import make_document, make_screen
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput, parse_mechanism
from brakes.reproduce.forklift_as_printed import answer_as_printed

# The forklift: vehicle, kinematics and internal forces; later screens use results of earlier ones --------


def _as_printed(answer: ForkliftAnswer) -> str:
    """Make an HTML table of the results beside the printed results of the paper's stop."""
    printed = answer_as_printed(answer.design, answer.stages) or answer
    rows = list_outputs(stage_outputs(answer.stages), [answer, printed])
    return html([table("", ("", "corrected", "as printed", "unit"), rows, (0, 3))])


_PAPER = FoldedPart("As the paper prints", _as_printed, _as_printed)
VEHICLE = make_screen(forklift.TYPES["vehicle"], _PAPER)
KINEMATICS = make_screen(forklift.TYPES["kinematics"])
FORCES = make_screen(forklift.TYPES["forces"], _PAPER)
FORKLIFT = make_document(forklift.FORKLIFT, (VEHICLE, KINEMATICS, FORCES))


# Calipers, given by name with their dimensions, and mechanisms, given by bodies and joints -----------------


def check_caliper(text: str, source: str) -> CaliperInput:
    """Parse the file of a named caliper; raises `ConfigError` if it describes another mechanism."""
    design = parse_mechanism(text, source)
    if not isinstance(design, CaliperInput):
        raise ConfigError(source, ["caliper: missing; a mechanism of parts has a screen of its own"])
    return design


def check_mechanism(text: str, source: str) -> MechanismInput:
    """Parse the file of a mechanism given by its bodies and joints.

    Raises
    ------
    ConfigError
        If the file names a caliper, or a point has a name that the form's paths cannot hold.
    """
    design = parse_mechanism(text, source)
    if not isinstance(design, MechanismInput):
        raise ConfigError(source, ["caliper: it is a named caliper, which has a screen of its own"])
    if dotted := [name for name in design.points if "." in name]:
        raise ConfigError(
            source, [f"points: {show(dotted[0])} has a dot; give the point another name, e.g. with a dash"]
        )
    return design


CALIPER = make_document(caliper.CALIPER, check=check_caliper)
MECHANISM = make_document(
    caliper.MECHANISM, (replace(make_screen(caliper.MECHANISM), lists=LISTS),), check=check_mechanism
)


_STANDARD = (make_document(load()) for _, load in STANDARD.values())
BRAKES = Program("brakes", "Brakes", (FORKLIFT, *_STANDARD, CALIPER, MECHANISM))
