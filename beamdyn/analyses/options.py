"""Options that several analyses share: meaning, bounds, and conversion of texts."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses import values
from beamdyn.analyses.analysis import AsText

Text = Annotated[str, Parameter(allow_leading_hyphen=True)]


def none_given(_: bd.Scene) -> None:
    """Return None, the value of an option that may be left out."""


def final_speed(scene: bd.Scene) -> float:
    """Return the final speed of the scene's motion [rad/s], the default of the option for the speed."""
    return scene.final_speed


def positive(unit: str, **more: Any) -> AsText:
    """Describe an option that is a positive number with a unit."""
    return AsText(lambda option, text, _: values.parse_positive(option, text, unit), **more)


# Speeds and times -----------------------------------------------------------------------------------

_AT_SPEED = (
    'Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene\'s motion'
)
AtSpeed = Annotated[
    float, AsText(values.parse_speed, absent=final_speed), Parameter(help=f"{_AT_SPEED}, or 0 without one.")
]
AtFinalSpeed = Annotated[
    float, AsText(values.parse_speed, absent=final_speed), Parameter(help=f"{_AT_SPEED}.")
]
Speed = Annotated[float | None, AsText(values.parse_speed, absent=none_given)]
PositiveSpeed = Annotated[float, positive("rad/s")]
Speeds = Annotated[Any, AsText(lambda _, text, scene: values.parse_speeds(text, scene))]

EndOfRun = Annotated[float, positive("s")]

# Discretization, modes and physics ------------------------------------------------------------------

Named = Literal["ritz", "fem"]
Discretization = Annotated[
    Named,
    Parameter(
        help="ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other."
    ),
]
ModeCount = Annotated[int, values.at_most(100), Parameter(help="Number of modes, from the lowest.")]
Count = Annotated[int, values.at_most(100)]
CountOrAuto = Annotated[int | Literal["auto"], values.at_most(100)]
SmallestBasis = Annotated[
    CountOrAuto,
    Parameter(help="Number of modes; auto: the smallest whose modal truncation error meets the tolerance."),
]
Order = Annotated[int, values.at_most(5)]
FrequencyTolerance = Annotated[
    float | None,
    Parameter(
        help="Largest relative error of a frequency: the cheapest discretization that meets it is chosen; "
        "if not given, 1e-11, or 1e-4 where a rectangular section cambers or twists."
    ),
]
TimeTolerance = Annotated[
    float, Parameter(help="Target for the time-integration error, relative to the largest deflection.")
]

# Roads, and loads along the span --------------------------------------------------------------------

RoadClass = Literal["A", "B", "C", "D", "E", "F", "G", "H"]

LoadQuantity = Literal["force", "moment", "curvature", "strain", "stress"]
Stations = Annotated[
    list[float] | None,
    AsText(lambda option, text, _: values.parse_positions(option, text), absent=none_given),
    Parameter(
        help='Stations with their unit, e.g. "0, 10, 25 mm"; default: 21 along the beam, and both sides of '
        "each jump of the section."
    ),
]
SectionPoints = Annotated[
    list[list[float]] | None,
    AsText(lambda option, text, _: values.parse_points(option, text), absent=none_given),
    Parameter(
        help='Points of the section with their unit, e.g. "-0.1:0, 0.1:2 mm": coordinates in its first '
        "direction, in which the beam bends, and in the second. Default: the outermost points."
    ),
]
YoungsModulus = Annotated[
    float | None,
    AsText(lambda option, text, _: values.parse_positive(option, text, "Pa"), absent=none_given),
    Parameter(
        help='Modulus by which stress follows from strain, with its unit, e.g. "70 GPa"; default: that of a '
        "rectangular beam."
    ),
]
