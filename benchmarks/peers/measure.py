"""Measurements of programs: what they consist of, and how they are taken."""

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
DEFAULT, ALONE = "default", "one speed by itself"  # words in the names of beamdyn's settings

T_END, WINDOW = 30.0, (20.0, 30.0)
ENOUGH = 0.5  # time [s] for which short runs are repeated

Result = TypeVar("Result")


@dataclass(frozen=True)
class Point:
    """A program at one setting: its time [s] (per speed, or of the run) and its largest relative error."""

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
    """Measure the shortest of several runs [s], and return the last result, too; noise only adds."""
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
    """Compute the largest |u| in the window, by a parabola through the largest sample and its neighbours."""
    a = np.abs(u[(t >= WINDOW[0]) & (t <= WINDOW[1])])
    k = int(a[1:-1].argmax()) + 1
    slope, curvature = (a[k + 1] - a[k - 1]) / 2, a[k + 1] - 2 * a[k] + a[k - 1]
    return float(a[k] - slope**2 / (2 * curvature)) if curvature < 0 else float(a[k])


# What is known ------------------------------------------------------------------------------------


@lru_cache
def given() -> dict[str, float]:
    """Load Table 1 of the paper, in SI units."""
    return {name: entry["value"] for name, entry in load("lee_yoo_2019")["input"].items()}


def harvester_frequencies() -> dict[float, float]:
    """Load the frequency [Hz] of beam theory by speed [rad/s], to ten digits."""
    rows = load("lee_yoo_2019")["reference"]["first_frequency"]
    return {row["speed"]["value"]: row["bending"]["value"] for row in rows}


def blade_frequencies() -> dict[float, float]:
    """Load the first flap frequency of a uniform blade without hub by speed, to twelve digits."""
    return {case["gamma"]: case["frequency"][0] for case in load("rotating_beams")["case"] if _uniform(case)}


def _uniform(case: dict[str, Any]) -> bool:
    plain = case["model"] == "bending" and "tip" not in case and case["delta"] == 0
    return plain and case["bending_angle_deg"] == 90 and case["mass"] == case["stiffness"] == [1.0]


def largest_error(computed: dict[float, float], exact: dict[float, float]) -> float:
    """Compute the largest relative deviation."""
    return max(abs(computed[speed] / exact[speed] - 1) for speed in exact)
