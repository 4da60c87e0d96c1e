"""Report on the eeBrake, a bicycle caliper: published numbers beside those of our reconstruction."""

from __future__ import annotations

from functools import cache

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.published import values_alone
from brakes.calipers import CaliperStroke, EeBrake, stop
from brakes.drawings.caliper import caliper_figure
from brakes.drawings.mechanism import free_body_diagrams
from brakes.published import load

PAPER = load("eebrake")
_ERROR = 5e-10  # relative error of values of the reconstruction, whose dimensions are given to ten digits
_CABLE = 3.5e-3  # cable travel that closes the reconstruction's pads [m]


def sections() -> dict[str, list[Comparison]]:
    """Compare the published numbers with the reconstruction; return the comparisons by title of the table."""
    page, printed = "eeBrake page", values_alone(PAPER)
    statics, travel, given = (printed[name] for name in ("statics", "travel", "stop"))
    (f_t, x_work), (_, x_equal) = tangential_forces("equal work"), tangential_forces("equal force")
    gap = (x_work - f_t) / x_work
    percent = statics["difference_percent"], 100 * gap, 100 * _ERROR, 1, "cut off, not rounded"
    equal = "with equal pad forces X equals f_t; the page's X belongs to another cable tension, 2 delta_R"
    run = _stroke("equal force", _CABLE)
    finger, pad = 1e3 * float(run.finger[-1]), 1e3 * float(run.pad_travel[-1].mean())
    mean = float(run.finger[-1] / run.pad_travel[-1].sum())
    force, error = mean * travel["finger_force"], 1e-8 * mean
    stopped = stop(given["mass"], given["speed"] / 3.6, force, given["friction"])
    by_hand = given["distance"], stopped.distance, 1e-6, 2
    return {
        "eeBrake, open: forces for a force of 1 on the right pad": [
            Comparison("f_t of the strut", page, statics["f_t"], f_t, _ERROR, 3),
            Comparison("X, tension 2 delta_R", page, statics["X"], x_work, _ERROR, 3),
            Comparison("X, equal pad forces", page, statics["X"], x_equal, _ERROR, 3, equal),
            Comparison("difference (X - f_t)/X", page, statics["difference"], gap, _ERROR, 4),
            Comparison("difference (X - f_t)/X [%]", page, *percent),
        ],
        "eeBrake: travel, mechanical advantage, stop": [
            Comparison("travel of finger [mm]", page, 1e3 * travel["finger"], finger, 1e-9, 0),
            Comparison("mean travel of a pad [mm]", page, 1e3 * travel["pad"], pad, 1e-8, 2),
            Comparison("advantage, mean of the stroke", page, travel["advantage"], mean, error, 1),
            Comparison("force of each pad [N]", page, travel["pad_force"], force, 40 * error, 0),
            Comparison("stop of 80 kg from 30 km/h [m]", "by hand", *by_hand),
        ],
    }


def tangential_forces(split: str) -> tuple[float, float]:
    """Compute f_t and X for a right pad force of 1.

    f_t is the force of the strut on the right lever, X the force on the left lever's upper pin.
    """
    design, run = EeBrake(), _stroke(split, 0.0)
    pivot, pin = np.array(design.pivot), np.array(design.upper_pin)
    radial = (pin - pivot) / np.linalg.norm(pin - pivot)
    inboard_right, inboard_left = np.array((-radial[1], radial[0])), np.array((radial[1], radial[0]))
    strut = -run.reactions["strut end"][0]  # force on the right lever
    unit = float(run.pad_force[0, 0])
    return -float(strut @ inboard_right) / unit, float(run.reactions["pin O"][0] @ inboard_left) / unit


@cache
def _stroke(split: str, travel: float) -> CaliperStroke:
    return EeBrake(split=split).build().stroke([0.0, travel])  # pyright: ignore[reportArgumentType]


def notes() -> list[str]:
    """Return the remarks below the tables."""
    advantage = _stroke("equal force", _CABLE).advantage[[0, -1], 0]
    numbers = dict(zip(("open", "closed"), advantage, strict=True))
    ratio = _stroke("equal work", 0.0).force_symmetry[0]
    return [note.format(ratio=ratio, **numbers) for note in PAPER["notes"]]


def _with_curves() -> Figure:
    """Draw the brake open and closed, and its advantage, pad ratio and reactions over the stroke."""
    caliper = EeBrake().build()
    return caliper_figure(caliper, caliper.stroke(_CABLE), caliper.equilibrium(_CABLE))


PICTURES = {
    "eebrake": _with_curves,
    "eebrake_free_bodies": lambda: free_body_diagrams({"": EeBrake().build().equilibrium(_CABLE)}),
}
