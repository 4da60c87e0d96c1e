"""Rounding errors of eigenproblems.

They were fitted by benchmarks/stated_frequency_errors.py to 720 frequencies of random scenes.  The matrices
are graded, so that the errors are smaller than their norms suggest.
"""

from __future__ import annotations

import numpy as np

BACKWARD = 8 * np.finfo(float).eps  # backward error of the stiffness, relative to the sum of its terms
ROUNDING_SIZE = 40  # functions above which rounding errors grow in proportion to their number: measured
