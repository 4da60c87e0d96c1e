"""Text files of numbers that other programs write: their lines, and numbers as FORTRAN reads them.

Messages name the file, the line and what was expected there.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.units import show
from beamdyn.common.inputs.checks import MOST
from beamdyn.common.results.files import as_path

# FORTRAN reads 1.0D+03 and 1.0+03 as 1.0e+03.
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:(?:[eEdDqQ]|(?=[+-]))([+-]?\d+))?", re.ASCII)
_WORD = re.compile(r"'[^']*'|\"[^\"]*\"|[^\s,]+")
_MOST_BYTES = 20_000_000  # largest number of bytes of a file; an input deck has some ten thousand
# Encodings by the byte order mark at the start of a file.
_ENCODINGS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}


@dataclass(frozen=True)
class DataText:
    """A text file, line by line.

    Parameters
    ----------
    path : Path
        The file.
    lines : tuple of str
        Its lines; the first is line 1.
    """

    path: Path
    lines: tuple[str, ...]

    def refusal(self, line: int, sentence: str) -> ConfigError:
        """Return the error with a sentence about a line."""
        return ConfigError(str(self.path), [f"line {line}: {sentence}"])

    def lacking(self, sentence: str) -> ConfigError:
        """Return the error with a sentence about something that the file lacks."""
        return self.refusal(len(self.lines), f"the file ends here, {sentence}")

    def is_comment(self, line: int) -> bool:
        """Whether a line is empty, or a comment that begins with # or !."""
        plain = self.lines[line - 1].lstrip()
        return not plain or plain[0] in "#!"

    def words(self, line: int) -> list[str]:
        """Split a line into words as FORTRAN does, at blanks, tabs and commas; quoted text stays together."""
        return _WORD.findall(self.lines[line - 1])


def read_data(path: str | PathLike[str]) -> DataText:
    """Read a text file line by line.

    Its comments may be in any encoding: what is not UTF-8 is read as Latin-1.

    Parameters
    ----------
    path : str or path-like
        The file.

    Raises
    ------
    InvalidValue
        If `path` is neither text nor a path.
    ConfigError
        If the file cannot be read, is no text or is empty.
    """
    file = as_path("path", path, "a file")
    try:
        with file.open("rb") as opened:
            content = opened.read(_MOST_BYTES + 1)
    except FileNotFoundError:
        raise ConfigError(str(file), ["there is no such file; check the name and the folder"]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConfigError(str(file), [f"it cannot be read ({reason}); give a text file"]) from None
    if len(content) > _MOST_BYTES:
        raise ConfigError(str(file), ["it is longer than 20 MB; give a deck or a table"])
    try:
        text = content.decode(_ENCODINGS.get(content[:2], "utf-8-sig"))
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    if "\0" in text:
        raise ConfigError(str(file), ["it is no text; give a deck or a table saved as text"])
    if not text.strip():
        raise ConfigError(str(file), ["the file is empty; give a deck or a table"])
    return DataText(file, tuple(text.splitlines()))


def named_file(path: str | PathLike[str], key: str, name: str) -> Path:
    """Return the path of a file that a key of another file names, relative to that file.

    Raises
    ------
    ConfigError
        If the file does not exist; the message names the key, the file and the folder.
    """
    folder = Path(path).parent
    if not (folder / name).exists():
        said = f"{key} = {show(name)}: there is no such file in the folder {folder.resolve()}"
        raise ConfigError(str(path), [f"{said}; check the name, which is relative to this file"], [key])
    return folder / name


# Numbers ------------------------------------------------------------------------------------------


def to_number(word: str) -> float | None:
    """Read a word as FORTRAN reads a number, such as 1.0D+03; None if it is not a number, or too large."""
    match = _NUMBER.fullmatch(word)
    if match is None:
        return None
    number = float(f"{match[1]}e{match[2] or 0}")
    return number if math.isfinite(number) else None


def as_decimal(word: str) -> str:
    """Rewrite a number with e before its exponent, where FORTRAN may write another letter or none."""
    match = _NUMBER.fullmatch(word)
    assert match is not None
    return match[1] + (f"e{match[2]}" if match[2] else "")


def number_at(text: DataText, line: int, word: str, name: str) -> float:
    """Return the number in a word; raise an error that says what was expected."""
    number, advice = to_number(word), ""
    if number is not None and abs(number) <= MOST:
        return number
    if number is not None:
        raise text.refusal(line, f"expected a number up to {MOST:g} for {name}, found {quote(word)}")
    if strange := next((c for c in word if not c.isascii()), ""):
        known = unicodedata.name(strange, "no name").lower()
        advice = f" with the character U+{ord(strange):04X} ({known}); write it in plain characters"
    elif to_number(word.replace(",", ".", 1)) is not None:
        advice = "; write a decimal point"
    elif word.lower().lstrip("+-") in ("nan", "inf", "infinity"):
        advice = "; give a finite one"
    raise text.refusal(line, f"expected a number for {name}, found {quote(word)}{advice}")


def quote(word: str) -> str:
    """Quote a word in a message, shortened if it is long."""
    return f"'{word if len(word) <= 40 else word[:37] + '...'}'"


# Values followed by their names -------------------------------------------------------------------


@dataclass(frozen=True)
class NamedValue:
    """A value with its name and line.

    Parameters
    ----------
    name : str
        Its name, as written.
    word : str
        The value, as written, without quotes.
    line : int
        Its line.
    """

    name: str
    word: str
    line: int


def plain_name(name: str) -> str:
    """Return a name in lower case without brackets, colons, underscores and blanks, which programs vary."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def named_values(text: DataText, names: Collection[str]) -> dict[str, NamedValue]:
    """Read lines such as ``0.48  BldFlDmp(1) - damping`` or ``1.75 hub_rad: hub radius``.

    Parameters
    ----------
    text : DataText
        The file.
    names : collection of str
        The names looked for, as `plain_name` makes them.

    Returns
    -------
    dict
        Values by plain name, for those names that the file has.

    Raises
    ------
    ConfigError
        If a name occurs twice.
    """
    found: dict[str, NamedValue] = {}
    bare: dict[str, NamedValue] = {}
    for line in range(1, len(text.lines) + 1):
        words = [word for word in text.words(line) if word not in (":", "-")][:2]
        keys = [plain_name(word) for word in words]
        if len(keys) == 2 and (key := keys[1]) in names:
            if key in found:
                there = f"{words[1].rstrip(':')} stands in line {found[key].line}, too"
                raise text.refusal(line, f"{there}; expected each name once")
            found[key] = NamedValue(words[1].rstrip(":"), words[0].strip("'\""), line)
        elif keys and keys[0] in names:  # either a line whose value is missing, or a comment
            bare.setdefault(keys[0], NamedValue(words[0].rstrip(":"), "", line))
    return bare | found


def check_all_there(text: DataText, found: Mapping[str, NamedValue], names: Mapping[str, str]) -> None:
    """Refuse a file that lacks some names, or their values.

    Parameters
    ----------
    text : DataText
        The file.
    found : mapping
        Values that it has, by plain name.
    names : mapping
        Names that it must have, as shown in messages, by plain name.

    Raises
    ------
    ConfigError
        If a name or its value is missing.
    """
    for key in names:
        if key in found and not found[key].word:
            raise text.refusal(found[key].line, f"expected a value before {found[key].name}, found none")
    if missing := [shown for key, shown in names.items() if key not in found]:
        some = ", ".join(missing[:4]) + (f" and {len(missing) - 4} more" if len(missing) > 4 else "")
        raise text.lacking(f"without a line for {some}; expected a value and this name behind it")


def named_number(text: DataText, named: NamedValue) -> float:
    """Return the number of a named value."""
    return number_at(text, named.line, named.word, named.name)


def check_named(text: DataText, named: NamedValue, good: bool, wanted: str) -> None:
    """Refuse a named value unless `good` is true; `wanted` says what was expected."""
    if not good:
        raise text.refusal(named.line, f"expected {named.name} {wanted}, found {quote(named.word)}")


def named_count(text: DataText, named: NamedValue, least: int = 2) -> int:
    """Return the whole number of a named value, which must not be less than `least`."""
    number = named_number(text, named)
    if number != int(number) or number < least:
        said = f"expected a whole number of {least} or more for {named.name}, found {quote(named.word)}"
        raise text.refusal(named.line, said)
    return int(number)
