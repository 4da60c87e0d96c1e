"""Why there is no answer, also where its computation was ended, in sentences for the fields."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor

from beamdyn.common.app.open_document import OpenDocument
from beamdyn.common.app.processes import TakesTooLong
from beamdyn.common.app.screens import Screen
from beamdyn.common.app.tasks import Outcome


def outcome_of(future: asyncio.Future[Outcome], work: OpenDocument, screen: Screen) -> Outcome:
    """The outcome of a computation that is done; if it was ended: why, and what had changed."""
    if future.cancelled():
        return {"": ["Cancelled. The next change of an input is computed again."]}
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, TakesTooLong | BrokenExecutor):
        return _explained(str(error), work, screen)
    return {"": [f"There is no answer, for a reason that the program does not know: {error!r}"]}


def _explained(reason: str, work: OpenDocument, screen: Screen) -> Mapping[str, list[str]]:
    """Why an answer was given up, and at their fields the inputs that have changed since the last answer."""
    known = f" {screen.effort}" if screen.effort else ""
    sentence = f"Given up: {reason}.{known}"
    before = work.answered.get(screen.name)
    since = {path: [_since(path, before.entries)] for path in changed(work, screen)} if before else {}
    return {"": [sentence]} | since


def changed(work: OpenDocument, screen: Screen) -> list[str]:
    """Paths of the entries that have changed since the last answer of a screen; none where there is none."""
    if (before := work.answered.get(screen.name)) is None:
        return []
    now = work.needed(screen)
    return [path for path in {**before.entries, **now} if before.entries.get(path) != now.get(path)]


def _since(path: str, before: Mapping[str, str]) -> str:
    was = f"was {before[path]}" if before.get(path) else "was empty"
    return f"since the last answer this has changed; it {was}"
