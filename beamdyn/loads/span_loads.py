"""Base of all results on loads along the span: stations, loads there, and errors of the loads.

In shapes of arrays, C counts cases (speeds or times), S stations, and K outputs at each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from time import perf_counter
from typing import Any, ClassVar, NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count, one_of
from beamdyn.common.plots.curves import plot_along_span
from beamdyn.common.results.one_line import counted, error_at_most, number, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.equations.effects import modelled_directions
from beamdyn.loads.load_rows import STRAIGHT, refuse_uncovered_camber
from beamdyn.loads.stations import (
    SHOWN,
    UNITS,
    Positions,
    SectionPoints,
    SpanStations,
    StationOutputs,
    sections_at,
    stations_at,
)
from beamdyn.modes.repeated import JudgedByRepeating
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import refuse_large_deflection, warn_of_elastic_limit

REMEDIES = {
    "strain": "give the beam an outer_fibre, or points of the section",
    "stress": "give youngs_modulus, and the beam an outer_fibre, or points of the section",
}


_JUDGED = "strain", "moment", "force"


class LoadCase(NamedTuple):
    """Name and unit of what the first axis of load arrays counts (times or speeds).

    `field` is the name of the attribute of the result that contains these times or speeds.
    """

    name: str
    unit: str
    field: str


SPEEDS = LoadCase("speed", "rad/s", "speeds")


@dataclass(frozen=True)
class LargestLoad:
    """Largest magnitude of a quantity along the span, with its position.

    Parameters
    ----------
    quantity : str
        "force", "moment", "curvature", "strain" or "stress".
    value : float
        Largest value, with its sign where that is known [N, N m, 1/m, 1, Pa].
    error : float
        Estimated error of the value [same unit].
    x : float
        Position along the beam [m].
    inboard : bool
        Whether the value occurs just inboard of the position, if the quantity jumps there.
    component : int
        Index of the direction, of the force component, or of the point of the section.
    case : float
        Time [s] or speed [rad/s].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> loads = bd.static_loads(bd.Scene(strip, bd.Mount(radius=0.215)), speeds=50.0)
    >>> loads.largest("strain").quantity
    'strain'
    """

    quantity: str
    value: float
    error: float
    x: float
    inboard: bool
    component: int
    case: float


@dataclass(frozen=True)
class SpanLoads(SceneResult, JudgedByRepeating):
    """Forces, moments, curvatures, strains and stresses at stations along the span.

    In shapes of arrays, `cases` is the number of times or speeds, S the number of stations, d the number of
    modelled planes of bending (1 or 2), and `points` the number of points of the section.  Loads are the
    forces and moments that the part of the beam outboard of a station exerts on the part inboard; moments are
    about the deflected axis.  Loads are computed from the external forces and the inertia outboard, not from
    a curvature.

    `left_out` contains the estimated relative change of the `judged_quantity`'s largest value by each
    neglected physical effect, `model_error` the magnitude of the sum of these changes; both are computed at
    first use.

    Parameters
    ----------
    x : ndarray, shape (S,)
        Stations [m].  Where the section jumps or a mass is attached, the station is repeated, the inboard
        side first.
    inboard : ndarray of bool, shape (S,)
        Whether the station is just inboard of its position.
    points : ndarray, shape (S, points, 2)
        Points of each section [m]: along its first direction, in which `bending_stiffness` counts, and along
        the second.
    force : ndarray, shape (cases, S, 1 + d)
        Axial force, tension positive, then shear force along the bending direction at the root and, with two
        planes, across it [N].
    moment : ndarray, shape (cases, S, d)
        Bending moment in each of these directions [N m], positive if it bends towards positive deflection.
    curvature : ndarray, shape (cases, S, d)
        Curvature in each direction of the section, which turns with the twist of the beam [1/m].
    strain : ndarray, shape (cases, S, points)
        Axial strain at the points.
    stress : ndarray, shape (cases, S, points)
        Axial stress at the points [Pa]; nan if Young's modulus is not known.
    force_error, moment_error, curvature_error, strain_error, stress_error : ndarray
        Estimated errors; for a transient one error for the whole run, without the first axis.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        Program version, discretization and computing time.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> loads = bd.static_loads(bd.Scene(strip, bd.Mount(radius=0.215)), speeds=50.0)
    >>> isinstance(loads, bd.SpanLoads)
    True
    """

    x: np.ndarray
    inboard: np.ndarray
    points: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    curvature: np.ndarray
    strain: np.ndarray
    stress: np.ndarray
    force_error: np.ndarray
    moment_error: np.ndarray
    curvature_error: np.ndarray
    strain_error: np.ndarray
    stress_error: np.ndarray

    case: ClassVar[LoadCase]

    def headline(self) -> Iterator[str]:
        """Yield the largest moment and strain of all cases and stations, for a one-line summary.

        See `Result.headline`.
        """
        yield f"{counted(len(self.cases), self.case.name)}, {counted(len(self.x), 'station')}"
        for name in ("moment", "strain"):
            size = np.abs(self.values(name))
            if np.isfinite(size).any() and (size != 0).any():
                yield f"{name} to {number(np.nanmax(size), UNITS[name])}"
                yield error_at_most(self.error_of(name), UNITS[name])
        yield warned(self.warnings)

    @property
    def judged_quantity(self) -> str:
        """Quantity whose model error is stated: strain or, where that is 0 or unknown, moment or force."""
        sizes = {name: np.nan_to_num(np.abs(self.values(name))).max(initial=0.0) for name in _JUDGED}
        return next((name for name, size in sizes.items() if size), _JUDGED[-1])

    @property
    def drawn_quantity(self) -> str:
        """Quantity that a plot shows by default: the moment, unless nothing bends the beam."""
        return "moment" if np.nan_to_num(self.moment).any() else self.judged_quantity

    @property
    def judged_value(self) -> str:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Name of the value for which the model error is stated, such as "the largest strain"."""
        return f"the largest {self.judged_quantity}"

    def judged(self, found: SpanLoads) -> np.ndarray:
        """Return the largest value of the `judged_quantity`, or nan if unknown: shape ()."""
        known = np.isfinite(found.values(self.judged_quantity)).any()
        return np.array(abs(found.largest(self.judged_quantity).value) if known else np.nan)

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """Arguments that limit a repeated analysis to both sides of the station of the largest value."""
        return {"at": [self.largest(self.judged_quantity).x] * 2}

    @property
    def bending_speed(self) -> float:
        """Speed [rad/s] of the largest value, at which the change by large deflection is estimated."""
        return self.largest(self.judged_quantity).case

    @property
    def cases(self) -> np.ndarray:
        """Times [s] or speeds [rad/s] that the first axis of the load arrays counts."""
        return np.atleast_1d(getattr(self, self.case.field))

    def values(self, quantity: str) -> np.ndarray:
        """Return the values of a quantity of k components by its name: (cases, stations, k)."""
        one_of("quantity", quantity, (*UNITS,))
        return getattr(self, quantity)

    def error_of(self, quantity: str) -> np.ndarray:
        """Return the error of a quantity, as an array that broadcasts against the values."""
        one_of("quantity", quantity, (*UNITS,))
        return getattr(self, f"{quantity}_error")

    def components(self, quantity: str) -> tuple[str, ...]:
        """List the names of a quantity's components."""
        one_of("quantity", quantity, (*UNITS,))
        if quantity in ("strain", "stress"):
            return tuple(f"point {k + 1}" for k in range(self.points.shape[1]))
        directions = modelled_directions(self.scene)
        if quantity == "curvature":
            return ("first direction of the section", "second direction of the section")[: len(directions)]
        return ("axial", *directions) if quantity == "force" else directions

    def largest(self, quantity: str = "strain", component: int | None = None) -> LargestLoad:
        """Find the largest magnitude of a quantity over all cases, stations and components.

        Parameters
        ----------
        quantity : {"strain", "stress", "curvature", "moment", "force"}
            The quantity.
        component : int, optional
            One component only, such as 0 of the force for the axial one.

        Returns
        -------
        LargestLoad

        Raises
        ------
        ValueError
            If there are no such values: no points of the section, or no component of that number.
        """
        chosen = self.check_component(quantity, component)
        self.check_known(quantity)
        values = self.values(quantity)[..., chosen]
        size = np.where(np.isnan(values), -1.0, np.abs(values))
        c, s, k = np.unravel_index(int(size.argmax()), size.shape)
        error = np.broadcast_to(self.error_of(quantity)[..., chosen], size.shape)[c, s, k]
        return self.located(
            quantity, float(values[c, s, k]), float(error), int(s), chosen[k], float(self.cases[c])
        )

    def station_of(self, found: LargestLoad) -> int:
        """Find the index of the station at which a value occurs."""
        return int(np.flatnonzero((self.x == found.x) & (self.inboard == found.inboard))[0])

    def check_known(self, quantity: str) -> None:
        """Refuse a quantity for which the result has no values."""
        if not np.isfinite(self.values(quantity)).any():
            remedy = REMEDIES.get(quantity, "")
            raise InvalidValue("quantity", quantity, f"the result has no {quantity}", remedy)

    def check_component(self, quantity: str, component: int | None) -> list[int]:
        """List the indices of the requested components, or refuse a component that does not exist."""
        size = self.values(quantity).shape[-1]
        return list(range(size)) if component is None else [count("component", component, 0, size - 1)]

    def located(
        self, quantity: str, value: float, error: float, station: int, component: int, case: float
    ) -> LargestLoad:
        """Combine a value with the position, component and case at which it occurs."""
        at = float(self.x[station]), bool(self.inboard[station])
        return LargestLoad(quantity, value, error, *at, component, case)

    def plot(self, ax: Axes | None = None, quantity: str = "moment") -> Axes:
        """Plot a quantity along the span: each case if there are few, else the range over all cases."""
        return self.draw(ax, quantity, self.values, with_unit(quantity))

    def draw(self, ax: Axes | None, quantity: str, values: Callable[[str], np.ndarray], label: str) -> Axes:
        """Plot values (cases, stations, components) of a quantity along the span, if the result has it."""
        self.check_known(quantity)
        named = self.components(quantity)
        scale, _ = SHOWN[quantity]
        return plot_along_span(self.x, scale * values(quantity), named, label, ax, self.display_units)


def with_unit(quantity: str) -> str:
    """Return the label of an axis: a quantity and its unit."""
    one_of("quantity", quantity, (*UNITS,))
    return f"{quantity} [{SHOWN[quantity][1]}]"


# Requests of loads --------------------------------------------------------------------------------


@dataclass(frozen=True)
class AskedLoads:
    """Request for loads along the span: the stations and the outputs there, for any kind of analysis.

    Parameters
    ----------
    scene : Scene
        The scene.
    stations : SpanStations
        The S stations.
    outputs : StationOutputs
        The K outputs at each station.
    points : ndarray, shape (S, points, 2)
        Points of the sections [m].
    notes : tuple of str
        Contributions that the strain does not include.
    start : float
        Time of the request by `time.perf_counter` [s].
    """

    scene: Scene
    stations: SpanStations
    outputs: StationOutputs
    points: np.ndarray
    notes: tuple[str, ...]
    start: float

    @classmethod
    def of(
        cls, scene: Scene, at: Positions | None, points: SectionPoints | None, youngs_modulus: float | None
    ) -> AskedLoads:
        """Check the stations, the points of sections and Young's modulus of a request."""
        refuse_large_deflection(scene, STRAIGHT)
        refuse_uncovered_camber(scene)
        start, stations = perf_counter(), stations_at(scene.modelled_beam, at)
        sections = sections_at(scene, stations, points, youngs_modulus)
        return cls(scene, stations, sections.outputs, sections.points, sections.notes, start)

    def result(
        self, values: np.ndarray, errors: np.ndarray, warnings: Iterable[str], method: str, compared_with: str
    ) -> dict[str, Any]:
        """Build the fields of a `SpanLoads` from the outputs at stations and their errors.

        The last axes of `values` and `errors` count stations and outputs.
        """
        by_quantity = self.outputs.split(values)
        return {
            "x": self.stations.xi * self.scene.beam.length,
            "inboard": self.stations.inboard,
            "points": self.points,
            "scene": self.scene,
            **by_quantity,
            **self.outputs.split(errors, "_error"),
            "warnings": (*self.notes, *warnings, *warn_of_elastic_limit(by_quantity["strain"])),
            "provenance": Provenance.since(self.start, method, compared_with),
        }
