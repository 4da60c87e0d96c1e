"""Edges that users met: units of warnings, strain, heads, numbers in lists, elements at high speed."""

import math

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.analyses.results.cautions import warnings_of
from beamdyn.common.edge.views import rows_of, tables_of
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.validity import warn_of_elastic_limit

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
POINTED = bd.Beam.rectangular(
    **BEAM, point_masses=[bd.PointMass(0.02, 2e-4)], point_springs=[bd.PointSpring(0.03, 40.0)]
)
TANGENTIAL = bd.Mount(0.215, 1.4)


def test_warnings_speak_the_unit_of_the_file():
    scene = bd.Scene(bd.Beam.rectangular(**BEAM), TANGENTIAL, units={"speed": "rpm"})
    with unannounced():
        found = bd.static_loads(scene, np.array([150.0]))
    assert any("rad/s" in said for said in found.warnings)
    said = " ".join(warnings_of(found))
    assert f"{150 * 30 / math.pi:.6g} rpm" in said and "rad/s" not in said


def test_strain_past_one_percent_is_said():
    thick = bd.Beam.rectangular(**{**BEAM, "thickness": 5e-3})
    with unannounced():
        calm, torn = (bd.static_loads(bd.Scene(thick, TANGENTIAL), np.array([v])) for v in (100.0, 3000.0))
    assert np.abs(calm.strain).max() < 0.01 < np.abs(torn.strain).max()
    said = [any("linearly elastic" in each for each in found.warnings) for found in (calm, torn)]
    assert said == [False, True]
    assert not list(warn_of_elastic_limit(np.full((2, 2), np.nan)))


def test_headline_has_the_unit_of_the_error():
    found = bd.static_loads(bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2, 1.0, 0.3)), np.array([20.0]))
    lines = [each for each in found.headline() if "error" in each]
    assert lines[0].endswith("N m")


# Studies ------------------------------------------------------------------------------------------


def test_numbers_in_lists_may_vary():
    scene = bd.Scene(POINTED, bd.Mount(0.2, math.pi))
    names = {"beam.point_mass[0].mass": [1e-4, 2e-4], "beam.point_spring[0].position": [0.03]}
    found = bd.study(scene, names, "frequencies", modes=2)
    light = bd.Beam.rectangular(
        **BEAM, point_masses=[bd.PointMass(0.02, 1e-4)], point_springs=[bd.PointSpring(0.03, 40.0)]
    )
    for beam, row in zip((light, POINTED), found.value[:, 0], strict=True):
        expected = bd.natural_modes(bd.Scene(beam, scene.mount), 0.0, 2).frequency
        np.testing.assert_allclose(row, expected, rtol=1e-9)  # what frequencies promise
    assert [each.unit for each in found.inputs] == ["kg", "m"]


@pytest.mark.slow
def test_numbers_in_lists_may_have_a_tolerance():
    scene = bd.Scene(POINTED, bd.Mount(0.2, math.pi))
    found = bd.spread(scene, {"beam.point_mass[0].mass": "+-2%"}, "frequencies", modes=1, samples=128)
    (given,) = found.inputs
    assert given.nominal == 2e-4 and given.unit == "kg"


def test_a_percentage_of_no_speed_asks_for_one():
    with pytest.raises(InvalidValue, match="give spread a speed"):
        bd.spread(bd.Scene(POINTED), {"speed": "+-2%"}, samples=128)


def test_a_number_beyond_the_list_is_refused():
    scene = bd.Scene(POINTED, bd.Mount(0.2, math.pi))
    with pytest.raises(InvalidValue, match=r"beam\.point_mass\[0\]\.mass"):
        bd.study(scene, {"beam.point_mass[3].mass": [1e-4]}, "frequencies")
    with pytest.raises(InvalidValue, match="unknown input"):
        bd.study(scene, {"beam.point_mass[0].colour": [1e-4]}, "frequencies")


def test_heads_put_the_number_of_a_mode_last():
    found = bd.study(bd.Scene(POINTED), {"beam.thickness": [2e-4, 3e-4]}, "frequencies", modes=2)
    head = next(iter(rows_of(found)))
    assert list(head[1:3]) == ["frequency_Hz_1", "frequency_Hz_2"]


def test_a_row_without_an_answer_has_no_error():
    from rich.console import Console

    scene = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.215))
    with unannounced():
        found = bd.study(scene, {"speed": [0.0, 400.0]}, "frequencies", modes=1)
    assert np.isfinite(found.value[0, 0]) and not np.isfinite(found.value[1, 0])
    console = Console(width=120)
    with console.capture() as shown:
        console.print(tables_of(found))
    last = next(line for line in shown.get().splitlines() if "400" in line)
    assert last.rstrip(" │┃").endswith("-")


# Coarse models ------------------------------------------------------------------------------------


@pytest.mark.parametrize("gamma", [300.0, 3e3, 1e4])
def test_elements_cover_layers_that_they_do_not_resolve(gamma):
    """Against 200 assumed modes; the layer at the root is some 1/gamma long."""
    beam = bd.Beam.rectangular(**BEAM)
    unit = math.sqrt(7850 * 0.01 * 2e-4 * 0.05**4 / (2e11 * 0.01 * 2e-4**3 / 12))
    scene, speed = bd.Scene(beam, bd.Mount(0.05, math.pi, math.pi / 2)), gamma / unit
    with unannounced():
        exact = bd.natural_modes(scene, speed, 3, bd.Ritz(200))
        found = bd.natural_modes(scene, speed, 3, bd.Fem(40))
    error = np.abs(found.frequency / exact.frequency - 1)
    assert (error <= found.error + exact.error).all()


def test_limits_of_one_function_have_no_error():
    found = bd.setting_angle_limits(bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.215)), 100.0, bd.Ritz(1))
    assert found.error == np.inf
