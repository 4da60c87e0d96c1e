"""Warnings of Python by analyses whose answer lies outside the range of their theory."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import ParamSpec, TypeVar

from beamdyn.common.results.statements import OUTSIDE, of_kind

_REMEDY = '; Scene(..., physics="auto") adds what matters'

Arguments = ParamSpec("Arguments")
Answer = TypeVar("Answer")
_within_another: ContextVar[bool] = ContextVar("within_another", default=False)


class OutsideLinearTheory(UserWarning):
    """A number of linear theory about a beam that bends further than this theory allows.

    Analyses issue this warning of Python, once each, where the beam bends by more than a
    tenth of its length; the result says so in its ``warnings``, too.  With ``physics="auto"`` of the scene,
    analyses add the effects that matter instead.

    Examples
    --------
    To stop where one is issued, and to go on without:

    >>> import warnings
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=0.785))
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", bd.OutsideLinearTheory)
    ...     try:
    ...         modes = bd.natural_modes(scene, speed=100.0)
    ...     except bd.OutsideLinearTheory:
    ...         print("bent too far")
    bent too far
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", bd.OutsideLinearTheory)
    ...     modes = bd.natural_modes(scene, speed=100.0)
    """


def announced(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Make an analysis warn, as Python does, where its result says that it lies outside linear theory.

    So a script that reads one number of the result is told, too.  An analysis that calls another warns once.
    """
    return _announcing(analysis, _REMEDY)


def announced_of_plain_beam(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Make an analysis about the straight beam alone warn; physics "auto" does not bend its beam."""
    return _announcing(analysis, "")


def _announcing(analysis: Callable[Arguments, Answer], remedy: str) -> Callable[Arguments, Answer]:
    @functools.wraps(analysis)
    def announcing(*given: Arguments.args, **named: Arguments.kwargs) -> Answer:
        with unannounced():
            result = analysis(*given, **named)
        announce(getattr(result, "warnings", ()), remedy)
        return result

    return announcing


def announce(sentences: tuple[str, ...], remedy: str = _REMEDY) -> None:
    """Issue what a result says of lying outside linear theory, as warnings for the caller of the caller."""
    if not _within_another.get():
        for sentence in of_kind(sentences, OUTSIDE):
            warnings.warn(f"{sentence}{remedy}", OutsideLinearTheory, stacklevel=3)


@contextmanager
def unannounced() -> Iterator[None]:
    """Within it, analyses issue no such warnings: their results are parts of another."""
    before = _within_another.set(True)
    try:
        yield
    finally:
        _within_another.reset(before)
