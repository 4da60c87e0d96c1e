"""Sensitivity of a result to friction: the same design with less and with more friction."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

import numpy as np

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import part_at, with_parts
from brakes.answers.tables import format_number

Answer = TypeVar("Answer")
_SAME = 1e-9  # relative difference of two results below which they count as equal
PART = 0.1  # fraction by which friction varies, according to makers of linings


def change(other: float, value: float, unit: str, none: str) -> str:
    """State a result `other` with its unit and its change from `value` in %; `none` if it is not finite."""
    if not np.isfinite(other):
        return none
    relative = f" ({100 * (other / value - 1):+.1f} %)" if value else ""
    return f"{format_number(other)} {unit}{relative}"


def with_less_and_more(design: Any, path: str, solve: Callable[[Any], Answer]) -> list[Answer]:
    """Solve a design with less and with more friction; leave out cases without a result.

    Parameters
    ----------
    design : BaseModel
        The design.
    path : str
        Path of the friction coefficient in the design; without friction no case is solved.
    solve : callable
        ``solve(design)`` returns the answer.
    """
    friction, found = part_at(design, path), list[Answer]()
    for part in (1 - PART, 1 + PART) if friction else ():
        # With the varied friction out of bounds, or with a brake that locks, there is no result.
        with suppress(InvalidValue, NoAnswer):
            found.append(solve(with_parts(design, {path: part * friction})))
    return found


def hangs_on_friction(
    design: Any, path: str, of: str, result: Callable[[Any], float], unit: str, none: str
) -> str:
    """State in one sentence how a result changes with 10 % less and 10 % more friction.

    Parameters
    ----------
    design : BaseModel
        The design.
    path : str
        Path of the friction coefficient in the design.
    of : str
        Rubbing parts, and the name of the result, such as "tyres on the road: stopping distance".
    result : callable
        ``result(design)``: the result in `unit`; nan or inf if there is none.
    unit : str
        Unit of the result.
    none : str
        Words for a result that does not exist, such as "does not stop".
    """
    value = result(design)
    others = with_less_and_more(design, path, result)
    what, _, name = of.partition(": ")
    now, ends = change(value, 0.0, unit, none), ", ".join(change(each, value, unit, none) for each in others)
    if others and all(abs(each - value) <= _SAME * abs(value) for each in others):
        ends = "no change, as something else limits it"
    return f"{name} {now}; friction of {what} -+{100 * PART:.0f} %: {ends}."
