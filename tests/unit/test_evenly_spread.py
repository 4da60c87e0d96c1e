"""Few of many indices, evenly spread."""

import numpy as np
import pytest

from beamdyn.common.results.columns import evenly_spread


@pytest.mark.parametrize("count, most", [(301, 11), (12, 11), (11, 11), (3, 11), (1, 11), (1000, 2)])
def test_first_and_last_are_among_few_that_are_equally_far_apart(count, most):
    chosen = evenly_spread(count, most)
    assert (chosen[0], chosen[-1], len(chosen)) == (0, count - 1, min(count, most))
    apart = np.diff(chosen)
    assert not len(apart) or np.ptp(apart) <= 1  # whole numbers: by rounding


def test_none_of_none():
    assert evenly_spread(0, 11).size == 0
