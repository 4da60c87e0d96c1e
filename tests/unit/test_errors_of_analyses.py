"""Every analysis states a numerical and a model error, and takes a tolerance."""

import importlib.util
import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

import beamdyn as bd

ROOT = Path(__file__).parents[2]
STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, poissons_ratio=0.3)
INWARD = bd.Scene(STRIP, bd.Mount(0.215), damping_ratio=0.01)
BENT = replace(INWARD, mount=bd.Mount(0.215, math.pi / 4))
FLAT = bd.PowerSpectrum([5.0, 500.0], [1.0, 1.0])
CAMBER, LARGE = "camber of sections", "large deflection"
WITH_CAMBER = bd.Physics(camber=True)
ROLLING = replace(
    INWARD,
    motion=bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=0.2), bd.RoadWave(0.3, velocity_amplitude=0.01)),
)


def page():
    """The module that writes the table of the manual."""
    spec = importlib.util.spec_from_file_location("errors_page", ROOT / "docs" / "_ext" / "errors_page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_table_of_the_manual_has_no_empty_cell():
    rows = [*page().table()][2:]
    assert len(rows) == 28
    for row in rows:
        assert all(cell.strip() for cell in row.strip("|").split("|")), row


ANALYSES = {
    "response": lambda scene: bd.frequency_response(scene, 50.0, np.linspace(1, 100, 5)),
    "random": lambda scene: bd.random_response(scene, 50.0, FLAT, "bending"),
    "random loads": lambda scene: bd.random_loads(scene, 50.0, FLAT, "bending", at=[0.0]),
    "steady loads": lambda scene: bd.steady_loads(
        bd.steady_response(replace(scene, motion=ROLLING.motion), [55.0], 3), at=[0.0]
    ),
    "transient loads": lambda scene: bd.transient_loads(
        bd.simulate(replace(scene, motion=ROLLING.motion), 0.3, modes=2), at=[0.0]
    ),
    "cycles": lambda scene: bd.count_cycles(
        bd.transient_loads(bd.simulate(replace(scene, motion=ROLLING.motion), 0.3, modes=2), at=[0.0])
    ),
    "static loads": lambda scene: bd.static_loads(scene, 50.0, at=[0.0, 0.0]),
    "limits": lambda scene: bd.setting_angle_limits(scene, 50.0),
    "sensitivities": lambda scene: bd.frequency_sensitivities(scene, 50.0, 1, ["beam.length"]),
}


LONG = {"random loads", "sensitivities", "steady loads", "cycles"}  # the others show the same


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in ANALYSES]
)
def test_a_model_error_is_the_difference_of_two_answers(name):
    """Which are asked for one by one."""
    if name == "cycles":
        pytest.importorskip("rainflow")
    analysis = ANALYSES[name]
    found, with_camber = analysis(INWARD), analysis(replace(INWARD, physics=WITH_CAMBER))
    change = found.judged(with_camber) / found.judged(found) - 1
    assert found.left_out[CAMBER] == pytest.approx(change, rel=1e-6, abs=1e-9)  # the same equations
    bent = name in ("transient loads", "cycles")  # by its own inertia as it spins up; rotation does not
    assert (found.left_out[LARGE] == 0).all() or bent
    assert np.isfinite(found.model_error).all()


def test_large_deflection_of_a_response_is_judged_by_the_first_frequency():
    found, modes = ANALYSES["response"](BENT), bd.natural_modes(BENT, 50.0, 1)
    assert found.left_out[LARGE] == pytest.approx((1 + modes.left_out[LARGE][0]) ** -2 - 1)
    assert found.left_out_effects.assumed[LARGE] == "by the first frequency"


@pytest.mark.parametrize("speed", [30.0, 60.0, 100.0])
def test_large_deflection_of_loads_is_that_of_the_bent_beam(speed):
    """Its root moment, by the centrifugal forces on the beam of `equilibrium`: roughly."""
    found = bd.static_loads(BENT, speed, at=[0.0, 0.0])
    x = np.linspace(0, 0.05, 2001)
    along, across, _ = bd.equilibrium(BENT, speed).shape(x).T
    root = -0.215 * np.array([np.cos(math.pi / 4), np.sin(math.pi / 4)])
    forces = 7850 * 0.01 * 0.0002 * speed**2 * (np.array([along, across]) + root[:, None])
    moment = trapezoid(along * forces[1] - across * forces[0], x)
    change = abs(moment / found.moment[0, 0, 0]) - 1
    assert found.left_out[LARGE] == pytest.approx(change, rel=0.15)
    assert "roughly" in found.left_out_effects.assumed[LARGE]


@pytest.mark.parametrize(
    "name",
    [
        "static loads",
        "limits",
        *(pytest.param(n, marks=pytest.mark.slow) for n in ("response", "sensitivities")),
    ],
)
def test_large_deflection_is_that_of_the_physics_given(name):
    """Not what leaving camber out would change."""
    found = ANALYSES[name](replace(INWARD, physics=WITH_CAMBER))
    assert found.left_out[LARGE] == pytest.approx(0.0)
    oblique = replace(INWARD, mount=bd.Mount(0.215, math.pi, 0.7))
    assert ANALYSES[name](oblique).left_out[LARGE] == pytest.approx(0.0)


def test_modes_that_an_effect_adds_are_none_of_those_judged():
    thick = bd.Beam.rectangular(0.2, 0.08, 0.03, 200e9, 7850.0, poissons_ratio=0.3)
    scene = bd.Scene(thick, bd.Mount(0.1, math.pi, math.pi / 2))
    found = bd.frequency_sensitivities(scene, 300.0, inputs=["beam.length"])
    assert found.left_out["second plane of bending"] == pytest.approx(0.0, abs=1e-9)
    assert "answer" in found.left_out_effects.sentence()


def test_sensitivities_of_a_bent_beam_are_not_known():
    found = bd.frequency_sensitivities(BENT, 100.0, 1, ["beam.length"])
    assert np.isnan(found.left_out[LARGE]).all()
    assert found.left_out_effects.not_known[LARGE] == "sensitivities are computed for linear equations only"


def test_what_has_no_value_says_why_nothing_is_known():
    thick = bd.Beam.rectangular(0.2, 0.08, 0.03, 200e9, 7850.0)
    found = bd.setting_angle_limits(bd.Scene(thick, bd.Mount(0.1, math.pi, math.pi / 2)), 300.0)
    assert "there is no value that the effect could change" in found.left_out_effects.sentence()


def test_loads_of_a_tapered_strip_choose_physics_without_camber():
    width = np.polynomial.Polynomial([0.06, -0.02])
    strip = bd.Beam.rectangular(0.5, width, 0.002, 70e9, 2700.0, poissons_ratio=0.33)
    scene = bd.Scene(strip, bd.Mount(0.1, math.pi, math.pi / 2), physics="auto", damping_ratio=0.01)
    found = bd.static_loads(scene, 50.0, at=[0.0])
    assert CAMBER not in found.physics_choice.included
    assert any("only if the width is constant" in said for said in found.warnings)


def test_limits_of_a_bent_beam_are_not_known():
    limits = bd.setting_angle_limits(BENT, 100.0)
    assert np.isnan(limits.left_out[LARGE]).all()
    assert "the loci of a bent beam have another shape" in limits.left_out_effects.not_known[LARGE]


def test_frequencies_stand_for_matrices_and_backbones():
    modes = bd.natural_modes(INWARD, 50.0, 3)
    for found in (bd.matrices(INWARD, 50.0, 3), bd.state_space(INWARD, 50.0, modes=3)):
        assert found.model_error == pytest.approx(modes.model_error)
    bent = bd.backbone(INWARD, 50.0, mode=2)
    assert float(bent.left_out[CAMBER]) == pytest.approx(
        modes.left_out[CAMBER][1], rel=1e-3
    )  # about one equilibrium


def test_the_tip_of_an_equilibrium_is_judged_as_its_static_deflection():
    found = bd.equilibrium(BENT, 50.0)
    stiffer = bd.natural_modes(replace(BENT, physics=WITH_CAMBER), 50.0, 1).static_deflection
    plain = bd.natural_modes(BENT, 50.0, 1).static_deflection
    assert float(found.left_out[CAMBER]) == pytest.approx(stiffer / plain - 1, rel=1e-4)


def test_the_nominal_design_of_a_spread_is_judged():
    found = bd.spread(INWARD, {"beam.thickness": "+-2%"}, modes=2, samples=128)
    assert isinstance(found, bd.Spread)
    assert found.model_error == pytest.approx(bd.natural_modes(INWARD, modes=2).model_error)


def test_a_result_is_judged_after_it_was_pickled_and_loaded(tmp_path):
    found = ANALYSES["random"](INWARD)
    other = pickle.loads(pickle.dumps(found))
    assert other.model_error == found.model_error
    for each in (found, bd.backbone(INWARD, 50.0)):
        wanted = each.model_error
        each.save(tmp_path / f"{type(each).__name__}.json")
        loaded = bd.load(tmp_path / f"{type(each).__name__}.json")
        assert loaded.model_error == wanted
        assert loaded.to_json()


@pytest.mark.slow
def test_large_deflection_of_a_run_in_two_planes_is_not_known():
    """Nor that of its loads and cycles: rotation does not bend it, but its own motion does."""
    pytest.importorskip("rainflow")
    scene = replace(INWARD, motion=ROLLING.motion, physics=bd.Physics(planes=2))
    loads = bd.transient_loads(bd.simulate(scene, 0.3, modes=2), at=[0.0])
    for found in (loads, bd.count_cycles(loads)):
        assert np.isnan(found.left_out[LARGE])
        assert (
            found.left_out_effects.not_known[LARGE] == "not estimated for two planes, where modes may cross"
        )


def test_loads_of_a_loaded_run_are_not_judged_and_say_why(tmp_path):
    bd.simulate(replace(INWARD, motion=ROLLING.motion), 0.3, modes=2).save(tmp_path / "run.json")
    loads = bd.transient_loads(bd.load(tmp_path / "run.json"), at=[0.0])
    assert np.isnan(loads.model_error)
    assert "loaded from a file" in loads.left_out_effects.sentence()
    assert loads.to_json()


def test_a_run_from_coordinates_of_its_own_is_not_judged():
    run = bd.simulate(replace(INWARD, motion=ROLLING.motion), 0.3, modes=2, initial=np.zeros(4))
    assert np.isnan(bd.transient_loads(run, at=[0.0]).model_error)


TOLERANT = {
    "static loads": lambda scene, tolerance: bd.static_loads(scene, 50.0, tolerance=tolerance),
    "matrices": lambda scene, tolerance: bd.matrices(scene, 50.0, 3, tolerance=tolerance),
    "state space": lambda scene, tolerance: bd.state_space(scene, 50.0, modes=3, tolerance=tolerance),
    "limits": lambda scene, tolerance: bd.setting_angle_limits(scene, 50.0, tolerance=tolerance),
    "backbone": lambda scene, tolerance: bd.backbone(scene, 50.0, tolerance=tolerance),
    "crossings": lambda scene, tolerance: bd.resonance_speeds(ROLLING, 100.0, tolerance=tolerance),
    "slopes": lambda scene, tolerance: bd.crossing_sensitivities(
        ROLLING, 60.0, 1, ["beam.length"], tolerance=tolerance
    ),
}


@pytest.mark.parametrize("name", TOLERANT)
def test_a_tolerance_out_of_range_is_refused(name):
    with pytest.raises(ValueError, match=r"tolerance = 0\.5: "):
        TOLERANT[name](BENT if name == "static loads" else INWARD, 0.5)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-4, 1e-8])
def test_a_tolerance_of_loads_is_met(tolerance):
    exact = bd.static_loads(BENT, 50.0).moment
    loose = bd.static_loads(BENT, 50.0, tolerance=tolerance)
    assert loose.moment_error.max() <= tolerance * np.abs(exact).max()
    assert (np.abs(loose.moment - exact) <= loose.moment_error + 1e-12 * np.abs(exact).max()).all()


@pytest.mark.parametrize("tolerance", [1e-1, 1e-4])
def test_a_loose_response_takes_fewer_functions(tolerance):
    frequencies = np.linspace(1, 2000, 40)
    exact, loose = (bd.frequency_response(INWARD, 50.0, frequencies, tolerance=t) for t in (1e-9, tolerance))
    size = np.abs(exact.response).max()
    assert (np.abs(loose.response - exact.response) <= loose.error + 1e-9 * size).all()
    assert loose.error.max() <= tolerance * size
    sizes = [len(bd.matrices(INWARD, 50.0, tolerance=t).mass) for t in (None, tolerance)]
    assert sizes[1] < sizes[0]
    assert loose.provenance.method != exact.provenance.method
    peaks = loose.peaks.bandwidth - exact.peaks.bandwidth
    assert (np.abs(peaks) <= loose.peaks.bandwidth_error + exact.peaks.bandwidth_error).all()


@pytest.mark.parametrize(
    ("analysis", "said"),
    [
        (lambda scene: bd.static_loads(scene, 0.0), "turns freely about its root"),
        (lambda scene: bd.frequency_response(scene, 0.0, [10.0]), "turns freely about its root"),
    ],
)
def test_a_free_hinge_at_rest_is_refused_in_words(analysis, said):
    section = {"second_bending_stiffness": 1.0, "shear_stiffness": 1e4, "second_shear_stiffness": 1e4}
    inertia = {"rotary_inertia": 1e-6, "second_rotary_inertia": 1e-6}
    beam = bd.Beam.from_stiffness(0.5, 0.1, 1.0, **section, **inertia)
    physics = bd.Physics(planes=2, shear=True, rotary_inertia=True)
    hinged = bd.Mount(0.0, 0.0, math.pi / 2, second_root_stiffness=0.0)
    with pytest.raises((ValueError, ArithmeticError), match=said):
        analysis(bd.Scene(beam, hinged, physics=physics, damping_ratio=0.01))
