"""Descriptions of inputs as plain data: files, forms and help texts are made from them."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass


@dataclass(frozen=True)
class Described:
    """Description of an input, for ``Annotated[float, Described("m", "L", "length")]``.

    Parameters
    ----------
    unit : str
        SI unit; "" for a plain number, or a word.
    symbol : str
        Symbol in formulas.
    meaning : str
        What it is, for people: a phrase without a full stop.
    above, below : float, optional
        Bounds that the value must not reach [unit].
    least, most : float, optional
        Smallest and largest value [unit].
    remedy : str
        What to do about a value out of bounds.
    key : str
        Its key in files, if that is not the name of the argument.
    required : bool
        Whether files must give it, even where the argument has a default.
    """

    unit: str = ""
    symbol: str = ""
    meaning: str = ""
    _: KW_ONLY
    above: float | None = None
    below: float | None = None
    least: float | None = None
    most: float | None = None
    remedy: str = ""
    key: str = ""
    required: bool = False

    @property
    def bounds(self) -> str:
        """Bounds in words, such as "greater than 0, at most 1"; empty if there are none."""
        words = {
            "greater than": self.above,
            "at least": self.least,
            "below": self.below,
            "at most": self.most,
        }
        return ", ".join(f"{word} {bound:g}" for word, bound in words.items() if bound is not None)
