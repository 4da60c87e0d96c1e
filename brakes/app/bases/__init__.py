"""The designs shown on opening: those of this folder, or the examples of the same name."""

from importlib.resources import files

from beamdyn.common.screens.examples import examples_folder


def base(name: str) -> str:
    """Text of a design's TOML file."""
    own = files("brakes.app.bases") / f"{name}.toml"
    return (own if own.is_file() else examples_folder() / f"{name}.toml").read_text(encoding="utf-8")
