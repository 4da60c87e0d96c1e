"""Drum brakes whose shoes slide on a flat abutment; a lining may lift in part, as it cannot pull.

Axes and angles are those of `brakes.drum`. A rigid shoe that no pin holds presses with p0 max(0, sin(alpha -
delta)): it lifts where the lining would have to pull. Its end at (b, -c) slides along the abutment without
friction: the forces along the abutment's face, and the moments about that end, add up to zero. Eliminating p0
leaves one equation for the angle delta,

    R(delta) = int max(0, sin(alpha - delta)) w(alpha) d alpha = 0,   w = w0 + w1 cos(alpha) + w2 sin(alpha).

It has one solution if w has opposite signs at the ends of the lining. Then w, a shifted cosine, has
one zero there, alpha0. Let delta be a solution and delta' be larger. The ratio
sin(alpha - delta') / sin(alpha - delta) increases with alpha and is q at alpha0, so R(delta') = R(delta') - q
R(delta) is an integral of terms that have the sign of w beyond alpha0. So R has one zero, and bisection finds
it. If w has equal signs at both ends, nothing holds the shoe, and it is reported as locked.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from brakes.machines.machine import Lining, Machine

# Numbers of bisections, which reduce a step of angles to its rounding, and an angle below 2 pi to 1e-10; a
# Newton step then squares this error.
_HALVINGS, _HALVINGS_OF_ANGLE = 52, 36
_ANGLES, _MOST = 361, 3.0  # angles among which self-locking is sought, and largest friction
# Angle of contact [rad] below which the lining counts as touching only at its edge, where the shoe has no
# equilibrium.
_LEAST_CONTACT = 1e-3
_TURN_STEP = 1e-30  # imaginary part of an angle, for complex-step derivatives
_SHOES = "single: one shoe, which leads forward; simplex: one leads, one trails; duplex: both lead forward"
_LEADS = MappingProxyType({"single": (True,), "simplex": (True, False), "duplex": (True, True)})


@dataclass(frozen=True)
class Sliding(Machine):
    """A drum brake with sliding shoes; every number may be an array, one entry per case.

    Parameters
    ----------
    drum_radius, face_width : float or ndarray
        Inner radius of the drum r, width of the lining w [m].
    lining_start, lining_end : float or ndarray
        Angles of the lining's ends, measured from straight down, where the abutment is [rad].
    abutment_offset, abutment_depth : float or ndarray
        Point where the shoe rests on its abutment: distance b from the line of symmetry, depth c below the
        drum's centre [m].
    force_arm : float or ndarray
        Height a of the actuating force above the drum's centre [m].
    abutment_angle : float or ndarray
        Angle psi from the direction of the actuating force up to that of the abutment's force [rad].
    shoes : {"single", "simplex", "duplex"}
        Number of shoes and whether they lead or trail; each is pressed by the same force.

    Raises
    ------
    ValueError
        If a value is out of bounds, the lining is empty, or the force is not above the abutment.

    References
    ----------
    Standard: equilibrium of a rigid shoe, as in the docstring of the module.

    Examples
    --------
    >>> brake = machines.Sliding(0.138, 0.05, 0.5, 2.3, 0.02, 0.11, 0.115)
    >>> found = machines.solve_brake(brake, friction=0.35, force=1000.0)
    >>> round(float(found.torque), 2)  # N m
    260.64
    """

    drum_radius: Annotated[Numbers, Described("m", "r", "inner radius of the drum", above=0)]
    face_width: Annotated[Numbers, Described("m", "w", "width of the lining along the drum's axis", above=0)]
    lining_start: Annotated[
        Numbers, Described("rad", "alpha1", "start of the lining, from straight down", least=0, below=np.pi)
    ]
    lining_end: Annotated[
        Numbers, Described("rad", "alpha2", "end of the lining, from straight down", above=0, most=np.pi)
    ]
    abutment_offset: Annotated[
        Numbers, Described("m", "b", "distance of the abutment from the line of symmetry, towards its shoe")
    ]
    abutment_depth: Annotated[
        Numbers, Described("m", "c", "depth of the abutment below the drum's centre", above=0)
    ]
    force_arm: Annotated[Numbers, Described("m", "a", "height of the force above the drum's centre", least=0)]
    abutment_angle: Annotated[
        Numbers,
        Described(
            "rad",
            "psi",
            "angle of the abutment's force above the direction of the actuating force",
            least=-np.pi / 4,
            most=np.pi / 4,
        ),
    ] = 0.0
    shoes: Annotated[Literal["single", "simplex", "duplex"], Described(meaning=_SHOES)] = "simplex"

    grips: ClassVar[str] = "shoe"
    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType(
        {
            "normal_x": Meaning("N", "pressure on the shoe, to its side"),
            "normal_y": Meaning("N", "pressure on the shoe, upward"),
            "friction_x": Meaning("N", "friction on the shoe, to its side"),
            "friction_y": Meaning("N", "friction on the shoe, upward"),
            "abutment": Meaning("N", "force of the abutment"),
        }
    )
    place: ClassVar[Meaning] = Meaning("rad", "angle from straight down", "deg")

    def check(self) -> None:
        """Check that the lining's end is past its start."""
        one_of("shoes", self.shoes, tuple(_LEADS))
        start, end = np.asarray(self.lining_start), np.asarray(self.lining_end)
        bound = "the lining is empty: it must exceed {other}, {limit}"
        refuse(end <= start, "lining_end", end, "rad", bound, limit=start, other="lining_start")

    @property
    def reference_radius(self) -> Numbers:
        """Radius of the drum [m]."""
        return self.drum_radius

    @property
    def arm(self) -> Numbers:
        """Lever arm a + c of the actuating force about the abutment [m]."""
        return self.force_arm + np.asarray(self.abutment_depth)

    def reach(self) -> tuple[Numbers, Numbers]:
        """Return the angles of the lining's ends from straight down [rad]."""
        return self.lining_start, self.lining_end

    def leads(self, reverse: bool) -> tuple[bool, ...]:
        """Return for each shoe whether it leads, forward or in reverse."""
        return tuple(leads is not reverse for leads in _LEADS[self.shoes])

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return the linings of the shoes; see `Machine.linings`."""
        leads = self.leads(reverse)
        made = {each: self._shoe(friction, each) for each in dict.fromkeys(leads)}
        return {f"shoe {i + 1}, {_word(each)}": made[each] for i, each in enumerate(leads)}

    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Compute pressure / largest pressure on a leading shoe, at angles from straight down [rad]."""
        return self._pressure(at, friction, leads=True)

    def pressure_on(self, index: int, at: Numbers, friction: Numbers, reverse: bool) -> Numbers:
        """Compute the pressure on shoe `index` at angles from straight down [rad], over its largest value."""
        return self._pressure(at, friction, self.leads(reverse)[index])

    def remarks(self, friction: Numbers, reverse: bool) -> Sequence[str]:
        """Return sentences on linings that lift in part, with the contact angles; for a single case only."""
        said = []
        for leads in dict.fromkeys(self.leads(reverse)):
            delta = self.zero(np.asarray(friction), leads)
            if delta.ndim or not np.isfinite(delta):
                continue
            start, end = np.degrees(self._contact(delta))
            if max(start - np.degrees(self.lining_start), np.degrees(self.lining_end) - end) > 1e-9:
                place = f"from {start:.4g} to {end:.4g} deg"
                said.append(f"the {_word(leads)} shoe touches {place}: the rest of its lining lifts")
        return said

    def zero(self, friction: Numbers, leads: bool) -> np.ndarray:
        """Find the angle delta of zero pressure [rad]; nan where the shoe has no equilibrium."""
        mu, s = np.real(friction), -1.0 if leads else 1.0
        first, last = self._weight(self.lining_start, mu, s), self._weight(self.lining_end, mu, s)
        low = self.lining_start - np.pi + 0 * first
        high = self.lining_end + 0 * first
        for _ in range(_HALVINGS_OF_ANGLE):
            middle = (low + high) / 2
            before = self._residual(middle, mu, s) * first > 0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        delta = np.clip(self._newton((low + high) / 2, mu, s), low, high)
        begin, end = self._contact(delta)
        return np.where((first * last < 0) & (end - begin > _LEAST_CONTACT), delta, np.nan)

    def _newton(self, delta: np.ndarray, mu: Numbers, s: float) -> Any:
        """Improve the angle of zero pressure [rad] by a Newton step; mu may be complex (complex step)."""
        with np.errstate(divide="ignore", invalid="ignore"):  # nan if the shoe has no equilibrium
            slope = self._residual(delta + 1j * _TURN_STEP, np.real(mu), s).imag / _TURN_STEP
            return delta - self._residual(delta, mu, s) / slope

    @cached_property
    def locking(self) -> Mapping[bool, Numbers]:
        """Locking friction by whether the shoe leads (True) or trails (False); inf if it is above 3."""
        return {leads: self._locking(leads) for leads in (True, False)}

    def _locking(self, leads: bool) -> Numbers:
        """Find the smallest friction at which the actuating force is not positive.

        The balance is linear in the friction, so that each angle of zero pressure belongs to one friction.
        Angles are sampled, not frictions: a range of frictions that lock, however narrow, between those
        without equilibrium and those that slide, is wide in angles. Its ends are found by bisection. A shoe
        that locks without friction has a locking friction of 0.
        """
        s = -1.0 if leads else 1.0
        flat = 0.0 * (self._weight(self.lining_start, 0.0, s) + self._weight(self.lining_end, 0.0, s))
        low, high = self.lining_start - np.pi + _LEAST_CONTACT + flat, self.lining_end - _LEAST_CONTACT + flat
        delta = np.linspace(low, high, _ANGLES)
        mu, locks = self._lock_at(delta, s)
        best = np.argmin(np.where(locks, mu, np.inf), axis=0)[None]
        inside = np.take_along_axis(delta, best, axis=0)
        outside = np.concatenate(
            [np.take_along_axis(delta, np.clip(best + k, 0, _ANGLES - 1), axis=0) for k in (-1, 1)]
        )
        for _ in range(_HALVINGS):
            middle = (inside + outside) / 2
            found = self._lock_at(middle, s)[1]
            inside, outside = np.where(found, middle, inside), np.where(found, outside, middle)
        least = np.where(locks.any(axis=0), self._lock_at(inside, s)[0].min(axis=0), np.inf)
        without = self._moment(self._integrals(self.zero(np.asarray(0.0), leads)), 0.0, s)
        return np.where(without <= 0, 0.0, least)

    def _lock_at(self, delta: np.ndarray, s: float) -> tuple[np.ndarray, np.ndarray]:
        """Compute the friction of angles of zero pressure, and whether it keeps the shoe, which locks."""
        found = self._integrals(delta)
        balance = self._balance(found, 1j, s)  # its parts belong to the friction's powers 0 and 1
        with np.errstate(divide="ignore", invalid="ignore"):
            mu = -balance.real / balance.imag
            held = self._weight(self.lining_start, mu, s) * self._weight(self.lining_end, mu, s) < 0
            return mu, held & (mu >= 0) & (mu <= _MOST) & (self._moment(found, mu, s) <= 0)

    def _shoe(self, mu: Numbers, leads: bool) -> Lining:
        """Make the lining of one shoe."""
        s, delta = -1.0 if leads else 1.0, self.zero(mu, leads)
        held = np.isfinite(delta)
        delta = np.where(held, self._newton(delta, mu, s), self.lining_start)
        K, S, C = found = self._integrals(delta)
        area = self.face_width * np.asarray(self.drum_radius) / self._peak(delta)
        force = area * self._moment(found, mu, s) / self.arm
        b, c, r = self.abutment_offset, self.abutment_depth, self.drum_radius
        far = np.abs(b) + c
        # This sum of absolute terms also bounds the rounding of the integrals.
        size = 2 * area / self.arm * (far + np.abs(mu) * (r + far))
        nx, ny, tx, ty = -area * S, area * C, s * mu * area * C, s * mu * area * S
        psi = self.abutment_angle
        abutment = -(force + nx + tx) * np.cos(psi) - (ny + ty) * np.sin(psi)
        forces = {"normal_x": nx, "normal_y": ny, "friction_x": tx, "friction_y": ty, "abutment": abutment}
        # Without a pressure in equilibrium, results are nan; a negative force marks the shoe as locked.
        force = np.where(held, force, -1.0)
        torque, size = np.where(held, mu * area * r * K, np.nan), np.where(held, np.real(size), 1.0)
        return Lining(torque, force, size, self.locking[leads] + 0 * np.real(delta), forces)

    def _pressure(self, at: Numbers, friction: Numbers, leads: bool) -> Numbers:
        delta = self.zero(np.asarray(friction), leads)
        return np.maximum(np.sin(at - delta), 0.0) / self._peak(delta)

    def _contact(self, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the angles between which the lining touches the drum [rad]."""
        at = np.real(delta)
        return np.maximum(self.lining_start, at), np.minimum(self.lining_end, at + np.pi)

    def _peak(self, delta: np.ndarray) -> np.ndarray:
        """Compute the largest value of sin(alpha - delta), the pressure's shape, where the lining touches."""
        first, last = (each - np.real(delta) for each in self._contact(delta))
        inside = (first <= np.pi / 2) & (last >= np.pi / 2)
        return np.where(inside, 1.0, np.maximum(np.sin(first), np.sin(last)))

    def _integrals(self, delta: np.ndarray) -> tuple[Any, Any, Any]:
        """Integrate sin(x - delta), also times sin x and times cos x, over the contact; x is the angle."""
        u, v = (each - delta for each in self._contact(delta))
        m, h = (u + v) / 2, (v - u) / 2
        # In axes turned by delta a narrow contact keeps its digits; in those of the lining small integrals
        # would be differences of large terms.
        S, C = h - np.cos(2 * m) * np.sin(2 * h) / 2, np.sin(2 * m) * np.sin(2 * h) / 2
        sine, cosine = np.sin(delta), np.cos(delta)
        return 2 * np.sin(m) * np.sin(h), S * cosine + C * sine, C * cosine - S * sine

    def _moment(self, integrals: tuple[Any, Any, Any], mu: Numbers, s: float) -> Any:
        """Compute the moment [m] of pressure and friction about the abutment over p0 and the area w r.

        The scale p0 of the pressure is that of this module, w the width and r the radius of the drum;
        s is -1 on a leading shoe, 1 on a trailing one.
        """
        (K, S, C), b, c = integrals, self.abutment_offset, self.abutment_depth
        return c * S - b * C + s * mu * (self.drum_radius * K - b * S - c * C)

    def _balance(self, integrals: tuple[Any, Any, Any], mu: Numbers, s: float) -> Any:
        """Compute the residual [m] of the balance of forces and moments, over p0 and the area w r.

        It is linear in the integrals; p0, w, r and s are those of `_moment`.
        """
        (_, S, C), psi = integrals, self.abutment_angle
        along = np.sin(psi) * (S - s * mu * C) + np.cos(psi) * (C + s * mu * S)
        return along * self.arm - np.sin(psi) * self._moment(integrals, mu, s)

    def _weight(self, alpha: Numbers, mu: Numbers, s: float) -> Any:
        """Compute the weight w at an angle: the residual of a pressure that acts at that angle only."""
        return self._balance((1.0, np.sin(alpha), np.cos(alpha)), mu, s)

    def _residual(self, delta: np.ndarray, mu: Numbers, s: float) -> Any:
        return self._balance(self._integrals(delta), mu, s)


def _word(leads: bool) -> str:
    return "leading" if leads else "trailing"
