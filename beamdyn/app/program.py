"""The program ``beamdyn app``: the list of its screens."""

from __future__ import annotations

from importlib.resources import files

from beamdyn.analyses import analyses
from beamdyn.analyses.about_campbell import campbell
from beamdyn.app.analysis_screen import analysis_screen, first_entries
from beamdyn.app.deck_screen import DECK
from beamdyn.app.frequency_screen import FREQUENCIES
from beamdyn.app.mode_shapes import MODE_SHAPES
from beamdyn.app.rotor_screen import ROTOR
from beamdyn.app.scene_form import inputs_of
from beamdyn.app.steady_state import STEADY_STATE
from beamdyn.app.trade import TRADE
from beamdyn.app.transient_screen import TRANSIENT
from beamdyn.common.screens.screens import Document, Program
from beamdyn.files.scene_inputs import with_physics_as_table
from beamdyn.files.scenes import parse_scene

SHOWN = [*(analysis for analysis in analyses().values() if analysis.screen), campbell]
SCREENS = (FREQUENCIES, ROTOR, MODE_SHAPES, STEADY_STATE, TRANSIENT, TRADE, *map(analysis_screen, SHOWN))
SCENE = Document(
    "scene",
    (files("beamdyn.app") / "scene.toml").read_text(encoding="utf-8"),
    inputs_of,
    parse_scene,
    SCREENS,
    aside={
        "options.top_speed": "150 rad/s",
        "options.modes": "2",
        "operation.speed": "100 rad/s",
        "trade.digits": "3",
        "run.end": "12 s",
        "run.window_start": "0 s",
        "run.window_end": "",
    }
    | {path: text for analysis in SHOWN for path, text in first_entries(analysis).items()},
    in_fields=with_physics_as_table,
    headings={
        "options": "Speeds and modes",
        "model": "Gravity and damping ratio",
        "operation": "Speed",
        "trade": "Digits to keep",
        "run": "Time and window",
    }
    | {analysis.function.__name__: "Options" for analysis in SHOWN},
)
BEAMDYN = Program("beamdyn", "Rotating beam", (SCENE, DECK))
