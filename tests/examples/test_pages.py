"""The Python and the commands of the site's pages run as they stand, and print what stands below them.

Blocks of a page run one after the other, in a folder that has the examples. Below commands stand lines of
what they print, and a block with a caption is a file of that name. A comment ``<!-- given`` before a block
has what the text around it gives; ``<!-- not run: why -->`` says why one is not run: docs/README.md.
"""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import matplotlib
import pytest

from beamdyn.cli import main as beamdyn
from brakes.cli import main as brakes

ROOT = Path(__file__).parents[2]
PARTS = re.compile(
    r"^<!-- given\n(?P<given>.*?)-->|^<!-- not run: (?P<skip>.+?) -->\n+```.*?^```|"
    r"^```\{code-block\} \w+\n:caption: (?P<file>\S+)\n\n(?P<content>.*?)^```|"
    r"^```python\n(?P<python>.*?)^```(?:\n+```text\n(?P<text>.*?)^```)?|"
    r"^```sh\n(?P<sh>.*?)^```(?:\n+```text\n(?P<lines>.*?)^```)?",
    re.DOTALL | re.MULTILINE,
)
ELSEWHERE = {  # run by tests of their own, shortened or with errors left out
    "docs/results.md",
    "docs/sweeps.md",
    "docs/spread.md",
    "docs/README.md",  # about blocks
}
EXTRAS = {"docs/loads.md": "rainflow"}
COMMANDS = {"beamdyn": beamdyn, "brakes": brakes}
PAGES = [
    name
    for path in sorted((ROOT / "docs").rglob("*.md"))
    if not {"generated", "gallery", "_build"} & {*path.parts}
    if (name := path.relative_to(ROOT).as_posix()) not in ELSEWHERE
    if re.search(r"^```(python|sh)$", path.read_text(encoding="utf-8"), re.MULTILINE)
]


def run_commands(block: str) -> None:
    for line in block.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words and words[0] in COMMANDS:
            assert COMMANDS[words[0]](words[1:]) == 0, line


@pytest.mark.parametrize("page", PAGES)
def test_blocks_of_a_page(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if page in EXTRAS:
        pytest.importorskip(EXTRAS[page])
    matplotlib.use("Agg")
    (tmp_path / "examples").symlink_to(ROOT / "examples", target_is_directory=True)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for part in PARTS.finditer((ROOT / page).read_text(encoding="utf-8")):
        capsys.readouterr()
        exec(part["given"] or part["python"] or "", names)
        if part["text"]:
            assert capsys.readouterr().out.split() == part["text"].split()
        if part["file"]:
            Path(part["file"]).write_text(part["content"], encoding="utf-8")
        run_commands(part["sh"] or "")
        if part["lines"]:
            shown = " ".join("".join(capsys.readouterr()).split())
            assert [line for line in part["lines"].splitlines() if " ".join(line.split()) not in shown] == []


def test_blocks_that_are_not_run_say_why() -> None:
    reasons = [
        part["skip"]
        for path in sorted((ROOT / "docs").rglob("*.md"))
        for part in PARTS.finditer(path.read_text(encoding="utf-8"))
        if part["skip"]
    ]
    assert all(len(reason) > 5 for reason in reasons)
