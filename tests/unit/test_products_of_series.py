"""Products of Legendre series are accurate to rounding, whatever their lengths."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import legendre

from beamdyn.common.numerics import multiply_series

AT = np.linspace(-1, 1, 801)


@pytest.mark.parametrize("count", [1, 2, 12, 24, 32, 48, 64])
def test_a_product_is_that_of_the_values(count: int) -> None:
    a, b = (legendre.legfit(AT, f(AT), count - 1) for f in (np.exp, lambda t: 1.2 + np.sin(3 * t)))
    expected = legendre.legval(AT, a) * legendre.legval(AT, b)
    found = legendre.legval(AT, multiply_series(a[:, None], b[:, None])[:, 0])
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-13 * np.abs(expected).max())
