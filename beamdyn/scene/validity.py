"""Where the theory holds: limits of deflection, strain and road, and the warnings past them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

LARGE_DEFLECTION = 0.1  # of the length: past it a linear theory errs by several percent
LARGE_STRAIN = 0.01
STANDARD_GRAVITY = 9.81  # m/s2: past this acceleration of the road a wheel leaves it
FASTEST = 1e50  # rad/s: its fourth power is still far from overflow


def check_speeds(speeds: np.ndarray) -> None:
    """Refuse speeds [rad/s] whose powers would overflow."""
    fastest = speeds[np.abs(speeds).argmax()]
    if abs(fastest) > FASTEST:
        raise ValueError(f"speed = {fastest:g} rad/s: give at most {FASTEST:g} rad/s either way")


def warn_of_strain(strain: float) -> Iterator[str]:
    """A warning for a static axial strain that is not small."""
    if strain > LARGE_STRAIN:
        yield f"static axial strain reaches {strain:.2g}: above 1 % stretch is not negligible"


def warn_of_static_deflection(deflection: np.ndarray, length: float, speeds: np.ndarray) -> Iterator[str]:
    """A warning where rotation bends the tip by `deflection` [m] past linear theory, at speeds [rad/s]."""
    bent = np.abs(deflection) > LARGE_DEFLECTION * length
    if bent.any():
        yield (
            f"at {speeds[bent][0]:.6g} rad/s the rotation bends the tip by "
            f"{abs(deflection[bent][0]) / length:.2g} of the length: past {LARGE_DEFLECTION:g} the answer is "
            "outside linear theory"
        )


def warn_of_deflection(
    deflection: np.ndarray, length: float, speeds: np.ndarray | None = None
) -> Iterator[str]:
    """A warning where the tip moves by `deflection` [m] past linear theory, at speeds [rad/s] if given."""
    large = deflection > LARGE_DEFLECTION * length
    if large.any():
        yield (
            f"the tip moves by {deflection[large].max() / length:.2g} of the length{_at(speeds, large)}: "
            f"past {LARGE_DEFLECTION:g} it is outside linear theory"
        )


def warn_of_road(acceleration: np.ndarray, speeds: np.ndarray | None = None) -> Iterator[str]:
    """A warning where the road accelerates the wheel [m/s2] by more than gravity, at speeds if given."""
    past = acceleration > STANDARD_GRAVITY
    if past.any():
        yield (
            f"the road accelerates the wheel by {acceleration.max():.4g} m/s2, more than gravity"
            f"{_at(speeds, past)}: the wheel leaves the road; was a velocity amplitude given as a height?"
        )


def _at(speeds: np.ndarray | None, where: np.ndarray) -> str:
    return "" if speeds is None else f" at {list_range(speeds[where])}"


def list_range(speeds: np.ndarray) -> str:
    """Slowest and fastest of some speeds [rad/s], in words."""
    ends = [f"{speed:.6g}" for speed in (speeds.min(), speeds.max())]
    return " to ".join(dict.fromkeys(ends)) + " rad/s"
