"""Twenty cases for collocation of the twisted beam, and the file of their frequencies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from benchmarks.cases.reference.generate import table
from benchmarks.cases.reference.twisted_beam.blade import Blade, Body, Function, Pair, constant
from benchmarks.cases.reference.twisted_beam.collocation import converged

Case = dict[str, Any]

TARGET = Path(__file__).parents[2] / "data" / "second_method.toml"
MODES = 4

HEADER = """\
# Beams that bend in two planes, with twist, shear, rotary inertia, tip bodies and root springs.
# Written by `python -m benchmarks.cases.reference.twisted_beam`: do not edit.
#
# All values come from that second method, collocation of the differential equations (see its docstring),
# not from a publication and not from beamdyn. Their squares on two meshes, one of half the size of the other,
# agree to {change:.0e}. Length 1; keys as the arguments of bd.Mount and bd.Beam.from_stiffness, angles in
# degrees but for the twist in rad, and
#   gamma        the speed
#   planes       of bending
#   breakpoints  where a property jumps; it then is a list of polynomials in x/L, one for each piece
#   mass_per_length and all other properties: coefficients of a polynomial in x/L, lowest first
#   tip          its axes are those of the section at the tip
#   frequency    the four lowest, 12 digits
"""

# Properties, then scenes; each case lists its additions to a uniform clamped beam with two planes.
ROUND = {"mass_per_length": [1.0], "bending_stiffness": [1.0], "second_bending_stiffness": [4.0]}
SHEAR = {"shear_stiffness": [250.0], "second_shear_stiffness": [400.0]}
ROTARY = {"rotary_inertia": [0.0012], "second_rotary_inertia": [0.0048]}
STOCKY_SHEAR = {"shear_stiffness": [60.0, -24.0], "second_shear_stiffness": [90.0, -30.0]}
STOCKY_ROTARY = {"rotary_inertia": [0.004, -0.002], "second_rotary_inertia": [0.03, -0.012]}
TAPER = {
    "mass_per_length": [1.0, -0.5],
    "bending_stiffness": [1.0, -0.7],
    "second_bending_stiffness": [9.0, -6.0],
}
CURVED_TAPER = {
    "mass_per_length": [1.0, 0.3, -0.7],
    "bending_stiffness": [1.0, -1.2, 0.6, -0.1],
    "second_bending_stiffness": [5.0, -3.0, -0.5],
}
JUMP = {
    "breakpoints": [0.4],
    "mass_per_length": [[1.0], [0.6, -0.2]],
    "bending_stiffness": [[1.0], [0.5, -0.2]],
    "second_bending_stiffness": [[3.0], [2.5, -1.0]],
}
TWO_JUMPS = {
    "breakpoints": [0.15, 0.625],
    "mass_per_length": [[1.0], [0.7], [0.4, 0.1]],
    "bending_stiffness": [[1.0, 0.5], [0.6], [0.3]],
    "second_bending_stiffness": [[2.0], [3.0, -1.0], [1.5]],
    "shear_stiffness": [[300.0], [180.0], [90.0]],
    "second_shear_stiffness": [[500.0], [350.0, -100.0], [200.0]],
    "rotary_inertia": [[0.002], [0.0012], [0.0006]],
    "second_rotary_inertia": [[0.006], [0.004, -0.001], [0.002]],
}
BODY = {"mass": 0.4, "offset": 0.06, "inertia": 0.012, "transverse_inertia": 0.02, "axial_inertia": 0.017}
FLAT_BODY = {
    "mass": 0.25,
    "offset": -0.03,
    "inertia": 0.003,
    "transverse_inertia": 0.024,
    "axial_inertia": 0.026,
}
OUTWARD, TRAILING = 180.0, 90.0

# name, gamma, radius, setting angle, bending angle [deg], root springs, parts
SCENES: list[tuple[str, float, float, float, float, tuple[float, float] | None, list[Case]]] = [
    ("twist and shear", 3, 0.2, OUTWARD, 90, None, [SHEAR, {"twist": [0.0, 0.6]}]),
    (
        "twist, shear, rotary inertia, fast",
        12,
        0.5,
        OUTWARD,
        90,
        None,
        [SHEAR, ROTARY, {"twist": [0.0, -0.8]}],
    ),
    (
        "taper, twist, shear, rotary inertia",
        6,
        1.0,
        OUTWARD,
        70,
        None,
        [TAPER, SHEAR, ROTARY, {"twist": [0.0, 0.5]}],
    ),
    ("curved taper and twist", 8, 0.1, OUTWARD, 80, None, [CURVED_TAPER, {"twist": [0.0, 0.9, -0.4]}]),
    ("jump and kinked twist", 4, 0.3, OUTWARD, 85, None, [JUMP, {"twist": [[0.0], [-0.28, 0.7]]}]),
    ("two jumps, all effects", 7, 0.8, OUTWARD, 35, None, [TWO_JUMPS, {"twist": [[0.0, 0.5]] * 3}]),
    ("three inertias at the tip, twist", 5, 0.4, OUTWARD, 90, None, [{"twist": [0.0, 0.7], "tip": BODY}]),
    ("flat body inboard of the tip, oblique", 9, 0.0, OUTWARD, 40, None, [{"tip": FLAT_BODY}]),
    ("springs", 4, 0.5, OUTWARD, 90, (3.0, 11.0), [{"twist": [0.0, 0.45]}]),
    ("flap hinge and lag spring", 10, 0.15, OUTWARD, 90, (0.0, 2.0), [SHEAR, ROTARY, {"twist": [0.0, 0.3]}]),
    ("inward, twist, shear", 1.1, 3.0, 0.0, 20, None, [SHEAR, ROTARY, {"twist": [0.0, 0.5]}]),
    ("inward, oblique, tip body", 0.8, 1.7, 0.0, 55, None, [TAPER, {"tip": BODY}]),
    ("tangential, tip body", 2.5, 1.3, TRAILING, 30, None, [{"twist": [0.0, -0.4], "tip": BODY}]),
    (
        "second direction softer, then stiffer",
        5,
        0.2,
        OUTWARD,
        60,
        None,
        [{"bending_stiffness": [1.0, -0.6], "second_bending_stiffness": [0.6, 0.7], "twist": [0.0, 1.0]}],
    ),
    (
        "a quarter turn of twist, very fast",
        25,
        0.3,
        OUTWARD,
        40,
        None,
        [TAPER, ROTARY, {"twist": [0.0, 1.570796]}],
    ),
    ("oblique, rotary inertia alone, fast", 20, 0.1, OUTWARD, 45, None, [STOCKY_ROTARY]),
    (
        "one plane, oblique, all effects",
        6,
        0.3,
        OUTWARD,
        65,
        (5.0, math.inf),
        [{"planes": 1}, STOCKY_SHEAR, STOCKY_ROTARY, {"tip": BODY}],
    ),
    (
        "stocky, inward, flap hinge",
        0.6,
        0.25,
        0.0,
        90,
        (0.0, math.inf),
        [STOCKY_SHEAR, {"twist": [0.0, 0.8]}],
    ),
    (
        "all at once, 135 deg",
        3,
        0.9,
        135.0,
        75,
        (20.0, 60.0),
        [CURVED_TAPER, STOCKY_SHEAR, STOCKY_ROTARY, {"twist": [0.0, -0.9, 0.2], "tip": FLAT_BODY}],
    ),
    (
        "all at once, inward at 30 deg, jumps",
        0.9,
        1.2,
        30.0,
        15,
        (8.0, 25.0),
        [TWO_JUMPS, {"twist": [[0.0, 0.4]] * 3, "tip": FLAT_BODY}],
    ),
]


def cases() -> list[Case]:
    return [_case(number, *scene) for number, scene in enumerate(SCENES, start=1)]


def _case(
    number: int,
    name: str,
    gamma: float,
    radius: float,
    setting: float,
    bending: float,
    springs: tuple[float, float] | None,
    parts: list[Case],
) -> Case:
    scene = {"gamma": gamma, "radius": radius, "setting_angle_deg": setting, "bending_angle_deg": bending}
    case = {"name": f"{number:02d} {name}", "source": "collocation", "planes": 2}
    case |= {key: float(value) for key, value in scene.items()}
    if springs:
        case["root_stiffness"] = list(springs)
    case |= ROUND
    for part in parts:
        case |= part
    return case if case["planes"] == 2 else {k: v for k, v in case.items() if not k.startswith("second_")}


def blade_of(case: Case) -> Blade:
    """Return the blade of a case, with unit length."""
    stops = case.get("breakpoints", ())

    def function(name: str, default: float) -> Function:
        return piecewise(case[name], stops) if name in case else constant(default)

    def pair(name: str, default: float) -> Pair:
        return function(name, default), function(f"second_{name}", default)

    stiff, soft = pair("shear_stiffness", math.inf)
    return Blade(
        mass=function("mass_per_length", 1.0),
        stiffness=pair("bending_stiffness", 1.0),
        twist=function("twist", 0.0),
        flexibility=(lambda x: 1 / stiff(x), lambda x: 1 / soft(x)),
        rotary=pair("rotary_inertia", 0.0),
        hub=_hub(case["radius"], case["setting_angle_deg"]),
        bending_angle=math.radians(case["bending_angle_deg"]),
        springs=tuple(case.get("root_stiffness", (math.inf, math.inf))),
        body=body_of(case.get("tip", {"mass": 0.0})),
        planes=case["planes"],
        breakpoints=stops,
    )


def body_of(tip: Case) -> Body:
    inertia = tip.get("inertia", 0.0)
    lateral = tip.get("transverse_inertia", inertia)
    return Body(tip["mass"], tip.get("offset", 0.0), inertia, lateral, tip.get("axial_inertia", 0.0))


def _hub(radius: float, setting: float) -> float:
    """Compute the hub radius -r cos(phi) from radius r and setting angle phi; 0 at a quarter turn."""
    return 0.0 if setting % 180 == 90 else -radius * math.cos(math.radians(setting))


def piecewise(coefficients: Sequence[Any], stops: Sequence[float] = ()) -> Function:
    """Return a polynomial in x/L, or a piecewise one with given polynomials between stops."""
    if not isinstance(coefficients[0], Sequence):
        return Polynomial(coefficients)
    pieces = [Polynomial(c) for c in coefficients]

    def value(x: np.ndarray) -> np.ndarray:
        place = np.searchsorted(stops, x, side="right")
        return np.choose(place, [p(x) for p in pieces])

    return value


def solved(case: Case) -> tuple[Case, float]:
    """Return the case with frequencies, and the change of their squares on a mesh of half the pieces."""
    squares, change = converged(blade_of(case), case["gamma"], MODES)
    return case | {"frequency": [f"{value:#.12g}" for value in np.sqrt(squares)]}, change


def main() -> None:
    done, changes = zip(*map(solved, cases()), strict=True)
    header = HEADER.format(change=max(changes)).rstrip()
    TARGET.write_text("\n\n".join([header, *map(table, done)]) + "\n", encoding="utf-8")
