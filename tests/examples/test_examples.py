"""Every example runs, and writes what it says."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from beamdyn.cli import main

ROOT = Path(__file__).parents[2]
# Any warning fails, except deprecations in other people's code.
STRICT = ("-W", "error", "-W", "ignore::DeprecationWarning", "-W", "error::DeprecationWarning:__main__")
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_and_writes_what_it_says(path, tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}
    command = [sys.executable, *STRICT, str(path)]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    written = [p.name for p in tmp_path.iterdir()]
    assert written and all(name in path.read_text() for name in written)


def test_table_3_in_a_few_lines():
    peaks = runpy.run_path(str(ROOT / "examples" / "transient.py"))["largest_deflections"]()
    exact = [1.947177e-3, 1.946482e-3, 1.943300e-3, 1.942770e-3, 1.942558e-3, 1.942509e-3]
    assert peaks == pytest.approx(exact, rel=1e-5)


HARVESTER = str(ROOT / "examples" / "harvester_45deg.toml")


def test_linear_frequencies_of_the_bent_harvester_come_with_their_model_error(finished):
    """What large deflection is worth: 60.66 Hz, of the boundary-value solver, for 55.62 Hz; and camber."""
    printed = finished(main(["modes", HARVESTER, "--speed", "100 rad/s"]), 0)
    said = " ".join(printed.out.split())
    assert "55.62" in said
    assert "left out: large deflection +9.1 % (mode 1)" in said
    assert "(mode 1), camber of sections +1.7 %" in said
    assert "the model error, 11 %, exceeds 1 %: large deflection, left out" in " ".join(printed.err.split())


def test_chosen_physics_bends_the_harvester(finished, tmp_path):
    commented = "# physics = "
    text = (ROOT / "examples" / "harvester_45deg.toml").read_text()
    assert commented in text
    changed = tmp_path / "auto.toml"
    changed.write_text(text.replace(commented, "physics = "))
    for arguments in ([HARVESTER, "--physics", "auto"], [str(changed)]):
        said = " ".join(finished(main(["modes", *arguments, "--speed", "100 rad/s"]), 0).out.split())
        assert "60.657" in said
        assert "55.62" not in said
        assert 'physics "auto", tolerance 0.001: large deflection' in said
