"""Whether rotation buckles a beam at any speed, decided without a search for that speed.

A critical speed exists exactly if some deflection u lowers the form that multiplies the squared speed,

    F(u) = int N u'^2 - c^2 int rho A u^2 - c^2 m t^2 + (s^2 (J_e - J_1) + eps N(L)) D^2,

with the tension N = N_B - a N_A per squared speed, a = r cos(phi), t = u(L) + eps D, D = u'(L); symbols as
in docs/conventions.md.  Bending stiffness is not in F.  So any deflection counts that is 0 at the root,
whatever its slope there, and D does not depend on it: a short bend at the tip gives any D.

rho A dx is the mass, that of point masses along the beam with it; N is less beyond each of them.

**Tension.**  Where N < 0, short waves make F negative.  As N' = -rho A (x - a), N is least at an end.

**Tip body.**  Let T be the matrix of F in (u(L), D) after completing a square with u = x, a rigid turn:

    F = int N (u' - u/x)^2 + int rho A (s^2 x - a) u^2 / x + (u(L), D) T (u(L), D)^T,
    T_11 = m (s^2 L + eps - a) / L,  T_12 = -c^2 m eps,  T_22 = s^2 (J_e - J_1) + m eps (L - a + s^2 eps).

If T_22 < 0, or T_22 = 0 and T_12 is not, the tip body topples, however stiff the beam.  If a <= 0 and
T >= 0, then F >= 0.

**Precone** eta gives N = N_B cos^2 eta + r N_A cos eta.  Over cos^2 eta, F is the form with
a = -r / cos eta, the coefficients 1 / cos^2 eta in place of c^2 = 1 in the plane of rotation and tan^2 eta in
place of 0 out of it, J_e - J_1 less tan^2 eta B, and s^2 = 1 - c^2 of either sign: the integral of
(s^2 x - a) rho A u^2 / x is not negative where s^2 L >= a.

**Two planes.**  Neither bending stiffness nor twist is in F, which in the directions in the plane of
rotation (c = 1) and out of it (s = 1) falls into two forms of this kind: a critical speed exists if it does
in either.  A tip body has J_e - J_1 out of the plane, of the axes of its section.

**Shear** frees the slope of the sections, hence D, from that of the deflection: F is the same.

**Springs** at the root or along the beam are stiffness, and change nothing.  At a hinge without springs along
the beam, a rigid turn u = x has no stiffness:

    F(x) = s^2 (I_0 + J_e - J_1 - int rho I) - a S_1,  I_0 = int rho A x^2 + m (L + eps)^2,

with S_1 = int rho A x + m (L + eps).  If F(x) < 0, the beam is unstable at every speed, if F(x) = 0, neutral.

**Rotary inertia** of sections that tilt out of the plane of rotation, and a tip body with a product of
inertia between both planes, may lower F without limit in a bend of no length.  Where F without them is
positive, the last section says below which speed they buckle nothing, usually one at which the axial strain
of the beam has passed 1 %, where linear theory ends.

**String.**  Else, least over D, F is the form of a string with a mass at its end.  Its lowest eigenvalue
decides; it converges fast, as without bending stiffness there are no thin layers.

**Toppling.**  Let F0 be the form of above for a slender beam, and E twice the energy of bending and of
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

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.linalg import eigh

from beamdyn.equations.discretization import FIXED
from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.mass import axial_tension, gram_by_mass, moments_about_root
from beamdyn.equations.ritz import Ritz
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import centrifugal_inertia, section_tensor

_ROUNDING = 64 * float(np.finfo(float).eps)  # of a sum, relative to its terms
_SHORTEST = 1e-12  # distance from the tip below which a point mass stands there, as x/L
_STRING_SIZES = 60, 100  # functions on all segments together, in two bases that must agree
_RESOLVED = 10  # distance of an eigenvalue from its limit, relative to that of the two bases
_CELLS = 2000  # of the midpoint rule on all segments together
_MARGIN = 1.01  # for its error
_LARGE_STRAIN = 0.01  # axial, in order of magnitude (speed L / speed of sound)^2: linear theory ends
_ALIGNED = 1e-14  # product of inertia relative to the moments below which a body is not oblique


@dataclass(frozen=True)
class Buckling:
    """Whether a beam in bending has a critical speed.

    Parameters
    ----------
    exists : bool or None
        None if this could not be decided.
    why : str
        The argument, in words.
    speed : float or None
        Critical speed [rad/s], where the argument supplies it: 0 if the beam is unstable at every speed, inf
        if its axial strain passes 1 % first; None if it is to be sought.
    none_below : float
        Where only the inertia of tilting sections can buckle the beam: a speed [rad/s] below which it does
        not; else 0.
    """

    exists: bool | None
    why: str
    speed: float | None = None
    none_below: float = 0.0


def decide_buckling(scene: Scene) -> Buckling:
    """Decide whether bending has a critical speed, by the arguments in the docstring of this module."""
    if (turning := _least_turning(scene)) < 0:
        return Buckling(True, "the rotation turns the beam about its hinge", speed=0.0)
    by_plane = [_decide_in_plane(form) for form in _SpinForm.of_planes(scene)]
    for exists in (True, None):
        if found := [each for each in by_plane if each.exists is exists]:
            return found[0]
    inertia = _Inertia(scene)
    if inertia.topples:  # the rotation stiffens the beam, but for the inertia of what tilts
        why = "only the rotary inertia of what tilts out of the plane can buckle it"
        slowest = float((_MARGIN * min(inertia.softening, inertia.softening_at_hinge)) ** -0.5)
        strained = slowest >= _LARGE_STRAIN**0.5 * inertia.sound_speed
        exists = True if inertia.topples_in_slender_limit else None
        speed = math.inf if strained else None
        return Buckling(exists, f"the rotation stiffens the beam; {why}", speed, slowest)
    if turning == 0:
        why = "the rotation stiffens the beam against every deflection but a turn about its hinge"
        return Buckling(False, why)
    return by_plane[0]


def _decide_in_plane(form: _SpinForm) -> Buckling:
    """Decide for a slender beam in one plane, at last by the string: if its lowest eigenvalue > 1, F >= 0."""
    if form.tension_at_root < 0 or form.tension_at_tip < 0:
        return Buckling(True, "the rotation compresses a part of the beam")
    if form.toppling < 0 or (form.toppling == 0 and form.coupling):
        return Buckling(True, "the rotation topples the tip body, however stiff the beam")
    if form.stiffens:
        return Buckling(False, "the rotation stiffens the beam against every deflection")
    coarse, fine = (_lowest_of_string(form, size) for size in _STRING_SIZES)
    if fine < 1 - _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(True, "the rotation softens the beam more than its tension stiffens it")
    if fine - 1 > _RESOLVED * (coarse - fine) + _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(False, "the tension by rotation stiffens the beam more than rotation softens it")
    return Buckling(None, "tension stiffens the beam by as much as rotation softens it, within the error")


@dataclass(frozen=True)
class _SpinForm:
    """The form F of a scene.

    Parameters
    ----------
    beam : Beam
        The beam.
    inward : float
        a [m].
    cos_squared : float
        c^2, above 1 in the plane of rotation with precone.
    tip_mass : float
        m [kg].
    tension_at_root, tension_at_tip : float
        N(0) and N(L) [kg m].
    toppling : float
        T_22 [kg m2].
    coupling : float
        -T_12 [kg m].
    tip_determinant : float
        Determinant of T, times L / m [kg m3].
    """

    beam: Beam
    inward: float
    cos_squared: float
    tip_mass: float
    tension_at_root: float
    tension_at_tip: float
    toppling: float
    coupling: float
    tip_determinant: float

    @classmethod
    def of_planes(cls, scene: Scene) -> Iterator[_SpinForm]:
        """Yield the form of a beam in one plane, or those in the plane of rotation and out of it."""
        beam, tip, a = scene.modelled_beam, scene.beam.tip or TipMass(0.0), _inward(scene)
        cosine, sine = exact_cos_sin(scene.mount.precone)
        slope2 = (sine / cosine) ** 2  # 0 without precone
        B = centrifugal_inertia(tip, beam.tip_twist)
        if scene.physics.planes == 1:
            cos2, sin2 = (v**2 for v in aligned_cos_sin(scene.mount.bending_angle))
            tilt = (sin2 - slope2) * (tip.inertia_about_bending_direction - tip.axial_inertia)
            yield cls.of(beam, a / cosine, cos2 + slope2, sin2 - slope2, tilt)
            return
        d, n = map(np.array, plane_components(scene))
        yield cls.of(beam, a / cosine, 1.0 + slope2, -slope2, -slope2 * float(d @ B @ d))
        yield cls.of(beam, a / cosine, slope2, 1.0 - slope2, (1.0 - slope2) * float(n @ B @ n))

    @classmethod
    def of(cls, beam: Beam, a: float, cos2: float, sin2: float, tilt: float) -> _SpinForm:
        """Compute the numbers of a beam that bends in one plane; `tilt` is what is said of J_e - J_1."""
        L, tip = beam.length, beam.tip or TipMass(0.0)
        m, eps, reach = tip.mass, tip.offset, L + tip.offset - a
        n_a, n_b = (float(n(np.zeros(1))[0]) for n in axial_tension(beam))
        xi, lumped = beam.lumps
        lump = float(lumped[xi > 1 - _SHORTEST].sum())
        return cls(
            beam=beam,
            inward=a,
            cos_squared=cos2,
            tip_mass=m,
            tension_at_root=_sum(n_b, -a * n_a),
            tension_at_tip=_sum((m + lump) * L, m * eps, -(m + lump) * a),
            toppling=_sum(tilt, m * eps * L, -m * eps * a, m * eps * sin2 * eps),
            coupling=cos2 * m * eps,
            tip_determinant=_sum(
                *(tilt * v for v in (sin2 * L, eps, -a)),
                *(m * eps * reach * v for v in (sin2 * L, sin2 * eps, -a)),
            ),
        )

    @property
    def stiffens(self) -> bool:
        """Whether F >= 0 is known without the string."""
        if min(self.tension_at_root, self.tension_at_tip, self.toppling) < 0:
            return False
        flat = self.toppling == 0  # then T_12 is 0, too, and T_11 has the sign of the tension at the tip
        if self.cos_squared == 0:
            return True
        pulled = self.inward <= min(0.0, (1 - self.cos_squared) * self.beam.length)
        return pulled and (flat or self.tip_determinant >= 0)

    @property
    def end_mass(self) -> float:
        """Mass c^2 m (1 + c^2 m eps^2 / T_22) at the end of the string [kg]."""
        swing = self.coupling**2 / self.toppling if self.coupling else 0.0
        return self.cos_squared * self.tip_mass + swing


def _sum(*terms: float) -> float:
    """Add terms; 0 if the sum is within their rounding errors.

    A critical speed that hangs on less than these errors lies beyond 1e6 sqrt(EI / (rho A L^4)).
    """
    total = math.fsum(terms)
    return total if abs(total) > _ROUNDING * math.fsum(map(abs, terms)) else 0.0


def _inward(scene: Scene) -> float:
    """Distance a of the root from the axis of rotation, against the direction of the beam [m]."""
    return scene.mount.radius * exact_cos_sin(scene.mount.setting_angle)[0]


def _least_turning(scene: Scene) -> float:
    """Least of the form F over rigid turns about a hinge, of unit angle [kg m2]; inf without a hinge."""
    springs = scene.mount.root_stiffnesses[: scene.physics.planes]
    held = [scene.beam.springs(direction)[1].size > 0 for direction in range(len(springs))]  # by springs
    hinges = np.flatnonzero((np.array(springs) == 0) & ~np.array(held))
    if not hinges.size:
        return math.inf
    beam, tip = scene.modelled_beam, scene.beam.tip or TipMass(0.0)
    _, first, second = moments_about_root(scene.beam)
    reach = beam.length + tip.offset
    (d, n), (cosine, sine) = map(np.array, plane_components(scene)), exact_cos_sin(scene.mount.precone)
    B = centrifugal_inertia(tip, beam.tip_twist)
    for (i, j), inertia in section_tensor(beam, "rotary_inertia").items():
        B[i, j] -= beam.length * float(inertia.outboard_integral()(np.zeros(1))[0])
    turned = np.outer(n, n @ B)
    of_bodies = cosine**2 * (turned + turned.T) / 2 - sine**2 * B
    by_turn = (cosine**2 - sine**2) * np.outer(n, n) - sine**2 * np.outer(d, d)
    tilting = of_bodies + by_turn * (second + tip.mass * reach**2)
    form = tilting - cosine * _inward(scene) * (first + tip.mass * reach) * np.eye(2)
    least = float(np.linalg.eigvalsh(form[np.ix_(hinges, hinges)])[0])
    size = float(np.abs(tilting).max() + abs(_inward(scene)) * (first + tip.mass * reach))
    return least if abs(least) > _ROUNDING * size else 0.0


def _lowest_of_string(form: _SpinForm, size: int) -> float:
    """Lowest ratio of the work of the tension to that of the spin, by a Ritz basis: never too low."""
    beam, segments = form.beam, len(form.beam.breakpoints) - 1
    space = Ritz(max(2, size // segments)).spaces(beam).functions(FIXED)
    n_a, n_b = axial_tension(beam)
    tension = space.gram(n_b, 1) - form.inward * space.gram(n_a, 1)
    end, length = space.end(0), beam.length
    spin = form.cos_squared * length * gram_by_mass(beam, space)
    spin += form.end_mass * length * np.outer(end, end)
    return float(1 / eigh(spin, tension, eigvals_only=True)[-1])


# The inertia of what tilts --------------------------------------------------------------------------


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
    def components(self) -> np.ndarray:
        """Rows: the plane of rotation and out of it, in the directions of bending; shape (2, planes)."""
        return np.array(plane_components(self.scene))[:, : self.scene.physics.planes]

    def _tensor(self, name: str) -> np.ndarray:
        """A property of the sections in the directions of bending: shape (n, planes, planes)."""
        values = np.zeros((len(self.cells[0]), self.scene.physics.planes, self.scene.physics.planes))
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
        if self.scene.physics.planes == 1:
            return 0.0
        B = self._turned(centrifugal_inertia(self.beam.tip or TipMass(0.0), self.beam.tip_twist))
        cosine, sine = exact_cos_sin(self.scene.mount.precone)
        product = float(B[0, 1]) if abs(B[0, 1]) > _ALIGNED * np.abs(B).max() else 0.0
        return product * max(1.0, abs(cosine**2 - 2 * sine**2))

    @cached_property
    def moments(self) -> np.ndarray:
        """Rotary inertia (n,) that multiplies theta3^2 [kg m]: I33, or all of it in one plane."""
        if self.scene.physics.planes == 2:
            return self.tensors[:, 1, 1]
        return self._tensor("rotary_inertia")[:, 0, 0] * bool(self.components[1, 0])

    @cached_property
    def products(self) -> np.ndarray:
        """Products of inertia I23 of the sections (n,) [kg m]; 0 within rounding, or in one plane."""
        I23 = self.tensors[:, 0, 1] if self.scene.physics.planes == 2 else np.zeros(len(self.tensors))
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

    @cached_property
    def compliance(self) -> np.ndarray:
        """Compliance C at the cells (n, 2, 2) [1/(N m)]."""
        springs = self.scene.mount.root_stiffnesses[: self.scene.physics.planes]
        root = np.diag(
            [1 / k if k else 0.0 for k in springs]
        )  # of hinges that matter there is no bound, see `softening`
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
        springs = self.scene.mount.root_stiffnesses[: self.scene.physics.planes]
        tilting = zip(springs, self.components[1], strict=True)
        if any(k == 0 and (n or self.oblique) for k, n in tilting):  # without bending
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
        width, shear, springs = self.cells[1], self.scene.physics.shear, self.scene.mount.root_stiffnesses
        in_plane, tilting = self.components[0], float(width @ self.moments)
        if self.scene.physics.planes == 2:  # a hinge that matters
            in_plane = in_plane[np.array(springs) == 0] * self.oblique
        spare = float(width @ self.tension) / (2 if shear else 1) - 2 * tilting
        if spare <= 0 or (self.tension < 0).any() or in_plane.any():
            return np.inf
        bending, A, G = float(width @ self.flexibility), 0.0, 0.0
        if self.oblique:
            slope, g2 = np.sqrt(self.compliance[:, 0, 0]), self.torque**2 * self.flexibility * width
            direct = width @ (np.abs(self.products) * slope) + abs(self.body) * slope[-1]
            A, G = float(direct + np.sqrt(g2.sum())), float(np.sqrt(g2 @ slope**2))
        ratio = 2 * tilting * bending + A**2 / (4 * spare) + A * bending**0.5 + G
        if not shear:
            return ratio
        smaller = np.linalg.eigvalsh(self._tensor("shear_stiffness"))[:, 0]
        return max(ratio, float((self.tension / smaller).max()))

    @property
    def topples_in_slender_limit(self) -> bool:
        """Whether sections or a tip body surely topple whatever the stiffness, in a bend of no length."""
        if self.scene.mount.precone:
            return False  # it is not known
        free_end = self.tension[-1] < self.moments[-1] * (self.components[1] ** 2).sum()
        return bool(self.scene.physics.shear or self.oblique or free_end)

    @cached_property
    def torque(self) -> np.ndarray:
        """Torque g per squared speed (n,) [kg m2]."""
        return np.cumsum((self.cells[1] * self.products)[::-1])[::-1] - self.body

    @cached_property
    def tension(self) -> np.ndarray:
        """Tension N per squared speed (n,) [kg m], with that at the tip in the last cell."""
        (n_a, n_b), xi = axial_tension(self.beam), self.cells[0].copy()
        xi[-1] = 1.0
        return n_b(xi) - _inward(self.scene) * n_a(xi)
