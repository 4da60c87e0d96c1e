"""Names that messages and docstrings tell people to use exist in `beamdyn`."""

import ast
import builtins
import inspect
import re
from pathlib import Path

import pytest

import beamdyn as bd

PACKAGE = Path(bd.__file__).parent
EDGE = (
    "app",
    "cli",
    "edge",
    "decks",
    "screens",
)  # whose texts are about keys, options, forms, other programs' names
# "Scene(beam)", "Beam.from_stiffness", "MotionSample"; a dotted name such as "numpy.unique" is complete.
CLASS = re.compile(r"(?<![\w.])([A-Z][a-z]+(?:[A-Z]\w*)?)(?=\(|\.[a-z_]+)|(?<![\w.])([A-Z][a-z]+[A-Z]\w*)\b")
FUNCTION = re.compile(r"(?<![\w.])([a-z]+_[a-z_]+)\(")
TYPES = re.compile(r"^\w[\w, ]* : (.*)$", re.MULTILINE)  # of numpydoc's parameters
ELSEWHERE = {"Axes", "Executor", "Path", "OdeSolver", "ParaView", "Callable"}  # of other people
ELSEWHERE |= {
    "Provenance",
    "Result",
    "Entry",
    "EquivalentRange",
    "Diagram",
    "LinearSystem",
    "ModalSystem",
}  # parts of results, made by nobody
ELSEWHERE |= {"BeamDyn", "ElastoDyn", "DejaVu", "TipDxb1", "RootMyb1"}  # a program, a font, channels of FAST
ELSEWHERE |= {"Described", "FieldsOnly", "SampledScene"}  # for who extends the package
ELSEWHERE |= {"Re", "RecurDyn", "with_speed"}  # no advice: a formula, a paper's program, a method at fault


def known(name):
    return hasattr(bd, name) or hasattr(builtins, name) or name in ELSEWHERE


def messages():
    """Texts in the code of the core that are no docstrings, with their module."""
    for path in sorted(PACKAGE.rglob("*.py")):
        if {*path.parts} & {*EDGE} or path.name == "__init__.py":
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        plain = {
            id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)
        }  # docstrings, among others
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in plain:
                yield path.name, node.value


def named_classes(text):
    return {name for pair in CLASS.findall(text) for name in pair if name}


@pytest.mark.slow
def test_messages_name_what_exists():
    unknown = {
        (name, where)
        for where, text in messages()
        if " " in text
        for name in named_classes(text) | set(FUNCTION.findall(text))
        if not known(name)
    }
    assert unknown == set()


def documented(name):
    """A public object and its public methods and properties."""
    item = getattr(bd, name)
    yield item
    if isinstance(item, type) and item.__module__.startswith("beamdyn"):
        yield from (getattr(item, member) for member in vars(item) if not member.startswith("_"))


@pytest.mark.parametrize("name", [name for name in bd.__all__ if name != "Polynomial"])
def test_docstrings_name_what_exists(name):
    for item in documented(name):
        text = inspect.getdoc(item) or ""
        types = " ".join(TYPES.findall(text))
        named = named_classes(text) | set(re.findall(r"(?<![\w.{\"'])([A-Z][a-z]+\w*)", types))
        assert {each for each in named if not known(each)} == set()


def test_a_motion_and_a_polynomial_are_made_with_public_names_alone():
    import numpy as np

    def shaken(t):
        zero = np.zeros_like(t)
        return bd.MotionSample(5.0 * t, 5.0 + zero, zero, np.zeros((*t.shape, 3)))

    assert isinstance(bd.UserMotion(shaken, t_end=1.0), bd.Motion)
    assert issubclass(bd.SpinUp, bd.Rotation)
    beam = bd.Beam.rectangular(0.05, bd.Polynomial([0.01, -0.005]), 0.0002, 200e9, 7850.0)
    assert isinstance(beam.mass_per_length, bd.Profile)
    with pytest.raises(bd.ConfigError):
        bd.load_scene("parsnips.toml")
