"""Physics "auto": what each analysis adds, what it says of it, and how it is given."""

from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli.commands import main
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.files.scenes import parse_scene
from beamdyn.modes.model_error.effect_choice import EffectSizes, choose_by, choose_for_motion
from beamdyn.scene.physics import PhysicsChoice
from tests.unit.toml_scenes import STRIP_TOML

EXAMPLES = Path(__file__).parents[2] / "examples"
LARGE, SHEAR, ROTARY = "large deflection", "shear deformation", "rotary inertia of sections"
SECOND, STRETCH, CAMBER = "second plane of bending", "stretch", "camber of sections"

# With Poisson's ratio 0 sections do not camber.
STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.0)
STOCKY = bd.Beam.rectangular(0.05, 0.01, 0.002, 200e9, 7850.0, poissons_ratio=0.0)
STEEL = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
TWISTED = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3, twist=0.3)
INWARD, LEANING = bd.Mount(0.215), bd.Mount(0.215, math.radians(45))
ROLLING = bd.RollingWheel(0.3, bd.SpinUp(40.0, 1.0), bd.RoadWave(0.3, 0.01))


def choice_of(result: object) -> PhysicsChoice:
    choice = getattr(result, "physics_choice", None)
    assert isinstance(choice, PhysicsChoice)
    return choice


# What modes add -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("beam", "mount", "included"),
    [
        (STRIP, INWARD, set()),
        (STRIP, LEANING, {LARGE}),
        (STOCKY, INWARD, {SHEAR, ROTARY}),
    ],
)
def test_what_matters_is_added_and_nothing_else(beam: bd.Beam, mount: bd.Mount, included: set[str]) -> None:
    modes = bd.natural_modes(bd.Scene(beam, mount, physics="auto"), 100.0)
    choice = choice_of(modes)
    assert {*choice.included} == included
    assert choice.is_met
    assert (modes.model_error <= 1e-3).all()
    assert not modes.warnings
    assert not modes.scene.chooses_physics
    assert all(effect.size > 1e-4 for effect in choice.effects if effect.included)


def test_camber_of_steel_is_added_and_what_models_miss_of_it_is_said() -> None:
    """A twentieth of what camber changes is not sure beside solids: 1 % is kept by it, 0.1 % is not."""
    scene = bd.Scene(STEEL, INWARD, physics="auto")
    fine, coarse = (bd.natural_modes(scene, 100.0, tolerance=t) for t in (1e-3, 1e-2))
    for modes in (fine, coarse):
        assert choice_of(modes).included == (CAMBER,)
        assert (modes.model_error <= 1e-3).all()
        size = choice_of(modes).effects[0].size
        assert 0.05 * size <= choice_of(modes).beyond_models < 0.1 * size
    assert any("is not met" in text and "strain by rotation may change" in text for text in fine.warnings)
    assert choice_of(coarse).is_met
    assert not coarse.warnings


def test_modes_of_torsion_are_named_and_not_added() -> None:
    """Torsion changes no frequency of a straight strip."""
    modes = bd.natural_modes(bd.Scene(STEEL, INWARD, physics="auto"), 100.0)
    assert not modes.scene.physics.torsion
    (torsion,) = modes.left_out_effects.unlisted
    assert torsion.kind == "torsion"
    assert modes.frequency[1] < torsion.frequency < modes.frequency[2]


def test_camber_of_a_twisted_strip_is_bounded_and_keeps_the_tolerance_from_being_met() -> None:
    modes = bd.natural_modes(bd.Scene(TWISTED, INWARD, physics="auto"), 100.0)
    choice = choice_of(modes)
    assert choice.included == ("twist",)
    assert not choice.is_met
    assert not choice.not_known
    (warning,) = modes.warnings
    assert "it is estimated as if no section cambered, which is the most" in warning
    (reason,) = (effect.reason for effect in bd.terms(modes.scene).left_out if effect.name == CAMBER)
    assert reason.endswith("camber and torsion of a twisted strip are not modelled")  # and no option is named


def test_the_answer_is_that_of_the_physics_given() -> None:
    """To the bit: the choice changes nothing but the physics."""
    scene = bd.Scene(STOCKY, LEANING, damping_ratio=0.01, physics="auto")
    chosen = bd.natural_modes(scene, 100.0)
    given = bd.natural_modes(replace(scene, physics=chosen.scene.physics), 100.0)
    np.testing.assert_array_equal(chosen.eigenvalue, given.eigenvalue)
    assert given.physics_choice is None
    assert chosen.scene == given.scene  # how it was chosen is no part of the scene


def test_the_tolerance_decides() -> None:
    scene = bd.Scene(STOCKY, INWARD, physics="auto")
    loose, tight = (bd.natural_modes(scene, 100.0, tolerance=t) for t in (0.1, 1e-5))
    assert choice_of(loose).included == ()
    assert {SHEAR, ROTARY} <= {*choice_of(tight).included}
    assert (choice_of(loose).tolerance, choice_of(tight).tolerance) == (0.1, 1e-5)


def test_a_locus_is_judged_at_its_fastest_speed_too() -> None:
    """At rest the strip is straight, at 100 rad/s it is bent."""
    scene = bd.Scene(STRIP, LEANING, physics="auto")
    assert choice_of(bd.natural_modes(scene, 0.0)).included == ()
    locus = bd.frequency_locus(scene, [0.0, 10.0, 100.0])
    assert choice_of(locus).included == (LARGE,)
    assert choice_of(locus).speeds == (0.0, 10.0, 100.0)
    np.testing.assert_allclose(  # the sums of two models of different size
        locus.frequency[-1], bd.natural_modes(scene, 100.0).frequency, rtol=1e-9
    )


def test_what_the_beam_lacks_is_named_and_not_assumed() -> None:
    silent = bd.Beam.rectangular(0.05, 0.01, 0.002, 200e9, 7850.0)
    modes = bd.natural_modes(bd.Scene(silent, INWARD, physics="auto"), 100.0)
    choice = choice_of(modes)
    assert choice.included == (ROTARY,)
    assert not choice.is_met
    assert any("the effect of shear deformation, left out, is 1.5 %" in text for text in modes.warnings)
    bare = bd.Beam.from_stiffness(1.0, 1.0, 10.0)
    modes = bd.natural_modes(bd.Scene(bare, INWARD, physics="auto"), 0.1)
    assert choice_of(modes).not_known[SHEAR] == "give shear_stiffness"
    assert any("shear deformation (give shear_stiffness)" in text for text in modes.warnings)


SOFT = replace(STRIP, shear_stiffness=STRIP.shear_stiffness and STRIP.shear_stiffness.scaled(0.02))


@pytest.mark.parametrize("speed", [100.0, 40.0])
def test_large_deflection_and_shear_are_both_included(speed: float) -> None:
    choice = choice_of(bd.natural_modes(bd.Scene(SOFT, LEANING, physics="auto"), speed))
    assert {*choice.included} == {LARGE, SHEAR}
    assert choice.is_met


def test_a_motion_has_large_deflection_in_one_plane_alone_and_the_smaller_error_is_left_and_said() -> None:
    """Large deflection and shear exclude each other there."""
    scene = bd.Scene(SOFT, LEANING, physics="auto")
    for speed, taken, other in ((100.0, LARGE, SHEAR), (40.0, SHEAR, LARGE)):
        choice = choice_of(choose_for_motion(scene, np.array([speed]), 3, 1e-3))
        sizes = {effect.name: effect.size for effect in choice.effects}
        assert taken in choice.included
        assert other not in choice.included
        assert 1e-3 < sizes[other] < sizes[taken]
        assert not choice.is_met
        assert any("in one plane:" in effect.reason for effect in choice.effects if effect.name == other)


def test_an_oblique_direction_has_large_deflection_in_modes_and_not_in_motions() -> None:
    scene = bd.Scene(STRIP, replace(LEANING, bending_angle=0.3), physics="auto")
    modes = bd.natural_modes(scene, 100.0)
    assert LARGE in choice_of(modes).included
    assert choice_of(modes).is_met
    assert LARGE not in choice_of(choose_for_motion(scene, np.array([100.0]), 3, 1e-3)).included


def test_an_effect_that_turns_modes_into_others_is_added() -> None:
    """Sections turned by 0.5 to 1.5 rad: the second mode of one plane is in neither direction mostly."""
    twist = np.polynomial.Polynomial([0.5, 1.0])
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=25.0, twist=twist)
    choice = choice_of(bd.natural_modes(bd.Scene(beam, physics="auto"), 0.0, 2))
    assert choice.physics.planes == 2
    assert (choice.effects[0].name, choice.effects[0].size) == ("twist", math.inf)
    assert choice.is_met


def test_where_no_mode_vibrates_nothing_is_added_and_all_is_said_not_to_be_known() -> None:
    scene = bd.Scene(STRIP, INWARD)
    speed = 1.1 * bd.critical_speed(scene)
    choice = choice_of(bd.natural_modes(replace(scene, physics="auto"), speed, 1))
    assert choice.included == ()
    assert {*choice.not_known} == {SHEAR, ROTARY, SECOND, STRETCH, CAMBER, LARGE}
    assert "no mode vibrates" in choice.not_known[SHEAR]


def test_costs_are_measured() -> None:
    choice = choice_of(bd.natural_modes(bd.Scene(STOCKY, INWARD, physics="auto"), 100.0))
    shear, rotary = choice.effects[:2]
    assert (shear.name, rotary.name) == (SHEAR, ROTARY)
    assert shear.coordinates == 2.0  # one more field
    assert rotary.coordinates == 1.0  # one more term
    assert min(shear.time, rotary.time, choice.time) > 0
    assert math.isnan(choice.effects[-1].time)
    assert "times the time" in choice.sentence()


# The order of the choice, with given sizes --------------------------------------------------------


@pytest.mark.parametrize(
    ("sizes", "included"),
    [
        ({SHEAR: 2e-3, ROTARY: 2e-5}, (SHEAR,)),
        ({SHEAR: 4e-4, ROTARY: 3e-4}, (SHEAR,)),  # together above half the tolerance
        ({SHEAR: 3e-4, ROTARY: 1e-4}, ()),
        ({SHEAR: 9e-5, ROTARY: 9e-5, STRETCH: 9e-5, SECOND: 9e-5}, ()),
        ({SECOND: math.inf}, (SECOND,)),
        ({LARGE: 0.1, SHEAR: 1e-4}, (LARGE,)),
        ({LARGE: 0.1, ROTARY: 0.01}, (LARGE, ROTARY)),
        ({LARGE: 0.1, SHEAR: 0.2}, (SHEAR, LARGE)),
        ({LARGE: math.nan, SHEAR: 0.2}, (SHEAR,)),
        ({LARGE: 2e-4, SHEAR: 2e-4}, ()),
    ],
)
def test_the_rule(sizes: dict[str, float], included: tuple[str, ...]) -> None:
    """The largest first, until those that are left are worth half of 1e-3, and none below 1e-4."""
    every = {SHEAR: 0.0, ROTARY: 0.0, STRETCH: 0.0, SECOND: 0.0, LARGE: 0.0} | sizes

    def judge(scene: bd.Scene) -> EffectSizes:
        return EffectSizes(dict(every), {})

    scene = bd.Scene(STRIP, physics="auto")
    chosen = choose_by(scene, judge, lambda _: 1, 1e-3, np.array([1.0]))
    assert choice_of(chosen).included == included


@pytest.mark.parametrize("unknown", [SECOND, SHEAR])
def test_a_size_that_is_not_known_adds_nothing(unknown: str) -> None:
    """Wherever it stands among the others, which are added by their own."""
    every = {SECOND: 0.0, ROTARY: 0.2, SHEAR: 0.0, STRETCH: 0.0, LARGE: 0.0} | {unknown: math.nan}

    def judge(scene: bd.Scene) -> EffectSizes:
        return EffectSizes(dict(every), {unknown: "not resolved"})

    chosen = choose_by(bd.Scene(STRIP, physics="auto"), judge, lambda _: 1, 1e-3, np.array([1.0]))
    assert choice_of(chosen).included == (ROTARY,)


def test_what_an_effect_brings_up_is_added_after_it() -> None:
    """With the second plane come modes in which shear matters."""

    def judge(scene: bd.Scene) -> EffectSizes:
        shear = 0.1 if scene.physics.planes == 2 else 0.0
        return EffectSizes({SECOND: 0.2, SHEAR: shear, LARGE: 0.0}, {})

    chosen = choose_by(bd.Scene(STRIP, physics="auto"), judge, lambda _: 1, 1e-3, np.array([1.0]))
    assert chosen.physics == bd.Physics(planes=2, shear=True)


# The other analyses -------------------------------------------------------------------------------


def test_motions_are_chosen_for_by_their_frequencies() -> None:
    scene = bd.Scene(STOCKY, INWARD, ROLLING, damping_ratio=0.02, physics="auto")
    with_shear = bd.Physics(shear=True, rotary_inertia=True)
    run = bd.simulate(scene, 0.2, modes=2)
    assert run.scene.physics == with_shear
    given = bd.simulate(replace(scene, physics=with_shear), 0.2, modes=2)
    np.testing.assert_array_equal(run.tip, given.tip)
    assert choice_of(run).tolerance == 1e-3  # 1e-5 is the default of the numerical errors
    assert bd.steady_response(scene, [30.0], modes=2).scene.physics == with_shear
    assert bd.resonance_speeds(scene, 150.0, modes=2).scene.physics == with_shear


def test_every_motion_of_a_beam_that_rotation_bends_is_one_of_large_deflection() -> None:
    rolling = bd.RollingWheel(0.3, bd.SpinUp(60.0, 0.01), bd.RoadWave(0.3, 0.01))
    scene = bd.Scene(STRIP, LEANING, rolling, physics="auto")
    answers = (
        bd.simulate(scene, 0.01, modes=1),
        bd.sweep(scene, [60.0], (0.0, 0.01), modes=1),
        bd.steady_response(scene, [60.0], modes=1),
        bd.resonance_speeds(scene, 60.0, modes=1),
    )
    assert [answer.scene.physics for answer in answers] == 4 * [bd.Physics(large_deflection=True)]


def test_a_sweep_is_stored_under_the_same_keys_each_time(tmp_path: Path) -> None:
    """The measured times of the choice are no part of the request."""
    scene = bd.Scene(STOCKY, INWARD, ROLLING, physics="auto")
    runs, files = [], []
    for _ in range(2):
        runs.append(bd.sweep(scene, [20.0, 30.0], (0.1, 0.2), modes=1, store=tmp_path))
        files.append({*tmp_path.iterdir()})
    first, again = runs
    assert files[0] == files[1]
    np.testing.assert_array_equal(first.peaks, again.peaks)
    assert SHEAR in choice_of(first).included


ROUGH = bd.RollingWheel(
    0.3, bd.SpinUp(40.0, 0.1), bd.RoadWave(0.3, 0.4)
)  # the road shakes the strip by a twentieth of its length


def test_a_run_that_bends_the_beam_is_repeated_with_large_deflection() -> None:
    """Rotation does not bend the strip that points at the axis, the road does."""
    scene = bd.Scene(STRIP, INWARD, ROUGH, damping_ratio=0.05, physics="auto")
    run = bd.simulate(scene, 0.3, modes=1)
    assert choice_of(run).included == (LARGE,)
    straight, bent = (
        bd.simulate(replace(scene, physics=physics), 0.3, modes=1)
        for physics in (bd.Physics(), bd.Physics(large_deflection=True))
    )
    assert (straight.largest / 0.05) ** 2 > 5e-4
    np.testing.assert_array_equal(run.tip, bent.tip)


def test_a_sweep_says_what_large_deflection_may_change() -> None:
    scene = bd.Scene(STRIP, INWARD, ROUGH, damping_ratio=0.05, physics="auto")
    swept = bd.sweep(scene, [40.0], (0.0, 0.3), modes=1)
    assert choice_of(swept).included == ()
    assert any("not met at the largest deflection" in text for text in swept.warnings)


def test_a_critical_speed_is_chosen_for_by_those_with_each_effect() -> None:
    thick = bd.critical_point(bd.Scene(STOCKY, INWARD, physics="auto"))
    assert choice_of(thick).included == (SHEAR,)
    given = bd.critical_point(bd.Scene(STOCKY, INWARD, physics=bd.Physics(shear=True)))
    assert thick.speed == given.speed
    easy, stiff = STRIP.bending_stiffness, STRIP.second_bending_stiffness
    assert stiff is not None
    across = replace(STRIP, bending_stiffness=stiff, second_bending_stiffness=easy)
    lower = bd.Scene(across, INWARD, physics="auto")
    point = bd.critical_point(lower)
    assert point.speed == bd.critical_point(replace(lower, physics=point.scene.physics)).speed
    assert SECOND in choice_of(point).included  # out of the plane it buckles first
    assert point.speed < 0.5 * bd.critical_speed(replace(lower, physics=bd.Physics()))


def test_what_does_not_choose_takes_the_plain_beam_and_says_so() -> None:
    scene = bd.Scene(STOCKY, INWARD, physics="auto")
    bounds, plain = bd.frequency_bounds(scene, 10.0), replace(scene, physics=bd.Physics())
    np.testing.assert_array_equal(bounds.lower, bd.frequency_bounds(plain, 10.0).lower)
    assert "that of the plain beam" in bounds.warnings[0]


def test_a_curved_beam_is_no_plain_one() -> None:
    strip = bd.Beam.rectangular(1.0, 0.02, 0.01, 200e9, 7850.0, sweep=np.polynomial.Polynomial([0.0, 0.3]))
    scene = bd.Scene(strip, bd.Mount(0.2, np.pi), physics="auto")
    modes = bd.natural_modes(scene, 5.0, 1, tolerance=0.1)
    assert modes.physics_choice is not None
    assert "curved beam in space" in modes.physics_choice.sentence()


def test_limits_and_loads_choose_for_the_straight_beam() -> None:
    scene = bd.Scene(STOCKY, INWARD, physics="auto")
    for found in (bd.setting_angle_limits(scene, 100.0), bd.static_loads(scene, 100.0, at=[0.0])):
        assert found.physics_choice is not None
        given = replace(scene, physics=found.physics_choice.physics)
        assert not given.physics.large_deflection
    assert bd.static_loads(given, 100.0, at=[0.0]).strain == pytest.approx(found.strain, rel=1e-12)


def test_terms_are_those_of_the_plain_beam_and_say_that_analyses_choose() -> None:
    scene = bd.Scene(STOCKY, INWARD, physics="auto")
    listed = bd.terms(scene)
    assert listed.present == bd.terms(replace(scene, physics=bd.Physics())).present
    reasons = {effect.name: effect.reason for effect in listed.left_out}
    assert 'physics is "auto"' in reasons[SHEAR]
    assert "auto" not in reasons["torsion"]


# How it is given and kept -------------------------------------------------------------------------

TOML = STRIP_TOML + '[mount]\nradius = "215 mm"\nsetting_angle = "45 deg"\n'


def test_the_word_is_read_from_a_file() -> None:
    for text in ('physics = "auto"\n' + TOML, TOML + "[physics]\nauto = true\n"):
        assert parse_scene(text).chooses_physics
    assert not parse_scene(TOML).chooses_physics
    with pytest.raises(ValueError, match='physics = "automatic": give "auto", or a table'):
        parse_scene('physics = "automatic"\n' + TOML)
    with pytest.raises(ValueError, match=r"physics.shear = true: physics is auto"):
        parse_scene(TOML + "[physics]\nauto = true\nshear = true\n")


def test_other_words_are_refused() -> None:
    with pytest.raises(InvalidValue, match='give "auto", or a Physics such as Physics'):
        bd.Scene(STRIP, physics="all")  # pyright: ignore[reportArgumentType]


def test_a_choice_does_not_outlive_its_physics() -> None:
    scene = bd.natural_modes(bd.Scene(STOCKY, physics="auto")).scene
    assert scene.physics_choice is not None
    assert replace(scene, damping_ratio=0.01).physics_choice is scene.physics_choice
    assert replace(scene, physics=bd.Physics()).physics_choice is None
    assert replace(scene, physics="auto").chooses_physics


def test_results_keep_how_it_was_chosen(tmp_path: Path) -> None:
    modes = bd.natural_modes(bd.Scene(STOCKY, INWARD, physics="auto"), 100.0)
    modes.save(tmp_path / "modes.json")
    for kept in (bd.load(tmp_path / "modes.json"), pickle.loads(pickle.dumps(modes))):
        assert kept.physics_choice.sentence() == choice_of(modes).sentence()
    stored = json.loads((tmp_path / "modes.json").read_text())["physics_choice"]
    assert [e["name"] for e in stored["effects"] if e["included"]] == [SHEAR, ROTARY]
    assert stored["not_modelled"][0] == "offsets of sections"


def test_commands_take_the_word_in_place_of_the_physics_of_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(TOML)
    assert main(["modes", str(file), "--speed", "100 rad/s", "--physics", "auto"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert 'physics "auto", tolerance 0.001: large deflection (9.1 %;' in printed
    assert main(["modes", str(file), "--physics", "all"]) == 2


def test_a_curved_axis_is_a_beam_in_space_from_the_start() -> None:
    strip = bd.Beam.rectangular(
        0.9,
        0.025,
        0.0016,
        73e9,
        2682.0,
        poissons_ratio=0.33,
        sweep=bd.Table([0, 0.8, 0.8, 1], [0, 0, 0.3, 0.3]),
    )
    scene = bd.Scene(strip, bd.Mount(0.06, np.pi, np.pi / 2), physics="auto")
    chosen = bd.natural_modes(scene, 10.0, 2, tolerance=0.01)
    physics = chosen.scene.physics
    assert (physics.planes, physics.torsion, physics.large_deflection) == (2, True, True)
    assert chosen.physics_choice is not None
    given = bd.natural_modes(replace(scene, physics=physics), 10.0, 2, tolerance=0.01)
    np.testing.assert_allclose(chosen.frequency, given.frequency, rtol=1e-6)


def test_a_beam_of_section_matrices_is_a_beam_in_space_from_the_start() -> None:
    """The matrices couple all strains: there is no simpler physics to begin with."""
    scene = bd.load_scene(EXAMPLES / "iea_15_blade.toml")
    given, chosen = (bd.natural_modes(s, 0.8, 2) for s in (scene, replace(scene, physics="auto")))
    assert chosen.scene.physics == scene.physics
    np.testing.assert_allclose(chosen.frequency, given.frequency, rtol=1e-12)  # the same model


@pytest.mark.slow
@pytest.mark.parametrize(("name", "speed"), [("iea_15_blade", 0.8), ("swept_blade", 78.5)])
def test_equilibria_of_a_beam_that_straight_equations_refuse_begin_in_space(name: str, speed: float) -> None:
    """A swept blade that bends in one plane alone has another deflection."""
    scene = bd.load_scene(EXAMPLES / f"{name}.toml")
    given, chosen = (bd.equilibrium(s, speed) for s in (scene, replace(scene, physics="auto")))
    assert chosen.scene.physics.torsion
    np.testing.assert_allclose(chosen.tip, given.tip, rtol=0, atol=given.error)


@pytest.mark.parametrize("name", ["iea_15_blade", "swept_blade"])
def test_terms_of_a_beam_that_straight_equations_refuse_are_listed(name: str) -> None:
    scene = replace(bd.load_scene(EXAMPLES / f"{name}.toml"), physics="auto")
    left_out = {effect.name: effect.reason for effect in bd.terms(scene).left_out}
    assert left_out[LARGE].endswith("an analysis adds the effect where it matters")


@pytest.mark.parametrize(
    "name, needing", [("swept_blade", "sweep"), ("iea_15_blade", "prebend and matrices")]
)
def test_analyses_of_straight_beams_say_what_of_the_beam_needs_large_deflection(
    name: str, needing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = replace(bd.load_scene(EXAMPLES / f"{name}.toml"), physics="auto", gravity=9.81)
    scene = replace(scene, motion=bd.SteadyRotation(1.0))
    # They are refused before the beam in space is made, whose equilibria take minutes.
    monkeypatch.setattr("beamdyn.equations.beam_in_space.rotating_beam.assemble_beam_in_space", None)
    for analysis in (
        lambda: bd.frequency_response(scene, 1.0, [1.0]),
        lambda: bd.matrices(scene, 1.0),
        lambda: bd.static_loads(scene, 1.0),
        lambda: bd.setting_angle_limits(scene, 1.0),
        lambda: bd.frequency_bounds(scene, 1.0),
        lambda: bd.floquet_multipliers(scene),
        lambda: bd.frequency_sensitivities(scene, 1.0),
        lambda: bd.critical_speed_sensitivities(scene),
        lambda: bd.crossing_sensitivities(scene, 1.0),
        lambda: bd.identify(scene, bd.MeasuredFrequencies([1.0]), {"mount.radius": None}),
    ):
        with pytest.raises(InvalidValue, match=f"; describe the beam without {needing}(, or|$)"):
            analysis()


def test_motions_of_a_curved_beam_are_those_of_the_beam_in_space() -> None:
    scene = replace(bd.load_scene(EXAMPLES / "swept_blade.toml"), physics="auto")
    found = bd.simulate(scene, t_end=0.01, modes=1)
    assert found.scene.bends_in_space and choice_of(found).physics.torsion
