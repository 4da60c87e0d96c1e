"""What damps the vibration of the beam, beyond one ratio for all modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from beamdyn.common.inputs.checks import InvalidValue, amount, real_array, refuse, set_fields
from beamdyn.common.inputs.described import Described, descriptions

_RATIO: Any = {"least": 0, "below": 1, "remedy": "1 % is 0.01"}


@dataclass(frozen=True)
class Damping:
    """Damping of the beam: ratios mode by mode, Rayleigh's factors, and a damper at the tip; they add up.

    Parameters
    ----------
    ratios : sequence of float
        Damping ratio of each mode of the beam at rest, from the lowest, each from 0 to below 1; further modes
        have the last one.
    mass_factor : float
        Factor alpha of the mass [1/s] in C = alpha M + beta K, with K at rest (Rayleigh).
    stiffness_factor : float
        Factor beta of the stiffness [s]: a material whose stress is E (strain + beta strain rate).
    tip_damper : float
        Damper between the tip and the carrier [N s/m], against motion across the beam in any direction.

    Raises
    ------
    ValueError
        If a value is not finite or out of its range.

    References
    ----------
    Standard: modal ratios, Rayleigh damping, a viscous damper; section Damping of docs/conventions.md.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, damping=bd.Damping(ratios=(0.01, 0.02)))  # of the first two modes
    >>> scene.is_damped
    True
    """

    ratios: Sequence[
        Annotated[float, Described("", "zeta_k", "damping ratio of each mode at rest", **_RATIO)]
    ] = ()
    mass_factor: Annotated[
        float, Described("1/s", "alpha", "damping by the mass: C = alpha M + beta K", least=0)
    ] = 0.0
    stiffness_factor: Annotated[
        float, Described("s", "beta", "damping by the stiffness at rest: C = alpha M + beta K", least=0)
    ] = 0.0
    tip_damper: Annotated[
        float, Described("N s/m", "c_t", "damper between the tip and the carrier", least=0)
    ] = 0.0

    def __post_init__(self) -> None:
        ratios = real_array("damping.ratios", self.ratios)
        bound = "each is from 0 to below 1"
        refuse((ratios < 0) | (ratios >= 1), "damping.ratios", ratios, "", bound, _RATIO["remedy"])
        set_fields(self, ratios=tuple(ratios.tolist()))
        for name in ("mass_factor", "stiffness_factor", "tip_damper"):
            described, of = descriptions(Damping)[name], f"damping.{name}"
            set_fields(self, **{name: amount(of, described.check(of, getattr(self, name)), described.unit)})

    @property
    def damps(self) -> bool:
        """Whether anything is damped."""
        return any(self.ratios) or bool(self.mass_factor or self.stiffness_factor or self.tip_damper)

    def ratios_of(self, modes: int) -> list[float]:
        """Ratio of each of a number of modes at rest, from the lowest; 0 where none is given."""
        last = self.ratios[-1] if self.ratios else 0.0
        return [*self.ratios[:modes], *[last] * (modes - len(self.ratios))]


NO_DAMPING = Damping()


def check_one_kind_of_ratios(ratio: float, damping: Damping) -> None:
    """Refuse one ratio for all modes beside one for each."""
    if ratio and damping.ratios:
        bound = "damping.ratios gives one for each mode, too"
        raise InvalidValue("damping_ratio", ratio, bound, "leave one of the two out")
