"""Results of bicycle calipers, and the types of brakes `MechanismType` and `CaliperType`."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.edge.config import ConfigError, MissingValue, parse, read
from beamdyn.common.edge.console import table
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.edge.file_words import in_files, say
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import Input, in_range
from beamdyn.common.edge.varied_inputs import numbers
from beamdyn.common.inputs.described import descriptions
from beamdyn.common.results.columns import Column, Columns
from beamdyn.common.results.pictures import Figure
from beamdyn.common.screens.screen_parts import Slider
from beamdyn.common.words import Words
from brakes.answers import planar
from brakes.answers.base import Answer, TableBrakeType
from brakes.answers.doubts import hangs_on_friction
from brakes.answers.mechanism import MechanismAnswer, mechanism_outputs
from brakes.calipers import NAMED, Caliper, CaliperStroke, PadWear, PivotFriction, Stance, StoppingDistance
from brakes.common.limits import passes, verdict
from brakes.config.mechanism import (
    PARTS,
    CaliperInput,
    MechanismInput,
    idle_inputs,
    inputs_of_tables,
    mechanism_from_dict,
    named_text,
)
from brakes.drawings.caliper import (
    caliper_drawing,
    caliper_figure,
    caliper_sketch,
    mechanism_sketch,
    stroke_charts,
    title_of,
)
from brakes.drawings.mechanism import free_body_drawings
from brakes.planar import AssemblyError, Equilibrium, Mechanism, OutOfReachError, solve
from brakes.planar.system import OppositeTravelError, join_names

_STROKE = "Travels [mm], pad force / finger force, velocity of the left pad / velocity of the right pad"
_AT_STOPS = 11  # number of positions of the screen's slider over the stroke
_STROKE_HEADS = (
    *("cable", "finger", "right pad", "left pad"),
    *("right force", "left force", "both", "left/right"),
)
_MM = 1e-3
_OUTPUTS = (
    Output("finger_travel", "travel of the finger", lambda a: a.run.finger[-1], "mm", _MM),
    Output("right_pad_travel", "travel of the right pad", lambda a: a.run.pad_travel[-1, 0], "mm", _MM),
    Output("left_pad_travel", "travel of the left pad", lambda a: a.run.pad_travel[-1, 1], "mm", _MM),
    Output("right_pad_force", "force of the right pad", lambda a: a.run.pad_force[-1, 0], "N"),
    Output("left_pad_force", "force of the left pad", lambda a: a.run.pad_force[-1, 1], "N"),
    Output("right_advantage", "right pad over finger", lambda a: a.run.advantage[-1, 0]),
    Output("left_advantage", "left pad over finger", lambda a: a.run.advantage[-1, 1]),
    Output("total_advantage", "both pads over finger", lambda a: a.run.total_advantage[-1]),
    Output("travel_symmetry", "velocity of the left pad over the right", lambda a: a.run.travel_symmetry[-1]),
    *(
        Output(key, words, lambda a, key=key: getattr(a.friction, key) if a.friction else np.nan, unit)
        for key, words, unit in (
            ("squeeze", "efficiency, squeezing: cable tension without friction / with friction", ""),
            ("release", "releasing: cable tension with friction / without friction", ""),
            ("squeezing_tension", "cable tension with friction, squeezing, for unchanged pad forces", "N"),
            ("releasing_tension", "cable tension with friction, releasing, for unchanged pad forces", "N"),
        )
    ),
    Output("stopping_distance", "stopping distance", lambda a: a.stop.distance if a.stop else np.nan, "m"),
)


@dataclass(frozen=True)
class CaliperAnswer(planar.PlanarAnswer):
    """Results of a caliper over its stroke and at the end of the stroke.

    Friction, wear and a stop are included if the file has them.

    Attributes
    ----------
    caliper : Caliper
        The caliper.
    run : CaliperStroke
        Travels and forces over its stroke.
    friction : PivotFriction, optional
        Efficiency with friction in the pivots, at the end of the stroke.
    wear : PadWear, optional
        Travel to contact with worn pads.
    """

    caliper: Caliper
    run: CaliperStroke
    friction: PivotFriction | None
    wear: PadWear | None

    @classmethod
    def of(cls, caliper: Caliper, design: CaliperInput | MechanismInput) -> CaliperAnswer:
        """Solve a caliper over its stroke; add friction and wear only if statics determines the forces."""
        given = design.run
        run = caliper.stroke(given.travel, given.points, given.finger)
        end = float(run.cable[-1])
        determined = run.status == "determined"
        rubs = given.friction or caliper.free.friction
        return cls(
            design,
            caliper.equilibrium_after(run),
            run.motion,
            caliper,
            run,
            caliper.friction(given.friction, end, given.finger) if rubs and determined else None,
            caliper.wear(given.wear) if given.wear and determined else None,
        )

    @property
    def status(self) -> str:
        """Status as in `planar.Equilibrium`: whether statics determines the forces and both pads press."""
        return self.run.status

    @property
    def message(self) -> str:
        """The status as a sentence.

        If a pad would have to pull, the sentence begins with the travel of the cable from which this is so.
        """
        pulls = (self.run.pad_force <= 0).any(axis=1)
        if not pulls.any():
            return self.run.message
        return Words(f"from cable travel {1e3 * self.run.cable[pulls.argmax()]:.6g} mm: ", self.run.message)

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on undetermined forces, open contacts, jamming, and a vehicle that cannot stop."""
        slips = self.stop and self.stop.status != "stops" and f"the vehicle {self.stop.message}"
        return (*self._unsolved, *([slips] if slips else []))

    @property
    def _unsolved(self) -> Sequence[str]:
        """Reasons why the forces of the pads are unknown, one sentence each."""
        stuck = self.friction and not self.friction.has_answer and in_files(self.friction.message)
        return (*super().refusals, *([stuck] if stuck else []))

    @property
    def warnings(self) -> Sequence[str]:
        """Warnings of the stroke, of friction that holds the brake, and of the force of the hand."""
        f = self.friction
        held = [f.message] if f and f.has_answer and f.status != "determined" else []
        hand = "bicycle", self.run.finger_force
        hard = [f"hand, {verdict(*hand)}"] if passes(*hand) else []
        return tuple(map(in_files, (*self.run.warnings, *held, *hard)))

    @property
    def error(self) -> float:
        """Largest error of the forces, relative to the largest force."""
        rubbing = np.nan if self.friction is None else self.friction.error
        return float(np.fmax.reduce((*self.run.error, self.equilibrium.largest_error, rubbing)))

    @cached_property
    def stop(self) -> StoppingDistance | None:
        """The stop with the mean pad force at the end of the stroke.

        It is None if the file has no stop, or if the pad forces are unknown.
        """
        if self.design.stop is None or self._unsolved:
            return None
        return self.design.stop.with_force(float(self.run.pad_force[-1].mean()))

    def _doubt(self) -> str:
        """State the stopping distance with less and with more friction between pads and rim."""

        def distance(design: Any) -> float:
            found = design.stop.with_force(float(self.run.pad_force[-1].mean()))
            return found.distance if found.status == "stops" else np.nan

        of = "pads and rim: Stopping distance"
        return hangs_on_friction(self.design, "stop.friction", of, distance, "m", "does not stop")

    def tables(self) -> list[RenderableType]:
        """Make the tables: lever, stroke, forces at its end, friction, wear, stop, and the statics."""
        run, pads = self.run, self.run.pad_travel[-1].sum()
        rows = [
            [
                f"{round(float(1e3 * v), 4) + 0.0:.4f}"
                for v in (run.cable[k], run.finger[k], *run.pad_travel[k])
            ]
            + [f"{v:.4f}" for v in (*run.advantage[k], run.total_advantage[k], run.travel_symmetry[k])]
            for k in planar.select_rows(len(run.cable))
        ]
        shown: list[RenderableType] = [
            f"{run.caliper}: {run.finger_force:g} N on the hand lever, lever ratio {run.lever_ratio:g}, "
            f"{run.tension:g} N in the cable",
            table(_STROKE, _STROKE_HEADS, rows),
            planar.reactions_table(self.equilibrium, f"Forces at cable travel {1e3 * run.cable[-1]:.4g} mm"),
            f"Over the whole stroke the finger travels {run.finger[-1] / pads if pads > 0 else np.nan:.4f} "
            "times as far as both pads together.",
        ]
        if (f := self.friction) is not None:
            own = self.caliper.free.friction
            named = f", {join_names(own)} with their own" if own else ""
            shown.append(
                f"Pivots with friction {f.coefficient:g}{named}: {100 * f.squeeze:.2f} % of the force "
                "reaches the pads when squeezed; when released, the tension of the cable is "
                f"{100 * f.release:.2f} % of the tension without friction."
            )
            shown.append(f"For the same forces of the pads: {self._tensions(f)}.")
        if (w := self.wear) is not None:
            shown += [
                f"Pads worn by {1e3 * lost:g} mm touch at {1e3 * finger:.3f} mm of finger travel; "
                f"force of the pad / of the finger there: {right:.4f} right, {left:.4f} left."
                for lost, finger, (right, left) in zip(w.lost, w.finger, w.advantage, strict=True)
            ]
        if self.stop is not None:
            shown.append(
                f"With {run.pad_force[-1].mean():.5g} N on each pad the vehicle {self.stop.message}"
                f"{self._assumed()}."
            )
            shown.append(self._doubt())
        hand = verdict("bicycle", self.run.finger_force)
        return [*shown, f"Hand, {hand}.", self._diagnosis(run.message, run.virtual_work)]

    def _assumed(self) -> str:
        """State which dimensions of the vehicle are assumed to be those of a usual bicycle."""
        assert self.design.stop is not None
        given = {"braked_wheel", *self.design.stop.model_fields_set}
        units = {"tyre_friction": ""}
        said = ", ".join(
            f"{key} {value:g} {units.get(key, 'm')}".rstrip()
            for key, value in vars(Stance()).items()
            if key not in given
        )
        return f"; values of a usual bicycle, as [stop] does not give them: {said}" if said else ""

    @staticmethod
    def _tensions(friction: PivotFriction) -> str:
        """State the cable's tension without friction, while squeezing and while releasing the lever."""
        both = (friction.squeezing_tension, friction.releasing_tension)
        squeezing, releasing = (planar.format_size(size, "N") for size in both)
        return (
            f"cable {friction.tension:.5g} N without friction, {squeezing} squeezing, {releasing} releasing"
        )

    def rows(self) -> Columns:
        """Make the columns of the stroke: travels, forces of the pads, and reactions of the joints."""
        run, sides = self.run, ("right", "left")
        reactions = (
            Column(f"{name} {axis} N", force[:, k])
            for name, force in run.reactions.items()
            for k, axis in enumerate("xy")
        )
        return Columns(
            Column("cable", run.cable, "m"),
            Column("finger", run.finger, "m"),
            *(Column(f"{side}_pad", run.pad_travel[:, k], "m") for k, side in enumerate(sides)),
            *(Column(f"{side}_pad", run.pad_force[:, k], "N") for k, side in enumerate(sides)),
            *(Column(f"{side}_advantage", run.advantage[:, k]) for k, side in enumerate(sides)),
            *reactions,
        )

    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""
        more = {"friction": self.friction, "wear": self.wear, "stop": self.stop}
        return self.run.to_dict() | {key: value and value.to_dict() for key, value in more.items()}

    def figure(self, place: float | None = None) -> Figure:
        """Draw the caliper at a fraction of the stroke (0 to 1), and beside it the curves over the stroke.

        The drawing also has the open caliper in grey, and the forces.
        """
        cable, closed = self._closed_at(1.0 if place is None else place)
        return caliper_figure(self.caliper, self.run, closed, cable, self._caption(cable))

    def drawings(self, place: float) -> Rows:
        """Make the drawing of the caliper at a fraction of the stroke (0 to 1), with its forces.

        The open caliper is drawn in grey.
        """
        cable, closed = self._closed_at(place)
        title = "\n".join(filter(None, (title_of(self.caliper, self.run, cable), self._caption(cable))))
        return ((caliper_drawing(self.caliper, closed, title),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """Make the charts of advantage, pad velocities and reactions over the stroke."""
        return stroke_charts(self.caliper, self.run, self._cable_at(place))

    def _closed_at(self, place: float) -> tuple[float, Equilibrium]:
        """Find the travel of the cable [m], and the equilibrium, at a fraction of the stroke from 0 to 1."""
        cable = self._cable_at(place)
        if place >= 1:
            return cable, self.equilibrium
        return cable, self.caliper.equilibrium(cable, self.run.finger_force)

    def _cable_at(self, place: float) -> float:
        """Compute the travel of the cable [m] at a fraction of the stroke from 0 to 1."""
        return float(np.interp(place, (0.0, 1.0), self.run.cable[[0, -1]]))

    def _caption(self, cable: float) -> str:
        """State the cable tensions with friction if the travel `cable` is the last of the stroke; else ""."""
        return self._tensions(self.friction) if self.friction and cable == self.run.cable[-1] else ""


# From file to results -----------------------------------------------------------------------------------


class MechanismType(TableBrakeType[CaliperInput | MechanismInput]):
    """Type of brake for mechanisms given by their bodies and joints, and for named calipers."""

    name = "mechanism"
    title = "Mechanism"
    method = "equilibrium of rigid bodies in a plane, solved by singular values; friction by Newton's method"
    error_from = "rounding and residual of the equations, both divided by their smallest singular value"
    purpose = "Any planar mechanism of bodies, joints and loads: every force, as drawn and over a stroke."
    sections = ("", "points", "run", "caliper", "stop")
    needs = ("title", "bodies", *PARTS, *sections[1:])
    example_sweep = "points.C.x=17:20:13 mm"
    sweep_results = "work"
    slider = Slider("stroke", ("as drawn", "end of the stroke"), step=0.1)
    more = MappingProxyType({"Free bodies": lambda answer: free_body_drawings(answer.equilibria)})

    def open(self, name: str) -> tuple[Mapping[str, Any], str]:
        """Read tables and text of a file, or of a named caliper."""
        if name in NAMED:
            return {"caliper": name}, named_text(name)
        known = f"give a TOML file, or the name of a caliper: {', '.join(NAMED)}"
        if not name:
            raise MissingValue("MECHANISM", None, f"{known}; brakes caliper --list shows their dimensions")
        if "." not in name and not Path(name).exists():
            raise ConfigError(name, [f"there is no such caliper; {known}"])
        text = read(name)
        return parse(text, name), text

    def read(self, tables: Mapping[str, Any], source: str) -> CaliperInput | MechanismInput:
        """Read the caliper or the mechanism that tables describe."""
        mistakes = {}
        for part in PARTS:
            if isinstance(text := tables.get(part), str):  # the user typed a text, not a list of tables
                form = 'give a list of tables, e.g. [{ name = "A", body = "arm", at = "B" }]'
                try:
                    tomllib.loads(f"parts = {text}")
                except (ValueError, RecursionError) as error:
                    form = f"not valid TOML: {str(error).rpartition(' (at line')[0] or error}; {form}"
                mistakes[part] = f"{part}: {form}"
        if mistakes:
            raise ConfigError(source, [*mistakes.values()], [*mistakes])
        return mechanism_from_dict(tables, source)

    def coarser(self, tables: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return tables with a stroke of only the positions at which the slider stops, without worn pads."""
        run = dict(tables.get("run", {}))
        points = run.get("points", _AT_STOPS)
        run["points"] = min(points, _AT_STOPS) if isinstance(points, int) else points
        run.pop("wear", None)
        return {**tables, "run": run}

    def solve(self, design: CaliperInput | MechanismInput) -> planar.PlanarAnswer:
        """Compute the forces of a caliper over its stroke, or of a mechanism as drawn and over its stroke.

        Raises
        ------
        NoAnswer
            If the mechanism cannot be assembled, does not reach the end of its stroke, or does not have the
            mobility 1.
        ValueError
            If the numbers are out of range.
        """
        with in_range(design):
            core = design.core
            try:
                if isinstance(core, Caliper):
                    return CaliperAnswer.of(core, design)
                return MechanismAnswer.of(core, design)
            except OutOfReachError as error:
                what = "clearance" if design.run.travel is None else "travel"
                words = f"{in_files(error.reason)}; give a smaller {what}, or move points"
                raise NoAnswer(words) from None
            except OppositeTravelError:
                if isinstance(design, MechanismInput):
                    raise
                remedy = "move pads, pivots or the ends of the cable"
                raise ValueError(f"the cable opens the pads: {remedy}") from None
            except AssemblyError as error:
                raise NoAnswer(say(error)) from None
            except ValueError as error:
                if solve(core.free if isinstance(core, Caliper) else core).mobility == 1:
                    raise
                raise NoAnswer(say(error)) from None

    def _first(self, answer: Answer, outputs: Mapping[str, Output]) -> Sequence[tuple[str, str]]:
        """Return words and names of three loads for the top of the screen, the unknown loads first."""
        if not isinstance(answer, MechanismAnswer):
            return super()._first(answer, outputs)
        mechanism = answer.equilibrium.position.mechanism
        given = {load.name for load in mechanism.loads} - {load.name for load in mechanism.unknown_loads}
        loads = sorted(mechanism.loads, key=lambda load: load.name in given)
        when = "at the end of the stroke" if answer.motion else "as drawn"
        return [(f"{load.name} {when}", planar.name_output(load.name)) for load in loads][:3]

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Make drawings that explain the symbols of joints and, if a stop is described, of the vehicle."""
        return mechanism_sketch(any(text for path, text in entries.items() if path.startswith("stop.")))

    def outputs(self, design: CaliperInput | MechanismInput) -> Sequence[Output]:
        """Describe the outputs at the end of the stroke, and the largest force of each joint."""
        core = design.core
        if isinstance(core, Mechanism):
            return mechanism_outputs(core)
        return (*_OUTPUTS, *planar.joint_outputs(core.mechanism, lambda answer: answer.run.magnitudes))

    def default_results(self, design: CaliperInput | MechanismInput) -> str:
        """Return the name of the first output, which a sweep shows if none is named."""
        return self.outputs(design)[0].name

    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Return the inputs of the caliper that a file names, or else of the mechanism that it describes."""
        return inputs_of_tables(tables)

    def idle(self, entries: Mapping[str, str]) -> Iterable[str]:
        """Return the paths of inputs that only calipers use, which have no effect on other mechanisms."""
        return idle_inputs(entries)

    def sweep_inputs(self, design: CaliperInput | MechanismInput, tables: Mapping[str, Any]) -> list[Input]:
        """Describe the inputs that are numbers, which a sweep can vary; among them x and y of points."""
        return numbers(self.inputs(tables))


class CaliperType(MechanismType):
    """Type of brake for named calipers."""

    name = "caliper"
    title = "Caliper"
    purpose = "A bicycle's caliper over its stroke: travels, forces, and the reaction of every joint."
    sections = ("", "run", "dimensions", "stop")
    key_results = (
        ("both pads over finger", "total_advantage"),
        ("travel of the finger", "finger_travel"),
        ("left pad over right, velocity", "travel_symmetry"),
        ("stopping distance", "stopping_distance"),
    )
    needs = ("caliper", "title", "dimensions", "run", "stop")
    example_sweep = "dimensions.clearance=1:2:21 mm"
    sweep_results = "finger_travel"
    slider = Slider("stroke", ("open", "closed"), step=0.1)

    def coarser(self, tables: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return tables with a stroke of only the positions at which the slider stops.

        Friction and worn pads are left out.
        """
        coarse = super().coarser(tables)
        friction = {"friction": 0.0} if "friction" in coarse["run"] else {}
        return {**coarse, "run": {**coarse["run"], **friction}}

    def sketch(self, entries: Mapping[str, str]) -> Rows:
        """Draw the chosen caliper with the names of its dimensions."""
        return caliper_sketch(entries.get("caliper", "").strip())

    def read(self, tables: Mapping[str, Any], source: str) -> CaliperInput | MechanismInput:
        """Read the named caliper that tables describe; without a name, an error lists the known names."""
        return super().read({"caliper": ""} | dict(tables), source)

    def inputs(self, tables: Mapping[str, Any]) -> list[Input]:
        """Return the inputs of the named caliper; without its dimensions if the name is unknown."""
        return super().inputs({"caliper": ""} | dict(tables))


CALIPER, MECHANISM = CaliperType(), MechanismType()


def names_tables() -> Iterator[RenderableType]:
    """Make a table of the dimensions of each named caliper, with their usual values."""
    for name, kind in NAMED.items():
        design, rows = kind(), []
        for key, entry in descriptions(kind).items():
            value = getattr(design, key)
            if entry.unit == "m":
                lengths = [f"{1e3 * part:.5g}" for part in np.ravel(value)]
                value = f"({', '.join(lengths)}) mm" if isinstance(value, tuple) else f"{lengths[0]} mm"
            rows.append((key, str(value), entry.meaning))
        yield table(f"{name}: {design.label}", ("dimension", "usual", "meaning"), rows, (0, 1, 2))
