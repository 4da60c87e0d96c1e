"""Drum brakes whose shoes slide on a flat abutment, with contact on one side only.

Axes and angles as in `brakes.drum`. A rigid shoe that no pin holds presses with p0 max(0, sin(alpha -
delta)): where the lining would have to pull, it lifts. Its end at (b, -c) slides along the abutment without
friction: the forces along its face vanish, and the moments about that end. Eliminating p0 leaves one
equation,

    R(delta) = int max(0, sin(alpha - delta)) w(alpha) d alpha = 0,   w = w0 + w1 cos(alpha) + w2 sin(alpha).

It has one solution if w has opposite signs at the ends of the lining. For w, a shifted cosine, then
vanishes once there, at some alpha0. Let delta solve it, and delta' exceed it: the ratio of the sine of
delta' to that of delta increases with alpha, and with its value q at alpha0, R(delta') = R(delta') - q
R(delta) is an integral of terms of the sign that w has beyond alpha0. So R vanishes once, and halving finds
it. Where the signs are equal, the shoe finds no hold: it is said to lock.
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
from beamdyn.common.results.meanings import Meaning
from brakes.machines.machine import Lining, Machine

_HALVINGS = 56  # of an angle below 2 pi, to its rounding
_FRICTIONS = np.linspace(0.0, 3.0, 61)  # among which self-locking is looked for
_LEAST_CONTACT = 1e-3  # [rad] below which a lining touches at its edge alone, and nothing holds the shoe
_TURN_STEP = 1e-30  # imaginary part of an angle, for derivatives
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
        Angles of the lining's ends from straight down, where the abutment is [rad].
    abutment_offset, abutment_depth : float or ndarray
        Where the shoe rests on its abutment: b beside the line of symmetry, c below the centre [m].
    force_arm : float or ndarray
        Height a of the actuating force above the drum's centre [m].
    abutment_angle : float or ndarray
        Angle psi of the abutment's force above the actuating force's direction [rad].
    shoes : {"single", "simplex", "duplex"}
        Which shoes there are, each pressed by the same force.

    Raises
    ------
    ValueError
        If a value is out of bounds, the lining is empty, or the force not above the abutment.

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
        Numbers, Described("m", "b", "distance of the abutment from the line of symmetry, to its shoe")
    ]
    abutment_depth: Annotated[
        Numbers, Described("m", "c", "depth of the abutment below the drum's centre", above=0)
    ]
    force_arm: Annotated[Numbers, Described("m", "a", "height of the force above the drum's centre", least=0)]
    abutment_angle: Annotated[
        Numbers,
        Described("rad", "psi", "abutment's force above the actuating one", least=-np.pi / 4, most=np.pi / 4),
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
        """Refuse an empty lining."""
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
        """Arm a + c of the actuating force about the abutment [m]."""
        return self.force_arm + np.asarray(self.abutment_depth)

    def reach(self) -> tuple[Numbers, Numbers]:
        """Ends of the lining [rad]."""
        return self.lining_start, self.lining_end

    def leads(self, reverse: bool) -> tuple[bool, ...]:
        """Whether each shoe leads."""
        return tuple(leads is not reverse for leads in _LEADS[self.shoes])

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """The shoes; see `Machine.linings`."""
        leads = self.leads(reverse)
        return {f"shoe {i + 1}, {_word(each)}": self._shoe(friction, each) for i, each in enumerate(leads)}

    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Pressure on a shoe that leads, over its largest value."""
        return self._pressure(at, friction, leads=True)

    def pressure_on(self, index: int, at: Numbers, friction: Numbers, reverse: bool) -> Numbers:
        """Pressure on a shoe, over its largest value."""
        return self._pressure(at, friction, self.leads(reverse)[index])

    def remarks(self, friction: Numbers, reverse: bool) -> Sequence[str]:
        """Where a lining lifts, of one case."""
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
        """Angle delta at which the pressure vanishes [rad]; nan where nothing holds the shoe."""
        mu, s = np.real(friction), -1.0 if leads else 1.0
        first, last = self._weight(self.lining_start, mu, s), self._weight(self.lining_end, mu, s)
        low = self.lining_start - np.pi + 0 * first
        high = self.lining_end + 0 * first
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            before = self._residual(middle, mu, s) * first > 0
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        delta = (low + high) / 2
        begin, end = self._contact(delta)
        return np.where((first * last < 0) & (end - begin > _LEAST_CONTACT), delta, np.nan)

    @cached_property
    def locking(self) -> Mapping[bool, Numbers]:
        """Friction from which a leading shoe, and a trailing one, locks; inf if none up to 3."""
        return {leads: self._locking(leads) for leads in (True, False)}

    def _locking(self, leads: bool) -> Numbers:
        """Friction at the first actuating force that is not positive, by halving.

        Where nothing holds the shoe there is no force; that is no locking.
        """

        def holds(mu: np.ndarray) -> np.ndarray:
            return ~(self._force(mu, leads) <= 0)

        numbers = (value for value in vars(self).values() if not isinstance(value, str | Mapping))
        shape = np.broadcast_shapes(*map(np.shape, numbers))
        grid = _FRICTIONS.reshape(-1, *(1,) * len(shape)) + np.zeros(shape)
        free = np.logical_and.accumulate(holds(grid), axis=0)
        last = np.maximum(free.sum(axis=0) - 1, 0)
        low = _FRICTIONS[last]
        high = low + _FRICTIONS[1]
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            fine = holds(middle)
            low, high = np.where(fine, middle, low), np.where(fine, high, middle)
        return np.where(free.all(axis=0), np.inf, high)

    def _force(self, mu: np.ndarray, leads: bool) -> np.ndarray:
        """Actuating force while p0 is 1 Pa, over area [-]; nan where nothing holds the shoe."""
        s, delta = -1.0 if leads else 1.0, self.zero(mu, leads)
        return self._moment(self._integrals(delta), mu, s) / self.arm

    def _shoe(self, mu: Numbers, leads: bool) -> Lining:
        """A shoe at the zero of its pressure; the derivative of that zero by one step of Newton's method."""
        s, delta = -1.0 if leads else 1.0, self.zero(mu, leads)
        held = np.isfinite(delta)
        delta = np.where(held, delta, self.lining_start)
        slope = self._residual(delta + 1j * _TURN_STEP, np.real(mu), s).imag / _TURN_STEP
        delta = delta - self._residual(delta, mu, s) / slope
        K, S, C = found = self._integrals(delta)
        area = self.face_width * np.asarray(self.drum_radius) / self._peak(delta)
        force = area * self._moment(found, mu, s) / self.arm
        b, c, r = self.abutment_offset, self.abutment_depth, self.drum_radius
        far = np.abs(b) + c
        size = 2 * area / self.arm * (far + np.abs(mu) * (r + far))  # of the terms of the integrals, too
        nx, ny, tx, ty = -area * S, area * C, s * mu * area * C, s * mu * area * S
        psi = self.abutment_angle
        abutment = -(force + nx + tx) * np.cos(psi) - (ny + ty) * np.sin(psi)
        forces = {"normal_x": nx, "normal_y": ny, "friction_x": tx, "friction_y": ty, "abutment": abutment}
        force = np.where(held, force, -1.0)  # what nothing holds has no numbers, as what locks
        torque, size = np.where(held, mu * area * r * K, np.nan), np.where(held, np.real(size), 1.0)
        return Lining(torque, force, size, self.locking[leads] + 0 * np.real(delta), forces)

    def _pressure(self, at: Numbers, friction: Numbers, leads: bool) -> Numbers:
        delta = self.zero(np.asarray(friction), leads)
        return np.maximum(np.sin(at - delta), 0.0) / self._peak(delta)

    def _contact(self, delta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Ends of the contact [rad]."""
        at = np.real(delta)
        return np.maximum(self.lining_start, at), np.minimum(self.lining_end, at + np.pi)

    def _peak(self, delta: np.ndarray) -> np.ndarray:
        """Largest value of the sine on the contact."""
        first, last = (each - np.real(delta) for each in self._contact(delta))
        inside = (first <= np.pi / 2) & (last >= np.pi / 2)
        return np.where(inside, 1.0, np.maximum(np.sin(first), np.sin(last)))

    def _integrals(self, delta: np.ndarray) -> tuple[Any, Any, Any]:
        """Integrals of sin(x - delta), and of it times sin x and cos x, over the contact."""
        e1, e2 = self._contact(delta)
        wide = (np.sin(2 * e2 - delta) - np.sin(2 * e1 - delta)) / 2
        high = (np.cos(2 * e2 - delta) - np.cos(2 * e1 - delta)) / 2
        S = ((e2 - e1) * np.cos(delta) - wide) / 2
        C = (-high - (e2 - e1) * np.sin(delta)) / 2
        return np.cos(e1 - delta) - np.cos(e2 - delta), S, C

    def _moment(self, integrals: tuple[Any, Any, Any], mu: Numbers, s: float) -> Any:
        """Moment of pressure and friction about the abutment, over p0 and area [m]."""
        (K, S, C), b, c = integrals, self.abutment_offset, self.abutment_depth
        return c * S - b * C + s * mu * (self.drum_radius * K - b * S - c * C)

    def _balance(self, integrals: tuple[Any, Any, Any], mu: Numbers, s: float) -> Any:
        """Residual [m] of the two equations after p0 is eliminated; linear in the integrals."""
        (_, S, C), psi = integrals, self.abutment_angle
        along = np.sin(psi) * (S - s * mu * C) + np.cos(psi) * (C + s * mu * S)
        return along * self.arm - np.sin(psi) * self._moment(integrals, mu, s)

    def _weight(self, alpha: Numbers, mu: Numbers, s: float) -> Any:
        """The weight w at an angle: the balance of a pressure at that angle alone."""
        return self._balance((1.0, np.sin(alpha), np.cos(alpha)), mu, s)

    def _residual(self, delta: np.ndarray, mu: Numbers, s: float) -> Any:
        return self._balance(self._integrals(delta), mu, s)


def _word(leads: bool) -> str:
    return "leading" if leads else "trailing"
