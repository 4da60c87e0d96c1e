"""Lists of a mechanism's bodies, points, joints and loads, in which users add, rename and remove them.

All functions are pure: they take the entries of the form, as in the TOML file, and return new ones.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from string import ascii_uppercase
from typing import Any

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import Input, describe
from beamdyn.common.edge.toml_text import toml_value
from beamdyn.common.inputs.described import described_hints, description
from beamdyn.common.screens.form_entries import Entries, entries_of, tables_of
from beamdyn.common.screens.lists import Cell, Item, ListGroup, Lists
from brakes.config.mechanism import SECTIONS, inputs_of_tables, mechanism_from_dict
from brakes.planar import GROUND, JOINTS, LOADS, Mechanism, Part
from brakes.planar.part import DescribedBody, DescribedDirection, DescribedPoint, is_list

_PARTS: dict[str, type[Part]] = {part.key(): part for part in (*JOINTS, *LOADS)}
_INPUTS = {key: describe(SECTIONS[key]) for key in _PARTS}
_HINTS_OF_KEYS = {key: hint for part in _PARTS.values() for key, hint in described_hints(part).items()}
_BODIES, _POINTS, _DIRECTIONS = (
    [key for key, hint in _HINTS_OF_KEYS.items() if isinstance(description(hint), kind)]
    for kind in (DescribedBody, DescribedPoint, DescribedDirection)
)
_LISTED = [key for key, hint in _HINTS_OF_KEYS.items() if is_list(hint)]
_ROLES = ("cable", "pads", "centring")  # keys of [caliper] whose values are names of joints and loads
# Units of numbers that are typed without a unit, by the SI unit of the input.
_UNITS = {"m": "mm", "rad": "deg", "N/m": "N/mm"}
_FIRST = {  # initial values of inputs of a new joint or load
    "direction": "-90 deg",
    "along": "0 deg",
    "normal": "90 deg",
    "stiffness": "5 N/mm",
    "free_length": "10 mm",
    "free_angle": "0 deg",
}
_HINTS = {"direction": "0 deg is to the right, 90 deg up", "normal": "0 deg is to the right, 90 deg up"}
_APART = 20.0  # distance between points that are added [mm]


# Entries and tables -------------------------------------------------------------------------------------


def _tables(entries: Mapping[str, str]) -> dict[str, Any]:
    points = {path.partition(".")[2] for path in entries if path.startswith("points.")}
    return tables_of(entries, inputs_of_tables({"points": dict.fromkeys(points)}))


def _entries(tables: dict[str, Any]) -> Entries:
    kept = {key: value for key, value in tables.items() if value not in ([], {})}
    return entries_of(kept, inputs_of_tables(kept))


def _list_at(tables: Mapping[str, Any], key: str) -> list[Any]:
    """Return the list at a key of tables; an empty list if the key is missing or its value is no list."""
    given = tables.get(key)
    return given if isinstance(given, list) else []


def _table_at(tables: Mapping[str, Any], key: str) -> dict[str, Any]:
    """Return the table at a key of tables; an empty table if the key is missing or its value is no table."""
    given = tables.get(key)
    return given if isinstance(given, dict) else {}


def _bodies(tables: Mapping[str, Any]) -> list[str]:
    return [str(body) for body in _list_at(tables, "bodies")]


def _parts(tables: Mapping[str, Any]) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Yield kind, index within the kind, and table of each joint and load."""
    for key in _PARTS:
        for number, part in enumerate(_list_at(tables, key)):
            if isinstance(part, dict):
                yield key, number, part


def _loads(tables: Mapping[str, Any]) -> list[str]:
    kinds = {load.key() for load in LOADS}
    return [str(part.get("name", "")) for key, _, part in _parts(tables) if key in kinds]


def _without(part: Mapping[str, Any], *keys: str) -> dict[str, Any]:
    return {name: value for name, value in part.items() if name not in keys}


def covers(path: str) -> bool:
    """Return whether the lists show the input of a path, so that the form can leave it out."""
    table = path.partition(".")[0]
    return table in ("bodies", "points", *_PARTS) or path in ("run.driver", "run.travel")


# Contents of the lists ----------------------------------------------------------------------------------


def groups(entries: Mapping[str, str]) -> list[ListGroup]:
    """Make the lists of bodies, points, joints and loads, and of the load that drives the stroke."""
    tables = _tables(entries)
    bodies = [Item("bodies", i, name, (_name_cell(name),)) for i, name in enumerate(_bodies(tables))]
    points = []
    for name, at in _table_at(tables, "points").items():
        places = (Cell(axis, axis, text) for axis, text in _coordinates(at).items())
        points.append(Item(f"points.{name}", None, name, (_name_cell(name), *places)))
    run = _table_at(tables, "run")
    driver, travel = str(run.get("driver", "")), str(run.get("travel", ""))
    drivers = tuple(dict.fromkeys(("", *_loads(tables), driver)))
    cells = (
        Cell("driver", "driver", driver, drivers, "the load whose point moves", "none"),
        Cell("travel", "travel", travel, (), "such as 10 mm, or 5 deg of a moment"),
    )
    stroke = [Item("run", None, "stroke", cells)]
    joints, loads = ({kind.key(): kind.kind() for kind in kinds} for kinds in (JOINTS, LOADS))
    parts = [_item(key, i, part, tables) for key, i, part in _parts(tables)]
    of_joints, of_loads = ([part for part in parts if part.path in keys] for keys in (joints, loads))
    free = "Forces and springs. If a force has no magnitude, equilibrium determines it."
    drawn = "Points where joints and loads act. Drag them in the drawing."
    each = (
        ("Bodies", "What moves. The ground always exists.", bodies, {"body": "body"}),
        ("Points", drawn, points, {"point": "point"}),
        ("Joints", "They hold bodies together, or to the ground.", of_joints, joints),
        ("Loads", free, of_loads, loads),
        ("Stroke", "The load that moves the mechanism, and how far.", stroke, {}),
    )
    return [ListGroup(heading, about, tuple(items), kinds) for heading, about, items, kinds in each]


def _name_cell(name: str) -> Cell:
    return Cell("name", "name", name)


def _coordinates(at: Any) -> dict[str, str]:
    """Return the coordinates of a point as the user typed them."""
    x, y = (str(part) for part in at) if isinstance(at, list) and len(at) == 2 else (str(at), "")
    return {"x": x, "y": y}


def _item(key: str, number: int, part: Mapping[str, Any], tables: Mapping[str, Any]) -> Item:
    """Make the list item of a joint or load."""
    cells = tuple(_cell(entry, part.get(entry.path), tables) for entry in _INPUTS[key])
    kind, name = _PARTS[key].kind(), str(part.get("name", ""))
    return Item(key, number, name if name.startswith(kind) else f"{kind} {name}".strip(), cells)


def _cell(entry: Input, value: Any, tables: Mapping[str, Any]) -> Cell:
    """Make the cell of an input of a joint or load: a text field, or a choice of known names."""
    key = entry.path
    if isinstance(value, list) and all(isinstance(part, str) for part in value):
        text = ", ".join(value)
    else:
        text = "" if value is None else value if isinstance(value, str) else toml_value(value)
    known: tuple[str, ...] = ()
    if key in _POINTS and key not in _LISTED and not isinstance(value, list):
        known = tuple(_table_at(tables, "points"))
    elif key in _BODIES and key not in _LISTED:
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


# Changes by the user ------------------------------------------------------------------------------------


def put(entries: Mapping[str, str], item: Item, key: str, text: str) -> Entries:
    """Change the text of a cell; if an item is renamed, references to it are renamed, too."""
    tables, text = _tables(entries), text.strip()
    points, name = _table_at(tables, "points"), item.name
    if item.path == "bodies" and not text:
        return dict(entries)
    if item.path == "run":
        run = {**tables.get("run", {}), key: text if key == "driver" else _with_unit(text, "mm")}
        tables["run"] = {name: value for name, value in run.items() if value}
    elif item.path == "bodies":
        tables["bodies"] = _renamed(_bodies(tables), name, text)
        tables = _with_references(tables, _PARTS, _BODIES, name, text)
    elif item.path.startswith("points.") and key != "name":
        at = _coordinates(points.get(name, ["", ""])) | {key: _with_unit(text, "mm")}
        tables["points"] = {**points, name: [at["x"], at["y"]]}
    elif item.path.startswith("points."):
        if text and "." not in text and text not in points:
            tables["points"] = {_renamed(each, name, text): at for each, at in points.items()}
            tables = _with_references(tables, _PARTS, _POINTS, name, text)
    else:
        part = tables[item.path][item.number or 0]
        if key == "name" and text:
            roles = ("driver", *_ROLES)
            tables = _with_references(tables, ("run", "caliper"), roles, str(part.get("name")), text)
        entry = next(e for e in _INPUTS[item.path] if e.path == key)
        changed = {**part, key: _value(entry, text)} if text else _without(part, key)
        parts = enumerate(tables[item.path])
        tables[item.path] = [changed if i == (item.number or 0) else each for i, each in parts]
    return _entries(tables)


def _value(entry: Input, text: str) -> Any:
    """Convert a typed text to the value of an input; a bare number gets the unit that the form shows."""
    if entry.path in _LISTED:
        return [part.strip() for part in text.split(",")]
    if entry.kind is bool:
        return text == "true"
    if entry.path in ("name", *_BODIES) or (entry.path in _POINTS and not text.startswith("[")):
        return text
    if entry.path in _DIRECTIONS and not text.startswith("["):
        return _with_unit(text, "deg")
    unit = _UNITS.get(entry.quantity.unit, entry.quantity.unit)
    if unit and not text.startswith("["):
        return _with_unit(text, unit)
    return tables_of({"value": text}, ()).get("value")


def _with_unit(text: str, unit: str) -> str:
    """Add a unit to a text that is a bare number; a decimal comma becomes a point."""
    number = text.replace(",", ".", 1)
    return f"{number} {unit}" if re.fullmatch(r"[-+]?\d*\.?\d+(e[-+]?\d+)?", number) else text


def _renamed(value: Any, old: str, new: str) -> Any:
    """Replace a name, alone or within a list of names."""
    if isinstance(value, list):
        return [new if part == old else part for part in value]
    return new if value == old else value


def _with_references(
    tables: dict[str, Any], names: Iterable[str], keys: Sequence[str], old: str, new: str
) -> dict[str, Any]:
    """Replace the name `old` by `new` wherever it is the value of one of `keys`.

    This is done in the tables, or lists of tables, that `names` lists.
    """

    def changed(table: Any) -> Any:
        if isinstance(table, list):
            return [changed(each) for each in table]
        if not isinstance(table, dict):
            return table
        return {key: _renamed(value, old, new) if key in keys else value for key, value in table.items()}

    return tables | {name: changed(tables[name]) for name in names if name in tables}


def add(entries: Mapping[str, str], kind: str) -> Entries:
    """Add a body, point, joint or load to the entries, with references to existing bodies and points."""
    tables = _tables(entries)
    if kind == "body":
        tables["bodies"] = [*_bodies(tables), _fresh("body", _bodies(tables))]
    elif kind == "point":  # a new point at a free position, named by the next letter
        points = _table_at(tables, "points")
        name = next((letter for letter in ascii_uppercase if letter not in points), _fresh("P", [*points]))
        taken = {tuple(at) for at in points.values() if isinstance(at, list)}
        row, column = divmod(len(points), 4)
        rows = range(row, row + len(points) + 1)
        places = ((f"{_APART * column:g} mm", f"{_APART * each:g} mm") for each in rows)
        tables["points"] = {**points, name: [*next(place for place in places if place not in taken)]}
    else:
        part = {entry.path: _first(entry.path, kind, tables) for entry in _INPUTS[kind] if entry.required}
        if kind == "force" and not _loads(tables):
            part["magnitude"] = "100 N"
        tables[kind] = [*tables.get(kind, []), part]
    return _entries(tables)


def _fresh(word: str, taken: Sequence[str]) -> str:
    return next(name for i in range(1, len(taken) + 2) if (name := f"{word} {i}") not in taken)


def _first(key: str, kind: str, tables: Mapping[str, Any]) -> Any:
    """Choose the initial value of an input of a new joint or load, such as the newest body or points."""
    points, body = [*_table_at(tables, "points")], next(reversed(_bodies(tables)), "")
    if key == "name":
        return _fresh(_PARTS[kind].kind(), [str(part.get("name")) for _, _, part in _parts(tables)])
    if key in _BODIES:
        return [body, GROUND] if key in _LISTED else body
    if key in _POINTS and key in _LISTED:
        return points[-2:]
    if key in _POINTS:
        alone = key == "to" or kind in ("pin", "force")
        return "".join(points[-1:] if alone or len(points) < 2 else points[-2:-1])
    return _FIRST.get(key, "")


def remove(entries: Mapping[str, str], item: Item) -> Entries:
    """Remove a body, point, joint or load from the entries, with joints and loads that refer to it.

    The stroke is removed with its driver.  Removed names are deleted in [caliper], and the table itself is
    deleted if neither cable nor pads are left.
    """
    tables, name = _tables(entries), item.name
    keys: Sequence[str] = ()
    if item.path == "bodies":
        keys, tables["bodies"] = _BODIES, [body for body in _bodies(tables) if body != name]
    elif item.path.startswith("points."):
        keys, tables["points"] = _POINTS, _without(_table_at(tables, "points"), name)

    def goes(key: str, number: int, part: Mapping[str, Any]) -> bool:
        given = (part.get(each) for each in keys)
        uses = any(name in value if isinstance(value, list) else name == value for value in given)
        return uses or (key, number) == (item.path, item.number or 0)

    gone = [each for each in _parts(tables) if goes(*each)]
    names = {part.get("name") for _, _, part in gone}
    for key in {key for key, _, _ in gone}:
        numbers = {number for other, number, _ in gone if other == key}
        tables[key] = [part for number, part in enumerate(tables[key]) if number not in numbers]
    run, caliper = _table_at(tables, "run"), _table_at(tables, "caliper")
    if run.get("driver") in names:
        tables["run"] = _without(run, "driver", "travel")
    for key in _ROLES:
        value = caliper.get(key)
        if isinstance(value, list):
            caliper[key] = [part for part in value if part not in names]
        elif value in names:
            caliper[key] = ""
    kept = {key: value for key, value in caliper.items() if value not in ("", [])}
    if kept.keys() & {"cable", "pads"}:
        tables["caliper"] = kept
    elif caliper:
        del tables["caliper"]
    return _entries(tables)


def empty(entries: Mapping[str, str]) -> Entries:
    """Make the entries of a new mechanism, with one body and two points."""
    points = {"A": ["0 mm", "0 mm"], "B": ["40 mm", "0 mm"]}
    return _entries({"title": "my mechanism", "bodies": ["body 1"], "points": points})


# Advice on what is missing ------------------------------------------------------------------------------


def advice(entries: Mapping[str, str]) -> list[str]:
    """Return sentences on what a mechanism lacks until its forces are determined and it moves."""
    tables = _tables(entries)
    return [*_structure(tables)] or [*_motion(tables)]


def _structure(tables: Mapping[str, Any]) -> Iterator[str]:
    bodies, joints = _bodies(tables), {joint.key() for joint in JOINTS}
    held = [part for key, _, part in _parts(tables) if key in joints]
    joined = [
        _list_at(part, "bodies") if "bodies" in part else [part.get("body"), part.get("other") or GROUND]
        for part in held
    ]
    if not bodies:
        yield "Add a body: a part that moves."
    if not _table_at(tables, "points"):
        yield "Add points where joints and loads act."
    if bodies and not any(GROUND in named for named in joined):
        yield "Nothing is held by the ground: add a pin, a bar or a slot whose other body is the ground."
    for body in bodies:
        if held and not any(body in named for named in joined):
            yield f"Nothing holds {body}: join it to another body or the ground."
    if bodies and held and not _loads(tables):
        yield "Add a force, and give it a magnitude."


def _motion(tables: Mapping[str, Any]) -> Iterator[str]:
    """Yield advice that compares mobility with the number of unknown loads, and asks for a driver."""
    run = _table_at(tables, "run")
    try:
        core = mechanism_from_dict({**tables, "run": _without(run, "driver", "travel")}, "mechanism").core
    except (ConfigError, ValueError):
        return  # no advice while inputs are wrong: the form shows these mistakes beside its fields
    if not isinstance(core, Mechanism):
        return
    free = core.system.size - core.system.constraints
    # The force of a spring is no unknown: it follows from the spring's length.
    unknown = sum(getattr(load, "magnitude", 0.0) is None for load in core.loads)
    if free != unknown:
        more, fewer = "Add a joint, or a force without magnitude.", "Give magnitudes, or remove a joint."
        yield (
            f"Degrees of freedom of bodies: {core.system.size}; constraints of joints: "
            f"{core.system.constraints}; loads without magnitude: {unknown}. "
            f"{more if free > unknown else fewer}"
        )
    elif free == 1 and not (run.get("driver") and run.get("travel")):
        yield "To see the mechanism move, choose the load that drives the stroke, and its travel."


LISTS = Lists(covers, groups, put, add, remove, advice, empty)
