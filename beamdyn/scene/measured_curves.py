"""Measured or independently computed data: histories, peaks, loads along the span, frequency responses.

In shapes of arrays, n counts abscissae, and C curves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs import checks
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.one_line import counted
from beamdyn.common.results.snapshots import ReadOnlyArrays
from beamdyn.scene.measured_frequencies import set_doubts, table_of


@dataclass(frozen=True)
class MeasuredCurves(ReadOnlyArrays):
    """Base class of measured values over time, speed, position or frequency.

    Attributes
    ----------
    along : tuple of str
        Name of the abscissa over which the values are given, and its unit.
    """

    along: ClassVar[tuple[str, str]]

    @property
    def x(self) -> np.ndarray:
        """Abscissa of the data: times [s], speeds [rad/s], positions [m] or frequencies [Hz]."""
        return getattr(self, self.along[0])

    @property
    def columns(self) -> np.ndarray:
        """The measured values, one column for each name."""
        return getattr(self, "value")  # noqa: B009  (of subclasses)

    @property
    def allowance(self) -> np.ndarray:
        """Tolerance of each value: half a unit of the last digit plus twice the uncertainty."""
        spread = np.asarray(getattr(self, "uncertainty"))  # noqa: B009  (of subclasses)
        return self.half_digits + 2 * np.nan_to_num(spread).reshape(self.columns.shape)

    @property
    def half_digits(self) -> np.ndarray:
        """Half a unit of the last digit of each value, in columns."""
        return np.asarray(getattr(self, "rounding")).reshape(self.columns.shape)  # noqa: B009

    def _check_columns(self, given: Any, names: Sequence[str], units: dict[str, str]) -> None:
        """Check values, their names and uncertainties, store them, and make all arrays read-only."""
        names = checks.several("names", names, str, "give names in a list")
        if not names:
            raise InvalidValue("names", names, "it is empty", f"give {', '.join(units)}")
        for name in names:
            checks.one_of("names", name, (*units,))
        if len(set(names)) < len(names):
            raise InvalidValue("names", names, "one stands twice", "give each column a name of its own")
        array = checks.as_floats(given)
        values = table_of("value", given if array is None or array.ndim != 1 else array[:, None])
        if values.shape != (len(self.x), len(names)) or not np.isfinite(values).all():
            bound = f"it must have {len(self.x)} rows of {len(names)} finite values, one per name"
            raise InvalidValue("value", given, bound, "give one row per abscissa and one name per column")
        checks.kind("source", getattr(self, "source", ""), str)
        checks.set_fields(self, value=values, names=names)
        set_doubts(self, values, "")
        super().__post_init__()


@dataclass(frozen=True)
class MeasuredHistory(MeasuredCurves):
    """Deflections, strain or moments over time, from a laboratory or another program.

    Parameters
    ----------
    time : array-like, shape (n,)
        Times [s], ascending, counted from the beginning of the scene's motion.
    value : array-like, shape (n,) or (n, C)
        The values [m, N m, or a plain number for strain], one column for each name.
    names : sequence of str, shape (C,)
        Quantities in the columns: "tip", "tip across", "root moment", "root moment across" or "root strain".
    uncertainty : float or array-like, broadcast to (n, C)
        Standard uncertainties [unit of the value]; nan where they are not known.
    rounding : float or array-like, broadcast to (n, C)
        Half a unit of the last digit that was written down [unit of the value].
    source : str
        Where the values come from, such as the name of a file.

    Raises
    ------
    ValueError
        If times do not ascend, or the shape of the values does not fit times and names.

    Examples
    --------
    >>> bd.MeasuredHistory([0.0, 0.1, 0.2], [0.0, 1e-3, -1e-3]).value.shape
    (3, 1)
    """

    time: Any
    value: Any
    names: Sequence[str] = ("tip",)
    uncertainty: Any = np.nan
    rounding: Any = 0.0
    source: str = ""

    along: ClassVar[tuple[str, str]] = ("time", "s")
    units: ClassVar[dict[str, str]] = {
        "tip": "m",
        "tip across": "m",
        "root moment": "N m",
        "root moment across": "N m",
        "root strain": "",
    }

    def __post_init__(self) -> None:
        time = checks.ascending("time", self.time)
        checks.refuse(
            time < 0, "time", time, "s", "it counts from the beginning of the motion", "give 0 or more"
        )
        checks.set_fields(self, time=time)
        self._check_columns(self.value, self.names, self.units)


@dataclass(frozen=True)
class MeasuredPeaks(MeasuredCurves):
    """Largest tip deflection in a time window, at some speeds, from a laboratory or another program.

    Parameters
    ----------
    speed : array-like, shape (n,)
        Final speeds of the scene's motion [rad/s], ascending.
    value : array-like, shape (n,) or (n, 1)
        Largest |tip deflection| in the window [m].
    window : array-like, shape (2,)
        Beginning and end of the window [s], counted from the beginning of the motion.
    names : sequence of str, shape (1,)
        Quantity in the column: "largest tip".
    uncertainty : float or array-like, broadcast to (n, 1)
        Standard uncertainties [m]; nan where they are not known.
    rounding : float or array-like, broadcast to (n, 1)
        Half a unit of the last digit that was written down [m].
    source : str
        Where the values come from, such as the name of a file.

    Raises
    ------
    ValueError
        If speeds do not ascend, the window does not end after it begins, or the shape of the values does not
        fit the speeds.

    Examples
    --------
    >>> bd.MeasuredPeaks([55.0], [1.94e-3], window=(20.0, 30.0)).value.shape
    (1, 1)
    """

    speed: Any
    value: Any
    window: Any
    names: Sequence[str] = ("largest tip",)
    uncertainty: Any = np.nan
    rounding: Any = 0.0
    source: str = ""

    along: ClassVar[tuple[str, str]] = ("speed", "rad/s")
    units: ClassVar[dict[str, str]] = {"largest tip": "m"}

    def __post_init__(self) -> None:
        window = checks.ascending("window", self.window)
        if len(window) != 2:
            raise InvalidValue("window", self.window, "it has a beginning and an end", "give two times", "s")
        checks.set_fields(self, speed=checks.ascending("speed", self.speed), window=window)
        self._check_columns(self.value, self.names, self.units)


@dataclass(frozen=True)
class MeasuredLoads(MeasuredCurves):
    """Moments and forces along the span in equilibrium at a speed, from a laboratory or another program.

    Parameters
    ----------
    position : array-like, shape (n,)
        Distances from the root [m], ascending; a repeated distance stands for both sides of a jump.
    value : array-like, shape (n,) or (n, C)
        The loads [N m or N], one column for each name, with the signs of `SpanLoads`.
    names : sequence of str, shape (C,)
        Quantities in the columns: "moment", "moment across", "shear", "shear across" or "axial".
    speed : float, optional
        Speed [rad/s]; if not given, the final speed of the scene's motion, or at rest without one.
    uncertainty : float or array-like, broadcast to (n, C)
        Standard uncertainties [unit of the value]; nan where they are not known.
    rounding : float or array-like, broadcast to (n, C)
        Half a unit of the last digit that was written down [unit of the value].
    source : str
        Where the values come from, such as the name of a file.

    Raises
    ------
    ValueError
        If positions descend, or the shape of the values does not fit positions and names.

    Examples
    --------
    >>> bd.MeasuredLoads([0.0, 0.025], [0.47, 0.26], ["axial"], speed=50.0).value.shape
    (2, 1)
    """

    position: Any
    value: Any
    names: Sequence[str] = ("moment",)
    speed: float | None = None
    uncertainty: Any = np.nan
    rounding: Any = 0.0
    source: str = ""

    along: ClassVar[tuple[str, str]] = ("position", "m")
    units: ClassVar[dict[str, str]] = {
        "moment": "N m",
        "moment across": "N m",
        "shear": "N",
        "shear across": "N",
        "axial": "N",
    }

    def __post_init__(self) -> None:
        position = checks.real_array("position", self.position)
        if not position.size:
            raise InvalidValue("position", self.position, "it is empty", "give at least one value")
        checks.refuse(
            np.diff(position, prepend=0.0) < 0, "position", position, "m", "positions ascend from 0"
        )
        checks.set_fields(self, position=position, speed=_speed(self.speed))
        self._check_columns(self.value, self.names, self.units)


@dataclass(frozen=True)
class MeasuredResponse(MeasuredCurves):
    """A frequency response at a steady speed, from a laboratory or another program.

    Parameters
    ----------
    frequency : array-like, shape (n,)
        Frequencies of the excitation [Hz], ascending.
    magnitude : array-like, shape (n,)
        Amplitude of the output per unit of the input [SI].
    phase : array-like, shape (n,), optional
        Phase by which the output leads the input [rad]; without it magnitudes alone are compared.
    output, input : str
        Observed quantity and excitation of the beam, by their names in `frequency_response`.
    speed : float, optional
        Speed [rad/s]; if not given, the final speed of the scene's motion, or at rest without one.
    uncertainty : float or array-like, broadcast to (n,)
        Standard uncertainties of the amplitude [SI]; nan where they are not known.
    rounding : float or array-like, broadcast to (n,)
        Half a unit of the last digit of the amplitude that was written down [SI].
    source : str
        Where the values come from, such as the name of a file.

    Raises
    ------
    ValueError
        If frequencies do not ascend, an amplitude is negative, or there is not one for each frequency.

    Examples
    --------
    >>> bd.MeasuredResponse([50.0, 60.0], [1e-5, 3e-5]).columns.shape
    (2, 1)
    """

    frequency: Any
    magnitude: Any
    phase: Any = None
    output: str = "tip"
    input: str = "bending"
    speed: float | None = None
    uncertainty: Any = np.nan
    rounding: Any = 0.0
    source: str = ""

    along: ClassVar[tuple[str, str]] = ("frequency", "Hz")

    def __post_init__(self) -> None:
        given = {"frequency": checks.ascending("frequency", self.frequency)}
        given["magnitude"] = checks.real_array("magnitude", self.magnitude)
        if self.phase is not None:
            given["phase"] = checks.real_array("phase", self.phase)
        for name, value in given.items():
            if len(value) != len(given["frequency"]):
                frequencies = counted(len(given["frequency"]), "frequency", "frequencies")
                bound = f"there are {len(value)} for {frequencies}"
                raise InvalidValue(name, value, bound, "give one for each frequency")
        size = given["magnitude"]
        checks.refuse(
            size < 0, "magnitude", size, "", "an amplitude is 0 or more", "put the sign into the phase"
        )
        for name in ("output", "input", "source"):
            checks.kind(name, getattr(self, name), str)
        checks.set_fields(self, **given, speed=_speed(self.speed))
        set_doubts(self, size, "")
        super().__post_init__()

    @property
    def names(self) -> tuple[str, ...]:
        """Name of the single column, such as "tip by tip force"."""
        return (f"{self.output} by {self.input}",)

    @property
    def columns(self) -> np.ndarray:
        """The response as one column: complex where the phase is known."""
        turned = self.magnitude if self.phase is None else self.magnitude * np.exp(1j * self.phase)
        return turned[:, None]


def _speed(given: float | None) -> float | None:
    """Check the speed of the data [rad/s]; None stands for the speed of the scene."""
    return None if given is None else checks.real("speed", given, "rad/s")
