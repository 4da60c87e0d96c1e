"""Studies: answers of many designs at once, over all combinations of inputs of a scene."""
