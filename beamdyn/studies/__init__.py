"""Studies: results for many designs at once, such as all combinations of given inputs of a scene."""
