"""Stations along the span, and the requested outputs there as linear functions of the loads.

Outputs are the loads themselves, and curvature, strain and stress at points of the sections.  The modal
truncation error follows from the distance of the loads from those of a solution with more modes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from beamdyn.accuracy.refinement import MODES_OF_FORCES, MODES_OF_MOMENTS
from beamdyn.common.inputs.checks import InvalidValue, as_floats, positive, real_array, refuse
from beamdyn.modes.modal.model import ModalBasis
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

Positions: TypeAlias = "float | Sequence[float] | np.ndarray"
SectionPoints: TypeAlias = "Sequence[Sequence[float]] | np.ndarray"

UNITS = {"force": "N", "moment": "N m", "curvature": "1/m", "strain": "", "stress": "Pa"}  # SI units
# Units in which tables and plots show loads, and factors from SI to these units.
_OF_SECTIONS = {"strain": (1e6, "1e-6"), "stress": (1e-6, "MPa")}
SHOWN = {name: (1.0, unit) for name, unit in UNITS.items()} | _OF_SECTIONS

_EVENLY = 21  # number of stations by default, in addition to both sides of each jump
_MOST, _MOST_POINTS = 1001, 100
_SAME = 1e-12  # distance, in lengths of the beam, below which a position counts as at a breakpoint
_BESIDE = 2e-12  # distance from a jump, in lengths of the beam, at which section properties are evaluated
_ROUNDING = 1e-9  # relative tolerance within which a point on the section's edge counts as inside
# Ratio of the difference between two models to the largest load along the span, above which the difference
# is no bound of the error.
_LIMIT = 0.3
_ROUNDING_OF_LOADS = 1e-12  # rounding error relative to the largest load along the span
_BETWEEN = 21  # number of further stations at which two models are compared
_WITHOUT_AXIAL = "the strain is that of bending alone: the beam has no axial_stiffness"


@dataclass(frozen=True)
class SpanStations:
    """Stations along the span: cross-sections at which the beam is cut.

    Parameters
    ----------
    xi : ndarray, shape (S,)
        Positions x/L, ascending; a repeated position stands for the two sides of a jump.
    inboard : ndarray of bool, shape (S,)
        Whether the cut is just inboard of the position, so that a mass there belongs to the part
        outboard; else it is just outboard.
    """

    xi: np.ndarray
    inboard: np.ndarray

    @property
    def beside(self) -> np.ndarray:
        """Position x/L for each station at which section properties are evaluated, on the side of the cut."""
        return np.clip(self.xi + np.where(self.inboard, -_BESIDE, _BESIDE), 0.0, 1.0)


def stations_at(beam: Beam, at: Positions | None) -> SpanStations:
    """Build stations at positions [m], or by default evenly along the beam and on both sides of jumps.

    A repeated position stands for both sides, the inboard side first; a single position stands for the
    outboard side, or at the tip for the inboard side.
    """
    ends = np.array(beam.breakpoints)
    if at is None:
        xi = np.unique(np.concatenate([_snapped(np.linspace(0, 1, _EVENLY), ends), ends]))
        xi = np.sort(np.concatenate([xi, ends[1:-1]]))
    else:
        xi = _snapped(_checked_positions(at, beam.length) / beam.length, ends)
    return SpanStations(xi, np.append(xi[1:] == xi[:-1], False) | (xi == 1))


def _checked_positions(at: Positions, length: float) -> np.ndarray:
    """Check that positions [m] ascend along the beam, each occurring at most twice."""
    array = as_floats(at)
    x = real_array("at", array.reshape(1) if array is not None and not array.ndim else at)
    if not 1 <= len(x) <= _MOST:
        raise InvalidValue("at", at, f"give 1 to {_MOST} positions along the beam", unit="m")
    outside = (x < 0) | (x > length * (1 + _SAME))
    refuse(outside, "at", x, "m", "stations must lie from the root, 0, to the tip, {limit}", limit=length)
    refuse(np.diff(x, prepend=0.0) < 0, "at", x, "m", "positions must ascend", "sort them")
    again = np.zeros(len(x), dtype=bool)
    again[2:] = x[2:] == x[:-2]
    bound = "a position may be given once, for one side, or twice for both sides"
    refuse(again, "at", x, "m", bound, "give it no more than twice")
    return x


def _snapped(xi: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Move positions that are within rounding of a breakpoint exactly to it."""
    nearest = ends[np.abs(xi[:, None] - ends).argmin(axis=1)]
    return np.where(np.abs(xi - nearest) <= _SAME, nearest, xi)


# Outputs at the stations --------------------------------------------------------------------------


@dataclass(frozen=True)
class StationOutputs:
    """All outputs at S stations, as linear functions of the loads there.

    Parameters
    ----------
    matrix : ndarray, shape (S, K, 1 + 2 d)
        The K outputs (forces, moments, curvatures, strains and stresses, one after the other) per unit of
        each load: axial force, d shear forces, d bending moments.  Where sections camber, the moment of
        camber is one more load, (S, K, 2 + 2 d).
    sizes : tuple of int
        Number of components of each quantity.
    """

    matrix: np.ndarray
    sizes: tuple[int, ...]

    @property
    def places(self) -> dict[str, slice]:
        """Slice of each quantity's components among all outputs, by the quantity's name."""
        ends = np.cumsum(self.sizes).tolist()
        return {name: slice(b - n, b) for name, n, b in zip(UNITS, self.sizes, ends, strict=True)}

    def split(self, values: np.ndarray, suffix: str = "") -> dict[str, Any]:
        """Split K components (..., K) by quantity, each under its name with a suffix."""
        return {name + suffix: values[..., place] for name, place in self.places.items()}


class Sections(NamedTuple):
    """Sections at S stations: their outputs, and P points in each section at which strain is computed.

    `points` has the shape (S, P, 2) [m]; `notes` name contributions that the strain does not include.
    """

    outputs: StationOutputs
    points: np.ndarray
    notes: tuple[str, ...]


def sections_at(
    scene: Scene,
    stations: SpanStations,
    points: SectionPoints | None = None,
    youngs_modulus: float | None = None,
) -> Sections:
    """Build the outputs of the sections of a scene at S stations.

    Parameters
    ----------
    scene : Scene
        The scene.
    stations : SpanStations
        The stations.
    points : sequence of (float, float), optional
        Points of every section [m], along its first direction, in which `bending_stiffness` counts, and along
        the second; if not given, the corners of a rectangle that bends in two planes, else the outer fibres,
        and none if the beam has no outer fibre.
    youngs_modulus : float, optional
        Young's modulus [Pa]; that of a rectangular beam if not given, and stresses are nan if there is none.

    Returns
    -------
    Sections

    Raises
    ------
    InvalidValue
        If the points are not pairs of finite numbers, or lie outside a section, or the modulus is not
        positive.
    """
    beam, rectangle, xi = scene.modelled_beam, scene.beam.section, stations.beside
    planes = scene.physics.planes
    half = np.full((len(xi), 2), np.nan)  # distances of the edges from the centre, where they are known
    if scene.beam.outer_fibre is not None:
        half[:, 0] = scene.beam.outer_fibre(xi)
    if rectangle is not None:
        half[:, 1] = rectangle.width(xi) / 2
    if points is not None:
        at_stations = np.broadcast_to(given := _checked_points(points, half), (len(xi), *given.shape))
    elif np.isnan(half[:, 0]).any():
        at_stations = np.zeros((len(xi), 0, 2))
    else:
        corners = planes == 2 and rectangle is not None
        signs = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]] if corners else [[-1, 0], [1, 0]])
        at_stations = signs * np.nan_to_num(half)[:, None]
    curvature = of_free = _curvature(beam, xi, planes)
    if scene.physics.camber:
        assert rectangle is not None, "camber of layers is refused beforehand"
        curvature = _with_camber(curvature, rectangle, beam.length, xi)
        of_free = np.concatenate([of_free, np.zeros((*of_free.shape[:2], 1))], axis=2)
    modulus = np.nan if rectangle is None else rectangle.modulus_of_stress
    if youngs_modulus is not None:
        modulus = positive("youngs_modulus", youngs_modulus, "Pa")
    loads = curvature.shape[2]
    axial = np.zeros((len(xi), 1, loads))
    if beam.axial_stiffness is not None:
        axial[:, 0, 0] = 1 / beam.axial_stiffness(xi)
    # The clamp hinders the strain across the width and so stiffens the section.  This reduces the curvature
    # and the strain, but not the stress: the stress follows from the curvature without the clamp's effect.
    strain, strain_by_stress = (
        axial - np.einsum("spi,sik->spk", at_stations[..., :planes], each) for each in (curvature, of_free)
    )
    unchanged = np.broadcast_to(np.eye(loads), (len(xi), loads, loads))
    parts = (
        unchanged[:, : 1 + planes],
        unchanged[:, 1 + planes : 1 + 2 * planes],
        curvature,
        strain,
        modulus * strain_by_stress,
    )
    outputs = StationOutputs(np.concatenate(parts, axis=1), tuple(part.shape[1] for part in parts))
    lacks_axial = beam.axial_stiffness is None and at_stations.shape[1]
    return Sections(outputs, at_stations, (_WITHOUT_AXIAL,) if lacks_axial else ())


def _checked_points(points: object, half: np.ndarray) -> np.ndarray:
    """Check that P points (P, 2) are inside every section whose edges are known."""
    array = as_floats(points)
    if array is None or array.ndim != 2 or array.shape[1] != 2 or not 1 <= len(array) <= _MOST_POINTS:
        pairs = f"1 to {_MOST_POINTS} pairs"
        bound = f"give {pairs} of distances from the neutral axes, along the section's two directions"
        raise InvalidValue("points", points, bound, "such as [(-0.001, 0.0), (0.001, 0.0)]", "m")
    if not np.isfinite(array).all():
        raise InvalidValue("points", points, "give finite numbers", unit="m")
    for side, name in enumerate(("first", "second")):
        limit = half[:, side].min()  # nan: the section's edge is not known
        bad = np.abs(array[:, side]) > limit * (1 + _ROUNDING)
        bound = f"it lies outside the section: the smallest section reaches {{limit}} in the {name} direction"
        remedy = "leave {field} out, for the outermost points"
        refuse(bad, "points", array[:, side], "m", bound, remedy, limit=limit)
    return array


def _curvature(beam: Beam, xi: np.ndarray, planes: int) -> np.ndarray:
    """Compute the curvature in each direction of the section per unit load: shape (S, d, 1 + 2 d).

    The loads at S stations are the axial force, then d transverse forces, then d moments.
    """
    turned = np.zeros(len(xi)) if beam.twist is None else beam.twist(xi)
    cos, sin = np.cos(turned), np.sin(turned)
    matrix = np.zeros((len(xi), planes, 1 + 2 * planes))
    stiffness = (beam.bending_stiffness, beam.second_bending_stiffness)[:planes]
    for k, (EI, along) in enumerate(zip(stiffness, ((cos, sin), (-sin, cos)), strict=False)):
        assert isinstance(EI, Profile)
        for i in range(planes):
            matrix[:, k, 1 + planes + i] = along[i] / EI(xi)
    return matrix


def _with_camber(curvature: np.ndarray, section: Rectangle, length: float, xi: np.ndarray) -> np.ndarray:
    """Compute the mean curvature per unit load and unit moment of camber, at each station.

    The bending moment is E I/(1 - nu^2) times the curvature, plus the moment of camber.
    """
    stiffening = section.camber_stiffening, section.stiffening_across(length)
    held = np.stack([each(xi) for each, _ in zip(stiffening, curvature[0], strict=False)], axis=1)
    curvature = curvature / held[:, :, None]
    by_camber = np.zeros((*curvature.shape[:2], 1))
    by_camber[:, 0, 0] = -curvature[:, 0, 1 + curvature.shape[1]]
    return np.concatenate([curvature, by_camber], axis=2)


# Modal truncation error ---------------------------------------------------------------------------


def with_neighbours(stations: SpanStations) -> SpanStations:
    """Append evenly spaced stations to the given ones: two models are compared at all of them."""
    more = np.linspace(0, 1, _BETWEEN)
    return SpanStations(np.append(stations.xi, more), np.append(stations.inboard, more == 1))


def mode_error(
    distance: np.ndarray,
    along_span: np.ndarray,
    stations: SpanStations,
    outputs: StationOutputs,
    basis: ModalBasis,
    length: float,
) -> np.ndarray:
    """Estimate the errors of outputs, including rounding, from the differences of loads between two models.

    At the nodes of the modes that a larger model adds, the distance is small by chance, although other modes
    left out contribute.  So the error at a station follows from the largest distance within half
    a wavelength of the first mode left out, to either side.

    Parameters
    ----------
    distance : ndarray, shape (..., N, 1 + 2 d)
        Distance of the loads from those of more modes, at the N stations of `with_neighbours`.
    along_span : ndarray, shape (..., 1 + 2 d)
        Largest magnitude of the loads along the span.
    stations : SpanStations
        The S stations asked for.
    outputs : StationOutputs
        The K outputs at each station.
    basis : ModalBasis
        The modes kept.
    length : float
        Length of the beam [m].

    Returns
    -------
    ndarray, shape (..., S, K)
        Infinite where the distance exceeds 0.3 of the largest value along the span plus the rounding error:
        then it does not bound the error.
    """
    modes = np.inf if basis.modes is None else basis.modes  # number of modes of each field
    near = np.abs(stations.xi[:, None] - with_neighbours(stations).xi) <= 1 / (modes + 0.5)
    nearby = np.where(near[..., None], distance[..., None, :, :], 0.0).max(axis=-2)
    loads = distance.shape[-1]
    planes = (loads - 1) // 2
    of_moments = loads - 1 - planes  # moments, including that of camber, if there is one
    factors = MODES_OF_MOMENTS.factor, MODES_OF_FORCES.factor, MODES_OF_MOMENTS.factor
    margins = np.repeat(factors, [1, planes, of_moments])
    # The rounding error of moments is relative also to the largest force times the length of the beam.
    force = along_span[..., : 1 + planes].max(axis=-1, keepdims=True)
    moment = np.maximum(along_span[..., 1 + planes :].max(axis=-1, keepdims=True), length * force)
    both = [np.repeat(force, 1 + planes, axis=-1), np.repeat(moment, of_moments, axis=-1)]
    rounding = through(outputs, (_ROUNDING_OF_LOADS * np.concatenate(both, axis=-1))[..., None, :])
    too_large = through(outputs, nearby) > _LIMIT * through(outputs, along_span[..., None, :]) + rounding
    return np.where(too_large, np.inf, through(outputs, margins * nearby) + rounding)


def through(outputs: StationOutputs, errors: np.ndarray) -> np.ndarray:
    """Convert errors of 1 + 2 d loads at S stations to errors of K outputs: shape (..., S, K).

    The errors of the loads add up by magnitude in each output.
    """
    weights = np.abs(outputs.matrix)
    with np.errstate(invalid="ignore"):  # an infinite error times 0 counts as 0
        return np.where(weights != 0, weights * errors[..., None, :], 0.0).sum(axis=-1)
