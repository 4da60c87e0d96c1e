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
positive, `beamdyn.modes.toppling` says below which speed they buckle nothing, usually one at which the
axial strain of the beam has passed 1 %, where linear theory ends.

**String.**  Else, least over D, F is the form of a string with a mass at its end.  Its lowest eigenvalue
decides; it converges fast, as without bending stiffness there are no thin layers.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from beamdyn.equations.discretization import FIXED
from beamdyn.equations.fields.transverse import plane_components
from beamdyn.equations.mass import axial_tension, gram_by_mass, moments_about_root
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.toppling import (
    least_toppling_speed,
    strain_limit_comes_first,
    topples_in_slender_limit,
)
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import Profile
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import centrifugal_inertia, section_tensor

_ROUNDING = 64 * float(np.finfo(float).eps)  # of a sum, relative to its terms
_SHORTEST = 1e-12  # distance from the tip below which a point mass stands there, as x/L
_STRING_SIZES = 60, 100  # functions on all segments together, in two bases that must agree
_RESOLVED = 10  # distance of an eigenvalue from its limit, relative to that of the two bases


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
    found = next((b for b in by_plane if b.exists), None) or next(
        (b for b in by_plane if b.exists is None), None
    )
    if found is not None:
        return found
    if math.isfinite(toppling := least_toppling_speed(scene)):
        return _decide_toppling(scene, toppling)
    if turning == 0:
        return Buckling(
            False, "the rotation stiffens the beam against every deflection but a turn about its hinge"
        )
    return by_plane[0]


def _decide_toppling(scene: Scene, none_below: float) -> Buckling:
    """Decide where the rotation stiffens the beam, but for the inertia of what tilts."""
    why = (
        "the rotation stiffens the beam; only the rotary inertia of what tilts out of the plane can buckle it"
    )
    exists = True if topples_in_slender_limit(scene) else None
    return Buckling(exists, why, math.inf if strain_limit_comes_first(scene) else None, none_below)


def _decide_in_plane(form: _SpinForm) -> Buckling:
    """Decide for a slender beam in one plane."""
    if form.tension_at_root < 0 or form.tension_at_tip < 0:
        return Buckling(True, "the rotation compresses a part of the beam")
    if form.toppling < 0 or (form.toppling == 0 and form.coupling):
        return Buckling(True, "the rotation topples the tip body, however stiff the beam")
    if form.stiffens:
        return Buckling(False, "the rotation stiffens the beam against every deflection")
    return _decide_by_string(form)


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
    tip = scene.beam.tip or TipMass(0.0)
    _, first, second = moments_about_root(scene.beam)
    reach = scene.beam.length + tip.offset
    d, n = plane_components(scene)
    cosine, sine = exact_cos_sin(scene.mount.precone)
    by_turn = (cosine**2 - sine**2) * np.outer(n, n) - sine**2 * np.outer(d, d)
    tilting = _tilting_resistance(scene) + by_turn * (second + tip.mass * reach**2)
    form = tilting - cosine * _inward(scene) * (first + tip.mass * reach) * np.eye(2)
    least = float(np.linalg.eigvalsh(form[np.ix_(hinges, hinges)])[0])
    size = float(np.abs(tilting).max() + abs(_inward(scene)) * (first + tip.mass * reach))
    return least if abs(least) > _ROUNDING * size else 0.0


def _tilting_resistance(scene: Scene) -> np.ndarray:
    """Form (2, 2) of the spin of tip body and sections in a rigid turn [kg m2]."""
    beam = scene.modelled_beam
    B = centrifugal_inertia(beam.tip or TipMass(0.0), beam.tip_twist)
    for (i, j), inertia in section_tensor(beam, "rotary_inertia").items():
        B[i, j] -= beam.length * _integral(inertia)
    n = np.array(plane_components(scene)[1])
    turned = np.outer(n, n @ B)
    cosine, sine = exact_cos_sin(scene.mount.precone)
    return cosine**2 * (turned + turned.T) / 2 - sine**2 * B


def _integral(profile: Profile) -> float:
    """Integral over x/L."""
    return float(profile.outboard_integral()(np.zeros(1))[0])


# The string ---------------------------------------------------------------------------------------


def _decide_by_string(form: _SpinForm) -> Buckling:
    """Compare the lowest eigenvalue of the string with 1, above which F >= 0."""
    coarse, fine = (_lowest_of_string(form, size) for size in _STRING_SIZES)
    if fine < 1 - _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(True, "the rotation softens the beam more than its tension stiffens it")
    if fine - 1 > _RESOLVED * (coarse - fine) + _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(False, "the tension by rotation stiffens the beam more than rotation softens it")
    return Buckling(None, "tension stiffens the beam by as much as rotation softens it, within the error")


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
