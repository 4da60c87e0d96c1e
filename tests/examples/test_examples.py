"""Every example runs, and writes what it says."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

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
