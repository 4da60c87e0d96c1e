"""The beam's screens as pure functions: what they show is what the package's functions find."""

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from beamdyn import critical_speed, natural_modes, resonance_speeds, simulate
from beamdyn.app.frequency_screen import FREQUENCIES
from beamdyn.app.mode_shapes import MODE_SHAPES
from beamdyn.app.program import SCENE
from beamdyn.app.rotor_screen import ROTOR
from beamdyn.app.scene_form import COARSE
from beamdyn.app.scene_screen import bar, left_out_table
from beamdyn.app.steady_state import STEADY_STATE, stretches
from beamdyn.app.trade import TRADE
from beamdyn.app.transient_screen import TRANSIENT
from beamdyn.common.drawing.shapes import Outline
from beamdyn.common.edge.file_words import in_files, on_form
from beamdyn.common.edge.rendering import html
from beamdyn.common.screens.chart_options import options_of, thinned
from beamdyn.common.screens.form_entries import heading_of, tables_of
from beamdyn.common.screens.handles import draw_sheet
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.words import Setting, Words

pytestmark = pytest.mark.filterwarnings("ignore::beamdyn.common.results.statements.OutsideLinearTheory")
SHORT = {"run.end": "2 s", "motion.rotation.duration": "1 s"}


def opened(**more):
    work = OpenDocument(SCENE)
    for path, text in more.items():
        work.put(path, text)
    return work


def solved(screen, **more):
    work = opened(**more)
    assert work.solve(screen), work.mistakes
    return work.answered[screen.name].answer


@pytest.mark.parametrize(
    "screen, path, text, said",
    [
        (TRANSIENT, "mount.root_stiffness", "0 N m/rad", "past the critical speed"),
        (TRANSIENT, "model.gravity", "1e300 m/s2", 'model.gravity = "1e300 m/s2": give at most'),
        (STEADY_STATE, "damping.stiffness_factor", "1e300 s", "damping.stiffness_factor = "),
        (STEADY_STATE, "motion.road.velocity_amplitude", "1e20 m/s", "excitation is too strong"),
        (TRANSIENT, "motion.rolling_radius", "1e9 m", 'run.end = "12 s": it takes about'),
        (FREQUENCIES, "damping.mass_factor", "1e300 1/s", "damping.mass_factor = "),
    ],
)
def test_numbers_out_of_range_are_refused_in_the_words_of_a_user(screen, path, text, said):
    """Of a hinge it was "float division by zero", of gravity "negative dimensions are not allowed"."""
    work = opened(**{path: text})
    assert not work.solve(screen)
    assert said in str(work.mistakes[screen.name])


@pytest.mark.parametrize("screen", [s for s in SCENE.screens if s.charts], ids=lambda s: s.name)
def test_charts_are_data_that_a_page_can_be_sent(screen):
    for chart in screen.charts(solved(screen, **SHORT), screen.last):
        assert json.dumps(options_of(chart))


def coarse(screen, **more):
    work = opened(**more)
    return screen.solve(screen.coarser(tables_of(work.needed(screen), work.inputs, screen.needs)))


def scene_of(**more):
    work = opened(**more)
    return SCENE.check(work.text(), "mine")


def curve(chart, name):
    return next(c for c in chart.curves if c.name == name)


def refusal(screen, path, text, **more):
    work = opened(**(more | {path: text}))
    assert not work.solve(screen)
    ((where, said),) = work.mistakes[screen.name].items()
    assert where == path
    return said[0]


# Frequencies --------------------------------------------------------------------------------------------


def test_frequencies_mark_resonances_margins_and_critical_speed():
    answer = solved(FREQUENCIES, **{"options.top_speed": "170 rad/s"})
    (chart,) = FREQUENCIES.charts(answer, 0.0)
    found = {p.name: p.at for p in chart.points}
    expected = resonance_speeds(scene_of(), 170.0, 2)
    assert [at[:2] for at in found["resonance"]] == [(c.speed, c.frequency) for c in expected]
    (mark, motion) = chart.marks
    assert mark.at == pytest.approx(critical_speed(scene_of()), rel=1e-9)  # both by the same equations
    assert motion.at == 55.0
    assert (chart.bands[0].low, chart.bands[0].high) == (mark.at, 170.0)
    near = min(answer.margins, key=lambda m: m.mode)
    frequency = natural_modes(scene_of(), 55.0, 2).frequency[0]
    excited = max(line.multiple for line in answer.lines) * 55.0 / (2 * np.pi)
    assert near.margin == pytest.approx(excited / frequency - 1, rel=1e-6)  # of a difference of a twentieth
    assert "4.08 % above its frequency" in html(FREQUENCIES.tables(answer))


def test_coarse_frequencies_lie_on_those_in_full():
    """While something is dragged: within what is seen of a chart, 1e-3 of its height."""
    full, quick = solved(FREQUENCIES), coarse(FREQUENCIES)
    assert len(quick.locus.speeds) < len(full.locus.speeds) / 3
    for mode in range(2):
        fine = np.interp(quick.locus.speeds, full.locus.speeds, full.locus.frequency[:, mode])
        assert np.allclose(quick.locus.frequency[:, mode], fine, rtol=1e-3)
    forced = sorted(m[0] for m in full.crossing_points if "forced" in m[2])
    assert sorted(m[0] for m in quick.crossing_points) == pytest.approx(forced, rel=1e-3)
    (chart,) = FREQUENCIES.charts(quick, 0.0)
    assert [c.name for c in chart.curves] == [c.name for c in FREQUENCIES.charts(full, 0.0)[0].curves]


def test_frequencies_without_motion_have_no_lines():
    work = OpenDocument(SCENE)
    work.open("\n".join(SCENE.base.partition("[motion]")[:1]), "scene")
    assert work.solve(FREQUENCIES), work.mistakes
    answer = work.answered[FREQUENCIES.name].answer
    (chart,) = FREQUENCIES.charts(answer, 0.0)
    assert not chart.points and [c.name for c in chart.curves] == ["mode 1", "mode 2"]


# Rotor --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("angle", ["0 deg", "40 deg", "90 deg", "180 deg"])
def test_points_of_the_rotor_write_what_they_stand_for(angle):
    answer = solved(ROTOR, **{"mount.setting_angle": angle})
    radius, tip, middle = ROTOR.handles(answer, 0.0)
    assert radius.moved(*radius.at) == {"mount.radius": pytest.approx(0.215)}
    (phi,) = tip.moved(*tip.at).values()
    assert phi == pytest.approx(np.radians(float(angle.split()[0])), abs=1e-12)
    (length,) = middle.moved(*middle.at).values()
    assert length == pytest.approx(0.05, rel=1e-12)
    outline = answer.outline.reshape(2, -1, 2)
    ends = (outline[0] + outline[1][::-1]) / 2  # the beam's axis, from root to tip
    assert np.allclose(tip.at, ends[-1], atol=1e-12)
    assert np.allclose(middle.at, (ends[0] + ends[-1]) / 2, atol=1e-12)


def test_radius_cannot_be_dragged_past_the_axis():
    radius = ROTOR.handles(solved(ROTOR), 0.0)[0]
    assert radius.moved(-0.1, 0.3) == {"mount.radius": 0.0}


# Mode shapes --------------------------------------------------------------------------------------------


def beam_of(drawing):
    """The axis of the beam as drawn, shape (n, 2)."""
    (edge,) = (s for s in drawing.shapes if isinstance(s, Outline) and s.role == "beam")
    there, back = np.asarray(edge.points).reshape(2, -1, 2)
    return (there + back[::-1]) / 2


def test_mode_shapes_swing_through_rest():
    answer = solved(MODE_SHAPES)
    ((one, _),), ((rest, _),), ((other, _),) = (MODE_SHAPES.drawings(answer, p) for p in (0.0, 1.0, 2.0))
    assert np.allclose(beam_of(rest)[:, 1], 0)
    assert np.allclose(beam_of(one)[:, 1], -beam_of(other)[:, 1])
    x, y = beam_of(one).T
    shape = natural_modes(scene_of(), 100.0, 2).shape(x)[0].real
    assert np.allclose(y / y[-1], shape / shape[-1], rtol=1e-6, atol=1e-9)  # the same shape, to another scale


def test_mode_shapes_of_two_planes_say_in_which_they_are_drawn():
    more = {"physics.planes": "2", "options.modes": "4"}
    rows = MODE_SHAPES.drawings(solved(MODE_SHAPES, **more), 0.0)
    assert [len(row) for row in rows] == [2, 2]
    assert all("drawn in" in drawing.title for row in rows for drawing in row)


STRIP = {"physics.torsion": "true", "physics.camber": "true", "beam.poissons_ratio": "0.3"}


def mesh_of(drawing):
    """The lines of a strip as drawn: those along, and the sections, each shape (n, 2)."""
    (mesh,) = (np.asarray(s.points) for s in drawing.shapes if isinstance(s, Outline) and s.role == "beam")
    lines = np.split(mesh, np.flatnonzero(np.isnan(mesh[:, 0])))
    return [line[np.isfinite(line[:, 0])] for line in lines if len(line) > 1]


def test_mode_shapes_of_a_strip_are_meshes_that_swing_through_rest():
    answer = solved(MODE_SHAPES, **STRIP, **{"options.modes": "3"})
    one, rest, other = (MODE_SHAPES.drawings(answer, p)[1][0] for p in (0.0, 1.0, 2.0))
    assert one.title.endswith("torsion")
    for there, still, back in zip(*map(mesh_of, (one, rest, other)), strict=True):
        np.testing.assert_allclose(there - still, still - back, rtol=0, atol=1e-15)
    *_, tip = mesh_of(one)
    *_, tip_at_rest = mesh_of(rest)
    twisted = (tip - tip_at_rest)[:, 1]
    surface = answer.surface([0.05], np.linspace(1, -1, len(tip)))[2, 0]
    np.testing.assert_allclose(twisted / twisted[0], surface / surface[0], rtol=0, atol=1e-9)
    assert np.abs(twisted).max() == pytest.approx(0.12 * 0.05)


# Steady response ----------------------------------------------------------------------------------------


def test_steady_response_is_grey_where_it_does_not_hold():
    answer = solved(STEADY_STATE, **{"options.top_speed": "180 rad/s"})
    said = stretches(answer)
    large = answer.amplitude > 0.1 * 0.05
    assert set(said[large & answer.stable]) == {"deflection past 0.1 of the length: not linear"}
    assert set(said[~answer.stable]) == set(answer.status[~answer.stable])
    assert "past the critical speed" in said
    (chart,) = STEADY_STATE.charts(answer, 0.0)
    size = curve(chart, "largest deflection").y
    assert np.array_equal(np.isfinite(size), said == "")
    for band in chart.bands:
        inside = (answer.speeds > band.low) & (answer.speeds < band.high)
        assert inside.any() and set(said[inside]) == {band.text}
    in_bands = sum(((answer.speeds >= b.low) & (answer.speeds <= b.high)).sum() for b in chart.bands)
    assert in_bands == (said != "").sum()


# Transient ----------------------------------------------------------------------------------------------


def test_transient_plays_what_simulate_finds():
    answer = solved(TRANSIENT, **SHORT)
    run = simulate(scene_of(**SHORT), 2.0, tolerance=1e-4)
    whole, close = TRANSIENT.charts(answer, 0.5)
    assert (whole.cursor, close.cursor) == (1.0, 1.0)
    tip = curve(close, "tip deflection")
    assert np.allclose(tip.y, 1e3 * run.deflection(tip.x), rtol=1e-9, atol=1e-12)  # [mm]
    ((peak,),) = (p.at for p in whole.points)
    assert abs(peak[1]) == pytest.approx(1e3 * run.peak(0.0, 2.0), rel=1e-4)  # of 201 times beside it
    ((drawing,),) = TRANSIENT.drawings(answer, 0.5)
    x, y = beam_of(drawing).T
    shape = run.shape(x, [1.0])[0]
    assert np.allclose(y / y[-1], shape / shape[-1], rtol=1e-6, atol=1e-6)


def test_every_period_of_a_run_is_seen_when_its_chart_is_zoomed():
    answer = solved(TRANSIENT)
    whole, _ = TRANSIENT.charts(answer, 0.5)
    x, y = thinned(whole.curves[0].x, whole.curves[0].y, whole.curves[0].most)
    late = answer.run.t > 9.0  # where it vibrates with its first frequency
    turns = np.count_nonzero(np.diff(np.sign(answer.run.tip[late])))
    assert np.count_nonzero(np.diff(np.sign(y[x > 9.0]))) == pytest.approx(turns, rel=0.01)


def test_transient_marks_the_passage_of_a_resonance():
    answer = solved(TRANSIENT, **SHORT)
    scene = scene_of(**SHORT)
    speeds = [c.speed for c in resonance_speeds(scene, 55.0, 3)]
    passed = np.abs(scene.motion.at(np.array([t for t, _ in answer.passages])).speed)
    assert passed == pytest.approx(speeds, rel=1e-5)  # straight between 4001 times
    assert len(TRANSIENT.charts(answer, 0.0)[0].marks) == len(speeds) == 1


def test_window_of_the_peak_is_that_which_is_given():
    answer = solved(TRANSIENT, **SHORT, **{"run.window_start": "0.1 s", "run.window_end": "0.4 s"})
    assert answer.peak == answer.run.peak(0.1, 0.4)
    assert 0.1 <= answer.peak_at <= 0.4
    bands = TRANSIENT.charts(answer, 0.0)[0].bands
    assert [(b.low, b.high) for b in bands] == [(0.0, 0.1), (0.4, 2.0)]


@pytest.mark.parametrize(
    "path, text, sentence",
    [
        ("run.end", "1e9 s", "20000 periods"),
        ("run.end", "0 s", "greater than 0"),
        ("run.window_start", "3 s", "before the end"),
        ("run.window_end", "3 s", "after the end of the run"),
    ],
)
def test_run_that_cannot_be_is_refused_at_its_field(path, text, sentence):
    assert sentence in refusal(TRANSIENT, path, text, **SHORT)


# Trade --------------------------------------------------------------------------------------------------


def test_cheapest_model_keeps_the_digits_and_nothing_cheaper_does():
    answer = solved(TRADE)
    assert answer.tolerance == 1e-3
    assert (answer.modes.error <= 1e-3).all()
    assert answer.modes.speed == 100.0
    known = natural_modes(scene_of(), 100.0, 2)
    assert np.allclose(answer.modes.frequency, known.frequency, rtol=1e-3)
    cheapest = answer.cheapest(answer.numerical)
    measured = answer.numerical.measurements
    (own,) = [
        m
        for m in measured
        if (m.family, m.setting, m.time) == (cheapest.family, cheapest.setting, cheapest.time)
    ]
    assert own.error <= 1e-3
    assert all(m.error > 1e-3 for m in measured if m.time < own.time)


def test_digits_that_the_physics_does_not_have_are_said_to_be_missing():
    answer = solved(TRADE, **{"trade.digits": "9"})
    said = html(TRADE.tables(answer))
    assert "the model error exceeds the tolerance" in said
    (numbers, _) = TRADE.charts(answer, 0.0)
    assert curve(numbers, "tolerance 1e-09").y.tolist() == [1e-9, 1e-9]
    assert curve(numbers, "chosen by tolerance").points  # not as it is called in Python


def test_measurements_are_made_once_for_all_digits():
    first, second = solved(TRADE, **{"trade.digits": "2"}), solved(TRADE, **{"trade.digits": "4"})
    assert first.numerical is second.numerical


@pytest.mark.parametrize("screen", [TRADE, TRANSIENT], ids=lambda s: s.name)
def test_what_follows_a_slider_has_the_charts_of_the_whole_answer(screen):
    work = opened(**SHORT)
    whole, rough = work.attempt(screen), work.attempt(screen, for_drawing=True)
    assert rough.is_rough and not rough.is_whole and whole.is_whole and not whole.is_rough
    charts = [screen.charts(each.answer, 0.0) for each in (whole, rough)]
    assert len(charts[0]) == len(charts[1]) > 1
    assert all(options_of(chart) for chart in charts[1])
    assert [each.words for each in rough.headline] == [each.words for each in whole.headline]
    if screen is TRANSIENT:
        assert rough.answer.peak == pytest.approx(whole.answer.peak, rel=1e-2)  # its tolerance


def test_what_a_coarse_solution_cannot_answer_is_answered_whole():
    def solve(tables):
        if COARSE in tables:
            raise ValueError("too coarse")
        return FREQUENCIES.solve(tables)

    found = opened().attempt(replace(FREQUENCIES, solve=solve), for_drawing=True)
    assert found.is_whole and found.tables


# What the physics leaves out ----------------------------------------------------------------------------


@pytest.mark.parametrize("change, length", [(0.0, 0), (1e-7, 0), (-1e-5, 3), (1e-3, 9), (0.1, 15), (1e9, 21)])
def test_bar_is_as_long_as_the_decades_of_a_change(change, length):
    assert len(bar(change)) == length


def test_table_of_what_is_left_out_has_the_largest_first():
    effects = natural_modes(scene_of(), 100.0, 2).left_out_effects
    made = left_out_table(effects, "frequencies")
    written = html([made])
    by_place = sorted(effects.changes, key=lambda name: written.index(f'<td class="words">{name}<'))
    sizes = [np.abs(effects.changes[name]).max() for name in by_place]
    assert sizes == sorted(sizes, reverse=True)
    assert all(name in written for name in effects.not_modelled)


# On the page --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("screen", [ROTOR, MODE_SHAPES, TRANSIENT], ids=lambda s: s.name)
def test_moving_drawing_keeps_its_place(screen):
    answer = solved(screen, **SHORT)
    view = draw_sheet(screen, answer, screen.last).view
    held = draw_sheet(screen, answer, 0.0, view).view
    assert np.allclose(view.point((1.0, 1.0)), held.point((1.0, 1.0)))
    assert np.allclose(view.point((0.0, 0.0)), held.point((0.0, 0.0)))


@pytest.mark.parametrize(
    "screen, path, text, words",
    [
        (FREQUENCIES, "options.top_speed", "1400 rpm", ("at 1400 rpm", "1526 rpm")),
        (STEADY_STATE, "options.top_speed", "1400 rpm", ("rpm",)),
        (TRANSIENT, "beam.length", "5 cm", ("cm",)),
    ],
    ids=["frequencies", "steady", "transient"],
)
def test_results_are_shown_in_the_unit_that_is_typed(screen, path, text, words):
    work = OpenDocument(SCENE)
    work.put(path, text)
    assert work.solve(screen), work.mistakes
    answer = work.answered[screen.name].answer
    said = " ".join(part for result in screen.headline(answer) for part in result)
    assert all(word in said for word in words) and "rad/s" not in said
    unit = text.split()[1]
    assert any(unit in (chart.x.unit, chart.y.unit) for chart in screen.charts(answer, screen.last))


def test_a_deflection_past_linear_theory_does_not_stand_first_without_saying_so():
    words = []
    for top in ("40 rad/s", "60 rad/s"):  # below and past a resonance
        work = OpenDocument(SCENE)
        work.put("options.top_speed", top)
        assert work.solve(STEADY_STATE), work.mistakes
        words.append(next(STEADY_STATE.headline(work.answered[STEADY_STATE.name].answer)).words)
    assert words == ["largest deflection of the tip", "largest deflection of the tip, past linear theory"]


def test_warnings_name_inputs_as_the_form_does():
    said = Words("shear, left out, matters; ", Setting("physics", rotary_inertia=True), " includes it")
    damped = Setting("model", damping_ratio=0)
    with on_form(partial(heading_of, headings=SCENE.headings)):
        assert in_files(said).endswith("; Physics: rotary inertia = true includes it")
        assert in_files(damped) == "Gravity and damping ratio: damping ratio = 0"
    assert in_files(damped) == "[model] damping_ratio = 0"
