"""What a harvester refuses, its file, its numbers, its command and its limits."""

from __future__ import annotations

import math
from dataclasses import replace
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.results import result
from beamdyn.files.scenes import parse_scene
from beamdyn.scene.numbers import number_at, paths_of, with_numbers
from beamdyn.steady import best_resistance, harvest

EXAMPLE = Path(__file__).parents[2] / "examples" / "bimorph.toml"
TEXT = EXAMPLE.read_text(encoding="utf-8")
SCENE = bd.load_scene(EXAMPLE)
STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
CERAMIC: dict[str, Any] = {
    "thickness": 1.5e-4,
    "density": 7750.0,
    "e31": -10.4,
    "c11e": 61e9,
    "eps33s": 1.33e-8,
}


def refused(*parts, beam=STRIP, **changes):
    with pytest.raises(ValueError) as refusal:
        bd.Harvester(**(CERAMIC | changes)).on(beam)
    said = str(refusal.value)
    assert "\n" not in said
    for part in parts:
        assert part in said, said


def test_bad_layers_are_refused_with_key_value_bound_and_remedy():
    refused("harvester.end = 0.06 m", "the beam ends at 0.05 m", end=0.06)
    refused("harvester.start = 0.04 m", "before their end at 0.03 m", "swapped", start=0.04, end=0.03)
    refused("harvester.start = 0.05 m", "the beam ends at 0.05 m", start=0.05)
    refused("harvester.resistance = -1 ohm", "at least 0", "0 is a short circuit", resistance=-1.0)
    refused("harvester.eps33s = None", "e31, c11e and eps33s", eps33s=None)
    refused("harvester.d31", "by d31, s11e and eps33t", d31=-1.7e-10)
    stressed = {"e31": None, "c11e": None, "eps33s": None, "d31": -1.7e-10, "s11e": 1.6e-11}
    refused("harvester.eps33t = 1e-09 F/m", "no material has more coupling", **stressed, eps33t=1e-9)
    refused("harvester.connection = 'both'", connection="both")
    layered = bd.Harvester(**CERAMIC).on(STRIP)
    refused("harvester.start", "overlap", beam=layered)
    refused("beam = 3: layers stand on a Beam", "Beam.rectangular makes one", beam=3)
    across = {"poissons_ratio": 0.5, "eps33s": 3e-9}
    refused("harvester.poissons_ratio = 0.5", "no material couples so much", **across)
    refused("harvester.poissons_ratio = 0.6", "at most 0.5", poissons_ratio=0.6)
    refused("rectangular section", beam=bd.Beam.from_stiffness(0.05, 0.0157, 1.3e-3))
    tapered = bd.Beam.rectangular(0.05, bd.Polynomial([0.02, -0.01]), 0.0002, 200e9, 7850.0)
    refused("width = 0.01", "constant under the layers", "a beam of constant width", beam=tapered)
    refused("twist", beam=bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, twist=0.3))


def test_a_file_says_its_mistakes_by_key():
    for old, new, said in (
        ('resistance = "200 kohm"', 'resistance = "-5 kohm"', "harvester.resistance"),
        ('end = "30 mm"', 'end = "60 mm"', "harvester.end"),
        ('eps33t = "15.33e-9 F/m"', "", "harvester.eps33t"),
        ('connection = "series"', 'connection = "star"', "harvester.connection"),
    ):
        with pytest.raises(ConfigError, match=said):
            parse_scene(TEXT.replace(old, new))


def test_files_of_open_and_short_circuits():
    for text, resistance in (("inf", math.inf), ("0 ohm", 0.0)):
        read = parse_scene(TEXT.replace('"200 kohm"', f'"{text}"'))
        assert number_at(read, "harvester.resistance") == resistance


def test_numbers_of_the_layers_and_of_the_bare_beam_are_set_together():
    assert number_at(SCENE, "harvester.resistance") == 200e3
    assert number_at(SCENE, "beam.thickness") == 0.0002
    changed = with_numbers(
        SCENE, {"harvester.thickness": 2e-4, "beam.thickness": 3e-4, "beam.tip.mass": 2e-3}
    )
    bare = bd.Beam.rectangular(0.05, 0.01, 3e-4, 200e9, 7850.0, tip=bd.TipMass(2e-3))
    assert SCENE.beam.electrodes is not None
    assert changed.beam == replace(SCENE.beam.electrodes.harvester, thickness=2e-4).on(bare)
    assert not any(path.startswith("harvester") for path in paths_of(bd.Scene(STRIP)))
    with pytest.raises(ValueError, match=r"harvester\.resistance"):
        with_numbers(bd.Scene(STRIP), {"harvester.resistance": 1.0})


@pytest.mark.parametrize(
    ("path", "values"),
    [("harvester.thickness", [1e-4, 2e-4]), ("beam.thickness", [1e-4, 3e-4]), ("mount.radius", [0.1, 0.2])],
)
@pytest.mark.parametrize("resistance", [0.0, math.inf])
def test_studies_solve_each_design_as_by_itself(resistance, path, values):
    given = with_numbers(SCENE, {"harvester.resistance": resistance})
    found = bd.study(given, {path: values}, speed=20.0, modes=2)
    wanted = [bd.natural_modes(with_numbers(given, {path: v}), 20.0, 2).frequency for v in values]
    np.testing.assert_allclose(found.value, wanted, rtol=1e-9)  # the errors are below that


@pytest.mark.slow
def test_studies_ask_for_power_and_strain_of_the_layers():
    vary = {"harvester.resistance": [1e5, 3e5]}
    alone = [bd.harvest(with_numbers(SCENE, {"harvester.resistance": r}), [60.0]) for r in (1e5, 3e5)]
    for what in ("power", "strain"):
        found = bd.study(SCENE, vary, what, speed=60.0)
        expected = np.concatenate([getattr(each, what) for each in alone])
        np.testing.assert_allclose(found.value, expected, rtol=1e-12)  # the same calls


def test_a_study_of_power_without_layers_is_refused():
    with pytest.raises(ValueError, match=r"radius = 0.2 m: the beam carries no piezoelectric layers; Harv"):
        bd.study(replace(SCENE, beam=STRIP), {"mount.radius": [0.2]}, "power", speed=60.0)


def test_outputs_that_a_circuit_does_not_have_are_refused():
    for resistance, output in ((0.0, "voltage"), (math.inf, "current")):
        given = with_numbers(SCENE, {"harvester.resistance": resistance})
        with pytest.raises(ValueError, match="circuit has none"):
            bd.frequency_response(given, 20.0, [10.0], output=output)
    with pytest.raises(ValueError, match=r"position = 0\.04 m: the layers end at 0\.03 m"):
        bd.frequency_response(SCENE, 20.0, [10.0], output=bd.LayerStrain(0.04))
    beside = with_numbers(SCENE, {"harvester.start": 0.02})
    with pytest.raises(ValueError, match=r"position = 0\.01 m: the layers begin at 0\.02 m"):
        bd.frequency_response(beside, 20.0, [10.0], output=bd.LayerStrain(0.01))
    with pytest.raises(
        ValueError, match=r"camber = True: it needs poissons_ratio of the beam and of its layers"
    ):
        replace(SCENE, physics=bd.Physics(camber=True))
    with pytest.raises(ValueError, match="short-circuited"):
        replace(SCENE, physics=bd.Physics(large_deflection=True))


def test_strain_past_its_limit_is_warned_of():
    found = bd.harvest(with_numbers(SCENE, {"harvester.strain_limit": 4e-5}), [20.0, 60.0], modes=2)
    assert found.strain[0] < found.strain_limit < found.strain[1]
    assert any("past their limit" in said and "60 rad/s" in said for said in found.warnings)
    assert not any("past their limit" in said for said in bd.harvest(SCENE, [60.0], modes=2).warnings)


def test_nothing_vibrates_without_gravity_and_road():
    still = replace(SCENE, motion=None, gravity=0.0)
    assert bd.harvest(still, [20.0], modes=1).power[0] == 0
    with pytest.raises(ValueError, match="nothing vibrates"):
        bd.best_resistance(still, 20.0, modes=1)


def test_a_resistance_that_hardly_conducts_takes_no_longer_than_an_open_circuit():
    """The slow decay of its charge is no state that resonates with the vibration."""
    found = [
        bd.harvest(with_numbers(SCENE, {"harvester.resistance": each}), [50.0], modes=3)
        for each in (1e15, math.inf)
    ]
    assert found[0].status[0] == "stable" and not found[0].warnings
    assert found[0].voltage[0] == pytest.approx(found[1].voltage[0], rel=3e-4)


@pytest.mark.parametrize(("resistance", "name"), [(0.0, "current"), (math.inf, "voltage")])
def test_without_a_load_the_error_is_that_of_the_voltage_or_current(resistance, name):
    scene = with_numbers(SCENE, {"harvester.resistance": resistance})
    few, many = (bd.harvest(scene, [50.0], modes=each) for each in (1, 12))
    apart = abs(getattr(few, name)[0] / getattr(many, name)[0] - 1)
    assert 5e-4 < apart < few.error[0] < 5 * apart


def test_layers_that_do_not_couple_harvest_nothing():
    with np.errstate(all="raise"):
        scene = with_numbers(SCENE, {"harvester.d31": 0.0})
        found = bd.harvest(scene, [50.0], modes=2)
        assert found.power[0] == 0 and found.amplitude[0] > 0
        with pytest.raises(ValueError, match="do not couple"):
            bd.best_resistance(scene, 50.0, modes=2)


def test_past_the_critical_speed_no_resistance_is_best():
    with pytest.raises(ValueError, match=r"speed = 300 rad/s: past the critical speed"):
        bd.best_resistance(SCENE, 300.0, modes=2)
    assert main(["best-resistance", str(EXAMPLE), "--speed", "300 rad/s"]) == 1


@pytest.mark.parametrize("beside", [-1e-9, 1e-9])
def test_beside_the_critical_speed(beside):
    """The first mode is nearly free there; the circuit has the flexibility of the modes left out alone."""
    critical = bd.critical_speed(SCENE)
    spaces = (bd.state_space(SCENE, critical * (1 + part)) for part in (beside, -1e-6))
    poles, farther = (np.sort(np.abs(np.linalg.eigvals(space.A))) for space in spaces)
    np.testing.assert_allclose(poles[3:], farther[3:], rtol=1e-4)  # but for the first mode and the charge
    with pytest.raises(ValueError, match="is at its critical speed"):
        bd.frequency_response(SCENE, critical * (1 + beside), [1.0, 5.0])


@pytest.mark.slow
def test_sensitivities_of_a_scene_with_layers(finished):
    """By the coupling, which is negative, and by a begin at 0; the load changes no natural mode."""
    given = with_numbers(SCENE, {"harvester.resistance": math.inf, "harvester.start": 0.005})
    found = bd.frequency_sensitivities(given, modes=1)
    names = [each.name for each in found.inputs]
    assert "harvester.resistance" not in names and "harvester.strain_limit" not in names
    for name, step in (("harvester.d31", 1e-15), ("harvester.end", 1e-6)):
        own = number_at(given, name)
        either = (with_numbers(given, {name: own + sign * step}) for sign in (1, -1))
        above, below = (bd.natural_modes(each, modes=1).frequency[0] for each in either)
        derivative = found.derivative[names.index(name), 0]
        assert derivative == pytest.approx((above - below) / (2 * step), rel=1e-4), name
    assert "harvester.s11e" in finished(main(["sensitivities", str(EXAMPLE), "--modes", "1"]), 0).out


def test_natural_modes_say_their_circuit(capsys, tmp_path):
    """A load changes none of them: short-circuited, or open."""
    path = tmp_path / "open.toml"
    path.write_text(TEXT.replace('"200 kohm"', '"inf"'), encoding="utf-8")
    for scene, said in ((EXAMPLE, "with the layers short-circuited, by"), (path, "with an open circuit, by")):
        assert main(["modes", str(scene)]) == 0
        assert main(["locus", str(scene), "--speeds", "0:50:2 rad/s"]) == 0
        assert " ".join(capsys.readouterr().out.split()).count(said) == 2


def test_the_command(finished, tmp_path):
    path = tmp_path / "power.csv"
    given = ["harvest", str(EXAMPLE), "--speeds", "40:60:3 rad/s", "--modes", "2", "--csv", str(path)]
    printed = finished(main(given), 0).out
    assert "power [W]" in printed and "Resonances: 44.47 rad/s, 58.77 rad/s" in printed
    assert path.read_text(encoding="utf-8").startswith("speed_rad_per_s,power_W,efficiency,voltage_V")


def test_a_random_road_is_warned_of_and_refused_where_it_says_nothing(capsys, finished, tmp_path):
    road = bd.RoadRoughness("C")
    found = bd.harvest(SCENE, [0.0, 20.0, 50.0], modes=2, road=road)
    assert found.road is not None and found.road.power[0] == 0 < found.road.power[1]
    said = " ".join(found.warnings)
    assert "the road lacks a spatial frequency that excites the first resonance, at 20 to 50 rad/s" in said
    assert "with 3 standard deviations of the response to the road, at 50 rad/s: past their limit" in said
    assert found.best[1] == pytest.approx(found.power[2] + found.road.power[2], rel=1e-15)
    rough = bd.harvest(SCENE, [100.0], modes=2, road=bd.RoadRoughness("C", highest=10.0))
    assert any("parametric term that is left out would raise" in said for said in rough.warnings)
    for scene, words in (
        (replace(with_numbers(SCENE, {"harvester.resistance": 0.0}), damping_ratio=0.0), "damping_ratio"),
        (replace(SCENE, motion=bd.SteadyRotation(50.0)), "rolling radius"),
    ):
        with pytest.raises(ValueError, match=words):
            bd.harvest(scene, [50.0], modes=1, road=road)
    with pytest.raises(ValueError, match=r'road = .C.: .*RoadRoughness\("C"\)'):
        bd.harvest(SCENE, [50.0], modes=1, road="C")  # pyright: ignore[reportArgumentType]
    path, given = (
        tmp_path / "power.csv",
        ["harvest", str(EXAMPLE), "--speeds", "60:90:2 km/h", "--modes", "2"],
    )
    assert "give --road" in finished(main([*given, "--highest", "5 1/m"]), 2).err
    assert main([*given, "--road", "A", "--highest", "10 1/m", "--csv", str(path)]) == 0
    assert "Additionally on a random road, class A, up to 10 1/m" in capsys.readouterr().out
    head, first, _ = path.read_text(encoding="utf-8").splitlines()
    assert float(
        dict(zip(head.split(","), first.split(","), strict=True))["velocity_km_per_h"]
    ) == pytest.approx(60)


def test_the_best_resistance_is_that_of_the_most_power_tried():
    best = bd.best_resistance(SCENE, 50.0, modes=2)
    assert best.tried_power.max() == pytest.approx(best.power[0], rel=1e-9)  # with one discretization
    assert best.resistances[best.tried_power.argmax()] == pytest.approx(best.resistance, rel=1e-5)
    assert np.isfinite(best.model_error)


def test_the_time_stated_counts_resonances_and_resistances_tried(monkeypatch):
    clock = [0.0]

    def taking(seconds, does):
        def late(*given):
            clock[0] += seconds
            return does(*given)

        return late

    for module in (result, harvest, best_resistance):
        monkeypatch.setattr(module, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(harvest, "resonance_speeds", taking(1.0, harvest.resonance_speeds))
    monkeypatch.setattr(best_resistance, "steady_response", taking(10.0, best_resistance.steady_response))
    assert bd.harvest(SCENE, [50.0], modes=1).provenance.wall_time == 1.0
    assert bd.best_resistance(SCENE, 50.0, modes=1).provenance.wall_time == 11.0


def test_the_best_resistance_is_printed_with_the_digits_that_more_modes_keep(capsys):
    assert main(["best-resistance", str(EXAMPLE), "--speed", "55 rad/s", "--modes", "1"]) == 0
    printed = capsys.readouterr().out.partition("Harvested with ")[2].split()[0]
    last = 10.0 ** int(Decimal(printed).as_tuple().exponent)
    assert abs(float(printed) - bd.best_resistance(SCENE, 55.0, modes=5).resistance) <= last


def test_summary_and_picture_give_the_best_resistance_the_digits_of_the_table():
    best = bd.best_resistance(SCENE, 55.0, modes=1)
    digits = best.say_resistance()
    rounded = Decimal(digits.removesuffix(" ohm"))
    assert abs(float(rounded) - best.resistance) <= 10.0 ** int(rounded.as_tuple().exponent) / 2
    assert f"best resistance {digits} at" in str(best)
    assert f"best, {digits}" in best.plot().get_legend_handles_labels()[1]


@pytest.mark.slow
def test_the_error_of_a_best_resistance_counts_how_flat_the_power_is():
    """A load that alone damps takes all power of nearly white noise: the power hardly depends on it."""
    undamped = replace(SCENE, damping_ratio=0.0, motion=bd.RollingWheel(0.3, 55.0))
    road = bd.RoadRoughness("A", highest=10.0)
    two, three = (bd.best_resistance(undamped, 50.0, modes=count, road=road) for count in (2, 3))
    assert abs(two.resistance - three.resistance) <= two.resistance_error


def test_the_best_resistance_of_slow_motion_is_inverse_to_the_speed():
    slow, slower = (bd.best_resistance(SCENE, speed, modes=1) for speed in (1e-2, 1e-4))
    assert 100 * slow.resistance == pytest.approx(slower.resistance, rel=1e-3)
    assert slow.resistance_error < slow.resistance


@pytest.mark.slow
def test_the_best_resistance_counts_the_power_of_a_random_road(capsys):
    road = bd.RoadRoughness("A", highest=10.0)
    best = bd.best_resistance(SCENE, 50.0, modes=1, road=road)
    assert best.resistance != pytest.approx(bd.best_resistance(SCENE, 50.0, modes=1).resistance, rel=0.01)
    for factor in (0.9, 1.1):
        other = with_numbers(SCENE, {"harvester.resistance": factor * best.resistance})
        (found,) = bd.harvest(other, [50.0], modes=1, road=road).total_power
        assert found < best.total_power[0]
    given = ["best-resistance", str(EXAMPLE), "--speed", "50 rad/s", "--modes", "1", "--highest", "10 1/m"]
    assert main(given) == 2 and "give --road" in capsys.readouterr().err
    assert main([*given, "--road", "A"]) == 0
    printed = capsys.readouterr().out
    assert "Additionally on a random road, class A, up to 10 1/m" in printed
    assert " 1 mode," in " ".join(printed.split()) and "Resonances" not in printed  # at one speed


@pytest.mark.slow
@pytest.mark.parametrize("root_stiffness", [math.inf, 10.0])
def test_a_harvester_that_begins_in_equilibrium_stays_there_without_voltage(root_stiffness):
    layered = bd.Harvester(**CERAMIC, resistance=1e5).on(STRIP)
    mount = bd.Mount(0.1, 0.5, root_stiffness=root_stiffness)
    scene = bd.Scene(layered, mount, bd.SteadyRotation(50.0), damping_ratio=0.01)
    still, moving = (bd.simulate(scene, 0.2, initial=start) for start in ("equilibrium", "rest"))
    bent = bd.natural_modes(scene, 50.0, 1).static_deflection
    np.testing.assert_allclose(still.tip, bent, rtol=1e-4)  # of the modes left out
    voltages = (np.abs(bd.transient_harvest(each).voltage).max() for each in (still, moving))
    assert next(voltages) < 1e-9 * next(voltages)
