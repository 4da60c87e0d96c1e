"""An error in a paper, and what it costs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Erratum:
    """An error in a paper and its consequence: the number that follows from it beside the right one.

    Attributes
    ----------
    name : str
        Short name.
    where, printed, right : str
        The place in the paper, what it has there, and what it should have.
    quantity, unit : str
        Name and unit of the two values; an empty quantity where nothing follows from the error.
    printed_value, right_value : float
        The number that follows from the error, and the right one.
    remark : str
        A further remark on the consequence.
    """

    name: str
    where: str
    printed: str
    right: str
    quantity: str = ""
    unit: str = ""
    printed_value: float = 0.0
    right_value: float = 0.0
    remark: str = ""

    @property
    def consequence(self) -> str:
        """The consequence in a sentence."""
        if not self.quantity:
            return "none further on"
        unit, remark = (self.unit and f" {self.unit}"), (self.remark and f"; {self.remark}")
        return f"{self.quantity}: {self.printed_value:.5g} in place of {self.right_value:.5g}{unit}{remark}"
