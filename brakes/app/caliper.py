"""The screens of calipers, given by name with their dimensions, and of mechanisms given part by part."""

from __future__ import annotations

from dataclasses import replace

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.units import show
from brakes.answers import caliper
from brakes.app.mechanism_lists import LISTS
from brakes.app.screens import make_document, make_screen
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput, parse_mechanism


def check_caliper(text: str, source: str) -> CaliperInput:
    """Parse the file of a named caliper; raises `ConfigError` if it is of another kind."""
    design = parse_mechanism(text, source)
    if not isinstance(design, CaliperInput):
        raise ConfigError(source, ["caliper: missing; a mechanism of parts has a screen of its own"])
    return design


def check_mechanism(text: str, source: str) -> MechanismInput:
    """Parse the file of a mechanism given part by part.

    Raises
    ------
    ConfigError
        If it is of another kind, or has a name that the form's paths cannot hold.
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
