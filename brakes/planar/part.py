"""Base classes of joints and loads: inputs, rows (see `brakes.planar.rows`), drawings, and how to write one.

In shapes of arrays, S counts positions.
"""

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
    """Description of an input that is a point in the drawing."""

    def check(self, name: str, value: Any) -> Point:
        """Return the point; refuse a value that is not two finite coordinates."""
        return check_point(name, value)


@dataclass(frozen=True)
class DescribedBody(Described):
    """Description of an input that is the name of a body, or a list of such names."""


@dataclass(frozen=True)
class DescribedDirection(Described):
    """Description of an input that is a direction."""

    def check(self, name: str, value: Any) -> Point:
        """Return the unit vector; refuse a value that is not two finite components, or is zero."""
        return unit_vector(name, value)


def check_inputs(core: object, prefix: str = "") -> None:
    """Check described inputs of a dataclass against their descriptions, and store numbers as floats.

    Parameters
    ----------
    core : object
        An instance of a frozen dataclass.
    prefix : str
        Text before the names of inputs in messages.

    Raises
    ------
    ValueError
        For the first input that is refused.
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
    """List each described input of a dataclass: name, type, whether it is a list, whether it may be None.

    Cached, as studies make thousands of instances of each class.
    """
    hints, wanted = described_hints(core), []
    for name, described in descriptions(core).items():
        kinds, listed = kinds_of(hints[name]), is_list(hints[name])
        kind = kinds_of(get_args(kinds[0])[0])[0] if listed else kinds[0]
        wanted.append((name, kind, listed, NoneType in kinds, described))
    return wanted


def _check(name: str, value: object, wanted: Any, described: Described) -> float | None:
    """Refuse a value that contradicts its description; return a number as a float, else None."""
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
    """Return whether a type annotation is a tuple of any length."""
    return Ellipsis in get_args(kinds_of(hint)[0])


Body = Annotated[str, DescribedBody(meaning="body")]
Other = Annotated[str, DescribedBody(meaning="other body; the ground if not given", default=GROUND)]
DrawnPoint = Annotated[Point, DescribedPoint("m", meaning="point in the drawing")]
Direction = Annotated[Point, DescribedDirection(meaning="direction, as a vector or an angle")]
Length = Annotated[float, Described("m", meaning="length, if not the drawing's", above=0)]
_OPPOSES = "friction opposes motion in either direction; give its absolute value"
Coefficient = Annotated[float, Described("", "mu", "coefficient of friction", least=0, remedy=_OPPOSES)]
_UNKNOWN = "or None for an unknown magnitude"
_NEWTONS = Described("N", meaning="magnitude; unknown if not given", remedy=_UNKNOWN)
Newtons = Annotated[float, _NEWTONS]
NewtonMetres = Annotated[float, replace(_NEWTONS, unit="N m")]


Style = Literal["bar", "cable", "spring", "pin", "face", "force"]


class Shape(NamedTuple):
    """A part of the drawing of a joint or load.

    Parameters
    ----------
    style : {"bar", "cable", "spring", "pin", "face", "force"}
        A bar, cable or spring along `ends`; a pin or a face at the first of them; a force, drawn as an arrow
        if it is known.  The second end of a round face is its centre.
    ends : tuple of End
        Points of bodies. The outline of a body goes around the points of all its joints and loads.
    frame : str
        The body with which a face turns.
    along : tuple of float
        Direction of a straight face.

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
    """Words in messages about a joint or load that acts in one direction only.

    noun : name of the part, such as "cable".
    cannot : the impossible action, such as "push".
    status : status of an equilibrium in which it would have to do that.
    remedy : advice for this case.
    """

    noun: str
    cannot: str
    status: str
    remedy: str


@dataclass(frozen=True)
class Part:
    """Base of joints and loads of a mechanism.

    Parameters
    ----------
    name : str
        Unique name among the joints and loads of the mechanism.

    Raises
    ------
    ValueError
        If an input contradicts its description.

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
        """Name of the kind of joint or load, such as "rotation lock"."""
        return "".join(f" {c.lower()}" if c.isupper() else c for c in cls.__name__).strip()

    @classmethod
    def key(cls) -> str:
        """Name of the kind's table in a file, such as "rotation_lock"."""
        return cls.kind().replace(" ", "_")

    @property
    def title(self) -> str:
        """Kind and name of this joint or load, for messages."""
        return f"{self.kind()} {self.name!r}"

    def rows(self) -> tuple[Row, ...]:
        """Return the rows of a joint's constraints, or the row whose value is a load's coordinate."""
        raise NotImplementedError

    def shapes(self) -> tuple[Shape, ...]:
        """Return the shapes with which the joint or load is drawn."""
        return ()

    @property
    def acts_on(self) -> tuple[str, ...]:
        """The bodies on which the joint or load acts; results give the force on the first one."""
        return self.rows()[0].bodies

    @property
    def is_couple(self) -> bool:
        """Whether the joint or load acts by couples only."""
        return all(row.is_couple for row in self.rows())

    @property
    def unit(self) -> str:
        """Unit of the force or couple: "N" or "N m"."""
        return "N m" if self.is_couple else "N"


@dataclass(frozen=True)
class OnTwoBodies(Part):
    """Base of joints and loads between two bodies."""

    body: Body
    other: Other


@dataclass(frozen=True)
class BetweenPoints(OnTwoBodies):
    """Base of joints and loads along the line between a point of one body and a point of another."""

    remedy: ClassVar[str] = "it has no direction; move one of its ends"
    style: ClassVar[Style]

    at: DrawnPoint
    to: DrawnPoint

    def __post_init__(self) -> None:
        super().__post_init__()
        check_distinct(self.title, (self.at, self.to), self.remedy)

    def path(self, length: float | None = None) -> Path:
        """Return the row of the line between the points, for a length [m], by default that of the drawing."""
        drawn = math.dist(self.at, self.to)
        return Path((self.body, self.other), (self.at, self.to), drawn if length is None else length)

    def shapes(self) -> tuple[Shape, ...]:
        """Return the drawing of a line between the points."""
        return (Shape(self.style, self.path().ends),)


class Joint(Part):
    """Base class of joints.

    How to write a new joint:

    1. Derive a frozen dataclass from `Joint`, in a module of its own.  Its fields are its inputs; annotate
       each by a type of `inputs` or by ``Annotated[type, Described(...)]``.  Checks, TOML tables and forms
       follow from that; the table's name is the class name in snake case.
    2. `rows` returns the constraints: each `Line`, `Path`, `Turn` or `Round` has the value 0 as long
       as the joint holds, and an unknown reaction as multiplier.  The joint's force is the force on the first
       body of the first row.  The constructor must refuse what makes a row meaningless (coincident points):
       extend `__post_init__`, and call the method of the base class first.
    3. If there is one row, its multiplier with its sign is the size of the joint's force; if there are
       several, the size is the norm of the multipliers.  Override `size` if that is not a force, or not the
       one of interest.
    4. If the joint has friction, `friction_laws` returns where it acts and how; laws with a coefficient of
       0 are left out.  If it is friction in a pivot, override `with_pivot` as well.
    5. `shapes` returns how the joint is drawn, by the styles of `Shape`.
    6. `label` is the joint's name in the plural, for forms.  Set `one_way` if only a positive size
       makes sense, `signs` if the signs of the size have names, and `is_hinge` if the joint holds a point
       and nothing else. `doubts` warns of inputs that a stroke shows to be doubtful.
    7. Add the class to `JOINTS` and to `__all__` in `brakes/planar/__init__.py`, and test it
       against a closed form.  Files, forms, statics, strokes, friction and drawings then include it.

    Examples
    --------
    >>> [joint.__name__ for joint in planar.JOINTS]
    ['Pin', 'Bar', 'Slot', 'Contact', 'RotationLock', 'Cable']
    """

    signs: ClassVar[tuple[str, str]] = ("", "")
    is_hinge: ClassVar[bool] = False

    def friction_laws(self) -> tuple[FrictionLaw, ...]:
        """Return the friction laws of the joint; the mechanism ignores laws with a coefficient of 0."""
        return ()

    def size(self, multiplier: np.ndarray) -> np.ndarray:
        """Compute the size of the joint's force [N, N m] from its rows' multipliers (positions, rows)."""
        return multiplier[:, 0] if multiplier.shape[1] == 1 else np.hypot.reduce(multiplier, axis=1)

    def doubts(self, angles: Mapping[str, np.ndarray]) -> Iterator[str]:
        """Yield warnings of doubtful inputs, given the angles of the bodies over a stroke [rad]."""
        return iter(())

    def with_pivot(self, radius: float, friction: float) -> Joint:
        """Copy the joint with a radius [m] and friction of its pivot, unless it already has friction.

        A joint without a pivot returns itself.
        """
        return self


class Load(Part):
    """Base class of loads.

    How to write a new load:

    1. Describe its inputs like those of a joint (see `Joint`, step 1).
    2. `row` returns the coordinate on which the load does work: a unit load acts as the row's gradient.
       If the row's value is not a coordinate, as for a direction that turns, override `has_coordinate`.
    3. `amplitude` returns the load's size at values of that coordinate, or None if equilibrium determines it.
       For a load with a field `magnitude`, derive from `AppliedLoad` instead, which does this.
    4. `shapes`, `label` and `one_way` are like those of a joint.
    5. Add the class to `LOADS` and to `__all__` in `brakes/planar/__init__.py`, and write a test.

    Examples
    --------
    >>> [load.__name__ for load in planar.LOADS]
    ['Force', 'Moment', 'CablePair', 'Spring', 'TorsionSpring']
    """

    def row(self) -> Row:
        """Return the row whose value is the coordinate on which the load does work."""
        raise NotImplementedError

    def rows(self) -> tuple[Row, ...]:
        """Return the single row of the load: the coordinate on which the load does work."""
        return (self.row(),)

    @property
    def has_coordinate(self) -> bool:
        """Whether the value of the load's row is a coordinate, which may drive a stroke."""
        return True

    def amplitude(self, coordinate: np.ndarray) -> np.ndarray | float | None:
        """Compute the load [N, N m] at values of the load's coordinate [m, rad]; None if unknown."""
        raise NotImplementedError

    def with_magnitude(self, magnitude: float | None) -> Load:
        """Copy the load with another magnitude [N, N m].

        Raises
        ------
        ValueError
            If the magnitude cannot be chosen, as for a spring.
        """
        raise ValueError(f"load {self.name!r} is a spring: name a force, a moment or a cable pair")

    def shifted(self, distance: float) -> Load:
        """Copy the load with its point moved along its direction by a distance [m].

        Raises
        ------
        ValueError
            If it does not act on one point.
        """
        raise ValueError("the wear of a pad needs its load to be a force on its face")


class AppliedLoad(Load):
    """Base of loads with a known magnitude [N, N m], or an unknown one (None) that equilibrium gives."""

    magnitude: float | None

    def amplitude(self, coordinate: np.ndarray) -> float | None:
        """Return the load's magnitude [N, N m] at any value of its coordinate; None if unknown."""
        return self.magnitude

    def with_magnitude(self, magnitude: float | None) -> Self:
        """Copy the load with another magnitude [N, N m]."""
        return replace(self, magnitude=magnitude)
