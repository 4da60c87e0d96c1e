"""How much a two-wheeled vehicle can be braked at one wheel: grip of the tyre, and pitching over.

On level ground, with the deceleration a, the mass M, the centre of gravity at the height h and x behind
the front axle, the wheelbase L, and wheels of inertia J and radius R, moments about the front wheel's contact
give the load of the rear wheel, (M g x - (M h + J / R) a) / L; the front wheel has the rest of the weight.
The vehicle pitches over where the rear wheel has no load.  The tyre of the braked wheel slips where it would
have to hold more than its friction times its load; it is taken to slow down all wheels, (M + J / R^2) a.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal

from beamdyn.common.checks import InvalidValue, one_of
from beamdyn.common.described import Described
from brakes.planar.inputs import check_inputs

GRAVITY = 9.80665  # [m/s2] standard
EQUAL = 1e-9  # relative difference that is rounding
TyreFriction = Annotated[float, Described("", "mu_t", "friction of the tyre on the road", above=0, most=2)]
Wheelbase = Annotated[float, Described("m", "L", "distance of the axles", above=0)]
Height = Annotated[float, Described("m", "h", "height of the centre of gravity, with rider", above=0)]
Behind = Annotated[
    float, Described("m", "x", "centre of gravity, with rider, behind the front axle", above=0)
]


@dataclass(frozen=True)
class Stance:
    """Where the weight of a vehicle with two wheels lies, and what the braked tyre holds.

    Parameters
    ----------
    braked_wheel : {"front", "rear"}
        The wheel with the brake.
    tyre_friction : float, optional
        Friction of its tyre on the road; needs the three lengths.
    wheelbase : float, optional
        Distance of the axles [m].
    cg_height : float, optional
        Height of the centre of gravity above the road, with rider [m]; needs `cg_behind_front`.
    cg_behind_front : float, optional
        Its horizontal distance behind the front axle [m]; needs `cg_height`.

    Raises
    ------
    ValueError
        If a value is out of its bounds, or one is given without those it needs.

    References
    ----------
    Standard: moments about the front wheel's contact.

    Examples
    --------
    >>> stance = calipers.Stance(cg_height=1.1, cg_behind_front=0.6)
    >>> round(stance.pitch_limit(lift=1.0), 2)  # m/s2, g 0.6/1.1
    5.35
    """

    braked_wheel: Annotated[Literal["front", "rear"], Described(meaning="wheel with the brake")] = "front"
    tyre_friction: TyreFriction | None = None
    wheelbase: Wheelbase | None = None
    cg_height: Height | None = None
    cg_behind_front: Behind | None = None

    def __post_init__(self) -> None:
        check_inputs(self)
        one_of("braked_wheel", self.braked_wheel, ("front", "rear"))
        place = "cg_height", "cg_behind_front"
        self._check_complete("tyre_friction", ("wheelbase", *place))
        for name in place:
            self._check_complete(name, place)
        x, length = self.cg_behind_front, self.wheelbase
        if x is not None and length is not None and x >= length * (1 - EQUAL):
            bound = "it is behind the rear axle, at {other} = {limit}"
            raise InvalidValue("cg_behind_front", x, bound, unit="m", limit=length, other="wheelbase")

    def _check_complete(self, name: str, needed: tuple[str, ...]) -> None:
        missing = [other for other in needed if getattr(self, other) is None]
        if getattr(self, name) is not None and missing:
            raise ValueError(f"{name} needs {' and '.join(missing)}: give {' and '.join(missing)} in m")

    def pitch_limit(self, lift: float) -> float:
        """Deceleration at which the rear wheel lifts [m/s2]; nan if the centre of gravity is not given.

        Parameters
        ----------
        lift : float
            (M h + J / R) / (M h): what the wheels' inertia adds to the moment that lifts it.
        """
        if self.cg_height is None or self.cg_behind_front is None:
            return math.nan
        return GRAVITY * self.cg_behind_front / (self.cg_height * lift)

    def grip_limit(self, lift: float, inertia: float) -> float:
        """Deceleration at which the braked tyre slips [m/s2], inf if it never does; nan if not given.

        Parameters
        ----------
        lift : float
            As for `pitch_limit`.
        inertia : float
            (M + J / R^2) / M.
        """
        mu, length = self.tyre_friction, self.wheelbase
        if mu is None or length is None or self.cg_height is None or self.cg_behind_front is None:
            return math.nan
        moved, x = mu * self.cg_height * lift, self.cg_behind_front
        if self.braked_wheel == "rear":
            return mu * GRAVITY * x / (inertia * length + moved)
        holds = inertia * length - moved  # not positive where pitching over comes first
        return mu * GRAVITY * (length - x) / holds if holds > 0 else math.inf
