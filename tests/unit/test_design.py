"""Designs sought backwards: wanted answers that are known, limits, the best, and what no design meets."""

from __future__ import annotations

import tomllib
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.numbers import with_numbers
from benchmarks.cases.wanted_designs import INWARD, ROLLING, WIDE, frequency

THICKNESS = {"beam.thickness": (1e-4, 4e-4)}
SCENE = "examples/tyre_harvester.toml"


def test_one_number_gives_the_wanted_frequency():
    found = bd.design(INWARD, THICKNESS, [bd.Target("frequencies", equals=frequency(thickness=3.3e-4))])
    assert found.found and found.solves <= 60 and not found.limited_by
    np.testing.assert_allclose(found.value, 3.3e-4, rtol=1e-10)  # the root is bracketed to that
    np.testing.assert_allclose(found.relative, 1.0, rtol=1e-9)  # f ~ h; differences of rounded frequencies
    np.testing.assert_allclose(found.derivative, [found.reached / 3.3e-4], rtol=1e-9)


def test_of_two_numbers_the_design_nearest_to_the_scene_is_found():
    found = bd.design(INWARD, WIDE, [bd.Target("frequencies", equals=1.2 * frequency())])
    spans = np.log([high / low for low, high in WIDE.values()])
    step = np.log(found.value / [0.0002, 0.05]) / spans  # in shares: along the gradient of h / L^2
    np.testing.assert_allclose(step[0] / step[1], -spans[0] / (2 * spans[1]), rtol=1e-6)
    np.testing.assert_allclose(found.relative, [[1.0, -2.0]], rtol=1e-6)  # by differences over 0.1 %


def test_a_limit_that_holds_the_best_is_named():
    critical = bd.critical_speed(INWARD)
    wanted = [
        bd.Target("frequencies", best="smallest"),
        bd.Target("critical_speed", at_least=0.8 * critical),
    ]
    found = bd.design(INWARD, THICKNESS, wanted)
    np.testing.assert_allclose(found.reached[0], 0.8 * frequency(), rtol=1e-6)  # both are proportional to h
    assert [each.partition(" at least")[0] for each in found.limited_by] == ["critical speed"]


def test_a_resonance_comes_to_the_wanted_speed():
    found = bd.design(ROLLING, THICKNESS, [bd.Target("crossings", equals=37.0, line="road +")])
    crossings = bd.resonance_speeds(found.scene_found, 60.0, 1)
    speed = next(each.speed for each in crossings if each.line.name == "road +" and each.kind == "forced")
    np.testing.assert_allclose(speed, 37.0, rtol=1e-9)  # the root is bracketed closer than that
    assert found.solves < 30  # though thick beams have no resonance up to the top speed


def test_the_strain_of_a_study_is_the_largest_of_the_steady_loads():
    with unannounced():
        found = bd.study(ROLLING, {"beam.thickness": [0.0003]}, "strain", speed=20.0)
        loads = bd.steady_loads(bd.steady_response(found.scene_at(0), [20.0], tolerance=1e-5))
    np.testing.assert_allclose(found.value, loads.largest("strain").value, rtol=1e-12)  # the same call


@pytest.mark.parametrize(
    ("targets", "is_sure"),
    [
        ([bd.Target("frequencies", equals=500.0)], True),
        ([bd.Target("critical_speed", at_most=10.0)], True),
        ([bd.Target("frequencies", at_least=80.0), bd.Target("critical_speed", at_most=100.0)], False),
    ],
)
def test_where_no_design_meets_the_targets_the_nearest_is_said(targets, is_sure):
    found = bd.design(INWARD, THICKNESS, targets)
    assert not found.found and found.only_one_way == is_sure
    said = "No design in the bounds has " if is_sure else "No design was found that has "
    assert found.sentences()[0].startswith(said)
    assert ("no other design comes nearer" in " ".join(found.sentences())) == is_sure


@pytest.mark.slow
def test_a_number_has_an_effect_where_an_answer_is_largest():
    """At the peak of a resonance the amplitude is level over the thickness, which stays there."""
    target = bd.Target("amplitude", best="largest", speed=55.0)
    found = bd.design(ROLLING, {"beam.thickness": (1.7e-4, 2.6e-4)}, [target])
    assert not found.without_effect
    others = [0.999 * found.value[0], 1.001 * found.value[0], 2e-4]  # the last is the scene's own
    beside = bd.study(ROLLING, {"beam.thickness": others}, "amplitude", speed=55.0).value
    assert (found.reached[0] > beside).all()


@pytest.mark.parametrize("others", [{}, {"beam.length": (0.04, 0.06)}])
def test_a_number_without_effect_is_named_and_stays(others):
    """The width stands in stiffness and mass alike: f ~ h / L^2."""
    for speed in (None, 1.0):
        wanted = [bd.Target("frequencies", equals=300.0, speed=speed)]
        found = bd.design(INWARD, {"beam.width": (0.005, 0.02)} | others, wanted)
        assert found.without_effect == ("beam.width",) and found.value[0] == found.given[0]
        said = " ".join(found.sentences())
        assert (
            f"beam.width has no effect on frequency of mode 1{'' if speed is None else ' at 1 rad/s'}."
            in said
        )
        if speed is None:
            assert found.proof.startswith("beam.width does not change ")
        else:
            assert ("rise or fall with each other number" if others else "are the same") in said
            assert said.startswith("No design was found that has ") and "does not prove" in said
    assert not bd.design(INWARD, THICKNESS, wanted).without_effect


@pytest.mark.parametrize(
    ("name", "bounds", "change"),
    [
        ("beam.youngs_modulus", (1e11, 3e11), {}),
        ("beam.density", (7000.0, 9000.0), {}),
        ("beam.tip.mass", (1e-4, 3e-3), {}),
        ("beam.thickness", (1e-4, 4e-4), {}),
        ("beam.length", (0.04, 0.06), {}),
        ("mount.root_stiffness", (0.1, 10.0), {"mount.root_stiffness": 1.0}),
    ],
)
def test_that_there_is_none_is_proven_where_each_mode_is_monotone(name, bounds, change):
    given = with_numbers(INWARD, {"beam.tip.mass": 1e-3} | change)
    ends = [bd.natural_modes(with_numbers(given, {name: x}), 0.0, 2).frequency[1] for x in bounds]
    for wanted in (
        bd.Target("frequencies", equals=1.01 * max(ends), mode=2),
        bd.Target("frequencies", at_most=0.99 * min(ends), mode=2),
    ):
        found = bd.design(given, {name: bounds}, [wanted])
        assert not found.found and found.proof.startswith(name)
        assert "It is proven" in " ".join(found.sentences())
        turning = bd.design(given, {name: bounds}, [replace(wanted, speed=30.0)])
        assert not turning.proof  # rotation adds what depends on the numbers in other ways


@pytest.mark.slow
def test_targets_that_are_met_are_mentioned_beside_those_that_are_missed_for_their_sake():
    apart = [bd.Target("frequencies", at_least=80.0), bd.Target("critical_speed", at_most=100.0)]
    for others in ([], [bd.Target("critical_speed", at_least=50.0)]):
        found = bd.design(INWARD, THICKNESS, [*apart, *others])
        assert found.why_none and found.met.tolist() == [False, False, *(True for _ in others)]
        said = " together with all other targets; the nearest found is "
        assert (said in found.sentences()[0]) == bool(others)


def test_a_number_may_raise_an_answer_of_some_designs_and_not_change_it_of_others():
    """The width does nothing to a strip alone, and stiffens it beside a tip mass."""
    free = {"beam.tip.mass": (0.0, 1e-3), "beam.width": (0.005, 0.02)}
    found = bd.design(INWARD, free, [bd.Target("frequencies", at_most=10.0)])
    assert found.proof.startswith("beam.tip.mass lowers and beam.width raises ")


def test_no_proof_hangs_on_rounding():
    """1.5 times 0.05 m is larger than 0.075 m by rounding alone."""
    near = replace(INWARD, mount=bd.Mount(0.075))
    assert near.mount.radius < 1.5 * 0.05
    found = bd.design(near, {"beam.length": (0.03, 0.05)}, [bd.Target("critical_speed", at_least=1e4)])
    assert found.proof


def test_nothing_is_proven_of_thickness_beside_a_spring_or_of_a_plate():
    wanted = [bd.Target("frequencies", equals=500.0)]
    soft = with_numbers(INWARD, {"mount.root_stiffness": 1.0})
    assert bd.design(INWARD, THICKNESS, wanted).proof
    for given in (soft, replace(INWARD, physics=bd.Physics(planes=2))):
        assert not bd.design(given, THICKNESS, wanted).proof


def test_nothing_is_proven_of_two_missed_targets_that_pull_apart_or_of_damping():
    apart = [bd.Target("frequencies", at_least=500.0), bd.Target("frequencies", at_most=60.0)]
    assert not bd.design(INWARD, THICKNESS, apart).proof
    wanted = [bd.Target("frequencies", at_most=5.0)]
    assert bd.design(INWARD, {"beam.density": (17e3, 60e3)}, wanted).proof
    damped = replace(INWARD, damping=bd.Damping(tip_damper=0.2))  # the first frequency rises with the density
    assert not bd.design(damped, {"beam.density": (17e3, 60e3)}, wanted).proof


def test_a_critical_speed_beyond_the_bounds_is_proven():
    """Inward from a radius of 0.215 m, rotation compresses all of the beam, the more the longer it is."""
    wanted = [bd.Target("critical_speed", at_least=1e3)]
    for tip in (None, bd.TipMass(1e-3)):
        given = replace(INWARD, beam=replace(INWARD.beam, tip=tip))
        found = bd.design(given, WIDE, wanted)
        assert found.proof == found.why_none.partition(", so that")[0]
        assert found.proof.startswith("beam.thickness raises and beam.length lowers the elastic energy")
    near = replace(given, mount=bd.Mount(0.06))  # a long beam passes the axis, where rotation stretches it
    assert not bd.design(near, WIDE, wanted).why_none


@pytest.mark.parametrize(
    ("free", "targets", "said"),
    [
        (
            THICKNESS,
            [bd.Target("frequencies", at_least=80.0), bd.Target("critical_speed", at_most=100.0)],
            "so that the critical speed is too high from beam.thickness = ",
        ),
        (
            WIDE,
            [bd.Target("frequencies", equals=70.0), bd.Target("frequencies", at_least=450.0, mode=2)],
            "frequency of mode 2 at least 450 Hz is 2.58 % above the largest by frequency of mode 1 = 70 Hz",
        ),
    ],
)
def test_that_there_is_none_is_proven_where_the_nearest_is_not(free, targets, said):
    """The ratio of the first two frequencies of a cantilever is 6.2669."""
    found = bd.design(INWARD, free, targets)
    assert not found.found and not found.proof and said in found.why_none
    assert "It is proven that no design meets all targets" in " ".join(found.sentences())


@pytest.mark.parametrize(
    ("tip", "radius", "wanted"), [(1e-3, 0.2, 57.0), (3e-4, 0.1, 78.5), (2e-3, 0.25, 67.7)]
)
def test_a_value_is_met_exactly_beside_the_best_of_another(tip, radius, wanted):
    """The last steps close what is missed when no more designs may be tried."""
    beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, tip=bd.TipMass(tip))
    free = {"beam.thickness": (1e-4, 5e-4), "beam.length": (0.03, 0.08), "beam.tip.mass": (1e-5, 4e-3)}
    best = bd.Target("critical_speed", best="largest")
    scene = bd.Scene(beam, bd.Mount(radius=radius))
    found = bd.design(scene, free, [bd.Target("frequencies", equals=wanted), best])
    assert found.found and found.solves <= 60
    np.testing.assert_allclose(found.reached[0], wanted, rtol=1e-10)


def test_of_designs_far_from_a_limit_the_nearest_is_found():
    """A thousand times less than is wanted: 0.4 mm, which is the thickest, has the most."""
    found = bd.design(INWARD, {"beam.thickness": (1e-4, 4e-4)}, [bd.Target("frequencies", at_least=1e5)])
    assert not found.found and found.value[0] == 4e-4


def test_an_answer_beyond_all_numbers_is_said_in_words():
    outward = bd.Scene(INWARD.beam, bd.Mount(radius=0.2, setting_angle=np.pi))
    found = bd.design(outward, THICKNESS, [bd.Target("critical_speed", equals=160.0)])
    assert "(there it does not buckle)" in found.sentences()[0]


def test_the_answer_follows_from_the_seed_alone():
    wanted = [bd.Target("frequencies", equals=80.0, speed=50.0), bd.Target("critical_speed", at_least=200.0)]
    values = [bd.design(INWARD, WIDE, wanted, seed=3).value for _ in range(2)]
    assert (values[0] == values[1]).all()


@pytest.mark.parametrize(
    ("free", "said"),
    [
        ({"speed": (1.0, 2.0)}, "no number of a scene"),
        ({"beam.thickness": (2e-4, 1e-4)}, "finite and ascending"),
        ({"beam.thickness": (1e-4, 1.0)}, "thickness"),
        ({"beam.thicknes": None}, "give beam.thickness"),
        ({}, "with their bounds"),
    ],
)
def test_wrong_numbers_are_refused(free, said):
    with pytest.raises(ValueError, match=said):
        bd.design(INWARD, free, [bd.Target("frequencies", equals=80.0)])


def test_wrong_targets_are_refused():
    for wrong, said in (
        ({}, "give one of equals"),
        ({"equals": 1.0, "at_most": 2.0}, "give one of equals"),
        ({"equals": -1.0}, "greater than 0"),
        ({"equals": 1.0, "line": "road +"}, "line"),
        ({"equals": 1.0, "window": (1.0, 2.0)}, "window"),
    ):
        with pytest.raises(ValueError, match=said):
            bd.Target("frequencies", **wrong)
    best = bd.Target("frequencies", best="largest")
    with pytest.raises(ValueError, match="only one answer can be required to be"):
        bd.design(INWARD, THICKNESS, [best, best])


def test_the_command_writes_the_scene_that_it_finds(tmp_path, capsys, finished):
    to = tmp_path / "found.toml"
    ask = ["design", SCENE, "--free", "length=30:60 mm", "--so-that"]
    assert "met" in finished(main([*ask, "frequency 1 at 10 rad/s = 80 Hz", "--write", str(to)]), 0).out
    found = bd.load_scene(to)
    np.testing.assert_allclose(bd.natural_modes(found, 10.0, 1).frequency, 80.0, rtol=1e-9)  # ten digits
    assert "beam" in tomllib.loads(to.read_text())
    assert main([*ask, "frequency 1 = 800 Hz"]) == 1
    assert "the nearest is beam.length = 30 mm" in " ".join(capsys.readouterr().out.split())
    assert "give e.g." in finished(main([*ask, "frequenzy 1 = 800 Hz"]), 2).err
