"""`brakes keys`: who begins with an empty file learns its tables and keys from the program."""

import pytest

from brakes.answers import STANDARD
from brakes.answers.caliper import CALIPER, MECHANISM
from brakes.answers.forklift import FORKLIFT
from brakes.cli import main

OTHERS = {each.name: each for each in (FORKLIFT, CALIPER, MECHANISM)}


@pytest.mark.parametrize("name", [*STANDARD, *OTHERS])
def test_every_key_is_listed_with_its_unit(name, finished, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    out = finished(main(["keys", name]), 0).out
    brake = OTHERS.get(name) or STANDARD[name][1]()
    for entry in brake.inputs({}):
        (first, *_) = [line.split() for line in out.splitlines() if line.split()[:1] == [entry.name]]
        assert first
        unit = {"rad": "deg"}.get(entry.quantity.unit, entry.quantity.unit)
        assert not unit or f"[{unit}]" in out or f"[{unit} or %]" in out
    assert "required" in out


def test_an_empty_file_and_an_unknown_command_say_where_to_begin(finished, tmp_path):
    file = tmp_path / "empty.toml"
    file.touch()
    assert "`brakes keys disc` lists them" in " ".join(finished(main(["disc", str(file)]), 2).err.split())
    assert "'vehicle', 'forklift', 'caliper' or 'mechanism'" in finished(main(["keys", "wheel"]), 2).err


def test_tables_that_may_be_left_out_are_said(capsys):
    main(["keys", "vehicle"])
    out = capsys.readouterr().out
    assert "[lever], which may be left out" in out
    assert "[road]\n" in out
    assert "slope of the road [deg or %], at least 0, at most 45 " in out  # as files give it


def test_which_tables_and_keys_go_together_is_said(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "400")
    for name, said in (
        (
            "disc",
            "[load]: give one of force, torque, peak_pressure, or cylinder_bore with line_pressure. A quant",
        ),
        ("forklift", "[forces] with [brake] or [levers] for the forces"),
        ("vehicle", "[lever], [cable] or [line], and [brakes] go together."),
    ):
        main(["keys", name])
        assert said in capsys.readouterr().out


def test_defaults_are_as_a_file_would_give_them(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    main(["keys", "disc"])
    rows = {line.split()[0]: line.rstrip() for line in capsys.readouterr().out.splitlines() if line.strip()}
    assert rows["stops"].endswith(" 1")
    assert 'such as [["20 degC", 0.4]' in rows["friction_curve"]
