"""A mechanism's bodies, points, joints and loads as lists: to add, name, join and remove them.

All functions are pure: they take entries of the form, which are those of the TOML file, and return others.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import Input, describe
from beamdyn.common.screens.form_entries import Entries, entries_of, tables_of, toml_value
from beamdyn.common.screens.lists import Cell, Item, ListGroup, Lists
from brakes.config.mechanism import SECTIONS, inputs_of_tables, mechanism_from_dict
from brakes.planar import GROUND, JOINTS, LOADS, Mechanism, Part

_PARTS: dict[str, type[Part]] = {part.key(): part for part in (*JOINTS, *LOADS)}
_INPUTS = {key: describe(SECTIONS[key]) for key in _PARTS}
_POINTS = ("at", "to", "on", "at_other", "points")  # keys whose values are points
_BODIES = ("body", "other", "bodies")
_ROLES = ("cable", "pads", "centring")  # keys of [caliper] whose values are joints and loads
_UNITS = {"m": "mm", "rad": "deg", "N/m": "N/mm"}  # units in which a bare number is taken
_FIRST = {  # first entries of what is added
    "direction": "-90 deg",
    "along": "0 deg",
    "normal": "90 deg",
    "stiffness": "5 N/mm",
    "free_length": "10 mm",
    "free_angle": "0 deg",
}
_HINTS = {"direction": "0 deg is to the right, 90 deg up", "normal": "0 deg is to the right, 90 deg up"}
_APART = 20.0  # between points that are added [mm]


# Entries and tables -------------------------------------------------------------------------------------


def _tables(entries: Mapping[str, str]) -> dict[str, Any]:
    points = {path.partition(".")[2] for path in entries if path.startswith("points.")}
    return tables_of(entries, inputs_of_tables({"points": dict.fromkeys(points)}))


def _entries(tables: dict[str, Any]) -> Entries:
    kept = {key: value for key, value in tables.items() if value not in ([], {})}
    return entries_of(kept, inputs_of_tables(kept))


def _list_at(tables: Mapping[str, Any], key: str) -> list[Any]:
    """The list at a key; an empty one where there is none, such as a text with a mistake."""
    given = tables.get(key)
    return given if isinstance(given, list) else []


def _table_at(tables: Mapping[str, Any], key: str) -> dict[str, Any]:
    """The table at a key; an empty one where there is none."""
    given = tables.get(key)
    return given if isinstance(given, dict) else {}


def _bodies(tables: Mapping[str, Any]) -> list[str]:
    return [str(body) for body in _list_at(tables, "bodies")]


def _points(tables: Mapping[str, Any]) -> dict[str, Any]:
    return _table_at(tables, "points")


def _parts(tables: Mapping[str, Any]) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Kind, number and table of each joint and load."""
    for key in _PARTS:
        for number, part in enumerate(_list_at(tables, key)):
            if isinstance(part, dict):
                yield key, number, part


def _loads(tables: Mapping[str, Any]) -> list[str]:
    kinds = {load.key() for load in LOADS}
    return [str(part.get("name", "")) for key, _, part in _parts(tables) if key in kinds]


def covers(path: str) -> bool:
    """Whether an input is in the lists."""
    table = path.partition(".")[0]
    return table in ("bodies", "points", *_PARTS) or path in ("run.driver", "run.travel")


# What is listed -----------------------------------------------------------------------------------------


def groups(entries: Mapping[str, str]) -> list[ListGroup]:
    """Bodies, points, joints, loads, and what drives the stroke."""
    tables = _tables(entries)
    return [
        ListGroup(
            "Bodies",
            "What moves. The ground is there by itself.",
            tuple(
                Item("bodies", i, body, (Cell("name", "name", body),))
                for i, body in enumerate(_bodies(tables))
            ),
            {"body": "body"},
        ),
        ListGroup(
            "Points",
            "Places in the drawing, where joints and loads act. Drag them there.",
            tuple(_point(name, at) for name, at in _points(tables).items()),
            {"point": "point"},
        ),
        _group("Joints", "They hold bodies together, or to the ground.", JOINTS, tables),
        _group("Loads", "Forces and springs. One without magnitude is found by equilibrium.", LOADS, tables),
        ListGroup("Stroke", "The load that moves the mechanism, and how far.", (_stroke(tables),), {}),
    ]


def _point(name: str, at: Any) -> Item:
    x, y = (str(part) for part in at) if isinstance(at, list) and len(at) == 2 else (str(at), "")
    cells = (Cell("name", "name", name), Cell("x", "x", x), Cell("y", "y", y))
    return Item(f"points.{name}", None, name, cells)


def _group(heading: str, about: str, kinds: Sequence[type[Part]], tables: Mapping[str, Any]) -> ListGroup:
    keys = {kind.key(): kind.kind() for kind in kinds}
    items = tuple(_part(key, i, part, tables) for key, i, part in _parts(tables) if key in keys)
    return ListGroup(heading, about, items, keys)


def _part(key: str, number: int, part: Mapping[str, Any], tables: Mapping[str, Any]) -> Item:
    cells = tuple(_cell(entry, part.get(entry.path), tables) for entry in _INPUTS[key])
    kind, name = _PARTS[key].kind(), str(part.get("name", ""))
    return Item(key, number, name if name.startswith(kind) else f"{kind} {name}".strip(), cells)


def _cell(entry: Input, value: Any, tables: Mapping[str, Any]) -> Cell:
    key, text = entry.path, _said(value)
    known: tuple[str, ...] = ()
    if key in _POINTS and not isinstance(value, list) and key != "points":
        known = tuple(_points(tables))
    elif key in ("body", "other"):
        known = (*_bodies(tables), GROUND)
    elif entry.kind is bool:
        known = ("true", "false")
    if known and text and text not in known:
        known = (text, *known)
    if known and not entry.required:
        known = ("", *known)
    unit = _UNITS.get(entry.quantity.unit, entry.quantity.unit)
    meaning, _, usual = entry.quantity.meaning.partition("; ")
    usual = usual.removesuffix(" if not given") if "if not given" in usual else ""
    words = key.replace("_", " ") + (f" [{unit}]" if unit and key not in _POINTS else "")
    return Cell(key, words, text, known, _HINTS.get(key, meaning), usual)


def _said(value: Any) -> str:
    """A value as it is typed."""
    if value is None:
        return ""
    if isinstance(value, list) and all(isinstance(part, str) for part in value):
        return ", ".join(value)
    return value if isinstance(value, str) else toml_value(value)


def _stroke(tables: Mapping[str, Any]) -> Item:
    run = _table_at(tables, "run")
    driver = str(run.get("driver", ""))
    options = tuple(dict.fromkeys(("", *_loads(tables), driver)))
    cells = (
        Cell("driver", "driver", driver, options, "the load whose point moves", "none"),
        Cell("travel", "travel", str(run.get("travel", "")), (), "such as 10 mm, or 5 deg of a moment"),
    )
    return Item("run", None, "stroke", cells)


# Changes ------------------------------------------------------------------------------------------------


def put(entries: Mapping[str, str], item: Item, key: str, text: str) -> Entries:
    """The entries with another text in a cell; references to an item that is renamed follow."""
    tables, text = _tables(entries), text.strip()
    if item.path == "run":
        run = {**tables.get("run", {}), key: text if key == "driver" else _with_unit(text, "mm")}
        return _entries({**tables, "run": {name: value for name, value in run.items() if value}})
    if item.path == "bodies":
        return _entries(_renamed(tables, _BODIES, item.name, text)) if text else dict(entries)
    if item.path.startswith("points."):
        return _entries(_with_point(tables, item, key, text))
    parts = [dict(part) for part in tables[item.path]]
    part = parts[item.number or 0]
    if key == "name" and text:
        tables = _with_part_renamed(tables, str(part.get("name")), text)
    entry = next(e for e in _INPUTS[item.path] if e.path == key)
    parts[item.number or 0] = {**part, key: _value(entry, text)} if text else _without(part, key)
    return _entries({**tables, item.path: parts})


def _without(part: Mapping[str, Any], key: str) -> dict[str, Any]:
    return {name: value for name, value in part.items() if name != key}


def _value(entry: Input, text: str) -> Any:
    """The value that a text stands for, a bare number with the unit that the form shows."""
    if entry.path in ("bodies", "points"):
        return [part.strip() for part in text.split(",")]
    if entry.kind is bool:
        return text == "true"
    if entry.path in ("name", *_BODIES) or (entry.path in _POINTS and not text.startswith("[")):
        return text
    if text.startswith("["):
        return tables_of({"value": text}, ()).get("value")
    if entry.path in ("direction", "along", "normal"):
        return _with_unit(text, "deg")
    unit = _UNITS.get(entry.quantity.unit, entry.quantity.unit)
    return _with_unit(text, unit) if unit else tables_of({"value": text}, ()).get("value")


def _with_unit(text: str, unit: str) -> str:
    """The text, with a unit if it is a bare number; a decimal comma is a point."""
    number = text.replace(",", ".", 1)
    return f"{number} {unit}" if re.fullmatch(r"[-+]?\d*\.?\d+(e[-+]?\d+)?", number) else text


def _with_point(tables: dict[str, Any], item: Item, key: str, text: str) -> dict[str, Any]:
    points = _points(tables)
    if key == "name":
        if not text or "." in text or text in points:
            return tables
        return _renamed(tables, _POINTS, item.name, text)
    now = {cell.key: cell.text for cell in _point(item.name, points.get(item.name, ["", ""])).cells}
    at = now | {key: _with_unit(text, "mm")}
    return {**tables, "points": {**points, item.name: [at["x"], at["y"]]}}


def _renamed(tables: dict[str, Any], keys: Sequence[str], old: str, new: str) -> dict[str, Any]:
    """Tables in which a body or point has another name, also where a part refers to it."""

    def other(value: Any) -> Any:
        if isinstance(value, list):
            return [other(part) if isinstance(part, str) else part for part in value]
        return new if value == old else value

    made = dict(tables)
    if keys is _BODIES:
        made["bodies"] = other(_bodies(tables))
    else:
        made["points"] = {other(name): at for name, at in _points(tables).items()}
    for key, number, part in _parts(tables):
        changed = {name: other(value) if name in keys else value for name, value in part.items()}
        made[key] = [*made[key][:number], changed, *made[key][number + 1 :]]
    return made


def _with_part_renamed(tables: dict[str, Any], old: str, new: str) -> dict[str, Any]:
    """Tables in which the stroke and the caliper call a part by its new name."""

    def other(value: Any) -> Any:
        return [other(part) for part in value] if isinstance(value, list) else new if value == old else value

    named = {"run": ("driver",), "caliper": _ROLES}
    return tables | {
        table: {key: other(value) if key in keys else value for key, value in tables[table].items()}
        for table, keys in named.items()
        if isinstance(tables.get(table), dict)
    }


def add(entries: Mapping[str, str], kind: str) -> Entries:
    """The entries with one more body, point, joint or load, on bodies and points that there are."""
    tables = _tables(entries)
    if kind == "body":
        return _entries({**tables, "bodies": [*_bodies(tables), _fresh("body", _bodies(tables))]})
    if kind == "point":
        return _entries({**tables, "points": {**_points(tables), **_new_point(tables)}})
    part = {entry.path: _first(entry, kind, tables) for entry in _INPUTS[kind] if entry.required}
    if kind == "force" and not _loads(tables):
        part["magnitude"] = "100 N"
    return _entries({**tables, kind: [*tables.get(kind, []), part]})


def _fresh(word: str, taken: Sequence[str]) -> str:
    return next(name for i in range(1, len(taken) + 2) if (name := f"{word} {i}") not in taken)


def _new_point(tables: Mapping[str, Any]) -> dict[str, Any]:
    """A point beside the last one where there is none, named by the next letter."""
    points = _points(tables)
    letters = [chr(code) for code in range(ord("A"), ord("Z") + 1)]
    name = next((letter for letter in letters if letter not in points), _fresh("P", list(points)))
    taken = {tuple(at) for at in points.values() if isinstance(at, list)}
    column, row = len(points) % 4, len(points) // 4
    places = ((f"{_APART * column:g} mm", f"{_APART * (row + i):g} mm") for i in range(len(points) + 1))
    return {name: [*next(place for place in places if place not in taken)]}


def _first(entry: Input, kind: str, tables: Mapping[str, Any]) -> Any:
    """The first value of an input of a new part: the last body or the last points, which are the newest."""
    key, bodies, points = entry.path, _bodies(tables), list(_points(tables))
    if key == "name":
        return _fresh(_PARTS[kind].kind(), [str(part.get("name")) for _, _, part in _parts(tables)])
    if key == "body":
        return bodies[-1] if bodies else ""
    if key == "bodies":
        return [bodies[-1] if bodies else "", GROUND]
    if key == "points":
        return points[-2:]
    if key in _POINTS:
        alone = key == "to" or kind in ("pin", "force")
        return "".join(points[-1:] if alone or len(points) < 2 else points[-2:-1])
    return _FIRST.get(key, "")


def remove(entries: Mapping[str, str], item: Item) -> Entries:
    """The entries without a body, point, joint or load, and without joints and loads that name it."""
    tables = _tables(entries)
    if item.path == "bodies":
        left = [body for body in _bodies(tables) if body != item.name]
        return _entries(_without_users({**tables, "bodies": left}, _BODIES, item.name))
    if item.path.startswith("points."):
        left = _without(_points(tables), item.name)
        return _entries(_without_users({**tables, "points": left}, _POINTS, item.name))
    return _entries(_without_parts(tables, {(item.path, item.number or 0)}))


def _without_users(tables: dict[str, Any], keys: Sequence[str], name: str) -> dict[str, Any]:
    """Tables without the joints and loads that name a body or point."""

    def uses(part: Mapping[str, Any]) -> bool:
        given = (part.get(key) for key in keys)
        return any(name in value if isinstance(value, list) else name == value for value in given)

    return _without_parts(tables, {(key, number) for key, number, part in _parts(tables) if uses(part)})


def _without_parts(tables: dict[str, Any], gone: Collection[tuple[str, int]]) -> dict[str, Any]:
    """Tables without joints and loads by kind and number; a driver that goes ends the stroke."""
    left: dict[str, Any] = {
        key: [part for number, part in enumerate(tables[key]) if (key, number) not in gone] for key, _ in gone
    }
    names = {part.get("name") for key, number, part in _parts(tables) if (key, number) in gone}
    run = tables.get("run")
    if isinstance(run, dict) and run.get("driver") in names:
        left["run"] = {key: value for key, value in run.items() if key not in ("driver", "travel")}
    return _without_roles(tables | left, names)


def _without_roles(tables: dict[str, Any], names: Collection[Any]) -> dict[str, Any]:
    """Tables whose [caliper] names none of these parts; without cable and pads it is no caliper."""
    given = tables.get("caliper")
    if not isinstance(given, dict):
        return tables
    roles = {key: _unnamed(value, names) if key in _ROLES else value for key, value in given.items()}
    kept = {key: value for key, value in roles.items() if value not in ("", [])}
    if kept.keys() & {"cable", "pads"}:
        return tables | {"caliper": kept}
    return {key: table for key, table in tables.items() if key != "caliper"}


def _unnamed(value: Any, names: Collection[Any]) -> Any:
    """A name, or a list of them, without those of some parts."""
    if isinstance(value, list):
        return [name for name in value if name not in names]
    return "" if value in names else value


def empty(entries: Mapping[str, str]) -> Entries:
    """Entries of one body and two points, to begin with."""
    points = {"A": ["0 mm", "0 mm"], "B": ["40 mm", "0 mm"]}
    return _entries({"title": "my mechanism", "bodies": ["body 1"], "points": points})


# What is missing ----------------------------------------------------------------------------------------


def advice(entries: Mapping[str, str]) -> list[str]:
    """Sentences on what a mechanism still lacks before its forces are determined and it moves."""
    tables = _tables(entries)
    return [*_structure(tables)] or [*_motion(tables)]


def _structure(tables: Mapping[str, Any]) -> Iterator[str]:
    bodies, joints = _bodies(tables), {joint.key() for joint in JOINTS}
    held = [part for key, _, part in _parts(tables) if key in joints]
    if not bodies:
        yield "Add a body: a part that moves."
    if not _points(tables):
        yield "Add points where joints and loads act."
    if bodies and not any(GROUND in _named(part) for part in held):
        yield "Nothing is held by the ground: add a pin, a bar or a slot whose other body is the ground."
    for body in bodies:
        if held and not any(body in _named(part) for part in held):
            yield f"Nothing holds {body}: join it to another body or the ground."
    if bodies and held and not _loads(tables):
        yield "Add a force, and give it a magnitude."


def _named(part: Mapping[str, Any]) -> tuple[Any, ...]:
    """Bodies that a joint joins."""
    if "bodies" in part:
        return tuple(_list_at(part, "bodies"))
    return part.get("body"), part.get("other") or GROUND


def _motion(tables: Mapping[str, Any]) -> Iterator[str]:
    """Compare degrees of freedom with unknown loads, and ask for what drives the stroke."""
    run = _table_at(tables, "run")
    still = {**tables, "run": _without(_without(run, "driver"), "travel")}
    try:
        core = mechanism_from_dict(still, "mechanism").core
    except (ConfigError, ValueError):
        return  # the mistakes stand at the fields
    if not isinstance(core, Mechanism):
        return
    free = core.system.size - core.system.constraints
    unknown = sum(not _is_known(load) for load in core.loads)
    if free > unknown:
        yield (
            f"{len(core.bodies)} bodies have {core.system.size} freedoms; the joints take "
            f"{core.system.constraints}, loads without magnitude {unknown}. Add a joint, or a force without "
            "magnitude."
        )
    elif free < unknown:
        yield f"{unknown} loads have no magnitude, {free} can be found: give magnitudes, or remove a joint."
    elif free == 1 and not (run.get("driver") and run.get("travel")):
        yield "To see it move, choose the load that drives the stroke, and its travel."


def _is_known(load: Any) -> bool:
    """Whether a load has a given magnitude; that of a spring follows from its length."""
    return getattr(load, "magnitude", 0.0) is not None


LISTS = Lists(covers, groups, put, add, remove, advice, empty)
