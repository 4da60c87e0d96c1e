"""The command on loads along the span: in equilibrium, in a transient, in steady response."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from cyclopts import Parameter

from beamdyn.cli.cycles import NOT_COUNTED, CycleOptions, LoadQuantity
from beamdyn.cli.program import app, deliver
from beamdyn.cli.values import (
    BasisSize,
    Discretization,
    PhysicsOption,
    SceneFile,
    Text,
    load_moving,
    load_with,
    naming_option,
    parse_points,
    parse_positions,
    parse_positive,
    parse_quantity,
    parse_speeds,
    parse_window,
    speed_or_final,
)
from beamdyn.common.edge.outputs import NO_FILES, Outputs, on_axes
from beamdyn.common.edge.program import examples

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.loads.span_loads import SpanLoads
    from beamdyn.scene.scene import Scene


@Parameter(name="*")
@dataclass(frozen=True)
class SpanPlaces:
    """Where loads are wanted: stations along the span, and points of their sections.

    Parameters
    ----------
    at : str, optional
        Stations with their unit, e.g. "0, 10, 25 mm"; default: 21 along the beam, and both sides of jumps.
    points : str, optional
        Points of the section with their unit, e.g. "-0.1:0, 0.1:2 mm": along its first direction, in which
        the beam bends, and along the second. Default: the outermost.
    """

    at: Text | None = None
    points: Text | None = None

    @property
    def options(self) -> dict[str, object]:
        """The options, for the head of a report; None where one is not given."""
        return dict(vars(self))

    @property
    def where(self) -> dict[str, Any]:
        """The arguments of the core."""
        return {
            "at": None if self.at is None else parse_positions(self.at),
            "points": None if self.points is None else parse_points(self.points),
        }

    @contextmanager
    def named(self) -> Iterator[None]:
        """Within it, a refusal of a place names its option and shows it as given."""
        at, points = self.at or "", self.points or ""
        with naming_option("at", "--at", at), naming_option("points", "--points", points):
            yield


EVERYWHERE = SpanPlaces()


@app.command(
    help_epilogue=examples(
        'beamdyn loads examples/tyre_harvester.toml --speed "50 rad/s"',
        'beamdyn loads examples/rolling_harvester.toml --t-end "12 s" --modes 3',
    )
)
def loads(
    scene: SceneFile,
    /,
    *,
    speed: Text | None = None,
    t_end: Text | None = None,
    speeds: Text | None = None,
    places: SpanPlaces = EVERYWHERE,
    angle: Text | None = None,
    window: Text | None = None,
    counting: CycleOptions = NOT_COUNTED,
    quantity: LoadQuantity | None = None,
    modes: BasisSize | None = None,
    tolerance: float | None = None,
    discretization: Discretization = "ritz",
    physics: PhysicsOption = None,
    outputs: Outputs = NO_FILES,
) -> None:
    """Forces, bending moments, strains and stresses along the span, from loads and inertia.

    In equilibrium at a speed, with --t-end in a transient, with --speeds in steady response over speed.

    Parameters
    ----------
    scene
        The scene; a transient and steady response take its motion.
    speed
        Speed of the equilibrium with its unit, e.g. "50 rad/s" or "525 rpm"; default: the final speed of the
        scene's motion, or 0 without one.
    t_end
        In a transient: end of the run with its unit, e.g. "30 s".
    speeds
        In steady response: start:stop:count, e.g. "1:150:100 rad/s", or a list, e.g. "50, 55 rad/s".
    places
        Stations, and points of the section.
    angle
        In equilibrium: angle of rotation at which gravity acts, with its unit, e.g. "90 deg"; default 0.
    window
        In a transient: the largest loads within this time window: start:end, e.g. "20:30 s".
    counting
        Cycles of a transient.
    quantity
        What --plot and --report draw along the span; default: moment.
    modes
        Of a transient and steady response, as for simulate and steady; default: auto.
    tolerance
        The same; default: 1e-5.
    discretization
        ritz: assumed modes; fem: finite elements. They are independent, so that each checks the other.
    physics
        auto: add the effects whose size exceeds the tolerance, in place of the physics of the scene.
    outputs
        Output files.
    """
    from beamdyn.common.edge.html_report import Question
    from beamdyn.tables.loads import loads_csv

    outputs.check(scene, **{"cycles-file": counting.cycles_file})
    check_drawn(quantity, outputs)
    _check_together(speed, t_end, speeds, angle, window)
    counting.check(in_transient=t_end is not None)
    _check_moving(t_end is not None or speeds is not None, modes=modes, tolerance=tolerance)
    question = Question.on_file(
        "beamdyn loads", scene, speed=speed, t_end=t_end, speeds=speeds, **places.options,
        angle=angle, window=window, **counting.options, modes=modes, tolerance=tolerance,
        discretization=discretization, physics=physics,
    )  # fmt: skip
    where = places.where
    basis: dict[str, Any] = {"discretization": discretization, "modes": "auto", "tolerance": 1e-5}
    basis |= {
        name: value for name, value in (("modes", modes), ("tolerance", tolerance)) if value is not None
    }
    with places.named():
        if t_end is not None:
            result, tables = _in_transient(load_moving(scene, physics), t_end, window, counting, where, basis)
        elif speeds is not None:
            result, tables = _in_steady_response(load_with(scene, physics, speeds), speeds, where, basis)
        else:
            loaded = load_with(scene, physics, speed)
            result, tables = _in_equilibrium(loaded, speed, angle, where, discretization)
    span = {} if window is None else dict(zip(("start", "end"), parse_window(window), strict=True))
    draw = on_axes(lambda ax: result.plot(ax, quantity or "moment", **span))
    deliver(result, outputs, question, tables, loads_csv(result), draw, _warnings(result), _refusal(result))


def check_drawn(quantity: LoadQuantity | None, outputs: Outputs) -> None:
    """Refuse a quantity to be drawn if there is no picture."""
    if quantity is not None and outputs.plot is None and outputs.report is None:
        remedy = "give --plot or --report, or leave it out"
        raise ValueError(f"--quantity = {quantity}: it is what a picture shows; {remedy}")


def _check_moving(moving: bool, **given: object) -> None:
    """Refuse options of a transient and of steady response in equilibrium."""
    for name, value in given.items():
        if value is not None and not moving:
            remedy = "give --t-end or --speeds, too, or leave it out"
            raise ValueError(f"--{name} = {value}: the equilibrium does not depend on it; {remedy}")


def _check_together(
    speed: str | None,
    t_end: str | None,
    speeds: str | None,
    angle: str | None,
    window: str | None,
) -> None:
    """Refuse options that belong to different analyses."""
    kinds = [name for name, given in (("--speed", speed), ("--t-end", t_end), ("--speeds", speeds)) if given]
    if len(kinds) > 1:
        raise ValueError(
            f"{' and '.join(kinds)}: give one of them: --speed for the equilibrium, --t-end for a transient, "
            "--speeds for steady response"
        )
    if window is not None and t_end is None:
        raise ValueError("--window belongs to a transient: give --t-end, too")
    if angle is not None and (t_end is not None or speeds is not None):
        raise ValueError("--angle belongs to the equilibrium at a --speed: elsewhere the beam turns")


def _in_equilibrium(
    scene: Scene, speed: str | None, angle: str | None, where: dict[str, Any], discretization: Discretization
) -> tuple[SpanLoads, list[RenderableType]]:
    from beamdyn import static_loads
    from beamdyn.tables.loads import static_loads_table

    theta = 0.0 if angle is None else parse_quantity("--angle", angle, "rad")
    given = speed_or_final(scene, speed)
    result = static_loads(scene, given, angle=theta, discretization=discretization, **where)
    return result, [static_loads_table(result)]


def _in_transient(
    scene: Scene,
    t_end: str,
    window: str | None,
    counting: CycleOptions,
    where: dict[str, Any],
    basis: dict[str, Any],
) -> tuple[SpanLoads, list[RenderableType]]:
    from beamdyn import count_cycles, simulate, transient_loads
    from beamdyn.tables.loads import transient_loads_table

    if counting.cycles is not None and find_spec("rainflow") is None:
        raise ValueError("--cycles needs rainflow: pip install 'beamdyn[fatigue]'")
    end = parse_positive("--t-end", t_end, "s")
    span = None if window is None else parse_window(window, end)
    with naming_option("t_end", "--t-end", t_end):
        run = simulate(scene, end, **basis)
    result = transient_loads(run, **where)
    tables: list[RenderableType] = [transient_loads_table(result, span)]
    if counting.cycles is not None:
        ends = (None, None) if span is None else span
        place = result.largest(counting.cycles, None, *ends)
        station = result.station_of(place)
        cycles = count_cycles(result, counting.cycles, station, place.component, *ends)
        counting.write(cycles)
        equivalents = cycles.equivalents(counting.exponents, counting.number, place.error)
        result = replace(result, equivalent_ranges=equivalents)
        tables += counting.tables(cycles, equivalents)
    return result, tables


def _in_steady_response(
    scene: Scene, speeds: str, where: dict[str, Any], basis: dict[str, Any]
) -> tuple[SpanLoads, list[RenderableType]]:
    from beamdyn import steady_loads, steady_response
    from beamdyn.tables.loads import steady_loads_table

    result = steady_loads(steady_response(scene, parse_speeds(speeds, scene), **basis), **where)
    return result, [steady_loads_table(result)]


def _warnings(result: SpanLoads) -> list[str]:
    from beamdyn.cautions import warnings_of

    return warnings_of(result)


def _refusal(result: SpanLoads) -> str:
    """Why there are no loads at any speed; empty where there are."""
    import numpy as np

    if np.isfinite(result.moment).any():
        return ""
    return f"at none of {len(result.cases)} speeds is there a steady response"
