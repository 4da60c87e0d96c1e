"""Campbell diagrams: crossings are roots, margins, several scenes, the picture, the command, bad input."""

from __future__ import annotations

import csv
import json
import math
import pickle
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, DONE
from beamdyn.common.plots.campbell import Curves, plot_campbell
from beamdyn.equations.effects import words_of_directions
from beamdyn.modes.modal.line_roots import find_roots
from benchmarks.cases.scenes import HARVESTER
from benchmarks.cases.uniform_blade import UNIFORM_BLADE

ROOT = Path(__file__).parents[2]
BLADE = ROOT / "examples" / "blade.toml"
ROLLING = ROOT / "examples" / "rolling_harvester.toml"
SPEEDS = np.linspace(0.0, 12.0, 121)

# Bir, AIAA 2009-1035, Table 3a (after Wright et al. 1982): first two flap frequencies [rad/s] of a uniform
# blade without hub whose EI / (rho A L^4) is 1 s^-2, at 0, 1, ... 12 rad/s.
BIR_FLAP_1 = (3.516, 3.682, 4.137, 4.797, 5.585, 6.450, 7.360, 8.300, 9.257, 10.226, 11.202, 12.184, 13.170)
BIR_FLAP_2 = (
    22.035,
    22.181,
    22.615,
    23.320,
    24.273,
    25.446,
    26.809,
    28.334,
    29.995,
    31.771,
    33.640,
    35.589,
    37.603,
)

# Two planes that nothing couples: flap rises past the edge, which is stiffer but rises less.
STRIP = bd.Beam.from_stiffness(10.0, 100.0, 1e6, second_bending_stiffness=1.6e6)
TWO_PLANES = bd.Scene(STRIP, bd.Mount(1.0, math.pi, math.pi / 2), physics=bd.Physics(planes=2))
TURNED = bd.Beam.from_stiffness(
    10.0, 100.0, 1e6, second_bending_stiffness=1.6e6, twist=np.polynomial.Polynomial([0.3, -0.3])
)
TWISTED = replace(TWO_PLANES, beam=TURNED)


@pytest.fixture(scope="module")
def of_two_planes() -> bd.Campbell:
    return bd.campbell({"strip": TWO_PLANES}, SPEEDS, rated=8.0, operating=(3.0, 9.0))


@pytest.mark.parametrize("scene", [UNIFORM_BLADE, TWO_PLANES, TWISTED, HARVESTER])
def test_crossings_are_roots(scene: bd.Scene) -> None:
    """At each crossing a natural frequency, solved anew, is n Omega to 1e-9, as the errors promise."""
    found = bd.campbell(scene, SPEEDS * (12 if scene is HARVESTER else 1), modes=4)
    assert len(found.crossings) >= 5
    again = bd.frequency_locus(scene, np.unique([c.speed for c in found.crossings]), 6)
    for crossing in found.crossings:
        line = crossing.line.multiple * crossing.speed / (2 * math.pi)
        at = np.searchsorted(again.speeds, crossing.speed)
        nearest = np.nanargmin(np.abs(again.frequency[at] - line))
        assert again.frequency[at, nearest] == pytest.approx(line, rel=1e-9)
        assert crossing.frequency == pytest.approx(line, rel=1e-12)
        assert again.plane_share[at, nearest] == pytest.approx(crossing.plane_share, abs=1e-6)
        assert 0 < crossing.error < 1e-9


def test_every_change_of_sign_has_its_crossing(of_two_planes: bd.Campbell) -> None:
    """Mode by mode, against the signs on the tracked locus: none is missed, none invented."""
    (locus,) = of_two_planes.loci
    for line in of_two_planes.lines:
        for mode in range(locus.frequency.shape[1]):
            sign = locus.frequency[:, mode] > line.multiple * locus.speeds / (2 * np.pi)
            expected = locus.speeds[np.flatnonzero(np.diff(sign)) + 1]
            own = [c.speed for c in of_two_planes.crossings if (c.mode, c.line) == (mode + 1, line)]
            assert len(own) == len(expected)
            assert all(high - 0.1 - 1e-9 <= speed <= high for speed, high in zip(own, expected, strict=True))


@pytest.mark.parametrize(("mode", "printed"), [(0, BIR_FLAP_1), (1, BIR_FLAP_2)])
def test_uniform_blade_is_that_of_bir(mode: int, printed: tuple[float, ...]) -> None:
    """Within the printed digits: half of 1e-3, and a unit for their rounding of the analytical column."""
    locus = bd.campbell(UNIFORM_BLADE, np.arange(13.0), modes=2, per_rev=[1]).loci[0]
    assert 2 * np.pi * locus.frequency[:, mode] == pytest.approx(np.array(printed), abs=1.5e-3)


def test_crossings_lie_where_the_printed_table_has_them() -> None:
    """Lines cross flap 2 of the uniform blade where Bir's column, interpolated, passes n Omega."""
    from scipy.interpolate import CubicSpline
    from scipy.optimize import brentq

    table = CubicSpline(np.arange(13.0), np.array(BIR_FLAP_2))
    for n in (4, 5, 6):
        expected = brentq(lambda omega, n=n: table(omega) - n * omega, 2.0, 12.0)
        found = bd.campbell(UNIFORM_BLADE, SPEEDS, modes=2, per_rev=[n])
        (speed,) = (c.speed for c in found.crossings if c.mode == 2)
        # a printed error of 5e-4 over the slope n - f' > 1.3, and the spline's own of 1e-3
        assert speed == pytest.approx(expected, abs=1.5e-3)


def test_modes_that_pass_one_another_keep_their_names(of_two_planes: bd.Campbell) -> None:
    (names,), (locus,) = of_two_planes.names, of_two_planes.loci
    assert names == ("flap 1", "edge 1", "flap 2", "edge 2")
    assert (locus.frequency[0, 0] < locus.frequency[0, 1]) and (
        locus.frequency[-1, 0] > locus.frequency[-1, 1]
    )
    for c in of_two_planes.crossings:
        assert c.plane_share == ((1.0, 0.0) if c.name.startswith("flap") else (0.0, 1.0))
        assert c.confidence > 0.9


@pytest.mark.parametrize("degrees", [85, 95, 50, 130, -85, 275])
def test_a_pitched_blade_has_flap_and_edge(degrees: float) -> None:
    """By its sections' own directions, of which flap is nearer to the axis of rotation."""
    mount = replace(TWO_PLANES.mount, bending_angle=math.radians(degrees))
    found = bd.campbell(replace(TWO_PLANES, mount=mount), SPEEDS[:2], modes=4)
    assert found.names == (("flap 1", "edge 1", "flap 2", "edge 2"),)
    assert words_of_directions(found.loci[0].scene) == ("flap", "edge")  # of tables, loads among them


def test_in_plane_of_a_pitched_blade_is_edge() -> None:
    """At a pitch of 85 deg the stiffer direction is nearer to the axis."""
    mount = replace(TWO_PLANES.mount, bending_angle=math.radians(5))
    (names,) = bd.campbell(replace(TWO_PLANES, mount=mount), SPEEDS[:2], modes=4).names
    assert names == ("edge 1", "flap 1", "edge 2", "flap 2")
    bent = bd.frequency_locus(replace(TWO_PLANES, mount=mount), SPEEDS[:2], 2)
    assert "flap" in bent.plot(Figure().subplots()).get_legend().get_texts()[2].get_text()


def test_margins_are_those_of_the_frequencies(of_two_planes: bd.Campbell) -> None:
    """At the rated speed against natural modes and all six lines by hand."""
    modes = bd.natural_modes(TWO_PLANES, 8.0, 4)
    by_mode = {m.name: m for m in of_two_planes.margins if m.where == "rated speed"}
    found = sorted(by_mode.values(), key=lambda m: m.frequency)
    for margin, frequency in zip(found, modes.frequency, strict=True):
        ratios = np.arange(1, 7) * 8.0 / (2 * np.pi) / frequency - 1
        assert margin.margin == pytest.approx(ratios[np.abs(ratios).argmin()], rel=1e-9)
        assert margin.speed == 8.0


def test_margin_over_the_range_is_zero_where_a_line_crosses(of_two_planes: bd.Campbell) -> None:
    in_range = {m.mode: m for m in of_two_planes.margins if m.where == "operating range"}
    crossed = {c.mode for c in of_two_planes.crossings if 3.0 <= c.speed <= 9.0}
    assert crossed and crossed < set(in_range)
    assert {mode for mode, m in in_range.items() if m.margin == 0.0} == crossed
    for crossing in of_two_planes.crossings:
        assert crossing.operating == (3.0 <= crossing.speed <= 9.0)
    for mode in set(in_range) - crossed:  # against a fine sampling of the range
        omega = np.linspace(3.0, 9.0, 61)
        f = bd.frequency_locus(TWO_PLANES, omega, 4).frequency[:, :, None]
        least = np.abs(omega[:, None, None] * np.arange(1, 7) / (2 * np.pi * f) - 1).min(axis=(0, 2))
        assert np.abs(least - abs(in_range[mode].margin)).min() < 1e-6


def test_operating_speeds_are_among_those_of_the_locus() -> None:
    found = bd.campbell(UNIFORM_BLADE, SPEEDS, 1, rated=0.1 * math.pi, operating=(0.3, 12.0 * (1 + 1e-12)))
    speeds = found.loci[0].speeds
    assert {0.1 * math.pi, 0.3, 12.0} <= set(speeds.tolist())
    assert np.diff(speeds).min() > 1e-3


def test_lines_of_the_motion_stand_beside_the_per_rev_lines() -> None:
    rolling = bd.load_scene(ROLLING)
    found = bd.campbell(rolling, np.linspace(0, 150, 151), 1)
    assert [line.name for line in found.lines] == ["1P", "2P", "3P", "4P", "5P", "6P", "road -", "road +"]
    resonances = {c.line.name: c.speed for c in bd.resonance_speeds(rolling, 150.0, 1) if c.kind == "forced"}
    own = {c.line.name: c.speed for c in found.crossings}
    for name in ("road -", "road +"):
        assert own[name] == pytest.approx(resonances[name], rel=1e-10)


def test_gravity_is_the_line_of_one_per_rev() -> None:
    scene = replace(UNIFORM_BLADE, mount=bd.Mount(0.0, math.pi), gravity=9.81)
    assert [line.name for line in bd.campbell(scene, SPEEDS, 1, per_rev=[2, 1]).lines] == ["1P", "2P"]


def test_a_line_that_is_the_frequency_is_no_crossing() -> None:
    """A hinged blade without hub flaps at 1P at every speed."""
    hinged = replace(UNIFORM_BLADE, mount=bd.Mount(0.0, math.pi, math.pi / 2, root_stiffness=0.0))
    found = bd.campbell(hinged, SPEEDS, 2)
    assert not [c for c in found.crossings if c.line.name == "1P"]
    assert any("flap 1 and 1P coincide" in warning for warning in found.warnings)


@pytest.mark.slow
def test_finite_elements_cross_where_assumed_modes_do() -> None:
    """Each in the other's stated errors, of which finite elements' are the larger."""
    ritz, fem = (bd.campbell(UNIFORM_BLADE, SPEEDS, 2, discretization=d) for d in ("ritz", "fem"))
    for one, other in zip(ritz.crossings, fem.crossings, strict=True):
        assert one.line == other.line
        assert other.speed == pytest.approx(one.speed, rel=one.error + other.error)


def test_model_error_of_crossings_is_that_of_resonances() -> None:
    rolling = bd.load_scene(ROLLING)
    found, resonances = (
        bd.campbell(rolling, np.linspace(0, 150, 151), 1),
        bd.resonance_speeds(rolling, 150.0, 1),
    )
    forced = {
        c.line.name: e for c, e in zip(resonances, resonances.model_error, strict=True) if c.kind == "forced"
    }
    own = {c.line.name: e for c, e in zip(found.crossings, found.model_error, strict=True)}
    for name in ("road -", "road +"):  # estimates by two bases
        assert own[name] == pytest.approx(forced[name], rel=1e-3)


def test_several_scenes_have_their_own_crossings_and_model_errors() -> None:
    alone = [bd.campbell(scene, SPEEDS, 2) for scene in (TWO_PLANES, TWISTED)]
    both = bd.campbell([TWO_PLANES, TWISTED], SPEEDS, 2)
    assert both.labels == ("scene 1", "scene 2")
    for label, one in zip(both.labels, alone, strict=True):
        assert [c.speed for c in both.crossings if c.label == label] == [c.speed for c in one.crossings]
    assert both.model_error.shape == (len(both.crossings),)


def test_guaranteed_bounds_enclose_the_frequencies() -> None:
    found = bd.campbell({"blade": UNIFORM_BLADE}, SPEEDS, 2, rated=8.0, bounds=True)
    ((label, bounds),) = found.bounds
    at_rated = bd.natural_modes(UNIFORM_BLADE, 8.0, 2).frequency
    assert label == "blade" and (bounds.lower <= at_rated).all() and (at_rated <= bounds.upper).all()
    damped = replace(UNIFORM_BLADE, damping_ratio=0.01)
    refused = bd.campbell({"damped": damped}, SPEEDS, 1, bounds=True)
    assert refused.bounds == () and any("damped: no guaranteed bounds" in w for w in refused.warnings)


def test_result_is_saved_loaded_and_pickled(of_two_planes: bd.Campbell, tmp_path: Path) -> None:
    of_two_planes.save(tmp_path / "campbell.json")
    loaded = bd.load(tmp_path / "campbell.json")
    assert loaded.crossings == of_two_planes.crossings == pickle.loads(pickle.dumps(loaded)).crossings
    written = json.loads((tmp_path / "campbell.json").read_text())
    assert len(written["crossings"]) == len(of_two_planes.crossings) == len(written["model_error"])


def test_roots_at_a_node_and_of_a_touching_pair_are_found_once() -> None:
    x = np.arange(6.0)
    assert [root for root, _ in find_roots(lambda v: v - 2.0, x, x - 2.0)] == [2.0]

    def dip(v: float) -> float:
        return (v - 3.4) ** 2 - 1e-6

    assert [root for root, _ in find_roots(dip, x, dip(x))] == pytest.approx([3.399, 3.401], rel=1e-12)


# The picture --------------------------------------------------------------------------------------


def draw(result: bd.Campbell):
    figure = Figure(figsize=(8.5, 6.0), layout="constrained")
    ax = result.plot(figure.subplots())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.draw_without_rendering()
    return ax


def overlapping(ax) -> list[tuple[str, str]]:
    """Pairs of labels beside and above the axes that cover one another."""
    boxes = [(t.get_text(), Text.get_window_extent(t)) for t in ax.texts]  # without their leaders
    return [(a, b) for i, (a, one) in enumerate(boxes) for b, other in boxes[i + 1 :] if one.overlaps(other)]


def test_picture_names_modes_and_lines_without_overlap(of_two_planes: bd.Campbell) -> None:
    ax = draw(of_two_planes)
    texts = [t.get_text() for t in ax.texts]
    assert {"1P", "6P", "flap 1", "edge 1"} <= set(texts)
    assert not overlapping(ax)
    legend = [t.get_text() for t in ax.get_legend().get_texts()]
    assert {"mostly flap", "mostly edge", "rated speed 8 rad/s", "operating range 3 to 9 rad/s"} <= set(
        legend
    )
    box = ax.figure.get_tightbbox()
    assert box.x0 >= 0 and box.x1 <= 8.5 and box.y0 >= 0 and box.y1 <= 6.0  # inch: nothing is cut


def test_flap_is_solid_and_edge_dashed(of_two_planes: bd.Campbell) -> None:
    ax = draw(of_two_planes)
    curves = {line.get_ydata()[0]: line.get_linestyle() for line in ax.lines if len(line.get_xdata()) > 100}
    rest = of_two_planes.loci[0].frequency[0]
    assert [curves[f] for f in rest[:2]] == ["-", "--"]


def test_axis_has_the_unit_of_the_speeds() -> None:
    found = bd.campbell(UNIFORM_BLADE, SPEEDS, 1, unit="rpm")
    ax = draw(found)
    assert ax.get_xlabel() == "rotor speed [rpm]"
    assert ax.get_xlim()[1] == pytest.approx(12.0 * 30 / math.pi, rel=1e-12)


def test_overlaid_scenes_have_their_colours_in_the_legend() -> None:
    ax = draw(bd.campbell({"straight": TWO_PLANES, "twisted": TWISTED}, SPEEDS))
    legend = [t.get_text() for t in ax.get_legend().get_texts()]
    assert {"straight", "twisted", "mostly flap"} <= set(legend)
    assert not overlapping(ax)


def test_many_close_labels_are_moved_apart() -> None:
    speeds, near = np.linspace(0, 10, 11), np.outer(np.ones(11), 5 + 0.01 * np.arange(8))
    figure = Figure(figsize=(8.5, 6.0), layout="constrained")
    names = tuple(f"mode {i}" for i in range(8))
    ax = plot_campbell([Curves(speeds, near, names)], {"3P": 3.0}, {}, figure.subplots())
    figure.draw_without_rendering()
    assert len(ax.texts) == 9 and not overlapping(ax)


def test_a_mode_that_buckles_is_named_inside() -> None:
    ax = draw(bd.campbell(HARVESTER, np.linspace(0, 200, 201), 2))
    (name,) = (t for t in ax.texts if t.get_text() == "mode 1")
    assert name.get_window_extent().x1 < ax.get_window_extent().x1
    assert any(t.get_text().startswith("above: mode 2") for t in ax.get_legend().get_texts())


# Bad input ----------------------------------------------------------------------------------------

WRONG = {
    "no scene": (dict(scenes=[]), ("scenes", "empty")),
    "no scene but a number": (dict(scenes=3), ("scenes", "beamdyn.Scene")),
    "a number among scenes": (dict(scenes=[UNIFORM_BLADE, 3]), ("scene 2", "beamdyn.Scene")),
    "no order": (dict(per_rev=[]), ("per_rev", "no order")),
    "order 0": (dict(per_rev=[0]), ("per_rev = 0", "from 1")),
    "negative order": (dict(per_rev=[1, -2]), ("per_rev = -2",)),
    "fractional order": (dict(per_rev=[1.5]), ("per_rev = 1.5",)),
    "a number of orders": (dict(per_rev=6), ("per_rev = 6", "range(1, 7)")),
    "rated above the top": (dict(rated=13.0), ("rated = 13 rad/s", "top speed", "12 rad/s")),
    "rated negative": (dict(rated=-1.0), ("rated = -1 rad/s", "greater than 0")),
    "range upside down": (dict(operating=(5.0, 4.0)), ("operating[0] = 5 rad/s", "below", "4 rad/s")),
    "range above the top": (dict(operating=(5.0, 14.0)), ("operating[1] = 14 rad/s", "top speed")),
    "range negative": (dict(operating=(-5.0, 4.0)), ("operating[0] = -5 rad/s", "first speed")),
    "one operating speed": (dict(operating=5.0), ("operating", "lowest")),
    "rated outside the range": (dict(rated=3.0, operating=(5.0, 9.0)), ("rated = 3", "5 to 9")),
    "negative speeds": (dict(speeds=[-1.0, 5.0]), ("speeds = -1 rad/s", "0 or above")),
    "one speed": (dict(speeds=[5.0]), ("speeds", "two speeds")),
    "unit": (dict(unit="Hz"), ("unit", "'rad/s' or 'rpm'")),
}


@pytest.mark.parametrize("case", WRONG)
def test_bad_input_is_refused_by_name(case: str) -> None:
    changes, parts = WRONG[case]
    with pytest.raises(ValueError) as refused:
        bd.campbell(**({"scenes": UNIFORM_BLADE, "speeds": SPEEDS, "modes": 1} | changes))
    assert all(part in str(refused.value) for part in parts), str(refused.value)


# The command --------------------------------------------------------------------------------------


def test_command_writes_what_it_prints(run, tmp_path: Path) -> None:
    picture, table, crossings, record = (tmp_path / n for n in ("c.png", "c.csv", "x.csv", "c.json"))
    code, out, err = run(
        "campbell", BLADE, "--top-speed", "2000 rpm", "--rated", "1500 rpm", "--operating", "900:1500 rpm",
        "--modes", "2", "--per-rev", "3", "--plot", picture, "--csv", table, "--crossings", crossings,
        "--json", record,
    )  # fmt: skip
    assert (code, err) == (DONE, "")
    assert "speed [rpm]" in out and "Margins" in out and "model" in out
    assert picture.stat().st_size > 10_000
    rows = [*csv.DictReader(table.read_text().splitlines())]
    assert float(rows[-1]["speed_rpm"]) == pytest.approx(2000.0, rel=1e-12)
    listed, stored = [*csv.DictReader(crossings.read_text().splitlines())], json.loads(record.read_text())
    assert len(listed) == len(stored["crossings"])
    assert bd.load(record).unit == "rpm"


def test_command_finds_few_equilibria_and_the_same_crossings(run, tmp_path: Path) -> None:
    """A beam bent far is solved at a fifth of the speeds; where a line crosses does not depend on them."""
    bent, table = tmp_path / "bent.toml", tmp_path / "x.csv"
    text = (ROOT / "examples" / "harvester_45deg.toml").read_text()
    bent.write_text(text.replace("[beam]", "[physics]\nlarge_deflection = true\n\n[beam]"))
    few = ("--modes", "1", "--crossings", table, "--csv", tmp_path / "f.csv")
    code, _, _ = run("campbell", bent, "--top-speed", "90 rad/s", *few)
    assert code == DONE and len((tmp_path / "f.csv").read_text().splitlines()) < 90
    with warnings.catch_warnings(action="ignore"):
        known = bd.campbell(bd.load_scene(bent), np.linspace(0, 90, 181), modes=1)
    found = [float(row["speed_rad_per_s"]) for row in csv.DictReader(table.read_text().splitlines())]
    error = 3 * known.crossings[0].error  # of both, by different bases
    assert found == pytest.approx([each.speed for each in known.crossings], rel=error)


def test_command_overlays_scenes_and_lists_orders(run, tmp_path: Path) -> None:
    other = tmp_path / "stiffer.toml"
    other.write_text(BLADE.read_text())
    code, out, _ = run(
        "campbell", BLADE, other, "--top-speed", "200 rad/s", "--per-rev", "3, 6", "--modes", "1"
    )
    assert code == DONE and "stiffer" in out and "speed [rad/s]" in out
    assert "3P" in out and "4P" not in out


def test_command_takes_the_blades_of_other_programs(run, tmp_path: Path) -> None:
    table = tmp_path / "blade.csv"
    table.write_text(
        "r [m], mass [kg/m], EI flap [N m2], EI edge [N m2], offset [m]\n1,50,1e6,4e6,0.1\n9,50,1e6,4e6,0.1\n"
    )
    code, out, err = run("campbell", table, "--top-speed", "300 rpm", "--bounds", "--modes", "2")
    assert code == DONE
    assert "not modelled: offset (0.1 m)" in err and "ounds" in out
    beam = bd.Beam.from_stiffness(8.0, 50.0, 1e6, second_bending_stiffness=4e6)
    scene = bd.Scene(beam, bd.Mount(1.0, math.pi, math.pi / 2), physics=bd.Physics(planes=2))
    known = bd.campbell(scene, np.linspace(0, 10 * math.pi, 301), modes=2, per_rev=range(1, 7))
    for crossing in known.crossings:
        assert f"{crossing.speed * 30 / math.pi:.6g}"[:6] in out


MISTAKES = {
    "no top speed": ((BLADE,), ("--top-speed",)),
    "no scene": (("--top-speed", "5 rpm"), ("FILE",)),
    "bare top speed": ((BLADE, "--top-speed", "5"), ("--top-speed", "unit")),
    "top speed negative": ((BLADE, "--top-speed", "-5 rpm"), ("--top-speed", "greater than 0")),
    "top below rated": (
        (BLADE, "--top-speed", "5 rpm", "--rated", "6 rpm"),
        ("--rated", '"6 rpm"', "--top-speed", "higher"),
    ),
    "no order": ((BLADE, "--top-speed", "5 rpm", "--per-rev", "0"), ("--per-rev", "1P to 6P")),
    "negative order": ((BLADE, "--top-speed", "5 rpm", "--per-rev", "-3"), ("--per-rev", "1P to 6P")),
    "range of one": ((BLADE, "--top-speed", "5 rpm", "--operating", "3 rpm"), ("--operating", "lowest:")),
    "range falls": ((BLADE, "--top-speed", "5 rpm", "--operating", "4:3 rpm"), ("--operating", "end above")),
    "range above the top": (
        (BLADE, "--top-speed", "60 rpm", "--operating", "10:80 rpm"),
        ("--operating = 80 rpm", "above", '--top-speed = "60 rpm"', "higher"),
    ),
    "rated outside the range": (
        (BLADE, "--top-speed", "100 rpm", "--operating", "10:80 rpm", "--rated", "90 rpm"),
        ('--rated = "90 rpm"', 'outside --operating = "10:80 rpm"'),
    ),
    "many orders": (
        (BLADE, "--top-speed", "5 rpm", "--per-rev", "2000"),
        ('--per-rev = "2000"', "from 1 to 100"),
    ),
    "one label twice": ((BLADE, BLADE, "--top-speed", "5 rpm"), ("blade", "--labels")),
    "labels alike": ((BLADE, BLADE, "--top-speed", "5 rpm", "--labels", "a, a"), ('"a"', "its own")),
    "length of a scene": ((BLADE, "--top-speed", "5 rpm", "--length", "5 m"), ("--length", "leave it out")),
    "length of two": (
        (BLADE.with_suffix(".dat"), "b.dat", "--top-speed", "5 rpm", "--length", "5 m"),
        ("--length", "one blade", "import"),
    ),
    "one label of two": ((BLADE, BLADE, "--top-speed", "5 rpm", "--labels", "a"), ("--labels", "2 in all")),
}  # fmt: skip


@pytest.mark.parametrize("case", MISTAKES)
def test_mistakes_are_named(run, case: str) -> None:
    arguments, parts = MISTAKES[case]
    code, _, err = run("campbell", *arguments)
    assert code == BAD_INPUT
    assert all(part in err for part in parts), err


@pytest.mark.slow
def test_torsion_has_a_line_of_its_own() -> None:
    strip = bd.Beam.rectangular(0.1, 0.03, 0.001, 200e9, 7850.0, poissons_ratio=0.3)
    plate = bd.Scene(strip, bd.Mount(0.1, np.pi), physics=bd.Physics(2, camber=True, torsion=True))
    ax = bd.campbell(plate, np.linspace(0, 600, 5), modes=3).plot(Figure().subplots())
    legend = {text.get_text() for text in ax.get_legend().get_texts()}
    assert {"mostly edge", "mostly torsion"} <= legend
    assert "mostly flap" not in legend  # no such mode is drawn
    dotted = [
        line.get_ydata()[0]
        for line in ax.get_lines()
        if line.get_linestyle() == ":" and len(line.get_ydata())
    ]
    assert dotted == pytest.approx([560], rel=0.02)  # Hz: torsion 1 alone
