"""Analyses of the scene itself: its drawing, the terms of its equations, and accuracy over computing time."""

from __future__ import annotations

from typing import Annotated

import beamdyn as bd
from beamdyn.analyses.analysis import analysis
from beamdyn.analyses.options import Count, Text, none_given, positive
from beamdyn.analyses.values import parse_speed
from beamdyn.common.edge.command_options import NO_ANSWER_FILES, AnswerFiles
from beamdyn.common.edge.console import at_work

MeasuredEnd = Annotated[float | None, positive("s", absent=none_given)]
Budget = Annotated[float, positive("s", default="60 s")]


@analysis("beamdyn draw examples/tyre_harvester.toml --plot rotor.svg", physics=None)
def draw(scene: bd.Scene) -> bd.RotorDrawing:
    """Draw the rotor: axis of rotation, radius, and the beam at its angles, undeformed."""
    return bd.draw(scene)


@analysis("beamdyn terms examples/rolling_harvester.toml")
def terms(scene: bd.Scene, *, outputs: AnswerFiles = NO_ANSWER_FILES) -> bd.Terms:
    """Terms of the equations of motion: which of them the scene has, and why."""
    return bd.terms(scene)


@analysis(
    'beamdyn tradeoff examples/tyre_harvester.toml --budget "10 s" --plot t.png',
    about_scene="The scene; with a motion, transients and the steady response are timed, too.",
    physics=None,
)
def tradeoff(
    scene: bd.Scene, *, speed: Text | None = None, modes: Count = 3, t_end: MeasuredEnd, budget: Budget
) -> bd.Tradeoff:
    """Error against computing time of bases, elements, physics, integrators, numbers of modes and harmonics.

    Parameters
    ----------
    speed
        Speed with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the scene's
        motion, or 0 without one.
    modes
        Number of modes, from the lowest; at most 20.
    t_end
        End of the transients with its unit, e.g. "2 s"; default: a hundred periods of the first
        mode, counted from the end of the spin-up, or from rest if the spin-up takes more than 900 periods.
    budget
        Approximate computing time, e.g. "60 s"; measurements that do not fit are left out and
        listed.
    """
    at = None if speed is None else parse_speed("--speed", speed, scene)
    with at_work("measuring") as progress:
        return bd.tradeoff(scene, at, modes, t_end, budget, progress)
