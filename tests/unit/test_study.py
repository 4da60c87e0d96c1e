"""Studies: inputs and their names, shapes, answers of single calls, refusals and model errors."""

import pickle
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.edge.views import rows_of
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import Designs, VariedInput, check_designs
from beamdyn.scene.numbers import number_at, units, with_numbers
from beamdyn.scene.rectangle import SECTION_UNITS
from tests.unit.toml_scenes import STRIP_TOML

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 200e9, "density": 7850.0}
SCENE = bd.Scene(bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-10)), bd.Mount(0.2))
WITHOUT_CAMBER = replace(SCENE, beam=bd.Beam.rectangular(**BEAM, tip=SCENE.beam.tip, poissons_ratio=0.0))
TOO_MANY = dict.fromkeys(("beam.width", "mount.radius"), np.linspace(1e-3, 2e-2, 4000))
ROUNDING = 1e-12  # a few ulp of the inputs, times what frequencies amplify them
TOML = STRIP_TOML + '[mount]\nradius = "0.2 m"\n'


def close_to_single(study, *place, **options):
    """Whether the answer of a design is that of a single call, within the stated errors of both."""
    speed = study.design(*place).get("speed", 0.0)
    modes = bd.natural_modes(study.scene_at(*place), speed, study.value.shape[-1], **options)
    return np.array_equal(modes.status, study.status[place]) and np.allclose(
        np.nan_to_num(study.value[place] / modes.frequency, nan=1.0),
        1.0,
        rtol=0.0,
        atol=(modes.error + study.error[place]).max(),
    )


def test_axes_are_the_inputs_in_their_order():
    speeds = [0.0, 30.0, 60.0, 10.0]
    study = bd.study(
        SCENE, {"beam.thickness": [2e-4, 3e-4], "speed": speeds, "mount.radius": [0.1, 0.2, 0.3]}
    )
    assert study.shape == (2, 4, 3)
    assert study.value.shape == study.error.shape == study.status.shape == (2, 4, 3, 3)
    assert study.design(1, 2, 0) == {"beam.thickness": 3e-4, "speed": 60.0, "mount.radius": 0.1}
    for place in ((0, 0, 0), (1, 2, 0), (0, 3, 2)):
        assert close_to_single(study, *place)


def test_values_taken_together():
    study = bd.study(SCENE, {"speed": [0.0, 60.0], "beam.tip.mass": [1e-4, 2e-4]}, combine="zip", modes=2)
    assert study.value.shape == (2, 2)
    assert close_to_single(study, 0) and close_to_single(study, 1)


def test_speed_alone():
    study = bd.study(SCENE, {"speed": [0.0, 25.0]})
    assert close_to_single(study, 1)


@pytest.mark.parametrize(
    "made",
    [
        bd.Beam.rectangular(**BEAM),
        bd.Beam.rectangular(**BEAM, poissons_ratio=0.3, breakpoints=(0.4,)),
        bd.Beam.rectangular(
            **BEAM | {"width": np.polynomial.Polynomial([0.01, -0.004])}, poissons_ratio=-0.2
        ),
        bd.Beam.rectangular(**BEAM | {"thickness": bd.Table([0, 0.5, 1], [3e-4, 2e-4, 1e-4])}),
    ],
)
def test_a_rectangular_beam_is_made_again_from_its_section(made):
    section = made.section
    given = {name: getattr(section, name) for name in SECTION_UNITS}
    again = bd.Beam.rectangular(length=made.length, **given)
    assert again == made and again.section == section
    assert pickle.loads(pickle.dumps(made)).section == section


def test_a_beam_knows_no_section_that_its_properties_do_not_follow_from():
    assert bd.Beam.from_stiffness(0.05, 0.0157, 1.3e-3).section is None
    rectangular = bd.Beam.rectangular(**BEAM)
    assert replace(rectangular, tip=bd.TipMass(0.1)).section == rectangular.section
    stiffer = rectangular.bending_stiffness.scaled(2.0)
    assert replace(rectangular, bending_stiffness=stiffer).section is None


def test_a_stretched_rectangle_is_one():
    scene = bd.Scene(bd.Beam.rectangular(**BEAM))
    stretched = with_numbers(scene, {"beam.scale.thickness": 2.0, "beam.scale.width": 3.0})
    assert number_at(stretched, "beam.thickness") == 2 * BEAM["thickness"]
    again = bd.Beam.rectangular(**BEAM | {"thickness": 2 * BEAM["thickness"], "width": 3 * BEAM["width"]})
    assert stretched.beam == again


def test_every_name_replaces_what_it_names():
    blade = bd.Beam.from_stiffness(
        1.0, 2.0, 30.0, 1e6, 0.01, second_bending_stiffness=40.0, shear_stiffness=1e5,
        second_shear_stiffness=2e5, rotary_inertia=1e-3, second_rotary_inertia=2e-3, twist=0.1,
        torsion_stiffness=20.0, warping_stiffness=0.1, mass_offset=0.01, tension_offset=0.02,
        tip=bd.TipMass(0.1, 0.0, 0.01, 0.01, 0.01),
    )  # fmt: skip
    plate = bd.Beam.rectangular(**BEAM, poissons_ratio=0.3)
    mount = bd.Mount(0.1, np.pi)
    others = {"width": 0.02, "poissons_ratio": 0.2, "thickness": 3e-4, "youngs_modulus": 1e11, "density": 5e3}
    of_section = ("width", "thickness", "youngs_modulus", "density", "poissons_ratio")
    for name in (
        name
        for name in units()
        if not name.startswith(("speed", "motion.", "harvester.")) and "[" not in name
    ):
        last = name.rpartition(".")[2]
        physics = bd.Physics(large_deflection=last in ("sweep", "prebend"))  # with which an axis is curved
        scene = bd.Scene(plate if last in of_section else blade, mount, physics=physics)
        value = others.get(last, 0.011)
        assert with_numbers(scene, {name: value}) != scene, name


def test_saved_and_pickled(tmp_path):
    study = bd.study(SCENE, {"beam.thickness": [2e-4, 3e-4]})
    study.save(tmp_path / "study.json")
    for again in (bd.load(tmp_path / "study.json"), pickle.loads(pickle.dumps(study))):
        assert np.array_equal(again.value, study.value) and again.scene == study.scene
        assert again.scene_at(1) == study.scene_at(1)


def test_critical_speeds():
    study = bd.study(SCENE, {"mount.setting_angle": [0.0, np.pi]}, "critical_speed")
    single = bd.critical_point(SCENE)
    assert abs(study.value[0] / single.speed - 1) <= study.error[0] + single.error
    assert study.status.tolist() == ["buckles", "does not buckle"]
    assert np.isinf(study.value[1]) and study.error[1] == 0


def test_amplitudes():
    """Their errors are relative to the amplitude, those of a response to its bound."""
    road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
    wheel = bd.RollingWheel(rolling_radius=0.3, speed=bd.SteadyRotation(50.0), road=road)
    scene = bd.Scene(SCENE.beam, SCENE.mount, wheel, damping_ratio=0.02)
    study = bd.study(scene, {"model.damping_ratio": [0.02, 0.05], "speed": [20.0, 30.0]}, "amplitude")
    single = bd.steady_response(study.scene_at(1, 0), [20.0, 30.0])  # as the study does: all speeds at once
    assert np.array_equal(study.value[1], single.amplitude) and study.status[1, 0] == single.status[0]
    assert study.unit == "m" and study.value.shape == (2, 2)
    of_bound = study.error[1, 0] * study.value[1, 0] / single.bound[0]
    np.testing.assert_allclose(of_bound, single.error[0] + single.mode_error[0], rtol=ROUNDING)


@pytest.mark.parametrize(
    ("vary", "options", "named"),
    [
        ({}, {}, "vary"),
        ({"beam.thicknes": [1e-4]}, {}, "beam.thickness"),
        ({"beam.thickness": []}, {}, "beam.thickness"),
        ({"beam.thickness": [2e-4, 0.02]}, {}, "thickness"),
        ({"beam.thickness": [2e-4, -1e-4]}, {}, "^beam.thickness = -"),
        ({"mount.radius": [-1.0]}, {}, "^mount.radius = -1"),
        ({"beam.tip.mass": [-1.0]}, {}, "^beam.tip.mass = -1"),
        ({"beam.thickness": [2e-4], "mount.radius": [0.1, 0.2]}, {"combine": "zip"}, "combine"),
        ({"beam.thickness": [2e-4], "beam.bending_stiffness": [1.0]}, {}, "bending_stiffness"),
        ({"speed": [1.0]}, {"what": "critical_speed"}, "speed"),
        ({"speed": [1e60]}, {}, "speed"),
        ({"speed": [1.0]}, {"what": "crossings", "speed": 5.0}, "speed"),
        ({"mount.radius": [0.1]}, {"what": "crossings"}, "^speed = 0"),
        ({"mount.radius": [0.1]}, {"what": "peak"}, "scene.motion"),
        ({"mount.radius": [0.1]}, {"what": "amplitude"}, "scene.motion"),
        ({"mount.radius": [0.1]}, {"window": (3.0, 2.0)}, "window"),
        ({"beam.scale.thickness": [1.0, -1.0]}, {}, "^beam.scale.thickness = -1"),
        ({"beam.scale.second_rotary_inertia": [0.0]}, {}, "^beam.scale.second_rotary_inertia = 0"),
        (TOO_MANY, {}, "4000 x 4000 values"),
    ],
)
def test_refusals_name_the_input(vary, options, named):
    with pytest.raises(InvalidValue, match=named):
        bd.study(SCENE, vary, **options)


def test_values_that_are_fine_together_but_not_with_each_other():
    """Widths below the other design's thickness: no design is refused that is a beam."""
    together = {"beam.width": [0.001, 0.01], "beam.thickness": [5e-4, 5e-3]}
    assert bd.study(SCENE, together, combine="zip").value.shape == (2, 3)
    with pytest.raises(InvalidValue, match="width"):
        bd.study(SCENE, together)


def test_a_section_of_no_rectangle_is_refused():
    scene = bd.Scene(bd.Beam.from_stiffness(0.05, 0.0157, 1.3e-3), bd.Mount(0.2))
    with pytest.raises(InvalidValue, match="not those of a rectangular section"):
        bd.study(scene, {"beam.thickness": [1e-4]})


def test_warnings_say_of_how_many_designs():
    with pytest.warns(UserWarning, match="outside linear theory"):
        study = bd.study(SCENE, {"mount.setting_angle": [0.0, 0.8], "speed": [0.0, 60.0]})
    assert any(said.startswith("at 1 of 4 designs") for said in study.warnings)


def test_the_static_deflection_that_is_warned_of_is_that_of_single_calls():
    from beamdyn.studies.batched import Refinement, solve_frequencies
    from beamdyn.studies.similar import SimilarDesigns

    columns = {"beam.thickness": [3e-4, 2e-4], "beam.length": [0.05, 0.04], "mount.setting_angle": [1.0, 2.0]}
    columns |= {"beam.youngs_modulus": [2e11, 1e11], "beam.tip.mass": [0.0, 1e-4], "mount.radius": [0.1, 0.3]}
    columns = {name: np.array(values) for name, values in columns.items()}
    scenes = [with_numbers(SCENE, {name: v[i] for name, v in columns.items()}) for i in range(2)]
    first = {name: float(values[0]) for name, values in columns.items()}
    designs = SimilarDesigns(scenes[0], first, columns)
    speeds = np.full((2, 1), 20.0)
    found = solve_frequencies(designs, Refinement(scenes[0], 3, "ritz", None), speeds)
    singles = [bd.natural_modes(scene, 20.0) for scene in scenes]
    deflection = [abs(single.static_deflection) / single.scene.beam.length for single in singles]
    np.testing.assert_allclose(found.deflection[:, 0], deflection, rtol=1e-10)  # error of the basis
    strain = [single.axial_strain for single in singles]
    np.testing.assert_allclose(designs.strains(speeds)[:, 0], strain, rtol=ROUNDING)


def test_a_tolerance_takes_the_basis_of_a_single_call():
    study = bd.study(SCENE, {"speed": [0.0, 60.0]}, tolerance=1e-4)
    assert close_to_single(study, 1, tolerance=1e-4)
    assert study.error.max() <= 1e-4


def test_an_input_given_twice_is_refused():
    twice = [VariedInput("speed", "rad/s", np.array([1.0, 2.0]))] * 2
    with pytest.raises(InvalidValue, match=r"speed.: the input is given twice"):
        check_designs(Designs(twice))


def test_designs_are_rows_and_places():
    inputs = [VariedInput("a", "", np.array([1.0, 2.0])), VariedInput("b", "m", np.array([3.0, 4.0, 5.0]))]
    designs = Designs(inputs)
    assert designs.shape == (2, 3) and designs.count == 6
    columns = designs.columns(slice(2, 5))
    assert columns["a"].tolist() == [1, 2, 2] and columns["b"].tolist() == [5, 3, 4]
    assert designs.at(1, 0) == {"a": 2.0, "b": 3.0}
    assert [*Designs(inputs[:1], "zip").extremes()] == [{"a": 1.0}, {"a": 2.0}]
    assert designs.at(-1, 2) == designs.at(1, -1) == {"a": 2.0, "b": 5.0}
    with pytest.raises(ValueError, match="give one index per axis"):
        designs.at(1)


@pytest.mark.parametrize("place", [(2, 0), (0, 3), (-3, 0)])
def test_a_place_outside_the_designs_is_refused(place):
    inputs = [VariedInput("a", "", np.array([1.0, 2.0])), VariedInput("b", "m", np.array([3.0, 4.0, 5.0]))]
    with pytest.raises(ValueError, match=r"outside the shape \(2, 3\)"):
        Designs(inputs).at(*place)
    with pytest.raises(ValueError, match=r"outside the shape \(2,\)"):
        Designs(inputs[:1], "zip").at(2)


ROAD = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)


def rolling(duration=0.5, **options):
    wheel = bd.RollingWheel(0.3, bd.SpinUp(40.0, duration), ROAD)
    return bd.Scene(SCENE.beam, SCENE.mount, wheel, **options)


def test_numbers_of_the_motion_are_inputs():
    scene = bd.Scene(SCENE.beam, SCENE.mount, bd.RollingWheel(0.3, 40.0, ROAD))
    vary = {"motion.road.wavelength": [0.2, 0.3], "speed": [20.0, 30.0], "motion.rolling_radius": [0.3, 0.35]}
    study = bd.study(scene, vary, "amplitude")
    assert [each.unit for each in study.inputs] == ["m", "rad/s", "m"]
    own = bd.RollingWheel(0.35, 40.0, bd.RoadWave(0.2, velocity_amplitude=0.01))
    assert study.scene_at(0, 1, 1).motion == own
    single = bd.steady_response(study.scene_at(0, 1, 1), [20.0, 30.0]).amplitude
    assert np.array_equal(study.value[0, :, 1], single)


def test_numbers_of_a_rotation_of_a_wheel_are_inputs():
    made = with_numbers(rolling(), {"motion.rotation.duration": 2.0, "motion.road.velocity_amplitude": 0.02})
    road = bd.RoadWave(0.3, velocity_amplitude=0.02)
    assert made.motion == bd.RollingWheel(0.3, bd.SpinUp(40.0, 2.0), road)
    turning = replace(SCENE, motion=bd.SpinUp(40.0, 1.0))
    assert with_numbers(turning, {"motion.duration": 3.0}).motion == bd.SpinUp(40.0, 3.0)


@pytest.mark.parametrize(
    ("what", "name", "values", "said"),
    [
        (
            "amplitude",
            "motion.road.height",
            [0.1],
            "no such number; give one of motion.rolling_radius, motion.r",
        ),
        ("amplitude", "motion.road.wavelength", [-0.1], "motion.road.wavelength = -0.1 m: "),
        (
            "frequencies",
            "motion.road.wavelength",
            [0.1],
            "only amplitudes, peaks, strains and power are studied over",
        ),
        ("crossings", "motion.rolling_radius", [0.1], "ask for one of these"),
        ("amplitude", "motion.rotation.speed", [0.1], "unknown input"),
        ("amplitude", "motion.road.wavelenght", [0.1], "give motion.road.wavelength"),
    ],
)
def test_numbers_of_the_motion_are_refused_in_a_sentence(what, name, values, said):
    with pytest.raises(InvalidValue, match=said.replace(".", "[.]")):
        bd.study(rolling(), {name: values}, what, speed=30.0)


@pytest.mark.slow
def test_a_spread_takes_numbers_of_the_motion():
    scene = bd.Scene(SCENE.beam, SCENE.mount, bd.RollingWheel(0.3, 40.0, ROAD))
    found = bd.spread(scene, {"motion.road.velocity_amplitude": "+-2%"}, "amplitude", samples=128)
    assert found.worst.largest[0] / found.nominal[0] == pytest.approx(1.02, rel=1e-6)  # proportional


def test_peaks_are_those_of_sweeps():
    scene = rolling(damping_ratio=0.02)
    vary = {"speed": [30.0, 20.0], "beam.thickness": [2e-4, 3e-4]}
    study = bd.study(scene, vary, "peak", window=(0.5, 0.6))
    assert study.value.shape == (2, 2) and study.unit == "m"
    single = bd.sweep(study.scene_at(0, 1), [20.0, 30.0], (0.5, 0.6))
    assert np.array_equal(study.value[:, 1], single.peaks[::-1])
    stated = (single.time_error + single.mode_error * single.largest) / single.peaks
    np.testing.assert_allclose(study.error[:, 1], stated[::-1], rtol=ROUNDING)
    assert (study.status == "done").all()


def test_a_speed_past_the_critical_one_refuses_its_peak_alone():
    critical = bd.critical_speed(SCENE)
    study = bd.study(rolling(), {"speed": [20.0, 1.5 * critical]}, "peak", window=(0.5, 0.6))
    assert study.status.tolist() == ["done", "refused"] and np.isnan(study.value[1])
    assert any(said.startswith("at 1 of 2 designs there is no answer") for said in study.warnings)


@pytest.mark.parametrize(("what", "options"), [("amplitude", {}), ("peak", {"window": (0.5, 0.6)})])
def test_warnings_are_counted_by_the_designs_that_they_are_of(what, options):
    critical = bd.critical_speed(SCENE)
    speeds = [20.0, 30.0, (1.5 if what == "amplitude" else 0.95) * critical]
    vary = {"beam.thickness": [2e-4, 2.001e-4], "speed": speeds}
    study = bd.study(rolling(), vary, what, tolerance=1e-3, **options)
    limited = [said for said in study.warnings if "there are warnings" in said]
    assert len(limited) == 1 and limited[0].startswith("at 2 of 6 designs there are warnings; at beam.th")


def test_an_unresolved_response_has_an_infinite_error(monkeypatch):
    """Not the largest number that there is."""
    sure = SimpleNamespace(
        amplitude=np.array([1e-3, 2e-3]), bound=np.array([1e-3, 2e-3]), error=np.zeros(2),
        mode_error=np.array([1e-6, np.inf]), status=("stable", "stable"), warnings=(),
    )  # fmt: skip
    monkeypatch.setattr("beamdyn.studies.one_by_one.steady_response", lambda *_, **__: sure)
    amplitudes = bd.study(rolling(), {"speed": [20.0, 30.0]}, "amplitude")
    assert amplitudes.error.tolist() == [1e-6, np.inf]
    of_sweep = SimpleNamespace(
        peaks=np.array([1e-3, 2e-3]), largest=np.array([1e-3, 2e-3]), time_error=np.array([1e-9, 1e-9]),
        mode_error=np.inf, status=("done", "done"), warnings=(),
    )  # fmt: skip
    monkeypatch.setattr("beamdyn.studies.one_by_one.sweep", lambda *_, **__: of_sweep)
    assert np.isinf(bd.study(rolling(), {"speed": [20.0, 30.0]}, "peak", window=(0.5, 0.6)).error).all()


def test_model_error_is_that_of_single_calls():
    study = bd.study(SCENE, {"beam.thickness": [2e-4, 3e-4], "speed": [0.0, 30.0, 60.0]}, modes=2)
    for place, error in zip(study.left_out_places, study.model_error, strict=True):
        modes = bd.natural_modes(study.scene_at(*place), study.design(*place)["speed"], 2)
        # Of frequencies from other bases, within rounding of changes that are differences of them.
        np.testing.assert_allclose(error, modes.model_error, rtol=1e-6, atol=1e-9)
    assert {(0, 0), (0, 2), (1, 0), (1, 2)} <= {*study.left_out_places}
    assert study.to_dict()["model_error"] == study.model_error.tolist()


def test_model_error_says_where_it_is_large():
    bent = bd.study(SCENE, {"mount.setting_angle": [0.0, 0.8], "speed": [0.0, 60.0]})
    (said,) = bent.model_warnings()
    assert "at mount.setting_angle = 0.8 rad, speed = 60 rad/s the model error" in said


def test_a_model_error_that_is_not_known_names_the_design_that_diverges():
    """Not the stable one whose known changes are largest."""
    for thickness in ([1e-4, 2e-4, 4e-4], [4e-4, 2e-4, 1e-4]):
        study = bd.study(WITHOUT_CAMBER, {"beam.thickness": thickness}, speed=120.0, modes=1)
        assert study.status[:, 0].tolist().count("divergence") == 1
        (said,) = study.model_warnings()
        assert said.startswith("at beam.thickness = 0.0001 m the model error may exceed")


def test_a_model_error_that_is_not_known_at_several_designs_says_at_how_many():
    vary = {"beam.thickness": [1e-4, 4e-4], "speed": [0.0, 120.0, 130.0]}
    study = bd.study(WITHOUT_CAMBER, vary, modes=1)
    (said,) = study.model_warnings()
    assert said.startswith("at beam.thickness = 0.0001 m, speed = 120 rad/s, and at 1 more of 6 designs")


@pytest.mark.parametrize("store", ["", "  "])
def test_a_store_without_a_name_is_refused(store, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InvalidValue, match=r"^store = '.*': the name is empty; give a folder"):
        bd.study(SCENE, {"speed": [0.0, 1.0]}, store=store)
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("key", [1, None, ("a",)])
def test_a_name_that_is_no_string_is_refused(key):
    with pytest.raises(InvalidValue, match=r"^vary = .*is a string; give one such as \"beam.thickness\""):
        bd.study(SCENE, {key: [1.0, 2.0]})
    with pytest.raises(InvalidValue, match=r"^inputs = .*is a string; give one such as"):
        bd.spread(SCENE, {key: "+-2%"})


def test_plots_of_one_input_have_a_panel_a_mode_and_those_of_three_a_map_each():
    one = bd.study(SCENE, {"mount.radius": [0.1, 0.2, 0.3]}).plot().figure.axes[1:]
    assert [ax.get_title() for ax in one] == [f"frequency, mode {i} [Hz]" for i in (1, 2, 3)]
    assert one[-1].get_xlabel() == "mount radius [m]"
    vary = {"mount.radius": [0.1, 0.2], "speed": [0.0, 9.0], "beam.width": [0.01, 0.02]}
    three = bd.study(SCENE, vary, modes=2).plot().figure.axes[1:]
    assert [ax.get_title().partition("\n")[2] for ax in three] == [
        "width = 0.01 m", "width = 0.02 m"
    ] * 2  # fmt: skip


def test_each_crossing_of_a_rolling_beam_has_a_head_of_its_own():
    """Of the sum and of the difference of the road's frequency and the rotation's, forced and parametric."""
    rolling = bd.load_scene("examples/rolling_harvester.toml")
    found = bd.study(rolling, {"beam.length": [0.05, 0.051]}, "crossings", speed=150.0, modes=2)
    heads = next(iter(rows_of(found)))
    assert len(set(heads)) == len(heads) == 1 + 3 * len(found.labels)
    assert "resonance_speed_rad_per_s_1_road_plus_forced" in heads


def test_a_mistyped_number_of_a_list_is_corrected_to_one_that_can_be_typed():
    beam = bd.Beam.from_stiffness(0.05, 0.0157, 1.33e-3, point_masses=[bd.PointMass(0.03, 0.001)])
    with pytest.raises(InvalidValue) as refused:
        bd.study(bd.Scene(beam), {"beam.point_mass.mass": [0.002]})
    suggested = str(refused.value).rpartition("give ")[2]
    assert bd.study(bd.Scene(beam), {suggested: [0.002]}).answered.all()
