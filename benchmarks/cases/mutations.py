"""Mutations of the text of a TOML file: each takes a text and a random generator and returns another text."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

Mutation = Callable[[str, Random], str]

_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_UNIT = re.compile(r'(?<=\d )[A-Za-z][\w/^]*(?=")')
_VALUE = re.compile(r"(?m)(?<== )[^\s#][^#\n]*?(?=\s*(?:#.*)?$)")
_KEY = re.compile(r"(?m)\b[a-z][a-z_]*(?= = )")
_NAME = re.compile(r'(?<=")[^"\n]*(?=")')
_ASSIGNMENT = re.compile(r"(?m)^[\w.]+ = .*\n?")
_HEADING = re.compile(r"(?m)^\[.*\]$")

UNITS = (
    "mm",
    "m",
    "km",
    "deg",
    "rad",
    "rpm",
    "rad/s",
    "Hz",
    "kg",
    "N",
    "N m2",
    "GPa",
    "s",
    "h",
    "%",
    "K",
    "dB",
    "",
)
VALUES = (
    *(
        "nan",
        "-inf",
        "inf",
        "0",
        "-0.0",
        "1",
        "-1",
        "true",
        "false",
        '""',
        '" "',
        "[]",
        "{}",
        "[[]]",
        "{ a = 1 }",
    ),
    *(
        '"nan m"',
        '"inf rad/s"',
        '"0 m"',
        '"-1 mm"',
        '"1e400 m"',
        '"1e-320 kg"',
        '"1,5 mm"',
        '"1 mm 2"',
        '"m"',
        '"inf"',
        '"0 N m/rad"',
        '"30 deg"',
    ),
    *(
        '"Größe"',
        '"１ mm"',
        '"−1 deg"',
        '"\\u0000"',
        '"\\t"',
        '"🙂"',
        "2024-01-01",
        "12:00:00",
        "0x10",
        "1_000",
    ),
    *(
        '["1 mm", "2 mm"]',
        "[1, 2, 3]",
        '[[["1 mm"]]]',
        "{ polynomial = [1] }",
        "{ stations = [], values = [] }",
        '[["x/L", "twist [deg]"], [0, 10], [1, -5]]',
    ),
    *("9" * 400, f'"{"x" * 5000}"', "[" * 300 + "]" * 300, f"[{'1, ' * 3000}]"),
)
EXTRAS = (
    *(
        "\ufeff",
        "\x00",
        "\r",
        "=",
        "[",
        '"',
        "'''",
        "# \U0001f642",
        "[beam]",
        "[[pin]]",
        "[a.b.c]",
        "x = 1",
        "[run]",
    ),
    *(
        "[motion]",
        "[physics]\nplanes = 2",
        "[mount]\nradius = 1",
        "[stop]",
        "caliper = 'eebrake'",
        "beam.length = '1 m'",
        "a = {b = {c = 1}}",
    ),
)


def _at_one(pattern: re.Pattern[str], change: Callable[[str, Random], str]) -> Mutation:
    """Make a mutation that replaces one of the matches of a pattern."""

    def mutate(text: str, random: Random) -> str:
        places = [match.span() for match in pattern.finditer(text)]
        if not places:
            return text
        start, end = random.choice(places)
        return text[:start] + change(text[start:end], random) + text[end:]

    return mutate


def _scaled(number: str, random: Random) -> str:
    exponent = random.choice((-300, -30, -9, -3, -1, 1, 3, 9, 30, 300))
    return f"{number.lower().partition('e')[0]}e{exponent:+d}"


def _other_letter(word: str, random: Random) -> str:
    place = random.randrange(len(word))
    return word[:place] + random.choice("aeiou_") + word[place + 1 :]


def _nested(value: str, random: Random) -> str:
    return random.choice(("[{}]", "{{ value = {} }}", "[[{}]]", "{{ a = {{ b = {} }} }}")).format(value)


def _one_of(choices: Sequence[str]) -> Callable[[str, Random], str]:
    return lambda _, random: random.choice(choices)


def other_name(text: str, random: Random) -> str:
    """Replace a quoted text of the file by another one, such as the name of a body or a kind."""
    names = _NAME.findall(text) or [""]
    return _at_one(_NAME, lambda _, random: random.choice(names))(text, random)


def insert(text: str, random: Random) -> str:
    """Insert a stray character or line at the start of a line."""
    lines = text.splitlines(keepends=True)
    lines.insert(random.randint(0, len(lines)), random.choice(EXTRAS) + random.choice(("", "\n")))
    return "".join(lines)


def cut(text: str, random: Random) -> str:
    """Cut off the file at a random position."""
    return text[: random.randrange(len(text) + 1)]


def shuffle(text: str, random: Random) -> str:
    """Shuffle the lines of the file."""
    lines = text.splitlines(keepends=True)
    random.shuffle(lines)
    return "".join(lines)


MUTATIONS: dict[str, Mutation] = {
    "key deleted": _at_one(_ASSIGNMENT, lambda *_: ""),
    "key doubled": _at_one(_ASSIGNMENT, lambda line, _: line + line),
    "key misspelt": _at_one(_KEY, _other_letter),
    "table deleted": _at_one(_HEADING, lambda *_: ""),
    "table doubled": _at_one(_HEADING, lambda line, _: f"{line}\n{line}"),
    "magnitude": _at_one(_NUMBER, _scaled),
    "sign": _at_one(_NUMBER, lambda number, _: number[1:] if number[0] == "-" else f"-{number.lstrip('+')}"),
    "zero": _at_one(_NUMBER, lambda *_: "0"),
    "no number": _at_one(_NUMBER, _one_of(("nan", "inf", "", "x", "1e", "--1", "1.2.3"))),
    "other digits": _at_one(
        _NUMBER, lambda _, random: f"{random.uniform(-1, 1) * 10 ** random.randint(-6, 6):.6g}"
    ),
    "unit": _at_one(_UNIT, _one_of(UNITS)),
    "value": _at_one(_VALUE, _one_of(VALUES)),
    "nested": _at_one(_VALUE, _nested),
    "other name": other_name,
    "inserted": insert,
    "cut": cut,
    "shuffled": shuffle,
}
# Mutations after which a file is usually still valid.
_OFTEN = ("magnitude", "sign", "other digits", "other name")
_RARE = ("cut", "shuffled", "inserted")  # mutations after which a file is rarely valid TOML


def mutate(text: str, random: Random) -> tuple[str, str]:
    """Mutate a text one to three times; return it with the names of the mutations."""
    weights = [4.0 if name in _OFTEN else 0.2 if name in _RARE else 1.0 for name in MUTATIONS]
    names = random.choices([*MUTATIONS], weights, k=random.choice((1, 1, 1, 2, 3)))
    for name in names:
        text = MUTATIONS[name](text, random)
    return text, ", ".join(names)
