"""Style and scripts of an interactive program's page: those in files beside this one, and colours."""

from __future__ import annotations

import json
from importlib.resources import files

from beamdyn.common.drawing.svg import page_colours
from beamdyn.common.edge.rendering import STYLE as TABLES
from beamdyn.common.screens.chart_options import chart_colours

BLUE, RED = "#0072B2", "#8c1c00"
_HERE = files("beamdyn.common.screens")
_DARK = "body.body--dark"
STYLE = (
    TABLES
    + page_colours(":root")
    + chart_colours(":root")
    + page_colours(_DARK, dark=True)
    + chart_colours(_DARK, dark=True)
    + (_HERE / "page.css").read_text(encoding="utf-8")
)


def scripts_of(program: str) -> str:
    """The scripts of a program's page as HTML.

    Parameters
    ----------
    program : str
        Name of the program.
    """
    script = (_HERE / "page.js").read_text(encoding="utf-8")
    named = f"window.programName = {json.dumps(program)};"
    return f'<script>{named}</script>\n<script type="module">\n{script}</script>'
