"""Writing of a blade as a scene file: TOML tables, and text with a table of stations with units."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from beamdyn.common.inputs.described import descriptions
from beamdyn.files.decks.blade import Blade, BladeMatrices
from beamdyn.scene.beam import ANGLE_UNITS, OF_ANY_SIGN, OFFSETS, PROPERTY_UNITS
from beamdyn.scene.points import TipMass
from beamdyn.scene.section_matrices import UPPER, entry_name, entry_units

_UNITS = dict.fromkeys(ANGLE_UNITS, "deg") | PROPERTY_UNITS
_TIP_UNITS = {name: each.unit for name, each in descriptions(TipMass).items()}
_DIGITS = 15  # digits of numbers in the file: the precision of a float


def tables_of(blade: Blade) -> dict[str, Any]:
    """Return the TOML tables of a scene with the blade, as tomllib would return them.

    The blade points outward.  If twist and pitch are 0, flapwise bending (with `bending_stiffness`) is out of
    the plane of rotation.
    """
    tables: dict[str, Any] = {
        "beam": {"length": f"{_number(blade.length)} m"} | _tables_of_stations(blade),
        "mount": {
            "radius": f"{_number(blade.hub_radius)} m",
            "setting_angle": "180 deg",
            "bending_angle": f"{_number(90 - blade.pitch)} deg",
        },
    }
    if blade.precone:  # downwind is the direction -b3
        tables["mount"]["precone"] = f"{_number(-blade.precone)} deg"
    if blade.tip:
        units = {key: unit for key, unit in _TIP_UNITS.items() if key == "mass" or blade.tip.get(key)}
        units |= {key: _TIP_UNITS[key] for key in ("transverse_inertia",) if key in blade.tip}
        tables["beam"]["tip"] = {
            key: f"{_number(blade.tip.get(key, 0.0))} {units[key]}" for key in _TIP_UNITS if key in units
        }
    if blade.speed:
        tables["motion"] = {"kind": "steady", "speed": f"{_number(blade.speed)} rpm"}
    if "second_bending_stiffness" in blade.columns:
        tables["physics"] = {"planes": 2}
    if any(_names(blade, OFFSETS)) or blade.tip.get("offset_across"):
        tables["physics"]["torsion"] = True
    if blade.matrices is not None:
        effects = ("shear", "rotary_inertia", "stretch", "torsion", "large_deflection")
        tables["physics"] = {"planes": 2} | dict.fromkeys(effects, True)
    return tables


def _tables_of_stations(blade: Blade) -> dict[str, Any]:
    """Return TOML tables of properties along the blade, and of its cross-section matrices if it has any."""
    if blade.matrices is None:
        return {"stations": _rows(blade)}
    given = {"stations": _rows(blade)} if _names(blade, _UNITS) else {}
    return given | {"matrices": _matrix_rows(blade.matrices)}


def _matrix_rows(matrices: BladeMatrices) -> list[list[Any]]:
    """Return headings and rows for the matrix entries that are nonzero at any station."""
    both = {"K": matrices.stiffness, "M": matrices.mass}
    entries = {
        f"{entry_name(letter, i, j)}": values[:, i, j] for letter, values in both.items() for i, j in UPPER
    }
    units = entry_units()
    kept = {f"{name} [{units[name]}]": values for name, values in entries.items() if values.any()}
    columns = [matrices.stations, *kept.values()]
    return [["x/L", *kept], *([float(_number(value)) for value in row] for row in zip(*columns, strict=True))]


def _names(blade: Blade, among: Iterable[str]) -> list[str]:
    """Select the properties that the blade has; offsets and twist only if nonzero at any station."""
    given = (name for name in among if name in blade.columns)
    return [name for name in given if name not in OF_ANY_SIGN or blade.columns[name].any()]


def _rows(blade: Blade) -> list[list[Any]]:
    """Return headings and rows of the table of stations."""
    names = _names(blade, _UNITS)
    heads = ["x/L", *(f"{name} [{_UNITS[name]}]" for name in names)]
    columns = [blade.stations, *(blade.columns[name] for name in names)]
    return [heads, *([float(_number(value)) for value in row] for row in zip(*columns, strict=True))]


def _number(value: float) -> str:
    """Format a number with the precision of a float, and zero without a sign."""
    return f"{value + 0.0:.{_DIGITS}g}"


# Text of the file ---------------------------------------------------------------------------------


def text_of(tables: Mapping[str, Any], comments: Mapping[str, Iterable[str]]) -> str:
    """Write the text of a scene file.

    Parameters
    ----------
    tables : mapping
        Tables of the scene file, as returned by `tables_of`.
    comments : mapping
        Sentences to write as comments above a table, by name of the table; "" for the start of the file.
    """
    lines = [*_commented(comments.get("", ()))]
    for name, table in tables.items():
        inner = {key: value for key, value in table.items() if isinstance(value, dict)}
        lines += ["", *_commented(comments.get(name, ())), f"[{name}]"]
        lines += [
            line for key, value in table.items() if key not in inner for line in _assignment(key, value)
        ]
        for key, value in inner.items():
            lines += ["", f"[{name}.{key}]"]
            lines += [line for k, v in value.items() for line in _assignment(k, v)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _commented(sentences: Iterable[str]) -> Iterator[str]:
    """Yield comment lines; characters that would end a comment are replaced by blanks."""
    for sentence in sentences:
        yield f"# {''.join(c if c.isprintable() else ' ' for c in sentence)}".rstrip()


def _assignment(key: str, value: Any) -> Iterator[str]:
    if isinstance(value, list):
        yield f"{key} = ["
        # The numbers in the rows are aligned in columns.
        heads, *numbers = value
        cells = [[f'"{head}"' for head in heads], *([_cell(value) for value in row] for row in numbers)]
        widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
        for row in cells:
            padded = (f"{cell},".ljust(width + 1) for cell, width in zip(row, widths, strict=True))
            yield f"  [{' '.join(padded).rstrip().rstrip(',')}],"
        yield "]"
    else:
        plain = f"{value}".lower() if isinstance(value, bool) else value
        yield f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {plain}"


def _cell(value: float) -> str:
    """Format a number in TOML notation, large numbers with an exponent."""
    text = _number(value)
    if "e" not in text and abs(value) >= 1e6:
        mantissa, _, exponent = f"{value:.{_DIGITS - 1}e}".partition("e")
        text = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return text
