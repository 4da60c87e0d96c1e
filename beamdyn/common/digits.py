"""Numbers as text with the digits that their error justifies."""

from __future__ import annotations

import math

_DIGITS = 10  # most that a table shows


def supported(value: float, error: float, most: int = _DIGITS) -> str:
    """A number rounded so that half a unit of its last digit is not below its error.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Its absolute error.
    most : int
        Most significant digits.

    Returns
    -------
    str
        "0 ± error" where no digit is sure, "unresolved" where the error is not known.
    """
    if not math.isfinite(value):
        return "none" if math.isnan(value) else str(value)
    if not math.isfinite(error):
        return "unresolved"
    if value == 0 and error == 0:
        return "0"
    if 2 * error >= abs(value):
        return f"0 ± {abs(value) + error:.1g}"
    lead = math.floor(math.log10(abs(value)))
    decimals = most - 1 - lead
    if error > 0:
        decimals = min(decimals, math.floor(-math.log10(2 * error)))
    if decimals + lead < 0:
        return f"0 ± {abs(value) + error:.1g}"
    return f"{value:.{decimals}f}" if lead > -4 and decimals >= 0 else f"{value:.{decimals + lead}e}"
