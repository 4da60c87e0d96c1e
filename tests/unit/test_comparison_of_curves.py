"""Measured histories, loads and responses beside a scene: alignment, figures, verdicts, refusals, files."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli.commands import main

# The strip of the examples by its stiffness: of no width and thickness, few effects are left out.
BEAM = bd.Beam.from_stiffness(0.05, 0.0157, 4 / 3e3, outer_fibre=1e-4)
PLAIN = bd.Scene(BEAM, bd.Mount(radius=0.215))
ROAD = bd.RoadWave(0.3, velocity_amplitude=0.01)
MOVING = replace(PLAIN, motion=bd.RollingWheel(0.3, bd.SpinUp(55.0, duration=0.2), ROAD))
DAMPED = replace(PLAIN, damping_ratio=0.02)
T = np.linspace(0.05, 0.28, 300)
RUN = bd.simulate(MOVING, 0.3)
F = np.linspace(20.0, 100.0, 17)


def test_a_history_of_the_scene_itself_agrees_without_delay():
    found = bd.compare(MOVING, bd.MeasuredHistory(T, np.round(RUN.deflection(T), 9), rounding=5e-10))
    assert found.agrees
    assert found.delay == 0.0
    assert "within the data's uncertainty" in found.sentences()[0]


def test_a_delay_is_found_and_taken_out():
    late = 1.7e-3
    data = bd.MeasuredHistory(T, 1.02 * RUN.deflection(T - late), rounding=1e-9)
    found = bd.compare(MOVING, data)
    # The misfit is quadratic about its least: a factor shifts it by none; runs of two ends differ by 1e-5.
    np.testing.assert_allclose(found.delay, late, rtol=1e-3)
    np.testing.assert_allclose(found.deviation, 0.02, rtol=1e-2)  # runs of two ends differ by 1e-5
    np.testing.assert_allclose(found.rms, 0.02, rtol=1e-2)
    assert found.phase[0] < 0
    assert "by which the data are behind" in found.sentences()[0]


def test_a_sign_that_is_turned_is_named_and_its_delay_is_not_half_a_period():
    late = 1.7e-3
    data = bd.MeasuredHistory(T, -RUN.deflection(T - late), rounding=1e-9)
    found = bd.compare(MOVING, data)
    assert found.is_turned.all()
    np.testing.assert_allclose(found.delay, late, rtol=1e-3)
    assert "its sign is opposite: with the other sign" in found.sentences()[0]
    loads = bd.MeasuredLoads([0.0, 0.025], [0.3729, 0.1742], ["axial"], 50.0, rounding=5e-5)
    assert "its sign is opposite" in bd.compare(PLAIN, loads).sentences()[0]
    assert not bd.compare(PLAIN, replace(loads, value=-loads.value)).is_turned.any()


def test_data_without_a_speed_are_compared_at_that_of_the_scene_which_is_said():
    loads = bd.MeasuredLoads([0.0, 0.025], [-0.4512, -0.2108], ["axial"], rounding=5e-5)
    found = bd.compare(MOVING, loads)
    assert found.speed == 55.0
    assert "the final speed of the scene" in found.warnings[0]
    assert "axial at 55 rad/s" in found.sentences()[0]
    given = bd.compare(MOVING, replace(loads, speed=55.0))
    assert len(given.warnings) == len(found.warnings) - 1
    np.testing.assert_array_equal(given.computed, found.computed)


def test_digits_that_agree_are_no_deviation():
    exact = bd.compare(PLAIN, bd.MeasuredLoads([0.0], [1.0], ["axial"], 50.0)).computed
    near = bd.compare(PLAIN, bd.MeasuredLoads([0.0], exact.round(3), ["axial"], 50.0, rounding=5e-4))
    assert "agree to the digits of the data" in near.sentences()[0]
    off = bd.compare(PLAIN, bd.MeasuredLoads([0.0], exact.round(3), ["axial"], 50.0, uncertainty=5e-3))
    assert off.agrees
    assert "below" in off.sentences()[0] or "above" in off.sentences()[0]


def test_a_value_beside_none_is_no_infinite_deviation():
    found = bd.compare(PLAIN, bd.MeasuredLoads([0.0, 0.02], [1.0, 0.5], ["moment"], 50.0))
    assert "compared with 0 in the model" in found.sentences()[0]
    assert "inf" not in " ".join(found.sentences())


def test_moment_and_strain_at_the_root_have_one_clock():
    loads = bd.transient_loads(RUN, at=[0.0], t=T)
    values = np.c_[RUN.root_strain(T), loads.moment[:, 0, 0]]
    data = bd.MeasuredHistory(
        T, values, ["root strain", "root moment"], rounding=1e-4 * np.abs(values).max(axis=0)
    )
    found = bd.compare(MOVING, data)
    assert found.unit == ("", "N m")
    assert found.agrees


def test_verdicts_ask_the_data_first_then_the_model():
    with_doubt = bd.MeasuredLoads([0.0, 0.02], [-0.38, -0.22], ["axial"], 50.0, uncertainty=0.01)
    found = bd.compare(PLAIN, with_doubt)
    assert found.verdict == ("agrees",)
    sure = replace(with_doubt, uncertainty=np.nan)
    assert bd.compare(PLAIN, sure).verdict == ("outside",)
    assert replace(found, model_error=np.ones(1), allowance=np.zeros((2, 1))).verdict == (
        "within the model error",
    )
    assert replace(found, error=np.full((2, 1), np.inf)).verdict == ("not known",)
    vain = replace(found, model_error=np.array([14.14]), allowance=np.zeros((2, 1)))
    assert vain.verdict == ("not known",)
    assert (
        "no verdict, as what the model leaves out (1414 %) is more than the curve itself"
        in vain.sentences()[0]
    )


def test_a_largest_value_that_is_off_is_outside_though_the_whole_is_near():
    response = bd.frequency_response(DAMPED, 0.0, F).response[:, 0]
    spread = 0.2 * np.abs(response).max()
    data = bd.MeasuredResponse(F, np.abs(response), np.angle(response), uncertainty=spread)
    assert bd.compare(DAMPED, data).agrees
    k = int(np.abs(response).argmax())
    high = np.where(np.arange(len(F)) == k, 1.5, 1.0) * np.abs(response)
    found = bd.compare(DAMPED, replace(data, magnitude=high))
    assert found.rms[0] < 0.5
    assert found.verdict == ("outside",)


def test_a_phase_that_is_off_is_told_where_the_response_is_largest():
    response = bd.frequency_response(DAMPED, 0.0, F).response[:, 0]
    data = bd.MeasuredResponse(F, np.abs(response), np.angle(response) + 0.1)
    found = bd.compare(DAMPED, data)
    np.testing.assert_allclose(found.phase, 0.1, rtol=1e-9)  # of rounding alone
    np.testing.assert_allclose(found.rms, abs(np.exp(0.1j) - 1), rtol=1e-9)
    (said,) = found.sentences()
    assert (
        "is the same as 0.00023028 m" in said and "5.73 deg ahead there: outside the numerical error" in said
    )
    assert bd.compare(DAMPED, replace(data, phase=None)).rms[0] < 1e-9


@pytest.mark.parametrize(
    ("scene", "data", "said"),
    [
        (
            MOVING,
            bd.MeasuredHistory([0.1, 0.11], [0.0, 1.0]),
            "shorter than a period of the first mode",
        ),
        (PLAIN, bd.MeasuredHistory([0.1, 0.2], [0.0, 1.0]), "a transient needs a motion"),
        (MOVING, bd.MeasuredHistory([0.1, 0.2], [0.0, 1.0], ["tip across"]), "physics.planes = 2"),
        (PLAIN, bd.MeasuredLoads([0.0, 0.06], [1.0, 1.0]), r"position = 0.06 m: the beam reaches"),
        (PLAIN, bd.MeasuredLoads([0.0], [1.0], ["shear across"]), "physics.planes = 2"),
        (DAMPED, bd.MeasuredResponse([50.0], [1.0], input="n2", speed=50.0), "at two frequencies"),
    ],
)
def test_what_cannot_be_compared_is_refused(scene, data, said):
    with pytest.raises(ValueError, match=said):
        bd.compare(scene, data)


def test_the_command_writes_all_forms_and_takes_names_and_doubts(tmp_path, capsys):
    file = tmp_path / "loads.csv"
    file.write_text("x [mm], Axial [N]\n0, -0.37\n20, -0.22\n")
    names = {kind: tmp_path / f"out.{kind}" for kind in ("json", "csv", "html", "png")}
    options = zip(("--json", "--csv", "--report", "--plot"), map(str, names.values()), strict=True)
    command = ["compare", "examples/tyre_harvester.toml", str(file), "--speeds", "50 rad/s"]
    assert main([*command, "--uncertainty", "10 %", *(word for pair in options for word in pair)]) == 0
    assert "agrees" in capsys.readouterr().out
    written = json.loads(names["json"].read_text())
    assert written["verdict"] == ["agrees"]
    assert names["csv"].read_text().startswith("position_mm,measured_N_axial,computed_N_axial")
    assert names["png"].stat().st_size > 1000
    assert main([*command, "--uncertainty", "1 N"]) == 2
    assert 'a column "tip uncertainty [mm]"' in " ".join(capsys.readouterr().err.split())
    assert main(["identify", *command[1:3], "--free", "length"]) == 2
    assert "identify takes natural frequencies" in " ".join(capsys.readouterr().err.split())


def test_the_command_names_the_file_whose_data_cannot_be_compared(tmp_path, capsys):
    file = tmp_path / "loads.csv"
    file.write_text("x [mm], axial [N]\n0, -0.37\n60, -0.22\n")
    assert main(["compare", "examples/tyre_harvester.toml", str(file)]) == 2
    assert "loads.csv: position = 0.06 m: the beam reaches" in " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize("text", ["tip", "= x", ";"])
def test_columns_are_given_in_pairs(text, finished):
    command = ["compare", "examples/tyre_harvester.toml", "examples/epps.csv", "--columns", text]
    assert "tip = TipDxb1; root moment" in " ".join(finished(main(command), 2).err.split())


def test_a_history_up_to_the_end_of_a_recorded_motion():
    """The run ends with the motion; a curve can then be found to be late, but no earlier than it begins."""
    t = np.linspace(0.0, 0.5, 51)
    scene = replace(PLAIN, motion=bd.SampledRotation(t, 20 * np.sin(3 * t) ** 2))
    run, times = bd.simulate(scene, 0.5), np.linspace(0.0, 0.5, 400)
    late = 1e-3
    data = bd.MeasuredHistory(times, run.deflection(np.maximum(times - late, 0.0)), rounding=1e-12)
    np.testing.assert_allclose(bd.compare(scene, data).delay, late, rtol=1e-3)


def test_a_curve_beside_nothing_left_out_is_outside_its_data_alone():
    positions, pressed = [0.0, 0.025], np.array([-0.3729, -0.1742])
    strip = bd.Beam.from_stiffness(0.05, 0.0157, 0.001333)
    scene = bd.Scene(strip, bd.Mount(radius=0.215))
    off = bd.MeasuredLoads(positions, 2 * pressed, ["axial"], speed=50.0, rounding=5e-5)
    (said,) = bd.compare(scene, off).sentences()
    assert said.endswith("outside the data's uncertainty (0.0067 %).")
    exact = replace(off, rounding=0.0)
    assert bd.compare(scene, exact).sentences()[0].endswith("outside the numerical error.")
