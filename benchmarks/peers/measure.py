"""Measurements of accuracy and time of programs: data and functions common to all programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from importlib import metadata
from time import perf_counter
from typing import Any, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from beamdyn.published import load

HARVESTER = "first frequency of the inward harvester at 0, 50, 100 rad/s"
BLADE = "first flap frequency of an outward blade at nondimensional speeds 0 to 12"
ROLLING = "largest deflection of the rolling harvester in 20...30 s"
CASES = (HARVESTER, BLADE, ROLLING)
OURS = "beamdyn"
DEFAULT, ALONE = "default", "one speed by itself"  # phrases in the names of beamdyn's settings

T_END, WINDOW = 30.0, (20.0, 30.0)
ENOUGH = 0.5  # total time [s] for which short runs are repeated

Result = TypeVar("Result")


@dataclass(frozen=True)
class Point:
    """A program at one setting: time [s] (per speed, or of the transient) and largest relative error."""

    case: str
    program: str
    setting: str
    time: float
    error: float


def installed(package: str) -> str | None:
    """Return the version of a package; None if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def shortest(action: Callable[[], Result], runs: int = 3) -> tuple[float, Result]:
    """Measure the shortest of several runs [s], as disturbances only lengthen; return also a result."""
    times: list[float] = []
    while len(times) < runs or sum(times) < ENOUGH:
        start = perf_counter()
        result = action()
        times.append(perf_counter() - start)
    return min(times), result


def best_threads(action: Callable[[], Result]) -> tuple[float, Result]:
    """Measure the shortest run [s] with the default number of BLAS threads and with one."""
    default, _ = shortest(action)
    with threadpool_limits(1):
        single, result = shortest(action)
    return min(default, single), result


def peak(t: np.ndarray, u: np.ndarray) -> float:
    """Compute the largest |u| in the time window, by a parabola through the largest three samples."""
    a = np.abs(u[(t >= WINDOW[0]) & (t <= WINDOW[1])])
    k = int(a[1:-1].argmax()) + 1
    slope, curvature = (a[k + 1] - a[k - 1]) / 2, a[k + 1] - 2 * a[k] + a[k - 1]
    return float(a[k] - slope**2 / (2 * curvature)) if curvature < 0 else float(a[k])


# Reference values ---------------------------------------------------------------------------------


@lru_cache
def given() -> dict[str, float]:
    """Load Table 1 of Lee and Yoo (2019), in SI units."""
    return {name: entry["value"] for name, entry in load("lee_yoo_2019")["input"].items()}


def harvester_frequencies() -> dict[float, float]:
    """Load the harvester's first frequency [Hz] by beam theory to ten digits, by speed [rad/s]."""
    rows = load("lee_yoo_2019")["reference"]["first_frequency"]
    return {row["speed"]["value"]: row["bending"]["value"] for row in rows}


def blade_frequencies() -> dict[float, float]:
    """Load the first flap frequency of a uniform blade without hub to twelve digits, by speed."""
    return {case["gamma"]: case["frequency"][0] for case in load("rotating_beams")["case"] if _uniform(case)}


def _uniform(case: dict[str, Any]) -> bool:
    plain = case["model"] == "bending" and "tip" not in case and case["delta"] == 0
    return plain and case["bending_angle_deg"] == 90 and case["mass"] == case["stiffness"] == [1.0]


def largest_error(computed: dict[float, float], exact: dict[float, float]) -> float:
    """Compute the largest relative deviation."""
    return max(abs(computed[speed] / exact[speed] - 1) for speed in exact)
