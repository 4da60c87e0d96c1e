"""What the inputs of joints and loads are: described once, for checks here and for files and forms."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cache
from typing import Annotated, Any, Literal, get_args, get_type_hints

from beamdyn.common.checks import not_negative, positive, real
from brakes.planar.points import GROUND, Point, check_point, unit_vector

_CHECKS = {None: real, "positive": positive, "not negative": not_negative}


@dataclass(frozen=True)
class Described:
    """Description of an input, for `Annotated[float, Described("number", "stiffness", unit="N/m")]`.

    Parameters
    ----------
    kind : {"name", "names", "choice", "flag", "number", "point", "points", "direction"}
        What it is.
    meaning : str
        What it is for people: a phrase without a full stop.
    unit, symbol : str
        SI unit, "" for a plain number; symbol in formulas.
    bound : {"positive", "not negative"}, optional
        Its bound.
    remedy : str
        What to do about a value out of bounds.
    choices : tuple of str
        The values allowed of a choice.
    default : str, optional
        What a file may leave out, though the constructor asks for it.
    """

    kind: Literal["name", "names", "choice", "flag", "number", "point", "points", "direction"]
    meaning: str
    _: KW_ONLY
    unit: str = ""
    symbol: str = ""
    bound: Literal["positive", "not negative"] | None = None
    remedy: str = ""
    choices: tuple[str, ...] = ()
    default: str | None = None

    def check(self, key: str, value: Any) -> None:
        """A ValueError that names the key if a value is not such an input."""
        if self.kind == "number":
            _CHECKS[self.bound](key, value, self.unit, self.remedy)
        elif self.kind == "direction":
            unit_vector(key, value)
        elif self.kind in ("point", "points"):
            for point in value if self.kind == "points" else (value,):
                check_point(key, point)
        elif self.kind == "choice" and value not in self.choices:
            raise ValueError(f"{key} = {value!r}: give {' or '.join(map(repr, self.choices))}")


@cache
def inputs_of(model: type) -> dict[str, Described]:
    """The described fields of a dataclass, in their order."""
    hints = get_type_hints(model, include_extras=True)
    described = {key: _description(hint) for key, hint in hints.items()}
    return {key: entry for key, entry in described.items() if entry is not None}


def check_inputs(core: object, prefix: str = "") -> None:
    """A ValueError if a described field of a dataclass is not as described; None is left to the class."""
    for key, described in inputs_of(type(core)).items():
        value = getattr(core, key)
        if value is not None:
            described.check(prefix + key, value)


def _description(annotation: Any) -> Described | None:
    """That of an annotation, or of one of its alternatives."""
    for part in (annotation, *get_args(annotation)):
        for described in getattr(part, "__metadata__", ()):
            if type(described) is Described:
                return described
    return None


Body = Annotated[str, Described("name", "body")]
Other = Annotated[str, Described("name", "other body; the ground if not given", default=GROUND)]
DrawnPoint = Annotated[Point, Described("point", "point in the drawing", unit="m")]
Direction = Annotated[Point, Described("direction", "direction, as a vector or an angle")]
Length = Annotated[float, Described("number", "length, if not the drawing's", unit="m", bound="positive")]
_FRICTION = "friction opposes the motion by itself; give its size"
Coefficient = Annotated[
    float, Described("number", "coefficient of friction", symbol="mu", bound="not negative", remedy=_FRICTION)
]


def _magnitude(unit: str) -> Described:
    meaning, remedy = "magnitude; unknown if not given", "or None for an unknown amplitude"
    return Described("number", meaning, unit=unit, remedy=remedy)


Newtons = Annotated[float, _magnitude("N")]
NewtonMetres = Annotated[float, _magnitude("N m")]
