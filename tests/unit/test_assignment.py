"""Assignments have the least sum of costs, whether or not the rows compete for a column."""

from itertools import permutations

import numpy as np
import pytest

from beamdyn.common.numerics import assign


@pytest.mark.parametrize("apart", [0.0, 2.0])
def test_no_other_assignment_costs_less(apart):
    for cost in np.random.default_rng(7).random((20, 3, 4)) - apart * np.eye(3, 4):
        least = min(sum(cost[range(3), columns]) for columns in permutations(range(4), 3))
        assert sum(cost[range(3), assign(cost)]) == pytest.approx(least, rel=1e-12)


def test_a_cost_that_is_no_number_is_refused():
    with pytest.raises(ValueError, match="invalid numeric entries"):
        assign(np.array([[0.0, 1.0], [np.nan, 0.0]]))
