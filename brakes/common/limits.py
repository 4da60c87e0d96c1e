"""Largest forces of hand and foot by the standards whose text was opened, and the verdict on a force."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers

_EDGE = 1e-9  # relative excess over a limit that is rounding
LIMITS = MappingProxyType(  # by what presses: the force [N], and who says so
    {
        "foot": (450.0, "ISO 6292:2020, 4.5.2"),
        "hand": (300.0, "ISO 6292:2020, 4.5.4"),
        "grip": (150.0, "ISO 6292:2020, 4.5.5"),
        "bicycle": (180.0, "TBIS 4210-2:2018, 4.6.9.2, an edition of ISO 4210-2"),
    }
)


def passes(limb: str, force: Numbers) -> bool:
    """Whether a force [N], or any of many, is above the limit of what presses."""
    return bool(np.max(force) > LIMITS[limb][0] * (1 + _EDGE))


def verdict(limb: str, force: Numbers) -> str:
    """One sentence on the largest of the forces [N] of what presses."""
    most, source = LIMITS[limb]
    said = "exceeded" if passes(limb, force) else "kept"
    limb = "hand on a bicycle's lever" if limb == "bicycle" else limb
    return f"force of {float(np.max(force)):.6g} N: {source}, allows {most:g} N for a {limb}: {said}"
