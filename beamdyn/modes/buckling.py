"""Decision whether rotation buckles a beam at any speed, without a search for the critical speed.

A critical speed exists if and only if, for some deflection u, the form that multiplies the squared speed is
negative,

    F(u) = int N u'^2 - c^2 int rho A u^2 - c^2 m t^2 + (s^2 (J_e - J_1) + eps N(L)) D^2,

with the tension N = N_B - a N_A per squared speed, a = r cos(phi), t = u(L) + eps D, D = u'(L); symbols as in
docs/conventions.md.  Bending stiffness is not in F.  So any deflection that is 0 at the root is admissible,
whatever its slope there, and D is independent of u: a short bend at the tip gives any D.

rho A dx includes the point masses along the beam; N is smaller beyond each of them.

**Tension.**  Where N < 0, short waves make F negative.  As N' = -rho A (x - a), N is least at an end.

**Tip body.**  Let T be the matrix of F in (u(L), D) after completing a square with u = x, a rigid rotation:

    F = int N (u' - u/x)^2 + int rho A (s^2 x - a) u^2 / x + (u(L), D) T (u(L), D)^T,
    T_11 = m (s^2 L + eps - a) / L,  T_12 = -c^2 m eps,  T_22 = s^2 (J_e - J_1) + m eps (L - a + s^2 eps).

If T_22 < 0, or T_22 = 0 and T_12 is not, the tip body topples, however stiff the beam.  If a <= 0 and
T >= 0, then F >= 0.

**Precone** eta gives N = N_B cos^2 eta + r N_A cos eta.  Divided by cos^2 eta, F is the form above with
a = -r / cos eta.  In the plane of rotation c^2 is 1 / cos^2 eta in place of 1, out of it tan^2 eta in place
of 0.  In either plane s^2 = 1 - c^2, which may have either sign.  The integral of (s^2 x - a) rho A u^2 / x
is not negative where s^2 L >= a.

**Two planes.**  Neither bending stiffness nor twist is in F, which splits into two forms of this kind, in the
plane of rotation (c = 1) and out of it (s = 1): a critical speed exists if it does in either.  A tip body has
J_e - J_1 out of the plane, of the axes of its section.

**Shear** makes the rotation of the sections, hence D, independent of the slope of the deflection: F is the
same.

**Springs** at the root or along the beam are stiffness, which is not in F.  With a hinge and no springs along
the beam, a rigid rotation u = x has no stiffness:

    F(x) = s^2 (I_0 + J_e - J_1 - int rho I) - a S_1,  I_0 = int rho A x^2 + m (L + eps)^2,

with S_1 = int rho A x + m (L + eps).  If F(x) < 0, the beam is unstable at every speed, if F(x) = 0, neutral.

**Rotary inertia** of sections that tilt out of the plane of rotation, and a tip body with a product of
inertia between both planes, may lower F without limit in an infinitely short bend.  Where F without them is
positive, the last section gives a speed below which they cannot cause buckling, usually one at which the
axial strain of the beam has passed 1 %, where linear theory ends.

**String.**  Otherwise, minimized over D, F is the form of a string with a mass at its end: the work of the
tension minus that of centrifugal forces.  The smallest ratio of the first to the second, the lowest
eigenvalue of the string, decides: F >= 0 if it is at least 1.  Ritz's method finds this eigenvalue with few
functions, as without bending stiffness there are no boundary layers.

**Toppling.**  Let F0 be the form F above for a slender beam, and W twice the strain energy of bending and of
the springs at the root.  With the tilt theta of the sections (theta2 in the plane of rotation, theta3 out of
it), the tensor I of their rotary inertia and that of the tip body, B, rotation adds to F0

    -int (I33 theta3^2 + I23 theta2 theta3) + B23 theta2 theta3 at the tip
    + int g (theta2 theta3' - theta3 theta2'),    g(x) = int_x^L I23 - B23,

where B33 theta3^2 at the tip is a part of F0.  With the compliance C(x), the integral of the sections'
compliances from the root to x plus the compliance of the springs, theta_i^2 <= C_ii W.  So rotation adds at
least -R W per squared speed, with

    R = int (I33 C33 + |I23| (C22 C33)^(1/2)) + |B23| (C22 C33)^(1/2) + (int g^2 trace(C) / EI)^(1/2),

with the smaller bending stiffness EI at x.  **If F0 >= 0, no speed below R^(-1/2) is critical.**  For a
uniform beam that is 2^(1/2) times the speed of sound in its material, over the length.

A hinge has an infinite C.  If it turns out of the plane only, where F0 >= int N u'^2, split theta3 into its
mean with the weight N and a remainder, which is at most (e W)^(1/2) with e = int 1/EI.  If
S = int N - 2 int I33 > 0,

    R = 2 e int I33 + p^2 / (4 S) + p e^(1/2) + q,    q = (int g^2 C22 / EI)^(1/2),
    p = int |I23| C22^(1/2) + |B23| C22^(1/2) + (int g^2 / EI)^(1/2).

With shear, which causes a part of u', S = int N / 2 - 2 int I33, and R is at least N divided by the shear
stiffness kappa G A, everywhere.

Precone eta multiplies all but B23 by cos^2 eta <= 1, and adds sin^2 eta I to the form, which is not negative;
B23 has the factor cos^2 eta - 2 sin^2 eta.  The arguments for a hinge and for a short bend are not used then.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
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
from beamdyn.scene.sections import section_tensor, tip_inertia

# Rounding error of a sum, relative to the magnitudes of its terms.
_ROUNDING = 64 * float(np.finfo(float).eps)
_SHORTEST = 1e-12  # distance x/L of a point mass from the tip below which it counts as a tip mass
# Numbers of functions, on all segments together, of two bases whose results must agree.
_STRING_SIZES = 60, 100
# The string's eigenvalue decides only if its distance from 1 exceeds this number times the difference between
# the eigenvalues of the two bases.
_RESOLVED = 10
_CELLS = 2000  # number of cells of the midpoint rule on all segments together
_MARGIN = 1.01  # factor that allows for the error of the midpoint rule
# Order of magnitude of the axial strain, (speed L / speed of sound)^2, at which linear theory ends.
_LARGE_STRAIN = 0.01
_ALIGNED = 1e-14  # ratio of a product of inertia to the moments of inertia below which it counts as 0


@dataclass(frozen=True)
class Buckling:
    """Decision whether a beam in bending has a critical speed, with the theoretical reason.

    Parameters
    ----------
    exists : bool or None
        Whether there is a critical speed; None if this could not be decided.
    why : str
        Theoretical reason of the decision, as a clause.
    speed : float or None
        Critical speed [rad/s], if it follows from the theory: 0 if the beam is unstable at every speed, inf
        if its axial strain passes 1 % first; None if a search is needed.
    none_below : float
        If only the inertia of tilting sections can buckle the beam, a speed [rad/s] below which it does not;
        otherwise 0.
    """

    exists: bool | None
    why: str
    speed: float | None = None
    none_below: float = 0.0


def decide_buckling(scene: Scene) -> Buckling:
    """Decide whether bending has a critical speed, by the arguments in the docstring of this module.

    The arguments do not hold if offsets of section centres couple bending with torsion.
    """
    if scene.physics.torsion and scene.beam.has_offsets:
        return Buckling(None, "no argument covers sections with offsets")
    if (turning := _least_turning(scene)) < 0:
        return Buckling(True, "rotation makes the beam unstable about its hinge", speed=0.0)
    beam, tip = scene.modelled_beam, scene.beam.tip or TipMass(0.0)
    cosine, sine = exact_cos_sin(scene.mount.precone)
    # tan^2 eta of the precone eta, and a of the module's docstring.
    slope2, a = (sine / cosine) ** 2, _inward(scene) / cosine
    if scene.physics.planes == 1:
        cos2, sin2 = (v**2 for v in aligned_cos_sin(scene.mount.bending_angle))
        tilt = (sin2 - slope2) * (tip.inertia_about_bending_direction - tip.axial_inertia)
        by_plane = [_decide_in_plane(beam, a, cos2 + slope2, sin2 - slope2, tilt)]
    else:
        (d, n), B = map(np.array, plane_components(scene)), tip_inertia(tip, beam.tip_twist).centrifugal
        tilts = -slope2 * float(d @ B @ d), (1.0 - slope2) * float(n @ B @ n)
        by_plane = [
            _decide_in_plane(beam, a, 1.0 + slope2, -slope2, tilts[0]),
            _decide_in_plane(beam, a, slope2, 1.0 - slope2, tilts[1]),
        ]
    for exists in (True, None):
        if found := [each for each in by_plane if each.exists is exists]:
            return found[0]
    if (toppling := _decide_toppling(scene)) is not None:
        return toppling
    if turning == 0:
        why = "the rotation stiffens the beam against every deflection but a turn about its hinge"
        return Buckling(False, why)
    return by_plane[0]


def _decide_in_plane(beam: Beam, a: float, cos2: float, sin2: float, tilt: float) -> Buckling:
    """Decide whether a slender beam in one plane has a critical speed, if need be by an equivalent string.

    The parameters, with the symbols of the module's docstring, are a, the distance of the root from the axis
    of rotation times cos(setting angle), positive for an inward beam [m]; c^2 and s^2; and `tilt`, the part
    of T_22 by the moments of inertia J_e and J_1 [kg m2].
    """
    L, tip = beam.length, beam.tip or TipMass(0.0)
    m, eps, reach, (xi, lumped) = tip.mass, tip.offset, L + tip.offset - a, beam.lumps
    n_a, n_b = (float(n(np.zeros(1))[0]) for n in axial_tension(beam))
    lump = float(lumped[xi > 1 - _SHORTEST].sum())
    at_root, at_tip = _sum(n_b, -a * n_a), _sum((m + lump) * L, m * eps, -(m + lump) * a)
    # T_22 of the matrix T in the module's docstring.
    toppling = _sum(tilt, m * eps * L, -m * eps * a, m * eps * sin2 * eps)
    coupling = cos2 * m * eps  # -T_12 of the matrix T in the module's docstring
    if at_root < 0 or at_tip < 0:
        return Buckling(True, "the rotation compresses a part of the beam")
    if toppling < 0 or (toppling == 0 and coupling):
        return Buckling(True, "the rotation topples the tip body, however stiff the beam")
    determinant = _sum(  # determinant of the matrix T in the module's docstring, times L / m
        *(tilt * v for v in (sin2 * L, eps, -a)), *(m * eps * reach * v for v in (sin2 * L, sin2 * eps, -a))
    )
    # Of the matrix T in the module's docstring: if T_22 = 0, T_12 is 0 here as well, and T_11 has the sign of
    # the tension at the tip, which is not negative here.  So T >= 0 without a check of the determinant.
    pulled = a <= min(0.0, (1 - cos2) * L) and (toppling == 0 or determinant >= 0)
    if cos2 == 0 or pulled:
        return Buckling(False, "the rotation stiffens the beam against every deflection")
    # Mass at the end of the string, c^2 m (1 + c^2 m eps^2 / T_22); symbols: see the module's docstring.
    end_mass = cos2 * m + (coupling**2 / toppling if coupling else 0.0)
    coarse, fine = (_lowest_of_string(beam, a, cos2, end_mass, size) for size in _STRING_SIZES)
    if fine < 1 - _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(True, "the rotation softens the beam more than its tension stiffens it")
    if fine - 1 > _RESOLVED * (coarse - fine) + _ROUNDING * _STRING_SIZES[-1]:
        return Buckling(False, "the tension by rotation stiffens the beam more than rotation softens it")
    return Buckling(None, "tension stiffens the beam by as much as rotation softens it, within the error")


def _lowest_of_string(beam: Beam, a: float, cos2: float, end_mass: float, size: int) -> float:
    """Compute the lowest eigenvalue of the string with a mass at its end by Ritz's method, which is above it.

    The eigenvalue is the ratio of the work of the tension to that of centrifugal forces; see the docstring of
    this module.  `size` is the number of trial functions on all segments together.
    """
    space = Ritz(max(2, size // (len(beam.breakpoints) - 1))).spaces(beam).functions(FIXED)
    n_a, n_b = axial_tension(beam)
    tension = space.gram(n_b, 1) - a * space.gram(n_a, 1)
    end, length = space.end(0), beam.length
    spin = cos2 * length * gram_by_mass(beam, space)
    spin += end_mass * length * np.outer(end, end)
    return float(1 / eigh(spin, tension, eigvals_only=True)[-1])


def _sum(*terms: float) -> float:
    """Add numbers; return 0 if the sum is within their rounding errors.

    A sum that is wrongly taken for 0 can hide only a critical speed above 1e6 sqrt(EI / (rho A L^4)).
    """
    total = math.fsum(terms)
    return total if abs(total) > _ROUNDING * math.fsum(map(abs, terms)) else 0.0


def _inward(scene: Scene) -> float:
    """Compute a: hub radius times cos(setting angle) [m], positive if the beam points inward."""
    return scene.mount.radius * aligned_cos_sin(scene.mount.setting_angle)[0]


def _least_turning(scene: Scene) -> float:
    """Compute the minimum of the form F over unit rotations about a hinge [kg m2]; inf without a free hinge.

    F, which multiplies the squared speed in the stiffness, is defined in the docstring of this module.
    """
    springs = scene.mount.root_stiffnesses[: scene.physics.planes]
    # Whether springs along the beam support the beam, in each direction.
    held = [scene.beam.springs(direction)[1].size > 0 for direction in range(len(springs))]
    hinges = np.flatnonzero((np.array(springs) == 0) & ~np.array(held))
    if not hinges.size:
        return math.inf
    beam, tip = scene.modelled_beam, scene.beam.tip or TipMass(0.0)
    _, first, second = moments_about_root(scene.beam)
    reach = beam.length + tip.offset
    (d, n), (cosine, sine) = map(np.array, plane_components(scene)), exact_cos_sin(scene.mount.precone)
    B = tip_inertia(tip, beam.tip_twist).centrifugal
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


# Inertia of tilting sections and tip body ----------------------------------------------------------


def _decide_toppling(scene: Scene) -> Buckling | None:
    """Decide whether the inertia of tilting sections or a tip body buckles a beam; None if nothing tilts.

    Integrals are sums over n cells; the components of tensors (n, 2, 2) are in the plane of rotation and out
    of it.
    """
    beam, planes, mount, shear = scene.modelled_beam, scene.physics.planes, scene.mount, scene.physics.shear
    ends = np.array(beam.breakpoints)
    per_segment = max(20, _CELLS // (len(ends) - 1))
    edges = np.unique(np.concatenate([np.linspace(a, b, per_segment + 1) for a, b in pairwise(ends)]))
    xi, width = (edges[1:] + edges[:-1]) / 2, np.diff(edges) * beam.length
    components = np.array(plane_components(scene))[:, :planes]
    rotary = _tensor(beam, "rotary_inertia", xi, planes)
    moments, products, body = _tilting_inertia(scene, components, rotary)
    oblique = bool(body or products.any())
    if not (oblique or moments.any()):
        return None
    bending = _tensor(beam, "bending_stiffness", xi, planes)
    springs = np.array(mount.root_stiffnesses)[:planes]
    flexibility = 1 / np.linalg.eigvalsh(bending)[:, 0]  # 1 / smaller principal bending stiffness
    # Hinges count as rigid here; the conditions below select the arguments that hold for a hinge.
    root = np.diag([1 / k if k else 0.0 for k in springs])
    by_bending = np.cumsum(np.linalg.inv(bending) * width[:, None, None], axis=0)
    C = components @ (root + by_bending) @ components.T
    torque, slope = np.cumsum((width * products)[::-1])[::-1] - body, np.sqrt(C[:, 0, 0])
    n_a, n_b = axial_tension(beam)
    at = np.append(xi[:-1], 1.0)  # the last cell takes the value at the tip
    tension = n_b(at) - _inward(scene) * n_a(at)
    ratios = [np.inf]  # candidates of R (module's docstring) from the two arguments
    if not any(k == 0 and (n or oblique) for k, n in zip(springs, components[1], strict=True)):
        both = np.sqrt(C[:, 0, 0] * C[:, 1, 1])
        ratio = width @ (moments * C[:, 1, 1] + np.abs(products) * both)
        twisting = np.sqrt(width @ (torque**2 * np.trace(C, axis1=1, axis2=2) * flexibility))
        ratios.append(float(ratio + abs(body) * both[-1] + twisting))
    in_plane = components[0][springs == 0] * oblique if planes == 2 else components[0]
    spare = float(width @ tension) / (2 if shear else 1) - 2 * float(width @ moments)
    if not mount.precone and spare > 0 and (tension >= 0).all() and not in_plane.any():
        g2 = torque**2 * flexibility * width
        p = float(width @ (np.abs(products) * slope) + abs(body) * slope[-1] + np.sqrt(g2.sum()))
        e, q = float(width @ flexibility), float(np.sqrt(g2 @ slope**2))
        ratio = 2 * float(width @ moments) * e + p**2 / (4 * spare) + p * e**0.5 + q
        if shear:
            smaller = np.linalg.eigvalsh(_tensor(beam, "shear_stiffness", xi, planes))[:, 0]
            ratio = max(ratio, float((tension / smaller).max()))
        ratios.append(ratio)
    # The speed of sound is divided by the length of the beam [1/s].
    slowest, sound_speed = float((_MARGIN * min(ratios)) ** -0.5), 0.0
    if inertia := float(width @ rotary[:, 0, 0]):
        sound_speed = (inertia * float(width @ (1 / bending[:, 0, 0]))) ** -0.5
    speed = math.inf if slowest >= _LARGE_STRAIN**0.5 * sound_speed else None
    # Whatever the stiffness, sections or a tip body may topple in an infinitely short bend.
    free_end = tension[-1] < moments[-1] * (components[1] ** 2).sum()
    surely = not mount.precone and bool(shear or oblique or free_end)
    why = "only the rotary inertia of tilting sections or a tip body can buckle the beam"
    return Buckling(surely or None, f"the rotation stiffens the beam; {why}", speed, slowest)


def _tilting_inertia(
    scene: Scene, components: np.ndarray, rotary: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Compute I33 and I23 of n sections [kg m], and B23 of the tip body [kg m2]; symbols: see module.

    In one plane, I33 is all of the rotary inertia.  Products of inertia within rounding of 0 are set to 0.
    With precone eta, B23 is multiplied by |cos^2 eta - 2 sin^2 eta| if that exceeds 1.
    """
    if scene.physics.planes == 1:
        return rotary[:, 0, 0] * bool(components[1, 0]), np.zeros(len(rotary)), 0.0
    beam, turned = scene.modelled_beam, components @ rotary @ components.T
    B = components @ tip_inertia(beam.tip or TipMass(0.0), beam.tip_twist).centrifugal @ components.T
    cosine, sine = exact_cos_sin(scene.mount.precone)
    body = float(B[0, 1]) if abs(B[0, 1]) > _ALIGNED * np.abs(B).max() else 0.0
    oblique = np.abs(turned[:, 0, 1]) > _ALIGNED * np.abs(turned).max()
    products = np.where(oblique, turned[:, 0, 1], 0.0)
    return turned[:, 1, 1], products, body * max(1.0, abs(cosine**2 - 2 * sine**2))


def _tensor(beam: Beam, name: str, xi: np.ndarray, planes: int) -> np.ndarray:
    """Evaluate a section property in the directions of bending: shape (n, planes, planes)."""
    values = np.zeros((len(xi), planes, planes))
    for (i, j), profile in section_tensor(beam, name).items():
        if max(i, j) < planes:  # in one plane, the rotary inertia in the other is used for torsion alone
            values[:, i, j] = profile(xi)
    return values
