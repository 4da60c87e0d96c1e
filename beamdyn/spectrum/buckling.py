"""Whether rotation buckles a beam at any speed, decided without a search for that speed.

A critical speed exists exactly if some deflection u lowers the form that multiplies the squared speed,

    F(u) = int N u'^2 - c^2 int rho A u^2 - c^2 m t^2 + (s^2 (J_e - J_1) + eps N(L)) D^2,

with the tension N = N_B - a N_A per squared speed, a = r cos(phi), t = u(L) + eps D, D = u'(L); symbols as
in docs/conventions.md.  Bending stiffness is not in F.  So any deflection counts that is 0 at the root,
whatever its slope there, and D does not depend on it: a short bend at the tip gives any D.

**Tension.**  Where N < 0, short waves make F negative.  As N' = -rho A (x - a), N is least at an end.

**Tip body.**  Let T be the matrix of F in (u(L), D) after completing a square with u = x, a rigid turn:

    F = int N (u' - u/x)^2 + int rho A (s^2 x - a) u^2 / x + (u(L), D) T (u(L), D)^T,
    T_11 = m (s^2 L + eps - a) / L,  T_12 = -c^2 m eps,  T_22 = s^2 (J_e - J_1) + m eps (L - a + s^2 eps).

If T_22 < 0, or T_22 = 0 and T_12 is not, the tip body topples, however stiff the beam.  If a <= 0 and
T >= 0, then F >= 0.

**String.**  Else, least over D, F is the form of a string with a mass at its end.  Its lowest eigenvalue
decides; it converges fast, as without bending stiffness there are no thin layers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.discretization import FIXED
from beamdyn.equations.ritz import Ritz
from beamdyn.equations.root_motion import exact_cos_sin
from beamdyn.scene.beam import TipMass
from beamdyn.scene.scene import Scene

_ROUNDING = 64 * float(np.finfo(float).eps)  # of a sum, relative to its terms
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
    """

    exists: bool | None
    why: str


def decide_buckling(scene: Scene) -> Buckling:
    """Decide whether bending has a critical speed, by the arguments in the docstring of this module."""
    if not scene.is_slender_beam_in_one_plane:
        return Buckling(None, "the argument that decides it is known for a slender beam in one plane")
    form = _SpinForm.of(scene)
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
    scene : Scene
        The scene.
    inward : float
        a [m].
    cos_squared : float
        c^2.
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

    scene: Scene
    inward: float
    cos_squared: float
    tip_mass: float
    tension_at_root: float
    tension_at_tip: float
    toppling: float
    coupling: float
    tip_determinant: float

    @classmethod
    def of(cls, scene: Scene) -> _SpinForm:
        """Compute the numbers of a scene."""
        beam, L, tip = scene.beam, scene.beam.length, scene.beam.tip or TipMass(0.0)
        a = scene.mount.radius * exact_cos_sin(scene.mount.setting_angle)[0]
        cos2, sin2 = (v**2 for v in exact_cos_sin(scene.mount.bending_angle))
        m, eps, reach = tip.mass, tip.offset, L + tip.offset - a
        n_a, n_b = (float(n(np.zeros(1))[0]) for n in axial_tension(beam))
        tilt = sin2 * (tip.inertia_about_bending_direction - tip.axial_inertia)
        return cls(
            scene=scene,
            inward=a,
            cos_squared=cos2,
            tip_mass=m,
            tension_at_root=_sum(n_b, -a * n_a),
            tension_at_tip=_sum(m * L, m * eps, -m * a),
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
        return self.cos_squared == 0 or (self.inward <= 0 and (flat or self.tip_determinant >= 0))

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
    beam, segments = form.scene.beam, len(form.scene.beam.breakpoints) - 1
    space = Ritz(max(2, size // segments)).spaces(beam).functions(FIXED)
    n_a, n_b = axial_tension(beam)
    tension = space.gram(n_b, 1) - form.inward * space.gram(n_a, 1)
    end, length = space.end(0), beam.length
    spin = form.cos_squared * length**2 * space.gram(beam.mass_per_length, 0)
    spin += form.end_mass * length * np.outer(end, end)
    return float(1 / eigh(spin, tension, eigvals_only=True)[-1])
