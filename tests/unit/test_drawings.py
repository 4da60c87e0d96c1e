"""Drawings as data: labels find free places, texts are escaped, both renderers draw the same."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.analyses.results.cautions import notes_of
from beamdyn.analyses.results.of_modes import rotor_csv
from beamdyn.app.program import BEAMDYN
from beamdyn.common.drawing.label_places import LabelRequest, Obstacles, place_labels
from beamdyn.common.drawing.layout import Fit, Paper, arrange, follow, lay_out
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, Label, Outline, Symbol
from beamdyn.common.drawing.strokes import INKS
from beamdyn.common.drawing.svg import page_colours, svg_of
from beamdyn.common.drawing.text_width import text_size, wrapped
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.screens.open_document import OpenDocument
from brakes import calipers
from brakes.app.program import BRAKES
from brakes.drawings.caliper import caliper_drawing
from brakes.drawings.forklift import truck
from brakes.drawings.mechanism import free_body_drawings

ROOT = Path(__file__).parents[2]
SVG = "{http://www.w3.org/2000/svg}"
HINTED = 1.02  # letters that matplotlib draws are up to this much wider: it fits them to pixels
TOUCHING = 0.75  # boxes that matplotlib measures include a fringe of half a pixel at 100 dpi [pt]


# Every drawing of every example, command and screen ---------------------------------------------------------


def rotors():
    for path in sorted((ROOT / "examples").glob("*.toml")):
        try:
            scene = bd.load_scene(path)
        except ConfigError:  # of a brake
            continue
        yield pytest.param(lambda s=scene: bd.draw(s).drawings(), id=path.stem)


def screens():
    for document in BRAKES.documents:
        for screen in document.screens:
            places = (0.0, 0.5, 1.0, 1.7, 2.0) if screen.name == "Kinematics" else (0.0, 0.4, 1.0)
            for place in places if screen.slider else (1.0,):
                yield pytest.param(
                    lambda d=document, s=screen, p=place: of_screen(d, s, p), id=f"{screen.name} {place}"
                )


def of_screen(document, screen, place):
    work = OpenDocument(document)
    assert work.solve(screen), work.mistakes
    return screen.drawings(work.answered[screen.name].answer, place)


def mechanisms():
    from brakes.answers.caliper import MECHANISM
    from brakes.config.mechanism import load_mechanism

    for path in (
        *sorted((ROOT / "examples").glob("calipers/*.toml")),
        ROOT / "examples" / "block_brake.toml",
    ):
        yield pytest.param(lambda p=path: MECHANISM.solve(load_mechanism(p)).drawings(1.0), id=path.stem)
        yield pytest.param(
            lambda p=path: free_body_drawings(MECHANISM.solve(load_mechanism(p)).equilibria),
            id=f"{path.stem}, free bodies",
        )


def commands():
    from brakes.answers.forklift import FORKLIFT
    from brakes.config.forklift import load_forklift

    yield pytest.param(
        lambda: FORKLIFT.solve(load_forklift(ROOT / "examples" / "forklift.toml"))._drawn(None),
        id="forklift",
    )


def named():
    def rows():
        made = [calipers.NAMED[name]().build() for name in calipers.NAMED]
        drawn = [caliper_drawing(caliper, caliper.equilibrium(finger=40.0)) for caliper in made]
        return [drawn[:3], drawn[3:]]

    yield pytest.param(rows, id="examples/caliper.py")


def sketches():
    """Those of all forms, with each kind that may be chosen there."""
    for program in (BRAKES, BEAMDYN):
        for document in program.documents:
            for name, entries in kinds(document).items():
                for screen in document.screens[: None if program is BRAKES else 1]:
                    if screen.sketch(entries):  # a deck is text, without symbols
                        yield pytest.param(
                            lambda s=screen, e=entries: s.sketch(e), id=f"sketch of {screen.name} {name}"
                        )


def kinds(document):
    """Entries of a document by the choice that makes them differ from the base."""
    base = document.base_entries
    made = {"": base}
    made |= {name: {**base, "caliper": name} for name in calipers.NAMED if "caliper" in base}
    if document.name == "mechanism":
        made["that stops a vehicle"] = {**base, "stop.mass": "100 kg"}
    if document.name == "scene":
        plain = {path: text for path, text in base.items() if not path.startswith(("motion", "beam"))}
        made["of a stiffness"] = {**plain, "beam.length": "1 m", "beam.bending_stiffness": "1 N m2"}
    return made


ALL = [*rotors(), *screens(), *mechanisms(), *commands(), *named(), *sketches()]


@cache
def drawn(draw):
    """Return the rows that each of the tests below looks at, computed once."""
    return draw()


def extents(figure):
    """Texts of a figure with the boxes in which matplotlib draws them, by axes [pt]."""
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(100)
    canvas.draw()
    renderer = canvas.get_renderer()
    for ax in figure.axes:
        texts = [text for text in (*ax.texts, ax.title) if text.get_text()]
        boxes = [text.get_window_extent(renderer).extents * 72 / 100 for text in texts]
        frame = ax.get_window_extent(renderer).extents * 72 / 100
        yield [text.get_text() for text in texts], np.array(boxes).reshape(-1, 4), frame


def check_texts(figure):
    """No two texts overlap and none leaves its axes, by the boxes that matplotlib's own renderer draws."""
    for words, boxes, (left, low, right, high) in extents(figure):
        for (one, a), (other, b) in combinations(zip(words, boxes, strict=True), 2):
            across, up = np.minimum(a[2:], b[2:]) - np.maximum(a[:2], b[:2])
            assert across < TOUCHING or up < TOUCHING, (one, other)
        for word, box in zip(words, boxes, strict=True):
            assert (box[:2] > (left - TOUCHING, low - TOUCHING)).all(), word
            assert (box[2:] < (right + TOUCHING, high + TOUCHING)).all(), word


@pytest.mark.parametrize("draw", ALL)
def test_no_two_texts_overlap_and_none_leaves_the_frame(draw):
    check_texts(figure_of(drawn(draw)))


@pytest.mark.parametrize("at", [(0.5, 0.5), (1.0, 0.2)])
def test_the_check_finds_a_text_on_another_and_one_that_leaves(at):
    ax = Figure(figsize=(4, 3)).add_axes((0.0, 0.0, 1.0, 1.0))
    ax.text(0.5, 0.5, "a label")
    check_texts(ax.figure)
    ax.text(*at, "another")
    with pytest.raises(AssertionError):
        check_texts(ax.figure)


@pytest.mark.parametrize("draw", ALL)
def test_no_label_covers_the_end_of_an_arrow_or_a_line(draw):
    rows = drawn(draw)
    for layout in lay_out(rows, Paper.of(rows)):
        arrows = [shape for shape in layout.drawing.shapes if isinstance(shape, Arrow)]
        for at in layout.fit.to_paper(np.reshape([(a.foot, a.tip) for a in arrows], (-1, 2))):
            for text in layout.texts:
                left, top, right, bottom = text.box
                assert not (left < at[0] < right and top < at[1] < bottom), (text.lines, at)


@pytest.mark.parametrize("draw", ALL)
def test_svg_has_every_text_at_the_width_that_was_measured(draw):
    rows = drawn(draw)
    root = ET.fromstring(svg_of(rows))
    assert root.get("role") == "img" and root.find(f"{SVG}title").text and root.find(f"{SVG}desc").text
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    written = sorted("".join(text.itertext()).replace("\u200b", "") for text in root.iter(f"{SVG}text"))
    expected = [
        f"{text.symbol.replace('_', '')} {line}".strip() if i == 0 else line
        for layout in lay_out(rows, Paper.of(rows))
        for text in layout.texts
        for i, line in enumerate(text.lines)
    ]
    assert written == sorted(expected)


def test_the_key_has_used_entries_alone():
    key = {"load": "a load", "reaction": "a reaction"}
    drawing = Drawing([Arrow((0, 0), (1, 1), "load")], key=key)
    assert drawing.legend == {"load": "a load"}
    layout = arrange(drawing, (0.0, 0.0, 300.0, 300.0))
    assert "a load" in [text.lines[0] for text in layout.texts]
    assert "a reaction" not in [text.lines[0] for text in layout.texts]


# Places of labels -----------------------------------------------------------------------------------------


def crowd(count, seed, room=600.0, size=(60.0, 12.0)):
    draw = np.random.default_rng(seed)
    ends = draw.uniform(40, room - 40, (120, 4))
    requests = [LabelRequest(size, end[None, 2:], tuple(end[2:] - end[:2])) for end in ends[:count]]
    return requests, Obstacles((0.0, 0.0, room, room), ends, ends[:, 2:])


@pytest.mark.parametrize("seed", range(5))
def test_labels_of_a_crowd_are_free_and_the_same_again(seed):
    requests, obstacles = crowd(40, seed)
    places = place_labels(requests, obstacles)
    assert None not in places
    half = np.array(requests[0].size) / 2
    centres = np.array([place.centre for place in places])
    for one, other in combinations(centres, 2):
        assert (np.abs(one - other) >= 2 * half - 1e-9).any()
    assert (centres - half >= 0).all() and (centres + half <= 600).all()
    for at in obstacles.points:
        assert (np.abs(centres - at) > half).any(axis=1).all()
    again = np.array([place.centre for place in place_labels(*crowd(40, seed))])
    np.testing.assert_array_equal(again, centres)


def test_a_label_for_which_there_is_no_room_has_no_place():
    requests, obstacles = crowd(6, 1, room=110.0)
    assert None in place_labels(requests, obstacles)


def test_what_has_no_place_is_numbered_and_listed():
    labels = [Label(f"a long name of part number {i}", (0.5, 0.5)) for i in range(12)]
    drawing = Drawing([Disc((0.5, 0.5), 0.5, "body")], labels)
    layout = arrange(drawing, (0.0, 0.0, 260.0, 220.0))
    assert layout.numbered
    written = " ".join(line for text in layout.texts for line in text.lines)
    for i, said in enumerate(layout.numbered, 1):
        assert f"({i}) {said}" in written
    boxes = [text.box for text in layout.texts]
    for a, b in combinations(boxes, 2):
        assert (np.minimum(a[2:], b[2:]) - np.maximum(a[:2], b[:2]) < 1e-6).any()


def test_a_label_that_stands_far_away_has_a_line_to_its_point():
    points = np.full((9, 1, 2), 0.5)
    drawing = Drawing(
        [Outline([(0, 0), (1, 1)], "body")], [Label(f"name {i}", p) for i, p in enumerate(points)]
    )
    layout = arrange(drawing, (0.0, 0.0, 400.0, 400.0))
    at = layout.fit.to_paper((0.5, 0.5))
    led = [rule for rule in layout.rules if rule.role == "axis"]
    assert led and all(np.allclose(rule.ends[1], at) for rule in led)


# Texts ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("text", ["left arm", "239.2 N", "φ = 45°", "Träger, Öse", "WWW iii", "1.5 kN (pin)"])
@pytest.mark.parametrize("size", [9.0, 11.0])
def test_measured_width_is_that_of_matplotlib(text, size):
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    path = TextPath((0, 0), text, size=size, prop=FontProperties(family="DejaVu Sans"))
    drawn = path.get_extents().width
    assert drawn <= HINTED * text_size(text, size)[0]
    assert drawn > 0.85 * text_size(text, size)[0]  # bearings and kerning


def test_wrapped_lines_fit():
    text = "a title of many words, " * 9 + "anunbrokenwordthatiswiderthanthewholeframe" * 3
    lines = wrapped(text, 200.0, 9.0)
    assert max(text_size(line, 9.0)[0] for line in lines) <= 200.0
    assert lines[-1].endswith("…")


@pytest.mark.parametrize("name", ["<script>alert(1)</script>", 'a" onload="x', "&amp; ]]>", "$x$ \\frac"])
def test_a_name_is_a_text_and_nothing_else(name):
    drawing = Drawing(
        [Disc((0, 0), 1.0, "body")], [Label(name, (0, 0))], title=name, words=name, points={name: (0, 1)}
    )
    text = svg_of([[drawing]])
    root = ET.fromstring(text)
    tags = {element.tag.removeprefix(SVG) for element in root.iter()}
    assert tags <= {
        "svg",
        "title",
        "desc",
        "style",
        "rect",
        "clipPath",
        "g",
        "path",
        "circle",
        "text",
        "tspan",
    }
    assert not any(key.startswith("on") for element in root.iter() for key in element.attrib)
    assert name in ["".join(text.itertext()) for text in root.iter(f"{SVG}text")]
    (words, _, _), *_ = extents(figure_of([[drawing]]))
    assert any(name.replace("$", r"\$") == word for word in words)


def test_every_role_has_a_colour_on_light_and_on_dark_that_can_be_read():
    """Contrast of letters against the obstacles, by the formula of WCAG 2: at least 3, of text at least 7."""

    def luminance(colour):
        parts = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
        linear = np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
        return float(linear @ (0.2126, 0.7152, 0.0722))

    def contrast(one, other):
        high, low = sorted((luminance(one), luminance(other)), reverse=True)
        return (high + 0.05) / (low + 0.05)

    paper = INKS["paper"]
    for role in INKS.keys() - {"paper"}:
        ink = INKS[role]
        least = 1.4 if role == "ghost" else 7 if role == "text" else 2.9
        assert contrast(ink.line, paper.area) >= least, role
        assert contrast(ink.dark_line, paper.dark_area) >= least, role
        assert f"--{role}:" in page_colours(":root") and f"--{role}:" in page_colours(":root", dark=True)


def test_paper_and_machine_are_inverse():
    fit = Fit.of(np.array([-1.0, 2.0]), np.array([3.0, 4.0]), (0.0, 0.0, 400.0, 300.0), 20.0)
    points = np.array([(-1.0, 2.0), (0.3, 3.1)])
    np.testing.assert_allclose(fit.from_paper(fit.to_paper(points)), points, rtol=1e-13)
    assert (fit.to_paper(points[0])[1]) > fit.to_paper(points[1])[1]  # up is up


# The rotor ------------------------------------------------------------------------------------------------


def rotor(**mount):
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(0.001, offset=0.002))
    return bd.draw(bd.Scene(beam, bd.Mount(radius=0.2, **mount)))


@pytest.mark.parametrize(
    "phi, tip",
    [(0.0, (0.15, 0.0)), (np.pi / 2, (0.2, 0.05)), (np.pi, (0.25, 0.0)), (-np.pi / 2, (0.2, -0.05))],
)
def test_the_beam_points_where_the_conventions_have_it(phi, tip):
    """0 inward, 90 deg against the motion of the root, 180 deg outward, -90 deg with it: there, down."""
    made = rotor(setting_angle=phi)
    ends = made.outline.reshape(2, -1, 2)
    middle = (ends[0, -1] + ends[1, 0]) / 2
    np.testing.assert_allclose(middle, tip, rtol=0, atol=1e-15)


def test_the_drawn_depth_is_the_section_times_the_stated_magnification():
    flat, edge = rotor(setting_angle=np.pi), rotor(setting_angle=np.pi, bending_angle=np.pi / 2)
    for made, side in ((flat, 0.0002), (edge, 0.01)):
        depth = np.ptp(made.outline[:, 1])
        assert depth == pytest.approx(made.magnification * side, rel=1e-12)
        assert depth > 0.03 * 0.05 - 1e-12
    assert edge.magnification == 1.0
    np.testing.assert_allclose(np.ptp(flat.section, axis=0), (0.0002, 0.01), rtol=1e-12)
    np.testing.assert_allclose(np.ptp(edge.section, axis=0), (0.01, 0.0002), rtol=1e-12)


def test_a_short_beam_is_also_drawn_by_itself_to_a_larger_scale():
    assert len(rotor().drawings()) == 2  # 0.2 m from the axis
    beam = bd.Beam.rectangular(0.03, 0.01, 2e-4, 200e9, 7850.0)
    made = bd.draw(bd.Scene(beam, bd.Mount(radius=1.0, setting_angle=0.6)))
    rows = made.drawings()
    plan, alone, _ = lay_out(rows, Paper.of(rows))
    assert alone.fit.scale > 5 * plan.fit.scale
    edges = [next(s.points for s in d.shapes if isinstance(s, Outline) and s.role == "beam")
             for d in (plan.drawing, alone.drawing)]  # fmt: skip
    assert np.array_equal(*edges)


def test_the_edge_of_a_rotor_as_csv_says_how_much_it_is_magnified():
    made = rotor()
    head, *rows = rotor_csv(made)
    assert head == ["x_m", "y_m", "depth_magnification"]
    assert np.array_equal(np.array(rows)[:, :2], made.outline)
    assert {row[2] for row in rows} == {made.magnification}


def test_labels_follow_what_moves_as_long_as_they_are_free():
    def cross(x):
        signs = [Symbol("dot", at, "axis") for at in ((0, 0), (x, 0), (9, 9))]
        return Drawing(signs, [Label("here", (x, 0), "axis", (1.0, 0.0))], unit="m")

    frame = (0.0, 0.0, 400.0, 400.0)
    first = arrange(cross(3.0), frame)
    step = 20.0 / first.fit.scale  # whole cells of the grid, which tells what is free
    moved = follow(cross(3.0 + step), frame, first)
    shift = [m.centre - f.centre for m, f in zip(moved.texts[:1], first.texts[:1], strict=True)]
    assert shift == [pytest.approx(np.array([20.0, 0.0]), abs=1e-9)]
    assert moved.fit == first.fit
    covered = follow(cross(8.9), frame, first)  # where it would leave the frame or cover a sign
    (left, top), (right, bottom) = covered.texts[0].box.reshape(2, 2)
    assert frame[0] <= left and right <= frame[2] and frame[1] <= top and bottom <= frame[3]


def test_a_forklift_that_does_not_stop_is_marked():
    from brakes.answers.forklift import FORKLIFT
    from brakes.config.forklift import parse_forklift

    text = (ROOT / "examples" / "forklift.toml").read_text(encoding="utf-8")
    marked = {}
    for slope in ("0.02 rad", "0.55 rad"):
        design = parse_forklift(text.replace('"0.3019 rad"', f'"{slope}"'))
        made = truck(FORKLIFT.solve(design).stop)
        said = any(label.text == "does not stop" for label in made.labels)
        assert said == ("does not stop" in made.arrows)
        marked[slope] = said
    assert marked == {"0.02 rad": False, "0.55 rad": True}


def test_a_drawn_rotor_is_saved_and_loaded(tmp_path):
    made = rotor(setting_angle=0.5)
    made.save(tmp_path / "rotor.json")
    again = bd.load(tmp_path / "rotor.json")
    np.testing.assert_array_equal(again.outline, made.outline)
    assert again.svg() == made.svg()


def test_layers_are_drawn_with_the_strip():
    made = bd.draw(bd.load_scene("examples/bimorph.toml"))
    assert made.section_known and made.warnings == ()
    assert np.ptp(made.section[:, 0]) == pytest.approx(0.2e-3 + 2 * 0.15e-3, rel=1e-12)


def test_no_note_on_the_answer_stands_below_an_undeformed_rotor():
    assert not notes_of(bd.draw(bd.load_scene("examples/harvester_oblique.toml")))


def test_a_jump_of_thickness_is_drawn_as_a_step():
    thickness = bd.Table((0.0, 0.4, 0.4, 1.0), (5e-4, 5e-4, 2.5e-4, 2.5e-4))
    beam = bd.Beam.rectangular(0.06, 0.01, thickness, youngs_modulus=200e9, density=7850.0)
    above, _ = bd.draw(bd.Scene(beam, bd.Mount(0.2, np.pi))).outline.reshape(2, -1, 2)
    along = np.abs(above[:, 0] - above[0, 0])
    heights = np.abs(above[np.abs(along - 0.4 * 0.06) < 1e-9, 1])
    assert len(heights) == 2
    np.testing.assert_allclose(heights[0] / heights[1], 2.0, rtol=1e-9)  # rounding of polynomials


# Labels and signs -----------------------------------------------------------------------------------------


def signs_of(layout):
    """Boxes around the signs of a drawing on paper: left, top, right, bottom."""
    for shape in layout.drawing.shapes:
        if isinstance(shape, Symbol):
            x, y = layout.fit.to_paper(shape.at)
            half = 0.35 * shape.size  # their corners are empty
            low = 0.8 * shape.size if shape.kind == "ground" else half
            yield np.array([x - half, y - half, x + half, y + low])


@pytest.mark.parametrize("draw", ALL)
def test_on_the_page_no_text_covers_another_or_a_sign_and_none_leaves_the_frame(draw):
    """In the places that the layout gives, which the page and SVG files state."""
    rows = drawn(draw)
    for layout in lay_out(rows, Paper.of(rows)):
        left, top, right, bottom = layout.frame
        signs = list(signs_of(layout))
        for text in layout.texts:
            assert left <= text.box[0] and text.box[2] <= right, text.lines
            assert top <= text.box[1] and text.box[3] <= bottom, text.lines
            for sign in signs:
                gap = np.minimum(text.box[2:], sign[2:]) - np.maximum(text.box[:2], sign[:2])
                assert (gap <= 0).any(), (text.lines, sign)
        for one, other in combinations(layout.texts, 2):
            gap = np.minimum(one.box[2:], other.box[2:]) - np.maximum(one.box[:2], other.box[:2])
            assert (gap < 1e-6).any(), (one.lines, other.lines)


def test_a_label_stands_beside_a_ground_sign_not_on_it():
    """Where there is room all around, whatever direction it should have."""
    for towards in [(0.0, -1.0), (1.0, -1.0), (-1.0, -0.3), (0.4, -1.0)]:
        drawing = Drawing(
            [Symbol("ground", (0.0, 0.0), "ground", 14.0), Outline([(-1, -1), (1, 1)], "ghost", 0.0)],
            [Label("163 N", (0.0, 0.0), "reaction", towards)],
        )
        layout = arrange(drawing, (0.0, 0.0, 400.0, 400.0))
        (text,) = [text for text in layout.texts if text.lines == ("163 N",)]
        (sign,) = signs_of(layout)
        gap = np.minimum(text.box[2:], sign[2:]) - np.maximum(text.box[:2], sign[:2])
        assert (gap <= 0).any(), towards


def test_a_detail_has_a_scale_of_its_own_and_less_of_the_width():
    def line(length, own_scale=False):
        return Drawing([Outline([(0, 0), (length, length)], "axis")], own_scale=own_scale)

    def scales(*row):
        return [layout.fit.scale for layout in lay_out([row], Paper.of([row]))]

    one, other = scales(line(1.0), line(0.01))
    assert one == other
    one, detail = scales(line(1.0), line(0.01, own_scale=True))
    assert detail > 50 * one
    (left, _, end, _), (start, _, right, _) = (
        layout.frame for layout in lay_out([[line(1.0), line(1.0, own_scale=True)]], Paper(680.0, (400.0,)))
    )
    assert left == 0 and end == start and right == 680.0
    assert right - start < end - left
