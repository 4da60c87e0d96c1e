"""Similar designs: a reference beam with different tip bodies, springs, radii, angles and speeds.

A similar beam has mass per length, stiffness and length s_m, s_k and s_L times those of a reference beam.  It
vibrates like the reference beam with the similar beam's tip mass divided by s_m s_L, moments of inertia
divided by s_m s_L^3, offset and radius divided by s_L, root springs multiplied by s_L/s_k, and speed
multiplied by

    T = sqrt(s_m s_L^4 / s_k);

its frequencies are those of this reference beam, divided by T.  The reference's matrices are polynomials of
few quantities.  In one plane of bending they are linear in the mass of the body, in its moment of inertia J_n
about the axis of bending, in (J_e - J_1)/J_n with its transverse and axial moments of inertia J_e and J_1, in
r cos(phi) of radius and setting angle, in the squared cosine of the bending angle and in the spring,
quadratic in the offset.  In two planes they are linear in the moments of inertia, in the springs, and in the
stiffness in the second direction over that in the first, and they are combinations of 1, cos(2 psi) and
sin(2 psi) of the bending angle psi.  The matrices are interpolated between the extremes of all designs.
Every combination of extremes must be a valid scene, but a moment of inertia could then exceed the sum of the
other two.  So the tip body's second moments of mass are combined instead: moments of inertia are sums of two
of them, and any nonnegative values belong to a possible body.

In shapes of arrays, N counts designs, S speeds, R selected designs, and T scenes at combinations of extremes.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.mass import sampled_axial_stiffness, steady_tension
from beamdyn.modes.modal.error_estimate import parts_of_distances
from beamdyn.modes.modal.many_designs import Estimate, PencilStack
from beamdyn.modes.modal.model import Model
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import RIGHT_ANGLE, ROUNDED_ANGLE, Mount
from beamdyn.scene.numbers import SCALE
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from beamdyn.studies.sensitivities.changes import equations_near

# Powers of each input to which mass per length, and bending, axial and second bending stiffness are
# proportional.
POWERS = {
    "beam.width": (1, 1, 1, 3),
    "beam.thickness": (1, 3, 1, 1),
    "beam.youngs_modulus": (0, 1, 1, 1),
    "beam.density": (1, 0, 0, 0),
    "beam.mass_per_length": (1, 0, 0, 0),
    "beam.bending_stiffness": (0, 1, 0, 0),
    "beam.axial_stiffness": (0, 0, 1, 0),
    "beam.second_bending_stiffness": (0, 0, 0, 1),
    "beam.length": (0, 0, 0, 0),
}
POWERS |= {
    SCALE + name: POWERS[f"beam.{name}"]
    for name in (
        *("width", "thickness", "mass_per_length", "bending_stiffness", "axial_stiffness"),
        "second_bending_stiffness",
    )
}
_OF_TIP = ("mass", "offset", "inertia", "transverse_inertia", "axial_inertia")
_OF_MOUNT = ("radius", "setting_angle", "bending_angle")
_SPRINGS = ("root_stiffness", "second_root_stiffness")
_WITHOUT_EFFECT = {"model.gravity"}  # inputs without effect on modes at constant speed
SIMILAR = {
    *POWERS,
    *(f"beam.tip.{name}" for name in _OF_TIP),
    *(f"mount.{name}" for name in (*_OF_MOUNT, *_SPRINGS)),
    *_WITHOUT_EFFECT,
}
# Quantities of which the matrices are polynomials, with the degree of the polynomial; for "angle" the
# polynomial is trigonometric.
_DEGREES = {
    **{"mass": 1, "offset": 2, "inertia": 1, "tilt": 1, "axial": 1, "in_plane": 1, "spring": 1},
    **{"along_beam": 1, "along_bending": 1, "along_axis": 1},
    **{"second_spring": 1, "second_stiffness": 1, "angle": 2},
}
_ANGLES = np.array([0.0, 1.0, 2.0]) * math.pi / 3  # nodes of the trigonometric interpolation [rad]
_MOST_NODES = 512  # largest number of scenes to be assembled, which takes some seconds
_NODES_EACH = 8  # largest number of assembled scenes per result: with more, single analyses are as fast
# Ratios of rounding errors, on root springs and in two planes, to those of a clamped beam in one plane.
_ROUNDING_ON_SPRINGS, _ROUNDING_OF_PLANES = 2.0, 3.0

Nodes = tuple[tuple[str, tuple[float, ...]], ...]


def differ_in_numbers_only(scene: Scene, names: set[str]) -> bool:
    """Return whether all designs of a study over the inputs `names` are similar beams.

    They can then be solved in one basis.
    """
    plain = scene.physics in (Physics(), Physics(planes=2)) and not scene.chooses_physics
    lumped = bool(scene.beam.point_masses) and bool(names & POWERS.keys())
    apart = scene.physics.planes == 1 or scene.beam.second_bending_stiffness is not None
    beyond = scene.mount.precone or scene.beam.point_springs or scene.damping.damps
    # The layers of a harvester depend on the numbers of the beam, so that the designs are not similar.
    beyond = beyond or scene.beam.electrodes is not None
    return plain and apart and not beyond and not lumped and names <= SIMILAR


@dataclass(frozen=True)
class SimilarDesigns(FieldsOnly):
    """N designs, represented by one beam with different tip bodies, springs, radii, angles and speeds.

    Parameters
    ----------
    reference : Scene
        Scene with the reference beam.
    first : mapping of str to float
        Inputs of the reference.
    columns : mapping of str to ndarray, shape (N,)
        Inputs of each design.
    nodes : tuple of (str, tuple of float), optional
        Values of each quantity between which matrices are interpolated.  They are given if the designs are a
        part of a larger set, for whose extremes the matrices are assembled; otherwise they follow from the
        designs.
    """

    reference: Scene
    first: Mapping[str, float]
    columns: Mapping[str, np.ndarray]
    nodes: Nodes | None = None

    @property
    def count(self) -> int:
        """Number N of designs."""
        return len(next(iter(self.columns.values()))) if self.columns else 1

    @property
    def _planes(self) -> int:
        return self.reference.physics.planes

    # Similarity -----------------------------------------------------------------------------------

    def _scale(self, which: int) -> np.ndarray:
        """Compute the ratio of a property of each design to that of the reference, shape (N,).

        `which` is 0 for the mass per length, and 1, 2 or 3 for the bending, axial or second bending
        stiffness: the index in the values of `POWERS`.
        """
        scale = np.ones(self.count)
        for name, powers in POWERS.items():
            if name in self.columns:
                scale = scale * (self.columns[name] / self.first[name]) ** powers[which]
        return scale

    @cached_property
    def length(self) -> np.ndarray:
        """Ratio of the length of each design to that of the reference."""
        given = self.columns.get("beam.length")
        return np.ones(self.count) if given is None else given / self.first["beam.length"]

    @cached_property
    def time(self) -> np.ndarray:
        """Ratio of the time unit of each design to that of the reference.

        The reference rotates at the speed of a design times this ratio.
        """
        return np.sqrt(self._scale(0) * self.length**4 / self._scale(1))

    @cached_property
    def strain(self) -> np.ndarray:
        """Ratio of each design's axial strain to that of the reference at the corresponding speed."""
        return self._scale(1) / (self.length**2 * self._scale(2))

    # Quantities on which the matrices depend as polynomials -------------------------------------------

    def _given(self, name: str, reference: float) -> np.ndarray:
        return np.asarray(self.columns.get(name, np.full(self.count, reference)), dtype=float)

    def _of_mount(self, name: str) -> np.ndarray:
        return self._given(f"mount.{name}", getattr(self.reference.mount, name))

    @cached_property
    def tip(self) -> dict[str, np.ndarray]:
        """Properties, by name, of the tip body on the reference beam that represents each design."""
        tip, mass = self.reference.beam.tip or TipMass(0.0), self._scale(0) * self.length
        given = {name: self._given(f"beam.tip.{name}", getattr(tip, name) or 0.0) for name in _OF_TIP}
        if tip.transverse_inertia is None:
            given["transverse_inertia"] = self.columns.get("beam.tip.transverse_inertia", given["inertia"])
        scales = {"mass": mass, "offset": self.length}
        return {name: v / scales.get(name, mass * self.length**2) for name, v in given.items()}

    @cached_property
    def _springs(self) -> dict[str, np.ndarray]:
        """Root springs of the reference beam that represents each design [N m/rad].

        They are inf if the root is clamped.
        """
        stiffer = self.length / self._scale(1)
        return {name: self._of_mount(name) * stiffer for name in _SPRINGS[: self._planes]}

    @cached_property
    def _radius(self) -> np.ndarray:
        return self._of_mount("radius") / self.length

    @property
    def axial(self) -> np.ndarray:
        """Component r cos(phi) of the root's distance from the axis of rotation, along the beam [m].

        It is that of the reference beam that represents each design, and positive if the beam points inward.
        """
        return self._radius * _cos(self._of_mount("setting_angle"), ROUNDED_ANGLE)

    @cached_property
    def quantities(self) -> dict[str, np.ndarray]:
        """Values of the quantities on which the matrices depend, by name."""
        tip, springs = self.tip, self._springs
        common = {"mass": tip["mass"], "offset": tip["offset"], "axial": self.axial}
        if np.isfinite(spring := springs["root_stiffness"]).all():
            common["spring"] = spring
        if self._planes == 1:
            return common | {"inertia": tip["inertia"], "tilt": self.tilt, "in_plane": self.in_plane}
        if np.isfinite(spring := springs["second_root_stiffness"]).all():
            common["second_spring"] = spring
        # Second moments of mass of the tip body [kg m2] along beam, bending direction and axis of bending.
        n, e, one = (self.tip[name] for name in ("inertia", "transverse_inertia", "axial_inertia"))
        twice = {"along_beam": n + e - one, "along_bending": n + one - e, "along_axis": e + one - n}
        common |= {name: np.maximum(v / 2, 0.0) for name, v in twice.items()}
        second = self._scale(3) / self._scale(1)
        return common | {"angle": self._of_mount("bending_angle"), "second_stiffness": second}

    @property
    def tilt(self) -> np.ndarray:
        """Transverse minus axial moment of inertia of the tip body over its `inertia`, -1 to 1."""
        inertia = self.tip["inertia"]
        difference = self.tip["transverse_inertia"] - self.tip["axial_inertia"]
        tilt = np.where(inertia == 0, 0.0, difference / np.where(inertia == 0, 1.0, inertia))
        return np.clip(tilt, -1.0, 1.0)  # rounding may exceed these limits

    @property
    def in_plane(self) -> np.ndarray:
        """Squared cosine of the bending angle."""
        return _cos(self._of_mount("bending_angle")) ** 2

    @cached_property
    def across(self) -> np.ndarray:
        """Acceleration of the root across the beam, over squared speed [m], in each plane: (N, planes)."""
        size = self._radius * _cos(self._of_mount("setting_angle") - math.pi / 2, ROUNDED_ANGLE)
        angle = self._of_mount("bending_angle")
        each = (_cos(angle), -_cos(angle - math.pi / 2))[: self._planes]
        return size[:, None] * np.stack(each, axis=1)

    # Matrices -------------------------------------------------------------------------------------

    @cached_property
    def _nodes(self) -> Nodes:
        return nodes_of([self]) if self.nodes is None else self.nodes

    def has_few_nodes(self, answers: int) -> bool:
        """Return whether the number of scenes to be assembled is small enough for a number of results."""
        most = min(_MOST_NODES, _NODES_EACH * answers)
        return math.prod(len(values) for _, values in self._nodes) <= most

    @property
    def can_be_solved(self) -> bool:
        """Whether all designs can be solved with the same coordinates.

        This is so if each root spring is infinite (clamped) in all designs, or finite and positive in all.
        """
        return all(
            (v > 0).all() and (np.isfinite(v).all() or np.isinf(v).all()) for v in self._springs.values()
        )

    def family(self, discretization: Discretization) -> PencilFamily:
        """Return the matrices of all designs in one basis.

        Each process caches them for the next call.
        """
        return _family(self.reference, self._nodes, discretization)

    def estimate(self, discretization: Discretization) -> Estimate:
        """Return the parameters of the error estimate for a basis."""
        on_springs = np.isfinite(self.reference.mount.root_stiffness)
        rounding = _ROUNDING_OF_PLANES if self._planes == 2 else _ROUNDING_ON_SPRINGS if on_springs else 1.0
        return Estimate(rounding == 1.0, parts_of_distances(self.reference, discretization), rounding)

    def weights(self, designs: np.ndarray) -> np.ndarray:
        """Compute the weights (R, T) of T node scenes in the matrices of R designs."""
        weights = np.ones((len(designs), 1))
        for name, nodes in self._nodes:
            own = _weights_of(name, np.array(nodes), self.quantities[name][designs])
            weights = (weights[:, :, None] * own[:, None, :]).reshape(len(weights), -1)
        return weights

    def strains(self, speeds: np.ndarray) -> np.ndarray:
        """Compute the largest axial strain of each design at its speeds (designs, speeds) [rad/s].

        The strain is nan if it is not known.
        """
        per_square = np.abs(self.weights(np.arange(self.count)) @ _forces(self.reference, self._nodes)).max(
            axis=1
        )
        return (per_square * self.strain * self.time**2)[:, None] * speeds**2


def nodes_of(parts: Iterable[SimilarDesigns]) -> Nodes:
    """Return the values of each quantity between which the matrices of all designs are interpolated.

    The designs are given in several `parts`.
    """
    ends: dict[str, tuple[float, float]] = {}
    for part in parts:
        for name, values in part.quantities.items():
            low, high = ends.get(name, (math.inf, -math.inf))
            ends[name] = min(low, float(values.min())), max(high, float(values.max()))
    return tuple((name, _nodes_between(name, *ends[name])) for name in ends)


@dataclass(frozen=True)
class PencilFamily:
    """Matrices of T node scenes, between which the matrices of designs are interpolated.

    Parameters
    ----------
    K0 : ndarray, shape (coordinates, coordinates) or (T, coordinates, coordinates)
        Stiffness at rest, common to all node scenes or one for each.
    M, K2 : ndarray, shape (T, coordinates, coordinates)
        Mass, and the part of the stiffness due to rotation, divided by the squared speed.
    loads : ndarray, shape (T, d, coordinates)
        Loads under a unit acceleration of the root in the d directions of bending.
    tips : ndarray, shape (d, coordinates)
        Tip deflections in the directions of bending, per unit of each coordinate.
    coarse : ndarray of int, optional
        Indices of the coordinates that the coarser basis also has; None if it has different functions.
    """

    K0: np.ndarray
    M: np.ndarray
    K2: np.ndarray
    loads: np.ndarray
    tips: np.ndarray
    coarse: np.ndarray | None

    def stack(self, weights: np.ndarray) -> PencilStack:
        """Interpolate the matrices of designs between node scenes, with weights (designs, node scenes)."""
        M, K2 = (np.tensordot(weights, A, axes=1) for A in (self.M, self.K2))
        K0 = self.K0 if self.K0.ndim == 2 else np.tensordot(weights, self.K0, axes=1)
        return PencilStack(K0, M, K2)


# Scenes at the nodes, assembled once in each process -----------------------------------------------


@lru_cache(maxsize=8)
def _node_scenes(reference: Scene, nodes: Nodes) -> list[Scene]:
    """Build the reference scene with each combination of the quantities' values at the nodes.

    The values of the last quantity change fastest from scene to scene.
    """
    grids = np.meshgrid(*(values for _, values in nodes), indexing="ij")
    points = zip(*(grid.ravel().tolist() for grid in grids), strict=True)
    names = [name for name, _ in nodes]
    return [_scene_at(reference, dict(zip(names, point, strict=True))) for point in points]


def _scene_at(reference: Scene, at: Mapping[str, float]) -> Scene:
    """Build the reference beam for given values of the quantities."""
    beam, axial = reference.beam, at["axial"]
    if "tilt" in at:
        inertia, angle = at["inertia"], math.acos(math.sqrt(at["in_plane"]))
        inertias = inertia, (1 + at["tilt"]) * inertia, inertia
    else:
        a, b, c = (at[name] for name in ("along_beam", "along_bending", "along_axis"))
        inertias, angle = (a + b, a + c, b + c), at["angle"]
        assert beam.second_bending_stiffness is not None
        second = beam.second_bending_stiffness.scaled(at["second_stiffness"])
        beam = replace(beam, second_bending_stiffness=second)
    springs = at.get("spring", math.inf), at.get("second_spring", math.inf)
    mount = Mount(
        abs(axial), 0.0 if axial >= 0 else math.pi, angle, **dict(zip(_SPRINGS, springs, strict=True))
    )
    tip = TipMass(at["mass"], at["offset"], *inertias)
    return Scene(replace(beam, tip=tip), mount, physics=reference.physics)


@lru_cache(maxsize=16)
def _family(reference: Scene, nodes: Nodes, discretization: Discretization) -> PencilFamily:
    scenes = _node_scenes(reference, nodes)
    first = Model(scenes[0], discretization)
    equations = [equations_near(first, scene) for scene in scenes]
    pencils = [each.steady() for each in equations]
    same = all(np.array_equal(pencil.K0, pencils[0].K0) for pencil in pencils)
    directions = range(reference.physics.planes)
    return PencilFamily(
        K0=pencils[0].K0 if same else np.array([pencil.K0 for pencil in pencils]),
        M=np.array([pencil.M for pencil in pencils]),
        K2=np.array([pencil.K2 for pencil in pencils]),
        loads=np.array([[each.P(i) for i in directions] for each in equations]),
        tips=equations[0].tips[: len(directions)],
        coarse=equations[0].coarse,
    )


@lru_cache(maxsize=8)
def _forces(reference: Scene, nodes: Nodes) -> np.ndarray:
    """Compute the axial strain by rotation, divided by squared speed [s2], at points along T node scenes.

    The shape is (T, points).  The strain is nan if the axial stiffness of the beam is not known.
    """
    scenes, beam = _node_scenes(reference, nodes), reference.beam
    if beam.axial_stiffness is None:
        return np.full((len(scenes), 1), np.nan)
    return np.array([steady_tension(scene.beam, scene.mount) for scene in scenes]) / sampled_axial_stiffness(
        beam
    )


# Interpolation --------------------------------------------------------------------------------------


def _cos(angle: np.ndarray, least: float = RIGHT_ANGLE) -> np.ndarray:
    """Compute cosines of angles [rad]; 0 if their magnitude is smaller than `least`."""
    c = np.cos(angle)
    return np.where(np.abs(c) < least, 0.0, c)


def _nodes_between(name: str, low: float, high: float) -> tuple[float, ...]:
    """Return as many values between two extremes as the polynomial needs; one if the extremes are equal."""
    if high == low:
        return (low,)
    return tuple((_ANGLES if name == "angle" else np.linspace(low, high, _DEGREES[name] + 1)).tolist())


def _weights_of(name: str, nodes: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Compute the weights (len(x), p) with which values at p nodes are interpolated at x.

    A weight is 1 at its own node, and 0 at the other nodes.
    """
    if name == "angle" and len(nodes) > 1:
        return (1 + 2 * np.cos(2 * (x[:, None] - nodes))) / 3
    values = np.ones((len(x), len(nodes)))
    for i, node in enumerate(nodes):
        for other in np.delete(nodes, i):
            values[:, i] *= (x - other) / (node - other)
    return values
