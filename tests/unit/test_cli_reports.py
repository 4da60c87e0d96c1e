"""`--report FILE.html` of every command that has an answer."""

from __future__ import annotations

import base64
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET
from html import unescape
from pathlib import Path

import numpy as np
import pytest

import beamdyn.cli
import brakes.cli
from beamdyn import __version__
from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE, NO_ANSWER
from beamdyn.common.edge.html_report import Question, report_page
from brakes.calipers import NAMED
from brakes.config.mechanism import named, parse_mechanism

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
BLADE, ROLLING = EXAMPLES / "blade.toml", EXAMPLES / "rolling_harvester.toml"
LEANING = EXAMPLES / "harvester_45deg.toml"
DRUM, FORKLIFT = EXAMPLES / "drum.toml", EXAMPLES / "forklift.toml"
CLAMP, OWN = EXAMPLES / "calipers" / "toggle-clamp.toml", EXAMPLES / "calipers" / "own-caliper.toml"

# Command, its file, its options, how many drawings its report has.
COMMANDS = {
    "modes": (beamdyn.cli, BLADE, ["--speed", "20 rad/s"], 1),
    "locus": (beamdyn.cli, BLADE, ["--speeds", "0:150:7 rad/s"], 1),
    "resonances": (beamdyn.cli, ROLLING, ["--top-speed", "150 rad/s"], 1),
    "campbell": (beamdyn.cli, ROLLING, ["--top-speed", "150 rad/s"], 1),
    "study": (beamdyn.cli, BLADE, ["--vary", "mount.radius=1:2:3 m"], 1),
    "steady": (beamdyn.cli, ROLLING, ["--speeds", "40:60:5 rad/s"], 1),
    "simulate": (beamdyn.cli, ROLLING, ["--t-end", "0.5 s", "--modes", "1"], 1),
    "loads": (beamdyn.cli, ROLLING, ["--t-end", "0.2 s", "--modes", "1"], 1),
    "sweep": (
        beamdyn.cli,
        ROLLING,
        ["--speeds", "10:11:2 rad/s", "--window", "10:10.2 s", "--modes", "1"],
        1,
    ),
    "tradeoff": (beamdyn.cli, BLADE, ["--budget", "0.5 s"], 1),
    "equilibrium": (beamdyn.cli, LEANING, ["--speed", "50 rad/s"], 1),
    "drum": (brakes.cli, DRUM, [], 1),
    "drum --vary": (brakes.cli, DRUM, ["--vary", "friction=0.1:0.5:3"], 1),
    "forklift": (brakes.cli, FORKLIFT, [], 1),
    "forklift --vary": (brakes.cli, FORKLIFT, ["--vary", "stop.speed=10:20:3 km/h"], 1),
    "caliper": (brakes.cli, OWN, [], 2),
    "caliper of parts": (brakes.cli, CLAMP, [], 2),
    "caliper --vary": (brakes.cli, OWN, ["--vary", "points.right_pad.y=-50:-46:3 mm"], 1),
}


def pictures(page: str) -> list[str]:
    """SVGs that a page holds."""
    found = re.findall(r'src="data:image/svg\+xml;base64,([^"]*)"', page)
    return [base64.b64decode(data, validate=True).decode() for data in found]


def inputs(page: str) -> str:
    """What a page says that was asked."""
    (text,) = re.findall(r"<pre>(.*?)</pre>", page, re.DOTALL)
    return unescape(text)


def cells(page: str) -> set[str]:
    """What stands in its tables."""
    return {unescape(re.sub("<[^>]*>", "", text)) for text in re.findall(r"<td[^>]*>(.*?)</td>", page)}


@pytest.mark.parametrize("name", COMMANDS)
def test_report_has_inputs_results_drawings_and_version_in_one_file(name, tmp_path, finished):
    program, file, options, drawings = COMMANDS[name]
    path = tmp_path / "report.html"
    printed = finished(program.main([name.split()[0], str(file), *options, "--report", str(path)]), DONE)
    page = path.read_text(encoding="utf-8")
    assert len(pictures(page)) == drawings
    assert {ET.fromstring(text).tag for text in pictures(page)} == {"{http://www.w3.org/2000/svg}svg"}
    assert not re.search(r"<(script|link|iframe|object)\b|\bhref=|url\(|@import|src=\"(?!data:)", page)
    assert tomllib.loads(inputs(page)) == tomllib.loads(file.read_text(encoding="utf-8"))
    assert all(word in inputs(page).splitlines()[0] for option in options for word in option.split())
    assert f"beamdyn {__version__}" in page
    numbers = {word for word in re.findall(r"\S*\d\S*", printed.out) if word in cells(page)}
    assert len(numbers) >= 3, printed.out
    for warning in re.findall(r": warning: (.*)", printed.err):
        assert warning in unescape(page)


@pytest.mark.parametrize(
    ("command", "file", "options", "said"),
    [
        ("critical", ROLLING, [], "critical speed: 159.818332659 rad/s"),
        ("limits", ROLLING, ["--top-speed", "100 rad/s"], "Setting-angle limits up to 100 rad/s"),
        ("terms", BLADE, [], "Left out: torsion"),
        ("branches", LEANING, ["--top-speed", "50 rad/s"], "Branches of equilibria up to 50 rad/s"),
    ],
)
def test_report_of_few_numbers(command, file, options, said, tmp_path):
    path = tmp_path / "report.html"
    assert beamdyn.cli.main([command, str(file), *options, "--report", str(path)]) == DONE
    page = path.read_text(encoding="utf-8")
    assert said in re.sub("<[^>]*>", "", unescape(page))
    assert len(pictures(page)) == (command == "branches")


def test_report_holds_all_rows_that_are_printed(tmp_path, capsys):
    """The forces of a drum brake by Shigley's integrals: 262.96 = 176.73 + 86.233 N m."""
    path = tmp_path / "report.html"
    assert brakes.cli.main(["drum", str(DRUM), "--report", str(path)]) == DONE
    assert {"262.96", "176.73", "86.233"} <= cells(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", NAMED)
def test_report_on_a_named_caliper_has_its_dimensions(name, tmp_path, capsys):
    path = tmp_path / "report.html"
    assert brakes.cli.main(["caliper", name, "--report", str(path)]) == DONE
    found = parse_mechanism(inputs(path.read_text(encoding="utf-8")))
    said = tomllib.loads(inputs(path.read_text(encoding="utf-8")))["dimensions"]
    keys = type(named(name).dimensions).model_fields  # pyright: ignore[reportAttributeAccessIssue]
    assert said.keys() == keys.keys()
    for key in keys:
        value, wanted = (getattr(design.dimensions, key) for design in (found, named(name)))  # pyright: ignore[reportAttributeAccessIssue]
        if isinstance(wanted, str):
            assert value == wanted
        else:  # written with 12 digits, in mm
            np.testing.assert_allclose(value, wanted, rtol=1e-11, atol=1e-15)


# Answers that are refused --------------------------------------------------------------------------------


def test_report_on_a_brake_that_locks_says_so(tmp_path, capsys):
    file, path = tmp_path / "locks.toml", tmp_path / "report.html"
    file.write_text(DRUM.read_text(encoding="utf-8").replace("friction = 0.35", "friction = 1.2"))
    assert brakes.cli.main(["drum", str(file), "--report", str(path)]) == NO_ANSWER
    assert "<strong>Warning:</strong> locked: friction 1.2 is" in path.read_text(encoding="utf-8")


def test_report_on_a_truck_that_does_not_stop_says_so(tmp_path, capsys):
    file, path = tmp_path / "slides.toml", tmp_path / "report.html"
    file.write_text(FORKLIFT.read_text(encoding="utf-8").replace("friction = 0.7 ", "friction = 0.3 "))
    assert brakes.cli.main(["forklift", str(file), "--report", str(path)]) == NO_ANSWER
    said = capsys.readouterr().err.partition("no answer: ")[2].strip()
    assert said and said in unescape(path.read_text(encoding="utf-8"))


def test_report_on_an_unstable_beam_says_so(tmp_path, capsys):
    path = tmp_path / "report.html"
    assert (
        beamdyn.cli.main(["modes", str(ROLLING), "--speed", "300 rad/s", "--report", str(path)]) == NO_ANSWER
    )
    assert "<strong>Warning:</strong> unstable at 300 rad/s" in path.read_text(encoding="utf-8")


def test_report_on_a_mechanism_that_statics_does_not_determine_says_so(tmp_path, capsys):
    file, path = tmp_path / "held.toml", tmp_path / "report.html"
    held = '\n[[pin]]\nname = "extra"\nbody = "arm"\nat = "E"\n\n[[force]]'
    text = CLAMP.read_text(encoding="utf-8").partition("[run]")[0].replace("\n[[force]]", held, 1)
    file.write_text(text, encoding="utf-8")
    assert brakes.cli.main(["caliper", str(file), "--report", str(path)]) == NO_ANSWER
    said = capsys.readouterr().err.partition("no answer: ")[2].strip()
    assert said and f"Warning:</strong> {said}" in unescape(path.read_text(encoding="utf-8"))


# Files that cannot be written, before anything is computed ----------------------------------------------


@pytest.mark.parametrize(
    "name, sentence",
    [
        ("report.txt", "unknown suffix '.txt'; give one of .html"),
        ("none/report.html", "there is no folder"),
        ("old.html", "the file exists; add --force"),
    ],
)
@pytest.mark.parametrize("command", ["caliper", "forklift", "drum"])
def test_file_that_cannot_be_written_is_refused_first(command, name, sentence, tmp_path, capsys):
    (tmp_path / "old.html").write_text("mine")
    path = tmp_path / name
    assert brakes.cli.main([command, "no-such-file.toml", "--report", str(path)]) == BAD_INPUT
    assert f"--report = {path}: {sentence}" in capsys.readouterr().err
    assert (tmp_path / "old.html").read_text() == "mine"


def test_force_overwrites_and_each_file_is_its_own(tmp_path, finished):
    path = tmp_path / "old.html"
    path.write_text("mine")
    assert brakes.cli.main(["drum", str(DRUM), "--report", str(path), "--force"]) == DONE
    assert "262.96" in path.read_text(encoding="utf-8")
    both = ["--report", str(path), "--csv", str(path), "--force"]
    assert "give each its own file" in finished(brakes.cli.main(["drum", str(DRUM), *both]), BAD_INPUT).err


# Text of others is text ---------------------------------------------------------------------------------


def test_markup_of_a_file_stays_text(tmp_path, capsys):
    file, path = tmp_path / "a<b>.toml", tmp_path / "report.html"
    file.write_text('caliper = "v-brake"\ntitle = "<script>alert(1)</script>"\n')
    assert brakes.cli.main(["caliper", str(file), "--report", str(path)]) == DONE
    page = path.read_text(encoding="utf-8")
    assert "<script" not in page and "a<b>" not in page
    assert "&lt;script&gt;alert(1)" in page
    assert "<script" not in report_page("<script>", "<script>", [("<script>", ["<script>"], "", "")])


def test_options_cannot_leave_their_comment():
    asked = Question.of("brakes drum", "a.toml", "x = 1\n", vary=("a\nx = 2", "b\r\nx = 3"), none=None)
    assert tomllib.loads(asked.inputs) == {"x": 1}
    assert asked.inputs.splitlines()[0].count("--vary") == 2 and "none" not in asked.inputs


def test_commands_load_nothing_for_a_report_that_is_not_asked_for():
    code = "import brakes.cli, beamdyn.cli, sys; print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=True
    )
    assert not {"matplotlib", "numpy", "pydantic", "nicegui", "pint"} & set(done.stdout.split())


@pytest.mark.slow
def test_report_needs_no_interactive_program(tmp_path):
    code = (
        "import sys; sys.modules['nicegui'] = None; from brakes.cli import main; "
        f"sys.exit(main(['drum', {str(DRUM)!r}, '--report', {str(tmp_path / 'r.html')!r}]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == DONE, done.stderr
    assert (tmp_path / "r.html").exists()
