"""The numbers that papers and books print, one TOML file a source; tests and reports read the same files."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import Any


def load(name: str) -> dict[str, Any]:
    """Contents of ``brakes/published/<name>.toml``.

    Parameters
    ----------
    name
        Of the file, without its ending, e.g. ``"yoo_1997"``.

    Returns
    -------
    dict
        The file's tables; quantities are tables with ``value``, ``unit`` and mostly ``source``.

    Raises
    ------
    ValueError
        If there is no such file; the message lists those there are.
    """
    known = available()
    if name not in known:
        raise ValueError(f"no published data {name!r}; there are {', '.join(known)}")
    return tomllib.loads(files(__name__).joinpath(f"{name}.toml").read_text(encoding="utf-8"))


def available() -> list[str]:
    """Names that `load` accepts, sorted."""
    names = (file.name for file in files(__name__).iterdir())
    return sorted(name.removesuffix(".toml") for name in names if name.endswith(".toml"))
