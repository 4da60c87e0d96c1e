"""Downloads of files that are made in another process."""

from __future__ import annotations

import asyncio
from concurrent.futures import BrokenExecutor
from typing import Any

from nicegui import ui

from beamdyn.common.screens.processes import TakesTooLong
from beamdyn.common.screens.under_way import SOON


async def download(making: asyncio.Future[Any], name: str) -> None:
    """Download bytes or a text as a file when they have been made; notify if that takes long, or fails.

    Parameters
    ----------
    making : asyncio.Future
        From `TaskTaker.submit`.
    name : str
        Name of the file.
    """
    await asyncio.wait([making], timeout=SOON)
    if not making.done():
        ui.notify(f"{name} is being made")
    try:
        made = await making
    except (TakesTooLong, BrokenExecutor) as error:
        ui.notify(f"{name} was given up: {error}", type="negative")
        return
    ui.download.content(made.encode() if isinstance(made, str) else made, name)
