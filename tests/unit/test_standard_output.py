"""What commands print: in any encoding, to a reader that has left, on a full disk; without a traceback."""

import io
import json
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest

from beamdyn import cli as beams
from beamdyn.common.edge.console import Terminal, spell, spell_output, table
from brakes import cli as brakes
from tests.unit.toml_scenes import without_camber

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
SCENE, ROLLING = str(EXAMPLES / "tyre_harvester.toml"), str(EXAMPLES / "rolling_harvester.toml")
COMMANDS = {
    "modes": (beams, "modes", SCENE),
    "locus": (beams, "locus", SCENE, "--speeds", "0:200:5 rad/s"),
    "critical": (beams, "critical", SCENE),
    "limits": (beams, "limits", SCENE, "--top-speed", "400 rad/s"),
    "terms": (beams, "terms", ROLLING),
    "resonances": (beams, "resonances", ROLLING, "--top-speed", "100 rad/s"),
    "steady": (beams, "steady", ROLLING, "--speeds", "20, 30 rad/s"),
    "simulate": (beams, "simulate", ROLLING, "--t-end", "0.2 s", "--modes", "2"),
    "loads": (beams, "loads", SCENE, "--speed", "20 rad/s"),
    "sweep": (beams, "sweep", ROLLING, "--speeds", "10 rad/s", "--window", "0:0.1 s", "--modes", "2"),
    "tradeoff": (beams, "tradeoff", SCENE, "--budget", "0.1 s", "--modes", "1"),
    "drum": (brakes, "drum", str(EXAMPLES / "drum.toml")),
    "forklift": (brakes, "forklift", str(EXAMPLES / "forklift.toml")),
    "caliper": (brakes, "caliper", "dual-pivot"),
    "caliper --list": (brakes, "caliper", "--list"),
    **{f"{name} --help": (beams, name, "--help") for name in ("modes", "sweep", "reproduce", "app")},
    **{f"{name} --help": (brakes, name, "--help") for name in ("drum", "caliper")},
    "beamdyn --help": (beams, "--help"),
    "brakes --version": (brakes, "--version"),
}


@pytest.fixture
def run_into(monkeypatch):
    def run(stream, program, *arguments):
        errors = io.StringIO()
        monkeypatch.setattr(sys, "stdout", stream)
        monkeypatch.setattr(sys, "stderr", errors)
        return program.main(list(arguments)), errors.getvalue()

    return run


QUICK = ("modes", "terms", "drum", "caliper", "modes --help")


def in_every_encoding():
    """Each command in ASCII, which has least; in the others those that are quick, and all as slow tests."""
    for command in COMMANDS:
        for encoding in ("ascii", "cp1252", "latin-1"):
            slow = encoding != "ascii" and command not in QUICK
            yield pytest.param(command, encoding, marks=[pytest.mark.slow] if slow else [])


@pytest.mark.parametrize(("command", "encoding"), [*in_every_encoding()])
def test_every_command_prints_in_any_encoding(run_into, command, encoding):
    printed = io.BytesIO()
    code, err = run_into(io.TextIOWrapper(printed, encoding), *COMMANDS[command])
    assert code == beams.DONE, err
    assert printed.getvalue() and b"?" not in printed.getvalue()


def test_symbols_that_a_console_lacks_are_spelled_and_columns_stay_aligned(run_into):
    printed = io.BytesIO()
    run_into(io.TextIOWrapper(printed, "ascii"), *COMMANDS["terms"])
    lines = printed.getvalue().decode().splitlines()
    assert any("omega^2 KGB q2" in line for line in lines)
    rows = lines[1 : next(k for k, line in enumerate(lines) if line.startswith("Lines:"))]
    assert len({len(line) for line in rows if line}) == 1


def test_rules_and_titles_are_spelled_too():
    printed = io.BytesIO()
    stream = io.TextIOWrapper(printed, "ascii")
    spell_output(stream)
    screen = Terminal(file=stream, width=8)
    screen.rule()
    screen.print(table("Δω in °", ("a",), [("b",)]))
    assert printed.getvalue().startswith(b"--------\n?omega")


def test_spelling():
    assert spell("ω² 0 ± 4e-08, 5° é 漢", "ascii") == "omega^2 0 +- 4e-08, 5 deg e ?"
    assert spell("ω² 0 ± 4e-08", "cp1252") == "omega² 0 ± 4e-08"
    assert spell("ω² 漢", "utf-8") == "ω² 漢"


@pytest.mark.parametrize("command", ["terms", "caliper", "modes --help", "brakes --version"])
def test_a_closed_standard_output_is_said_before_any_work(run_into, command):
    code, err = run_into(None, *COMMANDS[command])
    assert code == beams.BAD_INPUT
    assert "standard output is closed" in err and err.count("\n") == 1


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
@pytest.mark.parametrize("command", ["terms", "caliper", "modes --help", "brakes --version"])
def test_a_full_disk_under_the_standard_output_is_said(run_into, command):
    with suppress(OSError), open("/dev/full", "w") as full:  # closing it fails, too
        code, err = run_into(full, *COMMANDS[command])
    assert code == beams.BAD_INPUT
    assert "standard output cannot be written (No space left on device)" in err and err.count("\n") == 1


def test_the_files_are_written_though_the_reader_has_left(run_into, tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    with open(writer, "w") as stream:
        command = beams, "modes", without_camber(SCENE, tmp_path)
        code, err = run_into(stream, *command, "--json", str(tmp_path / "modes.json"))
    assert (code, err) == (beams.DONE, "")
    assert len(json.loads((tmp_path / "modes.json").read_text())["frequency"]) == 3


WRITING = {
    **{name: (*COMMANDS[name], "--json") for name in ("modes", "critical", "limits", "terms", "drum")},
    "animation": (*COMMANDS["simulate"], "--animation"),
    "sweep of a brake": (*COMMANDS["drum"], "--vary", "brake.friction=0.2:0.4:3", "--csv"),
    "free bodies": (*COMMANDS["caliper"], "--free-bodies"),
}
SUFFIXES = {"animation": ".gif", "free bodies": ".png"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
@pytest.mark.parametrize("command", WRITING)
def test_the_files_are_written_though_the_tables_cannot_be_printed(run_into, tmp_path, command, monkeypatch):
    monkeypatch.setattr("beamdyn.analyses.about_motion._FRAMES", 7)
    path = tmp_path / f"result{SUFFIXES.get(command, '.txt')}"
    with suppress(OSError), open("/dev/full", "w") as full:
        code, err = run_into(full, *WRITING[command], str(path))
    assert code == beams.BAD_INPUT and "standard output cannot be written" in err
    assert path.stat().st_size > 0


def test_without_standard_error_nothing_is_mixed_into_the_output(monkeypatch, finished):
    monkeypatch.setattr(sys, "stderr", None)
    assert finished(beams.main(["modes", "nowhere.toml"]), beams.BAD_INPUT).out == ""


def test_head_takes_a_line_and_no_traceback_is_seen():
    script = f"{sys.executable} -m beamdyn terms {SCENE} | head -1; exit $?"
    done = subprocess.run(
        ["sh", "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.stdout, done.stderr) == ("Terms of the equations of motion\n", "")


# What is read ---------------------------------------------------------------------------------------


def test_a_byte_order_mark_is_no_mistake(tmp_path, finished):
    (tmp_path / "scene.toml").write_bytes(b"\xef\xbb\xbf" + Path(SCENE).read_bytes())
    marked = finished(beams.main(["modes", str(tmp_path / "scene.toml")]), beams.DONE).out
    assert marked == finished(beams.main(["modes", SCENE]), beams.DONE).out


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-32"])
def test_another_encoding_is_a_sentence(tmp_path, finished, encoding):
    (tmp_path / "scene.toml").write_text(Path(SCENE).read_text(), encoding=encoding)
    err = finished(beams.main(["modes", str(tmp_path / "scene.toml")]), beams.BAD_INPUT).err
    assert "scene.toml" in err and ("UTF-8" in err or "not valid TOML" in err) and err.count("\n") == 1
