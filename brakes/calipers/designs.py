"""Six bicycle calipers as data: their dimensions, and the mechanisms with these dimensions.

x points to the right and y up, seen from the front; the wheel's mid-plane is x = 0 and the brake is drawn
open.  "Right" and "left" are the sides of the pads; the rim pushes the pads outward.  Dimensions of a
symmetric caliper are given for its right side.  The eeBrake is reconstructed so that it meets the numbers of
a web page whose own coordinates are lost; the others have dimensions usual for their kind, of no particular
product.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from brakes.calipers import caliper
from brakes.planar import GROUND, Cable, CablePair, Contact, Force, Mechanism, Pin, RotationLock, Slot
from brakes.planar.part import DescribedPoint, check_inputs
from brakes.planar.rows import Point

MM = 1e-3
RIGHT, LEFT = "right arm", "left arm"


def _point(meaning: str) -> DescribedPoint:
    return DescribedPoint("m", meaning=meaning)


@dataclass(frozen=True, kw_only=True)
class Design:
    """Dimensions that all calipers have: lever ratio, clearance, and radius of the pivots.

    Parameters
    ----------
    lever_ratio : float
        Travel of the finger over the travel of the cable, at the hand lever.
    clearance : float
        Mean gap between pad and rim in the open position [m].
    pivot_radius : float
        Radius of the pivots [m]; it matters only with friction.

    Examples
    --------
    >>> sorted(calipers.NAMED)
    ['cantilever', 'centre-pull', 'dual-pivot', 'eebrake', 'single-pivot', 'v-brake']
    >>> issubclass(calipers.VBrake, calipers.Design)
    True
    """

    label: ClassVar[str]

    lever_ratio: caliper.LeverRatio = 4.0
    clearance: caliper.Clearance = 1.25e-3
    pivot_radius: caliper.PivotRadius = 4e-3

    def __post_init__(self) -> None:
        check_inputs(self)

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        raise NotImplementedError

    def _caliper(
        self, mechanism: Mechanism, centring: tuple[RotationLock, ...] = (), **more: Any
    ) -> caliper.Caliper:
        return caliper.Caliper(
            mechanism,
            centring,
            lever_ratio=self.lever_ratio,
            clearance=self.clearance,
            pivot_radius=self.pivot_radius,
            name=self.label,
            **more,
        )


@dataclass(frozen=True, kw_only=True)
class EeBrake(Design):
    """The eeBrake, reconstructed: two levers, which a strut and a link keep in step, on a fixed panel.

    Parameters
    ----------
    pivot, pad, upper_pin : tuple of 2 floats
        Pivot of the right lever on the panel, point where the rim's force acts on its pad, and its pin with
        the strut [m]; the left lever is the mirror image, and its upper pin O carries the upper-left lever.
    link_pin, strut_pin, housing : tuple of 2 floats
        Points A (link), B (strut) and C (face on which the cable's housing stands) of the upper-left lever
        [m].
    link_anchor : tuple of 2 floats
        End G of the link on the panel [m].
    cable_anchor : tuple of 2 floats
        End of the inner wire on the panel, at the right pivot [m].
    split : {"equal force", "equal work"}
        How the two pads share the load of the rim, which statics alone does not fix.  "equal work" means that
        a force of 1 on the right pad needs the cable tension T = 2 delta_R, with the ratio delta_R of the
        velocities of right pad and cable; this gives the published X = 0.875, the force on the left lever's
        upper pin.

    Examples
    --------
    >>> run = calipers.EeBrake().build().stroke(finger=40.0)  # N
    >>> round(float(run.advantage[-1, 0]), 2)
    5.98
    """

    label = "eeBrake (reconstructed)"

    pivot: Annotated[Point, _point("pivot of the right lever on the panel")] = (17.5 * MM, -19 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.75 * MM, -45 * MM)
    upper_pin: Annotated[Point, _point("pin of the strut on the right lever; its mirror image is pin O")] = (
        25.5 * MM,
        11.053947511008978 * MM,
    )
    link_pin: Annotated[Point, _point("pin A of the link on the upper-left lever")] = (
        -22 * MM,
        20.679813957477265 * MM,
    )
    strut_pin: Annotated[Point, _point("pin B of the strut on the upper-left lever")] = (-12.6 * MM, 29 * MM)
    housing: Annotated[Point, _point("face C of the cable's housing")] = (-3.765798714439799 * MM, 33.9 * MM)
    link_anchor: Annotated[Point, _point("pin G of the link on the panel")] = (-3.6 * MM, 14.9 * MM)
    cable_anchor: Annotated[Point, _point("end of the inner wire on the panel")] = (17.5 * MM, -19 * MM)
    split: caliper.Split = "equal force"

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        right, left, upper, strut, link = "right lever", "left lever", "upper-left lever", "strut", "link"
        joints = (
            Pin("right pivot", right, GROUND, self.pivot),
            Pin("left pivot", left, GROUND, mirrored(self.pivot)),
            Pin("pin O", upper, left, mirrored(self.upper_pin)),
            Pin("pin A", link, upper, self.link_pin),
            Pin("pin G", link, GROUND, self.link_anchor),
            Pin("pin B", strut, upper, self.strut_pin),
            Pin("strut end", strut, right, self.upper_pin),
        )
        cable = CablePair(caliper.CABLE, upper, GROUND, self.housing, self.cable_anchor)
        bodies = (right, left, upper, strut, link)
        loads = (cable, *pads(self.pad, right, left))
        return self._caliper(Mechanism(bodies, joints, loads), split=self.split)


@dataclass(frozen=True, kw_only=True)
class SinglePivot(Design):
    """Single-pivot side-pull: both arms turn on the mount bolt, and the cable pulls their ends together.

    Parameters
    ----------
    bolt, pad : tuple of 2 floats
        The mount bolt, on which both arms turn, and the point where the rim's force acts on the right pad
        [m]. The point of the left pad is its mirror image.
    clamp, housing : tuple of 2 floats
        Cable clamp on the arm of the right pad, and housing stop on the arm of the left pad [m].

    Examples
    --------
    >>> round(float(calipers.SinglePivot().build().stroke(finger=40.0).advantage[-1, 0]), 2)
    3.46
    """

    label = "single-pivot side-pull"

    bolt: Annotated[Point, _point("mount bolt, on which both arms turn")] = (0 * MM, 0 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.5 * MM, -48 * MM)
    clamp: Annotated[Point, _point("cable clamp, on the arm of the right pad")] = (-42 * MM, 2 * MM)
    housing: Annotated[Point, _point("stop of the housing, on the arm of the left pad")] = (-42 * MM, 34 * MM)

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        joints = (
            Pin("bolt, right arm", RIGHT, GROUND, self.bolt),
            Pin("bolt, left arm", LEFT, GROUND, self.bolt),
        )
        cable = CablePair(caliper.CABLE, RIGHT, LEFT, self.clamp, self.housing)
        return self._caliper(Mechanism((RIGHT, LEFT), joints, (cable, *pads(self.pad))), CENTRED)


@dataclass(frozen=True, kw_only=True)
class DualPivot(Design):
    """Dual-pivot side-pull: one arm turns on the mount bolt, the other beside it; a roller couples them.

    Parameters
    ----------
    bolt, side_pivot : tuple of 2 floats
        Pivots of the arm of the left pad and of the arm of the right pad [m].
    roller : tuple of 2 floats
        Point where the right pad's arm lifts the left pad's arm [m].
    pad : tuple of 2 floats
        Point where the rim's force acts on the right pad; that of the left one is its mirror image [m].
    clamp, housing : tuple of 2 floats
        Cable clamp on the arm of the right pad, and housing stop on the arm of the left pad [m].
    split : {"equal force", "equal work"}
        How the rim loads the two pads, which statics leaves open: see `Caliper`.

    Examples
    --------
    >>> run = calipers.DualPivot(clearance=0.001).build().stroke(finger=40.0)
    >>> round(float(run.pad_travel[-1, 0]), 5)  # m: the clearance
    0.001
    """

    label = "dual-pivot side-pull"

    bolt: Annotated[Point, _point("mount bolt, pivot of the arm of the left pad")] = (0 * MM, 0 * MM)
    side_pivot: Annotated[Point, _point("pivot of the arm of the right pad")] = (27 * MM, 4 * MM)
    roller: Annotated[Point, _point("roller between the arms")] = (13 * MM, 1 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.5 * MM, -46 * MM)
    clamp: Annotated[Point, _point("cable clamp, on the arm of the right pad")] = (-38 * MM, 2 * MM)
    housing: Annotated[Point, _point("stop of the housing, on the arm of the left pad")] = (-38 * MM, 34 * MM)
    split: caliper.Split = "equal force"

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        joints = (
            Pin("side pivot", RIGHT, GROUND, self.side_pivot),
            Pin("bolt", LEFT, GROUND, self.bolt),
            Contact("roller", LEFT, RIGHT, self.roller, (0.0, 1.0)),
        )
        cable = CablePair(caliper.CABLE, RIGHT, LEFT, self.clamp, self.housing)
        return self._caliper(Mechanism((RIGHT, LEFT), joints, (cable, *pads(self.pad))), split=self.split)


@dataclass(frozen=True, kw_only=True)
class CentrePull(Design):
    """Centre-pull: arms that cross, each on its pivot; a yoke pulls the straddle cable between their ends.

    Parameters
    ----------
    pivot, pad, hook : tuple of 2 floats
        Pivot of the right arm, point where the rim's force acts on its pad, and the hook at which the arm
        holds the straddle cable, on the other side of the wheel's mid-plane [m].
    yoke, stop : tuple of 2 floats
        The yoke on the straddle cable, and the stop of the main cable's housing above it [m].

    Examples
    --------
    >>> round(float(calipers.CentrePull().build().stroke(finger=40.0).advantage[-1, 0]), 2)
    3.06
    """

    label = "centre-pull"

    pivot: Annotated[Point, _point("pivot of the right arm")] = (20 * MM, 0 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.5 * MM, -48 * MM)
    hook: Annotated[Point, _point("end of the straddle cable on the right arm")] = (-32 * MM, 24 * MM)
    yoke: Annotated[Point, _point("yoke on the straddle cable")] = (0 * MM, 60 * MM)
    stop: Annotated[Point, _point("stop of the main cable's housing")] = (0 * MM, 120 * MM)

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        return self._caliper(straddled(self), CENTRED)


@dataclass(frozen=True, kw_only=True)
class Cantilever(Design):
    """Cantilever: arms on bosses below the rim; a yoke pulls the straddle cable between their outer ends.

    Parameters
    ----------
    pivot, pad, hook : tuple of 2 floats
        Boss of the right arm, point where the rim's force acts on its pad, and the hook at which the arm
        holds the straddle cable [m].
    yoke, stop : tuple of 2 floats
        The yoke on the straddle cable, and the stop of the main cable's housing above it [m].

    Examples
    --------
    >>> round(float(calipers.Cantilever().build().stroke(finger=40.0).advantage[-1, 0]), 2)
    4.94
    """

    label = "cantilever"

    pivot: Annotated[Point, _point("boss of the right arm")] = (40 * MM, -25 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.5 * MM, 0 * MM)
    hook: Annotated[Point, _point("end of the straddle cable on the right arm")] = (62 * MM, 12 * MM)
    yoke: Annotated[Point, _point("yoke on the straddle cable")] = (0 * MM, 70 * MM)
    stop: Annotated[Point, _point("stop of the main cable's housing")] = (0 * MM, 130 * MM)

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        return self._caliper(straddled(self), CENTRED)


@dataclass(frozen=True, kw_only=True)
class VBrake(Design):
    """V-brake (linear-pull): long arms on bosses below the rim; the cable pulls their tops together.

    Parameters
    ----------
    pivot, pad, clamp : tuple of 2 floats
        Boss of the right arm, point where the rim's force acts on its pad, and the cable clamp at its top
        [m]; the left arm with the cable's noodle is its mirror image.

    Examples
    --------
    >>> round(float(calipers.VBrake().build().stroke(finger=40.0).advantage[-1, 0]), 2)
    9.77
    """

    label = "V-brake"

    lever_ratio: caliper.LeverRatio = 2.2
    pivot: Annotated[Point, _point("boss of the right arm")] = (40 * MM, -25 * MM)
    pad: Annotated[Point, _point("right pad")] = (12.5 * MM, 0 * MM)
    clamp: Annotated[Point, _point("cable clamp at the top of the right arm")] = (34 * MM, 80 * MM)

    def build(self) -> caliper.Caliper:
        """Make the caliper with these dimensions."""
        joints = (
            Pin("right boss", RIGHT, GROUND, self.pivot),
            Pin("left boss", LEFT, GROUND, mirrored(self.pivot)),
        )
        cable = CablePair(caliper.CABLE, RIGHT, LEFT, self.clamp, mirrored(self.clamp))
        return self._caliper(Mechanism((RIGHT, LEFT), joints, (cable, *pads(self.pad))), CENTRED)


NAMED: dict[str, type[Design]] = {
    "eebrake": EeBrake,
    "single-pivot": SinglePivot,
    "dual-pivot": DualPivot,
    "centre-pull": CentrePull,
    "cantilever": Cantilever,
    "v-brake": VBrake,
}

# Equal return springs turn free arms by equal angles; the arms can turn apart once the pads touch.
CENTRED = (RotationLock("return springs", LEFT, RIGHT, -1.0),)


def mirrored(point: Point) -> Point:
    """Mirror a point on the wheel's mid-plane x = 0."""
    return -point[0], point[1]


def pads(right: Point, right_body: str = RIGHT, left_body: str = LEFT) -> tuple[Force, Force]:
    """Make the rim's forces on the right pad at a point, and on the left pad at its mirror image."""
    return (
        Force(caliper.RIGHT_PAD, right_body, right, (1.0, 0.0)),
        Force(caliper.LEFT_PAD, left_body, mirrored(right), (-1.0, 0.0)),
    )


def straddled(arms: CentrePull | Cantilever) -> Mechanism:
    """Make the mechanism of two arms and a yoke on a straddle cable, which the main cable keeps centred."""
    yoke = "yoke"
    joints = (
        Pin("right pivot", RIGHT, GROUND, arms.pivot),
        Pin("left pivot", LEFT, GROUND, mirrored(arms.pivot)),
        Cable("straddle cable", (RIGHT, yoke, LEFT), (arms.hook, arms.yoke, mirrored(arms.hook))),
        Slot("middle", yoke, GROUND, arms.yoke, (0.0, 1.0)),
        RotationLock("yoke upright", yoke, GROUND),
    )
    cable = CablePair(caliper.CABLE, yoke, GROUND, arms.yoke, arms.stop)
    return Mechanism((RIGHT, LEFT, yoke), joints, (cable, *pads(arms.pad)))
