"""Loads along the span: in equilibrium, in transients (with load cycles), in steady and random response."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from cyclopts import Parameter

import beamdyn as bd
from beamdyn.analyses import options
from beamdyn.analyses.about_linear_models import NO_RANDOM_INPUT, RandomInput
from beamdyn.analyses.analysis import DRAWN, WRITTEN, Answer, AsText, analysis
from beamdyn.analyses.results import of_loads
from beamdyn.analyses.values import parse_quantity, parse_speeds, parse_window
from beamdyn.common.edge.command_options import write_table
from beamdyn.common.inputs import checks
from beamdyn.common.results.files import write_text
from beamdyn.common.words import at_any
from beamdyn.loads.span_loads import AskedLoads

if TYPE_CHECKING:
    from rich.console import RenderableType

    from beamdyn.loads.transient_loads import EquivalentRange


# Load cycles -----------------------------------------------------------------------------------------


_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)


@Parameter(name="*")
@dataclass(frozen=True)
class CycleOptions:
    """Options on the counting of load cycles in a transient, and on equivalent cycles.

    Parameters
    ----------
    cycles : str, optional
        In a transient: also count the cycles of this quantity, where it is largest (rainflow counting, ASTM
        E1049; needs the extra fatigue).
    woehler : str, optional
        Exponents m of the Woehler (S-N) curve, e.g. "3, 5, 10"; with --cycles. For each the result states the
        range of cycles of equal size that do the same damage as the counted ones, by Miner's rule.
    equivalent_cycles : float, optional
        Number of these cycles of equal size; default: 1.
    cycles_file : Path, optional
        Write range, mean and count of each cycle into this file: .csv, .tsv, .txt or .json.
    """

    cycles: options.LoadQuantity | None = None
    woehler: options.Text | None = None
    equivalent_cycles: float | None = None
    cycles_file: Annotated[Path | None, WRITTEN] = None

    def check(self, in_transient: bool) -> None:
        """Raise an error for options that would have no effect, or whose values are not valid.

        All of these options affect transients only.
        """
        if self.cycles is not None and not in_transient:
            raise ValueError("--cycles belongs to a transient: give --t-end, too")
        text = "" if self.woehler is None else f'"{self.woehler}"'
        for name, value in (("woehler", text), ("cycles-file", self.cycles_file)):
            if value and self.cycles is None:
                raise ValueError(f"--{name} = {value}: it needs counted cycles; give --cycles, too")
        if self.equivalent_cycles is not None and not text:
            number = f"{self.equivalent_cycles:g}"
            raise ValueError(f"--equivalent-cycles = {number}: give --woehler, too, or leave it out")
        for exponent in self.exponents:
            checks.positive("exponent", exponent)
        checks.positive("equivalent_cycles", self.number)

    @property
    def exponents(self) -> list[float]:
        """Read the exponents of the Woehler (S-N) curve; empty if they are not given."""
        if self.woehler is None:
            return []
        parts = [part.strip() for part in self.woehler.split(",")]
        if not all(map(_NUMBER.fullmatch, parts)):
            words = f'--woehler = "{self.woehler}"'
            raise ValueError(f'{words}: give numbers, such as "3, 5, 10"')
        return [float(part) for part in parts]

    @property
    def number(self) -> float:
        """Return the number of equal cycles that cause the same damage as the counted cycles."""
        return 1.0 if self.equivalent_cycles is None else self.equivalent_cycles

    def tables(self, cycles: bd.LoadCycles, equivalents: Sequence[EquivalentRange]) -> list[RenderableType]:
        """Make the tables of the counted cycles, and of equal cycles that cause the same damage."""
        made: list[RenderableType] = [of_loads.cycles_table(cycles)]
        return [*made, of_loads.equivalents_table(equivalents)] if equivalents else made

    def write(self, cycles: bd.LoadCycles) -> None:
        """Write the counted cycles to the requested file, if any."""
        if self.cycles_file is None:
            return
        if self.cycles_file.suffix.lower() == ".json":
            write_text(self.cycles_file, cycles.to_json())
        else:
            write_table(self.cycles_file, of_loads.cycles_csv(cycles))


NOT_COUNTED = CycleOptions()


# Analyses --------------------------------------------------------------------------------------------


LoadSpeeds = Annotated[
    Any, AsText(lambda _, text, scene: parse_speeds(text, scene), absent=options.none_given)
]
End = Annotated[float | None, options.positive("s", absent=options.none_given)]
Angle = Annotated[
    float | None,
    AsText(lambda option, text, _: parse_quantity(option, text, "rad"), absent=options.none_given),
]
Drawn = Annotated[options.LoadQuantity | None, DRAWN]
Duration = Annotated[float, options.positive("s", default="1 h")]


@analysis(
    'beamdyn loads examples/tyre_harvester.toml --speed "50 rad/s"',
    'beamdyn loads examples/rolling_harvester.toml --t-end "12 s" --modes 3',
    screen="Loads",
    about_scene="The scene; its motion is used in a transient and in steady response.",
    moving=lambda options: options["t_end"] is not None,
)
def loads(
    scene: bd.Scene,
    *,
    speed: options.Speed,
    t_end: End,
    speeds: LoadSpeeds,
    at: options.Stations,
    points: options.SectionPoints,
    youngs_modulus: options.YoungsModulus,
    angle: Angle,
    window: options.Text | None = None,
    counting: CycleOptions = NOT_COUNTED,
    quantity: Drawn = None,
    modes: options.CountOrAuto | None = None,
    tolerance: float | None = None,
    discretization: options.Discretization = "ritz",
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
        What --plot and --report draw along the span; default: moment, or strain where nothing bends
        the beam.
    modes
        Number of modes of a transient or steady response, as for simulate and steady; default: auto.
    tolerance
        Tolerance of a transient or steady response, as for simulate and steady; default: 1e-5.
    """
    kinds = {"--speed": speed, "--t-end": t_end, "--speeds": speeds}
    _check_together([name for name, given in kinds.items() if given is not None], angle, window)
    counting.check(in_transient=t_end is not None)
    chosen = {name: each for name, each in (("modes", modes), ("tolerance", tolerance)) if each is not None}
    for name, value in chosen.items() if t_end is None and speeds is None else ():
        remedy = "give --t-end or --speeds, too, or leave it out"
        raise ValueError(f"--{name} = {value}: the equilibrium does not depend on it; {remedy}")
    where = {"at": at, "points": points, "youngs_modulus": youngs_modulus}
    basis: dict[str, Any] = {"discretization": discretization, "modes": "auto", "tolerance": 1e-5} | chosen
    span = None if window is None else parse_window(window, t_end)
    tables = None
    if t_end is not None or speeds is not None:
        AskedLoads.of(scene, **where)  # refuses what the loads cannot have before the long computation
    if t_end is not None:
        result, tables = _in_transient(scene, t_end, span, counting, where, basis)
    elif speeds is not None:
        result = bd.steady_loads(bd.steady_response(scene, speeds, **basis), **where)
    else:
        at_speed = scene.final_speed if speed is None else speed
        result = bd.static_loads(scene, at_speed, angle=angle or 0.0, discretization=discretization, **where)
    ends = {} if span is None else dict(zip(("start", "end"), span, strict=True))
    draw = partial(result.plot, quantity=quantity or result.drawn_quantity, **ends)
    known = np.isfinite(result.moment).any()
    none = "" if known else f"there is no steady response {at_any(len(result.cases), 'speed')}"
    return Answer(result, none, None, tables, draw)


@analysis(
    'beamdyn random-loads examples/rough_road.toml --road C --at "0, 10 mm"',
    about_scene="The scene, with damping; for --road, with a rolling wheel.",
)
def random_loads(
    scene: bd.Scene,
    *,
    random_input: RandomInput = NO_RANDOM_INPUT,
    duration: Duration,
    at: options.Stations,
    points: options.SectionPoints,
    youngs_modulus: options.YoungsModulus,
    quantity: Drawn = None,
    modes: options.CountOrAuto = "auto",
    discretization: options.Discretization = "ritz",
) -> Answer:
    """Largest expected strains, stresses, moments and forces along the span for a random input.

    Parameters
    ----------
    duration
        Duration for which the largest values are expected, with its unit.
    quantity
        What --plot and --report draw along the span; default: strain, or moment where it is not known.
    modes
        Number of modes; auto: the fewest that keep the error below 1e-4 of the largest value along the span.
    """
    asked = random_input
    shown, speed = asked.shown(scene), asked.speed_of(scene)
    given, basis = (asked.density, asked.drive), {"modes": modes, "discretization": discretization}
    result = bd.random_loads(shown, speed, *given, duration, at, points, youngs_modulus, **basis)
    return Answer(result, draw=partial(result.plot, quantity=quantity))


def _check_together(kinds: list[str], angle: float | None, window: str | None) -> None:
    """Raise an error for options of different analyses.

    `kinds` are those of --speed, --t-end and --speeds that are given: each chooses an analysis.
    """
    if len(kinds) > 1:
        raise ValueError(
            f"{' and '.join(kinds)}: give one of them: --speed for the equilibrium, --t-end for a transient, "
            "--speeds for steady response"
        )
    if window is not None and "--t-end" not in kinds:
        raise ValueError("--window belongs to a transient: give --t-end, too")
    if angle is not None and kinds and kinds != ["--speed"]:
        raise ValueError("--angle belongs to the equilibrium at a --speed; otherwise leave it out")


def _in_transient(
    scene: bd.Scene,
    end: float,
    span: tuple[float, float] | None,
    counting: CycleOptions,
    where: dict[str, Any],
    basis: dict[str, Any],
) -> tuple[bd.SpanLoads, list[RenderableType]]:
    if counting.cycles is not None and find_spec("rainflow") is None:
        raise ValueError("--cycles needs rainflow: pip install 'beamdyn[fatigue]'")
    result = bd.transient_loads(bd.simulate(scene, end, **basis), **where)
    tables: list[RenderableType] = [of_loads.transient_loads_table(result, span)]
    if counting.cycles is None:
        return result, tables
    ends = (None, None) if span is None else span
    place = result.largest(counting.cycles, None, *ends)
    cycles = bd.count_cycles(result, counting.cycles, result.station_of(place), place.component, *ends)
    counting.write(cycles)
    equivalents = cycles.equivalents(counting.exponents, counting.number)
    result = result.with_equivalent_ranges(equivalents)
    return result, tables + counting.tables(cycles, equivalents)
