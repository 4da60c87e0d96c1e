"""The Campbell diagram of one scene, and the reading of options for Campbell diagrams."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

import beamdyn as bd
from beamdyn.analyses.analysis import analysis
from beamdyn.analyses.options import Discretization, FrequencyTolerance, ModeCount, Text
from beamdyn.analyses.values import in_unit_of, parse_positive, parse_speed
from beamdyn.common.edge.units import unit_as_written
from beamdyn.studies.campbell.diagram import Campbell

_SPEEDS = 301
_SPEEDS_OF_BENT = 61  # number of speeds if deflections are large: each speed needs an equilibrium


@analysis('beamdyn campbell examples/rolling_harvester.toml --top-speed "150 rad/s"', screen="Campbell")
def campbell(
    scene: bd.Scene,
    *,
    top_speed: Text,
    rated: Text | None = None,
    operating: Text | None = None,
    per_rev: Text = "6",
    modes: ModeCount = 4,
    discretization: Discretization = "ritz",
    tolerance: FrequencyTolerance = None,
) -> Campbell:
    """Campbell diagram: natural frequencies over rotor speed, per-rev lines, crossings and margins.

    Parameters
    ----------
    top_speed
        Top speed of the diagram, with its unit, e.g. "15 rpm".
    rated
        Rated speed, at which margins are stated, with its unit, e.g. "12.1 rpm".
    operating
        Operating range, over which margins are stated and in which crossings are marked: lowest:highest with
        a unit, e.g. "6.9:12.1 rpm".
    per_rev
        Per-rev lines: "6" for 1P to 6P, one order, e.g. "2P", or a list, e.g. "3, 6, 9".
    """
    speeds, unit = parse_top(top_speed, scene, scene.physics.large_deflection)
    at, between = parse_operation(rated, operating, top_speed, speeds[-1], scene)
    return bd.campbell(
        in_unit_of(scene, top_speed), speeds, per_rev=parse_orders(per_rev), rated=at, operating=between,
        unit=unit, modes=modes, discretization=discretization, tolerance=tolerance,
    )  # fmt: skip


# Reading of options ----------------------------------------------------------------------------------


def parse_top(text: str, scene: bd.Scene | None, bent: bool) -> tuple[Any, str]:
    """Read a top speed, such as "15 rpm": return speeds from 0 to it [rad/s], and the unit for display.

    The speeds are evenly spaced; with large deflections (`bent`) there are fewer.
    """
    top = parse_positive("--top-speed", text, "rad/s", scene)
    unit, _ = unit_as_written(text, "rad/s")
    count = _SPEEDS_OF_BENT if bent else _SPEEDS
    return np.linspace(0.0, top, count), "rpm" if unit == "rpm" else "rad/s"


def parse_operation(
    rated: str | None, operating: str | None, top_text: str, top: float, scene: bd.Scene | None
) -> tuple[float | None, tuple[float, float] | None]:
    """Read the rated speed and the operating range [rad/s]; raise an error if they exceed the top speed."""

    def up_to_top(speed: float, words: str) -> float:
        if speed > top * (1 + 1e-12):
            raise ValueError(f'{words}: it is above --top-speed = "{top_text}"; give a higher top speed')
        return min(speed, top)

    at, range_ = None, None
    if rated is not None:
        at = up_to_top(parse_positive("--rated", rated, "rad/s", scene), f'--rated = "{rated}"')
    if operating is not None:
        numbers, _, unit = operating.strip().rpartition(" ")
        ends, words = [part.strip() for part in numbers.split(":")], f'--operating = "{operating}"'
        if len(ends) != 2:
            raise ValueError(f'{words}: give lowest:highest and a unit, e.g. "6.9:12.1 rpm"')
        low, high = (parse_speed("--operating", f"{end} {unit}", scene) for end in ends)
        if not 0 <= low < high:
            raise ValueError(f"{words}: it must begin at 0 or above and end above its beginning")
        range_ = low, up_to_top(high, f"--operating = {ends[1]} {unit}")
    if at is not None and range_ is not None and not range_[0] <= at <= range_[1]:
        raise ValueError(f'--rated = "{rated}": it lies outside --operating = "{operating}"; widen the range')
    return at, range_


def parse_orders(text: str) -> Sequence[int]:
    """Read the orders of per-rev lines: 1 to n for "n", only n for "nP", or the orders in a list."""
    if alone := re.fullmatch(r"\s*([1-9]\d*)\s*P\s*", text, re.IGNORECASE):
        return [int(alone[1])]
    parts = [part.strip() for part in text.split(",")]
    orders = [int(part) for part in parts if part.isdecimal() and int(part) > 0]
    if len(orders) < len(parts):
        raise ValueError(
            f'--per-rev = "{text}": give the highest order, e.g. "6" for 1P to 6P, one order, e.g. "2P", or '
            'a list of whole numbers above 0, e.g. "3, 6, 9"'
        )
    return orders if len(parts) > 1 else range(1, orders[0] + 1)
