"""Warnings about results: limits of validity of the theory, and input that the model does not use."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from beamdyn.common.inputs.checks import MOST, InvalidValue, refuse
from beamdyn.common.results.statements import (
    EXCITATION,
    INPUT,
    LIMITS,
    MODEL_ERROR,
    OUTSIDE,
    Speeds,
    Statement,
    joined,
)
from beamdyn.common.words import Setting, Words, percent, told_from
from beamdyn.scene.physics import how_without_large_deflection, needing_large_deflection
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

LARGE_DEFLECTION = 0.1  # deflection divided by length, past which linear theory has errors of several percent
LARGE_STRAIN = 0.01  # static axial strain beyond which the neglected stretch matters
# Acceleration of gravity [m/s2]: a wheel that a road accelerates by more loses contact.
STANDARD_GRAVITY = 9.81
_NARROW = 5.0  # ratio of width to thickness below which a section does not behave as a plate
_WORTH_OF_NARROW = 0.01  # largest relative frequency difference from narrow solid bodies: benchmarks.solids
# Relative error of frequencies per change of the width's slope (0.037 at most, in 36 tapered strips
# compared with strips with a rounded kink, in bending), and the error from which a warning is given.
_WORTH_OF_KINKS, _SMALL_WORTH = 0.04, 1e-3
# Relative distance of a width from a bound, up to which the width counts as at the bound.
_ROUNDING_OF_SIDES = 1e-9
_MOST_RANGES = 4  # largest number of ranges of speeds in a sentence
FASTEST = MOST  # largest accepted speed [rad/s]: its fourth power is far from overflow


def check_speeds(speeds: np.ndarray | float, name: str = "speeds") -> None:
    """Refuse speeds [rad/s], the argument `name`, whose powers would overflow (an `InvalidValue`)."""
    bound = "give at most {limit} either way"
    refuse(np.abs(speeds) > FASTEST, name, speeds, "rad/s", bound, limit=FASTEST)


def refuse_large_deflection(scene: Scene, bound: str, *instead: str) -> None:
    """Refuse large deflection in an analysis of the straight beam; `instead` ends the remedy.

    A beam that needs it is refused with physics "auto", too, before that is chosen.
    """
    if scene.physics.large_deflection or (scene.chooses_physics and needing_large_deflection(scene.beam)):
        chosen = scene.chooses_physics or scene.physics_choice is not None
        remedy = Words(how_without_large_deflection(scene.beam, chosen), *instead)
        raise InvalidValue("physics.large_deflection", True, bound, remedy)


def refuse_bending_in_space(scene: Scene) -> None:
    """Refuse large deflection in space in analyses that model it in one plane only (an `InvalidValue`)."""
    if scene.bends_in_space:
        bound = "this analysis models large deflection in one plane: in the plane of rotation or out of it"
        remedy = "leave large_deflection out where the deflection is small, or model one such plane"
        raise InvalidValue("physics.large_deflection", True, bound, remedy)


def refuse_tip_load(scene: Scene) -> None:
    """Refuse a load at the tip in an analysis that models rotation alone (an `InvalidValue`)."""
    if scene.tip_load.acts:
        bound = "this analysis models only loads by the motion of the carrier"
        remedy = "equilibria, modes, loci and transients model a load at the tip"
        raise InvalidValue("tip_load.force", scene.tip_load.force, bound, remedy)


def refuse_vanishing_frequency(scene: Scene) -> None:
    """Refuse a load at the tip that lowers a frequency at rest to 0 within rounding (`InvalidValue`)."""
    load = scene.tip_load
    name, unit = ("force", "N") if any(load.force) else ("moment", "N m")
    bound = "within rounding the lowest frequency under it is 0, beside which the others are lost"
    remedy = (
        "give a smaller load" if load.follows else "give one that differs from it by a part in 1e9 or more"
    )
    raise InvalidValue(f"tip_load.{name}", getattr(load, name), bound, remedy, unit)


def warn_of_left_out(scene: Scene) -> Iterator[Statement]:
    """Yield warnings of unused input, narrow sections, kinks of the width, and errors of physics "auto"."""
    if scene.models_width and (section := scene.beam.strip) is not None:
        yield from _warn_of_narrow_section(section)
    if scene.physics.camber and (section := scene.beam.strip) is not None:
        yield from _warn_of_kinks(section, scene.beam.length)
    if scene.physics_choice is not None:
        yield from scene.physics_choice.warnings()
        return
    if scene.physics.branch != "straight" and not scene.physics.large_deflection:
        branch = scene.physics.branch
        remedy = Words(Setting("physics", large_deflection=True, branch=branch), " bends it")
        said = f"physics.branch is {branch}, but physics.large_deflection is off: the beam is straight; "
        yield Statement(said, remedy, kind=INPUT, quantity="physics.branch", remedy=remedy)
    given = {
        "twist": scene.beam.is_twisted,
        "second_root_stiffness": scene.mount.second_root_stiffness != math.inf,
    }
    for name, is_given in given.items():
        if is_given and scene.physics.planes == 1:
            remedy = Words(Setting("physics", planes=2), " models it")
            said = f"{name} is given, but physics.planes is 1: it is left out; "
            yield Statement(said, remedy, kind=INPUT, quantity=name, remedy=remedy)


def _warn_of_narrow_section(section: Rectangle) -> Iterator[Statement]:
    """Yield a warning if a section whose width is modelled is too narrow for a plate."""
    width, thickness = section.sides()
    narrowest = float((width / thickness).min())
    if narrowest < _NARROW * (1 - _ROUNDING_OF_SIDES):
        ratio = told_from(narrowest, _NARROW)
        said = f"width/thickness is {ratio}: below {_NARROW:g} a section is no plate, and corrections for "
        worth = (
            f"camber and torsion are fitted to frequencies of solid elements, and differ from these by up to "
            f"{percent(_WORTH_OF_NARROW)} (docs/solids.md)"
        )
        quantity = "width over thickness"
        yield Statement(said, worth, kind=MODEL_ERROR, quantity=quantity, value=narrowest, limit=_NARROW)


def _warn_of_kinks(section: Rectangle, length: float) -> Iterator[Statement]:
    """Yield a warning if camber is modelled and the width has kinks, which trial functions cannot follow."""
    sharpest = float(section.kinks_of_width(length).max(initial=0.0))
    if (worth := _WORTH_OF_KINKS * sharpest) > _SMALL_WORTH:
        said = f"the slope of the width changes by {sharpest:.2g} at a kink, where functions of camber are "
        end = f"smooth: frequencies are up to {percent(worth)} too high; round the kink to compare"
        yield Statement(said, end, kind=LIMITS, quantity="change of the slope of the width", value=sharpest)


def warn_of_strain(strain: float) -> Iterator[Statement]:
    """Yield a warning if the static axial strain is not small."""
    if strain > LARGE_STRAIN:
        said = f"static axial strain reaches {strain:.2g}: above 1 % stretch is not negligible"
        yield Statement(said, kind=LIMITS, quantity="static axial strain", value=strain, limit=LARGE_STRAIN)


def warn_of_elastic_limit(
    strain: np.ndarray, say_when: Callable[[int], Words | str] | None = None
) -> Iterator[Statement]:
    """Yield a warning if strains (nan if unknown) exceed the range of linear elasticity.

    `say_when` describes the time or speed of an index of the first axis in words.
    """
    known = np.where(np.isfinite(strain), np.abs(strain), 0.0)
    if (largest := float(known.max(initial=0.0))) > LARGE_STRAIN:
        when = (
            () if say_when is None else (say_when(int(known.argmax() // math.prod(known.shape[1:]))), " the ")
        )
        said = f"strain reaches {largest:.2g}: past {LARGE_STRAIN:g} few materials are linearly elastic"
        yield Statement(*when, said, kind=LIMITS, quantity="strain", value=largest, limit=LARGE_STRAIN)


def warn_of_static_deflection(
    deflection: np.ndarray, length: float, speeds: np.ndarray
) -> Iterator[Statement]:
    """Yield a warning if the static tip deflection [m] at speeds [rad/s] is too large for linear theory."""
    bent = np.abs(deflection) > LARGE_DEFLECTION * length
    if bent.any():
        first, worst = np.abs(speeds[bent]).argmin(), np.abs(deflection[bent]).argmax()
        ratio, at = abs(deflection[bent][worst]) / length, Speeds(speeds[bent][worst])
        most = _say_lengths(ratio)
        on = f" on the rotation bends the tip by up to {most}, at "
        begin = "from ", Speeds(speeds[bent][first]), on, at
        said = begin if bent.sum() > 1 else ("at ", at, f" the rotation bends the tip by {most}")
        end = f": past {LARGE_DEFLECTION:g} of the length the answer is {OUTSIDE}"
        yield _bent_too_far(ratio, *said, end)


def _bent_too_far(ratio: float, *words: str) -> Statement:
    quantity = "tip deflection over the length"
    return Statement(*words, kind=OUTSIDE, quantity=quantity, value=ratio, limit=LARGE_DEFLECTION)


def warn_of_deflection(
    deflection: np.ndarray, length: float, speeds: np.ndarray | None = None
) -> Iterator[Statement]:
    """Yield a warning if the tip deflection [m], at any speed if given, is too large for linear theory."""
    large = deflection > LARGE_DEFLECTION * length
    if large.any():
        ratio, at = deflection[large].max() / length, _at_speeds(speeds, large)
        end = f": past {LARGE_DEFLECTION:g} of the length the answer is {OUTSIDE}"
        yield _bent_too_far(ratio, f"the tip moves by {_say_lengths(ratio)}", at, end)


def _say_lengths(ratio: float) -> str:
    """Format the ratio of a deflection to the length: "0.12 of the length", "79 lengths"."""
    return f"{ratio:.2g} of the length" if ratio < 1 else f"{ratio:.{1 if ratio < 10 else 0}f} lengths"


def warn_of_road(acceleration: np.ndarray, speeds: np.ndarray | None = None) -> Iterator[Statement]:
    """Yield a warning if the road accelerates the wheel [m/s2] by more than gravity."""
    excessive = acceleration > STANDARD_GRAVITY
    if excessive.any():
        largest = acceleration.max()
        yield Statement(
            f"the road accelerates the wheel by {largest:.4g} m/s2, more than gravity",
            _at_speeds(speeds, excessive),
            ": the wheel leaves the road; was a velocity amplitude given as a height?",
            kind=EXCITATION,
            quantity="acceleration of the wheel [m/s2]",
            value=largest,
            limit=STANDARD_GRAVITY,
        )


def _at_speeds(speeds: np.ndarray | None, selected: np.ndarray) -> str:
    """Format " at ..." for the selected speeds; empty if no speeds are given."""
    return "" if speeds is None else Words(" at ", list_speeds(speeds, selected))


def list_speeds(speeds: np.ndarray, selected: np.ndarray) -> Words:
    """Format the selected speeds [rad/s], at least one: "20 to 35 rad/s and 50 rad/s".

    Selected speeds that are neighbours in ascending order form a range.  If there are many ranges, the first
    ones are named, then the number of the others and the last speed.
    """
    ascending = np.argsort(speeds, kind="stable")
    speeds, selected = speeds[ascending], selected[ascending]
    changes = np.flatnonzero(np.diff(np.concatenate(([False], selected, [False])).astype(int)))
    ranges: list[Words] = [
        Speeds(speeds[first], speeds[after - 1]) for first, after in changes.reshape(-1, 2)
    ]
    if len(ranges) > _MOST_RANGES:
        more = len(ranges) - _MOST_RANGES + 1
        ranges[_MOST_RANGES - 1 :] = [Words(f"{more} more ranges up to ", Speeds(speeds[selected][-1]))]
    *most, end = ranges
    return Words(joined(", ", most), " and ", end) if most else end
