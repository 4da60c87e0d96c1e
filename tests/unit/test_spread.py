"""Spreads: tolerances as text, refusals, what follows from the seed, files and pictures, the commands."""

import csv
import json
import pickle

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.cli import main
from beamdyn.common.edge.input_sweep import Output, one_by_one
from beamdyn.common.edge.spread_tables import headline
from beamdyn.common.edge.varied_inputs import parse_axis
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.spreading.statistics import BLOCKS, SpreadDesigns
from beamdyn.common.spreading.tolerances import SpreadInput, parse_tolerance
from beamdyn.common.spreading.worst_case import trends_of
from brakes.answers.caliper import MECHANISM
from brakes.cli import main as brakes

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
SCENE = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2))
FEW = {"samples": 128, "modes": 1}
HARVESTER = "examples/tyre_harvester.toml"
DRUM = "examples/drum.toml"
ROUNDING = 1e-14  # of a sum of two numbers


@pytest.fixture(scope="module")
def found():
    given = {"beam.thickness": "+-2%", "mount.radius": "sd 1%", "speed": bd.Uniform(40.0, 55.0)}
    return bd.spread(SCENE, given, samples=128, modes=2, speed=50.0)


@pytest.mark.parametrize(
    ("text", "low", "high"),
    [
        ("+-2%", 1.96, 2.04),
        ("± 2 %", 1.96, 2.04),
        ("+/-0.5", 1.5, 2.5),
        ("+1% -2%", 1.96, 2.02),
        ("-2%+1%", 1.96, 2.02),
        ("+1, -2 %", 1.96, 2.02),
        ("+1%", 2.0, 2.02),
        ("-1e-1", 1.9, 2.0),
        ("1.5 to 3", 1.5, 3.0),
        ("-1 to 3", -1.0, 3.0),
        ("sd 1%", 1.94, 2.06),
    ],
)
def test_forms_of_a_tolerance(text, low, high):
    made = parse_tolerance("x", text, 2.0, "", lambda number, unit: float(number))
    np.testing.assert_allclose(made.ends, (low, high), rtol=ROUNDING)
    assert made.text == text and isinstance(made, bd.Normal) == text.startswith("sd")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "it names no input"),
        ("beam.thickness", "it names no input"),
        ({"beam.thicknes": "+-2%"}, "give beam.thickness"),
        ({"beam.thickness": "2%"}, "it is no tolerance"),
        ({"beam.thickness": 0.02}, "give a Uniform or a Normal"),
        ({"beam.thickness": "+-0%"}, "leave the input out"),
        ({"beam.thickness": "+1% +2%"}, "one of each"),
        ({"beam.thickness": "+-0.01 mm"}, "percentages, or numbers in m"),
        ({"beam.thickness": "+-150%"}, "-0.0001 m, which +-150% reaches"),
        ({"beam.thickness": "sd 30%"}, "which sd 30% reaches"),
        ({"beam.thickness": "1e-3 to 2e-3"}, "does not contain the nominal value, 0.0002 m"),
        ({"beam.thickness": bd.Uniform(1e-3, 2e-3)}, "does not contain the nominal value"),
        ({"beam.thickness": "3e-4 to 1e-4"}, "it must ascend"),
        ({"beam.thickness": "90% to 110%"}, 'give percentages as "+1% -2%"'),
        ({"mount.setting_angle": "+-1%"}, "give it in rad"),
        ({"model.damping_ratio": "+-1%"}, "give a plain number"),
        ({"mount.root_stiffness": "+-1%"}, "the scene's value is inf"),
        ({"beam.shear_stiffness": "+-1%"}, "no such number"),
        ({"beam.tip.inertia": "+-1%"}, "give it in kg m2"),
    ],
)
def test_refusals(given, said):
    with pytest.raises(InvalidValue) as refused:
        bd.spread(SCENE, given, **FEW)
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"samples": 64}, "from 128 to"),
        ({"samples": 200.5}, "whole number"),
        ({"seed": -1}, "seed = -1"),
        ({"what": "weight"}, "what = 'weight'"),
    ],
)
def test_refused_options(options, said):
    with pytest.raises(InvalidValue, match=said):
        bd.spread(SCENE, {"beam.thickness": "+-2%"}, **options)


def test_a_distribution_has_two_ends_in_order():
    with pytest.raises(InvalidValue, match="above low = 2"):
        bd.Uniform(2.0, 1.0)
    with pytest.raises(InvalidValue, match="greater than 0"):
        bd.Normal(2.0, 0.0)


def test_a_property_that_varies_has_a_factor():
    tapered = bd.Beam.rectangular(**BEAM | {"thickness": np.polynomial.Polynomial([2e-4, -1e-4])})
    scene = bd.Scene(tapered, bd.Mount(0.2))
    with pytest.raises(InvalidValue, match=r"give a spread of beam\.scale\.thickness"):
        bd.spread(scene, {"beam.thickness": "+-1%"}, **FEW)
    assert np.isfinite(bd.spread(scene, {"beam.scale.thickness": "+-1%"}, **FEW).indices.total).all()


@pytest.mark.slow
def test_the_strip_under_layers_has_a_section():
    layered = bd.load_scene("examples/bimorph.toml")
    made = bd.spread(layered, {"beam.density": "+-2%"}, **FEW)
    assert made.inputs[0].nominal == 7850.0 and np.isfinite(made.indices.total).all()


def test_samples_that_are_no_power_of_two():
    found = bd.spread(SCENE, {"beam.thickness": "+-2%"}, samples=200, modes=1)
    assert found.samples == 256
    assert "samples = 200: 256, the next power of two, are used" in found.warnings


def test_designs_of_a_sample_differ_from_the_other_in_one_input():
    inputs = [SpreadInput(name, "", 0.5, bd.Uniform(0.0, 1.0)) for name in "abc"]
    designs = SpreadDesigns(inputs, 128, 7)
    _, _, random = designs.part(designs.table)
    for i in range(3):
        expected = random[0].copy()
        expected[:, i] = random[1][:, i]
        assert np.array_equal(random[2 + i], expected)
    blocks = random[0][:, 0].reshape(BLOCKS, -1)  # each is spread evenly: one point in each eighth
    assert (np.sort(np.floor(8 * blocks), axis=1) == np.arange(8)).all()


@pytest.mark.slow
def test_samples_follow_from_the_seed_and_from_nothing_else():
    """Parts of 1024 answers, so that two workers have some."""
    given = {"beam.thickness": "+-2%", "beam.length": "+-1%"}
    first, again, other = (
        bd.spread(SCENE, given, samples=512, modes=1, seed=seed, workers=workers)
        for seed, workers in ((3, 1), (3, 2), (4, 1))
    )
    assert again.to_dict() | {"provenance": None} == first.to_dict() | {"provenance": None}
    assert not np.isin(other.sampled_inputs, first.sampled_inputs).any()


def test_answers_are_those_of_the_designs(found):
    """As of a single call: within the errors of both, some 1e-9."""
    design = found.design(17)
    scene = bd.Scene(
        bd.Beam.rectangular(**BEAM | {"thickness": design["beam.thickness"]}),
        bd.Mount(design["mount.radius"]),
    )
    single = bd.natural_modes(scene, design["speed"], 2).frequency
    np.testing.assert_allclose(found.sampled_answers[17], single, rtol=1e-8)
    np.testing.assert_allclose(found.nominal, bd.natural_modes(SCENE, 50.0, 2).frequency, rtol=1e-8)
    for value, at in (
        (found.worst.smallest, found.worst.smallest_at),
        (found.worst.largest, found.worst.largest_at),
    ):
        scene = bd.Scene(bd.Beam.rectangular(**BEAM | {"thickness": at[0, 0]}), bd.Mount(at[0, 1]))
        assert np.isclose(value[0], bd.natural_modes(scene, at[0, 2], 2).frequency[0], rtol=1e-8)


def test_no_random_design_is_beyond_the_worst_cases(found):
    """But for values of the normal input beyond three standard deviations, which a worst case leaves out."""
    radius = found.sampled_inputs[:, 1]
    inside = found.sampled_answers[np.abs(radius - 0.2) <= 0.006]
    assert (inside >= found.worst.smallest).all() and (inside <= found.worst.largest).all()


def test_saved_read_and_pickled(found, tmp_path):
    found.save(tmp_path / "spread.json")
    for again in (bd.load(tmp_path / "spread.json"), pickle.loads(pickle.dumps(found))):
        assert again.to_dict() == found.to_dict()
        assert again.matters_most() == found.matters_most()
    numbers = json.loads((tmp_path / "spread.json").read_text())
    assert np.shape(numbers["indices"]["total"]) == (3, 2)


def test_drawn(found):
    ax = found.plot(Figure().subplots(), 1)
    assert ax.get_xlabel() == "mode 2 [Hz]"
    assert sum(patch.get_height() for patch in ax.patches) == pytest.approx(100)
    bars = found.plot_indices(Figure().subplots())
    assert [label.get_text() for label in bars.get_yticklabels()] == [each.name for each in found.inputs]


def test_headline_has_the_digits_of_its_errors(found):
    said = headline(found, 0)
    assert said.startswith("mode 1: ") and "beam.thickness matters most" in said
    deviation = said.partition("standard deviation ")[2].partition(" Hz")[0]
    half_unit = 0.5 * 10.0 ** -len(deviation.partition(".")[2])
    assert half_unit >= found.scatter.deviation_error[0]


def test_one_input_makes_all_of_the_variance():
    indices = bd.spread(SCENE, {"beam.thickness": "+-2%"}, **FEW).indices
    assert indices.first == indices.total == 1


# Commands -----------------------------------------------------------------------------------------


def test_command(tmp_path, finished):
    files = {name: tmp_path / f"s.{name}" for name in ("json", "csv", "png", "html")}
    options = [["--json", "json"], ["--csv", "csv"], ["--plot", "png"], ["--report", "html"]]
    asked = [part for option, name in options for part in (option, str(files[name]))]
    given = ["--spread", "beam.thickness=+-2%", "--spread", "mount.radius=+-1 mm", "--samples", "128"]
    shown = finished(main(["study", HARVESTER, *given, "--modes", "2", *asked]), 0).out
    assert "beam.thickness matters most" in shown and "+-1 mm" in shown
    assert max(map(len, shown.splitlines())) <= 120
    rows = [*csv.reader(files["csv"].read_text().splitlines())]
    assert (
        rows[0] == ["beam_thickness_m", "mount_radius_m", "frequency_Hz_1", "frequency_Hz_2"]
        and len(rows) == 257
    )
    loaded = bd.load(files["json"])
    np.testing.assert_allclose(loaded.inputs[1].distribution.ends, (0.214, 0.216), rtol=ROUNDING)
    assert all(path.stat().st_size > 1000 for path in files.values())


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--spread", "beam.thickness=+-0.01"], "give a unit"),
        (["--spread", "beam.thickness=+-1 kg"], "a unit of mass where length is wanted"),
        (["--spread", "beam.thicknes=+-1%"], "did you mean beam.thickness?"),
        (["--spread", "beam.thickness"], "give KEY=TOLERANCE"),
        (["--spread", "beam.thickness=+-1%", "--spread", "thickness=+-2%"], "has a tolerance already"),
        (["--spread", "beam.thickness=+-1%", "--vary", "beam.thickness=0.1:0.2:3 mm"], "is varied, or has"),
        (["--spread", "beam.thickness=+-1%", "--vary", "beam.width=5:9:3 mm"], "--vary does not go with"),
        (["--spread", "beam.thickness=+-1%", "--together"], "--together does not go with"),
        (["--spread", "mount.setting_angle=+-1%"], "the value is 0"),
        (["--spread", "beam.thickness=+-1%", "--samples", "3"], "--samples = 3"),
        (["--spread", "beam.thickness=+-1%", "--samples", "200.5"], "not a whole number"),
        (["--seed", "3"], "--seed goes with --spread"),
    ],
)
def test_mistakes_of_a_command(given, said, finished):
    assert said in finished(main(["study", HARVESTER, *given]), 2).err


def test_torque_of_a_drum_is_proportional_to_its_force(tmp_path, capsys):
    """The share of the variance and the standard deviation of a product are in closed form."""
    path = tmp_path / "drum.json"
    given = ["--spread", "load.force=+-10%", "--spread", "brake.friction=+-1%", "--what", "torque,c_star"]
    assert brakes(["drum", DRUM, *given, "--json", str(path)]) == 0
    found = bd.load(path)
    assert found.answers == ("torque", "c_star") and found.units == ("N m", "")
    assert found.matters_most(0) == ("load.force",) and found.matters_most(1) == ("brake.friction",)
    of_force = found.first_order.slope[0, 0] * 1000.0
    assert abs(of_force - found.nominal[0]) <= found.first_order.slope_error[0, 0] * 1000.0 + 1e-9 * of_force
    of_factor = found.scatter.deviation[1] / found.scatter.mean[1]
    deviation = found.scatter.mean[0] * np.sqrt((1 + of_factor**2) * (1 + 0.01 / 3) - 1)
    assert abs(found.scatter.deviation[0] - deviation) <= 3 * found.scatter.deviation_error[0]
    assert found.trends[0].tolist() == ["rises", "does not change"]
    assert "load.force matters most" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["drum", DRUM, "--spread", "friction=+-150%"], "it must be at least 0"),
        (["drum", DRUM, "--spread", "line_pressure=+-1%"], "the file gives it no value"),
        (["drum", DRUM, "--spread", "frictoin=+-1%"], "did you mean"),
        (["drum", DRUM, "--spread", "friction=+-1%", "--what", "torqe"], "did you mean torque?"),
        (["drum", DRUM, "--what", "torque"], "--what goes with --vary or --spread"),
        (["caliper", "eebrake", "--spread", "dimensions.clearance=+-1%"], "give fewer samples"),
    ],
)
def test_mistakes_of_a_command_on_brakes(given, said, finished):
    assert said in finished(brakes(given), 2).err


def test_designs_of_a_named_caliper_go_to_workers():
    """The class of its table of dimensions is made as the file is read: no worker knows it."""
    tables, _ = MECHANISM.open("eebrake")
    design = MECHANISM.read(tables, "eebrake")
    inputs = MECHANISM.sweep_inputs(design, tables)
    axes = [parse_axis(inputs, text) for text in ("clearance=1:2:3 mm", "dimensions.pad.y=-46:-44:3 mm")]
    sent = []

    def solve(task):
        sent.append(pickle.loads(pickle.dumps(task)))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        one_by_one(tables, axes, [Output("finger_travel", "", float)], solve)
    assert np.array_equal(sent[0].given[0], [1.0, -46.0])


def test_an_answer_that_no_design_has_neither_rises_nor_stays():
    answers = np.array([[[1.0, np.nan]], [[2.0, np.nan]], [[2.0, np.nan]]])  # of A, B, and A with B's input
    trends = trends_of(answers, np.zeros_like(answers), np.array([[0.0]]), np.array([[1.0]]))
    assert trends.tolist() == [["rises", "no answer"]]
