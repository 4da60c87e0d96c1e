"""No verdict, status or kind of warning of the examples changes with the last digits of their numbers."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from beamdyn.cli.commands import main as beamdyn
from brakes.cli.commands import main as brakes

EXAMPLES = Path("examples").resolve()
# Numbers in quotes are quantities; bare ones with a decimal point are ratios; integers are counts.
QUANTITY = re.compile(r'(?<=")[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?=\s*[a-zA-Z%"])')
RATIO = re.compile(r"(?<![\w.\"-])\d+\.\d+(?:e[-+]?\d+)?(?![\w.\"])")
NUMBER = re.compile(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?")

SCENES = [
    "blade.toml",
    "harvester_45deg.toml",
    "harvester_on_road.toml",
    "patched.toml",
    "rolling_harvester.toml",
    "twisted_blade.toml",
    "tyre_harvester.toml",
]
COMMANDS = [
    *((beamdyn, ["modes", name, "--speed", "30 rad/s"]) for name in SCENES),
    *((beamdyn, ["critical", name]) for name in SCENES),
    (beamdyn, ["resonances", "rolling_harvester.toml", "--top-speed", "150 rad/s"]),
    (beamdyn, ["response", "harvester_45deg.toml", "--speed", "20 rad/s"]),
    (brakes, ["drum", "drum.toml"]),
    (brakes, ["forklift", "forklift.toml"]),
    (brakes, ["caliper", "block_brake.toml"]),
    *(
        (brakes, ["caliper", f"calipers/{path.name}"])
        for path in sorted((EXAMPLES / "calipers").glob("*.toml"))
    ),
]


def change(text: str, by: float, rng: np.random.Generator) -> str:
    """Multiply each number of a file by 1 + by or 1 - by; the same number, such as that of a jump, alike."""
    factors: dict[str, float] = {}

    def changed(found: re.Match[str]) -> str:
        factor = factors.setdefault(found[0], 1 + by * float(rng.choice([-1, 1])))
        return repr(float(found[0]) * factor)

    lines = []
    for line in text.splitlines():
        key, equals, value = line.partition("=")
        if equals and not key.lstrip().startswith("#"):
            value = RATIO.sub(changed, value) if '"' not in value else QUANTITY.sub(changed, value)
        lines.append(key + equals + value)
    return "\n".join(lines)


def verdict_of(
    program: Callable[[list[str]], int], arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> tuple[int, list[str]]:
    """Exit code and the words of all that is printed, without numbers and their order, which is by size."""
    code = program(arguments)
    out, err = capsys.readouterr()
    words = NUMBER.sub("#", re.sub("─|below ", "", out + err)).replace(";", ",").split()
    return code, sorted(words)


@pytest.mark.parametrize(
    "program, arguments", COMMANDS, ids=lambda value: " ".join(value[:2]) if isinstance(value, list) else ""
)
def test_last_digits_change_no_verdict(
    program: Callable[[list[str]], int],
    arguments: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    shutil.copytree(EXAMPLES, tmp_path / "examples")
    monkeypatch.chdir(tmp_path / "examples")
    before = verdict_of(program, arguments, capsys)
    file = Path(arguments[1])
    text, rng = file.read_text(encoding="utf-8"), np.random.default_rng(1)
    for by in (1e-12, 1e-12, 1e-9):
        file.write_text(changed := change(text, by, rng), encoding="utf-8")
        assert changed != text
        assert verdict_of(program, arguments, capsys) == before
