"""Answers over all combinations of inputs of a scene: many designs at once."""
