"""Designs that differ in numbers only: one beam with other tip bodies, radii, angles and speeds.

Beams of one shape, whose mass per length, stiffness and length are s_m, s_k and s_L times a reference's,
vibrate as the reference does with the tip body's mass over s_m s_L, its moments of inertia over s_m s_L^3,
offset and radius over s_L, and the speed times

    T = sqrt(s_m s_L^4 / s_k);

its frequencies over T are theirs.  In one plane of bending the matrices of the reference are polynomials of
few quantities: linear in the mass of the body, its inertia J_n, (J_e - J_1)/J_n, in r cos(phi) and in the
squared cosine of the bending angle, quadratic in the offset.  They are interpolated between the extremes of
all designs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.discretization import Discretization
from beamdyn.modal.many_designs import PencilStack
from beamdyn.modal.model import Model
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

# Powers of an input in mass per length, bending stiffness and axial stiffness.
_POWERS = {
    "beam.width": (1, 1, 1),
    "beam.thickness": (1, 3, 1),
    "beam.youngs_modulus": (0, 1, 1),
    "beam.density": (1, 0, 0),
    "beam.mass_per_length": (1, 0, 0),
    "beam.bending_stiffness": (0, 1, 0),
    "beam.axial_stiffness": (0, 0, 1),
    "beam.length": (0, 0, 0),
}
_OF_TIP = ("mass", "offset", "inertia", "transverse_inertia", "axial_inertia")
_OF_MOUNT = ("radius", "setting_angle", "bending_angle")
SIMILAR = {*_POWERS, *(f"beam.tip.{name}" for name in _OF_TIP), *(f"mount.{name}" for name in _OF_MOUNT)}
# Quantities of which the matrices are polynomials, and their degrees in them.
_DEGREES = {"mass": 1, "offset": 2, "inertia": 1, "tilt": 1, "axial": 1, "in_plane": 1}
_RIGHT_ANGLE = 2e-16  # cosine of a rounded right angle, as in `beamdyn.scene.mount.exact_cos_sin`
_PLACES = np.linspace(0, 1, 101)  # x/L at which the axial strain is computed


def differ_in_numbers_only(scene: Scene, names: set[str]) -> bool:
    """Whether the designs of a study over some inputs are similar to beams of one shape and basis."""
    plain = scene.physics == Physics() and not scene.chooses_physics
    clamped = scene.is_slender_beam_in_one_plane
    points = scene.beam.point_masses or scene.beam.point_springs
    beyond = scene.is_damped or scene.mount.precone or points
    return plain and clamped and not beyond and names <= SIMILAR


@dataclass(frozen=True)
class SimilarDesigns(FieldsOnly):
    """N designs as one beam with other tip bodies, radii, angles and speeds.

    Parameters
    ----------
    reference : Scene
        The scene of a reference.
    first : mapping of str to float
        Inputs of the reference.
    columns : mapping of str to ndarray, shape (N,)
        The same inputs of each design.
    nodes : mapping of str to ndarray, optional
        Values of each quantity between which the matrices are interpolated, where designs are some of many.
    """

    reference: Scene
    first: Mapping[str, float]
    columns: Mapping[str, np.ndarray]
    nodes: Mapping[str, np.ndarray] | None = None

    def part(self, rows: slice) -> SimilarDesigns:
        """Some of the designs, interpolated as all are."""
        columns = {name: values[rows] for name, values in self.columns.items()}
        return SimilarDesigns(self.reference, self.first, columns, self._nodes)

    @property
    def count(self) -> int:
        """Number N of designs."""
        return len(next(iter(self.columns.values()))) if self.columns else 1

    # Similarity -----------------------------------------------------------------------------------

    def _scale(self, which: int) -> np.ndarray:
        """Mass per length (0), bending stiffness (1) or axial stiffness (2) over the reference's, (N,)."""
        scale = np.ones(self.count)
        for name, powers in _POWERS.items():
            if name in self.columns:
                scale = scale * (self.columns[name] / self.first[name]) ** powers[which]
        return scale

    @cached_property
    def length(self) -> np.ndarray:
        """Length over the reference's, (N,)."""
        given = self.columns.get("beam.length")
        return np.ones(self.count) if given is None else given / self.first["beam.length"]

    @cached_property
    def time(self) -> np.ndarray:
        """Time T over the reference's: its speeds are the designs' times T, (N,)."""
        return np.sqrt(self._scale(0) * self.length**4 / self._scale(1))

    @cached_property
    def strain(self) -> np.ndarray:
        """Axial strain over the reference's at corresponding speeds, (N,)."""
        return self._scale(1) / (self.length**2 * self._scale(2))

    # Quantities of which the matrices are polynomials ---------------------------------------------

    def _given(self, name: str, reference: float) -> np.ndarray:
        return np.asarray(self.columns.get(name, np.full(self.count, reference)), dtype=float)

    @cached_property
    def _tip(self) -> dict[str, np.ndarray]:
        """The tip body of the reference beam in each design."""
        tip, mass = self.reference.beam.tip or TipMass(0.0), self._scale(0) * self.length
        given = {name: self._given(f"beam.tip.{name}", getattr(tip, name) or 0.0) for name in _OF_TIP}
        if tip.transverse_inertia is None:
            given["transverse_inertia"] = self.columns.get("beam.tip.transverse_inertia", given["inertia"])
        scales = {"mass": mass, "offset": self.length}
        return {name: v / scales.get(name, mass * self.length**2) for name, v in given.items()}

    @cached_property
    def _angles(self) -> dict[str, np.ndarray]:
        return {
            name: self._given(f"mount.{name}", getattr(self.reference.mount, name)) for name in _OF_MOUNT[1:]
        }

    @cached_property
    def _radius(self) -> np.ndarray:
        return self._given("mount.radius", self.reference.mount.radius) / self.length

    @cached_property
    def quantities(self) -> dict[str, np.ndarray]:
        """Values (N,) of the quantities of the reference beam, by name."""
        tip, inertia = self._tip, self._tip["inertia"]
        difference = tip["transverse_inertia"] - tip["axial_inertia"]
        return {
            "mass": tip["mass"],
            "offset": tip["offset"],
            "inertia": inertia,
            "tilt": np.where(inertia == 0, 0.0, difference / np.where(inertia == 0, 1.0, inertia)),
            "axial": self._radius * _cos(self._angles["setting_angle"]),
            "in_plane": _cos(self._angles["bending_angle"]) ** 2,
        }

    @cached_property
    def across(self) -> np.ndarray:
        """Acceleration of the root in the direction of bending per squared speed [m], its size, (N,)."""
        sine = _cos(self._angles["setting_angle"] - math.pi / 2)
        return np.abs(self._radius * sine * _cos(self._angles["bending_angle"]))

    @cached_property
    def _nodes(self) -> Mapping[str, np.ndarray]:
        """Values of each quantity between which the matrices are interpolated."""
        if self.nodes is not None:
            return self.nodes
        return {name: _nodes_of(values, _DEGREES[name]) for name, values in self.quantities.items()}

    @cached_property
    def _node_scenes(self) -> list[Scene]:
        """The reference beam with each combination of these values."""
        grids = np.meshgrid(*self._nodes.values(), indexing="ij")
        points = zip(*(grid.ravel().tolist() for grid in grids), strict=True)
        return [self._scene_at(**dict(zip(self._nodes, point, strict=True))) for point in points]

    def _scene_at(
        self, mass: float, offset: float, inertia: float, tilt: float, axial: float, in_plane: float
    ) -> Scene:
        tip = TipMass(mass, offset, inertia, (1 + tilt) * inertia, inertia)
        mount = Mount(abs(axial), 0.0 if axial >= 0 else math.pi, math.acos(math.sqrt(in_plane)))
        return Scene(replace(self.reference.beam, tip=tip), mount)

    def family(self, discretization: Discretization) -> PencilFamily:
        """The matrices of all designs in one basis."""
        models = [Model(scene, discretization) for scene in self._node_scenes]
        pencils = [model.equations.steady() for model in models]
        coarse = models[0].equations.coarse
        assert coarse is not None
        return PencilFamily(
            K0=pencils[0].K0,
            M=np.array([pencil.M for pencil in pencils]),
            K2=np.array([pencil.K2 for pencil in pencils]),
            load=np.array([model.equations.P(0) for model in models]),
            tip=models[0].equations.tip,
            coarse=coarse,
        )

    def weights(self, designs: np.ndarray) -> np.ndarray:
        """Weights (R, T) of the T node scenes in the matrices of R designs."""
        weights = np.ones((len(designs), 1))
        for name, nodes in self._nodes.items():
            own = _lagrange(nodes, self.quantities[name][designs])
            weights = (weights[:, :, None] * own[:, None, :]).reshape(len(weights), -1)
        return weights

    @cached_property
    def _forces(self) -> np.ndarray:
        """Axial force of the node scenes over their axial stiffness, per squared speed [s2], (T, points)."""
        stiffness = self.reference.beam.axial_stiffness
        if stiffness is None:
            return np.full((len(self._node_scenes), 1), np.nan)
        return np.array([_axial_force(scene) for scene in self._node_scenes]) / stiffness(_PLACES)

    def strains(self, speeds: np.ndarray) -> np.ndarray:
        """Largest axial strain of each design at its speeds (N, S) [rad/s]; nan if it is not known."""
        per_square = np.abs(self.weights(np.arange(self.count)) @ self._forces).max(axis=1)
        return (per_square * self.strain * self.time**2)[:, None] * speeds**2


@dataclass(frozen=True)
class PencilFamily:
    """Matrices of T scenes, between which those of designs are interpolated.

    Parameters
    ----------
    K0 : ndarray, shape (n, n)
        Stiffness at rest.
    M, K2 : ndarray, shape (T, n, n)
        Mass, and stiffness per squared speed.
    load : ndarray, shape (T, n)
        Load under a unit acceleration of the root in the direction of bending.
    tip : ndarray, shape (n,)
        Tip deflection per coordinate.
    coarse : ndarray of int
        Coordinates of the coarser basis.
    """

    K0: np.ndarray
    M: np.ndarray
    K2: np.ndarray
    load: np.ndarray
    tip: np.ndarray
    coarse: np.ndarray

    def stack(self, weights: np.ndarray) -> PencilStack:
        """The matrices of designs of some weights (R, T)."""
        M, K2 = (np.tensordot(weights, A, axes=1) for A in (self.M, self.K2))
        return PencilStack(self.K0, M, K2)


def _cos(angle: np.ndarray) -> np.ndarray:
    c = np.cos(angle)
    return np.where(np.abs(c) < _RIGHT_ANGLE, 0.0, c)


def _axial_force(scene: Scene) -> np.ndarray:
    n_a, n_b = axial_tension(scene.beam)
    axial = scene.mount.radius * math.cos(scene.mount.setting_angle)
    return n_b(_PLACES) - axial * n_a(_PLACES)


def _nodes_of(values: np.ndarray, degree: int) -> np.ndarray:
    """As many values between the extremes as a polynomial of a degree needs; one if all are the same."""
    low, high = values.min(), values.max()
    return np.linspace(low, high, degree + 1) if high > low else np.array([low])


def _lagrange(nodes: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Values (R, p) at x (R,) of the polynomials that are 1 at one of p nodes and 0 at the others."""
    values = np.ones((len(x), len(nodes)))
    for i, node in enumerate(nodes):
        for other in np.delete(nodes, i):
            values[:, i] *= (x - other) / (node - other)
    return values
