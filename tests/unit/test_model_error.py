"""What results and commands say of the physics that their model leaves out."""

from __future__ import annotations

import json
import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import beamdyn as bd
from beamdyn.cli.commands import main
from beamdyn.common.edge.console import set_apart, table
from beamdyn.common.edge.rendering import html
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.words import count_sure
from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.modes.model_error.added_effects import shift_eigenvalues
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, say_change
from tests.conftest import Finished

STRIP = bd.Beam.rectangular(0.5, 0.06, 0.03, 200e9, 7850.0, poissons_ratio=0.3)
OUTWARD = bd.Mount(0.2, math.pi, math.pi / 2)
SCENE = bd.Scene(STRIP, OUTWARD)
NONE = np.zeros((2, 2))
NEVER = ("offsets of sections", "contact")

FILE = """
[beam]
length = "0.5 m"
width = "60 mm"
thickness = "30 mm"
youngs_modulus = "200 GPa"
density = "7850 kg/m3"

[mount]
radius = "200 mm"
setting_angle = "180 deg"
bending_angle = "90 deg"
"""


# What is stated -----------------------------------------------------------------------------------


def test_model_error_is_the_size_of_the_sum() -> None:
    modes = bd.natural_modes(SCENE, 100.0)
    total = sum(modes.left_out.values())
    assert modes.model_error.shape == (3,)
    np.testing.assert_array_equal(modes.model_error, np.abs(total))
    with pytest.raises(TypeError):
        modes.left_out["shear deformation"] = np.zeros(3)  # pyright: ignore[reportIndexIssue]


def test_nothing_is_left_out_of_what_is_modelled() -> None:
    physics = bd.Physics(2, shear=True, rotary_inertia=True, stretch=True, camber=True, torsion=True)
    modes = bd.natural_modes(replace(SCENE, physics=physics), 100.0)
    assert {*modes.left_out} == {"large deflection"}
    assert modes.left_out_effects.not_modelled == NEVER
    assert modes.left_out_effects.unlisted == ()


@pytest.mark.parametrize("load", [bd.TipLoad(), bd.TipLoad((0.0, 0.0, 1.0))])
def test_torsion_of_a_bent_twisted_strip_is_modelled(load: bd.TipLoad) -> None:
    """That of the straight strip, on which effects are judged, is not."""
    physics = bd.Physics(2, torsion=True, large_deflection=True)
    beam = bd.Beam.rectangular(0.5, 0.06, 0.03, 200e9, 7850.0, poissons_ratio=0.3, twist=0.2)
    scene = bd.Scene(beam, OUTWARD, physics=physics, tip_load=load)
    assert bd.natural_modes(scene, 10.0, 1, tolerance=1e-3).left_out_effects.not_modelled == NEVER


def test_what_the_beam_lacks_is_named() -> None:
    beam = bd.Beam.from_stiffness(1.0, 1.0, 10.0)
    effects = bd.natural_modes(bd.Scene(beam, OUTWARD), 1.0).left_out_effects
    assert effects.not_known == {
        "shear deformation": "give shear_stiffness",
        "rotary inertia of sections": "give rotary_inertia",
        "camber of sections": "give the sides of a rectangular section",
        "stretch": "give axial_stiffness",
        "second plane of bending": "give second_bending_stiffness",
    }
    assert effects.not_modelled == ("torsion", *NEVER)
    assert "not known: second plane of bending (give second_bending_stiffness)" in effects.sentence()


def with_ratio(ratio: float | None) -> bd.Beam:
    """The strip with another Poisson's ratio, or with none."""
    return bd.Beam.rectangular(0.5, 0.06, 0.03, 200e9, 7850.0, poissons_ratio=ratio)


def test_shear_and_camber_of_a_rectangle_are_estimated_by_assumed_ratios_which_are_said() -> None:
    """Shear hardly depends on it, and has the usual one; camber grows with it from 0, and has the largest."""
    assumed, given, largest = (
        bd.natural_modes(bd.Scene(with_ratio(ratio), OUTWARD), 100.0) for ratio in (None, 0.3, 0.5)
    )
    shear, camber = "shear deformation", "camber of sections"
    np.testing.assert_allclose(assumed.left_out[shear], given.left_out[shear], rtol=1e-12)  # the same sums
    np.testing.assert_allclose(assumed.left_out[camber], largest.left_out[camber], rtol=1e-12)
    assert assumed.left_out_effects.assumed == {
        shear: "with Poisson's ratio 0.3 assumed",
        camber: "with Poisson's ratio 0.5, as none is given; 0 % with ratio 0",
    }
    for said in assumed.left_out_effects.assumed.values():
        assert said in assumed.left_out_effects.sentence()
    assert not given.left_out_effects.assumed


def test_camber_changes_nothing_without_poissons_ratio() -> None:
    modes = bd.natural_modes(bd.Scene(with_ratio(0.0), OUTWARD), 100.0)
    np.testing.assert_allclose(modes.left_out["camber of sections"], 0.0, atol=1e-9)


def test_modes_that_the_model_does_not_have_are_named_below_its_highest() -> None:
    """Of the other direction, by the ratio of the sides; of torsion, by Saint-Venant's formula for 2:1."""
    modes = bd.natural_modes(bd.Scene(STRIP, OUTWARD), 0.0)
    unlisted = {(mode.kind, mode.number): mode for mode in modes.left_out_effects.unlisted}
    assert {*unlisted} == {("edge", 1), ("edge", 2), ("torsion", 1)}
    slender = 0.06 / 0.03 * modes.frequency[0]
    assert 0.98 * slender < unlisted["edge", 1].frequency < slender  # less by shear and rotary inertia
    shear_modulus, constant = 200e9 / 2.6, 0.229 * 0.06 * 0.03**3  # Timoshenko and Goodier, 2:1
    polar = 7850.0 * 0.06 * 0.03 * (0.06**2 + 0.03**2) / 12
    free = math.sqrt(shear_modulus * constant / polar) / (4 * 0.5)
    assert free < unlisted["torsion", 1].frequency < 1.02 * free  # more, as the root does not warp
    assert modes.frequency[2] > unlisted["torsion", 1].frequency
    lowest = bd.natural_modes(bd.Scene(STRIP, OUTWARD), 0.0, modes=1)
    assert lowest.left_out_effects.unlisted == ()


def test_sections_that_are_no_rectangles_are_not_assumed_to_be() -> None:
    beam = replace(STRIP, shear_stiffness=None, outer_fibre=STRIP.outer_fibre and STRIP.outer_fibre.scaled(2))
    assert "shear deformation" in bd.natural_modes(bd.Scene(beam, OUTWARD)).left_out_effects.not_known


def test_modes_without_a_frequency_are_not_judged() -> None:
    """A free turn has the frequency 0, and a mode past the critical speed has none."""
    hinge = bd.natural_modes(replace(SCENE, mount=bd.Mount(0.0, math.pi, 0.0, root_stiffness=0.0)), 0.0)
    assert np.isnan(hinge.left_out["shear deformation"][0])
    assert np.isfinite(hinge.left_out["shear deformation"][1:]).all()
    scene = bd.Scene(replace(STRIP, axial_stiffness=None), bd.Mount(1.0))
    unstable = bd.natural_modes(scene, 1.1 * bd.critical_speed(scene))
    assert unstable.status[0] == "divergence"
    assert np.isnan(unstable.model_error[0])


def test_where_nothing_loads_the_straight_beam_large_deflection_changes_nothing() -> None:
    np.testing.assert_array_equal(bd.natural_modes(SCENE, 100.0).left_out["large deflection"], 0.0)
    trailing = replace(SCENE, mount=bd.Mount(0.2, math.pi / 2))
    np.testing.assert_array_equal(bd.natural_modes(trailing, 0.0).left_out["large deflection"], 0.0)


HARVESTER = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.0)  # no camber


@pytest.mark.parametrize(
    "physics", [bd.Physics(), bd.Physics(stretch=True), bd.Physics(shear=True, rotary_inertia=True)]
)
def test_large_deflection_is_solved(physics: bd.Physics) -> None:
    """Where it cannot be combined, the plain beam stands for it: to the 1e-4 that the rest is worth."""
    beam = replace(HARVESTER, shear_stiffness=HARVESTER.axial_stiffness)
    scene = bd.Scene(beam, bd.Mount(0.215, math.radians(45)), physics=physics)
    bent = bd.natural_modes(replace(scene, physics=bd.Physics(large_deflection=True)), 100.0)
    straight = bd.natural_modes(replace(scene, physics=bd.Physics()), 100.0)
    true = bent.frequency / straight.frequency - 1
    found = bd.natural_modes(scene, 100.0)
    assert true[0] > 0.09  # 55.62 Hz in place of 60.66
    np.testing.assert_allclose(found.left_out["large deflection"], true, rtol=2e-4)
    assert "large deflection +9.1 % (mode 1)" in found.left_out_effects.sentence()


def test_large_deflection_that_cannot_be_solved_makes_the_model_error_unknown() -> None:
    """A second plane; a hinge; a straight beam that has buckled."""
    mount, buckled = bd.Mount(0.215, math.radians(45)), bd.Scene(HARVESTER, bd.Mount(0.215))
    cases = {
        "two planes": (bd.Scene(HARVESTER, mount, physics=bd.Physics(planes=2)), 100.0),
        "hinge": (bd.Scene(HARVESTER, replace(mount, root_stiffness=0.0)), 10.0),
        "unstable": (buckled, 1.2 * bd.critical_speed(buckled)),
    }
    for reason, (scene, speed) in cases.items():
        modes = bd.natural_modes(scene, speed)
        assert np.isnan(modes.model_error).all()
        assert reason in modes.left_out_effects.not_known["large deflection"]


def test_about_the_bent_beam_other_effects_are_those_of_the_straight_one() -> None:
    scene = bd.Scene(HARVESTER, bd.Mount(0.215, math.radians(45)))
    bent = bd.natural_modes(replace(scene, physics=bd.Physics(large_deflection=True)), 100.0)
    straight = bd.natural_modes(scene, 100.0)
    assert "large deflection" not in bent.left_out
    name = "rotary inertia of sections"
    np.testing.assert_allclose(bent.left_out[name], straight.left_out[name], rtol=1e-6)
    assert bent.left_out_effects.assumed[name] == "as of the straight beam"
    assert "planes=2" in bent.left_out_effects.reasons["second plane of bending"]
    assert "rotary_inertia=True" in bent.left_out_effects.reasons[name]


def test_effects_on_a_bent_run_are_not_the_change_by_bending() -> None:
    """Nothing moves an untwisted beam out of its plane; it bends by a tenth less than the straight one."""
    mount = bd.Mount(0.215, math.radians(45))
    scene = bd.Scene(HARVESTER, mount, bd.SpinUp(60.0, 0.1), physics=bd.Physics(large_deflection=True))
    run = bd.simulate(scene, 0.2, modes=1)
    straight = bd.simulate(replace(scene, physics=bd.Physics()), 0.2, modes=1)
    assert abs(run.largest / straight.largest - 1) > 1e-3
    assert abs(run.left_out["second plane of bending"]) < 1e-9  # of the frequency, which is the same sum
    assert abs(run.left_out["stretch"]) < 1e-5  # of the strain, 1e-6


def test_why_a_bent_mode_is_not_judged_is_said() -> None:
    scene = bd.Scene(HARVESTER, bd.Mount(0.215))
    bent = replace(scene, physics=bd.Physics(large_deflection=True, branch="bent"))
    effects = bd.natural_modes(bent, 1.2 * bd.critical_speed(scene)).left_out_effects
    assert np.isnan(effects.total[0])
    assert "stretch (estimated for the straight beam, which is unstable)" in effects.sentence()
    assert len([*effects.warnings()]) == 1


def test_locus_knows_its_model_error_up_to_the_last_stable_speed() -> None:
    """At 161 speeds, of which 16 are evenly spread, and past the critical speed nowhere."""
    scene = bd.Scene(HARVESTER, bd.Mount(0.215))
    locus = bd.frequency_locus(scene, np.linspace(0.0, 200.0, 161), 2)
    header, *rows = rows_of(locus)
    stable = (locus.status == "stable").all(axis=1)
    assert 100 < stable.sum() < 160
    error = np.array([row[header.index("model_error_1")] for row in rows], dtype=float)
    np.testing.assert_array_equal(np.isfinite(error), stable)
    said = locus.left_out_effects.sentence(where="at 1 rad/s", speeds=locus.left_out_speeds)
    first = locus.speeds[~stable][0]
    assert f"bends it; at {first:g} to 200 rad/s)" in said
    assert locus.to_dict()["warnings"][-1].startswith(f"at {first:g} to 200 rad/s the model error may exceed")
    screen = Console(width=120)
    with screen.capture() as capture:
        screen.print(tables_of(locus))
    assert "model error" in capture.get()


def test_critical_speed_has_the_same_words() -> None:
    point = bd.critical_point(bd.Scene(STRIP, bd.Mount(1.0)))
    assert point.model_error.shape == ()
    assert point.left_out["large deflection"] == 0  # the straight beam is an equilibrium until it buckles
    assert np.isnan(bd.critical_point(SCENE).model_error)  # there is no critical speed to change
    oblique = bd.critical_point(bd.Scene(STRIP, bd.Mount(1.0, 0.3)))
    assert "does not buckle" in oblique.left_out_effects.not_known["large deflection"]


def test_locus_states_it_at_some_of_its_speeds() -> None:
    locus = bd.frequency_locus(SCENE, np.linspace(0.0, 100.0, 40), 2)
    assert locus.model_error.shape == (len(locus.left_out_speeds), 2)
    last = bd.natural_modes(SCENE, 100.0, 2).left_out["shear deformation"]
    np.testing.assert_allclose(locus.left_out["shear deformation"][-1], last, rtol=1e-6)  # by other bases
    np.testing.assert_allclose(locus.left_out_at([39]).changes["shear deformation"][0], last, rtol=1e-6)


def test_results_keep_it_in_pickles_and_files(tmp_path: Path) -> None:
    modes = bd.natural_modes(SCENE, 100.0)
    expected = modes.model_error
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(modes)).model_error, expected)
    modes.save(tmp_path / "modes.json")
    np.testing.assert_array_equal(bd.load(tmp_path / "modes.json").model_error, expected)


# In words and digits --------------------------------------------------------------------------------


def test_warning_above_one_percent_or_the_tolerance() -> None:
    effects = LeftOutEffects({"a": np.array([0.004, 0.006])}, {}, {}, (), {"a": "why"})
    assert not [*effects.warnings()]
    assert not [*effects.warnings(0.0061)]
    (text,) = effects.warnings(0.001)
    assert text == ("the model error, 0.6 %, exceeds 0.1 %: a, left out, changes the answer by +0.6 %; why")


def test_a_warning_tells_the_model_error_from_its_limit() -> None:
    (text,) = LeftOutEffects({"a": np.array([0.010002])}, {}, {}, (), {}).warnings()
    assert text.startswith("the model error, 1.0002 %, exceeds 1 %: ")


def test_an_unknown_effect_does_not_silence_a_large_one() -> None:
    changes = {"large deflection": np.array([0.3, 0.1]), "shear": np.array([np.nan, 1e-5])}
    effects = LeftOutEffects(changes, {"shear": "another mode"}, {}, (), {}, (2,))
    (text,) = effects.warnings()
    assert text.startswith("the model error, at least 30 %, exceeds 1 %: large deflection, left out")
    (text,) = LeftOutEffects(
        {"shear": changes["shear"]}, {"shear": "another mode"}, {}, (), {}, (2,)
    ).warnings()
    assert text == "the model error may exceed 1 %: the change by shear, left out, is unknown: another mode"


@pytest.mark.parametrize("command", [("modes", "--speed", "2 rad/s"), ("locus", "--speeds", "0:2:3 rad/s")])
def test_nothing_left_to_compute(tmp_path: Path, capsys: pytest.CaptureFixture[str], command) -> None:
    """With large deflection, and data for nothing else."""
    file = tmp_path / "scene.toml"
    file.write_text(
        '[beam]\nlength = "1 m"\nmass_per_length = "1 kg/m"\nbending_stiffness = "1 N m2"\n'
        '[mount]\nradius = "0.5 m"\nsetting_angle = "45 deg"\n[physics]\nlarge_deflection = true\n'
    )
    assert main([command[0], str(file), *command[1:]]) == 0
    assert "nothing that can be computed; not known: second plane of bending" in capsys.readouterr().out
    modes = bd.natural_modes(bd.load_scene(file), 2.0, 2)
    np.testing.assert_array_equal(modes.model_error, [0.0, 0.0])


def test_sentence_begins_with_the_largest() -> None:
    changes = {"small": np.array([1e-5, -3e-5]), "large": np.array([0.094, 0.01])}
    said = LeftOutEffects(changes, {"x": "give y"}, {}, ("torsion",), {}).sentence(where="at 5 rad/s")
    assert said == (
        "left out at 5 rad/s: large +9.4 % (mode 1), small -0.003 % (mode 2); not known: x (give y); "
        "not modelled: torsion"
    )


def test_what_is_not_known_somewhere_is_not_said_to_be_zero() -> None:
    changes = {"a": np.array([0.0, np.nan]), "b": np.array([0.0, 0.0])}
    said = LeftOutEffects(changes, {"a": "beyond"}, {}, (), {}).sentence()
    assert said == "left out: b 0 %; not known: a (beyond)"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (0.0906, "+9.1 %"),
        (-3e-5, "-0.003 %"),
        (0, "0 %"),
        (1e-12, "below 1e-7 %"),
        (4.56, "+456 %"),
        (11.2, "+11 times"),
    ],
)
def test_changes_in_percent(change: float, words: str) -> None:
    assert say_change(change) == words


@pytest.mark.parametrize(
    ("text", "error", "sure"),
    [
        ("55.62047", 0.004, "55.62"),  # half a unit of the digit is not below the error: as `supported`
        ("55.62047", 0.006, "55.6"),
        ("1234.5", 4.0, "123"),
        ("1.2345e-05", 4e-8, "1.23"),
        ("55.62", 0.0, "55.62"),
        ("55.62", math.nan, ""),
        ("55.62", 500.0, ""),
        ("-", math.nan, "-"),
        ("0 ± 3", 1.0, "0 ± 3"),
        ("5e+02 ± 2e+02", 200.0, "5e+02 ± 2e+02"),
    ],
)
def test_digits_beyond_an_error(text: str, error: float, sure: str) -> None:
    assert text[: count_sure(text, error)] == sure


def test_digits_beyond_the_model_error_are_dimmed_and_kept() -> None:
    cell = set_apart("55.62047", 0.004)
    assert (cell.plain, [(s.start, s.end, s.style) for s in cell.spans]) == ("55.62047", [(5, 8, "dim")])
    assert '55.62<span class="beyond">047</span>' in html([table("t", ["f"], [[cell]])])
    console = Console(force_terminal=True, color_system="truecolor", width=120)
    with console.capture() as captured:
        console.print(tables_of(bd.natural_modes(SCENE, 100.0)))
        console.print(tables_of(bd.frequency_locus(SCENE, [0.0, 100.0], 2)))
    assert captured.get().count("\x1b[2m") >= 3 + 4  # each frequency


# Commands -------------------------------------------------------------------------------------------


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(FILE, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "command",
    [["modes", "--speed", "100 rad/s"], ["locus", "--speeds", "0, 100 rad/s"], ["critical"]],
)
def test_commands_say_it_below_the_table_and_in_json(
    command: list[str], scene_file: Path, tmp_path: Path, finished: Finished
) -> None:
    out = tmp_path / "out.json"
    said = finished(main([command[0], str(scene_file), *command[1:], "--json", str(out)]), 0)
    printed = " ".join(said.out.split())
    assert "left out" in printed
    assert "not modelled: offsets of sections, contact" in printed
    found = json.loads(out.read_text(encoding="utf-8"))
    assert "shear deformation" in found["left_out"]
    assert "model_error" in found
    assert found["not_modelled"] == list(NEVER)
    if command[0] != "critical":
        assert "modes not listed: edge" in printed
        assert {mode["kind"] for mode in found["unlisted_modes"]} == {"edge", "torsion"}
        assert "with Poisson's ratio 0.3 assumed" in printed
        assert "exceeds 1 %: shear deformation, left out, changes the answer by" in said.err
        assert "[physics] shear = true includes it, with shear_stiffness or poissons_ratio" in said.err


def test_no_warning_below_a_stated_tolerance(scene_file: Path, finished: Finished) -> None:
    assert "exceeds" not in finished(main(["modes", str(scene_file), "--tolerance", "0.1"]), 0).err


def test_an_effect_left_out_of_a_blade_whose_axial_stiffness_jumps() -> None:
    """A stiffness that is not modelled, and needs more cells than all others, changes no function."""
    x = np.linspace(0, 1, 11)
    axial = np.where(np.arange(11) % 2, 1e10, 1e7)
    beam = bd.Beam.from_stiffness(
        10.0,
        *(bd.Table(x.tolist(), v.tolist()) for v in (100 * (1.2 - x), 1e6 * (1.2 - x) ** 2)),
        axial_stiffness=bd.Table(x.tolist(), axial.tolist()),
        rotary_inertia=bd.Table(x.tolist(), (5 * (1.2 - x)).tolist()),
    )
    scene = bd.Scene(beam, bd.Mount(1.0, math.pi, math.pi / 2))
    without = bd.natural_modes(scene, 5.0, 4)
    with_it = bd.natural_modes(replace(scene, physics=bd.Physics(rotary_inertia=True)), 5.0, 4)
    changes = with_it.frequency / without.frequency - 1
    stated = without.left_out["rotary inertia of sections"]
    np.testing.assert_allclose(stated, changes, rtol=0.1)  # to the first order of changes of 3 % and less


def test_shifted_eigenvalues_are_those_of_the_changed_equations() -> None:
    """K = diag(1, 4) becomes [[1.1, 0.05], [0.05, 4.2]], whose eigenvalues a quadratic equation gives."""
    K = np.array([[1.1, 0.05], [0.05, 4.2]])
    pencil = SteadyPencil(np.eye(2), NONE, NONE, K, NONE, np.zeros(2))
    shifted = shift_eigenvalues(pencil, 0.0, np.array([1j, 2j]), np.eye(2))
    middle, half = (1.1 + 4.2) / 2, math.hypot((4.2 - 1.1) / 2, 0.05)
    expected = 1j * np.sqrt([middle - half, middle + half])
    np.testing.assert_allclose(shifted, expected, rtol=1e-6)  # a step that ends at 1 % of the change, squared


@pytest.mark.parametrize("entry", [0.0, np.nan])
def test_equations_that_have_no_eigenvalue_give_none(entry: float) -> None:
    M = np.full((2, 2), entry)
    pencil = SteadyPencil(M, NONE, NONE, M, NONE, np.zeros(2))
    assert np.isnan(shift_eigenvalues(pencil, 0.0, np.array([1j]), np.eye(2)[:, :1])).all()


def test_torsion_in_space_has_all_rotary_inertia_and_leaves_none_out():
    strip = bd.Beam.rectangular(0.4, 0.03, 0.003, 70e9, 2700.0, poissons_ratio=0.33)
    mount = bd.Mount(0.1, np.pi, np.pi / 2, root_stiffness=40.0, second_root_stiffness=900.0)
    asked, unasked = (
        bd.natural_modes(
            bd.Scene(
                strip, mount, physics=bd.Physics(2, rotary_inertia=of, torsion=True, large_deflection=True)
            ),
            60.0,
        )
        for of in (True, False)
    )
    np.testing.assert_allclose(asked.frequency, unasked.frequency, rtol=1e-12)
    assert "rotary inertia of sections" not in unasked.left_out_effects.changes
    np.testing.assert_allclose(
        unasked.left_out_effects.total_of_known, asked.left_out_effects.total_of_known, rtol=1e-6
    )


def test_a_layered_beam_without_poissons_ratio_asks_for_what_it_accepts() -> None:
    """Its section is rectangular, and refuses a shear stiffness."""
    layered = bd.load_scene(Path(__file__).parents[2] / "examples" / "bimorph.toml")
    assert bd.natural_modes(layered).left_out_effects.not_known == {
        "shear deformation": "give poissons_ratio"
    }
