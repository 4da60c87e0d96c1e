"""Loads along the span: in equilibrium, in a transient, in steady response, under a random input."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Annotated, Any

import beamdyn as bd
from beamdyn.analyses.analysis import DRAWN, Answer, AsText, analysis
from beamdyn.analyses.cycles import NOT_COUNTED, CycleOptions
from beamdyn.analyses.excitations import NO_RANDOM_INPUT, RandomInput
from beamdyn.analyses.options import (
    CountOrAuto,
    Discretization,
    LoadQuantity,
    SectionPoints,
    Speed,
    Stations,
    Text,
    none_given,
    positive,
)
from beamdyn.analyses.values import (
    final_speed,
    parse_quantity,
    parse_speeds,
    parse_window,
)

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.loads.span_loads import SpanLoads
    from beamdyn.scene.scene import Scene

LoadSpeeds = Annotated[Any, AsText(lambda _, text, scene: parse_speeds(text, scene), absent=none_given)]
End = Annotated[float | None, positive("s", absent=none_given, field="t_end")]
Angle = Annotated[
    float | None, AsText(lambda option, text, _: parse_quantity(option, text, "rad"), absent=none_given)
]
Drawn = Annotated[LoadQuantity | None, DRAWN]
Duration = Annotated[float, positive("s", default="1 h")]


@analysis(
    'beamdyn loads examples/tyre_harvester.toml --speed "50 rad/s"',
    'beamdyn loads examples/rolling_harvester.toml --t-end "12 s" --modes 3',
    about_scene="The scene; a transient and steady response take its motion.",
    moving=lambda options: options["t_end"] is not None,
)
def loads(
    scene: Scene,
    *,
    speed: Speed,
    t_end: End,
    speeds: LoadSpeeds,
    at: Stations,
    points: SectionPoints,
    angle: Angle,
    window: Text | None = None,
    counting: CycleOptions = NOT_COUNTED,
    quantity: Drawn = None,
    modes: CountOrAuto | None = None,
    tolerance: float | None = None,
    discretization: Discretization = "ritz",
) -> Answer:
    """Forces, bending moments, strains and stresses along the span, from loads and inertia.

    In equilibrium at a speed, with --t-end in a transient, with --speeds in steady response over speed.

    Parameters
    ----------
    speed
        Speed of the equilibrium with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final
        speed of the scene's motion, or 0 without one.
    t_end
        In a transient: end of the run with its unit, e.g. "30 s".
    speeds
        In steady response: start:stop:count, e.g. "1:150:100 rad/s", or a list, e.g. "50, 55
        rad/s".
    angle
        In equilibrium: angle of rotation at which gravity acts, with its unit, e.g. "90 deg";
        default 0.
    window
        In a transient: the largest loads within this time window: start:end, e.g. "20:30 s".
    quantity
        What --plot and --report draw along the span; default: moment.
    modes
        Of a transient and steady response, as for simulate and steady; default: auto.
    tolerance
        The same; default: 1e-5.
    """
    kinds = {"--speed": speed, "--t-end": t_end, "--speeds": speeds}
    _check_together([name for name, given in kinds.items() if given is not None], angle, window)
    counting.check(in_transient=t_end is not None)
    _check_moving(t_end is not None or speeds is not None, modes=modes, tolerance=tolerance)
    where = {"at": at, "points": points}
    basis: dict[str, Any] = {"discretization": discretization, "modes": "auto", "tolerance": 1e-5}
    basis |= {
        name: value for name, value in (("modes", modes), ("tolerance", tolerance)) if value is not None
    }
    span = None if window is None else parse_window(window, t_end)
    tables = None
    if t_end is not None:
        result, tables = _in_transient(scene, t_end, span, counting, where, basis)
    elif speeds is not None:
        result = bd.steady_loads(bd.steady_response(scene, speeds, **basis), **where)
    else:
        at_speed = final_speed(scene) if speed is None else speed
        result = bd.static_loads(scene, at_speed, angle=angle or 0.0, discretization=discretization, **where)
    ends = {} if span is None else dict(zip(("start", "end"), span, strict=True))
    draw = partial(result.plot, quantity=quantity or "moment", **ends)
    return Answer(result, _refusal(result), None, tables, draw)


@analysis(
    'beamdyn random-loads examples/rough_road.toml --road C --at "0, 10 mm"',
    about_scene="The scene, damped; with a rolling wheel for a road.",
)
def random_loads(
    scene: Scene,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    duration: Duration,
    at: Stations,
    points: SectionPoints,
    quantity: Drawn = None,
    modes: CountOrAuto = "auto",
    discretization: Discretization = "ritz",
) -> Answer:
    """Largest strains, stresses, moments and forces along the span that a random input makes expected.

    Parameters
    ----------
    duration
        Duration within which the largest are expected, with its unit.
    quantity
        What --plot and --report draw along the span; default: strain.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-4 of the largest along the
        span.
    """
    asked = random_input
    shown, speed = asked.shown(scene), asked.speed_of(scene)
    result = bd.random_loads(
        shown,
        speed,
        asked.density,
        asked.drive,
        duration,
        at,
        points,
        modes=modes,
        discretization=discretization,
    )
    return Answer(result, draw=partial(result.plot, quantity=quantity or "strain"))


def _check_moving(moving: bool, **given: object) -> None:
    """Refuse options of a transient and of steady response in equilibrium."""
    for name, value in given.items():
        if value is not None and not moving:
            remedy = "give --t-end or --speeds, too, or leave it out"
            raise ValueError(f"--{name} = {value}: the equilibrium does not depend on it; {remedy}")


def _check_together(kinds: list[str], angle: float | None, window: str | None) -> None:
    """Refuse options that belong to different analyses; `kinds` are those given that choose one."""
    if len(kinds) > 1:
        raise ValueError(
            f"{' and '.join(kinds)}: give one of them: --speed for the equilibrium, --t-end for a transient, "
            "--speeds for steady response"
        )
    if window is not None and "--t-end" not in kinds:
        raise ValueError("--window belongs to a transient: give --t-end, too")
    if angle is not None and kinds and kinds != ["--speed"]:
        raise ValueError("--angle belongs to the equilibrium at a --speed: elsewhere the beam turns")


def _in_transient(
    scene: Scene,
    end: float,
    span: tuple[float, float] | None,
    counting: CycleOptions,
    where: dict[str, Any],
    basis: dict[str, Any],
) -> tuple[SpanLoads, list[RenderableType]]:
    from beamdyn.results.of_loads import transient_loads_table

    if counting.cycles is not None and find_spec("rainflow") is None:
        raise ValueError("--cycles needs rainflow: pip install 'beamdyn[fatigue]'")
    result = bd.transient_loads(bd.simulate(scene, end, **basis), **where)
    tables: list[RenderableType] = [transient_loads_table(result, span)]
    if counting.cycles is None:
        return result, tables
    ends = (None, None) if span is None else span
    place = result.largest(counting.cycles, None, *ends)
    cycles = bd.count_cycles(result, counting.cycles, result.station_of(place), place.component, *ends)
    counting.write(cycles)
    equivalents = cycles.equivalents(counting.exponents, counting.number, place.error)
    result = replace(result, equivalent_ranges=equivalents)
    return result, tables + counting.tables(cycles, equivalents)


def _refusal(result: SpanLoads) -> str:
    """Why there are no loads at any speed; empty where there are."""
    import numpy as np

    if np.isfinite(result.moment).any():
        return ""
    return f"at none of {len(result.cases)} speeds is there a steady response"
