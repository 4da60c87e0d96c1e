"""Values as the types of JSON."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


def plain(value: Any) -> Any:
    """A value as JSON's types, with complex numbers as pairs and numbers that are not finite kept."""
    if isinstance(value, np.ndarray):
        value = np.stack([value.real, value.imag], axis=-1) if np.iscomplexobj(value) else value
        return value.tolist()
    if isinstance(value, np.generic):
        return plain(value.item())
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value) if f.repr}
    if isinstance(value, tuple | list):
        return [plain(v) for v in value]
    if isinstance(value, dict):
        return {str(key): plain(v) for key, v in value.items()}
    if isinstance(value, complex):
        return [value.real, value.imag]
    return value


def nullified(value: Any) -> Any:
    """Replace numbers that are not finite, which JSON does not have, by null."""
    if isinstance(value, dict):
        return {key: nullified(v) for key, v in value.items()}
    if isinstance(value, list):
        return [nullified(v) for v in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
