"""Matrices and responses at one speed: what they mean, what is refused, and their commands."""

import json
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.analyses.about_linear_models import parse_frequencies, parse_input, parse_output
from beamdyn.analyses.results.of_linear_models import random_csv, response_csv
from beamdyn.cli import BAD_INPUT, DONE, main
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.modes.modal.model import Model
from tests.unit.toml_scenes import STRIP_TOML

BEAM = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
SCENE = bd.Scene(BEAM, bd.Mount(0.2, np.pi), damping_ratio=0.01)
TABLE = bd.PowerSpectrum([5.0, 50.0], [1.0, 2.0])
FILE = "examples/rough_road.toml"


def test_matrices_are_those_of_the_modes():
    modes = bd.natural_modes(SCENE, 50.0, 3)
    M = bd.matrices(SCENE, 50.0, 3)
    omega = np.sqrt(np.linalg.eigvalsh(M.stiffness))
    np.testing.assert_allclose(omega, np.abs(modes.eigenvalue), rtol=1e-5)  # damping ratio 1 %: 5e-5 of omega
    np.testing.assert_allclose(M.mass, np.eye(3), atol=1e-12)
    assert not M.gyroscopic.any() and (np.diag(M.damping) > 0).all()


def test_nodal_coordinates_are_deflections_and_slopes_where_they_say():
    M = bd.matrices(SCENE, 0.0, discretization=bd.Fem(4))
    assert len(M.coordinates) == len(M.rows) == len(M.mass) == 8
    assert M.coordinates[-2].startswith("bending, deflection at 0.05 m")
    tip = M.deflection([0.05])[0]
    np.testing.assert_allclose(tip, np.eye(8)[-2], atol=1e-12)
    assert "slope by x/L" in M.coordinates[-1]


def test_a_beam_of_many_stations_has_matrices():
    places = np.linspace(0, 1, 12)
    width = bd.Table(places, 0.01 + 0.002 * np.cos(20 * places))
    beam = bd.Beam.rectangular(0.5, width, 0.002, 200e9, 7850.0)
    found = bd.matrices(bd.Scene(beam, bd.Mount(radius=0.2)), 5.0)
    assert found.coordinates[0].endswith("coefficient of function 1 [m]")
    assert found.error[0] < 1e-9


def test_stiffness_by_axial_acceleration_is_what_gravity_adds():
    # The hub radius r is a steady acceleration -omega^2 r along an outward beam, whose tension stiffens it.
    with_hub, without = (
        bd.matrices(replace(SCENE, mount=bd.Mount(r, np.pi)), 50.0, discretization=bd.Ritz(6))
        for r in (0.2, 0)
    )
    added = 50.0**2 * 0.2 * with_hub.stiffness_by_axial_acceleration
    difference = with_hub.stiffness - without.stiffness
    np.testing.assert_allclose(difference, added, atol=1e-9 * np.abs(added).max())


def test_gyroscopic_matrix_of_a_blade_with_precone_is_skew():
    beam = bd.Beam.rectangular(0.05, 0.01, 0.001, 200e9, 7850.0)
    scene = bd.Scene(beam, bd.Mount(0.2, np.pi, precone=0.3), physics=bd.Physics(planes=2))
    G = bd.matrices(scene, 50.0, 2).gyroscopic
    assert np.abs(G).max() > 1
    np.testing.assert_allclose(G, -G.T, atol=1e-12 * np.abs(G).max())


def test_results_are_saved_and_loaded(tmp_path):
    response = bd.frequency_response(SCENE, 5.0, [1.0, 10.0], modes=2)
    random = bd.random_response(SCENE, 5.0, TABLE, modes=2)
    for k, result in enumerate((bd.matrices(SCENE, 5.0, 2), response, random)):
        result.save(tmp_path / f"{k}.json")
        again = bd.load(tmp_path / f"{k}.json")
        assert again.to_dict() == result.to_dict()
    assert random.plot().get_xlabel() == response.plot().get_xlabel() == "frequency [Hz]"


BEYOND, TWO = bd.PointForce(0.06), replace(SCENE, physics=bd.Physics(planes=2))
REFUSED = {
    "point outside the beam": (lambda: bd.frequency_response(SCENE, 5.0, [1.0], BEYOND), "position = 0.06 m"),
    "output outside": (lambda: bd.state_space(SCENE, 5.0, outputs=[bd.DeflectionAt(1.0)]), "position = 1 m"),
    "deflection outside": (lambda: bd.matrices(SCENE, 5.0, 2).deflection([0.06]), "x = 0.06 m"),
    "negative density": (lambda: bd.PowerSpectrum([1, 2], [1, -1]), "psd.values = -1"),
    "density of 0": (lambda: bd.PowerSpectrum([1, 2], [1, 0]), "psd.values = 0"),
    "frequency of 0": (lambda: bd.PowerSpectrum([0, 2], [1, 1]), "psd.frequencies = 0"),
    "negative white noise": (lambda: bd.random_response(SCENE, 5.0, -1.0), "psd = -1"),
    "strain by white noise": (lambda: bd.random_response(SCENE, 5.0, 1.0, output="root strain"), "output"),
    "delayed strain": (
        lambda: bd.state_space(
            replace(SCENE, damping_ratio=0.0, damping=bd.Damping(stiffness_factor=1e-4)),
            5.0,
            outputs=["root strain"],
        ),
        "damping.stiffness_factor = 0.0001 s",
    ),
    "white noise past the critical speed": (
        lambda: bd.random_response(bd.Scene(BEAM, bd.Mount(0.2), damping_ratio=0.01), 200.0, 1.0),
        "speed = 200 rad/s",
    ),
    "white noise of density 0": (lambda: bd.random_response(SCENE, 5.0, 0), "psd = 0"),
    "no damping": (
        lambda: bd.random_response(SCENE.undamped, 5.0, TABLE),
        "damping_ratio = 0: a mode is not damped",
    ),
    "a road without a wheel": (lambda: bd.random_response(SCENE, 5.0, bd.RoadRoughness("C")), "scene.motion"),
    "unknown class": (lambda: bd.RoadRoughness("Z"), "road.roughness = 'Z'"),
    "negative frequency": (lambda: bd.frequency_response(SCENE, 5.0, [-1.0]), "frequencies = -1 Hz"),
    "frequency beyond squares": (
        lambda: bd.frequency_response(SCENE, 80.0, [1e308]),
        "frequencies = 1e+308 Hz: give at most 1e+12 Hz",
    ),
    "rotating input": (lambda: bd.state_space(SCENE, 5.0, ["n2"]), "speed = 5 rad/s"),
    "rigid direction": (lambda: bd.frequency_response(SCENE, 5.0, [1.0], "tip force across"), "input"),
    "along the beam": (lambda: bd.matrices(SCENE, 0.0, inputs=["n1"]), "input"),
    "no outer fibre": (
        lambda: bd.state_space(bd.Scene(bd.Beam.from_stiffness(1, 1, 1)), 0.0, outputs=["root strain"]),
        "output",
    ),
    "past the critical speed": (
        lambda: bd.frequency_response(bd.Scene(BEAM, bd.Mount(0.2), damping_ratio=0.1), 1e3, [1.0]),
        "speed = 1000 rad/s",
    ),
    "a free hinge": (
        lambda: bd.frequency_response(bd.Scene(BEAM, bd.Mount(root_stiffness=0.0)), 0.0, [1.0]),
        "speed = 0 rad/s",
    ),
    "large deflection": (
        lambda: bd.matrices(replace(SCENE, physics=bd.Physics(large_deflection=True)), 5.0),
        "physics.large_deflection",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_by_name(case):
    make, said = REFUSED[case]
    with pytest.raises(ValueError) as refusal:
        make()
    assert str(refusal.value).startswith(said)


def test_white_noise_is_answered_to_ten_times_the_first_resonance():
    first = bd.natural_modes(SCENE, 5.0, 1).frequency[0]
    found = bd.random_response(SCENE, 5.0, np.int64(1))
    assert found.frequencies[-1] == pytest.approx(10 * first, rel=1e-3)  # damped: less by 5e-5
    overdamped = bd.random_response(replace(SCENE, damping_ratio=0.999), 0.0, 1.0)
    assert (overdamped.frequencies > 0).all()


def test_a_density_of_a_tip_force_has_its_unit(run, tmp_path):
    (tmp_path / "psd.csv").write_text("f [Hz], psd [N2/Hz]\n1, 1\n100, 1\n")
    asked = ("random", FILE, "--psd", tmp_path / "psd.csv", "--speed", "5 rad/s", "--input")
    code, _, err = run(*asked, "tip force")
    assert code == 0, err
    code, _, err = run(*asked, "bending")
    assert code == 2 and "m2/s4/Hz" in err


def test_a_measured_density_may_begin_at_0_hz_on_linear_axes(run, tmp_path):
    (tmp_path / "psd.csv").write_text("f [Hz], psd [m2/s4/Hz]\n0, 0\n100, 1\n")
    asked = ("random", FILE, "--psd", tmp_path / "psd.csv", "--speed", "5 rad/s", "--modes", "2")
    code, _, err = run(*asked)
    assert code == 2 and "leave the point out, or give --psd-axes linear" in err
    code, out, err = run(*asked, "--psd-axes", "linear")
    assert code == 0, err
    rms = bd.PowerSpectrum([0, 100], [0, 1], "linear").rms
    assert f"{rms:.6g} m/s2" in out
    code, _, err = run("random", FILE, "--road", "A", "--speed", "5 rad/s", "--psd-axes", "linear")
    assert code == 2 and "--psd-axes = linear: give it with --psd" in err


def test_an_input_beside_the_first_resonance_is_warned_of():
    first = bd.natural_modes(SCENE, 0.0, 1).frequency[0]
    for middle in (0.5, 1.5):
        psd = bd.PowerSpectrum([0.9 * middle * first, 1.1 * middle * first], [1.0, 1.0])
        said = f"what {first:.4g} Hz excites is not in the answer"
        assert any(said in each for each in bd.random_response(SCENE, 0.0, psd).warnings)
    around = bd.PowerSpectrum([0.5 * first, 1.5 * first], [1.0, 1.0])
    assert not any("resonance" in each for each in bd.random_response(SCENE, 0.0, around).warnings)


def test_a_road_that_ends_between_the_side_bands_is_warned_of():
    """A rotating beam answers at f + n and f - n; the road must reach both."""
    scene = bd.load_scene(FILE)
    first = bd.natural_modes(scene, 80.0, 1).frequency[0]
    turn = 80 / (2 * np.pi)
    for ends, lacking in (((1.0, first), [first + turn]), ((first, 9e3), [first - turn]), ((1.0, 9e3), [])):
        psd = bd.PowerSpectrum(ends, [1.0, 1.0])
        said = [w for w in bd.random_response(scene, 80.0, psd, "n2", modes=2).warnings if "resonance" in w]
        assert len(said) == len(lacking)
        assert all(f"what {f:.4g} Hz excites" in w for f, w in zip(lacking, said, strict=True))


def test_poles_of_all_functions_are_the_natural_frequencies():
    """By another route; LAPACK's QZ algorithm, once used here, fails on some pairs of nearly equal planes."""
    poles = ModelAtSpeed(Model(SCENE, bd.Ritz(20)), 5.0, None).free_motion.finite_poles
    found = np.sort(np.imag(poles)[np.imag(poles) > 0])[:4]
    known = 2 * np.pi * bd.natural_modes(SCENE, 5.0, 4).frequency
    np.testing.assert_allclose(found, known, rtol=1e-10)


@pytest.mark.slow
def test_a_road_may_go_on(run):
    asked = ("random", FILE, "--road", "C", "--velocity", "90 km/h")
    code, _, err = run(*asked)
    assert code == 0 and "excites is not in the answer" in err
    code, _, err = run(*asked, "--highest", "10 1/m")
    assert code == 0 and "resonance" not in err


def test_a_velocity_without_a_wheel_names_what_helps(run):
    asked = ("random", "examples/blade.toml", "--velocity", "90 km/h")
    code, _, err = run(*asked, "--road", "C")  # which needs the wheel's radius itself
    assert code == 2 and err.endswith('give motion.kind = "rolling"\n')
    code, _, err = run(*asked, "--psd", FILE)
    assert code == 2 and err.endswith('give motion.kind = "rolling", or --speed\n')


def test_an_undamped_beam_is_warned_of():
    found = bd.frequency_response(SCENE.undamped, 5.0, [1.0])
    assert any("no damping" in said for said in found.warnings)


# Records ------------------------------------------------------------------------------------------


def test_a_record_with_a_gap_is_refused():
    with pytest.raises(ValueError, match="times = 5 s: samples are missing after 2 s"):
        bd.SampledTranslation([0, 1, 2, 5, 6], along_n2=[0.0] * 5)


def test_a_record_is_interpolated_and_turns():
    motion = bd.SampledTranslation([0.0, 1.0, 2.0], along_n3=[0.0, 2.0, 0.0], rotation=3.0)
    sample = motion.at(np.array([0.5, 1.5]))
    np.testing.assert_allclose(sample.carrier_acceleration[:, 2], [1.0, 1.0])
    np.testing.assert_allclose(sample.angle, [1.5, 4.5])
    assert motion.with_speed(4.0).final_speed == 4.0 and motion.end == 2.0


RECORDED = STRIP_TOML + '[mount]\nradius = "0.2 m"\n[motion]\n'
TRANSLATION = RECORDED + 'kind = "sampled_translation"\nfile = "r.csv"\nrotation = { speed = "30 rpm" }\n'
ROTATION = RECORDED + 'kind = "sampled"\nfile = "r.csv"\n'


def scene_with(tmp_path, text, record):
    (tmp_path / "s.toml").write_text(text)
    (tmp_path / "r.csv").write_text(record)
    return bd.load_scene(tmp_path / "s.toml")


def test_translation_and_rotation_from_csv(tmp_path):
    moved = scene_with(tmp_path, TRANSLATION, "t [ms], n2 [mm/s2]\n0, 100\n10, -300\n20, 0\n").motion
    assert moved.times == (0.0, 0.01, 0.02) and moved.along_n2 == (0.1, -0.3, 0.0)
    assert moved.final_speed == pytest.approx(np.pi, rel=1e-15)
    turned = scene_with(tmp_path, ROTATION, "time [s]; speed [rpm]\n0; 0\n1; 60\n").motion
    assert isinstance(turned, bd.SampledRotation)
    assert turned.speeds == pytest.approx((0.0, 2 * np.pi), rel=1e-15)


BAD_RECORDS = {
    "no unit": ("t [s], n2\n0,1\n1,2\n", "line 1: expected a unit like [m/s2] for n2, found none"),
    "another unit": ("t [s], n2 [Hz]\n0,1\n1,2\n", "line 1: expected a unit like [m/s2] for n2, found [Hz]"),
    "missing cell": ("t [s], n2 [m/s2]\n0,1\n1,\n2,3\n", "line 3: expected a number for n2 [m/s2], found ''"),
    "gap": ("t [s], n2 [m/s2]\n0,1\n1,1\n2,1\n5,1\n", "line 5: t = 5 s: samples are missing after 2 s"),
    "late": ("t [s], n2 [m/s2]\n1,1\n2,1\n", "line 2: t = 1 s: a motion begins at t = 0"),
    "unknown": ("t [s], x [m]\n0,1\n1,1\n", "line 1: unknown column 'x'"),
    "backwards": ("t [s], n2 [m/s2]\n0,1\n2,1\n1,1\n", "line 4: t = 1 s: it follows 2 s"),
}


@pytest.mark.parametrize("case", BAD_RECORDS)
def test_a_bad_record_is_named_by_its_line(tmp_path, case):
    record, said = BAD_RECORDS[case]
    with pytest.raises(bd.ConfigError) as refusal:
        scene_with(tmp_path, TRANSLATION, record)
    assert said in str(refusal.value)


def test_a_motion_without_lists_names_no_file(tmp_path):
    with pytest.raises(bd.ConfigError, match="this kind of motion reads no file"):
        scene_with(tmp_path, RECORDED + 'kind = "steady"\nfile = "r.csv"\n', "t [s]\n0\n")


# Commands -----------------------------------------------------------------------------------------


def test_columns_have_their_units():
    answers = {"tip": "m", "tip acceleration": "m_per_s2", "root moment": "N_m"}
    squares = {"tip": "m2", "tip acceleration": "m2_per_s4", "root moment": "N2_m2"}
    for output, unit in answers.items():
        head = [*next(iter(random_csv(bd.random_response(SCENE, 5.0, TABLE, output=output, modes=2))))]
        squared = squares[output]
        assert head == ["frequency_Hz", f"psd_{squared}_per_Hz", f"psd_error_{squared}_per_Hz"]
        found = bd.frequency_response(SCENE, 5.0, [1.0], "tip force", output, modes=2)
        assert [*next(iter(response_csv(found)))][2] == f"real_{unit}_per_N"


def test_options():
    np.testing.assert_allclose(parse_frequencies("1:100:3 Hz"), [1, 10, 100])
    np.testing.assert_allclose(parse_frequencies("1, 2 kHz"), [1000, 2000])
    assert parse_input("force@20 mm across") == bd.PointForce(0.02, "across")
    assert parse_input("n2") == bd.BaseMotion("n2")
    assert parse_output("acceleration@tip") == bd.AccelerationAt()
    assert parse_output("root strain") == bd.StrainAtRoot()
    for wrong in ("", "5", "10:1:5 Hz", "1:10 Hz", "1,2 m"):
        with pytest.raises(ValueError, match="--frequencies"):
            parse_frequencies(wrong)


@pytest.mark.slow
def test_the_strain_on_a_rough_road_by_a_command(tmp_path, finished):
    paths = {name: tmp_path / f"out.{name}" for name in ("json", "csv")} | {"plot": tmp_path / "out.png"}
    files = [word for name, path in paths.items() for word in (f"--{name}", str(path))]
    arguments = ["random", FILE, "--road", "C", "--velocity", "90 km/h", "--output", "root strain"]
    assert "root mean square" in finished(main([*arguments, *files]), DONE).out
    scene = bd.load_scene(FILE)
    speed = 25 / scene.motion.rolling_radius
    expected = bd.random_response(scene, speed, bd.RoadRoughness("C"), output="root strain").rms
    assert json.loads(paths["json"].read_text())["rms"] == expected
    assert paths["csv"].read_text().splitlines()[0] == "frequency_Hz,psd_per_Hz,psd_error_per_Hz"
    assert paths["plot"].stat().st_size > 10_000


def test_the_commands_response_and_matrices(tmp_path, finished):
    path = tmp_path / "r.csv"
    assert (
        main(["response", FILE, "--frequencies", "1:1000:50 Hz", "--input", "n2", "--csv", str(path)]) == DONE
    )
    assert len(path.read_text().splitlines()) == 51
    assert "bending, mode 2" in finished(main(["matrices", FILE, "--modes", "2"]), DONE).out


def test_bad_densities_are_refused_by_the_command(tmp_path, capsys, finished):
    path = tmp_path / "psd.csv"
    for content, said in (
        ("f [Hz], psd [m2/s4/Hz]\n5,1\n50,-2\n", "a power spectral density is not negative"),
        ("f [Hz], psd\n5,1\n50,2\n", "expected a unit like [m2/s4/Hz] for psd, found none"),
    ):
        path.write_text(content)
        assert said in finished(main(["random", FILE, "--psd", str(path)]), BAD_INPUT).err
    assert main(["random", FILE]) == BAD_INPUT
    assert "--psd, --road, --roughness: give one of the three" in capsys.readouterr().err


@pytest.mark.parametrize("functions", [6, 8, 12])
def test_a_given_basis_with_functions_without_mass_serves_as_many_modes_as_have_mass(functions):
    beam = bd.Beam.rectangular(0.05, 0.01, 0.002, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(beam, bd.Mount(0.2), damping_ratio=0.01, physics=bd.Physics(shear=True))
    flat = bd.PowerSpectrum([5.0, 500.0], [1.0, 2.0])
    own = bd.random_response(scene, 10.0, flat, input="bending", discretization=bd.Ritz(functions))
    chosen = bd.random_response(scene, 10.0, flat, input="bending")
    assert own.rms == pytest.approx(chosen.rms, rel=1e-6)
    assert own.rms_error == np.inf  # there is no larger model in these functions
