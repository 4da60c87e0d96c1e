"""Results of planar mechanisms of bodies, joints and loads, as drawn and over a stroke."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Chart, Drawing
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.console import table
from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import plain
from brakes.answers import planar
from brakes.answers.tables import SCALES
from brakes.config.mechanism import CaliperInput, MechanismInput
from brakes.drawings import mechanism as drawings
from brakes.planar import Equilibrium, Mechanism, assemble, solve, solve_with_friction, stroke
from brakes.planar.system import join_names

WITHOUT = "without friction"


def mechanism_outputs(mechanism: Mechanism) -> tuple[Output, ...]:
    """Describe the outputs of a mechanism: loads and travels at the end of the stroke, largest joint forces.

    Each unknown load has two further outputs, while squeezing and while releasing, which are nan without
    friction.
    """
    loads, rubbing = [], []
    for load in mechanism.loads:
        key, (_, travel, size) = planar.name_output(load.name), planar.units_of(load)
        end, moved = f"{load.name} at the end of the stroke", f"travel of {load.name}"
        loads += [
            Output(key, end, lambda a, n=load.name: np.ravel(a.last.amplitudes[n])[-1], size),
            Output(
                f"{key}_travel",
                moved,
                lambda a, n=load.name: a.motion.travel[n][-1] if a.motion else np.nan,
                travel,
                SCALES[travel],
            ),
        ]
        rubbing += [
            Output(
                f"{key}_{way}",
                f"{end}, {way}",
                lambda a, n=load.name, way=way: (
                    np.ravel(a.friction.last.ways[way].amplitudes[n])[-1] if a.friction else np.nan
                ),
                load.unit,
            )
            for way in ("squeezing", "releasing")
            if load in mechanism.unknown_loads
        ]
    return (*loads, *planar.joint_outputs(mechanism, lambda answer: answer.last.magnitudes), *rubbing)


@dataclass(frozen=True)
class MechanismAnswer(planar.PlanarAnswer):
    """Equilibrium of a mechanism as drawn in its file, and over the stroke of a driver if one is named.

    Attributes
    ----------
    over : Equilibrium, optional
        Equilibrium at each position of the stroke.
    friction : MechanismFriction, optional
        Equilibria with friction, if a joint has friction, the mobility is 1 and statics determines the
        forces.
    branch : {"without friction", "squeezing", "releasing"}
        Name of the equilibrium whose forces are drawn.
    """

    over: Equilibrium | None
    friction: planar.MechanismFriction | None
    branch: str = WITHOUT

    def branches(self) -> Mapping[str, MechanismAnswer]:
        """Return copies that draw the forces of each branch: without friction, squeezing, releasing."""
        return (
            {name: replace(self, branch=name) for name in self.friction.drawn.ways} if self.friction else {}
        )

    @classmethod
    def of(cls, mechanism: Mechanism, design: CaliperInput | MechanismInput) -> MechanismAnswer:
        """Assemble a mechanism and solve for its forces; see `brakes.planar.assemble` and `stroke`.

        Raises
        ------
        MissingValue
            If joints have friction and no driver is named.
        """
        drawn, run = solve(mechanism, assemble(mechanism)), design.run
        motion, over, friction = None, None, None
        if run.driver is not None and run.travel is not None:
            motion = stroke(mechanism, run.driver, np.linspace(0.0, run.travel, run.points))
            over = solve(mechanism, motion.position)
        last = drawn if over is None else over
        if mechanism.friction and last.is_determined and drawn.mobility == 1:
            if run.driver is None:
                names = join_names(mechanism.friction)
                words = f"friction of {names} resists a motion: name the load that drives it"
                raise MissingValue("run.driver", None, words)
            moved = motion and solve_with_friction(mechanism, run.driver, motion.position)
            still = solve_with_friction(mechanism, run.driver, drawn.position)
            friction = planar.MechanismFriction(run.driver, still, moved)
        return cls(design, drawn, motion, over, friction)

    @property
    def last(self) -> Equilibrium:
        """Equilibrium over the stroke, or as drawn if there is no stroke."""
        return self.over or self.equilibrium

    @property
    def status(self) -> str:
        """Status: whether statics determines the forces; see `planar.Equilibrium`."""
        return self.last.status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return self.last.message

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on undetermined forces, open contacts, and directions in which friction jams."""
        found = super().refusals
        if self.friction is not None:
            return (*found, *map(in_files, self.friction.refusals))
        if self._mechanism.friction and self.last.is_determined:
            return (*found, f"friction needs mobility 1; here the mobility is {self.equilibrium.mobility}")
        return found

    @property
    def warnings(self) -> Sequence[str]:
        """Warnings of statics, toggle positions, and directions in which friction holds the mechanism."""
        said = [*self.last.warnings]
        if self.motion is not None:  # add warnings of toggle positions and of doubtful inputs of joints
            said += [toggle.message for toggle in self.motion.toggles]
            angles = {body: self.motion.position.angle(body) for body in self._mechanism.bodies}
            said += [words for joint in self._mechanism.joints for words in joint.doubts(angles)]
        return tuple(map(in_files, (*said, *(self.friction.warnings if self.friction else ()))))

    @property
    def error(self) -> float:
        """Largest error of the forces, relative to the largest force."""
        return max(self.last.largest_error, self.friction.error if self.friction else 0.0)

    @property
    def equilibria(self) -> Mapping[str, Equilibrium]:
        """Equilibrium as drawn; with friction, the three equilibria as drawn, by name."""
        return super().equilibria if self.friction is None else self.friction.drawn.ways

    @property
    def _mechanism(self) -> Mechanism:
        return self.equilibrium.position.mechanism

    def tables(self) -> list[RenderableType]:
        """Make the tables: forces as drawn, friction, loads over the stroke, forces at its end, statics."""
        title = f"{self.design.title}: forces {{}}{', without friction' if self.friction else ''}"
        shown = [planar.reactions_table(self.equilibrium, title.format("as drawn"))]
        if self.friction:
            shown.append(self.friction.table())
        if self.motion is not None:
            columns, end = self._columns(), len(self.motion.values) - 1
            rows = [
                [planar.format_force(v[k], 6) for v in columns.values()] for k in planar.select_rows(end + 1)
            ]
            last = solve(self._mechanism, self.motion.position[end])
            shown.append(table(f"Stroke of {self.motion.driver}", [*columns], rows))
            shown.append(planar.reactions_table(last, title.format(f"at {self._travelled(end)}")))
        return [*shown, self._diagnosis(self.message, self.last.virtual_work)]

    def _columns(self) -> dict[str, np.ndarray]:
        """Return travels and magnitudes of the loads over the stroke, by name with unit."""
        if self.motion is None or self.over is None:
            return {}
        travels, loads = {}, {}
        for load in self._mechanism.loads:
            factor, travel, size = planar.units_of(load)
            travels[f"{load.name} [{travel}]"] = factor * self.motion.travel[load.name]
            loads[f"{load.name} [{size}]"] = self.over.amplitudes[load.name]
        rubbing = self.friction.curves() if self.friction else ()
        return travels | loads | {f"{name} [{load.unit}]": size for load, name, size in rubbing}

    def rows(self) -> Iterator[Sequence[object]]:
        """Make the rows of the stroke or, without one, of the forces of loads and joints as drawn."""
        if self.motion is not None:
            columns = self._columns()
            yield [*columns]
            yield from np.stack([*columns.values()], axis=1).tolist()
            return
        ways = list(self.equilibria.values())
        more = ("squeezing", "releasing") if self.friction else ()
        yield "force_of", "x_N", "y_N", "size", *more, "unit"
        for part in self._mechanism.parts:
            force = np.ravel(self.equilibrium.reactions.get(part.name, (np.nan, np.nan)))
            sizes = (float((way.magnitudes | way.amplitudes)[part.name]) for way in ways)
            yield part.name, *force, *sizes, part.unit

    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""
        keys = ("mobility", "indeterminacy", "loose", "undetermined", "open_or_slack")
        forces = ("reactions", "magnitudes", "amplitudes")
        drawn = {key: plain(getattr(self.equilibrium, key)) for key in (*keys, *forces)}
        told = {"title": self.design.title, "status": self.status, "message": self.message}
        more = {"warnings": plain(self.warnings), "stroke": plain(self._columns())}
        return told | drawn | more | {"friction": self.friction and self.friction.to_dict()}

    def figure(self, place: float | None = None) -> Figure:
        """Draw the mechanism with its forces, and the loads over the stroke.

        Parameters
        ----------
        place : float, optional
            Fraction of the stroke, from 0 to 1; if not given, the mechanism has the position of its file, to
            which the table of forces also belongs.
        """
        ((drawn,),) = self.drawings(place or 0.0)
        return drawings.mechanism_figure(drawn, self.charts(place or 0.0))

    def drawings(self, place: float) -> Rows:
        """Draw the mechanism at a fraction of its stroke (0 to 1), and in grey the position of its file."""
        return ((self._drawing(self._index_at(place)),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """Make the chart of forces and moments over the stroke, if there is one."""
        if self.motion is None or self.over is None:
            return ()
        curves = [(load, load.name, self.over.amplitudes[load.name]) for load in self._mechanism.loads]
        factor, unit, _ = planar.units_of(self._mechanism.load(self.motion.driver))
        return drawings.loads_over_stroke(
            drawings.travel_axis(f"travel of {self.motion.driver}", unit, factor * self.motion.values),
            factor * self.motion.values,
            [*curves, *(self.friction.curves() if self.friction else ())],
            factor * float(self.motion.values[self._index_at(place)]),
            self.friction.locked() if self.friction else {},
        )

    def _index_at(self, place: float) -> int:
        """Return the index of the position at a fraction of the stroke, from 0 to 1."""
        return 0 if self.motion is None else round(place * (len(self.motion.values) - 1))

    def _drawing(self, index: int) -> Drawing:
        """Draw the mechanism at the position of an index, with the forces of the selected branch."""
        way, title = f", {self.branch}" if self.friction else "", self.design.title
        if self.motion is None:
            title += way
        else:
            title += f": {self._travelled(index)}{way}; grey: as drawn" if index else f": as drawn{way}"
        position = self.equilibrium.position if self.motion is None else self.motion.position[index]
        if self.friction is not None and self.branch != WITHOUT:
            now = solve_with_friction(self._mechanism, self.friction.driver, position).ways[self.branch]
        else:
            now = solve(self._mechanism, position)
        captions = self.friction.captions(index) if self.friction else ()
        drawn = drawings.open_and_closed(self.equilibrium.position, now, "\n".join((title, *captions)))
        if now.status == "self-locking":
            drawn = drawings.with_lock(drawn, now, self._mechanism.unknown_loads[-1].name)
        # The input of a caliper that is chosen by a name has dimensions instead of points.
        points = getattr(self.design, "points", {})
        return drawings.with_points(drawn, {name: (float(x), float(y)) for name, (x, y) in points.items()})

    def _travelled(self, index: int) -> str:
        """State the travel of the driving load at the position of an index."""
        if self.motion is None:
            return ""
        factor, unit, _ = planar.units_of(self._mechanism.load(self.motion.driver))
        return f"{factor * self.motion.values[index]:.3g} {unit} of {self.motion.driver}"
