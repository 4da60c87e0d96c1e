"""Numbers as text, with the digits that their error justifies."""

from __future__ import annotations

import math

_DIGITS = 10  # largest number of digits that a table shows


def supported(value: float, error: float, most: int = _DIGITS) -> str:
    """Round a number so that half a unit of its last digit is not below its error.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Absolute error of the number.
    most : int
        Largest number of significant digits.

    Returns
    -------
    str
        "0 ± error" where the error is half the number or more, "number ± error" where else no digit is sure,
        "unresolved" where the error is not known.
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
        return _with_error(value, error)
    return f"{value:.{decimals}f}" if lead > -4 and decimals >= 0 else f"{value:.{decimals + lead}e}"


def supported_or_range(value: float, error: float, most: int = _DIGITS) -> str:
    """Format a number like `supported`, but as "number ± error" where only one digit is sure."""
    text = supported(value, error, most)
    if "±" in text or not (0 < 2 * error < abs(value) < math.inf):
        return text
    lead = math.floor(math.log10(abs(value)))
    return _with_error(value, error) if math.floor(-math.log10(2 * error)) + lead <= 0 else text


def _with_error(value: float, error: float) -> str:
    """Format a number with the digits up to the first of its error, and that error with one digit."""
    last = math.floor(math.log10(error))
    digits = max(math.floor(math.log10(abs(value))) - last, 0) + 1
    return f"{value:#.{digits}g} ± {error:.1g}".replace(". ", " ").replace(".e", "e")


def told_from(value: float, limit: float) -> str:
    """Format a number with two digits, or as many as tell it from a limit beside it."""
    texts = (f"{value:.{digits}g}" for digits in range(2, 18))
    return next((text for text in texts if float(text) != limit), f"{value:g}")


def percent(value: float, sign: str = "") -> str:
    """Format a relative number in percent with two digits, never with a positive exponent."""
    digits = f"{100 * value:{sign}.2g}"
    return f"{100 * value:{sign}.0f} %" if "e+" in digits else f"{digits} %"


def count_sure(text: str, error: float) -> int:
    """Count the characters of a number's text up to the last digit that its error supports.

    Parameters
    ----------
    text : str
        A number as `supported` writes it.
    error : float
        Absolute error; nan or inf leaves no digit sure.

    Returns
    -------
    int
        The whole length if all digits are sure; a sign or decimal point counts only before a sure digit.
    """
    mantissa, _, exponent = text.partition("e")
    digits = mantissa.lstrip("-").replace(".", "", 1)
    if not digits.isdigit() or error == 0:
        return len(text)
    point = mantissa.find(".") if "." in mantissa else len(mantissa)
    scale = int(exponent or 0)
    sure = 0
    for i, character in enumerate(mantissa):
        place = scale + (point - i - 1 if i < point else point - i)  # power of ten of the digit
        if character.isdigit() and not 2 * error <= 10.0**place:
            break
        if character.isdigit():
            sure = i + 1
    else:
        return len(text)
    return sure
