"""Published numbers in TOML files, one per paper, which are part of the package."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any


def load(package: str, name: str) -> dict[str, Any]:
    """Read the file ``<name>.toml`` of published numbers in a package.

    Parameters
    ----------
    package : str
        The package, e.g. ``"beamdyn.published"``.
    name : str
        Name of the file without its suffix, e.g. ``"lee_yoo_2019"``.

    Returns
    -------
    dict
        The file's tables; quantities are tables with ``value``, ``unit`` and mostly ``source``.

    Raises
    ------
    ValueError
        If there is no such file; the message lists the names that exist.
    """
    known = available(package)
    if name not in known:
        raise ValueError(f"no published data {name!r}; there are {', '.join(known)}")
    return tomllib.loads(files(package).joinpath(f"{name}.toml").read_text(encoding="utf-8"))


def available(package: str) -> list[str]:
    """Return the names of all published files in a package, sorted; `load` accepts these names."""
    names = (file.name for file in files(package).iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))


def values_alone(entry: Any) -> Any:
    """Replace each quantity in a file of published numbers by its ``value``, without unit and source."""
    if isinstance(entry, dict):
        return entry["value"] if "value" in entry else {key: values_alone(v) for key, v in entry.items()}
    return [values_alone(item) for item in entry] if isinstance(entry, list) else entry
