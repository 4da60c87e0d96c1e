"""Initial designs of documents: files in this folder, or else the examples of the same name."""

from importlib.resources import files

from beamdyn.common.screens.examples import examples_folder


def base(name: str) -> str:
    """Return the TOML text of a document's initial design."""
    own = files("brakes.app.bases") / f"{name}.toml"
    return (own if own.is_file() else examples_folder() / f"{name}.toml").read_text(encoding="utf-8")
