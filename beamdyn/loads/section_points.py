"""Curvature, strain and stress at points of the sections, from the loads there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, positive, refuse
from beamdyn.loads.stations import SpanStations
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

SectionPoints: TypeAlias = "Sequence[Sequence[float]] | np.ndarray"

_MOST = 100
_ROUNDING = 1e-9  # relative: a point on the edge is inside


@dataclass(frozen=True)
class Sections:
    """The sections at S stations, as maps from loads to what they do there.

    Parameters
    ----------
    points : ndarray, shape (S, P, 2)
        Points of each section [m]: along its first direction, in which `bending_stiffness` counts, and along
        the second.
    curvature : ndarray, shape (S, d, 1 + 2 d)
        Curvature [1/m] in each direction of the section per load.
    strain : ndarray, shape (S, P, 1 + 2 d)
        Axial strain at the points per load.
    youngs_modulus : float
        Young's modulus [Pa]; nan if it is not known.
    notes : tuple of str
        What the strain lacks.
    """

    points: np.ndarray
    curvature: np.ndarray
    strain: np.ndarray
    youngs_modulus: float
    notes: tuple[str, ...]


def sections_at(
    scene: Scene, stations: SpanStations, points: SectionPoints | None, youngs_modulus: float | None
) -> Sections:
    """Find the sections of a scene at stations.

    Parameters
    ----------
    scene : Scene
        The scene.
    stations : SpanStations
        The S stations.
    points : sequence of (float, float), optional
        Points of every section [m]; if not given, the corners of a rectangle that bends in two planes, else
        the outer fibres, and none if the beam has no outer fibre.
    youngs_modulus : float, optional
        Young's modulus [Pa]; that of a rectangular beam if not given.

    Returns
    -------
    Sections

    Raises
    ------
    InvalidValue
        If the points are not pairs of finite numbers, or lie outside a section, or the modulus is not
        positive.
    """
    beam, rectangle = scene.modelled_beam, scene.beam.section
    half = _half_sides(scene.beam, rectangle, stations.beside)
    if points is None:
        corners = scene.physics.planes == 2 and rectangle is not None
        at_stations = _outermost(half, corners)
    else:
        at_stations = np.broadcast_to(given := _checked(points, half), (len(stations.xi), *given.shape))
    curvature = _curvature(beam, stations.beside, scene.physics.planes)
    axial = np.zeros((len(stations.xi), 1, curvature.shape[2]))
    if beam.axial_stiffness is not None:
        axial[:, 0, 0] = 1 / beam.axial_stiffness(stations.beside)
    notes = [_WITHOUT_AXIAL] if beam.axial_stiffness is None and at_stations.shape[1] else []
    bent = np.einsum("spi,sik->spk", at_stations[..., : curvature.shape[1]], curvature)
    return Sections(at_stations, curvature, axial - bent, _modulus(rectangle, youngs_modulus), (*notes,))


_WITHOUT_AXIAL = "the strain is that of bending alone: the beam has no axial_stiffness"


def _modulus(rectangle: Rectangle | None, given: float | None) -> float:
    if given is not None:
        return positive("youngs_modulus", given, "Pa")
    return np.nan if rectangle is None else rectangle.youngs_modulus


def _half_sides(beam: Beam, rectangle: Rectangle | None, xi: np.ndarray) -> np.ndarray:
    """Distances (S, 2) of the edges of the sections from their centres [m]; nan where they are not known."""
    half = np.full((len(xi), 2), np.nan)
    if beam.outer_fibre is not None:
        half[:, 0] = beam.outer_fibre(xi)
    if rectangle is not None:
        half[:, 1] = rectangle.width(xi) / 2
    return half


def _outermost(half: np.ndarray, corners: bool) -> np.ndarray:
    """Corners of the sections (S, 4, 2), or their outer fibres (S, 2, 2), or no points (S, 0, 2)."""
    if np.isnan(half[:, 0]).any():
        return np.zeros((len(half), 0, 2))
    signs = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]] if corners else [[-1, 0], [1, 0]])
    return signs * np.nan_to_num(half)[:, None]


def _checked(points: object, half: np.ndarray) -> np.ndarray:
    """Points (P, 2) that lie in every section whose edges are known."""
    array = as_floats(points)
    if array is None or array.ndim != 2 or array.shape[1] != 2 or not 1 <= len(array) <= _MOST:
        bound = f"give 1 to {_MOST} pairs: the distances from the neutral axes along the section's directions"
        raise InvalidValue("points", points, bound, "such as [(-0.001, 0.0), (0.001, 0.0)]", "m")
    if not np.isfinite(array).all():
        raise InvalidValue("points", points, "give finite numbers", unit="m")
    for side, name in enumerate(("first", "second")):
        limit = half[:, side].min()  # nan is no limit
        bad, remedy = (
            np.abs(array[:, side]) > limit * (1 + _ROUNDING),
            "leave points out: the outermost of each",
        )
        bound = f"it lies outside the section: along its {name} direction the thinnest reaches {{limit}}"
        refuse(bad, "points", array[:, side], "m", bound, remedy, limit=limit)
    return array


def _curvature(beam: Beam, xi: np.ndarray, planes: int) -> np.ndarray:
    """Curvature in each direction of the section per load, (S, d, 1 + 2 d)."""
    stiffness = [beam.bending_stiffness, beam.second_bending_stiffness][:planes]
    turned = np.zeros(len(xi)) if beam.twist is None else beam.twist(xi)
    cos, sin = np.cos(turned), np.sin(turned)
    matrix = np.zeros((len(xi), planes, 1 + 2 * planes))
    for k, EI in enumerate(stiffness):
        assert isinstance(EI, Profile)
        along = (cos, sin) if k == 0 else (-sin, cos)
        for i in range(planes):
            matrix[:, k, 1 + planes + i] = along[i] / EI(xi)
    return matrix


# All quantities as linear outputs of the loads ----------------------------------------------------

QUANTITIES = "force", "moment", "curvature", "strain", "stress"


@dataclass(frozen=True)
class StationOutputs:
    """All outputs at S stations, as linear functions of the loads there.

    Parameters
    ----------
    matrix : ndarray, shape (S, K, 1 + 2 d)
        Of K components: forces, moments, curvatures, strains and stresses, one after the other.
    sizes : tuple of int
        Number of components of each of the `QUANTITIES`.
    """

    matrix: np.ndarray
    sizes: tuple[int, ...]

    @classmethod
    def of_sections(cls, sections: Sections) -> StationOutputs:
        """Outputs of sections, stresses included: nan where Young's modulus is not known."""
        stations, planes, loads = sections.curvature.shape
        unchanged = np.broadcast_to(np.eye(loads), (stations, loads, loads))
        stress = sections.youngs_modulus * sections.strain
        forces, moments = unchanged[:, : 1 + planes], unchanged[:, 1 + planes :]
        parts = (forces, moments, sections.curvature, sections.strain, stress)
        return cls(np.concatenate(parts, axis=1), tuple(part.shape[1] for part in parts))

    @property
    def places(self) -> dict[str, slice]:
        """Components of each quantity."""
        ends = np.cumsum(self.sizes).tolist()
        return {name: slice(b - n, b) for name, n, b in zip(QUANTITIES, self.sizes, ends, strict=True)}

    def split(self, values: np.ndarray, suffix: str = "") -> dict[str, Any]:
        """The components (..., K) of each quantity, by its name and a suffix."""
        return {name + suffix: values[..., place] for name, place in self.places.items()}
