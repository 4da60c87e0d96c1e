"""A scene in exact numbers, one of which may be changed.

Properties are nondimensional, at the points of a mesh.  The unit of length is the beam's, of mass per length
and bending stiffness theirs at the root.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from mpmath import mp, mpf

import beamdyn as bd
from beamdyn.scene.profile import Profile
from benchmarks.cases.reference.many_digits.mesh import Mesh

_QUARTER = 2e-16  # cosine below which the angle counts as a quarter turn
_SAME = 1e-12  # difference of x/L below which two points are the same
# Powers of the sides and of the material of a rectangular section in its properties.
_AREA = ("mass_per_length", "axial_stiffness", "shear_stiffness", "second_shear_stiffness")
_EASY, _STIFF = ("bending_stiffness", "rotary_inertia"), ("second_bending_stiffness", "second_rotary_inertia")
_POWERS: dict[str, dict[str, int]] = {
    "width": {**dict.fromkeys((*_AREA, *_EASY), 1), **dict.fromkeys(_STIFF, 3)},
    "thickness": {**dict.fromkeys((*_AREA, *_STIFF), 1), **dict.fromkeys(_EASY, 3)},
    "youngs_modulus": dict.fromkeys((*_AREA[1:], _EASY[0], _STIFF[0]), 1),
    "density": dict.fromkeys((_AREA[0], _EASY[1], _STIFF[1]), 1),
}


@dataclass(frozen=True)
class Numbers:
    """The numbers of a scene, one of which may be changed.

    Parameters
    ----------
    scene : Scene
        The scene.
    speed : float
        Speed [rad/s].
    functions : int
        Functions on each segment of the mesh.
    pieces : int
        Segments between two breakpoints.
    name : str
        Name of the number that is changed; none if empty.
    value, change : mpf
        Value and change of that number, in the number's unit.
    """

    scene: bd.Scene
    speed: float
    functions: int
    pieces: int = 1
    name: str = ""
    value: mpf = mpf(0)
    change: mpf = mpf(0)

    def of(self, name: str, value: float) -> mpf:
        """Return the value of a number, with the change added if this number is changed."""
        return mpf(value) + (self.change if name == self.name else 0)

    @cached_property
    def length(self) -> mpf:
        return self.of("beam.length", self.scene.beam.length)

    @cached_property
    def root_mass(self) -> mpf:
        """Unit of mass per length: that at the root."""
        return self._root("mass_per_length")

    @cached_property
    def root_stiffness(self) -> mpf:
        """Unit of bending stiffness: that at the root."""
        return self._root("bending_stiffness")

    @cached_property
    def time(self) -> mpf:
        """Unit of time [s]."""
        return mp.sqrt(self.root_mass * self.length**4 / self.root_stiffness)

    @cached_property
    def omega(self) -> mpf:
        """Nondimensional speed, in 1 / unit of time."""
        return self.of("speed", self.speed) * self.time

    def _root(self, name: str) -> mpf:
        profile = getattr(self.scene.beam, name)
        return mpf(float(profile.end_values()[0][0])) * self.factor(name)

    def factor(self, name: str) -> mpf:
        """Return the factor by which the changed number multiplies a property."""
        own = self.name.removeprefix("beam.").removeprefix("scale.")
        if own == "poissons_ratio":
            quotient = (12 + 11 * self.value) / (12 + 11 * (self.value + self.change))
            return quotient if name.endswith("shear_stiffness") else mpf(1)
        if not self.name.startswith("beam.") or "." in own:
            return mpf(1)
        power = 1 if own == name else _POWERS.get(own, {}).get(name, 0)
        return (1 + self.change / self.value) ** power

    # Along the beam -------------------------------------------------------------------------------

    @cached_property
    def mesh(self) -> Mesh:
        """Mesh of segments between all breakpoints and points, each divided into pieces."""
        points = [self.place(kind, k) for kind, k in self._points]
        plain = [mpf(xi) for xi in self.scene.modelled_beam.breakpoints]
        ends = sorted([*points, *(xi for xi in plain if all(abs(xi - at) > _SAME for at in points))])
        ends = [xi for k, xi in enumerate(ends) if k == 0 or xi - ends[k - 1] > _SAME]
        cut = [a + (b - a) * j / self.pieces for a, b in pairwise(ends) for j in range(self.pieces)]
        return Mesh([*cut, mpf(1)], self.functions)

    @property
    def _points(self) -> list[tuple[str, int]]:
        beam = self.scene.beam
        return [
            *(("point_mass", k) for k in range(len(beam.point_masses))),
            *(("point_spring", k) for k in range(len(beam.point_springs))),
        ]

    def place(self, kind: str, k: int) -> mpf:
        """Return the position x/L of a point mass or spring."""
        beam = self.scene.beam
        points = beam.point_masses if kind == "point_mass" else beam.point_springs
        if points[k].position == beam.length:
            return mpf(1)
        return self.of(f"beam.{kind}[{k}].position", points[k].position) / self.length

    def point(self, kind: str, k: int) -> int:
        """Return the index of a point mass or spring among the points of the mesh."""
        at = self.place(kind, k)
        return self.mesh.end(
            min(range(len(self.mesh.lengths)), key=lambda j: abs(self.mesh.ends[j + 1] - at))
        )

    def along(self, name: str, unit: mpf) -> np.ndarray | None:
        """Return a property at the points of the mesh, divided by a unit; None if it is not modelled."""
        profile = getattr(self.scene.modelled_beam, name)
        if profile is None:
            return None
        return values_at(profile, self.mesh) * (self.factor(name) / unit)

    @cached_property
    def mass(self) -> np.ndarray:
        found = self.along("mass_per_length", self.root_mass)
        assert found is not None
        return found

    def tensor(self, name: str, unit: mpf) -> list[list[np.ndarray]] | None:
        """Return a property of both directions along e1 and e2 at the points, 2 x 2; None if not modelled."""
        first = self.along(name, unit)
        if first is None:
            return None
        second = self.along(f"second_{name}", unit)
        return turned(first, first if second is None else second, self.twist)

    @cached_property
    def twist(self) -> np.ndarray:
        profile = self.scene.modelled_beam.twist
        if profile is None or self.scene.physics.planes == 1:
            return np.array([mpf(0)] * len(self.mesh.places), dtype=object)
        return values_at(profile, self.mesh) + (self.change if self.name == "beam.twist" else 0)

    # Mount ----------------------------------------------------------------------------------------

    @cached_property
    def inward(self) -> mpf:
        """Compute the distance of the root from the axis of rotation along the beam, positive if inward."""
        mount = self.scene.mount
        exact = self.name != "mount.setting_angle" and abs(math.cos(mount.setting_angle)) < _QUARTER
        cosine = (
            mpf(0)
            if exact
            else _cosine(mount.setting_angle, self.of("mount.setting_angle", mount.setting_angle))
        )
        return cosine * self.of("mount.radius", mount.radius) / self.length

    @cached_property
    def bending_angle(self) -> mpf:
        return self.of("mount.bending_angle", self.scene.mount.bending_angle)

    @cached_property
    def precone(self) -> mpf:
        return self.of("mount.precone", self.scene.mount.precone)

    def root_spring(self, plane: int) -> mpf | None:
        """Return the stiffness of the root's spring in a plane; None if it is clamped."""
        name = ("root_stiffness", "second_root_stiffness")[plane]
        value = getattr(self.scene.mount, name)
        return (
            None if math.isinf(value) else self.of(f"mount.{name}", value) * self.length / self.root_stiffness
        )

    # Bodies ---------------------------------------------------------------------------------------

    @property
    def _mass_unit(self) -> mpf:
        return self.root_mass * self.length

    def tip(self) -> dict[str, mpf] | None:
        """Return mass, offset and moments J_n, J_e, J_1 of the tip body; None without one."""
        tip = self.scene.beam.tip
        if tip is None:
            return None
        moment = self._mass_unit * self.length**2
        normal = self.of("beam.tip.inertia", tip.inertia)
        across = (
            normal
            if tip.transverse_inertia is None
            else self.of("beam.tip.transverse_inertia", tip.transverse_inertia)
        )
        return {
            "mass": self.of("beam.tip.mass", tip.mass) / self._mass_unit,
            "offset": self.of("beam.tip.offset", tip.offset) / self.length,
            "normal": normal / moment,
            "across": across / moment,
            "axial": self.of("beam.tip.axial_inertia", tip.axial_inertia) / moment,
        }  # fmt: skip

    def point_masses(self) -> list[tuple[int, mpf]]:
        """Return the mesh point and the mass of each point mass."""
        return [
            (self.point("point_mass", k), self.of(f"beam.point_mass[{k}].mass", each.mass) / self._mass_unit)
            for k, each in enumerate(self.scene.beam.point_masses)
        ]

    def point_springs(self) -> list[tuple[int, int, mpf]]:
        """Return the mesh point, plane and stiffness of each point spring."""
        unit = self.root_stiffness / self.length**3
        return [
            (
                self.point("point_spring", k),
                int(each.direction == "across"),
                self.of(f"beam.point_spring[{k}].stiffness", each.stiffness) / unit,
            )
            for k, each in enumerate(self.scene.beam.point_springs)
        ]

    # Damping --------------------------------------------------------------------------------------

    def mass_factor(self) -> mpf:
        return self.of("damping.mass_factor", self.scene.damping.mass_factor) * self.time

    def stiffness_factor(self) -> mpf:
        return self.of("damping.stiffness_factor", self.scene.damping.stiffness_factor) / self.time

    def tip_damper(self) -> mpf:
        damper = self.of("damping.tip_damper", self.scene.damping.tip_damper)
        return damper * self.length**3 / (self.root_stiffness * self.time)

    def ratios(self, modes: int) -> list[mpf]:
        """Return the damping ratio of each mode at rest, from the lowest."""
        if self.scene.damping_ratio:
            return [self.of("model.damping_ratio", self.scene.damping_ratio)] * modes
        given = [self.of(f"damping.ratios[{k}]", z) for k, z in enumerate(self.scene.damping.ratios)]
        return [given[min(k, len(given) - 1)] for k in range(modes)] if given else []


def turned(first: np.ndarray, second: np.ndarray, angle: np.ndarray) -> list[list[np.ndarray]]:
    """Return the tensor along e1, e2 of values along axes turned by an angle, at each point."""
    cosine = np.array([mp.cos(a) for a in angle], dtype=object)
    sine = np.array([mp.sin(a) for a in angle], dtype=object)
    mixed = (first - second) * cosine * sine
    return [
        [first * cosine**2 + second * sine**2, mixed],
        [mixed, first * sine**2 + second * cosine**2],
    ]


def values_at(profile: Profile, mesh: Mesh) -> np.ndarray:
    """Evaluate a piecewise polynomial at mesh points, each by the polynomial of the point's segment."""
    ends = [float(e) for e in mesh.ends]
    middles = [(a + b) / 2 for a, b in pairwise(ends)]
    parts = np.searchsorted(profile.breakpoints[1:-1], middles, side="right").tolist()
    found = []
    for x, segment in zip(mesh.places, mesh.segments, strict=True):
        part = parts[segment]
        a, b = (mpf(e) for e in profile.breakpoints[part : part + 2])
        found.append(_series(profile.coefficients[part], (2 * x - a - b) / (b - a)))
    return np.array(found, dtype=object)


def _series(coefficients: Sequence[float], t: mpf) -> mpf:
    before, now, total = mpf(0), mpf(1), mpf(coefficients[0])
    for k, c in enumerate(coefficients[1:]):
        before, now = now, ((2 * k + 1) * t * now - k * before) / (k + 1)
        total += mpf(c) * now
    return total


def _cosine(value: float, exact: mpf) -> mpf:
    """Compute the cosine of an angle; a quarter or half turn of 16 digits counts as exact."""
    if abs(math.cos(value)) < _QUARTER:
        return -mp.sin(exact - mpf(value)) * (1 if value > 0 else -1)
    if abs(math.sin(value)) < _QUARTER:
        return mp.cos(exact - mpf(value)) * (1 if math.cos(value) > 0 else -1)
    return mp.cos(exact)
