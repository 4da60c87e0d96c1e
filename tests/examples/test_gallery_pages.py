"""The build of the site runs the gallery's examples again if the code that they ran has changed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("sphinx_gallery", reason="the site is the extra docs")

EXTENSIONS = Path(__file__).parents[2] / "docs" / "_ext"
CONF = """
import sys
from pathlib import Path
sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parent / "_ext")]
extensions = ["sphinx_gallery.gen_gallery", "gallery_pages"]
sphinx_gallery_conf = {"examples_dirs": "../examples/gallery", "gallery_dirs": "gallery",
    "filename_pattern": r"\\.py$", "abort_on_example_error": True, "write_computation_times": False}
"""
EXAMPLE = '''"""
Title
=====

Words.
"""
from pathlib import Path

from beamdyn import part

with Path(r"{root}/ran").open("a") as file:
    file.write(part.WORD + (Path(r"{root}") / "examples" / "scene.toml").read_text())
'''


@pytest.fixture
def build(tmp_path):
    """Builds a site with one example; what the example has written by then."""
    files = {
        "beamdyn/__init__.py": "",
        "beamdyn/part.py": 'WORD = "a"',
        "beamdyn/other.py": "",
        "examples/scene.toml": "1",
        "examples/gallery/GALLERY_HEADER.rst": "Gallery\n=======\n",
        "examples/gallery/one.py": EXAMPLE.format(root=tmp_path),
        "docs/conf.py": CONF,
        "docs/index.rst": "Site\n====\n\n.. toctree::\n\n   gallery/index\n",
    }
    files |= {f"docs/_ext/{path.name}": path.read_text("utf-8") for path in EXTENSIONS.glob("*_pages.py")}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")

    def build() -> str:
        command = [sys.executable, "-m", "sphinx", "-q", "docs", "site"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return (tmp_path / "ran").read_text()

    return build, tmp_path


@pytest.mark.slow
def test_examples_run_again_when_what_they_ran_or_read_has_changed(build):
    run, root = build
    assert run() == "a1"
    (root / "beamdyn" / "other.py").write_text("x = 1")  # which it does not import
    assert run() == "a1"
    (root / "beamdyn" / "part.py").write_text('WORD = "b"')
    assert run() == "a1b1"
    assert run() == "a1b1"
    (root / "examples" / "scene.toml").write_text("2")
    assert run() == "a1b1b2"


@pytest.mark.slow
def test_examples_that_failed_after_a_change_are_run_again(build):
    run, root = build
    run()
    (root / "beamdyn" / "part.py").write_text("")
    with pytest.raises(AssertionError):
        run()
    (root / "beamdyn" / "part.py").write_text('WORD = "a"')
    assert run() == "a1a1"
