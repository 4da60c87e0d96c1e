"""Speeds below which the inertia of tilting sections, or of an oblique tip body, buckles no beam.

Let F0 be the form of `beamdyn.modes.buckling` for a slender beam, and E twice the energy of bending and of
the springs at the root.  With the tilt theta of the sections (theta2 in the plane of rotation, theta3 out of
it), the tensor I of their rotary inertia and that of the tip body, B, rotation adds to F0

    -int (I33 theta3^2 + I23 theta2 theta3) + B23 theta2 theta3 at the tip
    + int g (theta2 theta3' - theta3 theta2'),    g(x) = int_x^L I23 - B23,

in which B33 theta3^2 at the tip counts to F0.  With the compliance C(x), the integral of the sections' from
the root to x plus that of the springs, theta_i^2 <= C_ii E.  So what rotation adds is at least -r E per
squared speed, with

    r = int (I33 C33 + |I23| (C22 C33)^(1/2)) + |B23| (C22 C33)^(1/2) + (int g^2 trace(C) / EI)^(1/2),

with the smaller EI at x.  **If F0 >= 0, no speed below r^(-1/2) is critical.**  For a uniform beam that is
2^(1/2) times the speed of sound in its material, over the length.

At a hinge C is infinite.  If it turns out of the plane only, where F0 >= int N u'^2, split theta3 into its
mean with the weight N and the rest, at most (e E)^(1/2) with e = int 1/EI.  If S = int N - 2 int I33 > 0,

    r = 2 e int I33 + A^2 / (4 S) + A e^(1/2) + G,    G = (int g^2 C22 / EI)^(1/2),
    A = int |I23| C22^(1/2) + |B23| C22^(1/2) + (int g^2 / EI)^(1/2).

With shear, of which u' has a part, S = int N / 2 - 2 int I33, and r is at least N / (kappa G A) everywhere.

Precone eta multiplies all but B23 by cos^2 eta <= 1, and adds sin^2 eta I to the form, which is not negative;
B23 has the factor cos^2 eta - 2 sin^2 eta.  The arguments for a hinge and for a short bend are not used then.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.mass import axial_tension
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import centrifugal_inertia, section_tensor

_CELLS = 2000  # of the midpoint rule on all segments together
_MARGIN = 1.01  # for its error
_LARGE_STRAIN = 0.01  # axial, in order of magnitude (speed L / speed of sound)^2: linear theory ends
_ALIGNED = 1e-14  # product of inertia relative to the moments below which a body is not oblique


def least_toppling_speed(scene: Scene) -> float:
    """Speed below which tilting sections and an oblique tip body buckle no beam with F0 >= 0.

    Parameters
    ----------
    scene : Scene
        The scene.

    Returns
    -------
    float
        Speed [rad/s]; inf if no inertia tilts out of the plane, 0 if the argument gives no bound.
    """
    inertia = _Inertia(scene)
    if not inertia.topples:
        return np.inf
    return float((_MARGIN * min(inertia.softening, inertia.softening_at_hinge)) ** -0.5)


def strain_limit_comes_first(scene: Scene) -> bool:
    """Whether a beam of one material passes an axial strain of 1 % below `least_toppling_speed`."""
    inertia = _Inertia(scene)
    return inertia.topples and least_toppling_speed(scene) >= _LARGE_STRAIN**0.5 * inertia.sound_speed


def topples_in_slender_limit(scene: Scene) -> bool:
    """Whether sections or a tip body surely topple whatever the stiffness, in a bend of no length."""
    inertia = _Inertia(scene)
    if scene.mount.precone:
        return False  # it is not known
    free_end = inertia.tension[-1] < inertia.moments[-1] * (inertia.components[1] ** 2).sum()
    return inertia.topples and bool(scene.physics.shear or inertia.oblique or free_end)


@dataclass(frozen=True)
class _Inertia:
    """Inertia and compliance of a scene at the midpoints of n cells along its beam.

    Tensors have the directions in the plane of rotation and out of it.
    """

    scene: Scene

    @cached_property
    def beam(self) -> Beam:
        return self.scene.modelled_beam

    @cached_property
    def cells(self) -> tuple[np.ndarray, np.ndarray]:
        """Midpoints x/L (n,) and widths [m] (n,)."""
        ends = np.array(self.beam.breakpoints)
        per_segment = max(20, _CELLS // (len(ends) - 1))
        edges = np.unique(np.concatenate([np.linspace(a, b, per_segment + 1) for a, b in pairwise(ends)]))
        return (edges[1:] + edges[:-1]) / 2, np.diff(edges) * self.beam.length

    @cached_property
    def planes(self) -> int:
        return self.scene.physics.planes

    @cached_property
    def components(self) -> np.ndarray:
        """Rows: the plane of rotation and out of it, in the directions of bending; shape (2, planes)."""
        return np.array(plane_components(self.scene))[:, : self.planes]

    def _tensor(self, name: str) -> np.ndarray:
        """A property of the sections in the directions of bending: shape (n, planes, planes)."""
        values = np.zeros((len(self.cells[0]), self.planes, self.planes))
        for (i, j), profile in section_tensor(self.beam, name).items():
            values[:, i, j] = profile(self.cells[0])
        return values

    def _turned(self, tensor: np.ndarray) -> np.ndarray:
        return self.components @ tensor @ self.components.T

    @cached_property
    def tensors(self) -> np.ndarray:
        """Rotary inertia of the sections (n, 2, 2) [kg m]."""
        return self._turned(self._tensor("rotary_inertia"))

    @cached_property
    def body(self) -> float:
        """Product of inertia B23 of the tip body [kg m2]; 0 within rounding, or in one plane.

        With precone, it is at least as large as the factor of its work.
        """
        if self.planes == 1:
            return 0.0
        B = self._turned(centrifugal_inertia(self.beam.tip or TipMass(0.0), self.beam.tip_twist))
        cosine, sine = exact_cos_sin(self.scene.mount.precone)
        product = float(B[0, 1]) if abs(B[0, 1]) > _ALIGNED * np.abs(B).max() else 0.0
        return product * max(1.0, abs(cosine**2 - 2 * sine**2))

    @cached_property
    def moments(self) -> np.ndarray:
        """Rotary inertia (n,) that multiplies theta3^2 [kg m]: I33, or all of it in one plane."""
        if self.planes == 2:
            return self.tensors[:, 1, 1]
        return self._tensor("rotary_inertia")[:, 0, 0] * bool(self.components[1, 0])

    @cached_property
    def products(self) -> np.ndarray:
        """Products of inertia I23 of the sections (n,) [kg m]; 0 within rounding, or in one plane."""
        I23 = self.tensors[:, 0, 1] if self.planes == 2 else np.zeros(len(self.tensors))
        return np.where(np.abs(I23) > _ALIGNED * np.abs(self.tensors).max(), I23, 0.0)

    @property
    def oblique(self) -> bool:
        """Whether any product of inertia is not 0."""
        return bool(self.body or self.products.any())

    @property
    def topples(self) -> bool:
        """Whether any inertia but B33 works against the tilt."""
        return self.oblique or bool(self.moments.any())

    @cached_property
    def flexibility(self) -> np.ndarray:
        """Inverse of the smaller bending stiffness (n,) [1/(N m2)]."""
        return 1 / np.linalg.eigvalsh(self._tensor("bending_stiffness"))[:, 0]

    @property
    def hinged(self) -> bool:
        """Whether a hinge lets the sections tilt without bending."""
        springs = self.scene.mount.root_stiffnesses[: self.planes]
        coupled = self.oblique
        return any(k == 0 and (n or coupled) for k, n in zip(springs, self.components[1], strict=True))

    @cached_property
    def compliance(self) -> np.ndarray:
        """Compliance C at the cells (n, 2, 2) [1/(N m)]."""
        springs = self.scene.mount.root_stiffnesses[: self.planes]
        root = np.diag([1 / k if k else 0.0 for k in springs])  # of hinges that matter, see `hinged`
        by_bending = np.linalg.inv(self._tensor("bending_stiffness")) * self.cells[1][:, None, None]
        return self._turned(root + np.cumsum(by_bending, axis=0))

    @property
    def sound_speed(self) -> float:
        """Speed of sound in the material over the length [rad/s]; 0 for sections without rotary inertia."""
        inertia = float(self.cells[1] @ self._tensor("rotary_inertia")[:, 0, 0])
        compliance = float(self.cells[1] @ (1 / self._tensor("bending_stiffness")[:, 0, 0]))
        return (inertia * compliance) ** -0.5 if inertia else 0.0

    @property
    def softening(self) -> float:
        """The number r of the docstring of this module [s2], of a root without hinges; inf at a hinge."""
        if self.hinged:
            return np.inf
        width, C, product = self.cells[1], self.compliance, self.products
        both = np.sqrt(C[:, 0, 0] * C[:, 1, 1])
        ratio = width @ (self.moments * C[:, 1, 1] + np.abs(product) * both)
        twisting = np.sqrt(width @ (self.torque**2 * np.trace(C, axis1=1, axis2=2) * self.flexibility))
        return float(ratio + abs(self.body) * both[-1] + twisting)

    @property
    def softening_at_hinge(self) -> float:
        """The number r by the argument for a hinge, which soft springs do not harm [s2]; inf if it fails."""
        if self.scene.mount.precone:
            return np.inf
        width, shear = self.cells[1], self.scene.physics.shear
        tilting = float(width @ self.moments)
        spare = float(width @ self.tension) / (2 if shear else 1) - 2 * tilting
        if spare <= 0 or (self.tension < 0).any() or self._turns_in_plane:
            return np.inf
        bending, by_mean, by_rest = float(width @ self.flexibility), *self._products_at_hinge
        ratio = 2 * tilting * bending + by_mean**2 / (4 * spare) + by_mean * bending**0.5 + by_rest
        if not shear:
            return ratio
        smaller = np.linalg.eigvalsh(self._tensor("shear_stiffness"))[:, 0]
        return max(ratio, float((self.tension / smaller).max()))

    @property
    def _turns_in_plane(self) -> bool:
        """Whether bending in one plane, or a hinge that matters, turns the beam in the plane of rotation."""
        if self.planes == 1:
            return bool(self.components[0].any())
        springs = np.array(self.scene.mount.root_stiffnesses)
        return self.oblique and bool(self.components[0][springs == 0].any())

    @property
    def _products_at_hinge(self) -> tuple[float, float]:
        """The numbers A [kg^(1/2) m s] and G [s2] of the docstring of this module."""
        if not self.oblique:
            return 0.0, 0.0
        width, slope = self.cells[1], np.sqrt(self.compliance[:, 0, 0])
        g2 = self.torque**2 * self.flexibility * width
        direct = width @ (np.abs(self.products) * slope) + abs(self.body) * slope[-1]
        return float(direct + np.sqrt(g2.sum())), float(np.sqrt(g2 @ slope**2))

    @cached_property
    def torque(self) -> np.ndarray:
        """Torque g per squared speed (n,) [kg m2]."""
        return np.cumsum((self.cells[1] * self.products)[::-1])[::-1] - self.body

    @cached_property
    def tension(self) -> np.ndarray:
        """Tension N per squared speed (n,) [kg m], with that at the tip in the last cell."""
        n_a, n_b = axial_tension(self.beam)
        inward = self.scene.mount.radius * exact_cos_sin(self.scene.mount.setting_angle)[0]
        xi = self.cells[0].copy()
        xi[-1] = 1.0
        return n_b(xi) - inward * n_a(xi)
