"""What the command `brakes caliper` finds, prints, writes and draws."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console, RenderableType

from beamdyn.common.edge.config import ConfigError, parse, read
from beamdyn.common.edge.program import NoAnswer
from beamdyn.common.edge.tables import table
from beamdyn.common.results import Result
from brakes.answers.mechanism import MechanismAnswer, animate_stroke, reactions_table, some_rows, verdict
from brakes.calipers import NAMED, Caliper, CaliperStroke, PadWear, PivotFriction
from brakes.config.mechanism import CaliperInput, MechanismInput
from brakes.config.mechanism_inputs import named_text
from brakes.drawings.caliper import caliper_figure
from brakes.drawings.mechanism import free_body_diagrams
from brakes.planar import AssemblyError, Equilibrium, Mechanism, OutOfReachError, solve
from brakes.planar.described import inputs_of

_STROKE = "Travels [mm], forces of the pads over that of the finger, velocity of the left pad over the right"


def answer_to(given: CaliperInput | MechanismInput) -> Answer:
    """The answer to a caliper or a mechanism.

    Raises
    ------
    NoAnswer
        If the mechanism cannot be assembled, does not reach the end of its stroke, or has not one motion.
    """
    core = given.core
    try:
        return CaliperAnswer.of(core, given) if isinstance(core, Caliper) else MechanismAnswer.of(core, given)
    except (AssemblyError, OutOfReachError) as error:
        raise NoAnswer(str(error)) from None
    except ValueError as error:
        if _mobility(core) != 1:
            raise NoAnswer(str(error)) from None
        raise


def design_of(name_or_file: str) -> tuple[Mapping[str, Any], str]:
    """Tables of a file, or of the caliper of a name, and their text.

    Raises
    ------
    ConfigError
        If there is no such name or file, or it is not TOML.
    """
    if name_or_file in NAMED:
        return {"caliper": name_or_file}, named_text(name_or_file)
    if not name_or_file or ("." not in name_or_file and not Path(name_or_file).exists()):
        known = f"give a TOML file or one of {', '.join(NAMED)}"
        raise ConfigError(name_or_file or "no mechanism", [f"there is no such caliper; {known}"])
    text = read(name_or_file)
    return parse(text, name_or_file), text


def _mobility(core: Caliper | Mechanism) -> int:
    return int(solve(core.free if isinstance(core, Caliper) else core).mobility)


def write_names(screen: Console) -> None:
    """Print the named calipers with their dimensions."""
    for name, model in NAMED.items():
        values = model()
        rows = []
        for key, described in inputs_of(model).items():
            value = getattr(values, key)
            rows.append((key, _length(value) if described.unit == "m" else f"{value}", described.meaning))
        screen.print(table(f"{name}: {model.label}", ("dimension", "usual", "meaning"), rows, (0, 1, 2)))


def _length(value: Any) -> str:
    if isinstance(value, tuple):
        return f"({value[0] * 1e3:.5g}, {value[1] * 1e3:.5g}) mm"
    return f"{value * 1e3:.5g} mm"


# Calipers -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class CaliperAnswer(Result):
    """A caliper over its stroke, where it closes, and with friction, wear and a stop if asked for."""

    caliper: Caliper
    given: CaliperInput | MechanismInput
    run: CaliperStroke
    closed: Equilibrium
    friction: PivotFriction | None
    wear: PadWear | None

    @classmethod
    def of(cls, caliper: Caliper, given: CaliperInput | MechanismInput) -> CaliperAnswer:
        """Solve."""
        asked = given.run
        run = caliper.stroke(asked.travel, asked.points, asked.finger)
        end = float(run.cable[-1])
        determined = run.status == "determined" and bool((run.pad_force > 0).all())
        return cls(
            caliper,
            given,
            run,
            caliper.equilibrium(end, asked.finger),
            caliper.friction(asked.friction, end) if asked.friction and determined else None,
            caliper.wear(asked.wear) if asked.wear and determined else None,
        )

    @property
    def status(self) -> str:
        """Whether statics determines the forces, and the pads press."""
        return "open" if (self.run.pad_force <= 0).any() else self.run.status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        if self.status != "open":
            return self.run.message
        cable = self.run.cable[(self.run.pad_force <= 0).any(axis=1).argmax()]
        return (
            f"at {1e3 * cable:.6g} mm of cable the pads would have to pull on the rim: the caliper is past "
            "its toggle position, or a pad's direction is reversed; give a shorter travel"
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of the stroke and of friction."""
        locked = self.friction and self.friction.status != "determined" and self.friction.message
        return (*self.run.warnings, *([locked] if locked else []))

    @cached_property
    def stop(self) -> Any:
        """The stop, if it is asked for: with the mean force of the pads at the end of the stroke."""
        if self.given.stop is None or self.status != "determined":
            return None
        return self.given.stop.with_force(float(self.run.pad_force[-1].mean()))

    def tables(self) -> list[RenderableType]:
        """Tables and sentences for people."""
        run = self.run
        return [
            f"{run.caliper}: {run.finger_force:g} N on the hand lever, lever ratio {run.lever_ratio:g}, "
            f"{run.tension:g} N in the cable",
            table(_STROKE, *self._stroke_table()),
            reactions_table(self.closed, f"Forces at {1e3 * run.cable[-1]:.4g} mm of cable"),
            *self._sentences(),
            verdict(self.closed, run.message, run.virtual_work.max()),
        ]

    def _stroke_table(self) -> tuple[Sequence[str], list[list[str]]]:
        heads = (
            "cable",
            "finger",
            "right pad",
            "left pad",
            "right force",
            "left force",
            "both",
            "left/right",
        )
        run, rows = self.run, []
        for k in some_rows(len(run.cable)):
            lengths = (run.cable[k], run.finger[k], *run.pad_travel[k])
            ratios = (*run.advantage[k], run.total_advantage[k], run.travel_symmetry[k])
            rows.append([f"{np.round(1e3 * v, 4) + 0.0:.4f}" for v in lengths] + [f"{v:.4f}" for v in ratios])
        return heads, rows

    def _sentences(self) -> Iterator[str]:
        run = self.run
        mean = run.finger[-1] / run.pad_travel[-1].sum() if run.pad_travel[-1].sum() > 0 else np.nan
        yield f"Over the whole stroke the finger travels {mean:.4f} times as far as both pads together."
        if self.friction is not None:
            f = self.friction
            yield (
                f"Pivots with friction {f.coefficient:g}: {100 * f.squeeze:.2f} % of the force arrives when "
                f"squeezed; when let go the cable still has {100 * f.release:.2f} % of its tension."
            )
        if self.wear is not None:
            for lost, finger, (right, left) in zip(
                self.wear.lost, self.wear.finger, self.wear.advantage, strict=True
            ):
                yield (
                    f"Pads worn by {1e3 * lost:g} mm touch at {1e3 * finger:.3f} mm of finger travel; "
                    f"pad/finger there {right:.4f} right, {left:.4f} left."
                )
        if self.stop is not None:
            yield f"With {run.pad_force[-1].mean():.5g} N on each pad the vehicle {self.stop.message}."

    def rows(self) -> Iterator[Sequence[object]]:
        """Rows of the CSV file."""
        run, joints = self.run, list(self.run.reactions)
        yield (
            *("cable_m", "finger_m", "right_pad_m", "left_pad_m"),
            *("right_pad_N", "left_pad_N", "right_advantage", "left_advantage"),
            *(f"{name} {axis} N" for name in joints for axis in "xy"),
        )
        reactions = [run.reactions[name] for name in joints]
        columns = (run.cable[:, None], run.finger[:, None], run.pad_travel, run.pad_force, run.advantage)
        yield from np.concatenate((*columns, *reactions), axis=1).tolist()

    def to_dict(self) -> dict[str, Any]:
        """The answer as plain numbers, lists and strings."""
        more = {"friction": self.friction, "wear": self.wear, "stop": self.stop}
        return self.run.to_dict() | {key: value and value.to_dict() for key, value in more.items()}

    def figure(self) -> Figure:
        """Open and closed with forces, and the curves over the stroke."""
        return caliper_figure(self.caliper, self.run, self.closed)

    def free_bodies(self) -> Figure:
        """A diagram of each body at the end of the stroke."""
        return free_body_diagrams(self.closed)

    def animate(self, path: Path, force: bool) -> None:
        """Write the stroke as GIF."""
        animate_stroke(self.run.motion, path, force)


Answer = CaliperAnswer | MechanismAnswer
