"""Joints and loads: what each is, brings and is given; the base classes tell how to write a new one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache
from types import NoneType
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self, get_args

import numpy as np

from beamdyn.common.inputs.checks import flag, kind, set_fields, several
from beamdyn.common.inputs.described import Described, described_hints, descriptions, kinds_of
from brakes.planar.rows import (
    GROUND,
    End,
    FrictionLaw,
    Path,
    Point,
    Row,
    check_distinct,
    check_point,
    unit_vector,
)

# Types of the inputs of joints and loads, described for checks, files and forms --------------------------


@dataclass(frozen=True)
class DescribedPoint(Described):
    """Description of a point."""

    def check(self, name: str, value: Any) -> Point:
        """The point; what is not two finite coordinates is refused."""
        return check_point(name, value)


@dataclass(frozen=True)
class DescribedBody(Described):
    """Description of the name of a body, or of a list of them."""


@dataclass(frozen=True)
class DescribedDirection(Described):
    """Description of a direction."""

    def check(self, name: str, value: Any) -> Point:
        """The unit vector; what is not two finite components, or has no direction, is refused."""
        return unit_vector(name, value)


def check_inputs(core: object, prefix: str = "") -> None:
    """Refuse described inputs that are not as described, and keep numbers as floats.

    Parameters
    ----------
    core : object
        An instance of a frozen dataclass.
    prefix : str
        Put before their names in messages.

    Raises
    ------
    ValueError
        With the first that is refused.
    """
    for name, wanted, listed, optional, described in _wanted(type(core)):
        value = getattr(core, name)
        if value is None and optional:
            continue
        if listed:
            for k, part in enumerate(several(prefix + name, value, object)):
                _check(f"{prefix}{name}[{k}]", part, wanted, described)
        elif (checked := _check(prefix + name, value, wanted, described)) is not None:
            set_fields(core, **{name: checked})


@cache
def _wanted(core: type) -> list[tuple[str, Any, bool, bool, Described]]:
    """Name of each input of a dataclass, its type, whether it is a list of these, whether it may be None.

    Told once, since designs are made by the thousand.
    """
    hints, wanted = described_hints(core), []
    for name, described in descriptions(core).items():
        kinds, listed = kinds_of(hints[name]), is_list(hints[name])
        kind = kinds_of(get_args(kinds[0])[0])[0] if listed else kinds[0]
        wanted.append((name, kind, listed, NoneType in kinds, described))
    return wanted


def _check(name: str, value: object, wanted: Any, described: Described) -> float | None:
    """Refuse a value that is not as described; a number is returned as a float."""
    if wanted is float:
        return described.check(name, value)
    if wanted is str:
        kind(name, value, str)
    elif wanted is bool:
        flag(name, value)
    elif type(described) is not Described:
        described.check(name, value)
    return None


def is_list(hint: Any) -> bool:
    """Whether an annotation is that of a tuple of any length."""
    return Ellipsis in get_args(kinds_of(hint)[0])


Body = Annotated[str, DescribedBody(meaning="body")]
Other = Annotated[str, DescribedBody(meaning="other body; the ground if not given", default=GROUND)]
DrawnPoint = Annotated[Point, DescribedPoint("m", meaning="point in the drawing")]
Direction = Annotated[Point, DescribedDirection(meaning="direction, as a vector or an angle")]
Length = Annotated[float, Described("m", meaning="length, if not the drawing's", above=0)]
Coefficient = Annotated[
    float,
    Described(
        symbol="mu",
        meaning="coefficient of friction",
        least=0,
        remedy="friction opposes the motion by itself; give its size",
    ),
]


_NEWTONS = Described(
    "N", meaning="magnitude; unknown if not given", remedy="or None for an unknown amplitude"
)
Newtons = Annotated[float, _NEWTONS]
NewtonMetres = Annotated[float, replace(_NEWTONS, unit="N m")]


Style = Literal["bar", "cable", "spring", "pin", "face", "force"]


class Shape(NamedTuple):
    """A part of the drawing of a joint or load.

    Parameters
    ----------
    style : {"bar", "cable", "spring", "pin", "face", "force"}
        A bar or cable through `ends`, a spring between them, a pin or a face at the first of them; a force is
        drawn as an arrow where it is known.  The second end of a round face is its centre.
    ends : tuple of End
        Points of bodies; each body's outline goes around those of all its joints and loads.
    frame : str
        The body with which a face turns.
    along : tuple of float
        Direction of a face.

    Examples
    --------
    >>> pin = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> [shape.style for shape in pin.shapes()]
    ['pin']
    """

    style: Style
    ends: tuple[End, ...]
    frame: str = GROUND
    along: Point = (1.0, 0.0)


class OneWay(NamedTuple):
    """Words for a joint or load that acts one way only.

    noun : what it is.
    cannot : what it cannot do.
    status : the status of an equilibrium in which it would have to.
    remedy : what to do then.
    """

    noun: str
    cannot: str
    status: str
    remedy: str


@dataclass(frozen=True)
class Part:
    """A joint or a load.

    Parameters
    ----------
    name : str
        Its name, which no other joint or load of the mechanism has.

    Raises
    ------
    ValueError
        If an input is not as it is described.

    Examples
    --------
    >>> isinstance(planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0)), planar.Part)
    True
    """

    label: ClassVar[str] = ""
    one_way: ClassVar[OneWay | None] = None

    name: Annotated[str, Described(meaning="name")]

    def __post_init__(self) -> None:
        kind("name", self.name, str)
        check_inputs(self, f"{self.title}: ")

    @classmethod
    def kind(cls) -> str:
        """Name of the kind, such as "rotation lock"."""
        return "".join(f" {c.lower()}" if c.isupper() else c for c in cls.__name__).strip()

    @classmethod
    def key(cls) -> str:
        """Its table in a file, such as "rotation_lock"."""
        return cls.kind().replace(" ", "_")

    @property
    def title(self) -> str:
        """Kind and name, for messages."""
        return f"{self.kind()} {self.name!r}"

    def rows(self) -> tuple[Row, ...]:
        """Rows that it forbids (a joint), or the coordinate on which it does its work (a load)."""
        raise NotImplementedError

    def shapes(self) -> tuple[Shape, ...]:
        """How it is drawn."""
        return ()

    @property
    def acts_on(self) -> tuple[str, ...]:
        """The bodies on which it acts, that whose force is given first."""
        return self.rows()[0].bodies

    @property
    def is_couple(self) -> bool:
        """Whether it acts by a couple alone."""
        return all(row.is_couple for row in self.rows())

    @property
    def unit(self) -> str:
        """Unit of its size."""
        return "N m" if self.is_couple else "N"


@dataclass(frozen=True)
class OnTwoBodies(Part):
    """Base of joints and loads on a body and another one."""

    body: Body
    other: Other


@dataclass(frozen=True)
class BetweenPoints(OnTwoBodies):
    """Base of joints and loads along the line between a point of a body and one of another."""

    remedy: ClassVar[str] = "it has no direction; move one of its ends"
    style: ClassVar[Style]

    at: DrawnPoint
    to: DrawnPoint

    def __post_init__(self) -> None:
        super().__post_init__()
        check_distinct(self.title, (self.at, self.to), self.remedy)

    def path(self, length: float | None = None) -> Path:
        """The line between the points; its length is the drawing's if not given [m]."""
        drawn = math.dist(self.at, self.to)
        return Path((self.body, self.other), (self.at, self.to), drawn if length is None else length)

    def shapes(self) -> tuple[Shape, ...]:
        """A line between the points."""
        return (Shape(self.style, self.path().ends),)


class Joint(Part):
    """Base class of joints.

    In order to write a new joint:

    1. Derive a frozen dataclass from `Joint`, in a module of its own.  Its fields are its inputs; annotate
       each by a type of `inputs` or by ``Annotated[type, Described(...)]``.  Checks, TOML tables and forms
       follow from that; the table's name is the class name in snake case.
    2. `rows` returns what the joint forbids: each `Line`, `Path`, `Turn` or `Round` has the value 0 as long
       as the joint holds, and is an unknown reaction.  The force of the joint is the one on the first body of
       the first row.  The constructor must refuse what makes a row meaningless (points that coincide); extend
       `__post_init__`, and call that of the base class first.
    3. With one row, its multiplier is the size of the joint, with a sign; with several it is the length of
       the vector of multipliers.  Override `size` if that is not a force, or not the one of interest.
    4. If it rubs, `friction_laws` returns where and how; laws with a coefficient of 0 are left out.  If
       friction comes from a pivot, override `with_pivot` as well.
    5. `shapes` returns how it is drawn, by the styles of `Shape`.
    6. `label` is its name in the plural, for forms.  Set `one_way` if only a positive size makes sense,
       `signs` if the signs of the size have names, and `is_hinge` if it holds a point and nothing else.
       `doubts` warns of inputs that a stroke shows to be doubtful.
    7. Add the class to `JOINTS` and to `__all__` in `brakes/planar/__init__.py`, and write a test of it
       against a closed form.  Files, forms, statics, strokes, friction and drawings take it from there.

    Examples
    --------
    >>> [joint.__name__ for joint in planar.JOINTS]
    ['Pin', 'Bar', 'Slot', 'Contact', 'RotationLock', 'Cable']
    """

    signs: ClassVar[tuple[str, str]] = ("", "")
    is_hinge: ClassVar[bool] = False

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        """Friction at the joint; none if its coefficient is 0."""
        return ()

    def size(self, multiplier: np.ndarray) -> np.ndarray:
        """Size (S,) of the joint's force for multipliers (S, rows) [N, N m]."""
        single = multiplier.shape[1] == 1
        return multiplier[:, 0] if single else np.hypot.reduce(multiplier, axis=1)

    def doubts(self, angles: Mapping[str, np.ndarray]) -> Iterator[str]:
        """Sentences on what may not be meant, by the angles (S,) of the bodies over a stroke [rad]."""
        return iter(())

    def with_pivot(self, radius: float, friction: float) -> Joint:
        """The joint with a radius [m] and friction of its pivot where it has none of its own.

        Itself if it has no pivot.
        """
        return self


class Load(Part):
    """Base class of loads.

    In order to write a new load:

    1. Describe its inputs as those of a joint (see `Joint`, 1).
    2. `row` returns the coordinate on which it does its work: a unit load acts as the row's gradient.  If the
       direction of the load makes the row's value no coordinate, override `has_coordinate`.
    3. `amplitude` returns its size at values of that coordinate, or None if equilibrium has to give it.  For
       a load with a field `magnitude` derive from `AppliedLoad` instead, which does that.
    4. `shapes`, `label` and `one_way` are as those of a joint.
    5. Add the class to `LOADS` and to `__all__` in `brakes/planar/__init__.py`, and write a test.

    Examples
    --------
    >>> [load.__name__ for load in planar.LOADS]
    ['Force', 'Moment', 'CablePair', 'Spring', 'TorsionSpring']
    """

    def row(self) -> Row:
        """The coordinate on which it does its work."""
        raise NotImplementedError

    def rows(self) -> tuple[Row, ...]:
        """The only row."""
        return (self.row(),)

    @property
    def has_coordinate(self) -> bool:
        """Whether the value of its row is a coordinate, which may drive a stroke."""
        return True

    def amplitude(self, coordinate: np.ndarray) -> np.ndarray | float | None:
        """Its size [N, N m] at values (S,) of its coordinate [m, rad]; None if unknown."""
        raise NotImplementedError

    def with_magnitude(self, magnitude: float | None) -> Load:
        """The load with another magnitude [N, N m].

        Raises
        ------
        ValueError
            If its size is not free to choose.
        """
        raise ValueError(f"load {self.name!r} is a spring: name a force, a moment or a cable pair")

    def shifted(self, distance: float) -> Load:
        """The load with its point moved along its direction [m].

        Raises
        ------
        ValueError
            If it does not act on one point.
        """
        raise ValueError("the wear of a pad needs its load to be a force on its face")


class AppliedLoad(Load):
    """A load of a known magnitude [N, N m], or of an unknown one (None) that equilibrium gives."""

    magnitude: float | None

    def amplitude(self, coordinate: np.ndarray) -> float | None:
        """Its magnitude."""
        return self.magnitude

    def with_magnitude(self, magnitude: float | None) -> Self:
        """The load with another magnitude [N, N m]."""
        return replace(self, magnitude=magnitude)
