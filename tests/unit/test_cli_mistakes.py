"""Mistakes on the command line: each message names the option or the file, and what to give."""

from pathlib import Path

import pytest

import beamdyn as bd
from beamdyn.cli import BAD_INPUT, DONE

ROOT = Path(__file__).parents[2]
BLADE = str(ROOT / "examples" / "blade.toml")
TYRE = str(ROOT / "examples" / "tyre_harvester.toml")


@pytest.fixture
def refused(run):
    """The one line that a command says about bad input."""

    def refused(*arguments):
        code, out, err = run(*arguments)
        assert (code, out, err.count("\n")) == (BAD_INPUT, "", 1)
        return err

    return refused


@pytest.mark.parametrize("command", [("modes", BLADE), ("steady", BLADE, "--speeds", "5 rad/s")])
@pytest.mark.parametrize("count", ["2.5", "2.0", "0x3", "two", "1e1"])
def test_a_number_of_modes_is_whole(refused, command, count):
    assert f'"{count}" is not a whole number' in refused(*command, "--modes", count)


def test_other_counts_are_whole_too(refused, tmp_path):
    assert "--order" in refused("resonances", TYRE, "--top-speed", "50 rad/s", "--order", "1.5")
    sweep = ("sweep", TYRE, "--speeds", "5 rad/s", "--window", "0:1 s")
    assert "--workers" in refused(*sweep, "--workers", "1.5")


def test_the_largest_number_of_modes_is_named(refused):
    assert "at most 100" in refused("modes", BLADE, "--modes", "500")
    with pytest.raises(ValueError, match="at most 176 modes"):
        bd.natural_modes(bd.load_scene(BLADE), modes=500)
    with pytest.raises(ValueError, match="at most 1000 modes"):
        bd.natural_modes(bd.load_scene(BLADE), modes=1500, discretization="fem")


def test_a_trade_off_of_more_modes_than_its_reference_resolves_is_refused(refused):
    said = refused("tradeoff", TYRE, "--budget", "1 s", "--modes", "99")
    assert "--modes = 99: give a whole number from 1 to 20; " in said


def test_an_option_that_is_given_twice_is_named_with_a_remedy(refused):
    said = refused("identify", TYRE, "--measured", "62 Hz", "--free", "length", "--free", "thickness")
    assert "--free is given twice; give it once, with all values where it takes several." in said


@pytest.mark.parametrize(
    "command", [("simulate", "--t-end", "1 s"), ("sweep", "--speeds", "5 rad/s", "--window", "0:1 s")]
)
def test_a_missing_motion_is_missing_in_the_file(refused, command):
    name, *options = command
    sentence = refused(name, TYRE, *options)
    assert "tyre_harvester.toml: motion: missing" in sentence and "[motion]" in sentence


@pytest.mark.parametrize("option", [("--method", "ritz"), ("--method=fem",)])
def test_an_unknown_option_is_known_by_its_word(refused, option):
    assert "Unknown option: --method. Did you mean --discretization?" in refused("modes", BLADE, *option)
    for short, meant in (("--mode", "--modes"), ("--pl", "--plot")):
        said = refused("modes", BLADE, short, "3").replace('"', "")  # quoted in cyclopts 4.1
        assert f"Did you mean {meant}? See beamdyn modes --help." in said


@pytest.mark.parametrize(
    ("speeds", "remedy"),
    [
        ("50, 0, 100 rad/s", '"0, 50, 100 rad/s"'),
        ("525, 5e2, 525 rpm", '"5e2, 525 rpm"'),
    ],
)
def test_speeds_that_do_not_ascend_are_given_sorted(refused, speeds, remedy):
    sentence = refused("locus", BLADE, "--speeds", speeds)
    assert f'--speeds = "{speeds}": the speeds must ascend' in sentence and f"give {remedy}" in sentence


@pytest.mark.parametrize(
    ("speed", "sentence"),
    [
        ("nan rad/s", "not a finite number; give e.g. \"1 rpm\""),
        ("5 kg", "a unit of mass where angular speed is wanted; give e.g. \"5 rpm\""),
    ],
)  # fmt: skip
def test_a_speed_is_a_quantity(refused, speed, sentence):
    assert f'--speed = "{speed}": {sentence}' in refused("modes", BLADE, "--speed", speed)


def test_a_carrier_that_stands_still_excites_nothing(run):
    code, out, err = run("steady", TYRE, "--speeds", "0 rad/s")
    assert (code, out.count("stable")) == (DONE, 1)
    assert "warning: nothing excites the beam at 0 rad/s" in err


def test_doubtful_units_are_a_warning_of_the_program(run, tmp_path):
    scene = tmp_path / "soft.toml"
    scene.write_text(Path(BLADE).read_text(encoding="utf-8").replace("70 GPa", "70 kPa"), encoding="utf-8")
    code, _, err = run("modes", scene, "--speed", "0 rad/s", "--modes", "1")
    assert code == DONE
    assert err.startswith("beamdyn: warning: youngs_modulus = 70000 Pa with density = 2700 kg/m3")
    assert err.count("\n") == 1


def test_a_unit_that_the_shell_has_parted_from_its_number_is_said_to_need_quotes(refused):
    said = refused("modes", TYRE, "--speed", "50", "rad/s")
    assert (
        'One word too many: rad/s; leave it out, or put a value with spaces into quotes as in --speed "50 '
        in said
    )
    assert said.endswith("See beamdyn modes --help.\n")


def test_a_second_file_is_one_word_too_many(refused):
    said = refused("modes", TYRE, "other.toml")
    assert "One word too many: other.toml; leave it out" in said and "as in" not in said


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--tolerance", "abc"), '--tolerance: "abc" is not a number.'),
        (("--force=maybe",), '--force: "maybe" is not a value of a switch.'),
    ],
)
def test_values_that_an_option_does_not_take_are_refused_in_plain_words(refused, options, words):
    said = refused("modes", TYRE, *options)
    assert words in said and "See beamdyn modes --help." in said


def test_help_on_an_unknown_command_is_that_of_the_program(refused):
    assert refused("mode", TYRE).endswith("See beamdyn --help.\n")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("speed=+-2%", '--spread = "speed=+-2%": the value is 0'),
        ("thickness=2 %", '--spread = "beam.thickness=2 %": it is no tolerance'),
        ("thickness=+-1 kg", '--spread = "beam.thickness=+-1 kg": '),
    ],
)
def test_a_wrong_tolerance_names_its_option(refused, given, said):
    assert said in refused("study", TYRE, "--spread", given)


def test_a_key_that_is_given_twice_is_said_to_be(refused, tmp_path):
    """Not to need quotes."""
    file = tmp_path / "twice.toml"
    file.write_text('[beam]\nlength = "50 mm"\nlength = "60 mm"\n')
    said = refused("modes", file)
    assert "(at line 3" in said and "give each key and each [table] once" in said


def test_a_folder_without_a_name_is_no_place_for_pictures(refused, tmp_path, monkeypatch):
    """It would be the current folder."""
    monkeypatch.chdir(tmp_path)
    assert "--output: the name is empty; give a folder" in refused("reproduce", "--output", "")
    assert not [*tmp_path.iterdir()]


def test_a_refused_density_has_its_unit(refused, tmp_path):
    (tmp_path / "p.csv").write_text("f [Hz], psd [m2/s4/Hz]\n10, -0.1\n20, 0.1\n")
    assert "--psd, values = -0.1 m2/s4/Hz: " in refused("random", TYRE, "--psd", tmp_path / "p.csv")


def test_a_refused_end_of_transients_is_shown_as_it_was_given(refused):
    assert '--t-end = "1 s": the scene has no motion' in refused("tradeoff", TYRE, "--t-end", "1 s")


def test_a_name_like_none_lists_all_that_there_are(refused):
    """All begin with beam: that alone makes none the one that is meant."""
    said = refused("sensitivities", TYRE, "--inputs", "beam.nosuch")
    assert "beam.length, " in said and "beam.thickness" in said
    assert refused("sensitivities", TYRE, "--inputs", "beam.thicknes").endswith("give beam.thickness\n")


@pytest.mark.parametrize("given", [("-",), (TYRE, "--csv", "-"), (TYRE, "--json", "-")])
def test_a_dash_is_said_to_be_no_file(refused, given):
    assert "A dash names no file: give a name, such as /dev/stdin" in refused("modes", *given)


@pytest.mark.parametrize("name", ["", "  "])
def test_an_empty_name_is_not_the_current_folder(refused, name):
    assert 'one of the names is empty (""); give the name of a file' in refused("modes", name)
