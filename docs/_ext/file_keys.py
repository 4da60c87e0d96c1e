"""Tables of the keys in place of ``<!-- keys of MODULE:SECTION -->``, from their description.

``<!-- keys of MODULE:SECTION [table] -->`` gives one table; in place of a section a type of brake may stand.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from importlib import import_module
from itertools import takewhile
from pathlib import Path
from typing import Any, get_args, get_origin

from beamdyn.common.edge.inputs import Input, Section, describe
from brakes.answers import STANDARD
from brakes.answers.machine import MachineType

MARK = re.compile(r"^<!-- keys of (\S+):(\w+)(?: \[(\w+)\])? -->$", re.MULTILINE)
_BEAMS = {"RectangularInput": "rectangular", "StiffnessInput": "any section", "MatricesInput": "matrices"}
_HEAD = "| key | what | default | only with |\n|---|---|---|---|"


def tables_of(section: Any, only: str | None = None) -> str:
    """All tables of a file, or one of them, in Markdown."""
    groups: dict[str, list[Input]] = {}
    for entry in describe(getattr(section, "model", section)):
        groups.setdefault(entry.path.rpartition(".")[0], []).append(entry)
    repeated = set(_repeated(section))
    return "\n\n".join(
        "\n".join(_table(f"[[{path}]]" if path in repeated else f"[{path}]", entries))
        for path, entries in groups.items()
        if only in (None, path)
    )


def _repeated(annotation: Any, path: str = "") -> Iterator[str]:
    """Paths of the tables that may be there as often as needed."""
    if _is_section(annotation):
        for name, field in annotation.model_fields.items():
            yield from _repeated(field.annotation, f"{path}.{name}".lstrip("."))
        return
    within = get_args(annotation)
    if get_origin(annotation) is list and within and _is_section(within[0]):
        yield path
    for part in within:
        yield from _repeated(part, path)


def _is_section(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, Section)


def _table(heading: str, entries: Sequence[Input]) -> Iterator[str]:
    yield f"### {'At the top' if heading == '[]' else f'`{heading}`'}\n\n{_HEAD}"
    all_kinds = dict.fromkeys(_kind(entry) for entry in entries)
    for name in dict.fromkeys(entry.name for entry in entries):
        own = [entry for entry in entries if entry.name == name]
        kinds = dict.fromkeys(_kind(entry) for entry in own)
        only = ", ".join(kinds) if len(kinds) < len(all_kinds) and name != "kind" else ""
        yield f"| `{name}` | {_what(own, name)} | {_default(own[0], name)} | {only} |"


def _kind(entry: Input) -> str:
    """What tells the table that has the key from its alternatives."""
    field = entry.section.model_fields.get("kind")
    if field is not None and field.default:
        return f"`{field.default}`"
    return _BEAMS.get(entry.section.__name__, entry.section.__name__)


def _what(entries: Sequence[Input], name: str) -> str:
    choices = dict.fromkeys(str(choice) for entry in entries for choice in entry.choices)
    said = "; or ".join(dict.fromkeys(entry.help for entry in entries))
    text = f"{said}: {', '.join(choices)}" if choices else said
    return text.replace("|", "\\|")


def _default(entry: Input, name: str) -> str:
    if name == "kind":
        return str(entry.choices[0])
    if entry.required:
        return "**required**"
    if entry.default in (None, [], ()):
        return ""
    return str(entry.default).lower() if isinstance(entry.default, bool) else str(entry.default)


def rows_of_brakes() -> str:
    """Rows of the page of commands: a brake that has no options of its own, what its command answers."""
    rows = (
        f"| `brakes {name}` | {shown} | [examples](examples.md) |" for name, (shown, _) in STANDARD.items()
    )
    return "\n".join(rows)


def keys_of_machines() -> str:
    """Tables of the brakes pressed by one force: the one that they share, and that of each."""
    brakes = [brake for brake in (load() for _, load in STANDARD.values()) if isinstance(brake, MachineType)]
    shared = tables_of(brakes[0], "brake")
    return "\n\n".join([shared, *(tables_of(brake, brake.name) for brake in brakes)])


def list_of_examples() -> str:
    """Each example with the first sentence of its comment."""
    folder = Path(__file__).parents[2] / "examples"
    files = (*sorted(folder.glob("*.toml")), *sorted(folder.glob("*/*.toml")))
    each = ((file.relative_to(folder), first_sentence(file.read_text(encoding="utf-8"))) for file in files)
    return "\n".join(f"- [{name}](../examples/{name}): {said}" for name, said in each)


def first_sentence(text: str) -> str:
    """The first sentence of the comment that a file begins with, without the command that may follow it."""
    comment = takewhile(lambda line: line.startswith("#"), text.splitlines())
    whole = " ".join(line[1:].strip() for line in comment)
    return re.split(r"\.(?=\s+[A-Z`]|$)|: beamdyn ", whole)[0]


def write_tables(app, docname: str, source: list[str]) -> None:
    source[0] = source[0].replace("<!-- standard brakes -->", rows_of_brakes())
    source[0] = source[0].replace("<!-- list of examples -->", list_of_examples())
    if not MARK.search(source[0]):
        return
    source[0] = with_tables(source[0])


def with_tables(text: str) -> str:
    """A page with the tables in place of its marks."""
    text = text.replace("<!-- keys of brakes pressed by one force -->", keys_of_machines())
    return MARK.sub(lambda mark: tables_of(getattr(import_module(mark[1]), mark[2]), mark[3]), text)


def note_sources(app, docname: str, source: list[str]) -> None:
    """The page is written anew when what describes its keys has changed."""
    marks = [*MARK.finditer(source[0])]
    for mark in marks:
        import_module(mark[1])
    for file in _described_in() if marks else ():
        app.env.note_dependency(file)


def _described_in() -> Iterator[str]:
    """Modules of the packages: keys are described where the objects are that they make."""
    for name, module in [*sys.modules.items()]:
        if name.startswith(("beamdyn.", "brakes.")) and (file := getattr(module, "__file__", None)):
            yield file


def setup(app) -> dict[str, bool]:
    app.connect("source-read", note_sources)  # before the marks are replaced
    app.connect("source-read", write_tables)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    print(with_tables((Path(__file__).parents[1] / "input_files.md").read_text(encoding="utf-8")))
