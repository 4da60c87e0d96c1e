"""Numbers put into the text of a scene's file, which keeps its comments and everything else."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping

from beamdyn.common.edge.config import ConfigError
from beamdyn.scene.numbers import unit_of

_DIGITS = 10
_TABLE = re.compile(r"\s*\[([^\[\]]+)\]\s*(#.*)?")


def with_numbers_in_text(text: str, values: Mapping[str, float], head: Iterable[str] = ()) -> str:
    """The text of a scene's file with some of its numbers replaced, or added to their tables.

    Parameters
    ----------
    text : str
        The text.
    values : mapping of str to float
        Numbers [SI] by their names, such as "beam.thickness"; an infinite one is written as "inf".
    head : iterable of str
        Sentences that stand as comments above.

    Raises
    ------
    ConfigError
        If a number has no line of its own that could be replaced: it is one of a list, or a factor.
    """
    lines = text.splitlines()
    for path, value in values.items():
        table, _, key = path.rpartition(".")
        if "[" in path or ".scale." in path:
            said = (
                f"{path}: no line of the file holds this number alone; write it by hand, {value:.{_DIGITS}g}"
            )
            raise ConfigError("scene", [said], [path])
        _put(lines, table, key, f"{key} = {_written(path, value)}")
    comments = [f"# {''.join(c if c.isprintable() else ' ' for c in said)}" for said in head]
    return "\n".join([*comments, *lines]) + "\n"


def _written(path: str, value: float) -> str:
    """A number as the file has it: text with its unit."""
    if math.isinf(value):
        return '"inf"'
    unit = unit_of(path)
    return f'"{value:.{_DIGITS}g} {unit}"' if unit else f"{value:.{_DIGITS}g}"


def _put(lines: list[str], table: str, key: str, line: str) -> None:
    """Replace the line of a key in a table, or add it at the end of the table, or with the table."""
    heads = {match[1].strip(): k for k, each in enumerate(lines) if (match := _TABLE.fullmatch(each))}
    if table not in heads:
        lines += ["", f"[{table}]", line]
        return
    start = heads[table] + 1
    end = min([k for k in heads.values() if k >= start], default=len(lines))
    for k in range(start, end):
        if re.match(rf"\s*{re.escape(key)}\s*=", lines[k]):
            comment = re.search(r"\s+#[^\"']*$", lines[k])
            lines[k] = line + (comment[0] if comment else "")
            return
    while end > start and not lines[end - 1].strip():
        end -= 1
    lines.insert(end, line)
