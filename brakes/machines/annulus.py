"""Brakes whose linings rub on flat or conical rings: disc brakes, plates and cones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from brakes.common.locking import LEAST_MARGIN
from brakes.machines.machine import Lining, Machine

_LAW = "wear: worn-in lining, pressure as 1 / radius; pressure: new lining, the same pressure everywhere"
_TURN = 2 * np.pi
_LOSS = "share of the piston's force that the housing's slide keeps from the outer pad of a floating caliper"
_REMEDY = "leave 1 or more out of 100 parts"


@dataclass(frozen=True)
class Ring(Machine):
    """Base of brakes that rub on a ring; every number may be an array, one entry per case.

    Force and friction moment per radian of a ring with the radii ri (inner) and ro (outer), at the largest
    pressure p and a friction coefficient of 1, are p ri (ro - ri) and p ri (ro^2 - ri^2)/2 under uniform
    wear, p (ro^2 - ri^2)/2 and p (ro^3 - ri^3)/3 under uniform pressure (Budynas and Nisbett, Shigley's
    Mechanical Engineering Design, sections 16-5 to 16-7).

    Parameters
    ----------
    inner_radius, outer_radius : float or ndarray
        Inner and outer radius of the lining [m].

    Raises
    ------
    ValueError
        If a value is out of bounds, or the outer radius is not above the inner one.
    """

    inner_radius: Annotated[Numbers, Described("m", "r_i", "inner radius of the lining", above=0)]
    outer_radius: Annotated[Numbers, Described("m", "r_o", "outer radius of the lining", above=0)]

    laws: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"wear": "uniform wear", "pressure": "uniform pressure"}
    )
    place: ClassVar[Meaning] = Meaning("m", "radius", "mm")

    def check(self) -> None:
        """Check that the outer radius exceeds the inner one."""
        bound = "the lining is empty: it must exceed {other}, {limit}"
        bad, inner = np.asarray(self.outer_radius) <= self.inner_radius, self.inner_radius
        refuse(bad, "outer_radius", self.outer_radius, "m", bound, limit=inner, other="inner_radius")

    @property
    def force_per_radian(self) -> Numbers:
        """Normal force on one radian of the ring at a largest pressure of 1 Pa [N]."""
        inner, width = np.asarray(self.inner_radius), self.outer_radius - np.asarray(self.inner_radius)
        return width * (inner if self.law == "wear" else inner + width / 2)

    @property
    def reference_radius(self) -> Numbers:
        """Effective radius of the ring: moment of the friction divided by the friction force [m]."""
        i, o = np.asarray(self.inner_radius), np.asarray(self.outer_radius)
        return (o + i) / 2 if self.law == "wear" else 2 * (o * o + o * i + i * i) / (3 * (o + i))

    @property
    def rubbing_radius(self) -> Numbers:
        """Radius [m] at which pressure times radius is largest: inner radius under wear, else the outer."""
        return self.inner_radius if self.law == "wear" else self.outer_radius

    def reach(self) -> tuple[Numbers, Numbers]:
        """Return inner and outer radius of the lining [m]."""
        return self.inner_radius, self.outer_radius

    def pressure(self, at: Numbers, friction: Numbers) -> Numbers:
        """Compute the pressure at radii [m], divided by its largest value."""
        return self.inner_radius / at if self.law == "wear" else np.ones_like(at)


@dataclass(frozen=True)
class Disc(Ring):
    """A disc brake with a pad on each side; every number may be an array, one entry per case.

    Parameters
    ----------
    inner_radius, outer_radius : float or ndarray
        Radii of the pads [m].
    pad_angle : float or ndarray
        Angle of a pad about the disc's axis [rad]; 2 pi for a full ring.
    caliper : {"fixed", "floating"}
        Whether a piston presses each pad, or one piston the inner pad and the sliding housing the outer pad.
    guide_loss : float or ndarray
        Fraction of the piston's force that friction in a floating caliper's slide keeps from the outer pad.
    pressure_law : {"wear", "pressure"}
        Uniform wear, or uniform pressure.

    Raises
    ------
    ValueError
        If a value is out of bounds, the outer radius is not above the inner one, or a fixed caliper has a
        guide loss.

    References
    ----------
    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 16-6: annular pads.

    Examples
    --------
    >>> disc = machines.Disc(0.098, 0.14, pad_angle=1.9)
    >>> found = machines.solve_brake(disc, friction=0.4, force=1000.0)
    >>> round(float(found.c_star), 12), round(float(found.torque), 9)  # C* is 2 mu; N m
    (0.8, 95.2)
    """

    pad_angle: Annotated[Numbers, Described("rad", "theta", "angle of a pad", above=0, most=_TURN)]
    caliper: Annotated[
        Literal["fixed", "floating"],
        Described(meaning="fixed: a piston presses each pad; floating: one piston, the housing slides"),
    ] = "fixed"
    guide_loss: Annotated[Numbers, Described("", "eta", _LOSS, least=0, below=1)] = 0.0
    pressure_law: Annotated[Literal["wear", "pressure"], Described(meaning=_LAW)] = "wear"

    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType(
        {
            "normal": Meaning("N", "force on the pad"),
            "abutment": Meaning("N", "force of the pad on its abutment"),
        }
    )

    def check(self) -> None:
        """Check that the ring is not empty, and that a fixed caliper has no loss in a slide."""
        super().check()
        one_of("caliper", self.caliper, ("fixed", "floating"))
        bound = 'caliper = "fixed" has no slide'
        bad = np.asarray(self.guide_loss) > (0 if self.caliper == "fixed" else 1)
        refuse(bad, "guide_loss", self.guide_loss, "", bound, 'leave it out, or give caliper = "floating"')

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return the linings of the two pads; see `Machine.linings`."""
        drag = friction * self.force_per_radian
        force = self.pad_angle * self.force_per_radian + 0 * friction
        forces = {"normal": force, "abutment": drag * 2 * np.sin(self.pad_angle / 2)}
        torque = drag * self.pad_angle * self.reference_radius
        inner = Lining(torque, force, force, reactions=forces)
        outer = Lining(torque, force, force, reactions=forces, share=1 - np.asarray(self.guide_loss))
        return {"inner pad": inner, "outer pad": outer}


@dataclass(frozen=True)
class Plates(Ring):
    """A multi-plate brake: rings pressed together by one force; every number may be an array.

    Parameters
    ----------
    inner_radius, outer_radius : float or ndarray
        Radii of the linings [m].
    faces : float or ndarray
        Number of pairs of rubbing faces; each carries the full force: friction in the splines is neglected.
    pressure_law : {"wear", "pressure"}
        Uniform wear, or uniform pressure.

    Raises
    ------
    ValueError
        If a value is out of bounds, the outer radius is not above the inner one, or the number is not whole.

    References
    ----------
    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 16-5: axial clutches.

    Examples
    --------
    >>> plates = machines.Plates(0.05, 0.07, faces=8)
    >>> round(float(machines.solve_brake(plates, friction=0.1, force=1000.0).torque), 9)  # N m: n mu F r
    48.0
    """

    faces: Annotated[
        Numbers, Described("", "n", "number of pairs of rubbing faces", least=1, most=1000, whole=True)
    ]
    pressure_law: Annotated[Literal["wear", "pressure"], Described(meaning=_LAW)] = "wear"

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return all plates as one lining; see `Machine.linings`."""
        force = _TURN * self.force_per_radian + 0 * friction
        return {"plates": Lining(friction * force * self.faces * self.reference_radius, force, force)}


@dataclass(frozen=True)
class Cone(Ring):
    """A cone brake; every number may be an array, one entry per case.

    The cone is pressed along its axis; friction along the slant while it engages is neglected.

    Parameters
    ----------
    inner_radius, outer_radius : float or ndarray
        Radii of the lining at its narrow and its wide end [m].
    width : float or ndarray
        Length of the lining along the axis [m], not along the slant.
    pressure_law : {"wear", "pressure"}
        Uniform wear, or uniform pressure.

    Raises
    ------
    ValueError
        If a value is out of bounds, or the outer radius is not above the inner one.

    Notes
    -----
    Forces as for a flat ring, with the torque divided by sin alpha, where tan alpha = (ro - ri)/width.

    References
    ----------
    Budynas and Nisbett, Shigley's Mechanical Engineering Design, section 16-8.

    Examples
    --------
    >>> cone = machines.Cone(0.153, 0.165, width=0.06)
    >>> round(float(machines.solve_brake(cone, friction=0.26, torque=200.0).force), 3)  # N
    948.796
    """

    width: Annotated[Numbers, Described("m", "w", "length of the lining along the axis", above=0)]
    pressure_law: Annotated[Literal["wear", "pressure"], Described(meaning=_LAW)] = "wear"

    reactions: ClassVar[Mapping[str, Meaning]] = MappingProxyType(
        {
            "normal": Meaning("N", "pressure times area"),
            "release": Meaning("N", "force that releases the cone; below 0 it releases itself"),
        }
    )

    @property
    def taper(self) -> Numbers:
        """Tangent of the angle between lining and axis; from this friction coefficient on the cone sticks."""
        return (self.outer_radius - np.asarray(self.inner_radius)) / self.width

    def linings(self, friction: Numbers, reverse: bool) -> Mapping[str, Lining]:
        """Return the lining of the cone; see `Machine.linings`."""
        force = _TURN * self.force_per_radian + 0 * friction
        normal = force * np.hypot(1.0, 1 / self.taper)  # 1 / sin(alpha), the taper being tan(alpha)
        forces = {"normal": normal, "release": force * (friction / self.taper - 1)}
        return {"cone": Lining(friction * normal * self.reference_radius, force, force, reactions=forces)}

    def remarks(self, friction: Numbers, reverse: bool) -> Sequence[str]:
        """Return a sentence if the cone sticks in its cup when the force is gone."""
        sticks = np.asarray(friction >= self.taper * (1 - LEAST_MARGIN))
        if not sticks.any():
            return ()
        least = float(np.min(np.broadcast_to(self.taper, sticks.shape)[sticks]))
        return (f"the cone sticks from friction {least:.4g} on, tan of its angle: pull it out of the cup",)
