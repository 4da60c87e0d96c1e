"""The one refinement, and the one table of margins."""

from importlib.util import find_spec

import pytest

from beamdyn.accuracy import refinement
from beamdyn.accuracy.refinement import refine
from beamdyn.equations.effects import EFFECTS, NEVER_MODELLED
from beamdyn.scene.physics import Physics

MARGINS = [value for value in vars(refinement).values() if isinstance(value, refinement.ErrorMargin)]


def test_refines_until_the_tolerance_is_met() -> None:
    """Newton's iteration for a root doubles its digits."""
    found = refine(1.0, lambda x: (x + 2 / x) / 2, lambda x: abs(x * x - 2) < 1e-12)
    assert found == pytest.approx(2**0.5, rel=1e-12)


def test_keeps_what_meets_the_tolerance_and_the_last_where_nothing_does() -> None:
    """Nothing finer is computed than is needed or can be had."""
    sizes = iter([2, 4])
    assert refine(1, lambda _: next(sizes), lambda size: size >= 2) == 2
    assert next(sizes) == 4
    assert refine(1, lambda size: size + 1 if size < 3 else None, lambda _: False) == 3


@pytest.mark.parametrize("margin", MARGINS, ids=lambda margin: margin.distance)
def test_evidence_of_a_margin_is_a_benchmark(margin: refinement.ErrorMargin) -> None:
    """A reader can measure each margin again."""
    assert find_spec(f"benchmarks.{margin.evidence}") is not None


def test_effects_are_switches_of_the_physics() -> None:
    """Each effect that models have is switched by a field of `Physics`, to other than its default."""
    assert all(getattr(Physics(), effect.switch) != effect.value for effect in EFFECTS)
    fields = {name for name in vars(Physics()) if name != "branch"}
    assert {effect.switch for effect in EFFECTS} == fields
    assert not any(effect.switch for effect in NEVER_MODELLED)


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.5, 0.8])
def test_the_error_of_the_finest_of_three_is_that_of_a_geometric_series(ratio: float) -> None:
    """By the margin, which alone counts where answers converge slowly."""
    margin = refinement.THREE_DISCRETIZATIONS
    found = refinement.error_of_finest(margin, ratio - ratio**2, 1 - ratio)
    assert found == pytest.approx(margin.factor * min(ratio**2, ratio - ratio**2), rel=1e-12)
