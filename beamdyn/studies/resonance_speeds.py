"""Resonance speeds of many similar designs at once, by batched eigenproblems in one basis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import Designs, rows_of
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.statements import EXCITATION, Statement
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.many_designs import speeds_of_meeting
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion.base import Line
from beamdyn.scene.names_elsewhere import WITH_WHEEL
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossing, label_crossing
from beamdyn.steady.periodic_system import excitation_lines, periodic_system
from beamdyn.studies import batched
from beamdyn.studies.answers import REFUSED, DesignAnswers, caution_where
from beamdyn.studies.similar import SimilarDesigns

RESONATES, NO_RESONANCE, NO_LINE = "resonates", "none up to the top speed", "not excited"
_NOTHING_EXCITES = Statement(" nothing excites the beam", kind=EXCITATION)
_FEW = Ritz(6)  # small basis for finding a scene's excitation lines, which do not depend on the basis
_PROBED = 16  # number of designs, in addition to the extremes, whose excitation lines are computed
_MOST_EXTREMES = 4  # largest number of inputs of which all combinations of extremes are considered


def line_key(kind: str, line: Line) -> tuple[str, float]:
    """Return a sort key for an excitation line; lines whose multiples differ by rounding share a key.

    The kind is "forced" or "parametric".
    """
    return kind, round(line.multiple, 9)


def crossing_key(crossing: Crossing | PossibleCrossing) -> tuple[str, float, int]:
    """Return kind, multiple and mode of a crossing: a key that matches found crossings with possible ones."""
    return *line_key(crossing.kind, crossing.line), crossing.mode


@dataclass(frozen=True)
class PossibleCrossing:
    """Mode and excitation line that may cross.

    Parameters
    ----------
    kind : {"forced", "parametric"}
        Kind of excitation, as for `Crossing`.
    line : Line
        Excitation line.
    mode : int
        Number of the mode, from 1.
    """

    kind: str
    line: Line
    mode: int

    @property
    def label(self) -> str:
        """Label of the crossing in tables and plots."""
        return label_crossing(self.line, self.kind, self.mode)

    @property
    def key(self) -> tuple[str, float, int]:
        """Key of the line and the mode; see `crossing_key`."""
        return crossing_key(self)

    @property
    def multiple(self) -> float:
        """Ratio of the mode's frequency to the speed at resonance."""
        return self.line.multiple / (2 if self.kind == "parametric" else 1)


@lru_cache(maxsize=64)
def lines_of(scene: Scene, top: float) -> tuple[tuple[str, Line], ...]:
    """Return each excitation line of a scene with its kind, "forced" or "parametric".

    These are the lines of the load and of the periodic stiffness, without the lines that products of the two
    add.  `top` is the speed [rad/s] at which the equations are expanded in harmonics.
    """
    system = periodic_system(Model(scene, _FEW).equations, scene.motion, np.array([top]))
    kinds = zip(("forced", "parametric"), excitation_lines(system, scene.motion, 1), strict=True)
    return tuple((kind, line) for kind, lines in kinds for line in lines)


def list_resonances(scene: Scene, designs: Designs, top: float, modes: int) -> tuple[PossibleCrossing, ...]:
    """List the resonances that may occur in the designs: each excitation line with each mode.

    The lines are collected from extreme designs and from some evenly spread ones.

    Raises
    ------
    InvalidValue
        If nothing excites the beam in any of these designs.
    """
    rows = np.unique([*evenly_spread(designs.count, _PROBED), *_ends_of_columns(designs)])
    probed = rows_of(designs.columns(rows)) if designs.inputs else [{}]
    if designs.combine == "product" and len(designs.inputs) <= _MOST_EXTREMES:
        probed += [*designs.extremes()]
    found: dict[tuple[str, float], tuple[str, Line]] = {}
    for design in probed:
        for kind, line in lines_of(with_numbers(scene, design), top):
            found.setdefault(line_key(kind, line), (kind, line))
    if not found:
        bound = "nothing varies in time at steady speed in any design, so that none resonates"
        raise InvalidValue("scene.motion", scene.motion and type(scene.motion).__name__, bound, WITH_WHEEL)
    each = (found[key] for key in sorted(found))
    return tuple(PossibleCrossing(kind, line, mode) for kind, line in each for mode in range(1, modes + 1))


def _ends_of_columns(designs: Designs) -> list[int]:
    """Return the indices of the designs with the smallest and largest value of each input.

    The list is empty if the designs are all combinations of the inputs: their extremes are found otherwise.
    """
    if designs.combine == "product":
        return []
    return [int(end(each.values)) for each in designs.inputs for end in (np.argmin, np.argmax)]


def crossings_of(
    designs: SimilarDesigns,
    refinement: batched.Refinement,
    scene: Scene,
    resonances: Sequence[PossibleCrossing],
    top: float,
) -> DesignAnswers:
    """Compute the resonance speeds (N, 1, c) of similar designs, with statuses and warnings.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    refinement : Refinement
        The bases, and the number of modes.
    scene : Scene
        The scene that is varied; its motion and gravity excite the beam.
    resonances : sequence of PossibleCrossing
        The c crossings to be computed.
    top : float
        Top speed [rad/s].
    """
    multiples, modes = np.unique([each.multiple for each in resonances]), refinement.modes

    def solve(rows: np.ndarray, basis: Discretization) -> batched.BasisAnswers:
        stack, coarse, *_ = batched.stacks_of(designs, rows, basis)
        time, estimate = designs.time[rows], designs.estimate(basis)
        speed, error, rounding = speeds_of_meeting(stack, coarse, multiples, modes, top * time, estimate)
        critical = speeds_of_meeting(stack, coarse, np.zeros(1), 1, top * time, estimate)[0]
        speed = np.where(speed < critical, speed, np.inf)  # above its critical speed a beam does not vibrate
        met = np.isinf(speed) | (error <= np.maximum(refinement.target_of(basis), 3 * rounding))
        return batched.BasisAnswers((speed / time[:, None, None], error), np.all(met, axis=(1, 2)))

    found, functions = refinement.solve(designs.count, len(multiples), solve)
    found = found or [np.full((designs.count, len(multiples), modes), np.nan)] * 2
    places = [(int(np.searchsorted(multiples, r.multiple)), r.mode - 1) for r in resonances]
    speed, error = (np.stack([values[:, i, j] for i, j in places], axis=1)[:, None] for values in found)
    excited = np.broadcast_to(_excited(designs, scene, resonances, top)[:, None], speed.shape)
    states = [NO_LINE, REFUSED, RESONATES]
    status = np.select([~excited, np.isnan(speed), np.isfinite(speed)], states, NO_RESONANCE)
    error = np.select([status == REFUSED, status == RESONATES], [np.inf, error], 0.0)
    cautions = (
        *batched.cautions_of_refused(status),
        *batched.cautions_of_error(error, refinement.tolerance),
        *caution_where((status == NO_LINE).all(axis=2), "g", 0.0, _NOTHING_EXCITES),
    )
    speed = np.where(status == RESONATES, speed, np.nan)
    return DesignAnswers(speed, error, status, cautions, f"Ritz, at most {functions} functions, batched")


def _excited(
    designs: SimilarDesigns, scene: Scene, resonances: Sequence[PossibleCrossing], top: float
) -> np.ndarray:
    """Decide which of the resonances have an excitation line in each design: (designs, resonances).

    That depends on gravity, and on whether the load has a component in the direction of bending.
    """

    def have_line(design: Mapping[str, float]) -> np.ndarray:
        there = {line_key(*each) for each in lines_of(with_numbers(scene, design), top)}
        return np.array([resonance.key[:2] in there for resonance in resonances])

    columns = {n: v for n, v in designs.columns.items() if n in ("mount.bending_angle", "model.gravity")}
    if not columns:
        return np.broadcast_to(have_line({}), (designs.count, len(resonances)))
    kinds = np.stack([_kind_of(name, values) for name, values in columns.items()], axis=1)
    _, first, kind = np.unique(kinds, axis=0, return_index=True, return_inverse=True)
    each = rows_of({name: values[first] for name, values in columns.items()})
    return np.array([have_line(design) for design in each])[kind.ravel()]


def _kind_of(name: str, values: np.ndarray) -> np.ndarray:
    """Classify values by what decides on excitation lines: an integer or bool for each.

    For gravity that is whether it is 0; for an angle, which of its cosine and sine are 0.
    """
    if name == "model.gravity":
        return values != 0
    return (np.abs(np.cos(values)) > 1e-15) * 2 + (np.abs(np.sin(values)) > 1e-15)
