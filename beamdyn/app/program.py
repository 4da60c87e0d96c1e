"""The program ``beamdyn app``: the list of its screens."""

from __future__ import annotations

from importlib.resources import files

from beamdyn.app.frequencies import FREQUENCIES
from beamdyn.app.inputs import inputs_of
from beamdyn.app.steady_state import STEADY_STATE
from beamdyn.common.app.screens import Document, Program
from beamdyn.config import parse_scene, with_physics_as_table

SCREENS = (FREQUENCIES, STEADY_STATE)
SCENE = Document(
    "scene",
    (files("beamdyn.app") / "scene.toml").read_text(encoding="utf-8"),
    inputs_of,
    parse_scene,
    SCREENS,
    aside={"options.top_speed": "150 rad/s", "options.modes": "2"},
    in_fields=with_physics_as_table,
)
BEAMDYN = Program("beamdyn", "Rotating beam", (SCENE,))
