"""Each command's help has an example, which works as it stands in the folder of the source."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from beamdyn import cli as beams
from beamdyn.common.edge.exit_codes import DONE
from brakes import cli as brakes
from brakes.answers import STANDARD

ROOT = Path(__file__).parents[2]
PROGRAMS = {"beamdyn": beams, "brakes": brakes}
COMMANDS = [
    (program, name)
    for program, module in PROGRAMS.items()
    for name in module.app.resolved_commands()
    if not name.startswith("-")
]
LONG = ("app", "reproduce", "tradeoff", "branches")  # that serve, or compute for many seconds
SECONDS = ("campbell", "sweep", "steady", "study", "caliper", "forklift", *STANDARD)
EACH = [pytest.param(*command, id=" ".join(command)) for command in COMMANDS]
RUN = [
    pytest.param(*command, id=" ".join(command), marks=[pytest.mark.slow] if command[1] in SECONDS else [])
    for command in COMMANDS
    if command[1] not in LONG
]


@pytest.fixture
def shown(capsys, monkeypatch):
    """Examples of a command as its help prints them, on a screen of 80 characters."""
    monkeypatch.setenv("COLUMNS", "80")

    def shown(program, name):
        assert PROGRAMS[program].main([name, "--help"]) == DONE
        _, mark, text = capsys.readouterr().out.partition("in the folder of the source:")
        assert mark, "no examples"
        examples, _, codes = text.partition("Exit codes:")
        assert codes, "no exit codes"
        return [line.strip() for line in examples.splitlines() if line.strip()]

    return shown


@pytest.mark.parametrize(("program", "name"), EACH)
def test_examples_are_whole_lines_of_the_command(shown, program, name):
    lines = shown(program, name)
    assert lines and all(line.startswith(f"{program} {name}") for line in lines)
    for line in lines:
        function, *_ = PROGRAMS[program].app.parse_args(
            shlex.split(line)[1:], exit_on_error=False, print_error=False
        )
        assert function.__module__.startswith(("beamdyn.", "brakes."))
        files = [Path(word) for word in shlex.split(line) if word.startswith("examples/")]
        assert all((ROOT / file).is_file() for file in files)


@pytest.mark.parametrize(("program", "name"), RUN)
def test_examples_have_an_answer(shown, program, name, tmp_path, monkeypatch, capsys):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    lines = shown(program, name)
    monkeypatch.chdir(tmp_path)
    for line in lines:
        code = PROGRAMS[program].main(shlex.split(line)[1:])
        out, err = capsys.readouterr()
        assert code == DONE and out, err
        wanted = re.findall(r"--(?:plot|json|output|free-bodies) (\S+)", line)
        assert all((tmp_path / file).stat().st_size for file in wanted)


@pytest.mark.parametrize(("program", "name"), EACH)
def test_help_is_in_the_words_of_its_program(program, name, finished):
    """No switch that only empties a list, and in the help of brakes no inputs of a beam."""
    text = finished(PROGRAMS[program].main([name, "--help"]), DONE).out
    assert "--empty-" not in text
    assert program == "beamdyn" or not re.search(r"thickness=|damping_ratio=", text)


@pytest.mark.parametrize("program", PROGRAMS)
def test_the_page_of_commands_has_each(program):
    page = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    listed = re.findall(rf"^\| `{program} ([\w-]+)` \|", page, re.MULTILINE)
    listed += STANDARD if program == "brakes" else ()  # rows that the site makes
    assert "<!-- standard brakes -->" in page
    assert sorted(listed) == sorted(name for each, name in COMMANDS if each == program)
