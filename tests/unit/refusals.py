"""What a refusal says."""

import pytest


def refused(build, *parts):
    """Check that a ValueError of one line with all given parts refuses the call."""
    with pytest.raises(ValueError) as refusal:
        build()
    message = str(refusal.value)
    assert "\n" not in message
    assert [part for part in parts if part not in message] == []
