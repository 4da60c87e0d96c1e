"""Result of a sensitivity analysis: derivatives of results with respect to the numbers of the scene.

In shapes of arrays, n counts inputs (numbers of the scene), and k results.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from scipy.optimize import linear_sum_assignment

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.plots.curves import plot_bars
from beamdyn.common.results.one_line import counted, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.words import InputName
from beamdyn.modes.repeated import JudgedByRepeating
from beamdyn.scene.beam import ANGLE_UNITS, OFFSETS, PROPERTY_UNITS, Beam
from beamdyn.scene.numbers import SCALE, SPEED, number_at, paths_of, unit_of
from beamdyn.scene.profile import mean
from beamdyn.scene.rectangle import SECTION_UNITS, SIDES
from beamdyn.scene.scene import Scene, SceneResult

_TOUCHING = 1e-6  # distance between two points, over the length, below which they touch
_STEP = 0.01  # step of a number, as a fraction of its value or of the typical size of its kind
# Ratio of the number of modes to that of the result, when the analysis is repeated for another scene: so each
# mode of the result has a counterpart.
_FURTHER = 2
_SAME = 0.2  # relative distance below which results of two scenes may belong to the same mode
# Smallest similarity of a name that is proposed for a mistyped one: many names have the same beginning.
_NEAR = 0.8
_ACROSS = "beam.tip.offset_across"
_OF_OFFSETS = tuple(f"beam.{name}" for name in OFFSETS)
_COUPLING = "harvester.d31", "harvester.e31"  # electromechanical coupling constants, which may be negative
_ENDS = "harvester.start", "harvester.end"
_OF_LOAD = "harvester.resistance", "harvester.strain_limit"  # numbers without effect on natural modes


@dataclass(frozen=True)
class SceneNumber:
    """Number of a scene, with its value and the step for its derivative.

    Parameters
    ----------
    name : str
        Name of the number in scene files, such as "beam.thickness"; "beam.scale.mass_per_length" is a factor
        of a property that varies along the beam.
    unit : str
        SI unit of the number.
    value : float
        Value of the number [unit].
    step : float
        Largest change within which the equations are evaluated for a derivative [unit].
    least : float
        Smallest allowed value [unit].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> number = bd.frequency_sensitivities(bd.Scene(strip), modes=1, inputs=["beam.density"]).inputs[0]
    >>> number.name, number.value
    ('beam.density', 7850.0)
    """

    name: str
    unit: str
    value: float
    step: float
    least: float = -math.inf


def check_names(inputs: object) -> tuple[str, ...] | None:
    """Check the names of numbers given to an analysis; None means all numbers."""
    if inputs is None:
        return None
    good = isinstance(inputs, list | tuple) and inputs and all(isinstance(name, str) for name in inputs)
    if not good:
        raise InvalidValue("inputs", inputs, 'give names in a list, such as ["beam.thickness"]')
    assert isinstance(inputs, list | tuple)
    return tuple(dict.fromkeys(inputs))


def numbers_of(
    scene: Scene, names: Sequence[str] | None = None, argument: str = "inputs"
) -> tuple[SceneNumber, ...]:
    """Return the numbers of a scene: all, or those with the given names.

    Raises
    ------
    InvalidValue
        If the scene has no number of a given name.
    """
    found = {each.name: each for each in _all(scene)}
    if names is None:
        return tuple(found.values())
    for name in names:
        if name == "speed":
            bound = "a critical or resonance speed is a result, not an input"
            raise InvalidValue(argument, name, bound, "leave it out")
        if name not in found:
            near = difflib.get_close_matches(str(name), found, n=1, cutoff=_NEAR)
            remedy = f"give {near[0] if near else ', '.join(found)}"
            raise InvalidValue(argument, name, "it is no number of this scene", remedy)
    return tuple(found[name] for name in names)


def _all(scene: Scene) -> Iterator[SceneNumber]:
    """Yield the numbers on which frequencies depend.

    A property that varies along the beam is represented by its factor.
    """
    for path in paths_of(scene):
        value = _value_of(scene, path)
        if value is None or not _matters(scene, path, value):
            continue
        varies = math.isnan(value)
        if path != "beam.twist" or not varies:
            yield _number(scene, path.replace("beam.", SCALE) if varies else path, 1.0 if varies else value)


def _value_of(scene: Scene, path: str) -> float | None:
    """Return the value of the number at a path; nan if it varies along the beam.

    None if the scene has no such number, the physics does not model it, or it follows from other numbers.
    """
    name = path.removeprefix("beam.")
    if name in SECTION_UNITS:
        return number_at(scene, path) if _follows_from_section(scene) else None
    if name in PROPERTY_UNITS or name in ANGLE_UNITS:
        unused = {"outer_fibre"} if scene.physics.stretch else {"outer_fibre", "axial_stiffness"}
        follows = name not in ANGLE_UNITS and _follows_from_section(scene)
        if follows or name in unused or getattr(scene.modelled_beam, name) is None:
            return None
    return number_at(scene, path)


def _follows_from_section(scene: Scene) -> bool:
    """Return whether numbers of the section stand for the properties: of constant sides, or under layers."""
    return scene.beam.electrodes is not None or not any(
        math.isnan(number_at(scene, f"beam.{side}") or math.nan) for side in SIDES
    )


def _matters(scene: Scene, path: str, value: float) -> bool:
    """Return whether natural frequencies depend on the number of a scene at a path.

    They do not if the number is infinite, belongs to the motion, to gravity or to a load, or to an effect
    that the scene does not model; factors of properties ("beam.scale.") are not counted either.
    """
    table, _, key = path.partition(".")
    if (
        table in ("motion", "tip_load", SPEED)
        or path.startswith(SCALE)
        or path == "model.gravity"
        or math.isinf(value)
    ):
        return False
    if table == "damping" or key in ("damping_ratio", "precone"):
        return value != 0
    if path in _OF_LOAD:
        return False
    if path == _ACROSS:
        return scene.beam.tip is not None and scene.modelled_beam.torsion_stiffness is not None
    if key.startswith("tip."):
        return scene.beam.tip is not None
    if path.endswith("].position"):
        return _room_of(scene.beam, path) > 0
    return (key != "poissons_ratio" or scene.physics.shear) and (
        key != "second_root_stiffness" or scene.physics.planes == 2
    )


def _number(scene: Scene, path: str, value: float) -> SceneNumber:
    """Describe the input at a path, with the step for its derivative.

    The step is 1 % of the value or, if larger, of a typical magnitude, such as the beam's length; 0.01 for
    angles [rad] and Poisson's ratio; for positions of point masses and springs, the distance that
    `_room_of` returns.
    """
    unit, beam, step = unit_of(path) or "", scene.beam, _STEP * abs(value)
    if unit == "rad" or path == "beam.poissons_ratio":
        return SceneNumber(path, unit, value, _STEP)
    if path.endswith("].position"):
        return SceneNumber(path, unit, value, _room_of(beam, path), 0.0)
    if path.startswith(("mount.", "beam.tip.", "beam.point_")) or path in (*_OF_OFFSETS, *_ENDS):
        mass, bending = mean(beam.mass_per_length) * beam.length, mean(beam.bending_stiffness)
        sizes = {"m": beam.length, "kg": mass, "kg m2": mass * beam.length**2}
        sizes |= {"N m/rad": bending / beam.length, "N/m": bending / beam.length**3}
        step = _STEP * max(abs(value), sizes[unit])
    of_any_sign = ("beam.tip.offset", _ACROSS, *_OF_OFFSETS, *_COUPLING)
    return SceneNumber(path, unit, value, step, -math.inf if path in of_any_sign else 0.0)


def _room_of(beam: Beam, path: str) -> float:
    """Return how far [m] a point mass or spring may move along the beam for a derivative.

    It is 0 if another point, a breakpoint of the section or an end of the beam is at the same position.
    """
    field = "point_masses" if "point_mass" in path else "point_springs"
    points, k = getattr(beam, field), int(path.partition("[")[2].partition("]")[0])
    others = replace(beam, **{field: [*points[:k], *points[k + 1 :]]}).breakpoints
    apart = min(abs(points[k].position - xi * beam.length) for xi in others)
    return min(_STEP / 10 * beam.length, apart / 3) if apart > _TOUCHING * beam.length else 0.0


# Result of a sensitivity analysis --------------------------------------------------------------------


@dataclass(frozen=True)
class Sensitivities(SceneResult, JudgedByRepeating):
    """Derivatives of k results with respect to n numbers of a scene.

    `left_out` contains the estimated relative change, by each neglected physical effect, of the derivative of
    each result with respect to its most important number, `model_error` (k,) the magnitude of the sum of
    these changes; both are computed at first use.

    Parameters
    ----------
    answers : tuple of str
        Name of each result, such as "mode 1", shape (k,).
    unit : str
        Unit of the results.
    value : ndarray, shape (k,)
        Values of the results [unit].
    inputs : tuple of SceneNumber
        The numbers, each with its `name`, `unit` and `value`, shape (n,).
    derivative : ndarray, shape (n, k)
        Derivative of each result with respect to each number [unit / unit of the number]; nan if there is
        none (see `warnings`).
    error : ndarray, shape (n, k)
        Estimated absolute error of the derivative [same unit].
    warnings : tuple of str
        Missing derivatives with the reason; warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.frequency_sensitivities(bd.Scene(strip), modes=2, inputs=["beam.density"])
    >>> found.relative.round(6)
    array([[-0.5, -0.5]])
    """

    answers: tuple[str, ...]
    unit: str
    value: np.ndarray
    inputs: tuple[SceneNumber, ...]
    derivative: np.ndarray
    error: np.ndarray
    speed: float = field(default=0.0, repr=False, metadata=ADDED_LATER)

    def headline(self) -> Iterator[str]:
        """Yield numbers of results and inputs, and the most important input, for the one-line summary.

        See `Result.headline`.
        """
        yield f"{counted(len(self.answers), 'answer')}, derivatives by {counted(len(self.inputs), 'number')}"
        if self.derivative.size and np.isfinite(self.relative).any():
            size = np.nan_to_num(np.abs(self.relative))
            most = np.unravel_index(int(size.argmax()), size.shape)
            yield f"largest by {self.inputs[most[0]].name}: relative derivative {number(self.relative[most])}"
        yield warned(self.warnings)

    @property
    def relative(self) -> np.ndarray:
        """Relative change of each result over that of each number, shape (n, k).

        It is 3 if the result is proportional to the cube of the number, and 0 if the number is 0.
        """
        return self.derivative * np.array([each.value for each in self.inputs])[:, None] / self.value

    follows_stiffness: ClassVar[bool] = False
    judged_value = "the largest derivatives"
    counted = "answer"

    @property
    def most_important(self) -> tuple[str, ...]:
        """Name of the number with the largest relative effect on each result."""
        size = np.nan_to_num(np.abs(self.relative), nan=-1.0)
        return tuple(self.inputs[row].name for row in size.argmax(axis=0).tolist())

    def judged(self, found: Sensitivities) -> np.ndarray:
        """Return the derivatives, shape (k,), whose model error is stated, from the result `found`.

        Each is the derivative of a result with respect to its most important number.  `found` is the analysis
        of another scene; the derivative is nan where it lacks the result.
        """
        rows = {each.name: i for i, each in enumerate(found.inputs)}
        most = zip(self._same_answers(found).tolist(), self.most_important, strict=True)
        return np.array([np.nan if k < 0 else found.derivative[rows[name], k] for k, name in most])

    def _same_answers(self, found: Sensitivities) -> np.ndarray:
        """Return, for each result, the index of the nearest result in another scene's analysis.

        The index is -1 if none is near.  Modes that an effect adds may be between the others.
        """
        apart = np.abs(found.value / self.value[:, None] - 1)
        near = np.where(np.isfinite(apart), np.minimum(apart, 1.0), 1.0)
        rows, columns = linear_sum_assignment(near)
        same = np.full(len(self.value), -1)
        same[rows] = np.where(near[rows, columns] <= _SAME, columns, -1)
        return same

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """Arguments with which the analysis is repeated: the most important numbers, and more modes."""
        numbers = {"inputs": [*dict.fromkeys(self.most_important)]}
        return numbers | ({"modes": _FURTHER * len(self.answers)} if self.unit == "Hz" else {})

    @property
    def bending_speed(self) -> float:
        """Speed [rad/s] at which the change by large deflection is estimated.

        It is the speed of the frequencies, or the largest critical or resonance speed.
        """
        return self.speed if self.unit == "Hz" else float(np.nanmax(self.value, initial=0.0))

    def by(self, name: str) -> np.ndarray:
        """Return the derivatives with respect to the number of a given name, shape (k,).

        Raises
        ------
        ValueError
            If there is no number of this name.
        """
        names = [each.name for each in self.inputs]
        if name not in names:
            raise ValueError(f"{name!r} is none of the numbers: give one of {', '.join(names)}")
        return self.derivative[names.index(name)]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the relative change of each result over that of each number, the most important on top."""
        names = [InputName(each.name).on_form for each in self.inputs]
        return plot_bars(names, self.relative, self.answers, "relative change over that of the number", ax)
