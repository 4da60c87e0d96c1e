"""On a terminal, a command that takes over a second says so on standard error, and elsewhere nothing."""

from __future__ import annotations

import io
import re
import sys
import time
from pathlib import Path

import pytest

from beamdyn import cli as beams
from beamdyn.common.edge import console
from beamdyn.common.edge.console import at_work, quiet
from beamdyn.common.edge.exit_codes import DONE
from brakes import cli as brakes
from tests.unit.toml_scenes import without_camber

EXAMPLES = Path(__file__).parents[2] / "examples"
ROLLING, TYRE = str(EXAMPLES / "rolling_harvester.toml"), str(EXAMPLES / "tyre_harvester.toml")
COMMANDS = [
    (beams, "beamdyn modes", TYRE),
    (beams, "beamdyn loads", TYRE, "--speed", "20 rad/s"),
    (beams, "beamdyn simulate", ROLLING, "--t-end", "0.2 s", "--modes", "2"),
    (brakes, "brakes drum", str(EXAMPLES / "drum.toml")),
]
COUNTED = [
    (beams, "study", TYRE, "--vary", "beam.thickness=0.2:0.3:4 mm", "--what", "critical_speed"),
    (beams, "sweep", ROLLING, "--speeds", "10, 11 rad/s", "--window", "0:0.1 s", "--modes", "2"),
    (beams, "tradeoff", TYRE, "--budget", "0.1 s", "--modes", "1"),
]
_CONTROL = re.compile(r"\x1b\[[?0-9;]*[A-Za-z]")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True

    @property
    def text(self) -> str:
        return _CONTROL.sub("", self.getvalue())


@pytest.fixture
def on_terminal(monkeypatch):
    """Makes standard error a terminal, on which a little silence is long."""
    monkeypatch.setenv("TERM", "xterm")

    def on_terminal(silence=0.001):
        monkeypatch.setattr(console, "SILENCE", silence)
        screen = Terminal()
        monkeypatch.setattr(sys, "stderr", screen)
        return screen

    return on_terminal


def wait_for(said, stream):
    """Until it stands on the screen, at most some seconds on a busy machine."""
    end = time.monotonic() + 20
    while said not in stream.text and time.monotonic() < end:
        time.sleep(0.01)
    assert said in stream.text


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command[1])
def test_every_command_says_that_it_is_at_work(on_terminal, monkeypatch, finished, command):
    terminal = on_terminal()
    program, name, *options = command
    hide = console._ProgressLine.hide

    def hide_when_shown(line):  # a quick command would end before a busy machine shows it
        wait_for(name, terminal)
        hide(line)

    monkeypatch.setattr(console._ProgressLine, "hide", hide_when_shown)
    assert finished(program.main([name.split()[1], *options]), DONE).out and name in terminal.text


@pytest.mark.parametrize("command", COUNTED, ids=lambda command: command[1])
def test_what_has_steps_counts_them(on_terminal, monkeypatch, command):
    on_terminal()
    counts = []
    count = console._ProgressLine.count
    monkeypatch.setattr(
        console._ProgressLine, "count", lambda line, *steps: (counts.append(steps), count(line, *steps))
    )
    program, *arguments = command
    assert program.main(arguments) == DONE
    assert len({total for _, total in counts}) == 1 and counts[-1][0] > 0
    assert [done for done, _ in counts] == sorted(done for done, _ in counts)


def test_nothing_is_said_where_standard_error_is_no_terminal(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(console, "SILENCE", 0.001)
    monkeypatch.setenv("FORCE_COLOR", "1")  # by which rich takes anything for a terminal
    assert beams.main(["modes", without_camber(TYRE, tmp_path)]) == DONE
    with at_work("designs") as count:
        count(1, 2)
        time.sleep(0.05)
    assert capsys.readouterr().err == ""


def test_nothing_is_said_of_what_is_done_within_a_second(on_terminal):
    terminal = on_terminal(silence=1.0)
    with at_work("designs") as count:
        count(1, 2)
    assert terminal.getvalue() == ""


def test_the_line_has_time_and_count_and_is_taken_away(on_terminal):
    terminal = on_terminal()
    with at_work("designs") as count:
        wait_for("0:00:00", terminal)
        count(3, 7)
        wait_for("3/7", terminal)
        wait_for(" left", terminal)
    assert terminal.getvalue().endswith("\x1b[2K")  # the line is erased


def test_what_is_printed_takes_the_place_of_the_line(on_terminal):
    terminal = on_terminal()
    with at_work("designs"):
        wait_for("designs", terminal)
        with quiet():
            assert terminal.getvalue().endswith("\x1b[2K")
            before = terminal.getvalue()
            time.sleep(0.05)
            assert terminal.getvalue() == before
        terminal.truncate(0)
        wait_for("designs", terminal)


def test_a_line_within_another_takes_its_place(on_terminal):
    terminal = on_terminal()
    with at_work("whole"):
        wait_for("whole", terminal)
        with at_work("part"):
            wait_for("part", terminal)
            terminal.truncate(0)
            time.sleep(0.3)
            assert "whole" not in terminal.text
        terminal.truncate(0)
        wait_for("whole", terminal)


@pytest.mark.parametrize(
    ("counts", "left"),
    [
        ([(0.0, 0), (10.0, 10), (10.1, 20)], 40.4),  # two workers end at about the same time
        ([(0.0, 0), (0.1, 50), (60.1, 60)], 240.0),  # half is in the store; a step takes longer than 30 s
        ([(0.0, 0), (8.0, 10), (12.0, 20), (14.0, 30), (15.0, 40), (16.0, 50)], 10.0),  # the longest first
    ],
)
def test_the_time_left_is_that_of_the_last_half_of_the_time(counts, left):
    pace = console.Pace()
    for at, done in counts:
        pace.note(at, done)
    now = counts[-1][0]
    assert pace.left(now, 100) == pytest.approx(left, rel=1e-12)
    assert pace.left(now + 1.0, 100) == pytest.approx(left - 1.0, rel=1e-12)


def test_no_time_is_left_to_say_before_a_step_has_ended():
    pace = console.Pace()
    assert pace.left(0.0, 100) is None
    pace.note(0.0, 0)
    assert pace.left(1.0, 100) is None


def test_the_time_left_stands_on_the_line(on_terminal, monkeypatch):
    monkeypatch.setattr(console.Pace, "left", lambda pace, now, total: 3725.4)
    terminal = on_terminal()
    with at_work("designs") as count:
        count(1, 2)
        wait_for("1:02:05 left", terminal)
