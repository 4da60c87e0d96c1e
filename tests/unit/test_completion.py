"""The scripts by which shells complete commands, options and choices."""

from __future__ import annotations

import shutil
import subprocess

import pytest

from beamdyn import cli as beams
from beamdyn.common.edge.exit_codes import BAD_INPUT, DONE
from brakes import cli as brakes

PROGRAMS = {"beamdyn": beams, "brakes": brakes}
TYPED = [
    ("beamdyn", ["sens"], "sensitivities"),
    ("beamdyn", ["campbell", "--top"], "--top-speed"),
    ("beamdyn", ["modes", "--discretization", "f"], "fem"),
    ("brakes", ["fork"], "forklift"),
    ("brakes", ["drum", "--vary", "x", "--tog"], "--together"),
]


@pytest.fixture
def script(finished):
    def script(program, shell):
        return finished(PROGRAMS[program].main(["completion", shell]), DONE).out

    return script


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
@pytest.mark.parametrize(("program", "words", "completed"), TYPED, ids=lambda each: "".join(each))
def test_bash_completes(script, tmp_path, program, words, completed):
    path = tmp_path / program
    path.write_text(script(program, "bash"))
    line = " ".join(f"'{word}'" for word in [program, *words])
    ask = f'. "{path}"; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _{program}; echo "${{COMPREPLY[@]}}"'
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, timeout=60, check=True)
    assert (done.stdout.split(), done.stderr) == ([completed], "")


@pytest.mark.slow
@pytest.mark.parametrize("shell", ["zsh", "fish"])
@pytest.mark.parametrize("program", PROGRAMS)
def test_other_shells_have_all_commands(script, program, shell):
    made = script(program, shell)
    names = [name for name in PROGRAMS[program].app.resolved_commands() if not name.startswith("-")]
    assert all(name in made for name in names)


def test_another_shell_is_refused(finished):
    assert "bash" in finished(beams.main(["completion", "tcsh"]), BAD_INPUT).err
