"""A bicycle caliper: a mechanism that a cable closes until its two pads press on the rim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.checks import count, not_negative, one_of, positive, real, real_array
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.statements import joined
from beamdyn.common.words import Words
from brakes.calipers.results import CaliperStroke, PadWear, PivotFriction
from brakes.planar import Equilibrium, Joint, Mechanism, Position, solve, solve_with_friction, stroke
from brakes.planar.kinematics import MOST_POSITIONS, driver_at_travel
from brakes.planar.part import OneWay, check_inputs
from brakes.planar.statics import combine, find_wrong_way, one_way_parts, tolerance
from brakes.planar.system import OppositeTravelError

CABLE, RIGHT_PAD, LEFT_PAD = "cable", "right pad", "left pad"
_FINGER = 40.0  # usual force of the hand on a brake lever [N], a firm squeeze
_PADS = Described(meaning="forces on the right and left pad", required=True)
_PAST = "the caliper is past its toggle position, or the pad's direction is reversed; give a shorter travel"
_PAD = OneWay("pad", "pull", "contact opens", _PAST)

Split = Annotated[Literal["equal force", "equal work"], Described(meaning="how the rim loads the two pads")]
LeverRatio = Annotated[float, Described(meaning="travel of the finger over that of the cable", above=0)]
Clearance = Annotated[float, Described("m", meaning="mean gap between pad and rim, open", above=0)]
PivotRadius = Annotated[float, Described("m", meaning="radius of the pivots", least=0)]


@dataclass(frozen=True)
class Caliper:
    """A caliper as a mechanism with a cable and two pads, described in its open position.

    Parameters
    ----------
    mechanism : Mechanism
        Bodies, joints and loads; the loads include the cable and the rim's forces on the pads, of any
        magnitude.
    centring : tuple of joints
        Joints that couple the arms' rotations until the pads touch, such as equal return springs.  Empty if
        the mechanism couples the arms: then `split`, not statics, determines how the rim loads the two pads.
    cable : str
        Name of the load that closes the brake.
    pads : tuple of 2 str
        Names of the rim's forces on the right and on the left pad, which point away from the rim.
    split : {"equal force", "equal work"}
        Both pads press with the same force, or both do the same work during a small motion of the cable.
    lever_ratio : float
        Travel of the finger over the travel of the cable.
    clearance : float
        Mean gap between pad and rim [m]; the brake is centred so that both pads touch at the same time.
    pivot_radius : float
        Radius of the pivots [m].
    name : str
        Name for titles.

    References
    ----------
    The sources of `planar.solve`.  The advantage is the pad's force over the hand's, and by virtual work the
    hand's travel over the pad's (standard).

    Examples
    --------
    >>> caliper = calipers.VBrake().build()
    >>> caliper.equilibrium(finger=40.0).has_answer
    True
    """

    mechanism: Mechanism
    centring: tuple[Joint, ...] = ()
    cable: Annotated[str, Described(meaning="load that closes the brake", required=True)] = CABLE
    pads: Annotated[tuple[str, str], _PADS] = (RIGHT_PAD, LEFT_PAD)
    split: Split = "equal force"
    lever_ratio: LeverRatio = 4.0
    clearance: Clearance = 1.25e-3
    pivot_radius: PivotRadius = 4e-3
    name: str = "caliper"

    def __post_init__(self) -> None:
        check_inputs(self)
        one_of("split", self.split, ("equal force", "equal work"))
        for name in (self.cable, *self.pads):
            self.mechanism.load(name).with_magnitude(None)  # raises an error if the load is a spring
        if len({self.cable, *self.pads}) < 3:
            raise ValueError(f"cable {self.cable!r} and pads {self.pads}: name three different loads")

    # Motion -----------------------------------------------------------------------------------------

    @cached_property
    def free(self) -> Mechanism:
        """The mechanism before the pads touch: with its centring joints, without tension and pad forces."""
        held = replace(self.mechanism, joints=(*self.mechanism.joints, *self.centring))
        return _with_magnitudes(held, {self.cable: 0.0, **dict.fromkeys(self.pads, 0.0)})

    @cached_property
    def contact(self) -> float:
        """Cable travel at which the pads touch [m]: their mean travel is then the clearance.

        Raises
        ------
        OutOfReachError
            If the motion of the caliper ends before the pads touch.
        """
        try:
            return driver_at_travel(self.free, self.cable, dict.fromkeys(self.pads, -0.5), self.clearance)
        except OppositeTravelError:
            raise OppositeTravelError(
                f"load {self.cable!r} opens the pads: turn the directions of {self.pads[0]!r} and "
                f"{self.pads[1]!r} away from the rim, or reverse the cable"
            ) from None

    def _pads(self, travel: dict[str, np.ndarray]) -> np.ndarray:
        """Return the travels of the right and left pad at S positions, (S, 2) [m], positive to the rim."""
        return -np.stack([travel[name] for name in self.pads], axis=-1)

    # Forces -----------------------------------------------------------------------------------------

    def stroke(
        self,
        travel: float | Sequence[float] | np.ndarray | None = None,
        points: int = 100,
        finger: float = _FINGER,
    ) -> CaliperStroke:
        """Compute travel and forces of the caliper over its stroke.

        Parameters
        ----------
        travel : float or sequence of floats, optional
            Largest travel of the cable, or all its travels [m]; if not given, up to where the pads touch.
        points : int
            Number of positions from 0 to the largest travel.
        finger : float
            Force of the finger on the hand lever [N].

        Raises
        ------
        AssemblyError, OutOfReachError
            If the joints of the drawing cannot be brought together, or the mechanism does not reach a travel.
        ValueError
            If the mobility of the mechanism is not 1.
        """
        travel = self.contact if travel is None else travel
        if np.ndim(travel) == 0:
            travel = np.linspace(0.0, real("travel", travel, "m"), count("points", points, 2, MOST_POSITIONS))
        motion = stroke(self.free, self.cable, real_array("travel", travel))  # pyright: ignore[reportArgumentType]
        finger = positive("finger", finger, "N")
        tension = self.lever_ratio * finger
        forces = self._forces(motion.position, tension)
        forces["warnings"] += tuple(toggle.message for toggle in motion.toggles)
        return CaliperStroke(
            caliper=self.name,
            finger_force=finger,
            tension=tension,
            lever_ratio=self.lever_ratio,
            cable=motion.values,
            finger=motion.values * self.lever_ratio,
            pad_travel=self._pads(motion.travel),
            pad_ratio=self._pads(motion.ratio),
            advantage=forces["pad_force"] / finger,
            motion=motion,
            **forces,
        )

    def equilibrium(self, travel: float | None = None, finger: float = _FINGER) -> Equilibrium:
        """Compute all forces at a travel of the cable [m], by default at contact, for free-body diagrams."""
        position = stroke(self.free, self.cable, [self.contact if travel is None else travel]).position
        tension = self.lever_ratio * positive("finger", finger, "N")
        # Without centring joints `split` fixes the force of the right pad; with them it is unknown (nan).
        force = np.nan if self.centring else float(self._forces(position, tension)["pad_force"][0, 0])
        return self._at(position[0], tension, force)

    def equilibrium_after(self, run: CaliperStroke) -> Equilibrium:
        """Compute all forces at the last position of a stroke of this caliper, for free-body diagrams."""
        force = np.nan if self.centring else float(run.pad_force[-1, 0])
        return self._at(run.motion.position[-1], run.tension, force)

    def _at(self, position: Position, tension: float, right: float) -> Equilibrium:
        """Solve the equilibrium at a position and tension [N]; a right pad's force of nan is an unknown."""
        return solve(self._with(tension, None if np.isnan(right) else right, None), position)

    def _with(self, tension: float | None, right: float | None, left: float | None) -> Mechanism:
        magnitudes = zip((self.cable, *self.pads), (tension, right, left), strict=True)
        return _with_magnitudes(self.mechanism, dict(magnitudes))

    def _forces(self, position: Position, tension: float) -> dict[str, Any]:
        """Compute forces at a cable tension [N], as a mapping by attribute of `CaliperStroke`.

        If the arms are coupled, the result is a weighted mean of two equilibria: one with all force on the
        right pad, and one with all force on the left pad. Any such mean is in equilibrium, and the weight is
        the right pad's fraction of the work.
        """
        if self.centring:
            return _mean(solve(self._with(tension, None, None), position), None, self.pads, 1.0)
        right = solve(self._with(tension, None, 0.0), position)
        left = solve(self._with(tension, 0.0, None), position)
        share = np.full(len(position.batch), 0.5)
        if self.split == "equal force":
            a, b = right.amplitudes[self.pads[0]], left.amplitudes[self.pads[1]]
            share = b / (a + b)
        return _mean(right, left, self.pads, share)

    # Friction and wear ------------------------------------------------------------------------------

    def friction(
        self, coefficient: float, travel: float | None = None, finger: float = _FINGER
    ) -> PivotFriction:
        """Compute the caliper's efficiency with friction at a travel of the cable [m], by default at contact.

        The coefficient applies to all pivots without a coefficient; slots and contacts have their own.
        The forces of the pads are those without friction; friction changes the tension that they need.
        """
        coefficient = not_negative("coefficient", coefficient)
        travel = self.contact if travel is None else travel
        motion = stroke(self.free, self.cable, [travel])
        tension = self.lever_ratio * positive("finger", finger, "N")
        right, left = self._forces(motion.position, tension)["pad_force"][0]
        joints = tuple(joint.with_pivot(self.pivot_radius, coefficient) for joint in self.free.joints)
        magnitudes = {self.cable: None, self.pads[0]: right, self.pads[1]: left}
        mechanism = _with_magnitudes(replace(self.free, joints=joints), magnitudes)
        band = solve_with_friction(mechanism, self.cable, motion.position.of(mechanism))
        squeeze, release = (float(e.amplitudes[self.cable][0]) for e in (band.squeeze, band.release))
        ways = {name: way for name, way in band.ways.items() if way is not band.without}
        wrong = {name: way for name, way in ways.items() if way.status != "determined"}
        # If one direction of motion locks and a contact opens in the other, the contact is reported.
        worst = max(
            (way.status for way in wrong.values()), key=lambda s: s != "self-locking", default="determined"
        )
        words = joined("; ", (Words(name, ": ", way.message) for name, way in wrong.items()))
        return PivotFriction(
            coefficient=coefficient,
            cable=float(travel),
            tension=tension,
            squeezing_tension=squeeze,
            releasing_tension=release,
            squeeze=0.0 if np.isnan(squeeze) else tension / squeeze,
            release=0.0 if np.isnan(release) else max(release / tension, 0.0),
            error=float(np.fmax.reduce((*band.squeeze.error, *band.release.error))),
            status=worst,
            message=words or "the brake closes and opens",
        )

    def worn(self, lost: float) -> Caliper:
        """Copy the caliper with each pad thinner by `lost` [m]: the pads' faces lie farther from the rim."""
        lost = not_negative("lost", lost, "m", "it is the thickness that a pad has lost")
        loads = tuple(load.shifted(lost) if load.name in self.pads else load for load in self.mechanism.loads)
        return replace(self, mechanism=replace(self.mechanism, loads=loads), clearance=self.clearance + lost)

    def wear(self, lost: Sequence[float] | np.ndarray) -> PadWear:
        """Compute the travel to contact, and the advantage there, for pads worn by thicknesses [m]."""
        lost = real_array("lost", lost)
        worn = [self.worn(thickness) for thickness in lost]
        runs = [caliper.stroke([caliper.contact]) for caliper in worn]
        cable = np.array([run.cable[0] for run in runs])
        advantage = np.array([run.advantage[0] for run in runs]).reshape(-1, 2)
        return PadWear(lost, cable, cable * self.lever_ratio, advantage)


def _with_magnitudes(mechanism: Mechanism, magnitudes: dict[str, float | None]) -> Mechanism:
    """Copy a mechanism with other magnitudes of the named loads."""
    loads = tuple(
        load.with_magnitude(magnitudes[load.name]) if load.name in magnitudes else load
        for load in mechanism.loads
    )
    return replace(mechanism, loads=loads)


def _mean(
    a: Equilibrium, b: Equilibrium | None, pads: tuple[str, str], share: np.ndarray | float
) -> dict[str, Any]:
    """Compute the mean of two equilibria, with the weight `share` of the first; `a` if there is no `b`.

    The error and residual at each position are the larger ones of both equilibria; the status follows
    from the mean forces.
    """
    b = a if b is None else b
    weight = np.broadcast_to(share, a.residual.shape)

    def mean(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        w = weight.reshape(-1, *[1] * (x.ndim - 1))
        return x if a is b else w * x + (1 - w) * y

    forces = np.stack([mean(a.amplitudes[name], b.amplitudes[name]) for name in pads], axis=-1)
    mechanism, multiplier = a.position.mechanism, mean(a.multiplier, b.multiplier)
    system = mechanism.system
    sizes = {joint.name: joint.size(multiplier[:, system.joints[joint.name]]) for joint in mechanism.joints}
    if not (a.is_determined and b.is_determined):
        status, message = (b.status, b.message) if a.is_determined else (a.status, a.message)
    else:
        least = tolerance(system) * np.abs(multiplier / system.unit).max(axis=1)
        ways = dict.fromkeys(pads, _PAD) | one_way_parts(mechanism.joints)
        pressed = dict(zip(pads, forces.T, strict=True))
        status, message = combine([*find_wrong_way(ways, sizes | pressed, least).values()])
    return {
        "status": status,
        "message": message,
        "warnings": tuple(dict.fromkeys((*a.warnings, *b.warnings))),
        "pad_force": forces,
        "reactions": {name: mean(force, b.reactions[name]) for name, force in a.reactions.items()},
        "magnitudes": sizes,
        **{
            key: np.maximum(getattr(a, key), getattr(b, key)) for key in ("virtual_work", "residual", "error")
        },
    }
