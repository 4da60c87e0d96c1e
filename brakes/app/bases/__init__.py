"""The designs shown on opening."""

from importlib.resources import files


def base(name: str) -> str:
    """Text of a design's TOML file."""
    return (files("brakes.app.bases") / f"{name}.toml").read_text(encoding="utf-8")
