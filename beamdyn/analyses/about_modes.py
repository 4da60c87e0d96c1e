"""Equilibria, natural frequencies at one speed and over speed, and buckling."""

from __future__ import annotations

from functools import partial
from math import isinf, isnan
from pathlib import Path
from typing import Annotated

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses import options
from beamdyn.analyses.analysis import WRITTEN, Answer, Physics, analysis
from beamdyn.analyses.results.cautions import critical_label, labels_of, warnings_of
from beamdyn.common.edge.command_options import NO_ANSWER_FILES, NO_FILES, AnswerFiles, Outputs
from beamdyn.common.plots.plots import mark_critical
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.statements import GROWING, OUTSIDE, of_kind
from beamdyn.common.words import at_any

# Equilibria ------------------------------------------------------------------------------------------


_BENT = "The scene; large deflection is modelled in any case."


@analysis(
    'beamdyn equilibrium examples/rolling_harvester.toml --speed "50 rad/s"', about_scene=_BENT, physics=None
)
def equilibrium(
    scene: bd.Scene,
    *,
    speed: options.AtSpeed,
    branch: options.Text | None = None,
    discretization: options.Discretization = "ritz",
) -> bd.Equilibrium:
    """Equilibrium of the beam bent by rotation, for deflections of any size, and its stability.

    Parameters
    ----------
    branch
        straight: the equilibrium on the branch that begins at rest; bent: the stable equilibrium that
        exists besides it at high speed. Default: as the scene's physics requires.
    """
    return bd.equilibrium(scene, speed, branch, discretization)


@analysis(
    'beamdyn branches examples/rolling_harvester.toml --top-speed "250 rad/s"',
    about_scene=_BENT,
    physics=None,
)
def branches(
    scene: bd.Scene, *, top_speed: options.PositiveSpeed, discretization: options.Discretization = "ritz"
) -> bd.EquilibriumBranches:
    """Branches of equilibria over speed: where the beam buckles, and where a branch turns back (limit point).

    Parameters
    ----------
    top_speed
        Speed up to which the branches are followed, with its unit, e.g. "250 rad/s".
    """
    return bd.equilibrium_branches(scene, top_speed, discretization)


# Frequencies -----------------------------------------------------------------------------------------


_GROWING = "divergence", "flutter"  # statuses of unstable modes
_PLAIN = "auto: add the effects whose size exceeds the tolerance, except large deflection and stretch."
PlainPhysics = Annotated[Physics, Parameter(help=_PLAIN)]


@analysis('beamdyn modes examples/tyre_harvester.toml --speed "50 rad/s"')
def modes(
    scene: bd.Scene,
    *,
    speed: options.AtSpeed,
    modes: options.ModeCount = 3,
    discretization: options.Discretization = "ritz",
    tolerance: options.FrequencyTolerance = None,
    shapes: Annotated[Path | None, WRITTEN] = None,
    outputs: Outputs = NO_FILES,
) -> Answer:
    """Natural frequencies at one speed, with their errors and stability.

    Parameters
    ----------
    shapes
        Write the mode shapes into this file for ParaView: .vtu or .vtk.
    """
    result = bd.natural_modes(scene, speed, modes, discretization, tolerance)
    if shapes is not None:
        result.export(shapes, force=outputs.force, labels=labels_of(result))
    return Answer(result, _unstable(result), warnings_of(result, tolerance, without=GROWING))


@analysis('beamdyn locus examples/tyre_harvester.toml --speeds "0:150:31 rad/s"')
def locus(
    scene: bd.Scene,
    *,
    speeds: options.Speeds,
    modes: options.ModeCount = 3,
    discretization: options.Discretization = "ritz",
    tolerance: options.FrequencyTolerance = None,
) -> Answer:
    """Natural frequencies over speed; each mode is tracked through crossings.

    Parameters
    ----------
    speeds
        Speeds with their unit: start:stop:count, e.g. "0:150:301 rad/s", or a list, e.g. "0, 50,
        100 rad/s".
    """
    result = bd.frequency_locus(scene, speeds, modes, discretization, tolerance)
    unstable = np.isin(result.status, _GROWING).any(axis=1)
    never = f"the beam is not stable {at_any(len(result.speeds), 'speed')}" if unstable.all() else ""
    return Answer(result, never, warnings_of(result, tolerance), draw=partial(_draw_locus, result))


@analysis("beamdyn critical examples/tyre_harvester.toml")
def critical(
    scene: bd.Scene,
    *,
    discretization: options.Discretization = "ritz",
    outputs: AnswerFiles = NO_ANSWER_FILES,
) -> Answer:
    """Critical speed, at which the rotating beam buckles; if none is found, the reason or a lower bound."""
    result = bd.critical_point(scene, discretization)
    # If the error is infinite, a critical speed may exist that was not found or not resolved.
    refusal = "; ".join(result.warnings) if isinf(result.error) else ""
    return Answer(result, refusal, [] if refusal else None)


@analysis(
    'beamdyn limits examples/tyre_harvester.toml --top-speed "400 rad/s"',
    about_scene="The scene; its own setting angle is not used.",
    physics=PlainPhysics,
)
def limits(
    scene: bd.Scene,
    *,
    top_speed: options.PositiveSpeed,
    discretization: options.Discretization = "ritz",
    outputs: AnswerFiles = NO_ANSWER_FILES,
) -> Answer:
    """Setting angles above which the first frequency rises with speed: at low speed, and up to a top speed.

    Parameters
    ----------
    top_speed
        Above the second of these angles, the first frequency rises from rest up to this speed; with its
        unit, e.g. "400 rad/s".
    """
    result = bd.setting_angle_limits(scene, top_speed, discretization).in_units(speed=scene.units.speed)
    if isnan(result.first) or isnan(result.second):
        return Answer(result, result.warnings[0], (), ())
    return Answer(result)


def _draw_locus(result: bd.Locus, ax: Axes) -> None:
    result.plot(ax)
    if not result.scene.may_flutter_by_load:
        critical = bd.critical_point(result.scene)
        mark_critical(ax, critical.speed, critical_label(critical), result.display_units)


def _unstable(result: bd.Modes) -> str:
    """Name the unstable modes, with the critical speed; empty if all modes are stable."""
    unstable = [i for i, status in enumerate(result.status) if status in _GROWING]
    if not unstable:
        return ""
    which = ", ".join(f"mode {i + 1} ({result.status[i]}, {result.growth_rate[i]:.4g} 1/s)" for i in unstable)
    # A follower load may cause flutter, so that no critical speed is known.
    if result.scene.may_flutter_by_load:
        return f"unstable at {result.speed:g} rad/s: {which}"
    critical = bd.critical_point(result.scene)
    said = f"; the critical speed is {critical.speed:.6g} rad/s" if critical.speed <= result.speed else ""
    straight = ", were the beam straight" if of_kind(critical.warnings, OUTSIDE) else ""
    return f"unstable at {result.speed:g} rad/s: {which}{said}{straight}"
