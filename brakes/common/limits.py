"""Largest forces that standards allow for a hand or a foot, and the comparison of a force with them."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers

EDGE = 1e-9  # relative excess of a value over its limit that counts as rounding
LIMITS = MappingProxyType(  # largest force [N], and its source, by limb and control
    {
        "foot": (450.0, "ISO 6292:2020, 4.5.2"),
        "hand": (300.0, "ISO 6292:2020, 4.5.4"),
        "grip": (150.0, "ISO 6292:2020, 4.5.5"),
        "bicycle": (180.0, "TBIS 4210-2:2018, 4.6.9.2, an edition of ISO 4210-2"),
    }
)


def passes(limb: str, force: Numbers) -> bool:
    """Return whether a force [N], or any of many, exceeds the limit of a limb, a key of `LIMITS`."""
    return bool(np.max(force) > LIMITS[limb][0] * (1 + EDGE))


def verdict(limb: str, force: Numbers) -> str:
    """Compare the largest force [N] with the limit of a limb (a key of `LIMITS`), in one sentence."""
    most, source = LIMITS[limb]
    said = "exceeded" if passes(limb, force) else "kept"
    limb = "hand on a bicycle's lever" if limb == "bicycle" else limb
    return f"force of {float(np.max(force)):.6g} N: {source}, allows {most:g} N for a {limb}: {said}"
