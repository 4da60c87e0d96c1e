"""Equilibria, their branches, and what is refused with large deflection."""

from __future__ import annotations

import math
import time
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.app import frequency_screen
from beamdyn.cli import DONE, NO_ANSWER, main
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.modes.modal import continuation, equilibrium
from beamdyn.modes.modal.model import Model
from beamdyn.scene.profile import to_profile
from benchmarks.cases.elastica import harvester_at
from tests.conftest import Finished

EXAMPLES = Path(__file__).parents[2] / "examples"
EPS = float(np.finfo(float).eps)
BENT = bd.Physics(large_deflection=True)
SPRING = bd.Mount(0.2, 1.0, root_stiffness=0.0)
SECOND_HINGE, IN_SPACE = bd.Mount(0.2, 1.0, second_root_stiffness=0.0), bd.Physics(2, large_deflection=True)
SLOPE = to_profile("prebend", 0.1)
ACROSS = (0.0, 0.1, 0.0)
FOLLOWING, TWISTING = bd.TipLoad(ACROSS, follows=True), bd.TipLoad(moment=(1e-3, 0.0, 0.0))
PUSHED = bd.Scene(harvester_at(45.0).beam, bd.Mount(0.2, 1.0), physics=BENT, tip_load=bd.TipLoad(ACROSS))


def harvester(degrees: float, physics: bd.Physics = BENT) -> bd.Scene:
    scene = harvester_at(degrees)
    return bd.Scene(scene.beam, scene.mount, physics=physics)


def test_shape_ends_at_the_tip_and_keeps_the_length() -> None:
    found = bd.equilibrium(harvester(45.0), 100.0)
    x = np.linspace(0, found.scene.beam.length, 2001)
    path = found.shape(x)
    np.testing.assert_allclose(path[-1], found.tip, rtol=0, atol=1e-14)  # rounding of 0.05 m
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    assert steps == pytest.approx(found.scene.beam.length, rel=1e-6)  # of chords, which are shorter


def test_out_of_the_plane_the_tip_leaves_it() -> None:
    scene = bd.Scene(harvester(0.0).beam, bd.Mount(0.215, 0.0, math.pi / 2), physics=BENT)
    tip = bd.equilibrium(scene, 200.0, "bent").tip
    assert tip[1] == 0.0
    assert abs(tip[2]) > 0.5 * scene.beam.length


def test_a_picture_of_a_beam_in_space_shows_both_directions() -> None:
    beam = bd.Beam.from_stiffness(
        1.0, 1.0, 10.0, second_bending_stiffness=30.0, torsion_stiffness=5.0, rotary_inertia=1e-3,
        second_rotary_inertia=1e-3, sweep=np.polynomial.Polynomial([0, 0, 0.3]),
    )  # fmt: skip
    physics = bd.Physics(2, torsion=True, large_deflection=True)
    found = bd.equilibrium(bd.Scene(beam, bd.Mount(0.5, np.pi), physics=physics), 3.0)
    ends = [float(line.get_ydata()[-1]) for line in found.plot().get_lines()[:2]]
    assert ends == pytest.approx(found.tip[1:], abs=1e-12)  # over a length of 1 m
    assert abs(ends[1]) > 0.05


def test_error_covers_a_finer_model() -> None:
    scene = harvester(5.0)
    coarse, fine = (bd.equilibrium(scene, 200.0, discretization=bd.Ritz(n)) for n in (8, 24))
    true = np.abs(coarse.tip - fine.tip).max()
    assert 0 < true <= coarse.error


def test_an_unstable_equilibrium_says_so() -> None:
    found = bd.equilibrium(harvester(0.0), 200.0)
    assert not found.stable
    assert found.growth_rate > 100
    assert "unstable at 200 rad/s" in found.warnings[0]
    assert bd.equilibrium(harvester(0.0), 200.0, "bent").stable


def test_branches_of_the_inward_harvester_meet_at_the_critical_speed() -> None:
    found = bd.equilibrium_branches(harvester(0.0), 200.0)
    straight, bent = found.branches
    np.testing.assert_allclose(bent.turning_speeds, found.critical_speed, rtol=1e-8)
    assert (straight.stable == (straight.speeds < found.critical_speed)).all()
    assert bent.tip[:, 1].min() < -0.02 < 0.02 < bent.tip[:, 1].max()  # to both sides


def test_a_turning_point_is_as_stable_as_what_it_ends() -> None:
    """The stiffness is singular there: rounding would decide."""
    bent = bd.equilibrium_branches(harvester(0.0), 200.0).branches[1]
    assert bent.turning_speeds.size and bent.stable.all()


def test_a_near_speed_is_met_in_one_step(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as changed:
        changed.setattr(continuation, "_LONGEST", 0.0)
        followed = bd.equilibrium(harvester(45.0), 60.0).tip
    monkeypatch.setattr(continuation, "follow", None)
    np.testing.assert_allclose(bd.equilibrium(harvester(45.0), 60.0).tip, followed, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    ("example", "basis", "speed"),
    [
        ("iea_15_blade", bd.Ritz(14, "moments"), 0.9),
        ("iea_15_blade", bd.Ritz(14, "moments"), 1.5),
        ("harvester_oblique", bd.Ritz(20), 150.0),
    ],
)
@pytest.mark.parametrize("digits", [1, -1, -10, 1000, 1e5])
def test_a_speed_that_differs_by_rounding_is_reached(
    example: str, basis: bd.Ritz, speed: float, digits: float
) -> None:
    """As when a root finder closes in on the speed at which a frequency meets a line."""
    solver = Model(bd.load_scene(EXAMPLES / f"{example}.toml"), basis).deflected
    beside = solver.equilibria(np.array([speed])), solver.equilibria(np.array([speed * (1 + digits * EPS)]))
    assert np.abs(np.diff(beside, axis=0) @ solver.load.angles).max() < 1e-8  # rounding of a stiff blade


@pytest.mark.parametrize("digits", [(1, 2), (-2, -5), (0, 1, 2, 3), (-1e3, 1, 3)])
def test_several_speeds_that_differ_by_rounding_are_reached_together(digits: tuple[float, ...]) -> None:
    """As when several lines meet a frequency at one speed."""
    solver = Model(bd.load_scene(EXAMPLES / "iea_15_blade.toml"), bd.Ritz(14, "moments")).deflected
    known = solver.equilibria(np.array([0.9]))
    beside = solver.equilibria(0.9 * (1 + np.array(digits) * EPS))
    assert np.abs((beside - known) @ solver.load.angles).max() < 1e-8


def test_no_step_leads_past_where_a_nearly_straight_beam_begins_to_bend() -> None:
    found = bd.equilibrium(harvester(1e-6), 162.0)  # a straight beam buckles at 159.8 rad/s
    assert found.stable
    assert abs(found.tip[1]) > 0.2 * found.scene.beam.length


def test_the_straight_branch_is_stable_up_to_the_critical_speed() -> None:
    found = bd.equilibrium_branches(harvester(0.0), 200.0)
    straight = found.branches[0]
    assert straight.speeds[straight.stable].max() == pytest.approx(found.critical_speed, rel=1e-8)


def test_what_a_swept_blade_leaves_out_is_not_known_where_the_straight_one_does_not_deflect() -> None:
    scene = bd.load_scene(Path(__file__).parents[2] / "examples" / "swept_blade.toml")
    found = bd.equilibrium(scene, 30.0)
    assert "does not deflect" in found.left_out_effects.not_known["stretch"] and math.isnan(found.model_error)


def test_the_slope_at_the_tip_is_printed_with_the_digits_that_are_sure(finished: Finished) -> None:
    example = Path(__file__).parents[2] / "examples" / "harvester_45deg.toml"
    command = ["equilibrium", str(example), "--speed", "100 rad/s", "--discretization", "fem"]
    printed = finished(main(command), DONE).out.partition("slope at the tip [deg]")[2].split()[0]
    exact = math.degrees(bd.equilibrium(bd.load_scene(example), 100.0).tip_angle)
    assert abs(float(printed) - exact) <= 0.5 * 10.0 ** -len(printed.partition(".")[2])


def test_branches_end_at_the_top_speed() -> None:
    for branch in bd.equilibrium_branches(harvester(5.0), 200.0).branches:
        assert branch.speeds.max() == pytest.approx(200.0, rel=1e-12)  # rounding of a square root


def test_a_speed_below_the_fold_has_one_branch() -> None:
    found = bd.equilibrium_branches(harvester(5.0), 150.0)
    assert [branch.name for branch in found.branches] == ["straight"]
    assert "no equilibrium beside" in found.warnings[0]


def test_a_locus_does_not_depend_on_its_speeds() -> None:
    """The equilibrium at a speed is the same wherever the continuation came from."""
    speeds = np.array([20.0, 90.0, 160.0])
    together = bd.frequency_locus(harvester(30.0), speeds).frequency
    apart = [bd.natural_modes(harvester(30.0), v).frequency for v in speeds]
    np.testing.assert_allclose(together, apart, rtol=1e-10)  # both stated errors


def test_speeds_just_past_the_fold_are_found_beside_others() -> None:
    """The bent branch begins at 178.701 rad/s; it is followed to all speeds, then refused below."""
    scene = harvester(5.0, bd.Physics(large_deflection=True, branch="bent"))
    together = bd.frequency_locus(scene, [178.71, 200.0, 250.0], 1, bd.Ritz(10)).frequency[:, 0]
    apart = [bd.natural_modes(scene, v, 1, bd.Ritz(10)).frequency[0] for v in (178.71, 200.0, 250.0)]
    np.testing.assert_allclose(together, apart, rtol=1e-9)  # near the fold errors grow as its distance falls
    with pytest.raises(ArithmeticError, match=r"turns back at 178\.701 rad/s"):
        bd.frequency_locus(scene, [178.6, 250.0], 1, bd.Ritz(10))


def test_critical_speed_is_that_of_a_straight_beam() -> None:
    assert bd.critical_speed(harvester(0.0)) == bd.critical_speed(harvester(0.0, bd.Physics()))
    assert bd.critical_speed(harvester(5.0)) == math.inf
    assert "bends the beam from rest on" in bd.critical_point(harvester(5.0)).reason


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: bd.Physics(large_deflection=True, camber=True), "physics.camber"),
        (lambda: bd.Physics(branch="up"), "physics.branch"),  # pyright: ignore[reportArgumentType]
        (lambda: bd.Scene(harvester(0.0).beam, SPRING, physics=BENT), "mount.root_stiffness"),
        (
            lambda: bd.Scene(harvester(0.0).beam, SECOND_HINGE, physics=IN_SPACE),
            "mount.second_root_stiffness",
        ),
        (lambda: bd.Scene(replace(harvester(0.0).beam, prebend=SLOPE)), "prebend"),
        (lambda: bd.setting_angle_limits(harvester(0.0), 400.0), "physics.large_deflection"),
        (lambda: bd.frequency_bounds(harvester(0.0), 10.0), "physics.large_deflection"),
        (lambda: bd.equilibrium(harvester(0.0), 10.0, "up"), "branch"),
        (lambda: bd.equilibrium(harvester(0.0), math.nan), "speed"),
        (lambda: bd.equilibrium(harvester(0.0), 10.0).shape([0.06]), "x"),
        (lambda: replace(PUSHED, physics=bd.Physics()), "physics.large_deflection"),
        (lambda: replace(PUSHED, tip_load=bd.TipLoad((0.0, 0.0, 1.0))), "physics.planes"),
        (lambda: replace(PUSHED, tip_load=bd.TipLoad(moment=(0.0, 1.0, 0.0))), "physics.planes"),
        (lambda: bd.critical_point(replace(PUSHED, tip_load=FOLLOWING)), "tip_load.follows"),
        (lambda: bd.critical_point(replace(PUSHED, physics=IN_SPACE, tip_load=TWISTING)), "tip_load.moment"),
        (lambda: bd.backbone(PUSHED), "tip_load.force"),
        (lambda: bd.resonance_speeds(replace(PUSHED, motion=bd.SteadyRotation(1.0)), 9.0), "tip_load.force"),
        (lambda: bd.steady_response(replace(PUSHED, motion=bd.SteadyRotation(1.0)), [9.0]), "tip_load.force"),
    ],
)
def test_refused_by_name(call: Callable[[], object], named: str) -> None:
    with pytest.raises(ValueError, match=f"^{named}"):
        call()


def test_terms_say_that_slopes_have_any_size() -> None:
    listed = bd.terms(harvester(45.0))
    assert listed["large deflection"].present
    assert "large deflection" not in [effect.name for effect in listed.left_out]


def test_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(
        '[beam]\nlength = "50 mm"\nwidth = "10 mm"\nthickness = "0.2 mm"\nyoungs_modulus = "200 GPa"\n'
        'density = "7850 kg/m3"\n[mount]\nradius = "215 mm"\nsetting_angle = "5 deg"\n'
    )
    picture = tmp_path / "branches.png"
    assert main(["branches", str(file), "--top-speed", "200 rad/s", "--plot", str(picture)]) == DONE
    assert "178.70093" in capsys.readouterr().out
    assert picture.stat().st_size > 5000
    assert main(["equilibrium", str(file), "--speed", "200 rad/s", "--branch", "bent"]) == DONE
    assert "0.8503" in capsys.readouterr().out
    assert main(["equilibrium", str(file), "--speed", "100 rad/s", "--branch", "bent"]) == NO_ANSWER
    assert "no equilibrium beside" in capsys.readouterr().err


@pytest.mark.parametrize("ask", [bd.equilibrium, bd.equilibrium_branches, bd.backbone])
def test_an_effect_that_large_deflection_excludes_is_refused_without_a_word_on_what_was_not_set(ask):
    strip = bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(strip, bd.Mount(0.2), physics=bd.Physics(camber=True))
    with pytest.raises(
        InvalidValue, match=r"camber = True: this analysis models large deflection.*; leave it out"
    ):
        ask(scene, 50.0)


def test_a_blade_that_coils_is_followed_to_an_angle_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tip without stiffness would coil by ever more turns, and the search would not end."""
    swept = bd.Beam.from_stiffness(
        1.0,
        1.0,
        1.0,
        second_bending_stiffness=1.0,
        torsion_stiffness=1e-3,
        rotary_inertia=1e-4,
        second_rotary_inertia=1e-4,
        sweep=bd.Table([0.0, 0.5, 1.0], [0.0, 0.0, 0.5]),
    )
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(swept, bd.Mount(0.2, np.pi, np.pi / 2), physics=physics)
    whole = bd.critical_point(scene, bd.Ritz(6))
    monkeypatch.setattr(equilibrium, "_COILED", 0.1)
    short = bd.critical_point(scene, bd.Ritz(6))
    assert whole.speed == short.speed == np.inf
    assert 0 < short.none_below < whole.none_below


@pytest.mark.slow
def test_a_search_ends_where_a_basis_does_not_resolve_the_boundary_layers() -> None:
    """At 24 times the first frequency, steps of this basis get ever shorter; the search took minutes."""
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(strip, bd.Mount(0.1, np.pi / 2, 0.4), physics=physics)
    start = time.process_time()
    found = bd.critical_point(scene, bd.Ritz(22))
    assert time.process_time() - start < 60
    assert found.speed == np.inf
    first = 2 * np.pi * bd.natural_modes(scene, modes=1).frequency[0]
    assert 20 * first < found.none_below < 30 * first


# A load at the tip ----------------------------------------------------------------------------------


def test_a_load_that_was_not_reached_says_how_much_of_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(continuation, "_MOST_TURNS", 0.1)
    with pytest.raises(
        bd.NoEquilibrium, match=r"no equilibrium was found beyond 0\.\d+ of the load at the tip"
    ):
        bd.equilibrium(replace(PUSHED, tip_load=bd.TipLoad((0.0, 1.0, 0.0))), 0.0)


def test_changes_by_effects_are_not_known_of_a_loaded_beam() -> None:
    beam = bd.Beam.rectangular(0.05, 0.01, 0.001, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(beam, physics=BENT, tip_load=bd.TipLoad(ACROSS))
    for found, shape in ((bd.equilibrium(scene, 0.0), ()), (bd.natural_modes(scene, modes=2), (2,))):
        assert found.left_out["shear deformation"].shape == shape
        assert "no load at its tip" in found.left_out_effects.not_known["shear deformation"]


def test_a_file_has_the_load_and_a_study_varies_it(tmp_path: Path) -> None:
    path, given = tmp_path / "loaded.toml", Path("examples/harvester_45deg.toml").read_text(encoding="utf-8")
    load = 'force = ["0 N", "0.1 N", "0 N"]\nmoment = ["0 N m", "0 N m", "1 N mm"]\nfollows = true'
    path.write_text(f"{given}\n[physics]\nlarge_deflection = true\n[tip_load]\n{load}\n", encoding="utf-8")
    scene = bd.load_scene(path)
    assert scene.tip_load == bd.TipLoad(ACROSS, (0.0, 0.0, 1e-3), follows=True)
    assert "load at the tip" in str(scene)
    found = bd.study(scene, {"tip_load.force[1]": [0.0, 0.1], "speed": [100.0]}, modes=1)
    alone = bd.natural_modes(scene, 100.0, 1).frequency
    np.testing.assert_allclose(found.value[1, 0], alone, rtol=1e-9)
    assert abs(found.value[0, 0, 0] / alone[0] - 1) > 0.01


BECK = """[beam]
length = "1 m"
mass_per_length = "1 kg/m"
bending_stiffness = "1 N m2"
[mount]
radius = "0 m"
setting_angle = "180 deg"
[physics]
large_deflection = true
[tip_load]
force = ["-20.06 N", "0 N", "0 N"]
follows = true
"""


def test_flutter_under_a_follower_load_is_an_answer_without_a_critical_speed(
    tmp_path: Path, finished: Finished
) -> None:
    """The growth rate is that of a Galerkin solution of Beck's column with its own functions."""
    file = tmp_path / "beck.toml"
    file.write_text(BECK, encoding="utf-8")
    said = finished(main(["modes", str(file), "--modes", "2"]), NO_ANSWER).err
    assert "unstable at 0 rad/s: mode 1 (flutter, 0.2069 1/s)" in said and "critical" not in said
    assert main(["locus", str(file), "--speeds", "0:1:3 rad/s", "--plot", str(tmp_path / "l.png")]) == DONE
    tables = tomllib.loads(BECK.replace("20.06", "20.04"))
    shown = frequency_screen.solve(tables | {"options": {"top_speed": "0.5 rad/s", "modes": 2}})
    assert shown.critical is None and shown.critical_speed == np.inf
    assert "critical speed" not in [each.words for each in frequency_screen.headline(shown)]
    assert frequency_screen.draw(shown).axes and frequency_screen.chart(shown)


@pytest.mark.parametrize("analysis", [bd.equilibrium, bd.equilibrium_branches])
@pytest.mark.parametrize("lacking", ["harvester.resistance", "point_springs", "damping.tip_damper"])
def test_what_is_always_modelled_is_not_to_be_left_out(
    analysis: Callable[[bd.Scene, float], object], lacking: str
) -> None:
    """The remedy named large deflection, which the scene does not have."""
    loaded = bd.load_scene(Path(__file__).parents[2] / "examples" / "bimorph.toml")
    held = replace(loaded.beam, electrodes=None, point_springs=[bd.PointSpring(0.02, 10.0)])
    scene = {
        "harvester.resistance": loaded,
        "point_springs": replace(loaded, beam=held),
        "damping.tip_damper": bd.Scene(harvester(0.0).beam, damping=bd.Damping(tip_damper=0.1)),
    }[lacking]
    with pytest.raises(InvalidValue, match="leave it out, as this analysis always models large") as refused:
        analysis(scene, 50.0)
    assert refused.value.field == lacking


def beck(push: float, across: float = 0.0) -> bd.Scene:
    """Return an outward beam of unit properties under a force that follows its tip."""
    load = bd.TipLoad((-push, across, 0.0), follows=True)
    return bd.Scene(
        bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, math.pi), physics=BENT, tip_load=load
    )


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # of unit properties
def test_a_load_that_buckles_the_beam_within_rounding_is_refused_with_a_remedy_that_works() -> None:
    def loaded(ratio: float) -> bd.Scene:
        load = bd.TipLoad((-ratio * math.pi**2 / 4, 0.0, 0.0))
        return bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.5), physics=BENT, tip_load=load)

    said = r"tip_load.force = \(-2.467.*\): .*lowest frequency under it is 0.*part in 1e9"
    for ratio in (1 - 1e-14, 1.0, 1 + 2.3e-16, 1 + 1e-14):
        with pytest.raises(ValueError, match=said):
            bd.natural_modes(loaded(ratio), 0.0, 2)
        assert bd.critical_point(loaded(ratio)).speed < 1e-6
    for ratio in (1 - 1e-9, 1 + 1e-9):
        assert bd.natural_modes(loaded(ratio), 0.0, 2).frequency.shape == (2,)


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # of unit properties
def test_a_large_tension_that_follows_the_tip_is_not_said_to_buckle_it() -> None:
    """Its lowest frequency falls exponentially with the tension; the remedy to give less works."""
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
    pulled = [
        bd.Scene(beam, bd.Mount(0.1), physics=BENT, tip_load=bd.TipLoad((tension, 0.0, 0.0), follows=True))
        for tension in (10.0, 1e3)
    ]
    with pytest.raises(
        ValueError, match=r"tip_load.force.* lowest frequency under it is 0.* give a smaller load"
    ):
        bd.natural_modes(pulled[1], 0.0, 3)
    assert bd.natural_modes(pulled[0], 0.0, 3).error.max() < 1e-9


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # of unit properties
@pytest.mark.parametrize(
    ("basis", "ratio", "error"),
    [(bd.Ritz(3), 1.0003, math.inf), (bd.Fem(10), 1.00001, math.inf), (bd.Ritz(12), 1.0003, 1e-10)],
)
def test_a_load_that_buckles_the_finer_of_two_models_at_rest(
    basis: bd.Ritz | bd.Fem, ratio: float, error: float
) -> None:
    """The coarser one is stiffer, and loses stability at a speed; Euler's load is pi^2/4."""
    load = bd.TipLoad((-ratio * math.pi**2 / 4, 0.0, 0.0))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.5), physics=BENT, tip_load=load)
    found = bd.critical_point(scene, basis)
    assert (found.speed, found.error) == (0.0, error)


@pytest.mark.filterwarnings("ignore:bending_stiffness:UserWarning")  # of unit properties
@pytest.mark.parametrize(
    ("push", "across", "stable"),
    [
        (20.04, 0.0, True),
        (20.5, 0.0, False),  # the first two modes flutter, at rest beyond 20.0509
        (21.0, 0.02, False),
        (100.0, 0.0, False),  # the first mode vibrates, and higher ones flutter
        (100.0, 0.02, False),
    ],
)
@pytest.mark.parametrize("speed", [0.0, 0.3])
def test_all_modes_decide_whether_an_equilibrium_is_stable(
    push: float, across: float, stable: bool, speed: float
) -> None:
    scene = beck(push, across)
    modes = bd.natural_modes(scene, speed, modes=6)
    found, branches = bd.equilibrium(scene, speed), bd.equilibrium_branches(scene, 0.4)
    assert found.stable == stable
    assert found.growth_rate == pytest.approx(modes.growth_rate.max(), rel=1e-6, abs=0)
    assert (branches.branches[0].stable == stable).all()
    assert math.isnan(branches.critical_speed)  # it may flutter first
