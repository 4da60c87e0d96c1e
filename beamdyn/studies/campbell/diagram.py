"""Campbell diagram of one scene or several: natural frequencies, excitation lines, crossings, margins."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter
from typing import Any, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending, count, flag, kind, one_of, positive, real
from beamdyn.common.plots.campbell import Curves, plot_campbell
from beamdyn.common.results.columns import DisplayUnits
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import after
from beamdyn.equations.effects import first_drawn, name_directions
from beamdyn.modes.bounds import FrequencyBounds, frequency_bounds
from beamdyn.modes.locus import Locus, frequency_locus
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import BENDING, OTHER_KINDS
from beamdyn.modes.model_error.left_out_changes import nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.motion.base import Line
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.steady.crossings import left_out_of_crossings
from beamdyn.steady.periodic_system import distinct_lines, excitation_lines, periodic_system
from beamdyn.studies.campbell import line_crossings

UNITS = ("rad/s", "rpm")
_MOST_ORDERS = 100
_SAME = 1e-9  # relative difference below which an operating speed equals another speed

Scenes: TypeAlias = "Scene | Sequence[Scene] | Mapping[str, Scene]"


@dataclass(frozen=True)
class Campbell(SceneResult, StatesModelError):
    """Natural frequencies over speed, excitation lines, their crossings and margins.

    `left_out` contains the estimated relative change of the speed of each crossing by each neglected physical
    effect, `model_error` (k,) the magnitude of the sum of these changes; both are computed at first use.

    Parameters
    ----------
    labels : tuple of str
        Label of each scene.
    names : tuple of tuple of str
        Names of the modes of each scene: "flap 1", "edge 1" by the direction in which they mostly bend at the
        first speed; "mode 1" if the bending angle is not a multiple of 90 degrees, or if a beam with one
        plane does not point outward.
    loci : tuple of Locus
        Natural frequencies of each scene, tracked, with errors and confidence.
    lines : tuple of Line
        The lines at multiples of the speed (per-rev), then other lines of the motions.
    crossings : tuple of LineCrossing
        Where lines meet natural frequencies, scene by scene, by ascending speed.
    margins : tuple of Margin
        Distances of each mode from the nearest line at the rated speed and over the operating range.
    bounds : tuple of (str, FrequencyBounds)
        Label and guaranteed bounds, at the rated speed or otherwise the top speed, of each scene that has
        them; empty if they were not requested.
    rated : float or None
        Rated speed [rad/s].
    operating : tuple of float or None
        Operating range [rad/s].
    unit : {"rad/s", "rpm"}
        Unit of speeds in the plot and the tables.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi))
    >>> diagram = bd.campbell(scene, np.linspace(0, 200, 21), modes=1, per_rev=(3, 4), rated=130.0)
    >>> [(m.line.name, round(m.margin, 3)) for m in diagram.margins]
    [('4P', -0.026)]
    """

    labels: tuple[str, ...]
    names: tuple[tuple[str, ...], ...]
    loci: tuple[Locus, ...]
    lines: tuple[Line, ...]
    crossings: tuple[line_crossings.LineCrossing, ...]
    margins: tuple[line_crossings.Margin, ...]
    bounds: tuple[tuple[str, FrequencyBounds], ...]
    rated: float | None
    operating: tuple[float, float] | None
    unit: str

    def headline(self) -> Iterator[str]:
        """Yield numbers of crossings, lines and scenes, and the error, for the one-line summary.

        See `Result.headline`.
        """
        found, top = counted(len(self.crossings), "crossing"), self.loci[0].speeds[-1]
        yield f"{found} of {counted(len(self.lines), 'line')} up to {self.say_speed(top)}"
        yield counted(len(self.loci), "scene") if len(self.loci) > 1 else ""
        yield error_at_most([c.error for c in self.crossings]) if self.crossings else ""
        yield warned(self.warnings)

    @property
    def plot_label(self) -> str:
        """Label of the curves in a plot of several results: empty, as each scene has a label."""
        return ""

    @property
    def display_units(self) -> DisplayUnits:
        """Units of tables, columns and plots, with the requested unit of speeds."""
        return vars(self).get("_display_units") or super().display_units.with_others({"speed": self.unit})

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the speed of each crossing by neglected effects: a value per crossing."""
        effects, sizes = [], []
        for label, locus in zip(self.labels, self.loci, strict=True):
            own = [c for c in self.crossings if c.label == label]
            modes = locus.frequency.shape[1]
            speeds = np.array([c.speed for c in own])
            # A crossing with one mode is treated as a combination of this mode with itself.
            pairs = 2 * np.pi * np.array([[c.frequency] * 2 for c in own])
            known = left_out_of_crossings(locus.model, speeds, pairs, modes) if own else None
            effects.append(known or nothing_known(locus.scene))
            sizes.append(len(own))
        if not sum(sizes):
            return effects[0]
        changes = {
            name: np.concatenate(
                [e.changes.get(name, np.zeros(n)) for e, n in zip(effects, sizes, strict=True) if n]
            )
            for name in dict.fromkeys(name for e in effects for name in e.changes)
        }
        words = {part: {k: v for e in effects for k, v in getattr(e, part).items()} for part in _IN_WORDS}
        not_modelled = tuple(dict.fromkeys(name for e in effects for name in e.not_modelled))
        return replace(effects[0], changes=changes, not_modelled=not_modelled, shape=(sum(sizes),), **words)

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain numbers, lists and strings, with model error and neglected effects."""
        # Loci without model errors, which would take long to compute.
        loci = [super(StatesModelError, locus).to_dict() for locus in self.loci]
        return super().to_dict() | {"loci": loci}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the diagram, with flap solid and edge dashed if two planes are modelled."""
        return plot_campbell(
            [self._curves(i) for i in range(len(self.loci))],
            {line.name: line.multiple for line in self.lines},
            self._marked(),
            ax,
            unit=self.display_units.speed_unit().name,
            rated=self.rated,
            operating=self.operating,
        )

    def _curves(self, i: int) -> Curves:
        locus, label, names = self.loci[i], self.labels[i], self.names[i]
        if locus.scene.physics.planes == 1:
            return Curves(locus.speeds, locus.frequency, names, label)
        drawn, words = first_drawn(locus.scene), name_directions(locus.scene)
        meanings = words[drawn][1], words[1 - drawn][1], *OTHER_KINDS
        return Curves(locus.speeds, locus.frequency, names, label, locus.main_motions, meanings)

    def _marked(self) -> dict[str, list[tuple[float, float]]]:
        """Return points (speed, frequency) of the crossings, by the name in the legend."""
        if self.operating is None:
            return {"crossing": [(c.speed, c.frequency) for c in self.crossings]}
        inside = "crossing in the operating range", "crossing outside it"
        points: dict[str, list[tuple[float, float]]] = {name: [] for name in inside}
        for c in self.crossings:
            points[inside[0] if c.operating else inside[1]].append((c.speed, c.frequency))
        return points


def campbell(
    scenes: Scenes,
    speeds: np.ndarray | Sequence[float],
    modes: int = 4,
    per_rev: Iterable[int] = range(1, 7),
    rated: float | None = None,
    operating: tuple[float, float] | None = None,
    unit: str | None = None,
    bounds: bool = False,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
) -> Campbell:
    """Compute a Campbell diagram: natural frequencies over speed, and the lines that may excite them.

    All lines are compared with all modes, whether the line excites the mode or not; `resonance_speeds` takes
    that into account for a scene's motion.

    Parameters
    ----------
    scenes : Scene, sequence of Scene or mapping of str to Scene
        One scene or several, which are drawn in one plot; a mapping gives them names.
    speeds : sequence of float
        Speeds [rad/s], ascending, from 0 or above.  The operating speeds are added to them.
    modes : int
        Number of modes to follow.
    per_rev : iterable of int
        Orders n of the per-rev lines, whose frequency is n speed / (2 pi).
    rated : float, optional
        Rated speed [rad/s], at which margins are stated.
    operating : (float, float), optional
        Lowest and highest operating speed [rad/s]: margins are stated over the range, and the crossings in it
        are marked.
    unit : {"rad/s", "rpm"}, optional
        Unit of speeds in the plot and the tables, by default that of the first scene; the result itself is in
        rad/s.
    bounds : bool
        Whether to compute guaranteed bounds of the frequencies at the rated speed, or otherwise the top
        speed.
    discretization, tolerance
        As for `natural_modes`.

    Returns
    -------
    Campbell

    Raises
    ------
    ValueError
        If an argument is out of its range.

    References
    ----------
    Campbell (1924), The protection of steam-turbine disk wheels from axial vibration, Transactions of the
    ASME 46.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=np.pi))
    >>> diagram = bd.campbell(scene, np.linspace(0, 200, 21), modes=1, per_rev=(2, 3, 4))
    >>> [(c.line.name, round(c.speed, 2)) for c in diagram.crossings]  # rad/s
    [('4P', 136.01)]
    """
    start = perf_counter()
    by_label, orders, bounds = _check_scenes(scenes), _check_orders(per_rev), flag("bounds", bounds)
    if unit is None:
        own = next(iter(by_label.values())).units.speed
        unit = own if own in UNITS else UNITS[0]
    one_of("unit", unit, UNITS)
    speeds = _check_speeds(speeds)
    rated, operating = _check_operation(speeds, rated, operating)
    # Operating speeds are added to the given speeds; they replace given speeds that are equal within
    # rounding.
    added = np.unique([v for v in (rated, *(operating or ())) if v is not None])
    if added.size:
        far = np.abs(speeds[:, None] - added).min(axis=1) > _SAME * speeds[-1]
        speeds = np.union1d(speeds[far], added)
    loci = [frequency_locus(s, speeds, modes, discretization, tolerance) for s in by_label.values()]
    names = [_name_modes(locus) for locus in loci]
    lines, unknown = _all_lines(orders, loci, [*by_label])
    named = [*zip(by_label, names, loci, strict=True)]
    crossings, margins = [], []
    for one in named:
        found = line_crossings.find_crossings(*one, lines, operating)
        crossings += found
        margins += [] if rated is None else line_crossings.margins_at_rated(*one, lines, rated)
        margins += [] if operating is None else line_crossings.margins_in_range(*one, lines, operating, found)
    bounded, refused = _bound(named, speeds[-1] if rated is None else rated) if bounds else ([], [])
    methods = (", ".join(dict.fromkeys(getattr(c.provenance, n) for c in loci)) for n in _METHODS)
    return Campbell(
        labels=tuple(by_label),
        names=tuple(names),
        loci=tuple(loci),
        lines=tuple(lines),
        crossings=tuple(crossings),
        margins=tuple(margins),
        bounds=tuple(bounded),
        rated=rated,
        operating=operating,
        unit=unit,
        warnings=(*_warnings(named, lines), *unknown, *refused),
        provenance=Provenance.since(start, *methods),
        scene=loci[0].scene,
    )


_METHODS = "method", "compared_with"


# Check of the arguments ----------------------------------------------------------------------------


def _check_scenes(scenes: Scenes) -> dict[str, Scene]:
    """Return the scenes by their labels; by numbers if several have no label, or the same label."""
    if isinstance(scenes, Scene):
        return {"": scenes}
    by_label: dict[str, Any]
    if isinstance(scenes, Mapping):
        by_label = {**scenes}
        for label in by_label:
            kind("scenes", label, str, "labels are text")
    else:
        try:
            numbered = {f"scene {i}": scene for i, scene in enumerate(scenes, 1)}
        except TypeError:
            numbered = {"": scenes}
        own = {name: scene.label if isinstance(scene, Scene) else "" for name, scene in numbered.items()}
        by_label = {own[name] or name: scene for name, scene in numbered.items()}
        by_label = by_label if len(by_label) == len(numbered) else numbered
    if not by_label:
        raise InvalidValue("scenes", scenes, "it is empty; give at least one scene")
    for label, scene in by_label.items():
        kind(f"scenes[{label!r}]" if label else "scenes", scene, Scene, "give a beamdyn.Scene, or several")
    return by_label


def _check_orders(per_rev: Iterable[int]) -> list[int]:
    """Return the orders of the per-rev lines, ascending; raise an error if one is not a whole number."""
    try:
        given = () if isinstance(per_rev, str | bytes | set | dict) else tuple(per_rev)
    except TypeError:
        raise InvalidValue("per_rev", per_rev, "give whole numbers, such as range(1, 7)") from None
    orders = [count("per_rev", n, most=_MOST_ORDERS) for n in given]
    if not orders:
        raise InvalidValue("per_rev", per_rev, "there is no order in it; give some, such as range(1, 7)")
    return sorted(set(orders))


def _check_speeds(speeds: np.ndarray | Sequence[float]) -> np.ndarray:
    given = ascending("speeds", speeds)
    if given[0] < 0:
        raise InvalidValue("speeds", float(given[0]), "a diagram begins at 0 or above", "", "rad/s")
    if len(given) < 2:
        remedy = "give a range, such as numpy.linspace(0, top, 301)"
        raise InvalidValue("speeds", float(given[0]), "a diagram needs two speeds at least", remedy, "rad/s")
    return given


def _check_operation(
    speeds: np.ndarray, rated: float | None, operating: tuple[float, float] | None
) -> tuple[float | None, tuple[float, float] | None]:
    """Return rated speed and operating range; raise an error if they exceed the speeds of the diagram."""
    if rated is not None:
        rated = _within_speeds("rated", positive("rated", rated, "rad/s"), speeds)
    if operating is None:
        return rated, None
    try:
        low, high = operating
    except (TypeError, ValueError):
        raise InvalidValue("operating", operating, "give the lowest and the highest speed") from None
    low, high = real("operating[0]", low, "rad/s"), real("operating[1]", high, "rad/s")
    if not low < high:
        bound = "it must be below the highest operating speed, {limit}"
        raise InvalidValue("operating[0]", low, bound, "", "rad/s", high)
    if rated is not None and not low <= rated <= high:
        bound = f"it must lie in the operating range, {low:.6g} to {high:.6g} {{unit}}"
        raise InvalidValue("rated", rated, bound, "", "rad/s")
    return rated, (_within_speeds("operating[0]", low, speeds), _within_speeds("operating[1]", high, speeds))


def _within_speeds(name: str, value: float, speeds: np.ndarray) -> float:
    first, top = speeds[[0, -1]].tolist()
    if value > top * (1 + _SAME):
        bound = "it is above the top speed of the diagram, {limit}"
        raise InvalidValue(name, value, bound, "give a higher top speed", "rad/s", top)
    if value < first:
        bound = "it is below the first speed of the diagram, {limit}"
        raise InvalidValue(name, value, bound, "begin at a lower speed", "rad/s", first)
    return min(value, top)


# Names, lines, warnings ---------------------------------------------------------------------------


def _name_modes(locus: Locus) -> tuple[str, ...]:
    """Name each mode by the direction in which it mostly bends at the first speed.

    A mode that is not one of bending is named by its kind, such as torsion.
    """
    words, mount = [word for _, word in name_directions(locus.scene)], locus.scene.mount
    # With a negative cosine, the beam points outward, like a blade.
    is_blade = locus.scene.physics.planes == 2 or np.cos(mount.setting_angle) < 0
    if "flap" not in words or not is_blade:
        return locus.names()
    bent = [words[0 if locus.scene.physics.planes == 1 else k] for k in locus.plane_share[0].argmax(axis=1)]
    kinds = map(str, locus.kind[0])
    chosen = [word if kind == BENDING else kind for word, kind in zip(bent, kinds, strict=True)]
    return tuple(f"{word} {chosen[: i + 1].count(word)}" for i, word in enumerate(chosen))


def _all_lines(
    orders: Sequence[int], loci: Sequence[Locus], labels: Sequence[str]
) -> tuple[list[Line], list[str]]:
    """Return per-rev lines and the motions' other lines, with warnings for motions with unknown lines."""
    per_rev, others, unknown = [Line(f"{n}P", float(n)) for n in orders], [], []
    for label, locus in zip(labels, loci, strict=True):
        try:
            # The excitation by the scene's motion and gravity has further lines.
            motion = locus.scene.motion
            system = periodic_system(locus.model.equations, motion, locus.speeds[-1:])
            others += excitation_lines(system, motion, 1)[0]
        except ValueError as error:
            unknown.append(f"{_prefix(label)}no excitation lines: {error}")
    # Of several lines with the same frequency, the first is kept.
    distinct = distinct_lines([*per_rev, *others])
    return [*per_rev, *(line for line in distinct if line not in per_rev)], unknown


def _bound(
    named: Sequence[tuple[str, Sequence[str], Locus]], speed: float
) -> tuple[list[tuple[str, FrequencyBounds]], list[str]]:
    """Compute guaranteed bounds of each scene at a speed.

    Return the bounds with the labels of their scenes; and sentences: warnings, and why other scenes have no
    bounds.
    """
    bounded, refused = [], []
    for label, names, locus in named:
        try:
            found = frequency_bounds(locus.scene, float(speed), len(names))
            bounded.append((label, found))
            refused += [after(_prefix(label), warning) for warning in found.warnings]
        except ValueError as error:
            refused.append(f"{_prefix(label)}no guaranteed bounds: {error}")
    return bounded, refused


def _warnings(named: Sequence[tuple[str, Sequence[str], Locus]], lines: Sequence[Line]) -> Iterator[str]:
    for label, names, locus in named:
        yield from (after(_prefix(label), warning) for warning in locus.warnings)
        for line, mode in line_crossings.coincident(locus, lines):
            both = f"{names[mode]} and {line.name}"
            yield f"{_prefix(label)}{both} coincide at every speed, so there is no crossing"


def _prefix(label: str) -> str:
    return label and f"{label}: "


_IN_WORDS = "not_known", "assumed", "reasons"
