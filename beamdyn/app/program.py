"""The program that the command ``beamdyn app`` runs: its kinds of input files, each with its screens."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files

from beamdyn.analyses import analyses
from beamdyn.analyses.about_campbell import campbell
from beamdyn.analyses.analysis import Analysis
from beamdyn.app.analysis_screen import analysis_screen, first_entries
from beamdyn.app.deck_screen import DECK
from beamdyn.app.frequency_screen import FREQUENCIES
from beamdyn.app.mode_shapes import MODE_SHAPES
from beamdyn.app.rotor_screen import ROTOR
from beamdyn.app.scene_form import ASIDE, inputs_of
from beamdyn.app.steady_state import STEADY_STATE
from beamdyn.app.trade import TRADE
from beamdyn.app.transient_screen import TRANSIENT
from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens.examples import examples_folder
from beamdyn.common.screens.form_entries import table_of
from beamdyn.common.screens.screens import Document, Program, Screen
from beamdyn.files.scene_inputs import with_physics_as_table
from beamdyn.files.scenes import parse_scene

SHOWN = [*(analysis for analysis in analyses().values() if analysis.screen), campbell]
# Example file that is open at first, for each kind of input file (`Document`) other than "scene".
_BASES = {"harvester": "bimorph.toml", "periodic motion": "pulsating_wheel.toml"}
_ASIDE = {
    "options.top_speed": "150 rad/s",
    "options.modes": "2",
    "operation.speed": "100 rad/s",
    "trade.digits": "3",
    "run.end": "12 s",
    "run.window_start": "0 s",
    "run.window_end": "",
}
_HEADINGS = {
    "options": "Speeds and modes",
    "model": "Gravity and damping ratio",
    "operation": "Speed",
    "trade": "Digits to keep",
    "run": "Time and window",
} | {analysis.function.__name__: "Options" for analysis in SHOWN}


def _on(base: str) -> list[Analysis]:
    """Return the analyses whose first example uses the file `base`; their screens start with it."""
    return [each for each in SHOWN if f"/{base} " in f"{each.examples[0]} "]


def _scene(
    name: str, base: str, shown: Sequence[Analysis], aside: Mapping[str, str], *special: Screen
) -> Document:
    """Make a `Document`, a kind of input file with its screens, for scenes; it opens with the text `base`.

    Its screens are the `special` ones and those made from the analyses `shown`; `aside` contains initial
    texts of form fields that are not part of the scene file.
    """
    of_analyses = (first_entries(each).items() for each in shown)
    aside = {**aside, **{path: text for entries in of_analyses for path, text in entries}}
    elsewhere = {*ASIDE} - {*map(table_of, aside)}

    def inputs(entries: Mapping[str, str]) -> list[Input]:
        return [entry for entry in inputs_of(entries) if table_of(entry.path) not in elsewhere]

    screens = (*special, *map(analysis_screen, shown))
    return Document(
        name, base, inputs, parse_scene, screens, aside, in_fields=with_physics_as_table, headings=_HEADINGS
    )


_OWN = {name: _on(base) for name, base in _BASES.items()}
SCENE = _scene(
    "scene",
    (files("beamdyn.app") / "scene.toml").read_text(encoding="utf-8"),
    [each for each in SHOWN if not any(each in own for own in _OWN.values())],
    _ASIDE,
    *(FREQUENCIES, ROTOR, MODE_SHAPES, STEADY_STATE, TRANSIENT, TRADE),
)
OTHERS = tuple(
    _scene(name, (examples_folder() / base).read_text(encoding="utf-8"), _OWN[name], {})
    for name, base in _BASES.items()
)
BEAMDYN = Program("beamdyn", "Rotating beam", (SCENE, *OTHERS, DECK))
