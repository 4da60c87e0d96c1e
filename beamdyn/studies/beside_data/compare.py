"""Comparison of measured frequencies, histories, loads and responses with those of a scene, in any unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, pi
from time import perf_counter

import numpy as np

from beamdyn.common.inputs.checks import kind
from beamdyn.common.results.one_line import number
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import INPUT, Speeds, Statement, unannounced
from beamdyn.common.words import Words, percent
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.scene import measured_curves
from beamdyn.scene.measured_frequencies import MeasuredFrequencies
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.studies.beside_data import computed_curves
from beamdyn.studies.beside_data.curve_comparison import CurveComparison
from beamdyn.studies.beside_data.frequency_comparison import OUTSIDE, FrequencyComparison
from beamdyn.studies.beside_data.pairing import NO_MODE, likeness_of, likeness_of_kinds, pair
from beamdyn.studies.beside_data.single_numbers import explain

# Number of computed modes in excess of the measured ones, among which matching modes are searched.
_MORE_MODES = 3


def compare(
    scene: Scene, data: MeasuredFrequencies | measured_curves.MeasuredCurves
) -> FrequencyComparison | CurveComparison:
    """Compare measured values with computed ones of a scene, and find possible causes of deviations.

    Histories are compared with the scene's motion from rest, aligned in time within half a period of the
    first mode at rest; peaks with the peaks of transients up to each speed; loads with the loads in
    equilibrium at a steady speed; and responses with the frequency responses at a steady speed.

    At each speed, measured frequencies are paired with computed ones by the smallest total distance, and by
    mode shapes if these were measured.  If a deviation exceeds the sum of measurement uncertainty, numerical
    error and model error, each number of the scene is fitted alone to all data, within physical bounds.  This
    is not done with large deflection, for which derivatives are not available.

    If all data differ by one factor of 2 pi, 60, 1000 or an inverse of these, a warning says that they may be
    in another unit.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is used for histories and peaks, and its final speed if the data have no speed.
    data : MeasuredFrequencies, MeasuredHistory, MeasuredPeaks, MeasuredLoads or MeasuredResponse
        The measured values.

    Returns
    -------
    FrequencyComparison or CurveComparison

    Raises
    ------
    ValueError
        If the data are of another kind, shapes or loads are at positions beyond the beam, a history is
        shorter than a period of the first mode, or the scene lacks a motion that the data need.

    References
    ----------
    Allemang (2003), The modal assurance criterion; pairs by linear assignment (standard).

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    >>> found = bd.compare(bd.Scene(strip), bd.MeasuredFrequencies([58.90, 369.2], uncertainty=0.05))
    >>> found.explanations[0].explains
    True
    """
    check_scene(scene)
    if isinstance(data, measured_curves.MeasuredCurves):
        return _beside_curves(scene, data)
    start = perf_counter()
    rows = measured_rows(scene, data)
    found = _compared(scene, rows, start)
    found = replace(found, warnings=(*doubts_of_unit(rows), *found.warnings))
    if OUTSIDE not in found.verdict or scene.physics.large_deflection:
        return found
    bound = found.allowance + found.error + np.nan_to_num(found.model_error)
    return replace(found, explanations=explain(scene, data, bound))


def measured_rows(scene: Scene, data: MeasuredFrequencies) -> list[_MeasuredRow]:
    """Pair the measured frequencies at each speed with the scene's modes; arguments as for `compare`."""
    check_scene(scene)
    kind("data", data, MeasuredFrequencies, "read a file by bd.read_measurements")
    if data.positions is not None:
        computed_curves.check_positions(scene, "positions", data.positions)
    return [_MeasuredRow.of(scene, data, k) for k in range(len(data.speeds))]


def doubts_of_unit(rows: Sequence[_MeasuredRow]) -> Iterator[Statement]:
    """Yield a statement if the data may be in another unit, by a common factor: see `wrong_unit`."""
    return wrong_unit(
        rows[0].data.frequency, [row.modes.frequency for row in rows], [row.of_shapes for row in rows]
    )


def beside(scene: Scene, data: MeasuredFrequencies) -> FrequencyComparison:
    """Compare frequencies, without explanations or checks of units; arguments as for `compare`."""
    start = perf_counter()
    return _compared(scene, measured_rows(scene, data), start)


def _compared(scene: Scene, rows: Sequence[_MeasuredRow], start: float) -> FrequencyComparison:
    data = rows[0].data
    at, column = np.nonzero(np.isfinite(data.frequency))
    found = map(np.concatenate, zip(*(row.of_modes() for row in rows), strict=True))
    computed, mode, error, model_error, likeness = found
    warnings = dict.fromkeys(str(said) for row in rows for said in row.modes.warnings)
    provenance = rows[0].modes.provenance
    return FrequencyComparison(
        label=tuple(data.labels[k] for k in column.tolist()),
        speed=data.speeds[at],
        measured=data.frequency[at, column],
        computed=computed,
        mode=mode,
        allowance=data.allowance[at, column],
        rounding=data.rounding[at, column],
        error=error,
        model_error=model_error,
        likeness=likeness,
        resembles=tuple(said for row in rows for said in row.resembling()),
        unmeasured=tuple(said for row in rows for said in row.unmeasured()),
        explanations=(),
        warnings=(*warnings,),
        provenance=Provenance.since(start, provenance.method, provenance.compared_with),
        scene=scene,
        source=data.source,
    )


def _beside_curves(scene: Scene, data: measured_curves.MeasuredCurves) -> CurveComparison:
    """Compare measured curves of any kind (histories, peaks, loads, responses) with computed ones."""
    start = perf_counter()
    match data:
        case measured_curves.MeasuredHistory():
            found = computed_curves.computed_history(scene, data)
        case measured_curves.MeasuredPeaks():
            found = computed_curves.computed_peaks(scene, data)
        case measured_curves.MeasuredLoads():
            found = computed_curves.computed_loads(scene, data)
        case measured_curves.MeasuredResponse():
            found = computed_curves.computed_response(scene, data)
        case _:
            kinds = "MeasuredFrequencies, MeasuredHistory, MeasuredPeaks, MeasuredLoads or MeasuredResponse"
            raise TypeError(f"data = {data!r}: give {kinds}")
    made = found.result.provenance
    return CurveComparison(
        name=tuple(data.names),
        unit=found.unit,
        along=data.along[0],
        x=data.x,
        measured=data.columns,
        computed=found.value,
        allowance=data.allowance,
        rounding=data.half_digits,
        error=np.broadcast_to(found.error, found.value.shape),
        model_error=np.full(len(data.names), found.result.left_out_effects.total_of_known),
        speed=found.speed,
        delay=found.delay,
        phase=np.full(len(data.names), found.phase),
        warnings=(*_assumed(data, found.speed), *found.result.warnings),
        provenance=Provenance.since(start, made.method, made.compared_with),
        scene=scene,
        source=data.source,
    )


def _assumed(data: measured_curves.MeasuredCurves, speed: float) -> Iterator[Statement]:
    """Yield a statement that names the assumed speed, if the data state none."""
    if getattr(data, "speed", 0.0) is None:
        said = "the data have no speed: compared at ", Speeds(speed), ", the final speed of the scene"
        yield Statement(*said, kind=INPUT)


@dataclass(frozen=True)
class _MeasuredRow:
    """Measured frequencies at one speed, together with the computed modes at that speed.

    Results have an entry for each frequency that was measured at this speed; `of_shapes` also has rows for
    those that were not.
    """

    data: MeasuredFrequencies
    row: int
    modes: Modes

    @classmethod
    def of(cls, scene: Scene, data: MeasuredFrequencies, row: int) -> _MeasuredRow:
        count = data.frequency.shape[1] + _MORE_MODES
        with unannounced():
            return cls(data, row, natural_modes(scene, float(data.speeds[row]), count))

    @cached_property
    def _known(self) -> np.ndarray:
        return np.isfinite(self.data.frequency[self.row])

    @cached_property
    def of_shapes(self) -> np.ndarray | None:
        """Modal assurance criterion (m, n) of measured and computed shapes.

        If no shapes were measured, it is 1 where the measured and the computed mode are both torsional, or
        both not, by the labels of the data, and 0 elsewhere; None if no label mentions torsion.
        """
        data, modes = self.data, self.modes
        if data.shapes is None:
            return likeness_of_kinds(data.labels, modes.kinds, len(modes.frequency))
        return likeness_of(data.shapes, modes.shape(np.minimum(data.positions, modes.scene.beam.length)))

    @cached_property
    def _place(self) -> np.ndarray:
        return pair(self.data.frequency[self.row], self.modes.frequency, self.of_shapes)[self._known]

    def of_modes(self) -> tuple[np.ndarray, ...]:
        """Return frequency [Hz], number, error and model error [Hz] and likeness of each value's mode.

        Without a mode the number is 0, and the others are nan.
        """
        place, frequency, left_out = self._place, self.modes.frequency, self.modes.left_out_effects
        shapes = None if self.data.shapes is None else self.of_shapes
        alike = shapes[self._known] if shapes is not None else np.full((len(place), len(frequency)), np.nan)
        errors = self.modes.error * frequency, left_out.total_of_known * frequency
        each = frequency[place], *(error[place] for error in errors), alike[np.arange(len(place)), place]
        computed, error, model_error, likeness = np.where(place == NO_MODE, np.nan, each)
        return computed, place + 1, error, model_error, likeness

    def resembling(self) -> Iterator[str]:
        """Yield, for each measured value without a mode, the mode with the most similar shape.

        The text is empty for all other values.
        """
        known = np.flatnonzero(self._known)
        for column, place in zip(known.tolist(), self._place.tolist(), strict=True):
            shapes = self.of_shapes if place == NO_MODE and self.data.shapes is not None else None
            yield "" if shapes is None else self._most_alike(shapes[column])

    def _most_alike(self, likeness: np.ndarray) -> str:
        k = int(likeness.argmax())
        return f"mode {k + 1}, {number(self.modes.frequency[k], 'Hz')} (likeness {likeness[k]:.2f})"

    def unmeasured(self) -> Iterator[str]:
        """Yield the modes without a measured value, below the highest mode that has one."""
        highest = int(self._place.max(initial=NO_MODE))
        for k in sorted(set(range(highest)) - set(self._place.tolist())):
            frequency = number(self.modes.frequency[k], "Hz")
            yield Words(f"mode {k + 1} of the scene, {frequency} at ", Speeds(self.data.speeds[self.row]))


# Possible mistakes of units: ratio of given to correct values, as text (the key) and as a number; and words
# for the unit in which the values would then be.
_UNITS: Mapping[str, tuple[float, str]] = {
    "2 pi": (2 * pi, "in rad/s, and read as Hz"),
    "60": (60.0, "in 1/min, and read as Hz"),
    "1000": (1e3, "in mHz, or in Hz and read as kHz"),
    "1/(2 pi)": (1 / (2 * pi), "in Hz, and read as rad/s or divided by 2 pi"),
    "1/60": (1 / 60, "in Hz, and read as 1/min"),
    "1/1000": (1e-3, "in kHz, and read as Hz"),
}
# Largest relative deviation of data that are read in the right unit: models rarely deviate more.
_ALIKE = 0.1
_LESS = 0.5  # largest scatter of the deviations in the right unit, relative to that in a wrong one
_FEWEST = 2  # smallest number of values needed to detect a common factor


def wrong_unit(
    measured: Sequence[np.ndarray], computed: Sequence[np.ndarray], likeness: Sequence[np.ndarray | None]
) -> Iterator[Statement]:
    """Yield a statement if all values deviate by one common factor that is the ratio of two units.

    The values divided by the factor are paired with modes again.  The statement is made if each then has a
    mode within 10 %, and if the scatter of the ratios of measured to computed values is less than half of
    that without the factor.

    Parameters
    ----------
    measured : sequence of ndarray, each of shape (m,)
        Measured frequencies at each speed [Hz]; nan if not measured.
    computed : sequence of ndarray, each of shape (n,)
        Frequencies of the model at each speed [Hz].
    likeness : sequence of ndarray, each of shape (m, n), or None
        Modal assurance criterion of the shapes, as for `pair`.
    """
    if sum(int(np.isfinite(each).sum()) for each in measured) < _FEWEST:
        return

    def logarithms(factor: float) -> np.ndarray:
        """Compute log(measured / factor / computed) of each value and its mode; inf if it has none."""
        found = []
        for values, modes, alike in zip(measured, computed, likeness, strict=True):
            place, known = pair(values / factor, modes, alike), np.isfinite(values)
            of_mode = np.where(place == NO_MODE, 1.0, modes[place])
            found.append(np.where(place == NO_MODE, inf, np.log(values / factor / of_mode))[known])
        return np.concatenate(found)

    def scatter(logs: np.ndarray) -> float:
        return float(np.ptp(logs)) if np.isfinite(logs).all() else inf

    as_read = scatter(logarithms(1.0))
    for name, (factor, words) in _UNITS.items():
        logs = logarithms(factor)
        if np.abs(logs).max() <= np.log1p(_ALIKE) and scatter(logs) < _LESS * as_read:
            off = percent(float(np.abs(np.expm1(logs)).max()))
            said = f"all measured frequencies are {name} times those of the scene, within {off}: they may be "
            yield Statement(f"{said}{words}; give them in Hz or rad/s, with the unit", kind=INPUT)
            return
