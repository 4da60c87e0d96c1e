"""Values of a wrong kind for most arguments, and a check that calls refuse them."""

import math
from decimal import Decimal

import numpy as np

WRONG = {
    "bytes": b"1",
    "text": "parsnips",
    "complex": 1j,
    "numpy's complex": np.complex128(1),
    "array of complex": np.array([1j, 2.0]),
    "truth": True,
    "numpy's truth": np.True_,
    "list with a truth": [True, 2.0],
    "nan": math.nan,
    "Decimal nan": Decimal("sNaN"),
    "beyond float": 10**400,
    "masked": np.ma.masked,
    "date": np.datetime64("2020"),
    "object": object(),
    "dictionary": {},
    "set": {1.0},
    "nested": [[1.0, 2.0], [3.0, 4.0]],
    "ragged": [[1.0], [2.0, 3.0]],
    "empty": [],
    "empty array": np.array([]),
    "matrix": np.ones((2, 2)),
    "class": float,
}
SAID_AS = {"driver": "load"}  # names that messages have for arguments


def refusals_missing(make, good, name, allowed):
    """Return the wrong values of an argument that are not refused by one sentence with its name."""
    missing = {}
    for kind, value in WRONG.items():
        if kind in allowed:
            continue
        try:
            make(**(good | {name: value}))
            missing[kind] = "accepted"
        except (ValueError, TypeError) as refusal:
            if SAID_AS.get(name, name) not in str(refusal) or "\n" in str(refusal):
                missing[kind] = f"{type(refusal).__name__}: {refusal}"
    return missing
