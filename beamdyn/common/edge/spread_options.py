"""Options of commands for ranges over tolerances of inputs: the tolerances, the number of random designs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter, Token

from beamdyn.common.edge.varying import OPTION as VARY
from beamdyn.common.edge.varying import VaryOptions
from beamdyn.common.spreading import DEFAULT_SAMPLES

if TYPE_CHECKING:
    from beamdyn.common.edge.inputs import Input
    from beamdyn.common.spreading.tolerances import Convert, SpreadInput

OPTION = "--spread"


def _whole(_: object, tokens: Sequence[Token]) -> int:
    """A whole number; cyclopts alone would cut 2.5 down to 2."""
    text = tokens[0].value.strip()
    if not (text.isascii() and text.isdecimal()):
        raise ValueError(f'"{text}" is not a whole number of 0 or more.')
    return int(text)


@Parameter(name="*")
@dataclass(frozen=True)
class SpreadOptions:
    """Inputs that have a tolerance, and how many random designs are drawn.

    Parameters
    ----------
    spread : tuple of str
        An input and its tolerance, NAME=tolerance, such as "NAME=+-2%", "NAME=+1% -2%", "NAME=+-0.01 mm",
        "NAME=0.19 mm to 0.21 mm" (all values as likely), or "NAME=sd 1%" (normal). Give the option once for
        each input. Names are those of the file.
    samples : int
        Number n of designs in each of 2 + d random samples of d inputs: a power of two, from 128.
    seed : int
        Whole number from which the random designs follow.
    """

    spread: Annotated[
        tuple[str, ...], Parameter(negative="", consume_multiple=False, show_default=False)
    ] = ()
    samples: Annotated[int, Parameter(converter=_whole)] = DEFAULT_SAMPLES
    seed: Annotated[int, Parameter(converter=_whole)] = 0

    @property
    def options(self) -> dict[str, object]:
        """The options that are not at their defaults, for the head of a report."""
        given: dict[str, object] = {"spread": self.spread or None}
        given["samples"] = self.samples if self.samples != DEFAULT_SAMPLES else None
        return given | {"seed": self.seed or None}

    def check(self, varying: VaryOptions) -> None:
        """Refuse what does not go together with the inputs that are varied."""
        for name in ("samples", "seed"):
            if not self.spread and getattr(self, name) != getattr(NO_SPREAD, name):
                raise ValueError(f"--{name} goes with {OPTION}: no random designs are drawn without it")
        if not self.spread:
            return
        both = {_key(text) for text in self.spread} & {_key(text) for text in varying.vary}
        if both:
            name = min(both)
            raise ValueError(
                f"{name} is given to {VARY} and to {OPTION}: an input is varied, or has a spread"
            )
        if varying.vary or varying.together:
            given = VARY if varying.vary else "--together"
            raise ValueError(f"{given} does not go with {OPTION}: give one of them")


NO_SPREAD = SpreadOptions()


def _key(text: str) -> str:
    return text.partition("=")[0].strip()


def parse_spreads(
    inputs: Sequence[Input], texts: Sequence[str], nominal: Callable[[Input], tuple[float, str]]
) -> tuple[SpreadInput, ...]:
    """Read inputs with their tolerances.

    Parameters
    ----------
    inputs : sequence of Input
        Those that may have a tolerance.
    texts : sequence of str
        KEY=TOLERANCE of each; the key as for `parse_axis`.
    nominal : callable
        ``nominal(input)``: value of an input in SI, and its SI unit.

    Returns
    -------
    tuple of SpreadInput

    Raises
    ------
    ValueError
        If there is no such input, it is given twice, or its tolerance cannot be read.
    """
    from beamdyn.common.edge.varied_inputs import find_input

    made: dict[str, SpreadInput] = {}
    for text in texts:
        words = f'{OPTION} = "{text}"'
        if not text.partition("=")[2].strip():
            raise ValueError(f'{words}: give KEY=TOLERANCE, such as "{_key(text) or "thickness"}=+-2%"')
        entry = find_input(inputs, _key(text), words)
        if entry.path in made:
            raise ValueError(f"{words}: {entry.path} has a spread already; give each input once")
        made[entry.path] = _parse_spread(entry, text.partition("=")[2].strip(), *nominal(entry))
    return tuple(made.values())


@contextmanager
def in_units_of(given: Sequence[SpreadInput]) -> Iterator[None]:
    """Within it, a refusal of what a tolerance reaches has the unit in which the tolerance was typed."""
    from beamdyn.common.edge.wording import in_unit_of
    from beamdyn.common.inputs.checks import InvalidValue

    texts = {each.name: each.text for each in given}
    try:
        yield
    except InvalidValue as error:
        raise in_unit_of(error, texts.get(error.field, "")) from None


def _parse_spread(entry: Input, tolerance: str, value: float, unit: str) -> SpreadInput:
    from beamdyn.common.edge.units import InvalidInput
    from beamdyn.common.inputs.checks import InvalidValue
    from beamdyn.common.spreading.tolerances import SpreadInput, parse_tolerance

    try:
        given = parse_tolerance(entry.path, tolerance, value, unit, _in_si(unit))
    except InvalidValue as error:
        given = f"{entry.path}={tolerance}"
        raise InvalidInput(OPTION, given, error.bound, error.remedy, error.unit, error.limit) from None
    return SpreadInput(entry.path, unit, value, given)


def _in_si(unit: str) -> Convert:
    from beamdyn.common.edge.units import quantity

    def convert(number: str, written: str) -> float:
        return quantity(f"{number} {written}".strip(), unit)

    return convert
