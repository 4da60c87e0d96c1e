"""Calipers: bad input, diagnosis, stopping, pictures, and their files."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest

from beamdyn.common.drawing.shapes import Arrow
from beamdyn.common.edge.config import ConfigError
from brakes import calipers
from brakes.calipers import Caliper, stop
from brakes.cli import main
from brakes.config.mechanism import mechanism_from_dict, parse_mechanism
from brakes.drawings import mechanism as drawings
from brakes.drawings import mechanism_parts as parts
from brakes.drawings.caliper import caliper_figure
from brakes.drawings.mechanism import force_scale
from brakes.planar import OutOfReachError, Position, free_body

EXAMPLES = Path(__file__).parents[2] / "examples" / "calipers"
OWN = (EXAMPLES / "own-caliper.toml").read_text()
CLAMP = (EXAMPLES / "toggle-clamp.toml").read_text()


# Bad input and diagnosis --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"lever_ratio": 0}, "lever_ratio = 0: it must be greater than 0"),
        ({"clearance": -1e-3}, "clearance = -0.001 m"),
        ({"pivot_radius": -1.0}, "pivot_radius = -1 m"),
        ({"split": "fair"}, "split = 'fair': give 'equal force' or 'equal work'"),
        ({"cable": "wire"}, "load 'wire' does not exist"),
        ({"pads": ("right pad", "right pad")}, "name three different loads"),
    ],
)
def test_bad_calipers_are_refused(change, words):
    with pytest.raises(ValueError, match=words.replace("(", r"\(")):
        dataclasses.replace(calipers.EeBrake().build(), **change)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda c: c.stroke(finger=0.0), "finger = 0 N"),
        (lambda c: c.stroke(points=1), "points = 1"),
        (lambda c: c.stroke(object()), "travel = <object object at .*>: give a finite number in m"),
        (lambda c: c.stroke([np.nan]), "every value must be finite"),
        (lambda c: c.worn(-1e-3), "lost = -0.001 m"),
        (lambda c: c.friction(-0.1), "coefficient = -0.1"),
    ],
)
def test_bad_questions_are_refused(call, words):
    with pytest.raises(ValueError, match=words):
        call(calipers.VBrake().build())


@pytest.mark.parametrize(
    ("status", "answered"),
    [("determined", True), ("self-locking", True), ("contact opens", False), ("cable slackens", False)],
)
def test_with_friction_what_would_have_to_act_the_other_way_is_no_answer(status, answered):
    """The rule of a caliper is that of a mechanism: only locking leaves forces that are its own."""
    caliper = calipers.VBrake().build()
    found = dataclasses.replace(caliper.friction(0.2), status=status)
    assert found.has_answer == answered
    jammed = dataclasses.replace(found, releasing_tension=math.nan)
    assert not jammed.has_answer
    way = dataclasses.replace(caliper.equilibrium(), status=status)
    assert way.has_answer == answered


def test_a_caliper_that_locks_names_the_way_as_a_mechanism_does():
    locked = dataclasses.replace(calipers.VBrake().build(), pivot_radius=0.03).friction(5.0)
    assert locked.status == "self-locking" and "releasing: self-locking" in locked.message


def test_any_number_of_python_is_one():
    """Decimal numbers give what floats give, and results hold floats."""
    caliper = calipers.VBrake().build()
    pressed = caliper.stroke(finger=Decimal(40), points=2)
    assert np.array_equal(pressed.advantage, caliper.stroke(points=2).advantage)
    assert type(pressed.finger_force) is float
    rubbing = caliper.friction(Decimal("0.25"), finger=Decimal(40))
    assert rubbing == caliper.friction(0.25) and type(rubbing.coefficient) is float


def test_a_cable_that_opens_the_pads_is_refused():
    with pytest.raises(ValueError, match="opens the pads"):
        calipers.Cantilever(yoke=(0.0, 0.2)).build().contact  # noqa: B018  (the yoke is above its stop)


def test_a_travel_out_of_reach():
    with pytest.raises(OutOfReachError, match="cannot reach"):
        calipers.EeBrake().build().stroke(0.05)


def test_without_the_strut_or_the_link_the_sentence_names_what_moves():
    caliper = calipers.EeBrake().build()
    for lost, moving in (("pin G", "link"), ("strut end", "strut")):
        m = caliper.mechanism
        loose = dataclasses.replace(m, joints=tuple(j for j in m.joints if j.name != lost))
        with pytest.raises(ValueError, match=f"mobility 3.*{moving}"):
            dataclasses.replace(caliper, mechanism=loose).stroke([0.0])


def test_a_roller_that_would_pull_is_an_answer_of_its_own():
    """With its pivot high up the right arm is the weaker one, and the roller cannot help it."""
    weak = calipers.DualPivot(side_pivot=(0.027, 0.08)).build()
    run = weak.stroke([0.0])
    assert run.magnitudes["roller"][0] < 0
    assert run.status == "contact opens"
    assert "contact 'roller' would have to pull" in run.message


def test_worn_pads_lie_further_out():
    caliper = calipers.VBrake().build()
    worn = caliper.worn(2e-3)
    assert worn.clearance == caliper.clearance + 2e-3
    assert worn.mechanism.load("right pad").at[0] == pytest.approx(14.5e-3, rel=1e-14)
    assert worn.mechanism.load("left pad").at[0] == pytest.approx(-14.5e-3, rel=1e-14)


def test_the_stroke_as_plain_numbers():
    run = calipers.SinglePivot().build().stroke(points=3)
    found = run.to_dict()
    assert found["reactions"]["bolt, right arm"][2] == run.reactions["bolt, right arm"][2].tolist()
    assert found["travel_symmetry"] == run.travel_symmetry.tolist()
    assert "motion" not in found


# Stopping -----------------------------------------------------------------------------------------

RIDER = {"mass": 80.0, "speed": 8.0, "friction": 0.4}


def test_a_force_that_grows_with_the_distance():
    """E = 2 mu (F0 s + k s^2/2) solved for s."""
    first, slope = 100.0, 30.0
    energy = 80.0 * 8.0**2 / 2
    by_hand = (-first + math.sqrt(first**2 + slope * energy / 0.4)) / slope
    found = stop(pad_force=lambda s: first + slope * s, **RIDER)
    assert found.distance == pytest.approx(by_hand, rel=1e-10)  # tolerance of the integration, summed
    assert found.energy == energy and found.status == "stops"


def test_a_constant_force_given_as_a_function():
    fixed, function = stop(pad_force=200.0, **RIDER), stop(pad_force=lambda s: 200.0, **RIDER)
    assert function.distance == pytest.approx(fixed.distance, rel=1e-12)
    assert fixed.deceleration == pytest.approx(8.0**2 / (2 * fixed.distance), rel=1e-14)


def test_rotating_mass_and_rim_radius():
    plain = stop(pad_force=200.0, **RIDER).distance
    heavy = stop(pad_force=200.0, wheel_inertia=0.2, tyre_radius=0.34, **RIDER).distance
    assert heavy / plain == pytest.approx(1 + 0.2 / 0.34**2 / 80, rel=1e-14)
    inner = stop(pad_force=200.0, tyre_radius=0.34, rim_radius=0.311, **RIDER).distance
    assert inner / plain == pytest.approx(0.34 / 0.311, rel=1e-14)


@pytest.mark.parametrize("force", [200, lambda s: Decimal(200)])
def test_a_stop_takes_decimal_numbers(force):
    decimals = {"mass": 80, "speed": 8, "wheel_inertia": 0.25, "tyre_radius": 0.5, "rim_radius": 0.25}
    floats = stop(pad_force=200.0 if force == 200 else lambda s: 200.0, friction=0.5, **decimals)
    exact = {name: Decimal(value) for name, value in decimals.items()}
    given = Decimal(force) if force == 200 else force
    assert repr(stop(pad_force=given, friction=Decimal("0.5"), **exact)) == repr(floats)  # limits are nan


@pytest.mark.parametrize("force", [0.0, lambda s: 100.0 * (1 - s / 2)])
def test_pads_that_let_go_do_not_stop(force):
    found = stop(pad_force=force, **RIDER)
    assert (found.status, found.distance) == ("does not stop", math.inf)


def test_at_rest_the_distance_is_nothing():
    assert stop(80.0, 0.0, lambda s: 100.0, 0.4).distance == 0.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mass": 0.0}, "mass = 0 kg"),
        ({"friction": 0.0}, "friction = 0"),
        ({"pad_force": -1.0}, "pad_force = -1 N"),
        ({"pad_force": lambda s: -1.0}, "pad_force at s = 0 is -1 N"),
        ({"wheel_inertia": 0.1}, "needs tyre_radius"),
        ({"rim_radius": 0.3}, "needs tyre_radius"),
        ({"rim_radius": 0.4, "tyre_radius": 0.34}, "must not exceed tyre_radius"),
        ({"stance": 3}, "stance = 3: give a Stance"),
    ],
)
def test_bad_stops_are_refused(change, words):
    with pytest.raises(ValueError, match=words):
        stop(**({"pad_force": 200.0} | RIDER | change))


# Files --------------------------------------------------------------------------------------------


def test_named_caliper_with_dimensions():
    text = 'caliper = "cantilever"\n[dimensions]\nyoke = ["0 mm", "5 cm"]\nlever_ratio = 3'
    found = parse_mechanism(text).core
    expected = calipers.Cantilever(yoke=(0.0, 0.05), lever_ratio=3.0).build()
    assert found == expected


@pytest.mark.parametrize("name", calipers.NAMED)
def test_a_file_without_dimensions_is_the_usual_caliper(name):
    assert parse_mechanism(f'caliper = "{name}"').core == calipers.NAMED[name]().build()


def test_own_points_make_the_same_caliper_as_a_design():
    """The single-pivot written out with points of one's own."""
    text = OWN.replace('["6 mm", "0 mm"]', '["0 mm", "0 mm"]').replace(
        '["-6 mm", "0 mm"]', '["0 mm", "0 mm"]'
    )
    own = parse_mechanism(text).core
    assert isinstance(own, Caliper) and [joint.name for joint in own.centring] == ["springs"]
    run, expected = own.stroke(points=5), calipers.SinglePivot().build().stroke(points=5)
    assert run.advantage == pytest.approx(expected.advantage, rel=1e-12)
    assert run.pad_travel == pytest.approx(expected.pad_travel, rel=1e-9, abs=1e-15)


def mistakes(text: str) -> str:
    with pytest.raises(ConfigError) as caught:
        parse_mechanism(text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('at = "clamp"', 'at = "clam"', 'cable_pair[0].at = "clam": no such point in [points]'),
        ('at = "clamp"', 'at = ["1 mm"]', "cable_pair[0].at"),
        ('to = "housing"', 'to = "clamp"', "cable_pair[0]: cable pair 'wire' has zero length"),
        (
            'left_pad"\ndirection = [-1, 0]',
            'left_pad"\ndirection = [-1, 0]\n[[spring]]\nname = "s"\nbody = "left arm"\nat = "clamp"\n'
            'to = "clamp"\nstiffness = "5 N/mm"\nfree_length = "1 mm"',
            "spring 's' has zero length at (-42, 2) mm",
        ),
        ('body = "left arm"\nat', 'body = "left"\nat', "did you mean 'left arm'?"),
        ('["-42 mm", "2 mm"]', '["-42 mm", 2]', "points.clamp"),
        ("direction = [1, 0]", "direction = [0, 0]", "force[0]: force 'right pad': direction = (0, 0)"),
        ("direction = [1, 0]", 'direction = "3 mm"', "force[0].direction"),
        ('cable = "wire"', 'cable = "wir"', "did you mean 'wire'?"),
        ('["springs"]', '["spring"]', "'spring' is not a joint"),
        ('pads = ["right pad", "left pad"]', 'pads = ["right pad"]', "caliper.pads"),
        ('finger = "40 N"', 'finger = "40 mm"', "run.finger"),
        ("friction = 0.15", "friction = -0.15", "run.friction = -0.15"),
        ("ratio = -1\n", "ration = -1\n", "rotation_lock[0].ration: unknown key"),
    ],
)
def test_mistakes_in_a_file_name_the_key(old, new, words):
    assert OWN.count(old) >= 1
    assert words in mistakes(OWN.replace(old, new, 1))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('driver = "hand"', 'driver = "foot"', 'run.driver = "foot": no such load; name one of hand, work'),
        ('travel = "14 mm" ', 'travel = "14 deg" ', "moves by a length"),
        ('driver = "hand"\n', "", "run.driver: missing"),
        ('travel = "14 mm" ', "# ", "run.travel: missing"),
    ],
)
def test_mistakes_in_a_run(old, new, words):
    assert words in mistakes(CLAMP.replace(old, new, 1))


def test_all_mistakes_of_a_file_at_once():
    text = OWN.replace('at = "clamp"', 'at = "x"').replace("lever_ratio = 4", "lever_ratio = -4")
    assert "2 mistakes" in mistakes(text)


def test_every_kind_of_part_is_read():
    tables = {
        "bodies": ["a", "b"],
        "points": {"O": ["0 mm", "0 mm"]},
        "pin": [{"name": "p", "body": "a", "at": "O", "radius": "3 mm", "friction": 0.1}],
        "bar": [{"name": "q", "body": "a", "other": "b", "at": ["1 mm", "0 mm"], "to": ["1 mm", "5 mm"]}],
        "slot": [{"name": "s", "body": "b", "at": ["0 mm", "5 mm"], "along": "90 deg"}],
        "contact": [{"name": "c", "body": "b", "at": ["2 mm", "5 mm"], "normal": [0, 1]}],
        "rotation_lock": [{"name": "l", "body": "b"}],
        "cable": [{"name": "w", "bodies": ["a", "b"], "points": ["O", ["3 mm", "3 mm"]]}],
        "force": [{"name": "f", "body": "a", "at": "O", "direction": [0, 1], "magnitude": "1 N"}],
        "moment": [{"name": "m", "body": "a", "magnitude": "2 N m"}],
        "cable_pair": [{"name": "t", "body": "a", "at": "O", "to": ["9 mm", "0 mm"]}],
        "spring": [
            {
                "name": "k",
                "body": "a",
                "at": "O",
                "to": ["0 mm", "9 mm"],
                "stiffness": "1 N/mm",
                "free_length": "8 mm",
            }
        ],
        "torsion_spring": [{"name": "n", "body": "a", "stiffness": "2 N m/rad", "free_angle": "5 deg"}],
    }
    found = mechanism_from_dict(tables).core
    assert [part.name for part in found.parts] == list("pqsclwfmtkn")
    assert found.loads[3].stiffness == pytest.approx(1000.0, rel=1e-15)
    assert found.joints[2].along == pytest.approx((0.0, 1.0), abs=1e-15)
    assert found.joints[5].points == ((0.0, 0.0), (0.003, 0.003))


# Pictures -----------------------------------------------------------------------------------------


def test_members_in_tension_and_compression():
    answer = calipers.EeBrake().build().equilibrium()
    forces = {member.name: member.force for member in parts.members(answer.position, answer)}
    assert forces == pytest.approx(
        {"strut": -answer.magnitudes["pin B"], "link": -answer.magnitudes["pin A"]}
    )


def test_outer_forces_balance():
    """Loads and the ground's reactions on the whole: forces and moments add up to zero."""
    for name, design in calipers.NAMED.items():
        arrows = parts.outer_forces(design().build().equilibrium())
        assert np.abs(sum(arrow.force for arrow in arrows)).max() < 1e-10, name  # of some hundred newtons
        moments = [arrow.at[0] * arrow.force[1] - arrow.at[1] * arrow.force[0] for arrow in arrows]
        assert abs(sum(moments)) < 1e-11


def test_outer_forces_are_loads_and_what_the_ground_gives():
    arrows = parts.outer_forces(calipers.DualPivot().build().equilibrium())
    given = {(arrow.name, arrow.reaction) for arrow in arrows}  # neither the cable nor the roller
    assert given == {("side pivot", True), ("bolt", True), ("right pad", False), ("left pad", False)}


def test_arrows_have_one_scale():
    answer = calipers.VBrake().build().equilibrium()
    low, high = parts.extent(answer.position)
    scale = force_scale(parts.outer_forces(answer), math.dist(low, high))
    made = drawings.open_and_closed(answer.position, answer)
    drawn = [math.hypot(*shape.vector) for shape in made.shapes if isinstance(shape, Arrow)]
    sizes = [np.linalg.norm(arrow.force) for arrow in parts.outer_forces(answer)]
    assert sorted(drawn) == pytest.approx(
        sorted(1e3 * scale * size for size in sizes if size > 1e-9), rel=1e-9
    )


def test_free_bodies_show_all_that_acts():
    answer = calipers.DualPivot().build().equilibrium()
    figure = drawings.free_body_diagrams({"": answer})
    assert [ax.get_title() for ax in figure.axes] == ["right arm", "left arm"]
    for ax, body in zip(figure.axes, ("right arm", "left arm"), strict=True):
        written = " ".join(text.get_text() for text in ax.texts)
        assert all(action.name in written for action in free_body(answer, body))


def test_a_caliper_has_its_curves():
    caliper = calipers.EeBrake().build()
    run = caliper.stroke(points=11)
    figure = caliper_figure(caliper, run, caliper.equilibrium())
    advantage, ratio, reactions = figure.axes[1:]
    assert np.array_equal(advantage.lines[0].get_ydata(), run.advantage[:, 0])
    assert np.array_equal(ratio.lines[1].get_ydata(), run.pad_ratio[:, 1])
    labels = [line.get_label() for line in reactions.lines]
    assert "pin A, pin G" in labels and "pin B, strut end" in labels  # ends of two-force bodies


def test_animation_goes_there_and_back(tmp_path):
    from PIL import Image

    run = calipers.VBrake().build().stroke(points=4)
    drawings.animate(run.position, tmp_path / "a.gif", lambda k: f"{k}")
    with Image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 6
    with pytest.raises(FileExistsError):
        drawings.animate(run.position, tmp_path / "a.gif")


def test_outlines_are_where_the_points_are():
    run = calipers.SinglePivot().build().stroke(points=2)
    last = Position(run.position.mechanism, run.position.batch[-1])
    corners = parts.outline(last, "right arm")
    for at in last.mechanism.points["right arm"]:
        assert np.abs(corners - last.point("right arm", at)).sum(axis=1).min() < 1e-15


# The command --------------------------------------------------------------------------------------


def run(capsys, *arguments) -> tuple[int, str, str]:
    code = main(["caliper", *map(str, arguments)])
    out, err = capsys.readouterr()
    return code, out, err


def test_the_command_prints_what_it_finds(capsys):
    code, out, err = run(capsys, EXAMPLES / "eebrake.toml")
    assert (code, err) == (0, "")
    for words in (
        "5.9811",
        "strut end",
        "compression",
        "5.6000 times",
        "every reaction",
        "stops in 14.5133 m",
    ):
        assert words in out


def test_the_command_writes_what_is_asked_for(capsys, tmp_path):
    files = {
        "--plot": "p.png",
        "--free-bodies": "f.png",
        "--animation": "a.gif",
        "--json": "r.json",
        "--csv": "t.csv",
    }
    text = (
        (EXAMPLES / "own-caliper.toml").read_text().replace('finger = "40 N"', 'finger = "40 N"\npoints = 4')
    )
    (tmp_path / "own.toml").write_text(text)
    options = [part for key, name in files.items() for part in (key, tmp_path / name)]
    assert run(capsys, tmp_path / "own.toml", *options)[0] == 0
    assert all((tmp_path / name).stat().st_size for name in files.values())
    head, *rows = (tmp_path / "t.csv").read_text().splitlines()
    assert head.startswith("cable_m,finger_m") and len(rows) == 4
    code, _, err = run(capsys, tmp_path / "own.toml", *options)
    assert code == 2 and "--force" in err


def test_names_are_listed(capsys):
    code, out, _ = run(capsys, "--list")
    assert code == 0 and all(name in out for name in calipers.NAMED) and "link_anchor" in out


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('travel = "14 mm" ', 'travel = "30 mm" ', "cannot reach 30 mm: it turns back at 14.25 mm"),
        ('travel = "14 mm" ', 'travel = "14.2502 mm" ', "it turns back just short of it, at 14.25 mm"),
        ('[[bar]]\nname = "CD"\nbody = "handle"\nat = "C"\nto = "D"\n', "", "mobility 2"),
        (
            '[run]\ndriver = "hand"\ntravel = "14 mm"',
            '[[pin]]\nname="E"\nbody="arm"\nat="E"\n[run]\n#',
            "does not give A, E and work",
        ),
    ],
)
def test_no_answer_ends_with_1_and_says_why(capsys, tmp_path, old, new, words):
    assert old in CLAMP
    (tmp_path / "m.toml").write_text(CLAMP.replace(old, new, 1))
    code, _, err = run(capsys, tmp_path / "m.toml")
    assert code == 1 and words in err


def test_past_the_toggle_position_the_command_says_so(capsys, tmp_path):
    text = (EXAMPLES / "eebrake.toml").read_text().replace('"3.5 mm"', '"30 mm"')
    (tmp_path / "m.toml").write_text(text)
    code, _, err = run(capsys, tmp_path / "m.toml")
    assert code == 1 and "past its toggle position" in err and "toggle position of 'right pad'" in err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "MECHANISM: missing; give a TOML file, or the name of a caliper: eebrake, single-pivot"),
        (["eebrak"], "eebrak: there is no such caliper"),
        (["none.toml"], "there is no such file"),
        (["v-brake", "--plot", "x.bmp"], "unknown suffix"),
        (["v-brake", "--animation", "x.mp4"], "unknown suffix"),
    ],
)
def test_bad_input_ends_with_2(capsys, arguments, words):
    code, _, err = run(capsys, *arguments)
    assert code == 2 and words in err


def test_examples_are_what_they_say():
    for path in EXAMPLES.glob("*.toml"):
        given = tomllib.loads(path.read_text())
        assert "caliper" in given or "bodies" in given


def test_a_rim_outside_the_tyre_is_refused_by_key_and_in_the_unit_of_the_file():
    vehicle = '[stop]\nmass = "90 kg"\nspeed = "25 km/h"\nfriction = 0.4\ntyre_radius = "34 cm"\n'
    said = mistakes(f'{OWN}\n{vehicle}rim_radius = "40 cm"\n')
    assert said.endswith('stop.rim_radius = "40 cm": it must not exceed tyre_radius = 34 cm')
