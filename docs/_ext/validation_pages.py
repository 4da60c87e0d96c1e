"""The validation manual, written when the site is built and what its numbers follow from has changed.

What it follows from stands beside its pages: the modules that writing it imported, and the published data.
"""

from __future__ import annotations

import json
import re
import sys
import warnings
from collections.abc import Iterable, Mapping
from hashlib import sha256
from pathlib import Path

ROOT = Path(__file__).parents[2]
INDEX = ROOT / "docs" / "validation" / "index.md"
FOLDER = INDEX.parent / "generated"
PACKAGES = ("beamdyn", "brakes", "benchmarks")


def hashes(files: Iterable[str]) -> dict[str, str]:
    """What is in each file of the repository; nothing in one that is not there."""
    paths = {name: ROOT / name for name in files}
    return {name: sha256(p.read_bytes()).hexdigest() if p.exists() else "" for name, p in paths.items()}


def data() -> set[str]:
    """Files of published values and of cases."""
    found = (path for package in PACKAGES for path in (ROOT / package).rglob("*.toml"))
    return {path.relative_to(ROOT).as_posix() for path in found}


def modules() -> set[str]:
    """Files of the repository's modules that have been imported."""
    own = [module for name, module in [*sys.modules.items()] if name.partition(".")[0] in PACKAGES]
    files = (Path(file).resolve() for module in own if (file := getattr(module, "__file__", None)))
    return {file.relative_to(ROOT).as_posix() for file in files if file.is_relative_to(ROOT)}


def is_current(recorded: Mapping[str, str], pages: Iterable[Path]) -> bool:
    """Whether all pages are there, and what they were written from is as it was."""
    code = {name for name in recorded if name.endswith(".py")}
    return bool(recorded) and all(map(Path.exists, pages)) and hashes(code | data()) == recorded


def write(app) -> None:
    wanted = re.findall(r"^generated/(\w+)$", INDEX.read_text(encoding="utf-8"), re.MULTILINE)
    record = FOLDER / "sources.json"
    recorded = json.loads(record.read_text(encoding="utf-8")) if record.exists() else {}
    if is_current(recorded, [FOLDER / f"{name}.md" for name in wanted]):
        return
    record.unlink(missing_ok=True)  # until all is written
    from beamdyn import OutsideLinearTheory
    from benchmarks.validation_manual import write_pages

    with warnings.catch_warnings():  # where the papers leave linear theory, so does this
        warnings.simplefilter("ignore", OutsideLinearTheory)
        write_pages(FOLDER)
    record.write_text(json.dumps(hashes(modules() | data()), indent=1), encoding="utf-8")


def setup(app) -> dict[str, bool]:
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
