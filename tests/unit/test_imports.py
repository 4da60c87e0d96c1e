"""`import beamdyn` is cheap: what is heavy is loaded when it is used."""

import subprocess
import sys
from pathlib import Path

import pytest

import beamdyn

ROOT = Path(__file__).parents[2]
HEAVY = {"matplotlib", "pydantic", "skfem", "pint", "meshio"}


FIRST_ANSWER = """
import beamdyn as bd
bd.natural_modes(bd.Scene(bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0), bd.Mount(0.215)), 50.0)
"""


def loaded_by(statement, names="name.partition('.')[0]"):
    """Top-level packages, or other parts of names, in a fresh interpreter after the statement."""
    code = f"{statement}\nimport sys; print(*{{{names} for name in sys.modules}})"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split())


def test_import_loads_nothing_heavy():
    assert loaded_by("import beamdyn") & HEAVY == set()


def test_first_answer_loads_no_sparse_matrices():
    by_scipy = loaded_by("import scipy.linalg", "name")  # its older versions load some themselves
    own = loaded_by(FIRST_ANSWER, "name") - by_scipy
    assert not any(name.startswith("scipy.sparse") for name in own)


@pytest.mark.parametrize("package", sorted(HEAVY))
def test_detector_sees_a_heavy_package(package):
    assert package in loaded_by(f"import {package}")


def test_every_public_name_exists():
    assert beamdyn.__all__
    assert [name for name in beamdyn.__all__ if not hasattr(beamdyn, name)] == []


def test_public_names_are_listed_before_they_are_loaded():
    loaded_by("import beamdyn; assert set(beamdyn.__all__) <= set(dir(beamdyn))")


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no_such_name"):
        beamdyn.no_such_name  # noqa: B018
