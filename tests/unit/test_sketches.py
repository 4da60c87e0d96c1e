"""Sketches beside the forms: their symbols are those of the inputs, and no text covers another."""

from __future__ import annotations

import pytest

from beamdyn.app.program import BEAMDYN
from beamdyn.common.drawing.layout import lay_out
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.sketch import Sketch, sketch_paper
from beamdyn.common.drawing.text_width import symbol_html, typeset
from beamdyn.common.screens.form_entries import label, label_html, table_of
from brakes.app.program import BRAKES
from tests.unit.test_drawings import check_texts, kinds

SCREENS = [
    pytest.param(document, screen, entries, id=f"{screen.name} {name}")
    for program in (BRAKES, BEAMDYN)
    for document in program.documents
    for name, entries in kinds(document).items()
    for screen in document.screens
]
# Lengths and angles that no sketch shows: those of functions along the beam, and beside the plane drawn.
OFFSETS = {"beam.mass_offset", "beam.tension_offset", "beam.tip.offset_across"}
LAYERS = {"harvester.thickness", "harvester.start", "harvester.end"}  # on the beam, too thin to be seen
OF_DECKS = {"deck.length", "deck.hub_radius"}  # of a blade that its file describes
NOT_DRAWN = {"beam.twist", "beam.sweep", "beam.prebend"} | OFFSETS | LAYERS | OF_DECKS


@pytest.mark.parametrize("document, screen, entries", SCREENS)
def test_a_sketch_has_the_symbols_of_its_form_and_no_others(document, screen, entries):
    inputs = document.inputs(entries)
    rows = screen.sketch(entries)
    drawn = {label.symbol for row in rows for drawing in row for label in drawing.labels if label.symbol}
    said = {word.strip(",;") for entry in inputs for word in entry.quantity.meaning.split()}
    assert drawn <= {typeset(known) for known in {entry.quantity.symbol for entry in inputs} | said}
    on_form = [e for e in inputs if table_of(e.path) in screen.sections and e.quantity.symbol]
    if screen.name == "Mechanism" and not entries.get("stop.mass"):  # its table is folded
        on_form = [entry for entry in on_form if table_of(entry.path) != "stop"]
    of_space = {e.path: e for e in on_form if e.quantity.unit in ("m", "rad") and e.path not in NOT_DRAWN}
    missing = {path for path, entry in of_space.items() if typeset(entry.quantity.symbol) not in drawn}
    assert missing == set()


@pytest.mark.parametrize("document, screen, entries", SCREENS)
def test_no_text_of_a_sketch_covers_another_on_the_paper_of_a_form(document, screen, entries):
    rows = screen.sketch(entries)
    check_texts(figure_of(rows, sketch_paper(rows)))
    assert not any(layout.numbered for layout in lay_out(rows, sketch_paper(rows)))


def test_a_dimension_of_each_named_caliper_has_its_name_in_the_sketch():
    document = next(document for document in BRAKES.documents if document.name == "caliper")
    for name, entries in kinds(document).items():
        written = " ".join(label.text for label in document.screens[0].sketch(entries)[0][0].labels)
        dimensions = [e for e in document.inputs(entries) if table_of(e.path) == "dimensions"]
        points = [entry for entry in dimensions if isinstance(entry.default, tuple)]
        assert points
        for entry in points:
            assert entry.name.replace("_", " ") in written, name


@pytest.mark.parametrize(
    "symbol, drawn, html",
    [
        ("r", "r", "<i>r</i>"),
        ("phi", "φ", "<i>φ</i>"),
        ("alpha1", "α_1", "<i>α</i><sub>1</sub>"),
        ("m_t", "m_t", "<i>m</i><sub>t</sub>"),
        ("omega_s", "ω_s", "<i>ω</i><sub>s</sub>"),
        ("p_max", "p_max", "<i>p</i><sub>max</sub>"),
        ("rho A", "rho A", "<i>ρ</i> <i>A</i>"),
        ("C*", "C*", "<i>C*</i>"),
        ("<b>", "<b>", "<i>&lt;b&gt;</i>"),
    ],
)
def test_symbols_are_set_alike_in_drawing_and_form(symbol, drawn, html):
    assert typeset(symbol) == drawn and symbol_html(symbol) == html


def test_the_form_has_symbols_as_the_sketch_has_them():
    document = next(each for each in BEAMDYN.documents if each.name == "scene")
    entry = next(e for e in document.inputs(document.base_entries) if e.path == "mount.setting_angle")
    assert label(entry) == "setting angle, phi" and label_html(entry) == "setting angle, <i>φ</i>"


def test_a_sketch_has_no_scale():
    sketch = Sketch()
    sketch.length("L", (0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    rows = [[sketch.drawing("A length", "A length: L")]]
    (layout,) = lay_out(rows, sketch_paper(rows))
    assert [text.symbol or text.lines[0] for text in layout.texts] == ["A length", "L"]
