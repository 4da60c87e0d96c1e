"""Why there is no answer, also where its computation was ended, in sentences for the fields."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor

from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.processes import TakesTooLong
from beamdyn.common.screens.screens import Screen
from beamdyn.common.screens.tasks import Outcome

_FEW = 3  # fields that are changed by hand between two answers; a file that is opened changes more


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


def at_fault(work: OpenDocument, screen: Screen) -> dict[str, list[str]]:
    """Mistakes on a screen, by the path of the field at fault.

    What is about no single field is about all that have changed since the last answer.  So is what is about
    others than these, if they are few: a top speed is refused since the beam has been made longer.
    """
    mistakes = dict(work.mistakes.get(screen.name, {}))
    since = changed(work, screen)
    if "" in mistakes:
        return dict.fromkeys(since, mistakes[""]) | mistakes
    if not 0 < len(since) <= _FEW or not mistakes or {*since} & {*mistakes}:
        return mistakes
    before = work.answered[screen.name].entries
    sentences = [said for each in mistakes.values() for said in each]
    return {path: [f"{said}; {_cause(path, before)}" for said in sentences] for path in since}


def _since(path: str, before: Mapping[str, str]) -> str:
    return f"since the last answer this has changed; it was {before.get(path) or 'empty'}"


def _cause(path: str, before: Mapping[str, str]) -> str:
    return f"that comes from {path}, which was {before.get(path) or 'empty'}: change either"
